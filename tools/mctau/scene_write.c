#include "scene_write.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "csv_output.h"
#include "mctau/stepper.h"
#include "say.h"
#include "src/scene/check.h"

enum { LONGEST_VALUE = 32 * MCT_MAX_LIST };

/* --- values --- */

/* Adds to a text what there is room for. */
static void add(char *text, size_t size, const char *more)
{
    const size_t length = strlen(text);
    snprintf(text + length, size - length, "%s", more);
}

/* The shortest that reads back as the same double. */
static void add_number(char *text, size_t size, double value)
{
    char number[32];
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(number, sizeof number, "%.*g", digits, value);
        if (strtod(number, NULL) == value) {
            break;
        }
    }
    add(text, size, number);
}

static void add_quoted(char *text, size_t size, const char *quoted)
{
    add(text, size, "\"");
    for (; *quoted != '\0'; quoted++) {
        const char letter[2] = {*quoted, '\0'};
        add(text, size, *quoted == '"' || *quoted == '\\' ? "\\" : "");
        add(text, size, letter);
    }
    add(text, size, "\"");
}

static void add_list(char *text, size_t size, const mct_scene *scene, const mct_scene_key *key)
{
    const mct_list *list = (const mct_list *)(const void *)((const char *)scene + key->field.offset);
    const int columns = key->rows != NULL ? key->rows->column_count : 1;
    add(text, size, "[");
    for (int32_t i = 0; i < list->count; i++) {
        const mct_field *column = key->rows != NULL ? &key->rows->columns[i % columns] : &key->field;
        add(text, size, i > 0 ? ", " : "");
        add(text, size, columns > 1 && i % columns == 0 ? "[" : "");
        if (column->kind == MCT_FIELD_CHOICE) {
            add_quoted(text, size, mct_choice_name(column, (int32_t)list->values[i]));
        } else {
            add_number(text, size, list->values[i]);
        }
        add(text, size, columns > 1 && i % columns == columns - 1 ? "]" : "");
    }
    add(text, size, "]");
}

const char *scene_value_text(const mct_scene *scene, const mct_scene_key *key, char *text, size_t size)
{
    text[0] = '\0';
    switch (key->field.kind) {
    case MCT_FIELD_TEXT:
        add_quoted(text, size, (const char *)scene + key->field.offset);
        break;
    case MCT_FIELD_LIST:
        add_list(text, size, scene, key);
        break;
    case MCT_FIELD_CHOICE:
        add_quoted(text, size, mct_choice_name(&key->field, (int32_t)mct_key_get(scene, key)));
        break;
    case MCT_FIELD_BOOLEAN:
        add(text, size, mct_key_get(scene, key) != 0 ? "true" : "false");
        break;
    case MCT_FIELD_REAL:
    case MCT_FIELD_INTEGER:
        add_number(text, size, mct_key_get(scene, key));
        break;
    }
    return text;
}

/* --- which keys --- */

/* What a reader would refuse, because the scene has no use for it. */
static bool is_idle(const mct_scene *scene, int table, const mct_scene_key *key, int number)
{
    const mct_system *system = mct_systems[scene->system];
    const bool is_input = strcmp(mct_table_name(table), "input") == 0;
    return (key->effect != NULL && (key->effect->mask & system->effects) == 0) ||
           (table == MCT_TABLE_INITIAL && number >= mct_state_count(scene)) ||
           (is_input && !mct_input_reads(scene->input, key->field.name));
}

/* Whether a reader would only say that nothing reads it. */
static bool is_unread(const mct_scene *scene, int table, const mct_scene_key *key)
{
    const uint32_t readers = key->rows != NULL ? key->rows->effects : key->field.effects;
    return table == MCT_TABLE_PARAMETERS && readers != 0 && (readers & mct_scene_effects(scene)) == 0;
}

static bool is_written_always(int table)
{
    return strcmp(mct_table_name(table), "scene") == 0 || table == MCT_TABLE_PARAMETERS ||
           table == MCT_TABLE_EFFECTS || table == MCT_TABLE_INITIAL;
}

/* --- the file --- */

static void write_key(csv_output *out, const char *before, const mct_scene_key *key, const char *value)
{
    char line[LONGEST_VALUE + 512], assignment[LONGEST_VALUE + 64], unit[32] = "";
    if (key->field.unit[0] != '\0') {
        snprintf(unit, sizeof unit, " [%s]", key->field.unit);
    }
    const char *doc = key->field.doc, *space = doc[0] != '\0' ? " " : "";
    snprintf(assignment, sizeof assignment, "%s%s = %s", before, key->field.name, value);
    const int length = snprintf(line, sizeof line, "%-32s #%s%s%s\n", assignment, unit, space, doc);
    csv_output_headers(out, line, (size_t)length);
}

static void write_table(csv_output *out, const mct_scene *scene, const mct_scene *defaults, int table)
{
    const mct_system *system = mct_systems[scene->system];
    bool is_begun = false;
    for (int i = 0; i < mct_key_count(table, system); i++) {
        char value[LONGEST_VALUE], standard[LONGEST_VALUE];
        mct_scene_key key = mct_key_at(table, system, i);
        scene_value_text(scene, &key, value, sizeof value);
        scene_value_text(defaults, &key, standard, sizeof standard);
        if (is_idle(scene, table, &key, i) || (!is_written_always(table) && strcmp(value, standard) == 0)) {
            continue;
        }
        if (!is_begun) {
            char header[64];
            const int length = snprintf(header, sizeof header, "\n[%s]\n", mct_table_name(table));
            csv_output_headers(out, header, (size_t)length);
            is_begun = true;
        }
        if (is_unread(scene, table, &key)) {
            key.field.doc = "its effect is off";
            write_key(out, "# ", &key, value);
        } else {
            write_key(out, "", &key, value);
        }
    }
}

static void write_comment(csv_output *out, const char *comment)
{
    while (*comment != '\0') {
        const size_t length = strcspn(comment, "\n");
        csv_output_headers(out, "# ", 2);
        csv_output_headers(out, comment, length);
        csv_output_headers(out, "\n", 1);
        comment += length + (comment[length] == '\n' ? 1 : 0);
    }
}

int scene_write(const mct_scene *scene, const char *comment, const char *path)
{
    mct_message why;
    mct_scene written = *scene, defaults;
    csv_output *out = need_memory(malloc(sizeof *out));
    mct_status status = csv_output_open(out, path, &why);
    int exit_code = status != MCT_OK ? say_status(status, &why) : 0;
    if (exit_code == 0) {
        written.stepper = scene->automatic ? MCT_STEPPER_COUNT : scene->stepper; /* "auto" */
        mct_scene_defaults(&defaults, scene->system);
        write_comment(out, comment);
        for (int table = 0; table < MCT_TABLE_COUNT; table++) {
            write_table(out, &written, &defaults, table);
        }
        csv_output_close(out);
        exit_code =
            out->error != 0 ? say(EXIT_IO, "%s: %s; it is left as it was", path, strerror(out->error)) : 0;
    }
    free(out);
    return exit_code;
}

#include "mctau/scene.h"

#include <string.h>

#include "check.h"
#include "mctau/mix.h"
#include "mctau/stepper.h"
#include "tables.h"
#include "text.h"
#include "toml.h"

/* What a reading holds; some 20 kB, on the stack of mct_scene_read. */
typedef struct {
    mct_toml toml;
    mct_scene scene;
    const mct_system *system;
    const char *origin;
    const mct_override *overrides;
    int override_count;
    mct_message *why;
} reader;

/* One value given, in the file or from outside. */
typedef struct {
    const mct_toml_entry *entry;
    const char *origin; /* of an override; NULL for the file */
} given;

/* --- sentences --- */

enum { SHOWN = 48 }; /* bytes of a value or a name that a message shows */

static void add_shown(mct_message *why, mct_span text)
{
    mct_message_add_span(why, text.start, text.length < SHOWN ? text.length : SHOWN);
    mct_message_add(why, text.length > SHOWN ? "..." : "");
}

/* "scenes/x.toml:12: " or "--set: " */
static void begin_place(const reader *self, const char *override_origin, int32_t line)
{
    mct_message_clear(self->why);
    mct_message_add(self->why, override_origin != NULL ? override_origin : self->origin);
    if (override_origin == NULL && line > 0) {
        mct_message_add(self->why, ":");
        mct_message_add_integer(self->why, line);
    }
    mct_message_add(self->why, ": ");
}

/* "scenes/x.toml:12: parameters.pole_mass: " */
static void begin_key(const reader *self, given value)
{
    begin_place(self, value.origin, value.entry->line);
    add_shown(self->why, value.entry->table);
    mct_message_add(self->why, ".");
    add_shown(self->why, value.entry->key);
    mct_message_add(self->why, ": ");
}

/* --- the closest of the allowed names --- */

enum { LONGEST_NAME = 40 };

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* Letters to insert, remove, replace or swap with their neighbour (optimal string alignment). */
static int edit_distance(mct_span a, mct_span b)
{
    int rows[3][LONGEST_NAME + 1];
    int *before = rows[0];
    int *last = rows[1];
    int *row = rows[2];
    if (a.length > LONGEST_NAME || b.length > LONGEST_NAME) {
        return 2 * LONGEST_NAME;
    }
    for (size_t j = 0; j <= b.length; j++) {
        last[j] = (int)j;
        before[j] = 0;
    }
    for (size_t i = 1; i <= a.length; i++) {
        row[0] = (int)i;
        for (size_t j = 1; j <= b.length; j++) {
            const int replaced = last[j - 1] + (a.start[i - 1] != b.start[j - 1]);
            row[j] = least(replaced, 1 + least(last[j], row[j - 1]));
            const bool swapped =
                i > 1 && j > 1 && a.start[i - 1] == b.start[j - 2] && a.start[i - 2] == b.start[j - 1];
            row[j] = swapped ? least(row[j], before[j - 2] + 1) : row[j];
        }
        int *const oldest = before;
        before = last;
        last = row;
        row = oldest;
    }
    return last[b.length];
}

/* Collects the names that would have been allowed. */
typedef struct {
    mct_span found;
    const char *closest;
    int distance;
    mct_message list;
} suggestion;

static void begin_suggestion(suggestion *self, mct_span found)
{
    self->found = found;
    self->closest = NULL;
    self->distance = least(4, 1 + (int)(found.length < LONGEST_NAME ? found.length : LONGEST_NAME) / 3);
    mct_message_clear(&self->list);
}

static void consider(suggestion *self, const char *name)
{
    const int distance = edit_distance(self->found, mct_text_span(name));
    if (distance < self->distance || (distance == self->distance && self->closest == NULL)) {
        self->distance = distance;
        self->closest = name;
    }
    mct_message_add(&self->list, self->list.text[0] != '\0' ? ", " : "");
    mct_message_add(&self->list, name);
}

static void add_suggestion(mct_message *why, const suggestion *self)
{
    enum { SHORT = 240 };
    if (self->closest != NULL) {
        mct_message_add(why, "; did you mean '");
        mct_message_add(why, self->closest);
        mct_message_add(why, "'?");
    }
    if (self->closest == NULL || mct_text_length(self->list.text) <= SHORT) {
        mct_message_add(why, self->closest != NULL ? " allowed " : "; allowed ");
        mct_message_add(why, self->list.text);
    }
}

/* --- finding the key --- */

static int find_table(mct_span name)
{
    for (int table = 0; table < MCT_TABLE_COUNT; table++) {
        if (mct_span_is(name, mct_table_name(table))) {
            return table;
        }
    }
    return -1;
}

static bool find_key(int table, const mct_system *system, mct_span name, mct_scene_key *key)
{
    for (int i = 0; i < mct_key_count(table, system); i++) {
        *key = mct_key_at(table, system, i);
        if (mct_span_is(name, key->field.name)) {
            return true;
        }
    }
    return false;
}

/* Whether a name is that of a component of a vector or a matrix: gravity_2, inertia_1_3, attitude_w. */
static bool is_component(mct_span vector, mct_span name)
{
    const mct_span begin = {name.start, vector.length};
    if (name.length < vector.length + 2 || !mct_span_equal(begin, vector)) {
        return false;
    }
    const char *const rest = name.start + vector.length; /* _1, _1_3 */
    const size_t length = name.length - vector.length;
    for (size_t i = 0; i + 1 < length; i += 2) {
        const char c = rest[i + 1];
        if (rest[i] != '_' || !((c >= '1' && c <= '3') || (c >= 'w' && c <= 'z'))) {
            return false;
        }
    }
    return length % 2 == 0;
}

/* Component `number` of a vector; the one behind the last has no name. */
static mct_scene_key component_at(int table, const mct_system *system, mct_span vector, int number)
{
    for (int i = 0, count = 0; i < mct_key_count(table, system); i++) {
        const mct_scene_key key = mct_key_at(table, system, i);
        if (is_component(vector, mct_text_span(key.field.name)) && count++ == number) {
            return key;
        }
    }
    const mct_scene_key none = {.field = {.name = NULL}};
    return none;
}

static int component_count(int table, const mct_system *system, mct_span vector)
{
    int count = 0;
    while (component_at(table, system, vector, count).field.name != NULL) {
        count++;
    }
    return count;
}

static mct_status refuse_table(const reader *self, const char *override_origin, int32_t line, mct_span name)
{
    suggestion names;
    begin_suggestion(&names, name);
    for (int table = 0; table < MCT_TABLE_COUNT; table++) {
        consider(&names, mct_table_name(table));
    }
    begin_place(self, override_origin, line);
    mct_message_add(self->why, "[");
    add_shown(self->why, name);
    mct_message_add(self->why, "]: unknown table");
    add_suggestion(self->why, &names);
    return MCT_ERROR_RANGE;
}

static mct_status refuse_key(const reader *self, given value, int table)
{
    mct_scene_key key;
    suggestion names;
    const char *home = NULL;
    begin_suggestion(&names, value.entry->key);
    for (int i = 0; i < mct_key_count(table, self->system); i++) {
        consider(&names, mct_key_at(table, self->system, i).field.name);
    }
    for (int i = 0; i < MCT_TABLE_COUNT && home == NULL; i++) {
        home = find_key(i, self->system, value.entry->key, &key) ? mct_table_name(i) : NULL;
    }
    const char *owner = NULL;
    for (int i = 0; i < MCT_SYSTEM_COUNT && owner == NULL; i++) {
        owner = find_key(table, mct_systems[i], value.entry->key, &key) ? mct_systems[i]->name : NULL;
    }
    begin_key(self, value);
    mct_message_add(self->why, "unknown key of [");
    mct_message_add(self->why, mct_table_name(table));
    mct_message_add(self->why, "] for ");
    mct_message_add(self->why, self->system->name);
    if (home != NULL) {
        mct_message_add(self->why, "; it belongs to [");
        mct_message_add(self->why, home);
        mct_message_add(self->why, "]");
    } else if (owner != NULL) {
        mct_message_add(self->why, "; it belongs to ");
        mct_message_add(self->why, owner);
        mct_message_add(self->why, "; allowed ");
        mct_message_add(self->why, names.list.text);
    } else {
        add_suggestion(self->why, &names);
    }
    return MCT_ERROR_RANGE;
}

/* --- one value --- */

static bool is_finite(double value)
{
    return value - value == 0;
}

static mct_status refuse_value(const reader *self, given value, const mct_scene_key *key, const char *reason,
                               mct_status status)
{
    const mct_toml_kind kind = value.entry->kind;
    const bool is_number =
        (kind == MCT_TOML_INTEGER || kind == MCT_TOML_REAL) && is_finite(value.entry->number);
    begin_key(self, value);
    mct_message_add(self->why, "found ");
    add_shown(self->why, value.entry->source);
    if (is_number) {
        mct_message_add_unit(self->why, &key->field);
    }
    mct_message_add(self->why, reason);
    mct_message_add(self->why, "; allowed ");
    mct_message_add_allowed(self->why, key, self->system);
    return status;
}

static mct_status refuse_type(const reader *self, given value, const mct_scene_key *key)
{
    static const char *const found[] = {
        [MCT_TOML_INTEGER] = ", a number", [MCT_TOML_REAL] = ", a number", [MCT_TOML_BOOLEAN] = ", a boolean",
        [MCT_TOML_TEXT] = ", a text",      [MCT_TOML_LIST] = ", a list",
    };
    static const char *const expected[] = {
        [MCT_FIELD_REAL] = ", where a number belongs",
        [MCT_FIELD_INTEGER] = ", where a whole number belongs",
        [MCT_FIELD_BOOLEAN] = ", where a boolean belongs",
        [MCT_FIELD_CHOICE] = ", where a name in quotes belongs",
        [MCT_FIELD_TEXT] = ", where a text in quotes belongs",
        [MCT_FIELD_LIST] = ", where a list belongs",
    };
    begin_key(self, value);
    mct_message_add(self->why, "found ");
    add_shown(self->why, value.entry->source);
    mct_message_add(self->why, found[value.entry->kind]);
    mct_message_add(self->why, expected[key->field.kind]);
    mct_message_add(self->why, "; allowed ");
    mct_message_add_allowed(self->why, key, self->system);
    return MCT_ERROR_RANGE;
}

static mct_status refuse_out_of_range(const reader *self, given value, const mct_scene_key *key,
                                      double number)
{
    return refuse_value(self, value, key, is_finite(number) ? "" : ", which is not finite", MCT_ERROR_RANGE);
}

static mct_status set_choice(reader *self, given value, const mct_scene_key *key)
{
    static const char *const switched[] = {"false", "true"}; /* of an override, whose text has no quotes */
    char name[MCT_MAX_TEXT];
    const bool is_switch = key->effect != NULL && key->effect->is_switch;
    const bool is_boolean = value.entry->kind == MCT_TOML_BOOLEAN;
    const size_t length = is_boolean ? 0 : mct_toml_text(value.entry, name, sizeof name);
    const mct_span found = {name, length < sizeof name ? length : sizeof name - 1};
    for (int32_t i = 0; mct_choice_name(&key->field, i) != NULL; i++) {
        const bool is_switched =
            is_switch && i < 2 && (is_boolean ? value.entry->integer == i : mct_span_is(found, switched[i]));
        if (!is_switched && !(length > 0 && mct_span_is(found, mct_choice_name(&key->field, i)))) {
            continue;
        }
        if (key->effect != NULL && (key->effect->bits[i] & ~self->system->effects)) {
            return refuse_value(self, value, key, ", which the system has not", MCT_ERROR_UNSUITED);
        }
        mct_key_set(&self->scene, key, i);
        return MCT_OK;
    }
    suggestion names;
    begin_suggestion(&names, found);
    for (int32_t i = 0; mct_choice_name(&key->field, i) != NULL; i++) {
        consider(&names, mct_choice_name(&key->field, i));
    }
    begin_key(self, value);
    mct_message_add(self->why, "found ");
    add_shown(self->why, value.entry->source);
    add_suggestion(self->why, &names);
    return MCT_ERROR_RANGE;
}

static mct_status set_text(reader *self, given value, const mct_scene_key *key)
{
    char text[MCT_MAX_TEXT];
    const size_t capacity = (size_t)key->field.maximum;
    const size_t length = mct_toml_text(value.entry, text, capacity);
    if (length >= capacity) {
        return refuse_value(self, value, key, ", which is too long", MCT_ERROR_BOUND);
    }
    if (mct_text_length(text) != length) {
        return refuse_value(self, value, key, ", which contains a NUL", MCT_ERROR_RANGE);
    }
    memcpy((char *)&self->scene + key->field.offset, text, length + 1);
    return MCT_OK;
}

/* One number of a list, or the index of a name. */
static mct_status read_item(const reader *self, given value, const mct_scene_key *key, const mct_field *field,
                            const mct_toml_entry *item, double *number)
{
    char name[MCT_MAX_TEXT];
    if (field->kind != MCT_FIELD_CHOICE) {
        *number = item->number;
        return item->kind == MCT_TOML_INTEGER || item->kind == MCT_TOML_REAL
                   ? MCT_OK
                   : refuse_value(self, value, key, ", where numbers belong", MCT_ERROR_RANGE);
    }
    if (item->kind == MCT_TOML_TEXT) {
        mct_toml_text(item, name, sizeof name);
        for (int32_t i = 0; mct_choice_name(field, i) != NULL; i++) {
            if (mct_text_equal(name, mct_choice_name(field, i))) {
                *number = i;
                return MCT_OK;
            }
        }
    }
    return refuse_value(self, value, key, ", with a name that is unknown", MCT_ERROR_RANGE);
}

static mct_status read_row(const reader *self, given value, const mct_scene_key *key,
                           const mct_toml_entry *row, mct_list *list)
{
    size_t position = 0;
    mct_toml_entry item;
    mct_status status = MCT_OK;
    if (row->kind != MCT_TOML_LIST || row->count != key->rows->column_count) {
        begin_key(self, value);
        mct_message_add(self->why, "found ");
        add_shown(self->why, row->source);
        mct_message_add(self->why, " as row ");
        mct_message_add_integer(self->why, list->count / key->rows->column_count + 1);
        mct_message_add(self->why, "; allowed ");
        mct_message_add_allowed(self->why, key, self->system);
        return MCT_ERROR_RANGE;
    }
    for (int i = 0; status == MCT_OK && mct_toml_item(row, &position, &item); i++) {
        status = read_item(self, value, key, &key->rows->columns[i], &item, &list->values[list->count]);
        list->count++;
    }
    return status;
}

static mct_status set_list(reader *self, given value, const mct_scene_key *key)
{
    mct_list list;
    mct_toml_entry item;
    mct_message sentence;
    size_t position = 0;
    mct_status status = MCT_OK;
    const int columns = key->rows != NULL ? key->rows->column_count : 1;
    const int most = key->rows != NULL ? key->rows->most_rows : MCT_MAX_LIST;
    memset(&list, 0, sizeof list);
    if (value.entry->count > most) {
        begin_key(self, value);
        mct_message_add(self->why, "found ");
        mct_message_add_integer(self->why, value.entry->count);
        mct_message_add(self->why, columns > 1 ? " rows; allowed " : " numbers; allowed ");
        mct_message_add_allowed(self->why, key, self->system);
        return MCT_ERROR_BOUND;
    }
    while (status == MCT_OK && mct_toml_item(value.entry, &position, &item)) {
        if (columns > 1) {
            status = read_row(self, value, key, &item, &list);
        } else {
            status = read_item(self, value, key, key->rows != NULL ? &key->rows->columns[0] : &key->field,
                               &item, &list.values[list.count]);
            list.count++;
        }
    }
    if (status != MCT_OK) {
        return status;
    }
    mct_message_clear(&sentence);
    status = mct_list_examine(key, self->system, &list, &sentence);
    if (status != MCT_OK) {
        begin_key(self, value);
        mct_message_add(self->why, sentence.text);
        return status;
    }
    memcpy((char *)&self->scene + key->field.offset, &list, sizeof list);
    return MCT_OK;
}

static mct_status set_value(reader *self, given value, const mct_scene_key *key)
{
    const mct_toml_entry *const entry = value.entry;
    switch (key->field.kind) {
    case MCT_FIELD_REAL:
        if (entry->kind != MCT_TOML_INTEGER && entry->kind != MCT_TOML_REAL) {
            return refuse_type(self, value, key);
        }
        break;
    case MCT_FIELD_INTEGER:
        if (entry->kind != MCT_TOML_INTEGER) {
            return refuse_type(self, value, key);
        }
        break;
    case MCT_FIELD_BOOLEAN:
        if (entry->kind != MCT_TOML_BOOLEAN) {
            return refuse_type(self, value, key);
        }
        if (entry->integer == 1 && key->effect != NULL && (key->effect->mask & ~self->system->effects)) {
            return refuse_value(self, value, key, ", which the system has not", MCT_ERROR_UNSUITED);
        }
        mct_key_set(&self->scene, key, (double)entry->integer);
        return MCT_OK;
    case MCT_FIELD_CHOICE:
        return entry->kind == MCT_TOML_TEXT ||
                       (entry->kind == MCT_TOML_BOOLEAN && key->effect != NULL && key->effect->is_switch)
                   ? set_choice(self, value, key)
                   : refuse_type(self, value, key);
    case MCT_FIELD_TEXT:
        return entry->kind == MCT_TOML_TEXT ? set_text(self, value, key) : refuse_type(self, value, key);
    case MCT_FIELD_LIST:
        return entry->kind == MCT_TOML_LIST ? set_list(self, value, key) : refuse_type(self, value, key);
    }
    if (!mct_field_allows(&key->field, entry->number)) {
        return refuse_out_of_range(self, value, key, entry->number);
    }
    mct_key_set(&self->scene, key, entry->number);
    return MCT_OK;
}

/*
 * A vector: one list for the keys that its components have on their own, gravity = [0, -9.81, 0] for gravity_1,
 * gravity_2 and gravity_3; a matrix is a list of its rows. Each is set as if it stood alone.
 */
static mct_status set_components(reader *self, given value, int table, const mct_toml_entry *list,
                                 int *number)
{
    mct_toml_entry item;
    size_t position = 0;
    mct_status status = MCT_OK;
    while (status == MCT_OK && mct_toml_item(list, &position, &item)) {
        if (item.kind == MCT_TOML_LIST) {
            status = set_components(self, value, table, &item, number);
            continue;
        }
        const mct_scene_key key = component_at(table, self->system, value.entry->key, *number);
        item.table = value.entry->table;
        item.key = mct_text_span(key.field.name);
        item.line = value.entry->line;
        const given component = {&item, value.origin};
        status = set_value(self, component, &key);
        ++*number;
    }
    return status;
}

/* Numbers in a list and in the lists that it holds. */
static int count_numbers(const mct_toml_entry *list)
{
    mct_toml_entry item;
    size_t position = 0;
    int count = 0;
    while (mct_toml_item(list, &position, &item)) {
        count += item.kind == MCT_TOML_LIST ? count_numbers(&item) : 1;
    }
    return count;
}

static mct_status set_vector(reader *self, given value, int table)
{
    const int components = component_count(table, self->system, value.entry->key);
    const int count = value.entry->kind == MCT_TOML_LIST ? count_numbers(value.entry) : -1;
    if (count != components) {
        begin_key(self, value);
        mct_message_add(self->why, "found ");
        add_shown(self->why, value.entry->source);
        mct_message_add(self->why, "; allowed a list of ");
        mct_message_add_integer(self->why, components);
        mct_message_add(self->why, ":");
        for (int i = 0; i < components; i++) {
            mct_message_add(self->why, i > 0 ? ", " : " ");
            mct_message_add(self->why, component_at(table, self->system, value.entry->key, i).field.name);
        }
        return MCT_ERROR_RANGE;
    }
    int number = 0;
    return set_components(self, value, table, value.entry, &number);
}

/* Whether what is written sets a key or a part of it: it is its name, or that of its vector, or of a component. */
static bool gives(mct_span written, mct_span key)
{
    return mct_span_equal(written, key) || is_component(written, key) || is_component(key, written);
}

/* Remembers which parameters are given. */
static void note_given(reader *self, int table, mct_span written)
{
    for (int i = 0; table == MCT_TABLE_PARAMETERS && i < mct_key_count(table, self->system); i++) {
        const mct_scene_key key = mct_key_at(table, self->system, i);
        if (gives(written, mct_text_span(key.field.name))) {
            self->scene.given |= UINT32_C(1) << i;
        }
    }
}

static mct_status set_entry(reader *self, given value)
{
    mct_scene_key key;
    const int table = find_table(value.entry->table);
    if (table < 0) {
        return refuse_table(self, value.origin, value.entry->line, value.entry->table);
    }
    note_given(self, table, value.entry->key);
    if (find_key(table, self->system, value.entry->key, &key)) {
        return set_value(self, value, &key);
    }
    return component_count(table, self->system, value.entry->key) > 0 ? set_vector(self, value, table)
                                                                      : refuse_key(self, value, table);
}

/* --- overrides --- */

/* A text or a name may go without quotes, as a shell leaves it. */
static mct_status read_override(const reader *self, const mct_override *given_override, mct_toml_entry *entry)
{
    const char *const assignment = given_override->assignment != NULL ? given_override->assignment : "";
    const mct_status status = mct_toml_split(assignment, given_override->origin, entry, self->why);
    if (status != MCT_OK) {
        return status;
    }
    mct_scene_key key;
    const int table = find_table(entry->table);
    const bool is_key = table >= 0 && find_key(table, self->system, entry->key, &key);
    const bool known = is_key || (table >= 0 && component_count(table, self->system, entry->key) > 0);
    const char first = entry->source.length > 0 ? entry->source.start[0] : '\0';
    entry->is_bare =
        !known || (is_key && (key.field.kind == MCT_FIELD_TEXT || key.field.kind == MCT_FIELD_CHOICE) &&
                   first != '"' && first != '\'');
    if (entry->is_bare) { /* an unknown key is refused as such, whatever its value */
        entry->kind = MCT_TOML_TEXT;
        return MCT_OK;
    }
    return mct_toml_read_value(given_override->origin, entry, self->why);
}

/* The last value given for a key, NULL when none is; an override is split into `storage`. */
static given find_given(const reader *self, const char *table, const char *key, mct_toml_entry *storage)
{
    given found = {NULL, NULL};
    for (int i = self->override_count - 1; i >= 0; i--) {
        const mct_override *const candidate = &self->overrides[i];
        if (read_override(self, candidate, storage) == MCT_OK && mct_span_is(storage->table, table) &&
            gives(storage->key, mct_text_span(key))) {
            found.entry = storage;
            found.origin = candidate->origin != NULL ? candidate->origin : "";
            return found;
        }
    }
    for (int i = 0; i < self->toml.entry_count && found.entry == NULL; i++) {
        const mct_toml_entry *const entry = &self->toml.entries[i];
        if (mct_span_is(entry->table, table) && gives(entry->key, mct_text_span(key))) {
            found.entry = entry;
        }
    }
    return found;
}

/* --- the whole scene --- */

/* Ahead of all else: a misspelt assignment shall not be reported as a value that is missing. */
static mct_status check_overrides(const reader *self)
{
    mct_status status = MCT_OK;
    for (int i = 0; i < self->override_count && status == MCT_OK; i++) {
        mct_toml_entry entry;
        const char *const assignment = self->overrides[i].assignment;
        status = mct_toml_split(assignment != NULL ? assignment : "", self->overrides[i].origin, &entry,
                                self->why);
    }
    return status;
}

static mct_status read_system(reader *self)
{
    mct_toml_entry storage;
    mct_scene_key key;
    self->system = mct_systems[0]; /* stands in until the scene's own is known */
    const mct_span name = mct_text_span("system");
    (void)find_key(0, self->system, name, &key);
    const given value = find_given(self, "scene", "system", &storage);
    if (value.entry == NULL) {
        begin_place(self, NULL, 0);
        mct_message_add(self->why, "scene.system: found none; allowed ");
        mct_message_add_allowed(self->why, &key, self->system);
        return MCT_ERROR_RANGE;
    }
    const mct_status status = set_value(self, value, &key);
    if (status == MCT_OK) {
        self->system = mct_systems[self->scene.system];
        mct_scene_defaults(&self->scene, self->scene.system);
    }
    return status;
}

static mct_status set_all(reader *self)
{
    mct_status status = MCT_OK;
    for (int i = 0; i < self->toml.table_count && status == MCT_OK; i++) {
        const mct_toml_table *const table = &self->toml.tables[i];
        status = find_table(table->name) >= 0 ? MCT_OK : refuse_table(self, NULL, table->line, table->name);
    }
    for (int i = 0; i < self->toml.entry_count && status == MCT_OK; i++) {
        const given value = {&self->toml.entries[i], NULL};
        status = set_entry(self, value);
    }
    for (int i = 0; i < self->override_count && status == MCT_OK; i++) {
        mct_toml_entry entry;
        status = read_override(self, &self->overrides[i], &entry);
        if (status == MCT_OK) {
            const char *const origin = self->overrides[i].origin;
            const given value = {&entry, origin != NULL ? origin : ""};
            status = set_entry(self, value);
        }
    }
    return status;
}

/* What a scene would need to have a state. */
static const char *what_brings_state(const mct_system *system, int index)
{
    if (system->lists_coordinates) {
        return "a longer list";
    }
    if (!mct_state_is_phase(system, index)) {
        return "effects.motor = inductive and an inductance";
    }
    return (system->effects & MCT_FORCING) ? "effects.forcing = true" : "effects.base_motion = true";
}

/* Refuses keys that nothing would read: a writer who gives one expects it to act. */
static mct_status refuse_idle_keys(const reader *self)
{
    mct_toml_entry storage;
    for (int table = 0; table < MCT_TABLE_COUNT; table++) {
        for (int i = 0; i < mct_key_count(table, self->system); i++) {
            const mct_scene_key key = mct_key_at(table, self->system, i);
            const char *const name = key.field.name;
            const bool is_input = mct_text_equal(mct_table_name(table), "input");
            const bool idle_input = is_input && !mct_input_reads(self->scene.input, name);
            const bool idle_state = table == MCT_TABLE_INITIAL && i >= mct_state_count(&self->scene);
            if (!idle_input && !idle_state) {
                continue;
            }
            const given value = find_given(self, mct_table_name(table), name, &storage);
            if (value.entry == NULL) {
                continue;
            }
            begin_key(self, value);
            if (idle_state) {
                mct_message_add(self->why, "found a state that the scene has not; allowed with ");
                mct_message_add(self->why, what_brings_state(self->system, i));
            } else {
                const mct_scene_key selector = mct_key_at(table, self->system, 0);
                const char *between = "";
                mct_message_add(self->why, "found with input.kind = ");
                mct_message_add(self->why, mct_choice_name(&selector.field, self->scene.input));
                mct_message_add(self->why, ", which does not read it; allowed with ");
                for (int32_t kind = 0; mct_choice_name(&selector.field, kind) != NULL; kind++) {
                    if (mct_input_reads(kind, name)) {
                        mct_message_add(self->why, between);
                        mct_message_add(self->why, mct_choice_name(&selector.field, kind));
                        between = " or ";
                    }
                }
            }
            return MCT_ERROR_UNSUITED;
        }
    }
    return MCT_OK;
}

/* A bound of the motor's voltage, asked for where there is no motor. */
static mct_status refuse_idle_saturation(const reader *self)
{
    mct_toml_entry storage;
    const given value = find_given(self, "effects", "saturation", &storage);
    if (value.entry == NULL || !(self->scene.effects & MCT_SATURATION) || (self->scene.effects & MCT_MOTOR)) {
        return MCT_OK;
    }
    begin_key(self, value);
    mct_message_add(self->why, "found ");
    add_shown(self->why, value.entry->source);
    mct_message_add(self->why,
                    " with effects.motor = off, which excludes it: a force or torque has no supply; "
                    "allowed off, or a motor");
    return MCT_ERROR_UNSUITED;
}

static mct_status examine(const reader *self)
{
    mct_blame blame;
    mct_message sentence;
    const mct_status status = mct_scene_examine(&self->scene, &blame, &sentence);
    if (status != MCT_OK) {
        mct_toml_entry storage;
        const given value = find_given(self, blame.table, blame.key, &storage);
        begin_place(self, value.origin, value.entry != NULL ? value.entry->line : 0);
        mct_message_add(self->why, blame.table);
        mct_message_add(self->why, ".");
        mct_message_add(self->why, blame.key);
        mct_message_add(self->why, ": ");
        mct_message_add(self->why, sentence.text);
    }
    return status;
}

mct_status mct_scene_read(const char *text, size_t length, const char *origin, const mct_override *overrides,
                          int override_count, mct_scene *scene, mct_message *why)
{
    reader self;
    memset(&self.scene, 0, sizeof self.scene);
    self.origin = origin != NULL ? origin : "scene";
    self.overrides = overrides;
    self.override_count = overrides != NULL ? override_count : 0;
    self.why = why;
    mct_status status =
        mct_toml_read(text != NULL ? text : "", text != NULL ? length : 0, self.origin, &self.toml, why);
    status = status != MCT_OK ? status : check_overrides(&self);
    status = status != MCT_OK ? status : read_system(&self);
    status = status != MCT_OK ? status : set_all(&self);
    if (status == MCT_OK) {
        mct_toml_entry storage;
        self.scene.automatic = self.scene.stepper == MCT_STEPPER_COUNT;
        if (self.scene.automatic || find_given(&self, "scene", "stepper", &storage).entry == NULL) {
            self.scene.stepper = mct_best_stepper(&self.scene);
        }
        status = refuse_idle_keys(&self);
        status = status != MCT_OK ? status : refuse_idle_saturation(&self);
    }
    status = status != MCT_OK ? status : examine(&self);
    if (status == MCT_OK) {
        *scene = self.scene;
        mct_message_clear(why);
    }
    return status;
}

/* --- variation --- */

/*
 * What is known exactly enough to be left alone: gravity, lengths, counts of teeth, the supply. Masses,
 * inertias, the motor and friction are not.
 */
static bool is_certain(const mct_field *parameter)
{
    static const char *const units[] = {"m/s^2", "m", "", "V"};
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        if (mct_text_equal(units[i], parameter->unit)) {
            return true;
        }
    }
    return false;
}

/* Uniform in [-1, 1), a function of the two numbers alone. */
static double uniform(int32_t seed, int index)
{
    const uint64_t stream = mct_mix((uint64_t)(uint32_t)seed + MCT_MIX_STEP);
    const uint64_t bits = mct_mix(stream + MCT_MIX_STEP * ((uint64_t)index + 1));
    return (double)(int64_t)(bits >> 11) * 0x1p-52 - 1; /* 53 bits: exact */
}

void mct_scene_vary(const mct_scene *scene, mct_scene *plant)
{
    const mct_system *const system = mct_systems[scene->system];
    *plant = *scene;
    for (int i = 0; i < system->parameter_count; i++) {
        const mct_field *const field = &system->parameters[i];
        if (is_certain(field)) {
            continue;
        }
        const double varied =
            scene->parameters[i] * (1 + scene->variation_spread * uniform(scene->variation_seed, i));
        const double raised = varied < field->minimum ? field->minimum : varied;
        plant->parameters[i] = raised > field->maximum ? field->maximum : raised;
    }
}

/*
 * Drawn argument lists for the command: the parser of options, and every verb behind it.
 *
 * Input: words, a byte of kind each and what it takes.
 */
#include <string.h>

#include "fuzz/command.h"
#include "fuzz/fuzz.h"
#include "mctau/stepper.h"
#include "verbs.h"

enum { MOST_WORDS = 24, LONGEST_WORD = 256 };

static const verb *const verbs[] = {&verb_run,  &verb_mct,  &verb_list,   &verb_replay, &verb_drive,
                                    &verb_cost, &verb_pick, &verb_advise, &verb_hard};
enum { VERBS = (int)(sizeof verbs / sizeof verbs[0]) };

/* What may stand behind an option, or anywhere. */
static const char *const values[] = {
    "0",       "1",    "-1",   "0.001", "0.002", "0.01",  "1e-9",    "1e9",   "1e400",
    "nan",     "-inf", "true", "",      "-",     "--",    "double",  "float", "auto",
    "rk4",     "seed", "ring", "sim",   "\"x\"", "[1,2]", "out.csv", "none",  "candump:bus.log",
    "viscous", "h",    "--set"};
enum { VALUES = (int)(sizeof values / sizeof values[0]) };

typedef struct {
    char text[MOST_WORDS][LONGEST_WORD];
    char *argv[MOST_WORDS + 1];
    int argc;
} line;

static const option *draw_option(fuzz_bytes *input, const verb *of)
{
    int count = 0;
    while (of->options[count].name != NULL) {
        count++;
    }
    return count > 0 ? &of->options[fuzz_byte(input) % count] : &of->options[0];
}

/* "table.key=value", of a key that there is. */
static void draw_assignment(fuzz_bytes *input, char *word)
{
    const mct_scene_table *table = &mct_scene_tables[fuzz_byte(input) % MCT_SCENE_TABLE_COUNT];
    const mct_field *field =
        &table->fields[fuzz_byte(input) % (table->field_count > 0 ? table->field_count : 1)];
    const int number = fuzz_byte(input);
    const char *value = values[number % VALUES];
    if (field->choices != NULL && number >= VALUES) {
        int count = 0;
        while (field->choices[count] != NULL) {
            count++;
        }
        value = field->choices[number % count];
    }
    snprintf(word, LONGEST_WORD, "%s.%s=%s", table->name, table->field_count > 0 ? field->name : "x", value);
}

/* Any bytes but those that lead out of the folder. */
static void draw_text(fuzz_bytes *input, char *word)
{
    int length = 0;
    for (uint8_t byte = fuzz_byte(input); byte != 0; byte = fuzz_byte(input)) {
        if (byte != '/' && byte != '\\' && length < LONGEST_WORD - 1) {
            word[length++] = (char)byte;
        }
    }
    word[length] = '\0';
}

static void draw_word(fuzz_bytes *input, const verb *of, char *word)
{
    switch (fuzz_byte(input) % 8) {
    case 0:
        snprintf(word, LONGEST_WORD, "%s", verbs[fuzz_byte(input) % VERBS]->name);
        return;
    case 1:
    case 2:
        snprintf(word, LONGEST_WORD, "--%s", draw_option(input, of)->name);
        return;
    case 3: {
        const option *row = draw_option(input, of);
        snprintf(word, LONGEST_WORD, "--%s=%s", row->name, values[fuzz_byte(input) % VALUES]);
        return;
    }
    case 4:
        snprintf(word, LONGEST_WORD, "%s", fuzz_command_file(fuzz_byte(input) % FUZZ_COMMAND_FILES));
        return;
    case 5:
        draw_assignment(input, word);
        return;
    case 6:
        snprintf(word, LONGEST_WORD, "%s", values[fuzz_byte(input) % VALUES]);
        return;
    default:
        draw_text(input, word);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static line self;
    fuzz_bytes input = {data, data + size};
    const verb *of = verbs[fuzz_byte(&input) % VERBS];
    fuzz_command_begin();
    memset(&self, 0, sizeof self);
    strcpy(self.text[self.argc++], "mctau");
    strcpy(self.text[self.argc++], of->name);
    while (input.at < input.end && self.argc < MOST_WORDS) {
        draw_word(&input, of, self.text[self.argc++]);
    }
    for (int i = 0; i < self.argc; i++) {
        self.argv[i] = self.text[i];
    }
    const int exit_code = fuzz_command(self.argc, self.argv);
    const char *said = fuzz_command_said();
    FUZZ_RULE(exit_code >= 0 && exit_code <= 3, "an exit code that is documented: %d", exit_code);
    FUZZ_RULE(exit_code < 2 || strncmp(said, "mctau: ", 7) == 0, "a refusal has a reason: %d, %s", exit_code,
              said);
    return 0;
}

/* Each verb with each of its options. */
size_t fuzz_seed(int number, uint8_t *out)
{
    for (int i = 0; i < VERBS; i++) {
        for (int j = 0; verbs[i]->options[j].name != NULL; j++) {
            if (number-- > 0) {
                continue;
            }
            const bool is_log = verbs[i] == &verb_replay;
            const uint8_t words[] = {
                (uint8_t)i, 4, (uint8_t)(is_log ? 5 : j % 3), 1, (uint8_t)j, 6, (uint8_t)(j % VALUES), 1, 0,
                6,          4};
            memcpy(out, words, sizeof words);
            return sizeof words;
        }
    }
    return 0;
}

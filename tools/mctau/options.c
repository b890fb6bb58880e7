#include "options.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "mctau/stepper.h"
#include "say.h"

enum { HELP = 256, FIRST_OPTION = 512 }; /* values that getopt_long gives */

/* --- help --- */

static const mct_field *find_field(const char *key)
{
    for (int i = 0; i < MCT_SCENE_TABLE_COUNT; i++) {
        const mct_scene_table *table = &mct_scene_tables[i];
        const size_t length = strlen(table->name);
        if (strncmp(key, table->name, length) != 0 || key[length] != '.') {
            continue;
        }
        for (int j = 0; j < table->field_count; j++) {
            if (strcmp(table->fields[j].name, key + length + 1) == 0) {
                return &table->fields[j];
            }
        }
    }
    return NULL;
}

static void print_choices(const mct_field *field, FILE *file)
{
    fputs("; one of", file);
    if (field->choices == NULL) {
        for (int i = 0; i < MCT_STEPPER_COUNT; i++) {
            fprintf(file, " %s", mct_steppers[i].name);
        }
        fputs(" auto", file);
    }
    for (int i = 0; field->choices != NULL && field->choices[i] != NULL; i++) {
        fprintf(file, " %s", field->choices[i]);
    }
}

static bool is_letter(const option *self)
{
    return self->name[1] == '\0';
}

static void print_option(const option *self, FILE *file)
{
    char head[64];
    snprintf(head, sizeof head, "%s%s %s", is_letter(self) ? "-" : "--", self->name,
             self->argument != NULL ? self->argument : "");
    fprintf(file, "  %-24s ", head);
    const mct_field *field = self->key != NULL ? find_field(self->key) : NULL;
    fputs(self->doc != NULL ? self->doc : field != NULL ? field->doc : "", file);
    if (field == NULL) {
        fputc('\n', file);
        return;
    }
    if (field->kind == MCT_FIELD_CHOICE) {
        print_choices(field, file);
    } else if (field->unit[0] != '\0') {
        fprintf(file, " [%s]", field->unit);
    }
    const bool tells_default = self->doc != NULL && strstr(self->doc, "left out") != NULL;
    if (field->kind == MCT_FIELD_REAL && !tells_default) {
        fprintf(file, "; default %g", field->standard);
    }
    fprintf(file, "\n  %-24s = --set %s=%s\n", "", self->key,
            self->argument != NULL ? self->argument : "true");
}

void print_help(const verb *self, FILE *file)
{
    fprintf(file, "usage: mctau %s%s%s [options]\n\n%s\n\nOptions\n", self->name,
            self->operand != NULL ? " " : "", self->operand != NULL ? self->operand : "", self->text);
    for (const option *row = self->options; row->name != NULL; row++) {
        print_option(row, file);
    }
    fprintf(file, "  %-24s this text\n\nExamples\n%s\nExit codes\n%s", "--help", self->examples,
            self->exit_codes);
}

/* --- parser --- */

const char *arguments_value(const arguments *self, const char *name)
{
    for (int i = 0; self->verb->options[i].name != NULL; i++) {
        if (strcmp(self->verb->options[i].name, name) == 0) {
            return self->values[i];
        }
    }
    return NULL;
}

/* "--duration", as messages of the scene reader shall call it; owned by the arguments. */
static char *joined(const char *a, const char *b, const char *c)
{
    const size_t size = strlen(a) + strlen(b) + strlen(c) + 1;
    char *text = need_memory(malloc(size));
    snprintf(text, size, "%s%s%s", a, b, c);
    return text;
}

static bool add_override(arguments *self, const option *row, const char *value, int *exit_code)
{
    if (strpbrk(value, "\r\n") != NULL) {
        *exit_code =
            say(EXIT_USAGE, "--%s: found a line break within its argument; allowed one line", row->name);
        return false;
    }
    const size_t size = (size_t)(self->override_count + 1) * sizeof *self->overrides;
    self->overrides = need_memory(realloc(self->overrides, size));
    const bool any = row->key[0] == '\0';
    self->overrides[self->override_count++] = (mct_override){
        .assignment = any ? joined(value, "", "") : joined(row->key, "=", value),
        .origin = joined("--", row->name, ""),
    };
    return true;
}

void arguments_free(arguments *self)
{
    for (int i = 0; i < self->override_count; i++) {
        free((char *)(uintptr_t)self->overrides[i].assignment);
        free((char *)(uintptr_t)self->overrides[i].origin);
    }
    free(self->overrides);
}

static int complain(const char *name, char **argv, int wrong)
{
    const char *what = argv[optind - 1];
    if (wrong == ':') {
        return say(EXIT_USAGE, "%s: %s needs an argument; mctau %s --help shows which", name, what, name);
    }
    if (optopt >= FIRST_OPTION || optopt == HELP) {
        return say(EXIT_USAGE, "%s: %s takes no argument", name, what);
    }
    return say(EXIT_USAGE, "%s: unknown or ambiguous option %s; mctau %s --help lists all", name, what, name);
}

static bool take_operand(arguments *self, int argc, char **argv, int *exit_code)
{
    const verb *asked = self->verb;
    const int allowed = asked->operand != NULL ? 1 : 0;
    const bool any = allowed == 1 && strstr(asked->operand, "...") != NULL;
    self->operands = argv + optind;
    self->operand_count = argc - optind;
    if (argc - optind > allowed && !any) {
        *exit_code =
            say(EXIT_USAGE, "%s: found one argument too many: %s; usage: mctau %s %s [options]", asked->name,
                argv[optind + allowed], asked->name, asked->operand != NULL ? asked->operand : "");
        return false;
    }
    if (argc > optind) {
        self->operand = argv[optind];
    } else if (allowed == 1 && asked->operand[0] != '[') {
        *exit_code =
            say(EXIT_USAGE, "%s: no %s given\nusage: mctau %s %s [options]\n%smctau %s --help tells more",
                asked->name, asked->operand, asked->name, asked->operand, asked->examples, asked->name);
        return false;
    }
    return true;
}

/* What getopt_long() has found, a letter being the row that it names. */
static int row_of(const verb *asked, int found)
{
    for (int i = 0; asked->options[i].name != NULL; i++) {
        if (is_letter(&asked->options[i]) && found == asked->options[i].name[0]) {
            return FIRST_OPTION + i;
        }
    }
    return found;
}

bool arguments_read(arguments *self, const verb *asked, int argc, char **argv, int *exit_code)
{
    struct option table[MAX_OPTIONS + 2];
    char letters[2 * MAX_OPTIONS + 3] = ":h";
    int count = 0;
    memset(self, 0, sizeof *self);
    self->verb = asked;
    for (; asked->options[count].name != NULL; count++) {
        const option *row = &asked->options[count];
        const int has_argument = row->argument != NULL ? required_argument : no_argument;
        table[count] = (struct option){row->name, has_argument, NULL, FIRST_OPTION + count};
        if (is_letter(row)) {
            strcat(strcat(letters, row->name), has_argument == required_argument ? ":" : "");
        }
    }
    table[count] = (struct option){"help", no_argument, NULL, HELP};
    table[count + 1] = (struct option){NULL, 0, NULL, 0};
    opterr = 0;
    for (;;) {
        const int found = row_of(asked, getopt_long(argc, argv, letters, table, NULL));
        if (found == -1) {
            return take_operand(self, argc, argv, exit_code);
        }
        if (found == HELP || found == 'h') {
            print_help(asked, stdout);
            *exit_code = EXIT_WELL;
            return false;
        }
        if (found < FIRST_OPTION) {
            *exit_code = complain(asked->name, argv, found);
            return false;
        }
        const option *row = &asked->options[found - FIRST_OPTION];
        const char *value = optarg != NULL ? optarg : "";
        self->values[found - FIRST_OPTION] = value;
        const char *meaning = row->argument != NULL ? value : "true";
        if (row->key != NULL && !add_override(self, row, meaning, exit_code)) {
            return false;
        }
    }
}

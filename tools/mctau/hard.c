/* mctau hard: what breaks common schemes, and what becomes of it here, by every stepper. */
#include "tools/hard/hard.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "candidates.h"
#include "json.h"
#include "say.h"
#include "scene_file.h"
#include "verbs.h"

static const option options[] = {
    {"precision", "NAME", NULL, "double or float; default: the first that this build has"},
    {"full", NULL, NULL, "long cases at their full length: 1e8 steps; takes minutes"},
    OPTION_JSON,
    {NULL, NULL, NULL, NULL},
};

static int run_verb(const arguments *given);

const verb verb_hard = {
    .name = "hard",
    .doc = "what breaks common schemes, and what every stepper makes of it",
    .operand = "[CASE...]",
    .text =
        "Runs hard cases, all or those with the given numbers. Each has a rule, a figure by which it is "
        "judged, and "
        "a\n"
        "criterion; it is run as a scene that asks for nothing special, with every stepper, and by what is "
        "commonly done.\n"
        "First a line a case: the figure of the scene as it stands and its criterion; the figure of what is "
        "commonly done.\n"
        "Then the matrix stepper x case, and why the library refuses what it refuses.",
    .options = options,
    .examples = "  mctau hard\n"
                "  mctau hard 1 9 29\n"
                "  mctau hard --precision float --json\n",
    .exit_codes = "  0  every case meets its criterion, or is refused where that is an answer\n"
                  "  1  one does not\n"
                  "  2  the command line is wrong\n",
    .run = run_verb,
};

typedef struct {
    const hard_case *about;
    hard_result results[HARD_METHOD_COUNT];
} row;

typedef struct {
    const mct_runner *runner;
    row *rows;
    int count;
    bool is_full;
} matrix;

static hard_verdict verdict_of(const matrix *self, const row *one, int method)
{
    return self->runner->hard_judge(one->about, &one->results[method]);
}

static bool is_well(const matrix *self, const row *one)
{
    return hard_is_well(one->about, verdict_of(self, one, HARD_LIBRARY));
}

static int exit_code_of(const matrix *self)
{
    for (int i = 0; i < self->count; i++) {
        if (!is_well(self, &self->rows[i])) {
            return EXIT_CHECK_FAILED;
        }
    }
    return EXIT_WELL;
}

static const char *method_name(int method)
{
    return method < MCT_STEPPER_COUNT ? mct_steppers[method].name
           : method == HARD_LIBRARY   ? "mctau"
                                      : "naive";
}

/* --- JSON --- */

static void print_json(const matrix *self, FILE *file)
{
    static const char *const verdicts[] = {"pass", "miss", "not finite", "refused", "not judged"};
    json out = json_begin(file, "mctau.hard/1");
    json_text(&out, "precision", self->runner->precision);
    json_list(&out, "cases");
    for (int i = 0; i < self->count; i++) {
        const row *one = &self->rows[i];
        const hard_case *about = one->about;
        const double criterion = self->runner->hard_criterion(about);
        json_object(&out, NULL);
        json_integer(&out, "number", about->number);
        json_text(&out, "rule", about->rule);
        json_text(&out, "naive", about->naive);
        json_text(&out, "remedy", about->remedy);
        json_text(&out, "measure", about->measure);
        json_number(&out, "seconds",
                    self->is_full && about->full_seconds > 0 ? about->full_seconds : about->seconds);
        json_number(&out, "criterion", criterion > 0 ? criterion : (double)NAN);
        json_boolean(&out, "well", is_well(self, one));
        json_list(&out, "methods");
        for (int method = 0; method < HARD_METHOD_COUNT; method++) {
            const hard_result *result = &one->results[method];
            if (result->is_tried) {
                json_object(&out, NULL);
                json_text(&out, "method", method_name(method));
                json_text(&out, "verdict", verdicts[verdict_of(self, one, method)]);
                json_number(&out, "figure", result->is_refused ? (double)NAN : result->error);
                json_text(&out, "why", result->is_refused ? result->why.text : NULL);
                if (method == HARD_LIBRARY) {
                    const bool has_stepper = about->scene != NULL && result->stepper >= 0;
                    json_text(&out, "stepper", has_stepper ? mct_steppers[result->stepper].name : NULL);
                }
                json_end_object(&out);
            }
        }
        json_end_list(&out);
        json_end_object(&out);
    }
    json_end_list(&out);
    json_finish(&out);
}

/* --- for people --- */

enum { CELL = 8 };

/* "2e-12", "inf"; what nothing may exceed is as good as 0 */
static void figure_of(double figure, char *text)
{
    snprintf(text, CELL, figure < 1e-99 ? "0" : "%.0e", figure);
}

/* "2e-12", "2e-12!" for a miss, "inf", "-" where refused */
static const char *cell_of(const matrix *self, const row *one, int method, char *text)
{
    const hard_result *result = &one->results[method];
    if (result->is_refused) {
        return "-";
    }
    figure_of(result->error, text);
    if (verdict_of(self, one, method) == HARD_MISSED) {
        strcat(text, "!");
    }
    return text;
}

/* A paragraph in lines of at most 110 columns: the first has begun, the others are indented. */
static void print_wrapped(const char *text, size_t length, size_t column, size_t indent)
{
    for (size_t word; length > 0; text += word, length -= word) {
        word = strcspn(text + 1, " ") + 1;
        word = word < length ? word : length;
        if (column + word > 110) {
            printf("\n%*s", (int)indent, "");
            column = indent;
        }
        column += word;
        printf("%.*s", (int)word, text);
    }
    printf("\n");
}

static void print_rules(const matrix *self)
{
    char cell[CELL + 1];
    printf("%4s %8s %9s %8s  %s\n", "case", "figure", "allowed", "naive", "rule");
    for (int i = 0; i < self->count; i++) {
        const row *one = &self->rows[i];
        const double criterion = self->runner->hard_criterion(one->about);
        printf("%4d %8s ", one->about->number, cell_of(self, one, HARD_LIBRARY, cell));
        figure_of(criterion, cell);
        printf("%9s ", criterion > 0 ? cell : "any");
        figure_of(one->results[HARD_NAIVE].error, cell);
        printf("%8s  ", cell);
        print_wrapped(one->about->rule, strlen(one->about->rule), 34, 33);
    }
}

/* Whether any case has a figure of the stepper. */
static bool is_shown(const matrix *self, int stepper)
{
    for (int i = 0; i < self->count; i++) {
        if (self->rows[i].results[stepper].is_tried && !self->rows[i].results[stepper].is_refused) {
            return true;
        }
    }
    return false;
}

static void print_matrix(const matrix *self)
{
    printf("\n%4s", "case");
    for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
        if (is_shown(self, stepper)) {
            printf(" %*s", CELL - 1, mct_steppers[stepper].name);
        }
    }
    printf("\n");
    for (int i = 0; i < self->count; i++) {
        const row *one = &self->rows[i];
        if (one->about->scene == NULL) {
            continue;
        }
        printf("%4d", one->about->number);
        for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
            char cell[CELL + 1];
            if (is_shown(self, stepper)) {
                const bool is_own = stepper == one->results[HARD_LIBRARY].stepper;
                const int width = CELL - 1 - (is_own ? 1 : 0);
                printf(" %*s%s", width, cell_of(self, one, stepper, cell), is_own ? "*" : "");
            }
        }
        printf("\n");
    }
}

/* What a refusal says behind the name of what was refused, without what is allowed instead. */
static const char *reason_of(const hard_result *result, int method)
{
    const char *name = strstr(result->why.text, method_name(method));
    return name != NULL && method < MCT_STEPPER_COUNT ? name + strlen(method_name(method)) : result->why.text;
}

static bool is_same_reason(const row *one, int a, int b)
{
    const char *first = reason_of(&one->results[a], a), *second = reason_of(&one->results[b], b);
    return one->results[b].is_refused && strcspn(first, ";") == strcspn(second, ";") &&
           strncmp(first, second, strcspn(first, ";")) == 0;
}

/* One paragraph for all methods that are refused for the same reason. */
static void print_reasons(const row *one)
{
    bool is_told[HARD_METHOD_COUNT] = {false};
    for (int method = 0; method < HARD_METHOD_COUNT; method++) {
        if (!one->results[method].is_refused || is_told[method]) {
            continue;
        }
        char names[256] = "";
        for (int other = method; other < HARD_METHOD_COUNT; other++) {
            if (is_same_reason(one, method, other)) {
                strcat(strcat(names, " "), other == HARD_LIBRARY ? "*" : method_name(other));
                is_told[other] = true;
            }
        }
        const char *reason = reason_of(&one->results[method], method);
        reason += strncmp(reason, ", which ", 8) == 0 ? 8 : 0;
        printf("%4d %s: ", one->about->number, names);
        print_wrapped(reason, strcspn(reason, ";"), 7 + strlen(names), 9);
    }
}

static void print_text(const matrix *self)
{
    printf("Hard cases, %s: the scene as it stands, and what is commonly done\n\n", self->runner->precision);
    print_rules(self);
    print_matrix(self);
    printf("\nCells are figures, smaller is better. *: what a scene gets that does not ask, or would name; "
           "!: misses "
           "the\ncriterion; inf: not finite, or a tick was rejected; -: refused, because:\n");
    for (int i = 0; i < self->count; i++) {
        print_reasons(&self->rows[i]);
    }
    printf("\n");
    for (int i = 0; i < self->count; i++) {
        if (!is_well(self, &self->rows[i])) {
            printf("Case %d misses its criterion.\n", self->rows[i].about->number);
        }
    }
    if (exit_code_of(self) == EXIT_WELL) {
        printf("%s meets its criterion.\n", self->count == 1 ? "The case" : "Every case");
    }
}

/* --- all of it --- */

static int complain(const mct_runner *runner, const char *found)
{
    char allowed[1024] = "";
    for (const hard_case *one = runner->hard_case_after(0); one != NULL;
         one = runner->hard_case_after(one->number)) {
        const size_t length = strlen(allowed);
        snprintf(allowed + length, sizeof allowed - length, "%s%d", length > 0 ? ", " : "", one->number);
    }
    return say(EXIT_USAGE, "hard: found case %s; allowed %s", found, allowed);
}

static bool is_asked(const arguments *given, const hard_case *about)
{
    bool asked = given->operand_count == 0;
    for (int i = 0; i < given->operand_count; i++) {
        asked = asked || strtol(given->operands[i], NULL, 10) == about->number;
    }
    return asked;
}

/* The case of an operand; NULL: there is none. */
static const hard_case *find_case(const mct_runner *runner, const char *operand)
{
    char *end;
    const long number = strtol(operand, &end, 10);
    const hard_case *one = number > 0 && number < 1000000 && *end == '\0' && operand[0] >= '0'
                               ? runner->hard_case_after((int)number - 1)
                               : NULL;
    return one != NULL && one->number == number ? one : NULL;
}

static void run_cases(matrix *self, const arguments *given)
{
    const bool progress = isatty(STDERR_FILENO);
    for (const hard_case *one = self->runner->hard_case_after(0); one != NULL;
         one = self->runner->hard_case_after(one->number)) {
        if (is_asked(given, one)) {
            self->rows = need_memory(realloc(self->rows, (size_t)(self->count + 1) * sizeof *self->rows));
            row *next = &self->rows[self->count++];
            next->about = one;
            if (progress) {
                fprintf(stderr, "\r\033[K%d %s", one->number, one->rule);
            }
            self->runner->hard_run_case(one, self->is_full, next->results);
        }
    }
    if (progress) {
        fprintf(stderr, "\r\033[K");
    }
}

static int run_verb(const arguments *given)
{
    int precision;
    const int exit_code = read_precision(arguments_value(given, "precision"), &precision);
    if (exit_code != 0) {
        return exit_code;
    }
    matrix self = {.runner = find_runner(precision), .is_full = arguments_value(given, "full") != NULL};
    for (int i = MCT_PRECISION_DOUBLE; self.runner == NULL && i <= MCT_PRECISION_FLOAT; i++) {
        self.runner = find_runner(i);
    }
    for (int i = 0; i < given->operand_count; i++) {
        if (find_case(self.runner, given->operands[i]) == NULL) {
            return complain(self.runner, given->operands[i]);
        }
    }
    run_cases(&self, given);
    if (arguments_value(given, "json") != NULL) {
        print_json(&self, stdout);
    } else {
        print_text(&self);
    }
    const int found = exit_code_of(&self);
    free(self.rows);
    return found;
}

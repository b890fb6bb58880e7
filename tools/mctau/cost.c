/* mctau cost: what accuracy costs in a scene, for every stepper, step and precision. */
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "candidates.h"
#include "instructions.h"
#include "mctau/stepper.h"
#include "runner_cost.h"
#include "say.h"
#include "verbs.h"

static const option options[] = {
    {"duration", "S", "scene.duration", "how much of the scene, a whole number of ticks"},
    {"dt", "S", "scene.dt", NULL},
    {"precision", "NAME", NULL, "only candidates of this precision, double or float; default: both"},
    {"reference-seconds", "S", NULL,
     "computing time that each of the reference's two methods may take; default 4"},
    OPTION_INSTRUCTIONS,
    {"plot", "FILE.svg", NULL, "a diagram: error over cost, a line for each stepper and precision"},
    {"html", "FILE", NULL, "a page that stands alone, with diagram and table"},
    OPTION_SET,
    OPTION_JSON,
    {NULL, NULL, NULL, NULL},
};

static int run_verb(const arguments *given);

const verb verb_cost = {
    .name = "cost",
    .doc = "what accuracy costs: error and time of every stepper, step and precision",
    .operand = "SCENE",
    .text = "Simulates a scene with every stepper that suits, at many steps and in both precisions, and "
            "prints for each\n"
            "its error and its cost. Errors are held against a reference that two methods agree on.\n"
            "The error of a state is its distance from the reference, divided by the reference's largest "
            "value in the run, or\n"
            "by 1 (rad, m, rad/s, m/s, A) where that is less; a rotation counts as the angle between "
            "attitudes. Shown is that\n"
            "of the worst state: at the end, and at the worst tick.\n"
            "Without controller and [input] a scene is free, and a step may be longer than the tick. Else "
            "the input is held\n"
            "over each tick, which is kept; a controller runs once in closed loop, and its inputs are "
            "replayed to all.\n"
            "Times are of the plant alone, without controller and sensors: nanoseconds of the host per tick "
            "of the scene\n"
            "(a longer step counts in parts), median and quartiles of fifteen samples.",
    .options = options,
    .examples = "  mctau cost scenes/cart_pole_free.toml\n"
                "  mctau cost scenes/reaction_wheel.toml --plot cost.svg --html cost.html\n"
                "  mctau cost scenes/rigid_body.toml --precision double --json\n",
    .exit_codes = "  0  well\n"
                  "  1  every stepper diverges\n"
                  "  2  the command line or the scene is wrong\n"
                  "  3  a file could not be read or written, or there is no Python to draw with\n",
    .run = run_verb,
};

typedef struct {
    study study;
    candidate *list;
    int count;
    const char *counted_by;  /* processor or valgrind; NULL: instructions were not counted */
    const char *not_counted; /* why */
} costs;

/* --- JSON --- */

static void print_json(const costs *self, FILE *file)
{
    json out = json_begin(file, "mctau.cost/1");
    study_json(&self->study, &out);
    json_text(&out, "instructions_counted_by", self->counted_by);
    json_text(&out, "instructions_not_counted", self->not_counted);
    json_list(&out, "candidates");
    for (int i = 0; i < self->count; i++) {
        const candidate *one = &self->list[i];
        json_object(&out, NULL);
        candidate_json(one, &self->study, &out);
        json_boolean(&out, "diverged", one->diverged);
        json_number(&out, "error_end", one->error_end);
        json_number(&out, "error_worst", one->error_worst);
        json_number(&out, "ns_per_tick", one->ns);
        json_number(&out, "ns_per_tick_low", one->ns_low);
        json_number(&out, "ns_per_tick_high", one->ns_high);
        json_number(&out, "ns_per_ms", one->ns * 1e-3 / self->study.scene.dt);
        json_number(&out, "instructions_per_tick", one->instructions);
        json_boolean(&out, "pareto", one->pareto);
        json_end_object(&out);
    }
    json_end_list(&out);
    json_finish(&out);
}

/* --- for people --- */

static void print_row(const costs *self, const candidate *one)
{
    printf("%c %-9s %-7s %9.5g  ", one->pareto ? '*' : ' ', mct_steppers[one->stepper].name,
           precision_name(one->precision), 1e3 * one->step);
    if (one->diverged) {
        printf("%9s %9s\n", "diverged", "-");
        return;
    }
    printf("%9.1e %9.1e %10.1f %6.1f .. %-7.1f %9.1f ", one->error_end, one->error_worst, one->ns,
           one->ns_low, one->ns_high, one->ns * 1e-3 / self->study.scene.dt);
    if (isnan(one->instructions)) {
        printf("%10s\n", "-");
    } else {
        printf("%10.0f\n", one->instructions);
    }
}

static int by_cost(const void *a, const void *b)
{
    const double x = ((const candidate *)a)->ns, y = ((const candidate *)b)->ns;
    return (x > y) - (x < y);
}

static void print_header(void)
{
    printf("  %-9s %-7s %9s  %9s %9s %10s %17s %9s %10s\n", "stepper", "", "step [ms]", "error end", "worst",
           "ns/tick", "quartiles", "ns/ms", "instr/tick");
}

static void print_text(const costs *self, const char *path)
{
    const mct_scene *scene = &self->study.scene;
    printf("%s: %s, tick %g s, %g s\n", path, mct_systems[scene->system]->name, scene->dt,
           (double)self->study.ticks * scene->dt);
    study_print(&self->study, stdout);
    printf("\n");
    print_header();
    for (int i = 0; i < self->count; i++) {
        print_row(self, &self->list[i]);
    }
    candidate *sorted = need_memory(malloc((size_t)self->count * sizeof *sorted));
    memcpy(sorted, self->list, (size_t)self->count * sizeof *sorted);
    qsort(sorted, (size_t)self->count, sizeof *sorted, by_cost);
    printf("\n* The front, by cost: nothing is both cheaper and more accurate\n");
    print_header();
    for (int i = 0; i < self->count; i++) {
        if (sorted[i].pareto) {
            print_row(self, &sorted[i]);
        }
    }
    free(sorted);
    if (self->counted_by != NULL) {
        printf("\nInstructions: counted by %s.\n",
               strcmp(self->counted_by, "valgrind") == 0 ? "valgrind (callgrind)" : "the processor");
    } else {
        printf("\nInstructions: not counted: %s.\n", self->not_counted);
    }
}

/* --- pictures --- */

#define DRAWER MCT_SOURCE "/tools/report/work_precision.py"
#define PYTHON MCT_SOURCE "/build/venv/bin/python"

/* Hands the JSON to Python, which draws. */
static int draw(const costs *self, const char *name, const char *plot, const char *html)
{
    int ends[2];
    if (access(PYTHON, X_OK) != 0 || access(DRAWER, R_OK) != 0) {
        return say(EXIT_IO, "--plot and --html draw with Python and matplotlib, which are not at " PYTHON
                            "; tools/setup in the source folder installs them");
    }
    if (pipe(ends) != 0) {
        return say(EXIT_IO, "--plot, --html: %s", strerror(errno));
    }
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[0], STDIN_FILENO);
        close(ends[0]);
        close(ends[1]);
        execl(PYTHON, PYTHON, DRAWER, name, plot != NULL ? plot : "", html != NULL ? html : "", (char *)NULL);
        _exit(EXIT_IO);
    }
    close(ends[0]);
    signal(SIGPIPE, SIG_IGN); /* Python may end before it has read all */
    FILE *pipe_in = child > 0 ? fdopen(ends[1], "w") : NULL;
    if (pipe_in != NULL) {
        print_json(self, pipe_in);
        fclose(pipe_in);
    } else {
        close(ends[1]);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        return say(EXIT_IO, "--plot, --html: nothing was drawn; what Python says stands above");
    }
    return 0;
}

static int show_costs(const costs *self, const scene_file *file)
{
    const char *plot = arguments_value(file->given, "plot");
    const char *html = arguments_value(file->given, "html");
    if (arguments_value(file->given, "json") != NULL) {
        print_json(self, stdout);
    } else {
        print_text(self, file->path);
    }
    return plot != NULL || html != NULL ? draw(self, file->path, plot, html) : 0;
}

/* --- all of it --- */

/* Under valgrind: the candidates that the first process has, and no more than that. */
static int count_under_valgrind(const scene_file *file, int precision)
{
    study about;
    const int exit_code = study_begin_again(&about, file, strtoull(instructions_note(), NULL, 10));
    if (exit_code == 0) {
        candidate *list = need_memory(malloc(MAX_CANDIDATES * sizeof *list));
        study_count_again(&about, list, study_candidates(&about, precision, false, list));
        free(list);
        study_end(&about);
    }
    return exit_code;
}

static int run_costs(const scene_file *file, int precision, double seconds, int counter)
{
    costs self = {.list = NULL};
    const int exit_code = study_begin(&self.study, file, seconds);
    if (exit_code != 0) {
        return exit_code;
    }
    self.list = need_memory(malloc(MAX_CANDIDATES * sizeof *self.list));
    self.count = study_candidates(&self.study, precision, false, self.list);
    study_measure(&self.study, self.list, self.count);
    study_time(&self.study, self.list, self.count);
    char note[24];
    snprintf(note, sizeof note, "%llu", (unsigned long long)self.study.ticks);
    self.not_counted = study_count(&self.study, self.list, self.count, file->path, note, &counter);
    self.counted_by = self.not_counted == NULL ? counter_names[counter] : NULL;
    study_mark_pareto(&self.study, self.list, self.count);
    const int shown = show_costs(&self, file);
    free(self.list);
    study_end(&self.study);
    return shown;
}

static int run_verb(const arguments *given)
{
    scene_file file;
    int precision, counter;
    double seconds = 4;
    const char *asked = arguments_value(given, "reference-seconds");
    int exit_code = read_precision(arguments_value(given, "precision"), &precision);
    exit_code = exit_code != 0 ? exit_code : read_counter(arguments_value(given, "instructions"), &counter);
    if (exit_code == 0 && asked != NULL) {
        exit_code = read_number("reference-seconds", asked, 0.01, 3600, "0.01 to 3600 s", &seconds);
    }
    exit_code = exit_code != 0 ? exit_code : scene_file_read(&file, given);
    if (exit_code == 0) {
        exit_code = instructions_note() != NULL ? count_under_valgrind(&file, precision)
                                                : run_costs(&file, precision, seconds, counter);
        scene_file_free(&file);
    }
    return exit_code;
}

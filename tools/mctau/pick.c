/* mctau pick: the cheapest stepper, step and precision that meet a tolerance. */
#include "pick.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "candidates.h"
#include "mctau/stepper.h"
#include "say.h"
#include "verbs.h"

#define SMALLEST_TOLERANCE 1e-15 /* five roundings of a double */

static const option options[] = {
    {"tolerance", "E", NULL,
     "largest error allowed at any tick, as mctau cost --help defines it; 1e-15 or more"},
    {"budget", "NS", NULL,
     "no more nanoseconds (instructions, for another target) a tick; without --tolerance: the most accurate "
     "within"},
    {"target", "NAME", NULL, "whose cost counts: host, the default, or cortex-m4f, which takes --costs"},
    {"costs", "FILE", NULL,
     "of a target: lines stepper,precision,instructions a step,instructions a tick beside"},
    {"duration", "S", "scene.duration", "how much of the scene, a whole number of ticks"},
    {"horizon", NULL, NULL,
     "of a motion that is sensitive to its start, as chaotic motion is: the part before any error has grown "
     "1e4 "
     "times"},
    {"dt", "S", "scene.dt", NULL},
    {"precision", "NAME", NULL, "only candidates of this precision, double or float; default: both"},
    OPTION_SET,
    OPTION_JSON,
    {NULL, NULL, NULL, NULL},
};

static int run_verb(const arguments *given);

const verb verb_pick = {
    .name = "pick",
    .doc = "the cheapest stepper, step and precision that meet a tolerance, verified",
    .operand = "SCENE",
    .text = "Finds the cheapest way to simulate a scene to a tolerance. Pilot runs at h and h/2 predict each "
            "candidate's error\n"
            "(Richardson); of those predicted to have half the tolerance or less the cheapest is run against "
            "a reference that\n"
            "two methods agree on. If it fails there, the next is tried. A tolerance is met when measured "
            "error and\n"
            "uncertainty of the reference together are within it, at every tick.\n"
            "Where a small difference at the start grows 1e4 times before the scene's end, as in chaotic "
            "motion, the "
            "end\n"
            "state means nothing, and nothing is picked without --horizon. A controller's inputs are "
            "replayed without "
            "it;\n"
            "what it holds upright would fall, so of such a scene the part before is taken in any case.\n"
            "Which steps and inputs there are, and what an error is, mctau cost --help says.",
    .options = options,
    .examples = "  mctau pick scenes/cart_pole_free.toml --tolerance 1e-8\n"
                "  mctau pick scenes/reaction_wheel.toml --tolerance 1e-6 --budget 100\n"
                "  mctau pick scenes/cart_pole.toml --budget 60 --precision float --json\n",
    .exit_codes =
        "  0  found and verified\n"
        "  1  nothing meets the request; what comes closest is shown. Or the scene is sensitive, and "
        "--horizon\n"
        "     was not given; or it diverges\n"
        "  2  the command line or the scene is wrong\n"
        "  3  a file could not be read\n",
    .run = run_verb,
};

/* --- what is asked for --- */

/* Instructions of a target, by stepper and precision; NaN: not known. */
typedef struct {
    double per_step[MCT_STEPPER_COUNT][2], per_tick[MCT_STEPPER_COUNT][2];
} instruction_costs;

typedef struct {
    double tolerance; /* infinite: none */
    double budget;    /* per tick; infinite: none */
    int precision;
    const char *target;             /* its name */
    const instruction_costs *costs; /* of another target than the host */
} request;

typedef struct {
    const study *study;
    const request *asked;
    double *rows[2]; /* of two pilots */
    candidate *list;
    int count;
    int failed;   /* candidates that verification refused */
    bool refused; /* the scene, which is sensitive */
    bool met;
    candidate found; /* which meets the request, or comes closest */
} picking;

/* Per tick of the scene; infinite when it is not known. */
static double cost_of(const picking *self, const candidate *one)
{
    const instruction_costs *costs = self->asked->costs;
    if (costs == NULL) {
        return one->ns;
    }
    const double cost = (costs->per_tick[one->stepper][one->precision] +
                         one->substeps * costs->per_step[one->stepper][one->precision]) /
                        one->multiple;
    return isnan(cost) ? (double)INFINITY : cost;
}

/* --- prediction --- */

static bool is_same_family(const candidate *a, const candidate *b)
{
    return a->stepper == b->stepper && a->precision == b->precision;
}

/*
 * Richardson: with the error proportional to h^p, the difference of two runs, at h and at h/2, tells both. The error of
 * the run at h.
 */
static double prediction_of(const picking *self, const candidate *one)
{
    candidate half = *one;
    half.substeps *= 2;
    half.step /= 2;
    if (!study_follow(self->study, one, self->rows[0]) || !study_follow(self->study, &half, self->rows[1])) {
        return (double)INFINITY;
    }
    const double difference =
        study_distance(self->study, self->rows[0], one->multiple, self->rows[1], half.multiple, NULL);
    const double ratio = pow(2, mct_steppers[one->stepper].order);
    return difference * ratio / (ratio - 1);
}

/* --- the choice --- */

/* Whether the shortest step of a stepper and precision is far from doing, by what a longer one has shown. */
static bool is_hopeless(const picking *self, int i)
{
    const candidate *one = &self->list[i], *shortest = one;
    while (shortest + 1 < self->list + self->count && is_same_family(shortest + 1, one)) {
        shortest++;
    }
    const double falls = pow(shortest->step / one->step, mct_steppers[one->stepper].order);
    return isfinite(one->predicted) && one->predicted * falls > 100 * self->asked->tolerance;
}

#define SMALL 0.01 /* an error from which on errors fall by the order, until roundings are left */

/* Errors of one stepper and precision, from the longest step on. */
typedef struct {
    double least;
    int idle; /* how many since then were no smaller */
} descent;

/* Whether shorter steps help no more: roundings are all that is left. */
static bool is_exhausted(descent *self, double error)
{
    const bool falls = error < 0.9 * self->least || !(self->least < SMALL);
    self->idle = falls ? 0 : self->idle + 1;
    self->least = fmin(self->least, error);
    return self->idle >= 2;
}

/*
 * Of candidate i's stepper and precision the first at or behind it that is predicted to do; -1: none. Once errors fall
 * by the order, steps more than an octave too long are passed over.
 */
static int first_that_may_do(picking *self, int i)
{
    const double allowed = 0.5 * self->asked->tolerance;
    descent predicted = {(double)INFINITY, 0};
    for (const candidate *begin = &self->list[i]; i < self->count && is_same_family(&self->list[i], begin);) {
        candidate *one = &self->list[i];
        one->predicted = prediction_of(self, one);
        if (one->predicted <= allowed) {
            return i;
        }
        if (is_hopeless(self, i) || is_exhausted(&predicted, one->predicted)) {
            return -1;
        }
        const double falls = pow(allowed / one->predicted, 1.0 / mct_steppers[one->stepper].order);
        const double longest = one->predicted < SMALL ? 2 * falls * one->step : one->step;
        do {
            i++;
        } while (i + 1 < self->count && is_same_family(&self->list[i + 1], begin) &&
                 self->list[i].step > longest);
    }
    return -1;
}

static bool is_next_family(const picking *self, int i)
{
    return i == 0 || !is_same_family(&self->list[i], &self->list[i - 1]);
}

/* Measured, and certain. */
static bool meets(const picking *self, const candidate *one)
{
    return one->error_worst + self->study->quality.uncertainty <= self->asked->tolerance;
}

/* From the cheapest on, until one is verified. */
static void pick_by_tolerance(picking *self)
{
    int heads[2 * MCT_STEPPER_COUNT], count = 0;
    for (int i = 0; i < self->count; i++) {
        if (is_next_family(self, i)) {
            heads[count] = first_that_may_do(self, i);
            if (heads[count] >= 0) {
                study_time(self->study, &self->list[heads[count]], 1);
                count++;
            }
        }
    }
    while (count > 0 && !self->met) {
        int best = 0;
        for (int i = 1; i < count; i++) {
            if (cost_of(self, &self->list[heads[i]]) < cost_of(self, &self->list[heads[best]])) {
                best = i;
            }
        }
        const int tried = heads[best];
        candidate *one = &self->list[tried];
        if (!(cost_of(self, one) <= self->asked->budget) || isinf(cost_of(self, one))) {
            return; /* and so are all others */
        }
        study_measure(self->study, one, 1);
        self->met = meets(self, one);
        if (self->met) {
            self->found = *one;
            return;
        }
        self->failed++;
        const bool has_more = tried + 1 < self->count && !is_next_family(self, tried + 1);
        heads[best] = has_more ? first_that_may_do(self, tried + 1) : -1;
        if (heads[best] < 0) {
            heads[best] = heads[--count];
        } else {
            study_time(self->study, &self->list[heads[best]], 1);
        }
    }
}

static bool is_allowed(const picking *self, const candidate *one)
{
    const double cost = cost_of(self, one);
    return !one->diverged && cost <= self->asked->budget && !isinf(cost);
}

static bool is_truer(const picking *self, const candidate *one, const candidate *than)
{
    (void)self;
    return one->error_worst < than->error_worst;
}

static bool is_cheaper(const picking *self, const candidate *one, const candidate *than)
{
    return cost_of(self, one) < cost_of(self, than);
}

typedef bool (*condition)(const picking *self, const candidate *one);
typedef bool (*comparison)(const picking *self, const candidate *one, const candidate *than);

static candidate best_of(const picking *self, comparison is_better)
{
    candidate best = self->list[0];
    for (int i = 1; i < self->count; i++) {
        best = is_better(self, &self->list[i], &best) ? self->list[i] : best;
    }
    return best;
}

/* Drops what does not fulfil a condition; when nothing does, all but the best of a comparison. */
static bool keep(picking *self, condition holds, comparison is_better)
{
    int kept = 0;
    const candidate best = best_of(self, is_better);
    for (int i = 0; i < self->count; i++) {
        if (holds(self, &self->list[i])) {
            self->list[kept++] = self->list[i];
        }
    }
    if (kept == 0) {
        self->list[0] = best;
    }
    self->count = kept > 0 ? kept : 1;
    return kept > 0;
}

/* All, but for steps so short that they help no more. */
static void measure_all(const picking *self)
{
    descent measured = {(double)INFINITY, 0};
    bool is_over = false;
    for (int i = 0; i < self->count; i++) {
        candidate *one = &self->list[i];
        if (is_next_family(self, i)) {
            measured = (descent){(double)INFINITY, 0};
            is_over = false;
        }
        if (is_over) {
            one->diverged = true;
            one->error_worst = one->error_end = (double)INFINITY;
            continue;
        }
        study_measure(self->study, one, 1);
        is_over = is_exhausted(&measured, one->error_worst);
    }
}

/*
 * When prediction has found nothing, or cannot say what is most accurate: all are measured, of a budget those
 * that it allows.
 */
static void pick_of_all(picking *self)
{
    const bool has_budget = isfinite(self->asked->budget), has_tolerance = isfinite(self->asked->tolerance);
    const bool on_host = self->asked->costs == NULL;
    if (self->count == 0) {
        return;
    }
    if (has_budget && on_host) {
        study_time(self->study, self->list, self->count);
    }
    const bool allowed = !(has_budget || !on_host) || keep(self, is_allowed, is_cheaper);
    measure_all(self);
    const bool well = keep(self, meets, is_truer);
    if (!has_budget && on_host) {
        study_time(self->study, self->list, self->count);
    }
    self->found = best_of(self, well && has_tolerance ? is_cheaper : is_truer);
    self->found.predicted = prediction_of(self, &self->found);
    self->met = allowed && well && !self->found.diverged;
}

static void pick(picking *self)
{
    self->list = need_memory(malloc(MAX_CANDIDATES * sizeof *self->list));
    self->count = study_candidates(self->study, self->asked->precision, true, self->list);
    for (int i = 0; i < 2; i++) {
        self->rows[i] = study_rows(self->study);
    }
    if (isfinite(self->asked->tolerance)) {
        pick_by_tolerance(self);
    }
    if (!self->met) {
        pick_of_all(self);
    }
    for (int i = 0; i < 2; i++) {
        free(self->rows[i]);
    }
    free(self->list);
}

/* --- telling --- */

static const char *cost_unit(const request *asked)
{
    return asked->costs != NULL ? "instructions" : "ns";
}

static void json_choice(const picking *self, const candidate *one, json *out)
{
    const bool on_host = self->asked->costs == NULL;
    candidate_json(one, self->study, out);
    json_number(out, "predicted_error", one->predicted);
    json_number(out, "verified_error", one->error_worst);
    json_number(out, "error_end", one->error_end);
    json_number(out, "ns_per_tick", on_host ? one->ns : (double)NAN);
    json_number(out, "instructions_per_tick", on_host ? (double)NAN : cost_of(self, one));
}

static void print_json(const picking *self)
{
    static const char *const keys[] = {
        "stepper",         "precision",      "dt",        "substeps",    "step",
        "predicted_error", "verified_error", "error_end", "ns_per_tick", "instructions_per_tick"};
    json out = json_begin(stdout, "mctau.pick/1");
    study_json(self->study, &out);
    json_text(&out, "target", self->asked->target);
    json_number(&out, "tolerance", self->asked->tolerance);
    json_number(&out, "budget", self->asked->budget);
    json_boolean(&out, "met", self->met);
    json_integer(&out, "refused_by_verification", self->failed);
    if (self->met) {
        json_choice(self, &self->found, &out);
    } else {
        for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
            json_text(&out, keys[i], NULL);
        }
        json_object(&out, "closest");
        if (self->found.step > 0) {
            json_choice(self, &self->found, &out);
        }
        json_end_object(&out);
    }
    json_finish(&out);
}

static void print_choice(const picking *self, const char *path)
{
    char text[128];
    const candidate *one = &self->found;
    const mct_scene *scene = &self->study->scene;
    printf("  %s\n  error        %.2e measured against the reference, %.2e at the end",
           candidate_text(one, text, sizeof text), one->error_worst, one->error_end);
    if (!isnan(one->predicted)) {
        printf(", %.2e predicted", one->predicted);
    }
    printf("\n  cost         %.4g %s a tick\n  to run it    mctau run %s --stepper %s --precision %s",
           cost_of(self, one), cost_unit(self->asked), path, mct_steppers[one->stepper].name,
           precision_name(one->precision));
    if (one->multiple > 1) {
        printf(" --dt %.10g", one->multiple * scene->dt);
    }
    printf(" --set scene.substeps=%d\n", one->substeps);
}

/* What the motion is asked to mean to its end, and does not. */
static void print_sensitive(const picking *self)
{
    const study *about = self->study;
    const double dt = about->scene.dt;
    printf("\nNothing is picked: the state at %g s means nothing, since by then any error has grown beyond "
           "measure.\n"
           "The first %g s mean something: --horizon picks for them, or --duration %g.\n",
           (double)about->all_ticks * dt, (double)about->ticks * dt, (double)about->ticks * dt);
}

static void print_text(const picking *self, const char *path)
{
    const request *asked = self->asked;
    printf("%s: %s, tick %g s, %g s\n", path, mct_systems[self->study->scene.system]->name,
           self->study->scene.dt, (double)self->study->ticks * self->study->scene.dt);
    study_print(self->study, stdout);
    if (self->refused) {
        print_sensitive(self);
        return;
    }
    printf(self->met ? "\nThe %s" : "\nNothing meets the request: ",
           isfinite(asked->tolerance) ? "cheapest" : "most accurate");
    if (isfinite(asked->tolerance)) {
        printf(self->met ? " with an error up to %g" : "an error up to %g", asked->tolerance);
    }
    if (isfinite(asked->budget)) {
        printf("%s within %g %s a tick", isfinite(asked->tolerance) || self->met ? "" : "a run",
               asked->budget, cost_unit(asked));
    }
    printf("\n");
    if (!self->met && self->study->quality.uncertainty > asked->tolerance) {
        printf("The reference itself is only known to %.1e.\n", self->study->quality.uncertainty);
    }
    if (self->failed > 0) {
        printf("Verification refused %d that the pilots had promised.\n", self->failed);
    }
    if (self->found.step > 0) {
        printf(self->met ? "" : "What comes closest:\n");
        print_choice(self, path);
    }
}

/* --- stepper = "auto" --- */

int choose_stepper(scene_file *file)
{
    char text[128];
    study about;
    mct_scene *scene = &file->scene;
    if (scene->automatic == 0 || mct_systems[scene->system]->is_process || scene->duration == 0) {
        return 0;
    }
    const int exit_code = study_begin(&about, file, 1);
    if (exit_code != 0) {
        return exit_code;
    }
    about.keeps_tick = true;
    const request asked = {.tolerance = scene->tolerance,
                           .budget = (double)INFINITY,
                           .precision = scene->precision,
                           .target = "host"};
    picking self = {.study = &about, .asked = &asked};
    pick(&self);
    candidate_text(&self.found, text, sizeof text);
    if (self.met) {
        scene->stepper = self.found.stepper;
        scene->substeps = self.found.substeps;
        scene_file_note(file, "scene.stepper", mct_steppers[scene->stepper].name);
        char substeps[16];
        snprintf(substeps, sizeof substeps, "%d", scene->substeps);
        scene_file_note(file, "scene.substeps", substeps);
        say(0, "note: stepper = auto: %s; error %.1e over %g s%s, allowed %g; %.3g ns a tick", text,
            self.found.error_worst, (double)about.ticks * scene->dt,
            study_is_sensitive(&about) ? ", after which the motion is sensitive to any" : "",
            scene->tolerance, self.found.ns);
    } else {
        say(EXIT_CHECK_FAILED,
            "scene.stepper: found auto, and nothing meets scene.tolerance = %g at this tick and precision; "
            "closest "
            "comes %s with an error of %.1e, against a reference known to %.1e",
            scene->tolerance, text, self.found.error_worst, about.quality.uncertainty);
    }
    study_end(&about);
    return self.met ? 0 : EXIT_CHECK_FAILED;
}

/* --- the command line --- */

static int read_costs(const char *path, instruction_costs *costs)
{
    char line[256], stepper[32], precision[32], end;
    double step, tick;
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        return say(EXIT_IO, "--costs: %s cannot be read", path);
    }
    for (int i = 0; i < MCT_STEPPER_COUNT; i++) {
        for (int j = 0; j < 2; j++) {
            costs->per_step[i][j] = costs->per_tick[i][j] = (double)NAN;
        }
    }
    int exit_code = 0;
    for (int number = 1; exit_code == 0 && fgets(line, sizeof line, file) != NULL; number++) {
        if (line[0] == '#' || line[0] == '\n') {
            continue;
        }
        int known = -1;
        const int fields = sscanf(line, "%31[^,],%31[^,],%lf,%lf %c", stepper, precision, &step, &tick, &end);
        for (int i = 0; fields == 4 && i < MCT_STEPPER_COUNT; i++) {
            known = strcmp(stepper, mct_steppers[i].name) == 0 ? i : known;
        }
        const int which = strcmp(precision, "float") == 0 ? MCT_PRECISION_FLOAT : MCT_PRECISION_DOUBLE;
        if (known < 0 || strcmp(precision, precision_name(which)) != 0 || !(step > 0) || !(tick >= 0)) {
            exit_code =
                say(EXIT_USAGE,
                    "%s:%d: allowed stepper,precision,instructions a step,instructions a tick beside, as "
                    "rk4,float,900,60",
                    path, number);
            break;
        }
        costs->per_step[known][which] = step;
        costs->per_tick[known][which] = tick;
    }
    fclose(file);
    return exit_code;
}

static int read_target(const arguments *given, request *asked, instruction_costs *costs)
{
    const char *name = arguments_value(given, "target"), *path = arguments_value(given, "costs");
    asked->target = name != NULL ? name : "host";
    if (strcmp(asked->target, "host") == 0) {
        return path == NULL
                   ? 0
                   : say(EXIT_USAGE, "--costs: found together with the target host, which is timed here");
    }
    if (strcmp(asked->target, "cortex-m4f") != 0) {
        return say(EXIT_USAGE, "--target: found %s; allowed host, cortex-m4f", asked->target);
    }
    if (path == NULL) {
        return say(EXIT_USAGE,
                   "--target: found cortex-m4f, whose instructions cannot be counted here; allowed together "
                   "with --costs FILE, as tools/instructions SCENE -o FILE writes it");
    }
    asked->costs = costs;
    return read_costs(path, costs);
}

static int read_request(const arguments *given, request *asked, instruction_costs *costs)
{
    const char *tolerance = arguments_value(given, "tolerance"), *budget = arguments_value(given, "budget");
    *asked = (request){.tolerance = (double)INFINITY, .budget = (double)INFINITY};
    int exit_code = read_precision(arguments_value(given, "precision"), &asked->precision);
    if (exit_code == 0 && tolerance == NULL && budget == NULL) {
        exit_code =
            say(EXIT_USAGE, "pick: no --tolerance given, the largest error allowed, as 1e-6; or --budget");
    }
    if (exit_code == 0 && tolerance != NULL) {
        exit_code = read_number("tolerance", tolerance, SMALLEST_TOLERANCE, 1e6,
                                "1e-15 to 1e6; below, rounding alone is larger", &asked->tolerance);
    }
    if (exit_code == 0 && budget != NULL) {
        exit_code = read_number("budget", budget, 1e-3, 1e12, "0.001 to 1e12 a tick", &asked->budget);
    }
    return exit_code != 0 ? exit_code : read_target(given, asked, costs);
}

static int pick_for(const scene_file *file, const request *asked)
{
    study about;
    const int exit_code = study_begin(&about, file, 4);
    if (exit_code != 0) {
        return exit_code;
    }
    picking self = {.study = &about, .asked = asked};
    self.refused =
        study_is_sensitive(&about) && !about.is_recorded && arguments_value(file->given, "horizon") == NULL;
    if (!self.refused) {
        pick(&self);
    }
    if (arguments_value(file->given, "json") != NULL) {
        print_json(&self);
    } else {
        print_text(&self, file->path);
    }
    study_end(&about);
    return self.met ? EXIT_WELL : EXIT_CHECK_FAILED;
}

static int run_verb(const arguments *given)
{
    scene_file file;
    request asked;
    instruction_costs costs;
    int exit_code = read_request(given, &asked, &costs);
    exit_code = exit_code != 0 ? exit_code : scene_file_read(&file, given);
    if (exit_code == 0) {
        exit_code = pick_for(&file, &asked);
        scene_file_free(&file);
    }
    return exit_code;
}

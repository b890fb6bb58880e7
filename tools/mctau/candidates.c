#include "candidates.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "instructions.h"
#include "mctau/stepper.h"
#include "runner_cost.h"
#include "say.h"

enum { MOST_SUBSTEPS = 1000 }; /* as in a scene */

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void show(const study *self, const char *what, int done, int of)
{
    if (self->progress) {
        fprintf(stderr, "\r\033[K%s", what);
        if (of > 0) {
            fprintf(stderr, " %d of %d", done, of);
        }
        fflush(stderr);
    }
}

static void hide(const study *self)
{
    if (self->progress) {
        fputs("\r\033[K", stderr);
    }
}

/* --- one candidate's run --- */

static uint64_t row_count(const study *self)
{
    return self->ticks + 1;
}

double *study_rows(const study *self)
{
    return need_memory(malloc(row_count(self) * (uint64_t)self->states * sizeof(double)));
}

/* The scene as a candidate simulates it. */
static mct_scene scene_of(const study *self, const candidate *one)
{
    mct_scene scene = self->scene;
    scene.effects = (scene.effects & ~one->without) | one->with;
    scene.stepper = one->stepper;
    scene.precision = one->precision;
    scene.substeps = one->substeps;
    scene.dt = one->multiple * self->scene.dt;
    scene.duration = (double)self->ticks * self->scene.dt;
    return scene;
}

bool study_suits(const study *self, const candidate *one)
{
    mct_message why;
    trial nothing = {.ticks = 1};
    const mct_scene scene = scene_of(self, one);
    const mct_runner *runner = find_runner(one->precision);
    return runner != NULL && mct_scene_check(&scene, NULL) == MCT_OK &&
           runner->try(&scene, &nothing, &why) == MCT_OK;
}

static trial trial_of(const study *self, const candidate *one)
{
    return (trial){.inputs = self->inputs, .ticks = self->ticks / (uint64_t)one->multiple};
}

bool study_follow(const study *self, const candidate *one, double *rows)
{
    mct_message why;
    const mct_scene scene = scene_of(self, one);
    trial asked = trial_of(self, one);
    asked.states = rows;
    return find_runner(one->precision)->try(&scene, &asked, &why) == MCT_OK && !asked.diverged;
}

/* --- distances --- */

static double attitude_distance(const double *a, const double *b)
{
    const double w = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    const double v[3] = {a[0] * b[1] - a[1] * b[0] - (a[2] * b[3] - a[3] * b[2]),
                         a[0] * b[2] - a[2] * b[0] - (a[3] * b[1] - a[1] * b[3]),
                         a[0] * b[3] - a[3] * b[0] - (a[1] * b[2] - a[2] * b[1])};
    return 2 * atan2(sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), fabs(w)); /* q and -q are one attitude */
}

/* First entry of the quaternion, or -1. */
static int quaternion_of(const mct_system *system)
{
    return system->attitude == MCT_ATTITUDE_NONE ? -1 : mct_rate_index(system) - 4;
}

/* Largest distance of two states; infinite when one is no number. */
double state_distance(const mct_system *system, int states, const double *scale, const double *a,
                      const double *b, int *worst)
{
    const int quaternion = quaternion_of(system);
    double largest = quaternion < 0 ? 0 : attitude_distance(a + quaternion, b + quaternion);
    int where = quaternion < 0 ? 0 : quaternion;
    for (int i = 0; i < states; i++) {
        const bool is_turned = quaternion >= 0 && i >= quaternion && i < quaternion + 4;
        if (!is_turned && !mct_state_is_phase(system, i)) {
            const double distance = fabs(a[i] - b[i]) / scale[i];
            where = distance <= largest ? where : i;
            largest = distance <= largest ? largest : distance; /* a NaN is kept */
        }
    }
    if (worst != NULL) {
        *worst = where;
    }
    return isnan(largest) ? (double)INFINITY : largest;
}

static double row_distance(const study *self, const double *a, const double *b)
{
    return state_distance(mct_systems[self->scene.system], self->states, self->scale, a, b, NULL);
}

static uint64_t common_multiple(int a, int b)
{
    uint64_t both = (uint64_t)a;
    while (both % (uint64_t)b != 0) {
        both += (uint64_t)a;
    }
    return both;
}

double study_distance(const study *self, const double *a, int a_multiple, const double *b, int b_multiple,
                      double *at_end)
{
    const uint64_t states = (uint64_t)self->states;
    const uint64_t stride = common_multiple(a_multiple, b_multiple);
    double worst = 0;
    for (uint64_t tick = 0;; tick += stride) {
        tick = tick < self->ticks ? tick : self->ticks;
        const double here = row_distance(self, a + tick / (uint64_t)a_multiple * states,
                                         b + tick / (uint64_t)b_multiple * states);
        worst = fmax(worst, here);
        if (tick == self->ticks) {
            if (at_end != NULL) {
                *at_end = here;
            }
            return worst;
        }
    }
}

/* --- the reference --- */

/* Runs of one stepper at h, h/2, h/4 ..., extrapolated to h = 0 tick by tick. */
enum { COLUMNS = 6, LEVELS = 10 }; /* the finest step is the tick / 512 */

typedef struct {
    int substeps;  /* of the finest run; 0: none went well */
    double change; /* between the best two approximations */
    double *rows;  /* the best one */
} limit;

/*
 * Adds a run to the table of Neville's scheme: column j is free of the terms h^p ... h^(p+j-1) of the error.
 * `rows` becomes the newest diagonal.
 */
static void extrapolate(double *rows, double **columns, int known, int order, uint64_t size)
{
    for (uint64_t i = 0; i < size; i++) {
        double value = rows[i];
        for (int j = 0; j < known; j++) {
            const double before = columns[j][i];
            columns[j][i] = value;
            value += (value - before) / (ldexp(1, order + j) - 1);
        }
        if (known < COLUMNS) {
            columns[known][i] = value;
        }
        rows[i] = value;
    }
}

static limit limit_of(const study *self, int stepper, double seconds)
{
    const uint64_t size = row_count(self) * (uint64_t)self->states;
    limit found = {.substeps = 0, .change = (double)INFINITY, .rows = study_rows(self)};
    double *rows = study_rows(self), *before = study_rows(self), *columns[COLUMNS];
    for (int i = 0; i < COLUMNS; i++) {
        columns[i] = study_rows(self);
    }
    const double begin = now();
    int known = 0, worse = 0;
    for (int level = 0; level < LEVELS && worse < 2 && found.change > 1e-15; level++) {
        const candidate run = {.stepper = stepper, .multiple = 1, .substeps = 1 << level};
        const double spent = now() - begin;
        if (known > 1 && 2 * spent > seconds) { /* the next run takes as long as all before it */
            break;
        }
        if (!study_suits(self, &run)) {
            continue;
        }
        if (!study_follow(self, &run, rows)) {
            known = 0;
            continue;
        }
        extrapolate(rows, columns, known < COLUMNS ? known : COLUMNS - 1, mct_steppers[stepper].order, size);
        const double change = known > 0 ? study_distance(self, rows, 1, before, 1, NULL) : (double)INFINITY;
        if (known == 0 || change < found.change) {
            memcpy(found.rows, rows, size * sizeof *rows);
            found.change = change;
            found.substeps = run.substeps;
            worse = 0;
        } else if (found.change < 1e-9) { /* rounding is all that is left */
            worse++;
        }
        memcpy(before, rows, size * sizeof *rows);
        known++;
    }
    for (int i = 0; i < COLUMNS; i++) {
        free(columns[i]);
    }
    free(rows);
    free(before);
    return found;
}

/* Steppers are of one family when their names differ in their digits alone: taylor4, taylor8. */
static bool is_same_family(int a, int b)
{
    static const char digits[] = "0123456789";
    const char *names[2] = {mct_steppers[a].name, mct_steppers[b].name};
    const size_t length = strcspn(names[0], digits);
    return length == strcspn(names[1], digits) && strncmp(names[0], names[1], length) == 0;
}

/* The stepper of the highest order that suits at some step; not of the family of `but`; -1: there is none. */
static int best_stepper(const study *self, int but, const bool *refused)
{
    int best = -1;
    for (int i = 0; i < MCT_STEPPER_COUNT; i++) {
        const candidate finest = {.stepper = i, .multiple = 1, .substeps = 1 << (LEVELS - 1)};
        const bool better = best < 0 || mct_steppers[i].order >= mct_steppers[best].order;
        if (!refused[i] && better && (but < 0 || !is_same_family(i, but)) && study_suits(self, &finest)) {
            best = i;
        }
    }
    return best;
}

static void set_scale(study *self, const double *rows)
{
    for (int i = 0; i < self->states; i++) {
        self->scale[i] = 1;
        for (uint64_t tick = 0; tick <= self->ticks; tick++) {
            self->scale[i] = fmax(self->scale[i], fabs(rows[tick * (uint64_t)self->states + (uint64_t)i]));
        }
    }
}

/* Coarsest run of a stepper that does not diverge, written to rows. */
static bool follow_somehow(const study *self, candidate *run, double *rows)
{
    for (run->substeps = 4; run->substeps <= 1 << (LEVELS - 1); run->substeps *= 2) {
        if (study_suits(self, run) && study_follow(self, run, rows)) {
            return true;
        }
    }
    return false;
}

/* Follows a start that differs a little, and leaves out what comes after it has come to differ much. */
static void find_horizon(study *self, int stepper)
{
    double *rows = study_rows(self), *other = study_rows(self);
    candidate run = {.stepper = stepper, .multiple = 1};
    if (follow_somehow(self, &run, rows)) {
        study changed = *self;
        set_scale(self, rows);
        memcpy(changed.scale, self->scale, sizeof self->scale);
        for (int i = 0; i < self->states; i++) {
            changed.scene.initial[i] += 1e-9 * self->scale[i];
        }
        const bool well = study_follow(&changed, &run, other);
        const double first = row_distance(self, rows, other);
        uint64_t horizon = self->ticks;
        for (uint64_t tick = 1; well && first > 0 && tick <= self->ticks; tick++) {
            const uint64_t place = tick * (uint64_t)self->states;
            self->growth = fmax(self->growth, row_distance(self, rows + place, other + place) / first);
            if (self->growth > STUDY_LARGEST_GROWTH && horizon == self->ticks) {
                horizon = tick - 1;
            }
        }
        if (horizon < self->ticks) {
            uint64_t parts = 480; /* so that longer steps fit in */
            while (parts > 1 && 8 * parts > horizon) {
                parts /= 2;
            }
            self->ticks = horizon > 0 ? horizon - horizon % parts : 1;
        }
        set_scale(self, rows);
    } else {
        self->diverges = true;
    }
    free(rows);
    free(other);
}

static void find_reference(study *self, double seconds)
{
    reference_quality *quality = &self->quality;
    bool refused[MCT_STEPPER_COUNT] = {false};
    show(self, "inputs and reference", 0, 0);
    quality->stepper = best_stepper(self, -1, refused);
    quality->other_stepper = -1;
    quality->agreement = (double)NAN;
    if (quality->stepper < 0) {
        self->diverges = true;
        return;
    }
    find_horizon(self, quality->stepper);
    if (self->diverges) {
        return;
    }
    const limit own = limit_of(self, quality->stepper, seconds);
    self->reference = own.rows;
    set_scale(self, own.rows);
    quality->substeps = own.substeps;
    quality->own = own.change;
    quality->uncertainty = own.change;
    self->diverges = own.substeps == 0;
    for (int i; quality->other_stepper < 0 && !self->diverges &&
                (i = best_stepper(self, quality->stepper, refused)) >= 0;) {
        show(self, "a second method for the reference", 0, 0);
        const limit other = limit_of(self, i, seconds);
        refused[i] = true;
        if (isfinite(other.change)) {
            quality->other_stepper = i;
            quality->other_substeps = other.substeps;
            quality->agreement = study_distance(self, own.rows, 1, other.rows, 1, NULL);
            quality->uncertainty = fmax(quality->uncertainty, quality->agreement);
        }
        free(other.rows);
    }
}

/* A scene's study without inputs, horizon and reference. */
static int set_up(study *self, const scene_file *file)
{
    const mct_scene *scene = &file->scene;
    memset(self, 0, sizeof *self);
    if (mct_systems[scene->system]->is_process) {
        return say(EXIT_USAGE, "scene.system: found %s, a process: it has no time, and so no step to choose",
                   mct_systems[scene->system]->name);
    }
    if (find_runner(MCT_PRECISION_DOUBLE) == NULL) {
        return say(EXIT_USAGE, "the reference is computed in double, which this build has not");
    }
    mct_scene_vary(scene, &self->scene);
    self->scene.controller = MCT_CONTROLLER_NONE;
    self->scene.input = MCT_INPUT_NONE;
    self->scene.precision = MCT_PRECISION_DOUBLE;
    self->is_recorded = scene->controller != MCT_CONTROLLER_NONE;
    self->held = self->is_recorded || scene->input != MCT_INPUT_NONE;
    self->keeps_tick = self->held;
    self->all_ticks = (uint64_t)(scene->duration / scene->dt + 0.5);
    self->ticks = self->all_ticks < STUDY_MOST_TICKS ? self->all_ticks : STUDY_MOST_TICKS;
    self->states = mct_state_count(scene);
    return self->ticks > 0
               ? 0
               : say(EXIT_USAGE,
                     "scene.duration: found 0 s; allowed a tick or more, for there to be an error");
}

/* Inputs of the first ticks; the rest is 0. */
static int find_inputs(study *self, const scene_file *file, uint64_t ticks)
{
    if (!self->held) {
        return 0;
    }
    mct_message why;
    const run_options options = {.samples = file->samples};
    self->inputs = need_memory(calloc(self->ticks, sizeof *self->inputs));
    const mct_status status = file->runner->inputs(&file->scene, &options, ticks, self->inputs, &why);
    if (status != MCT_OK) {
        study_end(self);
        return say_status(status, &why);
    }
    return 0;
}

int study_begin_inputs(study *self, const scene_file *file)
{
    const int exit_code = set_up(self, file);
    self->progress = isatty(STDERR_FILENO) == 1;
    return exit_code != 0 ? exit_code : find_inputs(self, file, self->ticks);
}

int study_begin(study *self, const scene_file *file, double seconds)
{
    const int exit_code = study_begin_inputs(self, file);
    if (exit_code != 0) {
        return exit_code;
    }
    find_reference(self, seconds);
    hide(self);
    if (self->diverges) {
        study_end(self);
        return say(
            EXIT_CHECK_FAILED,
            "the scene diverges with every stepper: there is no reference; --duration takes less of it");
    }
    return 0;
}

int study_begin_again(study *self, const scene_file *file, uint64_t ticks)
{
    const int exit_code = set_up(self, file);
    self->ticks = ticks;
    return exit_code != 0
               ? exit_code
               : find_inputs(self, file, ticks < RUNNER_COUNTED_TICKS ? ticks : RUNNER_COUNTED_TICKS);
}

bool study_is_sensitive(const study *self)
{
    return self->growth > STUDY_LARGEST_GROWTH;
}

void study_end(study *self)
{
    free(self->inputs);
    free(self->reference);
    self->inputs = NULL;
    self->reference = NULL;
}

/* --- candidates --- */

/* The power of two at `value` or next below, from 1 to 2^19. */
static int power_below(double value)
{
    int power = 1;
    while (power < 1 << 19 && 2 * power <= value) {
        power *= 2;
    }
    return power;
}

static int add(const study *self, candidate one, candidate *found, int count)
{
    one.step = one.multiple * self->scene.dt / one.substeps;
    one.instructions = one.predicted = (double)NAN;
    if (count == MAX_CANDIDATES || !study_suits(self, &one)) {
        return count;
    }
    found[count] = one;
    return count + 1;
}

/* 1, 2, 3, 4, 6, 8, 12 ... */
static int half_octave_behind(int s)
{
    return (s & (s - 1)) != 0 ? s / 3 * 4 : s > 1 ? s / 2 * 3 : 2;
}

/* Of one stepper and precision. */
static int add_steps(const study *self, candidate one, bool deep, candidate *found, int count)
{
    const double dt = self->scene.dt;
    /* The tick, down to a 32nd of it. Free: 64 ms to 1/8 ms, and as much about the tick. */
    const int longest = self->keeps_tick ? 1 : (int)fmax(64, 0.064 / dt);
    const double shortest = self->keeps_tick ? fmax(32, dt / 31.25e-6) : fmax(8, dt / 0.125e-3);
    const int finest = power_below(fmin(MOST_SUBSTEPS, shortest));
    const int deepest = deep ? power_below(fmin(MOST_SUBSTEPS, fmax(128, dt / 8e-6))) : finest;
    int last = 0;
    one.substeps = 1;
    for (int m = longest; m > 1; m--) { /* those in which the run is a whole number of steps, not too close */
        if (self->ticks % (uint64_t)m == 0 && (last == 0 || 4 * last >= 5 * m)) {
            one.multiple = last = m;
            count = add(self, one, found, count);
        }
    }
    one.multiple = 1;
    for (int s = 1; s <= deepest; s = s < finest ? half_octave_behind(s) : 2 * s) {
        one.substeps = s;
        count = add(self, one, found, count);
    }
    return count;
}

int study_candidates(const study *self, int precision, bool deep, candidate *found)
{
    int count = 0;
    for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
        for (int i = MCT_PRECISION_DOUBLE; i <= MCT_PRECISION_FLOAT; i++) {
            if (precision == ANY_PRECISION || precision == i) {
                count = add_steps(self, (candidate){.stepper = stepper, .precision = i}, deep, found, count);
            }
        }
    }
    return count;
}

void study_measure(const study *self, candidate *list, int count)
{
    double *rows = study_rows(self);
    for (int i = 0; i < count; i++) {
        candidate *one = &list[i];
        show(self, "errors", i, count);
        one->diverged = !study_follow(self, one, rows);
        one->error_end = one->error_worst = (double)INFINITY;
        if (!one->diverged) {
            one->error_worst = study_distance(self, rows, one->multiple, self->reference, 1, &one->error_end);
        }
    }
    hide(self);
    free(rows);
}

/* --- cost --- */

enum { ROUNDS = 15 };

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Round after round over all, so that a machine that slows down meanwhile slows all of them. */
void study_time(const study *self, candidate *list, int count)
{
    double(*samples)[ROUNDS] = need_memory(calloc((size_t)count + 1, sizeof *samples));
    for (int round = 0; round < ROUNDS; round++) {
        show(self, "times, round", round + 1, ROUNDS);
        for (int i = 0; i < count; i++) {
            mct_message why;
            const mct_scene scene = scene_of(self, &list[i]);
            trial asked = trial_of(self, &list[i]);
            asked.sample_ns = 5e5;
            const bool well =
                !list[i].diverged && find_runner(list[i].precision)->try(&scene, &asked, &why) == MCT_OK;
            samples[i][round] = well ? asked.ns / list[i].multiple : (double)NAN;
        }
    }
    for (int i = 0; i < count; i++) {
        qsort(samples[i], ROUNDS, sizeof samples[i][0], by_value);
        list[i].ns = samples[i][ROUNDS / 2];
        list[i].ns_low = samples[i][ROUNDS / 4];
        list[i].ns_high = samples[i][ROUNDS - 1 - ROUNDS / 4];
    }
    hide(self);
    free(samples);
}

/* --- instructions --- */

const char *const counter_names[COUNTERS] = {"processor", "valgrind", "none"};

static bool count_here(const study *self, candidate *list, int count)
{
    bool counted = false;
    for (int i = 0; i < count; i++) {
        mct_message why;
        const mct_scene scene = scene_of(self, &list[i]);
        trial asked = trial_of(self, &list[i]);
        asked.count = true;
        const bool well = find_runner(list[i].precision)->try(&scene, &asked, &why) == MCT_OK;
        list[i].instructions = well ? asked.instructions / list[i].multiple : (double)NAN;
        counted = counted || !isnan(list[i].instructions);
    }
    return counted;
}

void study_count_again(const study *self, candidate *list, int count)
{
    (void)count_here(self, list, count);
}

/* NULL, or why not. */
static const char *count_by_valgrind(candidate *list, int count, const char *path, const char *note)
{
    if (strcmp(path, "-") == 0) {
        return "valgrind cannot read the scene once more from standard input";
    }
    const size_t pieces = 2 * (size_t)count; /* half of the ticks, and all: what begins and ends drops out */
    uint64_t *counts = need_memory(calloc(pieces, sizeof *counts));
    const char *why_not = instructions_by_valgrind(note, counts, pieces);
    for (int i = 0; i < count && why_not == NULL; i++) {
        list[i].instructions =
            (double)(counts[2 * i + 1] - counts[2 * i]) / (RUNNER_COUNTED_TICKS / 2) / list[i].multiple;
    }
    free(counts);
    return why_not;
}

const char *study_count(const study *self, candidate *list, int count, const char *path, const char *note,
                        int *counter)
{
    if (*counter == COUNTER_NONE) {
        return "not asked for";
    }
    if (*counter != COUNTER_VALGRIND && count_here(self, list, count)) {
        *counter = COUNTER_PROCESSOR;
        return NULL;
    }
    if (*counter == COUNTER_PROCESSOR) {
        return "the kernel does not let a program read the processor's counter";
    }
    *counter = COUNTER_VALGRIND;
    return count_by_valgrind(list, count, path, note);
}

/* --- the front --- */

static double known_error(const study *self, const candidate *one)
{
    return fmax(one->error_worst, self->quality.uncertainty);
}

void study_mark_pareto(const study *self, candidate *list, int count)
{
    for (int i = 0; i < count; i++) {
        list[i].pareto = !list[i].diverged;
        for (int j = 0; j < count && list[i].pareto; j++) {
            const double own = known_error(self, &list[i]), other = known_error(self, &list[j]);
            const bool as_good = !list[j].diverged && list[j].ns <= list[i].ns && other <= own;
            list[i].pareto = !(as_good && (list[j].ns < list[i].ns || other < own));
        }
    }
}

/* --- telling --- */

const char *precision_name(int precision)
{
    return precision == MCT_PRECISION_FLOAT ? "float" : "double";
}

const char *candidate_text(const candidate *self, char *text, size_t size)
{
    snprintf(text, size, "%s, step %.6g ms, %s", mct_steppers[self->stepper].name, 1e3 * self->step,
             precision_name(self->precision));
    return text;
}

void candidate_json(const candidate *self, const study *of, json *out)
{
    json_text(out, "stepper", mct_steppers[self->stepper].name);
    json_text(out, "precision", precision_name(self->precision));
    json_number(out, "dt", self->multiple * of->scene.dt);
    json_integer(out, "substeps", self->substeps);
    json_number(out, "step", self->step);
}

void study_print(const study *self, FILE *file)
{
    const double dt = self->scene.dt;
    const reference_quality *quality = &self->quality;
    if (self->is_recorded) {
        fprintf(
            file,
            "Held input: that of one closed-loop run, replayed without the controller; the tick is kept.\n");
    } else {
        fprintf(file, self->held ? "Held input: it changes at every tick, so the tick is kept.\n"
                                 : "Free: no input, so a step may be longer than the tick.\n");
    }
    fprintf(file, "Reference: %s at %d steps a tick, extrapolated; ", mct_steppers[quality->stepper].name,
            quality->substeps);
    if (quality->other_stepper < 0) {
        fprintf(file, "no second method suits, so it is not verified; its last refinement changed %.1e.\n",
                quality->own);
    } else {
        fprintf(file, "%s at %d agrees to %.1e. Known to %.1e.\n", mct_steppers[quality->other_stepper].name,
                quality->other_substeps, quality->agreement, quality->uncertainty);
    }
    if (study_is_sensitive(self)) {
        fprintf(file,
                "Sensitive, as chaotic and unstable motion is: a small difference at the start, and so any "
                "error, grows up to\n%s%.0e times. Measured is the part in which it grows at most 1e4 times: "
                "--duration %g of %g s.\n",
                self->growth > 1e8 ? "more than " : "", fmin(self->growth, 1e8), (double)self->ticks * dt,
                (double)self->all_ticks * dt);
    } else if (self->ticks < self->all_ticks) {
        fprintf(file, "Measured are the first %d ticks, %g of %g s.\n", STUDY_MOST_TICKS,
                (double)self->ticks * dt, (double)self->all_ticks * dt);
    }
}

void study_json(const study *self, json *out)
{
    const double dt = self->scene.dt;
    const reference_quality *quality = &self->quality;
    json_text(out, "system", mct_systems[self->scene.system]->name);
    json_text(out, "input", self->is_recorded ? "replayed" : self->held ? "held" : "free");
    json_number(out, "tick", dt);
    json_number(out, "duration", (double)self->all_ticks * dt);
    json_number(out, "horizon", (double)self->ticks * dt);
    json_number(out, "growth", self->growth);
    json_boolean(out, "sensitive", study_is_sensitive(self));
    json_object(out, "reference");
    json_text(out, "stepper", mct_steppers[quality->stepper].name);
    json_integer(out, "substeps", quality->substeps);
    json_number(out, "last_change", quality->own);
    json_boolean(out, "verified", quality->other_stepper >= 0);
    json_text(out, "other_stepper",
              quality->other_stepper < 0 ? NULL : mct_steppers[quality->other_stepper].name);
    json_integer(out, "other_substeps", quality->other_substeps);
    json_number(out, "agreement", quality->agreement);
    json_number(out, "uncertainty", quality->uncertainty);
    json_object(out, "state"); /* at the horizon */
    for (int i = 0; i < self->states; i++) {
        const double *end = self->reference + self->ticks * (uint64_t)self->states;
        json_number(out, mct_state_field(mct_systems[self->scene.system], i)->name, end[i]);
    }
    json_end_object(out);
    json_end_object(out);
}

/* --- options --- */

int read_precision(const char *name, int *precision)
{
    *precision = ANY_PRECISION;
    for (int i = MCT_PRECISION_DOUBLE; name != NULL && i <= MCT_PRECISION_FLOAT; i++) {
        if (strcmp(name, precision_name(i)) == 0 && find_runner(i) != NULL) {
            *precision = i;
        }
    }
    return name == NULL || *precision != ANY_PRECISION
               ? 0
               : say(EXIT_USAGE, "--precision: found %s; allowed %s", name, runner_names());
}

int read_counter(const char *name, int *counter)
{
    *counter = COUNTER_ANY;
    for (int i = 0; name != NULL && i < COUNTERS; i++) {
        *counter = strcmp(name, counter_names[i]) == 0 ? i : *counter;
    }
    return name == NULL || *counter != COUNTER_ANY
               ? 0
               : say(EXIT_USAGE, "--instructions: found %s; allowed processor, valgrind, none", name);
}

int read_number(const char *name, const char *text, double least, double most, const char *allowed,
                double *value)
{
    char *end;
    *value = strtod(text, &end);
    const bool is_number = end != text && *end == '\0';
    return is_number && *value >= least && *value <= most
               ? 0
               : say(EXIT_USAGE, "--%s: found %s; allowed %s", name, text[0] != '\0' ? text : "nothing",
                     allowed);
}

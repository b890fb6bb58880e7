#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "advise.h"
#include "kernel_bytes.h"
#include "mctau/stepper.h"
#include "say.h"

enum { MOST_SUBSTEPS = 128, MOST_STEPS = 400000 };
#define FIRST_ORDER 0.05 /* an estimate up to which it is used */
#define ACCURATE    0.05 /* of the tolerance: a stepper's own error that does not blur what effects do */

static const mct_system *system_of(const advice *self)
{
    return mct_systems[self->full.system];
}

static mct_scene changed(const mct_scene *scene, const change *one)
{
    mct_scene result = *scene;
    mct_key_set(&result, &one->key, one->to);
    return result;
}

/* Without what does nothing, and a reader refuses: a bound of a motor's voltage where there is no motor. */
static mct_scene with_acting_effects(const mct_scene *scene)
{
    mct_scene result = *scene;
    if (!(scene->effects & MCT_MOTOR)) {
        result.effects &= ~(uint32_t)MCT_SATURATION;
    }
    return result;
}

/* --- what could be left out, and what is --- */

static change *add_change(change *list, int *count, int table, mct_scene_key key, double from, double to)
{
    list[*count] = (change){.table = table,
                            .key = key,
                            .from = from,
                            .to = to,
                            .time_scale = (double)NAN,
                            .estimate = {(double)NAN, 0, 0}};
    return &list[(*count)++];
}

static change *keep(change *one, const char *reason)
{
    one->is_fixed = true;
    one->reason = reason;
    return one;
}

static bool has_choice(const advice *self, const mct_effect *effect, int choice)
{
    return choice < 3 && effect->bits[choice] != 0 && (effect->bits[choice] & ~system_of(self)->effects) == 0;
}

/* Each step down from where an effect stands. */
static void find_effects(advice *self)
{
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        const mct_scene_key key = mct_key_at(MCT_TABLE_EFFECTS, system_of(self), i);
        const int now = (int)mct_key_get(&self->full, &key);
        const bool is_motor = (key.effect->mask & MCT_MOTOR) != 0;
        for (int to = now - 1; to >= (is_motor ? 1 : 0); to--) {
            if (to == 0 || has_choice(self, key.effect, to)) {
                add_change(self->list, &self->count, MCT_TABLE_EFFECTS, key, now, to);
            }
        }
        if (is_motor && now == 1) {
            keep(add_change(self->list, &self->count, MCT_TABLE_EFFECTS, key, now, now),
                 "without it the input would be a force");
        }
    }
}

/* What a controller sees through. */
static void find_sensors(advice *self)
{
    const mct_system *system = system_of(self);
    int table = 0;
    while (strcmp(mct_table_name(table), "sensors") != 0) {
        table++;
    }
    for (int i = 0; i < mct_key_count(table, system); i++) {
        const mct_scene_key key = mct_key_at(table, system, i);
        const bool is_encoder = i >= mct_scene_tables[table].field_count;
        const bool is_latency = key.field.offset == offsetof(mct_scene, latency);
        const bool is_noise = key.field.offset == offsetof(mct_scene, noise);
        const double value = is_encoder || is_latency || is_noise ? mct_key_get(&self->full, &key) : 0;
        if ((is_latency || is_noise) && value > 0) {
            change *one = add_change(self->list, &self->count, table, key, value, 0);
            one->time_scale = is_latency ? value * self->full.dt : (double)NAN;
        } else if (is_encoder) {
            keep(add_change(self->list, &self->count, table, key, value, value), "how the controller sees");
        }
    }
}

bool advise_would_read(const advice *self, const change *one, const mct_scene_key *parameter)
{
    const mct_effect *effect = one->key.effect;
    const uint32_t readers = parameter->rows != NULL ? parameter->rows->effects : parameter->field.effects;
    const uint32_t present = self->full.effects & effect->mask;
    const uint32_t more = effect->bits[(int)one->to] & ~present;
    const bool is_there = parameter->rows != NULL || mct_key_get(&self->file->scene, parameter) != 0;
    return is_there && (readers & more) != 0 && (readers & present) == 0;
}

/* A step up from where an effect stands, when a coefficient that is not 0 speaks of it. */
static void find_left_out(advice *self)
{
    const mct_system *system = system_of(self);
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        const mct_scene_key key = mct_key_at(MCT_TABLE_EFFECTS, system, i);
        const int now = (int)mct_key_get(&self->full, &key);
        const bool needs_motor = (key.effect->mask & (MCT_MOTOR | MCT_SATURATION)) != 0;
        const int to = now == 0 && !has_choice(self, key.effect, 1) ? 2 : now + 1;
        if (!has_choice(self, key.effect, to) || (needs_motor && !(self->full.effects & MCT_MOTOR))) {
            continue;
        }
        const change *one =
            add_change(self->left_out, &self->left_out_count, MCT_TABLE_EFFECTS, key, now, to);
        bool speaks = false;
        for (int j = 0; j < mct_key_count(MCT_TABLE_PARAMETERS, system); j++) {
            const mct_scene_key parameter = mct_key_at(MCT_TABLE_PARAMETERS, system, j);
            speaks = speaks || advise_would_read(self, one, &parameter);
        }
        self->left_out_count -= speaks ? 0 : 1;
    }
}

/* --- runs --- */

/* Rows of a scene's run, to be freed; NULL when it diverges or nothing suits. */
static double *follow(const advice *self, const mct_scene *scene)
{
    mct_message why;
    const mct_runner *runner = find_runner(MCT_PRECISION_DOUBLE);
    double *rows = need_memory(malloc((self->ticks + 1) * (uint64_t)mct_state_count(scene) * sizeof *rows));
    trial asked = {.inputs = self->about.inputs, .ticks = self->ticks, .states = rows};
    mct_status status = mct_scene_check(scene, &why);
    if (status == MCT_OK) {
        status = self->is_loop ? runner->loop(scene, self->ticks, rows, &asked.diverged, &why)
                               : runner->try(scene, &asked, &why);
    }
    if (status != MCT_OK || asked.diverged) {
        free(rows);
        return NULL;
    }
    return rows;
}

/* Where two runs differ most; infinite when there is no second one. */
static departure compare(const advice *self, const double *rows, int width, const double *others,
                         int other_width)
{
    departure found = {others == NULL ? (double)INFINITY : 0, 0, 0};
    for (uint64_t tick = 0; others != NULL && tick <= self->ticks; tick++) {
        int state;
        const double size =
            state_distance(system_of(self), self->moving, self->scale, rows + tick * (uint64_t)width,
                           others + tick * (uint64_t)other_width, &state);
        if (size > found.size) {
            found = (departure){size, state, tick};
        }
    }
    return found;
}

/* By how much a scene's run differs from the full one. */
static departure departure_of(const advice *self, const mct_scene *scene)
{
    double *rows = follow(self, scene);
    const departure found = compare(self, self->rows, self->run.width, rows, mct_state_count(scene));
    free(rows);
    return found;
}

/* What steps half as long change in a run. */
static double own_error(const advice *self, const mct_scene *scene, const double *rows)
{
    mct_scene finer = *scene;
    finer.stride = 1;
    finer.substeps = scene->stride > 1 ? 1 : 2 * scene->substeps;
    double *others = follow(self, &finer);
    const double found = compare(self, rows, mct_state_count(scene), others, mct_state_count(scene)).size;
    free(others);
    return found;
}

/* --- a stepper that all scenes of a comparison share --- */

typedef struct {
    int32_t stepper, substeps, stride;
} method;

static mct_scene by_method(const mct_scene *scene, method how)
{
    mct_scene result = *scene;
    result.stepper = how.stepper;
    result.substeps = how.substeps;
    result.stride = how.stride;
    return result;
}

static bool suits(const mct_scene *scene, method how)
{
    const mct_scene asked = by_method(scene, how);
    return mct_scene_check(&asked, NULL) == MCT_OK;
}

/* Whether it suits the full scene, and with each of the changes. */
static bool suits_all(const advice *self, const change *list, int count, method how)
{
    bool all = suits(&self->full, how);
    for (int i = 0; i < count && all; i++) {
        const mct_scene other = changed(&self->full, &list[i]);
        all = list[i].is_fixed || suits(&other, how);
    }
    return all;
}

/* The stepper of the highest order, at the fewest steps a tick; substeps 0: there is none. */
static method best_method(const advice *self, const change *list, int count)
{
    method best = {0, 0, 1};
    for (int32_t i = 0; i < MCT_STEPPER_COUNT; i++) {
        const bool better = best.substeps == 0 || mct_steppers[i].order >= mct_steppers[best.stepper].order;
        bool found = false;
        for (int32_t substeps = 1; better && !found && substeps <= MOST_SUBSTEPS; substeps *= 2) {
            found = suits_all(self, list, count, (method){i, substeps, 1});
            best = found ? (method){i, substeps, 1} : best;
        }
    }
    return best;
}

static void set_scale(advice *self)
{
    for (int i = 0; i < self->moving; i++) {
        self->scale[i] = 1;
        for (uint64_t tick = 0; tick <= self->ticks; tick++) {
            self->scale[i] =
                fmax(self->scale[i], fabs(self->rows[tick * (uint64_t)self->run.width + (uint64_t)i]));
        }
    }
}

/* The full run by a method; false when it diverges. */
static bool run_full(advice *self, method how)
{
    self->full = by_method(&self->full, how);
    free(self->rows);
    self->rows = follow(self, &self->full);
    self->run = (course){self->about.inputs, self->rows, mct_state_count(&self->full), self->ticks};
    if (self->rows == NULL) {
        self->own = (double)INFINITY;
        return false;
    }
    set_scale(self);
    self->own = own_error(self, &self->full, self->rows);
    return true;
}

/* The scene's own method where it is accurate enough; else the best one, at steps so short that it is. */
static void find_method(advice *self)
{
    const double allowed = ACCURATE * self->tolerance;
    const method own = {self->full.stepper, self->full.substeps, self->full.stride};
    method how = best_method(self, self->list, self->count), best = own;
    double least = (double)INFINITY;
    if (suits_all(self, self->list, self->count, own) && run_full(self, own)) {
        least = self->own;
    }
    for (bool helps = true; helps && least > allowed && how.substeps > 0; how.substeps *= 2) {
        const bool better = run_full(self, how) && self->own < 0.5 * least;
        if (better) {
            least = self->own;
            best = how;
        }
        /* Not where encoders count: there any difference grows to a count's. */
        helps = (better || !self->is_loop) && 2 * how.substeps <= MOST_SUBSTEPS &&
                (uint64_t)how.substeps * self->ticks <= MOST_STEPS;
    }
    (void)run_full(self, best);
}

/* --- estimates --- */

/* To first order: what each does in a tick, carried on. */
static void estimate_first_order(advice *self, change *list, int count)
{
    int places[MOST_CHANGES], others = 0;
    departure found[MOST_CHANGES];
    mct_message why;
    const method ticked = {self->full.stepper, self->full.substeps, 1}; /* a defect is one tick's */
    const mct_scene full = by_method(&self->full, ticked);
    mct_scene *scenes = need_memory(malloc(MOST_CHANGES * sizeof *scenes));
    for (int i = 0; i < count; i++) {
        if (!list[i].is_fixed && !list[i].by_run) {
            const mct_scene other = changed(&self->full, &list[i]);
            places[others] = i;
            scenes[others++] = by_method(&other, ticked);
        }
    }
    const mct_status status = find_runner(MCT_PRECISION_DOUBLE)
                                  ->depart(&full, &self->run, self->scale, scenes, others, found, &why);
    for (int i = 0; i < others && status == MCT_OK; i++) {
        list[places[i]].estimate = found[i];
    }
    free(scenes);
}

/*
 * To first order; but by a run where a controller closes the loop, where dry friction holds what would move without it,
 * and where the estimate is too large for a first order to mean much.
 */
static void estimate(advice *self, change *list, int count)
{
    for (int i = 0; i < count; i++) {
        change *one = &list[i];
        const mct_scene other = changed(&self->full, one);
        const bool is_on = one->to < one->from;
        if (one->key.effect != NULL && one->to != one->from) {
            one->time_scale =
                find_runner(MCT_PRECISION_DOUBLE)
                    ->time_scale(is_on ? &self->full : &other, is_on ? &other : &self->full, &self->run);
        }
        one->by_run = self->is_loop || (one->key.effect != NULL && (one->key.effect->mask & MCT_COULOMB));
    }
    if (!self->is_loop) {
        estimate_first_order(self, list, count);
    }
    for (int i = 0; i < count; i++) {
        change *one = &list[i];
        one->by_run = one->by_run || !(one->estimate.size < FIRST_ORDER);
        if (!one->is_fixed && one->by_run) {
            const mct_scene other = changed(&self->full, one);
            one->estimate = departure_of(self, &other);
            one->reason = isinf(one->estimate.size) ? "the scene does not run without it" : NULL;
        }
    }
}

/* Of a change that the full run's stepper does not suit: beside a full run by one that does. */
static void estimate_beside(const advice *self, change *one)
{
    advice beside = *self;
    beside.rows = NULL;
    const method own = {self->full.stepper, self->full.substeps, self->full.stride};
    const bool was_fixed = one->is_fixed;
    one->is_fixed = false;
    method how = suits_all(self, one, 1, own) ? own : best_method(self, one, 1);
    if (how.substeps > 0 && how.substeps < self->full.substeps) {
        how.substeps = self->full.substeps;
    }
    if (how.substeps > 0 && run_full(&beside, how)) {
        estimate(&beside, one, 1);
    } else {
        keep(one, "no stepper suits with it and without it");
    }
    free(beside.rows);
    one->is_fixed = one->is_fixed || was_fixed;
}

static void estimate_all(advice *self)
{
    estimate(self, self->list, self->count);
    for (int i = 0; i < self->count; i++) {
        if (self->list[i].needs_stepper) {
            estimate_beside(self, &self->list[i]);
            keep(&self->list[i], "the scene's stepper needs it");
        }
    }
    /* A factor, as a ratio of two frictions, is not 0 and says nothing by itself: what would change nothing is not told. */
    int count = 0;
    for (int i = 0; i < self->left_out_count; i++) {
        change one = self->left_out[i];
        estimate_beside(self, &one);
        if (one.is_fixed || one.estimate.size != 0) {
            self->left_out[count++] = one;
        }
    }
    self->left_out_count = count;
}

/* --- the choice --- */

static mct_scene without_dropped(const advice *self, const mct_scene *scene)
{
    mct_scene result = *scene;
    for (int i = 0; i < self->count; i++) {
        if (self->list[i].is_dropped) {
            mct_key_set(&result, &self->list[i].key, self->list[i].to);
        }
    }
    return result;
}

static double bound_of(const advice *self)
{
    double sum = 0;
    for (int i = 0; i < self->count; i++) {
        sum += self->list[i].is_dropped ? self->list[i].estimate.size : 0;
    }
    return sum;
}

/* What is dropped of the same effect already, one step down of two; NULL: nothing. */
static change *dropped_before(advice *self, const change *one)
{
    for (int i = 0; i < self->count; i++) {
        change *other = &self->list[i];
        if (other->is_dropped && other->table == one->table &&
            strcmp(other->key.field.name, one->key.field.name) == 0) {
            return other;
        }
    }
    return NULL;
}

/* By rising estimate while the sum stays within the tolerance; order[i] is the i-th that was dropped. */
static int drop(advice *self, change **order)
{
    bool seen[MOST_CHANGES] = {false};
    int dropped = 0;
    for (;;) {
        int least = -1;
        for (int i = 0; i < self->count; i++) {
            const change *one = &self->list[i];
            if (!seen[i] && !one->is_fixed && one->estimate.size <= self->tolerance &&
                (least < 0 || one->estimate.size < self->list[least].estimate.size)) {
                least = i;
            }
        }
        if (least < 0) {
            return dropped;
        }
        seen[least] = true;
        change *one = &self->list[least], *before = dropped_before(self, one);
        if (before != NULL && before->to <= one->to) {
            one->reason = "more of the effect is dropped";
            continue;
        }
        const double replaced = before != NULL ? before->estimate.size : 0;
        if (bound_of(self) + one->estimate.size - replaced > self->tolerance) {
            one->reason = "together with the others it would change too much";
            continue;
        }
        if (before != NULL) {
            before->is_dropped = false;
            before->reason = "more of the effect is dropped";
        }
        one->is_dropped = true;
        one->reason = "changes little";
        order[dropped++] = one;
    }
}

/* A run without what is dropped, and one of steps half as long. */
static bool verify(advice *self)
{
    self->pruned = without_dropped(self, &self->full);
    double *rows = follow(self, &self->pruned);
    self->verified = compare(self, self->rows, self->run.width, rows, mct_state_count(&self->pruned)).size;
    self->uncertainty = self->own;
    if (rows != NULL) {
        self->uncertainty = fmax(self->own, own_error(self, &self->pruned, rows));
    }
    free(rows);
    return self->verified + self->uncertainty <= self->tolerance;
}

/* Drops what it can, and takes the last back until a run agrees. */
static void choose(advice *self)
{
    change *order[MOST_CHANGES];
    int dropped = drop(self, order);
    while (!(self->is_certified = verify(self)) && dropped > 0) {
        change *last = order[--dropped];
        if (!last->is_dropped) { /* one step down of two, of which more was dropped */
            continue;
        }
        last->is_dropped = false;
        last->reason = "verification refused to drop it";
        self->taken_back++;
        for (int i = dropped - 1; i >= 0 && dropped_before(self, last) == NULL; i--) {
            if (strcmp(order[i]->key.field.name, last->key.field.name) == 0) { /* what it had replaced */
                order[i]->is_dropped = true;
                order[i]->reason = "changes little";
            }
        }
    }
    for (int i = 0; i < self->count; i++) {
        change *one = &self->list[i];
        if (one->reason == NULL) {
            one->reason = "changes more than the tolerance";
        }
    }
    self->refusal = self->is_certified ? NULL : "steps half as long change even the full run by more";
    self->bound = self->is_certified ? bound_of(self) : (double)NAN;
}

mct_scene advise_pruned_scene(const advice *self)
{
    const mct_scene scene = with_acting_effects(&self->file->scene);
    return without_dropped(self, &scene);
}

/* --- costs --- */

/* The scene as it is, with a change of its effects. */
static candidate cost_of(const advice *self, uint32_t effects)
{
    const mct_scene *scene = &self->file->scene;
    return (candidate){.stepper = scene->stepper,
                       .precision = scene->precision,
                       .multiple = 1,
                       .substeps = scene->substeps,
                       .without = self->about.scene.effects & ~effects,
                       .with = effects & ~self->about.scene.effects,
                       .ns = (double)NAN,
                       .instructions = (double)NAN};
}

/* Every mask once: "1000 3:0 8:10", ticks, then what is left out and added. */
static char *note_of(const advice *self, const candidate *list, int count)
{
    const size_t size = 32 + 24 * (size_t)count;
    char *note = need_memory(malloc(size));
    int used = snprintf(note, size, "%llu", (unsigned long long)self->ticks);
    for (int i = 0; i < count; i++) {
        used += snprintf(note + used, size - (size_t)used, " %x:%x", (unsigned)list[i].without,
                         (unsigned)list[i].with);
    }
    return note;
}

int advise_count_again(const scene_file *file, const char *note)
{
    advice self = {.file = file};
    char *end;
    const int exit_code = study_begin_again(&self.about, file, strtoull(note, &end, 10));
    if (exit_code == 0) {
        candidate list[MOST_CHANGES + 2];
        int count = 0;
        while (*end == ' ' && count < MOST_CHANGES + 2) {
            list[count] = cost_of(&self, self.about.scene.effects);
            list[count].without = (uint32_t)strtoul(end + 1, &end, 16);
            list[count++].with = (uint32_t)strtoul(end + 1, &end, 16);
        }
        study_count_again(&self.about, list, count);
        study_end(&self.about);
    }
    return exit_code;
}

static void find_costs(advice *self)
{
    candidate *places[MOST_CHANGES + 2], list[MOST_CHANGES + 2];
    int count = 0;
    self->full_cost = cost_of(self, self->full.effects);
    self->pruned_cost = cost_of(self, self->pruned.effects);
    places[count++] = &self->full_cost;
    places[count++] = &self->pruned_cost;
    for (int i = 0; i < self->count; i++) {
        change *one = &self->list[i];
        one->cost = cost_of(self, changed(&self->full, one).effects);
        if (one->key.effect != NULL && one->to != one->from && study_suits(&self->about, &one->cost)) {
            places[count++] = &one->cost;
        }
    }
    for (int i = 0; i < count; i++) {
        list[i] = *places[i];
    }
    study_time(&self->about, list, count);
    char *note = note_of(self, list, count);
    self->not_counted = study_count(&self->about, list, count, self->file->path, note, &self->counter);
    free(note);
    for (int i = 0; i < count; i++) {
        *places[i] = list[i];
    }
}

double advise_flash(const advice *self, const candidate *with, const candidate *without)
{
    const candidate *both[2] = {with, without};
    double bytes[2];
    for (int i = 0; i < 2; i++) {
        mct_scene scene = self->about.scene;
        scene.effects = (scene.effects & ~both[i]->without) | both[i]->with;
        const int known = mct_kernel_bytes(scene.system, both[i]->stepper, mct_scene_effects(&scene));
        bytes[i] = known >= 0 ? known : (double)NAN;
    }
    return bytes[0] - bytes[1];
}

bool advise_is_near_tick(const advice *self, double time_scale)
{
    const double ratio = time_scale / self->full.dt;
    return ratio >= 0.1 && ratio <= 10;
}

/* --- all of it --- */

/* What the scene's stepper needs stays, unless it is chosen anew at every run. */
static void keep_what_stepper_needs(advice *self)
{
    const mct_scene *scene = &self->file->scene;
    for (int i = 0; i < self->count && !scene->automatic; i++) {
        const mct_scene other = changed(scene, &self->list[i]);
        if (mct_scene_check(&other, NULL) != MCT_OK) {
            self->list[i].needs_stepper = self->list[i].is_fixed = true;
        }
    }
}

static void find_scene(advice *self)
{
    self->is_loop = self->file->scene.controller != MCT_CONTROLLER_NONE;
    self->full = with_acting_effects(self->is_loop ? &self->file->scene : &self->about.scene);
    self->full.precision = MCT_PRECISION_DOUBLE;
    self->ticks = self->about.ticks;
    self->full.duration = (double)self->ticks * self->full.dt;
    self->moving = mct_rate_index(system_of(self)) + system_of(self)->coordinate_count;
    self->pruned = self->full;
}

int advise_begin(advice *self, const scene_file *file, double tolerance, int counter)
{
    memset(self, 0, sizeof *self);
    self->file = file;
    self->tolerance = tolerance;
    self->counter = counter;
    const int exit_code = study_begin_inputs(&self->about, file);
    if (exit_code != 0) {
        return exit_code;
    }
    find_scene(self);
    if (system_of(self)->effects == 0) {
        advise_end(self);
        return say(EXIT_USAGE, "scene.system: found %s, which has no effects to leave out",
                   system_of(self)->name);
    }
    find_effects(self);
    if (self->is_loop) {
        find_sensors(self);
    }
    keep_what_stepper_needs(self);
    find_left_out(self);
    find_method(self);
    if (self->rows == NULL) {
        advise_end(self);
        return say(EXIT_CHECK_FAILED,
                   "the scene diverges: there is nothing to compare with; --duration takes less of it");
    }
    estimate_all(self);
    choose(self);
    find_costs(self);
    return 0;
}

void advise_end(advice *self)
{
    free(self->rows);
    self->rows = NULL;
    study_end(&self->about);
}

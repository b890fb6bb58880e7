#include "runner_advise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "candidates.h"
#include "mctau/plant.h"
#include "say.h"

/* Coordinates and rates, which all scenes of a system have. */
static int moving_states(const mct_plant *plant)
{
    return mct_rate_index(plant->system) + plant->system->coordinate_count;
}

static mct_real input_at(const course *along, uint64_t tick)
{
    return along->inputs != NULL ? (mct_real)along->inputs[tick] : 0;
}

/* --- departures --- */

/*
 * A scene without an effect departs from the full one in each tick by a defect: its own tick, begun at the full one's
 * state, minus the full one's. Defects add up as deviations, which the full scene's tick carries on as it does any small
 * change of its state: d <- T d + defect.
 */

#define NUDGE 1e-6 /* of a state, for differences: far above rounding, far below what bends the motion */

/* Sets a plant to another's state: what both have; what one of them lacks, as a current, goes its own way. */
static void set_state(mct_plant *plant, const mct_plant *full)
{
    const int shared = plant->states == full->states ? full->entries : moving_states(full);
    for (int i = 0; i < shared; i++) {
        plant->state.x[i] = full->state.x[i];
        plant->state.c[i] = full->state.c[i];
    }
    memcpy(plant->state.turns, full->state.turns, sizeof plant->state.turns);
}

/* The tick's derivative by the state at its beginning; a state's rounding counts as nothing. */
static void find_tangent(const mct_plant *before, mct_plant *probe, mct_real input,
                         double T[][RUNNER_MAX_STATES])
{
    for (int j = 0; j < before->states; j++) {
        double ends[2][RUNNER_MAX_STATES], places[2];
        for (int side = 0; side < 2; side++) {
            const double nudge = NUDGE * fmax(1, fabs((double)before->state.x[j]));
            set_state(probe, before);
            memset(probe->state.c, 0, sizeof probe->state.c);
            probe->state.x[j] += (mct_real)(side == 0 ? nudge : -nudge);
            places[side] = (double)probe->state.x[j];
            mct_plant_step(probe, input);
            for (int i = 0; i < before->states; i++) {
                ends[side][i] = mct_plant_value(probe, i);
            }
        }
        for (int i = 0; i < before->states; i++) {
            T[i][j] = (ends[0][i] - ends[1][i]) / (places[0] - places[1]);
        }
    }
}

typedef struct {
    mct_plant plant;
    bool is_known; /* it could be prepared */
    double deviation[RUNNER_MAX_STATES];
} departing;

/* Over one tick of the full plant, from `before` to `after`. */
static void carry_on(departing *self, const mct_plant *before, const mct_plant *after, mct_real input,
                     double T[][RUNNER_MAX_STATES])
{
    const bool alike = self->plant.states == after->states;
    double deviation[RUNNER_MAX_STATES];
    set_state(&self->plant, before);
    mct_plant_step(&self->plant, input);
    for (int i = 0; i < after->states; i++) {
        const bool has_defect = (alike || i < moving_states(after)) && !mct_state_is_phase(after->system, i);
        deviation[i] = has_defect ? mct_plant_value(&self->plant, i) - mct_plant_value(after, i) : 0;
        for (int j = 0; j < after->states; j++) {
            deviation[i] += self->deviation[j] != 0 ? T[i][j] * self->deviation[j] : 0;
        }
    }
    memcpy(self->deviation, deviation, sizeof deviation);
}

static void note_largest(const departing *self, const mct_plant *full, const double *scale, departure *found)
{
    double here[RUNNER_MAX_STATES], there[RUNNER_MAX_STATES];
    const int moving = moving_states(full);
    for (int i = 0; i < moving; i++) {
        here[i] = mct_plant_value(full, i);
        there[i] = here[i] + self->deviation[i];
    }
    int state;
    const double size = state_distance(full->system, moving, scale, here, there, &state);
    if (size > found->size) {
        *found = (departure){size, state, full->tick};
    }
}

mct_status runner_depart(const mct_scene *scene, const course *along, const double *scale,
                         const mct_scene *others, int count, departure *found, mct_message *why)
{
    mct_plant full, before, probe;
    double T[RUNNER_MAX_STATES][RUNNER_MAX_STATES];
    mct_message_clear(why);
    const mct_status status = mct_plant_init(&full, scene, why);
    if (status != MCT_OK) {
        return status;
    }
    departing *all = need_memory(calloc((size_t)count + 1, sizeof *all));
    for (int i = 0; i < count; i++) {
        mct_message unsaid;
        all[i].is_known = mct_plant_init(&all[i].plant, &others[i], &unsaid) == MCT_OK;
        found[i] = (departure){all[i].is_known ? 0 : (double)NAN, 0, 0};
    }
    before = probe = full;
    while (full.tick < along->ticks) {
        const mct_real input = input_at(along, full.tick);
        before.state = full.state;
        mct_plant_step(&full, input);
        find_tangent(&before, &probe, input, T);
        for (int i = 0; i < count; i++) {
            if (all[i].is_known) {
                carry_on(&all[i], &before, &full, input, T);
                note_largest(&all[i], &full, scale, &found[i]);
            }
        }
    }
    free(all);
    return MCT_OK;
}

/* --- time scales --- */

enum { SAMPLES = 33 };

/* The largest magnitude of a matrix's eigenvalues: |J^256|^(1/256), which does not depend on units. */
static double spectral_radius(int n, double J[][RUNNER_MAX_COORDINATES])
{
    double logarithm = 0, part = 1;
    for (int squaring = 0; squaring < 8; squaring++, part /= 2) {
        double norm = 0, square[RUNNER_MAX_COORDINATES][RUNNER_MAX_COORDINATES] = {{0}};
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                norm = fmax(norm, fabs(J[i][j]));
            }
        }
        if (!(norm > 0)) {
            return 0;
        }
        logarithm += part * log(norm);
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                for (int k = 0; k < n; k++) {
                    square[i][j] += J[i][k] / norm * (J[k][j] / norm);
                }
            }
        }
        memcpy(J, square, sizeof square);
    }
    return exp(logarithm);
}

/* Moves a coordinate, or its rate; of a rotation, turns it about one of its axes. */
static void move(const mct_system *system, double *states, int coordinate, bool is_rate, double by)
{
    const int n = system->coordinate_count, rate = mct_rate_index(system);
    const int axis = coordinate - (n - 3);
    if (is_rate || system->attitude == MCT_ATTITUDE_NONE || axis < 0) {
        states[is_rate ? rate + coordinate : coordinate] += by;
        return;
    }
    double *q = states + rate - 4;
    const double w = q[0], x = q[1 + axis], y = q[1 + (axis + 1) % 3], z = q[1 + (axis + 2) % 3];
    q[0] -= by / 2 * x;
    q[1 + axis] += by / 2 * w;
    q[1 + (axis + 1) % 3] -= by / 2 * z;
    q[1 + (axis + 2) % 3] += by / 2 * y;
}

/* Two scenes of which one has an effect, at one state. */
typedef struct {
    mct_plant with, without;
    double states[RUNNER_MAX_STATES]; /* coordinates and rates */
    mct_real time, input;
} contrast;

static void evaluate(mct_plant *plant, const contrast *at, mct_evaluation *out)
{
    const mct_state start = plant->state; /* whose current or phases stand in */
    const int moving = moving_states(plant);
    mct_state_set(plant->system, moving, at->states, &plant->state);
    for (int i = moving; i < plant->states; i++) {
        plant->state.x[i] = start.x[i];
    }
    plant->state.x[plant->states] = at->time; /* read where the system is timed */
    plant->input = at->input;
    mct_plant_evaluate(plant, out);
    plant->state = start;
}

/* What the effect adds to the accelerations; gives the largest of them all. */
static double added(contrast *self, double *acceleration)
{
    mct_evaluation with, without;
    double largest = 0;
    evaluate(&self->with, self, &with);
    evaluate(&self->without, self, &without);
    for (int i = 0; i < self->with.system->coordinate_count; i++) {
        acceleration[i] = (double)with.acceleration[i] - (double)without.acceleration[i];
        largest = fmax(largest, fabs((double)with.acceleration[i]));
    }
    return largest;
}

/* Largest eigenvalue of what it adds, by rates [1/s] or by coordinates [1/s^2]; 0 where only rounding is seen. */
static double response(contrast *self, bool is_rate)
{
    const double width = 1e-4, seen = 1e-9;
    const int n = self->with.system->coordinate_count;
    double J[RUNNER_MAX_COORDINATES][RUNNER_MAX_COORDINATES], start[RUNNER_MAX_STATES], largest = 1;
    memcpy(start, self->states, sizeof start);
    for (int j = 0; j < n; j++) {
        double ends[2][RUNNER_MAX_COORDINATES];
        for (int side = 0; side < 2; side++) {
            move(self->with.system, self->states, j, is_rate, side == 0 ? width : -width);
            largest = fmax(largest, added(self, ends[side]));
            memcpy(self->states, start, sizeof start);
        }
        for (int i = 0; i < n; i++) {
            J[i][j] = (ends[0][i] - ends[1][i]) / (2 * width);
        }
    }
    const double radius = spectral_radius(n, J);
    return radius > seen * largest ? radius : 0;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/*
 * The median along the run, so that a moment at which a force stands still or jumps does not decide. By rates, as
 * friction; else by coordinates, as weight and springs; else how long what it adds takes to make the largest rate.
 */
static double time_of_response(contrast *self, const course *along, double dt, bool responds)
{
    const int n = self->with.system->coordinate_count, rate = mct_rate_index(self->with.system);
    double by_rate[SAMPLES], by_place[SAMPLES], strongest[RUNNER_MAX_COORDINATES] = {0};
    double fastest[RUNNER_MAX_COORDINATES] = {0}, shortest = (double)INFINITY;
    for (int sample = 0; sample < SAMPLES; sample++) {
        double acceleration[RUNNER_MAX_COORDINATES];
        const uint64_t tick = along->ticks * (uint64_t)sample / SAMPLES;
        memcpy(self->states, along->states + tick * (uint64_t)along->width,
               (size_t)(rate + n) * sizeof(double));
        self->time = (mct_real)((double)tick * dt);
        self->input = input_at(along, tick);
        (void)added(self, acceleration);
        by_rate[sample] = responds ? response(self, true) : 0;
        by_place[sample] = responds ? response(self, false) : 0;
        for (int i = 0; i < n; i++) {
            strongest[i] = fmax(strongest[i], fabs(acceleration[i]));
            fastest[i] = fmax(fastest[i], fabs(self->states[rate + i]));
        }
    }
    qsort(by_rate, SAMPLES, sizeof by_rate[0], by_value);
    qsort(by_place, SAMPLES, sizeof by_place[0], by_value);
    for (int i = 0; i < n; i++) {
        if (strongest[i] > 1e-12 && fastest[i] > 0) {
            shortest = fmin(shortest, fastest[i] / strongest[i]);
        }
    }
    return by_rate[SAMPLES / 2] > 0    ? 1 / by_rate[SAMPLES / 2]
           : by_place[SAMPLES / 2] > 0 ? 1 / sqrt(by_place[SAMPLES / 2])
           : isfinite(shortest)        ? shortest
                                       : (double)NAN;
}

/* Angular frequency of the fastest phase that is an angle, 0 when there is none [rad/s]. */
static double phase_rate(const mct_scene *scene)
{
    mct_message why;
    mct_plant plant;
    mct_scene slow = *scene;
    double fastest = 0;
    slow.dt = scene->dt * 1e-3; /* so that no phase turns by half a turn */
    if (mct_plant_init(&plant, &slow, &why) == MCT_OK) {
        const mct_state start = plant.state;
        mct_plant_step(&plant, 0);
        for (int i = 0; i < plant.states; i++) {
            if (mct_state_is_phase_angle(plant.system, i)) {
                const double turned = (double)(plant.state.x[i] - start.x[i]);
                fastest = fmax(fastest, fabs(remainder(turned, 6.283185307179586)) / slow.dt);
            }
        }
    }
    return fastest;
}

double runner_time_scale(const mct_scene *with, const mct_scene *without, const course *along)
{
    mct_message why;
    const uint32_t effects = mct_scene_effects(with);
    const uint32_t more = effects & ~mct_scene_effects(without);
    const double turning = (more & MCT_CLOCK) ? phase_rate(with) : 0;
    if (more & MCT_MOTOR_INDUCTIVE) {
        const mct_actuation *actuation = mct_systems[with->system]->actuation;
        return with->parameters[actuation->inductance_parameter] /
               with->parameters[actuation->resistance_parameter];
    }
    if (turning > 0) {
        return 1 / turning;
    }
    contrast *self = need_memory(calloc(1, sizeof *self));
    mct_scene both[2] = {*with, *without};
    const bool responds = (more & MCT_COULOMB) == 0; /* dry friction jumps, its own and what changes it */
    for (int i = 0; i < 2 && responds; i++) {
        both[i].effects &= ~(uint32_t)MCT_COULOMB;
    }
    double found = (double)NAN;
    if ((more & MCT_KERNEL_EFFECTS) && mct_plant_init(&self->with, &both[0], &why) == MCT_OK &&
        mct_plant_init(&self->without, &both[1], &why) == MCT_OK) {
        found = time_of_response(self, along, with->dt, responds);
    }
    free(self);
    return found;
}

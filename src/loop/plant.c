#include "mctau/plant.h"

#include <string.h>

#include "mctau/compensated.h"
#include "mctau/matrix.h"

#define TURN 6.283185307179586476925
/*
 * A whole turn as the nearest mct_real and the rest, so that taking one out is exact to twice the precision.
 */
static const mct_real turn = MCT_R(TURN);
#if MCT_REAL_IS_FLOAT
static const mct_real turn_rest = -1.7484555e-07F;
#else
static const mct_real turn_rest = 2.4492935982947064e-16;
#endif

/*
 * Finite, sane, and nothing next to nothing, as nearly always: a quick look, by squares, that may also say no where the
 * closer ones below find all well.
 */
static bool is_ordinary(const mct_state *state, int entries)
{
    mct_real sum = 0;
    mct_real least = MCT_REAL_MAX;
    for (int i = 0; i < entries; i++) {
        const mct_real square = state->x[i] * state->x[i];
        sum += square;
        least = square < least ? square : least;
    }
    return sum <= MCT_STATE_BOUND * MCT_STATE_BOUND && least >= MCT_REAL_NOTHING;
}

/* Finite, and within what any mechanism can do in a tick; false for NaN. */
static bool is_sane(const mct_state *state, int states)
{
    bool sane = true;
    for (int i = 0; i < states; i++) {
        sane &= state->x[i] <= MCT_STATE_BOUND && state->x[i] >= -MCT_STATE_BOUND;
    }
    return sane;
}

/* What has decayed to next to nothing comes to rest. */
static void settle(mct_plant *plant)
{
    mct_state *state = &plant->state;
    for (int i = 0; i < plant->states; i++) {
        if (mct_settled(state->x[i]) == 0) {
            state->x[i] = 0 * state->x[i];
            state->c[i] = 0 * state->c[i];
        }
    }
}

/* An angle that swings about the hanging position is left alone. */
MCT_INLINE bool is_beyond_a_turn(mct_real angle)
{
    return mct_size(angle) > turn;
}

/*
 * Takes whole turns out of an angle beyond +-2 pi.
 * Turns are subtracted by powers of two from the largest down, so that each difference is exact; the rest of
 * a turn goes to the compensation. Returns how many.
 */
static int32_t take_turns(mct_state *state, int i)
{
    enum { LARGEST = 28 }; /* MCT_STATE_BOUND is less than 2^28 turns */
    const mct_real x = state->x[i];
    const mct_real sign = x < 0 ? -1 : 1;
    const int32_t turns = (int32_t)(sign * x / turn);
    mct_real left = sign * x;
    for (int bit = turns == 1 ? 0 : LARGEST; bit >= 0; bit--) { /* nearly always it is one */
        if (turns & (1 << bit)) {
            left -= (mct_real)(1 << bit) * turn;
        }
    }
    const mct_real rest = state->c[i] - sign * (mct_real)turns * turn_rest;
    state->x[i] = mct_two_sum(sign * left, rest, &state->c[i]);
    return x < 0 ? -turns : turns;
}

/* An angle's turns are counted; those of a phase mean nothing. */
static void wrap_angles(mct_plant *plant)
{
    const mct_system *system = plant->system;
    mct_state *state = &plant->state;
    for (int i = 0; i < system->coordinate_count; i++) {
        if (system->coordinates[i].is_angle && is_beyond_a_turn(state->x[i])) {
            /* Wraps after 2^31 turns, a year at 60 turns a second, as a counter does. */
            state->turns[i] = (int32_t)((uint32_t)state->turns[i] + (uint32_t)take_turns(state, i));
        }
    }
    if (system->phases != NULL) {
        for (int i = mct_rate_index(system) + system->coordinate_count; i < plant->states; i++) {
            if (mct_state_is_phase_angle(system, i) && is_beyond_a_turn(state->x[i])) {
                (void)take_turns(state, i);
            }
        }
    }
}

/* What makes the quaternion's length 1. */
static double attitude_scale(const mct_system *system, const double *values)
{
    if (system->attitude == MCT_ATTITUDE_NONE) {
        return 1;
    }
    const double *q = values + mct_rate_index(system) - 4;
    return 1 / mct_sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}

void mct_state_set(const mct_system *system, int states, const double *values, mct_state *state)
{
    memset(state, 0, sizeof *state);
    const int rate = mct_rate_index(system);
    const double shrink = attitude_scale(system, values);
    for (int i = 0; i < states; i++) {
        double value = values[i];
        if (i < system->coordinate_count && system->coordinates[i].is_angle) {
            state->turns[i] = (int32_t)(value / TURN);
            value -= state->turns[i] * TURN;
        } else if (mct_state_is_phase_angle(system, i)) {
            value -= (int32_t)(value / TURN) * TURN;
        }
        if (system->attitude != MCT_ATTITUDE_NONE && i >= rate - 4 && i < rate) {
            value *= shrink;
        }
        state->x[i] = (mct_real)value;
        state->c[i] = (mct_real)(value - (double)state->x[i]);
    }
}

mct_status mct_plant_init(mct_plant *plant, const mct_scene *scene, mct_message *why)
{
    memset(plant, 0, sizeof *plant);
    plant->system = mct_systems[scene->system];
    plant->effects = mct_scene_effects(scene);
    const mct_named_kernel *kernel = plant->system->kernel(scene->stepper, plant->effects);
    if (kernel == NULL) {
        mct_message_add(why, "scene.stepper: found ");
        mct_message_add(why, mct_steppers[scene->stepper].name);
        mct_message_add(why, ", which does not suit ");
        mct_message_add(why, plant->system->name);
        return MCT_ERROR_UNSUITED;
    }
    plant->kernel = kernel->function;
    if (scene->stride > 1 && (plant->system->motion == NULL || (plant->effects & MCT_COULOMB_EXACT))) {
        mct_message_add(why, "scene.stride: found a step over several ticks, for which ");
        mct_message_add(why, plant->system->name);
        mct_message_add(why, " has no series to hand");
        return MCT_ERROR_UNSUITED;
    }
    const bool has_motor = (plant->effects & MCT_MOTOR) != 0;
    const bool bounded = has_motor && (plant->effects & MCT_SATURATION_VOLTAGE);
    plant->substeps = scene->substeps;
    plant->stride.ticks = scene->stride;
    plant->bound =
        bounded ? (mct_real)scene->parameters[plant->system->actuation->supply_parameter] : MCT_REAL_MAX;
    if (plant->effects & MCT_SATURATION_CURRENT) {
        const mct_actuation *actuation = plant->system->actuation;
        plant->drop = (mct_real)(scene->parameters[actuation->current_limit_parameter] *
                                 scene->parameters[actuation->resistance_parameter]);
    }
    plant->limit = has_motor && (plant->effects & MCT_SATURATION_CURRENT) ? mct_plant_within_current
                   : bounded                                              ? mct_plant_within_voltage
                                                                          : NULL;
    plant->advance = scene->stride > 1 ? mct_plant_stride : NULL;
    plant->states = mct_state_count(scene);
    plant->entries = plant->states + (plant->system->is_timed ? 1 : 0);
    mct_state_set(plant->system, plant->states, scene->initial, &plant->state);
    return plant->system->prepare(scene, mct_scene_step(scene), &plant->constants, why);
}

/*
 * Changes of all states after the part f of a step: Horner's scheme in f^2, even and odd terms side by side, so that few
 * wait for each other.
 */
static void changes_after(const mct_motion *motion, mct_real f, mct_real *change)
{
    const mct_real square = f * f;
    for (int i = 0; i < MCT_MOTION_STATES; i++) {
        mct_real even = motion->term[MCT_MOTION_TERMS - 1][i];
        mct_real odd = motion->term[MCT_MOTION_TERMS - 2][i];
        for (int n = MCT_MOTION_TERMS - 3; n > 0; n -= 2) {
            even = motion->term[n][i] + square * even;
            odd = motion->term[n - 1][i] + square * odd;
        }
        even = motion->term[0][i] + square * even;
        change[i] = f * (even + f * odd);
    }
}

/* One tick further along the step that the stride is in, or on a new one. */
void mct_plant_stride(mct_plant *plant, bool is_new)
{
    mct_stride *stride = &plant->stride;
    mct_real change[MCT_MOTION_STATES];
    if (is_new || stride->gone == 0 || stride->gone == stride->ticks) {
        stride->start = plant->state;
        stride->gone = 0;
        plant->system->motion(&plant->constants, plant->effects, &stride->start, plant->input,
                              &stride->motion);
    }
    stride->gone++;
    changes_after(&stride->motion, (mct_real)stride->gone / (mct_real)stride->ticks, change);
    for (int i = 0; i < plant->states; i++) {
        plant->state.x[i] = stride->start.x[i];
        plant->state.c[i] = stride->start.c[i] + stride->motion.remainder * change[i];
        mct_add_compensated(&plant->state.x[i], &plant->state.c[i], change[i]);
    }
    for (int i = 0; i < plant->system->coordinate_count; i++) {
        plant->state.turns[i] = stride->start.turns[i];
    }
}

mct_real mct_plant_within_voltage(const mct_plant *plant, mct_real input)
{
    return mct_clamp(input, plant->bound);
}

/*
 * The voltage that a drive gives when it bounds its current: one that drives no more than that through the motor at
 * its present speed.
 */
mct_real mct_plant_within_current(const mct_plant *plant, mct_real input)
{
    const mct_actuation *actuation = plant->system->actuation;
    const mct_motor *motor = actuation->motor(&plant->constants);
    const int rate = plant->system->coordinate_count + actuation->driven_coordinate;
    const mct_real emf = motor->emf * plant->state.x[rate];
    const mct_real drop = input - emf;
    const mct_real within = drop > plant->drop    ? emf + plant->drop
                            : drop < -plant->drop ? emf - plant->drop
                                                  : input;
    return mct_plant_within_voltage(plant, within);
}

void mct_plant_step(mct_plant *plant, mct_real input)
{
    const mct_real before = plant->input;
    if (mct_finite(input)) {
        plant->input = plant->limit != NULL ? plant->limit(plant, input) : input;
    } else {
        plant->rejected_inputs++;
    }
    /* In place: copying what a kernel has just written would wait for its stores. */
    mct_real x[MCT_MAX_STATES], c[MCT_MAX_STATES];
    for (int i = 0; i < plant->entries; i++) {
        x[i] = plant->state.x[i];
        c[i] = plant->state.c[i];
    }
    if (plant->advance != NULL) {
        plant->advance(plant, plant->input != before);
    } else {
        plant->kernel(&plant->constants, &plant->state, plant->input, plant->substeps);
    }
    if (is_ordinary(&plant->state, plant->entries)) {
        wrap_angles(plant);
    } else if (is_sane(&plant->state, plant->entries)) {
        wrap_angles(plant);
        settle(plant);
    } else {
        for (int i = 0; i < plant->entries; i++) {
            plant->state.x[i] = x[i];
            plant->state.c[i] = c[i];
        }
        plant->stride.gone = 0;
        plant->diverged_ticks++;
    }
    plant->tick++;
}

double mct_plant_value(const mct_plant *plant, int index)
{
    const mct_state *state = &plant->state;
    const double within = (double)state->x[index] + (double)state->c[index];
    return index < plant->system->coordinate_count ? within + state->turns[index] * TURN : within;
}

void mct_plant_evaluate(const mct_plant *plant, mct_evaluation *out)
{
    plant->system->evaluate(&plant->constants, plant->effects, plant->state.x, plant->input, out);
}

#include "mctau/watch.h"

#include <string.h>

#include "mctau/matrix.h"

/* Of what is in motion: more than this cannot have come from errors of steps that follow the motion. */
#define IMPOSSIBLE 0.5

/* Whether a surface that rubs moves: a coefficient of dry friction that is a speed. */
static bool has_belt(const mct_plant *plant, const mct_scene *scene)
{
    for (int i = 0; i < plant->system->parameter_count; i++) {
        const mct_field *field = &plant->system->parameters[i];
        if (field->effects == MCT_COULOMB && field->unit[0] == 'm' && scene->parameters[i] != 0) {
            return true;
        }
    }
    return false;
}

/* Whether all that does work is the input, forces with a potential, and friction against what rests. */
static bool has_one_source(const mct_plant *plant, const mct_scene *scene)
{
    if ((plant->effects & MCT_SOURCES) || plant->system->is_timed || plant->system->is_process) {
        return false;
    }
    if (plant->effects & MCT_MOTOR_INDUCTIVE) {
        const mct_motor *motor = plant->system->actuation->motor(&plant->constants);
        return motor->resistance > 0 && motor->force_per_ampere == motor->emf;
    }
    return !(plant->effects & MCT_COULOMB) || !has_belt(plant, scene);
}

/* What an input of 1 adds to the forces of a body that moves, so that dry friction is the same with it. */
static void find_force(mct_watch *watch, const mct_plant *plant)
{
    mct_evaluation e;
    mct_real x[MCT_MAX_STATES];
    memcpy(x, plant->state.x, sizeof x);
    for (int i = mct_rate_index(plant->system); i < plant->states; i++) {
        x[i] = 1;
    }
    for (int input = 0; input <= 1; input++) {
        plant->system->evaluate(&plant->constants, plant->effects, x, (mct_real)input, &e);
        for (int i = 0; i < plant->system->coordinate_count; i++) {
            watch->force[i] = (double)e.tau[i] - watch->force[i];
        }
    }
}

void mct_watch_start(mct_watch *watch, const mct_plant *plant, const mct_scene *scene)
{
    mct_evaluation e;
    memset(watch, 0, sizeof *watch);
    watch->is_watched = has_one_source(plant, scene);
    if (!watch->is_watched) {
        return;
    }
    watch->dt = scene->dt;
    for (int i = 0; i < plant->states; i++) {
        watch->before[i] = mct_plant_value(plant, i);
    }
    mct_plant_evaluate(plant, &e);
    watch->energy = (double)e.kinetic_energy + (double)e.potential_energy + (double)e.magnetic_energy;
    find_force(watch, plant);
}

/* Adds the work of a force, or of a voltage by the charge, that goes with a state's change over the present tick. */
static void add_work(mct_watch *watch, const mct_plant *plant, int index, double force)
{
    const double now = mct_plant_value(plant, index);
    watch->work += force * (now - watch->before[index]);
    watch->rounding += DBL_EPSILON * mct_abs(force * now);
    watch->before[index] = now;
}

/* What the input did over a tick. A motor's charge follows from L di/dt = V - R i - emf w. */
static void add_work_of_input(mct_watch *watch, const mct_plant *plant)
{
    const int n = plant->system->coordinate_count;
    const double input = (double)plant->input;
    if (plant->effects & MCT_MOTOR_INDUCTIVE) {
        const mct_motor *motor = plant->system->actuation->motor(&plant->constants);
        const double current = input * (double)motor->conductance;
        const double short_circuit = input * current * watch->dt;
        watch->work += short_circuit;
        watch->rounding += DBL_EPSILON * short_circuit;
        add_work(watch, plant, mct_rate_index(plant->system) + n, -current * (double)motor->inductance);
        add_work(watch, plant, plant->system->actuation->driven_coordinate, -current * (double)motor->emf);
        return;
    }
    for (int i = 0; i < n; i++) {
        add_work(watch, plant, i, input * watch->force[i]);
    }
}

/* What has been in motion since the last look: the kinetic energy of all that was fastest, here. */
static double largest_motion(mct_watch *watch, const mct_plant *plant)
{
    mct_evaluation e;
    mct_real x[MCT_MAX_STATES];
    memcpy(x, plant->state.x, sizeof x);
    memcpy(x + mct_rate_index(plant->system), watch->fastest,
           sizeof *x * (size_t)plant->system->coordinate_count);
    memset(watch->fastest, 0, sizeof watch->fastest);
    plant->system->evaluate(&plant->constants, plant->effects, x, plant->input, &e);
    return (double)e.kinetic_energy;
}

bool mct_watch_tick(mct_watch *watch, const mct_plant *plant)
{
    if (!watch->is_watched) {
        return true;
    }
    const mct_real *const rate = plant->state.x + mct_rate_index(plant->system);
    for (int i = 0; i < plant->system->coordinate_count; i++) {
        const mct_real size = rate[i] < 0 ? -rate[i] : rate[i];
        watch->fastest[i] = size > watch->fastest[i] ? size : watch->fastest[i];
    }
    add_work_of_input(watch, plant);
    if (plant->tick % MCT_WATCH_TICKS != 0) {
        return true;
    }
    mct_evaluation e;
    mct_plant_evaluate(plant, &e);
    const double moving = (double)e.kinetic_energy + (double)e.magnetic_energy;
    const double energy = moving + (double)e.potential_energy;
    const double size = moving + mct_abs((double)e.potential_energy) + mct_abs(watch->energy);
    const double rounding = watch->rounding + (double)MCT_REAL_EPSILON * (double)plant->tick * size;
    const double allowed = IMPOSSIBLE * (largest_motion(watch, plant) + (double)e.magnetic_energy) + rounding;
    const bool is_possible = energy - watch->energy - watch->work <= allowed;
    watch->impossible += is_possible ? 0 : 1;
    return is_possible;
}

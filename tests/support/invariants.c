#include "support/invariants.h"

#include <math.h>
#include <string.h>

#include "mctau/stepper.h"
#include "support/energy.h"

#define WEIGHT       (MCT_GRAVITY | MCT_BUOYANCY)
#define CONSERVATIVE (WEIGHT | MCT_SPRING | MCT_CENTRIFUGAL | MCT_CORIOLIS | MCT_EULER_FORCE)

const char *const kept_names[KEPT_COUNT] = {"energy", "momentum", "angular momentum",
                                            "length of the quaternion"};

static bool is_load(const char *unit)
{
    return strcmp(unit, "N") == 0 || strcmp(unit, "N m") == 0 || strcmp(unit, "rad/s^2") == 0;
}

bool invariant_scene(mct_scene *scene, int system, int stepper, bool with_weight)
{
    const mct_system *model = mct_systems[system];
    mct_scene_defaults(scene, system);
    scene->stepper = stepper;
    scene->dt = 1e-3;
    scene->effects = model->effects & CONSERVATIVE & (model->standard_effects | MCT_SPRING);
    if (!with_weight) {
        scene->effects &= ~(uint32_t)WEIGHT;
    }
    for (int i = 0; i < model->parameter_count; i++) {
        if (is_load(model->parameters[i].unit)) {
            scene->parameters[i] = 0;
        }
    }
    const bool only_falls =
        with_weight && model->attitude != MCT_ATTITUDE_NONE && model->coordinate_count > 3;
    if (model->is_process || only_falls || model->kernel(stepper, scene->effects) == NULL) {
        return false;
    }
    const int rate = mct_rate_index(model);
    for (int i = 0; i < model->coordinate_count; i++) {
        scene->initial[i] += model->coordinates[i].is_angle ? 1 : 0.05;
        scene->initial[rate + i] += 0.3 + 0.4 * (i % 3); /* three different rates about three axes */
    }
    return true;
}

/* State k of a few that lie about the start: shifted by `amount` along coordinate `along` (-1: not). */
static void evaluate_near(const mct_plant *plant, int k, int along, double amount, mct_evaluation *out)
{
    const int rate = mct_rate_index(plant->system);
    double values[MCT_MAX_STATES];
    mct_state state;
    for (int i = 0; i < plant->states; i++) {
        values[i] = mct_plant_value(plant, i) * (1 + 0.1 * k) + (i >= rate ? 0.1 * (i - rate + 1) : 0);
    }
    if (along >= 0) {
        values[along] += amount;
    }
    mct_state_set(plant->system, plant->states, values, &state);
    plant->system->evaluate(&plant->constants, plant->effects, state.x, 0, out);
}

static bool differs(mct_real a, mct_real b, double scale)
{
    return fabs((double)a - (double)b) > 64 * (double)MCT_REAL_EPSILON * scale;
}

enum { STATES_TRIED = 3 };

static bool keeps_energy(const mct_plant *plant)
{
    for (int k = 0; k < STATES_TRIED; k++) {
        mct_evaluation e;
        evaluate_near(plant, k, -1, 0, &e);
        double size = 0; /* apparent forces have powers that cancel */
        for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
            size += fabs((double)e.power[i]);
        }
        if (differs((mct_real)energy_rate(&e), 0, size)) {
            return false;
        }
    }
    return true;
}

/* Noether's rule: neither energy depends on the coordinate. */
static bool keeps_momentum(const mct_plant *plant, int i)
{
    for (int k = 0; k < STATES_TRIED; k++) {
        mct_evaluation e, shifted;
        evaluate_near(plant, k, -1, 0, &e);
        evaluate_near(plant, k, i, 0.5, &shifted);
        const double scale = (double)e.kinetic_energy + fabs((double)e.potential_energy);
        if (e.tau[i] != 0 || differs(e.kinetic_energy, shifted.kinetic_energy, scale) ||
            differs(e.potential_energy, shifted.potential_energy, scale)) {
            return false;
        }
    }
    return true;
}

static bool is_free(const mct_plant *plant)
{
    mct_evaluation e;
    evaluate_near(plant, 1, -1, 0, &e);
    for (int i = 0; i < plant->system->coordinate_count; i++) {
        if (e.tau[i] != 0) {
            return false;
        }
    }
    return true;
}

/* out = the body's vector in space, by the quaternion (w, x, y, z). */
static void to_space(const double *q, const double *body, double *out)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        const double *u = q + 1;
        const double dot = u[0] * body[0] + u[1] * body[1] + u[2] * body[2];
        out[i] = (q[0] * q[0] - u[0] * u[0] - u[1] * u[1] - u[2] * u[2]) * body[i] + 2 * dot * u[i] +
                 2 * q[0] * (u[j] * body[k] - u[k] * body[j]);
    }
}

/* (M v)_i by coordinate, then the angular momentum about the origin, in space: x cross p and the spin. */
static void momenta(const mct_plant *plant, const mct_evaluation *e, double *p, double *size)
{
    const mct_system *system = plant->system;
    const int n = system->coordinate_count;
    const int rate = mct_rate_index(system);
    for (int i = 0; i < n; i++) {
        p[i] = size[i] = 0;
        for (int j = 0; j < n; j++) {
            const double term = (double)e->M[i][j] * mct_plant_value(plant, rate + j);
            p[i] += term;
            size[i] += fabs(term);
        }
    }
    if (system->attitude == MCT_ATTITUDE_NONE) {
        return;
    }
    double q[4], x[3] = {0}, linear[3] = {0}, spin[3];
    for (int i = 0; i < 4; i++) {
        q[i] = mct_plant_value(plant, rate - 4 + i);
    }
    memcpy(spin, p + n - 3, sizeof spin);
    if (system->attitude == MCT_ATTITUDE_BODY) {
        to_space(q, p + n - 3, spin);
    }
    for (int i = 0; i < 3 && n == 6; i++) { /* it moves as well */
        x[i] = mct_plant_value(plant, i);
        linear[i] = p[i];
    }
    double whole = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        p[n + i] = spin[i] + x[j] * linear[k] - x[k] * linear[j];
        whole += fabs(spin[i]) + fabs(x[j] * linear[k]) + fabs(x[k] * linear[j]);
    }
    size[n] = size[n + 1] = size[n + 2] = whole;
}

/* How far a quaternion's length is from 1. */
static double length_error(const mct_plant *plant)
{
    double square = 0;
    for (int i = 0; i < 4; i++) {
        const double q = mct_plant_value(plant, mct_rate_index(plant->system) - 4 + i);
        square += q * q;
    }
    return fabs(sqrt(square) - 1);
}

static int momentum_count(const mct_plant *plant)
{
    return plant->system->coordinate_count + (plant->system->attitude != MCT_ATTITUDE_NONE ? 3 : 0);
}

static kept momentum_kind(const mct_plant *plant, int i)
{
    return i < plant->system->coordinate_count ? KEPT_MOMENTUM : KEPT_ANGULAR_MOMENTUM;
}

void invariants_start(invariants *self, const mct_plant *plant)
{
    const int n = plant->system->coordinate_count;
    const bool turns = plant->system->attitude != MCT_ATTITUDE_NONE;
    mct_evaluation e;
    memset(self, 0, sizeof *self);
    self->is_kept[KEPT_ENERGY] = keeps_energy(plant);
    self->is_kept[KEPT_LENGTH] = turns;
    for (int i = 0; i < momentum_count(plant); i++) {
        const bool is_rotation = turns && i >= n - 3;
        self->is_momentum[i] = i >= n ? is_free(plant) : !is_rotation && keeps_momentum(plant, i);
        self->is_kept[momentum_kind(plant, i)] |= self->is_momentum[i];
    }
    mct_plant_evaluate(plant, &e);
    self->potential = (double)e.potential_energy;
    self->energy = (double)e.kinetic_energy + self->potential;
    momenta(plant, &e, self->momentum, self->momentum_scale);
}

static double ratio(double error, double scale)
{
    return error > 0 ? error / scale : error;
}

void invariants_look(invariants *self, const mct_plant *plant)
{
    mct_evaluation e;
    double p[MCT_MAX_COORDINATES + 3], size[MCT_MAX_COORDINATES + 3];
    mct_plant_evaluate(plant, &e);
    const double kinetic = (double)e.kinetic_energy;
    const double potential = (double)e.potential_energy;
    self->energy_scale = fmax(self->energy_scale, kinetic + fabs(potential - self->potential));
    self->energy_error = fmax(self->energy_error, fabs(kinetic + potential - self->energy));
    self->drift[KEPT_ENERGY] = ratio(self->energy_error, self->energy_scale);
    self->drift[KEPT_MOMENTUM] = self->drift[KEPT_ANGULAR_MOMENTUM] = 0;
    momenta(plant, &e, p, size);
    for (int i = 0; i < momentum_count(plant); i++) {
        double *drift = &self->drift[momentum_kind(plant, i)];
        self->momentum_scale[i] = fmax(self->momentum_scale[i], size[i]);
        self->momentum_error[i] = fmax(self->momentum_error[i], fabs(p[i] - self->momentum[i]));
        if (self->is_momentum[i]) {
            *drift = fmax(*drift, ratio(self->momentum_error[i], self->momentum_scale[i]));
        }
    }
    if (self->is_kept[KEPT_LENGTH]) {
        self->drift[KEPT_LENGTH] = fmax(self->drift[KEPT_LENGTH], length_error(plant));
    }
    for (int kind = 0; kind < KEPT_COUNT && plant->diverged_ticks > 0; kind++) {
        self->drift[kind] = HUGE_VAL;
    }
}

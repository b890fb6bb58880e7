/* Hard cases at the ends: ratios of parameters, days of time, controllers at their limits. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "hal/sim/sim.h"
#include "hard_run.h"
#include "mctau/loop.h"

#define TURN        6.283185307179586476925
#define COUNT(list) (sizeof(list) / sizeof(list)[0])

/* --- closed loops --- */

typedef struct {
    mct_sim sim;
    mct_loop loop;
    mct_plan plan;
} closed_loop;

/* A scene's loop in lockstep; false where the library refuses, with its reason in the result. */
static bool close_loop(closed_loop *self, const mct_scene *scene, hard_result *result)
{
    mct_status status = mct_sim_init(&self->sim, scene, &result->why);
    if (status == MCT_OK) {
        const mct_hal hal = mct_sim_hal(&self->sim);
        status =
            mct_loop_init(&self->loop, &self->plan, scene, hal, NULL, (mct_samples){NULL, 0}, &result->why);
        (void)hal.ops->open(hal.context, &result->why);
    }
    result->is_refused = status != MCT_OK;
    return status == MCT_OK;
}

/* The angle from upright [rad], whole turns taken out. */
static double from_upright(const closed_loop *self)
{
    const int upright = self->sim.plant.system->actuation->upright_coordinate;
    return fabs(remainder(mct_plant_value(&self->sim.plant, upright), TURN));
}

/*
 * What is commonly done, on the default reaction wheel: volts by the arm's angle, from a count that is half a count off,
 * and its rate; to swing up, full volts along the rate. Semi-implicit Euler.
 */
typedef struct {
    double supply;             /* [V] */
    double angle, rate, wheel; /* of the arm; of the wheel, relative to it [rad], [rad/s] */
} wheel_pendulum;

static void control_naively(wheel_pendulum *self)
{
    const double inertia = 0.00457, weight = 0.355, wheel_inertia = 2.495e-5, k = 0.0274, resistance = 12.1;
    const double off = remainder(self->angle, TURN) + 0.5 * TURN / 4096;
    const double pump = self->rate == 0 ? 0 : self->rate > 0 ? -self->supply : self->supply;
    const double wanted = fabs(off) < 0.3 ? 400 * off + 50 * self->rate : pump;
    const double volts = fmax(-self->supply, fmin(self->supply, wanted));
    const double torque = k * (volts - k * self->wheel) / resistance;
    const double acceleration = (weight * sin(self->angle) - 2e-4 * self->rate - torque) / inertia;
    self->rate += 1e-3 * acceleration;
    self->wheel += 1e-3 * (torque / wheel_inertia - acceleration);
    self->angle += 1e-3 * self->rate;
}

/* Largest angle from upright from `settled` [s] on; infinite after a fault. */
static void run_loop(const hard_trial *trial, double settled, wheel_pendulum naive, hard_result *result)
{
    const uint64_t ticks = (uint64_t)(trial->seconds * 1000 + 0.5), first = (uint64_t)(settled * 1000 + 0.5);
    closed_loop closed;
    hard_run run;
    if (trial->method != HARD_NAIVE &&
        !(hard_start(&run, trial, NULL, result) && close_loop(&closed, &run.scene, result))) {
        return;
    }
    for (uint64_t tick = 0; tick < ticks; tick++) {
        if (trial->method == HARD_NAIVE) {
            control_naively(&naive);
        } else {
            mct_loop_tick(&closed.loop);
        }
        if (tick >= first) {
            hard_error(result,
                       trial->method == HARD_NAIVE ? remainder(naive.angle, TURN) : from_upright(&closed));
        }
    }
    if (trial->method != HARD_NAIVE &&
        (closed.loop.supervisor.latched != 0 || closed.sim.plant.diverged_ticks > 0)) {
        hard_error(result, (double)INFINITY);
    }
}

/* 46 */
static void run_day(const hard_trial *trial, hard_result *result)
{
    run_loop(trial, 20, (wheel_pendulum){10, 0, 0, 0}, result);
}

/* 47 */
static void run_hanging(const hard_trial *trial, hard_result *result)
{
    run_loop(trial, trial->seconds - 1, (wheel_pendulum){10, TURN / 2, 0, 0}, result);
}

/* 48 */
static void run_saturated(const hard_trial *trial, hard_result *result)
{
    run_loop(trial, trial->seconds - 1, (wheel_pendulum){10, 0.05, 0, 365}, result);
}

/* --- 49: controllers at their limits --- */

static const char *const limits[] = {
    "parameters.supply_voltage = 0.001",
    "parameters.supply_voltage = 1",
    "parameters.supply_voltage = 3",
    "parameters.supply_voltage = 1000",
    "parameters.gravity = 1000",
    "parameters.gravity = 0.001",
    "parameters.torque_constant = 0.0001",
    "parameters.torque_constant = 0",
    "parameters.gravity = 0",
    "sensors.latency = 3",
    "sensors.latency = 16",
    "sensors.noise = 10",
    "sensors.noise = 1000",
    "sensors.counter_bits = 8",
    "controller.observer_bandwidth = 1",
    "controller.observer_bandwidth = 10000",
    "controller.energy_band = 0.001",
    "controller.energy_band = 10",
    "controller.capture = 0.05",
    "controller.capture = 0.95",
    "controller.input_weight = 1e-6",
    "controller.input_weight = 1e6",
    "variation.spread = 0.5",
    "scene.dt = 0.02",
    "scene.dt = 0.1",
    "scene.dt = 1",
};
static const char *const wheel_limits[] = {"sensors.arm_counts_per_turn = 4",
                                           "sensors.arm_counts_per_turn = 64",
                                           "sensors.wheel_counts_per_turn = 4"};
static const char *const cart_limits[] = {
    "sensors.pole_counts_per_turn = 4", "sensors.pole_counts_per_turn = 64",
    "sensors.cart_counts_per_metre = 4", "controller.track_half_length = 0.01"};

#define UPRIGHT 0.64 /* [rad]: beyond it the controller does not balance; its cosine is 0.8 */

/* Whether a scene at a limit ends well: it balances, or the voltage is 0 for a reason, or it is refused for one. */
static bool ends_well(const char *system, const char *limit, double seconds)
{
    char text[256];
    mct_scene scene;
    closed_loop closed;
    hard_result result = {0};
    snprintf(text, sizeof text,
             "scene.system = \"%s\"\nscene.duration = 0\ncontroller.kind = \"swing_up_balance\"\n%s\n",
             system, limit);
    if (mct_scene_read(text, strlen(text), "scene", NULL, 0, &scene, &result.why) != MCT_OK ||
        !close_loop(&closed, &scene, &result)) {
        return result.why.text[0] != '\0';
    }
    const uint64_t ticks = (uint64_t)(seconds / scene.dt), last = (uint64_t)(1 / scene.dt);
    double farthest = 0;
    for (uint64_t tick = 0; tick < ticks; tick++) {
        mct_loop_tick(&closed.loop);
        if (tick + last >= ticks) {
            farthest = fmax(farthest, from_upright(&closed));
        }
    }
    const bool is_cut = closed.loop.supervisor.latched != 0 && closed.loop.record.applied == 0;
    return closed.sim.plant.diverged_ticks == 0 && (is_cut || farthest < UPRIGHT);
}

static void run_limits(const hard_trial *trial, hard_result *result)
{
    int left = 0;
    if (trial->method == HARD_NAIVE) {
        for (double supply = 0.5; supply < 4; supply *= 2) {
            wheel_pendulum one = {supply, TURN / 2, 0.01, 0};
            for (uint64_t tick = 0; tick < (uint64_t)(trial->seconds * 1000); tick++) {
                control_naively(&one);
            }
            left += fabs(remainder(one.angle, TURN)) > UPRIGHT;
        }
        hard_error(result, left);
        return;
    }
    for (size_t i = 0; i < COUNT(limits); i++) {
        left += !ends_well("reaction_wheel", limits[i], trial->seconds);
        left += !ends_well("cart_pole", limits[i], trial->seconds);
    }
    for (size_t i = 0; i < COUNT(wheel_limits); i++) {
        left += !ends_well("reaction_wheel", wheel_limits[i], trial->seconds);
    }
    for (size_t i = 0; i < COUNT(cart_limits); i++) {
        left += !ends_well("cart_pole", cart_limits[i], trial->seconds);
    }
    hard_error(result, left);
}

/* --- 50: ratios of parameters --- */

/* Nothing of these brings energy in; apparent forces do not, in space, as all of them are on by default. */
#define PASSIVE                                                                                    \
    (MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB | MCT_DRAG | MCT_SPRING | MCT_STOKES | MCT_BUOYANCY | \
     MCT_CENTRIFUGAL | MCT_CORIOLIS | MCT_EULER_FORCE)

/* Whether a state is so large that the next tick may take it out of bounds without any error. */
static bool is_far(const mct_plant *plant)
{
    bool is = false;
    for (int i = 0; i < plant->states; i++) {
        is |= fabs((double)plant->state.x[i]) > 0.1 * (double)MCT_STATE_BOUND;
    }
    return is;
}

/* By how much the energy of a scene grows in a time, relative to what is exchanged; infinite where it blows up. */
static double growth(const mct_scene *scene, double seconds)
{
    mct_plant plant;
    mct_evaluation now;
    if (mct_plant_init(&plant, scene, NULL) != MCT_OK) {
        return 0;
    }
    mct_plant_evaluate(&plant, &now);
    const double potential = (double)now.potential_energy, energy = (double)now.kinetic_energy + potential;
    const double rounding =
        1e4 * (double)MCT_REAL_EPSILON * fabs(potential); /* of energies that nearly cancel */
    double scale = fmax((double)now.kinetic_energy, rounding), most = 0;
    for (uint64_t tick = 0; tick < (uint64_t)(seconds / scene->dt) && plant.diverged_ticks == 0; tick++) {
        mct_plant_step(&plant, 0);
        mct_plant_evaluate(&plant, &now);
        scale = fmax(scale, (double)now.kinetic_energy);
        scale = fmax(scale, fabs((double)now.potential_energy - potential));
        most = fmax(most, (double)now.kinetic_energy + (double)now.potential_energy - energy);
    }
    return plant.diverged_ticks > 0 && !is_far(&plant) ? (double)INFINITY : most > 0 ? most / scale : 0;
}

static void run_ratios(const hard_trial *trial, hard_result *result)
{
    static const double factors[] = {1e-6, 1e-3, 1e3, 1e6};
    if (trial->method == HARD_NAIVE) {
        /* a spring of 40e6 N/m, rest length 0.3 m, mass 0.5 kg: semi-implicit Euler */
        double length = 0.42, rate = 0;
        for (int step = 0; step < 2000 && rate < 1e9; step++) {
            rate -= 1e-3 * 40e6 / 0.5 * (length - 0.3);
            length += 1e-3 * rate;
        }
        hard_error(result, 0.5 * 0.5 * rate * rate / (0.5 * 40e6 * 0.12 * 0.12) - 1);
        return;
    }
    for (int number = 0; number < MCT_SYSTEM_COUNT; number++) {
        const mct_system *system = mct_systems[number];
        int taken = 0;
        for (int i = 0; i < system->parameter_count && !system->is_process; i++) {
            const mct_field *field = &system->parameters[i];
            for (size_t n = 0; n < COUNT(factors) && field->kind == MCT_FIELD_REAL && field->standard != 0;
                 n++) {
                mct_scene scene;
                mct_scene_defaults(&scene, number);
                scene.effects &= PASSIVE;
                scene.parameters[i] =
                    fmax(field->minimum, fmin(field->maximum, field->standard * factors[n]));
                mct_message why = {""};
                if (mct_scene_check(&scene, &why) == MCT_OK) {
                    hard_error(result, growth(&scene, trial->seconds));
                    taken++;
                } else if (why.text[0] == '\0') {
                    hard_error(result, (double)INFINITY);
                }
            }
        }
        if (taken == 0 && !system->is_process) {
            hard_error(result, (double)INFINITY); /* all refused: nothing was shown */
        }
    }
}

#define BALANCED_WHEEL "scene.system = \"reaction_wheel\"\ncontroller.kind = \"swing_up_balance\"\n"

const hard_case hard_extremes[] = {
    {.number = 46,
     .rule = "a wheel that balances does so all day",
     .naive =
         "by the arm's angle and rate alone: half a count off, the wheel runs up until it has no torque left",
     .remedy = "the wheel's rate is brought home too, its angle from where balancing began stands for an "
               "integrator",
     .measure = "largest angle from upright from 20 s on [rad]",
     .scene = BALANCED_WHEEL "sensors.noise = 1\n",
     .seconds = 100,
     .full_seconds = 86400,
     .criterion = 0.01, /* a count of noise is 0.0015 rad */
     .criterion_f32 = 0.01,
     .run = run_day},
    {.number = 47,
     .rule = "a swing-up begins at rest, where no direction is better than the other",
     .naive = "full voltage along the rate: at rest there is none",
     .remedy = "the direction of pumping is kept near a standstill, and there is one at the start",
     .measure = "largest angle from upright in the last second [rad]",
     .scene = BALANCED_WHEEL,
     .seconds = 60,
     .criterion = 0.01, /* six counts */
     .criterion_f32 = 0.01,
     .run = run_hanging},
    {.number = 48,
     .rule = "a wheel that is at its top speed when the arm falls is caught in the end",
     .naive = "by the arm's angle and rate alone",
     .remedy = "what cannot be caught is let fall and swung up again",
     .measure = "largest angle from upright in the last second [rad]",
     .scene = BALANCED_WHEEL "initial.arm_angle = 0.05\ninitial.wheel_rate = 365\n",
     .seconds = 60,
     .criterion = 0.01, /* six counts */
     .criterion_f32 = 0.01,
     .run = run_saturated},
    {.number = 49,
     .rule = "a controller at its limits balances, or ends at zero volts with a named reason",
     .naive = "too little voltage swings the arm for ever, and nobody is told",
     .remedy = "the supervisor's faults; no_balance where a swing-up does not end",
     .measure = "how many of the scenes at a limit still swing at the end",
     .seconds = 200, /* give_up_after is 120 s, and some balance now and then */
     .criterion = 1e-300,
     .criterion_f32 = 1e-300,
     .run = run_limits},
    {.number = 50,
     .rule = "a mechanism with one part a million times larger or smaller gains no energy, or is refused",
     .naive = "semi-implicit Euler on a spring a million times as stiff",
     .remedy = "steps that do not follow the motion are refused at init",
     .measure = "largest growth of energy, relative to what is exchanged, over all systems and parameters",
     .seconds = 2,
     .criterion = 1e-3,     /* steps that are just short enough have errors of this size */
     .criterion_f32 = 1e-2, /* of a frame that turns by 2e5 rad, whose angle is known to 6e-8 of itself */
     .run = run_ratios},
    {.rule = NULL}};

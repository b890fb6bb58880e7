/*
 * Motion of the pendulum with a moving base, in double precision, against an independent reference: Hamilton's form of
 * the textbook's Lagrangian in quadruple precision,
 *     L = m/2 (l^2 w^2 + 2 l w (u1d cos th - u2d sin th)) - m g l cos th + what th does not enter,
 * which knows the base's velocity only, where the closed form knows its acceleration.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/quad.h"
#include "support/scenes.h"
#include "unity.h"

#define TURN 6.283185307179586

static int system_number;

void setUp(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, "moving_base") == 0) {
            system_number = i;
        }
    }
}

void tearDown(void)
{
}

/* ---- the reference ---- */

typedef struct {
    quad m, l, g, friction, torque;
    quad amplitude[2], frequency[2], phase[2];
} textbook;

static void base_velocity(const textbook *self, quad time, quad *v)
{
    for (int i = 0; i < 2; i++) {
        v[i] =
            -self->amplitude[i] * self->frequency[i] * quad_sin(self->frequency[i] * time + self->phase[i]);
    }
}

static quad shaken(const textbook *self, quad time, quad angle)
{
    quad v[2];
    base_velocity(self, time, v);
    return self->m * self->l * (v[0] * quad_cos(angle) - v[1] * quad_sin(angle));
}

/* x = (angle, momentum) */
static void textbook_rate(const void *model, quad time, const quad *x, quad *dx)
{
    const textbook *self = model;
    quad v[2];
    base_velocity(self, time, v);
    const quad s = quad_sin(x[0]);
    const quad c = quad_cos(x[0]);
    const quad w = (x[1] - shaken(self, time, x[0])) / (self->m * self->l * self->l);
    dx[0] = w;
    dx[1] = -self->m * self->l * w * (v[0] * s + v[1] * c) + self->m * self->g * self->l * s -
            self->friction * w + self->torque;
}

static void textbook_motion(mct_scene *scene, double torque, double duration, long steps, double *end)
{
    const char *const amplitude[] = {"base_amplitude_1", "base_amplitude_2"};
    const char *const frequency[] = {"base_frequency_1", "base_frequency_2"};
    const char *const phase[] = {"base_phase_1", "base_phase_2"};
    textbook model = {.m = *parameter_of(scene, "mass"),
                      .l = *parameter_of(scene, "length"),
                      .g = *parameter_of(scene, "gravity"),
                      .friction = *parameter_of(scene, "friction"),
                      .torque = torque};
    for (int i = 0; i < 2; i++) {
        model.amplitude[i] = *parameter_of(scene, amplitude[i]);
        model.frequency[i] = *parameter_of(scene, frequency[i]);
        model.phase[i] = *parameter_of(scene, phase[i]);
    }
    const quad inertia = model.m * model.l * model.l;
    quad x[2] = {scene->initial[0], 0};
    x[1] = inertia * scene->initial[1] + shaken(&model, 0, x[0]);
    quad_extrapolate(textbook_rate, &model, 0, x, 2, duration, steps);
    end[0] = (double)x[0];
    end[1] = (double)((x[1] - shaken(&model, duration, x[0])) / inertia);
}

/* ---- motions ---- */

typedef struct {
    const char *name;
    double length, friction, amplitude[2], frequency[2], phase[2], angle, rate, torque;
} motion;

static const motion motions[] = {
    {"slow, sideways", 0.3, 0.001, {0.03, 0}, {6, 1}, {0.4, 0}, 2.6, 0.3, 0.0},
    {"both axes, driven", 0.5, 0.004, {0.02, 0.03}, {9, 13}, {-0.3, 1.1}, 3.0, -1.0, 0.05},
    {"Kapitza, 48 Hz", 0.2, 0.003, {0, 0.01}, {300, 300}, {0, 0.7}, 0.5, 0.0, 0.0},
};

static mct_scene scene_of_motion(const motion *self, int stepper, double dt)
{
    mct_scene scene = scene_of(system_number, stepper, mct_systems[system_number]->standard_effects);
    *parameter_of(&scene, "length") = self->length;
    *parameter_of(&scene, "friction") = self->friction;
    *parameter_of(&scene, "base_amplitude_1") = self->amplitude[0];
    *parameter_of(&scene, "base_amplitude_2") = self->amplitude[1];
    *parameter_of(&scene, "base_frequency_1") = self->frequency[0];
    *parameter_of(&scene, "base_frequency_2") = self->frequency[1];
    *parameter_of(&scene, "base_phase_1") = self->phase[0];
    *parameter_of(&scene, "base_phase_2") = self->phase[1];
    scene.initial[0] = self->angle;
    scene.initial[1] = self->rate;
    scene.dt = dt;
    return scene;
}

/* Worst of angle and rate after 5 s. */
static double error_of(const motion *self, int stepper, double dt, const double *expected)
{
    const mct_scene scene = scene_of_motion(self, stepper, dt);
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, self->torque, lround(5 / dt));
    return fmax(fabs(mct_plant_value(&plant, 0) - expected[0]),
                fabs(mct_plant_value(&plant, 1) - expected[1]));
}

static void reference_motion(const motion *self, double *expected)
{
    double coarse[2];
    mct_scene scene = scene_of_motion(self, MCT_STEPPER_RK4, 1e-3);
    textbook_motion(&scene, self->torque, 5, 1000, coarse);
    textbook_motion(&scene, self->torque, 5, 2000, expected);
    for (int i = 0; i < 2; i++) { /* the reference is good to 14 digits */
        TEST_ASSERT_TRUE(fabs(coarse[i] - expected[i]) <= 1e-14 * (1 + fabs(expected[i])));
    }
}

/*
 * Tolerances: rk4 at 1 ms 1e-9 where the base is slow. Kapitza's base turns 0.3 rad in a step, of which order 4 leaves
 * 0.3^4 / 120, and the slow motion gathers it over 5 s: a sixteenth of the step divides 3e-3 by 16^4.
 */
static void test_motion_follows_the_textbook_in_quadruple_precision(void)
{
    static const int steppers[] = {MCT_STEPPER_SEED, MCT_STEPPER_EULER, MCT_STEPPER_LEAP, MCT_STEPPER_RK4};
    for (int i = 0; i < 3; i++) {
        double expected[2];
        reference_motion(&motions[i], expected);
        printf("%s, 5 s at 1 ms:", motions[i].name);
        for (int k = 0; k < 4; k++) {
            printf(" %s %.1e", mct_steppers[steppers[k]].name,
                   error_of(&motions[i], steppers[k], 1e-3, expected));
        }
        const double rk4 = error_of(&motions[i], MCT_STEPPER_RK4, 1e-3, expected);
        const double finer = error_of(&motions[i], MCT_STEPPER_RK4, 0.0625e-3, expected);
        printf("; rk4 at 1/16 ms %.1e\n", finer);
        TEST_ASSERT_TRUE(i == 2 ? finer < 1e-7 : rk4 < 1e-9);
    }
}

static void test_each_stepper_has_its_order_with_a_moving_base(void)
{
    static const int steppers[] = {MCT_STEPPER_SEED, MCT_STEPPER_EULER, MCT_STEPPER_LEAP, MCT_STEPPER_RK4};
    double expected[2];
    reference_motion(&motions[1], expected);
    for (int k = 0; k < 4; k++) {
        const double coarse = error_of(&motions[1], steppers[k], 4e-3, expected);
        const double fine = error_of(&motions[1], steppers[k], 2e-3, expected);
        const double order = log2(coarse / fine);
        printf("%s: order %.2f\n", mct_steppers[steppers[k]].name, order);
        TEST_ASSERT_TRUE(order > mct_steppers[steppers[k]].order - 0.3);
    }
}

/*
 * A base that runs around a circle, without weight: in the frame that turns with it the motion is that of a pendulum,
 * psi = th + f t, psidd = (A f^2 / l) cos psi, whose energy stays. leap keeps it but for a ripple of second order,
 * rk4 by its own small loss; both over a million steps.
 */
static double circle_energy(const mct_plant *plant, double f, double A, double l)
{
    const double psi = (double)plant->state.x[0] + (double)plant->state.x[2];
    const double rate = (double)plant->state.x[1] + f;
    return 0.5 * rate * rate - A * f * f / l * sin(psi);
}

static void test_a_circling_base_keeps_the_energy_of_its_own_frame(void)
{
    static const int steppers[] = {MCT_STEPPER_LEAP, MCT_STEPPER_RK4};
    static const double allowed[] = {1e-4, 1e-6};
    for (int k = 0; k < 2; k++) {
        mct_scene scene = scene_of(system_number, steppers[k], MCT_BASE_MOTION);
        const double f = 5;
        const double A = 0.1;
        const double l = 0.2;
        *parameter_of(&scene, "length") = l;
        *parameter_of(&scene, "base_amplitude_1") = *parameter_of(&scene, "base_amplitude_2") = A;
        *parameter_of(&scene, "base_frequency_1") = *parameter_of(&scene, "base_frequency_2") = f;
        *parameter_of(&scene, "base_phase_2") = -TURN / 4;
        scene.initial[0] = 0.7;
        scene.initial[1] = -4;
        mct_plant plant;
        start_plant(&plant, &scene);
        const double start = circle_energy(&plant, f, A, l);
        double worst = 0;
        for (long tick = 0; tick < 1000000; tick++) {
            mct_plant_step(&plant, 0);
            worst = fmax(worst, fabs(circle_energy(&plant, f, A, l) - start));
        }
        printf("%s: a million steps change %.3f (rad/s)^2 by at most %.1e\n", mct_steppers[steppers[k]].name,
               start, worst);
        TEST_ASSERT_TRUE(worst < allowed[k]);
    }
}

/* ---- Kapitza's threshold ---- */

/* |trace| of the map of a second, that is of a whole number of oscillations, about upright: at most 2 when stable. */
static double trace_of(mct_scene *scene, double amplitude)
{
    const double small = 1e-9; /* linear to 1e-18 */
    double trace = 0;
    *parameter_of(scene, "base_amplitude_2") = amplitude;
    for (int k = 0; k < 2; k++) {
        scene->initial[0] = k == 0 ? small : 0;
        scene->initial[1] = k == 1 ? small : 0;
        mct_plant plant;
        start_plant(&plant, scene);
        step_plant(&plant, 0, lround(1 / scene->dt));
        trace += mct_plant_value(&plant, k) / small;
    }
    return fabs(trace);
}

/* Least amplitude that keeps the pendulum upright [m], by bisection. */
static double threshold_of(int stepper, double hertz, double dt, int substeps)
{
    mct_scene scene = scene_of(system_number, stepper, MCT_GRAVITY | MCT_BASE_MOTION);
    *parameter_of(&scene, "base_frequency_2") = TURN * hertz;
    *parameter_of(&scene, "base_frequency_1") = 0;
    scene.dt = dt;
    scene.substeps = substeps;
    const double averaged = sqrt(2 * 9.81 * 0.2) / (TURN * hertz); /* Kapitza's own */
    double low = 0.3 * averaged;
    double high = low;
    while (high < 3 * averaged && trace_of(&scene, high) > 2) {
        low = high;
        high *= 1.02;
    }
    for (int k = 0; k < 26; k++) {
        const double middle = 0.5 * (low + high);
        *(trace_of(&scene, middle) > 2 ? &low : &high) = middle;
    }
    return high;
}

/* NUMERICS: off by 24 % where the base's acceleration is sampled at the middle, by 6e-6 where its integral is taken. */
static void test_kapitzas_threshold_at_400_hz_and_1_khz_is_right_where_the_base_is_fed_as_velocity(void)
{
    const double reference = threshold_of(MCT_STEPPER_RK4, 400, 1e-3, 32);
    const double leap = threshold_of(MCT_STEPPER_LEAP, 400, 1e-3, 1) / reference - 1;
    const double leap_4 = threshold_of(MCT_STEPPER_LEAP, 400, 1e-3, 4) / reference - 1;
    const double rk4 = threshold_of(MCT_STEPPER_RK4, 400, 1e-3, 1) / reference - 1;
    const double seed = threshold_of(MCT_STEPPER_SEED, 400, 1e-3, 2) / reference - 1;
    printf("threshold %.5f mm; leap %+.1e, with 4 substeps %+.1e; rk4 %+.1e; seed with 2 substeps %+.1e\n",
           1e3 * reference, leap, leap_4, rk4, seed);
    TEST_ASSERT_TRUE(fabs(leap) < 1e-5);
    TEST_ASSERT_TRUE(fabs(leap_4) < 1e-6);
    TEST_ASSERT_TRUE(fabs(rk4) < 0.05 && fabs(seed) > 0.05);
}

/* At 1 kHz a tick of 1 ms sees nothing of the base, and is refused. */
static void test_kapitzas_threshold_at_1_khz_is_met_with_substeps(void)
{
    const double reference = threshold_of(MCT_STEPPER_RK4, 1000, 1e-3, 64);
    const double leap = threshold_of(MCT_STEPPER_LEAP, 1000, 1e-3, 4) / reference - 1;
    printf("threshold %.5f mm; leap with 4 substeps %+.1e\n", 1e3 * reference, leap);
    TEST_ASSERT_TRUE(fabs(leap) < 1e-6);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_motion_follows_the_textbook_in_quadruple_precision);
    RUN_TEST(test_each_stepper_has_its_order_with_a_moving_base);
    RUN_TEST(test_a_circling_base_keeps_the_energy_of_its_own_frame);
    RUN_TEST(test_kapitzas_threshold_at_400_hz_and_1_khz_is_right_where_the_base_is_fed_as_velocity);
    RUN_TEST(test_kapitzas_threshold_at_1_khz_is_met_with_substeps);
    return UNITY_END();
}

/*
 * Motions of the particle pendulum and the fixed axis, in double precision: against the source's torque, summed over the
 * particles in quadruple precision; against the period in closed form; energy over a million steps.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/quad.h"
#include "support/scenes.h"
#include "unity.h"

#define PI 3.14159265358979323846

enum { MOST = 4 };

void setUp(void)
{
}

void tearDown(void)
{
}

/* A body: in the plane if it has no axis. */
typedef struct {
    const char *name;
    double axis[3], gravity[3];
    int count;
    double particles[MOST][4];
    double friction, torque, angle, rate;
} motion;

static const motion motions[] = {
    {"a metronome, driven",
     {0, 0, 0},
     {0, -9.81, 0},
     2,
     {{0.03, 0, -0.05}, {0.005, 0.01, 0.15}},
     3e-5,
     1e-4,
     0.5,
     -3},
    {"a bent rod, over the top",
     {0, 0, 0},
     {0, -9.81, 0},
     3,
     {{0.05, 0, 0.1}, {0.05, 0, 0.2}, {0.1, 0.1, 0.3}},
     2e-3,
     0,
     0.3,
     14},
    {"1 mrad from upright", {0, 0, 0}, {0, -9.81, 0}, 2, {{0.1, 0, 0.3}, {0.2, 0, 0.5}}, 0, 0, 1e-3, 0},
    {"a leaning gate",
     {0.1, 1, 0},
     {0, -9.81, 0},
     4,
     {{5, 0.2, 0.2, 0}, {5, 0.2, 0.8, 0}, {5, 0.8, 0.2, 0}, {5, 0.8, 0.8, 0}},
     0.8,
     0.3,
     2.5,
     0},
    {"askew in all, spun up",
     {1, -2, 0.5},
     {3, -9, 2},
     3,
     {{1, 0.3, 0.1, -0.2}, {0.4, -0.5, 0.2, 0.7}, {2, 0, -0.4, 0.1}},
     0.02,
     4,
     -1,
     6},
    {"1 mrad from balance on a skew axis",
     {2, 1, 2},
     {-4, -2, 4},
     2,
     {{1, 0.2, 0.1, -0.8}, {0.3, 0.2, -0.4, -0.1}},
     0,
     0,
     0,
     0},
};
enum { MOTIONS = sizeof motions / sizeof motions[0] };

static bool is_plane(const motion *self)
{
    return self->axis[0] == 0 && self->axis[1] == 0 && self->axis[2] == 0;
}

static mct_scene scene_of_motion(const motion *self, int stepper)
{
    const bool plane = is_plane(self);
    const int columns = plane ? 3 : 4;
    mct_scene scene = scene_of(system_called(plane ? "particle_pendulum" : "fixed_axis"), stepper,
                               MCT_GRAVITY | MCT_VISCOUS);
    scene.lists[0].count = columns * self->count;
    for (int i = 0; i < self->count; i++) {
        memcpy(scene.lists[0].values + columns * i, self->particles[i], sizeof(double) * (size_t)columns);
    }
    for (int i = 0; i < 3 && !plane; i++) {
        static const char *const axis[] = {"axis_1", "axis_2", "axis_3"};
        static const char *const gravity[] = {"gravity_1", "gravity_2", "gravity_3"};
        *parameter_of(&scene, axis[i]) = self->axis[i];
        *parameter_of(&scene, gravity[i]) = self->gravity[i];
    }
    *parameter_of(&scene, "friction") = self->friction;
    scene.initial[0] = self->angle;
    scene.initial[1] = self->rate;
    return scene;
}

/* ---- the reference: u'sum x_i x m_i g, with each particle turned on its own (338), (109) ---- */

static void quad_cross(const quad *a, const quad *b, quad *product)
{
    for (int i = 0; i < 3; i++) {
        product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

static quad quad_dot(const quad *a, const quad *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Sum over the particles of inertia and of the weight's torque at this angle. */
static void sums_of(const motion *self, quad angle, quad *inertia, quad *torque)
{
    quad s = quad_sin(angle), c = quad_cos(angle);
    *inertia = *torque = 0;
    for (int i = 0; i < self->count; i++) {
        const double *row = self->particles[i];
        const quad m = row[0];
        if (is_plane(self)) {
            *inertia += m * ((quad)row[1] * row[1] + (quad)row[2] * row[2]);
            *torque -= m * self->gravity[1] * (row[1] * c + row[2] * s);
            continue;
        }
        quad u[3], b[3], x[3], arm[3], twice[3], moment[3], g[3];
        quad length = 0;
        for (int j = 0; j < 3; j++) {
            length += (quad)self->axis[j] * self->axis[j];
        }
        for (int j = 0; j < 3; j++) {
            u[j] = self->axis[j] / quad_sqrt(length);
            b[j] = row[1 + j];
            g[j] = m * self->gravity[j];
        }
        quad_cross(u, b, arm);
        quad_cross(u, arm, twice);
        for (int j = 0; j < 3; j++) { /* 1 + sin th R[u] + (1 - cos th) R^2[u] */
            x[j] = b[j] + s * arm[j] + (1 - c) * twice[j];
        }
        quad_cross(x, g, moment);
        *inertia += m * quad_dot(arm, arm);
        *torque += quad_dot(u, moment);
    }
}

static void textbook_rate(const void *model, quad time, const quad *x, quad *dx)
{
    const motion *self = model;
    quad inertia, torque;
    (void)time;
    sums_of(self, x[0], &inertia, &torque);
    dx[0] = x[1];
    dx[1] = (torque + self->torque - self->friction * x[1]) / inertia;
}

/* Angle of balance and rate of small swings about it: the torque is - I w0^2 sin(th - rest). */
static void rest_of(const motion *self, double *rest, double *w0)
{
    quad inertia, at_0, at_90;
    sums_of(self, 0, &inertia, &at_0);
    sums_of(self, (quad)PI / 2, &inertia, &at_90);
    *rest = atan2((double)at_0, -(double)at_90);
    *w0 = sqrt(hypot((double)at_0, (double)at_90) / (double)inertia);
}

/* How much a motion amplifies an error of its rate that is made on the way, by the reference itself; at least 1. */
static double growth_of(const motion *self, const quad *end)
{
    enum { PLACES = 20 };
    const quad nudge = (quad)1e-12;
    quad way[2] = {self->angle, self->rate};
    double growth = 1;
    for (int i = 0; i < PLACES; i++) {
        const quad left = 5 - (quad)5 * i / PLACES;
        quad x[2] = {way[0], way[1] + nudge};
        quad_extrapolate(textbook_rate, self, 0, x, 2, left, 20L * (PLACES - i));
        growth = fmax(growth, (double)(quad_abs(x[0] - end[0]) / nudge));
        quad_extrapolate(textbook_rate, self, 0, way, 2, (quad)5 / PLACES, 20);
    }
    return growth;
}

/* Angle and rate after 5 s, good to 14 digits. */
static void follow_textbook(const motion *self, quad *end)
{
    quad coarse[2] = {self->angle, self->rate};
    end[0] = self->angle;
    end[1] = self->rate;
    quad_extrapolate(textbook_rate, self, 0, coarse, 2, 5, 200);
    quad_extrapolate(textbook_rate, self, 0, end, 2, 5, 400);
    for (int k = 0; k < 2; k++) {
        TEST_ASSERT_TRUE(quad_abs(coarse[k] - end[k]) <= (quad)1e-14 * (1 + quad_abs(end[k])));
    }
}

/* Worst of angle and rate after 5 s. */
static double error_of(const motion *self, int stepper, double dt, const quad *expected)
{
    mct_scene scene = scene_of_motion(self, stepper);
    mct_plant plant;
    double error = 0;
    scene.dt = dt;
    start_plant(&plant, &scene);
    step_plant(&plant, self->torque, lround(5 / dt));
    for (int k = 0; k < 2; k++) {
        error = fmax(error, fabs(mct_plant_value(&plant, k) - (double)expected[k]));
    }
    return error;
}

/* 1 mrad from balance a motion amplifies an error by thousands, whatever the stepper: the error is divided by that. */
static void test_motion_follows_the_sources_torque_in_quadruple_precision(void)
{
    for (int i = 0; i < MOTIONS; i++) {
        motion now = motions[i];
        quad end[2];
        if (i == MOTIONS - 1) {
            double rest, w0;
            rest_of(&now, &rest, &w0);
            now.angle = rest + PI + 1e-3;
        }
        follow_textbook(&now, end);
        const double growth = growth_of(&now, end);
        printf("%s, 5 s at 1 ms:", now.name);
        FOR_EACH_STEPPER (stepper, scene_of_motion(&now, 0).system, MCT_GRAVITY | MCT_VISCOUS) {
            const double error = error_of(&now, stepper, 1e-3, end);
            printf(" %s %.1e", mct_steppers[stepper].name, error);
            TEST_ASSERT_TRUE(stepper != MCT_STEPPER_RK4 || error <= 1e-9 * growth);
            TEST_ASSERT_TRUE(stepper != MCT_STEPPER_TAYLOR6 ||
                             error <= 1e-9); /* whatever the motion amplifies */
        }
        printf(", growth %.1e\n", growth);
    }
}

static void test_each_stepper_has_its_order(void)
{
    for (int i = 0; i < MOTIONS; i += 4) { /* the metronome, and the one askew in all */
        quad end[2];
        follow_textbook(&motions[i], end);
        FOR_EACH_STEPPER (stepper, scene_of_motion(&motions[i], 0).system, MCT_GRAVITY | MCT_VISCOUS) {
            if (mct_steppers[stepper].needs_smooth) {
                continue; /* at rounding by 2 ms: tests/steppers/test_order_f64.c */
            }
            const double order =
                log2(error_of(&motions[i], stepper, 4e-3, end) / error_of(&motions[i], stepper, 2e-3, end));
            printf("%s, %s: order %.2f\n", motions[i].name, mct_steppers[stepper].name, order);
            TEST_ASSERT_TRUE(order > mct_steppers[stepper].order - 0.3);
        }
    }
}

/* T = 2 pi / (w0 agm(1, cos(a/2))), a the swing to either side, in a whole number of steps. */
static void test_the_period_is_that_of_the_elliptic_integral(void)
{
    static const double swings[] = {0.1, 1, 2, 3};
    for (int i = 0; i < MOTIONS; i++) {
        for (size_t n = 0; n < sizeof swings / sizeof swings[0]; n++) {
            motion now = motions[i];
            double rest, w0, a = 1, b = cos(swings[n] / 2);
            rest_of(&now, &rest, &w0);
            for (int k = 0; k < 8; k++) {
                const double mean = (a + b) / 2;
                b = sqrt(a * b);
                a = mean;
            }
            now.angle = rest + swings[n];
            now.rate = now.friction = 0;
            mct_scene scene = scene_of_motion(&now, MCT_STEPPER_RK4);
            const double period = 2 * PI / (w0 * a);
            const long steps = lround(period / 1e-3);
            scene.dt = period / (double)steps;
            mct_plant plant;
            start_plant(&plant, &scene);
            step_plant(&plant, 0, 5 * steps);
            /* A turning point stays one: what a wrong period would show is the rate. */
            TEST_ASSERT_TRUE(fabs(mct_plant_value(&plant, 0) - now.angle) < 1e-9);
            TEST_ASSERT_TRUE(fabs(mct_plant_value(&plant, 1)) < 3e-9 * w0 * w0);
        }
    }
}

static void test_energy_stays_over_a_million_steps_without_friction(void)
{
    static const int steppers[] = {MCT_STEPPER_LEAP, MCT_STEPPER_RK4};
    static const double allowed[] = {1e-4, 1e-8}; /* leap ripples by (w h)^2, rk4 loses (w h)^5 a step */
    for (int i = 1; i < MOTIONS; i += 3) {
        motion now = motions[i];
        double rest, w0;
        rest_of(&now, &rest, &w0);
        now.angle = rest + 2;
        now.rate = now.friction = 0;
        for (int k = 0; k < 2; k++) {
            const mct_scene scene = scene_of_motion(&now, steppers[k]);
            mct_plant plant;
            mct_evaluation at;
            start_plant(&plant, &scene);
            mct_plant_evaluate(&plant, &at);
            const double first = energy_of(&plant);
            const double depth = (double)at.M[0][0] * w0 * w0; /* of gravity's well, half of it */
            double worst = 0;
            for (long tick = 0; tick < 1000000; tick++) {
                mct_plant_step(&plant, 0);
                worst = fmax(worst, fabs(energy_of(&plant) - first));
            }
            printf("%s, %s: energy off by %.1e of %.3g J\n", now.name, mct_steppers[steppers[k]].name, worst,
                   depth);
            TEST_ASSERT_TRUE(worst < depth * allowed[k]);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_motion_follows_the_sources_torque_in_quadruple_precision);
    RUN_TEST(test_each_stepper_has_its_order);
    RUN_TEST(test_the_period_is_that_of_the_elliptic_integral);
    RUN_TEST(test_energy_stays_over_a_million_steps_without_friction);
    return UNITY_END();
}

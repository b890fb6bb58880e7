/*
 * Motion of the solid pendulum, in double precision: against the textbook's compound pendulum in quadruple precision,
 * its inertia from the integral over the box about the axle rather than from Steiner's theorem; against the period in
 * closed form, 4 K(k) / w0 by the arithmetic-geometric mean; and its friction against the law of its turning points.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/quad.h"
#include "support/scenes.h"
#include "unity.h"

#define PI 3.14159265358979323846

static int system_number;

void setUp(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, "solid_pendulum") == 0) {
            system_number = i;
        }
    }
}

void tearDown(void)
{
}

/* ---- the reference ---- */

typedef struct {
    quad inertia, weight_moment, friction, torque;
} textbook;

static textbook textbook_of(mct_scene *scene, double torque)
{
    const quad x = *parameter_of(scene, "size_1");
    const quad y = *parameter_of(scene, "size_2");
    const quad p = *parameter_of(scene, "pivot_offset");
    const quad sheet = (quad)*parameter_of(scene, "density") * (quad)*parameter_of(scene, "size_3");
    return (textbook){
        .inertia = sheet * (y * ((x - p) * (x - p) * (x - p) + p * p * p) / 3 + x * y * y * y / 12),
        .weight_moment = sheet * y * ((x - p) * (x - p) - p * p) / 2 * *parameter_of(scene, "gravity"),
        .friction = *parameter_of(scene, "friction"),
        .torque = torque};
}

static void textbook_rate(const void *model, quad time, const quad *x, quad *dx)
{
    const textbook *self = model;
    (void)time;
    dx[0] = x[1];
    dx[1] = (self->torque - self->weight_moment * quad_cos(x[0]) - self->friction * x[1]) / self->inertia;
}

/* ---- motions ---- */

typedef struct {
    const char *name;
    double size[3], offset, friction, angle, rate, torque;
    double growth; /* largest factor by which the motion amplifies an error */
} motion;

/* Upright amplifies by exp(3.86 t), w0 = 3.86/s, until it has fallen: 1 mrad to 1 rad, 1e3. */
static const motion motions[] = {
    {"the source's bar", {1, 0.04, 0.04}, 0.01, 0.2, 0, 0, 0, 1},
    {"a slab, driven over the top", {0.4, 0.3, 0.02}, 0.05, 0.05, -1, 9, 0.5, 1},
    {"1 mrad from standing", {1, 0.04, 0.04}, 0.01, 0, PI / 2 + 1e-3, 0, 0, 1e3},
};

static mct_scene scene_of_motion(const motion *self, int stepper, double dt)
{
    static const char *const sizes[] = {"size_1", "size_2", "size_3"};
    mct_scene scene = scene_of(system_number, stepper, mct_systems[system_number]->standard_effects);
    for (int i = 0; i < 3; i++) {
        *parameter_of(&scene, sizes[i]) = self->size[i];
    }
    *parameter_of(&scene, "pivot_offset") = self->offset;
    *parameter_of(&scene, "friction") = self->friction;
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
    mct_scene scene = scene_of_motion(self, MCT_STEPPER_RK4, 1e-3);
    const textbook model = textbook_of(&scene, self->torque);
    quad coarse[2] = {self->angle, self->rate};
    quad fine[2] = {self->angle, self->rate};
    quad_extrapolate(textbook_rate, &model, 0, coarse, 2, 5, 200);
    quad_extrapolate(textbook_rate, &model, 0, fine, 2, 5, 400);
    for (int i = 0; i < 2; i++) { /* the reference is good to 14 digits */
        expected[i] = (double)fine[i];
        TEST_ASSERT_TRUE(quad_abs(coarse[i] - fine[i]) <= (quad)1e-14 * (1 + quad_abs(fine[i])));
    }
}

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
        printf("\n");
        TEST_ASSERT_TRUE(error_of(&motions[i], MCT_STEPPER_RK4, 1e-3, expected) < 1e-9 * motions[i].growth);
    }
}

static void test_each_stepper_has_its_order(void)
{
    static const int steppers[] = {MCT_STEPPER_SEED, MCT_STEPPER_EULER, MCT_STEPPER_LEAP, MCT_STEPPER_RK4};
    double expected[2];
    reference_motion(&motions[0], expected);
    for (int k = 0; k < 4; k++) {
        const double coarse = error_of(&motions[0], steppers[k], 4e-3, expected);
        const double fine = error_of(&motions[0], steppers[k], 2e-3, expected);
        TEST_ASSERT_TRUE(log2(coarse / fine) > mct_steppers[steppers[k]].order - 0.3);
    }
}

/* ---- closed forms ---- */

static double elliptic_k(double k)
{
    double a = 1;
    double b = sqrt((1 - k) * (1 + k));
    for (int n = 0; n < 30; n++) {
        const double mean = 0.5 * (a + b);
        b = sqrt(a * b);
        a = mean;
    }
    return PI / (2 * a);
}

/* Time between two passages of the hanging position in the same direction, by cubic interpolation of time. */
static double period_of(const mct_plant *from)
{
    mct_plant plant = *from;
    double passage[2] = {0, 0};
    for (int found = 0; found < 2;) {
        const double before = mct_plant_value(&plant, 0) + PI / 2;
        const double rate_before = mct_plant_value(&plant, 1);
        const double start = 1e-3 * (double)plant.tick;
        mct_plant_step(&plant, 0);
        const double after = mct_plant_value(&plant, 0) + PI / 2;
        const double rate_after = mct_plant_value(&plant, 1);
        if (before > 0 && after <= 0) { /* Hermite, inverted by Newton */
            double t = before / (before - after);
            for (int n = 0; n < 6; n++) {
                const double h0 = rate_before * 1e-3;
                const double h1 = rate_after * 1e-3;
                const double b = -3 * before - 2 * h0 + 3 * after - h1;
                const double a = 2 * before + h0 - 2 * after + h1;
                t -= (((a * t + b) * t + h0) * t + before) / ((3 * a * t + 2 * b) * t + h0);
            }
            passage[found++] = start + 1e-3 * t;
        }
        TEST_ASSERT_TRUE(plant.tick < 100000);
    }
    return passage[1] - passage[0];
}

static void test_the_period_is_that_of_the_complete_elliptic_integral(void)
{
    for (double amplitude = 0.5; amplitude < 3; amplitude += 0.8) {
        mct_scene scene = scene_of(system_number, MCT_STEPPER_RK4, MCT_GRAVITY);
        scene.initial[0] = -PI / 2 + amplitude;
        mct_plant plant;
        start_plant(&plant, &scene);
        const textbook model = textbook_of(&scene, 0);
        const double w0 = sqrt((double)(model.weight_moment / model.inertia));
        const double expected = 4 * elliptic_k(sin(amplitude / 2)) / w0;
        const double period = period_of(&plant);
        printf("amplitude %.1f rad: period %.6f s, off by %+.1e\n", amplitude, period, period / expected - 1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1, period / expected);
    }
}

static void test_energy_stays_over_a_million_steps_without_friction(void)
{
    static const int steppers[] = {MCT_STEPPER_LEAP, MCT_STEPPER_RK4};
    static const double allowed[] = {1e-4, 1e-8}; /* leap ripples by (w h)^2, rk4 loses (w h)^5 a step */
    for (int k = 0; k < 2; k++) {
        mct_scene scene = scene_of(system_number, steppers[k], MCT_GRAVITY);
        mct_plant plant;
        start_plant(&plant, &scene);
        double worst = 0;
        for (long tick = 0; tick < 1000000; tick++) {
            mct_plant_step(&plant, 0);
            worst = fmax(worst, fabs(energy_of(&plant)));
        }
        printf("%s: energy off by %.1e J of 20.3 J\n", mct_steppers[steppers[k]].name, worst);
        TEST_ASSERT_TRUE(worst < 20.3 * allowed[k]);
    }
}

/* From one turning point to the next, gravity gives what dry friction takes: G (sin a - sin b) = F |a - b|. */
static void test_dry_friction_takes_its_torque_times_the_way_between_turning_points(void)
{
    const double dry = 1;
    mct_scene scene = scene_of(system_number, MCT_STEPPER_RK4, MCT_GRAVITY | MCT_COULOMB_MOREAU);
    *parameter_of(&scene, "coulomb") = dry;
    mct_plant plant;
    start_plant(&plant, &scene);
    const textbook model = textbook_of(&scene, 0);
    const double G = (double)model.weight_moment;
    double last = mct_plant_value(&plant, 0);
    int turns = 0;
    for (long tick = 0; tick < 20000; tick++) {
        const double before = mct_plant_value(&plant, 1);
        const double at = mct_plant_value(&plant, 0);
        mct_plant_step(&plant, 0);
        const double after = mct_plant_value(&plant, 1);
        if (before != 0 && before * after <= 0) { /* nearest the turn, whose angle is even in time */
            const double turn = fabs(before) < fabs(after) ? at : mct_plant_value(&plant, 0);
            const double gap = G * (sin(last) - sin(turn)) - dry * fabs(last - turn);
            TEST_ASSERT_TRUE(fabs(gap) < 1e-4 * G);
            last = turn;
            turns++;
        }
    }
    printf("%d turning points; at rest %.4f rad from hanging\n", turns, last + PI / 2);
    TEST_ASSERT_TRUE(turns >= 10);
    TEST_ASSERT_TRUE(plant.state.x[1] == 0); /* and then it stays */
    TEST_ASSERT_TRUE(fabs(G * cos(last)) <= dry);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_motion_follows_the_textbook_in_quadruple_precision);
    RUN_TEST(test_each_stepper_has_its_order);
    RUN_TEST(test_the_period_is_that_of_the_complete_elliptic_integral);
    RUN_TEST(test_energy_stays_over_a_million_steps_without_friction);
    RUN_TEST(test_dry_friction_takes_its_torque_times_the_way_between_turning_points);
    return UNITY_END();
}

/*
 * Ten seconds of every stepper at 1 kHz against the reference in quadruple precision; the measured errors are
 * printed.
 *
 * Errors are the worst over all states and all ticks that are looked at (every 20th), each state relative to
 * the largest size that it has in the run, at least 1. Bounds: double, those that the project promises;
 * float, 5e-6, which is some forty roundings of a state of size 2 pi; both hold for steppers that are
 * accurate enough, so that rounding decides.
 */
#include <math.h>
#include <stdio.h>

#include "support/reference.h"
#include "support/scenes.h"
#include "unity.h"

#define DURATION    10.0
#define TICK        1e-3
#define FLOAT_BOUND 5e-6

enum { TICKS = 10000, EVERY = 20, SAMPLES = TICKS / EVERY };

void setUp(void)
{
}

void tearDown(void)
{
}

typedef double trajectory[SAMPLES][REFERENCE_STATES];

static trajectory exact;

/* Volts, as the plant gets them. */
static mct_real held_sine(int tick)
{
    return (mct_real)(8.0 * sin(4.0 * TICK * tick));
}

/* Worst scaled error of a run against `exact`; infinite where it diverges or stops. */
static double error_of(const mct_scene *scene, int states, bool driven)
{
    double size[REFERENCE_STATES];
    for (int i = 0; i < states; i++) {
        size[i] = 1;
        for (int k = 0; k < SAMPLES; k++) {
            size[i] = fmax(size[i], fabs(exact[k][i]));
        }
    }
    mct_plant plant;
    start_plant(&plant, scene);
    double worst = 0;
    for (int tick = 0; tick < TICKS; tick++) {
        mct_plant_step(&plant, driven ? held_sine(tick) : 0);
        if ((tick + 1) % EVERY == 0) {
            for (int i = 0; i < states; i++) {
                worst = fmax(worst, fabs(mct_plant_value(&plant, i) - exact[tick / EVERY][i]) / size[i]);
            }
        }
    }
    return plant.diverged_ticks > 0 ? INFINITY : worst;
}

static void keep(const quad *x, int sample)
{
    for (int i = 0; i < REFERENCE_STATES; i++) {
        exact[sample][i] = (double)x[i];
    }
}

static double stepper_error(mct_scene scene, int stepper, const char *what, bool driven)
{
    scene.stepper = stepper;
    const double error = error_of(&scene, mct_state_count(&scene), driven);
    printf("%-44s %-6s %.2e\n", what, mct_steppers[stepper].name, error);
    return error;
}

/* ---- cart-pole, motor off, released at 2 rad ---- */

static mct_scene free_cart_pole(double cart, double pole, double length, double cart_friction,
                                double pole_friction)
{
    mct_scene scene = scene_of(CART_POLE, MCT_STEPPER_RK4, MCT_GRAVITY | MCT_VISCOUS);
    *parameter_of(&scene, "cart_mass") = cart;
    *parameter_of(&scene, "pole_mass") = pole;
    *parameter_of(&scene, "pole_length") = length;
    *parameter_of(&scene, "cart_friction") = cart_friction;
    *parameter_of(&scene, "pole_friction") = pole_friction;
    scene.initial[1] = 2.0;
    return scene;
}

static void compute_free_cart_pole(const mct_scene *scene)
{
    const reference_model model = reference_of(scene);
    quad x[REFERENCE_STATES];
    reference_start(&model, scene->initial, x);
    for (int k = 0; k < SAMPLES; k++) {
        reference_extrapolate(&model, x, 0, (quad)EVERY / 1000, 1);
        keep(x, k);
    }
}

static void check_free_cart_pole(mct_scene scene, const char *what)
{
    compute_free_cart_pole(&scene);
    const double rk4 = stepper_error(scene, MCT_STEPPER_RK4, what, false);
    const double leap = stepper_error(scene, MCT_STEPPER_LEAP, what, false);
    const double euler = stepper_error(scene, MCT_STEPPER_EULER, what, false);
    const double seed = stepper_error(scene, MCT_STEPPER_SEED, what, false);
    TEST_ASSERT_TRUE(rk4 < (MCT_REAL_IS_FLOAT ? FLOAT_BOUND : 5e-9));
    TEST_ASSERT_TRUE(leap < 2e-3); /* its error constant: 1e-6 w^3 t / 24 for the fastest of these scenes */
    TEST_ASSERT_TRUE(rk4 < leap && leap < euler && euler < INFINITY);
    TEST_ASSERT_TRUE(seed > 30 * leap);
}

static void test_rk4_follows_the_default_cart_pole_within_5e_9(void)
{
    check_free_cart_pole(free_cart_pole(0.758, 0.175, 0.434, 4.3, 0.0024), "cart-pole, default");
}

static void test_rk4_follows_the_cart_pole_of_the_benchmarks_within_5e_9(void)
{
    check_free_cart_pole(free_cart_pole(1, 0.2, 0.5, 0.1, 0.005), "cart-pole, m1 1, m2 0.2, l 0.5");
}

static void test_rk4_follows_a_cart_lighter_than_its_pole_within_5e_9(void)
{
    check_free_cart_pole(free_cart_pole(0.4, 0.5, 0.6, 0.05, 0.001),
                         "cart-pole, hard: m1 0.4, m2 0.5, l 0.6");
}

/* ---- reaction wheel, inductive ---- */

static mct_scene wheel(double time_constant)
{
    mct_scene scene =
        scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_INDUCTIVE);
    *parameter_of(&scene, "inductance") = time_constant * *parameter_of(&scene, "resistance");
    scene.initial[0] = 2.0;
    return scene;
}

static reference_flow first_tick;
static reference_flow later;

static void compute_driven_wheel(const mct_scene *scene, double time_constant)
{
    const reference_model model = reference_of(scene);
    TEST_ASSERT_TRUE(reference_flow_prepare(&later, &model, TICK, 2 * time_constant, TICK) > 0);
    quad x[REFERENCE_STATES];
    reference_start(&model, scene->initial, x);
    for (int tick = 0; tick < TICKS; tick++) {
        reference_flow_advance(&later, x, held_sine(tick));
        if ((tick + 1) % EVERY == 0) {
            keep(x, tick / EVERY);
        }
    }
}

static void compute_free_wheel(const mct_scene *scene, double time_constant)
{
    const reference_model model = reference_of(scene);
    const double sample = EVERY * TICK;
    TEST_ASSERT_TRUE(reference_flow_prepare(&first_tick, &model, sample, 2 * time_constant, sample / 8) > 0);
    TEST_ASSERT_TRUE(reference_flow_prepare(&later, &model, sample, sample / 8, sample / 8) > 0);
    quad x[REFERENCE_STATES];
    reference_start(&model, scene->initial, x);
    for (int k = 0; k < SAMPLES; k++) {
        reference_flow_advance(k == 0 ? &first_tick : &later, x, 0);
        keep(x, k);
    }
}

static void check_wheel(double time_constant, bool driven)
{
    char what[64];
    snprintf(what, sizeof what, "reaction wheel, L/R %g s, %s", time_constant, driven ? "held sine" : "free");
    const mct_scene scene = wheel(time_constant);
    if (driven) {
        compute_driven_wheel(&scene, time_constant);
    } else {
        compute_free_wheel(&scene, time_constant);
    }
    const double expo = stepper_error(scene, MCT_STEPPER_EXPO, what, driven);
    const double leap = stepper_error(scene, MCT_STEPPER_LEAP, what, driven);
    const double euler = stepper_error(scene, MCT_STEPPER_EULER, what, driven);
    TEST_ASSERT_TRUE(expo < (MCT_REAL_IS_FLOAT ? FLOAT_BOUND : 1e-8));
    TEST_ASSERT_TRUE(leap < 2e-3); /* 7e-4 at worst in the prototype */
    TEST_ASSERT_TRUE(expo < leap && leap < euler && euler < INFINITY);
    if (TICK / time_constant < mct_steppers[MCT_STEPPER_RK4].motor_stability_limit) {
        stepper_error(scene, MCT_STEPPER_RK4, what, driven);
        stepper_error(scene, MCT_STEPPER_SEED, what, driven);
    }
}

static void test_expo_follows_a_driven_wheel_within_1e_8_at_any_time_constant_of_the_motor(void)
{
    check_wheel(10e-6, true);
    check_wheel(100e-6, true);
    check_wheel(1e-3, true);
    check_wheel(5e-3, true);
}

static void test_expo_follows_a_free_wheel_within_1e_8_at_any_time_constant_of_the_motor(void)
{
    check_wheel(10e-6, false);
    check_wheel(100e-6, false);
    check_wheel(1e-3, false);
    check_wheel(5e-3, false);
}

int main(void)
{
    if (!HAVE_REFERENCE) {
        puts("skipped: this compiler has no quadruple precision");
        return 77;
    }
    UNITY_BEGIN();
    RUN_TEST(test_rk4_follows_the_default_cart_pole_within_5e_9);
    RUN_TEST(test_rk4_follows_the_cart_pole_of_the_benchmarks_within_5e_9);
    RUN_TEST(test_rk4_follows_a_cart_lighter_than_its_pole_within_5e_9);
    RUN_TEST(test_expo_follows_a_driven_wheel_within_1e_8_at_any_time_constant_of_the_motor);
    RUN_TEST(test_expo_follows_a_free_wheel_within_1e_8_at_any_time_constant_of_the_motor);
    return UNITY_END();
}

/* The motor at the ends of its range: no inductance, no resistance, high speed. */
#include <math.h>
#include <stdio.h>

#include "support/scenes.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static mct_scene scene_with_motor(int system, int stepper, double resistance, double inductance)
{
    mct_scene scene = scene_of(system, stepper, MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_INDUCTIVE);
    *parameter_of(&scene, "resistance") = resistance;
    *parameter_of(&scene, "inductance") = inductance;
    scene.initial[mct_systems[system]->actuation->upright_coordinate] = 2;
    return scene;
}

/* State after half a second under a square wave, 50 Hz. */
static void run_wave(const mct_scene *scene, double *end)
{
    mct_plant plant;
    start_plant(&plant, scene);
    for (int k = 0; k < 500; k++) {
        mct_plant_step(&plant, (k / 10) % 2 ? 8 : -6);
    }
    for (int i = 0; i < 4; i++) {
        end[i] = mct_plant_value(&plant, i);
    }
    TEST_ASSERT_EQUAL_UINT64(0, plant.diverged_ticks);
}

/* The gap to L = 0 shrinks with L down to rounding and has no jump: leap averages the current exactly, expo
 * flows it. */
static void test_the_motion_is_continuous_in_the_inductance_down_to_zero(void)
{
    static const double inductances[] = {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9};
    static const struct {
        int system, stepper;
    } pairs[] = {{CART_POLE, MCT_STEPPER_LEAP},
                 {REACTION_WHEEL, MCT_STEPPER_LEAP},
                 {REACTION_WHEEL, MCT_STEPPER_EXPO}};
    for (size_t n = 0; n < sizeof pairs / sizeof pairs[0]; n++) {
        const double resistance = pairs[n].system == CART_POLE ? 2.6 : 12.1;
        double limit[4];
        const mct_scene without = scene_with_motor(pairs[n].system, pairs[n].stepper, resistance, 0);
        TEST_ASSERT_EQUAL_UINT32(MCT_MOTOR_QUASI_STATIC, mct_scene_effects(&without) & MCT_MOTOR);
        run_wave(&without, limit);
        double before = INFINITY;
        printf("%s, %s: gap to L = 0:", mct_systems[pairs[n].system]->name,
               mct_steppers[pairs[n].stepper].name);
        for (int k = 0; k < 7; k++) {
            const mct_scene scene =
                scene_with_motor(pairs[n].system, pairs[n].stepper, resistance, inductances[k]);
            double end[4];
            run_wave(&scene, end);
            double gap = 0;
            for (int i = 0; i < 4; i++) {
                gap = fmax(gap, fabs(end[i] - limit[i]) / fmax(1, fabs(limit[i])));
            }
            printf(" %.1e", gap);
            /* ten times less inductance, ten times less gap, until roundings of 500 steps are all that is
             * left */
            TEST_ASSERT_TRUE(gap < fmax(before / 5, 500 * (double)MCT_REAL_EPSILON));
            before = gap;
        }
        printf("\n");
    }
}

/* 10 V on a hanging wheel: at L/R = 0.5 ms the quasi-static arm is off by 0.16 mrad after 2 s (ERRATA). */
static void test_the_gap_to_the_quasi_static_motor_is_linear_in_its_time_constant(void)
{
    double gap[4];
    double end = 0;
    for (int k = 0; k < 4; k++) {
        const double time_constant = 0.5e-3 / (1 << k);
        mct_scene inductive = scene_with_motor(REACTION_WHEEL, MCT_STEPPER_EXPO, 12.1, 12.1 * time_constant);
        inductive.initial[0] = 3.141592653589793;
        mct_scene quasi_static = inductive;
        quasi_static.effects = MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_QUASI_STATIC;
        mct_plant a;
        mct_plant b;
        start_plant(&a, &inductive);
        start_plant(&b, &quasi_static);
        gap[k] = 0;
        for (int tick = 0; tick < 2000; tick++) {
            mct_plant_step(&a, 10);
            mct_plant_step(&b, 10);
            const double now = fabs(mct_plant_value(&a, 0) - mct_plant_value(&b, 0));
            gap[k] = fmax(gap[k], now);
            end = k == 0 ? now : end;
        }
    }
    printf("arm's gap at L/R = 0.5 ms: %.3f mrad after 2 s, at most %.3f; halved: %.3f, %.3f, %.3f\n",
           end * 1e3, gap[0] * 1e3, gap[1] * 1e3, gap[2] * 1e3, gap[3] * 1e3);
    TEST_ASSERT_DOUBLE_WITHIN(0.02e-3, 0.16e-3, end);
    for (int k = 1; k < 4; k++) {
        TEST_ASSERT_DOUBLE_WITHIN(MCT_REAL_IS_FLOAT ? 0.1 : 0.02, 2, gap[k - 1] / gap[k]);
    }
}

/* Without resistance the current of a shorted motor is -(k / L) times the way of the wheel. */
static void test_a_motor_without_resistance_is_finite_and_its_current_follows_the_way(void)
{
    static const int steppers[] = {MCT_STEPPER_EULER, MCT_STEPPER_LEAP, MCT_STEPPER_RK4, MCT_STEPPER_EXPO};
    for (size_t n = 0; n < sizeof steppers / sizeof steppers[0]; n++) {
        for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
            const mct_scene scene = scene_with_motor(system, steppers[n], 0, 0.5);
            if (mct_systems[system]->kernel(scene.stepper, scene.effects) == NULL) {
                continue;
            }
            mct_plant plant;
            start_plant(&plant, &scene);
            step_plant(&plant, 0, 2000);
            TEST_ASSERT_EQUAL_UINT64(0, plant.diverged_ticks);
            const double emf = system == CART_POLE ? 0.00767 * 3.71 / 0.00635 : 0.0274;
            const int driven = mct_systems[system]->actuation->driven_coordinate;
            const double way = mct_plant_value(&plant, driven) - scene.initial[driven];
            const double current = mct_plant_value(&plant, 4);
            TEST_ASSERT_TRUE(fabs(way) > 1e-3);
            /* leap and euler see another way within a step: h/2 times the rate */
            const double rate = fabs(mct_plant_value(&plant, 2 + driven));
            const double tolerance =
                emf / 0.5 * (fabs(way) * (MCT_REAL_IS_FLOAT ? 1e-4 : 1e-6) + 1e-3 * (rate + 5));
            TEST_ASSERT_DOUBLE_WITHIN(tolerance, -emf / 0.5 * way, current);
            if (steppers[n] == MCT_STEPPER_EXPO || steppers[n] == MCT_STEPPER_RK4) {
                TEST_ASSERT_DOUBLE_WITHIN(fabs(current) * (MCT_REAL_IS_FLOAT ? 1e-4 : 1e-7), -emf / 0.5 * way,
                                          current);
            }
        }
    }
}

static void test_a_motor_with_neither_resistance_nor_inductance_is_refused(void)
{
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        const mct_scene scene = scene_with_motor(system, MCT_STEPPER_LEAP, 0, 0);
        mct_plant plant;
        mct_message why = {""};
        TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_plant_init(&plant, &scene, &why));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "parameters.resistance: found 0 ohm"), why.text);
    }
}

static void test_a_current_that_settles_at_once_is_refused_by_its_inductance(void)
{
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        const mct_scene scene = scene_with_motor(system, MCT_STEPPER_LEAP, 1e6, 1e-17);
        mct_plant plant;
        mct_message why = {""};
        TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_plant_init(&plant, &scene, &why));
        TEST_ASSERT_NOT_NULL_MESSAGE(
            strstr(why.text,
                   "parameters.inductance: found 1e-17 H, with which the current settles within 1e-23 s"),
            why.text);
    }
}

/* A wheel at 1e4 rad/s under 10 V brakes to V / k, 365 rad/s, without a swing about it, at any L/R and at
 * long ticks. */
static void test_a_wheel_at_1e4_rad_per_s_slows_monotonically_to_the_voltage_over_k(void)
{
    static const int steppers[] = {MCT_STEPPER_LEAP, MCT_STEPPER_EXPO};
    static const double inductances[] = {0, 12.1 * 1e-6, 12.1 * 1e-4};
    for (int n = 0; n < 2; n++) {
        for (int m = 0; m < 3; m++) {
            mct_scene scene = scene_with_motor(REACTION_WHEEL, steppers[n], 12.1, inductances[m]);
            scene.effects = MCT_MOTOR_INDUCTIVE;
            scene.initial[3] = 1e4;
            scene.initial[4] = (10 - 0.0274 * 1e4) / 12.1;
            scene.dt = 0.01;
            mct_plant plant;
            start_plant(&plant, &scene);
            double before = 1e4;
            const double last = 10 / 0.0274;
            for (int k = 0; k < 2000; k++) {
                mct_plant_step(&plant, 10);
                const double rate = mct_plant_value(&plant, 3);
                TEST_ASSERT_TRUE(rate <= before * (1 + (double)MCT_REAL_EPSILON) &&
                                 rate > last * (1 - 100 * (double)MCT_REAL_EPSILON));
                before = rate;
            }
            TEST_ASSERT_DOUBLE_WITHIN(1e-3 * last, last, before);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_motion_is_continuous_in_the_inductance_down_to_zero);
    RUN_TEST(test_the_gap_to_the_quasi_static_motor_is_linear_in_its_time_constant);
    RUN_TEST(test_a_motor_without_resistance_is_finite_and_its_current_follows_the_way);
    RUN_TEST(test_a_motor_with_neither_resistance_nor_inductance_is_refused);
    RUN_TEST(test_a_current_that_settles_at_once_is_refused_by_its_inductance);
    RUN_TEST(test_a_wheel_at_1e4_rad_per_s_slows_monotonically_to_the_voltage_over_k);
    return UNITY_END();
}

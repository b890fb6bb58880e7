/*
 * Dry friction before textbook results, by Moreau's clamp and exact, on every stepper that has the one or the other.
 *
 * Tolerances, Moreau: a stop is off by the way of the step that it falls in, at most a h^2 / 8; exact: some roundings of
 * the way, and of each of thousands of steps; in float 100 times 6e-8 of the way.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scenes.h"
#include "unity.h"

#define ROUNDING (MCT_REAL_IS_FLOAT ? 100 * (double)FLT_EPSILON : 100 * DBL_EPSILON)

static const uint32_t kinds[] = {MCT_COULOMB_MOREAU, MCT_COULOMB_EXACT};

void setUp(void)
{
}

void tearDown(void)
{
}

/* seed and euler are of first order while a body slides under its weight. */
static bool is_accurate(int stepper)
{
    return stepper != MCT_STEPPER_SEED && stepper != MCT_STEPPER_EULER;
}

/* Without weight: w^2 I / (2 tau). */
static void test_a_hinge_stops_after_w2_i_over_2_tau(void)
{
    const int system = system_called("pendulum");
    for (int i = 0; i < 2; i++) {
        FOR_EACH_STEPPER (stepper, system, kinds[i]) {
            mct_scene scene = scene_of(system, stepper, kinds[i]);
            *parameter_of(&scene, "coulomb") = 0.02; /* I = 0.009: 2.2 rad/s^2 */
            scene.initial[0] = 0;
            scene.initial[1] = 1.0007;
            mct_plant plant;
            start_plant(&plant, &scene);
            step_plant(&plant, 0, 1000);
            const double way = 1.0007 * 1.0007 * 0.009 / (2 * 0.02);
            const double error = mct_plant_value(&plant, 0) - way;
            printf("stop, %s, %s: %.1e rad\n", i == 0 ? "moreau" : "exact", mct_steppers[stepper].name,
                   error);
            TEST_ASSERT_TRUE(plant.state.x[1] == 0);
            const double clamp = i == 0 ? 0.02 / 0.009 * 1e-6 / 8 : 0;
            TEST_ASSERT_DOUBLE_WITHIN(clamp + ROUNDING * way, 0, error);
        }
    }
}

static void test_what_static_friction_holds_does_not_creep_in_1e6_steps_and_goes_just_above_it(void)
{
    const int system = system_called("pendulum");
    for (int i = 0; i < 2; i++) {
        FOR_EACH_STEPPER (stepper, system, MCT_GRAVITY | kinds[i]) {
            mct_scene scene = scene_of(system, stepper, MCT_GRAVITY | kinds[i]);
            scene.initial[0] = 0.5;
            const double weight = 0.1 * 9.81 * 0.3 * sin(0.5);
            *parameter_of(&scene, "static_ratio") = 1.25;
            /* rk4 looks ahead: it sees the weight where the body would fall to within the step */
            const double margin = stepper == MCT_STEPPER_RK4 ? 1e-4 : ROUNDING;
            mct_plant plant;
            *parameter_of(&scene, "coulomb") = weight / 1.25 * (1 + margin);
            start_plant(&plant, &scene);
            const mct_state before = plant.state;
            step_plant(&plant, 0, 1000000);
            TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&before, &plant.state, sizeof before,
                                             mct_steppers[stepper].name);
            *parameter_of(&scene, "coulomb") = weight / 1.25 * (1 - margin);
            start_plant(&plant, &scene);
            step_plant(&plant, 0, 1000);
            TEST_ASSERT_TRUE(mct_plant_value(&plant, 0) > 0.55); /* by a fifth of its weight */
        }
    }
}

/* m g l (cos th_n - cos th_n+1) = -+ tau (th_n+1 - th_n), from one turning point to the next. */
static double turning_error(int stepper, uint32_t kind, double dt)
{
    const int system = system_called("pendulum");
    mct_scene scene = scene_of(system, stepper, MCT_GRAVITY | kind);
    const double weight = 0.1 * 9.81 * 0.3, friction = 0.01;
    scene.dt = dt;
    *parameter_of(&scene, "coulomb") = friction;
    scene.initial[0] = M_PI - 1.5;
    mct_plant plant;
    start_plant(&plant, &scene);
    double expected = -1.5, worst = 0, last = 0;
    int swings = 0, direction = 1;
    for (long k = 0; k < lround(20 / dt); k++) {
        mct_plant_step(&plant, 0);
        const double rate = mct_plant_value(&plant, 1);
        const double energy = 0.5 * 0.009 * rate * rate - weight * cos(mct_plant_value(&plant, 0) - M_PI);
        if (rate * direction < 0) { /* the next angle at which the energy is what friction has left */
            double low = 0, high = fabs(expected);
            for (int i = 0; i < 60; i++) {
                const double middle = (low + high) / 2;
                const double lost = friction * (fabs(expected) + middle);
                *(weight * (cos(middle) - cos(expected)) > lost ? &low : &high) = middle;
            }
            expected = direction * low;
            direction = -direction;
            swings++;
        }
        /* on the way back: what is left there, less the work on the way so far */
        const double now = mct_plant_value(&plant, 0) - M_PI;
        const double left = -weight * cos(expected) - friction * fabs(now - expected);
        if (rate != 0) {
            last = fabs(energy - left) / weight;
            worst = fmax(worst, last);
        }
    }
    TEST_ASSERT_TRUE(swings > 10 && plant.state.x[1] == 0);
    return worst;
}

static void test_a_pendulum_loses_the_friction_times_its_way_between_turning_points(void)
{
    for (int i = 0; i < 2; i++) {
        FOR_EACH_STEPPER (stepper, system_called("pendulum"), MCT_GRAVITY | kinds[i]) {
            if (is_accurate(stepper)) {
                const double error = turning_error(stepper, kinds[i], 1e-3);
                printf("amplitudes, %s, %s: %.1e of the weight's moment\n", i == 0 ? "moreau" : "exact",
                       mct_steppers[stepper].name, error);
                /*
                 * Moreau: a turning point falls into a step, which friction crosses: tau^2 h^2 / I a swing; leap and
                 * taylor4 have the error of their own order, and float rounds 2e4 steps.
                 */
                const double exact = stepper == MCT_STEPPER_TAYLOR4 ? 1e-9 : 1e-13;
                TEST_ASSERT_TRUE(error < (i == 0 ? 1e-5 : MCT_REAL_IS_FLOAT ? 2e-6 : exact));
            }
        }
    }
}

/* With friction the energy never grows without an input, whatever the step. */
static void test_friction_never_adds_energy_to_a_wheel_that_swings(void)
{
    mct_scene scene = scene_of(REACTION_WHEEL, MCT_STEPPER_TAYLOR6, MCT_GRAVITY | MCT_COULOMB_EXACT);
    *parameter_of(&scene, "arm_coulomb") = 0.01;
    *parameter_of(&scene, "wheel_coulomb") = 1e-4;
    scene.dt = 5e-3;
    scene.initial[0] -= 1.4;
    scene.initial[3] = 30;
    mct_plant plant;
    start_plant(&plant, &scene);
    const double start = energy_of(&plant);
    double before = start;
    for (int k = 0; k < 4000; k++) {
        mct_plant_step(&plant, 0);
        const double now = energy_of(&plant);
        TEST_ASSERT_TRUE(now <= before + ROUNDING * fabs(start));
        before = now;
    }
    TEST_ASSERT_TRUE(plant.state.x[2] == 0 && plant.state.x[3] == 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_hinge_stops_after_w2_i_over_2_tau);
    RUN_TEST(test_what_static_friction_holds_does_not_creep_in_1e6_steps_and_goes_just_above_it);
    RUN_TEST(test_a_pendulum_loses_the_friction_times_its_way_between_turning_points);
    RUN_TEST(test_friction_never_adds_energy_to_a_wheel_that_swings);
    return UNITY_END();
}

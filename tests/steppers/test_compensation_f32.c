/* Single precision is worth what its compensation makes of it. */
#include <math.h>
#include <stdio.h>

#include "support/random.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "unity.h"

enum { TICKS = 10000 };

void setUp(void)
{
}

void tearDown(void)
{
}

/* Error of the upright coordinate after 10 s; without compensation each tick drops what its rounding kept
 * back. */
static double error_after_10_s(const mct_scene *scene, bool compensated, const quad *end)
{
    mct_plant plant;
    start_plant(&plant, scene);
    for (int k = 0; k < TICKS; k++) {
        mct_plant_step(&plant, 0);
        for (int i = 0; i < MCT_MAX_STATES && !compensated; i++) {
            plant.state.c[i] = 0;
        }
    }
    double worst = 0;
    for (int i = 0; i < 4; i++) {
        const double exact = (double)end[i];
        worst = fmax(worst, fabs(mct_plant_value(&plant, i) - exact) / fmax(1, fabs(exact)));
    }
    return worst;
}

/* Ten roundings of 6e-8 would be enough if they came once; a factor of 5 leaves room for luck of the other.
 */
static void check_compensation(int system, int stepper)
{
    mct_scene scene = scene_of(system, stepper, MCT_GRAVITY | MCT_VISCOUS);
    scene.initial[mct_systems[system]->actuation->upright_coordinate] = 2;
    const reference_model model = reference_of(&scene);
    quad end[REFERENCE_STATES];
    reference_start(&model, scene.initial, end);
    reference_extrapolate(&model, end, 0, 10, 500);
    const double with = error_after_10_s(&scene, true, end);
    const double without = error_after_10_s(&scene, false, end);
    printf("%s, %s, 10 s: %.1e compensated, %.1e without\n", mct_systems[system]->name,
           mct_steppers[stepper].name, with, without);
    TEST_ASSERT_TRUE(with < 5e-6);
    TEST_ASSERT_TRUE(without > 5 * with);
}

static void test_a_compensated_state_is_within_5e_6_and_much_better_than_a_bare_one(void)
{
    check_compensation(CART_POLE, MCT_STEPPER_RK4);
    check_compensation(REACTION_WHEEL, MCT_STEPPER_RK4);
    check_compensation(REACTION_WHEEL, MCT_STEPPER_EXPO);
}

/* Mean and worst relative error of the way of a cart that moves freely, over velocities of four octaves. */
static double time_lost(int stepper, double *worst)
{
    enum { VELOCITIES = 400, TICKS_EACH = 20000 };
    test_random random = {17};
    double mean = 0;
    *worst = 0;
    for (int n = 0; n < VELOCITIES; n++) {
        mct_scene scene = scene_of(CART_POLE, stepper, 0);
        scene.initial[1] = 0;
        scene.initial[2] = (double)(float)random_scale(&random, 0.5, 8);
        mct_plant plant;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, TICKS_EACH);
        const double error = mct_plant_value(&plant, 0) / (scene.initial[2] * TICKS_EACH * 1e-3) - 1;
        mean += error / VELOCITIES;
        *worst = fmax(*worst, fabs(error));
    }
    printf("%s: time lost %.1e in the mean, %.1e at worst; a bare float step %.1e\n",
           mct_steppers[stepper].name, mean, *worst, (double)1e-3f / 1e-3 - 1);
    return mean;
}

/*
 * 1e-3f is 1.0000000475e-3: over a day 4 ms too long. What the step lacks is added to every increment. At one
 * steady velocity it may fall victim to the rounding of the increment, 6e-8 of it, and of its sum with the
 * compensation, as much again; over all velocities it must not. 400 of them leave 3e-9 of that: four times as much.
 */
static void test_a_step_that_float_cannot_hold_loses_no_time(void)
{
    static const int steppers[] = {MCT_STEPPER_SEED, MCT_STEPPER_EULER, MCT_STEPPER_LEAP};
    for (int n = 0; n < 3; n++) {
        double worst;
        TEST_ASSERT_DOUBLE_WITHIN(1.2e-8, 0, time_lost(steppers[n], &worst));
        TEST_ASSERT_TRUE(worst < 2 * 6e-8);
    }
}

/* Six times its weight h/6, rounded, is not h: what the step lacks must be that of the weight. */
static void test_rk4_loses_no_time_either(void)
{
    double worst;
    TEST_ASSERT_DOUBLE_WITHIN(1.2e-8, 0, time_lost(MCT_STEPPER_RK4, &worst));
}

int main(void)
{
    if (!HAVE_REFERENCE) {
        puts("skipped: this compiler has no quadruple precision");
        return 77;
    }
    UNITY_BEGIN();
    RUN_TEST(test_a_compensated_state_is_within_5e_6_and_much_better_than_a_bare_one);
    RUN_TEST(test_a_step_that_float_cannot_hold_loses_no_time);
    RUN_TEST(test_rk4_loses_no_time_either);
    return UNITY_END();
}

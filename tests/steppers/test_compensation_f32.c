/* Single precision is worth what its compensation makes of it. */
#include <math.h>
#include <stdio.h>

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
    scene.initial[mct_systems[system]->upright_coordinate] = 2;
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

/* 1e-3f is 1.0000000475e-3: over a day 4 ms too long. What the step lacks is made up for in every increment.
 */
static void test_a_step_that_float_cannot_hold_loses_no_time(void)
{
    mct_scene scene = scene_of(CART_POLE, MCT_STEPPER_RK4, 0);
    scene.initial[1] = 0;
    scene.initial[2] = 1;
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 1000000);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 1000.0, mct_plant_value(&plant, 0)); /* 4.7e-5 with the bare step */
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
    return UNITY_END();
}

/* The main job: both default scenes swing up from hanging and balance. */
#include <stdio.h>

#include "support/scenes.h"
#include "support/swing_up.h"
#include "unity.h"

#define DEGREES 57.29577951308232

void setUp(void)
{
}

void tearDown(void)
{
}

static swing_up run_default(int system)
{
    const mct_scene scene = swing_up_scene(system);
    const swing_up run = run_swing_up(&scene, 30, 10);
    printf("%s: upright from %.3f s, then within %.4f degrees; at the end rate %.3g; cart or arm at %.3g, at "
           "most %.3f\n",
           mct_systems[system]->name, run.upright_time, run.deviation * DEGREES, run.wheel_rate,
           run.cart_position, run.farthest);
    TEST_ASSERT_TRUE(run.upright_time <= 10);
    TEST_ASSERT_TRUE(run.deviation * DEGREES < 2);
    TEST_ASSERT_EQUAL_UINT32(0, run.faults);
    return run;
}

static void test_the_reaction_wheel_is_upright_within_10_s_and_within_2_degrees_until_30_s(void)
{
    TEST_ASSERT_TRUE(run_default(REACTION_WHEEL).wheel_rate < 20);
}

static void test_the_cart_pole_is_upright_within_10_s_and_within_2_degrees_until_30_s(void)
{
    const swing_up run = run_default(CART_POLE);
    TEST_ASSERT_TRUE(run.cart_position < 0.03);
    TEST_ASSERT_TRUE(run.farthest < 0.4); /* the track */
}

/* The other motors and steppers, and a plant that starts elsewhere. */
static void test_the_swing_up_does_not_hang_on_stepper_or_motor_or_start(void)
{
    static const double starts[] = {0.1, 2.0, -2.5, 9.5};
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        for (int k = 0; k < 4; k++) {
            mct_scene scene = swing_up_scene(system);
            scene.stepper = k % 2 ? MCT_STEPPER_LEAP : MCT_STEPPER_RK4;
            scene.effects &= ~(uint32_t)MCT_MOTOR;
            scene.effects |= k % 2 ? MCT_MOTOR_INDUCTIVE : MCT_MOTOR_QUASI_STATIC;
            scene.initial[mct_systems[system]->actuation->upright_coordinate] = starts[k];
            const swing_up run = run_swing_up(&scene, 30, 20);
            printf("%s from %g rad, %s: upright from %.3f s\n", mct_systems[system]->name, starts[k],
                   motor_name(scene.effects), run.upright_time);
            TEST_ASSERT_TRUE(run.upright_time <= 15);
            TEST_ASSERT_EQUAL_UINT32(0, run.faults);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_reaction_wheel_is_upright_within_10_s_and_within_2_degrees_until_30_s);
    RUN_TEST(test_the_cart_pole_is_upright_within_10_s_and_within_2_degrees_until_30_s);
    RUN_TEST(test_the_swing_up_does_not_hang_on_stepper_or_motor_or_start);
    return UNITY_END();
}

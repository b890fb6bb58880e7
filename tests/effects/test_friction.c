/* Dry friction in motion: what sticks stays, what slides stops where theory says. */
#include <math.h>
#include <stdio.h>

#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* The arm, 45 degrees off upright, its weight of 0.25 N m held by a friction of 0.3 N m. */
static mct_scene held_arm(int stepper, double friction)
{
    mct_scene scene = scene_of(REACTION_WHEEL, stepper, MCT_GRAVITY | MCT_COULOMB_MOREAU);
    scene.initial[0] = 0.785;
    *parameter_of(&scene, "arm_coulomb") = friction;
    *parameter_of(&scene, "wheel_coulomb") = 1e-3;
    return scene;
}

static void test_an_arm_held_by_dry_friction_does_not_creep_in_1e6_ticks(void)
{
    FOR_EACH_STEPPER (stepper, REACTION_WHEEL, MCT_GRAVITY | MCT_COULOMB_MOREAU) {
        const mct_scene scene = held_arm(stepper, 0.3);
        mct_plant plant;
        start_plant(&plant, &scene);
        const mct_state before = plant.state;
        step_plant(&plant, 0, TEST_CASES(1000000));
        for (int i = 0; i < 4; i++) {
            TEST_ASSERT_TRUE(plant.state.x[i] == before.x[i] && plant.state.c[i] == before.c[i]);
        }
    }
}

static void test_an_arm_that_friction_cannot_hold_starts_to_move(void)
{
    FOR_EACH_STEPPER (stepper, REACTION_WHEEL, MCT_GRAVITY | MCT_COULOMB_MOREAU) {
        const mct_scene scene = held_arm(stepper, 0.24);
        mct_plant plant;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, 1000);
        TEST_ASSERT_TRUE(mct_plant_value(&plant, 0) > scene.initial[0] + 0.1);
    }
}

/* A cart alone: v^2 / (2 a), a = F / m. The tick in which it stops is off by at most h^2 a / 8. */
static void test_a_sliding_cart_stops_where_v_squared_over_2_a_says_and_then_rests(void)
{
    FOR_EACH_STEPPER (stepper, CART_POLE, MCT_COULOMB_MOREAU) {
        mct_scene scene = scene_of(CART_POLE, stepper, MCT_COULOMB_MOREAU);
        *parameter_of(&scene, "cart_coulomb") = 2;
        *parameter_of(&scene, "pole_mass") = 0.5;
        *parameter_of(&scene, "cart_mass") = 0.5;
        *parameter_of(&scene, "pole_coulomb") = 100; /* the pole is locked to the cart, straight up */
        scene.initial[1] = 0;
        scene.initial[2] = 1;
        const double a = 2.0 / 1.0;
        mct_plant plant;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, 2000);
        const double error = fabs(mct_plant_value(&plant, 0) - 0.5 / a);
        printf("%-5s stops %.1e m off\n", mct_steppers[stepper].name, error);
        /* seed's free term is half a step of acceleration more; float: 500 roundings of a way of 0.25 m */
        const double way = 1e-6 * a / 8 + 100 * (double)MCT_REAL_EPSILON * 0.25;
        TEST_ASSERT_TRUE(error <
                         (stepper == MCT_STEPPER_EULER || stepper == MCT_STEPPER_SEED ? 1e-3 : 2 * way));
        TEST_ASSERT_TRUE(plant.state.x[2] == 0 && plant.state.x[3] == 0);
        const mct_state rest = plant.state;
        step_plant(&plant, MCT_R(1.99), 10000); /* less than the friction */
        TEST_ASSERT_TRUE(plant.state.x[0] == rest.x[0] && plant.state.x[2] == 0);
        step_plant(&plant, MCT_R(2.01), 10000);
        TEST_ASSERT_TRUE(plant.state.x[0] > rest.x[0]);
    }
}

/*
 * A hanging pendulum with dry friction alone loses tau (|th_n| + |th_n+1|) between two turning points, where
 * it may rest for a tick. Tolerance: a turning point is found to a tick, where the energy is off by the
 * square of a tick's rate.
 */
static void test_each_half_swing_loses_the_friction_times_its_way(void)
{
    mct_scene scene = scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, MCT_GRAVITY | MCT_COULOMB_MOREAU);
    const double friction = 0.005;
    *parameter_of(&scene, "arm_coulomb") = friction;
    *parameter_of(&scene, "wheel_coulomb") = 10; /* the wheel is locked to the arm */
    scene.initial[0] -= 1.0;
    mct_plant plant;
    start_plant(&plant, &scene);
    const double weight = (0.025384 + 0.085 * 0.127) * 9.81;
    double turning = -1.0;
    int swings = 0;
    int resting = 0; /* ticks */
    double direction = 1;
    for (int k = 0; k < 60000 && resting < 100; k++) {
        mct_plant_step(&plant, 0);
        const double rate = mct_plant_value(&plant, 2);
        resting = rate == 0 ? resting + 1 : 0;
        if (rate * direction < 0) {
            direction = -direction;
            const double reached = mct_plant_value(&plant, 0) - 3.141592653589793;
            const double lost = weight * (cos(reached) - cos(turning));
            TEST_ASSERT_DOUBLE_WITHIN(2e-5, friction * fabs(reached - turning), lost);
            turning = reached;
            swings++;
        }
    }
    const double rest = mct_plant_value(&plant, 0) - 3.141592653589793;
    printf("%d half swings, at rest %.4f rad from hanging\n", swings, rest);
    TEST_ASSERT_TRUE(resting == 100 && swings > 10);
    TEST_ASSERT_TRUE(weight * fabs(sin(rest)) <= friction);
    TEST_ASSERT_TRUE(plant.state.x[3] == 0); /* the lock held */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_arm_held_by_dry_friction_does_not_creep_in_1e6_ticks);
    RUN_TEST(test_an_arm_that_friction_cannot_hold_starts_to_move);
    RUN_TEST(test_a_sliding_cart_stops_where_v_squared_over_2_a_says_and_then_rests);
    RUN_TEST(test_each_half_swing_loses_the_friction_times_its_way);
    return UNITY_END();
}

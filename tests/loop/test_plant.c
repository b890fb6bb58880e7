/* The plant refuses what would poison it, counts it, and keeps angles that grow. */
#include <math.h>
#include <string.h>

#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

#define TURN 6.283185307179586

void setUp(void)
{
}

void tearDown(void)
{
}

static const double bad_inputs[] = {NAN, INFINITY, -INFINITY};

/* Not finite: counted, the last valid input is held, and not a bit differs from a run that was given that
 * input. */
static void test_an_input_that_is_not_finite_is_refused_counted_and_the_last_one_held(void)
{
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        const mct_scene scene = scene_of(system, MCT_STEPPER_LEAP, mct_systems[system]->standard_effects);
        mct_plant plant;
        mct_plant twin;
        start_plant(&plant, &scene);
        start_plant(&twin, &scene);
        for (int k = 0; k < 300; k++) {
            const mct_real good = (mct_real)(5 * sin(0.01 * (k - k % 10)));
            mct_plant_step(&plant, k % 10 == 0 ? good : (mct_real)bad_inputs[k % 3]);
            mct_plant_step(&twin, good);
            TEST_ASSERT_EQUAL_MEMORY(&twin.state, &plant.state, sizeof plant.state);
        }
        TEST_ASSERT_EQUAL_UINT64(270, plant.rejected_inputs);
        TEST_ASSERT_EQUAL_UINT64(300, plant.tick);
        TEST_ASSERT_EQUAL_UINT64(0, plant.diverged_ticks);
    }
}

static void test_a_bad_first_input_leaves_the_plant_at_zero_volts(void)
{
    const mct_scene scene = scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, MCT_GRAVITY | MCT_MOTOR_QUASI_STATIC);
    mct_plant plant;
    start_plant(&plant, &scene);
    mct_plant_step(&plant, (mct_real)NAN);
    TEST_ASSERT_TRUE(plant.input == 0);
    TEST_ASSERT_EQUAL_UINT64(1, plant.rejected_inputs);
}

/* rk4 far beyond its stability: the state before stays, to the last bit, and each refusal is counted. */
static void test_a_result_that_has_blown_up_is_refused_and_the_state_kept(void)
{
    mct_scene scene = scene_of(REACTION_WHEEL, MCT_STEPPER_RK4, MCT_GRAVITY | MCT_MOTOR_INDUCTIVE);
    *parameter_of(&scene, "inductance") = 1e-9;
    mct_plant plant;
    start_plant(&plant, &scene);
    mct_plant_step(&plant, 0);
    for (int k = 0; k < 200; k++) {
        const mct_state before = plant.state;
        const uint64_t refused = plant.diverged_ticks;
        mct_plant_step(&plant, 10);
        TEST_ASSERT_TRUE(fabs((double)plant.state.x[4]) <= 1e9);
        if (plant.diverged_ticks > refused) {
            TEST_ASSERT_EQUAL_MEMORY(&before, &plant.state, sizeof before);
        }
    }
    TEST_ASSERT_TRUE(plant.diverged_ticks > 100);
}

/*
 * An arm that goes round: the plant, which takes turns out, against its bare kernel, which does not.
 * Tolerance: the roundings of the kernel's own, growing angle, 300 rad at the end, over 20 s.
 */
static void test_taking_turns_out_changes_neither_value_nor_motion(void)
{
    mct_scene scene = scene_of(REACTION_WHEEL, MCT_STEPPER_LEAP, MCT_GRAVITY);
    scene.initial[0] = 1;
    scene.initial[2] = 16; /* over the top, again and again */
    scene.initial[3] = -40;
    mct_plant plant;
    start_plant(&plant, &scene);
    mct_plant bare = plant;
    int turned = 0;
    for (int k = 0; k < 20000; k++) {
        const mct_real u = (mct_real)(1e-4 * sin(0.003 * k));
        const int32_t before = plant.state.turns[0];
        mct_plant_step(&plant, u);
        bare.kernel(&bare.constants, &bare.state, u, 1);
        turned += plant.state.turns[0] != before;
        for (int i = 0; i < 4; i++) {
            const double tolerance = 4000 * (double)MCT_REAL_EPSILON * (i < 2 ? 300 : 20);
            TEST_ASSERT_DOUBLE_WITHIN(tolerance, (double)bare.state.x[i] + (double)bare.state.c[i],
                                      mct_plant_value(&plant, i));
        }
        TEST_ASSERT_TRUE(fabs((double)plant.state.x[0]) <= TURN * 1.01 &&
                         fabs((double)plant.state.x[1]) <= TURN * 1.01);
    }
    TEST_ASSERT_TRUE(turned > 20);
}

/* The same start some turns away moves the same way. What double cannot hold of a start grows, but slowly on
 * this scene. */
static void test_a_start_that_is_whole_turns_away_moves_the_same_way(void)
{
    static const int turns[] = {1, -1, 5, -1000};
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        const int upright = mct_systems[system]->actuation->upright_coordinate;
        mct_scene scene = scene_of(system, MCT_STEPPER_RK4, MCT_GRAVITY | MCT_VISCOUS);
        scene.initial[upright] = 2;
        mct_plant home;
        start_plant(&home, &scene);
        step_plant(&home, 0, 5000);
        for (size_t n = 0; n < sizeof turns / sizeof turns[0]; n++) {
            mct_scene away = scene;
            away.initial[upright] = 2 + turns[n] * TURN;
            mct_plant plant;
            start_plant(&plant, &away);
            step_plant(&plant, 0, 5000);
            for (int i = 0; i < 4; i++) {
                const double shift = i == upright ? turns[n] * TURN : 0;
                const double rounding = fabs(turns[n] * TURN) * 1e-15 + 100 * (double)MCT_REAL_EPSILON;
                TEST_ASSERT_DOUBLE_WITHIN(20 * rounding, mct_plant_value(&home, i) + shift,
                                          mct_plant_value(&plant, i));
            }
        }
    }
}

/* 1e4 rad/s for 100 s, 1.6e5 turns: the angle is the rate times the time. */
static void test_a_wheel_at_1e4_rad_per_s_keeps_its_angle(void)
{
    mct_scene scene = scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, 0);
    scene.initial[0] = 0;
    scene.initial[3] = 1e4;
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 100000);
    /* compensated: what is lost is a rounding of the increment, at random, 1e5 times */
    TEST_ASSERT_DOUBLE_WITHIN(MCT_REAL_IS_FLOAT ? 1e-7 * 1e6 : 1e-9, 1e6, mct_plant_value(&plant, 1));
    TEST_ASSERT_TRUE(plant.state.x[3] == 10000 && plant.state.x[0] == 0);
    TEST_ASSERT_EQUAL_UINT64(0, plant.diverged_ticks);
}

/*
 * What a tick moves an angle by, with turns taken out and without, at this rate of the wheel. Bound: a thousandth of
 * a rounding of the angle, for compensation has twice the precision; and what double leaves to see of it.
 */
static void check_turns_taken_out(double rate)
{
    mct_scene scene = scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, 0);
    scene.initial[0] = 0;
    scene.initial[3] = rate;
    mct_plant plant;
    start_plant(&plant, &scene);
    for (int k = 0; k < 1000; k++) {
        const mct_state before = plant.state;
        mct_state bare = before;
        plant.kernel(&plant.constants, &bare, 0, 1);
        mct_plant_step(&plant, 0);
        const mct_state *const now = &plant.state;
        const double moved =
            ((double)bare.x[1] - (double)before.x[1]) + ((double)bare.c[1] - (double)before.c[1]);
        const double kept = ((double)now->x[1] - (double)before.x[1]) +
                            ((double)now->c[1] - (double)before.c[1]) +
                            (now->turns[1] - before.turns[1]) * TURN;
        const double size = fabs(rate) * 1e-3 + TURN;
        TEST_ASSERT_DOUBLE_WITHIN(1e-3 * size * (double)MCT_REAL_EPSILON + 2e-16 * size, moved, kept);
    }
}

static void test_one_or_two_turns_taken_out_of_a_tick_lose_nothing(void)
{
    check_turns_taken_out(300);
    check_turns_taken_out(-7000);
    check_turns_taken_out(9000);
}

/* Three, five or seven turns: their product with a rounded turn is not exact. */
static void test_several_turns_taken_out_of_one_tick_lose_nothing(void)
{
    check_turns_taken_out(20000);
    check_turns_taken_out(-45000);
}

/* A rate that decays by 5/s goes through all numbers there are in 150 s. */
static void test_what_has_decayed_to_next_to_nothing_is_zero(void)
{
    mct_scene scene = scene_of(CART_POLE, MCT_STEPPER_RK4, MCT_VISCOUS);
    *parameter_of(&scene, "pole_friction") = 0.5;
    for (int sign = -1; sign <= 1; sign += 2) {
        mct_plant plant;
        scene.initial[2] = sign;
        scene.initial[3] = sign;
        start_plant(&plant, &scene);
        for (int k = 0; k < 200000; k++) {
            mct_plant_step(&plant, 0);
        }
        for (int i = 2; i < 4; i++) {
            TEST_ASSERT_TRUE(plant.state.x[i] == 0 && plant.state.c[i] == 0);
        }
        TEST_ASSERT_TRUE(plant.state.x[0] * (mct_real)sign > 0);
    }
}

/* The bound itself is kept: nothing larger is touched. */
static void test_what_is_settled_is_below_the_bound_and_nothing_else(void)
{
    const mct_real nothing = MCT_REAL_NOTHING;
    TEST_ASSERT_TRUE(mct_settled(nothing) == nothing && mct_settled(-nothing) == -nothing);
    TEST_ASSERT_TRUE(mct_settled(nothing / 2) == 0 && !signbit(mct_settled(nothing / 2)));
    TEST_ASSERT_TRUE(mct_settled(-nothing / 2) == 0 && signbit(mct_settled(-nothing / 2)));
    TEST_ASSERT_TRUE(isnan(mct_settled((mct_real)NAN)));
}

static void test_upright_exactly_stays_upright_for_1e6_ticks(void)
{
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
            mct_scene scene = scene_of(
                system, stepper, mct_systems[system]->standard_effects & ~(uint32_t)MCT_MOTOR_INDUCTIVE);
            if (mct_systems[system]->kernel(stepper, scene.effects) == NULL) {
                continue;
            }
            scene.initial[mct_systems[system]->actuation->upright_coordinate] = 0;
            mct_plant plant;
            start_plant(&plant, &scene);
            step_plant(&plant, 0, TEST_CASES(stepper == MCT_STEPPER_RK4 ? 1000000 : 100000));
            for (int i = 0; i < 4; i++) {
                TEST_ASSERT_TRUE(plant.state.x[i] == 0);
            }
        }
    }
}

static void test_the_supply_bounds_the_voltage_with_saturation_and_a_motor_only(void)
{
    static const struct {
        uint32_t effects;
        bool bounded;
    } cases[] = {{MCT_MOTOR_QUASI_STATIC | MCT_SATURATION_VOLTAGE, true},
                 {MCT_MOTOR_INDUCTIVE | MCT_SATURATION_VOLTAGE, true},
                 {MCT_MOTOR_QUASI_STATIC, false},
                 {MCT_SATURATION_VOLTAGE, false}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        mct_scene scene = scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, cases[k].effects);
        *parameter_of(&scene, "supply_voltage") = 7;
        mct_plant plant;
        start_plant(&plant, &scene);
        mct_plant_step(&plant, 25);
        TEST_ASSERT_TRUE(plant.input == (cases[k].bounded ? 7 : 25));
        mct_plant_step(&plant, -25);
        TEST_ASSERT_TRUE(plant.input == (cases[k].bounded ? -7 : -25));
        mct_plant_step(&plant, 3);
        TEST_ASSERT_TRUE(plant.input == 3);
    }
}

/* The drive knows the speed at the tick's start, so the current overshoots by what the speed changes in a tick. */
static void test_the_drive_bounds_the_current_where_saturation_says_so(void)
{
    static const uint32_t motors[] = {MCT_MOTOR_QUASI_STATIC, MCT_MOTOR_INDUCTIVE};
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        for (int k = 0; k < 2; k++) {
            mct_scene scene = scene_of(system, MCT_STEPPER_LEAP, MCT_VISCOUS | MCT_SATURATION | motors[k]);
            *parameter_of(&scene, "supply_voltage") = 24;
            const double limit = *parameter_of(&scene, "current_limit");
            mct_plant plant;
            start_plant(&plant, &scene);
            double largest = 0;
            for (int tick = 0; tick < 200; tick++) {
                mct_evaluation now;
                mct_plant_step(&plant, tick < 100 ? 24 : -24);
                mct_plant_evaluate(&plant, &now);
                largest = fmax(largest, fabs((double)now.current));
            }
            TEST_ASSERT_TRUE(largest > 0.9 * limit && largest <= limit * (1 + 1e-6));
            mct_scene voltage_alone = scene;
            voltage_alone.effects &= ~(uint32_t)MCT_SATURATION_CURRENT;
            start_plant(&plant, &voltage_alone);
            mct_plant_step(&plant, 24);
            TEST_ASSERT_TRUE(plant.input == 24);
        }
    }
}

static void test_a_current_within_its_bound_is_left_alone_bit_for_bit(void)
{
    mct_scene bounded = scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, MCT_MOTOR_INDUCTIVE | MCT_SATURATION);
    mct_scene free = bounded;
    free.effects = MCT_MOTOR_INDUCTIVE;
    mct_plant a, b;
    start_plant(&a, &bounded);
    start_plant(&b, &free);
    for (int tick = 0; tick < 1000; tick++) {
        mct_plant_step(&a, MCT_R(0.25) * (mct_real)(tick % 7));
        mct_plant_step(&b, MCT_R(0.25) * (mct_real)(tick % 7));
    }
    TEST_ASSERT_EQUAL_MEMORY(a.state.x, b.state.x, sizeof a.state.x);
}

static void test_a_stepper_that_does_not_suit_is_refused_with_a_sentence(void)
{
    const mct_scene scene = scene_of(CART_POLE, MCT_STEPPER_EXPO, MCT_GRAVITY);
    mct_plant plant;
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_plant_init(&plant, &scene, &why));
    TEST_ASSERT_NOT_NULL(strstr(why.text, "expo"));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_plant_init(&plant, &scene, NULL));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_input_that_is_not_finite_is_refused_counted_and_the_last_one_held);
    RUN_TEST(test_a_bad_first_input_leaves_the_plant_at_zero_volts);
    RUN_TEST(test_a_result_that_has_blown_up_is_refused_and_the_state_kept);
    RUN_TEST(test_taking_turns_out_changes_neither_value_nor_motion);
    RUN_TEST(test_a_start_that_is_whole_turns_away_moves_the_same_way);
    RUN_TEST(test_a_wheel_at_1e4_rad_per_s_keeps_its_angle);
    RUN_TEST(test_one_or_two_turns_taken_out_of_a_tick_lose_nothing);
    RUN_TEST(test_several_turns_taken_out_of_one_tick_lose_nothing);
    RUN_TEST(test_what_has_decayed_to_next_to_nothing_is_zero);
    RUN_TEST(test_what_is_settled_is_below_the_bound_and_nothing_else);
    RUN_TEST(test_upright_exactly_stays_upright_for_1e6_ticks);
    RUN_TEST(test_the_supply_bounds_the_voltage_with_saturation_and_a_motor_only);
    RUN_TEST(test_the_drive_bounds_the_current_where_saturation_says_so);
    RUN_TEST(test_a_current_within_its_bound_is_left_alone_bit_for_bit);
    RUN_TEST(test_a_stepper_that_does_not_suit_is_refused_with_a_sentence);
    return UNITY_END();
}

/* The open-loop input: what it is at each tick. */
#include "mctau/input.h"

#include <math.h>

#include "unity.h"

static mct_scene scene;
static mct_input input;

void setUp(void)
{
    mct_scene_defaults(&scene, 0);
    scene.dt = 1e-3;
}

void tearDown(void)
{
}

static double at(uint64_t tick)
{
    return (double)mct_input_at(&input, tick);
}

static void start(int kind, mct_samples samples)
{
    scene.input = kind;
    mct_input_init(&input, &scene, samples);
}

static void test_without_a_kind_there_is_none(void)
{
    scene.input_value = 3;
    start(MCT_INPUT_NONE, (mct_samples){NULL, 0});
    TEST_ASSERT_EQUAL_DOUBLE(0, at(0));
    TEST_ASSERT_EQUAL_DOUBLE(0, at(1000));
}

static void test_a_constant_is_the_same_at_every_tick(void)
{
    scene.input_value = -1.5;
    start(MCT_INPUT_CONSTANT, (mct_samples){NULL, 0});
    TEST_ASSERT_EQUAL_DOUBLE(-1.5, at(0));
    TEST_ASSERT_EQUAL_DOUBLE(-1.5, at(UINT64_MAX));
}

/* Tolerance: a rounding of sine and product each. The frequency is in rad/s. */
static void test_a_sine_begins_upwards_at_its_middle(void)
{
    scene.input_value = 2;
    scene.input_amplitude = 3;
    scene.input_frequency = 250;
    start(MCT_INPUT_SINE, (mct_samples){NULL, 0});
    for (uint64_t tick = 0; tick < 100; tick++) {
        const double expected = 2 + 3 * sin(0.25 * (double)tick);
        TEST_ASSERT_DOUBLE_WITHIN(10 * (double)MCT_REAL_EPSILON, expected, at(tick));
    }
}

static void test_a_step_comes_with_the_first_tick_that_is_not_before_it(void)
{
    static const double times[] = {0.002, 0.0035, 0.005};
    static const mct_real values[] = {1, 2, 3};
    static const double expected[] = {0, 0, 1, 1, 2, 3, 3};
    scene.input_times.count = scene.input_values.count = 3;
    for (int i = 0; i < 3; i++) {
        scene.input_times.values[i] = times[i];
        scene.input_values.values[i] = values[i];
    }
    start(MCT_INPUT_STEPS, (mct_samples){NULL, 0});
    for (uint64_t tick = 0; tick < 7; tick++) {
        TEST_ASSERT_EQUAL_DOUBLE(expected[tick], at(tick));
    }
}

/* 0.003 / 0.001 is a rounding below 3, 0.007 / 0.001 above 7. */
static void test_a_time_that_is_a_tick_but_for_rounding_is_that_tick(void)
{
    for (int tick = 1; tick < 1000; tick++) {
        scene.input_times.count = scene.input_values.count = 1;
        scene.input_times.values[0] = tick / 1000.0;
        scene.input_values.values[0] = 1;
        start(MCT_INPUT_STEPS, (mct_samples){NULL, 0});
        TEST_ASSERT_EQUAL_DOUBLE(0, at((uint64_t)tick - 1));
        TEST_ASSERT_EQUAL_DOUBLE(1, at((uint64_t)tick));
    }
}

static void test_samples_are_one_a_tick_and_the_last_is_held(void)
{
    static const mct_real values[] = {1, -2, 3, 99}; /* the last one is not among the three that are given */
    start(MCT_INPUT_CSV, (mct_samples){values, 3});
    TEST_ASSERT_EQUAL_DOUBLE(1, at(0));
    TEST_ASSERT_EQUAL_DOUBLE(-2, at(1));
    TEST_ASSERT_EQUAL_DOUBLE(3, at(2));
    TEST_ASSERT_EQUAL_DOUBLE(3, at(3));
    TEST_ASSERT_EQUAL_DOUBLE(3, at(1000000));
    start(MCT_INPUT_CSV, (mct_samples){NULL, 0});
    TEST_ASSERT_EQUAL_DOUBLE(0, at(0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_without_a_kind_there_is_none);
    RUN_TEST(test_a_constant_is_the_same_at_every_tick);
    RUN_TEST(test_a_sine_begins_upwards_at_its_middle);
    RUN_TEST(test_a_step_comes_with_the_first_tick_that_is_not_before_it);
    RUN_TEST(test_a_time_that_is_a_tick_but_for_rounding_is_that_tick);
    RUN_TEST(test_samples_are_one_a_tick_and_the_last_is_held);
    return UNITY_END();
}

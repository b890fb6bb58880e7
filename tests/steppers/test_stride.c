/* Long steps with the ticks read off their series: scene.stride. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scenes.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* Roundings of some hundred steps, on states of the size of 10. */
#define ROUNDING (MCT_REAL_IS_FLOAT ? 3e-5 : 2e-13)

enum { STRIDE = 20, TICKS = 5000 };

static mct_scene smooth_scene(int system, int stride)
{
    const uint32_t smooth = MCT_GRAVITY | MCT_VISCOUS;
    mct_scene scene = scene_of(system, MCT_STEPPER_TAYLOR12, mct_systems[system]->effects & smooth);
    scene.stride = stride;
    return scene;
}

static double distance(const mct_plant *a, const mct_plant *b)
{
    double worst = 0;
    for (int i = 0; i < a->states; i++) {
        const double value = mct_plant_value(b, i);
        worst = fmax(worst, fabs(mct_plant_value(a, i) - value) / fmax(1, fabs(value)));
    }
    return worst;
}

/* Largest distance of the ticks of a stride from those that are stepped one by one, under what `input` gives a tick. */
static double worst_tick(int system, mct_real (*input)(int tick))
{
    const mct_scene scene = smooth_scene(system, STRIDE), stepped_scene = smooth_scene(system, 1);
    mct_plant plant, stepped;
    double worst = 0;
    start_plant(&plant, &scene);
    start_plant(&stepped, &stepped_scene);
    for (int tick = 0; tick < TICKS; tick++) {
        mct_plant_step(&plant, input(tick));
        mct_plant_step(&stepped, input(tick));
        worst = fmax(worst, distance(&plant, &stepped));
    }
    TEST_ASSERT_EQUAL_UINT64(0, plant.diverged_ticks);
    return worst;
}

static mct_real none(int tick)
{
    (void)tick;
    return 0;
}

/* Changes at ticks that are no ends of strides, and twice running. */
static mct_real jumps(int tick)
{
    return tick % 7 == 3 || tick % 7 == 4 ? MCT_R(0.001) * (mct_real)(tick % 11) : 0;
}

static void check_all_systems(const char *what, mct_real (*input)(int tick))
{
    int systems = 0;
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        if (mct_systems[system]->motion != NULL) {
            const double worst = worst_tick(system, input);
            printf("%s, %s: %.1e\n", mct_systems[system]->name, what, worst);
            TEST_ASSERT_TRUE(worst < ROUNDING);
            systems++;
        }
    }
    TEST_ASSERT_TRUE(systems >= 5);
}

static void test_a_tick_within_a_stride_lies_on_the_motion(void)
{
    check_all_systems("free", none);
}

static void test_an_input_that_changes_begins_a_new_stride_at_once(void)
{
    check_all_systems("under jumps", jumps);
}

static void test_a_motor_may_pull_over_a_stride(void)
{
    static const uint32_t motors[] = {MCT_MOTOR_QUASI_STATIC, MCT_MOTOR_INDUCTIVE};
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        for (int motor = 0; motor < 2; motor++) {
            mct_scene scene =
                scene_of(system, MCT_STEPPER_TAYLOR12, MCT_GRAVITY | MCT_VISCOUS | motors[motor]);
            *parameter_of(&scene, "inductance") =
                0.05 * *parameter_of(&scene, "resistance"); /* slow: 50 ms */
            mct_scene strided = scene;
            strided.stride = 8;
            mct_plant plant, stepped;
            start_plant(&stepped, &scene);
            start_plant(&plant, &strided);
            for (int tick = 0; tick < 2000; tick++) {
                mct_plant_step(&plant, tick < 1000 ? 3 : -3);
                mct_plant_step(&stepped, tick < 1000 ? 3 : -3);
                TEST_ASSERT_TRUE(distance(&plant, &stepped) < ROUNDING);
            }
        }
    }
}

static void test_turns_are_counted_once_within_a_stride(void)
{
    const int pendulum = 2;
    TEST_ASSERT_EQUAL_STRING("pendulum", mct_systems[pendulum]->name);
    mct_scene scene = smooth_scene(pendulum, STRIDE);
    scene.effects = 0;
    scene.initial[0] = 0;
    scene.initial[1] = 100; /* two turns in 126 ms */
    mct_plant plant;
    start_plant(&plant, &scene);
    for (int tick = 1; tick <= 1000; tick++) {
        mct_plant_step(&plant, 0);
        TEST_ASSERT_TRUE(fabs(mct_plant_value(&plant, 0) - 0.1 * tick) < 100 * ROUNDING);
    }
    TEST_ASSERT_EQUAL_INT(15, plant.state.turns[0]);
}

static void test_a_stride_that_diverges_keeps_the_state_and_goes_on(void)
{
    mct_scene scene = smooth_scene(CART_POLE, STRIDE);
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 5);
    const mct_state before = plant.state;
    mct_plant_step(&plant, MCT_R(1e30));
    TEST_ASSERT_EQUAL_UINT64(1, plant.diverged_ticks);
    TEST_ASSERT_EQUAL_MEMORY(before.x, plant.state.x, sizeof(mct_real) * (size_t)plant.states);
    step_plant(&plant, 0, 5);
    TEST_ASSERT_EQUAL_UINT64(1, plant.diverged_ticks);
}

static void refuse(mct_scene scene, const char *sentence)
{
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_scene_check(&scene, &why));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, sentence), why.text);
}

static void test_a_stride_without_a_series_is_refused_with_what_is_allowed(void)
{
    mct_scene scene = smooth_scene(CART_POLE, STRIDE);
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_scene_check(&scene, &why), why.text);
    scene.substeps = 2;
    refuse(scene, "scene.stride: found 20 beside scene.substeps = 2; allowed either above 1");
    scene.substeps = 1;
    scene.stepper = MCT_STEPPER_RK4;
    refuse(scene,
           "scene.stride: found 20 with stepper rk4, which has no series to read ticks off; allowed 1, or "
           "stepper taylor12");
    scene.stride = 0;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_scene_check(&scene, &why));
    int bodies = 0;
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        scene = smooth_scene(system, STRIDE);
        if (mct_systems[system]->motion == NULL &&
            mct_systems[system]->kernel(MCT_STEPPER_TAYLOR12, scene.effects) != NULL) {
            refuse(scene, "has no series to hand; allowed 1");
            bodies++;
        }
    }
    TEST_ASSERT_TRUE(bodies > 0);
}

static void test_a_stride_too_long_for_the_motor_is_told_in_ticks(void)
{
    mct_scene scene = scene_of(REACTION_WHEEL, MCT_STEPPER_TAYLOR12, MCT_GRAVITY | MCT_MOTOR_INDUCTIVE);
    *parameter_of(&scene, "inductance") = 0.001 * *parameter_of(&scene, "resistance");
    scene.stride = STRIDE;
    refuse(scene, "or a scene.stride below 6"); /* h R/L up to 5.822 */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_tick_within_a_stride_lies_on_the_motion);
    RUN_TEST(test_an_input_that_changes_begins_a_new_stride_at_once);
    RUN_TEST(test_a_motor_may_pull_over_a_stride);
    RUN_TEST(test_turns_are_counted_once_within_a_stride);
    RUN_TEST(test_a_stride_that_diverges_keeps_the_state_and_goes_on);
    RUN_TEST(test_a_stride_without_a_series_is_refused_with_what_is_allowed);
    RUN_TEST(test_a_stride_too_long_for_the_motor_is_told_in_ticks);
    return UNITY_END();
}

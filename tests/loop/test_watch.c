/* Energy that cannot be is found long before a state leaves all bounds; what an input brings in is none. */
#include <math.h>
#include <stdio.h>

#include "mctau/watch.h"
#include "support/scenes.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static mct_plant plant;
static mct_watch watch;

/* Ticks until the watch finds energy from nowhere; 0 when it does not. The input swings once a second. */
static long ticks_until_alarm(const mct_scene *scene, double amplitude, long ticks)
{
    start_plant(&plant, scene);
    mct_watch_start(&watch, &plant, scene);
    for (long tick = 1; tick <= ticks; tick++) {
        mct_plant_step(&plant, (mct_real)(amplitude * sin(6.28 * scene->dt * (double)tick)));
        if (!mct_watch_tick(&watch, &plant)) {
            return tick;
        }
    }
    return 0;
}

static void test_an_anti_damped_scheme_is_found_out_while_its_state_is_ordinary(void)
{
    mct_scene scene = scene_of(system_called("pendulum"), MCT_STEPPER_SEED, MCT_GRAVITY);
    *parameter_of(&scene, "length") = 0.02; /* 22 rad/s: its energy grows by a quarter each second */
    scene.initial[0] = 3.141592653589793 - 0.5;
    const long tick = ticks_until_alarm(&scene, 0, 20000);
    TEST_ASSERT_TRUE(tick > 0 && tick % MCT_WATCH_TICKS == 0);
    TEST_ASSERT_EQUAL_UINT64(1, watch.impossible);
    TEST_ASSERT_TRUE(fabs(mct_plant_value(&plant, 1)) < 1e3);
    scene.stepper = MCT_STEPPER_RK4;
    TEST_ASSERT_EQUAL_INT(0, ticks_until_alarm(&scene, 0, 20000));
}

/* Each alarm would be a false one: the work of the input is all that comes in. */
static void test_the_work_of_an_input_is_no_energy_from_nowhere(void)
{
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        const mct_system *model = mct_systems[system];
        static const uint32_t motors[] = {0, MCT_MOTOR_QUASI_STATIC, MCT_MOTOR_INDUCTIVE};
        for (int i = 0; i < (model->actuation != NULL ? 3 : 1); i++) {
            mct_scene scene;
            mct_scene_defaults(&scene, system);
            scene.effects = (scene.effects & ~(uint32_t)MCT_MOTOR & ~(uint32_t)MCT_SATURATION) | motors[i];
            scene.stepper = i == 2 ? MCT_STEPPER_LEAP : scene.stepper; /* which any L/R suits */
            TEST_ASSERT_EQUAL_INT_MESSAGE(0, ticks_until_alarm(&scene, i == 0 ? 1 : 8, 10240), model->name);
            const bool works_alone = (model->effects & (MCT_FORCES | MCT_CLOCK | MCT_CENTRIFUGAL)) == 0;
            TEST_ASSERT_EQUAL_INT_MESSAGE(works_alone && !model->is_process, watch.is_watched, model->name);
        }
    }
}

/* Energy put in behind its back is half of what then moves, and more. */
static void test_energy_that_the_input_did_not_bring_is_found_at_the_next_look(void)
{
    static const uint32_t motors[] = {0, MCT_MOTOR_QUASI_STATIC, MCT_MOTOR_INDUCTIVE};
    for (int i = 0; i < 3; i++) {
        mct_scene scene = scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, MCT_GRAVITY | motors[i]);
        TEST_ASSERT_EQUAL_INT(0, ticks_until_alarm(&scene, 1, MCT_WATCH_TICKS + 10));
        plant.state.x[2] += 50;
        for (long tick = MCT_WATCH_TICKS + 11; tick < 2 * MCT_WATCH_TICKS; tick++) {
            mct_plant_step(&plant, 0);
            TEST_ASSERT_TRUE(mct_watch_tick(&watch, &plant));
        }
        mct_plant_step(&plant, 0);
        TEST_ASSERT_FALSE(mct_watch_tick(&watch, &plant));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_anti_damped_scheme_is_found_out_while_its_state_is_ordinary);
    RUN_TEST(test_the_work_of_an_input_is_no_energy_from_nowhere);
    RUN_TEST(test_energy_that_the_input_did_not_bring_is_found_at_the_next_look);
    return UNITY_END();
}

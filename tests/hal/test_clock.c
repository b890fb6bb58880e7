/* The clock when the system cannot sleep: clock_nanosleep stands here for the C library's. */
#define _GNU_SOURCE
#include <errno.h>
#include <time.h>

#include "hal/clock.h"
#include "hal/sim/sim.h"
#include "mctau/loop.h"
#include "support/scenes.h"
#include "support/swing_up.h"
#include "unity.h"

static int answer;   /* of the next calls */
static long calls;   /* since setUp */
static long answers; /* calls that are answered so; the rest go well */

int clock_nanosleep(clockid_t clock, int flags, const struct timespec *until, struct timespec *left)
{
    (void)clock;
    (void)flags;
    (void)until;
    (void)left;
    return calls++ < answers ? answer : 0;
}

void setUp(void)
{
    calls = 0;
    answers = 0;
}

void tearDown(void)
{
}

static void test_a_sleep_that_a_signal_ends_goes_on(void)
{
    mct_clock clock;
    mct_clock_start(&clock, 0.001);
    answer = EINTR;
    answers = 5;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_clock_wait(&clock));
    TEST_ASSERT_EQUAL_INT(6, (int)calls);
}

static void test_a_sleep_that_fails_is_said(void)
{
    static const int numbers[] = {EINVAL, EIO, EINTR};
    mct_clock clock;
    mct_clock_start(&clock, 0.001);
    answers = 1000000;
    for (int i = 0; i < 3; i++) {
        answer = numbers[i];
        TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, mct_clock_wait(&clock));
    }
}

static void test_a_loop_that_cannot_keep_its_time_has_zero_volts(void)
{
    static mct_loop loop;
    static mct_plan plan;
    static mct_sim sim;
    mct_clock clock;
    mct_scene scene = swing_up_scene(1);
    scene.realtime = 1;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_sim_init(&sim, &scene, NULL));
    sim.clock = &clock;
    const mct_hal hal = mct_sim_hal(&sim);
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          mct_loop_init(&loop, &plan, &scene, hal, NULL, (mct_samples){NULL, 0}, NULL));
    hal.ops->open(hal.context, NULL);
    mct_loop_tick(&loop);
    TEST_ASSERT_TRUE(loop.record.applied != 0);
    answer = EIO;
    answers = 1000000;
    mct_loop_tick(&loop);
    mct_loop_tick(&loop);
    TEST_ASSERT_TRUE(loop.record.applied == 0);
    TEST_ASSERT_BITS_HIGH(1u << MCT_FAULT_HAL, loop.record.faults);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_sleep_that_a_signal_ends_goes_on);
    RUN_TEST(test_a_sleep_that_fails_is_said);
    RUN_TEST(test_a_loop_that_cannot_keep_its_time_has_zero_volts);
    return UNITY_END();
}

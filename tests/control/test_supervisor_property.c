/* The gate in front of the motor: every fault by its name, limits, and zero whenever there is doubt. */
#include <math.h>
#include <string.h>

#include "hal/sim/sim.h"
#include "mctau/loop.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/swing_up.h"
#include "unity.h"

static mct_supervisor gate;
static mct_reading reading;
static mct_real estimate[2 * MCT_MAX_ENCODERS];

static void start(int system)
{
    const mct_scene scene = swing_up_scene(system);
    mct_supervisor_init(&gate, &scene);
    memset(&reading, 0, sizeof reading);
    memset(estimate, 0, sizeof estimate);
}

void setUp(void)
{
    start(REACTION_WHEEL);
}

void tearDown(void)
{
}

static mct_real pass(double wanted)
{
    reading.counts[0]++; /* alive */
    reading.counts[1]++;
    return mct_supervisor_pass(&gate, &reading, estimate, (mct_real)wanted);
}

/* The fault is latched, and stays; cleared, the motor runs again from the next valid reading on. */
static void check_latched(mct_fault fault, const char *name)
{
    TEST_ASSERT_EQUAL_STRING(name, mct_fault_name(fault));
    TEST_ASSERT_TRUE(strlen(mct_fault_text(fault)) > 10);
    TEST_ASSERT_EQUAL_UINT32(1u << fault, gate.latched);
    TEST_ASSERT_TRUE(gate.counts[fault] >= 1);
    TEST_ASSERT_FALSE(gate.armed);
    memset(estimate, 0, sizeof estimate);
    reading.flags = 0;
    reading.age_us = 0;
    for (int k = 0; k < 20; k++) {
        TEST_ASSERT_TRUE(pass(5) == 0);
        TEST_ASSERT_EQUAL_UINT32(1u << fault, gate.latched);
    }
    mct_supervisor_rearm(&gate);
    reading.flags = MCT_READING_MISSING;
    TEST_ASSERT_TRUE(pass(5) == 0);
    reading.flags = 0;
    TEST_ASSERT_TRUE(pass(5) == 5);
    TEST_ASSERT_TRUE(gate.armed);
}

static void test_a_healthy_gate_lets_through_what_is_wanted_up_to_the_supply(void)
{
    TEST_ASSERT_TRUE(pass(3) == 3);
    TEST_ASSERT_TRUE(pass(-10) == -10);
    TEST_ASSERT_EQUAL_UINT64(0, gate.limited_ticks);
    TEST_ASSERT_TRUE(pass(10.5) == 10 && pass(-1e30) == -10);
    TEST_ASSERT_EQUAL_UINT64(2, gate.limited_ticks);
    TEST_ASSERT_EQUAL_UINT32(0, gate.latched);
}

static void test_the_motor_is_not_driven_before_the_first_valid_reading(void)
{
    reading.flags = MCT_READING_MISSING;
    for (int k = 0; k < 5; k++) {
        TEST_ASSERT_TRUE(pass(5) == 0 && !gate.armed);
    }
    reading.flags = 0;
    TEST_ASSERT_TRUE(pass(5) == 5 && gate.armed);
}

static void test_a_sensor_value_that_is_not_finite_latches_sensor_invalid(void)
{
    pass(5);
    reading.flags = MCT_READING_INVALID;
    TEST_ASSERT_TRUE(pass(5) == 0);
    check_latched(MCT_FAULT_SENSOR_INVALID, "sensor_invalid");
}

static void test_feedback_is_derated_from_3_ms_and_zero_and_latched_from_5_ms(void)
{
    pass(8);
    static const struct {
        uint32_t age;
        double factor;
    } ages[] = {{0, 1}, {2999, 1}, {3000, 1}, {3500, 0.75}, {4000, 0.5}, {4999, 0.0005}};
    for (size_t k = 0; k < sizeof ages / sizeof ages[0]; k++) {
        reading.age_us = ages[k].age;
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 8 * ages[k].factor, (double)pass(8));
        TEST_ASSERT_EQUAL_UINT32(0, gate.latched);
    }
    TEST_ASSERT_EQUAL_UINT64(3, gate.derated_ticks);
    reading.age_us = 4000;
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 5, (double)pass(1000)); /* limited first */
    reading.age_us = 5000;
    TEST_ASSERT_TRUE(pass(8) == 0);
    check_latched(MCT_FAULT_SENSOR_STALE, "sensor_stale");
}

static void test_what_passes_is_whole_millivolts_within_the_limit(void)
{
    for (int k = -11000; k <= 11000; k++) {
        const double wanted = k * 1.00037e-3;
        const mct_real passed = pass(wanted);
        const int32_t steps = (int32_t)(passed * 1000 + (passed < 0 ? MCT_R(-0.5) : MCT_R(0.5)));
        TEST_ASSERT_TRUE(passed == (mct_real)steps / 1000);
        TEST_ASSERT_TRUE(passed <= 10 && passed >= -10);
        if (wanted < 10 && wanted > -10) {
            TEST_ASSERT_DOUBLE_WITHIN(0.000501, wanted, (double)passed);
        }
    }
}

static void test_what_a_drive_reports_latches_its_fault(void)
{
    static const struct {
        uint32_t flag;
        mct_fault fault;
        const char *name;
    } cases[] = {
        {MCT_READING_LINK_DOWN, MCT_FAULT_LINK_DOWN, "link_down"},
        {MCT_READING_DRIVE_FAULT, MCT_FAULT_DRIVE, "drive_fault"},
        {MCT_READING_NOT_READY, MCT_FAULT_NOT_READY, "drive_not_ready"},
        {MCT_READING_RESTARTED, MCT_FAULT_RESTARTED, "drive_restarted"},
        {MCT_READING_ESTOP, MCT_FAULT_ESTOP, "estop"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        pass(5);
        TEST_ASSERT_TRUE(gate.armed);
        reading.flags = cases[i].flag;
        TEST_ASSERT_TRUE(pass(5) == 0);
        check_latched(cases[i].fault, cases[i].name);
    }
}

static void test_a_drive_that_is_not_ready_yet_is_waited_for_without_a_fault(void)
{
    reading.flags = MCT_READING_NOT_READY;
    for (int k = 0; k < 1000; k++) {
        TEST_ASSERT_TRUE(pass(5) == 0);
    }
    TEST_ASSERT_EQUAL_UINT32(0, gate.latched);
    reading.flags = 0;
    TEST_ASSERT_TRUE(pass(5) == 5);
}

static void test_good_feedback_asks_for_rearming_after_the_time_that_the_scene_gives(void)
{
    gate.rearm_limit = 50;
    pass(5);
    reading.flags = MCT_READING_MISSING;
    reading.age_us = 6000;
    pass(5);
    reading.flags = MCT_READING_NOT_READY; /* it was stopped: this lasts until it is armed */
    reading.age_us = 0;
    for (int k = 0; k < 49; k++) {
        pass(5);
        TEST_ASSERT_FALSE(mct_supervisor_wants_rearm(&gate));
    }
    reading.flags = MCT_READING_LINK_DOWN; /* not good: from the beginning again */
    pass(5);
    reading.flags = MCT_READING_NOT_READY;
    for (int k = 0; k < 50; k++) {
        TEST_ASSERT_FALSE(mct_supervisor_wants_rearm(&gate));
        pass(5);
    }
    TEST_ASSERT_TRUE(mct_supervisor_wants_rearm(&gate));
    mct_supervisor_rearm(&gate);
    TEST_ASSERT_FALSE(mct_supervisor_wants_rearm(&gate));
    TEST_ASSERT_EQUAL_UINT64(1, gate.rearmed);
}

static void test_a_driven_encoder_that_stands_still_latches_sensor_frozen(void)
{
    int ticks = 0;
    for (; gate.latched == 0 && ticks < 1000; ticks++) {
        mct_supervisor_pass(&gate, &reading, estimate, 6);
    }
    TEST_ASSERT_TRUE(ticks > 200 && ticks < 300);
    check_latched(MCT_FAULT_SENSOR_FROZEN, "sensor_frozen");
}

static void test_an_encoder_may_stand_still_under_little_voltage(void)
{
    for (int k = 0; k < 5000; k++) {
        mct_supervisor_pass(&gate, &reading, estimate, 4);
    }
    TEST_ASSERT_EQUAL_UINT32(0, gate.latched);
}

static void test_an_estimate_that_is_not_finite_latches_its_fault(void)
{
    for (int i = 0; i < 4; i++) {
        start(REACTION_WHEEL);
        pass(5);
        estimate[i] = (mct_real)NAN;
        TEST_ASSERT_TRUE(pass(5) == 0);
        check_latched(MCT_FAULT_ESTIMATE, "estimate_not_finite");
    }
}

static void test_a_wanted_voltage_that_is_not_finite_latches_its_fault(void)
{
    static const double wanted[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        start(REACTION_WHEEL);
        pass(5);
        TEST_ASSERT_TRUE(pass(wanted[k]) == 0);
        check_latched(MCT_FAULT_COMMAND, "command_not_finite");
    }
}

static void test_a_cart_that_leaves_its_track_latches_track_end(void)
{
    start(CART_POLE);
    estimate[0] = MCT_R(0.399);
    TEST_ASSERT_TRUE(pass(5) == 5);
    estimate[0] = MCT_R(-0.401);
    TEST_ASSERT_TRUE(pass(5) == 0);
    check_latched(MCT_FAULT_TRACK_END, "track_end");
}

static void test_a_wheel_beyond_its_speed_latches_overspeed(void)
{
    estimate[3] = 1999;
    TEST_ASSERT_TRUE(pass(5) == 5);
    estimate[3] = -2001;
    TEST_ASSERT_TRUE(pass(5) == 0);
    check_latched(MCT_FAULT_OVERSPEED, "overspeed");
}

/* By default after 120 s; balance pays for as much restlessness later. */
static void test_driving_without_balance_for_too_long_latches_no_balance(void)
{
    static const struct {
        int balance, restless; /* ticks, in turn */
        int least, most;       /* until the fault; 0: never */
    } cases[] = {{0, 1, 120001, 120003}, {1, 3, 239990, 240010}, {1, 1, 0, 0}, {3, 1, 0, 0}};
    for (int i = 0; i < 4; i++) {
        int ticks = 0;
        start(REACTION_WHEEL);
        for (; gate.latched == 0 && ticks < 500000; ticks++) {
            const int phase = ticks % (cases[i].balance + cases[i].restless);
            mct_supervisor_watch_balance(&gate, phase < cases[i].balance);
            pass(5);
        }
        if (cases[i].most == 0) {
            TEST_ASSERT_EQUAL_UINT32(0, gate.latched);
        } else {
            TEST_ASSERT_TRUE(ticks >= cases[i].least && ticks <= cases[i].most);
            check_latched(MCT_FAULT_NO_BALANCE, "no_balance");
            mct_supervisor_watch_balance(&gate, false);
            TEST_ASSERT_EQUAL_UINT32(0, gate.latched); /* it has all its time again */
        }
    }
}

static void test_what_is_not_driven_may_wait_for_balance_for_ever(void)
{
    for (int ticks = 0; ticks < 300000; ticks++) {
        reading.flags = MCT_READING_NOT_READY;
        mct_supervisor_watch_balance(&gate, false);
        TEST_ASSERT_TRUE(pass(5) == 0);
    }
    TEST_ASSERT_EQUAL_UINT32(0, gate.latched);
}

static void test_without_a_time_to_give_up_it_never_does(void)
{
    mct_scene scene = swing_up_scene(REACTION_WHEEL);
    scene.give_up_after = 0;
    mct_supervisor_init(&gate, &scene);
    for (int ticks = 0; ticks < 300000; ticks++) {
        mct_supervisor_watch_balance(&gate, false);
        pass(5);
    }
    TEST_ASSERT_EQUAL_UINT32(0, gate.latched);
}

static void test_faults_from_outside_are_latched_under_their_names(void)
{
    pass(5);
    mct_supervisor_fault(&gate, MCT_FAULT_HAL);
    TEST_ASSERT_TRUE(pass(5) == 0);
    check_latched(MCT_FAULT_HAL, "hal_error");
    mct_supervisor_fault(&gate, MCT_FAULT_STOPPED);
    TEST_ASSERT_TRUE(pass(5) == 0);
    check_latched(MCT_FAULT_STOPPED, "stopped");
}

static void test_a_cause_that_persists_latches_again(void)
{
    reading.flags = MCT_READING_INVALID;
    pass(5);
    mct_supervisor_rearm(&gate);
    TEST_ASSERT_TRUE(pass(5) == 0);
    TEST_ASSERT_EQUAL_UINT32(1u << MCT_FAULT_SENSOR_INVALID, gate.latched);
    TEST_ASSERT_EQUAL_UINT64(2, gate.counts[MCT_FAULT_SENSOR_INVALID]);
}

static double anything(test_random *random)
{
    switch (random_bits(random) % 12) {
    case 0:
        return NAN;
    case 1:
        return INFINITY;
    case 2:
        return -INFINITY;
    case 3:
        return 1e38;
    case 4:
        return -1e-38;
    default:
        return random_in(random, -15, 15);
    }
}

static void test_whatever_comes_in_what_goes_out_is_finite_within_the_limit_and_zero_in_doubt(void)
{
    test_random random = {3};
    long driven = 0;
    for (int k = 0; k < TEST_CASES(1000000); k++) {
        if (k % 50 == 0) {
            start((k / 50) % 2);
        }
        if (random_bits(&random) % 10 == 0) {
            mct_supervisor_rearm(&gate);
        }
        const bool calm = random_bits(&random) % 4 != 0;
        reading.counts[0] = (int32_t)random_bits(&random);
        reading.counts[1] = (int32_t)(random_bits(&random) % 3);
        reading.age_us = (uint32_t)(random_bits(&random) % (calm ? 3000 : 7000));
        reading.flags = calm ? 0 : (uint32_t)random_bits(&random) & 3;
        for (int i = 0; i < 4; i++) {
            estimate[i] = (mct_real)(calm ? random_in(&random, -0.3, 0.3) : anything(&random));
        }
        const mct_real wanted = (mct_real)(calm ? random_in(&random, -20, 20) : anything(&random));
        const mct_real out = mct_supervisor_pass(&gate, &reading, k % 3 ? estimate : NULL, wanted);
        TEST_ASSERT_TRUE(out >= -10 && out <= 10); /* NaN fails this, too */
        TEST_ASSERT_TRUE(out == 0 || (gate.latched == 0 && gate.armed && reading.age_us < 5000 &&
                                      !(reading.flags & MCT_READING_INVALID) && (out > 0) == (wanted > 0)));
        driven += out != 0;
    }
    TEST_ASSERT_TRUE(driven > TEST_CASES(100000));
}

/* ---- in the loop ---- */

static mct_loop loop;
static mct_plan plan;
static mct_sim sim;

static void start_loop(const mct_scene *scene)
{
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_sim_init(&sim, scene, &why), why.text);
    const mct_hal hal = mct_sim_hal(&sim);
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        MCT_OK, mct_loop_init(&loop, &plan, scene, hal, NULL, (mct_samples){NULL, 0}, &why), why.text);
    TEST_ASSERT_EQUAL_INT(MCT_OK, hal.ops->open(hal.context, NULL));
}

static void test_silent_sensors_end_at_zero_volts_within_6_ticks_and_it_stays_so(void)
{
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        for (int latency = 0; latency < 3; latency++) {
            mct_scene scene = swing_up_scene(system);
            scene.latency = latency;
            scene.sensor_fault = MCT_SENSOR_FAULT_SILENT;
            scene.sensor_fault_time = 0.6;
            scene.sensor_fault_duration = 0.5;
            start_loop(&scene);
            int last_valid = 0;
            for (int k = 0; k < 2000; k++) {
                mct_loop_tick(&loop);
                last_valid = k < 600 && loop.record.reading.flags == 0 ? k : last_valid;
                TEST_ASSERT_TRUE(k < last_valid + 6 || k < 600 || loop.record.applied == 0);
                TEST_ASSERT_TRUE(k != 599 || loop.record.applied != 0);
            }
            TEST_ASSERT_EQUAL_INT(599, last_valid);
            TEST_ASSERT_EQUAL_UINT32(1u << MCT_FAULT_SENSOR_STALE, loop.record.faults);
        }
    }
}

static void test_a_nan_from_a_sensor_is_zero_volts_in_the_same_tick(void)
{
    mct_scene scene = swing_up_scene(CART_POLE);
    scene.sensor_fault = MCT_SENSOR_FAULT_NAN;
    scene.sensor_fault_time = 0.6;
    scene.sensor_fault_duration = 0.001;
    start_loop(&scene);
    for (int k = 0; k < 1000; k++) {
        mct_loop_tick(&loop);
        TEST_ASSERT_TRUE(k < 600 || (loop.record.applied == 0 && sim.plant.input == 0));
    }
    TEST_ASSERT_EQUAL_UINT32(1u << MCT_FAULT_SENSOR_INVALID, loop.record.faults);
    TEST_ASSERT_EQUAL_UINT64(1, loop.supervisor.counts[MCT_FAULT_SENSOR_INVALID]);
}

/* A short silence is ridden out: derated at most, and the pendulum stays up. */
static void test_a_silence_of_three_ticks_is_ridden_out(void)
{
    mct_scene scene = swing_up_scene(REACTION_WHEEL);
    scene.initial[0] = 0.05;
    scene.sensor_fault = MCT_SENSOR_FAULT_SILENT;
    scene.sensor_fault_time = 2;
    scene.sensor_fault_duration = 0.003;
    start_loop(&scene);
    for (int k = 0; k < 5000; k++) {
        mct_loop_tick(&loop);
    }
    TEST_ASSERT_EQUAL_UINT32(0, loop.record.faults);
    TEST_ASSERT_TRUE(angle_size(mct_plant_value(&sim.plant, 0)) < 0.01);
}

/* A HAL that fails on command, in front of the sim. */
static struct {
    mct_status read, write;
    int stops;
    mct_real last;
} broken;

static mct_status broken_read(void *context, mct_reading *out)
{
    return broken.read != MCT_OK ? broken.read : mct_sim_hal(context).ops->read(context, out);
}

static mct_status broken_write(void *context, mct_real input)
{
    broken.last = input;
    return broken.write != MCT_OK ? broken.write : mct_sim_hal(context).ops->write(context, input);
}

static void broken_stop(void *context)
{
    broken.stops++;
    mct_sim_hal(context).ops->stop(context);
}

static void test_a_hal_that_cannot_read_or_write_is_latched_and_ends_at_zero_volts(void)
{
    for (int which = 0; which < 2; which++) {
        const mct_scene scene = swing_up_scene(CART_POLE);
        start_loop(&scene);
        mct_hal_ops ops = *mct_sim_hal(&sim).ops;
        ops.read = broken_read;
        ops.write = broken_write;
        ops.stop = broken_stop;
        loop.hal.ops = &ops;
        memset(&broken, 0, sizeof broken);
        for (int k = 0; k < 400; k++) {
            broken.read = which == 0 && k == 300 ? MCT_ERROR_IO : MCT_OK;
            broken.write = which == 1 && k == 300 ? MCT_ERROR_IO : MCT_OK;
            mct_loop_tick(&loop);
            TEST_ASSERT_TRUE(k != 299 || sim.plant.input != 0);
            TEST_ASSERT_TRUE(k < 300 || sim.plant.input == 0);
        }
        TEST_ASSERT_EQUAL_UINT32(1u << MCT_FAULT_HAL, loop.supervisor.latched);
        TEST_ASSERT_EQUAL_INT(1, broken.stops);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_healthy_gate_lets_through_what_is_wanted_up_to_the_supply);
    RUN_TEST(test_the_motor_is_not_driven_before_the_first_valid_reading);
    RUN_TEST(test_a_sensor_value_that_is_not_finite_latches_sensor_invalid);
    RUN_TEST(test_feedback_is_derated_from_3_ms_and_zero_and_latched_from_5_ms);
    RUN_TEST(test_what_passes_is_whole_millivolts_within_the_limit);
    RUN_TEST(test_what_a_drive_reports_latches_its_fault);
    RUN_TEST(test_a_drive_that_is_not_ready_yet_is_waited_for_without_a_fault);
    RUN_TEST(test_good_feedback_asks_for_rearming_after_the_time_that_the_scene_gives);
    RUN_TEST(test_a_driven_encoder_that_stands_still_latches_sensor_frozen);
    RUN_TEST(test_an_encoder_may_stand_still_under_little_voltage);
    RUN_TEST(test_an_estimate_that_is_not_finite_latches_its_fault);
    RUN_TEST(test_a_wanted_voltage_that_is_not_finite_latches_its_fault);
    RUN_TEST(test_a_cart_that_leaves_its_track_latches_track_end);
    RUN_TEST(test_a_wheel_beyond_its_speed_latches_overspeed);
    RUN_TEST(test_driving_without_balance_for_too_long_latches_no_balance);
    RUN_TEST(test_what_is_not_driven_may_wait_for_balance_for_ever);
    RUN_TEST(test_without_a_time_to_give_up_it_never_does);
    RUN_TEST(test_faults_from_outside_are_latched_under_their_names);
    RUN_TEST(test_a_cause_that_persists_latches_again);
    RUN_TEST(test_whatever_comes_in_what_goes_out_is_finite_within_the_limit_and_zero_in_doubt);
    RUN_TEST(test_silent_sensors_end_at_zero_volts_within_6_ticks_and_it_stays_so);
    RUN_TEST(test_a_nan_from_a_sensor_is_zero_volts_in_the_same_tick);
    RUN_TEST(test_a_silence_of_three_ticks_is_ridden_out);
    RUN_TEST(test_a_hal_that_cannot_read_or_write_is_latched_and_ends_at_zero_volts);
    return UNITY_END();
}

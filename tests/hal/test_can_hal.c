/*
 * The HAL over CAN against virtual drives on a bus within the process, under the whole loop: the motor is judged by
 * what its drive really puts on it.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "hal/socketcan/can.h"
#include "hal/socketcan/candump.h"
#include "hal/socketcan/drive.h"
#include "hal/socketcan/ring.h"
#include "mctau/loop.h"
#include "support/scenes.h"
#include "support/swing_up.h"
#include "unity.h"

enum { SWING_UP = 3000, BALANCE = 20000, LAST_TICK = 50000 }; /* [ticks] */

static mct_scene scene;
static mct_can_ring bus;
static mct_can_drive drive;
static mct_can can;
static mct_loop loop;
static mct_plan plan;
static mct_message why;

void setUp(void)
{
    scene = swing_up_scene(REACTION_WHEEL);
}

void tearDown(void)
{
}

/* Everything but the HAL's start. */
static mct_status prepare(void)
{
    memset(&why, 0, sizeof why);
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_scene_check(&scene, &why), why.text);
    mct_can_ring_init(&bus);
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_can_drive_init(&drive, &scene, mct_can_ring_end(&bus, 1), &why),
                                  why.text);
    mct_can_drive_serve(&drive, &bus);
    drive.held = true;
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_can_drive_open(&drive, &why), why.text);
    const mct_status status = mct_can_init(&can, &scene, mct_can_ring_end(&bus, 0), true, &why);
    can.plant = &drive.sim.plant.state;
    return status;
}

static mct_status open_hal(void)
{
    const mct_hal hal = mct_can_hal(&can);
    const mct_status status = hal.ops->open(hal.context, &why);
    drive.held = false;
    return status;
}

static void start(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, prepare(), why.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, open_hal(), why.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        MCT_OK, mct_loop_init(&loop, &plan, &scene, mct_can_hal(&can), NULL, (mct_samples){NULL, 0}, &why),
        why.text);
}

static void finish(void)
{
    const mct_hal hal = mct_can_hal(&can);
    hal.ops->close(hal.context);
    mct_can_drive_close(&drive);
}

static double angle(void)
{
    return angle_size((double)drive.sim.plant.state.x[drive.sim.plant.system->actuation->upright_coordinate]);
}

static void check_same_bits(int system, bool disturbed)
{
    static mct_sim sim;
    static mct_loop reference;
    static mct_plan reference_plan;
    scene = swing_up_scene(system);
    if (disturbed) {
        scene.noise = 1;
        scene.latency = 1;
        scene.variation_spread = 0.1;
        scene.variation_seed = 3;
    }
    start();
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_sim_init(&sim, &scene, &why));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_loop_init(&reference, &reference_plan, &scene, mct_sim_hal(&sim), NULL,
                                                (mct_samples){NULL, 0}, &why));
    for (int k = 0; k < 30000; k++) {
        mct_loop_tick(&loop);
        mct_loop_tick(&reference);
        TEST_ASSERT_EQUAL_MEMORY(&reference.record.plant, &loop.record.plant, sizeof loop.record.plant);
        TEST_ASSERT_EQUAL_MEMORY(reference.record.reading.counts, loop.record.reading.counts,
                                 sizeof loop.record.reading.counts);
        TEST_ASSERT_EQUAL_MEMORY(reference.record.estimate, loop.record.estimate,
                                 sizeof loop.record.estimate);
        TEST_ASSERT_TRUE(reference.record.applied == loop.record.applied);
        TEST_ASSERT_EQUAL_INT(reference.record.mode, loop.record.mode);
        TEST_ASSERT_EQUAL_UINT32(0, loop.record.faults);
    }
    finish();
}

static void test_a_lossless_bus_gives_the_bits_of_the_simulated_hal(void)
{
    for (int system = CART_POLE; system <= REACTION_WHEEL; system++) {
        check_same_bits(system, false);
        check_same_bits(system, true);
    }
}

static void test_each_protocol_swings_up_and_balances(void)
{
    static const struct {
        int32_t protocol, mode, firmware;
    } cases[] = {
        {MCT_CAN_NATIVE, MCT_CAN_MODE_VOLTAGE, 0},
        {MCT_CAN_VESC, MCT_CAN_MODE_VOLTAGE, 0},
        {MCT_CAN_ODRIVE, MCT_CAN_MODE_VOLTAGE, MCT_CAN_FIRMWARE_0_6},
        {MCT_CAN_ODRIVE, MCT_CAN_MODE_VOLTAGE, MCT_CAN_FIRMWARE_0_5},
        {MCT_CAN_ODRIVE, MCT_CAN_MODE_TORQUE, MCT_CAN_FIRMWARE_0_6},
        {MCT_CAN_ODRIVE, MCT_CAN_MODE_TORQUE, MCT_CAN_FIRMWARE_0_5},
    };
    for (int system = CART_POLE; system <= REACTION_WHEEL; system++) {
        for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
            scene = swing_up_scene(system);
            scene.can_protocol = cases[i].protocol;
            scene.can_mode = cases[i].mode;
            scene.can_firmware = cases[i].firmware;
            start();
            double worst = 0;
            for (int k = 0; k < 30000; k++) {
                mct_loop_tick(&loop);
                worst = k >= 20000 ? fmax(worst, angle()) : 0;
            }
            char text[64];
            snprintf(text, sizeof text, "system %d, case %d: %g rad", system, (int)i, worst);
            TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, loop.record.faults, text);
            TEST_ASSERT_TRUE_MESSAGE(worst < 0.035, text);
            finish();
        }
    }
}

/* Wires crossed in the scene and in the drive alike: what is described is what is driven. */
static void test_a_motor_and_encoders_mounted_the_other_way_round_balance_as_well(void)
{
    for (int32_t protocol = MCT_CAN_NATIVE; protocol <= MCT_CAN_ODRIVE; protocol++) {
        scene.can_protocol = protocol;
        scene.can_inverted = 1;
        scene.can_encoder_ratio[0] = -1;
        scene.can_encoder_ratio[1] = protocol == MCT_CAN_NATIVE ? -1 : -4; /* a gear, too */
        scene.can_encoder_node[0] = 5;
        start();
        for (int k = 0; k < 30000; k++) {
            mct_loop_tick(&loop);
        }
        TEST_ASSERT_EQUAL_UINT32(0, loop.record.faults);
        TEST_ASSERT_TRUE(angle() < 0.035);
        TEST_ASSERT_EQUAL_INT(2, can.axes.count);
        finish();
    }
}

/* --- the fault matrix --- */

#define FAULT(fault) (1u << MCT_FAULT_##fault)

typedef struct {
    int32_t kind;
    const char *name;
    /* Any of these must have been latched first; 0: the run goes on as if nothing had happened. By protocol. */
    uint32_t named[MCT_CAN_PROTOCOL_COUNT];
    int within; /* ticks from the fault's begin until the motor has zero volts */
} fault_case;

static const fault_case fault_cases[] = {
    {MCT_CAN_FAULT_DROP, "drop", {FAULT(SENSOR_STALE), FAULT(SENSOR_STALE), FAULT(SENSOR_STALE)}, 6},
    {MCT_CAN_FAULT_DELAY, "delay", {FAULT(SENSOR_STALE), FAULT(SENSOR_STALE), FAULT(SENSOR_STALE)}, 6},
    {MCT_CAN_FAULT_DUPLICATE, "duplicate", {0, 0, 0}, 0},
    {MCT_CAN_FAULT_REORDER, "reorder", {0, 0, 0}, 0},
    {MCT_CAN_FAULT_SHORT, "short", {FAULT(SENSOR_STALE), FAULT(SENSOR_STALE), FAULT(SENSOR_STALE)}, 6},
    {MCT_CAN_FAULT_REMOTE, "remote", {FAULT(SENSOR_STALE), FAULT(SENSOR_STALE), FAULT(SENSOR_STALE)}, 6},
    {MCT_CAN_FAULT_FORMAT, "format", {FAULT(SENSOR_STALE), FAULT(SENSOR_STALE), FAULT(SENSOR_STALE)}, 6},
    {MCT_CAN_FAULT_NAN, "nan", {FAULT(SENSOR_INVALID), FAULT(SENSOR_STALE), FAULT(SENSOR_INVALID)}, 6},
    {MCT_CAN_FAULT_SILENCE, "silence", {FAULT(SENSOR_STALE), FAULT(SENSOR_STALE), FAULT(SENSOR_STALE)}, 6},
    {MCT_CAN_FAULT_REBOOT, "reboot", {FAULT(SENSOR_STALE), FAULT(SENSOR_STALE), FAULT(SENSOR_STALE)}, 6},
    {MCT_CAN_FAULT_ESTOP,
     "estop",
     {FAULT(ESTOP) | FAULT(DRIVE), FAULT(NOT_READY), FAULT(DRIVE) | FAULT(NOT_READY)},
     6},
    {MCT_CAN_FAULT_ERROR, "error", {FAULT(DRIVE), FAULT(NOT_READY), FAULT(DRIVE) | FAULT(NOT_READY)}, 6},
};

static char label[128];

static void check_fault(const fault_case *fault, int32_t protocol, int at)
{
    enum { LASTS = 200, PAUSE = 500 };
    const uint32_t named = fault->named[protocol];
    /* A vesc cannot say that it has let the motor go: it shows in time or is over unnoticed. */
    const bool is_silent = protocol == MCT_CAN_VESC && named == FAULT(NOT_READY);
    snprintf(label, sizeof label, "%s, protocol %d, tick %d", fault->name, (int)protocol, at);
    scene.can_protocol = protocol;
    scene.can_fault = fault->kind;
    scene.can_fault_time = at * scene.dt;
    scene.can_fault_duration = LASTS * scene.dt;
    start();
    uint32_t first = 0;
    int driven_again = -1;
    for (int k = 0; k < LAST_TICK; k++) {
        if (k == at + LASTS + PAUSE && named != 0) {
            mct_loop_rearm(&loop);
        }
        mct_loop_tick(&loop);
        first = first == 0 ? loop.record.faults : first;
        TEST_ASSERT_TRUE_MESSAGE(fabs(drive.volts) <= drive.devices[0].supply || !drive.powered, label);
        TEST_ASSERT_TRUE_MESSAGE(k >= at || loop.record.faults == 0, label);
        const bool is_over = k >= at + LASTS && is_silent && loop.record.faults == 0;
        if (named != 0 && k >= at + fault->within && k < at + LASTS + PAUSE && !is_over) {
            TEST_ASSERT_TRUE_MESSAGE(!drive.powered || drive.volts == 0, label);
        }
        if (k > at + LASTS + PAUSE && driven_again < 0 && drive.powered && drive.volts != 0) {
            driven_again = k;
        }
    }
    if (named == 0) {
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, first, label);
    } else {
        TEST_ASSERT_TRUE_MESSAGE((first & named) != 0 || is_silent, label);
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, first & ~named, label);
        TEST_ASSERT_TRUE_MESSAGE(driven_again >= 0 && driven_again < at + LASTS + PAUSE + 1200, label);
    }
    if (fault->kind !=
        MCT_CAN_FAULT_REBOOT) { /* that one forgets where it is, and nobody has brought it home */
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, loop.record.faults, label);
        TEST_ASSERT_TRUE_MESSAGE(angle() < 0.035, label);
    }
    TEST_ASSERT_TRUE_MESSAGE(drive.result.spoilt > 0 || fault->kind >= MCT_CAN_FAULT_REBOOT, label);
    finish();
}

static void test_every_fault_ends_at_zero_volts_is_named_and_can_be_rearmed(void)
{
    for (size_t i = 0; i < sizeof fault_cases / sizeof fault_cases[0]; i++) {
        for (int32_t protocol = MCT_CAN_NATIVE; protocol <= MCT_CAN_ODRIVE; protocol++) {
            check_fault(&fault_cases[i], protocol, SWING_UP);
            check_fault(&fault_cases[i], protocol, BALANCE);
        }
    }
}

static void test_a_controller_that_is_gone_is_stopped_by_the_drives_watchdog(void)
{
    for (int32_t protocol = MCT_CAN_NATIVE; protocol <= MCT_CAN_ODRIVE; protocol++) {
        scene.can_protocol = protocol;
        start();
        for (int k = 0; k < SWING_UP; k++) {
            mct_loop_tick(&loop);
        }
        TEST_ASSERT_TRUE(drive.powered && drive.volts != 0);
        const int timeout = (int)(scene.can_watchdog / scene.dt + 0.5);
        const uint64_t trips = drive.result.watchdog_trips; /* it was tried at the start */
        for (int k = 0; k < 1000; k++) {
            mct_can_drive_tick(&drive); /* nobody says anything */
            TEST_ASSERT_TRUE(k < timeout + 1 || !drive.powered || drive.volts == 0);
        }
        TEST_ASSERT_EQUAL_UINT64(trips + 1, drive.result.watchdog_trips);
        mct_can_drive_close(&drive);
    }
}

static void test_a_link_that_comes_back_carries_no_stale_command(void)
{
    static const mct_can_link_state states[] = {MCT_CAN_DOWN, MCT_CAN_GONE, MCT_CAN_BUS_OFF, MCT_CAN_UNSENT};
    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++) {
        for (int32_t protocol = MCT_CAN_NATIVE; protocol <= MCT_CAN_ODRIVE; protocol++) {
            snprintf(label, sizeof label, "state %d, protocol %d", (int)states[i], (int)protocol);
            scene.can_protocol = protocol;
            start();
            for (int k = 0; k < LAST_TICK; k++) {
                if (k == SWING_UP) {
                    bus.state = states[i];
                } else if (k == SWING_UP + 200) {
                    bus.state = MCT_CAN_UP;
                } else if (k == SWING_UP + 1000) {
                    mct_loop_rearm(&loop);
                }
                mct_loop_tick(&loop);
                if (k >= SWING_UP + 1 && k < SWING_UP + 1000) {
                    TEST_ASSERT_TRUE_MESSAGE(loop.record.faults & FAULT(LINK_DOWN), label);
                    TEST_ASSERT_TRUE_MESSAGE(loop.record.applied == 0, label);
                }
                /* The drive heard nothing while the link was down: its own watchdog has stopped it. */
                if (k >= SWING_UP + 110 && k < SWING_UP + 1000) {
                    TEST_ASSERT_TRUE_MESSAGE(!drive.powered || drive.volts == 0, label);
                }
            }
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, loop.record.faults, label);
            TEST_ASSERT_TRUE_MESSAGE(angle() < 0.035, label);
            finish();
        }
    }
}

/* After 128 commands a newer one looks older to a native drive: to cease is heeded all the same. */
static void test_a_stop_that_was_lost_with_the_link_is_heeded_when_the_link_is_back(void)
{
    for (int outage = 20; outage < 240; outage += 20) {
        scene.can_watchdog = 0.25;
        start();
        for (int k = 0; k < SWING_UP + outage + 300; k++) {
            bus.state = k >= SWING_UP && k < SWING_UP + outage ? MCT_CAN_BUS_OFF : MCT_CAN_UP;
            mct_loop_tick(&loop);
            TEST_ASSERT_TRUE(k < SWING_UP + outage + 2 || drive.volts == 0);
        }
        TEST_ASSERT_TRUE(drive.result.stops > 0);
        finish();
    }
}

static void test_after_a_drives_restart_a_mechanism_brought_home_swings_up_again(void)
{
    scene.can_fault = MCT_CAN_FAULT_REBOOT;
    scene.can_fault_time = 3;
    start();
    for (int k = 0; k < LAST_TICK; k++) {
        if (k == 10000) { /* by hand */
            mct_state_set(drive.sim.plant.system, MCT_MAX_STATES, scene.initial, &drive.sim.plant.state);
            memset(drive.boards[0].position, 0, sizeof drive.boards[0].position);
        }
        if (k == 10010) {
            TEST_ASSERT_TRUE(loop.record.faults & FAULT(RESTARTED));
            mct_loop_rearm(&loop);
        }
        mct_loop_tick(&loop);
    }
    TEST_ASSERT_EQUAL_HEX32(0, loop.record.faults);
    TEST_ASSERT_TRUE(angle() < 0.035);
    finish();
}

/* It never says that it has restarted; after half a second without a position nobody knows. */
static void test_a_vesc_that_comes_back_after_a_silence_is_taken_for_restarted(void)
{
    enum { SILENT = 500 };
    scene.can_protocol = MCT_CAN_VESC;
    scene.can_fault = MCT_CAN_FAULT_SILENCE;
    scene.can_fault_time = 3;
    scene.can_fault_duration = SILENT * scene.dt;
    start();
    for (int k = 0; k < SWING_UP + SILENT + 10; k++) {
        mct_loop_tick(&loop);
        TEST_ASSERT_TRUE(k < SWING_UP + 6 || !drive.powered || drive.volts == 0);
        TEST_ASSERT_TRUE(k > SWING_UP + SILENT - 2 || !(loop.record.faults & FAULT(RESTARTED)));
    }
    TEST_ASSERT_TRUE(loop.record.faults & FAULT(RESTARTED));
    TEST_ASSERT_EQUAL_UINT64(2, can.counts.values[MCT_CAN_COUNT_DRIVE_RESTARTS]); /* of wheel and arm */
    finish();
}

static void test_faults_are_cleared_by_themselves_where_the_scene_asks_for_it(void)
{
    scene.rearm_after = 0.5;
    scene.can_fault = MCT_CAN_FAULT_SILENCE;
    scene.can_fault_time = 20;
    start();
    for (int k = 0; k < LAST_TICK; k++) {
        mct_loop_tick(&loop);
    }
    TEST_ASSERT_EQUAL_UINT64(1, loop.supervisor.rearmed);
    TEST_ASSERT_EQUAL_HEX32(0, loop.record.faults);
    TEST_ASSERT_TRUE(angle() < 0.035);
    finish();
}

/* --- a recorded bus --- */

/* The host's end of the bus, with all that it carries written down as candump does. */
static struct {
    char text[1 << 20];
    size_t length;
    mct_can_transport_ops ops;
    mct_can_transport end;
} tape;

static void write_down(const mct_can_frame *frame)
{
    const long long us = bus.now_us;
    char *at = tape.text + tape.length;
    size_t left = sizeof tape.text - tape.length;
    int used = snprintf(at, left, "(%lld.%06lld) can0 %0*X#", 1000 + us / 1000000, us % 1000000,
                        frame->extended ? 8 : 3, (unsigned)frame->id);
    for (int i = 0; i < frame->length; i++) {
        used += snprintf(at + used, left - (size_t)used, "%02X", frame->data[i]);
    }
    used += snprintf(at + used, left - (size_t)used, "\n");
    TEST_ASSERT_TRUE((size_t)used < left);
    tape.length += (size_t)used;
}

static bool tape_send(void *context, const mct_can_frame *frame)
{
    write_down(frame);
    return tape.end.ops->send(context, frame);
}

static bool tape_receive(void *context, mct_can_frame *frame)
{
    const bool came = tape.end.ops->receive(context, frame);
    if (came) {
        write_down(frame);
    }
    return came;
}

static void test_a_recorded_bus_replays_the_same_commands(void)
{
    enum { TICKS = 4000 };
    static mct_can_candump log;
    static mct_real applied[TICKS];
    for (int32_t protocol = MCT_CAN_NATIVE; protocol <= MCT_CAN_ODRIVE; protocol++) {
        snprintf(label, sizeof label, "protocol %d", (int)protocol);
        scene.can_protocol = protocol;
        TEST_ASSERT_EQUAL_INT(MCT_OK, prepare());
        tape.length = 0;
        tape.end = mct_can_ring_end(&bus, 0);
        tape.ops = *tape.end.ops;
        tape.ops.send = tape_send;
        tape.ops.receive = tape_receive;
        can.transport.ops = &tape.ops;
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, open_hal(), why.text);
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_loop_init(&loop, &plan, &scene, mct_can_hal(&can), NULL,
                                                    (mct_samples){NULL, 0}, &why));
        for (int k = 0; k < TICKS; k++) {
            mct_loop_tick(&loop);
            applied[k] = loop.record.applied;
        }
        finish();
        const mct_can_transport recorded = mct_can_candump_transport(&log, tape.text, tape.length);
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_can_init(&can, &scene, recorded, true, &why));
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, open_hal(), why.text);
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_loop_init(&loop, &plan, &scene, mct_can_hal(&can), NULL,
                                                    (mct_samples){NULL, 0}, &why));
        for (int k = 0; k < TICKS; k++) {
            mct_loop_tick(&loop);
            TEST_ASSERT_TRUE_MESSAGE(loop.record.applied == applied[k], label);
        }
        TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, log.mismatches, label);
        TEST_ASSERT_EQUAL_UINT64_MESSAGE(0, log.unmatched, label);
        TEST_ASSERT_TRUE_MESSAGE(log.compared >= TICKS, label);
        mct_loop_tick(&loop); /* beyond the end: zero volts, and it says why */
        mct_loop_tick(&loop);
        TEST_ASSERT_TRUE_MESSAGE(loop.record.faults & FAULT(LINK_DOWN), label);
        TEST_ASSERT_TRUE_MESSAGE(loop.record.applied == 0, label);
        finish();
    }
}

/* --- the start --- */

static void check_refused(const char *words)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_ERROR_IO, open_hal(), words);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, words), why.text);
    TEST_ASSERT_EQUAL_UINT64(0, drive.result.driven_ticks);
    mct_can_drive_close(&drive);
}

/* Drives that are not there, by node. */
static void test_the_start_names_the_message_that_is_missing(void)
{
    for (int32_t protocol = MCT_CAN_NATIVE; protocol <= MCT_CAN_ODRIVE; protocol++) {
        scene.can_protocol = protocol;
        TEST_ASSERT_EQUAL_INT(MCT_OK, prepare());
        mct_can_ring_serve(&bus, 1, NULL, NULL); /* nobody */
        check_refused(protocol == MCT_CAN_NATIVE ? "node 1: Drive_Fb has not come"
                      : protocol == MCT_CAN_VESC ? "node 1: STATUS_4 has not come"
                                                 : "node 1: Get_Encoder_Estimates has not come");
    }
    scene.can_protocol = MCT_CAN_ODRIVE;
    scene.can_encoder_node[0] = 7; /* as the drive has it */
    TEST_ASSERT_EQUAL_INT(MCT_OK, prepare());
    scene.can_encoder_node[0] = 9; /* as the host believes it is */
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_can_init(&can, &scene, mct_can_ring_end(&bus, 0), true, &why));
    check_refused("node 9: Get_Encoder_Estimates has not come within 3 s; other messages have");
}

/* A drive that ticks every tenth millisecond of the host's. */
static void tick_slowly(void *context, int64_t timeout_us)
{
    static int calls;
    (void)timeout_us;
    if (++calls % 10 == 0) {
        mct_can_drive_tick(context);
    }
    mct_can_ring_advance(&bus, 1000);
}

static void test_the_start_names_the_message_that_is_too_slow(void)
{
    for (int32_t protocol = MCT_CAN_NATIVE; protocol <= MCT_CAN_ODRIVE; protocol++) {
        scene.can_protocol = protocol;
        TEST_ASSERT_EQUAL_INT(MCT_OK, prepare());
        mct_can_ring_serve(&bus, 1, tick_slowly, &drive);
        check_refused("comes every 1");
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "allowed up to 3 ms"), why.text);
    }
}

/* Another drive with the number of the first encoder's, a third of a turn away. */
static void tick_two(void *context, int64_t timeout_us)
{
    (void)context;
    (void)timeout_us;
    mct_can_drive_tick(&drive);
    mct_can_device other = drive.devices[0];
    other.turns += 0.3;
    for (int i = 0; i < other.protocol->message_count; i++) {
        mct_can_frame frame;
        if (other.protocol->messages[i].period == 0 && other.protocol->report(&other, i, &frame)) {
            const mct_can_transport end = mct_can_ring_end(&bus, 1);
            end.ops->send(end.context, &frame);
        }
    }
    mct_can_ring_advance(&bus, 1000);
}

static void test_two_drives_with_one_number_are_refused(void)
{
    for (int32_t protocol = MCT_CAN_VESC; protocol <= MCT_CAN_ODRIVE; protocol++) {
        scene.can_protocol = protocol;
        TEST_ASSERT_EQUAL_INT(MCT_OK, prepare());
        mct_can_ring_serve(&bus, 1, tick_two, NULL);
        check_refused("node 1: found two drives with this number");
    }
}

static void test_a_drive_whose_watchdog_does_not_act_is_not_driven(void)
{
    static mct_scene without;
    for (int32_t protocol = MCT_CAN_NATIVE; protocol <= MCT_CAN_ODRIVE; protocol += MCT_CAN_ODRIVE) {
        scene.can_protocol = protocol;
        without = scene;
        TEST_ASSERT_EQUAL_INT(MCT_OK, prepare());
        without.can_watchdog = 0;
        drive.devices[0].scene = &without; /* an odrive has it from its own configuration */
        if (protocol == MCT_CAN_ODRIVE) {
            check_refused("its watchdog did not act");
        } else {
            TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, open_hal(), why.text); /* a native drive is told */
            TEST_ASSERT_TRUE(can.report.watchdog_verified);
            finish();
        }
    }
}

static void test_a_drive_that_does_not_get_ready_is_said_so(void)
{
    scene.can_protocol = MCT_CAN_ODRIVE;
    scene.can_fault = MCT_CAN_FAULT_DROP_COMMANDS;
    TEST_ASSERT_EQUAL_INT(MCT_OK, prepare());
    drive.devices[0].node =
        33; /* it hears and says nothing any more, its encoder's frames come from elsewhere */
    check_refused("has not come");
}

static void test_a_bus_that_would_be_too_full_is_refused_before_anything_is_sent(void)
{
    scene.can_protocol = MCT_CAN_ODRIVE;
    scene.can_bitrate = 250000;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, prepare());
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "can.bitrate: found 250000 bit/s"), why.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "allowed 70 %"), why.text);
    scene.can_highest_load = 2;
    TEST_ASSERT_EQUAL_INT(MCT_OK, prepare());
}

/* CAN.md's figures for one ODrive axis and 500 kbit/s: 45 to 54 %. */
static void test_the_bus_load_is_that_of_the_frames(void)
{
    scene.can_protocol = MCT_CAN_ODRIVE;
    scene.can_bitrate = 1000000;
    TEST_ASSERT_EQUAL_INT(MCT_OK, prepare());
    /* one command and two encoders a millisecond, two heartbeats a tenth of a second */
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, (3 * 1000 + 2 * 10) * 111 / 1e6, can.report.nominal_load);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, (3 * 1000 + 2 * 10) * 135 / 1e6, can.report.load);
}

static void test_scenes_that_no_drive_can_serve_are_refused(void)
{
    scene.can_protocol = MCT_CAN_VESC;
    scene.can_mode = MCT_CAN_MODE_TORQUE;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_can_axes_init(&can.axes, &scene, &why));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "can.mode"), why.text);
    scene.can_mode = MCT_CAN_MODE_VOLTAGE;
    scene.can_encoder_node[0] = scene.can_node; /* a vesc reads one encoder */
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_can_axes_init(&can.axes, &scene, &why));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "can.arm_node"), why.text);
    scene = swing_up_scene(REACTION_WHEEL);
    scene.effects &= ~(uint32_t)MCT_MOTOR;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_can_axes_init(&can.axes, &scene, &why));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "effects.motor off"), why.text);
    scene = swing_up_scene(REACTION_WHEEL);
    scene.can_encoder_ratio[1] = 0;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_can_axes_init(&can.axes, &scene, &why));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "can.wheel_ratio: found 0"), why.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_lossless_bus_gives_the_bits_of_the_simulated_hal);
    RUN_TEST(test_each_protocol_swings_up_and_balances);
    RUN_TEST(test_a_motor_and_encoders_mounted_the_other_way_round_balance_as_well);
    RUN_TEST(test_every_fault_ends_at_zero_volts_is_named_and_can_be_rearmed);
    RUN_TEST(test_a_controller_that_is_gone_is_stopped_by_the_drives_watchdog);
    RUN_TEST(test_a_link_that_comes_back_carries_no_stale_command);
    RUN_TEST(test_a_stop_that_was_lost_with_the_link_is_heeded_when_the_link_is_back);
    RUN_TEST(test_after_a_drives_restart_a_mechanism_brought_home_swings_up_again);
    RUN_TEST(test_a_vesc_that_comes_back_after_a_silence_is_taken_for_restarted);
    RUN_TEST(test_faults_are_cleared_by_themselves_where_the_scene_asks_for_it);
    RUN_TEST(test_a_recorded_bus_replays_the_same_commands);
    RUN_TEST(test_the_start_names_the_message_that_is_missing);
    RUN_TEST(test_the_start_names_the_message_that_is_too_slow);
    RUN_TEST(test_two_drives_with_one_number_are_refused);
    RUN_TEST(test_a_drive_whose_watchdog_does_not_act_is_not_driven);
    RUN_TEST(test_a_drive_that_does_not_get_ready_is_said_so);
    RUN_TEST(test_a_bus_that_would_be_too_full_is_refused_before_anything_is_sent);
    RUN_TEST(test_the_bus_load_is_that_of_the_frames);
    RUN_TEST(test_scenes_that_no_drive_can_serve_are_refused);
    return UNITY_END();
}

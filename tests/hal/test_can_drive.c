/* The virtual drive: the motion of hal/sim over a good bus, a real drive's rules, faults as they are told. */
#include <math.h>
#include <string.h>

#include "hal/socketcan/drive.h"
#include "support/scenes.h"
#include "unity.h"

#define TURN 6.283185307179586

enum { LONG_AGO = 4096, DT_US = 1000 };

static mct_scene scene;
static mct_can_ring ring;
static mct_can_drive drive;
static mct_can_transport bus; /* the host's end */
static mct_can_counts counts;
static mct_can_axes host;
/* what the host has heard */
static struct {
    mct_can_frame frame;
    int tick;
    mct_can_verdict verdict;
} heard[LONG_AGO];
static int heard_count, tick_count;
static int verdicts[MCT_CAN_IS_BAD_CHECKSUM + 1];

void setUp(void)
{
    scene = scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_INDUCTIVE);
    scene.initial[0] = 2;
    scene.can_duty_ramp = 1e6;
}

void tearDown(void)
{
}

static void begin(void)
{
    mct_message why = {""};
    memset(&counts, 0, sizeof counts);
    memset(verdicts, 0, sizeof verdicts);
    heard_count = 0;
    tick_count = 0;
    mct_can_ring_init(&ring);
    bus = mct_can_ring_end(&ring, 0);
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        MCT_OK, mct_can_drive_init(&drive, &scene, mct_can_ring_end(&ring, 1), &why), why.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_can_axes_init(&host, &scene, &why), why.text);
    mct_can_drive_serve(&drive, &ring);
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_can_drive_open(&drive, &why));
    TEST_ASSERT_EQUAL_INT(MCT_OK, bus.ops->open(bus.context, NULL, 0, &counts, &why));
}

/* In the order of can.protocol, an ODrive of firmware 0.5 behind. */
enum { ODRIVE_0_5 = MCT_CAN_PROTOCOL_COUNT, KINDS };

static void speak(int protocol)
{
    scene.can_protocol = protocol == ODRIVE_0_5 ? MCT_CAN_ODRIVE : protocol;
    scene.can_firmware = protocol == ODRIVE_0_5 ? MCT_CAN_FIRMWARE_0_5 : MCT_CAN_FIRMWARE_0_6;
}

static void hear(void)
{
    mct_can_frame frame;
    while (bus.ops->receive(bus.context, &frame)) {
        mct_can_verdict verdict = MCT_CAN_IS_FOREIGN;
        for (int i = 0; i < host.count && verdict == MCT_CAN_IS_FOREIGN; i++) {
            verdict = host.protocol->hear(&host.axes[i], &frame);
        }
        verdicts[verdict]++;
        if (heard_count < LONG_AGO) {
            heard[heard_count].frame = frame;
            heard[heard_count].tick = tick_count;
            heard[heard_count].verdict = verdict;
            heard_count++;
        }
    }
}

static void tick(void)
{
    bus.ops->wait(bus.context, DT_US);
    tick_count++;
    hear();
}

static void ticks(int n)
{
    for (int i = 0; i < n; i++) {
        tick();
    }
}

static void send(const mct_can_frame *frame)
{
    TEST_ASSERT_TRUE(bus.ops->send(bus.context, frame));
}

static void command(double volts)
{
    mct_can_frame frame;
    host.protocol->command(&host.axes[0], (mct_real)volts, true, &frame);
    send(&frame);
}

static void drive_on(double volts, int n)
{
    for (int i = 0; i < n; i++) {
        command(volts);
        tick();
    }
}

static void arm(void)
{
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    for (int i = 0; i < host.count; i++) {
        const int n = host.protocol->arm(&host.axes[i], frames);
        for (int j = 0; j < n; j++) {
            send(&frames[j]);
        }
    }
}

static void stop(void)
{
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    const int n = host.protocol->stop(&host.axes[0], frames);
    for (int j = 0; j < n; j++) {
        send(&frames[j]);
    }
}

/* Ready, with the mechanism at tick 0 as a run's owner has it. */
static void begin_ready(void)
{
    begin();
    drive.held = true;
    ticks(5);
    arm();
    tick();
    drive.held = false;
    heard_count = 0;
    memset(verdicts, 0, sizeof verdicts);
}

static bool is_driven(void)
{
    return drive.powered && drive.volts != 0;
}

static double value(int state)
{
    return mct_plant_value(&drive.sim.plant, state);
}

/* Frames of a code heard at a tick; -1: at all. */
static int heard_of(uint32_t id, int at)
{
    int n = 0;
    for (int i = 0; i < heard_count; i++) {
        n += heard[i].frame.id == id && (at < 0 || heard[i].tick == at);
    }
    return n;
}

static const uint32_t feedback = 0x181; /* native, node 1 */

/* --- the same motion as hal/sim --- */

static void test_a_native_drive_gives_counts_and_motion_of_the_simulated_hal_to_the_bit(void)
{
    enum { RUNS = 6, TICKS = 3000 };
    for (int run = 0; run < RUNS; run++) {
        static mct_sim sim;
        mct_reading reading;
        mct_message why = {""};
        setUp();
        scene.noise = run > 0 ? 1.5 : 0;
        scene.latency = run > 1 ? 3 : 0;
        scene.counter_bits = run > 2 ? 12 : 32;
        scene.variation_spread = 0.1;
        scene.can_inverted = run == 4;
        scene.can_encoder_ratio[0] = run == 4 ? -1 : 1;
        scene.can_encoder_node[0] = run == 5 ? 9 : -1;
        begin_ready();
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_sim_init(&sim, &scene, &why));
        const mct_hal hal = mct_sim_hal(&sim);
        TEST_ASSERT_EQUAL_INT(MCT_OK, hal.ops->open(hal.context, &why));
        for (int k = 0; k < TICKS; k++) {
            /* what the frame carries: whole millivolts */
            const mct_real volts = (mct_real)rint(9000 * sin(0.005 * k)) / MCT_R(1000);
            hal.ops->read(hal.context, &reading);
            TEST_ASSERT_EQUAL_MEMORY(&sim.plant.state, &drive.sim.plant.state, sizeof(mct_state));
            for (int i = 0; i < 2; i++) {
                mct_can_axis *axis;
                /* what is mounted the other way and wraps: the low bits */
                const uint32_t mask = scene.counter_bits == 12 ? 0xFFF : 0xFFFFFFFF;
                TEST_ASSERT_EQUAL_UINT32((uint32_t)reading.counts[i] & mask,
                                         (uint32_t)mct_can_encoder_of(&host, i, &axis)->counts & mask);
            }
            hal.ops->write(hal.context, volts);
            hal.ops->wait_tick(hal.context);
            command((double)volts);
            tick();
        }
        TEST_ASSERT_EQUAL_UINT64(TICKS, drive.result.ticks);
        TEST_ASSERT_EQUAL_UINT64(0, drive.result.refused + drive.result.old_commands);
    }
}

/* The arm's drive, which is never armed, as well. A counter of the drive's has 32 bits whatever the scene's have. */
static void test_an_odrive_0_5_gives_the_counts_of_the_sensors_to_the_bit_armed_or_not(void)
{
    for (int run = 0; run < 4; run++) {
        setUp();
        speak(ODRIVE_0_5);
        scene.can_mode = run == 3 ? MCT_CAN_MODE_TORQUE : MCT_CAN_MODE_VOLTAGE;
        scene.noise = run > 0 ? 1.5 : 0;
        scene.counter_bits = run > 1 ? 10 : 32;
        scene.can_encoder_ratio[0] = run > 1 ? -1 : 1;
        scene.can_encoder_ratio[1] = run > 1 ? -3 : 1;
        begin_ready();
        for (int k = 0; k < 3000; k++) {
            drive_on(9 * sin(0.005 * k), 1);
            for (int i = 0; i < 2; i++) {
                mct_can_axis *axis;
                const uint32_t mask = scene.counter_bits == 10 ? 0x3FF : 0xFFFFFFFF;
                TEST_ASSERT_EQUAL_UINT32((uint32_t)drive.reading.counts[i] & mask,
                                         (uint32_t)mct_can_encoder_of(&host, i, &axis)->counts & mask);
            }
        }
        TEST_ASSERT_TRUE(fabs(value(1)) > 2 * TURN);
        TEST_ASSERT_EQUAL_INT(2, host.count);
        for (int i = 0; i < 2; i++) {
            TEST_ASSERT_EQUAL_INT(i == 0, drive.devices[i].has_driven);
            TEST_ASSERT_EQUAL_UINT32(0, host.axes[i].restarts + host.axes[i].alternations);
        }
        /* Its estimates are heard where their speed is needed. */
        TEST_ASSERT_EQUAL_INT(run == 3, heard_of(1 << 5 | 0x09, -1) > 0);
        TEST_ASSERT_EQUAL_INT(0, heard_of(2 << 5 | 0x09, -1));
    }
}

static void test_turns_of_the_others_are_the_counts_that_the_sensors_gave(void)
{
    for (int protocol = MCT_CAN_VESC; protocol < KINDS; protocol++) {
        speak(protocol);
        scene.noise = 2;
        scene.counter_bits = 10;
        begin_ready();
        for (int k = 0; k < 2000; k++) {
            drive_on(5, 1);
            const double turns = drive.devices[0].turns;
            const double exact = value(1) / TURN;
            const double whole = turns * 4096;
            TEST_ASSERT_DOUBLE_WITHIN(1e-6, rint(whole), whole);
            TEST_ASSERT_DOUBLE_WITHIN(10.5, exact * 4096, whole); /* 5 standard deviations, and rounding */
        }
        TEST_ASSERT_TRUE(fabs(value(1)) > 2 * TURN);
    }
}

static void test_a_rate_is_as_late_as_the_counts_and_whole_counts_a_second(void)
{
    enum { LATENCY = 3 };
    double rates[LATENCY + 1] = {0};
    scene.can_protocol = MCT_CAN_ODRIVE;
    scene.latency = LATENCY;
    begin_ready();
    for (int k = 1; k < 500; k++) {
        drive_on(5, 1);
        rates[k % (LATENCY + 1)] = value(3) / TURN;
        const double before = k > LATENCY ? rates[(k - LATENCY) % (LATENCY + 1)] : 0;
        TEST_ASSERT_DOUBLE_WITHIN(0.5001 / 4096, before, drive.devices[0].rate);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, rint(drive.devices[0].rate * 4096), drive.devices[0].rate * 4096);
    }
    TEST_ASSERT_TRUE(fabs(drive.devices[0].rate) > 1);
}

/* --- the release --- */

static void test_a_held_mechanism_does_not_move_and_its_drives_talk(void)
{
    scene.noise = 3;
    begin();
    drive.held = true;
    arm();
    drive_on(5, 499);
    command(5);
    tick();
    TEST_ASSERT_EQUAL_UINT64(0, drive.sim.plant.tick);
    TEST_ASSERT_EQUAL_INT(500, heard_of(feedback, -1));
    TEST_ASSERT_EQUAL_INT(5, heard_of(0x201, -1)); /* Drive_Status, 10 Hz */
    for (int i = 1; i < heard_count; i++) {
        if (heard[i].frame.id == feedback) {
            TEST_ASSERT_EQUAL_MEMORY(heard[0].frame.data, heard[i].frame.data, 4); /* the counts */
        }
    }
    TEST_ASSERT_EQUAL_UINT64(0, drive.result.driven_ticks);
    drive.held = false;
    command(3);
    tick();
    TEST_ASSERT_EQUAL_UINT64(1, drive.sim.plant.tick);
    TEST_ASSERT_EQUAL_DOUBLE(3, (double)drive.sim.plant.input);
}

static void test_without_an_owner_it_is_let_go_when_the_motors_drive_is_ready(void)
{
    for (int protocol = 0; protocol < KINDS; protocol++) {
        speak(protocol);
        begin();
        ticks(200);
        TEST_ASSERT_FALSE(drive.released);
        if (protocol != MCT_CAN_VESC) { /* which is always ready for a command */
            command(5);
            tick();
            TEST_ASSERT_FALSE(drive.released);
        }
        arm();
        command(5);
        tick();
        TEST_ASSERT_TRUE(drive.released);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_READY, drive.devices[0].state);
        drive_on(5, 20);
        TEST_ASSERT_TRUE(drive.sim.plant.tick >= 20);
    }
}

/* --- rules --- */

static void test_the_watchdog_takes_the_volts_away_within_its_time(void)
{
    for (int protocol = 0; protocol < KINDS; protocol++) {
        speak(protocol);
        scene.can_watchdog = 0.05;
        begin_ready();
        drive_on(5, 100);
        TEST_ASSERT_TRUE(is_driven());
        int lasts = 0;
        for (; is_driven() && lasts < 1000; lasts++) {
            tick();
        }
        TEST_ASSERT_EQUAL_INT(50, lasts); /* 49 of the 50 ms go on after the tick of the last command */
        ticks(200);
        TEST_ASSERT_FALSE(is_driven());
        TEST_ASSERT_EQUAL_UINT64(1, drive.result.watchdog_trips);
        TEST_ASSERT_EQUAL_UINT64(149, drive.result.driven_ticks);
        TEST_ASSERT_EQUAL_UINT64(148, drive.result.last_driven);
        drive_on(5, 10);
        TEST_ASSERT_TRUE(is_driven() == (protocol == MCT_CAN_VESC)); /* which latches nothing */
        if (protocol != MCT_CAN_VESC) {
            TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_FAULTY, drive.devices[0].state);
            ticks(200);
            TEST_ASSERT_TRUE(host.axes[0].watchdog_expired);
            arm();
            drive_on(5, 2);
            TEST_ASSERT_TRUE(is_driven());
        }
    }
}

static void test_without_a_watchdog_an_odrive_goes_on_for_ever(void)
{
    scene.can_protocol = MCT_CAN_ODRIVE;
    scene.can_watchdog = 0;
    begin_ready();
    drive_on(5, 1);
    ticks(5000);
    TEST_ASSERT_TRUE(is_driven());
}

/* It is told so; what the scene of the drive's side says counts for nothing. */
static void test_a_native_drive_has_the_watchdog_that_it_is_told(void)
{
    static mct_scene other;
    scene.can_watchdog = 0;
    begin_ready();
    other = scene;
    other.can_watchdog = 0.05;
    drive.devices[0].scene = &other;
    drive_on(5, 1);
    ticks(5000);
    TEST_ASSERT_TRUE(is_driven());
    host.axes[0].watchdog_ms = mct_can_watchdog_ms(other.can_watchdog);
    drive_on(5, 1);
    ticks(48);
    TEST_ASSERT_TRUE(is_driven());
    ticks(2);
    TEST_ASSERT_FALSE(is_driven());
}

static void test_a_watchdog_that_a_native_drive_cannot_be_told_is_refused(void)
{
    static const struct {
        double seconds;
        int protocol;
        const char *found;
    } cases[] = {{0.3, MCT_CAN_NATIVE, "0.3 s"},
                 {0.256, MCT_CAN_NATIVE, "0.256 s"},
                 {2, MCT_CAN_NATIVE, "2 s"},
                 {0.004, MCT_CAN_NATIVE, "0.004 s"},
                 {1e-9, MCT_CAN_NATIVE, "1e-09 s"},
                 {0, MCT_CAN_NATIVE, NULL},
                 {0.005, MCT_CAN_NATIVE, NULL},
                 {0.255, MCT_CAN_NATIVE, NULL},
                 {0.3, MCT_CAN_VESC, NULL},
                 {0.001, MCT_CAN_ODRIVE, NULL},
                 {2, ODRIVE_0_5, NULL}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        mct_message why = {""};
        speak(cases[i].protocol);
        scene.can_watchdog = cases[i].seconds;
        const mct_status status = mct_can_axes_init(&host, &scene, &why);
        TEST_ASSERT_EQUAL_INT_MESSAGE(cases[i].found ? MCT_ERROR_UNSUITED : MCT_OK, status, why.text);
        if (cases[i].found) {
            char words[128] = "can.watchdog: found ";
            strcat(words, cases[i].found);
            strcat(words, "; allowed 0 (none), or 0.005 to 0.255 s, which a native drive can be told");
            TEST_ASSERT_EQUAL_STRING(words, why.text);
        }
    }
}

static void test_any_frame_to_its_axis_feeds_the_watchdog_of_an_odrive(void)
{
    const mct_can_frame unknown = {.id = 1 << 5 | 0x1F};
    const mct_can_frame foreign = {.id = 3 << 5 | 0x1F};
    for (int protocol = MCT_CAN_ODRIVE; protocol < KINDS; protocol++) {
        speak(protocol);
        scene.can_watchdog = 0.05;
        begin_ready();
        drive_on(5, 1);
        for (int i = 0; i < 500; i++) {
            send(&unknown);
            tick();
        }
        TEST_ASSERT_TRUE(is_driven());
        for (int i = 0; i < 100; i++) {
            send(&foreign);
            tick();
        }
        TEST_ASSERT_FALSE(is_driven());
    }
}

static void test_what_stops_a_native_motor_shorts_it_and_what_stops_the_others_lets_it_run_free(void)
{
    for (int protocol = 0; protocol < KINDS; protocol++) {
        speak(protocol);
        scene.can_watchdog = 0.05;
        begin_ready();
        drive_on(8, 400);
        TEST_ASSERT_TRUE(fabs(value(3)) > 50);
        ticks(80);
        TEST_ASSERT_EQUAL_UINT64(1, drive.result.watchdog_trips);
        if (protocol == MCT_CAN_NATIVE) {
            TEST_ASSERT_TRUE(drive.sim.plant.input == 0);
            TEST_ASSERT_TRUE(fabs(value(4)) > 0.01); /* the back-emf brakes */
        } else {
            /* what the change of the speed within a tick makes of a held voltage */
            TEST_ASSERT_DOUBLE_WITHIN(1e-3, 0, value(4));
            TEST_ASSERT_DOUBLE_WITHIN(0.02, 0.0274 * value(3), drive.volts);
            TEST_ASSERT_TRUE(drive.devices[0].volts == 0); /* of its own it puts none there */
        }
    }
}

static void test_an_emergency_stop_holds_until_it_is_cleared(void)
{
    for (int protocol = 0; protocol < KINDS; protocol++) {
        if (protocol == MCT_CAN_VESC) {
            continue; /* which has no word for it */
        }
        speak(protocol);
        begin_ready();
        drive_on(5, 100);
        stop();
        tick();
        TEST_ASSERT_FALSE(is_driven());
        TEST_ASSERT_EQUAL_UINT64(100, drive.result.driven_ticks);
        drive_on(5, 500);
        TEST_ASSERT_FALSE(is_driven());
        TEST_ASSERT_EQUAL_UINT64(100, drive.result.driven_ticks);
        TEST_ASSERT_EQUAL_UINT64(1, drive.result.stops);
        TEST_ASSERT_TRUE(host.axes[0].estopped);
        arm();
        tick();
        TEST_ASSERT_FALSE(is_driven()); /* no old command comes to life */
        drive_on(5, 1);
        TEST_ASSERT_TRUE(is_driven());
    }
}

/* Of what arms an ODrive all but the torque, which it remembers. */
static void test_what_was_wanted_before_a_stop_is_forgotten(void)
{
    enum { TORQUE = 0x0E, CLEAR = 0x18 };
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    scene.can_protocol = MCT_CAN_ODRIVE;
    scene.can_watchdog = 0.05;
    begin_ready();
    drive_on(5, 10);
    ticks(100);
    TEST_ASSERT_EQUAL_UINT64(1, drive.result.watchdog_trips);
    const int n = host.protocol->arm(&host.axes[0], frames);
    for (int only_clear = 1; only_clear >= 0; only_clear--) {
        for (int i = 0; i < n; i++) {
            const uint32_t code = frames[i].id & 0x1F;
            if (code != TORQUE && (code == CLEAR || !only_clear)) {
                send(&frames[i]);
            }
        }
        tick();
        TEST_ASSERT_FALSE(is_driven());
        TEST_ASSERT_EQUAL_INT(only_clear ? MCT_CAN_DRIVE_IDLE : MCT_CAN_DRIVE_READY, drive.devices[0].state);
    }
}

static void test_a_native_drive_refuses_commands_that_are_not_newer(void)
{
    mct_can_frame first, second;
    begin_ready();
    host.protocol->command(&host.axes[0], 5, true, &first);
    host.protocol->command(&host.axes[0], -3, true, &second);
    send(&first);
    send(&second);
    tick();
    TEST_ASSERT_EQUAL_DOUBLE(-3, drive.volts);
    send(&second);
    send(&first);
    tick();
    TEST_ASSERT_EQUAL_DOUBLE(-3, drive.volts);
    TEST_ASSERT_EQUAL_UINT64(2, drive.result.old_commands);
    for (int i = 0; i < 200; i++) {
        send(&first); /* nor do they feed the watchdog */
        tick();
    }
    TEST_ASSERT_FALSE(is_driven());
}

static void test_frames_of_a_wrong_form_move_nothing_and_are_counted(void)
{
    mct_can_frame frame;
    begin_ready();
    drive_on(5, 10);
    for (int i = 0; i < 4; i++) {
        host.protocol->command(&host.axes[0], -5, true, &frame);
        frame.length = i == 0 ? 7 : 8;
        frame.remote = i == 1;
        frame.extended = i == 2;
        frame.data[0] = (uint8_t)(frame.data[0] + (i == 3)); /* the checksum does not fit */
        send(&frame);
        tick();
    }
    TEST_ASSERT_EQUAL_DOUBLE(5, drive.volts);
    TEST_ASSERT_EQUAL_UINT64(4, drive.result.refused);
}

static void test_no_command_makes_more_volts_than_the_supply(void)
{
    static const struct {
        int protocol, mode;
        double highest;
    } cases[] = {{MCT_CAN_NATIVE, MCT_CAN_MODE_VOLTAGE, 10},
                 {MCT_CAN_VESC, MCT_CAN_MODE_VOLTAGE, 9.5},
                 {MCT_CAN_VESC, MCT_CAN_MODE_FOC, 5.4848275573014446}, /* 9.5 / sqrt(3) */
                 {MCT_CAN_ODRIVE, MCT_CAN_MODE_VOLTAGE, 10},
                 {MCT_CAN_ODRIVE, MCT_CAN_MODE_TORQUE, 10}};
    for (int n = 0; n < 5; n++) {
        scene.can_protocol = cases[n].protocol;
        scene.can_mode = cases[n].mode;
        begin_ready();
        for (int k = 0; k < 3000; k++) {
            drive_on(k % 600 < 300 ? 1000 : -1000, 1);
            TEST_ASSERT_TRUE(fabs((double)drive.sim.plant.input) <= cases[n].highest * (1 + 1e-6));
        }
        TEST_ASSERT_DOUBLE_WITHIN(cases[n].highest * 1e-6, cases[n].highest, drive.result.highest_volts);
    }
    /* a current as large as you like */
    const mct_can_frame amperes = {
        .id = 0x101, .extended = true, .length = 4, .data = {0x7F, 0xFF, 0xFF, 0xFF}};
    scene.can_protocol = MCT_CAN_VESC;
    scene.can_mode = MCT_CAN_MODE_VOLTAGE;
    begin_ready();
    send(&amperes);
    tick();
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 9.5, drive.volts);
}

static void test_a_torque_becomes_the_current_that_gives_it(void)
{
    const float torque = 0.005F;
    mct_can_frame frame = {.id = 1 << 5 | 0x0E, .length = 8};
    memcpy(frame.data, &torque, sizeof torque); /* as this machine has it: little-endian */
    scene.can_protocol = MCT_CAN_ODRIVE;
    scene.can_mode = MCT_CAN_MODE_TORQUE;
    begin_ready();
    for (int k = 0; k < 200; k++) {
        send(&frame);
        tick();
        if (k > 10) { /* L/R is half a millisecond */
            TEST_ASSERT_DOUBLE_WITHIN(2e-3, 0.005 / 0.0274, value(4));
        }
    }
    TEST_ASSERT_TRUE(fabs(value(3)) > 10);
}

static void test_a_vesc_moves_its_duty_at_its_pace_and_begins_at_zero_after_a_release(void)
{
    scene.can_protocol = MCT_CAN_VESC;
    scene.can_duty_ramp = 20; /* 0.02 a tick */
    scene.can_watchdog = 0.05;
    begin_ready();
    for (int k = 1; k < 100; k++) {
        drive_on(10, 1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10 * (0.02 * k < 0.95 ? 0.02 * k : 0.95), drive.volts);
    }
    for (int k = 1; k < 100; k++) {
        drive_on(-10, 1);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10 * (0.95 - 0.02 * k > -0.95 ? 0.95 - 0.02 * k : -0.95),
                                  drive.volts);
    }
    ticks(100);
    TEST_ASSERT_FALSE(drive.powered);
    drive_on(10, 1);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.2, drive.volts);
}

static void test_the_messages_of_a_vesc_come_slower_than_their_name_in_real_time(void)
{
    const uint32_t status_4 = 0x1001;
    scene.can_protocol = MCT_CAN_VESC;
    for (int lockstep = 0; lockstep < 2; lockstep++) {
        begin();
        drive.lockstep = lockstep;
        ticks(1100);
        TEST_ASSERT_EQUAL_INT(lockstep ? 1100 : 1000, heard_of(status_4, -1));
    }
}

/* --- faults --- */

static void begin_fault(int fault, int protocol)
{
    speak(protocol);
    scene.can_fault = fault;
    scene.can_fault_time = 0.1;
    scene.can_fault_duration = 0.02;
    begin_ready();
}

/* Under volts of its own at each tick, so that each frame differs from the one before. */
static void run_to(uint64_t until)
{
    while (drive.sim.plant.tick < until) {
        command(5);
        tick();
    }
}

static void test_a_fault_of_frames_begins_and_ends_on_its_ticks(void)
{
    static const struct {
        int fault;
        mct_can_verdict verdict;
        int in_place_of; /* frames of feedback that arrive for each one sent */
    } cases[] = {
        {MCT_CAN_FAULT_DROP, MCT_CAN_IS_FEEDBACK, 0},      {MCT_CAN_FAULT_SILENCE, MCT_CAN_IS_FEEDBACK, 0},
        {MCT_CAN_FAULT_DUPLICATE, MCT_CAN_IS_REPEATED, 2}, {MCT_CAN_FAULT_SHORT, MCT_CAN_IS_BAD_LENGTH, 1},
        {MCT_CAN_FAULT_REMOTE, MCT_CAN_IS_REMOTE, 1},      {MCT_CAN_FAULT_FORMAT, MCT_CAN_IS_BAD_FORMAT, 1},
        {MCT_CAN_FAULT_NAN, MCT_CAN_IS_NOT_FINITE, 1}};
    for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
        begin_fault(cases[n].fault, MCT_CAN_NATIVE);
        for (int k = 1; k <= 200; k++) {
            const int before = heard_of(feedback, -1);
            const int verdict = verdicts[cases[n].verdict];
            run_to((uint64_t)k);
            const bool spoilt = k >= 100 && k < 120;
            TEST_ASSERT_EQUAL_INT(spoilt ? cases[n].in_place_of : 1, heard_of(feedback, -1) - before);
            if (cases[n].verdict != MCT_CAN_IS_FEEDBACK) {
                TEST_ASSERT_TRUE((verdicts[cases[n].verdict] > verdict) == spoilt);
            }
        }
        /* both encoders, and what the drives tell of themselves twice a window at most */
        TEST_ASSERT_TRUE(drive.result.spoilt >= 40 && drive.result.spoilt <= 62);
    }
}

static void test_a_fault_of_no_duration_lasts_one_tick(void)
{
    begin_fault(MCT_CAN_FAULT_DROP, MCT_CAN_NATIVE);
    scene.can_fault_duration = 0;
    begin_ready();
    run_to(200);
    TEST_ASSERT_EQUAL_INT(199, heard_of(feedback, -1));
}

static void test_nothing_befalls_what_is_held(void)
{
    scene.can_fault = MCT_CAN_FAULT_SILENCE;
    scene.can_fault_time = 0;
    scene.can_fault_duration = 0.05;
    begin();
    drive.held = true;
    ticks(300);
    TEST_ASSERT_EQUAL_INT(300, heard_of(feedback, -1));
    drive.held = false;
    ticks(100);
    TEST_ASSERT_EQUAL_INT(300 + 51, heard_of(feedback, -1)); /* those of states 50 to 100 */
}

static void test_a_fault_at_the_very_first_tick_befalls_its_command(void)
{
    begin_fault(MCT_CAN_FAULT_DROP_COMMANDS, MCT_CAN_NATIVE);
    scene.can_fault_time = 0;
    begin_ready();
    run_to(21);
    TEST_ASSERT_EQUAL_UINT64(1, drive.result.driven_ticks);
    TEST_ASSERT_EQUAL_UINT64(20, drive.result.last_driven);
}

static void test_commands_that_are_dropped_are_not_heard_but_a_stop_is(void)
{
    begin_fault(MCT_CAN_FAULT_DROP_COMMANDS, MCT_CAN_NATIVE);
    scene.can_fault_duration = 0.3;
    begin_ready();
    run_to(100);
    for (int k = 0; k < 50; k++) {
        command(-5);
        tick();
        TEST_ASSERT_EQUAL_DOUBLE(5, drive.volts);
    }
    TEST_ASSERT_EQUAL_UINT64(50, drive.result.spoilt);
    stop();
    tick();
    TEST_ASSERT_FALSE(is_driven());
    TEST_ASSERT_EQUAL_UINT64(1, drive.result.stops);
    begin_ready();
    run_to(300);
    TEST_ASSERT_EQUAL_UINT64(1, drive.result.watchdog_trips); /* after 100 ms of that */
}

static void test_a_delay_makes_each_frame_late_and_keeps_their_order(void)
{
    begin_fault(MCT_CAN_FAULT_DELAY, MCT_CAN_NATIVE);
    const int first = tick_count;
    run_to(200);
    /* the frame of state k, by its clock, and when it came */
    int expected = 1;
    for (int i = 0; i < heard_count; i++) {
        if (heard[i].frame.id != feedback) {
            continue;
        }
        const int at = heard[i].tick - first;
        const int due = expected < 100 || expected >= 120 ? expected
                        : expected + MCT_CAN_DELAY < 120  ? expected + MCT_CAN_DELAY
                                                          : 120;
        const int clock = heard[i].frame.data[4] | heard[i].frame.data[5] << 8;
        TEST_ASSERT_EQUAL_INT((uint16_t)((first + expected) * DT_US), clock);
        TEST_ASSERT_EQUAL_INT(due, at);
        expected++;
    }
    TEST_ASSERT_EQUAL_INT(201, expected);
    TEST_ASSERT_EQUAL_INT(0, verdicts[MCT_CAN_IS_OLDER]);
}

static void test_reordered_frames_come_behind_those_of_the_next_tick(void)
{
    begin_fault(MCT_CAN_FAULT_REORDER, MCT_CAN_NATIVE);
    run_to(200);
    TEST_ASSERT_EQUAL_INT(200, heard_of(feedback, -1));
    /* ten pairs of two encoders, at most two of what the drive tells of itself */
    TEST_ASSERT_EQUAL_INT(20, verdicts[MCT_CAN_IS_OLDER]);
    TEST_ASSERT_TRUE(drive.result.spoilt >= 20 && drive.result.spoilt <= 22);
}

static void test_an_invalid_encoder_is_told_as_each_protocol_can(void)
{
    for (int protocol = 0; protocol < KINDS; protocol++) {
        const int encoders = 2;
        begin_fault(MCT_CAN_FAULT_NAN, protocol);
        run_to(200);
        const bool has_words = protocol == MCT_CAN_NATIVE || protocol == MCT_CAN_ODRIVE;
        TEST_ASSERT_EQUAL_INT(has_words ? 20 * encoders : 0, verdicts[MCT_CAN_IS_NOT_FINITE]);
        TEST_ASSERT_EQUAL_UINT64(20 * encoders, drive.result.spoilt);
        TEST_ASSERT_EQUAL_UINT64(200, drive.result.driven_ticks); /* the drive itself is well */
    }
}

static void test_an_encoder_that_says_nothing_makes_no_feedback(void)
{
    scene.sensor_fault = MCT_SENSOR_FAULT_SILENT;
    scene.sensor_fault_time = 0.1;
    scene.sensor_fault_duration = 0.02;
    begin_ready();
    run_to(200);
    TEST_ASSERT_EQUAL_INT(180, heard_of(feedback, -1));
}

static void test_a_drive_that_says_nothing_hears_a_stop(void)
{
    begin_fault(MCT_CAN_FAULT_SILENCE, MCT_CAN_NATIVE);
    scene.can_fault_duration = 0.3;
    begin_ready();
    run_to(150);
    TEST_ASSERT_TRUE(is_driven());
    stop();
    run_to(151);
    TEST_ASSERT_FALSE(is_driven());
    TEST_ASSERT_EQUAL_UINT64(1, drive.result.stops);
    TEST_ASSERT_EQUAL_UINT64(0, drive.result.watchdog_trips); /* it was fed all the time */
}

static void test_a_reboot_is_dark_then_idle_with_counters_at_zero(void)
{
    for (int protocol = 0; protocol < KINDS; protocol++) {
        begin_fault(MCT_CAN_FAULT_REBOOT, protocol);
        run_to(100);
        const int before = heard_count;
        const double turned = value(1);
        TEST_ASSERT_TRUE(fabs(turned) > 0.1);
        TEST_ASSERT_TRUE(is_driven());
        const uint64_t commands = drive.result.commands;
        stop();
        run_to(150);
        TEST_ASSERT_EQUAL_INT(before, heard_count); /* 50 ms, though the fault is shorter */
        TEST_ASSERT_EQUAL_UINT64(commands, drive.result.commands);
        TEST_ASSERT_EQUAL_UINT64(0, drive.result.stops);
        TEST_ASSERT_FALSE(drive.powered);
        TEST_ASSERT_EQUAL_UINT64(100, drive.result.driven_ticks);
        const int64_t counted = drive.boards[0].position[0];
        TEST_ASSERT_TRUE(counted > 100 || counted < -100);
        ticks(1);
        TEST_ASSERT_TRUE(heard_count > before);
        TEST_ASSERT_TRUE(drive.boards[0].position[0] < 100 && drive.boards[0].position[0] > -100);
        TEST_ASSERT_DOUBLE_WITHIN(0.02, 0, drive.devices[0].turns);
        TEST_ASSERT_TRUE(drive.devices[0].restarted);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_IDLE, drive.devices[0].state);
        drive_on(5, 100);
        TEST_ASSERT_TRUE(is_driven() == (protocol == MCT_CAN_VESC)); /* the others wait to be asked */
        if (protocol == MCT_CAN_VESC) {
            continue;
        }
        TEST_ASSERT_EQUAL_UINT32(1, host.axes[0].restarts);
        arm();
        drive_on(5, 1);
        TEST_ASSERT_TRUE(is_driven());
        TEST_ASSERT_FALSE(drive.devices[0].restarted);
    }
}

static void test_an_emergency_stop_on_the_bus_is_one_event_that_lasts_until_it_is_cleared(void)
{
    for (int protocol = 0; protocol < KINDS; protocol++) {
        begin_fault(MCT_CAN_FAULT_ESTOP, protocol);
        run_to(100);
        TEST_ASSERT_TRUE(is_driven());
        run_to(101);
        TEST_ASSERT_FALSE(is_driven());
        run_to(300);
        TEST_ASSERT_TRUE(is_driven() == (protocol == MCT_CAN_VESC)); /* which has no word for it */
        if (protocol == MCT_CAN_VESC) {
            TEST_ASSERT_EQUAL_UINT64(280, drive.result.driven_ticks);
            continue;
        }
        TEST_ASSERT_EQUAL_INT(protocol == MCT_CAN_NATIVE ? 1 : 0, verdicts[MCT_CAN_IS_STOP]);
        TEST_ASSERT_TRUE(host.axes[0].estopped);
        TEST_ASSERT_EQUAL_UINT64(1, drive.result.stops);
        TEST_ASSERT_EQUAL_UINT64(100, drive.result.driven_ticks);
        arm();
        drive_on(5, 1);
        TEST_ASSERT_TRUE(is_driven());
    }
}

static void test_an_error_stops_the_motor_and_can_be_cleared_once_it_is_over(void)
{
    for (int protocol = 0; protocol < KINDS; protocol++) {
        begin_fault(MCT_CAN_FAULT_ERROR, protocol);
        run_to(100);
        TEST_ASSERT_TRUE(is_driven());
        run_to(110);
        TEST_ASSERT_FALSE(is_driven());
        if (protocol >= MCT_CAN_ODRIVE) {
            TEST_ASSERT_FALSE(drive.devices[0].wants_ready); /* an error disarms its axis */
        }
        arm();
        run_to(119);
        TEST_ASSERT_FALSE(is_driven()); /* it is there yet */
        run_to(300);
        TEST_ASSERT_TRUE(is_driven() == (protocol == MCT_CAN_VESC));
        if (protocol != MCT_CAN_VESC) {
            TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_FAULTY, host.axes[0].state);
            TEST_ASSERT_TRUE(host.axes[0].error != 0);
            TEST_ASSERT_EQUAL_UINT64(100, drive.result.driven_ticks);
            arm();
            drive_on(5, 1);
            TEST_ASSERT_TRUE(is_driven());
        }
    }
}

/* --- waiting for commands --- */

static void test_waiting_ends_with_a_command_and_with_nothing_else(void)
{
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    scene.can_protocol = MCT_CAN_ODRIVE;
    begin();
    TEST_ASSERT_FALSE(mct_can_drive_wait(&drive, DT_US));
    const int n = host.protocol->arm(&host.axes[0], frames);
    for (int i = 0; i < n; i++) {
        send(&frames[i]);
        const bool is_torque = (frames[i].id & 0x1F) == 0x0E;
        TEST_ASSERT_TRUE(mct_can_drive_wait(&drive, DT_US) == is_torque);
    }
    tick();
    TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_READY, drive.devices[0].state); /* what came meanwhile was heard */
    /* one that a fault swallows has come all the same */
    scene.can_fault = MCT_CAN_FAULT_DROP_COMMANDS;
    scene.can_fault_time = 0;
    begin_ready();
    tick();
    command(5);
    TEST_ASSERT_TRUE(mct_can_drive_wait(&drive, DT_US));
    tick();
    TEST_ASSERT_FALSE(is_driven());
}

static void test_closing_leaves_no_volts(void)
{
    mct_can_frame frame = {.id = 1};
    begin_ready();
    drive_on(5, 10);
    mct_can_drive_close(&drive);
    TEST_ASSERT_TRUE(drive.volts == 0 && !drive.powered && drive.sim.input == 0);
    TEST_ASSERT_FALSE(drive.transport.ops->receive(drive.transport.context, &frame));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_native_drive_gives_counts_and_motion_of_the_simulated_hal_to_the_bit);
    RUN_TEST(test_an_odrive_0_5_gives_the_counts_of_the_sensors_to_the_bit_armed_or_not);
    RUN_TEST(test_turns_of_the_others_are_the_counts_that_the_sensors_gave);
    RUN_TEST(test_a_rate_is_as_late_as_the_counts_and_whole_counts_a_second);
    RUN_TEST(test_a_held_mechanism_does_not_move_and_its_drives_talk);
    RUN_TEST(test_without_an_owner_it_is_let_go_when_the_motors_drive_is_ready);
    RUN_TEST(test_the_watchdog_takes_the_volts_away_within_its_time);
    RUN_TEST(test_without_a_watchdog_an_odrive_goes_on_for_ever);
    RUN_TEST(test_a_native_drive_has_the_watchdog_that_it_is_told);
    RUN_TEST(test_a_watchdog_that_a_native_drive_cannot_be_told_is_refused);
    RUN_TEST(test_any_frame_to_its_axis_feeds_the_watchdog_of_an_odrive);
    RUN_TEST(test_what_stops_a_native_motor_shorts_it_and_what_stops_the_others_lets_it_run_free);
    RUN_TEST(test_an_emergency_stop_holds_until_it_is_cleared);
    RUN_TEST(test_what_was_wanted_before_a_stop_is_forgotten);
    RUN_TEST(test_a_native_drive_refuses_commands_that_are_not_newer);
    RUN_TEST(test_frames_of_a_wrong_form_move_nothing_and_are_counted);
    RUN_TEST(test_no_command_makes_more_volts_than_the_supply);
    RUN_TEST(test_a_torque_becomes_the_current_that_gives_it);
    RUN_TEST(test_a_vesc_moves_its_duty_at_its_pace_and_begins_at_zero_after_a_release);
    RUN_TEST(test_the_messages_of_a_vesc_come_slower_than_their_name_in_real_time);
    RUN_TEST(test_a_fault_of_frames_begins_and_ends_on_its_ticks);
    RUN_TEST(test_a_fault_of_no_duration_lasts_one_tick);
    RUN_TEST(test_nothing_befalls_what_is_held);
    RUN_TEST(test_a_fault_at_the_very_first_tick_befalls_its_command);
    RUN_TEST(test_commands_that_are_dropped_are_not_heard_but_a_stop_is);
    RUN_TEST(test_a_delay_makes_each_frame_late_and_keeps_their_order);
    RUN_TEST(test_reordered_frames_come_behind_those_of_the_next_tick);
    RUN_TEST(test_an_invalid_encoder_is_told_as_each_protocol_can);
    RUN_TEST(test_an_encoder_that_says_nothing_makes_no_feedback);
    RUN_TEST(test_a_drive_that_says_nothing_hears_a_stop);
    RUN_TEST(test_a_reboot_is_dark_then_idle_with_counters_at_zero);
    RUN_TEST(test_an_emergency_stop_on_the_bus_is_one_event_that_lasts_until_it_is_cleared);
    RUN_TEST(test_an_error_stops_the_motor_and_can_be_cleared_once_it_is_over);
    RUN_TEST(test_waiting_ends_with_a_command_and_with_nothing_else);
    RUN_TEST(test_closing_leaves_no_volts);
    return UNITY_END();
}

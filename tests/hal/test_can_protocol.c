/* What drives and host say to each other: vectors of the drives' documents, rules of hal/socketcan. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "hal/socketcan/protocol.h"
#include "support/random.h"
#include "unity.h"

#define TICK 1000 /* us */

/* In the order of can.protocol, older firmware behind. */
enum { KINDS = 4 };
static const mct_can_protocol *const kinds[KINDS] = {&mct_can_native, &mct_can_vesc, &mct_can_odrive,
                                                     &mct_can_odrive_0_5};

static mct_scene scene;
static mct_can_axis axis;
static mct_can_device device;

void setUp(void)
{
}

void tearDown(void)
{
}

/* A host's axis and the drive that it speaks to, both fresh. */
static void begin(const mct_can_protocol *protocol, uint8_t node)
{
    memset(&scene, 0, sizeof scene);
    scene.can_pole_pairs = 7;
    scene.can_watchdog = 0.1;
    scene.dt = 1e-3;
    memset(&axis, 0, sizeof axis);
    axis.protocol = protocol;
    axis.scene = &scene;
    axis.watchdog_ms = mct_can_watchdog_ms(scene.can_watchdog);
    axis.node = node;
    axis.roles = MCT_CAN_OF_MOTOR | MCT_CAN_OF_ENCODER;
    axis.motor =
        (mct_can_motor){.supply = 12, .resistance = 2, .torque_per_ampere = 0.05, .emf_per_turn = 0.25};
    axis.encoders[0].used = true;
    axis.encoders[0].counts_per_turn = 4096;
    if (protocol->has_spare) {
        axis.roles |= MCT_CAN_OF_SPARE;
        axis.encoders[1].used = true;
        axis.encoders[1].counts_per_turn = 4096;
    }
    memset(&device, 0, sizeof device);
    device.protocol = protocol;
    device.scene = &scene;
    device.node = node;
    device.roles = axis.roles;
    device.state = MCT_CAN_DRIVE_READY;
    device.supply = 12;
    device.counts_per_turn = 4096;
}

static int message_of(const char *name, bool from_drive)
{
    const mct_can_protocol *protocol = axis.protocol;
    for (int i = 0; i < protocol->message_count; i++) {
        if (strcmp(protocol->messages[i].name, name) == 0 && protocol->messages[i].from_drive == from_drive) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE(name);
    return -1;
}

static mct_can_frame frame_of(uint32_t id, bool extended, int length, const char *bytes)
{
    mct_can_frame frame = {.id = id, .extended = extended, .length = (uint8_t)length};
    memcpy(frame.data, bytes, (size_t)length);
    return frame;
}

static mct_can_frame reported(const char *name, int64_t time_us)
{
    mct_can_frame frame;
    TEST_ASSERT_TRUE(device.protocol->report(&device, message_of(name, true), &frame));
    frame.time_us = time_us;
    return frame;
}

static mct_can_verdict hear(const mct_can_frame *frame)
{
    return axis.protocol->hear(&axis, frame);
}

/* The drive says something, the host hears it. */
static mct_can_verdict tell(const char *name, int64_t time_us)
{
    const mct_can_frame frame = reported(name, time_us);
    return hear(&frame);
}

static mct_can_frame commanded(double volts, bool enable)
{
    mct_can_frame frame;
    axis.protocol->command(&axis, (mct_real)volts, enable, &frame);
    return frame;
}

static mct_can_verdict obey(const mct_can_frame *frame)
{
    return device.protocol->obey(&device, frame);
}

static mct_can_verdict order(double volts, bool enable)
{
    const mct_can_frame frame = commanded(volts, enable);
    return obey(&frame);
}

static void assert_bytes(const char *expected, const mct_can_frame *frame)
{
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, frame->data, 8);
}

/* --- all protocols --- */

static void test_protocols_stand_in_the_order_of_the_scenes_choices(void)
{
    TEST_ASSERT_EQUAL_PTR(&mct_can_native, mct_can_protocols[MCT_CAN_NATIVE]);
    TEST_ASSERT_EQUAL_PTR(&mct_can_vesc, mct_can_protocols[MCT_CAN_VESC]);
    TEST_ASSERT_EQUAL_PTR(&mct_can_odrive, mct_can_protocols[MCT_CAN_ODRIVE]);
}

static void test_firmware_chooses_between_the_protocols_of_an_odrive_alone(void)
{
    for (int protocol = 0; protocol < MCT_CAN_PROTOCOL_COUNT; protocol++) {
        memset(&scene, 0, sizeof scene);
        scene.can_protocol = protocol;
        TEST_ASSERT_EQUAL_PTR(mct_can_protocols[protocol], mct_can_protocol_of(&scene));
        scene.can_firmware = MCT_CAN_FIRMWARE_0_5;
        TEST_ASSERT_EQUAL_PTR(protocol == MCT_CAN_ODRIVE ? &mct_can_odrive_0_5 : mct_can_protocols[protocol],
                              mct_can_protocol_of(&scene));
        TEST_ASSERT_EQUAL_STRING(mct_can_protocols[protocol]->name, mct_can_protocol_of(&scene)->name);
    }
}

/* Nodes 0 to 63, messages that go the same way. */
static void test_no_two_messages_of_a_protocol_share_an_identifier(void)
{
    for (int p = 0; p < KINDS; p++) {
        const mct_can_protocol *protocol = kinds[p];
        TEST_ASSERT_TRUE(protocol->message_count <= MCT_CAN_MAX_MESSAGES);
        static bool taken[2][1 << 16];
        memset(taken, 0, sizeof taken);
        for (int i = 0; i < protocol->message_count; i++) {
            for (int node = 0; node < 64; node++) {
                const uint32_t id = protocol->identifier(protocol->messages[i].code, (uint8_t)node);
                TEST_ASSERT_TRUE(id < (protocol->extended ? 1u << 16 : 1u << 11));
                TEST_ASSERT_FALSE(taken[protocol->messages[i].from_drive][id]);
                taken[protocol->messages[i].from_drive][id] = true;
            }
        }
    }
}

/* Share of the bus at a tick of 1 ms that the messages of one axis take. */
static void load_of(const mct_can_protocol *protocol, double bitrate, double *nominal, double *stuffed)
{
    *nominal = *stuffed = 0;
    for (int i = 0; i < protocol->message_count; i++) {
        const mct_can_message *message = &protocol->messages[i];
        if (message->period >= 0 && !(message->of & (MCT_CAN_OF_SPARE | MCT_CAN_OF_TORQUE))) {
            const double period = message->period > 0 ? message->period : 1e-3;
            *nominal += mct_can_nominal_bits(protocol->extended, message->length) / period / bitrate;
            *stuffed += mct_can_stuffed_bits(protocol->extended, message->length) / period / bitrate;
        }
    }
}

/* Vectors: the classic lengths of a frame; the shares that the makers' messages take, to the percent. */
static void test_frames_are_as_long_as_the_standard_says(void)
{
    double nominal, stuffed;
    TEST_ASSERT_EQUAL_INT(111, mct_can_nominal_bits(false, 8));
    TEST_ASSERT_EQUAL_INT(135, mct_can_stuffed_bits(false, 8));
    TEST_ASSERT_EQUAL_INT(131, mct_can_nominal_bits(true, 8));
    TEST_ASSERT_EQUAL_INT(160, mct_can_stuffed_bits(true, 8));
    TEST_ASSERT_EQUAL_INT(47, mct_can_nominal_bits(false, 0));
    TEST_ASSERT_EQUAL_INT(55, mct_can_stuffed_bits(false, 0));
    load_of(&mct_can_odrive, 500e3, &nominal, &stuffed);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.45, nominal);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.54, stuffed);
    load_of(&mct_can_odrive_0_5, 500e3, &nominal, &stuffed); /* counts in place of estimates */
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.45, nominal);
    load_of(&mct_can_odrive, 1e6, &nominal, &stuffed);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.22, nominal);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.27, stuffed);
    load_of(&mct_can_vesc, 500e3, &nominal, &stuffed);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.49, nominal);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.59, stuffed);
}

static bool is_stop(const mct_can_message *message)
{
    return strstr(message->name, "Estop") != NULL;
}

/* A frame is refused with this verdict, and nothing but the verdict tells that it came. */
static void refuses(const mct_can_frame *frame, mct_can_verdict verdict)
{
    const mct_can_axis before = axis;
    TEST_ASSERT_EQUAL_INT(verdict, hear(frame));
    TEST_ASSERT_EQUAL_MEMORY(&before, &axis, sizeof axis);
}

static void test_the_host_refuses_wrong_length_format_and_remote_frames(void)
{
    for (int p = 0; p < KINDS; p++) {
        begin(kinds[p], 5);
        for (int i = 0; i < axis.protocol->message_count; i++) {
            const mct_can_message *message = &axis.protocol->messages[i];
            mct_can_frame good;
            device.estopped = is_stop(message);
            if (!message->from_drive || !device.protocol->report(&device, i, &good)) {
                continue;
            }
            TEST_ASSERT_EQUAL_UINT8(message->length, good.length);
            for (int length = 0; length <= 8; length++) {
                mct_can_frame frame = good;
                frame.length = (uint8_t)length;
                if (length != good.length && !is_stop(message)) {
                    refuses(&frame, MCT_CAN_IS_BAD_LENGTH);
                }
            }
            mct_can_frame frame = good;
            frame.extended = !good.extended;
            refuses(&frame, MCT_CAN_IS_BAD_FORMAT);
            frame = good;
            frame.remote = true;
            refuses(&frame, MCT_CAN_IS_REMOTE);
            frame = good;
            frame.id = axis.protocol->identifier(message->code, 6);
            refuses(&frame, MCT_CAN_IS_FOREIGN);
            TEST_ASSERT_TRUE(hear(&good) <= MCT_CAN_IS_STOP);
        }
    }
}

static void test_the_drive_refuses_wrong_length_format_and_remote_frames(void)
{
    for (int p = 0; p < KINDS; p++) {
        begin(kinds[p], 5);
        const mct_can_frame good = commanded(3, true);
        /* An ODrive needs the float alone: its documents' examples send no padding. */
        const int least = p >= MCT_CAN_ODRIVE ? 4 : good.length;
        const mct_can_device before = device;
        for (int length = 0; length <= 8; length++) {
            mct_can_frame frame = good;
            frame.length = (uint8_t)length;
            if (length < least || length > good.length) {
                TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_BAD_LENGTH, obey(&frame));
            }
        }
        mct_can_frame frame = good;
        frame.extended = !good.extended;
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_BAD_FORMAT, obey(&frame));
        frame = good;
        frame.remote = true;
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_REMOTE, obey(&frame));
        axis.node = 6;
        frame = commanded(3, true);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FOREIGN, obey(&frame));
        axis.node = 5;
        refuses(&good, MCT_CAN_IS_FOREIGN); /* another host's command, to a host */
        TEST_ASSERT_EQUAL_MEMORY(&before, &device, sizeof device);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, obey(&good));
    }
}

/* Whatever comes: nothing undefined (the sanitizers look), numbers stay finite, refusals change nothing. */
static void test_any_frame_is_survived(void)
{
    test_random numbers = {20240517};
    for (int p = 0; p < KINDS; p++) {
        for (int options = 0; options < 4; options++) {
            begin(kinds[p], 3);
            axis.roles |= options & 1 ? MCT_CAN_OF_TORQUE : 0;
            scene.can_mode = options & 2 ? MCT_CAN_MODE_TORQUE : MCT_CAN_MODE_VOLTAGE;
            axis.encoders[0].counts_per_turn = -1e9;
            int64_t time_us = 0;
            for (int k = 0; k < 50000; k++) {
                const int i = (int)(random_bits(&numbers) % (uint64_t)axis.protocol->message_count);
                const mct_can_message *message = &axis.protocol->messages[i];
                const uint64_t bits = random_bits(&numbers) << (random_bits(&numbers) % 64);
                mct_can_frame frame = {.id = axis.protocol->identifier(message->code, 3),
                                       .extended = axis.protocol->extended,
                                       .length = message->length};
                if (random_bits(&numbers) % 8 == 0) {
                    frame.length = (uint8_t)(random_bits(&numbers) % 9);
                }
                memcpy(frame.data, &bits, frame.length);
                time_us += (int64_t)(random_bits(&numbers) % 100000) - 1000;
                frame.time_us = time_us;
                const mct_can_axis before = axis;
                if (hear(&frame) > MCT_CAN_IS_REQUEST) {
                    TEST_ASSERT_EQUAL_MEMORY(&before, &axis, sizeof axis);
                }
                obey(&frame);
                TEST_ASSERT_TRUE(isfinite(axis.rate) && isfinite(mct_can_bus_voltage(&axis)));
                TEST_ASSERT_TRUE(isfinite(axis.encoders[0].turns) && isfinite(device.value));
                TEST_ASSERT_TRUE(isfinite(axis.change) && isfinite(axis.encoders[0].fastest));
                device.turns = device.value * 1e20;
                device.counts[0] = (int32_t)(uint32_t)bits;
                device.counts_per_turn = (int32_t)(bits >> 33);
                device.has_driven = true;
                device.rate = axis.rate * 1e30;
                device.amperes = device.volts = device.temperature = -device.turns;
                device.supply = mct_can_bus_voltage(&axis);
                for (int j = 0; j < axis.protocol->message_count; j++) {
                    axis.protocol->report(&device, j, &frame);
                }
                commanded(device.value, true);
            }
        }
    }
}

static void test_a_command_that_is_not_finite_or_disabled_asks_for_nothing(void)
{
    const double values[] = {NAN, INFINITY, -INFINITY, 5};
    for (int p = 0; p < KINDS; p++) {
        for (int mode = MCT_CAN_MODE_VOLTAGE; mode <= MCT_CAN_MODE_TORQUE; mode++) {
            for (int i = 0; i < 4; i++) {
                begin(kinds[p], 1);
                scene.can_mode = mode;
                axis.rate = 3;
                TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, order(values[i], i < 3));
                TEST_ASSERT_TRUE(device.value == 0);
            }
        }
    }
}

static void test_an_axis_without_a_motor_is_never_powered(void)
{
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    for (int p = 0; p < KINDS; p++) {
        begin(kinds[p], 1);
        axis.roles = MCT_CAN_OF_ENCODER;
        axis.state = MCT_CAN_DRIVE_READY;
        const int count = axis.protocol->arm(&axis, frames);
        /* what was known of it before counts no more, where it tells at all */
        TEST_ASSERT_EQUAL_INT(p == MCT_CAN_VESC ? MCT_CAN_DRIVE_READY : MCT_CAN_DRIVE_UNKNOWN, axis.state);
        for (int i = 0; i < count; i++) {
            obey(&frames[i]);
        }
        TEST_ASSERT_FALSE(device.wants_ready);
        TEST_ASSERT_EQUAL_INT(p == MCT_CAN_VESC ? 0 : 1, count);
        TEST_ASSERT_EQUAL(p != MCT_CAN_VESC, device.wants_clear);
        TEST_ASSERT_EQUAL_INT(0, axis.protocol->stop(&axis, frames));
    }
}

static void test_armed_then_stopped_a_drive_is_ready_then_at_zero(void)
{
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    for (int p = 0; p < KINDS; p++) {
        begin(kinds[p], 1);
        int count = axis.protocol->arm(&axis, frames);
        for (int i = 0; i < count; i++) {
            obey(&frames[i]);
        }
        TEST_ASSERT_TRUE(device.value == 0);
        order(4, true);
        TEST_ASSERT_TRUE(device.wants_ready);
        TEST_ASSERT_TRUE(device.value > 0);
        device.wants_clear = false;
        count = axis.protocol->stop(&axis, frames);
        TEST_ASSERT_TRUE(count >= 1 && count <= MCT_CAN_MAX_BURST);
        for (int i = 0; i < count; i++) {
            const mct_can_verdict verdict = obey(&frames[i]);
            TEST_ASSERT_TRUE(verdict <= MCT_CAN_IS_REQUEST);
            TEST_ASSERT_TRUE(device.value == 0); /* from the first frame on */
        }
        if (p == MCT_CAN_NATIVE) {
            TEST_ASSERT_EQUAL_HEX8(1, frames[0].data[0]); /* the reason "host" */
        }
        TEST_ASSERT_FALSE(device.wants_clear);
        if (p != MCT_CAN_VESC) { /* which knows neither */
            TEST_ASSERT_TRUE(device.wants_stop);
            TEST_ASSERT_FALSE(device.wants_ready);
        }
    }
}

/* --- native --- */

/* By the table that the polynomial makes; held against the check value of the catalogue of CRCs. */
static uint8_t crc_by_table(const uint8_t *bytes, int count)
{
    uint8_t table[256];
    uint8_t crc = 0xFF;
    for (int i = 0; i < 256; i++) {
        int value = i;
        for (int bit = 0; bit < 8; bit++) {
            value = value & 0x80 ? (value << 1) ^ 0x11D : value << 1;
        }
        table[i] = (uint8_t)value;
    }
    for (int i = 0; i < count; i++) {
        crc = table[crc ^ bytes[i]];
    }
    return crc ^ 0xFF;
}

static void test_native_commands_carry_the_checksum_of_sae_j1850(void)
{
    TEST_ASSERT_EQUAL_HEX8(0x4B, crc_by_table((const uint8_t *)"123456789", 9));
    test_random numbers = {5};
    for (int k = 0; k < 1000; k++) {
        begin(&mct_can_native, (uint8_t)(k % 64));
        const mct_can_frame frame = commanded(random_in(&numbers, -50, 50), k % 3 > 0);
        uint8_t bytes[9] = {(uint8_t)frame.id, (uint8_t)(frame.id >> 8)};
        memcpy(bytes + 2, frame.data, 7);
        TEST_ASSERT_EQUAL_HEX8(crc_by_table(bytes, 9), frame.data[7]);
    }
}

static void test_native_drive_refuses_a_command_with_any_bit_wrong(void)
{
    begin(&mct_can_native, 1);
    const mct_can_frame good = commanded(7.5, true);
    const mct_can_device before = device;
    for (int bit = 0; bit < 64; bit++) {
        mct_can_frame frame = good;
        frame.data[bit / 8] ^= (uint8_t)(1 << bit % 8);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_BAD_CHECKSUM, obey(&frame));
    }
    /* A command for node 1 under the identifier of node 2. */
    mct_can_frame frame = good;
    frame.id++;
    device.node = 2;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_BAD_CHECKSUM, obey(&frame));
    device.node = 1;
    TEST_ASSERT_EQUAL_MEMORY(&before, &device, sizeof device);
}

/* Layout by hand from native.dbc: -1.5 V is -1500 = 0xFFFFFA24 mV. */
static void test_native_command_of_the_document(void)
{
    begin(&mct_can_native, 1);
    axis.sequence = 41;
    const mct_can_frame frame = commanded(-1.5, true);
    TEST_ASSERT_EQUAL_HEX32(0x101, frame.id);
    TEST_ASSERT_FALSE(frame.extended);
    TEST_ASSERT_EQUAL_UINT8(8, frame.length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY("\x24\xFA\xFF\xFF\x2A\x11\x64", frame.data, 7);
}

/* The supervisor rounds to millivolts, so the drive must get its very bits: on a bus as in the simulation. */
static void test_native_carries_every_millivolt_in_the_same_bits(void)
{
    for (int inverted = 0; inverted < 2; inverted++) {
        begin(&mct_can_native, 1);
        axis.motor.inverted = inverted != 0;
        for (int32_t k = -100000; k <= 100000; k++) {
            const mct_real volts = (mct_real)k / (mct_real)1000;
            TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, order((double)volts, true));
            const mct_real back = (mct_real)device.value;
            TEST_ASSERT_TRUE(back == (inverted ? -volts : volts));
            /* the same by double arithmetic, as another drive may compute */
            TEST_ASSERT_TRUE((mct_real)((double)k / 1000) == volts);
        }
    }
}

static void test_native_voltage_is_rounded_to_the_nearest_millivolt_and_clamped(void)
{
    begin(&mct_can_native, 1);
    static const struct {
        double volts, millivolts;
    } cases[] = {{0.0004, 0},      {0.0625, 63},       {-0.0625, -63},    {0.0006, 1},
                 {-0.0006, -1},    {-0.0004, 0},       {40, 40000},       {-40, -40000},
                 {1e7, INT32_MAX}, {-1e7, -INT32_MAX}, {1e30, INT32_MAX}, {-1e30, -INT32_MAX},
                 {3e38, INT32_MAX}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const mct_can_frame frame = commanded(cases[i].volts, true);
        int32_t millivolts;
        memcpy(&millivolts, frame.data, 4);
        TEST_ASSERT_TRUE(cases[i].millivolts == millivolts);
    }
}

static void test_native_timeout_is_within_what_the_frame_holds(void)
{
    static const struct {
        double seconds;
        int milliseconds;
    } cases[] = {{0.1, 100}, {0.005, 5},    {0.001, 5}, {0.255, 255},
                 {2, 255},   {0.0997, 100}, {0, 0},     {1e-4, 5}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        begin(&mct_can_native, 1);
        axis.watchdog_ms = mct_can_watchdog_ms(cases[i].seconds);
        const mct_can_frame frame = commanded(1, true);
        TEST_ASSERT_EQUAL_UINT8(cases[i].milliseconds, frame.data[6]);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, obey(&frame));
        TEST_ASSERT_EQUAL_INT(cases[i].milliseconds, device.watchdog_ms);
    }
}

/* What no host sends; layout by hand: byte 6. */
static void test_native_drive_is_told_no_watchdog_by_zero_and_five_milliseconds_at_least(void)
{
    for (int timeout = 0; timeout < 256; timeout++) {
        begin(&mct_can_native, 1);
        mct_can_frame frame = commanded(5, true);
        frame.data[6] = (uint8_t)timeout;
        uint8_t bytes[9] = {(uint8_t)frame.id, (uint8_t)(frame.id >> 8)};
        memcpy(bytes + 2, frame.data, 7);
        frame.data[7] = crc_by_table(bytes, 9);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, obey(&frame));
        TEST_ASSERT_EQUAL_UINT32(timeout > 0 && timeout < 5 ? 5 : timeout, device.watchdog_ms);
    }
}

/* Over several turns of the 8 bits. */
static void test_native_drive_takes_newer_commands_only(void)
{
    begin(&mct_can_native, 1);
    axis.sequence = 200; /* the first one may have any number */
    const mct_can_frame old = commanded(1, true);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, obey(&old));
    for (uint32_t k = 0; k < 700; k++) {
        const mct_can_frame lost = commanded(9, true);
        const mct_can_frame next = commanded(2, true);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, obey(&next));
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_REPEATED, obey(&next));
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_OLDER, obey(&lost));
        TEST_ASSERT_TRUE(device.value == (double)(mct_real)2);
        TEST_ASSERT_EQUAL_UINT32(2 * (k + 1), device.old_commands);
    }
    TEST_ASSERT_EQUAL_UINT32(701, device.commands);
}

/* After 128 lost commands the next one looks older. */
static void test_native_drive_ceases_whatever_the_sequence(void)
{
    begin(&mct_can_native, 1);
    for (int lost = 1; lost < 256; lost++) {
        TEST_ASSERT_TRUE(order(5, true) == MCT_CAN_IS_COMMAND && device.value == 5);
        axis.sequence = (uint8_t)(axis.sequence + lost);
        const mct_can_verdict verdict = order(0, false);
        TEST_ASSERT_EQUAL_INT(lost == 255 ? MCT_CAN_IS_REPEATED : MCT_CAN_IS_COMMAND, verdict);
        TEST_ASSERT_TRUE(lost == 255 || device.value == 0);
    }
}

static void test_native_drive_takes_any_sequence_after_a_gap_or_with_a_clear(void)
{
    begin(&mct_can_native, 1);
    axis.sequence = 99;
    order(1, true);
    axis.sequence = 9;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_OLDER, order(1, true));
    device.watchdog_expired = true;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, order(1, true));
    device.watchdog_expired = false;
    axis.sequence = 200; /* a host that has started anew */
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_OLDER, order(1, true));
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    TEST_ASSERT_EQUAL_INT(1, axis.protocol->arm(&axis, frames));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, obey(&frames[0]));
    TEST_ASSERT_TRUE(device.wants_clear && device.wants_ready && device.value == 0);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_UNKNOWN, axis.state);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, order(1, true));
}

static void test_native_voltage_needs_its_mode_and_its_bit(void)
{
    for (int bits = 0; bits < 32; bits++) {
        begin(&mct_can_native, 1);
        mct_can_frame frame = commanded(5, true);
        frame.data[5] = (uint8_t)bits;
        uint8_t bytes[9] = {(uint8_t)frame.id, (uint8_t)(frame.id >> 8)};
        memcpy(bytes + 2, frame.data, 7);
        frame.data[7] = crc_by_table(bytes, 9);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, obey(&frame));
        TEST_ASSERT_TRUE(device.value == (bits == 0x11 ? 5 : 0));
        TEST_ASSERT_EQUAL(bits == 0x12 || bits == 0x02, device.wants_clear);
        TEST_ASSERT_EQUAL(bits > 0x10, device.wants_ready);
    }
}

static void test_native_plain_commands_clear_nothing(void)
{
    begin(&mct_can_native, 1);
    order(1, true);
    order(1, false);
    TEST_ASSERT_FALSE(device.wants_clear);
    TEST_ASSERT_FALSE(device.wants_ready);
}

static void test_native_echo_is_the_sequence_of_the_newest_command(void)
{
    begin(&mct_can_native, 1);
    for (int k = 0; k < 300; k++) {
        order(1, true);
        device.time_us = (uint64_t)(k * TICK);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Drive_Fb", k * TICK));
        TEST_ASSERT_EQUAL_UINT8(axis.sequence, axis.encoders[0].echo);
    }
}

/* All of 32 bits, in integers: also the smallest one, which has no opposite. */
static void test_native_counts_are_the_drives_or_their_opposite_modulo_32_bits(void)
{
    static const int32_t values[] = {0, 1, -1, 4096, INT32_MAX, INT32_MIN, INT32_MIN + 1, 123456789};
    for (int opposite = 0; opposite < 2; opposite++) {
        begin(&mct_can_native, 1);
        axis.encoders[0].counts_per_turn = opposite ? -4096 : 4096;
        for (int i = 0; i < 8; i++) {
            device.time_us += TICK;
            device.counts[0] = values[i];
            device.counts[1] = ~values[i];
            TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Drive_Fb", i * TICK));
            TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Drive_Fb2", i * TICK));
            const uint32_t expected = opposite ? 0u - (uint32_t)values[i] : (uint32_t)values[i];
            TEST_ASSERT_EQUAL_HEX32(expected, (uint32_t)axis.encoders[0].counts);
            TEST_ASSERT_EQUAL_INT32(~values[i], axis.encoders[1].counts);
        }
        TEST_ASSERT_EQUAL_UINT32(8, axis.encoders[0].updates);
    }
}

static void test_native_feedback_twice_counts_once_and_older_feedback_not_at_all(void)
{
    begin(&mct_can_native, 1);
    for (uint64_t k = 1; k < 200; k++) { /* the drive's clock wraps three times */
        const int64_t now = (int64_t)k * TICK;
        device.counts[0] = -1;
        device.time_us = k * TICK - 400;
        const mct_can_frame late = reported("Drive_Fb", now + 10);
        device.counts[0] = (int32_t)k;
        device.time_us = k * TICK;
        const mct_can_frame news = reported("Drive_Fb", now);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, hear(&news));
        refuses(&news, MCT_CAN_IS_REPEATED);
        refuses(&late, MCT_CAN_IS_OLDER);
        TEST_ASSERT_EQUAL_INT32(k, axis.encoders[0].counts);
        TEST_ASSERT_EQUAL_UINT32(k, axis.encoders[0].updates);
        TEST_ASSERT_EQUAL_INT64(now, axis.encoders[0].time_us);
    }
    /* After a silence nobody knows what the 16 bits mean: taken. */
    device.time_us -= 20000;
    mct_can_frame frame = reported("Drive_Fb", 199 * TICK + 29000 - TICK);
    refuses(&frame, MCT_CAN_IS_OLDER);
    frame.time_us += 2 * TICK;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, hear(&frame));
}

static void test_native_feedback_of_an_invalid_encoder_changes_nothing(void)
{
    begin(&mct_can_native, 1);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Drive_Fb", 0));
    device.encoder_invalid = true;
    device.time_us = TICK;
    const mct_can_frame frame = reported("Drive_Fb", TICK);
    refuses(&frame, MCT_CAN_IS_NOT_FINITE);
    /* An encoder that nobody reads may be: the drive's state is heard all the same. */
    axis.encoders[0].used = false;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_STATE, tell("Drive_Fb", TICK));
}

static void test_native_flags_tell_the_drives_state(void)
{
    begin(&mct_can_native, 1);
    static const mct_can_drive_state states[] = {MCT_CAN_DRIVE_IDLE, MCT_CAN_DRIVE_READY,
                                                 MCT_CAN_DRIVE_FAULTY};
    for (int k = 0; k < 12; k++) {
        device.state = states[k % 3];
        device.watchdog_expired = k % 2 > 0;
        device.estopped = k % 4 > 1;
        device.time_us += TICK;
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Drive_Fb", k * TICK));
        TEST_ASSERT_EQUAL_INT(device.state, axis.state);
        TEST_ASSERT_EQUAL(device.watchdog_expired, axis.watchdog_expired);
        TEST_ASSERT_EQUAL(device.estopped, axis.estopped);
        TEST_ASSERT_EQUAL_UINT32(k + 1, axis.state_updates);
    }
}

static void test_native_second_encoder_tells_its_counts_alone(void)
{
    begin(&mct_can_native, 1);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Drive_Fb", 0));
    device.state = MCT_CAN_DRIVE_FAULTY;
    device.estopped = device.restarted = true;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Drive_Fb2", 0));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_READY, axis.state);
    TEST_ASSERT_EQUAL_UINT32(0, axis.restarts);
    TEST_ASSERT_FALSE(axis.estopped);
    axis.encoders[1].used = false;
    device.time_us += TICK;
    const mct_can_frame frame = reported("Drive_Fb2", TICK);
    refuses(&frame, MCT_CAN_IS_FOREIGN);
    device.roles &= ~(uint32_t)MCT_CAN_OF_SPARE; /* a drive that reads one encoder says nothing of a second */
    mct_can_frame none;
    TEST_ASSERT_FALSE(device.protocol->report(&device, message_of("Drive_Fb2", true), &none));
    device.estopped = false;
    TEST_ASSERT_FALSE(device.protocol->report(&device, message_of("Drive_Estop", true), &none));
}

static void test_native_says_when_it_is_asked_for_more_than_its_supply(void)
{
    begin(&mct_can_native, 1);
    static const double volts[] = {12, 12.5, -12, -12.5};
    for (int i = 0; i < 4; i++) {
        order(volts[i], true);
        TEST_ASSERT_EQUAL_HEX8(i % 2 ? 0x21 : 0x01, reported("Drive_Fb", 0).data[7]);
    }
}

static void test_native_restart_is_counted_once_and_not_at_the_first_meeting(void)
{
    begin(&mct_can_native, 1);
    static const bool restarted[] = {true, true, false, false, true, true, false, true};
    static const uint32_t restarts[] = {0, 0, 0, 0, 1, 1, 1, 2};
    for (int k = 0; k < 8; k++) {
        device.restarted = restarted[k];
        device.time_us += TICK;
        tell("Drive_Fb", k * TICK);
        TEST_ASSERT_EQUAL_UINT32(restarts[k], axis.restarts);
    }
}

static void test_native_status_tells_error_supply_and_another_drive(void)
{
    begin(&mct_can_native, 1);
    tell("Drive_Fb", 0);
    device.supply = 24.375; /* half a step more than 24.37: away from zero */
    device.serial = 1234;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_STATE, tell("Drive_Status", 0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 24.38, mct_can_bus_voltage(&axis));
    TEST_ASSERT_EQUAL_UINT16(1234, axis.serial);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_READY, axis.state);
    device.error = 3;
    tell("Drive_Status", 0);
    TEST_ASSERT_EQUAL_UINT32(3, axis.error);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_FAULTY, axis.state);
    TEST_ASSERT_EQUAL_UINT32(0, axis.serial_changes);
    device.serial = 1235;
    tell("Drive_Status", 0);
    TEST_ASSERT_EQUAL_UINT32(1, axis.serial_changes);
}

/* It must be heard, so its length is nobody's concern. */
static void test_an_emergency_stop_of_anybody_is_heard_at_both_ends_whatever_its_length(void)
{
    static const struct {
        const mct_can_protocol *protocol;
        uint32_t id;
    } cases[] = {{&mct_can_native, 0x011}, {&mct_can_odrive, 0x022}, {&mct_can_odrive_0_5, 0x022}};
    for (int i = 0; i < 3; i++) {
        for (int length = 0; length <= 8; length++) {
            begin(cases[i].protocol, 1);
            order(3, true);
            device.wants_ready = true;
            const mct_can_frame frame = frame_of(cases[i].id, false, length, "\0\0\0\0\0\0\0");
            TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_STOP, hear(&frame));
            TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_STOP, obey(&frame));
            TEST_ASSERT_TRUE(device.wants_stop && !device.wants_ready && device.value == 0);
        }
    }
}

/* --- vesc --- */

/* From the firmware's documentation/comm_can.md: 51 A to the controller 23. */
static void test_vesc_vector_of_its_document(void)
{
    begin(&mct_can_vesc, 23);
    const mct_can_frame frame = frame_of(0x00000117, true, 4, "\x00\x00\xC7\x38");
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, obey(&frame));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_WISH_CURRENT, device.wish);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 51, device.value);
}

/* 6 V of 12 V: 50000 = 0xC350 steps of duty, big-endian, 4 bytes. */
static void test_vesc_duty_is_the_share_of_the_supply(void)
{
    begin(&mct_can_vesc, 5);
    mct_can_frame frame = commanded(6, true);
    TEST_ASSERT_EQUAL_HEX32(0x005, frame.id);
    TEST_ASSERT_TRUE(frame.extended);
    TEST_ASSERT_EQUAL_UINT8(4, frame.length);
    assert_bytes("\x00\x00\xC3\x50\0\0\0", &frame);
    axis.motor.inverted = true;
    frame = commanded(6, true);
    assert_bytes("\xFF\xFF\x3C\xB0\0\0\0", &frame);
    axis.motor.inverted = false;
    /* As the drive measures it, once it does: 24.0 V. */
    device.supply = 24;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_STATE, tell("STATUS_5", 0));
    order(6, true);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.25, device.value);
    /* A measurement that can be none is none. */
    device.supply = 0.5;
    tell("STATUS_5", 0);
    order(6, true);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.5, device.value);
    /* Field orientation: sqrt(3) more. */
    scene.can_mode = MCT_CAN_MODE_FOC;
    order(6, true);
    TEST_ASSERT_DOUBLE_WITHIN(5e-6, 0.5 * sqrt(3.0), device.value);
}

static void test_vesc_duty_is_clamped_to_one_and_by_the_drive_to_its_limit(void)
{
    begin(&mct_can_vesc, 5);
    mct_can_frame frame = commanded(1e30, true);
    assert_bytes("\x00\x01\x86\xA0\0\0\0", &frame);
    obey(&frame);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.95, device.value);
    frame = commanded(-13, true);
    assert_bytes("\xFF\xFE\x79\x60\0\0\0", &frame);
    axis.motor.supply = 0;
    order(5, true);
    TEST_ASSERT_TRUE(device.value == 0);
}

static void test_vesc_obeys_what_is_for_everybody_and_brakes_against_the_motion(void)
{
    begin(&mct_can_vesc, 5);
    const mct_can_frame everybody = frame_of(0x000000FF, true, 4, "\x00\x00\x27\x10");
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, obey(&everybody));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.1, device.value);
    const mct_can_frame brake = frame_of(0x00000205, true, 4, "\x00\x00\x07\xD0");
    for (int direction = -1; direction <= 1; direction++) {
        device.rate = 3 * direction;
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, obey(&brake));
        TEST_ASSERT_EQUAL_INT(MCT_CAN_WISH_CURRENT, device.wish);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, -2 * direction, device.value);
    }
}

/* A walk of up to half a turn between messages, over thousands of turns, mounted either way. */
static void test_vesc_position_is_unwrapped_to_counts(void)
{
    test_random numbers = {77};
    const double counts_per_turn[] = {4096, -4096, 1000.25, -18000};
    for (int i = 0; i < 4; i++) {
        begin(&mct_can_vesc, 1);
        axis.encoders[0].counts_per_turn = counts_per_turn[i];
        int64_t steps = 9000;
        for (int k = 0; k < 100000; k++) {
            device.turns = ((double)steps + 0.5) / 18000;
            TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("STATUS_4", k * TICK));
            const double counts = floor((double)steps * counts_per_turn[i] / 18000);
            TEST_ASSERT_EQUAL_INT32((int32_t)(uint32_t)(int64_t)counts, axis.encoders[0].counts);
            steps += (int64_t)random_in(&numbers, -8999, k < 50000 ? 8999.9 : -1000);
        }
        TEST_ASSERT_EQUAL_UINT32(100000, axis.encoders[0].updates);
    }
}

/* 3500 electrical turns a minute of 7 pole pairs are 8.333 turns a second. */
static void test_vesc_encoder_that_stands_from_status_to_status_while_it_turns_is_frozen(void)
{
    begin(&mct_can_vesc, 1);
    device.turns = 0.25;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("STATUS_4", 0));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("STATUS_4", TICK)); /* standing still is no fault */
    device.rate = 3500.0 / 60 / 7;
    for (int k = 0; k < 2; k++) { /* one status may be at the very start of a motion, a second one not */
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("STATUS_4", 2 * TICK));
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_STATE, tell("STATUS", 2 * TICK));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 8.3333333333, axis.rate);
    }
    const mct_can_frame frame = reported("STATUS_4", 3 * TICK);
    refuses(&frame, MCT_CAN_IS_REPEATED);
    device.turns += 0.01;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("STATUS_4", 4 * TICK));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK,
                          tell("STATUS_4", 5 * TICK)); /* believed till the next status */
    /* A change of direction passes through rest; a speed that nobody would see is none. */
    static const double rates[] = {5, -5, 5, -5, 0.05, 0.05, -0.05, 0, 0.05, 5, 0.05, 0};
    tell("STATUS", 6 * TICK);
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        device.rate = rates[i];
        if (i == 0) {
            axis.rate = -1;
        }
        tell("STATUS", 7 * TICK);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("STATUS_4", 8 * TICK));
    }
}

static void test_vesc_encoder_that_moves_between_statuses_is_not_frozen(void)
{
    begin(&mct_can_vesc, 1);
    device.rate = 0.2;
    for (int k = 0; k < 50; k++) {
        device.turns += 0.004;
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("STATUS_4", k * TICK));
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_STATE, tell("STATUS", k * TICK));
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("STATUS_4", k * TICK + 1)); /* not yet further */
    }
}

/* It never says so: at the first message nothing is known, after a silence nothing is known any more. */
static void test_vesc_position_that_comes_again_after_a_silence_is_of_another_start(void)
{
    begin(&mct_can_vesc, 1);
    device.turns = 0.3;
    int64_t now = 3600 * (int64_t)1000000;
    static const struct {
        int64_t later;
        uint32_t restarts;
    } cases[] = {
        {0, 0}, {TICK, 0},        {250 * TICK, 0}, {250 * TICK + 1, 1}, {TICK, 1},
        {0, 1}, {-400 * TICK, 1}, {100 * TICK, 1}, {5000 * TICK, 2},    {3600 * (int64_t)1000000, 3}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        now += cases[i].later;
        tell("STATUS", now); /* says nothing of the position */
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("STATUS_4", now));
        TEST_ASSERT_EQUAL_UINT32(cases[i].restarts, axis.restarts);
    }
    /* What is refused is as good as silence. */
    device.rate = 5;
    tell("STATUS", now);
    tell("STATUS", now);
    tell("STATUS", now);
    for (int k = 0; k <= 260; k++) {
        const mct_can_frame frame = reported("STATUS_4", now += TICK);
        refuses(&frame, MCT_CAN_IS_REPEATED);
    }
    device.turns = 0.4;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("STATUS_4", now));
    TEST_ASSERT_EQUAL_UINT32(4, axis.restarts);
}

/* It never says so, but one that is told 0.1 and more fifty times in a row and shows no duty does not obey. */
static void test_vesc_that_shows_no_duty_while_told_a_large_one_is_not_ready(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        begin(&mct_can_vesc, 1);
        tell("STATUS", 0);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_READY, axis.state);
        for (int k = 1; k <= 60; k++) {
            commanded(1.3 * sign, true);
            tell("STATUS", k * TICK);
            TEST_ASSERT_EQUAL_INT(k < 50 ? MCT_CAN_DRIVE_READY : MCT_CAN_DRIVE_IDLE, axis.state);
        }
        device.volts = 1.3 * sign;
        tell("STATUS", 61 * TICK);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_READY, axis.state);
    }
    device.volts = 0;
    commanded(0, true);
    for (int k = 0; k < 400; k++) { /* small ones, changing ones and interrupted ones prove nothing */
        const double volts = k < 100 ? 1.1 : k < 200 ? (k % 40 < 20 ? 5 : -5) : 5;
        commanded(volts, k < 200 || k % 40 != 0);
        tell("STATUS", 62 * TICK);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_READY, axis.state);
    }
}

/* 4 bytes of nothing: with a duty of zero the drive would ramp down first. */
static void test_vesc_disabled_has_no_current(void)
{
    begin(&mct_can_vesc, 5);
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    frames[1] = commanded(6, false);
    TEST_ASSERT_EQUAL_INT(1, axis.protocol->stop(&axis, frames));
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_EQUAL_HEX32(0x105, frames[i].id);
        TEST_ASSERT_EQUAL_UINT8(4, frames[i].length);
        assert_bytes("\0\0\0\0\0\0\0", &frames[i]);
        device.value = 1;
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_COMMAND, obey(&frames[i]));
        TEST_ASSERT_EQUAL_INT(MCT_CAN_WISH_CURRENT, device.wish);
        TEST_ASSERT_TRUE(device.value == 0);
    }
}

/* --- odrive --- */

/* node 3: 3 << 5 | 0x0E = 0x6E; 1.5f is 0x3FC00000. */
static void test_odrive_vectors_of_its_document(void)
{
    begin(&mct_can_odrive, 3);
    mct_can_frame frame = commanded(1.5, true);
    TEST_ASSERT_EQUAL_HEX32(0x06E, frame.id);
    TEST_ASSERT_FALSE(frame.extended);
    TEST_ASSERT_EQUAL_UINT8(8, frame.length);
    assert_bytes("\x00\x00\xC0\x3F\0\0\0", &frame);
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    TEST_ASSERT_EQUAL_INT(4, axis.protocol->arm(&axis, frames));
    TEST_ASSERT_EQUAL_HEX32(0x06E, frames[0].id); /* no torque left over from before */
    assert_bytes("\0\0\0\0\0\0\0", &frames[0]);
    TEST_ASSERT_EQUAL_HEX32(0x078, frames[1].id);
    TEST_ASSERT_EQUAL_UINT8(1, frames[1].length);
    TEST_ASSERT_EQUAL_HEX32(0x06B, frames[2].id); /* the mode ahead of closed loop */
    assert_bytes("\x01\0\0\0\x01\0\0", &frames[2]);
    TEST_ASSERT_EQUAL_HEX32(0x067, frames[3].id);
    assert_bytes("\x08\0\0\0\0\0\0", &frames[3]);
    begin(&mct_can_odrive_0_5, 3);
    axis.protocol->arm(&axis, frames);
    TEST_ASSERT_EQUAL_HEX32(0x078, frames[1].id);
    TEST_ASSERT_EQUAL_UINT8(0, frames[1].length);
    TEST_ASSERT_EQUAL_INT(3, axis.protocol->stop(&axis, frames));
    TEST_ASSERT_EQUAL_HEX32(0x06E, frames[0].id);
    TEST_ASSERT_EQUAL_HEX32(0x062, frames[1].id);
    TEST_ASSERT_EQUAL_HEX32(0x067, frames[2].id);
    assert_bytes("\x01\0\0\0\0\0\0", &frames[2]);
    /* The maker's Python example asks for closed loop with 4 bytes. */
    const mct_can_frame brief = frame_of(0x067, false, 4, "\x08\0\0");
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_REQUEST, obey(&brief));
    TEST_ASSERT_TRUE(device.wants_ready);
    /* Any frame to the axis feeds its watchdog, known or not. */
    const mct_can_frame unknown = frame_of(0x07D, false, 2, "\1");
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_REQUEST, obey(&unknown));
}

/* i = (V - emf rate)/R = (6 - 0.25 * 8)/2 = 2 A, 0.05 N m/A. */
static void test_odrive_torque_is_that_of_the_armature(void)
{
    begin(&mct_can_odrive, 1);
    scene.can_mode = MCT_CAN_MODE_TORQUE;
    device.rate = 8;
    tell("Get_Encoder_Estimates", 0);
    order(6, true);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_WISH_TORQUE, device.wish);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.1, device.value);
    order(0, true); /* zero volts brake */
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, -0.05, device.value);
    axis.motor.inverted = true;
    order(6, true); /* -6 V in the drive's sense, the emf as before */
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, -0.2, device.value);
    order(-1e30, true); /* no more than the supply */
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.25, device.value);
    device.rate = 1e30; /* a speed that cannot be: no more than twice the supply */
    tell("Get_Encoder_Estimates", 0);
    order(0, true);
    TEST_ASSERT_DOUBLE_WITHIN(
        1e-6, -2 * axis.motor.supply / axis.motor.resistance * axis.motor.torque_per_ampere, device.value);
    axis.motor.resistance = 0;
    order(6, true);
    TEST_ASSERT_TRUE(device.value == 0);
    scene.can_mode = MCT_CAN_MODE_VOLTAGE;
    order(6, true);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_WISH_VOLTS, device.wish);
    TEST_ASSERT_TRUE(device.value == -6);
}

static void test_odrive_numbers_that_are_not_finite_are_refused_at_both_ends(void)
{
    static const char *const bad[] = {"\0\0\xC0\x7F\0\0\0", "\0\0\x80\x7F\0\0\0", "\0\0\x80\xFF\0\0\0",
                                      "\1\0\x80\x7F\0\0\0"};
    begin(&mct_can_odrive, 1);
    tell("Get_Encoder_Estimates", 0);
    for (int i = 0; i < 4; i++) {
        mct_can_frame frame = frame_of(0x029, false, 8, bad[i]);
        refuses(&frame, MCT_CAN_IS_NOT_FINITE);
        memcpy(frame.data, "\0\0\0\0", 4);
        memcpy(frame.data + 4, bad[i], 4);
        refuses(&frame, MCT_CAN_IS_NOT_FINITE);
        frame = frame_of(0x037, false, 8, bad[i]);
        refuses(&frame, MCT_CAN_IS_NOT_FINITE);
        frame = frame_of(0x02E, false, 8, bad[i]);
        const mct_can_device before = device;
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_NOT_FINITE, obey(&frame));
        TEST_ASSERT_EQUAL_MEMORY(&before, &device, sizeof device);
    }
    device.encoder_invalid = true;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_NOT_FINITE, tell("Get_Encoder_Estimates", TICK));
}

/*
 * A wheel at 20000 turns, where the float's steps are 8 counts wide, with a speed that swings. The trapezoid's
 * error in a tick, dt^3/12 * 0.2 * 27 turns, is nothing, so what is left is rounding: half a count, and the
 * speed's float. The float alone would be wrong by 4.
 */
static void test_odrive_position_is_finer_than_its_float_and_does_not_drift(void)
{
    begin(&mct_can_odrive, 1);
    double worst = 0;
    for (int k = 0; k < 200000; k++) {
        const double t = k * 1e-3;
        device.turns = 20000 + 2 * t + 0.2 * sin(3 * t);
        device.rate = 2 + 0.6 * cos(3 * t);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Estimates", k * TICK));
        const double error = axis.encoders[0].counts - device.turns * 4096;
        if (k > 1000) {
            worst = fabs(error) > worst ? fabs(error) : worst;
        }
        TEST_ASSERT_TRUE(fabs(error) <= 4.5);
    }
    printf("odrive at 20000 turns: worst error %.2f counts where the float's steps are 8\n", worst);
    TEST_ASSERT_TRUE(worst < 1.5);
    TEST_ASSERT_EQUAL_UINT32(0, axis.restarts);
}

static void test_odrive_whole_counts_stay_themselves_through_the_float(void)
{
    const double counts_per_turn[] = {4096, -4096, 43958, 1000};
    for (int i = 0; i < 4; i++) {
        begin(&mct_can_odrive, 1);
        axis.encoders[0].counts_per_turn = counts_per_turn[i];
        for (int32_t k = -20000; k < 20000; k++) {
            device.turns = k / counts_per_turn[i];
            device.rate = 1 / counts_per_turn[i] / 1e-3;
            TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Estimates", k * TICK));
            TEST_ASSERT_EQUAL_INT32(k, axis.encoders[0].counts);
        }
    }
}

static void test_odrive_estimate_that_stands_while_the_motor_turns_is_a_repetition(void)
{
    begin(&mct_can_odrive, 1);
    device.turns = 3;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Estimates", 0));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Estimates", TICK));
    device.rate = 5; /* 20 counts a tick */
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Estimates", 2 * TICK));
    const mct_can_frame frame = reported("Get_Encoder_Estimates", 3 * TICK);
    refuses(&frame, MCT_CAN_IS_REPEATED);
    /* A float whose steps are wider than the motion says the same twice and is right. */
    device.turns = 3e6; /* steps of 0.25 */
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Estimates", 4 * TICK));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Estimates", 5 * TICK));
}

static void test_odrive_heartbeat_tells_state_and_errors_of_both_firmwares(void)
{
    for (int firmware = 0; firmware < 2; firmware++) {
        begin(firmware == MCT_CAN_FIRMWARE_0_5 ? &mct_can_odrive_0_5 : &mct_can_odrive, 1);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_STATE, tell("Heartbeat", 0));
        TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_READY, axis.state);
        TEST_ASSERT_EQUAL_UINT32(0, axis.error);
        device.state = MCT_CAN_DRIVE_FAULTY;
        device.watchdog_expired = true;
        tell("Heartbeat", 0);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_FAULTY, axis.state);
        TEST_ASSERT_EQUAL_HEX32(firmware == MCT_CAN_FIRMWARE_0_5 ? 0x800 : 0x01000000, axis.error);
        TEST_ASSERT_TRUE(axis.watchdog_expired && !axis.estopped);
        device.watchdog_expired = false;
        device.estopped = true;
        tell("Heartbeat", 0);
        TEST_ASSERT_EQUAL_HEX32(firmware == MCT_CAN_FIRMWARE_0_5 ? 0x4000 : 0x02000000, axis.error);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_IDLE, axis.state); /* a stop is no fault */
        TEST_ASSERT_TRUE(axis.estopped);
        device.estopped = false;
        tell("Heartbeat", 0);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_FAULTY, axis.state); /* an error without a name is one */
        TEST_ASSERT_TRUE(axis.error != 0);
    }
    /* 0.5: errors of motor, encoder and controller are flags; a trajectory done (bit 63) is none. */
    begin(&mct_can_odrive_0_5, 1);
    mct_can_frame frame = frame_of(0x021, false, 8, "\0\0\0\0\x08\0\0\x80");
    hear(&frame);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_READY, axis.state);
    static const char *const flags[] = {"\0\0\0\0\x08\1\0\0", "\0\0\0\0\x08\0\1\0", "\0\0\0\0\x08\0\0\1"};
    for (int i = 0; i < 3; i++) {
        frame = frame_of(0x021, false, 8, flags[i]);
        hear(&frame);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_FAULTY, axis.state);
    }
}

static void check_leaving(const mct_can_protocol *protocol)
{
    begin(protocol, 1);
    tell("Heartbeat", 0);
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    axis.protocol->arm(&axis, frames); /* asking again forgets nothing of it */
    device.state = MCT_CAN_DRIVE_IDLE;
    tell("Heartbeat", 0);
    TEST_ASSERT_EQUAL_UINT32(1, axis.restarts);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_DRIVE_IDLE, axis.state);
    tell("Heartbeat", 0);
    TEST_ASSERT_EQUAL_UINT32(1, axis.restarts);
    /* A stop from here leaves an error, and a fault is one. */
    device.state = MCT_CAN_DRIVE_READY;
    tell("Heartbeat", 0);
    device.state = MCT_CAN_DRIVE_IDLE;
    device.estopped = true;
    tell("Heartbeat", 0);
    device.estopped = false;
    tell("Heartbeat", 0);
    TEST_ASSERT_EQUAL_UINT32(1, axis.restarts);
    /* A state that only a drive at its start has. */
    device.state = MCT_CAN_DRIVE_READY;
    tell("Heartbeat", 0);
    device.state = MCT_CAN_DRIVE_UNKNOWN;
    device.error = 1;
    tell("Heartbeat", 0);
    TEST_ASSERT_EQUAL_UINT32(2, axis.restarts);
}

static void test_odrive_that_leaves_closed_loop_without_an_error_has_restarted(void)
{
    check_leaving(&mct_can_odrive);
    check_leaving(&mct_can_odrive_0_5);
}

/* Told by position and heartbeat in either order, one restart is one. */
static void test_odrive_position_that_moves_further_than_its_speed_allows_is_a_restart(void)
{
    for (int beat_first = 0; beat_first < 2; beat_first++) {
        begin(&mct_can_odrive, 1);
        tell("Heartbeat", 0);
        device.turns = 0.4;
        tell("Get_Encoder_Estimates", 0);
        device.state = MCT_CAN_DRIVE_IDLE;
        device.turns = 0;
        if (beat_first) {
            tell("Heartbeat", 200 * TICK);
        }
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Estimates", 201 * TICK));
        tell("Heartbeat", 202 * TICK);
        TEST_ASSERT_EQUAL_UINT32(1, axis.restarts);
        TEST_ASSERT_EQUAL_INT32(0, axis.encoders[0].counts); /* it begins anew */
    }
    /* The hardest real motion is none: from rest to 300 turns/s in 10 ms, time stamps late by up to 3 ms. */
    begin(&mct_can_odrive, 1);
    test_random numbers = {9};
    for (int k = 0; k < 1000; k++) {
        const double t = k * 1e-3;
        const double ramp = t < 0.01 ? t : 0.01;
        device.rate = 3e4 * ramp;
        device.turns = 3e4 * (ramp * ramp / 2 + (t - ramp) * ramp);
        tell("Get_Encoder_Estimates", k * TICK + (int64_t)random_in(&numbers, 0, 3000));
    }
    TEST_ASSERT_EQUAL_UINT32(0, axis.restarts);
}

/* --- odrive 0.5 --- */

/* node 1, 0x0A: 0x12345678 and -2. */
static void test_odrive_0_5_count_of_the_document(void)
{
    begin(&mct_can_odrive_0_5, 1);
    mct_can_frame frame = frame_of(0x02A, false, 8, "\x78\x56\x34\x12\x00\x08\0");
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, hear(&frame));
    TEST_ASSERT_EQUAL_INT32(0x12345678, axis.encoders[0].counts);
    begin(&mct_can_odrive_0_5, 1);
    axis.encoders[0].counts_per_turn = -4096;
    frame = frame_of(0x02A, false, 8, "\xFE\xFF\xFF\xFF\xFE\x0F\0");
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, hear(&frame));
    TEST_ASSERT_EQUAL_INT32(2, axis.encoders[0].counts);
    device.counts[0] = -2;
    frame = reported("Get_Encoder_Count", 0);
    TEST_ASSERT_EQUAL_HEX32(0x02A, frame.id);
    assert_bytes("\xFE\xFF\xFF\xFF\xFE\x0F\0", &frame); /* -2 is 4094 within the turn */
    /* 0.6 has no such message. */
    begin(&mct_can_odrive, 1);
    refuses(&frame, MCT_CAN_IS_FOREIGN);
}

/* All of 32 bits, in integers; whatever the ratio, of which the sign is used. */
static void test_odrive_0_5_counts_are_the_drives_or_their_opposite_over_the_counters_end(void)
{
    const double counts_per_turn[] = {4096, -4096, 8192.5, -1e-3};
    for (int i = 0; i < 4; i++) {
        begin(&mct_can_odrive_0_5, 1);
        axis.encoders[0].counts_per_turn = counts_per_turn[i];
        uint32_t counts = 0x7FFFFF00;
        for (int k = 0; k < 600; k++) {
            counts += i < 3 ? 3 : 0;
            device.counts[0] = (int32_t)counts;
            TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Count", k * TICK));
            TEST_ASSERT_EQUAL_HEX32(i % 2 ? 0u - counts : counts, (uint32_t)axis.encoders[0].counts);
        }
        TEST_ASSERT_EQUAL_UINT32(0, axis.restarts); /* the counter's end is no jump */
        TEST_ASSERT_EQUAL_UINT32(600, axis.encoders[0].updates);
    }
}

/* get_encoder_estimates_callback: the controller has no source of a position until it is in closed loop. */
static void test_odrive_0_5_that_was_never_armed_counts_though_its_estimates_stand(void)
{
    begin(&mct_can_odrive_0_5, 1);
    device.turns = 0.5;
    device.rate = 3;
    for (int k = 0; k < 100; k++) {
        const mct_can_frame frame = reported("Get_Encoder_Estimates", k * TICK);
        assert_bytes("\0\0\0\0\0\0\0", &frame);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_STATE, hear(&frame));
        device.counts[0] = 12 * k;
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Count", k * TICK));
        TEST_ASSERT_EQUAL_INT32(12 * k, axis.encoders[0].counts);
    }
    TEST_ASSERT_EQUAL_UINT32(100, axis.encoders[0].updates);
    TEST_ASSERT_EQUAL_UINT32(0, axis.restarts);
    device.has_driven = true;
    mct_can_frame frame = reported("Get_Encoder_Estimates", 100 * TICK);
    assert_bytes("\0\0\0\x3F\0\0\x40\x40", &frame);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_STATE, hear(&frame));
    TEST_ASSERT_TRUE(axis.rate == 3);
    TEST_ASSERT_EQUAL_INT32(12 * 99, axis.encoders[0].counts);
    /* It has no words for an encoder that is lost: no position, and 0 for its speed. */
    device.encoder_invalid = true;
    TEST_ASSERT_FALSE(device.protocol->report(&device, message_of("Get_Encoder_Count", true), &frame));
    frame = reported("Get_Encoder_Estimates", 100 * TICK);
    assert_bytes("\0\0\0\0\0\0\0", &frame);
    frame = frame_of(0x029, false, 8, "\0\0\0\0\0\0\xC0");
    frame.data[7] = 0x7F; /* a speed that is not finite */
    refuses(&frame, MCT_CAN_IS_NOT_FINITE);
    frame = frame_of(0x029, false, 8, "\0\0\xC0\x7F\0\0\0"); /* nor is the position, though it is not used */
    refuses(&frame, MCT_CAN_IS_NOT_FINITE);
}

static void test_odrive_0_5_torque_needs_a_speed_of_the_same_time(void)
{
    begin(&mct_can_odrive_0_5, 1);
    scene.can_mode = MCT_CAN_MODE_TORQUE;
    axis.roles |= MCT_CAN_OF_TORQUE;
    device.has_driven = true;
    device.rate = 8;
    int64_t now = 1000000;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_STATE, tell("Get_Encoder_Count", now));
    TEST_ASSERT_EQUAL_UINT32(0, axis.encoders[0].updates);
    tell("Get_Encoder_Estimates", now);
    order(6, true);
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0.1, device.value); /* as in 0.6 */
    for (int k = 0; k < 20; k++) {                      /* 3 ticks, and 5 ms that a stamp may be late */
        device.counts[0] += 33;
        TEST_ASSERT_EQUAL_INT(k <= 8 ? MCT_CAN_IS_FEEDBACK : MCT_CAN_IS_STATE,
                              tell("Get_Encoder_Count", now + k * TICK));
    }
    TEST_ASSERT_EQUAL_UINT32(9, axis.encoders[0].updates);
    tell("Get_Encoder_Estimates", now + 20 * TICK);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Count", now + 20 * TICK));
    TEST_ASSERT_EQUAL_UINT32(0, axis.restarts);
}

static void test_odrive_0_5_count_that_stands_is_a_repetition_only_while_the_drive_tells_a_speed(void)
{
    begin(&mct_can_odrive_0_5, 1);
    device.has_driven = true;
    for (int k = 0; k < 50; k++) { /* no speed is told: it may have been stopped */
        device.counts[0] = k < 10 ? 30 * k : 300;
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Count", k * TICK));
    }
    device.rate = 5; /* 20 counts a tick */
    tell("Get_Encoder_Estimates", 50 * TICK);
    mct_can_frame frame = reported("Get_Encoder_Count", 50 * TICK);
    refuses(&frame, MCT_CAN_IS_REPEATED);
    device.rate = 0.2; /* less than a count a tick */
    tell("Get_Encoder_Estimates", 51 * TICK);
    frame.time_us = 51 * TICK;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, hear(&frame));
}

/* Told by count and heartbeat in either order, one restart is one. */
static void test_odrive_0_5_count_that_jumps_is_a_restart(void)
{
    for (int beat_first = 0; beat_first < 2; beat_first++) {
        begin(&mct_can_odrive_0_5, 1);
        tell("Heartbeat", 0);
        for (int k = 0; k <= 20; k++) {
            device.counts[0] = 1600 + 4 * k;
            TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Count", k * TICK));
        }
        device.state = MCT_CAN_DRIVE_IDLE;
        device.counts[0] = 0;
        if (beat_first) {
            tell("Heartbeat", 60 * TICK);
        }
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Count", 61 * TICK));
        tell("Heartbeat", 62 * TICK);
        TEST_ASSERT_EQUAL_UINT32(1, axis.restarts);
        TEST_ASSERT_EQUAL_INT32(0, axis.encoders[0].counts); /* it begins anew */
        for (int k = 1; k < 50; k++) {                       /* on the way at 25 turns/s: it goes on */
            device.counts[0] += 100;
            TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Count", (61 + k) * TICK));
        }
        TEST_ASSERT_EQUAL_UINT32(1, axis.restarts);
    }
    /* One that is read only is idle all the time. */
    begin(&mct_can_odrive_0_5, 1);
    device.state = MCT_CAN_DRIVE_IDLE;
    static const struct {
        int32_t counts;
        int later;
        uint32_t restarts;
    } cases[] = {{0, 0, 0}, {180, 1, 0}, {-100, 1, 1}, {-100, 1, 1}, {2000, 60, 2}, {1900, 60, 2}};
    int64_t now = 0;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (int k = 0; k < 20 && i > 0; k++) { /* at rest */
            tell("Get_Encoder_Count", now += TICK);
        }
        now += cases[i].later * TICK;
        device.counts[0] = cases[i].counts;
        tell("Heartbeat", now);
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Count", now));
        TEST_ASSERT_EQUAL_UINT32(cases[i].restarts, axis.restarts);
    }
}

/* What no speed tells: an axis that is read only and has no other sign of a restart. */
static void test_odrive_0_5_count_that_comes_again_after_a_silence_is_of_another_start(void)
{
    begin(&mct_can_odrive_0_5, 1);
    int64_t now = 3600 * (int64_t)1000000;
    static const int64_t later[] = {0, TICK, 250 * TICK, 250 * TICK + 1, TICK, 2000 * TICK};
    static const uint32_t restarts[] = {0, 0, 0, 1, 1, 2};
    for (int i = 0; i < 6; i++) {
        now += later[i];
        TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell("Get_Encoder_Count", now));
        TEST_ASSERT_EQUAL_UINT32(restarts[i], axis.restarts);
    }
}

/*
 * From rest to 300 turns/s in 10 ms and to rest again, stamps late by up to 5 ms; then 100 turns/s^2 while messages
 * are lost.
 */
static void test_odrive_0_5_hardest_real_motion_is_no_restart(void)
{
    test_random numbers = {10};
    for (int run = 0; run < 200; run++) {
        begin(&mct_can_odrive_0_5, 1);
        double rate = 0, turns = 0;
        for (int k = 0; k < 300; k++) {
            rate += k >= 5 && k < 15 ? 30 : k >= 200 && k < 210 ? -30 : 0;
            turns += rate * 1e-3;
            device.counts[0] = (int32_t)floor(turns * 4096);
            tell("Get_Encoder_Count", k * TICK + (int64_t)random_in(&numbers, 0, 5000));
        }
        TEST_ASSERT_EQUAL_UINT32(0, axis.restarts);
        const int gap = (int)random_in(&numbers, 1, 245);
        device.counts[0] += (int32_t)(0.5 * 100 * 1e-6 * gap * gap * 4096);
        tell("Get_Encoder_Count", (300 + gap) * TICK);
        TEST_ASSERT_EQUAL_UINT32(0, axis.restarts);
    }
}

/* --- two drives under one number --- */

static const char *position_of(const mct_can_protocol *protocol)
{
    return protocol == &mct_can_vesc     ? "STATUS_4"
           : protocol == &mct_can_odrive ? "Get_Encoder_Estimates"
                                         : "Get_Encoder_Count";
}

static mct_can_verdict tell_turns(double turns, int64_t time_us)
{
    device.turns = turns;
    device.counts[0] = (int32_t)floor(turns * 4096);
    return tell(position_of(device.protocol), time_us);
}

/* Whatever lies between them, beyond 1/64 turn: also half a turn, of which a vesc does not know the way. */
static void test_two_drives_with_one_number_are_seen_by_their_alternating_positions(void)
{
    static const double apart[] = {0.02, -0.02, 0.3, 0.49, 0.5, 0.51, -0.9, 0.97};
    for (int p = MCT_CAN_VESC; p < KINDS; p++) {
        for (size_t i = 0; i < sizeof apart / sizeof apart[0]; i++) {
            begin(kinds[p], 1);
            for (int k = 0; k < 8; k++) {
                TEST_ASSERT_EQUAL_INT(MCT_CAN_IS_FEEDBACK, tell_turns(k % 2 * apart[i], k * TICK));
                TEST_ASSERT_EQUAL_UINT32(k < 2 ? 0 : k - 1, axis.alternations);
            }
            /* One of them now and then comes in ahead of the other. */
            for (int k = 0; k < 20; k++) {
                tell_turns(k / 2 % 2 ? apart[i] : 0, k * TICK);
                tell_turns(k / 2 % 2 ? 0 : apart[i], k * TICK);
            }
            TEST_ASSERT_TRUE(axis.alternations >= 6 + 19);
        }
    }
}

/*
 * Standing with noise; by hand, shaken 20 times a second by a quarter of a turn; set going and stopped as hard as
 * can be; a jump, as of a restart; slow messages.
 */
static void test_one_drive_never_seems_to_be_two(void)
{
    test_random numbers = {11};
    for (int p = MCT_CAN_VESC; p < KINDS; p++) {
        for (int motion = 0; motion < 5; motion++) {
            begin(kinds[p], 1);
            device.has_driven = true;
            double rate = 0, turns = 0;
            for (int k = 0; k < 3000; k++) {
                const double t = k * 1e-3;
                const double before = turns;
                rate += motion == 2 ? (k % 40 < 10 ? 30 : k % 40 >= 20 && k % 40 < 30 ? -30 : 0) : 0;
                turns = motion == 0   ? 0.4 + random_in(&numbers, -0.005, 0.005)
                        : motion == 1 ? 0.25 * sin(125.7 * t)
                        : motion == 2 ? turns + rate * 1e-3
                        : motion == 3 ? (k < 1000 ? 0.2 : 0)
                                      : 0.25 * sin(12.57 * t);
                device.rate = (turns - before) / 1e-3;
                if (motion < 4 || k % 10 == 0) {
                    tell_turns(turns, k * TICK);
                }
            }
            TEST_ASSERT_EQUAL_UINT32(0, axis.alternations);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_protocols_stand_in_the_order_of_the_scenes_choices);
    RUN_TEST(test_firmware_chooses_between_the_protocols_of_an_odrive_alone);
    RUN_TEST(test_no_two_messages_of_a_protocol_share_an_identifier);
    RUN_TEST(test_frames_are_as_long_as_the_standard_says);
    RUN_TEST(test_the_host_refuses_wrong_length_format_and_remote_frames);
    RUN_TEST(test_the_drive_refuses_wrong_length_format_and_remote_frames);
    RUN_TEST(test_any_frame_is_survived);
    RUN_TEST(test_a_command_that_is_not_finite_or_disabled_asks_for_nothing);
    RUN_TEST(test_an_axis_without_a_motor_is_never_powered);
    RUN_TEST(test_armed_then_stopped_a_drive_is_ready_then_at_zero);
    RUN_TEST(test_native_commands_carry_the_checksum_of_sae_j1850);
    RUN_TEST(test_native_drive_refuses_a_command_with_any_bit_wrong);
    RUN_TEST(test_native_command_of_the_document);
    RUN_TEST(test_native_carries_every_millivolt_in_the_same_bits);
    RUN_TEST(test_native_voltage_is_rounded_to_the_nearest_millivolt_and_clamped);
    RUN_TEST(test_native_timeout_is_within_what_the_frame_holds);
    RUN_TEST(test_native_drive_is_told_no_watchdog_by_zero_and_five_milliseconds_at_least);
    RUN_TEST(test_native_drive_takes_newer_commands_only);
    RUN_TEST(test_native_drive_ceases_whatever_the_sequence);
    RUN_TEST(test_native_drive_takes_any_sequence_after_a_gap_or_with_a_clear);
    RUN_TEST(test_native_voltage_needs_its_mode_and_its_bit);
    RUN_TEST(test_native_plain_commands_clear_nothing);
    RUN_TEST(test_native_echo_is_the_sequence_of_the_newest_command);
    RUN_TEST(test_native_counts_are_the_drives_or_their_opposite_modulo_32_bits);
    RUN_TEST(test_native_feedback_twice_counts_once_and_older_feedback_not_at_all);
    RUN_TEST(test_native_feedback_of_an_invalid_encoder_changes_nothing);
    RUN_TEST(test_native_flags_tell_the_drives_state);
    RUN_TEST(test_native_second_encoder_tells_its_counts_alone);
    RUN_TEST(test_native_says_when_it_is_asked_for_more_than_its_supply);
    RUN_TEST(test_native_restart_is_counted_once_and_not_at_the_first_meeting);
    RUN_TEST(test_native_status_tells_error_supply_and_another_drive);
    RUN_TEST(test_an_emergency_stop_of_anybody_is_heard_at_both_ends_whatever_its_length);
    RUN_TEST(test_vesc_vector_of_its_document);
    RUN_TEST(test_vesc_duty_is_the_share_of_the_supply);
    RUN_TEST(test_vesc_duty_is_clamped_to_one_and_by_the_drive_to_its_limit);
    RUN_TEST(test_vesc_obeys_what_is_for_everybody_and_brakes_against_the_motion);
    RUN_TEST(test_vesc_position_is_unwrapped_to_counts);
    RUN_TEST(test_vesc_encoder_that_stands_from_status_to_status_while_it_turns_is_frozen);
    RUN_TEST(test_vesc_encoder_that_moves_between_statuses_is_not_frozen);
    RUN_TEST(test_vesc_position_that_comes_again_after_a_silence_is_of_another_start);
    RUN_TEST(test_vesc_that_shows_no_duty_while_told_a_large_one_is_not_ready);
    RUN_TEST(test_vesc_disabled_has_no_current);
    RUN_TEST(test_odrive_vectors_of_its_document);
    RUN_TEST(test_odrive_torque_is_that_of_the_armature);
    RUN_TEST(test_odrive_numbers_that_are_not_finite_are_refused_at_both_ends);
    RUN_TEST(test_odrive_position_is_finer_than_its_float_and_does_not_drift);
    RUN_TEST(test_odrive_whole_counts_stay_themselves_through_the_float);
    RUN_TEST(test_odrive_estimate_that_stands_while_the_motor_turns_is_a_repetition);
    RUN_TEST(test_odrive_heartbeat_tells_state_and_errors_of_both_firmwares);
    RUN_TEST(test_odrive_that_leaves_closed_loop_without_an_error_has_restarted);
    RUN_TEST(test_odrive_position_that_moves_further_than_its_speed_allows_is_a_restart);
    RUN_TEST(test_odrive_0_5_count_of_the_document);
    RUN_TEST(test_odrive_0_5_counts_are_the_drives_or_their_opposite_over_the_counters_end);
    RUN_TEST(test_odrive_0_5_that_was_never_armed_counts_though_its_estimates_stand);
    RUN_TEST(test_odrive_0_5_torque_needs_a_speed_of_the_same_time);
    RUN_TEST(test_odrive_0_5_count_that_stands_is_a_repetition_only_while_the_drive_tells_a_speed);
    RUN_TEST(test_odrive_0_5_count_that_jumps_is_a_restart);
    RUN_TEST(test_odrive_0_5_count_that_comes_again_after_a_silence_is_of_another_start);
    RUN_TEST(test_odrive_0_5_hardest_real_motion_is_no_restart);
    RUN_TEST(test_two_drives_with_one_number_are_seen_by_their_alternating_positions);
    RUN_TEST(test_one_drive_never_seems_to_be_two);
    return UNITY_END();
}

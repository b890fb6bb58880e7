/*
 * The native drive: volts in, counts out. Payloads: native.dbc.
 *
 * Order. Each command has a sequence number; the drive takes newer ones only (signed difference of 8 bits), so
 * a late copy moves nothing. After a gap (watchdog) and for a clear any number is taken: a host that has just
 * started knows none. Feedback carries the drive's clock (16 bits); the host takes later ones only, unless the
 * last one is so old that the clock may have wrapped.
 *
 * Latches. Watchdog, emergency stop, errors and a restart of the drive hold the motor at zero volts until a
 * command of mode clear, which nobody but `arm` sends.
 *
 * Watchdog. Each command says how long it holds; 0: until the next one.
 *
 * What the host's end does in a tick has no arithmetic in double.
 */
#include <string.h>

#include "hal/socketcan/codec.h"
#include "hal/socketcan/generated/mct_dbc_native.h"

enum { ESTOP = 0x010, COMMAND = 0x100, FEEDBACK = 0x180, STATUS = 0x200, FEEDBACK_2 = 0x280 };
enum { MODE_IDLE, MODE_VOLTAGE, MODE_CLEAR };
enum { REASON_HOST = 1, REASON_BUTTON = 2 };

#define ALL_AXES         (MCT_CAN_OF_MOTOR | MCT_CAN_OF_ENCODER | MCT_CAN_OF_SPARE)
#define SHORTEST_TIMEOUT 5
#define ORDERED_US       30000 /* less than half of what the drive's clock of 16 bits can tell apart */
#define LARGEST_MV       INT32_MAX

static const mct_can_message messages[] = {
    {"Drive_Cmd", COMMAND, 8, false, MCT_CAN_OF_MOTOR, 0, 0},
    {"Drive_Estop", ESTOP, 1, false, MCT_CAN_OF_MOTOR, -1, -1},
    {"Drive_Fb", FEEDBACK, 8, true, MCT_CAN_OF_MOTOR | MCT_CAN_OF_ENCODER, 0, 0},
    {"Drive_Fb2", FEEDBACK_2, 8, true, MCT_CAN_OF_SPARE, 0, 0},
    {"Drive_Status", STATUS, 8, true, MCT_CAN_OF_MOTOR | MCT_CAN_OF_ENCODER, 0.1, 0.5},
    {"Drive_Estop", ESTOP, 1, true, ALL_AXES, -1, -1},
};

static uint32_t identifier(uint32_t code, uint8_t node)
{
    return code + node;
}

/* CRC-8/SAE-J1850 over identifier and data but the last byte. */
static uint8_t checksum(const mct_can_frame *frame)
{
    uint8_t crc = 0xFF;
    for (int i = 0; i < 9; i++) {
        const uint32_t byte = i == 0 ? frame->id & 0xFF : i == 1 ? frame->id >> 8 : frame->data[i - 2];
        crc = (uint8_t)(crc ^ byte);
        for (int bit = 0; bit < 8; bit++) {
            crc = (uint8_t)((crc & 0x80) != 0 ? (crc << 1) ^ 0x1D : crc << 1);
        }
    }
    return (uint8_t)~crc;
}

/* A stop is a stop whatever its length. */
static bool has_length(const mct_can_message *message, const mct_can_frame *frame)
{
    return message->code == ESTOP || frame->length == message->length;
}

/* --- the host's end --- */

static void hear_state(mct_can_axis *axis, const struct mct_dbc_native_drive_fb_t *feedback)
{
    const mct_can_encoder *encoder = &axis->encoders[0];
    struct mct_dbc_native_drive_fb_t before;
    mct_dbc_native_drive_fb_unpack(&before, encoder->last, sizeof encoder->last);
    if (encoder->updates > 0 && feedback->restarted && !before.restarted) {
        axis->restarts++;
    }
    axis->watchdog_expired = feedback->watchdog_expired;
    axis->estopped = feedback->estopped;
    axis->state = feedback->fault   ? MCT_CAN_DRIVE_FAULTY
                  : feedback->ready ? MCT_CAN_DRIVE_READY
                                    : MCT_CAN_DRIVE_IDLE;
    axis->state_updates++;
}

/* Both encoders' frames have one layout. */
static mct_can_verdict hear_feedback(mct_can_axis *axis, int place, const mct_can_frame *frame)
{
    mct_can_encoder *encoder = &axis->encoders[place];
    struct mct_dbc_native_drive_fb_t feedback;
    mct_dbc_native_drive_fb_unpack(&feedback, frame->data, frame->length);
    if (place > 0 && !encoder->used) {
        return MCT_CAN_IS_FOREIGN;
    }
    if (encoder->used && feedback.encoder_invalid) {
        return MCT_CAN_IS_NOT_FINITE;
    }
    if (encoder->updates > 0) {
        const int16_t newer = (int16_t)(uint16_t)(feedback.capture_time - encoder->capture_us);
        if (memcmp(encoder->last, frame->data, sizeof encoder->last) == 0) {
            return MCT_CAN_IS_REPEATED;
        }
        if (newer < 0 && frame->time_us - encoder->time_us < ORDERED_US) {
            return MCT_CAN_IS_OLDER;
        }
    }
    if (place == 0) {
        hear_state(axis, &feedback);
    }
    const uint32_t counts = (uint32_t)feedback.counts;
    encoder->counts = (int32_t)(mct_can_is_negative(encoder->counts_per_turn) ? 0 - counts : counts);
    encoder->updates++;
    encoder->time_us = frame->time_us;
    encoder->echo = feedback.echo;
    encoder->capture_us = feedback.capture_time;
    memcpy(encoder->last, frame->data, sizeof encoder->last);
    return encoder->used ? MCT_CAN_IS_FEEDBACK : MCT_CAN_IS_STATE;
}

static mct_can_verdict hear_status(mct_can_axis *axis, const mct_can_frame *frame)
{
    struct mct_dbc_native_drive_status_t status;
    mct_dbc_native_drive_status_unpack(&status, frame->data, frame->length);
    axis->bus_10mv = status.bus_voltage;
    axis->error = status.fault;
    if (status.fault != 0) {
        axis->state = MCT_CAN_DRIVE_FAULTY;
    }
    if (axis->serial != 0 && axis->serial != status.serial) {
        axis->serial_changes++;
    }
    axis->serial = status.serial;
    axis->state_updates++;
    return MCT_CAN_IS_STATE;
}

static mct_can_verdict hear(mct_can_axis *axis, const mct_can_frame *frame)
{
    mct_can_verdict verdict;
    const mct_can_message *message = mct_can_sort(&mct_can_native, axis->node, true, frame, &verdict);
    if (message == NULL) {
        return verdict;
    }
    if (!has_length(message, frame)) {
        return MCT_CAN_IS_BAD_LENGTH;
    }
    switch (message->code) {
    case FEEDBACK:
        return hear_feedback(axis, 0, frame);
    case FEEDBACK_2:
        return hear_feedback(axis, 1, frame);
    case STATUS:
        return hear_status(axis, frame);
    default:
        return MCT_CAN_IS_STOP;
    }
}

uint8_t mct_can_watchdog_ms(double seconds)
{
    return (uint8_t)(seconds > 0 ? mct_can_nearest(seconds * 1000, SHORTEST_TIMEOUT, UINT8_MAX) : 0);
}

static void fill_command(mct_can_axis *axis, int32_t millivolts, uint8_t mode, bool enable,
                         mct_can_frame *frame)
{
    axis->sequence++;
    const struct mct_dbc_native_drive_cmd_t command = {
        .voltage = axis->motor.inverted ? -millivolts : millivolts,
        .sequence = axis->sequence,
        .mode = mode,
        .enable = enable,
        .timeout = axis->watchdog_ms,
    };
    mct_can_begin(&mct_can_native, COMMAND, axis->node, 8, frame);
    mct_dbc_native_drive_cmd_pack(frame->data, &command, sizeof frame->data);
    frame->data[7] = checksum(frame);
}

static void command(mct_can_axis *axis, mct_real volts, bool enable, mct_can_frame *frame)
{
    const bool drives = enable && mct_finite(volts);
    const int32_t millivolts = drives ? mct_can_nearest_real(volts * MCT_R(1000), LARGEST_MV) : 0;
    fill_command(axis, millivolts, drives ? MODE_VOLTAGE : MODE_IDLE, drives, frame);
}

/* Clears what is latched; a drive that reads encoders only stays disabled. */
static int arm(mct_can_axis *axis, mct_can_frame frames[MCT_CAN_MAX_BURST])
{
    axis->state = MCT_CAN_DRIVE_UNKNOWN;
    fill_command(axis, 0, MODE_CLEAR, (axis->roles & MCT_CAN_OF_MOTOR) != 0, &frames[0]);
    return 1;
}

static int stop(mct_can_axis *axis, mct_can_frame frames[MCT_CAN_MAX_BURST])
{
    if ((axis->roles & MCT_CAN_OF_MOTOR) == 0) {
        return 0;
    }
    mct_can_begin(&mct_can_native, ESTOP, axis->node, 1, &frames[0]);
    frames[0].data[0] = REASON_HOST;
    fill_command(axis, 0, MODE_IDLE, false, &frames[1]);
    return 2;
}

/* --- the drive's end --- */

static mct_can_verdict obey_command(mct_can_device *device, const mct_can_frame *frame)
{
    struct mct_dbc_native_drive_cmd_t command;
    mct_dbc_native_drive_cmd_unpack(&command, frame->data, frame->length);
    if (command.checksum != checksum(frame)) {
        return MCT_CAN_IS_BAD_CHECKSUM;
    }
    const int8_t newer = (int8_t)(uint8_t)(command.sequence - device->sequence);
    /* To cease is obeyed in any order: after 128 commands that were lost a newer one looks older. */
    const bool in_order = !device->has_sequence || newer > 0 || (newer != 0 && !command.enable);
    if (!in_order && !device->watchdog_expired && command.mode != MODE_CLEAR) {
        device->old_commands++;
        return newer == 0 ? MCT_CAN_IS_REPEATED : MCT_CAN_IS_OLDER;
    }
    const bool drives = command.enable && command.mode == MODE_VOLTAGE;
    device->sequence = command.sequence;
    device->has_sequence = true;
    const bool is_short = command.timeout > 0 && command.timeout < SHORTEST_TIMEOUT;
    device->watchdog_ms = is_short ? SHORTEST_TIMEOUT : command.timeout;
    device->wants_ready = command.enable && command.mode != MODE_IDLE;
    device->wants_clear |= command.mode == MODE_CLEAR;
    device->wish = MCT_CAN_WISH_VOLTS;
    /* As the host's supervisor rounds: the same bits. */
    device->value = drives ? (double)((mct_real)command.voltage / MCT_R(1000)) : 0;
    device->commands++;
    return MCT_CAN_IS_COMMAND;
}

static mct_can_verdict obey(mct_can_device *device, const mct_can_frame *frame)
{
    mct_can_verdict verdict;
    const mct_can_message *message = mct_can_sort(&mct_can_native, device->node, false, frame, &verdict);
    if (message == NULL) {
        return verdict;
    }
    if (!has_length(message, frame)) {
        return MCT_CAN_IS_BAD_LENGTH;
    }
    if (message->code == COMMAND) {
        return obey_command(device, frame);
    }
    device->wants_stop = true;
    device->wants_ready = false;
    device->wish = MCT_CAN_WISH_VOLTS;
    device->value = 0;
    return MCT_CAN_IS_STOP;
}

static void report_feedback(const mct_can_device *device, int place, mct_can_frame *frame)
{
    const double magnitude = device->value < 0 ? -device->value : device->value;
    const struct mct_dbc_native_drive_fb_t feedback = {
        .counts = device->counts[place],
        .capture_time = (uint16_t)device->time_us,
        .echo = device->sequence,
        .ready = device->state == MCT_CAN_DRIVE_READY,
        .fault = device->state == MCT_CAN_DRIVE_FAULTY,
        .watchdog_expired = device->watchdog_expired,
        .restarted = device->restarted,
        .estopped = device->estopped,
        .limited = device->wish == MCT_CAN_WISH_VOLTS && magnitude > device->supply,
        .encoder_invalid = device->encoder_invalid,
    };
    mct_dbc_native_drive_fb_pack(frame->data, &feedback, sizeof frame->data);
}

static void report_status(const mct_can_device *device, mct_can_frame *frame)
{
    const struct mct_dbc_native_drive_status_t status = {
        .bus_voltage = (uint16_t)mct_can_nearest(device->supply * 100, 0, UINT16_MAX),
        .current = (int16_t)mct_can_nearest(device->amperes * 100, INT16_MIN, INT16_MAX),
        .temperature = (int8_t)mct_can_nearest(device->temperature, INT8_MIN, INT8_MAX),
        .fault = (uint8_t)(device->error < UINT8_MAX ? device->error : UINT8_MAX),
        .serial = device->serial,
    };
    mct_dbc_native_drive_status_pack(frame->data, &status, sizeof frame->data);
}

static bool report(mct_can_device *device, int message, mct_can_frame *frame)
{
    if (message < 0 || message >= mct_can_native.message_count || !messages[message].from_drive) {
        return false;
    }
    mct_can_begin(&mct_can_native, messages[message].code, device->node, messages[message].length, frame);
    switch (messages[message].code) {
    case FEEDBACK:
        report_feedback(device, 0, frame);
        return true;
    case FEEDBACK_2:
        report_feedback(device, 1, frame);
        return (device->roles & MCT_CAN_OF_SPARE) != 0;
    case STATUS:
        report_status(device, frame);
        return true;
    default:
        frame->data[0] = REASON_BUTTON;
        return device->estopped;
    }
}

const mct_can_protocol mct_can_native = {
    .name = "native",
    .doc = "volts in, encoder counts out: see hal/socketcan/native.dbc",
    .extended = false,
    .has_spare = true,
    .has_echo = true,
    .has_state = true,
    .message_count = (int)(sizeof messages / sizeof messages[0]),
    .messages = messages,
    .identifier = identifier,
    .hear = hear,
    .command = command,
    .arm = arm,
    .stop = stop,
    .obey = obey,
    .report = report,
};

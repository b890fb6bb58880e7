/*
 * VESC: duty in, a position within the turn out. Payloads: vesc.dbc. Sources: the firmware's comm_can.c and its
 * documentation/comm_can.md.
 *
 * Volts. A brushed motor's mean voltage is duty * supply; with field orientation the q-axis voltage is
 * duty * supply / sqrt(3). The supply is the drive's own measurement when it tells (STATUS_5), else the scene's.
 *
 * Differences from a voltage source: the drive limits the duty (0.95 by default) and ramps it; a duty of zero shorts
 * the motor's terminals, a timeout releases them.
 *
 * The drive never says whether it is ready. What can be judged is what it does: one that
 * reports no duty while it is told a large one for some time does not obey (MCT_CAN_DRIVE_IDLE), and one that
 * reports a speed while its position stands still has a blind encoder, whose messages then count for nothing.
 *
 * Restart. The drive counts anew then, and says nothing of it. So a position that comes again after 0.25 s without
 * one is taken for that of another start. A drive that is up again sooner goes unnoticed.
 *
 * A status message holds no number that is not finite. The status messages that are not each tick's have one rate
 * in the drive (its second), so one period here.
 */
#include <string.h>

#include "hal/socketcan/codec.h"
#include "hal/socketcan/generated/mct_dbc_vesc.h"

enum { SET_DUTY = 0, SET_CURRENT = 1, SET_CURRENT_BRAKE = 2, STATUS = 9, STATUS_4 = 16, STATUS_5 = 27 };

#define STEPS_PER_TURN 18000 /* of 0.02 degree */
#define DUTY_STEPS     100000
#define HIGHEST_DUTY   0.95 /* the drive's default */
#define LEAST_SUPPLY   1.0  /* [V] a lower measurement is none */
#define ROOT_OF_3      1.7320508075688772
#define EVERYBODY      255 /* a controller id */
#define SURELY_MOVES   0.1 /* [turns/s] a speed that must show in the position between two status messages */
#define SEEN_DUTY      10000 /* [1e-5] that a drive which obeys shows */
#define SEEN_COMMANDS  50    /* after so many of them */

static const mct_can_message messages[] = {
    {"SET_DUTY", SET_DUTY, 4, false, MCT_CAN_OF_MOTOR, 0, 0},
    {"SET_CURRENT", SET_CURRENT, 4, false, 0, -1, -1},
    {"SET_CURRENT_BRAKE", SET_CURRENT_BRAKE, 4, false, 0, -1, -1},
    {"STATUS_4", STATUS_4, 8, true, MCT_CAN_OF_ENCODER, 0, 0},
    {"STATUS", STATUS, 8, true, MCT_CAN_OF_MOTOR | MCT_CAN_OF_ENCODER, 0.02, 0.5},
    {"STATUS_5", STATUS_5, 8, true, 0, 0.02, 0.5},
};

static uint32_t identifier(uint32_t code, uint8_t node)
{
    return code << 8 | node;
}

/* Volts of a full duty. */
static double full_voltage(const mct_scene *scene, double supply)
{
    return scene->can_mode == MCT_CAN_MODE_FOC ? supply / ROOT_OF_3 : supply;
}

/* --- the host's end --- */

static mct_can_verdict hear_position(mct_can_axis *axis, const mct_can_frame *frame)
{
    mct_can_encoder *encoder = &axis->encoders[0];
    struct mct_dbc_vesc_status_4_t status;
    mct_dbc_vesc_status_4_unpack(&status, frame->data, frame->length);
    /* The shorter way round: up to half a turn between two messages. */
    int32_t change = (status.position - (int32_t)(encoder->steps % STEPS_PER_TURN)) % STEPS_PER_TURN;
    const int32_t least = encoder->updates > 0 ? 1 - STEPS_PER_TURN / 2 : 0;
    change += change < least ? STEPS_PER_TURN : change >= least + STEPS_PER_TURN ? -STEPS_PER_TURN : 0;
    if (axis->is_frozen && change == 0) {
        return MCT_CAN_IS_REPEATED;
    }
    if (encoder->updates > 0) {
        mct_can_note_change(axis, (double)change / STEPS_PER_TURN);
    }
    axis->restarts += mct_can_was_silent(encoder, frame);
    axis->is_frozen = false;
    axis->has_moved |= change != 0;
    encoder->steps += change;
    encoder->counts = mct_can_counter((double)encoder->steps * encoder->counts_per_turn / STEPS_PER_TURN);
    encoder->updates++;
    encoder->time_us = frame->time_us;
    return encoder->used ? MCT_CAN_IS_FEEDBACK : MCT_CAN_IS_STATE;
}

static mct_can_verdict hear_status(mct_can_axis *axis, const mct_can_frame *frame)
{
    struct mct_dbc_vesc_status_t status;
    mct_dbc_vesc_status_unpack(&status, frame->data, frame->length);
    const double rate = status.electrical_speed / (60.0 * axis->scene->can_pole_pairs);
    axis->is_frozen = !axis->has_moved && mct_can_magnitude(rate) > SURELY_MOVES &&
                      mct_can_magnitude(axis->rate) > SURELY_MOVES && (rate > 0) == (axis->rate > 0);
    axis->has_moved = false;
    axis->rate = rate;
    /* One that talks and does not disobey is ready: there is nothing to ask it. */
    const bool disobeys = axis->steady_commands >= SEEN_COMMANDS && status.duty == 0;
    axis->state = disobeys ? MCT_CAN_DRIVE_IDLE : MCT_CAN_DRIVE_READY;
    axis->state_updates++;
    return MCT_CAN_IS_STATE;
}

static mct_can_verdict hear_supply(mct_can_axis *axis, const mct_can_frame *frame)
{
    struct mct_dbc_vesc_status_5_t status;
    mct_dbc_vesc_status_5_unpack(&status, frame->data, frame->length);
    axis->bus_voltage = status.voltage_in * 0.1;
    return MCT_CAN_IS_STATE;
}

static mct_can_verdict hear(mct_can_axis *axis, const mct_can_frame *frame)
{
    mct_can_verdict verdict;
    const mct_can_message *message = mct_can_sort(&mct_can_vesc, axis->node, true, frame, &verdict);
    if (message == NULL) {
        return verdict;
    }
    if (frame->length != message->length) {
        return MCT_CAN_IS_BAD_LENGTH;
    }
    return message->code == STATUS_4 ? hear_position(axis, frame)
           : message->code == STATUS ? hear_status(axis, frame)
                                     : hear_supply(axis, frame);
}

/* No current: the motor runs free at once, whereas a duty of zero is reached by the ramp. */
static void release(mct_can_axis *axis, mct_can_frame *frame)
{
    const struct mct_dbc_vesc_set_current_t nothing = {.current = 0};
    axis->steady_commands = 0;
    mct_can_begin(&mct_can_vesc, SET_CURRENT, axis->node, 4, frame);
    mct_dbc_vesc_set_current_pack(frame->data, &nothing, sizeof frame->data);
}

static void command(mct_can_axis *axis, mct_real volts, bool enable, mct_can_frame *frame)
{
    const double supply = axis->bus_voltage > LEAST_SUPPLY ? axis->bus_voltage : axis->motor.supply;
    const double full = full_voltage(axis->scene, supply);
    const double wanted = axis->motor.inverted ? -(double)volts : (double)volts;
    if (!enable || !mct_finite(volts) || !(full > 0)) {
        release(axis, frame);
        return;
    }
    const struct mct_dbc_vesc_set_duty_t duty = {
        .duty = mct_can_nearest(wanted / full * DUTY_STEPS, -DUTY_STEPS, DUTY_STEPS),
    };
    const bool is_seen = duty.duty >= SEEN_DUTY || duty.duty <= -SEEN_DUTY;
    const bool goes_on = (duty.duty > 0) == (axis->sent_duty > 0);
    axis->steady_commands = is_seen ? (goes_on ? axis->steady_commands : 0) + 1 : 0;
    axis->sent_duty = duty.duty;
    /* 4 bytes: of a longer SET_ message the firmware makes something else. */
    mct_can_begin(&mct_can_vesc, SET_DUTY, axis->node, 4, frame);
    mct_dbc_vesc_set_duty_pack(frame->data, &duty, sizeof frame->data);
}

static int arm(mct_can_axis *axis, mct_can_frame frames[MCT_CAN_MAX_BURST])
{
    (void)axis;
    (void)frames;
    return 0;
}

/* The drive latches nothing: whoever commands it next moves it. */
static int stop(mct_can_axis *axis, mct_can_frame frames[MCT_CAN_MAX_BURST])
{
    if ((axis->roles & MCT_CAN_OF_MOTOR) == 0) {
        return 0;
    }
    release(axis, &frames[0]);
    return 1;
}

/* --- the drive's end --- */

static void follow(mct_can_device *device, mct_can_wish wish, double value)
{
    device->wish = wish;
    device->value = value;
    device->wants_ready = true;
    device->commands++;
}

static mct_can_verdict obey(mct_can_device *device, const mct_can_frame *frame)
{
    mct_can_verdict verdict;
    const mct_can_message *message = mct_can_sort(&mct_can_vesc, device->node, false, frame, &verdict);
    if (message == NULL && verdict == MCT_CAN_IS_FOREIGN) {
        message = mct_can_sort(&mct_can_vesc, EVERYBODY, false, frame, &verdict);
    }
    if (message == NULL) {
        return verdict;
    }
    if (frame->length != message->length) {
        return MCT_CAN_IS_BAD_LENGTH;
    }
    /* All have one signed number of 32 bits. */
    struct mct_dbc_vesc_set_duty_t number;
    mct_dbc_vesc_set_duty_unpack(&number, frame->data, frame->length);
    const double duty = (double)number.duty / DUTY_STEPS;
    const double amperes = number.duty * 0.001;
    switch (message->code) {
    case SET_DUTY:
        follow(device, MCT_CAN_WISH_DUTY,
               duty > HIGHEST_DUTY    ? HIGHEST_DUTY
               : duty < -HIGHEST_DUTY ? -HIGHEST_DUTY
                                      : duty);
        break;
    case SET_CURRENT:
        follow(device, MCT_CAN_WISH_CURRENT, amperes);
        break;
    default: /* a brake: against the motion of this moment */
        follow(device, MCT_CAN_WISH_CURRENT,
               device->rate > 0   ? -mct_can_magnitude(amperes)
               : device->rate < 0 ? mct_can_magnitude(amperes)
                                  : 0);
        break;
    }
    return MCT_CAN_IS_COMMAND;
}

static int16_t tenths(double value)
{
    return (int16_t)mct_can_nearest(value * 10, INT16_MIN, INT16_MAX);
}

static double duty_of(const mct_can_device *device)
{
    const double full = full_voltage(device->scene, device->supply);
    return full > 0 ? device->volts / full : 0;
}

static bool report_position(const mct_can_device *device, mct_can_frame *frame)
{
    const bool known = mct_can_magnitude(device->turns) < 1e15;
    const double whole = known ? (double)(int64_t)device->turns : 0;
    const double within = known ? device->turns - whole : 0;
    const double positive = within < 0 ? within + 1 : within; /* may round to 1 */
    const struct mct_dbc_vesc_status_4_t status = {
        .temperature_fet = tenths(device->temperature),
        .temperature_motor = tenths(device->temperature),
        .current_in = tenths(device->amperes * duty_of(device)),
        .position = (int16_t)(mct_can_counter(positive * STEPS_PER_TURN) % STEPS_PER_TURN),
    };
    mct_dbc_vesc_status_4_pack(frame->data, &status, sizeof frame->data);
    return !device->encoder_invalid;
}

static void report_status(const mct_can_device *device, mct_can_frame *frame)
{
    const double speed = device->rate * 60 * device->scene->can_pole_pairs;
    const struct mct_dbc_vesc_status_t status = {
        .electrical_speed = mct_can_nearest(speed, INT32_MIN, INT32_MAX),
        .current = tenths(device->amperes),
        .duty = (int16_t)mct_can_nearest(duty_of(device) * 1000, INT16_MIN, INT16_MAX),
    };
    mct_dbc_vesc_status_pack(frame->data, &status, sizeof frame->data);
}

static void report_supply(const mct_can_device *device, mct_can_frame *frame)
{
    const struct mct_dbc_vesc_status_5_t status = {
        .tachometer = mct_can_counter(device->turns * 6 * device->scene->can_pole_pairs),
        .voltage_in = tenths(device->supply),
    };
    mct_dbc_vesc_status_5_pack(frame->data, &status, sizeof frame->data);
}

static bool report(mct_can_device *device, int message, mct_can_frame *frame)
{
    if (message < 0 || message >= mct_can_vesc.message_count || !messages[message].from_drive) {
        return false;
    }
    mct_can_begin(&mct_can_vesc, messages[message].code, device->node, messages[message].length, frame);
    switch (messages[message].code) {
    case STATUS_4:
        return report_position(device, frame);
    case STATUS:
        report_status(device, frame);
        return true;
    default:
        report_supply(device, frame);
        return true;
    }
}

const mct_can_protocol mct_can_vesc = {
    .name = "vesc",
    .doc = "VESC: duty in, position within the turn out",
    .extended = true,
    .has_spare = false,
    .has_echo = false,
    .has_state = false,
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

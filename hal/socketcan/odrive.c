/*
 * ODrive CANSimple, firmware 0.6 and 0.5.6: torque in, turns out. Payloads: odrive.dbc, odrive_0_5.dbc. Sources:
 * the maker's protocol page, and can_simple.cpp of the 0.5 firmware.
 *
 * Volts. Mode voltage: a GIMBAL motor with torque constant 1 takes its torque for volts along q. Mode torque: the
 * armature is computed here, i = (V - emf)/R with the newest speed, torque = k_T i; the current limit is the
 * drive's. A disabled command asks for no torque: the motor runs free.
 *
 * 0.5. Its estimates are 0 until the axis has been in closed loop for the first time: they are those of the
 * controller, which has no source before (get_encoder_estimates_callback). So a drive that is read only and never
 * armed would seem to stand still. Its position comes from the encoder's own counter instead, which goes on in any
 * state: counts are the scene's (of the encoder's ratio the sign alone is used). Its estimates are asked for where
 * their speed is needed, in mode torque; a count without a speed of the same time is no feedback then. 0.6 and 0.5
 * are two protocols with one code.
 *
 * Position, 0.6. A float's steps are coarse after many turns, so between its steps the speed is summed up, and
 * the sum is held within the step that the float names. Nothing drifts: the float has the last word.
 *
 * Restart. The drive does not tell. It looks like one when its axis is no longer in closed loop though nothing
 * was wrong (a stop from here leaves the error ESTOP_REQUESTED), or when its position moves further than its
 * speed allows. A counter tells no speed: that of the messages before stands for it, and after 0.25 s without one
 * nothing can be judged, which is taken for a restart.
 *
 * Repetition. The same bytes again while the drive tells a speed. A counter alone cannot be judged: what has just
 * been stopped shows the same bytes for ever.
 *
 * Stop. Torque 0 first, as the quickest way to no current; then Estop, which the drive latches whatever torque
 * comes after; IDLE in case that an old firmware takes the emergency stop late. `arm` clears it.
 */
#include <string.h>

#include "hal/socketcan/codec.h"
#include "hal/socketcan/generated/mct_dbc_odrive.h"
#include "hal/socketcan/generated/mct_dbc_odrive_0_5.h"

enum {
    HEARTBEAT = 0x01,
    ESTOP = 0x02,
    SET_AXIS_STATE = 0x07,
    ESTIMATES = 0x09,
    COUNT = 0x0A,
    SET_CONTROLLER_MODE = 0x0B,
    SET_INPUT_TORQUE = 0x0E,
    BUS = 0x17,
    CLEAR_ERRORS = 0x18
};
enum { STATE_UNDEFINED = 0, STATE_IDLE = 1, STATE_CLOSED_LOOP = 8 };
enum { CONTROL_TORQUE = 1, INPUT_PASSTHROUGH = 1 };

/* Error bits that are acted on, by firmware. */
typedef struct {
    uint32_t watchdog, estop, other;
} error_bits;
static const error_bits bits_0_6 = {0x01000000, 0x02000000, 0x2 /* SYSTEM_LEVEL */};
static const error_bits bits_0_5 = {0x800, 0x4000, 0x40 /* MOTOR_FAILED */};
enum { MOTOR_FAILED_0_5 = 0x40, ENCODER_FAILED_0_5 = 0x100, CONTROLLER_FAILED_0_5 = 0x200 };

#define AXES         (MCT_CAN_OF_MOTOR | MCT_CAN_OF_ENCODER)
#define NODE_SHIFT   5
#define SURELY_MOVED 2     /* counts */
#define JUMP         0.05  /* turns that nothing moves without a speed */
#define LATE         0.005 /* [s] that a time stamp may be wrong by */
#define HARDEST      100.0 /* [turns/s^2] that a mechanism may do while messages are lost */
#define NEAREST      0.001 /* [s] from message to message, as the drive sends them */

/* One table: what 0.6 alone has, what both have, what 0.5 alone has. */
enum { ONLY_0_6 = 2, ONLY_0_5 = 3 };
static const mct_can_message messages[] = {
    {"Get_Encoder_Estimates", ESTIMATES, 8, true, AXES, 0, 0},
    {"Clear_Errors", CLEAR_ERRORS, 1, false, AXES, -1, -1},

    {"Set_Input_Torque", SET_INPUT_TORQUE, 8, false, MCT_CAN_OF_MOTOR, 0, 0},
    {"Set_Axis_State", SET_AXIS_STATE, 8, false, MCT_CAN_OF_MOTOR, -1, -1},
    {"Set_Controller_Mode", SET_CONTROLLER_MODE, 8, false, MCT_CAN_OF_MOTOR, -1, -1},
    {"Estop", ESTOP, 0, false, MCT_CAN_OF_MOTOR, -1, -1},
    {"Heartbeat", HEARTBEAT, 8, true, AXES, 0.1, 0.5},
    {"Get_Bus_Voltage_Current", BUS, 8, true, 0, 0.1, 0.5},
    {"Estop", ESTOP, 0, true, AXES, -1, -1},

    {"Get_Encoder_Count", COUNT, 8, true, AXES, 0, 0},
    {"Get_Encoder_Estimates", ESTIMATES, 8, true, MCT_CAN_OF_TORQUE, 0, 0},
    {"Clear_Errors", CLEAR_ERRORS, 0, false, AXES, -1, -1},
};
enum { MESSAGES = sizeof messages / sizeof messages[0] };

static uint32_t identifier(uint32_t code, uint8_t node)
{
    return (uint32_t)node << NODE_SHIFT | code;
}

static bool is_0_5(const mct_can_protocol *protocol)
{
    return protocol == &mct_can_odrive_0_5;
}

static const error_bits *bits_of(const mct_can_protocol *protocol)
{
    return is_0_5(protocol) ? &bits_0_5 : &bits_0_6;
}

/* --- the host's end --- */

/* From a float to the next one. */
static double spacing(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    const uint32_t exponent = bits >> 23 & 0xFF;
    const uint32_t step = exponent > 23 ? (exponent - 23) << 23 : 1;
    float result;
    memcpy(&result, &step, sizeof result);
    return (double)result;
}

/* What was known of its position counts no more; all ones are no position. */
static void note_restart(mct_can_axis *axis)
{
    axis->restarts++;
    axis->axis_state = STATE_UNDEFINED;
    memset(axis->encoders[0].last, 0xFF, sizeof axis->encoders[0].last);
}

static bool has_position(const mct_can_encoder *encoder)
{
    bool is_one = false;
    for (size_t i = 0; i < sizeof encoder->last; i++) {
        is_one |= encoder->last[i] != 0xFF;
    }
    return encoder->updates > 0 && is_one;
}

/* Since the last feedback [s]. */
static double seconds_since(const mct_can_encoder *encoder, const mct_can_frame *frame)
{
    const int64_t us = frame->time_us - encoder->time_us;
    return us > 0 ? (double)us * 1e-6 : 0;
}

/* True for the last feedback once more, though at this speed it must have moved: `moved` turns, of `step`. */
static bool is_repeated(const mct_can_encoder *encoder, const mct_can_frame *frame, double moved, double step)
{
    return memcmp(encoder->last, frame->data, sizeof encoder->last) == 0 && moved > step &&
           moved * mct_can_magnitude(encoder->counts_per_turn) > SURELY_MOVED;
}

static mct_can_verdict note_feedback(mct_can_encoder *encoder, const mct_can_frame *frame)
{
    encoder->updates++;
    encoder->time_us = frame->time_us;
    memcpy(encoder->last, frame->data, sizeof encoder->last);
    return encoder->used ? MCT_CAN_IS_FEEDBACK : MCT_CAN_IS_STATE;
}

static mct_can_verdict hear_estimates(mct_can_axis *axis, const mct_can_frame *frame)
{
    mct_can_encoder *encoder = &axis->encoders[0];
    struct mct_dbc_odrive_get_encoder_estimates_t estimates;
    mct_dbc_odrive_get_encoder_estimates_unpack(&estimates, frame->data, frame->length);
    const double turns = (double)estimates.pos_estimate;
    const double rate = (double)estimates.vel_estimate;
    if (!mct_can_finite(turns) || !mct_can_finite(rate)) {
        return MCT_CAN_IS_NOT_FINITE;
    }
    const double step = spacing(estimates.pos_estimate);
    double refined = turns;
    if (has_position(encoder)) {
        const double seconds = seconds_since(encoder, frame);
        const double moved = mct_can_magnitude(rate) * seconds;
        const double before = mct_can_magnitude(axis->rate);
        const double fastest = before > mct_can_magnitude(rate) ? before : mct_can_magnitude(rate);
        if (is_repeated(encoder, frame, moved, step)) {
            return MCT_CAN_IS_REPEATED;
        }
        if (mct_can_magnitude(turns - encoder->turns) > JUMP + step + fastest * (seconds + LATE)) {
            note_restart(axis);
        } else {
            const double predicted = encoder->turns + 0.5 * (axis->rate + rate) * seconds;
            const double low = turns - 0.5 * step;
            const double high = turns + 0.5 * step;
            refined = predicted < low ? low : predicted > high ? high : predicted;
        }
    }
    if (encoder->updates > 0) {
        mct_can_note_change(axis, refined - encoder->turns);
    }
    axis->rate = rate;
    encoder->turns = refined;
    /* The nearest one: a whole count that a float has rounded down is that count still. */
    encoder->counts = mct_can_counter(refined * encoder->counts_per_turn + 0.5);
    return note_feedback(encoder, frame);
}

/* 0.5: only what the counter does not tell. */
static mct_can_verdict hear_speed(mct_can_axis *axis, const mct_can_frame *frame)
{
    struct mct_dbc_odrive_0_5_get_encoder_estimates_t estimates;
    mct_dbc_odrive_0_5_get_encoder_estimates_unpack(&estimates, frame->data, frame->length);
    if (!mct_can_finite((double)estimates.pos_estimate) || !mct_can_finite((double)estimates.vel_estimate)) {
        return MCT_CAN_IS_NOT_FINITE;
    }
    axis->rate = (double)estimates.vel_estimate;
    axis->rate_us = frame->time_us;
    return MCT_CAN_IS_STATE;
}

/* True when a speed that is needed has not come for some ticks. */
static bool lacks_speed(const mct_can_axis *axis, const mct_can_frame *frame)
{
    const double age = (double)(frame->time_us - axis->rate_us) * 1e-6;
    return (axis->roles & MCT_CAN_OF_TORQUE) && age > 3 * axis->scene->dt + LATE;
}

/* Turns from the last count to this one, which may be beyond the counter's end. */
static double change_of(const mct_can_encoder *encoder, int32_t counts)
{
    struct mct_dbc_odrive_0_5_get_encoder_count_t before;
    mct_dbc_odrive_0_5_get_encoder_count_unpack(&before, encoder->last, sizeof encoder->last);
    const int32_t change = (int32_t)((uint32_t)counts - (uint32_t)before.shadow_count);
    return change / mct_can_magnitude(encoder->counts_per_turn);
}

static mct_can_verdict hear_count(mct_can_axis *axis, const mct_can_frame *frame)
{
    mct_can_encoder *encoder = &axis->encoders[0];
    struct mct_dbc_odrive_0_5_get_encoder_count_t count;
    mct_dbc_odrive_0_5_get_encoder_count_unpack(&count, frame->data, frame->length);
    if (lacks_speed(axis, frame)) {
        return MCT_CAN_IS_STATE;
    }
    if (has_position(encoder)) {
        const double seconds = seconds_since(encoder, frame);
        const double change = change_of(encoder, count.shadow_count);
        const double size = mct_can_magnitude(change);
        const double speed = size / (seconds > NEAREST ? seconds : NEAREST);
        const double longest = seconds + LATE;
        const double allowed = JUMP + encoder->fastest * longest + 0.5 * HARDEST * longest * longest;
        if (is_repeated(encoder, frame, mct_can_magnitude(axis->rate) * seconds, 0)) {
            return MCT_CAN_IS_REPEATED;
        }
        mct_can_note_change(axis, change);
        if (size > allowed || mct_can_was_silent(encoder, frame)) {
            note_restart(axis);
        }
        encoder->fastest = speed > 0.5 * encoder->fastest ? speed : 0.5 * encoder->fastest;
    }
    const uint32_t counts = (uint32_t)count.shadow_count;
    encoder->counts = (int32_t)(mct_can_is_negative(encoder->counts_per_turn) ? 0 - counts : counts);
    return note_feedback(encoder, frame);
}

/* Error and state of either firmware's heartbeat; flags of 0.5 become the error bits of the same meaning. */
static uint32_t unpack_heartbeat(const mct_can_protocol *protocol, const mct_can_frame *frame, uint8_t *state)
{
    if (is_0_5(protocol)) {
        struct mct_dbc_odrive_0_5_heartbeat_t beat;
        mct_dbc_odrive_0_5_heartbeat_unpack(&beat, frame->data, frame->length);
        *state = beat.axis_state;
        return beat.axis_error | (beat.motor_error_flag ? (uint32_t)MOTOR_FAILED_0_5 : 0) |
               (beat.encoder_error_flag ? (uint32_t)ENCODER_FAILED_0_5 : 0) |
               (beat.controller_error_flag ? (uint32_t)CONTROLLER_FAILED_0_5 : 0);
    }
    struct mct_dbc_odrive_heartbeat_t beat;
    mct_dbc_odrive_heartbeat_unpack(&beat, frame->data, frame->length);
    *state = beat.axis_state;
    return beat.axis_error;
}

static mct_can_verdict hear_heartbeat(mct_can_axis *axis, const mct_can_frame *frame)
{
    const error_bits *bits = bits_of(axis->protocol);
    uint8_t state;
    const uint32_t error = unpack_heartbeat(axis->protocol, frame, &state);
    const bool was_driving = axis->axis_state == STATE_CLOSED_LOOP;
    const bool is_driving = state == STATE_CLOSED_LOOP;
    if (was_driving && !is_driving && (error == 0 || state == STATE_UNDEFINED)) {
        note_restart(axis);
    }
    axis->axis_state = state;
    axis->error = error;
    axis->watchdog_expired = (error & bits->watchdog) != 0;
    axis->estopped = (error & bits->estop) != 0;
    /* A stop that was asked for is no fault. */
    axis->state = (error & ~bits->estop) != 0 ? MCT_CAN_DRIVE_FAULTY
                  : is_driving && error == 0  ? MCT_CAN_DRIVE_READY
                                              : MCT_CAN_DRIVE_IDLE;
    axis->state_updates++;
    return MCT_CAN_IS_STATE;
}

static mct_can_verdict hear_bus(mct_can_axis *axis, const mct_can_frame *frame)
{
    struct mct_dbc_odrive_get_bus_voltage_current_t bus;
    mct_dbc_odrive_get_bus_voltage_current_unpack(&bus, frame->data, frame->length);
    if (!mct_can_finite((double)bus.bus_voltage)) {
        return MCT_CAN_IS_NOT_FINITE;
    }
    axis->bus_voltage = (double)bus.bus_voltage;
    return MCT_CAN_IS_STATE;
}

static mct_can_verdict hear(mct_can_axis *axis, const mct_can_frame *frame)
{
    mct_can_verdict verdict;
    const mct_can_message *message = mct_can_sort(axis->protocol, axis->node, true, frame, &verdict);
    if (message == NULL) {
        return verdict;
    }
    if (message->code == ESTOP) {
        return MCT_CAN_IS_STOP; /* whatever its length */
    }
    if (frame->length != message->length) {
        return MCT_CAN_IS_BAD_LENGTH;
    }
    switch (message->code) {
    case COUNT:
        return hear_count(axis, frame);
    case ESTIMATES:
        return is_0_5(axis->protocol) ? hear_speed(axis, frame) : hear_estimates(axis, frame);
    case HEARTBEAT:
        return hear_heartbeat(axis, frame);
    default:
        return hear_bus(axis, frame);
    }
}

static void fill_torque(const mct_can_axis *axis, float torque, mct_can_frame *frame)
{
    const struct mct_dbc_odrive_set_input_torque_t input = {.input_torque = torque};
    mct_can_begin(axis->protocol, SET_INPUT_TORQUE, axis->node, 8, frame);
    mct_dbc_odrive_set_input_torque_pack(frame->data, &input, sizeof frame->data);
}

static void fill_state(const mct_can_axis *axis, uint32_t state, mct_can_frame *frame)
{
    const struct mct_dbc_odrive_set_axis_state_t request = {.axis_requested_state = state};
    mct_can_begin(axis->protocol, SET_AXIS_STATE, axis->node, 8, frame);
    mct_dbc_odrive_set_axis_state_pack(frame->data, &request, sizeof frame->data);
}

static void fill_clear(const mct_can_axis *axis, mct_can_frame *frame)
{
    const uint8_t length = is_0_5(axis->protocol) ? 0 : 1;
    mct_can_begin(axis->protocol, CLEAR_ERRORS, axis->node, length, frame);
}

/* The armature, which the drive does not have: all in the drive's own sense of rotation. */
static double within(double value, double bound)
{
    return value > bound ? bound : value < -bound ? -bound : value;
}

static double torque_of(const mct_can_axis *axis, double volts)
{
    const mct_can_motor *motor = &axis->motor;
    /* A motor driven by its supply cannot turn faster than twice its own speed: who says so is not believed. */
    const double emf = within(motor->emf_per_turn * axis->rate, 2 * motor->supply);
    const double amperes = (within(volts, motor->supply) - emf) / motor->resistance;
    return motor->resistance > 0 ? motor->torque_per_ampere * amperes : 0;
}

static void command(mct_can_axis *axis, mct_real volts, bool enable, mct_can_frame *frame)
{
    const double wanted = axis->motor.inverted ? -(double)volts : (double)volts;
    const double value = axis->scene->can_mode == MCT_CAN_MODE_TORQUE ? torque_of(axis, wanted) : wanted;
    const bool drives = enable && mct_finite(volts) && mct_can_finite(value);
    fill_torque(axis, drives ? mct_can_float(value) : 0, frame);
}

/* Torque first: the drive remembers the last one. The mode must be set before closed loop. */
static int arm(mct_can_axis *axis, mct_can_frame frames[MCT_CAN_MAX_BURST])
{
    const struct mct_dbc_odrive_set_controller_mode_t mode = {CONTROL_TORQUE, INPUT_PASSTHROUGH};
    axis->state = MCT_CAN_DRIVE_UNKNOWN;
    if ((axis->roles & MCT_CAN_OF_MOTOR) == 0) {
        fill_clear(axis, &frames[0]); /* an axis that is only read is never powered */
        return 1;
    }
    fill_torque(axis, 0, &frames[0]);
    fill_clear(axis, &frames[1]);
    mct_can_begin(axis->protocol, SET_CONTROLLER_MODE, axis->node, 8, &frames[2]);
    mct_dbc_odrive_set_controller_mode_pack(frames[2].data, &mode, sizeof frames[2].data);
    fill_state(axis, STATE_CLOSED_LOOP, &frames[3]);
    return 4;
}

static int stop(mct_can_axis *axis, mct_can_frame frames[MCT_CAN_MAX_BURST])
{
    if ((axis->roles & MCT_CAN_OF_MOTOR) == 0) {
        return 0;
    }
    fill_torque(axis, 0, &frames[0]);
    mct_can_begin(axis->protocol, ESTOP, axis->node, 0, &frames[1]);
    fill_state(axis, STATE_IDLE, &frames[2]);
    return 3;
}

/* --- the drive's end --- */

static void release(mct_can_device *device)
{
    device->wants_ready = false;
    device->wish = MCT_CAN_WISH_RELEASE;
    device->value = 0;
}

static mct_can_verdict obey_torque(mct_can_device *device, const mct_can_frame *frame)
{
    struct mct_dbc_odrive_set_input_torque_t input;
    mct_dbc_odrive_set_input_torque_unpack(&input, frame->data, sizeof frame->data);
    if (!mct_can_finite((double)input.input_torque)) {
        return MCT_CAN_IS_NOT_FINITE;
    }
    const bool is_torque = device->scene->can_mode == MCT_CAN_MODE_TORQUE;
    device->wish = is_torque ? MCT_CAN_WISH_TORQUE : MCT_CAN_WISH_VOLTS;
    device->value = (double)input.input_torque;
    device->commands++;
    return MCT_CAN_IS_COMMAND;
}

static mct_can_verdict obey_state(mct_can_device *device, const mct_can_frame *frame)
{
    struct mct_dbc_odrive_set_axis_state_t request;
    mct_dbc_odrive_set_axis_state_unpack(&request, frame->data, sizeof frame->data);
    if (request.axis_requested_state == STATE_CLOSED_LOOP) {
        device->wants_ready = true;
    } else if (request.axis_requested_state == STATE_IDLE) {
        release(device);
    }
    return MCT_CAN_IS_REQUEST;
}

/* Every frame to the axis feeds the watchdog, also one that it does not know. Of a frame it needs what it reads:
 * padding may be missing. */
static mct_can_verdict obey(mct_can_device *device, const mct_can_frame *frame)
{
    if (frame->id >> NODE_SHIFT != device->node) {
        return MCT_CAN_IS_FOREIGN;
    }
    if (frame->extended) {
        return MCT_CAN_IS_BAD_FORMAT;
    }
    if (frame->remote) {
        return MCT_CAN_IS_REMOTE;
    }
    const uint32_t code = frame->id & ((1 << NODE_SHIFT) - 1);
    const uint8_t least = code == SET_CONTROLLER_MODE                          ? 8
                          : code == SET_INPUT_TORQUE || code == SET_AXIS_STATE ? 4
                                                                               : 0;
    if (frame->length < least || frame->length > sizeof frame->data) {
        return MCT_CAN_IS_BAD_LENGTH;
    }
    switch (code) {
    case SET_INPUT_TORQUE:
        return obey_torque(device, frame);
    case SET_AXIS_STATE:
        return obey_state(device, frame);
    case CLEAR_ERRORS:
        device->wants_clear = true;
        return MCT_CAN_IS_REQUEST;
    case ESTOP:
        device->wants_stop = true;
        release(device);
        return MCT_CAN_IS_STOP;
    default:
        return MCT_CAN_IS_REQUEST;
    }
}

static void report_heartbeat(const mct_can_device *device, mct_can_frame *frame)
{
    const error_bits *bits = bits_of(device->protocol);
    const bool other = device->state == MCT_CAN_DRIVE_FAULTY && device->error == 0 &&
                       !device->watchdog_expired && !device->estopped;
    const uint32_t error = device->error | (device->watchdog_expired ? bits->watchdog : 0) |
                           (device->estopped ? bits->estop : 0) | (other ? bits->other : 0);
    const uint8_t state = device->state == MCT_CAN_DRIVE_UNKNOWN ? STATE_UNDEFINED
                          : device->state == MCT_CAN_DRIVE_READY ? STATE_CLOSED_LOOP
                                                                 : STATE_IDLE;
    if (is_0_5(device->protocol)) {
        const struct mct_dbc_odrive_0_5_heartbeat_t beat = {
            .axis_error = error,
            .axis_state = state,
            .motor_error_flag = (error & MOTOR_FAILED_0_5) != 0,
            .encoder_error_flag = (error & ENCODER_FAILED_0_5) != 0,
            .controller_error_flag = (error & CONTROLLER_FAILED_0_5) != 0,
            .trajectory_done_flag = 1,
        };
        mct_dbc_odrive_0_5_heartbeat_pack(frame->data, &beat, sizeof frame->data);
    } else {
        const struct mct_dbc_odrive_heartbeat_t beat = {
            .axis_error = error,
            .axis_state = state,
            .trajectory_done_flag = 1,
        };
        mct_dbc_odrive_heartbeat_pack(frame->data, &beat, sizeof frame->data);
    }
}

/* What has no position: 0.6 says NaN, as of an encoder that has lost it, and 0.5 says 0. */
static void report_estimates(const mct_can_device *device, mct_can_frame *frame)
{
    const uint32_t bits = is_0_5(device->protocol) ? 0 : UINT32_MAX; /* all ones: a NaN */
    const bool is_known = !device->encoder_invalid && (device->has_driven || !is_0_5(device->protocol));
    float nothing;
    memcpy(&nothing, &bits, sizeof nothing);
    const struct mct_dbc_odrive_get_encoder_estimates_t estimates = {
        .pos_estimate = is_known ? mct_can_float(device->turns) : nothing,
        .vel_estimate = is_known ? mct_can_float(device->rate) : nothing,
    };
    mct_dbc_odrive_get_encoder_estimates_pack(frame->data, &estimates, sizeof frame->data);
}

static bool report_count(const mct_can_device *device, mct_can_frame *frame)
{
    const int32_t turn = device->counts_per_turn;
    const int32_t within = turn > 0 ? device->counts[0] % turn : 0;
    const struct mct_dbc_odrive_0_5_get_encoder_count_t count = {
        .shadow_count = device->counts[0],
        .count_in_cpr = within < 0 ? within + turn : within,
    };
    mct_dbc_odrive_0_5_get_encoder_count_pack(frame->data, &count, sizeof frame->data);
    return !device->encoder_invalid;
}

static void report_bus(const mct_can_device *device, mct_can_frame *frame)
{
    const double power = device->volts * device->amperes;
    const struct mct_dbc_odrive_get_bus_voltage_current_t bus = {
        .bus_voltage = mct_can_float(device->supply),
        .bus_current = device->supply > 0 ? mct_can_float(power / device->supply) : 0,
    };
    mct_dbc_odrive_get_bus_voltage_current_pack(frame->data, &bus, sizeof frame->data);
}

static bool report(mct_can_device *device, int number, mct_can_frame *frame)
{
    const mct_can_protocol *protocol = device->protocol;
    if (number < 0 || number >= protocol->message_count || !protocol->messages[number].from_drive) {
        return false;
    }
    const mct_can_message *message = &protocol->messages[number];
    mct_can_begin(protocol, message->code, device->node, message->length, frame);
    switch (message->code) {
    case COUNT:
        return report_count(device, frame);
    case ESTIMATES:
        report_estimates(device, frame);
        return true;
    case HEARTBEAT:
        report_heartbeat(device, frame);
        return true;
    case BUS:
        report_bus(device, frame);
        return true;
    default: /* an emergency stop is never the drive's own */
        return false;
    }
}

#define PROTOCOL(documentation, first, count)                                                               \
    {                                                                                                       \
        .name = "odrive", .doc = (documentation), .extended = false, .has_spare = false, .has_echo = false, \
        .has_state = true, .message_count = (count), .messages = messages + (first),                        \
        .identifier = identifier, .hear = hear, .command = command, .arm = arm, .stop = stop, .obey = obey, \
        .report = report,                                                                                   \
    }

const mct_can_protocol mct_can_odrive =
    PROTOCOL("ODrive CANSimple: torque or q-axis volts in, turns out", 0, MESSAGES - ONLY_0_5);

const mct_can_protocol mct_can_odrive_0_5 =
    PROTOCOL("ODrive CANSimple 0.5: torque or q-axis volts in, counts out", ONLY_0_6, MESSAGES - ONLY_0_6);

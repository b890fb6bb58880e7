/*
 * Arbitrary frames into both ends of every protocol.
 *
 * Input: a byte for the scene, then records of FUZZ_CAN_FRAME + 2 bytes: what to do, how much later, and a frame.
 */
#include <math.h>
#include <string.h>

#include "fuzz/can_scenes.h"
#include "fuzz/fuzz.h"
#include "hal/socketcan/codec.h"

enum { RECORD = FUZZ_CAN_FRAME + 2, SCENES = FUZZ_CAN_SCENES };

typedef struct {
    mct_can_axes axes;
    mct_can_device devices[MCT_CAN_MAX_AXES];
} ends;

static void check_axis(const mct_can_axis *axis)
{
    FUZZ_RULE(isfinite(axis->rate), "a rate is finite: %g", axis->rate);
    FUZZ_RULE(isfinite(mct_can_bus_voltage(axis)), "a bus voltage is finite: %g", mct_can_bus_voltage(axis));
    FUZZ_RULE(axis->state <= MCT_CAN_DRIVE_FAULTY, "a state is one of the four: %d", (int)axis->state);
    for (int i = 0; i < MCT_CAN_ENCODERS; i++) {
        FUZZ_RULE(isfinite(axis->encoders[i].turns), "turns are finite: %g", axis->encoders[i].turns);
    }
}

/* A native drive's clock tells what is new, unless so much time has passed that it may have wrapped. */
static void check_order(const mct_can_encoder *before, const mct_can_encoder *after)
{
    if (before->updates == 0 || after->updates == before->updates) {
        return;
    }
    const int16_t newer = (int16_t)(uint16_t)(after->capture_us - before->capture_us);
    FUZZ_RULE(memcmp(before->last, after->last, sizeof after->last) != 0,
              "the same once more is no feedback");
    FUZZ_RULE(newer >= 0 || after->time_us - before->time_us >= 30000, "what is older is no feedback");
}

static void hear(ends *self, const mct_can_frame *frame)
{
    for (int i = 0; i < self->axes.count; i++) {
        mct_can_axis *axis = &self->axes.axes[i];
        mct_can_axis before;
        memcpy(&before, axis, sizeof before);
        const mct_can_verdict verdict = self->axes.protocol->hear(axis, frame);
        FUZZ_RULE(verdict != MCT_CAN_IS_COMMAND && verdict != MCT_CAN_IS_REQUEST,
                  "a host is told what to do by nobody");
        if (verdict >= MCT_CAN_IS_FOREIGN) {
            FUZZ_RULE(memcmp(&before, axis, sizeof before) == 0,
                      "a frame that is refused (%d) changes nothing", (int)verdict);
        }
        uint32_t updates = 0, updates_before = 0;
        for (int j = 0; j < MCT_CAN_ENCODERS; j++) {
            updates += axis->encoders[j].used ? axis->encoders[j].updates : 0;
            updates_before += before.encoders[j].used ? before.encoders[j].updates : 0;
            if (self->axes.protocol == &mct_can_native) {
                check_order(&before.encoders[j], &axis->encoders[j]);
            }
        }
        FUZZ_RULE(updates - updates_before == (verdict == MCT_CAN_IS_FEEDBACK),
                  "feedback is one update, else there is none");
        if (verdict == MCT_CAN_IS_FEEDBACK) {
            FUZZ_RULE(!frame->remote && frame->extended == self->axes.protocol->extended &&
                          frame->length == 8,
                      "feedback has the protocol's form");
        }
        check_axis(axis);
    }
}

static void check_device(const mct_can_device *device)
{
    FUZZ_RULE(isfinite(device->value), "what a drive follows is finite: %g", device->value);
    FUZZ_RULE(device->wish <= MCT_CAN_WISH_TORQUE, "a wish is one of the five: %d", (int)device->wish);
    FUZZ_RULE(device->wish != MCT_CAN_WISH_DUTY || fabs(device->value) <= 0.95, "duty is limited: %g",
              device->value);
}

/* No bit of an obeyed command can be another one. */
static void check_checksum(const mct_can_device *before, const mct_can_frame *frame)
{
    for (int bit = 0; bit < 64; bit += 7) {
        mct_can_device device = *before;
        mct_can_frame changed = *frame;
        changed.data[bit / 8] = (uint8_t)(changed.data[bit / 8] ^ 1u << bit % 8);
        FUZZ_RULE(device.protocol->obey(&device, &changed) == MCT_CAN_IS_BAD_CHECKSUM,
                  "a checksum shows a wrong bit");
    }
}

static void obey(ends *self, const mct_can_frame *frame)
{
    for (int i = 0; i < self->axes.count; i++) {
        mct_can_device *device = &self->devices[i];
        mct_can_device before;
        memcpy(&before, device, sizeof before);
        const mct_can_verdict verdict = self->axes.protocol->obey(device, frame);
        FUZZ_RULE(verdict != MCT_CAN_IS_FEEDBACK, "a drive is told no position");
        const bool is_old = verdict == MCT_CAN_IS_REPEATED || verdict == MCT_CAN_IS_OLDER;
        if (verdict >= MCT_CAN_IS_FOREIGN) {
            before.old_commands += is_old;
            FUZZ_RULE(memcmp(&before, device, sizeof before) == 0,
                      "a frame that is refused (%d) changes nothing", (int)verdict);
        }
        FUZZ_RULE(device->commands - before.commands == (verdict == MCT_CAN_IS_COMMAND),
                  "a command is counted once");
        check_device(device);
        if (self->axes.protocol == &mct_can_native && verdict == MCT_CAN_IS_COMMAND) {
            check_checksum(&before, frame);
        }
    }
}

/* What a frame looks like that was made here. */
static void check_made(const ends *self, const mct_can_frame *frame)
{
    FUZZ_RULE(frame->length <= 8 && !frame->remote && frame->extended == self->axes.protocol->extended,
              "a frame that is sent has the protocol's form");
    FUZZ_RULE(frame->id < (frame->extended ? 1u << 29 : 1u << 11), "an identifier fits its bits: %x",
              frame->id);
    for (int i = frame->length; i < 8; i++) {
        FUZZ_RULE(frame->data[i] == 0, "data are zero beyond the length");
    }
}

/* Any volts at all: what the drive makes of them, and that a drive obeys its own host. */
static void command(ends *self, const uint8_t bytes[FUZZ_CAN_FRAME])
{
    mct_can_axis *axis = &self->axes.axes[0];
    mct_can_device *device = &self->devices[0];
    mct_can_frame frame;
    mct_real volts;
    const bool enable = bytes[0] & 1;
    if ((bytes[0] & 6) == 6) {
        static const mct_real special[] = {INFINITY,     -INFINITY,     NAN,
                                           MCT_REAL_MAX, -MCT_REAL_MAX, MCT_R(1e-30)};
        volts = special[bytes[1] % 6];
    } else if (bytes[0] & 2) {
        memcpy(&volts, bytes + 4, sizeof volts);
    } else {
        int16_t millivolts;
        memcpy(&millivolts, bytes + 4, sizeof millivolts);
        volts = (mct_real)millivolts / 1000;
    }
    self->axes.protocol->command(axis, volts, enable, &frame);
    check_made(self, &frame);
    obey(self, &frame);
    device->watchdog_expired = true; /* any number of a command is taken */
    FUZZ_RULE(self->axes.protocol->obey(device, &frame) == MCT_CAN_IS_COMMAND, "a drive obeys its host");
    check_device(device);
    const bool zero = !enable || !isfinite((double)volts);
    FUZZ_RULE(!zero || device->value == 0, "disabled or not a number: told zero, not %g", device->value);
    const double sent = axis->motor.inverted ? -(double)volts : (double)volts;
    if (!zero && device->wish == MCT_CAN_WISH_VOLTS && fabs((double)volts) < 2e6) {
        FUZZ_RULE(fabs(device->value - sent) <= 0.5001e-3 + 1e-6 * fabs(sent), "%g V arrive as %g V", sent,
                  device->value);
    }
    if (device->wish == MCT_CAN_WISH_DUTY) {
        const uint32_t bits = (uint32_t)frame.data[0] << 24 | (uint32_t)frame.data[1] << 16 |
                              (uint32_t)frame.data[2] << 8 | frame.data[3];
        FUZZ_RULE((int32_t)bits <= 100000 && (int32_t)bits >= -100000, "no duty beyond the supply: %d",
                  (int32_t)bits);
    }
    if (device->wish == MCT_CAN_WISH_DUTY && device->value != 0) {
        FUZZ_RULE(device->value * sent > 0, "duty has the sign of its voltage");
    }
}

static void ask(ends *self, uint8_t which)
{
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    for (int i = 0; i < self->axes.count; i++) {
        mct_can_axis *axis = &self->axes.axes[i];
        const bool stops = which & 1;
        const int count =
            stops ? self->axes.protocol->stop(axis, frames) : self->axes.protocol->arm(axis, frames);
        FUZZ_RULE(count >= 0 && count <= MCT_CAN_MAX_BURST, "a burst fits: %d", count);
        for (int j = 0; j < count; j++) {
            check_made(self, &frames[j]);
            const mct_can_verdict verdict = self->axes.protocol->obey(&self->devices[i], &frames[j]);
            FUZZ_RULE(verdict <= MCT_CAN_IS_REQUEST || verdict == MCT_CAN_IS_OLDER ||
                          verdict == MCT_CAN_IS_REPEATED,
                      "a drive understands its host (%d)", (int)verdict);
        }
        FUZZ_RULE(self->devices[i].value == 0 || i > 0 || count == 0, "a request brings no volts");
    }
}

/* A drive in any condition tells it, and the host understands. */
static void report(ends *self, const uint8_t bytes[FUZZ_CAN_FRAME], int64_t time_us)
{
    const int number = (bytes[0] & 3) % self->axes.count;
    mct_can_device *device = &self->devices[number];
    mct_can_device before;
    double value;
    memcpy(&before, device, sizeof before);
    memcpy(&value, bytes + 4, sizeof value);
    device->state = (mct_can_drive_state)(bytes[1] & 3);
    device->error = bytes[2];
    device->watchdog_expired = bytes[1] & 4;
    device->estopped = bytes[1] & 8;
    device->restarted = bytes[1] & 16;
    device->encoder_invalid = bytes[1] & 32;
    device->time_us = (uint64_t)time_us;
    memcpy(device->counts, bytes + 4, sizeof device->counts);
    device->turns = bytes[3] & 1 ? value : 1.5;
    device->rate = bytes[3] & 2 ? value : -2.5;
    device->amperes = bytes[3] & 4 ? value : 3;
    device->volts = bytes[3] & 8 ? value : 3;
    device->supply = bytes[3] & 16 ? value : 24;
    device->temperature = bytes[3] & 32 ? value : 25;
    for (int i = -1; i <= self->axes.protocol->message_count; i++) {
        mct_can_frame frame;
        if (self->axes.protocol->report(device, i, &frame)) {
            check_made(self, &frame);
            frame.time_us = time_us;
            hear(self, &frame);
        }
    }
    memcpy(device, &before, sizeof before);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static mct_scene scenes[SCENES];
    static ends starts[SCENES];
    static bool made;
    for (int i = 0; !made && i < SCENES; i++) {
        mct_message why = {""};
        scenes[i] = fuzz_can_scene(i);
        FUZZ_RULE(mct_can_axes_init(&starts[i].axes, &scenes[i], &why) == MCT_OK, "axes of scene %d: %s", i,
                  why.text);
        for (int j = 0; j < starts[i].axes.count; j++) {
            starts[i].devices[j] = fuzz_can_device(&starts[i].axes, j);
        }
    }
    made = true;
    if (size == 0) {
        return 0;
    }
    ends self = starts[data[0] % SCENES];
    int64_t time_us = 0;
    for (size_t at = 1; at + RECORD <= size; at += RECORD) {
        const uint8_t *bytes = data + at + 2;
        mct_can_frame frame = fuzz_can_frame(&self.axes, bytes);
        /* At most an hour later, or a little earlier. */
        time_us += data[at + 1] < 0xF0 ? data[at + 1] * 100 : data[at + 1] < 0xF8 ? 3600000000 : -1000;
        frame.time_us = time_us;
        switch (data[at] % 8) {
        case 0:
        case 1:
        case 2:
            hear(&self, &frame);
            break;
        case 3:
        case 4:
            obey(&self, &frame);
            break;
        case 5:
            command(&self, bytes);
            break;
        case 6:
            ask(&self, bytes[0]);
            break;
        default:
            report(&self, bytes, time_us);
            break;
        }
    }
    return 0;
}

/* Every message of every scene, twice with other data; then requests, commands, reports. */
size_t fuzz_seed(int number, uint8_t *out)
{
    static const uint8_t some[3][8] = {{0}, {1, 2, 3, 4, 5, 6, 7, 1}, {0, 0, 0xC0, 0x3F, 0, 0, 0x20, 0xC0}};
    size_t size = 1;
    if (number >= SCENES) {
        return 0;
    }
    out[0] = (uint8_t)number;
    for (int k = 0; k < 3; k++) {
        for (int message = 0; message < 9; message++) {
            for (int what = 0; what < 8; what += 3) {
                out[size] = (uint8_t)(what == 6 ? 5 + message % 3 : what);
                out[size + 1] = 10;
                fuzz_can_bytes(message % 2, message, 8, some[k], out + size + 2);
                size += RECORD;
            }
        }
    }
    return size;
}

#include "hal/socketcan/protocol.h"

#include <string.h>

#include "hal/socketcan/codec.h"

const mct_can_protocol *const mct_can_protocols[MCT_CAN_PROTOCOL_COUNT] = {
    [MCT_CAN_NATIVE] = &mct_can_native,
    [MCT_CAN_VESC] = &mct_can_vesc,
    [MCT_CAN_ODRIVE] = &mct_can_odrive,
};

const mct_can_protocol *mct_can_protocol_of(const mct_scene *scene)
{
    const bool is_0_5 = scene->can_protocol == MCT_CAN_ODRIVE && scene->can_firmware == MCT_CAN_FIRMWARE_0_5;
    return is_0_5 ? &mct_can_odrive_0_5 : mct_can_protocols[scene->can_protocol];
}

double mct_can_bus_voltage(const mct_can_axis *axis)
{
    return axis->bus_10mv > 0 ? axis->bus_10mv * 0.01 : axis->bus_voltage;
}

/* Start, identifier, control, checksum of 15 bits, acknowledgement, end of 7 bits, gap of 3. */
int mct_can_nominal_bits(bool extended, int length)
{
    return (extended ? 67 : 47) + 8 * length;
}

/* From the start to the checksum a bit follows on each five equal ones, itself among the next five. */
int mct_can_stuffed_bits(bool extended, int length)
{
    const int stuffed = (extended ? 54 : 34) + 8 * length;
    return mct_can_nominal_bits(extended, length) + (stuffed - 1) / 4;
}

const mct_can_message *mct_can_sort(const mct_can_protocol *protocol, uint8_t node, bool from_drive,
                                    const mct_can_frame *frame, mct_can_verdict *verdict)
{
    *verdict = MCT_CAN_IS_FOREIGN;
    for (int i = 0; i < protocol->message_count; i++) {
        const mct_can_message *message = &protocol->messages[i];
        if (message->from_drive != from_drive || protocol->identifier(message->code, node) != frame->id) {
            continue;
        }
        if (frame->extended != protocol->extended) {
            *verdict = MCT_CAN_IS_BAD_FORMAT;
            return NULL;
        }
        if (frame->remote) {
            *verdict = MCT_CAN_IS_REMOTE;
            return NULL;
        }
        return message;
    }
    return NULL;
}

void mct_can_begin(const mct_can_protocol *protocol, uint32_t code, uint8_t node, uint8_t length,
                   mct_can_frame *frame)
{
    memset(frame, 0, sizeof *frame);
    frame->id = protocol->identifier(code, node);
    frame->extended = protocol->extended;
    frame->length = length;
}

void mct_can_note_change(mct_can_axis *axis, double turns)
{
    const double least = 1.0 / 64;
    const double apart = mct_can_magnitude(axis->change + turns);
    const bool is_back = apart < least || (apart > 1 - least && apart < 1 + least);
    if (mct_can_magnitude(axis->change) > least && mct_can_magnitude(turns) > least && is_back) {
        axis->alternations++;
    }
    axis->change = turns;
}

bool mct_can_was_silent(const mct_can_encoder *encoder, const mct_can_frame *frame)
{
    const int64_t longest_us = 250000;
    return encoder->updates > 0 && frame->time_us - encoder->time_us > longest_us;
}

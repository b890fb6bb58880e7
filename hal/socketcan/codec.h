/**
 * @file codec.h
 * What the protocols share: which message a frame is, and conversions that are defined for every number.
 */
#ifndef MCTAU_HAL_SOCKETCAN_CODEC_H
#define MCTAU_HAL_SOCKETCAN_CODEC_H

#include <float.h>
#include <string.h>

#include "hal/socketcan/protocol.h"

/**
 * The message of a node that a frame is, whatever its length; NULL when it is none, with the reason in
 * `verdict`: foreign, of the other format or a remote request.
 * @param from_drive  which end asks: true the host's
 */
const mct_can_message *mct_can_sort(const mct_can_protocol *protocol, uint8_t node, bool from_drive,
                                    const mct_can_frame *frame, mct_can_verdict *verdict);

/** A frame to or from a node, its data zero. */
void mct_can_begin(const mct_can_protocol *protocol, uint32_t code, uint8_t node, uint8_t length,
                   mct_can_frame *frame);

/**
 * Keeps how far a position has moved since the message before, and counts in `axis->alternations` the times that it
 * went there and back at once. Two drives under one number do so, each with a position of its own. Nothing that moves
 * does: over 1/64 turn, in two messages a millisecond apart, it would take 3e4 turns/s^2. What begins and ends within
 * a turn may also be back by the other way round.
 */
void mct_can_note_change(mct_can_axis *axis, double turns);

/** True when a position comes after so long a silence that its drive may have restarted meanwhile. */
bool mct_can_was_silent(const mct_can_encoder *encoder, const mct_can_frame *frame);

static inline double mct_can_magnitude(double value)
{
    return value < 0 ? -value : value;
}

/** The sign alone: without arithmetic in double, which many a float target has in software. */
static inline bool mct_can_is_negative(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits >> 63 != 0;
}

static inline bool mct_can_finite(double value)
{
    return value - value == 0;
}

/** The nearest integer within [low, high], halves away from zero; NaN becomes what is nearest to zero. */
static inline int32_t mct_can_nearest(double value, int32_t low, int32_t high)
{
    const double known = value == value ? value : 0;
    if (known <= low) {
        return low;
    }
    if (known >= high) {
        return high;
    }
    const int32_t whole = (int32_t)known; /* towards zero */
    const double rest = known - whole;
    return rest >= 0.5 ? whole + 1 : rest <= -0.5 ? whole - 1 : whole;
}

/** The same in the core's scalar, without double arithmetic on a float target. */
static inline int32_t mct_can_nearest_real(mct_real value, int32_t bound)
{
    if (!(value > -(mct_real)bound)) {
        return value == value ? -bound : 0;
    }
    if (value >= (mct_real)bound) {
        return bound;
    }
    const int32_t whole = (int32_t)value;
    const mct_real rest = value - (mct_real)whole;
    return rest >= MCT_R(0.5) ? whole + 1 : rest <= MCT_R(-0.5) ? whole - 1 : whole;
}

/** The nearest float; what is beyond becomes the largest. NaN stays NaN. */
static inline float mct_can_float(double value)
{
    const double largest = (double)FLT_MAX;
    return (float)(value > largest ? largest : value < -largest ? -largest : value);
}

/** The largest integer that is not above, wrapped to 32 bits as a counter wraps; 0 for what is not finite. */
static inline int32_t mct_can_counter(double value)
{
    const double span = 4294967296.0;
    /* Beyond this every double is a multiple of the span. */
    /* cppcheck-suppress incorrectLogicOperator; it reads the 0x1 of 0x1p85 alone */
    if (!(value < 0x1p85 && value > -0x1p85)) {
        return 0;
    }
    const double rest = value - (double)(int64_t)(value / span) * span; /* exact */
    const int64_t whole = (int64_t)rest;
    return (int32_t)(uint32_t)(uint64_t)(rest < (double)whole ? whole - 1 : whole);
}

#endif

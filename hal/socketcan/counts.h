/**
 * @file counts.h
 * Everything that can happen on the bus, each counted: in telemetry, in the summary of a run, in the docs.
 *
 * One thread writes (the loop's), any may read. A new count is a line here.
 */
#ifndef MCTAU_HAL_SOCKETCAN_COUNTS_H
#define MCTAU_HAL_SOCKETCAN_COUNTS_H

#include "hal/hal.h"

/** Each count once: identifier, name, what it means and what to look at. */
#define MCT_CAN_COUNT_LIST(COUNT)                                                                           \
    COUNT(SENT, sent, "frames handed to the bus")                                                           \
    COUNT(CONFIRMED, confirmed, "commands that the bus has taken, as the controller chip says")             \
    COUNT(QUEUE_FULL, queue_full,                                                                           \
          "commands given up because the send queue was full; they are not repeated")                       \
    COUNT(HELD_BACK, held_back, "commands given up because the one before was still unsent")                \
    COUNT(RECEIVED, received, "frames received from the drives")                                            \
    COUNT(SKIPPED, skipped, "feedback frames passed over because a newer one had come by the same tick")    \
    COUNT(OVERFLOWED, overflowed, "frames lost because the receive queue was full")                         \
    COUNT(FOREIGN, foreign, "frames that belong to nobody here")                                            \
    COUNT(BAD_LENGTH, bad_length, "frames refused: wrong length")                                           \
    COUNT(BAD_FORMAT, bad_format, "frames refused: 11 bits of identifier in place of 29, or the reverse")   \
    COUNT(REMOTE, remote, "frames refused: remote requests")                                                \
    COUNT(NOT_FINITE, not_finite, "frames refused: a number in them was not finite or the encoder invalid") \
    COUNT(REPEATED, repeated, "feedback frames refused: the one before once more")                          \
    COUNT(OUT_OF_ORDER, out_of_order, "feedback frames refused: older than one already taken")              \
    COUNT(ANSWER_LATE, answer_late, "feedback that answers a command two or more ticks old")                \
    COUNT(NO_FEEDBACK, no_feedback, "ticks on which an encoder had nothing new")                            \
    COUNT(ERROR_FRAMES, error_frames, "errors that the controller chip reported")                           \
    COUNT(NO_ACKNOWLEDGE, no_acknowledge, "errors: nobody acknowledged a frame; is another node alive?")    \
    COUNT(BUS_ERRORS, bus_errors, "errors: bits or forms violated; wrong bit rate, wiring or termination")  \
    COUNT(ERROR_PASSIVE, error_passive, "times the controller chip became error-passive")                   \
    COUNT(BUS_OFF, bus_off, "times the controller chip left the bus")                                       \
    COUNT(LINK_LOST, link_lost, "times the interface went down or away, bus-off included")                  \
    COUNT(LINK_BACK, link_back, "times it came back")                                                       \
    COUNT(DRIVE_FAULTS, drive_faults, "times a drive reported an error")                                    \
    COUNT(DRIVE_RESTARTS, drive_restarts, "times a drive restarted and forgot its position")                \
    COUNT(EMERGENCY_STOPS, emergency_stops, "emergency stops heard on the bus")                             \
    COUNT(STOPS_SENT, stops_sent, "times the motor was stopped from here")                                  \
    COUNT(ARMINGS, armings, "times the drives were asked to get ready")

#define MCT_CAN_COUNT_ENUMERATOR(identifier, name, doc) MCT_CAN_COUNT_##identifier,
typedef enum { MCT_CAN_COUNT_LIST(MCT_CAN_COUNT_ENUMERATOR) MCT_CAN_COUNTS } mct_can_count;
#undef MCT_CAN_COUNT_ENUMERATOR

typedef struct {
    uint64_t values[MCT_CAN_COUNTS];
} mct_can_counts;

/** Names and meanings, in the order of the values. */
extern const mct_counter mct_can_counters[MCT_CAN_COUNTS];

/** Adds one. */
static inline void mct_can_counted(mct_can_counts *counts, mct_can_count count)
{
    mct_hal_count(&counts->values[count], 1);
}

#endif

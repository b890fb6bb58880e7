/**
 * @file candump.h
 * Replays a recorded bus, in the text format of `candump -l`: the log is the bus.
 *
 *     (1436509052.249713) can0 123#0011AABB        data, identifier of 11 bits
 *     (1436509052.249800) can0 18DAF110#R3 T       remote request, 29 bits, optional direction R or T
 *
 * The interface's name and the direction are ignored, frames of the controller's errors (identifiers from
 * 20000000) are passed over. CAN FD is refused. The whole log is checked at open.
 *
 * How it goes on, the same each time, whatever the clock of the machine says:
 *
 * - A logged frame is *one's own* if a frame of its identifier and kind has been sent before, or if its
 *   identifier is listed in `own`, or, when nothing is listed, if the filters do not want it. Record without
 *   foreign traffic, or list what is one's own.
 * - `receive` gives the wanted frames behind the position, one after another, up to the next one of one's
 *   own: own commands part the ticks. What is neither wanted nor one's own is passed over.
 * - `send` looks for the next logged frame of the same identifier and kind, among all that the log has within
 *   MCT_CAN_LOG_REACH_US of the first frame behind the position (silence on the bus is no obstacle). Found:
 *   the position moves behind it (what was wanted between is counted SKIPPED), and length and data are
 *   compared. Not found: the position stays and `unmatched` counts; the frame was not in the recorded run.
 * - The clock is the time stamp of the newest frame behind the position, less that of the first line. A wait
 *   in vain takes its timeout: all that follows in the log comes so much later. Else no time passes.
 * - The log has ended when nothing wanted is left, or when only own frames come next and what was sent last
 *   was not found. Then `tend` returns MCT_CAN_END_OF_LOG, and a send that finds nothing is refused.
 *
 * For one thread. Cost: linear in the text passed over, some 100 ns a line; of a send that finds nothing, all
 * that is in reach.
 */
#ifndef MCTAU_HAL_SOCKETCAN_CANDUMP_H
#define MCTAU_HAL_SOCKETCAN_CANDUMP_H

#include <stddef.h>

#include "hal/socketcan/transport.h"

#define MCT_CAN_LOG_REACH_US 1000000 /**< a command that comes later in the log is another one */
#define MCT_CAN_LOG_IDS      64      /**< identifiers that can be sent */

typedef struct {
    /* may be set between init and open */
    const mct_can_filter *own; /**< identifiers that the recorded host sent; must outlive the log */
    int own_count;             /**< 0: whatever the filters do not want */

    /* to be read */
    uint64_t lines;      /**< frames in the log, set by open */
    uint64_t compared;   /**< sent frames that were found in the log */
    uint64_t mismatches; /**< of these, with another length or other data than logged */
    uint64_t unmatched;  /**< sent frames that were not found */

    /* private */
    const char *text;
    size_t length;
    size_t position;    /**< next line, in bytes */
    size_t last_wanted; /**< line of the last frame that the filters want */
    int64_t first_us;   /**< time stamp of the first line */
    int64_t log_us;     /**< newest time stamp behind the position, relative to the first */
    int64_t waited_us;  /**< all waits in vain */
    bool open, stuck;   /**< stuck: the frame sent last was not found */
    mct_can_counts *counts;
    int filter_count;
    mct_can_filter filters[MCT_CAN_MAX_FILTERS];
    int sent_count;
    mct_can_frame sent[MCT_CAN_LOG_IDS]; /**< one of each identifier and kind */
} mct_can_candump;

/**
 * The transport of a log.
 * @param text  the log, `length` bytes that need not end in NUL; must outlive the log and stay as it is
 */
mct_can_transport mct_can_candump_transport(mct_can_candump *log, const char *text, size_t length);

#endif

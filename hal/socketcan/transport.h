/**
 * @file transport.h
 * What carries frames: a socket, a ring within the process, a recorded log. One const table of functions and a
 * caller-owned context; who sends and receives does not know which one it has.
 *
 * No function allocates. send and receive never wait.
 */
#ifndef MCTAU_HAL_SOCKETCAN_TRANSPORT_H
#define MCTAU_HAL_SOCKETCAN_TRANSPORT_H

#include "hal/socketcan/counts.h"
#include "hal/socketcan/frame.h"
#include "mctau/message.h"
#include "mctau/status.h"

#define MCT_CAN_MAX_FILTERS 32

/** An identifier that is wanted; both kinds of identifier and remote requests are told apart by the receiver. */
typedef struct {
    uint32_t id;
    bool extended;
} mct_can_filter;

/** Why nothing can be sent or received. */
typedef enum {
    MCT_CAN_UP,
    MCT_CAN_DOWN,       /**< the interface is down */
    MCT_CAN_GONE,       /**< the interface is not there any more (adapter unplugged) */
    MCT_CAN_BUS_OFF,    /**< the controller chip has left the bus */
    MCT_CAN_UNSENT,     /**< a command has waited too long to be sent: nobody acknowledges */
    MCT_CAN_END_OF_LOG, /**< a recorded log holds no more */
    MCT_CAN_LINK_STATES
} mct_can_link_state;

/** One sentence on a state: what it means and what to do. */
const char *mct_can_link_text(mct_can_link_state state);

typedef struct {
    const char *name;
    bool
        simulated; /**< its clock moves only while somebody waits, and a tick brings all that it will bring */
    /**
     * Gets ready to carry frames.
     * @param filters  what shall be received; nothing else is. count 0: everything
     * @param counts   where to count what happens; must outlive the transport
     * @param why      a sentence on failure: what is wrong and what to do
     * @return MCT_OK or MCT_ERROR_IO
     */
    mct_status (*open)(void *context, const mct_can_filter *filters, int count, mct_can_counts *counts,
                       mct_message *why);
    /**
     * Hands over a frame, or gives it up: a frame is never kept to be sent later, and while one of the same
     * identifier is still unsent the next one is given up. Counted as SENT, QUEUE_FULL or HELD_BACK.
     * @return true when it was handed over
     */
    bool (*send)(void *context, const mct_can_frame *frame);
    /** The next frame that has come, never one's own; false when there is none. */
    bool (*receive)(void *context, mct_can_frame *frame);
    /** Waits until there is a frame, at most `timeout_us`. @return whether there is one */
    bool (*wait)(void *context, int64_t timeout_us);
    /** The clock of mct_can_frame.time_us [us]; it only goes forward. */
    int64_t (*now_us)(void *context);
    /** Looks after the link: takes note of errors, tries to bring it back. Call once a tick. */
    mct_can_link_state (*tend)(void *context);
    void (*close)(void *context);
} mct_can_transport_ops;

/** A transport in use. */
typedef struct {
    const mct_can_transport_ops *ops;
    void *context;
} mct_can_transport;

#endif

/**
 * @file socket.h
 * A CAN bus through Linux: a CAN_RAW socket on an interface such as can0 or vcan0.
 *
 * - Of what is sent, the kernel gives each frame back when the controller chip has sent it (MSG_CONFIRM). Of
 *   each identifier at most one frame is under way: the next one is given up (HELD_BACK) until that has come
 *   back, so that a bus which comes to life again carries one old command of each kind and not a queue. A
 *   frame unsent for MCT_CAN_UNSENT_US makes the link MCT_CAN_UNSENT. Interfaces without an echo of their own
 *   (vcan, some serial adapters) confirm at once, whatever becomes of the frame.
 * - No time ends the wait for a confirmation: a queue that is stuck would get one more old command each time.
 *   It ends with the link (lost, or a chip that starts anew), and when the receive queue has overflowed, for
 *   that may have taken the confirmation with it.
 * - Frames of other programs on the same machine are received like those from the bus.
 * - mct_can_frame.time_us is the kernel's stamp of the arrival, on CLOCK_MONOTONIC.
 * - A link that was lost (down, gone, bus-off) is looked after by `tend`: a socket is opened anew on an
 *   interface that has come again under its name. What came before is thrown away (SKIPPED). While
 *   it is lost, sends are refused and not counted.
 * - The identifiers of sent frames are added to the kernel's filters at the first frame of each (one more
 *   system call); frames with them from elsewhere are counted FOREIGN. Of more than MCT_CAN_MAX_FLIGHTS
 *   identifiers the rest is sent without being confirmed.
 *
 * Per frame one or two system calls, some microseconds. For one thread. No heap.
 */
#ifndef MCTAU_HAL_SOCKETCAN_SOCKET_H
#define MCTAU_HAL_SOCKETCAN_SOCKET_H

#include "hal/socketcan/transport.h"

#define MCT_CAN_INTERFACE_SIZE 16     /**< of a name with its NUL, as the kernel has it (IFNAMSIZ) */
#define MCT_CAN_MAX_FLIGHTS    64     /**< identifiers that are confirmed */
#define MCT_CAN_UNSENT_US      20000  /**< a frame that waits longer makes the link MCT_CAN_UNSENT */
#define MCT_CAN_RETRY_US       100000 /**< between attempts to bring a lost link back */

/** An identifier that has been sent. */
typedef struct {
    uint32_t id;      /**< with the kernel's flags for 29 bits and remote requests */
    bool unsent;      /**< one is under way */
    int64_t since_us; /**< when that was handed over */
} mct_can_flight;

/** All members private. */
typedef struct {
    char interface[MCT_CAN_INTERFACE_SIZE];
    bool name_fits;
    uint32_t bitrate;
    int fd; /**< -1: none */
    mct_can_counts *counts;
    int filter_count;
    mct_can_filter filters[MCT_CAN_MAX_FILTERS];
    mct_can_link_state state; /**< UP, DOWN, GONE or BUS_OFF */
    int64_t tried_us;         /**< when a lost link was looked at last */
    int flight_count;
    mct_can_flight flights[MCT_CAN_MAX_FLIGHTS];
    bool passive;       /**< the chip is error-passive */
    uint32_t dropped;   /**< the kernel's count of frames lost to a full receive queue */
    int64_t emptied_us; /**< when the receive queue was seen empty last */
    bool has_pending;   /**< a frame was read ahead */
    mct_can_frame pending;
} mct_can_socket;

/**
 * The transport of an interface; opens nothing.
 * @param interface  name; copied. One that is too long makes open fail
 * @param bitrate    of the bus [bit/s], for the advice when the interface is down; 0: not known
 */
mct_can_transport mct_can_socket_transport(mct_can_socket *socket, const char *interface, uint32_t bitrate);

/** What the kernel knows of an interface. */
typedef struct {
    int index;
    bool is_can; /**< it carries CAN frames */
    bool is_up;
    char kind[16];       /**< "can", "vcan", ...; empty: not known */
    uint32_t bitrate;    /**< [bit/s]; 0: not known, or none (vcan) */
    uint32_t restart_ms; /**< after bus-off; 0: never by itself */
    uint32_t queue;      /**< length of the send queue [frames] */
    int state;           /**< of the chip, enum can_state of linux/can/netlink.h; -1: not known */
    bool listen_only;    /**< the chip never sends */
} mct_can_link;

/** Asks the kernel about an interface. Takes some 100 us. @return false when there is none of this name */
bool mct_can_link_details(const char *interface, mct_can_link *link);

/* --- the rules, free of system calls; for the tests --- */

struct can_frame;

/**
 * Takes in what the kernel has given: a confirmation, an error of the chip, or a frame from elsewhere.
 * @param flags    msg_flags of recvmsg (MSG_CONFIRM: one's own, MSG_DONTROUTE: of this machine)
 * @param time_us  when it came
 * @return whether there is a frame to receive, in `frame`
 */
bool mct_can_socket_take(mct_can_socket *socket, const struct can_frame *raw, int flags, int64_t time_us,
                         mct_can_frame *frame);

/** Takes note of how many frames the kernel has dropped since the socket is open (modulo 2^32). */
void mct_can_socket_dropped(mct_can_socket *socket, uint32_t total);

/**
 * The flight of an identifier with its flags, a new one if need be.
 * @return NULL when there is no more room
 */
mct_can_flight *mct_can_socket_flight(mct_can_socket *socket, uint32_t id, bool *is_new);

/** The state; `now_us` is when the receive queue was found empty. */
mct_can_link_state mct_can_socket_state(const mct_can_socket *socket, int64_t now_us);

/** Takes note that the link is lost; or that it is back. */
void mct_can_socket_lose(mct_can_socket *socket, mct_can_link_state state);
void mct_can_socket_regain(mct_can_socket *socket);

#endif

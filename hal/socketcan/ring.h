/**
 * @file ring.h
 * A bus within the process: two ends, whatever one sends the other one receives, in order, nothing lost.
 *
 * Who lives behind an end can work in the thread of the other: its service is called when the other end waits
 * and has nothing to receive. Time is simulated: the clock stands until mct_can_ring_advance moves it, so
 * that what happens depends on the frames alone and never on the machine.
 *
 * For one thread. Cost: of a send or receive some 10 ns, of a wait that of the service.
 */
#ifndef MCTAU_HAL_SOCKETCAN_RING_H
#define MCTAU_HAL_SOCKETCAN_RING_H

#include "hal/socketcan/transport.h"

#define MCT_CAN_RING_FRAMES 64 /**< that wait for an end */

/**
 * Lets who lives behind an end work: receive, send, and advance the ring's clock by the time that this took
 * in the simulation, at most `timeout_us`. May return as soon as it has sent something. A service that never
 * advances the clock lets those wait for ever who wait for a time.
 */
typedef void (*mct_can_ring_service)(void *context, int64_t timeout_us);

/** An end; all members private. */
typedef struct {
    struct mct_can_ring *ring;
    int other;
    bool open;
    mct_can_counts *counts;
    int filter_count;
    mct_can_filter filters[MCT_CAN_MAX_FILTERS];
    mct_can_link_state seen; /**< state of the link when it was looked at last */
    mct_can_ring_service service;
    void *service_context;
    uint32_t head, count; /**< of the frames that wait to be received */
    mct_can_frame frames[MCT_CAN_RING_FRAMES];
} mct_can_ring_port;

typedef struct mct_can_ring {
    /**
     * For tests: what `tend` returns. While it is not MCT_CAN_UP nothing is sent or received. DOWN, GONE and
     * BUS_OFF count as a lost link, by each end at the first look that finds it changed, and what waited then
     * is thrown away (SKIPPED).
     */
    mct_can_link_state state;
    int64_t now_us; /**< read it; moved by mct_can_ring_advance */
    bool serving;   /**< private: a service is at work; it is never called from within itself */
    mct_can_ring_port ports[2];
} mct_can_ring;

/** Both ends closed, the clock at 0, the link up. The ring must not be moved in memory from here on. */
void mct_can_ring_init(mct_can_ring *ring);

/**
 * The transport of an end, 0 or 1. send: the frame gets the ring's time and waits at the other end if its
 * filters want it; counted as SENT and CONFIRMED, or as QUEUE_FULL and given up where MCT_CAN_RING_FRAMES
 * wait already. To an end that is not open frames go unheard. wait: true if there is a frame; else the other
 * end's service is called once, with the timeout, and whether there is a frame then; without a service a wait
 * in vain takes its timeout on the clock.
 */
mct_can_transport mct_can_ring_end(mct_can_ring *ring, int end);

/** Sets the service of who lives behind `end`; called by the other end's wait. NULL: none. */
void mct_can_ring_serve(mct_can_ring *ring, int end, mct_can_ring_service service, void *context);

/** Moves the clock forward by `us` >= 0. */
void mct_can_ring_advance(mct_can_ring *ring, int64_t us);

#endif

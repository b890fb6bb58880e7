/**
 * @file record.h
 * What a tick leaves behind, and the ring that carries it to another thread.
 */
#ifndef MCTAU_RECORD_H
#define MCTAU_RECORD_H

#include "hal/hal.h"
#include "mctau/controller.h"

/**
 * Everything of one tick: all inputs, so that it can be replayed, and all results, so that a replay can be
 * checked. Its parts have the same sizes on every machine, so the bytes of one can be read by another
 * (hal/records.h).
 */
typedef struct {
    uint64_t tick;
    mct_state plant; /**< simulated state at the tick; zero on real hardware */
    mct_reading reading;
    mct_real estimate[2 * MCT_MAX_ENCODERS]; /**< zero in open loop */
    mct_real wanted;                         /**< input asked for [V] */
    mct_real applied;                        /**< input let through [V] */
    int32_t mode;                            /**< mct_mode */
    uint32_t faults;                         /**< latched, bit (1 << mct_fault) */
    bool rearmed;                            /**< faults were cleared before this tick */
    uint32_t late_us;                        /**< how late the tick began */
    uint64_t dropped;                        /**< records lost so far because the ring was full */
} mct_record;

#define MCT_RING_SIZE 4096 /**< records, a power of two: 4 s at 1 kHz */

/**
 * A queue from one producer (the loop) to one consumer (telemetry). Neither ever waits; a push to a full ring
 * is counted and lost. Zero-initialise before use. The counters are words that any processor reads and writes whole;
 * they may wrap, as the size is a power of two.
 */
typedef struct {
    size_t head;    /**< records pushed; written by the producer only */
    size_t dropped; /**< pushes refused; written by the producer only */
    size_t tail;    /**< records taken; written by the consumer only */
    mct_record records[MCT_RING_SIZE];
} mct_ring;

/** Producer: adds a record. Returns false, and counts, when the ring is full. */
bool mct_ring_push(mct_ring *ring, const mct_record *record);

/** Consumer: the oldest record, or NULL; it stays valid until mct_ring_pop. */
const mct_record *mct_ring_peek(const mct_ring *ring);

/** Consumer: frees the oldest record. Call only after mct_ring_peek gave one. */
void mct_ring_pop(mct_ring *ring);

/** Either side: whether a push would be refused. */
bool mct_ring_is_full(const mct_ring *ring);

#endif

/**
 * @file clock.h
 * A periodic clock with absolute deadlines, and how well they were met: by CLOCK_MONOTONIC (clock.c), or by SysTick
 * (cortex_m/systick.c), whose period is that of the ticks.
 */
#ifndef MCTAU_HAL_CLOCK_H
#define MCTAU_HAL_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/hal.h"

typedef struct {
    double period_ns;
    int64_t start_ns;
    uint64_t tick;     /**< of the next deadline, start_ns + tick * period_ns: no rounding adds up */
    int64_t woke;      /**< when the present tick began [ns; by SysTick: cycles] */
    bool has_priority; /**< SCHED_FIFO was granted */
    bool has_memory;   /**< mlockall was granted */
    mct_timing timing;
} mct_clock;

/**
 * Starts the clock at the present time. Asks for SCHED_FIFO and locked memory; goes on without where they are
 * not allowed (see has_priority, has_memory).
 */
void mct_clock_start(mct_clock *clock, double period);

/**
 * Sleeps until the next deadline. Deadlines that have passed already are skipped and counted, never caught
 * up.
 * @return MCT_OK; MCT_ERROR_IO when the system cannot sleep: the tick then begins too early
 */
mct_status mct_clock_wait(mct_clock *clock);

#endif

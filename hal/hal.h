/**
 * @file hal.h
 * What a loop needs of the world: a clock, encoders in counts, a motor in volts. One const table of functions
 * and a caller-owned context; the controller does not know which one it has.
 *
 * Contract of every HAL: after open, close, stop, a signal, a fault, stale feedback or a missed watchdog the
 * motor has zero volts. No function allocates; each does bounded work but for wait_tick, which may sleep.
 */
#ifndef MCTAU_HAL_H
#define MCTAU_HAL_H

#include "mctau/real.h"
#include "mctau/status.h"
#include "mctau/system.h"

/** What was wrong with a reading. */
enum {
    MCT_READING_INVALID =
        1 << 0, /**< a value that is not finite or cannot be: counts are the last valid ones */
    MCT_READING_MISSING = 1 << 1 /**< nothing new since the last tick: counts are the last valid ones */
};

/** What the sensors say at a tick. */
typedef struct {
    int32_t counts[MCT_MAX_COORDINATES]; /**< encoder counters as the hardware has them; they wrap */
    uint32_t age_us;                     /**< time since the newest counts were captured */
    uint32_t flags;                      /**< MCT_READING_... */
} mct_reading;

/** How well the clock was kept; all zero in lockstep. */
typedef struct {
    uint64_t missed_ticks;  /**< skipped because the loop came too late */
    uint32_t latest_us;     /**< lateness of the last wake-up */
    uint32_t worst_us;      /**< greatest lateness so far */
    uint32_t worst_work_us; /**< longest time from wake-up to wait_tick */
    uint64_t lateness[32];  /**< wake-ups by lateness: bin b holds [2^(b-1), 2^b) us, bin 0 below 1 us */
} mct_timing;

typedef struct {
    const char *name;
    /** Makes ready: sensors running, motor at zero volts. */
    mct_status (*open)(void *context);
    /** Reads the newest sensor values. Values that are not finite are rejected here and flagged. */
    mct_status (*read)(void *context, mct_reading *reading);
    /**
     * Sets the motor's voltage [V] (the force or torque of a plant without motor), held until the next write.
     */
    mct_status (*write)(void *context, mct_real input);
    /** Waits for the next tick. */
    mct_status (*wait_tick)(void *context);
    /** Zero volts at once; may be called at any time between open and close. */
    void (*stop)(void *context);
    /** Zero volts and release. */
    void (*close)(void *context);
    /** State of the simulated plant, or NULL where nobody knows it. */
    const mct_state *(*plant)(void *context);
    /** How the clock was kept. */
    const mct_timing *(*timing)(void *context);
} mct_hal_ops;

/** A HAL in use. */
typedef struct {
    const mct_hal_ops *ops;
    void *context;
} mct_hal;

#endif

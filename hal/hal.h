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

#include "mctau/message.h"
#include "mctau/real.h"
#include "mctau/status.h"
#include "mctau/system.h"

/** What was wrong with a reading. */
enum {
    MCT_READING_INVALID =
        1 << 0, /**< a value that is not finite or cannot be: counts are the last valid ones */
    MCT_READING_MISSING = 1 << 1,     /**< nothing new since the last tick: counts are the last valid ones */
    MCT_READING_LINK_DOWN = 1 << 2,   /**< nothing can be sent to the motor */
    MCT_READING_NOT_READY = 1 << 3,   /**< the motor's drive does not obey commands */
    MCT_READING_DRIVE_FAULT = 1 << 4, /**< a drive reports an error */
    MCT_READING_RESTARTED = 1 << 5,   /**< a drive has restarted: its counter begins anew */
    MCT_READING_ESTOP = 1 << 6        /**< an emergency stop was called on the bus */
};

/** Counts are not to be believed on these. */
#define MCT_READING_NO_COUNTS (MCT_READING_INVALID | MCT_READING_MISSING)

/** What the sensors say at a tick. */
typedef struct {
    int32_t counts[MCT_MAX_ENCODERS]; /**< encoder counters as the hardware has them; they wrap */
    uint32_t age_us;                  /**< time since the newest counts were captured */
    uint32_t flags;                   /**< MCT_READING_... */
} mct_reading;

/** A histogram of times: bin b holds [2^(b-1), 2^b) us, bin 0 below 1 us, the last one all beyond. */
#define MCT_HISTOGRAM_BINS 32
typedef struct {
    uint64_t bins[MCT_HISTOGRAM_BINS];
    uint32_t latest_us, worst_us;
} mct_histogram;

/** Adds a number to a counter that another thread may be reading. */
static inline void mct_hal_count(uint64_t *counter, uint64_t more)
{
    __atomic_store_n(counter, *counter + more, __ATOMIC_RELAXED);
}

static inline void mct_histogram_add(mct_histogram *histogram, uint32_t us)
{
    int bin = 0;
    for (uint32_t rest = us; rest > 0 && bin < MCT_HISTOGRAM_BINS - 1; rest >>= 1) {
        bin++;
    }
    mct_hal_count(&histogram->bins[bin], 1);
    __atomic_store_n(&histogram->latest_us, us, __ATOMIC_RELAXED);
    if (us > histogram->worst_us) {
        __atomic_store_n(&histogram->worst_us, us, __ATOMIC_RELAXED);
    }
}

/** How well the clock was kept; all zero in lockstep. Written by the loop's thread. */
typedef struct {
    uint64_t missed_ticks;    /**< skipped because the loop came too late */
    mct_histogram lateness;   /**< of wake-ups */
    mct_histogram work;       /**< from wake-up to wait_tick */
    mct_histogram round_trip; /**< from a command to the feedback that answers it, where a drive says so */
} mct_timing;

/** What a HAL counts: a name as in telemetry, and what it means. */
typedef struct {
    const char *name;
    const char *doc;
} mct_counter;

/** Counters of a HAL; values may change while they are read, each on its own. */
typedef struct {
    int count;
    const mct_counter *counters;
    const uint64_t *values;
} mct_counters;

#define MCT_MAX_COUNTERS 32

typedef struct {
    const char *name;
    /**
     * Makes ready: sensors running, motor at zero volts. May take seconds.
     * @param why  a sentence on failure: what is wrong and what to do
     */
    mct_status (*open)(void *context, mct_message *why);
    /** Reads the newest sensor values. Values that are not finite are rejected here and flagged. */
    mct_status (*read)(void *context, mct_reading *reading);
    /**
     * Sets the motor's voltage [V] (the force or torque of a plant without motor), held until the next write.
     */
    mct_status (*write)(void *context, mct_real input);
    /** Waits for the next tick. */
    mct_status (*wait_tick)(void *context);
    /** Zero volts at once and, whatever is written, until arm; at any time between open and close. */
    void (*stop)(void *context);
    /** Asks the drives to get ready again after a stop; the reading tells when they are. Does not wait. */
    void (*arm)(void *context);
    /** Zero volts and release. */
    void (*close)(void *context);
    /** State of the simulated plant, or NULL where nobody knows it. */
    const mct_state *(*plant)(void *context);
    /** How the clock was kept. */
    const mct_timing *(*timing)(void *context);
    /** What has happened; at most MCT_MAX_COUNTERS. */
    mct_counters (*counters)(void *context);
} mct_hal_ops;

/** A HAL in use. */
typedef struct {
    const mct_hal_ops *ops;
    void *context;
} mct_hal;

#endif

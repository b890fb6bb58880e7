/**
 * @file observer.h
 * Positions and rates from encoder counts.
 *
 * A tracking loop per encoder, fed forward with the model's acceleration: over a tick the rate is advanced by
 * h a, the deviation e between count and model by what the count moved and the model did not, and both are
 * corrected by the gains of a double pole at the bandwidth,
 *     e- = e + counts * unit - h rate - h^2/2 a,   e = p^2 e-,   rate += h a + (1 - p)^2 e- / h,
 *     p = exp(-bandwidth h).
 * Position is the count less e, so it never drifts from the encoder; the difference of counts is taken modulo
 * the counter, so it is exact across a wrap. With a right model there is no lag, and a count's step moves the
 * rate by (1 - p)^2 unit / h only (0.004 rad/s at 4096 counts a turn, 1 kHz and 50 rad/s).
 * Source: alpha-beta filter, critically damped (Benedict, Bordner 1962), with model feed-forward.
 */
#ifndef MCTAU_OBSERVER_H
#define MCTAU_OBSERVER_H

#include "hal/hal.h"
#include "mctau/constants.h"
#include "mctau/scene.h"

typedef struct {
    int32_t turn;       /**< counts per turn of an angle, 0 for a length */
    int32_t last;       /**< counter at the last tick */
    int32_t travelled;  /**< counts since the start, less whole turns or laps */
    int32_t laps;       /**< of 2^30 counts each, of a length */
    mct_real unit;      /**< coordinate per count */
    mct_real start;     /**< coordinate where the counter started */
    mct_real deviation; /**< e: measured less model, after correction */
} mct_encoder_track;

typedef struct {
    const mct_system *system;
    const mct_constants *constants; /**< of the model; caller-owned */
    uint32_t effects;
    uint32_t counter_shift; /**< 32 - bits of the counters */
    bool started;
    uint32_t blind_ticks; /**< without a valid reading so far */
    mct_real h;
    mct_real keep;      /**< p^2 */
    mct_real rate_gain; /**< (1 - p)^2 / h [1/s] */
    mct_encoder_track encoders[MCT_MAX_ENCODERS];
    /** Model's upright acceleration per sine of the angle; 0 when nothing is learned [rad/s^2]. */
    mct_real gravity_slope;
    mct_real gravity; /**< model's gravity at the last tick [rad/s^2] */
    mct_real excess;  /**< gravity acts (1 + excess) times as in the model; learned by the controller */
    mct_real correction[MCT_MAX_ENCODERS]; /**< what the last reading added to the model's acceleration */
    mct_real x[2 * MCT_MAX_ENCODERS];      /**< estimate: coordinates (angles within +-pi), rates */
    mct_real sine, cosine;                 /**< of the upright coordinate in x */
} mct_observer;

/**
 * @param constants  of the model, prepared for the scene; must outlive the observer
 * The first reading stands for the scene's initial position: encoders are incremental.
 */
void mct_observer_init(mct_observer *observer, const mct_scene *scene, const mct_constants *constants);

/** Begins anew: the next reading stands for the scene's initial position, at rest. What was learned is kept. */
void mct_observer_restart(mct_observer *observer);

/**
 * Takes in a tick's reading; one that is flagged leaves positions to the model for that tick.
 * @param input  voltage applied since the last tick
 * Cost: one model acceleration, some 40 ns. A value that is not finite never gets in.
 */
void mct_observer_update(mct_observer *observer, const mct_reading *reading, mct_real input);

#endif

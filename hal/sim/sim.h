/**
 * @file sim.h
 * The simulated HAL: a plant behind encoders and a motor driver, in lockstep with the loop or in real time.
 *
 * Sensors: incremental encoders that count from the plant's initial position, with noise, a limited counter,
 * latency and faults on request. The clock: in lockstep wait_tick advances the plant at once; in real time it
 * also sleeps until the tick.
 */
#ifndef MCTAU_HAL_SIM_H
#define MCTAU_HAL_SIM_H

#include "hal/clock.h"
#include "hal/hal.h"
#include "mctau/plant.h"

#define MCT_MAX_LATENCY 16 /**< ticks */

/** Numbers of counts are in two parts, so that float has them to twice its digits. */
typedef struct {
    int32_t turn_counts; /**< per turn of an angle, 0 for a length */
    mct_real unit_counts, unit_rest; /**< per radian or metre: rounded, and what that leaves out */
    uint32_t start_counts;           /**< at the initial position: whole ones, modulo 2^32, */
    mct_real start_rest;             /**< and the rest */
} mct_sim_encoder;

typedef struct {
    mct_plant plant;
    /* sensors */
    mct_sim_encoder encoders[MCT_MAX_ENCODERS];
    int32_t encoder_count;
    mct_real noise; /**< standard deviation [counts] */
    uint32_t seed;
    uint32_t counter_shift; /**< 32 - bits of the counters */
    uint32_t latency;       /**< [ticks] */
    uint32_t tick_us;
    int32_t fault;                          /**< MCT_SENSOR_FAULT_... */
    uint64_t fault_begin, fault_end;        /**< [ticks] */
    mct_reading queue[MCT_MAX_LATENCY + 1]; /**< readings of the last ticks, one after the other, round and round */
    int32_t newest;                         /**< place of the present tick's */
    mct_reading last;                       /**< last delivered */
    uint32_t silent_ticks;                  /**< since something was delivered */
    /* motor driver */
    mct_real input; /**< held until the next write */
    /* clock */
    bool realtime;
    double dt;
    mct_clock *clock; /**< of a scene in real time, set before open and caller-owned; not read in lockstep */
} mct_sim;

/**
 * Prepares the plant and its sensors. With [variation] the plant differs from the scene's model.
 * @return MCT_OK, or what mct_plant_init says, with a sentence in `why`
 */
mct_status mct_sim_init(mct_sim *sim, const mct_scene *scene, mct_message *why);

/** The HAL of a simulation; `sim` must outlive it. */
mct_hal mct_sim_hal(mct_sim *sim);

#endif

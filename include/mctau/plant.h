/**
 * @file plant.h
 * A simulated mechanism: one kernel, its constants and a state.
 */
#ifndef MCTAU_PLANT_H
#define MCTAU_PLANT_H

#include "mctau/constants.h"
#include "mctau/message.h"
#include "mctau/scene.h"
#include "mctau/stepper.h"
#include "mctau/system.h"

#define MCT_STATE_BOUND MCT_R(1e9) /**< a state beyond this, in SI units, has blown up */

/** A step that goes over several ticks: mct_scene.stride. */
typedef struct {
    int32_t ticks; /**< of one step; 1: each tick is stepped */
    int32_t gone;  /**< ticks of it that have gone by */
    mct_state start;
    mct_motion motion;
} mct_stride;

typedef struct mct_plant {
    const mct_system *system;
    mct_kernel kernel;
    /** What saturation leaves of an input, one of the functions below; NULL without saturation. */
    mct_real (*limit)(const struct mct_plant *plant, mct_real input);
    /** Advances by a tick where a step goes over several, mct_plant_stride(); NULL: the kernel does. */
    void (*advance)(struct mct_plant *plant, bool is_new);
    uint32_t effects; /**< as simulated, see mct_scene_effects */
    int32_t states;
    int32_t entries;  /**< of the state that the kernel uses: the states, and perhaps the time behind them */
    int32_t substeps; /**< steps per tick */
    mct_real bound;   /**< largest input [V]; without saturation the largest finite number */
    mct_real drop;    /**< of the current's bound through the armature [V]; read by MCT_SATURATION_CURRENT */
    mct_real input;   /**< as applied over the last tick */
    mct_state state;
    uint64_t tick;
    uint64_t rejected_inputs; /**< inputs that were not finite: the last valid one was held */
    /** Ticks whose result was not finite or beyond MCT_STATE_BOUND: the state before was kept. */
    uint64_t diverged_ticks;
    mct_stride stride;
    mct_constants constants;
} mct_plant;

/**
 * Prepares a plant at the scene's initial state: constants in double, kernel chosen.
 * @param why  a sentence on failure
 * @return MCT_OK; MCT_ERROR_UNSUITED when the stepper does not suit system and effects; else what prepare
 * says
 */
mct_status mct_plant_init(mct_plant *plant, const mct_scene *scene, mct_message *why);

/**
 * Advances by one tick under a held input. An input that is not finite is refused and the last one held; a
 * result that is not finite or has blown up is refused and the state kept. Both are counted. With a stride, a step
 * is made where one has gone by or the input has changed, and the ticks between are read off its series. Whoever
 * writes the state himself then sets stride.gone to 0. Cost: the kernel, and some 5 to 15 ns; a tick that is read
 * off, two thirds of one by `rk4`. Not thread-safe per plant.
 */
void mct_plant_step(mct_plant *plant, mct_real input);

/**
 * What a plant may hold as `limit` and `advance`, by name for a program that was compiled: one whose scene has no
 * saturation, or no stride, holds none of it.
 */
mct_real mct_plant_within_voltage(const mct_plant *plant, mct_real input);
mct_real mct_plant_within_current(const mct_plant *plant, mct_real input);
void mct_plant_stride(mct_plant *plant, bool is_new);

/** Value of state `index` in double, whole turns included. */
double mct_plant_value(const mct_plant *plant, int index);

/** M, C, tau and all that follows, at the present state under the present input. */
void mct_plant_evaluate(const mct_plant *plant, mct_evaluation *out);

/** Sets a state from values in double: whole turns are taken out of angles, a quaternion gets the length 1. */
void mct_state_set(const mct_system *system, int states, const double *values, mct_state *state);

#endif

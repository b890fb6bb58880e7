/**
 * @file loop.h
 * The tick: read -> estimate -> control -> supervise -> write -> record -> wait.
 */
#ifndef MCTAU_LOOP_H
#define MCTAU_LOOP_H

#include "hal/hal.h"
#include "mctau/controller.h"
#include "mctau/input.h"
#include "mctau/record.h"
#include "mctau/scene.h"
#include "mctau/supervisor.h"

/** What a loop goes by: computed once, never changed, so that it may lie in a microcontroller's flash. */
typedef struct {
    mct_constants model; /**< of the controller */
    mct_input input;     /**< of an open loop */
} mct_plan;

typedef struct {
    mct_hal hal;
    mct_ring *ring; /**< NULL: records go nowhere */
    bool controlled;
    uint64_t tick;
    mct_real applied;     /**< input since the last tick [V] */
    const mct_plan *plan; /**< caller-owned */
    mct_controller controller;
    mct_supervisor supervisor;
    bool rearm;        /**< asked for by mct_loop_rearm */
    mct_record record; /**< of the last tick */
} mct_loop;

/**
 * Prepares a loop; opens nothing.
 * @param plan     written; must outlive the loop
 * @param scene    read during the call only
 * @param hal      open before the first tick, close after the last
 * @param ring     where records go, or NULL
 * @param samples  of a csv input, else {NULL, 0}
 * @param why      a sentence on failure
 * @return MCT_OK, or what mct_controller_init says
 */
mct_status mct_loop_init(mct_loop *loop, mct_plan *plan, const mct_scene *scene, mct_hal hal, mct_ring *ring,
                         mct_samples samples, mct_message *why);

/**
 * Asks for faults to be cleared and the drives to be armed again, at the next tick; a cause that persists latches
 * again. After a drive's restart the mechanism must be at its initial position, at rest. May be called by another
 * thread.
 */
void mct_loop_rearm(mct_loop *loop);

/**
 * One tick, ending where the next begins. When a fault is latched the HAL is stopped, once; it stays at zero volts
 * until it is armed again. A HAL that cannot read or write latches MCT_FAULT_HAL; the loop
 * goes on at zero volts. Bounded work but for the HAL's wait_tick. Cost on a laptop, plant included: below
 * 400 ns.
 */
void mct_loop_tick(mct_loop *loop);

#endif

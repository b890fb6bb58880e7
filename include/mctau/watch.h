/**
 * @file watch.h
 * Energy that cannot be: a plant's energy against what it had and what its input has brought in since.
 *
 * A simulation that gains energy from nowhere is wrong long before its state leaves all bounds (MCT_STATE_BOUND). The work
 * of an input that is held over a tick is u times the way, exactly, whatever the mechanism; losses only lower the bound.
 *
 * What it cannot see: a scene where something else does work (a moving base, a rotating frame, constant or prescribed
 * forces, a belt, motor constants that disagree) is not watched; nor is energy that is lost, nor a gain below half of what
 * is in motion.
 */
#ifndef MCTAU_WATCH_H
#define MCTAU_WATCH_H

#include "mctau/plant.h"

#define MCT_WATCH_TICKS 1024 /**< between two looks at the energy */

typedef struct {
    bool is_watched;
    double dt;       /**< the tick [s] */
    double energy;   /**< at the start [J] */
    double work;     /**< of the input since then; losses in the motor's resistance are not taken off [J] */
    double rounding; /**< of the work, at most [J] */
    double force[MCT_MAX_COORDINATES]; /**< of a force, torque or quasi-static motor, per unit of the input */
    double before[MCT_MAX_STATES];     /**< at the last tick */
    mct_real fastest[MCT_MAX_COORDINATES]; /**< largest size of each rate since the last look */
    uint64_t impossible;                   /**< looks that found energy from nowhere */
} mct_watch;

/** Starts at the present state of a plant of this scene. Costs three evaluations. */
void mct_watch_start(mct_watch *watch, const mct_plant *plant, const mct_scene *scene);

/**
 * To be called after every mct_plant_step(). Costs some 15 ns, and two evaluations (8 kB of stack in double, half of it in
 * float) every MCT_WATCH_TICKS ticks. Not thread-safe per watch.
 * @return false at a look that found energy from nowhere; also counted
 */
bool mct_watch_tick(mct_watch *watch, const mct_plant *plant);

#endif

/**
 * @file moving_base.h
 * Constants of the pendulum with a moving base, precomputed by mct_moving_base.prepare. Equations in
 * src/systems/moving_base.c.
 */
#ifndef MCTAU_MOVING_BASE_H
#define MCTAU_MOVING_BASE_H

#include "mctau/real.h"
#include "mctau/step.h"

/** Motion of the base along one axis, amplitude cos(angle + phase); all 0 when off. */
typedef struct {
    mct_real frequency; /**< rate of the angle [rad/s] */
    mct_real phase;     /**< within a turn [rad] */
    mct_real middle;    /**< phase in the middle of a step that starts at angle 0 [rad] */
    mct_real turn;      /**< of the angle in a step [rad] */
    mct_real turn_rest; /**< what rounding has kept back of it [rad] */
    mct_real amplitude; /**< [m] */
    mct_real velocity;  /**< amplitude frequency [m/s] */
    mct_real peak;      /**< amplitude frequency^2 [m/s^2] */
    mct_real kick;      /**< change of velocity in a step is -kick cos(angle + middle) [m/s] */
} mct_base_axis;

typedef struct {
    mct_step step;
    mct_real mass;            /**< m [kg] */
    mct_real length;          /**< l [m] */
    mct_real moment;          /**< m l [kg m] */
    mct_real inertia;         /**< m l^2 [kg m^2] */
    mct_real inverse_inertia; /**< [1/(kg m^2)] */
    mct_real gravity;         /**< g [m/s^2], 0 when off */
    mct_real weight_moment;   /**< m g l [N m], 0 when off */
    mct_real viscous;         /**< [N m s], 0 when off */
    mct_base_axis base[2];    /**< right, up */
} mct_moving_base_constants;

#endif

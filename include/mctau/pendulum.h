/**
 * @file pendulum.h
 * Constants of the pendulum, precomputed by mct_pendulum.prepare. Equations in src/systems/pendulum.c.
 */
#ifndef MCTAU_PENDULUM_H
#define MCTAU_PENDULUM_H

#include "mctau/real.h"
#include "mctau/step.h"

typedef struct {
    mct_step step;
    mct_real mass;            /**< m [kg] */
    mct_real length;          /**< l [m] */
    mct_real inertia;         /**< m l^2 [kg m^2] */
    mct_real inverse_inertia; /**< [1/(kg m^2)] */
    mct_real gravity;         /**< g [m/s^2], 0 when off */
    mct_real weight_moment;   /**< m g l [N m], 0 when off */
    mct_real viscous;         /**< [N m s], 0 when off */
    mct_real drag;            /**< [N m s^2], 0 when off */
    mct_real coulomb;         /**< dry friction [N m], 0 when off */
} mct_pendulum_constants;

#endif

/**
 * @file solid_pendulum.h
 * Constants of the solid pendulum, precomputed by mct_solid_pendulum.prepare. Equations in
 * src/systems/solid_pendulum.c.
 */
#ifndef MCTAU_SOLID_PENDULUM_H
#define MCTAU_SOLID_PENDULUM_H

#include "mctau/real.h"
#include "mctau/step.h"

typedef struct {
    mct_step step;
    mct_real mass;            /**< m, of the whole box [kg] */
    mct_real inertia;         /**< about the pivot [kg m^2] */
    mct_real inverse_inertia; /**< [1/(kg m^2)] */
    mct_real gravity;         /**< g [m/s^2], 0 when off */
    mct_real weight_moment;   /**< m g d [N m], 0 when off */
    mct_real viscous;         /**< [N m s], 0 when off */
    mct_real coulomb;         /**< dry friction [N m], 0 when off */
    mct_real along[4];        /**< of the particles from the pivot, along the box [m] */
    mct_real across[4];       /**< and across it [m] */
} mct_solid_pendulum_constants;

#endif

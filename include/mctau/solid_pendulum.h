/**
 * @file solid_pendulum.h
 * Constants of the solid pendulum, precomputed by mct_solid_pendulum.prepare. Equations in
 * src/systems/solid_pendulum.c.
 */
#ifndef MCTAU_SOLID_PENDULUM_H
#define MCTAU_SOLID_PENDULUM_H

#include "mctau/hinge.h"

typedef struct {
    mct_hinge hinge;
    mct_real mass;      /**< m, of the whole box [kg] */
    mct_real gravity;   /**< g [m/s^2], 0 when off */
    mct_real along[4];  /**< of the particles from the pivot, along the box [m] */
    mct_real across[4]; /**< and across it [m] */
} mct_solid_pendulum_constants;

#endif

/**
 * @file pendulum.h
 * Constants of the pendulum, precomputed by mct_pendulum.prepare. Equations in src/systems/pendulum.c.
 */
#ifndef MCTAU_PENDULUM_H
#define MCTAU_PENDULUM_H

#include "mctau/hinge.h"

typedef struct {
    mct_hinge hinge;
    mct_real mass;    /**< m [kg] */
    mct_real length;  /**< l [m] */
    mct_real gravity; /**< g [m/s^2], 0 when off */
} mct_pendulum_constants;

#endif

/**
 * @file falling_sphere.h
 * Constants of the falling sphere, precomputed by mct_falling_sphere.prepare. Equations in
 * src/systems/falling_sphere.c.
 */
#ifndef MCTAU_FALLING_SPHERE_H
#define MCTAU_FALLING_SPHERE_H

#include "mctau/real.h"
#include "mctau/step.h"

typedef struct {
    mct_step step;
    mct_real mass;         /**< m [kg] */
    mct_real inverse_mass; /**< [1/kg] */
    mct_real weight;       /**< m g [N], 0 when off */
    mct_real lift;         /**< weight of the displaced fluid [N], 0 when off */
    mct_real stokes;       /**< 6 pi mu r / m [1/s], 0 when off */
    mct_real drag;         /**< c rho pi r^2 / (2 m) [1/m], 0 when off */
    mct_real flow[2][2];   /**< of a step without drag: increments of h and v by v and by acceleration */
    mct_real remainder;    /**< of expo: that of the step with drag; 0 without, where the flow is exact */
} mct_falling_sphere_constants;

#endif

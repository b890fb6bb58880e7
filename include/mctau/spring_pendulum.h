/**
 * @file spring_pendulum.h
 * Constants of the spring pendulum, precomputed by mct_spring_pendulum.prepare. Equations in
 * src/systems/spring_pendulum.c.
 */
#ifndef MCTAU_SPRING_PENDULUM_H
#define MCTAU_SPRING_PENDULUM_H

#include "mctau/real.h"
#include "mctau/step.h"

typedef struct {
    mct_step step;
    mct_real mass;           /**< m [kg] */
    mct_real inverse_mass;   /**< [1/kg] */
    mct_real stiffness;      /**< k [N/m], 0 when off */
    mct_real rest_length;    /**< l0 [m] */
    mct_real length_viscous; /**< k1 [N s/m], 0 when off */
    mct_real angle_viscous;  /**< k2 [N m s], 0 when off */
    mct_real gravity;        /**< g [m/s^2], 0 when off */
    mct_real stiffness_rate; /**< k / m [1/s^2] */
    mct_real rest_rate;      /**< k l0 / m [m/s^2] */
    mct_real length_damping; /**< k1 / m [1/s] */
    mct_real angle_damping;  /**< k2 / m [m^2/s] */
    mct_real near_friction;  /**< (nearest length that a step resolves)^2: the part of k2 [m^2] */
    mct_real near_torque;    /**< and that of a torque [m^2/(N m)] */
    /** What a step of spring and friction along the rod alone adds to (r - l0, rd), from these and a constant pull. */
    mct_real along[2][3];
    mct_real resting_inverse_cube; /**< 1 / l0^3 [1/m^3]; 0 without a rest length */
} mct_spring_pendulum_constants;

#endif

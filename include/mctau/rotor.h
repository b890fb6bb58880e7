/**
 * @file rotor.h
 * Constants of a body that turns about a point of it, a pivot or its centre: what ball_joint and rigid_body
 * share. Equations in src/systems/rotor.h.
 */
#ifndef MCTAU_ROTOR_H
#define MCTAU_ROTOR_H

#include "mctau/real.h"
#include "mctau/step.h"
#include "mctau/system.h"

typedef struct {
    mct_step step;
    int32_t count;                      /**< of its particles */
    mct_real mass[MCT_MAX_PARTICLES];   /**< of each [kg] */
    mct_real arm[MCT_MAX_PARTICLES][3]; /**< to each from the point, in body axes [m] */
    mct_real total_mass;                /**< [kg] */
    mct_real inertia[3][3];             /**< I about the point, in body axes [kg m^2] */
    mct_real inverse[3][3];             /**< its pseudo-inverse [1/(kg m^2)] */
    mct_real idle_axis[3]; /**< unit vector n without inertia, in body axes; 0 when there is none */
    mct_real inverse_size; /**< 1 / largest principal moment [1/(kg m^2)] */
    mct_real shape[3][3];  /**< I / largest + n n', which has an inverse */
    mct_real viscous;      /**< friction [N m s] */
    mct_real drag;         /**< couple of the air by the square of the angular velocity [N m s^2] */
} mct_rotor;

#endif

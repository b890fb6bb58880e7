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
    mct_real idle_axis[3]; /**< unit vector without inertia, in body axes; 0 when there is none */

    /* Steps are taken in principal axes. What belongs to an axis without inertia is 0. */
    bool is_turned;       /**< they are others than the body's */
    mct_real axes[3][3];  /**< rows: they, in body axes */
    mct_real turn[4];     /**< quaternion from them to body axes */
    mct_real moment[3];   /**< principal moments by the largest */
    mct_real inverse[3];  /**< 1 / principal moment [1/(kg m^2)] */
    mct_real coupling[3]; /**< (I_2 - I_3) / I_1, and so on: Euler's equation without a couple */

    /* Of `split3`, by the moments above. */
    mct_real round;     /**< 1 / moment of one axis, */
    mct_real excess[3]; /**< and what the others have beyond */

    mct_real viscous; /**< friction [N m s] */
    mct_real drag;    /**< couple of the air by the square of the angular velocity [N m s^2] */
} mct_rotor;

#endif

/**
 * @file reaction_wheel.h
 * Constants of the reaction wheel pendulum, precomputed by mct_reaction_wheel.prepare. Equations in
 * src/systems/reaction_wheel.c.
 */
#ifndef MCTAU_REACTION_WHEEL_H
#define MCTAU_REACTION_WHEEL_H

#include "mctau/expo.h"
#include "mctau/motor.h"
#include "mctau/real.h"
#include "mctau/step.h"
#include "mctau/symmetric2.h"

typedef struct {
    mct_step step;
    mct_real arm_inertia;     /**< m_w l^2 + I_a: about the pivot, the wheel as a point [kg m^2] */
    mct_real wheel_inertia;   /**< I_w [kg m^2] */
    mct_real weight_moment;   /**< (S_a + m_w l) g [N m], 0 with gravity off */
    mct_real gravity;         /**< [m/s^2], 0 when off */
    mct_real arm_viscous;     /**< nu_1 [N m s], 0 when off */
    mct_real wheel_viscous;   /**< nu_2 [N m s], 0 when off */
    mct_real wheel_damping;   /**< nu_2 and the back-emf of a quasi-static motor [N m s] */
    mct_real coulomb[2];      /**< dry friction in motion [N m], 0 when off */
    mct_real hold[2];         /**< and the most that it bears at rest */
    mct_real drag[2];         /**< by the square of a rate [N m s^2], 0 when off */
    mct_real inverse_arm;     /**< 1 / arm_inertia */
    mct_real inverse_wheel;   /**< 1 / wheel_inertia */
    mct_inertia2 inertia;     /**< M and M^-1 */
    mct_symmetric2 implicit;  /**< (M + h D)^-1, for euler */
    mct_symmetric2 symmetric; /**< (M + h D / 2)^-1, the averaged motor included, for leap */
    mct_motor motor;
    mct_expo expo;
    /* geometry of the equivalent particles */
    mct_real arm_length;          /**< l [m] */
    mct_real wheel_radius;        /**< of the hoop, sqrt(I_w / m_w) [m] */
    mct_real arm_radius;          /**< of the arm's two particles, at +-arm_radius [m] */
    mct_real wheel_particle_mass; /**< each of two [kg] */
    mct_real outer_arm_mass;      /**< at +arm_radius [kg] */
    mct_real inner_arm_mass;      /**< at -arm_radius [kg] */
} mct_reaction_wheel_constants;

#endif

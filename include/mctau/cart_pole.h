/**
 * @file cart_pole.h
 * Constants of the cart-pole, precomputed by mct_cart_pole.prepare. Equations in src/systems/cart_pole.c.
 */
#ifndef MCTAU_CART_POLE_H
#define MCTAU_CART_POLE_H

#include "mctau/motor.h"
#include "mctau/real.h"
#include "mctau/step.h"

typedef struct {
    mct_step step;
    mct_real cart_mass;        /**< m1 [kg] */
    mct_real pole_mass;        /**< m2 [kg] */
    mct_real total_mass;       /**< m1 + m2 [kg] */
    mct_real length;           /**< l [m] */
    mct_real moment;           /**< m2 l [kg m] */
    mct_real inertia;          /**< m2 l^2 [kg m^2] */
    mct_real weight_moment;    /**< m2 g l [N m], 0 with gravity off */
    mct_real inverse_length;   /**< 1 / l [1/m] */
    mct_real mass_per_inertia; /**< (m1 + m2) / (m2 l^2) [1/m^2] */
    mct_real gravity;          /**< [m/s^2], 0 when off */
    mct_real cart_viscous;     /**< kappa_1 [N s/m], 0 when off */
    mct_real pole_viscous;     /**< kappa_2 [N m s], 0 when off */
    mct_real cart_damping;     /**< kappa_1 and the back-emf of a quasi-static motor [N s/m] */
    mct_real coulomb[2];       /**< dry friction in motion [N], [N m], 0 when off */
    mct_real hold[2];          /**< and the most that it bears at rest */
    mct_real drag[2];          /**< by the square of a rate [N s^2/m^2], [N m s^2], 0 when off */
    mct_motor motor;
} mct_cart_pole_constants;

#endif

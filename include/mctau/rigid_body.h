/**
 * @file rigid_body.h
 * Constants of the free rigid body, precomputed by mct_rigid_body.prepare. Equations in
 * src/systems/rigid_body.c.
 */
#ifndef MCTAU_RIGID_BODY_H
#define MCTAU_RIGID_BODY_H

#include "mctau/rotor.h"

/** Any number of constant forces F on points p of the body, p from its centre, do what these four do. */
typedef struct {
    mct_rotor rotor;
    mct_real inverse_mass;      /**< [1/kg] */
    mct_real gravity[3];        /**< in space axes [m/s^2] */
    mct_real drag;              /**< force of the air by the square of the centre's velocity [N s^2/m^2] */
    mct_real space_force[3];    /**< sum of those in space axes [N] */
    mct_real space_lever[3][3]; /**< sum p F' of those: row in principal axes, column in space axes [N m] */
    mct_real body_force[3];     /**< sum of those in body axes, in principal axes [N] */
    mct_real body_couple[3];    /**< sum p x F of those, in principal axes [N m] */
} mct_rigid_body_constants;

#endif

/**
 * @file hinge.h
 * Constants of rigid bodies that turn about one fixed axis, precomputed by prepare. Equations in src/systems/hinge.h
 * and src/systems/hinged_particles.c.
 */
#ifndef MCTAU_HINGE_H
#define MCTAU_HINGE_H

#include "mctau/real.h"
#include "mctau/step.h"
#include "mctau/system.h"

/** What a step needs, whatever the body is; the first member of the constants of each such system. */
typedef struct {
    mct_step step;
    mct_real inertia;         /**< I about the axis [kg m^2] */
    mct_real inverse_inertia; /**< [1/(kg m^2)] */
    mct_real sine_moment;     /**< P of the weight's moment P sin th + Q cos th [N m], 0 when off */
    mct_real cosine_moment;   /**< Q [N m], 0 when off */
    mct_real viscous;         /**< [N m s], 0 when off */
    mct_real drag;            /**< [N m s^2], 0 when off */
    mct_real coulomb;         /**< dry friction in motion [N m], 0 when off */
    mct_real hold;            /**< and the most that it bears at rest [N m] */
} mct_hinge;

/** A body that is a list of particles, about any axis through the origin: of particle_pendulum and fixed_axis. */
typedef struct {
    mct_hinge hinge;
    mct_real axis[3];         /**< of length 1 */
    mct_real gravity[3];      /**< [m/s^2], 0 when off */
    mct_real level_potential; /**< energy of the weight that does not depend on the angle [J] */
    int32_t count;
    struct {
        mct_real mass;      /**< [kg] */
        mct_real along;     /**< where it is along the axis [m] */
        mct_real radius[3]; /**< from the axis to it at angle 0 [m] */
    } particle[MCT_MAX_PARTICLES];
} mct_hinged_particles;

#endif

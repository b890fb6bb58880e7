/**
 * @file linked_particles.h
 * Constants of the linked particles, precomputed by mct_linked_particles.prepare. Equations in
 * src/systems/linked_particles.c.
 */
#ifndef MCTAU_LINKED_PARTICLES_H
#define MCTAU_LINKED_PARTICLES_H

#include "mctau/real.h"
#include "mctau/step.h"

typedef struct {
    mct_step step;
    mct_real mass[2];      /**< m1, m2 [kg] */
    mct_real total_mass;   /**< m1 + m2 [kg] */
    mct_real inverse_mass; /**< 1 / (m1 + m2) [1/kg] */
    mct_real separation;   /**< c [m] */
    mct_real force[2][3];  /**< on each particle [N] */
    mct_real acceleration; /**< by these forces [m/s^2] */
} mct_linked_particles_constants;

#endif

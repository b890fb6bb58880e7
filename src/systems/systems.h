/* The systems that mct_systems lists. */
#ifndef MCT_SYSTEMS_SYSTEMS_H
#define MCT_SYSTEMS_SYSTEMS_H

#include "mctau/system.h"

/* "particle_1" and on, MCT_MAX_PARTICLES of them: of a system that lists its particles. */
extern const char *const mct_particle_numbers[MCT_MAX_PARTICLES];

/* A parameter of those that give dry friction as forces. */
#define MCT_STATIC_RATIO                                       \
    MCT_COEFFICIENT(MCT_COULOMB, "static_ratio", "", 1, 10, 1, \
                    "static over dynamic friction, of what is at rest")

extern const mct_system mct_cart_pole;
extern const mct_system mct_reaction_wheel;
extern const mct_system mct_pendulum;
extern const mct_system mct_spring_pendulum;
extern const mct_system mct_linked_particles;
extern const mct_system mct_particle_pendulum;
extern const mct_system mct_moving_base;
extern const mct_system mct_rotating_frame;
extern const mct_system mct_ball_joint;
extern const mct_system mct_fixed_axis;
extern const mct_system mct_solid_pendulum;
extern const mct_system mct_rigid_body;
extern const mct_system mct_chain;
extern const mct_system mct_block;
extern const mct_system mct_falling_sphere;

#endif

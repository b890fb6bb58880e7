/* The systems that mct_systems lists. */
#ifndef MCT_SYSTEMS_SYSTEMS_H
#define MCT_SYSTEMS_SYSTEMS_H

#include "mctau/cart_pole.h"
#include "mctau/system.h"

/* "particle_1" and on, MCT_MAX_PARTICLES of them: of a system that lists its particles. */
extern const char *const mct_particle_numbers[MCT_MAX_PARTICLES];

/* A parameter of those that give dry friction as forces. */
#define MCT_STATIC_RATIO                                       \
    MCT_COEFFICIENT(MCT_COULOMB, "static_ratio", "", 1, 10, 1, \
                    "static over dynamic friction, of what is at rest")

/* An entry of a table of kernels. */
#define MCT_NAMED_KERNEL(function) MCT_NAMED_KERNEL_AS(function)
#define MCT_NAMED_KERNEL_AS(function) \
    {                                 \
        function, #function           \
    }

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

/* What a tick reaches through these descriptors: found from outside by its name, mct_SYSTEM_MEMBER, as kernels are. */
void mct_cart_pole_accelerate(const void *constants, uint32_t effects, const mct_real *x, mct_real s, mct_real c,
                              mct_real u, mct_real *a);
void mct_reaction_wheel_accelerate(const void *constants, uint32_t effects, const mct_real *x, mct_real s,
                                   mct_real c, mct_real u, mct_real *a);
const mct_motor *mct_cart_pole_motor(const void *constants);
const mct_motor *mct_reaction_wheel_motor(const void *constants);
void mct_cart_pole_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real u,
                          mct_motion *motion);
void mct_reaction_wheel_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real u,
                               mct_motion *motion);
void mct_pendulum_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real u,
                         mct_motion *motion);
void mct_particle_pendulum_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real u,
                                  mct_motion *motion);
void mct_fixed_axis_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real u,
                           mct_motion *motion);
void mct_solid_pendulum_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real u,
                               mct_motion *motion);

/* The input under which, by mct_cart_pole_accelerate, the cart has an acceleration. */
mct_real mct_cart_pole_input_for(const mct_cart_pole_constants *constants, uint32_t effects, const mct_real *x,
                                 mct_real s, mct_real c, mct_real acceleration);

#endif

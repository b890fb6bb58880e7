/*
 * A body of particles that turns about an axis through the origin: all of particle_pendulum and fixed_axis but their
 * descriptors.
 */
#ifndef MCT_SYSTEMS_HINGED_PARTICLES_H
#define MCT_SYSTEMS_HINGED_PARTICLES_H

#include "mctau/hinge.h"
#include "mctau/message.h"
#include "mctau/scene.h"

#define MCT_HINGED_EFFECTS (MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB)

/* Bodies with less inertia are refused: the lightest pendulum's [kg m^2], and a part of that about the origin. */
#define MCT_LEAST_INERTIA       1e-14
#define MCT_LEAST_INERTIA_SHARE 1e-18

/* How the body hangs. */
typedef struct {
    double axis[3];    /* of length 1 */
    double gravity[3]; /* [m/s^2] */
    double friction;   /* [N m s] */
    double coulomb;    /* [N m] */
    double static_ratio;
} mct_hinging;

/* Constants of the scene's first list, rows of a mass and two or three coordinates at angle 0; the effects decide. */
mct_status mct_hinged_particles_prepare(const mct_scene *scene, double h, const mct_hinging *hinging,
                                        mct_hinged_particles *constants, mct_message *why);

/* Of the descriptor; O(particles). */
void mct_hinged_particles_evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                                   mct_evaluation *out);
void mct_hinged_particles_place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                                mct_hyperdual (*position)[3]);
const mct_named_kernel *mct_hinged_particles_kernel(int stepper, uint32_t effects);
void mct_hinged_particles_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real u,
                                 mct_motion *motion);

#endif

/**
 * @file judge.h
 * A system before the generic Gauss engine: what it knows is the geometry x = h(t, q), the masses and what acts from
 * outside, and nothing of the closed form.
 */
#ifndef MCTAU_JUDGE_H
#define MCTAU_JUDGE_H

#include "mctau/gauss.h"
#include "mctau/system.h"

/** What the engine finds, and room for it: some 40 KiB in double. */
typedef struct {
    mct_gauss_motion motion; /**< as the engine numbers particles: those with mass */
    int32_t particle_count;
    int32_t particle[MCT_MAX_PARTICLES]; /**< number in the system of each that the engine has */
    mct_real mass[MCT_MAX_PARTICLES];
    mct_gauss_lagrange
        lagrange; /**< C from the derivatives of M; 0 of a system with a rotation, whose M has none */
    mct_real
        couple[MCT_GAUSS_MAX_COORDINATES]; /**< tau - J'f: friction of joints, torques between bodies [N m] */
    mct_gauss_workspace workspace;         /**< private */
} mct_judgement;

/**
 * Solves Gauss's least-squares problem for a system at one state, with the forces f that the closed form names.
 *
 * A rotation turns by three coordinates u about its present attitude, where du/dt is the angular velocity and its
 * rate the angular acceleration: body and space axes differ by the side on which e^u stands.
 *
 * @param constants  of the system, prepared
 * @param particles  how many it has: mct_particle_count()
 * @param x          the state as for mct_system.evaluate, phases and time included
 * @param closed     what evaluate() says there; its masses, forces and tau are used
 * @param out        written; on MCT_ERROR_SINGULAR without accelerations and constraint forces
 * @return MCT_OK; MCT_ERROR_UNSUITED for a process, which has no motion; what the engine returns, of which
 *         MCT_ERROR_SINGULAR is a position where the coordinates do not move the particles independently.
 *         Thread-safe for distinct outputs.
 */
mct_status mct_judge(const mct_system *system, const void *constants, int particles, const mct_real *x,
                     const mct_evaluation *closed, mct_judgement *out);

#endif

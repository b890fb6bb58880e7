/**
 * @file gauss.h
 * Gauss's principle of least constraint, for any particles whose place is a function of coordinates and time.
 *
 *     x = h(t, q),    m xdd = f + e,    e = arg min sum |e_i|^2 / m_i
 *
 * The only thing to write is h, once, in hyper-dual numbers. All else follows without a finite difference:
 *
 *     xd  = J v + dh/dt
 *     xdd = J a + Jdot v + d(dh/dt)/dt
 *     M a + C v (+ what an explicit time adds) = tau,   M = J'mJ,   C = J'm Jdot,   tau = J'f + couples
 *
 * The accelerations are the solution of the least-squares problem itself, by reflections of J in the inner
 * product of the masses, and the constraint forces are its residual; M is for show and is never inverted.
 * A cart-pole took 1.2 us an evaluation where it was measured (x86-64, -O2): the engine is the judge of the
 * closed forms, and what serves a mechanism that has none.
 *
 * Conventions: SI units; axes 1 right, 2 up, 3 to the viewer; v is the rate of q. Source: sections 1, 2 and
 * 2.6. Differences from it: the sign of e is that of (5) and (12), not of (35); (66), (69), (70), (175) as
 * corrected here; couples (motor torques between bodies, joint friction) have no particle force
 * in the source and are given here the smallest one, see mct_gauss_dynamics().
 */
#ifndef MCTAU_GAUSS_H
#define MCTAU_GAUSS_H

#include "mctau/hyperdual.h"
#include "mctau/real.h"
#include "mctau/status.h"

#define MCT_GAUSS_MAX_PARTICLES   32
#define MCT_GAUSS_MAX_COORDINATES 8

/**
 * The constraint x = h(t, q): writes all three coordinates [m] of every particle. It is called once for each
 * coordinate and once more, must not depend on anything but its arguments, and must not branch on
 * derivatives. In single precision, let `time` be a phase: after three hours a float clock ticks in
 * milliseconds.
 */
typedef void (*mct_gauss_place)(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                                mct_hyperdual (*position)[3]);

/** A mechanism: constant, owned by the caller, shared freely between threads. */
typedef struct {
    int particle_count;   /**< 1 to MCT_GAUSS_MAX_PARTICLES */
    int coordinate_count; /**< 1 to MCT_GAUSS_MAX_COORDINATES */
    const mct_real *mass; /**< of each particle, positive [kg] */
    mct_gauss_place place;
    const void *context; /**< handed to place() */
} mct_gauss_system;

#define MCT_GAUSS_MAX_ROWS (3 * MCT_GAUSS_MAX_PARTICLES)

/** Room for the calculation, 23 KiB in double, one for each thread. All members are private. */
typedef struct {
    mct_real J[MCT_GAUSS_MAX_ROWS * MCT_GAUSS_MAX_COORDINATES];      /* dx/dq', 3 rows a particle, packed */
    mct_real J_rate[MCT_GAUSS_MAX_ROWS * MCT_GAUSS_MAX_COORDINATES]; /* Jdot, in the same way */
    mct_real bias[MCT_GAUSS_MAX_ROWS];                               /* xdd for a = 0 */
    mct_real design[MCT_GAUSS_MAX_ROWS * MCT_GAUSS_MAX_COORDINATES];
    mct_real weight[MCT_GAUSS_MAX_ROWS];
    mct_real residual[MCT_GAUSS_MAX_ROWS];
    mct_hyperdual position[MCT_GAUSS_MAX_PARTICLES][3];
} mct_gauss_workspace;

/** What the equation of motion says at one state. Entries beyond the two counts are not written. */
typedef struct {
    /* of time, position and velocity, by mct_gauss_kinematics() */
    mct_real M[MCT_GAUSS_MAX_COORDINATES][MCT_GAUSS_MAX_COORDINATES]; /**< J'mJ, symmetric */
    mct_real C[MCT_GAUSS_MAX_COORDINATES][MCT_GAUSS_MAX_COORDINATES]; /**< J'm Jdot; only C v is unique */
    mct_real Cv[MCT_GAUSS_MAX_COORDINATES];        /**< J'm xdd for a = 0: C v, plus that of explicit time */
    mct_real position[MCT_GAUSS_MAX_PARTICLES][3]; /**< [m] */
    mct_real velocity[MCT_GAUSS_MAX_PARTICLES][3]; /**< [m/s] */
    /* of these and the forces, by mct_gauss_dynamics() */
    mct_real tau[MCT_GAUSS_MAX_COORDINATES];                    /**< J'f + couples: N, N m by coordinate */
    mct_real acceleration[MCT_GAUSS_MAX_COORDINATES];           /**< a, of the coordinates */
    mct_real particle_acceleration[MCT_GAUSS_MAX_PARTICLES][3]; /**< xdd [m/s^2] */
    mct_real constraint_force[MCT_GAUSS_MAX_PARTICLES][3];      /**< e = m xdd - f [N] */
} mct_gauss_motion;

/**
 * Everything that depends on time, position and velocity alone; forces may then be made from it (drag,
 * springs).
 *
 * @param time  [s]
 * @param q, v  coordinates and their rates, coordinate_count each
 * @return MCT_ERROR_ARGUMENT (a count below 1, no mass, no place), MCT_ERROR_BOUND (a count above its most),
 *         MCT_ERROR_RANGE (a mass is not positive), MCT_ERROR_NOT_FINITE (h, or a derivative of it). M may be
 *         singular. On an error, `motion` is undefined. Thread-safe for distinct workspaces and motions.
 */
mct_status mct_gauss_kinematics(const mct_gauss_system *self, mct_real time, const mct_real *q,
                                const mct_real *v, mct_gauss_workspace *workspace, mct_gauss_motion *motion);

/**
 * Generalised forces, accelerations and constraint forces, after mct_gauss_kinematics() with the same
 * arguments.
 *
 * A couple is a generalised force that no particle force is known for: a motor's torque between two bodies
 * counts on the angle between them. Of all particle forces with that effect, the constraints pass on the
 * smallest one in the sense of the principle, m J M^-1 couple, so e contains it. Therefore:
 *     e . xd = couple . v   for constraints without explicit time, hence 0 without couples;
 *     a moving base works on the particles through e.
 *
 * @param force   on each particle, particle_count x 3 [N], or null for none
 * @param couple  on each coordinate, coordinate_count, or null for none
 * @return MCT_ERROR_SINGULAR when the coordinates do not move the particles independently, so that M has no
 *         inverse; MCT_ERROR_NOT_FINITE (a force, or an acceleration). Then tau is still written, and the
 *         accelerations and constraint forces keep their former values. Thread-safe as above.
 */
mct_status mct_gauss_dynamics(const mct_gauss_system *self, const mct_real *force, const mct_real *couple,
                              mct_gauss_workspace *workspace, mct_gauss_motion *motion);

/**
 * C from the derivatives of M, in two of its forms; for constraints without explicit time both give C v of
 * (227).
 */
typedef struct {
    /** [k][i][j] is dM_ij/dq_k, symmetric in i and j */
    mct_real M_by[MCT_GAUSS_MAX_COORDINATES][MCT_GAUSS_MAX_COORDINATES][MCT_GAUSS_MAX_COORDINATES];
    /**
     * Christoffel's: C_ij = sum_k (dM_ij/dq_k + dM_ik/dq_j - dM_jk/dq_i) v_k / 2, so that Mdot - 2 C is skew
     */
    mct_real C[MCT_GAUSS_MAX_COORDINATES][MCT_GAUSS_MAX_COORDINATES];
    /** that of (228), (229): C_ij = sum_k (dM_ij/dq_k - dM_jk/dq_i / 2) v_k */
    mct_real C_alternative[MCT_GAUSS_MAX_COORDINATES][MCT_GAUSS_MAX_COORDINATES];
} mct_gauss_lagrange;

/**
 * The Lagrangian's form of C (3.0.3), after mct_gauss_kinematics() with the same arguments.
 *
 * Christoffel's choice is J'm Jdot, the C of mct_gauss_motion, where time does not enter: that one comes from
 * the motion, this one from M alone. With explicit time both leave out what time adds to C v. Corrections to
 * the source: (228) has one rate too many, and (229) is not J'm Jdot, though it gives the same C v.
 *
 * @return MCT_ERROR_NOT_FINITE (a second derivative of h, or a rate); `form` is then undefined. Cost: place()
 *         is called coordinate_count^2 times. Thread-safe as above; mct_gauss_dynamics() may follow as well.
 */
mct_status mct_gauss_christoffel(const mct_gauss_system *self, mct_real time, const mct_real *q,
                                 const mct_real *v, mct_gauss_workspace *workspace, mct_gauss_lagrange *form);

#endif

/**
 * @file rotation.h
 * Rotations of space: vectors, quaternions, matrices, and their rates (source, section 4.1); motion in polar
 * coordinates (4.5).
 *
 * One rotation in three forms, all of which take a vector b of the body to x = r b in space:
 *
 *     vector      u[3] = axis * angle [rad], turning counterclockwise about u (233)
 *     quaternion  q[4] = (cos(|u|/2), sin(|u|/2) u/|u|), scalar first, of length 1; q and -q are one rotation
 *     matrix      r[9] = e^R[u], row-major: entry (i, j) is r[3 i + j]; R[u] y = u x y (230)
 *
 * The rate of u is not the angular velocity (see mct_left_jacobian()), so motion is carried by a quaternion,
 * turned by small increments: no angle is special to it.
 *
 * All is in the core's precision and deterministic to the bit. An output must not overlap an input. Angles:
 * to 1e6 rad, in single precision 8192 (sincos.h); numbers that are not finite go through. Thread-safe.
 */
#ifndef MCTAU_ROTATION_H
#define MCTAU_ROTATION_H

#include "mctau/arctan.h"
#include "mctau/real.h"
#include "mctau/sincos.h"
#include "mctau/status.h"

/* --- inline: what kernels are made of --- */

/** a' b, of 3 components each. */
MCT_INLINE mct_real mct_dot(const mct_real *a, const mct_real *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** product = a x b, of 3 components each. */
MCT_INLINE void mct_cross(const mct_real *a, const mct_real *b, mct_real *product)
{
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

/** product = a b of quaternions, the rotation b and then a. 16 multiplications. */
MCT_INLINE void mct_quaternion_multiply(const mct_real *a, const mct_real *b, mct_real *product)
{
    product[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    product[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    product[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    product[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

/** The inverse rotation: of length 1, q^-1 = (q0, -q1, -q2, -q3). */
MCT_INLINE void mct_quaternion_inverse(const mct_real *q, mct_real *inverse)
{
    inverse[0] = q[0];
    for (int i = 1; i < 4; i++) {
        inverse[i] = -q[i];
    }
}

/**
 * x = r b = b + w y + v x y, y = 2 v x b, for q = (w, v): from body axes to those of space. Some 30
 * operations.
 */
MCT_INLINE void mct_rotate(const mct_real *q, const mct_real *b, mct_real *x)
{
    mct_real once[3], twice[3];
    mct_cross(q + 1, b, once);
    mct_cross(q + 1, once, twice);
    for (int i = 0; i < 3; i++) {
        x[i] = b[i] + 2 * (q[0] * once[i] + twice[i]);
    }
}

/** b = r' x: from space axes to those of the body. */
MCT_INLINE void mct_rotate_back(const mct_real *q, const mct_real *x, mct_real *b)
{
    mct_real once[3], twice[3];
    mct_cross(q + 1, x, once);
    mct_cross(q + 1, once, twice);
    for (int i = 0; i < 3; i++) {
        b[i] = x[i] + 2 * (twice[i] - q[0] * once[i]);
    }
}

/**
 * e = e^(u/2) - 1: the quaternion of the rotation vector u less the identity (1, 0, 0, 0), so that a small
 * turn keeps all its digits; good at 0 and around 2 pi. No root and no sine up to |u| = 1/2; there the series
 * leaves out less than a tenth of a rounding.
 */
MCT_INLINE void mct_quaternion_turn(const mct_real *u, mct_real *e)
{
    const mct_real z = MCT_R(0.25) * mct_dot(u, u); /* the square of the half angle a */
    mct_real sine;                                  /* sin(a) / (2 a) */
    if (z <= MCT_R(0.0625)) {
#if MCT_REAL_IS_FLOAT
        sine = 0.5F - z * (1.0F / 12 - z * (1.0F / 240 - z * (1.0F / 10080)));
        e[0] = -z * (0.5F - z * (1.0F / 24 - z * (1.0F / 720 - z * (1.0F / 40320))));
#else
        sine = 0.5 - z * (1.0 / 12 -
                          z * (1.0 / 240 - z * (1.0 / 10080 - z * (1.0 / 725760 - z * (1.0 / 79833600)))));
        e[0] = -z * (0.5 -
                     z * (1.0 / 24 -
                          z * (1.0 / 720 - z * (1.0 / 40320 - z * (1.0 / 3628800 - z * (1.0 / 479001600))))));
#endif
    } else {
        const mct_real inverse_length = mct_inverse_root(z);
        mct_real s, c; /* of a/2 */
        mct_sincos(MCT_R(0.5) * (z * inverse_length), &s, &c);
        sine = s * c * inverse_length;
        e[0] = -2 * s * s;
    }
    for (int i = 0; i < 3; i++) {
        e[i + 1] = sine * u[i];
    }
}

/** increment = q (e^(u/2) - 1): what a turn by u, given in body axes, adds to q. */
MCT_INLINE void mct_quaternion_turn_body(const mct_real *q, const mct_real *u, mct_real *increment)
{
    mct_real e[4];
    mct_quaternion_turn(u, e);
    mct_quaternion_multiply(q, e, increment);
}

/** increment = (e^(u/2) - 1) q: what a turn by u, given in space axes, adds to q. */
MCT_INLINE void mct_quaternion_turn_space(const mct_real *q, const mct_real *u, mct_real *increment)
{
    mct_real e[4];
    mct_quaternion_turn(u, e);
    mct_quaternion_multiply(e, q, increment);
}

/** rate = q (0, w)/2, of q under the angular velocity w in body axes [rad/s]. */
MCT_INLINE void mct_quaternion_rate_body(const mct_real *q, const mct_real *w, mct_real *rate)
{
    const mct_real half[4] = {0, MCT_R(0.5) * w[0], MCT_R(0.5) * w[1], MCT_R(0.5) * w[2]};
    mct_quaternion_multiply(q, half, rate);
}

/** rate = (0, w)/2 q, of q under the angular velocity w in space axes [rad/s]. */
MCT_INLINE void mct_quaternion_rate_space(const mct_real *q, const mct_real *w, mct_real *rate)
{
    const mct_real half[4] = {0, MCT_R(0.5) * w[0], MCT_R(0.5) * w[1], MCT_R(0.5) * w[2]};
    mct_quaternion_multiply(half, q, rate);
}

/**
 * (1 - |q|^2)/2: times q, it is the increment of Newton's step back to length 1. Once a step keeps q there.
 */
MCT_INLINE mct_real mct_quaternion_defect(const mct_real *q)
{
    return MCT_R(0.5) * ((1 - q[0] * q[0]) - mct_dot(q + 1, q + 1));
}

/* --- from one form to another --- */

/** R[u] (231), so that R[u] y = u x y. */
void mct_skew(const mct_real *u, mct_real *matrix);

/** The quaternion of a rotation vector of any length. */
void mct_quaternion_of_vector(const mct_real *u, mct_real *q);

/** The shortest rotation vector of a quaternion, |u| <= pi. q need not have length 1, but not length 0. */
void mct_vector_of_quaternion(const mct_real *q, mct_real *u);

/** The matrix of a quaternion of length 1. */
void mct_matrix_of_quaternion(const mct_real *q, mct_real *r);

/**
 * The quaternion of a matrix, of length 1 and with q[0] >= 0. By its largest component, so no angle is
 * special; a matrix that rounding has left not quite orthogonal will do.
 */
void mct_quaternion_of_matrix(const mct_real *r, mct_real *q);

/** e^R[u] (232), for a rotation vector of any length. */
void mct_matrix_of_vector(const mct_real *u, mct_real *r);

/** The shortest rotation vector of a matrix, |u| <= pi: to the last digits at 0 and at pi, too. */
void mct_vector_of_matrix(const mct_real *r, mct_real *u);

/* --- the rate of a rotation vector --- */

/**
 * Stumpff's functions c[0] to c[6] of s = a^2 >= 0: c[n] = 1/n! - s/(n+2)! + s^2/(n+4)! ...; cos a, sin(a)/a,
 * (1 - cos a)/a^2, (a - sin a)/a^3, and so on, without their differences where a is small.
 */
void mct_stumpff(mct_real s, mct_real *c);

/**
 * J_l of w = J_l(u) du/dt, the angular velocity in space axes from the rate of the rotation vector, 3 x 3
 * row-major: J_l = 1 + (1 - cos a)/a^2 R[u] + (a - sin a)/a^3 R^2[u], a = |u|. It corrects (242), where it is
 * missing.
 */
void mct_left_jacobian(const mct_real *u, mct_real *matrix);

/** J_r = r' J_l = J_l': the angular velocity in body axes is J_r(u) du/dt. */
void mct_right_jacobian(const mct_real *u, mct_real *matrix);

/**
 * J_l^-1 = 1 - R[u]/2 + (1/a^2 - (1 + cos a)/(2 a sin a)) R^2[u], so that du/dt = J_l^-1 w.
 * @return MCT_ERROR_SINGULAR, with the matrix undefined, where |u| is a whole number of turns but 0 to within
 *         rounding.
 */
mct_status mct_left_jacobian_inverse(const mct_real *u, mct_real *matrix);

/** J_r^-1, of the angular velocity in body axes; corrects (419). Errors as above. */
mct_status mct_right_jacobian_inverse(const mct_real *u, mct_real *matrix);

/* --- motion in polar coordinates --- */

/** A motion as turning about a point and moving away from it: x - o = alpha e^R[beta] (b - o) (288). */
typedef struct {
    mct_real scale;                  /**< alpha, positive */
    mct_real rotation[3];            /**< beta, the shortest of those that do: across b - o [rad] */
    mct_real scale_rate;             /**< [1/s] */
    mct_real angular_velocity[3];    /**< in space axes, the one across x - o [rad/s] */
    mct_real radial_velocity[3];     /**< (292), along x - o */
    mct_real tangential_velocity[3]; /**< (293) with a cross product: angular_velocity x (x - o) */
} mct_polar_motion;

/**
 * Splits the motion of a particle about a fixed point into its rotational and its radial part (4.5, where the
 * text has "tangential" for radial, and the rate of beta stands for the angular velocity).
 *
 * A spin about x - o moves nothing, so it is taken as 0, in beta, too. Where x lies opposite to b, any axis
 * across will do, and one is chosen.
 *
 * @param about      o, the fixed point [m]
 * @param reference  b, where the particle is for alpha = 1, beta = 0
 * @param position, velocity  of the particle [m], [m/s]
 * @return MCT_ERROR_SINGULAR, with `motion` undefined, when the particle or its reference lies at the point.
 *         Squares of distances must be representable: in single precision, distances from 1e-18 to 1e18.
 */
mct_status mct_polar_decomposition(const mct_real *about, const mct_real *reference, const mct_real *position,
                                   const mct_real *velocity, mct_polar_motion *motion);

#endif

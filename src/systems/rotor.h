/*
 * A body that turns about a point: Euler's equation in body axes, and the pieces of which steppers are made.
 *
 *     I wd = couple - D w - w x I w,    qd = q (0, w) / 2
 *
 * w is the angular velocity in body axes, q the attitude, D the damping: viscous + drag |w|.
 *
 * Where all particles lie on a line through the point there is no inertia about it, and wd is the least that
 * fits: the spin about the line is kept, and nothing damps it. The pseudo-inverse does that, and D w stands
 * for its part across the line.
 *
 * Source: 4.2, 5.2, 6.4, with theta-dot read as the angular velocity; (417) in body axes; (419) by turning
 * the attitude.
 */
#ifndef MCT_SYSTEMS_ROTOR_H
#define MCT_SYSTEMS_ROTOR_H

#include "../steppers/taylor.h"
#include "mctau/hyperdual.h"
#include "mctau/inertia.h"
#include "mctau/rotation.h"
#include "mctau/rotor.h"
#include "mctau/system.h"

enum { MCT_ROTOR_COLUMNS = 4 }; /* of a particle: mass, place in body axes */

extern const mct_field mct_rotor_columns[MCT_ROTOR_COLUMNS];

/* A principal moment below this part of the largest counts as none. */
#define MCT_LEAST_MOMENT 1e-10

/*
 * Constants for steps of h seconds, but for the damping, which is 0: of particles, rows of mass [kg], above
 * 0, and place [m], that turn about their centre or about the origin. `body` and the principal moments about
 * that point are for who needs them. Returns MCT_ERROR_SINGULAR when no axis has inertia.
 */
mct_status mct_rotor_prepare(const double *particles, int count, bool about_center, double h,
                             mct_rotor *rotor, mct_body *body, double *moments);

/* Where the particles are about the point, for the Gauss engine; q: the attitude. */
void mct_rotor_place(const mct_rotor *rotor, const mct_hyperdual *q, mct_hyperdual (*position)[3]);

/* --- vectors and matrices of three --- */

MCT_INLINE void mct_apply(const mct_real (*matrix)[3], const mct_real *x, mct_real *product)
{
    for (int i = 0; i < 3; i++) {
        product[i] = mct_dot(matrix[i], x);
    }
}

/* wd x arm + w x (w x arm): acceleration of a point of a body that turns, all in the same axes. */
MCT_INLINE void mct_turning_acceleration(const mct_real *w, const mct_real *wd, const mct_real *arm,
                                         mct_real *out)
{
    mct_real velocity[3], inward[3];
    mct_cross(w, arm, velocity);
    mct_cross(w, velocity, inward);
    mct_cross(wd, arm, out);
    for (int i = 0; i < 3; i++) {
        out[i] += inward[i];
    }
}

/* --- the right-hand side --- */

/* D of a velocity or an angular velocity v, and what its square adds along v: d(D v)/dv' = D + slope v v'. */
MCT_INLINE mct_real mct_damping(unsigned effects, mct_real viscous, mct_real drag, const mct_real *v,
                                mct_real *slope)
{
    mct_real sum = 0;
    *slope = 0;
    if (effects & MCT_VISCOUS) {
        sum += viscous;
    }
    if (effects & MCT_DRAG) {
        const mct_real square = mct_dot(v, v);
        const mct_real inverse = mct_inverse_root(square); /* finite at 0 */
        sum += drag * (square * inverse);
        *slope = drag * inverse;
    }
    return sum;
}

/* couple - D w - w x I w, where is_gyroscopic; returns D. */
MCT_INLINE mct_real mct_rotor_drive(const mct_rotor *k, unsigned effects, bool is_gyroscopic,
                                    const mct_real *couple, const mct_real *w, mct_real *slope, mct_real *sum)
{
    const mct_real damping = mct_damping(effects, k->viscous, k->drag, w, slope);
    const mct_real idle = mct_dot(k->idle_axis, w);
    mct_real momentum[3], gyroscopic[3];
    mct_apply(k->inertia, w, momentum);
    mct_cross(w, momentum, gyroscopic);
    for (int i = 0; i < 3; i++) {
        sum[i] = couple[i];
        if (effects & (MCT_VISCOUS | MCT_DRAG)) {
            sum[i] -= damping * (w[i] - idle * k->idle_axis[i]);
        }
        if (is_gyroscopic) {
            sum[i] -= gyroscopic[i];
        }
    }
    return damping;
}

/* wd under a couple. */
MCT_INLINE void mct_rotor_accelerate(const mct_rotor *k, unsigned effects, const mct_real *couple,
                                     const mct_real *w, mct_real *wd)
{
    mct_real slope, sum[3];
    (void)mct_rotor_drive(k, effects, true, couple, w, &slope, sum);
    mct_apply(k->inverse, sum, wd);
}

/* --- pieces of steppers: increments over a step --- */

/* Newton's step back to length 1, within the same increment. */
MCT_INLINE void mct_rotor_renormalise(const mct_real *q, mct_real *dq)
{
    mct_real end[4];
    for (int i = 0; i < 4; i++) {
        end[i] = q[i] + dq[i];
    }
    const mct_real defect = mct_quaternion_defect(end);
    for (int i = 0; i < 4; i++) {
        dq[i] += defect * end[i];
    }
}

/* end = q turned at w, in body axes, for `time`; dq: by how much. */
MCT_INLINE void mct_rotor_drift(const mct_real *q, const mct_real *w, mct_real time, mct_real *dq,
                                mct_real *end)
{
    const mct_real u[3] = {time * w[0], time * w[1], time * w[2]};
    mct_quaternion_turn_body(q, u, dq);
    for (int i = 0; i < 4; i++) {
        end[i] = q[i] + dq[i];
    }
}

/* Solves A x = b, whose columns are given: Cramer's rule, for A well away from singular. */
MCT_INLINE void mct_solve_columns(mct_real (*column)[3], const mct_real *b, mct_real *x)
{
    mct_real across[3][3];
    for (int j = 0; j < 3; j++) {
        mct_cross(column[(j + 1) % 3], column[(j + 2) % 3], across[j]);
    }
    const mct_real inverse = 1 / mct_dot(column[0], across[0]);
    for (int j = 0; j < 3; j++) {
        x[j] = inverse * mct_dot(across[j], b);
    }
}

/*
 * dw of `euler`: the couple alone, the damping at the new rate, (I + h D) dw = h (couple - D w). The body
 * turns later.
 */
MCT_INLINE void mct_rotor_push(const mct_rotor *k, unsigned effects, const mct_real *couple,
                               const mct_real *w, mct_real *dw)
{
    mct_real slope, sum[3], column[3][3];
    const mct_real damping = mct_rotor_drive(k, effects, false, couple, w, &slope, sum);
    if (!(effects & (MCT_VISCOUS | MCT_DRAG))) {
        mct_apply(k->inverse, sum, dw);
        for (int i = 0; i < 3; i++) {
            dw[i] *= k->step.h;
        }
        return;
    }
    const mct_real factor = k->step.h * k->inverse_size;
    for (int i = 0; i < 3; i++) {
        sum[i] *= factor;
        for (int j = 0; j < 3; j++) {
            column[j][i] = k->shape[i][j] + (i == j ? factor * damping : 0);
        }
    }
    mct_solve_columns(column, sum, dw);
}

/*
 * dw of `leap`, with f = couple - D w - w x I w: (I - h/2 df/dw') dw = h f, which is Kahan's bilinear form of
 * what is quadratic in w.
 */
MCT_INLINE void mct_rotor_kick(const mct_rotor *k, unsigned effects, const mct_real *couple,
                               const mct_real *w, mct_real *dw)
{
    mct_real slope, sum[3], momentum[3], column[3][3];
    const mct_real damping = mct_rotor_drive(k, effects, true, couple, w, &slope, sum);
    const mct_real factor = k->step.half * k->inverse_size;
    mct_apply(k->inertia, w, momentum);
    const mct_real momentum_across[3][3] = {/* - I w x each axis */
                                            {0, -momentum[2], momentum[1]},
                                            {momentum[2], 0, -momentum[0]},
                                            {-momentum[1], momentum[0], 0}};
    for (int j = 0; j < 3; j++) {
        mct_cross(w, k->inertia[j], column[j]); /* I is symmetric */
        for (int i = 0; i < 3; i++) {
            mct_real rate = column[j][i] + momentum_across[j][i];
            if (effects & (MCT_VISCOUS | MCT_DRAG)) {
                rate += (i == j ? damping : 0) + slope * (w[i] * w[j]);
            }
            column[j][i] = k->shape[i][j] + factor * rate;
        }
        sum[j] *= 2 * factor;
    }
    mct_solve_columns(column, sum, dw);
}

/* change = (r - 1) y, r the turn whose quaternion is 1 + e; without a difference of large numbers. */
MCT_INLINE void mct_turn_change(const mct_real *e, const mct_real *y, mct_real *change)
{
    mct_real once[3], twice[3];
    mct_cross(e + 1, y, once);
    mct_cross(e + 1, once, twice);
    for (int i = 0; i < 3; i++) {
        change[i] = 2 * (twice[i] + (1 + e[0]) * once[i]);
    }
}

/*
 * The body turns at w for h under its angular momentum, which stays in space: 1 + e, the turn r, and
 * dw = I^-1 (r' - 1) I w. A spin about the idle axis takes no part: the momentum has nothing along it.
 */
MCT_INLINE void mct_rotor_carry(const mct_rotor *k, const mct_real *w, mct_real *e, mct_real *dw)
{
    const mct_real idle = mct_dot(k->idle_axis, w);
    mct_real turn[3], momentum[3], change[3];
    for (int i = 0; i < 3; i++) {
        turn[i] = k->step.h * (w[i] - idle * k->idle_axis[i]);
    }
    mct_quaternion_turn(turn, e);
    mct_apply(k->inertia, w, momentum);
    const mct_real back[4] = {e[0], -e[1], -e[2], -e[3]};
    mct_turn_change(back, momentum, change);
    mct_apply(k->inverse, change, dw);
}

/* --- series --- */

/* Terms of a vector. Not const where it is read: C99 takes no array of arrays for one of const. */
typedef mct_real mct_vector_series[MCT_TAYLOR_TERMS][3];

/* Of attitude, angular velocity and angular momentum in body axes. */
typedef struct {
    mct_real q[MCT_TAYLOR_TERMS][4];
    mct_vector_series w, momentum;
} mct_rotor_series;

MCT_INLINE void mct_rotor_series_start(const mct_rotor *k, const mct_real *q, const mct_real *w,
                                       mct_rotor_series *y)
{
    MCT_UNROLL
    for (int i = 0; i < 4; i++) {
        y->q[0][i] = q[i];
    }
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        y->w[0][i] = w[i];
    }
    mct_apply(k->inertia, w, y->momentum[0]);
}

/* Term n of a x b. */
MCT_INLINE void mct_series_cross(mct_vector_series a, mct_vector_series b, int n, mct_real *product)
{
    mct_real sum[3] = {0, 0, 0};
    for (int j = 0; j <= n; j++) {
        mct_real term[3];
        mct_cross(a[j], b[n - j], term);
        MCT_UNROLL
        for (int i = 0; i < 3; i++) {
            sum[i] += term[i];
        }
    }
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        product[i] = sum[i];
    }
}

/* Term n + 1 of r'y, a vector y of space in body axes: its rate is (r'y) x w. */
MCT_INLINE void mct_rotor_series_turn_back(const mct_rotor *k, mct_rotor_series *y, int n,
                                           mct_vector_series vector)
{
    const mct_real share = k->step.h * mct_series_share(n);
    mct_real rate[3];
    mct_series_cross(vector, y->w, n, rate);
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        vector[n + 1][i] = share * rate[i];
    }
}

/* Term n + 1 of all, under term n of the couple: as mct_rotor_accelerate() and mct_quaternion_rate_body(). */
MCT_INLINE void mct_rotor_series_next(const mct_rotor *k, unsigned effects, const mct_real *couple, int n,
                                      mct_rotor_series *y)
{
    const mct_real share = k->step.h * mct_series_share(n);
    const mct_real *const now = y->w[n];
    mct_real sum[3], turn[4] = {0, 0, 0, 0};
    mct_series_cross(y->momentum, y->w, n, sum);
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        sum[i] += couple[i];
        if (effects & MCT_VISCOUS) {
            sum[i] -= k->viscous * (now[i] - mct_dot(k->idle_axis, now) * k->idle_axis[i]);
        }
    }
    mct_apply(k->inverse, sum, y->w[n + 1]);
    for (int j = 0; j <= n; j++) { /* of 2 qd = q (0, w) */
        const mct_real *const q = y->q[n - j];
        const mct_real *const w = y->w[j];
        mct_real across[3];
        mct_cross(q + 1, w, across);
        turn[0] -= mct_dot(q + 1, w);
        MCT_UNROLL
        for (int i = 0; i < 3; i++) {
            turn[1 + i] += q[0] * w[i] + across[i];
        }
    }
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        y->w[n + 1][i] *= share;
    }
    mct_apply(k->inertia, y->w[n + 1], y->momentum[n + 1]);
    MCT_UNROLL
    for (int i = 0; i < 4; i++) {
        y->q[n + 1][i] = MCT_R(0.5) * share * turn[i];
    }
}

MCT_INLINE void mct_rotor_series_sum(mct_rotor_series *y, int order, mct_real *dq, mct_real *dw)
{
    MCT_UNROLL
    for (int i = 0; i < 4; i++) {
        dq[i] = y->q[order][i];
    }
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        dw[i] = y->w[order][i];
    }
    for (int n = order - 1; n > 0; n--) { /* the smallest first */
        MCT_UNROLL
        for (int i = 0; i < 4; i++) {
            dq[i] += y->q[n][i];
        }
        MCT_UNROLL
        for (int i = 0; i < 3; i++) {
            dw[i] += y->w[n][i];
        }
    }
}

#endif

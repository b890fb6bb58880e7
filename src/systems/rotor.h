/*
 * A body that turns about a point: Euler's equation in principal axes, and the pieces of which steppers are
 * made.
 *
 *     I wd = couple - D w - w x I w,    qd = q (0, w) / 2
 *
 * w is the angular velocity, q the attitude, D the damping: viscous + drag |w|. All are of the principal
 * axes, which are fixed in the body, so I has three entries: `mct_rotor_enter` takes an attitude there,
 * `mct_rotor_leave` increments back.
 *
 * Where all particles lie on a line through the point there is no inertia about it, and wd is the least that
 * fits: the spin about the line is kept, and nothing damps it. What the constants have for that axis is 0.
 *
 * Source: 4.2, 5.2, 6.4, with theta-dot read as the angular velocity; (417); principal axes (367); (419) by
 * turning the attitude.
 */
#ifndef MCT_SYSTEMS_ROTOR_H
#define MCT_SYSTEMS_ROTOR_H

#include "../steppers/split3.h"
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

/* product = matrix' x */
MCT_INLINE void mct_apply_back(const mct_real (*matrix)[3], const mct_real *x, mct_real *product)
{
    for (int i = 0; i < 3; i++) {
        product[i] = matrix[0][i] * x[0] + matrix[1][i] * x[1] + matrix[2][i] * x[2];
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

/* wd under a couple. */
MCT_INLINE void mct_rotor_accelerate(const mct_rotor *k, unsigned effects, const mct_real *couple,
                                     const mct_real *w, mct_real *wd)
{
    mct_real slope;
    const mct_real damping = mct_damping(effects, k->viscous, k->drag, w, &slope);
    for (int i = 0; i < 3; i++) {
        mct_real torque = couple[i];
        if (effects & (MCT_VISCOUS | MCT_DRAG)) {
            torque -= damping * w[i];
        }
        wd[i] = (k->coupling[i] * w[(i + 1) % 3]) * w[(i + 2) % 3] + k->inverse[i] * torque;
    }
}

/* qd = q (0, w) / 2 */
MCT_INLINE void mct_rotor_turn_rate(const mct_real *q, const mct_real *w, mct_real *qd)
{
    const mct_real a = MCT_R(0.5) * w[0], b = MCT_R(0.5) * w[1], c = MCT_R(0.5) * w[2];
    qd[0] = -(q[1] * a + q[2] * b) - q[3] * c;
    qd[1] = (q[0] * a + q[2] * c) - q[3] * b;
    qd[2] = (q[0] * b + q[3] * a) - q[1] * c;
    qd[3] = (q[0] * c + q[1] * b) - q[2] * a;
}

/* --- pieces of steppers: increments over a step --- */

/* The attitude of the principal axes, from that of the body, */
MCT_INLINE void mct_rotor_enter(const mct_rotor *k, const mct_real *q, mct_real *own)
{
    if (k->is_turned) {
        mct_quaternion_multiply(q, k->turn, own);
        return;
    }
    MCT_UNROLL
    for (int i = 0; i < 4; i++) {
        own[i] = q[i];
    }
}

/* and the way back, of its increment. */
MCT_INLINE void mct_rotor_leave(const mct_rotor *k, const mct_real *own, mct_real *q)
{
    if (k->is_turned) {
        mct_real back[4];
        mct_quaternion_inverse(k->turn, back);
        mct_quaternion_multiply(own, back, q);
        return;
    }
    MCT_UNROLL
    for (int i = 0; i < 4; i++) {
        q[i] = own[i];
    }
}

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
    mct_real slope;
    const mct_real damping = mct_damping(effects, k->viscous, k->drag, w, &slope);
    for (int i = 0; i < 3; i++) {
        const mct_real share = k->step.h * k->inverse[i];
        dw[i] = share * couple[i];
        if (effects & (MCT_VISCOUS | MCT_DRAG)) {
            dw[i] = share * (couple[i] - damping * w[i]) / (1 + share * damping);
        }
    }
}

/*
 * dw of `leap`: (1 - h/2 dwd/dw') dw = h wd, which is Kahan's bilinear form of what is quadratic in w.
 */
MCT_INLINE void mct_rotor_kick(const mct_rotor *k, unsigned effects, const mct_real *couple,
                               const mct_real *w, mct_real *dw)
{
    const mct_real half = k->step.half;
    mct_real sum[3], column[3][3], slope;
    const mct_real damping = mct_damping(effects, k->viscous, k->drag, w, &slope);
    mct_rotor_accelerate(k, effects, couple, w, sum);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const int l = (i + 2) % 3;
        const mct_real coupling = half * k->coupling[i];
        column[i][i] = 1;
        column[j][i] = -coupling * w[l];
        column[l][i] = -coupling * w[j];
        if (effects & (MCT_VISCOUS | MCT_DRAG)) {
            const mct_real share = half * k->inverse[i];
            column[i][i] += share * (damping + slope * (w[i] * w[i]));
            column[j][i] += share * (slope * (w[i] * w[j]));
            column[l][i] += share * (slope * (w[i] * w[l]));
        }
        sum[i] *= k->step.h;
    }
    mct_solve_columns(column, sum, dw);
}

/*
 * dw of half a step at rest: (1 + h/4 D / I) dw = h/2 (couple - D w) / I, symmetric in time; friction alone
 * damps.
 */
MCT_INLINE void mct_rotor_half_kick(const mct_rotor *k, unsigned effects, const mct_real *couple,
                                    const mct_real *w, mct_real *dw)
{
    for (int i = 0; i < 3; i++) {
        const mct_real share = k->step.half * k->inverse[i];
        dw[i] = share * couple[i];
        if (effects & MCT_VISCOUS) {
            dw[i] = share * (couple[i] - k->viscous * w[i]) / (1 + MCT_R(0.5) * share * k->viscous);
        }
    }
}

/* w of a momentum by the largest moment; 0 about an axis without inertia. */
MCT_INLINE mct_real mct_rotor_rate(const mct_rotor *k, int axis, mct_real momentum)
{
    return k->moment[axis] > 0 ? momentum / k->moment[axis] : 0;
}

/* The body turns under its angular momentum from w + dw on: `split3`. */
MCT_INLINE void mct_rotor_split(const mct_rotor *k, const mct_real *q, const mct_real *w, mct_real *dq,
                                mct_real *dw)
{
    mct_real L[3], change[3];
    for (int i = 0; i < 3; i++) {
        L[i] = k->moment[i] * (w[i] + dw[i]);
    }
    mct_split3(k->round, k->excess, k->step.h, q, L, dq, change);
    for (int i = 0; i < 3; i++) {
        dw[i] += mct_rotor_rate(k, i, change[i]);
    }
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
    mct_real turn[3], momentum[3], change[3];
    for (int i = 0; i < 3; i++) {
        turn[i] = k->moment[i] > 0 ? k->step.h * w[i] : 0;
        momentum[i] = k->moment[i] * w[i];
    }
    mct_quaternion_turn(turn, e);
    const mct_real back[4] = {e[0], -e[1], -e[2], -e[3]};
    mct_turn_change(back, momentum, change);
    for (int i = 0; i < 3; i++) {
        dw[i] = mct_rotor_rate(k, i, change[i]);
    }
}

/* --- series --- */

/* Terms of a vector. Not const where it is read: C99 takes no array of arrays for one of const. */
typedef mct_real mct_vector_series[MCT_TAYLOR_TERMS][3];

/* Of attitude and angular velocity. */
typedef struct {
    mct_real q[MCT_TAYLOR_TERMS][4];
    mct_vector_series w;
} mct_rotor_series;

MCT_INLINE void mct_rotor_series_start(const mct_real *q, const mct_real *w, mct_rotor_series *y)
{
    MCT_UNROLL
    for (int i = 0; i < 4; i++) {
        y->q[0][i] = q[i];
    }
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        y->w[0][i] = w[i];
    }
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

/* Term n + 1 of all, under term n of the couple: as mct_rotor_accelerate() and mct_rotor_turn_rate(). */
MCT_INLINE void mct_rotor_series_next(const mct_rotor *k, unsigned effects, const mct_real *couple, int n,
                                      mct_rotor_series *y)
{
    const mct_real share = k->step.h * mct_series_share(n);
    mct_real product[3] = {0, 0, 0}, turn[4] = {0, 0, 0, 0};
    for (int j = 0; j <= n; j++) { /* of 2 qd = q (0, w) */
        const mct_real *const q = y->q[n - j];
        const mct_real *const v = y->w[n - j];
        const mct_real *const w = y->w[j];
        mct_real across[3];
        mct_cross(q + 1, w, across);
        turn[0] -= mct_dot(q + 1, w);
        MCT_UNROLL
        for (int i = 0; i < 3; i++) {
            product[i] += v[(i + 1) % 3] * w[(i + 2) % 3];
            turn[1 + i] += q[0] * w[i] + across[i];
        }
    }
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        mct_real torque = couple[i];
        if (effects & MCT_VISCOUS) {
            torque -= k->viscous * y->w[n][i];
        }
        y->w[n + 1][i] = share * (k->coupling[i] * product[i] + k->inverse[i] * torque);
    }
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

/* --- a body without a couple --- */

/*
 * (1 + x)^(-1/2), nearly: to 2e-9 where x is above -0.1, which a step of mct_quaternion_defect() makes exact.
 */
MCT_INLINE mct_real mct_inverse_root_near(mct_real x)
{
    if (!(x > MCT_R(-0.1) && x < MCT_R(0.1))) {
        return mct_inverse_root(1 + x);
    }
    const mct_real z = MCT_R(-0.5) * x;
    const mct_real zz = z * z;
    return ((1 + z) + zz * (MCT_R(3.0 / 2) + z * MCT_R(5.0 / 2))) +
           (zz * zz) *
               ((MCT_R(35.0 / 8) + z * MCT_R(63.0 / 8)) + zz * (MCT_R(231.0 / 16) + z * MCT_R(429.0 / 16)));
}

/* mct_quaternion_turn() of way L, square = L'L, for which fewer operations wait for each other. */
MCT_INLINE void mct_turn_along(const mct_real *L, mct_real square, mct_real way, mct_real *e)
{
    const mct_real z = (MCT_R(0.25) * square) * (way * way);
    const mct_real zz = z * z;
    const mct_real u[3] = {way * L[0], way * L[1], way * L[2]};
    if (!(z <= MCT_R(0.0625))) {
        mct_quaternion_turn(u, e);
        return;
    }
    const mct_real sine = (MCT_R(1.0 / 2) - z * MCT_R(1.0 / 12)) +
                          zz * ((MCT_R(1.0 / 240) - z * MCT_R(1.0 / 10080)) +
                                zz * (MCT_R(1.0 / 725760) - z * MCT_R(1.0 / 79833600)));
    e[0] = -z * ((MCT_R(1.0 / 2) - z * MCT_R(1.0 / 24)) +
                 zz * ((MCT_R(1.0 / 720) - z * MCT_R(1.0 / 40320)) +
                       zz * (MCT_R(1.0 / 3628800) - z * MCT_R(1.0 / 479001600))));
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        e[1 + i] = sine * u[i];
    }
}

/*
 * A step by series. The angular momentum L stays in space, which leaves of the attitude a turn about it: the
 * shortest turn from the new L, as the body sees it, to the old one L', and then about the old one
 *
 *     L'  integral (w.L' + w.L) / (L.L' + L.L) dt
 *
 * for the rate of the shortest turn from L to L' has nothing along L + L'. That is one product of series
 * beside the three of w, where the quaternion's own rate takes twelve; and the momentum's direction is
 * kept whatever the order.
 *
 * Where L turns half round in the body within a step the integrand has a pole; no order is of use there.
 */
MCT_INLINE void mct_rotor_free_series(const mct_rotor *k, int order, const mct_real *q, const mct_real *w,
                                      mct_real *dq, mct_real *dw)
{
    const mct_real L[3] = {k->moment[0] * w[0], k->moment[1] * w[1], k->moment[2] * w[2]};
    const mct_real M[3] = {k->moment[0] * L[0], k->moment[1] * L[1], k->moment[2] * L[2]}; /* w.M = L.L' */
    const mct_real square = mct_dot(L, L);
    const mct_real inverse = square > 0 ? MCT_R(0.5) / square : 0;
    /* Factors of each product: of w2 w3, w3 w1, w1 w2, and of denominator and fraction. */
    mct_real a[MCT_TAYLOR_TERMS][4], b[MCT_TAYLOR_TERMS][4];
    mct_real now[3] = {w[0], w[1], w[2]}, first[3], rest[3] = {0, 0, 0}, way = 0;
    for (int n = 0; n < order; n++) {
        const mct_real share = k->step.h * mct_series_share(n);
        mct_real sum[4] = {0, 0, 0, 0};
        MCT_UNROLL
        for (int i = 0; i < 3; i++) {
            a[n][i] = now[(i + 1) % 3];
            b[n][i] = now[(i + 2) % 3];
        }
        a[n][3] = mct_dot(M, now); /* nobody reads term 0 */
        for (int j = n - 1; j > 0; j--) {
            MCT_UNROLL
            for (int i = 0; i < 4; i++) {
                sum[i] += a[j][i] * b[n - j][i];
            }
        }
        if (n > 0) {
            MCT_UNROLL
            for (int i = 0; i < 4; i++) {
                sum[i] += a[n][i] * b[0][i];
            }
        }
        b[n][3] = inverse * ((n == 0 ? 2 : 1) * mct_dot(L, now) - sum[3]);
        way += share * b[n][3];
        MCT_UNROLL
        for (int i = 0; i < 3; i++) {
            now[i] = (share * k->coupling[i]) * (sum[i] + a[0][i] * b[n][i]);
            if (n == 0) {
                first[i] = now[i];
            } else {
                rest[i] += now[i];
            }
        }
    }
    mct_real change[3], across[3], third[3], e[4], turn[4];
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        /* cppcheck-suppress uninitvar; the first round of the loop sets it */
        dw[i] = first[i] + rest[i];
        change[i] = inverse * (k->moment[i] * dw[i]);
    }
    /* The shortest turn: beside each other cosine and sine of its half, times the cosine. */
    const mct_real less = mct_dot(change, L);
    const mct_real along = 1 + less;
    mct_cross(change, L, across);
    const mct_real length = along * along + mct_dot(across, across); /* squared */
    const mct_real scale = mct_inverse_root_near(less);
    const mct_real cosine = scale * along;
    mct_turn_along(L, square, way, turn);
    mct_cross(turn + 1, across, third);
    e[0] = turn[0] * cosine + (cosine - 1);
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        e[1 + i] = cosine * turn[1 + i] + scale * ((1 + turn[0]) * across[i] + third[i]);
    }
    mct_quaternion_multiply(q, e, dq);
    /* Newton's step for both lengths, that of q at the start and that of the turn. */
    const mct_real defect = mct_quaternion_defect(q) + MCT_R(0.5) * (1 - (length * scale) * scale);
    MCT_UNROLL
    for (int i = 0; i < 4; i++) {
        dq[i] += defect * (q[i] + dq[i]);
    }
}

#endif

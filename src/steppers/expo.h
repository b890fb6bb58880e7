/*
 * Exponential collocation for xdot = A x + B u + e sin x_0: the linear part, motor included, is flowed
 * exactly; the sine, sampled at the start and at Radau's nodes, goes along the step as the polynomial through
 * its samples, which is integrated exactly. Hence no bound on h from the motor's L/R.
 *
 * The angle at a node needs the sine there and before. It is predicted within h^6 by the sine's Taylor series
 * up to t^3, from the mean second and third derivative of the linear motion, which a fast motor leaves
 * finite. Each further sweep, an iteration of Picard's, gains two orders. So the order is the smaller of 2
 * nodes + 1 and 2 sweeps + 4:
 *
 *     expo    2 nodes, 1 sweep: order 5
 *     expo8   4 nodes, 3 sweeps: order 9 by that, 8 measured; 5 to 6 below 1e-10 where L/R is near h
 *
 * Stored are the flow minus 1 and the response to what the sine exceeds its start by, which keeps float
 * exact.
 * Source: of the family in Hochbruck, Ostermann, "Exponential integrators", Acta Numerica 2010, section 2;
 *   order and error are measured in tests.
 */
#ifndef MCT_STEPPERS_EXPO_H
#define MCT_STEPPERS_EXPO_H

#include "advance.h"
#include "mctau/expo.h"
#include "mctau/sincos.h"

/*
 * Hides from gcc that a pointer is the same in every step. Else it copies all constants to its own stack before the
 * first one, which may take a third of a step where a tick has one.
 */
#if defined __GNUC__
#define MCT_EXPO_RELOAD(pointer) __asm__("" : "+r"(pointer))
#else
#define MCT_EXPO_RELOAD(pointer) (void)(pointer)
#endif

/* Terms side by side, in two sums: few wait for each other. */
MCT_INLINE mct_real mct_expo_dot(int n, const mct_real *a, const mct_real *b)
{
    mct_real even = a[0] * b[0];
    mct_real odd = a[1] * b[1];
    MCT_UNROLL
    for (int i = 2; i < n; i++) {
        *(i % 2 == 0 ? &even : &odd) += a[i] * b[i];
    }
    return even + odd;
}

/*
 * By how much sine and cosine of x + delta exceed s0 and c0, those of x: the addition theorem and series,
 * which leave out less than a rounding up to 1/2 rad; beyond as mct_sincos, which an absurd delta must not
 * leave the range of.
 */
MCT_INLINE void mct_expo_turn(mct_real x, mct_real delta, mct_real s0, mct_real c0, mct_real *s, mct_real *c)
{
    if (!(delta <= MCT_R(0.5) && delta >= MCT_R(-0.5))) {
        mct_sincos(x + mct_clamp(delta, 100000), s, c);
        *s -= s0;
        *c -= c0;
        return;
    }
    const mct_real z = delta * delta;
    const mct_real zz = z * z;
#if MCT_REAL_IS_FLOAT
    const mct_real p = (-1.0F / 6 + z * (1.0F / 120)) + zz * (-1.0F / 5040);
    const mct_real q = (0.5F - z * (1.0F / 24)) + zz * (1.0F / 720);
#else
    const mct_real p =
        (-1.0 / 6 + z * (1.0 / 120)) +
        zz * ((-1.0 / 5040 + z * (1.0 / 362880)) + zz * (-1.0 / 39916800 + z * (1.0 / 6227020800.0)));
    const mct_real q = ((0.5 - z * (1.0 / 24)) + zz * (1.0 / 720 - z * (1.0 / 40320))) +
                       (zz * zz) * ((1.0 / 3628800 - z * (1.0 / 479001600)) + zz * (1.0 / 87178291200.0));
#endif
    const mct_real sine = delta + (delta * z) * p;
    const mct_real versine = z * q;
    *s = c0 * sine - s0 * versine;
    *c = -(s0 * sine + c0 * versine);
}

/*
 * A node's angle [rad] that a sweep changes by less moves its sine along the tangent. That leaves out half
 * the change's square, which for h of use is less than the sweep itself leaves, change (w h)^2 / 56.
 */
#define MCT_EXPO_NEAR MCT_R(0.0009765625)

/* A row of x_0 times rates, current and input. */
MCT_INLINE mct_real mct_expo_linear(const mct_real *row, int rates, const mct_real *v, mct_real u)
{
    return mct_expo_dot(rates, row, v) + row[MCT_EXPO_INPUT] * u;
}

/* nodes, sweeps: literals, those that the constants are made for */
MCT_INLINE void mct_expo_increments(const mct_expo *expo, int nodes, int sweeps, unsigned effects, int n,
                                    const mct_real *x, mct_real u, mct_real *dx)
{
    if (effects & MCT_GRAVITY) {
        MCT_EXPO_RELOAD(expo);
    }
    const int states = 2 * n + ((effects & MCT_MOTOR_INDUCTIVE) ? 1 : 0);
    const int rates = states - n;
    const mct_real *v = x + n;
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        dx[i] = mct_expo_dot(rates, expo->flow[i], v) + expo->input[i] * u;
    }
    if (!(effects & MCT_GRAVITY)) {
        return;
    }
    mct_real s0, c0;
    mct_sincos(x[0], &s0, &c0);

    /*
     * The sine's derivatives at the start, by w, a and j, those of the angle: w c0, a c0 - w^2 s0 and
     * (j - w^3) c0 - 3 w a s0. Of a and j the linear part is known before the sine.
     */
    const mct_real w = v[0];
    const mct_real a = mct_expo_linear(expo->mean[0], rates, v, u);
    const mct_real j = mct_expo_linear(expo->mean[1], rates, v, u);
    const mct_real a_by_sine = expo->mean[0][MCT_EXPO_CONSTANT];
    const mct_real j_by_sine = expo->mean[1][MCT_EXPO_CONSTANT];
    const mct_real sc = s0 * c0;
    const mct_real rise[3] = {
        w * c0,
        (a * c0 - (w * w) * s0) + a_by_sine * sc,
        ((j - w * w * w) * c0 - (3 * w * a) * s0) + (j_by_sine * sc + (a_by_sine * w) * (1 - 4 * (s0 * s0))),
    };

    mct_real held[MCT_EXPO_NODES]; /* angles under the sine's first value; all less the start, these */
    mct_real angle[MCT_EXPO_NODES], s[MCT_EXPO_NODES], c[MCT_EXPO_NODES]; /* and their sines and cosines */
    MCT_UNROLL
    for (int m = 0; m < nodes; m++) {
        held[m] = mct_expo_linear(expo->angle[m], rates, v, u) + expo->angle[m][MCT_EXPO_CONSTANT] * s0;
        angle[m] = held[m] + mct_expo_dot(3, expo->angle_powers[m], rise);
        mct_expo_turn(x[0], angle[m], s0, c0, &s[m], &c[m]);
    }
    MCT_UNROLL
    for (int sweep = 1; sweep < sweeps; sweep++) {
        mct_real better[MCT_EXPO_NODES];
        MCT_UNROLL
        for (int m = 0; m < nodes; m++) {
            better[m] = held[m] + mct_expo_dot(nodes, expo->angle_nodes[m], s);
        }
        MCT_UNROLL
        for (int m = 0; m < nodes; m++) {
            const mct_real change = better[m] - angle[m];
            if (change <= MCT_EXPO_NEAR && change >= -MCT_EXPO_NEAR) {
                s[m] += (c0 + c[m]) * change;
            } else {
                mct_expo_turn(x[0], better[m], s0, c0, &s[m], &c[m]);
            }
            angle[m] = better[m];
        }
    }
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        dx[i] = (dx[i] + expo->constant[i] * s0) + mct_expo_dot(nodes, expo->nodes[i], s);
    }
}

#endif

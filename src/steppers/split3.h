/*
 * Splitting of a free rotation in principal axes: turns about axes in turn, each of them exact.
 *
 * The kinetic energy is L^2 / (2 I_a) + sum L_i^2 (1/I_i - 1/I_a) / 2, L the angular momentum, I_a one of the
 * moments. The first part turns the body about L, which stays; it commutes with all others. Each of these
 * turns it about axis i at a constant rate, L_i (1/I_i - 1/I_a), and L the other way round in the body:
 * nothing is left to do for a itself. So momentum is kept in space at any spin, and the motion of a body with
 * two equal moments is exact. The turns are put together symmetrically, 1 2 3 2 1: order 2, symmetric in
 * time; energy stays near.
 * Source: R. I. McLachlan, Explicit Lie-Poisson integration and the Euler equations (1993); S. Reich (1994);
 *   with the part that is round, F. Fasso (2003); Hairer, Lubich, Wanner, Geometric Numerical Integration,
 *   VII.5.
 */
#ifndef MCT_STEPPERS_SPLIT3_H
#define MCT_STEPPERS_SPLIT3_H

#include "mctau/rotation.h"

/* A turn of q + dq about principal axis i; of L + dL, seen from the body, the other way round. */
MCT_INLINE void mct_split3_turn(int i, mct_real angle, const mct_real *q, const mct_real *L, mct_real *dq,
                                mct_real *dL)
{
    const int j = (i + 1) % 3;
    const int l = (i + 2) % 3;
    mct_real s, c;
    mct_sincos(MCT_R(0.25) * angle, &s, &c);
    const mct_real sine = 2 * s * c; /* of half the angle, and its cosine less 1 */
    const mct_real less = -2 * s * s;
    const mct_real whole_sine = 2 * sine * (1 + less);
    const mct_real whole_less = -2 * sine * sine;
    const mct_real now[4] = {q[0] + dq[0], q[1] + dq[1], q[2] + dq[2], q[3] + dq[3]};
    const mct_real Lj = L[j] + dL[j];
    const mct_real Ll = L[l] + dL[l];
    dq[0] += less * now[0] - sine * now[1 + i];
    dq[1 + i] += less * now[1 + i] + sine * now[0];
    dq[1 + j] += less * now[1 + j] + sine * now[1 + l];
    dq[1 + l] += less * now[1 + l] - sine * now[1 + j];
    dL[j] += whole_less * Lj + whole_sine * Ll;
    dL[l] += whole_less * Ll - whole_sine * Lj;
}

/*
 * Increments over h seconds, of attitude and angular momentum; round: 1/I_a, excess: 1/I_i - 1/I_a, of which
 * one is 0.
 */
MCT_INLINE void mct_split3(mct_real round, const mct_real *excess, mct_real h, const mct_real *q,
                           const mct_real *L, mct_real *dq, mct_real *dL)
{
    const mct_real time = h * round;
    const mct_real u[3] = {time * L[0], time * L[1], time * L[2]};
    mct_quaternion_turn_body(q, u, dq);
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        dL[i] = 0;
    }
    MCT_UNROLL
    for (int turn = 0; turn < 5; turn++) {
        const int i = turn < 3 ? turn : 4 - turn;
        const mct_real span = i < 2 ? MCT_R(0.5) * h : h;
        if (excess[i] != 0) {
            mct_split3_turn(i, span * excess[i] * (L[i] + dL[i]), q, L, dq, dL);
        }
    }
}

#endif

/*
 * Kahan's leapfrog: half a drift, a kick at the middle with forces bilinear in the old and the new velocity,
 * half a drift.
 *
 * Quadratic velocity terms C(q,v) v become C(q,v) v', damping D v becomes D (v + v')/2, and an inductive
 * motor gives the mean of its exact current. One sincos, one 2 x 2 solve; exactly symmetric in time without
 * damping.
 * Source: Kahan's unconventional scheme for quadratic fields, inside a Strang splitting. Order 2.
 */
#ifndef MCT_STEPPERS_LEAP_H
#define MCT_STEPPERS_LEAP_H

#include "advance.h"

MCT_INLINE void mct_leap(mct_derivative kick, const void *constants, mct_step step, unsigned effects, int n,
                         const mct_real *x, mct_real u, mct_real *dx)
{
    const int states = mct_entries(effects, n);
    mct_real middle[MCT_MAX_STATES];
    MCT_UNROLL
    for (int i = 0; i < n; i++) {
        middle[i] = x[i] + step.half * x[n + i];
    }
    MCT_UNROLL
    for (int i = n; i < states; i++) {
        middle[i] = x[i];
    }
    kick(constants, effects, middle, u, dx);
    MCT_UNROLL
    for (int i = 0; i < n; i++) {
        dx[i] = step.h * x[n + i] + step.half * dx[n + i];
    }
}

#endif

/*
 * The source document's scheme, eqs. 22-23: v += h a, q += h v + h^2/2 a with the old v and a.
 * It is the Taylor method of order 1 with one free term more, and anti-damped: an oscillator of frequency w
 * grows as exp(w^2 h t / 4). Kept as the baseline.
 */
#ifndef MCT_STEPPERS_SEED_H
#define MCT_STEPPERS_SEED_H

#include "advance.h"

MCT_INLINE void mct_seed(mct_derivative derivative, const void *constants, mct_step step, unsigned effects,
                         int n, const mct_real *x, mct_real u, mct_real *dx)
{
    const int states = mct_entries(effects, n);
    derivative(constants, effects, x, u, dx);
    MCT_UNROLL
    for (int i = 0; i < n; i++) {
        dx[i] = step.h * (x[n + i] + step.half * dx[n + i]);
    }
    MCT_UNROLL
    for (int i = n; i < states; i++) {
        dx[i] *= step.h;
    }
}

#endif

/*
 * The classical Runge-Kutta method of order 4, for a right-hand side without an angle. rk4.h is the one with.
 */
#ifndef MCT_STEPPERS_RK4_PLAIN_H
#define MCT_STEPPERS_RK4_PLAIN_H

#include "advance.h"

MCT_INLINE void mct_rk4_plain(mct_derivative derivative, const void *constants, mct_step step,
                              unsigned effects, int n, const mct_real *x, mct_real u, mct_real *dx)
{
    const int states = mct_entries(effects, n);
    mct_real k1[MCT_MAX_STATES], k2[MCT_MAX_STATES], k3[MCT_MAX_STATES], k4[MCT_MAX_STATES],
        stage[MCT_MAX_STATES];
    derivative(constants, effects, x, u, k1);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.half * k1[i];
    }
    derivative(constants, effects, stage, u, k2);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.half * k2[i];
    }
    derivative(constants, effects, stage, u, k3);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.h * k3[i];
    }
    derivative(constants, effects, stage, u, k4);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        dx[i] = step.sixth * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
    }
}

#endif

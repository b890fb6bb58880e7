/*
 * The classical Runge-Kutta method of order 4.
 */
#ifndef MCT_STEPPERS_RK4_H
#define MCT_STEPPERS_RK4_H

#include "advance.h"

MCT_INLINE void mct_rk4(mct_derivative derivative, const void *constants, mct_step step, unsigned effects,
                        int n, const mct_real *x, mct_real u, mct_real *dx)
{
    const int states = 2 * n + ((effects & MCT_MOTOR_INDUCTIVE) ? 1 : 0);
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
    const mct_real sixth = step.h * MCT_R(1.0 / 6);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        dx[i] = sixth * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
    }
}

#endif

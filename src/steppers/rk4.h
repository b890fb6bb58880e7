/*
 * The classical Runge-Kutta method of order 4, for a system with one angle in its forces.
 *
 * The sine and cosine of the three later stages follow from the first by the addition theorem: a stage is a
 * small angle away, for which short series do. Beyond 1/16 rad (a rate of 125 rad/s at half a millisecond)
 * they are taken afresh.
 */
#ifndef MCT_STEPPERS_RK4_H
#define MCT_STEPPERS_RK4_H

#include "advance.h"
#include "mctau/sincos.h"

/* Time derivative of the state, given the sine and cosine of its angle. */
typedef void (*mct_derivative_at)(const void *constants, unsigned effects, const mct_real *x, mct_real sine,
                                  mct_real cosine, mct_real u, mct_real *dx);

/*
 * `angle` is the index of the coordinate whose sine and cosine the derivative wants. middle: those of the second stage,
 * half a step ahead at the rate of the start (out).
 */
MCT_INLINE void mct_rk4_by_middle(mct_derivative_at derivative, int angle, const void *constants,
                                  mct_step step, unsigned effects, int n, const mct_real *x, mct_real u,
                                  mct_real *dx, mct_real *middle)
{
    const int states = mct_entries(effects, n);
    mct_real k1[MCT_MAX_STATES], k2[MCT_MAX_STATES], k3[MCT_MAX_STATES], k4[MCT_MAX_STATES],
        stage[MCT_MAX_STATES];
    mct_real s0, c0, s, c;
    mct_sincos(x[angle], &s0, &c0);
    derivative(constants, effects, x, s0, c0, u, k1);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.half * k1[i];
    }
    mct_sincos_near(stage[angle], step.half * k1[angle], s0, c0, &s, &c);
    middle[0] = s;
    middle[1] = c;
    derivative(constants, effects, stage, s, c, u, k2);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.half * k2[i];
    }
    mct_sincos_near(stage[angle], step.half * k2[angle], s0, c0, &s, &c);
    derivative(constants, effects, stage, s, c, u, k3);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.h * k3[i];
    }
    mct_sincos_near(stage[angle], step.h * k3[angle], s0, c0, &s, &c);
    derivative(constants, effects, stage, s, c, u, k4);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        dx[i] = step.sixth * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
    }
}

MCT_INLINE void mct_rk4(mct_derivative_at derivative, int angle, const void *constants, mct_step step,
                        unsigned effects, int n, const mct_real *x, mct_real u, mct_real *dx)
{
    mct_real middle[2];
    mct_rk4_by_middle(derivative, angle, constants, step, effects, n, x, u, dx, middle);
}

#endif

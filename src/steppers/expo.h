/*
 * Exponential Nystroem method of order 4 (ERN4) for xdot = A x + B u + e g(x_0): the linear part, motor
 * included, is flowed exactly; the force g, one scalar, is sampled at the start, the middle and the end, and
 * its parabola integrated exactly. Hence no bound on h from the motor's L/R. Three sines a step. Constants
 * store the flow minus 1, which keeps float exact.
 * Source: of the family in Hochbruck, Ostermann, "Exponential integrators", Acta Numerica 2010; order and
 *   error are measured in tests.
 */
#ifndef MCT_STEPPERS_EXPO_H
#define MCT_STEPPERS_EXPO_H

#include "advance.h"
#include "mctau/expo.h"

/* The nonlinear force at a coordinate. */
typedef mct_real (*mct_expo_force)(const void *constants, mct_real position);

MCT_INLINE void mct_expo_increments(mct_expo_force force, const void *constants, const mct_expo *expo,
                                    unsigned effects, int n, const mct_real *x, mct_real u, mct_real *dx)
{
    const int states = 2 * n + ((effects & MCT_MOTOR_INDUCTIVE) ? 1 : 0);
    const mct_real *rates = x + n;
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        dx[i] = expo->input[i] * u;
        MCT_UNROLL
        for (int j = 0; j < states - n; j++) {
            dx[i] += expo->flow[i][j] * rates[j];
        }
    }
    if (!(effects & MCT_GRAVITY)) {
        return;
    }
    const mct_real start = force(constants, x[0]);
    mct_real to_middle = expo->half_input * u + expo->half_force * start;
    MCT_UNROLL
    for (int j = 0; j < states - n; j++) {
        to_middle += expo->half_flow[j] * rates[j];
    }
    const mct_real middle = force(constants, x[0] + to_middle);
    const mct_real end = force(constants, x[0] + (dx[0] + expo->force[0][0] * middle));
    const mct_real slope = 4 * middle - 3 * start - end;
    const mct_real curvature = 2 * (start - 2 * middle + end);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        dx[i] += expo->force[0][i] * start + (expo->force[1][i] * slope + expo->force[2][i] * curvature);
    }
}

#endif

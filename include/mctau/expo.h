/**
 * @file expo.h
 * Constants of the exponential stepper `expo` for a system whose only nonlinearity is one force on one
 * coordinate, a function of that coordinate: xdot = A x + B u + e g(x_0). The scheme is in
 * src/steppers/expo.h.
 */
#ifndef MCTAU_EXPO_H
#define MCTAU_EXPO_H

#include "mctau/real.h"
#include "mctau/status.h"
#include "mctau/system.h"

#define MCT_EXPO_RATES  (MCT_MAX_ENCODERS + 1)     /**< states that the flow depends on: rates and current */
#define MCT_EXPO_STATES (2 * MCT_MAX_ENCODERS + 1) /**< of a system with a motor */

typedef struct {
    mct_real flow[MCT_EXPO_STATES][MCT_EXPO_RATES]; /**< e^(A h) - 1, the columns of rates and current */
    mct_real input[MCT_EXPO_STATES];                /**< response to a unit input held over the step */
    mct_real force[3][MCT_EXPO_STATES];             /**< response to g = 1, s/h, (s/h)^2 along the step */
    mct_real half_flow[MCT_EXPO_RATES];             /**< the same over half a step, row of x_0 only */
    mct_real half_input;
    mct_real half_force;
} mct_expo;

/**
 * Computes the constants in double.
 * @param coordinates  n; nothing depends linearly on them
 * @param states       2 n, or 2 n + 1 with a current
 * @param A            states x states, row-major; B, e: states
 * @param h            step [s]
 * @return MCT_OK, or the status of mct_expm1 when A h is out of reach
 */
mct_status mct_expo_prepare(mct_expo *expo, int coordinates, int states, const double *A, const double *B,
                            const double *e, double h);

#endif

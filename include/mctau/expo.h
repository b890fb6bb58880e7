/**
 * @file expo.h
 * Constants of the exponential steppers `expo` and `expo8` for a system whose only nonlinearity is the sine
 * of one coordinate: xdot = A x + B u + e sin x_0. The scheme is in src/steppers/expo.h.
 */
#ifndef MCTAU_EXPO_H
#define MCTAU_EXPO_H

#include "mctau/real.h"
#include "mctau/status.h"
#include "mctau/system.h"

#define MCT_EXPO_RATES  (MCT_MAX_ENCODERS + 1)     /**< states that the flow depends on: rates and current */
#define MCT_EXPO_STATES (2 * MCT_MAX_ENCODERS + 1) /**< of a system with a motor */
#define MCT_EXPO_NODES  4 /**< at most: when the sine is sampled, but for the start */

/** Columns of a row of x_0: rates and current, then */
enum { MCT_EXPO_INPUT = MCT_EXPO_RATES, MCT_EXPO_CONSTANT, MCT_EXPO_COLUMNS };

/**
 * Over a step, less the start. `constant` is the response to a sine that keeps its value at the start,
 * `nodes` that to what it exceeds it by at each node.
 */
typedef struct {
    mct_real flow[MCT_EXPO_STATES][MCT_EXPO_RATES]; /**< e^(A h) - 1, the columns of rates and current */
    mct_real input[MCT_EXPO_STATES];                /**< response to a unit input held over the step */
    mct_real constant[MCT_EXPO_STATES];
    mct_real nodes[MCT_EXPO_STATES][MCT_EXPO_NODES];
    mct_real angle[MCT_EXPO_NODES][MCT_EXPO_COLUMNS]; /**< x_0 at each node */
    mct_real angle_nodes[MCT_EXPO_NODES][MCT_EXPO_NODES];
    mct_real angle_powers[MCT_EXPO_NODES][3]; /**< for a sine that grows as t, t^2 / 2, t^3 / 6 */
    mct_real mean[2][MCT_EXPO_COLUMNS]; /**< second and third derivative of x_0, as the nodes show them */
} mct_expo;

/**
 * Computes the constants in double.
 * @param nodes        2 for `expo`, 4 for `expo8`
 * @param coordinates  n; nothing depends linearly on them
 * @param states       2 n, or 2 n + 1 with a current
 * @param A            states x states, row-major; B, e: states
 * @param h            step [s]
 * @return MCT_OK, or the status of mct_expm1 when A h is out of reach
 */
mct_status mct_expo_prepare(mct_expo *expo, int nodes, int coordinates, int states, const double *A,
                            const double *B, const double *e, double h);

#endif

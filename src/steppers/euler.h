/*
 * Semi-implicit Euler: the velocity first, with damping and the motor's current taken implicitly, then the
 * position with the new velocity. `kick` is the system's piece: it writes the increments of velocity (and
 * current) at the old position.
 */
#ifndef MCT_STEPPERS_EULER_H
#define MCT_STEPPERS_EULER_H

#include "advance.h"

MCT_INLINE void mct_euler(mct_derivative kick, const void *constants, mct_step step, unsigned effects, int n,
                          const mct_real *x, mct_real u, mct_real *dx)
{
    kick(constants, effects, x, u, dx);
    MCT_UNROLL
    for (int i = 0; i < n; i++) {
        dx[i] = step.h * (x[n + i] + dx[n + i]);
    }
}

#endif

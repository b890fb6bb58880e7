/*
 * A kernel: increments of a stepper added to a compensated state, `steps` times under a held input.
 *
 * A stepper is a function that writes increments. Systems hand it their pieces (right-hand side, kicks) as
 * function arguments; everything is inlined with a literal effect mask, so a kernel is straight code.
 */
#ifndef MCT_STEPPERS_ADVANCE_H
#define MCT_STEPPERS_ADVANCE_H

#include "mctau/compensated.h"
#include "mctau/step.h"
#include "mctau/system.h"

/* Time derivative of the state, or increments over one step, from the state x under input u. */
typedef void (*mct_derivative)(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                               mct_real *dx);

/* No effects, but of a kernel's mask: */
#define MCT_TIMED (UINT32_C(1) << 31) /* the state carries the time */
#define MCT_ROTATION \
    (UINT32_C(1) << 30) /* the last three coordinates are a rotation, four entries of the state */

/* Entries of a state that a kernel carries: n coordinates, their rates, then current, phases or time. */
MCT_INLINE int mct_entries(unsigned effects, int n)
{
    return 2 * n + ((effects & MCT_MOTOR_INDUCTIVE) ? 1 : 0) + ((effects & MCT_CLOCK) ? MCT_PHASES : 0) +
           ((effects & MCT_TIMED) ? 1 : 0) + ((effects & MCT_ROTATION) ? 1 : 0);
}

/*
 * A phase has its increment in two parts, dx[i] and dx[i + MCT_PHASES], so that it does not drift.
 * `remainder` is what the rounding of the step's length leaves out of each increment, relative to it
 * (mct_step); 0 where the increments are exact.
 */
MCT_INLINE void mct_advance(mct_derivative increments, mct_derivative friction, const void *constants,
                            mct_real remainder, unsigned effects, int n, mct_state *state, mct_real input,
                            int32_t steps)
{
    const int states = mct_entries(effects, n);
    mct_real x[MCT_MAX_STATES];
    mct_real c[MCT_MAX_STATES];
    mct_real dx[MCT_MAX_STATES];
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        x[i] = state->x[i];
        c[i] = state->c[i];
    }
    for (int32_t k = 0; k < steps; k++) {
        increments(constants, effects, x, input, dx);
        if (effects & MCT_COULOMB_MOREAU) {
            friction(constants, effects, x, input, dx);
        }
        MCT_UNROLL
        for (int i = 0; i < states; i++) {
            if ((effects & MCT_CLOCK) && i >= 2 * n) {
                mct_add_parts(&x[i], &c[i], dx[i], dx[i + MCT_PHASES]);
                continue;
            }
#if MCT_REAL_IS_FLOAT
            c[i] += remainder * dx[i];
#endif
            if ((effects & MCT_COULOMB) && i >= n && i < 2 * n && dx[i] == -x[i]) {
                x[i] = 0; /* at rest exactly: nothing may creep */
                c[i] = 0;
            } else {
                mct_add_compensated(&x[i], &c[i], dx[i]);
            }
        }
    }
    (void)remainder;
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        state->x[i] = x[i];
        state->c[i] = c[i];
    }
}

#endif

/*
 * Dry (Coulomb) friction on one or two coordinates, exact: starts and stops are located within the step.
 *
 * Rule         A coordinate at rest stays there while the load, which is the sum of all other forces on it, does not
 *              exceed static friction; one that moves has dynamic friction against it, of constant size.
 * Phases       A step is cut where a velocity reaches 0 or a load exceeds static friction. In between the motion is
 *              smooth, so it has a series. What distinguishes phases is data, the mode: which coordinates are at rest and
 *              which way the others slide. So a system writes one series for all of them.
 * Modes        Of k coordinates at rest, the first of 3^k modes that agrees with itself: loads within static friction,
 *              accelerations along the directions; the most sticking first. If a single load is too large, its
 *              coordinate goes. As static friction is at least the dynamic one, there is such a mode.
 * Bounds       MCT_FRICTION_PHASES in a step, the last of which is not looked into for events; 9 modes a phase; in each
 *              of them at most two roots for a coordinate, by Newton's method kept within a bracket.
 * Accuracy     that of the series; an event is found to rounding. Also a drag by the square is smooth within a phase.
 * Source       the source document has no dry friction but in 8.2; the rule is Coulomb's, the procedure ours.
 *
 * Most steps have no event: that none can come is seen from the sizes of the terms. The rest is friction_exact.c.
 */
#ifndef MCT_STEPPERS_FRICTION_EXACT_H
#define MCT_STEPPERS_FRICTION_EXACT_H

#include "taylor.h"

#define MCT_FRICTION_PHASES 6

typedef struct {
    mct_real hold[MCT_MAX_ENCODERS]; /* static friction, at least the dynamic one */
    mct_real surface;                /* velocity at which friction sees rest: of a belt */
    mct_real rest;                   /* and how far off it is rounding */
} mct_dry;

typedef struct {
    int order;
    int coordinates;
    int rows;   /* coordinates, and perhaps a current */
    mct_real h; /* of the whole step */
    mct_dry dry;
    mct_slip slip;                       /* what phases are distinguished by: the mode */
    mct_real relative[MCT_MAX_ENCODERS]; /* velocities to the surface at the start */
    mct_series rates[MCT_MAX_ENCODERS + 1];
    mct_series loads[MCT_MAX_ENCODERS];
} mct_phase;

/*
 * Takes the mode to try next, when a phase disagrees with its own; `tried` counts, from 0. required: the directions that
 * are known, else 0. False for the one to take when no other agreed.
 */
bool mct_friction_next_mode(int *tried, mct_phase *phase, mct_real *required);

/*
 * Adds a phase's changes to dx, of a step from x, up to the first event or, without one and in the last phase, over what
 * is left of the step. Returns what is left then; gone: the direction in which a coordinate broke away, else 0.
 */
mct_real mct_friction_phase(const mct_phase *phase, bool is_last, const mct_real *x, mct_real *dx,
                            mct_real *gone);

MCT_INLINE mct_real mct_friction_size(mct_real value)
{
    return value < 0 ? -value : value;
}

/* Whether terms from `first` to `last` cannot add up to more than `margin`. */
static inline bool mct_friction_within(const mct_real *series, int first, int last, mct_real margin)
{
    mct_real sum = 0;
    for (int n = first; n <= last; n++) { /* the newest last */
        sum += mct_friction_size(series[n]);
    }
    return sum <= margin;
}

/* Whether nothing can happen to a coordinate in a step that the phase lasts. */
static inline bool mct_friction_is_quiet(const mct_phase *phase, int i)
{
    const mct_real *const rate = phase->rates[i], *const load = phase->loads[i];
    const mct_real direction = phase->slip.direction[i];
    if (direction == 0) {
        return mct_friction_within(load, 1, phase->order - 1,
                                   phase->dry.hold[i] - mct_friction_size(load[0]));
    }
    return phase->relative[i] == 0 /* it starts: its velocity is 0 now, but must not be again */
               ? mct_friction_within(rate, 2, phase->order, direction * rate[1])
               : mct_friction_within(rate, 1, phase->order, mct_friction_size(phase->relative[i]));
}

/* Increments of a step of h seconds; n coordinates. */
MCT_INLINE void mct_friction_exact(mct_series_of series, const void *constants, mct_dry dry, mct_real h,
                                   unsigned effects, int order, int n, const mct_real *x, mct_real u,
                                   mct_real *dx)
{
    const int rows = n + ((effects & MCT_MOTOR_INDUCTIVE) ? 1 : 0);
    const int entries = mct_entries(effects, n);
    mct_phase phase;
    mct_real gone[MCT_MAX_ENCODERS] = {0};
    phase.order = order;
    phase.coordinates = n;
    phase.rows = rows;
    phase.h = h;
    phase.dry = dry;
    phase.slip.passed = 0;
    MCT_UNROLL
    for (int i = 0; i < n + rows; i++) {
        dx[i] = 0;
    }
    for (int number = 1; number <= MCT_FRICTION_PHASES; number++) {
        mct_real now[MCT_MAX_STATES], required[MCT_MAX_ENCODERS];
        mct_real *const direction = phase.slip.direction;
        MCT_UNROLL
        for (int i = 0; i < entries; i++) {
            now[i] = i < n + rows ? x[i] + dx[i] : x[i]; /* a clock is the system's, by `passed` */
        }
        MCT_UNROLL
        for (int i = 0; i < n; i++) {
            mct_real relative = now[n + i] - dry.surface;
            if (mct_friction_size(relative) <= dry.rest) {
                relative = 0;
                now[n + i] = dry.surface;
                dx[n + i] = dry.surface - x[n + i];
            }
            required[i] = relative > 0 ? 1 : relative < 0 ? -1 : gone[i];
            direction[i] = required[i];
            phase.relative[i] = relative;
        }
        int tried = 0;
        for (bool is_open = true;;) {
            bool agrees = true;
            series(constants, effects, order, now, u, &phase.slip, phase.rates, phase.loads);
            MCT_UNROLL
            for (int i = 0; i < n; i++) {
                if (direction[i] == 0) {
                    agrees &= mct_friction_size(phase.loads[i][0]) <= dry.hold[i];
                } else if (required[i] == 0) {
                    agrees &= direction[i] * phase.rates[i][1] > 0;
                }
            }
            if (agrees || !is_open) {
                break;
            }
            is_open = mct_friction_next_mode(&tried, &phase, required);
        }
        bool is_quiet = phase.slip.passed == 0;
        MCT_UNROLL
        for (int i = 0; i < n; i++) {
            is_quiet &= mct_friction_is_quiet(&phase, i);
        }
        if (is_quiet) {
            MCT_UNROLL
            for (int i = 0; i < n; i++) {
                mct_real change;
                mct_series_increments(phase.rates[i], h, order, &dx[i], &change);
                dx[n + i] += change;
            }
            if (rows > n) {
                dx[2 * n] = mct_series_sum(phase.rates[n], order);
            }
            return;
        }
        const mct_real left = mct_friction_phase(&phase, number == MCT_FRICTION_PHASES, x, dx, gone);
        if (!(left > 0)) {
            return;
        }
        phase.slip.passed = 1 - left;
    }
}

/* Taylor's method, with dry friction where it is exact. */
MCT_INLINE void mct_taylor_dry(mct_series_of series, const void *constants, mct_dry dry, mct_real h,
                               unsigned effects, int order, int n, const mct_real *x, mct_real u,
                               mct_real *dx)
{
    if (effects & MCT_COULOMB_EXACT) {
        mct_friction_exact(series, constants, dry, h, effects, order, n, x, u, dx);
    } else {
        mct_taylor(series, constants, h, effects, order, n, x, u, dx);
    }
}

#endif

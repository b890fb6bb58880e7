/*
 * Taylor's method: the derivatives of the motion up to an order, by recurrences, with one sine and cosine a step.
 *
 * Term n of a series is its quantity's nth derivative times h^n/n!, so that an increment is the sum of all terms but
 * the first. A system writes the series of its rates, term by term, with the functions below; a coordinate, which is a
 * derivative ahead of its rate, gets one term more. The first order, with that term, is the source's scheme (`seed`).
 *
 * The order of a kernel is a literal: loops unroll, and terms stay in registers. A step is one chain of operations, each
 * waiting for the one before, so what depends on the newest terms comes last in a sum, with its factors multiplied
 * beforehand.
 * Source: the recurrences are Steffensen's; Hairer, Norsett, Wanner, Solving ODEs I, I.8.
 */
#ifndef MCT_STEPPERS_TAYLOR_H
#define MCT_STEPPERS_TAYLOR_H

#include "advance.h"

#define MCT_TAYLOR_TERMS 13 /* of order 12, the highest of this stepper */
#define MCT_SERIES_TERMS 18 /* of order 17, the block's */

/* The sum of nothing. Not +0, which changes -0: compilers keep that addition, and a series waits for it. */
#define MCT_NOTHING MCT_R(-0.0)

typedef mct_real mct_series[MCT_SERIES_TERMS];

/* 1 / (n + 1): times h, it takes term n of a rate to term n + 1 of what has that rate. */
MCT_INLINE mct_real mct_series_share(int n)
{
    static const mct_real shares[MCT_SERIES_TERMS] = {
        1,
        MCT_R(1.0 / 2),
        MCT_R(1.0 / 3),
        MCT_R(1.0 / 4),
        MCT_R(1.0 / 5),
        MCT_R(1.0 / 6),
        MCT_R(1.0 / 7),
        MCT_R(1.0 / 8),
        MCT_R(1.0 / 9),
        MCT_R(1.0 / 10),
        MCT_R(1.0 / 11),
        MCT_R(1.0 / 12),
        MCT_R(1.0 / 13),
        MCT_R(1.0 / 14),
        MCT_R(1.0 / 15),
        MCT_R(1.0 / 16),
        MCT_R(1.0 / 17),
        MCT_R(1.0 / 18),
    };
    return shares[n];
}

/* Term n of a b. In all of these what is known first comes first, so that no sum waits for the latest term. */
MCT_INLINE mct_real mct_series_product(const mct_real *a, const mct_real *b, int n)
{
    mct_real sum = MCT_NOTHING;
    MCT_UNROLL
    for (int j = n - 1; j > 0; j--) {
        sum += a[j] * b[n - j];
    }
    if (n > 0) {
        sum += a[n] * b[0];
    }
    return sum + a[0] * b[n];
}

/* Terms n of a b and a c. */
MCT_INLINE void mct_series_products(const mct_real *a, const mct_real *b, const mct_real *c, int n,
                                    mct_real *ab, mct_real *ac)
{
    mct_real first = MCT_NOTHING, second = MCT_NOTHING;
    MCT_UNROLL
    for (int j = n - 1; j > 0; j--) {
        first += a[j] * b[n - j];
        second += a[j] * c[n - j];
    }
    if (n > 0) {
        first += a[n] * b[0];
        second += a[n] * c[0];
    }
    *ab = first + a[0] * b[n];
    *ac = second + a[0] * c[n];
}

/* Term n + 1 of sine and cosine of an angle, from their terms and those of its rate up to n. */
MCT_INLINE void mct_series_sincos(const mct_real *rate, mct_real h, int n, mct_real *s, mct_real *c)
{
    const mct_real share = h * mct_series_share(n);
    mct_real up = MCT_NOTHING, down = MCT_NOTHING;
    MCT_UNROLL
    for (int j = 1; j < n; j++) {
        up += rate[j] * c[n - j];
        down += rate[j] * s[n - j];
    }
    if (n > 0) {
        up = share * up + (share * c[0]) * rate[n];
        down = share * down + (share * s[0]) * rate[n];
    }
    s[n + 1] = up + (share * rate[0]) * c[n];
    c[n + 1] = -down - (share * rate[0]) * s[n];
}

/* Increment of what has the series: from the smallest term up, the two newest by themselves. */
MCT_INLINE mct_real mct_series_sum(const mct_real *series, int order)
{
    mct_real sum = MCT_NOTHING;
    MCT_UNROLL
    for (int n = order - 2; n > 0; n--) {
        sum += series[n];
    }
    return sum + (series[order] + series[order - 1]);
}

/* Increments of a coordinate and of its rate, which has the series. */
MCT_INLINE void mct_series_increments(const mct_real *rate, mct_real h, int order, mct_real *coordinate,
                                      mct_real *of_rate)
{
    mct_real way = MCT_NOTHING;
    MCT_UNROLL
    for (int n = order - 2; n > 0; n--) {
        way += mct_series_share(n) * rate[n];
    }
    const mct_real newest =
        mct_series_share(order) * rate[order] + mct_series_share(order - 1) * rate[order - 1];
    *coordinate = h * ((rate[0] + way) + newest);
    *of_rate = mct_series_sum(rate, order);
}

/* Which coordinates stick and slip, where dry friction is exact: friction_exact.h. */
typedef struct {
    mct_real direction[MCT_MAX_ENCODERS]; /* in which a coordinate slides, +-1; 0 at rest */
    mct_real passed;                      /* of the step, before: a fraction */
} mct_slip;

/*
 * A system whose states are n coordinates, their rates and perhaps a current has one function that writes the series of
 * rates and current. It makes the increments of a step and, at the highest order, the motion within one. With exact dry
 * friction it also writes the loads of what is at rest, of one order less; else slip and loads are NULL.
 */
typedef void (*mct_series_of)(const void *constants, unsigned effects, int order, const mct_real *x,
                              mct_real u, const mct_slip *slip, mct_series *rates, mct_series *loads);

MCT_INLINE void mct_taylor(mct_series_of series, const void *constants, mct_real h, unsigned effects,
                           int order, int n, const mct_real *x, mct_real u, mct_real *dx)
{
    mct_series rates[MCT_MAX_ENCODERS + 1];
    series(constants, effects, order, x, u, NULL, rates, NULL);
    MCT_UNROLL
    for (int i = 0; i < n; i++) {
        mct_series_increments(rates[i], h, order, &dx[i], &dx[n + i]);
    }
    if (effects & MCT_MOTOR_INDUCTIVE) {
        dx[2 * n] = mct_series_sum(rates[n], order);
    }
}

MCT_INLINE void mct_taylor_motion(mct_series_of series, const void *constants, mct_step step,
                                  unsigned effects, int n, const mct_state *state, mct_real u,
                                  mct_motion *motion)
{
    enum { ORDER = MCT_TAYLOR_TERMS - 1 };
    mct_series rates[MCT_MAX_ENCODERS + 1] = {
        {0}}; /* compilers do not see that all that is read is written */
    series(constants, effects, ORDER, state->x, u, NULL, rates, NULL);
    for (int i = 0; i < n; i++) {
        for (int k = 0; k <= ORDER; k++) {
            motion->term[k][i] = step.h * mct_series_share(k) * rates[i][k];
        }
    }
    for (int i = n; i < mct_entries(effects, n); i++) {
        for (int k = 0; k < ORDER; k++) {
            motion->term[k][i] = rates[i - n][k + 1];
        }
        motion->term[ORDER][i] = 0;
    }
    motion->remainder = step.remainder;
}

#endif

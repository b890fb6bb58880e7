/*
 * Motions in quadruple precision (long double where the compiler has none: 18 digits), for tests that write a
 * right-hand side of their own: Gragg's midpoint rule with Bulirsch-Stoer extrapolation, order 18, explicit.
 */
#ifndef MCT_TEST_QUAD_H
#define MCT_TEST_QUAD_H

#include <string.h>

#if defined __SIZEOF_FLOAT128__ && !defined __clang__
#include <quadmath.h>
typedef __float128 quad;
#define quad_sin  sinq
#define quad_cos  cosq
#define quad_sqrt sqrtq
#define quad_abs  fabsq
#else
#include <math.h>
typedef long double quad;
#define quad_sin  sinl
#define quad_cos  cosl
#define quad_sqrt sqrtl
#define quad_abs  fabsl
#endif

enum { QUAD_COLUMNS = 9, QUAD_MAX_STATES = 16 };

/* Time derivative of x. */
typedef void (*quad_rate)(const void *model, quad time, const quad *x, quad *dx);

static inline void quad_midpoint(quad_rate rate, const void *model, quad time, const quad *x,
                                 const quad *first, int states, quad H, int n, quad *end)
{
    const quad h = H / n;
    quad before[QUAD_MAX_STATES];
    quad slope[QUAD_MAX_STATES];
    for (int i = 0; i < states; i++) {
        before[i] = x[i];
        end[i] = x[i] + h * first[i];
    }
    for (int k = 1; k < n; k++) {
        rate(model, time + k * h, end, slope);
        for (int i = 0; i < states; i++) {
            const quad next = before[i] + 2 * h * slope[i];
            before[i] = end[i];
            end[i] = next;
        }
    }
}

/* Advances x by equal steps of extrapolation. Halve the steps to see how exact the result is. */
static inline void quad_extrapolate(quad_rate rate, const void *model, quad time, quad *x, int states,
                                    quad duration, long steps)
{
    const quad H = duration / steps;
    for (long step = 0; step < steps; step++) {
        quad table[QUAD_COLUMNS][QUAD_MAX_STATES];
        quad first[QUAD_MAX_STATES];
        const quad now = time + step * H;
        rate(model, now, x, first);
        for (int row = 0; row < QUAD_COLUMNS; row++) {
            const int n = 2 * (row + 1);
            quad_midpoint(rate, model, now, x, first, states, H, n, table[row]);
            for (int k = row - 1; k >= 0; k--) { /* table[k] becomes the value of the next column */
                const quad ratio = (quad)(n * n) / (quad)(4 * (k + 1) * (k + 1));
                for (int i = 0; i < states; i++) {
                    table[k][i] = table[k + 1][i] + (table[k + 1][i] - table[k][i]) / (ratio - 1);
                }
            }
        }
        memcpy(x, table[0], sizeof(quad) * (size_t)states);
    }
}

#endif

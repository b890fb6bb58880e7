/*
 * Kernels as one would write them for a mechanism that has no effects at all: no gravity, no friction, no
 * motor. Written from the equations, with no mask anywhere. test_kernels.py holds the library's kernels of
 * mask 0 against them.
 * Only what every kernel has is shared: constants, sine and cosine, compensated sums.
 */
#include "mctau/cart_pole.h"
#include "mctau/compensated.h"
#include "mctau/reaction_wheel.h"
#include "mctau/sincos.h"
#include "mctau/system.h"

void plain_rk4(const void *constants, mct_state *state, mct_real force, int32_t steps);
void plain_leap(const void *constants, mct_state *state, mct_real force, int32_t steps);
void plain_expo(const void *constants, mct_state *state, mct_real torque, int32_t steps);

/* The state plus increments, with what rounding and the step's length have left out. */
MCT_INLINE void add(mct_real remainder, const mct_real *dx, mct_real *x, mct_real *c)
{
    (void)remainder;
    MCT_UNROLL
    for (int i = 0; i < 4; i++) {
#if MCT_REAL_IS_FLOAT
        c[i] += remainder * dx[i];
#endif
        mct_add_compensated(&x[i], &c[i], dx[i]);
    }
}

MCT_INLINE void load(const mct_state *state, mct_real *x, mct_real *c)
{
    MCT_UNROLL
    for (int i = 0; i < 4; i++) {
        x[i] = state->x[i];
        c[i] = state->c[i];
    }
}

MCT_INLINE void store(const mct_real *x, const mct_real *c, mct_state *state)
{
    MCT_UNROLL
    for (int i = 0; i < 4; i++) {
        state->x[i] = x[i];
        state->c[i] = c[i];
    }
}

/* (m1 + m2 sin^2) a = f + m2 l sin thd^2,  l alpha = -a cos */
MCT_INLINE void cart_pole(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                          mct_real force, mct_real *dx)
{
    const mct_real f = force + k->moment * s * x[3] * x[3];
    const mct_real inverse = 1 / (k->cart_mass + k->pole_mass * s * s);
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = inverse * f;
    dx[3] = -inverse * (c * k->inverse_length * f);
}

void plain_rk4(const void *constants, mct_state *state, mct_real force, int32_t steps)
{
    const mct_cart_pole_constants *k = constants;
    const mct_step step = k->step;
    mct_real x[4], c[4], k1[4], k2[4], k3[4], k4[4], stage[4], dx[4];
    load(state, x, c);
    for (int32_t n = 0; n < steps; n++) {
        mct_real s0, c0, sine, cosine;
        mct_sincos(x[1], &s0, &c0);
        cart_pole(k, x, s0, c0, force, k1);
        MCT_UNROLL
        for (int i = 0; i < 4; i++) {
            stage[i] = x[i] + step.half * k1[i];
        }
        mct_sincos_near(stage[1], step.half * k1[1], s0, c0, &sine, &cosine);
        cart_pole(k, stage, sine, cosine, force, k2);
        MCT_UNROLL
        for (int i = 0; i < 4; i++) {
            stage[i] = x[i] + step.half * k2[i];
        }
        mct_sincos_near(stage[1], step.half * k2[1], s0, c0, &sine, &cosine);
        cart_pole(k, stage, sine, cosine, force, k3);
        MCT_UNROLL
        for (int i = 0; i < 4; i++) {
            stage[i] = x[i] + step.h * k3[i];
        }
        mct_sincos_near(stage[1], step.h * k3[1], s0, c0, &sine, &cosine);
        cart_pole(k, stage, sine, cosine, force, k4);
        MCT_UNROLL
        for (int i = 0; i < 4; i++) {
            dx[i] = step.sixth * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
        }
        add(step.sixth_remainder, dx, x, c);
    }
    store(x, c, state);
}

/* At the middle: [m1 + m2, m2 l cos - h m2 l sin thd; m2 l cos, m2 l^2] dv = h (f + m2 l sin thd^2, 0) */
void plain_leap(const void *constants, mct_state *state, mct_real force, int32_t steps)
{
    const mct_cart_pole_constants *k = constants;
    const mct_step step = k->step;
    mct_real x[4], compensation[4], dx[4];
    load(state, x, compensation);
    for (int32_t n = 0; n < steps; n++) {
        mct_real s, c;
        mct_sincos(x[1] + step.half * x[3], &s, &c);
        const mct_real centrifugal = k->moment * s * x[3];
        const mct_real impulse = step.h * (force + centrifugal * x[3]);
        const mct_real m12 = k->moment * c;
        const mct_real det = k->inertia * (k->cart_mass + k->pole_mass * s * s) + step.h * centrifugal * m12;
        const mct_real inverse = 1 / det;
        dx[2] = inverse * (k->inertia * impulse);
        dx[3] = -inverse * (m12 * impulse);
        dx[0] = step.h * x[2] + step.half * dx[2];
        dx[1] = step.h * x[3] + step.half * dx[3];
        add(step.remainder, dx, x, compensation);
    }
    store(x, compensation, state);
}

/* Without gravity the system is linear: x += (e^Ah - 1) x + ... u */
void plain_expo(const void *constants, mct_state *state, mct_real torque, int32_t steps)
{
    const mct_reaction_wheel_constants *k = constants;
    mct_real x[4], c[4], dx[4];
    load(state, x, c);
    for (int32_t n = 0; n < steps; n++) {
        MCT_UNROLL
        for (int i = 0; i < 4; i++) {
            dx[i] = k->expo.input[i] * torque + k->expo.flow[i][0] * x[2] + k->expo.flow[i][1] * x[3];
        }
        add(0, dx, x, c);
    }
    store(x, c, state);
}

/*
 * Kernels as one would write them for a mechanism that has some effects and never any others. Written from the
 * equations, with no mask anywhere. test_kernels.py holds the library's kernels for the same effects against them:
 * plain_cart_pole_rk4_13 is rk4 with an inductive motor (0x10), gravity and viscous friction (0x3). All effects but one,
 * for each: 17 without drag, 47 without a motor, 53 without dry friction, 55 without viscous friction, 56 without gravity,
 * and 4f with a motor without inductance; and the same without drag, which expo has not.
 * Only what every kernel has is shared: constants, sine and cosine, compensated sums, and the clamp of dry friction.
 *
 * The program runs both from the same start, for measure.h, and fails where they do not move alike.
 */
#include <stdio.h>

#include "mctau/cart_pole.h"
#include "mctau/compensated.h"
#include "mctau/plant.h"
#include "mctau/reaction_wheel.h"
#include "mctau/sincos.h"
#include "mctau/system.h"
#include "src/effects/friction.h"
#include "src/steppers/expo.h"
#include "src/systems/systems.h"
#include "tools/benchmark/measure.h"

/* The kernels, as KERNEL(system, name, STEPPER, effects in hexadecimal). */
#define KERNELS                            \
    KERNEL(cart_pole, rk4, RK4, 0)         \
    KERNEL(cart_pole, rk4, RK4, 3)         \
    KERNEL(cart_pole, rk4, RK4, 13)        \
    KERNEL(cart_pole, rk4, RK4, 7)         \
    KERNEL(cart_pole, rk4, RK4, f)         \
    KERNEL(cart_pole, rk4, RK4, 15)        \
    KERNEL(cart_pole, rk4, RK4, 16)        \
    KERNEL(cart_pole, rk4, RK4, 17)        \
    KERNEL(cart_pole, rk4, RK4, 47)        \
    KERNEL(cart_pole, rk4, RK4, 4f)        \
    KERNEL(cart_pole, rk4, RK4, 53)        \
    KERNEL(cart_pole, rk4, RK4, 55)        \
    KERNEL(cart_pole, rk4, RK4, 56)        \
    KERNEL(cart_pole, leap, LEAP, 0)       \
    KERNEL(reaction_wheel, rk4, RK4, 7)    \
    KERNEL(reaction_wheel, rk4, RK4, f)    \
    KERNEL(reaction_wheel, rk4, RK4, 13)   \
    KERNEL(reaction_wheel, rk4, RK4, 15)   \
    KERNEL(reaction_wheel, rk4, RK4, 16)   \
    KERNEL(reaction_wheel, rk4, RK4, 17)   \
    KERNEL(reaction_wheel, rk4, RK4, 47)   \
    KERNEL(reaction_wheel, rk4, RK4, 4f)   \
    KERNEL(reaction_wheel, rk4, RK4, 53)   \
    KERNEL(reaction_wheel, rk4, RK4, 55)   \
    KERNEL(reaction_wheel, rk4, RK4, 56)   \
    KERNEL(reaction_wheel, expo, EXPO, 0)  \
    KERNEL(reaction_wheel, expo, EXPO, 7)  \
    KERNEL(reaction_wheel, expo, EXPO, f)  \
    KERNEL(reaction_wheel, expo, EXPO, 13) \
    KERNEL(reaction_wheel, expo, EXPO, 15) \
    KERNEL(reaction_wheel, expo, EXPO, 16) \
    KERNEL(reaction_wheel, expo, EXPO, 17)

#define KERNEL(system, name, STEPPER, effects)                                                    \
    void plain_##system##_##name##_##effects(const void *constants, mct_state *state, mct_real u, \
                                             int32_t steps);
KERNELS
#undef KERNEL

/* The state plus increments, with what rounding and the step's length have left out. */
MCT_INLINE void add(int states, mct_real remainder, const mct_real *dx, mct_real *x, mct_real *c)
{
    (void)remainder;
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
#if MCT_REAL_IS_FLOAT
        c[i] += remainder * dx[i];
#endif
        mct_add_compensated(&x[i], &c[i], dx[i]);
    }
}

/* The same for four positions and rates, of which friction may have brought a rate to rest. */
MCT_INLINE void add_resting(int states, mct_real remainder, const mct_real *dx, mct_real *x, mct_real *c)
{
    (void)remainder;
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
#if MCT_REAL_IS_FLOAT
        c[i] += remainder * dx[i];
#endif
        if ((i == 2 || i == 3) && dx[i] == -x[i]) {
            x[i] = 0;
            c[i] = 0;
        } else {
            mct_add_compensated(&x[i], &c[i], dx[i]);
        }
    }
}

MCT_INLINE void load(int states, const mct_state *state, mct_real *x, mct_real *c)
{
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        x[i] = state->x[i];
        c[i] = state->c[i];
    }
}

MCT_INLINE void store(int states, const mct_real *x, const mct_real *c, mct_state *state)
{
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        state->x[i] = x[i];
        state->c[i] = c[i];
    }
}

/* --- cart-pole: x = (p, th, pd, thd, and with a motor i); s, c: sine and cosine of th --- */

typedef void (*cart_pole_rates)(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                                mct_real input, mct_real *dx);

/* (m1 + m2 sin^2) a = f + m2 l sin thd^2,  l alpha = -a cos */
MCT_INLINE void alone(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                      mct_real force, mct_real *dx)
{
    const mct_real f = force + k->moment * s * x[3] * x[3];
    const mct_real inverse = 1 / (k->cart_mass + k->pole_mass * s * s);
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = inverse * f;
    dx[3] = -inverse * (c * k->inverse_length * f);
}

/*
 * f1 = f - k1 pd + m2 l sin thd^2,  f2 = m2 g l sin - k2 thd;
 * (m1 + m2 sin^2) a = f1 - cos/l f2,  (m1 + m2 sin^2) alpha = (m1 + m2) / (m2 l^2) f2 - cos/l f1
 */
MCT_INLINE void damped(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                       mct_real force, mct_real *dx)
{
    const mct_real f1 = force - k->cart_viscous * x[2] + k->moment * s * x[3] * x[3];
    const mct_real f2 = k->weight_moment * s - k->pole_viscous * x[3];
    const mct_real inverse = 1 / (k->cart_mass + k->pole_mass * s * s);
    const mct_real c_by_l = c * k->inverse_length;
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = inverse * (f1 - c_by_l * f2);
    dx[3] = inverse * (k->mass_per_inertia * f2 - c_by_l * f1);
}

/* The same from f1 and f2. */
MCT_INLINE void accelerated(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                            mct_real f1, mct_real f2, mct_real *dx)
{
    const mct_real inverse = 1 / (k->cart_mass + k->pole_mass * s * s);
    const mct_real c_by_l = c * k->inverse_length;
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = inverse * (f1 - c_by_l * f2);
    dx[3] = inverse * (k->mass_per_inertia * f2 - c_by_l * f1);
}

/* L di/dt = V - R i - k_b pd, f = k_T i */
MCT_INLINE void current_rate(const mct_cart_pole_constants *k, const mct_real *x, mct_real voltage,
                             mct_real *dx)
{
    dx[4] = k->motor.inverse_inductance * (voltage - k->motor.resistance * x[4] - k->motor.emf * x[2]);
}

MCT_INLINE void driven(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                       mct_real voltage, mct_real *dx)
{
    damped(k, x, s, c, k->motor.force_per_ampere * x[4], dx);
    current_rate(k, x, voltage, dx);
}

/* Without inductance: f = k_T / R (V - k_b pd), whose last term is a damping of the cart. */
MCT_INLINE void driven_at_once(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                               mct_real voltage, mct_real *dx)
{
    accelerated(k, x, s, c,
                k->motor.force_per_volt * voltage + k->moment * s * x[3] * x[3] - k->cart_damping * x[2],
                k->weight_moment * s - k->pole_viscous * x[3], dx);
}

/* Without viscous friction, */
MCT_INLINE void driven_smoothly(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                                mct_real voltage, mct_real *dx)
{
    accelerated(k, x, s, c, k->motor.force_per_ampere * x[4] + k->moment * s * x[3] * x[3],
                k->weight_moment * s, dx);
    current_rate(k, x, voltage, dx);
}

/* and without weight. */
MCT_INLINE void driven_level(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                             mct_real voltage, mct_real *dx)
{
    accelerated(k, x, s, c,
                k->motor.force_per_ampere * x[4] + k->moment * s * x[3] * x[3] - k->cart_viscous * x[2],
                -(k->pole_viscous * x[3]), dx);
    current_rate(k, x, voltage, dx);
}

MCT_INLINE mct_real drag(mct_real coefficient, mct_real rate)
{
    return coefficient * (rate < 0 ? -rate : rate) * rate;
}

/* The same with drag, c v |v| against each rate. */
MCT_INLINE void dragged(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                        mct_real force, mct_real *dx)
{
    accelerated(k, x, s, c,
                force + k->moment * s * x[3] * x[3] - k->cart_viscous * x[2] - drag(k->drag[0], x[2]),
                k->weight_moment * s - k->pole_viscous * x[3] - drag(k->drag[1], x[3]), dx);
}

MCT_INLINE void dragged_driven(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                               mct_real voltage, mct_real *dx)
{
    dragged(k, x, s, c, k->motor.force_per_ampere * x[4], dx);
    current_rate(k, x, voltage, dx);
}

MCT_INLINE void dragged_at_once(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                                mct_real voltage, mct_real *dx)
{
    accelerated(k, x, s, c,
                k->motor.force_per_volt * voltage + k->moment * s * x[3] * x[3] - k->cart_damping * x[2] -
                    drag(k->drag[0], x[2]),
                k->weight_moment * s - k->pole_viscous * x[3] - drag(k->drag[1], x[3]), dx);
}

MCT_INLINE void dragged_alone(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                              mct_real voltage, mct_real *dx)
{
    accelerated(k, x, s, c,
                k->motor.force_per_ampere * x[4] + k->moment * s * x[3] * x[3] - drag(k->drag[0], x[2]),
                k->weight_moment * s - drag(k->drag[1], x[3]), dx);
    current_rate(k, x, voltage, dx);
}

MCT_INLINE void dragged_level(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                              mct_real voltage, mct_real *dx)
{
    accelerated(k, x, s, c,
                k->motor.force_per_ampere * x[4] + k->moment * s * x[3] * x[3] - k->cart_viscous * x[2] -
                    drag(k->drag[0], x[2]),
                -(k->pole_viscous * x[3]) - drag(k->drag[1], x[3]), dx);
    current_rate(k, x, voltage, dx);
}

/* The increments of one step; middle: sine and cosine half a step ahead, at the rate of the start. */
MCT_INLINE void rk4_step(cart_pole_rates rates, int states, const mct_cart_pole_constants *k,
                         const mct_real *x, mct_real input, mct_real *dx, mct_real *middle)
{
    const mct_step step = k->step;
    mct_real k1[5], k2[5], k3[5], k4[5], stage[5], s0, c0, sine, cosine;
    mct_sincos(x[1], &s0, &c0);
    rates(k, x, s0, c0, input, k1);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.half * k1[i];
    }
    mct_sincos_near(stage[1], step.half * k1[1], s0, c0, &sine, &cosine);
    middle[0] = sine;
    middle[1] = cosine;
    rates(k, stage, sine, cosine, input, k2);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.half * k2[i];
    }
    mct_sincos_near(stage[1], step.half * k2[1], s0, c0, &sine, &cosine);
    rates(k, stage, sine, cosine, input, k3);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.h * k3[i];
    }
    mct_sincos_near(stage[1], step.h * k3[1], s0, c0, &sine, &cosine);
    rates(k, stage, sine, cosine, input, k4);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        dx[i] = step.sixth * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
    }
}

MCT_INLINE void rk4(cart_pole_rates rates, int states, const mct_cart_pole_constants *k, mct_state *state,
                    mct_real input, int32_t steps)
{
    mct_real x[5], c[5], dx[5], middle[2];
    load(states, state, x, c);
    for (int32_t n = 0; n < steps; n++) {
        rk4_step(rates, states, k, x, input, dx, middle);
        add(states, k->step.sixth_remainder, dx, x, c);
    }
    store(states, x, c, state);
}

/* With dry friction: the impulse that it has at the middle of the step, by M where the pole then is. */
MCT_INLINE void cart_pole_friction(const mct_cart_pole_constants *k, mct_real s, mct_real c,
                                   const mct_real *x, mct_real *dx)
{
    const mct_real inverse = 1 / (k->cart_mass + k->pole_mass * s * s);
    const mct_inertia2 inertia = {{k->total_mass, k->moment * c, k->inertia},
                                  {inverse, -inverse * c * k->inverse_length, inverse * k->mass_per_inertia}};
    mct_friction_correct(inertia, k->coulomb, k->hold, k->step.h, x + 2, dx);
}

MCT_INLINE void rk4_dry(cart_pole_rates rates, int states, const mct_cart_pole_constants *k, mct_state *state,
                        mct_real input, int32_t steps)
{
    mct_real x[5], c[5], dx[5], middle[2];
    load(states, state, x, c);
    for (int32_t n = 0; n < steps; n++) {
        rk4_step(rates, states, k, x, input, dx, middle);
        cart_pole_friction(k, middle[0], middle[1], x, dx);
        add_resting(states, k->step.sixth_remainder, dx, x, c);
    }
    store(states, x, c, state);
}

#define CART_POLE(effects, states, step, rates)                                                            \
    void plain_cart_pole_rk4_##effects(const void *constants, mct_state *state, mct_real u, int32_t steps) \
    {                                                                                                      \
        step(rates, states, constants, state, u, steps);                                                   \
    }
CART_POLE(0, 4, rk4, alone)
CART_POLE(3, 4, rk4, damped)
CART_POLE(13, 5, rk4, driven)
CART_POLE(7, 4, rk4_dry, damped)
CART_POLE(f, 4, rk4_dry, driven_at_once)
CART_POLE(15, 5, rk4_dry, driven_smoothly)
CART_POLE(16, 5, rk4_dry, driven_level)
CART_POLE(17, 5, rk4_dry, driven)
CART_POLE(47, 4, rk4_dry, dragged)
CART_POLE(4f, 4, rk4_dry, dragged_at_once)
CART_POLE(53, 5, rk4, dragged_driven)
CART_POLE(55, 5, rk4_dry, dragged_alone)
CART_POLE(56, 5, rk4_dry, dragged_level)

/* At the middle: [m1 + m2, m2 l cos - h m2 l sin thd; m2 l cos, m2 l^2] dv = h (f + m2 l sin thd^2, 0) */
void plain_cart_pole_leap_0(const void *constants, mct_state *state, mct_real force, int32_t steps)
{
    const mct_cart_pole_constants *k = constants;
    const mct_step step = k->step;
    mct_real x[4], compensation[4], dx[4];
    load(4, state, x, compensation);
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
        add(4, step.remainder, dx, x, compensation);
    }
    store(4, x, compensation, state);
}

/* --- reaction wheel: x = (th1, th2, th1d, th2d, and with a motor i), linear but for sin th1 --- */

/* Without gravity: x += (e^Ah - 1) x + ... u */
void plain_reaction_wheel_expo_0(const void *constants, mct_state *state, mct_real torque, int32_t steps)
{
    const mct_reaction_wheel_constants *k = constants;
    mct_real x[4], c[4], dx[4];
    load(4, state, x, c);
    for (int32_t n = 0; n < steps; n++) {
        MCT_UNROLL
        for (int i = 0; i < 4; i++) {
            dx[i] = k->expo.input[i] * torque + k->expo.flow[i][0] * x[2] + k->expo.flow[i][1] * x[3];
        }
        add(4, 0, dx, x, c);
    }
    store(4, x, c, state);
}

typedef void (*wheel_rates)(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real s, mct_real u,
                            mct_real *dx);

/* J alpha1 = tau1 - tau2,  I_w alpha2 = tau2 - I_w alpha1 */
MCT_INLINE void turned(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real tau1, mct_real tau2,
                       mct_real *dx)
{
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = (tau1 - tau2) * k->inverse_arm;
    dx[3] = tau2 * k->inverse_wheel - dx[2];
}

MCT_INLINE void wheel_current_rate(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real voltage,
                                   mct_real *dx)
{
    dx[4] = (voltage - k->motor.resistance * x[4] - k->motor.emf * x[3]) * k->motor.inverse_inductance;
}

/* tau1 = P sin - nu1 w1,  tau2 = torque - nu2 w2 */
MCT_INLINE void wheel_damped(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real s,
                             mct_real torque, mct_real *dx)
{
    turned(k, x, k->weight_moment * s - k->arm_viscous * x[2], torque - k->wheel_viscous * x[3], dx);
}

/* By a motor: tau2 = k_T i - nu2 w2. */
MCT_INLINE void wheel_driven(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real s,
                             mct_real voltage, mct_real *dx)
{
    wheel_damped(k, x, s, k->motor.force_per_ampere * x[4], dx);
    wheel_current_rate(k, x, voltage, dx);
}

/* Without inductance, */
MCT_INLINE void wheel_driven_at_once(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real s,
                                     mct_real voltage, mct_real *dx)
{
    turned(k, x, k->weight_moment * s - k->arm_viscous * x[2],
           k->motor.force_per_volt * voltage - k->wheel_damping * x[3], dx);
}

/* without viscous friction, */
MCT_INLINE void wheel_driven_smoothly(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real s,
                                      mct_real voltage, mct_real *dx)
{
    turned(k, x, k->weight_moment * s, k->motor.force_per_ampere * x[4], dx);
    wheel_current_rate(k, x, voltage, dx);
}

/* and without weight, which needs no sine. */
MCT_INLINE void wheel_driven_level(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real s,
                                   mct_real voltage, mct_real *dx)
{
    (void)s;
    turned(k, x, -(k->arm_viscous * x[2]), k->motor.force_per_ampere * x[4] - k->wheel_viscous * x[3], dx);
    wheel_current_rate(k, x, voltage, dx);
}

/* The same with drag, c v |v| against each rate. */
MCT_INLINE void wheel_dragged(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real s,
                              mct_real torque, mct_real *dx)
{
    turned(k, x, k->weight_moment * s - k->arm_viscous * x[2] - drag(k->drag[0], x[2]),
           torque - k->wheel_viscous * x[3] - drag(k->drag[1], x[3]), dx);
}

MCT_INLINE void wheel_dragged_driven(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real s,
                                     mct_real voltage, mct_real *dx)
{
    wheel_dragged(k, x, s, k->motor.force_per_ampere * x[4], dx);
    wheel_current_rate(k, x, voltage, dx);
}

MCT_INLINE void wheel_dragged_at_once(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real s,
                                      mct_real voltage, mct_real *dx)
{
    turned(k, x, k->weight_moment * s - k->arm_viscous * x[2] - drag(k->drag[0], x[2]),
           k->motor.force_per_volt * voltage - k->wheel_damping * x[3] - drag(k->drag[1], x[3]), dx);
}

MCT_INLINE void wheel_dragged_alone(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real s,
                                    mct_real voltage, mct_real *dx)
{
    turned(k, x, k->weight_moment * s - drag(k->drag[0], x[2]),
           k->motor.force_per_ampere * x[4] - drag(k->drag[1], x[3]), dx);
    wheel_current_rate(k, x, voltage, dx);
}

MCT_INLINE void wheel_dragged_level(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real s,
                                    mct_real voltage, mct_real *dx)
{
    (void)s;
    turned(k, x, -(k->arm_viscous * x[2]) - drag(k->drag[0], x[2]),
           k->motor.force_per_ampere * x[4] - k->wheel_viscous * x[3] - drag(k->drag[1], x[3]), dx);
    wheel_current_rate(k, x, voltage, dx);
}

MCT_INLINE void wheel_rk4_step(wheel_rates rates, int states, const mct_reaction_wheel_constants *k,
                               const mct_real *x, mct_real input, mct_real *dx)
{
    const mct_step step = k->step;
    mct_real k1[5], k2[5], k3[5], k4[5], stage[5], s0, c0, sine, cosine;
    mct_sincos(x[0], &s0, &c0);
    rates(k, x, s0, input, k1);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.half * k1[i];
    }
    mct_sincos_near(stage[0], step.half * k1[0], s0, c0, &sine, &cosine);
    rates(k, stage, sine, input, k2);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.half * k2[i];
    }
    mct_sincos_near(stage[0], step.half * k2[0], s0, c0, &sine, &cosine);
    rates(k, stage, sine, input, k3);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        stage[i] = x[i] + step.h * k3[i];
    }
    mct_sincos_near(stage[0], step.h * k3[0], s0, c0, &sine, &cosine);
    rates(k, stage, sine, input, k4);
    MCT_UNROLL
    for (int i = 0; i < states; i++) {
        dx[i] = step.sixth * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
    }
}

MCT_INLINE void wheel_friction(const mct_reaction_wheel_constants *k, const mct_real *x, mct_real *dx)
{
    mct_friction_correct(k->inertia, k->coulomb, k->hold, k->step.h, x + 2, dx);
}

MCT_INLINE void wheel_rk4(wheel_rates rates, int states, const mct_reaction_wheel_constants *k,
                          mct_state *state, mct_real input, int32_t steps)
{
    mct_real x[5], c[5], dx[5];
    load(states, state, x, c);
    for (int32_t n = 0; n < steps; n++) {
        wheel_rk4_step(rates, states, k, x, input, dx);
        add(states, k->step.sixth_remainder, dx, x, c);
    }
    store(states, x, c, state);
}

MCT_INLINE void wheel_rk4_dry(wheel_rates rates, int states, const mct_reaction_wheel_constants *k,
                              mct_state *state, mct_real input, int32_t steps)
{
    mct_real x[5], c[5], dx[5];
    load(states, state, x, c);
    for (int32_t n = 0; n < steps; n++) {
        wheel_rk4_step(rates, states, k, x, input, dx);
        wheel_friction(k, x, dx);
        add_resting(states, k->step.sixth_remainder, dx, x, c);
    }
    store(states, x, c, state);
}

#define WHEEL(effects, states, step, rates)                                                      \
    void plain_reaction_wheel_rk4_##effects(const void *constants, mct_state *state, mct_real u, \
                                            int32_t steps)                                       \
    {                                                                                            \
        step(rates, states, constants, state, u, steps);                                         \
    }
WHEEL(7, 4, wheel_rk4_dry, wheel_damped)
WHEEL(f, 4, wheel_rk4_dry, wheel_driven_at_once)
WHEEL(13, 5, wheel_rk4, wheel_driven)
WHEEL(15, 5, wheel_rk4_dry, wheel_driven_smoothly)
WHEEL(16, 5, wheel_rk4_dry, wheel_driven_level)
WHEEL(17, 5, wheel_rk4_dry, wheel_driven)
WHEEL(47, 4, wheel_rk4_dry, wheel_dragged)
WHEEL(4f, 4, wheel_rk4_dry, wheel_dragged_at_once)
WHEEL(53, 5, wheel_rk4, wheel_dragged_driven)
WHEEL(55, 5, wheel_rk4_dry, wheel_dragged_alone)
WHEEL(56, 5, wheel_rk4_dry, wheel_dragged_level)

/* What follows linearly from the rates, and the current if there is one. */
MCT_INLINE mct_real response(int rates, const mct_real *row, const mct_real *x, mct_real input)
{
    const mct_real of_rates = row[0] * x[2] + row[1] * x[3];
    return (rates == 3 ? of_rates + row[2] * x[4] : of_rates) + row[MCT_EXPO_INPUT] * input;
}

/* With gravity: the sine goes along the polynomial through its values at the start and at two nodes. */
MCT_INLINE void expo_step(int rates, const mct_expo *k, const mct_real *x, mct_real input, mct_real *dx)
{
    mct_real growth[2], s, c, unused;
    MCT_EXPO_RELOAD(k); /* else a sixth of the code copies constants ahead of the first step */
    mct_sincos(x[0], &s, &c);
    /*
     * Three derivatives of the sine, by acceleration and jerk of the arm, of which the sine's own share is multiplied out:
     * all else need not wait for it.
     */
    const mct_real w = x[2];
    const mct_real a = response(rates, k->mean[0], x, input);
    const mct_real j = response(rates, k->mean[1], x, input);
    const mct_real a_by_sine = k->mean[0][MCT_EXPO_CONSTANT];
    const mct_real s1 = w * c;
    const mct_real s2 = a * c - w * w * s + a_by_sine * (s * c);
    const mct_real s3 = (j - w * w * w) * c - 3 * w * a * s +
                        (k->mean[1][MCT_EXPO_CONSTANT] * (s * c) + a_by_sine * w * (1 - 4 * (s * s)));
    MCT_UNROLL
    for (int m = 0; m < 2; m++) {
        const mct_real *power = k->angle_powers[m];
        const mct_real angle = response(rates, k->angle[m], x, input) + k->angle[m][MCT_EXPO_CONSTANT] * s +
                               power[0] * s1 + power[1] * s2 + power[2] * s3;
        mct_expo_turn(x[0], angle, s, c, &growth[m], &unused);
    }
    MCT_UNROLL
    for (int i = 0; i < rates + 2; i++) {
        const mct_real of_rates = k->flow[i][0] * x[2] + k->flow[i][1] * x[3];
        dx[i] = (rates == 3 ? of_rates + k->flow[i][2] * x[4] : of_rates) + k->input[i] * input +
                k->constant[i] * s + k->nodes[i][0] * growth[0] + k->nodes[i][1] * growth[1];
    }
}

void plain_reaction_wheel_expo_13(const void *constants, mct_state *state, mct_real voltage, int32_t steps)
{
    const mct_reaction_wheel_constants *k = constants;
    mct_real x[5], c[5], dx[5];
    load(5, state, x, c);
    for (int32_t n = 0; n < steps; n++) {
        expo_step(3, &k->expo, x, voltage, dx);
        add(5, 0, dx, x, c);
    }
    store(5, x, c, state);
}

MCT_INLINE void expo_dry(int rates, const mct_reaction_wheel_constants *k, mct_state *state, mct_real input,
                         int32_t steps)
{
    mct_real x[5], c[5], dx[5];
    load(rates + 2, state, x, c);
    for (int32_t n = 0; n < steps; n++) {
        expo_step(rates, &k->expo, x, input, dx);
        wheel_friction(k, x, dx);
        add_resting(rates + 2, 0, dx, x, c);
    }
    store(rates + 2, x, c, state);
}

/* Viscous friction and a motor without inductance are in the flow's matrices alone. */
void plain_reaction_wheel_expo_7(const void *constants, mct_state *state, mct_real torque, int32_t steps)
{
    expo_dry(2, constants, state, torque, steps);
}

void plain_reaction_wheel_expo_f(const void *constants, mct_state *state, mct_real voltage, int32_t steps)
{
    expo_dry(2, constants, state, voltage, steps);
}

void plain_reaction_wheel_expo_15(const void *constants, mct_state *state, mct_real voltage, int32_t steps)
{
    expo_dry(3, constants, state, voltage, steps);
}

void plain_reaction_wheel_expo_17(const void *constants, mct_state *state, mct_real voltage, int32_t steps)
{
    expo_dry(3, constants, state, voltage, steps);
}

void plain_reaction_wheel_expo_16(const void *constants, mct_state *state, mct_real voltage, int32_t steps)
{
    const mct_reaction_wheel_constants *k = constants;
    mct_real x[5], c[5], dx[5];
    load(5, state, x, c);
    for (int32_t n = 0; n < steps; n++) {
        MCT_UNROLL
        for (int i = 0; i < 5; i++) {
            dx[i] = k->expo.input[i] * voltage + k->expo.flow[i][0] * x[2] + k->expo.flow[i][1] * x[3] +
                    k->expo.flow[i][2] * x[4];
        }
        wheel_friction(k, x, dx);
        add_resting(5, 0, dx, x, c);
    }
    store(5, x, c, state);
}

/* --- both side by side --- */

typedef struct {
    mct_plant start;
    mct_state state;
    mct_kernel kernel;
} running;

static void restart(void *context)
{
    running *self = context;
    self->state = self->start.state;
}

static void run(void *context, long steps)
{
    running *self = context;
    self->kernel(&self->start.constants, &self->state, MCT_R(0.25), (int32_t)steps);
}

/* Counts a step of one kernel, and leaves the state after a thousand of them. */
static void count(const measure_effort *effort, const char *whose, const char *name, mct_kernel kernel,
                  running *self)
{
    char label[64];
    snprintf(label, sizeof label, "%s_%s", whose, name);
    self->kernel = kernel;
    measure(effort, label, run, restart, self, 0);
    restart(self);
    run(self, 1000);
}

int main(int argc, char **argv)
{
    static const struct {
        const mct_system *system;
        int stepper;
        uint32_t effects;
        const char *name;
        mct_kernel plain;
    } cases[] = {
#define KERNEL(system, name, STEPPER, effects)                                          \
    {&mct_##system, MCT_STEPPER_##STEPPER, 0x##effects, #system "_" #name "_" #effects, \
     plain_##system##_##name##_##effects},
        KERNELS
#undef KERNEL
    };
    const measure_effort effort = measure_effort_of(argc, argv);
    static running self;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mct_scene scene;
        mct_message why = {""};
        int system = 0;
        while (mct_systems[system] != cases[i].system) {
            system++;
        }
        mct_scene_defaults(&scene, system);
        scene.stepper = cases[i].stepper;
        scene.effects = cases[i].effects;
        scene.dt = 1e-4; /* rk4 follows the cart's motor up to 2e-4 */
        scene.initial[2] = 0.5;
        scene.initial[3] = 3;
        for (int field = 0; field < cases[i].system->parameter_count; field++) {
            if (cases[i].system->parameters[field].effects & (MCT_COULOMB | MCT_DRAG)) {
                scene.parameters[field] += 1e-3; /* they are 0 by default */
            }
        }
        if (mct_plant_init(&self.start, &scene, &why) != MCT_OK) {
            fprintf(stderr, "%s: %s\n", cases[i].name, why.text);
            return 1;
        }
        count(&effort, "library", cases[i].name, self.start.kernel, &self);
        const mct_state library = self.state;
        count(&effort, "plain", cases[i].name, cases[i].plain, &self);
        for (int entry = 0; entry < self.start.entries; entry++) {
            const double difference = (double)(self.state.x[entry] - library.x[entry]);
            if (!(difference <= 1e-9 && difference >= -1e-9)) { /* a thousand steps' roundings */
                fprintf(stderr, "%s: state %d differs by %g\n", cases[i].name, entry, difference);
                return 1;
            }
        }
    }
    return 0;
}

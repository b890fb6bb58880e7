/*
 * A rigid body that turns about one fixed axis: what systems of this kind share.
 *
 *     I a = P sin th + Q cos th - nu w - c w |w| + torque + dry friction,    th the angle, w its rate, a its acceleration
 *
 * The including file's `constants_t` begins with a mct_hinge. Its MCT_ALWAYS, defined first, says which of P and Q it
 * has: the other leaves no instruction.
 */
#ifndef MCT_SYSTEMS_HINGE_H
#define MCT_SYSTEMS_HINGE_H

#include "../effects/friction1.h"
#include "../steppers/euler.h"
#include "../steppers/friction_exact.h"
#include "../steppers/leap.h"
#include "../steppers/rk4.h"
#include "../steppers/rkn6.h"
#include "../steppers/seed.h"
#include "../steppers/taylor.h"
#include "kernels.h"
#include "mctau/hinge.h"
#include "mctau/sincos.h"

/* No effects, but of a kernel's mask: */
#define MCT_HINGE_SINE   (UINT32_C(1) << 29)
#define MCT_HINGE_COSINE (UINT32_C(1) << 28)

MCT_INLINE mct_real mct_hinge_size(mct_real value)
{
    return value < 0 ? -value : value;
}

/* All torques but dry friction. */
MCT_INLINE mct_real mct_hinge_torque(const mct_hinge *k, unsigned effects, mct_real s, mct_real c, mct_real w,
                                     mct_real u)
{
    mct_real sum = u;
    if ((effects & MCT_GRAVITY) && (effects & MCT_HINGE_SINE)) {
        sum += k->sine_moment * s;
    }
    if ((effects & MCT_GRAVITY) && (effects & MCT_HINGE_COSINE)) {
        sum += k->cosine_moment * c;
    }
    if (effects & MCT_VISCOUS) {
        sum -= k->viscous * w;
    }
    if (effects & MCT_DRAG) {
        sum -= k->drag * w * mct_hinge_size(w);
    }
    return sum;
}

MCT_INLINE void mct_hinge_derivative_at(const void *constants, unsigned effects, const mct_real *x,
                                        mct_real s, mct_real c, mct_real u, mct_real *dx)
{
    const mct_hinge *k = constants;
    dx[0] = x[1];
    dx[1] = k->inverse_inertia * mct_hinge_torque(k, effects, s, c, x[1], u);
}

MCT_INLINE void mct_hinge_derivative(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                                     mct_real *dx)
{
    mct_real s, c;
    mct_sincos(x[0], &s, &c);
    mct_hinge_derivative_at(constants, effects, x, s, c, u, dx);
}

/*
 * By how much the impulse falls with the new rate: viscous damping is taken there (`share` 1: euler) or at the mean of
 * both (1/2: leap); w |w| becomes w' |w|, bilinear as all that `leap` finds quadratic.
 */
MCT_INLINE mct_real mct_hinge_damping(const mct_hinge *k, unsigned effects, mct_real w, mct_real share)
{
    if (!(effects & MCT_DRAG)) {
        return k->step.h * share * k->viscous;
    }
    const mct_real drag = k->drag * mct_hinge_size(w);
    return k->step.h * ((effects & MCT_VISCOUS) ? share * k->viscous + drag : drag);
}

/* Velocity increment of a step. */
MCT_INLINE void mct_hinge_kick(const mct_hinge *k, unsigned effects, const mct_real *x, mct_real u,
                               mct_real share, mct_real *dx)
{
    mct_real s, c;
    mct_sincos(x[0], &s, &c);
    const mct_real impulse = k->step.h * mct_hinge_torque(k, effects, s, c, x[1], u);
    if (effects & (MCT_VISCOUS | MCT_DRAG)) {
        dx[1] = impulse / (k->inertia + mct_hinge_damping(k, effects, x[1], share));
    } else {
        dx[1] = k->inverse_inertia * impulse;
    }
}

MCT_INLINE void mct_hinge_kick_implicit(const void *constants, unsigned effects, const mct_real *x,
                                        mct_real u, mct_real *dx)
{
    mct_hinge_kick(constants, effects, x, u, 1, dx);
}

MCT_INLINE void mct_hinge_kick_symmetric(const void *constants, unsigned effects, const mct_real *x,
                                         mct_real u, mct_real *dx)
{
    mct_hinge_kick(constants, effects, x, u, MCT_R(0.5), dx);
}

/* The rate's in a mode of exact friction, which drag needs, too: w |w| has a kink where the body turns back. */
MCT_INLINE void mct_hinge_series(const void *constants, unsigned effects, int order, const mct_real *x,
                                 mct_real u, const mct_slip *slip, mct_series *rates, mct_series *loads)
{
    const mct_hinge *k = constants;
    const mct_real h = k->step.h;
    mct_real turn = h * k->inverse_inertia;
    mct_real torque = u;
    mct_real drag = 0;
    mct_real *const w = rates[0];
    mct_series s = {0}, c = {0}; /* for compilers that do not see that the effects decide both times */
    if (effects & MCT_GRAVITY) {
        mct_sincos(x[0], &s[0], &c[0]);
    }
    w[0] = x[1];
    if (effects & MCT_COULOMB_EXACT) {
        const mct_real direction = slip->direction[0]; /* NOLINT(*NullDereference): exact friction has it */
        if (direction == 0) {                          /* the load of a body at rest is constant */
            turn = 0;
            loads[0][0] = mct_hinge_torque(k, effects & ~(unsigned)MCT_DRAG, s[0], c[0], w[0], u);
            for (int n = 1; n < order; n++) {
                loads[0][n] = 0;
            }
        }
        torque -= direction * k->coulomb;
        drag = direction * k->drag;
    }
    MCT_UNROLL
    for (int n = 0; n < order; n++) {
        const mct_real share = turn * mct_series_share(n);
        mct_real change = n == 0 ? turn * torque : MCT_NOTHING;
        if (effects & MCT_DRAG) {
            change -= (share * drag) * mct_series_product(w, w, n);
        }
        if (effects & MCT_VISCOUS) {
            change -= (share * k->viscous) * w[n];
        }
        if ((effects & MCT_GRAVITY) && (effects & MCT_HINGE_COSINE)) {
            change += (share * k->cosine_moment) * c[n];
        }
        if ((effects & MCT_GRAVITY) && (effects & MCT_HINGE_SINE)) {
            change += (share * k->sine_moment) * s[n];
        }
        w[n + 1] = change;
        if (effects & MCT_GRAVITY) {
            mct_series_sincos(w, h, n, s, c);
        }
    }
}

/* Of kernels.h. */
MCT_INLINE void taylor(const void *constants, unsigned effects, int order, const mct_real *x, mct_real u,
                       mct_real *dx)
{
    const mct_hinge *k = constants;
    const mct_dry dry = {{k->hold}, 0, 0};
    mct_taylor_dry(mct_hinge_series, constants, dry, k->step.h, effects, order, 1, x, u, dx);
}

/* An angle whose sine and cosine are known: stages of a step lie near it. */
typedef struct {
    const mct_hinge *k;
    mct_real angle, s, c;
} mct_hinge_start;

MCT_INLINE void mct_hinge_acceleration(const void *self, unsigned effects, const mct_real *x, mct_real u,
                                       mct_real *a)
{
    const mct_hinge_start *start = self;
    mct_real s, c;
    mct_sincos_near(x[0], x[0] - start->angle, start->s, start->c, &s, &c);
    a[0] = start->k->inverse_inertia * mct_hinge_torque(start->k, effects, s, c, 0, u);
}

MCT_INLINE void mct_hinge_rkn6(const mct_hinge *k, unsigned effects, const mct_real *x, mct_real u,
                               mct_real *dx)
{
    mct_hinge_start start = {k, x[0], 0, 1};
    mct_sincos(x[0], &start.s, &start.c);
    mct_rkn6(mct_hinge_acceleration, &start, k->step, effects, 1, x, u, dx);
}

/* Of kernels.h. */
MCT_INLINE void friction(const void *constants, unsigned effects, const mct_real *x, mct_real u, mct_real *dx)
{
    const mct_hinge *k = constants;
    (void)effects;
    (void)u;
    mct_friction1_correct(k->inertia, k->inverse_inertia, k->coulomb, k->hold, k->step.h, x[1], dx);
}

/* All of an evaluation but the particles; potential energy is that of P and Q alone. s, c are of the angle. */
static inline void mct_hinge_evaluate(const mct_hinge *k, uint32_t effects, mct_real s, mct_real c,
                                      mct_real w, mct_real u, mct_evaluation *out)
{
    *out = (mct_evaluation){0};
    const mct_real smooth = mct_hinge_torque(k, effects | MCT_ALWAYS, s, c, w, u);
    const mct_real dry = mct_friction1_force(k->coulomb, k->hold, w, smooth);
    out->M[0][0] = k->inertia;
    out->tau[0] = smooth + dry;
    out->acceleration[0] = k->inverse_inertia * out->tau[0];
    out->kinetic_energy = MCT_R(0.5) * k->inertia * w * w;
    out->potential_energy = k->sine_moment * c - k->cosine_moment * s;
    out->power_input = u * w;
    out->power[MCT_EFFECT_GRAVITY] = (k->sine_moment * s + k->cosine_moment * c) * w;
    out->power[MCT_EFFECT_VISCOUS] = -k->viscous * w * w;
    out->power[MCT_EFFECT_DRAG] = -k->drag * mct_hinge_size(w) * w * w;
    out->power[MCT_EFFECT_COULOMB] = dry * w;
}

/* The kernels, and kernel() and motion() of the descriptor: by kernels.h's macros for any stepper and for series, and
 * the first switches of those below that the system has. */
#define MCT_HINGE_KERNELS(KERNELS, SERIES, ...)                                                             \
    KERNELS(seed, k->hinge.step.remainder, 1, 5, __VA_ARGS__,                                               \
            mct_seed(mct_hinge_derivative, k, k->hinge.step, effects, 1, x, u, dx))                         \
    KERNELS(euler, k->hinge.step.remainder, 1, 5, __VA_ARGS__,                                              \
            mct_euler(mct_hinge_kick_implicit, k, k->hinge.step, effects, 1, x, u, dx))                     \
    KERNELS(leap, k->hinge.step.remainder, 1, 5, __VA_ARGS__,                                               \
            mct_leap(mct_hinge_kick_symmetric, k, k->hinge.step, effects, 1, x, u, dx))                     \
    KERNELS(rk4, k->hinge.step.sixth_remainder, 1, 5, __VA_ARGS__,                                          \
            mct_rk4(mct_hinge_derivative_at, 0, k, k->hinge.step, effects, 1, x, u, dx))                    \
    SERIES(k->hinge.step.remainder, 1, MCT_GRAVITY, MCT_VISCOUS)                                            \
    MCT_SMOOTH_KERNELS_1(rkn6, k->hinge.step.remainder, 1, 5, MCT_GRAVITY,                                  \
                         mct_hinge_rkn6(&k->hinge, effects, x, u, dx))                                      \
    static const mct_named_kernel *kernel(int stepper, uint32_t effects)                                    \
    {                                                                                                       \
        static const uint32_t switches[] = {MCT_GRAVITY, MCT_VISCOUS,       MCT_COULOMB_MOREAU,             \
                                            MCT_DRAG,    MCT_COULOMB_EXACT, 0};                             \
        static const mct_named_kernel *const kernels[MCT_STEPPER_COUNT] = {                                 \
            [MCT_STEPPER_SEED] = seed_kernels, [MCT_STEPPER_EULER] = euler_kernels,                         \
            [MCT_STEPPER_LEAP] = leap_kernels, [MCT_STEPPER_RK4] = rk4_kernels,                             \
            [MCT_STEPPER_RKN6] = rkn6_kernels, MCT_TAYLOR_ROWS,                                             \
        };                                                                                                  \
        return mct_switched_kernel_of(kernels, switches, stepper, effects);                                 \
    }                                                                                                       \
    void MCT_OF_SYSTEM(motion)(const void *constants, uint32_t effects, const mct_state *state, mct_real u, \
                               mct_motion *motion)                                                          \
    {                                                                                                       \
        const mct_hinge *k = constants;                                                                     \
        mct_taylor_motion(mct_hinge_series, constants, k->step, effects | MCT_ALWAYS, 1, state, u, motion); \
    }

#endif

/*
 * Kernels as one would write them for a mechanism that has some effects and never any others. Written from the
 * equations, with no mask anywhere. test_kernels.py holds the library's kernels of the same name against them:
 * plain_rk4_16_3 is rk4 with an inductive motor (16), gravity and viscous friction (3).
 * Only what every kernel has is shared: constants, sine and cosine, compensated sums.
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
#include "src/steppers/expo.h"
#include "src/systems/systems.h"
#include "tools/benchmark/measure.h"

void plain_rk4_0_0(const void *constants, mct_state *state, mct_real force, int32_t steps);
void plain_rk4_0_3(const void *constants, mct_state *state, mct_real force, int32_t steps);
void plain_rk4_16_3(const void *constants, mct_state *state, mct_real voltage, int32_t steps);
void plain_leap_0_0(const void *constants, mct_state *state, mct_real force, int32_t steps);
void plain_expo_0_0(const void *constants, mct_state *state, mct_real torque, int32_t steps);
void plain_expo_16_3(const void *constants, mct_state *state, mct_real voltage, int32_t steps);

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

/* L di/dt = V - R i - k_b pd, f = k_T i */
MCT_INLINE void driven(const mct_cart_pole_constants *k, const mct_real *x, mct_real s, mct_real c,
                       mct_real voltage, mct_real *dx)
{
    damped(k, x, s, c, k->motor.force_per_ampere * x[4], dx);
    dx[4] = k->motor.inverse_inductance * (voltage - k->motor.resistance * x[4] - k->motor.emf * x[2]);
}

MCT_INLINE void rk4(cart_pole_rates rates, int states, const mct_cart_pole_constants *k, mct_state *state,
                    mct_real input, int32_t steps)
{
    const mct_step step = k->step;
    mct_real x[5], c[5], k1[5], k2[5], k3[5], k4[5], stage[5], dx[5];
    load(states, state, x, c);
    for (int32_t n = 0; n < steps; n++) {
        mct_real s0, c0, sine, cosine;
        mct_sincos(x[1], &s0, &c0);
        rates(k, x, s0, c0, input, k1);
        MCT_UNROLL
        for (int i = 0; i < states; i++) {
            stage[i] = x[i] + step.half * k1[i];
        }
        mct_sincos_near(stage[1], step.half * k1[1], s0, c0, &sine, &cosine);
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
        add(states, step.sixth_remainder, dx, x, c);
    }
    store(states, x, c, state);
}

void plain_rk4_0_0(const void *constants, mct_state *state, mct_real force, int32_t steps)
{
    rk4(alone, 4, constants, state, force, steps);
}

void plain_rk4_0_3(const void *constants, mct_state *state, mct_real force, int32_t steps)
{
    rk4(damped, 4, constants, state, force, steps);
}

void plain_rk4_16_3(const void *constants, mct_state *state, mct_real voltage, int32_t steps)
{
    rk4(driven, 5, constants, state, voltage, steps);
}

/* At the middle: [m1 + m2, m2 l cos - h m2 l sin thd; m2 l cos, m2 l^2] dv = h (f + m2 l sin thd^2, 0) */
void plain_leap_0_0(const void *constants, mct_state *state, mct_real force, int32_t steps)
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
void plain_expo_0_0(const void *constants, mct_state *state, mct_real torque, int32_t steps)
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

/* What follows linearly from the state, and from a sine that stays as it is. */
MCT_INLINE mct_real response(const mct_real *row, const mct_real *x, mct_real voltage, mct_real sine)
{
    return row[0] * x[2] + row[1] * x[3] + row[2] * x[4] + row[MCT_EXPO_INPUT] * voltage +
           row[MCT_EXPO_CONSTANT] * sine;
}

/* With gravity: the sine goes along the polynomial through its values at the start and at two nodes. */
void plain_expo_16_3(const void *constants, mct_state *state, mct_real voltage, int32_t steps)
{
    const mct_expo *k = &((const mct_reaction_wheel_constants *)constants)->expo;
    mct_real x[5], compensation[5], dx[5], growth[2];
    load(5, state, x, compensation);
    for (int32_t n = 0; n < steps; n++) {
        MCT_EXPO_RELOAD(k); /* else a sixth of the code copies constants ahead of the first step */
        mct_real s, c, unused;
        mct_sincos(x[0], &s, &c);
        /* acceleration and jerk of the arm, where the sine's growth joins in; three derivatives of the sine */
        const mct_real w = x[2];
        const mct_real s1 = w * c;
        const mct_real a = response(k->mean[0], x, voltage, s);
        const mct_real j = response(k->mean[1], x, voltage, s) + k->mean[0][MCT_EXPO_CONSTANT] * s1;
        const mct_real s2 = a * c - w * w * s;
        const mct_real s3 = (j - w * w * w) * c - 3 * w * a * s;
        MCT_UNROLL
        for (int m = 0; m < 2; m++) {
            const mct_real *power = k->angle_powers[m];
            const mct_real angle =
                response(k->angle[m], x, voltage, s) + power[0] * s1 + power[1] * s2 + power[2] * s3;
            mct_expo_turn(x[0], angle, s, c, &growth[m], &unused);
        }
        MCT_UNROLL
        for (int i = 0; i < 5; i++) {
            dx[i] = k->flow[i][0] * x[2] + k->flow[i][1] * x[3] + k->flow[i][2] * x[4] +
                    k->input[i] * voltage + k->constant[i] * s + k->nodes[i][0] * growth[0] +
                    k->nodes[i][1] * growth[1];
        }
        add(5, 0, dx, x, compensation);
    }
    store(5, x, compensation, state);
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
    char label[32];
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
        {&mct_cart_pole, MCT_STEPPER_RK4, 0, "rk4_0_0", plain_rk4_0_0},
        {&mct_cart_pole, MCT_STEPPER_RK4, 3, "rk4_0_3", plain_rk4_0_3},
        {&mct_cart_pole, MCT_STEPPER_RK4, 16 + 3, "rk4_16_3", plain_rk4_16_3},
        {&mct_cart_pole, MCT_STEPPER_LEAP, 0, "leap_0_0", plain_leap_0_0},
        {&mct_reaction_wheel, MCT_STEPPER_EXPO, 0, "expo_0_0", plain_expo_0_0},
        {&mct_reaction_wheel, MCT_STEPPER_EXPO, 16 + 3, "expo_16_3", plain_expo_16_3},
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

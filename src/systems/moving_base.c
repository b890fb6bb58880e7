/*
 * Pendulum with a moving base: a point mass m at the end of a massless rod of length l that turns about a
 * pivot, which moves in the plane as prescribed, u = (A_1 cos(f_1 t + p_1), A_2 cos(f_2 t + p_2)).
 *
 * Equation      m l^2 a = m g l sin th - nu w - m l (u1dd cos th - u2dd sin th) + torque, th the angle, w
 *               its rate, a its acceleration.
 * Source        section 2.6, eqs. 170-187.
 * Conventions   th clockwise from the upward vertical. Axis 1 to the right, 2 up. M = m l^2, C = 0; Cv holds
 *               what the explicit time adds, m l (u1dd cos th - u2dd sin th). Velocities and energies are
 *               those of the fixed frame, potential energy is zero at the height of the resting base.
 * Differences   (175): - m Jdot thd; (179): Jdot = l thd (-sin, -cos, 0); (185), (186): gravity is m g l sin
 *               th, and the base's term - m l [cos, -sin, 0] udd, a row; the printed one is a matrix without
 *               m l.
 * Constraint    rod and base, e = m xdd - (0, -m g, 0). The base does work through it: e . ud, the power of
 *               base_motion.
 * Validity      rod and base rigid; any m, l > 0; the base completes at most half an oscillation in a step.
 *
 * Time          A kernel gets none. The clock is two angles, f_1 t and f_2 t, which are states behind the
 *               rates (mct_system.phases): they are recorded, replayed and set as any state, and are no
 *               coordinates. A step turns them by the same two-part number (mct_add_parts), in any stepper,
 *               and whole turns are taken out; hence no drift in float either: at most 2e-14 rad a step. A
 *               tick count would be as exact, but evaluate() and the records know states only; rotating
 *               phasors would have to be renormalised.
 * Steppers      `euler` and `leap` feed the base as the change of its velocity over the step, exactly: a
 *               fast base (Kapitza) is not aliased, and leap's stability limit at 400 Hz and 1 ms is right
 *               to 6e-6. `seed`, `rk4` and Taylor take its acceleration: rk4 is the more accurate one while f h is
 *               well below 1.
 */
#include "mctau/moving_base.h"

#include "../steppers/euler.h"
#include "../steppers/leap.h"
#include "../steppers/rk4.h"
#include "../steppers/seed.h"
#include "../steppers/taylor.h"
#define MCT_SYSTEM moving_base
#include "kernels.h"
#include "mctau/scene.h"
#include "mctau/sincos.h"
#include "systems.h"

typedef mct_moving_base_constants constants_t;

enum {
    MASS,
    LENGTH,
    GRAVITY,
    FRICTION,
    BASE_AMPLITUDE_1,
    BASE_AMPLITUDE_2,
    BASE_FREQUENCY_1,
    BASE_FREQUENCY_2,
    BASE_PHASE_1,
    BASE_PHASE_2,
    PARAMETERS
};

static const mct_field parameters[PARAMETERS] = {
    [MASS] = MCT_QUANTITY("mass", "kg", 1e-6, 1e6, 0.1, "point mass"),
    [LENGTH] = MCT_QUANTITY("length", "m", 1e-4, 1e4, 0.2, "pivot to point mass"),
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity", "m/s^2", 0, 1e4, 9.81, "gravitational acceleration"),
    [FRICTION] =
        MCT_COEFFICIENT(MCT_VISCOUS, "friction", "N m s", 0, 1e6, 0.0005, "viscous friction of the pivot"),
    [BASE_AMPLITUDE_1] =
        MCT_COEFFICIENT(MCT_BASE_MOTION, "base_amplitude_1", "m", 0, 1e4, 0, "of the base to the right"),
    [BASE_AMPLITUDE_2] =
        MCT_COEFFICIENT(MCT_BASE_MOTION, "base_amplitude_2", "m", 0, 1e4, 0.01, "of the base upwards"),
    [BASE_FREQUENCY_1] = MCT_COEFFICIENT(MCT_BASE_MOTION, "base_frequency_1", "rad/s", 0, 1e6, 300,
                                         "of the base to the right"),
    [BASE_FREQUENCY_2] =
        MCT_COEFFICIENT(MCT_BASE_MOTION, "base_frequency_2", "rad/s", 0, 1e6, 300, "of the base upwards"),
    [BASE_PHASE_1] = MCT_COEFFICIENT(MCT_BASE_MOTION, "base_phase_1", "rad", -1e6, 1e6, 0,
                                     "0: the base starts at its far right"),
    [BASE_PHASE_2] = MCT_COEFFICIENT(MCT_BASE_MOTION, "base_phase_2", "rad", -1e6, 1e6, 0,
                                     "0: the base starts at its top"),
};

static const mct_coordinate coordinates[1] = {
    {.position = MCT_QUANTITY("angle", "rad", -1e6, 1e6, 0.5, "clockwise from upright"),
     .rate = MCT_QUANTITY("angle_rate", "rad/s", -1e6, 1e6, 0, ""),
     .is_angle = true},
};

static const mct_field phases[MCT_PHASES] = {
    MCT_QUANTITY("base_angle_1", "rad", -1e6, 1e6, 0, "base_frequency_1 times time, whole turns taken out"),
    MCT_QUANTITY("base_angle_2", "rad", -1e6, 1e6, 0, "base_frequency_2 times time, whole turns taken out"),
};
enum { FIRST_PHASE = 2 }; /* its place in the state */

static const mct_field torque_field = MCT_QUANTITY("torque", "N m", -1e9, 1e9, 0, "about the pivot");
static const char *const particle_names[] = {"bob"};

#define PI 3.141592653589793

static double within_a_turn(double angle)
{
    return angle - 2 * PI * (double)(int64_t)(angle / (2 * PI));
}

static mct_status prepare_axis(const double *p, int axis, double h, mct_base_axis *base,
                               struct mct_message *why)
{
    const double amplitude = p[BASE_AMPLITUDE_1 + axis];
    const double frequency = p[BASE_FREQUENCY_1 + axis];
    const double phase = within_a_turn(p[BASE_PHASE_1 + axis]);
    const double turn = frequency * h;
    if (turn > PI) {
        mct_message_add(why, "parameters.");
        mct_message_add(why, parameters[BASE_FREQUENCY_1 + axis].name);
        mct_message_add(why, ": found ");
        mct_message_add_number(why, frequency);
        mct_message_add(why, ", more than half an oscillation in a step; allowed at most ");
        mct_message_add_number(why, PI / h);
        mct_message_add(why, " at this dt and substeps");
        return MCT_ERROR_UNSUITED;
    }
    double sine, cosine;
    mct_sincos_f64(0.5 * turn, &sine, &cosine);
    base->frequency = (mct_real)frequency;
    base->phase = (mct_real)phase;
    base->middle = (mct_real)(phase + 0.5 * turn);
    base->turn = (mct_real)turn;
    base->turn_rest = (mct_real)(turn - (double)base->turn);
    base->amplitude = (mct_real)amplitude;
    base->velocity = (mct_real)(amplitude * frequency);
    base->peak = (mct_real)(amplitude * frequency * frequency);
    base->kick = (mct_real)(2 * amplitude * frequency * sine);
    return MCT_OK;
}

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const double inertia = p[MASS] * p[LENGTH] * p[LENGTH];
    const double gravity = (scene->effects & MCT_GRAVITY) ? p[GRAVITY] : 0;
    k->step = mct_step_of(h);
    k->mass = (mct_real)p[MASS];
    k->length = (mct_real)p[LENGTH];
    k->moment = (mct_real)(p[MASS] * p[LENGTH]);
    k->inertia = (mct_real)inertia;
    k->inverse_inertia = (mct_real)(1 / inertia);
    k->gravity = (mct_real)gravity;
    k->weight_moment = (mct_real)(p[MASS] * gravity * p[LENGTH]);
    k->viscous = (mct_real)((scene->effects & MCT_VISCOUS) ? p[FRICTION] : 0);
    for (int axis = 0; axis < MCT_PHASES; axis++) {
        k->base[axis] = (mct_base_axis){0};
        const mct_status status =
            (scene->effects & MCT_BASE_MOTION) ? prepare_axis(p, axis, h, &k->base[axis], why) : MCT_OK;
        if (status != MCT_OK) {
            return status;
        }
    }
    return MCT_OK;
}

/* - J' m udd: what an acceleration of the base (or a change of its velocity, as an impulse) does to the angle. */
MCT_INLINE mct_real apparent(const constants_t *k, const mct_real *base, mct_real s, mct_real c)
{
    return -k->moment * (base[0] * c - base[1] * s);
}

/* Acceleration of the base at the phases of x. */
MCT_INLINE void base_acceleration(const constants_t *k, const mct_real *x, mct_real *base)
{
    for (int axis = 0; axis < MCT_PHASES; axis++) {
        mct_real s, c;
        mct_sincos(x[FIRST_PHASE + axis] + k->base[axis].phase, &s, &c);
        base[axis] = -k->base[axis].peak * c;
    }
}

/* Change of the base's velocity over the step that begins at the phases of x. */
MCT_INLINE void base_kick(const constants_t *k, const mct_real *x, mct_real *base)
{
    for (int axis = 0; axis < MCT_PHASES; axis++) {
        mct_real s, c;
        mct_sincos(x[FIRST_PHASE + axis] + k->base[axis].middle, &s, &c);
        base[axis] = -k->base[axis].kick * c;
    }
}

/* The phases' increments of a step, in two parts. */
MCT_INLINE void turn_base(const constants_t *k, unsigned effects, mct_real *dx)
{
    if (effects & MCT_BASE_MOTION) {
        for (int axis = 0; axis < MCT_PHASES; axis++) {
            dx[FIRST_PHASE + axis] = k->base[axis].turn;
            dx[FIRST_PHASE + MCT_PHASES + axis] = k->base[axis].turn_rest;
        }
    }
}

/* All torques but the base's. */
MCT_INLINE mct_real torque(const constants_t *k, unsigned effects, mct_real s, mct_real w, mct_real u)
{
    mct_real sum = u;
    if (effects & MCT_GRAVITY) {
        sum += k->weight_moment * s;
    }
    if (effects & MCT_VISCOUS) {
        sum -= k->viscous * w;
    }
    return sum;
}

MCT_INLINE void derivative_at(const void *constants, unsigned effects, const mct_real *x, mct_real s,
                              mct_real c, mct_real u, mct_real *dx)
{
    const constants_t *k = constants;
    mct_real sum = torque(k, effects, s, x[1], u);
    if (effects & MCT_BASE_MOTION) {
        mct_real base[MCT_PHASES];
        base_acceleration(k, x, base);
        sum += apparent(k, base, s, c);
        dx[FIRST_PHASE] = k->base[0].frequency;
        dx[FIRST_PHASE + 1] = k->base[1].frequency;
    }
    dx[0] = x[1];
    dx[1] = k->inverse_inertia * sum;
}

MCT_INLINE void derivative(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                           mct_real *dx)
{
    mct_real s, c;
    mct_sincos(x[0], &s, &c);
    derivative_at(constants, effects, x, s, c, u, dx);
}

/*
 * Velocity increment of a step. Viscous damping is taken at the new rate (`share` 1: euler) or at the mean of both
 * (1/2: leap); the base acts by the exact change of its velocity.
 */
MCT_INLINE void kick(const constants_t *k, unsigned effects, const mct_real *x, mct_real u, mct_real share,
                     mct_real *dx)
{
    mct_real s, c;
    mct_sincos(x[0], &s, &c);
    mct_real impulse = k->step.h * torque(k, effects, s, x[1], u);
    if (effects & MCT_BASE_MOTION) {
        mct_real base[MCT_PHASES];
        base_kick(k, x, base);
        impulse += apparent(k, base, s, c);
    }
    if (effects & MCT_VISCOUS) {
        dx[1] = impulse / (k->inertia + k->step.h * share * k->viscous);
    } else {
        dx[1] = k->inverse_inertia * impulse;
    }
}

MCT_INLINE void kick_implicit(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                              mct_real *dx)
{
    kick(constants, effects, x, u, 1, dx);
}

MCT_INLINE void kick_symmetric(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                               mct_real *dx)
{
    kick(constants, effects, x, u, MCT_R(0.5), dx);
}

/* The base's acceleration swings: its derivatives are those of a cosine. */
MCT_INLINE void taylor(const void *constants, unsigned effects, int order, const mct_real *x, mct_real u,
                       mct_real *dx)
{
    const constants_t *k = constants;
    const mct_real h = k->step.h;
    mct_series s, c, w, base[MCT_PHASES], across[MCT_PHASES]; /* across: a quarter of an oscillation behind */
    if (effects & (MCT_GRAVITY | MCT_BASE_MOTION)) {
        mct_sincos(x[0], &s[0], &c[0]);
    }
    for (int axis = 0; axis < MCT_PHASES && (effects & MCT_BASE_MOTION); axis++) {
        mct_sincos(x[FIRST_PHASE + axis] + k->base[axis].phase, &across[axis][0], &base[axis][0]);
        across[axis][0] *= -k->base[axis].peak;
        base[axis][0] *= -k->base[axis].peak;
    }
    w[0] = x[1];
    MCT_UNROLL
    for (int n = 0; n < order; n++) {
        const mct_real share = h * mct_series_share(n);
        mct_real sum = torque(k, effects, (effects & MCT_GRAVITY) ? s[n] : 0, w[n], n == 0 ? u : 0);
        if (effects & MCT_BASE_MOTION) {
            sum -= k->moment * (mct_series_product(base[0], c, n) - mct_series_product(base[1], s, n));
            for (int axis = 0; axis < MCT_PHASES; axis++) {
                const mct_real turn = share * k->base[axis].frequency;
                base[axis][n + 1] = -turn * across[axis][n];
                across[axis][n + 1] = turn * base[axis][n];
            }
        }
        if (effects & (MCT_GRAVITY | MCT_BASE_MOTION)) {
            mct_series_sincos(w, h, n, s, c);
        }
        w[n + 1] = share * (k->inverse_inertia * sum);
    }
    mct_series_increments(w, h, order, &dx[0], &dx[1]);
    turn_base(k, effects, dx);
}

#define friction mct_no_friction

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_real w = x[1];
    mct_real s, c;
    mct_real u_x[MCT_PHASES] = {0}, u_v[MCT_PHASES] = {0}, u_a[MCT_PHASES] = {0}; /* of the base */
    mct_sincos(x[0], &s, &c);
    *out = (mct_evaluation){0};
    if (effects & MCT_BASE_MOTION) {
        for (int axis = 0; axis < MCT_PHASES; axis++) {
            const mct_base_axis *base = &k->base[axis];
            mct_real sine, cosine;
            mct_sincos(x[FIRST_PHASE + axis] + base->phase, &sine, &cosine);
            u_x[axis] = base->amplitude * cosine;
            u_v[axis] = -base->velocity * sine;
            u_a[axis] = -base->peak * cosine;
        }
    }
    out->M[0][0] = k->inertia;
    out->Cv[0] = -apparent(k, u_a, s, c);
    out->tau[0] = torque(k, effects, s, w, u);
    out->acceleration[0] = k->inverse_inertia * (out->tau[0] - out->Cv[0]);
    const mct_real a = out->acceleration[0];
    const mct_real velocity[2] = {u_v[0] + k->length * c * w, u_v[1] - k->length * s * w};
    mct_real *const e = out->constraint_force[0];
    out->mass[0] = k->mass;
    out->position[0][0] = u_x[0] + k->length * s;
    out->position[0][1] = u_x[1] + k->length * c;
    out->force[0][1] = -k->mass * k->gravity;
    e[0] = k->mass * (u_a[0] + k->length * (c * a - s * w * w));
    e[1] = k->mass * (u_a[1] - k->length * (s * a + c * w * w) + k->gravity);
    out->kinetic_energy = MCT_R(0.5) * k->mass * (velocity[0] * velocity[0] + velocity[1] * velocity[1]);
    out->potential_energy = k->mass * k->gravity * out->position[0][1];
    out->power_input = u * w;
    out->power[MCT_EFFECT_GRAVITY] = -k->mass * k->gravity * velocity[1];
    out->power[MCT_EFFECT_VISCOUS] = -k->viscous * w * w;
    out->power[MCT_EFFECT_BASE_MOTION] = e[0] * u_v[0] + e[1] * u_v[1];
}

/* In seconds since the phases were 0. */
static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const constants_t *k = constants;
    mct_hyperdual of_rod[2];
    mct_hyperdual_sincos(q[0], &of_rod[0], &of_rod[1]);
    for (int axis = 0; axis < MCT_PHASES; axis++) {
        const mct_base_axis *base = &k->base[axis];
        mct_hyperdual turned = mct_hyperdual_scale(base->frequency, time);
        turned.value = q[FIRST_PHASE - 1 + axis].value; /* the clock, where there is one */
        const mct_hyperdual phase = mct_hyperdual_add(turned, mct_hyperdual_constant(base->phase));
        position[0][axis] = mct_hyperdual_add(mct_hyperdual_scale(k->length, of_rod[axis]),
                                              mct_hyperdual_scale(base->amplitude, mct_hyperdual_cos(phase)));
    }
    position[0][2] = mct_hyperdual_constant(0);
}

#define SWITCHES MCT_GRAVITY, MCT_VISCOUS, MCT_BASE_MOTION
static const uint32_t switches[] = {SWITCHES, 0};

MCT_KERNELS_3(seed, k->step.remainder, 1, SWITCHES,
              (mct_seed(derivative, k, k->step, effects, 1, x, u, dx), turn_base(k, effects, dx)))
MCT_KERNELS_3(euler, k->step.remainder, 1, SWITCHES,
              (mct_euler(kick_implicit, k, k->step, effects, 1, x, u, dx), turn_base(k, effects, dx)))
MCT_KERNELS_3(leap, k->step.remainder, 1, SWITCHES,
              (mct_leap(kick_symmetric, k, k->step, effects, 1, x, u, dx), turn_base(k, effects, dx)))
MCT_KERNELS_3(rk4, k->step.sixth_remainder, 1, SWITCHES,
              (mct_rk4(derivative_at, 0, k, k->step, effects, 1, x, u, dx), turn_base(k, effects, dx)))
MCT_TAYLOR_KERNELS_3(k->step.remainder, 1, 3, SWITCHES)

static const mct_named_kernel *kernel(int stepper, uint32_t effects)
{
    static const mct_named_kernel *const kernels[MCT_STEPPER_COUNT] = {
        [MCT_STEPPER_SEED] = seed_kernels,
        [MCT_STEPPER_EULER] = euler_kernels,
        [MCT_STEPPER_LEAP] = leap_kernels,
        [MCT_STEPPER_RK4] = rk4_kernels,
        MCT_TAYLOR_ROWS,
    };
    return mct_switched_kernel_of(kernels, switches, stepper, effects);
}

const mct_system mct_moving_base = {
    .name = "moving_base",
    .doc = "a pendulum whose pivot is shaken",
    .source = "2.6",
    .coordinate_count = 1,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .phases = phases,
    .input_without_motor = &torque_field,
    .effects = MCT_GRAVITY | MCT_VISCOUS | MCT_BASE_MOTION,
    .standard_effects = MCT_GRAVITY | MCT_VISCOUS | MCT_BASE_MOTION,
    .particle_count = 1,
    .particle_names = particle_names,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
};

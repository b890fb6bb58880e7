/*
 * Pendulum: a point mass m at the end of a massless rod of length l that turns about a fixed pivot.
 *
 * Equation      m l^2 a = m g l sin th - nu w - c w |w| + dry friction,  th the angle, w its rate, a its acceleration.
 * Source        section 1.2, eqs. 25-39.
 * Conventions   th clockwise from the upward vertical, zero is the unstable equilibrium.
 * Differences   (36): the centrifugal term has w^2 and the whole is -e; (38): e = m l (g cos th / l - w^2) along the
 *               rod, not m x (g cos th - w). Friction and drag are ours.
 * Constraint    the rod, e = m xdd - (0, -m g, 0), which also transmits the couples of friction and drag.
 * Validity      rod rigid; any m, l > 0.
 */
#include "mctau/pendulum.h"

#include "../effects/friction1.h"
#include "../steppers/euler.h"
#include "../steppers/leap.h"
#include "../steppers/rk4.h"
#include "../steppers/seed.h"
#include "kernels.h"
#include "mctau/scene.h"
#include "mctau/sincos.h"
#include "systems.h"

typedef mct_pendulum_constants constants_t;

enum { MASS, LENGTH, GRAVITY, FRICTION, DRAG, COULOMB, PARAMETERS };

static const mct_field parameters[PARAMETERS] = {
    [MASS] = MCT_QUANTITY("mass", "kg", 1e-6, 1e6, 0.1, "point mass"),
    [LENGTH] = MCT_QUANTITY("length", "m", 1e-4, 1e4, 0.3, "pivot to point mass"),
    [GRAVITY] = MCT_QUANTITY("gravity", "m/s^2", 0, 1e4, 9.81, "gravitational acceleration"),
    [FRICTION] = MCT_QUANTITY("friction", "N m s", 0, 1e6, 0.0005, "viscous friction of the pivot"),
    [DRAG] = MCT_QUANTITY("drag", "N m s^2", 0, 1e6, 0, "torque of the air by the square of the rate"),
    [COULOMB] = MCT_QUANTITY("coulomb", "N m", 0, 1e6, 0, "dry friction of the pivot"),
};

static const mct_coordinate coordinates[1] = {
    {.position = MCT_QUANTITY("angle", "rad", -1e6, 1e6, 3.0, "clockwise from upright"),
     .rate = MCT_QUANTITY("angle_rate", "rad/s", -1e6, 1e6, 0, ""),
     .is_angle = true},
};

static const mct_field torque_field = MCT_QUANTITY("torque", "N m", -1e9, 1e9, 0, "about the pivot");
static const char *const particle_names[] = {"bob"};

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const double inertia = p[MASS] * p[LENGTH] * p[LENGTH];
    const double gravity = (scene->effects & MCT_GRAVITY) ? p[GRAVITY] : 0;
    (void)why;
    k->step = mct_step_of(h);
    k->mass = (mct_real)p[MASS];
    k->length = (mct_real)p[LENGTH];
    k->inertia = (mct_real)inertia;
    k->inverse_inertia = (mct_real)(1 / inertia);
    k->gravity = (mct_real)gravity;
    k->weight_moment = (mct_real)(p[MASS] * gravity * p[LENGTH]);
    k->viscous = (mct_real)((scene->effects & MCT_VISCOUS) ? p[FRICTION] : 0);
    k->drag = (mct_real)((scene->effects & MCT_DRAG) ? p[DRAG] : 0);
    k->coulomb = (mct_real)((scene->effects & MCT_COULOMB) ? p[COULOMB] : 0);
    return MCT_OK;
}

MCT_INLINE mct_real size_of(mct_real value)
{
    return value < 0 ? -value : value;
}

/* All torques but dry friction. */
MCT_INLINE mct_real torque(const constants_t *k, unsigned effects, mct_real s, mct_real w, mct_real u)
{
    mct_real sum = u;
    if (effects & MCT_GRAVITY) {
        sum += k->weight_moment * s;
    }
    if (effects & MCT_VISCOUS) {
        sum -= k->viscous * w;
    }
    if (effects & MCT_DRAG) {
        sum -= k->drag * w * size_of(w);
    }
    return sum;
}

MCT_INLINE void derivative_at(const void *constants, unsigned effects, const mct_real *x, mct_real s,
                              mct_real c, mct_real u, mct_real *dx)
{
    const constants_t *k = constants;
    (void)c;
    dx[0] = x[1];
    dx[1] = k->inverse_inertia * torque(k, effects, s, x[1], u);
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
 * (1/2: leap); w |w| becomes w' |w|, bilinear as all that `leap` finds quadratic.
 */
MCT_INLINE void kick(const constants_t *k, unsigned effects, const mct_real *x, mct_real u, mct_real share,
                     mct_real *dx)
{
    mct_real s, c;
    mct_sincos(x[0], &s, &c);
    const mct_real impulse = k->step.h * torque(k, effects, s, x[1], u);
    mct_real damping = 0;
    if (effects & MCT_VISCOUS) {
        damping += share * k->viscous;
    }
    if (effects & MCT_DRAG) {
        damping += k->drag * size_of(x[1]);
    }
    if (effects & (MCT_VISCOUS | MCT_DRAG)) {
        dx[1] = impulse / (k->inertia + k->step.h * damping);
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

MCT_INLINE void friction(const void *constants, unsigned effects, const mct_real *x, mct_real u, mct_real *dx)
{
    const constants_t *k = constants;
    (void)effects;
    (void)u;
    mct_friction1_correct(k->inertia, k->inverse_inertia, k->coulomb, k->step.h, x[1], dx);
}

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_real w = x[1];
    mct_real s, c;
    mct_sincos(x[0], &s, &c);
    *out = (mct_evaluation){0};
    const mct_real smooth = torque(k, effects, s, w, u);
    const mct_real dry = mct_friction1_force(k->coulomb, w, smooth);
    out->M[0][0] = k->inertia;
    out->tau[0] = smooth + dry;
    out->acceleration[0] = k->inverse_inertia * out->tau[0];
    const mct_real a = out->acceleration[0];
    out->mass[0] = k->mass;
    out->position[0][0] = k->length * s;
    out->position[0][1] = k->length * c;
    out->force[0][1] = -k->mass * k->gravity;
    out->constraint_force[0][0] = k->mass * k->length * (c * a - s * w * w);
    out->constraint_force[0][1] = k->mass * (k->gravity - k->length * (s * a + c * w * w));
    out->kinetic_energy = MCT_R(0.5) * k->inertia * w * w;
    out->potential_energy = k->weight_moment * c;
    out->power_input = u * w;
    out->power_viscous = -k->viscous * w * w - k->drag * size_of(w) * w * w;
    out->power_coulomb = dry * w;
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const constants_t *k = constants;
    mct_hyperdual s, c;
    (void)time;
    mct_hyperdual_sincos(q[0], &s, &c);
    position[0][0] = mct_hyperdual_scale(k->length, s);
    position[0][1] = mct_hyperdual_scale(k->length, c);
    position[0][2] = mct_hyperdual_constant(0);
}

#define SWITCHES MCT_GRAVITY, MCT_VISCOUS, MCT_COULOMB, MCT_DRAG
static const uint32_t switches[] = {SWITCHES, 0};

MCT_KERNELS_4(seed, k->step.remainder, 1, SWITCHES, mct_seed(derivative, k, k->step, effects, 1, x, u, dx))
MCT_KERNELS_4(euler, k->step.remainder, 1, SWITCHES,
              mct_euler(kick_implicit, k, k->step, effects, 1, x, u, dx))
MCT_KERNELS_4(leap, k->step.remainder, 1, SWITCHES,
              mct_leap(kick_symmetric, k, k->step, effects, 1, x, u, dx))
MCT_KERNELS_4(rk4, k->step.sixth_remainder, 1, SWITCHES,
              mct_rk4(derivative_at, 0, k, k->step, effects, 1, x, u, dx))

static mct_kernel kernel(int stepper, uint32_t effects)
{
    static const mct_kernel *const kernels[MCT_STEPPER_COUNT] = {
        [MCT_STEPPER_SEED] = seed_kernels,
        [MCT_STEPPER_EULER] = euler_kernels,
        [MCT_STEPPER_LEAP] = leap_kernels,
        [MCT_STEPPER_RK4] = rk4_kernels,
    };
    return mct_switched_kernel_of(kernels, switches, stepper, effects);
}

const mct_system mct_pendulum = {
    .name = "pendulum",
    .doc = "a point mass on a rod",
    .source = "1.2",
    .coordinate_count = 1,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .input_without_motor = &torque_field,
    .effects = MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB | MCT_DRAG,
    .standard_effects = MCT_GRAVITY | MCT_VISCOUS,
    .particle_count = 1,
    .particle_names = particle_names,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
};

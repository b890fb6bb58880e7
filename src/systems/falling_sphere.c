/*
 * Falling sphere: a sphere of mass m = 4/3 pi r^3 eta that moves up and down in a fluid at rest.
 *
 * Equation      m vd = u - m g + rho V g - 6 pi mu r v - 1/2 rho c pi r^2 v |v|,  V = 4/3 pi r^3.
 * Source        section 8.2, eqs. 448-457.
 * Conventions   height and velocity up; the input u is a force upwards. rho is the fluid's density, mu its
 *               viscosity, eta the sphere's density: the source calls all of the fluid's rho.
 * Differences   (448): rho is the density; (452): - b v / m, not - v / (b m); buoyancy, which (455) lacks, so
 *               that Stokes' terminal speed is 2/9 g (eta - rho) r^2 / mu in place of (457).
 * Constraint    the vertical line: e = 0.
 * Steppers      expo: without drag the equation is linear and flowed exactly; with it, v is a power series in
 *               time, summed to rounding over parts of a step that are short against the motion's own time,
 *               at most MOST_PARTS, after which it is at its terminal speed. So it is stable at any step.
 * Validity      Stokes' law: Reynolds number 2 r |v| rho / mu far below 1. Drag: from about 1000 to 2e5,
 *               where c is near 0.47. No added mass, no history force: the fluid is much lighter or the
 *               motion slow to change.
 */
#include "mctau/falling_sphere.h"

#include "../steppers/euler.h"
#include "../steppers/leap.h"
#include "../steppers/rk4_plain.h"
#include "../steppers/seed.h"
#define MCT_SYSTEM falling_sphere
#include "kernels.h"
#include "mctau/matrix.h"
#include "mctau/message.h"
#include "mctau/scene.h"
#include "systems.h"

#define friction mct_no_friction
#define PI       3.141592653589793

typedef mct_falling_sphere_constants constants_t;

enum { RADIUS, DENSITY, FLUID_DENSITY, FLUID_VISCOSITY, DRAG_COEFFICIENT, GRAVITY, PARAMETERS };

/* A steel ball in glycerine at 20 C: it falls 1 cm a second. */
static const mct_field parameters[PARAMETERS] = {
    [RADIUS] = MCT_QUANTITY("radius", "m", 1e-7, 1e3, 1e-3, "of the sphere"),
    [DENSITY] = MCT_QUANTITY("density", "kg/m^3", 1e-3, 1e5, 7850, "of the sphere"),
    [FLUID_DENSITY] =
        MCT_COEFFICIENT(MCT_BUOYANCY | MCT_DRAG, "fluid_density", "kg/m^3", 0, 1e5, 1260, "of the fluid"),
    [FLUID_VISCOSITY] =
        MCT_COEFFICIENT(MCT_STOKES, "fluid_viscosity", "Pa s", 0, 1e6, 1.42, "of the fluid, dynamic"),
    [DRAG_COEFFICIENT] = MCT_COEFFICIENT(MCT_DRAG, "drag_coefficient", "", 0, 1e3, 0.47,
                                         "of the sphere, by its cross-section"),
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY | MCT_BUOYANCY, "gravity", "m/s^2", 0, 1e4, 9.81,
                                "gravitational acceleration"),
};

static const mct_coordinate coordinates[1] = {
    {.position = MCT_QUANTITY("height", "m", -1e6, 1e6, 0, "of the centre, upwards"),
     .rate = MCT_QUANTITY("velocity", "m/s", -1e6, 1e6, 0, "")},
};

static const mct_field force_field = MCT_QUANTITY("force", "N", -1e9, 1e9, 0, "upwards");
static const char *const particle_names[] = {"sphere"};

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const uint32_t effects = scene->effects;
    const double area = PI * p[RADIUS] * p[RADIUS];
    const double volume = 4.0 / 3 * p[RADIUS] * area;
    const double mass = volume * p[DENSITY];
    const double stokes = (effects & MCT_STOKES) ? 6 * PI * p[FLUID_VISCOSITY] * p[RADIUS] / mass : 0;
    const double drag = (effects & MCT_DRAG) ? 0.5 * p[FLUID_DENSITY] * p[DRAG_COEFFICIENT] * area / mass : 0;
    const bool is_explicit = scene->stepper == MCT_STEPPER_SEED || scene->stepper == MCT_STEPPER_RK4;
    if (is_explicit && stokes * h > 2) {
        mct_message_add(why, "parameters.fluid_viscosity: found ");
        mct_message_add_number(why, p[FLUID_VISCOSITY]);
        mct_message_add(why, " Pa s, which slows the sphere within ");
        mct_message_add_number(why, 1 / stokes);
        mct_message_add(why, " s; allowed with this stepper at least half a step, ");
        mct_message_add_number(why, 0.5 * h);
        mct_message_add(why, " s; with expo and euler any");
        return MCT_ERROR_UNSUITED;
    }
    /* d/dt (height, velocity, acceleration by what is constant) */
    const double generator[9] = {0, h, 0, 0, -h * stokes, h, 0, 0, 0};
    double flow[9];
    const mct_status status = mct_expm1(3, generator, flow);
    if (status != MCT_OK) {
        mct_message_add(
            why, "parameters.fluid_viscosity: found a sphere that stops at once; allowed 1e18 times a step");
        return status;
    }
    k->step = mct_step_of(h);
    k->mass = (mct_real)mass;
    k->inverse_mass = (mct_real)(1 / mass);
    k->weight = (mct_real)((effects & MCT_GRAVITY) ? mass * p[GRAVITY] : 0);
    k->lift = (mct_real)((effects & MCT_BUOYANCY) ? volume * p[FLUID_DENSITY] * p[GRAVITY] : 0);
    k->stokes = (mct_real)stokes;
    k->drag = (mct_real)drag;
    k->remainder = (effects & MCT_DRAG) ? k->step.remainder : 0;
    k->flow[0][0] = (mct_real)flow[1];
    k->flow[0][1] = (mct_real)flow[2];
    k->flow[1][0] = (mct_real)flow[4];
    k->flow[1][1] = (mct_real)flow[5];
    return MCT_OK;
}

MCT_INLINE mct_real size_of(mct_real value)
{
    return value < 0 ? -value : value;
}

/* Acceleration by all that does not depend on the velocity. */
MCT_INLINE mct_real steady(const constants_t *k, unsigned effects, mct_real u)
{
    mct_real force = u;
    if (effects & MCT_GRAVITY) {
        force -= k->weight;
    }
    if (effects & MCT_BUOYANCY) {
        force += k->lift;
    }
    return k->inverse_mass * force;
}

MCT_INLINE mct_real acceleration(const constants_t *k, unsigned effects, mct_real v, mct_real u)
{
    mct_real sum = steady(k, effects, u);
    if (effects & MCT_STOKES) {
        sum -= k->stokes * v;
    }
    if (effects & MCT_DRAG) {
        sum -= k->drag * v * size_of(v);
    }
    return sum;
}

MCT_INLINE void derivative(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                           mct_real *dx)
{
    dx[0] = x[1];
    dx[1] = acceleration(constants, effects, x[1], u);
}

/*
 * Stokes' drag at the new velocity (`share` 1: euler) or at the mean of both (1/2: leap); v |v| becomes v'
 * |v|.
 */
MCT_INLINE void kick(const constants_t *k, unsigned effects, const mct_real *x, mct_real u, mct_real share,
                     mct_real *dx)
{
    mct_real damping = 0;
    if (effects & MCT_STOKES) {
        damping += share * k->stokes;
    }
    if (effects & MCT_DRAG) {
        damping += k->drag * size_of(x[1]);
    }
    dx[1] = k->step.h * acceleration(k, effects, x[1], u);
    if (effects & (MCT_STOKES | MCT_DRAG)) {
        dx[1] /= 1 + k->step.h * damping;
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

/* --- the exact motion --- */

enum {
    ORDER = MCT_REAL_IS_FLOAT ? 9 : 17,
    HALVINGS = 60,    /* of a step, to a part that is short against the motion's own time */
    MOST_PARTS = 256, /* some 40 e-foldings towards the terminal speed */
    ITERATIONS = 8    /* of Newton's method */
};

static mct_real value_at(const mct_real *c, mct_real s)
{
    mct_real sum = c[ORDER];
    for (int n = ORDER - 1; n >= 0; n--) {
        sum = sum * s + c[n];
    }
    return sum;
}

/*
 * One part of a step: v' = a - B v - D v |v| as a series, v_(n+1) = (a - B v - D v |v|)_n h / (n + 1), in the
 * fraction of h that has passed. It ends where v passes through 0, for there |v| has a corner. Returns the
 * fraction done.
 */
MCT_INLINE mct_real move_part(mct_real a, const constants_t *k, unsigned effects, mct_real h,
                              mct_real *height, mct_real *velocity)
{
    mct_real v[ORDER + 1];
    mct_real mean[ORDER + 1]; /* of v from 0 to the fraction */
    const mct_real start = *velocity;
    const mct_real sign = start > 0 || (start == 0 && a > 0) ? MCT_R(1.0) : MCT_R(-1.0);
    v[0] = start;
    mean[0] = start;
    for (int n = 0; n < ORDER; n++) {
        mct_real square = 0;
        for (int i = 0; i <= n; i++) {
            square += v[i] * v[n - i];
        }
        const mct_real share = MCT_R(1.0) / (mct_real)(n + 1);
        mct_real acceleration = n == 0 ? a : 0;
        if (effects & MCT_STOKES) {
            acceleration -= k->stokes * v[n];
        }
        v[n + 1] = share * h * (acceleration - sign * k->drag * square);
        mean[n + 1] = v[n + 1] / (mct_real)(n + 2);
    }
    mct_real done = 1;
    v[0] = 0;
    mct_real gain = value_at(v, 1);
    v[0] = start;
    if (start != 0 && sign * (start + gain) < 0) {
        done = start / (start - (start + gain));
        for (int i = 0; i < ITERATIONS; i++) { /* v is monotone and nearly straight here */
            mct_real slope = 0;
            for (int n = ORDER; n >= 1; n--) {
                slope = slope * done + (mct_real)n * v[n];
            }
            done = mct_clamp(done - value_at(v, done) / slope, 1);
        }
        gain = -start;
    }
    *height += h * done * value_at(mean, done);
    *velocity = start + gain;
    return done;
}

MCT_INLINE void relax(mct_real a, const constants_t *k, unsigned effects, const mct_real *x, mct_real *dx)
{
    mct_real velocity = x[1];
    mct_real left = k->step.h;
    dx[0] = 0;
    for (int part = 0; part < MOST_PARTS && left > 0; part++) {
        mct_real length = left;
        mct_real rate = 2 * k->drag * size_of(velocity);
        if (effects & MCT_STOKES) {
            rate += k->stokes;
        }
        for (int i = 0; i < HALVINGS; i++) {
            if (rate * length <= MCT_R(0.25) && k->drag * size_of(a) * length * length <= MCT_R(1.0 / 64)) {
                break;
            }
            length *= MCT_R(0.5);
        }
        const mct_real done = move_part(a, k, effects, length, &dx[0], &velocity);
        left -= done * length;
    }
    dx[0] += left * velocity;
    dx[1] = velocity - x[1];
}

MCT_INLINE void exact(const constants_t *k, unsigned effects, const mct_real *x, mct_real u, mct_real *dx)
{
    const mct_real a = steady(k, effects, u);
    if (effects & MCT_DRAG) {
        relax(a, k, effects, x, dx);
        return;
    }
    for (int i = 0; i < 2; i++) {
        dx[i] = k->flow[i][0] * x[1] + k->flow[i][1] * a;
    }
}

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_real v = x[1];
    *out = (mct_evaluation){0};
    out->M[0][0] = k->mass;
    out->acceleration[0] = acceleration(k, effects, v, u);
    out->tau[0] = k->mass * out->acceleration[0];
    out->mass[0] = k->mass;
    out->position[0][1] = x[0];
    out->force[0][1] = out->tau[0];
    out->kinetic_energy = MCT_R(0.5) * k->mass * v * v;
    out->potential_energy = (k->weight - k->lift) * x[0];
    out->power_input = u * v;
    out->power[MCT_EFFECT_GRAVITY] = -k->weight * v;
    out->power[MCT_EFFECT_BUOYANCY] = k->lift * v;
    out->power[MCT_EFFECT_STOKES] = -k->mass * k->stokes * v * v;
    out->power[MCT_EFFECT_DRAG] = -k->mass * k->drag * size_of(v) * v * v;
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    (void)constants;
    (void)time;
    position[0][0] = mct_hyperdual_constant(0);
    position[0][1] = q[0];
    position[0][2] = mct_hyperdual_constant(0);
}

#define SWITCHES MCT_GRAVITY, MCT_STOKES, MCT_DRAG, MCT_BUOYANCY
static const uint32_t switches[] = {SWITCHES, 0};

MCT_KERNELS_4(seed, k->step.remainder, 1, SWITCHES, mct_seed(derivative, k, k->step, effects, 1, x, u, dx))
MCT_KERNELS_4(euler, k->step.remainder, 1, SWITCHES,
              mct_euler(kick_implicit, k, k->step, effects, 1, x, u, dx))
MCT_KERNELS_4(leap, k->step.remainder, 1, SWITCHES,
              mct_leap(kick_symmetric, k, k->step, effects, 1, x, u, dx))
MCT_KERNELS_4(rk4, k->step.sixth_remainder, 1, SWITCHES,
              mct_rk4_plain(derivative, k, k->step, effects, 1, x, u, dx))
MCT_KERNELS_4(expo, k->remainder, 1, SWITCHES, exact(k, effects, x, u, dx))

static const mct_named_kernel *kernel(int stepper, uint32_t effects)
{
    static const mct_named_kernel *const kernels[MCT_STEPPER_COUNT] = {
        [MCT_STEPPER_SEED] = seed_kernels, [MCT_STEPPER_EULER] = euler_kernels,
        [MCT_STEPPER_LEAP] = leap_kernels, [MCT_STEPPER_RK4] = rk4_kernels,
        [MCT_STEPPER_EXPO] = expo_kernels,
    };
    return mct_switched_kernel_of(kernels, switches, stepper, effects);
}

const mct_system mct_falling_sphere = {
    .name = "falling_sphere",
    .doc = "a sphere in a fluid",
    .source = "8.2",
    .coordinate_count = 1,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .input_without_motor = &force_field,
    .effects = MCT_GRAVITY | MCT_STOKES | MCT_DRAG | MCT_BUOYANCY,
    .standard_effects = MCT_GRAVITY | MCT_STOKES | MCT_BUOYANCY,
    .particle_count = 1,
    .particle_names = particle_names,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
};

/*
 * Block: a mass m with one coordinate x up a plane that is tilted by a, on the plane or on a belt that runs
 * along it with the speed b; a spring pulls it to x = 0.
 *
 * Equation      m xdd = u + F(t) - m g sin a - k x + R
 *               F(t) = F_0 + r t + A sin(w t), t the time
 *               R dry friction: while xd = b it holds, |R| <= mu_s m g cos a;
 *               else R = - mu_d m g cos a sign(xd - b).
 * Source        section 8.2, eq. 447 (F = mu W, W = m g on the level, and the text on mu_s, mu_d).
 * Conventions   x up the slope; the plane passes through the origin; x = 0 is the spring's end.
 * Differences   slope, spring, belt, the forces in time are ours.
 * Constraint    the plane: e = m xdd - f = m g cos a along its normal. Friction is a force from outside, no
 *               part of e.
 * Steppers      all with Moreau's clamp (effects/friction1.h, with mu_s at rest): first order where the block starts or
 *               stops. expo: between such events the motion is linear, so its series in time is summed to rounding;
 *               with exact friction the events are located within the step (steppers/friction_exact.h): exact,
 *               however large the step.
 * Validity      mu_s >= mu_d; the block does not leave the plane or tip. Spring and sine turn at most 1 rad a
 *               step.
 */
#include "mctau/block.h"

#include "../steppers/euler.h"
#include "../steppers/friction_exact.h"
#include "../steppers/leap.h"
#include "../steppers/rk4.h"
#include "../steppers/rk4_plain.h"
#include "../steppers/seed.h"
#define MCT_SYSTEM block
#include "kernels.h"
#include "mctau/matrix.h"
#include "mctau/message.h"
#include "mctau/scene.h"
#include "mctau/sincos.h"
#include "systems.h"

#define friction \
    mct_no_friction /* the steppers here see to it themselves: it has a belt and two coefficients */

typedef mct_block_constants constants_t;

enum {
    MASS,
    STATIC,
    DYNAMIC,
    GRAVITY,
    SLOPE,
    FORCE,
    FORCE_RAMP,
    FORCE_AMPLITUDE,
    FORCE_FREQUENCY,
    SPRING,
    BELT_SPEED,
    PARAMETERS
};

static const mct_field parameters[PARAMETERS] = {
    [MASS] = MCT_QUANTITY("mass", "kg", 1e-6, 1e6, 1, "of the block"),
    [STATIC] = MCT_COEFFICIENT(MCT_COULOMB, "static_coefficient", "", 0, 1e3, 0.6,
                               "of friction at rest; at least the dynamic one"),
    [DYNAMIC] = MCT_COEFFICIENT(MCT_COULOMB, "dynamic_coefficient", "", 0, 1e3, 0.5, "of friction in motion"),
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity", "m/s^2", 0, 1e4, 9.81, "gravitational acceleration"),
    [SLOPE] = MCT_QUANTITY("slope", "rad", -1.57, 1.57, 0, "of the plane, upwards with the position"),
    [FORCE] = MCT_COEFFICIENT(MCT_FORCING, "force", "N", -1e9, 1e9, 0, "along the plane, constant"),
    [FORCE_RAMP] = MCT_COEFFICIENT(MCT_FORCING, "force_ramp", "N/s", -1e9, 1e9, 0, "growth of the force"),
    [FORCE_AMPLITUDE] =
        MCT_COEFFICIENT(MCT_FORCING, "force_amplitude", "N", -1e9, 1e9, 0, "of the force's sine in time"),
    [FORCE_FREQUENCY] =
        MCT_COEFFICIENT(MCT_FORCING, "force_frequency", "rad/s", 0, 1e6, 1, "of the force's sine in time"),
    [SPRING] = MCT_COEFFICIENT(MCT_SPRING, "spring", "N/m", 0, 1e9, 100,
                               "stiffness of the spring, at rest at position 0"),
    [BELT_SPEED] = MCT_COEFFICIENT(MCT_COULOMB, "belt_speed", "m/s", -1e4, 1e4, 0,
                                   "of the plane's surface, along the plane"),
};

static const mct_coordinate coordinates[1] = {
    {.position = MCT_QUANTITY("position", "m", -1e6, 1e6, 0, "up the slope"),
     .rate = MCT_QUANTITY("velocity", "m/s", -1e6, 1e6, 0, "")},
};

static const mct_field phases[MCT_PHASES] = {
    MCT_QUANTITY("force_phase", "rad", -1e6, 1e6, 0, "force_frequency times time, whole turns taken out"),
    MCT_QUANTITY("force_time", "s", -1e6, 1e6, 0, "that force_ramp has grown for"),
};
enum { PHASE = 2, TIME = 3 }; /* their places in the state */

static const mct_field force_field = MCT_QUANTITY("force", "N", -1e9, 1e9, 0, "along the plane");
static const char *const particle_names[] = {"block"};

/* Terms of the series of exp(angle) that are not below rounding. */
static int32_t order_of(double angle)
{
    double term = 1;
    int32_t order = 0;
    while (order < 3 || (order < MCT_BLOCK_ORDER && term > 0.01 * (double)MCT_REAL_EPSILON)) {
        order++;
        term *= angle / (order + 1);
    }
    return order;
}

static mct_status refuse(struct mct_message *why, const char *key, double found, const char *unit,
                         const char *allowed, double bound)
{
    mct_message_add(why, "parameters.");
    mct_message_add(why, key);
    mct_message_add(why, ": found ");
    mct_message_add_number(why, found);
    mct_message_add(why, unit);
    mct_message_add(why, "; allowed ");
    mct_message_add(why, allowed);
    mct_message_add_number(why, bound);
    mct_message_add(why, unit);
    return MCT_ERROR_UNSUITED;
}

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    double sine, cosine;
    mct_sincos_f64(p[SLOPE], &sine, &cosine);
    const double weight = (scene->effects & MCT_GRAVITY) ? p[MASS] * p[GRAVITY] : 0;
    const double normal = (scene->effects & MCT_COULOMB) ? weight * cosine : 0;
    const double spring = (scene->effects & MCT_SPRING) ? p[SPRING] : 0;
    const double turn_of_spring = h * mct_sqrt(spring / p[MASS]);
    const bool forcing = scene->effects & MCT_FORCING;
    const double turn_of_force = forcing && p[FORCE_AMPLITUDE] != 0 ? h * p[FORCE_FREQUENCY] : 0;
    if (normal > 0 && p[STATIC] < p[DYNAMIC]) {
        return refuse(why, "static_coefficient", p[STATIC], "", "from dynamic_coefficient, ", p[DYNAMIC]);
    }
    if (turn_of_spring > 1) {
        return refuse(why, "spring", spring, " N/m", "1 rad of oscillation a step, up to ",
                      p[MASS] / (h * h));
    }
    if (turn_of_force > 1) {
        return refuse(why, "force_frequency", p[FORCE_FREQUENCY], " rad/s", "1 rad a step, up to ", 1 / h);
    }
    k->step = mct_step_of(h);
    k->mass = (mct_real)p[MASS];
    k->inverse_mass = (mct_real)(1 / p[MASS]);
    k->step_over_mass = (mct_real)(h / p[MASS]);
    k->sine = (mct_real)sine;
    k->cosine = (mct_real)cosine;
    k->weight = (mct_real)weight;
    k->weight_along = (mct_real)(-weight * sine);
    k->static_friction = (mct_real)(p[STATIC] * normal);
    k->dynamic_friction = (mct_real)(p[DYNAMIC] * normal);
    k->belt_speed = (mct_real)p[BELT_SPEED];
    const double belt = p[BELT_SPEED] < 0 ? -p[BELT_SPEED] : p[BELT_SPEED];
    const double speed = belt + 4 * h * p[STATIC] * normal / p[MASS]; /* a step before it came to rest */
    k->rest_speed = (mct_real)(belt > 0 ? 16 * (double)MCT_REAL_EPSILON * speed : 0);
    k->spring = (mct_real)spring;
    k->force = (mct_real)(forcing ? p[FORCE] : 0);
    k->ramp = (mct_real)(forcing ? p[FORCE_RAMP] : 0);
    k->amplitude = (mct_real)(forcing ? p[FORCE_AMPLITUDE] : 0);
    k->frequency = (mct_real)p[FORCE_FREQUENCY];
    k->phase_step = (mct_real)turn_of_force;
    k->phase_rest = (mct_real)(turn_of_force - (double)k->phase_step);
    k->step_rest = (mct_real)(h - (double)k->step.h);
    k->order = order_of(turn_of_spring > turn_of_force ? turn_of_spring : turn_of_force);
    return MCT_OK;
}

MCT_INLINE mct_real size_of(mct_real value)
{
    return value < 0 ? -value : value;
}

MCT_INLINE mct_real sign_of(mct_real value)
{
    return (mct_real)(value > 0) - (mct_real)(value < 0);
}

/* F(t), given the sine of its phase. */
MCT_INLINE mct_real prescribed(const constants_t *k, mct_real sine, mct_real time)
{
    return k->force + k->ramp * time + k->amplitude * sine;
}

/* All forces but friction and F(t). */
MCT_INLINE mct_real steady(const constants_t *k, unsigned effects, mct_real position, mct_real u)
{
    mct_real sum = u;
    if (effects & MCT_GRAVITY) {
        sum += k->weight_along;
    }
    if (effects & MCT_SPRING) {
        sum -= k->spring * position;
    }
    return sum;
}

/* All forces but friction. */
MCT_INLINE mct_real smooth_force(const constants_t *k, unsigned effects, mct_real position, mct_real phase,
                                 mct_real time, mct_real u)
{
    mct_real sum = steady(k, effects, position, u);
    if (effects & MCT_FORCING) {
        mct_real s, c;
        mct_sincos(phase, &s, &c);
        sum += prescribed(k, s, time);
    }
    return sum;
}

/* The clock's increments of a step, in two parts. */
MCT_INLINE void turn_clock(const constants_t *k, unsigned effects, mct_real *dx)
{
    if (effects & MCT_FORCING) {
        dx[PHASE] = k->phase_step;
        dx[TIME] = k->step.h;
        dx[PHASE + MCT_PHASES] = k->phase_rest;
        dx[TIME + MCT_PHASES] = k->step_rest;
    }
}

MCT_INLINE bool is_at_rest(const constants_t *k, mct_real relative)
{
    return size_of(relative) <= k->rest_speed;
}

/* --- Moreau's clamp --- */

/* Corrects the increments of a step for friction: what comes to rest on the belt has exactly its speed. */
MCT_INLINE void clamp(const constants_t *k, unsigned effects, const mct_real *x, mct_real *dx)
{
    if (!(effects & MCT_COULOMB_MOREAU)) {
        return;
    }
    const mct_real relative = x[1] - k->belt_speed;
    const mct_real most = k->step.h * (is_at_rest(k, relative) ? k->static_friction : k->dynamic_friction);
    const mct_real stop = -k->mass * (relative + dx[1]);
    if (most > 0 && stop >= -most && stop <= most) {
        dx[1] = -relative;
        dx[0] = k->step.half * (x[1] + k->belt_speed);
    } else {
        const mct_real change = k->inverse_mass * mct_clamp(stop, k->step.h * k->dynamic_friction);
        dx[1] += change;
        dx[0] += k->step.half * change;
    }
}

/* The steppers' increments, corrected for friction; the clock is exact. */
MCT_INLINE void finish(const constants_t *k, unsigned effects, const mct_real *x, mct_real *dx)
{
    clamp(k, effects, x, dx);
    turn_clock(k, effects, dx);
}

/* The angle is the force's phase. */
MCT_INLINE void derivative_at(const void *constants, unsigned effects, const mct_real *x, mct_real s,
                              mct_real c, mct_real u, mct_real *dx)
{
    const constants_t *k = constants;
    mct_real sum = steady(k, effects, x[0], u);
    (void)c;
    if (effects & MCT_FORCING) {
        sum += prescribed(k, s, x[TIME]);
        dx[PHASE] = k->frequency;
        dx[TIME] = 1;
    }
    dx[0] = x[1];
    dx[1] = k->inverse_mass * sum;
}

MCT_INLINE void derivative(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                           mct_real *dx)
{
    mct_real s = 0;
    mct_real c = 1;
    if (effects & MCT_FORCING) {
        mct_sincos(x[PHASE], &s, &c);
    }
    derivative_at(constants, effects, x, s, c, u, dx);
}

MCT_INLINE void runge_kutta(const constants_t *k, unsigned effects, const mct_real *x, mct_real u,
                            mct_real *dx)
{
    if (effects & MCT_FORCING) {
        mct_rk4(derivative_at, PHASE, k, k->step, effects, 1, x, u, dx);
    } else {
        mct_rk4_plain(derivative, k, k->step, effects, 1, x, u, dx);
    }
}

/*
 * Velocity increment of a step with the forces at x (euler), or of the middle of the step (leap, x its
 * middle).
 */
MCT_INLINE void kick(const void *constants, unsigned effects, const mct_real *x, mct_real u, mct_real *dx)
{
    const constants_t *k = constants;
    const bool forced = effects & MCT_FORCING;
    dx[1] =
        k->step_over_mass * smooth_force(k, effects, x[0], forced ? x[PHASE] : 0, forced ? x[TIME] : 0, u);
}

MCT_INLINE void kick_middle(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                            mct_real *dx)
{
    const constants_t *k = constants;
    const bool forced = effects & MCT_FORCING;
    const mct_real phase = forced ? x[PHASE] + MCT_R(0.5) * k->phase_step : 0;
    dx[1] = k->step_over_mass * smooth_force(k, effects, x[0], phase, forced ? x[TIME] + k->step.half : 0, u);
}

/* --- the exact motion --- */

/*
 * The velocity's series, from m dv/dt = F - k x - R and dx/dt = v, term by term. A block that sticks is not accelerated:
 * its load is all but friction.
 */
MCT_INLINE void phase_series(const void *constants, unsigned effects, int order, const mct_real *x,
                             mct_real u, const mct_slip *slip, mct_series *rates, mct_series *loads)
{
    const constants_t *k = constants;
    mct_real *const velocity = rates[0];
    mct_real direction = 0;
    mct_real inertia = k->step_over_mass;
    mct_real position = x[0]; /* the next term of the position, and of sine and cosine */
    mct_real s = 0, c = 0, ramp = 0;
    if (effects & MCT_COULOMB_EXACT) {
        direction = slip->direction[0];
        inertia = direction == 0 ? 0 : inertia;
    }
    if (effects & MCT_FORCING) {
        const mct_real passed = (effects & MCT_COULOMB_EXACT) ? slip->passed : 0;
        mct_sincos(x[PHASE] + passed * k->phase_step, &s, &c);
        s *= k->amplitude;
        c *= k->amplitude;
        ramp = k->ramp * (x[TIME] + passed * k->step.h);
    }
    velocity[0] = x[1];
    for (int n = 0; n < order; n++) {
        mct_real load = 0;
        if (n == 0) {
            load = steady(k, effects, position, u);
        } else if (effects & MCT_SPRING) {
            load = -k->spring * position;
        }
        if (effects & MCT_FORCING) {
            load += s; /* the n-th term of prescribed() */
            if (n == 0) {
                load += k->force + ramp;
            } else if (n == 1) {
                load += k->ramp * k->step.h;
            }
        }
        mct_real force = load;
        if (effects & MCT_COULOMB_EXACT) {
            loads[0][n] = load;
            force -= n == 0 ? direction * k->dynamic_friction : 0;
        }
        const mct_real share = mct_series_share(n);
        velocity[n + 1] = inertia * force * share;
        position = k->step.h * velocity[n] * share;
        const mct_real turned = k->phase_step * share;
        const mct_real next = turned * c;
        c = -turned * s;
        s = next;
    }
}

MCT_INLINE void exact(const constants_t *k, unsigned effects, const mct_real *x, mct_real u, mct_real *dx)
{
    if (effects & MCT_COULOMB_EXACT) {
        const mct_dry dry = {{k->static_friction}, k->belt_speed, k->rest_speed};
        mct_friction_exact(phase_series, k, dry, k->step.h, effects, k->order, 1, x, u, dx);
    } else {
        mct_series rates[1];
        phase_series(k, effects, k->order, x, u, NULL, rates, NULL);
        mct_series_increments(rates[0], k->step.h, k->order, &dx[0], &dx[1]);
    }
    finish(k, effects, x, dx);
}

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_real position = x[0];
    const mct_real v = x[1];
    const mct_real relative = v - k->belt_speed;
    mct_real forcing = 0;
    *out = (mct_evaluation){0};
    if (effects & MCT_FORCING) {
        mct_real s, c;
        mct_sincos(x[PHASE], &s, &c);
        forcing = prescribed(k, s, x[TIME]);
    }
    const mct_real smooth = steady(k, effects, position, u + forcing);
    mct_real dry = 0;
    if (!is_at_rest(k, relative)) {
        dry = -sign_of(relative) * k->dynamic_friction;
    } else if (size_of(smooth) <= k->static_friction) {
        dry = -smooth;
    } else {
        dry = -sign_of(smooth) * k->dynamic_friction;
    }
    out->M[0][0] = k->mass;
    out->tau[0] = smooth + dry;
    out->acceleration[0] = k->inverse_mass * out->tau[0];
    out->mass[0] = k->mass;
    out->position[0][0] = k->cosine * position;
    out->position[0][1] = k->sine * position;
    const mct_real along = out->tau[0] - k->weight_along;
    out->force[0][0] = k->cosine * along;
    out->force[0][1] = k->sine * along - k->weight;
    out->constraint_force[0][0] = -k->weight * k->cosine * k->sine;
    out->constraint_force[0][1] = k->weight * k->cosine * k->cosine;
    out->kinetic_energy = MCT_R(0.5) * k->mass * v * v;
    out->potential_energy = -k->weight_along * position + MCT_R(0.5) * k->spring * position * position;
    out->power_input = u * v;
    out->power[MCT_EFFECT_GRAVITY] = k->weight_along * v;
    out->power[MCT_EFFECT_SPRING] = -k->spring * position * v;
    out->power[MCT_EFFECT_FORCING] = forcing * v;
    out->power[MCT_EFFECT_COULOMB] = dry * v; /* the belt's dry belt_speed, less the heat -dry relative */
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const constants_t *k = constants;
    (void)time;
    position[0][0] = mct_hyperdual_scale(k->cosine, q[0]);
    position[0][1] = mct_hyperdual_scale(k->sine, q[0]);
    position[0][2] = mct_hyperdual_constant(0);
}

#define SWITCHES MCT_GRAVITY, MCT_SPRING, MCT_FORCING
static const uint32_t switches[] = {SWITCHES, MCT_COULOMB_MOREAU, MCT_COULOMB_EXACT, 0};

MCT_SMOOTH_KERNELS_4(seed, k->step.remainder, 1, 5, SWITCHES, MCT_COULOMB_MOREAU,
                     (mct_seed(derivative, k, k->step, effects, 1, x, u, dx), finish(k, effects, x, dx)))
MCT_SMOOTH_KERNELS_4(euler, k->step.remainder, 1, 5, SWITCHES, MCT_COULOMB_MOREAU,
                     (mct_euler(kick, k, k->step, effects, 1, x, u, dx), finish(k, effects, x, dx)))
MCT_SMOOTH_KERNELS_4(leap, k->step.remainder, 1, 5, SWITCHES, MCT_COULOMB_MOREAU,
                     (mct_leap(kick_middle, k, k->step, effects, 1, x, u, dx), finish(k, effects, x, dx)))
MCT_SMOOTH_KERNELS_4(rk4, k->step.sixth_remainder, 1, 5, SWITCHES, MCT_COULOMB_MOREAU,
                     (runge_kutta(k, effects, x, u, dx), finish(k, effects, x, dx)))
MCT_DRY_KERNELS_3(expo, k->step.remainder, 1, SWITCHES, exact(k, effects, x, u, dx))

static const mct_named_kernel *kernel(int stepper, uint32_t effects)
{
    static const mct_named_kernel *const kernels[MCT_STEPPER_COUNT] = {
        [MCT_STEPPER_SEED] = seed_kernels, [MCT_STEPPER_EULER] = euler_kernels,
        [MCT_STEPPER_LEAP] = leap_kernels, [MCT_STEPPER_RK4] = rk4_kernels,
        [MCT_STEPPER_EXPO] = expo_kernels,
    };
    return mct_switched_kernel_of(kernels, switches, stepper, effects);
}

const mct_system mct_block = {
    .name = "block",
    .doc = "a block with dry friction on a slope or a belt",
    .source = "8.2",
    .coordinate_count = 1,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .phases = phases,
    .input_without_motor = &force_field,
    .effects = MCT_GRAVITY | MCT_COULOMB | MCT_SPRING | MCT_FORCING,
    .standard_effects = MCT_GRAVITY | MCT_COULOMB_MOREAU | MCT_FORCING,
    .particle_count = 1,
    .particle_names = particle_names,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
};

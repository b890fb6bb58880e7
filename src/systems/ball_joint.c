/*
 * Ball joint: particles m at b, fixed to each other, that turn about a fixed pivot in all three ways.
 *
 * Equation      M wd + w x M w = sum x x m g - nu w,  x = r b,  M = - sum m R^2[x] = sum m (x'x - x x'),
 *               w the angular velocity in space axes. Steps are taken in principal axes: rotor.h.
 * Source        sections 4.2, 5.1 to 5.3, 5.5.1, eqs. 241-263, 297-313, 339-350.
 * Conventions   the pivot is the origin of space and of the body; q takes body axes to space axes.
 * Differences   (242) to (263), (298) to (312): thd is not the rate of the rotation vector but w; (310),
 *               (341): the masses and the minus; (348): M has no inverse with a single particle, and the sign
 *               is the other one. C = m J'Jdot = - R[w] sum m x x' is not R'[L] of (258), (301), but for what
 *               it does to w. Friction is ours.
 * Constraint    body and pivot, e = m xdd - m g, which also transmits the couple of friction.
 * Validity      body rigid. With all particles on a line through the pivot, as with a single one, there is no
 *               inertia about it: the spin about it is kept and means nothing, and friction does not act on
 *               it.
 */
#include "mctau/ball_joint.h"

#include "../steppers/rk4_plain.h"
#define MCT_SYSTEM ball_joint
#define MCT_ALWAYS MCT_ROTATION
#include "kernels.h"
#include "mctau/scene.h"
#include "rotor.h"
#include "systems.h"

typedef mct_ball_joint_constants constants_t;

enum { N = 3, Q = 0, W = 4 }; /* coordinates; places of quaternion and angular velocity in the state */

enum { GRAVITY, FRICTION = GRAVITY + 3, PARAMETERS };

static const mct_field parameters[PARAMETERS] = {
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity_1", "m/s^2", -1e4, 1e4, 0,
                                "gravitational acceleration, to the right"),
    [GRAVITY + 1] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity_2", "m/s^2", -1e4, 1e4, -9.81, "upwards"),
    [GRAVITY + 2] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity_3", "m/s^2", -1e4, 1e4, 0, "to the viewer"),
    [FRICTION] =
        MCT_COEFFICIENT(MCT_VISCOUS, "friction", "N m s", 0, 1e6, 0.0002, "viscous friction of the pivot"),
};

/* A top on its tip: three balls on a ring, 0.2 m along its second axis. */
static const double top[] = {
    0.05, 0.1,   0.2, 0,      /**/
    0.05, -0.05, 0.2, 0.0866, /**/
    0.05, -0.05, 0.2, -0.0866,
};

static const mct_row_list lists[] = {
    {.name = "particles",
     .doc = "mass and place in body axes, from the pivot, of each",
     .column_count = MCT_ROTOR_COLUMNS,
     .columns = mct_rotor_columns,
     .fewest_rows = 1,
     .most_rows = MCT_MAX_PARTICLES,
     .standard_rows = 3,
     .standard = top},
};

#define COORDINATE(axis, standard, what)                                                           \
    {                                                                                              \
        .position = MCT_QUANTITY("rotation_" axis, "rad", -1e6, 1e6, 0, "about space axis " axis), \
        .rate = MCT_QUANTITY("angular_velocity_" axis, "rad/s", -1e6, 1e6, standard, what)         \
    }

static const mct_coordinate coordinates[N] = {
    COORDINATE("1", 1, "in space axes"),
    COORDINATE("2", 30, ""),
    COORDINATE("3", 0, ""),
};

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const int count = mct_particle_count(scene);
    mct_body body;
    double moments[3];
    *k = (constants_t){0};
    const mct_status status =
        mct_rotor_prepare(scene->lists[0].values, count, false, h, &k->rotor, &body, moments);
    if (status == MCT_ERROR_SINGULAR) {
        mct_message_add(why, "parameters.particles: found ");
        mct_message_add_integer(why, count);
        mct_message_add(why, count == 1 ? ", at the pivot" : ", all at the pivot");
        mct_message_add(why, ", where they have no inertia; allowed at least one elsewhere");
        return MCT_ERROR_UNSUITED;
    }
    k->rotor.viscous = (mct_real)((scene->effects & MCT_VISCOUS) ? p[FRICTION] : 0);
    for (int i = 0; i < 3; i++) {
        double center = 0; /* along principal axis i */
        for (int j = 0; j < 3; j++) {
            center += (double)k->rotor.axes[i][j] * body.center[j];
        }
        k->first_moment[i] = (mct_real)(body.mass * center);
        k->gravity[i] = (mct_real)((scene->effects & MCT_GRAVITY) ? p[GRAVITY + i] : 0);
    }
    return status;
}

/* sum b x m r'g: of the weights, in principal axes. */
MCT_INLINE void couple_at(const constants_t *k, unsigned effects, const mct_real *q, mct_real *couple)
{
    mct_real gravity[3] = {0};
    if (effects & MCT_GRAVITY) {
        mct_rotate_back(q, k->gravity, gravity);
    }
    mct_cross(k->first_moment, gravity, couple);
}

/* --- steps in principal axes: x is the attitude and the angular velocity of these --- */

MCT_INLINE void derivative(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                           mct_real *dx)
{
    const constants_t *k = constants;
    mct_real couple[3];
    (void)u;
    couple_at(k, effects, x + Q, couple);
    mct_rotor_turn_rate(x + Q, x + W, dx + Q);
    mct_rotor_accelerate(&k->rotor, effects, couple, x + W, dx + W);
}

/* (418), and (419) with a turn. */
MCT_INLINE void seed(const constants_t *k, unsigned effects, int order, const mct_real *x, mct_real *dx)
{
    (void)order;
    const mct_step *step = &k->rotor.step;
    mct_real turn[3];
    derivative(k, effects, x, 0, dx);
    for (int i = 0; i < 3; i++) {
        turn[i] = step->h * (x[W + i] + step->half * dx[W + i]);
        dx[W + i] *= step->h;
    }
    mct_quaternion_turn_body(x + Q, turn, dx + Q);
}

/* The angular momentum by the couple, then the body turns under it. */
MCT_INLINE void euler(const constants_t *k, unsigned effects, int order, const mct_real *x, mct_real *dx)
{
    (void)order;
    mct_real couple[3], w[3], e[4], carried[3];
    couple_at(k, effects, x + Q, couple);
    mct_rotor_push(&k->rotor, effects, couple, x + W, dx + W);
    for (int i = 0; i < 3; i++) {
        w[i] = x[W + i] + dx[W + i];
    }
    mct_rotor_carry(&k->rotor, w, e, carried);
    mct_quaternion_multiply(x + Q, e, dx + Q);
    for (int i = 0; i < 3; i++) {
        dx[W + i] += carried[i];
    }
}

/* Half a turn, a kick at the middle, half a turn. */
MCT_INLINE void leap(const constants_t *k, unsigned effects, int order, const mct_real *x, mct_real *dx)
{
    (void)order;
    mct_real couple[3], w[3], middle[4], end[4], second[4];
    mct_rotor_drift(x + Q, x + W, k->rotor.step.half, dx + Q, middle);
    couple_at(k, effects, middle, couple);
    mct_rotor_kick(&k->rotor, effects, couple, x + W, dx + W);
    for (int i = 0; i < 3; i++) {
        w[i] = x[W + i] + dx[W + i];
    }
    mct_rotor_drift(middle, w, k->rotor.step.half, second, end);
    for (int i = 0; i < 4; i++) {
        dx[Q + i] += second[i];
    }
}

/* Half a kick, all of the turn, half a kick. */
MCT_INLINE void split3(const constants_t *k, unsigned effects, int order, const mct_real *x, mct_real *dx)
{
    mct_real couple[3], w[3], end[4], dw[3];
    (void)order;
    couple_at(k, effects, x + Q, couple);
    mct_rotor_half_kick(&k->rotor, effects, couple, x + W, dx + W);
    mct_rotor_split(&k->rotor, x + Q, x + W, dx + Q, dx + W);
    for (int i = 0; i < 4; i++) {
        end[i] = x[Q + i] + dx[Q + i];
    }
    for (int i = 0; i < 3; i++) {
        w[i] = x[W + i] + dx[W + i];
    }
    couple_at(k, effects, end, couple);
    mct_rotor_half_kick(&k->rotor, effects, couple, w, dw);
    for (int i = 0; i < 3; i++) {
        dx[W + i] += dw[i];
    }
}

MCT_INLINE void rk4(const constants_t *k, unsigned effects, int order, const mct_real *x, mct_real *dx)
{
    (void)order;
    mct_rk4_plain(derivative, k, k->rotor.step, effects, N, x, 0, dx);
}

/* Weight in principal axes turns back as the body turns. */
MCT_INLINE void series(const constants_t *k, unsigned effects, int order, const mct_real *x, mct_real *dx)
{
    mct_rotor_series y;
    mct_vector_series gravity;
    mct_rotor_series_start(x + Q, x + W, &y);
    if (effects & MCT_GRAVITY) {
        mct_rotate_back(x + Q, k->gravity, gravity[0]);
    }
    for (int n = 0; n < order; n++) {
        mct_real couple[3] = {0, 0, 0};
        if (effects & MCT_GRAVITY) {
            mct_cross(k->first_moment, gravity[n], couple);
            mct_rotor_series_turn_back(&k->rotor, &y, n, gravity);
        }
        mct_rotor_series_next(&k->rotor, effects, couple, n, &y);
    }
    mct_rotor_series_sum(&y, order, dx + Q, dx + W);
}

typedef void (*step_in_principal_axes)(const constants_t *k, unsigned effects, int order, const mct_real *x,
                                       mct_real *dx);

/* A step in principal axes as one in space axes: r' w' - r w = r (dw + (E - 1) w'), r' = r E, w' = w + dw. */
MCT_INLINE void in_space(step_in_principal_axes step, const constants_t *k, unsigned effects, int order,
                         const mct_real *x, mct_real *dx)
{
    mct_real own[MCT_MAX_STATES], own_change[MCT_MAX_STATES], back[4], e[4], change[3];
    mct_rotor_enter(&k->rotor, x + Q, own + Q);
    mct_rotate_back(own + Q, x + W, own + W);
    step(k, effects, order, own, own_change);
    mct_rotor_renormalise(own + Q, own_change + Q);
    mct_quaternion_inverse(own + Q, back);
    mct_quaternion_multiply(back, own_change + Q, e);
    for (int i = 0; i < 3; i++) {
        own[W + i] += own_change[W + i];
    }
    mct_turn_change(e, own + W, change);
    for (int i = 0; i < 3; i++) {
        change[i] += own_change[W + i];
    }
    mct_rotate(own + Q, change, dx + W);
    mct_rotor_leave(&k->rotor, own_change + Q, dx + Q);
}

MCT_INLINE void taylor(const void *constants, unsigned effects, int order, const mct_real *x, mct_real u,
                       mct_real *dx)
{
    (void)u;
    in_space(series, constants, effects, order, x, dx);
}

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_rotor *rotor = &k->rotor;
    const mct_real *w = x + W;
    mct_real second[3][3] = {{0}}, own[4], own_w[3], couple[3], wd[3], axis[3], momentum[3], center[3], slope;
    (void)u;
    *out = (mct_evaluation){0};
    mct_rotor_enter(rotor, x + Q, own);
    mct_rotate_back(own, w, own_w);
    couple_at(k, effects, own, couple);
    mct_rotor_accelerate(rotor, effects, couple, own_w, wd);
    mct_rotate(own, wd, out->acceleration); /* w x w = 0: the rate is the same vector in either axes */
    for (int n = 0; n < rotor->count; n++) {
        mct_real *at = out->position[n];
        mct_real xdd[3];
        out->mass[n] = rotor->mass[n];
        mct_rotate(x + Q, rotor->arm[n], at);
        mct_turning_acceleration(w, out->acceleration, at, xdd);
        for (int i = 0; i < 3; i++) {
            out->force[n][i] = rotor->mass[n] * k->gravity[i];
            out->constraint_force[n][i] = rotor->mass[n] * (xdd[i] - k->gravity[i]);
            for (int j = 0; j < 3; j++) {
                second[i][j] += rotor->mass[n] * at[i] * at[j];
            }
        }
    }
    /* M = tr S - S, C = - R[w] S, S = sum m x x' */
    for (int j = 0; j < 3; j++) {
        mct_real column[3];
        mct_cross(w, second[j], column);
        for (int i = 0; i < 3; i++) {
            out->M[i][j] = (i == j ? second[(j + 1) % 3][(j + 1) % 3] + second[(j + 2) % 3][(j + 2) % 3]
                                   : -second[i][j]);
            out->C[i][j] = -column[i];
        }
    }
    for (int i = 0; i < 3; i++) {
        momentum[i] = mct_dot(out->M[i], w);
    }
    mct_cross(w, momentum, out->Cv);
    mct_rotate(own, k->first_moment, center);
    mct_cross(center, k->gravity, out->tau);
    out->power[MCT_EFFECT_GRAVITY] = mct_dot(out->tau, w);
    mct_rotate(x + Q, rotor->idle_axis, axis);
    const mct_real damping = mct_damping(effects, rotor->viscous, 0, w, &slope);
    const mct_real idle = mct_dot(axis, w);
    for (int i = 0; i < 3; i++) {
        const mct_real friction_torque = -damping * (w[i] - idle * axis[i]);
        out->tau[i] += friction_torque;
        out->power[MCT_EFFECT_VISCOUS] += friction_torque * w[i];
    }
    out->kinetic_energy = MCT_R(0.5) * mct_dot(w, momentum);
    out->potential_energy = 0 - mct_dot(center, k->gravity); /* not -0 */
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const constants_t *k = constants;
    (void)time;
    mct_rotor_place(&k->rotor, q + Q, position);
}

#define friction mct_no_friction
#define SWITCHES MCT_GRAVITY, MCT_VISCOUS
static const uint32_t switches[] = {SWITCHES, 0};

MCT_KERNELS_2(seed, k->rotor.step.remainder, N, SWITCHES, in_space(seed, k, effects, 0, x, dx))
MCT_KERNELS_2(euler, k->rotor.step.remainder, N, SWITCHES, in_space(euler, k, effects, 0, x, dx))
MCT_KERNELS_2(leap, k->rotor.step.remainder, N, SWITCHES, in_space(leap, k, effects, 0, x, dx))
MCT_KERNELS_2(rk4, k->rotor.step.sixth_remainder, N, SWITCHES, in_space(rk4, k, effects, 0, x, dx))
MCT_KERNELS_2(split3, k->rotor.step.remainder, N, SWITCHES, in_space(split3, k, effects, 0, x, dx))
MCT_TAYLOR_KERNELS_2(k->rotor.step.remainder, N, 2, MCT_GRAVITY, MCT_VISCOUS)

static const mct_named_kernel *kernel(int stepper, uint32_t effects)
{
    static const mct_named_kernel *const kernels[MCT_STEPPER_COUNT] = {
        [MCT_STEPPER_SEED] = seed_kernels,     [MCT_STEPPER_EULER] = euler_kernels,
        [MCT_STEPPER_LEAP] = leap_kernels,     [MCT_STEPPER_RK4] = rk4_kernels,
        [MCT_STEPPER_SPLIT3] = split3_kernels, MCT_TAYLOR_ROWS,
    };
    return mct_switched_kernel_of(kernels, switches, stepper, effects);
}

const mct_system mct_ball_joint = {
    .name = "ball_joint",
    .doc = "particles, fixed to each other, on a pivot that lets them turn in all three ways",
    .source = "4.2, 5, 5.5.1",
    .coordinate_count = N,
    .coordinates = coordinates,
    .attitude = MCT_ATTITUDE_SPACE,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .list_count = 1,
    .lists = lists,
    .lists_particles = true,
    .effects = MCT_GRAVITY | MCT_VISCOUS,
    .standard_effects = MCT_GRAVITY | MCT_VISCOUS,
    .particle_names = mct_particle_numbers,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
};

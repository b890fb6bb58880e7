/*
 * Rotating frame: a point mass m seen from axes that turn, the cannon on a platform and the Coriolis fountain.
 *
 * Equation      x = r q,  r = exp(R[u]),  u = t w0 + t^2/2 al0:  q the position in the frame, x that in space;
 *                   m a + m [w x (w x q) + 2 w x v + wd x q] = r' (f + weight) + drag,
 *               centrifugal, Coriolis and Euler term in this order; w and wd are the angular velocity of the frame and
 *               its rate, in the frame's axes:
 *                   w = J_r(u) ud,   J_r = 1 - c2 R[u] + c3 R^2[u],
 *               c1 = sin |u| / |u|, c2 = (1 - cos |u|) / |u|^2, c3 = (|u| - sin |u|) / |u|^3 (Stumpff's functions).
 *               Where w0 and al0 have one direction, w = w0 + t al0 and wd = al0.
 * Source        section 4.4, eqs. 276-287.
 * Conventions   At t = 0 the frame lies on the space axes, turns with w0 (angular_velocity) and gains al0
 *               (angular_acceleration). Weight is along -2 in space. The air is at rest in space: drag is against
 *               v + w x q, the velocity in space. R[u] y is u x y here.
 * Differences   (277)-(287) take the rate of u for the angular velocity, right for a u of fixed direction alone;
 *               the Euler force below (286) lacks the factor m. Drag and weight are ours.
 * Constraint    none that a force would keep: e = m xdd - f is 0. With an apparent force left out, e is what would have
 *               to act on the mass for it to move like that.
 * Energies      are those in space, where apparent forces do no work. Their powers are those in the frame, where Coriolis'
 *               has none; power_frame is what the power of e leaves of them.
 * State         the time is kept in x[6] (MCT_TIMED).
 * Validity      any rotation; in single precision the frame's angle is known to 6e-8 of itself.
 */
#include "mctau/rotating_frame.h"

#include "../steppers/euler.h"
#include "../steppers/leap.h"
#include "../steppers/rk4_plain.h"
#include "../steppers/seed.h"
#define MCT_SYSTEM rotating_frame
#define MCT_ALWAYS MCT_TIMED
#include "kernels.h"
#include "mctau/matrix.h"
#include "mctau/rotation.h"
#include "mctau/scene.h"
#include "mctau/sincos.h"
#include "systems.h"

typedef mct_rotating_frame_constants constants_t;

enum { N = 3, TIME = 2 * N };

enum {
    MASS,
    VELOCITY,
    ACCELERATION = VELOCITY + 3,
    FORCE = ACCELERATION + 3,
    GRAVITY = FORCE + 3,
    DRAG,
    PARAMETERS
};

#define LARGEST_SPIN 1e5

static const mct_field parameters[PARAMETERS] = {
    [MASS] = MCT_QUANTITY("mass", "kg", 1e-6, 1e6, 1, "point mass"),
    [VELOCITY] = MCT_QUANTITY("angular_velocity_1", "rad/s", -LARGEST_SPIN, LARGEST_SPIN, 0,
                              "of the frame at the start, axis 1 (right)"),
    [VELOCITY + 1] =
        MCT_QUANTITY("angular_velocity_2", "rad/s", -LARGEST_SPIN, LARGEST_SPIN, 0, "axis 2 (up)"),
    [VELOCITY + 2] =
        MCT_QUANTITY("angular_velocity_3", "rad/s", -LARGEST_SPIN, LARGEST_SPIN, 1, "axis 3 (to the viewer)"),
    [ACCELERATION] = MCT_QUANTITY("angular_acceleration_1", "rad/s^2", -LARGEST_SPIN, LARGEST_SPIN, 0,
                                  "of the frame at the start: its rotation vector is t w0 + t^2/2 al0"),
    [ACCELERATION + 1] =
        MCT_QUANTITY("angular_acceleration_2", "rad/s^2", -LARGEST_SPIN, LARGEST_SPIN, 0, "axis 2"),
    [ACCELERATION + 2] =
        MCT_QUANTITY("angular_acceleration_3", "rad/s^2", -LARGEST_SPIN, LARGEST_SPIN, 0, "axis 3"),
    [FORCE] = MCT_QUANTITY("force_1", "N", -1e6, 1e6, 0, "on the mass, along axis 1 of space"),
    [FORCE + 1] = MCT_QUANTITY("force_2", "N", -1e6, 1e6, 0, "along axis 2 of space"),
    [FORCE + 2] = MCT_QUANTITY("force_3", "N", -1e6, 1e6, 0, "along axis 3 of space"),
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity", "m/s^2", 0, 1e4, 9.81,
                                "gravitational acceleration, against axis 2 of space"),
    [DRAG] = MCT_COEFFICIENT(MCT_DRAG, "drag", "N s^2/m^2", 0, 1e6, 0.01,
                             "of air at rest in space, by the square of the speed"),
};

#define COORDINATE(name, rate_name, at_start, rate_at_start)                                     \
    {                                                                                            \
        .position = MCT_QUANTITY(name, "m", -1e6, 1e6, at_start, "in the rotating frame"),       \
        .rate = MCT_QUANTITY(rate_name, "m/s", -1e6, 1e6, rate_at_start, "as seen in the frame") \
    }
static const mct_coordinate coordinates[N] = {
    COORDINATE("position_1", "velocity_1", 0, 0),
    COORDINATE("position_2", "velocity_2", -1, 1),
    COORDINATE("position_3", "velocity_3", 0, 0),
};

static const char *const particle_names[] = {"ball"};

static double dot_of(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const double *w0 = p + VELOCITY;
    const double *al0 = p + ACCELERATION;
    const double gravity = (scene->effects & MCT_GRAVITY) ? p[GRAVITY] : 0;
    const double drag = (scene->effects & MCT_DRAG) ? p[DRAG] : 0;
    const double spin = mct_sqrt(dot_of(w0, w0));
    const double gain = mct_sqrt(dot_of(al0, al0));
    const double *along = spin > 0 ? w0 : al0;
    const double length = spin > 0 ? spin : gain;
    double across = 0; /* of al0, to its axis */
    (void)why;
    k->step = mct_step_of(h);
    k->mass = (mct_real)p[MASS];
    k->gravity = (mct_real)gravity;
    k->drag = (mct_real)drag;
    k->drag_by_mass = (mct_real)(drag / p[MASS]);
    k->is_pushed = false;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const int l = (i + 2) % 3;
        const double axis = length > 0 ? along[i] / length : i == 2 ? 1 : 0;
        const double turn = length > 0 ? (along[j] * al0[l] - along[l] * al0[j]) / length : 0;
        const double push = p[FORCE + i] / p[MASS] - (i == 1 ? gravity : 0);
        across += turn * turn;
        k->axis[i] = (mct_real)axis;
        k->angular_velocity[i] = (mct_real)w0[i];
        k->angular_acceleration[i] = (mct_real)al0[i];
        k->force[i] = (mct_real)p[FORCE + i];
        k->push[i] = (mct_real)push;
        k->is_pushed = k->is_pushed || push != 0;
    }
    k->has_fixed_axis = mct_sqrt(across) <= 1e-15 * gain;
    k->spin = (mct_real)spin;
    k->spin_rate = (mct_real)(length > 0 ? dot_of(al0, along) / length : 0);
    return MCT_OK;
}

/* --- the frame --- */

/* The frame at one time, all in its own axes. */
typedef struct {
    mct_real angular_velocity[3];
    mct_real angular_acceleration[3];
    mct_real push[3]; /* r' (force and weight) / m; not written when there is none */
} frame_t;

/* turned = r' y = y - c1 u x y + c2 u x (u x y), from space axes to the frame's. */
MCT_INLINE void turn_back(const mct_real *u, mct_real c1, mct_real c2, const mct_real *y, mct_real *turned)
{
    mct_real once[3], twice[3];
    mct_cross(u, y, once);
    mct_cross(u, once, twice);
    for (int i = 0; i < 3; i++) {
        turned[i] = y[i] + (c2 * twice[i] - c1 * once[i]);
    }
}

/* The rotation vector and its rate. */
MCT_INLINE void rotation_at(const constants_t *k, mct_real t, mct_real *u, mct_real *ud)
{
    for (int i = 0; i < 3; i++) {
        u[i] = t * (k->angular_velocity[i] + MCT_R(0.5) * t * k->angular_acceleration[i]);
        ud[i] = k->angular_velocity[i] + t * k->angular_acceleration[i];
    }
}

static void frame_about_any_axis(const constants_t *k, mct_real t, frame_t *frame)
{
    mct_real u[3], ud[3], p[3], up[3], pd[3], udp[3], upd[3];
    mct_real c[7];
    const mct_real *udd = k->angular_acceleration;
    rotation_at(k, t, u, ud);
    mct_stumpff(mct_dot(u, u), c);
    const mct_real half_s_rate = mct_dot(u, ud);
    const mct_real c2_rate = (2 * c[4] - c[3]) * half_s_rate;
    const mct_real c3_rate = (3 * c[5] - c[4]) * half_s_rate;
    mct_cross(u, ud, p);
    mct_cross(u, p, up);
    mct_cross(u, udd, pd);
    mct_cross(ud, p, udp);
    mct_cross(u, pd, upd);
    for (int i = 0; i < 3; i++) {
        frame->angular_velocity[i] = ud[i] - c[2] * p[i] + c[3] * up[i];
        frame->angular_acceleration[i] =
            udd[i] - c2_rate * p[i] - c[2] * pd[i] + c3_rate * up[i] + c[3] * (udp[i] + upd[i]);
    }
    turn_back(u, c[1], c[2], k->push, frame->push);
}

MCT_INLINE void frame_at(const constants_t *k, unsigned effects, mct_real t, frame_t *frame)
{
    if (!k->has_fixed_axis) {
        frame_about_any_axis(k, t, frame);
        return;
    }
    for (int i = 0; i < 3; i++) {
        frame->angular_velocity[i] = k->angular_velocity[i] + t * k->angular_acceleration[i];
        frame->angular_acceleration[i] = k->angular_acceleration[i];
    }
    if ((effects & MCT_GRAVITY) || k->is_pushed) {
        mct_real s, c;
        mct_sincos(t * (k->spin + MCT_R(0.5) * t * k->spin_rate), &s, &c);
        turn_back(k->axis, s, 1 - c, k->push, frame->push);
    }
}

/* --- the right-hand side --- */

/* w: angular velocity of the frame; out: velocity in space, in the frame's axes. */
MCT_INLINE void space_velocity(const mct_real *w, const mct_real *x, mct_real *out)
{
    mct_cross(w, x, out);
    for (int i = 0; i < N; i++) {
        out[i] += x[N + i];
    }
}

/* Accelerations, and what drag takes of each velocity, drag speed / m [1/s]. */
MCT_INLINE void accelerate(const constants_t *k, unsigned effects, const frame_t *frame, const mct_real *x,
                           mct_real *a, mct_real *drag_rate)
{
    const mct_real *w = frame->angular_velocity;
    mct_real along[3], across[3];
    for (int i = 0; i < N; i++) {
        a[i] = ((effects & MCT_GRAVITY) || k->is_pushed) ? frame->push[i] : 0;
    }
    *drag_rate = 0;
    if (effects & MCT_CENTRIFUGAL) {
        mct_cross(w, x, along);
        mct_cross(w, along, across);
        for (int i = 0; i < N; i++) {
            a[i] -= across[i];
        }
    }
    if (effects & MCT_CORIOLIS) {
        mct_cross(w, x + N, along);
        for (int i = 0; i < N; i++) {
            a[i] -= 2 * along[i];
        }
    }
    if (effects & MCT_EULER_FORCE) {
        mct_cross(frame->angular_acceleration, x, along);
        for (int i = 0; i < N; i++) {
            a[i] -= along[i];
        }
    }
    if (effects & MCT_DRAG) {
        space_velocity(w, x, along);
        *drag_rate = k->drag_by_mass * mct_sqrt_real(mct_dot(along, along));
        for (int i = 0; i < N; i++) {
            a[i] -= *drag_rate * along[i];
        }
    }
}

MCT_INLINE void derivative(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                           mct_real *dx)
{
    const constants_t *k = constants;
    frame_t frame;
    mct_real drag_rate;
    (void)u;
    frame_at(k, effects, x[TIME], &frame);
    accelerate(k, effects, &frame, x, dx + N, &drag_rate);
    for (int i = 0; i < N; i++) {
        dx[i] = x[N + i];
    }
    dx[TIME] = 1;
}

/*
 * Velocity increment of a step, the Coriolis force at the new velocity (`share` 1: euler) or at the mean of both (1/2:
 * leap), |v| v as |v| v': the matrix is that of d + b cross, whose inverse is known.
 */
MCT_INLINE void kick(const constants_t *k, unsigned effects, mct_real t, const mct_real *x, mct_real share,
                     mct_real *dx)
{
    frame_t frame;
    mct_real a[3], drag_rate, b[3], turned[3];
    frame_at(k, effects, t, &frame);
    accelerate(k, effects, &frame, x, a, &drag_rate);
    dx[TIME] = k->step.h;
    const mct_real d = (effects & MCT_DRAG) ? 1 + k->step.h * drag_rate : 1;
    if (!(effects & MCT_CORIOLIS)) {
        for (int i = 0; i < N; i++) {
            dx[N + i] = k->step.h * a[i] / d;
        }
        return;
    }
    for (int i = 0; i < N; i++) {
        a[i] *= k->step.h;
        b[i] = 2 * share * k->step.h * frame.angular_velocity[i];
    }
    const mct_real inverse = 1 / (d * d + mct_dot(b, b));
    const mct_real along = mct_dot(b, a) / d;
    mct_cross(b, a, turned);
    for (int i = 0; i < N; i++) {
        dx[N + i] = inverse * (d * a[i] - turned[i] + along * b[i]);
    }
}

MCT_INLINE void kick_implicit(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                              mct_real *dx)
{
    (void)u;
    kick(constants, effects, x[TIME], x, 1, dx);
}

/* The positions in x are those at the middle of the step; the time is not. */
MCT_INLINE void kick_symmetric(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                               mct_real *dx)
{
    const constants_t *k = constants;
    (void)u;
    kick(k, effects, x[TIME] + k->step.half, x, MCT_R(0.5), dx);
}

/* turned = (r1' r0 - 1) y, where r0 and r1 are the frame at the beginning and at the end of the step. */
MCT_INLINE void turn_on(const constants_t *k, mct_real t, const mct_real *y, mct_real *turned)
{
    if (k->has_fixed_axis) {
        mct_real s, c, once[3], twice[3];
        mct_sincos(k->step.half * (k->spin + (t + k->step.half) * k->spin_rate), &s, &c); /* half the angle */
        mct_cross(k->axis, y, once);
        mct_cross(k->axis, once, twice);
        for (int i = 0; i < 3; i++) {
            turned[i] = 2 * s * (s * twice[i] - c * once[i]);
        }
        return;
    }
    mct_real u[3], ud[3], c[7], space[3];
    rotation_at(k, t, u, ud);
    mct_stumpff(mct_dot(u, u), c);
    turn_back(u, -c[1], c[2], y, space); /* r0 y */
    rotation_at(k, t + k->step.h, u, ud);
    mct_stumpff(mct_dot(u, u), c);
    turn_back(u, c[1], c[2], space, turned);
    for (int i = 0; i < 3; i++) {
        turned[i] -= y[i];
    }
}

/*
 * The exact flow: in space the mass runs a parabola. With E = r1' r0 - 1, velocity z = v + w x q in space and
 * acceleration p, both in the axes of the beginning,
 *     dq = E q + (1 + E) (h z + h^2/2 p),    dv = E z + (1 + E) h p - (w1 - w0) x q - w1 x dq.
 */
MCT_INLINE void flow(const constants_t *k, unsigned effects, const mct_real *x, mct_real *dx)
{
    const mct_real h = k->step.h;
    const bool pushed = (effects & MCT_GRAVITY) || k->is_pushed;
    frame_t begin, end;
    mct_real z[3], path[3], change[3], turned[3], gain[3], turn[3];
    frame_at(k, effects, x[TIME], &begin);
    frame_at(k, effects, x[TIME] + h, &end);
    space_velocity(begin.angular_velocity, x, z);
    for (int i = 0; i < N; i++) {
        const mct_real p = pushed ? begin.push[i] : 0;
        path[i] = h * (z[i] + k->step.half * p);
        turned[i] = x[i] + path[i];
        change[i] = z[i] + h * p;
        gain[i] = h * p;
        turn[i] = k->has_fixed_axis ? h * k->angular_acceleration[i] /* no difference of rounded numbers */
                                    : end.angular_velocity[i] - begin.angular_velocity[i];
    }
    turn_on(k, x[TIME], turned, dx);
    turn_on(k, x[TIME], change, dx + N);
    for (int i = 0; i < N; i++) {
        dx[i] += path[i];
    }
    mct_cross(turn, x, turned);
    mct_cross(end.angular_velocity, dx, path);
    for (int i = 0; i < N; i++) {
        dx[N + i] += gain[i] - turned[i] - path[i];
    }
    dx[TIME] = h;
}

/* --- all that the equation says --- */

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_real *w;
    frame_t frame;
    mct_real rotation[3], rotation_rate[3], c[7], z[3], term[3], centrifugal[3], euler[3], drag_rate;
    (void)u;
    *out = (mct_evaluation){0};
    frame_about_any_axis(k, x[TIME], &frame);
    rotation_at(k, x[TIME], rotation, rotation_rate);
    mct_stumpff(mct_dot(rotation, rotation), c);
    w = frame.angular_velocity;
    accelerate(k, effects | (k->is_pushed ? MCT_GRAVITY : 0), &frame, x, out->acceleration, &drag_rate);
    space_velocity(w, x, z);
    mct_cross(w, x, term);
    mct_cross(w, term, centrifugal);
    mct_cross(frame.angular_acceleration, x, euler);
    mct_cross(w, x + N, term);
    mct_real missing[3], space[3], weight[3] = {0, -k->mass * k->gravity, 0}, force[3];
    for (int i = 0; i < N; i++) {
        const mct_real kept = ((effects & MCT_CENTRIFUGAL) ? centrifugal[i] : 0) +
                              ((effects & MCT_CORIOLIS) ? 2 * term[i] : 0) +
                              ((effects & MCT_EULER_FORCE) ? euler[i] : 0);
        missing[i] = k->mass * ((centrifugal[i] + 2 * term[i] + euler[i]) - kept);
        out->M[i][i] = k->mass;
        out->Cv[i] = k->mass * kept;
        out->tau[i] = k->mass * (out->acceleration[i] + kept);
    }
    if (effects &
        MCT_CORIOLIS) { /* m J' Jdot: half of the Coriolis term; the other half is of explicit time */
        const mct_real skew[3][3] = {{0, -w[2], w[1]}, {w[2], 0, -w[0]}, {-w[1], w[0], 0}};
        for (int i = 0; i < N; i++) {
            for (int j = 0; j < N; j++) {
                out->C[i][j] = k->mass * skew[i][j];
            }
        }
    }
    out->mass[0] = k->mass;
    turn_back(rotation, -c[1], c[2], x, out->position[0]);
    turn_back(rotation, -c[1], c[2], missing, out->constraint_force[0]);
    turn_back(rotation, -c[1], c[2], z, space);
    turn_back(rotation, c[1], c[2], k->force, force);
    for (int i = 0; i < N; i++) {
        out->force[0][i] = k->force[i] + weight[i] - k->mass * drag_rate * space[i];
    }
    out->kinetic_energy = MCT_R(0.5) * k->mass * mct_dot(z, z);
    out->potential_energy = -weight[1] * out->position[0][1];
    out->power_input = mct_dot(force, z);
    out->power[MCT_EFFECT_GRAVITY] = weight[1] * space[1];
    out->power[MCT_EFFECT_DRAG] = -k->mass * drag_rate * mct_dot(z, z);
    if (effects & MCT_CENTRIFUGAL) {
        out->power[MCT_EFFECT_CENTRIFUGAL] = -k->mass * mct_dot(centrifugal, x + N);
    }
    if (effects & MCT_EULER_FORCE) {
        out->power[MCT_EFFECT_EULER] = -k->mass * mct_dot(euler, x + N);
    }
    out->power_frame =
        mct_dot(missing, z) - (out->power[MCT_EFFECT_CENTRIFUGAL] + out->power[MCT_EFFECT_EULER]);
}

static mct_hyperdual product(mct_hyperdual a, mct_hyperdual b)
{
    return mct_hyperdual_mul(a, b);
}

static void place_cross(const mct_hyperdual *a, const mct_hyperdual *b, mct_hyperdual *out)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const int l = (i + 2) % 3;
        out[i] = mct_hyperdual_sub(product(a[j], b[l]), product(a[l], b[j]));
    }
}

/* x = q + c1 u x q + c2 u x (u x q); of a Stumpff function, 2 dc[n]/ds = n c[n+2] - c[n+1]. */
static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const constants_t *k = constants;
    mct_hyperdual u[3], once[3], twice[3];
    mct_hyperdual s = mct_hyperdual_constant(0);
    mct_real c[7];
    for (int i = 0; i < 3; i++) {
        const mct_hyperdual mean =
            mct_hyperdual_add(mct_hyperdual_constant(k->angular_velocity[i]),
                              mct_hyperdual_scale(MCT_R(0.5) * k->angular_acceleration[i], time));
        u[i] = product(time, mean);
        s = mct_hyperdual_add(s, product(u[i], u[i]));
    }
    mct_stumpff(s.value, c);
    const mct_hyperdual c1 = mct_hyperdual_compose(s, c[1], MCT_R(0.5) * (c[3] - c[2]),
                                                   MCT_R(0.25) * (3 * c[5] - 3 * c[4] + c[3]));
    const mct_hyperdual c2 = mct_hyperdual_compose(s, c[2], MCT_R(0.5) * (2 * c[4] - c[3]),
                                                   MCT_R(0.25) * (8 * c[6] - 5 * c[5] + c[4]));
    place_cross(u, q, once);
    place_cross(u, once, twice);
    for (int i = 0; i < 3; i++) {
        position[0][i] =
            mct_hyperdual_add(q[i], mct_hyperdual_add(product(c1, once[i]), product(c2, twice[i])));
    }
}

#define SWITCHES MCT_GRAVITY, MCT_DRAG, MCT_CENTRIFUGAL, MCT_CORIOLIS, MCT_EULER_FORCE
static const uint32_t switches[] = {SWITCHES, 0};
#define APPARENT (MCT_CENTRIFUGAL | MCT_CORIOLIS | MCT_EULER_FORCE)
#define friction mct_no_friction

MCT_KERNELS_5(seed, k->step.remainder, N, SWITCHES, mct_seed(derivative, k, k->step, effects, N, x, u, dx))
MCT_KERNELS_5(euler, k->step.remainder, N, SWITCHES,
              mct_euler(kick_implicit, k, k->step, effects, N, x, u, dx))
MCT_KERNELS_5(leap, k->step.remainder, N, SWITCHES,
              mct_leap(kick_symmetric, k, k->step, effects, N, x, u, dx))
MCT_KERNELS_5(rk4, k->step.sixth_remainder, N, SWITCHES,
              mct_rk4_plain(derivative, k, k->step, effects, N, x, u, dx))
/* In space the mass is free, if nothing is left out and no air slows it: the last three switches and perhaps gravity. */
MCT_INCREMENTS(expo, flow(k, effects, x, dx))
MCT_PAIR(expo, k->step.remainder, N, exact, APPARENT, MCT_GRAVITY)
static const mct_named_kernel expo_kernels[32] = {[28] = MCT_PAIR_NAMES(expo, exact)};

static const mct_named_kernel *kernel(int stepper, uint32_t effects)
{
    static const mct_named_kernel *const kernels[MCT_STEPPER_COUNT] = {
        [MCT_STEPPER_SEED] = seed_kernels, [MCT_STEPPER_EULER] = euler_kernels,
        [MCT_STEPPER_LEAP] = leap_kernels, [MCT_STEPPER_RK4] = rk4_kernels,
        [MCT_STEPPER_EXPO] = expo_kernels,
    };
    return mct_switched_kernel_of(kernels, switches, stepper, effects);
}

const mct_system mct_rotating_frame = {
    .name = "rotating_frame",
    .doc = "a point mass seen from a rotating frame: the cannon and the Coriolis fountain",
    .source = "4.4",
    .coordinate_count = N,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .is_timed = true,
    .input_without_motor = NULL,
    .effects = MCT_GRAVITY | MCT_DRAG | APPARENT,
    .standard_effects = APPARENT,
    .particle_count = 1,
    .particle_names = particle_names,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
};

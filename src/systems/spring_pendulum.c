/*
 * Spring pendulum: a ball of mass m slides on a rod that turns about a fixed pivot; a spring of stiffness k and rest
 * length l0 pulls it along the rod.
 *
 * Equation      M(q) a + C(q,v) v = tau,  q = (r, th),  v = (rd, w):
 *                   [ m   0     ]        [ -m r w^2   ]         [ -k (r - l0) - k1 rd - m g sin th ]
 *               M = [ 0   m r^2 ]  C v = [ 2 m r rd w ]   tau = [ torque - k2 w - m g r cos th     ]
 * Source        section 1.3, eqs. 40-53.
 * Conventions   r from the pivot, positive; th counterclockwise from axis 1, -pi/2 hangs.
 * Differences   none in the equations; the rest length is ours, the source has l0 = 0. Weight, spring and k1 are
 *               forces on the ball; torque and k2 are couples, which the rod transmits.
 * Constraint    the rod, e = m xdd - (weight + spring + friction along the rod): (torque - k2 w) / r across it.
 * Integration   M is singular at r = 0, where the ball may pass, the motion is not. `rk4` and the series up to order 8 integrate
 *               the equation as it stands where a step stays away from the pivot (stays_away). Else, and always with
 *               `taylor12`, `euler` and `leap`, a step is made in Cartesian coordinates along and
 *               across the rod as it stands at its start,
 *                   xdd = g' - k/m (1 - l0/R) X - k1/m (X.xd) X / R^2 + (torque - k2 w) / (m R^2) (-X2, X1),
 *               and its increments are turned into polar ones without a difference of large numbers. A ball that
 *               passes the pivot comes out on the other side: r stays positive, th jumps by half a turn.
 *               `split3` takes the motion along the rod exactly, between halves of all else, in polar coordinates.
 * Validity      m, k > 0; steps short against sqrt(m/k) and m/k1, but with `split3`: else refused. With k2 or a torque the equation has no
 *               limit at r = 0: starting where a step does not resolve it is refused, a step that leads there fails
 *               (mct_plant.diverged_ticks). With l0 > 0 the spring's force jumps at r = 0: `rk4` and the series pass
 *               it in parts of a step (rk4_in_frame); a step of `euler` or `leap` across it is of first order.
 */
#include "mctau/spring_pendulum.h"

#include "../steppers/euler.h"
#include "../steppers/leap.h"
#include "../steppers/rk4.h"
#include "../steppers/rk4_plain.h"
#include "../steppers/seed.h"
#include "../steppers/taylor.h"
#define MCT_SYSTEM spring_pendulum
#include "kernels.h"
#include "mctau/arctan.h"
#include "mctau/matrix.h"
#include "mctau/scene.h"
#include "mctau/sincos.h"
#include "systems.h"

typedef mct_spring_pendulum_constants constants_t;

enum { MASS, STIFFNESS, REST_LENGTH, LENGTH_FRICTION, ANGLE_FRICTION, GRAVITY, PARAMETERS };

static const mct_field parameters[PARAMETERS] = {
    [MASS] = MCT_QUANTITY("mass", "kg", 1e-6, 1e6, 0.5, "ball"),
    [STIFFNESS] = MCT_COEFFICIENT(MCT_SPRING, "stiffness", "N/m", 0, 1e9, 40, "of the spring"),
    [REST_LENGTH] =
        MCT_COEFFICIENT(MCT_SPRING, "rest_length", "m", 0, 1e4, 0.3, "of the spring; 0 in the source"),
    [LENGTH_FRICTION] = MCT_COEFFICIENT(MCT_VISCOUS, "length_friction", "N s/m", 0, 1e6, 0.02,
                                        "viscous friction along the rod"),
    [ANGLE_FRICTION] = MCT_COEFFICIENT(MCT_VISCOUS, "angle_friction", "N m s", 0, 1e6, 0.001,
                                       "viscous friction of the pivot"),
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity", "m/s^2", 0, 1e4, 9.81, "gravitational acceleration"),
};

static const mct_coordinate coordinates[2] = {
    {.position = MCT_QUANTITY("length", "m", 1e-6, 1e6, 0.42, "pivot to ball"),
     .rate = MCT_QUANTITY("length_rate", "m/s", -1e6, 1e6, 0, "")},
    {.position = MCT_QUANTITY("angle", "rad", -1e6, 1e6, 0, "counterclockwise from horizontal"),
     .rate = MCT_QUANTITY("angle_rate", "rad/s", -1e6, 1e6, 0, ""),
     .is_angle = true},
};

static const mct_field torque_field = MCT_QUANTITY("torque", "N m", -1e9, 1e9, 0, "on the rod");
static const char *const particle_names[] = {"ball"};

/* What a step resolves, each as a number without unit. */
#define LONGEST_PHASE    2.0   /* h sqrt(k/m): `euler` and `leap` are unstable beyond, `rk4` at 2.8 */
#define LONGEST_DAMPING  2.0   /* h k1/m */
#define FASTEST_FRICTION 1.0   /* h k2/(m r^2) */
#define FASTEST_TORQUE   0.1   /* h^2 torque/(m r^2) */
#define PIVOT_SQUARE     1e-24 /* [m^2] this near, polar coordinates say nothing about the velocity */

/* A step that is rarely taken: one function for all effects, for which the others keep no registers free. */
#if defined __GNUC__
#define RARE static __attribute__((noinline, cold))
#else
#define RARE static
#endif

static mct_status refuse(struct mct_message *why, const char *key, double found, const char *unit,
                         const char *reason, double allowed)
{
    mct_message_add(why, key);
    mct_message_add(why, ": found ");
    mct_message_add_number(why, found);
    mct_message_add(why, unit);
    mct_message_add(why, reason);
    mct_message_add_number(why, allowed);
    mct_message_add(why, unit);
    return MCT_ERROR_RANGE;
}

static mct_status check(const struct mct_scene *scene, double h, struct mct_message *why)
{
    const double *p = scene->parameters;
    const double m = p[MASS];
    const double r = scene->initial[0];
    const bool viscous = scene->effects & MCT_VISCOUS;
    const double stiffest = m * (LONGEST_PHASE / h) * (LONGEST_PHASE / h);
    const double densest = m * LONGEST_DAMPING / h;
    const double roughest = FASTEST_FRICTION * m * r * r / h;
    const bool is_exact = scene->stepper == MCT_STEPPER_SPLIT3; /* along the rod */
    if ((scene->effects & MCT_SPRING) && p[STIFFNESS] > stiffest && !is_exact) {
        return refuse(
            why, "parameters.stiffness", p[STIFFNESS], " N/m",
            ", an oscillation too fast for a step of this length; allowed any with split3, else up to ",
            stiffest);
    }
    if (viscous && p[LENGTH_FRICTION] > densest && !is_exact) {
        return refuse(why, "parameters.length_friction", p[LENGTH_FRICTION], " N s/m",
                      ", a decay too fast for a step of this length; allowed any with split3, else up to ",
                      densest);
    }
    if (!(r > 0)) {
        return refuse(why, "initial.length", r, " m", ", where the angle says nothing; allowed above ", 0);
    }
    if (viscous && p[ANGLE_FRICTION] > roughest) {
        return refuse(why, "initial.length", r, " m",
                      ", where angle_friction acts too fast for a step of this length; allowed from ",
                      mct_sqrt(h * p[ANGLE_FRICTION] / (FASTEST_FRICTION * m)));
    }
    return MCT_OK;
}

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const double m = p[MASS];
    const bool viscous = scene->effects & MCT_VISCOUS;
    const double stiffness = (scene->effects & MCT_SPRING) ? p[STIFFNESS] : 0;
    const double length_viscous = viscous ? p[LENGTH_FRICTION] : 0;
    const double angle_viscous = viscous ? p[ANGLE_FRICTION] : 0;
    k->step = mct_step_of(h);
    k->mass = (mct_real)m;
    k->inverse_mass = (mct_real)(1 / m);
    k->stiffness = (mct_real)stiffness;
    k->rest_length = (mct_real)((scene->effects & MCT_SPRING) ? p[REST_LENGTH] : 0);
    k->length_viscous = (mct_real)length_viscous;
    k->angle_viscous = (mct_real)angle_viscous;
    k->gravity = (mct_real)((scene->effects & MCT_GRAVITY) ? p[GRAVITY] : 0);
    k->stiffness_rate = (mct_real)(stiffness / m);
    k->rest_rate = (mct_real)(stiffness * p[REST_LENGTH] / m);
    k->length_damping = (mct_real)(length_viscous / m);
    k->angle_damping = (mct_real)(angle_viscous / m);
    k->near_friction = (mct_real)(h * angle_viscous / (FASTEST_FRICTION * m));
    k->near_torque = (mct_real)(h * h / (FASTEST_TORQUE * m));
    const double rest = scene->effects & MCT_SPRING ? p[REST_LENGTH] : 0;
    k->resting_inverse_cube = (mct_real)(rest > 0 ? 1 / (rest * rest * rest) : 0);
    /* d/dt (r - l0, rd, a constant pull) */
    const double generator[9] = {0, h, 0, -h * stiffness / m, -h * length_viscous / m, h, 0, 0, 0};
    double flow[9];
    const mct_status status = mct_expm1(3, generator, flow);
    if (status != MCT_OK) {
        mct_message_add(why, "parameters.stiffness: found a spring too stiff, or too rough, for any step");
        return status;
    }
    for (int i = 0; i < 6; i++) {
        k->along[i / 3][i % 3] = (mct_real)flow[i];
    }
    return check(scene, h, why);
}

MCT_INLINE mct_real size_of(mct_real a)
{
    return a < 0 ? -a : a;
}

/* ---- a step in the frame of the rod as it stands at the start of the step: axis 1 along it, axis 2 across ---- */

typedef struct {
    const constants_t *k;
    mct_real along;  /* gravity along the rod [m/s^2] */
    mct_real across; /* and across it */
} frame;

MCT_INLINE frame frame_at(const constants_t *k, unsigned effects, mct_real angle)
{
    frame now = {k, 0, 0};
    if (effects & MCT_GRAVITY) {
        mct_real s, c;
        mct_sincos(angle, &s, &c);
        now.along = -k->gravity * s;
        now.across = -k->gravity * c;
    }
    return now;
}

/* Acceleration by weight, spring and torque; `inverse` is 1 / R there. */
MCT_INLINE void accelerate(const frame *now, unsigned effects, const mct_real *y, mct_real inverse,
                           mct_real u, mct_real *a)
{
    const constants_t *k = now->k;
    const mct_real turning = k->inverse_mass * u * (inverse * inverse);
    a[0] = -turning * y[1];
    a[1] = turning * y[0];
    if (effects & MCT_GRAVITY) {
        a[0] += now->along;
        a[1] += now->across;
    }
    if (effects & MCT_SPRING) {
        mct_real pull = k->stiffness_rate;
        if (k->rest_rate > 0) {
            pull -= k->rest_rate * inverse;
        }
        a[0] -= pull * y[0];
        a[1] -= pull * y[1];
    }
}

/* R^2, never 0: at the pivot itself what points along the rod vanishes. */
MCT_INLINE mct_real square_of(const mct_real *y)
{
    const mct_real smallest = MCT_REAL_IS_FLOAT ? MCT_R(1e-36) : MCT_R(1e-290);
    return y[0] * y[0] + y[1] * y[1] + smallest;
}

/*
 * (cosine - 1) / tan^2 of a small turn from z = tan^2 of it, |tan| <= SMALL_TANGENT: the series of 1 / sqrt(1 + z).
 * What it leaves out of the cosine is less than a tenth of a rounding.
 */
#define SMALL_TANGENT MCT_R(1.0 / 32)
MCT_INLINE mct_real cosine_less_one_by(mct_real z)
{
    const mct_real zz = z * z;
#if MCT_REAL_IS_FLOAT
    return (-0.5F + 0.375F * z) - 0.3125F * zz;
#else
    return (-0.5 + 0.375 * z) + zz * ((-0.3125 + 0.2734375 * z) - 0.24609375 * zz);
#endif
}

/* 1 / R. At the start of a step Y is 0; within it, it is small as a rule. */
MCT_INLINE mct_real inverse_of(const mct_real *y)
{
    if (!(size_of(y[1]) <= SMALL_TANGENT * y[0])) {
        return mct_inverse_root(square_of(y));
    }
    const mct_real inverse = 1 / y[0];
    const mct_real z = y[1] * inverse * (y[1] * inverse);
    return inverse + inverse * (z * cosine_less_one_by(z));
}

/* y = (X, Xd), rates of both. */
MCT_INLINE void derivative(const void *self, unsigned effects, const mct_real *y, mct_real u, mct_real *dy)
{
    const frame *now = self;
    const constants_t *k = now->k;
    const mct_real inverse = inverse_of(y);
    const mct_real inverse_square = inverse * inverse;
    dy[0] = y[2];
    dy[1] = y[3];
    accelerate(now, effects, y, inverse, u, dy + 2);
    if (effects & MCT_VISCOUS) {
        const mct_real radial = k->length_damping * (y[0] * y[2] + y[1] * y[3]) * inverse_square;
        const mct_real rate = (y[0] * y[3] - y[1] * y[2]) * inverse_square;
        const mct_real turning = k->angle_damping * rate * inverse_square;
        dy[2] -= radial * y[0] - turning * y[1];
        dy[3] -= radial * y[1] + turning * y[0];
    }
}

/* Velocity increment; damping is taken at the new velocity (`share` 1: euler) or at the mean of both (1/2: leap). */
MCT_INLINE void kick(const frame *now, unsigned effects, const mct_real *y, mct_real inverse, mct_real u,
                     mct_real share, mct_real *dy)
{
    const constants_t *k = now->k;
    const mct_real h = k->step.h;
    const mct_real inverse_square = inverse * inverse;
    mct_real a[2];
    accelerate(now, effects, y, inverse, u, a);
    if (effects & MCT_VISCOUS) { /* along and across the rod as it stands at y, times R */
        const mct_real length_damping = h * k->length_damping;
        const mct_real angle_damping = h * k->angle_damping * inverse_square;
        const mct_real along =
            (h * (y[0] * a[0] + y[1] * a[1]) - length_damping * (y[0] * y[2] + y[1] * y[3])) /
            (1 + share * length_damping);
        const mct_real across =
            (h * (y[0] * a[1] - y[1] * a[0]) - angle_damping * (y[0] * y[3] - y[1] * y[2])) /
            (1 + share * angle_damping);
        dy[2] = (along * y[0] - across * y[1]) * inverse_square;
        dy[3] = (along * y[1] + across * y[0]) * inverse_square;
    } else {
        dy[2] = h * a[0];
        dy[3] = h * a[1];
    }
}

MCT_INLINE void kick_implicit(const void *self, unsigned effects, const mct_real *y, mct_real u, mct_real *dy)
{
    kick(self, effects, y, 1 / y[0], u, 1, dy); /* at the start of the step: Y = 0 */
}

MCT_INLINE void kick_symmetric(const void *self, unsigned effects, const mct_real *y, mct_real u,
                               mct_real *dy)
{
    kick(self, effects, y, inverse_of(y), u, MCT_R(0.5), dy);
}

/*
 * Classical Runge-Kutta in the frame. With a rest length the spring's force turns as the ball passes the pivot, all at
 * once at the pivot itself. So near it a step is made in parts, each a quarter of the time in which the force turns,
 * but no shorter than SHORTEST_PART of the step: what the jump costs is of that size.
 */
#define SHORTEST_PART (MCT_REAL_IS_FLOAT ? MCT_R(0x1p-16) : MCT_R(0x1p-28))
#define MOST_PARTS    192 /* towards the pivot R shrinks to 3/4 a part, behind it grows to 5/4 */

RARE void rk4_in_frame(const frame *now, unsigned effects, const mct_real *y, mct_real u, mct_real *dy)
{
    const constants_t *k = now->k;
    const mct_real h = k->step.h;
    const mct_real rest = (effects & MCT_SPRING) ? k->rest_rate : 0;
    const mct_real speed_square = y[2] * y[2] + y[3] * y[3];
    if (!(rest > 0) || 16 * h * h * (speed_square + rest * y[0]) <= y[0] * y[0]) {
        mct_rk4_plain(derivative, now, k->step, effects, 2, y, u, dy);
        return;
    }
    mct_real left = h;
    mct_real at[4] = {y[0], y[1], y[2], y[3]};
    for (int part = 1; left > 0; part++) {
        const mct_real square = square_of(at);
        const mct_real length = square * mct_inverse_root(square);
        const mct_real turning = at[2] * at[2] + at[3] * at[3] + rest * length;
        mct_real time = MCT_R(0.25) * length * mct_inverse_root(turning);
        time = time > SHORTEST_PART * h ? time : SHORTEST_PART * h;
        time = time < left && part < MOST_PARTS ? time : left;
        const mct_step step = {.h = time, .half = MCT_R(0.5) * time, .sixth = time / 6};
        mct_real change[4];
        mct_rk4_plain(derivative, now, step, effects, 2, at, u, change);
        for (int i = 0; i < 4; i++) {
            at[i] += change[i];
        }
        left -= time;
    }
    for (int i = 0; i < 4; i++) {
        dy[i] = at[i] - y[i];
    }
}

/* Term n + 1 of p = 1/R from R^2 = q: 2 q p' = - q' p. */
MCT_INLINE mct_real next_inverse(const mct_real *square, const mct_real *inverse, mct_real by_square, int n)
{
    mct_real sum = 0;
    mct_real weight = MCT_R(-0.5) * (mct_real)(n + 1);
    for (int j = n + 1; j > 0; j--) {
        sum += weight * (square[j] * inverse[n + 1 - j]);
        weight -= MCT_R(0.5);
    }
    return by_square * mct_series_share(n) * sum;
}

/*
 * Increments dy of y. By terms, Xdd = g' + pull X + turning (-Y, X) with
 *     pull = - k/m + k l0/(m R) - k1/m X.Xd / R^2,    turning = (torque - k2 w) / (m R^2),    w = X x Xd / R^2.
 */
MCT_INLINE void taylor_in_frame(const frame *now, unsigned effects, int order, const mct_real *y, mct_real u,
                                mct_real *dy)
{
    const constants_t *k = now->k;
    const mct_real h = k->step.h;
    const mct_real inverse_length = 1 / y[0]; /* at the start of the step: Y = 0 */
    const mct_real by_square = inverse_length * inverse_length;
    const bool has_rest = (effects & MCT_SPRING) && k->rest_rate > 0;
    const bool is_turned = (effects & MCT_VISCOUS) || u != 0;
    const bool has_inverse = has_rest || is_turned;
    /*
     * 1/R is singular at a complex time R/|Xd| from here: a step that comes half as far is rk4's, with a rest length, where
     * that is made in parts, one of a low order sooner.
     */
    const mct_real reach = !has_rest || order > 8 ? MCT_R(4) : order > 4 ? MCT_R(16) : MCT_R(64);
    if (has_inverse && reach * h * h * (y[2] * y[2] + y[3] * y[3]) * by_square > 1) {
        rk4_in_frame(now, effects, y, u, dy);
        return;
    }
    mct_series X, Y, Xd, Yd, square, along, inverse, inverse_square, across, rate, pull, turning;
    X[0] = y[0];
    Y[0] = y[1];
    Xd[0] = y[2];
    Yd[0] = y[3];
    square[0] = y[0] * y[0];
    inverse[0] = inverse_length;
    for (int n = 0; n < order; n++) {
        const mct_real share = h * mct_series_share(n);
        mct_real a[2] = {0, 0};
        if ((effects & MCT_GRAVITY) && n == 0) {
            a[0] = now->along;
            a[1] = now->across;
        }
        mct_real part[4];
        if (has_inverse) {
            mct_series_products(X, Xd, Yd, n, &part[0], &part[1]);
            mct_series_products(Y, Xd, Yd, n, &part[2], &part[3]);
            along[n] = part[0] + part[3];
            across[n] = part[1] - part[2];
        }
        pull[n] = (effects & MCT_SPRING) && n == 0 ? -k->stiffness_rate : 0;
        if (has_rest) {
            pull[n] += k->rest_rate * inverse[n];
        }
        if (is_turned) {
            inverse_square[n] = mct_series_product(inverse, inverse, n);
            turning[n] = k->inverse_mass * u * inverse_square[n];
        }
        if (effects & MCT_VISCOUS) {
            mct_series_products(inverse_square, along, across, n, &part[0], &rate[n]);
            pull[n] -= k->length_damping * part[0];
            turning[n] -= k->angle_damping * mct_series_product(inverse_square, rate, n);
        }
        if (effects & (MCT_SPRING | MCT_VISCOUS)) {
            mct_series_products(pull, X, Y, n, &part[0], &part[1]);
            a[0] += part[0];
            a[1] += part[1];
        }
        if (is_turned) {
            mct_series_products(turning, X, Y, n, &part[0], &part[1]);
            a[0] -= part[1];
            a[1] += part[0];
        }
        X[n + 1] = share * Xd[n];
        Y[n + 1] = share * Yd[n];
        Xd[n + 1] = share * a[0];
        Yd[n + 1] = share * a[1];
        if (has_inverse) {
            square[n + 1] = 2 * share * along[n];
            inverse[n + 1] = next_inverse(square, inverse, by_square, n);
        }
    }
    mct_series_increments(Xd, h, order, &dy[0], &dy[2]);
    mct_series_increments(Yd, h, order, &dy[1], &dy[3]);
}

/* A step that has no result: the plant keeps its state and counts it. */
MCT_INLINE void fail(mct_real *dx)
{
    dx[0] = MCT_REAL_MAX;
    dx[1] = dx[2] = dx[3] = 0;
}

/* (nearest length at which friction and torque can be followed)^2 */
MCT_INLINE mct_real nearest_square(const constants_t *k, unsigned effects, mct_real u)
{
    const mct_real by_torque = k->near_torque * size_of(u);
    return (effects & MCT_VISCOUS) ? by_torque + k->near_friction : by_torque;
}

/* Whether the step from (r, 0) by (dX, dY) comes nearer to the pivot than friction and torque can be followed. */
MCT_INLINE bool comes_too_near(const constants_t *k, unsigned effects, mct_real r, const mct_real *dy,
                               mct_real square, mct_real u)
{
    const mct_real limit = nearest_square(k, effects, u);
    const mct_real travelled = dy[0] * dy[0] + dy[1] * dy[1];
    const mct_real towards = -r * dy[0];
    const bool passes = towards > 0 && towards < travelled;
    const mct_real passed = r * dy[1];
    return square < limit || (passes && passed * passed < limit * travelled);
}

/*
 * to_polar by series where the rod turns little, by t = Y/X its tangent: as exact, with no root and one division.
 * R = X sqrt(1 + t^2), sqrt(1 + t^2) = (1 + t^2) cosine.
 */
MCT_INLINE void turn_little(const mct_real *x, mct_real X, mct_real Yd, const mct_real *dy, mct_real *dx)
{
    const mct_real inverse = 1 / X;
    const mct_real t = dy[1] * inverse;
    const mct_real z = t * t;
    const mct_real e = cosine_less_one_by(z);
    const mct_real cosine = 1 + z * e;
#if MCT_REAL_IS_FLOAT
    const mct_real rest = -1.0F / 3 + 1.0F / 5 * z;
#else
    const mct_real rest = (-1.0 / 3 + 1.0 / 5 * z) + z * z * ((-1.0 / 7 + 1.0 / 9 * z) - 1.0 / 11 * (z * z));
#endif
    dx[0] = dy[0] + dy[1] * t * (1 + (e + z * e));
    dx[1] = t + t * (z * rest);
    dx[2] = cosine * (dy[2] + t * Yd) + x[2] * (z * e);
    dx[3] = cosine * cosine * inverse * ((dy[3] - x[3] * (dy[0] + dy[1] * t)) - t * (x[2] + dy[2]));
}

/* Increments of (r, th, rd, w) from those of (X, Xd). */
MCT_INLINE void to_polar(const constants_t *k, unsigned effects, const mct_real *x, mct_real u,
                         const mct_real *dy, mct_real *dx)
{
    const mct_real r = x[0];
    const mct_real X = r + dy[0];
    const mct_real Y = dy[1];
    const mct_real Xd = x[2] + dy[2];
    const mct_real Yd = r * x[3] + dy[3];
    const mct_real square = X * X + Y * Y;
    if (square < MCT_R(PIVOT_SQUARE) || comes_too_near(k, effects, r, dy, square, u)) {
        fail(dx);
        return;
    }
    if (size_of(Y) <= SMALL_TANGENT * X) {
        turn_little(x, X, Yd, dy, dx);
        return;
    }
    const mct_real inverse = mct_inverse_root(square);
    const mct_real R = square * inverse;
    const mct_real X_less_R = X > 0 ? -Y * Y / (R + X) : X - R;
    dx[0] = (dy[0] * (r + X) + Y * Y) / (R + r);
    dx[1] = mct_direction(X, Y, R);
    dx[2] = inverse * (x[2] * X_less_R + X * dy[2] + Y * Yd);
    dx[3] = inverse * inverse * (X * dy[3] - x[3] * (X * dy[0] + Y * Y) - Y * Xd);
}

/* ---- in polar coordinates ---- */

MCT_INLINE void polar_derivative_at(const void *constants, unsigned effects, const mct_real *x, mct_real s,
                                    mct_real c, mct_real u, mct_real *dx)
{
    const constants_t *k = constants;
    const mct_real r = x[0];
    const mct_real rd = x[2];
    const mct_real w = x[3];
    const mct_real inverse = 1 / r;
    mct_real radial = r * w * w;
    mct_real turning = k->inverse_mass * u * inverse;
    if (effects & MCT_SPRING) {
        radial -= k->stiffness_rate * r - k->rest_rate;
    }
    if (effects & MCT_VISCOUS) {
        radial -= k->length_damping * rd;
        turning -= k->angle_damping * w * inverse;
    }
    if (effects & MCT_GRAVITY) {
        radial -= k->gravity * s;
        turning -= k->gravity * c;
    }
    dx[0] = rd;
    dx[1] = w;
    dx[2] = radial;
    dx[3] = (turning - 2 * rd * w) * inverse;
}

MCT_INLINE void polar_derivative(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                                 mct_real *dx)
{
    mct_real s, c;
    mct_sincos(x[1], &s, &c);
    polar_derivative_at(constants, effects, x, s, c, u, dx);
}

/* The source's own step, in the source's coordinates, which end at the pivot. */
MCT_INLINE void polar_seed(const constants_t *k, unsigned effects, const mct_real *x, mct_real u,
                           mct_real *dx)
{
    mct_seed(polar_derivative, k, k->step, effects, 2, x, u, dx);
    const mct_real r = x[0] + dx[0];
    const mct_real dy[2] = {dx[0], r * dx[1]};
    if (!(r > 0) || comes_too_near(k, effects, x[0], dy, r * r, u)) {
        fail(dx);
    }
}

/* A step in the frame of the rod, by one of the steppers: `step` from `y` to the increments `dy`. */
#define STEP_IN_FRAME(kind, name, step)                                                               \
    kind void name(const void *constants, unsigned effects, int order, const mct_real *x, mct_real u, \
                   mct_real *dx)                                                                      \
    {                                                                                                 \
        const constants_t *k = constants;                                                             \
        const frame now = frame_at(k, effects, x[1]);                                                 \
        const mct_real y[4] = {x[0], 0, x[2], x[0] * x[3]};                                           \
        mct_real dy[4];                                                                               \
        step;                                                                                         \
        (void)order;                                                                                  \
        to_polar(k, effects, x, u, dy, dx);                                                           \
    }
STEP_IN_FRAME(MCT_INLINE, framed_euler, mct_euler(kick_implicit, &now, k->step, effects, 2, y, u, dy))
STEP_IN_FRAME(MCT_INLINE, framed_leap, mct_leap(kick_symmetric, &now, k->step, effects, 2, y, u, dy))
STEP_IN_FRAME(MCT_INLINE, framed_taylor, taylor_in_frame(&now, effects, order, y, u, dy))
STEP_IN_FRAME(MCT_INLINE, framed_rk4, mct_rk4_plain(derivative, &now, k->step, effects, 2, y, u, dy))
STEP_IN_FRAME(RARE, rare_taylor, taylor_in_frame(&now, effects, order, y, u, dy))
STEP_IN_FRAME(RARE, rare_rk4, rk4_in_frame(&now, effects, y, u, dy))

/* ---- away from the pivot ---- */

/*
 * Whether a step is made in polar coordinates. It is short: by speed, fall, friction and torque at most a quarter of r.
 * And it is no less exact so: r varies in every term, in the frame of the rod in the rest length's part of the force
 * alone, whose acceleration, rest * r, therefore has to outweigh the motion's own, speed * r: never without the spring.
 * That test knows no h: else the error would not go down by the order with the step.
 */
MCT_INLINE bool stays_away(const constants_t *k, unsigned effects, const mct_real *x, mct_real inverse,
                           mct_real u)
{
    const mct_real h_square = k->step.h * k->step.h;
    const mct_real stretching = x[2] * inverse;
    const mct_real speed = stretching * stretching + x[3] * x[3];
    const mct_real rest = k->rest_rate * inverse;
    mct_real fall = size_of(k->stiffness_rate - rest);
    if (effects & MCT_GRAVITY) {
        fall += k->gravity * inverse;
    }
    const mct_real couple = nearest_square(k, effects, u) * (inverse * inverse);
    return speed < MCT_R(0.5) * rest && h_square * (16 * speed + 4 * fall) + 4 * couple < 1;
}

/* Term n of a a: half the products of mct_series_product. */
MCT_INLINE mct_real square(const mct_real *a, int n)
{
    mct_real half = MCT_NOTHING;
    MCT_UNROLL
    for (int j = 1; 2 * j < n; j++) {
        half += a[j] * a[n - j];
    }
    const mct_real inner = n > 0 && n % 2 == 0 ? 2 * half + a[n / 2] * a[n / 2] : 2 * half;
    return n > 0 ? inner + 2 * a[0] * a[n] : a[0] * a[0];
}

/*
 * By terms, with lengths in units of r at the start, so that r and r^2 begin with 1: the force along the rod, and the
 * torque, which changes the angular momentum r^2 w,
 *     rdd = r w^2 - k/m (r - l0) - k1/m rd - g s,    (r^2 w)' = (torque - k2 w)/m - g r c,
 *     (g s)' = g c w,    (g c)' = - g s w.
 * The order is a literal: all loops vanish, and the terms stay in registers. In sums the latest term comes last.
 */
MCT_INLINE void polar_taylor(const constants_t *k, unsigned effects, int order, const mct_real *x,
                             mct_real inverse, mct_real u, mct_real *dx)
{
    const mct_real h = k->step.h;
    const mct_real push = k->inverse_mass * u * (inverse * inverse);
    const mct_real damping = k->angle_damping * (inverse * inverse);
    mct_series r, rr, rd, w, ww, along, across;
    r[0] = 1;
    rr[0] = 1;
    rd[0] = x[2] * inverse;
    w[0] = x[3];
    if (effects & MCT_GRAVITY) {
        const mct_real g = -k->gravity * inverse;
        mct_real s, c;
        mct_sincos(x[1], &s, &c);
        along[0] = g * s;
        across[0] = g * c;
    }
    mct_real way = MCT_NOTHING, turn = MCT_NOTHING, of_rd = MCT_NOTHING,
             of_w = MCT_NOTHING; /* but the first terms */
    MCT_UNROLL
    for (int n = 0; n < order; n++) {
        const mct_real share = h * mct_series_share(n);
        r[n + 1] = share * rd[n];
        rr[n + 1] = square(r, n + 1);
        ww[n] = square(w, n);
        mct_real radial = MCT_NOTHING;
        mct_real torque = n == 0 ? push : MCT_NOTHING;
        if (effects & MCT_SPRING) {
            radial -= k->stiffness_rate * r[n];
            radial += n == 0 ? k->rest_rate * inverse : MCT_NOTHING;
        }
        if (effects & MCT_VISCOUS) {
            radial -= k->length_damping * rd[n];
            torque -= damping * w[n];
        }
        MCT_UNROLL
        for (int j = n; j >= 0; j--) {
            radial += r[j] * ww[n - j];
        }
        if (effects & MCT_GRAVITY) {
            radial += along[n];
            torque += mct_series_product(r, across, n);
            along[n + 1] = share * mct_series_product(w, across, n);
            across[n + 1] = -share * mct_series_product(w, along, n);
        }
        mct_real carried = MCT_NOTHING; /* of (r^2 w) but w itself */
        MCT_UNROLL
        for (int j = n; j > 0; j--) {
            carried += rr[j] * w[n + 1 - j];
        }
        carried += w[0] * rr[n + 1];
        rd[n + 1] = share * radial;
        w[n + 1] = share * torque - carried;
        if (n > 0) {
            way += r[n + 1];
            turn += share * w[n];
            of_rd += rd[n + 1];
            of_w += w[n + 1];
        }
    }
    const mct_real share = h * mct_series_share(order);
    dx[0] = x[0] * (r[1] + (way + share * rd[order]));
    dx[1] = h * w[0] + (turn + share * w[order]);
    dx[2] = x[0] * (rd[1] + of_rd);
    dx[3] = w[1] + of_w;
}

MCT_INLINE void rk4_step(const constants_t *k, unsigned effects, const mct_real *x, mct_real u, mct_real *dx)
{
    if (!(effects & MCT_SPRING)) {
        framed_rk4(k, effects, 0, x, u, dx);
    } else if (stays_away(k, effects, x, 1 / x[0], u)) {
        mct_rk4(polar_derivative_at, 1, k, k->step, effects, 2, x, u, dx);
    } else {
        rare_rk4(k, effects, 0, x, u, dx);
    }
}

/* Not of order 12: its steps are so long that it costs a digit and more. */
MCT_INLINE void taylor_step(const constants_t *k, unsigned effects, int order, const mct_real *x, mct_real u,
                            mct_real *dx)
{
    const mct_real inverse = 1 / x[0];
    if (!(effects & MCT_SPRING)) {
        framed_taylor(k, effects, order, x, u, dx);
    } else if (stays_away(k, effects, x, inverse, u)) {
        polar_taylor(k, effects, order, x, inverse, u, dx);
    } else {
        rare_taylor(k, effects, order, x, u, dx);
    }
}

/* ---- the spring by itself, however stiff ---- */

typedef struct {
    mct_real r, rd;
    mct_real momentum; /* r^2 w, by mass */
    mct_real s, c;     /* of the angle */
} split_state;

/*
 * What pulls along the rod, by mass: weight, and the turning's pull as it is at the rest length. Neither changes while the
 * ball moves along the rod, so that it swings about where they hold it.
 */
MCT_INLINE mct_real held_pull(const constants_t *k, unsigned effects, const split_state *now)
{
    mct_real pull = MCT_NOTHING;
    if (effects & MCT_SPRING) {
        pull += now->momentum * now->momentum * k->resting_inverse_cube;
    }
    if (effects & MCT_GRAVITY) {
        pull -= k->gravity * now->s;
    }
    return pull;
}

/* What spring, friction and the held pull change along the rod: of the way (row 0), or of the rate (row 1). */
MCT_INLINE mct_real along_rod(const constants_t *k, unsigned effects, int row, const split_state *now)
{
    const mct_real *const share = k->along[row];
    mct_real change = MCT_NOTHING;
    if (effects & MCT_SPRING) {
        change += share[0] * (now->r - k->rest_length);
    }
    change += share[1] * now->rd;
    if (effects & (MCT_SPRING | MCT_GRAVITY)) {
        change += share[2] * held_pull(k, effects, now);
    }
    return change;
}

/* Torque and weight across the rod for half a step. */
MCT_INLINE void split_push(const constants_t *k, unsigned effects, mct_real u, split_state *now)
{
    mct_real torque = k->inverse_mass * u;
    if (effects & MCT_GRAVITY) {
        torque -= k->gravity * now->r * now->c;
    }
    now->momentum += k->step.half * torque;
}

/* Friction of the pivot for half a step, the mean of both ends. */
MCT_INLINE void split_slow(const constants_t *k, unsigned effects, split_state *now)
{
    if (effects & MCT_VISCOUS) {
        const mct_real share = MCT_R(0.5) * k->step.half * k->angle_damping / (now->r * now->r);
        now->momentum *= (1 - share) / (1 + share);
    }
}

/* Pull of the turning for half a step, beyond that at the rest length. */
MCT_INLINE void split_pull(const constants_t *k, unsigned effects, split_state *now)
{
    mct_real inverse_cube = 1 / (now->r * now->r * now->r);
    if (effects & MCT_SPRING) {
        inverse_cube -= k->resting_inverse_cube;
    }
    now->rd += k->step.half * (now->momentum * now->momentum * inverse_cube);
}

/*
 * The motion along the rod under spring, friction and a constant pull is linear and taken exactly, between two halves of all
 * else: torque and weight across the rod, friction of the pivot, turning. Each part by itself keeps what it should, and the
 * order is the same from both ends: of order 2, symmetric in time, at any stiffness.
 */
MCT_INLINE void split3(const constants_t *k, unsigned effects, const mct_real *x, mct_real u, mct_real *dx)
{
    split_state now = {x[0], x[2], x[0] * x[0] * x[3], 0, 0};
    mct_real s = 0, c = 0;
    if (effects & MCT_GRAVITY) {
        mct_sincos(x[1], &s, &c);
        now.s = s;
        now.c = c;
    }
    split_push(k, effects, u, &now);
    split_slow(k, effects, &now);
    const mct_real before = k->step.half * now.momentum / (now.r * now.r);
    if (effects & MCT_GRAVITY) {
        mct_sincos_near(x[1] + before, before, s, c, &now.s, &now.c);
    }
    split_pull(k, effects, &now);
    dx[0] = along_rod(k, effects, 0, &now);
    now.rd += along_rod(k, effects, 1, &now);
    now.r = x[0] + dx[0];
    if (!(now.r > 0)) {
        fail(dx);
        return;
    }
    split_pull(k, effects, &now);
    dx[1] = before + k->step.half * now.momentum / (now.r * now.r);
    if (effects & MCT_GRAVITY) {
        mct_sincos_near(x[1] + dx[1], dx[1], s, c, &now.s, &now.c);
    }
    split_slow(k, effects, &now);
    split_push(k, effects, u, &now);
    dx[2] = now.rd - x[2];
    dx[3] = now.momentum / (now.r * now.r) - x[3];
}

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_real m = k->mass;
    const mct_real r = x[0];
    const mct_real rd = x[2];
    const mct_real w = x[3];
    const mct_real stretch = r - k->rest_length;
    mct_real s, c;
    (void)effects;
    mct_sincos(x[1], &s, &c);
    *out = (mct_evaluation){0};
    out->M[0][0] = m;
    out->M[1][1] = m * r * r;
    out->C[0][1] = -m * r * w;
    out->C[1][0] = m * r * w;
    out->C[1][1] = m * r * rd;
    out->Cv[0] = -m * r * w * w;
    out->Cv[1] = 2 * m * r * rd * w;
    const mct_real couple = u - k->angle_viscous * w;
    const mct_real along = -k->stiffness * stretch - k->length_viscous * rd;
    out->tau[0] = along - m * k->gravity * s;
    out->tau[1] = couple - m * k->gravity * r * c;
    out->acceleration[0] = k->inverse_mass * (out->tau[0] - out->Cv[0]);
    out->acceleration[1] = (out->tau[1] - out->Cv[1]) / out->M[1][1];
    out->mass[0] = m;
    out->position[0][0] = r * c;
    out->position[0][1] = r * s;
    out->force[0][0] = along * c;
    out->force[0][1] = along * s - m * k->gravity;
    out->constraint_force[0][0] = -couple / r * s;
    out->constraint_force[0][1] = couple / r * c;
    out->kinetic_energy = MCT_R(0.5) * m * (rd * rd + r * r * w * w);
    out->potential_energy = m * k->gravity * r * s + MCT_R(0.5) * k->stiffness * stretch * stretch;
    out->power_input = u * w;
    out->power[MCT_EFFECT_GRAVITY] = -m * k->gravity * (s * rd + r * c * w);
    out->power[MCT_EFFECT_SPRING] = -k->stiffness * stretch * rd;
    out->power[MCT_EFFECT_VISCOUS] = -k->length_viscous * rd * rd - k->angle_viscous * w * w;
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    mct_hyperdual s, c;
    (void)constants;
    (void)time;
    mct_hyperdual_sincos(q[1], &s, &c);
    position[0][0] = mct_hyperdual_mul(q[0], c);
    position[0][1] = mct_hyperdual_mul(q[0], s);
    position[0][2] = mct_hyperdual_constant(0);
}

#define friction mct_no_friction
#define SWITCHES MCT_GRAVITY, MCT_SPRING, MCT_VISCOUS
static const uint32_t switches[] = {SWITCHES, 0};

MCT_KERNELS_3(seed, k->step.remainder, 2, SWITCHES, polar_seed(k, effects, x, u, dx))
MCT_KERNELS_3(euler, k->step.remainder, 2, SWITCHES, framed_euler(k, effects, 0, x, u, dx))
MCT_KERNELS_3(leap, k->step.remainder, 2, SWITCHES, framed_leap(k, effects, 0, x, u, dx))
MCT_KERNELS_3(rk4, k->step.sixth_remainder, 2, SWITCHES, rk4_step(k, effects, x, u, dx))
MCT_KERNELS_3(taylor4, k->step.remainder, 2, SWITCHES, taylor_step(k, effects, 4, x, u, dx))
MCT_KERNELS_3(taylor6, k->step.remainder, 2, SWITCHES, taylor_step(k, effects, 6, x, u, dx))
MCT_KERNELS_3(taylor8, k->step.remainder, 2, SWITCHES, taylor_step(k, effects, 8, x, u, dx))
MCT_KERNELS_3(taylor12, k->step.remainder, 2, SWITCHES, framed_taylor(k, effects, 12, x, u, dx))
MCT_KERNELS_3(split3, k->step.remainder, 2, SWITCHES, split3(k, effects, x, u, dx))

static const mct_named_kernel *kernel(int stepper, uint32_t effects)
{
    static const mct_named_kernel *const kernels[MCT_STEPPER_COUNT] = {
        [MCT_STEPPER_SEED] = seed_kernels,     [MCT_STEPPER_EULER] = euler_kernels,
        [MCT_STEPPER_LEAP] = leap_kernels,     [MCT_STEPPER_RK4] = rk4_kernels,
        [MCT_STEPPER_SPLIT3] = split3_kernels, MCT_TAYLOR_ROWS,
    };
    return mct_switched_kernel_of(kernels, switches, stepper, effects);
}

const mct_system mct_spring_pendulum = {
    .name = "spring_pendulum",
    .doc = "a ball on a spring that turns about a pivot",
    .source = "1.3",
    .coordinate_count = 2,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .input_without_motor = &torque_field,
    .effects = MCT_GRAVITY | MCT_SPRING | MCT_VISCOUS,
    .standard_effects = MCT_GRAVITY | MCT_SPRING | MCT_VISCOUS,
    .particle_count = 1,
    .particle_names = particle_names,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
};

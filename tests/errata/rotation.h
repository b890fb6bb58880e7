/* Particles on a rotation vector, x = e^{R[u]} b + c, written once in hyper-dual numbers for the engine. */
#ifndef MCT_TEST_ERRATA_ROTATION_H
#define MCT_TEST_ERRATA_ROTATION_H

#include "errata/errata.h"

typedef struct {
    mct_hyperdual a[3];
} dual_vector;

static inline dual_vector dual_cross(dual_vector x, dual_vector y)
{
    dual_vector z;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        z.a[i] = mct_hyperdual_sub(mct_hyperdual_mul(x.a[j], y.a[k]), mct_hyperdual_mul(x.a[k], y.a[j]));
    }
    return z;
}

/* x + a y + b z */
static inline dual_vector dual_sum(dual_vector x, mct_hyperdual a, dual_vector y, mct_hyperdual b,
                                   dual_vector z)
{
    for (int i = 0; i < 3; i++) {
        x.a[i] = mct_hyperdual_add(
            x.a[i], mct_hyperdual_add(mct_hyperdual_mul(a, y.a[i]), mct_hyperdual_mul(b, z.a[i])));
    }
    return x;
}

/* sin a / a, (1 - cos a)/a^2 and (a - sin a)/a^3 of s = a^2; the last with one derivative alone. */
typedef struct {
    mct_hyperdual sine, cosine, rest;
} angle_series;

static inline angle_series series_of(dual_vector u)
{
    mct_hyperdual s = mct_hyperdual_constant(0);
    for (int i = 0; i < 3; i++) {
        s = mct_hyperdual_add(s, mct_hyperdual_mul(u.a[i], u.a[i]));
    }
    const double a = sqrt(s.value);
    const double f = sin(a) / a, f1 = (cos(a) - f) / (2 * s.value), f2 = (-f / 2 - 3 * f1) / (2 * s.value);
    const double g = (1 - cos(a)) / s.value, g1 = (f / 2 - g) / s.value, g2 = (f1 / 2 - 2 * g1) / s.value;
    const double k = (1 - f) / s.value, k1 = (-f1 - k) / s.value;
    return (angle_series){mct_hyperdual_compose(s, f, f1, f2), mct_hyperdual_compose(s, g, g1, g2),
                          mct_hyperdual_compose(s, k, k1, 0)};
}

/* e^{R[u]} b, by (232) */
static inline dual_vector turned(dual_vector u, dual_vector b)
{
    const angle_series at = series_of(u);
    const dual_vector first = dual_cross(u, b);
    return dual_sum(b, at.sine, first, at.cosine, dual_cross(u, first));
}

/* The same in plain numbers, as a matrix. */
static inline matrix rotation(vector u)
{
    const double a = norm(u);
    return plus(plus(one, sin(a) / a, R(u)), (1 - cos(a)) / (a * a), R2(u));
}

/* Angular velocity J_l(u) udot in the axes of the world, and its rate. */
typedef struct {
    vector omega, omega_dot;
} spin;

static inline spin spin_of(vector u, vector udot, vector uddot)
{
    dual_vector angle, rate;
    for (int i = 0; i < 3; i++) {
        angle.a[i] = (mct_hyperdual){u.a[i], udot.a[i], 0, 0};
        rate.a[i] = (mct_hyperdual){udot.a[i], uddot.a[i], 0, 0};
    }
    const angle_series at = series_of(angle);
    const dual_vector first = dual_cross(angle, rate);
    const dual_vector omega = dual_sum(rate, at.cosine, first, at.rest, dual_cross(angle, first));
    return (spin){vec(omega.a[0].value, omega.a[1].value, omega.a[2].value),
                  vec(omega.a[0].e1, omega.a[1].e1, omega.a[2].e1)};
}

/* A rotation vector that is near neither 0 nor a whole turn, where the series above lose digits. */
static inline vector any_rotation(void)
{
    const vector direction = any_vector();
    return scale(some() / norm(direction), direction);
}

/* ---- a body of particles, on a pivot at the origin or free ---- */

enum { PARTICLES = 4 };

typedef struct {
    int count;    /* of particles, PARTICLES or fewer */
    bool is_free; /* then c, the place of the body's origin, moves too */
    double m[PARTICLES];
    vector b[PARTICLES], f[PARTICLES];
    vector u, udot, c, cdot;
    matrix r;
    /* by the engine */
    vector x[PARTICLES], v[PARTICLES], a[PARTICLES], uddot;
} body;

static inline void place_body(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                              mct_hyperdual (*position)[3])
{
    const body *const self = context;
    const dual_vector u = {{q[0], q[1], q[2]}};
    (void)time;
    for (int i = 0; i < self->count; i++) {
        dual_vector b;
        for (int k = 0; k < 3; k++) {
            b.a[k] = mct_hyperdual_constant(self->b[i].a[k]);
        }
        const dual_vector x = turned(u, b);
        for (int k = 0; k < 3; k++) {
            position[i][k] = self->is_free ? mct_hyperdual_add(x.a[k], q[3 + k]) : x.a[k];
        }
    }
}

static inline void run_body(body *self)
{
    double q[6], v[6];
    memcpy(q, self->u.a, sizeof self->u.a);
    memcpy(v, self->udot.a, sizeof self->udot.a);
    memcpy(q + 3, self->c.a, sizeof self->c.a);
    memcpy(v + 3, self->cdot.a, sizeof self->cdot.a);
    const mct_gauss_motion *const motion =
        engine((mct_gauss_system){self->count, self->is_free ? 6 : 3, self->m, place_body, self}, 0, q, v,
               self->f[0].a, NULL);
    self->uddot = vec_of(motion->acceleration);
    for (int i = 0; i < self->count; i++) {
        self->x[i] = vec_of(motion->position[i]);
        self->v[i] = vec_of(motion->velocity[i]);
        self->a[i] = vec_of(motion->particle_acceleration[i]);
    }
}

static inline body random_body(bool is_free, bool is_pushed)
{
    body p = {.count = PARTICLES, .is_free = is_free};
    for (int i = 0; i < PARTICLES; i++) {
        p.m[i] = some();
        p.b[i] = any_vector();
        p.f[i] = is_pushed ? any_vector() : zero;
    }
    p.u = any_rotation();
    p.udot = any_vector();
    p.c = is_free ? any_vector() : zero;
    p.cdot = is_free ? any_vector() : zero;
    p.r = rotation(p.u);
    run_body(&p);
    return p;
}

/* sum m_i x_i */
static inline vector first_moment(const body *self, const vector *x)
{
    vector sum = zero;
    for (int i = 0; i < self->count; i++) {
        sum = add(sum, scale(self->m[i], x[i]));
    }
    return sum;
}

static inline double mass_of(const body *self)
{
    double sum = 0;
    for (int i = 0; i < self->count; i++) {
        sum += self->m[i];
    }
    return sum;
}

/* - sum m_i R^2[x_i - about], (297) */
static inline matrix inertia(const body *self, const vector *x, vector about)
{
    matrix sum = {{{0}}};
    for (int i = 0; i < self->count; i++) {
        sum = plus(sum, -self->m[i], R2(sub(x[i], about)));
    }
    return sum;
}

/* sum of factor (x_i - about) x y_i, the factor being m_i or, without mass, 1 */
static inline vector moment(const body *self, bool with_mass, const vector *x, vector about, const vector *y)
{
    vector sum = zero;
    for (int i = 0; i < self->count; i++) {
        sum = add(sum, scale(with_mass ? self->m[i] : 1, cross(sub(x[i], about), y[i])));
    }
    return sum;
}

#endif

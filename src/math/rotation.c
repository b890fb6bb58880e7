#include "mctau/rotation.h"

#include "mctau/matrix.h"

void mct_skew(const mct_real *u, mct_real *matrix)
{
    const mct_real entries[9] = {0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0};
    memcpy(matrix, entries, sizeof entries);
}

/**
 * 1 + once R[u] + twice R^2[u]: what a rotation, its rates and their inverses all are. R^2[u] = u u' - u'u.
 */
static void polynomial(const mct_real *u, mct_real once, mct_real twice, mct_real *matrix)
{
    mct_skew(u, matrix);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        for (int l = 0; l < 3; l++) {
            matrix[3 * i + l] *= once;
        }
        matrix[3 * i + i] = 1 - twice * (u[j] * u[j] + u[k] * u[k]);
        matrix[3 * i + j] += twice * u[i] * u[j];
        matrix[3 * i + k] += twice * u[i] * u[k];
    }
}

/* --- from one form to another --- */

void mct_quaternion_of_vector(const mct_real *u, mct_real *q)
{
    mct_quaternion_turn(u, q);
    q[0] += 1;
}

void mct_vector_of_quaternion(const mct_real *q, mct_real *u)
{
    const mct_real w = q[0] < 0 ? -q[0] : q[0];
    const mct_real sign = q[0] < 0 ? -1 : 1;
    const mct_real square = mct_dot(q + 1, q + 1);
    const mct_real length = mct_sqrt_real(square);
    const bool is_small = square <= MCT_REAL_EPSILON * (w * w); /* the square may have vanished altogether */
    const mct_real factor =
        is_small ? 2 / w : 2 * mct_direction(w, length, mct_sqrt_real(w * w + square)) / length;
    for (int i = 0; i < 3; i++) {
        u[i] = sign * factor * q[i + 1];
    }
}

void mct_matrix_of_quaternion(const mct_real *q, mct_real *r)
{
    polynomial(q + 1, 2 * q[0], 2, r);
}

void mct_quaternion_of_matrix(const mct_real *r, mct_real *q)
{
    /* 4 q q', of which the row of the largest diagonal entry is taken */
    const mct_real square[4] = {1 + r[0] + r[4] + r[8], 1 + r[0] - r[4] - r[8], 1 - r[0] + r[4] - r[8],
                                1 - r[0] - r[4] + r[8]};
    const mct_real rows[4][4] = {{square[0], r[7] - r[5], r[2] - r[6], r[3] - r[1]},
                                 {r[7] - r[5], square[1], r[1] + r[3], r[2] + r[6]},
                                 {r[2] - r[6], r[1] + r[3], square[2], r[5] + r[7]},
                                 {r[3] - r[1], r[2] + r[6], r[5] + r[7], square[3]}};
    int largest = 0;
    for (int i = 1; i < 4; i++) {
        if (square[i] > square[largest]) {
            largest = i;
        }
    }
    const mct_real *row = rows[largest];
    const mct_real length = mct_sqrt_real(row[0] * row[0] + mct_dot(row + 1, row + 1));
    for (int i = 0; i < 4; i++) {
        q[i] = (row[0] < 0 ? -row[i] : row[i]) / length;
    }
}

void mct_matrix_of_vector(const mct_real *u, mct_real *r)
{
    mct_real c[7];
    mct_stumpff(mct_dot(u, u), c);
    polynomial(u, c[1], c[2], r);
}

void mct_vector_of_matrix(const mct_real *r, mct_real *u)
{
    mct_real q[4];
    mct_quaternion_of_matrix(r, q);
    mct_vector_of_quaternion(q, u);
}

/* --- the rate of a rotation vector --- */

void mct_stumpff(mct_real s, mct_real *c)
{
    if (s < 4) {
        c[5] = 0;
        c[6] = 0;
        mct_real five = MCT_R(1.0 / 120); /* s^j / (5 + 2 j)!, and the same of 6 */
        mct_real six = MCT_R(1.0 / 720);
        for (int j = 1; j <= 10; j++) {
            c[5] += five;
            c[6] += six;
            five *= -s / (mct_real)((4 + 2 * j) * (5 + 2 * j));
            six *= -s / (mct_real)((5 + 2 * j) * (6 + 2 * j));
        }
        c[4] = MCT_R(1.0 / 24) - s * c[6];
        c[3] = MCT_R(1.0 / 6) - s * c[5];
        c[2] = MCT_R(0.5) - s * c[4];
        c[1] = 1 - s * c[3];
        c[0] = 1 - s * c[2];
        return;
    }
    const mct_real a = mct_sqrt_real(s);
    mct_sincos(a, &c[1], &c[0]);
    c[1] /= a;
    c[2] = (1 - c[0]) / s;
    c[3] = (1 - c[1]) / s;
    c[4] = (MCT_R(0.5) - c[2]) / s;
    c[5] = (MCT_R(1.0 / 6) - c[3]) / s;
    c[6] = (MCT_R(1.0 / 24) - c[4]) / s;
}

void mct_left_jacobian(const mct_real *u, mct_real *matrix)
{
    mct_real c[7];
    mct_stumpff(mct_dot(u, u), c);
    polynomial(u, c[2], c[3], matrix);
}

void mct_right_jacobian(const mct_real *u, mct_real *matrix)
{
    mct_real c[7];
    mct_stumpff(mct_dot(u, u), c);
    polynomial(u, -c[2], c[3], matrix);
}

/**
 * The factor of R^2 is (1 - h cot h)/a^2 with half the angle, h = a/2: no difference but that of c2 and c3.
 */
static mct_status jacobian_inverse(const mct_real *u, mct_real once, mct_real *matrix)
{
    mct_real c[7];
    mct_stumpff(MCT_R(0.25) * mct_dot(u, u), c);
    if (!(c[1] > 4 * MCT_REAL_EPSILON || c[1] < -4 * MCT_REAL_EPSILON)) {
        return MCT_ERROR_SINGULAR;
    }
    polynomial(u, once, (c[2] - c[3]) / (4 * c[1]), matrix);
    return MCT_OK;
}

mct_status mct_left_jacobian_inverse(const mct_real *u, mct_real *matrix)
{
    return jacobian_inverse(u, MCT_R(-0.5), matrix);
}

mct_status mct_right_jacobian_inverse(const mct_real *u, mct_real *matrix)
{
    return jacobian_inverse(u, MCT_R(0.5), matrix);
}

/* --- motion in polar coordinates --- */

static mct_real length_of(const mct_real *a)
{
    return mct_sqrt_real(mct_dot(a, a));
}

/** The shortest rotation vector from the direction a to the direction b, both of length 1. */
static void shortest_turn(const mct_real *a, const mct_real *b, mct_real *u)
{
    mct_real sum[3], difference[3], axis[3];
    for (int i = 0; i < 3; i++) {
        sum[i] = b[i] + a[i];
        difference[i] = b[i] - a[i];
    }
    /* a x b, of the smaller of the two: that one is exact where a and b, or a and -b, are close */
    const bool is_acute = mct_dot(a, b) > 0;
    mct_cross(a, is_acute ? difference : sum, axis);
    const mct_real opening = length_of(difference); /* 2 sin(angle/2), and 2 cos of it */
    const mct_real angle = 2 * mct_direction(length_of(sum), opening, 2);
    mct_real length = length_of(axis);
    if (!is_acute && !(length > MCT_REAL_EPSILON)) { /* opposite: across a and the axis farthest from it */
        int farthest = 0;
        for (int i = 1; i < 3; i++) {
            if (a[i] * a[i] < a[farthest] * a[farthest]) {
                farthest = i;
            }
        }
        const mct_real other[3] = {farthest == 0, farthest == 1, farthest == 2};
        mct_cross(a, other, axis);
        length = length_of(axis);
    }
    for (int i = 0; i < 3; i++) {
        u[i] = length > 0 ? angle * axis[i] / length : 0;
    }
}

mct_status mct_polar_decomposition(const mct_real *about, const mct_real *reference, const mct_real *position,
                                   const mct_real *velocity, mct_polar_motion *motion)
{
    mct_real from[3], to[3];
    for (int i = 0; i < 3; i++) {
        from[i] = reference[i] - about[i];
        to[i] = position[i] - about[i];
    }
    const mct_real square = mct_dot(to, to);
    const mct_real before = length_of(from);
    const mct_real now = length_of(to);
    if (!(before > 0 && now > 0)) {
        return MCT_ERROR_SINGULAR;
    }
    const mct_real growth = mct_dot(to, velocity) / square; /* [1/s] */
    motion->scale = now / before;
    motion->scale_rate = growth * motion->scale;
    mct_cross(to, velocity, motion->angular_velocity);
    for (int i = 0; i < 3; i++) {
        motion->angular_velocity[i] /= square;
        motion->radial_velocity[i] = growth * to[i];
    }
    mct_cross(motion->angular_velocity, to, motion->tangential_velocity);
    for (int i = 0; i < 3; i++) {
        from[i] /= before;
        to[i] /= now;
    }
    shortest_turn(from, to, motion->rotation);
    return MCT_OK;
}

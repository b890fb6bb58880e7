/*
 * The rules of include/mctau/rotation.h (source, sections 4.1 and 4.5), against power series of R[u] in
 * quadruple precision, which know neither sines nor angles.
 */
#include <math.h>
#include <stdio.h>

#include "mctau/rotation.h"
#include "support/quad.h"
#include "support/random.h"
#include "unity.h"

#define EPSILON ((double)MCT_REAL_EPSILON)
#define PI      3.14159265358979323846

enum { TRIALS = TEST_CASES(3000) };

void setUp(void)
{
}

void tearDown(void)
{
}

/* --- references --- */

static void multiply(const quad *a, const quad *b, quad *product)
{
    for (int i = 0; i < 9; i++) {
        product[i] = 0;
        for (int k = 0; k < 3; k++) {
            product[i] += a[3 * (i / 3) + k] * b[3 * k + i % 3];
        }
    }
}

static void skew(const quad *u, quad *r)
{
    const quad entries[9] = {0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0};
    memcpy(r, entries, sizeof entries);
}

/*
 * The sum of R[u]^n / (n + shift)!: e^R[u] for 0, its mean over the turn, which is J_l, for 1. To |u| = 20.
 */
static void series(const quad *u, int shift, quad *sum)
{
    quad r[9], term[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, next[9];
    skew(u, r);
    memcpy(sum, term, sizeof term);
    for (int n = 1; n < 120; n++) {
        multiply(term, r, next);
        for (int i = 0; i < 9; i++) {
            term[i] = next[i] / (n + shift);
            sum[i] += term[i];
        }
    }
}

static void widen(const mct_real *narrow, quad *wide, int count)
{
    for (int i = 0; i < count; i++) {
        wide[i] = (quad)narrow[i];
    }
}

static void exponential_of(const mct_real *u, quad *r)
{
    quad wide[3];
    widen(u, wide, 3);
    series(wide, 0, r);
}

static double distance(const quad *wanted, const mct_real *found, int count)
{
    double worst = 0;
    for (int i = 0; i < count; i++) {
        worst = fmax(worst, (double)quad_abs(wanted[i] - (quad)found[i]));
    }
    return worst;
}

static double length_of(const mct_real *a)
{
    return hypot(hypot((double)a[0], (double)a[1]), (double)a[2]);
}

static double gap(const mct_real *a, const mct_real *b)
{
    const mct_real difference[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return length_of(difference);
}

/* --- samples --- */

static void random_direction(test_random *random, double length, mct_real *a)
{
    double x[3], size = 0;
    while (size < 0.1 || size > 1) {
        for (int i = 0; i < 3; i++) {
            x[i] = random_in(random, -1, 1);
        }
        size = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    }
    for (int i = 0; i < 3; i++) {
        a[i] = (mct_real)(length * x[i] / size);
    }
}

/* Angles of every size, and those close to where a form of a rotation may fail. */
static double sample_angle(test_random *random, int trial)
{
    static const double special[] = {0, PI, 2 * PI, 0.5, 2, 4 * PI};
    if (trial % 3 == 0) {
        const double off = random_scale(random, 1e-12, 1e-2);
        return fabs(special[trial / 3 % 6] + (trial % 2 ? off : -off));
    }
    return trial % 3 == 1 ? random_in(random, 0, 12) : random_scale(random, 1e-15, 1);
}

/* --- the rules --- */

/* A rounding of u turns the result by |u| roundings. */
static void test_every_form_of_a_rotation_is_the_exponential_of_its_vector(void)
{
    test_random random = {1};
    double worst = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        mct_real u[3], q[4], r[9], by_quaternion[9], b[3], x[3], back[3];
        quad wanted[9], turned[3] = {0};
        const double angle = sample_angle(&random, trial);
        random_direction(&random, angle, u);
        random_direction(&random, 1, b);
        exponential_of(u, wanted);
        mct_matrix_of_vector(u, r);
        mct_quaternion_of_vector(u, q);
        mct_matrix_of_quaternion(q, by_quaternion);
        mct_rotate(q, b, x);
        mct_rotate_back(q, x, back);
        for (int i = 0; i < 9; i++) {
            turned[i / 3] += wanted[i] * (quad)b[i % 3];
        }
        const double error = fmax(fmax(distance(wanted, r, 9), distance(wanted, by_quaternion, 9)),
                                  fmax(distance(turned, x, 3), gap(b, back)));
        worst = fmax(worst, error / (EPSILON * (1 + angle)));
    }
    printf("forms of a rotation: %.1f roundings\n", worst);
    TEST_ASSERT_TRUE(worst <= 4);
}

static void test_skew_is_the_cross_product(void)
{
    const mct_real u[] = {1, -2, 3}, y[] = {5, 7, -4};
    mct_real r[9], wanted[3];
    mct_skew(u, r);
    mct_cross(u, y, wanted);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(mct_dot(r + 3 * i, y) == wanted[i]);
    }
}

static void test_the_matrices_about_the_main_axes_are_236_to_238(void)
{
    const double s = sin(0.7), c = cos(0.7);
    const double wanted[3][9] = {
        {1, 0, 0, 0, c, -s, 0, s, c}, {c, 0, s, 0, 1, 0, -s, 0, c}, {c, -s, 0, s, c, 0, 0, 0, 1}};
    for (int axis = 0; axis < 3; axis++) {
        mct_real u[3] = {0}, r[9];
        u[axis] = MCT_R(0.7);
        mct_matrix_of_vector(u, r);
        for (int i = 0; i < 9; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(2 * EPSILON, wanted[axis][i], (double)r[i]);
        }
    }
}

static void test_a_product_is_one_rotation_after_the_other_and_the_inverse_undoes_it(void)
{
    test_random random = {2};
    for (int trial = 0; trial < TRIALS; trial++) {
        mct_real u[3], a[4], b[4], ab[4], inverse[4], one[4], y[3], once[3], twice[3], at_once[3];
        random_direction(&random, sample_angle(&random, trial), u);
        mct_quaternion_of_vector(u, a);
        random_direction(&random, sample_angle(&random, trial + 1), u);
        mct_quaternion_of_vector(u, b);
        random_direction(&random, 1, y);
        mct_quaternion_multiply(a, b, ab);
        mct_rotate(b, y, once);
        mct_rotate(a, once, twice);
        mct_rotate(ab, y, at_once);
        TEST_ASSERT_TRUE(gap(twice, at_once) <= 16 * EPSILON);
        mct_quaternion_inverse(a, inverse);
        mct_quaternion_multiply(a, inverse, one);
        TEST_ASSERT_DOUBLE_WITHIN(4 * EPSILON, 1, (double)one[0]);
        TEST_ASSERT_TRUE(length_of(one + 1) <= 4 * EPSILON);
    }
}

/* Relative to the vector, down to 1e-15 rad; a matrix knows a small angle to a rounding of 1 at worst. */
static void test_a_vector_comes_back_from_its_quaternion_and_its_matrix(void)
{
    test_random random = {3};
    for (int trial = 0; trial < TRIALS; trial++) {
        mct_real u[3], q[4], r[9], from_quaternion[3], from_matrix[3];
        const double angle = trial % 2 ? random_in(&random, 0, 3.1) : random_scale(&random, 1e-15, 1);
        random_direction(&random, angle, u);
        mct_quaternion_of_vector(u, q);
        mct_matrix_of_vector(u, r);
        mct_vector_of_quaternion(q, from_quaternion);
        mct_vector_of_matrix(r, from_matrix);
        TEST_ASSERT_TRUE(gap(u, from_quaternion) <= 8 * EPSILON * angle);
        TEST_ASSERT_TRUE(gap(u, from_matrix) <= 8 * EPSILON * angle);
    }
}

/* Around half a turn u and its other side are close to one rotation, so the rotations are compared. */
static void test_matrices_of_about_half_a_turn_keep_their_axis(void)
{
    test_random random = {4};
    double worst = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        mct_real u[3], r[9], q[4], found[3];
        quad wanted[9];
        if (trial < 6) { /* exactly half a turn about an axis, either way */
            u[0] = u[1] = u[2] = 0;
            u[trial % 3] = MCT_R(trial < 3 ? PI : -PI);
        } else {
            random_direction(&random, PI + (trial % 2 ? 1 : -1) * random_scale(&random, 1e-9, 1), u);
        }
        mct_matrix_of_vector(u, r);
        mct_quaternion_of_matrix(r, q);
        TEST_ASSERT_TRUE(q[0] >= 0);
        TEST_ASSERT_DOUBLE_WITHIN(2 * EPSILON, 0, (double)mct_quaternion_defect(q));
        mct_vector_of_matrix(r, found);
        TEST_ASSERT_TRUE(length_of(found) <= PI * (1 + 2 * EPSILON));
        exponential_of(found, wanted);
        worst = fmax(worst, distance(wanted, r, 9) / EPSILON);
    }
    printf("half a turn: %.1f roundings\n", worst);
    TEST_ASSERT_TRUE(worst <= 16); /* pi roundings of the vector, and those of the matrix both ways */
}

static void test_q_and_minus_q_are_one_rotation_whatever_their_length(void)
{
    const mct_real q[] = {MCT_R(0.5), MCT_R(0.1), MCT_R(-0.7), MCT_R(0.5)};
    const mct_real other[] = {-3 * q[0], -3 * q[1], -3 * q[2], -3 * q[3]};
    mct_real u[3], same[3];
    mct_vector_of_quaternion(q, u);
    mct_vector_of_quaternion(other, same);
    TEST_ASSERT_TRUE(gap(u, same) <= 8 * EPSILON);
}

/*
 * Hard case 10. sin^2(a/4) and sin(a/2)/a in quadruple precision; a vector far below a rounding of 1 is not
 * lost.
 */
static void test_a_small_turn_keeps_all_its_digits(void)
{
    test_random random = {5};
    double worst = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        mct_real u[3], e[4];
        quad wide[3];
        random_direction(&random, trial % 2 ? random_scale(&random, 1e-15, 6) : random_in(&random, 0.4, 0.6),
                         u);
        widen(u, wide, 3);
        const quad angle = quad_sqrt(wide[0] * wide[0] + wide[1] * wide[1] + wide[2] * wide[2]);
        const quad quarter = quad_sin(angle / 4);
        mct_quaternion_turn(u, e);
        worst = fmax(worst, fabs((double)((quad)e[0] / (-2 * quarter * quarter) - 1)) / EPSILON);
        for (int i = 0; i < 3; i++) {
            const quad wanted = quad_sin(angle / 2) / angle * wide[i];
            /* the sine is sure to roundings of the angle, which near 2 pi is all that there is of it */
            worst =
                fmax(worst, fabs((double)((quad)e[i + 1] - wanted)) / (EPSILON * fmin(1, (double)angle / 2)));
        }
    }
    printf("a small turn: %.1f roundings\n", worst);
    TEST_ASSERT_TRUE(worst <= 6);
    const mct_real none[3] = {0, 0, 0};
    mct_real e[4];
    mct_quaternion_turn(none, e);
    TEST_ASSERT_TRUE(e[0] == 0 && e[1] == 0 && e[2] == 0 && e[3] == 0);
}

static void test_increments_turn_about_axes_of_the_body_or_of_space(void)
{
    test_random random = {6};
    for (int trial = 0; trial < TRIALS; trial++) {
        mct_real u[3], q[4], b[3], turn[4], increment[4], x[3], y[3], wanted[3];
        random_direction(&random, sample_angle(&random, trial), u);
        mct_quaternion_of_vector(u, q);
        random_direction(&random, sample_angle(&random, trial + 1), u);
        mct_quaternion_of_vector(u, turn);
        random_direction(&random, 1, b);

        mct_quaternion_turn_body(q, u, increment);
        for (int i = 0; i < 4; i++) {
            increment[i] += q[i];
        }
        mct_rotate(increment, b, x);
        mct_rotate(turn, b, y); /* first the turn, in the body; then q */
        mct_rotate(q, y, wanted);
        TEST_ASSERT_TRUE(gap(x, wanted) <= 16 * EPSILON);

        mct_quaternion_turn_space(q, u, increment);
        for (int i = 0; i < 4; i++) {
            increment[i] += q[i];
        }
        mct_rotate(increment, b, x);
        mct_rotate(q, b, y);
        mct_rotate(turn, y, wanted);
        TEST_ASSERT_TRUE(gap(x, wanted) <= 16 * EPSILON);
    }
}

/*
 * The increment of a short time, over that time: the second term is half the time times a second rate,
 * |w|^2/4.
 */
static void test_rates_are_increments_over_a_short_time(void)
{
    const mct_real q[] = {MCT_R(0.5), MCT_R(0.1), MCT_R(-0.7), MCT_R(0.5)};
    const mct_real w[] = {MCT_R(0.3), MCT_R(-1.1), MCT_R(0.4)};
    const double time = 0x1p-10;
    const mct_real u[] = {MCT_R(0x1p-10) * w[0], MCT_R(0x1p-10) * w[1], MCT_R(0x1p-10) * w[2]};
    mct_real increment[4], rate[4];
    mct_quaternion_turn_body(q, u, increment);
    mct_quaternion_rate_body(q, w, rate);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(0.25 * time, (double)rate[i], (double)increment[i] / time);
    }
    mct_quaternion_turn_space(q, u, increment);
    mct_quaternion_rate_space(q, w, rate);
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(0.25 * time, (double)rate[i], (double)increment[i] / time);
    }
}

/*
 * Hard cases 11 and 13: 2^18 turns of 1/1024 rad, 40 revolutions. Each adds at most two roundings of
 * direction, so the rotation errs by at most 2^18 of them; the length, held by Newton's step, by a few.
 */
static void test_a_quaternion_turned_by_small_increments_passes_full_turns_and_keeps_its_length(void)
{
    enum { TURNS = 1 << 18 };
    const mct_real u[] = {MCT_R(0x1p-11), MCT_R(0x1p-11), MCT_R(0x1.6a09e6p-11)};
    mct_real q[4] = {1, 0, 0, 0}, increment[4];
    for (int k = 0; k < TURNS; k++) {
        mct_quaternion_turn_body(q, u, increment);
        const mct_real defect = mct_quaternion_defect(q);
        double square = 0;
        for (int i = 0; i < 4; i++) {
            q[i] += increment[i] + defect * q[i];
            square += (double)q[i] * (double)q[i];
        }
        TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON, 1, square);
    }
    const double size = sqrt((double)u[0] * (double)u[0] * 2 + (double)u[2] * (double)u[2]);
    const double half = 0.5 * TURNS * size;
    TEST_ASSERT_DOUBLE_WITHIN(TURNS * EPSILON, fabs(cos(half)), fabs((double)q[0]));
    TEST_ASSERT_DOUBLE_WITHIN(TURNS * EPSILON, fabs(sin(half)) * (double)u[2] / size, fabs((double)q[3]));
}

/* --- the rate of a rotation vector --- */

static void test_stumpff_functions_are_their_series_and_their_recurrence(void)
{
    for (int k = 0; k <= 160; k++) {
        mct_real c[7];
        const mct_real s = (mct_real)(0.0625 * k);
        mct_stumpff(s, c);
        for (int n = 0; n < 7; n++) {
            quad term = 1, sum = 0;
            for (int i = 2; i <= n; i++) {
                term /= i;
            }
            for (int j = 0; j < 40; j++) {
                sum += term;
                term *= -(quad)s / ((n + 2 * j + 1) * (n + 2 * j + 2));
            }
            /* terms of size 1 cancel; from s = 4 on, c[n + 2] is c[n] of rounded numbers over s */
            TEST_ASSERT_DOUBLE_WITHIN(4 * EPSILON, (double)sum, (double)c[n]);
        }
    }
}

static void test_the_left_jacobian_is_the_mean_of_the_turn_and_the_right_one_its_transpose(void)
{
    test_random random = {7};
    double worst = 0;
    for (int trial = 0; trial < TRIALS; trial++) {
        mct_real u[3], left[9], right[9], inverse[9];
        quad wide[3], wanted[9], turned[9], other[9];
        const double angle = sample_angle(&random, trial);
        random_direction(&random, angle, u);
        widen(u, wide, 3);
        series(wide, 1, wanted);
        for (int i = 0; i < 9; i++) {
            turned[i] = wanted[3 * (i % 3) + i / 3];
        }
        mct_left_jacobian(u, left);
        mct_right_jacobian(u, right);
        worst = fmax(worst, distance(wanted, left, 9) / (EPSILON * (1 + angle)));
        worst = fmax(worst, distance(turned, right, 9) / (EPSILON * (1 + angle)));
        if (angle > 6) {
            continue;
        }
        const quad one[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
        const double condition = 1 + 1 / (2 * PI - angle);
        mct_real product[9];
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_left_jacobian_inverse(u, inverse));
        widen(inverse, other, 9);
        multiply(other, wanted, turned);
        for (int i = 0; i < 9; i++) {
            product[i] = (mct_real)turned[i];
        }
        worst = fmax(worst, distance(one, product, 9) / (EPSILON * (1 + angle) * condition));
    }
    printf("Jacobians: %.1f roundings\n", worst);
    TEST_ASSERT_TRUE(worst <= 8);
}

/*
 * dr/dt r' = R[J_l du/dt]: what (242) leaves out. Differences of order 4 over 1e-3 of an angle err by about
 * 1e-12.
 */
static void test_the_angular_velocity_is_the_left_jacobian_times_the_rate_of_the_vector(void)
{
    const mct_real u[] = {MCT_R(0.3), MCT_R(-1.7), MCT_R(1.1)},
                   rate[] = {MCT_R(0.8), MCT_R(0.5), MCT_R(-0.4)};
    const int steps[] = {-2, -1, 1, 2}, weights[] = {1, -8, 8, -1};
    quad r[9], r_rate[9] = {0}, transposed[9], wanted[9];
    exponential_of(u, r);
    for (int k = 0; k < 4; k++) {
        quad near[3], at[9];
        for (int i = 0; i < 3; i++) {
            near[i] = (quad)u[i] + (quad)rate[i] * steps[k] / 1000;
        }
        series(near, 0, at);
        for (int i = 0; i < 9; i++) {
            r_rate[i] += at[i] * weights[k] * 1000 / 12;
        }
    }
    for (int i = 0; i < 9; i++) {
        transposed[i] = r[3 * (i % 3) + i / 3];
    }
    multiply(r_rate, transposed, wanted);
    mct_real left[9], w[3], w_cross[9];
    mct_left_jacobian(u, left);
    for (int i = 0; i < 3; i++) {
        w[i] = mct_dot(left + 3 * i, rate);
    }
    mct_skew(w, w_cross);
    TEST_ASSERT_TRUE(distance(wanted, w_cross, 9) <= 1e-11 + 8 * EPSILON);
}

/* The figures of the errata, to their three places. */
static void
test_the_rate_of_the_vector_follows_from_the_angular_velocity_of_the_body_as_in_419_corrected(void)
{
    const mct_real u[] = {MCT_R(0.3), MCT_R(-0.7), MCT_R(1.1)}, w[] = {1, 2, MCT_R(-1.5)};
    const double wanted[] = {0.200, 2.633, -0.879};
    mct_real inverse[9];
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_right_jacobian_inverse(u, inverse));
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(5e-4, wanted[i], (double)mct_dot(inverse + 3 * i, w));
    }
}

static void test_the_jacobian_has_no_inverse_at_full_turns_but_at_none(void)
{
    mct_real matrix[9];
    for (int turns = 1; turns <= 3; turns++) {
        const mct_real u[] = {0, MCT_R(2 * PI * turns), 0};
        TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, mct_left_jacobian_inverse(u, matrix));
        TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, mct_right_jacobian_inverse(u, matrix));
    }
    const mct_real none[] = {0, 0, 0};
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_left_jacobian_inverse(none, matrix));
    for (int i = 0; i < 9; i++) {
        TEST_ASSERT_TRUE(matrix[i] == (i % 4 == 0 ? 1 : 0));
    }
}

/* --- motion in polar coordinates --- */

static void check_polar(const mct_real *o, const mct_real *b, const mct_real *x, const mct_real *v)
{
    mct_polar_motion motion;
    mct_real arm[3], from[3], r[9], turned[3], sum[3], spin[3];
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_polar_decomposition(o, b, x, v, &motion));
    for (int i = 0; i < 3; i++) {
        arm[i] = x[i] - o[i];
        from[i] = b[i] - o[i];
        sum[i] = motion.radial_velocity[i] + motion.tangential_velocity[i];
    }
    const double size = length_of(arm), speed = length_of(v);
    mct_matrix_of_vector(motion.rotation, r);
    for (int i = 0; i < 3; i++) {
        turned[i] = motion.scale * mct_dot(r + 3 * i, from);
    }
    TEST_ASSERT_TRUE(gap(arm, turned) <= 16 * EPSILON * size); /* (288) */
    TEST_ASSERT_TRUE(gap(v, sum) <= 8 * EPSILON * speed);      /* (291) */
    TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON * size * speed, 0,
                              (double)mct_dot(arm, motion.tangential_velocity));
    mct_cross(arm, motion.radial_velocity, spin);
    TEST_ASSERT_TRUE(length_of(spin) <= 8 * EPSILON * size * speed);
    TEST_ASSERT_TRUE(length_of(motion.rotation) <= PI * (1 + 2 * EPSILON)); /* and no spin about the arm: */
    TEST_ASSERT_DOUBLE_WITHIN(16 * EPSILON * length_of(from), 0, (double)mct_dot(motion.rotation, from));
    TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON * speed, (double)motion.scale_rate * size,
                              (double)motion.scale * (double)mct_dot(arm, v) / size);
}

static void test_any_motion_is_a_turn_about_a_point_and_a_motion_away_from_it(void)
{
    test_random random = {8};
    for (int trial = 0; trial < TRIALS; trial++) {
        mct_real o[3], b[3], x[3], v[3];
        random_direction(&random, 2, o);
        random_direction(&random, random_scale(&random, 0.1, 10), b);
        random_direction(&random, random_scale(&random, 0.1, 10), x);
        random_direction(&random, random_scale(&random, 1e-3, 1e3), v);
        if (trial % 4 >=
            2) { /* the particle ahead of its reference, or opposite to it, by little or exactly */
            const double off = trial % 8 >= 6 ? 0 : random_scale(&random, 1e-10, 1e-2);
            for (int i = 0; i < 3; i++) {
                x[i] = (mct_real)(off * (double)x[i]) + (trial % 2 ? b[i] - o[i] : o[i] - b[i]) + o[i];
            }
        }
        check_polar(o, b, x, v);
    }
    for (int axis = 0; axis < 3; axis++) { /* exactly opposite along an axis: another one turns it */
        const mct_real o[3] = {0}, v[3] = {1, 1, 1};
        mct_real b[3] = {0}, x[3] = {0};
        b[axis] = 1;
        x[axis] = -2;
        check_polar(o, b, x, v);
    }
}

static void test_a_particle_at_the_point_itself_has_no_polar_coordinates(void)
{
    const mct_real o[] = {1, 2, 3}, b[] = {1, 2, 4}, v[] = {1, 0, 0};
    mct_polar_motion motion;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, mct_polar_decomposition(o, b, o, v, &motion));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, mct_polar_decomposition(o, o, b, v, &motion));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_form_of_a_rotation_is_the_exponential_of_its_vector);
    RUN_TEST(test_skew_is_the_cross_product);
    RUN_TEST(test_the_matrices_about_the_main_axes_are_236_to_238);
    RUN_TEST(test_a_product_is_one_rotation_after_the_other_and_the_inverse_undoes_it);
    RUN_TEST(test_a_vector_comes_back_from_its_quaternion_and_its_matrix);
    RUN_TEST(test_matrices_of_about_half_a_turn_keep_their_axis);
    RUN_TEST(test_q_and_minus_q_are_one_rotation_whatever_their_length);
    RUN_TEST(test_a_small_turn_keeps_all_its_digits);
    RUN_TEST(test_increments_turn_about_axes_of_the_body_or_of_space);
    RUN_TEST(test_rates_are_increments_over_a_short_time);
    RUN_TEST(test_a_quaternion_turned_by_small_increments_passes_full_turns_and_keeps_its_length);
    RUN_TEST(test_stumpff_functions_are_their_series_and_their_recurrence);
    RUN_TEST(test_the_left_jacobian_is_the_mean_of_the_turn_and_the_right_one_its_transpose);
    RUN_TEST(test_the_angular_velocity_is_the_left_jacobian_times_the_rate_of_the_vector);
    RUN_TEST(test_the_rate_of_the_vector_follows_from_the_angular_velocity_of_the_body_as_in_419_corrected);
    RUN_TEST(test_the_jacobian_has_no_inverse_at_full_turns_but_at_none);
    RUN_TEST(test_any_motion_is_a_turn_about_a_point_and_a_motion_away_from_it);
    RUN_TEST(test_a_particle_at_the_point_itself_has_no_polar_coordinates);
    return UNITY_END();
}

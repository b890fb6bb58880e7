/* The rules of include/mctau/matrix.h: square root, elimination, matrix exponential. All in double. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/matrix.h"
#include "unity.h"

static const double infinite = (double)INFINITY;
static const double not_a_number = (double)NAN;

void setUp(void)
{
}

void tearDown(void)
{
}

static uint64_t random_state = 1;

static uint64_t random_bits(void)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return random_state * UINT64_C(2685821657736338717);
}

/* In [-1, 1) */
static double random_number(void)
{
    return (double)(random_bits() >> 11) * 0x1p-52 - 1.0;
}

static double from_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* IEEE requires a correctly rounded root of libm's sqrt, so it is a reference to the bit. */
static void test_square_root_is_correctly_rounded(void)
{
    for (int i = 0; i < 300000; i++) {
        const double x = from_bits(random_bits() & UINT64_C(0x7fefffffffffffff));
        TEST_ASSERT_TRUE(mct_sqrt(x) == sqrt(x));
    }
}

static void test_square_root_is_exact_for_squares_and_rounds_their_neighbours(void)
{
    for (int i = 0; i < 20000; i++) {
        const double root = (double)(random_bits() >> 38);
        const double square = root * root;
        TEST_ASSERT_TRUE(mct_sqrt(square) == root);
        TEST_ASSERT_TRUE(mct_sqrt(nextafter(square, 0.0)) == sqrt(nextafter(square, 0.0)));
        TEST_ASSERT_TRUE(mct_sqrt(nextafter(square, 1e300)) == sqrt(nextafter(square, 1e300)));
    }
}

static void test_square_root_covers_the_ends_of_the_range(void)
{
    const double ends[] = {DBL_MAX,
                           DBL_MIN,
                           nextafter(DBL_MIN, 0.0),
                           0x1p-1074,
                           0x1.8p-1073,
                           1.0,
                           nextafter(1.0, 0.0),
                           nextafter(4.0, 0.0),
                           nextafter(2.0, 0.0)};
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        TEST_ASSERT_TRUE(mct_sqrt(ends[i]) == sqrt(ends[i]));
    }
    for (int i = 0; i < 2000; i++) {
        const double subnormal = from_bits(random_bits() >> 12);
        TEST_ASSERT_TRUE(mct_sqrt(subnormal) == sqrt(subnormal));
    }
}

static void test_square_root_of_what_has_none_is_nan_or_itself(void)
{
    TEST_ASSERT_TRUE(isnan(mct_sqrt(-1.0)) && !signbit(mct_sqrt(-1.0)));
    TEST_ASSERT_TRUE(isnan(mct_sqrt(-infinite)));
    TEST_ASSERT_TRUE(isnan(mct_sqrt(not_a_number)));
    TEST_ASSERT_TRUE(mct_sqrt(infinite) == infinite);
    TEST_ASSERT_TRUE(mct_sqrt(0.0) == 0.0 && !signbit(mct_sqrt(0.0)));
    TEST_ASSERT_TRUE(mct_sqrt(-0.0) == 0.0 && signbit(mct_sqrt(-0.0)));
}

static void test_square_root_of_the_core_is_correctly_rounded_wherever_it_is(void)
{
    const mct_real least = MCT_REAL_IS_FLOAT ? (mct_real)FLT_MIN : (mct_real)DBL_MIN;
    const mct_real ends[] = {0, MCT_REAL_MAX, least, least / 2, least * MCT_REAL_EPSILON};
    for (int i = 0; i < 100000; i++) {
        const int exponent = (int)(random_number() * (MCT_REAL_IS_FLOAT ? 277 : 2098));
        const double drawn = ldexp(random_number() + 1.0, exponent - (MCT_REAL_IS_FLOAT ? 149 : 1074));
        const mct_real x = i < 5 ? ends[i] : (mct_real)drawn;
#if MCT_REAL_IS_FLOAT
        TEST_ASSERT_TRUE(mct_sqrt_real(x) == sqrtf(x));
#else
        TEST_ASSERT_TRUE(mct_sqrt_real(x) == sqrt(x));
#endif
    }
    const mct_real of_negative = mct_sqrt_real(-1);
    TEST_ASSERT_TRUE(isnan(of_negative) && !signbit(of_negative));
    TEST_ASSERT_TRUE(isinf(mct_sqrt_real((mct_real)INFINITY)) && signbit(mct_sqrt_real(MCT_R(-0.0))));
}

static void test_products_and_transposes_take_any_shape(void)
{
    const double a[] = {1, 2, 3, 4, 5, 6};   /* 2 x 3 */
    const double b[] = {1, 0, -1, 2, 3, -3}; /* 3 x 2 */
    const double wanted[] = {8, -5, 17, -8};
    double product[4];
    mct_matrix_multiply(2, 3, 2, a, b, product);
    TEST_ASSERT_EQUAL_DOUBLE_ARRAY(wanted, product, 4);
    const double turned[] = {1, 4, 2, 5, 3, 6};
    double transposed[6];
    mct_matrix_transpose(2, 3, a, transposed);
    TEST_ASSERT_EQUAL_DOUBLE_ARRAY(turned, transposed, 6);
}

/* Backward stable: the residual is some n roundings of |a| |x|, whatever the condition. */
static void test_elimination_leaves_a_residual_of_rounding(void)
{
    for (int n = 1; n <= MCT_MATRIX_MAX; n++) {
        for (int trial = 0; trial < 50; trial++) {
            double a[MCT_MATRIX_MAX * MCT_MATRIX_MAX];
            double kept[MCT_MATRIX_MAX * MCT_MATRIX_MAX];
            double b[MCT_MATRIX_MAX * 3];
            double x[MCT_MATRIX_MAX * 3];
            for (int i = 0; i < n * n; i++) {
                kept[i] = a[i] = random_number();
            }
            for (int i = 0; i < n * 3; i++) {
                x[i] = b[i] = random_number();
            }
            TEST_ASSERT_EQUAL_INT(MCT_OK, mct_matrix_solve(n, 3, a, x));
            for (int i = 0; i < n; i++) {
                for (int j = 0; j < 3; j++) {
                    double residual = -b[i * 3 + j];
                    double size = 1.0;
                    for (int k = 0; k < n; k++) {
                        residual += kept[i * n + k] * x[k * 3 + j];
                        size += fabs(x[k * 3 + j]);
                    }
                    TEST_ASSERT_TRUE(fabs(residual) < 50 * DBL_EPSILON * size);
                }
            }
        }
    }
}

static void test_inverse_times_matrix_is_one(void)
{
    const double a[] = {0, 2, 0, 1, 0, 0, 0, 0, -4};
    const double wanted[] = {0, 1, 0, 0.5, 0, 0, 0, 0, -0.25};
    double inverse[9];
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_matrix_inverse(3, a, inverse));
    TEST_ASSERT_EQUAL_DOUBLE_ARRAY(wanted, inverse, 9);
}

static void test_units_do_not_make_a_matrix_singular(void)
{
    /* [[2, 1], [1, 1]] with its rows and columns in units of 1e+-20: answers scale, and keep their digits */
    double a[] = {2e20, 1e-20, 1, 1e-40};
    double b[] = {3e20, 2};
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_matrix_solve(2, 1, a, b));
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, 1.0, b[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e26, 1e40, b[1]);
    /* a permutation in such units: the rows' sizes must move with the rows */
    double permutation[] = {0, 2e-20, 0, 0, 0, 3, 4e20, 0, 0};
    double c[] = {2e-20 * 5, 3 * 6, 4e20 * 7};
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_matrix_solve(3, 1, permutation, c));
    const double wanted[] = {7, 5, 6};
    TEST_ASSERT_EQUAL_DOUBLE_ARRAY(wanted, c, 3);
}

static void test_a_singular_matrix_is_reported(void)
{
    double third[] = {1, 2, 3, 4, 5, 6, 7, 8, 9}; /* rank 2, and elimination leaves a pivot of rounding */
    double zero[] = {0, 0, 0, 1};
    double b[3] = {1, 1, 1};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, mct_matrix_solve(3, 1, third, b));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, mct_matrix_solve(2, 1, zero, b));
}

static void test_bad_matrices_are_refused(void)
{
    double a[] = {1, 0, 0, not_a_number};
    double b[4] = {1, 1, 1, 1};
    double x[4];
    double right[] = {infinite, 1};
    double one[] = {1, 0, 0, 1};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, mct_matrix_solve(2, 1, a, b));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, mct_matrix_solve(2, 1, one, right));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, mct_matrix_solve(0, 1, a, b));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, mct_matrix_solve(2, -1, a, b));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, mct_matrix_solve(MCT_MATRIX_MAX + 1, 1, a, b));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, mct_matrix_inverse(MCT_MATRIX_MAX + 1, a, x));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, mct_expm1(MCT_MATRIX_MAX + 1, a, x));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, mct_expm1(0, a, x));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, mct_expm1(2, a, x));
    a[3] = 1e30;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_expm1(2, a, x));
    a[3] = 1000;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_expm1(2, a, x));
}

/* Each doubling adds a rounding or two, and there are log2(norm) + 1 of them. */
static void test_exponential_of_a_number_agrees_with_expm1(void)
{
    double worst = 0.0;
    for (double size = 1e-300; size < 800.0; size *= 1.7) {
        for (int sign = -1; sign <= 1; sign += 2) {
            const double a = sign * size;
            if (a > 700.0) {
                continue;
            }
            double x;
            TEST_ASSERT_EQUAL_INT(MCT_OK, mct_expm1(1, &a, &x));
            const double doublings = size > 1 ? log2(size) + 1 : 1;
            const double error = fabs(x / expm1(a) - 1) / (DBL_EPSILON * (a > 1 ? a : doublings));
            worst = fmax(worst, error);
        }
    }
    printf("mctau: expm1 of a number, max error %.2f epsilon per doubling (per unit of a > 1)\n", worst);
    TEST_ASSERT_TRUE(worst < 4.0);
}

static void test_stiff_parts_end_at_minus_one_beside_slow_ones(void)
{
    /* rates 1e5, 1 and 1e-9 over a tick of 1 ms: no entry suffers from its neighbours */
    const double a[9] = {-1e5 * 1e-3, 0, 0, 0, -1e-3, 0, 0, 0, -1e-12};
    double x[9];
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_expm1(3, a, x));
    TEST_ASSERT_EQUAL_DOUBLE(-1.0, x[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-3 * 16 * DBL_EPSILON, expm1(-1e-3), x[4]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12 * 16 * DBL_EPSILON, expm1(-1e-12), x[8]);
    for (int i = 1; i < 8; i++) {
        TEST_ASSERT_TRUE(i == 4 || x[i] == 0.0);
    }
    const double stiffest = -1e15;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_expm1(1, &stiffest, x));
    TEST_ASSERT_EQUAL_DOUBLE(-1.0, x[0]);
}

/*
 * A motor of L/R = 10 us on a wheel over 1 ms: (speed, current), where the slow rate, 1/200 s, comes from
 * the coupling alone. Reference: the two modes in long double.
 */
static void test_tiny_entries_survive_a_stiff_coupling(void)
{
    const double h = 1e-3;
    const double coupling = 500.0;
    const double a[4] = {0, h * coupling, -h * 1.0, -h * 1e5};
    double x[4];
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_expm1(2, a, x));
    const long double root = sqrtl(1e10L - 4.0L * 500.0L);
    const long double fast = (-1e5L - root) / 2;
    const long double slow = 500.0L / fast; /* their product is the determinant */
    const long double fast_h = (long double)h * fast;
    const long double slow_h = (long double)h * slow;
    /* e^a = (e^slow (a - fast) - e^fast (a - slow)) / (slow - fast) */
    const long double wanted_speed = (expm1l(slow_h) * -fast - expm1l(fast_h) * -slow) / (slow - fast);
    const long double wanted_mixed = (expm1l(slow_h) - expm1l(fast_h)) * 500.0L / (slow - fast);
    printf("mctau: expm1 of a stiff motor, relative error %.1e and %.1e of entries %.1e and %.1e\n",
           (double)(x[0] / wanted_speed - 1), (double)(x[1] / wanted_mixed - 1), x[0], x[1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, (double)(x[0] / wanted_speed - 1));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.0, (double)(x[1] / wanted_mixed - 1));
}

static void test_a_rotation_generator_gives_sine_and_cosine(void)
{
    for (double angle = 1e-6; angle < 20.0; angle *= 3.3) {
        const double a[4] = {0, -angle, angle, 0};
        double x[4];
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_expm1(2, a, x));
        const double versine = -2 * sin(angle / 2) * sin(angle / 2);
        const double slack = 8 * DBL_EPSILON * fmin(angle, 1.0) * fmax(angle, 1.0);
        TEST_ASSERT_DOUBLE_WITHIN(slack, sin(angle), x[2]);
        TEST_ASSERT_DOUBLE_WITHIN(slack, -sin(angle), x[1]);
        TEST_ASSERT_DOUBLE_WITHIN(slack * fmin(angle, 1.0), versine, x[0]);
        TEST_ASSERT_DOUBLE_WITHIN(slack * fmin(angle, 1.0), versine, x[3]);
    }
}

static void test_a_chain_gives_the_powers_of_time(void)
{
    /* nilpotent: e^a - 1 = a + a^2 / 2 + a^3 / 6 exactly, with entries down to 1e-9 / 6 */
    const double h = 1e-3;
    const double a[16] = {0, h, 0, 0, 0, 0, h, 0, 0, 0, 0, h, 0, 0, 0, 0};
    double x[16];
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_expm1(4, a, x));
    TEST_ASSERT_DOUBLE_WITHIN(4 * DBL_EPSILON * h, h, x[1]);
    TEST_ASSERT_DOUBLE_WITHIN(4 * DBL_EPSILON * h * h / 2, h * h / 2, x[2]);
    TEST_ASSERT_DOUBLE_WITHIN(4 * DBL_EPSILON * h * h * h / 6, h * h * h / 6, x[3]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, x[0]);
}

static void test_two_halves_make_a_whole(void)
{
    /* e^a - 1 = 2 x + x x of the half, for full matrices of the largest size */
    enum { N = MCT_MATRIX_MAX };
    double a[N * N];
    double whole[N * N];
    double half[N * N];
    double square[N * N];
    for (int i = 0; i < N * N; i++) {
        a[i] = random_number();
    }
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_expm1(N, a, whole));
    for (int i = 0; i < N * N; i++) {
        a[i] *= 0.5;
    }
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_expm1(N, a, half));
    mct_matrix_multiply(N, N, N, half, half, square);
    for (int i = 0; i < N * N; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-13, 2 * half[i] + square[i], whole[i]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_square_root_is_correctly_rounded);
    RUN_TEST(test_square_root_is_exact_for_squares_and_rounds_their_neighbours);
    RUN_TEST(test_square_root_covers_the_ends_of_the_range);
    RUN_TEST(test_square_root_of_what_has_none_is_nan_or_itself);
    RUN_TEST(test_square_root_of_the_core_is_correctly_rounded_wherever_it_is);
    RUN_TEST(test_products_and_transposes_take_any_shape);
    RUN_TEST(test_elimination_leaves_a_residual_of_rounding);
    RUN_TEST(test_inverse_times_matrix_is_one);
    RUN_TEST(test_units_do_not_make_a_matrix_singular);
    RUN_TEST(test_a_singular_matrix_is_reported);
    RUN_TEST(test_bad_matrices_are_refused);
    RUN_TEST(test_exponential_of_a_number_agrees_with_expm1);
    RUN_TEST(test_stiff_parts_end_at_minus_one_beside_slow_ones);
    RUN_TEST(test_tiny_entries_survive_a_stiff_coupling);
    RUN_TEST(test_a_rotation_generator_gives_sine_and_cosine);
    RUN_TEST(test_a_chain_gives_the_powers_of_time);
    RUN_TEST(test_two_halves_make_a_whole);
    return UNITY_END();
}

/*
 * The rules of include/mctau/sincos.h, held against long double; the largest errors found are printed. Where that is no
 * wider than double, doubles are held by the bits that they have elsewhere.
 */
#include <math.h>
#include <stdio.h>

#include "mctau/sincos.h"
#include "support/random.h"
#include "unity.h"

#define HALF_PI 1.570796326794896619231321691639751442L

enum {
    HAS_REFERENCE = LDBL_MANT_DIG >= 64, /* for doubles */
    THINNED = 1000 / TEST_CASES(1000)
};

void setUp(void)
{
}

void tearDown(void)
{
}

/* First to less than an eighth of a turn, which is exact: the reference needs its digits near zeros, too. */
static void reference_turn32(int32_t angle, long double *s, long double *c)
{
    const int64_t quadrant = ((int64_t)angle + INT64_C(0xa0000000)) / INT64_C(0x40000000) - 2;
    const int64_t rest = angle - quadrant * INT64_C(0x40000000);
    const long double x = (long double)rest * (HALF_PI / 1073741824.0L);
    const long double a = quadrant & 1 ? cosl(x) : sinl(x);
    const long double b = quadrant & 1 ? sinl(x) : cosl(x);
    *s = quadrant & 2 ? -a : a;
    *c = (quadrant + 1) & 2 ? -b : b;
}

static test_random random_state = {1};

static double random_within(double bound)
{
    return random_in(&random_state, -bound, bound);
}

/* Error in units in the last place of a format with that many digits. */
static double ulps(long double got, long double wanted, int digits)
{
    int exponent;
    frexpl(wanted, &exponent);
    return (double)(fabsl(got - wanted) / ldexpl(1.0L, exponent - digits));
}

static double error_f64(double x)
{
    double s;
    double c;
    mct_sincos_f64(x, &s, &c);
    return fmax(ulps(s, sinl(x), DBL_MANT_DIG), ulps(c, cosl(x), DBL_MANT_DIG));
}

static double error_f32(float x)
{
    float s;
    float c;
    mct_sincos_f32(x, &s, &c);
    return fmax(ulps(s, sin((double)x), FLT_MANT_DIG), ulps(c, cos((double)x), FLT_MANT_DIG));
}

static double worst_random_f64(double bound, int count)
{
    double worst = 0.0;
    for (int i = 0; i < count; i++) {
        worst = fmax(worst, error_f64(random_within(bound)));
    }
    return worst;
}

/* Every `stride`-th float between two positive ones: steps of the last place are steps of the bits. */
static double worst_f32(float from, float to, uint32_t stride)
{
    double worst = 0.0;
    uint32_t bits;
    for (memcpy(&bits, &from, sizeof bits);; bits += stride) {
        float x;
        memcpy(&x, &bits, sizeof x);
        if (!(x <= to)) {
            return worst;
        }
        worst = fmax(worst, error_f32(x));
    }
}

/* The stated errors are the largest of all floats and of 9e7 doubles; this repeats them on a sample. */
static void test_double_errs_by_less_than_the_stated_ulps(void)
{
    const double pi = worst_random_f64(3.1415926535897931, TEST_CASES(200000));
    const double thousands = worst_random_f64(8192.0, TEST_CASES(200000));
    const double million = worst_random_f64(1e6, TEST_CASES(200000));
    printf("mctau: sincos double, max ulp: %.3f (pi), %.3f (8192), %.3f (1e6)\n", pi, thousands, million);
    TEST_ASSERT_TRUE(pi < 0.83 || !HAS_REFERENCE);
    TEST_ASSERT_TRUE(thousands < 0.83 || !HAS_REFERENCE);
    TEST_ASSERT_TRUE(million < 1.7 ||
                     !HAS_REFERENCE); /* the tail, 16 roundings there, meets no exact cosine */
}

static void test_float_errs_by_less_than_the_stated_ulps(void)
{
    const double pi = worst_f32(1e-4f, 3.1415927f, 211 * THINNED);
    const double thousands = worst_f32(3.1415927f, 8192.0f, 211 * THINNED);
    printf("mctau: sincos float, max ulp: %.3f (pi), %.3f (8192)\n", pi, thousands);
    TEST_ASSERT_TRUE(pi < 0.83);
    TEST_ASSERT_TRUE(thousands < 0.86);
}

static void test_the_angles_nearest_to_a_zero_lose_no_digits(void)
{
    double worst = 0.0;
    for (int n = 1; n < 636619; n += n < 10000 ? THINNED : 97 * THINNED) {
        worst = fmax(worst, error_f64((double)(n * HALF_PI)));
    }
    double worst_float = 0.0;
    for (int n = 1; n < 5215; n++) {
        worst_float = fmax(worst_float, error_f32((float)(n * HALF_PI)));
    }
    printf("mctau: sincos nearest to n pi/2, max ulp: %.3f double, %.3f float\n", worst, worst_float);
    TEST_ASSERT_TRUE(worst < 0.83 || !HAS_REFERENCE);
    TEST_ASSERT_TRUE(worst_float < 0.86);
}

/* One unit of the argument and one of the result, up to where the result becomes NaN. */
static void test_beyond_its_range_the_error_is_at_most_one_unit_of_the_angle(void)
{
    double worst = 0.0;
    for (double bound = 1e6; bound < 3e15; bound *= 1.5) {
        for (int i = 0; i < TEST_CASES(2000); i++) {
            const double x = random_within(bound);
            double s;
            double c;
            mct_sincos_f64(x, &s, &c);
            const double unit = ldexp(1.0, ilogb(x) - 52);
            const double error = (double)fmaxl(fabsl(s - sinl(x)), fabsl(c - cosl(x)));
            worst = fmax(worst, (error - DBL_EPSILON) / unit);
        }
    }
    double worst_float = 0.0;
    for (float x = 8192.0f; x < 3.2e6f; x *= 1 + 1e-5f * THINNED) {
        float s;
        float c;
        mct_sincos_f32(x, &s, &c);
        const double unit = ldexp(1.0, ilogb((double)x) - 23);
        const double error = fmax(fabs((double)s - sin((double)x)), fabs((double)c - cos((double)x)));
        worst_float = fmax(worst_float, (error - (double)FLT_EPSILON) / unit);
    }
    printf("mctau: sincos beyond its range, max ulp of x: %.3f double, %.3f float\n", worst, worst_float);
    TEST_ASSERT_TRUE(worst <= 1.0 || !HAS_REFERENCE);
    TEST_ASSERT_TRUE(worst_float <= 1.0);
}

static void test_no_angle_without_a_meaning_has_a_sine(void)
{
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY, 3.6e15, -3.6e15, 1e300, DBL_MAX};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        double s;
        double c;
        mct_sincos_f64(bad[i], &s, &c);
        TEST_ASSERT_TRUE(isnan(s) && isnan(c));
    }
    const float bad_float[] = {NAN, INFINITY, -INFINITY, 3.3e6f, -3.3e6f, 1e30f, FLT_MAX};
    for (size_t i = 0; i < sizeof bad_float / sizeof *bad_float; i++) {
        float s;
        float c;
        mct_sincos_f32(bad_float[i], &s, &c);
        TEST_ASSERT_TRUE(isnan(s) && isnan(c));
    }
}

static void test_sine_is_odd_and_cosine_is_even_to_the_bit(void)
{
    for (int i = 0; i < TEST_CASES(20000); i++) {
        const double x = random_within(1e5);
        double s[2];
        double c[2];
        mct_sincos_f64(x, &s[0], &c[0]);
        mct_sincos_f64(-x, &s[1], &c[1]);
        TEST_ASSERT_TRUE(s[1] == -s[0] && c[1] == c[0]);
        float t[2];
        float d[2];
        mct_sincos_f32((float)x, &t[0], &d[0]);
        mct_sincos_f32(-(float)x, &t[1], &d[1]);
        TEST_ASSERT_TRUE(t[1] == -t[0] && d[1] == d[0]);
    }
}

static void test_small_angles_are_their_own_sine(void)
{
    for (double x = 1e-8; x > DBL_MIN; x *= 0.1) {
        double s;
        double c;
        mct_sincos_f64(x, &s, &c);
        TEST_ASSERT_TRUE(s == x && c == 1.0);
    }
    for (float x = 1e-4f; x > FLT_MIN; x *= 0.1f) {
        float s;
        float c;
        mct_sincos_f32(x, &s, &c);
        TEST_ASSERT_TRUE(s == x && c == 1.0f);
    }
}

/* An error below one ulp lets a neighbour fall back by one, also across a seam at an odd multiple of pi/4. */
static void test_sine_rises_from_quarter_to_quarter_turn_without_a_step_back(void)
{
    float before = -1.0f;
    for (int i = -400000; i <= 400000; i += THINNED) {
        float s;
        float c;
        mct_sincos_f32((float)(HALF_PI / 400000) * (float)i, &s, &c);
        TEST_ASSERT_TRUE(s >= before - 0.5f * FLT_EPSILON);
        before = s;
    }
    for (int seam = 1; seam < 20; seam += 2) {
        double x = seam * (double)HALF_PI / 2;
        for (int i = 0; i < 200; i++) {
            x = nextafter(x, 0.0);
        }
        double s[2];
        double c[2];
        mct_sincos_f64(x, &s[0], &c[0]);
        for (int i = 0; i < 400; i++) {
            x = nextafter(x, 1e9);
            mct_sincos_f64(x, &s[1], &c[1]);
            const double slack = 0.5 * DBL_EPSILON;
            TEST_ASSERT_TRUE((s[1] - s[0]) * (c[0] > 0 ? 1 : -1) >= -slack);
            TEST_ASSERT_TRUE((c[0] - c[1]) * (s[0] > 0 ? 1 : -1) >= -slack);
            s[0] = s[1];
            c[0] = c[1];
        }
    }
}

static void test_binary_angle_errs_by_less_than_the_stated_ulps(void)
{
    double worst = 0.0;
    double worst_double = 0.0;
    for (int64_t i = INT32_MIN; i <= INT32_MAX; i += 6007 * THINNED) {
        const int32_t angle = (int32_t)i;
        long double wanted_s;
        long double wanted_c;
        reference_turn32(angle, &wanted_s, &wanted_c);
        float s;
        float c;
        double t;
        double d;
        mct_sincos_turn32(angle, &s, &c);
        mct_sincos_turn32_f64(angle, &t, &d);
        worst = fmax(worst, fmax(ulps(s, wanted_s, FLT_MANT_DIG), ulps(c, wanted_c, FLT_MANT_DIG)));
        worst_double = fmax(worst_double, ulps(t, wanted_s, DBL_MANT_DIG));
        worst_double = fmax(worst_double, ulps(d, wanted_c, DBL_MANT_DIG));
    }
    printf("mctau: sincos of binary angle, max ulp: %.3f float, %.3f double\n", worst, worst_double);
    TEST_ASSERT_TRUE(worst < 0.86);
    TEST_ASSERT_TRUE(worst_double < 0.83 || !HAS_REFERENCE);
}

static void test_every_quarter_of_a_binary_turn_is_exact(void)
{
    static const int32_t angle[] = {0, 0x40000000, INT32_MIN, -0x40000000};
    static const int sine[] = {0, 1, 0, -1};
    static const int cosine[] = {1, 0, -1, 0};
    for (int i = 0; i < 4; i++) {
        float s;
        float c;
        double t;
        double d;
        mct_sincos_turn32(angle[i], &s, &c);
        mct_sincos_turn32_f64(angle[i], &t, &d);
        TEST_ASSERT_TRUE(s == (float)sine[i] && c == (float)cosine[i]);
        TEST_ASSERT_TRUE(t == sine[i] && d == cosine[i]);
    }
}

static void test_smallest_binary_angles_keep_all_their_digits(void)
{
    for (int32_t i = -70000; i <= 70000; i += THINNED) {
        long double wanted_s;
        long double wanted_c;
        reference_turn32(i, &wanted_s, &wanted_c);
        float s[2];
        float c;
        mct_sincos_turn32(i, &s[0], &c);
        mct_sincos_turn32(i < 0 ? i + INT32_MAX + 1 : i + INT32_MIN, &s[1], &c);
        TEST_ASSERT_TRUE(ulps(s[0], wanted_s, FLT_MANT_DIG) < 0.86);
        TEST_ASSERT_TRUE(s[1] == -s[0]);
    }
}

/* FNV-1a */
static void hash_bytes(uint64_t *hash, const void *bytes, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        *hash = (*hash ^ ((const uint8_t *)bytes)[i]) * UINT64_C(0x100000001b3);
    }
}

static void test_sine_and_cosine_have_the_same_bits_on_every_machine(void)
{
    uint64_t hash = UINT64_C(0xcbf29ce484222325);
    test_random random = {5};
    for (int i = 0; i < 20000; i++) {
        const uint64_t bits = random_bits(&random);
        const double x = random_in(&random, -1, 1) * (double)(UINT64_C(1) << (bits & 31));
        const int32_t turn = (int32_t)(bits >> 33) - INT32_C(0x40000000);
        double s[2], c[2];
        float t[2], d[2];
        mct_sincos_f64(x, &s[0], &c[0]);
        mct_sincos_turn32_f64(turn, &s[1], &c[1]);
        mct_sincos_f32((float)random_in(&random, -8192, 8192), &t[0], &d[0]);
        mct_sincos_turn32(turn, &t[1], &d[1]);
        hash_bytes(&hash, s, sizeof s);
        hash_bytes(&hash, c, sizeof c);
        hash_bytes(&hash, t, sizeof t);
        hash_bytes(&hash, d, sizeof d);
    }
    TEST_ASSERT_TRUE(hash == UINT64_C(0x6667c2e9b034b56b));
}

static void test_the_core_takes_its_own_precision(void)
{
    mct_real s[2];
    mct_real c[2];
    mct_sincos(MCT_R(0.7), &s[0], &c[0]);
    mct_sincos_turn(123456789, &s[1], &c[1]);
#if MCT_REAL_IS_FLOAT
    float t[2];
    float d[2];
    mct_sincos_f32(0.7f, &t[0], &d[0]);
    mct_sincos_turn32(123456789, &t[1], &d[1]);
#else
    double t[2];
    double d[2];
    mct_sincos_f64(0.7, &t[0], &d[0]);
    mct_sincos_turn32_f64(123456789, &t[1], &d[1]);
#endif
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_TRUE(s[i] == t[i] && c[i] == d[i]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_double_errs_by_less_than_the_stated_ulps);
    RUN_TEST(test_float_errs_by_less_than_the_stated_ulps);
    RUN_TEST(test_the_angles_nearest_to_a_zero_lose_no_digits);
    RUN_TEST(test_beyond_its_range_the_error_is_at_most_one_unit_of_the_angle);
    RUN_TEST(test_no_angle_without_a_meaning_has_a_sine);
    RUN_TEST(test_sine_is_odd_and_cosine_is_even_to_the_bit);
    RUN_TEST(test_small_angles_are_their_own_sine);
    RUN_TEST(test_sine_rises_from_quarter_to_quarter_turn_without_a_step_back);
    RUN_TEST(test_binary_angle_errs_by_less_than_the_stated_ulps);
    RUN_TEST(test_every_quarter_of_a_binary_turn_is_exact);
    RUN_TEST(test_smallest_binary_angles_keep_all_their_digits);
    RUN_TEST(test_sine_and_cosine_have_the_same_bits_on_every_machine);
    RUN_TEST(test_the_core_takes_its_own_precision);
    return UNITY_END();
}

/* Inverse root and direction against libm in long double. */
#include <math.h>
#include <stdio.h>

#include "mctau/arctan.h"
#include "support/random.h"
#include "unity.h"

#define ROUNDING ((double)MCT_REAL_EPSILON)

enum { TRIALS = TEST_CASES(200000) };

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_the_inverse_root_is_within_two_roundings(void)
{
    test_random random = {11};
    double worst = 0;
    for (int k = 0; k < TRIALS; k++) {
        const mct_real x = (mct_real)(MCT_REAL_IS_FLOAT ? random_scale(&random, 2e-38, 1e38)
                                                        : random_scale(&random, 1e-307, 1e307));
        const long double exact = 1 / sqrtl((long double)x);
        worst = fmax(worst, fabs((double)(((long double)mct_inverse_root(x) - exact) / exact)));
    }
    printf("inverse root: %.2f roundings\n", worst / ROUNDING);
    TEST_ASSERT_TRUE(worst <= 2 * ROUNDING);
}

static void check_direction(mct_real x, mct_real y, double *worst)
{
    const mct_real size = (mct_real)sqrtl((long double)x * x + (long double)y * y);
    const long double exact = atan2l((long double)y, (long double)x);
    const double error = fabs((double)((long double)mct_direction(x, y, size) - exact));
    *worst = fmax(*worst, error == 0 ? 0 : error / fabs((double)exact));
}

static void test_the_direction_of_any_vector_is_within_three_roundings_of_the_angle(void)
{
    test_random random = {12};
    double worst = 0;
    for (int k = 0; k < TRIALS; k++) {
        const double angle = random_in(&random, -3.141592653589793, 3.141592653589793);
        const double size = random_scale(&random, 1e-3, 1e3);
        check_direction((mct_real)(size * cos(angle)), (mct_real)(size * sin(angle)), &worst);
        check_direction(1, (mct_real)random_scale(&random, 1e-15, 1e3), &worst); /* a step's small turn */
    }
    check_direction(1, 0, &worst);
    check_direction(-1, 0, &worst);
    check_direction(0, 1, &worst);
    check_direction(0, -1, &worst);
    printf("direction: %.2f roundings of the angle\n", worst / ROUNDING);
    TEST_ASSERT_TRUE(worst <= 3 * ROUNDING);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_inverse_root_is_within_two_roundings);
    RUN_TEST(test_the_direction_of_any_vector_is_within_three_roundings_of_the_angle);
    return UNITY_END();
}

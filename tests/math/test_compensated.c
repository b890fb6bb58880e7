/* The rules of include/mctau/compensated.h. */
#include <math.h>

#include "mctau/compensated.h"
#include "unity.h"

#define EPSILON ((double)MCT_REAL_EPSILON)

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_two_sum_loses_nothing(void)
{
    mct_real error;
    const mct_real small = MCT_REAL_EPSILON / 8;
    mct_real sum = mct_two_sum(MCT_R(1.0), small, &error);
    TEST_ASSERT_TRUE(sum == MCT_R(1.0) && error == small);
    sum = mct_two_sum(MCT_R(-3.0), MCT_R(3.0), &error);
    TEST_ASSERT_TRUE(sum == MCT_R(0.0) && error == MCT_R(0.0));
    for (int i = 1; i < 1000; i++) {
        const mct_real a = MCT_R(1.0) / (mct_real)i;
        const mct_real b = a / MCT_R(-700.1);
        sum = mct_two_sum(a, b, &error);
        /* in float the exact sum fits into a double; in double, into the long double of most machines */
        const long double exact = (long double)a + (long double)b;
        TEST_ASSERT_TRUE((long double)sum + (long double)error == exact || LDBL_MANT_DIG < 64);
    }
}

static void test_increments_too_small_for_the_value_add_up(void)
{
    mct_real value = MCT_R(1.0);
    mct_real compensation = MCT_R(0.0);
    mct_real plain = MCT_R(1.0);
    const mct_real increment = MCT_REAL_EPSILON / 16;
    for (int i = 0; i < 1 << 20; i++) {
        mct_add_compensated(&value, &compensation, increment);
        plain += increment;
    }
    TEST_ASSERT_TRUE(plain == MCT_R(1.0));
    TEST_ASSERT_TRUE(value == MCT_R(1.0) + 65536 * MCT_REAL_EPSILON);
}

/* Two roundings of the result, whatever the number of terms; the plain sum is off by thousands. */
static void test_a_million_steps_err_like_one(void)
{
    mct_real value = MCT_R(0.0);
    mct_real compensation = MCT_R(0.0);
    mct_real plain = MCT_R(0.0);
    const mct_real increment = MCT_R(1e-3);
    for (int i = 0; i < 1000000; i++) {
        mct_add_compensated(&value, &compensation, increment);
        plain += increment;
    }
    const double exact = 1e6 * (double)increment;
    TEST_ASSERT_DOUBLE_WITHIN(2 * EPSILON * exact, exact, (double)value);
    TEST_ASSERT_TRUE(fabs((double)plain - exact) > 1000 * EPSILON * exact);
}

static void test_a_value_that_swings_through_zero_returns_to_its_start(void)
{
    mct_real value = MCT_R(0.1);
    mct_real compensation = MCT_R(0.0);
    for (int turn = 0; turn < 1000; turn++) {
        for (int i = 0; i < 700; i++) {
            mct_add_compensated(&value, &compensation, MCT_R(-0.0007));
        }
        for (int i = 0; i < 700; i++) {
            mct_add_compensated(&value, &compensation, MCT_R(0.0007));
        }
    }
    TEST_ASSERT_DOUBLE_WITHIN(EPSILON, (double)MCT_R(0.1), (double)value);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_two_sum_loses_nothing);
    RUN_TEST(test_increments_too_small_for_the_value_add_up);
    RUN_TEST(test_a_million_steps_err_like_one);
    RUN_TEST(test_a_value_that_swings_through_zero_returns_to_its_start);
    return UNITY_END();
}

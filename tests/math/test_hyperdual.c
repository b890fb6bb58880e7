/* The rules of include/mctau/hyperdual.h: derivatives against closed forms. */
#include <math.h>

#include "mctau/hyperdual.h"
#include "unity.h"

/* A few roundings of numbers of the order of 10; a finite difference would leave half the digits. */
#define TOLERANCE (64.0 * (double)MCT_REAL_EPSILON)

void setUp(void)
{
}

void tearDown(void)
{
}

static void assert_hyperdual(double value, double e1, double e2, double e12, mct_hyperdual x)
{
    TEST_ASSERT_DOUBLE_WITHIN(TOLERANCE, value, (double)x.value);
    TEST_ASSERT_DOUBLE_WITHIN(TOLERANCE, e1, (double)x.e1);
    TEST_ASSERT_DOUBLE_WITHIN(TOLERANCE, e2, (double)x.e2);
    TEST_ASSERT_DOUBLE_WITHIN(TOLERANCE, e12, (double)x.e12);
}

/* An argument moved along both directions. */
static mct_hyperdual variable(double value, double e1, double e2)
{
    return (mct_hyperdual){MCT_R(value), MCT_R(e1), MCT_R(e2), MCT_R(0.0)};
}

static void test_a_constant_has_no_derivative(void)
{
    assert_hyperdual(1.5, 0, 0, 0, mct_hyperdual_constant(MCT_R(1.5)));
}

static void test_sums_differences_and_multiples_are_linear(void)
{
    const mct_hyperdual a = {MCT_R(1.0), MCT_R(2.0), MCT_R(3.0), MCT_R(4.0)};
    const mct_hyperdual b = {MCT_R(0.5), MCT_R(-1.0), MCT_R(0.25), MCT_R(8.0)};
    assert_hyperdual(1.5, 1, 3.25, 12, mct_hyperdual_add(a, b));
    assert_hyperdual(0.5, 3, 2.75, -4, mct_hyperdual_sub(a, b));
    assert_hyperdual(-2, -4, -6, -8, mct_hyperdual_scale(MCT_R(-2.0), a));
    assert_hyperdual(-1, -2, -3, -4, mct_hyperdual_neg(a));
}

static void test_a_product_obeys_the_rule_of_leibniz_twice(void)
{
    /* f = x^2 y at (1.5, -2), along a = (1, 2) and b = (3, -1) */
    const mct_hyperdual x = variable(1.5, 1, 3);
    const mct_hyperdual y = variable(-2, 2, -1);
    const mct_hyperdual f = mct_hyperdual_mul(mct_hyperdual_mul(x, x), y);
    const double f_x = 2 * 1.5 * -2;
    const double f_y = 1.5 * 1.5;
    const double f_xx = 2 * -2;
    const double f_xy = 2 * 1.5;
    assert_hyperdual(-4.5, f_x + 2 * f_y, 3 * f_x - f_y, 3 * f_xx + (-1 + 6) * f_xy, f);
}

static void test_sine_and_cosine_obey_the_chain_rule(void)
{
    /* f = sin(x y) and cos(x y) at (0.7, 1.3), both derivatives of which mix */
    const double x = 0.7;
    const double y = 1.3;
    const mct_hyperdual angle = mct_hyperdual_mul(variable(x, 1, 0), variable(y, 0, 1));
    const double s = sin(x * y);
    const double c = cos(x * y);
    assert_hyperdual(s, y * c, x * c, c - x * y * s, mct_hyperdual_sin(angle));
    assert_hyperdual(c, -y * s, -x * s, -s - x * y * c, mct_hyperdual_cos(angle));
    mct_hyperdual sine;
    mct_hyperdual cosine;
    mct_hyperdual_sincos(angle, &sine, &cosine);
    assert_hyperdual(s, y * c, x * c, c - x * y * s, sine);
    assert_hyperdual(c, -y * s, -x * s, -s - x * y * c, cosine);
}

static void test_any_function_with_two_derivatives_can_be_composed(void)
{
    /* 1 / r with r^2 = x^2 + y^2 at (3, 4), whose second derivatives are those of a potential */
    const mct_hyperdual x = variable(3, 1, 0);
    const mct_hyperdual y = variable(4, 0, 1);
    const mct_hyperdual square = mct_hyperdual_add(mct_hyperdual_mul(x, x), mct_hyperdual_mul(y, y));
    const double z = 25;
    const mct_hyperdual inverse =
        mct_hyperdual_compose(square, MCT_R(0.2), MCT_R(-0.5 * 0.2 / z), MCT_R(0.75 * 0.2 / z / z));
    assert_hyperdual(0.2, -3.0 / 125, -4.0 / 125, 3 * 12.0 / 3125, inverse);
}

static void test_equal_directions_give_the_second_derivative_itself(void)
{
    const mct_hyperdual x = variable(0.4, 1, 1);
    const mct_hyperdual f = mct_hyperdual_mul(mct_hyperdual_sin(x), mct_hyperdual_cos(x));
    TEST_ASSERT_DOUBLE_WITHIN(TOLERANCE, -2 * sin(0.8), (double)f.e12);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_constant_has_no_derivative);
    RUN_TEST(test_sums_differences_and_multiples_are_linear);
    RUN_TEST(test_a_product_obeys_the_rule_of_leibniz_twice);
    RUN_TEST(test_sine_and_cosine_obey_the_chain_rule);
    RUN_TEST(test_any_function_with_two_derivatives_can_be_composed);
    RUN_TEST(test_equal_directions_give_the_second_derivative_itself);
    return UNITY_END();
}

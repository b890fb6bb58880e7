/* The rules of include/mctau/units.h (source, section 8.3). */
#include <float.h>
#include <math.h>

#include "mctau/units.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void is(double wanted, double found)
{
    TEST_ASSERT_DOUBLE_WITHIN(2 * DBL_EPSILON * wanted, wanted,
                              found); /* the wanted ones are rounded twice */
}

static void test_every_unit_follows_from_the_inch_the_pound_the_second_and_standard_gravity(void)
{
    const double pi = acos(-1);
    is(MCT_POUND / 16, MCT_OUNCE);
    is(MCT_STANDARD_GRAVITY, MCT_KILOPOND);
    is(MCT_POUND * MCT_STANDARD_GRAVITY, MCT_POUND_FORCE);
    is(MCT_OUNCE * MCT_STANDARD_GRAVITY, MCT_OUNCE_FORCE);
    is(MCT_GRAM * MCT_CENTIMETER, MCT_DYNE);
    is(MCT_MILLIMETER, MCT_NEWTON_MILLIMETER);
    is(MCT_DYNE * MCT_CENTIMETER, MCT_DYNE_CENTIMETER);
    is(MCT_KILOPOND * MCT_CENTIMETER, MCT_KILOGRAM_CENTIMETER);
    is(MCT_OUNCE_FORCE * MCT_INCH, MCT_OUNCE_INCH);
    is(MCT_POUND_FORCE * MCT_INCH, MCT_POUND_INCH);
    is(MCT_POUND_FORCE * (12 * MCT_INCH), MCT_POUND_FOOT);
    is(pi / 180, MCT_DEGREE);
    is(2 * pi, MCT_TURN);
    is(2 * pi / 60, MCT_RPM);
}

/* To the digits that are printed there. */
static void test_the_figures_of_the_source_are_met(void)
{
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, 141.612, 1 / MCT_OUNCE_INCH);
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, 10.197, 1 / MCT_KILOGRAM_CENTIMETER);
    TEST_ASSERT_DOUBLE_WITHIN(5e-3, 9.81, MCT_KILOPOND);
    TEST_ASSERT_DOUBLE_WITHIN(5e-3, 2.94, 416 * MCT_OUNCE_INCH);
    TEST_ASSERT_DOUBLE_WITHIN(1e-20, 1e-7, MCT_DYNE_CENTIMETER);
    TEST_ASSERT_DOUBLE_WITHIN(5e-3, 0.22, 1 / MCT_POUND_FORCE);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_unit_follows_from_the_inch_the_pound_the_second_and_standard_gravity);
    RUN_TEST(test_the_figures_of_the_source_are_met);
    return UNITY_END();
}

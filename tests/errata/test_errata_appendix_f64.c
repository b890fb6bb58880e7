/* Section 8 of the source: least squares, drag, viscosities. docs/errata.md lists the equations. */
#include "errata/errata.h"

/* (439) is where the cost (435) is least; greatest it is nowhere. */
static void test_eq_436_is_the_least_cost(void)
{
    for (int n = 0; n < STATES; n++) {
        double x[3], y[3], w[3], xx = 0, xy = 0, there = 0, elsewhere = 0;
        for (int i = 0; i < 3; i++) {
            x[i] = any();
            y[i] = any();
            w[i] = some();
            xx += x[i] * w[i] * x[i];
            xy += x[i] * w[i] * y[i];
        }
        const double b = xy / xx, other = b + any();
        for (int i = 0; i < 3; i++) {
            there += w[i] / 2 * pow(y[i] - x[i] * b, 2);
            elsewhere += w[i] / 2 * pow(y[i] - x[i] * other, 2);
        }
        TEST_ASSERT_TRUE(there < elsewhere - MARGIN);
    }
}

/* In other units a force is another number by mass x length / time^2; so must 1/2 rho a c v^2 be. */
static void test_text_448_rho_is_a_density(void)
{
    while (another_state()) {
        const double kg = some() + 1, m = some() + 2, s = some() + 4; /* of the new units in the old */
        const double rho = some(), area = some(), c = some(), v = some();
        const double force = 0.5 * rho * area * c * v * v;
        const double rest = 0.5 * area * (m * m) * c * pow(v * m / s, 2);
        judge_number(force * kg * m / (s * s), rho * kg / (m * s) * rest, rho * kg / (m * m * m) * rest);
    }
}

/* Glycerine's viscosity [Pa s] at a temperature [C]: N.-S. Cheng, Ind. Eng. Chem. Res. 47 (2008) 3285. */
static double glycerine(double temperature)
{
    return 12.1 * exp((temperature - 1233) * temperature / (9900 + 70 * temperature));
}

/* Measured, table of the Dow company: 1.410 at 20 C, 0.284 at 40 C. The correlation is within 2 %. */
static void test_the_table_gives_glycerine_at_20_and_not_at_40_degrees(void)
{
    const double printed = 1.420;
    TEST_ASSERT_DOUBLE_WITHIN(0.02 * 1.410, 1.410, glycerine(20));
    TEST_ASSERT_DOUBLE_WITHIN(0.02 * 0.284, 0.284, glycerine(40));
    TEST_ASSERT_DOUBLE_WITHIN(0.02 * 1.410, 1.410, printed);
    TEST_ASSERT_TRUE(printed > 4 * glycerine(40));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_eq_436_is_the_least_cost);
    RUN_TEST(test_text_448_rho_is_a_density);
    RUN_TEST(test_the_table_gives_glycerine_at_20_and_not_at_40_degrees);
    return UNITY_END();
}

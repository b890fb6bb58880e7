/* The reference is worth its name: two integrators that share only the equations agree, and halving changes
 * nothing. */
#include <stdio.h>

#include "support/reference.h"
#include "support/scenes.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* Largest difference of two states, each entry relative to 1 or its size. */
static double difference(const quad *a, const quad *b)
{
    double worst = 0;
    for (int i = 0; i < REFERENCE_STATES; i++) {
        const double size = (double)(a[i] < 0 ? -a[i] : a[i]);
        const double d = (double)(a[i] < b[i] ? b[i] - a[i] : a[i] - b[i]) / (size > 1 ? size : 1);
        worst = d > worst ? d : worst;
    }
    return worst;
}

static mct_scene stiff_wheel(double time_constant)
{
    mct_scene scene =
        scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_INDUCTIVE);
    *parameter_of(&scene, "inductance") = time_constant * *parameter_of(&scene, "resistance");
    return scene;
}

static void test_halving_the_steps_of_the_extrapolation_changes_less_than_1e_16(void)
{
    static const double start[] = {0.3, 2.0, -0.5, 1.0, 0};
    const mct_scene scene = scene_of(CART_POLE, MCT_STEPPER_RK4, MCT_GRAVITY | MCT_VISCOUS);
    const reference_model model = reference_of(&scene);
    quad coarse[REFERENCE_STATES];
    quad fine[REFERENCE_STATES];
    reference_start(&model, start, coarse);
    reference_start(&model, start, fine);
    reference_extrapolate(&model, coarse, (quad)0.7, 10, 1000);
    reference_extrapolate(&model, fine, (quad)0.7, 10, 2000);
    printf("extrapolation, 10 s: halving changes %.1e\n", difference(coarse, fine));
    TEST_ASSERT_TRUE(difference(coarse, fine) < 1e-16);
}

static void test_the_reference_conserves_energy_where_nothing_dissipates(void)
{
    static const double start[] = {0, 2.0, 0, 0, 0};
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        const mct_scene scene = scene_of(system, MCT_STEPPER_RK4, MCT_GRAVITY);
        const reference_model model = reference_of(&scene);
        quad x[REFERENCE_STATES];
        reference_start(&model, start, x);
        x[system == CART_POLE ? 1 : 0] = 2;
        const quad before = reference_energy(&model, x);
        reference_extrapolate(&model, x, 0, 10, 1000);
        const double change = (double)((reference_energy(&model, x) - before) / before);
        printf("%s: energy changes by %.1e in 10 s\n", mct_systems[system]->name, change);
        TEST_ASSERT_TRUE(change < 1e-16 && change > -1e-16);
    }
}

static void test_both_integrators_agree_through_jumps_of_the_voltage_at_any_time_constant(void)
{
    static const double time_constants[] = {10e-6, 100e-6, 1e-3, 5e-3};
    static const double start[] = {2.0, 0.4, 0.5, -30, 0.1};
    static reference_flow flow;
    for (int n = 0; n < 4; n++) {
        const double tau = time_constants[n];
        const mct_scene scene = stiff_wheel(tau);
        const reference_model model = reference_of(&scene);
        TEST_ASSERT_TRUE(reference_flow_prepare(&flow, &model, 1e-3, 2 * tau, 1e-3) > 0);
        quad a[REFERENCE_STATES];
        quad b[REFERENCE_STATES];
        reference_start(&model, start, a);
        reference_start(&model, start, b);
        for (int tick = 0; tick < 12; tick++) {
            const quad u = tick % 3 == 0 ? 9 : tick % 3 == 1 ? -10 : 2;
            reference_flow_advance(&flow, a, u);
            reference_extrapolate(&model, b, u, (quad)1e-3, tau < 50e-6 ? 100 : 10);
        }
        printf("L/R = %g s: the integrators differ by %.1e after 12 jumps\n", tau, difference(a, b));
        TEST_ASSERT_TRUE(difference(a, b) < 1e-16);
    }
}

static void test_halving_the_windows_of_the_flow_changes_less_than_1e_16(void)
{
    static const double start[] = {2.0, 0, 0, 0, 0};
    static reference_flow coarse;
    static reference_flow fine;
    const double tau = 10e-6;
    const mct_scene scene = stiff_wheel(tau);
    const reference_model model = reference_of(&scene);
    TEST_ASSERT_TRUE(reference_flow_prepare(&coarse, &model, 1e-3, 2 * tau, 1e-3) > 0);
    TEST_ASSERT_TRUE(reference_flow_prepare(&fine, &model, 1e-3, tau, 0.1e-3) > 0);
    quad a[REFERENCE_STATES];
    quad b[REFERENCE_STATES];
    reference_start(&model, start, a);
    reference_start(&model, start, b);
    for (int tick = 0; tick < 500; tick++) {
        const quad u = (tick / 3) % 2 ? 10 : -8;
        reference_flow_advance(&coarse, a, u);
        reference_flow_advance(&fine, b, u);
    }
    printf("flow, L/R = 10 us, 0.5 s: halving changes %.1e\n", difference(a, b));
    TEST_ASSERT_TRUE(difference(a, b) < 1e-16);
}

int main(void)
{
    if (!HAVE_REFERENCE) {
        puts("skipped: this compiler has no quadruple precision");
        return 77;
    }
    UNITY_BEGIN();
    RUN_TEST(test_halving_the_steps_of_the_extrapolation_changes_less_than_1e_16);
    RUN_TEST(test_the_reference_conserves_energy_where_nothing_dissipates);
    RUN_TEST(test_both_integrators_agree_through_jumps_of_the_voltage_at_any_time_constant);
    RUN_TEST(test_halving_the_windows_of_the_flow_changes_less_than_1e_16);
    return UNITY_END();
}

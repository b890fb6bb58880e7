/*
 * Each stepper converges with the order that it claims, on every system and motor that it suits, over four
 * halvings of the step, on a smooth scene.
 *
 * An order is log2 of the ratio of two errors; it is within 0.25 of the claim at the coarsest step and within
 * 0.1 at the finest, where the next term of the expansion is at most a sixteenth of what it was.
 */
#include <math.h>
#include <stdio.h>

#include "support/reference.h"
#include "support/scenes.h"
#include "unity.h"

#define DURATION 0.512

enum { HALVINGS = 4 };

void setUp(void)
{
}

void tearDown(void)
{
}

static mct_scene smooth_scene(int system, uint32_t effects, double time_constant)
{
    mct_scene scene = scene_of(system, MCT_STEPPER_RK4, effects);
    *parameter_of(&scene, "inductance") = time_constant * *parameter_of(&scene, "resistance");
    scene.initial[mct_systems[system]->actuation->upright_coordinate] = 2;
    scene.initial[2] = 0.3;
    scene.initial[3] = -0.5;
    return scene;
}

static double input_of(const mct_scene *scene)
{
    return (scene->effects & MCT_MOTOR) ? 3 : scene->system == CART_POLE ? 0.5 : 0.002;
}

static void compute_end(const mct_scene *scene, long steps, quad *end)
{
    const reference_model model = reference_of(scene);
    reference_start(&model, scene->initial, end);
    reference_extrapolate(&model, end, input_of(scene), (quad)512 / 1000, steps);
}

/* Largest error over all states at the end, relative to 1 or the state's size. */
static double end_error(mct_scene scene, double h, const quad *end)
{
    mct_plant plant;
    scene.dt = h;
    start_plant(&plant, &scene);
    step_plant(&plant, input_of(&scene), lround(DURATION / h));
    double worst = 0;
    for (int i = 0; i < plant.states; i++) {
        const double exact = (double)end[i];
        worst = fmax(worst, fabs(mct_plant_value(&plant, i) - exact) / fmax(1, fabs(exact)));
    }
    return worst;
}

static void check_order(mct_scene scene, int stepper, double coarsest, const quad *end)
{
    double error[HALVINGS + 1];
    scene.stepper = stepper;
    for (int k = 0; k <= HALVINGS; k++) {
        error[k] = end_error(scene, coarsest / (1 << k), end);
    }
    printf("%-14s %-12s %-5s", mct_systems[scene.system]->name, motor_name(scene.effects),
           mct_steppers[stepper].name);
    const int claim = mct_steppers[stepper].order;
    for (int k = 1; k <= HALVINGS; k++) {
        const double order = log2(error[k - 1] / error[k]);
        printf(" %.2f", order);
        TEST_ASSERT_DOUBLE_WITHIN(k == HALVINGS ? 0.1 : 0.25, claim, order);
    }
    printf("  (error %.1e at %g ms, %.1e at %g ms)\n", error[0], coarsest * 1e3, error[HALVINGS],
           coarsest * 1e3 / (1 << HALVINGS));
}

static void test_every_stepper_converges_with_its_order_on_every_system_and_motor(void)
{
    static const uint32_t motors[] = {0, MCT_MOTOR_QUASI_STATIC, MCT_MOTOR_INDUCTIVE};
    int pairs = 0;
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        for (int motor = 0; motor < 3; motor++) {
            const mct_scene scene = smooth_scene(system, MCT_GRAVITY | MCT_VISCOUS | motors[motor], 0.05);
            quad end[REFERENCE_STATES];
            compute_end(&scene, 128, end);
            for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
                if (mct_systems[system]->kernel(stepper, scene.effects) != NULL) {
                    check_order(scene, stepper, mct_steppers[stepper].order == 1 ? 1e-3 : 8e-3, end);
                    pairs++;
                }
            }
        }
    }
    TEST_ASSERT_EQUAL_INT(3 * (4 + 5), pairs);
}

/*
 * 69 us is the motor of the default cart-pole. h R/L falls from 58, where rk4 would blow up, to 0.2: no
 * halving on the way gains less than order 1.9, and the last ones settle at 2.
 */
static void test_leap_converges_with_order_2_and_is_stable_on_a_cart_pole_with_a_stiff_motor(void)
{
    const mct_scene scene = smooth_scene(CART_POLE, MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_INDUCTIVE, 69e-6);
    quad end[REFERENCE_STATES];
    compute_end(&scene, 5120, end);
    mct_scene leap = scene;
    leap.stepper = MCT_STEPPER_LEAP;
    double before = end_error(leap, 4e-3, end);
    double order = 0;
    printf("cart_pole, L/R 69 us, leap: error %.1e at 4 ms, orders", before);
    for (int k = 1; k <= 8; k++) {
        const double error = end_error(leap, 4e-3 / (1 << k), end);
        order = log2(before / error);
        printf(" %.2f", order);
        TEST_ASSERT_TRUE(order > 1.9);
        before = error;
    }
    printf("\n");
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 2, order);

    mct_scene longer = scene;
    longer.stepper = MCT_STEPPER_LEAP;
    mct_plant plant;
    start_plant(&plant, &longer);
    for (int k = 0; k < 100000; k++) {
        mct_plant_step(&plant, (k / 250) % 2 ? 10 : -10);
        TEST_ASSERT_TRUE(fabs((double)plant.state.x[4]) <
                         20 / 2.6); /* twice the supply across the armature */
    }
    TEST_ASSERT_EQUAL_UINT64(0, plant.diverged_ticks);
}

static void test_expo_keeps_order_4_where_the_motor_is_a_thousand_times_faster_than_the_step(void)
{
    mct_scene scene = smooth_scene(REACTION_WHEEL, MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_INDUCTIVE, 8e-6);
    const reference_model model = reference_of(&scene);
    static reference_flow first;
    static reference_flow later;
    const double window = 2e-3;
    TEST_ASSERT_TRUE(reference_flow_prepare(&first, &model, window, 16e-6, window) > 0);
    TEST_ASSERT_TRUE(reference_flow_prepare(&later, &model, window, window, window) > 0);
    quad end[REFERENCE_STATES];
    reference_start(&model, scene.initial, end);
    for (int k = 0; k < 256; k++) {
        reference_flow_advance(k == 0 ? &first : &later, end, input_of(&scene));
    }
    check_order(scene, MCT_STEPPER_EXPO, 8e-3, end);
}

int main(void)
{
    if (!HAVE_REFERENCE) {
        puts("skipped: this compiler has no quadruple precision");
        return 77;
    }
    UNITY_BEGIN();
    RUN_TEST(test_every_stepper_converges_with_its_order_on_every_system_and_motor);
    RUN_TEST(test_leap_converges_with_order_2_and_is_stable_on_a_cart_pole_with_a_stiff_motor);
    RUN_TEST(test_expo_keeps_order_4_where_the_motor_is_a_thousand_times_faster_than_the_step);
    return UNITY_END();
}

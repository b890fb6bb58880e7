/*
 * Each stepper converges with the order that it claims, on every system whose motion is smooth and every motor that it
 * suits, over four refinements of the step, on a smooth scene. An order is the ratio of the logarithms of two errors and of
 * their steps. Steps are refined until rounding shows, and the last five are judged.
 *
 * Up to order 4 these are halvings: an order is within 0.25 of the claim at the coarsest step and within 0.1 at the finest,
 * where the next term of the expansion is at most a sixteenth of what it was. Beyond, four halvings would begin where a step
 * is as long as the motion's own times (at order 12, an error of 50 for one of 2e-13), so the ratio is the root of 2, and its
 * root for order 12. The next terms are still large there, and two that cancel raise an order: it is at least 0.4 below the
 * claim at the finest step, and 0.7 over all four.
 */
#include <math.h>
#include <stdio.h>

#include "support/reference.h"
#include "support/scenes.h"
#include "support/textbook.h"
#include "unity.h"

#define DURATION 0.512

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

/* --- every system --- */

/* What is special about a system's scene. */
typedef struct {
    const char *name;
    double input; /* without a motor */
    double initial[MCT_MAX_STATES];
    struct {
        const char *name;
        double value;
    } parameters[6];
} special;

static const special specials[] = {
    {"cart_pole", 0.5, {0, 2, 0.3, -0.5}, {{"inductance", 0.05 * 2.6}}},
    {"reaction_wheel", 0.002, {2, 0, 0.3, -0.5}, {{"inductance", 0.05 * 12.1}}},
    {"pendulum", 0.02, {2, 0.3}, {{0}}},
    {"spring_pendulum", 0.05, {0.42, 0, 0.2, 1}, {{0}}},
    {"particle_pendulum", 0.02, {1, 0.3}, {{0}}},
    {"moving_base",
     0.02,
     {0.5, 0.3},
     {{"base_amplitude_1", 0.05},
      {"base_frequency_1", 7},
      {"base_phase_1", 0.3},
      {"base_amplitude_2", 0.02},
      {"base_frequency_2", 11},
      {"base_phase_2", -1}}},
    {"ball_joint", 0, {0.9, 0.3, -0.2, 0.25, 2, -3, 4}, {{0}}},
    {"fixed_axis", 20, {2, 8}, {{0}}},
    {"solid_pendulum", 2, {0.5, 1}, {{0}}},
    {"rigid_body", 0, {0, 0, 0, 0.9, 0.3, -0.2, 0.25, 2, 5, -1, 2, -4, 3}, {{0}}},
};
enum { SPECIALS = sizeof specials / sizeof specials[0] };

/* Four particles and two forces, one of which turns with the body. */
static const double lumps[16] = {0.3, 0.2, 0.1,  0,   0.2, -0.1, 0.3, 0.1,
                                 0.5, 0,   -0.2, 0.2, 0.1, 0.1,  0.1, -0.4};
static const double pushes[14] = {0, 0.1, 0.2, 0, 0.5, 0.4, -0.3, 1, -0.1, 0, 0.3, 0.2, 0, 0.5};

static mct_scene special_scene(const special *self, uint32_t motor)
{
    const int system = system_called(self->name);
    const uint32_t smooth = MCT_GRAVITY | MCT_VISCOUS | MCT_SPRING | MCT_BASE_MOTION | MCT_FORCES;
    mct_scene scene = scene_of(system, MCT_STEPPER_RK4, (mct_systems[system]->effects & smooth) | motor);
    memcpy(scene.initial, self->initial, sizeof(double) * (size_t)mct_state_count(&scene));
    for (int i = 0; i < 6 && self->parameters[i].name != NULL; i++) {
        *parameter_of(&scene, self->parameters[i].name) = self->parameters[i].value;
    }
    if (mct_systems[system]->attitude != MCT_ATTITUDE_NONE) {
        set_rows(&scene, 0, lumps, 16);
    }
    if (mct_systems[system]->list_count > 1) {
        set_rows(&scene, 1, pushes, 14);
    }
    return scene;
}

enum { LOOKS = 4, FINEST = 2048, REFINEMENTS = 4, MOST_REFINEMENTS = 48 };
#define FLOOR 5e-13 /* 2000 roundings; those of expo's coefficients alone make 3e-14 */

/* The motion at LOOKS equal times. */
typedef struct {
    textbook book;
    double duration; /* between two of them */
    quad at[LOOKS][QUAD_MAX_STATES];
} journey;

static void prepare_journey(journey *self, const mct_scene *scene, double input, double duration)
{
    quad x[QUAD_MAX_STATES];
    mct_plant plant;
    TEST_ASSERT_TRUE(textbook_of(&self->book, scene, input));
    start_plant(&plant, scene);
    textbook_start(&self->book, &plant, x);
    self->duration = duration / LOOKS;
    for (int i = 0; i < LOOKS; i++) {
        quad_extrapolate(self->book.rate, &self->book, i * (quad)self->duration, x, self->book.states,
                         (quad)self->duration, 64);
        memcpy(self->at[i], x, sizeof x);
    }
}

/* Largest error of all looks, with so many steps between two; infinite where a step is too long to be taken. */
static double error_of(const journey *self, int stepper, long steps)
{
    mct_scene scene = *self->book.scene;
    mct_plant plant;
    double worst = 0;
    scene.stepper = stepper;
    scene.dt = self->duration / (double)steps;
    if (mct_plant_init(&plant, &scene, NULL) != MCT_OK) {
        return INFINITY;
    }
    for (int i = 0; i < LOOKS; i++) {
        step_plant(&plant, (mct_real)self->book.input, steps);
        worst = fmax(worst, textbook_distance(&self->book, &plant, self->at[i]));
    }
    return plant.diverged_ticks > 0 ? INFINITY : worst;
}

static double order_of(const double *error, const double *steps, int coarse, int fine)
{
    return log(error[coarse] / error[fine]) / log(steps[fine] / steps[coarse]);
}

static void check_convergence(const journey *self, int stepper)
{
    const int claim = mct_steppers[stepper].order;
    const mct_scene *scene = self->book.scene;
    const double factor = claim > 8 ? sqrt(sqrt(2)) : claim > 4 ? sqrt(2) : 2;
    double error[MOST_REFINEMENTS], steps[MOST_REFINEMENTS];
    int last = -1;
    for (double n = 1; n <= FINEST; n *= factor) {
        if (last >= 0 && round(n) == steps[last]) {
            continue;
        }
        const double now = error_of(self, stepper, lround(n));
        if (now < FLOOR) {
            break;
        }
        last++;
        steps[last] = round(n);
        error[last] = now;
    }
    printf("%-17s %-12s %-8s", mct_systems[scene->system]->name, motor_name(scene->effects),
           mct_steppers[stepper].name);
    TEST_ASSERT_TRUE(last >= REFINEMENTS);
    const int first = last - REFINEMENTS;
    for (int k = first + 1; k <= last; k++) {
        const double order = order_of(error, steps, k - 1, k);
        printf(" %.2f", order);
        if (claim <= 4) {
            TEST_ASSERT_DOUBLE_WITHIN(k == last ? 0.1 : 0.25, claim, order);
        }
    }
    printf("  (error %.1e at %.3g ms, %.1e at %.3g ms)\n", error[first], self->duration / steps[first] * 1e3,
           error[last], self->duration / steps[last] * 1e3);
    TEST_ASSERT_TRUE(order_of(error, steps, last - 1, last) > claim - 0.4);
    TEST_ASSERT_TRUE(order_of(error, steps, first, last) > claim - 0.7);
}

static void test_every_stepper_converges_with_its_order_on_every_smooth_system_and_motor(void)
{
    static const uint32_t motors[] = {0, MCT_MOTOR_QUASI_STATIC, MCT_MOTOR_INDUCTIVE};
    for (int i = 0; i < SPECIALS; i++) {
        const bool has_motor = mct_systems[system_called(specials[i].name)]->actuation != NULL;
        for (int motor = 0; motor < (has_motor ? 3 : 1); motor++) {
            const mct_scene scene = special_scene(&specials[i], motors[motor]);
            const double input = motor > 0 ? 3 : specials[i].input;
            journey shorter, longer;
            prepare_journey(&shorter, &scene, input, DURATION);
            prepare_journey(&longer, &scene, input, 4 * DURATION);
            FOR_EACH_STEPPER (stepper, scene.system, scene.effects) {
                check_convergence(mct_steppers[stepper].order > 4 ? &longer : &shorter, stepper);
            }
        }
    }
}

static void test_a_stepper_for_forces_of_position_converges_with_its_order_without_friction(void)
{
    int judged = 0;
    for (int i = 0; i < SPECIALS; i++) {
        mct_scene scene = special_scene(&specials[i], 0);
        const uint32_t with_friction = scene.effects;
        journey self;
        scene.effects &= ~(uint32_t)MCT_VISCOUS;
        prepare_journey(&self, &scene, specials[i].input, 4 * DURATION);
        FOR_EACH_STEPPER (stepper, scene.system, scene.effects) {
            if (mct_systems[scene.system]->kernel(stepper, with_friction) == NULL) {
                check_convergence(&self, stepper);
                judged++;
            }
        }
    }
    TEST_ASSERT_TRUE(judged >= 4);
}

/* Taylor's method is judged wherever it is: no system has it that is not in the table. */
static void test_every_system_with_a_series_is_judged(void)
{
    int found = 0;
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        for (uint32_t effects = 0; effects < 2 * MCT_FORCES; effects++) {
            if (mct_systems[system]->kernel(MCT_STEPPER_TAYLOR4, effects & mct_systems[system]->effects) !=
                NULL) {
                found++;
                break;
            }
        }
    }
    TEST_ASSERT_EQUAL_INT(SPECIALS, found);
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

static void test_expo_keeps_its_order_where_the_motor_is_a_thousand_times_faster_than_the_step(void)
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
    scene.stepper = MCT_STEPPER_EXPO;
    printf("%-17s %-12s expo, L/R 8 us", mct_systems[scene.system]->name, motor_name(scene.effects));
    double before = end_error(scene, 16e-3, end);
    int halvings = 0;
    for (double h = 8e-3; before > 100 * FLOOR; h /= 2) {
        const double error = end_error(scene, h, end);
        printf(" %.2f", log2(before / error));
        TEST_ASSERT_TRUE(log2(before / error) > mct_steppers[MCT_STEPPER_EXPO].order - 0.7);
        before = error;
        halvings++;
    }
    printf("  (error %.1e)\n", before);
    TEST_ASSERT_TRUE(halvings >= 2);
}

int main(void)
{
    if (!HAVE_REFERENCE) {
        puts("skipped: this compiler has no quadruple precision");
        return 77;
    }
    UNITY_BEGIN();
    RUN_TEST(test_every_stepper_converges_with_its_order_on_every_smooth_system_and_motor);
    RUN_TEST(test_a_stepper_for_forces_of_position_converges_with_its_order_without_friction);
    RUN_TEST(test_every_system_with_a_series_is_judged);
    RUN_TEST(test_leap_converges_with_order_2_and_is_stable_on_a_cart_pole_with_a_stiff_motor);
    RUN_TEST(test_expo_keeps_its_order_where_the_motor_is_a_thousand_times_faster_than_the_step);
    return UNITY_END();
}

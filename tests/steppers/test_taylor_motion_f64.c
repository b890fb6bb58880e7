/* Taylor's method against the textbook in quadruple precision: its first terms, long steps, and a pivot that is passed. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/textbook.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* --- the first terms --- */

/* Change of all states in one step. */
static void change_of(mct_scene scene, int stepper, double input, double *change)
{
    mct_plant plant;
    double before[MCT_MAX_STATES];
    scene.stepper = stepper;
    start_plant(&plant, &scene);
    for (int i = 0; i < plant.states; i++) {
        before[i] = mct_plant_value(&plant, i);
    }
    mct_plant_step(&plant, input);
    for (int i = 0; i < plant.states; i++) {
        change[i] = mct_plant_value(&plant, i) - before[i];
    }
}

/* Second derivative of all states: the difference of rates along the motion. */
static void second_rates(const textbook *book, const quad *x, double *second)
{
    const quad e = (quad)1e-9;
    quad rate[QUAD_MAX_STATES], ahead[QUAD_MAX_STATES], behind[QUAD_MAX_STATES];
    quad later[QUAD_MAX_STATES], earlier[QUAD_MAX_STATES];
    book->rate(book, 0, x, rate);
    for (int i = 0; i < book->states; i++) {
        ahead[i] = x[i] + e * rate[i];
        behind[i] = x[i] - e * rate[i];
    }
    book->rate(book, e, ahead, later);
    book->rate(book, -e, behind, earlier);
    for (int i = 0; i < book->states; i++) {
        second[i] = (double)((later[i] - earlier[i]) / (2 * e));
    }
}

/*
 * seed is the first order with the term more of a coordinate, h^2 a / 2. What a series adds begins with the rate j of the
 * acceleration: h^2 j / 2 to a rate, h^3 j / 6 to a coordinate. At 0.1 ms the next terms are less than a hundredth of that.
 */
static void test_seed_is_the_first_order_and_a_series_adds_the_next_derivative(void)
{
    static const struct {
        const char *name;
        double input, initial[MCT_MAX_STATES];
    } states[] = {
        {"cart_pole", 0.5, {0.1, 2, 0.3, -2}},
        {"reaction_wheel", 0.002, {2, 0, 0.5, -3}},
        {"pendulum", 0.02, {2, 3}},
        {"particle_pendulum", 0.02, {1, 2}},
        {"fixed_axis", 20, {2, 3}},
        {"solid_pendulum", 2, {0.5, 3}},
        {"moving_base", 0.01, {0.5, 2}},
        {"spring_pendulum", 0.05, {0.42, 0.3, 0.2, 2}},
    };
    for (size_t n = 0; n < sizeof states / sizeof states[0]; n++) {
        mct_scene scene;
        textbook book;
        mct_plant plant;
        quad x[QUAD_MAX_STATES];
        double seed[MCT_MAX_STATES], series[MCT_MAX_STATES], second[MCT_MAX_STATES];
        mct_scene_defaults(&scene, system_called(states[n].name));
        const double h = 1e-4;
        scene.dt = h;
        if (strcmp(states[n].name, "moving_base") == 0) {
            *parameter_of(&scene, "base_frequency_2") = 20; /* by default its own times are shorter */
        }
        scene.effects &= ~(uint32_t)(MCT_MOTOR | MCT_SATURATION);
        memcpy(scene.initial, states[n].initial, sizeof states[n].initial);
        start_plant(&plant, &scene);
        TEST_ASSERT_TRUE(textbook_of(&book, &scene, states[n].input));
        textbook_start(&book, &plant, x);
        second_rates(&book, x, second);
        change_of(scene, MCT_STEPPER_SEED, states[n].input, seed);
        const int count = mct_systems[scene.system]->coordinate_count;
        for (int stepper = MCT_STEPPER_TAYLOR4; stepper <= MCT_STEPPER_TAYLOR12; stepper++) {
            change_of(scene, stepper, states[n].input, series);
            for (int i = 0; i < count; i++) {
                const double jerk = second[count + i];
                const double size = fmax(fabs(jerk), 1);
                const double to_rate = (series[count + i] - seed[count + i]) / (h * h / 2);
                const double to_place = (series[i] - seed[i]) / (h * h * h / 6);
                TEST_ASSERT_DOUBLE_WITHIN(0.01 * size, jerk, to_rate);
                /* and a rounding of each place */
                TEST_ASSERT_DOUBLE_WITHIN(0.01 * size + 1e-15 / (h * h * h / 6), jerk, to_place);
            }
        }
    }
}

/* Half a step divides what it misses of a rate by 2^(order + 1), of a coordinate, with its term more, by 2^(order + 2). */
static void test_a_coordinate_gets_one_term_more_than_its_rate(void)
{
    mct_scene scene = scene_of(system_called("pendulum"), 0, MCT_GRAVITY | MCT_VISCOUS);
    textbook book;
    double missed[2][2];
    scene.initial[0] = 2;
    scene.initial[1] = 3;
    for (int stepper = MCT_STEPPER_TAYLOR4; stepper <= MCT_STEPPER_TAYLOR6; stepper++) {
        for (int half = 0; half < 2; half++) {
            mct_plant plant;
            quad x[QUAD_MAX_STATES];
            scene.stepper = stepper;
            scene.dt = half == 0 ? 0.04 : 0.02;
            start_plant(&plant, &scene);
            TEST_ASSERT_TRUE(textbook_of(&book, &scene, 0));
            textbook_start(&book, &plant, x);
            quad_extrapolate(book.rate, &book, 0, x, book.states, (quad)scene.dt, 4);
            mct_plant_step(&plant, 0);
            for (int i = 0; i < 2; i++) {
                missed[half][i] = fabs(mct_plant_value(&plant, i) - (double)x[i]);
            }
        }
        const int order = mct_steppers[stepper].order;
        TEST_ASSERT_DOUBLE_WITHIN(0.4, order + 2, log2(missed[0][0] / missed[1][0]));
        TEST_ASSERT_DOUBLE_WITHIN(0.4, order + 1, log2(missed[0][1] / missed[1][1]));
    }
}

/* --- long steps --- */

/* Largest error over ten seconds, by halves. */
static double error_of(const mct_scene *scene)
{
    textbook book;
    mct_plant plant;
    quad x[QUAD_MAX_STATES];
    double worst = 0;
    TEST_ASSERT_TRUE(textbook_of(&book, scene, 0));
    start_plant(&plant, scene);
    textbook_start(&book, &plant, x);
    for (int half = 0; half < 20; half++) {
        quad_extrapolate(book.rate, &book, half * (quad)0.5, x, book.states, (quad)0.5, 20);
        step_plant(&plant, 0, lround(0.5 / scene->dt));
        worst = fmax(worst, textbook_distance(&book, &plant, x));
    }
    return plant.diverged_ticks > 0 ? INFINITY : worst;
}

/* The scenes by which other libraries are measured. */
static void test_order_12_follows_free_motion_at_20_ms_within_1e_12(void)
{
    static const double lumps[16] = {0.25, 1, 0, 0, 0.25, -1, 0, 0, 0.25, 0, 0.5, 0.3, 0.25, 0, -0.5, -0.3};
    mct_scene scenes[4];
    scenes[0] = scene_of(CART_POLE, 0, MCT_GRAVITY | MCT_VISCOUS);
    *parameter_of(&scenes[0], "cart_mass") = 1;
    *parameter_of(&scenes[0], "pole_mass") = 0.2;
    *parameter_of(&scenes[0], "pole_length") = 0.5;
    *parameter_of(&scenes[0], "cart_friction") = 0.1;
    *parameter_of(&scenes[0], "pole_friction") = 0.005;
    scenes[0].initial[1] = 2;
    scenes[1] = scene_of(system_called("pendulum"), 0, MCT_GRAVITY);
    scenes[1].initial[0] = 2;
    scenes[2] = scene_of(system_called("spring_pendulum"), 0, MCT_GRAVITY | MCT_SPRING);
    *parameter_of(&scenes[2], "mass") = 1;
    *parameter_of(&scenes[2], "stiffness") = 100;
    *parameter_of(&scenes[2], "rest_length") = 1;
    scenes[2].initial[0] = 1.2;
    scenes[2].initial[1] = 1;
    scenes[3] = scene_of(system_called("rigid_body"), 0, MCT_GRAVITY);
    set_rows(&scenes[3], 0, lumps, 16);
    memcpy(scenes[3].initial + 7, (double[]){1, 5, 2, 0.5, 2, 0.3}, 6 * sizeof(double));
    for (int i = 0; i < 4; i++) {
        scenes[i].dt = 0.02;
        printf("%-16s at 20 ms:", mct_systems[scenes[i].system]->name);
        double error = 0;
        for (int stepper = MCT_STEPPER_RK4; stepper <= MCT_STEPPER_TAYLOR12; stepper++) {
            scenes[i].stepper = stepper;
            error = error_of(&scenes[i]);
            printf("  %s %.1e", mct_steppers[stepper].name, error);
        }
        printf("\n");
        TEST_ASSERT_TRUE(error < 1e-12);
    }
}

/* --- the spring pendulum's pivot --- */

/* The ball falls past the pivot again and again; a step is as long as the time for which it is near. */
static mct_scene passing(double rest_length, int stepper, double aside)
{
    mct_scene scene = scene_of(system_called("spring_pendulum"), stepper, MCT_SPRING);
    *parameter_of(&scene, "mass") = 1;
    *parameter_of(&scene, "stiffness") = 100;
    *parameter_of(&scene, "rest_length") = rest_length;
    scene.initial[0] = 0.5;
    scene.initial[3] = aside;
    return scene;
}

/* Without a rest length the motion is an ellipse, whose series knows no pivot: 5 mm beside it at 5 m/s, at 20 ms. */
static void test_without_rest_length_a_series_passes_the_pivot_as_if_it_were_not_there(void)
{
    mct_scene scene = passing(0, MCT_STEPPER_TAYLOR12, 0.1);
    mct_plant plant;
    double worst = 0;
    scene.dt = 0.02;
    start_plant(&plant, &scene);
    for (int k = 1; k <= 500; k++) {
        mct_plant_step(&plant, 0);
        const double r = mct_plant_value(&plant, 0), th = mct_plant_value(&plant, 1), phase = 10 * 0.02 * k;
        worst = fmax(worst, fabs(r * cos(th) - 0.5 * cos(phase)));
        worst = fmax(worst, fabs(r * sin(th) - 0.005 * sin(phase)));
    }
    printf("past the pivot: %.1e m off an ellipse of 0.5 m\n", worst);
    TEST_ASSERT_TRUE(worst < 1e-12);
    TEST_ASSERT_EQUAL_UINT64(0, plant.diverged_ticks);
}

/*
 * With one, 1/R leaves a series nothing to converge to; there it takes rk4's parts of a step, each a quarter of the time in
 * which the force turns: by order 4 that leaves 4^-5 of h^2 k l0/m, 1e-6 of the 0.5 m, and once more that for the way out.
 */
static void test_with_a_rest_length_every_stepper_passes_near_the_pivot_within_2e_6(void)
{
    double worst[MCT_STEPPER_COUNT] = {0};
    for (double aside = 0.02; aside < 1; aside *= 2) {
        mct_scene scene = passing(0.2, MCT_STEPPER_RK4, aside);
        scene.dt = 0.005;
        textbook book;
        mct_plant plant;
        quad x[QUAD_MAX_STATES];
        double error[MCT_STEPPER_COUNT];
        TEST_ASSERT_TRUE(textbook_of(&book, &scene, 0));
        start_plant(&plant, &scene);
        textbook_start(&book, &plant, x);
        quad_extrapolate(book.rate, &book, 0, x, book.states, (quad)0.3, 2000);
        for (int stepper = MCT_STEPPER_RK4; stepper <= MCT_STEPPER_TAYLOR12; stepper++) {
            scene.stepper = stepper;
            start_plant(&plant, &scene);
            step_plant(&plant, 0, 60);
            TEST_ASSERT_EQUAL_UINT64(0, plant.diverged_ticks);
            error[stepper] = fabs(mct_plant_value(&plant, 0) - (double)x[0]) / 0.5;
        }
        printf("%.3f m beside the pivot:", 0.05 * aside);
        for (int stepper = MCT_STEPPER_RK4; stepper <= MCT_STEPPER_TAYLOR12; stepper++) {
            printf("  %s %.1e", mct_steppers[stepper].name, error[stepper]);
            worst[stepper] = fmax(worst[stepper], error[stepper]);
        }
        printf("\n");
    }
    for (int stepper = MCT_STEPPER_RK4; stepper <= MCT_STEPPER_TAYLOR12; stepper++) {
        TEST_ASSERT_TRUE(worst[stepper] < 2e-6);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_seed_is_the_first_order_and_a_series_adds_the_next_derivative);
    RUN_TEST(test_a_coordinate_gets_one_term_more_than_its_rate);
    RUN_TEST(test_order_12_follows_free_motion_at_20_ms_within_1e_12);
    RUN_TEST(test_without_rest_length_a_series_passes_the_pivot_as_if_it_were_not_there);
    RUN_TEST(test_with_a_rest_length_every_stepper_passes_near_the_pivot_within_2e_6);
    return UNITY_END();
}

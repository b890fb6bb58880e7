/*
 * Peers of tools/bench --peers get the same physics: the closed form that they are given (tools/benchmark/closed_form.h)
 * is this library's, and the start is the same state.
 */
#include <math.h>
#include <stdio.h>

#include "mctau/plant.h"
#include "mctau/rotation.h"
#include "support/random.h"
#include "tools/benchmark/mctau_scene.h"
#include "unity.h"

/* scenes.c is no part of the library. */
#include "tools/benchmark/scenes.c"

void setUp(void)
{
}

void tearDown(void)
{
}

static mct_plant plant_of(const bench_scene *scene)
{
    mct_scene described;
    mct_plant plant;
    mct_message why = {""};
    TEST_ASSERT_TRUE_MESSAGE(mctau_scene_of(scene, &described), scene->name);
    described.stepper = MCT_STEPPER_RK4;
    described.substeps = 1000; /* short enough for the stiffest */
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_plant_init(&plant, &described, &why), why.text);
    return plant;
}

static void test_a_plant_begins_at_the_start_of_the_scene(void)
{
    for (int n = 0; n < SCENE_PEERS; n++) {
        const bench_scene *scene = &bench_scenes[n];
        const mct_plant plant = plant_of(scene);
        double x[SCENE_STATES];
        mctau_read(scene, &plant, x);
        for (int i = 0; i < scene->states; i++) {
            TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-15, scene->start[i], x[i], scene->name);
        }
    }
}

/* Accelerations, and the rate of the current, of the closed form from an evaluation at the same state. */
static void expected_rates(const bench_scene *scene, const mct_plant *plant, double input, const double *x,
                           double *dx)
{
    mct_evaluation now;
    mct_plant_evaluate(plant, &now);
    const int n = plant->system->coordinate_count;
    if (scene->form != SCENE_BODY) {
        memcpy(dx, x + n, sizeof(double) * (size_t)n);
    }
    if (scene->form == SCENE_SPRING) { /* of r and angle: the acceleration in space */
        const double r = plant->state.x[0], rd = plant->state.x[2], w = plant->state.x[3];
        const double c = x[0] / r, s = x[1] / r;
        const double along = now.acceleration[0] - r * w * w;
        const double across = r * now.acceleration[1] + 2 * rd * w;
        dx[2] = along * c - across * s;
        dx[3] = along * s + across * c;
    } else if (scene->form == SCENE_BODY) {
        mct_real rate[4];
        mct_quaternion_rate_body(plant->state.x + MCTAU_BODY_Q, plant->state.x + MCTAU_BODY_W, rate);
        memcpy(dx, rate, sizeof rate);
        memcpy(dx + 4, now.acceleration + 3, sizeof(double) * 3);
    } else {
        memcpy(dx + n, now.acceleration, sizeof(double) * (size_t)n);
    }
    if (scene->form == SCENE_WHEEL) {
        double p[SCENE_PARAMETERS];
        scene_parameters(scene, p);
        dx[4] = (input - p[10] * x[4] - p[9] * x[3]) / p[11];
    }
}

static void test_the_closed_form_has_the_accelerations_of_an_evaluation(void)
{
    test_random random = {20};
    double worst = 0;
    for (int n = 0; n < SCENE_PEERS; n++) {
        const bench_scene *scene = &bench_scenes[n];
        mct_plant plant = plant_of(scene);
        double k[SCENE_CONSTANTS];
        scene_constants(scene, k);
        for (int trial = 0; trial < 1000; trial++) {
            double x[SCENE_STATES], entries[MCT_MAX_STATES], dx[SCENE_STATES], expected[SCENE_STATES];
            for (int i = 0; i < scene->states; i++) {
                x[i] = random_in(&random, -3, 3);
            }
            if (scene->form == SCENE_BODY) {
                const double length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]);
                for (int i = 0; i < 4; i++) {
                    x[i] /= length;
                }
            }
            mctau_state_of(scene, x, entries);
            mct_state_set(plant.system, plant.states, entries, &plant.state);
            plant.input = scene->form == SCENE_BODY ? 0 : random_in(&random, -2, 2);
            scene_rate_of(scene)(k, plant.input, x, dx);
            expected_rates(scene, &plant, plant.input, x, expected);
            for (int i = 0; i < scene->states; i++) {
                /* Roundings of some ten operations; near the pivot of the spring they grow as 1/r. */
                double size = 1;
                for (int j = 0; j < scene->states; j++) {
                    size = fmax(size, fabs(expected[j]));
                }
                worst = fmax(worst, fabs(dx[i] - expected[i]) / size);
                TEST_ASSERT_DOUBLE_WITHIN_MESSAGE(1e-13 * size, expected[i], dx[i], scene->name);
            }
        }
    }
    printf("closed form and evaluation differ by %.1e\n", worst);
}

static void test_the_jacobian_of_the_wheel_is_the_slope_of_its_rates(void)
{
    const bench_scene *scene = scene_by_name("wheel 1 ms held");
    const double x[5] = {0.7, 2, -1.5, 30, 0.2};
    double k[SCENE_CONSTANTS], J[25];
    scene_constants(scene, k);
    scene_wheel_jacobian(k, x, J);
    for (int j = 0; j < 5; j++) {
        double above[5], below[5], up[5], down[5];
        memcpy(above, x, sizeof above);
        memcpy(below, x, sizeof below);
        above[j] += 1e-5;
        below[j] -= 1e-5;
        scene_wheel_rate(k, 1, above, up);
        scene_wheel_rate(k, 1, below, down);
        for (int i = 0; i < 5; i++) { /* central differences: roundings of 1e3 over 2e-5 */
            TEST_ASSERT_DOUBLE_WITHIN(1e-7, J[5 * i + j], (up[i] - down[i]) / 2e-5);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_plant_begins_at_the_start_of_the_scene);
    RUN_TEST(test_the_closed_form_has_the_accelerations_of_an_evaluation);
    RUN_TEST(test_the_jacobian_of_the_wheel_is_the_slope_of_its_rates);
    return UNITY_END();
}

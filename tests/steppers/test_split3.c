/*
 * Splitting about the principal axes: it keeps momentum to rounding at any spin, energy nearby for good, is
 * exact where two moments are equal, and symmetric in time. Its order is measured in test_order_f64.c, its
 * laws in test_invariants_property.c.
 *
 * What rounding does: each of n steps rounds a turn of the momentum that it leaves alone, and these add up
 * like a random walk; 10 sqrt(n) roundings are allowed.
 */
#include <math.h>
#include <stdio.h>

#include "support/bodies.h"
#include "unity.h"

#define EPSILON ((double)MCT_REAL_EPSILON)

static int rigid_body;

void setUp(void)
{
    rigid_body = system_called("rigid_body");
}

void tearDown(void)
{
}

static mct_scene body_scene(int stepper, const double *moments, const double *w)
{
    mct_scene scene = scene_of(rigid_body, stepper, 0);
    set_rows(&scene, 0, NULL, 0);
    *parameter_of(&scene, "mass") = 1;
    for (int i = 0; i < 3; i++) {
        parameter_of(&scene, "inertia_1_1")[4 * i] = moments[i];
        scene.initial[10 + i] = w[i];
    }
    return scene;
}

/* A body that lies askew in its axes, of many moments. */
static mct_scene askew_scene(int stepper)
{
    static const double rows[16] = {0.3, 0.2, 0.1,  0,   0.2, -0.1, 0.3, 0.1,
                                    0.5, 0,   -0.2, 0.2, 0.1, 0.1,  0.1, -0.4};
    static const double w[3] = {2, -4, 3};
    mct_scene scene = scene_of(rigid_body, stepper, 0);
    set_rows(&scene, 0, rows, 16);
    memcpy(scene.initial + 10, w, sizeof w);
    return scene;
}

/* Momentum in space, and the energy that turning has. */
static double momentum_of(const mct_plant *plant, double *momentum)
{
    mct_evaluation now;
    quad x[BODY_STATES], r[3][3], own[3];
    mct_plant_evaluate(plant, &now);
    body_of_plant(plant, x);
    quad_matrix(x, r);
    for (int i = 0; i < 3; i++) {
        own[i] = 0;
        for (int j = 0; j < 3; j++) {
            own[i] += (quad)now.M[3 + i][3 + j] * x[BODY_W + j];
        }
    }
    for (int i = 0; i < 3; i++) {
        momentum[i] = (double)(r[i][0] * own[0] + r[i][1] * own[1] + r[i][2] * own[2]);
    }
    return (double)(own[0] * x[BODY_W] + own[1] * x[BODY_W + 1] + own[2] * x[BODY_W + 2]) / 2;
}

typedef struct {
    double momentum, energy; /* largest relative change */
} change;

static change change_over(const mct_scene *scene, long looks, long steps)
{
    mct_plant plant;
    double first[3], now[3];
    change worst = {0, 0};
    start_plant(&plant, scene);
    const double energy = momentum_of(&plant, first);
    const double size = sqrt(first[0] * first[0] + first[1] * first[1] + first[2] * first[2]);
    for (long k = 0; k < looks; k++) {
        step_plant(&plant, 0, steps);
        worst.energy = fmax(worst.energy, fabs(momentum_of(&plant, now) / energy - 1));
        for (int i = 0; i < 3; i++) {
            worst.momentum = fmax(worst.momentum, fabs(now[i] - first[i]) / size);
        }
    }
    return worst;
}

/* The body turns half round within a step; a series and a polynomial know nothing of that. */
static void test_momentum_is_kept_at_a_spin_at_which_rk4_loses_it(void)
{
    static const double moments[3] = {1, 1.1, 0.5};
    for (double spin = 100; spin < 11000; spin *= 3.1622776601683795) {
        const double w[3] = {spin / 100, 0, spin};
        const mct_scene split = body_scene(MCT_STEPPER_SPLIT3, moments, w);
        const mct_scene plain = body_scene(MCT_STEPPER_RK4, moments, w);
        const change kept = change_over(&split, 10, 1000);
        const change lost = change_over(&plain, 10, 1000);
        printf("%5.0f rad/s at 1 ms, 10 s: split3 keeps momentum within %.1e, energy %.1e; rk4 %.1e, %.1e\n",
               spin, kept.momentum, kept.energy, lost.momentum, lost.energy);
        TEST_ASSERT_TRUE(kept.momentum < 1000 * EPSILON); /* 10 sqrt(10^4) */
        TEST_ASSERT_TRUE(kept.energy < 1e-3);
        TEST_ASSERT_TRUE(spin < 3000 || !(lost.momentum < 1e-3));
    }
}

/* Order 2: energy is off by (w h)^2, 3e-5 here, times what the moments differ; and stays there. */
static void test_momentum_is_kept_to_rounding_and_energy_nearby_over_a_million_steps(void)
{
    const mct_scene scene = askew_scene(MCT_STEPPER_SPLIT3);
    const change early = change_over(&scene, 100, 100);
    const change late = change_over(&scene, 1000, 1000);
    printf("1e6 steps: momentum within %.1e, energy within %.1e, after 1e4 steps %.1e\n", late.momentum,
           late.energy, early.energy);
    TEST_ASSERT_TRUE(late.momentum < 10000 * EPSILON);
    TEST_ASSERT_TRUE(late.energy < 1e-5 + 10000 * EPSILON);
    TEST_ASSERT_TRUE(late.energy < 1.2 * early.energy + 10000 * EPSILON);
}

/* Two equal moments: w turns about the axis at the rate (1 - I3/I1) w3, whatever the step. */
static void test_a_symmetric_body_moves_exactly_at_any_step(void)
{
    static const double w[3] = {3, 0, 40};
    for (int axis = 0; axis < 3; axis++) {
        const int j = (axis + 1) % 3, l = (axis + 2) % 3;
        double moments[3], turned[3];
        moments[axis] = 0.7;
        moments[j] = moments[l] = 1.9;
        turned[axis] = w[2];
        turned[j] = w[0];
        turned[l] = w[1];
        mct_scene scene = body_scene(MCT_STEPPER_SPLIT3, moments, turned);
        mct_plant plant;
        scene.dt = 0.125;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, 80);
        const double angle = (0.7 / 1.9 - 1) * w[2] * 10;
        const double expected[3] = {w[2], w[0] * cos(angle), w[0] * sin(angle)};
        const int place[3] = {axis, j, l};
        for (int i = 0; i < 3; i++) {
            const double found = mct_plant_value(&plant, 10 + place[i]);
            /* a rate is rounded, and so is its angle of 250 rad */
            TEST_ASSERT_TRUE(fabs(found - expected[i]) < 4 * fabs(angle) * w[0] * EPSILON);
        }
    }
}

/* Turned round it comes back: symmetric in time, with forces too. */
static void test_split3_returns_to_its_start_when_reversed(void)
{
    static const double push[7] = {0, 0.1, 0.2, 0, 0.5, 0.4, -0.3};
    mct_scene scene = askew_scene(MCT_STEPPER_SPLIT3);
    scene.effects = MCT_GRAVITY | MCT_FORCES;
    set_rows(&scene, 1, push, 7);
    scene.dt = 0.01;
    mct_plant plant;
    quad start[BODY_STATES], end[BODY_STATES], far[BODY_STATES];
    start_plant(&plant, &scene);
    body_of_plant(&plant, start);
    for (int way = 0; way < 2; way++) {
        step_plant(&plant, 0, 500);
        body_of_plant(&plant, far);
        for (int i = 7; i < 13; i++) {
            plant.state.x[i] = -plant.state.x[i];
            plant.state.c[i] = -plant.state.c[i];
        }
        TEST_ASSERT_TRUE(way == 1 || body_distance(start, far) > 1);
    }
    body_of_plant(&plant, end);
    const double off = body_distance(start, end);
    printf("comes back within %.1e after 500 + 500 steps of 10 ms\n", off);
    TEST_ASSERT_TRUE(off < 1000 * EPSILON); /* a rounding of each step, of places of some metres */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_momentum_is_kept_at_a_spin_at_which_rk4_loses_it);
    RUN_TEST(test_momentum_is_kept_to_rounding_and_energy_nearby_over_a_million_steps);
    RUN_TEST(test_a_symmetric_body_moves_exactly_at_any_step);
    RUN_TEST(test_split3_returns_to_its_start_when_reversed);
    return UNITY_END();
}

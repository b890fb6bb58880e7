/*
 * Two ways to treat dry friction that share no code meet: exact friction is the limit of Moreau's clamp at fine steps.
 *
 * Tolerance: Moreau is of first order where something starts or stops. At 1/64 of the step it is off by some 1e-4 of the
 * motion, and the median of many cases falls with the step.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

enum { CASES = 120, TICKS = 400 };

static const char *const systems[] = {"cart_pole",         "reaction_wheel", "pendulum",
                                      "particle_pendulum", "fixed_axis",     "solid_pendulum"};

void setUp(void)
{
}

void tearDown(void)
{
}

static void set(mct_scene *scene, const char *name, double value)
{
    for (int i = 0; i < mct_systems[scene->system]->parameter_count; i++) {
        if (strcmp(mct_systems[scene->system]->parameters[i].name, name) == 0) {
            scene->parameters[i] = value;
        }
    }
}

static void run(mct_scene scene, int stepper, uint32_t coulomb, int substeps, const double *input,
                mct_plant *plant)
{
    scene.stepper = stepper;
    scene.effects |= coulomb;
    scene.substeps = substeps;
    start_plant(plant, &scene);
    for (int k = 0; k < TICKS; k++) {
        mct_plant_step(plant, (mct_real)input[k / 100]);
    }
}

static int by_size(const void *a, const void *b)
{
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

static void test_exact_friction_is_the_limit_of_moreaus(void)
{
    test_random random = {11};
    double coarse[CASES], fine[CASES];
    for (int k = 0; k < CASES; k++) {
        const int system = system_called(systems[k % 6]);
        const uint32_t drag = (k / 6) % 2 ? MCT_DRAG & mct_systems[system]->effects : 0;
        mct_scene scene = scene_of(system, MCT_STEPPER_LEAP, MCT_GRAVITY | MCT_VISCOUS | drag);
        const bool heavy =
            strcmp(systems[k % 6], "fixed_axis") == 0 || strcmp(systems[k % 6], "solid_pendulum") == 0;
        const double size = heavy ? 5 : 0.1; /* of couples */
        set(&scene, "coulomb", size * random_scale(&random, 0.1, 1));
        set(&scene, "cart_coulomb", random_scale(&random, 0.3, 3));
        set(&scene, "pole_coulomb", random_scale(&random, 0.01, 0.3));
        set(&scene, "arm_coulomb", random_scale(&random, 0.003, 0.1));
        set(&scene, "wheel_coulomb", random_scale(&random, 0.0003, 0.01));
        set(&scene, "static_ratio", k % 4 == 0 ? 1 : random_in(&random, 1, 1.5));
        set(&scene, "drag", 0.001);
        set(&scene, "cart_drag", 0.3);
        set(&scene, "pole_drag", 0.002);
        set(&scene, "arm_drag", 0.001);
        const int n = mct_systems[system]->coordinate_count;
        double input[4];
        for (int i = 0; i < 2 * n; i++) {
            scene.initial[i] = random_in(&random, -2, 2);
        }
        for (int i = 0; i < 4; i++) {
            input[i] = random_in(&random, -1, 1) * (system == CART_POLE        ? 4
                                                    : system == REACTION_WHEEL ? 0.01
                                                                               : size);
        }
        mct_plant exact, moreau, finer;
        run(scene, MCT_STEPPER_TAYLOR6, MCT_COULOMB_EXACT, 1, input, &exact);
        run(scene, MCT_STEPPER_LEAP, MCT_COULOMB_MOREAU, 8, input, &moreau);
        run(scene, MCT_STEPPER_LEAP, MCT_COULOMB_MOREAU, 64, input, &finer);
        coarse[k] = fine[k] = 0;
        for (int i = 0; i < n; i++) {
            const double truth = mct_plant_value(&exact, i);
            coarse[k] = fmax(coarse[k], fabs(mct_plant_value(&moreau, i) - truth));
            fine[k] = fmax(fine[k], fabs(mct_plant_value(&finer, i) - truth));
        }
    }
    qsort(coarse, CASES, sizeof coarse[0], by_size);
    qsort(fine, CASES, sizeof fine[0], by_size);
    printf("from exact: at 1/8 of the step %.1e in the median, %.1e at most; at 1/64 %.1e and %.1e\n",
           coarse[CASES / 2], coarse[CASES - 1], fine[CASES / 2], fine[CASES - 1]);
    TEST_ASSERT_TRUE(fine[CASES - 1] < 1e-3);
    TEST_ASSERT_TRUE(MCT_REAL_IS_FLOAT || fine[CASES / 2] < coarse[CASES / 2] / 4);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_exact_friction_is_the_limit_of_moreaus);
    return UNITY_END();
}

/*
 * The falling sphere: its closed form against the Gauss engine, its power balance, and what is refused.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/gauss.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

/* Some tens of roundings of the terms that meet. */
#define TOLERANCE (MCT_REAL_IS_FLOAT ? 100 * (double)FLT_EPSILON : 1e-12)
#define PI        3.141592653589793

void setUp(void)
{
}

void tearDown(void)
{
}

static int sphere(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, "falling_sphere") == 0) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE("no falling_sphere");
    return 0;
}

static void test_the_closed_form_is_what_gauss_principle_gives_and_its_powers_add_up(void)
{
    static const uint32_t switches[4] = {MCT_GRAVITY, MCT_STOKES, MCT_DRAG, MCT_BUOYANCY};
    test_random random = {12345};
    double worst = 0;
    for (int k = 0; k < 10000; k++) {
        uint32_t effects = 0;
        for (int i = 0; i < 4; i++) {
            effects |= (k >> i) & 1 ? switches[i] : 0;
        }
        mct_scene scene = scene_of(sphere(), MCT_STEPPER_EXPO, effects);
        double *const p =
            scene.parameters; /* radius, density, fluid_density, fluid_viscosity, coefficient, gravity */
        p[0] = random_scale(&random, 1e-4, 1);
        p[1] = random_scale(&random, 1, 1e4);
        p[2] = random_scale(&random, 1, 1e4);
        p[3] = random_scale(&random, 1e-5, 10);
        p[4] = random_scale(&random, 0.1, 10);
        mct_constants constants;
        const mct_system *const system = mct_systems[sphere()];
        TEST_ASSERT_EQUAL_INT(MCT_OK, system->prepare(&scene, 1e-3, &constants, NULL));
        const mct_real x[2] = {(mct_real)random_in(&random, -10, 10), (mct_real)random_in(&random, -10, 10)};
        const mct_real u = (mct_real)random_in(&random, -1, 1);
        mct_evaluation out;
        system->evaluate(&constants, effects, x, u, &out);
        const double v = (double)x[1];
        const double volume = 4 * PI / 3 * p[0] * p[0] * p[0];
        const double m = p[1] * volume;
        const double terms[] = {
            (double)u,
            (effects & MCT_GRAVITY) ? -m * p[5] : 0,
            (effects & MCT_BUOYANCY) ? p[2] * volume * p[5] : 0,
            (effects & MCT_STOKES) ? -6 * PI * p[3] * p[0] * v : 0,
            (effects & MCT_DRAG) ? -0.5 * p[2] * p[4] * PI * p[0] * p[0] * v * fabs(v) : 0,
        };
        double sum = 0;
        double size = 0;
        for (int i = 0; i < 5; i++) {
            sum += terms[i];
            size += fabs(terms[i]);
        }
        const mct_real force[3] = {0, (mct_real)sum, 0};
        const mct_gauss_system engine = {1, 1, out.mass, system->place, &constants};
        static mct_gauss_workspace workspace;
        static mct_gauss_motion motion;
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_kinematics(&engine, 0, x, x + 1, &workspace, &motion));
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_dynamics(&engine, force, NULL, &workspace, &motion));
        double error = fabs((double)(out.M[0][0] - motion.M[0][0])) / m;
        error = fmax(error, fabs((double)(out.Cv[0] - motion.Cv[0])) / size);
        error = fmax(error, fabs((double)(out.tau[0] - motion.tau[0])) / size);
        error = fmax(error, fabs((double)(out.acceleration[0] - motion.acceleration[0])) * m / size);
        error =
            fmax(error, fabs((double)(out.constraint_force[0][1] - motion.constraint_force[0][1])) / size);
        error = fmax(error, fabs((double)(out.position[0][1] - motion.position[0][1])));
        const double rate = m * v * (double)out.acceleration[0] - (terms[1] + terms[2]) * v;
        const double powers = energy_rate(&out);
        error = fmax(error, fabs(rate - powers) / (size * fabs(v)));
        const double energy = 0.5 * m * v * v - (terms[1] + terms[2]) * (double)x[0];
        const double given = (double)out.kinetic_energy + (double)out.potential_energy;
        error = fmax(error, fabs(energy - given) / (m * v * v + size * fabs((double)x[0])));
        worst = fmax(worst, error);
        TEST_ASSERT_TRUE(error <= TOLERANCE);
        TEST_ASSERT_TRUE(out.power[MCT_EFFECT_STOKES] <= 0 && out.power[MCT_EFFECT_DRAG] <= 0);
    }
    printf("closed form and power balance: %.1e of the terms\n", worst);
}

/* (452) as printed, - v / (b m), is another motion; as corrected it is the closed form. */
static void test_equation_452_holds_as_corrected_and_not_as_printed(void)
{
    mct_scene scene = scene_of(sphere(), MCT_STEPPER_EXPO, MCT_STOKES);
    mct_constants constants;
    mct_systems[sphere()]->prepare(&scene, 1e-3, &constants, NULL);
    const mct_real x[2] = {0, 1};
    mct_evaluation out;
    mct_systems[sphere()]->evaluate(&constants, MCT_STOKES, x, 0, &out);
    const double m = 4 * PI / 3 * 1e-9 * 7850;
    const double b = 6 * PI * 1.42 * 1e-3;
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * b / m, -b / m, (double)out.acceleration[0]);
    TEST_ASSERT_TRUE(fabs((double)out.acceleration[0] + 1 / (b * m)) > 1);
}

static void test_a_sphere_that_stops_at_once_is_refused_in_a_sentence(void)
{
    mct_scene scene = scene_of(sphere(), MCT_STEPPER_EXPO, MCT_STOKES);
    mct_constants constants;
    mct_message why = {""};
    *parameter_of(&scene, "radius") = 1e-7;
    *parameter_of(&scene, "density") = 1e-3;
    *parameter_of(&scene, "fluid_viscosity") = 1e6;
    TEST_ASSERT_TRUE(mct_systems[sphere()]->prepare(&scene, 0.001, &constants, &why) != MCT_OK);
    TEST_ASSERT_EQUAL_STRING(
        "parameters.fluid_viscosity: found a sphere that stops at once; allowed 1e18 times a step", why.text);
}

static void test_a_step_too_long_for_an_explicit_stepper_is_refused(void)
{
    FOR_EACH_STEPPER (stepper, sphere(), mct_systems[sphere()]->effects) {
        mct_scene scene = scene_of(sphere(), stepper, mct_systems[sphere()]->effects);
        scene.dt = 0.01; /* against 1.2 ms */
        mct_plant plant;
        mct_message why = {""};
        const mct_status status = mct_plant_init(&plant, &scene, &why);
        if (stepper == MCT_STEPPER_SEED || stepper == MCT_STEPPER_RK4) {
            TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, status);
            TEST_ASSERT_EQUAL_STRING(
                "parameters.fluid_viscosity: found 1.42 Pa s, which slows the sphere within "
                "0.001228482 s; allowed with this stepper at least half a step, 0.005 s; with "
                "expo and euler any",
                why.text);
        } else {
            TEST_ASSERT_EQUAL_INT(MCT_OK, status);
            step_plant(&plant, 0, 1000);
            TEST_ASSERT_EQUAL_INT(0, plant.diverged_ticks);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_closed_form_is_what_gauss_principle_gives_and_its_powers_add_up);
    RUN_TEST(test_equation_452_holds_as_corrected_and_not_as_printed);
    RUN_TEST(test_a_sphere_that_stops_at_once_is_refused_in_a_sentence);
    RUN_TEST(test_a_step_too_long_for_an_explicit_stepper_is_refused);
    return UNITY_END();
}

/* A scene whose steps are too long for its motion is refused, with the steps that do; near that there is a note. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "scene/pace.h"
#include "support/scenes.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* A cart of a millionth of the pole's mass: where the pole hangs, it swings through within 1e-7 s. */
static mct_scene light_cart(int stepper)
{
    mct_scene scene = scene_of(CART_POLE, stepper, MCT_GRAVITY);
    *parameter_of(&scene, "cart_mass") = 1e-6;
    *parameter_of(&scene, "pole_mass") = 1;
    *parameter_of(&scene, "pole_length") = 0.5;
    scene.initial[1] = 2;
    return scene;
}

/* Largest gain of energy, over what the motion exchanges. */
static double energy_gained(const mct_scene *scene, double duration)
{
    static mct_plant plant;
    start_plant(&plant, scene);
    const double start = energy_of(&plant), scale = start + 9.81 * 0.5;
    double gained = 0;
    for (long tick = 0; tick < (long)(duration / scene->dt + 0.5); tick++) {
        mct_plant_step(&plant, 0);
        gained = fmax(gained, (energy_of(&plant) - start) / scale);
    }
    return gained;
}

static void test_a_light_cart_is_refused_by_its_share_of_inertia_its_step_and_the_steps_that_do(void)
{
    mct_scene scene = light_cart(MCT_STEPPER_RK4);
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_scene_check(&scene, &why));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "scene.dt: found steps of 0.001 s by rk4"), why.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, " feels "), why.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "allowed steps up to "), why.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "1000 scene.substeps"), why.text);
}

static void test_a_light_cart_blows_up_as_it_is_and_keeps_its_energy_with_the_steps_that_are_allowed(void)
{
    static const int steppers[] = {MCT_STEPPER_EULER, MCT_STEPPER_LEAP, MCT_STEPPER_RK4};
    for (int i = 0; i < 3; i++) {
        mct_scene scene = light_cart(steppers[i]);
        mct_pace pace;
        TEST_ASSERT_TRUE(energy_gained(&scene, 10) > 1000);
        mct_pace_find(&scene, &pace);
        TEST_ASSERT_EQUAL_INT(MCT_PACE_NOT_FOLLOWED, pace.verdict);
        TEST_ASSERT_TRUE(pace.longest > 0 && pace.longest < 1e-6);
        scene.substeps = 1000;
        scene.dt = 1000 * pace.longest;
        scene.duration = 100 * scene.dt;
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_scene_check(&scene, NULL));
        /* What a step leaves open is 0.11 of the rates, see src/scene/pace.c; energies are sums with the cart's millionth. */
        const double gained = energy_gained(&scene, 1);
        printf("%s: steps of %.3g s, energy grows by %.2g\n", mct_steppers[steppers[i]].name, pace.longest,
               gained);
        TEST_ASSERT_TRUE(gained < 0.11 + 4 * (double)MCT_REAL_EPSILON / 1e-6);
    }
}

static void test_every_system_is_followed_at_its_defaults_without_a_word(void)
{
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        mct_scene scene;
        mct_message why = {""};
        mct_scene_defaults(&scene, system);
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_scene_check(&scene, &why), why.text);
        TEST_ASSERT_FALSE_MESSAGE(mct_scene_note(&scene, 0, &why), why.text);
    }
}

/* But by the textbook's step, to which a sphere that settles within 0.3 ms is too fast. Motors have limits of their own. */
static void test_every_system_is_followed_at_its_defaults_by_every_stepper_that_suits(void)
{
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        for (int stepper = MCT_STEPPER_EULER; stepper < MCT_STEPPER_COUNT; stepper++) {
            mct_scene scene;
            mct_message why = {""};
            mct_scene_defaults(&scene, system);
            scene.stepper = stepper;
            scene.effects &= ~(uint32_t)MCT_MOTOR;
            if (mct_systems[system]->kernel(stepper, mct_scene_effects(&scene)) != NULL) {
                TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_scene_check(&scene, &why), why.text);
            }
        }
    }
}

static void test_a_step_that_is_long_is_noted_one_too_long_refused_and_an_exact_scheme_never(void)
{
    mct_message why = {""};
    mct_scene scene = scene_of(system_called("spring_pendulum"), MCT_STEPPER_LEAP, MCT_SPRING);
    *parameter_of(&scene, "mass") = 1;
    scene.initial[0] = *parameter_of(&scene, "rest_length");
    scene.initial[2] = 1;
    const struct {
        double stiffness; /* w h = sqrt(stiffness) / 1000 */
        mct_pace_verdict verdict;
    } cases[] = {{1e4, MCT_PACE_FOLLOWS}, {2.25e6, MCT_PACE_LONG}, {3.5e6, MCT_PACE_NOT_FOLLOWED}};
    for (int i = 0; i < 3; i++) {
        mct_pace pace;
        *parameter_of(&scene, "stiffness") = cases[i].stiffness;
        mct_pace_find(&scene, &pace);
        printf("w h = %.2g: %.3g\n", sqrt(cases[i].stiffness) / 1000, pace.error);
        TEST_ASSERT_EQUAL_INT(cases[i].verdict, pace.verdict);
        TEST_ASSERT_EQUAL_INT(i == 2 ? MCT_ERROR_UNSUITED : MCT_OK, mct_scene_check(&scene, &why));
        TEST_ASSERT_EQUAL_INT(i == 1, mct_scene_note(&scene, 0, &why));
        if (i > 0) {
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "scene.substeps from 2"), why.text);
        }
    }
    const int sphere = system_called("falling_sphere");
    /* A sphere in honey: leap makes (2 - z) / (2 + z) of a decay exp(-z). */
    scene = scene_of(sphere, MCT_STEPPER_EXPO, MCT_GRAVITY | MCT_STOKES);
    *parameter_of(&scene, "fluid_viscosity") *= 1000;
    scene.initial[1] = 1;
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_scene_check(&scene, &why), why.text);
    TEST_ASSERT_FALSE(mct_scene_note(&scene, 0, &why));
    scene.stepper = MCT_STEPPER_LEAP;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_scene_check(&scene, &why));
}

static void test_what_does_not_move_has_no_pace(void)
{
    mct_pace pace;
    mct_scene scene = scene_of(system_called("pendulum"), MCT_STEPPER_RK4, 0);
    mct_pace_find(&scene, &pace);
    TEST_ASSERT_EQUAL_INT(MCT_PACE_FOLLOWS, pace.verdict);
    TEST_ASSERT_TRUE(pace.error == 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_light_cart_is_refused_by_its_share_of_inertia_its_step_and_the_steps_that_do);
    RUN_TEST(test_a_light_cart_blows_up_as_it_is_and_keeps_its_energy_with_the_steps_that_are_allowed);
    RUN_TEST(test_every_system_is_followed_at_its_defaults_without_a_word);
    RUN_TEST(test_every_system_is_followed_at_its_defaults_by_every_stepper_that_suits);
    RUN_TEST(test_a_step_that_is_long_is_noted_one_too_long_refused_and_an_exact_scheme_never);
    RUN_TEST(test_what_does_not_move_has_no_pace);
    return UNITY_END();
}

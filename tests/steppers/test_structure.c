/* What a stepper keeps and what it does not: reversibility of leap, the negative damping of seed, substeps.
 */
#include <math.h>
#include <stdio.h>

#include "support/scenes.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void reverse(mct_plant *plant)
{
    for (int i = 2; i < 4; i++) {
        plant->state.x[i] = -plant->state.x[i];
        plant->state.c[i] = -plant->state.c[i];
    }
}

/* Tolerance: a rounding of each of 2e5 compensated steps, which add up like a random walk, of states of
 * size 10. */
static void test_leap_returns_to_its_start_when_reversed(void)
{
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        mct_scene scene = scene_of(system, MCT_STEPPER_LEAP, MCT_GRAVITY);
        scene.initial[mct_systems[system]->actuation->upright_coordinate] = 2;
        scene.initial[3] = 0.5;
        mct_plant plant;
        start_plant(&plant, &scene);
        const mct_real input = system == CART_POLE ? 0 : MCT_R(0.001);
        double way = 0;
        step_plant(&plant, input, 100000);
        for (int i = 0; i < 4; i++) {
            way = fmax(way, fabs(mct_plant_value(&plant, i) - scene.initial[i]));
        }
        reverse(&plant);
        step_plant(&plant, input, 100000);
        reverse(&plant);
        double error = 0;
        for (int i = 0; i < 4; i++) {
            error = fmax(error, fabs(mct_plant_value(&plant, i) - scene.initial[i]) / fmax(1, way));
        }
        printf("%s: leap comes back within %.1e of its way after 1e5 + 1e5 steps\n",
               mct_systems[system]->name, error);
        TEST_ASSERT_TRUE(way > 1);
        TEST_ASSERT_TRUE(error < 4000 * (double)MCT_REAL_EPSILON);
    }
}

/* Growth of the amplitude of small swings of the hanging arm, per second. */
static double growth_rate(int stepper, double duration)
{
    mct_scene scene = scene_of(REACTION_WHEEL, stepper, MCT_GRAVITY);
    scene.initial[0] += 0.05;
    mct_plant plant;
    mct_evaluation hanging;
    const mct_real rest[MCT_MAX_STATES] = {MCT_R(3.141592653589793)};
    start_plant(&plant, &scene);
    plant.system->evaluate(&plant.constants, plant.effects, rest, 0, &hanging);
    const double lowest = (double)hanging.potential_energy;
    const double before = energy_of(&plant) - lowest;
    step_plant(&plant, 0, lround(duration / scene.dt));
    return 0.5 * log((energy_of(&plant) - lowest) / before) / duration;
}

static void test_seed_is_anti_damped_at_the_rate_that_theory_gives_and_the_others_are_not(void)
{
    const double J = 0.085 * 0.127 * 0.127 + 3.201e-3; /* of the defaults */
    const double weight = (0.025384 + 0.085 * 0.127) * 9.81;
    const double theory = weight / J * 1e-3 / 4;
    const double seed = growth_rate(MCT_STEPPER_SEED, 20);
    printf("amplitude of seed grows by %.4f 1/s, theory %.4f\n", seed, theory);
    TEST_ASSERT_DOUBLE_WITHIN(0.02 * theory, theory,
                              seed); /* swings up to 7 degrees are 0.1 % slower than small ones */
    FOR_EACH_STEPPER (stepper, REACTION_WHEEL, MCT_GRAVITY) {
        if (stepper == MCT_STEPPER_SEED) {
            continue;
        }
        const double rate = growth_rate(stepper, 20);
        printf("amplitude of %s grows by %.1e 1/s\n", mct_steppers[stepper].name, rate);
        TEST_ASSERT_TRUE(fabs(rate) < 0.02 * theory);
    }
}

/* A tick of n substeps is n steps of a plant whose tick is the n-th part: not a bit differs. */
static void test_substeps_are_steps(void)
{
    FOR_EACH_STEPPER (stepper, REACTION_WHEEL, MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_INDUCTIVE) {
        mct_scene scene = scene_of(REACTION_WHEEL, stepper, MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_INDUCTIVE);
        scene.initial[0] = 2;
        mct_scene fine = scene;
        scene.substeps = 4;
        fine.dt = scene.dt / 4;
        mct_plant whole;
        mct_plant parts;
        start_plant(&whole, &scene);
        start_plant(&parts, &fine);
        for (int k = 0; k < 50; k++) {
            step_plant(&whole, MCT_R(2.5), 1);
            step_plant(&parts, MCT_R(2.5), 4);
            for (int i = 0; i < 5; i++) {
                TEST_ASSERT_TRUE(whole.state.x[i] == parts.state.x[i] &&
                                 whole.state.c[i] == parts.state.c[i]);
            }
        }
    }
}

/* Upright, hanging and any place without gravity are equilibria of every stepper and effect set, to the last
 * bit. */
static void test_rest_is_rest_to_the_last_bit_for_every_stepper_and_effect_set(void)
{
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        for (uint32_t effects = 0; effects < 24; effects++) {
            FOR_EACH_STEPPER (stepper, system, effects) {
                mct_scene scene = scene_of(system, stepper, effects);
                scene.initial[mct_systems[system]->actuation->upright_coordinate] = 0;
                mct_plant plant;
                start_plant(&plant, &scene);
                step_plant(&plant, 0, 1000);
                for (int i = 0; i < 5; i++) {
                    TEST_ASSERT_TRUE(plant.state.x[i] == 0 && plant.state.c[i] == 0);
                }
            }
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_leap_returns_to_its_start_when_reversed);
    RUN_TEST(test_seed_is_anti_damped_at_the_rate_that_theory_gives_and_the_others_are_not);
    RUN_TEST(test_substeps_are_steps);
    RUN_TEST(test_rest_is_rest_to_the_last_bit_for_every_stepper_and_effect_set);
    return UNITY_END();
}

/*
 * The powers of every system and effect are the rates of its energies, at random states with random parameters and
 * effects, drawn by the descriptors.
 *
 * A rate is a central difference of order 8 along the states' rates: its step turns no angle by more than 0.04 rad, so it
 * is off by some 1e-15 of the motion's own terms, and by the energies' rounding over the step. In double alone: a
 * difference has no digits to spare in float.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/rotation.h"
#include "support/draws.h"
#include "support/scenes.h"
#include "unity.h"

enum { TRIALS = TEST_CASES(10000) };

void setUp(void)
{
}

void tearDown(void)
{
}

static mct_scene scene;
static mct_constants constants;
static mct_real x[MCT_MAX_STATES + 1], rate[MCT_MAX_STATES + 1];
static mct_evaluation at;
static uint32_t effects;
static mct_real input;

enum { KINETIC, POTENTIAL, MAGNETIC, ENERGIES };
static const char *const energy_names[ENERGIES] = {"kinetic", "potential", "magnetic"};

/* Rates of all states, the time among them. */
static void find_rates(const mct_system *system)
{
    const int n = mct_coordinate_count(&scene);
    const int first = mct_rate_index(system);
    const int states = mct_state_count(&scene);
    const bool turns = system->attitude != MCT_ATTITUDE_NONE;
    for (int i = 0; i < n; i++) {
        rate[i] = x[first + i];
        rate[first + i] = at.acceleration[i];
    }
    if (turns) {
        (system->attitude == MCT_ATTITUDE_BODY ? mct_quaternion_rate_body : mct_quaternion_rate_space)(
            x + n - 3, x + first + n - 3, rate + n - 3);
    }
    if (effects & MCT_MOTOR_INDUCTIVE) {
        const mct_motor *motor = system->actuation->motor(&constants);
        const mct_real w = x[first + system->actuation->driven_coordinate];
        rate[first + n] = (input - motor->resistance * x[first + n] - motor->emf * w) / motor->inductance;
    } else if (states > first + n && strcmp(system->name, "block") == 0) {
        rate[first + n] = *parameter_of(&scene, "force_frequency");
        rate[first + n + 1] = 1;
    } else if (states > first + n) {
        rate[first + n] = *parameter_of(&scene, "base_frequency_1");
        rate[first + n + 1] = *parameter_of(&scene, "base_frequency_2");
    }
    rate[states] = 1;
}

/* Rates of the energies, and what rounding may do to them. */
static double find_energy_rates(const mct_system *system, double *change)
{
    static const double weights[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    const int states = mct_state_count(&scene);
    double fastest = system->is_timed ? 10 : 1,
           largest = 0; /* a frame turns at some 3 rad/s about each axis */
    for (int i = 0; i < states; i++) {
        if (i < mct_rate_index(system) || mct_state_is_phase(system, i)) {
            fastest = fmax(fastest, fabs(rate[i]));
        }
    }
    const double h = 0.01 / fastest;
    memset(change, 0, ENERGIES * sizeof *change);
    for (int k = 1; k <= 4; k++) {
        for (int side = -1; side <= 1; side += 2) {
            mct_real there[MCT_MAX_STATES + 1];
            mct_evaluation then;
            for (int i = 0; i <= states; i++) {
                there[i] = x[i] + side * k * h * rate[i];
            }
            system->evaluate(&constants, effects, there, input, &then);
            change[KINETIC] += side * weights[k - 1] * then.kinetic_energy / h;
            change[POTENTIAL] += side * weights[k - 1] * then.potential_energy / h;
            change[MAGNETIC] += side * weights[k - 1] * then.magnetic_energy / h;
            largest = fmax(largest, then.kinetic_energy + fabs(then.potential_energy) + then.magnetic_energy);
        }
    }
    return 300 * MCT_REAL_EPSILON * largest / h; /* of energies, and of angles of some rad */
}

static void test_energies_change_by_the_powers_of_the_effects(void)
{
    for (int number = 0; number < MCT_SYSTEM_COUNT; number++) {
        const mct_system *system = mct_systems[number];
        test_random random = {(uint64_t)number + 7};
        double worst = 0;
        int tried = 0;
        for (int trial = 0; trial < 3 * TRIALS && tried < TRIALS && !system->is_process; trial++) {
            if (!draw_scene(&random, number, 0, &scene, &constants, x)) {
                continue;
            }
            tried++;
            effects = mct_scene_effects(&scene);
            input = random_in(&random, -10, 10);
            system->evaluate(&constants, effects, x, input, &at);
            find_rates(system);
            const bool has_motor = (effects & MCT_MOTOR) != 0;
            double change[ENERGIES], size = fabs(at.power_input) + fabs(at.power_resistance);
            double sum[ENERGIES] = {at.power_frame, 0, at.power_resistance + at.power_conversion};
            sum[has_motor ? MAGNETIC : KINETIC] += at.power_input;
            sum[MAGNETIC] -= at.power[MCT_EFFECT_MOTOR];
            for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
                sum[KINETIC] += at.power[i];
                sum[POTENTIAL] -= (mct_effects[i].mask & MCT_POTENTIAL) ? at.power[i] : 0;
                size += fabs(at.power[i]);
                TEST_ASSERT_TRUE_MESSAGE((effects & mct_effects[i].mask) || at.power[i] == 0,
                                         mct_effects[i].name);
            }
            for (int i = 0; i < mct_coordinate_count(&scene); i++) { /* what meets in the accelerations */
                const double v = x[mct_rate_index(system) + i];
                size += fabs(at.tau[i] * v) + fabs(at.Cv[i] * v);
                size += at.M[i][i] * fabs(at.acceleration[i] * v);
            }
            const double rounding = find_energy_rates(system, change) + 1e-12 * size;
            for (int i = 0; i < ENERGIES; i++) {
                const double error = fabs(change[i] - sum[i]) / rounding;
                if (has_motor || i != MAGNETIC) {
                    worst = fmax(worst, error);
                    char text[160];
                    snprintf(text, sizeof text, "%s: %s: %.17g W of powers, %.17g W of energies, within %.1e",
                             system->name, energy_names[i], sum[i], change[i], rounding);
                    TEST_ASSERT_TRUE_MESSAGE(error <= 1, text);
                }
            }
        }
        TEST_ASSERT_TRUE(system->is_process || tried == TRIALS);
        printf("%-18s %5d states, within %.2f of what rounding may do\n", system->name, tried, worst);
    }
}

/* Losses take, bounds and forces across a velocity do no work; a belt alone lets dry friction drive. */
static void test_losses_take_and_what_acts_across_a_velocity_does_not_work(void)
{
    static const int losses[] = {MCT_EFFECT_VISCOUS, MCT_EFFECT_STOKES, MCT_EFFECT_DRAG, MCT_EFFECT_COULOMB};
    for (int number = 0; number < MCT_SYSTEM_COUNT; number++) {
        const mct_system *system = mct_systems[number];
        test_random random = {(uint64_t)number + 3};
        for (int trial = 0; trial < TRIALS / 10 && !system->is_process; trial++) {
            if (draw_scene(&random, number, 0, &scene, &constants, x)) {
                system->evaluate(&constants, mct_scene_effects(&scene), x, 1, &at);
                const bool has_belt = strcmp(system->name, "block") == 0;
                for (int i = 0; i < (has_belt ? 3 : 4); i++) {
                    TEST_ASSERT_TRUE_MESSAGE(at.power[losses[i]] <= 0, system->name);
                }
                TEST_ASSERT_TRUE(at.power_resistance <= 0);
                TEST_ASSERT_TRUE(at.power[MCT_EFFECT_SATURATION] == 0 && at.power[MCT_EFFECT_CORIOLIS] == 0);
            }
        }
    }
}

/* In the frame they are all that C v is made of; what is left out of them is no part of it. */
static void test_apparent_forces_work_as_they_do_in_the_frame(void)
{
    for (int number = 0; number < MCT_SYSTEM_COUNT; number++) {
        const mct_system *system = mct_systems[number];
        test_random random = {11};
        for (int trial = 0; trial < TRIALS && system->is_timed; trial++) {
            TEST_ASSERT_TRUE(draw_scene(&random, number, 0, &scene, &constants, x));
            x[mct_state_count(&scene)] = random_in(&random, 0, 3);
            system->evaluate(&constants, mct_scene_effects(&scene), x, 0, &at);
            double work = at.power[MCT_EFFECT_CENTRIFUGAL] + at.power[MCT_EFFECT_EULER], size = fabs(work);
            for (int i = 0; i < system->coordinate_count; i++) {
                work += at.Cv[i] * x[mct_rate_index(system) + i];
                size += fabs(at.Cv[i] * x[mct_rate_index(system) + i]);
            }
            TEST_ASSERT_TRUE(fabs(work) <= 16 * MCT_REAL_EPSILON * size); /* of some ten terms */
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_energies_change_by_the_powers_of_the_effects);
    RUN_TEST(test_apparent_forces_work_as_they_do_in_the_frame);
    RUN_TEST(test_losses_take_and_what_acts_across_a_velocity_does_not_work);
    return UNITY_END();
}

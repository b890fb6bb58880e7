/*
 * Linked particles: closed form against the generic Gauss engine, motion against p + v t + a t^2 / 2 in long double, and
 * the source's misprints.
 * Tolerances: 1e-12 in double, 300 roundings in float, relative to the forces that meet: the engine's to their norm,
 * weighted by mass, so that a force on the lighter particle counts for more.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/gauss.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

enum { TRIALS = 10000, MASS_1 = 0, MASS_2, SEPARATION, FORCE_1, FORCE_2 = FORCE_1 + 3 };

#define TOLERANCE (MCT_REAL_IS_FLOAT ? 300 * (double)FLT_EPSILON : 1e-12)

void setUp(void)
{
}

void tearDown(void)
{
}

static mct_scene linked_particles(int stepper)
{
    int system = 0;
    while (system < MCT_SYSTEM_COUNT - 1 && strcmp(mct_systems[system]->name, "linked_particles") != 0) {
        system++;
    }
    return scene_of(system, stepper, MCT_FORCES);
}

typedef struct {
    mct_scene scene;
    mct_constants constants;
    mct_real x[MCT_MAX_STATES];
    mct_real input;
    mct_evaluation out;
    mct_gauss_motion motion;
    double size; /* of the forces */
    double norm; /* sqrt(sum f^2 / m) */
} trial;

static void run_trial(trial *self, test_random *random)
{
    static mct_gauss_workspace workspace;
    memset(self, 0, sizeof *self);
    self->scene = linked_particles(MCT_STEPPER_RK4);
    const mct_system *const system = mct_systems[self->scene.system];
    double *p = self->scene.parameters;
    p[MASS_1] = random_scale(random, 1e-3, 1e3);
    p[MASS_2] = random_scale(random, 1e-3, 1e3);
    p[SEPARATION] = random_in(random, -2, 2);
    for (int i = FORCE_1; i < FORCE_2 + 3; i++) {
        p[i] = random_in(random, -10, 10);
    }
    self->x[0] = (mct_real)random_in(random, -5, 5);
    self->x[1] = (mct_real)random_in(random, -5, 5);
    self->input = (mct_real)random_in(random, -10, 10);
    TEST_ASSERT_EQUAL_INT(MCT_OK, system->prepare(&self->scene, 1e-3, &self->constants, NULL));
    system->evaluate(&self->constants, MCT_FORCES, self->x, self->input, &self->out);

    const mct_real mass[2] = {(mct_real)p[MASS_1], (mct_real)p[MASS_2]};
    const mct_gauss_system engine = {2, 1, mass, system->place, &self->constants};
    mct_real force[6];
    for (int i = 0; i < 6; i++) {
        force[i] = (mct_real)p[FORCE_1 + i];
        self->size += fabs(p[FORCE_1 + i]);
    }
    force[0] += self->input;
    self->size += fabs((double)self->input);
    for (int i = 0; i < 6; i++) {
        self->norm += (double)force[i] * (double)force[i] / (double)mass[i / 3];
    }
    self->norm = sqrt(self->norm);
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          mct_gauss_kinematics(&engine, 0, self->x, self->x + 1, &workspace, &self->motion));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_dynamics(&engine, force, NULL, &workspace, &self->motion));
}

static double worst;

static void compare(const char *name, mct_real closed, mct_real engine, double size)
{
    const double error = fabs((double)closed - (double)engine) / size;
    worst = fmax(worst, error);
    if (!(error <= TOLERANCE)) {
        TEST_FAIL_MESSAGE(name);
    }
}

static void test_the_closed_form_is_what_gauss_principle_gives(void)
{
    static trial now;
    test_random random = {77};
    for (int n = 0; n < TRIALS; n++) {
        run_trial(&now, &random);
        const double total = (double)now.out.M[0][0];
        compare("M", now.out.M[0][0], now.motion.M[0][0], total);
        compare("C v", now.out.Cv[0], now.motion.Cv[0], 1);
        compare("tau", now.out.tau[0], now.motion.tau[0], now.size);
        compare("acceleration", now.out.acceleration[0], now.motion.acceleration[0], now.norm / sqrt(total));
        for (int i = 0; i < 2; i++) {
            for (int k = 0; k < 3; k++) {
                compare("position", now.out.position[i][k], now.motion.position[i][k], 10);
                compare("constraint force", now.out.constraint_force[i][k], now.motion.constraint_force[i][k],
                        sqrt((double)now.out.mass[i]) * now.norm + now.size);
            }
        }
        /* dE/dt = M v a is the power of what comes from outside. */
        const double speed = fabs((double)now.x[1]);
        compare("power", (mct_real)(total * (double)now.x[1] * (double)now.out.acceleration[0]),
                (mct_real)energy_rate(&now.out), now.size * speed);
    }
    printf("worst in %d: %.1e\n", TRIALS, worst);
}

/* (98) leaves out f21, (103) has m1 for m2. */
static void test_the_printed_acceleration_and_link_force_are_wrong(void)
{
    static trial now;
    test_random random = {78};
    for (int n = 0; n < 100; n++) {
        run_trial(&now, &random);
        const double *p = now.scene.parameters;
        const double m1 = p[MASS_1], m2 = p[MASS_2], f11 = p[FORCE_1] + (double)now.input, f21 = p[FORCE_2];
        const double a = (double)now.motion.acceleration[0];
        TEST_ASSERT_TRUE(fabs(a - (f11 + f21) / (m1 + m2)) <= TOLERANCE * now.norm / sqrt(m1 + m2));
        TEST_ASSERT_TRUE(fabs(a - f11 / (m1 + m2)) >= 0.5 * fabs(f21) / (m1 + m2));
        /* The link's part of f11 alone, as (103) has it. */
        const double e21 = (double)now.motion.constraint_force[1][0] + m1 * f21 / (m1 + m2);
        TEST_ASSERT_TRUE(fabs(e21 - m2 * f11 / (m1 + m2)) <=
                         2 * TOLERANCE * (sqrt(m2) * now.norm + now.size));
        TEST_ASSERT_TRUE(fabs(e21 - m1 * f11 / (m1 + m2)) >= 0.5 * fabs((m1 - m2) * f11 / (m1 + m2)));
    }
}

/* Three sets; the last has a mass ratio of 1e9. The state is compensated: 5000 steps lose a few roundings, no more. */
static void test_motion_under_held_forces_is_exact(void)
{
    const double sets[3][4] = {{1, 0.5, 0.6, 0}, {3, 0.02, -2, 5}, {1e-3, 1e6, 0.3, -0.1}};
    const int steppers[] = {MCT_STEPPER_SEED, MCT_STEPPER_LEAP, MCT_STEPPER_RK4};
    double largest = 0;
    for (int n = 0; n < 9; n++) {
        const double *set = sets[n % 3];
        mct_scene scene = linked_particles(steppers[n / 3]);
        scene.parameters[MASS_1] = set[0];
        scene.parameters[MASS_2] = set[1];
        scene.parameters[FORCE_1] = set[2];
        scene.parameters[FORCE_2] = set[3];
        scene.initial[0] = 0.25;
        scene.initial[1] = -0.7;
        mct_plant plant;
        start_plant(&plant, &scene);
        const double input = 0.125;
        step_plant(&plant, (mct_real)input, 5000);
        const long double a = ((long double)set[2] + set[3] + input) / ((long double)set[0] + set[1]);
        const long double t = 5000 * (long double)scene.dt;
        const long double v = -0.7L + a * t;
        const long double x = 0.25L - 0.7L * t + a * t * t / 2;
        const double size = fabs((double)(a * t * t)) + 4;
        largest = fmax(largest, fabs((double)(mct_plant_value(&plant, 0) - x)) / size);
        largest = fmax(largest, fabs((double)(mct_plant_value(&plant, 1) - v)) / size);
    }
    printf("motion: %.1f roundings\n", largest / (double)MCT_REAL_EPSILON);
    TEST_ASSERT_TRUE(largest < 8 * (double)MCT_REAL_EPSILON);
}

static void test_without_forces_momentum_stays_to_the_last_bit(void)
{
    mct_scene scene = linked_particles(MCT_STEPPER_RK4);
    scene.parameters[FORCE_1] = 0;
    scene.initial[1] = 0.3;
    mct_plant plant;
    start_plant(&plant, &scene);
    const mct_real before = plant.state.x[1];
    step_plant(&plant, 0, 100000);
    TEST_ASSERT_TRUE(plant.state.x[1] == before);
}

static void test_expo_does_not_suit(void)
{
    mct_plant plant;
    mct_message why = {""};
    const mct_scene scene = linked_particles(MCT_STEPPER_EXPO);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_plant_init(&plant, &scene, &why));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_closed_form_is_what_gauss_principle_gives);
    RUN_TEST(test_the_printed_acceleration_and_link_force_are_wrong);
    RUN_TEST(test_motion_under_held_forces_is_exact);
    RUN_TEST(test_without_forces_momentum_stays_to_the_last_bit);
    RUN_TEST(test_expo_does_not_suit);
    return UNITY_END();
}

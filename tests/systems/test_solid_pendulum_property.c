/*
 * The solid pendulum: its closed form against the generic Gauss engine, which gets nothing but x = h(q), the masses of
 * the four points and what acts from outside; its power balance; the source's example; what it refuses.
 *
 * Tolerances: 1e-12 in double, 300 roundings in float, relative to the size of the terms that meet in a result.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/gauss.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

enum { TRIALS = TEST_CASES(10000), PARTICLES = 4 };

#define TOLERANCE (MCT_REAL_IS_FLOAT ? 300 * (double)FLT_EPSILON : 1e-12)

static int system_number;

void setUp(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, "solid_pendulum") == 0) {
            system_number = i;
        }
    }
}

void tearDown(void)
{
}

typedef struct {
    mct_scene scene;
    uint32_t effects;
    mct_constants constants;
    mct_real x[MCT_MAX_STATES];
    mct_real input;
    mct_evaluation out;
    mct_gauss_workspace workspace;
    mct_gauss_motion motion;
    double weight; /* of a particle */
    double couple;
} trial;

static void prepare_and_evaluate(trial *self)
{
    const mct_system *const system = mct_systems[system_number];
    TEST_ASSERT_EQUAL_INT(MCT_OK, system->prepare(&self->scene, 1e-3, &self->constants, NULL));
    system->evaluate(&self->constants, self->effects, self->x, self->input, &self->out);
}

static void randomise(trial *self, test_random *random, uint32_t effects)
{
    memset(self, 0, sizeof *self);
    self->effects = effects;
    self->scene = scene_of(system_number, MCT_STEPPER_RK4, effects);
    const double length = random_scale(random, 0.03, 3);
    *parameter_of(&self->scene, "size_1") = length;
    *parameter_of(&self->scene, "size_2") = random_scale(random, 0.01, 3);
    *parameter_of(&self->scene, "size_3") = random_scale(random, 0.01, 3);
    *parameter_of(&self->scene, "density") = random_scale(random, 10, 10000);
    *parameter_of(&self->scene, "pivot_offset") = random_in(random, 0, length);
    *parameter_of(&self->scene, "gravity") = random_in(random, 0, 20);
    *parameter_of(&self->scene, "friction") = random_scale(random, 1e-3, 10);
    *parameter_of(&self->scene, "coulomb") = random_scale(random, 1e-3, 10);
    self->x[0] = (mct_real)random_in(random, -7, 7);
    self->x[1] = (mct_real)random_in(random, -8, 8);
    self->input = (mct_real)random_in(random, -10, 10);
    prepare_and_evaluate(self);
}

/* The engine, with forces from the scene's parameters. */
static void run_engine(trial *self)
{
    const double mass = *parameter_of(&self->scene, "density") * *parameter_of(&self->scene, "size_1") *
                        *parameter_of(&self->scene, "size_2") * *parameter_of(&self->scene, "size_3");
    const double gravity = (self->effects & MCT_GRAVITY) ? *parameter_of(&self->scene, "gravity") : 0;
    const double friction = (self->effects & MCT_VISCOUS) ? *parameter_of(&self->scene, "friction") : 0;
    const double dry = (self->effects & MCT_COULOMB_MOREAU) ? *parameter_of(&self->scene, "coulomb") : 0;
    const double rate = (double)self->x[1];
    mct_real masses[PARTICLES];
    mct_real force[3 * PARTICLES] = {0};
    self->weight = 0.25 * mass * gravity;
    self->couple = (double)self->input - friction * rate - (rate > 0 ? dry : rate < 0 ? -dry : 0);
    for (int i = 0; i < PARTICLES; i++) {
        masses[i] = (mct_real)(0.25 * mass);
        force[3 * i + 1] = (mct_real)-self->weight;
    }
    const mct_real couple = (mct_real)self->couple;
    const mct_gauss_system engine = {PARTICLES, 1, masses, mct_systems[system_number]->place,
                                     &self->constants};
    TEST_ASSERT_EQUAL_INT(
        MCT_OK, mct_gauss_kinematics(&engine, 0, self->x, self->x + 1, &self->workspace, &self->motion));
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          mct_gauss_dynamics(&engine, force, &couple, &self->workspace, &self->motion));
}

enum { MASS, CV, TAU, ACCELERATION, CONSTRAINT, POSITION, ENERGY, POWER, QUANTITIES };
static const char *const quantity_names[] = {"M",        "Cv",     "tau",  "acceleration", "constraint force",
                                             "position", "energy", "power"};
static double worst[QUANTITIES];

static void compare(int quantity, mct_real closed, double engine, double size)
{
    const double error = fabs((double)closed - engine) / (size > 0 ? size : 1);
    worst[quantity] = fmax(worst[quantity], error);
    if (!(error <= TOLERANCE)) {
        char text[160];
        snprintf(text, sizeof text, "%s: closed form %.17g, engine %.17g, terms of size %.3g",
                 quantity_names[quantity], (double)closed, engine, size);
        TEST_FAIL_MESSAGE(text);
    }
}

/* Farthest that a particle is from the axle. */
static double reach(trial *self)
{
    return *parameter_of(&self->scene, "size_1") + *parameter_of(&self->scene, "size_2");
}

static double torque_size(trial *self)
{
    return fabs((double)self->input) + fabs(self->couple) + PARTICLES * self->weight * reach(self);
}

static void for_all_trials(void (*check)(trial *))
{
    test_random random = {1729};
    memset(worst, 0, sizeof worst);
    for (int n = 0; n < TRIALS; n++) {
        static trial now;
        const uint32_t effects =
            ((n & 1) ? MCT_GRAVITY : 0) | ((n & 2) ? MCT_VISCOUS : 0) | ((n & 4) ? MCT_COULOMB_MOREAU : 0);
        randomise(&now, &random, effects);
        run_engine(&now);
        check(&now);
    }
    printf("worst in %d:", TRIALS);
    for (int i = 0; i < QUANTITIES; i++) {
        if (worst[i] > 0) {
            printf(" %s %.1e", quantity_names[i], worst[i]);
        }
    }
    printf("\n");
}

static void check_closed_form(trial *self)
{
    const mct_evaluation *const out = &self->out;
    const mct_gauss_motion *const motion = &self->motion;
    const double M = (double)motion->M[0][0];
    const double torque = torque_size(self);
    const double rate = (double)self->x[1];
    compare(MASS, out->M[0][0], M, M);
    compare(CV, out->Cv[0], (double)motion->Cv[0], M * rate * rate);
    compare(TAU, out->tau[0], (double)motion->tau[0], torque);
    /* In the engine's least squares the centrifugal terms, of size w^2, meet the others before they cancel. */
    compare(ACCELERATION, out->acceleration[0], (double)motion->acceleration[0], torque / M + rate * rate);
    double kinetic = 0;
    double potential = 0;
    for (int i = 0; i < PARTICLES; i++) {
        const double mass = (double)out->mass[i];
        const double force = self->weight + mass * reach(self) * (torque / M + rate * rate);
        for (int axis = 0; axis < 3; axis++) {
            compare(POSITION, out->position[i][axis], (double)motion->position[i][axis], reach(self));
            compare(CONSTRAINT, out->constraint_force[i][axis], (double)motion->constraint_force[i][axis],
                    force);
            kinetic += 0.5 * mass * pow((double)motion->velocity[i][axis], 2);
        }
        potential += self->weight * (double)motion->position[i][1];
    }
    compare(ENERGY, out->kinetic_energy, kinetic, M * rate * rate);
    compare(ENERGY, out->potential_energy, potential, PARTICLES * self->weight * reach(self));
}

static void test_the_closed_form_is_what_gauss_principle_gives(void)
{
    for_all_trials(check_closed_form);
}

/* dE/dt = sum of m xd . xdd + m g yd, of the engine's motion. */
static void check_powers(trial *self)
{
    double change = 0;
    double size = fabs((double)self->x[1]) * torque_size(self);
    for (int i = 0; i < PARTICLES; i++) {
        const double mass = (double)self->out.mass[i];
        change += self->weight * (double)self->motion.velocity[i][1];
        for (int axis = 0; axis < 3; axis++) {
            const double v = (double)self->motion.velocity[i][axis];
            const double a = (double)self->motion.particle_acceleration[i][axis];
            change += mass * v * a;
            size += mass * fabs(v * a);
        }
    }
    compare(POWER, energy_rate(&self->out), change, size);
}

static void test_energy_changes_by_input_and_friction_and_nothing_else(void)
{
    for_all_trials(check_powers);
}

/* ---- the source's example ---- */

static void start_example(trial *self, double angle)
{
    memset(self, 0, sizeof *self);
    self->effects = MCT_GRAVITY;
    self->scene = scene_of(system_number, MCT_STEPPER_RK4, MCT_GRAVITY);
    self->x[0] = (mct_real)angle;
    prepare_and_evaluate(self);
    run_engine(self);
}

/* Second moment of the box about the axle, by the midpoint rule on its own 400 x 40 grid: exact to 2e-6. */
static double inertia_by_summation(void)
{
    double sum = 0;
    for (int i = 0; i < 400; i++) {
        for (int j = 0; j < 40; j++) {
            const double x = (i + 0.5) / 400 - 0.01;
            const double y = 0.04 * ((j + 0.5) / 40 - 0.5);
            sum += x * x + y * y;
        }
    }
    return 4.224 * sum / (400 * 40);
}

static void test_the_sources_example_needs_20_30_newton_metres_and_not_the_20_32_printed(void)
{
    trial now;
    start_example(&now, 0);
    TEST_ASSERT_DOUBLE_WITHIN(5e-5, -20.3043, (double)now.out.tau[0]);
    TEST_ASSERT_DOUBLE_WITHIN(5e-5, -20.3043, (double)now.motion.tau[0]);
    TEST_ASSERT_TRUE(fabs((double)now.out.tau[0] + 20.32) > 0.01);
    TEST_ASSERT_TRUE(fabs((double)now.motion.tau[0] - 20.32) > 40); /* the sign of (360) */
}

static void test_the_sources_example_has_an_inertia_of_1_3667_and_not_the_1_3706_printed(void)
{
    trial now;
    start_example(&now, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 1.3667456, (double)now.out.M[0][0]);
    TEST_ASSERT_DOUBLE_WITHIN(4e-6, inertia_by_summation(), (double)now.out.M[0][0]);
    TEST_ASSERT_TRUE(fabs(inertia_by_summation() - 1.3706) > 3e-3);
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, -14.856, (double)now.out.acceleration[0]);
    TEST_ASSERT_TRUE(fabs((double)now.motion.acceleration[0] + 14.826) > 0.02);
}

static void test_positive_angles_are_counterclockwise(void)
{
    trial now;
    start_example(&now, 0.5);
    for (int i = 0; i < PARTICLES; i++) {
        TEST_ASSERT_TRUE(i < 2 || (now.out.position[i][0] > 0 && now.out.position[i][1] > 0));
    }
    TEST_ASSERT_TRUE(now.out.potential_energy > 0);
}

/* Level, the bar is held by dry friction of 20.31 N m, and breaks away from 20.30. */
static void test_dry_friction_holds_the_bar_level_from_20_3043_newton_metres_on(void)
{
    static const double sizes[] = {20.31, 20.30};
    for (int i = 0; i < 2; i++) {
        mct_scene scene = scene_of(system_number, MCT_STEPPER_RK4, MCT_GRAVITY | MCT_COULOMB_MOREAU);
        *parameter_of(&scene, "coulomb") = sizes[i];
        mct_plant plant;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, 100000);
        if (i == 0) {
            TEST_ASSERT_TRUE(plant.state.x[0] == 0 && plant.state.x[1] == 0 && plant.state.c[0] == 0);
        } else {
            TEST_ASSERT_TRUE(mct_plant_value(&plant, 0) < -1e-3);
        }
    }
}

static void test_an_axle_beyond_the_box_is_refused_with_a_sentence(void)
{
    mct_scene scene = scene_of(system_number, MCT_STEPPER_RK4, MCT_GRAVITY);
    mct_plant plant;
    mct_message why = {""};
    *parameter_of(&scene, "pivot_offset") = 1.5;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_plant_init(&plant, &scene, &why));
    TEST_ASSERT_EQUAL_STRING("parameters.pivot_offset: found 1.5 m; allowed 0 to size_1, which is 1 m",
                             why.text);
    *parameter_of(&scene, "pivot_offset") = 1;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_plant_init(&plant, &scene, &why));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_closed_form_is_what_gauss_principle_gives);
    RUN_TEST(test_energy_changes_by_input_and_friction_and_nothing_else);
    RUN_TEST(test_the_sources_example_needs_20_30_newton_metres_and_not_the_20_32_printed);
    RUN_TEST(test_the_sources_example_has_an_inertia_of_1_3667_and_not_the_1_3706_printed);
    RUN_TEST(test_positive_angles_are_counterclockwise);
    RUN_TEST(test_dry_friction_holds_the_bar_level_from_20_3043_newton_metres_on);
    RUN_TEST(test_an_axle_beyond_the_box_is_refused_with_a_sentence);
    return UNITY_END();
}

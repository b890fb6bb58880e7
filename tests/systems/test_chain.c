/*
 * The chain as a system: its scenes, its evaluation, and its updates through a plant. The updates themselves:
 * test_chain_kinematics.c.
 * Tolerance: 1e-12 in double, 2000 roundings in float, relative to the terms of a sum: 16 links, whose directions come
 * from products of up to 16 rotations here and from a sum of angles in place().
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mctau/compensated.h"
#include "mctau/judge.h"
#include "support/random.h"
#include "support/scenes.h"
#include "systems/chain_kinematics.h"
#include "unity.h"

#define PI        3.14159265358979323846
#define TOLERANCE (MCT_REAL_IS_FLOAT ? 2000 * (double)FLT_EPSILON : 1e-12)

enum { MOST = MCT_CHAIN_MAX_LINKS, METHODS = 3 };

static int chain;

void setUp(void)
{
    chain = 0;
    while (chain < MCT_SYSTEM_COUNT - 1 && strcmp(mct_systems[chain]->name, "chain") != 0) {
        chain++;
    }
}

void tearDown(void)
{
}

static mct_scene chain_scene(int links, double length)
{
    mct_scene scene = scene_of(chain, MCT_STEPPER_DISCRETE, 0);
    scene.lists[0].count = links;
    for (int i = 0; i < links; i++) {
        scene.lists[0].values[i] = length;
    }
    return scene;
}

static mct_status read_text(const char *text, mct_scene *scene, mct_message *why)
{
    char whole[1024];
    const int length = snprintf(whole, sizeof whole, "[scene]\nsystem = \"chain\"\n%s", text);
    return mct_scene_read(whole, (size_t)length, "text", NULL, 0, scene, why);
}

/* --- scenes --- */

static void test_a_chain_of_1_to_16_links_is_read_with_as_many_angles_and_particles(void)
{
    char list[256];
    size_t used = (size_t)snprintf(list, sizeof list, "[parameters]\nlink_lengths = [0.25");
    for (int n = 1; n <= MOST; n++) {
        char text[300];
        mct_scene scene;
        mct_message why;
        snprintf(text, sizeof text, "%s]\n[initial]\nangle_%d = 0.5\n", list, n);
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, read_text(text, &scene, &why), why.text);
        TEST_ASSERT_EQUAL_INT(n, mct_coordinate_count(&scene));
        TEST_ASSERT_EQUAL_INT(n, mct_particle_count(&scene));
        TEST_ASSERT_EQUAL_INT(n, mct_state_count(&scene));
        TEST_ASSERT_EQUAL_INT(MCT_STEPPER_DISCRETE, scene.stepper); /* the one that suits */
        TEST_ASSERT_TRUE(scene.lists[0].values[n - 1] == 0.25 * n);
        TEST_ASSERT_TRUE(scene.initial[n - 1] == 0.5);
        mct_plant plant;
        mct_evaluation now;
        start_plant(&plant, &scene);
        mct_plant_evaluate(&plant, &now);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.25 * n * cos(0.5),
                                  (double)(now.position[0][0] - (n > 1 ? now.position[n - 1][0] : 0)));
        used += (size_t)snprintf(list + used, sizeof list - used, ", %g", 0.25 * (n + 1));
    }
}

/* The text is refused, and the sentence holds both parts. */
static void check_refusal(const char *text, const char *found, const char *allowed)
{
    mct_scene scene;
    mct_message why = {""};
    mct_plant plant;
    mct_status status = read_text(text, &scene, &why);
    if (status == MCT_OK) {
        status = mct_plant_init(&plant, &scene, &why);
    }
    TEST_ASSERT_TRUE_MESSAGE(status != MCT_OK, text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, found), why.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, allowed), why.text);
}

static void test_what_is_no_chain_is_refused_with_what_was_found_and_what_is_allowed(void)
{
    check_refusal("[parameters]\nlink_lengths = [1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1]\n", "found 17 numbers",
                  "allowed 1 to 16 numbers");
    check_refusal("[parameters]\nlink_lengths = []\n", "found 0 numbers", "allowed 1 to 16 numbers");
    check_refusal("[parameters]\nlink_lengths = [1, 0]\n", "found 0 m as number 2",
                  "allowed 0.0001 to 10000 m");
    check_refusal("[parameters]\nlink_lengths = [-1, 1]\n", "found -1 m as number 1", "allowed 0.0001 to");
    check_refusal("[parameters]\nmethod = \"newton\"\n", "newton", "transpose, inverse, ridge");
    check_refusal("[parameters]\nlargest_step = 0\n", "found 0 rad", "allowed 1e-06 to");
    check_refusal("[initial]\nangle_17 = 1\n", "initial.angle_17", "angle_1");
    check_refusal("[initial]\nangle_4 = 1\n", "initial.angle_4", "found a state that the scene has not");
    check_refusal("stepper = \"rk4\"\n", "found rk4", "allowed discrete");
}

/* 2 / (2^2 + 1^2) of two links of 1 m. */
static void test_a_gain_of_transpose_that_would_diverge_is_refused(void)
{
    const char *const above = "[parameters]\nlink_lengths = [1, 1]\nmethod = \"transpose\"\ngain = 0.401\n";
    check_refusal(above, "parameters.gain: found 0.401 1/m^2", "allowed up to 0.4");
    mct_scene scene = chain_scene(2, 1);
    *parameter_of(&scene, "method") = MCT_CHAIN_TRANSPOSE;
    *parameter_of(&scene, "gain") = 0.399;
    mct_plant plant;
    start_plant(&plant, &scene);
    *parameter_of(&scene, "method") = MCT_CHAIN_RIDGE; /* which has none */
    *parameter_of(&scene, "gain") = 9;
    start_plant(&plant, &scene);
}

static void test_a_choice_of_method_is_the_method(void)
{
    static const char *const names[METHODS] = {"transpose", "inverse", "ridge"};
    for (int method = 0; method < METHODS; method++) {
        char text[64];
        mct_scene scene;
        mct_message why;
        mct_plant plant;
        snprintf(text, sizeof text, "[parameters]\nmethod = \"%s\"\n", names[method]);
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, read_text(text, &scene, &why), why.text);
        start_plant(&plant, &scene);
        TEST_ASSERT_EQUAL_INT(method, plant.constants.chain.method);
    }
}

static void test_the_scene_in_the_repository_brings_its_tip_home(void)
{
    char path[512];
    static char text[4096];
    const char *const source = getenv("MCTAU_SOURCE");
    snprintf(path, sizeof path, "%s/scenes/chain.toml", source != NULL ? source : ".");
    FILE *const file = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    const size_t length = fread(text, 1, sizeof text, file);
    fclose(file);
    mct_scene scene;
    mct_message why;
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_scene_read(text, length, path, NULL, 0, &scene, &why),
                                  why.text);
    mct_plant plant;
    start_plant(&plant, &scene);
    TEST_ASSERT_TRUE(energy_of(&plant) > 0.1);
    step_plant(&plant, 0, lround(scene.duration / scene.dt));
    const double left = sqrt(2 * energy_of(&plant));
    printf("the tip is %.1e m from the target\n", left);
    TEST_ASSERT_TRUE(left <= 10 * (double)MCT_REAL_EPSILON * (double)plant.constants.chain.reach);
}

/* --- evaluation --- */

typedef struct {
    mct_scene scene;
    mct_plant plant;
    mct_evaluation out;
    double J[2][MOST];
    int n;
} trial;

/* The derivative of the tip by angle `index`, from place(); and that of half the squared error. */
static void differentiate(trial *self, int index)
{
    mct_hyperdual q[MOST];
    mct_hyperdual position[MOST][3];
    for (int i = 0; i < self->n; i++) {
        q[i] = mct_hyperdual_constant(self->plant.state.x[i]);
    }
    q[index].e1 = 1;
    mct_systems[chain]->place(&self->plant.constants, mct_hyperdual_constant(0), q, position);
    for (int axis = 0; axis < 2; axis++) {
        self->J[axis][index] = (double)position[0][axis].e1;
    }
    for (int i = 0; i < self->n; i++) {
        for (int axis = 0; axis < 3; axis++) {
            TEST_ASSERT_DOUBLE_WITHIN(TOLERANCE * (double)self->plant.constants.chain.reach,
                                      (double)position[i][axis].value, (double)self->out.position[i][axis]);
        }
    }
}

static void run_trial(trial *self, test_random *random, int method)
{
    self->n = 1 + (int)(random_bits(random) >> 40) % MOST;
    self->scene = chain_scene(self->n, 1);
    double reach = 0;
    for (int i = 0; i < self->n; i++) {
        self->scene.lists[0].values[i] = random_in(random, 0.2, 2);
        reach += self->scene.lists[0].values[i];
        self->scene.initial[i] = random_in(random, -10, 10);
    }
    *parameter_of(&self->scene, "target_1") = random_in(random, -1, 1) * reach;
    *parameter_of(&self->scene, "target_2") = random_in(random, -1, 1) * reach;
    *parameter_of(&self->scene, "method") = method;
    *parameter_of(&self->scene, "largest_step") = 1000;
    if (random_bits(random) >> 63) {
        *parameter_of(&self->scene, "ridge") = random_scale(random, 1e-3, 1);
        *parameter_of(&self->scene, "gain") = random_in(random, 0.1, 1) * 2 / (self->n * reach * reach);
    }
    start_plant(&self->plant, &self->scene);
    mct_plant_evaluate(&self->plant, &self->out);
    for (int i = 0; i < self->n; i++) {
        differentiate(self, i);
    }
}

static double worst;

static void check_sum(double found, double wanted, double terms)
{
    const double error = fabs(found - wanted) / terms;
    worst = fmax(worst, error);
    TEST_ASSERT_TRUE(error <= TOLERANCE);
}

/*
 * M a = J'e, where the gradient of |J a - e|^2 + alpha |a|^2 is 0 (inverse: alpha 0); J from place(), e from the force on
 * the tip.
 */
static void test_an_update_is_gauss_principle_for_a_unit_mass_at_the_tip(void)
{
    static trial now;
    test_random random = {2024};
    for (int trials = 0; trials < TEST_CASES(9999); trials++) {
        const int method = trials % METHODS;
        run_trial(&now, &random, method);
        const mct_evaluation *const out = &now.out;
        const double *const e = (const double[2]){(double)out->force[0][0], (double)out->force[0][1]};
        const double size = hypot(e[0], e[1]);
        const mct_chain_constants *const k = &now.plant.constants.chain;
        const double left =
            hypot((double)(k->target[0] - out->position[0][0]), (double)(k->target[1] - out->position[0][1]));
        check_sum((double)out->potential_energy, left * left / 2, left * left);
        double moved[2] = {0, 0};
        double moved_terms = size;
        for (int i = 0; i < now.n; i++) {
            const double a = (double)out->acceleration[i];
            moved[0] += now.J[0][i] * a;
            moved[1] += now.J[1][i] * a;
            moved_terms += hypot(now.J[0][i], now.J[1][i]) * fabs(a);
        }
        for (int axis = 0; axis < 2; axis++) {
            check_sum((double)out->constraint_force[0][axis], moved[axis] - e[axis], moved_terms);
        }
        const double reach = (double)now.plant.constants.chain.reach;
        for (int i = 0; i < now.n; i++) {
            double force = 0;
            double terms = reach * size;
            for (int j = 0; j < now.n; j++) {
                const double product = now.J[0][i] * now.J[0][j] + now.J[1][i] * now.J[1][j];
                const double a = (double)out->acceleration[j];
                force += (double)out->M[i][j] * a;
                terms += fabs((double)out->M[i][j] * a);
                TEST_ASSERT_TRUE(out->M[i][j] == out->M[j][i]);
                if (method != MCT_CHAIN_TRANSPOSE && i != j) {
                    check_sum((double)out->M[i][j], product, reach * reach);
                }
            }
            check_sum(force, (double)out->tau[i], terms);
            check_sum((double)out->tau[i], now.J[0][i] * e[0] + now.J[1][i] * e[1], reach * size);
        }
    }
    printf("worst: %.1e of the terms\n", worst);
}

/* By central differences of the energy, whose error is h^2 / 6 of a third derivative of some 4 reach^2. */
static void test_the_energy_of_a_target_within_reach_falls_along_the_torques(void)
{
    static trial now;
    test_random random = {7};
    const double h = MCT_REAL_IS_FLOAT ? 1e-2 : 1e-5;
    for (int trials = 0; trials < 300; trials++) {
        run_trial(&now, &random, trials % METHODS);
        const mct_chain_constants *const k = &now.plant.constants.chain;
        const double reach = (double)k->reach;
        const bool in_reach = k->aim[0] == k->target[0] && k->aim[1] == k->target[1];
        for (int i = 0; in_reach && i < now.n; i++) {
            double energy[2];
            for (int side = 0; side < 2; side++) {
                mct_plant beside = now.plant;
                beside.state.x[i] += (mct_real)(side == 0 ? -h : h);
                energy[side] = energy_of(&beside);
            }
            const double slope = (energy[1] - energy[0]) / (2 * h);
            TEST_ASSERT_DOUBLE_WITHIN(reach * reach * (h * h + 20 * (double)MCT_REAL_EPSILON / h),
                                      (double)now.out.tau[i], -slope);
        }
    }
}

static void test_out_of_reach_the_energy_tells_how_far_the_target_stays(void)
{
    mct_scene scene = chain_scene(3, 0.5);
    *parameter_of(&scene, "target_1") = 1.2;
    *parameter_of(&scene, "target_2") = 1.6; /* 2 away; the reach is 1.5 */
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 100);
    TEST_ASSERT_DOUBLE_WITHIN(20 * (double)MCT_REAL_EPSILON, 0.5, sqrt(2 * energy_of(&plant)));
}

static void test_at_the_target_and_in_line_with_it_all_of_it_is_finite(void)
{
    for (int method = 0; method < METHODS; method++) {
        for (int place = 0; place < 3; place++) { /* at the target; in line with it; at the base */
            mct_scene scene = chain_scene(4, 0.5);
            *parameter_of(&scene, "method") = method;
            *parameter_of(&scene, "target_1") = 2 - place;
            *parameter_of(&scene, "target_2") = 0;
            mct_plant plant;
            mct_evaluation now;
            start_plant(&plant, &scene);
            mct_plant_evaluate(&plant, &now);
            for (int i = 0; i < 4; i++) {
                for (int j = 0; j < 4; j++) {
                    TEST_ASSERT_TRUE(mct_finite(now.M[i][j]));
                }
                TEST_ASSERT_TRUE(now.tau[i] == 0);
                TEST_ASSERT_TRUE(now.acceleration[i] == (place == 0 ? 0 : MCT_CHAIN_BEND));
            }
        }
    }
}

static void test_the_gauss_engine_does_not_judge_a_process(void)
{
    static mct_judgement judgement;
    const mct_scene scene = chain_scene(3, 1);
    mct_plant plant;
    mct_evaluation now;
    start_plant(&plant, &scene);
    mct_plant_evaluate(&plant, &now);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED,
                          mct_judge(plant.system, &plant.constants, 3, plant.state.x, &now, &judgement));
}

/* --- updates --- */

static void test_a_step_of_the_plant_is_an_update_to_the_bit(void)
{
    test_random random = {11};
    for (int trials = 0; trials < 300; trials++) {
        const int n = 1 + trials % MOST;
        mct_scene scene = chain_scene(n, random_in(&random, 0.2, 2));
        *parameter_of(&scene, "method") = trials % METHODS;
        *parameter_of(&scene, "largest_step") = 0.02; /* 100 of these stay within a turn */
        *parameter_of(&scene, "target_1") = random_in(&random, -n, n);
        *parameter_of(&scene, "target_2") = random_in(&random, -n, n);
        scene.substeps = 1 + trials % 4;
        mct_real x[MOST], c[MOST];
        for (int i = 0; i < n; i++) {
            scene.initial[i] = random_in(&random, -PI, PI);
            x[i] = (mct_real)scene.initial[i];
            c[i] = (mct_real)(scene.initial[i] - (double)x[i]);
        }
        mct_plant plant;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, 100 / scene.substeps);
        for (int count = 0; count < 100 / scene.substeps * scene.substeps; count++) {
            mct_real step[MOST];
            mct_chain_update(&plant.constants.chain, x, step);
            for (int i = 0; i < n; i++) {
                mct_add_compensated(&x[i], &c[i], step[i]);
            }
        }
        for (int i = 0; i < n; i++) {
            TEST_ASSERT_TRUE(plant.state.x[i] == x[i] && plant.state.c[i] == c[i]);
        }
        TEST_ASSERT_EQUAL_INT(0, (int)plant.diverged_ticks);
    }
}

/* No angle jumps by more than a step: its turns are counted. The pull is the same as without them. */
static void test_a_chain_that_is_wound_up_comes_home_with_its_turns(void)
{
    mct_scene scene = chain_scene(5, 0.3);
    *parameter_of(&scene, "target_1") = -0.7;
    *parameter_of(&scene, "target_2") = 0.4;
    mct_scene wound = scene;
    for (int i = 0; i < 5; i++) {
        scene.initial[i] = 0.4 + 0.1 * i;
        wound.initial[i] = scene.initial[i] + 2 * PI * (1000 * i - 2000);
    }
    scene.initial[0] = wound.initial[0] = 6.2; /* and goes on counterclockwise, over the turn */
    mct_plant plain, turned;
    start_plant(&plain, &scene);
    start_plant(&turned, &wound);
    const double largest = *parameter_of(&scene, "largest_step");
    bool passed = false;
    for (int count = 0; count < 60; count++) {
        double before[5];
        for (int i = 0; i < 5; i++) {
            before[i] = mct_plant_value(&turned, i);
        }
        step_plant(&plain, 0, 1);
        step_plant(&turned, 0, 1);
        for (int i = 0; i < 5; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(largest + 1e-9, before[i], mct_plant_value(&turned, i));
        }
        passed = passed || plain.state.turns[0] != 0;
    }
    TEST_ASSERT_TRUE(passed);
    TEST_ASSERT_TRUE(energy_of(&plain) < 1e-12);
    TEST_ASSERT_TRUE(energy_of(&turned) < 1e-12);
    for (int i = 0; i < 5; i++) {
        /* 2000 turns leave 1e-12 of an angle in double; the updates do not spread a difference */
        const double turns = i == 0 ? 0 : 1000 * i - 2000;
        TEST_ASSERT_DOUBLE_WITHIN(MCT_REAL_IS_FLOAT ? 1e-4 : 1e-10,
                                  mct_plant_value(&plain, i) + 2 * PI * turns, mct_plant_value(&turned, i));
    }
}

/* Transpose may creep. An update of some 0.02 roundings is kept; the chain hardly moves, so all are alike. */
static void test_updates_below_a_rounding_of_an_angle_are_not_lost(void)
{
    mct_scene scene = chain_scene(2, 1);
    *parameter_of(&scene, "method") = MCT_CHAIN_TRANSPOSE;
    *parameter_of(&scene, "gain") = 0.01 * (double)MCT_REAL_EPSILON;
    *parameter_of(&scene, "target_1") = 0;
    *parameter_of(&scene, "target_2") = 1;
    scene.initial[0] = 3;
    mct_plant plant;
    mct_evaluation now;
    start_plant(&plant, &scene);
    mct_plant_evaluate(&plant, &now);
    step_plant(&plant, 0, 1000);
    const double wanted = 1000 * (double)now.acceleration[0];
    const double moved = (double)(plant.state.x[0] - 3) + (double)plant.state.c[0];
    TEST_ASSERT_DOUBLE_WITHIN(1e-4 * fabs(wanted), wanted, moved);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_chain_of_1_to_16_links_is_read_with_as_many_angles_and_particles);
    RUN_TEST(test_what_is_no_chain_is_refused_with_what_was_found_and_what_is_allowed);
    RUN_TEST(test_a_gain_of_transpose_that_would_diverge_is_refused);
    RUN_TEST(test_a_choice_of_method_is_the_method);
    RUN_TEST(test_the_scene_in_the_repository_brings_its_tip_home);
    RUN_TEST(test_an_update_is_gauss_principle_for_a_unit_mass_at_the_tip);
    RUN_TEST(test_the_energy_of_a_target_within_reach_falls_along_the_torques);
    RUN_TEST(test_out_of_reach_the_energy_tells_how_far_the_target_stays);
    RUN_TEST(test_at_the_target_and_in_line_with_it_all_of_it_is_finite);
    RUN_TEST(test_the_gauss_engine_does_not_judge_a_process);
    RUN_TEST(test_a_step_of_the_plant_is_an_update_to_the_bit);
    RUN_TEST(test_a_chain_that_is_wound_up_comes_home_with_its_turns);
    RUN_TEST(test_updates_below_a_rounding_of_an_angle_are_not_lost);
    return UNITY_END();
}

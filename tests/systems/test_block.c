/*
 * The block: its closed form against the Gauss engine, its power balance, and dry friction at rest, in both
 * precisions.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/gauss.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

/* Some tens of roundings of the terms that meet; float's parameters are rounded once more. */
#define TOLERANCE (MCT_REAL_IS_FLOAT ? 100 * (double)FLT_EPSILON : 1e-12)

void setUp(void)
{
}

void tearDown(void)
{
}

static int block(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, "block") == 0) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE("no block");
    return 0;
}

static mct_scene scene_with(int stepper, uint32_t effects)
{
    return scene_of(block(), stepper, effects);
}

enum { TRIALS = 10000, PHASE = 2, TIME = 3 };

static const uint32_t switches[4] = {MCT_GRAVITY, MCT_COULOMB_MOREAU, MCT_SPRING, MCT_FORCING};

typedef struct {
    mct_scene scene;
    mct_constants constants;
    uint32_t effects;
    mct_real x[MCT_MAX_STATES];
    mct_real input;
    mct_evaluation out;
} trial;

static void randomise(trial *self, test_random *random, int k)
{
    memset(self, 0, sizeof *self);
    for (int i = 0; i < 4; i++) {
        self->effects |= (k >> i) & 1 ? switches[i] : 0;
    }
    self->scene = scene_with(MCT_STEPPER_EXPO, self->effects);
    *parameter_of(&self->scene, "mass") = random_scale(random, 0.01, 100);
    *parameter_of(&self->scene, "dynamic_coefficient") = random_in(random, 0, 1);
    *parameter_of(&self->scene, "static_coefficient") = random_in(random, 1, 2);
    *parameter_of(&self->scene, "slope") = random_in(random, -1.5, 1.5);
    *parameter_of(&self->scene, "force") = random_in(random, -5, 5);
    *parameter_of(&self->scene, "force_ramp") = random_in(random, -5, 5);
    *parameter_of(&self->scene, "force_amplitude") = random_in(random, -5, 5);
    *parameter_of(&self->scene, "force_frequency") = random_scale(random, 0.1, 100);
    *parameter_of(&self->scene, "spring") = random_scale(random, 1, 1000);
    *parameter_of(&self->scene, "belt_speed") = (k >> 4) & 1 ? random_in(random, -1, 1) : 0;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_systems[block()]->prepare(&self->scene, 1e-3, &self->constants, NULL));
    self->x[0] = (mct_real)random_in(random, -2, 2);
    self->x[1] = (mct_real)random_in(random, -5, 5);
    if ((k >> 5) % 3 == 0) { /* at rest on the belt */
        self->x[1] = (mct_real)*parameter_of(&self->scene, "belt_speed");
    }
    self->x[PHASE] = (mct_real)random_in(random, -6, 6);
    self->x[TIME] = (mct_real)random_in(random, 0, 10);
    self->input = (mct_real)random_in(random, -10, 10);
    mct_systems[block()]->evaluate(&self->constants, self->effects, self->x, self->input, &self->out);
}

/*
 * Forces along the slope, from the scene's parameters: all but friction, friction, and the size of all terms.
 */
static void forces_of(trial *self, double *others, double *dry, double *size)
{
    const double g = (self->effects & MCT_GRAVITY) ? *parameter_of(&self->scene, "gravity") : 0;
    const double m = *parameter_of(&self->scene, "mass");
    const double slope = *parameter_of(&self->scene, "slope");
    const double normal = (self->effects & MCT_COULOMB_MOREAU) ? m * g * cos(slope) : 0;
    const double hold = *parameter_of(&self->scene, "static_coefficient") * normal;
    const double slide = *parameter_of(&self->scene, "dynamic_coefficient") * normal;
    const double relative = (double)self->x[1] - (double)(mct_real)*parameter_of(&self->scene, "belt_speed");
    const double terms[] = {
        (double)self->input,
        -m * g * sin(slope),
        (self->effects & MCT_SPRING) ? -*parameter_of(&self->scene, "spring") * (double)self->x[0] : 0,
        (self->effects & MCT_FORCING) ? *parameter_of(&self->scene, "force") : 0,
        (self->effects & MCT_FORCING) ? *parameter_of(&self->scene, "force_ramp") * (double)self->x[TIME] : 0,
        (self->effects & MCT_FORCING)
            ? *parameter_of(&self->scene, "force_amplitude") * sin((double)self->x[PHASE])
            : 0,
    };
    *others = 0;
    *size = hold;
    for (size_t i = 0; i < sizeof terms / sizeof terms[0]; i++) {
        *others += terms[i];
        *size += fabs(terms[i]);
    }
    const double against = relative > 0 || (relative == 0 && *others > hold)    ? -slide
                           : relative < 0 || (relative == 0 && *others < -hold) ? slide
                                                                                : -*others;
    *dry = against;
}

static void test_the_closed_form_is_what_gauss_principle_gives(void)
{
    test_random random = {12345};
    double worst = 0;
    for (int k = 0; k < TRIALS; k++) {
        static trial now;
        static mct_gauss_workspace workspace;
        static mct_gauss_motion motion;
        randomise(&now, &random, k);
        double others, dry, size;
        forces_of(&now, &others, &dry, &size);
        const double m = *parameter_of(&now.scene, "mass");
        const double slope = *parameter_of(&now.scene, "slope");
        const double g = (now.effects & MCT_GRAVITY) ? *parameter_of(&now.scene, "gravity") : 0;
        const double along = others + dry + m * g * sin(slope); /* weight acts as a force of its own */
        const mct_real force[3] = {(mct_real)(along * cos(slope)), (mct_real)(along * sin(slope) - m * g), 0};
        const mct_gauss_system engine = {1, 1, now.out.mass, mct_systems[block()]->place, &now.constants};
        TEST_ASSERT_EQUAL_INT(MCT_OK,
                              mct_gauss_kinematics(&engine, 0, now.x, now.x + 1, &workspace, &motion));
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_dynamics(&engine, force, NULL, &workspace, &motion));
        double error = fabs((double)(now.out.M[0][0] - motion.M[0][0])) / m;
        error = fmax(error, fabs((double)(now.out.Cv[0] - motion.Cv[0])) / size);
        error = fmax(error, fabs((double)(now.out.C[0][0] - motion.C[0][0])) / m);
        error = fmax(error, fabs((double)(now.out.tau[0] - motion.tau[0])) / size);
        error = fmax(error, fabs((double)(now.out.acceleration[0] - motion.acceleration[0])) * m / size);
        for (int i = 0; i < 3; i++) {
            const double e = (double)(now.out.constraint_force[0][i] - motion.constraint_force[0][i]);
            error = fmax(error, fabs(e) / (size + m * g));
            error = fmax(error, fabs((double)(now.out.position[0][i] - motion.position[0][i])) / 2);
        }
        worst = fmax(worst, error);
        TEST_ASSERT_TRUE(error <= TOLERANCE);
    }
    printf("closed form against Gauss: %.1e of the terms\n", worst);
}

/* dE/dt = m v a + m g sin a v + k x v, which is what the powers must add up to. */
static void test_powers_add_up_to_the_rate_of_the_energy(void)
{
    test_random random = {54321};
    double worst = 0;
    for (int k = 0; k < TRIALS; k++) {
        static trial now;
        randomise(&now, &random, k);
        double others, dry, size;
        forces_of(&now, &others, &dry, &size);
        const double v = (double)now.x[1];
        const double m = *parameter_of(&now.scene, "mass");
        const double g = (now.effects & MCT_GRAVITY) ? *parameter_of(&now.scene, "gravity") : 0;
        const double spring = (now.effects & MCT_SPRING) ? *parameter_of(&now.scene, "spring") : 0;
        const double x = (double)now.x[0];
        const double slope = *parameter_of(&now.scene, "slope");
        const double rate = v * (m * (double)now.out.acceleration[0] + m * g * sin(slope) + spring * x);
        const double powers = energy_rate(&now.out);
        const double energy = 0.5 * m * v * v + m * g * sin(slope) * x + 0.5 * spring * x * x;
        const double given = (double)now.out.kinetic_energy + (double)now.out.potential_energy;
        const double speed = fabs(v) + fabs(*parameter_of(&now.scene, "belt_speed"));
        worst = fmax(worst, fabs(rate - powers) / (size * speed + 1e-3));
        TEST_ASSERT_TRUE(fabs(rate - powers) <= TOLERANCE * (size * speed + 1e-3));
        TEST_ASSERT_TRUE(fabs(energy - given) <= TOLERANCE * (m * v * v + size * fabs(x) + 1e-3));
        const double belt = *parameter_of(&now.scene, "belt_speed");
        TEST_ASSERT_TRUE((double)now.out.power[MCT_EFFECT_COULOMB] <= dry * belt + TOLERANCE * size * speed);
    }
    printf("power balance: %.1e\n", worst);
}

static void test_a_block_held_on_a_slope_does_not_creep(void)
{
    FOR_EACH_STEPPER (stepper, block(), MCT_GRAVITY | MCT_COULOMB_MOREAU | MCT_FORCING) {
        mct_scene scene = scene_with(stepper, MCT_GRAVITY | MCT_COULOMB_MOREAU | MCT_FORCING);
        *parameter_of(&scene, "slope") =
            0.5; /* tan = 0.546: between the coefficients, so it is the static one */
        mct_plant plant;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, 100000);
        TEST_ASSERT_TRUE(plant.state.x[0] == 0 && plant.state.c[0] == 0);
        TEST_ASSERT_TRUE(plant.state.x[1] == 0 && plant.state.c[1] == 0);
        step_plant(&plant, MCT_R(-2.0), 100); /* a push of 2 N: 4.70 + 2 exceeds 0.6 m g cos = 5.17 */
        TEST_ASSERT_TRUE(plant.state.x[1] < 0);
    }
}

static void test_a_block_on_a_belt_is_carried_at_the_speed_of_the_belt(void)
{
    FOR_EACH_STEPPER (stepper, block(), MCT_GRAVITY | MCT_COULOMB_MOREAU) {
        mct_scene scene = scene_with(stepper, MCT_GRAVITY | MCT_COULOMB_MOREAU);
        *parameter_of(&scene, "belt_speed") = 0.3;
        scene.initial[1] = 2;
        mct_plant plant;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, 1000);
        const double from = mct_plant_value(&plant, 0);
        TEST_ASSERT_TRUE(plant.state.x[1] == MCT_R(0.3));
        step_plant(&plant, MCT_R(5.5),
                   10000); /* between dynamic and static friction, 4.9 and 5.9 N: it holds */
        TEST_ASSERT_TRUE(plant.state.x[1] == MCT_R(0.3));
        /* of 3 m; the belt's speed and the step are rounded once */
        TEST_ASSERT_DOUBLE_WITHIN(MCT_REAL_IS_FLOAT ? 1e-6 : 1e-14, 3, mct_plant_value(&plant, 0) - from);
    }
}

static void refused(const char *parameter, double value, const char *sentence)
{
    mct_scene scene =
        scene_with(MCT_STEPPER_EXPO, mct_systems[block()]->effects & ~(uint32_t)MCT_COULOMB_MOREAU);
    *parameter_of(&scene, parameter) = value;
    *parameter_of(&scene, "force_amplitude") = 1;
    mct_plant plant;
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_plant_init(&plant, &scene, &why));
    TEST_ASSERT_EQUAL_STRING(sentence, why.text);
}

static void test_parameters_that_do_not_go_together_are_refused(void)
{
    refused("static_coefficient", 0.4,
            "parameters.static_coefficient: found 0.4; allowed from dynamic_coefficient, 0.5");
    refused("spring", 4e6,
            "parameters.spring: found 4000000 N/m; allowed 1 rad of oscillation a step, up to 1000000 N/m");
    refused("force_frequency", 2000,
            "parameters.force_frequency: found 2000 rad/s; allowed 1 rad a step, up to 1000 rad/s");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_closed_form_is_what_gauss_principle_gives);
    RUN_TEST(test_powers_add_up_to_the_rate_of_the_energy);
    RUN_TEST(test_a_block_held_on_a_slope_does_not_creep);
    RUN_TEST(test_a_block_on_a_belt_is_carried_at_the_speed_of_the_belt);
    RUN_TEST(test_parameters_that_do_not_go_together_are_refused);
    return UNITY_END();
}

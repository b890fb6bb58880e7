/*
 * The spring pendulum's closed form against the generic Gauss engine, which gets h, the mass and what acts: weight,
 * spring and friction along the rod as forces on the ball, torque and friction of the pivot as couples.
 *
 * Tolerances: 1e-12 in double, 300 roundings in float, relative to the terms that meet in a result: a force on
 * coordinate j is at most sqrt(M_jj) times the norm, weighted by mass, of what acts and accelerates.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/gauss.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

enum { TRIALS = TEST_CASES(10000), N = 2 };

#define TOLERANCE (MCT_REAL_IS_FLOAT ? 300 * (double)FLT_EPSILON : 1e-12)

void setUp(void)
{
}

void tearDown(void)
{
}

static int spring_pendulum(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, "spring_pendulum") == 0) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE("no spring_pendulum");
    return -1;
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
    mct_real force[3];
    mct_real couple[N];
    double norm;
} trial;

static void randomise(trial *self, test_random *random, uint32_t effects)
{
    memset(self, 0, sizeof *self);
    self->scene = scene_of(spring_pendulum(), MCT_STEPPER_RK4, effects);
    self->effects = effects;
    for (int i = 0; i < mct_systems[self->scene.system]->parameter_count; i++) {
        self->scene.parameters[i] *= random_scale(random, 0.3, 3);
    }
    *parameter_of(&self->scene, "mass") = random_scale(random, 0.05, 20);
    if (random_in(random, 0, 1) < 0.3) {
        *parameter_of(&self->scene, "rest_length") = 0;
    }
    self->x[0] = (mct_real)random_scale(random, 0.05, 5);
    self->x[1] = (mct_real)random_in(random, -7, 7);
    self->x[2] = (mct_real)random_in(random, -8, 8);
    self->x[3] = (mct_real)random_in(random, -8, 8);
    self->input = (mct_real)random_in(random, -10, 10);
}

static void run_engine(trial *self)
{
    const mct_system *const system = mct_systems[self->scene.system];
    const double mass = *parameter_of(&self->scene, "mass");
    const bool viscous = self->effects & MCT_VISCOUS;
    const double r = (double)self->x[0];
    double along = 0;
    if (self->effects & MCT_SPRING) {
        along -= *parameter_of(&self->scene, "stiffness") * (r - *parameter_of(&self->scene, "rest_length"));
    }
    if (viscous) {
        along -= *parameter_of(&self->scene, "length_friction") * (double)self->x[2];
    }
    const double weight = (self->effects & MCT_GRAVITY) ? mass * *parameter_of(&self->scene, "gravity") : 0;
    self->force[0] = (mct_real)(along * cos((double)self->x[1]));
    self->force[1] = (mct_real)(along * sin((double)self->x[1]) - weight);
    self->couple[1] = self->input;
    if (viscous) {
        self->couple[1] -= (mct_real)(*parameter_of(&self->scene, "angle_friction") * (double)self->x[3]);
    }
    const mct_real particle = (mct_real)mass;
    const mct_gauss_system engine = {1, N, &particle, system->place, &self->constants};
    TEST_ASSERT_EQUAL_INT(
        MCT_OK, mct_gauss_kinematics(&engine, 0, self->x, self->x + N, &self->workspace, &self->motion));
    TEST_ASSERT_EQUAL_INT(
        MCT_OK, mct_gauss_dynamics(&engine, self->force, self->couple, &self->workspace, &self->motion));
    double square = 0;
    for (int k = 0; k < 3; k++) {
        const double a = (double)self->motion.particle_acceleration[0][k];
        const double f = (double)self->force[k];
        square += mass * a * a + (f * f + weight * weight + along * along) / mass;
    }
    for (int j = 0; j < N; j++) { /* what C v and M a cancel of each other */
        const double cv = (double)self->motion.Cv[j];
        square += cv * cv / (double)self->motion.M[j][j];
    }
    self->norm = sqrt(square);
}

static double worst;

static void compare(const char *name, mct_real closed, mct_real engine, double size)
{
    const double error = fabs((double)closed - (double)engine) / (size > 0 ? size : 1);
    worst = fmax(worst, error);
    if (!(error <= TOLERANCE)) {
        char text[160];
        snprintf(text, sizeof text, "%s: closed form %.17g, engine %.17g, terms of size %.3g", name,
                 (double)closed, (double)engine, size);
        TEST_FAIL_MESSAGE(text);
    }
}

static void check_closed_form(const trial *self)
{
    const mct_evaluation *const out = &self->out;
    const mct_gauss_motion *const motion = &self->motion;
    const double mass = (double)out->mass[0];
    const double speed = fabs((double)self->x[2]) + fabs((double)self->x[0] * (double)self->x[3]);
    double couples = 0;
    for (int i = 0; i < N; i++) {
        const double Mii = (double)out->M[i][i];
        const double force_size = sqrt(Mii) * self->norm + fabs((double)self->couple[i]);
        couples += fabs((double)self->couple[i]) / (double)self->x[0];
        for (int j = 0; j < N; j++) {
            const double size = sqrt(Mii * (double)out->M[j][j]);
            compare("M", out->M[i][j], motion->M[i][j], size);
            compare("C", out->C[i][j], motion->C[i][j], size * speed / (double)self->x[0]);
        }
        compare("C v", out->Cv[i], motion->Cv[i], force_size);
        compare("tau", out->tau[i], motion->tau[i], force_size);
        compare("acceleration", out->acceleration[i], motion->acceleration[i], force_size / Mii);
    }
    for (int k = 0; k < 3; k++) {
        compare("position", out->position[0][k], motion->position[0][k], (double)self->x[0]);
        compare("constraint force", out->constraint_force[0][k], motion->constraint_force[0][k],
                sqrt(mass) * self->norm + couples);
    }
}

/* dE/dt by the chain rule from E = m |xd|^2 / 2 + m g x2 + k (r - l0)^2 / 2. */
static void check_power_balance(const trial *self)
{
    const mct_evaluation *const out = &self->out;
    const double mass = (double)out->mass[0];
    const double r = (double)self->x[0], rd = (double)self->x[2], w = (double)self->x[3];
    const double s = sin((double)self->x[1]), c = cos((double)self->x[1]);
    const double a1 = (double)out->acceleration[0], a2 = (double)out->acceleration[1];
    const double g = (self->effects & MCT_GRAVITY) ? self->scene.parameters[5] : 0;
    const double k = (self->effects & MCT_SPRING) ? self->scene.parameters[1] : 0;
    const double terms[] = {mass * rd * a1,
                            mass * r * w * w * rd,
                            mass * r * r * w * a2,
                            mass * g * rd * s,
                            mass * g * r * w * c,
                            k * (r - self->scene.parameters[2]) * rd,
                            -(double)out->power_input,
                            -(double)out->power[MCT_EFFECT_VISCOUS]};
    double sum = 0;
    double size = 0;
    for (int i = 0; i < 8; i++) {
        sum += terms[i];
        size += fabs(terms[i]);
    }
    size += fabs(k * self->scene.parameters[2] * rd); /* r - l0 */
    compare("power", (mct_real)sum, 0, size);
    const double kinetic = mass * (rd * rd + r * r * w * w) / 2;
    compare("kinetic energy", out->kinetic_energy, (mct_real)kinetic, kinetic);
    TEST_ASSERT_TRUE(out->power[MCT_EFFECT_VISCOUS] <= 0);
}

static void for_all_trials(void (*check)(const trial *))
{
    static trial now;
    test_random random = {12345};
    worst = 0;
    for (int k = 0; k < TRIALS; k++) {
        const uint32_t effects =
            ((k & 1) ? MCT_GRAVITY : 0) | ((k & 2) ? MCT_SPRING : 0) | ((k & 4) ? MCT_VISCOUS : 0);
        randomise(&now, &random, effects);
        TEST_ASSERT_EQUAL_INT(MCT_OK,
                              mct_systems[now.scene.system]->prepare(&now.scene, 1e-3, &now.constants, NULL));
        mct_systems[now.scene.system]->evaluate(&now.constants, effects, now.x, now.input, &now.out);
        run_engine(&now);
        check(&now);
    }
    printf("worst in %d: %.1e\n", TRIALS, worst);
}

static void test_the_closed_form_is_what_gauss_principle_gives(void)
{
    for_all_trials(check_closed_form);
}

static void test_energy_changes_by_the_powers_of_the_effects(void)
{
    for_all_trials(check_power_balance);
}

/*
 * The kernel in either precision, at what a step errs by (1e-9, test_spring_pendulum_f64.c) and at some hundred roundings
 * of float: the spring's rates are rounded once, which moves the phase by w t = 32 roundings.
 */
static void test_the_kernel_follows_the_harmonic_oscillator(void)
{
    mct_scene scene = scene_of(spring_pendulum(), MCT_STEPPER_RK4, MCT_GRAVITY | MCT_SPRING);
    *parameter_of(&scene, "stiffness") = 20; /* w^2 = 40 */
    *parameter_of(&scene, "rest_length") = 0;
    scene.initial[0] = 0.7;
    scene.initial[1] = -0.4;
    scene.initial[2] = 0;
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 5000);
    const double centre = -*parameter_of(&scene, "gravity") / 40;
    const double phase = cos(sqrt(40.0) * 5);
    const double r = mct_plant_value(&plant, 0), th = mct_plant_value(&plant, 1);
    const double error = fmax(fabs(r * cos(th) - 0.7 * cos(-0.4) * phase),
                              fabs(r * sin(th) - (centre + (0.7 * sin(-0.4) - centre) * phase)));
    printf("harmonic: %.1e\n", error);
    TEST_ASSERT_TRUE(error < (MCT_REAL_IS_FLOAT ? 100 * (double)FLT_EPSILON : 1e-9));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_closed_form_is_what_gauss_principle_gives);
    RUN_TEST(test_energy_changes_by_the_powers_of_the_effects);
    RUN_TEST(test_the_kernel_follows_the_harmonic_oscillator);
    return UNITY_END();
}

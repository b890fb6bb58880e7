/*
 * The pendulum: its closed form against the generic Gauss engine, its power balance, its motion against the textbook's
 * equation in quadruple precision and against its period in closed form, the slip of eq. 38.
 *
 * Tolerances: 1e-12 relative to the size of the terms that meet; of motions as each test says.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/gauss.h"
#include "support/quad.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

#define PI 3.14159265358979323846

enum { TRIALS = 10000 };

static int pendulum;

void setUp(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, "pendulum") == 0) {
            pendulum = i;
        }
    }
}

void tearDown(void)
{
}

typedef struct {
    mct_scene scene;
    mct_constants constants;
    mct_real x[2];
    mct_real input;
    mct_evaluation out;
    double mass, length, gravity, couple; /* what acts, from the scene's parameters */
} trial;

static double used(trial *self, uint32_t effect, const char *name)
{
    return (self->scene.effects & effect) ? *parameter_of(&self->scene, name) : 0;
}

static void randomise(trial *self, test_random *random, uint32_t effects)
{
    self->scene = scene_of(pendulum, MCT_STEPPER_RK4, effects);
    *parameter_of(&self->scene, "mass") = random_scale(random, 1e-3, 1e3);
    *parameter_of(&self->scene, "length") = random_scale(random, 1e-2, 1e2);
    *parameter_of(&self->scene, "gravity") = random_in(random, 0, 20);
    *parameter_of(&self->scene, "friction") = random_scale(random, 1e-3, 10);
    *parameter_of(&self->scene, "drag") = random_scale(random, 1e-3, 10);
    *parameter_of(&self->scene, "coulomb") = random_scale(random, 1e-3, 10);
    self->x[0] = random_in(random, -7, 7);
    self->x[1] = random_in(random, -9, 9);
    self->input = random_in(random, -10, 10);
    const double rate = self->x[1];
    self->mass = *parameter_of(&self->scene, "mass");
    self->length = *parameter_of(&self->scene, "length");
    self->gravity = used(self, MCT_GRAVITY, "gravity");
    self->couple = self->input - used(self, MCT_VISCOUS, "friction") * rate -
                   used(self, MCT_DRAG, "drag") * rate * fabs(rate) -
                   used(self, MCT_COULOMB_MOREAU, "coulomb") * (rate > 0 ? 1 : -1);
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_systems[pendulum]->prepare(&self->scene, 1e-3, &self->constants, NULL));
    mct_systems[pendulum]->evaluate(&self->constants, effects, self->x, self->input, &self->out);
}

static void for_all_trials(void (*check)(trial *))
{
    static const uint32_t switches[] = {MCT_GRAVITY, MCT_VISCOUS, MCT_COULOMB_MOREAU, MCT_DRAG};
    test_random random = {1729};
    for (int n = 0; n < TRIALS; n++) {
        static trial now;
        uint32_t effects = 0;
        for (int i = 0; i < 4; i++) {
            effects |= (n >> i) & 1 ? switches[i] : 0;
        }
        randomise(&now, &random, effects);
        check(&now);
    }
}

static void check_near(double closed, double engine, double size)
{
    TEST_ASSERT_TRUE(fabs(closed - engine) <= 1e-12 * size);
}

static void check_against_engine(trial *self)
{
    static mct_gauss_workspace workspace;
    static mct_gauss_motion motion;
    const mct_real mass = self->mass;
    const mct_real force[3] = {0, -self->mass * self->gravity, 0};
    const mct_real couple = self->couple;
    const mct_gauss_system engine = {1, 1, &mass, mct_systems[pendulum]->place, &self->constants};
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          mct_gauss_kinematics(&engine, 0, self->x, self->x + 1, &workspace, &motion));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_dynamics(&engine, force, &couple, &workspace, &motion));
    const double inertia = self->mass * self->length * self->length;
    const double spin = self->x[1] * self->x[1];
    const double torque = fabs((double)self->input) + fabs(self->couple) +
                          self->mass * self->gravity * self->length + inertia * spin;
    check_near(self->out.M[0][0], motion.M[0][0], inertia);
    check_near(self->out.Cv[0], motion.Cv[0], inertia * spin);
    check_near(self->out.tau[0], motion.tau[0], torque);
    check_near(self->out.acceleration[0], motion.acceleration[0], torque / inertia);
    for (int axis = 0; axis < 3; axis++) {
        check_near(self->out.position[0][axis], motion.position[0][axis], self->length);
        check_near(self->out.constraint_force[0][axis], motion.constraint_force[0][axis],
                   torque / self->length);
    }
}

static void test_the_closed_form_is_that_of_the_gauss_engine(void)
{
    for_all_trials(check_against_engine);
}

static void check_power(trial *self)
{
    const mct_evaluation *at = &self->out;
    const double inertia = self->mass * self->length * self->length;
    const double weight = self->mass * self->gravity * self->length;
    const double rate = self->x[1];
    const double change = inertia * rate * at->acceleration[0] - weight * sin(self->x[0]) * rate;
    const double size = (fabs((double)self->input) + fabs(self->couple) + weight) * fabs(rate);
    check_near(energy_rate(at), change, size);
    check_near(at->kinetic_energy, 0.5 * inertia * rate * rate, inertia * rate * rate);
    check_near(at->potential_energy, weight * cos(self->x[0]), weight);
}

static void test_the_powers_add_up_to_the_change_of_energy(void)
{
    for_all_trials(check_power);
}

/* Eq. 38 compares the rate itself with g cos th; it is its square times the length, and the sign is the other one. */
static void test_the_rods_force_as_printed_is_not_what_keeps_the_rod(void)
{
    test_random random = {7};
    static trial now;
    randomise(&now, &random, MCT_GRAVITY);
    now.input = 0;
    mct_systems[pendulum]->evaluate(&now.constants, MCT_GRAVITY, now.x, 0, &now.out);
    const double s = sin(now.x[0]);
    const double c = cos(now.x[0]);
    const double rate = now.x[1];
    const double corrected = now.mass * (now.gravity * c - now.length * rate * rate);
    const double printed = -now.mass * now.length * (now.gravity * c - rate);
    const double along = now.out.constraint_force[0][0] * s + now.out.constraint_force[0][1] * c;
    check_near(along, corrected, fabs(corrected) + now.mass * now.gravity);
    TEST_ASSERT_TRUE(fabs(along - printed) > 1e-3 * fabs(along));
}

/* --- motions --- */

typedef struct {
    double inertia, weight, friction, drag;
} textbook;

static void textbook_rate(const void *model, quad time, const quad *x, quad *dx)
{
    const textbook *self = model;
    (void)time;
    dx[0] = x[1];
    dx[1] = ((quad)self->weight * quad_sin(x[0]) - (quad)self->friction * x[1] -
             (quad)self->drag * x[1] * quad_abs(x[1])) /
            (quad)self->inertia;
}

/* How much a motion amplifies an error of its rate that is made on the way, by the reference itself; at least 1. */
static double growth_of(const textbook *model, double angle, double rate, const quad *end)
{
    enum { PLACES = 20 };
    const quad nudge = (quad)1e-12;
    quad way[2] = {angle, rate};
    double growth = 1;
    for (int i = 0; i < PLACES; i++) {
        const quad left = 5 - (quad)5 * i / PLACES;
        quad x[2] = {way[0], way[1] + nudge};
        quad_extrapolate(textbook_rate, model, 0, x, 2, left, 20L * (PLACES - i));
        growth = fmax(growth, (double)(quad_abs(x[0] - end[0]) / nudge));
        quad_extrapolate(textbook_rate, model, 0, way, 2, (quad)5 / PLACES, 20);
    }
    return growth;
}

/* The third is let go 1 mrad from upright and comes back there: it amplifies an error by thousands. */
static void test_motion_follows_the_textbook_in_quadruple_precision(void)
{
    static const struct {
        const char *name;
        double mass, length, friction, drag, angle, rate;
    } motions[] = {
        {"default", 0.1, 0.3, 0.0005, 0, 3.0, 4},
        {"over the top, with drag", 0.5, 1.1, 0, 0.02, 0.3, 9},
        {"1 mrad from upright", 0.1, 0.3, 0, 0, 1e-3, 0},
    };
    for (size_t i = 0; i < sizeof motions / sizeof motions[0]; i++) {
        const double m = motions[i].mass;
        const double l = motions[i].length;
        mct_scene scene = scene_of(pendulum, MCT_STEPPER_RK4, MCT_GRAVITY | MCT_VISCOUS | MCT_DRAG);
        *parameter_of(&scene, "mass") = m;
        *parameter_of(&scene, "length") = l;
        *parameter_of(&scene, "friction") = motions[i].friction;
        *parameter_of(&scene, "drag") = motions[i].drag;
        scene.initial[0] = motions[i].angle;
        scene.initial[1] = motions[i].rate;
        const textbook model = {m * l * l, m * l * *parameter_of(&scene, "gravity"), motions[i].friction,
                                motions[i].drag};
        quad coarse[2] = {motions[i].angle, motions[i].rate};
        quad fine[2] = {motions[i].angle, motions[i].rate};
        quad_extrapolate(textbook_rate, &model, 0, coarse, 2, 5, 200);
        quad_extrapolate(textbook_rate, &model, 0, fine, 2, 5, 400);
        mct_plant plant;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, 5000);
        double worst = 0;
        for (int k = 0; k < 2; k++) {
            TEST_ASSERT_TRUE(quad_abs(coarse[k] - fine[k]) <= (quad)1e-14 * (1 + quad_abs(fine[k])));
            worst = fmax(worst, fabs(mct_plant_value(&plant, k) - (double)fine[k]));
        }
        const double growth = growth_of(&model, motions[i].angle, motions[i].rate, fine);
        printf("%s, 5 s at 1 ms: rk4 %.1e, growth %.1e\n", motions[i].name, worst, growth);
        TEST_ASSERT_TRUE(worst <= 1e-9 * growth);
    }
}

/* T = 2 pi sqrt(l/g) / agm(1, cos(a/2)), a the swing to either side: here by the time of many swings. */
static void test_the_period_is_that_of_the_elliptic_integral(void)
{
    static const double swings[] = {0.1, 1, 2, 3};
    for (size_t i = 0; i < sizeof swings / sizeof swings[0]; i++) {
        mct_scene scene = scene_of(pendulum, MCT_STEPPER_RK4, MCT_GRAVITY);
        scene.initial[0] = PI + swings[i];
        const double w0 = sqrt(*parameter_of(&scene, "gravity") / *parameter_of(&scene, "length"));
        double a = 1;
        double b = cos(swings[i] / 2);
        for (int k = 0; k < 8; k++) {
            const double mean = (a + b) / 2;
            b = sqrt(a * b);
            a = mean;
        }
        const double period = 2 * PI / (w0 * a);
        /* A whole number of steps to a period: after it the state is what it was. */
        const long steps = lround(period / 1e-3);
        scene.dt = period / (double)steps;
        mct_plant plant;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, 5 * steps);
        const double angle = mct_plant_value(&plant, 0) - scene.initial[0];
        printf("swing %g: after 5 periods off by %.1e rad, %.1e rad/s\n", swings[i], angle,
               mct_plant_value(&plant, 1));
        /* A turning point stays one: what a wrong period would show is the rate. */
        TEST_ASSERT_TRUE(fabs(angle) < 1e-9);
        TEST_ASSERT_TRUE(fabs(mct_plant_value(&plant, 1)) < 2e-9);
    }
}

/* w |w| taken as w' |w| keeps `leap` of order 2. */
static void test_steppers_have_their_order_with_drag_and_friction(void)
{
    static const struct {
        int stepper;
        double order;
    } cases[] = {{MCT_STEPPER_SEED, 1}, {MCT_STEPPER_EULER, 1}, {MCT_STEPPER_LEAP, 2}, {MCT_STEPPER_RK4, 4}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double end[3];
        for (int k = 0; k < 3; k++) {
            mct_scene scene = scene_of(pendulum, cases[i].stepper, MCT_GRAVITY | MCT_VISCOUS | MCT_DRAG);
            *parameter_of(&scene, "drag") = 0.005;
            scene.initial[0] = 0.5;
            scene.initial[1] = 12; /* it turns over and over: the rate keeps its sign */
            scene.dt = 4e-3 / (1 << k);
            mct_plant plant;
            start_plant(&plant, &scene);
            step_plant(&plant, 0, 50L << k);
            end[k] = mct_plant_value(&plant, 0);
        }
        const double order = log2(fabs((end[0] - end[1]) / (end[1] - end[2])));
        printf("%s: order %.2f\n", mct_steppers[cases[i].stepper].name, order);
        TEST_ASSERT_DOUBLE_WITHIN(0.2, cases[i].order, order);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_closed_form_is_that_of_the_gauss_engine);
    RUN_TEST(test_the_powers_add_up_to_the_change_of_energy);
    RUN_TEST(test_the_rods_force_as_printed_is_not_what_keeps_the_rod);
    RUN_TEST(test_motion_follows_the_textbook_in_quadruple_precision);
    RUN_TEST(test_the_period_is_that_of_the_elliptic_integral);
    RUN_TEST(test_steppers_have_their_order_with_drag_and_friction);
    return UNITY_END();
}

/*
 * Motion of the spring pendulum against references that know nothing of the kernels.
 *
 * Without rest length and friction it is the isotropic harmonic oscillator about (0, -m g / k): x = a cos wt + b sin wt,
 * in long double. Else the source's polar equation (53) in quadruple precision by extrapolation; the kernels integrate
 * in Cartesian coordinates where a step comes near the pivot.
 * Tolerances: rk4 errs by (w h)^4 w t / 120 of an oscillation of frequency w: 4e-9 at w = 10/s, h = 1 ms and t = 5 s
 * (the prototype's figure for the passage of the pivot, too), 1e-9 below 7/s.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/quad.h"
#include "support/scenes.h"
#include "unity.h"

#define PI 3.14159265358979323846

void setUp(void)
{
}

void tearDown(void)
{
}

static mct_scene scene_with(int stepper, uint32_t effects, double length, double angle, double rd, double w)
{
    int system = 0;
    while (system < MCT_SYSTEM_COUNT - 1 && strcmp(mct_systems[system]->name, "spring_pendulum") != 0) {
        system++;
    }
    mct_scene scene = scene_of(system, stepper, effects);
    scene.initial[0] = length;
    scene.initial[1] = angle;
    scene.initial[2] = rd;
    scene.initial[3] = w;
    return scene;
}

static void set(mct_scene *scene, double mass, double stiffness, double rest_length)
{
    *parameter_of(scene, "mass") = mass;
    *parameter_of(scene, "stiffness") = stiffness;
    *parameter_of(scene, "rest_length") = rest_length;
}

/* Place and velocity (X, Xd) of the ball; in a state with compensation, the sum of both. */
static void cartesian(const mct_plant *plant, double *x)
{
    const double r = mct_plant_value(plant, 0), th = mct_plant_value(plant, 1);
    const double rd = mct_plant_value(plant, 2), w = mct_plant_value(plant, 3);
    x[0] = r * cos(th);
    x[1] = r * sin(th);
    x[2] = rd * cos(th) - r * w * sin(th);
    x[3] = rd * sin(th) + r * w * cos(th);
}

/* Largest error over the run, of place and of velocity / w, relative to the largest distance from the centre. */
static double harmonic_error(mct_scene scene, double seconds)
{
    const long double mass = *parameter_of(&scene, "mass");
    const long double w = sqrtl((long double)*parameter_of(&scene, "stiffness") / mass);
    const long double centre =
        (scene.effects & MCT_GRAVITY) ? -(long double)*parameter_of(&scene, "gravity") / (w * w) : 0;
    mct_plant plant;
    start_plant(&plant, &scene);
    const long double r = scene.initial[0], th = scene.initial[1];
    const long double x0 = r * cosl(th), y0 = r * sinl(th) - centre;
    const long double u0 = scene.initial[2] * cosl(th) - r * scene.initial[3] * sinl(th);
    const long double v0 = scene.initial[2] * sinl(th) + r * scene.initial[3] * cosl(th);
    const double size = (double)sqrtl(x0 * x0 + y0 * y0 + (u0 * u0 + v0 * v0) / (w * w));
    double worst = 0;
    for (long k = 1; k <= lround(seconds / scene.dt); k++) {
        mct_plant_step(&plant, 0);
        const long double c = cosl(w * k * (long double)scene.dt);
        const long double s = sinl(w * k * (long double)scene.dt);
        double x[4];
        cartesian(&plant, x);
        worst = fmax(worst, fabs(x[0] - (double)(x0 * c + u0 / w * s)));
        worst = fmax(worst, fabs(x[1] - (double)(centre + y0 * c + v0 / w * s)));
        worst = fmax(worst, fabs(x[2] - (double)(u0 * c - w * x0 * s)) / (double)w);
        worst = fmax(worst, fabs(x[3] - (double)(v0 * c - w * y0 * s)) / (double)w);
    }
    TEST_ASSERT_EQUAL_UINT64(0, plant.diverged_ticks);
    return worst / size;
}

static void test_without_rest_length_and_friction_the_ball_is_a_harmonic_oscillator(void)
{
    mct_scene scene = scene_with(MCT_STEPPER_RK4, MCT_GRAVITY | MCT_SPRING, 0.7, -0.4, 0.3, 1.5);
    set(&scene, 0.5, 20, 0);
    const double error = harmonic_error(scene, 5);
    printf("harmonic, w = 6.3: %.1e\n", error);
    TEST_ASSERT_TRUE(error < 1e-9);
}

/* Hard: 10 000 rad/s at 0.1 mm from the pivot, every 0.3 s. Integrated in polar coordinates this ends in NaN. */
static void test_the_ball_passes_the_pivot_as_if_it_were_not_there(void)
{
    const double misses[] = {1e-2, 1e-4, 1e-7, 0};
    for (int i = 0; i < 4; i++) {
        mct_scene scene = scene_with(MCT_STEPPER_RK4, MCT_SPRING, 1, 0.3, 0, 10 * misses[i]);
        set(&scene, 1, 100, 0);
        const double error = harmonic_error(scene, 5);
        printf("harmonic, w = 10, nearest %.0e m: %.1e\n", misses[i], error);
        TEST_ASSERT_TRUE(error < 5e-9);
    }
    /* From above the pivot straight down, through it and back. */
    mct_scene fall = scene_with(MCT_STEPPER_RK4, MCT_SPRING | MCT_GRAVITY, 0.3, PI / 2, 0, 0);
    set(&fall, 0.5, 20, 0);
    TEST_ASSERT_TRUE(harmonic_error(fall, 5) < 1e-9);
}

/* After the first passage, 0.25 s from the start; the force turns by half a turn within 2 b / (6.3 m/s). */
static void pass_pivot(double nearest, int stepper, double dt, double *x)
{
    mct_scene scene = scene_with(stepper, MCT_SPRING, 1, 0.3, 0, 6.3 * nearest);
    set(&scene, 1, 100, 0.3);
    scene.dt = dt;
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, lround(0.25 / dt));
    TEST_ASSERT_EQUAL_UINT64(0, plant.diverged_ticks);
    cartesian(&plant, x);
}

/*
 * The force turns while the ball passes; steps without parts miss this by orders of magnitude. A quarter of the time
 * of the turn, by order 4, leaves 1e-5 of the 30 m/s^2 times that time: 1e-6 m at the most, some cm from the pivot.
 */
static void test_with_a_rest_length_the_ball_passes_the_pivot_at_any_distance(void)
{
    const double misses[] = {0.1, 0.03, 1e-2, 3e-3, 1e-3, 1e-4, 1e-6, 0};
    const int steppers[] = {MCT_STEPPER_RK4, MCT_STEPPER_TAYLOR6, MCT_STEPPER_TAYLOR12};
    for (int i = 0; i < 8; i++) {
        for (int k = 0; k < 3; k++) {
            double x[4], exact[4];
            pass_pivot(misses[i], steppers[k], 1e-3, x);
            pass_pivot(misses[i], MCT_STEPPER_RK4, 0x1p-7 * 1e-3, exact);
            const double error = hypot(x[0] - exact[0], x[1] - exact[1]);
            printf("rest length, nearest %.0e m, %s: %.1e m\n", misses[i], mct_steppers[steppers[k]].name,
                   error);
            TEST_ASSERT_TRUE(error < 1e-6);
        }
    }
}

typedef struct {
    quad mass, stiffness, rest, length_friction, angle_friction, gravity, torque;
} textbook;

/* Equation (53), solved for the accelerations. */
static void textbook_rate(const void *model, quad time, const quad *x, quad *dx)
{
    const textbook *m = model;
    (void)time;
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = x[0] * x[3] * x[3] + (-m->stiffness * (x[0] - m->rest) - m->length_friction * x[2] -
                                  m->mass * m->gravity * quad_sin(x[1])) /
                                     m->mass;
    dx[3] = ((m->torque - m->angle_friction * x[3] - m->mass * m->gravity * x[0] * quad_cos(x[1])) / m->mass -
             2 * x[0] * x[2] * x[3]) /
            (x[0] * x[0]);
}

/* Largest error of (r, th, rd/w, thd/w) at the end, w = sqrt(k/m). */
static double textbook_error(mct_scene scene, double torque, double seconds, double *reference_error)
{
    const bool viscous = scene.effects & MCT_VISCOUS;
    const textbook model = {*parameter_of(&scene, "mass"),
                            (scene.effects & MCT_SPRING) ? *parameter_of(&scene, "stiffness") : 0,
                            *parameter_of(&scene, "rest_length"),
                            viscous ? *parameter_of(&scene, "length_friction") : 0,
                            viscous ? *parameter_of(&scene, "angle_friction") : 0,
                            (scene.effects & MCT_GRAVITY) ? *parameter_of(&scene, "gravity") : 0,
                            torque};
    const double w = sqrt((double)(model.stiffness / model.mass)) + 1;
    quad x[4], coarse[4];
    for (int i = 0; i < 4; i++) {
        x[i] = coarse[i] = scene.initial[i];
    }
    quad_extrapolate(textbook_rate, &model, 0, x, 4, seconds, lround(seconds * 1000));
    quad_extrapolate(textbook_rate, &model, 0, coarse, 4, seconds, lround(seconds * 500));
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, torque, lround(seconds / scene.dt));
    TEST_ASSERT_EQUAL_UINT64(0, plant.diverged_ticks);
    double worst = 0;
    *reference_error = 0;
    for (int i = 0; i < 4; i++) {
        const double scale = i < 2 ? 1 : w;
        worst = fmax(worst, fabs((double)(mct_plant_value(&plant, i) - x[i])) / scale);
        *reference_error = fmax(*reference_error, fabs((double)(x[i] - coarse[i])) / scale);
    }
    return worst;
}

static mct_scene resonant(int stepper)
{
    mct_scene scene = scene_with(stepper, MCT_GRAVITY | MCT_SPRING | MCT_VISCOUS, 0.6, -1.5, 0, 0);
    set(&scene, 0.5, 20, 0.4);
    return scene;
}

static void test_rk4_follows_the_textbooks_equation_to_a_billionth(void)
{
    mct_scene plain = resonant(MCT_STEPPER_RK4);
    mct_scene spun = scene_with(MCT_STEPPER_RK4, MCT_GRAVITY | MCT_SPRING | MCT_VISCOUS, 0.5, 0.2, 0.3, 2);
    set(&spun, 0.8, 25, 0.35);
    mct_scene near =
        scene_with(MCT_STEPPER_RK4, MCT_SPRING, 0.8, 0, 0, 0.35); /* hard: to 5 cm of the pivot */
    set(&near, 0.5, 20, 0.1);
    const struct {
        const char *name;
        mct_scene scene;
        double torque;
    } cases[] = {{"resonant", plain, 0}, {"driven by a torque", spun, 0.1}, {"near the pivot", near, 0}};
    for (int i = 0; i < 3; i++) {
        double reference_error;
        const double error = textbook_error(cases[i].scene, cases[i].torque, 5, &reference_error);
        printf("textbook, %s: %.1e, reference %.0e\n", cases[i].name, error, reference_error);
        TEST_ASSERT_TRUE(reference_error < 1e-14);
        TEST_ASSERT_TRUE(error < 1e-9);
    }
}

static void test_each_stepper_has_its_order(void)
{
    const struct {
        int stepper, order;
    } cases[] = {{MCT_STEPPER_SEED, 1},
                 {MCT_STEPPER_EULER, 1},
                 {MCT_STEPPER_LEAP, 2},
                 {MCT_STEPPER_SPLIT3, 2},
                 {MCT_STEPPER_RK4, 4}};
    for (int i = 0; i < 5; i++) {
        double unused;
        mct_scene scene = resonant(cases[i].stepper);
        scene.dt = 4e-3;
        const double coarse = textbook_error(scene, 0.05, 1, &unused);
        scene.dt = 2e-3;
        const double fine = textbook_error(scene, 0.05, 1, &unused);
        const double order = log2(coarse / fine);
        printf("%s: error %.1e at 4 ms, order %.2f\n", mct_steppers[cases[i].stepper].name, coarse, order);
        TEST_ASSERT_TRUE(fabs(order - cases[i].order) < 0.3);
    }
}

/*
 * The ball swings on a spring of its own length, at w h from 0.1 to 32: the energy moves by the square of the step against
 * the swing's own time, (h w)^2 with w = 3/s, and by no more when the spring is stiffer; 1e-6 of m g l0 is measured.
 */
static void test_split3_keeps_energy_on_a_spring_of_any_stiffness(void)
{
    for (double stiffness = 1e4; stiffness <= 1e9; stiffness *= 1.7) {
        mct_scene scene = scene_with(MCT_STEPPER_SPLIT3, MCT_SPRING | MCT_GRAVITY, 1, -0.64, 0, 0);
        set(&scene, 1, stiffness, 1);
        mct_plant plant;
        start_plant(&plant, &scene);
        const double before = energy_of(&plant);
        double worst = 0;
        for (long k = 0; k < 10000; k++) {
            mct_plant_step(&plant, 0);
            worst = fmax(worst, fabs(energy_of(&plant) - before) / 9.81);
        }
        printf("%.1e N/m: energy within %.1e\n", stiffness, worst);
        TEST_ASSERT_TRUE(worst < 2e-6);
    }
}

/* A kick of `leap` points at the pivot and a drift is straight: neither changes r^2 w. A million steps' roundings. */
static void test_leap_keeps_the_angular_momentum_about_the_pivot(void)
{
    mct_scene scene = scene_with(MCT_STEPPER_LEAP, MCT_SPRING, 0.6, 0.1, 0.2, 3);
    mct_plant plant;
    start_plant(&plant, &scene);
    const double before = 0.36 * 3;
    step_plant(&plant, 0, 1000000);
    const double r = mct_plant_value(&plant, 0);
    const double gap = r * r * mct_plant_value(&plant, 3) / before - 1;
    printf("angular momentum after a million steps: %.1e\n", gap);
    TEST_ASSERT_TRUE(fabs(gap) < 1e-12);
}

/* Its energy swings by some (w h)^2 / 8 of itself, 1e-5 here, and does not wander off. */
static void test_leap_keeps_energy_for_a_thousand_seconds_near_where_it_was(void)
{
    mct_scene scene = scene_with(MCT_STEPPER_LEAP, MCT_SPRING | MCT_GRAVITY, 0.6, -0.3, 0, 0);
    mct_plant plant;
    start_plant(&plant, &scene);
    const double before = energy_of(&plant);
    double early = 0, late = 0;
    for (long k = 0; k < 1000000; k++) {
        mct_plant_step(&plant, 0);
        if (k < 100000 || k >= 900000) {
            double *worst = k < 100000 ? &early : &late;
            *worst = fmax(*worst, fabs(energy_of(&plant) - before));
        }
    }
    printf("energy: within %.1e J in the first 100 s, %.1e J in the last\n", early, late);
    TEST_ASSERT_TRUE(early < 1e-4);
    TEST_ASSERT_TRUE(late < 2 * early);
}

static void test_leap_returns_to_its_start_when_reversed(void)
{
    mct_scene scene = scene_with(MCT_STEPPER_LEAP, MCT_SPRING | MCT_GRAVITY, 0.6, -1.2, 0, 0);
    mct_plant plant;
    start_plant(&plant, &scene);
    double from[4], to[4];
    cartesian(&plant, from);
    step_plant(&plant, 0, 3000);
    for (int i = 2; i < 4; i++) {
        plant.state.x[i] = -plant.state.x[i];
        plant.state.c[i] = -plant.state.c[i];
    }
    step_plant(&plant, 0, 3000);
    cartesian(&plant, to);
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-11, from[i], to[i]); /* roundings, amplified by the motion */
    }
}

/* By the trapezoidal rule: off by h^2. */
static double ledger_gap(double dt)
{
    mct_scene scene = scene_with(MCT_STEPPER_RK4, MCT_GRAVITY | MCT_SPRING | MCT_VISCOUS, 0.5, -0.5, 0.5, 1);
    *parameter_of(&scene, "length_friction") = 0.3;
    *parameter_of(&scene, "angle_friction") = 0.02;
    scene.dt = dt;
    mct_plant plant;
    start_plant(&plant, &scene);
    mct_evaluation now;
    const double before = energy_of(&plant);
    double work = 0;
    for (long k = 0; k < lround(4 / dt); k++) {
        for (int side = 0; side < 2; side++) {
            plant.input = 0.05;
            mct_plant_evaluate(&plant, &now);
            work += dt / 2 * energy_rate(&now);
            if (side == 0) {
                mct_plant_step(&plant, 0.05);
            }
        }
    }
    return fabs(energy_of(&plant) - before - work);
}

static void test_the_works_of_friction_and_torque_add_up_to_the_change_of_energy(void)
{
    const double coarse = ledger_gap(1e-3), fine = ledger_gap(0.5e-3);
    printf("ledger: gap %.1e J, halved %.1e J\n", coarse, fine);
    TEST_ASSERT_TRUE(coarse < 1e-5);
    TEST_ASSERT_TRUE(fine < coarse / 3.5);
}

/* With a torque or friction at the pivot there is nothing to follow at r = 0: the last state stays and is counted. */
static void test_a_torque_or_friction_that_meets_the_pivot_stops_the_run(void)
{
    const int steppers[] = {MCT_STEPPER_SEED, MCT_STEPPER_EULER, MCT_STEPPER_LEAP, MCT_STEPPER_RK4};
    for (int i = 0; i < 4; i++) {
        for (int with_friction = 0; with_friction < 2; with_friction++) {
            mct_scene scene =
                scene_with(steppers[i], MCT_SPRING | (with_friction ? MCT_VISCOUS : 0), 0.3, 0, 0, 0);
            set(&scene, 0.5, 20, 0);
            mct_plant plant;
            start_plant(&plant, &scene);
            step_plant(&plant, with_friction ? 0 : 1e-6, 1000); /* it is at the pivot after 248 ticks */
            TEST_ASSERT_TRUE(plant.diverged_ticks > 700);
            TEST_ASSERT_TRUE(plant.state.x[0] > 0 && plant.state.x[0] < 0.01);
            TEST_ASSERT_TRUE(fabs(plant.state.x[2]) < 3);
        }
    }
}

static void expect_refusal(const mct_scene *scene, const char *sentence)
{
    mct_plant plant;
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_plant_init(&plant, scene, &why));
    TEST_ASSERT_EQUAL_STRING(sentence, why.text);
}

static void test_what_a_step_cannot_follow_is_refused_with_the_reason(void)
{
    mct_scene scene = resonant(MCT_STEPPER_RK4);
    *parameter_of(&scene, "stiffness") = 1e8;
    expect_refusal(&scene,
                   "parameters.stiffness: found 100000000 N/m, an oscillation too fast for a step of this "
                   "length; allowed any with split3, else up to 2000000 N/m");
    scene = resonant(MCT_STEPPER_RK4);
    *parameter_of(&scene, "length_friction") = 5000;
    expect_refusal(
        &scene, "parameters.length_friction: found 5000 N s/m, a decay too fast for a step of this length; "
                "allowed any with split3, else up to 1000 N s/m");
    scene = resonant(MCT_STEPPER_RK4);
    scene.initial[0] = 0;
    expect_refusal(&scene, "initial.length: found 0 m, where the angle says nothing; allowed above 0 m");
    scene = resonant(MCT_STEPPER_RK4);
    scene.initial[0] = 0.01;
    *parameter_of(&scene, "angle_friction") = 0.2;
    expect_refusal(&scene,
                   "initial.length: found 0.01 m, where angle_friction acts too fast for a step of this "
                   "length; allowed from 0.02 m");
}

static void test_expo_does_not_suit(void)
{
    mct_plant plant;
    mct_message why = {""};
    const mct_scene scene = resonant(MCT_STEPPER_EXPO);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_plant_init(&plant, &scene, &why));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_without_rest_length_and_friction_the_ball_is_a_harmonic_oscillator);
    RUN_TEST(test_the_ball_passes_the_pivot_as_if_it_were_not_there);
    RUN_TEST(test_with_a_rest_length_the_ball_passes_the_pivot_at_any_distance);
    RUN_TEST(test_rk4_follows_the_textbooks_equation_to_a_billionth);
    RUN_TEST(test_each_stepper_has_its_order);
    RUN_TEST(test_split3_keeps_energy_on_a_spring_of_any_stiffness);
    RUN_TEST(test_leap_keeps_the_angular_momentum_about_the_pivot);
    RUN_TEST(test_leap_keeps_energy_for_a_thousand_seconds_near_where_it_was);
    RUN_TEST(test_leap_returns_to_its_start_when_reversed);
    RUN_TEST(test_the_works_of_friction_and_torque_add_up_to_the_change_of_energy);
    RUN_TEST(test_a_torque_or_friction_that_meets_the_pivot_stops_the_run);
    RUN_TEST(test_what_a_step_cannot_follow_is_refused_with_the_reason);
    RUN_TEST(test_expo_does_not_suit);
    return UNITY_END();
}

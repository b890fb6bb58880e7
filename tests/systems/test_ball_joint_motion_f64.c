/*
 * The ball joint in motion: a single particle against its equation in Cartesian coordinates and against the
 * great circles of the source's Figure 14, a body against Euler's law in quadruple precision, a symmetric top
 * against steady precession.
 */
#include <math.h>
#include <stdio.h>

#include "support/bodies.h"
#include "unity.h"

static int ball_joint;

void setUp(void)
{
    ball_joint = system_called("ball_joint");
}

void tearDown(void)
{
}

static mct_scene scene_with(const double *particles, int count, int stepper, uint32_t effects,
                            double friction)
{
    mct_scene scene = scene_of(ball_joint, stepper, effects);
    set_rows(&scene, 0, particles, 4 * count);
    *parameter_of(&scene, "friction") = friction;
    return scene;
}

static void set_motion(mct_scene *scene, const double *attitude, const double *w)
{
    memcpy(scene->initial, attitude, 4 * sizeof *attitude);
    memcpy(scene->initial + 4, w, 3 * sizeof *w);
}

static const double no_turn[4] = {1, 0, 0, 0};

/* --- a single particle --- */

static void place_of(const mct_plant *plant, double *x)
{
    mct_evaluation now;
    mct_plant_evaluate(plant, &now);
    memcpy(x, now.position[0], 3 * sizeof *x);
}

/*
 * With no force the particle runs x = b cos Wt + (w x b)/W sin Wt, W the part of w across b; the part along b
 * stays.
 */
static void check_great_circle(int stepper, const double *w, double duration, double tolerance)
{
    const double particle[4] = {1, sqrt(2), sqrt(2), 0};
    mct_scene scene = scene_with(particle, 1, stepper, 0, 0);
    mct_plant plant;
    const double *b = particle + 1;
    double velocity[3], square = 0, worst = 0, along = 0, kept = 0;
    set_motion(&scene, no_turn, w);
    start_plant(&plant, &scene);
    for (int i = 0; i < 3; i++) {
        velocity[i] = w[(i + 1) % 3] * b[(i + 2) % 3] - w[(i + 2) % 3] * b[(i + 1) % 3];
        square += velocity[i] * velocity[i];
        along += w[i] * b[i] / 2;
    }
    const double rate = sqrt(square) / 2;
    for (int tick = 1000; tick <= lround(1000 * duration); tick += 1000) {
        double x[3], spin = 0;
        step_plant(&plant, 0, 1000);
        place_of(&plant, x);
        for (int i = 0; i < 3; i++) {
            const double angle = rate * 1e-3 * tick;
            worst = fmax(worst, fabs(x[i] - b[i] * cos(angle) - velocity[i] / rate * sin(angle)));
            spin += mct_plant_value(&plant, 4 + i) * x[i] / 2;
        }
        kept = fmax(kept, fabs(spin - along));
    }
    printf("Figure 14 from (%g, %g, %g), %s: once round in %.4f s; off by %.1e m in %g s, spin by %.1e\n",
           w[0], w[1], w[2], mct_steppers[stepper].name, 6.283185307179586 / rate, worst, duration, kept);
    TEST_ASSERT_TRUE(worst < tolerance);
    TEST_ASSERT_TRUE(kept < tolerance);
}

/* leap and euler: w h is 1e-3, order 2 and order 1. */
static void test_a_free_particle_runs_a_great_circle_and_the_text_and_the_caption_of_figure_14_are_two(void)
{
    static const double text[3] = {0, 1, 1};
    static const double caption[3] = {0, 1, 0};
    check_great_circle(MCT_STEPPER_RK4, text, 20, 1e-11);
    check_great_circle(MCT_STEPPER_RK4, caption, 20, 1e-11);
    check_great_circle(MCT_STEPPER_LEAP, text, 20, 1e-4);
    check_great_circle(MCT_STEPPER_EULER, text, 20, 1e-1);
}

typedef struct {
    quad mass, square, friction; /* square of the length */
    quad gravity[3];
} spherical_pendulum;

/* m xdd = m g - nu v / l^2 - (g.x + v^2) m x / l^2: the friction's torque nu w across the rod as a force. */
static void pendulum_rate(const void *model, quad time, const quad *x, quad *dx)
{
    const spherical_pendulum *self = model;
    quad pull = 0;
    (void)time;
    for (int i = 0; i < 3; i++) {
        pull += self->gravity[i] * x[i] + x[3 + i] * x[3 + i];
    }
    for (int i = 0; i < 3; i++) {
        dx[i] = x[3 + i];
        dx[3 + i] = self->gravity[i] - self->friction / (self->mass * self->square) * x[3 + i] -
                    pull / self->square * x[i];
    }
}

static double pendulum_reference(const spherical_pendulum *model, const quad *start, quad *end)
{
    quad coarse[6];
    double worst = 0;
    memcpy(coarse, start, sizeof coarse);
    memcpy(end, start, sizeof coarse);
    quad_extrapolate(pendulum_rate, model, 0, coarse, 6, 5, 400);
    quad_extrapolate(pendulum_rate, model, 0, end, 6, 5, 800);
    for (int i = 0; i < 6; i++) {
        worst = fmax(worst, (double)quad_abs(coarse[i] - end[i]));
    }
    return worst;
}

/*
 * The last one stands 1 mrad from upright: it amplifies an error of its start, and the comparison is divided
 * by that.
 */
static void test_a_single_particle_is_a_spherical_pendulum_in_quadruple_precision(void)
{
    static const struct {
        const char *name;
        double particle[4], friction, w[3];
        bool amplifies;
    } motions[] = {
        {"swings, with a spin that means nothing", {0.1, 0.3, -0.1, 0}, 0, {3, 5, -2}, false},
        {"with friction", {0.2, 0.2, 0, 0.1}, 0.002, {0, 4, 6}, false},
        {"1 mrad from upright", {0.1, 3e-4, 0.3, 0}, 0, {0, 0, 0}, true},
    };
    for (int i = 0; i < 3; i++) {
        const double *b = motions[i].particle + 1;
        mct_scene scene = scene_with(motions[i].particle, 1, MCT_STEPPER_RK4, MCT_GRAVITY | MCT_VISCOUS,
                                     motions[i].friction);
        spherical_pendulum model = {.mass = (quad)motions[i].particle[0],
                                    .friction = (quad)motions[i].friction,
                                    .gravity = {0, (quad)-9.81, 0}};
        quad start[6], end[6], nudged[6];
        double x[3], worst = 0, growth = 1;
        set_motion(&scene, no_turn, motions[i].w);
        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            start[k] = (quad)b[k];
            start[3 + k] = (quad)motions[i].w[l] * (quad)b[m] - (quad)motions[i].w[m] * (quad)b[l];
            model.square += start[k] * start[k];
        }
        TEST_ASSERT_TRUE(pendulum_reference(&model, start, end) < 1e-14);
        if (motions[i].amplifies) {
            const quad nudge = (quad)1e-12;
            start[3] += nudge;
            quad_extrapolate(pendulum_rate, &model, 0, memcpy(nudged, start, sizeof nudged), 6, 5, 200);
            growth = fmax(1, (double)(quad_abs(nudged[0] - end[0]) / nudge));
        }
        mct_plant plant;
        start_plant(&plant, &scene);
        step_plant(&plant, 0, 5000);
        place_of(&plant, x);
        for (int k = 0; k < 3; k++) {
            worst = fmax(worst, fabs(x[k] - (double)end[k]));
        }
        printf("%s, 5 s at 1 ms: rk4 %.1e m, growth %.1e\n", motions[i].name, worst, growth);
        TEST_ASSERT_TRUE(worst < 1e-9 * growth);
    }
}

/*
 * What gravity leaves alone: energy and the angular momentum about the vertical, over half a million swings'
 * steps.
 */
static void test_a_spherical_pendulum_keeps_energy_and_vertical_angular_momentum_over_a_million_steps(void)
{
    static const struct {
        int stepper;
        double allowed;
    } cases[] = {{MCT_STEPPER_EULER, 2e-2}, {MCT_STEPPER_LEAP, 1e-4}, {MCT_STEPPER_RK4, 1e-7}};
    static const double particle[4] = {0.1, 0.2, -0.2, 0};
    static const double w[3] = {1, 3, 0};
    for (int c = 0; c < 3; c++) {
        mct_scene scene = scene_with(particle, 1, cases[c].stepper, MCT_GRAVITY, 0);
        mct_plant plant;
        double worst[2] = {0}, first[2] = {0};
        set_motion(&scene, no_turn, w);
        start_plant(&plant, &scene);
        for (int k = 0; k <= 1000; k++) {
            mct_evaluation now;
            mct_plant_evaluate(&plant, &now);
            double momentum = 0;
            for (int j = 0; j < 3; j++) {
                momentum += now.M[1][j] * mct_plant_value(&plant, 4 + j);
            }
            const double kept[2] = {now.kinetic_energy + now.potential_energy, momentum};
            for (int j = 0; j < 2; j++) {
                first[j] = k == 0 ? kept[j] : first[j];
                worst[j] = fmax(worst[j], fabs(kept[j] - first[j]));
            }
            step_plant(&plant, 0, 1000);
        }
        printf("%s, 1e6 steps: energy off by %.1e J of %.2f, angular momentum by %.1e of %.3f\n",
               mct_steppers[cases[c].stepper].name, worst[0], first[0], worst[1], first[1]);
        TEST_ASSERT_TRUE(worst[0] < cases[c].allowed * 0.2);
        TEST_ASSERT_TRUE(worst[1] < cases[c].allowed * first[1]);
    }
}

/* --- bodies --- */

static const double lumps[16] = {0.3, 0.4, 0.1,  0,   0.2, -0.2, 0.5, 0.1,
                                 0.1, 0,   -0.7, 0.4, 0.2, 0.1,  0.2, -0.6};
static const double tilted[4] = {0.9, 0.3, -0.2, 0.25};
static const double turning[3] = {2, -3, 4};

static double lumps_error(int stepper, double dt, double duration, const quad *expected, quad *start)
{
    mct_scene scene = scene_with(lumps, 4, stepper, MCT_GRAVITY | MCT_VISCOUS, 0.01);
    mct_plant plant;
    quad end[BODY_STATES];
    scene.dt = dt;
    set_motion(&scene, tilted, turning);
    start_plant(&plant, &scene);
    body_of_plant(&plant, start);
    step_plant(&plant, 0, lround(duration / dt));
    body_of_plant(&plant, end);
    return expected == NULL ? 0 : body_distance(end, expected);
}

static double lumps_reference(double duration, textbook_body *body, quad *start, quad *end)
{
    static const double pivot[3] = {0};
    const mct_scene scene = scene_with(lumps, 4, MCT_STEPPER_RK4, MCT_GRAVITY | MCT_VISCOUS, 0.01);
    *body = body_of_rows(&scene, pivot);
    body->is_on_pivot = true;
    body->gravity[1] = (quad)-9.81;
    body->friction = (quad)0.01;
    (void)lumps_error(MCT_STEPPER_RK4, 1e-3, 0, NULL, start);
    return body_reference(body, start, duration, end);
}

static void test_a_body_on_a_pivot_follows_eulers_law_in_quadruple_precision(void)
{
    quad start[BODY_STATES], end[BODY_STATES];
    textbook_body body;
    TEST_ASSERT_TRUE(lumps_reference(5, &body, start, end) < 1e-14);
    const double growth = body_growth(&body, start, 5, end);
    printf("four particles with friction, 5 s at 1 ms, growth %.1e:", growth);
    FOR_EACH_STEPPER (stepper, ball_joint, MCT_GRAVITY | MCT_VISCOUS) {
        printf(" %s %.1e", mct_steppers[stepper].name, lumps_error(stepper, 1e-3, 5, end, start));
    }
    printf("\n");
    TEST_ASSERT_TRUE(lumps_error(MCT_STEPPER_RK4, 1e-3, 5, end, start) < 1e-9);
}

static void test_each_stepper_has_its_order_with_all_effects(void)
{
    quad start[BODY_STATES], end[BODY_STATES];
    textbook_body body;
    (void)lumps_reference(1, &body, start, end);
    FOR_EACH_STEPPER (stepper, ball_joint, MCT_GRAVITY | MCT_VISCOUS) {
        if (mct_steppers[stepper].needs_smooth) {
            continue; /* at rounding by 2 ms: tests/steppers/test_order_f64.c */
        }
        const double coarse = lumps_error(stepper, 4e-3, 1, end, start);
        const double order = log2(coarse / lumps_error(stepper, 2e-3, 1, end, start));
        printf("%s: order %.2f\n", mct_steppers[stepper].name, order);
        TEST_ASSERT_DOUBLE_WITHIN(0.2, mct_steppers[stepper].order, order);
    }
}

/*
 * Three balls on a ring, A about the pivot across the axis, C along it: with the axis at th from upright it
 * goes round the vertical at p where A cos th p^2 - C s p + m g l = 0, s being the part of w along the axis.
 */
static void test_a_symmetric_top_precesses_steadily(void)
{
    const double ring = 0.2, height = 0.1, mass = 0.05, tilt = 0.5, spin = 12;
    const double half = ring / 2, side = ring * sqrt(3) / 2;
    const double particles[12] = {mass,   ring, height, 0,     mass,   -half,
                                  height, side, mass,   -half, height, -side};
    const double C = 3 * mass * ring * ring;
    const double A = C / 2 + 3 * mass * height * height;
    const double moment = 3 * mass * 9.81 * height;
    const double slow = 2 * moment / (C * spin + sqrt(C * C * spin * spin - 4 * A * cos(tilt) * moment));
    const double fast = moment / (A * cos(tilt) * slow);
    const double rates[2] = {slow, fast};
    for (int i = 0; i < 2; i++) {
        const double p = rates[i];
        const double attitude[4] = {cos(tilt / 2), 0, 0, sin(tilt / 2)}; /* the axis leans to the left */
        const double axis[3] = {-sin(tilt), cos(tilt), 0};
        const double own = spin - p * cos(tilt);
        const double w[3] = {own * axis[0], p + own * axis[1], 0};
        mct_scene scene = scene_with(particles, 3, MCT_STEPPER_RK4, MCT_GRAVITY, 0);
        mct_plant plant;
        double worst = 0;
        set_motion(&scene, attitude, w);
        start_plant(&plant, &scene);
        for (int second = 1; second <= 5; second++) {
            step_plant(&plant, 0, 1000);
            mct_evaluation now;
            mct_plant_evaluate(&plant, &now);
            const double angle = p * second; /* about the vertical */
            const double expected[3] = {-sin(tilt) * cos(angle), cos(tilt), sin(tilt) * sin(angle)};
            for (int k = 0; k < 3; k++) {
                const double centre = (now.position[0][k] + now.position[1][k] + now.position[2][k]) / 3;
                worst = fmax(worst, fabs(centre / height - expected[k]));
            }
        }
        printf("steady precession at %.3f rad/s, spin %g rad/s: axis off by %.1e rad in 5 s\n", p, spin,
               worst);
        TEST_ASSERT_TRUE(worst < 1e-8);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_free_particle_runs_a_great_circle_and_the_text_and_the_caption_of_figure_14_are_two);
    RUN_TEST(test_a_single_particle_is_a_spherical_pendulum_in_quadruple_precision);
    RUN_TEST(test_a_spherical_pendulum_keeps_energy_and_vertical_angular_momentum_over_a_million_steps);
    RUN_TEST(test_a_body_on_a_pivot_follows_eulers_law_in_quadruple_precision);
    RUN_TEST(test_each_stepper_has_its_order_with_all_effects);
    RUN_TEST(test_a_symmetric_top_precesses_steadily);
    return UNITY_END();
}

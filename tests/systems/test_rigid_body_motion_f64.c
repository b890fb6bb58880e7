/*
 * The free rigid body in motion: against Euler's laws in quadruple precision, against Jacobi's elliptic
 * functions, and the orders of its steppers with everything on.
 */
#include <math.h>
#include <stdio.h>

#include "support/bodies.h"
#include "unity.h"

static int rigid_body;

void setUp(void)
{
    rigid_body = system_called("rigid_body");
}

void tearDown(void)
{
}

/* --- motions --- */

typedef struct {
    const char *name;
    double duration;
    uint32_t effects;
    double particles[16]; /* 4 of them, or none and moments */
    double moments[3];
    double forces[14]; /* 2 */
    double velocity[3], w[3];
} motion;

/*
 * The third flips over again and again. The last one is about to: all that it does in 11 s is to amplify an
 * error.
 */
static const motion motions[] = {
    {.name = "moments 1, 2, 3, free", .duration = 5, .effects = 0, .moments = {1, 2, 3}, .w = {0.5, 2, 0.3}},
    {.name = "four particles, thrown, pushed and dragged",
     .duration = 5,
     .effects = MCT_GRAVITY | MCT_FORCES | MCT_DRAG,
     .particles = {0.3, 0.2, 0.1, 0, 0.2, -0.1, 0.3, 0.1, 0.5, 0, -0.2, 0.2, 0.1, 0.1, 0.1, -0.4},
     .forces = {0, 0.1, 0.2, 0, 0.05, 0.04, -0.03, 1, -0.1, 0, 0.3, 0.02, 0, 0.05},
     .velocity = {2, 5, -1},
     .w = {1, -2, 3}},
    {.name = "flipping about the middle axis",
     .duration = 11,
     .effects = 0,
     .moments = {1, 2, 3},
     .w = {0.05, 6, 0.05}},
    {.name = "spun about the middle axis",
     .duration = 11,
     .effects = 0,
     .moments = {1, 2, 3},
     .w = {1e-9, 2.7, 1e-9}},
};
enum { MOTIONS = sizeof motions / sizeof motions[0] };

static mct_scene scene_of_motion(const motion *self, int stepper, double dt)
{
    mct_scene scene = scene_of(rigid_body, stepper, self->effects);
    scene.dt = dt;
    set_rows(&scene, 1, self->forces, 14);
    if (self->moments[0] > 0) {
        set_rows(&scene, 0, NULL, 0);
        *parameter_of(&scene, "mass") = 1;
        *parameter_of(&scene, "inertia_1_1") = self->moments[0];
        *parameter_of(&scene, "inertia_2_2") = self->moments[1];
        *parameter_of(&scene, "inertia_3_3") = self->moments[2];
    } else {
        set_rows(&scene, 0, self->particles, 16);
    }
    *parameter_of(&scene, "drag") = 0.02;
    *parameter_of(&scene, "angular_drag") = 0.001;
    for (int i = 0; i < 3; i++) {
        scene.initial[7 + i] = self->velocity[i];
        scene.initial[10 + i] = self->w[i];
    }
    return scene;
}

static textbook_body textbook_of(const motion *self, mct_scene *scene)
{
    double centre[3] = {0}, mass = 0;
    textbook_body body = {.mass = 1};
    if (self->moments[0] > 0) {
        for (int i = 0; i < 3; i++) {
            body.inertia[i][i] = self->moments[i];
        }
    } else {
        for (int n = 0; n < 16; n += 4) {
            mass += self->particles[n];
            for (int i = 0; i < 3; i++) {
                centre[i] += self->particles[n] * self->particles[n + 1 + i];
            }
        }
        for (int i = 0; i < 3; i++) {
            centre[i] /= mass;
        }
        body = body_of_rows(scene, centre);
        memset(body.first_moment, 0, sizeof body.first_moment);
    }
    body.gravity[1] = (self->effects & MCT_GRAVITY) ? (quad)-9.81 : 0;
    body.drag = (self->effects & MCT_DRAG) ? (quad)0.02 : 0;
    body.angular_drag = (self->effects & MCT_DRAG) ? (quad)0.001 : 0;
    body.forces = (self->effects & MCT_FORCES) ? 2 : 0;
    for (int n = 0; n < 2; n++) {
        body.in_body[n] = self->forces[7 * n] == 1;
        for (int i = 0; i < 3; i++) {
            body.point[n][i] = (quad)self->forces[7 * n + 1 + i] - (quad)centre[i];
            body.force[n][i] = (quad)self->forces[7 * n + 4 + i];
        }
    }
    return body;
}

static double error_of(const motion *self, int stepper, double dt, double duration, const quad *expected)
{
    const mct_scene scene = scene_of_motion(self, stepper, dt);
    mct_plant plant;
    quad end[BODY_STATES];
    start_plant(&plant, &scene);
    step_plant(&plant, 0, lround(duration / dt));
    body_of_plant(&plant, end);
    return body_distance(end, expected);
}

static double reference_of_motion(const motion *self, double duration, quad *start, quad *end,
                                  textbook_body *body)
{
    mct_scene scene = scene_of_motion(self, MCT_STEPPER_RK4, 1e-3);
    mct_plant plant;
    *body = textbook_of(self, &scene);
    start_plant(&plant, &scene);
    body_of_plant(&plant, start);
    return body_reference(body, start, duration, end);
}

static void test_motion_follows_eulers_laws_in_quadruple_precision(void)
{
    for (int i = 0; i < MOTIONS; i++) {
        quad start[BODY_STATES], end[BODY_STATES];
        textbook_body body;
        const double duration = motions[i].duration;
        const double inexact = reference_of_motion(&motions[i], duration, start, end, &body);
        const double growth = body_growth(&body, start, duration, end);
        TEST_ASSERT_TRUE(inexact < 1e-14);
        printf("%s, %g s at 1 ms, growth %.1e:", motions[i].name, duration, growth);
        FOR_EACH_STEPPER (stepper, rigid_body, motions[i].effects) {
            printf(" %s %.1e", mct_steppers[stepper].name,
                   error_of(&motions[i], stepper, 1e-3, duration, end));
        }
        printf("\n");
        TEST_ASSERT_TRUE(error_of(&motions[i], MCT_STEPPER_RK4, 1e-3, duration, end) <
                         1e-9 * (growth > 1e6 ? growth : 1));
    }
}

static void test_each_stepper_has_its_order_with_all_effects(void)
{
    quad start[BODY_STATES], end[BODY_STATES];
    textbook_body body;
    (void)reference_of_motion(&motions[1], 1, start, end, &body);
    FOR_EACH_STEPPER (stepper, rigid_body, motions[1].effects) {
        const double coarse = error_of(&motions[1], stepper, 4e-3, 1, end);
        const double order = log2(coarse / error_of(&motions[1], stepper, 2e-3, 1, end));
        printf("%s: order %.2f\n", mct_steppers[stepper].name, order);
        TEST_ASSERT_DOUBLE_WITHIN(0.2, mct_steppers[stepper].order, order);
    }
}

/* --- Jacobi's elliptic functions, by Gauss's arithmetic-geometric mean (Abramowitz and Stegun, 16.4) --- */

static void jacobi(double u, double m, double *sn, double *cn, double *dn)
{
    enum { LEVELS = 8 };
    double a[LEVELS + 1] = {1}, c[LEVELS + 1], b = sqrt(1 - m);
    for (int n = 0; n < LEVELS; n++) {
        a[n + 1] = (a[n] + b) / 2;
        c[n + 1] = (a[n] - b) / 2;
        b = sqrt(a[n] * b);
    }
    double phi = 256 * a[LEVELS] * u; /* 2^LEVELS */
    for (int n = LEVELS; n > 0; n--) {
        phi = (phi + asin(c[n] / a[n] * sin(phi))) / 2;
    }
    *sn = sin(phi);
    *cn = cos(phi);
    *dn = sqrt(1 - m * *sn * *sn);
}

/*
 * Free, with I1 < I2 < I3 and L^2 > 2 E I2, from w2 = 0: w1 = a cn, w2 = b sn, w3 = c dn (Landau, Lifshitz,
 * Mechanics, section 37). Attitude: the angular momentum stays in space.
 */
static void test_a_free_body_turns_by_the_elliptic_functions_and_keeps_its_angular_momentum(void)
{
    static const double I[3] = {1, 2, 3};
    static const double start[3] = {0.9, 0, 1.3};
    const motion free_body = {.effects = 0, .moments = {1, 2, 3}, .w = {0.9, 0, 1.3}};
    const double twice_energy = I[0] * 0.81 + I[2] * 1.69;
    const double square = I[0] * I[0] * 0.81 + I[2] * I[2] * 1.69;
    const double most = sqrt((twice_energy * I[2] - square) / (I[1] * (I[2] - I[1])));
    const double rate = sqrt((I[2] - I[1]) * (square - twice_energy * I[0]) / (I[0] * I[1] * I[2]));
    const double m =
        (I[1] - I[0]) * (twice_energy * I[2] - square) / ((I[2] - I[1]) * (square - twice_energy * I[0]));
    const mct_scene scene = scene_of_motion(&free_body, MCT_STEPPER_RK4, 1e-3);
    mct_plant plant;
    double worst = 0, turned = 0;
    start_plant(&plant, &scene);
    for (int second = 1; second <= 10; second++) {
        double sn, cn, dn;
        quad x[BODY_STATES], r[3][3];
        step_plant(&plant, 0, 1000);
        jacobi(rate * second, m, &sn, &cn, &dn);
        const double expected[3] = {start[0] * cn, most * sn, start[2] * dn};
        body_of_plant(&plant, x);
        quad_matrix(x, r);
        for (int i = 0; i < 3; i++) {
            quad momentum = 0;
            for (int j = 0; j < 3; j++) {
                momentum += r[i][j] * (quad)I[j] * x[BODY_W + j];
            }
            worst = fmax(worst, fabs((double)x[BODY_W + i] - expected[i]));
            turned = fmax(turned, fabs((double)momentum - I[i] * start[i]));
        }
    }
    printf("rk4, 10 s at 1 ms: off the elliptic functions by %.1e rad/s, angular momentum by %.1e\n", worst,
           turned);
    TEST_ASSERT_TRUE(worst < 1e-11);
    TEST_ASSERT_TRUE(turned < 1e-11);
}

/*
 * A body that is described twice, by its particles and by the mass, inertia and centre that follow from them.
 */
static void test_both_descriptions_of_a_body_move_alike(void)
{
    mct_scene scene = scene_of_motion(&motions[1], MCT_STEPPER_RK4, 1e-3);
    const textbook_body body = textbook_of(&motions[1], &scene);
    mct_plant plant;
    quad listed[BODY_STATES], described[BODY_STATES];
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 2000);
    body_of_plant(&plant, listed);
    double first[3] = {0};
    for (int n = 0; n < 16; n += 4) {
        for (int i = 0; i < 3; i++) {
            first[i] += motions[1].particles[n] * motions[1].particles[n + 1 + i];
        }
    }
    set_rows(&scene, 0, NULL, 0);
    *parameter_of(&scene, "mass") = (double)body.mass;
    for (int i = 0; i < 3; i++) {
        *(parameter_of(&scene, "centre_1") + i) = first[i] / (double)body.mass;
        for (int j = 0; j < 3; j++) {
            *(parameter_of(&scene, "inertia_1_1") + 3 * i + j) = (double)body.inertia[i][j];
        }
    }
    start_plant(&plant, &scene);
    TEST_ASSERT_EQUAL_INT(6, mct_particle_count(&scene));
    step_plant(&plant, 0, 2000);
    body_of_plant(&plant, described);
    TEST_ASSERT_TRUE(body_distance(listed, described) < 1e-12);
}

static void test_a_body_that_is_described_twice_is_refused_with_one_particle_as_well(void)
{
    static const char text[] = "[scene]\nsystem = \"rigid_body\"\n"
                               "[parameters]\nparticles = [[1, 0, 0, 0.1]]\nmass = 2\n";
    mct_scene scene;
    mct_message why = {""};
    TEST_ASSERT_TRUE(mct_scene_read(text, sizeof text - 1, "text", NULL, 0, &scene, &why) != MCT_OK);
    TEST_ASSERT_TRUE_MESSAGE(strstr(why.text, "parameters.mass: found 2 kg beside 1 particle;") != NULL,
                             why.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_motion_follows_eulers_laws_in_quadruple_precision);
    RUN_TEST(test_each_stepper_has_its_order_with_all_effects);
    RUN_TEST(test_a_free_body_turns_by_the_elliptic_functions_and_keeps_its_angular_momentum);
    RUN_TEST(test_both_descriptions_of_a_body_move_alike);
    RUN_TEST(test_a_body_that_is_described_twice_is_refused_with_one_particle_as_well);
    return UNITY_END();
}

/*
 * The motion in a rotating frame against closed forms: in space the mass runs a straight line or a parabola, or is
 * slowed along its line by the air; and each apparent force alone has a motion that is known.
 *
 * The references are computed in long double from rotation matrices written out by the rule of Rodrigues; they share
 * nothing with src/.
 */
#include <complex.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/scenes.h"
#include "unity.h"

#define APPARENT (MCT_CENTRIFUGAL | MCT_CORIOLIS | MCT_EULER_FORCE)

enum { N = 3 };

void setUp(void)
{
}

void tearDown(void)
{
}

typedef long double real;

static mct_scene frame_scene(int stepper, uint32_t effects)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, "rotating_frame") == 0) {
            return scene_of(i, stepper, effects);
        }
    }
    TEST_FAIL_MESSAGE("rotating_frame");
    return (mct_scene){0};
}

static void set_vector(mct_scene *scene, const char *name, const double *values)
{
    char first[64];
    snprintf(first, sizeof first, "%s_1", name);
    memcpy(parameter_of(scene, first), values, 3 * sizeof *values);
}

static void get_vector(mct_scene *scene, const char *name, real *values)
{
    char first[64];
    snprintf(first, sizeof first, "%s_1", name);
    for (int i = 0; i < 3; i++) {
        values[i] = parameter_of(scene, first)[i];
    }
}

static void rotation_of(mct_scene *scene, real t, real r[3][3])
{
    real w0[3], al0[3], n[3];
    get_vector(scene, "angular_velocity", w0);
    get_vector(scene, "angular_acceleration", al0);
    for (int i = 0; i < 3; i++) {
        n[i] = t * w0[i] + t * t / 2 * al0[i];
    }
    const real a = sqrtl(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int i = 0; i < 3; i++) {
        n[i] = a > 0 ? n[i] / a : 0;
    }
    const real skew[3][3] = {{0, -n[2], n[1]}, {n[2], 0, -n[0]}, {-n[1], n[0], 0}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            r[i][j] = (i == j ? cosl(a) : 0) + (1 - cosl(a)) * n[i] * n[j] + sinl(a) * skew[i][j];
        }
    }
}

/* Position in space of a mass at q in the frame. */
static void in_space(mct_scene *scene, real t, const real *q, real *x)
{
    real r[3][3];
    rotation_of(scene, t, r);
    for (int i = 0; i < 3; i++) {
        x[i] = r[i][0] * q[0] + r[i][1] * q[1] + r[i][2] * q[2];
    }
}

/* Position in space by the closed form: a parabola; with drag, and then no force, x0 + v0 ln(1 + c v0 t) / (c v0). */
static void reference_at(mct_scene *scene, real t, real *x)
{
    real w0[3], force[3];
    get_vector(scene, "angular_velocity", w0);
    get_vector(scene, "force", force);
    const real m = *parameter_of(scene, "mass");
    const double *q = scene->initial;
    const double *v = scene->initial + N;
    real v0[3];
    for (int i = 0; i < 3; i++) {
        v0[i] = v[i] + (w0[(i + 1) % 3] * q[(i + 2) % 3] - w0[(i + 2) % 3] * q[(i + 1) % 3]);
    }
    const real c = (scene->effects & MCT_DRAG) ? *parameter_of(scene, "drag") / m : 0;
    const real slowed = c * sqrtl(v0[0] * v0[0] + v0[1] * v0[1] + v0[2] * v0[2]);
    for (int i = 0; i < 3; i++) {
        real a = force[i] / m;
        if (i == 1 && (scene->effects & MCT_GRAVITY)) {
            a -= *parameter_of(scene, "gravity");
        }
        x[i] = q[i] + v0[i] * (slowed > 0 ? log1pl(slowed * t) / slowed : t) + a * t * t / 2;
    }
}

/* Largest distance in space from the closed form over a run, and of the velocity at its end, by the way's length. */
static double worst_error(mct_scene scene, double duration)
{
    mct_plant plant;
    double worst = 0;
    double size = 1;
    start_plant(&plant, &scene);
    const long ticks = lround(duration / scene.dt);
    for (long k = 1; k <= ticks; k++) {
        mct_plant_step(&plant, 0);
        real q[3], x[3], wanted[3];
        for (int i = 0; i < 3; i++) {
            q[i] = mct_plant_value(&plant, i);
        }
        const real t = (real)scene.dt * k;
        in_space(&scene, t, q, x);
        reference_at(&scene, t, wanted);
        for (int i = 0; i < 3; i++) {
            worst = fmax(worst, (double)fabsl(x[i] - wanted[i]));
            size = fmax(size, (double)fabsl(wanted[i]));
        }
    }
    return worst / size;
}

typedef struct {
    const char *name;
    double w0[3], al0[3], force[3], start[6];
    uint32_t effects;
    double tolerance[2]; /* of rk4 and expo */
} motion;

/*
 * rk4 at 1 ms, 3 rad/s: h^4 w^5 t / 120, some 1e-11. The spun-up frame ends at 60 rad/s: 1e-5, where expo has its
 * rounding alone, some 1e-16 of an angle of up to 150 rad.
 */
static const motion motions[] = {
    {"cannon", {0, 0, 1}, {0, 0, 0}, {0, 0, 0}, {0, -1, 0, 0, 0.8, 0}, APPARENT, {1e-12, 1e-13}},
    {"fountain",
     {0, 2, 0},
     {0, 0, 0},
     {0.3, 0, 0.1},
     {-1, 0, 0, 0.7, 3, 0},
     APPARENT | MCT_GRAVITY,
     {1e-11, 1e-13}},
    {"axis that moves",
     {1, -2, 2},
     {0.2, 0.1, -0.1},
     {1, 0, -2},
     {1, 2, 3, -1, 0, 1},
     APPARENT | MCT_GRAVITY,
     {1e-9, 1e-12}},
    {"spun up", {0, 0, 10}, {0, 0, 10}, {0, 0, 0}, {1, 0, 1, -5, 0, 0}, APPARENT, {1e-4, 1e-12}},
};

static mct_scene scene_of_motion(const motion *m, int stepper)
{
    mct_scene scene = frame_scene(stepper, m->effects);
    *parameter_of(&scene, "mass") = 0.5;
    set_vector(&scene, "angular_velocity", m->w0);
    set_vector(&scene, "angular_acceleration", m->al0);
    set_vector(&scene, "force", m->force);
    memcpy(scene.initial, m->start, sizeof m->start);
    return scene;
}

static void test_in_space_the_mass_runs_a_straight_line_or_a_parabola(void)
{
    static const int steppers[] = {MCT_STEPPER_RK4, MCT_STEPPER_EXPO};
    for (size_t i = 0; i < sizeof motions / sizeof motions[0]; i++) {
        printf("%-16s", motions[i].name);
        for (int j = 0; j < 2; j++) {
            const double error = worst_error(scene_of_motion(&motions[i], steppers[j]), 5);
            printf(" %s %.1e", mct_steppers[steppers[j]].name, error);
            TEST_ASSERT_TRUE(error < motions[i].tolerance[j]);
        }
        printf("\n");
    }
}

/* Half a radian a step: rk4 leaves all bounds, the exact flow has rounding errors of an angle of 2500 rad. */
static void test_a_frame_that_turns_by_half_a_radian_a_step_is_followed_exactly_by_expo(void)
{
    motion fast = motions[0];
    fast.w0[2] = 500;
    const double exact = worst_error(scene_of_motion(&fast, MCT_STEPPER_EXPO), 5);
    printf("w h = 0.5: expo %.1e", exact);
    TEST_ASSERT_TRUE(exact < 3e-12);
    mct_scene scene = scene_of_motion(&fast, MCT_STEPPER_RK4);
    const double rk4 = worst_error(scene, 0.05);
    printf(", rk4 after 0.05 s %.1e\n", rk4);
    TEST_ASSERT_TRUE(rk4 > 1e-3);
}

/* rk4 is exact to h^4 here too, whatever the frame does: the line in space does not depend on it. */
static void test_air_at_rest_in_space_slows_the_mass_along_its_line(void)
{
    motion slowed = motions[2];
    slowed.effects = APPARENT | MCT_DRAG;
    memset(slowed.force, 0, sizeof slowed.force);
    mct_scene scene = scene_of_motion(&slowed, MCT_STEPPER_RK4);
    *parameter_of(&scene, "drag") = 0.1;
    const double error = worst_error(scene, 5);
    printf("drag: rk4 %.1e\n", error);
    TEST_ASSERT_TRUE(error < 1e-9);
}

static mct_plant moved(mct_scene scene, double duration)
{
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, lround(duration / scene.dt));
    return plant;
}

static void check_plane(const mct_plant *plant, double complex q, double complex v)
{
    const double size = 1 + cabs(q) + cabs(v);
    const double wanted[] = {creal(q), cimag(q), creal(v), cimag(v)};
    const double found[] = {mct_plant_value(plant, 0), mct_plant_value(plant, 1), mct_plant_value(plant, 3),
                            mct_plant_value(plant, 4)};
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-11 * size, wanted[i], found[i]);
    }
}

/* In the plane q = q1 + i q2: alone, the forces make q'' = w^2 q, q'' = - 2 i w q', q'' = - i al q. */
static void test_each_apparent_force_alone_does_what_it_does(void)
{
    const double w = 1.5;
    const double t = 2;
    const double complex q = 0.3 - 0.7 * I;
    const double complex v = -0.4 + 0.5 * I;
    const motion alone = {"", {0, 0, w}, {0, 0, 0}, {0, 0, 0}, {0.3, -0.7, 0, -0.4, 0.5, 0}, 0, {0, 0}};
    mct_scene scene = scene_of_motion(&alone, MCT_STEPPER_RK4);
    scene.effects = MCT_CENTRIFUGAL;
    mct_plant plant = moved(scene, t);
    check_plane(&plant, q * cosh(w * t) + v * sinh(w * t) / w, q * w * sinh(w * t) + v * cosh(w * t));
    scene.effects = MCT_CORIOLIS; /* a circle of radius |v| / 2 w, twice a turn of the frame */
    plant = moved(scene, t);
    const double complex turn = cexp(-2 * I * w * t);
    check_plane(&plant, q + v * (1 - turn) / (2 * I * w), v * turn);
    scene.effects = MCT_EULER_FORCE;
    *parameter_of(&scene, "angular_acceleration_3") = 0.9;
    plant = moved(scene, t);
    const double complex root = csqrt(-I * 0.9);
    check_plane(&plant, q * ccosh(root * t) + v * csinh(root * t) / root,
                q * root * csinh(root * t) + v * ccosh(root * t));
    scene.effects = 0;
    plant = moved(scene, t);
    check_plane(&plant, q + v * t, v);
}

/* The invariant of centrifugal and Coriolis force together: (v^2 - (w x q)^2) / 2, Jacobi's; rk4 drifts by h^5. */
static void test_jacobis_integral_stays_over_a_long_run(void)
{
    mct_scene scene = scene_of_motion(&motions[0], MCT_STEPPER_EXPO);
    mct_plant plant;
    start_plant(&plant, &scene);
    double worst = 0;
    for (int k = 1; k <= 100000; k++) {
        mct_plant_step(&plant, 0);
        double integral = 0, way = 0;
        for (int i = 0; i < 2; i++) {
            const double q = mct_plant_value(&plant, i);
            const double v = mct_plant_value(&plant, N + i);
            integral += (v * v - q * q) / 2;
            way += v * v + q * q;
        }
        worst = fmax(worst, fabs(integral - (0.64 - 1) / 2) / way);
    }
    printf("Jacobi's integral within %.1e of its terms over 100 s\n", worst);
    TEST_ASSERT_TRUE(worst < 1e-13);
}

/* log2 of the ratio of errors at two steps, within 0.25. */
static void test_each_stepper_converges_with_its_order(void)
{
    for (int stepper = 0; stepper <= MCT_STEPPER_RK4; stepper++) {
        const double coarse = mct_steppers[stepper].order == 1 ? 1e-3 : 8e-3;
        double error[2];
        for (int j = 0; j < 2; j++) {
            mct_scene scene = scene_of_motion(&motions[2], stepper);
            scene.dt = coarse / (1 << j);
            error[j] = worst_error(scene, 0.512);
        }
        const double order = log2(error[0] / error[1]);
        printf("%s %.2f ", mct_steppers[stepper].name, order);
        TEST_ASSERT_DOUBLE_WITHIN(0.25, mct_steppers[stepper].order, order);
    }
    printf("\n");
}

/* There and back: the Coriolis force changes its sign with the frame's sense and the velocity. */
static void test_leap_returns_to_its_start_when_motion_and_frame_are_reversed(void)
{
    mct_scene scene = scene_of_motion(&motions[0], MCT_STEPPER_LEAP);
    mct_plant there = moved(scene, 5);
    *parameter_of(&scene, "angular_velocity_3") *= -1;
    for (int i = 0; i < N; i++) {
        scene.initial[i] = mct_plant_value(&there, i);
        scene.initial[N + i] = -mct_plant_value(&there, N + i);
    }
    const mct_plant back = moved(scene, 5);
    for (int i = 0; i < N; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, motions[0].start[i], mct_plant_value(&back, i));
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, -motions[0].start[N + i], mct_plant_value(&back, N + i));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_in_space_the_mass_runs_a_straight_line_or_a_parabola);
    RUN_TEST(test_a_frame_that_turns_by_half_a_radian_a_step_is_followed_exactly_by_expo);
    RUN_TEST(test_air_at_rest_in_space_slows_the_mass_along_its_line);
    RUN_TEST(test_each_apparent_force_alone_does_what_it_does);
    RUN_TEST(test_jacobis_integral_stays_over_a_long_run);
    RUN_TEST(test_each_stepper_converges_with_its_order);
    RUN_TEST(test_leap_returns_to_its_start_when_motion_and_frame_are_reversed);
    return UNITY_END();
}

/*
 * The rotating frame against the generic Gauss engine, which gets nothing but x = exp(R[u(t)]) q.
 *
 * The engine knows no single apparent force, but all three together, and the frame's angular velocity: its matrix
 * C = m J' Jdot is m R[w]. From these the terms are taken apart here as any textbook has them; what an effect set
 * leaves out is then a force of the engine's, and the engine's own constraint force is 0.
 *
 * Tolerances: 1e-12 in double; in float 4000 roundings, for angles of up to 40 rad, 4e-6 of which a float does not
 * know. Relative to the sizes of what meets in a result.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/gauss.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

enum { TRIALS = 10000, N = 3, TIME = 6 };
#define APPARENT  (MCT_CENTRIFUGAL | MCT_CORIOLIS | MCT_EULER_FORCE)
#define TOLERANCE (MCT_REAL_IS_FLOAT ? 4000 * (double)FLT_EPSILON : 1e-12)

static const uint32_t switches[] = {MCT_GRAVITY, MCT_DRAG, MCT_CENTRIFUGAL, MCT_CORIOLIS, MCT_EULER_FORCE};

void setUp(void)
{
}

void tearDown(void)
{
}

static void cross(const double *a, const double *b, double *c)
{
    for (int i = 0; i < 3; i++) {
        c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

static double norm(const double *a)
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static double *vector_of(mct_scene *scene, const char *name)
{
    char first[64];
    snprintf(first, sizeof first, "%s_1", name);
    return parameter_of(scene, first); /* the other two follow */
}

/* One random case. */
typedef struct {
    mct_scene scene;
    const mct_system *system;
    mct_constants constants;
    mct_real x[MCT_MAX_STATES];
    mct_evaluation out;
    double r[3][3]; /* from the frame's axes to those of space, by place() */
    mct_gauss_system engine;
    mct_gauss_workspace workspace;
    mct_gauss_motion motion;
    double w[3], centrifugal[3], coriolis[3], euler[3], missing[3]; /* by mass */
} trial;

static void place(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const trial *self = context;
    self->system->place(&self->constants, time, q, position);
}

static void randomise(trial *self, test_random *random, int k)
{
    memset(self, 0, sizeof *self);
    uint32_t effects = 0;
    for (int i = 0; i < 5; i++) {
        effects |= ((k >> i) & 1) ? switches[i] : 0;
    }
    self->scene = scene_of(system_called("rotating_frame"), MCT_STEPPER_RK4, effects);
    self->system = mct_systems[self->scene.system];
    *parameter_of(&self->scene, "mass") = random_scale(random, 0.01, 100);
    *parameter_of(&self->scene, "drag") = random_scale(random, 0.001, 10);
    *parameter_of(&self->scene, "gravity") = random_scale(random, 0.1, 30);
    double *w0 = vector_of(&self->scene, "angular_velocity");
    double *al0 = vector_of(&self->scene, "angular_acceleration");
    double *force = vector_of(&self->scene, "force");
    const double share = random_in(random, -1, 1);
    for (int i = 0; i < 3; i++) {
        w0[i] = (k / 32) % 7 == 0 ? 0 : random_in(random, -3, 3);
        /* every third frame turns about a fixed axis, some without a rate at the start, some evenly */
        al0[i] = (k / 32) % 3 == 0 ? ((k / 96) % 2 ? 0 : share * w0[i]) : random_in(random, -2, 2);
        force[i] = random_in(random, -5, 5);
        self->x[i] = (mct_real)random_in(random, -2, 2);
        self->x[N + i] = (mct_real)random_in(random, -3, 3);
    }
    self->x[TIME] = (mct_real)((k / 32) % 5 == 0 ? random_scale(random, 1e-6, 0.1) : random_in(random, 0, 5));
    TEST_ASSERT_EQUAL_INT(MCT_OK, self->system->prepare(&self->scene, 1e-3, &self->constants, NULL));
    self->system->evaluate(&self->constants, effects, self->x, 0, &self->out);
}

static void run_engine(trial *self)
{
    const uint32_t effects = self->scene.effects;
    const mct_real mass[1] = {self->out.mass[0]};
    const double m = (double)mass[0];
    double q[3], v[3], inner[3];
    self->engine = (mct_gauss_system){1, N, mass, place, self};
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_kinematics(&self->engine, self->x[TIME], self->x, self->x + N,
                                                       &self->workspace, &self->motion));
    for (int i = 0; i < 3; i++) {
        mct_hyperdual unit[3] = {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}, there[1][3];
        unit[i].value = 1;
        place(self, mct_hyperdual_constant(self->x[TIME]), unit, there);
        for (int j = 0; j < 3; j++) {
            self->r[j][i] = (double)there[0][j].value;
        }
        q[i] = (double)self->x[i];
        v[i] = (double)self->x[N + i];
        self->w[i] = (double)self->motion.C[(i + 2) % 3][(i + 1) % 3] / m;
    }
    cross(self->w, q, inner);
    cross(self->w, inner, self->centrifugal);
    cross(self->w, v, self->coriolis);
    mct_real force[3];
    double drag[3], push[3];
    const double speed =
        norm((double[3]){(double)self->motion.velocity[0][0], (double)self->motion.velocity[0][1],
                         (double)self->motion.velocity[0][2]});
    for (int i = 0; i < 3; i++) {
        self->coriolis[i] *= 2;
        self->euler[i] = (double)self->motion.Cv[i] / m - self->centrifugal[i] - self->coriolis[i];
        self->missing[i] = ((effects & MCT_CENTRIFUGAL) ? 0 : self->centrifugal[i]) +
                           ((effects & MCT_CORIOLIS) ? 0 : self->coriolis[i]) +
                           ((effects & MCT_EULER_FORCE) ? 0 : self->euler[i]);
    }
    for (int i = 0; i < 3; i++) {
        drag[i] = (effects & MCT_DRAG)
                      ? -*parameter_of(&self->scene, "drag") * speed * (double)self->motion.velocity[0][i]
                      : 0;
        push[i] = vector_of(&self->scene, "force")[i];
        if (i == 1 && (effects & MCT_GRAVITY)) {
            push[i] -= m * *parameter_of(&self->scene, "gravity");
        }
        double missing = 0;
        for (int j = 0; j < 3; j++) {
            missing += m * self->r[i][j] * self->missing[j];
        }
        force[i] = (mct_real)(push[i] + drag[i] + missing);
    }
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          mct_gauss_dynamics(&self->engine, force, NULL, &self->workspace, &self->motion));
}

static double worst[6];
enum { MASS, CV, TAU, ACCELERATION, CONSTRAINT, POSITION };
static const char *const names[] = {"M", "Cv", "tau", "acceleration", "constraint force", "position"};

static void compare(int quantity, double closed, double engine, double size)
{
    const double error = fabs(closed - engine) / size;
    worst[quantity] = fmax(worst[quantity], error);
    if (!(error <= TOLERANCE)) {
        char text[160];
        snprintf(text, sizeof text, "%s: closed form %.17g, engine %.17g, terms of size %.3g",
                 names[quantity], closed, engine, size);
        TEST_FAIL_MESSAGE(text);
    }
}

/* The size of all that meets in an equation of motion [N]. */
static double force_size(const trial *self)
{
    const double m = (double)self->out.mass[0];
    const double w = norm(self->w);
    double size =
        1 + norm(self->centrifugal) + norm(self->coriolis) + norm(self->euler) + 10 * w * w + 10 * w;
    for (int i = 0; i < 3; i++) {
        size += fabs((double)self->out.tau[i]) / m;
    }
    return m * size;
}

static void test_the_closed_form_is_what_gauss_principle_gives(void)
{
    test_random random = {777};
    memset(worst, 0, sizeof worst);
    for (int k = 0; k < TRIALS; k++) {
        static trial now;
        randomise(&now, &random, k);
        run_engine(&now);
        const double m = (double)now.out.mass[0];
        const double size = force_size(&now);
        for (int i = 0; i < 3; i++) {
            double e = 0;
            for (int j = 0; j < 3; j++) {
                compare(MASS, (double)now.out.M[i][j], (double)now.motion.M[i][j], m);
                e += m * now.r[i][j] * now.missing[j];
            }
            compare(CV, (double)now.out.Cv[i], (double)now.motion.Cv[i] - m * now.missing[i], size);
            compare(TAU, (double)now.out.tau[i], (double)now.motion.tau[i] - m * now.missing[i], size);
            compare(ACCELERATION, m * (double)now.out.acceleration[i], m * (double)now.motion.acceleration[i],
                    size);
            compare(CONSTRAINT, 0, (double)now.motion.constraint_force[0][i], size);
            compare(CONSTRAINT, (double)now.out.constraint_force[0][i], e, size);
            compare(POSITION, (double)now.out.position[0][i], (double)now.motion.position[0][i], 10);
        }
    }
    printf("rotating_frame, worst in %d:", TRIALS);
    for (int i = 0; i < 6; i++) {
        printf(" %s %.1e", names[i], worst[i]);
    }
    printf("\n");
}

static void test_c_is_m_j_jdot_where_the_coriolis_force_is_on(void)
{
    test_random random = {4711};
    for (int k = 0; k < 320; k++) {
        static trial now;
        randomise(&now, &random, k);
        run_engine(&now);
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                const double wanted = (now.scene.effects & MCT_CORIOLIS) ? (double)now.motion.C[i][j] : 0;
                TEST_ASSERT_TRUE(fabs((double)now.out.C[i][j] - wanted) <=
                                 TOLERANCE * (double)now.out.mass[0] * (1 + norm(now.w)));
            }
        }
    }
}

static double energy_at(const trial *self, const double *rate, double ahead)
{
    mct_real x[MCT_MAX_STATES];
    mct_evaluation there;
    for (int i = 0; i <= TIME; i++) {
        x[i] = (mct_real)((double)self->x[i] + ahead * rate[i]);
    }
    self->system->evaluate(&self->constants, self->scene.effects, x, 0, &there);
    return (double)there.kinetic_energy + (double)there.potential_energy;
}

/* A central difference with one extrapolation: error h^4 and eps/h, 1e-9 together; not asked for in float. */
static void test_the_energy_changes_by_the_powers_of_the_effects(void)
{
    test_random random = {99};
    double most = 0;
    for (int k = 0; k < (MCT_REAL_IS_FLOAT ? 0 : TRIALS); k++) {
        static trial now;
        randomise(&now, &random, k);
        double rate[TIME + 1] = {0}, change[2];
        for (int i = 0; i < 3; i++) {
            rate[i] = (double)now.x[N + i];
            rate[N + i] = (double)now.out.acceleration[i];
        }
        rate[TIME] = 1;
        for (int j = 0; j < 2; j++) {
            const double h = 2e-4 / (1 + j);
            change[j] = (energy_at(&now, rate, h) - energy_at(&now, rate, -h)) / (2 * h);
        }
        const double drag = (double)now.out.power[MCT_EFFECT_DRAG];
        const double apparent =
            (double)now.out.power[MCT_EFFECT_CENTRIFUGAL] + (double)now.out.power[MCT_EFFECT_EULER];
        const double powers[] = {(double)now.out.power_input, drag, apparent, (double)now.out.power_frame};
        double size = (double)now.out.kinetic_energy + fabs((double)now.out.potential_energy) + 1;
        for (int j = 0; j < 4; j++) {
            size += fabs(powers[j]);
        }
        for (int i = 0; i < 3; i++) {
            size += (double)now.out.mass[0] * fabs(rate[N + i]) * 10;
        }
        const double error = fabs((4 * change[1] - change[0]) / 3 - energy_rate(&now.out)) / size;
        most = fmax(most, error);
        TEST_ASSERT_TRUE(error < 1e-9);
        TEST_ASSERT_TRUE(drag <= 0);
        if ((now.scene.effects & APPARENT) == APPARENT) {
            TEST_ASSERT_TRUE(apparent == -(double)now.out.power_frame);
        }
    }
    if (!MCT_REAL_IS_FLOAT) {
        printf("power balance within %.1e\n", most);
    }
}

/* (285), (286): the rate of the rotation vector, turned into the frame, taken for the angular velocity. */
static void test_the_rate_of_the_rotation_vector_is_the_angular_velocity_about_a_fixed_axis_alone(void)
{
    test_random random = {5};
    double least = 1e9;
    double most = 0;
    for (int k = 0; k < 960; k++) {
        static trial now;
        randomise(&now, &random, k);
        if (now.x[TIME] < MCT_R(0.5)) {
            continue;
        }
        run_engine(&now);
        double printed[3], difference[3];
        for (int i = 0; i < 3; i++) {
            printed[i] = 0;
            for (int j = 0; j < 3; j++) {
                printed[i] +=
                    now.r[j][i] * (vector_of(&now.scene, "angular_velocity")[j] +
                                   (double)now.x[TIME] * vector_of(&now.scene, "angular_acceleration")[j]);
            }
            difference[i] = printed[i] - now.w[i];
        }
        if ((k / 32) % 3 == 0) {
            most = fmax(most, norm(difference));
        } else if ((k / 32) % 7 != 0) { /* with a rate at the start the axis does move */
            least = fmin(least, norm(difference));
        }
    }
    printf("r' udot off by at most %.1e about a fixed axis, else by at least %.1e rad/s\n", most, least);
    TEST_ASSERT_TRUE(most < 100 * TOLERANCE);
    TEST_ASSERT_TRUE(least > 1e-3);
}

static void test_the_euler_force_has_the_factor_m(void)
{
    mct_scene scene = scene_of(system_called("rotating_frame"), MCT_STEPPER_RK4, MCT_EULER_FORCE);
    mct_constants constants;
    mct_evaluation out;
    *parameter_of(&scene, "mass") = 4;
    *parameter_of(&scene, "angular_acceleration_3") = 2;
    const mct_real x[MCT_MAX_STATES] = {1};
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_systems[scene.system]->prepare(&scene, 1e-3, &constants, NULL));
    mct_systems[scene.system]->evaluate(&constants, scene.effects, x, 0, &out);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 8, (double)out.Cv[1]); /* m al x q; below (286) it is 2 */
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, -2, (double)out.acceleration[1]);
}

static void test_an_axis_that_stands_still_is_known_wherever_it_points(void)
{
    static const struct {
        double velocity[3], acceleration[3];
        bool stands_still;
    } cases[] = {
        {{1, 2, -2}, {0.5, 1, -1}, true},  {{1, 2, -2}, {-3, -6, 6}, true},  {{1, 2, -2}, {0, 0, 0}, true},
        {{0, 0, 0}, {0.3, -2, 0.7}, true}, {{1, 2, -2}, {0.5, 1, 1}, false}, {{0, 0, 1}, {0, 1e-3, 0}, false},
    };
    const int system = system_called("rotating_frame");
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        mct_scene scene;
        mct_constants constants;
        mct_scene_defaults(&scene, system);
        memcpy(vector_of(&scene, "angular_velocity"), cases[i].velocity, sizeof cases[i].velocity);
        memcpy(vector_of(&scene, "angular_acceleration"), cases[i].acceleration,
               sizeof cases[i].acceleration);
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_systems[system]->prepare(&scene, 0.001, &constants, NULL));
        TEST_ASSERT_TRUE(constants.rotating_frame.has_fixed_axis == cases[i].stands_still);
    }
}

static void test_what_is_wrong_is_refused_in_a_sentence(void)
{
    static const struct {
        const char *text;
        const char *says;
    } cases[] = {
        {"[scene]\nsystem = \"rotating_frame\"\n[parameters]\nmass = 0\n",
         "parameters.mass: found 0 kg; allowed 1e-06 to"},
        {"[scene]\nsystem = \"rotating_frame\"\n[parameters]\ndrag = -1\n",
         "parameters.drag: found -1 N s^2/m^2; allowed 0 to"},
        {"[scene]\nsystem = \"rotating_frame\"\nstepper = \"expo\"\n[effects]\ndrag = true\n",
         "scene.stepper: found expo, which does not suit rotating_frame with"},
        {"[scene]\nsystem = \"rotating_frame\"\nstepper = \"expo\"\n[effects]\neuler = false\n",
         "scene.stepper: found expo, which does not suit rotating_frame with"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        mct_scene scene;
        mct_message why = {""};
        TEST_ASSERT_NOT_EQUAL_INT(
            MCT_OK, mct_scene_read(cases[i].text, strlen(cases[i].text), "scene", NULL, 0, &scene, &why));
        TEST_ASSERT_TRUE_MESSAGE(strstr(why.text, cases[i].says) != NULL, why.text);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_closed_form_is_what_gauss_principle_gives);
    RUN_TEST(test_c_is_m_j_jdot_where_the_coriolis_force_is_on);
    RUN_TEST(test_the_energy_changes_by_the_powers_of_the_effects);
    RUN_TEST(test_the_rate_of_the_rotation_vector_is_the_angular_velocity_about_a_fixed_axis_alone);
    RUN_TEST(test_the_euler_force_has_the_factor_m);
    RUN_TEST(test_an_axis_that_stands_still_is_known_wherever_it_points);
    RUN_TEST(test_what_is_wrong_is_refused_in_a_sentence);
    return UNITY_END();
}

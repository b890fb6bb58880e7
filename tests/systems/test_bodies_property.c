/*
 * ball_joint and rigid_body: their closed forms against the generic Gauss engine, and against forces and
 * energies that are written here once more; what there is without inertia about an axis; what is refused.
 *
 * Tolerances: 1e-12 in double, 2000 roundings in float, relative to the size of the terms that meet in a
 * result. An acceleration is relative to the torques over the least moment: that is what the particles' arms
 * leave of it.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/inertia.h"
#include "mctau/judge.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

enum { TRIALS = TEST_CASES(10000), MOST = 8 };

#define TOLERANCE (MCT_REAL_IS_FLOAT ? 2000 * (double)FLT_EPSILON : 1e-12)

static int ball_joint, rigid_body;

void setUp(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        ball_joint = strcmp(mct_systems[i]->name, "ball_joint") == 0 ? i : ball_joint;
        rigid_body = strcmp(mct_systems[i]->name, "rigid_body") == 0 ? i : rigid_body;
    }
}

void tearDown(void)
{
}

typedef struct {
    mct_scene scene;
    bool is_free;
    int n, particles; /* coordinates */
    mct_constants constants;
    mct_real x[MCT_MAX_STATES];
    mct_evaluation out;
    mct_judgement judged;
    /* written here once more */
    double r[3][3];
    double mass, centre[3]; /* of the body, in body axes */
    double moments[3];      /* about the point that it turns about */
    double w[3], v[3];      /* in space axes */
    double gravity[3];
    double tau[6];
    double torque, force; /* sizes of the terms */
    double reach;         /* longest arm */
} trial;

static void cross(const double *a, const double *b, double *product)
{
    for (int i = 0; i < 3; i++) {
        product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double size(const double *a)
{
    return sqrt(dot(a, a));
}

static void to_space(const trial *self, const double *b, double *x)
{
    for (int i = 0; i < 3; i++) {
        x[i] = dot(self->r[i], b);
    }
}

static double *row_of(trial *self, int particle)
{
    return self->scene.lists[0].values + 4 * particle;
}

/* Arm of a particle as listed, in space axes, from the point that the body turns about. */
static void arm_of(trial *self, const double *place, double *arm)
{
    double b[3];
    for (int i = 0; i < 3; i++) {
        b[i] = place[i] - (self->is_free ? self->centre[i] : 0);
    }
    to_space(self, b, arm);
}

/* A force at a place of the body, in space axes: what it does to each coordinate. */
static void add_force(trial *self, const double *arm, const double *force)
{
    double couple[3];
    cross(arm, force, couple);
    for (int i = 0; i < 3; i++) {
        const double column[3] = {self->r[0][i], self->r[1][i], self->r[2][i]};
        if (self->is_free) {
            self->tau[i] += force[i];
            self->tau[3 + i] += dot(column, couple); /* along the body's axes */
        } else {
            self->tau[i] += couple[i];
        }
    }
    self->torque += size(arm) * size(force);
    self->force += size(force);
}

static void add_drag(trial *self)
{
    const double linear = *parameter_of(&self->scene, "drag") * size(self->v);
    const double angular = *parameter_of(&self->scene, "angular_drag") * size(self->w);
    for (int i = 0; i < 3; i++) {
        const double column[3] = {self->r[0][i], self->r[1][i], self->r[2][i]};
        self->tau[i] -= linear * self->v[i];
        self->tau[3 + i] -= angular * dot(column, self->w);
    }
    self->force += linear * size(self->v);
    self->torque += angular * size(self->w);
}

static void randomise_state(trial *self, test_random *random)
{
    double q[4], square = 0;
    const int rate = mct_rate_index(mct_systems[self->scene.system]);
    for (int i = 0; i < 4; i++) {
        q[i] = random_in(random, -1, 1);
        square += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++) {
        self->x[self->n - 3 + i] = (mct_real)(q[i] / sqrt(square));
        q[i] = (double)self->x[self->n - 3 + i];
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        self->r[i][i] = 1 - 2 * (q[1 + j] * q[1 + j] + q[1 + k] * q[1 + k]);
        self->r[i][j] = 2 * (q[1 + i] * q[1 + j] - q[0] * q[1 + k]);
        self->r[i][k] = 2 * (q[1 + i] * q[1 + k] + q[0] * q[1 + j]);
    }
    for (int i = 0; i < self->n; i++) {
        self->x[rate + i] = (mct_real)random_in(random, -5, 5);
        if (i < self->n - 3) {
            self->x[i] = (mct_real)random_in(random, -2, 2);
            self->v[i] = (double)self->x[rate + i];
        }
    }
    double w[3];
    for (int i = 0; i < 3; i++) {
        w[i] = self->w[i] = (double)self->x[rate + self->n - 3 + i];
    }
    if (self->is_free) {
        to_space(self, w, self->w);
    }
}

static void randomise_particles(trial *self, test_random *random, int count)
{
    double mass[MOST], place[MOST][3], inertia[9], axes[9];
    mct_body body;
    self->particles = count;
    self->scene.lists[0].count = 4 * count;
    for (int n = 0; n < count; n++) {
        double *row = row_of(self, n);
        row[0] = mass[n] = (double)(mct_real)random_scale(random, 0.1, 10);
        for (int i = 0; i < 3; i++) {
            row[1 + i] = place[n][i] = (double)(mct_real)random_in(random, -1, 1);
        }
        self->reach = fmax(self->reach, 2 * size(place[n]));
    }
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_body_of_particles(count, mass, (const double(*)[3])place, &body));
    self->mass = body.mass;
    memcpy(self->centre, body.center, sizeof self->centre);
    mct_inertia_about(&body, self->is_free ? body.center : (double[3]){0}, inertia);
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_principal_axes(inertia, self->moments, axes));
}

static void randomise_forces(trial *self, test_random *random)
{
    mct_list *list = &self->scene.lists[1];
    list->count = 7 * (int)random_in(random, 0, 4);
    for (int row = 0; row < list->count; row += 7) {
        double *value = list->values + row, arm[3], force[3];
        value[0] = random_in(random, 0, 2) < 1 ? 0 : 1;
        for (int i = 1; i < 7; i++) {
            value[i] = random_in(random, -3, 3);
        }
        arm_of(self, value + 1, arm);
        memcpy(force, value + 4, sizeof force);
        if (value[0] == 1) {
            to_space(self, value + 4, force);
        }
        if (self->scene.effects & MCT_FORCES) {
            add_force(self, arm, force);
        }
    }
}

static void randomise(trial *self, test_random *random, int system, int count, uint32_t effects)
{
    memset(self, 0, sizeof *self);
    self->scene = scene_of(system, MCT_STEPPER_RK4, effects);
    self->is_free = system == rigid_body;
    self->n = self->is_free ? 6 : 3;
    randomise_state(self, random);
    randomise_particles(self, random, count);
    double spin = 0;
    for (int i = 0; i < 3; i++) {
        double *gravity = parameter_of(&self->scene, "gravity_1") + i;
        *gravity = random_in(random, -10, 10);
        self->gravity[i] = (effects & MCT_GRAVITY) ? *gravity : 0;
        spin = fmax(spin, self->moments[i]);
    }
    for (int n = 0; n < count; n++) {
        double arm[3], weight[3];
        arm_of(self, row_of(self, n) + 1, arm);
        for (int i = 0; i < 3; i++) {
            weight[i] = row_of(self, n)[0] * self->gravity[i];
        }
        add_force(self, arm, weight);
    }
    self->torque += spin * dot(self->w, self->w);
    if (self->is_free) {
        *parameter_of(&self->scene, "drag") = random_scale(random, 0.01, 10);
        *parameter_of(&self->scene, "angular_drag") = random_scale(random, 0.01, 10);
        randomise_forces(self, random);
        if (effects & MCT_DRAG) {
            add_drag(self);
        }
    } else {
        const double friction = *parameter_of(&self->scene, "friction") = random_scale(random, 0.01, 10);
        for (int i = 0; i < 3 && (effects & MCT_VISCOUS); i++) {
            self->tau[i] -= friction * self->w[i];
            self->torque += friction * fabs(self->w[i]);
        }
    }
    const mct_system *const descriptor = mct_systems[system];
    TEST_ASSERT_EQUAL_INT(MCT_OK, descriptor->prepare(&self->scene, 1e-3, &self->constants, NULL));
    descriptor->evaluate(&self->constants, effects, self->x, 0, &self->out);
}

static void for_all_trials(void (*check)(trial *))
{
    static const uint32_t pivoted[] = {0, MCT_GRAVITY, MCT_VISCOUS, MCT_GRAVITY | MCT_VISCOUS};
    static const uint32_t thrown[] = {0, MCT_FORCES, MCT_DRAG, MCT_GRAVITY | MCT_FORCES | MCT_DRAG};
    static trial now;
    test_random random = {1729};
    for (int n = 0; n < TRIALS; n++) {
        const bool is_free = n % 2 == 1;
        const int count = (int)random_in(&random, is_free ? 3 : 2, MOST + 1);
        randomise(&now, &random, is_free ? rigid_body : ball_joint, count,
                  is_free ? thrown[n / 2 % 4] : pivoted[n / 2 % 4]);
        check(&now);
    }
}

static double least_moment(const trial *self)
{
    return fmin(fmin(self->moments[0], self->moments[1]), self->moments[2]);
}

static void check_near(double closed, double expected, double scale)
{
    TEST_ASSERT_TRUE(fabs(closed - expected) <= TOLERANCE * scale);
}

static void check_against_engine(trial *self)
{
    const mct_system *const system = mct_systems[self->scene.system];
    const mct_evaluation *const out = &self->out;
    const double most = fmax(fmax(self->moments[0], self->moments[1]), self->moments[2]);
    if (least_moment(self) < 1e-4 * most) { /* the engine's own digits go */
        return;
    }
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          mct_judge(system, &self->constants, self->particles, self->x, out, &self->judged));
    const mct_gauss_motion *const motion = &self->judged.motion;
    const double turning = self->torque / least_moment(self);
    const double moving = self->force / self->mass;
    for (int i = 0; i < self->n; i++) {
        const bool turns = i >= self->n - 3;
        for (int j = 0; j < self->n; j++) {
            check_near((double)out->M[i][j], (double)motion->M[i][j],
                       self->mass * fmax(1, self->reach * self->reach));
        }
        check_near((double)out->Cv[i], (double)motion->Cv[i],
                   turns ? self->torque : self->mass * self->reach * dot(self->w, self->w));
        check_near((double)out->tau[i], self->tau[i], turns ? self->torque : self->force);
        check_near((double)out->acceleration[i], (double)motion->acceleration[i],
                   turns ? turning : moving + self->reach * (turning + dot(self->w, self->w)));
    }
    for (int n = 0; n < self->particles; n++) {
        const double *row = row_of(self, n);
        const double inertial =
            moving + self->reach * (turning + dot(self->w, self->w)) + size(self->gravity);
        double arm[3];
        arm_of(self, row + 1, arm);
        TEST_ASSERT_EQUAL_DOUBLE(row[0], (double)out->mass[n]);
        for (int i = 0; i < 3; i++) {
            const double origin = self->is_free ? (double)self->x[i] : 0;
            check_near((double)out->position[n][i], origin + arm[i], 2 + self->reach);
            check_near((double)out->force[n][i], row[0] * self->gravity[i], row[0] * size(self->gravity));
            check_near((double)out->constraint_force[n][i], (double)motion->constraint_force[n][i],
                       row[0] * inertial);
        }
    }
}

static void test_the_closed_forms_are_those_of_the_gauss_engine(void)
{
    for_all_trials(check_against_engine);
}

/* C is the matrix m J'Jdot of the angular velocity: C v is what enters. */
static void check_power(trial *self)
{
    const mct_evaluation *const out = &self->out;
    const int rate = mct_rate_index(mct_systems[self->scene.system]);
    double kinetic = 0, potential = 0, through_constraints = 0, applied = 0;
    double power_size = self->force * size(self->v) + self->torque * size(self->w);
    for (int n = 0; n < self->particles; n++) {
        const double m = row_of(self, n)[0];
        double arm[3], velocity[3], e[3], x[3];
        arm_of(self, row_of(self, n) + 1, arm);
        cross(self->w, arm, velocity);
        for (int i = 0; i < 3; i++) {
            velocity[i] += self->v[i];
            x[i] = arm[i] + (self->is_free ? (double)self->x[i] : 0);
            e[i] = (double)out->constraint_force[n][i];
        }
        kinetic += m / 2 * dot(velocity, velocity);
        potential -= m * dot(self->gravity, x);
        through_constraints += dot(e, velocity);
        power_size += size(e) * size(velocity);
    }
    for (int i = 0; i < self->n; i++) {
        double Cv = 0;
        for (int j = 0; j < self->n; j++) {
            Cv += (double)out->C[i][j] * (double)self->x[rate + j];
        }
        applied += self->tau[i] * (double)self->x[rate + i];
        check_near((double)out->Cv[i], Cv, self->torque);
    }
    if (self->is_free) {
        applied -= self->mass * dot(self->gravity, self->v);
    } else {
        double arm[3], weight[3], couple[3];
        arm_of(self, self->centre, arm);
        for (int i = 0; i < 3; i++) {
            weight[i] = self->mass * self->gravity[i];
        }
        cross(arm, weight, couple);
        applied -= dot(couple, self->w);
    }
    const double powers = energy_rate(out);
    check_near((double)out->kinetic_energy, kinetic, kinetic);
    check_near((double)out->potential_energy, potential,
               self->mass * size(self->gravity) * (4 + self->reach));
    check_near(powers, applied, power_size);
    check_near(through_constraints, powers, power_size);
    TEST_ASSERT_TRUE(out->power[MCT_EFFECT_VISCOUS] <= 0 && out->power[MCT_EFFECT_DRAG] <= 0);
}

/*
 * m xdd = f + e with weights f: so the energy changes by the work of e, which is that of forces, drag and
 * friction alone.
 */
static void test_the_powers_add_up_to_the_change_of_energy(void)
{
    for_all_trials(check_power);
}

/* --- no inertia about an axis --- */

/*
 * Particles on a line through the pivot: M a + C v = tau still, nothing along the line, and no friction
 * there.
 */
static void test_particles_on_a_line_have_the_least_acceleration(void)
{
    static trial now;
    test_random random = {31};
    for (int n = 0; n < TRIALS / 10; n++) {
        randomise(&now, &random, ball_joint, 1 + n % 4, MCT_GRAVITY | MCT_VISCOUS);
        double axis[3], along_acceleration = 0, friction = *parameter_of(&now.scene, "friction"), bound = 0;
        for (int k = 1; k < now.particles; k++) {
            const double factor = random_in(&random, -1, 1);
            for (int i = 1; i < 4; i++) {
                row_of(&now, k)[i] = factor * row_of(&now, 0)[i];
            }
        }
        const mct_system *const system = mct_systems[ball_joint];
        TEST_ASSERT_EQUAL_INT(MCT_OK, system->prepare(&now.scene, 1e-3, &now.constants, NULL));
        system->evaluate(&now.constants, now.scene.effects, now.x, 0, &now.out);
        to_space(&now, row_of(&now, 0) + 1, axis);
        double spin = 0, couple[3] = {0};
        for (int i = 0; i < 3; i++) {
            axis[i] /= size(row_of(&now, 0) + 1);
            along_acceleration += axis[i] * (double)now.out.acceleration[i];
            spin += axis[i] * now.w[i];
        }
        for (int k = 0; k < now.particles; k++) {
            double arm[3], weight[3], part[3];
            arm_of(&now, row_of(&now, k) + 1, arm);
            for (int i = 0; i < 3; i++) {
                weight[i] = row_of(&now, k)[0] * now.gravity[i];
            }
            cross(arm, weight, part);
            for (int i = 0; i < 3; i++) {
                couple[i] += part[i];
            }
            bound += row_of(&now, k)[0] * now.reach * (size(now.gravity) + now.reach * dot(now.w, now.w));
        }
        bound += friction * size(now.w);
        for (int i = 0; i < 3; i++) {
            double left = (double)now.out.Cv[i] - (double)now.out.tau[i];
            for (int j = 0; j < 3; j++) {
                left += (double)now.out.M[i][j] * (double)now.out.acceleration[j];
            }
            check_near(left, 0, bound);
            check_near((double)now.out.tau[i], couple[i] - friction * (now.w[i] - spin * axis[i]), bound);
        }
        double acceleration[3] = {(double)now.out.acceleration[0], (double)now.out.acceleration[1],
                                  (double)now.out.acceleration[2]};
        check_near(along_acceleration, 0, size(acceleration) + dot(now.w, now.w));
    }
}

/* --- over a long run --- */

static void momentum_of(const mct_plant *plant, double *momentum)
{
    mct_evaluation now;
    mct_plant_evaluate(plant, &now);
    const int n = plant->system->coordinate_count, rate = mct_rate_index(plant->system);
    double own[3], q[4], r[3][3];
    for (int i = 0; i < 3; i++) {
        own[i] = 0;
        for (int j = 0; j < 3; j++) {
            own[i] += (double)now.M[n - 3 + i][n - 3 + j] * mct_plant_value(plant, rate + n - 3 + j);
        }
    }
    for (int i = 0; i < 4; i++) {
        q[i] = mct_plant_value(plant, n - 3 + i);
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        r[i][i] = 1 - 2 * (q[1 + j] * q[1 + j] + q[1 + k] * q[1 + k]);
        r[i][j] = 2 * (q[1 + i] * q[1 + j] - q[0] * q[1 + k]);
        r[i][k] = 2 * (q[1 + i] * q[1 + k] + q[0] * q[1 + j]);
    }
    for (int i = 0; i < 3; i++) {
        momentum[i] = plant->system->attitude == MCT_ATTITUDE_BODY ? dot(r[i], own) : own[i];
    }
}

/*
 * A free body of three different moments, spun about the middle axis, a million steps of 1 ms. What each
 * stepper keeps: the length of the quaternion, all of them; the angular momentum in space, euler to rounding;
 * the energy, leap and rk4.
 */
static void test_what_a_free_body_keeps_over_a_million_steps(void)
{
    static const struct {
        int stepper;
        double energy, momentum; /* of themselves; in double */
    } cases[] = {
        {MCT_STEPPER_EULER, 1, 1e-12}, {MCT_STEPPER_LEAP, 1e-4, 1e-2}, {MCT_STEPPER_RK4, 1e-7, 1e-7}};
    static const double jacks[24] = {1, 0.5, 0,    0, 1, -0.5, 0, 0,   1, 0, 0.4, 0,
                                     1, 0,   -0.4, 0, 1, 0,    0, 0.2, 1, 0, 0,   -0.2};
    for (int c = 0; c < 6; c++) {
        const int system = c % 2 == 0 ? rigid_body : ball_joint;
        mct_scene scene = scene_of(system, cases[c / 2].stepper, 0);
        mct_plant plant;
        scene.lists[0].count = 24;
        memcpy(scene.lists[0].values, jacks, sizeof jacks);
        double *w = scene.initial + mct_most_states(mct_systems[system]) - 3;
        w[0] = 0.1;
        w[1] = 3;
        w[2] = 0.1;
        start_plant(&plant, &scene);
        double start[3], now[3], off = 0, length = 0, drift = 0;
        const double energy = energy_of(&plant);
        const int n = plant.system->coordinate_count;
        momentum_of(&plant, start);
        for (int k = 0; k < TEST_CASES(1000); k++) {
            double square = 0;
            step_plant(&plant, 0, 1000);
            momentum_of(&plant, now);
            for (int i = 0; i < 3; i++) {
                off = fmax(off, fabs(now[i] - start[i]) / size(start));
            }
            for (int i = 0; i < 4; i++) {
                square += mct_plant_value(&plant, n - 3 + i) * mct_plant_value(&plant, n - 3 + i);
            }
            length = fmax(length, fabs(square - 1) / 2);
            drift = fmax(drift, fabs(energy_of(&plant) / energy - 1));
        }
        printf("%s, %s, 1e6 steps: |q| off by %.1e, energy by %.1e, angular momentum by %.1e\n",
               plant.system->name, mct_steppers[scene.stepper].name, length, drift, off);
        const double rounding = 100 * (double)MCT_REAL_EPSILON;
        TEST_ASSERT_TRUE(length < 2 * (double)MCT_REAL_EPSILON);
        TEST_ASSERT_TRUE(drift < cases[c / 2].energy + rounding);
        TEST_ASSERT_TRUE(off < cases[c / 2].momentum + rounding);
    }
}

/* --- what is refused --- */

static void check_refused(int system, const char *text, const char *sentence)
{
    char scene_text[512];
    mct_scene scene;
    mct_constants constants;
    mct_message why = {""};
    snprintf(scene_text, sizeof scene_text, "scene.system = \"%s\"\nscene.duration = 1\nparameters.%s\n",
             mct_systems[system]->name, text);
    mct_status status = mct_scene_read(scene_text, strlen(scene_text), "body", NULL, 0, &scene, &why);
    if (status == MCT_OK) {
        status = mct_systems[system]->prepare(&scene, 1e-3, &constants, &why);
    }
    TEST_ASSERT_NOT_EQUAL(MCT_OK, status);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, sentence), why.text);
}

static void test_what_is_no_body_is_refused_with_its_figures(void)
{
#define BARE "particles = []\nparameters.mass = 2\nparameters."
    check_refused(rigid_body, "particles = [[0, 1, 1, 1]]",
                  "parameters.particles: found 0 kg as mass of row 1");
    check_refused(ball_joint, "particles = [[-1, 1, 1, 1]]",
                  "parameters.particles: found -1 kg as mass of row 1");
    check_refused(ball_joint, "particles = []", "parameters.particles: found 0 rows; allowed 1 to 32 rows");
    check_refused(ball_joint, "particles = [[1, 0, 0, 0], [2, 0, 0, 0]]",
                  "parameters.particles: found 2, all at the pivot");
    check_refused(rigid_body, "particles = [[1, 0, 0, 0], [2, 1, 0, 0]]", "particles on one line");
    check_refused(rigid_body, "mass = 2", "parameters.mass: found 2 kg beside 4 particles");
    check_refused(rigid_body, "centre = [0, 0.5, 0]", "parameters.centre_2: found 0.5 m beside 4 particles");
    check_refused(rigid_body, "particles = []", "parameters.mass: found 0 kg and no particles");
    check_refused(rigid_body, BARE "inertia = [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]",
                  "parameters.inertia: found 0.1 kg m^2 in row 1, "
                  "column 2, and 0 opposite");
    check_refused(rigid_body, BARE "inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 3]]",
                  "principal moments 1, 1 and 3 kg m^2");
    check_refused(rigid_body, BARE "inertia = [[1, 0, 0], [0, -1, 0], [0, 0, 1]]", "allowed none below 0");
    check_refused(rigid_body, BARE "inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 0]]",
                  "allowed none below 1e-10 of the largest");
    check_refused(rigid_body, "forces = [[\"bodies\", 0, 0, 0, 1, 0, 0]]",
                  "allowed 0 to 16 rows of frame (space, body)");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_closed_forms_are_those_of_the_gauss_engine);
    RUN_TEST(test_the_powers_add_up_to_the_change_of_energy);
    RUN_TEST(test_particles_on_a_line_have_the_least_acceleration);
    RUN_TEST(test_what_a_free_body_keeps_over_a_million_steps);
    RUN_TEST(test_what_is_no_body_is_refused_with_its_figures);
    return UNITY_END();
}

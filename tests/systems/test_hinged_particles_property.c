/*
 * The particle pendulum and the fixed axis: their closed form against the generic Gauss engine; their geometry, forces and
 * couples against formulas written here; their power balance; what they have in common with the other bodies on a hinge;
 * the load of the bearing in the source's case study (5.5.1); what they refuse.
 *
 * Tolerances: 1e-12 in double, 300 roundings in float, relative to the size of the terms that meet in a result.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/judge.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

enum { TRIALS = TEST_CASES(10000) };

#define TOLERANCE (MCT_REAL_IS_FLOAT ? 300 * (double)FLT_EPSILON : 1e-12)

static const char *const names[] = {"particle_pendulum", "fixed_axis"};
enum { PLANE, SPACE, SYSTEMS };

void setUp(void)
{
}

void tearDown(void)
{
}

static void set_particles(mct_scene *scene, const double *numbers, int count)
{
    scene->lists[0].count = count;
    memcpy(scene->lists[0].values, numbers, sizeof *numbers * (size_t)count);
}

/* Component i of a vector parameter. */
static double *component_of(mct_scene *scene, const char *name, int i)
{
    char component[32];
    snprintf(component, sizeof component, "%s_%d", name, i + 1);
    return parameter_of(scene, component);
}

static void set_vector(mct_scene *scene, const char *name, const double *vector)
{
    for (int i = 0; i < 3; i++) {
        *component_of(scene, name, i) = vector[i];
    }
}

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

/* ---- what a scene says, by formulas of this file ---- */

typedef struct {
    mct_scene scene;
    mct_constants constants;
    mct_real x[2];
    mct_real input;
    mct_evaluation out;
    mct_judgement judged;
    int particles;
    double mass[MCT_MAX_PARTICLES], b[MCT_MAX_PARTICLES][3];
    double axis[3], gravity[3], couple;
    double reach, whole_mass; /* farthest particle from the origin */
} trial;

static double used(trial *self, uint32_t effect, const char *name)
{
    return (self->scene.effects & effect) ? *parameter_of(&self->scene, name) : 0;
}

/* e^(R[th u]) b, by the source's matrices (104) in the plane and by Rodrigues' in space. */
static void expected_position(const trial *self, int i, double *x)
{
    const double *b = self->b[i];
    const double *u = self->axis;
    const double s = sin((double)self->x[0]);
    const double c = cos((double)self->x[0]);
    if (strcmp(mct_systems[self->scene.system]->name, names[PLANE]) == 0) {
        x[0] = b[0] * c + b[1] * s;
        x[1] = -b[0] * s + b[1] * c;
        x[2] = 0;
        return;
    }
    for (int row = 0; row < 3; row++) {
        x[row] = 0;
        for (int column = 0; column < 3; column++) {
            const int third = 3 - row - column;
            const double skew = row == column ? 0 : (column - row + 3) % 3 == 1 ? -u[third] : u[third];
            x[row] += ((row == column ? c : 0) + (1 - c) * u[row] * u[column] + s * skew) * b[column];
        }
    }
}

static void evaluate(trial *self)
{
    const mct_system *const system = mct_systems[self->scene.system];
    const bool plane = strcmp(system->name, names[PLANE]) == 0;
    const int columns = system->lists[0].column_count;
    const double rate = (double)self->x[1];
    self->particles = mct_particle_count(&self->scene);
    self->reach = self->whole_mass = 0;
    for (int i = 0; i < self->particles; i++) {
        const double *row = self->scene.lists[0].values + columns * i;
        self->mass[i] = row[0];
        for (int j = 0; j < 3; j++) {
            self->b[i][j] = j + 1 < columns ? row[j + 1] : 0;
        }
        self->whole_mass += row[0];
        self->reach = fmax(self->reach, sqrt(dot(self->b[i], self->b[i])));
    }
    memset(self->gravity, 0, sizeof self->gravity);
    if (plane) {
        static const double away[] = {0, 0, -1};
        memcpy(self->axis, away, sizeof away);
        self->gravity[1] = -used(self, MCT_GRAVITY, "gravity");
    } else {
        double length = 0;
        for (int j = 0; j < 3; j++) {
            self->axis[j] = *component_of(&self->scene, "axis", j);
            self->gravity[j] =
                (self->scene.effects & MCT_GRAVITY) ? *component_of(&self->scene, "gravity", j) : 0;
            length = hypot(length, self->axis[j]);
        }
        for (int j = 0; j < 3; j++) {
            self->axis[j] /= length;
        }
    }
    self->couple = (double)self->input - used(self, MCT_VISCOUS, "friction") * rate -
                   used(self, MCT_COULOMB_MOREAU, "coulomb") * (rate > 0   ? 1
                                                                : rate < 0 ? -1
                                                                           : 0);
    TEST_ASSERT_EQUAL_INT(MCT_OK, system->prepare(&self->scene, 1e-3, &self->constants, NULL));
    system->evaluate(&self->constants, self->scene.effects, self->x, self->input, &self->out);
    TEST_ASSERT_EQUAL_INT(
        MCT_OK, mct_judge(system, &self->constants, self->particles, self->x, &self->out, &self->judged));
}

static void randomise(trial *self, test_random *random, int system, uint32_t effects)
{
    self->scene = scene_of(system, MCT_STEPPER_RK4, effects);
    const int columns = mct_systems[system]->lists[0].column_count;
    const int rows = 1 + (int)(random_bits(random) % MCT_MAX_PARTICLES);
    const double size = random_scale(random, 1e-2, 1e2);
    self->scene.lists[0].count = rows * columns;
    for (int i = 0; i < rows * columns; i++) {
        self->scene.lists[0].values[i] =
            i % columns == 0 ? random_scale(random, 1e-3, 1e3) : random_in(random, -size, size);
    }
    if (columns == 4) {
        const double axis_size = random_scale(random, 1e-3, 1e3);
        double axis[3], gravity[3];
        for (int j = 0; j < 3; j++) {
            axis[j] = random_in(random, -axis_size, axis_size);
            gravity[j] = random_in(random, -20, 20);
        }
        set_vector(&self->scene, "axis", axis);
        set_vector(&self->scene, "gravity", gravity);
    } else {
        *parameter_of(&self->scene, "gravity") = random_in(random, 0, 20);
    }
    *parameter_of(&self->scene, "friction") = random_scale(random, 1e-3, 10);
    *parameter_of(&self->scene, "coulomb") = random_scale(random, 1e-3, 10);
    self->x[0] = (mct_real)random_in(random, -7, 7);
    self->x[1] = (mct_real)random_in(random, -9, 9);
    self->input = (mct_real)random_in(random, -10, 10);
    evaluate(self);
}

enum { MASS, CV, TAU, ACCELERATION, FORCE, CONSTRAINT, POSITION, ENERGY, POWER, WORK, QUANTITIES };
static const char *const quantity_names[] = {
    "M", "Cv", "tau", "acceleration", "force", "constraint force", "position", "energy", "power", "work"};
static double worst[QUANTITIES];

static void compare(int quantity, double closed, double expected, double size)
{
    const double error = fabs(closed - expected) / (size > 0 ? size : 1);
    worst[quantity] = fmax(worst[quantity], error);
    if (!(error <= TOLERANCE)) {
        char text[160];
        snprintf(text, sizeof text, "%s: closed form %.17g, expected %.17g, terms of size %.3g",
                 quantity_names[quantity], closed, expected, size);
        TEST_FAIL_MESSAGE(text);
    }
}

static void for_all_trials(void (*check)(trial *))
{
    static const uint32_t switches[] = {MCT_GRAVITY, MCT_VISCOUS, MCT_COULOMB_MOREAU};
    for (int system = 0; system < SYSTEMS; system++) {
        test_random random = {1729};
        memset(worst, 0, sizeof worst);
        for (int n = 0; n < TRIALS; n++) {
            static trial now;
            uint32_t effects = 0;
            for (int i = 0; i < 3; i++) {
                effects |= (n >> i) & 1 ? switches[i] : 0;
            }
            randomise(&now, &random, system_called(names[system]), effects);
            check(&now);
        }
        printf("%s, worst in %d:", names[system], TRIALS);
        for (int i = 0; i < QUANTITIES; i++) {
            if (worst[i] > 0) {
                printf(" %s %.1e", quantity_names[i], worst[i]);
            }
        }
        printf("\n");
    }
}

static double torque_size(const trial *self)
{
    return fabs((double)self->input) + fabs(self->couple) +
           self->whole_mass * sqrt(dot(self->gravity, self->gravity)) * self->reach;
}

static double acceleration_size(const trial *self)
{
    const double rate = (double)self->x[1];
    return torque_size(self) / (double)self->judged.motion.M[0][0] + rate * rate;
}

static void check_closed_form(trial *self)
{
    const mct_evaluation *const out = &self->out;
    const mct_gauss_motion *const motion = &self->judged.motion;
    const double M = (double)motion->M[0][0];
    const double rate = (double)self->x[1];
    const double gravity = sqrt(dot(self->gravity, self->gravity));
    double inertia = 0, inertia_size = 0, torque = self->couple, potential = 0;
    TEST_ASSERT_EQUAL_INT(self->particles, self->judged.particle_count);
    for (int i = 0; i < self->particles; i++) {
        double x[3], arm[3], weight[3], moment[3];
        expected_position(self, i, x);
        cross(self->axis, self->b[i], arm);
        /* The engine's residual is as exact as its norm, in which a light particle counts by the root of its mass. */
        const double load =
            sqrt(self->mass[i] * self->whole_mass) * (gravity + self->reach * acceleration_size(self));
        for (int j = 0; j < 3; j++) {
            weight[j] = self->mass[i] * self->gravity[j];
            compare(POSITION, (double)out->position[i][j], x[j], self->reach);
            compare(FORCE, (double)out->force[i][j], weight[j], self->mass[i] * gravity);
            compare(CONSTRAINT, (double)out->constraint_force[i][j], (double)motion->constraint_force[i][j],
                    load);
        }
        cross(x, weight, moment);
        inertia += self->mass[i] * dot(arm, arm);
        inertia_size += self->mass[i] * dot(self->b[i], self->b[i]);
        torque += dot(self->axis, moment);
        potential -= dot(weight, x);
        compare(MASS, (double)out->mass[i], self->mass[i], self->mass[i]);
    }
    compare(MASS, (double)out->M[0][0], M, M);
    compare(MASS, (double)out->M[0][0], inertia, inertia_size);
    compare(CV, (double)out->Cv[0], (double)motion->Cv[0], M * rate * rate);
    compare(TAU, (double)out->tau[0], torque, torque_size(self));
    compare(TAU, (double)self->judged.couple[0], self->couple, torque_size(self));
    compare(ACCELERATION, (double)out->acceleration[0], (double)motion->acceleration[0],
            acceleration_size(self));
    compare(ENERGY, (double)out->kinetic_energy, 0.5 * M * rate * rate, M * rate * rate);
    compare(ENERGY, (double)out->potential_energy, potential, self->whole_mass * gravity * self->reach);
}

static void test_the_closed_form_is_that_of_the_gauss_engine(void)
{
    for_all_trials(check_closed_form);
}

/* dE/dt = sum of m xd . xdd - f . xd, of the engine's motion; e works as the couples do. */
static void check_powers(trial *self)
{
    const double rate = (double)self->x[1];
    double change = 0, work = 0, size = fabs(rate) * torque_size(self);
    for (int i = 0; i < self->particles; i++) {
        for (int j = 0; j < 3; j++) {
            const double v = (double)self->judged.motion.velocity[i][j];
            const double gain = self->mass[i] * v * (double)self->judged.motion.particle_acceleration[i][j];
            change += gain - self->mass[i] * self->gravity[j] * v;
            work += (double)self->out.constraint_force[i][j] * v;
            size += fabs(gain);
        }
    }
    const mct_evaluation *const out = &self->out;
    compare(POWER, energy_rate(out), change, size);
    compare(WORK, work, self->couple * rate, size);
}

static void test_energy_changes_by_torque_and_friction_and_constraints_work_as_these_couples_alone(void)
{
    for_all_trials(check_powers);
}

/* ---- its relatives ---- */

/* One particle upright is the pendulum; the four points of the box about axis 3 are the solid pendulum. */
static void test_one_particle_is_the_pendulum(void)
{
    test_random random = {5};
    for (int n = 0; n < 100; n++) {
        static trial now;
        const uint32_t effects = MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB_MOREAU;
        randomise(&now, &random, system_called(names[PLANE]), effects);
        const double row[] = {0.7, 0, 1.3};
        set_particles(&now.scene, row, 3);
        evaluate(&now);
        mct_scene scene = scene_of(system_called("pendulum"), MCT_STEPPER_RK4, effects);
        static const char *const same[] = {"gravity", "friction", "coulomb"};
        for (int i = 0; i < 3; i++) {
            *parameter_of(&scene, same[i]) = *parameter_of(&now.scene, same[i]);
        }
        *parameter_of(&scene, "mass") = row[0];
        *parameter_of(&scene, "length") = row[2];
        mct_constants constants;
        mct_evaluation out;
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_systems[scene.system]->prepare(&scene, 1e-3, &constants, NULL));
        mct_systems[scene.system]->evaluate(&constants, effects, now.x, now.input, &out);
        const double load = row[0] * (10 + row[2] * acceleration_size(&now));
        compare(TAU, (double)now.out.tau[0], (double)out.tau[0], torque_size(&now));
        compare(ENERGY, (double)now.out.potential_energy, (double)out.potential_energy, 20);
        for (int j = 0; j < 3; j++) {
            compare(POSITION, (double)now.out.position[0][j], (double)out.position[0][j], row[2]);
            compare(CONSTRAINT, (double)now.out.constraint_force[0][j], (double)out.constraint_force[0][j],
                    load);
        }
    }
}

static void test_the_points_of_a_box_about_axis_3_are_the_solid_pendulum(void)
{
    static const double axis[] = {0, 0, 5}, gravity[] = {0, -9.81, 0};
    static trial now;
    mct_scene box = scene_of(system_called("solid_pendulum"), MCT_STEPPER_RK4, MCT_GRAVITY);
    mct_constants constants;
    mct_evaluation out;
    const mct_real level[2] = {0, 0}, x[2] = {MCT_R(0.8), MCT_R(-2.5)};
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_systems[box.system]->prepare(&box, 1e-3, &constants, NULL));
    mct_systems[box.system]->evaluate(&constants, MCT_GRAVITY, level, 0, &out);
    now.scene = scene_of(system_called(names[SPACE]), MCT_STEPPER_RK4, MCT_GRAVITY);
    now.scene.lists[0].count = 16;
    for (int i = 0; i < 4; i++) {
        double *row = now.scene.lists[0].values + 4 * i;
        row[0] = (double)out.mass[i];
        for (int j = 0; j < 3; j++) {
            row[1 + j] = (double)out.position[i][j];
        }
    }
    set_vector(&now.scene, "axis", axis);
    set_vector(&now.scene, "gravity", gravity);
    memcpy(now.x, x, sizeof x);
    now.input = 0;
    evaluate(&now);
    mct_systems[box.system]->evaluate(&constants, MCT_GRAVITY, x, 0, &out);
    compare(MASS, (double)now.out.M[0][0], (double)out.M[0][0], (double)out.M[0][0]);
    compare(ACCELERATION, (double)now.out.acceleration[0], (double)out.acceleration[0], 20);
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 3; j++) {
            compare(CONSTRAINT, (double)now.out.constraint_force[i][j], (double)out.constraint_force[i][j],
                    50);
        }
    }
}

/* ---- the bearing ---- */

static void load_of(const trial *self, double *force, double *moment)
{
    memset(force, 0, 3 * sizeof *force);
    memset(moment, 0, 3 * sizeof *moment);
    for (int i = 0; i < self->particles; i++) {
        double x[3], e[3], once[3];
        for (int j = 0; j < 3; j++) {
            x[j] = (double)self->out.position[i][j];
            e[j] = (double)self->out.constraint_force[i][j];
            force[j] += e[j];
        }
        cross(x, e, once);
        for (int j = 0; j < 3; j++) {
            moment[j] += once[j];
        }
    }
}

/*
 * Section 5.5.1: at any angle alpha between arm and axis the particle spins steadily. What (347) gives as a torque on
 * the rotation is the bearing's moment, m w^2 d^2 sin alpha cos alpha, across the axis and turning with the body; a
 * second particle opposite takes it off the bearing, and (352) has the mass.
 */
static void test_a_skew_particle_spins_steadily_and_its_bearing_has_the_moment_of_347(void)
{
    static const double up[] = {0, 1, 0};
    const double d = 2, m = 3, w = 4;
    for (double alpha = 0.2; alpha < 1.6; alpha += 0.3) {
        static trial now;
        const double s = d * sin(alpha), c = d * cos(alpha);
        const double rows[] = {m, s, c, 0, m, -s, c, 0};
        for (int count = 1; count <= 2; count++) {
            now.scene = scene_of(system_called(names[SPACE]), MCT_STEPPER_RK4, 0);
            set_particles(&now.scene, rows, 4 * count);
            set_vector(&now.scene, "axis", up);
            now.x[0] = 0;
            now.x[1] = (mct_real)w;
            now.input = 0;
            evaluate(&now);
            double force[3], moment[3];
            load_of(&now, force, moment);
            const double size = m * w * w * d * d;
            compare(MASS, (double)now.out.M[0][0], count * m * s * s, m * d * d);
            compare(ACCELERATION, (double)now.out.acceleration[0], 0, w * w);
            compare(CONSTRAINT, force[0], count == 1 ? -m * w * w * s : 0, size);
            compare(CONSTRAINT, moment[0], 0, size);
            compare(CONSTRAINT, moment[1], 0, size);
            compare(CONSTRAINT, moment[2], count == 1 ? m * w * w * s * c : 0, size);
        }
    }
}

/* Held by dry friction on a leaning axis, a body stays where it is to the bit; and slips where friction is too small. */
static void test_dry_friction_holds_up_to_the_moment_of_the_weight(void)
{
    for (int system = 0; system < SYSTEMS; system++) {
        static trial now;
        const int number = system_called(names[system]);
        FOR_EACH_STEPPER (stepper, number, MCT_GRAVITY | MCT_COULOMB_MOREAU) {
            for (int slips = 0; slips < 2; slips++) {
                mct_scene scene = scene_of(number, stepper, MCT_GRAVITY);
                scene.initial[0] = 1.1;
                now.scene = scene;
                now.x[0] = MCT_R(1.1);
                now.x[1] = now.input = 0;
                evaluate(&now);
                scene.effects = MCT_GRAVITY | MCT_COULOMB_MOREAU;
                *parameter_of(&scene, "coulomb") = fabs((double)now.out.tau[0]) * (slips ? 0.999 : 1.001);
                mct_plant plant;
                start_plant(&plant, &scene);
                step_plant(&plant, 0, 10000);
                const bool moved = plant.state.x[0] != MCT_R(1.1) || plant.state.x[1] != 0;
                TEST_ASSERT_EQUAL_INT(slips, moved);
            }
        }
    }
}

/* ---- refusals ---- */

static void check_refused(const char *text, const char *sentence)
{
    mct_scene scene;
    mct_plant plant;
    mct_message why = {""};
    mct_status status = mct_scene_read(text, strlen(text), "scene", NULL, 0, &scene, &why);
    if (status == MCT_OK) {
        status = mct_plant_init(&plant, &scene, &why);
    }
    TEST_ASSERT_TRUE(status != MCT_OK);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, sentence), why.text);
}

#define FIXED_AXIS "[scene]\nsystem = \"fixed_axis\"\n[parameters]\n"
#define IN_PLANE   "[scene]\nsystem = \"particle_pendulum\"\n[parameters]\n"

static void test_a_body_without_inertia_about_the_axis_is_refused_with_the_figure(void)
{
    check_refused(FIXED_AXIS "axis = [1, 1, 1]\nparticles = [[1, 0.3, 0.3, 0.3], [2, -0.1, -0.1, -0.1]]\n",
                  " kg m^2 about the axis; allowed from 1e-14 kg m^2");
    check_refused(FIXED_AXIS "axis = [1, 0, 0]\nparticles = [[1, 1000, 0.5e-6, 0], [2, 2000, 0, 0]]\n",
                  "parameters.particles: found an inertia of 2.5e-13 kg m^2 about the axis; allowed from "
                  "9e-12 kg m^2");
    check_refused(
        IN_PLANE "particles = [[1, 0, 0], [2, 0, 0]]\n",
        "parameters.particles: found an inertia of 0 kg m^2 about the axis; allowed from 1e-14 kg m^2");
}

static void test_an_axis_without_direction_is_refused(void)
{
    check_refused(FIXED_AXIS "axis = [0, 0, 0]\n",
                  "parameters.axis: found 0, 0, 0; allowed a direction: not all three 0");
}

static void test_masses_that_are_not_positive_are_refused(void)
{
    check_refused(FIXED_AXIS "particles = [[1, 0, 0, 1], [0, 1, 0, 0]]\n", "found 0");
    check_refused(IN_PLANE "particles = [[-1, 0, 1]]\n", "found -1");
}

static void test_lists_of_no_particle_or_of_33_are_refused(void)
{
    char text[1024] = IN_PLANE "particles = [[1, 0, 1]";
    for (int i = 1; i < 33; i++) {
        strcat(text, ", [1, 0, 1]");
    }
    strcat(text, "]\n");
    check_refused(text, "found 33");
    check_refused(IN_PLANE "particles = []\n", "found 0");
    check_refused(IN_PLANE "particles = [[1, 0, 1, 0]]\n", "parameters.particles");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_closed_form_is_that_of_the_gauss_engine);
    RUN_TEST(test_energy_changes_by_torque_and_friction_and_constraints_work_as_these_couples_alone);
    RUN_TEST(test_one_particle_is_the_pendulum);
    RUN_TEST(test_the_points_of_a_box_about_axis_3_are_the_solid_pendulum);
    RUN_TEST(test_a_skew_particle_spins_steadily_and_its_bearing_has_the_moment_of_347);
    RUN_TEST(test_dry_friction_holds_up_to_the_moment_of_the_weight);
    RUN_TEST(test_a_body_without_inertia_about_the_axis_is_refused_with_the_figure);
    RUN_TEST(test_an_axis_without_direction_is_refused);
    RUN_TEST(test_masses_that_are_not_positive_are_refused);
    RUN_TEST(test_lists_of_no_particle_or_of_33_are_refused);
    return UNITY_END();
}

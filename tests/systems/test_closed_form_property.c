/*
 * The closed forms against the generic Gauss engine, which gets nothing but h, the masses and what acts from
 * outside.
 *
 * Forces on particles: weight; on the cart also the drive and the track's friction. Couples: friction of the
 * pole's joint; the wheel's motor and the friction of both its joints. They are computed here from the
 * scene's parameters.
 *
 * Tolerances: 1e-12 in double, 300 roundings in float (constants are rounded once in each of the two ways),
 * relative to the size of the terms that meet in a result: by Cauchy-Schwarz a force on coordinate j is at
 * most sqrt(M_jj) times the norm, weighted by mass, of what acts and accelerates; an acceleration inherits
 * |M^-1| times that.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/gauss.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "unity.h"

enum { TRIALS = TEST_CASES(10000), MOTORS = 3, N = 2 };

#define TOLERANCE (MCT_REAL_IS_FLOAT ? 300 * (double)FLT_EPSILON : 1e-12)

static const uint32_t motors[MOTORS] = {0, MCT_MOTOR_QUASI_STATIC, MCT_MOTOR_INDUCTIVE};

void setUp(void)
{
}

void tearDown(void)
{
}

/* One random case. */
typedef struct {
    mct_scene scene;
    const mct_system *system;
    uint32_t effects;
    mct_constants constants;
    mct_real x[MCT_MAX_STATES];
    mct_real input;
    mct_evaluation out;
    /* by the engine */
    int particles[MCT_MAX_PARTICLES]; /* those that have mass */
    mct_real mass[MCT_MAX_PARTICLES];
    mct_gauss_system engine;
    mct_gauss_workspace workspace;
    mct_gauss_motion motion;
    mct_real force[3 * MCT_MAX_PARTICLES];
    mct_real couple[N];
    double norm; /* of forces and accelerations, weighted by mass */
} trial;

static void place(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const trial *self = context;
    mct_hyperdual all[MCT_MAX_PARTICLES][3];
    self->system->place(&self->constants, time, q, all);
    for (int i = 0; i < self->engine.particle_count; i++) {
        memcpy(position[i], all[self->particles[i]], sizeof all[0]);
    }
}

static void randomise(trial *self, test_random *random, int system, uint32_t effects)
{
    memset(self, 0, sizeof *self);
    self->scene = scene_of(system, MCT_STEPPER_RK4, effects);
    self->system = mct_systems[system];
    self->effects = effects;
    double *p = self->scene.parameters;
    for (int i = 0; i < self->system->parameter_count; i++) { /* half an order of magnitude either way */
        p[i] *= random_scale(random, 0.3, 3);
    }
    if (system == CART_POLE) {
        *parameter_of(&self->scene, "cart_mass") = random_scale(random, 0.02, 20);
        *parameter_of(&self->scene, "pole_mass") = random_scale(random, 0.02, 20);
        *parameter_of(&self->scene, "cart_coulomb") = random_in(random, 0, 2);
        *parameter_of(&self->scene, "pole_coulomb") = random_in(random, 0, 0.1);
    } else {
        /* An arm that some body can have: its inertia exceeds that of its mass at its centre. */
        const double arm_mass = random_scale(random, 0.05, 1);
        const double centre = random_in(random, -0.1, 0.3);
        const double gyration = random_in(random, 0.02, 0.2);
        *parameter_of(&self->scene, "arm_moment") = arm_mass * centre;
        *parameter_of(&self->scene, "arm_inertia") = arm_mass * (centre * centre + gyration * gyration);
        *parameter_of(&self->scene, "arm_coulomb") = random_in(random, 0, 0.01);
        *parameter_of(&self->scene, "wheel_coulomb") = random_in(random, 0, 0.001);
    }
    *parameter_of(&self->scene, system == CART_POLE ? "cart_drag" : "arm_drag") = random_in(random, 0, 0.1);
    *parameter_of(&self->scene, system == CART_POLE ? "pole_drag" : "wheel_drag") =
        random_in(random, 0, 1e-3);
    *parameter_of(&self->scene, "static_ratio") = random_in(random, 1, 2);
    self->x[0] = (mct_real)random_in(random, -7, 7);
    self->x[1] = (mct_real)random_in(random, -7, 7);
    self->x[2] = (mct_real)random_in(random, -8, 8);
    self->x[3] = (mct_real)random_in(random, -8, 8);
    if (system == REACTION_WHEEL) {
        self->x[3] *= 20;
    }
    self->x[4] = (effects & MCT_MOTOR_INDUCTIVE) ? (mct_real)random_in(random, -3, 3) : 0;
    self->input = (mct_real)random_in(random, -10, 10);
}

static double friction_of(trial *self, const char *viscous, const char *dry, const char *square, double rate)
{
    const double sliding = (self->effects & MCT_COULOMB_MOREAU) ? *parameter_of(&self->scene, dry) : 0;
    const double damping = (self->effects & MCT_VISCOUS) ? *parameter_of(&self->scene, viscous) : 0;
    const double drag = (self->effects & MCT_DRAG) ? *parameter_of(&self->scene, square) : 0;
    return -(damping + drag * fabs(rate)) * rate - (rate > 0 ? sliding : rate < 0 ? -sliding : 0);
}

static double current_of(trial *self, double motor_rate)
{
    if (self->effects & MCT_MOTOR_INDUCTIVE) {
        return (double)self->x[4];
    }
    return ((double)self->input - *parameter_of(&self->scene, "back_emf_constant") * motor_rate) /
           *parameter_of(&self->scene, "resistance");
}

/* What acts, computed from parameters and state; the current's rate is returned. */
static void apply_forces(trial *self)
{
    const double v1 = (double)self->x[2];
    const double v2 = (double)self->x[3];
    const double gravity = (self->effects & MCT_GRAVITY) ? *parameter_of(&self->scene, "gravity") : 0;
    const bool motor = self->effects & MCT_MOTOR;
    for (int i = 0; i < self->engine.particle_count; i++) {
        self->force[3 * i + 1] = (mct_real)(-(double)self->mass[i] * gravity);
    }
    if (self->system == mct_systems[CART_POLE]) {
        const double ratio =
            *parameter_of(&self->scene, "gear_ratio") / *parameter_of(&self->scene, "pulley_radius");
        const double torque_constant = *parameter_of(&self->scene, "torque_constant");
        const double drive =
            motor ? ratio * torque_constant * current_of(self, ratio * v1) : (double)self->input;
        self->force[0] =
            (mct_real)(drive + friction_of(self, "cart_friction", "cart_coulomb", "cart_drag", v1));
        self->couple[1] = (mct_real)friction_of(self, "pole_friction", "pole_coulomb", "pole_drag", v2);
    } else {
        const double torque_constant = *parameter_of(&self->scene, "torque_constant");
        const double drive = motor ? torque_constant * current_of(self, v2) : (double)self->input;
        self->couple[0] = (mct_real)friction_of(self, "arm_friction", "arm_coulomb", "arm_drag", v1);
        self->couple[1] =
            (mct_real)(drive + friction_of(self, "wheel_friction", "wheel_coulomb", "wheel_drag", v2));
    }
}

static void run_engine(trial *self)
{
    double whole = 0;
    for (int i = 0; i < self->system->particle_count; i++) {
        whole += (double)self->out.mass[i];
    }
    int count = 0;
    for (int i = 0; i < self->system->particle_count; i++) {
        if ((double)self->out.mass[i] > 1e-14 * whole) {
            self->particles[count] = i;
            self->mass[count++] = self->out.mass[i];
        }
    }
    self->engine = (mct_gauss_system){count, N, self->mass, place, self};
    apply_forces(self);
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_kinematics(&self->engine, 0, self->x, self->x + N,
                                                       &self->workspace, &self->motion));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_dynamics(&self->engine, self->force, self->couple,
                                                     &self->workspace, &self->motion));
    double square = 0;
    double spread = 0;
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++) {
            const double a = (double)self->motion.particle_acceleration[i][k];
            const double f = (double)self->force[3 * i + k];
            square += (double)self->mass[i] * a * a + f * f / (double)self->mass[i];
        }
    }
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) {
            spread += (double)self->motion.M[i][j] * (double)self->motion.acceleration[i] *
                      (double)self->motion.acceleration[j];
        }
    }
    self->norm = sqrt(square) + sqrt(fabs(spread));
}

static const char *const quantity_names[] = {
    "M", "Cv", "C", "tau", "acceleration", "constraint force", "position", "energy"};
enum { MASS, CV, C, TAU, ACCELERATION, CONSTRAINT, POSITION, ENERGY, QUANTITIES };
static double worst[QUANTITIES];

static void compare(int quantity, mct_real closed, mct_real engine, double size)
{
    const double error = fabs((double)closed - (double)engine) / (size > 0 ? size : 1);
    worst[quantity] = fmax(worst[quantity], error);
    if (!(error <= TOLERANCE)) {
        char text[160];
        snprintf(text, sizeof text, "%s: closed form %.17g, engine %.17g, terms of size %.3g",
                 quantity_names[quantity], (double)closed, (double)engine, size);
        TEST_FAIL_MESSAGE(text);
    }
}

static void compare_all(const trial *self)
{
    const mct_evaluation *const out = &self->out;
    const mct_gauss_motion *const motion = &self->motion;
    const double det =
        (double)out->M[0][0] * (double)out->M[1][1] - (double)out->M[0][1] * (double)out->M[1][0];
    double force_size[N];
    double acceleration_size[N];
    for (int j = 0; j < N; j++) {
        force_size[j] = sqrt((double)out->M[j][j]) * self->norm + fabs((double)self->couple[j]);
    }
    for (int j = 0; j < N; j++) {
        const double own = (double)out->M[1 - j][1 - j];
        const double other = fabs((double)out->M[0][1]);
        acceleration_size[j] = (own * force_size[j] + other * force_size[1 - j]) / det;
    }
    for (int i = 0; i < N; i++) {
        for (int j = 0; j < N; j++) {
            const double size = sqrt((double)out->M[i][i] * (double)out->M[j][j]);
            const double rate = fabs((double)self->x[2]) + fabs((double)self->x[3]);
            compare(MASS, out->M[i][j], motion->M[i][j], size);
            compare(C, out->C[i][j], motion->C[i][j], size * rate);
        }
        compare(CV, out->Cv[i], motion->Cv[i], force_size[i]);
        compare(TAU, out->tau[i], motion->tau[i], force_size[i]);
        compare(ACCELERATION, out->acceleration[i], motion->acceleration[i], acceleration_size[i]);
    }
    double kinetic = 0;
    double potential = 0;
    double potential_size = 0;
    for (int i = 0; i < self->engine.particle_count; i++) {
        const int own = self->particles[i];
        const double mass = (double)self->mass[i];
        double size = sqrt(mass) * self->norm;
        for (int j = 0; j < N; j++) {
            size += sqrt(mass * (double)out->M[j][j]) * acceleration_size[j];
        }
        for (int k = 0; k < 3; k++) {
            compare(CONSTRAINT, out->constraint_force[own][k], motion->constraint_force[i][k], size);
            compare(POSITION, out->position[own][k], motion->position[i][k], 10);
            const double velocity = (double)motion->velocity[i][k];
            kinetic += 0.5 * mass * velocity * velocity;
        }
        potential -= (double)self->force[3 * i + 1] * (double)motion->position[i][1];
        potential_size += fabs((double)self->force[3 * i + 1] * (double)motion->position[i][1]);
        if (self->system == mct_systems[CART_POLE] && i == 0) {
            potential_size += fabs((double)self->force[1]);
        }
    }
    const double v1 = fabs((double)self->x[2]);
    const double v2 = fabs((double)self->x[3]);
    compare(ENERGY, out->kinetic_energy, (mct_real)kinetic,
            (double)out->M[0][0] * v1 * v1 + (double)out->M[1][1] * v2 * v2 +
                2 * fabs((double)out->M[0][1]) * v1 * v2);
    compare(ENERGY, out->potential_energy, (mct_real)potential, potential_size);
    TEST_ASSERT_TRUE(out->M[0][1] == out->M[1][0]);
    TEST_ASSERT_TRUE(out->M[0][0] > 0 && det > 0);
}

static void for_all_trials(int system, void (*check)(const trial *))
{
    test_random random = {12345};
    memset(worst, 0, sizeof worst);
    for (int k = 0; k < TRIALS; k++) {
        static trial now;
        const uint32_t effects = ((k / 3) % 5 ? MCT_GRAVITY : 0) | ((k / 15) % 2 ? MCT_VISCOUS : 0) |
                                 ((k / 30) % 2 ? MCT_COULOMB_MOREAU : 0) | ((k / 60) % 2 ? MCT_DRAG : 0) |
                                 motors[k % MOTORS];
        randomise(&now, &random, system, effects);
        TEST_ASSERT_EQUAL_INT(MCT_OK, now.system->prepare(&now.scene, 1e-3, &now.constants, NULL));
        now.system->evaluate(&now.constants, effects, now.x, now.input, &now.out);
        run_engine(&now);
        check(&now);
    }
    printf("%s, worst in %d:", mct_systems[system]->name, TRIALS);
    for (int i = 0; i < QUANTITIES; i++) {
        printf(" %s %.1e", quantity_names[i], worst[i]);
    }
    printf("\n");
}

static void test_the_cart_poles_closed_form_is_what_gauss_principle_gives(void)
{
    for_all_trials(CART_POLE, compare_all);
}

static void test_the_reaction_wheels_closed_form_is_what_gauss_principle_gives(void)
{
    for_all_trials(REACTION_WHEEL, compare_all);
}

static void check_work_of_constraints(const trial *self)
{
    double power = 0;
    double size = 0;
    for (int i = 0; i < self->engine.particle_count; i++) {
        for (int k = 0; k < 3; k++) {
            power += (double)self->out.constraint_force[self->particles[i]][k] *
                     (double)self->motion.velocity[i][k];
            size += sqrt((double)self->mass[i]) * fabs((double)self->motion.velocity[i][k]);
        }
    }
    double couple_size = 0;
    double amplification = 1; /* e inherits the error of the accelerations */
    const double det =
        (double)self->out.M[0][0] * (double)self->out.M[1][1] - pow((double)self->out.M[0][1], 2);
    amplification += (double)self->out.M[0][0] * (double)self->out.M[1][1] / det;
    for (int j = 0; j < N; j++) {
        power -= (double)self->couple[j] * (double)self->x[N + j];
        couple_size += fabs((double)self->couple[j] * (double)self->x[N + j]);
    }
    worst[CONSTRAINT] = fmax(worst[CONSTRAINT], fabs(power) / (size * self->norm + couple_size));
    TEST_ASSERT_TRUE(fabs(power) <= TOLERANCE * amplification * (size * self->norm + couple_size));
}

static void test_constraint_forces_do_the_work_of_the_couples_and_no_other(void)
{
    for_all_trials(CART_POLE, check_work_of_constraints);
    for_all_trials(REACTION_WHEEL, check_work_of_constraints);
}

/* dE/dt of the raw Lagrangian energy along the closed form's motion, by a central difference in quadruple
 * precision. */
static void check_power_balance(const trial *self)
{
    const reference_model model = reference_of(&self->scene);
    const mct_evaluation *const out = &self->out;
    const quad small = (quad)1e-11;
    quad rate[REFERENCE_STATES] = {0};
    quad ahead[REFERENCE_STATES] = {0};
    quad behind[REFERENCE_STATES] = {0};
    quad now[REFERENCE_STATES] = {0};
    for (int i = 0; i < 2 * N + 1; i++) {
        now[i] = self->x[i];
    }
    reference_rate(&model, now, self->input, rate); /* the current's rate */
    for (int i = 0; i < N; i++) {
        rate[i] = self->x[N + i];
        rate[N + i] = out->acceleration[i];
    }
    for (int i = 0; i < 2 * N + 1; i++) {
        ahead[i] = now[i] + small * rate[i];
        behind[i] = now[i] - small * rate[i];
    }
    const double change =
        (double)((reference_energy(&model, ahead) - reference_energy(&model, behind)) / (2 * small));
    const double sum = energy_rate(out);
    const double det = (double)out->M[0][0] * (double)out->M[1][1] - pow((double)out->M[0][1], 2);
    const double amplification = 1 + (double)out->M[0][0] * (double)out->M[1][1] / det;
    double size = fabs((double)out->power_input) + fabs((double)out->power_resistance) +
                  fabs((double)out->power_conversion);
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        size += fabs((double)out->power[i]);
    }
    for (int j = 0; j < N; j++) {
        size += sqrt((double)out->M[j][j]) * self->norm * fabs((double)self->x[N + j]) * amplification;
    }
    worst[ENERGY] = fmax(worst[ENERGY], fabs(change - sum) / size);
    TEST_ASSERT_TRUE(fabs(change - sum) <= TOLERANCE * size);
    TEST_ASSERT_TRUE(out->power[MCT_EFFECT_VISCOUS] <= 0 && out->power[MCT_EFFECT_COULOMB] <= 0 &&
                     out->power_resistance <= 0);
    TEST_ASSERT_TRUE((self->effects & MCT_MOTOR) != 0 ||
                     (out->power_resistance == 0 && out->power_conversion == 0));
}

static void test_the_power_balance_closes_also_for_unequal_motor_constants(void)
{
    for_all_trials(CART_POLE, check_power_balance);
    for_all_trials(REACTION_WHEEL, check_power_balance);
}

/*
 * The determinant of M near upright is that of the light cart alone: taken as a difference, float would be
 * off by 6 % and double by 1e-10. Tolerance: some roundings of the constants, no cancellation.
 */
static void test_accelerations_keep_their_digits_with_a_cart_of_a_millionth_of_the_pole(void)
{
    static const double angles[] = {0, 1e-5, 1e-3, 0.1, 3.1415926535};
    for (size_t n = 0; n < sizeof angles / sizeof angles[0]; n++) {
        mct_scene scene = scene_of(CART_POLE, MCT_STEPPER_RK4, MCT_GRAVITY);
        *parameter_of(&scene, "cart_mass") = 1e-6;
        *parameter_of(&scene, "pole_mass") = 1;
        const reference_model model = reference_of(&scene);
        mct_constants constants;
        mct_evaluation out;
        const mct_real x[MCT_MAX_STATES] = {0, (mct_real)angles[n], 0, 3, 0};
        quad exact_x[REFERENCE_STATES];
        quad rate[REFERENCE_STATES];
        for (int i = 0; i < REFERENCE_STATES; i++) {
            exact_x[i] = x[i];
        }
        const mct_system *const system = mct_systems[CART_POLE];
        TEST_ASSERT_EQUAL_INT(MCT_OK, system->prepare(&scene, 1e-3, &constants, NULL));
        system->evaluate(&constants, scene.effects, x, 1, &out);
        reference_rate(&model, exact_x, 1, rate);
        mct_real alone[N], s, c;
        mct_sincos(x[1], &s, &c);
        system->actuation->accelerate(&constants, scene.effects, x, s, c, 1, alone);
        for (int i = 0; i < N; i++) {
            const double exact = (double)rate[N + i];
            const double tolerance = 50 * (double)MCT_REAL_EPSILON;
            TEST_ASSERT_TRUE(fabs((double)out.acceleration[i] - exact) <= tolerance * fabs(exact));
            TEST_ASSERT_TRUE(fabs((double)alone[i] - exact) <= tolerance * fabs(exact));
        }
    }
}

static void test_particles_have_no_negative_mass_by_default(void)
{
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        const mct_scene scene = scene_of(system, MCT_STEPPER_RK4, MCT_GRAVITY);
        mct_constants constants;
        mct_evaluation out;
        const mct_real x[MCT_MAX_STATES] = {0};
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_systems[system]->prepare(&scene, 1e-3, &constants, NULL));
        mct_systems[system]->evaluate(&constants, scene.effects, x, 0, &out);
        for (int i = 0; i < mct_systems[system]->particle_count; i++) {
            TEST_ASSERT_TRUE(out.mass[i] >= 0);
        }
    }
}

/* A coordinate at rest either stays, held by no more than static friction, or starts against the dynamic one. */
static void test_dry_friction_at_rest_holds_or_gives_way_against_the_motion(void)
{
    test_random random = {99};
    int held = 0;
    for (int k = 0; k < 4000; k++) {
        static trial now;
        randomise(&now, &random, k % 2, MCT_GRAVITY | MCT_COULOMB_MOREAU | motors[k % MOTORS]);
        const int resting = 1 + (k / 2) % 3; /* bit i: coordinate i rests */
        for (int i = 0; i < N; i++) {
            now.x[N + i] = (resting >> i) & 1 ? 0 : now.x[N + i];
        }
        TEST_ASSERT_EQUAL_INT(MCT_OK, now.system->prepare(&now.scene, 1e-3, &now.constants, NULL));
        now.system->evaluate(&now.constants, now.effects, now.x, now.input, &now.out);
        mct_evaluation smooth;
        mct_scene frictionless = now.scene;
        frictionless.effects &= ~(uint32_t)MCT_COULOMB_MOREAU;
        mct_constants constants;
        TEST_ASSERT_EQUAL_INT(MCT_OK, now.system->prepare(&frictionless, 1e-3, &constants, NULL));
        now.system->evaluate(&constants, frictionless.effects, now.x, now.input, &smooth);
        static const char *const names[2][N] = {{"cart_coulomb", "pole_coulomb"},
                                                {"arm_coulomb", "wheel_coulomb"}};
        for (int i = 0; i < N; i++) {
            const double size = *parameter_of(&now.scene, names[k % 2][i]);
            const double most = size * *parameter_of(&now.scene, "static_ratio");
            const double dry = (double)now.out.tau[i] - (double)smooth.tau[i];
            const double slack = 100 * (double)MCT_REAL_EPSILON * (fabs((double)smooth.tau[i]) + size);
            const double a = (double)now.out.acceleration[i];
            const double force_size =
                fabs((double)smooth.tau[0]) + fabs((double)smooth.tau[1]) + fabs((double)smooth.Cv[0]);
            const double det =
                (double)now.out.M[0][0] * (double)now.out.M[1][1] - pow((double)now.out.M[0][1], 2);
            const double still = 100 * (double)MCT_REAL_EPSILON * force_size *
                                 ((double)now.out.M[0][0] + (double)now.out.M[1][1]) / det;
            TEST_ASSERT_TRUE(fabs(dry) <= most + slack);
            if (!((resting >> i) & 1)) {
                TEST_ASSERT_TRUE(fabs(dry + (now.x[N + i] > 0 ? size : -size)) <= slack);
            } else if (fabs(a) > still) {
                TEST_ASSERT_TRUE(fabs(dry + (a > 0 ? size : -size)) <= slack);
            } else {
                held++;
            }
        }
    }
    TEST_ASSERT_TRUE(held > 100);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_cart_poles_closed_form_is_what_gauss_principle_gives);
    RUN_TEST(test_the_reaction_wheels_closed_form_is_what_gauss_principle_gives);
    RUN_TEST(test_constraint_forces_do_the_work_of_the_couples_and_no_other);
    if (HAVE_REFERENCE) { /* gcc; the others check all the rest */
        RUN_TEST(test_the_power_balance_closes_also_for_unequal_motor_constants);
        RUN_TEST(test_accelerations_keep_their_digits_with_a_cart_of_a_millionth_of_the_pole);
    }
    RUN_TEST(test_particles_have_no_negative_mass_by_default);
    RUN_TEST(test_dry_friction_at_rest_holds_or_gives_way_against_the_motion);
    return UNITY_END();
}

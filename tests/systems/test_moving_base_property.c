/*
 * The pendulum with a moving base: its closed form against the generic Gauss engine, which gets nothing but
 * x = h(t, q), the mass and what acts from outside; its power balance; its clock; what it refuses.
 *
 * Tolerances: 1e-12 in double, 300 roundings in float, relative to the size of the terms that meet in a result. The
 * base's phase in the engine is a product of frequency and time, which itself rounds to that; hence the times are
 * short.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/gauss.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

enum { TRIALS = TEST_CASES(10000) };

#define TOLERANCE (MCT_REAL_IS_FLOAT ? 300 * (double)FLT_EPSILON : 1e-12)
#define TURN      6.283185307179586

static int system_number;

void setUp(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, "moving_base") == 0) {
            system_number = i;
        }
    }
}

void tearDown(void)
{
}

typedef struct {
    mct_scene scene;
    uint32_t effects;
    mct_constants constants;
    mct_real x[MCT_MAX_STATES];
    mct_real time;
    mct_real input;
    mct_evaluation out;
    mct_gauss_workspace workspace;
    mct_gauss_motion motion;
    double force[3]; /* on the bob */
    double couple;
} trial;

static void randomise(trial *self, test_random *random, uint32_t effects)
{
    memset(self, 0, sizeof *self);
    self->effects = effects;
    self->scene = scene_of(system_number, MCT_STEPPER_RK4, effects);
    *parameter_of(&self->scene, "mass") = random_scale(random, 0.01, 10);
    *parameter_of(&self->scene, "length") = random_scale(random, 0.03, 3);
    *parameter_of(&self->scene, "gravity") = random_in(random, 0, 20);
    *parameter_of(&self->scene, "friction") = random_scale(random, 1e-4, 0.1);
    *parameter_of(&self->scene, "base_amplitude_1") = random_scale(random, 1e-3, 1);
    *parameter_of(&self->scene, "base_amplitude_2") = random_scale(random, 1e-3, 1);
    *parameter_of(&self->scene, "base_frequency_1") = random_scale(random, 0.1, 300);
    *parameter_of(&self->scene, "base_frequency_2") = random_scale(random, 0.1, 300);
    *parameter_of(&self->scene, "base_phase_1") = random_in(random, -3, 3);
    *parameter_of(&self->scene, "base_phase_2") = random_in(random, -3, 3);
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          mct_systems[system_number]->prepare(&self->scene, 1e-3, &self->constants, NULL));
    self->x[0] = (mct_real)random_in(random, -7, 7);
    self->x[1] = (mct_real)random_in(random, -8, 8);
    self->time = (mct_real)random_in(random, 0, 0.01);
    self->input = (mct_real)random_in(random, -1, 1);
    if (effects & MCT_BASE_MOTION) {
        self->x[2] = self->constants.moving_base.base[0].frequency * self->time;
        self->x[3] = self->constants.moving_base.base[1].frequency * self->time;
    }
    mct_systems[system_number]->evaluate(&self->constants, effects, self->x, self->input, &self->out);
}

/* As the engine hands it over: behind the angle comes the clock. */
static void place(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const trial *self = context;
    const mct_hyperdual positions[3] = {q[0], mct_hyperdual_constant(self->x[2]),
                                        mct_hyperdual_constant(self->x[3])};
    mct_systems[system_number]->place(&self->constants, time, positions, position);
}

/* The engine, with forces from the scene's parameters. */
static void run_engine(trial *self)
{
    const mct_real mass = (mct_real)*parameter_of(&self->scene, "mass");
    const double gravity = (self->effects & MCT_GRAVITY) ? *parameter_of(&self->scene, "gravity") : 0;
    const double friction = (self->effects & MCT_VISCOUS) ? *parameter_of(&self->scene, "friction") : 0;
    const mct_gauss_system engine = {1, 1, &mass, place, self};
    self->force[1] = -(double)mass * gravity;
    self->couple = (double)self->input - friction * (double)self->x[1];
    const mct_real force[3] = {0, (mct_real)self->force[1], 0};
    const mct_real couple = (mct_real)self->couple;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_kinematics(&engine, self->time, self->x, self->x + 1,
                                                       &self->workspace, &self->motion));
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          mct_gauss_dynamics(&engine, force, &couple, &self->workspace, &self->motion));
}

enum { MASS, CV, C, TAU, ACCELERATION, CONSTRAINT, POSITION, ENERGY, POWER, QUANTITIES };
static const char *const quantity_names[] = {
    "M", "Cv", "C", "tau", "acceleration", "constraint force", "position", "energy", "power"};
static double worst[QUANTITIES];

static void compare(int quantity, mct_real closed, double engine, double size)
{
    const double error = fabs((double)closed - engine) / (size > 0 ? size : 1);
    worst[quantity] = fmax(worst[quantity], error);
    if (!(error <= TOLERANCE)) {
        char text[160];
        snprintf(text, sizeof text, "%s: closed form %.17g, engine %.17g, terms of size %.3g",
                 quantity_names[quantity], (double)closed, engine, size);
        TEST_FAIL_MESSAGE(text);
    }
}

/* What can meet in an acceleration of the bob, times its mass [N]. */
static double force_size(trial *self)
{
    const double m = *parameter_of(&self->scene, "mass");
    const double l = *parameter_of(&self->scene, "length");
    double base = 0;
    if (self->effects & MCT_BASE_MOTION) {
        base = *parameter_of(&self->scene, "base_amplitude_1") *
                   pow(*parameter_of(&self->scene, "base_frequency_1"), 2) +
               *parameter_of(&self->scene, "base_amplitude_2") *
                   pow(*parameter_of(&self->scene, "base_frequency_2"), 2);
    }
    const double w = (double)self->x[1];
    return m * (base + l * w * w) + fabs(self->force[1]) +
           (fabs((double)self->input) + fabs(self->couple)) / l;
}

static double velocity_size(trial *self)
{
    double base = 0;
    if (self->effects & MCT_BASE_MOTION) {
        base =
            *parameter_of(&self->scene, "base_amplitude_1") *
                *parameter_of(&self->scene, "base_frequency_1") +
            *parameter_of(&self->scene, "base_amplitude_2") * *parameter_of(&self->scene, "base_frequency_2");
    }
    return base + *parameter_of(&self->scene, "length") * fabs((double)self->x[1]);
}

static void for_all_trials(void (*check)(trial *))
{
    test_random random = {4711};
    memset(worst, 0, sizeof worst);
    for (int n = 0; n < TRIALS; n++) {
        static trial now;
        const uint32_t effects =
            ((n & 1) ? MCT_GRAVITY : 0) | ((n & 2) ? MCT_VISCOUS : 0) | ((n & 4) ? MCT_BASE_MOTION : 0);
        randomise(&now, &random, effects);
        run_engine(&now);
        check(&now);
    }
    printf("worst in %d:", TRIALS);
    for (int i = 0; i < QUANTITIES; i++) {
        if (worst[i] > 0) {
            printf(" %s %.1e", quantity_names[i], worst[i]);
        }
    }
    printf("\n");
}

static void check_closed_form(trial *self)
{
    const mct_evaluation *const out = &self->out;
    const mct_gauss_motion *const motion = &self->motion;
    const double l = *parameter_of(&self->scene, "length");
    const double force = force_size(self);
    const double M = (double)motion->M[0][0];
    compare(MASS, out->M[0][0], M, M);
    compare(C, out->C[0][0], (double)motion->C[0][0], M * fabs((double)self->x[1]));
    compare(CV, out->Cv[0], (double)motion->Cv[0], l * force);
    compare(TAU, out->tau[0], (double)motion->tau[0], l * force);
    compare(ACCELERATION, out->acceleration[0], (double)motion->acceleration[0], l * force / M);
    double square = 0;
    for (int axis = 0; axis < 3; axis++) {
        compare(POSITION, out->position[0][axis], (double)motion->position[0][axis], l + 2);
        compare(CONSTRAINT, out->constraint_force[0][axis], (double)motion->constraint_force[0][axis], force);
        square += pow((double)motion->velocity[0][axis], 2);
    }
    const double m = *parameter_of(&self->scene, "mass");
    compare(ENERGY, out->kinetic_energy, 0.5 * m * square, m * pow(velocity_size(self), 2));
    compare(ENERGY, out->potential_energy, -self->force[1] * (double)motion->position[0][1],
            fabs(self->force[1]) * (l + 2));
}

static void test_the_closed_form_is_what_gauss_principle_gives_under_explicit_time(void)
{
    for_all_trials(check_closed_form);
}

/* dE/dt = m xd . xdd + m g yd, of the engine's motion. */
static void check_powers(trial *self)
{
    const double m = *parameter_of(&self->scene, "mass");
    double change = -self->force[1] * (double)self->motion.velocity[0][1];
    for (int axis = 0; axis < 3; axis++) {
        change +=
            m * (double)self->motion.velocity[0][axis] * (double)self->motion.particle_acceleration[0][axis];
    }
    compare(POWER, (mct_real)energy_rate(&self->out), change, force_size(self) * velocity_size(self));
}

static void test_energy_changes_by_input_friction_and_the_work_of_the_base(void)
{
    for_all_trials(check_powers);
}

/* ---- errata ---- */

static double worst_printed;

/* (185), (186) as printed: gravity without l, and the base's term without m l. */
static void check_printed_equation(trial *self)
{
    const double m = *parameter_of(&self->scene, "mass");
    const double l = *parameter_of(&self->scene, "length");
    const double g = (self->effects & MCT_GRAVITY) ? *parameter_of(&self->scene, "gravity") : 0;
    const double s = sin((double)self->x[0]);
    const double c = cos((double)self->x[0]);
    double u[2] = {0, 0};
    for (int axis = 0; axis < 2 && (self->effects & MCT_BASE_MOTION); axis++) {
        const mct_base_axis *base = &self->constants.moving_base.base[axis];
        u[axis] = -(double)base->peak * cos((double)self->x[2 + axis] + (double)base->phase);
    }
    const double base_term = u[0] * c - u[1] * s; /* its components summed */
    const double printed = (m * g * s + self->couple - base_term) / (m * l * l);
    const double corrected = (m * g * l * s + self->couple - m * l * base_term) / (m * l * l);
    const double size = l * force_size(self) / (m * l * l);
    const double engine = (double)self->motion.acceleration[0];
    worst_printed = fmax(worst_printed, fabs(printed - engine) / size);
    compare(ACCELERATION, (mct_real)corrected, engine, size);
}

static void test_equation_186_holds_with_a_moment_m_l_and_fails_as_printed(void)
{
    worst_printed = 0;
    for_all_trials(check_printed_equation);
    printf("as printed: off by %.1g of the terms' size\n", worst_printed);
    TEST_ASSERT_TRUE(worst_printed > 0.1);
}

/* ---- the clock ---- */

/* Distance of two angles around the turn. */
static double apart(double a, double b)
{
    return fabs(remainder(a - b, TURN));
}

/*
 * An hour of ticks; 200.1 rad/s and 1 ms are no binary fractions. Allowed: roundings of the compensation, half a unit in
 * its last place (2^-25 2^-23 in float) a tick and as much a turn, all of one sign.
 */
static void test_the_phase_of_the_base_does_not_drift(void)
{
    const long ticks = TEST_CASES(3600000);
    const double seconds = (double)ticks / 1000;
    mct_scene scene = scene_of(system_number, MCT_STEPPER_EULER, MCT_BASE_MOTION);
    *parameter_of(&scene, "base_frequency_1") = 200.1;
    *parameter_of(&scene, "base_frequency_2") = 0.3;
    mct_plant plant;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, ticks);
    const double expected_1 =
        remainder(fmod(200.1 * 1e-3 * 1000, TURN) + fmod(200.1 * (seconds - 1), TURN), TURN);
    const double error_1 = apart((double)plant.state.x[2] + (double)plant.state.c[2], expected_1);
    const double error_2 = apart((double)plant.state.x[3] + (double)plant.state.c[3], 0.3 * seconds);
    /* 7e5 rad in double are known to 1e-10, the frequency's own rounding. */
    const double allowed = MCT_REAL_IS_FLOAT ? (double)ticks * 1.5e-14 : 3e-10;
    printf("after %.0f s: off by %.1e and %.1e rad, allowed %.1e\n", seconds, error_1, error_2, allowed);
    TEST_ASSERT_TRUE(error_1 < allowed && error_2 < allowed);
}

static void test_all_steppers_turn_the_base_alike_to_the_last_bit(void)
{
    static const int steppers[] = {MCT_STEPPER_SEED, MCT_STEPPER_EULER, MCT_STEPPER_LEAP, MCT_STEPPER_RK4};
    mct_plant plants[4];
    for (int i = 0; i < 4; i++) {
        const mct_scene scene = scene_of(system_number, steppers[i], MCT_BASE_MOTION | MCT_VISCOUS);
        start_plant(&plants[i], &scene);
        step_plant(&plants[i], 0, 1000);
        for (int k = 2; k < 4; k++) {
            TEST_ASSERT_TRUE(plants[i].state.x[k] == plants[0].state.x[k]);
            TEST_ASSERT_TRUE(plants[i].state.c[k] == plants[0].state.c[k]);
        }
    }
}

static void test_a_state_put_back_goes_on_as_it_would_have(void)
{
    mct_scene scene = scene_of(system_number, MCT_STEPPER_RK4, mct_systems[system_number]->standard_effects);
    mct_plant whole;
    mct_plant second;
    start_plant(&whole, &scene);
    step_plant(&whole, 0, 700);
    for (int i = 0; i < 4; i++) {
        scene.initial[i] = mct_plant_value(&whole, i);
    }
    start_plant(&second, &scene);
    step_plant(&whole, 0, 700);
    step_plant(&second, 0, 700);
    for (int i = 0; i < 4; i++) {
        const double gap = mct_plant_value(&whole, i) - mct_plant_value(&second, i);
        /* An initial value is a double: what lies below its last place is lost, and amplified. */
        TEST_ASSERT_TRUE(fabs(remainder(gap, TURN)) < 1e-11 * (MCT_REAL_IS_FLOAT ? 1e3 : 1));
    }
}

static int state_count_with(uint32_t effects)
{
    const mct_scene scene = scene_of(system_number, MCT_STEPPER_LEAP, effects);
    return mct_state_count(&scene);
}

static void test_without_base_motion_there_is_no_phase_and_the_base_rests(void)
{
    const mct_system *const system = mct_systems[system_number];
    TEST_ASSERT_EQUAL_INT(4, state_count_with(MCT_BASE_MOTION | MCT_GRAVITY));
    TEST_ASSERT_EQUAL_INT(2, state_count_with(MCT_GRAVITY));
    TEST_ASSERT_EQUAL_STRING("base_angle_2", mct_state_field(system, 3)->name);
    const mct_scene scene = scene_of(system_number, MCT_STEPPER_LEAP, MCT_GRAVITY);
    mct_plant plant;
    mct_evaluation out;
    start_plant(&plant, &scene);
    step_plant(&plant, 0, 100);
    mct_plant_evaluate(&plant, &out);
    TEST_ASSERT_TRUE(out.power[MCT_EFFECT_BASE_MOTION] == 0 && out.Cv[0] == 0);
    TEST_ASSERT_TRUE(plant.state.x[2] == 0 && plant.state.x[3] == 0);
}

static void test_a_base_too_fast_for_the_step_is_refused_with_a_sentence(void)
{
    mct_scene scene = scene_of(system_number, MCT_STEPPER_LEAP, mct_systems[system_number]->standard_effects);
    mct_plant plant;
    mct_message why = {""};
    *parameter_of(&scene, "base_frequency_2") = 4000;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, mct_plant_init(&plant, &scene, &why));
    TEST_ASSERT_EQUAL_STRING(
        "parameters.base_frequency_2: found 4000, more than half an oscillation in a step; "
        "allowed at most 3141.59265 at this dt and substeps",
        why.text);
    scene.substeps = 2;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_plant_init(&plant, &scene, &why));
    scene.substeps = 1;
    scene.effects = MCT_GRAVITY;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_plant_init(&plant, &scene, &why));
}

static void test_an_initial_phase_without_base_motion_is_refused_with_a_sentence(void)
{
    static const char text[] = "[scene]\nsystem = \"moving_base\"\n[effects]\nbase_motion = false\n"
                               "[initial]\nbase_angle_1 = 1.0\n";
    mct_scene scene;
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED,
                          mct_scene_read(text, sizeof text - 1, "here", NULL, 0, &scene, &why));
    TEST_ASSERT_EQUAL_STRING(
        "here:6: initial.base_angle_1: found a state that the scene has not; allowed with "
        "effects.base_motion = true",
        why.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_closed_form_is_what_gauss_principle_gives_under_explicit_time);
    RUN_TEST(test_energy_changes_by_input_friction_and_the_work_of_the_base);
    RUN_TEST(test_equation_186_holds_with_a_moment_m_l_and_fails_as_printed);
    RUN_TEST(test_the_phase_of_the_base_does_not_drift);
    RUN_TEST(test_all_steppers_turn_the_base_alike_to_the_last_bit);
    RUN_TEST(test_a_state_put_back_goes_on_as_it_would_have);
    RUN_TEST(test_without_base_motion_there_is_no_phase_and_the_base_rests);
    RUN_TEST(test_a_base_too_fast_for_the_step_is_refused_with_a_sentence);
    RUN_TEST(test_an_initial_phase_without_base_motion_is_refused_with_a_sentence);
    return UNITY_END();
}

/*
 * What holds of every system whatever its stepper: the mirrored start gives the mirrored motion, to the bit; an equilibrium
 * stays one exactly; and with a symmetric stepper a motion that is turned back returns to its start.
 *
 * Angles are mirrored and at rest where they are 0, the one place where a sine is exact: a pendulum at pi is 1e-16 off. The
 * rigid body's axes are its principal ones: where they are not, rounding turns it by 1e-28 at rest (by 1e-11 in float).
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/sincos.h"
#include "support/invariants.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

enum { MOST_SETTINGS = 3, MOST_ROWS = 16 };

typedef struct {
    const char *system;
    uint32_t not_mirrored; /* effects that have a direction of their own, which the mirror does not keep */
    uint32_t mirror;       /* bit i: state i changes its sign; the input does with it */
    uint32_t not_at_rest;  /* effects that move what is at rest here */
    struct {
        const char *name; /* of a parameter, or of a coordinate where all may be at rest */
        double value;
    } setting[MOST_SETTINGS], rest[MOST_SETTINGS];
    double particles[MOST_ROWS]; /* of the first list, if not those of the scene's default */
    int numbers;
} fact;

#define ON_AXIS_2                 \
    {                             \
        0.05, 0, 0.1, 0.1, 0, 0.3 \
    }
static const fact facts[] = {
    {"cart_pole", 0, 0x1F, 0, {{0}}, {{"pole_angle", 0}}, {0}, 0},
    {"reaction_wheel", 0, 0x1F, 0, {{0}}, {{"arm_angle", 0}}, {0}, 0},
    {"pendulum", 0, 0x3, 0, {{0}}, {{"angle", 0}}, {0}, 0},
    /* a turn of the rod about the pivot, at the rest length */
    {"spring_pendulum", MCT_GRAVITY, 0xA, MCT_GRAVITY, {{0}}, {{"length", 0.3}, {"angle", 0.7}}, {0}, 0},
    {"linked_particles", MCT_FORCES, 0x3, MCT_FORCES, {{0}}, {{0}}, {0}, 0},
    {"particle_pendulum", 0, 0x3, 0, {{0}}, {{"angle", 0}}, ON_AXIS_2, 6},
    {"moving_base", 0, 0x3, 0, {{0}}, {{"angle", 0}}, {0}, 0}, /* shaken upwards; its phases go on */
    /* half a turn about the axis of the frame */
    {"rotating_frame", MCT_GRAVITY, 0x1B, MCT_GRAVITY, {{0}}, {{"position_2", 0}}, {0}, 0},
    /* across the plane of axes 1 and 2: a turn about an axis in that plane changes its sign */
    {"ball_joint", 0, 0x36, 0, {{0}}, {{0}}, {0}, 0},
    {"fixed_axis", 0, 0x3, 0, {{"axis_1", 0}}, {{0}}, {0}, 0},             /* a vertical one */
    {"solid_pendulum", 0, 0x3, 0, {{"pivot_offset", 0.5}}, {{0}}, {0}, 0}, /* on an axle through its centre */
    {"rigid_body", MCT_FORCES, 0xE34, MCT_GRAVITY | MCT_FORCES, {{0}}, {{0}}, {0}, 0},
    {"block", MCT_GRAVITY | MCT_FORCING, 0x3, MCT_FORCING, {{"slope", 0.2}}, {{0}}, {0}, 0},
    {"falling_sphere",
     MCT_GRAVITY | MCT_BUOYANCY,
     0x3,
     0,
     {{"density", 1000}, {"fluid_density", 1000}, {"fluid_viscosity", 0.001}},
     {{0}},
     {0},
     0},
};
enum { FACTS = sizeof facts / sizeof facts[0] };

/* A scene of a system by its fact, at its default start. */
static mct_scene scene_by(const fact *self)
{
    mct_scene scene;
    mct_scene_defaults(&scene, system_called(self->system));
    for (int i = 0; i < MOST_SETTINGS && self->setting[i].name != NULL; i++) {
        *parameter_of(&scene, self->setting[i].name) = self->setting[i].value;
    }
    if (self->numbers > 0) {
        scene.lists[0].count = self->numbers;
        memcpy(scene.lists[0].values, self->particles, sizeof self->particles);
    }
    return scene;
}

static uint32_t drawn_effects(test_random *random, const mct_system *system)
{
    uint32_t effects = 0;
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        const uint32_t bits =
            mct_effects[i].bits[(int)random_in(random, 0, mct_effects[i].choices != NULL ? 3 : 2)];
        effects |= bits & system->effects;
    }
    return effects;
}

/* Every system that moves has its fact: a new one has to be given one. */
static void test_every_system_with_a_motion_has_its_symmetry_and_its_equilibrium(void)
{
    int moving = 0;
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        moving += !mct_systems[i]->is_process;
    }
    TEST_ASSERT_EQUAL_INT(moving, FACTS);
}

static void check_mirror(const fact *self, mct_scene *scene, test_random *random)
{
    static mct_plant plants[2];
    const mct_system *system = mct_systems[scene->system];
    mct_scene mirrored;
    const int states = mct_state_count(scene);
    for (int i = 0; i < states; i++) {
        if (!mct_state_is_phase(system, i)) {
            scene->initial[i] += random_in(random, 0, 0.4);
        }
    }
    mirrored = *scene;
    for (int i = 0; i < states; i++) {
        mirrored.initial[i] *= self->mirror >> i & 1 ? -1 : 1;
    }
    start_plant(&plants[0], scene);
    start_plant(&plants[1], &mirrored);
    for (int tick = 0; tick < 1000; tick++) {
        const mct_real input =
            (mct_real)(tick % 10 == 0 ? random_in(random, -1, 1) : (double)plants[0].input);
        mct_plant_step(&plants[0], input);
        mct_plant_step(&plants[1], -input);
        for (int i = 0; i < states; i++) {
            const mct_state *a = &plants[0].state, *b = &plants[1].state;
            const int sign = self->mirror >> i & 1 ? -1 : 1;
            if (a->x[i] != (mct_real)sign * b->x[i] || a->c[i] != (mct_real)sign * b->c[i] ||
                (i < system->coordinate_count && a->turns[i] != sign * b->turns[i])) {
                char text[200];
                snprintf(text, sizeof text, "%s by %s, effects %x, tick %d: %s %.17g and %.17g", self->system,
                         mct_steppers[scene->stepper].name, (unsigned)scene->effects, tick,
                         mct_state_field(system, i)->name, (double)a->x[i], (double)b->x[i]);
                TEST_FAIL_MESSAGE(text);
            }
        }
    }
}

static void test_a_mirrored_start_under_a_mirrored_input_gives_the_mirrored_motion_to_the_bit(void)
{
    test_random random = {42};
    int runs = 0;
    for (int i = 0; i < FACTS; i++) {
        for (int draw = 0; draw < 8; draw++) {
            mct_scene scene = scene_by(&facts[i]);
            const mct_system *system = mct_systems[scene.system];
            scene.effects = drawn_effects(&random, system) & ~facts[i].not_mirrored;
            FOR_EACH_STEPPER (stepper, scene.system, mct_scene_effects(&scene) & MCT_KERNEL_EFFECTS) {
                mct_scene one = scene;
                one.stepper = stepper;
                check_mirror(&facts[i], &one, &random);
                runs++;
            }
        }
    }
    printf("%d pairs of runs\n", runs);
    TEST_ASSERT_TRUE(runs > 500);
}

static void set_state(mct_scene *scene, const char *name, double value)
{
    const mct_system *system = mct_systems[scene->system];
    int index = 0;
    while (index < mct_most_states(system) && strcmp(mct_state_field(system, index)->name, name) != 0) {
        index++;
    }
    TEST_ASSERT_TRUE_MESSAGE(index < mct_most_states(system), name);
    scene->initial[index] = value;
}

static void test_an_equilibrium_stays_one_exactly(void)
{
    enum { TICKS = 100000 };
    static mct_plant plant;
    test_random random = {43};
    for (int i = 0; i < FACTS; i++) {
        for (int draw = 0; draw < 3; draw++) {
            mct_scene scene = scene_by(&facts[i]);
            const mct_system *system = mct_systems[scene.system];
            scene.effects = draw == 0 ? system->standard_effects : drawn_effects(&random, system);
            scene.effects &= ~facts[i].not_at_rest;
            if (strcmp(system->name, "block") == 0) { /* holds on its slope, where it has its friction */
                scene.effects |= scene.effects & MCT_COULOMB ? 0 : MCT_COULOMB_MOREAU;
            } else if (strcmp(system->name, "falling_sphere") == 0) { /* floats */
                scene.effects |= MCT_GRAVITY | MCT_BUOYANCY;
            }
            const int rate = mct_rate_index(system);
            for (int k = rate; k < rate + system->coordinate_count; k++) {
                scene.initial[k] = 0;
            }
            for (int k = 0; k < MOST_SETTINGS && facts[i].rest[k].name != NULL; k++) {
                set_state(&scene, facts[i].rest[k].name, facts[i].rest[k].value);
            }
            FOR_EACH_STEPPER (stepper, scene.system, mct_scene_effects(&scene) & MCT_KERNEL_EFFECTS) {
                scene.stepper = stepper;
                start_plant(&plant, &scene);
                const mct_state start = plant.state;
                step_plant(&plant, 0, TEST_CASES(TICKS));
                char text[200];
                snprintf(text, sizeof text, "%s by %s, effects %x: %g", system->name,
                         mct_steppers[stepper].name, (unsigned)scene.effects, mct_plant_value(&plant, 0));
                for (int k = 0; k < plant.states; k++) {
                    TEST_ASSERT_TRUE_MESSAGE(
                        mct_state_is_phase(system, k) ||
                            (plant.state.x[k] == start.x[k] && plant.state.c[k] == start.c[k]),
                        text);
                }
            }
        }
    }
}

/* What is turned back are the rates, and what rounding has kept back of them. */
static void test_a_motion_that_is_turned_back_returns_to_its_start(void)
{
    enum { STEPS = TEST_CASES(10000) };
    static const int symmetric[] = {MCT_STEPPER_LEAP, MCT_STEPPER_SPLIT3};
    static mct_plant plant;
    int runs = 0;
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        for (int s = 0; s < 4; s++) {
            mct_scene scene;
            const int stepper = symmetric[s / 2];
            if (!invariant_scene(&scene, system, stepper, s % 2 == 0) || (scene.effects & MCT_CORIOLIS)) {
                continue; /* Coriolis' force turns with the frame, which does not turn back */
            }
            start_plant(&plant, &scene);
            double start[MCT_MAX_STATES], fastest = 0, worst = 0;
            const int rate = mct_rate_index(plant.system);
            for (int i = 0; i < plant.states; i++) {
                start[i] = mct_plant_value(&plant, i);
            }
            for (int half = 0; half < 2; half++) {
                for (int step = 0; step < STEPS; step++) {
                    mct_plant_step(&plant, 0);
                    for (int i = rate; i < plant.states; i++) {
                        fastest = fmax(fastest, fabs((double)plant.state.x[i]));
                    }
                }
                for (int i = rate; i < plant.states; i++) {
                    plant.state.x[i] = -plant.state.x[i];
                    plant.state.c[i] = -plant.state.c[i];
                }
            }
            for (int i = 0; i < plant.states; i++) {
                worst = fmax(worst, fabs(mct_plant_value(&plant, i) - start[i]));
            }
            const double roundings = worst / ((double)MCT_REAL_EPSILON * fmax(1, fastest));
            printf("%-18s %-7s%s: off by %.2g, %.2g roundings\n", plant.system->name,
                   mct_steppers[stepper].name, s % 2 == 0 ? "" : " without weight", worst, roundings);
            /* A tenth of one in each step: a top under its weight adds them up; others have fewer than ten in all. */
            TEST_ASSERT_TRUE_MESSAGE(roundings < STEPS / 10, plant.system->name);
            runs++;
        }
    }
    TEST_ASSERT_TRUE(runs > 20);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_system_with_a_motion_has_its_symmetry_and_its_equilibrium);
    RUN_TEST(test_a_mirrored_start_under_a_mirrored_input_gives_the_mirrored_motion_to_the_bit);
    RUN_TEST(test_an_equilibrium_stays_one_exactly);
    RUN_TEST(test_a_motion_that_is_turned_back_returns_to_its_start);
    return UNITY_END();
}

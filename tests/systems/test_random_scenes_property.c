/*
 * Any scene that is taken stays finite, and without a source its energy does not grow: seeded random scenes of all
 * systems, each parameter and start drawn over six decades about its default (or 1) within its declared range, each
 * effect and stepper at random. A scene is run for 60 s, or refused with a reason.
 *
 * MCT_RANDOM_SCENES=1000 MCT_RANDOM_TICKS=60000 in the environment: as many scenes, and ticks of each.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mctau/constants.h"
#include "mctau/input.h"
#include "mctau/watch.h"
#include "scene/tables.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

/*
 * What energy may grow by, over the largest exchange of energy so far: a symmetric scheme's energy swings about by the
 * error of a step, of which 0.11 is let pass; with the others errors cost energy, or have to add up to less than 0.1.
 */
#define GROWTH 0.11

void setUp(void)
{
}

void tearDown(void)
{
}

static long setting(const char *name, long otherwise)
{
    const char *text = getenv(name);
    return text != NULL ? atol(text) : otherwise;
}

/* Three decades either side of the default, or of 1, and at times nothing. */
static double six_decades(test_random *random, const mct_field *field)
{
    const double about = field->standard != 0 ? fabs(field->standard) : 1;
    const double sign = field->minimum < 0 && random_in(random, -1, 1) < 0 ? -1 : 1;
    const double drawn = random_in(random, 0, 10) < 1 ? 0 : sign * about * random_scale(random, 1e-3, 1e3);
    return fmin(fmax(drawn, field->minimum), field->maximum);
}

static double drawn_field(test_random *random, const mct_field *field)
{
    if (field->kind == MCT_FIELD_CHOICE) {
        return field->choices[0] != NULL && field->choices[1] != NULL && random_in(random, 0, 2) < 1;
    }
    return field->kind == MCT_FIELD_BOOLEAN ? (double)(random_in(random, 0, 2) < 1)
                                            : six_decades(random, field);
}

static void draw_lists(test_random *random, const mct_system *system, mct_scene *scene)
{
    for (int i = 0; i < system->list_count; i++) {
        const mct_row_list *rows = &system->lists[i];
        const int most = rows->most_rows < 6 ? rows->most_rows : 6;
        scene->lists[i].count = (int)random_in(random, rows->fewest_rows, most + 1) * rows->column_count;
        for (int j = 0; j < scene->lists[i].count; j++) {
            scene->lists[i].values[j] = drawn_field(random, &rows->columns[j % rows->column_count]);
        }
    }
}

static mct_scene drawn_scene(test_random *random, int number)
{
    const mct_system *system = mct_systems[number];
    const double wild = random_in(random, 0, 1); /* part of the keys that are not left at their defaults */
    mct_scene scene;
    mct_scene_defaults(&scene, number);
    for (int i = 0; i < system->parameter_count; i++) {
        if (random_in(random, 0, 1) < wild) {
            scene.parameters[i] = drawn_field(random, &system->parameters[i]);
        }
    }
    if (random_in(random, 0, 1) < wild) {
        draw_lists(random, system, &scene);
    }
    mct_constants constants;
    if (system->prepare(&scene, scene.dt, &constants, NULL) != MCT_OK && system->list_count > 0) {
        mct_scene defaults; /* a body given in two ways, say */
        mct_scene_defaults(&defaults, number);
        memcpy(scene.parameters, defaults.parameters, sizeof scene.parameters);
    }
    scene.effects = 0;
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        const int choice = (int)random_in(random, 0, mct_effects[i].choices != NULL ? 3 : 2);
        scene.effects |= mct_effects[i].bits[choice] & system->effects;
    }
    for (int i = 0; i < mct_state_count(&scene); i++) {
        if (random_in(random, 0, 1) < wild) {
            scene.initial[i] = six_decades(random, mct_state_field(system, i));
        }
    }
    scene.duration = 60;
    if (random_in(random, 0, 2) < 1 && (system->actuation != NULL || system->input_without_motor != NULL)) {
        scene.input = MCT_INPUT_SINE;
        scene.input_amplitude = random_scale(random, 1e-3, 1e3);
        scene.input_frequency = random_scale(random, 1e-3, 1e3);
    }
    scene.stepper = mct_best_stepper(&scene);
    const int other = (int)random_in(random, MCT_STEPPER_EULER, 2 * MCT_STEPPER_COUNT);
    if (other < MCT_STEPPER_COUNT &&
        mct_stepper_suits(&scene, other)) { /* but `seed`, which feeds every oscillation */
        scene.stepper = other;
    }
    return scene;
}

typedef struct {
    double start, scale, growth; /* [J]; growth over the scale, at most so far */
    bool is_fed;                 /* something has brought energy in */
} account;

/* Everything but forces with a potential and the motor, which takes from the magnetic energy, or brakes. */
static bool is_fed(const mct_evaluation *e)
{
    bool fed = e->power_input > 0 || e->power_conversion != 0 || e->power_frame != 0;
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        fed = fed || (!(mct_effects[i].mask & (MCT_POTENTIAL | MCT_MOTOR)) && e->power[i] > 0);
    }
    return fed;
}

static void look(account *self, const mct_plant *plant)
{
    mct_evaluation e;
    mct_plant_evaluate(plant, &e);
    const double kinetic = (double)e.kinetic_energy + (double)e.magnetic_energy;
    const double energy = kinetic + (double)e.potential_energy;
    if (plant->tick == 0) {
        self->start = energy;
    }
    self->is_fed = self->is_fed || is_fed(&e) || plant->input != 0;
    const double exchanged = kinetic + fabs((double)e.potential_energy - (self->start - kinetic));
    self->scale = fmax(self->scale, exchanged);
    const double rounding = 1000 * (double)MCT_REAL_EPSILON * (fabs(energy) + fabs(self->start) + kinetic);
    if (!self->is_fed && energy - self->start > rounding) {
        self->growth = fmax(self->growth, (energy - self->start - rounding) / self->scale);
    }
}

static void describe(const mct_scene *scene, char *text, size_t size)
{
    const mct_system *system = mct_systems[scene->system];
    int used = snprintf(text, size, "%s by %s, effects %x, input %g at %g;", system->name,
                        mct_steppers[scene->stepper].name, (unsigned)scene->effects, scene->input_amplitude,
                        scene->input_frequency);
    for (int i = 0; i < system->parameter_count && used < (int)size; i++) {
        if (scene->parameters[i] != system->parameters[i].standard) {
            used += snprintf(text + used, size - (size_t)used, " %s %.17g", system->parameters[i].name,
                             scene->parameters[i]);
        }
    }
    for (int i = 0; i < mct_state_count(scene) && used < (int)size; i++) {
        used += snprintf(text + used, size - (size_t)used, " %s %.17g", mct_state_field(system, i)->name,
                         scene->initial[i]);
    }
}

/*
 * A scene with a source that is driven out of all bounds, or to where no step follows, as by a torque without friction or
 * a frame without its Coriolis force, ends as diverged, at its last sane state. Without one none may.
 */
static void test_a_scene_that_is_taken_stays_finite_and_gains_no_energy(void)
{
    const long scenes = setting("MCT_RANDOM_SCENES", TEST_CASES(1000));
    const long ticks = setting("MCT_RANDOM_TICKS", 3000);
    int refused[MCT_SYSTEM_COUNT] = {0}, taken[MCT_SYSTEM_COUNT] = {0}, judged[MCT_SYSTEM_COUNT] = {0};
    int wrong = 0, driven = 0, watched = 0, alarms = 0;
    test_random random = {20260101};
    for (long i = 0; i < scenes; i++) {
        static mct_plant plant;
        mct_watch watch;
        char text[2000];
        mct_message why = {""};
        mct_input input;
        account energy = {0};
        mct_scene scene = drawn_scene(&random, (int)(i % MCT_SYSTEM_COUNT));
        describe(&scene, text, sizeof text);
        if (mct_scene_check(&scene, &why) != MCT_OK) {
            TEST_ASSERT_TRUE_MESSAGE(strlen(why.text) > 20, text); /* a table, a key and a reason */
            refused[scene.system]++;
            continue;
        }
        taken[scene.system]++;
        start_plant(&plant, &scene);
        mct_input_init(&input, &scene, (mct_samples){0});
        look(&energy, &plant);
        mct_watch_start(&watch, &plant, &scene);
        for (long tick = 0; tick < ticks && plant.diverged_ticks == 0; tick++) {
            mct_plant_step(&plant, mct_input_at(&input, plant.tick));
            if (!mct_systems[scene.system]->is_process) {
                look(&energy, &plant);
            }
            (void)mct_watch_tick(&watch, &plant);
        }
        judged[scene.system] += !energy.is_fed;
        const bool is_lost = plant.diverged_ticks > 0 && !energy.is_fed;
        driven += plant.diverged_ticks > 0 && energy.is_fed;
        for (int k = 0; k < plant.states; k++) {
            TEST_ASSERT_TRUE_MESSAGE(isfinite(mct_plant_value(&plant, k)), text);
        }
        watched += watch.is_watched;
        alarms += watch.impossible > 0 && plant.diverged_ticks == 0;
        if (is_lost || energy.growth > GROWTH || (watch.impossible > 0 && plant.diverged_ticks == 0)) {
            printf("scene %ld, tick %lu, energy %.3g J of %.3g J grows by %.2g: %s\n", i,
                   (unsigned long)plant.tick, energy.start, energy.scale, energy.growth, text);
            wrong++;
        }
    }
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        printf("%-18s %4d refused, %4d run, %4d without a source\n", mct_systems[i]->name, refused[i],
               taken[i], judged[i]);
        TEST_ASSERT_TRUE_MESSAGE(scenes < 300 || taken[i] >= refused[i] / 10, mct_systems[i]->name);
    }
    printf("%d driven out of all bounds by their source\n", driven);
    printf("%d watched by their energy, %d of them in vain\n", watched, alarms);
    TEST_ASSERT_EQUAL_INT(0, wrong);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_scene_that_is_taken_stays_finite_and_gains_no_energy);
    return UNITY_END();
}

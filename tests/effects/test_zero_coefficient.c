/*
 * An effect that is on with nothing to it changes nothing; one that is off reads nothing. All systems, effects, sets of
 * the other effects and steppers, from descriptors alone: mct_field.effects says whose coefficient a parameter is.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/effects.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

enum { TICKS = 2000, SHORT = 50 };
/*
 * Terms of 0 are added in another order, by other formulas (a flow's matrices are others), so each step may round
 * otherwise, by some epsilons, and a motion may draw such differences apart: of all, by a few thousand times. That of the
 * largest value of a state, or of 1.
 */
#define TO_ROUNDING (4 * TICKS * (double)MCT_REAL_EPSILON)

/*
 * What makes an effect vanish is 0 in all of its coefficients that may be 0, and no row in its lists. Where that is not
 * it: these parameters alone.
 */
static const struct {
    uint32_t effect;
    const char *parameters; /* those whose names begin so; the input is 0, too */
    bool without_input;
} vanishing[] = {
    /* Frame's forces have its rotation, which is no coefficient of theirs: */
    {MCT_CENTRIFUGAL, "angular_", false},
    {MCT_CORIOLIS, "angular_", false},
    {MCT_EULER_FORCE, "angular_acceleration", false},
    /* A motor without torque and a force of 0: an input means something else with each. */
    {MCT_MOTOR, "torque_constant", true},
};

static bool begins(const char *text, const char *with)
{
    return strncmp(text, with, strlen(with)) == 0;
}

/* Takes an effect's weight out of a scene; returns whether inputs may act. */
static bool make_vanish(mct_scene *scene, uint32_t effect)
{
    const mct_system *const system = mct_systems[scene->system];
    const char *named = NULL;
    bool input = true;
    for (size_t i = 0; i < sizeof vanishing / sizeof *vanishing; i++) {
        if (vanishing[i].effect & effect) {
            named = vanishing[i].parameters;
            input = !vanishing[i].without_input;
        }
    }
    for (int i = 0; i < system->parameter_count; i++) {
        const mct_field *const field = &system->parameters[i];
        if (named != NULL ? begins(field->name, named)
                          : (field->effects & effect) && field->minimum <= 0 && field->maximum >= 0) {
            scene->parameters[i] = 0;
        }
    }
    for (int i = 0; i < system->list_count; i++) {
        if (system->lists[i].effects & effect) {
            scene->lists[i].count = 0;
        }
    }
    return input;
}

/* Defaults, thrown off; coefficients that are 0 by default are not. */
static mct_scene moving_scene(int index, int stepper, uint32_t effects)
{
    const mct_system *const system = mct_systems[index];
    mct_scene scene = scene_of(index, stepper, effects);
    const int rate = mct_rate_index(system);
    scene.dt = system->actuation != NULL ? 1e-4 : 1e-3; /* rk4 follows the cart's motor up to 2e-4 */
    scene.duration = TICKS * scene.dt;
    for (int i = 0; i < system->coordinate_count; i++) {
        scene.initial[rate + i] += 0.4 + 0.3 * i;
    }
    for (int i = 0; i < system->parameter_count; i++) {
        const mct_field *const field = &system->parameters[i];
        if (field->effects != 0 && scene.parameters[i] == 0) {
            scene.parameters[i] = 0.01;
        }
    }
    return scene;
}

static bool has_kernel(int system, int stepper, uint32_t effects)
{
    const mct_scene scene = moving_scene(system, stepper, effects);
    return mct_systems[system]->kernel(stepper, effects) != NULL && mct_scene_check(&scene, NULL) == MCT_OK;
}

static const char *place_of(int system, int stepper, uint32_t effects, const char *what)
{
    static char text[200];
    snprintf(text, sizeof text, "%s, %s, effects %#x: %s", mct_systems[system]->name,
             mct_steppers[stepper].name, (unsigned)effects, what);
    return text;
}

/* Calls `check` for each system, set of its effects and stepper that has a kernel for it. */
static void for_each_kernel(void (*check)(int system, int stepper, uint32_t effects))
{
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        const uint32_t all = mct_systems[system]->effects & MCT_KERNEL_EFFECTS;
        uint32_t effects = 0;
        do {
            for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
                if (!mct_systems[system]->is_process && has_kernel(system, stepper, effects)) {
                    check(system, stepper, effects);
                }
            }
            effects = (effects - all) & all; /* the next subset */
        } while (effects != 0);
    }
}

/* --- on, with nothing to it --- */

static long pairs;
static double largest;

/* Largest difference of positions and rates over a run, relative to a state's largest value or 1. */
static double difference_of(const mct_scene *on, const mct_scene *off, mct_real input)
{
    static mct_plant plants[2];
    double size[MCT_MAX_STATES] = {0}, apart[MCT_MAX_STATES] = {0}, worst = 0;
    start_plant(&plants[0], on);
    start_plant(&plants[1], off);
    const mct_system *const system = mct_systems[on->system];
    const int states = mct_rate_index(system) + mct_coordinate_count(on);
    for (int tick = 0; tick < TICKS; tick++) {
        mct_plant_step(&plants[0], input);
        mct_plant_step(&plants[1], input);
        for (int i = 0; i < states; i++) {
            const double value = mct_plant_value(&plants[1], i);
            size[i] = fmax(size[i], fabs(value));
            apart[i] = fmax(apart[i], fabs(mct_plant_value(&plants[0], i) - value));
        }
    }
    for (int i = 0; i < states; i++) {
        worst = fmax(worst, apart[i] / fmax(1, size[i]));
    }
    TEST_ASSERT_EQUAL_UINT64(0, plants[0].diverged_ticks + plants[1].diverged_ticks);
    return worst;
}

static void check_on_and_off(int system, int stepper, uint32_t effects)
{
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        const uint32_t off = effects & ~mct_effects[i].mask;
        if (off == effects || !has_kernel(system, stepper, off)) {
            continue;
        }
        mct_scene scene = moving_scene(system, stepper, effects);
        const mct_real input = make_vanish(&scene, effects & mct_effects[i].mask) ? MCT_R(0.05) : 0;
        mct_scene without = scene;
        without.effects = off;
        const double difference = difference_of(&scene, &without, input);
        largest = fmax(largest, difference);
        pairs++;
        if (!(difference <= TO_ROUNDING)) {
            char what[100];
            snprintf(what, sizeof what, "%s changes %.1e", mct_effects[i].name, difference);
            printf("%s\n", place_of(system, stepper, effects, what));
        }
    }
}

static void test_an_effect_without_weight_moves_nothing(void)
{
    for_each_kernel(check_on_and_off);
    printf("%ld pairs of kernels, largest difference %.1e\n", pairs, largest);
    TEST_ASSERT_GREATER_THAN(1000, pairs);
    TEST_ASSERT_TRUE(largest <= TO_ROUNDING);
}

/* Of the current: the voltage is taken from the motor's own and added to it again. */
static void test_a_bound_that_is_never_reached_moves_nothing(void)
{
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        const mct_actuation *const actuation = mct_systems[system]->actuation;
        const uint32_t free = mct_systems[system]->standard_effects & ~(uint32_t)MCT_SATURATION;
        mct_scene scene = moving_scene(system, MCT_STEPPER_EULER, free);
        scene.parameters[actuation->supply_parameter] = 1e4;
        scene.parameters[actuation->current_limit_parameter] = 1e4;
        mct_scene bound = scene;
        bound.effects = free | MCT_SATURATION_VOLTAGE;
        TEST_ASSERT_TRUE(difference_of(&scene, &bound, MCT_R(0.05)) == 0);
        bound.effects = free | MCT_SATURATION;
        TEST_ASSERT_TRUE(difference_of(&scene, &bound, MCT_R(0.05)) <= TO_ROUNDING);
    }
}

/* --- off, whatever its coefficients --- */

static test_random numbers = {7};

/* Anything within the range: an end of it, or any order of magnitude. */
static double any_value(const mct_field *field)
{
    const double largest_size = fmax(fabs(field->minimum), fabs(field->maximum));
    const double size = random_scale(&numbers, 1e-9, largest_size);
    const double value = field->minimum < 0 && (random_bits(&numbers) & 1) ? -size : size;
    switch (random_bits(&numbers) % 4) {
    case 0:
        return field->minimum;
    case 1:
        return field->maximum;
    default:
        return value < field->minimum ? field->minimum : value > field->maximum ? field->maximum : value;
    }
}

/* To the bit; what is evaluated may have zeros of either sign. */
static void assert_same_motion(const mct_scene *scene, const mct_scene *changed, const char *what)
{
    static mct_plant plants[2];
    static mct_evaluation evaluations[2];
    start_plant(&plants[0], scene);
    start_plant(&plants[1], changed);
    for (int i = 0; i < 2; i++) {
        step_plant(&plants[i], MCT_R(0.05), SHORT);
        mct_plant_evaluate(&plants[i], &evaluations[i]);
    }
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&plants[0].state, &plants[1].state, sizeof plants[0].state, what);
    const mct_real *const before = (const mct_real *)&evaluations[0]; /* it holds nothing else */
    const mct_real *const after = (const mct_real *)&evaluations[1];
    for (size_t i = 0; i < sizeof evaluations[0] / sizeof *before; i++) {
        TEST_ASSERT_TRUE_MESSAGE(before[i] == after[i], what);
    }
}

static void check_not_read(int system, int stepper, uint32_t effects)
{
    const mct_scene scene = moving_scene(system, stepper, effects);
    mct_scene changed = scene;
    int count = 0;
    for (int i = 0; i < mct_systems[system]->parameter_count; i++) {
        const mct_field *const field = &mct_systems[system]->parameters[i];
        if (field->effects != 0 && !(field->effects & effects)) {
            changed.parameters[i] = any_value(field);
            count++;
        }
    }
    for (int i = 0; i < mct_systems[system]->list_count; i++) {
        const mct_row_list *const list = &mct_systems[system]->lists[i];
        if (list->effects != 0 && !(list->effects & effects)) {
            changed.lists[i].count = list->column_count;
            for (int column = 0; column < list->column_count; column++) {
                const mct_field *const field = &list->columns[column];
                changed.lists[i].values[column] = field->kind == MCT_FIELD_CHOICE ? 0 : any_value(field);
            }
            count++;
        }
    }
    if (count > 0) {
        pairs++;
        assert_same_motion(&scene, &changed, place_of(system, stepper, effects, "reads what is off"));
    }
}

static void test_of_an_effect_that_is_off_no_coefficient_is_read(void)
{
    pairs = 0;
    for_each_kernel(check_not_read);
    TEST_ASSERT_GREATER_THAN(500, pairs);
}

/* A scene that gives one coefficient and switches off all that would read it. */
static void write_scene(const mct_system *system, const mct_field *field, char *text, size_t size)
{
    int length = snprintf(text, size, "[scene]\nsystem = '%s'\n[parameters]\n%s = %.17g\n[effects]\n",
                          system->name, field->name, field->standard);
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        if (mct_effects[i].mask & field->effects & system->effects) {
            length += snprintf(text + length, size - (size_t)length, "%s = %s\n", mct_effects[i].name,
                               mct_effects[i].is_switch ? "false" : "'off'");
        }
    }
}

static void test_a_coefficient_that_is_given_in_vain_is_noted_with_its_effect(void)
{
    int noted = 0;
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        for (int j = 0; j < mct_systems[i]->parameter_count; j++) {
            const mct_field *const field = &mct_systems[i]->parameters[j];
            static mct_scene scene;
            mct_message why;
            char text[500], words[100];
            if (field->effects == 0) {
                continue;
            }
            write_scene(mct_systems[i], field, text, sizeof text);
            TEST_ASSERT_EQUAL_INT_MESSAGE(
                MCT_OK, mct_scene_read(text, strlen(text), "x.toml", NULL, 0, &scene, &why), why.text);
            TEST_ASSERT_TRUE_MESSAGE(mct_scene_note(&scene, 0, &why), text);
            snprintf(words, sizeof words, "parameters.%s: given with effects.", field->name);
            TEST_ASSERT_TRUE_MESSAGE(begins(why.text, words), why.text);
            TEST_ASSERT_FALSE(mct_scene_note(&scene, 1, &why));
            noted++;
        }
    }
    TEST_ASSERT_GREATER_THAN(60, noted);
}

void setUp(void)
{
}

void tearDown(void)
{
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_effect_without_weight_moves_nothing);
    RUN_TEST(test_a_bound_that_is_never_reached_moves_nothing);
    RUN_TEST(test_of_an_effect_that_is_off_no_coefficient_is_read);
    RUN_TEST(test_a_coefficient_that_is_given_in_vain_is_noted_with_its_effect);
    return UNITY_END();
}

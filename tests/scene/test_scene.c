/* Rules of scenes: what is accepted, what is refused with which words, and that nothing is changed by a
 * refusal. */
#include "mctau/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mctau/stepper.h"
#include "scene/tables.h"
#include "unity.h"

#define CART  "[scene]\nsystem = \"cart_pole\"\n"
#define WHEEL "[scene]\nsystem = \"reaction_wheel\"\n"

static mct_scene scene;
static mct_message why;

void setUp(void)
{
    memset(&scene, 0, sizeof scene);
    mct_message_clear(&why);
}

void tearDown(void)
{
}

static mct_status read_with(const char *text, const char *first, const char *second)
{
    const mct_override overrides[] = {{first, "--set"}, {second, "--stepper"}};
    const int count = first == NULL ? 0 : second == NULL ? 1 : 2;
    return mct_scene_read(text, strlen(text), "x.toml", overrides, count, &scene, &why);
}

static void assert_read(const char *text)
{
    const mct_status status = read_with(text, NULL, NULL);
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, status, why.text);
}

static void assert_refused(mct_status status, const char *text, const char *message)
{
    mct_scene before;
    memset(&scene, 0xA5, sizeof scene);
    memcpy(&before, &scene, sizeof before);
    TEST_ASSERT_EQUAL_INT_MESSAGE(status, read_with(text, NULL, NULL), why.text);
    TEST_ASSERT_EQUAL_STRING(message, why.text);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&before, &scene, sizeof before, "a refusal changed the scene");
}

static void assert_override_refused(mct_status status, const char *text, const char *override,
                                    const char *message)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(status, read_with(text, override, NULL), why.text);
    TEST_ASSERT_EQUAL_STRING(message, why.text);
}

static double parameter(const char *name)
{
    const mct_system *const system = mct_systems[scene.system];
    for (int i = 0; i < system->parameter_count; i++) {
        if (strcmp(system->parameters[i].name, name) == 0) {
            return scene.parameters[i];
        }
    }
    TEST_FAIL_MESSAGE(name);
    return 0;
}

/* --- what is accepted --- */

static void test_a_scene_that_names_its_system_alone_is_that_of_the_defaults(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        char text[100];
        mct_scene expected;
        snprintf(text, sizeof text, "scene.system = '%s'", mct_systems[i]->name);
        assert_read(text);
        mct_scene_defaults(&expected, i);
        TEST_ASSERT_EQUAL_MEMORY(&expected, &scene, sizeof scene);
        TEST_ASSERT_EQUAL_INT(i, scene.system);
        TEST_ASSERT_EQUAL_STRING("sim", scene.hal);
    }
}

static void test_every_default_is_within_its_own_range(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        mct_scene_defaults(&scene, i);
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_scene_check(&scene, &why), why.text);
    }
}

static void test_every_key_can_be_given_its_smallest_and_its_largest_value_and_no_more(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        for (int table = 0; table < MCT_TABLE_COUNT; table++) {
            for (int number = 0; number < mct_key_count(table, mct_systems[i]); number++) {
                const mct_scene_key key = mct_key_at(table, mct_systems[i], number);
                if (key.field.kind != MCT_FIELD_REAL && key.field.kind != MCT_FIELD_INTEGER) {
                    continue;
                }
                const double bounds[] = {key.field.minimum, key.field.maximum};
                for (int side = 0; side < 2; side++) {
                    const double step =
                        key.field.kind == MCT_FIELD_INTEGER ? 1 : fabs(bounds[side]) * 1e-6 + 1e-9;
                    for (int beyond = 0; beyond < 2; beyond++) {
                        char text[300];
                        const double value = bounds[side] + (side == 0 ? -step : step) * beyond;
                        snprintf(text, sizeof text, "scene.system = '%s'\n%s.%s = %.17g\n",
                                 mct_systems[i]->name, mct_table_name(table), key.field.name, value);
                        const mct_status status = read_with(text, NULL, NULL);
                        if (beyond) {
                            TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_ERROR_RANGE, status, text);
                        } else if (status == MCT_OK) {
                            TEST_ASSERT_EQUAL_DOUBLE_MESSAGE(value, mct_key_get(&scene, &key), text);
                        } else { /* in range, though it may not go with the defaults of other keys */
                            TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_ERROR_UNSUITED, status, why.text);
                        }
                    }
                }
            }
        }
    }
}

static void test_every_kind_of_value_goes_where_it_belongs(void)
{
    assert_read(
        "[input]\nkind = 'steps'\ntimes = [0, 0.5]\nvalues = [1, -2.5]\n"
        "[scene]\nsystem = \"cart_pole\"\nstepper = 'leap'\ndt = 2e-3\nsubsteps = 4\nduration = 1\n"
        "precision = 'float'\nrealtime = true\nhal = 'socketcan:can0'\n"
        "[parameters]\npole_mass = 0.25\n[effects]\nmotor = 'inductive'\ncoulomb = true\ngravity = false\n"
        "[initial]\npole_angle = 0.1\ncart_velocity = -2\ncurrent = 0.5\n"
        "[weights]\npole_rate = 3\ncart_position = 0.25\n"
        "[sensors]\npole_counts_per_turn = 8192\ncart_counts_per_metre = 1000\ncounter_bits = 16\nlatency = "
        "2\n"
        "noise = 0.5\nseed = 42\nfault = 'frozen'\nfault_time = 0.25\nfault_duration = 0.125\n"
        "[variation]\nspread = 0.1\nseed = 7\n[telemetry]\nlcm = 'udpm://239.255.76.67:7667?ttl=0'\nlog = 'a "
        "b.lcm'\n");
    TEST_ASSERT_EQUAL_STRING("cart_pole", mct_systems[scene.system]->name);
    TEST_ASSERT_EQUAL_INT(MCT_STEPPER_LEAP, scene.stepper);
    TEST_ASSERT_EQUAL_INT(MCT_PRECISION_FLOAT, scene.precision);
    TEST_ASSERT_EQUAL_INT(4, scene.substeps);
    TEST_ASSERT_EQUAL_INT(1, scene.realtime);
    TEST_ASSERT_EQUAL_DOUBLE(2e-3, scene.dt);
    TEST_ASSERT_EQUAL_STRING("socketcan:can0", scene.hal);
    TEST_ASSERT_EQUAL_DOUBLE(0.25, parameter("pole_mass"));
    TEST_ASSERT_EQUAL_HEX32(MCT_VISCOUS | MCT_COULOMB_MOREAU | MCT_MOTOR_INDUCTIVE | MCT_SATURATION_VOLTAGE,
                            scene.effects);
    const double initial[] = {0, 0.1, -2, 0, 0.5};
    for (int i = 0; i < 5; i++) {
        TEST_ASSERT_EQUAL_DOUBLE(initial[i], scene.initial[i]);
    }
    TEST_ASSERT_EQUAL_DOUBLE(0.25, scene.weights[0]);
    TEST_ASSERT_EQUAL_DOUBLE(3, scene.weights[3]);
    TEST_ASSERT_EQUAL_INT(MCT_INPUT_STEPS, scene.input);
    TEST_ASSERT_EQUAL_INT(2, scene.input_values.count);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, scene.input_times.values[1]);
    TEST_ASSERT_EQUAL_DOUBLE(-2.5, scene.input_values.values[1]);
    TEST_ASSERT_EQUAL_DOUBLE(1000, scene.counts_per_unit[0]);
    TEST_ASSERT_EQUAL_DOUBLE(8192, scene.counts_per_unit[1]);
    TEST_ASSERT_EQUAL_INT(16, scene.counter_bits);
    TEST_ASSERT_EQUAL_INT(2, scene.latency);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, scene.noise);
    TEST_ASSERT_EQUAL_INT(42, scene.sensor_seed);
    TEST_ASSERT_EQUAL_INT(MCT_SENSOR_FAULT_FROZEN, scene.sensor_fault);
    TEST_ASSERT_EQUAL_DOUBLE(0.25, scene.sensor_fault_time);
    TEST_ASSERT_EQUAL_DOUBLE(0.125, scene.sensor_fault_duration);
    TEST_ASSERT_EQUAL_DOUBLE(0.1, scene.variation_spread);
    TEST_ASSERT_EQUAL_INT(7, scene.variation_seed);
    TEST_ASSERT_EQUAL_STRING("udpm://239.255.76.67:7667?ttl=0", scene.lcm);
    TEST_ASSERT_EQUAL_STRING("a b.lcm", scene.log);
}

static void test_a_stepper_left_out_is_the_most_accurate_that_suits(void)
{
    assert_read(CART);
    TEST_ASSERT_EQUAL_INT(MCT_STEPPER_RK4, scene.stepper);
    assert_read(CART "[effects]\nmotor = 'inductive'\n[parameters]\ninductance = 1e-5\n");
    TEST_ASSERT_EQUAL_INT(MCT_STEPPER_LEAP, scene.stepper);
    assert_read(WHEEL);
    TEST_ASSERT_EQUAL_INT(MCT_STEPPER_EXPO, scene.stepper);
}

static void test_auto_stands_for_the_most_accurate_until_a_host_chooses(void)
{
    assert_read(CART "stepper = 'auto'\ntolerance = 1e-8");
    TEST_ASSERT_EQUAL_INT(1, scene.automatic);
    TEST_ASSERT_EQUAL_INT(MCT_STEPPER_RK4, scene.stepper);
    TEST_ASSERT_EQUAL_DOUBLE(1e-8, scene.tolerance);
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_scene_check(&scene, &why));
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_with(CART "stepper = 'auto'", "scene.stepper=leap", NULL));
    TEST_ASSERT_EQUAL_INT(0, scene.automatic);
    TEST_ASSERT_EQUAL_INT(MCT_STEPPER_LEAP, scene.stepper);
    scene.stepper = MCT_STEPPER_COUNT; /* what stands for auto within the reader is no stepper */
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_scene_check(&scene, &why));
}

static void test_ready_scenes_are_read(void)
{
    static const char *const names[] = {"reaction_wheel", "cart_pole", "reaction_wheel_free",
                                        "cart_pole_free"};
    const char *const source = getenv("MCTAU_SOURCE");
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char path[1000];
        static char text[10000];
        snprintf(path, sizeof path, "%s/scenes/%s.toml", source != NULL ? source : ".", names[i]);
        FILE *const file = fopen(path, "rb");
        TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
        const size_t length = fread(text, 1, sizeof text, file);
        fclose(file);
        const mct_status status = mct_scene_read(text, length, path, NULL, 0, &scene, &why);
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, status, why.text);
        TEST_ASSERT_EQUAL_INT(i < 2 ? MCT_CONTROLLER_SWING_UP_BALANCE : MCT_CONTROLLER_NONE,
                              scene.controller);
        TEST_ASSERT_EQUAL_DOUBLE(i < 2 ? 30 : 10, scene.duration);
    }
}

/* --- overrides --- */

static void test_overrides_beat_the_file_and_later_ones_beat_earlier_ones(void)
{
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_with(CART "dt = 0.001\n", "scene.dt=0.002", "scene.dt = 0.004"));
    TEST_ASSERT_EQUAL_DOUBLE(0.004, scene.dt);
}

static void test_an_overridden_text_may_go_without_quotes(void)
{
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_with(CART, "telemetry.log=/tmp/a b #1.lcm", "effects.motor=off"));
    TEST_ASSERT_EQUAL_STRING("/tmp/a b #1.lcm", scene.log);
    TEST_ASSERT_EQUAL_HEX32(0, scene.effects & MCT_MOTOR);
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_with(CART, "telemetry.log=\"a\\\"b\"", "telemetry.lcm="));
    TEST_ASSERT_EQUAL_STRING("a\"b", scene.log);
    TEST_ASSERT_EQUAL_STRING("", scene.lcm);
}

static void test_an_overridden_system_brings_its_own_defaults(void)
{
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          read_with(CART, "scene.system=reaction_wheel", "parameters.wheel_mass=0.5"));
    TEST_ASSERT_EQUAL_STRING("reaction_wheel", mct_systems[scene.system]->name);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, parameter("wheel_mass"));
    TEST_ASSERT_EQUAL_INT(MCT_STEPPER_EXPO, scene.stepper);
}

static void test_an_override_is_called_by_its_origin(void)
{
    assert_override_refused(MCT_ERROR_RANGE, CART, "scene.dt=2",
                            "--set: scene.dt: found 2 s; allowed 1e-07 to 1 s");
    assert_override_refused(MCT_ERROR_SYNTAX, CART, "scene.dt=", "--set: scene.dt: a value is missing");
    assert_override_refused(MCT_ERROR_SYNTAX, CART, "scene.dt=1 2",
                            "--set: scene.dt: ' 2' stands behind the value");
    assert_override_refused(MCT_ERROR_SYNTAX, CART, "scene.dt", "--set: 'scene.dt' is not followed by '='");
    assert_override_refused(MCT_ERROR_SYNTAX, CART, "dt=1",
                            "--set: 'dt' belongs to no table: put it below a line such as [scene]");
    assert_override_refused(MCT_ERROR_SYNTAX, "", "scene.system",
                            "--set: 'scene.system' is not followed by '='");
    assert_override_refused(
        MCT_ERROR_RANGE, CART, "foo.bar=1",
        "--set: [foo]: unknown table; allowed scene, controller, input, sensors, can, variation, telemetry, "
        "parameters, effects, initial, weights");
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_UNSUITED, read_with(CART, "scene.dt=0.001", "scene.stepper=expo"));
    TEST_ASSERT_EQUAL_STRING(
        "--stepper: scene.stepper: found expo, which does not suit cart_pole with gravity, viscous, "
        "motor = quasi_static; allowed seed, euler, leap, rk4, taylor4, taylor6, taylor8, taylor12",
        why.text);
}

/* --- single values that are refused --- */

static void test_a_number_out_of_range_is_refused_with_line_key_found_and_allowed(void)
{
    assert_refused(MCT_ERROR_RANGE, CART "[parameters]\npole_mass = -1\n",
                   "x.toml:4: parameters.pole_mass: found -1 kg; allowed 1e-06 to 1000000 kg");
    assert_refused(MCT_ERROR_RANGE, CART "[sensors]\nseed = 2147483648\n",
                   "x.toml:4: sensors.seed: found 2147483648; allowed 0 to 2147483647");
    assert_refused(MCT_ERROR_RANGE, CART "substeps = 0x0",
                   "x.toml:3: scene.substeps: found 0x0; allowed 1 to 1000");
    assert_refused(MCT_ERROR_RANGE, CART "[input]\nkind = 'steps'\ntimes = [0, -1]\nvalues = [1, 2]",
                   "x.toml:5: input.times: found -1 s as number 2; allowed 0 to 10000000 s");
}

static void test_numbers_that_are_not_finite_are_refused_as_such(void)
{
    assert_refused(MCT_ERROR_RANGE, CART "dt = nan",
                   "x.toml:3: scene.dt: found nan, which is not finite; allowed 1e-07 to 1 s");
    assert_refused(MCT_ERROR_RANGE, CART "dt = 1e999",
                   "x.toml:3: scene.dt: found 1e999, which is not finite; allowed 1e-07 to 1 s");
    assert_refused(MCT_ERROR_RANGE, CART "dt = -inf",
                   "x.toml:3: scene.dt: found -inf, which is not finite; allowed 1e-07 to 1 s");
}

static void test_a_wrong_type_is_refused_with_the_one_that_belongs(void)
{
    assert_refused(
        MCT_ERROR_RANGE, CART "dt = \"fast\"",
        "x.toml:3: scene.dt: found \"fast\", a text, where a number belongs; allowed 1e-07 to 1 s");
    assert_refused(
        MCT_ERROR_RANGE, CART "substeps = 2.0",
        "x.toml:3: scene.substeps: found 2.0, a number, where a whole number belongs; allowed 1 to 1000");
    assert_refused(
        MCT_ERROR_RANGE, CART "realtime = 1",
        "x.toml:3: scene.realtime: found 1, a number, where a boolean belongs; allowed true or false");
    assert_refused(MCT_ERROR_RANGE, CART "precision = 64",
                   "x.toml:3: scene.precision: found 64, a number, where a name in quotes belongs; allowed "
                   "double, float");
    assert_refused(MCT_ERROR_RANGE, CART "[telemetry]\nlog = true",
                   "x.toml:4: telemetry.log: found true, a boolean, where a text in quotes belongs; allowed "
                   "a text of at most 255 bytes");
    assert_refused(MCT_ERROR_RANGE, CART "[input]\ntimes = 1",
                   "x.toml:4: input.times: found 1, a number, where a list belongs; allowed at most 128 "
                   "numbers from 0 to 10000000 s");
    assert_refused(MCT_ERROR_RANGE, CART "[parameters]\npole_mass = [1]",
                   "x.toml:4: parameters.pole_mass: found [1], a list, where a number belongs; allowed 1e-06 "
                   "to 1000000 kg");
}

static void test_unknown_keys_and_tables_are_refused_with_the_closest_name(void)
{
    assert_refused(MCT_ERROR_RANGE, CART "[paramters]\n",
                   "x.toml:3: [paramters]: unknown table; did you mean 'parameters'? allowed scene, "
                   "controller, input, sensors, "
                   "can, variation, telemetry, parameters, effects, initial, weights");
    assert_refused(
        MCT_ERROR_RANGE, CART "[initial]\npole_angel = 2\n",
        "x.toml:4: initial.pole_angel: unknown key of [initial] for cart_pole; did you mean 'pole_angle'? "
        "allowed cart_position, pole_angle, cart_velocity, pole_rate, current");
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, read_with(CART "[parameters]\npole_mas = 1\n", NULL, NULL));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "did you mean 'pole_mass'?"), why.text);
}

static void test_a_key_in_the_wrong_place_is_sent_where_it_belongs(void)
{
    assert_refused(
        MCT_ERROR_RANGE, CART "pole_mass = 1",
        "x.toml:3: scene.pole_mass: unknown key of [scene] for cart_pole; it belongs to [parameters]");
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, read_with(CART "[parameters]\nwheel_mass = 1\n", NULL, NULL));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "; it belongs to reaction_wheel; allowed "), why.text);
}

/* A sentence that ends with the names of all systems. */
static const char *with_systems(const char *begin)
{
    static char sentence[MCT_MESSAGE_SIZE];
    size_t used = (size_t)snprintf(sentence, sizeof sentence, "%s", begin);
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        used += (size_t)snprintf(sentence + used, sizeof sentence - used, "%s%s", i > 0 ? ", " : "",
                                 mct_systems[i]->name);
    }
    return sentence;
}

static void test_unknown_names_are_refused_with_those_that_are_known(void)
{
    assert_refused(
        MCT_ERROR_RANGE, "[scene]\nsystem = 'cart_pol'",
        with_systems("x.toml:2: scene.system: found 'cart_pol'; did you mean 'cart_pole'? allowed "));
    assert_refused(MCT_ERROR_RANGE, CART "stepper = 'rk5'",
                   "x.toml:3: scene.stepper: found 'rk5'; did you mean 'rk4'? allowed seed, euler, leap, "
                   "rk4, taylor4, taylor6, taylor8, taylor12, expo, expo8, rkn6, split3, discrete, auto");
    assert_refused(MCT_ERROR_RANGE, CART "[effects]\nmotor = 'stepper'",
                   "x.toml:4: effects.motor: found 'stepper'; allowed off, quasi_static, inductive");
}

static void test_a_scene_must_name_its_system(void)
{
    assert_refused(MCT_ERROR_RANGE, "[scene]\ndt = 0.001\n",
                   with_systems("x.toml: scene.system: found none; allowed "));
}

static void test_texts_and_lists_that_do_not_fit_are_refused(void)
{
    char text[2 * MCT_MAX_TEXT];
    size_t length = (size_t)sprintf(text, CART "[telemetry]\nlog = '");
    memset(text + length, 'a', MCT_MAX_TEXT - 1);
    strcpy(text + length + MCT_MAX_TEXT - 1, "'");
    assert_read(text);
    TEST_ASSERT_EQUAL_size_t(MCT_MAX_TEXT - 1, strlen(scene.log));
    strcpy(text + length + MCT_MAX_TEXT - 1, "a'");
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, read_with(text, NULL, NULL));
    assert_refused(MCT_ERROR_RANGE, CART "[telemetry]\nlog = \"a\\u0000b\"",
                   "x.toml:4: telemetry.log: found \"a\\u0000b\", which contains a NUL; allowed a text of at "
                   "most 255 bytes");

    length = (size_t)sprintf(text, CART "[input]\ntimes = [0");
    for (int i = 0; i < MCT_MAX_LIST; i++) {
        length += (size_t)sprintf(text + length, ",%d", i);
    }
    strcpy(text + length, "]");
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, read_with(text, NULL, NULL));
}

static void test_what_is_not_toml_is_refused_as_syntax(void)
{
    assert_refused(MCT_ERROR_SYNTAX, CART "dt 1", "x.toml:3:4: 'dt' is not followed by '='");
}

/* --- values that do not go together --- */

static void test_a_stepper_that_does_not_suit_names_those_that_do(void)
{
    assert_refused(
        MCT_ERROR_UNSUITED, CART "stepper = 'expo'",
        "x.toml:3: scene.stepper: found expo, which does not suit cart_pole with gravity, viscous, "
        "motor = quasi_static; allowed seed, euler, leap, rk4, taylor4, taylor6, taylor8, taylor12");
}

static void test_a_stepper_too_coarse_for_the_motor_names_what_would_do(void)
{
    assert_refused(
        MCT_ERROR_UNSUITED, WHEEL "stepper = 'rk4'\n[parameters]\ninductance = 12.1e-5\n",
        "x.toml:3: scene.stepper: found rk4, which follows an inductive motor up to h R/L = 2.785; at h = "
        "0.001 s "
        "it is 100; allowed euler, leap, expo, expo8, or scene.dt up to 2.78e-05 s, or scene.substeps from "
        "36");
    TEST_ASSERT_EQUAL_INT(
        MCT_ERROR_UNSUITED,
        read_with(WHEEL "stepper = 'rk4'\n[parameters]\ninductance = 12.1e-5\n", "scene.substeps=35", NULL));
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_with(WHEEL "stepper = 'rk4'\n[parameters]\ninductance = 12.1e-5\n",
                                            "scene.substeps=36", NULL));
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_with(WHEEL "stepper = 'rk4'\n[parameters]\ninductance = 12.1e-5\n",
                                            "scene.dt=2.78e-5", "scene.duration=2.78"));
}

static void test_a_motor_without_inductance_sets_no_limit_and_has_no_current(void)
{
    assert_read(WHEEL "stepper = 'rk4'\n[parameters]\ninductance = 0\n");
    assert_refused(MCT_ERROR_UNSUITED, WHEEL "[parameters]\ninductance = 0\n[initial]\ncurrent = 1\n",
                   "x.toml:6: initial.current: found a state that the scene has not; allowed with "
                   "effects.motor = inductive "
                   "and an inductance");
}

static void test_a_controller_needs_a_motor(void)
{
    assert_refused(
        MCT_ERROR_UNSUITED, CART "[effects]\nmotor = 'off'\n[controller]\nkind = 'swing_up_balance'\n",
        "x.toml:6: controller.kind: found a controller, which gives a voltage, with effects.motor = off; "
        "allowed with quasi_static or inductive");
}

static void test_a_bound_of_the_voltage_and_no_motor_exclude_each_other(void)
{
    assert_refused(MCT_ERROR_UNSUITED, CART "[effects]\nmotor = 'off'\nsaturation = true\n",
                   "x.toml:5: effects.saturation: found true with effects.motor = off, which excludes it: a "
                   "force or torque has no supply; allowed off, or a motor");
    assert_read(CART "[effects]\nmotor = 'off'\n"); /* that of the defaults says nothing */
    assert_read(CART "[effects]\nmotor = 'off'\nsaturation = 'off'\n");
}

static void test_a_switch_of_several_kinds_takes_true_for_its_first_kind(void)
{
    static const struct {
        const char *text;
        uint32_t bits;
    } cases[] = {{"coulomb = true", MCT_COULOMB_MOREAU},
                 {"coulomb = 'moreau'", MCT_COULOMB_MOREAU},
                 {"coulomb = false", 0},
                 {"coulomb = 'off'", 0},
                 {"saturation = 'current'", MCT_SATURATION}};
    char text[256];
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        snprintf(text, sizeof text, "%s[effects]\nsaturation = false\n", CART);
        if (strncmp(cases[i].text, "sat", 3) == 0) {
            snprintf(text, sizeof text, "%s[effects]\n", CART);
        }
        strcat(text, cases[i].text);
        assert_read(text);
        TEST_ASSERT_EQUAL_HEX32(cases[i].bits, scene.effects & (MCT_COULOMB | MCT_SATURATION));
    }
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_with(CART, "effects.coulomb=true", "effects.saturation=false"));
    TEST_ASSERT_EQUAL_HEX32(MCT_COULOMB_MOREAU, scene.effects & (MCT_COULOMB | MCT_SATURATION));
    assert_refused(
        MCT_ERROR_RANGE, CART "[effects]\nmotor = true\n",
        "x.toml:4: effects.motor: found true, a boolean, where a name in quotes belongs; allowed off, "
        "quasi_static, inductive");
}

static void test_a_coefficient_that_no_effect_reads_is_noted_by_both_names(void)
{
    assert_read(CART "[parameters]\ncart_friction = 1\npole_mass = 0.2\ninductance = 1e-3\n"
                     "[effects]\nviscous = false\nmotor = 'quasi_static'\n");
    TEST_ASSERT_TRUE(mct_scene_note(&scene, 0, &why));
    TEST_ASSERT_EQUAL_STRING("parameters.cart_friction: given with effects.viscous off: nothing reads it",
                             why.text);
    TEST_ASSERT_TRUE(mct_scene_note(&scene, 1, &why));
    TEST_ASSERT_EQUAL_STRING(
        "parameters.inductance: given with effects.motor not inductive: nothing reads it", why.text);
    TEST_ASSERT_FALSE(mct_scene_note(&scene, 2, &why));
    assert_read(CART "[parameters]\ncart_friction = 1\n");
    TEST_ASSERT_FALSE(mct_scene_note(&scene, 0, &why));
}

static void test_a_vector_and_a_list_that_no_effect_reads_are_noted_too(void)
{
    assert_read("[scene]\nsystem = 'rigid_body'\n[parameters]\ngravity = [0, -1, 0]\n"
                "forces = [['space', 0, 0, 0, 1, 0, 0]]\n[effects]\ngravity = false\nforces = false\n");
    TEST_ASSERT_TRUE(mct_scene_note(&scene, 0, &why));
    TEST_ASSERT_EQUAL_STRING("parameters.gravity_1: given with effects.gravity off: nothing reads it",
                             why.text);
    TEST_ASSERT_TRUE(mct_scene_note(&scene, 3, &why));
    TEST_ASSERT_EQUAL_STRING("parameters.forces: given with effects.forces off: nothing reads it", why.text);
    TEST_ASSERT_FALSE(mct_scene_note(&scene, 4, &why));
}

static void test_a_controller_and_an_open_loop_exclude_each_other(void)
{
    assert_refused(MCT_ERROR_UNSUITED,
                   CART "[controller]\nkind = 'swing_up_balance'\n[input]\nkind = 'constant'\n",
                   "x.toml:4: controller.kind: found a controller together with an open-loop [input]; "
                   "allowed one of them, "
                   "the other's kind being none");
}

static void test_a_key_that_the_kind_of_input_does_not_read_is_refused(void)
{
    assert_refused(MCT_ERROR_UNSUITED, CART "[input]\nkind = 'constant'\namplitude = 3\n",
                   "x.toml:5: input.amplitude: found with input.kind = constant, which does not read it; "
                   "allowed with sine");
    assert_refused(MCT_ERROR_UNSUITED, CART "[input]\nvalue = 3\n",
                   "x.toml:4: input.value: found with input.kind = none, which does not read it; allowed "
                   "with constant or sine");
    assert_override_refused(
        MCT_ERROR_UNSUITED, CART "[input]\nkind = 'sine'\n", "input.column=x",
        "--set: input.column: found with input.kind = sine, which does not read it; allowed with csv");
}

static void test_steps_rise_and_match(void)
{
    assert_refused(MCT_ERROR_UNSUITED, CART "[input]\nkind = 'steps'\ntimes = [0, 1, 1]\nvalues = [1, 2, 3]",
                   "x.toml:5: input.times: found 1 s behind 1 s; allowed only rising times");
    assert_refused(MCT_ERROR_UNSUITED, CART "[input]\nkind = 'steps'\ntimes = [0, 1]\nvalues = [1]",
                   "x.toml:5: input.times: found 2 times and 1 values; allowed equally many, at least one");
    assert_refused(MCT_ERROR_UNSUITED, CART "[input]\nkind = 'steps'\n",
                   "x.toml: input.times: found 0 times and 0 values; allowed equally many, at least one");
}

static void test_a_csv_input_needs_a_file_and_a_column(void)
{
    assert_refused(
        MCT_ERROR_UNSUITED, CART "[input]\nkind = 'csv'\ncolumn = 'u'\n",
        "x.toml: input.file: found none; an input of kind csv needs a file and the name of a column");
    assert_read(CART "[input]\nkind = 'csv'\ncolumn = 'u'\nfile = 'u.csv'\n");
}

static void test_a_duration_is_a_whole_number_of_ticks(void)
{
    assert_refused(
        MCT_ERROR_UNSUITED, CART "duration = 1.0006\n",
        "x.toml:3: scene.duration: found 1.0006 s, which is not a whole number of ticks of 0.001 s; "
        "the nearest is 1.001 s, 1001 ticks");
    assert_read(CART "duration = 0\n");
    assert_read(CART "dt = 1e-7\nduration = 1e7\n");
    for (int ticks = 1; ticks < 3000; ticks += 7) { /* decimals that no double holds exactly */
        char text[100];
        snprintf(text, sizeof text, CART "dt = 0.0007\nduration = %d.%04d\n", ticks * 7 / 10000,
                 ticks * 7 % 10000);
        assert_read(text);
    }
}

/* --- the check on its own --- */

static void test_the_check_finds_what_a_hand_has_spoilt(void)
{
    const mct_scene_key pole_mass = mct_key_at(MCT_TABLE_PARAMETERS, mct_systems[0], 1);
    assert_read(CART);
    const mct_scene good = scene;
    mct_key_set(&scene, &pole_mass, NAN);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_scene_check(&scene, &why));
    TEST_ASSERT_EQUAL_STRING("parameters.pole_mass: found nan kg; allowed 1e-06 to 1000000 kg", why.text);
    scene = good;
    scene.system = MCT_SYSTEM_COUNT;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_scene_check(&scene, &why));
    scene = good;
    scene.stepper = -1;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_scene_check(&scene, &why));
    scene = good;
    scene.effects |= MCT_MOTOR;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_scene_check(&scene, &why));
    TEST_ASSERT_EQUAL_STRING("effects.motor: found more than one; allowed off, quasi_static, inductive",
                             why.text);
    scene = good;
    scene.effects |= (uint32_t)1 << 31;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_scene_check(&scene, NULL));
    scene = good;
    memset(scene.log, 'a', sizeof scene.log);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, mct_scene_check(&scene, &why));
    scene = good;
    scene.input_values.count = MCT_MAX_LIST + 1;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, mct_scene_check(&scene, &why));
    scene = good;
    scene.realtime = 2;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_scene_check(&scene, &why));
}

static void test_who_does_not_ask_why_is_refused_all_the_same(void)
{
    const char text[] = CART "dt = 2";
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE,
                          mct_scene_read(text, sizeof text - 1, NULL, NULL, 0, &scene, NULL));
}

/* --- variation --- */

static void test_variation_changes_parameters_within_its_spread_and_nothing_else(void)
{
    mct_scene plant;
    double largest = 0;
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        for (int seed = 0; seed < 200; seed++) {
            mct_scene_defaults(&scene, system);
            scene.variation_spread = 0.1;
            scene.variation_seed = seed;
            mct_scene_vary(&scene, &plant);
            for (int i = 0; i < mct_systems[system]->parameter_count; i++) {
                const double change = plant.parameters[i] - scene.parameters[i];
                TEST_ASSERT_TRUE(fabs(change) <=
                                 (0.1 + 4e-16) * fabs(scene.parameters[i])); /* two roundings near 1 */
                largest = fmax(largest, scene.parameters[i] != 0 ? fabs(change / scene.parameters[i]) : 0);
            }
            memcpy(plant.parameters, scene.parameters, sizeof plant.parameters);
            TEST_ASSERT_EQUAL_MEMORY(&scene, &plant, sizeof plant);
        }
    }
    TEST_ASSERT_TRUE(largest > 0.099); /* of some 4000 uniform draws */
}

static void test_gravity_gears_and_supply_do_not_vary(void)
{
    static const char *const names[] = {"gravity", "gear_ratio", "supply_voltage"};
    assert_read(CART "[variation]\nspread = 0.5\nseed = 3\n");
    double before[3];
    for (int i = 0; i < 3; i++) {
        before[i] = parameter(names[i]);
    }
    const double mass = parameter("cart_mass");
    mct_scene_vary(&scene, &scene);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_DOUBLE(before[i], parameter(names[i]));
    }
    TEST_ASSERT_TRUE(parameter("cart_mass") != mass);
}

static void test_variation_is_a_function_of_seed_and_parameter_alone(void)
{
    mct_scene first;
    mct_scene second;
    mct_scene_defaults(&scene, 0);
    scene.variation_spread = 0.1;
    scene.variation_seed = 1;
    mct_scene_vary(&scene, &first);
    const double ratio = first.parameters[1] / scene.parameters[1];
    scene.parameters[0] *= 2;
    scene.parameters[1] *= 4;
    mct_scene_vary(&scene, &second);
    TEST_ASSERT_DOUBLE_WITHIN(4e-16 * ratio, ratio,
                              second.parameters[1] / scene.parameters[1]); /* two roundings */
    scene.variation_seed = 2;
    mct_scene_vary(&scene, &second);
    TEST_ASSERT_TRUE(fabs(second.parameters[1] / scene.parameters[1] - ratio) > 1e-6);
}

static void test_variation_draws_are_the_same_everywhere(void)
{
    /* splitmix64's published finaliser, evaluated in exact integers by another program. */
    mct_scene plant;
    mct_scene_defaults(&scene, 0);
    scene.variation_spread = 0.5;
    scene.variation_seed = 12345;
    scene.parameters[0] = 1;
    mct_scene_vary(&scene, &plant);
    TEST_ASSERT_EQUAL_DOUBLE(0x1.081ac041047f7p-1, plant.parameters[0]);
}

static void test_variation_stays_within_the_range_of_a_parameter(void)
{
    for (int seed = 0; seed < 20; seed++) {
        mct_scene plant;
        mct_scene_defaults(&scene, 0);
        scene.effects &= ~(uint32_t)MCT_VISCOUS; /* too fast a decay for so light a pole */
        scene.variation_spread = 0.5;
        scene.variation_seed = seed;
        scene.parameters[0] = mct_systems[0]->parameters[0].maximum;
        scene.parameters[1] = mct_systems[0]->parameters[1].minimum;
        mct_scene_vary(&scene, &plant);
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_scene_check(&plant, &why), why.text);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_scene_that_names_its_system_alone_is_that_of_the_defaults);
    RUN_TEST(test_every_default_is_within_its_own_range);
    RUN_TEST(test_every_key_can_be_given_its_smallest_and_its_largest_value_and_no_more);
    RUN_TEST(test_every_kind_of_value_goes_where_it_belongs);
    RUN_TEST(test_a_stepper_left_out_is_the_most_accurate_that_suits);
    RUN_TEST(test_auto_stands_for_the_most_accurate_until_a_host_chooses);
    RUN_TEST(test_ready_scenes_are_read);
    RUN_TEST(test_overrides_beat_the_file_and_later_ones_beat_earlier_ones);
    RUN_TEST(test_an_overridden_text_may_go_without_quotes);
    RUN_TEST(test_an_overridden_system_brings_its_own_defaults);
    RUN_TEST(test_an_override_is_called_by_its_origin);
    RUN_TEST(test_a_number_out_of_range_is_refused_with_line_key_found_and_allowed);
    RUN_TEST(test_numbers_that_are_not_finite_are_refused_as_such);
    RUN_TEST(test_a_wrong_type_is_refused_with_the_one_that_belongs);
    RUN_TEST(test_unknown_keys_and_tables_are_refused_with_the_closest_name);
    RUN_TEST(test_a_key_in_the_wrong_place_is_sent_where_it_belongs);
    RUN_TEST(test_unknown_names_are_refused_with_those_that_are_known);
    RUN_TEST(test_a_scene_must_name_its_system);
    RUN_TEST(test_texts_and_lists_that_do_not_fit_are_refused);
    RUN_TEST(test_what_is_not_toml_is_refused_as_syntax);
    RUN_TEST(test_a_stepper_that_does_not_suit_names_those_that_do);
    RUN_TEST(test_a_stepper_too_coarse_for_the_motor_names_what_would_do);
    RUN_TEST(test_a_motor_without_inductance_sets_no_limit_and_has_no_current);
    RUN_TEST(test_a_controller_needs_a_motor);
    RUN_TEST(test_a_bound_of_the_voltage_and_no_motor_exclude_each_other);
    RUN_TEST(test_a_switch_of_several_kinds_takes_true_for_its_first_kind);
    RUN_TEST(test_a_coefficient_that_no_effect_reads_is_noted_by_both_names);
    RUN_TEST(test_a_vector_and_a_list_that_no_effect_reads_are_noted_too);
    RUN_TEST(test_a_controller_and_an_open_loop_exclude_each_other);
    RUN_TEST(test_a_key_that_the_kind_of_input_does_not_read_is_refused);
    RUN_TEST(test_steps_rise_and_match);
    RUN_TEST(test_a_csv_input_needs_a_file_and_a_column);
    RUN_TEST(test_a_duration_is_a_whole_number_of_ticks);
    RUN_TEST(test_the_check_finds_what_a_hand_has_spoilt);
    RUN_TEST(test_who_does_not_ask_why_is_refused_all_the_same);
    RUN_TEST(test_variation_changes_parameters_within_its_spread_and_nothing_else);
    RUN_TEST(test_gravity_gears_and_supply_do_not_vary);
    RUN_TEST(test_variation_is_a_function_of_seed_and_parameter_alone);
    RUN_TEST(test_variation_draws_are_the_same_everywhere);
    RUN_TEST(test_variation_stays_within_the_range_of_a_parameter);
    return UNITY_END();
}

/* Vectors, matrices and lists of rows in scenes: what they set, and what is refused with which words. */
#include <stdio.h>
#include <string.h>

#include "mctau/scene.h"
#include "unity.h"

#define AXIS  "[scene]\nsystem = \"fixed_axis\"\n[parameters]\n"
#define BODY  "[scene]\nsystem = \"rigid_body\"\n[parameters]\n"
#define CHAIN "[scene]\nsystem = \"chain\"\n[parameters]\n"
#define ROW \
    "mass (1e-06 to 1000000 kg), b1 (-10000 to 10000 m), b2 (-10000 to 10000 m), b3 (-10000 to 10000 m)"

static mct_scene scene;
static mct_message why;

void setUp(void)
{
    mct_message_clear(&why);
}

void tearDown(void)
{
}

static mct_status read_with(const char *text, const char *override)
{
    const mct_override overrides[] = {{override, "--set"}};
    return mct_scene_read(text, strlen(text), "x.toml", overrides, override != NULL, &scene, &why);
}

static void assert_read(const char *text)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, read_with(text, NULL), why.text);
}

static void assert_refused(const char *text, const char *sentence)
{
    mct_scene before;
    memset(&scene, 0xA5, sizeof scene);
    memcpy(&before, &scene, sizeof before);
    TEST_ASSERT_TRUE_MESSAGE(read_with(text, NULL) != MCT_OK, text);
    TEST_ASSERT_EQUAL_STRING(sentence, why.text);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(&before, &scene, sizeof before, "a refusal changed the scene");
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

static void test_a_vector_sets_its_components_and_a_component_one_of_them(void)
{
    assert_read(AXIS "gravity = [1, -2.5, 3e0]\naxis_2 = 0.5");
    TEST_ASSERT_EQUAL_DOUBLE(1, parameter("gravity_1"));
    TEST_ASSERT_EQUAL_DOUBLE(-2.5, parameter("gravity_2"));
    TEST_ASSERT_EQUAL_DOUBLE(3, parameter("gravity_3"));
    TEST_ASSERT_EQUAL_DOUBLE(0.5, parameter("axis_2"));
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_with(AXIS "gravity = [1, 2, 3]", "parameters.gravity=[4, 5, 6]"));
    TEST_ASSERT_EQUAL_DOUBLE(6, parameter("gravity_3"));
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_with(AXIS "gravity = [1, 2, 3]", "parameters.gravity_2=7"));
    TEST_ASSERT_EQUAL_DOUBLE(7, parameter("gravity_2"));
}

static void test_a_matrix_is_a_list_of_its_rows(void)
{
    assert_read(BODY "particles = []\nmass = 1\ninertia = [[2, 0.1, 0], [0.1, 2, 0], [0, 0, 3]]");
    TEST_ASSERT_EQUAL_DOUBLE(0.1, parameter("inertia_1_2"));
    TEST_ASSERT_EQUAL_DOUBLE(3, parameter("inertia_3_3"));
}

static void test_the_start_of_a_rotation_is_a_quaternion(void)
{
    assert_read(BODY "[initial]\nattitude = [0.6, 0, 0.8, 0]\nangular_velocity = [1, 2, 3]");
    TEST_ASSERT_EQUAL_DOUBLE(0.6, scene.initial[3]);
    TEST_ASSERT_EQUAL_DOUBLE(0.8, scene.initial[5]);
    TEST_ASSERT_EQUAL_DOUBLE(3, scene.initial[12]);
    TEST_ASSERT_EQUAL_INT(13, mct_state_count(&scene));
    TEST_ASSERT_FALSE(mct_scene_note(&scene, 0, &why));
}

static void test_a_quaternion_of_another_length_is_noted_and_one_of_none_refused(void)
{
    assert_read(BODY "[initial]\nattitude = [0, 3, 0, 4]");
    TEST_ASSERT_TRUE(mct_scene_note(&scene, 0, &why));
    TEST_ASSERT_EQUAL_STRING("initial.attitude: found a quaternion of length 5; it is taken with length 1",
                             why.text);
    TEST_ASSERT_FALSE(mct_scene_note(&scene, 1, &why));
    assert_refused(
        BODY "[initial]\nattitude = [0, 0, 0, 0]",
        "x.toml:5: initial.attitude_w: found a quaternion of length 0; allowed any other, as 1, 0, 0, 0");
}

static void test_a_list_of_rows_is_as_long_as_it_is_written(void)
{
    assert_read(AXIS "particles = [[1, 0.1, 0.2, 0.3], # the first\n [2, 0, 0, 1],]");
    TEST_ASSERT_EQUAL_INT(2, mct_particle_count(&scene));
    TEST_ASSERT_EQUAL_DOUBLE(0.3, scene.lists[0].values[3]);
    TEST_ASSERT_EQUAL_DOUBLE(2, scene.lists[0].values[4]);
    assert_read(CHAIN "link_lengths = [0.3, 0.2, 0.1]");
    TEST_ASSERT_EQUAL_INT(3, mct_coordinate_count(&scene));
    TEST_ASSERT_EQUAL_INT(3, mct_state_count(&scene));
}

static void test_a_name_in_a_row_is_one_of_its_columns(void)
{
    assert_read(BODY "forces = [[\"space\", 0, 0, 0, 1, 2, 3], [\"body\", 0, 0, 0.5, 1, 0, 0]]");
    TEST_ASSERT_EQUAL_INT(14, scene.lists[1].count);
    TEST_ASSERT_TRUE(scene.lists[1].values[0] != scene.lists[1].values[7]);
    TEST_ASSERT_TRUE(read_with(BODY "forces = [[\"moon\", 0, 0, 0, 1, 2, 3]]", NULL) != MCT_OK);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text,
                                        "x.toml:4: parameters.forces: found [[\"moon\", 0, 0, 0, 1, 2, 3]], "
                                        "with a name that is unknown; allowed 0 to "),
                                 why.text);
}

static void test_what_a_vector_is_not_is_refused(void)
{
    assert_refused(
        AXIS "gravity = [1, 2]",
        "x.toml:4: parameters.gravity: found [1, 2]; allowed a list of 3: gravity_1, gravity_2, gravity_3");
    assert_refused(
        AXIS "gravity = 9.81",
        "x.toml:4: parameters.gravity: found 9.81; allowed a list of 3: gravity_1, gravity_2, gravity_3");
    assert_refused(AXIS "gravity = [1, 2e9, 3]",
                   "x.toml:4: parameters.gravity_2: found 2e9 m/s^2; allowed -10000 to 10000 m/s^2");
    assert_refused(AXIS "gravity = [1, \"x\", 3]",
                   "x.toml:4: parameters.gravity_2: found \"x\", a text, where a number "
                   "belongs; allowed -10000 to 10000 m/s^2");
    assert_refused(AXIS "friction = [1]",
                   "x.toml:4: parameters.friction: found [1], a list, where a number belongs; "
                   "allowed 0 to 1000000 N m s");
}

static void test_what_a_row_is_not_is_refused(void)
{
    assert_refused(AXIS "particles = [[1, 0, 0]]",
                   "x.toml:4: parameters.particles: found [1, 0, 0] as row 1; allowed 1 to 32 rows of " ROW);
    assert_refused(AXIS "particles = [[1, 0, 1, 0], 2]",
                   "x.toml:4: parameters.particles: found 2 as row 2; allowed 1 to 32 rows of " ROW);
    assert_refused(AXIS "particles = []",
                   "x.toml:4: parameters.particles: found 0 rows; allowed 1 to 32 rows of " ROW);
    assert_refused(
        AXIS "particles = [[1, 0, 1, 0], [-1, 0, 0, 0]]",
        "x.toml:4: parameters.particles: found -1 kg as mass of row 2; allowed 1e-06 to 1000000 kg");
    assert_refused(CHAIN "link_lengths = [1, 0]",
                   "x.toml:4: parameters.link_lengths: found 0 m as number 2; allowed 0.0001 to 10000 m");
    assert_refused(CHAIN "link_lengths = [1, true]",
                   "x.toml:4: parameters.link_lengths: found [1, true], where numbers "
                   "belong; allowed 1 to 16 numbers from 0.0001 to 10000 m");
    assert_refused(
        CHAIN "link_lengths = [1, 1]\n[initial]\nangle_3 = 1",
        "x.toml:6: initial.angle_3: found a state that the scene has not; allowed with a longer list");
}

static void test_more_rows_than_there_is_room_for_are_refused_with_the_bound(void)
{
    char text[1024] = AXIS "particles = [";
    for (int i = 0; i < MCT_MAX_PARTICLES + 1; i++) {
        strcat(text, "[1, 1, 0, 0],");
    }
    strcat(text, "]");
    assert_refused(text, "x.toml:4: parameters.particles: found 33 rows; allowed 1 to 32 rows of " ROW);
    assert_refused(CHAIN "link_lengths = [1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1]",
                   "x.toml:4: parameters.link_lengths: found 17 numbers; allowed 1 to 16 numbers from 0.0001 "
                   "to 10000 m");
}

static void test_a_scene_changed_by_hand_is_checked_as_well(void)
{
    assert_read(AXIS);
    scene.lists[0].count = 5;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, mct_scene_check(&scene, &why));
    scene.lists[0].count = 4;
    scene.lists[0].values[0] = -2;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_scene_check(&scene, &why));
    TEST_ASSERT_EQUAL_STRING(
        "parameters.particles: found -2 kg as mass of row 1; allowed 1e-06 to 1000000 kg", why.text);
    assert_read(CHAIN);
    scene.parameters[2] = 0.5; /* method, a name */
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_scene_check(&scene, &why));
}

static void test_an_input_of_a_system_that_has_none_is_refused(void)
{
    assert_refused("[scene]\nsystem = \"rigid_body\"\n[input]\nkind = \"constant\"\nvalue = 1",
                   "x.toml:4: input.kind: found an input, which rigid_body has not; allowed none");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_vector_sets_its_components_and_a_component_one_of_them);
    RUN_TEST(test_a_matrix_is_a_list_of_its_rows);
    RUN_TEST(test_the_start_of_a_rotation_is_a_quaternion);
    RUN_TEST(test_a_quaternion_of_another_length_is_noted_and_one_of_none_refused);
    RUN_TEST(test_a_list_of_rows_is_as_long_as_it_is_written);
    RUN_TEST(test_a_name_in_a_row_is_one_of_its_columns);
    RUN_TEST(test_what_a_vector_is_not_is_refused);
    RUN_TEST(test_what_a_row_is_not_is_refused);
    RUN_TEST(test_more_rows_than_there_is_room_for_are_refused_with_the_bound);
    RUN_TEST(test_a_scene_changed_by_hand_is_checked_as_well);
    RUN_TEST(test_an_input_of_a_system_that_has_none_is_refused);
    return UNITY_END();
}

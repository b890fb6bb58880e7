/* What a tick reaches through a descriptor is found from outside by its name. */
#include "control/swing_up.h"
#include "support/scenes.h"
#include "support/swing_up.h"
#include "systems/systems.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_a_systems_series_is_found_by_its_name(void)
{
    static const struct {
        const mct_system *system;
        void (*motion)(const void *, uint32_t, const mct_state *, mct_real, mct_motion *);
    } named[] = {
#define MOTION(system) {&mct_##system, mct_##system##_motion}
        MOTION(cart_pole),         MOTION(reaction_wheel), MOTION(pendulum),
        MOTION(particle_pendulum), MOTION(fixed_axis),     MOTION(solid_pendulum),
    };
    size_t with_series = 0;
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        with_series += mct_systems[system]->motion != NULL;
    }
    TEST_ASSERT_EQUAL_size_t(with_series, sizeof named / sizeof *named);
    for (size_t i = 0; i < with_series; i++) {
        TEST_ASSERT_TRUE_MESSAGE(named[i].system->motion == named[i].motion, named[i].system->name);
    }
}

static void test_what_a_system_with_a_motor_has_is_found_by_its_name(void)
{
    static const struct {
        const mct_system *system;
        void (*accelerate)(const void *, uint32_t, const mct_real *, mct_real, mct_real, mct_real,
                           mct_real *);
        const mct_motor *(*motor)(const void *);
        mct_real (*swing_up)(mct_controller *);
    } named[] = {
#define MOTOR(system) \
    {&mct_##system, mct_##system##_accelerate, mct_##system##_motor, mct_##system##_swing_up}
        MOTOR(cart_pole),
        MOTOR(reaction_wheel),
    };
    size_t with_motor = 0;
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        with_motor += mct_systems[system]->actuation != NULL;
    }
    TEST_ASSERT_EQUAL_size_t(with_motor, sizeof named / sizeof *named);
    for (size_t i = 0; i < with_motor; i++) {
        const char *const name = named[i].system->name;
        const mct_scene scene = swing_up_scene(system_called(name));
        mct_controller controller;
        mct_constants constants;
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_controller_init(&controller, &constants, &scene, NULL));
        TEST_ASSERT_TRUE_MESSAGE(named[i].system->actuation->accelerate == named[i].accelerate, name);
        TEST_ASSERT_TRUE_MESSAGE(named[i].system->actuation->motor == named[i].motor, name);
        TEST_ASSERT_TRUE_MESSAGE(controller.swing_up == named[i].swing_up, name);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_systems_series_is_found_by_its_name);
    RUN_TEST(test_what_a_system_with_a_motor_has_is_found_by_its_name);
    return UNITY_END();
}

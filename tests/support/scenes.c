#include "support/scenes.h"

#include <math.h>
#include <string.h>

#include "unity.h"

int system_called(const char *name)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, name) == 0) {
            return i;
        }
    }
    TEST_FAIL_MESSAGE(name);
    return 0;
}

mct_scene scene_of(int system, int stepper, uint32_t effects)
{
    mct_scene scene;
    mct_scene_defaults(&scene, system);
    scene.stepper = stepper;
    scene.effects = effects;
    return scene;
}

double *parameter_of(mct_scene *scene, const char *name)
{
    const mct_system *const system = mct_systems[scene->system];
    for (int i = 0; i < system->parameter_count; i++) {
        if (strcmp(system->parameters[i].name, name) == 0) {
            return &scene->parameters[i];
        }
    }
    TEST_FAIL_MESSAGE(name);
    return NULL;
}

void start_plant(mct_plant *plant, const mct_scene *scene)
{
    mct_message why = {""};
    const mct_status status = mct_plant_init(plant, scene, &why);
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, status, why.text);
}

void step_plant(mct_plant *plant, mct_real input, long ticks)
{
    for (long k = 0; k < ticks; k++) {
        mct_plant_step(plant, input);
    }
}

double energy_of(const mct_plant *plant)
{
    mct_evaluation now;
    mct_plant_evaluate(plant, &now);
    return (double)now.kinetic_energy + (double)now.potential_energy + (double)now.magnetic_energy;
}

const char *motor_name(uint32_t effects)
{
    return (effects & MCT_MOTOR_INDUCTIVE)      ? "inductive"
           : (effects & MCT_MOTOR_QUASI_STATIC) ? "quasi_static"
                                                : "off";
}

double angle_size(double angle)
{
    return fabs(remainder(angle, 6.283185307179586));
}

int suiting_stepper(int stepper, int system, uint32_t effects)
{
    do {
        stepper++;
    } while (stepper < MCT_STEPPER_COUNT && mct_systems[system]->kernel(stepper, effects) == NULL);
    return stepper;
}

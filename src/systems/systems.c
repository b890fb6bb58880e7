#include "mctau/system.h"

#include "mctau/scene.h"
#include "systems.h"

const mct_system *const mct_systems[MCT_SYSTEM_COUNT] = {&mct_cart_pole, &mct_reaction_wheel, &mct_pendulum};

static const mct_field current_field =
    MCT_QUANTITY("current", "A", -1e6, 1e6, 0, "armature current of an inductive motor");

int mct_encoder_count(const mct_system *system)
{
    return system->actuation != NULL ? system->coordinate_count : 0;
}

int mct_state_count(const mct_system *system, uint32_t effects)
{
    return 2 * system->coordinate_count + ((effects & MCT_MOTOR_INDUCTIVE) ? 1 : 0);
}

const mct_field *mct_state_field(const mct_system *system, int index)
{
    const int n = system->coordinate_count;
    if (index < n) {
        return &system->coordinates[index].position;
    }
    return index < 2 * n ? &system->coordinates[index - n].rate : &current_field;
}

uint32_t mct_scene_effects(const mct_scene *scene)
{
    const mct_system *system = mct_systems[scene->system];
    if ((scene->effects & MCT_MOTOR_INDUCTIVE) && scene->parameters[system->actuation->inductance_parameter] == 0) {
        return (scene->effects & ~(uint32_t)MCT_MOTOR) | MCT_MOTOR_QUASI_STATIC;
    }
    return scene->effects;
}

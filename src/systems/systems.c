#include "mctau/system.h"

#include "mctau/scene.h"
#include "systems.h"

const mct_system *const mct_systems[MCT_SYSTEM_COUNT] = {
    &mct_cart_pole,   &mct_reaction_wheel, &mct_pendulum,       &mct_spring_pendulum, &mct_linked_particles,
    &mct_moving_base, &mct_rotating_frame, &mct_solid_pendulum, &mct_block,           &mct_falling_sphere,
};

static const mct_field current_field =
    MCT_QUANTITY("current", "A", -1e6, 1e6, 0, "armature current of an inductive motor");

int mct_encoder_count(const mct_system *system)
{
    return system->actuation != NULL ? system->coordinate_count : 0;
}

int mct_state_count(const mct_system *system, uint32_t effects)
{
    const bool moves = (effects & MCT_CLOCK) && system->phases != NULL;
    return 2 * system->coordinate_count + ((effects & MCT_MOTOR_INDUCTIVE) ? 1 : 0) +
           (moves ? MCT_PHASES : 0);
}

bool mct_state_is_phase(const mct_system *system, int index)
{
    return system->phases != NULL && index >= 2 * system->coordinate_count;
}

bool mct_state_is_phase_angle(const mct_system *system, int index)
{
    return mct_state_is_phase(system, index) &&
           system->phases[index - 2 * system->coordinate_count].unit[0] == 'r';
}

const mct_field *mct_state_field(const mct_system *system, int index)
{
    const int n = system->coordinate_count;
    if (index < n) {
        return &system->coordinates[index].position;
    }
    if (mct_state_is_phase(system, index)) {
        return &system->phases[index - 2 * n];
    }
    return index < 2 * n ? &system->coordinates[index - n].rate : &current_field;
}

uint32_t mct_scene_effects(const mct_scene *scene)
{
    const mct_system *system = mct_systems[scene->system];
    if ((scene->effects & MCT_MOTOR_INDUCTIVE) &&
        scene->parameters[system->actuation->inductance_parameter] == 0) {
        return (scene->effects & ~(uint32_t)MCT_MOTOR) | MCT_MOTOR_QUASI_STATIC;
    }
    return scene->effects;
}

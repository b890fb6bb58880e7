#include "mctau/system.h"

#include "mctau/scene.h"
#include "systems.h"

const mct_system *const mct_systems[MCT_SYSTEM_COUNT] = {
    &mct_cart_pole,
    &mct_reaction_wheel,
    &mct_pendulum,
    &mct_spring_pendulum,
    &mct_linked_particles,
    &mct_particle_pendulum,
    &mct_moving_base,
    &mct_rotating_frame,
    &mct_ball_joint,
    &mct_fixed_axis,
    &mct_solid_pendulum,
    &mct_rigid_body,
    &mct_chain,
    &mct_block,
    &mct_falling_sphere,
};

static const mct_field current_field =
    MCT_QUANTITY("current", "A", -1e6, 1e6, 0, "armature current of an inductive motor");

/* Of a rotation; a scene's is made one of length 1. */
static const mct_field quaternion_fields[4] = {
    MCT_QUANTITY("attitude_w", "", -1e6, 1e6, 1, "quaternion from body to space, any length but 0"),
    MCT_QUANTITY("attitude_x", "", -1e6, 1e6, 0, ""),
    MCT_QUANTITY("attitude_y", "", -1e6, 1e6, 0, ""),
    MCT_QUANTITY("attitude_z", "", -1e6, 1e6, 0, ""),
};

#define NUMBERED_8(a, b, c, d, e, f, g, h)                                                                   \
    "particle_" a, "particle_" b, "particle_" c, "particle_" d, "particle_" e, "particle_" f, "particle_" g, \
        "particle_" h
const char *const mct_particle_numbers[MCT_MAX_PARTICLES] = {
    NUMBERED_8("1", "2", "3", "4", "5", "6", "7", "8"),
    NUMBERED_8("9", "10", "11", "12", "13", "14", "15", "16"),
    NUMBERED_8("17", "18", "19", "20", "21", "22", "23", "24"),
    NUMBERED_8("25", "26", "27", "28", "29", "30", "31", "32"),
};

int mct_encoder_count(const mct_system *system)
{
    return system->actuation != NULL ? system->coordinate_count : 0;
}

/* Rows of a scene's first list. */
static int listed(const mct_scene *scene)
{
    return scene->lists[0].count / mct_systems[scene->system]->lists[0].column_count;
}

int mct_coordinate_count(const mct_scene *scene)
{
    const mct_system *system = mct_systems[scene->system];
    return system->lists_coordinates ? listed(scene) : system->coordinate_count;
}

int mct_particle_count(const mct_scene *scene)
{
    const mct_system *system = mct_systems[scene->system];
    return system->lists_particles && listed(scene) > 0 ? listed(scene) : system->particle_count;
}

int mct_rate_index(const mct_system *system)
{
    return system->coordinate_count + (system->attitude != MCT_ATTITUDE_NONE ? 1 : 0);
}

static int state_count(const mct_system *system, int coordinates, uint32_t effects)
{
    const bool moves = (effects & MCT_CLOCK) && system->phases != NULL;
    return system->is_process ? coordinates
                              : mct_rate_index(system) + coordinates +
                                    ((effects & MCT_MOTOR_INDUCTIVE) ? 1 : 0) + (moves ? MCT_PHASES : 0);
}

int mct_state_count(const mct_scene *scene)
{
    return state_count(mct_systems[scene->system], mct_coordinate_count(scene), mct_scene_effects(scene));
}

int mct_most_states(const mct_system *system)
{
    return state_count(system, system->coordinate_count, system->effects);
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
    const int rate = mct_rate_index(system);
    if (rate > n && index >= n - 3 && index < rate) {
        return &quaternion_fields[index - (n - 3)];
    }
    if (index < n) {
        return &system->coordinates[index].position;
    }
    if (mct_state_is_phase(system, index)) {
        return &system->phases[index - 2 * n];
    }
    return index < rate + n ? &system->coordinates[index - rate].rate : &current_field;
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

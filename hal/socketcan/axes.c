#include "hal/socketcan/axes.h"

#include <string.h>

#include "mctau/constants.h"
#include "mctau/scene.h"

#define TURN 6.283185307179586476925

static mct_status refuse(mct_message *why, const char *key, const char *found, const char *allowed)
{
    mct_message_clear(why);
    mct_message_add(why, "can.");
    mct_message_add(why, key);
    mct_message_add(why, ": found ");
    mct_message_add(why, found);
    mct_message_add(why, "; allowed ");
    mct_message_add(why, allowed);
    return MCT_ERROR_UNSUITED;
}

static mct_status check_mode(const mct_scene *scene, mct_message *why)
{
    if (!(scene->effects & MCT_MOTOR)) {
        mct_message_clear(why);
        mct_message_add(
            why, "scene.hal: found a CAN bus with effects.motor off; allowed a motor, since a drive is "
                 "told volts");
        return MCT_ERROR_UNSUITED;
    }
    if (scene->can_mode == MCT_CAN_MODE_FOC && scene->can_protocol != MCT_CAN_VESC) {
        return refuse(why, "mode", "\"foc\", which a vesc alone has", "voltage, or protocol = \"vesc\"");
    }
    if (scene->can_mode == MCT_CAN_MODE_TORQUE && scene->can_protocol != MCT_CAN_ODRIVE) {
        return refuse(why, "mode", "\"torque\", which an odrive alone has",
                      "voltage, or protocol = \"odrive\"");
    }
    return MCT_OK;
}

/* A native drive is told its watchdog with each command, in whole milliseconds of a byte. */
static mct_status check_watchdog(const mct_scene *scene, mct_message *why)
{
    const double watchdog = scene->can_watchdog;
    if (scene->can_protocol == MCT_CAN_NATIVE && watchdog != 0 && !(watchdog >= 0.005 && watchdog <= 0.255)) {
        mct_message found;
        mct_message_clear(&found);
        mct_message_add_number(&found, watchdog);
        mct_message_add(&found, " s");
        return refuse(why, "watchdog", found.text,
                      "0 (none), or 0.005 to 0.255 s, which a native drive can be told");
    }
    return MCT_OK;
}

/* The motor by the turns of its drive's encoder. */
static mct_status describe_motor(const mct_scene *scene, mct_can_motor *motor, mct_message *why)
{
    const mct_system *system = mct_systems[scene->system];
    const int driven = system->actuation->driven_coordinate;
    mct_constants constants;
    const mct_status status = system->prepare(scene, scene->dt, &constants, why);
    if (status != MCT_OK) {
        return status;
    }
    const mct_motor *windings = system->actuation->motor(&constants);
    const double ratio = scene->can_encoder_ratio[driven];
    const double unit = (system->coordinates[driven].is_angle ? TURN : 1) / (ratio < 0 ? -ratio : ratio);
    motor->supply = scene->parameters[system->actuation->supply_parameter];
    motor->resistance = scene->parameters[system->actuation->resistance_parameter];
    motor->emf_per_turn = (double)windings->emf * unit;
    motor->torque_per_ampere = (double)windings->force_per_ampere * unit / TURN;
    motor->inverted = scene->can_inverted != 0;
    return MCT_OK;
}

/* Number of the drive that reads an encoder. */
static int32_t node_of(const mct_scene *scene, const mct_can_protocol *protocol, int coordinate)
{
    const mct_system *system = mct_systems[scene->system];
    const int32_t given = scene->can_encoder_node[coordinate];
    const bool with_motor = coordinate == system->actuation->driven_coordinate || protocol->has_spare;
    return given >= 0 ? given : with_motor ? scene->can_node : scene->can_node + 1;
}

static mct_can_axis *axis_of_node(mct_can_axes *axes, uint8_t node)
{
    for (int i = 0; i < axes->count; i++) {
        if (axes->axes[i].node == node) {
            return &axes->axes[i];
        }
    }
    mct_can_axis *axis = &axes->axes[axes->count++];
    axis->node = node;
    return axis;
}

static mct_status place_encoder(mct_can_axes *axes, const mct_scene *scene, int coordinate, mct_message *why)
{
    const mct_coordinate *described = &mct_systems[scene->system]->coordinates[coordinate];
    const double ratio = scene->can_encoder_ratio[coordinate];
    const int32_t node = node_of(scene, axes->protocol, coordinate);
    if (ratio == 0) {
        return refuse(why, described->encoder_ratio.name, "0", "any other number of turns");
    }
    if (node > 63) {
        return refuse(why, described->encoder_node.name, "64, the number behind can.node", "0 to 63");
    }
    mct_can_axis *axis = axis_of_node(axes, (uint8_t)node);
    const int place = axis->encoders[0].used ? 1 : 0;
    if (place == 1 && !axes->protocol->has_spare) {
        return refuse(why, described->encoder_node.name, "the drive that reads the other encoder",
                      "another one: such a drive reads its own encoder only");
    }
    mct_can_encoder *encoder = &axis->encoders[place];
    encoder->used = true;
    encoder->coordinate = coordinate;
    encoder->counts_per_turn = scene->counts_per_unit[coordinate] / ratio;
    axis->roles |= place == 0 ? MCT_CAN_OF_ENCODER : MCT_CAN_OF_SPARE;
    return MCT_OK;
}

mct_status mct_can_axes_init(mct_can_axes *axes, const mct_scene *scene, mct_message *why)
{
    const mct_system *system = mct_systems[scene->system];
    memset(axes, 0, sizeof *axes);
    axes->protocol = mct_can_protocol_of(scene);
    mct_status status = check_mode(scene, why);
    status = status != MCT_OK ? status : check_watchdog(scene, why);
    const int driven = status == MCT_OK ? system->actuation->driven_coordinate : 0;
    if (status == MCT_OK) {
        const bool is_torque = scene->can_mode == MCT_CAN_MODE_TORQUE;
        axis_of_node(axes, (uint8_t)scene->can_node)->roles =
            MCT_CAN_OF_MOTOR | (is_torque ? (uint32_t)MCT_CAN_OF_TORQUE : 0);
        /* A drive's own encoder is that of its motor. */
        status = place_encoder(axes, scene, driven, why);
    }
    for (int i = 0; i < system->coordinate_count && status == MCT_OK; i++) {
        if (i != driven) {
            status = place_encoder(axes, scene, i, why);
        }
    }
    if (status == MCT_OK) {
        status = describe_motor(scene, &axes->axes[0].motor, why);
    }
    for (int i = 0; i < axes->count; i++) {
        axes->axes[i].protocol = axes->protocol;
        axes->axes[i].scene = scene;
        axes->axes[i].watchdog_ms = mct_can_watchdog_ms(scene->can_watchdog);
    }
    return status;
}

mct_can_encoder *mct_can_encoder_of(mct_can_axes *axes, int coordinate, mct_can_axis **axis)
{
    for (int i = 0; i < axes->count; i++) {
        for (int j = 0; j < MCT_CAN_ENCODERS; j++) {
            mct_can_encoder *encoder = &axes->axes[i].encoders[j];
            if (encoder->used && encoder->coordinate == coordinate) {
                *axis = &axes->axes[i];
                return encoder;
            }
        }
    }
    *axis = NULL;
    return NULL;
}

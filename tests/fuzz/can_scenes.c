#include "fuzz/can_scenes.h"

#include <string.h>

#include "fuzz/fuzz.h"
#include "mctau/stepper.h"

enum { CART_POLE, REACTION_WHEEL }; /* as in mct_systems */

mct_scene fuzz_can_scene(int number)
{
    static const struct {
        int32_t system, protocol, mode, firmware, inverted;
        int32_t encoder_node[MCT_MAX_ENCODERS];
        double ratio;
    } all[FUZZ_CAN_SCENES] = {
        {REACTION_WHEEL, MCT_CAN_NATIVE, MCT_CAN_MODE_VOLTAGE, 0, 0, {-1, -1}, 1},
        {CART_POLE, MCT_CAN_NATIVE, MCT_CAN_MODE_VOLTAGE, 0, 1, {-1, -1}, -1},
        {REACTION_WHEEL, MCT_CAN_NATIVE, MCT_CAN_MODE_VOLTAGE, 0, 1, {9, 1}, 1},
        {CART_POLE, MCT_CAN_NATIVE, MCT_CAN_MODE_VOLTAGE, 0, 0, {1, 9}, 3},
        {REACTION_WHEEL, MCT_CAN_VESC, MCT_CAN_MODE_VOLTAGE, 0, 0, {-1, -1}, 1},
        {CART_POLE, MCT_CAN_VESC, MCT_CAN_MODE_FOC, 0, 1, {-1, -1}, -10},
        {REACTION_WHEEL, MCT_CAN_ODRIVE, MCT_CAN_MODE_VOLTAGE, MCT_CAN_FIRMWARE_0_6, 0, {-1, -1}, 1},
        {CART_POLE, MCT_CAN_ODRIVE, MCT_CAN_MODE_VOLTAGE, MCT_CAN_FIRMWARE_0_5, 1, {-1, -1}, 10},
        {REACTION_WHEEL, MCT_CAN_ODRIVE, MCT_CAN_MODE_TORQUE, MCT_CAN_FIRMWARE_0_6, 1, {-1, -1}, -1},
        {CART_POLE, MCT_CAN_ODRIVE, MCT_CAN_MODE_TORQUE, MCT_CAN_FIRMWARE_0_5, 0, {-1, -1}, 10},
        {CART_POLE, MCT_CAN_VESC, MCT_CAN_MODE_VOLTAGE, 0, 0, {-1, -1}, 10},
        {REACTION_WHEEL, MCT_CAN_ODRIVE, MCT_CAN_MODE_VOLTAGE, MCT_CAN_FIRMWARE_0_5, 0, {0, 1}, 1},
    };
    const int i = number % FUZZ_CAN_SCENES;
    mct_scene scene;
    mct_message why;
    mct_scene_defaults(&scene, all[i].system);
    scene.stepper = all[i].system == CART_POLE ? MCT_STEPPER_RK4 : MCT_STEPPER_EXPO;
    scene.controller = MCT_CONTROLLER_SWING_UP_BALANCE;
    scene.can_protocol = all[i].protocol;
    scene.can_mode = all[i].mode;
    scene.can_firmware = all[i].firmware;
    scene.can_inverted = all[i].inverted;
    scene.can_highest_load = 10;
    for (int j = 0; j < MCT_MAX_ENCODERS; j++) {
        scene.can_encoder_node[j] = all[i].encoder_node[j];
        scene.can_encoder_ratio[j] = all[i].ratio;
    }
    FUZZ_RULE(mct_scene_check(&scene, &why) == MCT_OK, "scene %d of the fuzz targets suits: %s", i, why.text);
    return scene;
}

mct_can_device fuzz_can_device(const mct_can_axes *axes, int number)
{
    const mct_can_axis *axis = &axes->axes[number];
    return (mct_can_device){
        .protocol = axes->protocol,
        .scene = axis->scene,
        .node = axis->node,
        .roles = axis->roles,
        .serial = 1000,
        .state = MCT_CAN_DRIVE_IDLE,
        .supply = axes->axes[0].motor.supply,
    };
}

mct_can_frame fuzz_can_frame(const mct_can_axes *axes, const uint8_t bytes[FUZZ_CAN_FRAME])
{
    const mct_can_protocol *protocol = axes->protocol;
    const mct_can_message *message = &protocol->messages[(bytes[0] >> 2) % protocol->message_count];
    const int axis = (bytes[0] & 3) % axes->count;
    const bool is_odd = (bytes[1] & 0xF0) == 0xF0; /* else of the form that is expected, but for its length */
    mct_can_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.id = protocol->identifier(message->code, axes->axes[axis].node);
    frame.extended = protocol->extended;
    frame.length = (bytes[1] & 8) ? bytes[1] & 7 : message->length;
    if (is_odd) {
        frame.id = (bytes[2] & 1) ? frame.id : ((uint32_t)bytes[2] << 8 | bytes[3]) & 0x7FF;
        frame.extended ^= (bytes[2] & 2) != 0;
        frame.remote = (bytes[2] & 4) != 0;
        frame.length = (bytes[1] & 8) ? 8 : bytes[1] & 7;
    }
    for (int i = 0; i < frame.length && !frame.remote; i++) {
        frame.data[i] = bytes[4 + i];
    }
    return frame;
}

void fuzz_can_bytes(int axis, int message, int length, const uint8_t data[8], uint8_t bytes[FUZZ_CAN_FRAME])
{
    memset(bytes, 0, FUZZ_CAN_FRAME);
    bytes[0] = (uint8_t)(message << 2 | axis);
    bytes[1] = (uint8_t)(length < 8 ? 8 | length : 0);
    memcpy(bytes + 4, data, 8);
}

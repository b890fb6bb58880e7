/**
 * @file axes.h
 * Which drive powers the motor and which reads which encoder: from a scene's [can] and [sensors].
 */
#ifndef MCTAU_HAL_SOCKETCAN_AXES_H
#define MCTAU_HAL_SOCKETCAN_AXES_H

#include "hal/socketcan/protocol.h"
#include "mctau/message.h"

#define MCT_CAN_MAX_AXES (MCT_MAX_ENCODERS + 1)

/** The drives of a mechanism: one, or one for each encoder and one for the motor. axes[0] powers the motor. */
typedef struct {
    const mct_can_protocol *protocol;
    int count;
    mct_can_axis axes[MCT_CAN_MAX_AXES];
} mct_can_axes;

/**
 * @param scene  must outlive the axes
 * @param why    a sentence on failure: "can.key: found ...; allowed ..."
 * @return MCT_OK; MCT_ERROR_UNSUITED (no motor; two encoders on a drive that can read one; a mode that the protocol
 *         has not got; a watchdog that a native drive cannot be told)
 */
mct_status mct_can_axes_init(mct_can_axes *axes, const mct_scene *scene, mct_message *why);

/** The encoder of a coordinate, and its axis. */
mct_can_encoder *mct_can_encoder_of(mct_can_axes *axes, int coordinate, mct_can_axis **axis);

#endif

/* Scenes over a CAN bus, one for each protocol with all that changes its frames. */
#ifndef MCT_TEST_FUZZ_CAN_SCENES_H
#define MCT_TEST_FUZZ_CAN_SCENES_H

#include "hal/socketcan/axes.h"
#include "mctau/scene.h"

enum { FUZZ_CAN_SCENES = 12 };

/* Scene `number`, 0 to FUZZ_CAN_SCENES - 1: those of the folder scenes/, with drives. */
mct_scene fuzz_can_scene(int number);

/* A drive as it is when it has just started. */
mct_can_device fuzz_can_device(const mct_can_axes *axes, int number);

/* A frame from four bytes of shape and eight of data: mostly one that somebody at these axes listens to. */
enum { FUZZ_CAN_FRAME = 12 };
mct_can_frame fuzz_can_frame(const mct_can_axes *axes, const uint8_t bytes[FUZZ_CAN_FRAME]);

/* The bytes that give message `message` of axis `axis` with these data. */
void fuzz_can_bytes(int axis, int message, int length, const uint8_t data[8], uint8_t bytes[FUZZ_CAN_FRAME]);

#endif

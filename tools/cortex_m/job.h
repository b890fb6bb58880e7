/* What the host hands to an image that counts: plain data, laid out alike on both (its size is checked). */
#ifndef MCTAU_TOOLS_CORTEX_M_JOB_H
#define MCTAU_TOOLS_CORTEX_M_JOB_H

#include "mctau/scene.h"
#include "mctau/stepper.h"

enum { JOB_TICKS = 10000 }; /* at most */

typedef struct {
    uint32_t size; /* of this struct */
    int32_t ticks; /* to run */
    int32_t suited[MCT_STEPPER_COUNT];
    mct_scene scene; /* the plant's, one step a tick */
    double inputs[JOB_TICKS];
} job;

#endif

/**
 * @file input.h
 * Open-loop input of a scene's [input] table, held over each tick.
 */
#ifndef MCTAU_INPUT_H
#define MCTAU_INPUT_H

#include "mctau/scene.h"

/** Samples of an input of kind "csv", one a tick; caller-owned. The last one is held when they run out. */
typedef struct {
    const mct_real *values;
    size_t count;
} mct_samples;

typedef struct {
    int32_t kind;
    mct_real value;
    mct_real amplitude;
    uint64_t phase_per_tick; /**< [2^-64 turns]: it may go on for ever and loses nothing */
    int32_t step_count;
    uint64_t step_ticks[MCT_MAX_LIST]; /**< first tick of each step */
    mct_real step_values[MCT_MAX_LIST];
    mct_samples samples;
} mct_input;

void mct_input_init(mct_input *input, const mct_scene *scene, mct_samples samples);

/** Input of a tick: volts with a motor, else newtons or newton metres. */
mct_real mct_input_at(const mct_input *input, uint64_t tick);

#endif

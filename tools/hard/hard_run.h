/* A hard case's plant, from its scene's text to its ticks. */
#ifndef MCTAU_TOOLS_HARD_RUN_H
#define MCTAU_TOOLS_HARD_RUN_H

#include <stdint.h>

#include "hard.h"
#include "mctau/plant.h"
#include "mctau/scene.h"

typedef struct {
    mct_scene scene;
    mct_plant plant;
    hard_result *result;
} hard_run;

/*
 * Reads the trial's scene, with its stepper unless that of HARD_LIBRARY, and prepares its plant. `more`: further lines
 * of text ahead of the scene's, as "parameters.mass = 2\n"; or NULL.
 * Returns false where the library refuses: the result says why.
 */
bool hard_start(hard_run *self, const hard_trial *trial, const char *more, hard_result *result);

/* Goes on by whole ticks under one input. Returns false, the error being infinite, where a tick is rejected. */
bool hard_advance(hard_run *self, double input, uint64_t ticks);

/* Ticks of the trial's duration. */
uint64_t hard_ticks(const hard_run *self, const hard_trial *trial);

/* A state by its index, in double. */
double hard_value(const hard_run *self, int state);

/* Kinetic, potential and magnetic energy [J]. */
double hard_energy(const hard_run *self);

#endif

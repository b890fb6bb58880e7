/*
 * The wheel's reference: tests/support/reference.h, equations in raw form; variation of constants, as the motor is stiff.
 * Without inductance it is not, and there is no window to begin with: extrapolation in `steps` a tick.
 */
#ifndef MCTAU_BENCHMARK_WHEEL_REFERENCE_H
#define MCTAU_BENCHMARK_WHEEL_REFERENCE_H

#include "scenes.h"

/* States after each sample, SCENE_STATES apart; false where it cannot be done. */
bool wheel_reference(const bench_scene *scene, int steps, double *samples);

#endif

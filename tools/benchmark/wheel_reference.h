/* The stiff scenes' reference: tests/support/reference.h, equations in raw form and variation of constants. */
#ifndef MCTAU_BENCHMARK_WHEEL_REFERENCE_H
#define MCTAU_BENCHMARK_WHEEL_REFERENCE_H

#include "scenes.h"

/* States after each sample, SCENE_STATES apart; false where it cannot be done. */
bool wheel_reference(const bench_scene *scene, double *samples);

#endif

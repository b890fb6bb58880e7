/* The states after every 200 ms of a scene of tools/bench, and how far a motion is from the reference. */
#ifndef MCTAU_BENCHMARK_SAMPLES_H
#define MCTAU_BENCHMARK_SAMPLES_H

#include "scenes.h"

#ifdef __cplusplus
extern "C" {
#endif

/*
 * The samples of a scene as benchmark_references has written them: lines of its name, then numbers. Ends the program
 * when there are none.
 */
void samples_read(const char *file, const bench_scene *scene, double *samples);

/*
 * Largest error of an entry of the state, relative to 1 or to the largest that it gets in this motion, whichever is
 * more. NaN when it is 1 or more, or the motion is.
 */
double samples_error(const bench_scene *scene, const double *reference, const double *samples);

#ifdef __cplusplus
}
#endif
#endif

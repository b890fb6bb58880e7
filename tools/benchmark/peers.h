/*
 * One program beside which tools/bench --peers puts this library. A peer is one file that defines `the_peer`; peers.c is
 * the main program of each.
 */
#ifndef MCTAU_BENCHMARK_PEERS_H
#define MCTAU_BENCHMARK_PEERS_H

#include <signal.h>

#include "scenes.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    const char *name;
    bool is_fixed; /* the setting is the number of steps in a span; else a tolerance, absolute and relative */
} peer_method;

typedef struct {
    const char *name;
    const char *(*version)(void);
    int method_count;
    const peer_method *methods;
    /* Prepares a scene, untimed. NULL where the method does not suit. */
    void *(*open)(const bench_scene *scene, int method, double setting);
    /*
     * The motion from the start to the end, timed: the states of the closed form after each sample, one behind the
     * other. May be called again and again. False where the method gave up.
     */
    bool (*run)(void *self, const double *inputs, double *samples);
    void (*close)(void *self);
} peer;

extern const peer the_peer;

/* Set while a run goes on that has become too dear to be of use: it gives up at the next sample. */
extern volatile sig_atomic_t peer_is_late;

/* peer.run for one that advances by a span; inlined with its functions. */
static inline __attribute__((always_inline)) bool
peer_loop(const bench_scene *scene, void *self, const double *inputs, double *samples,
          bool (*advance)(void *self, int span, double input), void (*read)(void *self, double *x))
{
    const int spans = scene_spans_per_sample(scene);
    for (int sample = 0, span = 0; sample < SCENE_SAMPLES; sample++) {
        for (int k = 0; k < spans; k++, span++) {
            if (!advance(self, span, inputs[span])) {
                return false;
            }
        }
        read(self, samples + sample * scene->states);
        if (peer_is_late) {
            return false;
        }
    }
    return true;
}

#ifdef __cplusplus
}
#endif
#endif

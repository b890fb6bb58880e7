/*
 * The scenes of tools/bench --peers: the same parameters, initial states and inputs for every program, 10 s each. Behind
 * them those that this library is measured by alone (--central).
 *
 * A free scene has no input, and its state is asked for every 200 ms: any longer step, and dense output, is allowed.
 * A held one has a new input at every tick of 1 ms, as a controller gives it.
 */
#ifndef MCTAU_BENCHMARK_SCENES_H
#define MCTAU_BENCHMARK_SCENES_H

#include <math.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FORM_REAL  double
#define FORM_SIN   sin
#define FORM_COS   cos
#define FORM_SQRT  sqrt
#define FORM(name) scene_##name
#include "closed_form.h"
#undef FORM_REAL
#undef FORM_SIN
#undef FORM_COS
#undef FORM_SQRT
#undef FORM

enum {
    SCENE_TICKS = 10000,
    SCENE_TICKS_PER_SAMPLE = 200,
    SCENE_SAMPLES = SCENE_TICKS / SCENE_TICKS_PER_SAMPLE,
    SCENE_STATES = 7,
    SCENE_CONSTANTS = 9,
    SCENE_PARAMETERS = 12
};
#define SCENE_TICK 1e-3 /* [s] */

typedef enum { SCENE_PENDULUM, SCENE_SPRING, SCENE_CART_POLE, SCENE_WHEEL, SCENE_BODY } scene_form;

typedef struct {
    const char *name;
    const char *doc; /* for people: parameters, start, input */
    scene_form form;
    bool is_held;
    int states;
    struct {
        const char *name; /* as mctau calls it */
        double value;
    } parameters[SCENE_PARAMETERS];
    double start[SCENE_STATES]; /* of the closed form */
    double amplitude;           /* of the input */
} bench_scene;

enum { SCENE_PEERS = 13, SCENE_COUNT = 15 };
extern const bench_scene bench_scenes[SCENE_COUNT];

/* By its name; NULL without. */
const bench_scene *scene_by_name(const char *name);

/* SCENE_TICKS inputs, one for each tick. Not thread-safe: of the last scene asked for. */
const double *scene_inputs(const bench_scene *scene);

void scene_parameters(const bench_scene *scene, double *p);
void scene_constants(const bench_scene *scene, double *k);

typedef void (*scene_rate)(const double *k, double u, const double *x, double *dx);
scene_rate scene_rate_of(const bench_scene *scene);

/* A span is what a program integrates at once: a tick under one held input, or the time between two samples. */
static inline int scene_spans_per_sample(const bench_scene *scene)
{
    return scene->is_held ? SCENE_TICKS_PER_SAMPLE : 1;
}

static inline double scene_span(const bench_scene *scene)
{
    return scene->is_held ? SCENE_TICK : SCENE_TICK * SCENE_TICKS_PER_SAMPLE;
}

#ifdef __cplusplus
}
#endif
#endif

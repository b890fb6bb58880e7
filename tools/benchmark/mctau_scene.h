/* A scene of tools/bench --peers as this library sees it. */
#ifndef MCTAU_BENCHMARK_MCTAU_SCENE_H
#define MCTAU_BENCHMARK_MCTAU_SCENE_H

#include "mctau/plant.h"
#include "scenes.h"

/*
 * System, parameters, effects and initial state; a tick is a span. A body moves, too, in this library: its centre stays
 * at rest. False when this library has lost a name.
 */
static inline bool mctau_scene_of(const bench_scene *scene, mct_scene *out);

/* The state of the closed form from a plant's, and back into the 13 or fewer entries of one. */
static inline void mctau_read(const bench_scene *scene, const mct_plant *plant, double *x);
static inline void mctau_state_of(const bench_scene *scene, const double *x, double *entries);

/* ---- */

#include <string.h>

enum { MCTAU_BODY_Q = 3, MCTAU_BODY_W = 10 };

static inline bool mctau_scene_of(const bench_scene *scene, mct_scene *out)
{
    static const struct {
        const char *system;
        uint32_t effects;
    } forms[] = {
        [SCENE_PENDULUM] = {"pendulum", MCT_GRAVITY},
        [SCENE_SPRING] = {"spring_pendulum", MCT_GRAVITY | MCT_SPRING},
        [SCENE_CART_POLE] = {"cart_pole", MCT_GRAVITY | MCT_VISCOUS},
        [SCENE_WHEEL] = {"reaction_wheel", MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_INDUCTIVE},
        [SCENE_BODY] = {"rigid_body", 0},
    };
    int system = 0;
    while (system < MCT_SYSTEM_COUNT && strcmp(mct_systems[system]->name, forms[scene->form].system) != 0) {
        system++;
    }
    if (system == MCT_SYSTEM_COUNT) {
        return false;
    }
    const mct_system *model = mct_systems[system];
    mct_scene_defaults(out, system);
    out->effects = forms[scene->form].effects;
    out->dt = scene_span(scene);
    if (scene->form == SCENE_BODY) {
        memset(out->lists, 0, sizeof out->lists); /* inertia instead of particles */
        out->parameters[0] = 1;                   /* mass: of no effect */
    }
    for (int i = 0; i < SCENE_PARAMETERS && scene->parameters[i].name != NULL; i++) {
        int place = 0;
        while (place < model->parameter_count &&
               strcmp(model->parameters[place].name, scene->parameters[i].name) != 0) {
            place++;
        }
        if (place == model->parameter_count) {
            return false;
        }
        out->parameters[place] = scene->parameters[i].value;
    }
    mctau_state_of(scene, scene->start, out->initial);
    return true;
}

static inline void mctau_state_of(const bench_scene *scene, const double *x, double *entries)
{
    memset(entries, 0, sizeof(double) * MCT_MAX_STATES);
    if (scene->form == SCENE_SPRING) {
        const double r = hypot(x[0], x[1]);
        entries[0] = r;
        entries[1] = atan2(x[1], x[0]);
        entries[2] = (x[0] * x[2] + x[1] * x[3]) / r;
        entries[3] = (x[0] * x[3] - x[1] * x[2]) / (r * r);
    } else if (scene->form == SCENE_BODY) {
        memcpy(entries + MCTAU_BODY_Q, x, 4 * sizeof *x);
        memcpy(entries + MCTAU_BODY_W, x + 4, 3 * sizeof *x);
    } else {
        memcpy(entries, x, sizeof *x * (size_t)scene->states);
    }
}

static inline void mctau_read(const bench_scene *scene, const mct_plant *plant, double *x)
{
    if (scene->form == SCENE_SPRING) {
        const double r = mct_plant_value(plant, 0), rd = mct_plant_value(plant, 2);
        const double c = cos(mct_plant_value(plant, 1)), s = sin(mct_plant_value(plant, 1));
        const double across = r * mct_plant_value(plant, 3);
        x[0] = r * c;
        x[1] = r * s;
        x[2] = rd * c - across * s;
        x[3] = rd * s + across * c;
        return;
    }
    if (scene->form == SCENE_BODY) { /* no angles, no turns: the sum is the value */
        for (int i = 0; i < scene->states; i++) {
            const int entry = i < 4 ? MCTAU_BODY_Q + i : MCTAU_BODY_W + i - 4;
            x[i] = (double)plant->state.x[entry] + (double)plant->state.c[entry];
        }
        return;
    }
    for (int i = 0; i < scene->states; i++) {
        x[i] = mct_plant_value(plant, i);
    }
}

#endif

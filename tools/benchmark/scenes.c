#include "scenes.h"

#include <string.h>

/* clang-format off */
#define PENDULUM {{"mass", 0.1}, {"length", 0.3}, {"gravity", 9.81}}
#define SPRING {{"mass", 1}, {"stiffness", 100}, {"rest_length", 1}, {"gravity", 9.81}}
#define CART_POLE {{"cart_mass", 1}, {"pole_mass", 0.2}, {"pole_length", 0.5}, {"cart_friction", 0.1}, \
                   {"pole_friction", 0.005}, {"gravity", 9.81}}
#define WHEEL(time_constant) {{"wheel_mass", 0.085}, {"wheel_inertia", 2.495e-5}, {"arm_length", 0.127}, \
                   {"arm_inertia", 3.201e-3}, {"arm_moment", 0.025384}, {"gravity", 9.81}, \
                   {"arm_friction", 2e-4}, {"wheel_friction", 3e-6}, {"torque_constant", 0.0274}, \
                   {"back_emf_constant", 0.0274}, {"resistance", 12.1}, {"inductance", 12.1 * (time_constant)}}
#define BODY {{"inertia_1_1", 1}, {"inertia_2_2", 2}, {"inertia_3_3", 3}}

#define PENDULUM_START {2}
#define SPRING_START {1.2 * 0.54030230586813971740, 1.2 * 0.84147098480789650665} /* 1.2 m, 1 rad */
#define CART_POLE_START {0, 2}
#define WHEEL_START {2}
#define BODY_START {1, 0, 0, 0, 0.5, 2, 0.3}

#define WHEEL_HELD(text, doc, states, time_constant) \
    {"wheel " text " held", doc, SCENE_WHEEL, true, states, WHEEL(time_constant), WHEEL_START, 5}
#define WHEEL_SCENES(text, time_constant) \
    {"wheel " text " free", "mctau's default reaction wheel, L/R " text ", from 2 rad at rest, no voltage", \
     SCENE_WHEEL, false, 5, WHEEL(time_constant), WHEEL_START, 0}, \
    WHEEL_HELD(text, "the same under up to 5 V", 5, time_constant)
/* clang-format on */

const bench_scene bench_scenes[SCENE_COUNT] = {
    {"pendulum free", "0.1 kg at 0.3 m, no friction, from 2 rad (upright is 0) at rest", SCENE_PENDULUM,
     false, 2, PENDULUM, PENDULUM_START, 0},
    {"pendulum held", "the same under up to 0.1 N m", SCENE_PENDULUM, true, 2, PENDULUM, PENDULUM_START, 0.1},
    {"spring free", "1 kg at a spring of 100 N/m and 1 m, no friction, from 1.2 m and 1 rad at rest",
     SCENE_SPRING, false, 4, SPRING, SPRING_START, 0},
    {"spring held", "the same under up to 1 N m about the pivot", SCENE_SPRING, true, 4, SPRING, SPRING_START,
     1},
    {"cart_pole free", "m1 1, m2 0.2 kg, l 0.5 m, k1 0.1 N s/m, k2 0.005 N m s, from 2 rad at rest",
     SCENE_CART_POLE, false, 4, CART_POLE, CART_POLE_START, 0},
    {"cart_pole held", "the same under up to 1 N", SCENE_CART_POLE, true, 4, CART_POLE, CART_POLE_START, 1},
    WHEEL_SCENES("1 ms", 1e-3),
    WHEEL_SCENES("0.1 ms", 1e-4),
    WHEEL_SCENES("10 us", 1e-5),
    {"body free", "principal moments 1, 2, 3 kg m^2, no forces, from w = (0.5, 2, 0.3) rad/s", SCENE_BODY,
     false, 7, BODY, BODY_START, 0},
    /* no peers */
    WHEEL_HELD("5 ms", "L/R 5 ms", 5, 5e-3),
    WHEEL_HELD("0", "no inductance: the current is no state", 4, 0),
};

const bench_scene *scene_by_name(const char *name)
{
    for (int i = 0; i < SCENE_COUNT; i++) {
        if (strcmp(bench_scenes[i].name, name) == 0) {
            return &bench_scenes[i];
        }
    }
    return NULL;
}

/* A square wave with something else on it at every tick. */
const double *scene_inputs(const bench_scene *scene)
{
    static double inputs[SCENE_TICKS];
    for (int k = 0; k < SCENE_TICKS; k++) {
        const double wave = (k / 256) % 2 == 0 ? 0.75 : -0.75;
        const double rest = ((37 * k) % 64 - 31.5) / 126;
        inputs[k] = scene->is_held ? scene->amplitude * (wave + rest) : 0;
    }
    return inputs;
}

void scene_parameters(const bench_scene *scene, double *p)
{
    for (int i = 0; i < SCENE_PARAMETERS; i++) {
        p[i] = scene->parameters[i].value;
    }
}

void scene_constants(const bench_scene *scene, double *k)
{
    static void (*const constants[])(const double *,
                                     double *) = {[SCENE_PENDULUM] = scene_pendulum_constants,
                                                  [SCENE_SPRING] = scene_spring_constants,
                                                  [SCENE_CART_POLE] = scene_cart_pole_constants,
                                                  [SCENE_WHEEL] = scene_wheel_constants,
                                                  [SCENE_BODY] = scene_body_constants};
    double p[SCENE_PARAMETERS];
    scene_parameters(scene, p);
    constants[scene->form](p, k);
}

scene_rate scene_rate_of(const bench_scene *scene)
{
    static const scene_rate rates[] = {[SCENE_PENDULUM] = scene_pendulum_rate,
                                       [SCENE_SPRING] = scene_spring_rate,
                                       [SCENE_CART_POLE] = scene_cart_pole_rate,
                                       [SCENE_WHEEL] = scene_wheel_rate,
                                       [SCENE_BODY] = scene_body_rate};
    return rates[scene->form];
}

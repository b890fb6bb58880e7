/*
 * MuJoCo's mj_step on a model of the same mechanism, with everything off that the scene does not need. It has equations
 * of its own; what differs:
 *   A point mass has no inertia, but MuJoCo wants one: it gets 1e-14 kg m^2.
 *   The arm of the wheel is 1 kg at a place that gives the same moments; only those are felt.
 *   The motor's current is an activation: with RK4 its rate is a callback, with the other integrators, which would not
 *   follow it, MuJoCo's exact filter of (V - k_b w) / R.
 */
#include "peers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mujoco/mujoco.h>

#define INERTIA 1e-14

static const peer_method methods[] = {{"Euler", true}, {"implicitfast", true}, {"RK4", true}};
enum { EULER, IMPLICITFAST, RK4, METHODS };

typedef struct {
    const bench_scene *scene;
    mjModel *model;
    mjData *data;
    int steps;
} theirs;

/* Of the model that is running: the callbacks have no context. */
static const bench_scene *running;
static double voltage;

enum { TORQUE_CONSTANT = 8, BACK_EMF, RESISTANCE, INDUCTANCE };

static mjtNum current_rate(const mjModel *model, const mjData *data, int id)
{
    (void)model, (void)id;
    return (voltage - running->parameters[RESISTANCE].value * data->act[0] -
            running->parameters[BACK_EMF].value * data->qvel[1]) /
           running->parameters[INDUCTANCE].value;
}

static void final_current(const mjModel *model, mjData *data)
{
    (void)model;
    data->ctrl[0] = (voltage - running->parameters[BACK_EMF].value * data->qvel[1]) /
                    running->parameters[RESISTANCE].value;
}

static void say_nothing(const char *text)
{
    (void)text;
}

static void write_bodies(const bench_scene *scene, const double *p, char *text, size_t size)
{
    switch (scene->form) {
    case SCENE_PENDULUM:
        snprintf(text, size,
                 "<body><joint type='hinge' axis='0 1 0'/>"
                 "<inertial pos='0 0 %.17g' mass='%.17g' diaginertia='%g %g %g'/></body>",
                 p[1], p[0], INERTIA, INERTIA, INERTIA);
        break;
    case SCENE_SPRING: /* counterclockwise from axis 1 */
        snprintf(text, size,
                 "<body><joint type='hinge' axis='0 -1 0'/>"
                 "<joint type='slide' axis='1 0 0' stiffness='%.17g' springref='%.17g'/>"
                 "<inertial pos='0 0 0' mass='%.17g' diaginertia='%g %g %g'/></body>",
                 p[1], p[2], p[0], INERTIA, INERTIA, INERTIA);
        break;
    case SCENE_CART_POLE:
        snprintf(text, size,
                 "<body><joint type='slide' axis='1 0 0' damping='%.17g'/>"
                 "<inertial pos='0 0 0' mass='%.17g' diaginertia='%g %g %g'/>"
                 "<body><joint type='hinge' axis='0 1 0' damping='%.17g'/>"
                 "<inertial pos='0 0 %.17g' mass='%.17g' diaginertia='%g %g %g'/></body></body>",
                 p[3], p[0], INERTIA, INERTIA, INERTIA, p[4], p[2], p[1], INERTIA, INERTIA, INERTIA);
        break;
    case SCENE_WHEEL: {
        const double arm = p[3] - p[4] * p[4]; /* about its centre, of 1 kg at p[4] */
        snprintf(text, size,
                 "<body><joint type='hinge' axis='0 1 0' damping='%.17g'/>"
                 "<inertial pos='0 0 %.17g' mass='1' diaginertia='%.17g %.17g %.17g'/>"
                 "<body pos='0 0 %.17g'><joint name='wheel' type='hinge' axis='0 1 0' damping='%.17g'/>"
                 "<inertial pos='0 0 0' mass='%.17g' diaginertia='%.17g %.17g %.17g'/></body></body>",
                 p[6], p[4], arm, arm, arm, p[2], p[7], p[0], p[1], p[1], p[1]);
        break;
    }
    case SCENE_BODY:
        snprintf(text, size,
                 "<body><joint type='ball'/>"
                 "<inertial pos='0 0 0' mass='1' diaginertia='%.17g %.17g %.17g'/></body>",
                 p[0], p[1], p[2]);
        break;
    }
}

static const char *version(void)
{
    return mj_versionString();
}

static void close_theirs(void *context)
{
    theirs *self = context;
    mj_deleteData(self->data);
    mj_deleteModel(self->model);
    free(self);
}

static void *open_theirs(const bench_scene *scene, int method, double setting)
{
    static const int integrators[METHODS] = {mjINT_EULER, mjINT_IMPLICITFAST, mjINT_RK4};
    static const int gravity_of[] = {
        [SCENE_PENDULUM] = 2, [SCENE_SPRING] = 3, [SCENE_CART_POLE] = 5, [SCENE_WHEEL] = 5};
    char bodies[1536], actuator[512] = "", text[4096], error[512] = "";
    double p[SCENE_PARAMETERS];
    const bool is_wheel = scene->form == SCENE_WHEEL;
    scene_parameters(scene, p);
    write_bodies(scene, p, bodies, sizeof bodies);
    if (is_wheel) {
        snprintf(actuator, sizeof actuator,
                 "<actuator><general joint='wheel' dyntype='%s' actdim='1' dynprm='%.17g' "
                 "gainprm='%.17g'/></actuator>",
                 method == RK4 ? "user" : "filterexact", p[INDUCTANCE] / p[RESISTANCE], p[TORQUE_CONSTANT]);
    }
    snprintf(text, sizeof text,
             "<mujoco><compiler angle='radian' autolimits='false'/>"
             "<option timestep='%.17g' gravity='0 0 %.17g'/><worldbody>%s</worldbody>%s</mujoco>",
             scene_span(scene) / setting, scene->form == SCENE_BODY ? 0 : -p[gravity_of[scene->form]], bodies,
             actuator);
    mju_user_warning = say_nothing;
    theirs *self = calloc(1, sizeof *self);
    mjSpec *spec = mj_parseXMLString(text, NULL, error, sizeof error);
    self->scene = scene;
    self->steps = (int)setting;
    self->model = spec != NULL ? mj_compile(spec, NULL) : NULL;
    if (self->model == NULL) {
        fprintf(stderr, "MuJoCo: %s\n", spec == NULL ? error : mjs_getError(spec));
        exit(1);
    }
    mj_deleteSpec(spec);
    int needed = mjDSBL_DAMPER;
    needed |= scene->form == SCENE_BODY ? 0 : mjDSBL_GRAVITY;
    needed |= scene->form == SCENE_SPRING ? mjDSBL_SPRING : 0;
    needed |= is_wheel ? mjDSBL_ACTUATION : 0;
    self->model->opt.disableflags = ((1 << mjNDISABLE) - 1) & ~needed;
    self->model->opt.enableflags = 0;
    self->model->opt.integrator = integrators[method];
    self->data = mj_makeData(self->model);
    mjcb_act_dyn = is_wheel && method == RK4 ? current_rate : NULL;
    mjcb_control = is_wheel && method != RK4 ? final_current : NULL;
    return self;
}

static inline bool advance(void *context, int span, double input)
{
    theirs *self = context;
    (void)span;
    if (self->scene->form == SCENE_WHEEL) {
        voltage = input;
    } else if (self->scene->is_held) {
        self->data->qfrc_applied[0] = input; /* the first joint has the input in all scenes */
    }
    for (int k = 0; k < self->steps; k++) {
        mj_step(self->model, self->data);
    }
    return true;
}

static inline void read(void *context, double *x)
{
    const theirs *self = context;
    const mjtNum *q = self->data->qpos, *v = self->data->qvel;
    if (self->scene->form == SCENE_SPRING) {
        const double c = cos(q[0]), s = sin(q[0]);
        x[0] = q[1] * c;
        x[1] = q[1] * s;
        x[2] = v[1] * c - q[1] * v[0] * s;
        x[3] = v[1] * s + q[1] * v[0] * c;
        return;
    }
    memcpy(x, q, sizeof *x * (size_t)self->model->nq);
    memcpy(x + self->model->nq, v, sizeof *x * (size_t)self->model->nv);
    if (self->model->na > 0) {
        x[4] = self->data->act[0];
    }
}

static bool run(void *context, const double *inputs, double *samples)
{
    theirs *self = context;
    const double *start = self->scene->start;
    running = self->scene;
    mj_resetData(self->model, self->data);
    memcpy(self->data->qpos, start, sizeof *start * (size_t)self->model->nq);
    if (self->scene->form == SCENE_SPRING) {
        self->data->qpos[0] = atan2(start[1], start[0]);
        self->data->qpos[1] = hypot(start[0], start[1]);
    } else {
        memcpy(self->data->qvel, start + self->model->nq, sizeof *start * (size_t)self->model->nv);
    }
    return peer_loop(self->scene, self, inputs, samples, advance, read);
}

const peer the_peer = {"MuJoCo", version, METHODS, methods, open_theirs, run, close_theirs};

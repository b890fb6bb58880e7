/*
 * MuJoCo's mj_step beside this library's plant, on the same cart-pole: the default parameters, gravity,
 * viscous friction, a force on the cart held over each step of 1 ms, from 2 rad at rest. Both in double.
 *   peer INTEGRATOR    one mj_step, with everything off that this scene does not need
 *   forced STEPPER     one step of ours
 * and the greatest difference of the two motions over 10 s with the classical Runge-Kutta method on both.
 *
 * A point mass has no inertia, but MuJoCo wants one: it gets 1e-14 kg m^2, 3e-13 of the pole's m l^2.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mujoco/mujoco.h>

#include "mctau/plant.h"
#include "measure.h"

#define INERTIA 1e-14
#define START   2.0 /* [rad] */
enum { COMPARED_STEPS = 10000, HOLD = 256 };

/* Newtons, a square wave of 1 N. */
static double force_at(long step)
{
    return (step / HOLD) % 2 == 0 ? 1 : -1;
}

static void fail(const char *why)
{
    fprintf(stderr, "benchmark: MuJoCo: %s\n", why);
    exit(1);
}

static double parameter(const mct_scene *scene, const char *name)
{
    const mct_system *system = mct_systems[scene->system];
    for (int i = 0; i < system->parameter_count; i++) {
        if (strcmp(system->parameters[i].name, name) == 0) {
            return scene->parameters[i];
        }
    }
    fail("the cart-pole has lost a parameter");
    return 0;
}

/* --- ours --- */

typedef struct {
    mct_plant start, plant;
} ours;

static void describe(mct_scene *scene)
{
    int system = 0;
    while (strcmp(mct_systems[system]->name, "cart_pole") != 0) {
        system++;
    }
    mct_scene_defaults(scene, system);
    scene->effects = MCT_GRAVITY | MCT_VISCOUS;
    scene->initial[mct_systems[system]->actuation->upright_coordinate] = START;
}

static void restart_ours(void *context)
{
    ours *self = context;
    self->plant = self->start;
}

static void run_ours(void *context, long count)
{
    ours *self = context;
    for (long k = 0; k < count; k++) {
        mct_plant_step(&self->plant, (mct_real)force_at(k));
    }
}

static void prepare_ours(ours *self, mct_scene *scene, int stepper)
{
    scene->stepper = stepper;
    if (mct_plant_init(&self->start, scene, NULL) != MCT_OK) {
        fail("our plant was not accepted");
    }
    restart_ours(self);
}

/* --- theirs --- */

typedef struct {
    mjModel *model;
    mjData *data;
} theirs;

static void restart_theirs(void *context)
{
    theirs *self = context;
    mj_resetData(self->model, self->data);
    self->data->qpos[1] = START;
}

static void run_theirs(void *context, long count)
{
    theirs *self = context;
    for (long k = 0; k < count; k++) {
        self->data->qfrc_applied[0] = force_at(k);
        mj_step(self->model, self->data);
    }
}

static void build_theirs(theirs *self, const mct_scene *scene)
{
    char xml[2048];
    char error[512] = "";
    snprintf(xml, sizeof xml,
             "<mujoco><compiler angle='radian' autolimits='false'/>"
             "<option timestep='%.17g' gravity='0 0 %.17g'/>"
             "<worldbody><body><joint type='slide' axis='1 0 0' damping='%.17g'/>"
             "<inertial pos='0 0 0' mass='%.17g' diaginertia='%g %g %g'/>"
             "<body><joint type='hinge' axis='0 1 0' damping='%.17g'/>"
             "<inertial pos='0 0 %.17g' mass='%.17g' diaginertia='%g %g %g'/>"
             "</body></body></worldbody></mujoco>",
             scene->dt, -parameter(scene, "gravity"), parameter(scene, "cart_friction"),
             parameter(scene, "cart_mass"), INERTIA, INERTIA, INERTIA, parameter(scene, "pole_friction"),
             parameter(scene, "pole_length"), parameter(scene, "pole_mass"), INERTIA, INERTIA, INERTIA);
    mjSpec *spec = mj_parseXMLString(xml, NULL, error, sizeof error);
    if (spec == NULL || (self->model = mj_compile(spec, NULL)) == NULL) {
        fail(spec == NULL ? error : mjs_getError(spec));
    }
    /* All but gravity and damping. */
    self->model->opt.disableflags = ((1 << mjNDISABLE) - 1) & ~(mjDSBL_GRAVITY | mjDSBL_DAMPER);
    self->model->opt.enableflags = 0;
    self->data = mj_makeData(self->model);
}

/* --- the same physics? --- */

static double largest_difference(ours *mine, theirs *other)
{
    double largest = 0;
    restart_ours(mine);
    restart_theirs(other);
    for (long k = 0; k < COMPARED_STEPS; k++) {
        mct_plant_step(&mine->plant, (mct_real)force_at(k));
        other->data->qfrc_applied[0] = force_at(k);
        mj_step(other->model, other->data);
        for (int i = 0; i < 2; i++) {
            largest = fmax(largest, fabs(mct_plant_value(&mine->plant, i) - other->data->qpos[i]));
            largest = fmax(largest, fabs(mct_plant_value(&mine->plant, 2 + i) - other->data->qvel[i]));
        }
    }
    return largest;
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        int integrator;
    } integrators[] = {
        {"peer Euler", mjINT_EULER}, {"peer implicitfast", mjINT_IMPLICITFAST}, {"peer RK4", mjINT_RK4}};
    const measure_effort effort = measure_effort_of(argc, argv);
    mct_scene scene;
    ours mine;
    theirs other;
    describe(&scene);
    build_theirs(&other, &scene);
    prepare_ours(&mine, &scene, MCT_STEPPER_RK4);
    other.model->opt.integrator = mjINT_RK4;
    printf("version %s\n", mj_versionString());
    printf("difference %.3g\n", largest_difference(&mine, &other));
    for (size_t i = 0; i < sizeof integrators / sizeof integrators[0]; i++) {
        other.model->opt.integrator = integrators[i].integrator;
        measure(&effort, integrators[i].name, run_theirs, restart_theirs, &other, 0);
    }
    for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
        char name[64];
        if (mct_systems[scene.system]->kernel(stepper, scene.effects) != NULL) {
            prepare_ours(&mine, &scene, stepper);
            snprintf(name, sizeof name, "forced %s", mct_steppers[stepper].name);
            measure(&effort, name, run_ours, restart_ours, &mine, 0);
        }
    }
    mj_deleteData(other.data);
    mj_deleteModel(other.model);
    return 0;
}

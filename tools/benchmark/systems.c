/*
 * What each system costs, in the precision of the library that this is linked with, from its default scene:
 *   kernel SYSTEM STEPPER   one step of a kernel
 *   plant SYSTEM STEPPER    the same with what a tick adds: bounds of the input, checks of the state, turns
 *   evaluate SYSTEM         M, C, tau and all that follows
 * and, when instructions are counted, of a system whose particles or coordinates are listed, with N of them
 *   particles SYSTEM step N, coordinates SYSTEM step N           a plant step
 *   particles SYSTEM evaluate N, coordinates SYSTEM evaluate N
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mctau/plant.h"
#include "measure.h"

enum { INPUTS = 64, LIVELY_STEPS = 100 };

typedef struct {
    mct_plant start, plant;
    mct_real inputs[INPUTS]; /* held for a step each, and never the same for long: nothing comes to rest */
    mct_evaluation evaluation;
} stepping;

static void restart(void *context)
{
    stepping *self = context;
    self->plant = self->start;
}

static void run_kernel(void *context, long count)
{
    stepping *self = context;
    for (long k = 0; k < count; k++) {
        self->plant.kernel(&self->plant.constants, &self->plant.state, self->inputs[k % INPUTS], 1);
    }
}

static void run_plant(void *context, long count)
{
    stepping *self = context;
    for (long k = 0; k < count; k++) {
        mct_plant_step(&self->plant, self->inputs[k % INPUTS]);
    }
}

static void run_evaluate(void *context, long count)
{
    stepping *self = context;
    for (long k = 0; k < count; k++) {
        self->plant.input = self->inputs[k % INPUTS];
        mct_plant_evaluate(&self->plant, &self->evaluation);
    }
}

/* The scene's plant in `start`; false where the scene is refused. */
static bool prepare(stepping *self, const mct_scene *scene)
{
    for (int i = 0; i < INPUTS; i++) {
        self->inputs[i] = (mct_real)((i * 37) % INPUTS - (INPUTS - 1) / 2.0) / 16;
    }
    const bool suits = mct_plant_init(&self->start, scene, NULL) == MCT_OK;
    restart(self);
    return suits;
}

static void measure_piece(const measure_effort *effort, const char *name, measure_work work, stepping *self)
{
    measure(effort, name, work, restart, self, 0);
    if (self->plant.diverged_ticks != 0) {
        fprintf(stderr, "benchmark: %s: diverged\n", name);
        exit(1);
    }
}

static void measure_steps(const measure_effort *effort, int system, int stepper)
{
    stepping self;
    mct_scene scene;
    char name[64];
    mct_scene_defaults(&scene, system);
    const mct_system *model = mct_systems[system];
    const double *p = scene.parameters;
    const mct_actuation *actuation = model->actuation;
    const double rate =
        actuation != NULL ? p[actuation->resistance_parameter] / p[actuation->inductance_parameter] : 0;
    const double limit = mct_steppers[stepper].motor_stability_limit;
    scene.stepper = stepper;
    if (actuation != NULL) {
        scene.initial[actuation->upright_coordinate] = 2;
    }
    while ((scene.effects & MCT_MOTOR_INDUCTIVE) && limit > 0 && scene.dt * rate > 0.9 * limit) {
        scene.dt /= 2; /* the cost of a step does not depend on its length */
    }
    if (!prepare(&self, &scene)) {
        return;
    }
    snprintf(name, sizeof name, "kernel %s %s", model->name, mct_steppers[stepper].name);
    measure_piece(effort, name, run_kernel, &self);
    snprintf(name, sizeof name, "plant %s %s", model->name, mct_steppers[stepper].name);
    measure_piece(effort, name, run_plant, &self);
}

/* In motion: at rest some branches are shorter. */
static void measure_evaluate(const measure_effort *effort, const mct_scene *scene, const char *name)
{
    stepping self;
    if (mct_systems[scene->system]->evaluate == NULL || !prepare(&self, scene)) {
        return;
    }
    run_plant(&self, LIVELY_STEPS);
    self.start = self.plant;
    measure_piece(effort, name, run_evaluate, &self);
}

/* `count` rows of the first list, no two alike: the standard ones over and over, a little different each time. */
static void list_rows(mct_scene *scene, int count)
{
    const mct_row_list *list = &mct_systems[scene->system]->lists[0];
    mct_list *rows = &scene->lists[0];
    rows->count = count * list->column_count;
    for (int i = 0; i < rows->count; i++) {
        const int k = i / list->column_count;
        const mct_field *column = &list->columns[i % list->column_count];
        const double value = list->standard_rows > 0
                                 ? list->standard[i % (list->standard_rows * list->column_count)]
                                 : column->standard;
        const double changed = value * (1 + 0.03 * k) + 0.01 * ((7 * i) % 5);
        const bool is_number = column->kind == MCT_FIELD_REAL && changed <= column->maximum;
        rows->values[i] = is_number ? changed : value;
    }
}

static void count_rows(const measure_effort *effort, int system)
{
    const mct_system *model = mct_systems[system];
    if (!effort->count || !(model->lists_particles || model->lists_coordinates)) {
        return;
    }
    const char *listed = model->lists_coordinates ? "coordinates" : "particles";
    for (int rows = 1; rows <= model->lists[0].most_rows; rows *= 2) {
        stepping self;
        mct_scene scene;
        char name[64];
        mct_scene_defaults(&scene, system);
        list_rows(&scene, rows);
        if (rows < model->lists[0].fewest_rows || !prepare(&self, &scene)) {
            continue; /* too few: a body of one particle has no inertia */
        }
        snprintf(name, sizeof name, "%s %s step %d", listed, model->name, rows);
        measure_piece(effort, name, run_plant, &self);
        snprintf(name, sizeof name, "%s %s evaluate %d", listed, model->name, rows);
        measure_evaluate(effort, &scene, name);
    }
}

int main(int argc, char **argv)
{
    const measure_effort effort = measure_effort_of(argc, argv);
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        mct_scene scene;
        char name[64];
        for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
            measure_steps(&effort, system, stepper);
        }
        mct_scene_defaults(&scene, system);
        snprintf(name, sizeof name, "evaluate %s", mct_systems[system]->name);
        measure_evaluate(&effort, &scene, name);
        count_rows(&effort, system);
    }
    return 0;
}

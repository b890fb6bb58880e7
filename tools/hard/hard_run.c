#include "hard_run.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Drops "origin:line: ": the text is the case's own. */
static void drop_origin(mct_message *why)
{
    const char *rest = strstr(why->text, ": ");
    if (rest != NULL) {
        memmove(why->text, rest + 2, strlen(rest + 2) + 1);
    }
}

bool hard_start(hard_run *self, const hard_trial *trial, const char *more, hard_result *result)
{
    char text[4096], assignment[64];
    const bool has_stepper = trial->method < MCT_STEPPER_COUNT;
    mct_override stepper = {assignment, "--stepper"};
    self->result = result;
    snprintf(text, sizeof text, "%s%s", more != NULL ? more : "",
             trial->about->scene != NULL ? trial->about->scene : "");
    snprintf(assignment, sizeof assignment, "scene.stepper=%s",
             has_stepper ? mct_steppers[trial->method].name : "");
    mct_status status = mct_scene_read(text, strlen(text), "scene", &stepper, has_stepper ? 1 : 0,
                                       &self->scene, &result->why);
    result->stepper = status == MCT_OK ? self->scene.stepper : -1;
    if (status != MCT_OK) {
        drop_origin(&result->why);
    } else {
        status = mct_plant_init(&self->plant, &self->scene, &result->why);
    }
    result->is_refused = status != MCT_OK;
    return !result->is_refused;
}

bool hard_advance(hard_run *self, double input, uint64_t ticks)
{
    for (uint64_t i = 0; i < ticks && self->plant.diverged_ticks == 0; i++) {
        mct_plant_step(&self->plant, (mct_real)input);
    }
    if (self->plant.diverged_ticks > 0) {
        hard_error(self->result, (double)INFINITY);
    }
    return self->plant.diverged_ticks == 0;
}

uint64_t hard_ticks(const hard_run *self, const hard_trial *trial)
{
    return (uint64_t)(trial->seconds / self->scene.dt + 0.5);
}

double hard_value(const hard_run *self, int state)
{
    return mct_plant_value(&self->plant, state);
}

double hard_energy(const hard_run *self)
{
    mct_evaluation now;
    mct_plant_evaluate(&self->plant, &now);
    return (double)now.kinetic_energy + (double)now.potential_energy + (double)now.magnetic_energy;
}

/*
 * What each effect of each system costs: a step of the kernel for the effects that a scene has when it does not say, with
 * one of them or another one on, and off. Names: SYSTEM STEPPER EFFECT with, SYSTEM STEPPER EFFECT without, and for the
 * defaults themselves SYSTEM STEPPER defaults with. Also prints the flash of each on a Cortex-M4F: flash/NAME/... BYTES.
 */
#include <stdio.h>
#include <stdlib.h>

#include "mctau/effects.h"
#include "mctau/plant.h"
#include "measure.h"
#include "tools/mctau/kernel_bytes.h"

enum { INPUTS = 64 };

/* What a coefficient gets that is 0 by default, as those of friction and drag are. */
#define SOME 1e-5

typedef struct {
    mct_plant plant;
    mct_state state;
    mct_real inputs[INPUTS]; /* held for a step each */
} stepping;

static void restart(void *context)
{
    stepping *self = context;
    self->state = self->plant.state;
}

static void run(void *context, long count)
{
    stepping *self = context;
    for (long k = 0; k < count; k++) {
        self->plant.kernel(&self->plant.constants, &self->state, self->inputs[k % INPUTS], 1);
    }
}

static void measure_kernel(const measure_effort *effort, int system, int stepper, uint32_t effects,
                           const char *name)
{
    static stepping self;
    mct_scene scene;
    const mct_system *const model = mct_systems[system];
    char label[128];
    mct_scene_defaults(&scene, system);
    scene.stepper = stepper;
    scene.effects = effects;
    scene.dt =
        1e-4; /* the cost of a step does not depend on its length; rk4 follows any motor's current here */
    for (int i = 0; i < model->parameter_count; i++) {
        if (model->parameters[i].effects != 0 && scene.parameters[i] == 0) {
            scene.parameters[i] = SOME;
        }
    }
    const int rate = mct_rate_index(model);
    for (int i = 0; i < model->coordinate_count && !model->is_process; i++) {
        scene.initial[rate + i] += 2; /* it slides against dry friction, as it does mostly */
    }
    for (int i = 0; i < INPUTS; i++) {
        self.inputs[i] = (mct_real)((i * 37) % INPUTS - (INPUTS - 1) / 2.0) / 16;
    }
    if (mct_plant_init(&self.plant, &scene, NULL) != MCT_OK) {
        return;
    }
    snprintf(label, sizeof label, "%s %s %s", model->name, mct_steppers[stepper].name, name);
    measure(effort, label, run, restart, &self, 0);
    for (char *letter = label; *letter != '\0'; letter++) {
        *letter = *letter == ' ' ? '/' : *letter;
    }
    printf("flash/%s %d\n", label, mct_kernel_bytes(system, stepper, effects));
}

/* Those of the effects among `bits` that the system has. */
static void measure_system(const measure_effort *effort, int system, int stepper, uint32_t among)
{
    const mct_system *const model = mct_systems[system];
    const uint32_t standard = model->standard_effects & MCT_KERNEL_EFFECTS;
    measure_kernel(effort, system, stepper, standard, "defaults with");
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        const mct_effect *const effect = &mct_effects[i];
        for (int choice = 1; choice < 3; choice++) {
            const uint32_t bits = effect->bits[choice] & among;
            char name[64];
            if (bits == 0 || (bits & ~model->effects) != 0) {
                continue;
            }
            const char *const kind = effect->choices != NULL ? effect->choices[choice] : "on";
            snprintf(name, sizeof name, "%s=%s with", effect->name, kind);
            measure_kernel(effort, system, stepper, (standard & ~effect->mask) | bits, name);
            snprintf(name, sizeof name, "%s=%s without", effect->name, kind);
            measure_kernel(effort, system, stepper, standard & ~effect->mask, name);
        }
    }
}

int main(int argc, char **argv)
{
    const measure_effort effort = measure_effort_of(argc, argv);
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        const uint32_t standard = mct_systems[system]->standard_effects & MCT_KERNEL_EFFECTS;
        static const int typical[] = {MCT_STEPPER_RK4, MCT_STEPPER_EXPO};
        for (size_t i = 0; i < sizeof typical / sizeof *typical; i++) {
            if (mct_systems[system]->kernel(typical[i], standard) != NULL) {
                measure_system(&effort, system, typical[i], MCT_KERNEL_EFFECTS);
            }
        }
        if (mct_systems[system]->kernel(MCT_STEPPER_TAYLOR6, MCT_COULOMB_EXACT) != NULL) {
            measure_system(&effort, system, MCT_STEPPER_TAYLOR6, MCT_COULOMB_EXACT);
        }
    }
    return 0;
}

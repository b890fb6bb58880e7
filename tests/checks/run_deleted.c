/*
 * Runs kernels of the library beside those of a source from which the effects that they lack were deleted, from the same
 * start, for measure.h. Fails where two do not move alike, to the bit. deleted_kernels.h, which the test writes, lists
 * CASES: KERNEL(system, stepper, effects, the kernel's name).
 */
#include <stdio.h>
#include <string.h>

#include "mctau/plant.h"
#include "tools/benchmark/measure.h"

#define KERNEL(system, stepper, effects, name) \
    void name(const void *constants, mct_state *state, mct_real input, int32_t steps);
#include "deleted_kernels.h"
CASES
#undef KERNEL

typedef struct {
    mct_plant start;
    mct_state state;
    mct_kernel kernel;
} running;

static void restart(void *context)
{
    running *self = context;
    self->state = self->start.state;
}

static void run(void *context, long steps)
{
    running *self = context;
    self->kernel(&self->start.constants, &self->state, MCT_R(0.25), (int32_t)steps);
}

int main(int argc, char **argv)
{
    static const struct {
        const char *system;
        int stepper;
        uint32_t effects;
        const char *name;
        mct_kernel deleted;
    } cases[] = {
#define KERNEL(system, stepper, effects, name) {system, stepper, effects, #name, name},
        CASES};
    const measure_effort effort = measure_effort_of(argc, argv);
    static running self;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mct_scene scene;
        mct_message why = {""};
        int system = 0;
        while (strcmp(mct_systems[system]->name, cases[i].system) != 0) {
            system++;
        }
        mct_scene_defaults(&scene, system);
        scene.stepper = cases[i].stepper;
        scene.effects = cases[i].effects;
        scene.dt = 1e-4; /* rk4 follows the cart's motor up to 2e-4 */
        if (mct_plant_init(&self.start, &scene, &why) != MCT_OK) {
            fprintf(stderr, "%s: %s\n", cases[i].name, why.text);
            return 1;
        }
        const mct_kernel both[2] = {self.start.kernel, cases[i].deleted};
        mct_state end[2];
        for (int which = 0; which < 2; which++) {
            char label[128];
            snprintf(label, sizeof label, "%s %s", which == 0 ? "library" : "deleted", cases[i].name);
            self.kernel = both[which];
            measure(&effort, label, run, restart, &self, 0);
            restart(&self);
            run(&self, 1000);
            end[which] = self.state;
        }
        const size_t size = (size_t)self.start.entries * sizeof(mct_real);
        if (memcmp(end[0].x, end[1].x, size) != 0 || memcmp(end[0].c, end[1].c, size) != 0) {
            fprintf(stderr, "%s: the two do not move alike\n", cases[i].name);
            return 1;
        }
    }
    return 0;
}

/*
 * The two central systems over 10 s at 1 kHz, in the precision of the library that this is linked with: by every stepper,
 * one step a tick
 *   error SCENE STEPPER VALUE   the largest, as in tools/bench --peers; "nan" where it is 1 or more; "refused"
 *   ns SCENE STEPPER TIMES      a kernel's call
 * Scenes are those of scenes.h, with _ for a space.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mctau_scene.h"
#include "measure.h"
#include "samples.h"

static const char *const central[] = {"cart_pole free",    "wheel 5 ms held",  "wheel 1 ms held",
                                      "wheel 0.1 ms held", "wheel 10 us held", "wheel 0 held"};

typedef struct {
    mct_plant start, plant;
    const double *inputs;
    int tick;
} running;

static void restart(void *context)
{
    running *self = context;
    self->plant = self->start;
    self->tick = 0;
}

/* Over and over from the start. */
static void run(void *context, long count)
{
    running *self = context;
    for (long k = 0; k < count; k++) {
        if (self->tick == SCENE_TICKS) {
            restart(self);
        }
        mct_plant *plant = &self->plant;
        plant->kernel(&plant->constants, &plant->state, (mct_real)self->inputs[self->tick++], 1);
    }
}

static double error_of(running *self, const bench_scene *scene, const double *reference)
{
    double samples[SCENE_SAMPLES * SCENE_STATES];
    restart(self);
    for (int i = 0; i < SCENE_SAMPLES; i++) {
        run(self, SCENE_TICKS_PER_SAMPLE);
        mctau_read(scene, &self->plant, samples + i * scene->states);
    }
    return samples_error(scene, reference, samples);
}

static void measure_scene(const measure_effort *effort, const char *file, const bench_scene *scene)
{
    double reference[SCENE_SAMPLES * SCENE_STATES];
    char name[64];
    mct_scene described;
    snprintf(name, sizeof name, "%s", scene->name);
    for (char *c = name; *c != '\0'; c++) {
        *c = *c == ' ' ? '_' : *c;
    }
    samples_read(file, scene, reference);
    if (!mctau_scene_of(scene, &described)) {
        fprintf(stderr, "benchmark: %s: this library has lost a name of it\n", scene->name);
        exit(1);
    }
    described.dt = SCENE_TICK;
    for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
        running self = {.inputs = scene_inputs(scene)};
        described.stepper = stepper;
        if (mct_systems[described.system]->kernel(stepper, mct_scene_effects(&described)) == NULL) {
            continue; /* not for this system */
        }
        if (mct_scene_check(&described, NULL) != MCT_OK ||
            mct_plant_init(&self.start, &described, NULL) != MCT_OK) {
            printf("error %s %s refused\n", name, mct_steppers[stepper].name);
            continue;
        }
        const double error = error_of(&self, scene, reference);
        printf("error %s %s %.3g\n", name, mct_steppers[stepper].name, error);
        if (error == error) {
            char both[128];
            snprintf(both, sizeof both, "%s %s", name, mct_steppers[stepper].name);
            measure(effort, both, run, restart, &self, 0);
        }
    }
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        fprintf(stderr, "usage: %s REFERENCES [--samples N] [--sample-us N]\n", argv[0]);
        return 2;
    }
    const measure_effort effort = measure_effort_of(argc - 1, argv + 1);
    for (size_t i = 0; i < sizeof central / sizeof central[0]; i++) {
        measure_scene(&effort, argv[1], scene_by_name(central[i]));
    }
    return 0;
}

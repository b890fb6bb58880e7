/* This library, in the precision that it is linked with: a kernel for each span, by every stepper that suits. */
#include "peers.h"

#include <stdlib.h>

#include "mctau_scene.h"

typedef struct {
    const bench_scene *scene;
    mct_plant start, plant;
} ours;

static peer_method methods[MCT_STEPPER_COUNT];

static const char *version(void)
{
    return MCT_VERSION;
}

static void *open_ours(const bench_scene *scene, int method, double setting)
{
    ours *self = malloc(sizeof *self);
    mct_scene described;
    self->scene = scene;
    bool suits = mctau_scene_of(scene, &described);
    described.stepper = method;
    described.substeps = (int32_t)setting;
    suits = suits && mct_systems[described.system]->kernel(method, described.effects) != NULL &&
            mct_plant_init(&self->start, &described, NULL) == MCT_OK;
    if (!suits) {
        free(self);
        return NULL;
    }
    return self;
}

static inline bool advance(void *context, int span, double input)
{
    mct_plant *plant = &((ours *)context)->plant;
    (void)span;
    plant->kernel(&plant->constants, &plant->state, (mct_real)input, plant->substeps);
    return true;
}

static inline void read(void *context, double *x)
{
    const ours *self = context;
    mctau_read(self->scene, &self->plant, x);
}

static bool run(void *context, const double *inputs, double *samples)
{
    ours *self = context;
    self->plant = self->start;
    return peer_loop(self->scene, self, inputs, samples, advance, read);
}

__attribute__((constructor)) static void name_methods(void)
{
    for (int i = 0; i < MCT_STEPPER_COUNT; i++) {
        methods[i] = (peer_method){mct_steppers[i].name, true};
    }
}

const peer the_peer = {
    MCT_REAL_IS_FLOAT ? "mctau float" : "mctau", version, MCT_STEPPER_COUNT, methods, open_ours, run, free};

#include "wheel_reference.h"

#include "mctau_scene.h"
#include "support/reference.h"

bool wheel_reference(const bench_scene *scene, int steps, double *samples)
{
    static reference_flow flow;
    const double *inputs = scene_inputs(scene);
    mct_scene described;
    quad x[REFERENCE_STATES];
    if (!mctau_scene_of(scene, &described)) {
        return false;
    }
    const reference_model model = reference_of(&described);
    const double time_constant = scene->parameters[11].value / scene->parameters[10].value;
    const bool is_stiff = time_constant > 0;
    if (is_stiff && reference_flow_prepare(&flow, &model, SCENE_TICK, 2 * time_constant, SCENE_TICK) == 0) {
        return false;
    }
    reference_start(&model, scene->start, x);
    for (int tick = 0; tick < SCENE_TICKS; tick++) {
        if (is_stiff) {
            reference_flow_advance(&flow, x, inputs[tick]);
        } else {
            reference_extrapolate(&model, x, inputs[tick], (quad)SCENE_TICK, steps);
        }
        for (int i = 0; (tick + 1) % SCENE_TICKS_PER_SAMPLE == 0 && i < scene->states; i++) {
            samples[tick / SCENE_TICKS_PER_SAMPLE * SCENE_STATES + i] = (double)x[i];
        }
    }
    return true;
}

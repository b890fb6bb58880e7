#include "mctau/input.h"

#include <string.h>

#include "mctau/sincos.h"

void mct_input_init(mct_input *input, const mct_scene *scene, mct_samples samples)
{
    memset(input, 0, sizeof *input);
    input->kind = scene->input;
    input->value = (mct_real)scene->input_value;
    input->amplitude = (mct_real)scene->input_amplitude;
    input->phase_per_tick = scene->input_frequency * scene->dt;
    input->samples = samples;
    input->step_count = scene->input_times.count;
    for (int i = 0; i < input->step_count; i++) {
        const double ticks = scene->input_times.values[i] / scene->dt;
        const uint64_t whole = (uint64_t)ticks;
        const bool is_whole = ticks - (double)whole < 1e-6;
        input->step_ticks[i] = is_whole ? whole : whole + 1;
        input->step_values[i] = (mct_real)scene->input_values.values[i];
    }
}

mct_real mct_input_at(const mct_input *input, uint64_t tick)
{
    switch (input->kind) {
    case MCT_INPUT_CONSTANT:
        return input->value;
    case MCT_INPUT_SINE: {
        double s, c;
        mct_sincos_f64((double)tick * input->phase_per_tick, &s, &c);
        return input->value + input->amplitude * (mct_real)s;
    }
    case MCT_INPUT_STEPS: {
        mct_real value = 0;
        for (int i = 0; i < input->step_count && input->step_ticks[i] <= tick; i++) {
            value = input->step_values[i];
        }
        return value;
    }
    case MCT_INPUT_CSV: {
        const size_t count = input->samples.count;
        return count == 0 ? 0 : (mct_real)input->samples.values[tick < count ? (size_t)tick : count - 1];
    }
    default:
        return 0;
    }
}

#include "mctau/input.h"

#include <string.h>

#include "mctau/sincos.h"

#define TURN 6.283185307179586476925

/* Fraction of a turn, in parts of 2^-64. */
static uint64_t fraction_of(double turns)
{
    const double fraction = turns - (double)(int64_t)turns;
    return (uint64_t)(int64_t)(fraction * 0x1p62) << 2; /* which a double has not more digits for, but below 2^-10 */
}

void mct_input_init(mct_input *input, const mct_scene *scene, mct_samples samples)
{
    memset(input, 0, sizeof *input);
    input->kind = scene->input;
    input->value = (mct_real)scene->input_value;
    input->amplitude = (mct_real)scene->input_amplitude;
    input->phase_per_tick = fraction_of(scene->input_frequency * scene->dt / TURN);
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
        /* By 32 bits each: a conversion of 64 goes through double where there is none in hardware. */
        const uint64_t phase = tick * input->phase_per_tick;
        const mct_real high = (mct_real)(int32_t)(phase >> 32);
        const mct_real low = (mct_real)(uint32_t)phase;
        mct_real s, c;
        mct_sincos(high * MCT_R(TURN * 0x1p-32) + low * MCT_R(TURN * 0x1p-64), &s, &c);
        return input->value + input->amplitude * s;
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
        return count == 0 ? 0 : input->samples.values[tick < count ? (size_t)tick : count - 1];
    }
    default:
        return 0;
    }
}

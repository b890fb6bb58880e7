#include "support/energy.h"

double energy_rate(const mct_evaluation *at)
{
    double sum = (double)at->power_input + (double)at->power_resistance + (double)at->power_conversion +
                 (double)at->power_frame;
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        sum += (mct_effects[i].mask & (MCT_POTENTIAL | MCT_MOTOR)) ? 0 : (double)at->power[i];
    }
    return sum;
}

/**
 * @file step.h
 * The length of a step in the core's precision.
 */
#ifndef MCTAU_STEP_H
#define MCTAU_STEP_H

#include "mctau/real.h"

typedef struct {
    mct_real h;    /**< nearest to the step asked for [s] */
    mct_real half; /**< h / 2 [s] */
    /** What rounding has left out, relative to h: float's 1e-3 is off by 5e-8, 4 ms a day. */
    mct_real remainder;
} mct_step;

/** The step of `h` seconds; h above 0. */
static inline mct_step mct_step_of(double h)
{
    const mct_real nearest = (mct_real)h;
    return (mct_step){nearest, (mct_real)(0.5 * h), (mct_real)((h - (double)nearest) / h)};
}

#endif

/**
 * @file step.h
 * The length of a step in the core's precision.
 */
#ifndef MCTAU_STEP_H
#define MCTAU_STEP_H

#include "mctau/real.h"

/**
 * What rounding leaves out of a step is kept relative to it: float's 1e-3 is off by 5e-8, 4 ms a day, unless
 * each increment is corrected by it.
 */
typedef struct {
    mct_real h;               /**< nearest to the step asked for [s] */
    mct_real half;            /**< h / 2 [s] */
    mct_real sixth;           /**< h / 6 [s] */
    mct_real remainder;       /**< (step - h) / step, of a scheme that multiplies by h */
    mct_real sixth_remainder; /**< (step - 6 sixth) / step, of one that multiplies by sixth */
} mct_step;

/** The step of `h` seconds; h above 0. */
static inline mct_step mct_step_of(double h)
{
    mct_step step;
    step.h = (mct_real)h;
    step.half = (mct_real)(0.5 * h);
    step.sixth = (mct_real)(h / 6);
    step.remainder = (mct_real)((h - (double)step.h) / h);
    step.sixth_remainder = (mct_real)((h - 6 * (double)step.sixth) / h);
    return step;
}

#endif

/* Hard cases of dry friction. */
#include <float.h>
#include <math.h>

#include "hard_run.h"

#define TICK 1e-3

/* --- what holds, holds --- */

/* On a slope of 0.5 rad with a coefficient of 0.6, above tan(0.5) = 0.55: the way that it slides [m]. */
static void run_hold(const hard_trial *trial, hard_result *result)
{
    double x = 0, v = 0;
    hard_run run;
    if (trial->method != HARD_NAIVE && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (uint64_t tick = 0; tick < (uint64_t)(trial->seconds / TICK + 0.5); tick++) {
        if (trial->method == HARD_NAIVE) {
            const double sign = (v > 0) - (v < 0);
            v -= TICK * 9.81 * (sin(0.5) + 0.6 * cos(0.5) * sign);
            x += TICK * v;
        } else if (hard_advance(&run, 0, 1)) {
            x = hard_value(&run, 0);
        } else {
            return;
        }
        hard_error(result, x);
    }
}

/* --- stick and slip --- */

/*
 * A block of 1 kg at a spring of 100 N/m, on a belt of 0.1 m/s, held by up to 6 N and braked by 4 N:
 * T = (2 pi - 2 atan(D w / b)) / w + 2 D / b with D = (6 - 4) / 100 m. Carried, it passes 40 mm at the belt's speed.
 */
static void run_belt(const hard_trial *trial, hard_result *result)
{
    const double D = 0.02, w = 10, belt = 0.1, middle = 0.04;
    const double period = (2 * acos(-1) - 2 * atan(D * w / belt)) / w + 2 * D / belt;
    double x = 0, v = belt, before = 0, first = 0, last = 0;
    int cycles = 0;
    hard_run run;
    if (trial->method != HARD_NAIVE && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (uint64_t tick = 1; tick <= (uint64_t)(trial->seconds / TICK + 0.5); tick++) {
        if (trial->method == HARD_NAIVE) { /* by the sign of the slip, static friction below 1 mm/s */
            const double slip = v - belt, limit = fabs(slip) < 1e-3 ? 6 : 4;
            v += TICK * (-100 * x - limit * ((slip > 0) - (slip < 0)));
            x += TICK * v;
        } else if (hard_advance(&run, 0, 1)) {
            x = hard_value(&run, 0);
        } else {
            return;
        }
        if (before < middle && x >= middle) {
            last = (double)tick * TICK - (x - middle) / belt;
            first = cycles == 0 ? last : first;
            cycles++;
        }
        before = x;
    }
    hard_error(result, cycles > 1 ? (last - first) / (cycles - 1) / period - 1 : (double)INFINITY);
}

const hard_case hard_friction[] = {
    {.number = 26,
     .rule = "a block that friction holds on a slope does not move in a million steps",
     .naive = "friction by the sign of the velocity: each step undoes a bit less than gravity did",
     .remedy = "an impulse that stops the block or what it can of that; at rest, nothing is added",
     .measure = "largest way, in m",
     .scene = "scene.system = \"block\"\nparameters.slope = 0.5\nparameters.static_coefficient = 0.6\n"
              "parameters.dynamic_coefficient = 0.6\nparameters.gravity = 9.81\n",
     .seconds = 1000,
     .criterion = DBL_MIN,
     .criterion_f32 = DBL_MIN,
     .run = run_hold},
    {.number = 27,
     .rule = "a block that sticks and slips on a belt keeps its period",
     .naive = "friction by the sign of the slip",
     .remedy = "exact friction: each start and stop is found within its step, on the exact flow",
     .measure = "relative error of the period over 200 s",
     .scene = "scene.system = \"block\"\neffects.coulomb = \"exact\"\neffects.spring = true\n"
              "parameters.mass = 1\nparameters.spring = 100\nparameters.gravity = 10\n"
              "parameters.static_coefficient = 0.6\nparameters.dynamic_coefficient = 0.4\n"
              "parameters.belt_speed = 0.1\ninitial.velocity = 0.1\n",
     .seconds = 200,
     .criterion = 1e-14,
     .criterion_f32 = 1e-6,
     .run = run_belt},
    {.rule = NULL},
};

/* Runs of the whole loop with the sim HAL, judged by the true state of the plant. */
#ifndef MCT_TEST_SWING_UP_H
#define MCT_TEST_SWING_UP_H

#include "hal/sim/sim.h"
#include "mctau/loop.h"

typedef struct {
    double upright_time;  /* from here on within 2 degrees until the end [s]; infinite when not */
    double reached_time;  /* first time within 2 degrees [s] */
    double deviation;     /* largest angle from upright after `settled` [rad] */
    double wheel_rate;    /* at the end [rad/s] */
    double cart_position; /* at the end [m] */
    double farthest;      /* largest way of a cart from the middle [m] */
    uint32_t faults;
} swing_up;

/* The default scene of a system, as scenes/ has it. */
mct_scene swing_up_scene(int system);

/* Runs a scene for a duration; deviations count from `settled` seconds on. */
swing_up run_swing_up(const mct_scene *scene, double duration, double settled);

/*
 * 500 variations: seeded parameters within 10 %, known to the controller or not, noise of 1 count, a tick of
 * latency. At least 99 % must be upright within 20 s, within 2 degrees until 40 s, with wheel or cart near
 * home, without a fault.
 */
void check_variations(int system, bool known);

#endif

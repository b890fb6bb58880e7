/* Hard cases of numbers: time, inverse kinematics, denormals, inputs that are none. */
#include <math.h>
#include <string.h>

#include "hal/sim/sim.h"
#include "hard_run.h"
#include "mctau/compensated.h"
#include "mctau/input.h"
#include "mctau/least_squares.h"
#include "mctau/observer.h"
#include "mctau/supervisor.h"

#define MS MCT_R(1e-3)

static long steps_of(const hard_trial *trial)
{
    return (long)(trial->seconds * 1000 + 0.5);
}

static void read_scene(const char *text, mct_scene *scene)
{
    (void)mct_scene_read(text, strlen(text), "scene", NULL, 0, scene, NULL);
}

/* Largest difference of two plants' states. */
static double distance(const mct_plant *a, const mct_plant *b)
{
    double worst = 0;
    for (int i = 0; i < a->states; i++) {
        worst = fmax(worst, fabs((double)(a->state.x[i] - b->state.x[i])));
    }
    return worst;
}

/* --- time --- */

#define DAY 86400

/* 15: at which time a step of the input comes that was asked for after a day. */
static void run_clock(const hard_trial *trial, hard_result *result)
{
    const uint64_t due = (uint64_t)DAY * 1000;
    if (trial->method == HARD_NAIVE) {
        mct_real time = 0;
        for (uint64_t tick = 0; tick < due; tick++) {
            time += MS;
        }
        hard_error(result, (double)time - DAY);
        return;
    }
    mct_scene scene;
    mct_input input;
    read_scene("scene.system = \"block\"\ninput.kind = \"steps\"\ninput.times = [86400]\ninput.values = [1]\n",
               &scene);
    mct_input_init(&input, &scene, (mct_samples){NULL, 0});
    uint64_t tick = due - 1000;
    while (tick < due + 1000 && mct_input_at(&input, tick) == 0) {
        tick++;
    }
    hard_error(result, (double)tick * scene.dt - DAY);
}

/* 16: what turns at 1 rad/s is a clock. */
static void run_pace(const hard_trial *trial, hard_result *result)
{
    hard_run run;
    double angle = 0;
    if (trial->method == HARD_NAIVE) {
        for (long step = steps_of(trial); step > 0; step--) {
            angle += (double)1e-3F;
        }
    } else if (hard_start(&run, trial, NULL, result) && hard_advance(&run, 0, hard_ticks(&run, trial))) {
        angle = hard_value(&run, 0);
    } else {
        return;
    }
    hard_error(result, (angle - trial->seconds) * DAY / trial->seconds);
}

/* 41: a sine of 50 Hz after a day, over 2 s. */
static void run_sine(const hard_trial *trial, hard_result *result)
{
    const uint64_t first = (uint64_t)(trial->seconds * 1000);
    const long double turn = 6.283185307179586476925286766559L;
    mct_scene scene;
    mct_input input;
    mct_real time = 0;
    read_scene("scene.system = \"block\"\ninput.kind = \"sine\"\ninput.amplitude = 1\n"
               "input.frequency = 314.1592653589793\n",
               &scene);
    mct_input_init(&input, &scene, (mct_samples){NULL, 0});
    for (uint64_t tick = 0; trial->method == HARD_NAIVE && tick < first; tick++) {
        time += MS;
    }
    for (uint64_t tick = first; tick < first + 2000; tick++) {
        const double exact = (double)sinl((long double)(tick % 20) / 20 * turn);
        const double sine = trial->method == HARD_NAIVE
                                ? sin((double)((mct_real)scene.input_frequency * time))
                                : (double)mct_input_at(&input, tick);
        hard_error(result, sine - exact);
        time += MS;
    }
}

/* 42: a tick of 0.1 us; damped by 10/s, rate e^-10t, angle 1 + (1 - e^-10t)/10. */
static void run_short_tick(const hard_trial *trial, hard_result *result)
{
    const double rate = exp(-10 * trial->seconds), angle = 1 + (1 - rate) / 10;
    hard_run run;
    if (trial->method == HARD_NAIVE) {
        const float h = 1e-7F;
        float x = 1, v = 1;
        for (long step = (long)(trial->seconds * 1e7 + 0.5); step > 0; step--) {
            v -= h * 10 * v;
            x += h * v;
        }
        hard_error(result, (double)x - angle);
        hard_error(result, (double)v - rate);
    } else if (hard_start(&run, trial, NULL, result) && hard_advance(&run, 0, hard_ticks(&run, trial))) {
        hard_error(result, hard_value(&run, 0) - angle);
        hard_error(result, hard_value(&run, 1) - rate);
    }
}

/* 43: a closed loop whose clock begins at another tick. */
static void run_late_clock(const hard_trial *trial, hard_result *result)
{
    static const uint64_t starts[] = {(UINT64_C(1) << 32) - 500, (UINT64_C(1) << 53) - 500,
                                      (UINT64_C(1) << 63) - 500};
    for (int i = 0; i < 3; i++) {
        if (trial->method == HARD_NAIVE) {
            const mct_real time = (mct_real)starts[i] * MS;
            hard_error(result, (double)(((time + MS) - time) / MS - 1));
            continue;
        }
        hard_run run;
        mct_sim sims[2];
        if (!hard_start(&run, trial, NULL, result)) {
            return;
        }
        for (int which = 0; which < 2; which++) {
            (void)mct_sim_init(&sims[which], &run.scene, NULL);
        }
        sims[1].plant.tick = starts[i];
        for (long step = steps_of(trial); step > 0; step--) {
            for (int which = 0; which < 2; which++) {
                const mct_hal hal = mct_sim_hal(&sims[which]);
                mct_reading reading;
                hal.ops->read(hal.context, &reading);
                hal.ops->write(hal.context, (mct_real)(reading.counts[0] % 10));
                hal.ops->wait_tick(hal.context);
            }
            hard_error(result, distance(&sims[0].plant, &sims[1].plant));
        }
    }
}

#include "runner_cost.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "hal/sim/sim.h"
#include "instructions.h"
#include "mctau/input.h"
#include "mctau/loop.h"
#include "mctau/plant.h"
#include "say.h"

static void write_row(const mct_plant *plant, double *rows)
{
    for (int i = 0; i < plant->states; i++) {
        rows[plant->tick * (uint64_t)plant->states + (uint64_t)i] = mct_plant_value(plant, i);
    }
}

/* --- the closed loop --- */

/* In simulation and in lockstep: what the controller applies, and where the plant goes; NULL: not written. */
static mct_status follow_loop(const mct_scene *scene, uint64_t ticks, double *inputs, double *states,
                              bool *diverged, mct_message *why)
{
    mct_scene simulated = *scene;
    simulated.realtime = 0;
    mct_sim *sim = need_memory(malloc(sizeof *sim));
    mct_loop *loop = need_memory(malloc(sizeof *loop));
    mct_plan *plan = need_memory(malloc(sizeof *plan));
    mct_status status = mct_sim_init(sim, &simulated, why);
    const mct_hal hal = mct_sim_hal(sim);
    status = status != MCT_OK ? status
                              : mct_loop_init(loop, plan, &simulated, hal, NULL, (mct_samples){NULL, 0}, why);
    status = status != MCT_OK ? status : hal.ops->open(hal.context, why);
    if (status == MCT_OK) {
        for (uint64_t i = 0; i < ticks; i++) {
            if (states != NULL) {
                write_row(&sim->plant, states);
            }
            mct_loop_tick(loop);
            if (inputs != NULL) {
                inputs[i] = (double)loop->record.applied;
            }
        }
        if (states != NULL) {
            write_row(&sim->plant, states);
        }
        *diverged = sim->plant.diverged_ticks > 0;
        hal.ops->stop(hal.context);
        hal.ops->close(hal.context);
    }
    free(loop);
    free(plan);
    free(sim);
    return status;
}

mct_status runner_loop(const mct_scene *scene, uint64_t ticks, double *states, bool *diverged,
                       mct_message *why)
{
    mct_message_clear(why);
    return follow_loop(scene, ticks, NULL, states, diverged, why);
}

/* --- inputs --- */

mct_status runner_inputs(const mct_scene *scene, const run_options *options, uint64_t ticks, double *inputs,
                         mct_message *why)
{
    mct_input open_loop;
    mct_message_clear(why);
    if (scene->controller != MCT_CONTROLLER_NONE) {
        bool diverged;
        return follow_loop(scene, ticks, inputs, NULL, &diverged, why);
    }
    mct_input_init(&open_loop, scene, RUNNER_SAMPLES(options));
    for (uint64_t i = 0; i < ticks; i++) {
        inputs[i] = (double)mct_input_at(&open_loop, i);
    }
    return MCT_OK;
}

/* --- a trial --- */

static double now_ns(void)
{
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time); /* what others do on this core does not count */
    return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

static void step(mct_plant *plant, const trial *self)
{
    mct_plant_step(plant, self->inputs != NULL ? (mct_real)self->inputs[plant->tick] : 0);
}

/* The whole run once; ends where it diverges. */
static void follow(mct_plant *plant, trial *self)
{
    write_row(plant, self->states);
    while (plant->tick < self->ticks && plant->diverged_ticks == 0) {
        step(plant, self);
        write_row(plant, self->states);
    }
    self->diverged = plant->diverged_ticks > 0;
}

/* Any number of ticks: the run, and when it is over again from its start. */
static void repeat(mct_plant *plant, const mct_plant *start, const trial *self, uint64_t ticks)
{
    for (uint64_t i = 0; i < ticks; i++) {
        if (plant->tick == self->ticks) {
            *plant = *start;
        }
        step(plant, self);
    }
}

static double time_ticks(mct_plant *plant, const mct_plant *start, const trial *self)
{
    uint64_t ticks = 16;
    *plant = *start;
    for (;;) { /* ends: twice as many ticks take twice as long */
        const double begin = now_ns();
        repeat(plant, start, self, ticks);
        const double spent = now_ns() - begin;
        if (spent >= self->sample_ns) {
            return spent / (double)ticks;
        }
        ticks *= 2;
    }
}

/* The difference of 32 and 16 ticks: what starts and stops the counter drops out. */
static double count_ticks(mct_plant *plant, const mct_plant *start, const trial *self)
{
    enum { TICKS = RUNNER_COUNTED_TICKS / 2 };
    uint64_t count[2] = {0, 0};
    const int counter = instructions_open();
    for (int i = 0; i < 2 && counter >= 0; i++) {
        *plant = *start;
        repeat(plant, start, self, TICKS); /* warm */
        *plant = *start;
        instructions_begin(counter);
        repeat(plant, start, self, (uint64_t)(i + 1) * TICKS);
        count[i] = instructions_end(counter);
    }
    instructions_close(counter);
    return count[1] > count[0] ? (double)(count[1] - count[0]) / TICKS : (double)NAN;
}

mct_status runner_try(const mct_scene *scene, trial *self, mct_message *why)
{
    mct_plant start, plant;
    mct_message_clear(why);
    const mct_status status = mct_plant_init(&start, scene, why);
    if (status != MCT_OK) {
        return status;
    }
    if (self->states != NULL) {
        plant = start;
        follow(&plant, self);
    }
    if (self->sample_ns > 0) {
        self->ns = time_ticks(&plant, &start, self);
    }
    if (self->count) {
        self->instructions = count_ticks(&plant, &start, self);
    }
    return MCT_OK;
}

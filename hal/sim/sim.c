#include "hal/sim/sim.h"

#include <string.h>

#include "mctau/compensated.h"
#include "mctau/mix.h"

#define TURN 6.283185307179586476925

/* Takes out whole counts, modulo 2^32, and leaves less than one. Without 64-bit integers, for numbers below 2^62. */
MCT_INLINE uint32_t take_whole(mct_real *counts)
{
    const mct_real half_range = MCT_R(0x1p31);
    const int32_t high = (int32_t)(*counts / half_range);
    const mct_real low = *counts - (mct_real)high * half_range;
    const int32_t whole = (int32_t)low;
    *counts = low - (mct_real)whole;
    return ((uint32_t)high << 31) + (uint32_t)whole;
}

/* A coordinate in counts: whole ones, modulo 2^32, and the rest. Both halves of the state go in. */
MCT_INLINE uint32_t counts_of(const mct_sim *sim, int i, mct_real *rest)
{
    const mct_sim_encoder *encoder = &sim->encoders[i];
    const mct_state *state = &sim->plant.state;
    mct_real error;
    mct_real product = mct_two_product(state->x[i], encoder->unit_counts, &error);
    const uint32_t whole = take_whole(&product);
    const mct_real small = state->x[i] * encoder->unit_rest + state->c[i] * encoder->unit_counts;
    *rest = product + (error + small);
    return whole + (uint32_t)state->turns[i] * (uint32_t)encoder->turn_counts;
}

mct_status mct_sim_init(mct_sim *sim, const mct_scene *scene, mct_message *why)
{
    mct_scene varied;
    memset(sim, 0, sizeof *sim);
    mct_scene_vary(scene, &varied);
    const mct_status status = mct_plant_init(&sim->plant, &varied, why);
    if (status != MCT_OK) {
        return status;
    }
    const mct_system *system = sim->plant.system;
    for (int i = 0; i < mct_encoder_count(system); i++) {
        const double counts = scene->counts_per_unit[i];
        const bool angle = system->coordinates[i].is_angle;
        mct_sim_encoder *encoder = &sim->encoders[i];
        encoder->turn_counts = angle ? (int32_t)(counts + 0.5) : 0;
        const double unit = angle ? encoder->turn_counts / TURN : counts;
        encoder->unit_counts = (mct_real)unit;
        encoder->unit_rest = (mct_real)(unit - (double)encoder->unit_counts);
        encoder->start_counts = counts_of(sim, i, &encoder->start_rest);
    }
    sim->encoder_count = mct_encoder_count(system);
    sim->noise = (mct_real)scene->noise;
    sim->seed = (uint32_t)scene->sensor_seed;
    sim->counter_shift = (uint32_t)(32 - scene->counter_bits);
    sim->latency = (uint32_t)scene->latency;
    sim->tick_us = scene->dt < 1e-6 ? 1 : (uint32_t)(scene->dt * 1e6 + 0.5); /* never ageless */
    sim->fault = scene->sensor_fault;
    sim->fault_begin = (uint64_t)(scene->sensor_fault_time / scene->dt + 0.5);
    sim->fault_end = (uint64_t)((scene->sensor_fault_time + scene->sensor_fault_duration) / scene->dt + 0.5);
    sim->realtime = scene->realtime != 0;
    sim->dt = scene->dt;
    return MCT_OK;
}

/* Noise depends on seed, tick and encoder alone. */
static uint64_t hash(uint64_t seed, uint64_t tick, uint64_t encoder)
{
    return mct_mix((seed << 40) + tick * 4 + encoder + MCT_MIX_STEP);
}

/* Nearly normal, standard deviation 1: the sum of four uniform numbers of 16 bits. */
static mct_real nearly_normal(uint64_t bits)
{
    const int32_t sum =
        (int32_t)((bits & 0xFFFF) + ((bits >> 16) & 0xFFFF) + ((bits >> 32) & 0xFFFF) + (bits >> 48));
    return (mct_real)(sum - 2 * 65535) * MCT_R(2.6429e-5); /* 1 / sqrt(4 * 65536^2 / 12) */
}

/* Encoder counters of the present state. They wrap as hardware's do. */
static void sense(const mct_sim *sim, mct_reading *reading)
{
    memset(reading, 0, sizeof *reading);
    for (int i = 0; i < sim->encoder_count; i++) {
        mct_real rest;
        const uint32_t whole = counts_of(sim, i, &rest) - sim->encoders[i].start_counts;
        rest -= sim->encoders[i].start_rest;
        if (sim->noise > 0) {
            rest += sim->noise * nearly_normal(hash(sim->seed, sim->plant.tick, (uint64_t)i));
        }
        rest += rest < 0 ? MCT_R(-0.5) : MCT_R(0.5);
        const uint32_t counter = (whole + take_whole(&rest)) << sim->counter_shift;
        reading->counts[i] = (int32_t)(counter >> sim->counter_shift);
    }
}

/* The fault of this tick. */
static int32_t fault_now(const mct_sim *sim)
{
    if (sim->fault == MCT_SENSOR_FAULT_NONE) {
        return MCT_SENSOR_FAULT_NONE;
    }
    const uint64_t tick = sim->plant.tick;
    return tick >= sim->fault_begin && tick < sim->fault_end ? sim->fault : MCT_SENSOR_FAULT_NONE;
}

static mct_status sim_open(void *context, mct_message *why)
{
    mct_sim *sim = context;
    sim->input = 0;
    if (sim->realtime && sim->clock == NULL) {
        mct_message_add(why, "scene.realtime: found true, and no clock in mct_sim");
        return MCT_ERROR_ARGUMENT;
    }
    if (sim->realtime) {
        mct_clock_start(sim->clock, sim->dt);
    }
    return MCT_OK;
}

static mct_status sim_read(void *context, mct_reading *reading)
{
    mct_sim *sim = context;
    const uint64_t tick = sim->plant.tick;
    const int32_t delay = (int32_t)(tick < sim->latency ? tick : sim->latency);
    const int32_t before = sim->newest - delay;
    const int32_t fault = fault_now(sim);
    sense(sim, &sim->queue[sim->newest]);
    if (fault == MCT_SENSOR_FAULT_SILENT) {
        sim->silent_ticks++;
        *reading = sim->last;
        reading->flags = MCT_READING_MISSING;
        reading->age_us = (sim->silent_ticks + sim->latency) * sim->tick_us;
        return MCT_OK;
    }
    sim->silent_ticks = 0;
    if (fault == MCT_SENSOR_FAULT_NAN) {
        *reading = sim->last; /* a value that is not a number has no counts: the last valid ones are held */
        reading->flags = MCT_READING_INVALID;
    } else if (fault == MCT_SENSOR_FAULT_FROZEN) {
        *reading = sim->last;
    } else {
        *reading = sim->queue[before < 0 ? before + MCT_MAX_LATENCY + 1 : before];
        sim->last = *reading;
    }
    reading->age_us = sim->latency * sim->tick_us;
    return MCT_OK;
}

static mct_status sim_write(void *context, mct_real input)
{
    mct_sim *sim = context;
    sim->input = input;
    return MCT_OK;
}

static mct_status sim_wait_tick(void *context)
{
    mct_sim *sim = context;
    mct_plant_step(&sim->plant, sim->input);
    sim->newest = sim->newest < MCT_MAX_LATENCY ? sim->newest + 1 : 0;
    return sim->realtime ? mct_clock_wait(sim->clock) : MCT_OK;
}

static void sim_arm(void *context)
{
    (void)context; /* a simulated motor is always ready */
}

static void sim_stop(void *context)
{
    mct_sim *sim = context;
    sim->input = 0;
}

static const mct_state *sim_plant(void *context)
{
    const mct_sim *sim = context;
    return &sim->plant.state;
}

static const mct_timing *sim_timing(void *context)
{
    static const mct_timing none = {0};
    const mct_sim *sim = context;
    return sim->realtime && sim->clock != NULL ? &sim->clock->timing : &none;
}

static mct_counters sim_counters(void *context)
{
    (void)context;
    return (mct_counters){0};
}

mct_hal mct_sim_hal(mct_sim *sim)
{
    static const mct_hal_ops ops = {
        .name = "sim",
        .open = sim_open,
        .read = sim_read,
        .write = sim_write,
        .wait_tick = sim_wait_tick,
        .stop = sim_stop,
        .arm = sim_arm,
        .close = sim_stop,
        .plant = sim_plant,
        .timing = sim_timing,
        .counters = sim_counters,
    };
    return (mct_hal){&ops, sim};
}

#include "hal/sim/sim.h"

#include <string.h>

#include "mctau/mix.h"

#define TURN 6.283185307179586476925

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
        sim->turn_counts[i] = angle ? (double)(int64_t)(counts + 0.5) : 0;
        sim->unit_counts[i] = angle ? sim->turn_counts[i] / TURN : counts;
        sim->start_counts[i] = scene->initial[i] * sim->unit_counts[i];
    }
    sim->noise = scene->noise;
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
static double nearly_normal(uint64_t bits)
{
    const int64_t sum =
        (int64_t)((bits & 0xFFFF) + ((bits >> 16) & 0xFFFF) + ((bits >> 32) & 0xFFFF) + (bits >> 48));
    return (double)(sum - 2 * 65535) * 2.6429e-5; /* 1 / sqrt(4 * 65536^2 / 12) */
}

static int64_t rounded(double value)
{
    return (int64_t)(value < 0 ? value - 0.5 : value + 0.5);
}

/* Encoder counters of the present state. */
static void sense(const mct_sim *sim, mct_reading *reading)
{
    const mct_plant *plant = &sim->plant;
    const mct_state *state = &plant->state;
    memset(reading, 0, sizeof *reading);
    for (int i = 0; i < mct_encoder_count(plant->system); i++) {
        double counts =
            ((double)state->x[i] + (double)state->c[i]) * sim->unit_counts[i] - sim->start_counts[i];
        if (sim->noise > 0) {
            counts += sim->noise * nearly_normal(hash(sim->seed, plant->tick, (uint64_t)i));
        }
        /* Whole turns are added as integers, and the counter wraps as hardware's does. */
        const int64_t whole = (int64_t)state->turns[i] * (int64_t)sim->turn_counts[i];
        const uint32_t counter = (uint32_t)(uint64_t)(rounded(counts) + whole) << sim->counter_shift;
        reading->counts[i] = (int32_t)(counter >> sim->counter_shift);
    }
}

static bool has_fault(const mct_sim *sim, int32_t fault)
{
    return sim->fault == fault && sim->plant.tick >= sim->fault_begin && sim->plant.tick < sim->fault_end;
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
    const uint32_t delay = tick < sim->latency ? (uint32_t)tick : sim->latency;
    sense(sim, &sim->queue[tick % (MCT_MAX_LATENCY + 1)]);
    if (has_fault(sim, MCT_SENSOR_FAULT_SILENT)) {
        sim->silent_ticks++;
        *reading = sim->last;
        reading->flags = MCT_READING_MISSING;
        reading->age_us = (sim->silent_ticks + sim->latency) * sim->tick_us;
        return MCT_OK;
    }
    sim->silent_ticks = 0;
    if (has_fault(sim, MCT_SENSOR_FAULT_NAN)) {
        *reading = sim->last; /* a value that is not a number has no counts: the last valid ones are held */
        reading->flags = MCT_READING_INVALID;
    } else if (has_fault(sim, MCT_SENSOR_FAULT_FROZEN)) {
        *reading = sim->last;
    } else {
        *reading = sim->queue[(tick - delay) % (MCT_MAX_LATENCY + 1)];
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

/*
 * The virtual drive on a CAN interface: paced by the clock, or in lockstep by the commands that come.
 *
 * In lockstep each command is a tick. When none comes for a while its sender is gone: then time goes on by
 * the clock, so that the drive's watchdog acts, until one comes again. A single command (a host that arms
 * the drive) leads for less long than a row of them, whose host may itself be waiting for an answer that was
 * lost.
 */
#include "runner_drive.h"

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "csv_output.h"
#include "hal/clock.h"
#include "hal/socketcan/drive.h"
#include "hal/socketcan/socket.h"
#include "mctau/plant.h"
#include "say.h"

#define TURN    6.283185307179586
#define UPRIGHT 0.034906585039886591538 /* 2 degrees */

enum {
    FIRST_PATIENCE_US = 50000,
    PATIENCE_US = 200000
}; /* in lockstep, behind the first command of a row, or more */
static const uint64_t never = UINT64_MAX;

typedef struct {
    const mct_scene *scene;
    const drive_options *options;
    mct_can_socket socket;
    mct_can_drive drive;
    mct_clock clock;
    uint64_t ticks;  /* of the mechanism, until it ends; `never` for until it is stopped */
    int row;         /* lockstep: commands that made the last ticks; 2: or more */
    int64_t tick_us; /* at least 1 */
    /* what the ticks have shown */
    int upright; /* index of the angle that is 0 upright */
    double deviation, least_deviation;
    uint64_t last_outside; /* tick at whose end the angle was beyond UPRIGHT, `never` for none */
    /* CSV */
    csv_output csv;
    bool has_csv;
    mct_plant reader; /* a state, to be read out */
    /* progress */
    bool has_progress;
    pthread_t progress;
    uint64_t progress_tick; /* atomic */
    bool progress_released; /* atomic */
    bool progress_ends;     /* atomic */
} drive_run;

static void sleep_us(int64_t us)
{
    const struct timespec span = {.tv_sec = us / 1000000, .tv_nsec = (long)(us % 1000000) * 1000};
    nanosleep(&span, NULL);
}

static const mct_plant *plant_of(const drive_run *self)
{
    return &self->drive.sim.plant;
}

static int states_of(const drive_run *self)
{
    return plant_of(self)->states;
}

/* --- CSV --- */

static mct_status open_csv(drive_run *self, mct_message *why)
{
    char line[1024];
    if (self->options->csv == NULL) {
        return MCT_OK;
    }
    const mct_status status = csv_output_open(&self->csv, self->options->csv, why);
    self->has_csv = status == MCT_OK;
    if (self->has_csv) {
        size_t used = (size_t)snprintf(line, sizeof line, "time");
        for (int i = 0; i < states_of(self); i++) {
            used += (size_t)snprintf(line + used, sizeof line - used, ",%s",
                                     mct_state_field(plant_of(self)->system, i)->name);
        }
        used += (size_t)snprintf(line + used, sizeof line - used, ",volts\n");
        csv_output_headers(&self->csv, line, used);
    }
    return status;
}

/* The state at the beginning of a tick and the volts that acted during it. */
static void write_row(drive_run *self, uint64_t tick, const mct_state *state)
{
    char line[1024];
    size_t used = (size_t)snprintf(line, sizeof line, "%.17g", (double)tick * self->scene->dt);
    self->reader.state = *state;
    for (int i = 0; i < states_of(self); i++) {
        used +=
            (size_t)snprintf(line + used, sizeof line - used, ",%.17g", mct_plant_value(&self->reader, i));
    }
    used += (size_t)snprintf(line + used, sizeof line - used, ",%.17g\n", self->drive.volts);
    csv_output_row(&self->csv, line, used);
}

/* --- progress --- */

static void *show_progress(void *context)
{
    enum { PAUSE_US = 250000 };
    drive_run *self = context;
    while (!__atomic_load_n(&self->progress_ends, __ATOMIC_ACQUIRE)) {
        const uint64_t tick = __atomic_load_n(&self->progress_tick, __ATOMIC_RELAXED);
        if (__atomic_load_n(&self->progress_released, __ATOMIC_RELAXED)) {
            fprintf(stderr, "\r%.1f s \033[K", (double)tick * self->scene->dt);
        } else {
            fputs("\rwaits for a host that arms it \033[K", stderr);
        }
        fflush(stderr);
        sleep_us(PAUSE_US);
    }
    fputs("\r\033[K", stderr);
    return NULL;
}

static void end_progress(drive_run *self)
{
    if (self->has_progress) {
        __atomic_store_n(&self->progress_ends, true, __ATOMIC_RELEASE);
        pthread_join(self->progress, NULL);
    }
}

/* --- ticks --- */

static void track_deviation(drive_run *self)
{
    const double deviation = fabs(remainder(mct_plant_value(plant_of(self), self->upright), TURN));
    self->deviation = deviation;
    self->least_deviation = deviation < self->least_deviation ? deviation : self->least_deviation;
    if (!(deviation <= UPRIGHT)) {
        self->last_outside = plant_of(self)->tick;
    }
}

/* Waits for the next tick. */
static void pace(drive_run *self)
{
    if (!self->drive.lockstep) {
        if (mct_clock_wait(&self->clock) != MCT_OK) {
            sleep_us(self->tick_us);
        }
    } else if (!self->drive.released) {
        sleep_us(self->tick_us); /* nobody leads yet */
    } else {
        const int64_t patience[] = {self->tick_us, FIRST_PATIENCE_US, PATIENCE_US};
        const bool led = mct_can_drive_wait(&self->drive, patience[self->row]);
        self->row = !led ? 0 : self->row < 2 ? self->row + 1 : 2;
    }
}

static void tick(drive_run *self)
{
    const uint64_t before = plant_of(self)->tick;
    const mct_state state = plant_of(self)->state;
    mct_can_drive_tick(&self->drive);
    if (plant_of(self)->tick != before) {
        track_deviation(self);
        if (self->has_csv) {
            write_row(self, before, &state);
        }
    }
    __atomic_store_n(&self->progress_tick, plant_of(self)->tick, __ATOMIC_RELAXED);
    __atomic_store_n(&self->progress_released, self->drive.released, __ATOMIC_RELAXED);
}

static void run_ticks(drive_run *self)
{
    track_deviation(self);
    if (!self->drive.lockstep) {
        mct_clock_start(&self->clock, self->scene->dt);
    }
    while (*self->options->stop == 0 && plant_of(self)->tick < self->ticks) {
        pace(self);
        tick(self);
    }
}

/* --- from beginning to end --- */

static void fill_result(const drive_run *self, drive_result *result)
{
    const mct_can_drive *drive = &self->drive;
    const mct_plant *plant = plant_of(self);
    const uint64_t upright_tick = self->last_outside == never ? 0 : self->last_outside + 1;
    result->states = states_of(self);
    for (int i = 0; i < result->states; i++) {
        const mct_field *field = mct_state_field(plant->system, i);
        result->names[i] = field->name;
        result->units[i] = field->unit;
        result->state[i] = mct_plant_value(plant, i);
    }
    result->stopped = plant->tick < self->ticks;
    result->released = drive->released;
    result->lockstep = drive->lockstep;
    result->powered = drive->powered;
    result->volts = drive->volts;
    result->drive = drive->result;
    result->link = drive->link;
    result->motor = drive->devices[0].state;
    memcpy(result->counts, drive->counts.values, sizeof drive->counts.values);
    result->diverged_ticks = plant->diverged_ticks;
    result->deviation = self->deviation;
    result->least_deviation = self->least_deviation;
    result->upright_at = self->last_outside == plant->tick ? -1 : (double)upright_tick * self->scene->dt;
    result->timing = self->clock.timing;
    result->has_priority = self->clock.has_priority;
    result->has_memory = self->clock.has_memory;
}

static mct_status prepare(drive_run *self, mct_message *why)
{
    const mct_scene *scene = self->scene;
    const mct_can_transport bus =
        mct_can_socket_transport(&self->socket, self->options->interface, (uint32_t)scene->can_bitrate);
    self->ticks = self->options->has_duration ? (uint64_t)(scene->duration / scene->dt + 0.5) : never;
    self->tick_us = scene->dt < 1e-6 ? 1 : (int64_t)(scene->dt * 1e6 + 0.5);
    self->last_outside = never;
    self->least_deviation = TURN;
    mct_status status = mct_can_drive_init(&self->drive, scene, bus, why);
    if (status != MCT_OK) {
        return status;
    }
    self->upright = mct_systems[scene->system]->actuation->upright_coordinate;
    for (int i = 0; i < self->drive.device_count; i++) {
        self->drive.devices[i].serial = (uint16_t)getpid(); /* two of them on one bus are two */
    }
    self->reader = *plant_of(self);
    return status != MCT_OK ? status : open_csv(self, why);
}

static mct_status execute(drive_run *self, drive_result *result, mct_message *why)
{
    mct_message reason;
    mct_message_clear(&reason);
    const mct_status status = mct_can_drive_open(&self->drive, &reason);
    if (status != MCT_OK) {
        mct_message_clear(why);
        mct_message_add(why, "--can: ");
        mct_message_add(why, reason.text);
        return status;
    }
    if (self->options->started != NULL) {
        self->options->started(&self->drive.axes);
    }
    if (self->options->progress) {
        self->has_progress = pthread_create(&self->progress, NULL, show_progress, self) == 0;
    }
    run_ticks(self);
    fill_result(self, result);
    mct_can_drive_close(&self->drive);
    end_progress(self);
    return MCT_OK;
}

mct_status runner_drive(const mct_scene *scene, const drive_options *options, drive_result *result,
                        mct_message *why)
{
    drive_run *self = need_memory(calloc(1, sizeof *self));
    memset(result, 0, sizeof *result);
    mct_message_clear(why);
    self->scene = scene;
    self->options = options;
    self->csv.file = -1;
    mct_status status = prepare(self, why);
    status = status != MCT_OK ? status : execute(self, result, why);
    if (status == MCT_OK && self->has_csv) {
        csv_output_close(&self->csv);
        result->csv_rows = self->csv.rows;
        result->csv_errors = self->csv.errors;
        result->csv_errno = self->csv.error;
    } else {
        csv_output_discard(&self->csv);
    }
    free(self);
    return status;
}

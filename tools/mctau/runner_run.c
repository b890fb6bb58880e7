/*
 * A run: HAL, loop, and who is told. The clock is read between blocks of ticks only, and rows of a CSV file
 * are written there: a tick costs here what it costs anywhere. In real time one block holds the whole run, so
 * that no tick waits for a disk.
 */
#include "runner_run.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "csv_output.h"
#include "hal/sim/sim.h"
#include "hal/socketcan/can.h"
#include "hal/socketcan/candump.h"
#include "hal/socketcan/drive.h"
#include "hal/socketcan/socket.h"
#include "mctau/loop.h"
#include "mctau/watch.h"
#include "say.h"
#if MCTAU_HAVE_LCM
#include "hal/lcm/telemetry.h"
#endif

#define PI      MCT_R(3.14159265358979323846)
#define UPRIGHT MCT_R(0.034906585039886591538) /* 2 degrees */

enum { BLOCK = 1024 };                                    /* ticks between looks at the clock */
static const uint64_t largest_buffer = UINT64_C(1) << 30; /* bytes of rows that a real-time run may keep */
static const uint64_t never = UINT64_MAX;

typedef struct {
    const mct_scene *scene;
    const run_options *options;
    mct_loop loop;
    mct_plan plan;
    mct_ring ring;
    /* the hardware, one of them by the name that the scene gives */
    mct_sim sim;
    mct_clock sim_clock;
    mct_watch watch; /* of the energy in sim */
    mct_can can;
    mct_can_socket socket;
    mct_can_candump log;
    char *log_text;
    mct_can_ring bus;
    mct_can_drive drive;
    mct_clock *clock;
    const mct_plant *mechanism; /* NULL where nobody knows it */
    const mct_state *plant;     /* its state */
    bool realtime;
    int rearmed;    /* requests that have been passed on */
    uint64_t ticks; /* of the whole run */
    /* what the ticks have shown */
    int upright; /* index of the angle that is 0 upright */
    mct_real deviation, least_deviation, worst_deviation, worst_last_second;
    uint64_t last_second;  /* tick at which it begins */
    uint64_t last_outside; /* tick at whose end the angle was beyond UPRIGHT, `never` for none */
    mct_real limit;        /* of the input */
    uint64_t saturated_ticks;
    uint64_t first_fault; /* tick on which a fault was latched, `never` for none */
    /* time */
    int64_t started_ns, loop_ns, waiting_ns;
    bool telemetry_is_stuck;
    /* CSV */
    csv_output csv;
    bool has_csv;
    mct_plant reader; /* a record's state, to be read out */
    mct_record *rows;
    uint64_t row_count, row_capacity;
    /* telemetry */
    bool has_telemetry;
#if MCTAU_HAVE_LCM
    mct_telemetry telemetry;
#endif
    /* progress */
    bool has_progress;
    pthread_t progress;
    uint64_t progress_tick; /* atomic */
    bool progress_ends;     /* atomic */
} run;

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static void sleep_ns(long ns)
{
    const struct timespec span = {.tv_nsec = ns};
    nanosleep(&span, NULL);
}

/* --- what a tick shows --- */

static mct_real deviation_of(const run *self)
{
    const mct_real angle =
        self->plant != NULL ? self->plant->x[self->upright] : self->loop.record.estimate[self->upright];
    const mct_real folded = angle > PI ? angle - 2 * PI : angle < -PI ? angle + 2 * PI : angle;
    return folded < 0 ? -folded : folded;
}

static void track_deviation(run *self, uint64_t tick)
{
    const mct_real deviation = deviation_of(self);
    self->deviation = deviation;
    if (!(deviation <= UPRIGHT)) {
        self->last_outside = tick;
        self->worst_deviation = 0;
    } else if (deviation > self->worst_deviation) {
        self->worst_deviation = deviation;
    }
    if (tick >= self->last_second && deviation > self->worst_last_second) {
        self->worst_last_second = deviation;
    }
    if (deviation < self->least_deviation) {
        self->least_deviation = deviation;
    }
}

/* --- CSV --- */

static size_t add(char *line, size_t used, size_t size, const char *text)
{
    const int length = snprintf(line + used, size - used, "%s%s", used > 0 ? "," : "", text);
    return used + (size_t)length;
}

static size_t add_number(char *line, size_t used, size_t size, double value)
{
    const int length = snprintf(line + used, size - used, ",%.17g", value);
    return used + (size_t)length;
}

/* Names of latched faults, joined by "+". */
static size_t add_faults(char *line, size_t used, size_t size, uint32_t faults)
{
    const char *between = ",";
    if (faults == 0) {
        return used + (size_t)snprintf(line + used, size - used, ",");
    }
    for (int i = 0; i < MCT_FAULT_COUNT; i++) {
        if (faults & (1u << i)) {
            used += (size_t)snprintf(line + used, size - used, "%s%s", between, mct_fault_name((mct_fault)i));
            between = "+";
        }
    }
    return used;
}

static void write_headers(run *self)
{
    char line[2048];
    size_t used = 0;
    const mct_system *system = self->reader.system;
    used = add(line, used, sizeof line, "time");
    for (int i = 0; self->plant != NULL && i < self->reader.states; i++) {
        used = add(line, used, sizeof line, mct_state_field(system, i)->name);
    }
    for (int i = 0; self->loop.controlled && i < 2 * mct_encoder_count(system); i++) {
        char name[128];
        snprintf(name, sizeof name, "%s_estimate", mct_state_field(system, i)->name);
        used = add(line, used, sizeof line, name);
    }
    used = add(line, used, sizeof line, "wanted,applied,mode,faults\n");
    csv_output_headers(&self->csv, line, used);
}

static void write_row(run *self, const mct_record *record)
{
    char line[2048];
    const mct_system *system = self->reader.system;
    size_t used = (size_t)snprintf(line, sizeof line, "%.17g", (double)record->tick * self->scene->dt);
    self->reader.state = record->plant;
    for (int i = 0; self->plant != NULL && i < self->reader.states; i++) {
        used = add_number(line, used, sizeof line, mct_plant_value(&self->reader, i));
    }
    for (int i = 0; self->loop.controlled && i < 2 * mct_encoder_count(system); i++) {
        used = add_number(line, used, sizeof line, (double)record->estimate[i]);
    }
    used = add_number(line, used, sizeof line, (double)record->wanted);
    used = add_number(line, used, sizeof line, (double)record->applied);
    used = add(line, used, sizeof line, mct_mode_name((mct_mode)record->mode));
    used = add_faults(line, used, sizeof line, record->faults);
    line[used++] = '\n';
    csv_output_row(&self->csv, line, used);
}

static void write_rows(run *self)
{
    for (uint64_t i = 0; i < self->row_count; i++) {
        write_row(self, &self->rows[i]);
    }
    self->row_count = 0;
}

static mct_status open_csv(run *self, mct_message *why)
{
    const bool realtime = self->realtime;
    if (self->options->csv == NULL || self->options->csv[0] == '\0') {
        return MCT_OK;
    }
    self->row_capacity = realtime ? self->ticks + 1 : BLOCK;
    if (self->row_capacity > largest_buffer / sizeof *self->rows) {
        mct_message_add(why, "--csv: found ");
        mct_message_add_number(why, self->scene->duration);
        mct_message_add(why, " s in real time, whose rows are kept in memory until the end; allowed up to ");
        mct_message_add_number(why, (double)(largest_buffer / sizeof *self->rows) * self->scene->dt);
        mct_message_add(why, " s; use --log");
        return MCT_ERROR_BOUND;
    }
    self->rows = need_memory(calloc(self->row_capacity, sizeof *self->rows));
    memset(self->rows, 1,
           self->row_capacity * sizeof *self->rows); /* so that no tick meets a page that is not there */
    const mct_status status = csv_output_open(&self->csv, self->options->csv, why);
    self->has_csv = status == MCT_OK;
    if (self->has_csv) {
        write_headers(self);
    }
    return status;
}

/* --- telemetry --- */

static bool is_given(const char *text)
{
    return text != NULL && text[0] != '\0';
}

static bool wants_telemetry(const run *self)
{
    return is_given(self->options->log) || is_given(self->options->lcm);
}

static mct_status start_telemetry(run *self, run_result *result, mct_message *why)
{
    if (!wants_telemetry(self)) {
        return MCT_OK;
    }
#if MCTAU_HAVE_LCM
    const mct_telemetry_targets targets = {
        .url = self->options->lcm,
        .log = self->options->log,
        .scene_text = self->options->scene_text,
        .timing = self->loop.hal.ops->timing(self->loop.hal.context),
        .counters = self->loop.hal.ops->counters(self->loop.hal.context),
    };
    const mct_status status = mct_telemetry_start(&self->telemetry, &self->ring, self->scene, &targets, why);
    self->has_telemetry = status == MCT_OK;
    if (status == MCT_OK) {
        result->warning = *why;
        mct_message_clear(why);
    }
    return status;
#else
    (void)result;
    mct_message_add(why, "telemetry: this build has no LCM, so --lcm and --log are left out of it");
    return MCT_ERROR_IO;
#endif
}

static void stop_telemetry(run *self, run_result *result)
{
#if MCTAU_HAVE_LCM
    if (self->has_telemetry) {
        mct_telemetry_stop(&self->telemetry);
        const mct_telemetry_counts *counts = &self->telemetry.counts;
        result->published = counts->published;
        result->publish_errors = counts->publish_errors;
        result->logged = counts->logged;
        result->log_errors = counts->log_errors;
        result->log_errno = counts->first_log_errno;
    }
#endif
    result->dropped = self->ring.dropped;
    self->has_telemetry = false;
}

/*
 * In lockstep nobody is in a hurry: the run waits for telemetry instead of losing records, but not for one
 * that is stuck.
 */
static void wait_for_telemetry(run *self)
{
    enum { PAUSE_NS = 100000, PAUSES = 20000 }; /* 2 s */
    const int64_t begin = now_ns();
    for (int i = 0; i < PAUSES && mct_ring_is_full(&self->ring) && *self->options->stop == 0; i++) {
        sleep_ns(PAUSE_NS);
    }
    self->telemetry_is_stuck = mct_ring_is_full(&self->ring);
    self->waiting_ns += now_ns() - begin;
}

/* --- progress --- */

static void *show_progress(void *context)
{
    enum { PAUSE_NS = 250000000, QUIET = 4 };
    run *self = context;
    for (int i = 0; !__atomic_load_n(&self->progress_ends, __ATOMIC_ACQUIRE); i++) {
        sleep_ns(i == 0 ? PAUSE_NS / 10 : PAUSE_NS);
        if (i >= QUIET) {
            const uint64_t tick = __atomic_load_n(&self->progress_tick, __ATOMIC_RELAXED);
            fprintf(stderr, "\r%.1f s of %g s, %d %% ", (double)tick * self->scene->dt, self->scene->duration,
                    (int)(100 * tick / (self->ticks + 1)));
            fflush(stderr);
        }
    }
    fputs("\r\033[K", stderr);
    return NULL;
}

/* --- from beginning to end --- */

/* What follows "NAME:" in the scene's hal, or NULL when it is another one. */
static const char *argument_of(const char *hal, const char *name)
{
    const size_t length = strlen(name);
    return strncmp(hal, name, length) == 0 && hal[length] == ':' && hal[length + 1] != '\0' ? hal + length + 1
                                                                                            : NULL;
}

static mct_status read_log(run *self, const char *path, size_t *length, mct_message *why)
{
    enum { LARGEST = 1 << 28 };
    FILE *file = fopen(path, "rb");
    struct stat there;
    bool well = file != NULL && fstat(fileno(file), &there) == 0 && there.st_size < LARGEST;
    if (well) {
        *length = (size_t)there.st_size;
        self->log_text = need_memory(malloc(*length + 1));
        well = fread(self->log_text, 1, *length, file) == *length;
    }
    if (!well) {
        mct_message_add(why, "scene.hal: ");
        mct_message_add(why, path);
        mct_message_add(why, ": the recorded bus cannot be read: ");
        mct_message_add(why, errno != 0 ? strerror(errno) : "too large");
    }
    if (file != NULL) {
        fclose(file);
    }
    return well ? MCT_OK : MCT_ERROR_IO;
}

static mct_status use_can(run *self, mct_can_transport transport, bool lockstep, mct_hal *hal,
                          mct_message *why)
{
    self->realtime = !lockstep;
    self->clock = &self->can.clock;
    *hal = mct_can_hal(&self->can);
    return mct_can_init(&self->can, self->scene, transport, lockstep, why);
}

/* A controller and a simulated drive at the two ends of a bus within the process. */
static mct_status use_ring(run *self, mct_hal *hal, mct_message *why)
{
    mct_can_ring_init(&self->bus);
    mct_status status = mct_can_drive_init(&self->drive, self->scene, mct_can_ring_end(&self->bus, 1), why);
    status = status != MCT_OK ? status : use_can(self, mct_can_ring_end(&self->bus, 0), true, hal, why);
    if (status == MCT_OK) {
        mct_can_drive_serve(&self->drive, &self->bus);
        self->drive.held = true;
        self->mechanism = &self->drive.sim.plant;
        self->can.plant = &self->mechanism->state;
        status = mct_can_drive_open(&self->drive, why);
    }
    return status;
}

/* HAL by the name that a scene gives. */
static mct_status choose_hal(run *self, mct_hal *hal, mct_message *why)
{
    const mct_scene *scene = self->scene;
    const char *const interface = argument_of(scene->hal, "socketcan");
    const char *const path = argument_of(scene->hal, "candump");
    if (strcmp(scene->hal, "sim") == 0) {
        self->realtime = scene->realtime != 0;
        self->clock = &self->sim_clock;
        self->mechanism = &self->sim.plant;
        *hal = mct_sim_hal(&self->sim);
        const mct_status status = mct_sim_init(&self->sim, scene, why);
        self->sim.clock = &self->sim_clock;
        if (status == MCT_OK) {
            mct_watch_start(&self->watch, &self->sim.plant, scene);
        }
        return status;
    }
    if (strcmp(scene->hal, "ring") == 0) {
        return use_ring(self, hal, why);
    }
    if (interface != NULL) {
        const mct_can_transport socket =
            mct_can_socket_transport(&self->socket, interface, (uint32_t)scene->can_bitrate);
        return use_can(self, socket, scene->can_lockstep != 0, hal, why);
    }
    if (path != NULL) {
        size_t length = 0;
        const mct_status status = read_log(self, path, &length, why);
        const mct_can_transport log = mct_can_candump_transport(&self->log, self->log_text, length);
        return status != MCT_OK ? status : use_can(self, log, true, hal, why);
    }
    mct_message_add(why, "scene.hal: found ");
    mct_message_add(why, scene->hal[0] != '\0' ? scene->hal : "nothing");
    mct_message_add(why, "; allowed sim, ring, socketcan:INTERFACE, candump:FILE");
    return MCT_ERROR_RANGE;
}

static mct_status prepare(run *self, run_result *result, mct_message *why)
{
    mct_hal hal;
    const mct_scene *scene = self->scene;
    const mct_system *system = mct_systems[scene->system];
    const run_options *options = self->options;
    self->ticks = (uint64_t)(scene->duration / scene->dt + 0.5);
    self->upright = system->actuation != NULL ? system->actuation->upright_coordinate : 0;
    self->last_second = scene->duration > 1 ? (uint64_t)((scene->duration - 1) / scene->dt + 0.5) : 0;
    self->first_fault = never;
    self->last_outside = never;
    self->least_deviation = MCT_REAL_MAX;
    self->reader.system = system;
    self->reader.effects = mct_scene_effects(scene);
    self->reader.states = mct_state_count(scene);
    mct_status status = choose_hal(self, &hal, why);
    if (status != MCT_OK) {
        return status;
    }
    status = mct_loop_init(&self->loop, &self->plan, scene, hal, wants_telemetry(self) ? &self->ring : NULL,
                           RUNNER_SAMPLES(options), why);
    self->plant = hal.ops->plant(hal.context);
    self->limit = self->loop.supervisor.limit;
    status = status != MCT_OK ? status : open_csv(self, why);
    status = status != MCT_OK ? status : start_telemetry(self, result, why);
    if (status != MCT_OK) {
        return status;
    }
    if (options->progress) {
        self->has_progress = pthread_create(&self->progress, NULL, show_progress, self) == 0;
    }
    return MCT_OK;
}

/* The ledger's next line: the mechanism's state, and what drove it there. */
static void tell_ledger(const run *self)
{
    double value[RUNNER_MAX_STATES], rest[RUNNER_MAX_STATES];
    const mct_plant *const plant = self->mechanism;
    if (self->options->ledger == NULL || plant == NULL) {
        return;
    }
    for (int i = 0; i < plant->entries; i++) {
        value[i] = (double)plant->state.x[i];
        rest[i] = (double)plant->state.c[i];
    }
    self->options->ledger_tick(self->options->ledger, value, rest, (double)plant->input);
}

static void tick(run *self)
{
    mct_loop *loop = &self->loop;
    if (*self->options->rearm != self->rearmed) {
        self->rearmed = *self->options->rearm;
        mct_loop_rearm(loop);
    }
    if (self->has_telemetry && !self->realtime && mct_ring_is_full(&self->ring)) {
        if (!self->telemetry_is_stuck) {
            wait_for_telemetry(self);
        }
    } else {
        self->telemetry_is_stuck = false;
    }
    mct_loop_tick(loop);
    if (self->mechanism == &self->sim.plant && !mct_watch_tick(&self->watch, self->mechanism)) {
        mct_supervisor_fault(&loop->supervisor, MCT_FAULT_ENERGY);
    }
    track_deviation(self, loop->tick);
    tell_ledger(self);
    const mct_real applied = loop->record.applied;
    self->saturated_ticks += applied >= self->limit || applied <= -self->limit;
    if (loop->record.faults != 0 && self->first_fault == never) {
        self->first_fault = loop->record.tick;
    }
    if (self->has_csv) {
        self->rows[self->row_count++] = loop->record;
    }
    __atomic_store_n(&self->progress_tick, loop->tick, __ATOMIC_RELAXED);
}

static void run_ticks(run *self)
{
    const mct_hal *hal = &self->loop.hal;
    const volatile int *stop = self->options->stop;
    const bool in_blocks = !self->realtime;
    track_deviation(self, 0);
    tell_ledger(self);
    while (self->loop.tick < self->ticks && *stop == 0) {
        const uint64_t left = self->ticks - self->loop.tick;
        const uint64_t end = in_blocks && left > BLOCK ? self->loop.tick + BLOCK : self->ticks;
        const int64_t begin = now_ns();
        while (self->loop.tick < end && *stop == 0) {
            tick(self);
        }
        self->loop_ns += now_ns() - begin;
        if (!in_blocks || *stop != 0) {
            hal->ops->stop(hal->context); /* zero volts before anything that may take its time */
        }
        write_rows(self);
    }
}

static void fill_state(const run *self, run_result *result)
{
    const mct_system *system = self->reader.system;
    /* What nobody simulates and nobody estimates is not known. */
    result->states = self->plant != NULL     ? self->reader.states
                     : self->loop.controlled ? 2 * mct_encoder_count(system)
                                             : 0;
    for (int i = 0; i < result->states; i++) {
        const mct_field *field = mct_state_field(system, i);
        result->names[i] = field->name;
        result->units[i] = field->unit;
        result->state[i] =
            self->plant != NULL ? mct_plant_value(self->mechanism, i) : (double)self->loop.record.estimate[i];
    }
}

static void fill_timing(const run *self, run_result *result)
{
    const mct_hal *hal = &self->loop.hal;
    const mct_timing *timing = hal->ops->timing(hal->context);
    result->timing = *timing;
    result->has_priority = self->clock->has_priority;
    result->has_memory = self->clock->has_memory;
    result->seconds = 1e-9 * (double)(now_ns() - self->started_ns);
    if (self->loop.tick > 0) {
        result->ns_per_tick = (double)(self->loop_ns - self->waiting_ns) / (double)self->loop.tick;
    }
}

static void fill_can(run *self, run_result *result)
{
    const mct_hal *hal = &self->loop.hal;
    const mct_counters counters = hal->ops->counters(hal->context);
    result->counters = counters.counters;
    result->counter_count = counters.count;
    for (int i = 0; i < counters.count; i++) {
        result->counts[i] = counters.values[i];
    }
    result->has_can = hal->context == &self->can;
    result->can = self->can.report;
    result->has_recording = self->log_text != NULL;
    result->compared = self->log.compared;
    result->mismatches = self->log.mismatches;
    result->unmatched = self->log.unmatched;
}

static void fill_result(run *self, run_result *result)
{
    const mct_supervisor *supervisor = &self->loop.supervisor;
    const double dt = self->scene->dt;
    mct_evaluation at;
    result->ticks = self->loop.tick;
    result->stopped = *self->options->stop != 0 && self->loop.tick < self->ticks;
    if (result->stopped) {
        mct_supervisor_fault(&self->loop.supervisor, MCT_FAULT_STOPPED);
    }
    result->latched = supervisor->latched;
    for (int i = 0; i < MCT_FAULT_COUNT; i++) {
        result->faults[i] = supervisor->counts[i];
    }
    result->fault_at = self->first_fault == never ? -1 : (double)self->first_fault * dt;
    result->saturated_ticks = self->saturated_ticks;
    result->limited_ticks = supervisor->limited_ticks;
    result->derated_ticks = supervisor->derated_ticks;
    if (self->mechanism != NULL) {
        result->rejected_inputs = self->mechanism->rejected_inputs;
        result->diverged_ticks = self->mechanism->diverged_ticks;
    }
    result->rearmed = supervisor->rearmed;
    result->realtime = self->realtime;
    result->limit = supervisor->limit < MCT_REAL_MAX ? (double)supervisor->limit : (double)INFINITY;
    result->controlled = self->loop.controlled;
    result->mode = mct_mode_name((mct_mode)self->loop.record.mode);
    result->deviation = (double)self->deviation;
    result->least_deviation = (double)self->least_deviation;
    result->worst_after_upright = (double)self->worst_deviation;
    result->worst_last_second = (double)self->worst_last_second;
    const uint64_t upright_tick = self->last_outside == never ? 0 : self->last_outside + 1;
    result->upright_at = self->last_outside == self->loop.tick ? -1 : (double)upright_tick * dt;
    if (self->mechanism != NULL) {
        mct_plant_evaluate(self->mechanism, &at);
        result->energy = runner_energies(&at);
        result->has_energy = true;
    }
    fill_state(self, result);
    fill_can(self, result);
}

static mct_status execute(run *self, run_result *result, mct_message *why)
{
    const mct_hal *hal = &self->loop.hal;
    mct_evaluation at;
    if (self->mechanism != NULL) {
        mct_plant_evaluate(self->mechanism, &at);
        result->energy_start = runner_energies(&at);
    }
    self->started_ns = now_ns();
    if (self->log_text != NULL) {
        mct_message_add(why, self->scene->hal + sizeof "candump");
        mct_message_add(why, ": ");
    }
    const mct_status status = hal->ops->open(hal->context, why);
    if (status == MCT_OK) {
        mct_message_clear(why);
        self->drive.held = false; /* from here on each tick moves it */
        if (hal->context == &self->can && self->options->started != NULL) {
            self->options->started(&self->can.report);
        }
        run_ticks(self);
        hal->ops->stop(hal->context);
        fill_timing(self, result);
        hal->ops->close(hal->context);
        fill_result(self, result);
    } else {
    }
    return status;
}

/* Removes a log that a run has not got to fill. */
static void discard_log(const run *self)
{
    struct stat there;
    if (is_given(self->options->log) && stat(self->options->log, &there) == 0 && S_ISREG(there.st_mode)) {
        unlink(self->options->log);
    }
}

mct_status runner_run(const mct_scene *scene, const run_options *options, run_result *result,
                      mct_message *why)
{
    run *self = need_memory(calloc(1, sizeof *self));
    memset(result, 0, sizeof *result);
    mct_message_clear(why);
    self->scene = scene;
    self->options = options;
    self->csv.file = -1;
    mct_status status = prepare(self, result, why);
    const bool prepared = status == MCT_OK;
    if (prepared) {
        status = execute(self, result, why);
    }
    if (self->has_progress) {
        __atomic_store_n(&self->progress_ends, true, __ATOMIC_RELEASE);
        pthread_join(self->progress, NULL);
    }
    stop_telemetry(self, result);
    if (status == MCT_OK && self->has_csv) {
        csv_output_close(&self->csv);
        result->csv_rows = self->csv.rows;
        result->csv_errors = self->csv.errors;
        result->csv_errno = self->csv.error;
    } else {
        csv_output_discard(&self->csv);
    }
    if (prepared && status != MCT_OK) {
        discard_log(self);
    }
    free(self->rows);
    free(self->log_text);
    free(self);
    return status;
}

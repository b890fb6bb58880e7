/*
 * A replay: the loop of the recorded scene, fed with the recorded readings, beside a simulation fed with what
 * the loop writes. Plant, sensors, estimate, voltage, mode and faults of each tick are compared with the
 * record; of a run in real time its lateness is not.
 *
 * The log is read here and not by LCM, whose reader cannot tell a log's end from damage, believes any length,
 * and prints.
 */
#include "runner_replay.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "say.h"

#if MCTAU_HAVE_LCM

#include "hal/lcm/telemetry.h"
#include "hal/sim/sim.h"
#include "mctau/loop.h"
#include "mctau_health_t.h"
#include "mctau_scene_t.h"
#include "mctau_tick_t.h"

/* --- the log: sync word, number, time, lengths of channel and data (all big-endian), channel, data --- */

static const uint32_t sync_word = 0xEDA1DA01;
enum { HEADER_SIZE = 28, LONGEST_CHANNEL = 255, LONGEST_DATA = MCT_TELEMETRY_SCENE_SIZE };

typedef enum { EVENT_READ, EVENT_END, EVENT_CUT, EVENT_DAMAGED } event_state;

typedef struct {
    FILE *file;
    const char *path;
    uint64_t count;                    /* events so far */
    char channel[LONGEST_CHANNEL + 1]; /* of the present event */
    uint32_t length;                   /* of its data; more than LONGEST_DATA has been skipped */
    uint8_t data[LONGEST_DATA];
} log_reader;

static uint32_t big_endian_32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static bool skip(FILE *file, uint32_t length)
{
    uint8_t nowhere[4096];
    for (uint32_t left = length; left > 0;) {
        const uint32_t part = left < sizeof nowhere ? left : (uint32_t)sizeof nowhere;
        if (fread(nowhere, 1, part, file) != part) {
            return false;
        }
        left -= part;
    }
    return true;
}

static event_state read_event(log_reader *self)
{
    uint8_t header[HEADER_SIZE];
    const size_t got = fread(header, 1, sizeof header, self->file);
    if (got == 0) {
        return EVENT_END;
    }
    if (got >= 4 && big_endian_32(header) != sync_word) {
        return EVENT_DAMAGED;
    }
    if (got < sizeof header) {
        return EVENT_CUT;
    }
    const uint32_t channel_length = big_endian_32(header + 20);
    self->length = big_endian_32(header + 24);
    if (channel_length == 0 || channel_length > LONGEST_CHANNEL || self->length > INT32_MAX) {
        return EVENT_DAMAGED;
    }
    if (fread(self->channel, 1, channel_length, self->file) != channel_length) {
        return EVENT_CUT;
    }
    self->channel[channel_length] = '\0';
    const bool fits = self->length <= LONGEST_DATA;
    if (fits ? fread(self->data, 1, self->length, self->file) != self->length
             : !skip(self->file, self->length)) {
        return EVENT_CUT;
    }
    self->count++;
    return EVENT_READ;
}

static bool is_on(const log_reader *self, const char *channel)
{
    return strcmp(self->channel, channel) == 0;
}

/* "run.lcm: " */
static void begin_sentence(const log_reader *self, mct_message *why)
{
    mct_message_clear(why);
    mct_message_add(why, self->path);
    mct_message_add(why, ": ");
}

static mct_status say_damaged(const log_reader *self, mct_message *why)
{
    begin_sentence(self, why);
    if (self->count == 0) {
        mct_message_add(why, "found something else than an event log");
    } else {
        mct_message_add(why, "the log is damaged after event ");
        mct_message_add_integer(why, (long long)self->count - 1);
    }
    return MCT_ERROR_SYNTAX;
}

/* --- data of an event, read within its bounds --- */

typedef struct {
    const uint8_t *at;
    uint32_t left;
    bool failed;
} cursor;

static uint32_t take_32(cursor *self)
{
    if (self->left < 4) {
        self->failed = true;
        return 0;
    }
    const uint32_t value = big_endian_32(self->at);
    self->at += 4;
    self->left -= 4;
    return value;
}

static uint64_t take_64(cursor *self)
{
    const uint64_t high = take_32(self);
    return high << 32 | take_32(self);
}

/* A string, which ends in a NUL that its length counts; "" on failure. */
static const char *take_string(cursor *self)
{
    const uint32_t length = take_32(self);
    if (self->failed || length == 0 || length > self->left || self->at[length - 1] != 0) {
        self->failed = true;
        return "";
    }
    const char *const string = (const char *)self->at;
    self->at += length;
    self->left -= length;
    return string;
}

/* --- the replay --- */

typedef struct {
    log_reader log;
    replay_result *result;
    mct_message *why;
    mct_scene scene;
    mct_sim sim;
    mct_loop loop;
    mct_plan plan;
    bool simulated;        /* else the plant was real, and the loop alone is compared */
    bool paced;            /* by a clock: how late a tick was is not in the scene */
    bool ended;            /* the log's last message has come */
    mctau_tick_t recorded; /* the present tick, in the arrays of which there is room below */
    mct_reading given;     /* its reading */
    mct_reading sensed;    /* the simulation's */
    mct_real wanted;       /* its input asked for, for inputs of kind csv */
    mct_timing timing;
    uint32_t injected; /* faults from outside that were latched at the last tick, see inject_faults */
} replay;

/* --- a HAL that gives the recorded readings --- */

static mct_status replay_open(void *context, mct_message *why)
{
    replay *self = context;
    const mct_hal hal = mct_sim_hal(&self->sim);
    return self->simulated ? hal.ops->open(hal.context, why) : MCT_OK;
}

static mct_status replay_read(void *context, mct_reading *reading)
{
    replay *self = context;
    const mct_hal hal = mct_sim_hal(&self->sim);
    *reading = self->given;
    return self->simulated ? hal.ops->read(hal.context, &self->sensed) : MCT_OK;
}

static mct_status replay_write(void *context, mct_real input)
{
    replay *self = context;
    const mct_hal hal = mct_sim_hal(&self->sim);
    return self->simulated ? hal.ops->write(hal.context, input) : MCT_OK;
}

static mct_status replay_wait_tick(void *context)
{
    replay *self = context;
    const mct_hal hal = mct_sim_hal(&self->sim);
    return self->simulated ? hal.ops->wait_tick(hal.context) : MCT_OK;
}

static void replay_stop(void *context)
{
    replay *self = context;
    const mct_hal hal = mct_sim_hal(&self->sim);
    hal.ops->stop(hal.context);
}

static void replay_arm(void *context)
{
    (void)context; /* the recorded readings tell when the drive was ready */
}

static const mct_state *replay_plant(void *context)
{
    const replay *self = context;
    return self->simulated ? &self->sim.plant.state : NULL;
}

static const mct_timing *replay_timing(void *context)
{
    const replay *self = context;
    return &self->timing;
}

static mct_counters replay_counters(void *context)
{
    (void)context;
    return (mct_counters){0};
}

static const mct_hal_ops replay_ops = {
    .name = "replay",
    .open = replay_open,
    .read = replay_read,
    .write = replay_write,
    .wait_tick = replay_wait_tick,
    .stop = replay_stop,
    .arm = replay_arm,
    .close = replay_stop,
    .plant = replay_plant,
    .timing = replay_timing,
    .counters = replay_counters,
};

/* --- comparing --- */

/* Keeps the first difference of the present tick. */
static void differ(replay *self, const char *field, const char *part, double recorded, double replayed)
{
    replay_result *result = self->result;
    if (!result->equal) {
        return;
    }
    result->equal = false;
    result->first_tick = self->loop.tick - 1;
    result->recorded = recorded;
    result->replayed = replayed;
    snprintf(result->field, sizeof result->field, "%s%s%s", field, part[0] != '\0' ? "." : "", part);
}

static void compare_integer(replay *self, const char *field, const char *part, int64_t recorded,
                            int64_t replayed)
{
    if (recorded != replayed) {
        differ(self, field, part, (double)recorded, (double)replayed);
    }
}

/* By their bits: zeros have signs, and a value that is not a number equals itself. */
static void compare_real(replay *self, const char *field, const char *part, double recorded, mct_real result)
{
    const double replayed = (double)result;
    if (memcmp(&recorded, &replayed, sizeof recorded) != 0) {
        differ(self, field, part, recorded, replayed);
    }
}

static void compare_reals(replay *self, const char *field, int count, const double *recorded,
                          const mct_real *replayed)
{
    const mct_system *system = mct_systems[self->scene.system];
    for (int i = 0; i < count; i++) {
        compare_real(self, field, mct_state_field(system, i)->name, recorded[i], replayed[i]);
    }
}

static void compare_integers(replay *self, const char *field, int count, const int32_t *recorded,
                             const int32_t *replayed)
{
    const mct_system *system = mct_systems[self->scene.system];
    for (int i = 0; i < count; i++) {
        compare_integer(self, field, mct_state_field(system, i)->name, recorded[i], replayed[i]);
    }
}

/* In the order in which a tick computes them, so that the first one found is the first one wrong. */
static void compare_tick(replay *self)
{
    const mctau_tick_t *recorded = &self->recorded;
    const mct_record *record = &self->loop.record;
    const int coordinates = recorded->coordinates;
    compare_integer(self, "utime", "", recorded->utime,
                    (int64_t)((double)record->tick * self->scene.dt * 1e6 + 0.5));
    compare_integer(self, "sequence", "", recorded->sequence, (int64_t)record->tick);
    if (self->simulated) {
        compare_reals(self, "state", recorded->states, recorded->x, record->plant.x);
        compare_reals(self, "compensation", recorded->states, recorded->c, record->plant.c);
        compare_integers(self, "turns", coordinates, recorded->turns, record->plant.turns);
        compare_integers(self, "counts", recorded->encoders, recorded->counts, self->sensed.counts);
        compare_integer(self, "age_us", "", recorded->age_us, self->sensed.age_us);
        compare_integer(self, "flags", "", recorded->flags, (int32_t)self->sensed.flags);
    }
    compare_reals(self, "estimate", recorded->estimates, recorded->estimate, record->estimate);
    compare_real(self, "wanted", "", recorded->wanted, record->wanted);
    compare_real(self, "applied", "", recorded->applied, record->applied);
    compare_integer(self, "mode", "", recorded->mode, record->mode);
    compare_integer(self, "faults", "", recorded->faults, (int32_t)record->faults);
    compare_integer(self, "dropped", "", recorded->dropped, 0); /* or there would be a gap */
    compare_integer(self, "rearmed", "", recorded->rearmed, record->rearmed);
    if (!self->paced) {
        compare_integer(self, "late_us", "", recorded->late_us, 0);
    }
}

/* --- a tick --- */

/* Whether a tick's data has the length that the scene's arrays give it: only then is it safe to decode. */
static bool has_tick_shape(const replay *self)
{
    enum { COUNTS_AT = 8 + 3 * 8 }; /* behind the type's hash, utime, sequence and tick */
    const mct_system *system = mct_systems[self->scene.system];
    const mctau_tick_t shape = {.coordinates = system->coordinate_count,
                                .states = mct_state_count(&self->scene),
                                .encoders = mct_encoder_count(system),
                                .estimates = 2 * mct_encoder_count(system)};
    const uint8_t *data = self->log.data;
    return self->log.length == (uint32_t)mctau_tick_t_encoded_size(&shape) &&
           big_endian_32(data + COUNTS_AT) == (uint32_t)shape.coordinates &&
           big_endian_32(data + COUNTS_AT + 4) == (uint32_t)shape.states &&
           big_endian_32(data + COUNTS_AT + 8) == (uint32_t)shape.encoders &&
           big_endian_32(data + COUNTS_AT + 12) == (uint32_t)shape.estimates;
}

/* A HAL that fails, a stop, and energy from nowhere, come from outside: they are latched here as they were in the run. They leave
 * no voltage. */
static void inject_faults(replay *self)
{
    const uint32_t outside = 1u << MCT_FAULT_HAL | 1u << MCT_FAULT_STOPPED | 1u << MCT_FAULT_ENERGY;
    const uint32_t recorded = (uint32_t)self->recorded.faults;
    const uint32_t new_ones = recorded & outside & ~self->loop.supervisor.latched;
    self->injected = self->recorded.applied == 0 ? new_ones : 0;
    for (int fault = 0; fault < MCT_FAULT_COUNT; fault++) {
        if (self->injected & (1u << fault)) {
            mct_supervisor_fault(&self->loop.supervisor, (mct_fault)fault);
        }
    }
}

/* A fault that was taken for one from outside, and that the next tick does not know: that tick was not as
 * recorded. */
static bool is_taken_back(const replay *self)
{
    return (self->injected & ~(uint32_t)self->recorded.faults) != 0;
}

static mct_status say_missing(replay *self, mct_message *why)
{
    begin_sentence(&self->log, why);
    mct_message_add(why, "found tick ");
    mct_message_add_integer(why, (long long)self->recorded.tick);
    mct_message_add(why, " where tick ");
    mct_message_add_integer(why, (long long)self->loop.tick);
    mct_message_add(why, " should be; what follows a gap cannot be replayed");
    return MCT_ERROR_IO;
}

static mct_status replay_decoded(replay *self)
{
    const mctau_tick_t *recorded = &self->recorded;
    replay_result *result = self->result;
    if ((uint64_t)recorded->tick != self->loop.tick) {
        return say_missing(self, self->why);
    }
    if (is_taken_back(self)) {
        const uint32_t faults = self->loop.record.faults;
        differ(self, "faults", "", (double)faults, (double)(faults & ~self->injected));
        return MCT_OK;
    }
    memset(&self->given, 0, sizeof self->given);
    for (int i = 0; i < recorded->encoders; i++) {
        self->given.counts[i] = recorded->counts[i];
    }
    self->given.age_us = (uint32_t)recorded->age_us;
    self->given.flags = (uint32_t)recorded->flags;
    self->wanted = (mct_real)recorded->wanted;
    inject_faults(self);
    if (recorded->rearmed) {
        mct_loop_rearm(&self->loop);
    }
    mct_loop_tick(&self->loop);
    compare_tick(self);
    result->ticks += result->equal;
    return MCT_OK;
}

static mct_status replay_tick(replay *self)
{
    if (!has_tick_shape(self)) {
        return say_damaged(&self->log, self->why);
    }
    memset(&self->recorded, 0, sizeof self->recorded);
    const int length = mctau_tick_t_decode(self->log.data, 0, (int)self->log.length, &self->recorded);
    const mct_status status = length > 0 ? replay_decoded(self) : say_damaged(&self->log, self->why);
    mctau_tick_t_decode_cleanup(&self->recorded);
    return status;
}

/* --- the scene --- */

static mct_status say_version(const replay *self)
{
    begin_sentence(&self->log, self->why);
    mct_message_add(self->why, "the log comes from another version of mctau");
    return MCT_ERROR_UNSUITED;
}

static mct_status check_precision(const replay *self, const char *precision)
{
    const char *const own = MCT_REAL_IS_FLOAT ? "float" : "double";
    if (strcmp(precision, own) == 0) {
        return MCT_OK;
    }
    begin_sentence(&self->log, self->why);
    mct_message_add(self->why, "found a log in ");
    mct_message_add(self->why, precision);
    mct_message_add(self->why, " precision; this replays ");
    mct_message_add(self->why, own);
    return MCT_ERROR_UNSUITED;
}

/* Reads what the scene's message begins with; the rest is for other listeners. */
static mct_status read_scene(replay *self)
{
    cursor at = {self->log.data, self->log.length, false};
    mct_override overrides[MCT_MAX_OVERRIDES];
    if (take_64(&at) != (uint64_t)__mctau_scene_t_get_hash()) {
        return at.failed ? say_damaged(&self->log, self->why) : say_version(self);
    }
    take_64(&at); /* time */
    take_64(&at); /* sequence */
    const uint32_t version = take_32(&at);
    const char *const precision = take_string(&at);
    const char *const text = take_string(&at);
    const uint32_t count = take_32(&at);
    if (at.failed || count > MCT_MAX_OVERRIDES) {
        return say_damaged(&self->log, self->why);
    }
    for (uint32_t i = 0; i < count; i++) {
        overrides[i] = (mct_override){take_string(&at), self->log.path};
    }
    if (at.failed) {
        return say_damaged(&self->log, self->why);
    }
    if (version != MCT_TELEMETRY_VERSION) {
        return say_version(self);
    }
    const mct_status status = check_precision(self, precision);
    return status != MCT_OK ? status
                            : mct_scene_read(text, strlen(text), self->log.path, overrides, (int)count,
                                             &self->scene, self->why);
}

static mct_status prepare(replay *self)
{
    const mct_hal hal = {&replay_ops, self};
    mct_status status = read_scene(self);
    if (status != MCT_OK) {
        return status;
    }
    const bool paced = self->scene.realtime != 0;
    self->scene.realtime = 0; /* the clock has no say in the results */
    self->simulated = strcmp(self->scene.hal, "sim") == 0;
    self->paced = paced || !self->simulated;
    status = mct_sim_init(&self->sim, &self->scene, self->why);
    if (status != MCT_OK) {
        return status;
    }
    /* The one sample of a csv input is set before each tick. */
    status = mct_loop_init(&self->loop, &self->plan, &self->scene, hal, NULL, (mct_samples){&self->wanted, 1},
                           self->why);
    return status != MCT_OK ? status : hal.ops->open(hal.context, self->why);
}

/* --- from beginning to end --- */

static bool is_another_type(const log_reader *log, int64_t hash)
{
    cursor at = {log->data, log->length, false};
    return take_64(&at) != (uint64_t)hash && !at.failed;
}

static mct_status replay_event(replay *self)
{
    const log_reader *log = &self->log;
    if (is_on(log, MCT_CHANNEL_TICK)) {
        const bool foreign = self->loop.tick == 0 && is_another_type(log, __mctau_tick_t_get_hash());
        return foreign ? say_version(self) : replay_tick(self);
    }
    if (is_on(log, MCT_CHANNEL_HEALTH)) {
        self->ended = log->length > 0 && log->length <= LONGEST_DATA && log->data[log->length - 1] != 0;
    }
    return MCT_OK;
}

/* The first scene, made ready; what stands before it is passed over. */
static mct_status find_scene(replay *self)
{
    event_state state = read_event(&self->log);
    const bool empty = state == EVENT_END;
    while (state == EVENT_READ && !is_on(&self->log, MCT_CHANNEL_SCENE)) {
        state = read_event(&self->log);
    }
    if (state == EVENT_READ) {
        return self->log.length <= LONGEST_DATA ? prepare(self) : say_damaged(&self->log, self->why);
    }
    if (state == EVENT_DAMAGED) {
        return say_damaged(&self->log, self->why);
    }
    begin_sentence(&self->log, self->why);
    mct_message_add(self->why, empty                ? "the log is empty"
                               : state == EVENT_CUT ? "the log ends before its scene is complete"
                                                    : "the log holds no scene (channel " MCT_CHANNEL_SCENE
                                                      "); was it made by mctau?");
    return MCT_ERROR_IO;
}

static mct_status replay_log(replay *self)
{
    mct_status status = find_scene(self);
    event_state state = EVENT_READ;
    self->result->equal = status == MCT_OK;
    while (status == MCT_OK && state == EVENT_READ && self->result->equal) {
        state = read_event(&self->log);
        if (state == EVENT_READ) {
            status = replay_event(self);
        } else if (state == EVENT_DAMAGED) {
            status = say_damaged(&self->log, self->why);
        }
    }
    if (ferror(self->log.file)) {
        begin_sentence(&self->log, self->why);
        mct_message_add(self->why, "the log cannot be read to its end");
        status = MCT_ERROR_IO;
    }
    self->result->truncated = state == EVENT_CUT || (state == EVENT_END && !self->ended);
    self->result->equal = self->result->equal && status == MCT_OK;
    return status;
}

mct_status runner_replay(const char *log, replay_result *result, mct_message *why)
{
    memset(result, 0, sizeof *result);
    mct_message_clear(why);
    FILE *file = fopen(log, "rb");
    if (file == NULL) {
        mct_message_add(why, log);
        mct_message_add(why, ": the log cannot be read: ");
        mct_message_add(why, strerror(errno));
        return MCT_ERROR_IO;
    }
    replay *self = need_memory(calloc(1, sizeof *self));
    self->log.file = file;
    self->log.path = log;
    self->result = result;
    self->why = why;
    const mct_status status = replay_log(self);
    free(self);
    fclose(file);
    return status;
}

#else

mct_status runner_replay(const char *log, replay_result *result, mct_message *why)
{
    memset(result, 0, sizeof *result);
    mct_message_clear(why);
    mct_message_add(why, log);
    mct_message_add(why, ": this mctau was built without LCM and cannot read logs");
    return MCT_ERROR_IO;
}

#endif

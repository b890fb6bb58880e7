#ifndef _POSIX_C_SOURCE
#define _POSIX_C_SOURCE 200809L
#endif

#include "hal/lcm/telemetry.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <lcm/lcm.h>
#include <sched.h>
#include <signal.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "mctau/controller.h"
#include "mctau/stepper.h"
#include "mctau_health_t.h"
#include "mctau_scene_t.h"
#include "mctau_tick_t.h"

enum {
    TICK_SIZE = 128 + 4 * MCT_MAX_COORDINATES + 20 * MCT_MAX_ENCODERS +
                16 * MCT_MAX_STATES, /* of a tick_t, at most */
    HEALTH_SIZE =
        256 + 8 * (4 * (MCT_HISTOGRAM_BINS + 1) + MCT_FAULT_COUNT + MCT_MODE_COUNT + MCT_MAX_COUNTERS),
    NO_FILE = -1,
    MOST_WRITES = 1000,     /* of one buffer */
    EVENT_HEADER = 28,      /* bytes of a log's event before its channel */
    HEALTHS_PER_SCENE = 10, /* the scene is repeated every second */
    STACK_SIZE = 256 * 1024,
    NAP_NS = 200000 /* while the ring is empty */
};
#define SYNC_WORD 0xEDA1DA01             /* that an event begins with */
static const double health_period = 0.1; /* [s] */

static int64_t microseconds(const mct_telemetry *self, uint64_t tick)
{
    return (int64_t)((double)tick * self->scene->dt * 1e6 + 0.5);
}

/* --- the log --- */

/* The log has refused something, which may be on the disk in part: it is taken back to the last event that is
 * whole, and the log is closed. */
static void fail_log(mct_telemetry *self, int reason)
{
    mct_telemetry_log *log = &self->log;
    self->counts.log_errors += log->waiting_events;
    self->counts.first_log_errno = reason;
    if (ftruncate(log->file, (off_t)log->kept_bytes) != 0) {
        /* a device or a pipe: nothing to take back */
    }
    close(log->file);
    log->file = NO_FILE;
}

/* @return 0, or why not all of it was written */
static int write_all(int file, const uint8_t *bytes, size_t length)
{
    int reason = EIO; /* nothing is written, and nobody says why */
    for (int tries = 0; length > 0 && tries < MOST_WRITES; tries++) {
        const ssize_t written = write(file, bytes, length);
        if (written > 0) {
            bytes += written;
            length -= (size_t)written;
        } else if (written < 0) {
            reason = errno;
            tries = reason == EINTR ? tries : MOST_WRITES;
        }
    }
    return length > 0 ? reason : 0;
}

static void flush_log(mct_telemetry *self)
{
    mct_telemetry_log *log = &self->log;
    if (log->file == NO_FILE) {
        return;
    }
    const int reason = write_all(log->file, log->buffer, log->waiting_bytes);
    if (reason != 0) {
        fail_log(self, reason);
        return;
    }
    self->counts.logged += log->waiting_records;
    log->kept_bytes += log->waiting_bytes;
    log->waiting_bytes = 0;
    log->waiting_events = 0;
    log->waiting_records = 0;
}

static uint8_t *put_big_endian(uint8_t *at, uint64_t value, int bytes)
{
    for (int i = bytes - 1; i >= 0; i--) {
        *at++ = (uint8_t)(value >> 8 * i);
    }
    return at;
}

static uint8_t *put_bytes(uint8_t *at, const void *bytes, size_t length)
{
    memcpy(at, bytes, length);
    return at + length;
}

/* Written by hand and not by LCM, which buffers by stdio: so each write ends with an event, it is known which of
 * them the disk has, and nothing is allocated. */
static void write_log(mct_telemetry *self, const char *channel, int64_t utime, const uint8_t *data,
                      int length)
{
    mct_telemetry_log *log = &self->log;
    const size_t channel_length = strlen(channel);
    const size_t bytes = EVENT_HEADER + channel_length + (size_t)length;
    if (!log->wanted) {
        return;
    }
    if (log->waiting_bytes + bytes > sizeof log->buffer) {
        flush_log(self);
    }
    if (log->file == NO_FILE) {
        self->counts.log_errors++;
        return;
    }
    uint8_t *at = log->buffer + log->waiting_bytes;
    at = put_big_endian(at, SYNC_WORD, 4);
    at = put_big_endian(at, log->events++, 8);
    at = put_big_endian(at, (uint64_t)utime, 8);
    at = put_big_endian(at, channel_length, 4);
    at = put_big_endian(at, (uint64_t)length, 4);
    at = put_bytes(at, channel, channel_length);
    put_bytes(at, data, (size_t)length);
    log->waiting_bytes += bytes;
    log->waiting_events++;
    log->waiting_records += strcmp(channel, MCT_CHANNEL_TICK) == 0;
}

/* On the disk, as far as there is one: an error of writing may show as late as now. */
static bool is_synced(int file)
{
    return fsync(file) == 0 || errno == EINVAL || errno == EROFS || errno == ENOTSUP;
}

static void close_log(mct_telemetry *self)
{
    mct_telemetry_log *log = &self->log;
    flush_log(self);
    if (log->file == NO_FILE) {
        return;
    }
    const int sync_error = is_synced(log->file) ? 0 : errno;
    const int close_error = close(log->file) == 0 ? 0 : errno;
    log->file = NO_FILE;
    self->counts.first_log_errno = sync_error != 0 ? sync_error : close_error;
}

/* --- messages --- */

static bool publish(mct_telemetry *self, const char *channel, const uint8_t *data, int length)
{
    if (self->lcm == NULL) {
        return false;
    }
    const bool taken = lcm_publish(self->lcm, channel, data, (unsigned)length) == 0;
    self->counts.publish_errors += !taken;
    return taken;
}

static void copy_reals(const mct_real *from, int count, double *to)
{
    for (int i = 0; i < count; i++) {
        to[i] = (double)from[i];
    }
}

static void send_tick(mct_telemetry *self, const mct_record *record)
{
    uint8_t data[TICK_SIZE];
    double estimate[2 * MCT_MAX_ENCODERS];
    double x[MCT_MAX_STATES];
    double c[MCT_MAX_STATES];
    copy_reals(record->estimate, 2 * self->encoders, estimate);
    copy_reals(record->plant.x, self->states, x);
    copy_reals(record->plant.c, self->states, c);
    const mctau_tick_t message = {
        .utime = microseconds(self, record->tick),
        .sequence = (int64_t)self->counts.records,
        .tick = (int64_t)record->tick,
        .coordinates = self->coordinates,
        .states = self->states,
        .encoders = self->encoders,
        .estimates = 2 * self->encoders,
        .counts = (int32_t *)record->reading.counts,
        .age_us = record->reading.age_us,
        .flags = (int32_t)record->reading.flags,
        .estimate = estimate,
        .wanted = (double)record->wanted,
        .applied = (double)record->applied,
        .mode = record->mode,
        .faults = (int32_t)record->faults,
        .rearmed = record->rearmed,
        .late_us = record->late_us,
        .dropped = (int64_t)record->dropped,
        .x = x,
        .c = c,
        .turns = (int32_t *)record->plant.turns,
    };
    const int length = mctau_tick_t_encode(data, 0, sizeof data, &message);
    self->counts.published += publish(self, MCT_CHANNEL_TICK, data, length);
    write_log(self, MCT_CHANNEL_TICK, message.utime, data, length);
    self->counts.records++;
}

/* The loop may be adding to it; returns the worst. */
static int64_t copy_histogram(const mct_histogram *from, int64_t to[MCT_HISTOGRAM_BINS])
{
    for (int i = 0; i < MCT_HISTOGRAM_BINS; i++) {
        to[i] = (int64_t)__atomic_load_n(&from->bins[i], __ATOMIC_RELAXED);
    }
    return __atomic_load_n(&from->worst_us, __ATOMIC_RELAXED);
}

static void send_health(mct_telemetry *self, bool finished)
{
    const mct_telemetry_health *health = &self->health;
    int64_t counters[MCT_MAX_COUNTERS];
    for (int i = 0; i < self->counters.count; i++) {
        counters[i] = (int64_t)__atomic_load_n(&self->counters.values[i], __ATOMIC_RELAXED);
    }
    uint8_t data[HEALTH_SIZE];
    mctau_health_t message = {
        .utime = microseconds(self, health->tick),
        .sequence = self->health.messages++,
        .tick = (int64_t)health->tick,
        .records = (int64_t)self->counts.records,
        .dropped = (int64_t)health->dropped,
        .publish_errors = (int64_t)self->counts.publish_errors,
        .log_errors = (int64_t)self->counts.log_errors,
        .worst_late_us = health->lateness.worst_us,
        .worst_age_us = health->age.worst_us,
        .counter_count = self->counters.count,
        .counters = counters,
        .faults = (int32_t)health->faults,
        .fault_count = MCT_FAULT_COUNT,
        .fault_ticks = (int64_t *)health->fault_ticks,
        .mode_count = MCT_MODE_COUNT,
        .mode_ticks = (int64_t *)health->mode_ticks,
        .finished = finished,
    };
    copy_histogram(&health->lateness, message.lateness);
    copy_histogram(&health->age, message.age);
    if (self->timing != NULL) {
        message.missed_ticks = (int64_t)__atomic_load_n(&self->timing->missed_ticks, __ATOMIC_RELAXED);
        message.worst_work_us = copy_histogram(&self->timing->work, message.work);
        message.worst_round_trip_us = copy_histogram(&self->timing->round_trip, message.round_trip);
    }
    const int length = mctau_health_t_encode(data, 0, sizeof data, &message);
    publish(self, MCT_CHANNEL_HEALTH, data, length);
    if (self->health.messages % HEALTHS_PER_SCENE == 0) {
        publish(self, MCT_CHANNEL_SCENE, self->scene_message, self->scene_length);
    }
    write_log(self, MCT_CHANNEL_HEALTH, message.utime, data, length);
    flush_log(self); /* who reads the log while it grows is a tenth of a second behind */
}

/* --- the thread --- */

static void account(mct_telemetry_health *health, const mct_record *record)
{
    mct_histogram_add(&health->lateness, record->late_us);
    mct_histogram_add(&health->age, record->reading.age_us);
    health->tick = record->tick;
    health->dropped = record->dropped;
    health->faults = record->faults;
    for (uint32_t fault = 0, bits = record->faults; bits != 0 && fault < MCT_FAULT_COUNT;
         fault++, bits >>= 1) {
        health->fault_ticks[fault] += bits & 1;
    }
    if ((unsigned)record->mode < MCT_MODE_COUNT) {
        health->mode_ticks[record->mode]++;
    }
}

static void drain(mct_telemetry *self)
{
    for (const mct_record *record = mct_ring_peek(self->ring); record != NULL;
         record = mct_ring_peek(self->ring)) {
        mct_telemetry_health *health = &self->health;
        send_tick(self, record);
        account(health, record);
        mct_ring_pop(self->ring);
        if (health->tick >= health->next_tick) {
            health->next_tick = health->tick - health->tick % health->period + health->period;
            send_health(self, false);
        }
    }
}

static void *run(void *argument)
{
    mct_telemetry *self = argument;
    const struct timespec nap = {.tv_sec = 0, .tv_nsec = NAP_NS};
    for (bool last = false; !last;) {
        last = __atomic_load_n(&self->stopping, __ATOMIC_ACQUIRE); /* first: then all is drained */
        drain(self);
        if (!last) {
            nanosleep(&nap, NULL);
        }
    }
    self->health.dropped = __atomic_load_n(&self->ring->dropped, __ATOMIC_ACQUIRE);
    send_health(self, true);
    close_log(self);
    return NULL;
}

/* A thread that leaves signals to others, and is not urgent whatever its maker is. */
static int start_thread(mct_telemetry *self)
{
    const struct sched_param priority = {.sched_priority = 0};
    pthread_attr_t attributes;
    sigset_t all;
    sigset_t before;
    int status = pthread_attr_init(&attributes);
    if (status != 0) {
        return status;
    }
    pthread_attr_setstacksize(&attributes, STACK_SIZE);
    pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
    pthread_attr_setschedpolicy(&attributes, SCHED_OTHER);
    pthread_attr_setschedparam(&attributes, &priority);
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    status = pthread_create(&self->thread, &attributes, run, self);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    pthread_attr_destroy(&attributes);
    return status;
}

/* --- the scene --- */

/* Splits off the overrides: the last lines that begin with the mark. The text is cut in place; returns their
 * number, or -1 when they are too many. */
static int split_overrides(char *text, char *overrides[MCT_MAX_OVERRIDES])
{
    const size_t mark = sizeof MCT_OVERRIDE_MARK - 1;
    size_t end = strlen(text);
    int count = 0;
    while (end > 0) {
        const size_t stop = text[end - 1] == '\n' ? end - 1 : end;
        size_t start = stop;
        while (start > 0 && text[start - 1] != '\n') {
            start--;
        }
        if (stop - start < mark || memcmp(text + start, MCT_OVERRIDE_MARK, mark) != 0) {
            break;
        }
        if (count == MCT_MAX_OVERRIDES) {
            return -1;
        }
        text[stop] = '\0';
        overrides[count++] = text + start + mark;
        end = start;
    }
    text[end] = '\0';
    for (int i = 0; i < count / 2; i++) {
        char *const other = overrides[i];
        overrides[i] = overrides[count - 1 - i];
        overrides[count - 1 - i] = other;
    }
    return count;
}

/* Encodes the scene. Its text is taken apart in the log's buffer, which nobody uses yet. */
static mct_status encode_scene(mct_telemetry *self, const char *text)
{
    const mct_scene *scene = self->scene;
    const mct_system *system = mct_systems[scene->system];
    char *copy = (char *)self->log.buffer;
    char *overrides[MCT_MAX_OVERRIDES];
    char *names[MCT_MAX_STATES];
    char *units[MCT_MAX_STATES];
    char *modes[MCT_MODE_COUNT];
    char *faults[MCT_FAULT_COUNT];
    char *counters[MCT_MAX_COUNTERS];
    const size_t length = strlen(text);
    if (length >= sizeof self->log.buffer) {
        return MCT_ERROR_BOUND;
    }
    memcpy(copy, text, length + 1);
    const int override_count = split_overrides(copy, overrides);
    if (override_count < 0) {
        return MCT_ERROR_BOUND;
    }
    for (int i = 0; i < self->states; i++) {
        names[i] = (char *)mct_state_field(system, i)->name;
        units[i] = (char *)mct_state_field(system, i)->unit;
    }
    for (int i = 0; i < MCT_MODE_COUNT; i++) {
        modes[i] = (char *)mct_mode_name((mct_mode)i);
    }
    for (int i = 0; i < MCT_FAULT_COUNT; i++) {
        faults[i] = (char *)mct_fault_name((mct_fault)i);
    }
    for (int i = 0; i < self->counters.count; i++) {
        counters[i] = (char *)self->counters.counters[i].name;
    }
    const mct_field *plain = system->input_without_motor;
    const char *unit = scene->effects & MCT_MOTOR ? "V" : plain != NULL ? plain->unit : "";
    const mctau_scene_t message = {
        .version = MCT_TELEMETRY_VERSION,
        .precision = (char *)(MCT_REAL_IS_FLOAT ? "float" : "double"),
        .text = copy,
        .override_count = override_count,
        .overrides = overrides,
        .release = (char *)MCT_VERSION,
        .system = (char *)system->name,
        .stepper = (char *)mct_steppers[scene->stepper].name,
        .dt = scene->dt,
        .input_unit = (char *)unit,
        .states = self->states,
        .state_names = names,
        .state_units = units,
        .coordinates = self->coordinates,
        .mode_count = MCT_MODE_COUNT,
        .mode_names = modes,
        .fault_count = MCT_FAULT_COUNT,
        .fault_names = faults,
        .counter_count = self->counters.count,
        .counter_names = counters,
    };
    self->scene_length = mctau_scene_t_encode(self->scene_message, 0, sizeof self->scene_message, &message);
    return self->scene_length > 0 ? MCT_OK : MCT_ERROR_BOUND;
}

/* --- start and stop --- */

static bool is_given(const char *text)
{
    return text != NULL && text[0] != '\0';
}

static void explain(mct_message *why, const char *what, const char *name, int reason)
{
    char text[128];
    mct_message_add(why, what);
    mct_message_add(why, name);
    if (reason != 0 && strerror_r(reason, text, sizeof text) == 0) {
        mct_message_add(why, ": ");
        mct_message_add(why, text);
    }
}

/* Address of "udpm://ADDRESS:PORT?...", LCM's own where none is given; false when it is none. */
static bool read_url(const char *url, struct sockaddr_in *address)
{
    static const char provider[] = "udpm://";
    const size_t start = sizeof provider - 1;
    char text[INET_ADDRSTRLEN] = "239.255.76.67";
    if (strncmp(url, provider, start) != 0) {
        return false;
    }
    const size_t length = strcspn(url + start, ":?");
    if (length >= sizeof text) {
        return false;
    }
    if (length > 0) {
        memcpy(text, url + start, length);
        text[length] = '\0';
    }
    memset(address, 0, sizeof *address);
    address->sin_family = AF_INET;
    address->sin_port = htons(7667);
    return inet_pton(AF_INET, text, &address->sin_addr) == 1 && IN_MULTICAST(ntohl(address->sin_addr.s_addr));
}

/* Whether there is a route to an address: connecting a datagram's socket sends nothing. LCM says so, too, but
 * on stderr. */
static int find_route(const struct sockaddr_in *address)
{
    const int test = socket(AF_INET, SOCK_DGRAM, 0);
    const bool found = test >= 0 && connect(test, (const struct sockaddr *)address, sizeof *address) == 0;
    const int reason = found ? 0 : errno;
    if (test >= 0) {
        close(test);
    }
    return reason;
}

static mct_status open_lcm(mct_telemetry *self, const char *url, mct_message *why)
{
    struct sockaddr_in address;
    if (!read_url(url, &address)) {
        explain(why, "telemetry.lcm: found ", url, 0);
        mct_message_add(why, "; allowed udpm://ADDRESS:PORT?ttl=N, 224.0.0.0 to 239.255.255.255");
        return MCT_ERROR_ARGUMENT;
    }
    const int reason = find_route(&address);
    self->lcm = reason == 0 ? lcm_create(url) : NULL;
    if (self->lcm == NULL) {
        explain(why, "no telemetry over the network: LCM cannot use ", url, reason);
        mct_message_add(why, reason == ENETUNREACH
                                 ? "; on one machine, 'ip route add 224.0.0.0/4 dev lo' gives a route"
                                 : "");
    }
    /* With its first message LCM allocates, and never again. */
    publish(self, MCT_CHANNEL_SCENE, self->scene_message, self->scene_length);
    return MCT_OK;
}

static mct_status open_log(mct_telemetry *self, const char *path, mct_message *why)
{
    self->log.file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (self->log.file == NO_FILE) {
        mct_message_clear(why);
        explain(why, "cannot write the log ", path, errno);
        return MCT_ERROR_IO;
    }
    self->log.wanted = true;
    write_log(self, MCT_CHANNEL_SCENE, 0, self->scene_message, self->scene_length);
    flush_log(self);
    return MCT_OK;
}

static void abandon(mct_telemetry *self, const char *log)
{
    struct stat about;
    close_log(self);
    if (self->log.wanted && stat(log, &about) == 0 && S_ISREG(about.st_mode)) {
        unlink(log);
    }
    if (self->lcm != NULL) {
        lcm_destroy(self->lcm);
    }
}

mct_status mct_telemetry_start(mct_telemetry *telemetry, mct_ring *ring, const mct_scene *scene,
                               const mct_telemetry_targets *targets, mct_message *why)
{
    const mct_system *system = mct_systems[scene->system];
    memset(telemetry, 0, sizeof *telemetry);
    mct_message_clear(why);
    telemetry->ring = ring;
    telemetry->log.file = NO_FILE;
    telemetry->scene = scene;
    telemetry->timing = targets->timing;
    telemetry->counters = targets->counters;
    telemetry->coordinates = system->coordinate_count;
    telemetry->encoders = mct_encoder_count(system);
    telemetry->states = mct_state_count(scene);
    telemetry->health.period = (uint64_t)(health_period / scene->dt + 0.5);
    telemetry->health.period += telemetry->health.period == 0;
    mct_status status = encode_scene(telemetry, targets->scene_text != NULL ? targets->scene_text : "");
    if (status != MCT_OK) {
        mct_message_add(why, "the scene is too long for a log: its text may have 60 kB and ");
        mct_message_add_integer(why, MCT_MAX_OVERRIDES);
        mct_message_add(why, " overrides");
        return status;
    }
    if (is_given(targets->url)) {
        status = open_lcm(telemetry, targets->url, why);
    }
    if (status == MCT_OK && is_given(targets->log)) {
        status = open_log(telemetry, targets->log, why);
    }
    if (status == MCT_OK) {
        const int reason = start_thread(telemetry);
        if (reason != 0) {
            explain(why, "cannot start the telemetry's thread", "", reason);
            status = MCT_ERROR_IO;
        }
    }
    if (status != MCT_OK) {
        abandon(telemetry, targets->log);
    }
    return status;
}

void mct_telemetry_stop(mct_telemetry *telemetry)
{
    __atomic_store_n(&telemetry->stopping, true, __ATOMIC_RELEASE);
    pthread_join(telemetry->thread, NULL);
    if (telemetry->lcm != NULL) {
        lcm_destroy(telemetry->lcm);
        telemetry->lcm = NULL;
    }
}

/**
 * @file telemetry.h
 * Carries records from a loop's ring to LCM listeners and an event log, in a thread of its own.
 *
 * The loop never waits: what the ring cannot hold is dropped and counted (mct_ring.dropped), and each
 * published tick says how many were lost before it. A listener that is slow or absent costs the loop nothing.
 * Times are simulated: tick * dt, so a run in lockstep leaves the same log, byte for byte, each time.
 *
 * Messages are those of hal/lcm/types/: tick_t for each record, health_t ten times a second and at the end,
 * scene_t at the start (over the network every second, for those who come late). A build without LCM has no
 * telemetry: MCTAU_HAVE_LCM is 0 there.
 */
#ifndef MCTAU_HAL_LCM_TELEMETRY_H
#define MCTAU_HAL_LCM_TELEMETRY_H

#include <pthread.h>
#include <stdbool.h>
#include <stdint.h>

#include "mctau/message.h"
#include "mctau/record.h"
#include "mctau/scene.h"
#include "mctau/supervisor.h"

#define MCT_TELEMETRY_VERSION 2 /**< of the meaning of the messages; scene_t carries it */

#define MCT_CHANNEL_TICK      "MCTAU_TICK"
#define MCT_CHANNEL_SCENE     "MCTAU_SCENE"
#define MCT_CHANNEL_HEALTH    "MCTAU_HEALTH"

/** Begins a line of a scene text that holds a value given from outside: "#!set table.key=value". */
#define MCT_OVERRIDE_MARK        "#!set "
#define MCT_MAX_OVERRIDES        64

#define MCT_TELEMETRY_SCENE_SIZE 65536 /**< longest scene message [bytes]: the text and some 1 kB */
#define MCT_TELEMETRY_LOG_SIZE   65792 /**< buffer of the log [bytes]: a scene message, or 0.2 s at 1 kHz */

typedef struct {
    const char *url; /**< LCM URL (udpm://...), or NULL or "" for none */
    const char *log; /**< path of the event log, or NULL or "" for none */
    /** What a replay needs: the file's text, then a line MCT_OVERRIDE_MARK "table.key=value" an override. */
    const char *scene_text;
    const mct_timing *timing; /**< of the HAL, read while the loop runs; or NULL */
    mct_counters counters;    /**< of the HAL, likewise; zero: none */
} mct_telemetry_targets;

/** What became of the records; read it after mct_telemetry_stop. */
typedef struct {
    uint64_t records;        /**< taken from the ring */
    uint64_t published;      /**< handed to LCM */
    uint64_t publish_errors; /**< messages that LCM did not take */
    uint64_t logged;         /**< records that are in the log */
    uint64_t log_errors;     /**< events (records, scene, health) that the log did not take: disk full, say */
    int first_log_errno;     /**< reason of the first of them, 0 when none */
} mct_telemetry_counts;

/** The event log. It ends at its first error, cut back to the last whole event, fit for a replay. */
typedef struct {
    int file; /**< descriptor; -1 when there is none, or after an error */
    bool wanted;
    uint64_t events;          /**< so far */
    uint64_t kept_bytes;      /**< written so far, up to a whole event */
    uint64_t waiting_bytes;   /**< in the buffer */
    uint64_t waiting_events;  /**< in the buffer */
    uint64_t waiting_records; /**< of them */
    uint8_t buffer[MCT_TELEMETRY_LOG_SIZE];
} mct_telemetry_log;

/** What health_t tells. */
typedef struct {
    int64_t messages;
    uint64_t period;    /**< [ticks] */
    uint64_t next_tick; /**< of the next message */
    uint64_t tick;      /**< newest */
    uint64_t dropped;
    uint32_t faults;
    mct_histogram lateness;
    mct_histogram age; /**< of feedback */
    uint64_t fault_ticks[MCT_FAULT_COUNT];
    uint64_t mode_ticks[MCT_MODE_COUNT];
} mct_telemetry_health;

/** Some 150 kB: not for a small stack. */
typedef struct mct_telemetry {
    mct_ring *ring;
    const mct_scene *scene;
    const mct_timing *timing;
    mct_counters counters;
    int32_t coordinates, states, encoders;
    bool stopping; /**< set by mct_telemetry_stop, read by the thread */
    pthread_t thread;
    void *lcm; /**< lcm_t */
    mct_telemetry_log log;
    mct_telemetry_health health;
    mct_telemetry_counts counts;
    int32_t scene_length; /**< [bytes] */
    uint8_t scene_message[MCT_TELEMETRY_SCENE_SIZE];
} mct_telemetry;

/**
 * Opens the targets, writes the scene and starts the thread, which takes signals of nobody and never runs in
 * real time.
 * @param ring   zero-initialised, fed by a loop; must outlive the telemetry, as must `scene`
 * @param why    a sentence on an error; a warning on MCT_OK, else empty
 * @return MCT_OK; MCT_ERROR_IO when the log cannot be made; MCT_ERROR_ARGUMENT for a URL of a provider other
 *         than udpm (tcpq would wait for its listeners); MCT_ERROR_BOUND for a scene text that is too long. A
 *         network that cannot be used (no route) is no error: `why` then holds a warning with MCT_OK, and
 *         records go to the log alone. A disk that is full from the start is none either: it is counted.
 *         On an error no partial log is left behind.
 */
mct_status mct_telemetry_start(mct_telemetry *telemetry, mct_ring *ring, const mct_scene *scene,
                               const mct_telemetry_targets *targets, mct_message *why);

/**
 * Drains the ring, ends the thread, flushes and closes. A log that cannot be flushed is counted as an error.
 * Call it after a start that was MCT_OK, when the loop has ended.
 */
void mct_telemetry_stop(mct_telemetry *telemetry);

#endif

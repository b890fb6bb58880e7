/* The rules of include/mctau/record.h (the ring, between threads) and hal/lcm/telemetry.h. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif

#include <stdio.h>

#include "unity.h"

#if MCTAU_HAVE_LCM

#include <errno.h>
#include <fcntl.h>
#include <lcm/lcm.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "mctau_health_t.h"
#include "mctau_scene_t.h"
#include "mctau_tick_t.h"
#include "telemetry/logged_run.h"

static logged_run run;
static char path[64];

void setUp(void)
{
    memset(&run, 0, sizeof run);
    log_path(path, "telemetry");
}

void tearDown(void)
{
    unlink(path);
}

static bool exists(const char *file)
{
    return access(file, F_OK) == 0;
}

static long size_of(const char *file)
{
    struct stat about;
    return stat(file, &about) == 0 ? (long)about.st_size : -1;
}

/* --- the ring --- */

enum { PUSHES = 300000 };

static void *push_all(void *ring)
{
    mct_record record;
    memset(&record, 0, sizeof record);
    for (uint64_t i = 0; i < PUSHES; i++) {
        record.tick = i;
        record.plant.x[0] = (mct_real)(i % 1000);
        record.dropped = ((mct_ring *)ring)->dropped;
        mct_ring_push(ring, &record);
    }
    return NULL;
}

static void test_a_slow_consumer_gets_records_in_order_and_the_rest_is_counted(void)
{
    pthread_t producer;
    uint64_t taken = 0;
    uint64_t next = 0;
    bool in_order = true;
    bool whole = true;
    const struct timespec pause = {.tv_nsec = 100000};
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&producer, NULL, push_all, &run.ring));
    while (__atomic_load_n(&run.ring.dropped, __ATOMIC_ACQUIRE) == 0) {
        nanosleep(&pause, NULL); /* slow enough that some are lost, however slow the producer */
    }
    for (bool last = false; !last;) {
        last = __atomic_load_n(&run.ring.head, __ATOMIC_ACQUIRE) +
                   __atomic_load_n(&run.ring.dropped, __ATOMIC_ACQUIRE) ==
               PUSHES;
        for (const mct_record *record = mct_ring_peek(&run.ring); record != NULL;
             record = mct_ring_peek(&run.ring)) {
            in_order &= record->tick >= next;
            whole &= record->plant.x[0] == (mct_real)(record->tick % 1000);
            whole &= record->tick == taken + record->dropped; /* so many were lost before it */
            next = record->tick + 1;
            mct_ring_pop(&run.ring);
            if (++taken % 1000 == 0) {
                nanosleep(&pause, NULL);
            }
        }
    }
    pthread_join(producer, NULL);
    TEST_ASSERT_TRUE(in_order);
    TEST_ASSERT_TRUE(whole);
    TEST_ASSERT_TRUE(taken + run.ring.dropped == PUSHES);
    TEST_ASSERT_TRUE(run.ring.dropped > 0);
}

static void test_a_full_ring_refuses_and_counts(void)
{
    const mct_record record = {.tick = 1};
    for (int i = 0; i < MCT_RING_SIZE; i++) {
        TEST_ASSERT_FALSE(mct_ring_is_full(&run.ring));
        TEST_ASSERT_TRUE(mct_ring_push(&run.ring, &record));
    }
    TEST_ASSERT_TRUE(mct_ring_is_full(&run.ring));
    TEST_ASSERT_FALSE(mct_ring_push(&run.ring, &record));
    TEST_ASSERT_TRUE(run.ring.dropped == 1);
    mct_ring_pop(&run.ring);
    TEST_ASSERT_TRUE(mct_ring_push(&run.ring, &record));
}

/* --- the log --- */

enum { TICKS = 10007 };

static void test_a_log_holds_scene_ticks_and_end_with_simulated_time(void)
{
    static char text[4096];
    snprintf(text, sizeof text, "%s# the end\n#!set scene.dt=0.0005\n#!set controller.capture=0.5\n",
             swing_up_scene);
    logged_run_all(&run, text, (mct_samples){NULL, 0}, TICKS, path);
    TEST_ASSERT_EQUAL_INT(MCT_OK, run.status);
    TEST_ASSERT_TRUE(run.telemetry.counts.records == TICKS && run.telemetry.counts.logged == TICKS);
    TEST_ASSERT_TRUE(run.telemetry.counts.log_errors == 0 && run.ring.dropped == 0);

    lcm_eventlog_t *log = lcm_eventlog_create(path, "r");
    int64_t ticks = 0;
    int64_t healths = 0;
    bool finished = false;
    for (lcm_eventlog_event_t *event = lcm_eventlog_read_next_event(log); event != NULL;
         event = lcm_eventlog_read_next_event(log)) {
        TEST_ASSERT_FALSE(finished);
        if (event->eventnum == 0) {
            mctau_scene_t scene;
            TEST_ASSERT_EQUAL_STRING(MCT_CHANNEL_SCENE, event->channel);
            TEST_ASSERT_EQUAL_INT(event->datalen,
                                  mctau_scene_t_decode(event->data, 0, event->datalen, &scene));
            TEST_ASSERT_EQUAL_INT(2, scene.override_count);
            TEST_ASSERT_EQUAL_STRING("scene.dt=0.0005", scene.overrides[0]);
            TEST_ASSERT_EQUAL_STRING("controller.capture=0.5", scene.overrides[1]);
            TEST_ASSERT_EQUAL_INT((int)(strstr(text, "#!set") - text), (int)strlen(scene.text));
            TEST_ASSERT_EQUAL_STRING("reaction_wheel", scene.system);
            TEST_ASSERT_EQUAL_INT(5, scene.states);
            TEST_ASSERT_EQUAL_STRING("arm_angle", scene.state_names[0]);
            TEST_ASSERT_EQUAL_STRING("rad", scene.state_units[0]);
            TEST_ASSERT_EQUAL_INT(MCT_FAULT_COUNT, scene.fault_count);
            TEST_ASSERT_EQUAL_STRING(MCT_REAL_IS_FLOAT ? "float" : "double", scene.precision);
            mctau_scene_t_decode_cleanup(&scene);
        } else if (strcmp(event->channel, MCT_CHANNEL_TICK) == 0) {
            mctau_tick_t tick;
            TEST_ASSERT_EQUAL_INT(event->datalen, mctau_tick_t_decode(event->data, 0, event->datalen, &tick));
            TEST_ASSERT_TRUE(tick.tick == ticks && tick.sequence == ticks);
            TEST_ASSERT_TRUE(tick.utime == ticks * 1000 && event->timestamp == tick.utime);
            ticks++;
            mctau_tick_t_decode_cleanup(&tick);
        } else {
            mctau_health_t health;
            TEST_ASSERT_EQUAL_STRING(MCT_CHANNEL_HEALTH, event->channel);
            TEST_ASSERT_EQUAL_INT(event->datalen,
                                  mctau_health_t_decode(event->data, 0, event->datalen, &health));
            TEST_ASSERT_TRUE(health.sequence == healths);
            TEST_ASSERT_TRUE(health.records == ticks && health.lateness[0] == ticks &&
                             health.utime == event->timestamp);
            finished = health.finished;
            healths++;
            mctau_health_t_decode_cleanup(&health);
        }
        lcm_eventlog_free_event(event);
    }
    lcm_eventlog_destroy(log);
    TEST_ASSERT_TRUE(finished);
    TEST_ASSERT_TRUE(ticks == TICKS);
    TEST_ASSERT_TRUE(healths == TICKS / 100 + 2); /* every 100 ms of 1 ms, from tick 0 on, and the last */
}

static void test_the_same_run_leaves_the_same_log(void)
{
    static char first[1 << 20];
    static char second[1 << 20];
    char *const logs[] = {first, second};
    size_t sizes[2];
    for (int i = 0; i < 2; i++) {
        logged_run_all(&run, swing_up_scene, (mct_samples){NULL, 0}, 2000, path);
        FILE *file = fopen(path, "rb");
        sizes[i] = fread(logs[i], 1, sizeof first, file);
        fclose(file);
    }
    TEST_ASSERT_TRUE(sizes[0] > 2000 * 200 && sizes[0] < sizeof first);
    TEST_ASSERT_TRUE(sizes[0] == sizes[1]);
    TEST_ASSERT_EQUAL_MEMORY(first, second, sizes[0]);
}

/* Where there is no route, the warning says so, and the log has it all. */
static void test_what_is_published_is_logged_too(void)
{
    const mct_telemetry_targets targets = {
        .url = "udpm://239.255.76.67:7699?ttl=0", .log = path, .scene_text = swing_up_scene};
    logged_run_prepare(&run, swing_up_scene, (mct_samples){NULL, 0});
    logged_run_start(&run, &targets);
    TEST_ASSERT_EQUAL_INT(MCT_OK, run.status);
    const bool has_network = run.telemetry.lcm != NULL;
    for (int i = 0; i < 3000; i++) {
        logged_run_tick(&run);
    }
    mct_telemetry_stop(&run.telemetry);
    TEST_ASSERT_TRUE(run.telemetry.counts.logged == 3000);
    TEST_ASSERT_TRUE(run.telemetry.counts.published == (has_network ? 3000 : 0));
    TEST_ASSERT_TRUE(has_network == (run.why.text[0] == '\0'));
}

/* --- what goes wrong --- */

static void test_a_full_disk_is_counted_and_the_run_goes_on(void)
{
    logged_run_all(&run, swing_up_scene, (mct_samples){NULL, 0}, 5000, "/dev/full");
    TEST_ASSERT_EQUAL_INT(MCT_OK, run.status);
    TEST_ASSERT_TRUE(run.telemetry.counts.records == 5000);
    TEST_ASSERT_TRUE(run.telemetry.counts.logged == 0);
    TEST_ASSERT_TRUE(run.telemetry.counts.log_errors >= 5000);
    TEST_ASSERT_EQUAL_INT(ENOSPC, run.telemetry.counts.first_log_errno);
    TEST_ASSERT_TRUE(run.loop.tick == 5000);
    TEST_ASSERT_TRUE(exists("/dev/full"));
}

/* A limit on the size of files stands for a disk that fills up in the middle of a run. */
static void test_a_disk_that_fills_up_leaves_whole_events(void)
{
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    const struct rlimit limit = {200001, before.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &limit);
    logged_run_all(&run, swing_up_scene, (mct_samples){NULL, 0}, 5000, path);
    setrlimit(RLIMIT_FSIZE, &before);
    const mct_telemetry_counts *counts = &run.telemetry.counts;
    TEST_ASSERT_EQUAL_INT(MCT_OK, run.status);
    TEST_ASSERT_EQUAL_INT(EFBIG, counts->first_log_errno);
    TEST_ASSERT_TRUE(counts->records == 5000 && counts->logged > 500 && counts->logged < 1000);
    TEST_ASSERT_TRUE(counts->logged + counts->log_errors > 5000); /* with scene and health */

    lcm_eventlog_t *log = lcm_eventlog_create(path, "r");
    uint64_t ticks = 0;
    long end = 0;
    for (lcm_eventlog_event_t *event = lcm_eventlog_read_next_event(log); event != NULL;
         event = lcm_eventlog_read_next_event(log)) {
        ticks += strcmp(event->channel, MCT_CHANNEL_TICK) == 0;
        end = ftell(log->f);
        lcm_eventlog_free_event(event);
    }
    lcm_eventlog_destroy(log);
    TEST_ASSERT_TRUE(ticks == counts->logged);
    TEST_ASSERT_EQUAL_INT(size_of(path), end);
}

static void test_a_start_that_fails_leaves_no_log(void)
{
    mct_telemetry_targets targets = {.url = "tcpq://127.0.0.1:1", .log = path, .scene_text = swing_up_scene};
    logged_run_prepare(&run, swing_up_scene, (mct_samples){NULL, 0});
    logged_run_start(&run, &targets);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, run.status);
    TEST_ASSERT_NOT_NULL(strstr(run.why.text, "telemetry.lcm: found tcpq://127.0.0.1:1; allowed udpm://"));
    TEST_ASSERT_FALSE(exists(path));

    targets = (mct_telemetry_targets){.log = "/nowhere/at/all.lcm", .scene_text = swing_up_scene};
    logged_run_start(&run, &targets);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, run.status);
    TEST_ASSERT_NOT_NULL(strstr(run.why.text, "/nowhere/at/all.lcm: No such file"));

    static char huge[MCT_TELEMETRY_SCENE_SIZE + 100];
    memset(huge, '#', sizeof huge - 1);
    targets = (mct_telemetry_targets){.log = path, .scene_text = huge};
    logged_run_start(&run, &targets);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, run.status);
    TEST_ASSERT_FALSE(exists(path));
}

static void test_urls_that_are_no_multicast_address_are_refused(void)
{
    static const char *const bad[] = {
        "udpm://somewhere",    "udpm://10.0.0.1:7667", "udpm://239.255.76.67.1:7667",
        "udp://239.255.76.67", "file:///tmp/x",        "x"};
    logged_run_prepare(&run, swing_up_scene, (mct_samples){NULL, 0});
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const mct_telemetry_targets targets = {.url = bad[i], .scene_text = swing_up_scene};
        logged_run_start(&run, &targets);
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_ERROR_ARGUMENT, run.status, bad[i]);
    }
}

static void test_records_that_wait_at_the_end_are_not_lost(void)
{
    const mct_telemetry_targets targets = {.log = path, .scene_text = swing_up_scene};
    logged_run_prepare(&run, swing_up_scene, (mct_samples){NULL, 0});
    for (int i = 0; i < MCT_RING_SIZE; i++) {
        mct_loop_tick(&run.loop); /* nobody listens yet */
    }
    logged_run_start(&run, &targets);
    mct_telemetry_stop(&run.telemetry);
    TEST_ASSERT_TRUE(run.telemetry.counts.logged == MCT_RING_SIZE);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_slow_consumer_gets_records_in_order_and_the_rest_is_counted);
    RUN_TEST(test_a_full_ring_refuses_and_counts);
    RUN_TEST(test_a_log_holds_scene_ticks_and_end_with_simulated_time);
    RUN_TEST(test_the_same_run_leaves_the_same_log);
    RUN_TEST(test_what_is_published_is_logged_too);
    RUN_TEST(test_a_full_disk_is_counted_and_the_run_goes_on);
    RUN_TEST(test_a_disk_that_fills_up_leaves_whole_events);
    RUN_TEST(test_a_start_that_fails_leaves_no_log);
    RUN_TEST(test_urls_that_are_no_multicast_address_are_refused);
    RUN_TEST(test_records_that_wait_at_the_end_are_not_lost);
    return UNITY_END();
}

#else
#include "telemetry/without_lcm.h"
#endif

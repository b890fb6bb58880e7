/*
 * The whole loop for long: plant, controller, sim HAL, ring and telemetry, whose log a reader takes through a pipe.
 * Nothing grows, no tick is lost or late, no fault comes. MCTAU_SOAK_TICKS in the environment: how many ticks.
 */
#include <stdio.h>

#include "unity.h"

#if MCTAU_HAVE_LCM

#include <sys/stat.h>

#include "telemetry/logged_run.h"

enum {
    TICKS = 1000000,
    WARM = 50000,
    GROWTH = 256 /* kB: pages of code and stack that are met for the first time */
};

static const char *const scene =
    "[scene]\nsystem = \"reaction_wheel\"\nstepper = \"expo\"\n[effects]\nmotor = \"inductive\"\n"
    "[initial]\narm_angle = 3.0\n[controller]\nkind = \"swing_up_balance\"\n[sensors]\nnoise = 0.5\n";

static logged_run run;

/* Who reads the log: every event in order, at its time. */
static struct {
    const char *path;
    uint64_t ticks, healths;
    bool in_order, on_time;
} reader;

void setUp(void)
{
}

void tearDown(void)
{
}

static uint64_t big_endian(const uint8_t *at, int bytes)
{
    uint64_t value = 0;
    for (int i = 0; i < bytes; i++) {
        value = value << 8 | at[i];
    }
    return value;
}

static void take(uint64_t number, uint64_t utime, const char *channel, const uint8_t *data)
{
    reader.in_order &= number == 1 + reader.ticks + reader.healths; /* behind the scene */
    if (strcmp(channel, MCT_CHANNEL_HEALTH) == 0) {
        reader.healths++;
        return;
    }
    enum { UTIME_AT = 8, SEQUENCE_AT = 16, TICK_AT = 24 };
    reader.in_order &=
        big_endian(data + TICK_AT, 8) == reader.ticks && big_endian(data + SEQUENCE_AT, 8) == reader.ticks;
    reader.on_time &=
        utime == 1000 * reader.ticks && big_endian(data + UTIME_AT, 8) == utime; /* 1 ms, exactly */
    reader.ticks++;
}

static void *read_log(void *nothing)
{
    static uint8_t header[28], data[MCT_TELEMETRY_SCENE_SIZE];
    char channel[64];
    FILE *file = fopen(reader.path, "rb");
    (void)nothing;
    while (file != NULL && fread(header, 1, sizeof header, file) == sizeof header) {
        const size_t channel_length = big_endian(header + 20, 4), length = big_endian(header + 24, 4);
        if (channel_length >= sizeof channel || length > sizeof data ||
            fread(channel, 1, channel_length, file) != channel_length ||
            fread(data, 1, length, file) != length) {
            break;
        }
        channel[channel_length] = '\0';
        if (strcmp(channel, MCT_CHANNEL_SCENE) != 0) {
            take(big_endian(header + 4, 8), big_endian(header + 12, 8), channel, data);
        }
    }
    if (file != NULL) {
        fclose(file);
    }
    return NULL;
}

/* Memory that this process occupies. */
static long resident_kb(void)
{
    long pages = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file != NULL) {
        if (fscanf(file, "%ld %ld", &pages, &resident) != 2) {
            resident = 0;
        }
        fclose(file);
    }
    return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

static void test_a_long_run_neither_grows_nor_loses_time_nor_fails(void)
{
    static char path[64];
    const char *asked = getenv("MCTAU_SOAK_TICKS");
    const uint64_t ticks = asked != NULL ? strtoull(asked, NULL, 10) : TICKS;
    pthread_t thread;
    uint64_t faulty = 0, balanced = 0;
    long before = 0;
    log_path(path, "soak");
    reader.path = path;
    reader.in_order = reader.on_time = true;
    TEST_ASSERT_EQUAL_INT(0, mkfifo(path, 0600));
    TEST_ASSERT_EQUAL_INT(0, pthread_create(&thread, NULL, read_log, NULL));
    const mct_telemetry_targets targets = {.log = path, .scene_text = scene};
    logged_run_prepare(&run, scene, (mct_samples){NULL, 0});
    TEST_ASSERT_EQUAL_INT(MCT_OK, run.status);
    logged_run_start(&run, &targets);
    TEST_ASSERT_EQUAL_INT(MCT_OK, run.status);
    const time_t begin = time(NULL);
    for (uint64_t i = 0; i < ticks; i++) {
        logged_run_tick(&run);
        faulty += run.loop.record.faults != 0 || run.sim.plant.diverged_ticks > 0;
        balanced += run.loop.controller.mode == MCT_MODE_BALANCE;
        before = i == WARM ? resident_kb() : before;
    }
    const long after = resident_kb();
    mct_telemetry_stop(&run.telemetry);
    pthread_join(thread, NULL);
    unlink(path);
    printf("%llu ticks in %lld s, %ld kB, then %ld kB; %llu in balance, %llu with a fault\n",
           (unsigned long long)ticks, (long long)(time(NULL) - begin), before, after,
           (unsigned long long)balanced, (unsigned long long)faulty);
    TEST_ASSERT_TRUE(after <= before + GROWTH);
    TEST_ASSERT_TRUE(run.loop.tick == ticks && run.sim.plant.tick == ticks);
    TEST_ASSERT_TRUE(run.telemetry.counts.logged == ticks && reader.ticks == ticks && run.ring.dropped == 0);
    TEST_ASSERT_TRUE(reader.in_order);
    TEST_ASSERT_TRUE(reader.on_time);
    TEST_ASSERT_TRUE(faulty == 0);
    TEST_ASSERT_TRUE(balanced > ticks / 2);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_long_run_neither_grows_nor_loses_time_nor_fails);
    return UNITY_END();
}

#else
#include "telemetry/without_lcm.h"
#endif

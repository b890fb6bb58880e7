/* The rules of tools/mctau/runner_replay.h: a replay proves equality, names the first difference, and
 * believes no file. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif

#include <stdio.h>

#include "unity.h"

#if MCTAU_HAVE_LCM

#include "telemetry/logged_run.h"
#include "tools/mctau/runner_replay.c"

/* The front end's. */
void *need_memory(void *memory)
{
    TEST_ASSERT_NOT_NULL(memory);
    return memory;
}

static logged_run run;
static char path[64];
static replay_result result;
static mct_message why;

static uint8_t bytes[1 << 21]; /* a log, and what becomes of it */
static size_t size;

void setUp(void)
{
    log_path(path, "replay");
}

void tearDown(void)
{
    unlink(path);
}

static void record(const char *text, int ticks)
{
    logged_run_all(&run, text, (mct_samples){NULL, 0}, ticks, path);
    TEST_ASSERT_EQUAL_INT(MCT_OK, run.status);
    FILE *file = fopen(path, "rb");
    size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    TEST_ASSERT_TRUE(size > 0 && size < sizeof bytes);
}

static void write_file(size_t count)
{
    unlink(path); /* some file systems wait for the disk when a file is replaced */
    FILE *file = fopen(path, "wb");
    fwrite(bytes, 1, count, file);
    fclose(file);
}

static void expect_equal(uint64_t ticks)
{
    const mct_status status = runner_replay(path, &result, &why);
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, status, why.text);
    TEST_ASSERT_TRUE_MESSAGE(result.equal, result.field);
    TEST_ASSERT_FALSE(result.truncated);
    TEST_ASSERT_TRUE(result.ticks == ticks);
}

/* --- events of the log in `bytes` --- */

static size_t event_end(size_t at)
{
    return at + HEADER_SIZE + big_endian_32(bytes + at + 20) + big_endian_32(bytes + at + 24);
}

/* Where the data of a tick stand, and their length. */
static size_t tick_data(uint64_t tick, size_t *length)
{
    for (size_t at = 0; at < size; at = event_end(at)) {
        const size_t channel = big_endian_32(bytes + at + 20);
        const size_t data = at + HEADER_SIZE + channel;
        if (channel == strlen(MCT_CHANNEL_TICK) &&
            memcmp(bytes + at + HEADER_SIZE, MCT_CHANNEL_TICK, channel) == 0 &&
            big_endian_32(bytes + data + 28) == tick) { /* behind hash, time, sequence */
            *length = big_endian_32(bytes + at + 24);
            return data;
        }
    }
    TEST_FAIL_MESSAGE("the tick is not in the log");
    return 0;
}

/* --- equality --- */

static void test_a_replay_of_a_swing_up_has_the_same_bits(void)
{
    record(swing_up_scene, 6000);
    expect_equal(6000);
}

static void test_a_replay_of_a_cart_pole_has_the_same_bits(void)
{
    record("[scene]\nsystem = \"cart_pole\"\n[effects]\nmotor = \"quasi_static\"\ncoulomb = true\n"
           "[initial]\npole_angle = 3.14\n[controller]\nkind = \"swing_up_balance\"\n"
           "[sensors]\nlatency = 1\nnoise = 1\n",
           6000);
    expect_equal(6000);
}

static void test_a_replay_of_free_motion_and_of_a_sine_has_the_same_bits(void)
{
    record("[scene]\nsystem = \"cart_pole\"\n[effects]\nmotor = \"off\"\n"
           "[initial]\npole_angle = 2\npole_rate = 30\n",
           3000);
    expect_equal(3000);
    record("[scene]\nsystem = \"reaction_wheel\"\n[input]\nkind = \"sine\"\namplitude = 5\nfrequency = 7\n",
           3000);
    expect_equal(3000);
}

static void test_a_csv_input_is_taken_from_the_log(void)
{
    enum { TICKS = 2000 };
    static mct_real samples[TICKS / 2];
    for (int i = 0; i < TICKS / 2; i++) {
        samples[i] = (mct_real)(6.0 * ((i / 100) % 2) - 3.1);
    }
    logged_run_all(
        &run,
        "[scene]\nsystem = \"cart_pole\"\n[effects]\nmotor = \"quasi_static\"\n[input]\nkind = \"csv\"\n"
        "file = \"gone.csv\"\ncolumn = \"u\"\n",
        (mct_samples){samples, TICKS / 2}, TICKS, path);
    TEST_ASSERT_EQUAL_INT(MCT_OK, run.status);
    expect_equal(TICKS);
}

static void test_overrides_are_part_of_the_log(void)
{
    static char text[4096];
    const mct_telemetry_targets targets = {.log = path, .scene_text = text};
    const mct_override override = {"parameters.wheel_mass=0.25", "--set"};
    logged_run_prepare(&run, swing_up_scene, (mct_samples){NULL, 0});
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_scene_read(swing_up_scene, strlen(swing_up_scene), "scene", &override,
                                                 1, &run.scene, &why));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_sim_init(&run.sim, &run.scene, &why));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_loop_init(&run.loop, &run.plan, &run.scene, mct_sim_hal(&run.sim),
                                                &run.ring, (mct_samples){NULL, 0}, &why));
    snprintf(text, sizeof text, "%s#!set %s\n", swing_up_scene, override.assignment);
    logged_run_start(&run, &targets);
    for (int i = 0; i < 1000; i++) {
        logged_run_tick(&run);
    }
    mct_telemetry_stop(&run.telemetry);
    expect_equal(1000);
}

static void test_faults_of_sensors_are_replayed(void)
{
    static const char *const faults[] = {"nan", "silent", "frozen"};
    for (int i = 0; i < 3; i++) {
        char text[1024];
        snprintf(text, sizeof text, "%sfault = \"%s\"\n",
                 "[scene]\nsystem = \"reaction_wheel\"\n[effects]\nmotor = \"quasi_static\"\n"
                 "[initial]\narm_angle = 3\n[controller]\nkind = \"swing_up_balance\"\n"
                 "[sensors]\nfault_time = 0.3\nfault_duration = 0.5\n",
                 faults[i]);
        record(text, 1500);
        expect_equal(1500);
        TEST_ASSERT_TRUE(run.loop.record.faults != 0 || i == 2); /* a motor at rest may well be frozen */
    }
}

/* A HAL that fails, a stop: a replay cannot know why, but it knows when. */
static void test_faults_from_outside_are_replayed(void)
{
    const mct_telemetry_targets targets = {.log = path, .scene_text = swing_up_scene};
    logged_run_prepare(&run, swing_up_scene, (mct_samples){NULL, 0});
    logged_run_start(&run, &targets);
    for (int i = 0; i < 1000; i++) {
        if (i == 700) {
            mct_supervisor_fault(&run.loop.supervisor, MCT_FAULT_STOPPED);
        }
        logged_run_tick(&run);
    }
    mct_telemetry_stop(&run.telemetry);
    TEST_ASSERT_TRUE(run.loop.record.applied == 0);
    expect_equal(1000);
}

/* --- differences --- */

typedef struct {
    const char *name;
    size_t length;
} span;

/* Each bit of a tick's data belongs to a field, and to be wrong is to be named. In the order of tick_t.lcm.
 * */
static void test_any_bit_of_a_tick_that_is_flipped_is_named(void)
{
    static const span spans[] = {
        {"utime", 8},
        {"sequence", 8},
        {"", 8 + 16},
        {"counts.arm_angle", 4},
        {"counts.wheel_angle", 4},
        {"age_us", 8},
        {"flags", 4},
        {"estimate.arm_angle", 8},
        {"estimate.wheel_angle", 8},
        {"estimate.arm_rate", 8},
        {"estimate.wheel_rate", 8},
        {"wanted", 8},
        {"applied", 8},
        {"mode", 4},
        {"faults", 4},
        {"rearmed", 1},
        {"late_us", 8},
        {"dropped", 8},
        {"state.arm_angle", 8},
        {"state.wheel_angle", 8},
        {"state.arm_rate", 8},
        {"state.wheel_rate", 8},
        {"state.current", 8},
        {"compensation.arm_angle", 8},
        {"compensation.wheel_angle", 8},
        {"compensation.arm_rate", 8},
        {"compensation.wheel_rate", 8},
        {"compensation.current", 8},
        {"turns.arm_angle", 4},
        {"turns.wheel_angle", 4},
    };
    enum { TICK = 37 };
    record(swing_up_scene, 50);
    size_t length;
    const size_t data = tick_data(TICK, &length);
    size_t at = data + 8; /* behind the type's hash */
    for (size_t i = 0; i < sizeof spans / sizeof *spans; i++) {
        for (size_t bit = 0; bit < 8 * spans[i].length; bit++) {
            bytes[at + bit / 8] ^= (uint8_t)(1u << bit % 8);
            write_file(size);
            bytes[at + bit / 8] ^= (uint8_t)(1u << bit % 8);
            const mct_status status = runner_replay(path, &result, &why);
            TEST_ASSERT_FALSE_MESSAGE(result.equal, spans[i].name);
            TEST_ASSERT_TRUE(result.ticks == TICK);
            if (spans[i].name[0] == '\0') { /* the tick's number and lengths */
                TEST_ASSERT_TRUE(status == MCT_ERROR_IO || status == MCT_ERROR_SYNTAX);
                TEST_ASSERT_TRUE(why.text[0] != '\0');
            } else {
                TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, status, why.text);
                TEST_ASSERT_EQUAL_STRING(spans[i].name, result.field);
                TEST_ASSERT_TRUE(result.first_tick == TICK);
            }
        }
        at += spans[i].length;
    }
    TEST_ASSERT_TRUE(at == data + length); /* no field is forgotten */
    write_file(size);
    expect_equal(50);
}

static void test_values_that_differ_are_told(void)
{
    record(swing_up_scene, 50);
    size_t length;
    const size_t applied = tick_data(20, &length) + 8 + 24 + 16 + 8 + 12 + 4 * 8 + 8;
    bytes[applied] ^= 0x80; /* its sign */
    write_file(size);
    TEST_ASSERT_EQUAL_INT(MCT_OK, runner_replay(path, &result, &why));
    TEST_ASSERT_EQUAL_STRING("applied", result.field);
    TEST_ASSERT_TRUE(result.recorded == -result.replayed);
}

static void test_a_plant_with_other_parameters_differs_at_the_first_step(void)
{
    record(swing_up_scene, 50);
    uint8_t *seed = memmem(bytes, size, "seed = 7", 8);
    TEST_ASSERT_NOT_NULL(seed);
    seed[7] = '8';
    write_file(size);
    TEST_ASSERT_EQUAL_INT(MCT_OK, runner_replay(path, &result, &why));
    TEST_ASSERT_FALSE(result.equal);
    TEST_ASSERT_TRUE(result.first_tick == 1);
    TEST_ASSERT_EQUAL_STRING_LEN("state.", result.field, 6);
}

/* --- logs that are not whole --- */

/* From within the scene to the end, every byte of the last events and some before. */
static void test_a_log_that_is_cut_replays_up_to_its_last_whole_event(void)
{
    enum { TICKS = 230 };
    record(swing_up_scene, TICKS);
    const size_t scene_end = event_end(0);
    size_t event = 0;
    uint64_t ticks = 0;
    for (size_t cut = 0; cut < size; cut += cut < scene_end + 800 || cut > size - 1500 ? 1 : 97) {
        while (event_end(event) <= cut) {
            ticks += memcmp(bytes + event + HEADER_SIZE, MCT_CHANNEL_TICK, strlen(MCT_CHANNEL_TICK)) == 0;
            event = event_end(event);
        }
        write_file(cut);
        const mct_status status = runner_replay(path, &result, &why);
        if (cut < scene_end) {
            TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, status);
            TEST_ASSERT_TRUE(why.text[0] != '\0');
        } else {
            TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, status, why.text);
            TEST_ASSERT_TRUE(result.equal && result.truncated);
            TEST_ASSERT_TRUE(result.ticks == ticks);
        }
    }
    TEST_ASSERT_TRUE(ticks == TICKS);
}

static void expect_error(mct_status expected, const char *sentence)
{
    const mct_status status = runner_replay(path, &result, &why);
    TEST_ASSERT_EQUAL_INT_MESSAGE(expected, status, why.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, sentence), why.text);
    TEST_ASSERT_FALSE(result.equal);
}

static void test_what_is_no_log_is_refused_with_a_sentence(void)
{
    expect_error(MCT_ERROR_IO, "cannot be read: No such file");
    write_file(0);
    expect_error(MCT_ERROR_IO, "empty");
    memset(bytes, 'x', 1000);
    write_file(1000);
    expect_error(MCT_ERROR_SYNTAX, "something else than an event log");
    write_file(2);
    expect_error(MCT_ERROR_IO, "ends before its scene");
    const char *const here = strrchr(path, '/');
    char file[64];
    memcpy(file, path, sizeof file);
    path[here - path + 1] = '\0'; /* the folder */
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, runner_replay(path, &result, &why));
    memcpy(path, file, sizeof file);
}

static void test_a_log_of_something_else_is_refused(void)
{
    record(swing_up_scene, 20);
    uint8_t *const channel = bytes + HEADER_SIZE;
    channel[0] = 'X'; /* no scene */
    write_file(size);
    expect_error(MCT_ERROR_IO, "holds no scene");
    channel[0] = 'M';
    bytes[HEADER_SIZE + strlen(MCT_CHANNEL_SCENE)] ^= 1; /* hash of the scene's type */
    write_file(size);
    expect_error(MCT_ERROR_UNSUITED, "another version");
    bytes[HEADER_SIZE + strlen(MCT_CHANNEL_SCENE)] ^= 1;
    bytes[HEADER_SIZE + strlen(MCT_CHANNEL_SCENE) + 27] ^= 2; /* our version */
    write_file(size);
    expect_error(MCT_ERROR_UNSUITED, "another version");
    bytes[HEADER_SIZE + strlen(MCT_CHANNEL_SCENE) + 27] ^= 2;
    uint8_t *precision = memmem(bytes, size, MCT_REAL_IS_FLOAT ? "float" : "double", 5);
    memcpy(precision, "other", 5);
    write_file(size);
    expect_error(MCT_ERROR_UNSUITED, "precision; this replays");
}

static void test_a_tick_that_is_missing_ends_the_replay(void)
{
    record(swing_up_scene, 50);
    size_t length;
    const size_t next = tick_data(31, &length) - HEADER_SIZE - strlen(MCT_CHANNEL_TICK);
    const size_t gap = tick_data(30, &length) - HEADER_SIZE - strlen(MCT_CHANNEL_TICK);
    memmove(bytes + gap, bytes + next, size - next);
    write_file(size - (next - gap));
    expect_error(MCT_ERROR_IO, "found tick 31 where tick 30 should be");
    TEST_ASSERT_TRUE(result.ticks == 30);
}

/* Events of others in between: their channels are passed over, whatever their length. */
static void test_other_channels_are_passed_over(void)
{
    record(swing_up_scene, 50);
    static uint8_t stranger[200000] = {0xED, 0xA1, 0xDA, 0x01};
    const uint32_t length = sizeof stranger - HEADER_SIZE - 3;
    stranger[23] = 3; /* length of the channel */
    stranger[25] = (uint8_t)(length >> 16);
    stranger[26] = (uint8_t)(length >> 8);
    stranger[27] = (uint8_t)length;
    memcpy(stranger + HEADER_SIZE, "ABC", 3);
    size_t data;
    const size_t place = tick_data(20, &data) - HEADER_SIZE - strlen(MCT_CHANNEL_TICK);
    memmove(bytes + place + sizeof stranger, bytes + place, size - place);
    memcpy(bytes + place, stranger, sizeof stranger);
    write_file(size + sizeof stranger);
    expect_equal(50);
}

static uint64_t random_state = 1;

static uint32_t random_below(uint32_t bound)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (uint32_t)((random_state * UINT64_C(2685821657736338717)) >> 33) % bound;
}

/* Bytes changed anywhere, lengths among them: any answer will do, but for equality with all ticks when a tick
 * was hit. */
static void test_a_damaged_log_is_never_believed_and_never_fatal(void)
{
    static uint8_t good[1 << 16];
    record(swing_up_scene, 60);
    TEST_ASSERT_TRUE(size < sizeof good);
    memcpy(good, bytes, size);
    for (int i = 0; i < 3000; i++) {
        memcpy(bytes, good, size);
        const uint32_t changes = 1 + random_below(4);
        for (uint32_t j = 0; j < changes; j++) {
            bytes[random_below((uint32_t)size)] = (uint8_t)(random_below(3) == 0 ? 0xFF : random_below(256));
        }
        write_file(size - (random_below(4) == 0 ? random_below((uint32_t)size) : 0));
        const mct_status status = runner_replay(path, &result, &why);
        TEST_ASSERT_TRUE(status == MCT_OK || why.text[0] != '\0');
        TEST_ASSERT_TRUE(status == MCT_OK || !result.equal);
        TEST_ASSERT_TRUE(result.ticks <= 60);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_replay_of_a_swing_up_has_the_same_bits);
    RUN_TEST(test_a_replay_of_a_cart_pole_has_the_same_bits);
    RUN_TEST(test_a_replay_of_free_motion_and_of_a_sine_has_the_same_bits);
    RUN_TEST(test_a_csv_input_is_taken_from_the_log);
    RUN_TEST(test_overrides_are_part_of_the_log);
    RUN_TEST(test_faults_of_sensors_are_replayed);
    RUN_TEST(test_faults_from_outside_are_replayed);
    RUN_TEST(test_any_bit_of_a_tick_that_is_flipped_is_named);
    RUN_TEST(test_values_that_differ_are_told);
    RUN_TEST(test_a_plant_with_other_parameters_differs_at_the_first_step);
    RUN_TEST(test_a_log_that_is_cut_replays_up_to_its_last_whole_event);
    RUN_TEST(test_what_is_no_log_is_refused_with_a_sentence);
    RUN_TEST(test_a_log_of_something_else_is_refused);
    RUN_TEST(test_a_tick_that_is_missing_ends_the_replay);
    RUN_TEST(test_other_channels_are_passed_over);
    RUN_TEST(test_a_damaged_log_is_never_believed_and_never_fatal);
    return UNITY_END();
}

#else
#include "telemetry/without_lcm.h"
#endif

/* The simulated HAL: counts, noise, latency, faults; the motor is at zero volts whenever it must be. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "hal/sim/sim.h"
#include "support/quad.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

#define TURN 6.283185307179586

static mct_sim sim;
static mct_hal hal;

void setUp(void)
{
}

void tearDown(void)
{
}

static mct_scene wheel(void)
{
    mct_scene scene =
        scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_QUASI_STATIC);
    scene.initial[0] = 2;
    return scene;
}

static void begin(const mct_scene *scene)
{
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, mct_sim_init(&sim, scene, &why), why.text);
    hal = mct_sim_hal(&sim);
    TEST_ASSERT_EQUAL_INT(MCT_OK, hal.ops->open(hal.context, NULL));
}

static mct_reading read_once(void)
{
    mct_reading reading;
    memset(&reading, 0xA5, sizeof reading);
    TEST_ASSERT_EQUAL_INT(MCT_OK, hal.ops->read(hal.context, &reading));
    return reading;
}

static void drive(int tick)
{
    TEST_ASSERT_EQUAL_INT(MCT_OK, hal.ops->write(hal.context, (mct_real)(10 * sin(0.005 * tick))));
    TEST_ASSERT_EQUAL_INT(MCT_OK, hal.ops->wait_tick(hal.context));
}

/* To the count, but where rounding of the plant's angle may decide. */
static void test_counts_are_the_plants_angles_in_counts_since_the_start(void)
{
    const mct_scene scene = wheel();
    begin(&scene);
    for (int k = 0; k < 20000; k++) {
        const mct_reading reading = read_once();
        TEST_ASSERT_EQUAL_UINT32(0, reading.flags);
        TEST_ASSERT_EQUAL_UINT32(0, reading.age_us);
        for (int i = 0; i < 2; i++) {
            const double exact = (mct_plant_value(&sim.plant, i) - scene.initial[i]) * 4096 / TURN;
            TEST_ASSERT_DOUBLE_WITHIN(0.5 + 1e-6, exact, reading.counts[i]);
        }
        drive(k);
    }
    TEST_ASSERT_TRUE(fabs(mct_plant_value(&sim.plant, 1)) > TURN);
}

/* A position of both halves of a state and whole turns, in counts. */
static quad exact_counts(const mct_state *state, int i, quad unit, double turn)
{
    return ((quad)state->x[i] + state->c[i]) * unit + (quad)state->turns[i] * turn;
}

/*
 * Held against quadruple precision, anywhere: of angles over a million turns, of lengths over kilometres, up to 1e9 counts
 * each. The count is the nearest whole one, or one of both where the rest is next to a half. Tolerance: some roundings of
 * the rest, of the counts within a turn or a length to twice the precision in float, and of those to one in double, where the
 * counts per radian are not known better.
 */
static void test_counts_are_exact_to_a_rounding_at_every_width_and_resolution(void)
{
    enum { CASES = 200000 };
    static const double resolutions[] = {4, 4096, 43958, 1e9};
    const double eps = (double)MCT_REAL_EPSILON;
    test_random random = {2024};
    for (int n = 0; n < 4; n++) {
        for (int i = 0; i < 2; i++) { /* a length and an angle */
            mct_scene scene = scene_of(CART_POLE, MCT_STEPPER_RK4, 0);
            scene.counts_per_unit[i] = resolutions[n];
            scene.initial[0] = -0.3;
            begin(&scene);
            const quad unit = i == 0 ? (quad)resolutions[n]
                                     : resolutions[n] / (2 * (quad)3.14159265358979323846264338327950288L);
            const double turn = i == 0 ? 0 : resolutions[n];
            mct_state *state = &sim.plant.state;
            const quad start = exact_counts(state, i, unit, turn);
            double worst = 0;
            for (int k = 0; k < TEST_CASES(CASES); k++) {
                sim.counter_shift = (uint32_t)random_in(&random, 0, 25);
                state->x[i] = (mct_real)(i == 0 ? random_in(&random, -1, 1) * random_scale(&random, 1e-6, 2e3)
                                                : random_in(&random, -TURN, TURN));
                state->c[i] = (mct_real)(random_in(&random, -0.5, 0.5) * eps) * state->x[i];
                state->turns[i] = i == 0 ? 0 : (int32_t)random_in(&random, -1e6, 1e6);
                const quad within = (quad)state->x[i] * unit;
                const quad exact = exact_counts(state, i, unit, turn) - start;
                const int64_t whole = (int64_t)(exact < 0 ? exact - (quad)0.5 : exact + (quad)0.5);
                const int32_t counts = read_once().counts[i];
                /* the shown bits stand for the count that is nearest */
                const uint32_t off = ((uint32_t)counts - (uint32_t)(uint64_t)whole) << sim.counter_shift;
                const int32_t by = (int32_t)off / (int32_t)(UINT32_C(1) << sim.counter_shift);
                const double error = (double)quad_abs((quad)(whole + by) - exact) - 0.5;
                const double size = (double)quad_abs(within);
                const double allowed = 4 * eps + 8 * size * (MCT_REAL_IS_FLOAT ? eps * eps : eps);
                TEST_ASSERT_TRUE(error <= allowed);
                worst = fmax(worst, error);
            }
            printf("%s, %g counts: at most half a count and %.1e\n", i == 0 ? "length" : "angle",
                   resolutions[n], worst);
        }
    }
}

static void test_a_narrow_counter_shows_the_low_bits_of_a_wide_one(void)
{
    static const int widths[] = {8, 12, 16, 24};
    for (int n = 0; n < 4; n++) {
        mct_scene scene = wheel();
        static int32_t wide[3000];
        for (int pass = 0; pass < 2; pass++) {
            scene.counter_bits = pass == 0 ? 32 : widths[n];
            begin(&scene);
            for (int k = 0; k < 3000; k++) {
                const int32_t counts = read_once().counts[1];
                if (pass == 0) {
                    wide[k] = counts;
                } else {
                    const uint32_t mask = (UINT32_C(1) << widths[n]) - 1;
                    TEST_ASSERT_EQUAL_UINT32((uint32_t)wide[k] & mask, (uint32_t)counts);
                }
                drive(k);
            }
        }
    }
}

static void test_a_cart_counts_by_the_metre(void)
{
    mct_scene scene = scene_of(CART_POLE, MCT_STEPPER_RK4, MCT_GRAVITY);
    scene.initial[0] = -0.1;
    scene.initial[2] = 0.5;
    begin(&scene);
    for (int k = 0; k < 2000; k++) {
        const double exact = (mct_plant_value(&sim.plant, 0) + 0.1) * scene.counts_per_unit[0];
        TEST_ASSERT_DOUBLE_WITHIN(MCT_REAL_IS_FLOAT ? 0.6 : 0.5 + 1e-6, exact, read_once().counts[0]);
        drive(0);
    }
}

/* Standing still: mean 0, the standard deviation asked for (with that of rounding, 1/12), no memory, none
 * between encoders. */
static void test_noise_has_its_statistics_and_no_memory(void)
{
    enum { SAMPLES = 200000 };
    mct_scene scene = wheel();
    scene.effects = 0;
    scene.noise = 3;
    scene.sensor_seed = 42;
    begin(&scene);
    double sum = 0, square = 0, lagged = 0, cross = 0, fourth = 0, before = 0;
    for (int k = 0; k < SAMPLES; k++) {
        const mct_reading reading = read_once();
        const double a = reading.counts[0];
        sum += a;
        square += a * a;
        fourth += a * a * a * a;
        lagged += a * before;
        cross += a * reading.counts[1];
        before = a;
        TEST_ASSERT_EQUAL_INT(MCT_OK, hal.ops->wait_tick(hal.context));
    }
    const double variance = square / SAMPLES;
    const double expected = 9 + 1.0 / 12;
    printf("noise: mean %.4f, standard deviation %.4f, kurtosis %.3f, correlations %.4f %.4f\n",
           sum / SAMPLES, sqrt(variance), fourth / SAMPLES / (variance * variance), lagged / square,
           cross / square);
    /* five standard errors of each */
    TEST_ASSERT_DOUBLE_WITHIN(5 * 3 / sqrt(SAMPLES), 0, sum / SAMPLES);
    TEST_ASSERT_DOUBLE_WITHIN(5 * expected * sqrt(2.0 / SAMPLES), expected, variance);
    TEST_ASSERT_DOUBLE_WITHIN(5 / sqrt(SAMPLES), 0, lagged / square);
    TEST_ASSERT_DOUBLE_WITHIN(5 / sqrt(SAMPLES), 0, cross / square);
    TEST_ASSERT_DOUBLE_WITHIN(
        0.1, 2.7, fourth / SAMPLES / (variance * variance)); /* of a sum of four uniform numbers */
}

static void test_the_same_seed_gives_the_same_counts_and_another_seed_others(void)
{
    static int32_t first[1000];
    mct_scene scene = wheel();
    scene.noise = 1;
    for (int pass = 0; pass < 3; pass++) {
        scene.sensor_seed = pass == 2 ? 8 : 7;
        begin(&scene);
        int different = 0;
        for (int k = 0; k < 1000; k++) {
            const int32_t counts = read_once().counts[0];
            first[k] = pass == 0 ? counts : first[k];
            different += counts != first[k];
            drive(k);
        }
        TEST_ASSERT_TRUE(pass == 2 ? different > 500 : different == 0);
    }
}

static void test_latency_delivers_the_counts_of_that_many_ticks_ago_and_their_age(void)
{
    static int32_t fresh[500][2];
    for (int latency = 0; latency <= MCT_MAX_LATENCY; latency++) {
        mct_scene scene = wheel();
        scene.noise = 1;
        scene.latency = latency;
        begin(&scene);
        for (int k = 0; k < 500; k++) {
            const mct_reading reading = read_once();
            for (int i = 0; i < 2; i++) {
                fresh[k][i] = latency == 0 ? reading.counts[i] : fresh[k][i];
                TEST_ASSERT_EQUAL_INT32(fresh[k < latency ? 0 : k - latency][i], reading.counts[i]);
            }
            TEST_ASSERT_EQUAL_UINT32((uint32_t)latency * 1000, reading.age_us);
            drive(k);
        }
    }
}

static void test_faults_begin_and_end_on_their_ticks(void)
{
    static const struct {
        int fault;
        uint32_t flags;
    } cases[] = {{MCT_SENSOR_FAULT_NAN, MCT_READING_INVALID},
                 {MCT_SENSOR_FAULT_SILENT, MCT_READING_MISSING},
                 {MCT_SENSOR_FAULT_FROZEN, 0}};
    for (int n = 0; n < 3; n++) {
        mct_scene scene = wheel();
        scene.sensor_fault = cases[n].fault;
        scene.sensor_fault_time = 0.1;
        scene.sensor_fault_duration = 0.02;
        begin(&scene);
        mct_reading before = read_once();
        for (int k = 0; k < 200; k++) {
            const mct_reading reading = k == 0 ? before : read_once();
            const bool faulty = k >= 100 && k < 120;
            TEST_ASSERT_EQUAL_UINT32(faulty ? cases[n].flags : 0, reading.flags);
            if (faulty) {
                TEST_ASSERT_EQUAL_INT32(before.counts[0], reading.counts[0]);
                const bool silent = cases[n].fault == MCT_SENSOR_FAULT_SILENT;
                TEST_ASSERT_EQUAL_UINT32(silent ? 1000 * (uint32_t)(k - 99) : 0, reading.age_us);
            } else {
                before = reading;
                TEST_ASSERT_EQUAL_UINT32(0, reading.age_us);
            }
            drive(k);
        }
    }
}

static void test_open_stop_and_close_leave_the_motor_at_zero_volts(void)
{
    const mct_scene scene = wheel();
    begin(&scene);
    hal.ops->wait_tick(hal.context);
    TEST_ASSERT_TRUE(sim.plant.input == 0);
    for (int k = 0; k < 2; k++) {
        hal.ops->write(hal.context, 7);
        hal.ops->wait_tick(hal.context);
        TEST_ASSERT_TRUE(sim.plant.input == 7);
        (k == 0 ? hal.ops->stop : hal.ops->close)(hal.context);
        hal.ops->wait_tick(hal.context);
        TEST_ASSERT_TRUE(sim.plant.input == 0);
    }
}

static void test_lockstep_time_knows_no_jitter_and_the_plants_state_is_there_to_see(void)
{
    const mct_scene scene = wheel();
    begin(&scene);
    for (int k = 0; k < 100; k++) {
        drive(k);
    }
    TEST_ASSERT_TRUE(hal.ops->plant(hal.context) == &sim.plant.state);
    const mct_timing *const timing = hal.ops->timing(hal.context);
    TEST_ASSERT_EQUAL_UINT64(0, timing->missed_ticks);
    TEST_ASSERT_EQUAL_UINT32(0, timing->lateness.worst_us);
    TEST_ASSERT_EQUAL_UINT64(100, sim.plant.tick);
}

static void test_a_variation_changes_the_plant_and_nothing_else(void)
{
    mct_scene scene = wheel();
    scene.variation_spread = 0.1;
    scene.variation_seed = 4;
    begin(&scene);
    mct_scene varied;
    mct_scene_vary(&scene, &varied);
    mct_plant plant;
    start_plant(&plant, &varied);
    TEST_ASSERT_EQUAL_MEMORY(&plant.constants.reaction_wheel.motor, &sim.plant.constants.reaction_wheel.motor,
                             sizeof(mct_motor));
    TEST_ASSERT_TRUE(plant.constants.reaction_wheel.wheel_inertia ==
                     sim.plant.constants.reaction_wheel.wheel_inertia);
    TEST_ASSERT_TRUE(varied.parameters[0] != scene.parameters[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_counts_are_the_plants_angles_in_counts_since_the_start);
    RUN_TEST(test_counts_are_exact_to_a_rounding_at_every_width_and_resolution);
    RUN_TEST(test_a_narrow_counter_shows_the_low_bits_of_a_wide_one);
    RUN_TEST(test_a_cart_counts_by_the_metre);
    RUN_TEST(test_noise_has_its_statistics_and_no_memory);
    RUN_TEST(test_the_same_seed_gives_the_same_counts_and_another_seed_others);
    RUN_TEST(test_latency_delivers_the_counts_of_that_many_ticks_ago_and_their_age);
    RUN_TEST(test_faults_begin_and_end_on_their_ticks);
    RUN_TEST(test_open_stop_and_close_leave_the_motor_at_zero_volts);
    RUN_TEST(test_lockstep_time_knows_no_jitter_and_the_plants_state_is_there_to_see);
    RUN_TEST(test_a_variation_changes_the_plant_and_nothing_else);
    return UNITY_END();
}

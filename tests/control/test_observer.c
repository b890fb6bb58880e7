/*
 * Rates from counts. The encoder of a wheel without forces, 4096 counts a turn, follows a prescribed motion;
 * the observer's model knows nothing of it, unless the test says so.
 *
 * Bounds: with p = exp(-bandwidth h), one count moves the rate by (1 - p)^2 unit / h, and rounding of the
 * position by half a count either way at most by four times that while it settles; an acceleration that the
 * model does not know makes the rate lag by h (1 + p) / (1 - p) times the acceleration.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/observer.h"
#include "support/random.h"
#include "support/scenes.h"
#include "unity.h"

#define TURN      6.283185307179586
#define UNIT      (TURN / 4096)
#define H         1e-3
#define BANDWIDTH 150.0

void setUp(void)
{
}

void tearDown(void)
{
}

static mct_scene forceless(double start, int bits)
{
    mct_scene scene = scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, 0);
    scene.initial[0] = start;
    scene.initial[1] = start;
    scene.counter_bits = bits;
    scene.observer_bandwidth = BANDWIDTH;
    return scene;
}

typedef struct {
    mct_scene scene;
    mct_constants constants;
    mct_observer observer;
    uint32_t mask;
    uint32_t first; /* what the counters showed at the start */
} bench;

static void start(bench *self, const mct_scene *scene, uint32_t first)
{
    self->scene = *scene;
    self->first = first;
    self->mask = scene->counter_bits == 32 ? UINT32_MAX : (UINT32_C(1) << scene->counter_bits) - 1;
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          mct_systems[scene->system]->prepare(scene, scene->dt, &self->constants, NULL));
    mct_observer_init(&self->observer, scene, &self->constants);
}

/* Hands over what encoders show that have moved by a way [rad] since the start. */
static void feed(bench *self, double way, uint32_t flags)
{
    mct_reading reading;
    memset(&reading, 0, sizeof reading);
    const int64_t counts = llround(way / UNIT);
    for (int i = 0; i < 2; i++) {
        reading.counts[i] = (int32_t)((self->first + (uint32_t)(uint64_t)counts) & self->mask);
    }
    reading.flags = flags;
    mct_observer_update(&self->observer, &reading, 0);
}

static double pole(void)
{
    return exp(-BANDWIDTH * H);
}

static double count_error(void)
{
    return 4 * (1 - pole()) * (1 - pole()) * UNIT / H;
}

static double lag(double acceleration)
{
    return H * (1 + pole()) / (1 - pole()) * acceleration;
}

/* Rounding of the observer's own arithmetic at this rate. */
static double rounding(double rate)
{
    return 100 * (double)MCT_REAL_EPSILON * rate;
}

static void test_a_ramp_has_no_lag_at_any_rate(void)
{
    static const double rates[] = {0.2, 1, 7, 33, -150, 400};
    for (size_t n = 0; n < sizeof rates / sizeof rates[0]; n++) {
        static bench self;
        const mct_scene scene = forceless(0, 32);
        start(&self, &scene, 0);
        double worst = 0;
        double mean = 0;
        for (int k = 0; k < 4000; k++) {
            feed(&self, rates[n] * k * H, 0);
            if (k >= 1000) {
                const double error = (double)self.observer.x[3] - rates[n];
                worst = fmax(worst, fabs(error));
                mean += error / 3000;
            }
        }
        printf("ramp of %g rad/s: off by %.4f at most, %.5f in the mean\n", rates[n], worst, mean);
        TEST_ASSERT_TRUE(worst < count_error() + rounding(rates[n]));
        TEST_ASSERT_TRUE(fabs(mean) < 1e-3 + rounding(fabs(rates[n])));
    }
}

/* The rate answers a step of the count as a double pole p does, n p^(n-1) times the first answer: no overshoot. */
static void test_a_step_of_the_count_is_answered_by_a_double_pole(void)
{
    static bench self;
    const mct_scene scene = forceless(0, 32);
    const double p = pole();
    const double first = (1 - p) * (1 - p) * 500 * UNIT / H;
    start(&self, &scene, 0);
    feed(&self, 0, 0);
    feed(&self, 0, 0);
    for (int n = 1; n < 200; n++) {
        feed(&self, 500 * UNIT, 0);
        const double expected = first * n * pow(p, n - 1);
        TEST_ASSERT_DOUBLE_WITHIN(first * 1000 * (double)MCT_REAL_EPSILON, expected,
                                  (double)self.observer.x[3]);
    }
}

static void test_a_sine_is_followed_within_the_lag_of_its_acceleration(void)
{
    static const double frequencies[] = {2, 9, 30};
    for (int n = 0; n < 3; n++) {
        static bench self;
        const double w = frequencies[n];
        const mct_scene scene = forceless(0, 32);
        start(&self, &scene, 0);
        double worst = 0;
        for (int k = 0; k < 5000; k++) {
            feed(&self, 0.5 * sin(w * k * H), 0);
            const double error = (double)self.observer.x[2] - 0.5 * w * cos(w * k * H);
            worst = k >= 1000 ? fmax(worst, fabs(error)) : worst;
        }
        printf("sine of %g rad/s, 0.5 rad: off by %.4f rad/s at most, bound %.4f\n", w, worst,
               lag(0.5 * w * w) + count_error());
        TEST_ASSERT_TRUE(worst < lag(0.5 * w * w) + count_error());
    }
}

/* A driven pendulum whose model is right: what is left is the counts', no lag. */
static void test_a_right_model_leaves_no_lag(void)
{
    mct_scene scene =
        scene_of(REACTION_WHEEL, MCT_STEPPER_EXPO, MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_QUASI_STATIC);
    scene.initial[0] = 2;
    scene.observer_bandwidth = BANDWIDTH;
    static bench self;
    start(&self, &scene, 0);
    mct_plant plant;
    start_plant(&plant, &scene);
    double worst[2] = {0, 0};
    mct_real applied = 0;
    for (int k = 0; k < 10000; k++) {
        mct_reading reading;
        memset(&reading, 0, sizeof reading);
        for (int i = 0; i < 2; i++) {
            reading.counts[i] = (int32_t)llround((mct_plant_value(&plant, i) - scene.initial[i]) / UNIT);
        }
        mct_observer_update(&self.observer, &reading, applied);
        for (int i = 0; i < 2; i++) {
            worst[i] = k < 1000 ? 0
                                : fmax(worst[i],
                                       fabs((double)self.observer.x[2 + i] - mct_plant_value(&plant, 2 + i)));
        }
        applied = (mct_real)(10 * sin(5 * k * H));
        mct_plant_step(&plant, applied);
    }
    printf("right model: arm's rate within %.4f rad/s, wheel's within %.4f\n", worst[0], worst[1]);
    TEST_ASSERT_TRUE(worst[0] < count_error() && worst[1] < count_error() + rounding(300));
}

/* Estimates do not know how wide a counter is, nor where it stood: the same bits. */
static void test_a_counters_width_and_its_wrap_change_no_bit_of_an_estimate(void)
{
    static const struct {
        int bits;
        uint32_t first;
    } counters[] = {{32, 0},      {32, 0x7fffffc0}, {32, 0xffffffe0}, {16, 0},   {16, 0xfff0},
                    {16, 0x7ff0}, {8, 0},           {8, 0xf8},        {8, 0x7c}, {12, 0}};
    enum { COUNTERS = sizeof counters / sizeof counters[0] };
    static bench benches[COUNTERS];
    for (int n = 0; n < COUNTERS; n++) {
        const mct_scene scene = forceless(1.0, counters[n].bits);
        start(&benches[n], &scene, counters[n].first);
    }
    for (int k = 0; k < 20000; k++) {
        const double way = 60 * sin(2.5 * k * H) + 20 * sin(0.3 * k * H); /* up to 100 counts a tick */
        for (int n = 0; n < COUNTERS; n++) {
            feed(&benches[n], way, 0);
            for (int i = 0; i < 4; i++) {
                TEST_ASSERT_TRUE(benches[n].observer.x[i] == benches[0].observer.x[i]);
            }
        }
    }
}

static void test_positions_start_where_the_scene_says_and_angles_stay_within_half_a_turn(void)
{
    static const double starts[] = {0, 3.141592653589793, -3.141592653589793, 6.2, -6.2, 100, -1000.5};
    for (size_t n = 0; n < sizeof starts / sizeof starts[0]; n++) {
        static bench self;
        const mct_scene scene = forceless(starts[n], 16);
        start(&self, &scene, 77);
        for (int k = 0; k < 8000; k++) {
            const double way = (n % 2 ? 9.0 : -9.0) * k * H;
            feed(&self, way, 0);
            const double x = (double)self.observer.x[0];
            TEST_ASSERT_DOUBLE_WITHIN(k == 0 ? TURN : TURN / 2 + 1e-4, 0, x);
            if (k > 200) { /* settled, counts' half and what the rate lacks */
                TEST_ASSERT_DOUBLE_WITHIN(2 * UNIT, 0, angle_size(x - (starts[n] + way)));
            }
        }
    }
}

/* Far beyond what a counter of 32 bits shows, there and back. Tolerance: roundings of the position, once it has settled. */
static void test_a_length_is_counted_beyond_32_bits(void)
{
    enum { STEPS = 1000, REST = 300 };
    static const int64_t ways[] = {1000000000000, -1000000000000, 3, -1 - (INT64_C(1) << 30),
                                   INT64_C(1) << 32};
    static bench self;
    mct_scene scene = scene_of(CART_POLE, MCT_STEPPER_RK4, 0);
    scene.counts_per_unit[0] = 1e9;
    scene.observer_bandwidth = BANDWIDTH;
    scene.initial[0] = 0.25;
    start(&self, &scene, 0);
    feed(&self, 0, 0);
    int64_t from = 0;
    for (size_t n = 0; n < sizeof ways / sizeof ways[0]; n++) {
        for (int64_t k = 1; k <= STEPS + REST; k++) { /* by less than 2^31 counts each */
            const int64_t counts = k < STEPS ? from + (ways[n] - from) / STEPS * k : ways[n];
            mct_reading reading = {{(int32_t)(uint32_t)(uint64_t)counts, 0}, 0, 0};
            mct_observer_update(&self.observer, &reading, 0);
        }
        const double exact = 0.25 + (double)ways[n] * 1e-9;
        TEST_ASSERT_DOUBLE_WITHIN(4 * (double)MCT_REAL_EPSILON * (1 + fabs(exact)), exact,
                                  (double)self.observer.x[0]);
        from = ways[n];
    }
}

static void test_the_very_first_estimate_of_an_angle_is_within_half_a_turn(void)
{
    static bench self;
    const mct_scene scene = forceless(6.2, 32);
    start(&self, &scene, 0);
    feed(&self, 0, 0);
    TEST_ASSERT_DOUBLE_WITHIN(TURN / 2 + 1e-4, 0, (double)self.observer.x[0]);
}

/* Ten ticks in each hundred are missing, their counts stand still: nothing is lost, the rate goes on. */
static void test_missing_readings_lose_no_count_and_keep_the_rate(void)
{
    static bench self;
    const mct_scene scene = forceless(0, 16);
    start(&self, &scene, 0);
    double held = 0;
    double worst = 0;
    for (int k = 0; k < 20000; k++) {
        const double way = 33.3 * k * H;
        const bool missing = k % 100 >= 90;
        held = missing ? held : way;
        feed(&self, held, missing ? MCT_READING_MISSING : 0);
        if (k > 1000) {
            worst = fmax(worst, fabs((double)self.observer.x[3] - 33.3));
            TEST_ASSERT_TRUE(angle_size((double)self.observer.x[1] - way) < 3 * UNIT);
        }
    }
    TEST_ASSERT_TRUE(worst < count_error() + rounding(33));
}

/* What has moved unseen for a second: the count says where it is, not how fast it is. */
static void test_a_jump_after_a_long_gap_moves_the_position_and_not_the_rate(void)
{
    static bench self;
    const mct_scene scene = forceless(0, 32);
    start(&self, &scene, 0);
    for (int k = 0; k < 1000; k++) {
        feed(&self, 0, 0);
    }
    for (int k = 0; k < 1000; k++) {
        feed(&self, 0, MCT_READING_MISSING);
    }
    for (int k = 0; k < 100; k++) {
        feed(&self, 1000.5, 0);
        TEST_ASSERT_TRUE(fabs((double)self.observer.x[3]) < 1e-6);
        TEST_ASSERT_TRUE(angle_size((double)self.observer.x[1] - 1000.5) < 3 * UNIT);
    }
}

static void test_nothing_is_estimated_before_the_first_valid_reading(void)
{
    static bench self;
    const mct_scene scene = forceless(2, 32);
    start(&self, &scene, 0);
    for (int k = 0; k < 10; k++) {
        feed(&self, 1000, MCT_READING_INVALID);
        TEST_ASSERT_FALSE(self.observer.started);
        TEST_ASSERT_TRUE(self.observer.x[0] == 2 && self.observer.x[2] == 0);
    }
    feed(&self, 1000, 0); /* wherever the counter stands, it stands for the start */
    TEST_ASSERT_TRUE(self.observer.started);
    TEST_ASSERT_TRUE(self.observer.x[0] == 2);
}

/* 2.8 hours: 35 000 turns of the wheel. The position is the counter's, so nothing adds up. */
static void test_a_position_does_not_drift_in_1e7_ticks(void)
{
    static bench self;
    const mct_scene scene = forceless(0.5, 32);
    start(&self, &scene, 0);
    double worst = 0;
    const int ticks = TEST_CASES(10000000);
    for (int k = 0; k < ticks; k++) {
        feed(&self, 22.2 * H * k, 0);
        if (k % 1000 == 999) {
            worst = fmax(worst, angle_size((double)self.observer.x[1] - (0.5 + 22.2 * H * k)));
        }
    }
    printf("after %d ticks: within %.2f counts\n", ticks, worst / UNIT);
    TEST_ASSERT_TRUE(worst < 2 * UNIT);
    TEST_ASSERT_DOUBLE_WITHIN(count_error(), 22.2, (double)self.observer.x[3]);
}

/* A deviation fades by p^2 a tick, in 2 s through all numbers there are. */
static void test_at_a_standstill_the_estimate_comes_to_rest_and_not_into_denormal_numbers(void)
{
    const mct_scene scene = forceless(0, 32);
    bench self;
    start(&self, &scene, 0);
    for (int tick = 0; tick < 10000; tick++) {
        feed(&self, tick < 100 ? 0.01 * tick : 1, 0);
    }
    for (int i = 0; i < 2; i++) {
        TEST_ASSERT_TRUE(self.observer.x[2 + i] == 0);
        TEST_ASSERT_TRUE(self.observer.encoders[i].deviation == 0);
        TEST_ASSERT_DOUBLE_WITHIN(UNIT, 1, (double)self.observer.x[i]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_ramp_has_no_lag_at_any_rate);
    RUN_TEST(test_a_step_of_the_count_is_answered_by_a_double_pole);
    RUN_TEST(test_a_sine_is_followed_within_the_lag_of_its_acceleration);
    RUN_TEST(test_a_right_model_leaves_no_lag);
    RUN_TEST(test_a_counters_width_and_its_wrap_change_no_bit_of_an_estimate);
    RUN_TEST(test_positions_start_where_the_scene_says_and_angles_stay_within_half_a_turn);
    RUN_TEST(test_a_length_is_counted_beyond_32_bits);
    RUN_TEST(test_the_very_first_estimate_of_an_angle_is_within_half_a_turn);
    RUN_TEST(test_missing_readings_lose_no_count_and_keep_the_rate);
    RUN_TEST(test_a_jump_after_a_long_gap_moves_the_position_and_not_the_rate);
    RUN_TEST(test_nothing_is_estimated_before_the_first_valid_reading);
    RUN_TEST(test_a_position_does_not_drift_in_1e7_ticks);
    RUN_TEST(test_at_a_standstill_the_estimate_comes_to_rest_and_not_into_denormal_numbers);
    return UNITY_END();
}

/* Bit timing of a bxCAN against the limits of its manual, tried out one by one. */
#include "hal/cortex_m/stm32f4/bit_timing.c"

#include "unity.h"

static const uint32_t clocks[] = {42000000, 45000000, 36000000, 16000000};
enum { CLOCKS = sizeof clocks / sizeof clocks[0], LOWEST = 10000, HIGHEST = 1000000 };

void setUp(void)
{
}

void tearDown(void)
{
}

/* RM0090, 32.9.2, CAN_BTR: fields of 10, 4 and 3 bits, each one less than its value; 8 to 25 quanta. */
static bool can_be_met(uint32_t clock_hz, uint32_t bitrate)
{
    for (uint32_t segment_1 = 1; segment_1 <= 16; segment_1++) {
        for (uint32_t segment_2 = 2; segment_2 <= 8; segment_2++) {
            const uint32_t quanta = 1 + segment_1 + segment_2;
            const uint64_t prescaler = clock_hz / ((uint64_t)quanta * bitrate);
            if (quanta >= 8 && prescaler >= 1 && prescaler <= 1024 &&
                (uint64_t)prescaler * quanta * bitrate == clock_hz) {
                return true;
            }
        }
    }
    return false;
}

static void test_every_bitrate_that_can_be_met_exactly_is_met_and_no_other(void)
{
    int met = 0;
    for (int i = 0; i < CLOCKS; i++) {
        for (uint32_t bitrate = LOWEST; bitrate <= HIGHEST; bitrate++) {
            mct_bit_timing timing;
            const bool found = mct_bit_timing_find(clocks[i], bitrate, &timing);
            if (found != can_be_met(clocks[i], bitrate)) {
                TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, bitrate, found ? "not exact" : "refused");
            }
            if (found) {
                const uint32_t quanta = 1 + timing.segment_1 + timing.segment_2;
                TEST_ASSERT_EQUAL_UINT32(clocks[i], bitrate * quanta * timing.prescaler);
                TEST_ASSERT_TRUE(quanta >= 8 && quanta <= 25 && timing.prescaler <= 1024);
                TEST_ASSERT_TRUE(timing.segment_1 >= 1 && timing.segment_1 <= 16);
                TEST_ASSERT_TRUE(timing.segment_2 >= 2 && timing.segment_2 <= 8);
                TEST_ASSERT_TRUE(timing.jump >= 1 && timing.jump <= 4 && timing.jump <= timing.segment_2);
                met++;
            }
        }
    }
    TEST_ASSERT_TRUE(met > 100);
}

/* By hand: of 42 cycles 21 quanta, sampled behind 16; of 84, 21 quanta, sampled behind 18; ... */
static void test_usual_bitrates_have_the_usual_sample_points(void)
{
    static const struct {
        uint32_t clock_hz, bitrate, point; /* [1/1000] */
    } cases[] = {{42000000, 1000000, 750}, {42000000, 500000, 875}, {42000000, 250000, 875},
                 {42000000, 125000, 875},  {42000000, 100000, 875}, {42000000, 50000, 875},
                 {42000000, 20000, 875},   {42000000, 10000, 875},  {16000000, 1000000, 750},
                 {16000000, 800000, 800},  {36000000, 500000, 875}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        mct_bit_timing timing;
        TEST_ASSERT_TRUE(mct_bit_timing_find(cases[i].clock_hz, cases[i].bitrate, &timing));
        const uint32_t quanta = 1 + timing.segment_1 + timing.segment_2;
        /* half a quantum of the shortest bit, 1/16, is all that may be left over */
        TEST_ASSERT_INT_WITHIN(32, cases[i].point, 1000 * (1 + timing.segment_1) / quanta);
    }
}

static void test_no_other_exact_timing_is_nearer_to_the_sample_point(void)
{
    for (uint32_t bitrate = LOWEST; bitrate <= 500000; bitrate++) {
        mct_bit_timing timing;
        if (!mct_bit_timing_find(42000000, bitrate, &timing)) {
            continue;
        }
        const double point = (1.0 + timing.segment_1) / (1 + timing.segment_1 + timing.segment_2);
        for (uint32_t segment_1 = 1; segment_1 <= 16; segment_1++) {
            for (uint32_t segment_2 = 2; segment_2 <= 8; segment_2++) {
                const uint32_t quanta = 1 + segment_1 + segment_2;
                const bool exact = quanta >= 8 && 42000000 % (bitrate * quanta) == 0 &&
                                   42000000 / (bitrate * quanta) <= 1024;
                const double other = (1.0 + segment_1) / quanta;
                const double off = point > 0.875 ? point - 0.875 : 0.875 - point;
                const double other_off = other > 0.875 ? other - 0.875 : 0.875 - other;
                /* points are compared in whole thousandths */
                TEST_ASSERT_TRUE(!exact || off <= other_off + 0.001);
            }
        }
    }
}

static void test_what_no_clock_can_make_is_refused(void)
{
    mct_bit_timing timing;
    TEST_ASSERT_FALSE(mct_bit_timing_find(42000000, 800000, &timing)); /* 52.5 cycles */
    TEST_ASSERT_FALSE(mct_bit_timing_find(42000000, 83333, &timing));
    TEST_ASSERT_FALSE(mct_bit_timing_find(42000000, 0, &timing));
    TEST_ASSERT_FALSE(mct_bit_timing_find(42000000, 1, &timing));
    TEST_ASSERT_FALSE(mct_bit_timing_find(42000000, 42000000, &timing));
    TEST_ASSERT_FALSE(mct_bit_timing_find(42000000, UINT32_MAX, &timing));
    TEST_ASSERT_FALSE(mct_bit_timing_find(0, 500000, &timing));
}

static void test_the_register_holds_each_number_less_one(void)
{
    const mct_bit_timing smallest = {1, 1, 1, 1};
    const mct_bit_timing largest = {1024, 16, 8, 4};
    const mct_bit_timing usual = {2, 15, 5, 4};
    TEST_ASSERT_EQUAL_HEX32(0, mct_bit_timing_register(&smallest));
    TEST_ASSERT_EQUAL_HEX32(0x037F03FF, mct_bit_timing_register(&largest));
    TEST_ASSERT_EQUAL_HEX32(0x034E0001, mct_bit_timing_register(&usual));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_bitrate_that_can_be_met_exactly_is_met_and_no_other);
    RUN_TEST(test_usual_bitrates_have_the_usual_sample_points);
    RUN_TEST(test_no_other_exact_timing_is_nearer_to_the_sample_point);
    RUN_TEST(test_what_no_clock_can_make_is_refused);
    RUN_TEST(test_the_register_holds_each_number_less_one);
    return UNITY_END();
}

#include "bit_timing.h"

enum { LEAST_QUANTA = 8, MOST_QUANTA = 25, MOST_PRESCALER = 1024 };
enum { MOST_SEGMENT_1 = 16, LEAST_SEGMENT_2 = 2, MOST_SEGMENT_2 = 8, MOST_JUMP = 4 };

/* [1/1000 of a bit] */
static uint32_t wanted_sample_point(uint32_t bitrate)
{
    return bitrate > 800000 ? 750 : bitrate > 500000 ? 800 : 875;
}

/* The segments of a bit whose sample point is nearest. */
static void divide(uint32_t quanta, uint32_t wanted, mct_bit_timing *timing)
{
    const uint32_t behind = (quanta * (1000 - wanted) + 500) / 1000;
    const uint32_t least =
        quanta > 1 + MOST_SEGMENT_1 + LEAST_SEGMENT_2 ? quanta - 1 - MOST_SEGMENT_1 : LEAST_SEGMENT_2;
    timing->segment_2 = behind < least ? least : behind > MOST_SEGMENT_2 ? MOST_SEGMENT_2 : behind;
    timing->segment_1 = quanta - 1 - timing->segment_2;
    timing->jump = timing->segment_2 < MOST_JUMP ? timing->segment_2 : MOST_JUMP;
}

bool mct_bit_timing_find(uint32_t clock_hz, uint32_t bitrate, mct_bit_timing *timing)
{
    const uint32_t wanted = wanted_sample_point(bitrate);
    const uint32_t cycles = bitrate > 0 && clock_hz % bitrate == 0 ? clock_hz / bitrate : 0;
    uint32_t nearest = UINT32_MAX;
    for (uint32_t quanta = MOST_QUANTA; quanta >= LEAST_QUANTA && cycles > 0; quanta--) {
        mct_bit_timing found = {.prescaler = cycles / quanta};
        if (cycles % quanta != 0 || found.prescaler > MOST_PRESCALER) {
            continue;
        }
        divide(quanta, wanted, &found);
        const int32_t point = (int32_t)(1000 * (1 + found.segment_1) / quanta);
        const int32_t off = point - (int32_t)wanted;
        const uint32_t distance = (uint32_t)(off < 0 ? -off : off);
        if (distance < nearest) {
            nearest = distance;
            *timing = found;
        }
    }
    return nearest < UINT32_MAX;
}

uint32_t mct_bit_timing_register(const mct_bit_timing *timing)
{
    return (timing->jump - 1) << 24 | (timing->segment_2 - 1) << 20 | (timing->segment_1 - 1) << 16 |
           (timing->prescaler - 1);
}

/* Seeded random numbers, the same on every machine and in both precisions (xorshift64*). */
#ifndef MCT_TEST_RANDOM_H
#define MCT_TEST_RANDOM_H

#include <math.h>
#include <stdint.h>

/*
 * How many random cases a test tries, how many ticks it lasts: of many, a tenth in builds with sanitizers. Those are ten
 * times as slow, and judge accesses, which do not differ from number to number. In an emulator, which is a hundred times
 * as slow, a hundredth.
 */
#ifndef MCT_TEST_FEWER
#define MCT_TEST_FEWER 1
#endif
#define TEST_CASES(count) (((count)-1) / MCT_TEST_FEWER + 1)

typedef struct {
    uint64_t state; /* not 0 */
} test_random;

static inline uint64_t random_bits(test_random *self)
{
    self->state ^= self->state >> 12;
    self->state ^= self->state << 25;
    self->state ^= self->state >> 27;
    return self->state * UINT64_C(2685821657736338717);
}

/* Uniform in [low, high). */
static inline double random_in(test_random *self, double low, double high)
{
    return low + (high - low) * ((double)(random_bits(self) >> 11) * 0x1p-53);
}

/* Its logarithm is uniform: every order of magnitude between low and high, both positive, is as likely. */
static inline double random_scale(test_random *self, double low, double high)
{
    return exp(random_in(self, log(low), log(high)));
}

#endif

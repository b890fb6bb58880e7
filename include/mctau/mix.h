/**
 * @file mix.h
 * Numbers that look random and depend on nothing but their arguments: noise and drawn parameters are the same on every
 * machine, in any order.
 */
#ifndef MCTAU_MIX_H
#define MCTAU_MIX_H

#include <stdint.h>

#define MCT_MIX_STEP \
    UINT64_C(0x9E3779B97F4A7C15) /**< 2^64 over the golden ratio: spreads counters before mixing */

/** The finaliser of splitmix64 (Steele, Lea, Flood 2014): every bit of z moves every bit of the result. */
static inline uint64_t mct_mix(uint64_t z)
{
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

#endif

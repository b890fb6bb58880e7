/* What count.c measures with: the board's timer, or nothing on the host. */
#ifndef MCTAU_TOOLS_CORTEX_M_TARGET_H
#define MCTAU_TOOLS_CORTEX_M_TARGET_H

#include <stdint.h>

#ifdef __arm__
#include "hal/cortex_m/mps2.h"
enum { TARGET_COUNTS = 1 };
#define target_start        mct_mps2_start
#define target_clock        mct_mps2_timer
#define target_instructions mct_mps2_instructions
#else
enum { TARGET_COUNTS = 0 };
static inline void target_start(void)
{
}
static inline uint32_t target_clock(void)
{
    return 0;
}
static inline uint32_t target_instructions(uint32_t begin, uint32_t end)
{
    return end - begin;
}
#endif

#endif

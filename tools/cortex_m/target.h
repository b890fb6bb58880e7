/* What images measure with: the board's timer and its stack, or nothing on the host. */
#ifndef MCTAU_TOOLS_CORTEX_M_TARGET_H
#define MCTAU_TOOLS_CORTEX_M_TARGET_H

#include <stdint.h>

#ifdef __arm__
#include "hal/cortex_m/mps2.h"
enum { TARGET_COUNTS = 1 };
#define target_start        mct_mps2_start
#define target_clock        mct_mps2_timer
#define target_instructions mct_mps2_instructions

/* Of hal/cortex_m/sections.ld: what is below the stack, and its upper end. */
extern uint32_t mct_bss_end[], mct_stack_top[];
enum {
    TARGET_PAINT = 0x57AC57AC,
    TARGET_MARGIN = 16
}; /* words of the present frame and a call's, at least */

/* From the end of the data to the present frame; in a call of its own, so that all others are above it. */
__attribute__((noinline, unused)) static void target_paint_stack(void)
{
    uint32_t here;
    for (uint32_t *word = mct_bss_end; word < &here - TARGET_MARGIN; word++) {
        *(volatile uint32_t *)word = TARGET_PAINT;
    }
}

/* How far the stack has grown since it was painted [bytes]. */
static inline uint32_t target_stack_used(void)
{
    const uint32_t *word = mct_bss_end;
    while (word < mct_stack_top && *word == TARGET_PAINT) {
        word++;
    }
    return (uint32_t)(mct_stack_top - word) * (uint32_t)sizeof *word;
}
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
static inline void target_paint_stack(void)
{
}
static inline uint32_t target_stack_used(void)
{
    return 0;
}
#endif

#endif

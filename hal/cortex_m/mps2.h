/**
 * @file mps2.h
 * Of ARM's board MPS2 (mps2-an386: Cortex-M4F, mps2-an500: Cortex-M7), as QEMU emulates it: CMSDK timer 0,
 * which counts instructions when the emulation's time is made of them (hal/cortex_m/run).
 *
 * Source: ARM DUI 0857 (CMSDK), APB timer; QEMU's option -icount.
 */
#ifndef MCTAU_HAL_CORTEX_M_MPS2_H
#define MCTAU_HAL_CORTEX_M_MPS2_H

#include <stdint.h>

typedef struct {
    volatile uint32_t control, value, reload, interrupt;
} mct_cmsdk_timer;

#define MCT_MPS2_TIMER0 ((mct_cmsdk_timer *)0x40000000)

/** Starts the timer; before the first reading. */
static inline void mct_mps2_start(void)
{
    MCT_MPS2_TIMER0->value = MCT_MPS2_TIMER0->reload = UINT32_MAX;
    MCT_MPS2_TIMER0->control = 1;
}

/** The timer now: it counts down, 25 MHz. */
static inline uint32_t mct_mps2_timer(void)
{
    return MCT_MPS2_TIMER0->value;
}

/**
 * Instructions between two readings, at most 167 million: `-icount shift=10` makes one of them 1024 ns, that
 * is 25.6 ticks of the timer. Exact: the readings' own rounding is less than a tick. A few instructions of
 * the reading itself are among them.
 */
static inline uint32_t mct_mps2_instructions(uint32_t begin, uint32_t end)
{
    return (uint32_t)(((uint64_t)(begin - end) * 10 + 128) / 256);
}

#endif

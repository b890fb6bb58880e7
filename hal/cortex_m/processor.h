/**
 * @file processor.h
 * What C has no words for. A test on the host has its own in their place.
 *
 * Source: ARMv7-M Architecture Reference Manual, B1.4.3 (PRIMASK), B1.5.18 (WFI).
 */
#ifndef MCTAU_HAL_CORTEX_M_PROCESSOR_H
#define MCTAU_HAL_CORTEX_M_PROCESSOR_H

#include <stdint.h>

/** Holds interrupts back; those that come wait. @return for mct_interrupts_restore: pairs may be nested */
static inline uint32_t mct_interrupts_hold(void)
{
    uint32_t before;
    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(before)::"memory");
    return before;
}

static inline void mct_interrupts_restore(uint32_t before)
{
    __asm__ volatile("msr primask, %0" ::"r"(before) : "memory");
}

/** Sleeps until an interrupt comes, also one that is held back. */
static inline void mct_interrupts_wait(void)
{
    __asm__ volatile("dsb\n\twfi" ::: "memory");
}

/** Writes a register whose bits act as they are written. */
static inline void mct_command(volatile uint32_t *place, uint32_t bits)
{
    *place = bits;
}

#endif

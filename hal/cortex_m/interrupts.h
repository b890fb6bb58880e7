/**
 * @file interrupts.h
 * What an interrupt must not come between. Source: ARMv7-M Architecture Reference Manual, B1.4.3 (PRIMASK).
 */
#ifndef MCTAU_HAL_CORTEX_M_INTERRUPTS_H
#define MCTAU_HAL_CORTEX_M_INTERRUPTS_H

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

#endif

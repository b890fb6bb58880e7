/**
 * @file systick.h
 * Time by SysTick: an interrupt for each tick of the loop, and the core's cycles since the start. hal/clock.h waits by it.
 * It counts cycles, so work and lateness need no other counter.
 *
 * Source: ARMv7-M Architecture Reference Manual, B3.3 (SysTick), B3.2.4 (ICSR).
 */
#ifndef MCTAU_HAL_CORTEX_M_SYSTICK_H
#define MCTAU_HAL_CORTEX_M_SYSTICK_H

#include <stdint.h>

#include "mctau/status.h"

/**
 * Starts it, once, ahead of all that reads the time.
 * @param core_mhz  frequency of the core [MHz], 1 to 1000
 * @param tick      period [s], rounded to whole cycles
 * @return MCT_OK; MCT_ERROR_RANGE where a tick is not 1000 to 2^24 cycles (100 ms at 168 MHz)
 */
mct_status mct_systick_start(uint32_t core_mhz, double tick);

/** Cycles since the start; only goes forward. From interrupts, too. Some 50 instructions. */
int64_t mct_systick_cycles(void);

/** The same in [us]. */
int64_t mct_systick_us(void);

#endif

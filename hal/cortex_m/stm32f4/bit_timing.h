/**
 * @file bit_timing.h
 * Bit timing of a bxCAN: a bit is 1 + segment_1 + segment_2 quanta, sampled between the segments. Plain C.
 *
 * Source: RM0090, 32.7.7 (bit timing) and 32.9.2 (CAN_BTR); ISO 11898-1 (8 to 25 quanta). Sample points: 75 % above
 * 800 kbit/s, 80 % above 500 kbit/s, else 87.5 % (CiA 301), which Linux takes for its interfaces, too.
 */
#ifndef MCTAU_HAL_CORTEX_M_STM32F4_BIT_TIMING_H
#define MCTAU_HAL_CORTEX_M_STM32F4_BIT_TIMING_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    uint32_t prescaler; /**< cycles of a quantum, 1 to 1024 */
    uint32_t segment_1; /**< [quanta] 1 to 16 */
    uint32_t segment_2; /**< [quanta] 1 to 8 */
    uint32_t jump;      /**< most that one bit is made longer or shorter [quanta], 1 to 4 */
} mct_bit_timing;

/**
 * The exact timing whose sample point is nearest; of two, the one with more quanta.
 * @param clock_hz  of the peripheral [Hz]
 * @param bitrate   [bit/s]
 * @return false where none is exact: a node that is nearly right breaks a bus now and then
 */
bool mct_bit_timing_find(uint32_t clock_hz, uint32_t bitrate, mct_bit_timing *timing);

/** The register CAN_BTR, with neither of its test modes. */
uint32_t mct_bit_timing_register(const mct_bit_timing *timing);

#endif

/**
 * @file board.h
 * An STM32F4DISCOVERY (STM32F407VG, crystal of 8 MHz) with a CAN transceiver. NOT RUN ON HARDWARE.
 *
 *   PD0  CAN1_RX, PD1 CAN1_TX   to the transceiver
 *   PD12 green LED              lit while no fault is latched
 *   PD13 orange LED             changes with each tick: 500 Hz at 1 kHz
 *   PA0  blue button            arms
 *
 * Another board with an STM32F405/407 has its own pins and, perhaps, crystal: board.c.
 */
#ifndef MCTAU_HAL_CORTEX_M_STM32F4_BOARD_H
#define MCTAU_HAL_CORTEX_M_STM32F4_BOARD_H

#include <stdbool.h>
#include <stdint.h>

enum { MCT_BOARD_CORE_MHZ = 168, MCT_BOARD_CAN_HZ = 42000000 };

/** Core to 168 MHz, pins, clock and interrupts of CAN1. @return false when the crystal or the PLL does not start */
bool mct_board_start(void);

void mct_board_show_well(bool is_well);
void mct_board_show_tick(void);
bool mct_board_button(void);

/**
 * Starts the independent watchdog, which nothing stops any more: without being fed it resets the chip.
 * @param least_us  after this time at the earliest, nearly three times of it at the latest: its oscillator has 17 to 47 kHz
 * @return false where it is too long, or does not start
 */
bool mct_board_watchdog_start(uint32_t least_us);
void mct_board_watchdog_feed(void);

#endif

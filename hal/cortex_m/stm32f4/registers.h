/**
 * @file registers.h
 * What board.c uses of an STM32F405/407, by the names of RM0090: addresses in 2.3, the rest in the section beside.
 */
#ifndef MCTAU_HAL_CORTEX_M_STM32F4_REGISTERS_H
#define MCTAU_HAL_CORTEX_M_STM32F4_REGISTERS_H

#include <stdint.h>

#define MCT_REGISTER(address) (*(volatile uint32_t *)(address))

/* 7.3, RCC */
#define RCC_CR      MCT_REGISTER(0x40023800)
#define RCC_PLLCFGR MCT_REGISTER(0x40023804)
#define RCC_CFGR    MCT_REGISTER(0x40023808)
#define RCC_AHB1ENR MCT_REGISTER(0x40023830)
#define RCC_APB1ENR MCT_REGISTER(0x40023840)

/* 3.9, flash interface */
#define FLASH_ACR MCT_REGISTER(0x40023C00)

/* 8.4, GPIO */
#define GPIOA_IDR     MCT_REGISTER(0x40020010)
#define GPIOD_MODER   MCT_REGISTER(0x40020C00)
#define GPIOD_OSPEEDR MCT_REGISTER(0x40020C08)
#define GPIOD_ODR     MCT_REGISTER(0x40020C14)
#define GPIOD_BSRR    MCT_REGISTER(0x40020C18)
#define GPIOD_AFRL    MCT_REGISTER(0x40020C20)

/* 21.4, independent watchdog */
#define IWDG_KR  MCT_REGISTER(0x40003000)
#define IWDG_PR  MCT_REGISTER(0x40003004)
#define IWDG_RLR MCT_REGISTER(0x40003008)
#define IWDG_SR  MCT_REGISTER(0x4000300C)

/* 32.9, bxCAN: bxcan.h */
#define CAN1_BASE 0x40006400

/* ARMv7-M Architecture Reference Manual, B3.4 (NVIC); numbers of interrupts: RM0090, 12.2 */
#define NVIC_ISER0 MCT_REGISTER(0xE000E100)

#endif

/**
 * @file scene.h
 * What main.c takes from the file that `mctau compile` writes: the structs as they are after their init.
 */
#ifndef MCTAU_HAL_CORTEX_M_STM32F4_SCENE_H
#define MCTAU_HAL_CORTEX_M_STM32F4_SCENE_H

#include "hal/socketcan/can.h"
#include "mctau/loop.h"

extern const mct_loop mct_scene_loop; /**< its HAL is set by main */
extern const mct_can mct_scene_can;   /**< its transport likewise */

#endif

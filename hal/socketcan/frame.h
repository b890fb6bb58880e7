/**
 * @file frame.h
 * A classic CAN frame, free of any operating system.
 */
#ifndef MCTAU_HAL_SOCKETCAN_FRAME_H
#define MCTAU_HAL_SOCKETCAN_FRAME_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    uint32_t id;     /**< 11 or 29 bits */
    bool extended;   /**< the identifier has 29 bits */
    bool remote;     /**< asks for a frame, holds no data */
    uint8_t length;  /**< of the data, 0 to 8 [bytes] */
    uint8_t data[8]; /**< zero beyond `length` */
    int64_t time_us; /**< when it came, by the clock of the transport that received it; 0 when sending */
} mct_can_frame;

#endif

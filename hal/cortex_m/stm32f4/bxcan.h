/**
 * @file bxcan.h
 * A CAN bus through ST's bxCAN (STM32F405 and its kin), as a transport of the HAL over CAN. NOT RUN ON HARDWARE: tested
 * against a model of the registers (tests/hal/test_bxcan_f64.c).
 *
 * - An interrupt moves what has come into a ring, with its time; FIFO 0 holds three frames only.
 * - Frames wait in a queue behind the three mailboxes, in their order; of each identifier at most one waits
 *   (HELD_BACK), so that a bus which comes to life again carries no queue of old commands.
 * - A frame that nobody acknowledges for MCT_BXCAN_UNSENT_US makes the link MCT_CAN_UNSENT; what waits is then taken
 *   back at each tick, until a frame gets through.
 * - After bus-off what waits is taken back, what came is thrown away (SKIPPED), and the chip is asked to come back, which
 *   takes it 128 times 11 quiet bits.
 *
 * Source: RM0090, 32 (bxCAN); registers 32.9.
 */
#ifndef MCTAU_HAL_CORTEX_M_STM32F4_BXCAN_H
#define MCTAU_HAL_CORTEX_M_STM32F4_BXCAN_H

#include "hal/socketcan/transport.h"

#define MCT_BXCAN_RECEIVED  64    /**< frames that wait to be received, a power of two */
#define MCT_BXCAN_WAITING   8     /**< frames that wait to be sent */
#define MCT_BXCAN_UNSENT_US 20000 /**< a queue that does not move for so long makes the link MCT_CAN_UNSENT */
#define MCT_BXCAN_BANKS     28    /**< filters of 32 bits; CAN2 gets none */

/** Registers of CAN1, by their names in the manual. */
typedef struct {
    volatile uint32_t MCR, MSR, TSR, RF0R, RF1R, IER, ESR, BTR;
    uint32_t reserved_1[88];
    struct {
        volatile uint32_t TIR, TDTR, TDLR, TDHR;
    } mailboxes[3];
    struct {
        volatile uint32_t RIR, RDTR, RDLR, RDHR;
    } fifos[2];
    uint32_t reserved_2[12];
    volatile uint32_t FMR, FM1R;
    uint32_t reserved_3;
    volatile uint32_t FS1R;
    uint32_t reserved_4;
    volatile uint32_t FFA1R;
    uint32_t reserved_5;
    volatile uint32_t FA1R;
    uint32_t reserved_6[8];
    struct {
        volatile uint32_t FR1, FR2;
    } filters[MCT_BXCAN_BANKS];
} mct_bxcan_registers;

/** Set the first block, zero the rest; all other members private. */
typedef struct {
    mct_bxcan_registers *registers; /**< their clock is on, their pins and interrupts are set */
    uint32_t clock_hz;              /**< of APB1 */
    uint32_t bitrate;
    int64_t (*now_us)(void); /**< a clock that only goes forward; interrupts read it, too */

    bool loopback; /**< for mct_bxcan_self_test: hears itself, and nobody else either */
    mct_can_counts *counts;
    mct_can_link_state state;
    bool passive;        /**< the chip is error-passive */
    int64_t progress_us; /**< when a frame got through, or none waited */
    /* shared with the interrupt */
    uint32_t received, taken; /**< frames, since open: those that wait are from `taken` to `received` */
    uint32_t overflowed;      /**< frames lost, likewise */
    uint32_t confirmed;       /**< frames sent */
    uint32_t told_overflowed; /**< of these, what `counts` has */
    uint32_t told_confirmed;
    mct_can_frame ring[MCT_BXCAN_RECEIVED];
    int waiting; /**< frames in the queue; interrupts are held back while it is changed */
    mct_can_frame queue[MCT_BXCAN_WAITING];
} mct_bxcan;

/** The transport; opens nothing. Its open refuses a bit rate that cannot be met exactly. */
mct_can_transport mct_bxcan_transport(mct_bxcan *bus);

/** The handler of CAN1_TX and CAN1_RX0. Takes at most one frame: the interrupt comes again while there are more. */
void mct_bxcan_interrupt(mct_bxcan *bus);

/**
 * Sends a frame to itself within the chip, silent on the bus: registers, clock, filters, interrupts. Ahead of open.
 * @param why  a sentence on failure
 */
bool mct_bxcan_self_test(mct_bxcan *bus, mct_message *why);

#endif

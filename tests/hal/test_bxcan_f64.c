/*
 * The bxCAN transport against a model of the chip: what the manual (RM0090, 32) says that registers do. Time passes, and
 * the chip works, when somebody reads the clock. No hardware is behind this: it shows that the driver does what the model
 * asks for, not that the chip does.
 */
#include <stddef.h>
#include <string.h>

/* In place of the Cortex-M's own: the model calls the interrupt only where it is not held back. */
#define MCTAU_HAL_CORTEX_M_INTERRUPTS_H
#include <stdint.h>
static uint32_t held;

static uint32_t mct_interrupts_hold(void)
{
    return held++;
}

static void mct_interrupts_restore(uint32_t before)
{
    held = before;
}

#include "hal/cortex_m/stm32f4/bit_timing.c"
#include "hal/cortex_m/stm32f4/bxcan.c"

#include "unity.h"

enum { LEC_STUFF = 1, MOST_WIRE = 64 };

static struct {
    int64_t now_us;
    int frame_us;       /* that a frame takes on the wire */
    bool is_answered;   /* somebody acknowledges */
    bool is_quiet;      /* the bus, for 11 bits */
    bool has_clock;     /* the chip answers */
    bool is_wired;      /* interrupts reach their handler */
    int bus_off_us;     /* left until a recovery is over; 0: not off */
    int64_t begun_us;   /* when the frame on the wire began; -1: none */
    int on_wire;        /* its mailbox */
    uint32_t order[3], orders; /* of requests */
    bool was_requested[3];
    int fifo_count;
    mct_can_frame fifo[3];
    int wire_count; /* frames that got through */
    mct_can_frame wire[MOST_WIRE];
} model;

static mct_bxcan_registers registers;
static mct_bxcan bus;
static mct_can_counts counts;
static mct_message why;
static mct_can_transport transport;

/* --- the model --- */

static mct_can_frame frame_in(int mailbox)
{
    const uint32_t identifier = registers.mailboxes[mailbox].TIR;
    mct_can_frame frame = {.extended = (identifier & IR_IDE) != 0, .remote = (identifier & IR_RTR) != 0};
    frame.id = frame.extended ? identifier >> 3 : identifier >> 21;
    frame.length = (uint8_t)registers.mailboxes[mailbox].TDTR;
    bytes_of(registers.mailboxes[mailbox].TDLR, frame.data);
    bytes_of(registers.mailboxes[mailbox].TDHR, frame.data + 4);
    return frame;
}

/* Shows the oldest frame of the FIFO. */
static void show_fifo(void)
{
    registers.RF0R = (registers.RF0R & RF0R_FOVR0) | (uint32_t)model.fifo_count;
    if (model.fifo_count > 0) {
        const mct_can_frame *frame = &model.fifo[0];
        registers.fifos[0].RIR = identifier_register(frame->id, frame->extended) | (frame->remote ? IR_RTR : 0);
        registers.fifos[0].RDTR = frame->length | 0xABCD0000; /* a time stamp above */
        registers.fifos[0].RDLR = word_of(frame->data);
        registers.fifos[0].RDHR = word_of(frame->data + 4);
    }
}

static bool passes(const mct_can_frame *frame)
{
    const uint32_t identifier = identifier_register(frame->id, frame->extended) | (frame->remote ? IR_RTR : 0);
    for (int i = 0; i < MCT_BXCAN_BANKS; i++) {
        const uint32_t differs = identifier ^ registers.filters[i].FR1;
        if ((registers.FA1R >> i & 1) && !(differs & registers.filters[i].FR2)) {
            return true;
        }
    }
    return false;
}

/* A frame comes from elsewhere, or in loopback from here. */
static void arrive(mct_can_frame frame)
{
    if (!passes(&frame)) {
        return;
    }
    if (model.fifo_count == 3) {
        registers.RF0R |= RF0R_FOVR0;
        model.fifo[2] = frame; /* RFLM = 0 */
    } else {
        model.fifo[model.fifo_count++] = frame;
    }
    show_fifo();
}

static void finish(int mailbox, bool is_sent)
{
    registers.mailboxes[mailbox].TIR &= ~(uint32_t)IR_TXRQ;
    registers.TSR |= (uint32_t)TSR_TME0 << mailbox | (uint32_t)TSR_RQCP0 << (8 * mailbox) |
                     (is_sent ? (uint32_t)TSR_TXOK0 << (8 * mailbox) : 0);
    model.was_requested[mailbox] = false;
}

/* Requests that are new: the mailbox is no longer empty, and what became of the one before is forgotten. */
static void take_requests(void)
{
    for (int i = 0; i < 3; i++) {
        if ((registers.mailboxes[i].TIR & IR_TXRQ) && !model.was_requested[i]) {
            model.was_requested[i] = true;
            model.order[i] = model.orders++;
            registers.TSR &= ~((uint32_t)TSR_TME0 << i | (uint32_t)3 << (8 * i));
        }
    }
}

static void work_on_wire(void)
{
    const bool is_on = !(registers.MSR & MSR_INAK) && model.bus_off_us == 0;
    const bool is_loopback = (registers.BTR & BTR_LBKM) != 0;
    if (model.begun_us < 0 && is_on) {
        int first = -1;
        for (int i = 0; i < 3; i++) {
            if (model.was_requested[i] && (first < 0 || model.order[i] < model.order[first])) {
                first = i;
            }
        }
        model.on_wire = first;
        model.begun_us = first >= 0 ? model.now_us : -1;
    }
    if (model.begun_us >= 0 && model.now_us - model.begun_us >= model.frame_us) {
        model.begun_us = -1;
        if (!model.is_answered && !is_loopback) {
            registers.ESR = (registers.ESR & ~(uint32_t)ESR_LEC) | LEC_ACKNOWLEDGEMENT << ESR_LEC_SHIFT;
            return;
        }
        const mct_can_frame frame = frame_in(model.on_wire);
        finish(model.on_wire, true);
        if (is_loopback) {
            arrive(frame);
        } else if (model.wire_count < MOST_WIRE) {
            model.wire[model.wire_count++] = frame;
        }
    }
}

/* Bits that a program writes and the chip clears. Between two steps of the model there is one write at most of each. */
static void take_commands(void)
{
    if (registers.RF0R & RF0R_RFOM0) { /* the write left the rest of the register 0 */
        memmove(model.fifo, model.fifo + 1, sizeof model.fifo[0] * 2);
        model.fifo_count -= model.fifo_count > 0;
        show_fifo();
    }
    if (registers.MCR & MCR_INRQ) {
        registers.MSR |= model.has_clock ? MSR_INAK : 0;
    } else if (model.is_quiet || (registers.BTR & BTR_LBKM)) {
        registers.MSR &= ~(uint32_t)MSR_INAK;
    }
}

static void pass_time(int us)
{
    for (int i = 0; i < us; i++) {
        model.now_us++;
        take_requests();
        take_commands();
        work_on_wire();
        if (model.bus_off_us > 0 && !(registers.MCR & MCR_INRQ) && --model.bus_off_us == 0) {
            registers.ESR &= ~(uint32_t)ESR_BOFF;
        }
    }
}

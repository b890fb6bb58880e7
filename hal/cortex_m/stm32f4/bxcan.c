#include "bxcan.h"

#include <string.h>

#include "bit_timing.h"
#include "hal/cortex_m/processor.h"
#include "hal/socketcan/filter.h"

/* RM0090, 32.9.2 to 32.9.4 */
enum { MCR_INRQ = 1 << 0, MCR_TXFP = 1 << 2 };
enum { MSR_INAK = 1 << 0 };
enum { TSR_RQCP0 = 1 << 0, TSR_TXOK0 = 1 << 1, TSR_ABRQ0 = 1 << 7, TSR_TME0 = 1 << 26, TSR_NEXT = 8 };
enum { RF0R_FMP0 = 3 << 0, RF0R_FOVR0 = 1 << 4, RF0R_RFOM0 = 1 << 5 };
enum { IER_TMEIE = 1 << 0, IER_FMPIE0 = 1 << 1 };
enum { ESR_EPVF = 1 << 1, ESR_BOFF = 1 << 2, ESR_LEC = 7 << 4, ESR_LEC_SHIFT = 4 };
enum { LEC_NONE = 0, LEC_ACKNOWLEDGEMENT = 3, LEC_SET_BY_SOFTWARE = 7 };
enum { FMR_FINIT = 1 << 0, FMR_CAN2SB_SHIFT = 8 };
enum { IR_TXRQ = 1 << 0, IR_RTR = 1 << 1, IR_IDE = 1 << 2, IR_EXID_SHIFT = 3, IR_STID_SHIFT = 21 };
#define BTR_LBKM (UINT32_C(1) << 30)
#define BTR_SILM (UINT32_C(1) << 31)

enum { MAILBOXES = 3, LARGEST_STANDARD = 0x7FF, LARGEST_EXTENDED = 0x1FFFFFFF };
enum { PATIENCE_US = 10000 }; /* for the chip to change its mode, and for last frames to get through */

/* --- identifiers: mailboxes, FIFOs and filters have them alike --- */

static uint32_t identifier_register(uint32_t id, bool extended)
{
    return extended ? id << IR_EXID_SHIFT | IR_IDE : id << IR_STID_SHIFT;
}

static uint32_t word_of(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void bytes_of(uint32_t word, uint8_t *bytes)
{
    for (int i = 0; i < 4; i++) {
        bytes[i] = (uint8_t)(word >> (8 * i));
    }
}

/* --- sending; interrupts are held back --- */

static void fill_mailbox(mct_bxcan *self, int mailbox, const mct_can_frame *frame)
{
    const uint32_t remote = frame->remote ? IR_RTR : 0;
    self->registers->mailboxes[mailbox].TDTR = frame->length;
    self->registers->mailboxes[mailbox].TDLR = word_of(frame->data);
    self->registers->mailboxes[mailbox].TDHR = word_of(frame->data + 4);
    mct_command(&self->registers->mailboxes[mailbox].TIR,
                identifier_register(frame->id, frame->extended) | remote | IR_TXRQ);
}

static bool is_empty(const mct_bxcan *self, int mailbox)
{
    return (self->registers->TSR & (uint32_t)TSR_TME0 << mailbox) != 0;
}

/* What has become of mailboxes; a new request would wipe it out. */
static void note_sent(mct_bxcan *self)
{
    for (int i = 0; i < MAILBOXES; i++) {
        const uint32_t status = self->registers->TSR >> (TSR_NEXT * i);
        if (status & TSR_RQCP0) {
            self->confirmed += (status & TSR_TXOK0) != 0;
            mct_command(&self->registers->TSR, (uint32_t)TSR_RQCP0 << (TSR_NEXT * i)); /* and TXOK with it */
        }
    }
}

/* Fills empty mailboxes from the queue. */
static void pump(mct_bxcan *self)
{
    note_sent(self);
    for (int mailbox = 0; mailbox < MAILBOXES && self->waiting > 0; mailbox++) {
        if (is_empty(self, mailbox)) {
            fill_mailbox(self, mailbox, &self->queue[0]);
            self->waiting--;
            memmove(self->queue, self->queue + 1, (size_t)self->waiting * sizeof self->queue[0]);
        }
    }
}

static bool is_under_way(const mct_bxcan *self, const mct_can_frame *frame)
{
    const uint32_t identifier = identifier_register(frame->id, frame->extended);
    bool found = false;
    for (int i = 0; i < self->waiting; i++) {
        found |= self->queue[i].id == frame->id && self->queue[i].extended == frame->extended;
    }
    for (int i = 0; i < MAILBOXES; i++) {
        const uint32_t flags = IR_TXRQ | IR_RTR;
        found |= !is_empty(self, i) && (self->registers->mailboxes[i].TIR & ~flags) == identifier;
    }
    return found;
}

static bool is_anything_under_way(const mct_bxcan *self)
{
    const uint32_t all = 7u * TSR_TME0;
    return self->waiting > 0 || (self->registers->TSR & all) != all;
}

/* What is on the wire this moment still gets through. */
static void take_back(mct_bxcan *self)
{
    const uint32_t before = mct_interrupts_hold();
    self->waiting = 0;
    mct_command(&self->registers->TSR, TSR_ABRQ0 | TSR_ABRQ0 << TSR_NEXT | TSR_ABRQ0 << 2 * TSR_NEXT);
    mct_interrupts_restore(before);
}

static bool bxcan_send(void *context, const mct_can_frame *frame)
{
    mct_bxcan *self = context;
    if (self->state == MCT_CAN_BUS_OFF) {
        return false;
    }
    const uint32_t before = mct_interrupts_hold();
    const bool is_held = is_under_way(self, frame);
    const bool is_taken = !is_held && self->waiting < MCT_BXCAN_WAITING;
    if (is_taken) {
        self->queue[self->waiting++] = *frame;
        pump(self);
    }
    mct_interrupts_restore(before);
    mct_can_counted(self->counts, is_taken  ? MCT_CAN_COUNT_SENT
                                  : is_held ? MCT_CAN_COUNT_HELD_BACK
                                            : MCT_CAN_COUNT_QUEUE_FULL);
    return is_taken;
}

/* --- the interrupt --- */

static void receive_one(mct_bxcan *self)
{
    const uint32_t identifier = self->registers->fifos[0].RIR;
    const uint32_t length = self->registers->fifos[0].RDTR & 15;
    if (self->received - self->taken == MCT_BXCAN_RECEIVED) {
        self->overflowed++;
    } else {
        mct_can_frame *frame = &self->ring[self->received % MCT_BXCAN_RECEIVED];
        frame->extended = (identifier & IR_IDE) != 0;
        frame->id = identifier >> (frame->extended ? IR_EXID_SHIFT : IR_STID_SHIFT);
        frame->remote = (identifier & IR_RTR) != 0;
        frame->length = (uint8_t)(length < 8 ? length : 8); /* 9 to 15 mean 8 */
        bytes_of(self->registers->fifos[0].RDLR, frame->data);
        bytes_of(self->registers->fifos[0].RDHR, frame->data + 4);
        for (int i = frame->remote ? 0 : frame->length; i < 8; i++) {
            frame->data[i] = 0;
        }
        frame->time_us = self->now_us();
        __atomic_store_n(&self->received, self->received + 1, __ATOMIC_RELEASE);
    }
    mct_command(&self->registers->RF0R, RF0R_RFOM0);
}

void mct_bxcan_interrupt(mct_bxcan *self)
{
    const uint32_t fifo = self->registers->RF0R;
    if (fifo & RF0R_FOVR0) {
        self->overflowed++;
        mct_command(&self->registers->RF0R, RF0R_FOVR0);
    }
    if (fifo & RF0R_FMP0) {
        receive_one(self);
    }
    pump(self);
}

/* --- receiving --- */

static bool has_frame(const mct_bxcan *self)
{
    return __atomic_load_n(&self->received, __ATOMIC_ACQUIRE) != self->taken;
}

static bool bxcan_receive(void *context, mct_can_frame *frame)
{
    mct_bxcan *self = context;
    if (!has_frame(self)) {
        return false;
    }
    *frame = self->ring[self->taken % MCT_BXCAN_RECEIVED];
    __atomic_store_n(&self->taken, self->taken + 1, __ATOMIC_RELEASE);
    return true;
}

static bool bxcan_wait(void *context, int64_t timeout_us)
{
    mct_bxcan *self = context;
    const int64_t begin = self->now_us();
    while (!has_frame(self) && self->now_us() - begin < timeout_us) {
    }
    return has_frame(self);
}

static int64_t bxcan_now_us(void *context)
{
    const mct_bxcan *self = context;
    return self->now_us();
}

/* --- the link --- */

/* What the interrupt has counted. */
static void tell_counts(mct_bxcan *self)
{
    const uint32_t confirmed = __atomic_load_n(&self->confirmed, __ATOMIC_RELAXED);
    const uint32_t overflowed = __atomic_load_n(&self->overflowed, __ATOMIC_RELAXED);
    mct_hal_count(&self->counts->values[MCT_CAN_COUNT_CONFIRMED], confirmed - self->told_confirmed);
    mct_hal_count(&self->counts->values[MCT_CAN_COUNT_OVERFLOWED], overflowed - self->told_overflowed);
    if (confirmed != self->told_confirmed && self->state == MCT_CAN_UNSENT) {
        self->state = MCT_CAN_UP;
    }
    if (confirmed != self->told_confirmed || (self->state == MCT_CAN_UP && !is_anything_under_way(self))) {
        self->progress_us = self->now_us();
    }
    self->told_confirmed = confirmed;
    self->told_overflowed = overflowed;
}

/* Errors since the last look: the chip keeps the last one alone. */
static void look_for_errors(mct_bxcan *self, uint32_t status)
{
    const uint32_t last = (status & ESR_LEC) >> ESR_LEC_SHIFT;
    const bool passive = (status & ESR_EPVF) != 0;
    if (last != LEC_NONE && last != LEC_SET_BY_SOFTWARE) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_ERROR_FRAMES);
        mct_can_counted(self->counts, last == LEC_ACKNOWLEDGEMENT ? MCT_CAN_COUNT_NO_ACKNOWLEDGE
                                                                  : MCT_CAN_COUNT_BUS_ERRORS);
    }
    if (passive && !self->passive) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_ERROR_PASSIVE);
    }
    self->passive = passive;
    mct_command(&self->registers->ESR, LEC_SET_BY_SOFTWARE << ESR_LEC_SHIFT);
}

static void lose(mct_bxcan *self)
{
    take_back(self);
    mct_can_counted(self->counts, MCT_CAN_COUNT_BUS_OFF);
    mct_can_counted(self->counts, MCT_CAN_COUNT_LINK_LOST);
    const uint32_t received = __atomic_load_n(&self->received, __ATOMIC_ACQUIRE);
    mct_hal_count(&self->counts->values[MCT_CAN_COUNT_SKIPPED], received - self->taken);
    __atomic_store_n(&self->taken, received, __ATOMIC_RELEASE);
    self->state = MCT_CAN_BUS_OFF;
    /* Into initialization mode and out of it: 32.7.6, bus-off recovery. */
    mct_command(&self->registers->MCR, self->registers->MCR | MCR_INRQ);
}

static mct_can_link_state bxcan_tend(void *context)
{
    mct_bxcan *self = context;
    const uint32_t status = self->registers->ESR;
    look_for_errors(self, status);
    tell_counts(self);
    if (self->state != MCT_CAN_BUS_OFF) {
        if (status & ESR_BOFF) {
            lose(self);
        } else if (self->now_us() - self->progress_us > MCT_BXCAN_UNSENT_US) {
            self->state = MCT_CAN_UNSENT;
            take_back(self);
        }
    } else if (self->registers->MSR & MSR_INAK) {
        mct_command(&self->registers->MCR, self->registers->MCR & ~(uint32_t)MCR_INRQ);
    } else if (!(self->registers->MCR & MCR_INRQ) && !(status & ESR_BOFF)) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_LINK_BACK);
        self->state = MCT_CAN_UP;
        self->progress_us = self->now_us();
    }
    return self->state;
}

/* --- opening --- */

/* Into initialization mode, or out of it: onto the bus, once that has been quiet for 11 bits. */
static bool initialize(mct_bxcan *self, bool on)
{
    const int64_t begin = self->now_us();
    const uint32_t wanted = on ? MSR_INAK : 0;
    mct_command(&self->registers->MCR, MCR_TXFP | (on ? MCR_INRQ : 0)); /* in their order; no sleep */
    while ((self->registers->MSR & MSR_INAK) != wanted && self->now_us() - begin < PATIENCE_US) {
    }
    return (self->registers->MSR & MSR_INAK) == wanted;
}

/* A bank lets one identifier pass, as data or as a remote request. */
static void fill_bank(mct_bxcan *self, int bank, uint32_t identifier, uint32_t mask)
{
    self->registers->filters[bank].FR1 = identifier;
    self->registers->filters[bank].FR2 = mask;
}

static int fill_banks(mct_bxcan *self, const mct_can_filter *filters, int count, bool in_other_form, int bank)
{
    for (int i = 0; i < count && bank < MCT_BXCAN_BANKS; i++) {
        const bool extended = filters[i].extended != in_other_form;
        const uint32_t largest = extended ? LARGEST_EXTENDED : LARGEST_STANDARD;
        if (filters[i].id <= largest) {
            const uint32_t mask = identifier_register(largest, extended) | IR_IDE;
            fill_bank(self, bank++, identifier_register(filters[i].id, extended), mask);
        }
    }
    return bank;
}

/* Identifiers in their other form, which the receiver counts and refuses, as far as there are banks. */
static void set_filters(mct_bxcan *self, const mct_can_filter *filters, int count)
{
    mct_bxcan_registers *registers = self->registers;
    registers->FMR = FMR_FINIT | MCT_BXCAN_BANKS << FMR_CAN2SB_SHIFT;
    registers->FM1R = 0;                                    /* all by identifier and mask, */
    registers->FS1R = (UINT32_C(1) << MCT_BXCAN_BANKS) - 1; /* of 32 bits, */
    registers->FFA1R = 0;                                   /* into FIFO 0 */
    int banks = fill_banks(self, filters, count, true, fill_banks(self, filters, count, false, 0));
    if (count == 0) {
        fill_bank(self, banks++, 0, 0); /* everything passes */
    }
    registers->FA1R = (UINT32_C(1) << banks) - 1;
    registers->FMR = MCT_BXCAN_BANKS << FMR_CAN2SB_SHIFT;
}

static void forget(mct_bxcan *self)
{
    self->state = MCT_CAN_UP;
    self->passive = false;
    self->received = self->taken = 0;
    self->overflowed = self->confirmed = self->told_overflowed = self->told_confirmed = 0;
    self->waiting = 0;
    self->progress_us = self->now_us();
}

static mct_status bxcan_open(void *context, const mct_can_filter *filters, int count, mct_can_counts *counts,
                             mct_message *why)
{
    mct_bxcan *self = context;
    mct_bit_timing timing;
    if (!mct_can_check_filters(filters, count, why)) {
        return MCT_ERROR_IO;
    }
    if (count > MCT_BXCAN_BANKS) {
        mct_message_add(why, "found ");
        mct_message_add_integer(why, count);
        mct_message_add(why, " identifiers to listen to; allowed up to ");
        mct_message_add_integer(why, MCT_BXCAN_BANKS);
        return MCT_ERROR_IO;
    }
    if (!mct_bit_timing_find(self->clock_hz, self->bitrate, &timing)) {
        mct_message_add(why, "can.bitrate: found ");
        mct_message_add_integer(why, self->bitrate);
        mct_message_add(why, " bit/s, which the chip cannot make of its clock of ");
        mct_message_add_integer(why, self->clock_hz);
        mct_message_add(why, " Hz; allowed a whole part of that, of 8 to 25 quanta");
        return MCT_ERROR_IO;
    }
    self->counts = counts;
    self->registers->IER = 0;
    if (!initialize(self, true)) {
        mct_message_add(why, "the CAN controller does not answer: look at its clock");
        return MCT_ERROR_IO;
    }
    self->registers->BTR = mct_bit_timing_register(&timing) | (self->loopback ? BTR_LBKM | BTR_SILM : 0);
    set_filters(self, filters, count);
    forget(self);
    if (!initialize(self, false)) {
        mct_message_add(why, "the CAN controller finds no quiet bus: look at transceiver, pins and wiring");
        return MCT_ERROR_IO;
    }
    self->registers->IER = IER_TMEIE | IER_FMPIE0;
    return MCT_OK;
}

/* The last frames are those that stop the motor. */
static void bxcan_close(void *context)
{
    mct_bxcan *self = context;
    const int64_t begin = self->now_us();
    while (is_anything_under_way(self) && self->now_us() - begin < PATIENCE_US) {
    }
    take_back(self);
    initialize(self, true);
    self->registers->IER = 0;
}

mct_can_transport mct_bxcan_transport(mct_bxcan *bus)
{
    static const mct_can_transport_ops ops = {
        .name = "bxcan",
        .simulated = false,
        .open = bxcan_open,
        .send = bxcan_send,
        .receive = bxcan_receive,
        .wait = bxcan_wait,
        .now_us = bxcan_now_us,
        .tend = bxcan_tend,
        .close = bxcan_close,
    };
    return (mct_can_transport){&ops, bus};
}

bool mct_bxcan_self_test(mct_bxcan *self, mct_message *why)
{
    const mct_can_filter filter = {0x2A5, false};
    const mct_can_frame sent = {.id = filter.id, .length = 8, .data = {1, 2, 3, 4, 5, 6, 7, 0xF8}};
    mct_can_frame heard = {.id = 0};
    mct_can_counts counts;
    memset(&counts, 0, sizeof counts);
    self->loopback = true;
    bool is_well = bxcan_open(self, &filter, 1, &counts, why) == MCT_OK;
    if (is_well) {
        is_well = bxcan_send(self, &sent) &&
                  bxcan_wait(self, PATIENCE_US + INT64_C(200000000) / self->bitrate) &&
                  bxcan_receive(self, &heard) && heard.id == sent.id &&
                  memcmp(heard.data, sent.data, sizeof sent.data) == 0;
        bxcan_close(self);
        if (!is_well) {
            mct_message_add(why, "the CAN controller does not hear itself: look at its interrupts");
        }
    }
    self->loopback = false;
    return is_well;
}

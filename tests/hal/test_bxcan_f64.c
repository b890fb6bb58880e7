/*
 * The bxCAN transport against a model of the chip: what its manual (RM0090, 32) says that registers do. Time passes, and
 * the chip works, when somebody reads the clock. No hardware is behind this: it shows that the driver does what the model
 * asks for, not that the chip does.
 */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* In place of the Cortex-M's own. */
#define MCTAU_HAL_CORTEX_M_PROCESSOR_H
static uint32_t held;

static uint32_t mct_interrupts_hold(void)
{
    return held++;
}

static void mct_interrupts_restore(uint32_t before)
{
    held = before;
}

static void mct_command(volatile uint32_t *place, uint32_t bits);

#include "hal/cortex_m/stm32f4/bit_timing.c"
#include "hal/cortex_m/stm32f4/bxcan.c"

#include "unity.h"

enum { FRAME_US = 100, MOST_WIRE = 64, LEC_STUFF = 1 };

static struct {
    int64_t now_us;
    bool has_clock;   /* the chip answers */
    bool is_quiet;    /* the bus, for 11 bits */
    bool is_answered; /* somebody acknowledges */
    bool is_wired;    /* interrupts reach their handler */
    int bus_off_us;   /* until a recovery is over */
    bool is_working;  /* time passes; the interrupt reads the clock, too */
    bool is_requested[3], is_aborted[3];
    uint32_t order[3], orders; /* of requests */
    int on_wire;               /* mailbox, -1: none */
    int64_t begun_us;
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
    const mct_can_frame *frame = &model.fifo[0];
    registers.RF0R = (registers.RF0R & ~(uint32_t)RF0R_FMP0) | (uint32_t)model.fifo_count;
    if (model.fifo_count > 0) {
        registers.fifos[0].RIR =
            identifier_register(frame->id, frame->extended) | (frame->remote ? IR_RTR : 0);
        registers.fifos[0].RDTR = frame->length | 0xABCD1200; /* time stamp and filter above */
        registers.fifos[0].RDLR = word_of(frame->data);
        registers.fifos[0].RDHR = word_of(frame->data + 4);
    }
}

static bool passes(const mct_can_frame *frame)
{
    const uint32_t identifier =
        identifier_register(frame->id, frame->extended) | (frame->remote ? IR_RTR : 0);
    bool found = false;
    for (int i = 0; i < MCT_BXCAN_BANKS; i++) {
        const uint32_t differs = identifier ^ registers.filters[i].FR1;
        const bool is_mask = !(registers.FM1R >> i & 1) && (registers.FS1R >> i & 1);
        const bool is_first = !(registers.FFA1R >> i & 1);
        found |= (registers.FA1R >> i & 1) && is_mask && is_first && !(differs & registers.filters[i].FR2);
    }
    return found;
}

/* A frame comes, from elsewhere or in loopback from here. */
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

static void end_request(int mailbox, bool is_sent)
{
    model.is_requested[mailbox] = model.is_aborted[mailbox] = false;
    registers.mailboxes[mailbox].TIR &= ~(uint32_t)IR_TXRQ;
    registers.TSR |= (uint32_t)TSR_TME0 << mailbox | (uint32_t)TSR_RQCP0 << (8 * mailbox) |
                     (is_sent ? (uint32_t)TSR_TXOK0 << (8 * mailbox) : 0);
}

static void begin_request(int mailbox)
{
    model.is_requested[mailbox] = true;
    model.order[mailbox] = model.orders++;
    registers.TSR &= ~((uint32_t)TSR_TME0 << mailbox | (uint32_t)(TSR_RQCP0 | TSR_TXOK0) << (8 * mailbox));
}

/* 32.9.2 and 32.9.3: bits that act as they are written. */
static void mct_command(volatile uint32_t *place, uint32_t bits)
{
    for (int i = 0; i < 3; i++) {
        const uint32_t status = bits >> (8 * i);
        if (place == &registers.mailboxes[i].TIR) {
            *place = bits;
            begin_request(i);
        }
        if (place == &registers.TSR && (status & TSR_RQCP0)) {
            registers.TSR &= ~((uint32_t)(TSR_RQCP0 | TSR_TXOK0) << (8 * i));
        }
        if (place == &registers.TSR && (status & TSR_ABRQ0) && model.is_requested[i]) {
            model.is_aborted[i] = true;
            if (model.on_wire != i) {
                end_request(i, false);
            }
        }
    }
    if (place == &registers.RF0R && (bits & RF0R_FOVR0)) {
        registers.RF0R &= ~(uint32_t)RF0R_FOVR0;
    }
    if (place == &registers.RF0R && (bits & RF0R_RFOM0) && model.fifo_count > 0) {
        memmove(model.fifo, model.fifo + 1, 2 * sizeof model.fifo[0]);
        model.fifo_count--;
        show_fifo();
    }
    if (place == &registers.MCR) {
        registers.MCR = bits;
    }
    if (place == &registers.ESR) {
        registers.ESR = (registers.ESR & ~(uint32_t)ESR_LEC) | (bits & ESR_LEC);
    }
}

static void change_mode(void)
{
    if (!model.has_clock) {
        return;
    }
    if (registers.MCR & MCR_INRQ) {
        registers.MSR |= MSR_INAK;
    } else if (model.is_quiet || (registers.BTR & BTR_LBKM)) {
        registers.MSR &= ~(uint32_t)MSR_INAK;
    }
    if (model.bus_off_us > 0 && !(registers.MSR & MSR_INAK) && !(registers.MCR & MCR_INRQ)) {
        model.bus_off_us--;
        registers.ESR &= model.bus_off_us == 0 ? ~(uint32_t)ESR_BOFF : UINT32_MAX;
    }
}

static void begin_frame(void)
{
    for (int i = 0; i < 3; i++) {
        const int first = model.on_wire;
        const uint32_t mine = registers.mailboxes[i].TIR;
        const bool by_order = (registers.MCR & MCR_TXFP) != 0;
        if (model.is_requested[i] && (first < 0 || (by_order ? model.order[i] < model.order[first]
                                                             : mine < registers.mailboxes[first].TIR))) {
            model.on_wire = i;
        }
    }
    model.begun_us = model.now_us;
}

/* The frame on the wire has come to nothing. */
static void leave_wire(void)
{
    if (model.is_aborted[model.on_wire]) {
        end_request(model.on_wire, false);
    }
    model.on_wire = -1;
}

static void end_frame(void)
{
    const int mailbox = model.on_wire;
    const bool is_loopback = (registers.BTR & BTR_LBKM) != 0;
    if (!is_loopback && !model.is_answered) {
        registers.ESR = (registers.ESR & ~(uint32_t)ESR_LEC) | LEC_ACKNOWLEDGEMENT << ESR_LEC_SHIFT;
        leave_wire();
        return;
    }
    model.on_wire = -1;
    const mct_can_frame frame = frame_in(mailbox);
    end_request(mailbox, true);
    if (is_loopback) {
        arrive(frame);
    }
    if (!(registers.BTR & BTR_SILM) && model.wire_count < MOST_WIRE) {
        model.wire[model.wire_count++] = frame;
    }
}

static void interrupt(void)
{
    const uint32_t completed = TSR_RQCP0 | TSR_RQCP0 << 8 | TSR_RQCP0 << 16;
    for (int i = 0; i < 10 && model.is_wired && held == 0; i++) {
        if (((registers.IER & IER_TMEIE) && (registers.TSR & completed)) ||
            ((registers.IER & IER_FMPIE0) && model.fifo_count > 0)) {
            mct_bxcan_interrupt(&bus);
        }
    }
}

static void pass_time(int us)
{
    model.is_working = true;
    for (int i = 0; i < us; i++) {
        model.now_us++;
        change_mode();
        if (!(registers.MSR & MSR_INAK) && !(registers.ESR & ESR_BOFF)) {
            if (model.on_wire < 0) {
                begin_frame();
            }
            if (model.on_wire >= 0 && model.now_us - model.begun_us >= FRAME_US) {
                end_frame();
            }
        } else if (model.on_wire >= 0) {
            leave_wire();
        }
        interrupt();
    }
    model.is_working = false;
}

/* What the driver reads. */
static int64_t now_us(void)
{
    if (!model.is_working) {
        pass_time(1);
    }
    return model.now_us;
}

/* --- what the tests do --- */

static mct_can_frame frame_of(uint32_t id, uint8_t byte)
{
    return (mct_can_frame){.id = id, .length = 8, .data = {byte, 1, 2, 3, 4, 5, 6, 0xFF}};
}

static bool send(uint32_t id, uint8_t byte)
{
    const mct_can_frame frame = frame_of(id, byte);
    return transport.ops->send(transport.context, &frame);
}

static mct_status open(const mct_can_filter *filters, int count)
{
    mct_message_clear(&why);
    return transport.ops->open(transport.context, filters, count, &counts, &why);
}

static void open_well(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, open(NULL, 0), why.text);
}

static mct_can_link_state tick(void)
{
    pass_time(1000);
    return transport.ops->tend(transport.context);
}

static uint32_t count_of(mct_can_count count)
{
    return (uint32_t)counts.values[count];
}

void setUp(void)
{
    memset(&registers, 0, sizeof registers);
    memset(&model, 0, sizeof model);
    memset(&counts, 0, sizeof counts);
    registers.MCR = 0x00010002; /* after a reset: asleep */
    registers.MSR = 0x00000C02;
    registers.TSR = 0x1C000000;
    model.has_clock = model.is_quiet = model.is_answered = model.is_wired = true;
    model.on_wire = -1;
    held = 0;
    bus = (mct_bxcan){.registers = &registers, .clock_hz = 42000000, .bitrate = 1000000, .now_us = now_us};
    transport = mct_bxcan_transport(&bus);
}

void tearDown(void)
{
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, held, "interrupts are held back for ever");
}

/* RM0090, 32.9.5, register map. */
static void test_registers_lie_where_the_manual_says(void)
{
    TEST_ASSERT_EQUAL_HEX32(0x008, offsetof(mct_bxcan_registers, TSR));
    TEST_ASSERT_EQUAL_HEX32(0x01C, offsetof(mct_bxcan_registers, BTR));
    TEST_ASSERT_EQUAL_HEX32(0x180, offsetof(mct_bxcan_registers, mailboxes));
    TEST_ASSERT_EQUAL_HEX32(0x1AC, offsetof(mct_bxcan_registers, mailboxes[2].TDHR));
    TEST_ASSERT_EQUAL_HEX32(0x1B0, offsetof(mct_bxcan_registers, fifos));
    TEST_ASSERT_EQUAL_HEX32(0x1CC, offsetof(mct_bxcan_registers, fifos[1].RDHR));
    TEST_ASSERT_EQUAL_HEX32(0x200, offsetof(mct_bxcan_registers, FMR));
    TEST_ASSERT_EQUAL_HEX32(0x20C, offsetof(mct_bxcan_registers, FS1R));
    TEST_ASSERT_EQUAL_HEX32(0x214, offsetof(mct_bxcan_registers, FFA1R));
    TEST_ASSERT_EQUAL_HEX32(0x21C, offsetof(mct_bxcan_registers, FA1R));
    TEST_ASSERT_EQUAL_HEX32(0x240, offsetof(mct_bxcan_registers, filters));
    TEST_ASSERT_EQUAL_HEX32(0x31C, offsetof(mct_bxcan_registers, filters[27].FR2));
}

static void test_open_goes_onto_the_bus_with_the_timing_of_its_bitrate(void)
{
    mct_bit_timing timing = {0};
    open_well();
    TEST_ASSERT_TRUE(mct_bit_timing_find(42000000, 1000000, &timing));
    TEST_ASSERT_EQUAL_HEX32(mct_bit_timing_register(&timing), registers.BTR);
    TEST_ASSERT_EQUAL_HEX32(0, registers.MSR & MSR_INAK);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, tick());
}

static void expect_refusal(const char *words)
{
    const int64_t begin = model.now_us;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, open(NULL, 0));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, words), why.text);
    TEST_ASSERT_TRUE(model.now_us - begin < 30000);
}

static void test_what_hinders_an_open_is_said_in_bounded_time(void)
{
    bus.bitrate = 800000;
    expect_refusal("can.bitrate: found 800000 bit/s");
    bus.bitrate = 1000000;
    model.has_clock = false;
    expect_refusal("does not answer");
    model.has_clock = true;
    model.is_quiet = false;
    expect_refusal("no quiet bus");
    model.is_quiet = true;
    open_well();
}

static void test_more_identifiers_than_filters_are_refused(void)
{
    mct_can_filter filters[MCT_CAN_MAX_FILTERS] = {{0, false}};
    TEST_ASSERT_EQUAL_INT(MCT_OK, open(filters, MCT_BXCAN_BANKS));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, open(filters, MCT_BXCAN_BANKS + 1));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "found 29 identifiers"), why.text);
}

static void test_a_frame_gets_through_bit_for_bit(void)
{
    static const mct_can_frame frames[] = {
        {.id = 0x7FF, .length = 8, .data = {0x80, 0xFF, 0, 1, 2, 3, 4, 0xFE}},
        {.id = 0, .length = 0},
        {.id = 0x123, .length = 3, .data = {1, 2, 3}},
        {.id = 0x1FFFFFFF, .extended = true, .length = 8, .data = {8, 7, 6, 5, 4, 3, 2, 1}},
        {.id = 0x123, .extended = true, .length = 1, .data = {0xAA}},
        {.id = 0x321, .remote = true, .length = 8},
    };
    open_well();
    for (size_t i = 0; i < sizeof frames / sizeof frames[0]; i++) {
        mct_can_frame heard;
        TEST_ASSERT_TRUE(transport.ops->send(transport.context, &frames[i]));
        pass_time(2 * FRAME_US);
        TEST_ASSERT_EQUAL_INT((int)i + 1, model.wire_count);
        TEST_ASSERT_EQUAL_MEMORY(&frames[i], &model.wire[i], sizeof frames[i]);
        arrive(frames[i]);
        pass_time(1);
        TEST_ASSERT_TRUE(transport.ops->receive(transport.context, &heard));
        TEST_ASSERT_EQUAL_INT(model.now_us, heard.time_us);
        heard.time_us = 0;
        TEST_ASSERT_EQUAL_MEMORY(&frames[i], &heard, sizeof heard);
    }
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, tick());
    TEST_ASSERT_EQUAL_UINT32(6, count_of(MCT_CAN_COUNT_SENT));
    TEST_ASSERT_EQUAL_UINT32(6, count_of(MCT_CAN_COUNT_CONFIRMED));
}

static void test_what_a_length_leaves_over_is_zero(void)
{
    mct_can_frame heard;
    open_well();
    arrive((mct_can_frame){.id = 1, .length = 2, .data = {1, 2, 3, 4, 5, 6, 7, 8}});
    arrive((mct_can_frame){.id = 1, .length = 15, .data = {1, 2, 3, 4, 5, 6, 7, 8}});
    pass_time(1);
    TEST_ASSERT_TRUE(transport.ops->receive(transport.context, &heard));
    TEST_ASSERT_TRUE(heard.length == 2 && heard.data[1] == 2 && heard.data[2] == 0 && heard.data[7] == 0);
    TEST_ASSERT_TRUE(transport.ops->receive(transport.context, &heard));
    TEST_ASSERT_TRUE(heard.length == 8 && heard.data[7] == 8);
}

/* A request for readiness takes four frames, and a command goes with it; there are three mailboxes. */
static void test_frames_leave_in_their_order_though_mailboxes_are_fewer(void)
{
    open_well();
    for (int i = 0; i < 8; i++) {
        TEST_ASSERT_TRUE(send(0x300 - 0x10 * (uint32_t)i, (uint8_t)i));
    }
    pass_time(10 * FRAME_US);
    TEST_ASSERT_EQUAL_INT(8, model.wire_count);
    for (int i = 0; i < 8; i++) {
        TEST_ASSERT_EQUAL_UINT8(i, model.wire[i].data[0]);
    }
}

static void test_of_an_identifier_one_frame_is_under_way(void)
{
    open_well();
    for (uint32_t i = 0; i < 6; i++) { /* three of them in mailboxes, three behind */
        TEST_ASSERT_TRUE(send(0x100 + i, 0));
    }
    for (uint32_t i = 0; i < 6; i++) {
        TEST_ASSERT_FALSE(send(0x100 + i, 1));
    }
    TEST_ASSERT_EQUAL_UINT32(6, count_of(MCT_CAN_COUNT_HELD_BACK));
    pass_time(8 * FRAME_US);
    TEST_ASSERT_EQUAL_INT(6, model.wire_count);
    TEST_ASSERT_TRUE(send(0x100, 2));
}

static void test_what_the_queue_has_no_room_for_is_given_up_and_counted(void)
{
    open_well();
    for (uint32_t i = 0; i < 3 + MCT_BXCAN_WAITING; i++) {
        TEST_ASSERT_TRUE(send(0x100 + i, 0));
    }
    TEST_ASSERT_FALSE(send(0x200, 0));
    TEST_ASSERT_EQUAL_UINT32(1, count_of(MCT_CAN_COUNT_QUEUE_FULL));
    pass_time(20 * FRAME_US);
    TEST_ASSERT_EQUAL_INT(3 + MCT_BXCAN_WAITING, model.wire_count);
}

static void test_frames_are_received_in_order_and_those_without_room_are_counted(void)
{
    mct_can_frame heard;
    open_well();
    for (uint32_t i = 0; i < MCT_BXCAN_RECEIVED + 5; i++) {
        arrive(frame_of(i, (uint8_t)i));
        pass_time(1);
    }
    for (uint32_t i = 0; i < MCT_BXCAN_RECEIVED; i++) {
        TEST_ASSERT_TRUE(transport.ops->receive(transport.context, &heard));
        TEST_ASSERT_EQUAL_UINT32(i, heard.id);
    }
    TEST_ASSERT_FALSE(transport.ops->receive(transport.context, &heard));
    tick();
    TEST_ASSERT_EQUAL_UINT32(5, count_of(MCT_CAN_COUNT_OVERFLOWED));
    arrive(frame_of(0x77, 0));
    TEST_ASSERT_TRUE(transport.ops->wait(transport.context, 10));
    TEST_ASSERT_TRUE(transport.ops->receive(transport.context, &heard) && heard.id == 0x77);
}

static void test_an_interrupt_that_comes_too_late_loses_frames_and_says_so(void)
{
    open_well();
    held = 1;
    for (uint32_t i = 0; i < 5; i++) {
        arrive(frame_of(i, 0));
        pass_time(1);
    }
    held = 0;
    tick();
    TEST_ASSERT_EQUAL_UINT32(3, bus.received);
    TEST_ASSERT_EQUAL_UINT32(1, count_of(MCT_CAN_COUNT_OVERFLOWED)); /* once or more: the chip does not say */
}

static bool is_received(uint32_t id, bool extended, bool remote)
{
    mct_can_frame frame = frame_of(id, 0);
    frame.extended = extended;
    frame.remote = remote;
    arrive(frame);
    pass_time(1);
    return transport.ops->receive(transport.context, &frame);
}

/* As hal/socketcan/filter.h: in the other form and as a remote request, too, for the receiver to refuse and count. */
static void test_filters_let_pass_what_is_wanted_in_either_form_and_nothing_else(void)
{
    static const mct_can_filter filters[] = {{0x181, false}, {0x7FF, false}, {0x00001001, true}};
    TEST_ASSERT_EQUAL_INT(MCT_OK, open(filters, 3));
    TEST_ASSERT_TRUE(is_received(0x181, false, false) && is_received(0x181, true, false));
    TEST_ASSERT_TRUE(is_received(0x181, false, true) && is_received(0x181, true, true));
    TEST_ASSERT_TRUE(is_received(0x7FF, false, false) && is_received(0x1001, true, false));
    for (uint32_t id = 0; id < 0x800; id++) {
        TEST_ASSERT_EQUAL(id == 0x181 || id == 0x7FF, is_received(id, false, false));
        TEST_ASSERT_EQUAL(id == 0x181 || id == 0x7FF, is_received(id, true, false));
    }
    TEST_ASSERT_FALSE(is_received(0x181 << 18, true, false) || is_received(0x1001 << 1, true, false) ||
                      is_received(0x10001001, true, false));
    open_well(); /* no filter: everything */
    TEST_ASSERT_TRUE(is_received(0x55, false, false) && is_received(0x1ABCDEF, true, true));
}

static void test_a_bus_that_answers_again_carries_the_newest_command_and_no_old_one(void)
{
    open_well();
    model.is_answered = false;
    mct_can_link_state state = MCT_CAN_UP;
    int unsent_after = 0;
    for (int i = 0; i < 40; i++) {
        send(0x101, (uint8_t)i);
        send(0x011, (uint8_t)i);
        state = tick();
        unsent_after += state == MCT_CAN_UP;
    }
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UNSENT, state);
    TEST_ASSERT_INT_WITHIN(1, MCT_BXCAN_UNSENT_US / 1000, unsent_after);
    TEST_ASSERT_TRUE(count_of(MCT_CAN_COUNT_NO_ACKNOWLEDGE) >= 20);
    TEST_ASSERT_EQUAL_UINT32(0, count_of(MCT_CAN_COUNT_BUS_ERRORS));
    tick(); /* with nothing to send */
    send(0x101, 50);
    tick();
    pass_time(2 * FRAME_US);
    model.is_answered = true;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UNSENT, tick());
    TEST_ASSERT_EQUAL_INT(0, model.wire_count);
    TEST_ASSERT_TRUE(send(0x101, 99));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, tick());
    TEST_ASSERT_TRUE(model.wire_count == 1 && model.wire[0].data[0] == 99);
}

static void test_a_silent_host_is_not_one_that_nobody_acknowledges(void)
{
    open_well();
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, tick());
    }
    send(0x101, 1);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, tick());
}

static void test_after_bus_off_nothing_old_is_sent_or_received_and_the_chip_comes_back(void)
{
    mct_can_frame heard;
    open_well();
    model.is_answered = false;
    send(0x101, 1);
    for (uint32_t i = 0; i < 5; i++) {
        send(0x102 + i, 1);
    }
    arrive(frame_of(0x181, 1));
    pass_time(1);
    registers.ESR |= ESR_BOFF;
    model.bus_off_us = 5000;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_BUS_OFF, transport.ops->tend(transport.context));
    TEST_ASSERT_FALSE(transport.ops->receive(transport.context, &heard));
    TEST_ASSERT_FALSE(send(0x110, 2));
    model.is_answered = true;
    int off = 0;
    while (off < 20 && tick() == MCT_CAN_BUS_OFF) {
        off++;
    }
    TEST_ASSERT_INT_WITHIN(2, 6, off);
    TEST_ASSERT_EQUAL_INT(0, model.wire_count);
    send(0x101, 3);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, tick());
    TEST_ASSERT_TRUE(model.wire_count == 1 && model.wire[0].data[0] == 3);
    TEST_ASSERT_EQUAL_UINT32(1, count_of(MCT_CAN_COUNT_BUS_OFF));
    TEST_ASSERT_EQUAL_UINT32(1, count_of(MCT_CAN_COUNT_LINK_LOST));
    TEST_ASSERT_EQUAL_UINT32(1, count_of(MCT_CAN_COUNT_LINK_BACK));
    TEST_ASSERT_EQUAL_UINT32(1, count_of(MCT_CAN_COUNT_SKIPPED));
}

static void test_errors_of_the_chip_are_counted_once(void)
{
    open_well();
    registers.ESR |= LEC_STUFF << ESR_LEC_SHIFT | ESR_EPVF;
    for (int i = 0; i < 5; i++) {
        tick();
    }
    TEST_ASSERT_EQUAL_UINT32(1, count_of(MCT_CAN_COUNT_ERROR_FRAMES));
    TEST_ASSERT_EQUAL_UINT32(1, count_of(MCT_CAN_COUNT_BUS_ERRORS));
    TEST_ASSERT_EQUAL_UINT32(1, count_of(MCT_CAN_COUNT_ERROR_PASSIVE));
}

static void test_close_lets_the_last_frames_out_and_leaves_the_bus_in_bounded_time(void)
{
    for (int answered = 0; answered < 2; answered++) {
        setUp();
        open_well();
        model.is_answered = answered == 1;
        for (uint32_t i = 0; i < 5; i++) {
            send(0x11 + i, 0);
        }
        const int64_t begin = model.now_us;
        transport.ops->close(transport.context);
        TEST_ASSERT_TRUE(model.now_us - begin < 30000);
        TEST_ASSERT_EQUAL_INT(answered ? 5 : 0, model.wire_count);
        TEST_ASSERT_EQUAL_HEX32(MSR_INAK, registers.MSR & MSR_INAK);
    }
}

static void test_the_self_test_is_silent_and_passes(void)
{
    mct_message_clear(&why);
    TEST_ASSERT_TRUE_MESSAGE(mct_bxcan_self_test(&bus, &why), why.text);
    TEST_ASSERT_EQUAL_INT(0, model.wire_count);
    open_well();
    TEST_ASSERT_EQUAL_HEX32(0, registers.BTR & (BTR_LBKM | BTR_SILM));
    send(0x101, 7);
    tick();
    TEST_ASSERT_EQUAL_INT(1, model.wire_count);
}

static void test_the_self_test_finds_interrupts_that_do_not_come_and_a_chip_without_a_clock(void)
{
    mct_message_clear(&why);
    model.is_wired = false;
    TEST_ASSERT_FALSE(mct_bxcan_self_test(&bus, &why));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "interrupts"), why.text);
    model.is_wired = true;
    model.has_clock = false;
    registers.MSR = 0;
    mct_message_clear(&why);
    TEST_ASSERT_FALSE(mct_bxcan_self_test(&bus, &why));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "clock"), why.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_registers_lie_where_the_manual_says);
    RUN_TEST(test_open_goes_onto_the_bus_with_the_timing_of_its_bitrate);
    RUN_TEST(test_what_hinders_an_open_is_said_in_bounded_time);
    RUN_TEST(test_more_identifiers_than_filters_are_refused);
    RUN_TEST(test_a_frame_gets_through_bit_for_bit);
    RUN_TEST(test_what_a_length_leaves_over_is_zero);
    RUN_TEST(test_frames_leave_in_their_order_though_mailboxes_are_fewer);
    RUN_TEST(test_of_an_identifier_one_frame_is_under_way);
    RUN_TEST(test_what_the_queue_has_no_room_for_is_given_up_and_counted);
    RUN_TEST(test_frames_are_received_in_order_and_those_without_room_are_counted);
    RUN_TEST(test_an_interrupt_that_comes_too_late_loses_frames_and_says_so);
    RUN_TEST(test_filters_let_pass_what_is_wanted_in_either_form_and_nothing_else);
    RUN_TEST(test_a_bus_that_answers_again_carries_the_newest_command_and_no_old_one);
    RUN_TEST(test_a_silent_host_is_not_one_that_nobody_acknowledges);
    RUN_TEST(test_after_bus_off_nothing_old_is_sent_or_received_and_the_chip_comes_back);
    RUN_TEST(test_errors_of_the_chip_are_counted_once);
    RUN_TEST(test_close_lets_the_last_frames_out_and_leaves_the_bus_in_bounded_time);
    RUN_TEST(test_the_self_test_is_silent_and_passes);
    RUN_TEST(test_the_self_test_finds_interrupts_that_do_not_come_and_a_chip_without_a_clock);
    return UNITY_END();
}

/* The ring: a bus within the process that loses nothing, has its own clock and lets the other end work. */
#include <string.h>

#include "hal/socketcan/ring.h"
#include "unity.h"

static mct_can_ring ring;
static mct_can_transport ends[2];
static mct_can_counts counts[2];

void setUp(void)
{
    memset(counts, 0, sizeof counts);
    mct_can_ring_init(&ring);
    for (int i = 0; i < 2; i++) {
        ends[i] = mct_can_ring_end(&ring, i);
    }
}

void tearDown(void)
{
}

static void open_end(int end, const mct_can_filter *filters, int count)
{
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT_MESSAGE(
        MCT_OK, ends[end].ops->open(ends[end].context, filters, count, &counts[end], &why), why.text);
}

static void open_both(void)
{
    open_end(0, NULL, 0);
    open_end(1, NULL, 0);
}

static mct_can_frame frame_of(uint32_t id, uint8_t first)
{
    const mct_can_frame frame = {.id = id, .length = 1, .data = {first}};
    return frame;
}

static bool send_from(int end, uint32_t id, uint8_t first)
{
    const mct_can_frame frame = frame_of(id, first);
    return ends[end].ops->send(ends[end].context, &frame);
}

static bool receive_at(int end, mct_can_frame *frame)
{
    return ends[end].ops->receive(ends[end].context, frame);
}

static uint64_t count_of(int end, mct_can_count count)
{
    return counts[end].values[count];
}

static void test_frames_come_in_order_to_the_other_end_and_never_back(void)
{
    mct_can_frame frame;
    open_both();
    for (int round = 0; round < 100; round++) {
        for (uint8_t k = 0; k < 5; k++) {
            TEST_ASSERT_TRUE(send_from(0, 0x100, k));
            TEST_ASSERT_TRUE(send_from(1, 0x200, k));
        }
        for (uint8_t k = 0; k < 5; k++) {
            TEST_ASSERT_TRUE(receive_at(1, &frame));
            TEST_ASSERT_EQUAL_HEX32(0x100, frame.id);
            TEST_ASSERT_EQUAL_UINT8(k, frame.data[0]);
            TEST_ASSERT_TRUE(receive_at(0, &frame));
            TEST_ASSERT_EQUAL_HEX32(0x200, frame.id);
        }
        TEST_ASSERT_FALSE(receive_at(0, &frame));
        TEST_ASSERT_FALSE(receive_at(1, &frame));
    }
    TEST_ASSERT_EQUAL_UINT64(500, count_of(0, MCT_CAN_COUNT_SENT));
    TEST_ASSERT_EQUAL_UINT64(500, count_of(0, MCT_CAN_COUNT_CONFIRMED));
}

static void test_a_full_queue_refuses_and_counts_and_keeps_the_older_frames(void)
{
    mct_can_frame frame;
    open_both();
    for (int k = 0; k < MCT_CAN_RING_FRAMES; k++) {
        TEST_ASSERT_TRUE(send_from(0, 0x100, (uint8_t)k));
    }
    TEST_ASSERT_FALSE(send_from(0, 0x100, 0xFF));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(0, MCT_CAN_COUNT_QUEUE_FULL));
    TEST_ASSERT_EQUAL_UINT64(MCT_CAN_RING_FRAMES, count_of(0, MCT_CAN_COUNT_SENT));
    for (int k = 0; k < MCT_CAN_RING_FRAMES; k++) {
        TEST_ASSERT_TRUE(receive_at(1, &frame));
        TEST_ASSERT_EQUAL_UINT8(k, frame.data[0]);
    }
    TEST_ASSERT_FALSE(receive_at(1, &frame));
    TEST_ASSERT_TRUE(send_from(0, 0x100, 1));
}

static void test_filters_pass_their_identifiers_in_either_format_and_remote_and_no_others(void)
{
    static const mct_can_filter filters[] = {{0x123, false}, {0x18DAF110, true}};
    mct_can_frame frame, sent = frame_of(0x123, 1);
    open_end(0, NULL, 0);
    open_end(1, filters, 2);
    TEST_ASSERT_TRUE(send_from(0, 0x122, 0)); /* the bus takes it, nobody wants it */
    TEST_ASSERT_FALSE(receive_at(1, &frame));
    sent.extended = true;
    sent.remote = true;
    TEST_ASSERT_TRUE(ends[0].ops->send(ends[0].context, &sent));
    TEST_ASSERT_TRUE(receive_at(1, &frame));
    TEST_ASSERT_TRUE(frame.extended);
    TEST_ASSERT_TRUE(frame.remote);
    sent = frame_of(0x18DAF110, 2);
    sent.extended = true;
    TEST_ASSERT_TRUE(ends[0].ops->send(ends[0].context, &sent));
    TEST_ASSERT_TRUE(receive_at(1, &frame));
    TEST_ASSERT_EQUAL_HEX32(0x18DAF110, frame.id);
}

static void test_filters_that_cannot_be_are_refused_with_a_sentence(void)
{
    static const mct_can_filter wide = {0x800, false};
    static const mct_can_filter filters[MCT_CAN_MAX_FILTERS + 1];
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, ends[0].ops->open(ends[0].context, &wide, 1, &counts[0], &why));
    TEST_ASSERT_EQUAL_STRING("found identifier 2048 to listen to; allowed up to 2047", why.text);
    mct_message_clear(&why);
    TEST_ASSERT_EQUAL_INT(
        MCT_ERROR_IO, ends[0].ops->open(ends[0].context, filters, MCT_CAN_MAX_FILTERS + 1, &counts[0], &why));
    TEST_ASSERT_EQUAL_STRING("found 33 identifiers to listen to; allowed up to 32", why.text);
}

/* A drive that takes 250 us and answers every second call. */
typedef struct {
    int calls;
    int64_t timeout_us;
} drive;

static void tick(void *context, int64_t timeout_us)
{
    drive *self = context;
    mct_can_frame frame;
    self->calls++;
    self->timeout_us = timeout_us;
    mct_can_ring_advance(&ring, 250);
    while (receive_at(1, &frame)) {
    }
    if (self->calls % 2 == 0) {
        send_from(1, 0x200, (uint8_t)self->calls);
    }
    ends[1].ops->wait(ends[1].context, 1000); /* from within: neither itself nor the other end is called */
}

static void test_a_wait_lets_the_other_end_work_once_and_only_when_nothing_is_there(void)
{
    drive other = {0, 0};
    mct_can_frame frame;
    open_both();
    mct_can_ring_serve(&ring, 1, tick, &other);
    TEST_ASSERT_FALSE(ends[0].ops->wait(ends[0].context, 5000));
    TEST_ASSERT_EQUAL_INT(1, other.calls);
    TEST_ASSERT_TRUE(other.timeout_us == 5000);
    TEST_ASSERT_TRUE(ends[0].ops->wait(ends[0].context, 5000));
    TEST_ASSERT_EQUAL_INT(2, other.calls);
    TEST_ASSERT_TRUE(ends[0].ops->wait(ends[0].context, 5000)); /* still there */
    TEST_ASSERT_EQUAL_INT(2, other.calls);
    TEST_ASSERT_TRUE(receive_at(0, &frame));
    TEST_ASSERT_EQUAL_UINT8(2, frame.data[0]);
}

static void test_a_service_is_not_called_from_within_itself(void)
{
    drive other = {0, 0};
    open_both();
    mct_can_ring_serve(&ring, 1, tick, &other);
    mct_can_ring_serve(&ring, 0, tick, &other); /* end 1's wait within tick would call it */
    TEST_ASSERT_FALSE(ends[0].ops->wait(ends[0].context, 5000));
    TEST_ASSERT_EQUAL_INT(1, other.calls);
}

static void test_time_stands_but_for_advance_and_waits_in_vain_without_a_service(void)
{
    mct_can_frame frame;
    open_both();
    TEST_ASSERT_TRUE(ends[0].ops->now_us(ends[0].context) == 0);
    mct_can_ring_advance(&ring, 700);
    TEST_ASSERT_TRUE(send_from(1, 0x200, 1));
    mct_can_ring_advance(&ring, 300);
    mct_can_ring_advance(&ring, -50);
    TEST_ASSERT_TRUE(ends[0].ops->now_us(ends[0].context) == 1000);
    TEST_ASSERT_TRUE(ends[0].ops->wait(ends[0].context, 400));
    TEST_ASSERT_TRUE(receive_at(0, &frame));
    TEST_ASSERT_TRUE(frame.time_us == 700);
    TEST_ASSERT_FALSE(ends[0].ops->wait(ends[0].context, 400));
    TEST_ASSERT_TRUE(ends[1].ops->now_us(ends[1].context) == 1400);
}

static void test_a_lost_link_carries_nothing_and_what_waited_is_thrown_away(void)
{
    static const mct_can_link_state states[] = {MCT_CAN_DOWN, MCT_CAN_GONE, MCT_CAN_BUS_OFF};
    mct_can_frame frame;
    open_both();
    for (uint64_t k = 0; k < 3; k++) {
        TEST_ASSERT_TRUE(send_from(1, 0x200, 1));
        ring.state = states[k];
        TEST_ASSERT_EQUAL_INT(states[k], ends[0].ops->tend(ends[0].context));
        TEST_ASSERT_FALSE(receive_at(0, &frame));
        TEST_ASSERT_FALSE(send_from(0, 0x100, 1));
        TEST_ASSERT_FALSE(ends[0].ops->wait(ends[0].context, 10));
        TEST_ASSERT_EQUAL_UINT64(k + 1, count_of(0, MCT_CAN_COUNT_LINK_LOST));
        TEST_ASSERT_EQUAL_UINT64(k, count_of(0, MCT_CAN_COUNT_LINK_BACK));
        ring.state = MCT_CAN_UP;
        TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, ends[0].ops->tend(ends[0].context));
        TEST_ASSERT_EQUAL_UINT64(k + 1, count_of(0, MCT_CAN_COUNT_LINK_BACK));
        TEST_ASSERT_EQUAL_UINT64(k + 1, count_of(0, MCT_CAN_COUNT_SKIPPED));
        TEST_ASSERT_FALSE(receive_at(0, &frame));
    }
    TEST_ASSERT_EQUAL_UINT64(0, count_of(0, MCT_CAN_COUNT_SENT));
}

static void test_while_nobody_acknowledges_sends_are_held_back_and_the_link_is_not_lost(void)
{
    open_both();
    ring.state = MCT_CAN_UNSENT;
    TEST_ASSERT_FALSE(send_from(0, 0x100, 1));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UNSENT, ends[0].ops->tend(ends[0].context));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(0, MCT_CAN_COUNT_HELD_BACK));
    TEST_ASSERT_EQUAL_UINT64(0, count_of(0, MCT_CAN_COUNT_LINK_LOST));
}

static void test_a_closed_end_neither_sends_nor_hears(void)
{
    mct_can_frame frame;
    open_end(0, NULL, 0);
    TEST_ASSERT_FALSE(send_from(1, 0x200, 1));
    TEST_ASSERT_TRUE(send_from(0, 0x100, 1));
    open_end(1, NULL, 0);
    TEST_ASSERT_FALSE(receive_at(1, &frame));
    TEST_ASSERT_TRUE(send_from(0, 0x100, 1));
    ends[1].ops->close(ends[1].context);
    open_end(1, NULL, 0);
    TEST_ASSERT_FALSE(receive_at(1, &frame));
}

static void test_each_state_of_a_link_has_its_sentence(void)
{
    for (int i = 0; i < MCT_CAN_LINK_STATES; i++) {
        const char *text = mct_can_link_text((mct_can_link_state)i);
        TEST_ASSERT_NOT_NULL(text);
        TEST_ASSERT_TRUE(strlen(text) > 10);
    }
    TEST_ASSERT_EQUAL_STRING("not a state of a link", mct_can_link_text(MCT_CAN_LINK_STATES));
}

static void test_each_count_has_name_and_meaning(void)
{
    for (int i = 0; i < MCT_CAN_COUNTS; i++) {
        TEST_ASSERT_TRUE(strlen(mct_can_counters[i].name) > 0);
        TEST_ASSERT_TRUE(strlen(mct_can_counters[i].doc) > 0);
    }
    TEST_ASSERT_EQUAL_STRING("sent", mct_can_counters[MCT_CAN_COUNT_SENT].name);
    TEST_ASSERT_EQUAL_STRING("armings", mct_can_counters[MCT_CAN_COUNT_ARMINGS].name);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_frames_come_in_order_to_the_other_end_and_never_back);
    RUN_TEST(test_a_full_queue_refuses_and_counts_and_keeps_the_older_frames);
    RUN_TEST(test_filters_pass_their_identifiers_in_either_format_and_remote_and_no_others);
    RUN_TEST(test_filters_that_cannot_be_are_refused_with_a_sentence);
    RUN_TEST(test_a_wait_lets_the_other_end_work_once_and_only_when_nothing_is_there);
    RUN_TEST(test_a_service_is_not_called_from_within_itself);
    RUN_TEST(test_time_stands_but_for_advance_and_waits_in_vain_without_a_service);
    RUN_TEST(test_a_lost_link_carries_nothing_and_what_waited_is_thrown_away);
    RUN_TEST(test_while_nobody_acknowledges_sends_are_held_back_and_the_link_is_not_lost);
    RUN_TEST(test_a_closed_end_neither_sends_nor_hears);
    RUN_TEST(test_each_state_of_a_link_has_its_sentence);
    RUN_TEST(test_each_count_has_name_and_meaning);
    return UNITY_END();
}

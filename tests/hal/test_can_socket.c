/*
 * The Linux socket. Its rules are tried without a bus: confirmations, errors of the chip, states. A pair of
 * local sockets stands for the kernel's queue. What the kernel does is tried in the lab.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include <linux/can.h>
#include <linux/can/error.h>

#include "hal/socketcan/socket.h"
#include "unity.h"

static const mct_can_filter drive_says[] = {{0x181, false}, {0x18DAF110, true}};

static mct_can_socket can;
static mct_can_transport bus;
static mct_can_counts counts;
static int far_end;

/* A socket as it is after open. */
void setUp(void)
{
    memset(&counts, 0, sizeof counts);
    bus = mct_can_socket_transport(&can, "can0", 500000);
    can.counts = &counts;
    can.state = MCT_CAN_UP;
    can.filter_count = 2;
    memcpy(can.filters, drive_says, sizeof drive_says);
    far_end = -1;
}

void tearDown(void)
{
    bus.ops->close(bus.context);
    if (far_end >= 0) {
        close(far_end);
    }
}

static uint64_t count_of(mct_can_count count)
{
    return counts.values[count];
}

static bool take(uint32_t id, int flags)
{
    struct can_frame raw;
    mct_can_frame frame;
    memset(&raw, 0, sizeof raw);
    raw.can_id = id;
    raw.can_dlc = 1;
    return mct_can_socket_take(&can, &raw, flags, 1234, &frame);
}

static void take_error(uint32_t class, uint8_t controller, uint8_t place)
{
    struct can_frame raw;
    mct_can_frame frame;
    memset(&raw, 0, sizeof raw);
    raw.can_id = CAN_ERR_FLAG | class;
    raw.can_dlc = CAN_ERR_DLC;
    raw.data[1] = controller;
    raw.data[3] = place;
    TEST_ASSERT_FALSE(mct_can_socket_take(&can, &raw, 0, 0, &frame));
}

/* Hands a frame over, as far as the rules go. */
static mct_can_flight *fly(uint32_t id, int64_t now_us)
{
    bool is_new;
    mct_can_flight *flight = mct_can_socket_flight(&can, id, &is_new);
    TEST_ASSERT_NOT_NULL(flight);
    flight->unsent = true;
    flight->since_us = now_us;
    return flight;
}

/* --- open --- */

static void check_no_can(int error)
{
    mct_message why = {""};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, bus.ops->open(bus.context, drive_says, 2, &counts, &why));
    TEST_ASSERT_TRUE(strlen(why.text) > 20);
    if (error == EAFNOSUPPORT || error == EPROTONOSUPPORT) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "this kernel has no CAN"), why.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "modprobe -a can can_raw"), why.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "container"), why.text);
    }
}

static void check_wrong_interface(const char *name, const char *words)
{
    mct_message why = {""};
    bus = mct_can_socket_transport(&can, name, 0);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, bus.ops->open(bus.context, drive_says, 2, &counts, &why));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, words), why.text);
}

/* By what this kernel has: both ways end without a socket. */
static void test_open_says_what_to_load_or_which_interface_is_wrong(void)
{
    const int fd = socket(PF_CAN, SOCK_RAW, CAN_RAW);
    if (fd < 0) {
        check_no_can(errno);
    } else {
        close(fd);
        check_wrong_interface("nosuchcan", "there is no interface \"nosuchcan\"");
        check_wrong_interface("lo", "\"lo\" is not a CAN interface");
    }
    TEST_ASSERT_EQUAL_INT(-1, can.fd);
}

static void test_a_name_that_no_interface_can_have_is_refused(void)
{
    mct_message why = {""};
    bus = mct_can_socket_transport(&can, "sixteen-letters-", 0);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, bus.ops->open(bus.context, drive_says, 2, &counts, &why));
    TEST_ASSERT_EQUAL_STRING(
        "found an interface's name \"sixteen-letters...\"; allowed 1 to 15 bytes, such as can0", why.text);
    mct_message_clear(&why);
    bus = mct_can_socket_transport(&can, "", 0);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, bus.ops->open(bus.context, drive_says, 2, &counts, &why));
    TEST_ASSERT_NOT_NULL(strstr(why.text, "allowed 1 to 15 bytes"));
}

static void test_a_socket_that_is_not_open_neither_sends_nor_receives(void)
{
    mct_can_frame frame = {.id = 0x101};
    TEST_ASSERT_FALSE(bus.ops->send(bus.context, &frame));
    TEST_ASSERT_FALSE(bus.ops->receive(bus.context, &frame));
    bus.ops->close(bus.context);
}

static void test_the_kernel_tells_of_an_interface_or_that_there_is_none(void)
{
    mct_can_link link;
    TEST_ASSERT_FALSE(mct_can_link_details("nosuchcan", &link));
    TEST_ASSERT_EQUAL_INT(-1, link.state);
    if (mct_can_link_details("lo", &link)) { /* a sandbox may have none */
        TEST_ASSERT_TRUE(link.index > 0);
        TEST_ASSERT_FALSE(link.is_can);
        TEST_ASSERT_EQUAL_INT(-1, link.state);
        TEST_ASSERT_EQUAL_UINT32(0, link.bitrate);
    }
}

/* --- what comes --- */

static void test_a_frame_from_the_bus_is_taken_as_it_is(void)
{
    mct_can_frame frame;
    struct can_frame raw;
    memset(&raw, 0xA5, sizeof raw);
    raw.can_id = 0x18DAF110 | CAN_EFF_FLAG;
    raw.can_dlc = 3;
    memcpy(raw.data, "abcdefgh", 8);
    TEST_ASSERT_TRUE(mct_can_socket_take(&can, &raw, 0, 1234, &frame));
    TEST_ASSERT_EQUAL_HEX32(0x18DAF110, frame.id);
    TEST_ASSERT_TRUE(frame.extended);
    TEST_ASSERT_FALSE(frame.remote);
    TEST_ASSERT_EQUAL_UINT8(3, frame.length);
    TEST_ASSERT_EQUAL_MEMORY("abc\0\0\0\0\0", frame.data, 8);
    TEST_ASSERT_TRUE(frame.time_us == 1234);
    raw.can_id |= CAN_RTR_FLAG;
    TEST_ASSERT_TRUE(
        mct_can_socket_take(&can, &raw, MSG_DONTROUTE, 1234, &frame)); /* of another program here */
    TEST_ASSERT_TRUE(frame.remote);
    TEST_ASSERT_EQUAL_MEMORY("\0\0\0", frame.data, 3);
}

static void test_frames_in_the_other_format_are_for_the_receiver_to_refuse(void)
{
    TEST_ASSERT_TRUE(take(0x181 | CAN_EFF_FLAG, 0));
    TEST_ASSERT_EQUAL_UINT64(0, count_of(MCT_CAN_COUNT_FOREIGN));
}

static void test_somebody_else_who_sends_ones_own_identifiers_is_foreign(void)
{
    fly(0x101, 0);
    TEST_ASSERT_FALSE(take(0x101, 0));
    TEST_ASSERT_FALSE(take(0x101, MSG_DONTROUTE));
    TEST_ASSERT_EQUAL_UINT64(2, count_of(MCT_CAN_COUNT_FOREIGN));
    TEST_ASSERT_EQUAL_UINT64(0, count_of(MCT_CAN_COUNT_CONFIRMED));
}

/* --- confirmations --- */

static void test_ones_own_frame_is_a_confirmation_and_never_received(void)
{
    mct_can_flight *flight = fly(0x181, 0);
    TEST_ASSERT_FALSE(take(0x181, MSG_DONTROUTE | MSG_CONFIRM));
    TEST_ASSERT_FALSE(flight->unsent);
    TEST_ASSERT_FALSE(take(0x181, MSG_DONTROUTE | MSG_CONFIRM));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_CONFIRMED));
}

static void test_each_identifier_has_its_own_flight_by_format_and_kind(void)
{
    mct_can_flight *plain = fly(0x101, 0);
    mct_can_flight *extended = fly(0x101 | CAN_EFF_FLAG, 0);
    mct_can_flight *remote = fly(0x101 | CAN_RTR_FLAG, 0);
    take(0x101 | CAN_EFF_FLAG, MSG_CONFIRM);
    TEST_ASSERT_TRUE(plain->unsent);
    TEST_ASSERT_FALSE(extended->unsent);
    TEST_ASSERT_TRUE(remote->unsent);
}

static void test_beyond_the_room_for_flights_there_is_none(void)
{
    bool is_new;
    for (uint32_t id = 0; id < MCT_CAN_MAX_FLIGHTS; id++) {
        fly(id, 0);
    }
    TEST_ASSERT_NULL(mct_can_socket_flight(&can, 0x7FF, &is_new));
    TEST_ASSERT_NOT_NULL(mct_can_socket_flight(&can, 0, &is_new));
    TEST_ASSERT_FALSE(is_new);
}

static void test_a_frame_unsent_for_long_makes_the_link_unsent_until_it_is_confirmed(void)
{
    fly(0x101, 1000);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, mct_can_socket_state(&can, 1000 + MCT_CAN_UNSENT_US));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UNSENT, mct_can_socket_state(&can, 1001 + MCT_CAN_UNSENT_US));
    take(0x101, MSG_CONFIRM);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, mct_can_socket_state(&can, 1002 + MCT_CAN_UNSENT_US));
    TEST_ASSERT_EQUAL_UINT64(0, count_of(MCT_CAN_COUNT_LINK_LOST));
}

static void test_a_frame_without_a_confirmation_stays_unsent_until_the_link_is_lost(void)
{
    const int64_t a_day_us = INT64_C(86400000000);
    mct_can_flight *flight = fly(0x101, 0);
    TEST_ASSERT_TRUE(take(0x181, 0)); /* a bus that lives confirms nothing */
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UNSENT, mct_can_socket_state(&can, a_day_us));
    TEST_ASSERT_TRUE(flight->unsent);
    mct_can_socket_lose(&can, MCT_CAN_DOWN);
    TEST_ASSERT_FALSE(flight->unsent);
    mct_can_socket_regain(&can);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, mct_can_socket_state(&can, a_day_us));
}

static void test_an_overflow_is_counted_by_difference_and_takes_confirmations_with_it(void)
{
    mct_can_flight *flight = fly(0x101, 0);
    can.dropped = UINT32_MAX - 1;
    mct_can_socket_dropped(&can, UINT32_MAX - 1);
    TEST_ASSERT_TRUE(flight->unsent);
    mct_can_socket_dropped(&can, 3);
    TEST_ASSERT_EQUAL_UINT64(5, count_of(MCT_CAN_COUNT_OVERFLOWED));
    TEST_ASSERT_FALSE(flight->unsent);
}

/* --- errors of the chip --- */

static void test_errors_are_told_apart(void)
{
    take_error(CAN_ERR_ACK, 0, 0);
    take_error(CAN_ERR_PROT | CAN_ERR_BUSERROR, 0, CAN_ERR_PROT_LOC_ACK);
    TEST_ASSERT_EQUAL_UINT64(2, count_of(MCT_CAN_COUNT_NO_ACKNOWLEDGE));
    take_error(CAN_ERR_PROT | CAN_ERR_BUSERROR, 0, CAN_ERR_PROT_LOC_DATA);
    take_error(CAN_ERR_BUSERROR, 0, CAN_ERR_PROT_LOC_ACK); /* the place holds only with CAN_ERR_PROT */
    TEST_ASSERT_EQUAL_UINT64(2, count_of(MCT_CAN_COUNT_BUS_ERRORS));
    take_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW, 0);
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_OVERFLOWED));
    take_error(CAN_ERR_TX_TIMEOUT, 0, 0);
    TEST_ASSERT_EQUAL_UINT64(6, count_of(MCT_CAN_COUNT_ERROR_FRAMES));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, mct_can_socket_state(&can, 0));
}

static void test_error_passive_is_counted_when_it_begins(void)
{
    take_error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING, 0);
    take_error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE, 0);
    take_error(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE | CAN_ERR_CRTL_RX_PASSIVE, 0);
    take_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW, 0); /* says nothing of it */
    take_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE, 0);
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_ERROR_PASSIVE));
    take_error(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE, 0);
    take_error(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE, 0);
    TEST_ASSERT_EQUAL_UINT64(2, count_of(MCT_CAN_COUNT_ERROR_PASSIVE));
}

static void test_bus_off_lasts_until_the_restart_and_forgets_what_was_under_way(void)
{
    mct_can_flight *flight = fly(0x101, 0);
    take_error(CAN_ERR_BUSOFF, 0, 0);
    take_error(CAN_ERR_BUSOFF, 0, 0);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_BUS_OFF, mct_can_socket_state(&can, 1000000));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_BUS_OFF));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_LINK_LOST));
    TEST_ASSERT_FALSE(flight->unsent);
    take_error(CAN_ERR_RESTARTED, 0, 0);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, mct_can_socket_state(&can, 1000000));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_LINK_BACK));
}

static void test_a_frame_from_the_bus_ends_bus_off_and_one_of_this_machine_does_not(void)
{
    take_error(CAN_ERR_BUSOFF, 0, 0);
    TEST_ASSERT_FALSE(take(0x181, MSG_DONTROUTE));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_BUS_OFF, mct_can_socket_state(&can, 0));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_SKIPPED));
    TEST_ASSERT_TRUE(take(0x181, 0));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, mct_can_socket_state(&can, 0));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_LINK_BACK));
}

static void test_a_link_that_changes_while_lost_is_lost_once_and_what_was_read_ahead_is_thrown_away(void)
{
    can.has_pending = true;
    mct_can_socket_lose(&can, MCT_CAN_DOWN);
    mct_can_socket_lose(&can, MCT_CAN_GONE);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_GONE, mct_can_socket_state(&can, 0));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_LINK_LOST));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_SKIPPED));
    TEST_ASSERT_FALSE(can.has_pending);
    mct_can_socket_regain(&can);
    mct_can_socket_regain(&can);
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_LINK_BACK));
}

/* --- the queue, with a pair of local sockets in the kernel's place --- */

static void connect_pair(void)
{
    int pair[2];
    TEST_ASSERT_EQUAL_INT(0, socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, pair));
    can.fd = pair[0];
    far_end = pair[1];
}

static void arrive(uint32_t id, uint8_t first)
{
    struct can_frame raw;
    memset(&raw, 0, sizeof raw);
    raw.can_id = id;
    raw.can_dlc = 1;
    raw.data[0] = first;
    TEST_ASSERT_EQUAL_INT(sizeof raw, write(far_end, &raw, sizeof raw));
}

static void test_frames_are_received_in_order_and_errors_among_them_are_not(void)
{
    mct_can_frame frame;
    connect_pair();
    TEST_ASSERT_FALSE(bus.ops->receive(bus.context, &frame));
    arrive(CAN_ERR_FLAG | CAN_ERR_ACK, 0);
    arrive(0x181, 1);
    arrive(CAN_ERR_FLAG | CAN_ERR_ACK, 0);
    arrive(0x181, 2);
    arrive(CAN_ERR_FLAG | CAN_ERR_ACK, 0);
    TEST_ASSERT_TRUE(bus.ops->wait(bus.context, 0));
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, bus.ops->tend(bus.context));
    for (uint8_t k = 1; k <= 2; k++) {
        TEST_ASSERT_TRUE(bus.ops->receive(bus.context, &frame));
        TEST_ASSERT_EQUAL_UINT8(k, frame.data[0]);
        const int64_t age_us = bus.ops->now_us(bus.context) - frame.time_us;
        TEST_ASSERT_TRUE(age_us >= 0 && age_us < 60000000);
    }
    TEST_ASSERT_FALSE(bus.ops->receive(bus.context, &frame));
    TEST_ASSERT_EQUAL_UINT64(3, count_of(MCT_CAN_COUNT_NO_ACKNOWLEDGE));
}

static void test_errors_alone_do_not_end_a_wait_and_a_wait_in_vain_takes_its_time(void)
{
    connect_pair();
    arrive(CAN_ERR_FLAG | CAN_ERR_ACK, 0);
    const int64_t begin_us = bus.ops->now_us(bus.context);
    TEST_ASSERT_FALSE(bus.ops->wait(bus.context, 3000));
    TEST_ASSERT_TRUE(bus.ops->now_us(bus.context) - begin_us >= 3000);
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_ERROR_FRAMES));
}

static void test_what_came_between_bus_off_and_restart_is_not_received(void)
{
    mct_can_frame frame;
    connect_pair();
    arrive(0x181, 1);
    TEST_ASSERT_TRUE(bus.ops->receive(bus.context, &frame));
    arrive(CAN_ERR_FLAG | CAN_ERR_BUSOFF, 0);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_BUS_OFF, bus.ops->tend(bus.context));
    const mct_can_frame command = {.id = 0x101, .length = 1};
    TEST_ASSERT_FALSE(bus.ops->send(bus.context, &command));
    arrive(CAN_ERR_FLAG | CAN_ERR_RESTARTED, 0);
    arrive(0x181, 2);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_UP, bus.ops->tend(bus.context));
    TEST_ASSERT_TRUE(bus.ops->receive(bus.context, &frame));
    TEST_ASSERT_EQUAL_UINT8(2, frame.data[0]);
}

static void test_an_unsent_frame_holds_back_the_next_of_its_identifier_only(void)
{
    const mct_can_frame first = {.id = 0x101, .length = 1}, second = {.id = 0x102, .length = 1};
    connect_pair();
    fly(0x101, bus.ops->now_us(bus.context));
    bool is_new;
    mct_can_socket_flight(&can, 0x102, &is_new);
    TEST_ASSERT_FALSE(bus.ops->send(bus.context, &first));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_HELD_BACK));
    TEST_ASSERT_TRUE(bus.ops->send(bus.context, &second));
    TEST_ASSERT_FALSE(bus.ops->send(bus.context, &second));
    TEST_ASSERT_EQUAL_UINT64(2, count_of(MCT_CAN_COUNT_HELD_BACK));
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_SENT));
}

/* The pair has no filters to add an identifier to: such frames are sent all the same, unconfirmed. */
static void test_a_full_send_queue_gives_the_frame_up(void)
{
    const mct_can_frame frame = {.id = 0x101, .length = 2, .data = {7, 8}};
    struct can_frame raw;
    connect_pair();
    int sent = 0;
    while (sent < 100000 && bus.ops->send(bus.context, &frame)) {
        sent++;
    }
    TEST_ASSERT_TRUE(sent > 0 && sent < 100000);
    TEST_ASSERT_EQUAL_UINT64(1, count_of(MCT_CAN_COUNT_QUEUE_FULL));
    TEST_ASSERT_EQUAL_UINT64((uint64_t)sent, count_of(MCT_CAN_COUNT_SENT));
    TEST_ASSERT_EQUAL_INT(0, can.flight_count);
    TEST_ASSERT_EQUAL_INT(sizeof raw, read(far_end, &raw, sizeof raw));
    TEST_ASSERT_EQUAL_HEX32(0x101, raw.can_id);
    TEST_ASSERT_EQUAL_UINT8(2, raw.can_dlc);
    TEST_ASSERT_EQUAL_MEMORY("\7\10\0\0\0\0\0\0", raw.data, 8);
}

static void test_an_interface_that_is_gone_is_looked_for_now_and_then(void)
{
    mct_can_frame frame = {.id = 0x101};
    connect_pair();
    bus = (mct_can_transport){bus.ops, &can};
    strcpy(can.interface, "nosuchcan");
    mct_can_socket_lose(&can, MCT_CAN_GONE);
    TEST_ASSERT_EQUAL_INT(MCT_CAN_GONE, bus.ops->tend(bus.context));
    TEST_ASSERT_EQUAL_INT(-1, can.fd);
    const int64_t tried_us = can.tried_us;
    TEST_ASSERT_TRUE(tried_us > 0);
    can.tried_us = bus.ops->now_us(bus.context); /* as if just now */
    const int64_t just_now = can.tried_us;
    TEST_ASSERT_EQUAL_INT(MCT_CAN_GONE, bus.ops->tend(bus.context));
    TEST_ASSERT_TRUE(can.tried_us == just_now || can.tried_us - just_now >= MCT_CAN_RETRY_US);
    TEST_ASSERT_FALSE(bus.ops->send(bus.context, &frame));
    TEST_ASSERT_FALSE(bus.ops->receive(bus.context, &frame));
    TEST_ASSERT_FALSE(bus.ops->wait(bus.context, 1000));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_open_says_what_to_load_or_which_interface_is_wrong);
    RUN_TEST(test_a_name_that_no_interface_can_have_is_refused);
    RUN_TEST(test_a_socket_that_is_not_open_neither_sends_nor_receives);
    RUN_TEST(test_the_kernel_tells_of_an_interface_or_that_there_is_none);
    RUN_TEST(test_a_frame_from_the_bus_is_taken_as_it_is);
    RUN_TEST(test_frames_in_the_other_format_are_for_the_receiver_to_refuse);
    RUN_TEST(test_somebody_else_who_sends_ones_own_identifiers_is_foreign);
    RUN_TEST(test_ones_own_frame_is_a_confirmation_and_never_received);
    RUN_TEST(test_each_identifier_has_its_own_flight_by_format_and_kind);
    RUN_TEST(test_beyond_the_room_for_flights_there_is_none);
    RUN_TEST(test_a_frame_unsent_for_long_makes_the_link_unsent_until_it_is_confirmed);
    RUN_TEST(test_a_frame_without_a_confirmation_stays_unsent_until_the_link_is_lost);
    RUN_TEST(test_an_overflow_is_counted_by_difference_and_takes_confirmations_with_it);
    RUN_TEST(test_errors_are_told_apart);
    RUN_TEST(test_error_passive_is_counted_when_it_begins);
    RUN_TEST(test_bus_off_lasts_until_the_restart_and_forgets_what_was_under_way);
    RUN_TEST(test_a_frame_from_the_bus_ends_bus_off_and_one_of_this_machine_does_not);
    RUN_TEST(test_a_link_that_changes_while_lost_is_lost_once_and_what_was_read_ahead_is_thrown_away);
    RUN_TEST(test_frames_are_received_in_order_and_errors_among_them_are_not);
    RUN_TEST(test_errors_alone_do_not_end_a_wait_and_a_wait_in_vain_takes_its_time);
    RUN_TEST(test_what_came_between_bus_off_and_restart_is_not_received);
    RUN_TEST(test_an_unsent_frame_holds_back_the_next_of_its_identifier_only);
    RUN_TEST(test_a_full_send_queue_gives_the_frame_up);
    RUN_TEST(test_an_interface_that_is_gone_is_looked_for_now_and_then);
    return UNITY_END();
}

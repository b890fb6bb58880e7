/* The recorded bus: what is a log, and how sends and receives walk through it. */
#include <stdlib.h>
#include <string.h>

#include "hal/socketcan/candump.h"
#include "unity.h"

/* Two ticks of a drive: commands 101, feedback 181, now and then status 201. */
static const char recorded[] = "(1000.000000) can0 181#01\n"
                               "(1000.000400) can0 201#AA\n"
                               "(1000.001000) can0 101#10\n"
                               "(1000.001300) can0 181#02\n"
                               "(1000.002000) can0 101#11\n"
                               "(1000.002300) can0 181#03\n"
                               "(1000.002400) can0 201#BB\n"
                               "(1000.003000) can0 101#12\n"
                               "(1000.003300) can0 181#04\n";

static const mct_can_filter drive_says[] = {{0x181, false}, {0x201, false}};

static mct_can_candump dump;
static mct_can_transport bus;
static mct_can_counts counts;
static mct_message why;

void setUp(void)
{
    memset(&counts, 0, sizeof counts);
    mct_message_clear(&why);
}

void tearDown(void)
{
}

static mct_status open_span(const char *text, size_t length)
{
    bus = mct_can_candump_transport(&dump, text, length);
    return bus.ops->open(bus.context, drive_says, 2, &counts, &why);
}

static void begin(const char *text)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, open_span(text, strlen(text)), why.text);
}

static bool send(uint32_t id, uint8_t first)
{
    const mct_can_frame frame = {.id = id, .length = 1, .data = {first}};
    return bus.ops->send(bus.context, &frame);
}

static int64_t now_us(void)
{
    return bus.ops->now_us(bus.context);
}

static void expect(uint32_t id, uint8_t first, int time_us)
{
    mct_can_frame frame;
    TEST_ASSERT_TRUE(bus.ops->wait(bus.context, 1000));
    TEST_ASSERT_TRUE(bus.ops->receive(bus.context, &frame));
    TEST_ASSERT_EQUAL_HEX32(id, frame.id);
    TEST_ASSERT_EQUAL_HEX8(first, frame.data[0]);
    TEST_ASSERT_EQUAL_INT(time_us, (int)frame.time_us);
    TEST_ASSERT_EQUAL_INT(time_us, (int)now_us());
}

static void expect_nothing(void)
{
    mct_can_frame frame;
    TEST_ASSERT_FALSE(bus.ops->receive(bus.context, &frame));
}

static void expect_state(mct_can_link_state state)
{
    TEST_ASSERT_EQUAL_INT(state, bus.ops->tend(bus.context));
}

static void test_own_commands_part_the_ticks_and_the_same_run_compares_equal(void)
{
    begin(recorded);
    TEST_ASSERT_EQUAL_UINT64(9, dump.lines);
    expect(0x181, 1, 0);
    expect(0x201, 0xAA, 400);
    expect_nothing();
    for (int k = 0; k < 3; k++) {
        expect_state(MCT_CAN_UP);
        TEST_ASSERT_TRUE(send(0x101, (uint8_t)(0x10 + k)));
        TEST_ASSERT_EQUAL_INT(1000 * (k + 1), (int)now_us());
        expect(0x181, (uint8_t)(2 + k), 1000 * (k + 1) + 300);
        if (k == 1) {
            expect(0x201, 0xBB, 2400);
        }
        expect_nothing();
    }
    expect_state(MCT_CAN_END_OF_LOG);
    TEST_ASSERT_EQUAL_UINT64(3, dump.compared);
    TEST_ASSERT_EQUAL_UINT64(0, dump.mismatches);
    TEST_ASSERT_EQUAL_UINT64(0, dump.unmatched);
    TEST_ASSERT_EQUAL_UINT64(3, counts.values[MCT_CAN_COUNT_SENT]);
    TEST_ASSERT_FALSE(send(0x101, 0x13)); /* no more of it */
    TEST_ASSERT_EQUAL_UINT64(1, dump.unmatched);
}

static void test_a_command_with_other_data_or_length_is_a_mismatch_and_replay_goes_on(void)
{
    const mct_can_frame longer = {.id = 0x101, .length = 2, .data = {0x11}};
    begin(recorded);
    TEST_ASSERT_TRUE(send(0x101, 0x55));
    TEST_ASSERT_EQUAL_UINT64(2, counts.values[MCT_CAN_COUNT_SKIPPED]); /* that nobody had received */
    TEST_ASSERT_TRUE(bus.ops->send(bus.context, &longer));
    TEST_ASSERT_TRUE(send(0x101, 0x12));
    TEST_ASSERT_EQUAL_UINT64(3, dump.compared);
    TEST_ASSERT_EQUAL_UINT64(2, dump.mismatches);
    expect(0x181, 4, 3300);
}

static void test_a_frame_that_the_log_has_not_is_counted_and_moves_nothing(void)
{
    begin(recorded);
    TEST_ASSERT_TRUE(send(0x7FF, 1));
    TEST_ASSERT_EQUAL_UINT64(1, dump.unmatched);
    expect_state(MCT_CAN_UP);
    expect(0x181, 1, 0);
}

static void test_a_command_far_ahead_is_another_one(void)
{
    begin("(1.000000) can0 181#01\n"
          "(1.000100) can0 301#01\n"
          "(1.000200) can0 181#02\n"
          "(2.000201) can0 301#02\n"
          "(2.000300) can0 181#03\n");
    TEST_ASSERT_TRUE(send(0x301, 1));
    TEST_ASSERT_TRUE(send(0x301, 2));
    TEST_ASSERT_EQUAL_UINT64(1, dump.unmatched);
    expect(0x181, 2, 200);
    TEST_ASSERT_TRUE(send(0x301, 2)); /* now nothing comes before it but silence */
    TEST_ASSERT_EQUAL_UINT64(1, dump.unmatched);
    expect(0x181, 3, 1000300);
}

static void test_a_wait_in_vain_takes_its_time_and_all_that_follows_comes_later(void)
{
    begin(recorded);
    expect(0x181, 1, 0);
    expect(0x201, 0xAA, 400);
    TEST_ASSERT_FALSE(bus.ops->wait(bus.context, 5000));
    TEST_ASSERT_EQUAL_INT(5400, (int)now_us());
    TEST_ASSERT_TRUE(send(0x101, 0x10));
    expect(0x181, 2, 6300);
}

static void test_foreign_frames_are_passed_over_where_ones_own_are_listed(void)
{
    static const mct_can_filter own[] = {{0x101, false}};
    static const char text[] = "(1.000000) can0 700#00\n"
                               "(1.000100) can0 181#01\n"
                               "(1.000200) can0 701#00\n"
                               "(1.000300) can0 101#01\n"
                               "(1.000400) can0 00000101#01\n"
                               "(1.000500) can0 181#02\n"
                               "(1.000600) can0 701#00\n";
    bus = mct_can_candump_transport(&dump, text, strlen(text));
    dump.own = own;
    dump.own_count = 1;
    TEST_ASSERT_EQUAL_INT(MCT_OK, bus.ops->open(bus.context, drive_says, 2, &counts, &why));
    expect(0x181, 1, 100);
    expect_nothing();
    TEST_ASSERT_TRUE(send(0x101, 1));
    expect(0x181, 2, 500);
    expect_state(MCT_CAN_END_OF_LOG);
}

static void test_a_log_that_only_holds_back_own_frames_has_ended(void)
{
    begin("(1.000000) can0 101#01\n"
          "(1.000100) can0 181#01\n"
          "(1.000200) can0 302#01\n"
          "(1.000300) can0 181#02\n");
    TEST_ASSERT_TRUE(send(0x101, 1));
    expect(0x181, 1, 100);
    expect_nothing(); /* 302 is one's own as far as anybody knows */
    expect_state(MCT_CAN_UP);
    TEST_ASSERT_FALSE(send(0x101, 2));
    expect_state(MCT_CAN_END_OF_LOG);
    TEST_ASSERT_TRUE(send(0x302, 1));
    expect_state(MCT_CAN_UP);
    expect(0x181, 2, 300);
    expect_state(MCT_CAN_END_OF_LOG);
}

static void test_every_form_of_a_line_is_read(void)
{
    mct_can_frame frame;
    begin("(0000000001.000000000) can0 181#R3 R\r\n"
          "\n"
          "(1.000001) slcan0-long 00000181#0011223344556677 T\n"
          "(1.000002) can0 20000080#0000080000000000\n"
          "(1.000003) can0 201#\n"
          "(1.000004) can0 201#R\n"
          "(1.000005) can0 201#aBcD");
    TEST_ASSERT_TRUE(bus.ops->receive(bus.context, &frame));
    TEST_ASSERT_TRUE(frame.remote);
    TEST_ASSERT_EQUAL_UINT8(3, frame.length);
    TEST_ASSERT_TRUE(bus.ops->receive(bus.context, &frame));
    TEST_ASSERT_TRUE(frame.extended);
    TEST_ASSERT_EQUAL_UINT8(8, frame.length);
    TEST_ASSERT_EQUAL_HEX8(0x77, frame.data[7]);
    TEST_ASSERT_TRUE(bus.ops->receive(bus.context, &frame));
    TEST_ASSERT_EQUAL_UINT8(0, frame.length);
    TEST_ASSERT_FALSE(frame.remote);
    TEST_ASSERT_TRUE(bus.ops->receive(bus.context, &frame));
    TEST_ASSERT_TRUE(frame.remote);
    TEST_ASSERT_TRUE(bus.ops->receive(bus.context, &frame));
    TEST_ASSERT_EQUAL_UINT8(2, frame.length);
    TEST_ASSERT_EQUAL_HEX8(0xAB, frame.data[0]);
    TEST_ASSERT_TRUE(frame.time_us == 5);
    expect_nothing();
    expect_state(MCT_CAN_END_OF_LOG);
}

static void test_a_line_that_is_none_is_refused_by_number_and_text_and_what_is_allowed(void)
{
    static const struct {
        const char *line, *says;
    } bad[] = {
        {"hello", "time stamp"},
        {"(1.0) can0 181#00", "time stamp"},
        {"(1.000000)can0 181#00", "time stamp"},
        {"(1.000000) 181#00", "an interface"},
        {"(1.000000) can0 181", "'#'"},
        {"(1.000000) can0 81#00", "3 or 8"},
        {"(1.000000) can0 181##100", "CAN FD"},
        {"(1.000000) can0 800#00", "7FF"},
        {"(1.000000) can0 40000000#00", "1FFFFFFF"},
        {"(1.000000) can0 181#0", "two hexadecimal"},
        {"(1.000000) can0 181#R9", "R8"},
        {"(1.000000) can0 181#001122334455667788", "8 bytes"},
        {"(1.000000) can0 181#00 X", "R or T"},
        {"(1.000000) can0 181#00 T ", "R or T"},
        {"(9999999999999.000000) can0 181#00", "time stamp"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        char text[256] = "(1.000000) can0 181#00\n\n";
        strcat(text, bad[i].line);
        strcat(text, "\n(1.000000) can0 181#00\n");
        mct_message_clear(&why);
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_ERROR_IO, open_span(text, strlen(text)), bad[i].line);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "line 3 of the CAN log: found \""), why.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, bad[i].line), why.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "allowed"), why.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, bad[i].says), why.text);
        expect_nothing();
        TEST_ASSERT_FALSE(send(0x101, 0));
    }
}

static void test_a_log_of_other_drives_is_refused(void)
{
    static const char text[] = "(1.000000) can0 182#00\n";
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, open_span(text, strlen(text)));
    TEST_ASSERT_NOT_NULL(strstr(why.text, "holds 1 frames, none of them"));
    mct_message_clear(&why);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_IO, open_span(NULL, 0));
    TEST_ASSERT_NOT_NULL(strstr(why.text, "holds 0 frames"));
}

/* In memory of its own size, for the sanitizer to see a step beyond. */
static void test_a_log_cut_anywhere_is_read_within_its_bounds(void)
{
    mct_can_frame frame;
    for (size_t length = 1; length < sizeof recorded; length++) {
        char *text = malloc(length);
        memcpy(text, recorded, length);
        if (open_span(text, length) == MCT_OK) {
            for (int k = 0; k < 4; k++) {
                while (bus.ops->receive(bus.context, &frame)) {
                }
                send(0x101, 0);
                bus.ops->tend(bus.context);
            }
            expect_state(MCT_CAN_END_OF_LOG);
        }
        free(text);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_own_commands_part_the_ticks_and_the_same_run_compares_equal);
    RUN_TEST(test_a_command_with_other_data_or_length_is_a_mismatch_and_replay_goes_on);
    RUN_TEST(test_a_frame_that_the_log_has_not_is_counted_and_moves_nothing);
    RUN_TEST(test_a_command_far_ahead_is_another_one);
    RUN_TEST(test_a_wait_in_vain_takes_its_time_and_all_that_follows_comes_later);
    RUN_TEST(test_foreign_frames_are_passed_over_where_ones_own_are_listed);
    RUN_TEST(test_a_log_that_only_holds_back_own_frames_has_ended);
    RUN_TEST(test_every_form_of_a_line_is_read);
    RUN_TEST(test_a_line_that_is_none_is_refused_by_number_and_text_and_what_is_allowed);
    RUN_TEST(test_a_log_of_other_drives_is_refused);
    RUN_TEST(test_a_log_cut_anywhere_is_read_within_its_bounds);
    return UNITY_END();
}

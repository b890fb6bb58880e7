/* Rules of messages: one line of valid text, never longer than its storage. */
#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "mctau/message.h"
#include "unity.h"

static mct_message message;

void setUp(void)
{
    memset(&message, 'x', sizeof message);
    mct_message_clear(&message);
}

void tearDown(void)
{
}

static void test_cleared_message_is_empty(void)
{
    TEST_ASSERT_EQUAL_STRING("", message.text);
}

static void test_pieces_follow_each_other(void)
{
    mct_message_add(&message, "found ");
    mct_message_add_number(&message, -1);
    mct_message_add_span(&message, " kg and more", 3);
    mct_message_add(&message, "; line ");
    mct_message_add_integer(&message, 12);
    TEST_ASSERT_EQUAL_STRING("found -1 kg; line 12", message.text);
}

static void test_integers_are_written_to_their_limits(void)
{
    const long long values[] = {0, 7, -7, 1000, LLONG_MAX, LLONG_MIN};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        char expected[32];
        snprintf(expected, sizeof expected, "%lld", values[i]);
        mct_message_clear(&message);
        mct_message_add_integer(&message, values[i]);
        TEST_ASSERT_EQUAL_STRING(expected, message.text);
    }
}

static void test_numbers_are_short_where_they_can_be(void)
{
    const double values[] = {0.001, 2.5e-6, 1000, 0.1, 3.141592653589793, -0.5, 1e-7, 1e300};
    const char *const texts[] = {"0.001", "2.5e-06", "1000", "0.1", "3.14159265", "-0.5", "1e-07", "1e+300"};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        mct_message_clear(&message);
        mct_message_add_number(&message, values[i]);
        TEST_ASSERT_EQUAL_STRING(texts[i], message.text);
    }
}

static void test_control_characters_and_broken_utf8_are_shown_as_question_marks(void)
{
    const char text[] = "a\nb\t\x1b[0m\x7f \xC3\xA9 \xC3( \xED\xA0\x80 \xFF";
    mct_message_add_span(&message, text, sizeof text - 1);
    TEST_ASSERT_EQUAL_STRING("a?b??[0m? \xC3\xA9 ?( ??? ?", message.text);
}

static void test_text_that_does_not_fit_is_cut_and_ends_in_dots(void)
{
    for (int i = 0; i < 100; i++) {
        mct_message_add(&message, "0123456789");
    }
    TEST_ASSERT_EQUAL_size_t(MCT_MESSAGE_SIZE - 1, strlen(message.text));
    TEST_ASSERT_EQUAL_STRING("567...", message.text + MCT_MESSAGE_SIZE - 1 - 6);
}

static void test_text_that_just_fits_is_not_cut(void)
{
    char text[MCT_MESSAGE_SIZE];
    memset(text, 'a', sizeof text - 1);
    text[sizeof text - 1] = '\0';
    mct_message_add(&message, text);
    TEST_ASSERT_EQUAL_STRING(text, message.text);
}

static void test_a_cut_message_takes_no_more(void)
{
    char before[MCT_MESSAGE_SIZE];
    for (int i = 0; i < MCT_MESSAGE_SIZE; i++) {
        mct_message_add(&message, "\xC3\xA9-"); /* so that the cut falls at different places of a character */
    }
    strcpy(before, message.text);
    mct_message_add(&message, "x");
    mct_message_add_number(&message, 1);
    TEST_ASSERT_EQUAL_STRING(before, message.text);
}

static void test_a_cut_does_not_split_a_character(void)
{
    for (int offset = 0; offset < 4; offset++) {
        mct_message_clear(&message);
        mct_message_add_span(&message, "abc", (size_t)offset);
        for (int i = 0; i < MCT_MESSAGE_SIZE / 4 + 1; i++) {
            mct_message_add(&message, "\xF0\x9F\x98\x80");
        }
        const size_t length = strlen(message.text);
        TEST_ASSERT_EQUAL_STRING("...", message.text + length - 3);
        TEST_ASSERT_EQUAL_size_t(0, (length - 3 - (size_t)offset) % 4);
    }
}

static void test_a_null_message_is_ignored(void)
{
    mct_message_clear(NULL);
    mct_message_add(NULL, "x");
    mct_message_add_number(NULL, 1);
    mct_message_add_integer(NULL, 1);
    mct_message_add(&message, NULL);
    TEST_ASSERT_EQUAL_STRING("", message.text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_cleared_message_is_empty);
    RUN_TEST(test_pieces_follow_each_other);
    RUN_TEST(test_integers_are_written_to_their_limits);
    RUN_TEST(test_numbers_are_short_where_they_can_be);
    RUN_TEST(test_control_characters_and_broken_utf8_are_shown_as_question_marks);
    RUN_TEST(test_text_that_does_not_fit_is_cut_and_ends_in_dots);
    RUN_TEST(test_text_that_just_fits_is_not_cut);
    RUN_TEST(test_a_cut_message_takes_no_more);
    RUN_TEST(test_a_cut_does_not_split_a_character);
    RUN_TEST(test_a_null_message_is_ignored);
    return UNITY_END();
}

/* Rules of the TOML reader that need no second implementation; tests/scene/test_toml.py holds it against
 * tomllib. */
#include "scene/toml.h"

#include <stdio.h>
#include <string.h>

#include "unity.h"

static mct_toml toml;
static mct_message why;

void setUp(void)
{
    memset(&toml, 0x5A, sizeof toml);
    mct_message_clear(&why);
}

void tearDown(void)
{
}

static mct_status read_text(const char *text)
{
    return mct_toml_read(text, strlen(text), "x.toml", &toml, &why);
}

static void assert_refused(const char *text, const char *message)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_ERROR_SYNTAX, read_text(text), text);
    TEST_ASSERT_EQUAL_STRING(message, why.text);
}

static void test_an_entry_knows_its_table_key_line_and_column(void)
{
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_text("# first\r\n[scene]\r\n\r\n  dt = 1e-3 # second\r\n"));
    TEST_ASSERT_EQUAL_INT(1, toml.entry_count);
    TEST_ASSERT_TRUE(mct_span_is(toml.entries[0].table, "scene"));
    TEST_ASSERT_TRUE(mct_span_is(toml.entries[0].key, "dt"));
    TEST_ASSERT_TRUE(mct_span_is(toml.entries[0].source, "1e-3"));
    TEST_ASSERT_EQUAL_INT(4, toml.entries[0].line);
    TEST_ASSERT_EQUAL_INT(3, toml.entries[0].column);
    TEST_ASSERT_EQUAL_DOUBLE(1e-3, toml.entries[0].number);
}

static void test_dotted_keys_stand_ahead_of_the_first_table(void)
{
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_text("scene . dt = 1\nscene.substeps = 2\n[input]\nvalue = 3"));
    TEST_ASSERT_EQUAL_INT(3, toml.entry_count);
    TEST_ASSERT_EQUAL_INT(2, toml.table_count);
    TEST_ASSERT_TRUE(mct_span_is(toml.entries[0].table, "scene"));
    TEST_ASSERT_TRUE(mct_span_is(toml.entries[0].key, "dt"));
    assert_refused("[scene]\na.b = 1",
                   "x.toml:2:1: a table within a table is TOML, but outside of the subset that scenes use");
    assert_refused("a.b.c = 1",
                   "x.toml:1:1: a table within a table is TOML, but outside of the subset that scenes use");
    assert_refused("scene.dt = 1\n[scene]\n",
                   "x.toml:2:2: 'scene' begins a second time; the first is in line 1");
}

static void test_a_byte_order_mark_is_skipped(void)
{
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_text("\xEF\xBB\xBF[scene]\n"));
    TEST_ASSERT_EQUAL_INT(1, toml.tables[0].line);
    TEST_ASSERT_EQUAL_INT(2, toml.tables[0].column);
}

static void test_texts_are_decoded(void)
{
    char text[64];
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          read_text("[t]\na = \"\\\"\\t\\u00e9\\U0001F600\"\nb = 'C:\\new'\nc = \"\""));
    TEST_ASSERT_EQUAL_size_t(8, mct_toml_text(&toml.entries[0], text, sizeof text));
    TEST_ASSERT_EQUAL_STRING("\"\t\xC3\xA9\xF0\x9F\x98\x80", text);
    mct_toml_text(&toml.entries[1], text, sizeof text);
    TEST_ASSERT_EQUAL_STRING("C:\\new", text);
    TEST_ASSERT_EQUAL_size_t(0, mct_toml_text(&toml.entries[2], text, sizeof text));
}

static void test_a_text_too_long_for_its_buffer_is_cut_and_says_its_length(void)
{
    char text[4];
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_text("[t]\na = 'abcdef'"));
    TEST_ASSERT_EQUAL_size_t(6, mct_toml_text(&toml.entries[0], text, sizeof text));
    TEST_ASSERT_EQUAL_STRING("abc", text);
}

static void test_lists_of_numbers_span_lines(void)
{
    size_t position = 0;
    mct_toml_entry item;
    TEST_ASSERT_EQUAL_INT(MCT_OK, read_text("[t]\na = [ 1, 2.5, # two\r\n\n -3e0\n,]\nb = []"));
    TEST_ASSERT_EQUAL_INT(3, toml.entries[0].count);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_TRUE(mct_toml_item(&toml.entries[0], &position, &item));
    }
    TEST_ASSERT_EQUAL_DOUBLE(-3, item.number);
    TEST_ASSERT_FALSE(mct_toml_item(&toml.entries[0], &position, &item));
    TEST_ASSERT_EQUAL_INT(0, toml.entries[1].count);
    position = 0;
    TEST_ASSERT_FALSE(mct_toml_item(&toml.entries[1], &position, &item));
}

static void test_what_toml_forbids_is_refused_with_place_and_reason(void)
{
    assert_refused("[a]\nb 1", "x.toml:2:3: 'b' is not followed by '='");
    assert_refused("[a]\nb =", "x.toml:2:4: 'b' has no value");
    assert_refused("[a]\nb = # 1", "x.toml:2:5: 'b' has no value");
    assert_refused("[a]\nb = 1 2", "x.toml:2:7: '2' stands behind what should end the line");
    assert_refused("[a]\nb = 1\nc = 2\nb = 3",
                   "x.toml:4:1: 'b' is given a second time; the first is in line 2");
    assert_refused("[a]\n[b]\n[a]", "x.toml:3:2: 'a' begins a second time; the first is in line 1");
    assert_refused("[a", "x.toml:1:3: the closing bracket of the table's name is missing");
    assert_refused("[]", "x.toml:1:2: the name of a table is missing (letters, digits, '_' and '-')");
    assert_refused("[a]\n= 1", "x.toml:2:1: a key is missing (letters, digits, '_' and '-')");
    assert_refused("[a]\nb = \"c", "x.toml:2:5: this text has no closing quote on its line");
    assert_refused("[a]\nb = [1, 2\n\n", "x.toml:2:5: this list has no closing bracket");
    assert_refused("[a]\nb = [1 2]", "x.toml:2:8: a comma or a closing bracket is missing in the list");
    assert_refused("[a]\nb = 01", "x.toml:2:5: '01': a decimal number has no leading zeros");
    assert_refused("[a]\n# \x01", "x.toml:2:3: a control character, U+0001");
    assert_refused("[a]\n# a\rb", "x.toml:2:4: a control character, U+000D");
    assert_refused("[a]\nb = '\xC0\x80'", "x.toml:2:6: these bytes are not UTF-8");
}

/* The ends of each range of first bytes and of those that they restrict (RFC 3629, section 4). */
static void test_text_is_utf_8_in_its_shortest_form_up_to_u_10ffff_without_surrogates(void)
{
    static const char *const good[] = {"\xC2\x80",     "\xDF\xBF",         "\xE0\xA0\x80",    "\xED\x9F\xBF",
                                       "\xEE\x80\x80", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"};
    static const char *const bad[] = {"\x80",
                                      "\xBF",
                                      "\xC1\xBF",
                                      "\xE0\x9F\xBF",
                                      "\xED\xA0\x80",
                                      "\xF0\x8F\xBF\xBF",
                                      "\xF4\x90\x80\x80",
                                      "\xF5\x80\x80\x80",
                                      "\xC2\x41",
                                      "\xE1\x80\x41",
                                      "\xF1\x80\x80",
                                      "\xFF"};
    char text[32];
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        snprintf(text, sizeof text, "[a]\nb = '%s'", good[i]);
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, read_text(text), why.text);
    }
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        snprintf(text, sizeof text, "[a]\nb = '%s'", bad[i]);
        assert_refused(text, "x.toml:2:6: these bytes are not UTF-8");
        snprintf(text, sizeof text, "[a]\n# %s", bad[i]); /* cut off by the end of the text */
        assert_refused(text, "x.toml:2:3: these bytes are not UTF-8");
    }
    static const char cut[] = "# \xE2\x82\xAC"; /* a character that goes on behind the end of the text */
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_toml_read(cut, 5, "x.toml", &toml, &why));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SYNTAX, mct_toml_read(cut, 4, "x.toml", &toml, &why));
}

static void test_what_is_outside_of_the_subset_is_called_that(void)
{
    static const char *const texts[] = {
        "[a]\nb = 1979-05-27",
        "[a]\nb = 07:32:00",
        "[a]\nb = 1979-05-27T07:32:00Z",
        "[a]\nb = {c = 1}",
        "[a]\nb = \"\"\"c\"\"\"",
        "[a]\nb = '''c'''",
        "[[a]]",
        "[a.b]",
        "[\"a\"]",
        "[a]\n\"b\" = 1",
        "[a]\nb = [[[1], [2]]]",
        "[a]\nb = [{}]",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        TEST_ASSERT_EQUAL_INT(MCT_ERROR_SYNTAX, read_text(texts[i]));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why.text, "is TOML, but outside of the subset"), why.text);
    }
}

static void test_more_than_storage_holds_is_refused_as_such(void)
{
    static char text[64 * (MCT_TOML_ENTRIES + 1)];
    size_t length = (size_t)sprintf(text, "[a]\n");
    for (int i = 0; i <= MCT_TOML_ENTRIES; i++) {
        length += (size_t)sprintf(text + length, "k%d = 1\n", i);
    }
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, read_text(text));
    length = 0;
    for (int i = 0; i <= MCT_TOML_TABLES; i++) {
        length += (size_t)sprintf(text + length, "[t%d]\n", i);
    }
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, read_text(text));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, mct_toml_read(text, MCT_TOML_LENGTH + 1, "x.toml", &toml, &why));
}

static void test_the_text_is_read_to_its_length_and_no_further(void)
{
    const char text[] = "[a]\nb = 12";
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_toml_read(text, sizeof text - 2, "x.toml", &toml, &why));
    TEST_ASSERT_EQUAL_DOUBLE(1, toml.entries[0].number);
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_toml_read(text, 0, "x.toml", &toml, &why));
    TEST_ASSERT_EQUAL_INT(0, toml.entry_count);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_entry_knows_its_table_key_line_and_column);
    RUN_TEST(test_dotted_keys_stand_ahead_of_the_first_table);
    RUN_TEST(test_a_byte_order_mark_is_skipped);
    RUN_TEST(test_texts_are_decoded);
    RUN_TEST(test_a_text_too_long_for_its_buffer_is_cut_and_says_its_length);
    RUN_TEST(test_lists_of_numbers_span_lines);
    RUN_TEST(test_what_toml_forbids_is_refused_with_place_and_reason);
    RUN_TEST(test_text_is_utf_8_in_its_shortest_form_up_to_u_10ffff_without_surrogates);
    RUN_TEST(test_what_is_outside_of_the_subset_is_called_that);
    RUN_TEST(test_more_than_storage_holds_is_refused_as_such);
    RUN_TEST(test_the_text_is_read_to_its_length_and_no_further);
    return UNITY_END();
}

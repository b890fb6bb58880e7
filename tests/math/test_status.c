/* The rules of include/mctau/status.h. */
#include <string.h>

#include "mctau/status.h"
#include "unity.h"

#define NUMBER(name, number, text) name,
static const mct_status all[] = {MCT_STATUS_LIST(NUMBER)};
enum { COUNT = sizeof all / sizeof *all };

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_only_success_is_zero_and_every_failure_is_negative(void)
{
    TEST_ASSERT_EQUAL_INT(0, MCT_OK);
    for (int i = 0; i < COUNT; i++) {
        TEST_ASSERT_TRUE(all[i] == MCT_OK || (int)all[i] < 0);
    }
}

static void test_every_status_has_a_number_and_a_sentence_of_its_own(void)
{
    for (int i = 0; i < COUNT; i++) {
        for (int j = 0; j < i; j++) {
            TEST_ASSERT_TRUE(all[i] != all[j]);
            TEST_ASSERT_TRUE(strcmp(mct_status_text(all[i]), mct_status_text(all[j])) != 0);
        }
    }
}

static void test_a_number_that_is_no_status_has_a_sentence_too(void)
{
    const char *const text = mct_status_text((mct_status)-1000);
    TEST_ASSERT_NOT_NULL(text);
    for (int i = 0; i < COUNT; i++) {
        TEST_ASSERT_TRUE(strcmp(text, mct_status_text(all[i])) != 0);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_only_success_is_zero_and_every_failure_is_negative);
    RUN_TEST(test_every_status_has_a_number_and_a_sentence_of_its_own);
    RUN_TEST(test_a_number_that_is_no_status_has_a_sentence_too);
    return UNITY_END();
}

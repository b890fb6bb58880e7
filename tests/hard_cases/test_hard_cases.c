/* Each hard case, by its rule: what a user gets meets the criterion, what is commonly done does not. */
#include <math.h>
#include <stdio.h>

#include "tools/hard/hard.h"
#include "unity.h"

static const hard_case *now; /* that is tested */
static hard_result results[HARD_METHOD_COUNT];

void setUp(void)
{
}

void tearDown(void)
{
}

static void the_naive_scheme_fails_and_the_library_does_not(void)
{
    const hard_result *library = &results[HARD_LIBRARY], *naive = &results[HARD_NAIVE];
    char figures[MCT_MESSAGE_SIZE + 128];
    snprintf(figures, sizeof figures, "%s: %.2g, allowed %.2g; naively %.2g; %s", now->measure,
             library->error, hard_criterion(now), naive->error, library->why.text);
    if (hard_criterion(now) > 0) {
        TEST_ASSERT_TRUE_MESSAGE(hard_is_well(now, hard_judge(now, library)), figures);
        TEST_ASSERT_TRUE_MESSAGE(naive->error > hard_criterion(now), figures);
    }
    TEST_ASSERT_FALSE_MESSAGE(naive->is_refused, figures);
}

static void every_method_tells_a_figure_or_why_there_is_none(void)
{
    for (int method = 0; method < HARD_METHOD_COUNT; method++) {
        const hard_result *one = &results[method];
        const char *name = method < MCT_STEPPER_COUNT ? mct_steppers[method].name : "not a stepper";
        TEST_ASSERT_TRUE_MESSAGE(one->error >= 0, name); /* no NaN */
        TEST_ASSERT_TRUE_MESSAGE(!one->is_refused || one->why.text[0] != '\0', name);
    }
}

static void test_no_two_cases_share_a_number_and_none_of_the_first_38_is_missing(void)
{
    int rows = 0, cases = 0, last = 0;
    for (int i = 0; hard_tables[i] != NULL; i++) {
        for (const hard_case *one = hard_tables[i]; one->rule != NULL; one++) {
            rows++;
        }
    }
    for (const hard_case *one = hard_case_after(0); one != NULL; one = hard_case_after(one->number)) {
        TEST_ASSERT_TRUE(one->number == last + 1 || last >= 38);
        last = one->number;
        cases++;
    }
    TEST_ASSERT_EQUAL_INT(rows, cases);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_no_two_cases_share_a_number_and_none_of_the_first_38_is_missing);
    for (now = hard_case_after(0); now != NULL; now = hard_case_after(now->number)) {
        char rest[64];
        hard_run_case(now, false, results);
        UnityDefaultTestRun(the_naive_scheme_fails_and_the_library_does_not, now->rule, __LINE__);
        snprintf(rest, sizeof rest, "case %d: every method tells a figure or why there is none", now->number);
        UnityDefaultTestRun(every_method_tells_a_figure_or_why_there_is_none, rest, __LINE__);
    }
    return UNITY_END();
}

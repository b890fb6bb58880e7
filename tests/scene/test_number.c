/* Rules of numbers as text: the bits are those of the C library's correctly rounded strtod and printf. */
#include "scene/number.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/random.h"
#include "unity.h"

static test_random draws;

void setUp(void)
{
    draws.state = 88172645463325252u;
}

void tearDown(void)
{
}

static double random_double(void)
{
    uint64_t bits = random_bits(&draws);
    double value;
    if (bits % 5 == 0) {
        bits &= 0x800FFFFFFFFFFFFFu; /* subnormal */
    }
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void assert_bits(double expected, double value, const char *text)
{
    uint64_t expected_bits;
    uint64_t value_bits;
    memcpy(&expected_bits, &expected, sizeof expected_bits);
    memcpy(&value_bits, &value, sizeof value_bits);
    TEST_ASSERT_EQUAL_HEX64_MESSAGE(expected_bits, value_bits, text);
}

static double read_number(const char *text)
{
    mct_number number;
    TEST_ASSERT_NULL_MESSAGE(mct_number_read(mct_text_span(text), &number), text);
    return number.value;
}

static void assert_as_strtod(const char *text)
{
    assert_bits(strtod(text, NULL), read_number(text), text);
}

static void test_seventeen_digits_give_the_double_back(void)
{
    for (int i = 0; i < TEST_CASES(20000); i++) {
        char text[64];
        const double value = random_double();
        if (isfinite(value)) {
            snprintf(text, sizeof text, "%.17e", value);
            assert_bits(value, read_number(text), text);
        }
    }
}

static void test_the_middle_of_two_doubles_rounds_to_even_and_its_neighbours_do_not(void)
{
    for (int i = 0; i < TEST_CASES(2000); i++) { /* odd integers of 54 bits */
        char text[64];
        const uint64_t odd = ((uint64_t)1 << 53) | (random_bits(&draws) >> 11) | 1;
        snprintf(text, sizeof text, "%llu.0", (unsigned long long)odd);
        assert_bits((double)(odd % 4 == 1 ? odd - 1 : odd + 1), read_number(text), text);
    }
#if LDBL_MANT_DIG > 53 /* else there is no type to hold the middle of any two */
    for (int i = 0; i < TEST_CASES(2000); i++) {
        char text[1400];
        double lower = fabs(random_double());
        if (!isfinite(lower)) {
            continue;
        }
        /* In long double the middle is exact, and printf shows it to its last digit. */
        const double upper = nextafter(lower, INFINITY);
        if (!isfinite(upper)) {
            continue;
        }
        const long double middle = ((long double)lower + (long double)upper) / 2;
        snprintf(text, sizeof text, "%.1100Le", middle);
        assert_as_strtod(text);
        char *const exponent = strchr(text, 'e');
        exponent[-1] = '1'; /* a hair more */
        assert_bits(upper, read_number(text), text);
    }
#endif
}

static void test_edges_of_the_range(void)
{
    static const char *const texts[] = {
        "0.0",
        "-0.0",
        "0e999999999999",
        "1e-999999999999999999999",
        "1e99999999999999999999",
        "4.9e-324",
        "2.4703282292062327e-324",
        "2.4703282292062328e-324",
        "2.2250738585072011e-308",
        "2.2250738585072014e-308",
        "1.7976931348623157e308",
        "1.7976931348623158e308",
        "1.7976931348623159e308",
        "179769313486231580793e289",
        "9007199254740993.0",
        "9007199254740992.5",
        "123456789012345678901234567890e-20",
        "1e22",
        "1e23",
        "8.5e22",
        "0.1e-6",
        "6.02214076e23",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        assert_as_strtod(texts[i]);
    }
}

static void test_digits_beyond_storage_still_decide(void)
{
    enum { ZEROS = 5000 };
    static char text[ZEROS + 64];
    /* 2^53 + 1 is a tie; a single digit thousands of places behind it breaks it. */
    strcpy(text, "9007199254740993.");
    const size_t start = strlen(text);
    memset(text + start, '0', ZEROS);
    text[start + ZEROS] = '\0';
    TEST_ASSERT_EQUAL_DOUBLE(9007199254740992.0, read_number(text));
    strcpy(text + start + ZEROS, "1");
    assert_bits(9007199254740994.0, read_number(text), "with a last digit");
    strcpy(text, "0.");
    memset(text + 2, '0', ZEROS);
    strcpy(text + 2 + ZEROS, "25e5000");
    assert_bits(0.25, read_number(text), "zeros and a large exponent");
}

static void test_integers_keep_all_their_bits(void)
{
    static const struct {
        const char *text;
        int64_t value;
    } cases[] = {
        {"0", 0},
        {"-0", 0},
        {"+7", 7},
        {"1_000", 1000},
        {"0xFf", 255},
        {"0o17", 15},
        {"0b1010_01", 41},
        {"9223372036854775807", INT64_MAX},
        {"-9223372036854775808", INT64_MIN},
        {"0x7FFFFFFFFFFFFFFF", INT64_MAX},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        mct_number number;
        TEST_ASSERT_NULL_MESSAGE(mct_number_read(mct_text_span(cases[i].text), &number), cases[i].text);
        TEST_ASSERT_TRUE(number.is_integer);
        TEST_ASSERT_TRUE_MESSAGE(number.integer == cases[i].value, cases[i].text);
        assert_bits((double)cases[i].value, number.value, cases[i].text);
    }
}

static void test_a_point_or_an_exponent_makes_a_real(void)
{
    mct_number number;
    TEST_ASSERT_NULL(mct_number_read(mct_text_span("2.0"), &number));
    TEST_ASSERT_FALSE(number.is_integer);
    TEST_ASSERT_NULL(mct_number_read(mct_text_span("2e0"), &number));
    TEST_ASSERT_FALSE(number.is_integer);
}

static void test_infinity_and_nan_are_read_as_what_they_are(void)
{
    TEST_ASSERT_TRUE(read_number("inf") > 0 && isinf(read_number("+inf")));
    TEST_ASSERT_TRUE(isinf(read_number("-inf")) && read_number("-inf") < 0);
    TEST_ASSERT_TRUE(isnan(read_number("nan")) && isnan(read_number("-nan")));
}

static void test_what_toml_forbids_is_refused_with_a_reason(void)
{
    static const char *const texts[] = {
        "",
        "+",
        "-",
        "01",
        "-00",
        "00.5",
        "1.",
        ".5",
        "1.e5",
        "1e",
        "1e+",
        "1__0",
        "_1",
        "1_",
        "1_.5",
        "1._5",
        "1e_5",
        "1e5_",
        "+0x1",
        "-0b1",
        "0x",
        "0x_1",
        "0X1",
        "0b2",
        "0o8",
        "1.5.2",
        "1e5.0",
        "Inf",
        "NaN",
        "infinity",
        "1f",
        "0x1p3",
        "--1",
        "+-1",
        "1,0",
        "0x1.0",
        "9223372036854775808",
        "-9223372036854775809",
        "0x8000000000000000",
        "nan0",
        "in",
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        mct_number number;
        TEST_ASSERT_NOT_NULL_MESSAGE(mct_number_read(mct_text_span(texts[i]), &number), texts[i]);
    }
}

static void test_numbers_are_written_as_nine_digits_of_printf(void)
{
    for (int i = 0; i < TEST_CASES(20000); i++) {
        char expected[64];
        char written[MCT_NUMBER_TEXT];
        double value = random_double();
        if (i % 4 == 1) {
            value = (double)(int64_t)(random_bits(&draws) >> 20) / 1024; /* with ties */
        } else if (i % 4 == 2) {
            value = ldexp(i % 8 == 2 ? 1 : 0x1.fffffffffffffp0, i % 2098 - 1074); /* about powers of two */
        } else if (i % 4 == 3) {
            value = (double)(random_bits(&draws) % 1000000) *
                    pow(10, (double)(i % 30) - 20); /* about powers of ten */
        }
        if (!isnan(value)) {
            snprintf(expected, sizeof expected, "%.9g", value);
            mct_number_write(value, written);
            TEST_ASSERT_EQUAL_STRING(value == 0 ? (signbit(value) ? "-0" : "0") : expected, written);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_seventeen_digits_give_the_double_back);
    RUN_TEST(test_the_middle_of_two_doubles_rounds_to_even_and_its_neighbours_do_not);
    RUN_TEST(test_edges_of_the_range);
    RUN_TEST(test_digits_beyond_storage_still_decide);
    RUN_TEST(test_integers_keep_all_their_bits);
    RUN_TEST(test_a_point_or_an_exponent_makes_a_real);
    RUN_TEST(test_infinity_and_nan_are_read_as_what_they_are);
    RUN_TEST(test_what_toml_forbids_is_refused_with_a_reason);
    RUN_TEST(test_numbers_are_written_as_nine_digits_of_printf);
    return UNITY_END();
}

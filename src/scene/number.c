#include "number.h"

#include <string.h>

#include "mctau/real.h"

/* --- big integers: little-endian words, as many as the largest shifted operand of a comparison needs --- */

/* D < 10^781 (2595 bits), 5^1105 times a significand (2620 bits), either shifted by at most 2080 bits: below
 * 5120. */
enum { WORDS = 160 };

typedef struct {
    int count; /* words in use; the last is not zero */
    uint32_t words[WORDS];
} big;

static void big_set(big *self, uint64_t value)
{
    self->words[0] = (uint32_t)value;
    self->words[1] = (uint32_t)(value >> 32);
    self->count = self->words[1] != 0 ? 2 : self->words[0] != 0 ? 1 : 0;
}

static void big_multiply_add(big *self, uint32_t factor, uint32_t term)
{
    uint64_t carry = term;
    for (int i = 0; i < self->count; i++) {
        carry += (uint64_t)self->words[i] * factor;
        self->words[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry != 0 && self->count < WORDS) {
        self->words[self->count++] = (uint32_t)carry;
    }
}

static void big_multiply_power(big *self, uint32_t base, int exponent)
{
    for (int i = 0; i < exponent; i++) {
        big_multiply_add(self, base, 0);
    }
}

/* out = self * factor * 2^shift */
static void big_scale(const big *self, uint64_t factor, int shift, big *out)
{
    const int words = shift / 32;
    const int bits = shift % 32;
    const uint32_t low = (uint32_t)factor;
    const uint32_t high = (uint32_t)(factor >> 32);
    memset(out->words, 0, sizeof out->words);
    uint64_t carry = 0;
    uint32_t previous = 0;
    int place = words;
    /* The factor's halves come one word apart; the carry stays below 2^34. */
    for (int i = 0; i < self->count + 2 && place < WORDS; i++) {
        const uint32_t word = i < self->count ? self->words[i] : 0;
        const uint64_t lower = (uint64_t)word * low;
        const uint64_t upper = (uint64_t)previous * high;
        const uint64_t sum = (lower & 0xFFFFFFFFu) + (upper & 0xFFFFFFFFu) + carry;
        out->words[place++] = (uint32_t)sum;
        carry = (sum >> 32) + (lower >> 32) + (upper >> 32);
        previous = word;
    }
    if (bits > 0) {
        uint32_t spill = 0;
        for (int i = words; i < WORDS; i++) {
            const uint32_t word = out->words[i];
            out->words[i] = (word << bits) | spill;
            spill = word >> (32 - bits);
        }
    }
    out->count = WORDS;
    while (out->count > 0 && out->words[out->count - 1] == 0) {
        out->count--;
    }
}

static int big_compare(const big *a, const big *b)
{
    if (a->count != b->count) {
        return a->count < b->count ? -1 : 1;
    }
    for (int i = a->count - 1; i >= 0; i--) {
        if (a->words[i] != b->words[i]) {
            return a->words[i] < b->words[i] ? -1 : 1;
        }
    }
    return 0;
}

/* a -= b, for a >= b */
static void big_subtract(big *a, const big *b)
{
    uint64_t borrow = 0;
    for (int i = 0; i < a->count; i++) {
        const uint64_t difference = (uint64_t)a->words[i] - (i < b->count ? b->words[i] : 0) - borrow;
        a->words[i] = (uint32_t)difference;
        borrow = difference >> 63;
    }
    while (a->count > 0 && a->words[a->count - 1] == 0) {
        a->count--;
    }
}

/* --- doubles as bits --- */

static const uint64_t infinity_bits = (uint64_t)0x7FF << 52;

static double double_of_bits(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint64_t bits_of_double(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* A finite double is significand * 2^exponent. */
static uint64_t significand_of(uint64_t bits, int *exponent)
{
    const uint64_t fraction = bits & (((uint64_t)1 << 52) - 1);
    const int biased = (int)(bits >> 52) & 0x7FF;
    *exponent = (biased > 0 ? biased : 1) - 1075;
    return biased > 0 ? fraction | ((uint64_t)1 << 52) : fraction;
}

/* --- text to double --- */

/* The exact middle of two doubles has at most 768 significant digits, so of what follows only "zero or not"
 * matters. */
enum { DIGITS = 780 };

typedef struct {
    int count;
    int64_t exponent; /* value = 0.d1 d2 ... * 10^exponent */
    bool more;        /* digits other than zero follow */
    unsigned char digits[DIGITS];
} decimal;

static double round_decimal(const decimal *d)
{
    if (d->count == 0 || d->exponent < -323) {
        return 0;
    }
    if (d->exponent > 309) {
        return double_of_bits(infinity_bits);
    }
    const int power = (int)d->exponent - d->count; /* value = digits * 10^power */
    if (d->count <= 15 && power >= -22 && power <= 22) {
        int64_t digits = 0;
        int64_t high = 1; /* 10^|power| = high * low; both products are exact */
        int64_t low = 1;
        for (int i = 0; i < d->count; i++) {
            digits = 10 * digits + d->digits[i];
        }
        const int size = power < 0 ? -power : power;
        for (int i = 0; i < size; i++) {
            *(i < 11 ? &high : &low) *= 10;
        }
        const double scale = (double)high * (double)low;
        return power < 0 ? (double)digits / scale : (double)digits * scale;
    }

    /* value = left * 2^power / right, with the powers of five in left or right */
    big left;
    big right;
    big scaled;
    big_set(&left, 0);
    big_set(&right, 1);
    for (int i = 0; i < d->count; i++) {
        big_multiply_add(&left, 10, d->digits[i]);
    }
    int shift = power;
    if (d->more) { /* anything strictly between two multiples of the last digit decides alike */
        big_multiply_add(&left, 10, 1);
        shift--;
    }
    big_multiply_power(&left, 5, shift > 0 ? shift : 0);
    big_multiply_power(&right, 5, shift < 0 ? -shift : 0);

    /* The smallest double whose upper middle is above the value (or on it, when ties go down: to even). */
    uint64_t from = 0;
    uint64_t to = infinity_bits;
    for (int i = 0; i < 64 && from < to; i++) {
        const uint64_t bits = from + (to - from) / 2;
        int exponent;
        const uint64_t significand = significand_of(bits, &exponent);
        const uint64_t middle = 2 * significand + 1; /* times 2^(exponent - 1) */
        const int difference = shift - (exponent - 1);
        int order;
        if (difference >= 0) {
            big raised;
            big_scale(&left, 1, difference, &raised);
            big_scale(&right, middle, 0, &scaled);
            order = big_compare(&raised, &scaled);
        } else {
            big_scale(&right, middle, -difference, &scaled);
            order = big_compare(&left, &scaled);
        }
        if (order < 0 || (order == 0 && significand % 2 == 0)) {
            to = bits;
        } else {
            from = bits + 1;
        }
    }
    return double_of_bits(from);
}

static void decimal_add(decimal *d, int digit)
{
    if (d->count == 0 && digit == 0) {
        return;
    }
    if (d->count < DIGITS) {
        d->digits[d->count++] = (unsigned char)digit;
    } else if (digit != 0) {
        d->more = true;
    }
}

static const char not_a_number[] = "not a number, true, false, a text in quotes or a list";
static const char bad_underscore[] = "an underscore in a number must stand between two digits";

static int digit_value(char c)
{
    return mct_is_digit(c)        ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : 99;
}

/* End of the digits that begin at `position`; sets `fault` when there is none or an underscore is out of
 * place. */
static size_t skip_digits(mct_span text, size_t position, int base, const char *none, const char **fault)
{
    const size_t start = position;
    while (position < text.length) {
        const char c = text.start[position];
        if (digit_value(c) < base) {
            position++;
        } else if (c == '_') {
            const bool after = position > start && text.start[position - 1] != '_';
            const bool before = position + 1 < text.length && digit_value(text.start[position + 1]) < base;
            if (!after || !before) {
                *fault = bad_underscore;
                return position;
            }
            position++;
        } else {
            break;
        }
    }
    if (position == start) {
        *fault = none;
    }
    return position;
}

/* Digits from `start` to `end`, underscores left out; false when they do not fit into 64 bits with a sign. */
static bool read_integer(mct_span text, size_t start, size_t end, int base, bool negative, int64_t *integer)
{
    const uint64_t limit = (uint64_t)INT64_MAX + (negative ? 1 : 0);
    uint64_t value = 0;
    for (size_t i = start; i < end; i++) {
        if (text.start[i] == '_') {
            continue;
        }
        const uint64_t digit = (uint64_t)digit_value(text.start[i]);
        if (value > (limit - digit) / (uint64_t)base) {
            return false;
        }
        value = value * (uint64_t)base + digit;
    }
    *integer = negative ? (value > 0 ? -(int64_t)(value - 1) - 1 : 0) : (int64_t)value;
    return true;
}

const char *mct_number_read(mct_span text, mct_number *number)
{
    const bool has_sign = text.length > 0 && (text.start[0] == '+' || text.start[0] == '-');
    const bool negative = has_sign && text.start[0] == '-';
    const size_t start = has_sign ? 1 : 0;
    const mct_span unsigned_text = {text.start + start, text.length - start};
    const char *fault = NULL;

    number->is_integer = false;
    number->integer = 0;
    if (mct_span_is(unsigned_text, "inf") || mct_span_is(unsigned_text, "nan")) {
        const uint64_t quiet = unsigned_text.start[0] == 'n' ? (uint64_t)1 << 51 : 0;
        number->value = double_of_bits(infinity_bits | quiet | (uint64_t)negative << 63);
        return NULL;
    }
    if (unsigned_text.length == 0 ||
        (!mct_is_digit(unsigned_text.start[0]) && unsigned_text.start[0] != '.')) {
        return not_a_number;
    }

    const char prefix =
        unsigned_text.length > 1 && unsigned_text.start[0] == '0' ? unsigned_text.start[1] : '\0';
    const int base = prefix == 'x' ? 16 : prefix == 'o' ? 8 : prefix == 'b' ? 2 : 10;
    if (base != 10) {
        if (has_sign) {
            return "a hexadecimal, octal or binary number has no sign";
        }
        const size_t end = skip_digits(text, 2, base, "digits are missing", &fault);
        if (fault != NULL || end != text.length) {
            return fault != NULL ? fault : not_a_number;
        }
        number->is_integer = true;
        if (!read_integer(text, 2, end, base, false, &number->integer)) {
            return "an integer beyond 64 bits";
        }
        number->value = (double)number->integer;
        return NULL;
    }

    const size_t whole_end = skip_digits(text, start, 10, "a point needs a digit on either side", &fault);
    if (fault != NULL) {
        return fault;
    }
    if (text.start[start] == '0' && whole_end > start + 1) {
        return "a decimal number has no leading zeros";
    }
    if (whole_end == text.length) {
        number->is_integer = true;
        if (!read_integer(text, start, whole_end, 10, negative, &number->integer)) {
            return "an integer beyond 64 bits";
        }
        number->value = (double)number->integer;
        return NULL;
    }

    size_t fraction_end = whole_end;
    if (text.start[whole_end] == '.') {
        fraction_end = skip_digits(text, whole_end + 1, 10, "a point needs a digit on either side", &fault);
        if (fault != NULL) {
            return fault;
        }
    }
    size_t end = fraction_end;
    int64_t exponent = 0;
    if (end < text.length && (text.start[end] == 'e' || text.start[end] == 'E')) {
        const bool signed_exponent =
            end + 1 < text.length && (text.start[end + 1] == '+' || text.start[end + 1] == '-');
        const bool negative_exponent = signed_exponent && text.start[end + 1] == '-';
        const size_t exponent_start = end + (signed_exponent ? 2 : 1);
        end = skip_digits(text, exponent_start, 10, "an exponent needs digits", &fault);
        if (fault != NULL) {
            return fault;
        }
        for (size_t i = exponent_start; i < end; i++) {
            if (text.start[i] != '_' && exponent < INT64_MAX / 100) {
                exponent = 10 * exponent + (text.start[i] - '0');
            }
        }
        exponent = negative_exponent ? -exponent : exponent;
    }
    if (end != text.length) {
        return not_a_number;
    }

    decimal d;
    d.count = 0;
    d.exponent = 0;
    d.more = false;
    for (size_t i = start; i < fraction_end; i++) {
        const char c = text.start[i];
        if (mct_is_digit(c)) {
            decimal_add(&d, c - '0');
            /* Digits before the point raise the magnitude, zeros just behind it lower it. */
            if (i < whole_end) {
                d.exponent += d.count > 0 ? 1 : 0;
            } else {
                d.exponent -= d.count == 0 ? 1 : 0;
            }
        }
    }
    while (!d.more && d.count > 0 && d.digits[d.count - 1] == 0) {
        d.count--;
    }
    d.exponent += exponent;
    const double magnitude = round_decimal(&d);
    number->value = negative ? -magnitude : magnitude;
    return NULL;
}

/* --- double to text --- */

/* value * 10^(DIGITS - 1 - power), rounded half to even: `power` is floor(log10(value)) when it has
 * MCT_NUMBER_DIGITS digits. */
static uint64_t scaled_digits(uint64_t significand, int exponent, int power)
{
    const int scale = MCT_NUMBER_DIGITS - 1 - power;
    big numerator;
    big denominator;
    big scratch;
    big_set(&scratch, significand);
    big_multiply_power(&scratch, 10, scale > 0 ? scale : 0);
    big_scale(&scratch, 1, exponent > 0 ? exponent : 0, &numerator);
    big_set(&scratch, 1);
    big_multiply_power(&scratch, 10, scale < 0 ? -scale : 0);
    big_scale(&scratch, 1, exponent < 0 ? -exponent : 0, &denominator);

    uint64_t quotient = 0; /* below 10^10 when `power` is one too small */
    for (int bit = 33; bit >= 0; bit--) {
        big_scale(&denominator, 1, bit, &scratch);
        if (big_compare(&numerator, &scratch) >= 0) {
            big_subtract(&numerator, &scratch);
            quotient |= (uint64_t)1 << bit;
        }
    }
    big_scale(&numerator, 2, 0, &scratch);
    const int order = big_compare(&scratch, &denominator);
    return quotient + (order > 0 || (order == 0 && quotient % 2 == 1) ? 1 : 0);
}

static void append(char *text, size_t *length, char c)
{
    text[(*length)++] = c;
}

void mct_number_write(double value, char text[MCT_NUMBER_TEXT])
{
    const uint64_t bits = bits_of_double(value);
    const uint64_t magnitude = bits & ~((uint64_t)1 << 63);
    size_t length = 0;
    if (bits != magnitude && magnitude <= infinity_bits) {
        append(text, &length, '-');
    }
    if (magnitude >= infinity_bits || magnitude == 0) {
        const char *word = magnitude == 0 ? "0" : magnitude == infinity_bits ? "inf" : "nan";
        const size_t size = mct_text_length(word) + 1;
        memcpy(text + length, word, size);
        return;
    }

    int exponent;
    const uint64_t significand = significand_of(magnitude, &exponent);
    int top = 0;
    while (significand >> top > 1) {
        top++;
    }
    /* floor(log10) from the binary exponent, at most one too small: log10(2) = 0.30103 */
    const int binary = top + exponent;
    int power = (binary >= 0 ? binary * 30103 : binary * 30103 - 99999) / 100000;
    uint64_t digits = scaled_digits(significand, exponent, power);
    if (digits >= 1000000000) {
        power++;
        digits = scaled_digits(significand, exponent, power);
    }
    int count = MCT_NUMBER_DIGITS;
    while (count > 1 && digits % 10 == 0) {
        digits /= 10;
        count--;
    }
    char decimals[MCT_NUMBER_DIGITS];
    for (int i = count - 1; i >= 0; i--) {
        decimals[i] = (char)('0' + (int)(digits % 10));
        digits /= 10;
    }

    const bool scientific = power < -4 || power >= MCT_NUMBER_DIGITS;
    const int point = scientific ? 1 : power + 1; /* digits before the point */
    for (int i = point < 1 ? point - 1 : 0; i < count || i < point; i++) {
        if (i == point && i > 0) {
            append(text, &length, '.');
        }
        append(text, &length, i >= 0 && i < count ? decimals[i] : '0');
        if (i < 0 && i == point - 1) {
            append(text, &length, '.');
        }
    }
    if (scientific) {
        const int size = power < 0 ? -power : power;
        append(text, &length, 'e');
        append(text, &length, power < 0 ? '-' : '+');
        if (size >= 100) {
            append(text, &length, (char)('0' + size / 100));
        }
        append(text, &length, (char)('0' + size / 10 % 10));
        append(text, &length, (char)('0' + size % 10));
    }
    text[length] = '\0';
}

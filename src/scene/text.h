/* Spans of text, without the C library. */
#ifndef MCT_SCENE_TEXT_H
#define MCT_SCENE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

/* A piece of somebody else's text; does not end in NUL. */
typedef struct {
    const char *start;
    size_t length;
} mct_span;

static inline size_t mct_text_length(const char *text)
{
    size_t length = 0;
    while (text[length] != '\0') {
        length++;
    }
    return length;
}

static inline mct_span mct_text_span(const char *text)
{
    const mct_span span = {text, mct_text_length(text)};
    return span;
}

static inline bool mct_span_equal(mct_span a, mct_span b)
{
    if (a.length != b.length) {
        return false;
    }
    for (size_t i = 0; i < a.length; i++) {
        if (a.start[i] != b.start[i]) {
            return false;
        }
    }
    return true;
}

static inline bool mct_span_is(mct_span span, const char *text)
{
    return mct_span_equal(span, mct_text_span(text));
}

static inline bool mct_text_equal(const char *a, const char *b)
{
    return mct_span_equal(mct_text_span(a), mct_text_span(b));
}

static inline bool mct_is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Bytes of the UTF-8 character at the start; 0 when it is not valid (overlong, a surrogate, beyond U+10FFFF,
 * cut off). */
static inline size_t mct_utf8_length(const char *text, size_t length)
{
    const unsigned char first = length > 0 ? (unsigned char)text[0] : 0xFF;
    if (first < 0x80) {
        return 1;
    }
    const size_t size = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
    if (size == 0 || size > length) {
        return 0;
    }
    for (size_t i = 1; i < size; i++) {
        if (((unsigned char)text[i] & 0xC0) != 0x80) {
            return 0;
        }
    }
    const unsigned char second = (unsigned char)text[1];
    const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
    const bool surrogate = first == 0xED && second >= 0xA0;
    const bool too_large = first == 0xF4 && second >= 0x90;
    return overlong || surrogate || too_large ? 0 : size;
}

#endif

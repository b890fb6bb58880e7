#include "mctau/message.h"

#include <string.h>

#include "number.h"
#include "text.h"

static const char ellipsis[] = "...";

/* Where a cut text ends: room is left for the ellipsis and the NUL. */
enum { ROOM = MCT_MESSAGE_SIZE - 1, CUT = ROOM - 3 };

static size_t length_of(const mct_message *message)
{
    size_t length = 0;
    while (length < ROOM && message->text[length] != '\0') {
        length++;
    }
    return length;
}

static bool is_cut(const mct_message *message, size_t length)
{
    /* cppcheck-suppress pointerOutOfBoundsCond; length_of ends at ROOM */
    return length >= CUT && mct_text_equal(message->text + length - 3, ellipsis);
}

/* Adds one character of `size` bytes; false when the text is full. */
static bool add_character(mct_message *message, size_t *length, const char *character, size_t size)
{
    if (*length + size <= ROOM) {
        memcpy(message->text + *length, character, size);
        *length += size;
        message->text[*length] = '\0';
        return true;
    }
    size_t end = CUT;
    while (((unsigned char)message->text[end] & 0xC0) == 0x80) {
        end--; /* not through the middle of a character */
    }
    memcpy(message->text + end, ellipsis, sizeof ellipsis);
    return false;
}

void mct_message_clear(mct_message *message)
{
    if (message != NULL) {
        message->text[0] = '\0';
    }
}

void mct_message_add_span(mct_message *message, const char *text, size_t length)
{
    if (message == NULL || text == NULL) {
        return;
    }
    size_t end = length_of(message);
    if (is_cut(message, end)) {
        return;
    }
    bool room = true;
    for (size_t i = 0; i < length && text[i] != '\0' && room;) {
        const size_t size = mct_utf8_length(text + i, length - i);
        const unsigned char first = (unsigned char)text[i];
        const bool shown = size > 1 || (size == 1 && first >= 0x20 && first != 0x7F);
        room = add_character(message, &end, shown ? text + i : "?", shown ? size : 1);
        i += size > 0 ? size : 1;
    }
}

void mct_message_add(mct_message *message, const char *text)
{
    if (text != NULL) {
        mct_message_add_span(message, text, mct_text_length(text));
    }
}

void mct_message_add_integer(mct_message *message, long long value)
{
    char digits[24];
    size_t start = sizeof digits;
    unsigned long long rest = value < 0 ? 0ULL - (unsigned long long)value : (unsigned long long)value;
    do {
        digits[--start] = (char)('0' + (int)(rest % 10));
        rest /= 10;
    } while (rest > 0);
    if (value < 0) {
        digits[--start] = '-';
    }
    mct_message_add_span(message, digits + start, sizeof digits - start);
}

void mct_message_add_number(mct_message *message, double value)
{
    char text[MCT_NUMBER_TEXT];
    mct_number_write(value, text);
    mct_message_add(message, text);
}

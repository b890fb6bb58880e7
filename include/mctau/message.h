/**
 * @file message.h
 * A sentence of bounded length, put together without stdio: what went wrong, where, what was found, what is
 * allowed. Text that does not fit is cut and ends in "...". Control characters and bytes that are not UTF-8
 * are shown as '?', so that whatever a file contained, a message is one line of valid text.
 *
 * A NULL message is ignored: who does not want to know why passes NULL. Cost: linear in the text; a number
 * takes some 20 us and 3 kB of stack. Thread-safe on different messages.
 */
#ifndef MCTAU_MESSAGE_H
#define MCTAU_MESSAGE_H

#include <stddef.h>

#define MCT_MESSAGE_SIZE 512

typedef struct mct_message {
    char text[MCT_MESSAGE_SIZE]; /**< NUL-terminated */
} mct_message;

void mct_message_clear(mct_message *message);
void mct_message_add(mct_message *message, const char *text);
/** Adds at most `length` bytes of a text that need not end in NUL; stops at a NUL. */
void mct_message_add_span(mct_message *message, const char *text, size_t length);
void mct_message_add_integer(mct_message *message, long long value);
/** Adds a number, rounded to 9 significant digits, as C's "%.9g" does ("0.001", "2.5e-06", "nan", "-inf"). */
void mct_message_add_number(mct_message *message, double value);

#endif

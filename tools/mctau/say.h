/* What the command says on stderr, and with which code it ends. */
#ifndef MCTAU_TOOLS_SAY_H
#define MCTAU_TOOLS_SAY_H

#include "mctau/message.h"
#include "mctau/status.h"

enum { EXIT_WELL = 0, EXIT_CHECK_FAILED = 1, EXIT_USAGE = 2, EXIT_IO = 3, EXIT_SIGNAL = 128 };

/* Prints "mctau: " and a sentence on stderr; returns the exit code, so that a caller can end with it. */
int say(int exit_code, const char *format, ...)
#if defined __GNUC__
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/* The same for what the library has answered; a status without a sentence gets its own. */
int say_status(mct_status status, const mct_message *why);

/* Ends the program when memory has run out: exit code 3. */
void *need_memory(void *memory);

#endif

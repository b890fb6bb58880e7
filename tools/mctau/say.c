#include "say.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

int say(int exit_code, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fflush(stdout);
    fputs("mctau: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    return exit_code;
}

int say_status(mct_status status, const mct_message *why)
{
    const int exit_code = status == MCT_ERROR_IO ? EXIT_IO : EXIT_USAGE;
    return say(exit_code, "%s", why->text[0] != '\0' ? why->text : mct_status_text(status));
}

void *need_memory(void *memory)
{
    if (memory == NULL) {
        exit(say(EXIT_IO, "out of memory"));
    }
    return memory;
}

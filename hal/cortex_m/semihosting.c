#include "semihosting.h"

#include <string.h>

#include "start.h"

enum {
    SYS_OPEN = 0x01,
    SYS_CLOSE = 0x02,
    SYS_WRITE0 = 0x04,
    SYS_READ = 0x06,
    SYS_GET_CMDLINE = 0x15,
    SYS_EXIT_EXTENDED = 0x20
};
enum { MODE_READ_BINARY = 1, APPLICATION_EXIT = 0x20026 };

static int32_t call(int32_t operation, const void *argument)
{
    register int32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

void mct_semihosting_write(const char *text)
{
    (void)call(SYS_WRITE0, text);
}

int mct_semihosting_command_line(char *text, size_t size)
{
    const uintptr_t block[2] = {(uintptr_t)text, size};
    return (int)call(SYS_GET_CMDLINE, block);
}

int32_t mct_semihosting_read_file(const char *path, void *data, size_t size)
{
    const uintptr_t name[3] = {(uintptr_t)path, MODE_READ_BINARY, strlen(path)};
    const int32_t file = call(SYS_OPEN, name);
    if (file == -1) {
        return -1;
    }
    const uintptr_t block[3] = {(uintptr_t)file, (uintptr_t)data, size};
    const int32_t left = call(SYS_READ, block); /* how much could not be read */
    (void)call(SYS_CLOSE, &block[0]);
    return left < 0 || (uint32_t)left > size ? -1 : (int32_t)size - left;
}

void mct_semihosting_exit(int code)
{
    const uintptr_t block[2] = {APPLICATION_EXIT, (uintptr_t)code};
    for (;;) {
        (void)call(SYS_EXIT_EXTENDED, block);
    }
}

void mct_image_end(const char *said, int code)
{
    if (said != NULL) {
        mct_semihosting_write(said);
    }
    mct_semihosting_exit(code);
}

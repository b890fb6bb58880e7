#include "semihosting.h"

#include "start.h"

enum {
    SYS_OPEN = 0x01,
    SYS_CLOSE = 0x02,
    SYS_WRITE0 = 0x04,
    SYS_WRITE = 0x05,
    SYS_READ = 0x06,
    SYS_GET_CMDLINE = 0x15,
    SYS_EXIT_EXTENDED = 0x20
};
enum { MODE_READ_BINARY = 1, MODE_WRITE_BINARY = 5, APPLICATION_EXIT = 0x20026 };

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

int32_t mct_semihosting_open(const char *path, bool writes)
{
    size_t length = 0;
    while (path[length] != '\0') { /* newlib's strlen is 200 bytes */
        length++;
    }
    const uintptr_t block[3] = {(uintptr_t)path, writes ? MODE_WRITE_BINARY : MODE_READ_BINARY, length};
    return call(SYS_OPEN, block);
}

/* Reads or writes; returns how much of it has not come about. */
static uint32_t left_of(int32_t operation, int32_t file, const void *data, size_t size)
{
    const uintptr_t block[3] = {(uintptr_t)file, (uintptr_t)data, size};
    return (uint32_t)call(operation, block);
}

int32_t mct_semihosting_read(int32_t file, void *data, size_t size)
{
    const uint32_t left = left_of(SYS_READ, file, data, size);
    return left > size ? -1 : (int32_t)(size - left);
}

bool mct_semihosting_append(int32_t file, const void *data, size_t size)
{
    return left_of(SYS_WRITE, file, data, size) == 0;
}

bool mct_semihosting_close(int32_t file)
{
    const uintptr_t block[1] = {(uintptr_t)file};
    return call(SYS_CLOSE, block) == 0;
}

int32_t mct_semihosting_read_file(const char *path, void *data, size_t size)
{
    const int32_t file = mct_semihosting_open(path, false);
    if (file == -1) {
        return -1;
    }
    const int32_t read = mct_semihosting_read(file, data, size);
    (void)mct_semihosting_close(file);
    return read;
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

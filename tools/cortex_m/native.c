/*
 * The semihosting calls of count.c on the host, where it shows the hashes of the same runs without an
 * emulator. The environment names the job's file: COUNT_JOB.
 */
#include <stdio.h>
#include <stdlib.h>

#include "hal/cortex_m/semihosting.h"

void mct_semihosting_write(const char *text)
{
    fputs(text, stdout);
}

int mct_semihosting_command_line(char *text, size_t size)
{
    const char *job = getenv("COUNT_JOB");
    const int length = snprintf(text, size, "count %s", job != NULL ? job : "");
    return length < 0 || (size_t)length >= size ? -1 : 0;
}

int32_t mct_semihosting_read_file(const char *path, void *data, size_t size)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return -1;
    }
    const size_t read = fread(data, 1, size, file);
    fclose(file);
    return (int32_t)read;
}

void mct_semihosting_exit(int code)
{
    exit(code);
}

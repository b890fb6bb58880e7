/*
 * The semihosting calls on the host, so that an image's program runs here as it does there. The environment has its
 * command line: IMAGE_ARGUMENTS.
 */
#include <stdio.h>
#include <stdlib.h>

#include "hal/cortex_m/semihosting.h"

enum { MOST_FILES = 8 };

/* By number, since a pointer may be longer than that. */
static FILE *files[MOST_FILES];

void mct_semihosting_write(const char *text)
{
    fputs(text, stdout);
}

int mct_semihosting_command_line(char *text, size_t size)
{
    const char *arguments = getenv("IMAGE_ARGUMENTS");
    const int length = snprintf(text, size, "image %s", arguments != NULL ? arguments : "");
    return length < 0 || (size_t)length >= size ? -1 : 0;
}

int32_t mct_semihosting_open(const char *path, bool writes)
{
    for (int32_t i = 0; i < MOST_FILES; i++) {
        if (files[i] == NULL) {
            files[i] = fopen(path, writes ? "wb" : "rb");
            return files[i] != NULL ? i : -1;
        }
    }
    return -1;
}

int32_t mct_semihosting_read(int32_t file, void *data, size_t size)
{
    return (int32_t)fread(data, 1, size, files[file]);
}

bool mct_semihosting_append(int32_t file, const void *data, size_t size)
{
    return fwrite(data, 1, size, files[file]) == size;
}

bool mct_semihosting_close(int32_t file)
{
    FILE *const closed = files[file];
    files[file] = NULL;
    return fclose(closed) == 0;
}

int32_t mct_semihosting_read_file(const char *path, void *data, size_t size)
{
    const int32_t file = mct_semihosting_open(path, false);
    if (file < 0) {
        return -1;
    }
    const int32_t read = mct_semihosting_read(file, data, size);
    (void)mct_semihosting_close(file);
    return read;
}

void mct_semihosting_exit(int code)
{
    exit(code);
}

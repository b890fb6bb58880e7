#include "csv_output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "say.h"

static mct_status refuse(const char *path, int reason, mct_message *why)
{
    mct_message_clear(why);
    mct_message_add(why, path);
    mct_message_add(why, ": the file cannot be written: ");
    mct_message_add(why, strerror(reason));
    return MCT_ERROR_IO;
}

/* Name of the file until it is complete: in the same folder, so that renaming is one step. */
static char *temporary_name(const char *path)
{
    const size_t size = strlen(path) + 32;
    char *name = need_memory(malloc(size));
    snprintf(name, size, "%s.%ld.tmp", path, (long)getpid());
    return name;
}

mct_status csv_output_open(csv_output *self, const char *path, mct_message *why)
{
    struct stat there;
    memset(self, 0, sizeof *self);
    self->path = path;
    if (strcmp(path, "-") == 0) {
        self->file = STDOUT_FILENO;
        return MCT_OK;
    }
    self->file = -1;
    const bool exists = stat(path, &there) == 0;
    if (exists && !S_ISREG(there.st_mode)) {
        self->file = open(path, O_WRONLY | O_CLOEXEC);
        return self->file >= 0 ? MCT_OK : refuse(path, errno, why);
    }
    if (exists && access(path, W_OK) != 0) {
        return refuse(path, errno, why);
    }
    self->temporary = temporary_name(path);
    self->file = open(self->temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (self->file < 0) {
        const int reason = errno;
        free(self->temporary);
        self->temporary = NULL;
        return refuse(path, reason, why);
    }
    return MCT_OK;
}

/* Gives 0, or why not all of it was written. */
static int write_all(int file, const char *text, size_t length)
{
    enum { MOST_WRITES = 1000 };
    int reason = EIO; /* nothing is written, and nobody says why */
    for (int tries = 0; length > 0 && tries < MOST_WRITES; tries++) {
        const ssize_t written = write(file, text, length);
        if (written > 0) {
            text += written;
            length -= (size_t)written;
        } else if (written < 0) {
            reason = errno;
            tries = reason == EINTR ? tries : MOST_WRITES;
        }
    }
    return length > 0 ? reason : 0;
}

/* A file that lacks rows is worth nothing, and its space may be what another file needs. */
static void fail(csv_output *self, int reason)
{
    self->errors += self->rows + self->waiting;
    self->rows = 0;
    self->waiting = 0;
    self->used = 0;
    self->error = reason;
    csv_output_discard(self);
}

static void flush(csv_output *self)
{
    if (self->file < 0) {
        return;
    }
    const int reason = write_all(self->file, self->buffer, self->used);
    if (reason != 0) {
        fail(self, reason);
        return;
    }
    self->rows += self->waiting;
    self->waiting = 0;
    self->used = 0;
}

void csv_output_headers(csv_output *self, const char *line, size_t length)
{
    if (self->used + length > sizeof self->buffer) {
        flush(self);
    }
    if (self->file >= 0) {
        memcpy(self->buffer + self->used, line, length);
        self->used += length;
    }
}

void csv_output_row(csv_output *self, const char *line, size_t length)
{
    csv_output_headers(self, line, length);
    if (self->file >= 0) {
        self->waiting++;
    } else {
        self->errors++;
    }
}

void csv_output_close(csv_output *self)
{
    flush(self);
    if (self->file < 0) {
        return;
    }
    if (self->file == STDOUT_FILENO) {
        self->file = -1;
        return;
    }
    const int file = self->file;
    self->file = -1;
    /* On the disk before it gets its name: else a power failure could leave an empty file of that name. */
    int reason = self->temporary != NULL && fsync(file) != 0 ? errno : 0;
    reason = close(file) != 0 && reason == 0 ? errno : reason;
    if (reason == 0 && self->temporary != NULL && rename(self->temporary, self->path) != 0) {
        reason = errno;
    }
    if (reason != 0) {
        fail(self, reason);
    }
    free(self->temporary);
    self->temporary = NULL;
}

void csv_output_discard(csv_output *self)
{
    if (self->file >= 0 && self->file != STDOUT_FILENO) {
        close(self->file);
    }
    self->file = -1;
    if (self->temporary != NULL) {
        unlink(self->temporary);
        free(self->temporary);
        self->temporary = NULL;
    }
}

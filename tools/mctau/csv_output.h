/*
 * A CSV file that is there in whole or not at all: written under another name in the same folder, renamed at
 * the end. What is no regular file (a pipe, a device, "-" for stdout) is written to directly.
 */
#ifndef MCTAU_TOOLS_CSV_OUTPUT_H
#define MCTAU_TOOLS_CSV_OUTPUT_H

#include <stddef.h>
#include <stdint.h>

#include "mctau/message.h"
#include "mctau/status.h"

#define CSV_BUFFER 65536

/* All members are private but for the last three. */
typedef struct {
    const char *path;
    char *temporary; /* NULL when written directly */
    int file;        /* -1 when closed */
    size_t used;
    uint64_t waiting; /* rows in the buffer */
    char buffer[CSV_BUFFER];
    uint64_t rows;   /* written, the line of headers not counted */
    uint64_t errors; /* rows that the file did not take */
    int error;       /* errno of the first of them, 0 when none */
} csv_output;

/* Opens; the path must stay valid. MCT_ERROR_IO with a sentence: then nothing is left behind. */
mct_status csv_output_open(csv_output *self, const char *path, mct_message *why);

/* Adds a line, at most CSV_BUFFER bytes, its line break included. After an error lines are only counted. */
void csv_output_headers(csv_output *self, const char *line, size_t length);
void csv_output_row(csv_output *self, const char *line, size_t length);

/* Writes out and gives the file its name; after an error there is no file. */
void csv_output_close(csv_output *self);

/* Closes and leaves nothing behind; harmless on what is closed. */
void csv_output_discard(csv_output *self);

#endif

/* One column of a CSV file, as an input. */
#ifndef MCTAU_TOOLS_CSV_INPUT_H
#define MCTAU_TOOLS_CSV_INPUT_H

#include <stddef.h>

#include "mctau/message.h"
#include "mctau/status.h"

/*
 * Reads the column whose header is `column`; the first line holds the headers. Every row must have a number
 * there, finite and within the range of an input.
 * Gives MCT_OK and *samples, which the caller frees; MCT_ERROR_IO when the file cannot be read;
 * MCT_ERROR_RANGE or MCT_ERROR_SYNTAX for what is in it, with "file:line: found ...; allowed ..." in `why`.
 */
mct_status csv_input_read(const char *path, const char *column, double **samples, size_t *count,
                          mct_message *why);

#endif

/*
 * What the images share: ticks that are counted, and what they print for tools/flash: lines of a name and numbers in
 * hexadecimal, or "failed: why".
 */
#ifndef MCTAU_TOOLS_CORTEX_M_IMAGE_H
#define MCTAU_TOOLS_CORTEX_M_IMAGE_H

#include "hal/cortex_m/semihosting.h"
#include "mctau/loop.h"

enum { IMAGE_WORD = 192 }; /* longest word of a command line, NUL included */

/* Instructions of the ticks, each counted alone; on the host, which does not count, 0. */
typedef struct {
    uint64_t ticks, sum;
    uint32_t least, most;
} image_counts;

/* Where a run's records go, if anywhere, and what they hash to. */
typedef struct {
    bool is_wanted, is_well; /* well: all has been taken so far */
    int32_t file;
    uint64_t hash;
} image_records;

/* Starts the timer and paints the stack; false when the timer does not count instructions. */
bool image_begin(void);

/* One tick of a loop. */
void image_tick(mct_loop *loop, image_counts *counts);

/* The command line's word of this number, from 1; false when there is none, or it is longer. */
bool image_word(int number, char word[IMAGE_WORD]);

/* The number that it is, in decimal; `otherwise` when there is none. */
uint64_t image_number(int number, uint64_t otherwise);

/* "name 00000000000000ff ..." */
void image_print(const char *name, const uint64_t *values, int count);

/* What a run has come to: ticks, hash of all records, instructions, mode, faults, stack. */
void image_report(const mct_loop *loop, const image_counts *counts, uint64_t hash);

/* Opens the file that the command line's word of this number names; none or "-" for nowhere. */
void image_records_open(image_records *records, int number);

/* Adds a record, to the hash in any case. */
void image_records_add(image_records *records, const mct_record *record);

/* Closes the file; false when not all has arrived. */
bool image_records_close(image_records *records);

/* Says why, and gives the exit code. */
int image_fail(const char *why);

#endif

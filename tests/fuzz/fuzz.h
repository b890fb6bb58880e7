/*
 * What the fuzz targets share. A target is a file fuzz_NAME.c with the two functions below; it is driven by libFuzzer
 * (tools/fuzz) or by random.c (ctest), the same input giving the same run in both.
 */
#ifndef MCT_TEST_FUZZ_H
#define MCT_TEST_FUZZ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { FUZZ_LONGEST = 4096 /* bytes of an input */ };

/* One run. Whatever it is given it ends, returns 0, and leaves nothing behind that the next run could notice. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Writes seed `number`, 0, 1, ..., into `out` of FUZZ_LONGEST bytes. Returns its size, 0 behind the last one. */
size_t fuzz_seed(int number, uint8_t *out);

/* A rule that holds whatever the input: else it is told, and the driver tells the input. */
#define FUZZ_RULE(holds, ...)                   \
    do {                                        \
        if (!(holds)) {                         \
            fprintf(stderr, "broken rule: ");   \
            fprintf(stderr, __VA_ARGS__);       \
            fprintf(stderr, " (%s)\n", #holds); \
            abort();                            \
        }                                       \
    } while (0)

/* An input taken byte by byte; behind its end come zeros. */
typedef struct {
    const uint8_t *at, *end;
} fuzz_bytes;

static inline uint8_t fuzz_byte(fuzz_bytes *input)
{
    return input->at < input->end ? *input->at++ : 0;
}

#endif

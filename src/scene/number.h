/*
 * Numbers as text: TOML's grammar to double, correctly rounded, and double to a few decimal digits, correctly
 * rounded.
 *
 * Short numbers take Clinger's exact path (both factors are doubles, one rounding). All others are decided by
 * exact comparison of big integers in fixed storage: the double is found by bisection of its bit pattern,
 * which rises with its value. Some 20 us, at init only; no table, no heap, any number of digits. Source: W.
 * D. Clinger, How to read floating point numbers accurately (PLDI 1990).
 */
#ifndef MCT_SCENE_NUMBER_H
#define MCT_SCENE_NUMBER_H

#include <stdint.h>

#include "text.h"

typedef struct {
    bool is_integer;
    int64_t integer; /* when it is one */
    double value;    /* in both cases; of an integer above 2^53 the nearest double */
} mct_number;

/*
 * Reads all of `text` as one TOML number: decimal, 0x, 0o, 0b, underscores, exponents, inf, nan.
 * What is beyond a double becomes infinite or zero, as IEEE 754 rounds it.
 * Returns NULL, or what is wrong with it (a constant text).
 */
const char *mct_number_read(mct_span text, mct_number *number);

#define MCT_NUMBER_DIGITS 9
#define MCT_NUMBER_TEXT   24 /* bytes that a written number needs at most, NUL included */

/* Writes a number as C's "%.9g" does. */
void mct_number_write(double value, char text[MCT_NUMBER_TEXT]);

#endif

/**
 * @file status.h
 * What a function that can fail returns. Zero is success, every failure is negative, and nothing aborts.
 */
#ifndef MCTAU_STATUS_H
#define MCTAU_STATUS_H

/** Each status once: name, number, the sentence that mct_status_text() gives. Numbers are never reused. */
#define MCT_STATUS_LIST(STATUS)                                                              \
    STATUS(MCT_OK, 0, "all is well")                                                         \
    STATUS(MCT_ERROR_ARGUMENT, -1, "an argument is missing, or contradicts another")         \
    STATUS(MCT_ERROR_NOT_FINITE, -2, "a number is infinite or not a number")                 \
    STATUS(MCT_ERROR_SINGULAR, -3, "the equations do not determine their unknowns")          \
    STATUS(MCT_ERROR_BOUND, -4, "something has more parts than the library keeps room for")  \
    STATUS(MCT_ERROR_UNSUITED, -5, "the stepper does not suit this system or these effects") \
    STATUS(MCT_ERROR_RANGE, -6, "a number lies outside its permitted range")                 \
    STATUS(MCT_ERROR_SYNTAX, -7, "the text does not follow the grammar")                     \
    STATUS(MCT_ERROR_IO, -8, "a file or a device could not be read or written")              \
    STATUS(MCT_ERROR_NO_CONVERGENCE, -9, "the iteration ended before it reached a solution")

#define MCT_STATUS_ENUMERATOR(name, number, text) name = (number),
typedef enum { MCT_STATUS_LIST(MCT_STATUS_ENUMERATOR) } mct_status;
#undef MCT_STATUS_ENUMERATOR

/**
 * The sentence that belongs to a status, without a full stop; for a number that is no status, a sentence that
 * says so. Never null; the text is constant. Thread-safe.
 */
const char *mct_status_text(mct_status status);

#endif

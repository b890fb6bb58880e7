/**
 * @file field.h
 * The descriptor of one named value. Everything that has to know a name, a unit, a range or a default (scene
 * reader, `mctau list`, telemetry, reports, docs) reads it from here; it is written nowhere else.
 */
#ifndef MCTAU_FIELD_H
#define MCTAU_FIELD_H

#include <stddef.h>
#include <stdint.h>

typedef enum {
    MCT_FIELD_REAL,    /**< stored as double */
    MCT_FIELD_INTEGER, /**< stored as int32_t */
    MCT_FIELD_BOOLEAN, /**< stored as int32_t, 0 or 1 */
    MCT_FIELD_CHOICE,  /**< stored as int32_t, the index into `choices` */
    MCT_FIELD_TEXT,    /**< stored as a NUL-terminated char array of `maximum` bytes */
    MCT_FIELD_LIST     /**< stored as mct_list: up to MCT_MAX_LIST numbers, each within the range */
} mct_field_kind;

typedef struct {
    const char *name; /**< as in scenes, `--set`, CSV headers and telemetry */
    const char *unit; /**< SI, "" for a pure number */
    const char *doc;  /**< one line */
    mct_field_kind kind;
    double minimum;             /**< smallest value allowed (numbers and lists) */
    double maximum;             /**< largest value allowed; for a text its capacity in bytes, NUL included */
    double standard;            /**< the default (numbers, booleans, index of a choice) */
    const char *const *choices; /**< NULL-terminated names of a choice; NULL otherwise */
    size_t
        offset; /**< where the value lies in mct_scene; 0 in tables of a system, which are stored by index */
    uint32_t effects; /**< of a coefficient: while none of them is on, nothing reads it; 0: read always */
} mct_field;

/** A real quantity of a system: no choices, stored by its index in the table. */
#define MCT_QUANTITY(name, unit, minimum, maximum, standard, doc) \
    MCT_COEFFICIENT(0, name, unit, minimum, maximum, standard, doc)

/** One that is read while one of the effects is on. */
#define MCT_COEFFICIENT(effects, name, unit, minimum, maximum, standard, doc)                       \
    {                                                                                               \
        (name), (unit), (doc), MCT_FIELD_REAL, (minimum), (maximum), (standard), NULL, 0, (effects) \
    }

#endif

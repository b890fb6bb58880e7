/*
 * Hard cases: what breaks common schemes, what this library does instead, and the figure by which both are judged.
 *
 * A case is written once, here, and read by `mctau hard`, by its test in tests/hard_cases/, and by the page generated
 * from both. Compiled once for each precision, like a runner. A case runs one method at a time: a stepper of the menu on
 * a scene, or, where no stepper has a part in it, what the library does; and what is commonly done, in a few lines of its
 * own, so that the case is seen to be hard.
 */
#ifndef MCTAU_TOOLS_HARD_H
#define MCTAU_TOOLS_HARD_H

#include <stdbool.h>

#include "mctau/message.h"
#include "mctau/stepper.h"

/* Methods: below MCT_STEPPER_COUNT a stepper of the menu. */
enum {
    HARD_NAIVE = MCT_STEPPER_COUNT, /* what is commonly done */
    HARD_LIBRARY,                   /* what the library does, where it is no matter of steppers */
    HARD_METHOD_COUNT
};

typedef struct {
    bool is_refused; /* by the library, before the first step; `why` says what it said */
    double error;    /* in the case's measure; infinite when states were not finite, or a tick was rejected */
    mct_message why;
} hard_result;

typedef struct {
    int number;          /* never used again for another case */
    const char *rule;    /* what holds, as a sentence: "an inductance of 10 us is followed at 1 ms" */
    const char *naive;   /* what is commonly done, and its failure */
    const char *remedy;  /* what the library does */
    const char *measure; /* what the figure is, over what time, relative to what */
    int method;          /* the one that a user gets without asking: a stepper, or HARD_LIBRARY */
    double
        criterion; /* in double: the method's error is at most this, the naive one's is more, or infinite */
    double criterion_f32;         /* the same in float; 0: not held in float */
    bool (*is_tried)(int method); /* has a cell in the matrix; NULL: HARD_NAIVE and HARD_LIBRARY alone */
    void (*run)(int method, hard_result *result);
} hard_case;

/* The cases of one file each, ended by one without a rule; hard_cases() of hard.c goes through them by number. */
extern const hard_case hard_electric[];  /* motor and inductance: 1 to 4 */
extern const hard_case hard_stiff[];     /* mass ratios, springs, drag, Stokes, base, frame, spin */
extern const hard_case hard_friction[];  /* 26, 27 */
extern const hard_case hard_long[];      /* energy, reversal, separatrix, upright: many steps */
extern const hard_case hard_rotations[]; /* 10, 11, 13, 14, 21 */
extern const hard_case hard_numbers[];   /* 5, 15, 16, 30 to 38: no stepper has a part in them */
extern const hard_case hard_extremes[];  /* own ones: parameter ratios, days, controllers at their limits */

#endif

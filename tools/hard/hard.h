/*
 * Hard cases: what breaks common schemes, what this library does instead, and the figure by which both are judged.
 *
 * A case is written once and read by `mctau hard`, by its test in tests/hard_cases/, and by the page generated from
 * both. Compiled once for each precision, like a runner. A case runs one method at a time: a scene as a user gets it,
 * the same scene with each stepper of the menu, and what is commonly done, in a few lines of its own, so that the case
 * is seen to be hard. Where no stepper has a part in it, the library's own way stands for the scene.
 */
#ifndef MCTAU_TOOLS_HARD_H
#define MCTAU_TOOLS_HARD_H

#include <stdbool.h>

#include "mctau/message.h"
#include "mctau/stepper.h"

/* Methods: below MCT_STEPPER_COUNT a stepper of the menu. */
enum {
    HARD_LIBRARY = MCT_STEPPER_COUNT, /* what a user gets who asks for nothing: the scene as it is written */
    HARD_NAIVE,                       /* what is commonly done */
    HARD_METHOD_COUNT
};

typedef struct {
    bool is_tried;
    bool is_refused; /* by the library, before the first step; `why` says what it said */
    double error;    /* in the case's measure; infinite when states were not finite, or a tick was rejected */
    int stepper;     /* that ran, of a case with a scene; -1: its scene is not even read */
    mct_message why;
} hard_result;

struct hard_case;

typedef struct {
    const struct hard_case *about;
    int method;
    double seconds;     /* of simulated time that this run goes */
    const void *shared; /* what hard_case.prepare made */
} hard_trial;

typedef struct hard_case {
    int number;          /* never used again for another case */
    const char *rule;    /* what holds, as a sentence: "an inductance of 10 us is followed at 1 ms" */
    const char *naive;   /* what is commonly done, and its failure */
    const char *remedy;  /* what the library does */
    const char *measure; /* what the figure is, relative to what */
    /*
     * The scene's text. Its stepper is left out, or named where a user would name it; with it, all steppers are tried.
     * NULL: no matter of steppers, HARD_LIBRARY and HARD_NAIVE alone.
     */
    const char *scene;
    bool may_refuse;     /* a refusal of HARD_LIBRARY, with its reason, is as good as the criterion */
    double seconds;      /* of simulated time; 0 where none passes */
    double full_seconds; /* the same where one asks for the full length; 0: `seconds` */
    double criterion; /* in double: HARD_LIBRARY's error is at most this, HARD_NAIVE's is more, or infinite */
    double criterion_f32; /* the same in float; 0: not held in float */
    /* What all methods share, as a reference: freed by free(). NULL: nothing. */
    void *(*prepare)(const struct hard_case *self, double seconds);
    /* Runs one method. Told by hard_error(), and by hard_run.h; error is 0 and nothing refused before. */
    void (*run)(const hard_trial *trial, hard_result *result);
} hard_case;

/* The cases of one file each, ended by one without a rule; an own case takes the next free number from 39 on. */
extern const hard_case hard_electric[];  /* motor and inductance: 1 to 4 */
extern const hard_case hard_stiff[];     /* mass ratios and springs: 5 to 9 */
extern const hard_case hard_fast[];      /* drag, fluids, shaken base, frame, spin: 17 to 20, 28, 29 */
extern const hard_case hard_friction[];  /* 26, 27 */
extern const hard_case hard_long[];      /* many steps: 22 to 25 */
extern const hard_case hard_rotations[]; /* 10 to 14, 21 */
extern const hard_case hard_numbers[];   /* 15, 16, 30 to 38: no stepper has a part in them */
extern const hard_case hard_extremes[];  /* own ones: parameter ratios, days, controllers at their limits */

/* All of these tables, ended by NULL. */
extern const hard_case *const hard_tables[];

/* The case with the smallest number above this one; NULL behind the last. */
const hard_case *hard_case_after(int number);

/* Runs all methods of a case; is_full: at the full length. results[] is by method. */
void hard_run_case(const hard_case *about, bool is_full, hard_result results[HARD_METHOD_COUNT]);

/* Takes an error into a result: the largest counts, and one that is not a number is infinite. */
void hard_error(hard_result *result, double error);

/* This precision's criterion; 0: none. */
double hard_criterion(const hard_case *about);

typedef enum {
    HARD_PASSED,
    HARD_MISSED,
    HARD_NOT_FINITE, /* or a tick was rejected */
    HARD_REFUSED,
    HARD_UNJUDGED /* a figure, and no criterion in this precision */
} hard_verdict;

hard_verdict hard_judge(const hard_case *about, const hard_result *result);

/* Whether a verdict on HARD_LIBRARY is well: no miss, and no refusal but one that is allowed. */
static inline bool hard_is_well(const hard_case *about, hard_verdict verdict)
{
    return verdict == HARD_PASSED || verdict == HARD_UNJUDGED ||
           (verdict == HARD_REFUSED && about->may_refuse);
}

#endif

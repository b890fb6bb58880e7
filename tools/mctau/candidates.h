/*
 * The ways in which a scene can be simulated, and what each is worth: its error against a reference that two
 * methods agree on, and its cost.
 *
 * The error of a state is its distance from the reference, divided by the largest value that the reference
 * takes in the run, or by 1 [rad, m, rad/s, m/s, A] where that is less: absolute for what is small, relative
 * for what is large. A rotation counts as one state, whose distance is the angle between the attitudes [rad];
 * the phases of a prescribed motion do not count. The error of a run is that of its worst state, at its end
 * or at its worst tick.
 */
#ifndef MCTAU_TOOLS_CANDIDATES_H
#define MCTAU_TOOLS_CANDIDATES_H

#include "json.h"
#include "scene_file.h"

enum { ANY_PRECISION = -1, MAX_CANDIDATES = 4096 };

typedef struct {
    int stepper;
    int precision;
    int multiple;           /* ticks of the scene in one step, or 1 */
    int substeps;           /* steps in a tick, or 1 */
    double step;            /* [s] */
    uint32_t without, with; /* effects taken from the scene, and added to it */
    bool diverged;
    double error_end, error_worst; /* measured; infinite when it diverged */
    double predicted;              /* error, from pilots */
    double ns, ns_low, ns_high;    /* per tick of the scene: median and quartiles */
    double instructions;           /* per tick of the scene; NaN: not counted */
    bool pareto;                   /* none is both cheaper and more accurate */
} candidate;

/* How well the reference is known. */
typedef struct {
    int stepper, substeps;             /* the finest it was computed with, then extrapolated to h = 0 */
    int other_stepper, other_substeps; /* the second method; -1 when the scene has none */
    double own;                        /* what its last refinement changed */
    double agreement;                  /* between the two; NaN without a second one */
    double uncertainty;                /* the larger of both */
} reference_quality;

typedef struct {
    mct_scene scene;    /* the plant's, with its variation */
    bool held;          /* the input changes at every tick */
    bool keeps_tick;    /* no step is longer than it; so it is where the input is held */
    bool is_recorded;   /* the inputs are those of a closed loop, replayed */
    bool diverges;      /* even the reference does */
    double *inputs;     /* one a tick; NULL: none acts */
    uint64_t ticks;     /* over which errors are measured */
    uint64_t all_ticks; /* of the scene */
    double growth;      /* of a small difference at the start, largest until the end of the scene */
    int states;
    double scale[RUNNER_MAX_STATES];
    double *reference; /* rows as of a trial */
    reference_quality quality;
    bool progress; /* on stderr */
} study;

/*
 * A difference that has grown so much has used up four of a double's sixteen digits; what lies beyond is not
 * measured.
 */
#define STUDY_LARGEST_GROWTH 1e4
#define STUDY_MOST_TICKS     100000

/*
 * Computes inputs, horizon and reference of a scene; `seconds` bounds the computing time of each of the two
 * methods. Gives 0, or says what is wrong and gives the exit code.
 */
int study_begin(study *self, const scene_file *file, double seconds);
/* Without horizon and reference: the inputs alone. */
int study_begin_inputs(study *self, const scene_file *file);
/* Without horizon and reference, which are known: as many candidates as a study of so many ticks has. */
int study_begin_again(study *self, const scene_file *file, uint64_t ticks);
void study_end(study *self);

/* Whether a small difference at the start, and so any error, has come to mean too much before the scene's end. */
bool study_is_sensitive(const study *self);

/*
 * What a user should know of it, a sentence a line: how the reference is verified, which part of the run
 * counts.
 */
void study_print(const study *self, FILE *file);
void study_json(const study *self, json *out);

/*
 * All candidates that suit, of one or any precision: by stepper and precision, from the longest step to the
 * shortest, half an octave apart where the run and the tick have such parts. `deep`: to a 128th of the tick, or
 * 8 us.
 */
int study_candidates(const study *self, int precision, bool deep, candidate *found);

/* Whether there is such a kernel, and the system prepares constants for it. */
bool study_suits(const study *self, const candidate *one);

/* States of a candidate's run, those after its ticks; `rows` has room for those of the reference. */
bool study_follow(const study *self, const candidate *one, double *rows);
double *study_rows(const study *self);
/* Worst distance of two runs over the ticks that both have; their ends' too, unless NULL. */
double study_distance(const study *self, const double *a, int a_multiple, const double *b, int b_multiple,
                      double *at_end);

/*
 * The same of two states of a system with `states` entries each, or fewer; `worst`, unless NULL, becomes the state that
 * differs most, of a rotation the first entry.
 */
double state_distance(const mct_system *system, int states, const double *scale, const double *a,
                      const double *b, int *worst);

/* Fills error_end, error_worst, diverged of each. */
void study_measure(const study *self, candidate *list, int count);
/* Fills ns, ns_low, ns_high; not of those that diverged. */
void study_time(const study *self, candidate *list, int count);
/* Who counts instructions. */
enum { COUNTER_ANY = -1, COUNTER_PROCESSOR, COUNTER_VALGRIND, COUNTER_NONE, COUNTERS };
extern const char *const counter_names[COUNTERS];
#define OPTION_INSTRUCTIONS                                                                              \
    {                                                                                                    \
        "instructions", "BY", NULL,                                                                      \
            "who counts instructions: processor, valgrind or none; default: the processor, or valgrind " \
            "where the kernel does not let a program read its counter"                                   \
    }

/*
 * Fills instructions; NULL, or why they could not be counted. `counter` becomes the one that did. Under valgrind the
 * program runs once more: with `note` it has to begin the same study again, and to count the same candidates.
 */
const char *study_count(const study *self, candidate *list, int count, const char *path, const char *note,
                        int *counter);
/* There: counts for the process that has asked. */
void study_count_again(const study *self, candidate *list, int count);
/*
 * Marks the candidates of which none is both cheaper and more accurate; errors below the reference's count as
 * its own.
 */
void study_mark_pareto(const study *self, candidate *list, int count);

/* "rk4, step 0.5 ms, double" */
const char *candidate_text(const candidate *self, char *text, size_t size);
const char *precision_name(int precision);
/* What a scene has to say for it, as members of an object. */
void candidate_json(const candidate *self, const study *of, json *out);

/*
 * A precision's number by its name; ANY_PRECISION for NULL. Gives 0, or says what is wrong and gives the exit
 * code.
 */
int read_precision(const char *name, int *precision);
/* A counter's number by its name; COUNTER_ANY for NULL; the same. */
int read_counter(const char *name, int *counter);
/* A number within a range, of an option; the same. `allowed` ends the sentence. */
int read_number(const char *name, const char *text, double least, double most, const char *allowed,
                double *value);

#endif

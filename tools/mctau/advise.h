/*
 * Which of a scene's effects a tolerance calls for: what each is worth, what leaving it out changes, and a run that
 * verifies what is left.
 *
 * A change takes one effect a step down, as coulomb from exact to moreau or to off, or the noise or latency of sensors to
 * 0. By how much two runs differ is what candidates.h defines, over coordinates and rates: what an effect takes away with
 * it, as a motor's current, is not compared.
 */
#ifndef MCTAU_TOOLS_ADVISE_H
#define MCTAU_TOOLS_ADVISE_H

#include "candidates.h"
#include "src/scene/tables.h"

typedef struct {
    int table; /* of the key, MCT_TABLE_EFFECTS or that of [sensors] */
    mct_scene_key key;
    double from, to;    /* its value: of a choice the index */
    const char *reason; /* why it is kept or dropped */
    bool is_fixed;      /* kept without asking */
    bool needs_stepper; /* and that because the scene's stepper does not suit without it */
    bool is_dropped;
    bool by_run;       /* the estimate: a run without it, not to first order */
    double time_scale; /* [s]; NaN: none */
    departure estimate;
    candidate cost; /* of the scene with the change; its times and instructions NaN where no kernel suits */
} change;

enum { MOST_CHANGES = 2 * MCT_EFFECT_COUNT + 2 + MCT_MAX_ENCODERS };

typedef struct {
    const scene_file *file;
    double tolerance;
    study about; /* inputs and costs, in the scene's own precision */
    bool is_loop;
    mct_scene full; /* as judged: in double, with a stepper and steps that are accurate enough */
    int moving;     /* states compared: coordinates and rates */
    uint64_t ticks;
    double scale[RUNNER_MAX_STATES];
    double own; /* what steps half as long change in the full run */
    course run; /* of `full` */
    double *rows;
    change list[MOST_CHANGES];
    int count;
    change left_out[MCT_EFFECT_COUNT];
    int left_out_count;
    /* the choice */
    mct_scene pruned; /* as judged */
    bool is_certified;
    const char *refusal; /* why not */
    double bound;        /* sum of the estimates of what is dropped */
    double verified;     /* measured between the full run and the pruned one */
    double uncertainty;  /* of both, by steps half as long */
    int taken_back;      /* drops that verification refused */
    candidate full_cost, pruned_cost;
    int counter;             /* who counted instructions */
    const char *not_counted; /* why not */
} advice;

/* All of it; `counter` as read_counter gives it. Gives 0, or says what is wrong and gives the exit code. */
int advise_begin(advice *self, const scene_file *file, double tolerance, int counter);
void advise_end(advice *self);

/* Under valgrind: counts what `note` names, for the process that has asked. Gives the exit code. */
int advise_count_again(const scene_file *file, const char *note);

/* The scene as it was read, without what is dropped. */
mct_scene advise_pruned_scene(const advice *self);

/* Bytes of flash that a change saves; NaN: not known. */
double advise_flash(const advice *self, const candidate *with, const candidate *without);

/* Whether a time scale is within a factor of ten of the tick. */
bool advise_is_near_tick(const advice *self, double time_scale);

/* Whether a key of [parameters] would be read, after a change that switches something on, and is not 0. */
bool advise_would_read(const advice *self, const change *one, const mct_scene_key *parameter);

#endif

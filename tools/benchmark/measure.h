/*
 * Times a piece of work: samples of a few milliseconds each, one line of samples for tools/bench to read. Or lets
 * callgrind count its instructions: instructions.py.
 */
#ifndef MCTAU_BENCHMARK_MEASURE_H
#define MCTAU_BENCHMARK_MEASURE_H

#include <stdbool.h>

/* Does `count` units of work. */
typedef void (*measure_work)(void *context, long count);

typedef struct {
    int samples;      /* of each piece of work */
    double sample_ns; /* length of one */
    bool count;       /* instructions, not time */
} measure_effort;

/* Options --samples N, --sample-us N and --count; ends the program with a message when there is anything else. */
measure_effort measure_effort_of(int argc, char **argv);

/*
 * Warms up, then prints "ns", the name, and the nanoseconds per unit of each sample. When instructions are counted:
 * does MEASURE_COUNT units, then twice as many, each between two calls of measure_mark, and prints "count" and the name.
 * prepare: called before each sample, untimed; may be NULL.
 * most: count of a sample; 0: as many as its length takes.
 */
void measure(const measure_effort *effort, const char *name, measure_work work,
             void (*prepare)(void *context), void *context, long most);

enum { MEASURE_COUNT = 256 };

/* Does nothing; callgrind writes down its counts when it returns. */
void measure_mark(void);

#endif

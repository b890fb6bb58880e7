/* Times a piece of work: samples of a few milliseconds each, one line of samples for tools/bench to read. */
#ifndef MCTAU_BENCHMARK_MEASURE_H
#define MCTAU_BENCHMARK_MEASURE_H

/* Does `count` units of work. */
typedef void (*measure_work)(void *context, long count);

typedef struct {
    int samples;      /* of each piece of work */
    double sample_ns; /* length of one */
} measure_effort;

/* Options --samples N and --sample-us N; ends the program with a message when there is anything else. */
measure_effort measure_effort_of(int argc, char **argv);

/*
 * Warms up, then prints "ns", the name, and the nanoseconds per unit of each sample.
 * prepare: called before each sample, untimed; may be NULL.
 * most: count of a sample; 0: as many as its length takes.
 */
void measure(const measure_effort *effort, const char *name, measure_work work,
             void (*prepare)(void *context), void *context, long most);

#endif

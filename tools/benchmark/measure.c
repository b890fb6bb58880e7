#include "measure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static double now_ns(void)
{
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time); /* what others do on this core does not count */
    return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

measure_effort measure_effort_of(int argc, char **argv)
{
    measure_effort effort = {.samples = 11, .sample_ns = 2e6};
    for (int i = 1; i < argc; i += 2) {
        if (strcmp(argv[i], "--count") == 0) {
            effort.count = true;
            i--;
        } else if (i + 1 < argc && strcmp(argv[i], "--samples") == 0) {
            effort.samples = atoi(argv[i + 1]);
        } else if (i + 1 < argc && strcmp(argv[i], "--sample-us") == 0) {
            effort.sample_ns = atof(argv[i + 1]) * 1e3;
        } else {
            fprintf(stderr, "%s: found %s; allowed --samples N, --sample-us N, --count\n", argv[0], argv[i]);
            exit(2);
        }
    }
    return effort;
}

static double time_of(measure_work work, void (*prepare)(void *context), void *context, long count)
{
    if (prepare != NULL) {
        prepare(context);
    }
    const double begin = now_ns();
    work(context, count);
    return now_ns() - begin;
}

__attribute__((noinline)) void measure_mark(void)
{
    __asm__ volatile(""); /* so that no call of it is left out */
}

static void count_twice(measure_work work, void (*prepare)(void *context), void *context)
{
    for (long units = MEASURE_COUNT; units <= 2 * MEASURE_COUNT; units += MEASURE_COUNT) {
        if (prepare != NULL) {
            prepare(context);
        }
        measure_mark();
        work(context, units);
        measure_mark();
    }
}

void measure(const measure_effort *effort, const char *name, measure_work work,
             void (*prepare)(void *context), void *context, long most)
{
    if (effort->count) {
        count_twice(work, prepare, context);
        printf("count %s\n", name);
        return;
    }
    long count = most > 0 ? most : 64;
    double spent = time_of(work, prepare, context, count);
    /* Finding the count is the warm-up too. */
    for (double warm = spent; warm < effort->sample_ns; warm += spent) {
        if (most == 0 && spent < effort->sample_ns / 2) {
            count *= 2;
        }
        spent = time_of(work, prepare, context, count);
    }
    printf("ns %s", name);
    for (int i = 0; i < effort->samples; i++) {
        printf(" %.3f", time_of(work, prepare, context, count) / (double)count);
    }
    printf("\n");
    fflush(stdout);
}

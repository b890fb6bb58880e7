/*
 * Sweeps the methods of one peer over one scene:
 *   PROGRAM REFERENCES SCENE [--quick]
 *   PROGRAM --scenes                     all scenes, as JSON
 * For each method and setting one line, its fields separated by tabs: point, scene, method, steps or tolerance, setting
 * (a step in seconds, or the tolerance), worst error over the samples, nanoseconds for each simulated millisecond
 * (median).
 *
 * The error of an entry of the state is relative to 1 or to the largest that it gets in this motion, whichever is more.
 * A sweep begins with the cheapest setting and ends where it has become too dear, or no more accurate.
 */
#include "peers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>

#include "samples.h"

enum { MOST_RUNS = 15 };

static struct {
    double longest_run, longest_point; /* [ns] */
    int fewest_runs;
    int stride; /* every how manieth setting */
} effort = {0.4e9, 60e6, 3, 1};

/* Of this thread on the core: another program's turn does not count. */
static double now_ns(void)
{
    struct timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return (double)time.tv_sec * 1e9 + (double)time.tv_nsec;
}

volatile sig_atomic_t peer_is_late;

static void become_late(int signal)
{
    (void)signal;
    peer_is_late = 1;
}

static void allow(double ns)
{
    const struct itimerval time = {.it_value = {(time_t)(ns / 1e9), (suseconds_t)(fmod(ns, 1e9) / 1e3)}};
    signal(SIGPROF, become_late);
    setitimer(ITIMER_PROF, &time, NULL);
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

typedef struct {
    double error, ns;
} point;

static point measure_point(const bench_scene *scene, int method, double setting, const double *reference)
{
    point found = {(double)NAN, (double)NAN};
    double samples[SCENE_SAMPLES * SCENE_STATES], times[MOST_RUNS], spent = 0;
    void *self = the_peer.open(scene, method, setting);
    if (self == NULL) {
        return found; /* does not suit, or not with this setting */
    }
    const double *inputs = scene_inputs(scene);
    bool is_well = true;
    int runs = 0;
    peer_is_late = 0;
    allow((effort.fewest_runs + 1) * effort.longest_run *
          (setting == 1 ? 4 : 1)); /* one step a span: whatever it takes */
    while (is_well && runs < MOST_RUNS && (runs < effort.fewest_runs || spent < effort.longest_point)) {
        const double begin = now_ns();
        is_well = the_peer.run(self, inputs, samples);
        times[runs] = now_ns() - begin;
        spent += times[runs++];
        if (runs == 1) {
            found.error = samples_error(scene, reference, samples);
            is_well = is_well && found.error == found.error;
        }
    }
    allow(0);
    the_peer.close(self);
    qsort(times, (size_t)runs, sizeof times[0], by_size);
    found.ns = times[(runs - 1) / 2] / SCENE_TICKS;
    found.error = is_well ? found.error : (double)NAN;
    return found;
}

/* 1, 2, 3, 4, 6, 8, 12, ... steps in a span; or 1e-2, 1e-3, 1e-4, ... */
static double setting_of(const peer_method *method, int i)
{
    if (method->is_fixed) {
        return i == 0 ? 1 : i % 2 == 1 ? (double)(2L << (i / 2)) : (double)(3L << (i / 2 - 1));
    }
    return pow(10, -2 - i);
}

static void sweep(const bench_scene *scene, int number, const double *reference)
{
    enum { TOLERANCES = 13, STEPS = 48, SAME = 4 };
    const peer_method *method = &the_peer.methods[number];
    const int last = method->is_fixed ? STEPS : TOLERANCES;
    double best = INFINITY;
    int idle = 0;
    for (int i = 0; i < last && idle < SAME; i += effort.stride) {
        const double setting = setting_of(method, i);
        const point found = measure_point(scene, number, setting, reference);
        if (found.error == found.error) {
            printf("point\t%s\t%s\t%s\t%.6g\t%.4g\t%.5g\n", scene->name, method->name,
                   method->is_fixed ? "step" : "tolerance",
                   method->is_fixed ? scene_span(scene) / setting : setting, found.error, found.ns);
        }
        idle = found.error < 0.7 * best || !(best < 1e-3) ? 0 : idle + 1;
        best = found.error < best ? found.error : best;
        if (found.ns * SCENE_TICKS > effort.longest_run || best < 3e-14) {
            break;
        }
        if (peer_is_late || (found.ns != found.ns && !method->is_fixed)) {
            break; /* does not suit; of a fixed method it may be the step that is too long */
        }
    }
    fflush(stdout);
}

static void print_numbers(const char *name, const double *values, int count)
{
    printf(", \"%s\": [", name);
    for (int i = 0; i < count; i++) {
        printf("%s%.17g", i ? ", " : "", values[i]);
    }
    printf("]");
}

static void print_scenes(void)
{
    static const char *const forms[] = {[SCENE_PENDULUM] = "pendulum",
                                        [SCENE_SPRING] = "spring",
                                        [SCENE_CART_POLE] = "cart_pole",
                                        [SCENE_WHEEL] = "wheel",
                                        [SCENE_BODY] = "body"};
    printf("{\"tick\": %g, \"ticks\": %d, \"ticks_per_sample\": %d, \"scenes\": [", SCENE_TICK, SCENE_TICKS,
           SCENE_TICKS_PER_SAMPLE);
    for (int n = 0; n < SCENE_PEERS; n++) {
        const bench_scene *scene = &bench_scenes[n];
        double p[SCENE_PARAMETERS];
        scene_parameters(scene, p);
        printf("%s\n{\"name\": \"%s\", \"doc\": \"%s\", \"form\": \"%s\", \"held\": %s, \"states\": %d",
               n ? "," : "", scene->name, scene->doc, forms[scene->form], scene->is_held ? "true" : "false",
               scene->states);
        print_numbers("parameters", p, SCENE_PARAMETERS);
        print_numbers("start", scene->start, scene->states);
        print_numbers("inputs", scene_inputs(scene), scene->is_held ? SCENE_TICKS : 0);
        printf("}");
    }
    printf("\n]}\n");
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--scenes") == 0) {
        print_scenes();
        return 0;
    }
    const bench_scene *scene = argc > 2 ? scene_by_name(argv[2]) : NULL;
    if (scene == NULL || argc > 4 || (argc == 4 && strcmp(argv[3], "--quick") != 0)) {
        fprintf(stderr, "usage: %s REFERENCES SCENE [--quick]\nscenes:", argv[0]);
        for (int i = 0; i < SCENE_PEERS; i++) {
            fprintf(stderr, "%s %s", i ? "," : "", bench_scenes[i].name);
        }
        fprintf(stderr, "\n");
        return 2;
    }
    if (argc == 4) {
        effort.longest_run = 0.025e9;
        effort.longest_point = 0.5e6;
        effort.fewest_runs = 2;
        effort.stride = 2;
    }
    double reference[SCENE_SAMPLES * SCENE_STATES];
    samples_read(argv[1], scene, reference);
    printf("peer\t%s\t%s\n", the_peer.name, the_peer.version());
    for (int method = 0; method < the_peer.method_count; method++) {
        sweep(scene, method, reference);
    }
    return 0;
}

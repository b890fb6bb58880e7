#include "samples.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void fail(const char *what, const char *why)
{
    fprintf(stderr, "%s: %s\n", what, why);
    exit(1);
}

void samples_read(const char *file, const bench_scene *scene, double *samples)
{
    char name[64];
    FILE *in = fopen(file, "r");
    if (in == NULL) {
        fail(file, "cannot be read");
    }
    bool found = false;
    int row = 0;
    while (row < SCENE_SAMPLES && fscanf(in, " %63[^:]:", name) == 1) {
        found = strcmp(name, scene->name) == 0;
        for (int i = 0; i < SCENE_STATES; i++) {
            double value;
            if (fscanf(in, "%lf", &value) != 1) {
                fail(file, "is cut off");
            }
            if (found && i < scene->states) {
                samples[row * scene->states + i] = value;
            }
        }
        row += found ? 1 : 0;
    }
    fclose(in);
    if (row < SCENE_SAMPLES) {
        fail(scene->name, "has no reference");
    }
}

double samples_error(const bench_scene *scene, const double *reference, const double *samples)
{
    double worst = 0;
    for (int i = 0; i < scene->states; i++) {
        double scale = 1;
        for (int k = i; k < SCENE_SAMPLES * scene->states; k += scene->states) {
            scale = fmax(scale, fabs(reference[k]));
        }
        for (int k = i; k < SCENE_SAMPLES * scene->states; k += scene->states) {
            const double error = fabs(samples[k] - reference[k]) / scale;
            if (!(error < 1)) {
                return (double)NAN; /* another motion, or none */
            }
            worst = fmax(worst, error);
        }
    }
    return worst;
}

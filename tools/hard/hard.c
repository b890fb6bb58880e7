#include "hard.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mctau/real.h"

const hard_case *const hard_tables[] = {hard_electric,  hard_stiff,   hard_fast,     hard_friction, hard_long,
                                        hard_rotations, hard_numbers, hard_extremes, NULL};

const hard_case *hard_case_after(int number)
{
    const hard_case *next = NULL;
    for (int i = 0; hard_tables[i] != NULL; i++) {
        for (const hard_case *one = hard_tables[i]; one->rule != NULL; one++) {
            if (one->number > number && (next == NULL || one->number < next->number)) {
                next = one;
            }
        }
    }
    return next;
}

void hard_run_case(const hard_case *about, bool is_full, hard_result results[HARD_METHOD_COUNT])
{
    const double seconds = is_full && about->full_seconds > 0 ? about->full_seconds : about->seconds;
    void *shared = about->prepare != NULL ? about->prepare(about, seconds) : NULL;
    for (int method = 0; method < HARD_METHOD_COUNT; method++) {
        memset(&results[method], 0, sizeof results[method]);
        results[method].is_tried = about->scene != NULL || method >= HARD_LIBRARY;
        if (results[method].is_tried) {
            about->run(&(hard_trial){about, method, seconds, shared}, &results[method]);
        }
    }
    free(shared);
}

void hard_error(hard_result *result, double error)
{
    const double size = fabs(error);
    result->error = size <= result->error ? result->error : size < (double)INFINITY ? size : (double)INFINITY;
}

double hard_criterion(const hard_case *about)
{
    return MCT_REAL_IS_FLOAT ? about->criterion_f32 : about->criterion;
}

hard_verdict hard_judge(const hard_case *about, const hard_result *result)
{
    const double criterion = hard_criterion(about);
    return result->is_refused                    ? HARD_REFUSED
           : !(result->error < (double)INFINITY) ? HARD_NOT_FINITE
           : !(criterion > 0)                    ? HARD_UNJUDGED
           : result->error <= criterion          ? HARD_PASSED
                                                 : HARD_MISSED;
}

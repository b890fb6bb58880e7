/* What a scene's effects do along a run of it. */
#ifndef MCTAU_TOOLS_RUNNER_ADVISE_H
#define MCTAU_TOOLS_RUNNER_ADVISE_H

#include "runner.h"

mct_status runner_depart(const mct_scene *scene, const course *along, const double *scale,
                         const mct_scene *others, int count, departure *found, mct_message *why);
double runner_time_scale(const mct_scene *with, const mct_scene *without, const course *along);

#endif

/* One way to simulate a scene, tried: where it goes and what it costs. */
#ifndef MCTAU_TOOLS_RUNNER_COST_H
#define MCTAU_TOOLS_RUNNER_COST_H

#include "runner.h"

enum { RUNNER_COUNTED_TICKS = 32 }; /* instructions are counted over so many at most */

mct_status runner_inputs(const mct_scene *scene, const run_options *options, uint64_t ticks, double *inputs,
                         mct_message *why);
mct_status runner_loop(const mct_scene *scene, uint64_t ticks, double *states, bool *diverged,
                       mct_message *why);
mct_status runner_try(const mct_scene *scene, trial *self, mct_message *why);

#endif

/* A run in this precision; see runner.h. */
#ifndef MCTAU_TOOLS_RUNNER_RUN_H
#define MCTAU_TOOLS_RUNNER_RUN_H

#include "mctau/plant.h"
#include "runner.h"

mct_status runner_run(const mct_scene *scene, const run_options *options, run_result *result,
                      mct_message *why);

energies runner_energies(const mct_evaluation *at);
powers runner_powers(const mct_evaluation *at);

#endif

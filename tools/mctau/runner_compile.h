/* A scene's structs as C text: see hal/compiled.h. */
#ifndef MCTAU_TOOLS_RUNNER_COMPILE_H
#define MCTAU_TOOLS_RUNNER_COMPILE_H

#include "csv_output.h"
#include "runner.h"

/* Writes them to `out`, which the caller opens and closes; nothing on an error, with a sentence in `why`. */
mct_status runner_compile(const mct_scene *scene, const run_options *options, csv_output *out,
                          mct_message *why);

#endif

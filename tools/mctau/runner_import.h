/* Records of an image (hal/records.h) into an event log. */
#ifndef MCTAU_TOOLS_RUNNER_IMPORT_H
#define MCTAU_TOOLS_RUNNER_IMPORT_H

#include "runner.h"

/*
 * Reads `records`, which a run of `scene` has left, into options->log, beside options->scene_text. MCT_ERROR_SYNTAX for what
 * is no such file, MCT_ERROR_UNSUITED for one of another precision, MCT_ERROR_IO; then there is no log.
 */
mct_status runner_import(const mct_scene *scene, const char *records, const run_options *options,
                         import_result *result, mct_message *why);

#endif

/* The virtual drive on a CAN interface in this precision; see runner.h. */
#ifndef MCTAU_TOOLS_RUNNER_DRIVE_H
#define MCTAU_TOOLS_RUNNER_DRIVE_H

#include "runner.h"

mct_status runner_drive(const mct_scene *scene, const drive_options *options, drive_result *result,
                        mct_message *why);

#endif

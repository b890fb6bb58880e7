/* A replay in this precision; see runner.h. */
#ifndef MCTAU_TOOLS_RUNNER_REPLAY_H
#define MCTAU_TOOLS_RUNNER_REPLAY_H

#include "runner.h"

/*
 * Runs the recorded inputs of an event log again and compares every result bit for bit, up to the first
 * difference.
 *
 * Returns MCT_OK when there was something to compare: result->equal and result->truncated then say how it
 * went. `truncated` is set, too, when the log lacks the message that ends it. Else a sentence in `why`, and
 *   MCT_ERROR_IO        the file cannot be read, or holds no complete scene, or ticks are missing in it
 *   MCT_ERROR_SYNTAX    it is no event log, or an event in it is damaged
 *   MCT_ERROR_UNSUITED  it was recorded in another precision (its runner can replay it) or by another version
 *   or what reading its scene gives.
 * result->ticks counts the ticks that were compared, also then.
 */
mct_status runner_replay(const char *log, replay_result *result, mct_message *why);

#endif

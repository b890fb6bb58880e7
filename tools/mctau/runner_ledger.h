/* The ledger of a run in this precision; see runner.h. */
#ifndef MCTAU_TOOLS_RUNNER_LEDGER_H
#define MCTAU_TOOLS_RUNNER_LEDGER_H

#include "runner.h"

mct_status ledger_begin(const mct_scene *scene, ledger **self, mct_message *why);
void ledger_tick(ledger *self, const double *value, const double *rest, double input);
void ledger_end(ledger *self, ledger_result *result);

#endif

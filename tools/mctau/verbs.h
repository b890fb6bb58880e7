/* The verbs, each in a file of its own; main.c lists them. */
#ifndef MCTAU_TOOLS_VERBS_H
#define MCTAU_TOOLS_VERBS_H

#include "options.h"

extern const verb verb_list;
extern const verb verb_run;
extern const verb verb_mct;
extern const verb verb_replay;
extern const verb verb_drive;
extern const verb verb_cost;
extern const verb verb_pick;
extern const verb verb_advise;
extern const verb verb_hard;
extern const verb verb_compile;
extern const verb verb_import;

#endif

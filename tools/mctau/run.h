/* What a run has come to, and how it is told. */
#ifndef MCTAU_TOOLS_RUN_H
#define MCTAU_TOOLS_RUN_H

#include <stdio.h>

#include "scene_file.h"

typedef enum { BALANCED, NOT_BALANCED, FAULTED, DIVERGED, STOPPED, FINISHED } verdict;

/* A run and what it was asked for. */
typedef struct {
    const scene_file *scene;
    const run_options *options;
    run_result result;
    ledger_result ledger; /* where the options have one */
    verdict verdict;
} run_report;

const char *verdict_name(verdict self);

void print_run_json(const run_report *report, FILE *file);

/* What the start found on a CAN bus. */
void print_start(const mct_can_report *can, FILE *file);

void print_run(const run_report *report, FILE *file);

#endif

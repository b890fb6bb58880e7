/* A run in lockstep with telemetry, as the command makes it; for the tests of telemetry and replay. */
#ifndef MCTAU_TESTS_LOGGED_RUN_H
#define MCTAU_TESTS_LOGGED_RUN_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "hal/lcm/telemetry.h"
#include "hal/sim/sim.h"
#include "mctau/loop.h"

typedef struct {
    mct_scene scene;
    mct_sim sim;
    mct_loop loop;
    mct_plan plan;
    mct_ring ring;
    mct_telemetry telemetry;
    mct_status status;
    mct_message why;
} logged_run;

static const char swing_up_scene[] =
    "[scene]\nsystem = \"reaction_wheel\"\nstepper = \"expo\"\n[effects]\nmotor = \"inductive\"\n"
    "[initial]\narm_angle = 3.0\n[controller]\nkind = \"swing_up_balance\"\n[sensors]\nnoise = 0.5\n"
    "[variation]\nspread = 0.1\nseed = 7\n";

/* A file name of this test alone; the file is not made. */
static inline void log_path(char path[64], const char *name)
{
    const char *folder = getenv("TMPDIR");
    snprintf(path, 64, "%s/mctau_%ld_%s", folder != NULL && strlen(folder) < 30 ? folder : "/tmp",
             (long)getpid(), name);
}

static inline void logged_run_prepare(logged_run *run, const char *text, mct_samples samples)
{
    memset(run, 0, sizeof *run);
    run->status = mct_scene_read(text, strlen(text), "scene", NULL, 0, &run->scene, &run->why);
    if (run->status == MCT_OK) {
        run->status = mct_sim_init(&run->sim, &run->scene, &run->why);
    }
    if (run->status == MCT_OK) {
        run->status = mct_loop_init(&run->loop, &run->plan, &run->scene, mct_sim_hal(&run->sim), &run->ring,
                                    samples, &run->why);
    }
    if (run->status != MCT_OK) {
        printf("%s\n", run->why.text);
    }
}

static inline void logged_run_start(logged_run *run, const mct_telemetry_targets *targets)
{
    const mct_hal *hal = &run->loop.hal;
    hal->ops->open(hal->context, NULL);
    run->status = mct_telemetry_start(&run->telemetry, &run->ring, &run->scene, targets, &run->why);
}

static inline void logged_run_tick(logged_run *run)
{
    const struct timespec pause = {.tv_nsec = 50000};
    for (int i = 0; i < 100000 && mct_ring_is_full(&run->ring); i++) {
        nanosleep(&pause, NULL);
    }
    mct_loop_tick(&run->loop);
}

/* A whole run of so many ticks into a log. */
static inline void logged_run_all(logged_run *run, const char *text, mct_samples samples, int ticks,
                                  const char *log)
{
    const mct_telemetry_targets targets = {.log = log, .scene_text = text};
    logged_run_prepare(run, text, samples);
    if (run->status != MCT_OK) {
        return;
    }
    logged_run_start(run, &targets);
    if (run->status != MCT_OK) {
        printf("%s\n", run->why.text);
        return;
    }
    for (int i = 0; i < ticks; i++) {
        logged_run_tick(run);
    }
    mct_telemetry_stop(&run->telemetry);
}

#endif

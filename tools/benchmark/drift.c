/*
 *   PROGRAM STEPS [SYSTEM | STEPPER]...
 * What each stepper keeps over many steps of 1 ms, in the precision of the library that this is linked with, of all
 * systems and by all steppers, or of and by those named: one line
 *   drift STEPPER VALUE SYSTEM, WHAT
 * for each thing that a system keeps (tests/support/invariants.h), VALUE the largest drift relative to its size; "inf"
 * where the plant diverged.
 *
 * With the weight of the system, and without where that keeps more.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mctau/plant.h"
#include "support/invariants.h"

/* A prime, so that no oscillation is looked at in the same phase for ever. */
enum { LOOK_EVERY = 1009 };

/* One motion; what is not known yet goes into `all`. */
static void run(const mct_scene *scene, invariants *all, long steps)
{
    mct_plant plant;
    invariants found;
    mct_message why = {""};
    if (mct_plant_init(&plant, scene, &why) != MCT_OK) {
        fprintf(stderr, "benchmark: %s: %s\n", mct_systems[scene->system]->name, why.text);
        exit(1);
    }
    invariants_start(&found, &plant);
    bool is_new = false;
    for (int kind = 0; kind < KEPT_COUNT; kind++) {
        is_new |= found.is_kept[kind] && !all->is_kept[kind];
    }
    for (long k = 1; is_new && k <= steps && plant.diverged_ticks == 0; k++) {
        mct_plant_step(&plant, 0);
        if (k % LOOK_EVERY == 0 || k == steps || plant.diverged_ticks > 0) {
            invariants_look(&found, &plant);
        }
    }
    for (int kind = 0; kind < KEPT_COUNT; kind++) {
        if (found.is_kept[kind] && !all->is_kept[kind]) {
            all->is_kept[kind] = true;
            all->drift[kind] = found.drift[kind];
        }
    }
}

/* What is named on the command line. */
typedef struct {
    bool systems[MCT_SYSTEM_COUNT], steppers[MCT_STEPPER_COUNT];
} choice;

static void run_system(int system, const choice *wanted, long steps)
{
    for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
        invariants all = {0};
        for (int weight = 1; wanted->steppers[stepper] && weight >= 0; weight--) {
            mct_scene scene;
            if (invariant_scene(&scene, system, stepper, weight)) {
                fprintf(stderr, "%s, %s%s\n", mct_systems[system]->name, mct_steppers[stepper].name,
                        weight ? "" : ", without weight");
                run(&scene, &all, steps);
            }
        }
        for (int kind = 0; kind < KEPT_COUNT; kind++) {
            if (all.is_kept[kind]) {
                printf("drift %s %.1e %s, %s\n", mct_steppers[stepper].name, all.drift[kind],
                       mct_systems[system]->name, kept_names[kind]);
            }
        }
        fflush(stdout);
    }
}

/* Marks what a name stands for; false where it is unknown. */
static bool choose(choice *wanted, const char *name)
{
    bool known = false;
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        wanted->systems[i] |= strcmp(name, mct_systems[i]->name) == 0;
        known |= strcmp(name, mct_systems[i]->name) == 0;
    }
    for (int i = 0; i < MCT_STEPPER_COUNT; i++) {
        wanted->steppers[i] |= strcmp(name, mct_steppers[i].name) == 0;
        known |= strcmp(name, mct_steppers[i].name) == 0;
    }
    return known;
}

/* None marked stands for all. */
static void complete(bool *marks, int count)
{
    bool any = false;
    for (int i = 0; i < count; i++) {
        any |= marks[i];
    }
    for (int i = 0; i < count; i++) {
        marks[i] |= !any;
    }
}

int main(int argc, char **argv)
{
    const long steps = argc >= 2 ? atol(argv[1]) : 0;
    choice wanted = {{false}, {false}};
    if (steps <= 0) {
        fprintf(stderr, "usage: %s STEPS [SYSTEM | STEPPER]...\n", argv[0]);
        return 2;
    }
    for (int i = 2; i < argc; i++) {
        if (!choose(&wanted, argv[i])) {
            fprintf(stderr, "tools/bench: --drift: found %s; allowed names of systems and steppers\n",
                    argv[i]);
            return 2;
        }
    }
    complete(wanted.systems, MCT_SYSTEM_COUNT);
    complete(wanted.steppers, MCT_STEPPER_COUNT);
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        if (wanted.systems[system]) {
            run_system(system, &wanted, steps);
        }
    }
    return 0;
}

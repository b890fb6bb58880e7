/*
 * What each stepper keeps over many steps of 1 ms, in the precision of the library that this is linked with: one line
 *   drift STEPPER VALUE SYSTEM, WHAT
 * for each thing that a system keeps (tests/support/invariants.h), VALUE the largest drift relative to its size; "inf"
 * where the plant diverged.
 *
 * With the weight of the system, and without where that keeps more.
 */
#include <stdio.h>
#include <stdlib.h>

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

int main(int argc, char **argv)
{
    const long steps = argc == 2 ? atol(argv[1]) : 0;
    if (steps <= 0) {
        fprintf(stderr, "usage: %s STEPS\n", argv[0]);
        return 2;
    }
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        fprintf(stderr, "%d of %d: %s\n", system + 1, MCT_SYSTEM_COUNT, mct_systems[system]->name);
        for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
            invariants all = {0};
            for (int weight = 1; weight >= 0; weight--) {
                mct_scene scene;
                if (invariant_scene(&scene, system, stepper, weight)) {
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
    return 0;
}

/**
 * @file compiled.h
 * A scene as `mctau compile` writes it: structs as their init leaves them, as const data. A program copies what changes
 * and runs; it has no scene reader, no init, and no kernel but one:
 *
 *     mct_loop loop = mct_compiled_loop;
 *     loop.hal = board_hal();
 *     loop.hal.ops->open(loop.hal.context, NULL);
 *     for (;;) {
 *         mct_loop_tick(&loop);
 *     }
 *
 * Linked with --gc-sections, since the library's other kernels stay out in this way alone. What is not used takes no
 * flash: a program without mct_compiled_sim has neither a plant nor a kernel.
 */
#ifndef MCTAU_HAL_COMPILED_H
#define MCTAU_HAL_COMPILED_H

#include "hal/sim/sim.h"
#include "hal/socketcan/can.h"
#include "mctau/loop.h"

/** Estimator, controller, supervisor, or an open-loop input. `hal` is for the program to fill in, and a ring, if any. */
extern const mct_loop mct_compiled_loop;

/** The scene's mechanism with its sensors, in lockstep: mct_sim_hal() of a copy. */
extern const mct_sim mct_compiled_sim;

/**
 * The HAL over CAN, as the scene's [can] describes it: `transport` is for the program to fill in. Reads
 * mct_compiled_scene. Not there for a scene that suits no bus; the file then says why.
 */
extern const mct_can mct_compiled_can;

/** The scene itself, for what is prepared when a program starts. 6 kB of flash when used. */
extern const union mct_compiled_scene {
    uint64_t words[(sizeof(mct_scene) + 7) / 8];
    mct_scene scene;
} mct_compiled_scene;

/** Ticks of the scene's duration. */
extern const uint64_t mct_compiled_ticks;

#endif

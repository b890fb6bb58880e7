/*
 * What a whole tick costs, in the precision of the library that this is linked with:
 *   tick SYSTEM MODE      in lockstep: sensors, estimator, controller, supervisor, plant, record to a ring that is
 *                         emptied
 *   bus SYSTEM PROTOCOL   the same over a bus within the process
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/sim/sim.h"
#include "hal/socketcan/can.h"
#include "hal/socketcan/drive.h"
#include "hal/socketcan/ring.h"
#include "mctau/loop.h"
#include "measure.h"

enum { SWING_UP_TICKS = 512, SETTLE_TICKS = 20000 };

static void fail(const char *name, const char *why)
{
    fprintf(stderr, "benchmark: %s: %s\n", name, why);
    exit(1);
}

/* --- ticks --- */

typedef struct {
    mct_sim sim, sim_start;
    mct_loop loop, loop_start; /* refers to itself and sim: copies come back to their place */
    mct_plan plan;
    mct_ring ring;
    mct_mode mode;
} ticking;

static void restart_loop(void *context)
{
    ticking *self = context;
    self->sim = self->sim_start;
    self->loop = self->loop_start;
}

static void drain(mct_ring *ring)
{
    while (mct_ring_peek(ring) != NULL) {
        mct_ring_pop(ring);
    }
}

static void run_ticks(void *context, long count)
{
    ticking *self = context;
    for (long k = 0; k < count; k++) {
        mct_loop_tick(&self->loop);
        if (k % (MCT_RING_SIZE / 2) == 0) {
            drain(&self->ring);
        }
    }
    drain(&self->ring);
}

static void measure_ticks(const measure_effort *effort, int system, mct_mode mode)
{
    static ticking self;
    mct_scene scene;
    mct_message why;
    char name[64];
    memset(&self, 0, sizeof self);
    mct_message_clear(&why);
    mct_scene_defaults(&scene, system);
    scene.controller = MCT_CONTROLLER_SWING_UP_BALANCE;
    const mct_samples none = {NULL, 0};
    if (mct_sim_init(&self.sim, &scene, &why) != MCT_OK ||
        mct_loop_init(&self.loop, &self.plan, &scene, mct_sim_hal(&self.sim), &self.ring, none, &why) !=
            MCT_OK) {
        fail(mct_systems[system]->name, why.text);
    }
    self.loop.hal.ops->open(self.loop.hal.context, NULL);
    run_ticks(&self, mode == MCT_MODE_BALANCE ? SETTLE_TICKS : 16);
    self.sim_start = self.sim;
    self.loop_start = self.loop;
    snprintf(name, sizeof name, "tick %s %s", mct_systems[system]->name, mct_mode_name(mode));
    measure(effort, name, run_ticks, restart_loop, &self, mode == MCT_MODE_SWING_UP ? SWING_UP_TICKS : 0);
    if (self.loop.controller.mode != mode || self.loop.supervisor.latched != 0 || self.ring.dropped != 0) {
        fail(name, "was not in that mode to the end, or faulted, or lost records");
    }
}

/* --- ticks over a bus within the process: the loop, the host's end, the drive's end and its plant --- */

typedef struct {
    mct_scene scene;
    mct_can_ring bus, bus_start;
    mct_can_drive drive, drive_start;
    mct_can can, can_start;
    mct_loop loop, loop_start; /* all refer to one another: copies come back to their place */
    mct_plan plan;
} bus_ticking;

static void restart_bus(void *context)
{
    bus_ticking *self = context;
    self->bus = self->bus_start;
    self->drive = self->drive_start;
    self->can = self->can_start;
    self->loop = self->loop_start;
}

static void run_bus_ticks(void *context, long count)
{
    bus_ticking *self = context;
    for (long k = 0; k < count; k++) {
        mct_loop_tick(&self->loop);
    }
}

static void measure_bus_ticks(const measure_effort *effort, int system, int32_t protocol)
{
    static bus_ticking self;
    mct_message why;
    char name[64];
    memset(&self, 0, sizeof self);
    mct_message_clear(&why);
    mct_scene_defaults(&self.scene, system);
    self.scene.controller = MCT_CONTROLLER_SWING_UP_BALANCE;
    self.scene.can_protocol = protocol;
    mct_can_ring_init(&self.bus);
    mct_status status = mct_can_drive_init(&self.drive, &self.scene, mct_can_ring_end(&self.bus, 1), &why);
    if (status == MCT_OK) {
        mct_can_drive_serve(&self.drive, &self.bus);
        status = mct_can_drive_open(&self.drive, &why);
    }
    status = status == MCT_OK
                 ? mct_can_init(&self.can, &self.scene, mct_can_ring_end(&self.bus, 0), true, &why)
                 : status;
    const mct_hal hal = mct_can_hal(&self.can);
    status = status == MCT_OK ? hal.ops->open(hal.context, &why) : status;
    status = status == MCT_OK
                 ? mct_loop_init(&self.loop, &self.plan, &self.scene, hal, NULL, (mct_samples){NULL, 0}, &why)
                 : status;
    if (status != MCT_OK) {
        fail(mct_systems[system]->name, why.text);
    }
    run_bus_ticks(&self, 16);
    self.bus_start = self.bus;
    self.drive_start = self.drive;
    self.can_start = self.can;
    self.loop_start = self.loop;
    snprintf(name, sizeof name, "bus %s %s", mct_systems[system]->name, self.can.axes.protocol->name);
    measure(effort, name, run_bus_ticks, restart_bus, &self, SWING_UP_TICKS);
    if (self.loop.supervisor.latched != 0) {
        fail(name, "faulted");
    }
}

int main(int argc, char **argv)
{
    const measure_effort effort = measure_effort_of(argc, argv);
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        if (mct_systems[system]->actuation == NULL) {
            continue;
        }
        measure_ticks(&effort, system, MCT_MODE_SWING_UP);
        measure_ticks(&effort, system, MCT_MODE_BALANCE);
        for (int32_t protocol = MCT_CAN_NATIVE; protocol <= MCT_CAN_ODRIVE; protocol++) {
            measure_bus_ticks(&effort, system, protocol);
        }
    }
    return 0;
}

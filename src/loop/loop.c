#include "mctau/loop.h"

#include <string.h>

mct_status mct_loop_init(mct_loop *loop, mct_plan *plan, const mct_scene *scene, mct_hal hal, mct_ring *ring,
                         mct_samples samples, mct_message *why)
{
    memset(loop, 0, sizeof *loop);
    memset(plan, 0, sizeof *plan);
    loop->plan = plan;
    loop->hal = hal;
    loop->ring = ring;
    loop->controlled = scene->controller != MCT_CONTROLLER_NONE;
    mct_input_init(&plan->input, scene, samples);
    mct_supervisor_init(&loop->supervisor, scene);
    return loop->controlled ? mct_controller_init(&loop->controller, &plan->model, scene, why) : MCT_OK;
}

/* The arrays are made for the largest system; of one with few coordinates the other half has never been set. */
static void copy_state(mct_state *to, const mct_state *from, int coordinates)
{
    enum { HALF = MCT_MAX_STATES / 2 };
    if (2 * coordinates + MCT_PHASES + 1 > HALF) {
        *to = *from;
        return;
    }
    memcpy(to->x, from->x, HALF * sizeof *to->x);
    memcpy(to->c, from->c, HALF * sizeof *to->c);
    memcpy(to->turns, from->turns, MCT_MAX_ENCODERS * sizeof *to->turns);
}

/* Fills the record of this tick but for what the HAL alone knows. */
static void observe_hal(mct_loop *loop, mct_record *record)
{
    const mct_state *plant = loop->hal.ops->plant(loop->hal.context);
    const mct_timing *timing = loop->hal.ops->timing(loop->hal.context);
    if (plant != NULL) {
        copy_state(&record->plant, plant, loop->supervisor.system->coordinate_count);
    }
    record->late_us = timing->lateness.latest_us;
    if (loop->ring != NULL) {
        record->dropped = loop->ring->dropped;
    }
}

void mct_loop_rearm(mct_loop *loop)
{
    __atomic_store_n(&loop->rearm, true, __ATOMIC_RELAXED);
}

/* Clears faults when somebody asks for it or when the scene does; the drives are armed again. */
static void rearm(mct_loop *loop)
{
    mct_supervisor *supervisor = &loop->supervisor;
    const bool asked = __atomic_load_n(&loop->rearm, __ATOMIC_RELAXED);
    if (asked) {
        __atomic_store_n(&loop->rearm, false, __ATOMIC_RELAXED);
    }
    loop->record.rearmed = supervisor->latched != 0 && (asked || mct_supervisor_wants_rearm(supervisor));
    if (!loop->record.rearmed) {
        return;
    }
    if (loop->controlled && (supervisor->latched & (1u << MCT_FAULT_RESTARTED))) {
        mct_controller_restart(&loop->controller);
    }
    mct_supervisor_rearm(supervisor);
    loop->hal.ops->arm(loop->hal.context);
}

void mct_loop_tick(mct_loop *loop)
{
    const mct_hal_ops *hal = loop->hal.ops;
    mct_supervisor *supervisor = &loop->supervisor;
    mct_record *record = &loop->record;
    record->tick = loop->tick;
    rearm(loop);
    const bool was_well = supervisor->latched == 0;
    observe_hal(loop, record);
    if (hal->read(loop->hal.context, &record->reading) != MCT_OK) {
        record->reading.flags |= MCT_READING_MISSING;
        mct_supervisor_fault(supervisor, MCT_FAULT_HAL);
    }
    const mct_real *estimate = NULL;
    if (loop->controlled) {
        record->wanted = mct_controller_update(&loop->controller, &record->reading, loop->applied);
        record->mode = (int32_t)loop->controller.mode;
        estimate = loop->controller.observer.x;
        memcpy(record->estimate, estimate, sizeof record->estimate);
        mct_supervisor_watch_balance(supervisor, record->mode == MCT_MODE_BALANCE);
    } else {
        record->mode = MCT_MODE_OPEN_LOOP;
        record->wanted = mct_input_at(&loop->plan->input, loop->tick);
    }
    record->applied = mct_supervisor_pass(supervisor, &record->reading, estimate, record->wanted);
    if (was_well && supervisor->latched != 0) {
        hal->stop(loop->hal.context);
    }
    if (hal->write(loop->hal.context, record->applied) != MCT_OK) {
        mct_supervisor_fault(supervisor, MCT_FAULT_HAL);
        hal->stop(loop->hal.context);
        record->applied = 0;
    }
    loop->applied = record->applied;
    record->faults = supervisor->latched;
    if (record->faults != 0) {
        record->mode = MCT_MODE_STOPPED;
    }
    if (loop->ring != NULL) {
        mct_ring_push(loop->ring, record);
    }
    loop->tick++;
    if (hal->wait_tick(loop->hal.context) != MCT_OK) {
        mct_supervisor_fault(supervisor, MCT_FAULT_HAL);
    }
}

#include "mctau/supervisor.h"

#include <string.h>

static const struct {
    const char *name;
    const char *text;
} faults[MCT_FAULT_COUNT] = {
    [MCT_FAULT_SENSOR_INVALID] =
        {"sensor_invalid", "a sensor gave a value that is not a number; look at its wiring and its drive"},
    [MCT_FAULT_SENSOR_STALE] =
        {"sensor_stale", "no valid feedback for too long; look at the drive's message rate and the bus"},
    [MCT_FAULT_SENSOR_FROZEN] =
        {"sensor_frozen",
         "the motor was driven but its encoder did not move; look for a blocked motor or a loose encoder"},
    [MCT_FAULT_ESTIMATE] = {"estimate_not_finite", "an estimated state was not a number"},
    [MCT_FAULT_COMMAND] = {"command_not_finite",
                           "the controller or the input asked for a voltage that is not a number"},
    [MCT_FAULT_TRACK_END] = {"track_end", "the cart left its track; look at controller.track_half_length"},
    [MCT_FAULT_OVERSPEED] = {"overspeed", "the driven axis turned faster than controller.overspeed"},
    [MCT_FAULT_HAL] = {"hal_error", "the hardware layer could not read or write"},
    [MCT_FAULT_STOPPED] = {"stopped", "the run was stopped from outside"},
};

const char *mct_fault_name(mct_fault fault)
{
    return faults[fault].name;
}

const char *mct_fault_text(mct_fault fault)
{
    return faults[fault].text;
}

void mct_supervisor_init(mct_supervisor *supervisor, const mct_scene *scene)
{
    enum { DERATE_US = 3000, STALE_US = 5000, FROZEN_MS = 250 };
    const mct_system *system = mct_systems[scene->system];
    const uint32_t tick_us = (uint32_t)(scene->dt * 1e6 + 0.5);
    memset(supervisor, 0, sizeof *supervisor);
    supervisor->system = system;
    supervisor->observed = scene->controller != MCT_CONTROLLER_NONE;
    supervisor->limit = MCT_REAL_MAX;
    supervisor->watch_limit = MCT_REAL_MAX;
    if (scene->effects & MCT_MOTOR) {
        if (scene->effects & MCT_SATURATION) {
            supervisor->limit = (mct_real)scene->parameters[system->supply_parameter];
        }
        supervisor->watch_limit = (mct_real)(0.5 * scene->parameters[system->supply_parameter]);
    }
    /* Feedback ages in ticks: a loop slower than 1 kHz waits three of them. */
    supervisor->derate_us = tick_us * 2 > DERATE_US ? tick_us * 2 : DERATE_US;
    supervisor->stale_us = tick_us * 3 > STALE_US ? tick_us * 3 : STALE_US;
    supervisor->frozen_limit = (uint32_t)(FROZEN_MS * 1e-3 / scene->dt) + 1;
    supervisor->track_half_length = (mct_real)scene->track_half_length;
    supervisor->overspeed = (mct_real)scene->overspeed;
}

void mct_supervisor_fault(mct_supervisor *supervisor, mct_fault fault)
{
    supervisor->latched |= 1u << fault;
    supervisor->counts[fault]++;
    supervisor->armed = false;
}

void mct_supervisor_rearm(mct_supervisor *supervisor)
{
    supervisor->latched = 0;
    supervisor->frozen_ticks = 0;
}

static mct_real size_of(mct_real value)
{
    return value < 0 ? -value : value;
}

static void watch_estimate(mct_supervisor *supervisor, const mct_real *estimate)
{
    const mct_system *system = supervisor->system;
    const int n = system->coordinate_count;
    const int driven = system->driven_coordinate;
    for (int i = 0; i < 2 * n; i++) {
        if (!mct_finite(estimate[i])) {
            mct_supervisor_fault(supervisor, MCT_FAULT_ESTIMATE);
            return;
        }
    }
    if (!system->coordinates[driven].is_angle) {
        if (size_of(estimate[driven]) > supervisor->track_half_length) {
            mct_supervisor_fault(supervisor, MCT_FAULT_TRACK_END);
        }
    } else if (size_of(estimate[n + driven]) > supervisor->overspeed) {
        mct_supervisor_fault(supervisor, MCT_FAULT_OVERSPEED);
    }
}

/*
 * A motor under more than half its supply that does not move a count for a quarter of a second is blocked or
 * blind.
 */
static void watch_motion(mct_supervisor *supervisor, const mct_reading *reading, mct_real wanted)
{
    const int32_t counts = reading->counts[supervisor->system->driven_coordinate];
    const bool driven = supervisor->armed && size_of(wanted) > supervisor->watch_limit;
    supervisor->frozen_ticks = driven && counts == supervisor->last_counts ? supervisor->frozen_ticks + 1 : 0;
    supervisor->last_counts = counts;
    if (supervisor->frozen_ticks > supervisor->frozen_limit) {
        mct_supervisor_fault(supervisor, MCT_FAULT_SENSOR_FROZEN);
        supervisor->frozen_ticks = 0;
    }
}

mct_real mct_supervisor_pass(mct_supervisor *supervisor, const mct_reading *reading, const mct_real *estimate,
                             mct_real wanted)
{
    if (reading->flags & MCT_READING_INVALID) {
        mct_supervisor_fault(supervisor, MCT_FAULT_SENSOR_INVALID);
    }
    if (reading->age_us >= supervisor->stale_us) {
        mct_supervisor_fault(supervisor, MCT_FAULT_SENSOR_STALE);
    }
    if (!mct_finite(wanted)) {
        mct_supervisor_fault(supervisor, MCT_FAULT_COMMAND);
    }
    if (estimate != NULL) {
        watch_estimate(supervisor, estimate);
    }
    watch_motion(supervisor, reading, wanted);
    if (supervisor->latched != 0) {
        return 0;
    }
    if (!supervisor->armed) {
        if (reading->flags != 0) {
            return 0;
        }
        supervisor->armed = true;
    }
    mct_real passed = wanted;
    if (passed > supervisor->limit || passed < -supervisor->limit) {
        passed = passed > 0 ? supervisor->limit : -supervisor->limit;
        supervisor->limited_ticks++;
    }
    if (reading->age_us > supervisor->derate_us) {
        const uint32_t left = supervisor->stale_us - reading->age_us;
        passed *= (mct_real)left / (mct_real)(supervisor->stale_us - supervisor->derate_us);
        supervisor->derated_ticks++;
    }
    return passed;
}

#include "mctau/supervisor.h"

#include <string.h>

#define MOST_STEPS MCT_R(1e9) /* whole numbers that fit an int32_t */

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
    [MCT_FAULT_LINK_DOWN] = {"link_down",
                             "nothing could be sent to the drive; look at the bus and its interface"},
    [MCT_FAULT_NOT_READY] = {"drive_not_ready",
                             "the drive ceased to obey commands; look at its supply and its watchdog"},
    [MCT_FAULT_DRIVE] = {"drive_fault", "a drive reported an error; look it up in the drive's manual"},
    [MCT_FAULT_RESTARTED] = {"drive_restarted", "a drive restarted and forgot its position; bring the "
                                                "mechanism to its initial position, then re-arm"},
    [MCT_FAULT_ESTOP] = {"estop", "an emergency stop was called on the bus"},
    [MCT_FAULT_NO_BALANCE] =
        {"no_balance", "the motor was driven for too long without balancing; look at its supply, at the "
                       "encoders' counts and noise, and at controller.give_up_after"},
    [MCT_FAULT_ENERGY] = {"energy",
                          "the simulation gained energy from nowhere: its steps do not follow the motion; "
                          "take more scene.substeps, a smaller scene.dt or another stepper"},
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
        const double supply = scene->parameters[system->actuation->supply_parameter];
        supervisor->steps_per_volt = supervisor->observed ? MCT_STEPS_PER_VOLT : 0;
        if (scene->effects & MCT_SATURATION_VOLTAGE) {
            const double whole = (double)(int64_t)(supply * MCT_STEPS_PER_VOLT + 1e-6);
            supervisor->limit =
                supervisor->observed ? (mct_real)whole / MCT_STEPS_PER_VOLT : (mct_real)supply;
        }
        supervisor->watch_limit = (mct_real)(0.5 * supply);
    }
    /* Feedback ages in ticks: a loop slower than 1 kHz waits three of them. */
    supervisor->derate_us = tick_us * 2 > DERATE_US ? tick_us * 2 : DERATE_US;
    supervisor->stale_us = tick_us * 3 > STALE_US ? tick_us * 3 : STALE_US;
    supervisor->frozen_limit = (uint32_t)(FROZEN_MS * 1e-3 / scene->dt) + 1;
    supervisor->track_half_length = (mct_real)scene->track_half_length;
    supervisor->overspeed = (mct_real)scene->overspeed;
    supervisor->give_up_limit = (uint64_t)(scene->give_up_after / scene->dt + 0.5);
    supervisor->rearm_limit = (uint32_t)(scene->rearm_after / scene->dt + 0.5);
}

void mct_supervisor_fault(mct_supervisor *supervisor, mct_fault fault)
{
    supervisor->latched |= 1u << fault;
    supervisor->counts[fault]++;
    supervisor->armed = false;
    supervisor->good_ticks = 0;
}

bool mct_supervisor_wants_rearm(const mct_supervisor *supervisor)
{
    return supervisor->rearm_limit > 0 && supervisor->good_ticks == supervisor->rearm_limit;
}

void mct_supervisor_rearm(mct_supervisor *supervisor)
{
    supervisor->latched = 0;
    supervisor->frozen_ticks = 0;
    supervisor->restless_ticks = 0;
    supervisor->good_ticks = 0;
    supervisor->rearmed++;
}

void mct_supervisor_watch_balance(mct_supervisor *supervisor, bool is_balancing)
{
    if (is_balancing || !supervisor->armed) {
        supervisor->restless_ticks -= supervisor->restless_ticks > 0;
    } else if (++supervisor->restless_ticks > supervisor->give_up_limit && supervisor->give_up_limit > 0) {
        mct_supervisor_fault(supervisor, MCT_FAULT_NO_BALANCE);
    }
}

static mct_real size_of(mct_real value)
{
    return value < 0 ? -value : value;
}

static void watch_estimate(mct_supervisor *supervisor, const mct_real *estimate)
{
    const mct_system *system = supervisor->system;
    const int n = system->coordinate_count;
    const int driven = system->actuation->driven_coordinate;
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
    const mct_actuation *actuation = supervisor->system->actuation;
    const int32_t counts = actuation != NULL ? reading->counts[actuation->driven_coordinate] : 0;
    const bool driven = supervisor->armed && size_of(wanted) > supervisor->watch_limit;
    supervisor->frozen_ticks = driven && counts == supervisor->last_counts ? supervisor->frozen_ticks + 1 : 0;
    supervisor->last_counts = counts;
    if (supervisor->frozen_ticks > supervisor->frozen_limit) {
        mct_supervisor_fault(supervisor, MCT_FAULT_SENSOR_FROZEN);
        supervisor->frozen_ticks = 0;
    }
}

static void watch_flags(mct_supervisor *supervisor, uint32_t flags)
{
    static const struct {
        uint32_t flag;
        mct_fault fault;
    } meanings[] = {
        {MCT_READING_INVALID, MCT_FAULT_SENSOR_INVALID},
        {MCT_READING_LINK_DOWN, MCT_FAULT_LINK_DOWN},
        {MCT_READING_DRIVE_FAULT, MCT_FAULT_DRIVE},
        {MCT_READING_RESTARTED, MCT_FAULT_RESTARTED},
        {MCT_READING_ESTOP, MCT_FAULT_ESTOP},
    };
    if (flags == 0) {
        return; /* as nearly always */
    }
    for (size_t i = 0; i < sizeof meanings / sizeof meanings[0]; i++) {
        if (flags & meanings[i].flag) {
            mct_supervisor_fault(supervisor, meanings[i].fault);
        }
    }
    if (supervisor->armed && (flags & MCT_READING_NOT_READY)) {
        mct_supervisor_fault(supervisor, MCT_FAULT_NOT_READY);
    }
}

/* Whole millivolts, never beyond the limit, which is whole itself. */
static mct_real rounded(const mct_supervisor *supervisor, mct_real volts)
{
    if (supervisor->steps_per_volt == 0) {
        return volts;
    }
    const mct_real steps = mct_clamp(volts * supervisor->steps_per_volt, MOST_STEPS);
    const mct_real whole = (mct_real)(int32_t)(steps < 0 ? steps - MCT_R(0.5) : steps + MCT_R(0.5));
    return mct_clamp(whole / supervisor->steps_per_volt, supervisor->limit);
}

mct_real mct_supervisor_pass(mct_supervisor *supervisor, const mct_reading *reading, const mct_real *estimate,
                             mct_real wanted)
{
    watch_flags(supervisor, reading->flags);
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
        const uint32_t lasting =
            MCT_READING_NOT_READY | MCT_READING_DRIVE_FAULT; /* until the drive is armed */
        supervisor->good_ticks += (reading->flags & ~lasting) == 0;
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
    return rounded(supervisor, passed);
}

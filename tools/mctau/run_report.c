/* The result of a run, for scripts and for people. */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "json.h"
#include "ledger.h"
#include "mctau/stepper.h"
#include "mctau/supervisor.h"
#include "run.h"

#define DEGREES 57.29577951308232

static double time_of(const run_report *report)
{
    return (double)report->result.ticks * report->scene->scene.dt;
}

static bool is_process(const run_report *report)
{
    return mct_systems[report->scene->scene.system]->is_process;
}

static bool was_seen(const run_result *result, int fault)
{
    return result->faults[fault] > 0 || (result->latched & (1u << fault)) != 0;
}

/* --- JSON --- */

static void json_time(json *out, const char *key, double time)
{
    json_number(out, key, time >= 0 ? time : (double)NAN);
}

static void json_ledger(json *out, const ledger_result *result, const mct_scene *scene)
{
    json_object(out, "ledger");
    json_powers(out, "works", &result->work, scene);
    json_energies(out, "stepper", &result->of_stepper);
    json_energies(out, "unexplained", &result->unexplained);
    json_energies(out, "gain", &result->gain);
    json_number(out, "size", result->size);
    json_count(out, "lost_ticks", result->lost_ticks);
    json_end_object(out);
}

static void json_faults(json *out, const run_result *result)
{
    json_list(out, "faults");
    for (int i = 0; i < MCT_FAULT_COUNT; i++) {
        if (was_seen(result, i)) {
            json_text(out, NULL, mct_fault_name((mct_fault)i));
        }
    }
    json_end_list(out);
    json_object(out, "fault_ticks");
    for (int i = 0; i < MCT_FAULT_COUNT; i++) {
        if (was_seen(result, i)) {
            json_count(out, mct_fault_name((mct_fault)i), result->faults[i]);
        }
    }
    json_end_object(out);
    json_time(out, "fault_at", result->fault_at);
}

static void json_timing(json *out, const run_result *result)
{
    const mct_timing *timing = &result->timing;
    double lateness[MCT_HISTOGRAM_BINS];
    for (int i = 0; i < MCT_HISTOGRAM_BINS; i++) {
        lateness[i] = (double)timing->lateness.bins[i];
    }
    json_object(out, "timing");
    json_count(out, "missed_ticks", timing->missed_ticks);
    json_count(out, "worst_late_us", timing->lateness.worst_us);
    json_count(out, "worst_work_us", timing->work.worst_us);
    json_count(out, "worst_round_trip_us", timing->round_trip.worst_us);
    json_boolean(out, "has_priority", result->has_priority);
    json_boolean(out, "has_memory", result->has_memory);
    json_vector(out, "lateness", lateness, MCT_HISTOGRAM_BINS);
    json_end_object(out);
}

static void json_telemetry(json *out, const run_result *result)
{
    json_object(out, "telemetry");
    json_count(out, "dropped", result->dropped);
    json_count(out, "published", result->published);
    json_count(out, "publish_errors", result->publish_errors);
    json_count(out, "logged", result->logged);
    json_count(out, "log_errors", result->log_errors);
    json_end_object(out);
}

static void json_can(json *out, const run_result *result)
{
    const mct_can_report *can = &result->can;
    json_object(out, "can");
    json_number(out, "nominal_load", can->nominal_load);
    json_number(out, "load", can->load);
    json_boolean(out, "watchdog_verified", can->watchdog_verified);
    json_number(out, "bus_voltage", can->bus_voltage);
    json_list(out, "messages");
    for (int i = 0; i < can->heard_count; i++) {
        const mct_can_heard *heard = &can->heard[i];
        json_object(out, NULL);
        json_text(out, "name", heard->message->name);
        json_count(out, "node", heard->node);
        json_count(out, "id", heard->id);
        json_number(out, "period", heard->period);
        json_number(out, "slowest", heard->slowest);
        json_end_object(out);
    }
    json_end_list(out);
    if (result->has_recording) {
        json_object(out, "recording");
        json_count(out, "compared", result->compared);
        json_count(out, "mismatches", result->mismatches);
        json_count(out, "unmatched", result->unmatched);
        json_end_object(out);
    }
    json_end_object(out);
}

void print_run_json(const run_report *report, FILE *file)
{
    const run_result *result = &report->result;
    const mct_scene *scene = &report->scene->scene;
    const arguments *given = report->scene->given;
    json out = json_begin(file, "mctau.run/1");
    json_text(&out, "version", MCT_VERSION);
    json_text(&out, "scene", report->scene->path);
    json_list(&out, "overrides");
    for (int i = 0; i < given->override_count; i++) {
        json_text(&out, NULL, given->overrides[i].assignment);
    }
    json_end_list(&out);
    json_text(&out, "system", mct_systems[scene->system]->name);
    json_text(&out, "stepper", mct_steppers[scene->stepper].name);
    json_text(&out, "precision", report->scene->runner->precision);
    json_number(&out, "dt", scene->dt);
    json_count(&out, "ticks", result->ticks);
    json_number(&out, "time", time_of(report));
    json_object(&out, "state");
    for (int i = 0; i < result->states; i++) {
        json_number(&out, result->names[i], result->state[i]);
    }
    json_end_object(&out);
    json_object(&out, "state_hex");
    for (int i = 0; i < result->states; i++) {
        json_hex(&out, result->names[i], result->state[i]);
    }
    json_end_object(&out);
    if (result->has_energy) {
        json_number(&out, "energy", energy_total(result->energy));
        json_number(&out, "energy_start", energy_total(result->energy_start));
        json_energies(&out, "energies", &result->energy);
    }
    if (report->options->ledger != NULL) {
        json_ledger(&out, &report->ledger, scene);
    }
    json_faults(&out, result);
    json_text(&out, "verdict", verdict_name(report->verdict));
    json_time(&out, "upright_at", result->upright_at);
    json_time(&out, "worst_after_upright", result->upright_at >= 0 ? result->worst_after_upright : -1);
    json_number(&out, "worst_last_second", result->stopped ? (double)NAN : result->worst_last_second);
    json_number(&out, "deviation", result->deviation);
    json_text(&out, "mode", result->mode);
    json_object(&out, "counters");
    json_count(&out, "saturated_ticks", result->saturated_ticks);
    json_count(&out, "limited_ticks", result->limited_ticks);
    json_count(&out, "derated_ticks", result->derated_ticks);
    json_count(&out, "rejected_inputs", result->rejected_inputs);
    json_count(&out, "diverged_ticks", result->diverged_ticks);
    json_count(&out, "rearmed", result->rearmed);
    for (int i = 0; i < result->counter_count; i++) {
        json_count(&out, result->counters[i].name, result->counts[i]);
    }
    json_end_object(&out);
    if (result->has_can) {
        json_can(&out, result);
    }
    if (result->realtime) {
        json_timing(&out, result);
    }
    if (scene->log[0] != '\0' || scene->lcm[0] != '\0') {
        json_telemetry(&out, result);
    }
    json_number(&out, "ns_per_tick", result->ns_per_tick);
    json_finish(&out);
}

/* --- for people --- */

/* A process has no time: its energy is half the square of how far it has to go. */
static void print_updates(const run_report *report, FILE *file)
{
    const run_result *result = &report->result;
    fprintf(file, "Finished: %" PRIu64 " updates; the tip is %.3g m from its target, %.3g m at the start.\n",
            result->ticks * (uint64_t)report->scene->scene.substeps, sqrt(2 * result->energy.potential),
            sqrt(2 * result->energy_start.potential));
}

static void print_verdict(const run_report *report, FILE *file)
{
    const run_result *result = &report->result;
    const double time = time_of(report);
    switch (report->verdict) {
    case BALANCED:
        fprintf(file, "Balanced: upright (within 2 deg) since %.3f s; in the last second within %.3f deg.\n",
                result->upright_at, result->worst_last_second * DEGREES);
        break;
    case NOT_BALANCED:
        if (result->upright_at >= 0) {
            fprintf(file, "Not balanced yet: upright since %.3f s, which is less than a second ago.\n",
                    result->upright_at);
        } else {
            fprintf(file,
                    "Not balanced: %.1f deg from upright at the end, %.1f deg at the nearest; the controller "
                    "was in mode %s.\n",
                    result->deviation * DEGREES, result->least_deviation * DEGREES, result->mode);
        }
        break;
    case FAULTED:
        fprintf(file, "Faulted at %.3f s: zero volts from there on.\n", result->fault_at);
        break;
    case DIVERGED:
        fprintf(file,
                "Diverged: on %" PRIu64
                " ticks the simulation left all bounds; the last sane state was kept.\n",
                result->diverged_ticks);
        break;
    case STOPPED:
        fprintf(file, "Stopped from outside at %.3f s, at zero volts.\n", time);
        break;
    case FINISHED:
        if (is_process(report)) {
            print_updates(report, file);
            break;
        }
        fprintf(file, "Finished: %g s of %s motion.\n", time,
                report->scene->scene.input == MCT_INPUT_NONE ? "free" : "open-loop");
        break;
    }
}

static void print_state(const run_report *report, FILE *file)
{
    const run_result *result = &report->result;
    if (result->states == 0) {
        return;
    }
    fprintf(file, "\nState at %g s%s\n", time_of(report), result->has_energy ? "" : ", as estimated");
    for (int i = 0; i < result->states; i++) {
        const double value = result->state[i];
        const bool is_angle = strcmp(result->units[i], "rad") == 0;
        fprintf(file, "  %-16s %14.6g %-6s", result->names[i], value, result->units[i]);
        if (is_angle) {
            const double turns = nearbyint(value * DEGREES / 360);
            fprintf(file, " %9.3f deg", value * DEGREES - 360 * turns);
            if (turns != 0) {
                fprintf(file, " %+.0f turn%s", turns, fabs(turns) > 1 ? "s" : "");
            }
        }
        fputc('\n', file);
    }
}

static void print_energy(const run_result *result, FILE *file)
{
    print_energies_head(file, "Energy [J]");
    print_energies(file, "at the start", &result->energy_start);
    print_energies(file, "at the end", &result->energy);
}

static void print_ledger(const run_report *report, FILE *file)
{
    const ledger_result *book = &report->ledger;
    print_energies_head(file, "Ledger [J]: work of each effect");
    print_powers(file, &book->work, &report->scene->scene);
    print_energies(file, "stepper", &book->of_stepper);
    print_energies(file, "unexplained", &book->unexplained);
    print_energies(file, "gain", &book->gain);
    if (book->lost_ticks > 0) {
        fprintf(file, "  %" PRIu64 " ticks could not be followed; what they gained is left unexplained\n",
                book->lost_ticks);
    }
}

static void print_share(FILE *file, const char *what, uint64_t ticks, uint64_t all)
{
    if (ticks > 0) {
        fprintf(file, "  %s on %" PRIu64 " of %" PRIu64 " ticks (%.1f %%)\n", what, ticks, all,
                100 * (double)ticks / (double)all);
    }
}

static void print_faults(const run_report *report, FILE *file)
{
    const run_result *result = &report->result;
    bool any = false;
    for (int i = 0; i < MCT_FAULT_COUNT; i++) {
        if (was_seen(result, i)) {
            fprintf(file, "%s  %s, seen on %" PRIu64 " ticks: %s\n", any ? "" : "\nFaults\n",
                    mct_fault_name((mct_fault)i), result->faults[i], mct_fault_text((mct_fault)i));
            any = true;
        }
    }
    if (!any) {
        fputs("\nFaults: none\n", file);
    }
    if (result->rearmed > 0) {
        fprintf(file, "  armed again after faults: %" PRIu64 " time%s\n", result->rearmed,
                result->rearmed > 1 ? "s" : "");
    }
    char limited[64];
    snprintf(limited, sizeof limited, "the voltage was at its limit of %g V", result->limit);
    print_share(file, limited, result->saturated_ticks, result->ticks);
    print_share(file, "the voltage was reduced because feedback was late", result->derated_ticks,
                result->ticks);
    print_share(file, "the plant refused an input that was not finite", result->rejected_inputs,
                result->ticks);
}

/* What the start found on the bus. */
void print_start(const mct_can_report *can, FILE *file)
{
    fprintf(file, "Bus load %.0f %% (%.0f %% without stuff bits)", 100 * can->load, 100 * can->nominal_load);
    if (can->bus_voltage > 0) {
        fprintf(file, ", supply %.1f V", can->bus_voltage);
    }
    fprintf(file, "; the drive's watchdog %s\n",
            can->watchdog_verified ? "was seen to act"
            : can->watchdog_tells  ? "is not used (can.watchdog = 0)"
                                   : "cannot be tried over this protocol: make sure of it in the drive");
    for (int i = 0; i < can->heard_count; i++) {
        const mct_can_heard *heard = &can->heard[i];
        const bool too_often = heard->message->period == 0 && heard->period < 0.7 * heard->slowest / 3;
        fprintf(file, "  node %2d  %-28s every %8.2f ms (allowed up to %g ms)%s\n", heard->node,
                heard->message->name, 1e3 * heard->period, 1e3 * heard->slowest,
                too_often ? "; more than once a tick: two drives with this number?" : "");
    }
}

static void print_can(const run_result *result, FILE *file)
{
    fputs("\nOn the bus\n", file);
    for (int i = 0; i < result->counter_count; i++) {
        if (result->counts[i] > 0) {
            fprintf(file, "  %-16s %9" PRIu64 "  %s\n", result->counters[i].name, result->counts[i],
                    result->counters[i].doc);
        }
    }
    if (result->has_recording) {
        fprintf(file,
                "  commands against the recorded ones: %" PRIu64 " found, %" PRIu64
                " of them differ; %" PRIu64 " not found\n",
                result->compared, result->mismatches, result->unmatched);
    }
    const mct_histogram *round_trip = &result->timing.round_trip;
    if (round_trip->worst_us > 0) {
        fprintf(file, "  from a command to its answer at most %" PRIu32 " us\n", round_trip->worst_us);
    }
}

static void print_timing(const run_result *result, FILE *file)
{
    enum { WIDTH = 50 };
    const mct_timing *timing = &result->timing;
    uint64_t most = 1;
    for (int i = 0; i < MCT_HISTOGRAM_BINS; i++) {
        most = timing->lateness.bins[i] > most ? timing->lateness.bins[i] : most;
    }
    fprintf(file,
            "\nClock: latest wake-up %" PRIu32 " us late, longest tick %" PRIu32 " us of work, %" PRIu64
            " ticks missed\n",
            timing->lateness.worst_us, timing->work.worst_us, timing->missed_ticks);
    if (!result->has_priority || !result->has_memory) {
        fprintf(file, "  without%s%s%s: run as root, or raise the limits rtprio and memlock\n",
                result->has_priority ? "" : " real-time priority",
                !result->has_priority && !result->has_memory ? " and" : "",
                result->has_memory ? "" : " locked memory");
    }
    for (int i = 0; i < MCT_HISTOGRAM_BINS; i++) {
        if (timing->lateness.bins[i] > 0) {
            fprintf(file, "  below %9.0f us %8" PRIu64 "  %.*s\n", ldexp(1, i), timing->lateness.bins[i],
                    (int)(1 + (WIDTH - 1) * timing->lateness.bins[i] / most),
                    "##################################################");
        }
    }
}

static void print_speed(const run_report *report, FILE *file)
{
    const run_result *result = &report->result;
    const double loop_s = 1e-9 * result->ns_per_tick * (double)result->ticks;
    if (loop_s <= 0) {
        return;
    }
    fprintf(file, "\nSpeed: %.0f ns per tick", result->ns_per_tick);
    if (!is_process(report)) {
        fprintf(file, ", %.0f times as fast as the mechanism itself", time_of(report) / loop_s);
    }
    fputs("\n", file);
}

static void print_files(const run_report *report, FILE *file)
{
    const run_result *result = &report->result;
    const run_options *options = report->options;
    const bool has_csv = options->csv != NULL && options->csv[0] != '\0' && result->csv_errno == 0;
    const bool has_log = options->log[0] != '\0';
    const bool has_lcm = options->lcm[0] != '\0';
    if (!has_csv && !has_log && !has_lcm) {
        return;
    }
    fputs("\nWritten\n", file);
    if (has_csv) {
        fprintf(file, "  %s: %" PRIu64 " rows\n", options->csv, result->csv_rows);
    }
    if (has_log) {
        fprintf(file, "  %s: %" PRIu64 " records", options->log, result->logged);
        fprintf(file, result->log_errors > 0 ? ", %" PRIu64 " events did not fit\n" : "\n",
                result->log_errors);
    }
    if (has_lcm) {
        fprintf(file, "  %s: %" PRIu64 " records published, %" PRIu64 " errors\n", options->lcm,
                result->published, result->publish_errors);
    }
    if (result->dropped > 0) {
        fprintf(file,
                "  %" PRIu64
                " records were dropped because telemetry could not keep up; no tick waited for it\n",
                result->dropped);
    }
}

/* What to do next, by what has happened. */
static void print_next(const run_report *report, FILE *file)
{
    const run_result *result = &report->result;
    const run_options *options = report->options;
    const char *path = report->scene->path;
    const char *mctau = report->scene->given->program;
    fputs("\nNext\n", file);
    if (report->verdict == DIVERGED) {
        fprintf(file,
                "  a smaller step (--dt, --set scene.substeps=10) or another --stepper; %s list tells which "
                "suit\n",
                mctau);
    } else if (report->verdict == NOT_BALANCED && result->upright_at >= 0) {
        fprintf(file, "  a longer --duration\n");
    } else if (report->verdict == NOT_BALANCED) {
        fprintf(file,
                "  a longer --duration, if it still swings up; more voltage or torque (supply_voltage, "
                "torque_constant)\n"
                "  if it never got near; gentler weights ([weights], controller.input_weight) if it fell\n");
    } else if (report->verdict == FAULTED) {
        fprintf(file,
                "  the rows around %.3f s in --csv show what the sensors said and what the motor was given\n",
                result->fault_at);
    }
    if (options->log[0] != '\0' && result->log_errors == 0) {
        fprintf(file, "  %s replay %s   runs it again from its log and proves the same bits\n", mctau,
                options->log);
    }
    if (options->csv == NULL) {
        fprintf(file, "  %s run %s --csv run.csv   writes every tick, for a plot\n", mctau, path);
    }
    fprintf(file, "  %s mct %s   shows M, C, tau and the constraint forces at the initial state\n", mctau,
            path);
}

void print_run(const run_report *report, FILE *file)
{
    const mct_scene *scene = &report->scene->scene;
    fprintf(file, "%s: %s, stepper %s, precision %s, tick %g s, %" PRIu64 " ticks\n\n",
            strcmp(report->scene->path, "-") == 0 ? "standard input" : report->scene->path,
            mct_systems[scene->system]->name, mct_steppers[scene->stepper].name,
            report->scene->runner->precision, scene->dt, report->result.ticks);
    print_verdict(report, file);
    print_state(report, file);
    if (report->result.has_energy && !is_process(report)) {
        print_energy(&report->result, file);
    }
    if (report->options->ledger != NULL) {
        print_ledger(report, file);
    }
    print_faults(report, file);
    if (report->result.has_can) {
        print_can(&report->result, file);
    }
    if (report->result.realtime) {
        print_timing(&report->result, file);
    } else {
        print_speed(report, file);
    }
    print_files(report, file);
    print_next(report, file);
}

/* mctau drive: the drives and the mechanism of a scene, simulated, on a CAN interface. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "json.h"
#include "mctau/stepper.h"
#include "pick.h"
#include "say.h"
#include "scene_file.h"
#include "verbs.h"

#define DEGREES 57.29577951308232

static const option options[] = {
    {"can", "IFACE", NULL, "the interface, such as vcan0 or can0; must be given"},
    {"protocol", "NAME", "can.protocol", NULL},
    {"lockstep", NULL, "can.lockstep",
     "each command is a tick, instead of the clock; the host's can.lockstep, too"},
    {"duration", "S", "scene.duration",
     "ends after so much of the mechanism's time; left out: runs until it is stopped"},
    {"fault", "KIND", "can.fault", NULL},
    {"fault-time", "S", "can.fault_time", "when, in the mechanism's time"},
    {"fault-duration", "S", "can.fault_duration", NULL},
    {"precision", "NAME", "scene.precision", NULL},
    OPTION_SET,
    {"csv", "FILE", NULL,
     "one row a tick: time, the mechanism's true states, volts at the motor; - is stdout"},
    OPTION_JSON,
    {NULL, NULL, NULL, NULL},
};

static int drive_verb(const arguments *given);

const verb verb_drive = {
    .name = "drive",
    .doc = "simulates a scene's drives and mechanism on a CAN interface, for a host to control",
    .operand = "SCENE",
    .text =
        "Puts the drives of a scene's [can] on a CAN interface, with the scene's mechanism behind them: they "
        "answer as real\n"
        "ones would and keep their rules (watchdog, volts, emergency stop). SCENE is a TOML file; - reads it "
        "from stdin.\n"
        "The mechanism is held until a host arms the motor's drive. Then it moves by the clock, or, with "
        "--lockstep, a tick\n"
        "for each command. Runs until it is stopped (Ctrl-C) or --duration is over, and tells what became of "
        "the motor.\n"
        "A fault of [can] befalls its frames, to see what the host makes of it.",
    .options = options,
    .examples =
        "  sudo ip link add vcan0 type vcan && sudo ip link set vcan0 up    a virtual bus, on Linux\n"
        "  mctau drive scenes/reaction_wheel.toml --can vcan0\n"
        "  mctau run scenes/reaction_wheel.toml --hal socketcan:vcan0       in another terminal\n"
        "  mctau drive scenes/cart_pole.toml --can vcan0 --protocol odrive --duration 30 --csv truth.csv\n"
        "  mctau drive scenes/reaction_wheel.toml --can vcan0 --fault reboot --fault-time 12\n",
    .exit_codes = "  0    its duration is over, or it was stopped (Ctrl-C, SIGTERM)\n"
                  "  1    the simulation diverged\n"
                  "  2    the command line or the scene is wrong\n"
                  "  3    no such CAN interface, or it cannot be used; a file could not be read or written\n",
    .run = drive_verb,
};

/* --- stopping from outside --- */

/* Set by a signal; a signal's handler has no other way to be heard. */
static volatile int stop_signal;

static void on_signal(int number)
{
    enum { PATIENCE = 3 };
    static volatile int count;
    stop_signal = number;
    if (++count >= PATIENCE) {
        _exit(EXIT_SIGNAL + number); /* what follows is stuck */
    }
}

static void watch_signals(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    sigemptyset(&action.sa_mask);
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGHUP, &action, NULL);
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, NULL);
}

/* --- the start --- */

static void print_period(const mct_can_message *message, FILE *file)
{
    if (message->period > 0) {
        fprintf(file, " (%g ms)", 1e3 * message->period);
    }
}

static void print_start(const mct_can_axes *axes, FILE *file)
{
    const mct_can_protocol *protocol = axes->protocol;
    for (int i = 0; i < axes->count; i++) {
        const mct_can_axis *axis = &axes->axes[i];
        const bool motor = (axis->roles & MCT_CAN_OF_MOTOR) != 0;
        const char *between = " ";
        fprintf(file, "  node %2d, %s, sends", axis->node,
                !motor                                    ? "an encoder"
                : axis->roles & MCT_CAN_OF_SPARE          ? "the motor and two encoders"
                : (axis->roles & MCT_CAN_OF_ENCODER) != 0 ? "the motor and its encoder"
                                                          : "the motor");
        for (int j = 0; j < protocol->message_count; j++) {
            const mct_can_message *message = &protocol->messages[j];
            if (message->from_drive && message->period >= 0 &&
                (message->of == 0 || (message->of & axis->roles))) {
                fprintf(file, "%s%s", between, message->name);
                print_period(message, file);
                between = ", ";
            }
        }
        fputc('\n', file);
    }
    fflush(file);
}

static const char *started_interface;

static void say_start(const mct_can_axes *axes)
{
    fprintf(stderr, "On %s, protocol %s; the mechanism is held until a host arms the drive\n",
            started_interface, axes->protocol->name);
    print_start(axes, stderr);
}

/* --- the end --- */

/* A virtual drive and what it was asked for. */
typedef struct {
    const scene_file *scene;
    const drive_options *options;
    drive_result result;
} drive_report;

static const char *state_name(mct_can_drive_state state)
{
    static const char *const names[] = {"unknown", "idle", "ready", "faulty"};
    return names[state];
}

static double time_of(const drive_report *report)
{
    return (double)report->result.drive.ticks * report->scene->scene.dt;
}

static const char *protocol_of(const drive_report *report)
{
    return mct_can_protocols[report->scene->scene.can_protocol]->name;
}

static void json_result(json *out, const drive_report *report)
{
    const drive_result *result = &report->result;
    const mct_can_drive_result *drive = &result->drive;
    const double dt = report->scene->scene.dt;
    json_object(out, "counters");
    json_count(out, "commands", drive->commands);
    json_count(out, "old_commands", drive->old_commands);
    json_count(out, "refused", drive->refused);
    json_count(out, "watchdog_trips", drive->watchdog_trips);
    json_count(out, "stops", drive->stops);
    json_count(out, "driven_ticks", drive->driven_ticks);
    json_count(out, "spoilt", drive->spoilt);
    json_count(out, "diverged_ticks", result->diverged_ticks);
    json_end_object(out);
    json_number(out, "last_driven", drive->driven_ticks > 0 ? (double)drive->last_driven * dt : (double)NAN);
    json_number(out, "highest_volts", drive->highest_volts);
    json_object(out, "bus");
    for (int i = 0; i < MCT_CAN_COUNTS; i++) {
        json_count(out, mct_can_counters[i].name, result->counts[i]);
    }
    json_end_object(out);
    json_boolean(out, "link_up", result->link == MCT_CAN_UP);
}

static void json_timing(json *out, const drive_result *result)
{
    json_object(out, "timing");
    json_count(out, "missed_ticks", result->timing.missed_ticks);
    json_count(out, "worst_late_us", result->timing.lateness.worst_us);
    json_count(out, "worst_work_us", result->timing.work.worst_us);
    json_boolean(out, "has_priority", result->has_priority);
    json_boolean(out, "has_memory", result->has_memory);
    json_end_object(out);
}

static void print_json(const drive_report *report, FILE *file)
{
    const drive_result *result = &report->result;
    const mct_scene *scene = &report->scene->scene;
    const arguments *given = report->scene->given;
    json out = json_begin(file, "mctau.drive/1");
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
    json_text(&out, "interface", report->options->interface);
    json_text(&out, "protocol", protocol_of(report));
    json_boolean(&out, "lockstep", result->lockstep);
    json_number(&out, "dt", scene->dt);
    json_boolean(&out, "released", result->released);
    json_boolean(&out, "stopped", result->stopped);
    json_count(&out, "ticks", result->drive.ticks);
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
    json_number(&out, "deviation", result->deviation);
    json_number(&out, "least_deviation", result->least_deviation);
    json_number(&out, "upright_at", result->upright_at >= 0 ? result->upright_at : (double)NAN);
    json_number(&out, "volts", result->volts);
    json_boolean(&out, "powered", result->powered);
    json_text(&out, "motor_drive", state_name(result->motor));
    json_result(&out, report);
    if (!result->lockstep) {
        json_timing(&out, result);
    }
    if (report->options->csv != NULL) {
        json_count(&out, "csv_rows", result->csv_rows);
    }
    json_finish(&out);
}

static void print_motion(const drive_report *report, FILE *file)
{
    const drive_result *result = &report->result;
    if (!result->released) {
        fputs("Nobody has armed the motor's drive: the mechanism has not moved.\n", file);
        return;
    }
    if (result->upright_at >= 0) {
        fprintf(file, "Upright (within 2 deg) since %.3f s", result->upright_at);
    } else {
        fprintf(file, "%.1f deg from upright, %.1f deg at the nearest", result->deviation * DEGREES,
                result->least_deviation * DEGREES);
    }
    fprintf(file, "; %s after %g s of the mechanism's time.\n", result->stopped ? "stopped" : "ended",
            time_of(report));
    fputs("\nState at the end\n", file);
    for (int i = 0; i < result->states; i++) {
        fprintf(file, "  %-16s %14.6g %s\n", result->names[i], result->state[i], result->units[i]);
    }
}

static void print_motor(const drive_report *report, FILE *file)
{
    const drive_result *result = &report->result;
    const mct_can_drive_result *drive = &result->drive;
    const double dt = report->scene->scene.dt;
    fprintf(file, "\nMotor: %s, its drive is %s\n",
            !result->powered     ? "runs free"
            : result->volts == 0 ? "zero volts"
                                 : "driven",
            state_name(result->motor));
    if (drive->driven_ticks > 0) {
        fprintf(file, "  driven for %g s, last at %.3f s, with up to %.2f V\n",
                (double)drive->driven_ticks * dt, (double)drive->last_driven * dt, drive->highest_volts);
    }
}

static void print_count(FILE *file, uint64_t count, const char *what)
{
    if (count > 0) {
        fprintf(file, "  %9" PRIu64 "  %s\n", count, what);
    }
}

static void print_people(const drive_report *report, FILE *file)
{
    const drive_result *result = &report->result;
    const mct_can_drive_result *drive = &result->drive;
    print_motion(report, file);
    print_motor(report, file);
    fputs("\nHeard\n", file);
    fprintf(file, "  %9" PRIu64 "  commands accepted\n", drive->commands);
    print_count(file, drive->old_commands, "commands refused: not newer than the last one");
    print_count(file, drive->refused, "frames refused for their form");
    print_count(file, drive->stops, "emergency stops");
    print_count(file, drive->watchdog_trips, "times that the watchdog stopped the motor: no command came");
    print_count(file, drive->spoilt, "frames that the fault befell");
    fputs("\nOn the bus\n", file);
    for (int i = 0; i < MCT_CAN_COUNTS; i++) {
        if (result->counts[i] > 0) {
            fprintf(file, "  %9" PRIu64 "  %-16s %s\n", result->counts[i], mct_can_counters[i].name,
                    mct_can_counters[i].doc);
        }
    }
    if (result->link != MCT_CAN_UP) {
        fprintf(file, "  at the end %s\n", mct_can_link_text(result->link));
    }
    if (!result->lockstep) {
        fprintf(file, "\nClock: latest wake-up %" PRIu32 " us late, %" PRIu64 " ticks missed\n",
                result->timing.lateness.worst_us, result->timing.missed_ticks);
    }
    if (report->options->csv != NULL && result->csv_errno == 0) {
        fprintf(file, "\nWritten\n  %s: %" PRIu64 " rows\n", report->options->csv, result->csv_rows);
    }
}

/* --- from beginning to end --- */

static int check_options(const scene_file *file, const drive_options *asked, bool as_json)
{
    if (asked->interface == NULL || asked->interface[0] == '\0') {
        return say(EXIT_USAGE,
                   "--can: found %s; allowed a CAN interface, such as vcan0 (ip link shows which there "
                   "are)",
                   asked->interface == NULL ? "nothing" : "an empty name");
    }
    if (asked->csv == NULL) {
        return 0;
    }
    if (asked->csv[0] == '\0') {
        return say(EXIT_USAGE, "--csv: found an empty name; allowed a file, or - for stdout");
    }
    if (strcmp(asked->csv, "-") == 0 && as_json) {
        return say(EXIT_USAGE,
                   "--csv: found - (stdout) together with --json, which is there already; allowed a file");
    }
    if (is_same_file(asked->csv, file->path)) {
        return say(EXIT_USAGE, "--csv: found %s, which the scene is read from; allowed another file",
                   asked->csv);
    }
    return 0;
}

static int drive_scene(const scene_file *file, const arguments *given)
{
    mct_message why;
    const bool as_json = arguments_value(given, "json") != NULL;
    const drive_options asked = {
        .interface = arguments_value(given, "can"),
        .has_duration = arguments_value(given, "duration") != NULL,
        .csv = arguments_value(given, "csv"),
        .stop = &stop_signal,
        .started = as_json ? NULL : say_start,
        .progress = isatty(STDERR_FILENO) == 1,
    };
    drive_report report = {.scene = file, .options = &asked};
    const int wrong = check_options(file, &asked, as_json);
    if (wrong != 0) {
        return wrong;
    }
    started_interface = asked.interface;
    watch_signals();
    const mct_status status = file->runner->drive(&file->scene, &asked, &report.result, &why);
    if (status != MCT_OK) {
        return say_status(status, &why);
    }
    if (as_json) {
        print_json(&report, stdout);
    } else {
        print_people(&report, asked.csv != NULL && strcmp(asked.csv, "-") == 0 ? stderr : stdout);
    }
    if (report.result.csv_errno != 0) {
        return say(EXIT_IO, "%s: %" PRIu64 " rows are lost: %s; no incomplete file is left", asked.csv,
                   report.result.csv_errors, strerror(report.result.csv_errno));
    }
    return report.result.diverged_ticks > 0 ? EXIT_CHECK_FAILED : EXIT_WELL;
}

static int drive_verb(const arguments *given)
{
    scene_file file;
    int exit_code = scene_file_read(&file, given);
    if (exit_code == 0) {
        exit_code = choose_stepper(&file);
        exit_code = exit_code != 0 ? exit_code : drive_scene(&file, given);
        scene_file_free(&file);
    }
    return exit_code;
}

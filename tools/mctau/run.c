/* mctau run: a scene from beginning to end. */
#include "run.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "mctau/supervisor.h"
#include "pick.h"
#include "say.h"
#include "verbs.h"

static const option options[] = {
    {"duration", "S", "scene.duration", "how long, a whole number of ticks"},
    {"dt", "S", "scene.dt", NULL},
    {"stepper", "NAME", "scene.stepper", "how the plant is simulated"},
    {"precision", "NAME", "scene.precision", NULL},
    {"realtime", NULL, "scene.realtime", NULL},
    {"hal", "NAME", "scene.hal", NULL},
    OPTION_SET,
    {"csv", "FILE", NULL,
     "one row a tick: time, states, estimates, input wanted and applied, mode, faults; - is stdout"},
    {"log", "FILE", "telemetry.log", "event log of every tick, for replay and for LCM's tools"},
    {"lcm", "URL", "telemetry.lcm", "publishes every tick, e.g. udpm://239.255.76.67:7667?ttl=0"},
    {"ledger", NULL, NULL,
     "the work of each effect, and what the stepper adds to the energy: follows every tick's exact motion"},
    OPTION_JSON,
    {NULL, NULL, NULL, NULL},
};

static int run_verb(const arguments *given);

const verb verb_run = {
    .name = "run",
    .doc = "simulates and controls a scene, says what happened, writes every tick if asked to",
    .operand = "SCENE",
    .text =
        "Runs a scene from beginning to end and prints what happened. SCENE is a TOML file; - reads it from "
        "stdin.\n"
        "In lockstep, the default, it runs as fast as it can; --realtime keeps the clock and shows how "
        "well.\n"
        "Over a CAN bus (--hal socketcan:can0) the clock is kept. After a fault the motor has zero volts; "
        "the "
        "signal\n"
        "SIGUSR1 clears it and arms the drives again.",
    .options = options,
    .examples =
        "  mctau run scenes/reaction_wheel.toml\n"
        "  mctau run scenes/cart_pole.toml --csv run.csv --set parameters.pole_mass=0.2\n"
        "  mctau run scenes/cart_pole.toml --set variation.spread=0.1 --set variation.seed=7 --json\n"
        "  mctau run scenes/reaction_wheel.toml --duration 10 --realtime --log run.lcm\n"
        "  mctau run scenes/reaction_wheel.toml --hal socketcan:can0 --set can.protocol=odrive\n"
        "  mctau run scenes/reaction_wheel.toml --hal ring --set can.fault=drop --set can.fault_time=10\n",
    .exit_codes = "  0    balanced: upright within 2 degrees for at least the last second; without a "
                  "controller: finished\n"
                  "  1    not balanced, a fault was latched, or the simulation diverged\n"
                  "  2    the command line or the scene is wrong\n"
                  "  3    the bus or a drive was not as it must be; a file could not be read or written, or "
                  "took not all of the run\n"
                  "  130  stopped by Ctrl-C (128 + the signal's number), at zero volts\n",
    .run = run_verb,
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
        _exit(EXIT_SIGNAL + number); /* zero volts since the first; what follows is stuck */
    }
}

/* Counts requests to clear faults and arm again. */
static volatile int rearm_requests;

static void on_rearm(int number)
{
    (void)number;
    rearm_requests++;
}

static void say_start(const mct_can_report *report)
{
    print_start(report, stderr);
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
    action.sa_handler = on_rearm;
    sigaction(SIGUSR1, &action, NULL);
    action.sa_handler = SIG_IGN; /* a reader that goes away must not end a run */
    sigaction(SIGPIPE, &action, NULL);
}

/* --- what a run may overwrite --- */

static int check_outputs(const scene_file *file, const run_options *run)
{
    const char *const outputs[] = {run->csv, run->log};
    static const char *const names[] = {"--csv", "telemetry.log"};
    for (int i = 0; i < 2; i++) {
        if (is_same_file(outputs[i], file->path) || is_same_file(outputs[i], file->samples_path)) {
            return say(EXIT_USAGE, "%s: found %s, which the scene is read from; allowed another file",
                       names[i], outputs[i]);
        }
    }
    if (run->csv != NULL && (strcmp(run->csv, run->log) == 0 || is_same_file(run->csv, run->log))) {
        const bool harmless = access(run->csv, F_OK) == 0 && !is_same_file(run->csv, run->csv); /* a device */
        return harmless ? 0
                        : say(EXIT_USAGE,
                              "--csv: found %s, which is the event log, too; allowed another file", run->csv);
    }
    return 0;
}

/* --- verdict --- */

const char *verdict_name(verdict self)
{
    static const char *const names[] = {"balanced", "not_balanced", "faulted",
                                        "diverged", "stopped",      "finished"};
    return names[self];
}

static verdict judge(const run_result *result, double dt)
{
    const double upright_for = (double)result->ticks * dt - result->upright_at;
    if (result->diverged_ticks > 0) {
        return DIVERGED;
    }
    if (result->latched & ~(1u << MCT_FAULT_STOPPED)) {
        return FAULTED;
    }
    if (result->stopped) {
        return STOPPED;
    }
    if (!result->controlled) {
        return FINISHED;
    }
    return result->upright_at >= 0 && upright_for >= 1 - 1e-9 ? BALANCED : NOT_BALANCED;
}

/* Files that did not take all of the run: said here, once. */
static int complain_about_files(const run_result *result, const run_options *run)
{
    int exit_code = 0;
    if (result->csv_errors > 0 || result->csv_errno != 0) {
        exit_code = say(EXIT_IO, "%s: %llu rows are lost: %s; the run went on, no incomplete file is left",
                        run->csv, (unsigned long long)result->csv_errors, strerror(result->csv_errno));
    }
    if (result->log_errors > 0 || result->log_errno != 0) {
        exit_code = say(EXIT_IO, "%s: the log holds %llu of %llu ticks: %s; the run went on", run->log,
                        (unsigned long long)result->logged, (unsigned long long)result->ticks,
                        strerror(result->log_errno));
    }
    if (result->warning.text[0] != '\0') {
        say(0, "%s", result->warning.text);
    }
    return exit_code;
}

static int exit_code_of(const run_report *report)
{
    switch (report->verdict) {
    case BALANCED:
    case FINISHED:
        return EXIT_WELL;
    case STOPPED:
        return EXIT_SIGNAL + stop_signal;
    default:
        return EXIT_CHECK_FAILED;
    }
}

/*
 * Whether the mechanism is simulated here; not behind a bus or in a recording, "socketcan:can0",
 * "candump:FILE".
 */
static bool simulates(const mct_scene *scene)
{
    return strchr(scene->hal, ':') == NULL;
}

/* Follows the run in double, where this build has it. */
static int open_ledger(const scene_file *file, const mct_runner *keeper, run_options *asked)
{
    mct_message why;
    mct_message_clear(&why);
    if (!simulates(&file->scene) || mct_systems[file->scene.system]->is_process) {
        return say(EXIT_USAGE, "--ledger: found %s, whose energy nobody knows; allowed a simulated mechanism",
                   simulates(&file->scene) ? mct_systems[file->scene.system]->name : file->scene.hal);
    }
    asked->ledger_tick = keeper->ledger_tick;
    const mct_status status = keeper->ledger_begin(&file->scene, &asked->ledger, &why);
    return status != MCT_OK ? say_status(status, &why) : 0;
}

static int run_scene(const scene_file *file, const arguments *given)
{
    mct_message why;
    run_options asked = {
        .csv = arguments_value(given, "csv"),
        .log = file->scene.log,
        .lcm = file->scene.lcm,
        .scene_text = file->text,
        .samples = file->samples,
        .stop = &stop_signal,
        .rearm = &rearm_requests,
        .started = arguments_value(given, "json") == NULL ? say_start : NULL,
        .progress = isatty(STDERR_FILENO) == 1,
    };
    run_report report = {.scene = file, .options = &asked};
    const bool csv_on_stdout = asked.csv != NULL && strcmp(asked.csv, "-") == 0;
    const bool as_json = arguments_value(given, "json") != NULL;
    if (csv_on_stdout && as_json) {
        return say(EXIT_USAGE,
                   "--csv: found - (stdout) together with --json, which is there already; allowed a file");
    }
    if (asked.csv != NULL && asked.csv[0] == '\0') {
        return say(EXIT_USAGE, "--csv: found an empty name; allowed a file, or - for stdout");
    }
    int exit_code = check_outputs(file, &asked);
    if (exit_code != 0) {
        return exit_code;
    }
    const mct_runner *const in_double = find_runner(MCT_PRECISION_DOUBLE);
    const mct_runner *const keeper = in_double != NULL ? in_double : file->runner;
    if (arguments_value(given, "ledger") != NULL) {
        exit_code = open_ledger(file, keeper, &asked);
        if (exit_code != 0) {
            return exit_code;
        }
    }
    watch_signals();
    const mct_status status = file->runner->run(&file->scene, &asked, &report.result, &why);
    if (asked.ledger != NULL) {
        keeper->ledger_end(asked.ledger, &report.ledger);
    }
    if (status != MCT_OK) {
        return say_status(status, &why);
    }
    report.verdict = judge(&report.result, file->scene.dt);
    if (as_json) {
        print_run_json(&report, stdout);
    } else {
        print_run(&report, csv_on_stdout ? stderr : stdout);
    }
    exit_code = complain_about_files(&report.result, &asked);
    return exit_code != 0 ? exit_code : exit_code_of(&report);
}

static int run_verb(const arguments *given)
{
    scene_file file;
    int exit_code = scene_file_read(&file, given);
    if (exit_code == 0) {
        exit_code = simulates(&file.scene) ? choose_stepper(&file) : 0;
        exit_code = exit_code != 0 ? exit_code : run_scene(&file, given);
        scene_file_free(&file);
    }
    return exit_code;
}

/*
 * What the command asks of the core, once for each precision.
 *
 * runner*.c is compiled for float and for double against the core of that precision; the table below is the
 * only symbol that either shows to the front end. Everything here is free of mct_real: values are doubles,
 * exact in both.
 */
#ifndef MCTAU_TOOLS_RUNNER_H
#define MCTAU_TOOLS_RUNNER_H

#include <stdbool.h>
#include <stdint.h>

#include "csv_output.h"
#include "hal/hal.h"
#include "hal/socketcan/can.h"
#include "hal/socketcan/drive.h"
#include "mctau/message.h"
#include "mctau/scene.h"
#include "mctau/status.h"
#include "powers.h"
#include "tools/hard/hard.h"

#define RUNNER_MAX_STATES      16
#define RUNNER_MAX_COORDINATES 16
#define RUNNER_MAX_PARTICLES   32
#define RUNNER_MAX_FAULTS      16

/* Follows a run and keeps its ledger: see docs/ledger.md. */
typedef struct ledger ledger;

typedef struct {
    powers work; /* along the exact motion of each tick */
    energies gain, of_stepper,
        unexplained;     /* gain = what the works bring to each + of_stepper + unexplained */
    double size;         /* of all works and energies: what rounding is relative to */
    uint64_t lost_ticks; /* whose exact motion could not be followed: left unexplained */
} ledger_result;

/* Of a csv input, one a tick. */
typedef struct {
    double *f64;
    float *f32; /* the same, rounded */
    size_t count;
} csv_samples;

/* Those of a runner's own precision. */
#if MCT_REAL_IS_FLOAT
#define RUNNER_SAMPLES(options) ((mct_samples){(options)->samples.f32, (options)->samples.count})
#else
#define RUNNER_SAMPLES(options) ((mct_samples){(options)->samples.f64, (options)->samples.count})
#endif

/* Where the results of a run go; NULL or "" for nowhere. */
typedef struct {
    const char *csv; /* path, "-" for stdout */
    const char *log;
    const char *lcm;
    const char *scene_text; /* as read, with its overrides, for the log */
    csv_samples samples;
    const volatile int *stop;  /* set by a signal: the run ends at zero volts */
    const volatile int *rearm; /* counts requests to clear faults and arm again */
    void (*started)(
        const struct mct_can_report *report); /* told what the start found on a CAN bus; or NULL */
    bool progress;                            /* show progress on stderr */
    ledger *
        ledger; /* told of every tick of a mechanism that is simulated here, by the function of its runner; or NULL */
    void (*ledger_tick)(ledger *self, const double *value, const double *rest, double input);
} run_options;

typedef struct {
    int states;
    const char *names[RUNNER_MAX_STATES];
    const char *units[RUNNER_MAX_STATES];
    double state[RUNNER_MAX_STATES];
    uint64_t ticks;
    energies energy_start, energy;      /* at the beginning and at the end */
    uint64_t faults[RUNNER_MAX_FAULTS]; /* ticks on which each fault was seen, by mct_fault */
    uint32_t latched;
    double fault_at;          /* [s] first tick on which one was latched; negative when none was */
    uint64_t saturated_ticks; /* input at its limit, whether the controller or the supervisor put it there */
    uint64_t limited_ticks, derated_ticks, rejected_inputs, diverged_ticks;
    double limit; /* largest input let through [V]; infinite when nothing bounds it */
    bool controlled;
    const char *mode;       /* of the controller at the end */
    double deviation;       /* from upright at the end [rad] */
    double least_deviation; /* of the whole run [rad] */
    double upright_at;      /* [s] from then on within 2 degrees of upright to the end; negative when not */
    double worst_after_upright; /* largest deviation since then [rad]; 0 when not upright */
    double worst_last_second;   /* largest deviation of the last second [rad] */
    double ns_per_tick;         /* wall-clock time of the loop, without init, CSV and waiting for telemetry */
    double seconds;             /* the same in all [s] */
    bool stopped;               /* by run_options.stop */
    bool has_energy;            /* the plant's state is known */
    bool realtime;              /* paced by the clock */
    uint64_t rearmed;           /* times that faults were cleared */
    /* CAN */
    bool has_can;
    mct_can_report can;
    const mct_counter *counters;
    uint64_t counts[MCT_MAX_COUNTERS];
    int counter_count;
    bool has_recording;                       /* the bus is a recorded log */
    uint64_t compared, mismatches, unmatched; /* commands, against the log */
    /* real time */
    mct_timing timing;
    bool has_priority, has_memory;
    /* telemetry */
    uint64_t dropped, published, publish_errors, logged, log_errors;
    int log_errno, csv_errno;
    uint64_t csv_rows, csv_errors; /* rows written, and rows that the file did not take */
    mct_message warning;           /* what telemetry goes without; empty when all is well */
} run_result;

/* Gauss's least-squares problem at a state, solved without the closed form. */
typedef struct {
    bool solved; /* else M is singular there, or there is no motion */
    double acceleration[RUNNER_MAX_COORDINATES];
    double couple[RUNNER_MAX_COORDINATES]; /* tau - J'f */
    double velocity[RUNNER_MAX_PARTICLES][3];
    double constraint_force[RUNNER_MAX_PARTICLES][3];
    double C[RUNNER_MAX_COORDINATES][RUNNER_MAX_COORDINATES]; /* of (229), from the derivatives of M */
    bool has_C;
} gauss_result;

typedef struct {
    int states;
    const char *names[RUNNER_MAX_STATES];
    const char *units[RUNNER_MAX_STATES];
    double state[RUNNER_MAX_STATES];
    const char *coordinate_names[RUNNER_MAX_COORDINATES];
    const char *coordinate_units[RUNNER_MAX_COORDINATES];
    double rate[RUNNER_MAX_COORDINATES];
    int coordinates, particles;
    const char *particle_names[RUNNER_MAX_PARTICLES];
    double M[RUNNER_MAX_COORDINATES][RUNNER_MAX_COORDINATES];
    double C[RUNNER_MAX_COORDINATES][RUNNER_MAX_COORDINATES];
    double Cv[RUNNER_MAX_COORDINATES];
    double tau[RUNNER_MAX_COORDINATES];
    double acceleration[RUNNER_MAX_COORDINATES];
    double mass[RUNNER_MAX_PARTICLES];
    double position[RUNNER_MAX_PARTICLES][3];
    double force[RUNNER_MAX_PARTICLES][3]; /* from outside */
    double constraint_force[RUNNER_MAX_PARTICLES][3];
    gauss_result gauss;
    double current;
    double input; /* as applied */
    energies energy;
    powers power;
} mct_result;

/* First difference between a log and its replay. */
typedef struct {
    uint64_t ticks; /* replayed */
    bool equal;
    bool truncated;      /* the log ends in the middle of an event: replayed up to the last complete one */
    uint64_t first_tick; /* that differs */
    char field[64];      /* that differs, as "applied" or "state.arm_angle" */
    double recorded, replayed;
} replay_result;

typedef struct {
    uint64_t ticks;
    uint64_t left_over; /* bytes behind the last whole record */
} import_result;

/* A virtual drive on a CAN interface. */
typedef struct {
    const char *interface;
    bool has_duration;        /* ends after scene.duration of the mechanism's time; else when stopped */
    const char *csv;          /* path, "-" for stdout; NULL for nowhere */
    const volatile int *stop; /* set by a signal */
    void (*started)(const mct_can_axes *axes); /* told once it is on the bus; or NULL */
    bool progress;                             /* show progress on stderr */
} drive_options;

typedef struct {
    int states;
    const char *names[RUNNER_MAX_STATES];
    const char *units[RUNNER_MAX_STATES];
    double state[RUNNER_MAX_STATES];
    bool stopped; /* before its duration was over */
    bool released, lockstep;
    bool powered; /* a bridge puts the volts on the motor */
    double volts; /* at the motor at the end [V] */
    mct_can_drive_result drive;
    mct_can_drive_state motor; /* of its drive, at the end */
    mct_can_link_state link;   /* at the end */
    uint64_t counts[MCT_CAN_COUNTS];
    uint64_t diverged_ticks;
    double deviation, least_deviation; /* from upright at the end, and ever [rad] */
    double upright_at; /* [s] from then on within 2 degrees of upright to the end; negative when not */
    mct_timing timing; /* zero in lockstep */
    bool has_priority, has_memory;
    uint64_t csv_rows, csv_errors;
    int csv_errno;
} drive_result;

/* A scene's run as its stepper, dt and substeps have it, under inputs that are known beforehand. */
typedef struct {
    const double *inputs; /* one a tick; NULL: none acts */
    uint64_t ticks;       /* of the run, at least 1 */
    double *states;       /* written unless NULL: ticks + 1 rows of all states, the first that of the start */
    double sample_ns;     /* how long ticks are timed; 0: they are not */
    bool count;           /* the instructions */
    /* results */
    bool diverged;
    double ns;           /* per tick */
    double instructions; /* per tick; NaN where nothing counts them */
} trial;

/* A run that is known. */
typedef struct {
    const double *inputs; /* one a tick; NULL: none acts */
    const double *states; /* as of a trial */
    int width;            /* of its rows: states of the scene that was run */
    uint64_t ticks;
} course;

/* Where two runs differ most, as a part of the state's scale. */
typedef struct {
    double size; /* infinite: one of them diverges; NaN: not known */
    int state;
    uint64_t tick;
} departure;

typedef struct {
    const char *precision;
    size_t real_size;
    mct_status (*run)(const mct_scene *scene, const run_options *options, run_result *result,
                      mct_message *why);
    /*
     * At the scene's initial state; `input` NULL stands for the scene's own at t = 0. It is bounded as in a
     * run.
     */
    mct_status (*mct)(const mct_scene *scene, const run_options *options, const double *input,
                      mct_result *result, mct_message *why);
    mct_status (*replay)(const char *log, replay_result *result, mct_message *why);
    mct_status (*drive)(const mct_scene *scene, const drive_options *options, drive_result *result,
                        mct_message *why);
    /* Inputs of the first `ticks` ticks: those of [input], or what the controller applies in simulation. */
    mct_status (*inputs)(const mct_scene *scene, const run_options *options, uint64_t ticks, double *inputs,
                         mct_message *why);
    /* A ledger of a scene's run, which starts at its initial state; ledger_end() frees it. */
    mct_status (*ledger_begin)(const mct_scene *scene, ledger **self, mct_message *why);
    /* The state after a tick, in two parts, and the input as applied. The first call is for the start. */
    void (*ledger_tick)(ledger *self, const double *value, const double *rest, double input);
    void (*ledger_end)(ledger *self, ledger_result *result);
    /* Follows, times and counts, as the trial asks; the scene's controller and [input] do not act. */
    mct_status (*try)(const mct_scene *scene, trial *asked, mct_message *why);
    /* Follows a scene with a controller in simulation, in lockstep; `states` and `diverged` as of a trial. */
    mct_status (*loop)(const mct_scene *scene, uint64_t ticks, double *states, bool *diverged,
                       mct_message *why);
    /*
     * Open loop, to first order: by how much other scenes of the system depart from the run of `scene`, at its inputs.
     * Compared are coordinates and rates, by their `scale`. found[i] is not known where others[i] cannot be prepared.
     */
    mct_status (*depart)(const mct_scene *scene, const course *along, const double *scale,
                         const mct_scene *others, int count, departure *found, mct_message *why);
    /*
     * Of what `with` has and `without` has not [s]: of a current L/R; of a prescribed motion 1 / its angular frequency;
     * else by how the accelerations that it brings respond to the state. NaN where it has none.
     */
    double (*time_scale)(const mct_scene *with, const mct_scene *without, const course *along);
    /* The scene's structs as C text: see runner_compile.h. */
    mct_status (*compile)(const mct_scene *scene, const run_options *options, csv_output *out,
                          mct_message *why);
    /* An image's records into an event log: see runner_import.h. */
    mct_status (*import)(const mct_scene *scene, const char *records, const run_options *options,
                         import_result *result, mct_message *why);
    /* Hard cases: see tools/hard/hard.h. */
    const hard_case *(*hard_case_after)(int number);
    void (*hard_run_case)(const hard_case *about, bool is_full, hard_result results[HARD_METHOD_COUNT]);
    hard_verdict (*hard_judge)(const hard_case *about, const hard_result *result);
    double (*hard_criterion)(const hard_case *about);
} mct_runner;

extern const mct_runner mct_runner_f64;
extern const mct_runner mct_runner_f32;

#endif

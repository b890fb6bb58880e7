/* Hard cases of numbers: time, inverse kinematics, denormals, inputs that are none. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "hal/sim/sim.h"
#include "hard_run.h"
#include "mctau/compensated.h"
#include "mctau/input.h"
#include "mctau/least_squares.h"
#include "mctau/observer.h"
#include "mctau/supervisor.h"

#define MS MCT_R(1e-3)
#define PI 3.14159265358979323846

static long steps_of(const hard_trial *trial)
{
    return (long)(trial->seconds * 1000 + 0.5);
}

static void read_scene(const char *text, mct_scene *scene)
{
    (void)mct_scene_read(text, strlen(text), "scene", NULL, 0, scene, NULL);
}

/* Largest difference of two plants' states. */
static double distance(const mct_plant *a, const mct_plant *b)
{
    double worst = 0;
    for (int i = 0; i < a->states; i++) {
        worst = fmax(worst, fabs((double)(a->state.x[i] - b->state.x[i])));
    }
    return worst;
}

/* --- time --- */

#define DAY 86400

/* 15: at which time a step of the input comes that was asked for after a day. */
static void run_clock(const hard_trial *trial, hard_result *result)
{
    const uint64_t due = (uint64_t)DAY * 1000;
    if (trial->method == HARD_NAIVE) {
        mct_real time = 0;
        for (uint64_t tick = 0; tick < due; tick++) {
            time += MS;
        }
        hard_error(result, (double)time - DAY);
        return;
    }
    mct_scene scene;
    mct_input input;
    read_scene(
        "scene.system = \"block\"\ninput.kind = \"steps\"\ninput.times = [86400]\ninput.values = [1]\n",
        &scene);
    mct_input_init(&input, &scene, (mct_samples){NULL, 0});
    uint64_t tick = due - 1000;
    while (tick < due + 1000 && mct_input_at(&input, tick) == 0) {
        tick++;
    }
    hard_error(result, (double)tick * scene.dt - DAY);
}

/*
 * 16: the phase of a force that swings at 1 rad/s. (The block's force_time, of a ramp, does not lose turns: in float it has
 * the 48 bits of a value and its compensation, which after a day are 3 ms.)
 */
static void run_pace(const hard_trial *trial, hard_result *result)
{
    enum { FORCE_PHASE = 2 }; /* state of the block [rad] */
    hard_run run;
    double late = 0;
    if (trial->method == HARD_NAIVE) {
        late = (double)steps_of(trial) * (double)1e-3F - trial->seconds;
    } else if (hard_start(&run, trial, NULL, result) && hard_advance(&run, 0, hard_ticks(&run, trial))) {
        late = remainder(hard_value(&run, FORCE_PHASE) - trial->seconds, 2 * PI);
    } else {
        return;
    }
    hard_error(result, late * DAY / trial->seconds);
}

/* 41: a sine of 50 Hz after a day, over 2 s. */
static void run_sine(const hard_trial *trial, hard_result *result)
{
    const uint64_t first = (uint64_t)(trial->seconds * 1000);
    const long double turn = 6.283185307179586476925286766559L;
    mct_scene scene;
    mct_input input;
    mct_real time = 0;
    read_scene("scene.system = \"block\"\ninput.kind = \"sine\"\ninput.amplitude = 1\n"
               "input.frequency = 314.1592653589793\n",
               &scene);
    mct_input_init(&input, &scene, (mct_samples){NULL, 0});
    for (uint64_t tick = 0; trial->method == HARD_NAIVE && tick < first; tick++) {
        time += MS;
    }
    for (uint64_t tick = first; tick < first + 2000; tick++) {
        const double exact = (double)sinl((long double)(tick % 20) / 20 * turn);
        const double sine = trial->method == HARD_NAIVE
                                ? sin((double)((mct_real)scene.input_frequency * time))
                                : (double)mct_input_at(&input, tick);
        hard_error(result, sine - exact);
        time += MS;
    }
}

/* 42: a tick of 0.1 us; damped by 10/s, rate e^-10t, angle 1 + (1 - e^-10t)/10. */
static void run_short_tick(const hard_trial *trial, hard_result *result)
{
    const double rate = exp(-10 * trial->seconds), angle = 1 + (1 - rate) / 10;
    hard_run run;
    if (trial->method == HARD_NAIVE) {
        const float h = 1e-7F;
        float x = 1, v = 1;
        for (long step = (long)(trial->seconds * 1e7 + 0.5); step > 0; step--) {
            v -= h * 10 * v;
            x += h * v;
        }
        hard_error(result, (double)x - angle);
        hard_error(result, (double)v - rate);
    } else if (hard_start(&run, trial, NULL, result) && hard_advance(&run, 0, hard_ticks(&run, trial))) {
        hard_error(result, hard_value(&run, 0) - angle);
        hard_error(result, hard_value(&run, 1) - rate);
    }
}

/* 43: a closed loop whose clock begins at another tick. */
static void run_late_clock(const hard_trial *trial, hard_result *result)
{
    static const uint64_t starts[] = {(UINT64_C(1) << 32) - 500, (UINT64_C(1) << 53) - 500,
                                      (UINT64_C(1) << 63) - 500};
    for (int i = 0; i < 3; i++) {
        if (trial->method == HARD_NAIVE) {
            const mct_real time = (mct_real)starts[i] * MS;
            hard_error(result, (double)(((time + MS) - time) / MS - 1));
            continue;
        }
        hard_run run;
        mct_sim sims[2];
        if (!hard_start(&run, trial, NULL, result)) {
            return;
        }
        for (int which = 0; which < 2; which++) {
            (void)mct_sim_init(&sims[which], &run.scene, NULL);
        }
        sims[1].plant.tick = starts[i];
        for (long step = steps_of(trial); step > 0; step--) {
            for (int which = 0; which < 2; which++) {
                const mct_hal hal = mct_sim_hal(&sims[which]);
                mct_reading reading;
                hal.ops->read(hal.context, &reading);
                hal.ops->write(hal.context, (mct_real)(reading.counts[0] % 10));
                hal.ops->wait_tick(hal.context);
            }
            hard_error(result, distance(&sims[0].plant, &sims[1].plant));
        }
    }
}

/* --- inverse kinematics: two links of 1 m --- */

/* Distance of the tip from a point [m]. */
static double tip_distance(const double *angles, const double *point)
{
    const double x = cos(angles[0]) + cos(angles[0] + angles[1]);
    const double y = sin(angles[0]) + sin(angles[0] + angles[1]);
    return hypot(point[0] - x, point[1] - y);
}

/* One update of two links by J' (J J' + ridge)^-1 e; with ridge = 0 that is J^-1 e. */
static void update_naively(double *angles, const double *target, double ridge)
{
    const double s1 = sin(angles[0]), c1 = cos(angles[0]);
    const double s12 = sin(angles[0] + angles[1]), c12 = cos(angles[0] + angles[1]);
    const double e[2] = {target[0] - c1 - c12, target[1] - s1 - s12};
    const double J[2][2] = {{-s1 - s12, -s12}, {c1 + c12, c12}};
    const double a = J[0][0] * J[0][0] + J[0][1] * J[0][1] + ridge;
    const double b = J[0][0] * J[1][0] + J[0][1] * J[1][1];
    const double d = J[1][0] * J[1][0] + J[1][1] * J[1][1] + ridge;
    const double w[2] = {(d * e[0] - b * e[1]) / (a * d - b * b), (a * e[1] - b * e[0]) / (a * d - b * b)};
    for (int i = 0; i < 2; i++) {
        angles[i] += J[0][i] * w[0] + J[1][i] * w[1];
    }
}

/* Updates towards a target; the error is how far from the nearest point in reach they end, or infinite after a leap. */
static void reach(const hard_trial *trial, const double *target, const double *nearest, double bend,
                  double ridge, hard_result *result)
{
    double angles[2] = {0, bend}, before[2];
    char more[128];
    hard_run run;
    snprintf(more, sizeof more,
             "parameters.target_1 = %.17g\nparameters.target_2 = %.17g\ninitial.angle_2 = %g\n", target[0],
             target[1], bend);
    if (trial->method != HARD_NAIVE && !hard_start(&run, trial, more, result)) {
        return;
    }
    for (long update = steps_of(trial); update > 0; update--) {
        memcpy(before, angles, sizeof before);
        if (trial->method == HARD_NAIVE) {
            update_naively(angles, target, ridge);
        } else {
            (void)hard_advance(&run, 0, 1);
            angles[0] = hard_value(&run, 0);
            angles[1] = hard_value(&run, 1);
        }
        if (!(fabs(angles[0] - before[0]) <= PI && fabs(angles[1] - before[1]) <= PI)) {
            hard_error(result, (double)INFINITY);
        }
    }
    hard_error(result, tip_distance(angles, nearest));
}

/* 30 */
static void run_reach(const hard_trial *trial, hard_result *result)
{
    static const double targets[][2] = {{1.9999, 0.01}, {2, 0}, {1.2, 1.6}, {0, 3}, {-1e6, 0}};
    static const double nearest[][2] = {{1.9999, 0.01}, {2, 0}, {1.2, 1.6}, {0, 2}, {-2, 0}};
    for (int i = 0; i < 5; i++) {
        reach(trial, targets[i], nearest[i], 1e-3, 0, result);
    }
}

/* 31 */
static void run_stretched(const hard_trial *trial, hard_result *result)
{
    static const double targets[][2] = {{1, 0}, {-1, 0}, {0.5, 0}};
    for (int i = 0; i < 3; i++) {
        reach(trial, targets[i], targets[i], 0, 1e-2, result);
    }
}

/* --- 32: two columns that are one but for their last digits; y is twice it, so (1, 1) is the smallest that fits --- */

static void run_dependent_columns(const hard_trial *trial, hard_result *result)
{
    enum { ROWS = 8, COLUMNS = 2, ALL = ROWS + COLUMNS };
    mct_real x[ALL][COLUMNS], y[ALL], weight[ALL], b[COLUMNS];
    mct_real xx[COLUMNS][COLUMNS] = {{0}}, xy[COLUMNS] = {0};
    for (int i = 0; i < ROWS; i++) {
        x[i][0] = 1 + (mct_real)i / 7;
        x[i][1] = 3 * (x[i][0] / 3);
        y[i] = 2 * x[i][0];
        weight[i] = 1;
        for (int j = 0; j < COLUMNS; j++) {
            xy[j] += x[i][j] * y[i];
            xx[j][0] += x[i][j] * x[i][0];
            xx[j][1] += x[i][j] * x[i][1];
        }
    }
    if (trial->method == HARD_NAIVE) { /* x'x b = x'y */
        const mct_real determinant = xx[0][0] * xx[1][1] - xx[0][1] * xx[1][0];
        b[0] = (xx[1][1] * xy[0] - xx[0][1] * xy[1]) / determinant;
        b[1] = (xx[0][0] * xy[1] - xx[1][0] * xy[0]) / determinant;
    } else {
        const mct_real ridge = MCT_REAL_IS_FLOAT ? MCT_R(1e-4) : MCT_R(1e-10);
        if (mct_least_squares_ridge(ROWS, COLUMNS, x[0], weight, y, ridge, b) != MCT_OK) {
            hard_error(result, (double)INFINITY);
            return;
        }
    }
    hard_error(result, (double)b[0] - 1);
    hard_error(result, (double)b[1] - 1);
}

/* --- 33: denormals --- */

static bool is_denormal(mct_real value)
{
    const mct_real size = value < 0 ? -value : value;
    return size > 0 && size < (MCT_REAL_IS_FLOAT ? MCT_R(FLT_MIN) : MCT_R(DBL_MIN));
}

static void run_decay(const hard_trial *trial, hard_result *result)
{
    const uint64_t ticks = (uint64_t)steps_of(trial);
    uint64_t slow = 0;
    hard_run run;
    mct_real rate = 1;
    if (trial->method != HARD_NAIVE && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (uint64_t tick = 0; tick < ticks; tick++) {
        bool is_slow = false;
        if (trial->method == HARD_NAIVE) {
            rate -= MS * 5 * rate;
            is_slow = is_denormal(rate);
        } else {
            (void)hard_advance(&run, 0, 1);
            for (int i = 0; i < run.plant.states; i++) {
                is_slow |= is_denormal(run.plant.state.x[i]) || is_denormal(run.plant.state.c[i]);
            }
        }
        slow += is_slow;
    }
    hard_error(result, (double)slow / (double)ticks);
}

/* --- 34 and 44: inputs --- */

static void run_bad_inputs(const hard_trial *trial, hard_result *result)
{
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    hard_run run, twin;
    if (trial->method == HARD_NAIVE) {
        double rate = 0;
        for (int tick = 0; tick < 1000; tick++) {
            rate += 1e-3 * (tick % 10 == 0 ? 5 : bad[tick % 3]);
        }
        hard_error(result, rate);
        return;
    }
    if (!hard_start(&run, trial, NULL, result) || !hard_start(&twin, trial, NULL, result)) {
        return;
    }
    mct_supervisor supervisor;
    const mct_reading well = {{0}, 0, 0};
    for (long tick = 0; tick < steps_of(trial); tick++) {
        const double good = 5 * sin(0.01 * (double)(tick - tick % 10));
        (void)hard_advance(&run, tick % 10 == 0 ? good : bad[tick % 3], 1);
        (void)hard_advance(&twin, good, 1);
        hard_error(result, distance(&run.plant, &twin.plant));
    }
    for (int i = 0; i < 3; i++) {
        mct_supervisor_init(&supervisor, &run.scene);
        const mct_real passed = mct_supervisor_pass(&supervisor, &well, NULL, (mct_real)bad[i]);
        hard_error(result, (double)passed);
        if (supervisor.latched != 1u << MCT_FAULT_COMMAND) {
            hard_error(result, (double)INFINITY);
        }
    }
}

/* The largest number as a torque cannot be: refused, the state kept. As a voltage it is the supply's. */
static void run_huge_input(const hard_trial *trial, hard_result *result)
{
    hard_run run, twin;
    if (trial->method == HARD_NAIVE) {
        const mct_real h = MS, inertia = MCT_R(2.5e-5);
        mct_real rate = 0;
        for (int tick = 0; tick < 1000; tick++) {
            rate += h * ((tick % 10 == 0 ? MCT_REAL_MAX : 0) - MCT_R(1e-6) * rate * rate) / inertia;
        }
        hard_error(result, (double)rate);
        return;
    }
    if (!hard_start(&run, trial, NULL, result) || !hard_start(&twin, trial, NULL, result)) {
        return;
    }
    for (long tick = 0; tick < steps_of(trial); tick++) {
        mct_plant_step(&run.plant, tick % 2 == 0 ? MCT_REAL_MAX : -MCT_REAL_MAX);
        mct_plant_step(&twin.plant, run.plant.input);
        hard_error(result, distance(&run.plant, &twin.plant));
    }
    if (run.plant.diverged_ticks > 0) {
        hard_error(result, (double)INFINITY);
    }
    const char *off = "effects.motor = \"off\"\neffects.saturation = \"off\"\n";
    if (!hard_start(&run, trial, off, result)) {
        return;
    }
    const mct_state before = run.plant.state;
    mct_plant_step(&run.plant, MCT_REAL_MAX);
    for (int i = 0; i < run.plant.states; i++) {
        hard_error(result, (double)(run.plant.state.x[i] - before.x[i]));
    }
    if (run.plant.diverged_ticks != 1) {
        hard_error(result, (double)INFINITY);
    }
}

/* --- 35: scenes that cannot be --- */

static const char *const impossible[] = {
    "parameters.mass = 0\n",   "parameters.mass = -1\n",     "parameters.length = 0\n",
    "parameters.mass = nan\n", "parameters.mass = 1e400\n",  "parameters.gravity = inf\n",
    "scene.dt = 0\n",          "scene.dt = -0.001\n",        "scene.dt = 10\n",
    "scene.dt = nan\n",        "initial.angle = inf\n",      "scene.substeps = 0\n",
    "scene.duration = -1\n",   "parameters.friction = -1\n",
};

static void run_impossible(const hard_trial *trial, hard_result *result)
{
    enum { COUNT = sizeof impossible / sizeof impossible[0] };
    int taken = 0;
    if (trial->method == HARD_NAIVE) {
        /* a pendulum by semi-implicit Euler: mass, length, friction, dt */
        static const double values[][4] = {{0, 1, 0, 1e-3},  {-1, 1, 1, 1e-3}, {1, 0, 0, 1e-3},
                                           {1, 1, 0, -1e-3}, {1, 1, 1, 10},    {1, 1, -1, 1e-3}};
        for (int i = 0; i < 6; i++) {
            const double *v = values[i];
            double angle = 1, rate = 0;
            for (int step = 0; step < 100000; step++) {
                rate += v[3] * (9.81 * v[0] * v[1] * sin(angle) - v[2] * rate) / (v[0] * v[1] * v[1]);
                angle += v[3] * rate;
            }
            taken += !(fabs(rate) < 10); /* more than the pendulum has energy for */
        }
    } else {
        for (int i = 0; i < COUNT; i++) {
            char text[256];
            mct_scene scene;
            mct_message why = {""};
            snprintf(text, sizeof text, "scene.system = \"pendulum\"\n%s", impossible[i]);
            const mct_status status = mct_scene_read(text, strlen(text), "scene", NULL, 0, &scene, &why);
            taken += status == MCT_OK || why.text[0] == '\0';
        }
    }
    hard_error(result, taken);
}

/* --- 36 and 45: counters --- */

/* What an observer makes of a wheel that runs up, from its counter in this many bits and with these turns ahead. */
typedef struct {
    mct_sim sim;
    mct_observer observer;
    mct_reading reading;
} observed;

static void observe_start(observed *self, const mct_scene *scene, int bits, int32_t turns)
{
    mct_scene changed = *scene;
    changed.counter_bits = bits;
    (void)mct_sim_init(&self->sim, &changed, NULL);
    self->sim.plant.state.turns[1] = turns;
    mct_observer_init(&self->observer, &changed, &self->sim.plant.constants);
}

/* Goes on by a tick. */
static void observe(observed *self)
{
    const mct_hal hal = mct_sim_hal(&self->sim);
    hal.ops->read(hal.context, &self->reading);
    mct_observer_update(&self->observer, &self->reading, self->sim.plant.input);
    hal.ops->write(hal.context, 10);
    hal.ops->wait_tick(hal.context);
}

/* Where the wheel is, naively: by its count, or by turns and angle [rad]. */
static double naive_angle(const observed *self, bool by_turns)
{
    return by_turns ? mct_plant_value(&self->sim.plant, 1)
                    : (double)self->reading.counts[1] * (2 * PI / 4096);
}

/* Compares the rate with that from a counter of 32 bits from 0 on; naively, it is the difference of angles. */
static void compare_counters(const hard_trial *trial, int bits, int32_t turns, hard_result *result)
{
    const bool is_naive = trial->method == HARD_NAIVE, by_turns = turns > 1 << 30;
    hard_trial plain = *trial;
    hard_run run;
    observed one, other;
    plain.method = is_naive ? HARD_LIBRARY : trial->method;
    if (!hard_start(&run, &plain, NULL, result)) {
        return;
    }
    observe_start(&one, &run.scene, 32, 0);
    observe_start(&other, &run.scene, bits, turns);
    observe(&one);
    observe(&other);
    for (long tick = steps_of(trial); tick > 0; tick--) {
        const double before = naive_angle(&other, by_turns) - naive_angle(&one, by_turns);
        observe(&one);
        observe(&other);
        const double after = naive_angle(&other, by_turns) - naive_angle(&one, by_turns);
        hard_error(result,
                   is_naive ? (after - before) / 1e-3 : (double)(other.observer.x[3] - one.observer.x[3]));
    }
}

static void run_wrap(const hard_trial *trial, hard_result *result)
{
    compare_counters(trial, 16, 0, result);
    compare_counters(trial, 12, 0, result);
    compare_counters(trial, 32, 524287, result); /* 2^31 counts are 524288 turns */
}

static void run_turns_wrap(const hard_trial *trial, hard_result *result)
{
    compare_counters(trial, 32, INT32_MAX - 2, result);
}

/* --- 37: a sum of ten million ticks --- */

static void run_sum(const hard_trial *trial, hard_result *result)
{
    enum { COUNT = 10000000 };
    const mct_real increment = MS;
    mct_real value = 0, compensation = 0;
    for (int i = 0; i < COUNT; i++) {
        if (trial->method == HARD_NAIVE) {
            value +=
                increment; /* what fast-math makes of it: (sum - larger) is `smaller` to it, the error 0 */
        } else {
            mct_add_compensated(&value, &compensation, increment);
        }
    }
    hard_error(result, ((double)value + (double)compensation) / ((double)increment * COUNT) - 1);
}

/* --- 38: chaos --- */

enum { WINDOW = 100 }; /* ticks */

/* The ball, x = (place, velocity), by rk4 in steps of 0.1 ms over a number of ticks. */
static void ball_rate(const long double *x, long double *dx)
{
    const long double mass = 0.5L, stiffness = 40, rest = 0.3L, gravity = 9.81L;
    const long double length = hypotl(x[0], x[1]);
    const long double pull = -stiffness * (length - rest) / (length * mass);
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = pull * x[0];
    dx[3] = pull * x[1] - gravity;
}

static void ball_advance(long double *x, long ticks)
{
    const long double h = 1e-4L;
    long double k[4][4], stage[4];
    for (long step = 0; step < 10 * ticks; step++) {
        ball_rate(x, k[0]);
        for (int n = 1; n < 4; n++) {
            for (int i = 0; i < 4; i++) {
                stage[i] = x[i] + (n < 3 ? h / 2 : h) * k[n - 1][i];
            }
            ball_rate(stage, k[n]);
        }
        for (int i = 0; i < 4; i++) {
            x[i] += h / 6 * (k[0][i] + 2 * (k[1][i] + k[2][i]) + k[3][i]);
        }
    }
}

static void ball_of(const hard_run *run, long double *x)
{
    const long double r = hard_value(run, 0), angle = hard_value(run, 1);
    const long double s = sinl(angle), c = cosl(angle);
    x[0] = r * c;
    x[1] = r * s;
    x[2] = hard_value(run, 2) * c - r * s * hard_value(run, 3);
    x[3] = hard_value(run, 2) * s + r * c * hard_value(run, 3);
}

static void run_chaos(const hard_trial *trial, hard_result *result)
{
    const bool is_naive = trial->method == HARD_NAIVE;
    hard_trial plain = *trial;
    hard_run run;
    long double exact[4], x[4];
    plain.method = is_naive ? HARD_LIBRARY : trial->method;
    if (!hard_start(&run, &plain, NULL, result)) {
        return;
    }
    ball_of(&run, exact);
    for (long left = steps_of(trial) / WINDOW; left > 0 && hard_advance(&run, 0, WINDOW); left--) {
        ball_advance(exact, WINDOW);
        ball_of(&run, x);
        for (int i = 0; i < 4 && (!is_naive || left == 1); i++) {
            hard_error(result, (double)(x[i] - exact[i]));
        }
        if (!is_naive) {
            memcpy(exact, x, sizeof exact);
        }
    }
}

const hard_case hard_numbers[] = {
    {.number = 15,
     .rule = "time does not stall, however long it runs",
     .naive = "t += dt: a float stands still from 9 h on, a double gathers its roundings",
     .remedy = "time is a count of ticks",
     .measure = "how late an input comes that is asked for after a day [s]",
     .seconds = DAY,
     .criterion = 1e-10,
     .criterion_f32 = 1e-10, /* a count is a count */
     .run = run_clock},
    {.number = 16,
     .rule = "a tick of 1 ms lasts 1 ms, in float too",
     .naive = "dt = 1e-3f, which is 1.00000005 ms",
     .remedy = "what runs in time has its increment in two parts, and a compensated sum: mct_add_parts()",
     .measure = "what the clock of a prescribed force gains or loses [s] in a day",
     .scene = "scene.system = \"block\"\nparameters.force_amplitude = 1e-3\n",
     .seconds = 1000,
     .full_seconds = DAY,
     .criterion = 1e-9,     /* the phase is read off in double, to 1e-15 */
     .criterion_f32 = 1e-5, /* a value and its compensation have 48 bits */
     .run = run_pace},
    {.number = 30,
     .rule = "a chain comes as near to a target out of reach as it can, without leaps",
     .naive = "J^-1 e: near the stretched pose its steps have no bound",
     .remedy = "damped by the error, towards the nearest point in reach",
     .measure =
         "distance from that point after 1000 updates, reach 2 m [m]; infinite after a leap by half a turn",
     .scene = "scene.system = \"chain\"\nparameters.link_lengths = [1, 1]\n",
     .seconds = 1,
     .criterion = 1e-6,
     .criterion_f32 = 1e-5,
     .run = run_reach},
    {.number = 31,
     .rule = "a chain that is stretched exactly bends for a target in line with it",
     .naive = "damped least squares: J'e is 0, so nothing moves",
     .remedy = "without a gradient each joint is bent by 1e-3 rad",
     .measure = "distance from the target after 1000 updates, reach 2 m [m]",
     .scene = "scene.system = \"chain\"\nparameters.link_lengths = [1, 1]\n",
     .seconds = 1,
     .criterion = 1e-6,
     .criterion_f32 = 1e-5,
     .run = run_stretched},
    {.number = 32,
     .rule = "columns that depend on each other share what they fit",
     .naive = "normal equations, whose determinant is rounding",
     .remedy = "orthogonal reflections with a ridge: the smallest solution",
     .measure = "error of coefficients that are 1",
     .criterion = 1e-10,    /* the ridge, 1e-10 */
     .criterion_f32 = 1e-4, /* the ridge, 1e-4 */
     .run = run_dependent_columns},
    {.number = 33,
     .rule = "what decays comes to rest, not into denormal numbers",
     .naive = "v -= h b v: the last bit of a denormal number does not decay",
     .remedy = "a state below 2^-918, in float 2^-80, is 0: mct_plant_step()",
     .measure = "share of all ticks with a denormal number in the state",
     .scene = "scene.system = \"pendulum\"\neffects.gravity = false\nparameters.friction = 0.05\n"
              "initial.angle_rate = 1\n",
     .seconds = 200,
     .criterion = 1e-300,
     .criterion_f32 = 1e-300,
     .run = run_decay},
    {.number = 34,
     .rule = "an input that is not a number changes nothing and latches a fault",
     .naive = "it is added, and from then on nothing is a number",
     .remedy = "the last valid input is held, the refusal counted, the voltage cut with a named fault",
     .measure = "largest difference from a run that is given what is held",
     .scene = "scene.system = \"reaction_wheel\"\n",
     .seconds = 1,
     .criterion = 1e-300, /* not a bit */
     .criterion_f32 = 1e-300,
     .run = run_bad_inputs},
    {.number = 35,
     .rule = "what cannot be is refused before the first step, with its reason",
     .naive = "simulated all the same: mass, length or step of 0, below 0 or far too large",
     .remedy = "ranges of every key, read from its descriptor",
     .measure = "scenes that were taken",
     .criterion = 1e-300,
     .criterion_f32 = 1e-300,
     .run = run_impossible},
    {.number = 36,
     .rule = "an encoder's counter wraps without a trace",
     .naive = "the difference of counts: 1e5 rad/s at the wrap",
     .remedy = "the difference modulo the counter's range",
     .measure = "largest difference of the estimated rate from that of a counter without a wrap [rad/s]",
     .scene = "scene.system = \"reaction_wheel\"\n",
     .seconds = 10,
     .criterion = 1e-300, /* not a bit */
     .criterion_f32 = 1e-300,
     .run = run_wrap},
    {.number = 37,
     .rule = "a sum keeps what rounding drops, which -ffast-math would remove: such a build is refused",
     .naive = "compiled with -ffast-math, compensation is 0 by algebra: a plain sum",
     .remedy = "real.h refuses to be compiled with it; the library's own build never has it",
     .measure = "relative error of the sum of ten million increments",
     .criterion = 1e-15,
     .criterion_f32 = 1e-12,
     .run = run_sum},
    {.number = 38,
     .rule = "a chaotic motion is judged by windows, not by where it ends",
     .naive = "where it ends: any rounding makes it another motion",
     .remedy = "the defect of each window of 0.1 s against the motion from the window's own start",
     .measure = "largest error of place and velocity in a window, naively at the end [m, m/s]",
     .scene = "scene.system = \"spring_pendulum\"\nscene.stepper = \"taylor8\"\neffects.viscous = false\n"
              "initial.length = 0.5\ninitial.angle = -0.3\ninitial.angle_rate = 1\n",
     .seconds = 30,
     .criterion = 1e-12,
     .criterion_f32 = 1e-5,
     .run = run_chaos},
    {.number = 41,
     .rule = "a sine of 50 Hz is in phase after a day",
     .naive = "sin(w t) with t summed up",
     .remedy = "its phase is a product of the tick's number, in double",
     .measure = "largest error of a sine of amplitude 1 over 2 s after a day",
     .seconds = DAY,
     .criterion = 1e-8, /* a phase of 2.7e7 rad has roundings of 4e-9 */
     .criterion_f32 = 1e-7,
     .run = run_sine},
    {.number = 42,
     .rule = "a tick of 0.1 us moves what a float can hold",
     .naive = "float states: increments are below a rounding, a smaller step makes it worse",
     .remedy = "compensated states",
     .measure = "largest error of rate and angle after 0.05 s of decay [rad/s, rad]",
     .scene = "scene.system = \"pendulum\"\nscene.dt = 1e-7\neffects.gravity = false\nparameters.mass = 1\n"
              "parameters.length = 1\nparameters.friction = 10\ninitial.angle = 1\ninitial.angle_rate = 1\n",
     .seconds = 0.05,
     .criterion = 1e-13,
     .criterion_f32 = 1e-6,
     .run = run_short_tick},
    {.number = 43,
     .rule = "a clock passes 2^32, 2^53 and 2^63 ticks unnoticed",
     .naive = "time in seconds: t + dt is t",
     .remedy = "64 bits of ticks, and nothing but the ticks depends on them",
     .measure =
         "largest difference of a closed loop's states from those of a clock at 0; naively, the step's error",
     .scene = "scene.system = \"reaction_wheel\"\n",
     .seconds = 2,
     .criterion = 1e-300, /* not a bit */
     .criterion_f32 = 1e-300,
     .run = run_late_clock},
    {.number = 44,
     .rule = "the largest number there is does no harm as an input",
     .naive = "it is added, and its square is infinite",
     .remedy = "a voltage is bounded by the supply; a torque that throws a state out of bounds is refused",
     .measure = "largest difference from a run at the supply's voltage, and of the kept state",
     .scene = "scene.system = \"reaction_wheel\"\n",
     .seconds = 1,
     .criterion = 1e-300, /* not a bit */
     .criterion_f32 = 1e-300,
     .run = run_huge_input},
    {.number = 45,
     .rule = "the count of whole turns wraps at 2^31 without a trace",
     .naive = "turns and angle as one number, which leaps by 2^32 turns",
     .remedy = "turns and counts are integers modulo 2^32",
     .measure = "largest difference of the estimated rate from that without a wrap [rad/s]",
     .scene = "scene.system = \"reaction_wheel\"\n",
     .seconds = 2,
     .criterion = 1e-300, /* not a bit */
     .criterion_f32 = 1e-300,
     .run = run_turns_wrap},
    {.rule = NULL}};

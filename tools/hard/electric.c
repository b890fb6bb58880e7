/* Hard cases of the motor: a current that follows in microseconds, none at all, jumps of the voltage. */
#include <math.h>
#include <stdlib.h>

#include "hard_run.h"

#define TICK 1e-3

/* --- a wheel with an inductive motor --- */

/* x = (arm, wheel, arm_rate, wheel_rate, current); dx = A x + b u + (0, 0, weight) sin(arm). */
enum { ARM, WHEEL, ARM_RATE, WHEEL_RATE, CURRENT, STATES };

typedef struct {
    double A[STATES][STATES], weight[STATES], per_volt; /* of the current's rate */
} wheel_model;

#define WHEEL_SCENE                                                            \
    "scene.system = \"reaction_wheel\"\neffects.motor = \"inductive\"\n"       \
    "parameters.wheel_mass = 0.1\nparameters.wheel_inertia = 2.5e-5\n"         \
    "parameters.arm_length = 0.13\nparameters.arm_inertia = 0.003\n"           \
    "parameters.arm_moment = 0.025\nparameters.gravity = 9.81\n"               \
    "parameters.arm_friction = 2e-4\nparameters.wheel_friction = 3e-6\n"       \
    "parameters.torque_constant = 0.03\nparameters.back_emf_constant = 0.03\n" \
    "parameters.resistance = 10\ninitial.arm_angle = 2\n"

/* The same numbers, from the equations: J a1 + I a2 = moment g sin - nu1 w1, I (a1 + a2) = kt i - nu2 w2. */
static wheel_model wheel_of(double inductance)
{
    const double I = 2.5e-5, arm = 0.1 * 0.13 * 0.13 + 0.003; /* J - I */
    const double moment = (0.025 + 0.1 * 0.13) * 9.81, nu1 = 2e-4, nu2 = 3e-6, k = 0.03;
    wheel_model self = {.per_volt = 1 / inductance};
    self.A[ARM][ARM_RATE] = self.A[WHEEL][WHEEL_RATE] = 1;
    self.A[ARM_RATE][ARM_RATE] = -nu1 / arm;
    self.A[ARM_RATE][WHEEL_RATE] = nu2 / arm;
    self.A[ARM_RATE][CURRENT] = -k / arm;
    self.weight[ARM_RATE] = moment / arm;
    for (int i = 0; i < STATES; i++) {
        self.A[WHEEL_RATE][i] = -self.A[ARM_RATE][i];
    }
    self.A[WHEEL_RATE][WHEEL_RATE] -= nu2 / I;
    self.A[WHEEL_RATE][CURRENT] += k / I;
    self.weight[WHEEL_RATE] = -self.weight[ARM_RATE];
    self.A[CURRENT][WHEEL_RATE] = -k / inductance;
    self.A[CURRENT][CURRENT] = -10 / inductance;
    return self;
}

/* A Taylor step of order 17: c[n] are the coefficients of x, s and c those of the arm's sine and cosine. */
static void wheel_step(const wheel_model *self, long double *x, double u, long double h)
{
    enum { ORDER = 17 };
    long double c[ORDER + 1][STATES], sine[ORDER], cosine[ORDER];
    for (int i = 0; i < STATES; i++) {
        c[0][i] = x[i];
    }
    sine[0] = sinl(x[ARM]);
    cosine[0] = cosl(x[ARM]);
    for (int n = 0; n < ORDER; n++) {
        for (int k = 1; k <= n; k++) {
            sine[n] = (k > 1 ? sine[n] : 0) + k * c[k][ARM] * cosine[n - k] / n;
            cosine[n] = (k > 1 ? cosine[n] : 0) - k * c[k][ARM] * sine[n - k] / n;
        }
        for (int i = 0; i < STATES; i++) {
            long double rate = self->weight[i] * sine[n] + (n == 0 && i == CURRENT ? self->per_volt * u : 0);
            for (int j = 0; j < STATES; j++) {
                rate += self->A[i][j] * c[n][j];
            }
            c[n + 1][i] = rate / (n + 1);
        }
    }
    for (int i = 0; i < STATES; i++) {
        for (int n = ORDER; n > 0; n--) {
            c[n - 1][i] += h * c[n][i];
        }
        x[i] = c[0][i];
    }
}

typedef struct {
    double inductance;
    double (*voltage)(uint64_t tick);
} wheel_drive;

static double held_sine(uint64_t tick)
{
    return (double)(float)(8 * sin(4 * TICK * (double)tick)); /* the same in both precisions */
}

/* +-8 V, thrown anew each tick. */
static double thrown(uint64_t tick)
{
    uint64_t bits = (tick + 1) * UINT64_C(0x9e3779b97f4a7c15);
    bits = (bits ^ (bits >> 31)) * UINT64_C(0xbf58476d1ce4e5b9);
    return bits >> 63 ? 8 : -8;
}

static const wheel_drive fast = {1e-4, held_sine}, jumping = {0.05, thrown};

static const wheel_drive *drive_of(const hard_case *about)
{
    return about->number == 1 ? &fast : &jumping;
}

/* A row of states for each tick's end. Steps of two time constants: 2^18/18! of a transient of 1 A is left, 4e-11. */
static void *follow_wheel(const hard_case *about, double seconds)
{
    const wheel_drive *drive = drive_of(about);
    const wheel_model model = wheel_of(drive->inductance);
    const uint64_t ticks = (uint64_t)(seconds / TICK + 0.5);
    const int parts = (int)ceil(TICK / (2 * drive->inductance / 10)) + 1;
    long double x[STATES] = {2};
    double *rows = malloc(ticks * STATES * sizeof *rows);
    for (uint64_t tick = 0; rows != NULL && tick < ticks; tick++) {
        for (int i = 0; i < parts; i++) {
            wheel_step(&model, x, drive->voltage(tick), (long double)TICK / parts);
        }
        for (int i = 0; i < STATES; i++) {
            rows[tick * STATES + (uint64_t)i] = (double)x[i];
        }
    }
    return rows;
}

static void wheel_rate(const wheel_model *self, const double *x, double u, double *dx)
{
    for (int i = 0; i < STATES; i++) {
        dx[i] = self->weight[i] * sin(x[ARM]) + (i == CURRENT ? self->per_volt * u : 0);
        for (int j = 0; j < STATES; j++) {
            dx[i] += self->A[i][j] * x[j];
        }
    }
}

/* Classical Runge-Kutta, which knows nothing of time constants. */
static void runge_kutta(const wheel_model *self, double *x, double u)
{
    static const double part[4] = {0, 0.5, 0.5, 1}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    double slope[STATES] = {0}, sum[STATES] = {0}, at[STATES];
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < STATES; i++) {
            at[i] = x[i] + part[stage] * TICK * slope[i];
        }
        wheel_rate(self, at, u, slope);
        for (int i = 0; i < STATES; i++) {
            sum[i] += weight[stage] * slope[i];
        }
    }
    for (int i = 0; i < STATES; i++) {
        x[i] += TICK * sum[i];
    }
}

/* Adams and Bashforth's method of order 2: its memory reaches over the jump. */
static void adams_bashforth(const wheel_model *self, double *x, double u, double *before, bool is_first)
{
    double now[STATES];
    wheel_rate(self, x, u, now);
    for (int i = 0; i < STATES; i++) {
        x[i] += TICK * (is_first ? now[i] : 1.5 * now[i] - 0.5 * before[i]);
        before[i] = now[i];
    }
}

static void run_wheel(const hard_trial *trial, hard_result *result)
{
    const wheel_drive *drive = drive_of(trial->about);
    const wheel_model model = wheel_of(drive->inductance);
    const double *exact = trial->shared;
    const bool is_naive = trial->method == HARD_NAIVE;
    double x[STATES] = {2}, before[STATES], size[STATES], worst[STATES] = {0};
    hard_run run;
    if (!is_naive && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (int i = 0; i < STATES; i++) {
        size[i] = 1;
    }
    for (uint64_t tick = 0; tick < (uint64_t)(trial->seconds / TICK + 0.5); tick++) {
        const double u = drive->voltage(tick);
        if (!is_naive && !hard_advance(&run, u, 1)) {
            return;
        }
        if (is_naive && drive == &fast) {
            runge_kutta(&model, x, u);
        } else if (is_naive) {
            adams_bashforth(&model, x, u, before, tick == 0);
        }
        for (int i = 0; i < STATES; i++) {
            const double at = exact[tick * STATES + (uint64_t)i];
            const double error = fabs((is_naive ? x[i] : hard_value(&run, i)) - at);
            worst[i] = error <= worst[i] ? worst[i] : error; /* a NaN stays */
            size[i] = fmax(size[i], fabs(at));
        }
    }
    for (int i = 0; i < STATES; i++) {
        hard_error(result, worst[i] / size[i]);
    }
}

/* --- no inductance, no resistance --- */

/* Largest distance of the arm's run from that with the limit itself. */
static void compare_motors(const hard_trial *trial, const char *limit, const char *near, hard_result *result)
{
    hard_run run[2];
    if (!hard_start(&run[0], trial, limit, result) || !hard_start(&run[1], trial, near, result)) {
        return;
    }
    for (uint64_t tick = 0; tick < hard_ticks(&run[0], trial); tick++) {
        const double u = held_sine(tick);
        if (!hard_advance(&run[0], u, 1) || !hard_advance(&run[1], u, 1)) {
            return;
        }
        for (int i = 0; i <= WHEEL_RATE; i++) {
            hard_error(result, (hard_value(&run[0], i) - hard_value(&run[1], i)) /
                                   fmax(1, fabs(hard_value(&run[0], i))));
        }
    }
}

static void run_limits(const hard_trial *trial, hard_result *result)
{
    if (trial->method == HARD_NAIVE) { /* di/dt as it is written */
        const double inductance = 0, current = 0, u = 8;
        hard_error(result, current + TICK * (u - 10 * current) / inductance);
        return;
    }
    compare_motors(trial, "parameters.resistance = 10\nparameters.inductance = 0\n",
                   "parameters.resistance = 10\nparameters.inductance = 1e-10\n", result);
    if (!result->is_refused) {
        compare_motors(trial, "parameters.resistance = 0\nparameters.inductance = 0.01\n",
                       "parameters.resistance = 1e-12\nparameters.inductance = 0.01\n", result);
    }
}

/* --- a fast wheel that its own voltage holds --- */

/* Without weight and friction: W = V/k (1 - e^(-t/T)), T = I' R / k^2, I' = I (1 - I/J). */
static void run_spin_up(const hard_trial *trial, hard_result *result)
{
    const double k = 1e-3, I = 1e-10, J = 0.01 + I, end = 10 / k;
    const double rate = k * k / (I * (1 - I / J) * 1.0); /* 1/T: 10 000/s */
    double w = 0;
    hard_run run;
    const bool is_naive = trial->method == HARD_NAIVE;
    if (!is_naive && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (uint64_t tick = 1; tick <= (uint64_t)(trial->seconds / TICK + 0.5); tick++) {
        const double before = w;
        if (is_naive) {
            w += TICK * rate * (end - w);
        } else if (!hard_advance(&run, 10, 1)) {
            return;
        } else {
            w = hard_value(&run, WHEEL_RATE);
        }
        hard_error(result, w / end + expm1(-rate * TICK * (double)tick));
        hard_error(result, fmax(0, before - w) / end); /* it never slows */
    }
}

const hard_case hard_electric[] = {
    {.number = 1,
     .rule = "a current that settles in 10 us is followed at 1 ms",
     .naive = "classical Runge-Kutta: h R/L = 100, beyond its 2.785, grows without bound",
     .remedy = "expo: the linear part, motor included, is flowed exactly, whatever L/R",
     .measure = "largest error of any state, of its size or of 1",
     .scene = WHEEL_SCENE "parameters.inductance = 1e-4\n",
     .seconds = 10,
     .criterion = 1e-8,
     .criterion_f32 = 5e-6, /* forty roundings of a state of some radians */
     .prepare = follow_wheel,
     .run = run_wheel},
    {.number = 2,
     .rule = "no inductance and no resistance are limits like others",
     .naive = "di/dt = (V - R i - k w) / L: a division by zero",
     .remedy =
         "without inductance the motor is the quasi-static one; without resistance the flow is as exact",
     .measure = "largest distance from the run with L/R = 10 ps, or with L/R = 1e10 s",
     .scene = "scene.system = \"reaction_wheel\"\ninitial.arm_angle = 2\n",
     .seconds = 10,
     .criterion = 1e-6,
     .criterion_f32 = 1e-4,
     .run = run_limits},
    {.number = 3,
     .rule = "a voltage that jumps every tick costs no accuracy",
     .naive = "Adams and Bashforth's method, whose memory reaches over the jump",
     .remedy = "one-step methods alone: each tick begins anew",
     .measure = "largest error of any state, of its size or of 1",
     .scene = WHEEL_SCENE "parameters.inductance = 0.05\n",
     .seconds = 10,
     .criterion = 1e-8,
     .criterion_f32 = 5e-6,
     .prepare = follow_wheel,
     .run = run_wheel},
    {.number = 4,
     .rule = "a wheel that its own voltage holds spins up to V/k and not beyond",
     .naive = "an explicit step: ten times the time constant, so each step overshoots by nine",
     .remedy = "the back-EMF is part of the exact flow",
     .measure = "largest error of the speed, and any loss of it, of V/k = 10 000 rad/s",
     .scene = "scene.system = \"reaction_wheel\"\neffects.motor = \"quasi_static\"\n"
              "effects.gravity = false\neffects.viscous = false\ninitial.arm_angle = 0\n"
              "parameters.wheel_mass = 1e-6\nparameters.arm_length = 0.0001\nparameters.arm_inertia = 0.01\n"
              "parameters.wheel_inertia = 1e-10\nparameters.resistance = 1\n"
              "parameters.torque_constant = 0.001\nparameters.back_emf_constant = 0.001\n",
     .seconds = 1,
     .criterion = 1e-12,
     .criterion_f32 = 1e-5,
     .run = run_spin_up},
    {.rule = NULL},
};

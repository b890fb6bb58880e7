/* Hard cases of many steps: a swing that nearly stops, the way back, energy. */
#include <math.h>
#include <string.h>

#include "hard_run.h"

#define TICK 1e-3
#define PI   3.141592653589793

/* g/l = 19.5 /s^2, a number of both precisions. The angle is clockwise from upright. */
#define PENDULUM(stepper, angle)                                                                   \
    "scene.system = \"pendulum\"\n" stepper "effects.viscous = false\nparameters.gravity = 9.75\n" \
    "parameters.length = 0.5\ninitial.angle = " angle "\n"
static const double pull = 19.5;

/* Ticks of a plant, or those of classical Runge-Kutta for HARD_NAIVE; x = (angle, rate). */
typedef struct {
    hard_run run;
    bool is_naive;
    mct_real x[2];
} swing;

static bool swing_start(swing *self, const hard_trial *trial, double angle, hard_result *result)
{
    self->is_naive = trial->method == HARD_NAIVE;
    self->x[0] = (mct_real)angle;
    self->x[1] = 0;
    return self->is_naive || hard_start(&self->run, trial, NULL, result);
}

static void runge_kutta(mct_real *x)
{
    static const mct_real part[4] = {0, MCT_R(0.5), MCT_R(0.5), 1};
    const mct_real h = MCT_R(TICK);
    mct_real slope[2] = {0, 0}, sum[2] = {0, 0};
    for (int stage = 0; stage < 4; stage++) {
        const mct_real angle = x[0] + part[stage] * h * slope[0];
        slope[0] = x[1] + part[stage] * h * slope[1];
        slope[1] = MCT_R(pull * sin((double)angle));
        const mct_real weight = (stage == 0 || stage == 3 ? MCT_R(1) : MCT_R(2)) / 6;
        sum[0] += weight * slope[0];
        sum[1] += weight * slope[1];
    }
    x[0] += h * sum[0];
    x[1] += h * sum[1];
}

static bool swing_tick(swing *self)
{
    if (self->is_naive) {
        runge_kutta(self->x);
        return true;
    }
    return hard_advance(&self->run, 0, 1);
}

static double swing_value(const swing *self, int i)
{
    return self->is_naive ? (double)self->x[i] : hard_value(&self->run, i);
}

/* --- from 1e-6 rad beside upright --- */

/* Complete elliptic integral K of sqrt(1 - other^2), by the arithmetic-geometric mean. */
static long double quarter(long double other)
{
    long double a = 1, b = other;
    for (int i = 0; i < 10; i++) {
        const long double mean = (a + b) / 2;
        b = sqrtl(a * b);
        a = mean;
    }
    return 3.14159265358979323846L / (2 * a);
}

/* From the start to the lowest point: a quarter of the period, K / w. */
static void run_separatrix(const hard_trial *trial, hard_result *result)
{
    const double exact = (double)(quarter(sinl(1e-6L / 2)) / sqrtl(pull));
    const bool is_naive = trial->method == HARD_NAIVE;
    mct_real angle = MCT_R(PI - 1e-6), rate = 0; /* of the naive one, from hanging */
    double above = 1;                            /* the lowest point [rad] */
    uint64_t tick = 0;
    swing self;
    if (!swing_start(&self, trial, 0, result)) {
        return;
    }
    while (above > 0 && (double)tick * TICK < trial->seconds) {
        if (is_naive) { /* semi-implicit Euler */
            rate -= MCT_R(TICK) * MCT_R(pull * sin((double)angle));
            angle += MCT_R(TICK) * rate;
            above = (double)angle;
        } else if (swing_tick(&self)) {
            above = PI - swing_value(&self, 0);
        } else {
            return;
        }
        tick++;
    }
    /* Back to the passage: x(t) = w t (1 - pull t^2 / 6) around it, w being the rate there. */
    const double since = -above / fabs(is_naive ? (double)rate : swing_value(&self, 1));
    hard_error(result, ((double)tick * TICK - since * (1 - pull * since * since / 3)) / exact - 1);
}

/* --- there and back --- */

/* As many steps with the rate reversed, after those of `seconds`: distance from the start. */
static void run_reversal(const hard_trial *trial, hard_result *result)
{
    const uint64_t ticks = (uint64_t)(trial->seconds / TICK + 0.5);
    swing self;
    if (!swing_start(&self, trial, 2, result)) {
        return;
    }
    const double start = swing_value(&self, 0);
    for (uint64_t tick = 0; tick < 2 * ticks; tick++) {
        if (tick == ticks) {
            mct_state *state = &self.run.plant.state;
            self.x[1] = -self.x[1];
            state->x[1] = -state->x[1];
            state->c[1] = -state->c[1];
        }
        if (!swing_tick(&self)) {
            return;
        }
    }
    hard_error(result, swing_value(&self, 0) - start);
    hard_error(result, swing_value(&self, 1) / sqrt(pull));
}

/* --- energy --- */

static long double energy_of(const swing *self)
{
    const long double angle = swing_value(self, 0), rate = swing_value(self, 1);
    return rate * rate / 2 + (long double)pull * cosl(angle);
}

/* Largest change of the energy, looked at each second, of what lies between hanging and upright. */
static void run_energy(const hard_trial *trial, hard_result *result)
{
    const bool forgets = trial->about->number == 25 && trial->method == HARD_NAIVE;
    swing self;
    if (forgets) { /* the library's own steps, without what rounding keeps back */
        hard_trial own = *trial;
        own.method = HARD_LIBRARY;
        if (!swing_start(&self, &own, 1, result)) {
            return;
        }
    } else if (!swing_start(&self, trial, 1, result)) {
        return;
    }
    const long double start = energy_of(&self);
    for (uint64_t tick = 1; tick <= (uint64_t)(trial->seconds / TICK + 0.5); tick++) {
        if (!swing_tick(&self)) {
            return;
        }
        if (forgets) {
            memset(self.run.plant.state.c, 0, sizeof self.run.plant.state.c);
        }
        if (tick % 1000 == 0) {
            hard_error(result, (double)((energy_of(&self) - start) / (2 * pull)));
        }
    }
}

const hard_case hard_long[] = {
    {.number = 22,
     .rule = "a pendulum falls from 1e-6 rad beside upright in the time of the textbook",
     .naive = "semi-implicit Euler, the angle from hanging: pi - 1e-6 has lost half its digits",
     .remedy = "rk4, the angle from upright: its digits are those of the distance",
     .measure = "relative error of a quarter of the period, K(k) / w",
     .scene = PENDULUM("", "1e-6"),
     .seconds = 10,
     .criterion = 1.4e-10,
     .criterion_f32 = 1e-5,
     .run = run_separatrix},
    {.number = 23,
     .rule = "1e5 steps and as many backwards end where they began",
     .naive = "Runge-Kutta: its error has a direction in time",
     .remedy = "leap: symmetric in time, with compensated sums",
     .measure = "distance from the start, in rad; of the rate, over that of small swings",
     .scene = PENDULUM("scene.stepper = \"leap\"\n", "2"),
     .seconds = 100,
     .criterion = 3e-14,
     .criterion_f32 = 6e-6,
     .run = run_reversal},
    {.number = 24,
     .rule = "energy is kept to rounding however long one simulates",
     .naive = "Runge-Kutta: a loss of energy each step",
     .remedy = "taylor8: exact to rounding at 1 kHz, with compensated sums",
     .measure = "largest change of the energy, of that between hanging and upright",
     .scene = PENDULUM("scene.stepper = \"taylor8\"\n", "1"),
     .seconds = 1000,
     .full_seconds = 100000,
     .criterion = 1e-14,
     .criterion_f32 = 2e-5,
     .run = run_energy},
    {.number = 25,
     .rule = "roundings of a million steps do not add up",
     .naive = "the same steps, added without what rounding keeps back",
     .remedy = "each state carries the rest of its sum",
     .measure = "largest change of the energy, of that between hanging and upright",
     .scene = PENDULUM("scene.stepper = \"taylor8\"\n", "1"),
     .seconds = 1000,
     .full_seconds = 100000,
     .criterion = 1e-14,
     .criterion_f32 = 1.1e-5,
     .run = run_energy},
    {.rule = NULL},
};

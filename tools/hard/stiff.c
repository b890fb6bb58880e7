/* Hard cases of scales far apart: a cart without mass, springs through their pivot and stiff ones. */
#include <math.h>

#include "hard_run.h"

#define TICK 1e-3

/* --- a cart of a millionth of its pole's mass --- */

#define LIGHT_CART                                                                          \
    "scene.system = \"cart_pole\"\neffects.motor = \"off\"\neffects.viscous = false\n"      \
    "parameters.cart_mass = 1e-6\nparameters.pole_mass = 1\nparameters.pole_length = 0.5\n" \
    "parameters.gravity = 9.81\ninitial.pole_angle = 2\n"

/* At rest: cart -m g s c / (M + m s^2), pole g s (M + m) / (l (M + m s^2)). */
static void run_determinant(const hard_trial *trial, hard_result *result)
{
    hard_run run;
    mct_evaluation now;
    if (!hard_start(&run, trial, "scene.dt = 1e-7\n" LIGHT_CART, result)) {
        return;
    }
    for (double angle = 1e-4; angle < 3; angle *= 1.3) {
        const mct_real th = (mct_real)angle;
        const long double s = sinl(th), c = cosl(th), g = (mct_real)9.81, M = (mct_real)1e-6;
        const long double cart = -g * s * c / (M + s * s), pole = 2 * g * s * (M + 1) / (M + s * s);
        run.plant.state.x[1] = th;
        mct_plant_evaluate(&run.plant, &now);
        if (trial->method == HARD_NAIVE) { /* Cramer's rule, as it is written */
            const mct_real m11 = now.M[0][0], m12 = now.M[0][1], m22 = now.M[1][1];
            const mct_real determinant = m11 * m22 - m12 * m12;
            now.acceleration[0] = (m22 * now.tau[0] - m12 * now.tau[1]) / determinant;
            now.acceleration[1] = (m11 * now.tau[1] - m12 * now.tau[0]) / determinant;
        }
        hard_error(result, (double)(now.acceleration[0] / cart - 1));
        hard_error(result, (double)(now.acceleration[1] / pole - 1));
    }
}

static void light_cart_rate(const double *x, double *dx)
{
    const double s = sin(x[1]), c = cos(x[1]), det = 1e-6 + s * s;
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = s * (0.5 * x[3] * x[3] - 9.81 * c) / det;
    dx[3] = s * (9.81 * (1 + 1e-6) - 0.5 * x[3] * x[3] * c) / (0.5 * det);
}

static void runge_kutta(void (*rate)(const double *x, double *dx), double *x)
{
    static const double part[4] = {0, 0.5, 0.5, 1}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    double slope[4] = {0}, sum[4] = {0}, at[4];
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < 4; i++) {
            at[i] = x[i] + part[stage] * TICK * slope[i];
        }
        rate(at, slope);
        for (int i = 0; i < 4; i++) {
            sum[i] += weight[stage] * slope[i];
        }
    }
    for (int i = 0; i < 4; i++) {
        x[i] += TICK * sum[i];
    }
}

/* Energy gained, of what lies between hanging and upright. */
static void run_light_cart(const hard_trial *trial, hard_result *result)
{
    double x[4] = {0, 2, 0, 0};
    hard_run run;
    const bool is_naive = trial->method == HARD_NAIVE;
    if (!is_naive && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    const double start = is_naive ? 9.81 * 0.5 * cos(2) : hard_energy(&run), scale = 2 * 9.81 * 0.5;
    for (uint64_t tick = 0; tick < (uint64_t)(trial->seconds / TICK + 0.5); tick++) {
        double energy;
        if (is_naive) {
            runge_kutta(light_cart_rate, x);
            energy = 0.5 * (1 + 1e-6) * x[2] * x[2] + 0.5 * cos(x[1]) * x[2] * x[3] + 0.125 * x[3] * x[3] +
                     9.81 * 0.5 * cos(x[1]);
        } else if (hard_advance(&run, 0, 1)) {
            energy = hard_energy(&run);
        } else {
            return;
        }
        hard_error(result, energy < start ? 0 : (energy - start) / scale);
    }
}

/* --- a spring through its pivot --- */

#define SPRING(rest, k, rate)                                                                \
    "scene.system = \"spring_pendulum\"\neffects.gravity = false\neffects.viscous = false\n" \
    "parameters.mass = 1\nparameters.stiffness = " k "\nparameters.rest_length = " rest "\n" \
    "initial.length = 1\ninitial.angle = 0.3\ninitial.angle_rate = " rate "\n"

/* m = 1, k = 100; polar coordinates, as they are. */
static void polar_rate(const double *x, double *dx)
{
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = x[0] * x[3] * x[3] - 100 * x[0];
    dx[3] = -2 * x[2] * x[3] / x[0];
}

static void cartesian(const double *polar, double *x)
{
    x[0] = polar[0] * cos(polar[1]);
    x[1] = polar[0] * sin(polar[1]);
    x[2] = polar[2] * cos(polar[1]) - polar[0] * polar[3] * sin(polar[1]);
    x[3] = polar[2] * sin(polar[1]) + polar[0] * polar[3] * cos(polar[1]);
}

/* Errors of place and of velocity / 10, of 1 m, in the axes along and across the rod at its start. */
static void spring_error(const double *polar, double along, double across, double along_rate,
                         double across_rate, hard_result *result)
{
    const double c = cos(0.3), s = sin(0.3);
    double x[4];
    cartesian(polar, x);
    hard_error(result, x[0] - (along * c - across * s));
    hard_error(result, x[1] - (along * s + across * c));
    hard_error(result, (x[2] - (along_rate * c - across_rate * s)) / 10);
    hard_error(result, (x[3] - (along_rate * s + across_rate * c)) / 10);
}

static bool next_polar(hard_run *run, double *polar)
{
    const bool is_well = hard_advance(run, 0, 1);
    for (int i = 0; i < 4; i++) {
        polar[i] = hard_value(run, i);
    }
    return is_well;
}

/* The ball passes the pivot at 0.1 mm: along cos 10 t, across 1e-4 sin 10 t. */
static void run_passage(const hard_trial *trial, hard_result *result)
{
    double polar[4] = {1, 0.3, 0, 1e-3};
    hard_run run;
    if (trial->method != HARD_NAIVE && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (uint64_t tick = 1; tick <= (uint64_t)(trial->seconds / TICK + 0.5); tick++) {
        const double t = 10 * TICK * (double)tick;
        if (trial->method == HARD_NAIVE) {
            runge_kutta(polar_rate, polar);
        } else if (!next_polar(&run, polar)) {
            return;
        }
        spring_error(polar, cos(t), 1e-4 * sin(t), -10 * sin(t), 1e-3 * cos(t), result);
    }
}

/* Along a line through the pivot the spring's force jumps there: x'' = -100 (x - 0.3 sign x). */
static void line_rate(const double *x, double *dx)
{
    dx[0] = x[2];
    dx[1] = dx[3] = 0;
    dx[2] = -100 * (x[0] - copysign(0.3, x[0]));
}

/* From 1 m to the pivot in a quarter of the period, on the other side the same mirrored. */
static void run_kink(const hard_trial *trial, hard_result *result)
{
    const double quarter = acos(-0.3 / 0.7) / 10;
    double x[4] = {1, 0, 0, 0}, polar[4];
    hard_run run;
    if (trial->method != HARD_NAIVE && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (uint64_t tick = 1; tick <= (uint64_t)(trial->seconds / TICK + 0.5); tick++) {
        const double t = remainder(TICK * (double)tick, 4 * quarter); /* even about a turn of the motion */
        const double side = fabs(t) < quarter ? 1 : -1;
        const double since = side > 0 ? t : t - copysign(2 * quarter, t);
        if (trial->method == HARD_NAIVE) {
            runge_kutta(line_rate, x);
            polar[0] = x[0];
            polar[1] = 0.3;
            polar[2] = x[2];
            polar[3] = 0;
        } else if (!next_polar(&run, polar)) {
            return;
        }
        spring_error(polar, side * (0.3 + 0.7 * cos(10 * since)), 0, -7 * side * sin(10 * since), 0, result);
    }
}

/* --- a spring whose oscillation a step does not see --- */

/* Largest change of the energy; the ball swings from aside, at the spring's own length. */
static void run_stiff_spring(const hard_trial *trial, hard_result *result)
{
    const double k = 1e8, g = 9.81;
    double place[2] = {cos(0.6), -sin(0.6)}, velocity[2] = {0, 0}, start = 0;
    hard_run run;
    const bool is_naive = trial->method == HARD_NAIVE;
    if (!is_naive && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (uint64_t tick = 0; tick <= (uint64_t)(trial->seconds / TICK + 0.5); tick++) {
        double energy;
        if (is_naive) {
            const double length = hypot(place[0], place[1]), stretch = length - 1;
            energy = 0.5 * k * stretch * stretch + g * place[1] +
                     0.5 * (velocity[0] * velocity[0] + velocity[1] * velocity[1]);
            for (int i = 0; i < 2; i++) { /* semi-implicit Euler */
                velocity[i] -= TICK * (k * stretch * place[i] / length + (i == 1 ? g : 0));
            }
            for (int i = 0; i < 2; i++) {
                place[i] += TICK * velocity[i];
            }
        } else if (hard_advance(&run, 0, tick > 0)) {
            energy = hard_energy(&run);
        } else {
            return;
        }
        start = tick == 0 ? energy : start;
        hard_error(result, (energy - start) / g);
    }
}

const hard_case hard_stiff[] = {
    {.number = 5,
     .rule = "a cart of a millionth of its pole's mass has its accelerations to rounding",
     .naive = "Cramer's rule: the determinant (M + m) m l^2 - (m l cos)^2 cancels",
     .remedy = "the determinant as m l^2 (M + m sin^2): no difference of large numbers",
     .measure = "largest relative error of an acceleration, from 1e-4 rad off upright to hanging",
     .criterion = 1e-15,
     .criterion_f32 = 5e-7,
     .run = run_determinant},
    {.number = 6,
     .rule = "a cart of a millionth of its pole's mass gains no energy, or is refused",
     .naive = "Runge-Kutta at 1 ms: at the pole's lowest point the cart turns within microseconds",
     .remedy = "refused at init: where the cart's inertia all but vanishes the step is tried, and the one "
               "that does "
               "follow is told",
     .measure = "energy gained, of what lies between hanging and upright",
     .scene = LIGHT_CART,
     .may_refuse = true,
     .seconds = 10,
     .criterion = 1e-6,
     .criterion_f32 = 1e-5,
     .run = run_light_cart},
    {.number = 7,
     .rule = "a spring passes its pivot at a tenth of a millimetre",
     .naive = "polar coordinates: 10 000 rad/s within a step of 1 ms",
     .remedy = "near the pivot a step is made in Cartesian coordinates",
     .measure = "largest error of place and velocity / 10 per s, of 1 m",
     .scene = SPRING("0", "100", "0.001"),
     .seconds = 5,
     .criterion = 4e-9,
     .criterion_f32 = 5e-6,
     .run = run_passage},
    {.number = 8,
     .rule = "a spring with a length of its own passes its pivot without loss of order",
     .naive = "Runge-Kutta across the point where the force jumps: of first order",
     .remedy = "near the pivot a step is made in parts, each a quarter of the time in which the force turns",
     .measure = "largest error of place and velocity / 10 per s, of 1 m",
     .scene = SPRING("0.3", "100", "0"),
     .seconds = 5,
     .criterion = 4e-9, /* what rk4 has without a jump: case 7 */
     .criterion_f32 = 5e-6,
     .run = run_kink},
    {.number = 9,
     .rule = "a spring that swings more than once in a step keeps its energy",
     .naive = "semi-implicit Euler, unstable beyond w h = 2; here it is 10",
     .remedy = "split3, which the refusal of others names: along the rod the motion is taken exactly",
     .measure = "largest change of the energy, of what the ball weighs at 1 m",
     .scene = "scene.system = \"spring_pendulum\"\nscene.stepper = \"split3\"\neffects.viscous = false\n"
              "parameters.mass = 1\nparameters.stiffness = 1e8\nparameters.rest_length = 1\n"
              "initial.length = 1\ninitial.angle = -0.6\n",
     .seconds = 10,
     .criterion = 3e-6,
     .criterion_f32 = 2e-4, /* a rounding of the length, 6e-8 m, is 6e-3 m/s in a step */
     .run = run_stiff_spring},
    {.rule = NULL},
};

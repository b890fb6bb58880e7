/* Hard cases of what is fast against a step: drag, fluids, shaken pivots, frames and spins. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hard_run.h"

#define TICK 1e-3
#define TURN 6.283185307179586

static uint64_t ticks_of(const hard_trial *trial)
{
    return (uint64_t)(trial->seconds / TICK + 0.5);
}

/* --- drag --- */

/* v' = -D v |v|: v = v0 / (1 + D |v0| t), D = 3/8 rho c / (r eta). */
static void run_drag(const hard_trial *trial, hard_result *result)
{
    const double start = 1e6, D = 0.375 * 1.25 * 0.5 / (0.02 * 900);
    double v = start;
    hard_run run;
    if (trial->method != HARD_NAIVE && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (uint64_t tick = 1; tick <= ticks_of(trial); tick++) {
        if (trial->method == HARD_NAIVE) {
            v -= TICK * D * v * fabs(v);
        } else if (hard_advance(&run, 0, 1)) {
            v = hard_value(&run, 1);
        } else {
            return;
        }
        hard_error(result, v / start * (1 + D * start * TICK * (double)tick) - 1);
    }
}

/* v = -g (1 - rho/eta) / B (1 - e^(-B t)), B = 9/2 mu / (r^2 eta) = 1e6/s. */
static void run_stokes(const hard_trial *trial, hard_result *result)
{
    const double B = 4.5 * 2e-5 / (9e-14 * 1000), terminal = -9.75 * (1 - 1.25 / 1000) / B;
    double v = 0;
    hard_run run;
    if (trial->method != HARD_NAIVE && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (uint64_t tick = 1; tick <= ticks_of(trial); tick++) {
        if (trial->method == HARD_NAIVE) {
            v += TICK * B * (terminal - v);
        } else if (hard_advance(&run, 0, 1)) {
            v = hard_value(&run, 1);
        } else {
            return;
        }
        hard_error(result, v / terminal + expm1(-B * TICK * (double)tick));
    }
}

/* --- Kapitza's pendulum --- */

/* A pendulum of 0.25 m about upright: x'' = (g - A w^2 cos wt) / l x. */
typedef struct {
    double hertz;
    hard_run *run;   /* a plant, or NULL: `substeps` of a leapfrog */
    long substeps;   /* in a tick */
    bool is_sampled; /* the base's acceleration, in the middle of each; else the change of its velocity */
    hard_result *result;
} shaken;

static void leapfrog(const shaken *self, double amplitude, double *x)
{
    const double w = TURN * self->hertz, h = TICK / (double)self->substeps;
    const double kick = self->is_sampled ? h * w * w : 2 * w * sin(0.5 * w * h);
    for (long i = 0; i < 1000 * self->substeps; i++) {
        x[0] += 0.5 * h * x[1];
        x[1] += (h * 9.75 - kick * amplitude * cos(w * h * ((double)i + 0.5))) / 0.25 * x[0];
        x[0] += 0.5 * h * x[1];
    }
}

static void run_plant(const shaken *self, double amplitude, double *x)
{
    hard_run *run = self->run;
    mct_scene scene = run->scene;
    const mct_system *system = mct_systems[scene.system];
    for (int i = 0; i < system->parameter_count; i++) {
        if (strcmp(system->parameters[i].name, "base_amplitude_2") == 0) {
            scene.parameters[i] = amplitude;
        }
    }
    scene.initial[0] = x[0];
    scene.initial[1] = x[1];
    self->result->is_refused = mct_plant_init(&run->plant, &scene, &self->result->why) != MCT_OK;
    if (!self->result->is_refused && hard_advance(run, 0, 1000)) {
        x[0] = hard_value(run, 0);
        x[1] = hard_value(run, 1);
    }
}

/* |trace| of the map of a second, a whole number of oscillations: above 2 the pendulum falls. */
static double trace_of(const shaken *self, double amplitude)
{
    const double small = 1e-9; /* linear to 1e-18 */
    double trace = 0;
    for (int k = 0; k < 2; k++) {
        double x[2] = {k == 0 ? small : 0, k == 1 ? small : 0};
        if (self->run != NULL) {
            run_plant(self, amplitude, x);
        } else {
            leapfrog(self, amplitude, x);
        }
        trace += x[k] / small;
    }
    return fabs(trace);
}

/* Least amplitude that keeps the pendulum upright, by bisection; Kapitza's own is sqrt(2 g l) / w. */
static double threshold_of(const shaken *self)
{
    const double averaged = sqrt(2 * 9.75 * 0.25) / (TURN * self->hertz);
    double low = 0.3 * averaged, high = low;
    while (high < 3 * averaged && trace_of(self, high) > 2) {
        low = high;
        high *= 1.05;
    }
    for (int i = 0; i < 26; i++) {
        const double middle = 0.5 * (low + high);
        *(trace_of(self, middle) > 2 ? &low : &high) = middle;
    }
    return high;
}

static double hertz_of(const hard_case *about)
{
    return about->number == 19 ? 400 : 1000;
}

/* With 48 substeps; with half as many it differs by 1e-9. */
static void *true_threshold(const hard_case *about, double seconds)
{
    double *threshold = malloc(sizeof *threshold);
    (void)seconds;
    if (threshold != NULL) {
        *threshold = threshold_of(&(shaken){.hertz = hertz_of(about), .substeps = 48});
    }
    return threshold;
}

static void run_kapitza(const hard_trial *trial, hard_result *result)
{
    shaken self = {hertz_of(trial->about), NULL, 1, true, result};
    const double *exact = trial->shared;
    hard_run run;
    if (trial->method != HARD_NAIVE) {
        self.run = &run;
        if (!hard_start(&run, trial, NULL, result)) {
            return;
        }
    }
    hard_error(result, threshold_of(&self) / *exact - 1);
}

/* --- a frame that turns half a radian in a step --- */

/* In space the mass runs a straight line; largest error of its place, as a part of its distance. */
static void run_frame(const hard_trial *trial, hard_result *result)
{
    const double W = 500, start[2] = {1, 0}, velocity[2] = {0.3, 0.1};
    double x[4] = {start[0], start[1], velocity[0] + W * start[1], velocity[1] - W * start[0]};
    hard_run run;
    if (trial->method != HARD_NAIVE && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (uint64_t tick = 1; tick <= ticks_of(trial); tick++) {
        const long double t = 1e-3L * (long double)tick, c = cosl(W * t), s = sinl(W * t);
        const long double X = start[0] + velocity[0] * t, Y = start[1] + velocity[1] * t;
        if (trial->method == HARD_NAIVE) { /* semi-implicit Euler with the apparent forces as forces */
            const double a[2] = {W * W * x[0] + 2 * W * x[3], W * W * x[1] - 2 * W * x[2]};
            for (int i = 0; i < 2; i++) {
                x[2 + i] += TICK * a[i];
                x[i] += TICK * x[2 + i];
            }
        } else if (hard_advance(&run, 0, 1)) {
            x[0] = hard_value(&run, 0);
            x[1] = hard_value(&run, 1);
        } else {
            return;
        }
        hard_error(result, (double)(hypotl(x[0] - (c * X + s * Y), x[1] - (c * Y - s * X)) / hypotl(X, Y)));
    }
}

/* --- a spin of half a turn in a step --- */

static const double moments[3] = {1, 1.1, 0.5}, spin[3] = {31.62, 0, 3162};

/* Angular momentum in space, r (I w), of q = (w, v): b + w y + v x y, y = 2 v x b. */
static void momentum_of(const double *q, const double *w, double *momentum)
{
    const double b[3] = {moments[0] * w[0], moments[1] * w[1], moments[2] * w[2]};
    double y[3];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        y[i] = 2 * (q[1 + j] * b[k] - q[1 + k] * b[j]);
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        momentum[i] = b[i] + q[0] * y[i] + q[1 + j] * y[k] - q[1 + k] * y[j];
    }
}

/* x = (q, w): q' = q (0, w) / 2, I w' = (I w) x w. */
static void body_rate(const double *x, double *dx)
{
    const double *q = x, *w = x + 4;
    dx[0] = -0.5 * (q[1] * w[0] + q[2] * w[1] + q[3] * w[2]);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        dx[1 + i] = 0.5 * (q[0] * w[i] + q[1 + j] * w[k] - q[1 + k] * w[j]);
        dx[4 + i] = (moments[j] - moments[k]) * w[j] * w[k] / moments[i];
    }
}

static void turn_by_runge_kutta(double *x)
{
    static const double part[4] = {0, 0.5, 0.5, 1}, weight[4] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    double slope[7] = {0}, sum[7] = {0}, at[7];
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < 7; i++) {
            at[i] = x[i] + part[stage] * TICK * slope[i];
        }
        body_rate(at, slope);
        for (int i = 0; i < 7; i++) {
            sum[i] += weight[stage] * slope[i];
        }
    }
    double square = 0;
    for (int i = 0; i < 7; i++) {
        x[i] += TICK * sum[i];
        square += i < 4 ? x[i] * x[i] : 0;
    }
    for (int i = 0; i < 4; i++) {
        x[i] /= sqrt(square);
    }
}

static void run_spin(const hard_trial *trial, hard_result *result)
{
    double x[7] = {1, 0, 0, 0, spin[0], spin[1], spin[2]}, first[3], now[3];
    hard_run run;
    if (trial->method != HARD_NAIVE && !hard_start(&run, trial, NULL, result)) {
        return;
    }
    for (uint64_t tick = 0; tick <= ticks_of(trial); tick++) {
        if (trial->method != HARD_NAIVE) {
            if (!hard_advance(&run, 0, tick > 0)) {
                return;
            }
            for (int i = 0; i < 4; i++) {
                x[i] = hard_value(&run, 3 + i);
            }
            for (int i = 0; i < 3; i++) {
                x[4 + i] = hard_value(&run, 10 + i);
            }
        } else if (tick > 0) {
            turn_by_runge_kutta(x);
        }
        momentum_of(x, x + 4, now);
        for (int i = 0; i < 3; i++) {
            first[i] = tick == 0 ? now[i] : first[i];
            hard_error(result, (now[i] - first[i]) / (moments[2] * spin[2]));
        }
    }
}

#define KAPITZA(hertz, rate, substeps)                                                          \
    "scene.system = \"moving_base\"\nscene.stepper = \"leap\"\nscene.substeps = " substeps "\n" \
    "effects.viscous = false\nparameters.length = 0.25\nparameters.gravity = 9.75\n"            \
    "parameters.base_frequency_1 = 0\nparameters.base_frequency_2 = " rate "\n"

const hard_case hard_fast[] = {
    {.number = 17,
     .rule = "drag by the square stops a sphere of 1000 km/s as it should",
     .naive = "an explicit step: the force of the start reverses the velocity, and more each step",
     .remedy = "expo: the velocity as a series in time, over parts of the step that are short against it",
     .measure = "largest relative error of the velocity",
     .scene = "scene.system = \"falling_sphere\"\neffects.drag = true\neffects.stokes = false\n"
              "effects.gravity = false\neffects.buoyancy = false\nparameters.radius = 0.02\n"
              "parameters.density = 900\nparameters.fluid_density = 1.25\nparameters.drag_coefficient = 0.5\n"
              "initial.velocity = 1e6\n",
     .seconds = 5,
     .criterion = 1e-14, /* some roundings of each of the first steps, which leave the least speed over */
     .criterion_f32 = 1e-5,
     .run = run_drag},
    {.number = 18,
     .rule = "a fog droplet that settles in 1 us has its terminal speed",
     .naive = "an explicit step: b h/m = 1000",
     .remedy = "expo: Stokes' drag is flowed exactly",
     .measure = "largest error of the velocity, of the terminal one",
     .scene =
         "scene.system = \"falling_sphere\"\nparameters.radius = 3e-7\nparameters.density = 1000\n"
         "parameters.fluid_density = 1.25\nparameters.fluid_viscosity = 2e-5\nparameters.gravity = 9.75\n",
     .seconds = 1,
     .criterion = 1e-15,
     .criterion_f32 = 5e-7,
     .run = run_stokes},
    {.number = 19,
     .rule = "a base shaken at 400 Hz keeps a pendulum upright from the amplitude on that it takes",
     .naive = "the base's acceleration sampled in the middle of each step",
     .remedy = "leap: the base enters as the change of its velocity over the step",
     .measure = "relative error of the least amplitude",
     .scene = KAPITZA("400", "2513.2741228718346", "1"),
     .seconds = 1,
     .criterion = 6e-6,
     .criterion_f32 = 1e-4,
     .prepare = true_threshold,
     .run = run_kapitza},
    {.number = 20,
     .rule = "a base shaken at the tick's own 1 kHz keeps a pendulum upright as it should",
     .naive = "the base's acceleration sampled once a step, always at the same phase",
     .remedy = "refused at one step a tick; 8 substeps of leap, which hold the change of the base's velocity",
     .measure = "relative error of the least amplitude",
     .scene = KAPITZA("1000", "6283.185307179586", "8"),
     .seconds = 1,
     .criterion = 7e-8,
     .criterion_f32 = 1e-4,
     .prepare = true_threshold,
     .run = run_kapitza},
    {.number = 28,
     .rule = "a spin of 3162 rad/s keeps its momentum at 1 ms",
     .naive = "Runge-Kutta on a quaternion",
     .remedy = "split3: turns about the principal axes, each exact",
     .measure = "largest change of the angular momentum, of itself",
     .scene = "scene.system = \"rigid_body\"\nscene.stepper = \"split3\"\neffects.gravity = false\n"
              "parameters.particles = []\nparameters.mass = 1\nparameters.inertia_1_1 = 1\n"
              "parameters.inertia_2_2 = 1.1\nparameters.inertia_3_3 = 0.5\n"
              "initial.angular_velocity_1 = 31.62\ninitial.angular_velocity_3 = 3162\n",
     .seconds = 10,
     .criterion = 2e-14,
     .criterion_f32 = 1e-5,
     .run = run_spin},
    {.number = 29,
     .rule = "a frame that turns half a radian in a step sees a straight line as it is",
     .naive = "centrifugal and Coriolis force as forces of a step",
     .remedy = "expo: the frame's motion is flowed exactly",
     .measure = "largest error of the place, of the distance",
     .scene = "scene.system = \"rotating_frame\"\nparameters.angular_velocity_3 = 500\n"
              "initial.position_1 = 1\ninitial.position_2 = 0\ninitial.velocity_1 = 0.3\n"
              "initial.velocity_2 = -499.9\n",
     .seconds = 1,
     .criterion = 3e-13,
     .criterion_f32 = 2e-3, /* 1000 roundings of 500 m/s */
     .run = run_frame},
    {.rule = NULL},
};

/* Hard cases of rotations and angles. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hard_run.h"
#include "mctau/rotation.h"

/* --- free bodies, about their principal axes --- */

typedef struct {
    double inertia[3]; /* [kg m^2] */
    long double x[7];  /* attitude, angular velocity in body axes: at the start */
    long double end[7];
} body;

enum { W = 4, INERTIA_11 = 1 }; /* of x; of the system's parameters */

static void body_rate(const body *self, const long double *x, long double *dx)
{
    const long double *w = x + W;
    dx[0] = -(x[1] * w[0] + x[2] * w[1] + x[3] * w[2]) / 2;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        dx[1 + i] = (x[0] * w[i] + x[1 + j] * w[k] - x[1 + k] * w[j]) / 2;
        dx[W + i] = (self->inertia[j] - self->inertia[k]) / self->inertia[i] * w[j] * w[k];
    }
}

static void body_rk4(const body *self, long double *x, double h)
{
    long double k[4][7], stage[7];
    body_rate(self, x, k[0]);
    for (int n = 1; n < 4; n++) {
        for (int i = 0; i < 7; i++) {
            stage[i] = x[i] + (n < 3 ? h / 2 : h) * k[n - 1][i];
        }
        body_rate(self, stage, k[n]);
    }
    for (int i = 0; i < 7; i++) {
        x[i] += h / 6 * (k[0][i] + 2 * (k[1][i] + k[2][i]) + k[3][i]);
    }
}

/* The body of a scene and where it ends: steps of 0.1 ms, whose error is 1e-4 of that at 1 ms, below 1e-14. */
static void *prepare_body(const hard_case *about, double seconds)
{
    body *self = calloc(1, sizeof *self);
    mct_scene scene;
    if (mct_scene_read(about->scene, strlen(about->scene), "scene", NULL, 0, &scene, NULL) == MCT_OK) {
        for (int i = 0; i < 3; i++) {
            self->inertia[i] = scene.parameters[INERTIA_11 + 4 * i];
            self->x[W + i] = scene.initial[10 + i];
        }
        for (int i = 0; i < 4; i++) {
            self->x[i] = scene.initial[3 + i];
        }
        memcpy(self->end, self->x, sizeof self->end);
        for (long n = 0; n < (long)(seconds * 1e4 + 0.5); n++) {
            body_rk4(self, self->end, 1e-4);
        }
    }
    return self;
}

/* Angle between two attitudes [rad]; q and -q are one. */
static double angle_between(const long double *a, const long double *b)
{
    long double along = 0, across = 0;
    for (int i = 0; i < 4; i++) {
        along += a[i] * b[i];
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const long double c = a[0] * b[1 + i] - b[0] * a[1 + i] - a[1 + j] * b[1 + k] + a[1 + k] * b[1 + j];
        across += c * c;
    }
    return (double)(2 * atan2l(sqrtl(across), fabsl(along)));
}

/* A scheme that only this file knows, from a body's start; writes the attitude at the end as a quaternion. */
typedef void (*body_scheme)(const body *self, long steps, mct_real h, mct_real *attitude);

static void run_body(const hard_trial *trial, hard_result *result, body_scheme naive)
{
    const body *self = trial->shared;
    long double end[4];
    hard_run run;
    if (trial->method == HARD_NAIVE) {
        mct_real attitude[4];
        naive(self, (long)(trial->seconds * 1000 + 0.5), MCT_R(1e-3), attitude);
        for (int i = 0; i < 4; i++) {
            end[i] = (long double)attitude[i];
        }
    } else if (hard_start(&run, trial, NULL, result) && hard_advance(&run, 0, hard_ticks(&run, trial))) {
        for (int i = 0; i < 4; i++) {
            end[i] = hard_value(&run, 3 + i);
        }
    } else {
        return;
    }
    hard_error(result, angle_between(end, self->end));
}

/* Euler's equations, in the core's precision. */
static void spin_rate(const body *self, const mct_real *w, mct_real *dw)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        dw[i] = (mct_real)((self->inertia[j] - self->inertia[k]) / self->inertia[i]) * w[j] * w[k];
    }
}

/* --- 11: J_r^-1 of the rotation vector --- */

/* du/dt = w + u x w / 2 + (1/a^2 - (1 + cos a)/(2 a sin a)) u x (u x w) */
static void vector_rate(const mct_real *u, const mct_real *w, mct_real *du)
{
    mct_real once[3], twice[3];
    const mct_real a = (mct_real)sqrt((double)mct_dot(u, u));
    const mct_real c = (mct_real)cos((double)a), s = (mct_real)sin((double)a);
    const mct_real factor = a < MCT_R(0.1) ? MCT_R(1.0 / 12) : 1 / (a * a) - (1 + c) / (2 * a * s);
    mct_cross(u, w, once);
    mct_cross(u, once, twice);
    for (int i = 0; i < 3; i++) {
        du[i] = w[i] + once[i] / 2 + factor * twice[i];
    }
}

static void by_rotation_vector(const body *self, long steps, mct_real h, mct_real *attitude)
{
    mct_real x[6], k[4][6], stage[6]; /* u, w */
    for (int i = 0; i < 3; i++) {
        x[i] = 0;
        x[3 + i] = (mct_real)self->x[W + i];
    }
    for (long step = 0; step < steps; step++) {
        memcpy(stage, x, sizeof stage);
        for (int n = 0; n < 4; n++) {
            vector_rate(stage, stage + 3, k[n]);
            spin_rate(self, stage + 3, k[n] + 3);
            for (int i = 0; i < 6; i++) {
                stage[i] = x[i] + (n < 2 ? h / 2 : h) * k[n][i];
            }
        }
        for (int i = 0; i < 6; i++) {
            x[i] += h / 6 * (k[0][i] + 2 * (k[1][i] + k[2][i]) + k[3][i]);
        }
    }
    mct_quaternion_of_vector(x, attitude);
}

static void run_full_turn(const hard_trial *trial, hard_result *result)
{
    run_body(trial, result, by_rotation_vector);
}

/* --- 39: Euler's angles --- */

/* Turns about axes 3, 1, 3 by (phi, theta, psi); w in body axes. */
static void angles_rate(const mct_real *x, mct_real *dx)
{
    const mct_real *w = x + 3;
    const mct_real ct = (mct_real)cos((double)x[1]), st = (mct_real)sin((double)x[1]);
    const mct_real cp = (mct_real)cos((double)x[2]), sp = (mct_real)sin((double)x[2]);
    dx[0] = (w[0] * sp + w[1] * cp) / st;
    dx[1] = w[0] * cp - w[1] * sp;
    dx[2] = w[2] - ct * dx[0];
}

static void by_euler_angles(const body *self, long steps, mct_real h, mct_real *attitude)
{
    mct_real x[6], k[4][6], stage[6];
    const double start = 2 * atan2((double)self->x[1], (double)self->x[0]); /* about axis 1 */
    for (int i = 0; i < 3; i++) {
        x[i] = i == 1 ? (mct_real)start : 0;
        x[3 + i] = (mct_real)self->x[W + i];
    }
    for (long step = 0; step < steps; step++) {
        memcpy(stage, x, sizeof stage);
        for (int n = 0; n < 4; n++) {
            angles_rate(stage, k[n]);
            spin_rate(self, stage + 3, k[n] + 3);
            for (int i = 0; i < 6; i++) {
                stage[i] = x[i] + (n < 2 ? h / 2 : h) * k[n][i];
            }
        }
        for (int i = 0; i < 6; i++) {
            x[i] += h / 6 * (k[0][i] + 2 * (k[1][i] + k[2][i]) + k[3][i]);
        }
    }
    const mct_real third[3] = {0, 0, x[0]}, first[3] = {x[1], 0, 0}, last[3] = {0, 0, x[2]};
    mct_real a[4], b[4], c[4], ab[4];
    mct_quaternion_of_vector(third, a);
    mct_quaternion_of_vector(first, b);
    mct_quaternion_of_vector(last, c);
    mct_quaternion_multiply(a, b, ab);
    mct_quaternion_multiply(ab, c, attitude);
}

static void run_pole(const hard_trial *trial, hard_result *result)
{
    run_body(trial, result, by_euler_angles);
}

/* --- 12: semi-implicit Euler --- */

static void by_euler_steps(const body *self, long steps, mct_real h, mct_real *q)
{
    mct_real w[3], dw[3], rate[4];
    for (int i = 0; i < 4; i++) {
        q[i] = (mct_real)self->x[i];
    }
    for (int i = 0; i < 3; i++) {
        w[i] = (mct_real)self->x[W + i];
    }
    for (long step = 0; step < steps; step++) {
        spin_rate(self, w, dw);
        for (int i = 0; i < 3; i++) {
            w[i] += h * dw[i];
        }
        mct_quaternion_rate_body(q, w, rate);
        mct_real square = 0;
        for (int i = 0; i < 4; i++) {
            q[i] += h * rate[i];
            square += q[i] * q[i];
        }
        for (int i = 0; i < 4; i++) {
            q[i] /= (mct_real)sqrt((double)square);
        }
    }
}

static void run_flip(const hard_trial *trial, hard_result *result)
{
    run_body(trial, result, by_euler_steps);
}

/* --- 13: a quaternion that nobody brings back to its length --- */

static void run_length(const hard_trial *trial, hard_result *result)
{
    hard_run run;
    double square = 0;
    if (trial->method == HARD_NAIVE) {
        /* rk4 on dq/dt = q w/2 about a fixed axis: the increment is the same multiple of q each step */
        const mct_real a = MCT_R(0.5 * 100 * 1e-3);
        mct_real c = 1, s = 0;
        for (long step = 0; step < (long)(trial->seconds * 1000 + 0.5); step++) {
            const mct_real along = -a * a / 2 * (1 - a * a / 12);
            const mct_real across = a * (1 - a * a / 6);
            const mct_real dc = along * c - across * s;
            s += along * s + across * c;
            c += dc;
        }
        square = (double)c * (double)c + (double)s * (double)s;
    } else if (hard_start(&run, trial, NULL, result) && hard_advance(&run, 0, hard_ticks(&run, trial))) {
        for (int i = 3; i < 7; i++) {
            square += hard_value(&run, i) * hard_value(&run, i);
        }
    } else {
        return;
    }
    hard_error(result, sqrt(square) - 1);
}

/* --- 40: the middle axis --- */

/* In space the momentum is constant, and the attitude gives w = R I^-1 R' L: its roundings tilt the body. */
static void momentum_rate(const body *self, const mct_real *momentum, const mct_real *q, mct_real *w,
                          mct_real *rate)
{
    mct_rotate_back(q, momentum, w);
    for (int i = 0; i < 3; i++) {
        w[i] /= (mct_real)self->inertia[i];
    }
    mct_quaternion_rate_body(q, w, rate);
}

static double off_axis_by_momentum(const body *self, long steps, mct_real h)
{
    mct_real q[4], w[3], momentum[3], stage[4], k[4][4];
    for (int i = 0; i < 4; i++) {
        q[i] = (mct_real)self->x[i];
    }
    for (int i = 0; i < 3; i++) {
        w[i] = (mct_real)(self->inertia[i] * (double)self->x[W + i]);
    }
    mct_rotate(q, w, momentum);
    double worst = 0;
    for (long step = 0; step < steps; step++) {
        memcpy(stage, q, sizeof stage);
        for (int n = 0; n < 4; n++) {
            momentum_rate(self, momentum, stage, w, k[n]);
            for (int i = 0; i < 4; i++) {
                stage[i] = q[i] + (n < 2 ? h / 2 : h) * k[n][i];
            }
        }
        for (int i = 0; i < 4; i++) {
            q[i] += h / 6 * (k[0][i] + 2 * (k[1][i] + k[2][i]) + k[3][i]);
        }
        worst = fmax(worst, fabs((double)w[0]) + fabs((double)w[2]));
    }
    return worst;
}

static void run_middle_axis(const hard_trial *trial, hard_result *result)
{
    hard_run run;
    if (trial->method == HARD_NAIVE) {
        hard_error(result,
                   off_axis_by_momentum(trial->shared, (long)(trial->seconds * 1000 + 0.5), MCT_R(1e-3)));
    } else if (hard_start(&run, trial, NULL, result)) {
        for (uint64_t tick = hard_ticks(&run, trial); tick > 0 && hard_advance(&run, 0, 1); tick--) {
            hard_error(result, fabs(hard_value(&run, 10)) + fabs(hard_value(&run, 12)));
        }
    }
}

/* --- 10: (1 - cos a)/a^2 and cos a - 1, of which turns are made --- */

static void run_small_turn(const hard_trial *trial, hard_result *result)
{
    for (int n = 0; n <= 240; n++) {
        const mct_real a = (mct_real)(3 * pow(10, -n / 20.0)); /* down to 3e-12 rad */
        const long double half = sinl((long double)a / 2), quarter = sinl((long double)a / 4);
        const double exact = (double)(2 * half * half / ((long double)a * (long double)a));
        const mct_real u[3] = {0, a, 0};
        mct_real c[7], e[4];
        if (trial->method == HARD_NAIVE) {
            c[2] = (1 - (mct_real)cos((double)a)) / (a * a);
            e[0] = (mct_real)cos((double)(a / 2)) - 1;
        } else {
            mct_stumpff(a * a, c);
            mct_quaternion_turn(u, e);
        }
        hard_error(result, (double)c[2] / exact - 1);
        hard_error(result, (double)e[0] / (double)(-2 * quarter * quarter) - 1);
    }
}

/* --- 14: an angle that grows --- */

static void run_growing_angle(const hard_trial *trial, hard_result *result)
{
    const double start = 1e6, rate = 1;
    hard_run run;
    double end = 0;
    if (trial->method == HARD_NAIVE) {
        mct_real angle = (mct_real)start;
        for (long step = 0; step < (long)(trial->seconds * 1000 + 0.5); step++) {
            angle += MCT_R(1e-3) * (mct_real)rate;
        }
        end = (double)angle;
    } else if (hard_start(&run, trial, NULL, result) && hard_advance(&run, 0, hard_ticks(&run, trial))) {
        end = hard_value(&run, 0);
    } else {
        return;
    }
    hard_error(result, (end - start) / (rate * trial->seconds) - 1);
}

/* --- 21: upright --- */

static void run_upright(const hard_trial *trial, hard_result *result)
{
    hard_run run;
    if (trial->method == HARD_NAIVE) {
        /* the angle from hanging, which is never pi exactly; velocity Verlet, g/l = 9.81/0.3 */
        const mct_real h = MCT_R(1e-3), pi = MCT_R(3.14159265358979323846), pull = MCT_R(9.81 / 0.3);
        mct_real angle = pi, rate = 0;
        for (long step = 0; step < (long)(trial->seconds * 1000 + 0.5); step++) {
            angle += h / 2 * rate;
            rate -= h * pull * (mct_real)sin((double)angle);
            angle += h / 2 * rate;
            hard_error(result, (double)(angle - pi));
        }
    } else if (hard_start(&run, trial, NULL, result)) {
        for (uint64_t tick = hard_ticks(&run, trial); tick > 0 && hard_advance(&run, 0, 1); tick--) {
            hard_error(result, hard_value(&run, 0));
        }
    }
}

#define FREE_BODY                                                                         \
    "scene.system = \"rigid_body\"\neffects.gravity = false\nparameters.particles = []\n" \
    "parameters.mass = 1\nparameters.inertia_1_1 = 1\n"

/* Numbers that rounding makes: a few hundred roundings of attitudes that turn some ten times. */
const hard_case hard_rotations[] = {
    {.number = 10,
     .rule = "a turn of next to nothing keeps all its digits",
     .naive = "1 - cos a, of which nothing is left where a is small",
     .remedy = "series and sines of half the angle: mct_stumpff(), mct_quaternion_turn()",
     .measure = "largest relative error of (1 - cos a)/a^2 and cos(a/2) - 1, a from 3e-12 to 3 rad",
     .criterion = 1e-15,    /* some four roundings */
     .criterion_f32 = 5e-7, /* the same */
     .run = run_small_turn},
    {.number = 11,
     .rule = "an attitude passes a full turn, where a rotation vector is singular",
     .naive = "rk4 on du/dt = J^-1(u) w, which grows without bound around |u| = 2 pi",
     .remedy = "a quaternion, turned by small increments: no angle is special to it",
     .measure = "error of the attitude after several turns [rad]",
     .scene = FREE_BODY "parameters.inertia_2_2 = 1\nparameters.inertia_3_3 = 1.7\n"
                        "initial.angular_velocity_1 = 1e-4\ninitial.angular_velocity_3 = 2\n",
     .seconds = 10,
     .criterion = 1e-10,
     .criterion_f32 = 1e-4,
     .prepare = prepare_body,
     .run = run_full_turn},
    {.number = 12,
     .rule = "a body flips about its middle axis when theory says so",
     .naive = "semi-implicit Euler, normalised",
     .remedy = "rk4 on a quaternion, with one Newton step to length 1",
     .measure = "error of the attitude [rad]",
     .scene = FREE_BODY "parameters.inertia_2_2 = 2\nparameters.inertia_3_3 = 3\n"
                        "initial.angular_velocity_1 = 0.5\ninitial.angular_velocity_2 = 2\n"
                        "initial.angular_velocity_3 = 0.3\n",
     .seconds = 10,
     .criterion = 1e-10,    /* rk4 has 7e-11 */
     .criterion_f32 = 1e-4, /* the flip amplifies roundings a hundredfold */
     .prepare = prepare_body,
     .run = run_flip},
    {.number = 13,
     .rule = "a quaternion keeps its length in any number of steps",
     .naive = "rk4 on the quaternion alone: each step shortens it by (h w)^6/9216, and rounding adds its own",
     .remedy = "a Newton step to length 1 with each step, in the compensated sum",
     .measure = "error of the length, at 100 rad/s",
     .scene = FREE_BODY "parameters.inertia_2_2 = 2\nparameters.inertia_3_3 = 3\n"
                        "initial.angular_velocity_3 = 100\n",
     .seconds = 100,
     .full_seconds = 1e5,
     .criterion = 1e-15,    /* roundings of one step */
     .criterion_f32 = 1e-6, /* the same */
     .run = run_length},
    {.number = 14,
     .rule = "an angle grows for ever without losing its pace",
     .naive = "angle += h w: in float it stands still from 32768 rad on, in double it loses digits",
     .remedy = "an angle within a turn, whole turns counted, the sum compensated",
     .measure = "error of the way of an angle that begins at 1e6 rad and grows at 1 rad/s, relative",
     .scene = "scene.system = \"pendulum\"\neffects.gravity = false\neffects.viscous = false\n"
              "initial.angle = 1e6\ninitial.angle_rate = 1\n",
     .seconds = 1000,
     .full_seconds = 1e5,
     .criterion = 1e-12,    /* a double at 1e6 has steps of 1e-10, in 1000 rad */
     .criterion_f32 = 1e-7, /* an increment has 24 bits, and is always the same */
     .run = run_growing_angle},
    {.number = 21,
     .rule = "what stands upright without a breath of air never falls",
     .naive = "the angle from hanging: pi is not a number, and the error grows",
     .remedy = "angles from upright, where the sine is 0 exactly",
     .measure = "largest angle from upright [rad]",
     .scene = "scene.system = \"reaction_wheel\"\ninitial.arm_angle = 0\n",
     .seconds = 600,
     .full_seconds = 1e4,
     .criterion = 1e-300, /* 0 */
     .criterion_f32 = 1e-300,
     .run = run_upright},
    {.number = 39,
     .rule = "a body passes its pole, where Euler's angles are singular",
     .naive = "rk4 on Euler's angles, which divides by the sine of the second one",
     .remedy = "a quaternion",
     .measure = "error of the attitude [rad]",
     .scene = FREE_BODY "parameters.inertia_2_2 = 1\nparameters.inertia_3_3 = 2\n"
                        "initial.attitude_w = 0.8\ninitial.attitude_x = 0.6\n"
                        "initial.angular_velocity_1 = -1\ninitial.angular_velocity_2 = 1e-4\n",
     .seconds = 10,
     .criterion = 1e-10,
     .criterion_f32 = 1e-4,
     .prepare = prepare_body,
     .run = run_pole},
    {.number = 40,
     .rule = "a body that turns about its middle axis exactly does so for ever",
     .naive = "the constant momentum in space and the attitude: their roundings tilt the body, and it flips",
     .remedy = "Euler's equations about the principal axes: where the other two rates are 0 they stay 0",
     .measure = "largest angular velocity about the other two axes [rad/s]",
     .scene = FREE_BODY "parameters.inertia_2_2 = 2\nparameters.inertia_3_3 = 3\n"
                        "initial.attitude_w = 0.8\ninitial.attitude_x = 0.36\ninitial.attitude_z = 0.48\n"
                        "initial.angular_velocity_2 = 2\n",
     .seconds = 60,
     .criterion = 1e-300, /* 0 */
     .criterion_f32 = 1e-300,
     .prepare = prepare_body,
     .run = run_middle_axis},
    {.rule = NULL}};

#include "support/reference.h"

#include <string.h>

#include "support/scenes.h"

#if HAVE_REFERENCE
#include <quadmath.h>
#define sine       sinq
#define cosine     cosq
#define size_of    fabsq
#define arctangent atanq
#else
#include <math.h>
#define sine       sinl
#define cosine     cosl
#define size_of    fabsl
#define arctangent atanl
#endif

/* Parameters in the order of the systems' tables. */
enum {
    M1,
    M2,
    LENGTH,
    K1,
    K2,
    CART_DRY,
    POLE_DRY,
    STATIC,
    CART_AIR,
    POLE_AIR,
    G,
    KT,
    KB,
    R,
    L,
    GEAR,
    PULLEY
};
enum {
    WHEEL_M,
    WHEEL_I,
    ARM_L,
    ARM_I,
    ARM_S,
    WHEEL_G,
    NU1,
    NU2,
    DRY1,
    DRY2,
    WHEEL_STATIC,
    AIR1,
    AIR2,
    WHEEL_KT,
    WHEEL_KB,
    WHEEL_R,
    WHEEL_L
};

reference_model reference_of(const mct_scene *scene)
{
    reference_model model = {.system = scene->system, .effects = mct_scene_effects(scene)};
    model.states = mct_state_count(scene);
    for (int i = 0; i < MCT_MAX_PARAMETERS; i++) {
        model.p[i] = scene->parameters[i];
    }
    return model;
}

void reference_start(const reference_model *model, const double *from, quad *x)
{
    for (int i = 0; i < REFERENCE_STATES; i++) {
        x[i] = i < model->states ? from[i] : 0;
    }
}

/* Solves M a = f by elimination with row pivoting. */
static void eliminate(quad M[2][2], quad *f, quad *a)
{
    const int first = size_of(M[1][0]) > size_of(M[0][0]) ? 1 : 0;
    const int second = 1 - first;
    const quad factor = M[second][0] / M[first][0];
    a[1] = (f[second] - factor * f[first]) / (M[second][1] - factor * M[first][1]);
    a[0] = (f[first] - M[first][1] * a[1]) / M[first][0];
}

/* Force of the motor on its coordinate, whose motor turns `ratio` times as fast, and the rate of the current.
 */
static quad drive(const reference_model *model, quad ratio, int kt, quad current, quad rate, quad u, quad *di)
{
    const quad *p = model->p;
    const quad emf = p[kt + 1] * ratio * rate;
    *di = 0;
    if (model->effects & MCT_MOTOR_INDUCTIVE) {
        *di = (u - p[kt + 2] * current - emf) / p[kt + 3];
        return ratio * p[kt] * current;
    }
    if (model->effects & MCT_MOTOR_QUASI_STATIC) {
        return ratio * p[kt] * ((u - emf) / p[kt + 2]);
    }
    return u;
}

void reference_rate(const reference_model *model, const quad *x, quad u, quad *dx)
{
    const quad *p = model->p;
    const bool gravity = model->effects & MCT_GRAVITY;
    const bool viscous = model->effects & MCT_VISCOUS;
    const bool drag = model->effects & MCT_DRAG;
    quad di;
    quad M[2][2];
    quad f[2];
    if (model->system == CART_POLE) {
        const quad s = sine(x[1]);
        const quad c = cosine(x[1]);
        M[0][0] = p[M1] + p[M2];
        M[0][1] = M[1][0] = p[M2] * p[LENGTH] * c;
        M[1][1] = p[M2] * p[LENGTH] * p[LENGTH];
        f[0] =
            drive(model, p[GEAR] / p[PULLEY], KT, x[4], x[2], u, &di) + p[M2] * p[LENGTH] * s * x[3] * x[3];
        f[1] = gravity ? p[M2] * p[G] * p[LENGTH] * s : 0;
        f[0] -= viscous ? p[K1] * x[2] : 0;
        f[1] -= viscous ? p[K2] * x[3] : 0;
        f[0] -= drag ? p[CART_AIR] * size_of(x[2]) * x[2] : 0;
        f[1] -= drag ? p[POLE_AIR] * size_of(x[3]) * x[3] : 0;
    } else {
        M[0][0] = p[WHEEL_M] * p[ARM_L] * p[ARM_L] + p[WHEEL_I] + p[ARM_I];
        M[0][1] = M[1][0] = M[1][1] = p[WHEEL_I];
        f[0] = gravity ? (p[ARM_S] + p[WHEEL_M] * p[ARM_L]) * p[WHEEL_G] * sine(x[0]) : 0;
        f[1] = drive(model, 1, WHEEL_KT, x[4], x[3], u, &di);
        f[0] -= viscous ? p[NU1] * x[2] : 0;
        f[1] -= viscous ? p[NU2] * x[3] : 0;
        f[0] -= drag ? p[AIR1] * size_of(x[2]) * x[2] : 0;
        f[1] -= drag ? p[AIR2] * size_of(x[3]) * x[3] : 0;
    }
    dx[0] = x[2];
    dx[1] = x[3];
    eliminate(M, f, dx + 2);
    dx[4] = di;
}

quad reference_energy(const reference_model *model, const quad *x)
{
    const quad *p = model->p;
    const quad gravity = (model->effects & MCT_GRAVITY) ? 1 : 0;
    const quad inductance =
        (model->effects & MCT_MOTOR_INDUCTIVE) ? p[model->system == CART_POLE ? L : WHEEL_L] : 0;
    const quad magnetic = inductance * x[4] * x[4] / 2;
    if (model->system == CART_POLE) {
        const quad right = x[2] + p[LENGTH] * cosine(x[1]) * x[3];
        const quad down = p[LENGTH] * sine(x[1]) * x[3];
        return (p[M1] * x[2] * x[2] + p[M2] * (right * right + down * down)) / 2 +
               gravity * p[M2] * p[G] * p[LENGTH] * cosine(x[1]) + magnetic;
    }
    const quad arm = p[WHEEL_M] * p[ARM_L] * p[ARM_L] + p[ARM_I];
    const quad rim = x[2] + x[3];
    return (arm * x[2] * x[2] + p[WHEEL_I] * rim * rim) / 2 +
           gravity * (p[ARM_S] + p[WHEEL_M] * p[ARM_L]) * p[WHEEL_G] * cosine(x[0]) + magnetic;
}

enum { COLUMNS = 9, ALL = REFERENCE_STATES };

/* Gragg's modified midpoint rule over H in n substeps. */
static void midpoint(const reference_model *model, const quad *x, const quad *first_rate, quad u, quad H,
                     int n, quad *end)
{
    const quad h = H / n;
    quad before[ALL];
    quad now[ALL];
    quad rate[ALL];
    for (int i = 0; i < ALL; i++) {
        before[i] = x[i];
        now[i] = x[i] + h * first_rate[i];
    }
    for (int k = 1; k < n; k++) {
        reference_rate(model, now, u, rate);
        for (int i = 0; i < ALL; i++) {
            const quad next = before[i] + 2 * h * rate[i];
            before[i] = now[i];
            now[i] = next;
        }
    }
    memcpy(end, now, sizeof now);
}

static void extrapolate_once(const reference_model *model, quad *x, quad u, quad H)
{
    quad table[COLUMNS][ALL];
    quad rate[ALL];
    reference_rate(model, x, u, rate);
    for (int row = 0; row < COLUMNS; row++) {
        const int n = 2 * (row + 1);
        midpoint(model, x, rate, u, H, n, table[row]);
        for (int k = row - 1; k >= 0; k--) { /* table[k] becomes the value of the next column */
            const quad ratio = (quad)(n * n) / (quad)(4 * (k + 1) * (k + 1));
            for (int i = 0; i < ALL; i++) {
                table[k][i] = table[k + 1][i] + (table[k + 1][i] - table[k][i]) / (ratio - 1);
            }
        }
    }
    memcpy(x, table[0], sizeof table[0]);
}

void reference_extrapolate(const reference_model *model, quad *x, quad u, quad duration, long steps)
{
    for (long k = 0; k < steps; k++) {
        extrapolate_once(model, x, u, duration / steps);
    }
}

/* ---- variation of constants ---- */

enum { NODES = REFERENCE_NODES, SIZE = ALL + 1 + NODES };

static void multiply(quad a[SIZE][SIZE], quad b[SIZE][SIZE], quad product[SIZE][SIZE])
{
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j < SIZE; j++) {
            quad sum = 0;
            for (int k = 0; k < SIZE; k++) {
                if (a[i][k] != 0 && b[k][j] != 0) {
                    sum += a[i][k] * b[k][j];
                }
            }
            product[i][j] = sum;
        }
    }
}

/* e^a by a Taylor sum of a / 2^k, squared k times. */
static void exponential(quad a[SIZE][SIZE], quad x[SIZE][SIZE])
{
    quad largest = 0;
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j < SIZE; j++) {
            largest = size_of(a[i][j]) > largest ? size_of(a[i][j]) : largest;
        }
    }
    int squarings = 0;
    for (; largest * SIZE > 1; largest /= 2) {
        squarings++;
    }
    quad scale = 1;
    for (int k = 0; k < squarings; k++) {
        scale /= 2;
    }
    quad term[SIZE][SIZE];
    quad next[SIZE][SIZE];
    for (int i = 0; i < SIZE; i++) {
        for (int j = 0; j < SIZE; j++) {
            a[i][j] *= scale;
            term[i][j] = x[i][j] = i == j ? 1 : 0;
        }
    }
    for (int n = 1; n <= 30; n++) {
        multiply(term, a, next);
        for (int i = 0; i < SIZE; i++) {
            for (int j = 0; j < SIZE; j++) {
                term[i][j] = next[i][j] / n;
                x[i][j] += term[i][j];
            }
        }
    }
    for (int k = 0; k < squarings; k++) {
        multiply(x, x, next);
        memcpy(x, next, sizeof next);
    }
}

/* Inverse of the Vandermonde matrix of the nodes: powers[m][k] is the factor of t^m in the k-th Lagrange
 * polynomial. */
static void lagrange(const quad *nodes, quad powers[NODES][NODES])
{
    for (int k = 0; k < NODES; k++) {
        quad polynomial[NODES + 1] = {1};
        int degree = 0;
        quad denominator = 1;
        for (int j = 0; j < NODES; j++) {
            if (j == k) {
                continue;
            }
            for (int m = ++degree; m > 0; m--) {
                polynomial[m] = polynomial[m - 1] - nodes[j] * polynomial[m];
            }
            polynomial[0] *= -nodes[j];
            denominator *= nodes[k] - nodes[j];
        }
        for (int m = 0; m < NODES; m++) {
            powers[m][k] = polynomial[m] / denominator;
        }
    }
}

/* The linear part, seen from outside: the rates that unit states and a unit input cause without gravity. */
static void linear_part(const reference_model *model, quad A[ALL][ALL], quad *B, quad *e)
{
    reference_model weightless = *model;
    weightless.effects &= ~(uint32_t)MCT_GRAVITY;
    const quad none[ALL] = {0};
    quad rate[ALL];
    for (int j = 0; j < ALL; j++) {
        quad unit[ALL] = {0};
        unit[j] = 1;
        reference_rate(&weightless, unit, 0, rate);
        for (int i = 0; i < ALL; i++) {
            A[i][j] = rate[i];
        }
    }
    reference_rate(&weightless, none, 1, B);
    /* e sin(angle): the arm level, at rest. */
    const quad level[ALL] = {2 * arctangent(1)};
    reference_rate(model, level, 0, e);
}

static void prepare_window(const reference_model *model, quad length, reference_window *window)
{
    quad A[ALL][ALL];
    quad B[ALL];
    quad e[ALL];
    quad nodes[NODES + 1];
    quad powers[NODES][NODES];
    linear_part(model, A, B, e);
    for (int j = 0; j < NODES; j++) {
        nodes[j] = (1 - cosine((2 * j + 1) * (4 * arctangent(1)) / (2 * NODES))) / 2;
    }
    nodes[NODES] = 1;
    lagrange(nodes, powers);
    window->length = length;
    for (int j = 0; j <= NODES; j++) {
        const quad T = nodes[j] * length;
        static quad generator[SIZE][SIZE]; /* large, and no test has threads */
        static quad flow[SIZE][SIZE];
        memset(generator, 0, sizeof generator);
        for (int i = 0; i < ALL; i++) {
            for (int k = 0; k < ALL; k++) {
                generator[i][k] = T * A[i][k];
            }
            generator[i][ALL] = T * B[i];
            generator[i][ALL + 1] = T * e[i];
        }
        for (int k = 1; k < NODES; k++) {
            generator[ALL + k][ALL + k + 1] = 1;
        }
        exponential(generator, flow);
        for (int i = 0; i < ALL; i++) {
            for (int k = 0; k < ALL; k++) {
                window->flow[j][i][k] = flow[i][k];
            }
            window->input[j][i] = flow[i][ALL];
            for (int k = 0; k < NODES; k++) {
                quad sum = 0;
                quad factor = 1; /* m! c^m: integral of e^(A(T-s)) e (s/length)^m over [0, T] */
                for (int m = 0; m < NODES; m++) {
                    sum += factor * flow[i][ALL + 1 + m] * powers[m][k];
                    factor *= (m + 1) * nodes[j];
                }
                window->force[j][k][i] = sum;
            }
        }
    }
}

int reference_flow_prepare(reference_flow *self, const reference_model *model, double duration, double first,
                           double longest)
{
    self->model = model;
    self->window_count = 0;
    quad left = duration;
    quad length = first;
    while (left > 0 && self->window_count < REFERENCE_WINDOWS) {
        length = length < longest ? length : (quad)longest;
        length = left < length * (quad)1.5 ? left : length;
        reference_window *const window = &self->windows[self->window_count];
        if (self->window_count > 0 && window[-1].length == length) {
            *window = window[-1];
        } else {
            prepare_window(model, length, window);
        }
        left -= length;
        self->window_count++;
        length *= self->window_count > 1 ? 2 : 1;
    }
    return left > 0 ? 0 : self->window_count;
}

static quad from_state(const reference_window *window, int node, int i, const quad *x, quad u)
{
    quad sum = window->input[node][i] * u;
    for (int k = 0; k < ALL; k++) {
        if (window->flow[node][i][k] != 0) {
            sum += window->flow[node][i][k] * x[k];
        }
    }
    return sum;
}

static void advance_window(const reference_window *window, quad *x, quad u)
{
    enum { MAX_ITERATIONS = 30 };
    quad base[NODES];
    quad force[NODES];
    const quad start = sine(x[0]);
    for (int j = 0; j < NODES; j++) {
        base[j] = from_state(window, j, 0, x, u);
        force[j] = start;
    }
    bool converged = false;
    for (int n = 0; n < MAX_ITERATIONS && !converged; n++) {
        quad next[NODES];
        converged = true;
        for (int j = 0; j < NODES; j++) {
            quad angle = base[j];
            for (int k = 0; k < NODES; k++) {
                angle += window->force[j][k][0] * force[k];
            }
            next[j] = sine(angle);
            converged = converged && size_of(next[j] - force[j]) < (quad)1e-24;
        }
        memcpy(force, next, sizeof next);
    }
    quad end[ALL];
    for (int i = 0; i < ALL; i++) {
        end[i] = from_state(window, NODES, i, x, u);
        for (int k = 0; k < NODES; k++) {
            end[i] += window->force[NODES][k][i] * force[k];
        }
    }
    memcpy(x, end, sizeof end);
}

void reference_flow_advance(const reference_flow *self, quad *x, quad u)
{
    for (int k = 0; k < self->window_count; k++) {
        advance_window(&self->windows[k], x, u);
    }
}

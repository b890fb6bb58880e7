#include "mctau/judge.h"

#include <string.h>

#include "mctau/matrix.h"

/* What place() below needs of the present state. */
typedef struct {
    const mct_system *system;
    const void *constants;
    const mct_real *x;
    const mct_judgement *judgement;
} view_t;

/* product = a b of quaternions. */
static void multiply(const mct_hyperdual *a, const mct_hyperdual *b, mct_hyperdual *product)
{
    static const int8_t factor[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
    static const int8_t sign[4][4] = {{1, -1, -1, -1}, {1, 1, 1, -1}, {1, -1, 1, 1}, {1, 1, -1, 1}};
    for (int i = 0; i < 4; i++) {
        product[i] = mct_hyperdual_constant(0);
        for (int j = 0; j < 4; j++) {
            const mct_hyperdual term = mct_hyperdual_mul(a[j], b[factor[i][j]]);
            product[i] = mct_hyperdual_add(product[i], mct_hyperdual_scale(sign[i][j], term));
        }
    }
}

/* The attitude turned by u, which is 0 but for its derivatives: e^(u/2) = (1 - u^2/8, u/2) up to the second. */
static void turn(mct_attitude attitude, const mct_real *now, const mct_hyperdual *u, mct_hyperdual *turned)
{
    mct_hyperdual step[4], start[4];
    step[0] = mct_hyperdual_constant(1);
    for (int i = 0; i < 3; i++) {
        step[0] =
            mct_hyperdual_sub(step[0], mct_hyperdual_scale(MCT_R(0.125), mct_hyperdual_mul(u[i], u[i])));
        step[1 + i] = mct_hyperdual_scale(MCT_R(0.5), u[i]);
    }
    for (int i = 0; i < 4; i++) {
        start[i] = mct_hyperdual_constant(now[i]);
    }
    if (attitude == MCT_ATTITUDE_BODY) {
        multiply(start, step, turned);
    } else {
        multiply(step, start, turned);
    }
}

static void place(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const view_t *view = context;
    const mct_system *system = view->system;
    const int n = system->coordinate_count;
    mct_hyperdual positions[MCT_GAUSS_MAX_COORDINATES + 1 + MCT_PHASES];
    mct_hyperdual all[MCT_MAX_PARTICLES][3];
    for (int i = 0; i < n; i++) {
        positions[i] = q[i];
    }
    if (system->attitude != MCT_ATTITUDE_NONE) {
        turn(system->attitude, view->x + n - 3, q + n - 3, positions + n - 3);
    }
    for (int i = 0; system->phases != NULL && i < MCT_PHASES; i++) {
        positions[n + i] = mct_hyperdual_constant(view->x[2 * n + i]);
    }
    system->place(view->constants, time, positions, all);
    for (int i = 0; i < view->judgement->particle_count; i++) {
        memcpy(position[i], all[view->judgement->particle[i]], sizeof all[0]);
    }
}

/*
 * Whether M has an inverse to within rounding: M_ii (M^-1)_ii is 1 for a coordinate that moves particles of its own, and
 * without bound for one that moves none that the others do not.
 */
static bool is_regular(const mct_gauss_motion *motion, int n)
{
    double M[MCT_GAUSS_MAX_COORDINATES * MCT_GAUSS_MAX_COORDINATES];
    double inverse[MCT_GAUSS_MAX_COORDINATES * MCT_GAUSS_MAX_COORDINATES];
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            M[i * n + j] = (double)motion->M[i][j];
        }
    }
    bool regular = mct_matrix_inverse(n, M, inverse) == MCT_OK;
    for (int i = 0; i < n && regular; i++) {
        const double amplified = M[i * n + i] * inverse[i * n + i];
        regular = amplified > 0 && amplified < 1 / (16 * (double)MCT_REAL_EPSILON);
    }
    return regular;
}

mct_status mct_judge(const mct_system *system, const void *constants, int particles, const mct_real *x,
                     const mct_evaluation *closed, mct_judgement *out)
{
    const view_t view = {system, constants, x, out};
    const int n = system->coordinate_count;
    mct_real q[MCT_GAUSS_MAX_COORDINATES];
    mct_real force[3 * MCT_MAX_PARTICLES];
    mct_real whole = 0;
    if (system->is_process) {
        return MCT_ERROR_UNSUITED;
    }
    for (int i = 0; i < particles; i++) {
        whole += closed->mass[i];
    }
    out->particle_count = 0;
    for (int i = 0; i < particles; i++) {
        if (closed->mass[i] > MCT_R(1e-14) * whole) { /* an arm's inertia may need no second point */
            out->particle[out->particle_count] = i;
            out->mass[out->particle_count] = closed->mass[i];
            memcpy(force + 3 * out->particle_count, closed->force[i], sizeof closed->force[i]);
            out->particle_count++;
        }
    }
    for (int i = 0; i < n; i++) {
        const bool turns = system->attitude != MCT_ATTITUDE_NONE && i >= n - 3;
        q[i] = turns ? 0 : x[i];
    }
    const mct_real *const v = x + mct_rate_index(system);
    const mct_real time = system->is_timed ? v[n] : 0;
    const mct_gauss_system engine = {out->particle_count, n, out->mass, place, &view};
    mct_status status = mct_gauss_kinematics(&engine, time, q, v, &out->workspace, &out->motion);
    if (status != MCT_OK) {
        return status;
    }
    memset(&out->lagrange, 0, sizeof out->lagrange);
    if (system->attitude == MCT_ATTITUDE_NONE) {
        status = mct_gauss_christoffel(&engine, time, q, v, &out->workspace, &out->lagrange);
        if (status != MCT_OK) {
            return status;
        }
    }
    /* First without couples, for J'f; tau holds it even where the accelerations are not defined. */
    status = mct_gauss_dynamics(&engine, force, NULL, &out->workspace, &out->motion);
    status = status == MCT_OK && !is_regular(&out->motion, n) ? MCT_ERROR_SINGULAR : status;
    if (status != MCT_OK && status != MCT_ERROR_SINGULAR) {
        return status;
    }
    for (int i = 0; i < n; i++) {
        out->couple[i] = closed->tau[i] - out->motion.tau[i];
    }
    return status == MCT_OK ? mct_gauss_dynamics(&engine, force, out->couple, &out->workspace, &out->motion)
                            : status;
}

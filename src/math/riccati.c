#include "mctau/riccati.h"

#include <string.h>

#include "mctau/matrix.h"

#define N MCT_RICCATI_MAX_STATES
#define M MCT_RICCATI_MAX_INPUTS

/* The error after a doubling is of the order of the square of the change that it made. */
#define SETTLED 0x1p-40

static double largest(int count, const double *a)
{
    double result = 0.0;
    for (int i = 0; i < count; i++) {
        const double size = mct_abs(a[i]);
        if (!mct_is_finite(size)) {
            return size;
        }
        result = mct_max(result, size);
    }
    return result;
}

/** sum += (c + c') / 2: what is symmetric stays so, whatever rounding says. */
static void add_symmetric(int n, const double *c, double *sum)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            sum[i * n + j] += 0.5 * (c[i * n + j] + c[j * n + i]);
        }
    }
}

/** K = (R + B'PB)^-1 B'PA */
static mct_status gain(int n, int m, const double *A, const double *B, const double *R, const double *P,
                       double *K)
{
    double Bt[M * N];
    double BtP[M * N];
    double weight[M * M];
    mct_matrix_transpose(n, m, B, Bt);
    mct_matrix_multiply(m, n, n, Bt, P, BtP);
    mct_matrix_multiply(m, n, m, BtP, B, weight);
    mct_matrix_multiply(m, n, n, BtP, A, K);
    for (int i = 0; i < m * m; i++) {
        weight[i] += R[i];
    }
    return mct_matrix_solve(m, n, weight, K);
}

/** G = B R^-1 B' */
static mct_status reach(int n, int m, const double *B, const double *R, double *G)
{
    double factor[M * M];
    double solved[M * N];
    memcpy(factor, R, (size_t)(m * m) * sizeof *R);
    mct_matrix_transpose(n, m, B, solved);
    const mct_status status = mct_matrix_solve(m, n, factor, solved);
    if (status == MCT_OK) {
        mct_matrix_multiply(n, m, n, B, solved, G);
    }
    return status;
}

/**
 * One doubling, with W = 1 + G H:  flow <- flow W^-1 flow,  G <- G + flow W^-1 G flow',
 * H <- H + flow' H W^-1 flow. `change` is the largest entry of what H gains.
 */
static mct_status double_horizon(int n, double *flow, double *G, double *H, double *change)
{
    double W[N * N];
    double solved[N * 2 * N]; /* W^-1 [flow G] */
    double transposed[N * N];
    double left[N * N];
    double right[N * N];
    mct_matrix_multiply(n, n, n, G, H, W);
    for (int i = 0; i < n; i++) {
        W[i * n + i] += 1.0;
        for (int j = 0; j < n; j++) {
            solved[i * 2 * n + j] = flow[i * n + j];
            solved[i * 2 * n + n + j] = G[i * n + j];
        }
    }
    const mct_status status = mct_matrix_solve(n, 2 * n, W, solved);
    if (status != MCT_OK) {
        return status;
    }
    mct_matrix_transpose(n, n, flow, transposed);

    for (int i = 0; i < n; i++) {
        memcpy(&right[i * n], &solved[i * 2 * n + n], (size_t)n * sizeof *right);
    }
    mct_matrix_multiply(n, n, n, flow, right, left);
    mct_matrix_multiply(n, n, n, left, transposed, right);
    add_symmetric(n, right, G);

    for (int i = 0; i < n; i++) {
        memcpy(&right[i * n], &solved[i * 2 * n], (size_t)n * sizeof *right);
    }
    mct_matrix_multiply(n, n, n, transposed, H, left);
    mct_matrix_multiply(n, n, n, left, right, W);
    add_symmetric(n, W, H);
    *change = largest(n * n, W);

    mct_matrix_multiply(n, n, n, flow, right, left);
    memcpy(flow, left, (size_t)(n * n) * sizeof *flow);
    return MCT_OK;
}

mct_status mct_discrete_riccati(int n, int m, const double *A, const double *B, const double *Q,
                                const double *R, double *P, double *K)
{
    if (n < 1 || m < 1) {
        return MCT_ERROR_ARGUMENT;
    }
    if (n > N || m > M) {
        return MCT_ERROR_BOUND;
    }
    if (!mct_is_finite(largest(n * n, A) + largest(n * m, B) + largest(n * n, Q) + largest(m * m, R))) {
        return MCT_ERROR_NOT_FINITE;
    }
    double flow[N * N]; /* of the closed loop over 2^k ticks: it vanishes where the solution stabilises */
    double G[N * N];
    const mct_status status = reach(n, m, B, R, G);
    if (status != MCT_OK) {
        return status;
    }
    memcpy(flow, A, (size_t)(n * n) * sizeof *A);
    memset(P, 0, (size_t)(n * n) * sizeof *P);
    add_symmetric(n, Q, P);
    for (int i = 0; i < MCT_RICCATI_MAX_ITERATIONS; i++) {
        double change;
        if (double_horizon(n, flow, G, P, &change) != MCT_OK) {
            break;
        }
        const double size = largest(n * n, P);
        const double remaining = largest(n * n, flow);
        if (!mct_is_finite(size + remaining)) {
            break;
        }
        if (change <= SETTLED * size && remaining < SETTLED) {
            return gain(n, m, A, B, R, P, K);
        }
    }
    return MCT_ERROR_NO_CONVERGENCE;
}

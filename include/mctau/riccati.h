/**
 * @file riccati.h
 * The discrete algebraic Riccati equation: gains of an optimal controller or, transposed, of an observer.
 */
#ifndef MCTAU_RICCATI_H
#define MCTAU_RICCATI_H

#include "mctau/real.h"
#include "mctau/status.h"

#define MCT_RICCATI_MAX_STATES     8
#define MCT_RICCATI_MAX_INPUTS     2
#define MCT_RICCATI_MAX_ITERATIONS 60

/**
 * Solves P = A' P A - A' P B (R + B' P B)^-1 B' P A + Q for the stabilising P, and gives the gain
 * K = (R + B' P B)^-1 B' P A, with which u = -K x minimises the sum of x' Q x + u' R u along x <- A x + B u.
 *
 * All matrices are flat, row-major, in double and owned by the caller. For the steady Kalman filter pass A',
 * C', the two noise covariances, and use K' as the gain of the prediction.
 *
 * @param n  states, 1 to 8
 * @param m  inputs, 1 or 2
 * @param A  n x n, may be unstable
 * @param B  n x m; what is unstable must be reached by it
 * @param Q  n x n, symmetric, positive semidefinite; what does not decay by itself must be seen by it
 * @param R  m x m, symmetric, positive definite
 * @param P  n x n, out; symmetric
 * @param K  m x n, out
 * @return MCT_ERROR_ARGUMENT (n or m below 1), MCT_ERROR_BOUND (above the most), MCT_ERROR_NOT_FINITE,
 *         MCT_ERROR_SINGULAR (R), MCT_ERROR_NO_CONVERGENCE (no stabilising solution, or none found in
 *         60 iterations); P and K are then undefined.
 *
 * Cost: usually 5 to 15 iterations of some 8 n^3 multiplications; 4.5 KiB of stack. Thread-safe.
 * Source: the structure-preserving doubling algorithm, E. K.-W. Chu, H.-Y. Fan, W.-W. Lin, C.-S. Wang (2004):
 * each iteration doubles the horizon, so the error is squared.
 */
mct_status mct_discrete_riccati(int n, int m, const double *A, const double *B, const double *Q,
                                const double *R, double *P, double *K);

#endif

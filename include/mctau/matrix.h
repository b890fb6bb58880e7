/**
 * @file matrix.h
 * Small matrices of double, for what is computed once at init, in both precisions of the core.
 *
 * A matrix is a flat row-major array that the caller owns: entry (i, j) of an n x m matrix is a[i * m + j].
 * Dimensions go up to MCT_MATRIX_MAX. Everything here is deterministic to the bit (+ - * / and integers),
 * bounded, free of allocation, and thread-safe for distinct outputs.
 */
#ifndef MCTAU_MATRIX_H
#define MCTAU_MATRIX_H

#include "mctau/real.h"
#include "mctau/status.h"

/** Largest dimension of a matrix. */
#define MCT_MATRIX_MAX 12

/** Most squarings in mct_expm1(), so the largest norm is 2^63. */
#define MCT_EXPM1_MAX_SQUARINGS 64

MCT_INLINE double mct_abs(double x)
{
    return x < 0.0 ? -x : x;
}

MCT_INLINE double mct_min(double a, double b)
{
    return b < a ? b : a;
}

MCT_INLINE double mct_max(double a, double b)
{
    return b > a ? b : a;
}

/** Neither infinite nor NaN. */
MCT_INLINE bool mct_is_finite(double x)
{
    return x - x == 0.0;
}

/**
 * The square root, correctly rounded, by integer arithmetic: the same bits with or without a machine's own.
 * A negative number gives NaN; 0, -0, infinity and NaN give themselves. Some 60 short integer steps.
 */
double mct_sqrt(double x);

/** The square root in the core's precision, without arithmetic in another; correctly rounded in both. */
mct_real mct_sqrt_real(mct_real x);

/** product = a b, for a (rows x inner), b (inner x columns); the product must not overlap a or b. */
void mct_matrix_multiply(int rows, int inner, int columns, const double *a, const double *b, double *product);

/** transposed = a', for a (rows x columns); must not overlap. */
void mct_matrix_transpose(int rows, int columns, const double *a, double *transposed);

/**
 * Solves a x = b for all columns of b, in place, by elimination with scaled partial pivoting.
 *
 * @param n        rows and columns of a, rows of b
 * @param columns  of b, at least 0, without an upper bound
 * @param a        n x n, used up: holds nothing of use afterwards
 * @param b        n x columns; becomes x. Undefined if the return is not MCT_OK
 * @return MCT_ERROR_ARGUMENT for n < 1 or columns < 0, MCT_ERROR_BOUND for n > MCT_MATRIX_MAX,
 *         MCT_ERROR_NOT_FINITE, or MCT_ERROR_SINGULAR when a is so to within rounding, whatever the units of
 *         its rows and columns. Some n^3 / 3 + n^2 columns multiplications.
 */
mct_status mct_matrix_solve(int n, int columns, double *a, double *b);

/** inverse = a^-1, for a (n x n); must not overlap. Errors: those of mct_matrix_solve(). 1.2 KiB of stack. */
mct_status mct_matrix_inverse(int n, const double *a, double *inverse);

/**
 * x = e^a - 1 (the identity taken off), for a (n x n); must not overlap.
 *
 * Without the identity, small entries keep all their digits: where e^a is 1 + 1e-9, so does x hold 1e-9 to
 * full precision, which single precision needs (the flow of a fast motor over a tick: 3.2e-3 becomes
 * 2.9e-6). A Taylor sum of a / 2^k, then k times x <- 2 x + x x, which is e^(2 a) - 1. Stiff parts (-1e5 and
 * beyond) end at -1 without overflow.
 *
 * @return MCT_ERROR_ARGUMENT for n < 1, MCT_ERROR_BOUND for n > MCT_MATRIX_MAX, MCT_ERROR_NOT_FINITE for an
 *         entry of a, MCT_ERROR_RANGE when the norm exceeds 2^63 or e^a is too large for a double; x is then
 *         undefined. At most 15 n^3 multiplications and n^3 for each doubling of the norm above 1/2; 1.4 KiB
 *         of stack.
 */
mct_status mct_expm1(int n, const double *a, double *x);

#endif

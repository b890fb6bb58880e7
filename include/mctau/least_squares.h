/**
 * @file least_squares.h
 * Weighted least squares by orthogonal reflections (source, section 8.1), in the core's precision.
 */
#ifndef MCTAU_LEAST_SQUARES_H
#define MCTAU_LEAST_SQUARES_H

#include "mctau/real.h"
#include "mctau/status.h"

#define MCT_LEAST_SQUARES_MAX_ROWS    96
#define MCT_LEAST_SQUARES_MAX_COLUMNS 8

/**
 * Finds the b that minimises (y - x b)' w (y - x b) / 2 - pull' b, and the residual y - x b.
 *
 * Without a pull this is (435) to (441), and the residual is w-orthogonal to the columns of x. A pull asks
 * for x' w (y - x b) = -pull instead: it moves b by the w-smallest change of x b that does so. The normal
 * equations x' w x, whose condition is the square of that of x, are never formed.
 *
 * Householder's reflections are taken in the inner product <x, y> = x' w y of (445), so the weights need no
 * roots, and the residual comes from a rotation, not from a difference: it is small to the last digit where
 * y lies in the span of x.
 *
 * @param rows      of x, at least as many as columns, at most MCT_LEAST_SQUARES_MAX_ROWS
 * @param columns   of x, 1 to MCT_LEAST_SQUARES_MAX_COLUMNS
 * @param design    x, rows x columns, row-major; used up
 * @param weight    diagonal of w, rows, all positive
 * @param observed  y, rows; becomes the residual
 * @param pull      columns, or null for none
 * @param estimate  b, columns, out
 * @return MCT_ERROR_ARGUMENT (a dimension below 1), MCT_ERROR_BOUND (one above its most), MCT_ERROR_RANGE (a
 *         weight is not positive), MCT_ERROR_NOT_FINITE, MCT_ERROR_SINGULAR when a column lies in the span of
 *         those before it, to within rows * epsilon of its own length, so units do not matter. The
 *         outputs are then undefined.
 *
 * Cost: about 2 rows columns^2 multiplications and one root for each column. Thread-safe. Squares of lengths
 * must be representable: in float, w x^2 between 1e-30 and 1e38. Corrections to the source: (436) reads arg
 * min; (444) rests on h' w h = h' w.
 */
mct_status mct_least_squares(int rows, int columns, mct_real *design, const mct_real *weight,
                             mct_real *observed, const mct_real *pull, mct_real *estimate);

/**
 * The same with a ridge: finds the b that minimises ((y - x b)' w (y - x b) + lambda b'b) / 2, and the
 * residual y - x b, with lambda = ridge tr(x' w x) / columns.
 *
 * Where columns depend on each other, to within rounding or altogether, the data do not say how to share
 * between them; then this is the smallest b that fits, to within about `ridge` of itself. There may be fewer
 * rows than columns. The b's are compared with each other, so columns should be of comparable units. In
 * single precision 1e-4 is a good ridge, in double 1e-10. The ridge is another row for each column, so again
 * no normal equations are formed.
 *
 * @param rows      of x, at least 1; rows + columns at most MCT_LEAST_SQUARES_MAX_ROWS
 * @param design    x, with room for `columns` rows more; used up
 * @param weight    diagonal of w, with room for as many entries more
 * @param observed  y, with as much room; becomes the residual, followed by -b
 * @param ridge     positive
 * @param estimate  b, columns, out
 * @return as mct_least_squares(); MCT_ERROR_RANGE for a ridge that is not positive; MCT_ERROR_SINGULAR only
 *         for an x of zeros or a ridge below (rows epsilon)^2. Source: 8.1; A. E. Hoerl, R. W. Kennard
 *         (1970).
 */
mct_status mct_least_squares_ridge(int rows, int columns, mct_real *design, mct_real *weight,
                                   mct_real *observed, mct_real ridge, mct_real *estimate);

#endif

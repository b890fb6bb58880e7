#include "mctau/least_squares.h"

#include "mctau/matrix.h"

/** A reflection y <- y - u (u'wy) / half that fixes the rows above `first`; u is a column of the design. */
typedef struct {
    const mct_real *u; /* entry i is u[i * stride] */
    int stride;
    const mct_real *weight;
    int first;
    int rows;
    mct_real half; /* u'wu / 2 */
} reflection;

/** Applies it to a vector whose entry i is y[i * stride]. */
static void reflect(const reflection *self, mct_real *y, int stride)
{
    mct_real product = MCT_R(0.0);
    for (int i = self->first; i < self->rows; i++) {
        product += self->weight[i] * self->u[i * self->stride] * y[i * stride];
    }
    const mct_real factor = product / self->half;
    for (int i = self->first; i < self->rows; i++) {
        y[i * stride] -= factor * self->u[i * self->stride];
    }
}

/** Sum of w x^2 over the rows from `first` to before `end` of a column. */
static mct_real squared_length(const mct_real *x, int stride, const mct_real *weight, int first, int end)
{
    mct_real sum = MCT_R(0.0);
    for (int i = first; i < end; i++) {
        sum += weight[i] * x[i * stride] * x[i * stride];
    }
    return sum;
}

static bool is_finite(mct_real x)
{
    return x - x == MCT_R(0.0);
}

static mct_status check(int rows, int columns, const mct_real *weight)
{
    if (rows < 1 || columns < 1) {
        return MCT_ERROR_ARGUMENT;
    }
    if (rows > MCT_LEAST_SQUARES_MAX_ROWS || columns > MCT_LEAST_SQUARES_MAX_COLUMNS) {
        return MCT_ERROR_BOUND;
    }
    for (int i = 0; i < rows; i++) {
        if (!is_finite(weight[i])) {
            return MCT_ERROR_NOT_FINITE;
        }
        if (!(weight[i] > MCT_R(0.0))) {
            return MCT_ERROR_RANGE;
        }
    }
    return rows < columns ? MCT_ERROR_SINGULAR : MCT_OK;
}

mct_status mct_least_squares(int rows, int columns, mct_real *design, const mct_real *weight,
                             mct_real *observed, const mct_real *pull, mct_real *estimate)
{
    const mct_status status = check(rows, columns, weight);
    if (status != MCT_OK) {
        return status;
    }
    const mct_real tolerance = (mct_real)rows * MCT_REAL_EPSILON;
    reflection mirror[MCT_LEAST_SQUARES_MAX_COLUMNS];
    mct_real diagonal[MCT_LEAST_SQUARES_MAX_COLUMNS]; /* of R; what is above it stays in the design */

    /* design <- [R; 0], observed <- the same rotation of y */
    for (int k = 0; k < columns; k++) {
        mct_real *const column = design + k;
        mct_real *const pivot = column + k * columns;
        const mct_real above = squared_length(column, columns, weight, 0, k);
        const mct_real below = squared_length(column, columns, weight, k, rows);
        if (!is_finite(above + below)) {
            return MCT_ERROR_NOT_FINITE;
        }
        if (!(below > tolerance * tolerance * (above + below))) {
            return MCT_ERROR_SINGULAR;
        }
        const mct_real length = mct_sqrt_real(below / weight[k]);
        diagonal[k] = *pivot > MCT_R(0.0) ? -length : length; /* the sign that does not cancel */
        const mct_real half = below - weight[k] * diagonal[k] * *pivot;
        *pivot -= diagonal[k];
        mirror[k] = (reflection){column, columns, weight, k, rows, half};
        for (int j = k + 1; j < columns; j++) {
            reflect(&mirror[k], design + j, columns);
        }
        reflect(&mirror[k], observed, 1);
    }

    /* R' w shift = pull; then R b = y + shift, and the residual of the first rows is -shift */
    mct_real force[MCT_LEAST_SQUARES_MAX_COLUMNS];
    for (int k = 0; k < columns; k++) {
        mct_real sum = pull != NULL ? pull[k] : MCT_R(0.0);
        for (int i = 0; i < k; i++) {
            sum -= design[i * columns + k] * force[i];
        }
        force[k] = sum / diagonal[k];
        const mct_real shift = force[k] / weight[k];
        estimate[k] = observed[k] + shift;
        observed[k] = -shift;
    }
    for (int k = columns - 1; k >= 0; k--) {
        for (int j = k + 1; j < columns; j++) {
            estimate[k] -= design[k * columns + j] * estimate[j];
        }
        estimate[k] /= diagonal[k];
        if (!is_finite(estimate[k])) {
            return MCT_ERROR_NOT_FINITE;
        }
    }
    for (int k = columns - 1; k >= 0; k--) {
        reflect(&mirror[k], observed, 1);
    }
    return MCT_OK;
}

mct_status mct_least_squares_ridge(int rows, int columns, mct_real *design, mct_real *weight,
                                   mct_real *observed, mct_real ridge, mct_real *estimate)
{
    if (rows < 1 || columns < 1) {
        return MCT_ERROR_ARGUMENT;
    }
    const int all = rows + columns;
    if (rows > MCT_LEAST_SQUARES_MAX_ROWS || columns > MCT_LEAST_SQUARES_MAX_COLUMNS ||
        all > MCT_LEAST_SQUARES_MAX_ROWS) {
        return MCT_ERROR_BOUND;
    }
    if (!(ridge > MCT_R(0.0))) {
        return MCT_ERROR_RANGE;
    }
    mct_real trace = MCT_R(0.0);
    for (int j = 0; j < columns; j++) {
        trace += squared_length(design + j, columns, weight, 0, rows);
    }
    if (trace == MCT_R(0.0)) {
        return MCT_ERROR_SINGULAR;
    }
    for (int i = rows; i < all; i++) { /* 0 = b[i - rows], with the weight lambda */
        for (int j = 0; j < columns; j++) {
            design[i * columns + j] = i - rows == j ? MCT_R(1.0) : MCT_R(0.0);
        }
        weight[i] = ridge * trace / (mct_real)columns;
        observed[i] = MCT_R(0.0);
    }
    return mct_least_squares(all, columns, design, weight, observed, NULL, estimate);
}

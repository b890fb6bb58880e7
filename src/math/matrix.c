#include "mctau/matrix.h"

#include <string.h>

#define TAYLOR_DEGREE 15 /* with a norm of 1/2, the first term left out is 2^-15 / 16!, below 2^-59 */

/*
 * The root of mantissa 2^digits, mantissa being below 4 and having `digits` binary digits behind its point: digit by digit,
 * and one more to round by, as a root is never half-way between two numbers.
 */
static uint64_t rounded_root(uint64_t mantissa, int digits)
{
    uint64_t rest = mantissa << 1;
    uint64_t twice_root = 0;
    uint64_t root = 0;
    for (uint64_t bit = UINT64_C(2) << digits; bit != 0; bit >>= 1) {
        const uint64_t trial = twice_root + bit;
        if (trial <= rest) {
            rest -= trial;
            twice_root = trial + bit;
            root += bit;
        }
        rest <<= 1;
    }
    return (root + 1) >> 1;
}

/* A NaN is given as bits, since 0/0 differs in sign between machines. */
double mct_sqrt(double x)
{
    if (!(x > 0.0 && x <= DBL_MAX)) {
        const uint64_t quiet = UINT64_C(0x7ff8000000000000);
        double nan;
        memcpy(&nan, &quiet, sizeof nan);
        return x < 0.0 ? nan : x;
    }
    const bool subnormal = x < DBL_MIN;
    const double normal = subnormal ? x * 0x1p54 : x;
    uint64_t bits;
    memcpy(&bits, &normal, sizeof bits);
    const int exponent = (int)(bits >> 52) - 1023;
    const int odd = exponent & 1;
    const uint64_t one = UINT64_C(1) << 52;
    const uint64_t mantissa = ((bits & (one - 1)) | one) << odd; /* x = mantissa 2^(exponent - odd - 52) */
    /* The leading bit of the rounded root counts as one in the exponent's field. */
    const int field = (exponent - odd) / 2 + 1022;
    const uint64_t result_bits = ((uint64_t)field << 52) + rounded_root(mantissa, 52);
    double result;
    memcpy(&result, &result_bits, sizeof result);
    return subnormal ? result * 0x1p-27 : result;
}

#if MCT_REAL_IS_FLOAT
/* The same in single precision. */
mct_real mct_sqrt_real(mct_real x)
{
    if (!(x > 0 && x <= FLT_MAX)) {
        const uint32_t quiet = UINT32_C(0x7fc00000);
        mct_real nan;
        memcpy(&nan, &quiet, sizeof nan);
        return x < 0 ? nan : x;
    }
    const bool subnormal = x < FLT_MIN;
    const mct_real normal = subnormal ? x * 0x1p24F : x;
    uint32_t bits;
    memcpy(&bits, &normal, sizeof bits);
    const int exponent = (int)(bits >> 23) - 127;
    const int odd = exponent & 1;
    const uint32_t one = UINT32_C(1) << 23;
    const uint64_t mantissa = (uint64_t)((bits & (one - 1)) | one) << odd;
    const int field = (exponent - odd) / 2 + 126;
    const uint32_t result_bits = ((uint32_t)field << 23) + (uint32_t)rounded_root(mantissa, 23);
    mct_real result;
    memcpy(&result, &result_bits, sizeof result);
    return subnormal ? result * 0x1p-12F : result;
}
#else
mct_real mct_sqrt_real(mct_real x)
{
    return mct_sqrt(x);
}
#endif

void mct_matrix_multiply(int rows, int inner, int columns, const double *a, const double *b, double *product)
{
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < columns; j++) {
            double sum = 0.0;
            for (int k = 0; k < inner; k++) {
                sum += a[i * inner + k] * b[k * columns + j];
            }
            product[i * columns + j] = sum;
        }
    }
}

void mct_matrix_transpose(int rows, int columns, const double *a, double *transposed)
{
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < columns; j++) {
            transposed[j * rows + i] = a[i * columns + j];
        }
    }
}

static mct_status check_dimension(int n)
{
    return n < 1 ? MCT_ERROR_ARGUMENT : n > MCT_MATRIX_MAX ? MCT_ERROR_BOUND : MCT_OK;
}

static void swap_rows(int columns, double *a, int i, int j)
{
    for (int k = 0; k < columns; k++) {
        const double kept = a[i * columns + k];
        a[i * columns + k] = a[j * columns + k];
        a[j * columns + k] = kept;
    }
}

/** row i <- row i - factor row j, from column `first` on */
static void subtract_row(int columns, double *a, int i, double factor, int j, int first)
{
    for (int k = first; k < columns; k++) {
        a[i * columns + k] -= factor * a[j * columns + k];
    }
}

mct_status mct_matrix_solve(int n, int columns, double *a, double *b)
{
    const mct_status status = columns < 0 ? MCT_ERROR_ARGUMENT : check_dimension(n);
    if (status != MCT_OK) {
        return status;
    }
    double scale[MCT_MATRIX_MAX]; /* of a row: the inverse of its size */
    double size[MCT_MATRIX_MAX];  /* of a column, its rows scaled: what a pivot is held against */
    for (int i = 0; i < n; i++) {
        double sum = 0.0;
        for (int j = 0; j < n; j++) {
            sum += mct_abs(a[i * n + j]);
        }
        if (!mct_is_finite(sum)) {
            return MCT_ERROR_NOT_FINITE;
        }
        if (sum < DBL_MIN) {
            return MCT_ERROR_SINGULAR;
        }
        scale[i] = 1.0 / sum;
    }
    for (int j = 0; j < n; j++) {
        size[j] = 0.0;
        for (int i = 0; i < n; i++) {
            size[j] = mct_max(size[j], scale[i] * mct_abs(a[i * n + j]));
        }
    }
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++) {
            if (scale[i] * mct_abs(a[i * n + k]) > scale[pivot] * mct_abs(a[pivot * n + k])) {
                pivot = i;
            }
        }
        if (!(scale[pivot] * mct_abs(a[pivot * n + k]) > n * DBL_EPSILON * size[k])) {
            return MCT_ERROR_SINGULAR;
        }
        swap_rows(n, a, k, pivot);
        swap_rows(columns, b, k, pivot);
        swap_rows(1, scale, k, pivot);
        for (int i = k + 1; i < n; i++) {
            const double factor = a[i * n + k] / a[k * n + k];
            subtract_row(n, a, i, factor, k, k);
            subtract_row(columns, b, i, factor, k, 0);
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int i = k + 1; i < n; i++) {
            subtract_row(columns, b, k, a[k * n + i], i, 0);
        }
        for (int j = 0; j < columns; j++) {
            b[k * columns + j] /= a[k * n + k];
            if (!mct_is_finite(b[k * columns + j])) {
                return MCT_ERROR_NOT_FINITE;
            }
        }
    }
    return MCT_OK;
}

mct_status mct_matrix_inverse(int n, const double *a, double *inverse)
{
    const mct_status status = check_dimension(n);
    if (status != MCT_OK) {
        return status;
    }
    double work[MCT_MATRIX_MAX * MCT_MATRIX_MAX];
    for (int i = 0; i < n * n; i++) {
        work[i] = a[i];
        inverse[i] = i % (n + 1) == 0 ? 1.0 : 0.0;
    }
    return mct_matrix_solve(n, n, work, inverse);
}

/** Largest sum of absolute values over a row; NaN or infinite when an entry is. */
static double row_norm(int n, const double *a)
{
    double norm = 0.0;
    for (int i = 0; i < n; i++) {
        double sum = 0.0;
        for (int j = 0; j < n; j++) {
            sum += mct_abs(a[i * n + j]);
        }
        if (!(sum <= norm)) {
            norm = sum;
        }
        if (!mct_is_finite(norm)) {
            break;
        }
    }
    return norm;
}

/** Column j of s + s^2/2! + s^3/3! + ..., s = a scale, by Horner: the small terms are added first. */
static void taylor_column(int n, const double *a, double scale, int j, double *x)
{
    double column[MCT_MATRIX_MAX];
    for (int i = 0; i < n; i++) {
        column[i] = scale * a[i * n + j] / TAYLOR_DEGREE;
    }
    for (int k = TAYLOR_DEGREE - 1; k >= 1; k--) {
        double next[MCT_MATRIX_MAX];
        mct_matrix_multiply(n, n, 1, a, column, next);
        for (int i = 0; i < n; i++) {
            column[i] = scale * (a[i * n + j] + next[i]) / k;
        }
    }
    for (int i = 0; i < n; i++) {
        x[i * n + j] = column[i];
    }
}

mct_status mct_expm1(int n, const double *a, double *x)
{
    const mct_status status = check_dimension(n);
    if (status != MCT_OK) {
        return status;
    }
    double norm = row_norm(n, a);
    if (!mct_is_finite(norm)) {
        return MCT_ERROR_NOT_FINITE;
    }
    double scale = 1.0;
    int squarings = 0;
    for (; norm > 0.5; norm *= 0.5, scale *= 0.5) {
        if (++squarings > MCT_EXPM1_MAX_SQUARINGS) {
            return MCT_ERROR_RANGE;
        }
    }
    for (int j = 0; j < n; j++) {
        taylor_column(n, a, scale, j, x);
    }
    for (; squarings > 0; squarings--) {
        double half[MCT_MATRIX_MAX * MCT_MATRIX_MAX];
        memcpy(half, x, (size_t)(n * n) * sizeof *x);
        mct_matrix_multiply(n, n, n, half, half, x);
        for (int i = 0; i < n * n; i++) {
            x[i] += 2.0 * half[i];
        }
    }
    return mct_is_finite(row_norm(n, x)) ? MCT_OK : MCT_ERROR_RANGE;
}

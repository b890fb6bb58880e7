/*
 * How a printed equation is shown to fail, and its correction to hold:
 *
 *     while (another_state()) {
 *         ... random numbers of order one, by some() and any() ...
 *         judge(truth, printed, corrected);
 *     }
 *
 * After the last state, another_state() concludes: the correction agreed with the truth in all of them, to
 * TOLERANCE, and the printed one was off by more than MARGIN in nine of ten. An error counts against 1 + the
 * size of the truth. All numbers are of order one, so TOLERANCE is some thousands of roundings.
 */
#ifndef MCT_TEST_ERRATA_H
#define MCT_TEST_ERRATA_H

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "mctau/gauss.h"
#include "support/random.h"
#include "unity.h"

#define TOLERANCE 1e-12
#define MARGIN    1e-2
#define GRAVITY   9.81
#define PI        3.14159265358979323846

enum { STATES = 200 };

static struct {
    test_random random;
    int states, judged, printed_off;
    double corrected_off;
} errata;

void setUp(void)
{
    memset(&errata, 0, sizeof errata);
    errata.random.state = 1729;
}

void tearDown(void)
{
}

static inline bool another_state(void)
{
    if (errata.states++ < STATES) {
        return true;
    }
    TEST_ASSERT_TRUE_MESSAGE(errata.judged > 0, "nothing was judged");
    TEST_ASSERT_TRUE_MESSAGE(errata.corrected_off <= TOLERANCE, "the correction does not hold");
    TEST_ASSERT_TRUE_MESSAGE(10 * errata.printed_off >= 9 * errata.judged, "the printed equation holds");
    return false;
}

/* Positive, for masses and lengths. */
static inline double some(void)
{
    return random_in(&errata.random, 0.5, 2);
}

/* Of either sign and never near 0, for angles and rates. */
static inline double any(void)
{
    const double size = random_in(&errata.random, 0.5, 3);
    return random_bits(&errata.random) >> 63 ? size : -size;
}

static inline void judge_all(int count, const double *truth, const double *printed, const double *corrected)
{
    double size = 0, printed_off = 0, corrected_off = 0;
    for (int i = 0; i < count; i++) {
        size = hypot(size, truth[i]);
        printed_off = hypot(printed_off, printed[i] - truth[i]);
        corrected_off = hypot(corrected_off, corrected[i] - truth[i]);
    }
    errata.judged++;
    errata.printed_off += printed_off > MARGIN * (1 + size);
    errata.corrected_off = fmax(errata.corrected_off, corrected_off / (1 + size));
}

static inline void judge_number(double truth, double printed, double corrected)
{
    judge_all(1, &truth, &printed, &corrected);
}

/* ---- vectors and 3x3 matrices, by value: a test reads like its equation ---- */

typedef struct {
    double a[3];
} vector;

typedef struct {
    double a[3][3];
} matrix;

static const vector zero = {{0, 0, 0}};
static const matrix one = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static inline vector vec(double x, double y, double z)
{
    return (vector){{x, y, z}};
}

static inline vector vec_of(const double *a)
{
    return vec(a[0], a[1], a[2]);
}

static inline vector any_vector(void)
{
    const double x = any();
    const double y = any();
    return vec(x, y, any());
}

static inline vector add(vector x, vector y)
{
    return vec(x.a[0] + y.a[0], x.a[1] + y.a[1], x.a[2] + y.a[2]);
}

static inline vector scale(double factor, vector x)
{
    return vec(factor * x.a[0], factor * x.a[1], factor * x.a[2]);
}

static inline vector sub(vector x, vector y)
{
    return add(x, scale(-1, y));
}

static inline double dot(vector x, vector y)
{
    return x.a[0] * y.a[0] + x.a[1] * y.a[1] + x.a[2] * y.a[2];
}

static inline double norm(vector x)
{
    return sqrt(dot(x, x));
}

static inline vector cross(vector x, vector y)
{
    return vec(x.a[1] * y.a[2] - x.a[2] * y.a[1], x.a[2] * y.a[0] - x.a[0] * y.a[2],
               x.a[0] * y.a[1] - x.a[1] * y.a[0]);
}

static inline vector times(matrix A, vector x)
{
    return vec(dot(vec_of(A.a[0]), x), dot(vec_of(A.a[1]), x), dot(vec_of(A.a[2]), x));
}

static inline matrix transpose(matrix A)
{
    matrix T;
    for (int i = 0; i < 9; i++) {
        T.a[i % 3][i / 3] = A.a[i / 3][i % 3];
    }
    return T;
}

static inline matrix product(matrix A, matrix B)
{
    matrix P;
    const matrix columns = transpose(B);
    for (int i = 0; i < 9; i++) {
        P.a[i / 3][i % 3] = dot(vec_of(A.a[i / 3]), vec_of(columns.a[i % 3]));
    }
    return P;
}

/* A + factor B */
static inline matrix plus(matrix A, double factor, matrix B)
{
    for (int i = 0; i < 9; i++) {
        A.a[i / 3][i % 3] += factor * B.a[i / 3][i % 3];
    }
    return A;
}

static inline matrix scaled(double factor, matrix A)
{
    return plus((matrix){{{0}}}, factor, A);
}

static inline double determinant(matrix A)
{
    return dot(vec_of(A.a[0]), cross(vec_of(A.a[1]), vec_of(A.a[2])));
}

/* x of A' x = b: of A x = b for a symmetric A */
static inline vector solve(matrix A, vector b)
{
    const vector x = vec_of(A.a[0]), y = vec_of(A.a[1]), z = vec_of(A.a[2]);
    return scale(1 / determinant(A), vec(dot(b, cross(y, z)), dot(b, cross(z, x)), dot(b, cross(x, y))));
}

/* (231) */
static inline matrix R(vector x)
{
    return (matrix){
        {{0, -x.a[2], x.a[1]}, {x.a[2], 0, -x.a[0]}, {-x.a[1], x.a[0], 0}},
    };
}

/* R^2 by its definition in (233) */
static inline matrix R2(vector x)
{
    return product(R(x), R(x));
}

static inline void judge(vector truth, vector printed, vector corrected)
{
    judge_all(3, truth.a, printed.a, corrected.a);
}

/* What holds as printed, too. */
static inline void agree(vector truth, vector figure)
{
    errata.corrected_off = fmax(errata.corrected_off, norm(sub(truth, figure)) / (1 + norm(truth)));
}

static inline void judge_matrix(matrix truth, matrix printed, matrix corrected)
{
    judge_all(9, truth.a[0], printed.a[0], corrected.a[0]);
}

/* ---- the judge ---- */

/* Valid until the next call. */
static inline const mct_gauss_motion *engine(mct_gauss_system system, double time, const double *q,
                                             const double *v, const double *force, const double *couple)
{
    static mct_gauss_workspace workspace;
    static mct_gauss_motion motion;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_kinematics(&system, time, q, v, &workspace, &motion));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_dynamics(&system, force, couple, &workspace, &motion));
    return &motion;
}

#endif

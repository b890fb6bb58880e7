/* The rules of include/mctau/least_squares.h (source, section 8.1). */
#include <math.h>
#include <string.h>

#include "mctau/least_squares.h"
#include "unity.h"

#define EPSILON ((double)MCT_REAL_EPSILON)

enum { ROWS = MCT_LEAST_SQUARES_MAX_ROWS, COLUMNS = MCT_LEAST_SQUARES_MAX_COLUMNS };

void setUp(void)
{
}

void tearDown(void)
{
}

static uint64_t random_state;

static mct_real random_number(void)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (mct_real)((double)((random_state * UINT64_C(2685821657736338717)) >> 11) * 0x1p-52 - 1.0);
}

/* A problem, its copy that is used up, and its solution. */
typedef struct {
    int rows;
    int columns;
    mct_real design[ROWS * COLUMNS];
    mct_real weight[ROWS];
    mct_real observed[ROWS];
    mct_real pull[COLUMNS];
    mct_real spent[ROWS * COLUMNS];
    mct_real residual[ROWS];
    mct_real estimate[COLUMNS];
} problem;

static mct_status solve(problem *self, bool pulled)
{
    memcpy(self->spent, self->design, sizeof self->spent);
    memcpy(self->residual, self->observed, sizeof self->residual);
    return mct_least_squares(self->rows, self->columns, self->spent, self->weight, self->residual,
                             pulled ? self->pull : NULL, self->estimate);
}

/* Weights over four decades, as the masses of a mechanism may be. */
static void fill(problem *self, int rows, int columns)
{
    random_state = (uint64_t)(1 + rows * 100 + columns);
    self->rows = rows;
    self->columns = columns;
    for (int i = 0; i < rows; i++) {
        for (int j = 0; j < columns; j++) {
            self->design[i * columns + j] = random_number();
        }
        self->weight[i] = (mct_real)pow(10.0, 2.0 * (double)random_number());
        self->observed[i] = random_number();
    }
    for (int j = 0; j < columns; j++) {
        self->pull[j] = random_number();
    }
}

static const int shapes[][2] = {{1, 1}, {3, 1}, {3, 3}, {6, 2}, {30, 5}, {ROWS, COLUMNS}};
enum { SHAPES = sizeof shapes / sizeof *shapes };

static double weighted_size(const problem *self)
{
    double sum = 1.0;
    for (int i = 0; i < self->rows; i++) {
        sum += (double)self->weight[i];
    }
    return sum;
}

static void test_residual_is_orthogonal_to_every_column_in_the_metric_of_the_weights(void)
{
    for (int k = 0; k < SHAPES; k++) {
        problem p;
        fill(&p, shapes[k][0], shapes[k][1]);
        TEST_ASSERT_EQUAL_INT(MCT_OK, solve(&p, false));
        for (int j = 0; j < p.columns; j++) {
            double product = 0.0;
            for (int i = 0; i < p.rows; i++) {
                product += (double)p.weight[i] * (double)p.design[i * p.columns + j] * (double)p.residual[i];
            }
            TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON * weighted_size(&p), 0.0, product);
        }
    }
}

static void test_residual_is_the_observation_less_the_estimate(void)
{
    for (int k = 0; k < SHAPES; k++) {
        for (int pulled = 0; pulled < 2; pulled++) {
            problem p;
            fill(&p, shapes[k][0], shapes[k][1]);
            TEST_ASSERT_EQUAL_INT(MCT_OK, solve(&p, pulled));
            double size = 1.0;
            for (int j = 0; j < p.columns; j++) {
                size += fabs((double)p.estimate[j]);
            }
            for (int i = 0; i < p.rows; i++) {
                double difference = (double)p.observed[i];
                for (int j = 0; j < p.columns; j++) {
                    difference -= (double)p.design[i * p.columns + j] * (double)p.estimate[j];
                }
                /* a light row beside a heavy one loses digits by the root of the ratio, here up to 100 */
                const double slack = 8 * EPSILON * size * sqrt(weighted_size(&p) / (double)p.weight[i]);
                TEST_ASSERT_DOUBLE_WITHIN(slack, difference, (double)p.residual[i]);
            }
        }
    }
}

static void test_a_pull_is_what_the_weighted_residual_balances(void)
{
    for (int k = 0; k < SHAPES; k++) {
        problem p;
        fill(&p, shapes[k][0], shapes[k][1]);
        TEST_ASSERT_EQUAL_INT(MCT_OK, solve(&p, true));
        for (int j = 0; j < p.columns; j++) {
            double product = 0.0;
            double size = weighted_size(&p);
            for (int i = 0; i < p.rows; i++) {
                product += (double)p.weight[i] * (double)p.design[i * p.columns + j] * (double)p.residual[i];
                size += (double)p.weight[i] * fabs((double)p.residual[i]);
            }
            TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON * size, -(double)p.pull[j], product);
        }
    }
}

static void test_weights_weigh(void)
{
    /* one unknown, two readings: the weighted mean */
    mct_real design[] = {MCT_R(1.0), MCT_R(1.0)};
    const mct_real weight[] = {MCT_R(3.0), MCT_R(1.0)};
    mct_real observed[] = {MCT_R(2.0), MCT_R(10.0)};
    mct_real mean;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_least_squares(2, 1, design, weight, observed, NULL, &mean));
    TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON, 4.0, (double)mean);
    TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON, -2.0, (double)observed[0]);
    TEST_ASSERT_DOUBLE_WITHIN(32 * EPSILON, 6.0, (double)observed[1]);
}

static void test_normal_equations_that_would_fail_are_not_formed(void)
{
    /* x'x = [[1 + d^2, 1], [1, 1 + d^2]] is singular to rounding; x is not */
    const mct_real d = MCT_REAL_IS_FLOAT ? MCT_R(1e-4) : MCT_R(1e-9);
    mct_real design[] = {MCT_R(1.0), MCT_R(1.0), d, MCT_R(0.0), MCT_R(0.0), d};
    const mct_real weight[] = {MCT_R(1.0), MCT_R(1.0), MCT_R(1.0)};
    mct_real observed[] = {MCT_R(3.0), d, 2 * d}; /* b = (1, 2) */
    mct_real b[2];
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_least_squares(3, 2, design, weight, observed, NULL, b));
    TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON / (double)d, 1.0, (double)b[0]);
    TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON / (double)d, 2.0, (double)b[1]);
}

static void test_units_of_a_column_do_not_change_its_rank(void)
{
    mct_real design[] = {MCT_R(1.0), MCT_R(1e-9), MCT_R(1.0), MCT_R(-1e-9)};
    const mct_real weight[] = {MCT_R(1.0), MCT_R(1.0)};
    mct_real observed[] = {MCT_R(3.0), MCT_R(1.0)};
    mct_real b[2];
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_least_squares(2, 2, design, weight, observed, NULL, b));
    TEST_ASSERT_DOUBLE_WITHIN(16 * EPSILON, 2.0, (double)b[0]);
    TEST_ASSERT_DOUBLE_WITHIN(16 * EPSILON, 1.0, 1e-9 * (double)b[1]);
}

static void test_columns_that_depend_on_each_other_are_reported(void)
{
    problem p;
    fill(&p, 30, 4);
    for (int i = 0; i < p.rows; i++) {
        mct_real *const row = p.design + i * p.columns;
        row[3] = row[0] - MCT_R(3.0) * row[1] + MCT_R(0.1) * row[2];
    }
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, solve(&p, false));
    for (int i = 0; i < p.rows; i++) {
        p.design[i * p.columns + 3] = MCT_R(0.0);
    }
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, solve(&p, false));
    fill(&p, 2, 3);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, solve(&p, false));
}

static void test_bad_problems_are_refused(void)
{
    problem p;
    fill(&p, 6, 2);
    p.weight[4] = MCT_R(0.0);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, solve(&p, false));
    p.weight[4] = (mct_real)NAN;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, solve(&p, false));
    fill(&p, 6, 2);
    p.observed[5] = (mct_real)NAN;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, solve(&p, false));
    fill(&p, 6, 2);
    p.design[11] = (mct_real)INFINITY;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, solve(&p, false));
    p.columns = 0;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, solve(&p, false));
    p.columns = COLUMNS + 1;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, solve(&p, false));
    p.columns = 1;
    p.rows = ROWS + 1;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, solve(&p, false));
}

/* ---- with a ridge ---- */

static mct_status solve_with_ridge(problem *self, double ridge)
{
    memcpy(self->spent, self->design, sizeof self->spent);
    memcpy(self->residual, self->observed, sizeof self->residual);
    return mct_least_squares_ridge(self->rows, self->columns, self->spent, self->weight, self->residual,
                                   (mct_real)ridge, self->estimate);
}

/* The minimum: x' w (y - x b) = lambda b. */
static void test_a_ridge_balances_the_weighted_residual_with_the_estimate(void)
{
    for (int s = 0; s < SHAPES - 1; s++) { /* the last one leaves no room for the ridge */
        problem p;
        fill(&p, shapes[s][0], shapes[s][1]);
        double trace = 0;
        for (int i = 0; i < p.rows * p.columns; i++) {
            trace += (double)p.weight[i / p.columns] * (double)p.design[i] * (double)p.design[i];
        }
        TEST_ASSERT_EQUAL_INT(MCT_OK, solve_with_ridge(&p, 0.01));
        for (int j = 0; j < p.columns; j++) {
            double balance = 0.01 * trace / p.columns * (double)p.estimate[j];
            for (int i = 0; i < p.rows; i++) {
                balance -= (double)p.weight[i] * (double)p.design[i * p.columns + j] * (double)p.residual[i];
            }
            TEST_ASSERT_DOUBLE_WITHIN(64 * EPSILON * weighted_size(&p), 0.0, balance);
        }
        for (int i = 0; i < p.rows; i++) {
            double residual = (double)p.observed[i];
            double size = 1;
            for (int j = 0; j < p.columns; j++) {
                residual -= (double)p.design[i * p.columns + j] * (double)p.estimate[j];
                size += fabs((double)p.estimate[j]);
            }
            TEST_ASSERT_DOUBLE_WITHIN(64 * EPSILON * size, residual, (double)p.residual[i]);
        }
        for (int j = 0; j < p.columns; j++) {
            TEST_ASSERT_DOUBLE_WITHIN(64 * EPSILON * (1 + fabs((double)p.estimate[j])),
                                      -(double)p.estimate[j], (double)p.residual[p.rows + j]);
        }
    }
}

/*
 * Hard case 32. y = 3 x_1 - x_2 where column 3 is x_1 + x_2: what b = (3, -1, 0) + t (1, 1, -1) is smallest
 * for t = -2/3, so (7, -5, 2)/3. A ridge takes lambda over the smallest square of a stretch, here a third of
 * the trace or more, off it, and roundings of the data are amplified by the root of its inverse at most.
 */
static void test_dependent_columns_get_the_smallest_estimate_that_fits(void)
{
    const double wanted[] = {7.0 / 3, -5.0 / 3, 2.0 / 3};
    const double ridge = MCT_REAL_IS_FLOAT ? 1e-4 : 1e-10;
    problem p;
    fill(&p, 40, 3);
    for (int i = 0; i < p.rows; i++) {
        mct_real *x = p.design + 3 * i;
        x[2] = x[0] + x[1];
        p.weight[i] = MCT_R(1.0);
        p.observed[i] = 3 * x[0] - x[1];
    }
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, solve(&p, false));
    TEST_ASSERT_EQUAL_INT(MCT_OK, solve_with_ridge(&p, ridge));
    for (int j = 0; j < 3; j++) {
        TEST_ASSERT_DOUBLE_WITHIN(10 * ridge + 40 * EPSILON / sqrt(ridge), wanted[j], (double)p.estimate[j]);
    }
}

static void test_fewer_rows_than_columns_do_with_a_ridge(void)
{
    problem p;
    fill(&p, 1, 2);
    p.design[0] = 3;
    p.design[1] = 4;
    p.observed[0] = 10;
    const double ridge = MCT_REAL_IS_FLOAT ? 1e-4 : 1e-10;
    TEST_ASSERT_EQUAL_INT(MCT_OK, solve_with_ridge(&p, ridge));
    TEST_ASSERT_DOUBLE_WITHIN(2 * ridge, 1.2, (double)p.estimate[0]);
    TEST_ASSERT_DOUBLE_WITHIN(2 * ridge, 1.6, (double)p.estimate[1]);
}

static void test_bad_ridges_are_refused(void)
{
    problem p;
    fill(&p, 6, 2);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, solve_with_ridge(&p, 0));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, solve_with_ridge(&p, NAN));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, solve_with_ridge(&p, INFINITY));
    p.weight[1] = -1;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, solve_with_ridge(&p, 0.1));
    fill(&p, ROWS, 2);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, solve_with_ridge(&p, 0.1));
    p.rows = 0;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, solve_with_ridge(&p, 0.1));
    fill(&p, 6, 2);
    memset(p.design, 0, sizeof p.design);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, solve_with_ridge(&p, 0.1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_residual_is_orthogonal_to_every_column_in_the_metric_of_the_weights);
    RUN_TEST(test_residual_is_the_observation_less_the_estimate);
    RUN_TEST(test_a_pull_is_what_the_weighted_residual_balances);
    RUN_TEST(test_weights_weigh);
    RUN_TEST(test_normal_equations_that_would_fail_are_not_formed);
    RUN_TEST(test_units_of_a_column_do_not_change_its_rank);
    RUN_TEST(test_columns_that_depend_on_each_other_are_reported);
    RUN_TEST(test_bad_problems_are_refused);
    RUN_TEST(test_a_ridge_balances_the_weighted_residual_with_the_estimate);
    RUN_TEST(test_dependent_columns_get_the_smallest_estimate_that_fits);
    RUN_TEST(test_fewer_rows_than_columns_do_with_a_ridge);
    RUN_TEST(test_bad_ridges_are_refused);
    return UNITY_END();
}

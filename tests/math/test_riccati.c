/* The rules of include/mctau/riccati.h. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/matrix.h"
#include "mctau/riccati.h"
#include "unity.h"

#define N MCT_RICCATI_MAX_STATES
#define M MCT_RICCATI_MAX_INPUTS

void setUp(void)
{
}

void tearDown(void)
{
}

typedef struct {
    int n;
    int m;
    double A[N * N];
    double B[N * M];
    double Q[N * N];
    double R[M * M];
} problem;

static double largest(int count, const double *a)
{
    double result = 0.0;
    for (int i = 0; i < count; i++) {
        result = fmax(result, fabs(a[i]));
    }
    return result;
}

/* closed = A - B K */
static void closed_loop(const problem *self, const double *K, double *closed)
{
    mct_matrix_multiply(self->n, self->m, self->n, self->B, K, closed);
    for (int i = 0; i < self->n * self->n; i++) {
        closed[i] = self->A[i] - closed[i];
    }
}

static mct_status solve(const problem *self, double *P, double *K)
{
    return mct_discrete_riccati(self->n, self->m, self->A, self->B, self->Q, self->R, P, K);
}

/* Largest entry of Q + A' P (A - B K) - P, over that of P: the equation itself, with K put in. */
static double residual(const problem *self, const double *P, const double *K)
{
    const int n = self->n;
    double closed[N * N];
    double At[N * N];
    double AtP[N * N];
    double sum[N * N];
    closed_loop(self, K, closed);
    mct_matrix_transpose(n, n, self->A, At);
    mct_matrix_multiply(n, n, n, At, P, AtP);
    mct_matrix_multiply(n, n, n, AtP, closed, sum);
    for (int i = 0; i < n * n; i++) {
        sum[i] += self->Q[i] - P[i];
    }
    return largest(n * n, sum) / largest(n * n, P);
}

/* The closed loop decays: its 2^20-th power vanishes. */
static bool is_stable(const problem *self, const double *K)
{
    const int n = self->n;
    double power[N * N];
    closed_loop(self, K, power);
    for (int i = 0; i < 20; i++) {
        double square[N * N];
        mct_matrix_multiply(n, n, n, power, power, square);
        memcpy(power, square, sizeof power);
    }
    return largest(n * n, power) < 1e-3;
}

/* The tolerance is that of rounding in A' P A, with the few digits that a badly scaled P costs. */
static void assert_solved(const char *name, const problem *self, double *P, double *K)
{
    TEST_ASSERT_EQUAL_INT(MCT_OK, solve(self, P, K));
    const double error = residual(self, P, K);
    printf("mctau: riccati, %s: relative residual %.1e\n", name, error);
    TEST_ASSERT_TRUE(error < 1e-12);
    TEST_ASSERT_TRUE(is_stable(self, K));
    for (int i = 0; i < self->n; i++) {
        TEST_ASSERT_TRUE(P[i * self->n + i] >= 0.0);
        for (int j = 0; j < i; j++) {
            TEST_ASSERT_TRUE(P[i * self->n + j] == P[j * self->n + i]);
        }
    }
}

static void test_scalar_equation_has_its_golden_solution(void)
{
    /* p = p - p^2 / (1 + p) + 1, so p^2 = p + 1 */
    const problem scalar = {1, 1, {1}, {1}, {1}, {1}};
    double P[1];
    double K[1];
    assert_solved("integrator", &scalar, P, K);
    const double golden = (1 + sqrt(5.0)) / 2;
    TEST_ASSERT_DOUBLE_WITHIN(4 * DBL_EPSILON, golden, P[0]);
    TEST_ASSERT_DOUBLE_WITHIN(4 * DBL_EPSILON, golden / (1 + golden), K[0]);
}

static void test_expensive_control_mirrors_an_unstable_pole(void)
{
    /* with Q = 0 the cheapest gain that stabilises a = 2 puts the pole at 1/2: p = 3, k = 3/2 */
    const problem scalar = {1, 1, {2}, {1}, {0}, {1}};
    double P[1];
    double K[1];
    /* without a cost the doubling starts at P = 0, which solves the equation but does not stabilise */
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NO_CONVERGENCE, solve(&scalar, P, K));
    problem cheap = scalar;
    cheap.Q[0] = 1e-12;
    assert_solved("unstable scalar", &cheap, P, K);
    TEST_ASSERT_DOUBLE_WITHIN(1e-11, 3.0, P[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-11, 1.5, K[0]);
}

static void test_double_integrator_at_a_kilohertz_is_solved(void)
{
    const double h = 1e-3;
    const problem mass = {2, 1, {1, h, 0, 1}, {h * h / 2, h}, {1, 0, 0, 0.1}, {1e-4}};
    double P[4];
    double K[2];
    assert_solved("double integrator, 1 kHz", &mass, P, K);
    /* the continuous regulator: k_2^2 = q_2 / r + 2 k_1, k_1^2 = q_1 / r; a tick changes it by some w h */
    TEST_ASSERT_DOUBLE_WITHIN(5.0, 100.0, K[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1.5, sqrt(1000.0 + 200.0), K[1]);
}

static void test_upright_reaction_wheel_with_motor_is_solved(void)
{
    /* arm angle, arm rate, wheel rate; e^(A h) - 1 by the library itself */
    const double h = 1e-3;
    double generator[16] = {0, 1, 0, 0, 77.0, -0.05, 0.02, -0.5, -77.0, 0.05, -2.5, 90.0, 0, 0, 0, 0};
    double flow[16];
    for (int i = 0; i < 16; i++) {
        generator[i] *= h;
    }
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_expm1(4, generator, flow));
    problem wheel = {3, 1, {0}, {0}, {0}, {0.01}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            wheel.A[i * 3 + j] = flow[i * 4 + j] + (i == j ? 1 : 0);
        }
        wheel.B[i] = flow[i * 4 + 3];
        wheel.Q[i * 3 + i] = i == 0 ? 100 : i == 1 ? 1 : 1e-6;
    }
    double P[9];
    double K[3];
    assert_solved("upright reaction wheel, 1 kHz", &wheel, P, K);
}

static void test_two_inputs_and_eight_states_are_solved(void)
{
    /* a chain of unstable cells, driven at both ends */
    problem chain = {8, 2, {0}, {0}, {0}, {1, 0.2, 0.2, 2}};
    for (int i = 0; i < 8; i++) {
        chain.A[i * 8 + i] = 1.02;
        chain.Q[i * 8 + i] = 1.0 + i;
        if (i > 0) {
            chain.A[i * 8 + i - 1] = 0.3;
            chain.A[(i - 1) * 8 + i] = -0.2;
        }
    }
    chain.B[0] = 1;
    chain.B[7 * 2 + 1] = 1;
    double P[64];
    double K[16];
    assert_solved("eight states, two inputs", &chain, P, K);
}

static void test_observer_is_the_transposed_regulator(void)
{
    /* a position measured with variance r, driven by acceleration noise: Kalata's relation of the gains */
    const double h = 1e-2;
    const double q = 4.0;
    const double r = 1e-3;
    const problem filter = {
        2,  1, {1, 0, h, 1}, {1, 0}, {q * h * h * h * h / 4, q * h * h * h / 2, q * h * h * h / 2, q * h * h},
        {r}};
    double P[4];
    double K[2];
    assert_solved("tracking filter", &filter, P, K);
    const double index = sqrt(q * h * h * h * h / r);
    const double alpha_beta = P[0] / (P[0] + r);
    const double beta = P[1] / (P[0] + r) * h;
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, index * index, beta * beta / (1 - alpha_beta));
}

static void test_what_cannot_be_stabilised_is_reported(void)
{
    const problem unreachable = {2, 1, {1.1, 0, 0, 0.5}, {0, 1}, {1, 0, 0, 1}, {1}};
    const problem unseen = {2, 1, {1.0, 0, 0, 0.5}, {1, 1}, {0, 0, 0, 1}, {1}};
    double P[4];
    double K[2];
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NO_CONVERGENCE, solve(&unreachable, P, K));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NO_CONVERGENCE, solve(&unseen, P, K));
}

static void test_bad_problems_are_refused(void)
{
    problem bad = {1, 1, {1}, {1}, {1}, {0}};
    double P[1];
    double K[1];
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, solve(&bad, P, K));
    bad.R[0] = (double)NAN;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, solve(&bad, P, K));
    bad.n = 0;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, solve(&bad, P, K));
    bad.n = N + 1;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, solve(&bad, P, K));
    bad.n = 1;
    bad.m = M + 1;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, solve(&bad, P, K));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_scalar_equation_has_its_golden_solution);
    RUN_TEST(test_expensive_control_mirrors_an_unstable_pole);
    RUN_TEST(test_double_integrator_at_a_kilohertz_is_solved);
    RUN_TEST(test_upright_reaction_wheel_with_motor_is_solved);
    RUN_TEST(test_two_inputs_and_eight_states_are_solved);
    RUN_TEST(test_observer_is_the_transposed_regulator);
    RUN_TEST(test_what_cannot_be_stabilised_is_reported);
    RUN_TEST(test_bad_problems_are_refused);
    return UNITY_END();
}

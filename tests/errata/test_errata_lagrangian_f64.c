/* Section 3 of the source, on its spring pendulum, against the Gauss engine. docs/errata.md has the list. */
#include "errata/errata.h"

typedef struct {
    double m, g, q[2], v[2]; /* mass, gravity; distance from the pivot and angle; their rates */
    double W_gradient[2];    /* of the work W of the weight, by differentiation of -m g x2 */
    const mct_gauss_motion *motion;
} ball;

static void place_ball(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                       mct_hyperdual (*position)[3])
{
    (void)context;
    (void)time;
    position[0][0] = mct_hyperdual_mul(q[0], mct_hyperdual_cos(q[1]));
    position[0][1] = mct_hyperdual_mul(q[0], mct_hyperdual_sin(q[1]));
    position[0][2] = mct_hyperdual_constant(0);
}

static ball random_ball(void)
{
    ball p = {.m = some(), .g = 10 * some(), .q = {some(), any()}, .v = {any(), any()}};
    for (int i = 0; i < 2; i++) {
        const mct_hyperdual q[2] = {{p.q[0], i == 0, 0, 0}, {p.q[1], i == 1, 0, 0}};
        mct_hyperdual position[1][3];
        place_ball(NULL, (mct_hyperdual){0, 0, 0, 0}, q, position);
        p.W_gradient[i] = -p.m * p.g * position[0][1].e1;
    }
    const double weight[3] = {0, -p.m * p.g, 0};
    p.motion = engine((mct_gauss_system){1, 2, &p.m, place_ball, NULL}, 0, p.q, p.v, weight, NULL);
    return p;
}

/* d/dt dL/dthd - dL/dth = 0 is M a + C v = dK/dth and +- dW/dth: the sign of W in L is that of the force. */
static void test_eq_189_is_the_sum_of_kinetic_energy_and_work(void)
{
    while (another_state()) {
        const ball p = random_ball();
        const double inertia[2] = {p.m, p.m * p.q[0] * p.q[0]};
        double printed[2], corrected[2];
        for (int i = 0; i < 2; i++) {
            printed[i] = (-p.W_gradient[i] - p.motion->Cv[i]) / inertia[i];
            corrected[i] = (p.W_gradient[i] - p.motion->Cv[i]) / inertia[i];
        }
        judge_all(2, p.motion->acceleration, printed, corrected);
    }
}

static void test_eq_215_is_minus_the_gradient_of_the_potential(void)
{
    while (another_state()) {
        const ball p = random_ball();
        const double V_gradient[2] = {-p.W_gradient[0], -p.W_gradient[1]};
        judge_all(2, p.motion->tau, V_gradient, (double[2]){-V_gradient[0], -V_gradient[1]});
    }
}

/* The rate of the momentum m r^2 w. Along the motion m J'Jdot v is 2 m r rd w, and m Jdot'J v is 0. */
static void test_eq_216_has_the_mass(void)
{
    while (another_state()) {
        const ball p = random_ball();
        const mct_hyperdual r = {p.q[0], p.v[0], 0, 0}, w = {p.v[1], p.motion->acceleration[1], 0, 0};
        const double truth = p.m * mct_hyperdual_mul(mct_hyperdual_mul(r, r), w).e1;
        const double inertial = p.motion->M[1][1] * p.motion->acceleration[1];
        const double J_Jdot_v = 2 * p.q[0] * p.v[0] * p.v[1];
        judge_number(truth, inertial + J_Jdot_v, inertial + p.m * J_Jdot_v);
    }
}

static void test_eq_218_and_219_have_the_mass(void)
{
    while (another_state()) {
        const ball p = random_ball();
        double printed[2], corrected[2];
        for (int i = 0; i < 2; i++) {
            const double inertial = p.motion->M[i][i] * p.motion->acceleration[i];
            printed[i] = inertial + p.motion->Cv[i] / p.m;
            corrected[i] = inertial + p.motion->Cv[i];
        }
        judge_all(2, p.motion->tau, printed, corrected);
    }
}

/* h_ijk of (229) for M = diag(m, m r^2): the only ones that are not 0. */
static double h_122(const ball *p)
{
    return -p->m * p->q[0];
}

static double h_221(const ball *p)
{
    return 2 * p->m * p->q[0];
}

static void test_eq_228_has_one_rate_and_not_two(void)
{
    while (another_state()) {
        const ball p = random_ball();
        const double C[2][2] = {{0, h_122(&p) * p.v[1]}, {0, h_221(&p) * p.v[0]}};
        double printed[2], corrected[2];
        for (int i = 0; i < 2; i++) {
            printed[i] = C[i][0] * p.v[0] * p.v[0] + C[i][1] * p.v[1] * p.v[1];
            corrected[i] = C[i][0] * p.v[0] + C[i][1] * p.v[1];
        }
        judge_all(2, p.motion->Cv, printed, corrected);
    }
}

static void test_text_229_equals_m_j_jdot_only_when_applied_to_the_rates(void)
{
    while (another_state()) {
        const ball p = random_ball();
        judge_number(p.motion->C[1][1], h_221(&p) * p.v[0], p.m * p.q[0] * p.v[0]);
        TEST_ASSERT_DOUBLE_WITHIN(TOLERANCE * (1 + fabs(p.motion->Cv[1])), p.motion->Cv[1],
                                  h_221(&p) * p.v[0] * p.v[1]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_eq_189_is_the_sum_of_kinetic_energy_and_work);
    RUN_TEST(test_eq_215_is_minus_the_gradient_of_the_potential);
    RUN_TEST(test_eq_216_has_the_mass);
    RUN_TEST(test_eq_218_and_219_have_the_mass);
    RUN_TEST(test_eq_228_has_one_rate_and_not_two);
    RUN_TEST(test_text_229_equals_m_j_jdot_only_when_applied_to_the_rates);
    return UNITY_END();
}

/*
 * Section 7 of the source, inverse kinematics of a planar chain, against a chain that is built link by link,
 * differentiated in hyper-dual numbers. docs/errata.md lists the equations.
 */
#include "errata/errata.h"

enum { LINKS = 4 };

typedef struct {
    double length[LINKS], angle[LINKS];
    double tip[2], J[2][LINKS]; /* by the links themselves */
    double miss[2];             /* d - f, target less tip */
} chain;

/* The tip, from the last link inwards: each joint turns all that lies beyond it. */
static void tip_of(const double *length, const mct_hyperdual *angle, mct_hyperdual tip[2])
{
    tip[0] = tip[1] = mct_hyperdual_constant(0);
    for (int i = LINKS - 1; i >= 0; i--) {
        const mct_hyperdual c = mct_hyperdual_cos(angle[i]), s = mct_hyperdual_sin(angle[i]);
        const mct_hyperdual x = mct_hyperdual_add(tip[0], mct_hyperdual_constant(length[i])), y = tip[1];
        tip[0] = mct_hyperdual_sub(mct_hyperdual_mul(c, x), mct_hyperdual_mul(s, y));
        tip[1] = mct_hyperdual_add(mct_hyperdual_mul(s, x), mct_hyperdual_mul(c, y));
    }
}

/* With its derivative by angle k. */
static void tip_by_angle(const chain *self, int k, mct_hyperdual tip[2])
{
    mct_hyperdual angle[LINKS];
    for (int i = 0; i < LINKS; i++) {
        angle[i] = (mct_hyperdual){self->angle[i], i == k, 0, 0};
    }
    tip_of(self->length, angle, tip);
}

static void differentiate(chain *self)
{
    for (int k = 0; k < LINKS; k++) {
        mct_hyperdual tip[2];
        tip_by_angle(self, k, tip);
        for (int axis = 0; axis < 2; axis++) {
            self->tip[axis] = tip[axis].value;
            self->J[axis][k] = tip[axis].e1;
        }
    }
}

static chain random_chain(void)
{
    chain p;
    for (int i = 0; i < LINKS; i++) {
        p.length[i] = some();
        p.angle[i] = any();
    }
    differentiate(&p);
    p.miss[0] = any();
    p.miss[1] = any();
    return p;
}

/* J'(d - f) */
static void pull(const chain *self, const double *miss, double *along)
{
    for (int k = 0; k < LINKS; k++) {
        along[k] = self->J[0][k] * miss[0] + self->J[1][k] * miss[1];
    }
}

/* x of (J'J + ridge) x = b, by elimination; positive definite, so no pivot is sought. */
static void solve_ridge(const chain *self, double ridge, const double *b, double *x)
{
    double A[LINKS][LINKS + 1];
    for (int i = 0; i < LINKS; i++) {
        for (int j = 0; j < LINKS; j++) {
            A[i][j] = self->J[0][i] * self->J[0][j] + self->J[1][i] * self->J[1][j] + (i == j) * ridge;
        }
        A[i][LINKS] = b[i];
    }
    for (int k = 0; k < LINKS; k++) {
        for (int i = 0; i < LINKS; i++) {
            const double factor = i == k ? 0 : A[i][k] / A[k][k];
            for (int j = k; j <= LINKS; j++) {
                A[i][j] -= factor * A[k][j];
            }
        }
    }
    for (int k = 0; k < LINKS; k++) {
        x[k] = A[k][LINKS] / A[k][k];
    }
}

static void test_eq_421_points_against_the_gradient(void)
{
    while (another_state()) {
        const chain p = random_chain();
        double truth[LINKS], printed[LINKS], corrected[LINKS];
        pull(&p, p.miss, printed);
        for (int k = 0; k < LINKS; k++) {
            mct_hyperdual tip[2], cost = mct_hyperdual_constant(0);
            tip_by_angle(&p, k, tip);
            for (int axis = 0; axis < 2; axis++) {
                const mct_hyperdual miss =
                    mct_hyperdual_sub(mct_hyperdual_constant(p.tip[axis] + p.miss[axis]), tip[axis]);
                cost = mct_hyperdual_add(cost, mct_hyperdual_scale(0.5, mct_hyperdual_mul(miss, miss)));
            }
            truth[k] = cost.e1;
            corrected[k] = -printed[k];
        }
        judge_all(LINKS, truth, printed, corrected);
    }
}

/* J'(J x - miss) + weight y: the gradient of 1/2 |miss - J x|^2 + weight/2 |y|^2 with dy/dx = 1. */
static void gradient(const chain *self, const double *step, double weight, const double *y, double *out)
{
    double left[2] = {-self->miss[0], -self->miss[1]};
    for (int k = 0; k < LINKS; k++) {
        left[0] += self->J[0][k] * step[k];
        left[1] += self->J[1][k] * step[k];
    }
    pull(self, left, out);
    for (int k = 0; k < LINKS; k++) {
        out[k] += weight * y[k];
    }
}

/*
 * A step minimises a cost where the gradient is 0. That of (429) does not minimise (428), but the cost with
 * (alpha/2) |x - u|^2. What does minimise (428) has twice alpha and pulls the angles to 0.
 */
static void test_eq_429_belongs_to_a_penalty_of_the_step_and_not_to_428(void)
{
    static const double none[LINKS] = {0};
    while (another_state()) {
        const chain p = random_chain();
        const double alpha = some();
        double b[LINKS], step[LINKS], other[LINKS], after[LINKS], other_after[LINKS];
        double printed[LINKS], corrected[LINKS], of_other[LINKS];
        pull(&p, p.miss, b);
        solve_ridge(&p, alpha, b, step);
        for (int k = 0; k < LINKS; k++) {
            b[k] -= 2 * alpha * p.angle[k];
        }
        solve_ridge(&p, 2 * alpha, b, other);
        for (int k = 0; k < LINKS; k++) {
            after[k] = p.angle[k] + step[k];
            other_after[k] = p.angle[k] + other[k];
        }
        gradient(&p, step, 2 * alpha, after, printed);
        gradient(&p, step, alpha, step, corrected);
        gradient(&p, other, 2 * alpha, other_after, of_other);
        judge_all(LINKS, none, printed, corrected);
        judge_all(LINKS, none, printed, of_other);
    }
}

static void test_eq_431_sums_the_angles_and_has_the_length(void)
{
    while (another_state()) {
        const chain p = random_chain();
        double printed[2] = {0, 0}, corrected[2] = {0, 0}, sum = 0;
        for (int i = 0; i < LINKS; i++) {
            sum += p.angle[i];
            printed[0] += cos((i + 1) * p.angle[i]);
            printed[1] += sin((i + 1) * p.angle[i]);
            corrected[0] += p.length[i] * cos(sum);
            corrected[1] += p.length[i] * sin(sum);
        }
        judge_all(2, p.tip, printed, corrected);
    }
}

static void test_eq_434_sums_the_angles_of_each_link_and_has_the_lengths(void)
{
    while (another_state()) {
        const chain p = random_chain();
        double printed[2][LINKS] = {{0}}, corrected[2][LINKS] = {{0}};
        for (int k = 0; k < LINKS; k++) {
            double sum = 0;
            for (int i = 0; i < LINKS; i++) {
                sum += p.angle[i];
                if (i >= k) {
                    printed[0][k] -= sin((k + 1) * p.angle[i]);
                    printed[1][k] += cos((k + 1) * p.angle[i]);
                    corrected[0][k] -= p.length[i] * sin(sum);
                    corrected[1][k] += p.length[i] * cos(sum);
                }
            }
        }
        judge_all(2 * LINKS, p.J[0], printed[0], corrected[0]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_eq_421_points_against_the_gradient);
    RUN_TEST(test_eq_429_belongs_to_a_penalty_of_the_step_and_not_to_428);
    RUN_TEST(test_eq_431_sums_the_angles_and_has_the_length);
    RUN_TEST(test_eq_434_sums_the_angles_of_each_link_and_has_the_lengths);
    return UNITY_END();
}

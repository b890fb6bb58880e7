/*
 * The kinematic chain (source, section 7): its geometry, its three methods, and where they converge.
 *
 * `test_methods_by_links_and_targets` prints the tables of docs/systems/chain.md.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "mctau/hyperdual.h"
#include "mctau/least_squares.h"
#include "mctau/matrix.h"
#include "support/random.h"
#include "systems/chain_kinematics.h"
#include "unity.h"

#define EPSILON ((double)MCT_REAL_EPSILON)
#define PI      3.14159265358979323846

enum { MOST = MCT_CHAIN_MAX_LINKS, METHODS = 3, CAP = 1000 };

static const char *const method_names[METHODS] = {"transpose", "inverse", "ridge"};

void setUp(void)
{
}

void tearDown(void)
{
}

/* A chain with random lengths, the target at (1, 0) times the reach. */
static mct_chain_constants chain_of(int n, mct_chain_method method, test_random *random)
{
    mct_chain_constants chain = {.links = n, .method = method, .largest_step = MCT_R(0.5)};
    double reach = 0;
    for (int i = 0; i < n; i++) {
        chain.length[i] = (mct_real)random_in(random, 0.5, 1.5);
        reach += (double)chain.length[i];
    }
    chain.target[0] = (mct_real)reach;
    mct_chain_complete(&chain);
    return chain;
}

static void aim_at(mct_chain_constants *chain, double distance, double direction)
{
    chain->target[0] = (mct_real)(distance * cos(direction));
    chain->target[1] = (mct_real)(distance * sin(direction));
    mct_chain_complete(chain);
}

static void bend_at_random(int n, test_random *random, mct_real *angles)
{
    for (int i = 0; i < n; i++) {
        angles[i] = (mct_real)random_in(random, -PI, PI);
    }
}

static double error_at(const mct_chain_constants *chain, const mct_real *angles)
{
    mct_chain_pose pose;
    mct_chain_place(chain, angles, &pose);
    return sqrt((double)mct_chain_error_squared(&pose));
}

static bool converged_at(const mct_chain_constants *chain, const mct_real *angles)
{
    mct_chain_pose pose;
    mct_chain_place(chain, angles, &pose);
    return mct_chain_converged(chain, &pose);
}

/* One update in place; returns the largest change of an angle. */
static double update(const mct_chain_constants *chain, mct_real *angles)
{
    mct_real step[MOST];
    double largest = 0;
    mct_chain_update(chain, angles, step);
    for (int k = 0; k < chain->links; k++) {
        TEST_ASSERT_TRUE(mct_finite(step[k]));
        angles[k] += step[k];
        largest = fmax(largest, fabs((double)step[k]));
    }
    return largest;
}

/* Updates until converged, CAP when not by then. */
static int updates_to_converge(const mct_chain_constants *chain, mct_real *angles)
{
    /* (1 + 4 roundings): the step is clamped, and the sum in `angles` is not looked at */
    const double bound = (double)chain->largest_step * (1 + 4 * EPSILON);
    for (int count = 0; count < CAP; count++) {
        if (converged_at(chain, angles)) {
            return count;
        }
        TEST_ASSERT_TRUE_MESSAGE(update(chain, angles) <= bound, "a step beyond the bound");
    }
    return CAP;
}

static void test_tip_and_jacobian_are_those_of_the_sums_at_random_poses(void)
{
    test_random random = {431};
    for (int trial = 0; trial < TEST_CASES(10000); trial++) {
        const int n = 1 + trial % MOST;
        const mct_chain_constants chain = chain_of(n, MCT_CHAIN_RIDGE, &random);
        /* 4 roundings a link: of the angle's sine, of the turn and of the sum, each of at most the reach */
        const double tolerance = 4 * n * EPSILON * (double)chain.reach;
        mct_real angles[MOST];
        mct_chain_pose pose;
        mct_real jacobian[2][MOST];
        bend_at_random(n, &random, angles);
        mct_chain_place(&chain, angles, &pose);
        mct_chain_jacobian(&chain, &pose, jacobian);
        for (int k = 0; k < n; k++) { /* (431) in hyper-dual numbers, joint k seeded; turns by the product */
            mct_hyperdual sine = mct_hyperdual_constant(0);
            mct_hyperdual cosine = mct_hyperdual_constant(1);
            mct_hyperdual tip[2] = {{0, 0, 0, 0}, {0, 0, 0, 0}};
            for (int i = 0; i < n; i++) {
                const mct_hyperdual angle = {angles[i], i == k, 0, 0};
                mct_hyperdual s, c;
                mct_hyperdual_sincos(angle, &s, &c);
                const mct_hyperdual turned =
                    mct_hyperdual_add(mct_hyperdual_mul(sine, c), mct_hyperdual_mul(cosine, s));
                cosine = mct_hyperdual_sub(mct_hyperdual_mul(cosine, c), mct_hyperdual_mul(sine, s));
                sine = turned;
                tip[0] = mct_hyperdual_add(tip[0], mct_hyperdual_scale(chain.length[i], cosine));
                tip[1] = mct_hyperdual_add(tip[1], mct_hyperdual_scale(chain.length[i], sine));
            }
            for (int axis = 0; axis < 2; axis++) {
                TEST_ASSERT_DOUBLE_WITHIN(tolerance, (double)tip[axis].value, (double)pose.arm[0][axis]);
                TEST_ASSERT_DOUBLE_WITHIN(tolerance, (double)tip[axis].e1, (double)jacobian[axis][k]);
            }
        }
        double sum = 0;
        double x = 0;
        double y = 0;
        for (int i = 0; i < n; i++) { /* (431) as corrected, by libm */
            sum += (double)angles[i];
            x += (double)chain.length[i] * cos(sum);
            y += (double)chain.length[i] * sin(sum);
        }
        TEST_ASSERT_DOUBLE_WITHIN(tolerance, x, (double)pose.arm[0][0]);
        TEST_ASSERT_DOUBLE_WITHIN(tolerance, y, (double)pose.arm[0][1]);
    }
}

static void test_a_chain_that_has_wound_itself_up_loses_no_digits(void)
{
    test_random random = {16};
    const mct_chain_constants chain = chain_of(MOST, MCT_CHAIN_RIDGE, &random);
    mct_real angles[MOST];
    long double sum = 0;
    long double x = 0;
    for (int i = 0; i < MOST; i++) {
        angles[i] = MCT_R(6.2);
        sum += (long double)angles[i];
        x += (long double)chain.length[i] * cosl(sum);
    }
    mct_chain_pose pose;
    mct_chain_place(&chain, angles, &pose);
    /* a rounding a link, some of which cancel; sums of up to 100 rad would be off by 100 */
    TEST_ASSERT_DOUBLE_WITHIN(6 * EPSILON * (double)chain.reach, (double)x, (double)pose.arm[0][0]);
}

static void test_the_aim_is_the_point_within_reach_nearest_to_the_target(void)
{
    test_random random = {17};
    for (int trial = 0; trial < TEST_CASES(2000); trial++) {
        const int n = 1 + trial % 4;
        mct_chain_constants chain = chain_of(n, MCT_CHAIN_RIDGE, &random);
        if (trial % 3 == 0) {
            chain.length[n / 2] *= 4; /* a hole */
        }
        aim_at(&chain, random_in(&random, 0, 12), random_in(&random, -PI, PI));
        double longest = 0;
        for (int i = 0; i < n; i++) {
            longest = fmax(longest, (double)chain.length[i]);
        }
        const double hole = fmax(0, 2 * longest - (double)chain.reach);
        const double dx = (double)(chain.target[0] - chain.aim[0]);
        const double dy = (double)(chain.target[1] - chain.aim[1]);
        const double away = hypot((double)chain.aim[0], (double)chain.aim[1]);
        const double slack = 8 * EPSILON * (double)chain.reach;
        TEST_ASSERT_TRUE(away <= (double)chain.reach + slack && away >= hole - slack);
        for (int pose = 0; pose < 50; pose++) {
            mct_real angles[MOST];
            mct_chain_pose at;
            bend_at_random(n, &random, angles);
            mct_chain_place(&chain, angles, &at);
            const double other =
                hypot((double)(chain.target[0] - at.arm[0][0]), (double)(chain.target[1] - at.arm[0][1]));
            TEST_ASSERT_TRUE(hypot(dx, dy) <= other + slack);
        }
    }
}

static void test_ridge_minimises_the_damped_functional(void)
{
    /* 1/2 |e - J dq|^2 + alpha/2 |dq|^2: rows [J; sqrt(alpha) 1], right side [e; 0] */
    test_random random = {427};
    for (int trial = 0; trial < TEST_CASES(2000); trial++) {
        const int n = 1 + trial % MCT_LEAST_SQUARES_MAX_COLUMNS;
        mct_chain_constants chain = chain_of(n, MCT_CHAIN_RIDGE, &random);
        chain.largest_step = MCT_R(1e9);
        chain.ridge = (mct_real)random_scale(&random, 1e-2, 10);
        aim_at(&chain, random_in(&random, 0, (double)chain.reach), random_in(&random, -PI, PI));
        mct_real angles[MOST];
        mct_chain_pose pose;
        mct_real jacobian[2][MOST];
        mct_real step[MOST];
        bend_at_random(n, &random, angles);
        mct_chain_place(&chain, angles, &pose);
        mct_chain_jacobian(&chain, &pose, jacobian);
        mct_chain_step(&chain, &pose, step);
        mct_real design[(2 + 8) * 8] = {0};
        mct_real weight[2 + 8];
        mct_real observed[2 + 8] = {pose.error[0], pose.error[1]};
        mct_real expected[8];
        for (int i = 0; i < n; i++) {
            design[i] = jacobian[0][i];
            design[n + i] = jacobian[1][i];
            design[(2 + i) * n + i] = mct_sqrt_real(chain.ridge);
        }
        for (int i = 0; i < 2 + n; i++) {
            weight[i] = 1;
        }
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_least_squares(2 + n, n, design, weight, observed, NULL, expected));
        /* 50 roundings of |e| / sqrt(alpha) by the condition of the design, at most reach sqrt(n / alpha) */
        const double condition = (double)chain.reach * sqrt(n / (double)chain.ridge);
        const double scale = error_at(&chain, angles) / sqrt((double)chain.ridge);
        for (int k = 0; k < n; k++) {
            TEST_ASSERT_DOUBLE_WITHIN(50 * EPSILON * fmax(1, condition) * scale, (double)expected[k],
                                      (double)step[k]);
        }
    }
}

/* J'J + diagonal, of a pose, in double. */
static void normal_matrix(const mct_chain_constants *chain, const mct_chain_pose *pose, double diagonal,
                          double *matrix, double *right)
{
    const int n = chain->links;
    mct_real jacobian[2][MOST];
    mct_chain_jacobian(chain, pose, jacobian);
    for (int i = 0; i < n; i++) {
        right[i] = 0;
        for (int axis = 0; axis < 2; axis++) {
            right[i] += (double)jacobian[axis][i] * (double)pose->error[axis];
        }
        for (int j = 0; j < n; j++) {
            matrix[i * n + j] = i == j ? diagonal : 0;
            for (int axis = 0; axis < 2; axis++) {
                matrix[i * n + j] += (double)jacobian[axis][i] * (double)jacobian[axis][j];
            }
        }
    }
}

static void test_the_inverse_as_printed_is_singular_from_three_links_on_and_ridge_is_not(void)
{
    test_random random = {426};
    double matrix[MCT_MATRIX_MAX * MCT_MATRIX_MAX];
    double right[MCT_MATRIX_MAX];
    for (int n = 2; n <= MCT_MATRIX_MAX; n++) {
        mct_chain_constants chain = chain_of(n, MCT_CHAIN_INVERSE, &random);
        chain.largest_step = MCT_R(1e9);
        aim_at(&chain, 0.5 * (double)chain.reach, 1);
        mct_real angles[MOST];
        mct_real step[MOST];
        mct_chain_pose pose;
        for (int i = 0; i < n; i++) {
            angles[i] = MCT_R(0.3);
        }
        mct_chain_place(&chain, angles, &pose);
        normal_matrix(&chain, &pose, 0, matrix, right);
        const mct_status status = mct_matrix_solve(n, 1, matrix, right);
        TEST_ASSERT_EQUAL_INT(n == 2 ? MCT_OK : MCT_ERROR_SINGULAR, status);
        /* the pseudo-inverse: J dq = e, and dq = J' w for some w, so no part of it is idle */
        mct_real jacobian[2][MOST];
        mct_chain_jacobian(&chain, &pose, jacobian);
        mct_chain_step(&chain, &pose, step);
        mct_real design[2 * MOST];
        mct_real weight[MOST];
        mct_real idle[MOST];
        mct_real w[2];
        double size = 0;
        for (int k = 0; k < n; k++) {
            design[2 * k] = jacobian[0][k];
            design[2 * k + 1] = jacobian[1][k];
            weight[k] = 1;
            idle[k] = step[k];
            size = fmax(size, fabs((double)step[k]));
        }
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_least_squares(n, 2, design, weight, idle, NULL, w));
        for (int axis = 0; axis < 2; axis++) {
            double moved = 0;
            for (int k = 0; k < n; k++) {
                moved += (double)jacobian[axis][k] * (double)step[k];
                TEST_ASSERT_DOUBLE_WITHIN(20 * EPSILON * size, 0, (double)idle[k]);
            }
            /* a sum of n terms */
            TEST_ASSERT_DOUBLE_WITHIN(8 * n * EPSILON * size * (double)chain.reach, (double)pose.error[axis],
                                      moved);
        }
        /* (430) as printed, n x n, is what the ridge gives in O(n) */
        chain.method = MCT_CHAIN_RIDGE;
        chain.ridge = MCT_R(0.5);
        mct_chain_step(&chain, &pose, step);
        normal_matrix(&chain, &pose, 0.5, matrix, right);
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_matrix_solve(n, 1, matrix, right));
        for (int k = 0; k < n; k++) {
            /* condition: reach^2 n / alpha */
            const double condition = (double)chain.reach * (double)chain.reach * n / 0.5;
            TEST_ASSERT_DOUBLE_WITHIN(2 * EPSILON * condition, right[k], (double)step[k]);
        }
        TEST_ASSERT_TRUE(updates_to_converge(&chain, angles) < 100);
    }
}

static void test_the_penalty_as_printed_pulls_the_angles_to_zero_and_misses_the_target(void)
{
    /* (427): its Gauss-Newton step is (J'J + 2 alpha)^-1 (J'e - 2 alpha q) */
    test_random random = {428};
    mct_chain_constants chain = chain_of(3, MCT_CHAIN_RIDGE, &random);
    aim_at(&chain, 0.5 * (double)chain.reach, 1);
    mct_real angles[MOST] = {MCT_R(0.3), MCT_R(0.5), MCT_R(-0.2)};
    chain.ridge = MCT_R(0.5);
    double step[3];
    for (int count = 0; count < CAP; count++) {
        double matrix[3 * 3];
        mct_chain_pose pose;
        mct_chain_place(&chain, angles, &pose);
        normal_matrix(&chain, &pose, 1.0, matrix, step);
        for (int k = 0; k < 3; k++) {
            step[k] -= (double)angles[k];
        }
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_matrix_solve(3, 1, matrix, step));
        for (int k = 0; k < 3; k++) {
            angles[k] += (mct_real)(0.5 * step[k]); /* half of it: settles */
        }
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0, step[0]); /* at rest, to float's rounding */
    TEST_ASSERT_TRUE(error_at(&chain, angles) > 0.02 * (double)chain.reach);
    TEST_ASSERT_TRUE(updates_to_converge(&chain, angles) < 100);
}

static void test_transpose_diverges_for_a_gain_above_two_over_the_square_of_the_jacobian(void)
{
    test_random random = {422};
    for (int trial = 0; trial < TEST_CASES(200); trial++) {
        const int n = 1 + trial % MOST;
        mct_chain_constants chain = chain_of(n, MCT_CHAIN_TRANSPOSE, &random);
        mct_real goal[MOST];
        mct_chain_pose pose;
        bend_at_random(n, &random, goal);
        mct_chain_place(&chain, goal, &pose);
        chain.aim[0] = pose.arm[0][0];
        chain.aim[1] = pose.arm[0][1];
        double xx = 0;
        double xy = 0;
        double yy = 0;
        for (int k = 0; k < n; k++) {
            const double x = (double)pose.arm[k][0];
            const double y = (double)pose.arm[k][1];
            xx += x * x;
            xy += x * y;
            yy += y * y;
        }
        /* |J|^2, the larger eigenvalue of J J', and its vector in the plane, brought back to the joints */
        const double square = 0.5 * (xx + yy) + sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
        const double lean = 0.5 * atan2(2 * xy, xx - yy);
        TEST_ASSERT_TRUE((double)mct_chain_largest_gain(&chain) <= 2 / square * (1 + 8 * EPSILON));
        for (int high = 0; high < 2; high++) {
            const double off = 1e-3; /* [rad]: squares of it are 1e-3 of it */
            mct_real angles[MOST];
            for (int k = 0; k < n; k++) {
                const double arm = (double)pose.arm[k][0] * cos(lean) + (double)pose.arm[k][1] * sin(lean);
                angles[k] = goal[k] + (mct_real)(off * arm / sqrt(square));
            }
            const double before = error_at(&chain, angles);
            chain.gain = (mct_real)((high ? 2.1 : 1.9) / square);
            for (int count = 0; count < 10; count++) {
                update(&chain, angles);
            }
            /* factors -0.9 and -1.1 an update: 0.35 and 2.6 after ten */
            const double ratio = error_at(&chain, angles) / before;
            TEST_ASSERT_TRUE(high ? ratio > 1.8 : ratio < 0.6);
        }
    }
}

static void test_a_third_of_the_largest_gain_never_takes_the_tip_farther_away(void)
{
    /* the gradient turns by at most |J|^2 + |e| |d2f|, three times |J|^2 of the stretched pose */
    test_random random = {423};
    for (int trial = 0; trial < TEST_CASES(200); trial++) {
        const int n = 2 + trial % 4;
        mct_chain_constants chain = chain_of(n, MCT_CHAIN_TRANSPOSE, &random);
        aim_at(&chain, random_in(&random, 0, 1) * (double)chain.reach, random_in(&random, -PI, PI));
        chain.gain = MCT_R(0.3) * mct_chain_largest_gain(&chain);
        mct_real angles[MOST];
        bend_at_random(n, &random, angles);
        double before = error_at(&chain, angles);
        for (int count = 0; count < 200; count++) {
            update(&chain, angles);
            const double after = error_at(&chain, angles);
            TEST_ASSERT_TRUE(after <= before + 8 * EPSILON * (double)chain.reach);
            before = after;
        }
    }
}

static void test_the_step_of_ridge_is_bounded_and_that_of_inverse_is_not(void)
{
    test_random random = {30};
    double longest_inverse = 0;
    for (int trial = 0; trial < TEST_CASES(5000); trial++) {
        const int n = 1 + trial % MOST;
        mct_chain_constants chain = chain_of(n, MCT_CHAIN_RIDGE, &random);
        chain.largest_step = MCT_R(1e9);
        aim_at(&chain, random_in(&random, 0, (double)chain.reach), 0);
        mct_real angles[MOST] = {0};
        for (int k = 0; k < n; k++) { /* near stretched, by any order of magnitude */
            angles[k] = (mct_real)random_scale(&random, 1e-5, 3);
        }
        mct_real step[MOST];
        mct_chain_update(&chain, angles, step);
        double square = 0;
        for (int k = 0; k < n; k++) {
            square += (double)step[k] * (double)step[k];
        }
        /* sigma / (sigma^2 + |e|^2 / 2) is at most sqrt(1/2) / |e| */
        TEST_ASSERT_TRUE(square <= 0.5 * (1 + 20 * EPSILON));
        chain.method = MCT_CHAIN_INVERSE;
        mct_chain_update(&chain, angles, step);
        longest_inverse = fmax(longest_inverse, fabs((double)step[0]));
    }
    TEST_ASSERT_TRUE(longest_inverse > 100);
}

/* Where a target lies, and how the chain stands at the start. */
typedef enum {
    REACHABLE,
    NEAR_EDGE,
    BOUNDARY,
    OUT_OF_REACH,
    AT_BASE,
    STRETCHED,
    FOLDED,
    IN_HOLE,
    KINDS
} kind_t;

static const char *const kind_names[KINDS] = {"inside",       "99.9 % of the reach",  "at the reach",
                                              "out of reach", "at the base",          "from stretched",
                                              "from folded",  "too near: in the hole"};

static void set_up(kind_t kind, int n, mct_chain_method method, unsigned trial, mct_chain_constants *chain,
                   mct_real *angles)
{
    test_random random = {1 + (uint64_t)n * 1000003u + trial * 7919u + (uint64_t)kind * 104729u};
    for (int i = 0; i < 10; i++) {
        random_bits(&random);
    }
    *chain = chain_of(n, method, &random);
    if (kind == IN_HOLE) {
        chain->length[n / 2] = (mct_real)(1.5 * n);
        mct_chain_complete(chain);
    }
    const double reach = (double)chain->reach;
    const double inner = (double)chain->inner;
    const double share = random_in(&random, 0.1, 0.9);
    const double direction = random_in(&random, -PI, PI);
    const double distance[KINDS] = {[REACHABLE] = inner + share * (reach - inner),
                                    [NEAR_EDGE] = 0.999 * reach,
                                    [BOUNDARY] = reach,
                                    [OUT_OF_REACH] = reach * (1 + 2 * share),
                                    [AT_BASE] = 0,
                                    [STRETCHED] = inner + share * (reach - inner),
                                    [FOLDED] = inner + share * (reach - inner),
                                    [IN_HOLE] = inner * share};
    aim_at(chain, distance[kind], direction);
    for (int i = 0; i < n; i++) {
        const double random_angle = random_in(&random, -PI, PI);
        const double fold = random_angle < 0 ? PI : 0;
        angles[i] = (mct_real)(kind == STRETCHED ? 0 : kind == FOLDED ? fold : random_angle);
    }
    if (kind == STRETCHED || kind == FOLDED) {
        angles[0] = (mct_real)(direction + (trial % 2 ? PI : 0));
    }
}

/* Of the trials of one cell of the table. */
typedef struct {
    int median; /* updates */
    int most;   /* of those that converged */
    int failed; /* within CAP updates */
} tally;

static tally tally_of(kind_t kind, int n, mct_chain_method method)
{
    enum { TRIALS = 60 };
    int histogram[CAP + 1] = {0};
    for (unsigned trial = 0; trial < TRIALS; trial++) {
        mct_chain_constants chain;
        mct_real angles[MOST];
        set_up(kind, n, method, trial, &chain, angles);
        histogram[updates_to_converge(&chain, angles)]++;
    }
    tally found = {.median = CAP, .failed = histogram[CAP]};
    int counted = 0;
    for (int count = 0; count < CAP; count++) {
        counted += histogram[count];
        found.most = histogram[count] > 0 ? count : found.most;
        found.median = found.median == CAP && 2 * counted >= TRIALS ? count : found.median;
    }
    return found;
}

static bool is_shown(int n)
{
    return n <= 3 || n == 5 || n == 8 || n == MOST;
}

static void test_methods_by_links_and_targets(void)
{
    for (int method = 0; method < METHODS; method++) {
        char line[160];
        snprintf(line, sizeof line, "%s, 1 2 3 5 8 16 links: updates median/most (+: of 60 not within 1000)",
                 method_names[method]);
        TEST_MESSAGE(line);
        for (int kind = 0; kind < KINDS; kind++) {
            size_t used = (size_t)snprintf(line, sizeof line, "| %s |", kind_names[kind]);
            for (int n = 1; n <= MOST; n++) {
                const tally found = tally_of((kind_t)kind, n, (mct_chain_method)method);
                const bool sure = method == MCT_CHAIN_RIDGE || n == 1 ||
                                  (method == MCT_CHAIN_INVERSE && n > 2 && kind == REACHABLE);
                if (sure) {
                    TEST_ASSERT_EQUAL_INT_MESSAGE(0, found.failed, kind_names[kind]);
                    TEST_ASSERT_TRUE_MESSAGE(found.most <= 400,
                                             kind_names[kind]); /* 1.5 times the most seen */
                }
                if (is_shown(n)) {
                    char cell[48] = " - |";
                    if (found.median < CAP) {
                        snprintf(cell, sizeof cell, " %d/%d +%d |", found.median, found.most, found.failed);
                    }
                    used += (size_t)snprintf(line + used, sizeof line - used, "%s", cell);
                }
            }
            TEST_MESSAGE(line);
        }
    }
}

static void test_the_error_of_ridge_dies_out_even_where_the_jacobian_is_singular(void)
{
    for (int n = 1; n <= MOST; n++) {
        for (unsigned trial = 0; trial < 10; trial++) {
            mct_chain_constants chain;
            mct_real angles[MOST];
            set_up(BOUNDARY, n, MCT_CHAIN_RIDGE, trial, &chain, angles);
            for (int count = 0; count < 400; count++) {
                update(&chain, angles);
            }
            /* an update stops at 1 of these; an angle of 4 rad is rounded by 2, the tip by 1 a link */
            TEST_ASSERT_TRUE(error_at(&chain, angles) <= (3 + n) * EPSILON * (double)chain.reach);
        }
    }
}

static void test_ridge_leaves_every_pose_in_line_with_its_target(void)
{
    test_random random = {31};
    for (int n = 1; n <= 8; n++) {
        for (unsigned folds = 0; folds < 1u << n; folds++) {
            for (int equal = 0; equal < 2; equal++) {
                mct_chain_constants chain = chain_of(n, MCT_CHAIN_RIDGE, &random);
                for (int i = 0; equal && i < n; i++) {
                    chain.length[i] = 1;
                }
                mct_chain_complete(&chain);
                const double inner = (double)chain.inner;
                aim_at(&chain, inner + random_in(&random, 0.1, 0.9) * ((double)chain.reach - inner), 0);
                mct_real angles[MOST];
                mct_real step[MOST];
                for (int i = 0; i < n; i++) {
                    angles[i] = (folds >> i) & 1u ? (mct_real)PI : 0;
                }
                mct_chain_update(&chain, angles, step);
                if (converged_at(&chain, angles)) {
                    continue;
                }
                if (folds == 0) { /* exact; folded by pi, rounding leaves a gradient for a long chain */
                    for (int k = 0; k < n; k++) {
                        TEST_ASSERT_TRUE(step[k] == MCT_CHAIN_BEND);
                    }
                }
                TEST_ASSERT_TRUE(updates_to_converge(&chain, angles) < 100);
            }
        }
    }
}

static void test_a_chain_at_its_goal_rests(void)
{
    for (int method = 0; method < METHODS; method++) {
        /* stretched, so without a gradient, to the goal; to the best there is; to almost the goal */
        static const double distance[] = {3.5, 9, 3.5 * (1 - 5e-7)};
        for (int i = 0; i < 3; i++) {
            mct_chain_constants chain = {.links = 3,
                                         .method = (mct_chain_method)method,
                                         .length = {1, 2, MCT_R(0.5)},
                                         .largest_step = MCT_R(0.5)};
            aim_at(&chain, distance[i], 0);
            mct_real angles[MOST] = {0};
            TEST_ASSERT_TRUE(update(&chain, angles) == 0);
        }
    }
}

static void test_aiming_at_a_target_out_of_reach_itself_would_not_settle(void)
{
    test_random random = {32};
    mct_chain_constants chain = chain_of(3, MCT_CHAIN_RIDGE, &random);
    const double reach = (double)chain.reach;
    aim_at(&chain, 1.05 * reach, 1);
    mct_real angles[MOST] = {MCT_R(0.3), MCT_R(0.5), MCT_R(-0.2)};
    mct_real same[MOST];
    memcpy(same, angles, sizeof same);
    TEST_ASSERT_TRUE(updates_to_converge(&chain, angles) < 50);
    chain.aim[0] = chain.target[0];
    chain.aim[1] = chain.target[1];
    double least = HUGE_VAL;
    for (int count = 0; count < CAP; count++) {
        update(&chain, same);
        least = count < CAP / 2 ? HUGE_VAL : fmin(least, error_at(&chain, same));
    }
    TEST_ASSERT_TRUE(least > 0.0501 * reach); /* 0.05 reach is the nearest */
}

static void test_two_links_end_at_one_of_the_two_poses_of_the_triangle(void)
{
    test_random random = {2};
    for (int trial = 0; trial < TEST_CASES(1000); trial++) {
        mct_chain_constants chain = chain_of(2, MCT_CHAIN_RIDGE, &random);
        const double a = (double)chain.length[0];
        const double b = (double)chain.length[1];
        const double distance = fabs(a - b) + random_in(&random, 0.1, 0.9) * (a + b - fabs(a - b));
        const double direction = random_in(&random, -PI, PI);
        mct_real angles[MOST];
        aim_at(&chain, distance, direction);
        bend_at_random(2, &random, angles);
        TEST_ASSERT_TRUE(updates_to_converge(&chain, angles) < 50);
        const double elbow = acos((distance * distance - a * a - b * b) / (2 * a * b));
        const double found = remainder((double)angles[1], 2 * PI);
        const double second = found < 0 ? -elbow : elbow;
        const double first = direction - atan2(b * sin(second), a + b * cos(second));
        /* 1e-6 of the reach, over the least that a turn moves the tip: a condition below 100 here */
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, second, found);
        TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0, remainder((double)angles[0] - first, 2 * PI));
    }
}

/* Largest distance of the tip's way from the straight line, as a part of its length. */
static double bow_of_way(double largest_step)
{
    mct_chain_constants chain = {
        .links = 3, .method = MCT_CHAIN_INVERSE, .length = {1, 1, 1}, .largest_step = (mct_real)largest_step};
    aim_at(&chain, 1.5, 2);
    mct_real angles[MOST] = {MCT_R(0.3), MCT_R(0.5), MCT_R(0.4)};
    mct_chain_pose pose;
    mct_chain_place(&chain, angles, &pose);
    const double x = (double)pose.error[0];
    const double y = (double)pose.error[1];
    double bow = 0;
    for (int count = 0; count < 20000 && !converged_at(&chain, angles); count++) {
        update(&chain, angles);
        mct_chain_place(&chain, angles, &pose);
        bow = fmax(bow, fabs((double)pose.error[0] * y - (double)pose.error[1] * x) / (x * x + y * y));
    }
    TEST_ASSERT_TRUE(converged_at(&chain, angles));
    return bow;
}

static void test_inverse_goes_straight_only_by_small_steps(void)
{
    TEST_ASSERT_TRUE(bow_of_way(1) > 0.05);
    /* each step is off by its square, and there are 1/step of them */
    TEST_ASSERT_DOUBLE_WITHIN(2, 10, bow_of_way(0.01) / bow_of_way(0.001));
    TEST_ASSERT_TRUE(bow_of_way(0.001) < 1e-3);
}

static void test_units_of_length_do_not_matter(void)
{
    test_random random = {5};
    for (int method = 0; method < METHODS; method++) {
        for (int trial = 0; trial < TEST_CASES(200); trial++) {
            const int n = 1 + trial % MOST;
            mct_chain_constants chain = chain_of(n, (mct_chain_method)method, &random);
            aim_at(&chain, random_in(&random, 0.5, 1.5) * (double)chain.reach, 1);
            mct_chain_constants other = chain;
            for (int i = 0; i < n; i++) {
                other.length[i] *= MCT_R(0.0009765625);
            }
            other.target[0] *= MCT_R(0.0009765625);
            other.target[1] *= MCT_R(0.0009765625);
            mct_chain_complete(&other);
            mct_real angles[MOST];
            mct_real step[MOST];
            mct_real same[MOST];
            bend_at_random(n, &random, angles);
            mct_chain_update(&chain, angles, step);
            mct_chain_update(&other, angles, same);
            for (int k = 0; k < n; k++) { /* a power of two: the bits */
                TEST_ASSERT_TRUE(step[k] == same[k]);
            }
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_tip_and_jacobian_are_those_of_the_sums_at_random_poses);
    RUN_TEST(test_a_chain_that_has_wound_itself_up_loses_no_digits);
    RUN_TEST(test_the_aim_is_the_point_within_reach_nearest_to_the_target);
    RUN_TEST(test_ridge_minimises_the_damped_functional);
    RUN_TEST(test_the_inverse_as_printed_is_singular_from_three_links_on_and_ridge_is_not);
    RUN_TEST(test_the_penalty_as_printed_pulls_the_angles_to_zero_and_misses_the_target);
    RUN_TEST(test_transpose_diverges_for_a_gain_above_two_over_the_square_of_the_jacobian);
    RUN_TEST(test_a_third_of_the_largest_gain_never_takes_the_tip_farther_away);
    RUN_TEST(test_the_step_of_ridge_is_bounded_and_that_of_inverse_is_not);
    RUN_TEST(test_methods_by_links_and_targets);
    RUN_TEST(test_the_error_of_ridge_dies_out_even_where_the_jacobian_is_singular);
    RUN_TEST(test_ridge_leaves_every_pose_in_line_with_its_target);
    RUN_TEST(test_a_chain_at_its_goal_rests);
    RUN_TEST(test_aiming_at_a_target_out_of_reach_itself_would_not_settle);
    RUN_TEST(test_two_links_end_at_one_of_the_two_poses_of_the_triangle);
    RUN_TEST(test_inverse_goes_straight_only_by_small_steps);
    RUN_TEST(test_units_of_length_do_not_matter);
    return UNITY_END();
}

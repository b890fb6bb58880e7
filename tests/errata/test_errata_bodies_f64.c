/* Sections 5 and 6 of the source, bodies, against the Gauss engine. docs/errata.md lists the equations. */
#include "errata/rotation.h"

static vector angular_velocity(const body *p)
{
    return spin_of(p->u, p->udot, p->uddot).omega;
}

static double kinetic_energy(const body *p)
{
    double sum = 0;
    for (int i = 0; i < p->count; i++) {
        sum += p->m[i] / 2 * dot(p->v[i], p->v[i]);
    }
    return sum;
}

/* ---- 5: on a pivot ---- */

static void test_eq_310_has_the_masses_and_a_minus(void)
{
    while (another_state()) {
        const body p = random_body(false, false);
        matrix printed = {{{0}}};
        for (int i = 0; i < p.count; i++) {
            printed = plus(printed, 1, R2(p.b[i]));
        }
        const vector w = times(transpose(p.r), angular_velocity(&p));
        judge_number(kinetic_energy(&p), dot(w, times(printed, w)) / 2,
                     dot(w, times(inertia(&p, p.b, zero), w)) / 2);
    }
}

static void test_eq_312_has_the_turned_matrix(void)
{
    while (another_state()) {
        const body p = random_body(false, false);
        const matrix fixed = inertia(&p, p.b, zero);
        const vector w = angular_velocity(&p);
        judge(moment(&p, true, p.x, zero, p.v), times(fixed, w),
              times(product(p.r, product(fixed, transpose(p.r))), w));
    }
}

/* The parallel axis theorem (321) with the centre (325), by a mass of either sign. */
static void test_eq_324_the_total_mass_is_positive(void)
{
    while (another_state()) {
        const body p = random_body(false, false);
        matrix sum[2];
        for (int corrected = 0; corrected < 2; corrected++) {
            const double mass = corrected ? mass_of(&p) : -mass_of(&p);
            const vector centre = scale(1 / mass, first_moment(&p, p.b));
            sum[corrected] = plus(inertia(&p, p.b, centre), -mass, R2(centre));
        }
        judge_matrix(inertia(&p, p.b, zero), sum[0], sum[1]);
    }
}

/* Eighths of a box at +- half / sqrt 3 have its second moments: two nodes of Gauss are exact for squares. */
static void test_eq_328_has_a_sum_of_squares_about_the_third_axis(void)
{
    while (another_state()) {
        const double m = some(), x = some() + 1, y = some() + 1;
        double truth = 0;
        for (int i = 0; i < 8; i++) {
            const double at_x = (i & 1 ? x : -x) / (2 * sqrt(3)), at_y = (i & 2 ? y : -y) / (2 * sqrt(3));
            truth += m / 8 * (at_x * at_x + at_y * at_y);
        }
        judge_number(truth, m / 12 * x * x * y * y, m / 12 * (x * x + y * y));
    }
}

static void test_eq_331_the_square_of_0_49_is_0_2401(void)
{
    const matrix minus = R2(vec(0.49, 0, 0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, -0.2401, minus.a[1][1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, -0.2401, minus.a[2][2]);
    TEST_ASSERT_TRUE(fabs(minus.a[2][2] + 0.241) > 8e-4);
}

/* ---- 5.5.1: a point on a ball joint, b = d (sin alpha, cos alpha, 0), turning about axis 2 ---- */

typedef struct {
    double m, d, alpha, rate;
    vector b;
    matrix shape; /* [[cos^2, -sin cos, 0], [-sin cos, sin^2, 0], [0, 0, 1]] */
} point;

static point random_point(void)
{
    point p = {.m = some() + 1, .d = some() + 1, .alpha = random_in(&errata.random, 0.3, 1.2), .rate = any()};
    const double s = sin(p.alpha), c = cos(p.alpha);
    p.b = vec(p.d * s, p.d * c, 0);
    p.shape = (matrix){{{c * c, -s * c, 0}, {-s * c, s * s, 0}, {0, 0, 1}}};
    return p;
}

static void test_eq_341_has_minus_the_mass(void)
{
    while (another_state()) {
        const point p = random_point();
        judge_matrix(scaled(p.m * p.d * p.d, p.shape), R2(p.b), scaled(-p.m, R2(p.b)));
    }
}

/*
 * Left to itself the point runs on a great circle, xdd = - |xd|^2 x / d^2. With the pseudo-inverse in the
 * place of the inverse, which does not exist, (348) has the other sign. At the start r = 1.
 */
static void test_eq_348_inverts_a_singular_matrix_and_has_the_other_sign(void)
{
    while (another_state()) {
        const point p = random_point();
        const vector omega = vec(0, p.rate, 0);
        const vector velocity = cross(omega, p.b);
        const vector truth = scale(-dot(velocity, velocity) / (p.d * p.d), p.b);
        TEST_ASSERT_TRUE(fabs(determinant(p.shape)) <= TOLERANCE);
        const vector pseudo_inverse = vec(0, 0, p.rate * p.rate * sin(p.alpha) * cos(p.alpha));
        const vector steady = cross(omega, velocity);
        judge(truth, add(cross(pseudo_inverse, p.b), steady),
              add(cross(scale(-1, pseudo_inverse), p.b), steady));
    }
}

/* The engine says the same of the matrix: a single point cannot be asked for three angles. */
static void test_eq_348_is_refused_by_the_engine(void)
{
    static mct_gauss_workspace workspace;
    static mct_gauss_motion motion;
    const body p = {.count = 1, .m = {2}, .b = {{{1, 1, 0}}}};
    const double u[3] = {0.3, 0.8, -0.2}, rate[3] = {0, 1, 1};
    const mct_gauss_system system = {1, 3, p.m, place_body, &p};
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_kinematics(&system, 0, u, rate, &workspace, &motion));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, mct_gauss_dynamics(&system, NULL, NULL, &workspace, &motion));
}

/* Euler's equation in body axes, the moments being those of (350). */
static vector two_points_rate(double alpha, vector w)
{
    const double I[3] = {pow(cos(alpha), 2), pow(sin(alpha), 2), 1};
    return vec((I[1] - I[2]) * w.a[1] * w.a[2] / I[0], (I[2] - I[0]) * w.a[2] * w.a[0] / I[1],
               (I[0] - I[1]) * w.a[0] * w.a[1] / I[2]);
}

/*
 * The axis is principal, so the rotation is steady. Nudged by 1e-6, the rest of the angular velocity stays
 * small where the moment about axis 2, sin^2, is the least of cos^2, sin^2, 1, and grows where it is the one
 * between.
 */
static void test_text_350_the_steady_rotation_is_unstable_above_45_degrees(void)
{
    for (int above = 0; above < 2; above++) {
        const double alpha = PI / 4 + (above ? 0.2 : -0.2), h = 1e-2;
        vector w = vec(1e-6, 1, 1e-6);
        double wobble = 0;
        for (int n = 0; n < 4000; n++) {
            const vector a = two_points_rate(alpha, w), b = two_points_rate(alpha, add(w, scale(h / 2, a)));
            const vector c = two_points_rate(alpha, add(w, scale(h / 2, b)));
            const vector d = two_points_rate(alpha, add(w, scale(h, c)));
            w = add(w, scale(h / 6, add(add(a, d), scale(2, add(b, c)))));
            wobble = fmax(wobble, hypot(w.a[0], w.a[2]));
        }
        TEST_ASSERT_TRUE(above ? wobble > 0.1 : wobble < 1e-5);
    }
}

/* ---- 5.6.1: b = d (1, 1, 0) ---- */

/* Inertia grows with the square of a length: so does (370), and not - m R^2[b] with the b of the text. */
static void test_text_368_b_is_a_length(void)
{
    while (another_state()) {
        const double m = some(), d = some() + 1;
        const matrix shape = {{{1, -1, 0}, {-1, 1, 0}, {0, 0, 2}}};
        judge_matrix(scaled(m * d * d, shape), scaled(-m, R2(vec(d * d, d * d, 0))),
                     scaled(-m, R2(vec(d, d, 0))));
    }
}

/* Largest entry of p diag(0, 2, 2) p' less (370). */
static double off_370(matrix p)
{
    const matrix moments = {{{0, 0, 0}, {0, 2, 0}, {0, 0, 2}}};
    const matrix wanted = {{{1, -1, 0}, {-1, 1, 0}, {0, 0, 2}}};
    const matrix off = plus(product(p, product(moments, transpose(p))), -1, wanted);
    double most = 0;
    for (int i = 0; i < 9; i++) {
        most = fmax(most, fabs(off.a[i / 3][i % 3]));
    }
    return most;
}

/* Four digits give (370) to four digits; what is printed, to two. */
static void test_eq_371_has_columns_of_length_1(void)
{
    TEST_ASSERT_TRUE(off_370((matrix){{{-0.701, -0.707, 0}, {-0.701, 0.701, 0}, {0, 0, 1}}}) > 1e-2);
    TEST_ASSERT_TRUE(off_370((matrix){{{-0.7071, -0.7071, 0}, {-0.7071, 0.7071, 0}, {0, 0, 1}}}) < 1e-4);
}

/* No torque is needed, w x M w = 0, about any axis across the arm; about an oblique one it is. */
static void test_text_371_every_axis_across_the_arm_is_principal(void)
{
    while (another_state()) {
        const vector b = any_vector(), oblique = add(b, cross(b, any_vector()));
        const matrix M = scaled(-some(), R2(b));
        const vector across = cross(b, any_vector());
        const vector axes[2] = {oblique, scale(1 / norm(across), across)};
        vector torque[2];
        for (int i = 0; i < 2; i++) {
            torque[i] = cross(axes[i], times(M, axes[i]));
        }
        judge(zero, torque[0], torque[1]);
    }
}

/* ---- 6: free bodies ---- */

/* A free body seen from its centre: what section 6 calls xbar and x_i - xbar. */
typedef struct {
    body p;
    vector centre, centre_velocity, w, w_dot, L, torque;
    matrix M; /* Mbar of (401) */
} free_body;

static free_body random_free_body(bool is_pushed)
{
    free_body self = {.p = random_body(true, is_pushed)};
    const body *const p = &self.p;
    const spin turning = spin_of(p->u, p->udot, p->uddot);
    self.w = turning.omega;
    self.w_dot = turning.omega_dot;
    self.centre = scale(1 / mass_of(p), first_moment(p, p->x));
    self.centre_velocity = scale(1 / mass_of(p), first_moment(p, p->v));
    self.M = inertia(p, p->x, self.centre);
    self.L = times(self.M, self.w);
    self.torque = moment(p, false, p->x, self.centre, p->f);
    return self;
}

static void test_eq_381_has_the_left_jacobian(void)
{
    while (another_state()) {
        const free_body s = random_free_body(true);
        const vector arm = sub(s.p.x[0], s.centre);
        judge(s.p.v[0], add(s.centre_velocity, cross(s.p.udot, arm)),
              add(s.centre_velocity, cross(s.w, arm)));
    }
}

/* (xbar-dot, omega)' M_i (xbar-dot, omega) is twice the kinetic energy of the particle. */
static void test_eq_382_has_the_mass_and_R_at_the_lower_left(void)
{
    while (another_state()) {
        const free_body s = random_free_body(true);
        const vector arm = sub(s.p.x[0], s.centre), v = s.centre_velocity;
        const double straight = dot(v, v) - dot(s.w, times(R2(arm), s.w));
        const double upper = dot(v, times(transpose(R(arm)), s.w));
        const double lower[2] = {dot(s.w, times(transpose(R(arm)), v)), dot(s.w, times(R(arm), v))};
        judge_number(s.p.m[0] * dot(s.p.v[0], s.p.v[0]), straight + upper + lower[0],
                     s.p.m[0] * (straight + upper + lower[1]));
    }
}

/* m_i J_i'Jdot_i omega about the centre, with the L_i of (389), which holds m_i. */
static void test_eq_388_and_390_count_the_mass_once(void)
{
    while (another_state()) {
        const free_body s = random_free_body(true);
        const double m = s.p.m[0];
        const vector arm = sub(s.p.x[0], s.centre), rate = sub(s.p.v[0], s.centre_velocity);
        const vector once = times(transpose(R(scale(m, cross(arm, rate)))), s.w); /* R'[L_i] omega */
        const vector geometry = times(scaled(-1, product(R(arm), R(rate))), s.w);
        judge(scale(m, geometry), scale(m, once), once); /* (388) */
        judge(once, geometry, scale(m, geometry));       /* (390) */
    }
}

/* tau = Mbar omega-dot + Cbar omega, (400). */
static void test_eq_392_has_no_minus_and_counts_the_mass_once(void)
{
    while (another_state()) {
        const free_body s = random_free_body(true);
        vector printed = zero, corrected = zero;
        for (int i = 0; i < s.p.count; i++) {
            const vector L = times(scaled(-s.p.m[i], R2(sub(s.p.x[i], s.centre))), s.w);
            const vector once = times(transpose(R(L)), s.w);
            printed = add(printed, scale(-s.p.m[i], once));
            corrected = add(corrected, once);
        }
        const vector inertial = times(s.M, s.w_dot);
        judge(s.torque, add(inertial, printed), add(inertial, corrected));
    }
}

/* Rates of what should stay: of the angular velocity, of the angular momentum. */
static void test_text_404_without_torque_the_angular_momentum_is_constant(void)
{
    while (another_state()) {
        const free_body s = random_free_body(false);
        judge(zero, s.w_dot, moment(&s.p, true, s.p.x, s.centre, s.p.a));
        agree(zero, add(times(s.M, s.w_dot), cross(s.w, s.L)));
    }
}

/* uddot of omega-dot, which is J_l uddot and a rest. */
static vector second_rate_of_rotation_vector(vector u, vector udot, vector omega_dot)
{
    const vector rest = spin_of(u, udot, zero).omega_dot;
    matrix columns;
    for (int k = 0; k < 3; k++) {
        memcpy(columns.a[k], spin_of(u, vec_of(one.a[k]), zero).omega.a, sizeof columns.a[k]);
    }
    return solve(columns, sub(omega_dot, rest));
}

/* Body axes. The printed one takes the rate of the rotation vector for the angular velocity. */
static void test_eq_417_holds_for_the_angular_velocity_in_body_axes(void)
{
    while (another_state()) {
        const free_body s = random_free_body(true);
        const matrix back = transpose(s.p.r), I = product(back, product(s.M, s.p.r));
        const vector torque = times(back, s.torque), w = times(back, s.w);
        const vector printed = solve(I, sub(torque, cross(s.p.udot, times(I, s.p.udot))));
        const vector corrected = solve(I, sub(torque, cross(w, times(I, w))));
        judge(times(back, s.w_dot), printed, corrected);
        judge(s.p.uddot, printed, second_rate_of_rotation_vector(s.p.u, s.p.udot, times(s.p.r, corrected)));
    }
}

/* J_r^-1(u) w */
static vector rate_of_rotation_vector(vector u, vector w)
{
    const double a = norm(u);
    const double factor = 1 / (a * a) - 1 / (2 * a * tan(a / 2));
    return add(w, add(scale(0.5, cross(u, w)), scale(factor, times(R2(u), w))));
}

/* The angular velocity is half the sum of x x xd over three particles on the axes of the body. */
static void test_eq_419_needs_the_inverse_of_the_right_jacobian(void)
{
    while (another_state()) {
        body p = random_body(false, false);
        p.count = 3;
        for (int i = 0; i < 3; i++) {
            p.b[i] = vec_of(one.a[i]);
        }
        run_body(&p);
        const vector w = times(transpose(p.r), scale(0.5, moment(&p, false, p.x, zero, p.v)));
        judge(p.udot, w, rate_of_rotation_vector(p.u, w));
    }
    const vector example = rate_of_rotation_vector(vec(0.3, -0.7, 1.1), vec(1, 2, -1.5));
    TEST_ASSERT_TRUE(norm(sub(example, vec(0.200, 2.633, -0.879))) < 1e-3); /* three printed digits */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_eq_310_has_the_masses_and_a_minus);
    RUN_TEST(test_eq_312_has_the_turned_matrix);
    RUN_TEST(test_eq_324_the_total_mass_is_positive);
    RUN_TEST(test_eq_328_has_a_sum_of_squares_about_the_third_axis);
    RUN_TEST(test_eq_331_the_square_of_0_49_is_0_2401);
    RUN_TEST(test_eq_341_has_minus_the_mass);
    RUN_TEST(test_eq_348_inverts_a_singular_matrix_and_has_the_other_sign);
    RUN_TEST(test_eq_348_is_refused_by_the_engine);
    RUN_TEST(test_text_350_the_steady_rotation_is_unstable_above_45_degrees);
    RUN_TEST(test_text_368_b_is_a_length);
    RUN_TEST(test_eq_371_has_columns_of_length_1);
    RUN_TEST(test_text_371_every_axis_across_the_arm_is_principal);
    RUN_TEST(test_eq_381_has_the_left_jacobian);
    RUN_TEST(test_eq_382_has_the_mass_and_R_at_the_lower_left);
    RUN_TEST(test_eq_388_and_390_count_the_mass_once);
    RUN_TEST(test_eq_392_has_no_minus_and_counts_the_mass_once);
    RUN_TEST(test_text_404_without_torque_the_angular_momentum_is_constant);
    RUN_TEST(test_eq_417_holds_for_the_angular_velocity_in_body_axes);
    RUN_TEST(test_eq_419_needs_the_inverse_of_the_right_jacobian);
    return UNITY_END();
}

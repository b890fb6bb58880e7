/* Section 4 of the source, rotations, against the Gauss engine. docs/errata.md lists the equations. */
#include "errata/rotation.h"

static void test_eq_234_has_the_first_and_third_squares_in_the_middle(void)
{
    while (another_state()) {
        const vector v = any_vector();
        const double x = v.a[0], y = v.a[1], z = v.a[2];
        matrix corrected = {
            {{-z * z - y * y, x * y, x * z}, {x * y, -x * x - z * z, y * z}, {x * z, y * z, -x * x - y * y}}};
        matrix printed = corrected;
        printed.a[1][1] = -y * y - z * z;
        judge_matrix(R2(v), printed, corrected);
    }
}

static void test_eq_240_counts_the_angle_once(void)
{
    const vector axis = {{0, 0, 1}};
    while (another_state()) {
        const double th = some() + 1.5; /* th^2 is another angle than th */
        const matrix r = {{{cos(th), -sin(th), 0}, {sin(th), cos(th), 0}, {0, 0, 1}}};
        const vector u = scale(th, axis); /* (239) */
        judge_matrix(r, rotation(scale(th, u)), rotation(scale(th, axis)));
    }
}

static void test_eq_242_has_the_left_jacobian(void)
{
    while (another_state()) {
        const body p = random_body(false, true);
        const vector omega = spin_of(p.u, p.udot, p.uddot).omega;
        judge(p.v[0], times(transpose(R(p.x[0])), p.udot), times(transpose(R(p.x[0])), omega));
    }
}

/* The acceleration of a particle when (253) is solved, with the one or the other for its thd. */
static void test_eq_243_to_263_hold_for_the_angular_velocity_alone(void)
{
    while (another_state()) {
        const body p = random_body(false, true);
        const matrix M = inertia(&p, p.x, zero);
        const vector torque = moment(&p, false, p.x, zero, p.f);
        const vector rates[2] = {p.udot, spin_of(p.u, p.udot, p.uddot).omega};
        vector a[2];
        for (int i = 0; i < 2; i++) {
            const vector w = rates[i];
            const vector w_dot = solve(M, sub(torque, cross(w, times(M, w))));
            a[i] = add(cross(w_dot, p.x[0]), cross(w, cross(w, p.x[0])));
        }
        judge(p.a[0], a[0], a[1]);
    }
}

/* l = M omega of one particle; its rate by the engine. */
static void test_eq_254_has_the_mass(void)
{
    while (another_state()) {
        const body p = random_body(false, true);
        const spin w = spin_of(p.u, p.udot, p.uddot);
        const vector inertial = times(scaled(-p.m[0], R2(p.x[0])), w.omega_dot);
        const vector J_Jdot =
            times(product(R(p.x[0]), transpose(R(p.v[0]))), w.omega); /* Jdot'J omega is 0 */
        judge(scale(p.m[0], cross(p.x[0], p.a[0])), add(inertial, J_Jdot),
              add(inertial, scale(p.m[0], J_Jdot)));
    }
}

/* Also for (298) to (311), (388) and (390): as matrices they differ, applied to omega they agree. */
static void test_eq_258_holds_applied_to_the_angular_velocity_and_not_as_matrices(void)
{
    while (another_state()) {
        const body p = random_body(false, true);
        const vector omega = spin_of(p.u, p.udot, p.uddot).omega;
        const vector x = p.x[0], v = p.v[0], l = scale(p.m[0], cross(x, v));
        const matrix C = scaled(p.m[0], product(R(x), transpose(R(v))));
        matrix corrected; /* - m xd x' */
        for (int i = 0; i < 9; i++) {
            corrected.a[i / 3][i % 3] = -p.m[0] * v.a[i / 3] * x.a[i % 3];
        }
        judge_matrix(C, transpose(R(l)), corrected);
        agree(times(C, omega), times(transpose(R(l)), omega));
    }
}

/* ---- a fixed axis (4.3) ---- */

static void place_about_axis(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                             mct_hyperdual (*position)[3])
{
    const vector *const self = context; /* axis, b */
    dual_vector u, b;
    (void)time;
    for (int k = 0; k < 3; k++) {
        u.a[k] = mct_hyperdual_scale(self[0].a[k], q[0]);
        b.a[k] = mct_hyperdual_constant(self[1].a[k]);
    }
    memcpy(position[0], turned(u, b).a, sizeof *position);
}

/* Also for (352); for (268) b is at any angle to u. */
static void test_eq_266_and_267_have_the_mass(void)
{
    while (another_state()) {
        const vector axis = any_vector();
        const vector context[2] = {scale(1 / norm(axis), axis), any_vector()};
        const double m = some() + 1, th = some(), rate = any();
        const double M =
            engine((mct_gauss_system){1, 1, &m, place_about_axis, context}, 0, &th, &rate, NULL, NULL)
                ->M[0][0];
        const double printed = -dot(context[0], times(R2(context[1]), context[0]));
        judge_number(M, printed, m * printed);
        judge_number(M, printed, m * pow(norm(cross(context[1], context[0])), 2)); /* (269) */
    }
}

/* ---- a turning frame (4.4) ---- */

typedef struct {
    vector u, udot, uddot; /* of the frame, at time 0 */
} frame;

static void place_in_frame(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                           mct_hyperdual (*position)[3])
{
    const frame *const self = context;
    dual_vector u, at;
    for (int k = 0; k < 3; k++) {
        const mct_hyperdual half = mct_hyperdual_scale(self->uddot.a[k] / 2, time);
        const mct_hyperdual rate = mct_hyperdual_add(mct_hyperdual_constant(self->udot.a[k]), half);
        u.a[k] = mct_hyperdual_add(mct_hyperdual_constant(self->u.a[k]), mct_hyperdual_mul(rate, time));
        at.a[k] = q[k];
    }
    memcpy(position[0], turned(u, at).a, sizeof *position);
}

/* (277) and (283) with a rate and its derivative in the place of udot and uddot. */
typedef struct {
    vector velocity, acceleration;
} seen;

static seen see(matrix r, vector q, vector v, vector f, double m, vector w, vector w_dot)
{
    const vector x = times(r, q), xd = times(r, v);
    const vector centrifugal = cross(w, cross(x, w));
    const vector coriolis = scale(2, cross(xd, w));
    const vector euler = cross(x, w_dot);
    const vector sum = add(add(scale(1 / m, f), centrifugal), add(coriolis, euler));
    return (seen){add(times(transpose(R(x)), w), xd), times(transpose(r), sum)};
}

static void test_eq_277_to_287_hold_for_the_angular_velocity_alone(void)
{
    while (another_state()) {
        const frame at = {any_rotation(), any_vector(), any_vector()};
        const double m = some();
        const vector q = any_vector(), v = any_vector(), f = any_vector();
        const mct_gauss_motion *const motion =
            engine((mct_gauss_system){1, 3, &m, place_in_frame, &at}, 0, q.a, v.a, f.a, NULL);
        const matrix r = rotation(at.u);
        const spin w = spin_of(at.u, at.udot, at.uddot);
        const seen printed = see(r, q, v, f, m, at.udot, at.uddot);
        const seen corrected = see(r, q, v, f, m, w.omega, w.omega_dot);
        judge(vec_of(motion->velocity[0]), printed.velocity, corrected.velocity); /* (277), (287) */
        judge(vec_of(motion->acceleration), printed.acceleration, corrected.acceleration);
    }
}

/* ---- polar coordinates (4.5): the scale and a rotation vector ---- */

static void place_polar(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                        mct_hyperdual (*position)[3])
{
    const vector *const self = context; /* b - o */
    const dual_vector beta = {{q[1], q[2], q[3]}};
    dual_vector b;
    (void)time;
    for (int k = 0; k < 3; k++) {
        b.a[k] = mct_hyperdual_mul(q[0], mct_hyperdual_constant(self->a[k]));
    }
    memcpy(position[0], turned(beta, b).a, sizeof *position);
}

static void test_eq_290_and_291_hold_for_the_angular_velocity_alone(void)
{
    while (another_state()) {
        const double m = 1, alpha = some(), alpha_dot = any();
        const vector b = any_vector(), beta = any_rotation(), beta_dot = any_vector();
        const double q[4] = {alpha, beta.a[0], beta.a[1], beta.a[2]};
        const double v[4] = {alpha_dot, beta_dot.a[0], beta_dot.a[1], beta_dot.a[2]};
        static mct_gauss_workspace workspace;
        static mct_gauss_motion motion;
        /* Four coordinates for one particle: M is singular, so only the kinematics are asked for. */
        const mct_gauss_system system = {1, 4, &m, place_polar, &b};
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_kinematics(&system, 0, q, v, &workspace, &motion));
        const vector x = vec_of(motion.position[0]);
        const vector radial = scale(alpha_dot / alpha, x);
        const vector omega = spin_of(beta, beta_dot, zero).omega;
        judge(vec_of(motion.velocity[0]), add(radial, cross(beta_dot, x)), add(radial, cross(omega, x)));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_eq_234_has_the_first_and_third_squares_in_the_middle);
    RUN_TEST(test_eq_240_counts_the_angle_once);
    RUN_TEST(test_eq_242_has_the_left_jacobian);
    RUN_TEST(test_eq_243_to_263_hold_for_the_angular_velocity_alone);
    RUN_TEST(test_eq_254_has_the_mass);
    RUN_TEST(test_eq_258_holds_applied_to_the_angular_velocity_and_not_as_matrices);
    RUN_TEST(test_eq_266_and_267_have_the_mass);
    RUN_TEST(test_eq_277_to_287_hold_for_the_angular_velocity_alone);
    RUN_TEST(test_eq_290_and_291_hold_for_the_angular_velocity_alone);
    return UNITY_END();
}

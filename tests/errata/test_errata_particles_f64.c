/* Sections 1 and 2 of the source, against the Gauss engine. docs/errata.md lists the equations. */
#include "errata/errata.h"

/* ---- the pendulum (1.2), its base moved (2.6.1) ---- */

typedef struct {
    double m, r, g, th, w;       /* mass, length, gravity, angle, rate */
    vector base_acceleration;    /* 0 at first */
    vector turn, J, Jdot, force; /* (sin, cos, 0), dx/dth, its rate, the weight */
    double acceleration;         /* from here on by the engine */
    vector x, velocity, xdd, e;
} pendulum;

static void place_pendulum(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                           mct_hyperdual (*position)[3])
{
    const pendulum *const self = context;
    const mct_hyperdual square = mct_hyperdual_mul(time, time);
    const mct_hyperdual turn[3] = {mct_hyperdual_sin(q[0]), mct_hyperdual_cos(q[0])};
    for (int k = 0; k < 3; k++) {
        position[0][k] = mct_hyperdual_add(mct_hyperdual_scale(self->r, turn[k]),
                                           mct_hyperdual_scale(self->base_acceleration.a[k] / 2, square));
    }
}

static void run_pendulum(pendulum *self)
{
    const mct_gauss_motion *const motion = engine((mct_gauss_system){1, 1, &self->m, place_pendulum, self}, 0,
                                                  &self->th, &self->w, self->force.a, NULL);
    self->acceleration = motion->acceleration[0];
    self->x = vec_of(motion->position[0]);
    self->velocity = vec_of(motion->velocity[0]);
    self->xdd = vec_of(motion->particle_acceleration[0]);
    self->e = vec_of(motion->constraint_force[0]);
}

static pendulum random_pendulum(void)
{
    pendulum p = {.m = some(), .r = some(), .g = 10 * some(), .th = any(), .w = any()};
    p.turn = vec(sin(p.th), cos(p.th), 0);
    p.J = scale(p.r, vec(cos(p.th), -sin(p.th), 0));
    p.Jdot = scale(-p.r * p.w, p.turn);
    p.force = vec(0, -p.m * p.g, 0);
    run_pendulum(&p);
    return p;
}

static void test_text_12_forgets_the_constraint_force_in_the_column_space(void)
{
    while (another_state()) {
        const pendulum p = random_pendulum();
        const vector forces = sub(p.force, scale(p.m * p.w, p.Jdot));
        judge_number(0, dot(p.turn, forces), dot(p.turn, add(forces, p.e))); /* turn is orthogonal to J */
    }
}

static void test_eq_20_is_the_work_along_the_velocity(void)
{
    while (another_state()) {
        const pendulum p = random_pendulum();
        judge_number(0, dot(p.e, p.x), dot(p.e, p.velocity));
    }
}

static void test_eq_35_is_minus_the_constraint_force(void)
{
    while (another_state()) {
        const pendulum p = random_pendulum();
        const vector motion = scale(p.m, add(scale(p.w, p.Jdot), scale(p.acceleration, p.J)));
        judge(p.e, sub(p.force, motion), sub(motion, p.force));
    }
}

static void test_eq_36_has_the_square_of_the_rate_and_the_other_sign(void)
{
    while (another_state()) {
        const pendulum p = random_pendulum();
        const vector swing = scale(p.m * p.g / p.r * sin(p.th), p.J);
        const vector printed = sub(sub(p.force, scale(p.m * p.r * p.w, p.turn)), swing);
        const vector corrected = sub(add(p.force, scale(p.m * p.r * p.w * p.w, p.turn)), swing);
        judge(p.e, printed, scale(-1, corrected));
    }
}

static void test_eq_37_has_the_square_of_the_rate_and_other_signs(void)
{
    while (another_state()) {
        const pendulum p = random_pendulum();
        const double s = sin(p.th), c = cos(p.th);
        const vector printed =
            add(sub(p.force, scale(p.m * p.w, p.x)), scale(p.m * p.g, vec(c * s, s * s, 0)));
        const vector corrected =
            add(add(p.force, scale(p.m * p.w * p.w, p.x)), scale(p.m * p.g, vec(-c * s, s * s, 0)));
        judge(p.e, printed, scale(-1, corrected));
    }
}

static void test_eq_38_has_the_square_of_the_rate_and_the_length(void)
{
    while (another_state()) {
        const pendulum p = random_pendulum();
        judge(p.e, scale(p.m * (p.g * cos(p.th) - p.w), p.x),
              scale(p.m * (p.g * cos(p.th) / p.r - p.w * p.w), p.x));
    }
}

static void test_eq_39_has_the_length(void)
{
    while (another_state()) {
        const pendulum p = random_pendulum();
        judge(p.velocity, scale(p.w / p.r, p.J), scale(p.w, p.J));
    }
}

static void test_eq_84_the_constraint_force_is_not_orthogonal_to_the_effective_force(void)
{
    while (another_state()) {
        const pendulum p = random_pendulum();
        const vector effective = add(p.force, p.e);
        judge_number(dot(p.e, scale(p.w, p.Jdot)), 0, dot(p.e, effective) / p.m);
    }
}

static void test_eq_175_has_the_rate_of_the_jacobian(void)
{
    while (another_state()) {
        pendulum p = random_pendulum();
        p.base_acceleration = any_vector();
        run_pendulum(&p);
        const vector rest = sub(add(p.force, p.e), scale(p.m, p.base_acceleration));
        judge(scale(p.m * p.acceleration, p.J), sub(rest, scale(p.m * p.w, p.J)),
              sub(rest, scale(p.m * p.w, p.Jdot)));
    }
}

static void test_eq_179_has_the_length(void)
{
    while (another_state()) {
        pendulum p = random_pendulum();
        p.base_acceleration = any_vector();
        run_pendulum(&p);
        const vector rest = add(scale(p.acceleration, p.J), p.base_acceleration);
        judge(sub(p.xdd, rest), scale(p.w / p.r, p.Jdot), scale(p.w, p.Jdot));
    }
}

/* ---- two linked particles (2.2); (95) to (103) are in tests/systems/test_linked_particles.c ---- */

static void place_linked(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                         mct_hyperdual (*position)[3])
{
    (void)time;
    memset(position, 0, 2 * sizeof *position);
    position[0][0] = q[0];
    position[1][0] = mct_hyperdual_add(q[0], mct_hyperdual_constant(*(const double *)context));
}

static void test_eq_86_the_jacobian_of_a_shift_is_1(void)
{
    while (another_state()) {
        const double m[2] = {some(), some()}, c = some(), th = any(), rate = any();
        const double M =
            engine((mct_gauss_system){2, 1, m, place_linked, &c}, 0, &th, &rate, NULL, NULL)->M[0][0];
        judge_number(M, (m[0] + m[1]) * (th + c) * (th + c), m[0] + m[1]);
    }
}

/* ---- the cart-pole (2.4) ---- */

typedef struct {
    double m[2], l, g, f, k[2], q[2], v[2];
    double s, c; /* of the pole's angle */
    const mct_gauss_motion *motion;
} cart_pole;

static void place_cart_pole(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                            mct_hyperdual (*position)[3])
{
    const double length = *(const double *)context;
    (void)time;
    memset(position, 0, 2 * sizeof *position);
    position[0][0] = q[0];
    position[1][0] = mct_hyperdual_add(q[0], mct_hyperdual_scale(length, mct_hyperdual_sin(q[1])));
    position[1][1] = mct_hyperdual_scale(length, mct_hyperdual_cos(q[1]));
}

static cart_pole random_cart_pole(void)
{
    cart_pole p = {.m = {some(), some()},
                   .l = some(),
                   .g = 10 * some(),
                   .f = any(),
                   .k = {some(), some()},
                   .q = {any(), any()},
                   .v = {any(), any()}};
    p.s = sin(p.q[1]);
    p.c = cos(p.q[1]);
    const double force[6] = {p.f, -p.m[0] * p.g, 0, 0, -p.m[1] * p.g, 0};
    const double couple[2] = {-p.k[0] * p.v[0], -p.k[1] * p.v[1]};
    p.motion = engine((mct_gauss_system){2, 2, p.m, place_cart_pole, &p.l}, 0, p.q, p.v, force, couple);
    return p;
}

static void test_eq_125_and_129_have_no_second_row(void)
{
    while (another_state()) {
        const cart_pole p = random_cart_pole();
        const double first = -p.m[1] * p.l * p.s * p.v[1] * p.v[1];
        const double inertia = p.m[1] * p.l * p.l;
        const double corrected[2] = {first, 0};
        judge_all(2, p.motion->Cv, (double[2]){first, -inertia * p.v[1]}, corrected);          /* (125) */
        judge_all(2, p.motion->Cv, (double[2]){first, -inertia * p.v[1] * p.v[1]}, corrected); /* (129) */
    }
}

static void test_eq_126_and_130_have_the_length_in_the_weight(void)
{
    while (another_state()) {
        const cart_pole p = random_cart_pole();
        const double weight = p.m[1] * p.g * p.s, friction = p.k[1] * p.v[1];
        judge_number(p.motion->tau[1], weight - friction, weight * p.l - friction);
    }
}

static void test_eq_131_has_the_acceleration_and_the_mass_of_the_pole(void)
{
    while (another_state()) {
        const cart_pole p = random_cart_pole();
        const double *const a = p.motion->acceleration;
        const double cart = (p.m[0] + p.m[1]) * a[0];
        const double swing = p.l * p.v[1] * p.v[1] * p.s;
        const double total = p.m[0] + p.m[1]; /* for the m without an index */
        judge_number(p.f - p.k[0] * p.v[0], cart + p.m[1] * p.l * p.c * p.v[1] - total * swing,
                     cart + p.m[1] * p.l * p.c * a[1] - p.m[1] * swing);
    }
}

static void test_eq_132_has_no_term_in_the_square_and_the_length_in_the_weight(void)
{
    while (another_state()) {
        const cart_pole p = random_cart_pole();
        const double *const a = p.motion->acceleration;
        const double inertia = p.m[1] * p.l * p.l, weight = p.m[1] * p.g * p.s;
        const double left = p.m[1] * p.l * p.c * a[0] + inertia * a[1];
        judge_number(-p.k[1] * p.v[1], left - inertia * p.q[1] * p.q[1] - weight, left - weight * p.l);
    }
}

/* What C v of (129) and tau of (130) do to the energy is not the power of the force and of both frictions. */
static void test_the_power_balance_of_the_cart_pole_closes_as_corrected_alone(void)
{
    while (another_state()) {
        const cart_pole p = random_cart_pole();
        const double *const v = p.v;
        const double coupling = p.m[1] * p.l * p.c, inertia = p.m[1] * p.l * p.l;
        const double coupling_rate = -p.m[1] * p.l * p.s * v[1];
        const double weight = p.m[1] * p.g * p.l * p.s;
        const double M[2][2] = {{p.m[0] + p.m[1], coupling}, {coupling, inertia}};
        const double momentum[2] = {M[0][0] * v[0] + coupling * v[1], coupling * v[0] + inertia * v[1]};
        const double force = p.f - p.k[0] * v[0] - coupling_rate * v[1]; /* tau - C v, the first row */
        const double torque[2] = {weight / p.l - p.k[1] * v[1] + inertia * v[1] * v[1],
                                  weight - p.k[1] * v[1]};
        double change[2];
        for (int k = 0; k < 2; k++) {
            const double det = M[0][0] * inertia - coupling * coupling;
            const double a[2] = {(inertia * force - coupling * torque[k]) / det,
                                 (M[0][0] * torque[k] - coupling * force) / det};
            change[k] = momentum[0] * a[0] + momentum[1] * a[1] + coupling_rate * v[0] * v[1] - weight * v[1];
        }
        judge_number(p.f * v[0] - p.k[0] * v[0] * v[0] - p.k[1] * v[1] * v[1], change[0], change[1]);
    }
}

/* ---- a particle of the reaction wheel (2.5) ---- */

static void place_on_wheel(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                           mct_hyperdual (*position)[3])
{
    const double *const self = context; /* l, r, alpha */
    const mct_hyperdual angle =
        mct_hyperdual_add(mct_hyperdual_add(q[0], q[1]), mct_hyperdual_constant(self[2]));
    (void)time;
    position[0][0] = mct_hyperdual_add(mct_hyperdual_scale(self[0], mct_hyperdual_sin(q[0])),
                                       mct_hyperdual_scale(self[1], mct_hyperdual_sin(angle)));
    position[0][1] = mct_hyperdual_add(mct_hyperdual_scale(self[0], mct_hyperdual_cos(q[0])),
                                       mct_hyperdual_scale(self[1], mct_hyperdual_cos(angle)));
    position[0][2] = mct_hyperdual_constant(0);
}

/* (145) and (146) are C for the rates (1, 0) and (0, 1). */
static void test_eq_145_to_147_have_the_other_sign(void)
{
    static const double unit[2][2] = {{1, 0}, {0, 1}};
    while (another_state()) {
        const double m = some(), shape[3] = {some(), some(), any()};
        const double q[2] = {any(), any()}, random[2] = {any(), any()};
        const double *const rates[3] = {unit[0], unit[1], random};
        const double s = shape[0] * shape[1] * sin(shape[2] + q[1]);
        for (int k = 0; k < 3; k++) {
            const double *const v = rates[k];
            const mct_gauss_motion *const motion =
                engine((mct_gauss_system){1, 2, &m, place_on_wheel, shape}, 0, q, v, NULL, NULL);
            double truth[4], printed[4], corrected[4];
            const double sum[4] = {v[1], v[0] + v[1], -v[0], 0};
            for (int i = 0; i < 4; i++) {
                truth[i] = motion->C[i / 2][i % 2];
                printed[i] = m * s * sum[i];
                corrected[i] = -m * s * sum[i];
            }
            judge_all(4, truth, printed, corrected);
        }
    }
}

/* The torque of two equal particles' weight on the wheel, by the angle between them that each rule gives. */
static void test_text_163_a_balanced_wheel_has_opposite_sines(void)
{
    while (another_state()) {
        const double m = some(), l = some(), r = some(), alpha = some(), v[2] = {any(), any()};
        const double q[2] = {any(), any()}, weight[3] = {0, -m * GRAVITY, 0};
        const double places[3] = {alpha, alpha + PI / 2, alpha + PI}; /* of one; of the other by each rule */
        double torque[3];
        for (int k = 0; k < 3; k++) {
            const double shape[3] = {l, r, places[k]};
            torque[k] =
                engine((mct_gauss_system){1, 2, &m, place_on_wheel, shape}, 0, q, v, weight, NULL)->tau[1];
        }
        judge_number(0, torque[0] + torque[1], torque[0] + torque[2]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_text_12_forgets_the_constraint_force_in_the_column_space);
    RUN_TEST(test_eq_20_is_the_work_along_the_velocity);
    RUN_TEST(test_eq_35_is_minus_the_constraint_force);
    RUN_TEST(test_eq_36_has_the_square_of_the_rate_and_the_other_sign);
    RUN_TEST(test_eq_37_has_the_square_of_the_rate_and_other_signs);
    RUN_TEST(test_eq_38_has_the_square_of_the_rate_and_the_length);
    RUN_TEST(test_eq_39_has_the_length);
    RUN_TEST(test_eq_84_the_constraint_force_is_not_orthogonal_to_the_effective_force);
    RUN_TEST(test_eq_175_has_the_rate_of_the_jacobian);
    RUN_TEST(test_eq_179_has_the_length);
    RUN_TEST(test_eq_86_the_jacobian_of_a_shift_is_1);
    RUN_TEST(test_eq_125_and_129_have_no_second_row);
    RUN_TEST(test_eq_126_and_130_have_the_length_in_the_weight);
    RUN_TEST(test_eq_131_has_the_acceleration_and_the_mass_of_the_pole);
    RUN_TEST(test_eq_132_has_no_term_in_the_square_and_the_length_in_the_weight);
    RUN_TEST(test_the_power_balance_of_the_cart_pole_closes_as_corrected_alone);
    RUN_TEST(test_eq_145_to_147_have_the_other_sign);
    RUN_TEST(test_text_163_a_balanced_wheel_has_opposite_sines);
    return UNITY_END();
}

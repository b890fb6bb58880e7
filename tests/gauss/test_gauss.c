/*
 * The rules of include/mctau/gauss.h: the engine against the closed forms of the source, as corrected, and
 * against Gauss's principle itself on a spatial chain without a closed form. Equation numbers are those of
 * the source.
 */
#include <math.h>
#include <string.h>

#include "mctau/gauss.h"
#include "unity.h"

#define EPSILON    ((double)MCT_REAL_EPSILON)
#define NEAR(size) (64.0 * EPSILON * (size)) /* some tens of roundings of terms of this size */
#define GRAVITY    9.81

void setUp(void)
{
}

void tearDown(void)
{
}

static mct_gauss_workspace workspace;
static mct_gauss_motion motion;

static mct_status move(const mct_gauss_system *system, double time, const mct_real *q, const mct_real *v,
                       const mct_real *force, const mct_real *couple)
{
    const mct_status status = mct_gauss_kinematics(system, MCT_R(time), q, v, &workspace, &motion);
    return status != MCT_OK ? status : mct_gauss_dynamics(system, force, couple, &workspace, &motion);
}

/* Numbers in [-1, 1), the same on every machine and in both precisions. */
static uint64_t random_state = 1;

static mct_real random_number(void)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (mct_real)((double)((random_state * UINT64_C(2685821657736338717)) >> 48) * 0x1p-15 - 1.0);
}

static void fill_randomly(int count, mct_real *numbers)
{
    for (int i = 0; i < count; i++) {
        numbers[i] = random_number();
    }
}

static double dot3(const mct_real *a, const mct_real *b)
{
    return (double)a[0] * (double)b[0] + (double)a[1] * (double)b[1] + (double)a[2] * (double)b[2];
}

/* ---- the pendulum (1.2), its base moved (2.6.1) ---- */

typedef struct {
    mct_real length;
    mct_real amplitude[2]; /* of the base, right and up [m] */
    mct_real frequency[2]; /* [rad/s] */
} pendulum;

static void place_pendulum(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                           mct_hyperdual (*position)[3])
{
    const pendulum *const self = context;
    mct_hyperdual sine;
    mct_hyperdual cosine;
    mct_hyperdual_sincos(q[0], &sine, &cosine);
    const mct_hyperdual right = mct_hyperdual_sin(mct_hyperdual_scale(self->frequency[0], time));
    const mct_hyperdual up = mct_hyperdual_cos(mct_hyperdual_scale(self->frequency[1], time));
    position[0][0] = mct_hyperdual_add(mct_hyperdual_scale(self->length, sine),
                                       mct_hyperdual_scale(self->amplitude[0], right));
    position[0][1] = mct_hyperdual_add(mct_hyperdual_scale(self->length, cosine),
                                       mct_hyperdual_scale(self->amplitude[1], up));
    position[0][2] = mct_hyperdual_constant(MCT_R(0.0));
}

static void test_pendulum_is_held_by_the_constraint_force_of_equation_38(void)
{
    const pendulum rod = {MCT_R(0.5), {MCT_R(0.0), MCT_R(0.0)}, {MCT_R(0.0), MCT_R(0.0)}};
    const mct_real mass[] = {MCT_R(2.0)};
    const mct_gauss_system system = {1, 1, mass, place_pendulum, &rod};
    const mct_real force[] = {MCT_R(0.0), MCT_R(-2.0 * GRAVITY), MCT_R(0.0)};
    for (int i = -30; i <= 30; i++) {
        const mct_real q[] = {MCT_R(0.1 * i)};
        const mct_real v[] = {MCT_R(0.3 * (i % 7))};
        TEST_ASSERT_EQUAL_INT(MCT_OK, move(&system, 0.0, q, v, force, NULL));
        const double angle = (double)q[0];
        const double rate = (double)v[0];
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(1), 2.0 * 0.25, (double)motion.M[0][0]);
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(1), 0.0, (double)motion.Cv[0]);
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(20), 2.0 * GRAVITY * 0.5 * sin(angle), (double)motion.tau[0]);
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(40), GRAVITY / 0.5 * sin(angle), (double)motion.acceleration[0]);
        /* e = m x (g cos th / r - thd^2), along the rod */
        const double along = 2.0 * (GRAVITY * cos(angle) / 0.5 - rate * rate);
        for (int k = 0; k < 3; k++) {
            const double wanted = along * (double)motion.position[0][k];
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(40), wanted, (double)motion.constraint_force[0][k]);
        }
    }
}

static void test_pendulum_on_a_moving_base_obeys_equation_187(void)
{
    const pendulum shaken = {MCT_R(0.7), {MCT_R(0.05), MCT_R(0.02)}, {MCT_R(11.0), MCT_R(17.0)}};
    const mct_real mass[] = {MCT_R(1.5)};
    const mct_gauss_system system = {1, 1, mass, place_pendulum, &shaken};
    const mct_real force[] = {MCT_R(0.0), MCT_R(-1.5 * GRAVITY), MCT_R(0.0)};
    const double friction = 0.2;
    for (int i = -20; i <= 20; i++) {
        const double time = 0.037 * (i + 20);
        const mct_real q[] = {MCT_R(0.15 * i)};
        const mct_real v[] = {MCT_R(1.0 - 0.2 * i)};
        const mct_real couple[] = {MCT_R(-friction) * v[0]};
        TEST_ASSERT_EQUAL_INT(MCT_OK, move(&system, time, q, v, force, couple));
        const double angle = (double)q[0];
        const double rate = (double)v[0];
        const double now = (double)MCT_R(time);
        const double base_rate[2] = {0.05 * 11 * cos(11 * now), -0.02 * 17 * sin(17 * now)};
        const double base_acceleration[2] = {-0.05 * 121 * sin(11 * now), -0.02 * 289 * cos(17 * now)};
        const double wanted = (GRAVITY + base_acceleration[1]) / 0.7 * sin(angle) -
                              base_acceleration[0] / 0.7 * cos(angle) - friction / (1.5 * 0.49) * rate;
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(40), wanted, (double)motion.acceleration[0]);
        const double velocity[2] = {0.7 * rate * cos(angle) + base_rate[0],
                                    -0.7 * rate * sin(angle) + base_rate[1]};
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(4), velocity[0], (double)motion.velocity[0][0]);
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(4), velocity[1], (double)motion.velocity[0][1]);
        /* (186): the matrix C is 0, yet the base presses */
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(4), 0.0, (double)motion.C[0][0] * rate);
        const double pressed =
            1.5 * 0.7 * (cos(angle) * base_acceleration[0] - sin(angle) * base_acceleration[1]);
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(20), pressed, (double)motion.Cv[0]);
        /* the base works through e: e . xd exceeds what the couple does by e . ud */
        const mct_real *const e = motion.constraint_force[0];
        const double by_base = (double)e[0] * base_rate[0] + (double)e[1] * base_rate[1];
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(100), by_base - friction * rate * rate, dot3(e, motion.velocity[0]));
    }
}

/* ---- the spring pendulum (1.3) ---- */

static void place_spring_pendulum(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                                  mct_hyperdual (*position)[3])
{
    (void)context;
    (void)time;
    position[0][0] = mct_hyperdual_mul(q[0], mct_hyperdual_cos(q[1]));
    position[0][1] = mct_hyperdual_mul(q[0], mct_hyperdual_sin(q[1]));
    position[0][2] = mct_hyperdual_constant(MCT_R(0.0));
}

static void test_spring_pendulum_has_the_matrices_42_and_47(void)
{
    const mct_real mass[] = {MCT_R(1.2)};
    const mct_gauss_system system = {1, 2, mass, place_spring_pendulum, NULL};
    const mct_real q[] = {MCT_R(0.8), MCT_R(1.1)};
    const mct_real v[] = {MCT_R(-0.6), MCT_R(2.5)};
    const mct_real force[] = {MCT_R(0.0), MCT_R(-1.2 * GRAVITY), MCT_R(0.0)};
    const mct_real couple[] = {MCT_R(-30.0 * 0.8), MCT_R(0.4)}; /* spring (49), torque (48) */
    TEST_ASSERT_EQUAL_INT(MCT_OK, move(&system, 0.0, q, v, force, couple));
    const double M[2][2] = {{1.2, 0}, {0, 1.2 * 0.64}};
    const double C[2][2] = {{0, -1.2 * 0.8 * 2.5}, {1.2 * 0.8 * 2.5, 1.2 * 0.8 * -0.6}};
    const double Cv[2] = {-1.2 * 0.8 * 2.5 * 2.5, 2 * 1.2 * 0.8 * -0.6 * 2.5};
    const double tau[2] = {-24 - 1.2 * GRAVITY * sin(1.1), 0.4 - 1.2 * GRAVITY * 0.8 * cos(1.1)};
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(4), M[i][j], (double)motion.M[i][j]);
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(4), C[i][j], (double)motion.C[i][j]);
        }
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(8), Cv[i], (double)motion.Cv[i]);
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(40), tau[i], (double)motion.tau[i]);
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(40), (tau[i] - Cv[i]) / M[i][i], (double)motion.acceleration[i]);
    }
}

static void test_a_mass_matrix_without_inverse_is_reported(void)
{
    const mct_real mass[] = {MCT_R(1.2)};
    const mct_gauss_system system = {1, 2, mass, place_spring_pendulum, NULL};
    const mct_real q[] = {MCT_R(0.0), MCT_R(1.1)}; /* at the pivot the angle moves nothing */
    const mct_real v[] = {MCT_R(1.0), MCT_R(2.0)};
    const mct_real force[] = {MCT_R(0.0), MCT_R(-5.0), MCT_R(0.0)};
    motion.acceleration[0] = MCT_R(7.0);
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_kinematics(&system, MCT_R(0.0), q, v, &workspace, &motion));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, mct_gauss_dynamics(&system, force, NULL, &workspace, &motion));
    TEST_ASSERT_DOUBLE_WITHIN(NEAR(5), -5 * sin(1.1), (double)motion.tau[0]);
    TEST_ASSERT_TRUE(motion.acceleration[0] == MCT_R(7.0));
}

/* ---- two linked particles (2.2) ---- */

static void place_linked(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                         mct_hyperdual (*position)[3])
{
    const mct_real *const separation = context;
    const mct_hyperdual zero = mct_hyperdual_constant(MCT_R(0.0));
    (void)time;
    for (int i = 0; i < 2; i++) {
        position[i][0] = mct_hyperdual_add(q[0], mct_hyperdual_constant((mct_real)i * *separation));
        position[i][1] = zero;
        position[i][2] = zero;
    }
}

static void test_a_link_shares_a_push_by_mass_as_in_103_corrected(void)
{
    const mct_real separation = MCT_R(0.3);
    const mct_real mass[] = {MCT_R(1.0), MCT_R(3.0)};
    const mct_gauss_system system = {2, 1, mass, place_linked, &separation};
    const mct_real q[] = {MCT_R(0.1)};
    const mct_real v[] = {MCT_R(0.4)};
    const mct_real force[] = {MCT_R(8.0), MCT_R(1.0), MCT_R(-2.0), MCT_R(0.0), MCT_R(0.0), MCT_R(0.0)};
    TEST_ASSERT_EQUAL_INT(MCT_OK, move(&system, 0.0, q, v, force, NULL));
    TEST_ASSERT_DOUBLE_WITHIN(NEAR(2), 8.0 / 4.0, (double)motion.acceleration[0]);
    const double wanted[2][3] = {{-3.0 / 4.0 * 8.0, -1.0, 2.0}, {3.0 / 4.0 * 8.0, 0.0, 0.0}};
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 3; k++) {
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(8), wanted[i][k], (double)motion.constraint_force[i][k]);
        }
    }
}

/* ---- the cart-pole (2.4) ---- */

static void place_cart_pole(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                            mct_hyperdual (*position)[3])
{
    const mct_real *const length = context;
    const mct_hyperdual zero = mct_hyperdual_constant(MCT_R(0.0));
    (void)time;
    position[0][0] = q[0];
    position[0][1] = zero;
    position[0][2] = zero;
    position[1][0] = mct_hyperdual_add(q[0], mct_hyperdual_scale(*length, mct_hyperdual_sin(q[1])));
    position[1][1] = mct_hyperdual_scale(*length, mct_hyperdual_cos(q[1]));
    position[1][2] = zero;
}

static void test_cart_pole_with_joint_friction_obeys_its_closed_form(void)
{
    const double m1 = 1.0;
    const double m2 = 0.25;
    const double l = 0.5;
    const mct_real length = MCT_R(l);
    const mct_real mass[] = {MCT_R(m1), MCT_R(m2)};
    const mct_gauss_system system = {2, 2, mass, place_cart_pole, &length};
    for (int i = 0; i < 40; i++) {
        const mct_real q[] = {MCT_R(0.1 * i), MCT_R(0.3 * i - 6.0)};
        const mct_real v[] = {MCT_R(1.0 - 0.1 * i), MCT_R(0.2 * i - 3.0)};
        const mct_real force[] = {MCT_R(2.0), MCT_R(-m1 * GRAVITY), MCT_R(0.0),
                                  MCT_R(0.0), MCT_R(-m2 * GRAVITY), MCT_R(0.0)};
        const mct_real couple[] = {MCT_R(-0.1) * v[0], MCT_R(-0.05) * v[1]};
        TEST_ASSERT_EQUAL_INT(MCT_OK, move(&system, 0.0, q, v, force, couple));
        const double s = sin((double)q[1]);
        const double c = cos((double)q[1]);
        const double rate = (double)v[1];
        const double M[2][2] = {{m1 + m2, m2 * l * c}, {m2 * l * c, m2 * l * l}};
        const double rest[2] = {2.0 - 0.1 * (double)v[0] + m2 * l * rate * rate * s,
                                m2 * GRAVITY * l * s - 0.05 * rate};
        const double determinant = m2 * l * l * (m1 + m2 * s * s);
        const double a[2] = {(M[1][1] * rest[0] - M[0][1] * rest[1]) / determinant,
                             (M[0][0] * rest[1] - M[0][1] * rest[0]) / determinant};
        for (int j = 0; j < 2; j++) {
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(2), M[j][0], (double)motion.M[j][0]);
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(2), M[j][1], (double)motion.M[j][1]);
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(8), rest[j], (double)motion.tau[j] - (double)motion.Cv[j]);
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(100), a[j], (double)motion.acceleration[j]);
        }
    }
}

/* ---- a particle under no constraint ---- */

static void place_freely(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                         mct_hyperdual (*position)[3])
{
    (void)context;
    (void)time;
    memcpy(position[0], q, 3 * sizeof *q);
}

static void test_a_particle_under_no_constraint_feels_none(void)
{
    const mct_real mass[] = {MCT_R(4.0)};
    const mct_gauss_system system = {1, 3, mass, place_freely, NULL};
    const mct_real q[] = {MCT_R(1.0), MCT_R(2.0), MCT_R(3.0)};
    const mct_real v[] = {MCT_R(-1.0), MCT_R(0.5), MCT_R(0.25)};
    const mct_real force[] = {MCT_R(1.0), MCT_R(-39.0), MCT_R(2.0)};
    TEST_ASSERT_EQUAL_INT(MCT_OK, move(&system, 0.0, q, v, force, NULL));
    for (int k = 0; k < 3; k++) {
        TEST_ASSERT_TRUE(motion.velocity[0][k] == v[k]);
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(10), (double)force[k] / 4.0, (double)motion.acceleration[k]);
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(10), 0.0, (double)motion.constraint_force[0][k]);
    }
}

/* ---- a spatial chain of universal joints, up to the engine's bounds, at will on a turning table ---- */

typedef struct {
    int particles;
    int coordinates;
    mct_real table_rate; /* [rad/s] */
} chain;

static void place_chain(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                        mct_hyperdual (*position)[3])
{
    const chain *const self = context;
    mct_hyperdual x[3] = {mct_hyperdual_constant(MCT_R(0.2)), mct_hyperdual_constant(MCT_R(0.0)),
                          mct_hyperdual_constant(MCT_R(0.1))};
    mct_hyperdual sine;
    mct_hyperdual cosine;
    mct_hyperdual_sincos(mct_hyperdual_scale(self->table_rate, time), &sine, &cosine);
    for (int i = 0; i < self->particles; i++) {
        const mct_hyperdual tilt = q[(2 * i) % self->coordinates];
        const mct_hyperdual turn = q[(2 * i + 1) % self->coordinates];
        const mct_real length = MCT_R(0.5) + MCT_R(0.1) * (mct_real)(i % 5);
        const mct_hyperdual reach = mct_hyperdual_scale(length, mct_hyperdual_sin(tilt));
        x[0] = mct_hyperdual_add(x[0], mct_hyperdual_mul(reach, mct_hyperdual_cos(turn)));
        x[1] = mct_hyperdual_sub(x[1], mct_hyperdual_scale(length, mct_hyperdual_cos(tilt)));
        x[2] = mct_hyperdual_add(x[2], mct_hyperdual_mul(reach, mct_hyperdual_sin(turn)));
        position[i][0] = mct_hyperdual_add(mct_hyperdual_mul(cosine, x[0]), mct_hyperdual_mul(sine, x[2]));
        position[i][1] = x[1];
        position[i][2] = mct_hyperdual_sub(mct_hyperdual_mul(cosine, x[2]), mct_hyperdual_mul(sine, x[0]));
    }
}

enum { P = MCT_GAUSS_MAX_PARTICLES, D = MCT_GAUSS_MAX_COORDINATES, TRIALS = 40 };

/* A chain in a random state under random forces and couples. */
typedef struct {
    chain shape;
    mct_gauss_system system;
    mct_real mass[P];
    mct_real q[D];
    mct_real v[D];
    mct_real force[3 * P];
    mct_real couple[D];
} scene;

static void make_scene(scene *self, int particles, int coordinates, double table_rate)
{
    self->shape = (chain){particles, coordinates, MCT_R(table_rate)};
    self->system = (mct_gauss_system){particles, coordinates, self->mass, place_chain, &self->shape};
    fill_randomly(D, self->q);
    fill_randomly(D, self->v);
    fill_randomly(3 * P, self->force);
    fill_randomly(D, self->couple);
    for (int i = 0; i < P; i++) {
        self->mass[i] = MCT_R(1.2) + random_number();
    }
}

static mct_status move_scene(const scene *self)
{
    return move(&self->system, 0.3, self->q, self->v, self->force, self->couple);
}

/* Size of the forces in play: what roundings are relative to. */
static double force_size(const scene *self)
{
    double size = 1.0;
    for (int i = 0; i < self->system.particle_count; i++) {
        const mct_real *const a = motion.particle_acceleration[i];
        const mct_real *const f = self->force + 3 * i;
        size += (double)self->mass[i] * sqrt(dot3(a, a)) + sqrt(dot3(f, f));
    }
    return size;
}

static void test_the_equation_of_motion_holds_for_any_chain(void)
{
    for (int trial = 0; trial < TRIALS; trial++) {
        scene s;
        make_scene(&s, trial % 2 ? P : 5, trial % 3 ? D : 4, 0.7 * (trial % 4));
        TEST_ASSERT_EQUAL_INT(MCT_OK, move_scene(&s));
        for (int i = 0; i < s.system.coordinate_count; i++) {
            double residual = (double)motion.Cv[i] - (double)motion.tau[i];
            double size = fabs((double)motion.Cv[i]) + fabs((double)motion.tau[i]);
            for (int j = 0; j < s.system.coordinate_count; j++) {
                residual += (double)motion.M[i][j] * (double)motion.acceleration[j];
                size += fabs((double)motion.M[i][j] * (double)motion.acceleration[j]);
            }
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(size), 0.0, residual);
        }
    }
}

static void test_the_residual_of_the_least_squares_is_the_constraint_force(void)
{
    for (int trial = 0; trial < TRIALS; trial++) {
        scene s;
        make_scene(&s, trial % 2 ? P : 5, trial % 3 ? D : 4, 0.7 * (trial % 4));
        TEST_ASSERT_EQUAL_INT(MCT_OK, move_scene(&s));
        for (int i = 0; i < s.system.particle_count; i++) {
            for (int k = 0; k < 3; k++) {
                const double e = (double)s.mass[i] * (double)motion.particle_acceleration[i][k] -
                                 (double)s.force[3 * i + k];
                TEST_ASSERT_DOUBLE_WITHIN(NEAR(force_size(&s)), e, (double)motion.constraint_force[i][k]);
            }
        }
    }
}

static void test_static_constraints_pass_on_couples_and_do_no_work_of_their_own(void)
{
    for (int trial = 0; trial < TRIALS; trial++) {
        scene s;
        make_scene(&s, trial % 2 ? P : 5, trial % 3 ? D : 4, 0.0);
        for (int coupled = 0; coupled < 2; coupled++) {
            const mct_real *const couple = coupled ? s.couple : NULL;
            TEST_ASSERT_EQUAL_INT(MCT_OK, move(&s.system, 0.3, s.q, s.v, s.force, couple));
            double power = 0.0;
            double fastest = 0.0;
            for (int i = 0; i < s.system.particle_count; i++) {
                power += dot3(motion.constraint_force[i], motion.velocity[i]);
                fastest = fmax(fastest, sqrt(dot3(motion.velocity[i], motion.velocity[i])));
            }
            double wanted = 0.0;
            for (int j = 0; coupled && j < s.system.coordinate_count; j++) {
                wanted += (double)s.couple[j] * (double)s.v[j];
            }
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(force_size(&s) * fastest), wanted, power);
        }
    }
}

static void test_no_other_acceleration_needs_a_smaller_constraint(void)
{
    for (int trial = 0; trial < TRIALS; trial++) {
        scene s;
        make_scene(&s, 6, 4, 0.7 * (trial % 4));
        TEST_ASSERT_EQUAL_INT(MCT_OK, move(&s.system, 0.3, s.q, s.v, s.force, NULL));
        /* J from two motions that differ by one rate: xd is linear in v */
        double J[18][4];
        const mct_gauss_motion actual = motion;
        for (int j = 0; j < 4; j++) {
            mct_real other[D];
            memcpy(other, s.v, sizeof other);
            other[j] += MCT_R(1.0);
            TEST_ASSERT_EQUAL_INT(MCT_OK, move(&s.system, 0.3, s.q, other, NULL, NULL));
            for (int row = 0; row < 18; row++) {
                const double before = (double)actual.velocity[row / 3][row % 3];
                J[row][j] = (double)motion.velocity[row / 3][row % 3] - before;
            }
        }
        for (int attempt = 0; attempt < 10; attempt++) {
            mct_real change[4];
            fill_randomly(4, change);
            double least = 0.0;
            double constraint = 0.0; /* sum |e|^2 / m, (77) */
            for (int row = 0; row < 18; row++) {
                const double mass = (double)s.mass[row / 3];
                const double e = (double)actual.constraint_force[row / 3][row % 3];
                double moved = e;
                for (int j = 0; j < 4; j++) {
                    moved += mass * J[row][j] * (double)change[j];
                }
                least += e * e / mass;
                constraint += moved * moved / mass;
            }
            TEST_ASSERT_TRUE(constraint > least);
        }
    }
}

static void test_mass_matrix_is_symmetric_to_the_bit_and_its_energy_that_of_the_particles(void)
{
    for (int trial = 0; trial < TRIALS; trial++) {
        scene s;
        make_scene(&s, trial % 2 ? P : 5, trial % 3 ? D : 4, 0.0);
        TEST_ASSERT_EQUAL_INT(MCT_OK, move_scene(&s));
        double twice_energy = 0.0;
        for (int i = 0; i < s.system.coordinate_count; i++) {
            TEST_ASSERT_TRUE(motion.M[i][i] > MCT_R(0.0));
            for (int j = 0; j < s.system.coordinate_count; j++) {
                TEST_ASSERT_TRUE(motion.M[i][j] == motion.M[j][i]);
                twice_energy += (double)s.v[i] * (double)motion.M[i][j] * (double)s.v[j];
            }
        }
        double of_particles = 0.0;
        for (int i = 0; i < s.system.particle_count; i++) {
            of_particles += (double)s.mass[i] * dot3(motion.velocity[i], motion.velocity[i]);
        }
        TEST_ASSERT_DOUBLE_WITHIN(NEAR(1 + of_particles), of_particles, twice_energy);
    }
}

static void test_the_matrix_C_times_the_rates_is_the_whole_bias_without_explicit_time(void)
{
    for (int trial = 0; trial < TRIALS; trial++) {
        scene s;
        make_scene(&s, trial % 2 ? P : 5, trial % 3 ? D : 4, 0.0);
        TEST_ASSERT_EQUAL_INT(MCT_OK, move_scene(&s));
        for (int i = 0; i < s.system.coordinate_count; i++) {
            double Cv = 0.0;
            double size = 1.0;
            for (int j = 0; j < s.system.coordinate_count; j++) {
                Cv += (double)motion.C[i][j] * (double)s.v[j];
                size += fabs((double)motion.C[i][j] * (double)s.v[j]);
            }
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(size), (double)motion.Cv[i], Cv);
        }
    }
}

static void test_C_plus_its_transpose_is_the_rate_of_the_mass_matrix(void)
{
    for (int trial = 0; trial < 10; trial++) {
        scene s;
        make_scene(&s, 5, 4, 0.0);
        TEST_ASSERT_EQUAL_INT(MCT_OK, move_scene(&s));
        const mct_gauss_motion now = motion;
        /* central difference along the motion: truncation h^2, rounding eps / h */
        const double h = MCT_REAL_IS_FLOAT ? 4e-3 : 1e-5;
        mct_gauss_motion side[2];
        for (int k = 0; k < 2; k++) {
            mct_real q[D];
            for (int j = 0; j < D; j++) {
                q[j] = s.q[j] + MCT_R(k == 0 ? -h : h) * s.v[j];
            }
            TEST_ASSERT_EQUAL_INT(MCT_OK, move(&s.system, 0.3, q, s.v, NULL, NULL));
            side[k] = motion;
        }
        for (int i = 0; i < 4; i++) {
            for (int j = 0; j < 4; j++) {
                const double rate = ((double)side[1].M[i][j] - (double)side[0].M[i][j]) / (2 * h);
                const double sum = (double)now.C[i][j] + (double)now.C[j][i];
                TEST_ASSERT_DOUBLE_WITHIN(100 * h * h + 50 * EPSILON / h, rate, sum);
            }
        }
    }
}

/* ---- C from the derivatives of M (3.0.3) ---- */

static void test_the_spring_pendulum_tells_the_two_forms_of_C_apart(void)
{
    const mct_real mass[] = {MCT_R(1.2)};
    const mct_gauss_system system = {1, 2, mass, place_spring_pendulum, NULL};
    const mct_real q[] = {MCT_R(0.8), MCT_R(1.1)};
    const mct_real v[] = {MCT_R(-0.6), MCT_R(2.5)};
    const double m_l = 1.2 * 0.8; /* M = diag(m, m l^2) */
    const double C[2][2] = {{0, -m_l * 2.5}, {m_l * 2.5, m_l * -0.6}};
    const double C_alternative[2][2] = {{0, -m_l * 2.5}, {0, 2 * m_l * -0.6}};
    mct_gauss_lagrange form;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_kinematics(&system, MCT_R(0.0), q, v, &workspace, &motion));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_christoffel(&system, MCT_R(0.0), q, v, &workspace, &form));
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2; j++) {
            const double by_length = i == 1 && j == 1 ? 2 * m_l : 0;
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(4), by_length, (double)form.M_by[0][i][j]);
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(4), 0, (double)form.M_by[1][i][j]);
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(4), C[i][j], (double)form.C[i][j]);
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(4), C_alternative[i][j], (double)form.C_alternative[i][j]);
        }
    }
}

static void test_C_from_the_derivatives_of_M_is_that_of_the_motion(void)
{
    for (int trial = 0; trial < TRIALS; trial++) {
        scene s;
        mct_gauss_lagrange form;
        make_scene(&s, trial % 2 ? P : 5, trial % 3 ? D : 4, 0.0);
        TEST_ASSERT_EQUAL_INT(MCT_OK, move_scene(&s));
        TEST_ASSERT_EQUAL_INT(MCT_OK,
                              mct_gauss_christoffel(&s.system, MCT_R(0.3), s.q, s.v, &workspace, &form));
        const int count = s.system.coordinate_count;
        for (int i = 0; i < count; i++) {
            double size = 1, by_christoffel = 0, by_alternative = 0;
            for (int j = 0; j < count; j++) {
                for (int k = 0; k < count; k++) {
                    size += fabs((double)form.M_by[k][i][j]) + fabs((double)form.M_by[i][j][k]);
                }
                by_christoffel += (double)form.C[i][j] * (double)s.v[j];
                by_alternative += (double)form.C_alternative[i][j] * (double)s.v[j];
            }
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(size), (double)motion.Cv[i], by_christoffel);
            TEST_ASSERT_DOUBLE_WITHIN(NEAR(size), (double)motion.Cv[i], by_alternative);
            for (int j = 0; j < count; j++) {
                double M_rate_less_2C[2] = {-2 * (double)form.C[i][j], -2 * (double)form.C[j][i]};
                for (int k = 0; k < count; k++) {
                    M_rate_less_2C[0] += (double)form.M_by[k][i][j] * (double)s.v[k];
                    M_rate_less_2C[1] += (double)form.M_by[k][j][i] * (double)s.v[k];
                }
                TEST_ASSERT_DOUBLE_WITHIN(NEAR(size), (double)motion.C[i][j], (double)form.C[i][j]);
                TEST_ASSERT_DOUBLE_WITHIN(NEAR(size), -M_rate_less_2C[1], M_rate_less_2C[0]);
            }
        }
    }
}

/* The base of this chain moves with time: M depends on q all the same. Central differences, as above. */
static void test_derivatives_of_M_are_those_of_its_differences(void)
{
    enum { N = 4 };
    const double h = MCT_REAL_IS_FLOAT ? 4e-3 : 1e-5;
    scene s;
    mct_gauss_lagrange form;
    make_scene(&s, 5, N, 0.7);
    TEST_ASSERT_EQUAL_INT(MCT_OK, move_scene(&s));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_christoffel(&s.system, MCT_R(0.3), s.q, s.v, &workspace, &form));
    for (int k = 0; k < N; k++) {
        mct_real side[2][MCT_GAUSS_MAX_COORDINATES][MCT_GAUSS_MAX_COORDINATES];
        for (int which = 0; which < 2; which++) {
            mct_real q[D];
            memcpy(q, s.q, sizeof q);
            q[k] += MCT_R(which == 0 ? -h : h);
            TEST_ASSERT_EQUAL_INT(MCT_OK, move(&s.system, 0.3, q, s.v, NULL, NULL));
            memcpy(side[which], motion.M, sizeof motion.M);
        }
        for (int i = 0; i < N; i++) {
            for (int j = 0; j < N; j++) {
                const double slope = ((double)side[1][i][j] - (double)side[0][i][j]) / (2 * h);
                TEST_ASSERT_DOUBLE_WITHIN(100 * h * h + 50 * EPSILON / h, slope, (double)form.M_by[k][i][j]);
            }
        }
    }
}

static void place_growing_pendulum(const void *context, mct_hyperdual time, const mct_hyperdual *q,
                                   mct_hyperdual (*position)[3])
{
    (void)context;
    position[0][0] = mct_hyperdual_mul(time, mct_hyperdual_sin(q[0]));
    position[0][1] = mct_hyperdual_mul(time, mct_hyperdual_cos(q[0]));
    position[0][2] = mct_hyperdual_constant(MCT_R(0.0));
}

/* Of length t: M = m t^2 changes with time, not with the angle. */
static void test_time_does_not_enter_the_derivatives_of_M(void)
{
    const mct_real mass[] = {MCT_R(1.2)}, q[] = {MCT_R(0.8)}, v[] = {MCT_R(3.0)};
    const mct_gauss_system system = {1, 1, mass, place_growing_pendulum, NULL};
    mct_gauss_lagrange form;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_kinematics(&system, MCT_R(2.0), q, v, &workspace, &motion));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_gauss_christoffel(&system, MCT_R(2.0), q, v, &workspace, &form));
    TEST_ASSERT_DOUBLE_WITHIN(NEAR(5), 0, (double)form.M_by[0][0][0]);
    TEST_ASSERT_DOUBLE_WITHIN(NEAR(15), 0, (double)form.C[0][0]);
    TEST_ASSERT_DOUBLE_WITHIN(NEAR(20), 2 * 1.2 * 2 * 3,
                              (double)motion.Cv[0]); /* 2 m l ld thd, all of time */
}

static void test_a_rate_that_is_not_finite_has_no_C(void)
{
    scene s;
    mct_gauss_lagrange form;
    make_scene(&s, 5, 4, 0.0);
    TEST_ASSERT_EQUAL_INT(MCT_OK, move_scene(&s));
    s.v[2] = (mct_real)NAN;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE,
                          mct_gauss_christoffel(&s.system, MCT_R(0.3), s.q, s.v, &workspace, &form));
}

static void test_bad_systems_are_refused(void)
{
    scene s;
    make_scene(&s, 5, 4, 0.0);
    mct_gauss_system bad = s.system;
    bad.particle_count = 0;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, move(&bad, 0.0, s.q, s.v, NULL, NULL));
    bad.particle_count = P + 1;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, move(&bad, 0.0, s.q, s.v, NULL, NULL));
    bad = s.system;
    bad.coordinate_count = 0;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, move(&bad, 0.0, s.q, s.v, NULL, NULL));
    bad.coordinate_count = D + 1;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_BOUND, move(&bad, 0.0, s.q, s.v, NULL, NULL));
    bad = s.system;
    bad.place = NULL;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, move(&bad, 0.0, s.q, s.v, NULL, NULL));
    s.mass[2] = MCT_R(0.0);
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, move_scene(&s));
    s.mass[2] = (mct_real)NAN;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, move_scene(&s));
    make_scene(&s, 5, 4, 0.0);
    s.q[1] = (mct_real)NAN;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, move_scene(&s));
    make_scene(&s, 5, 4, 0.0);
    s.v[0] = (mct_real)INFINITY;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, move_scene(&s));
    make_scene(&s, 5, 4, 0.0);
    s.force[7] = (mct_real)NAN;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, move_scene(&s));
    make_scene(&s, 1, 4, 0.0); /* more coordinates than a particle has directions */
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_SINGULAR, move_scene(&s));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_pendulum_is_held_by_the_constraint_force_of_equation_38);
    RUN_TEST(test_pendulum_on_a_moving_base_obeys_equation_187);
    RUN_TEST(test_spring_pendulum_has_the_matrices_42_and_47);
    RUN_TEST(test_a_mass_matrix_without_inverse_is_reported);
    RUN_TEST(test_a_link_shares_a_push_by_mass_as_in_103_corrected);
    RUN_TEST(test_cart_pole_with_joint_friction_obeys_its_closed_form);
    RUN_TEST(test_a_particle_under_no_constraint_feels_none);
    RUN_TEST(test_the_equation_of_motion_holds_for_any_chain);
    RUN_TEST(test_the_residual_of_the_least_squares_is_the_constraint_force);
    RUN_TEST(test_static_constraints_pass_on_couples_and_do_no_work_of_their_own);
    RUN_TEST(test_no_other_acceleration_needs_a_smaller_constraint);
    RUN_TEST(test_mass_matrix_is_symmetric_to_the_bit_and_its_energy_that_of_the_particles);
    RUN_TEST(test_the_matrix_C_times_the_rates_is_the_whole_bias_without_explicit_time);
    RUN_TEST(test_C_plus_its_transpose_is_the_rate_of_the_mass_matrix);
    RUN_TEST(test_the_spring_pendulum_tells_the_two_forms_of_C_apart);
    RUN_TEST(test_C_from_the_derivatives_of_M_is_that_of_the_motion);
    RUN_TEST(test_derivatives_of_M_are_those_of_its_differences);
    RUN_TEST(test_time_does_not_enter_the_derivatives_of_M);
    RUN_TEST(test_a_rate_that_is_not_finite_has_no_C);
    RUN_TEST(test_bad_systems_are_refused);
    return UNITY_END();
}

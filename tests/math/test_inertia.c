/*
 * The rules of include/mctau/inertia.h (source, sections 5.4 and 5.6); equation numbers are those of the
 * source.
 */
#include <float.h>
#include <math.h>
#include <stdbool.h>

#include "mctau/inertia.h"
#include "support/random.h"
#include "unity.h"

#define EPSILON DBL_EPSILON

enum { TRIALS = TEST_CASES(2000), PARTICLES = 7 };

void setUp(void)
{
}

void tearDown(void)
{
}

static double size_of(const double *inertia)
{
    return fabs(inertia[0]) + fabs(inertia[4]) + fabs(inertia[8]);
}

static void assert_near(const double *wanted, const double *found, int count, double tolerance)
{
    for (int i = 0; i < count; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(tolerance, wanted[i], found[i]);
    }
}

static void random_particles(test_random *random, double size, double *mass, double (*position)[3])
{
    for (int k = 0; k < PARTICLES; k++) {
        mass[k] = random_scale(random, 0.01, 10);
        for (int i = 0; i < 3; i++) {
            position[k][i] = size * random_in(random, -1, 1);
        }
    }
}

/* I about a point by its definition, u'I u = sum m |u x b|^2, for u = e_i + e_j: no matrices. */
static void inertia_by_definition(const double *mass, double (*position)[3], const double *point,
                                  double *inertia)
{
    for (int entry = 0; entry < 9; entry++) {
        double energies[3] = {0}; /* of e_i + e_j, e_i, e_j */
        for (int k = 0; k < PARTICLES; k++) {
            for (int which = 0; which < 3; which++) {
                double u[3] = {0}, b[3];
                u[entry / 3] += which != 2;
                u[entry % 3] += which != 1;
                for (int i = 0; i < 3; i++) {
                    b[i] = position[k][i] - point[i];
                }
                for (int i = 0; i < 3; i++) {
                    const double moved = u[(i + 1) % 3] * b[(i + 2) % 3] - u[(i + 2) % 3] * b[(i + 1) % 3];
                    energies[which] += mass[k] * moved * moved;
                }
            }
        }
        inertia[entry] = (energies[0] - energies[1] - energies[2]) / 2;
    }
}

static void test_particles_have_the_inertia_of_their_definition_about_any_point(void)
{
    test_random random = {1};
    for (int trial = 0; trial < TRIALS; trial++) {
        double mass[PARTICLES], position[PARTICLES][3], wanted[9], found[9], total = 0;
        const double point[3] = {random_in(&random, -3, 3), random_in(&random, -3, 3), 0.5};
        mct_body body;
        random_particles(&random, 1, mass, position);
        TEST_ASSERT_EQUAL_INT(MCT_OK,
                              mct_body_of_particles(PARTICLES, mass, (const double(*)[3])position, &body));
        for (int k = 0; k < PARTICLES; k++) {
            total += mass[k];
        }
        TEST_ASSERT_DOUBLE_WITHIN(PARTICLES * EPSILON * total, total, body.mass);
        inertia_by_definition(mass, position, point, wanted);
        mct_inertia_about(&body, point, found);
        assert_near(wanted, found, 9, 64 * EPSILON * size_of(wanted));
        inertia_by_definition(mass, position, body.center, wanted);
        assert_near(wanted, body.inertia, 9, 64 * EPSILON * size_of(wanted));
    }
}

/* A millimetre's particles a kilometre away: the centre is known to roundings of the kilometre, 1e-13 m. */
static void test_a_body_far_from_the_origin_keeps_its_inertia(void)
{
    test_random random = {2};
    double mass[PARTICLES], position[PARTICLES][3];
    mct_body near, far;
    random_particles(&random, 1, mass, position);
    for (int k = 0; k < PARTICLES; k++) {
        for (int i = 0; i < 3; i++) {
            position[k][i] = 0x1p-20 * floor(1000 * position[k][i]); /* so that the shift is exact */
        }
    }
    TEST_ASSERT_EQUAL_INT(MCT_OK,
                          mct_body_of_particles(PARTICLES, mass, (const double(*)[3])position, &near));
    for (int k = 0; k < PARTICLES; k++) {
        position[k][0] += 1024;
    }
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_body_of_particles(PARTICLES, mass, (const double(*)[3])position, &far));
    assert_near(near.inertia, far.inertia, 9, 1e-9 * size_of(near.inertia));
}

/* 5.4.1, as corrected: 0.0011, 1.3667, 1.3667. */
static void test_the_rectangular_prism_of_the_source(void)
{
    const double size[] = {1, 0.04, 0.04}, point[] = {0.01, 0.02, 0.02};
    const double wanted[9] = {4.224 * 0.0032 / 12, 0, 0, 0, 1.3667456, 0, 0, 0, 1.3667456};
    mct_body box = {2640 * 1 * 0.04 * 0.04, {0.5, 0.02, 0.02}, {0}};
    double inertia[9];
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_shape_inertia(MCT_BOX, box.mass, size, box.inertia));
    mct_inertia_about(&box, point, inertia);
    assert_near(wanted, inertia, 9, 8 * EPSILON);
}

/* Mean squares by Simpson's rule over slices across axis 3; the rest of each shape is a disc or a hoop. */
static void slices(double radius, double length, bool is_ball, bool is_hollow, double *second)
{
    enum { N = 2000 };
    const double half = is_ball ? radius : length / 2;
    double mass = 0;
    second[0] = second[1] = second[2] = 0;
    for (int k = 0; k <= N; k++) {
        const double z = half * (2.0 * k / N - 1);
        const double across =
            is_ball ? radius * radius - z * z : radius * radius; /* squared radius of the slice */
        const double even = k == 0 || k == N ? 1 : k % 2 ? 4 : 2;
        /* a thin shell of a ball has equal mass in slices of equal thickness (Archimedes) */
        const double slice = even * (is_ball && !is_hollow ? across : 1);
        const double mean = across * (is_hollow ? 0.5 : 0.25);
        mass += slice;
        second[0] += slice * mean;
        second[2] += slice * z * z;
    }
    second[0] /= mass;
    second[1] = second[0];
    second[2] /= mass;
}

static void check_shape(mct_shape shape, const double *size, const double *second)
{
    const double mass = 3;
    double inertia[9];
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_shape_inertia(shape, mass, size, inertia));
    for (int i = 0; i < 9; i++) {
        const double wanted = i % 4 ? 0 : mass * (second[(i / 4 + 1) % 3] + second[(i / 4 + 2) % 3]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, wanted, inertia[i]); /* Simpson's rule is exact but for roundings */
    }
}

static void test_every_shape_has_the_moments_of_its_slices(void)
{
    const double size[] = {0.7, 1.9, 0.4};
    double second[3];
    slices(size[0], 0, true, false, second);
    check_shape(MCT_SOLID_SPHERE, size, second);
    slices(size[0], 0, true, true, second);
    check_shape(MCT_HOLLOW_SPHERE, size, second);
    slices(size[0], size[1], false, false, second);
    check_shape(MCT_CYLINDER, size, second);
    slices(size[0], size[1], false, true, second);
    check_shape(MCT_TUBE, size, second);
    slices(size[0], 0, false, false, second);
    check_shape(MCT_DISC, size, second);
    slices(size[0], 0, false, true, second);
    check_shape(MCT_HOOP, size, second);
    slices(0, size[0], false, false, second);
    check_shape(MCT_ROD, size, second);
    for (int i = 0; i < 3; i++) {
        double rod[3];
        slices(0, size[i], false, false, rod);
        second[i] = rod[2];
    }
    check_shape(MCT_BOX, size, second);
}

/* --- principal axes --- */

static void check_axes(const double *inertia, const double *moments, const double *axes)
{
    const double tolerance = 8 * EPSILON;
    for (int j = 0; j < 3; j++) {
        for (int i = 0; i < 3; i++) {
            double pushed = 0, product = 0, crossed = 0;
            for (int k = 0; k < 3; k++) {
                pushed += inertia[3 * i + k] * axes[3 * k + j];
                product += axes[3 * k + i] * axes[3 * k + j];
            }
            crossed = axes[3 * ((i + 1) % 3)] * axes[3 * ((i + 2) % 3) + 1] -
                      axes[3 * ((i + 2) % 3)] * axes[3 * ((i + 1) % 3) + 1];
            TEST_ASSERT_DOUBLE_WITHIN(tolerance * size_of(inertia), moments[j] * axes[3 * i + j], pushed);
            TEST_ASSERT_DOUBLE_WITHIN(tolerance, i == j, product);
            TEST_ASSERT_DOUBLE_WITHIN(tolerance, crossed, axes[3 * i + 2]); /* right-handed */
        }
    }
}

static void test_the_point_mass_of_equation_370_has_one_axis_through_it_and_any_two_across(void)
{
    const double m = 2, d = 0.3;
    const double inertia[9] = {m * d * d, -m * d * d, 0, -m * d * d, m * d * d, 0, 0, 0, 2 * m * d * d};
    const double point[1][3] = {{d, d, 0}}, origin[3] = {0};
    double found[9], moments[3], axes[9];
    mct_body body;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_body_of_particles(1, &m, point, &body));
    mct_inertia_about(&body, origin, found);
    assert_near(inertia, found, 9, 2 * EPSILON);

    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_principal_axes(inertia, moments, axes));
    check_axes(inertia, moments, axes);
    const int along = moments[0] < moments[1] ? 0 : 1;
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(2 * EPSILON, i == along ? 0 : 2 * m * d * d, moments[i]);
    }
    const double *through = axes + along; /* (1, 1, 0) / sqrt 2, where (371) prints 0.701 */
    TEST_ASSERT_DOUBLE_WITHIN(2 * EPSILON, sqrt(0.5), fabs(through[0]));
    TEST_ASSERT_DOUBLE_WITHIN(2 * EPSILON, through[0], through[3]);
    TEST_ASSERT_DOUBLE_WITHIN(2 * EPSILON, 0, through[6]);
}

/* p diag p' of random moments, some repeated or 0, over many orders of magnitude. */
static void test_principal_axes_are_those_of_any_inertia_repeated_moments_included(void)
{
    test_random random = {3};
    for (int trial = 0; trial < TRIALS; trial++) {
        double p[9], inertia[9] = {0}, moments[3], axes[9], wanted[3];
        const double size = random_scale(&random, 1e-150, 1e150);
        const double q[4] = {random_in(&random, -1, 1), random_in(&random, -1, 1), random_in(&random, -1, 1),
                             random_in(&random, 0.1, 1)};
        const double s = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            p[4 * i] = 1 - s * (q[j] * q[j] + q[k] * q[k]);
            p[3 * i + j] = s * (q[i] * q[j] - q[3] * q[k]);
            p[3 * i + k] = s * (q[i] * q[k] + q[3] * q[j]);
            wanted[i] =
                size * (trial % 7 == 6 ? random_scale(&random, 1e-12, 1) : random_in(&random, 0.5, 1));
        }
        if (trial % 3 == 1) {
            wanted[1] = wanted[0];
        } else if (trial % 5 == 1) {
            wanted[0] = 0;
            wanted[2] = wanted[1];
        }
        for (int i = 0; i < 9; i++) {
            for (int k = 0; k < 3; k++) {
                inertia[i] += p[i / 3 * 3 + k] * wanted[k] * p[i % 3 * 3 + k];
            }
        }
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_principal_axes(inertia, moments, axes));
        check_axes(inertia, moments, axes);
        for (int i = 0; i < 3; i++) { /* each of the wanted moments is among those found */
            double closest = DBL_MAX;
            for (int k = 0; k < 3; k++) {
                closest = fmin(closest, fabs(wanted[i] - moments[k]));
            }
            TEST_ASSERT_TRUE(closest <= 16 * EPSILON * size);
        }
    }
}

static void test_a_diagonal_inertia_keeps_its_axes(void)
{
    const double inertia[9] = {3, 0, 0, 0, 1, 0, 0, 0, 2}, identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double moments[3], axes[9];
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_principal_axes(inertia, moments, axes));
    TEST_ASSERT_EQUAL_MEMORY(identity, axes, sizeof axes);
    TEST_ASSERT_TRUE(moments[0] == 3 && moments[1] == 1 && moments[2] == 2);
}

/* --- what no body has --- */

static void test_an_inertia_that_no_body_has_is_refused_with_its_figures(void)
{
    mct_inertia_report report;
    double inertia[9] = {2, 0.5, 0, 0.5, 3, 0, 0, 0, 4};
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_inertia_check(inertia, &report));
    TEST_ASSERT_EQUAL_INT(MCT_INERTIA_PHYSICAL, report.fault);

    inertia[3] = 0.25;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_inertia_check(inertia, &report));
    TEST_ASSERT_EQUAL_INT(MCT_INERTIA_NOT_SYMMETRIC, report.fault);
    TEST_ASSERT_TRUE(report.row == 0 && report.column == 1 && report.found == 0.5 && report.bound == 0.25);

    inertia[3] = inertia[1] = 3; /* moments (5 +- sqrt 37)/2 */
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_inertia_check(inertia, &report));
    TEST_ASSERT_EQUAL_INT(MCT_INERTIA_NEGATIVE, report.fault);
    TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON, (5 - sqrt(37)) / 2, report.found);
    TEST_ASSERT_TRUE(report.bound == 0);

    inertia[3] = inertia[1] = 0;
    inertia[8] = 5.5;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_inertia_check(inertia, &report));
    TEST_ASSERT_EQUAL_INT(MCT_INERTIA_NOT_TRIANGLE, report.fault);
    TEST_ASSERT_TRUE(report.found == 5.5 && report.bound == 5 && report.moments[2] == 5.5);

    inertia[5] = NAN;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, mct_inertia_check(inertia, &report));
    TEST_ASSERT_EQUAL_INT(MCT_INERTIA_NOT_FINITE, report.fault);
    TEST_ASSERT_TRUE(report.row == 1 && report.column == 2);
}

static void test_points_rods_and_plates_are_physical(void)
{
    const double flat[9] = {1, 0, 0, 0, 2, 0, 0, 0, 3}, rod[9] = {0, 0, 0, 0, 2, 0, 0, 0, 2}, point[9] = {0};
    mct_inertia_report report;
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_inertia_check(flat, &report));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_inertia_check(rod, &report));
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_inertia_check(point, &report));
}

/* --- six particles for a body --- */

static void test_six_particles_have_the_mass_the_centre_and_the_inertia_of_the_body(void)
{
    test_random random = {4};
    for (int trial = 0; trial < TRIALS; trial++) {
        double mass[PARTICLES], position[PARTICLES][3], six[MCT_EQUIMOMENTAL_COUNT][3];
        double sixth[MCT_EQUIMOMENTAL_COUNT];
        mct_body body, again;
        random_particles(&random, random_scale(&random, 1e-3, 1e3), mass, position);
        for (int k = 0; k < PARTICLES; k++) {
            for (int i = 0; i < 3; i++) { /* every fourth body is flat, every other one of those a rod */
                position[k][i] *= (trial % 4 == 3 && i == 0) || (trial % 8 == 7 && i == 1) ? 0 : 1;
            }
        }
        TEST_ASSERT_EQUAL_INT(MCT_OK,
                              mct_body_of_particles(PARTICLES, mass, (const double(*)[3])position, &body));
        TEST_ASSERT_EQUAL_INT(MCT_OK, mct_equimomental_particles(&body, six));
        for (int k = 0; k < MCT_EQUIMOMENTAL_COUNT; k++) {
            sixth[k] = body.mass / MCT_EQUIMOMENTAL_COUNT;
        }
        TEST_ASSERT_EQUAL_INT(
            MCT_OK, mct_body_of_particles(MCT_EQUIMOMENTAL_COUNT, sixth, (const double(*)[3])six, &again));
        const double length = sqrt(size_of(body.inertia) / body.mass);
        TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON * body.mass, body.mass, again.mass);
        for (int i = 0; i < 3; i++) {
            TEST_ASSERT_DOUBLE_WITHIN(8 * EPSILON * (length + fabs(body.center[i])), body.center[i],
                                      again.center[i]);
        }
        const double reach = length + fabs(body.center[0]) + fabs(body.center[1]) + fabs(body.center[2]);
        assert_near(body.inertia, again.inertia, 9, 32 * EPSILON * body.mass * length * reach);
    }
}

static void test_bad_bodies_are_refused(void)
{
    const double mass[] = {1, -1}, none[] = {0, 0}, position[2][3] = {{0}},
                 far[2][3] = {{0}, {INFINITY, 0, 0}};
    const double fine[] = {1, 1}, negative[] = {1, -1, 1};
    double inertia[9], six[6][3];
    mct_body body;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, mct_body_of_particles(0, mass, position, &body));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_body_of_particles(2, mass, position, &body));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_body_of_particles(2, none, position, &body));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, mct_body_of_particles(2, fine, far, &body));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_ARGUMENT, mct_shape_inertia((mct_shape)8, 1, fine, inertia));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_shape_inertia(MCT_ROD, -1, fine, inertia));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_shape_inertia(MCT_TUBE, 1, negative, inertia));
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, mct_shape_inertia(MCT_DISC, NAN, fine, inertia));
    body = (mct_body){0};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_equimomental_particles(&body, six));
    body = (mct_body){1, {0}, {1, 0, 0, 0, 1, 0, 0, 0, 3}};
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_RANGE, mct_equimomental_particles(&body, six));
    body.inertia[0] = INFINITY;
    TEST_ASSERT_EQUAL_INT(MCT_ERROR_NOT_FINITE, mct_principal_axes(body.inertia, inertia, six[0]));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_particles_have_the_inertia_of_their_definition_about_any_point);
    RUN_TEST(test_a_body_far_from_the_origin_keeps_its_inertia);
    RUN_TEST(test_the_rectangular_prism_of_the_source);
    RUN_TEST(test_every_shape_has_the_moments_of_its_slices);
    RUN_TEST(test_the_point_mass_of_equation_370_has_one_axis_through_it_and_any_two_across);
    RUN_TEST(test_principal_axes_are_those_of_any_inertia_repeated_moments_included);
    RUN_TEST(test_a_diagonal_inertia_keeps_its_axes);
    RUN_TEST(test_an_inertia_that_no_body_has_is_refused_with_its_figures);
    RUN_TEST(test_points_rods_and_plates_are_physical);
    RUN_TEST(test_six_particles_have_the_mass_the_centre_and_the_inertia_of_the_body);
    RUN_TEST(test_bad_bodies_are_refused);
    return UNITY_END();
}

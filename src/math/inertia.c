#include "mctau/inertia.h"

#include <string.h>

#include "mctau/matrix.h"

#define MOST_SWEEPS 16
#define TOLERANCE   1e-9 /* of the trace */

/** inertia += m (b'b - b b') */
static void add_point(double mass, const double *b, double *inertia)
{
    const double square = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            inertia[3 * i + j] += mass * ((i == j ? square : 0) - b[i] * b[j]);
        }
    }
}

static bool all_finite(const double *numbers, int count)
{
    for (int i = 0; i < count; i++) {
        if (!mct_is_finite(numbers[i])) {
            return false;
        }
    }
    return true;
}

mct_status mct_body_of_particles(int count, const double *mass, const double (*position)[3], mct_body *body)
{
    if (count < 1) {
        return MCT_ERROR_ARGUMENT;
    }
    *body = (mct_body){0};
    for (int k = 0; k < count; k++) {
        if (mass[k] < 0) {
            return MCT_ERROR_RANGE;
        }
        body->mass += mass[k];
        for (int i = 0; i < 3; i++) {
            body->center[i] += mass[k] * position[k][i];
        }
    }
    if (body->mass == 0) {
        return MCT_ERROR_RANGE;
    }
    for (int i = 0; i < 3; i++) {
        body->center[i] /= body->mass;
    }
    for (int k = 0; k < count; k++) {
        double arm[3];
        for (int i = 0; i < 3; i++) {
            arm[i] = position[k][i] - body->center[i];
        }
        add_point(mass[k], arm, body->inertia);
    }
    return all_finite(body->inertia, 9) ? MCT_OK : MCT_ERROR_NOT_FINITE;
}

void mct_inertia_about(const mct_body *body, const double *point, double *inertia)
{
    double arm[3];
    for (int i = 0; i < 3; i++) {
        arm[i] = body->center[i] - point[i];
    }
    memcpy(inertia, body->inertia, sizeof body->inertia);
    add_point(body->mass, arm, inertia);
}

mct_status mct_shape_inertia(mct_shape shape, double mass, const double *size, double *inertia)
{
    /* Mean square of each coordinate = its factor times the square of one of the sizes. */
    static const struct {
        int size_count;
        int size[3];
        double factor[3];
    } shapes[] = {
        [MCT_BOX] = {3, {0, 1, 2}, {1.0 / 12, 1.0 / 12, 1.0 / 12}},
        [MCT_SOLID_SPHERE] = {1, {0, 0, 0}, {1.0 / 5, 1.0 / 5, 1.0 / 5}},
        [MCT_HOLLOW_SPHERE] = {1, {0, 0, 0}, {1.0 / 3, 1.0 / 3, 1.0 / 3}},
        [MCT_CYLINDER] = {2, {0, 0, 1}, {1.0 / 4, 1.0 / 4, 1.0 / 12}},
        [MCT_TUBE] = {2, {0, 0, 1}, {1.0 / 2, 1.0 / 2, 1.0 / 12}},
        [MCT_DISC] = {1, {0, 0, 0}, {1.0 / 4, 1.0 / 4, 0}},
        [MCT_HOOP] = {1, {0, 0, 0}, {1.0 / 2, 1.0 / 2, 0}},
        [MCT_ROD] = {1, {0, 0, 0}, {0, 0, 1.0 / 12}},
    };
    if ((int)shape < 0 || (size_t)shape >= sizeof shapes / sizeof *shapes) {
        return MCT_ERROR_ARGUMENT;
    }
    if (mass < 0) {
        return MCT_ERROR_RANGE;
    }
    for (int i = 0; i < shapes[shape].size_count; i++) {
        if (size[i] < 0) {
            return MCT_ERROR_RANGE;
        }
    }
    double second[3];
    for (int i = 0; i < 3; i++) {
        const double length = size[shapes[shape].size[i]];
        second[i] = mass * (shapes[shape].factor[i] * length * length);
    }
    for (int i = 0; i < 9; i++) {
        inertia[i] = i % 4 == 0 ? second[(i / 4 + 1) % 3] + second[(i / 4 + 2) % 3] : 0;
    }
    return all_finite(inertia, 9) ? MCT_OK : MCT_ERROR_NOT_FINITE;
}

/** Turns axes i and j by the smaller of the angles that clear entry (i, j): a <- t' a t, p <- p t. */
static void clear_entry(double *a, double *p, int i, int j)
{
    const int k = 3 - i - j;
    const double entry = a[3 * i + j];
    const double ratio = (a[4 * j] - a[4 * i]) / (2 * entry); /* cotangent of twice the angle */
    const double tangent = (ratio < 0 ? -1 : 1) / (mct_abs(ratio) + mct_sqrt(1 + ratio * ratio));
    const double c = 1 / mct_sqrt(1 + tangent * tangent);
    const double s = tangent * c;
    const double ik = a[3 * i + k];
    const double jk = a[3 * j + k];
    a[4 * i] -= tangent * entry;
    a[4 * j] += tangent * entry;
    a[3 * i + j] = a[3 * j + i] = 0;
    a[3 * i + k] = a[3 * k + i] = c * ik - s * jk;
    a[3 * j + k] = a[3 * k + j] = s * ik + c * jk;
    for (int row = 0; row < 9; row += 3) {
        const double pi = p[row + i];
        const double pj = p[row + j];
        p[row + i] = c * pi - s * pj;
        p[row + j] = s * pi + c * pj;
    }
}

mct_status mct_principal_axes(const double *inertia, double *moments, double *axes)
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double a[9], largest = 0;
    memcpy(axes, identity, sizeof identity);
    for (int i = 0; i < 9; i++) {
        a[i] = inertia[i % 3 < i / 3 ? 3 * (i % 3) + i / 3 : i];
        largest = mct_max(largest, mct_abs(a[i]));
    }
    if (!all_finite(a, 9)) {
        return MCT_ERROR_NOT_FINITE;
    }
    const double scale = largest > 0 ? largest : 1; /* so that no square overflows or vanishes */
    for (int i = 0; i < 9; i++) {
        a[i] /= scale;
    }
    for (int sweep = 0; sweep < MOST_SWEEPS; sweep++) {
        bool is_diagonal = true;
        for (int k = 2; k >= 0; k--) { /* entries 12, 13, 23 */
            const int i = k == 0 ? 1 : 0;
            const int j = 3 - i - k;
            if (mct_abs(a[3 * i + j]) > 0x1p-60) { /* far below a rounding of the largest moment */
                is_diagonal = false;
                clear_entry(a, axes, i, j);
            }
        }
        if (is_diagonal) {
            for (int i = 0; i < 3; i++) {
                moments[i] = scale * a[4 * i];
            }
            return MCT_OK;
        }
    }
    return MCT_ERROR_NO_CONVERGENCE;
}

static mct_status fault(mct_inertia_report *report, mct_inertia_fault what, double found, double bound)
{
    report->fault = what;
    report->found = found;
    report->bound = bound;
    return what == MCT_INERTIA_NOT_FINITE ? MCT_ERROR_NOT_FINITE : MCT_ERROR_RANGE;
}

mct_status mct_inertia_check(const double *inertia, mct_inertia_report *report)
{
    *report = (mct_inertia_report){.fault = MCT_INERTIA_PHYSICAL};
    const double allowed = TOLERANCE * mct_abs(inertia[0] + inertia[4] + inertia[8]);
    for (int i = 0; i < 9; i++) {
        const double opposite = inertia[3 * (i % 3) + i / 3];
        report->row = i / 3;
        report->column = i % 3;
        if (!mct_is_finite(inertia[i])) {
            return fault(report, MCT_INERTIA_NOT_FINITE, inertia[i], opposite);
        }
        if (mct_abs(inertia[i] - opposite) > allowed) {
            return fault(report, MCT_INERTIA_NOT_SYMMETRIC, inertia[i], opposite);
        }
    }
    report->row = report->column = 0;
    const double *moments = report->moments;
    const mct_status status = mct_principal_axes(inertia, report->moments, report->axes);
    if (status != MCT_OK) {
        return status;
    }
    for (int i = 0; i < 3; i++) {
        if (moments[i] < -allowed) {
            return fault(report, MCT_INERTIA_NEGATIVE, moments[i], 0);
        }
    }
    for (int i = 0; i < 3; i++) {
        const double others = moments[(i + 1) % 3] + moments[(i + 2) % 3];
        if (moments[i] - others > allowed) {
            return fault(report, MCT_INERTIA_NOT_TRIANGLE, moments[i], others);
        }
    }
    return MCT_OK;
}

mct_status mct_equimomental_particles(const mct_body *body, double (*position)[3])
{
    if (!(body->mass > 0)) {
        return MCT_ERROR_RANGE;
    }
    mct_inertia_report report;
    const mct_status status = mct_inertia_check(body->inertia, &report);
    if (status != MCT_OK) {
        return status;
    }
    const double *moments = report.moments;
    for (int axis = 0; axis < 3; axis++) {
        const double others = moments[(axis + 1) % 3] + moments[(axis + 2) % 3];
        const double second =
            mct_max(0, 0.5 * (others - moments[axis])); /* rounding may have made it negative */
        const double distance = mct_sqrt(3 * second / body->mass);
        for (int i = 0; i < 3; i++) {
            position[2 * axis][i] = body->center[i] + distance * report.axes[3 * i + axis];
            position[2 * axis + 1][i] = body->center[i] - distance * report.axes[3 * i + axis];
        }
    }
    return MCT_OK;
}

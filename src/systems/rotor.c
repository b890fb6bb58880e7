#include "rotor.h"

#include <string.h>

#include "mctau/matrix.h"

const mct_field mct_rotor_columns[MCT_ROTOR_COLUMNS] = {
    MCT_QUANTITY("mass", "kg", 1e-6, 1e6, 0, "of the particle"),
    MCT_QUANTITY("b1", "m", -1e3, 1e3, 0, "where it is, in body axes"),
    MCT_QUANTITY("b2", "m", -1e3, 1e3, 0, ""),
    MCT_QUANTITY("b3", "m", -1e3, 1e3, 0, ""),
};

/*
 * The axis that `split3` does without: where the product of what the other two have beyond is least, for so is the error.
 * Nothing turns about an axis without inertia.
 */
static void prepare_split(const double *moment, double largest, mct_rotor *rotor)
{
    double least = -1;
    for (int axis = 0; axis < 3; axis++) {
        double excess[3], product = 1;
        for (int i = 0; i < 3 && moment[axis] > 0; i++) {
            excess[i] = moment[i] == 0 ? 0 : largest / moment[i] - largest / moment[axis];
            product *= i == axis ? 1 : mct_abs(excess[i]);
        }
        if (moment[axis] > 0 && (least < 0 || product < least)) {
            least = product;
            rotor->round = (mct_real)(largest / moment[axis]);
            for (int i = 0; i < 3; i++) {
                rotor->excess[i] = (mct_real)excess[i];
            }
        }
    }
}

/* Inertia, its principal axes and moments, and the axis that has none. */
static mct_status prepare_inertia(const double *inertia, mct_rotor *rotor, double *moments)
{
    double axes[9], moment[3], largest = 0;
    mct_real matrix[9];
    const mct_status status = mct_principal_axes(inertia, moments, axes);
    if (status != MCT_OK) {
        return status;
    }
    for (int axis = 0; axis < 3; axis++) {
        largest = mct_max(largest, moments[axis]);
    }
    if (largest == 0) {
        return MCT_ERROR_SINGULAR;
    }
    for (int i = 0; i < 9; i++) {
        rotor->inertia[i / 3][i % 3] = (mct_real)inertia[i];
        rotor->axes[i % 3][i / 3] = matrix[i] = (mct_real)axes[i];
        rotor->is_turned |= axes[i] != (i % 4 == 0 ? 1 : 0);
    }
    mct_quaternion_of_matrix(matrix, rotor->turn);
    for (int i = 0; i < 3; i++) {
        const bool is_idle = moments[i] < MCT_LEAST_MOMENT * largest;
        moment[i] = is_idle ? 0 : moments[i];
        rotor->moment[i] = (mct_real)(moment[i] / largest);
        rotor->inverse[i] = (mct_real)(is_idle ? 0 : 1 / moment[i]);
        for (int j = 0; j < 3 && is_idle; j++) {
            rotor->idle_axis[j] = rotor->axes[i][j];
        }
    }
    for (int i = 0; i < 3; i++) {
        const double difference = moment[(i + 1) % 3] - moment[(i + 2) % 3];
        rotor->coupling[i] = (mct_real)(moment[i] == 0 ? 0 : difference / moment[i]);
    }
    prepare_split(moment, largest, rotor);
    return MCT_OK;
}

mct_status mct_rotor_prepare(const double *particles, int count, bool about_center, double h,
                             mct_rotor *rotor, mct_body *body, double *moments)
{
    static const double origin[3] = {0, 0, 0};
    double mass[MCT_MAX_PARTICLES], place[MCT_MAX_PARTICLES][3], inertia[9];
    for (int n = 0; n < count; n++) {
        mass[n] = particles[MCT_ROTOR_COLUMNS * n];
        memcpy(place[n], particles + MCT_ROTOR_COLUMNS * n + 1, sizeof place[n]);
    }
    const mct_status status = mct_body_of_particles(count, mass, (const double(*)[3])place, body);
    if (status != MCT_OK) {
        return status;
    }
    const double *const point = about_center ? body->center : origin;
    mct_inertia_about(body, point, inertia);
    *rotor = (mct_rotor){.step = mct_step_of(h), .count = count, .total_mass = (mct_real)body->mass};
    for (int n = 0; n < count; n++) {
        rotor->mass[n] = (mct_real)mass[n];
        for (int i = 0; i < 3; i++) {
            rotor->arm[n][i] = (mct_real)(place[n][i] - point[i]);
        }
    }
    return prepare_inertia(inertia, rotor, moments);
}

/* product = a x b */
static void cross(const mct_hyperdual *a, const mct_hyperdual *b, mct_hyperdual *product)
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        product[i] = mct_hyperdual_sub(mct_hyperdual_mul(a[j], b[k]), mct_hyperdual_mul(a[k], b[j]));
    }
}

void mct_rotor_place(const mct_rotor *rotor, const mct_hyperdual *q, mct_hyperdual (*position)[3])
{
    for (int n = 0; n < rotor->count; n++) { /* as mct_rotate() */
        mct_hyperdual arm[3], once[3], twice[3];
        for (int i = 0; i < 3; i++) {
            arm[i] = mct_hyperdual_constant(rotor->arm[n][i]);
        }
        cross(q + 1, arm, once);
        cross(q + 1, once, twice);
        for (int i = 0; i < 3; i++) {
            const mct_hyperdual half = mct_hyperdual_add(mct_hyperdual_mul(q[0], once[i]), twice[i]);
            position[n][i] = mct_hyperdual_add(arm[i], mct_hyperdual_scale(2, half));
        }
    }
}

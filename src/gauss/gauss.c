#include "mctau/gauss.h"

#include "mctau/least_squares.h"

#if MCT_GAUSS_MAX_ROWS > MCT_LEAST_SQUARES_MAX_ROWS
#error "mctau: three rows a particle exceed the room of the least squares"
#endif
#if MCT_GAUSS_MAX_COORDINATES > MCT_LEAST_SQUARES_MAX_COLUMNS
#error "mctau: the coordinates exceed the room of the least squares"
#endif

static bool is_finite(mct_real x)
{
    return x - x == MCT_R(0.0);
}

static mct_status check(const mct_gauss_system *self)
{
    if (self->particle_count < 1 || self->coordinate_count < 1 || self->mass == NULL || self->place == NULL) {
        return MCT_ERROR_ARGUMENT;
    }
    if (self->particle_count > MCT_GAUSS_MAX_PARTICLES ||
        self->coordinate_count > MCT_GAUSS_MAX_COORDINATES) {
        return MCT_ERROR_BOUND;
    }
    for (int i = 0; i < self->particle_count; i++) {
        if (!(self->mass[i] > MCT_R(0.0))) {
            return MCT_ERROR_RANGE;
        }
    }
    return MCT_OK;
}

/**
 * Evaluates h with (time_rate, rate) as the first direction, and as the second either coordinate `column`
 * alone or, for column = coordinate_count, the first one again.
 */
static void place(const mct_gauss_system *self, mct_real time, const mct_real *q, mct_real time_rate,
                  const mct_real *rate, int column, mct_hyperdual (*position)[3])
{
    const mct_real one = MCT_R(1.0);
    const mct_real zero = MCT_R(0.0);
    const bool again = column == self->coordinate_count;
    const mct_hyperdual now = {time, time_rate, again ? time_rate : zero, zero};
    mct_hyperdual coordinate[MCT_GAUSS_MAX_COORDINATES];
    for (int j = 0; j < self->coordinate_count; j++) {
        const mct_real alone = j == column ? one : zero;
        coordinate[j] = (mct_hyperdual){q[j], rate[j], again ? rate[j] : alone, zero};
    }
    self->place(self->context, now, coordinate, position);
}

/** x' m y over all particles. Exactly the same for y' m x, so that M is symmetric to the bit. */
static mct_real mass_product(const mct_gauss_system *self, const mct_real *x, int x_stride, const mct_real *y,
                             int y_stride)
{
    mct_real sum = MCT_R(0.0);
    for (int row = 0; row < 3 * self->particle_count; row++) {
        sum += self->mass[row / 3] * (x[row * x_stride] * y[row * y_stride]);
    }
    return sum;
}

mct_status mct_gauss_kinematics(const mct_gauss_system *self, mct_real time, const mct_real *q,
                                const mct_real *v, mct_gauss_workspace *workspace, mct_gauss_motion *motion)
{
    const mct_status status = check(self);
    if (status != MCT_OK) {
        return status;
    }
    const int rows = 3 * self->particle_count;
    const int columns = self->coordinate_count;
    for (int j = 0; j < columns; j++) {
        place(self, time, q, MCT_R(1.0), v, j, workspace->position);
        for (int row = 0; row < rows; row++) {
            const mct_hyperdual x = workspace->position[row / 3][row % 3];
            workspace->J[row * columns + j] = x.e2;
            workspace->J_rate[row * columns + j] = x.e12;
        }
    }
    place(self, time, q, MCT_R(1.0), v, columns, workspace->position);
    bool finite = true;
    for (int row = 0; row < rows; row++) {
        const mct_hyperdual x = workspace->position[row / 3][row % 3];
        motion->position[row / 3][row % 3] = x.value;
        motion->velocity[row / 3][row % 3] = x.e1;
        workspace->bias[row] = x.e12;
        finite = finite && is_finite(x.value) && is_finite(x.e1);
    }
    for (int i = 0; i < columns; i++) {
        const mct_real *const J_i = workspace->J + i;
        for (int j = 0; j < columns; j++) {
            motion->M[i][j] = mass_product(self, J_i, columns, workspace->J + j, columns);
            motion->C[i][j] = mass_product(self, J_i, columns, workspace->J_rate + j, columns);
            finite = finite && is_finite(motion->M[i][j]) && is_finite(motion->C[i][j]);
        }
        motion->Cv[i] = mass_product(self, J_i, columns, workspace->bias, 1);
        finite = finite && is_finite(motion->Cv[i]);
    }
    return finite ? MCT_OK : MCT_ERROR_NOT_FINITE;
}

mct_status mct_gauss_dynamics(const mct_gauss_system *self, const mct_real *force, const mct_real *couple,
                              mct_gauss_workspace *workspace, mct_gauss_motion *motion)
{
    const int rows = 3 * self->particle_count;
    const int columns = self->coordinate_count;

    /* Unconstrained, the particles would accelerate by f / m: Gauss minimises the departure from that. */
    for (int j = 0; j < columns; j++) {
        motion->tau[j] = couple != NULL ? couple[j] : MCT_R(0.0);
    }
    for (int row = 0; row < rows; row++) {
        const mct_real mass = self->mass[row / 3];
        const mct_real f = force != NULL ? force[row] : MCT_R(0.0);
        workspace->weight[row] = mass;
        workspace->residual[row] = f / mass - workspace->bias[row];
        for (int j = 0; j < columns; j++) {
            motion->tau[j] += workspace->J[row * columns + j] * f;
            workspace->design[row * columns + j] = workspace->J[row * columns + j];
        }
    }
    mct_real a[MCT_GAUSS_MAX_COORDINATES];
    const mct_status status = mct_least_squares(rows, columns, workspace->design, workspace->weight,
                                                workspace->residual, couple, a);
    if (status != MCT_OK) {
        return status;
    }
    for (int row = 0; row < rows; row++) {
        mct_real acceleration = workspace->bias[row];
        for (int j = 0; j < columns; j++) {
            acceleration += workspace->J[row * columns + j] * a[j];
        }
        motion->particle_acceleration[row / 3][row % 3] = acceleration;
        motion->constraint_force[row / 3][row % 3] = -self->mass[row / 3] * workspace->residual[row];
    }
    for (int j = 0; j < columns; j++) {
        motion->acceleration[j] = a[j];
    }
    return MCT_OK;
}

mct_status mct_gauss_christoffel(const mct_gauss_system *self, mct_real time, const mct_real *q,
                                 const mct_real *v, mct_gauss_workspace *workspace, mct_gauss_lagrange *form)
{
    const int rows = 3 * self->particle_count;
    const int columns = self->coordinate_count;
    const mct_real *const J = workspace->J;
    mct_real *const J_by_k = workspace->design; /* dJ/dq_k */
    for (int k = 0; k < columns; k++) {
        mct_real along[MCT_GAUSS_MAX_COORDINATES] = {MCT_R(0.0)};
        along[k] = MCT_R(1.0);
        for (int j = 0; j < columns; j++) {
            place(self, time, q, MCT_R(0.0), along, j, workspace->position);
            for (int row = 0; row < rows; row++) {
                J_by_k[row * columns + j] = workspace->position[row / 3][row % 3].e12;
            }
        }
        for (int i = 0; i < columns; i++) {
            for (int j = 0; j < columns; j++) {
                form->M_by[k][i][j] = mass_product(self, J_by_k + i, columns, J + j, columns) +
                                      mass_product(self, J + i, columns, J_by_k + j, columns);
            }
        }
    }
    bool finite = true;
    for (int i = 0; i < columns; i++) {
        for (int j = 0; j < columns; j++) {
            mct_real christoffel = MCT_R(0.0);
            mct_real alternative = MCT_R(0.0);
            for (int k = 0; k < columns; k++) {
                const mct_real ij_by_k = form->M_by[k][i][j];
                const mct_real ik_by_j = form->M_by[j][i][k];
                const mct_real jk_by_i = form->M_by[i][j][k];
                christoffel += MCT_R(0.5) * (ij_by_k + ik_by_j - jk_by_i) * v[k];
                alternative += (ij_by_k - MCT_R(0.5) * jk_by_i) * v[k];
            }
            form->C[i][j] = christoffel;
            form->C_alternative[i][j] = alternative;
            finite = finite && is_finite(christoffel) && is_finite(alternative);
        }
    }
    return finite ? MCT_OK : MCT_ERROR_NOT_FINITE;
}

#include "mctau/expo.h"

#include <string.h>

#include "mctau/matrix.h"

#define POWERS (MCT_EXPO_NODES + 1)
#define SIZE   (MCT_EXPO_STATES + 1 + POWERS)

/* Radau's points on [0, 1] but for 0, by their number. */
static const double radau[][MCT_EXPO_NODES] = {
    [2] = {0.3550510257216821902, 0.8449489742783178098},
    [4] = {0.1397598643437805522, 0.4164095676310831799, 0.7231569863618761723, 0.9428958038854823178},
};

/* Of xdot = A x + B u + e g(t) over a time, less the start, by row of x: */
typedef struct {
    double states[MCT_EXPO_STATES][MCT_EXPO_STATES];
    double input[MCT_EXPO_STATES];
    double powers[MCT_EXPO_STATES][POWERS]; /* to g = (t / time)^k / k! */
} response;

/*
 * e^(G) - 1 of the augmented generator: one column for the held input and a chain for the powers of time,
 * whose entries are phi_1, phi_2, ... of A time, applied to e time.
 */
static mct_status response_over(int states, const double *A, const double *B, const double *e, double time,
                                response *out)
{
    const int size = states + 1 + POWERS;
    double generator[SIZE * SIZE];
    double flow[SIZE * SIZE];
    memset(generator, 0, sizeof generator);
    for (int i = 0; i < states; i++) {
        for (int j = 0; j < states; j++) {
            generator[i * size + j] = time * A[i * states + j];
        }
        generator[i * size + states] = time * B[i];
        generator[i * size + states + 1] = time * e[i];
    }
    for (int k = states + 1; k + 1 < size; k++) {
        generator[k * size + k + 1] = 1;
    }
    const mct_status status = mct_expm1(size, generator, flow);
    for (int i = 0; status == MCT_OK && i < states; i++) {
        memcpy(out->states[i], flow + i * size, (size_t)states * sizeof *flow);
        out->input[i] = flow[i * size + states];
        memcpy(out->powers[i], flow + i * size + states + 1, sizeof out->powers[i]);
    }
    return status;
}

/* Row i's response up to `end`, in steps, to the polynomial that is 1 at one node, 0 at the others and 0. */
static double response_to_node(const response *self, int i, double end, const double *node, int nodes,
                               int which)
{
    double c[POWERS] = {0, 1}; /* coefficients of t^k, t in steps: t times factors (t - node) */
    double scale = node[which];
    for (int j = 0, degree = 1; j < nodes; j++) {
        if (j == which) {
            continue;
        }
        degree++;
        for (int k = degree; k > 0; k--) {
            c[k] = c[k - 1] - node[j] * (k < degree ? c[k] : 0);
        }
        scale *= node[which] - node[j];
    }
    double sum = 0;
    double power = 1; /* k! end^k */
    for (int k = 1; k <= nodes; k++) {
        power *= k * end;
        sum += c[k] * (power * self->powers[i][k]);
    }
    return sum / scale;
}

/* a and j of a t^2 / 2 + j t^3 / 6 through y[0] at t[0] and y[1] at t[1]. */
static void bend(const double *t, const double *y, mct_real *a, mct_real *j)
{
    const double bend0 = 2 * y[0] / (t[0] * t[0]);
    const double bend1 = 2 * y[1] / (t[1] * t[1]);
    const double slope = (bend1 - bend0) / (t[1] - t[0]);
    *j = (mct_real)(3 * slope);
    *a = (mct_real)(bend0 - slope * t[0]);
}

mct_status mct_expo_prepare(mct_expo *expo, int nodes, int coordinates, int states, const double *A,
                            const double *B, const double *e, double h)
{
    const double *node = radau[nodes];
    response r;
    double angle[MCT_EXPO_NODES][MCT_EXPO_COLUMNS] = {{0}};
    memset(expo, 0, sizeof *expo);
    for (int m = 0; m < nodes; m++) {
        const double time = h * node[m];
        const mct_status status = response_over(states, A, B, e, time, &r);
        if (status != MCT_OK) {
            return status;
        }
        memcpy(angle[m], r.states[0] + coordinates, (size_t)(states - coordinates) * sizeof(double));
        angle[m][MCT_EXPO_INPUT] = r.input[0];
        angle[m][MCT_EXPO_CONSTANT] = r.powers[0][0];
        for (int j = 0; j < MCT_EXPO_COLUMNS; j++) {
            expo->angle[m][j] = (mct_real)angle[m][j];
        }
        for (int k = 0; k < nodes; k++) {
            expo->angle_nodes[m][k] = (mct_real)response_to_node(&r, 0, node[m], node, nodes, k);
        }
        double power = time;
        for (int k = 0; k < 3; k++, power *= time) {
            expo->angle_powers[m][k] = (mct_real)(power * r.powers[0][k + 1]);
        }
    }
    const int early = nodes / 2 - 1;
    const int late = nodes - 1;
    const double times[2] = {h * node[early], h * node[late]};
    for (int j = 0; j < MCT_EXPO_COLUMNS; j++) {
        const double first = j == 0 ? 1 : 0; /* the derivative that x_0's own rate is */
        const double curve[2] = {angle[early][j] - first * times[0], angle[late][j] - first * times[1]};
        bend(times, curve, &expo->mean[0][j], &expo->mean[1][j]);
    }
    const mct_status status = response_over(states, A, B, e, h, &r);
    for (int i = 0; status == MCT_OK && i < states; i++) {
        for (int j = coordinates; j < states; j++) {
            expo->flow[i][j - coordinates] = (mct_real)r.states[i][j];
        }
        expo->input[i] = (mct_real)r.input[i];
        expo->constant[i] = (mct_real)r.powers[i][0];
        for (int k = 0; k < nodes; k++) {
            expo->nodes[i][k] = (mct_real)response_to_node(&r, i, 1, node, nodes, k);
        }
    }
    return status;
}

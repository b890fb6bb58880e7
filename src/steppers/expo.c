#include "mctau/expo.h"

#include <string.h>

#include "mctau/matrix.h"

#define SIZE (MCT_EXPO_STATES + 4)

/*
 * e^(G) - 1 of the augmented generator of xdot = A x + B u + e (c0 + c1 s/h + c2 (s/h)^2): one column for the
 * held input and a chain of three for the powers of time, whose entries are h phi_1, h phi_2 and h phi_3 of A
 * h applied to e.
 */
static mct_status augmented_flow(int states, const double *A, const double *B, const double *e, double h,
                                 double *flow)
{
    const int size = states + 4;
    double generator[SIZE * SIZE];
    memset(generator, 0, sizeof generator);
    for (int i = 0; i < states; i++) {
        for (int j = 0; j < states; j++) {
            generator[i * size + j] = h * A[i * states + j];
        }
        generator[i * size + states] = h * B[i];
        generator[i * size + states + 1] = h * e[i];
    }
    generator[(states + 1) * size + states + 2] = 1;
    generator[(states + 2) * size + states + 3] = 1;
    return mct_expm1(size, generator, flow);
}

mct_status mct_expo_prepare(mct_expo *expo, int coordinates, int states, const double *A, const double *B,
                            const double *e, double h)
{
    static const double factorial[3] = {1, 1, 2}; /* integral of (s/h)^k is k! h phi_(k+1) */
    const int size = states + 4;
    double flow[SIZE * SIZE];
    memset(expo, 0, sizeof *expo);
    mct_status status = augmented_flow(states, A, B, e, h, flow);
    if (status != MCT_OK) {
        return status;
    }
    for (int i = 0; i < states; i++) {
        for (int j = coordinates; j < states; j++) {
            expo->flow[i][j - coordinates] = (mct_real)flow[i * size + j];
        }
        expo->input[i] = (mct_real)flow[i * size + states];
        for (int k = 0; k < 3; k++) {
            expo->force[k][i] = (mct_real)(factorial[k] * flow[i * size + states + 1 + k]);
        }
    }
    status = augmented_flow(states, A, B, e, 0.5 * h, flow);
    for (int j = coordinates; j < states; j++) {
        expo->half_flow[j - coordinates] = (mct_real)flow[j];
    }
    expo->half_input = (mct_real)flow[states];
    expo->half_force = (mct_real)flow[states + 1];
    return status;
}

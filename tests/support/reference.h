/*
 * An independent judge of motions, in quadruple precision.
 *
 * The equations stand in raw form: M and the forces as the Lagrangian gives them (eqs. 128 and 157 of the
 * source, as corrected), solved by Gaussian elimination; nothing of the closed forms in src/ is used. Two
 * integrators that share nothing but these equations watch over each other (tests/reference):
 *     reference_extrapolate  Gragg's midpoint rule with Bulirsch-Stoer extrapolation, order 18, explicit
 *     reference_flow         for a stiff motor: variation of constants, the sine collocated at 8 nodes and
 * iterated to convergence; windows grow from the motor's time constant, so a jump of the voltage is resolved
 */
#ifndef MCT_TEST_REFERENCE_H
#define MCT_TEST_REFERENCE_H

#include "mctau/expo.h"
#include "mctau/scene.h"
#include "support/quad.h"

#if defined __SIZEOF_FLOAT128__ && !defined __clang__
#define HAVE_REFERENCE 1
#else
#define HAVE_REFERENCE 0 /* no quadruple precision with this compiler: the tests say so and are skipped */
#endif

enum { REFERENCE_STATES = MCT_EXPO_STATES, REFERENCE_NODES = 8, REFERENCE_WINDOWS = 24 };

typedef struct {
    int system;
    uint32_t effects;
    int states;
    quad p[MCT_MAX_PARAMETERS];
} reference_model;

reference_model reference_of(const mct_scene *scene);

/* Time derivative of the state x = (q, v, current) under an input. */
void reference_rate(const reference_model *model, const quad *x, quad u, quad *dx);

/* Kinetic, potential and magnetic energy [J]. */
quad reference_energy(const reference_model *model, const quad *x);

/* Advances x over a duration in equal steps of extrapolation, under a held input. */
void reference_extrapolate(const reference_model *model, quad *x, quad u, quad duration, long steps);

/* The precomputed flow over one window. */
typedef struct {
    quad length;
    quad flow[REFERENCE_NODES + 1][REFERENCE_STATES][REFERENCE_STATES]; /* at the nodes and at the end */
    quad input[REFERENCE_NODES + 1][REFERENCE_STATES];
    quad force[REFERENCE_NODES + 1][REFERENCE_NODES][REFERENCE_STATES];
} reference_window;

typedef struct {
    const reference_model *model;
    int window_count;
    reference_window windows[REFERENCE_WINDOWS];
} reference_flow;

/*
 * Prepares windows that add up to a duration: from `first` on, doubling up to `longest`, as often as it
 * takes. Several equal ones in a row share one entry. Reaction wheel only. Returns the number of windows, or
 * 0 when they do not fit.
 */
int reference_flow_prepare(reference_flow *self, const reference_model *model, double duration, double first,
                           double longest);

/* Advances x over the duration under a held input. */
void reference_flow_advance(const reference_flow *self, quad *x, quad u);

/* x from doubles, the model's states. */
void reference_start(const reference_model *model, const double *from, quad *x);

#endif

/*
 * SUNDIALS on the shared closed form: CVODE (Adams; BDF with the Jacobian where the motor is stiff) and ARKODE
 * (explicit, adaptive and fixed; diagonally implicit where the motor is stiff), both started again at every tick whose
 * input is new. Free motions are read by interpolation.
 */
#include "peers.h"

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <stdlib.h>
#include <string.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

static const peer_method methods[] = {
    {"CVODE Adams", false},
    {"CVODE BDF", false},
    {"ARKODE order 4", false},
    {"ARKODE order 8", false},
    {"ARKODE order 4, fixed", true},
    {"ARKODE order 8, fixed", true},
    {"ARKODE implicit order 5", false},
};
enum { ADAMS, BDF, ERK4, ERK8, ERK4_FIXED, ERK8_FIXED, IMPLICIT, METHODS };

typedef struct {
    const bench_scene *scene;
    double k[SCENE_CONSTANTS];
    double input;
    double t;
    int method;
    void *solver;
    SUNContext context;
    N_Vector x;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    SUNNonlinearSolver nonlinear;
} theirs;

/* One function for each form, so that the closed form is inlined. */
#define RATE(name)                                                              \
    static int name##_rate(realtype t, N_Vector x, N_Vector dx, void *of)       \
    {                                                                           \
        const theirs *self = of;                                                \
        (void)t;                                                                \
        scene_##name##_rate(self->k, self->input, NV_DATA_S(x), NV_DATA_S(dx)); \
        return 0;                                                               \
    }
RATE(pendulum)
RATE(spring)
RATE(cart_pole)
RATE(wheel)
RATE(body)

static int wheel_jacobian(realtype t, N_Vector x, N_Vector dx, SUNMatrix J, void *of, N_Vector a, N_Vector b,
                          N_Vector c)
{
    const theirs *self = of;
    double rows[25];
    (void)t, (void)dx, (void)a, (void)b, (void)c;
    scene_wheel_jacobian(self->k, NV_DATA_S(x), rows);
    for (int i = 0; i < 25; i++) {
        SM_ELEMENT_D(J, i / 5, i % 5) = rows[i];
    }
    return 0;
}

static void say_nothing(int code, const char *module, const char *function, char *message, void *of)
{
    (void)code, (void)module, (void)function, (void)message, (void)of;
}

static const char *version(void)
{
    static char text[32];
    SUNDIALSGetVersion(text, sizeof text);
    return text;
}

static bool is_erk(int method)
{
    return method >= ERK4 && method <= ERK8_FIXED;
}

static bool prepare_cvode(theirs *self, CVRhsFn rate, double tolerance)
{
    void *const solver = self->solver = CVodeCreate(self->method == BDF ? CV_BDF : CV_ADAMS, self->context);
    bool well = CVodeInit(solver, rate, 0, self->x) == CV_SUCCESS;
    CVodeSetErrHandlerFn(solver, say_nothing, NULL);
    CVodeSetUserData(solver, self);
    CVodeSetMaxNumSteps(solver, 10000000);
    well = well && CVodeSStolerances(solver, tolerance, tolerance) == CV_SUCCESS;
    if (self->method == BDF) {
        return well && CVodeSetLinearSolver(solver, self->linear, self->matrix) == CV_SUCCESS &&
               CVodeSetJacFn(solver, wheel_jacobian) == CV_SUCCESS;
    }
    self->nonlinear = SUNNonlinSol_FixedPoint(self->x, 0, self->context);
    return well && CVodeSetNonlinearSolver(solver, self->nonlinear) == CV_SUCCESS;
}

static bool prepare_erk(theirs *self, ARKRhsFn rate, double setting)
{
    void *const solver = self->solver = ERKStepCreate(rate, 0, self->x, self->context);
    const bool order_8 = self->method == ERK8 || self->method == ERK8_FIXED;
    ERKStepSetErrHandlerFn(solver, say_nothing, NULL);
    ERKStepSetUserData(solver, self);
    ERKStepSetMaxNumSteps(solver, 10000000);
    ERKStepSetOrder(solver, order_8 ? 8 : 4);
    return methods[self->method].is_fixed
               ? ERKStepSetFixedStep(solver, scene_span(self->scene) / setting) == ARK_SUCCESS
               : ERKStepSStolerances(solver, setting, setting) == ARK_SUCCESS;
}

static bool prepare_implicit(theirs *self, ARKRhsFn rate, double tolerance)
{
    void *const solver = self->solver = ARKStepCreate(NULL, rate, 0, self->x, self->context);
    ARKStepSetErrHandlerFn(solver, say_nothing, NULL);
    ARKStepSetUserData(solver, self);
    ARKStepSetMaxNumSteps(solver, 10000000);
    ARKStepSetOrder(solver, 5);
    return ARKStepSStolerances(solver, tolerance, tolerance) == ARK_SUCCESS &&
           ARKStepSetLinearSolver(solver, self->linear, self->matrix) == ARK_SUCCESS &&
           ARKStepSetJacFn(solver, wheel_jacobian) == ARK_SUCCESS;
}

static void start(theirs *self)
{
    memcpy(NV_DATA_S(self->x), self->scene->start, sizeof(double) * (size_t)self->scene->states);
    self->t = 0;
    self->input = 0;
}

static void close_theirs(void *context)
{
    theirs *self = context;
    if (self->method == ADAMS || self->method == BDF) {
        CVodeFree(&self->solver);
    } else if (is_erk(self->method)) {
        ERKStepFree(&self->solver);
    } else {
        ARKStepFree(&self->solver);
    }
    if (self->nonlinear != NULL) {
        SUNNonlinSolFree(self->nonlinear);
    }
    SUNLinSolFree(self->linear);
    SUNMatDestroy(self->matrix);
    N_VDestroy(self->x);
    SUNContext_Free(&self->context);
    free(self);
}

static void *open_theirs(const bench_scene *scene, int method, double setting)
{
    static const CVRhsFn rates[] = {[SCENE_PENDULUM] = pendulum_rate,
                                    [SCENE_SPRING] = spring_rate,
                                    [SCENE_CART_POLE] = cart_pole_rate,
                                    [SCENE_WHEEL] = wheel_rate,
                                    [SCENE_BODY] = body_rate};
    if ((method == BDF || method == IMPLICIT) && scene->form != SCENE_WHEEL) {
        return NULL;
    }
    theirs *self = calloc(1, sizeof *self);
    self->scene = scene;
    self->method = method;
    scene_constants(scene, self->k);
    SUNContext_Create(NULL, &self->context);
    self->x = N_VNew_Serial(scene->states, self->context);
    self->matrix = SUNDenseMatrix(scene->states, scene->states, self->context);
    self->linear = SUNLinSol_Dense(self->x, self->matrix, self->context);
    start(self);
    const bool well = method <= BDF    ? prepare_cvode(self, rates[scene->form], setting)
                      : is_erk(method) ? prepare_erk(self, rates[scene->form], setting)
                                       : prepare_implicit(self, rates[scene->form], setting);
    if (!well) {
        close_theirs(self);
        return NULL;
    }
    return self;
}

static inline bool advance_cvode(void *context, int span, double input)
{
    theirs *self = context;
    const double end = (span + 1) * scene_span(self->scene);
    if (self->scene->is_held) {
        self->input = input;
        CVodeReInit(self->solver, self->t, self->x);
        CVodeSetStopTime(self->solver, end);
    }
    return CVode(self->solver, end, self->x, &self->t, CV_NORMAL) >= 0;
}

/* Reset, not re-initialised: it keeps its step. Fixed steps end with the span. */
static inline bool advance_erk(void *context, int span, double input)
{
    theirs *self = context;
    const double end = (span + 1) * scene_span(self->scene);
    if (self->scene->is_held) {
        self->input = input;
        ERKStepReset(self->solver, self->t, self->x);
    }
    if (self->scene->is_held || methods[self->method].is_fixed) {
        ERKStepSetStopTime(self->solver, end);
    }
    return ERKStepEvolve(self->solver, end, self->x, &self->t, ARK_NORMAL) >= 0;
}

static inline bool advance_implicit(void *context, int span, double input)
{
    theirs *self = context;
    const double end = (span + 1) * scene_span(self->scene);
    if (self->scene->is_held) {
        self->input = input;
        ARKStepReset(self->solver, self->t, self->x);
        ARKStepSetStopTime(self->solver, end);
    }
    return ARKStepEvolve(self->solver, end, self->x, &self->t, ARK_NORMAL) >= 0;
}

static inline void read(void *context, double *x)
{
    const theirs *self = context;
    memcpy(x, NV_DATA_S(self->x), sizeof *x * (size_t)self->scene->states);
}

static bool run(void *context, const double *inputs, double *samples)
{
    theirs *self = context;
    start(self);
    self->input = inputs[0];
    if (self->method <= BDF) {
        CVodeReInit(self->solver, 0, self->x);
        return peer_loop(self->scene, self, inputs, samples, advance_cvode, read);
    }
    if (is_erk(self->method)) {
        ERKStepReset(self->solver, 0, self->x);
        return peer_loop(self->scene, self, inputs, samples, advance_erk, read);
    }
    ARKStepReset(self->solver, 0, self->x);
    return peer_loop(self->scene, self, inputs, samples, advance_implicit, read);
}

const peer the_peer = {"SUNDIALS", version, METHODS, methods, open_theirs, run, close_theirs};

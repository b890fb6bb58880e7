/*
 * GSL's odeiv2 on the shared closed form: fixed steps by gsl_odeiv2_step_apply, adaptive ones by a driver, which is
 * reset where the input changes; implicit methods, with the Jacobian, where the motor is stiff.
 */
#include "peers.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_version.h>
#include <stdlib.h>
#include <string.h>

static const peer_method methods[] = {
    {"rk4", true},      {"rk8pd, fixed", true}, {"rkf45", false}, {"rk8pd", false},
    {"msadams", false}, {"bsimp", false},       {"msbdf", false},
};
enum { RK4, RK8PD_FIXED, RKF45, RK8PD, MSADAMS, BSIMP, MSBDF, METHODS };

typedef struct {
    const bench_scene *scene;
    double k[SCENE_CONSTANTS];
    double input;
    double x[SCENE_STATES], error[SCENE_STATES];
    gsl_odeiv2_system system;
    gsl_odeiv2_driver *driver; /* adaptive */
    gsl_odeiv2_step *step;     /* fixed */
    int steps;
    double t, first;
} theirs;

/* One function for each form, so that the closed form is inlined. */
#define RATE(name)                                                          \
    static int name##_rate(double t, const double *x, double *dx, void *of) \
    {                                                                       \
        const theirs *self = of;                                            \
        (void)t;                                                            \
        scene_##name##_rate(self->k, self->input, x, dx);                   \
        return GSL_SUCCESS;                                                 \
    }
RATE(pendulum)
RATE(spring)
RATE(cart_pole)
RATE(wheel)
RATE(body)

static int wheel_jacobian(double t, const double *x, double *J, double *dt, void *of)
{
    const theirs *self = of;
    (void)t;
    scene_wheel_jacobian(self->k, x, J);
    memset(dt, 0, sizeof(double) * 5);
    return GSL_SUCCESS;
}

static const char *version(void)
{
    return gsl_version;
}

static void *open_theirs(const bench_scene *scene, int method, double setting)
{
    static int (*const rates[])(double, const double *, double *,
                                void *) = {[SCENE_PENDULUM] = pendulum_rate,
                                           [SCENE_SPRING] = spring_rate,
                                           [SCENE_CART_POLE] = cart_pole_rate,
                                           [SCENE_WHEEL] = wheel_rate,
                                           [SCENE_BODY] = body_rate};
    const gsl_odeiv2_step_type *types[METHODS] = {
        gsl_odeiv2_step_rk4,     gsl_odeiv2_step_rk8pd, gsl_odeiv2_step_rkf45, gsl_odeiv2_step_rk8pd,
        gsl_odeiv2_step_msadams, gsl_odeiv2_step_bsimp, gsl_odeiv2_step_msbdf};
    if (method >= BSIMP && scene->form != SCENE_WHEEL) {
        return NULL;
    }
    gsl_set_error_handler_off();
    theirs *self = calloc(1, sizeof *self);
    self->scene = scene;
    scene_constants(scene, self->k);
    self->system = (gsl_odeiv2_system){rates[scene->form], wheel_jacobian, (size_t)scene->states, self};
    if (methods[method].is_fixed) {
        self->steps = (int)setting;
        self->step = gsl_odeiv2_step_alloc(types[method], (size_t)scene->states);
    } else {
        self->first = 1e-4;
        self->driver =
            gsl_odeiv2_driver_alloc_y_new(&self->system, types[method], self->first, setting, setting);
    }
    return self;
}

static inline bool advance_fixed(void *context, int span, double input)
{
    theirs *self = context;
    const double h = scene_span(self->scene) / self->steps;
    self->input = input;
    gsl_odeiv2_step_reset(self->step);
    for (int k = 0; k < self->steps; k++) {
        if (gsl_odeiv2_step_apply(self->step, span, h, self->x, self->error, NULL, NULL, &self->system) !=
            GSL_SUCCESS) {
            return false;
        }
    }
    return true;
}

static inline bool advance_adaptive(void *context, int span, double input)
{
    theirs *self = context;
    if (input != self->input) {
        gsl_odeiv2_driver_reset(self->driver);
        self->input = input;
    }
    return gsl_odeiv2_driver_apply(self->driver, &self->t, (span + 1) * scene_span(self->scene), self->x) ==
           GSL_SUCCESS;
}

static inline void read(void *context, double *x)
{
    const theirs *self = context;
    memcpy(x, self->x, sizeof *x * (size_t)self->scene->states);
}

static bool run(void *context, const double *inputs, double *samples)
{
    theirs *self = context;
    memcpy(self->x, self->scene->start, sizeof self->x);
    self->t = 0;
    self->input = 0;
    if (self->driver == NULL) {
        return peer_loop(self->scene, self, inputs, samples, advance_fixed, read);
    }
    gsl_odeiv2_driver_reset_hstart(self->driver, self->first);
    return peer_loop(self->scene, self, inputs, samples, advance_adaptive, read);
}

static void close_theirs(void *context)
{
    theirs *self = context;
    if (self->driver != NULL) {
        gsl_odeiv2_driver_free(self->driver);
    } else {
        gsl_odeiv2_step_free(self->step);
    }
    free(self);
}

const peer the_peer = {"GSL", version, METHODS, methods, open_theirs, run, close_theirs};

/*
 * Pendulum: a point mass m at the end of a massless rod of length l that turns about a fixed pivot.
 *
 * Equation      m l^2 a = m g l sin th - nu w - c w |w| + dry friction,  th the angle, w its rate, a its acceleration.
 * Source        section 1.2, eqs. 25-39.
 * Conventions   th clockwise from the upward vertical, zero is the unstable equilibrium.
 * Differences   (36): the centrifugal term has w^2 and the whole is -e; (38): e = m l (g cos th / l - w^2) along the
 *               rod, not m x (g cos th - w). Friction and drag are ours.
 * Constraint    the rod, e = m xdd - (0, -m g, 0), which also transmits the couples of friction and drag.
 * Validity      rod rigid; any m, l > 0.
 */
#include "mctau/pendulum.h"

#include "mctau/scene.h"
#include "systems.h"

#define MCT_SYSTEM pendulum
#define MCT_ALWAYS MCT_HINGE_SINE
#include "hinge.h"

typedef mct_pendulum_constants constants_t;

enum { MASS, LENGTH, GRAVITY, FRICTION, DRAG, COULOMB, STATIC_RATIO, PARAMETERS };

static const mct_field parameters[PARAMETERS] = {
    [MASS] = MCT_QUANTITY("mass", "kg", 1e-6, 1e6, 0.1, "point mass"),
    [LENGTH] = MCT_QUANTITY("length", "m", 1e-4, 1e4, 0.3, "pivot to point mass"),
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity", "m/s^2", 0, 1e4, 9.81, "gravitational acceleration"),
    [FRICTION] =
        MCT_COEFFICIENT(MCT_VISCOUS, "friction", "N m s", 0, 1e6, 0.0005, "viscous friction of the pivot"),
    [DRAG] = MCT_COEFFICIENT(MCT_DRAG, "drag", "N m s^2", 0, 1e6, 0,
                             "torque of the air by the square of the rate"),
    [COULOMB] = MCT_COEFFICIENT(MCT_COULOMB, "coulomb", "N m", 0, 1e6, 0, "dry friction of the pivot"),
    [STATIC_RATIO] = MCT_STATIC_RATIO,
};

static const mct_coordinate coordinates[1] = {
    {.position = MCT_QUANTITY("angle", "rad", -1e6, 1e6, 3.0, "clockwise from upright"),
     .rate = MCT_QUANTITY("angle_rate", "rad/s", -1e6, 1e6, 0, ""),
     .is_angle = true},
};

static const mct_field torque_field = MCT_QUANTITY("torque", "N m", -1e9, 1e9, 0, "about the pivot");
static const char *const particle_names[] = {"bob"};

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const double inertia = p[MASS] * p[LENGTH] * p[LENGTH];
    const double gravity = (scene->effects & MCT_GRAVITY) ? p[GRAVITY] : 0;
    (void)why;
    k->hinge = (mct_hinge){
        .step = mct_step_of(h),
        .inertia = (mct_real)inertia,
        .inverse_inertia = (mct_real)(1 / inertia),
        .sine_moment = (mct_real)(p[MASS] * gravity * p[LENGTH]),
        .viscous = (mct_real)((scene->effects & MCT_VISCOUS) ? p[FRICTION] : 0),
        .drag = (mct_real)((scene->effects & MCT_DRAG) ? p[DRAG] : 0),
        .coulomb = (mct_real)((scene->effects & MCT_COULOMB) ? p[COULOMB] : 0),
        .hold = (mct_real)((scene->effects & MCT_COULOMB) ? p[STATIC_RATIO] * p[COULOMB] : 0),
    };
    k->mass = (mct_real)p[MASS];
    k->length = (mct_real)p[LENGTH];
    k->gravity = (mct_real)gravity;
    return MCT_OK;
}

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_real w = x[1];
    mct_real s, c;
    mct_sincos(x[0], &s, &c);
    mct_hinge_evaluate(&k->hinge, effects, s, c, w, u, out);
    const mct_real a = out->acceleration[0];
    out->mass[0] = k->mass;
    out->position[0][0] = k->length * s;
    out->position[0][1] = k->length * c;
    out->force[0][1] = -k->mass * k->gravity;
    out->constraint_force[0][0] = k->mass * k->length * (c * a - s * w * w);
    out->constraint_force[0][1] = k->mass * (k->gravity - k->length * (s * a + c * w * w));
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const constants_t *k = constants;
    mct_hyperdual s, c;
    (void)time;
    mct_hyperdual_sincos(q[0], &s, &c);
    position[0][0] = mct_hyperdual_scale(k->length, s);
    position[0][1] = mct_hyperdual_scale(k->length, c);
    position[0][2] = mct_hyperdual_constant(0);
}

MCT_HINGE_KERNELS(MCT_SMOOTH_KERNELS_4, MCT_TAYLOR_EXACT_DRAG, MCT_GRAVITY, MCT_VISCOUS, MCT_COULOMB_MOREAU,
                  MCT_DRAG)

const mct_system mct_pendulum = {
    .name = "pendulum",
    .doc = "a point mass on a rod",
    .source = "1.2",
    .coordinate_count = 1,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .input_without_motor = &torque_field,
    .effects = MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB | MCT_DRAG,
    .standard_effects = MCT_GRAVITY | MCT_VISCOUS,
    .particle_count = 1,
    .particle_names = particle_names,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
    .motion = mct_pendulum_motion,
};

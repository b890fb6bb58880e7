/*
 * Solid pendulum: a homogeneous box x by y by z that turns in the plane about an axle through its long
 * middle line, at a distance from its end.
 *
 * Equation      I a = - m g d cos th - nu w + torque + dry friction,  th the angle, w its rate, a its
 *               acceleration, m = density x y z, d = x/2 - offset (pivot to centre), I = m (x^2 + y^2) / 12
 *               + m d^2.
 * Source        sections 5.4.1 and 5.5.2, eqs. 328-332, 354-362.
 * Conventions   th counterclockwise from the horizontal to the right: pi/2 stands (unstable), -pi/2 hangs,
 *               for d > 0.
 * Differences   (328): x^2 + y^2 in the third entry; (331): d^2 = 0.2401; (332), (355), (362): I = 1.3667,
 *               not 1.3706; (357): counterclockwise; (360), (362): the torque is -20.30 cos th N m; (362):
 *               of thdd, -14.856 rad/s^2 at the start. Friction is ours.
 * Particles     The box moves as four points of a quarter of its mass, sqrt(3) times nearer to its centre
 *               than its edges: same centre, same second moments in the plane.
 * Constraint    box and axle, e = m xdd - (0, -m g, 0), which also transmits the couple of friction. The
 *               force of the axle is the sum of all e.
 * Validity      box rigid, axle parallel to z, offset from 0 to x; any size > 0.
 */
#include "mctau/solid_pendulum.h"

#include "mctau/scene.h"
#include "systems.h"

#define MCT_SYSTEM solid_pendulum
#define MCT_ALWAYS MCT_HINGE_COSINE
#include "hinge.h"

typedef mct_solid_pendulum_constants constants_t;

enum { SIZE_1, SIZE_2, SIZE_3, DENSITY, PIVOT_OFFSET, GRAVITY, FRICTION, COULOMB, STATIC_RATIO, PARAMETERS };

static const mct_field parameters[PARAMETERS] = {
    [SIZE_1] = MCT_QUANTITY("size_1", "m", 1e-4, 1e3, 1, "length, from end to end"),
    [SIZE_2] = MCT_QUANTITY("size_2", "m", 1e-4, 1e3, 0.04, "height, across in the plane"),
    [SIZE_3] = MCT_QUANTITY("size_3", "m", 1e-4, 1e3, 0.04, "depth, along the axle"),
    [DENSITY] = MCT_QUANTITY("density", "kg/m^3", 1e-3, 1e5, 2640, "of the box; the source's aluminium"),
    [PIVOT_OFFSET] =
        MCT_QUANTITY("pivot_offset", "m", 0, 1e3, 0.01, "end of the box to axle; at most size_1"),
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity", "m/s^2", 0, 1e4, 9.81, "gravitational acceleration"),
    [FRICTION] =
        MCT_COEFFICIENT(MCT_VISCOUS, "friction", "N m s", 0, 1e6, 0.2, "viscous friction of the axle"),
    [COULOMB] = MCT_COEFFICIENT(MCT_COULOMB, "coulomb", "N m", 0, 1e6, 0, "dry friction of the axle"),
    [STATIC_RATIO] = MCT_STATIC_RATIO,
};

static const mct_coordinate coordinates[1] = {
    {.position = MCT_QUANTITY("angle", "rad", -1e6, 1e6, 0, "counterclockwise from horizontal"),
     .rate = MCT_QUANTITY("angle_rate", "rad/s", -1e6, 1e6, 0, ""),
     .is_angle = true},
};

static const mct_field torque_field = MCT_QUANTITY("torque", "N m", -1e9, 1e9, 0, "about the axle");
enum { PARTICLES = 4 };
static const char *const particle_names[PARTICLES] = {"near_below", "near_above", "far_below", "far_above"};

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const double x = p[SIZE_1];
    const double y = p[SIZE_2];
    if (p[PIVOT_OFFSET] > x) {
        mct_message_add(why, "parameters.pivot_offset: found ");
        mct_message_add_number(why, p[PIVOT_OFFSET]);
        mct_message_add(why, " m; allowed 0 to size_1, which is ");
        mct_message_add_number(why, x);
        mct_message_add(why, " m");
        return MCT_ERROR_UNSUITED;
    }
    const double mass = p[DENSITY] * x * y * p[SIZE_3];
    const double d = 0.5 * x - p[PIVOT_OFFSET];
    const double inertia = mass * ((x * x + y * y) / 12 + d * d);
    const double gravity = (scene->effects & MCT_GRAVITY) ? p[GRAVITY] : 0;
    const double share = 0.28867513459481288; /* 1 / sqrt(12) */
    k->hinge = (mct_hinge){
        .step = mct_step_of(h),
        .inertia = (mct_real)inertia,
        .inverse_inertia = (mct_real)(1 / inertia),
        .cosine_moment = (mct_real)(-mass * gravity * d),
        .viscous = (mct_real)((scene->effects & MCT_VISCOUS) ? p[FRICTION] : 0),
        .coulomb = (mct_real)((scene->effects & MCT_COULOMB) ? p[COULOMB] : 0),
        .hold = (mct_real)((scene->effects & MCT_COULOMB) ? p[STATIC_RATIO] * p[COULOMB] : 0),
    };
    k->mass = (mct_real)mass;
    k->gravity = (mct_real)gravity;
    for (int i = 0; i < PARTICLES; i++) {
        k->along[i] = (mct_real)(i < 2 ? d - share * x : d + share * x);
        k->across[i] = (mct_real)(i % 2 == 0 ? -share * y : share * y);
    }
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
    const mct_real mass = MCT_R(0.25) * k->mass;
    for (int i = 0; i < PARTICLES; i++) {
        const mct_real right = k->along[i] * c - k->across[i] * s;
        const mct_real up = k->along[i] * s + k->across[i] * c;
        out->mass[i] = mass;
        out->position[i][0] = right;
        out->position[i][1] = up;
        out->force[i][1] = -mass * k->gravity;
        out->constraint_force[i][0] = mass * (-up * a - right * w * w);
        out->constraint_force[i][1] = mass * (right * a - up * w * w + k->gravity);
    }
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const constants_t *k = constants;
    mct_hyperdual s, c;
    (void)time;
    mct_hyperdual_sincos(q[0], &s, &c);
    for (int i = 0; i < PARTICLES; i++) {
        position[i][0] =
            mct_hyperdual_sub(mct_hyperdual_scale(k->along[i], c), mct_hyperdual_scale(k->across[i], s));
        position[i][1] =
            mct_hyperdual_add(mct_hyperdual_scale(k->along[i], s), mct_hyperdual_scale(k->across[i], c));
        position[i][2] = mct_hyperdual_constant(0);
    }
}

MCT_HINGE_KERNELS(MCT_SMOOTH_KERNELS_3, MCT_TAYLOR_EXACT, MCT_GRAVITY, MCT_VISCOUS, MCT_COULOMB_MOREAU)

const mct_system mct_solid_pendulum = {
    .name = "solid_pendulum",
    .doc = "a box on an axle",
    .source = "5.4.1, 5.5.2",
    .coordinate_count = 1,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .input_without_motor = &torque_field,
    .effects = MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB,
    .standard_effects = MCT_GRAVITY | MCT_VISCOUS,
    .particle_count = PARTICLES,
    .particle_names = particle_names,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
    .motion = mct_solid_pendulum_motion,
};

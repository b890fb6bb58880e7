/*
 * Fixed axis: a rigid body of n point masses that turns about an axis of any direction through the origin.
 *
 * Equation      I a = u'sum x_i x m_i g - nu w + torque + dry friction,  x_i = e^(R[th u]) b_i,  u the axis,
 *               I = sum m_i |u x b_i|^2; spelled out in hinged_particles.c.
 * Source        sections 4.3 and 5.5, eqs. 264-275, 333-338, 351-353.
 * Conventions   th about the axis by the right hand, zero in the drawn position b; gravity is a vector.
 * Differences   (266), (267), (335), (352): the masses; (272): (x x u) x u times w; (268): b need not be orthogonal to u;
 *               (348): an unconstrained particle, whose matrix is singular, is ball_joint's. Friction and torque are
 *               ours.
 * Constraint    body and bearing, e = m xdd - m g, which also transmits the couples of friction and torque. Forces off
 *               the plane of motion are the bearing's: they do no work.
 * Validity      body rigid, bearing stiff; not all particles on the axis.
 */
#include "hinged_particles.h"
#include "mctau/matrix.h"
#include "systems.h"

enum { AXIS, GRAVITY = AXIS + 3, FRICTION = GRAVITY + 3, COULOMB, STATIC_RATIO, PARAMETERS };

#define AXIS_FIELD(name, standard, doc) MCT_QUANTITY(name, "", -1e6, 1e6, standard, doc)
#define GRAVITY_FIELD(name, standard, doc) \
    MCT_COEFFICIENT(MCT_GRAVITY, name, "m/s^2", -1e4, 1e4, standard, doc)

static const mct_field parameters[PARAMETERS] = {
    [AXIS] = AXIS_FIELD("axis_1", 0.1, "direction of the axis, of any length but 0; to the right"),
    [AXIS + 1] = AXIS_FIELD("axis_2", 1, "upwards"),
    [AXIS + 2] = AXIS_FIELD("axis_3", 0, "to the viewer"),
    [GRAVITY] = GRAVITY_FIELD("gravity_1", 0, "gravitational acceleration, to the right"),
    [GRAVITY + 1] = GRAVITY_FIELD("gravity_2", -9.81, "upwards"),
    [GRAVITY + 2] = GRAVITY_FIELD("gravity_3", 0, "to the viewer"),
    [FRICTION] =
        MCT_COEFFICIENT(MCT_VISCOUS, "friction", "N m s", 0, 1e6, 0.8, "viscous friction of the bearing"),
    [COULOMB] = MCT_COEFFICIENT(MCT_COULOMB, "coulomb", "N m", 0, 1e6, 0, "dry friction of the bearing"),
    [STATIC_RATIO] = MCT_STATIC_RATIO,
};

static const mct_field columns[] = {
    MCT_QUANTITY("mass", "kg", 1e-6, 1e6, 1, "of the particle"),
    MCT_QUANTITY("b1", "m", -1e4, 1e4, 0, "from the origin, which is on the axis, at angle 0: to the right"),
    MCT_QUANTITY("b2", "m", -1e4, 1e4, 0, "upwards"),
    MCT_QUANTITY("b3", "m", -1e4, 1e4, 0, "to the viewer"),
};

/* A gate on a post that leans: one by one metre, as four points. */
static const double standard[] = {5, 0.2, 0.2, 0, 5, 0.2, 0.8, 0, 5, 0.8, 0.2, 0, 5, 0.8, 0.8, 0};

static const mct_row_list lists[] = {
    {.name = "particles",
     .doc = "of the body, not all on the axis",
     .column_count = 4,
     .columns = columns,
     .fewest_rows = 1,
     .most_rows = MCT_MAX_PARTICLES,
     .standard_rows = 4,
     .standard = standard},
};

static const mct_coordinate coordinates[1] = {
    {.position = MCT_QUANTITY("angle", "rad", -1e6, 1e6, 2, "about the axis from the drawn position"),
     .rate = MCT_QUANTITY("angle_rate", "rad/s", -1e6, 1e6, 0, ""),
     .is_angle = true},
};

static const mct_field torque_field = MCT_QUANTITY("torque", "N m", -1e9, 1e9, 0, "about the axis");

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    const double *p = scene->parameters;
    const double *axis = p + AXIS;
    const double largest = mct_max(mct_abs(axis[0]), mct_max(mct_abs(axis[1]), mct_abs(axis[2])));
    if (!(largest > 0)) {
        mct_message_add(why, "parameters.axis: found 0, 0, 0; allowed a direction: not all three 0");
        return MCT_ERROR_UNSUITED;
    }
    mct_hinging hinging = {.friction = p[FRICTION], .coulomb = p[COULOMB], .static_ratio = p[STATIC_RATIO]};
    double square = 0;
    for (int i = 0; i < 3; i++) {
        hinging.axis[i] = axis[i] / largest; /* so that no square is lost */
        hinging.gravity[i] = p[GRAVITY + i];
        square += hinging.axis[i] * hinging.axis[i];
    }
    for (int i = 0; i < 3; i++) {
        hinging.axis[i] /= mct_sqrt(square);
    }
    return mct_hinged_particles_prepare(scene, h, &hinging, constants, why);
}

void mct_fixed_axis_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real u,
                           mct_motion *motion)
{
    mct_hinged_particles_motion(constants, effects, state, u, motion);
}

const mct_system mct_fixed_axis = {
    .name = "fixed_axis",
    .doc = "particles on one rigid body that turns about any axis",
    .source = "4.3, 5.5",
    .coordinate_count = 1,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .list_count = 1,
    .lists = lists,
    .input_without_motor = &torque_field,
    .effects = MCT_HINGED_EFFECTS,
    .standard_effects = MCT_GRAVITY | MCT_VISCOUS,
    .lists_particles = true,
    .particle_names = mct_particle_numbers,
    .prepare = prepare,
    .evaluate = mct_hinged_particles_evaluate,
    .place = mct_hinged_particles_place,
    .kernel = mct_hinged_particles_kernel,
    .motion = mct_fixed_axis_motion,
};

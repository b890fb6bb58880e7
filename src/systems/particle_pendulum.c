/*
 * Particle pendulum: n point masses on one rigid, massless body that turns in the plane about a fixed pivot.
 *
 * Equation      I a = g sum m_i (l1_i cos th + l2_i sin th) - nu w + torque + dry friction,  th the angle, w its rate, a
 *               its acceleration, I = sum m_i (l1_i^2 + l2_i^2).
 * Source        section 2.3, eqs. 104-114.
 * Conventions   th clockwise from the drawn position, in which l1 is to the right and l2 up: zero is upright for a body
 *               whose centre is on l2, as the source's is in (114).
 * Differences   (104): the matrix is 3 x 3, its last column (0, 0, 1)'; (110), (113): |l_i|^2. Friction and torque are
 *               ours.
 * Implemented   as fixed_axis, by an axis that points away from the viewer: hinged_particles.c.
 * Constraint    body and pivot, e = m xdd - (0, -m g, 0), which also transmits the couples of friction and torque.
 * Validity      body rigid; a particle at least away from the pivot.
 */
#include "hinged_particles.h"
#include "systems.h"

enum { GRAVITY, FRICTION, COULOMB, STATIC_RATIO, PARAMETERS };

static const mct_field parameters[PARAMETERS] = {
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity", "m/s^2", 0, 1e4, 9.81, "gravitational acceleration"),
    [FRICTION] =
        MCT_COEFFICIENT(MCT_VISCOUS, "friction", "N m s", 0, 1e6, 0.0005, "viscous friction of the pivot"),
    [COULOMB] = MCT_COEFFICIENT(MCT_COULOMB, "coulomb", "N m", 0, 1e6, 0, "dry friction of the pivot"),
    [STATIC_RATIO] = MCT_STATIC_RATIO,
};

static const mct_field columns[] = {
    MCT_QUANTITY("mass", "kg", 1e-6, 1e6, 0.1, "of the particle"),
    MCT_QUANTITY("l1", "m", -1e4, 1e4, 0, "from the pivot to the right, at angle 0"),
    MCT_QUANTITY("l2", "m", -1e4, 1e4, 0.3, "upwards, at angle 0"),
};

/* A rod with a bob to one side: its rest is not below. */
static const double standard[] = {0.05, 0, 0.1, 0.05, 0, 0.2, 0.1, 0.1, 0.3};

static const mct_row_list lists[] = {
    {.name = "particles",
     .doc = "of the body, not all at the pivot",
     .column_count = 3,
     .columns = columns,
     .fewest_rows = 1,
     .most_rows = MCT_MAX_PARTICLES,
     .standard_rows = 3,
     .standard = standard},
};

static const mct_coordinate coordinates[1] = {
    {.position = MCT_QUANTITY("angle", "rad", -1e6, 1e6, 0, "clockwise from the drawn position"),
     .rate = MCT_QUANTITY("angle_rate", "rad/s", -1e6, 1e6, 0, ""),
     .is_angle = true},
};

static const mct_field torque_field = MCT_QUANTITY("torque", "N m", -1e9, 1e9, 0, "about the pivot");

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    const double *p = scene->parameters;
    const mct_hinging hinging = {{0, 0, -1}, {0, -p[GRAVITY], 0}, p[FRICTION], p[COULOMB], p[STATIC_RATIO]};
    return mct_hinged_particles_prepare(scene, h, &hinging, constants, why);
}

void mct_particle_pendulum_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real u,
                                  mct_motion *motion)
{
    mct_hinged_particles_motion(constants, effects, state, u, motion);
}

const mct_system mct_particle_pendulum = {
    .name = "particle_pendulum",
    .doc = "particles on one rigid body that turns in the plane",
    .source = "2.3",
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
    .motion = mct_particle_pendulum_motion,
};

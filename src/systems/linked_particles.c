/*
 * Linked particles: two point masses m1, m2 on a rod along axis 1, a fixed distance c apart; a constant force acts on
 * each, and the input on the first one, along the rod.
 *
 * Equation      (m1 + m2) a = f11 + f21 + input,   x1 = (p, 0, 0),  x2 = (p + c, 0, 0).
 * Source        section 2.2, eqs. 85-103.
 * Conventions   p is the position of particle 1, to the right; f12 is the second component of the first force.
 * Differences   (86): J = (1, 0, 0)' and not (theta + c, 0, 0)'; (91), (92) lack the masses, (93) has J for C; (95), (96),
 *               (98) leave out f21; (103): m2 f11 / (m1 + m2) and not m1 f11 / (m1 + m2). The input is ours.
 * Constraint    rod and link, e = m xdd - f: along axis 1 the link's push, equal and opposite on the two; across, what
 *               the rod takes of the forces.
 * Validity      any m1, m2 > 0. Every stepper but `euler` is exact, up to rounding, under a held input.
 */
#include "mctau/linked_particles.h"

#include "../steppers/euler.h"
#include "../steppers/leap.h"
#include "../steppers/rk4_plain.h"
#include "../steppers/seed.h"
#define MCT_SYSTEM linked_particles
#include "kernels.h"
#include "mctau/scene.h"
#include "systems.h"

typedef mct_linked_particles_constants constants_t;

enum { MASS_1, MASS_2, SEPARATION, FORCE_1, FORCE_2 = FORCE_1 + 3, PARAMETERS = FORCE_2 + 3 };

#define FORCE(name, standard, doc) MCT_COEFFICIENT(MCT_FORCES, name, "N", -1e9, 1e9, standard, doc)

static const mct_field parameters[PARAMETERS] = {
    [MASS_1] = MCT_QUANTITY("mass_1", "kg", 1e-6, 1e6, 1, "particle 1"),
    [MASS_2] = MCT_QUANTITY("mass_2", "kg", 1e-6, 1e6, 0.5, "particle 2"),
    [SEPARATION] = MCT_QUANTITY("separation", "m", -1e6, 1e6, 0.3, "from particle 1 to particle 2"),
    [FORCE_1] = FORCE("force_1_1", 0.6, "on particle 1, along the rod"),
    [FORCE_1 + 1] = FORCE("force_1_2", 0, "on particle 1, upwards"),
    [FORCE_1 + 2] = FORCE("force_1_3", 0, "on particle 1, to the viewer"),
    [FORCE_2] = FORCE("force_2_1", 0, "on particle 2, along the rod"),
    [FORCE_2 + 1] = FORCE("force_2_2", 0, "on particle 2, upwards"),
    [FORCE_2 + 2] = FORCE("force_2_3", 0, "on particle 2, to the viewer"),
};

static const mct_coordinate coordinates[1] = {
    {.position = MCT_QUANTITY("position", "m", -1e6, 1e6, 0, "of particle 1, to the right"),
     .rate = MCT_QUANTITY("velocity", "m/s", -1e6, 1e6, 0, ""),
     .is_cyclic = true},
};

static const mct_field force_field =
    MCT_QUANTITY("force", "N", -1e9, 1e9, 0, "on particle 1, along the rod, beside its own");
static const char *const particle_names[] = {"first", "second"};

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const double total = p[MASS_1] + p[MASS_2];
    const bool pushed = scene->effects & MCT_FORCES;
    (void)why;
    k->step = mct_step_of(h);
    k->mass[0] = (mct_real)p[MASS_1];
    k->mass[1] = (mct_real)p[MASS_2];
    k->total_mass = (mct_real)total;
    k->inverse_mass = (mct_real)(1 / total);
    k->separation = (mct_real)p[SEPARATION];
    for (int i = 0; i < 3; i++) {
        k->force[0][i] = (mct_real)(pushed ? p[FORCE_1 + i] : 0);
        k->force[1][i] = (mct_real)(pushed ? p[FORCE_2 + i] : 0);
    }
    k->acceleration = (mct_real)(pushed ? (p[FORCE_1] + p[FORCE_2]) / total : 0);
    return MCT_OK;
}

MCT_INLINE mct_real acceleration(const constants_t *k, unsigned effects, mct_real u)
{
    const mct_real pushed = k->inverse_mass * u;
    return (effects & MCT_FORCES) ? k->acceleration + pushed : pushed;
}

MCT_INLINE void derivative(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                           mct_real *dx)
{
    dx[0] = x[1];
    dx[1] = acceleration(constants, effects, u);
}

MCT_INLINE void kick(const void *constants, unsigned effects, const mct_real *x, mct_real u, mct_real *dx)
{
    const constants_t *k = constants;
    (void)x;
    dx[1] = k->step.h * acceleration(k, effects, u);
}

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_real v = x[1];
    (void)effects;
    *out = (mct_evaluation){0};
    const mct_real along_1 = k->force[0][0] + u; /* force on each particle along the rod */
    const mct_real along_2 = k->force[1][0];
    out->M[0][0] = k->total_mass;
    out->tau[0] = along_1 + along_2;
    out->acceleration[0] = k->inverse_mass * out->tau[0];
    out->mass[0] = k->mass[0];
    out->mass[1] = k->mass[1];
    out->position[0][0] = x[0];
    out->position[1][0] = x[0] + k->separation;
    out->force[0][0] = along_1;
    out->force[1][0] = along_2;
    /* m1 a - f11, without a difference of large numbers. */
    const mct_real push = k->inverse_mass * (k->mass[0] * along_2 - k->mass[1] * along_1);
    out->constraint_force[0][0] = push;
    out->constraint_force[1][0] = -push;
    for (int i = 1; i < 3; i++) {
        out->force[0][i] = k->force[0][i];
        out->force[1][i] = k->force[1][i];
        out->constraint_force[0][i] = 0 - k->force[0][i]; /* not -0 */
        out->constraint_force[1][i] = 0 - k->force[1][i];
    }
    out->kinetic_energy = MCT_R(0.5) * k->total_mass * v * v;
    out->power_input = u * v;
    out->power[MCT_EFFECT_FORCES] = (k->force[0][0] + k->force[1][0]) * v;
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const constants_t *k = constants;
    const mct_hyperdual zero = mct_hyperdual_constant(0);
    (void)time;
    position[0][0] = q[0];
    position[1][0] = mct_hyperdual_add(q[0], mct_hyperdual_constant(k->separation));
    position[0][1] = position[0][2] = position[1][1] = position[1][2] = zero;
}

static const uint32_t switches[] = {MCT_FORCES, 0};
#define friction mct_no_friction

MCT_KERNELS_1(seed, k->step.remainder, 1, MCT_FORCES, mct_seed(derivative, k, k->step, effects, 1, x, u, dx))
MCT_KERNELS_1(euler, k->step.remainder, 1, MCT_FORCES, mct_euler(kick, k, k->step, effects, 1, x, u, dx))
MCT_KERNELS_1(leap, k->step.remainder, 1, MCT_FORCES, mct_leap(kick, k, k->step, effects, 1, x, u, dx))
MCT_KERNELS_1(rk4, k->step.sixth_remainder, 1, MCT_FORCES,
              mct_rk4_plain(derivative, k, k->step, effects, 1, x, u, dx))

static const mct_named_kernel *kernel(int stepper, uint32_t effects)
{
    static const mct_named_kernel *const kernels[MCT_STEPPER_COUNT] = {
        [MCT_STEPPER_SEED] = seed_kernels,
        [MCT_STEPPER_EULER] = euler_kernels,
        [MCT_STEPPER_LEAP] = leap_kernels,
        [MCT_STEPPER_RK4] = rk4_kernels,
    };
    return mct_switched_kernel_of(kernels, switches, stepper, effects);
}

const mct_system mct_linked_particles = {
    .name = "linked_particles",
    .doc = "two particles on a rod, a fixed distance apart",
    .source = "2.2",
    .coordinate_count = 1,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .input_without_motor = &force_field,
    .effects = MCT_FORCES,
    .standard_effects = MCT_FORCES,
    .particle_count = 2,
    .particle_names = particle_names,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
};

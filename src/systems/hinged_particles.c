/*
 * A body of particles m_i, b_i that turns by th about the axis u, |u| = 1, through the origin.
 *
 * Equation      x_i = z_i u + cos th r_i + sin th u x r_i,    z_i = u'b_i,  r_i = b_i - z_i u
 *               I a = P sin th + Q cos th - nu w + torque + dry friction
 *               I = sum m_i |r_i|^2,   P = - g'S,   Q = g'(u x S),   S = sum m_i r_i
 * Constraint    e_i = m_i xdd_i - m_i g, with xdd_i = a u x x_i - w^2 (x_i - z_i u). The force of the hinge is the sum of
 *               all e_i, its moment that of x_i x e_i.
 * Source        sections 4.3 and 5.5, eqs. 264-275, 333-338; in the plane 2.3, eqs. 104-114.
 */
#include "hinged_particles.h"

#include "mctau/matrix.h"
#include "mctau/rotation.h"

#define MCT_SYSTEM hinged_particles
#define MCT_ALWAYS (MCT_HINGE_SINE | MCT_HINGE_COSINE)
#include "hinge.h"

typedef mct_hinged_particles constants_t;

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double *a, const double *b, double *product)
{
    for (int i = 0; i < 3; i++) {
        product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

mct_status mct_hinged_particles_prepare(const mct_scene *scene, double h, const mct_hinging *hinging,
                                        mct_hinged_particles *k, mct_message *why)
{
    const int columns = mct_systems[scene->system]->lists[0].column_count;
    const double *u = hinging->axis;
    double gravity[3] = {0};
    double level_moment = 0; /* sum m z */
    double moment[3] = {0};  /* S */
    double about_axis = 0, about_origin = 0;
    k->count = mct_particle_count(scene);
    for (int i = 0; i < k->count; i++) {
        const double *row = scene->lists[0].values + columns * i;
        const double mass = row[0];
        const double b[3] = {row[1], row[2], columns > 3 ? row[3] : 0};
        const double along = dot(u, b);
        double radius[3];
        for (int j = 0; j < 3; j++) {
            radius[j] = b[j] - along * u[j];
            moment[j] += mass * radius[j];
            k->particle[i].radius[j] = (mct_real)radius[j];
        }
        k->particle[i].mass = (mct_real)mass;
        k->particle[i].along = (mct_real)along;
        level_moment += mass * along;
        about_axis += mass * dot(radius, radius);
        about_origin += mass * dot(b, b);
    }
    const double least = mct_max(MCT_LEAST_INERTIA, MCT_LEAST_INERTIA_SHARE * about_origin);
    if (!(about_axis >= least)) {
        mct_message_add(why, "parameters.particles: found an inertia of ");
        mct_message_add_number(why, about_axis);
        mct_message_add(why, " kg m^2 about the axis; allowed from ");
        mct_message_add_number(why, least);
        mct_message_add(why, " kg m^2");
        return MCT_ERROR_UNSUITED;
    }
    for (int j = 0; j < 3; j++) {
        gravity[j] = (scene->effects & MCT_GRAVITY) ? hinging->gravity[j] : 0;
        k->axis[j] = (mct_real)u[j];
        k->gravity[j] = (mct_real)gravity[j];
    }
    double turned[3];
    cross(u, moment, turned);
    k->level_potential = (mct_real)(-level_moment * dot(gravity, u));
    k->hinge = (mct_hinge){
        .step = mct_step_of(h),
        .inertia = (mct_real)about_axis,
        .inverse_inertia = (mct_real)(1 / about_axis),
        .sine_moment = (mct_real)-dot(gravity, moment),
        .cosine_moment = (mct_real)dot(gravity, turned),
        .viscous = (mct_real)((scene->effects & MCT_VISCOUS) ? hinging->friction : 0),
        .coulomb = (mct_real)((scene->effects & MCT_COULOMB) ? hinging->coulomb : 0),
        .hold = (mct_real)((scene->effects & MCT_COULOMB) ? hinging->static_ratio * hinging->coulomb : 0),
    };
    return MCT_OK;
}

void mct_hinged_particles_evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                                   mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_real w = x[1];
    mct_real s, c;
    mct_sincos(x[0], &s, &c);
    mct_hinge_evaluate(&k->hinge, effects, s, c, w, u, out);
    out->potential_energy += k->level_potential;
    const mct_real a = out->acceleration[0];
    for (int i = 0; i < k->count; i++) {
        const mct_real mass = k->particle[i].mass;
        const mct_real *const radius = k->particle[i].radius;
        mct_real across[3];
        mct_cross(k->axis, radius, across);
        out->mass[i] = mass;
        for (int j = 0; j < 3; j++) {
            const mct_real outwards = c * radius[j] + s * across[j];
            const mct_real forwards = c * across[j] - s * radius[j]; /* dx/dth */
            out->position[i][j] = k->particle[i].along * k->axis[j] + outwards;
            out->force[i][j] = mass * k->gravity[j];
            out->constraint_force[i][j] = mass * (forwards * a - outwards * w * w - k->gravity[j]);
        }
    }
}

void mct_hinged_particles_place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                                mct_hyperdual (*position)[3])
{
    const constants_t *k = constants;
    mct_hyperdual s, c;
    (void)time;
    mct_hyperdual_sincos(q[0], &s, &c);
    for (int i = 0; i < k->count; i++) {
        const mct_real *const radius = k->particle[i].radius;
        mct_real across[3];
        mct_cross(k->axis, radius, across);
        for (int j = 0; j < 3; j++) {
            const mct_hyperdual outwards =
                mct_hyperdual_add(mct_hyperdual_scale(radius[j], c), mct_hyperdual_scale(across[j], s));
            position[i][j] =
                mct_hyperdual_add(mct_hyperdual_constant(k->particle[i].along * k->axis[j]), outwards);
        }
    }
}

MCT_HINGE_KERNELS(MCT_SMOOTH_KERNELS_3, MCT_TAYLOR_EXACT, MCT_GRAVITY, MCT_VISCOUS, MCT_COULOMB_MOREAU)

const mct_named_kernel *mct_hinged_particles_kernel(int stepper, uint32_t effects)
{
    return kernel(stepper, effects);
}

/*
 * Rigid body: particles m at b, fixed to each other, that move and turn freely under gravity, constant forces
 * on points of the body, and drag.
 *
 * Equation      m xdd = F + m g - c |v| v,  I wd + w x I w = couple - d |w| w,  F and couple of the forces,
 *               couple = sum p x F,  I = sum m (b'b - b b'); p and b from the centre.
 * Source        section 6, eqs. 372-419.
 * Conventions   position and velocity are those of the centre of mass, in space axes, as (378); q takes body
 *               axes to space axes; w is the angular velocity in body axes, as (417) needs it. A force's
 *               point is fixed in the body; its vector is constant in space axes or in body axes.
 * Differences   (381), (419): the rate of a rotation vector is not w; (382), (388), (390), (392): masses and
 *               signs; (404): without torque the angular momentum is constant, not w. C = m J'Jdot = R[S w],
 *               S = sum m b b', is not R'[I w] of (392), but for what it does to w. Drag is ours.
 * Particles     A body given by mass, inertia and centre moves as six: mct_equimomental_particles().
 * Constraint    the body itself, e = m xdd - m g, which also transmits forces, drag and couples to the
 *               particles.
 * Validity      body rigid, with inertia about every axis. Drag knows no shape.
 */
#include "mctau/rigid_body.h"

#include <string.h>

#include "../steppers/rk4_plain.h"
#define MCT_SYSTEM rigid_body
#define MCT_ALWAYS MCT_ROTATION
#include "kernels.h"
#include "mctau/inertia.h"
#include "mctau/scene.h"
#include "rotor.h"
#include "systems.h"

typedef mct_rigid_body_constants constants_t;

enum { N = 6 };                                           /* coordinates */
enum { X_STATE, Q_STATE = 3, V_STATE = 7, W_STATE = 10 }; /* places in the state, */
enum { Q, W = 4, X = 7, V = 10 }; /* and where steps are taken: what turns comes first */

enum {
    MASS,
    INERTIA,
    CENTER = INERTIA + 9,
    GRAVITY = CENTER + 3,
    DRAG = GRAVITY + 3,
    ANGULAR_DRAG,
    PARAMETERS
};

#define MOMENT(name, doc) MCT_QUANTITY("inertia_" name, "kg m^2", -1e12, 1e12, 0, doc)
#define PLACE(name, doc)  MCT_QUANTITY("centre_" name, "m", -1e3, 1e3, 0, doc)

static const mct_field parameters[PARAMETERS] = {
    [MASS] = MCT_QUANTITY("mass", "kg", 0, 1e6, 0, "of the body, when it has no particles"),
    [INERTIA] = MOMENT("1_1", "about the centre, in body axes, when it has no particles"),
    [INERTIA + 1] = MOMENT("1_2", "row 1, column 2 of it"),
    [INERTIA + 2] = MOMENT("1_3", "row 1, column 3 of it"),
    [INERTIA + 3] = MOMENT("2_1", "row 2, column 1 of it"),
    [INERTIA + 4] = MOMENT("2_2", "row 2, column 2 of it"),
    [INERTIA + 5] = MOMENT("2_3", "row 2, column 3 of it"),
    [INERTIA + 6] = MOMENT("3_1", "row 3, column 1 of it"),
    [INERTIA + 7] = MOMENT("3_2", "row 3, column 2 of it"),
    [INERTIA + 8] = MOMENT("3_3", "row 3, column 3 of it"),
    [CENTER] = PLACE("1", "of mass, in body axes, when it has no particles"),
    [CENTER + 1] = PLACE("2", "its second coordinate"),
    [CENTER + 2] = PLACE("3", "its third coordinate"),
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity_1", "m/s^2", -1e4, 1e4, 0,
                                "gravitational acceleration, to the right"),
    [GRAVITY + 1] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity_2", "m/s^2", -1e4, 1e4, -9.81, "upwards"),
    [GRAVITY + 2] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity_3", "m/s^2", -1e4, 1e4, 0, "to the viewer"),
    [DRAG] = MCT_COEFFICIENT(MCT_DRAG, "drag", "N s^2/m^2", 0, 1e6, 0.01,
                             "force of the air by the square of the velocity"),
    [ANGULAR_DRAG] = MCT_COEFFICIENT(MCT_DRAG, "angular_drag", "N m s^2", 0, 1e6, 1e-5,
                                     "its couple by the square of the angular velocity"),
};

/* A racket, three different moments: the least about its handle, axis 1; the largest about axis 3. */
static const double racket[] = {
    0.05, -0.3, 0,     0, /**/
    0.04, 0.15, 0.11,  0, /**/
    0.04, 0.15, -0.11, 0, /**/
    0.03, 0.3,  0,     0,
};
enum { RACKET_ROWS = 4 };

static const char *const frames[] = {"space", "body", NULL};
enum { FRAME_SPACE, FRAME_BODY };
enum { FRAME, POINT, FORCE = POINT + 3, FORCE_COLUMNS = FORCE + 3 };

#define POINT_OF(name, doc) MCT_QUANTITY(name, "m", -1e3, 1e3, 0, doc)
#define FORCE_OF(name, doc) MCT_QUANTITY(name, "N", -1e9, 1e9, 0, doc)

static const mct_field force_columns[FORCE_COLUMNS] = {
    [FRAME] = {"frame", "", "axes in which the force is constant", MCT_FIELD_CHOICE, 0, 1, 0, frames, 0, 0},
    [POINT] = POINT_OF("p1", "where it acts, in body axes"),
    [POINT + 1] = POINT_OF("p2", ""),
    [POINT + 2] = POINT_OF("p3", ""),
    [FORCE] = FORCE_OF("f1", "force"),
    [FORCE + 1] = FORCE_OF("f2", ""),
    [FORCE + 2] = FORCE_OF("f3", ""),
};

enum { PARTICLES, FORCES };
static const mct_row_list lists[] = {
    [PARTICLES] = {.name = "particles",
                   .doc = "mass and place in body axes of each; none: mass, inertia and centre",
                   .column_count = MCT_ROTOR_COLUMNS,
                   .columns = mct_rotor_columns,
                   .fewest_rows = 0,
                   .most_rows = MCT_MAX_PARTICLES,
                   .standard_rows = RACKET_ROWS,
                   .standard = racket},
    [FORCES] = {.name = "forces",
                .doc = "constant forces on points of the body",
                .effects = MCT_FORCES,
                .column_count = FORCE_COLUMNS,
                .columns = force_columns,
                .fewest_rows = 0,
                .most_rows = 16,
                .standard_rows = 0,
                .standard = racket /* none of it */},
};

#define SHIFT(axis, what)                                                                      \
    {                                                                                          \
        .position = MCT_QUANTITY("position_" axis, "m", -1e6, 1e6, 0, "of the centre, " what), \
        .rate = MCT_QUANTITY("velocity_" axis, "m/s", -1e6, 1e6, 0, "")                        \
    }
#define TURN(axis, standard, what)                                                                \
    {                                                                                             \
        .position = MCT_QUANTITY("rotation_" axis, "rad", -1e6, 1e6, 0, "about body axis " axis), \
        .rate = MCT_QUANTITY("angular_velocity_" axis, "rad/s", -1e6, 1e6, standard, what)        \
    }

static const mct_coordinate coordinates[N] = {
    SHIFT("1", "to the right"),   SHIFT("2", "upwards"), SHIFT("3", "to the viewer"),
    TURN("1", 0, "in body axes"), TURN("2", 0, ""),      TURN("3", 0, ""),
};

/* --- constants --- */

static void add_figures(struct mct_message *why, const double *figures, const char *unit)
{
    for (int i = 0; i < 3; i++) {
        mct_message_add(why, i == 0 ? "" : i == 1 ? ", " : " and ");
        mct_message_add_number(why, figures[i]);
    }
    mct_message_add(why, unit);
}

static mct_status refuse_two_descriptions(int rows, int parameter, double value, struct mct_message *why)
{
    const mct_field *field = &parameters[parameter];
    mct_message_add(why, "parameters.");
    mct_message_add(why, field->name);
    mct_message_add(why, ": found ");
    mct_message_add_number(why, value);
    mct_message_add(why, " ");
    mct_message_add(why, field->unit);
    mct_message_add(why, " beside ");
    mct_message_add_integer(why, rows);
    mct_message_add(why, rows == 1 ? " particle" : " particles");
    mct_message_add(why, "; allowed particles alone, or particles = [] with mass, inertia and centre");
    return MCT_ERROR_UNSUITED;
}

static mct_status refuse_inertia(const mct_inertia_report *report, struct mct_message *why)
{
    mct_message_add(why, "parameters.inertia: found ");
    if (report->fault == MCT_INERTIA_NOT_SYMMETRIC) {
        mct_message_add_number(why, report->found);
        mct_message_add(why, " kg m^2 in row ");
        mct_message_add_integer(why, report->row + 1);
        mct_message_add(why, ", column ");
        mct_message_add_integer(why, report->column + 1);
        mct_message_add(why, ", and ");
        mct_message_add_number(why, report->bound);
        mct_message_add(why, " opposite; allowed a symmetric one");
        return MCT_ERROR_UNSUITED;
    }
    mct_message_add(why, "principal moments ");
    add_figures(why, report->moments, " kg m^2");
    mct_message_add(why, report->fault == MCT_INERTIA_NEGATIVE
                             ? "; allowed none below 0"
                             : "; allowed none above the sum of the other two, or no body has them");
    return MCT_ERROR_UNSUITED;
}

/* The particles of a body that is given by its mass, inertia and centre: rows as in a list. */
static mct_status particles_of(const double *p, double *particles, struct mct_message *why)
{
    mct_body body = {.mass = p[MASS]};
    mct_inertia_report report;
    double place[MCT_EQUIMOMENTAL_COUNT][3];
    if (p[MASS] <= 0) {
        mct_message_add(why, "parameters.mass: found 0 kg and no particles; allowed one of them");
        return MCT_ERROR_UNSUITED;
    }
    memcpy(body.center, p + CENTER, sizeof body.center);
    memcpy(body.inertia, p + INERTIA, sizeof body.inertia);
    mct_status status = mct_inertia_check(body.inertia, &report);
    if (status != MCT_OK) {
        return report.fault == MCT_INERTIA_PHYSICAL ? status : refuse_inertia(&report, why);
    }
    status = mct_equimomental_particles(&body, place);
    for (int n = 0; n < MCT_EQUIMOMENTAL_COUNT; n++) {
        double *row = particles + MCT_ROTOR_COLUMNS * n;
        row[0] = body.mass / MCT_EQUIMOMENTAL_COUNT;
        memcpy(row + 1, place[n], sizeof place[n]);
    }
    return status;
}

static mct_status refuse_line(int rows, const double *moments, struct mct_message *why)
{
    mct_message_add(why, rows > 0 ? "parameters.particles" : "parameters.inertia");
    mct_message_add(why, ": found principal moments ");
    add_figures(why, moments, " kg m^2");
    mct_message_add(why, rows > 0 ? ", particles on one line" : "");
    mct_message_add(
        why,
        "; allowed none below 1e-10 of the largest, for how the body turns about that axis is not defined");
    return MCT_ERROR_UNSUITED;
}

static void add_force(const double *row, const double *center, double space_force[3],
                      double space_lever[3][3], double body_force[3], double body_couple[3])
{
    const double *f = row + FORCE;
    double arm[3];
    for (int i = 0; i < 3; i++) {
        arm[i] = row[POINT + i] - center[i];
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const int l = (i + 2) % 3;
        if (row[FRAME] == FRAME_BODY) {
            body_force[i] += f[i];
            body_couple[i] += arm[j] * f[l] - arm[l] * f[j];
        } else {
            space_force[i] += f[i];
            for (int column = 0; column < 3; column++) {
                space_lever[i][column] += arm[i] * f[column];
            }
        }
    }
}

/* Forces and couples in principal axes. */
static void prepare_forces(const struct mct_scene *scene, const double *center, constants_t *k)
{
    const mct_rotor *rotor = &k->rotor;
    double space_force[3] = {0}, space_lever[3][3] = {{0}}, body_force[3] = {0}, body_couple[3] = {0};
    const mct_list *list = &scene->lists[FORCES];
    for (int32_t i = 0; (scene->effects & MCT_FORCES) && i < list->count; i += FORCE_COLUMNS) {
        add_force(list->values + i, center, space_force, space_lever, body_force, body_couple);
    }
    for (int i = 0; i < 3; i++) {
        double force = 0, couple = 0, lever[3] = {0};
        for (int l = 0; l < 3; l++) {
            const double axis = (double)rotor->axes[i][l];
            force += axis * body_force[l];
            couple += axis * body_couple[l];
            for (int j = 0; j < 3; j++) {
                lever[j] += axis * space_lever[l][j];
            }
        }
        k->space_force[i] = (mct_real)space_force[i];
        k->body_force[i] = (mct_real)force;
        k->body_couple[i] = (mct_real)couple;
        for (int j = 0; j < 3; j++) {
            k->space_lever[i][j] = (mct_real)lever[j];
        }
    }
}

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const int rows = scene->lists[PARTICLES].count / MCT_ROTOR_COLUMNS;
    double made[MCT_ROTOR_COLUMNS * MCT_EQUIMOMENTAL_COUNT], moments[3] = {0};
    mct_body body;
    *k = (constants_t){0};
    for (int i = MASS; i < GRAVITY && rows > 0; i++) {
        if (p[i] != 0) {
            return refuse_two_descriptions(rows, i, p[i], why);
        }
    }
    mct_status status = rows > 0 ? MCT_OK : particles_of(p, made, why);
    if (status != MCT_OK) {
        return status;
    }
    status = mct_rotor_prepare(rows > 0 ? scene->lists[PARTICLES].values : made, mct_particle_count(scene),
                               true, h, &k->rotor, &body, moments);
    if (status == MCT_ERROR_SINGULAR || mct_dot(k->rotor.idle_axis, k->rotor.idle_axis) > 0) {
        return refuse_line(rows, moments, why);
    }
    if (status != MCT_OK) {
        return status;
    }
    k->rotor.drag = (mct_real)((scene->effects & MCT_DRAG) ? p[ANGULAR_DRAG] : 0);
    k->drag = (mct_real)((scene->effects & MCT_DRAG) ? p[DRAG] : 0);
    k->inverse_mass = (mct_real)(1 / body.mass);
    for (int i = 0; i < 3; i++) {
        k->gravity[i] = (mct_real)((scene->effects & MCT_GRAVITY) ? p[GRAVITY + i] : 0);
    }
    prepare_forces(scene, body.center, k);
    return MCT_OK;
}

/* --- what acts: all in principal axes but for what is called space, and for place and velocity --- */

/* Force in space axes and couple about the centre, both of the forces alone. */
MCT_INLINE void forces_at(const constants_t *k, unsigned effects, const mct_real *q, mct_real *force,
                          mct_real *couple)
{
    if (!(effects & MCT_FORCES)) {
        for (int i = 0; i < 3; i++) {
            force[i] = 0;
            couple[i] = 0;
        }
        return;
    }
    mct_real lever[3][3]; /* sum p (r'F)' */
    mct_rotate(q, k->body_force, force);
    for (int i = 0; i < 3; i++) {
        mct_rotate_back(q, k->space_lever[i], lever[i]);
        force[i] += k->space_force[i];
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const int l = (i + 2) % 3;
        couple[i] = k->body_couple[i] + (lever[j][l] - lever[l][j]);
    }
}

/* Acceleration of the centre by all but drag, and couple, at an attitude. */
MCT_INLINE void act(const constants_t *k, unsigned effects, const mct_real *q, mct_real *a, mct_real *couple)
{
    forces_at(k, effects, q, a, couple);
    for (int i = 0; i < 3; i++) {
        a[i] *= k->inverse_mass;
        if (effects & MCT_GRAVITY) {
            a[i] += k->gravity[i];
        }
    }
}

MCT_INLINE void derivative(const void *constants, unsigned effects, const mct_real *y, mct_real u,
                           mct_real *dy)
{
    const constants_t *k = constants;
    mct_real couple[3], slope;
    (void)u;
    act(k, effects, y + Q, dy + V, couple);
    const mct_real damping = mct_damping(effects, 0, k->inverse_mass * k->drag, y + V, &slope);
    for (int i = 0; i < 3; i++) {
        dy[X + i] = y[V + i];
        if (effects & MCT_DRAG) {
            dy[V + i] -= damping * y[V + i];
        }
    }
    mct_rotor_turn_rate(y + Q, y + W, dy + Q);
    mct_rotor_accelerate(&k->rotor, effects, couple, y + W, dy + W);
}

/* Of attitude and half the angular velocity, without a couple: qd = q (0, w/2). */
MCT_INLINE void free_turn(const void *constants, unsigned effects, const mct_real *y, mct_real u,
                          mct_real *dy)
{
    const mct_real *coupling = ((const constants_t *)constants)->rotor.coupling;
    const mct_real *const q = y + Q, *const v = y + W;
    (void)effects;
    (void)u;
    dy[Q] = -(q[1] * v[0] + q[2] * v[1]) - q[3] * v[2];
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        const int l = (i + 2) % 3;
        dy[Q + 1 + i] = (q[0] * v[i] + q[1 + j] * v[l]) - q[1 + l] * v[j];
        dy[W + i] = (2 * coupling[i] * v[j]) * v[l];
    }
}

/* --- steppers --- */

/* (410), (411), (418), and (419) with a turn. */
MCT_INLINE void seed(const constants_t *k, unsigned effects, int order, const mct_real *y, mct_real *dy)
{
    const mct_step *step = &k->rotor.step;
    mct_real turn[3];
    (void)order;
    derivative(k, effects, y, 0, dy);
    for (int i = 0; i < 3; i++) {
        dy[X + i] = step->h * (y[V + i] + step->half * dy[V + i]);
        turn[i] = step->h * (y[W + i] + step->half * dy[W + i]);
        dy[V + i] *= step->h;
        dy[W + i] *= step->h;
    }
    mct_quaternion_turn_body(y + Q, turn, dy + Q);
    mct_rotor_renormalise(y + Q, dy + Q);
}

/*
 * dv under an acceleration a and drag D v: (1 + h D) dv = h (a - D v) for `euler`,
 * (1 + h/2 (D + slope v v')) dv = h (a - D v) for `leap`, at the midpoint.
 */
MCT_INLINE void push(const constants_t *k, unsigned effects, bool is_midpoint, const mct_real *a,
                     const mct_real *v, mct_real *dv)
{
    const mct_real h = k->rotor.step.h;
    const mct_real share = is_midpoint ? k->rotor.step.half : h;
    if (!(effects & MCT_DRAG)) {
        for (int i = 0; i < 3; i++) {
            dv[i] = h * a[i];
        }
        return;
    }
    mct_real slope;
    const mct_real damping = mct_damping(effects, 0, k->inverse_mass * k->drag, v, &slope);
    const mct_real whole = 1 + share * damping;
    for (int i = 0; i < 3; i++) {
        dv[i] = h * (a[i] - damping * v[i]) / whole;
    }
    if (is_midpoint) { /* Sherman and Morrison; slope v'v = D */
        const mct_real along = share * slope * mct_dot(v, dv) / (whole + share * damping);
        for (int i = 0; i < 3; i++) {
            dv[i] -= along * v[i];
        }
    }
}

/* Momentum and angular momentum by what acts, then the body moves and turns under them. */
MCT_INLINE void euler(const constants_t *k, unsigned effects, int order, const mct_real *y, mct_real *dy)
{
    const mct_real h = k->rotor.step.h;
    mct_real a[3], couple[3], w[3], e[4], carried[3];
    (void)order;
    act(k, effects, y + Q, a, couple);
    push(k, effects, false, a, y + V, dy + V);
    mct_rotor_push(&k->rotor, effects, couple, y + W, dy + W);
    for (int i = 0; i < 3; i++) {
        dy[X + i] = h * (y[V + i] + dy[V + i]);
        w[i] = y[W + i] + dy[W + i];
    }
    mct_rotor_carry(&k->rotor, w, e, carried);
    mct_quaternion_multiply(y + Q, e, dy + Q);
    for (int i = 0; i < 3; i++) {
        dy[W + i] += carried[i];
    }
    mct_rotor_renormalise(y + Q, dy + Q);
}

/* Half a way and half a turn, a kick at the middle, the other half. No force depends on where the body is. */
MCT_INLINE void leap(const constants_t *k, unsigned effects, int order, const mct_real *y, mct_real *dy)
{
    const mct_step *step = &k->rotor.step;
    mct_real a[3], couple[3], w[3], middle[4], end[4], second[4];
    (void)order;
    mct_rotor_drift(y + Q, y + W, step->half, dy + Q, middle);
    act(k, effects, middle, a, couple);
    push(k, effects, true, a, y + V, dy + V);
    mct_rotor_kick(&k->rotor, effects, couple, y + W, dy + W);
    for (int i = 0; i < 3; i++) {
        dy[X + i] = step->h * y[V + i] + step->half * dy[V + i];
        w[i] = y[W + i] + dy[W + i];
    }
    mct_rotor_drift(middle, w, step->half, second, end);
    for (int i = 0; i < 4; i++) {
        dy[Q + i] += second[i];
    }
    mct_rotor_renormalise(y + Q, dy + Q);
}

/* Half a kick, all of the turn and the way, half a kick. No drag, whose kick has no such form. */
MCT_INLINE void split3(const constants_t *k, unsigned effects, int order, const mct_real *y, mct_real *dy)
{
    const mct_rotor *rotor = &k->rotor;
    mct_real a[3], couple[3], w[3], end[4], dw[3];
    (void)order;
    act(k, effects, y + Q, a, couple);
    mct_rotor_half_kick(rotor, effects, couple, y + W, dy + W);
    mct_rotor_split(rotor, y + Q, y + W, dy + Q, dy + W);
    for (int i = 0; i < 4; i++) {
        end[i] = y[Q + i] + dy[Q + i];
    }
    for (int i = 0; i < 3; i++) {
        dy[V + i] = rotor->step.half * a[i];
        dy[X + i] = rotor->step.h * (y[V + i] + dy[V + i]);
        w[i] = y[W + i] + dy[W + i];
    }
    act(k, effects, end, a, couple);
    mct_rotor_half_kick(rotor, effects, couple, w, dw);
    for (int i = 0; i < 3; i++) {
        dy[V + i] += rotor->step.half * a[i];
        dy[W + i] += dw[i];
    }
    mct_rotor_renormalise(y + Q, dy + Q);
}

/* The centre under its weight alone: exact. */
MCT_INLINE void fall(const constants_t *k, unsigned effects, const mct_real *y, mct_real *dy)
{
    const mct_step *step = &k->rotor.step;
    for (int i = 0; i < 3; i++) {
        dy[V + i] = (effects & MCT_GRAVITY) ? step->h * k->gravity[i] : 0;
        dy[X + i] = step->h * y[V + i] + step->half * dy[V + i];
    }
}

MCT_INLINE void rk4(const constants_t *k, unsigned effects, int order, const mct_real *y, mct_real *dy)
{
    (void)order;
    if (effects & (MCT_FORCES | MCT_DRAG)) {
        mct_rk4_plain(derivative, k, k->rotor.step, effects, N, y, 0, dy);
    } else {
        mct_real half[7];
        for (int i = 0; i < 7; i++) {
            half[i] = i < W ? y[i] : MCT_R(0.5) * y[i];
        }
        mct_rk4_plain(free_turn, k, k->rotor.step, effects, N - 3, half, 0, dy);
        for (int i = W; i < X; i++) {
            dy[i] *= 2;
        }
        fall(k, effects, y, dy);
    }
    mct_rotor_renormalise(y + Q, dy + Q);
}

/*
 * The axes of space, seen from the body, turn back as it turns; forces and couples are linear in them.
 */
MCT_INLINE void forced_series(const constants_t *k, unsigned effects, int order, const mct_real *y,
                              mct_real *dy)
{
    const mct_real h = k->rotor.step.h;
    mct_rotor_series turning;
    mct_vector_series axes[3];
    mct_series v[3] = {{0}}; /* the compiler cannot see that all that is summed is written */
    mct_rotor_series_start(y + Q, y + W, &turning);
    for (int axis = 0; axis < 3; axis++) {
        const mct_real unit[3] = {axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0};
        v[axis][0] = y[V + axis];
        mct_rotate_back(y + Q, unit, axes[axis][0]);
    }
    for (int n = 0; n < order; n++) {
        const mct_real share = h * mct_series_share(n);
        mct_real couple[3] = {0, 0, 0};
        for (int axis = 0; axis < 3; axis++) {
            const mct_real lever[3] = {k->space_lever[0][axis], k->space_lever[1][axis],
                                       k->space_lever[2][axis]};
            const mct_real constant[3] = {n == 0 ? k->space_force[axis] : 0,
                                          n == 0 ? k->body_couple[axis] : 0,
                                          (effects & MCT_GRAVITY) && n == 0 ? k->gravity[axis] : 0};
            mct_real part[3];
            mct_cross(lever, axes[axis][n], part);
            couple[axis] += constant[1];
            MCT_UNROLL
            for (int i = 0; i < 3; i++) {
                couple[i] += part[i];
            }
            v[axis][n + 1] =
                share *
                (constant[2] + k->inverse_mass * (constant[0] + mct_dot(axes[axis][n], k->body_force)));
            mct_rotor_series_turn_back(&k->rotor, &turning, n, axes[axis]);
        }
        mct_rotor_series_next(&k->rotor, effects, couple, n, &turning);
    }
    for (int axis = 0; axis < 3; axis++) {
        mct_series_increments(v[axis], h, order, &dy[X + axis], &dy[V + axis]);
    }
    mct_rotor_series_sum(&turning, order, dy + Q, dy + W);
    mct_rotor_renormalise(y + Q, dy + Q);
}

/* No drag: |v| v has a kink where the body stops. */
MCT_INLINE void series(const constants_t *k, unsigned effects, int order, const mct_real *y, mct_real *dy)
{
    if (effects & MCT_FORCES) {
        forced_series(k, effects, order, y, dy);
    } else {
        mct_rotor_free_series(&k->rotor, order, y + Q, y + W, dy + Q, dy + W);
        fall(k, effects, y, dy);
    }
}

typedef void (*step_in_principal_axes)(const constants_t *k, unsigned effects, int order, const mct_real *y,
                                       mct_real *dy);

/* A state in principal axes, */
MCT_INLINE void enter(const mct_rotor *rotor, const mct_real *x, mct_real *y)
{
    mct_rotor_enter(rotor, x + Q_STATE, y + Q);
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        y[W + i] = rotor->is_turned ? mct_dot(rotor->axes[i], x + W_STATE) : x[W_STATE + i];
        y[X + i] = x[X_STATE + i];
        y[V + i] = x[V_STATE + i];
    }
}

/* and its increment on the way back. */
MCT_INLINE void leave(const mct_rotor *rotor, const mct_real *dy, mct_real *dx)
{
    mct_rotor_leave(rotor, dy + Q, dx + Q_STATE);
    MCT_UNROLL
    for (int i = 0; i < 3; i++) {
        dx[X_STATE + i] = dy[X + i];
        dx[V_STATE + i] = dy[V + i];
        dx[W_STATE + i] = dy[W + i];
    }
    if (rotor->is_turned) {
        mct_apply_back(rotor->axes, dy + W, dx + W_STATE);
    }
}

/* A step of a state. */
MCT_INLINE void whole(step_in_principal_axes step, const constants_t *k, unsigned effects, int order,
                      const mct_real *x, mct_real *dx)
{
    mct_real y[MCT_MAX_STATES], dy[MCT_MAX_STATES];
    enter(&k->rotor, x, y);
    step(k, effects, order, y, dy);
    leave(&k->rotor, dy, dx);
}

MCT_INLINE void taylor(const void *constants, unsigned effects, int order, const mct_real *x, mct_real u,
                       mct_real *dx)
{
    (void)u;
    whole(series, constants, effects, order, x, dx);
}

/* --- all that the equation says --- */

static void evaluate_particles(const constants_t *k, const mct_real *x, mct_evaluation *out)
{
    const mct_rotor *rotor = &k->rotor;
    for (int n = 0; n < rotor->count; n++) {
        mct_real turning[3], xdd[3];
        out->mass[n] = rotor->mass[n];
        mct_rotate(x + Q_STATE, rotor->arm[n], out->position[n]);
        mct_turning_acceleration(x + W_STATE, out->acceleration + 3, rotor->arm[n], turning);
        mct_rotate(x + Q_STATE, turning, xdd);
        for (int i = 0; i < 3; i++) {
            out->position[n][i] += x[i];
            out->force[n][i] = rotor->mass[n] * k->gravity[i];
            out->constraint_force[n][i] = rotor->mass[n] * (out->acceleration[i] + xdd[i] - k->gravity[i]);
        }
    }
}

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_rotor *rotor = &k->rotor;
    const mct_real mass = rotor->total_mass;
    const mct_real *v = x + V_STATE;
    const mct_real *w = x + W_STATE;
    mct_real y[MCT_MAX_STATES], dy[MCT_MAX_STATES], dx[MCT_MAX_STATES], force[3], own_couple[3], couple[3];
    mct_real momentum[3], second[3], C[9], slope;
    (void)u;
    *out = (mct_evaluation){0};
    enter(rotor, x, y);
    derivative(k, effects, y, 0, dy);
    leave(rotor, dy, dx);
    memcpy(out->acceleration, dx + V_STATE, N * sizeof dx[0]);
    forces_at(k, effects, y + Q, force, own_couple);
    mct_apply_back(rotor->axes, own_couple, couple);
    mct_apply(rotor->inertia, w, momentum);
    const mct_real half_trace =
        MCT_R(0.5) * (rotor->inertia[0][0] + rotor->inertia[1][1] + rotor->inertia[2][2]);
    for (int i = 0; i < 3; i++) { /* S w, S = sum m b b' = tr I / 2 - I */
        second[i] = half_trace * w[i] - momentum[i];
    }
    mct_skew(second, C);
    mct_cross(w, momentum, out->Cv + 3);
    const mct_real drag = mct_damping(effects, 0, k->drag, v, &slope);
    const mct_real angular_drag = mct_damping(effects, 0, rotor->drag, w, &slope);
    for (int i = 0; i < 3; i++) {
        out->M[i][i] = mass;
        for (int j = 0; j < 3; j++) {
            out->M[3 + i][3 + j] = rotor->inertia[i][j];
            out->C[3 + i][3 + j] = C[3 * i + j];
        }
        out->tau[i] = force[i] + mass * k->gravity[i] - drag * v[i];
        out->tau[3 + i] = couple[i] - angular_drag * w[i];
    }
    evaluate_particles(k, x, out);
    out->kinetic_energy = MCT_R(0.5) * (mass * mct_dot(v, v) + mct_dot(w, momentum));
    out->potential_energy = 0 - mass * mct_dot(k->gravity, x); /* not -0 */
    out->power[MCT_EFFECT_GRAVITY] = mass * mct_dot(k->gravity, v);
    out->power[MCT_EFFECT_FORCES] = mct_dot(force, v) + mct_dot(couple, w);
    out->power[MCT_EFFECT_DRAG] = -drag * mct_dot(v, v) - angular_drag * mct_dot(w, w);
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const constants_t *k = constants;
    (void)time;
    mct_rotor_place(&k->rotor, q + Q_STATE, position);
    for (int n = 0; n < k->rotor.count; n++) {
        for (int i = 0; i < 3; i++) {
            position[n][i] = mct_hyperdual_add(position[n][i], q[i]);
        }
    }
}

#define friction mct_no_friction
#define SWITCHES MCT_GRAVITY, MCT_FORCES, MCT_DRAG
static const uint32_t switches[] = {SWITCHES, 0};

MCT_KERNELS_3(seed, k->rotor.step.remainder, N, SWITCHES, whole(seed, k, effects, 0, x, dx))
MCT_KERNELS_3(euler, k->rotor.step.remainder, N, SWITCHES, whole(euler, k, effects, 0, x, dx))
MCT_KERNELS_3(leap, k->rotor.step.remainder, N, SWITCHES, whole(leap, k, effects, 0, x, dx))
MCT_KERNELS_3(rk4, k->rotor.step.sixth_remainder, N, SWITCHES, whole(rk4, k, effects, 0, x, dx))
MCT_SMOOTH_KERNELS_2(split3, k->rotor.step.remainder, N, 3, MCT_GRAVITY, MCT_FORCES,
                     whole(split3, k, effects, 0, x, dx))
MCT_TAYLOR_KERNELS_2(k->rotor.step.remainder, N, 3, MCT_GRAVITY, MCT_FORCES)

static const mct_named_kernel *kernel(int stepper, uint32_t effects)
{
    static const mct_named_kernel *const kernels[MCT_STEPPER_COUNT] = {
        [MCT_STEPPER_SEED] = seed_kernels,     [MCT_STEPPER_EULER] = euler_kernels,
        [MCT_STEPPER_LEAP] = leap_kernels,     [MCT_STEPPER_RK4] = rk4_kernels,
        [MCT_STEPPER_SPLIT3] = split3_kernels, MCT_TAYLOR_ROWS,
    };
    return mct_switched_kernel_of(kernels, switches, stepper, effects);
}

const mct_system mct_rigid_body = {
    .name = "rigid_body",
    .doc = "a body that moves and turns freely",
    .source = "6",
    .coordinate_count = N,
    .coordinates = coordinates,
    .attitude = MCT_ATTITUDE_BODY,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .list_count = 2,
    .lists = lists,
    .lists_particles = true,
    .effects = MCT_GRAVITY | MCT_FORCES | MCT_DRAG,
    .standard_effects = MCT_GRAVITY | MCT_FORCES,
    .particle_count = MCT_EQUIMOMENTAL_COUNT,
    .particle_names = mct_particle_numbers,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
};

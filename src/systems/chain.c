/*
 * Kinematic chain: the angles of n links change until the tip is at a target. A process: one update a step.
 *
 * Equation, source, conventions, differences, validity: chain_kinematics.h.
 * Evaluation    An update is Gauss's principle for a unit mass at the tip that the error pulls, in a time of 1: M a = J'e
 *               with a the update, M = J'J + alpha (ridge), J'J (inverse) or 1 / kappa (transpose; 0 where there is no
 *               kappa). What the links cannot do is the constraint force J a - e. a is the update as it is made: a step
 *               that is cut, or bends a pose without a gradient, is not M^-1 J'e. Nothing depends on rates. The energy is
 *               half the square of the way to the target itself: out of reach, some of it is left.
 */
#include "chain_kinematics.h"
#include "mctau/compensated.h"
#include "mctau/scene.h"
#include "mctau/stepper.h"
#include "systems.h"

typedef mct_chain_constants constants_t;

enum { TARGET_1, TARGET_2, METHOD, GAIN, RIDGE, LARGEST_STEP, PARAMETERS };

static const char *const methods[] = {"transpose", "inverse", "ridge", NULL}; /* as mct_chain_method */

static const mct_field parameters[PARAMETERS] = {
    [TARGET_1] = MCT_QUANTITY("target_1", "m", -1e6, 1e6, 0.3, "of the tip, to the right of the base"),
    [TARGET_2] = MCT_QUANTITY("target_2", "m", -1e6, 1e6, 0.4, "above the base"),
    [METHOD] = {"method", "", "how an update finds the angles' change", MCT_FIELD_CHOICE, 0, 0,
                MCT_CHAIN_RIDGE, methods, 0, 0},
    [GAIN] = MCT_QUANTITY("gain", "1/m^2", 0, 1e9, 0, "of transpose; 0: the best one of each update"),
    [RIDGE] = MCT_QUANTITY("ridge", "m^2", 0, 1e9, 0, "of ridge, its damping; 0: from the error"),
    [LARGEST_STEP] = MCT_QUANTITY("largest_step", "rad", 1e-6, 1e3, 0.5, "of an angle in an update"),
};

static const mct_field lengths[1] = {
    MCT_QUANTITY("link_length", "m", 1e-4, 1e4, 0.3, "of a link"),
};
static const double standard_lengths[] = {0.3, 0.25, 0.2};
static const mct_row_list lists[1] = {
    {.name = "link_lengths",
     .doc = "of each link, from the base to the tip",
     .column_count = 1,
     .columns = lengths,
     .fewest_rows = 1,
     .most_rows = MCT_CHAIN_MAX_LINKS,
     .standard_rows = sizeof standard_lengths / sizeof standard_lengths[0],
     .standard = standard_lengths},
};

/* Its turns are counted: a joint that has wound itself up shows it. */
#define ANGLE(number, doc)                                                                    \
    {                                                                                         \
        .position = MCT_QUANTITY("angle_" number, "rad", -1e6, 1e6, 0, doc), .is_angle = true \
    }
#define JOINT(number) ANGLE(number, "from the link before, counterclockwise")

static const mct_coordinate coordinates[MCT_CHAIN_MAX_LINKS] = {
    ANGLE("1", "from the right, counterclockwise"),
    JOINT("2"),
    JOINT("3"),
    JOINT("4"),
    JOINT("5"),
    JOINT("6"),
    JOINT("7"),
    JOINT("8"),
    JOINT("9"),
    JOINT("10"),
    JOINT("11"),
    JOINT("12"),
    JOINT("13"),
    JOINT("14"),
    JOINT("15"),
    JOINT("16"),
};

/* The tip comes first, so that its name does not depend on the number of links. */
static const char *const particle_names[MCT_CHAIN_MAX_LINKS] = {
    "tip",     "joint_2",  "joint_3",  "joint_4",  "joint_5",  "joint_6",  "joint_7",  "joint_8",
    "joint_9", "joint_10", "joint_11", "joint_12", "joint_13", "joint_14", "joint_15", "joint_16",
};

/* The particle at the end of link i. */
static int end_of_link(const constants_t *k, int i)
{
    return i == k->links - 1 ? 0 : i + 1;
}

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    (void)h;
    k->links = scene->lists[0].count;
    k->method = (mct_chain_method)p[METHOD];
    for (int i = 0; i < k->links; i++) {
        k->length[i] = (mct_real)scene->lists[0].values[i];
    }
    k->target[0] = (mct_real)p[TARGET_1];
    k->target[1] = (mct_real)p[TARGET_2];
    k->gain = (mct_real)p[GAIN];
    k->ridge = (mct_real)p[RIDGE];
    k->largest_step = (mct_real)p[LARGEST_STEP];
    mct_chain_complete(k);
    const mct_real largest_gain = mct_chain_largest_gain(k);
    if (k->method == MCT_CHAIN_TRANSPOSE && k->gain > largest_gain) {
        mct_message_add(why, "parameters.gain: found ");
        mct_message_add_number(why, p[GAIN]);
        mct_message_add(why,
                        " 1/m^2, with which transpose diverges where the chain is stretched; allowed up to ");
        mct_message_add_number(why, (double)largest_gain);
        mct_message_add(why, " 1/m^2, 2 / |J|^2 there; 0 is the best gain of each update");
        return MCT_ERROR_UNSUITED;
    }
    return MCT_OK;
}

/* What M has on its diagonal beside J'J, or, of transpose, instead of it. */
static mct_real diagonal_of(const constants_t *k, const mct_chain_pose *pose,
                            const mct_real (*J)[MCT_CHAIN_MAX_LINKS], const mct_real *tau)
{
    if (k->method != MCT_CHAIN_TRANSPOSE) {
        return mct_chain_ridge(k, (mct_real)mct_sqrt((double)mct_chain_error_squared(pose)));
    }
    if (k->gain > 0) {
        return 1 / k->gain;
    }
    mct_real square = 0;
    mct_real moved[2] = {0, 0};
    for (int i = 0; i < k->links; i++) {
        square += tau[i] * tau[i];
        moved[0] += J[0][i] * tau[i];
        moved[1] += J[1][i] * tau[i];
    }
    return square > 0 ? (moved[0] * moved[0] + moved[1] * moved[1]) / square : 0;
}

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const int n = k->links;
    mct_chain_pose pose;
    mct_real J[2][MCT_CHAIN_MAX_LINKS];
    (void)effects;
    (void)u;
    *out = (mct_evaluation){0};
    mct_chain_place(k, x, &pose);
    mct_chain_jacobian(k, &pose, J);
    mct_chain_step(k, &pose, out->acceleration);
    for (int i = 0; i < n; i++) {
        out->tau[i] = J[0][i] * pose.error[0] + J[1][i] * pose.error[1];
        for (int j = 0; j < n && k->method != MCT_CHAIN_TRANSPOSE; j++) {
            out->M[i][j] = J[0][i] * J[0][j] + J[1][i] * J[1][j];
        }
    }
    const mct_real diagonal = diagonal_of(k, &pose, (const mct_real(*)[MCT_CHAIN_MAX_LINKS])J, out->tau);
    for (int i = 0; i < n; i++) {
        out->M[i][i] += diagonal;
    }
    out->mass[0] = 1;
    for (int axis = 0; axis < 2; axis++) {
        for (int i = 0; i < n; i++) {
            out->position[end_of_link(k, i)][axis] = pose.arm[0][axis] - pose.arm[i + 1][axis];
            out->constraint_force[0][axis] += J[axis][i] * out->acceleration[i];
        }
        out->constraint_force[0][axis] -= pose.error[axis];
        out->force[0][axis] = pose.error[axis];
    }
    const mct_real left[2] = {k->target[0] - pose.arm[0][0], k->target[1] - pose.arm[0][1]};
    out->potential_energy = MCT_R(0.5) * (left[0] * left[0] + left[1] * left[1]);
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    const constants_t *k = constants;
    const mct_hyperdual zero = mct_hyperdual_constant(0);
    mct_hyperdual direction = zero;
    mct_hyperdual end[2] = {zero, zero};
    (void)time;
    for (int i = 0; i < k->links; i++) {
        mct_hyperdual *const particle = position[end_of_link(k, i)];
        mct_hyperdual s, c;
        direction = mct_hyperdual_add(direction, q[i]);
        mct_hyperdual_sincos(direction, &s, &c);
        end[0] = mct_hyperdual_add(end[0], mct_hyperdual_scale(k->length[i], c));
        end[1] = mct_hyperdual_add(end[1], mct_hyperdual_scale(k->length[i], s));
        particle[0] = end[0];
        particle[1] = end[1];
        particle[2] = zero;
    }
}

void mct_chain_discrete(const void *constants, mct_state *state, mct_real u, int32_t steps);
void mct_chain_discrete(const void *constants, mct_state *state, mct_real u, int32_t steps)
{
    const constants_t *k = constants;
    (void)u;
    for (int32_t count = 0; count < steps; count++) {
        mct_real step[MCT_CHAIN_MAX_LINKS];
        mct_chain_update(k, state->x, step);
        for (int i = 0; i < k->links; i++) {
            mct_add_compensated(&state->x[i], &state->c[i], step[i]);
        }
    }
}

static const mct_named_kernel *kernel(int stepper, uint32_t effects)
{
    static const mct_named_kernel discrete = MCT_NAMED_KERNEL(mct_chain_discrete);
    (void)effects;
    return stepper == MCT_STEPPER_DISCRETE ? &discrete : NULL;
}

const mct_system mct_chain = {
    .name = "chain",
    .doc = "links in a plane that bring their tip to a target: inverse kinematics, an update a step",
    .source = "7",
    .coordinate_count = MCT_CHAIN_MAX_LINKS,
    .coordinates = coordinates,
    .lists_coordinates = true,
    .is_process = true,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .list_count = 1,
    .lists = lists,
    .particle_count = MCT_CHAIN_MAX_LINKS,
    .particle_names = particle_names,
    .lists_particles = true,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
};

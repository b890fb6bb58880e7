#include "mctau/controller.h"

#include <string.h>

#include "../systems/systems.h"
#include "mctau/matrix.h"
#include "mctau/riccati.h"
#include "swing_up.h"

#define LEARNING  MCT_R(0.5) /* fraction of a missed energy by which the next approach aims differently */
#define MAX_MODEL (2 * MCT_MAX_ENCODERS)

/* The linear model, sampled: x+ = A x + B u. */
typedef struct {
    int states;
    double A[MAX_MODEL * MAX_MODEL];
    double B[MAX_MODEL];
} sampled_model;

const char *mct_mode_name(mct_mode mode)
{
    static const char *const names[MCT_MODE_COUNT] = {"open_loop", "wait", "swing_up", "balance", "stopped"};
    return names[mode];
}

static mct_status sample(const mct_scene *scene, sampled_model *model)
{
    const mct_system *system = mct_systems[scene->system];
    mct_linear_model full;
    system->actuation->linearise(scene, &full);
    /* e^[A B; 0 0]h = [A_sampled B_sampled; 0 1] */
    const int n = full.states;
    const int size = n + 1;
    model->states = n;
    double generator[(MAX_MODEL + 1) * (MAX_MODEL + 1)] = {0};
    double flow[(MAX_MODEL + 1) * (MAX_MODEL + 1)];
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            generator[i * size + j] = scene->dt * full.A[i * n + j];
        }
        generator[i * size + n] = scene->dt * full.B[i];
    }
    const mct_status status = mct_expm1(size, generator, flow);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            model->A[i * n + j] = flow[i * size + j] + (i == j ? 1 : 0);
        }
        model->B[i] = flow[i * size + n];
    }
    return status;
}

static mct_status balance_gains(const mct_scene *scene, const sampled_model *model, double limit,
                                mct_real *gains)
{
    const int n = model->states;
    double Q[MAX_MODEL * MAX_MODEL] = {0};
    double P[MAX_MODEL * MAX_MODEL];
    double K[MAX_MODEL] = {0};
    for (int i = 0; i < n; i++) {
        const double deviation = scene->weights[i];
        Q[i * n + i] = 1 / (deviation * deviation);
    }
    const double R = scene->input_weight / (limit * limit);
    const mct_status status = mct_discrete_riccati(n, 1, model->A, model->B, Q, &R, P, K);
    for (int i = 0; i < n; i++) {
        gains[i] = (mct_real)K[i];
    }
    return status;
}

/*
 * Left eigenvector w of the eigenvalue of largest modulus, by squaring A until only that mode is left, scaled
 * by the amplitude that the limited input can still hold.
 */
static mct_status catch_region(const sampled_model *model, double limit, mct_real *unstable)
{
    enum { SQUARINGS = 40 };
    const int n = model->states;
    double power[MAX_MODEL * MAX_MODEL];
    double square[MAX_MODEL * MAX_MODEL];
    memcpy(power, model->A, sizeof power);
    for (int k = 0; k < SQUARINGS; k++) {
        mct_matrix_multiply(n, n, n, power, power, square);
        double largest = 0;
        for (int i = 0; i < n * n; i++) {
            const double size = square[i] < 0 ? -square[i] : square[i];
            largest = size > largest ? size : largest;
        }
        if (!(largest > 0 && largest <= DBL_MAX)) {
            return MCT_ERROR_NO_CONVERGENCE;
        }
        for (int i = 0; i < n * n; i++) {
            power[i] = square[i] / largest;
        }
    }
    int row = 0;
    double longest = 0;
    for (int i = 0; i < n; i++) {
        double length = 0;
        for (int j = 0; j < n; j++) {
            length += power[i * n + j] * power[i * n + j];
        }
        if (length > longest) {
            longest = length;
            row = i;
        }
    }
    const double *w = power + row * n;
    double wAw = 0;
    double wB = 0;
    for (int j = 0; j < n; j++) {
        double wA = 0;
        for (int i = 0; i < n; i++) {
            wA += w[i] * model->A[i * n + j];
        }
        wAw += wA * w[j];
        wB += w[j] * model->B[j];
    }
    const double growth = wAw / longest - 1;
    const double edge = (wB < 0 ? -wB : wB) * limit / growth;
    if (!(growth > 0 && edge > 0 && edge <= DBL_MAX)) {
        return MCT_ERROR_NO_CONVERGENCE;
    }
    for (int i = 0; i < n; i++) {
        unstable[i] = (mct_real)(w[i] / edge);
    }
    return MCT_OK;
}

/* Energy that lifts the pendulum from hanging to upright, and its natural frequency when hanging. */
static void prepare_swing_up(mct_controller *controller, const mct_scene *scene)
{
    const mct_system *system = controller->system;
    mct_evaluation upright;
    mct_real x[MCT_MAX_STATES] = {0};
    system->evaluate(controller->constants, controller->effects, x, 0, &upright);
    const double lift = 2 * (double)upright.potential_energy;
    const int angle = system->actuation->upright_coordinate;
    const double inertia = (double)upright.M[angle][angle];
    const double frequency = mct_sqrt(0.5 * lift / inertia);
    controller->largest_shift = (mct_real)(scene->energy_band * lift);
    controller->energy_scale = (mct_real)(1 / (scene->energy_band * lift));
    controller->still = (mct_real)(0.02 * frequency);
    controller->track_half_length = (mct_real)scene->track_half_length;
    controller->swing_acceleration = (mct_real)(0.25 * scene->track_half_length * frequency * frequency);
    controller->track_stiffness = (mct_real)(0.25 * frequency * frequency);
    controller->track_damping = (mct_real)(0.5 * frequency);
}

/*
 * The model's gravity; a prior worth 5 ticks of it, so that noise does not lead astray; and a memory of 2 s
 * of it.
 */
static void prepare_learning(mct_controller *controller, const mct_scene *scene)
{
    const mct_system *system = controller->system;
    const int angle = system->actuation->upright_coordinate;
    mct_linear_model model;
    system->actuation->linearise(scene, &model);
    const double slope = model.A[(system->coordinate_count + angle) * model.states + angle];
    controller->observer.gravity_slope = (mct_real)slope;
    controller->information = (mct_real)(slope * slope * 5);
    controller->memory = (mct_real)(slope * slope * 2 / scene->dt);
}

static mct_real weighted(const mct_real *weights, const mct_real *x, int states)
{
    mct_real sum = 0;
    for (int i = 0; i < states; i++) {
        sum += weights[i] * x[i];
    }
    return sum;
}

mct_real mct_controller_reach(const mct_controller *controller)
{
    const mct_real z =
        weighted(controller->unstable, controller->observer.x, 2 * controller->system->coordinate_count);
    return z < 0 ? -z : z;
}

/*
 * Fraction of full pumping, from -1 (brake) to 1, that brings the pendulum to the energy of the upright rest.
 *
 * Friction leaves an approach a little short when pumping fades out, or a wrong model takes it over the top.
 * Both are seen in the upper half, as energy that was missing or too much, and shift the energy that the next
 * approach aims at. Near a standstill the direction is kept, so that noise does not make it chatter and a
 * start from rest has one.
 */
static mct_real pumping(mct_controller *controller, mct_real inertia, mct_real weight_moment,
                        mct_real power_per_input)
{
    const mct_system *system = controller->system;
    const mct_real *x = controller->observer.x;
    const mct_real angle = x[system->actuation->upright_coordinate];
    const mct_real rate = x[system->coordinate_count + system->actuation->upright_coordinate];
    const mct_real c = controller->observer.cosine;
    const mct_real direction = power_per_input > controller->still    ? 1
                               : power_per_input < -controller->still ? -1
                                                                      : controller->direction;
    const mct_real missing = weight_moment * (1 - c) - MCT_R(0.5) * inertia * rate * rate;
    const bool turned = direction != controller->direction;
    const bool crossed = (angle > 0) != (controller->last_angle > 0);
    if (c > 0 && (crossed || turned) && missing * controller->energy_scale < 1) {
        controller->energy_shift =
            mct_clamp(controller->energy_shift + LEARNING * missing, controller->largest_shift);
    }
    controller->direction = direction;
    controller->last_angle = angle;
    return direction * mct_clamp((missing + controller->energy_shift) * controller->energy_scale, 1);
}

/*
 * Learns by which fraction gravity's acceleration exceeds the model's: least squares of what the observer
 * still had to correct, on the model's gravity, with a prior of zero; the observer takes it over. A ratio
 * that is off by 10 % would miss the catch region by far.
 */
static void learn_gravity(mct_controller *controller)
{
    mct_observer *observer = &controller->observer;
    const mct_real gravity = observer->gravity;
    const mct_real information = controller->information + gravity * gravity;
    controller->information = information < controller->memory ? information : controller->memory;
    const mct_real correction = observer->correction[controller->system->actuation->upright_coordinate];
    observer->excess =
        mct_clamp(observer->excess + gravity * correction / controller->information, MCT_R(0.5));
}

/* The wheel's reaction does the work -torque arm_rate on the arm. */
mct_real mct_reaction_wheel_swing_up(mct_controller *controller)
{
    const mct_reaction_wheel_constants *k = &controller->constants->reaction_wheel;
    learn_gravity(controller);
    const mct_real inertia = k->arm_inertia / (1 + controller->observer.excess);
    return controller->limit * pumping(controller, inertia, k->weight_moment, -controller->observer.x[2]);
}

/*
 * The acceleration wanted of a cart, unless it needs more to stop before nine tenths of the way to the
 * track's end.
 */
static mct_real kept_on_track(const mct_controller *controller, mct_real position, mct_real velocity,
                              mct_real wanted)
{
    const mct_real way = velocity > 0 ? position : -position;
    const mct_real room = MCT_R(0.9) * controller->track_half_length - way;
    const mct_real least_room = MCT_R(0.05) * controller->track_half_length;
    const mct_real stop = MCT_R(0.5) * velocity * velocity / (room > least_room ? room : least_room);
    if (stop < 2 * controller->swing_acceleration) {
        return wanted;
    }
    return velocity > 0 ? -stop : stop;
}

/*
 * The cart's acceleration a does the work -m l cos(th) thd a on the pole; the voltage that gives it follows
 * from the model.
 */
mct_real mct_cart_pole_swing_up(mct_controller *controller)
{
    const mct_cart_pole_constants *k = &controller->constants->cart_pole;
    const mct_real *x = controller->observer.x;
    const mct_real s = controller->observer.sine;
    const mct_real c = controller->observer.cosine;
    const mct_real pump = pumping(controller, k->inertia, k->weight_moment, -c * x[3]);
    const mct_real wanted =
        kept_on_track(controller, x[0], x[2],
                      controller->swing_acceleration * pump - controller->track_stiffness * x[0] -
                          controller->track_damping * x[2]);
    return mct_cart_pole_input_for(k, controller->effects, x, s, c, wanted);
}

/*
 * How each system is swung up, and whether its law learns the gravity ratio (a cart's pole knows it from its
 * length).
 */
static const struct {
    const mct_system *system;
    mct_real (*swing_up)(mct_controller *controller);
    bool learns_gravity;
} laws[] = {{&mct_cart_pole, mct_cart_pole_swing_up, false},
            {&mct_reaction_wheel, mct_reaction_wheel_swing_up, true}};

mct_status mct_controller_init(mct_controller *controller, mct_constants *constants, const mct_scene *scene,
                               mct_message *why)
{
    const mct_system *system = mct_systems[scene->system];
    memset(controller, 0, sizeof *controller);
    controller->system = system;
    controller->constants = constants;
    controller->effects = mct_scene_effects(scene);
    controller->mode = MCT_MODE_WAIT;
    controller->capture = (mct_real)scene->capture;
    controller->direction = 1;
    bool learns_gravity = false;
    for (size_t i = 0; i < sizeof laws / sizeof laws[0]; i++) {
        if (laws[i].system == system) {
            controller->swing_up = laws[i].swing_up;
            learns_gravity = laws[i].learns_gravity;
        }
    }
    if (controller->swing_up == NULL) {
        mct_message_add(why, "controller.kind: there is no swing-up for ");
        mct_message_add(why, system->name);
        return MCT_ERROR_UNSUITED;
    }
    const double limit = scene->parameters[system->actuation->supply_parameter];
    controller->limit = (mct_real)limit;
    mct_status status = system->prepare(scene, scene->dt, constants, why);
    if (status != MCT_OK) {
        return status;
    }
    mct_observer_init(&controller->observer, scene, constants);
    sampled_model model;
    status = sample(scene, &model);
    if (status == MCT_OK) {
        status = balance_gains(scene, &model, limit, controller->gains);
    }
    if (status == MCT_OK) {
        status = catch_region(&model, limit, controller->unstable);
    }
    if (status != MCT_OK) {
        mct_message_add(why, "controller.kind: the motor of this scene cannot balance ");
        mct_message_add(why, system->name);
        mct_message_add(why, " upright; look at gravity, torque_constant, resistance and supply_voltage");
        return status;
    }
    prepare_swing_up(controller, scene);
    if (learns_gravity) {
        prepare_learning(controller, scene);
    }
    return MCT_OK;
}

/*
 * Balance. A coordinate on which no force depends has no home of its own: it is measured from where balancing
 * began, which also makes up for an encoder that is off by a few counts, as an integrator would.
 */
static mct_real balance(mct_controller *controller)
{
    const mct_system *system = controller->system;
    const int n = system->coordinate_count;
    mct_real x[2 * MCT_MAX_ENCODERS];
    memcpy(x, controller->observer.x, sizeof x);
    for (int i = 0; i < n; i++) {
        if (system->coordinates[i].is_cyclic) {
            controller->travelled[i] += controller->observer.h * x[n + i];
            x[i] = controller->travelled[i];
        }
    }
    return -weighted(controller->gains, x, 2 * n);
}

void mct_controller_restart(mct_controller *controller)
{
    mct_observer_restart(&controller->observer);
    controller->mode = MCT_MODE_WAIT;
    memset(controller->travelled, 0, sizeof controller->travelled);
}

mct_real mct_controller_update(mct_controller *controller, const mct_reading *reading, mct_real applied)
{
    mct_observer_update(&controller->observer, reading, applied);
    if (!controller->observer.started) {
        return 0;
    }
    const mct_real reach = mct_controller_reach(controller);
    const mct_real c = controller->observer.cosine;
    if (controller->mode == MCT_MODE_BALANCE) {
        if (reach > 1 || c < MCT_R(0.8)) {
            controller->mode = MCT_MODE_SWING_UP;
        }
    } else if (reach < controller->capture && c > MCT_R(0.9)) {
        controller->mode = MCT_MODE_BALANCE;
        memset(controller->travelled, 0, sizeof controller->travelled);
    } else {
        controller->mode = MCT_MODE_SWING_UP;
    }
    const mct_real wanted =
        controller->mode == MCT_MODE_BALANCE ? balance(controller) : controller->swing_up(controller);
    return mct_clamp(wanted, controller->limit);
}

/*
 * Reaction wheel pendulum: an arm on a fixed pivot carries a wheel that a motor turns against it.
 *
 * Equation      M a = tau (C = 0),  q = (th1, th2):
 *                   [ J + I_w  I_w ]         [ mgl sin th1 - nu1 th1d ]       J   = m_w l^2 + I_a
 *               M = [ I_w      I_w ]   tau = [ torque - nu2 th2d      ]       mgl = (S_a + m_w l) g
 *               hence J th1dd = tau1 - tau2,  I_w (th1dd + th2dd) = tau2.  torque = k_T i
 *               (src/effects/motor.h).
 * Source        section 2.5, eqs. 133-173.
 * Conventions   th1 clockwise from the upward vertical, zero is the unstable equilibrium; th2 is relative to
 *               the arm, as a motor's encoder sees it, so motor torque and nu2 enter row 2 only. S_a, I_a:
 *               sums of m l and m l^2 of the arm.
 * Differences   I_w is a parameter: the source's wheel is a hoop, I_w = m_w r^2 (140). The sign of (147) is
 *               wrong in the source, but a balanced wheel has C = 0. (168) lacks an entry. Inductance, dry
 *               friction, drag (- c v |v| in each row), saturation: ours.
 * Constraint    The arm stands for two particles at +-a with its S_a and I_a, the wheel for two opposite ones
 *               on its hoop; e = m xdd - m (0, -g, 0) also transmits the couples (motor, friction).
 * Validity      arm and wheel rigid, the wheel balanced; J, I_w > 0. M is constant: its condition is about
 * 190 by default.
 */
#include "mctau/reaction_wheel.h"

#include "../effects/friction.h"
#include "../effects/motor.h"
#include "../steppers/euler.h"
#include "../steppers/expo.h"
#include "../steppers/friction_exact.h"
#include "../steppers/leap.h"
#include "../steppers/rk4.h"
#include "../steppers/seed.h"
#include "../steppers/taylor.h"
#define MCT_SYSTEM reaction_wheel
#include "kernels.h"
#include "mctau/matrix.h"
#include "mctau/scene.h"
#include "mctau/sincos.h"
#include "systems.h"

typedef mct_reaction_wheel_constants constants_t;

enum {
    WHEEL_MASS,
    WHEEL_INERTIA,
    ARM_LENGTH,
    ARM_INERTIA,
    ARM_MOMENT,
    GRAVITY,
    ARM_FRICTION,
    WHEEL_FRICTION,
    ARM_COULOMB,
    WHEEL_COULOMB,
    STATIC_RATIO,
    ARM_DRAG,
    WHEEL_DRAG,
    TORQUE_CONSTANT,
    BACK_EMF_CONSTANT,
    RESISTANCE,
    INDUCTANCE,
    SUPPLY_VOLTAGE,
    CURRENT_LIMIT,
    PARAMETERS
};

static const mct_field parameters[PARAMETERS] = {
    [WHEEL_MASS] = MCT_QUANTITY("wheel_mass", "kg", 1e-6, 1e6, 0.0850,
                                "wheel, with the part of the motor that sits at its axle"),
    [WHEEL_INERTIA] = MCT_QUANTITY("wheel_inertia", "kg m^2", 1e-12, 1e6, 2.495e-5, "wheel about its axle"),
    [ARM_LENGTH] = MCT_QUANTITY("arm_length", "m", 1e-4, 1e4, 0.1270, "pivot to the wheel's axle"),
    [ARM_INERTIA] =
        MCT_QUANTITY("arm_inertia", "kg m^2", 0, 1e6, 3.201e-3, "sum of m l^2 of the arm about the pivot"),
    [ARM_MOMENT] = MCT_QUANTITY("arm_moment", "kg m", -1e6, 1e6, 0.025384, "sum of m l of the arm"),
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity", "m/s^2", 0, 1e4, 9.81, "gravitational acceleration"),
    [ARM_FRICTION] =
        MCT_COEFFICIENT(MCT_VISCOUS, "arm_friction", "N m s", 0, 1e6, 2e-4, "viscous friction of the pivot"),
    [WHEEL_FRICTION] = MCT_COEFFICIENT(MCT_VISCOUS, "wheel_friction", "N m s", 0, 1e6, 3e-6,
                                       "viscous friction of the wheel's axle"),
    [ARM_COULOMB] =
        MCT_COEFFICIENT(MCT_COULOMB, "arm_coulomb", "N m", 0, 1e6, 0, "dry friction of the pivot"),
    [WHEEL_COULOMB] =
        MCT_COEFFICIENT(MCT_COULOMB, "wheel_coulomb", "N m", 0, 1e6, 0, "dry friction of the wheel's axle"),
    [STATIC_RATIO] = MCT_STATIC_RATIO,
    [ARM_DRAG] = MCT_COEFFICIENT(MCT_DRAG, "arm_drag", "N m s^2", 0, 1e6, 0,
                                 "torque of the air on the arm by the square of its rate"),
    [WHEEL_DRAG] = MCT_COEFFICIENT(MCT_DRAG, "wheel_drag", "N m s^2", 0, 1e6, 0,
                                   "torque between wheel and arm by the square of the wheel's rate"),
    [TORQUE_CONSTANT] =
        MCT_COEFFICIENT(MCT_MOTOR, "torque_constant", "N m/A", 0, 1e4, 0.0274, "motor torque per current"),
    [BACK_EMF_CONSTANT] =
        MCT_COEFFICIENT(MCT_MOTOR, "back_emf_constant", "V s/rad", 0, 1e4, 0.0274, "motor voltage per speed"),
    [RESISTANCE] = MCT_COEFFICIENT(MCT_MOTOR, "resistance", "ohm", 0, 1e6, 12.1, "armature"),
    [INDUCTANCE] = MCT_COEFFICIENT(MCT_MOTOR_INDUCTIVE, "inductance", "H", 0, 1e3, 0.006, "armature"),
    [SUPPLY_VOLTAGE] =
        MCT_COEFFICIENT(MCT_MOTOR, "supply_voltage", "V", 1e-3, 1e4, 10, "largest voltage either way"),
    [CURRENT_LIMIT] = MCT_COEFFICIENT(MCT_SATURATION_CURRENT, "current_limit", "A", 1e-6, 1e4, 0.6,
                                      "of the drive, either way"),
};

static const mct_coordinate coordinates[2] = {
    {.position = MCT_QUANTITY("arm_angle", "rad", -1e6, 1e6, 3.141592653589793, "clockwise from upright"),
     .rate = MCT_QUANTITY("arm_rate", "rad/s", -1e6, 1e6, 0, ""),
     .is_angle = true,
     MCT_ENCODER("arm", "turn", "1/turn", 4, 4096, "the arm"),
     .position_weight = 0.2,
     .rate_weight = 2},
    {.position = MCT_QUANTITY("wheel_angle", "rad", -1e6, 1e6, 0, "of the wheel relative to the arm"),
     .rate = MCT_QUANTITY("wheel_rate", "rad/s", -1e6, 1e6, 0, ""),
     .is_angle = true,
     .is_cyclic = true,
     MCT_ENCODER("wheel", "turn", "1/turn", 4, 4096, "the wheel, on the arm"),
     .position_weight = 300,
     .rate_weight = 300},
};

static const mct_field torque_field =
    MCT_QUANTITY("torque", "N m", -1e9, 1e9, 0, "on the wheel, its reaction on the arm");
static const char *const particle_names[] = {"arm_outer", "arm_inner", "wheel_1", "wheel_2"};

/*
 * Adds the entries (e11, e22) to M and inverts it: J + e11 and I_w + e22 never meet in a difference that
 * cancels.
 */
static mct_symmetric2 inverse_of(double J, double I_w, double e11, double e22)
{
    const double m11 = J + I_w + e11;
    const double m22 = I_w + e22;
    const double det = (J + e11) * m22 + I_w * e22;
    return (mct_symmetric2){(mct_real)(m22 / det), (mct_real)(-I_w / det), (mct_real)(m11 / det)};
}

static double weight_moment(const mct_scene *scene, uint32_t effects)
{
    const double *p = scene->parameters;
    return (effects & MCT_GRAVITY) ? (p[ARM_MOMENT] + p[WHEEL_MASS] * p[ARM_LENGTH]) * p[GRAVITY] : 0;
}

/* xdot = A x + B input + e sin th1, x = (th1, th2, th1d, th2d, current); returns the number of states. */
static int linear_part(const mct_scene *scene, uint32_t effects, double *A, double *B, double *e)
{
    const double *p = scene->parameters;
    const int n = 2;
    const int states = 4 + ((effects & MCT_MOTOR_INDUCTIVE) ? 1 : 0);
    const double inverse_J = 1 / (p[WHEEL_MASS] * p[ARM_LENGTH] * p[ARM_LENGTH] + p[ARM_INERTIA]);
    const double inverse_I = 1 / p[WHEEL_INERTIA];
    const bool viscous = effects & MCT_VISCOUS;
    const double conductance = (effects & MCT_MOTOR_QUASI_STATIC) ? 1 / p[RESISTANCE] : 0;
    const double nu1 = viscous ? p[ARM_FRICTION] : 0;
    const double nu2 =
        (viscous ? p[WHEEL_FRICTION] : 0) + p[TORQUE_CONSTANT] * p[BACK_EMF_CONSTANT] * conductance;
    const double torque_per_input = (effects & MCT_MOTOR) ? p[TORQUE_CONSTANT] * conductance : 1;
    for (int i = 0; i < states * states; i++) {
        A[i] = 0;
    }
    for (int i = 0; i < states; i++) {
        B[i] = e[i] = 0;
    }
    A[0 * states + 2] = 1;
    A[1 * states + 3] = 1;
    /* th1dd = (tau1 - tau2) / J, th2dd = tau2 / I_w - th1dd */
    double *arm = A + n * states;
    double *wheel = A + (n + 1) * states;
    arm[2] = -nu1 * inverse_J;
    arm[3] = nu2 * inverse_J;
    B[2] = -torque_per_input * inverse_J;
    B[3] = torque_per_input * (inverse_I + inverse_J);
    e[2] = inverse_J * weight_moment(scene, effects);
    e[3] = -e[2];
    wheel[2] = -arm[2];
    wheel[3] = -nu2 * (inverse_I + inverse_J);
    if (effects & MCT_MOTOR_INDUCTIVE) {
        double *current = A + 4 * states;
        arm[4] = -p[TORQUE_CONSTANT] * inverse_J;
        wheel[4] = p[TORQUE_CONSTANT] * (inverse_I + inverse_J);
        current[3] = -p[BACK_EMF_CONSTANT] / p[INDUCTANCE];
        current[4] = -p[RESISTANCE] / p[INDUCTANCE];
        B[2] = B[3] = 0;
        B[4] = 1 / p[INDUCTANCE];
    }
    return states;
}

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const uint32_t effects = mct_scene_effects(scene);
    const bool viscous = effects & MCT_VISCOUS;
    const bool coulomb = effects & MCT_COULOMB;
    const double J = p[WHEEL_MASS] * p[ARM_LENGTH] * p[ARM_LENGTH] + p[ARM_INERTIA];
    const double I_w = p[WHEEL_INERTIA];
    k->step = mct_step_of(h);
    k->arm_inertia = (mct_real)J;
    k->wheel_inertia = (mct_real)I_w;
    k->weight_moment = (mct_real)weight_moment(scene, effects);
    k->gravity = (mct_real)((effects & MCT_GRAVITY) ? p[GRAVITY] : 0);
    k->arm_viscous = (mct_real)(viscous ? p[ARM_FRICTION] : 0);
    k->wheel_viscous = (mct_real)(viscous ? p[WHEEL_FRICTION] : 0);
    k->coulomb[0] = (mct_real)(coulomb ? p[ARM_COULOMB] : 0);
    k->coulomb[1] = (mct_real)(coulomb ? p[WHEEL_COULOMB] : 0);
    k->hold[0] = (mct_real)(coulomb ? p[STATIC_RATIO] * p[ARM_COULOMB] : 0);
    k->hold[1] = (mct_real)(coulomb ? p[STATIC_RATIO] * p[WHEEL_COULOMB] : 0);
    k->drag[0] = (mct_real)(effects & MCT_DRAG ? p[ARM_DRAG] : 0);
    k->drag[1] = (mct_real)(effects & MCT_DRAG ? p[WHEEL_DRAG] : 0);
    k->inverse_arm = (mct_real)(1 / J);
    k->inverse_wheel = (mct_real)(1 / I_w);

    mct_status status = mct_motor_prepare(&k->motor, effects, 1, p[TORQUE_CONSTANT], p[BACK_EMF_CONSTANT],
                                          p[RESISTANCE], p[INDUCTANCE], h);
    if (status == MCT_ERROR_RANGE) {
        mct_motor_refuse(p[RESISTANCE], p[INDUCTANCE], why);
    }
    if (status != MCT_OK) {
        return status;
    }
    k->wheel_damping = k->wheel_viscous + ((effects & MCT_MOTOR_QUASI_STATIC) ? k->motor.damping : 0);
    const double d1 = (double)k->arm_viscous;
    const double d2 = (double)k->wheel_damping;
    const double averaged_motor =
        (double)k->motor.force_per_ampere * (double)k->motor.emf * (double)k->motor.mean_from_change;
    k->inertia.inverse = inverse_of(J, I_w, 0, 0);
    k->inertia.mass = (mct_symmetric2){(mct_real)(J + I_w), (mct_real)I_w, (mct_real)I_w};
    k->implicit = inverse_of(J, I_w, h * d1, h * d2);
    k->symmetric = inverse_of(J, I_w, 0.5 * h * d1, 0.5 * h * d2 + h * averaged_motor);

    const double reach = p[ARM_MOMENT] < 0 ? -p[ARM_MOMENT] : p[ARM_MOMENT];
    double a = p[ARM_LENGTH];
    if (reach * a > p[ARM_INERTIA]) {
        a = p[ARM_INERTIA] / reach; /* no farther out than where both masses stay positive */
    }
    const double sum = a > 0 ? p[ARM_INERTIA] / (a * a) : 0;
    const double difference = a > 0 ? p[ARM_MOMENT] / a : 0;
    k->arm_length = (mct_real)p[ARM_LENGTH];
    k->wheel_radius = (mct_real)mct_sqrt(I_w / p[WHEEL_MASS]);
    k->arm_radius = (mct_real)a;
    k->wheel_particle_mass = (mct_real)(0.5 * p[WHEEL_MASS]);
    k->outer_arm_mass = (mct_real)mct_max(0, 0.5 * (sum + difference));
    k->inner_arm_mass = (mct_real)mct_max(0, 0.5 * (sum - difference)); /* rounding may take it below */

    const int nodes = scene->stepper == MCT_STEPPER_EXPO8 ? 4 : scene->stepper == MCT_STEPPER_EXPO ? 2 : 0;
    if (nodes == 0) {
        return MCT_OK;
    }
    double A[MCT_MAX_STATES * MCT_MAX_STATES];
    double B[MCT_MAX_STATES];
    double e[MCT_MAX_STATES];
    const int states = linear_part(scene, effects, A, B, e);
    status = mct_expo_prepare(&k->expo, nodes, 2, states, A, B, e, h);
    if (status != MCT_OK) {
        mct_message_add(
            why, "scene.dt: the linear part of this scene is too fast for the exact flow over one step");
    }
    return status;
}

/* Drag by the square as a damping, which grows with the rate. */
MCT_INLINE mct_real drag_of(const constants_t *k, int i, mct_real rate)
{
    return k->drag[i] * (rate < 0 ? -rate : rate);
}

/* tau at the sine of the arm's angle, and rates; without drag, which is not linear. */
MCT_INLINE void torques(const constants_t *k, unsigned effects, mct_real s, const mct_real *v, mct_real drive,
                        mct_real *tau)
{
    tau[0] = (effects & MCT_GRAVITY) ? k->weight_moment * s : 0;
    tau[1] = drive;
    if (effects & MCT_VISCOUS) {
        tau[0] -= k->arm_viscous * v[0];
    }
    if (effects & (MCT_VISCOUS | MCT_MOTOR_QUASI_STATIC)) {
        tau[1] -= k->wheel_damping * v[1];
    }
}

MCT_INLINE void derivative_at(const void *constants, unsigned effects, const mct_real *x, mct_real s,
                              mct_real c, mct_real u, mct_real *dx)
{
    (void)c;
    const constants_t *k = constants;
    const mct_real current = (effects & MCT_MOTOR_INDUCTIVE) ? x[4] : 0;
    mct_real tau[2];
    torques(k, effects, s, x + 2, mct_motor_force(&k->motor, effects, u, current), tau);
    if (effects & MCT_DRAG) {
        tau[0] -= drag_of(k, 0, x[2]) * x[2];
        tau[1] -= drag_of(k, 1, x[3]) * x[3];
    }
    dx[0] = x[2];
    dx[1] = x[3];
    dx[2] = (tau[0] - tau[1]) * k->inverse_arm;
    dx[3] = tau[1] * k->inverse_wheel - dx[2];
    if (effects & MCT_MOTOR_INDUCTIVE) {
        dx[4] = mct_motor_current_rate(&k->motor, u, x[3], current);
    }
}

MCT_INLINE void derivative(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                           mct_real *dx)
{
    mct_real s, c;
    mct_sincos(x[0], &s, &c);
    derivative_at(constants, effects, x, s, c, u, dx);
}

/* Rate increments of tau over a step. `inverse` holds what is linear; drag is bilinear in the old rate and the new one. */
MCT_INLINE void impulse(const constants_t *k, unsigned effects, mct_symmetric2 inverse, const mct_real *v,
                        mct_real *tau, mct_real *dv)
{
    const mct_real h = k->step.h;
    if (!(effects & MCT_DRAG)) {
        dv[0] = h * (inverse.a11 * tau[0] + inverse.a12 * tau[1]);
        dv[1] = h * (inverse.a12 * tau[0] + inverse.a22 * tau[1]);
        return;
    }
    /* (1 + inverse E) dv = inverse (h tau - E v), E = h drag |v| */
    const mct_real e1 = h * drag_of(k, 0, v[0]);
    const mct_real e2 = h * drag_of(k, 1, v[1]);
    const mct_real p1 = h * tau[0] - e1 * v[0];
    const mct_real p2 = h * tau[1] - e2 * v[1];
    const mct_real det = inverse.a11 * inverse.a22 - inverse.a12 * inverse.a12;
    const mct_real scale = 1 / (1 + inverse.a11 * e1 + inverse.a22 * e2 + det * e1 * e2);
    dv[0] = scale * (inverse.a11 * p1 + inverse.a12 * p2 + det * e2 * p1);
    dv[1] = scale * (inverse.a12 * p1 + inverse.a22 * p2 + det * e1 * p2);
}

/* Kick of `euler`: damping and current implicit. */
MCT_INLINE void kick_implicit(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                              mct_real *dx)
{
    const constants_t *k = constants;
    mct_real current = 0;
    if (effects & MCT_MOTOR_INDUCTIVE) {
        current = mct_motor_implicit_current(&k->motor, k->step.h, u, x[3], x[4]);
        dx[4] = current - x[4];
    }
    mct_real s, c;
    mct_sincos(x[0], &s, &c);
    mct_real tau[2];
    torques(k, effects, s, x + 2, mct_motor_force(&k->motor, effects, u, current), tau);
    impulse(k, effects, k->implicit, x + 2, tau, dx + 2);
}

/* Kick of `leap`: damping at the mean of old and new velocity, current averaged exactly. */
MCT_INLINE void kick_symmetric(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                               mct_real *dx)
{
    const constants_t *k = constants;
    mct_real current = 0;
    if (effects & MCT_MOTOR_INDUCTIVE) {
        current = mct_motor_mean_current(&k->motor, u, x[3], x[4]);
    }
    mct_real s, c;
    mct_sincos(x[0], &s, &c);
    mct_real tau[2];
    torques(k, effects, s, x + 2, mct_motor_force(&k->motor, effects, u, current), tau);
    impulse(k, effects, k->symmetric, x + 2, tau, dx + 2);
    if (effects & MCT_MOTOR_INDUCTIVE) {
        dx[4] = mct_motor_current_change(&k->motor, u, x[3], x[4], dx[3]);
    }
}

/* In a mode of exact friction, what is at rest has an unlimited inertia; its load is what its own equation leaves. */
MCT_INLINE void series(const void *constants, unsigned effects, int order, const mct_real *x, mct_real u,
                       const mct_slip *slip, mct_series *rates, mct_series *loads)
{
    const constants_t *k = constants;
    const mct_real h = k->step.h;
    mct_real *const arm = rates[0], *const wheel = rates[1], *const current = rates[2];
    mct_series s = {0}, c = {0}; /* for compilers that do not see that the effects decide both times */
    mct_series on_arm, on_wheel; /* torques */
    if (effects & MCT_GRAVITY) {
        mct_sincos(x[0], &s[0], &c[0]);
    }
    arm[0] = x[2];
    wheel[0] = x[3];
    if (effects & MCT_MOTOR_INDUCTIVE) {
        current[0] = x[4];
    }
    mct_symmetric2 inverse = k->inertia.inverse;
    mct_real against[2] = {0, 0}; /* dynamic friction */
    mct_real drag[2] = {0, 0};
    if (effects & MCT_COULOMB_EXACT) {
        const bool is_held[2] = {slip->direction[0] == 0, slip->direction[1] == 0};
        if (is_held[0] || is_held[1]) {
            inverse.a12 = 0;
            inverse.a11 = is_held[0] ? 0 : 1 / k->inertia.mass.a11;
            inverse.a22 = is_held[1] ? 0 : k->inverse_wheel;
        }
        for (int i = 0; i < 2; i++) {
            against[i] = slip->direction[i] * k->coulomb[i];
            drag[i] = slip->direction[i] * k->drag[i];
        }
    }
    MCT_UNROLL
    for (int n = 0; n < order; n++) {
        const mct_real share = h * mct_series_share(n);
        const mct_real input = n == 0 ? u : MCT_NOTHING;
        const mct_real v[2] = {arm[n], wheel[n]};
        const mct_real now = (effects & MCT_MOTOR_INDUCTIVE) ? current[n] : 0;
        mct_real drive = MCT_NOTHING;
        if (n == 0 || (effects & MCT_MOTOR_INDUCTIVE)) {
            drive = mct_motor_force(&k->motor, effects, u, now);
        }
        mct_real tau[2];
        torques(k, effects, (effects & MCT_GRAVITY) ? s[n] : 0, v, drive, tau);
        if ((effects & MCT_COULOMB_EXACT) && n == 0) {
            tau[0] -= against[0];
            tau[1] -= against[1];
        }
        if (effects & MCT_DRAG) {
            tau[0] -= drag[0] * mct_series_product(arm, arm, n);
            tau[1] -= drag[1] * mct_series_product(wheel, wheel, n);
        }
        on_arm[n] = tau[0];
        on_wheel[n] = tau[1];
        if (effects & MCT_COULOMB_EXACT) {
            arm[n + 1] = (share * inverse.a11) * tau[0] + (share * inverse.a12) * tau[1];
            wheel[n + 1] = (share * inverse.a12) * tau[0] + (share * inverse.a22) * tau[1];
        } else {
            arm[n + 1] = (share * k->inverse_arm) * (tau[0] - tau[1]);
            wheel[n + 1] = (share * k->inverse_wheel) * tau[1] - arm[n + 1];
        }
        if (effects & MCT_GRAVITY) {
            mct_series_sincos(arm, h, n, s, c);
        }
        if (effects & MCT_MOTOR_INDUCTIVE) {
            current[n + 1] = share * mct_motor_current_rate(&k->motor, input, v[1], now);
        }
    }
    if ((effects & MCT_COULOMB_EXACT) && (slip->direction[0] == 0 || slip->direction[1] == 0)) {
        const mct_real coupling = k->inertia.mass.a12 / h;
        for (int n = 0; n < order; n++) {
            const mct_real rate = (mct_real)(n + 1) * coupling;
            loads[0][n] = on_arm[n] - rate * wheel[n + 1];
            loads[1][n] = on_wheel[n] - rate * arm[n + 1];
        }
    }
}

MCT_INLINE void taylor(const void *constants, unsigned effects, int order, const mct_real *x, mct_real u,
                       mct_real *dx)
{
    const constants_t *k = constants;
    const mct_dry dry = {{k->hold[0], k->hold[1]}, 0, 0};
    mct_taylor_dry(series, constants, dry, k->step.h, effects, order, 2, x, u, dx);
}

void mct_reaction_wheel_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real u,
                               mct_motion *out)
{
    const constants_t *k = constants;
    mct_taylor_motion(series, constants, k->step, effects, 2, state, u, out);
}

MCT_INLINE void friction(const void *constants, unsigned effects, const mct_real *x, mct_real u, mct_real *dx)
{
    (void)effects;
    (void)u;
    const constants_t *k = constants;
    mct_friction_correct(k->inertia, k->coulomb, k->hold, k->step.h, x + 2, dx);
}

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_real arm_rate = x[2];
    const mct_real wheel_rate = x[3];
    const mct_real rim_rate = arm_rate + wheel_rate;
    mct_real s, c, rim_s, rim_c;
    mct_sincos(x[0], &s, &c);
    mct_sincos(x[0] + x[1], &rim_s, &rim_c);
    *out = (mct_evaluation){0};
    out->M[0][0] = k->arm_inertia + k->wheel_inertia;
    out->M[0][1] = out->M[1][0] = out->M[1][1] = k->wheel_inertia;

    mct_real drive = u;
    if (effects & MCT_MOTOR) {
        out->current =
            (effects & MCT_MOTOR_INDUCTIVE) ? x[4] : mct_motor_quasi_static_current(&k->motor, u, wheel_rate);
        drive = k->motor.force_per_ampere * out->current;
    }
    const mct_real arm_drag = drag_of(k, 0, arm_rate);
    const mct_real wheel_drag = drag_of(k, 1, wheel_rate);
    const mct_real smooth[2] = {k->weight_moment * s - (k->arm_viscous + arm_drag) * arm_rate,
                                drive - (k->wheel_viscous + wheel_drag) * wheel_rate};
    mct_real dry[2];
    mct_friction_force(&k->inertia, k->coulomb, k->hold, x + 2, smooth, dry);
    out->tau[0] = smooth[0] + dry[0];
    out->tau[1] = smooth[1] + dry[1];
    out->acceleration[0] = (out->tau[0] - out->tau[1]) * k->inverse_arm;
    out->acceleration[1] = out->tau[1] * k->inverse_wheel - out->acceleration[0];

    /* A particle at distance d along a direction (s, c) that turns with rate w and acceleration a moves with
     * d (c a - s w^2, -s a - c w^2). */
    const mct_real a = out->acceleration[0];
    const mct_real rim_a = a + out->acceleration[1];
    const mct_real along[2] = {c * a - s * arm_rate * arm_rate, -s * a - c * arm_rate * arm_rate};
    const mct_real rim[2] = {rim_c * rim_a - rim_s * rim_rate * rim_rate,
                             -rim_s * rim_a - rim_c * rim_rate * rim_rate};
    const mct_real masses[4] = {k->outer_arm_mass, k->inner_arm_mass, k->wheel_particle_mass,
                                k->wheel_particle_mass};
    const mct_real on_arm[4] = {k->arm_radius, -k->arm_radius, k->arm_length, k->arm_length};
    const mct_real on_rim[4] = {0, 0, k->wheel_radius, -k->wheel_radius};
    for (int i = 0; i < 4; i++) {
        out->mass[i] = masses[i];
        out->position[i][0] = on_arm[i] * s + on_rim[i] * rim_s;
        out->position[i][1] = on_arm[i] * c + on_rim[i] * rim_c;
        out->force[i][1] = -masses[i] * k->gravity;
        out->constraint_force[i][0] = masses[i] * (on_arm[i] * along[0] + on_rim[i] * rim[0]);
        out->constraint_force[i][1] = masses[i] * (on_arm[i] * along[1] + on_rim[i] * rim[1] + k->gravity);
    }

    out->kinetic_energy =
        MCT_R(0.5) * (k->arm_inertia * arm_rate * arm_rate + k->wheel_inertia * rim_rate * rim_rate);
    out->potential_energy = k->weight_moment * c;
    out->power[MCT_EFFECT_GRAVITY] = k->weight_moment * s * arm_rate;
    out->power[MCT_EFFECT_VISCOUS] =
        -(k->arm_viscous * arm_rate * arm_rate + k->wheel_viscous * wheel_rate * wheel_rate);
    out->power[MCT_EFFECT_DRAG] = -(arm_drag * arm_rate * arm_rate + wheel_drag * wheel_rate * wheel_rate);
    out->power[MCT_EFFECT_COULOMB] = dry[0] * arm_rate + dry[1] * wheel_rate;
    mct_motor_powers(&k->motor, effects, u, wheel_rate, out);
}

void mct_reaction_wheel_accelerate(const void *constants, uint32_t effects, const mct_real *x, mct_real s,
                                   mct_real c, mct_real u, mct_real *a)
{
    const constants_t *k = constants;
    (void)c;
    mct_real arm_damping = k->arm_viscous;
    mct_real wheel_damping = k->wheel_viscous;
    if (effects & MCT_DRAG) {
        arm_damping += drag_of(k, 0, x[2]);
        wheel_damping += drag_of(k, 1, x[3]);
    }
    const mct_real tau1 = k->weight_moment * s - arm_damping * x[2];
    const mct_real tau2 = mct_motor_observed_force(&k->motor, effects, u, x[3]) - wheel_damping * x[3];
    a[0] = (tau1 - tau2) * k->inverse_arm;
    a[1] = tau2 * k->inverse_wheel - a[0];
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    (void)time;
    const constants_t *k = constants;
    const mct_hyperdual rim_angle = mct_hyperdual_add(q[0], q[1]);
    const mct_hyperdual arm[2] = {mct_hyperdual_sin(q[0]), mct_hyperdual_cos(q[0])};
    const mct_hyperdual rim[2] = {mct_hyperdual_sin(rim_angle), mct_hyperdual_cos(rim_angle)};
    for (int axis = 0; axis < 2; axis++) {
        const mct_hyperdual axle = mct_hyperdual_scale(k->arm_length, arm[axis]);
        const mct_hyperdual spoke = mct_hyperdual_scale(k->wheel_radius, rim[axis]);
        position[0][axis] = mct_hyperdual_scale(k->arm_radius, arm[axis]);
        position[1][axis] = mct_hyperdual_scale(-k->arm_radius, arm[axis]);
        position[2][axis] = mct_hyperdual_add(axle, spoke);
        position[3][axis] = mct_hyperdual_sub(axle, spoke);
    }
    for (int i = 0; i < 4; i++) {
        position[i][2] = mct_hyperdual_constant(0);
    }
}

const mct_motor *mct_reaction_wheel_motor(const void *constants)
{
    return &((const constants_t *)constants)->motor;
}

static void linearise(const struct mct_scene *scene, mct_linear_model *model)
{
    uint32_t effects = scene->effects;
    if (effects & MCT_MOTOR) {
        effects = (effects & ~(uint32_t)MCT_MOTOR) | MCT_MOTOR_QUASI_STATIC;
    }
    double e[4];
    model->states = linear_part(scene, effects, model->A, model->B, e);
    model->A[2 * 4 + 0] += e[2];
    model->A[3 * 4 + 0] += e[3];
}

MCT_STEPPER_KERNELS(MCT_ALL_SETS, seed, k->step.remainder,
                    mct_seed(derivative, k, k->step, effects, 2, x, u, dx))
MCT_STEPPER_KERNELS(MCT_ALL_SETS, euler, k->step.remainder,
                    mct_euler(kick_implicit, k, k->step, effects, 2, x, u, dx))
MCT_STEPPER_KERNELS(MCT_ALL_SETS, leap, k->step.remainder,
                    mct_leap(kick_symmetric, k, k->step, effects, 2, x, u, dx))
MCT_STEPPER_KERNELS(MCT_ALL_SETS, rk4, k->step.sixth_remainder,
                    mct_rk4(derivative_at, 0, k, k->step, effects, 2, x, u, dx))
MCT_TAYLOR_MOTOR_KERNELS(k->step.remainder)
MCT_STEPPER_KERNELS(MCT_DRY_SETS, expo, 0, mct_expo_increments(&k->expo, 2, 1, effects, 2, x, u, dx))

MCT_STEPPER_KERNELS(MCT_SMOOTH_SETS, expo8, 0, mct_expo_increments(&k->expo, 4, 3, effects, 2, x, u, dx))

static const mct_named_kernel *kernel(int stepper, uint32_t effects)
{
    static const mct_named_kernel *const kernels[MCT_STEPPER_COUNT] = {
        [MCT_STEPPER_SEED] = seed_kernels,
        [MCT_STEPPER_EULER] = euler_kernels,
        [MCT_STEPPER_LEAP] = leap_kernels,
        [MCT_STEPPER_RK4] = rk4_kernels,
        [MCT_STEPPER_EXPO] = expo_kernels,
        [MCT_STEPPER_EXPO8] = expo8_kernels,
        MCT_TAYLOR_ROWS,
    };
    return mct_kernel_of(kernels, stepper, effects);
}

static const mct_actuation actuation = {
    .driven_coordinate = 1,
    .upright_coordinate = 0,
    .supply_parameter = SUPPLY_VOLTAGE,
    .current_limit_parameter = CURRENT_LIMIT,
    .resistance_parameter = RESISTANCE,
    .inductance_parameter = INDUCTANCE,
    .accelerate = mct_reaction_wheel_accelerate,
    .linearise = linearise,
    .motor = mct_reaction_wheel_motor,
};

const mct_system mct_reaction_wheel = {
    .name = "reaction_wheel",
    .doc = "an arm that a motor-driven wheel swings up and balances",
    .source = "2.5",
    .coordinate_count = 2,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .input_without_motor = &torque_field,
    .effects = MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB | MCT_DRAG | MCT_MOTOR | MCT_SATURATION,
    .standard_effects = MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_INDUCTIVE | MCT_SATURATION_VOLTAGE,
    .particle_count = 4,
    .particle_names = particle_names,
    .actuation = &actuation,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
    .motion = mct_reaction_wheel_motion,
};

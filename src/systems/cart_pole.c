/*
 * Cart-pole: a cart of mass m1 on a track carries a massless rod of length l with a point mass m2 at its end.
 *
 * Equation      M(q) a + C(q,v) v = tau,  q = (p, th),  v = (pd, thd):
 *                   [ m1 + m2      m2 l cos th ]       [ -m2 l thd^2 sin th ]       [ f - k1 pd             ]
 *               M = [ m2 l cos th  m2 l^2      ]  Cv = [  0                 ] tau = [ m2 g l sin th - k2 thd]
 *               Friction adds - c v |v| and dry friction to each row of tau.
 *               det M = m2 l^2 (m1 + m2 sin^2 th), never taken as a difference.
 *               With a motor f = force_per_ampere i (src/effects/motor.h) through a gear of ratio N and a
 *               pulley of radius rho: the motor turns N / rho times as fast as the cart moves.
 * Source        section 2.4, eqs. 115-132.
 * Conventions   p to the right; th clockwise from the upward vertical, zero is the unstable equilibrium.
 * Differences   (125), (129), (132) have an entry -m2 l^2 that is not there; (126), (130) lack l; (131) has m
 *               for m2. Motor, dry friction, drag and saturation are ours. k2 is a couple between pole and cart.
 * Constraint    cart: the track; pole: the rod, e = m2 xdd - (0, -m2 g, 0), which also transmits the couple
 *               k2.
 * Validity      rod and track rigid; any m1, m2, l > 0. A cart much lighter than the pole makes the motion
 *               stiff where the pole hangs or stands.
 */
#include "mctau/cart_pole.h"

#include "../effects/friction.h"
#include "../effects/motor.h"
#include "../steppers/euler.h"
#include "../steppers/friction_exact.h"
#include "../steppers/leap.h"
#include "../steppers/rk4.h"
#include "../steppers/seed.h"
#include "../steppers/taylor.h"
#define MCT_SYSTEM cart_pole
#include "kernels.h"
#include "mctau/scene.h"
#include "mctau/sincos.h"
#include "mctau/stepper.h"
#include "systems.h"

typedef mct_cart_pole_constants constants_t;

enum {
    CART_MASS,
    POLE_MASS,
    POLE_LENGTH,
    CART_FRICTION,
    POLE_FRICTION,
    CART_COULOMB,
    POLE_COULOMB,
    STATIC_RATIO,
    CART_DRAG,
    POLE_DRAG,
    GRAVITY,
    TORQUE_CONSTANT,
    BACK_EMF_CONSTANT,
    RESISTANCE,
    INDUCTANCE,
    GEAR_RATIO,
    PULLEY_RADIUS,
    SUPPLY_VOLTAGE,
    CURRENT_LIMIT,
    PARAMETERS
};

static const mct_field parameters[PARAMETERS] = {
    [CART_MASS] = MCT_QUANTITY("cart_mass", "kg", 1e-6, 1e6, 0.758,
                               "cart, with the motor's rotor as seen through the gear"),
    [POLE_MASS] = MCT_QUANTITY("pole_mass", "kg", 1e-6, 1e6, 0.175, "point mass at the end of the rod"),
    [POLE_LENGTH] = MCT_QUANTITY("pole_length", "m", 1e-4, 1e4, 0.434, "pivot to point mass"),
    [CART_FRICTION] =
        MCT_COEFFICIENT(MCT_VISCOUS, "cart_friction", "N s/m", 0, 1e6, 4.3, "viscous friction of the cart"),
    [POLE_FRICTION] = MCT_COEFFICIENT(MCT_VISCOUS, "pole_friction", "N m s", 0, 1e6, 0.0024,
                                      "viscous friction of the pivot"),
    [CART_COULOMB] = MCT_COEFFICIENT(MCT_COULOMB, "cart_coulomb", "N", 0, 1e6, 0, "dry friction of the cart"),
    [POLE_COULOMB] =
        MCT_COEFFICIENT(MCT_COULOMB, "pole_coulomb", "N m", 0, 1e6, 0, "dry friction of the pivot"),
    [STATIC_RATIO] = MCT_STATIC_RATIO,
    [CART_DRAG] = MCT_COEFFICIENT(MCT_DRAG, "cart_drag", "N s^2/m^2", 0, 1e6, 0,
                                  "force of the air on the cart by the square of its velocity"),
    [POLE_DRAG] = MCT_COEFFICIENT(MCT_DRAG, "pole_drag", "N m s^2", 0, 1e6, 0,
                                  "torque of the air on the pole by the square of its rate"),
    [GRAVITY] = MCT_COEFFICIENT(MCT_GRAVITY, "gravity", "m/s^2", 0, 1e4, 9.81, "gravitational acceleration"),
    [TORQUE_CONSTANT] =
        MCT_COEFFICIENT(MCT_MOTOR, "torque_constant", "N m/A", 0, 1e4, 0.00767, "motor torque per current"),
    [BACK_EMF_CONSTANT] = MCT_COEFFICIENT(MCT_MOTOR, "back_emf_constant", "V s/rad", 0, 1e4, 0.00767,
                                          "motor voltage per speed"),
    [RESISTANCE] = MCT_COEFFICIENT(MCT_MOTOR, "resistance", "ohm", 0, 1e6, 2.6, "armature"),
    [INDUCTANCE] = MCT_COEFFICIENT(MCT_MOTOR_INDUCTIVE, "inductance", "H", 0, 1e3, 0.00018, "armature"),
    [GEAR_RATIO] =
        MCT_COEFFICIENT(MCT_MOTOR, "gear_ratio", "", 1e-3, 1e4, 3.71, "motor turns per pulley turn"),
    [PULLEY_RADIUS] = MCT_COEFFICIENT(MCT_MOTOR, "pulley_radius", "m", 1e-5, 1e3, 0.00635,
                                      "pulley or pinion that drives the cart"),
    [SUPPLY_VOLTAGE] =
        MCT_COEFFICIENT(MCT_MOTOR, "supply_voltage", "V", 1e-3, 1e4, 10, "largest voltage either way"),
    [CURRENT_LIMIT] = MCT_COEFFICIENT(MCT_SATURATION_CURRENT, "current_limit", "A", 1e-6, 1e4, 3,
                                      "of the drive, either way"),
};

static const mct_coordinate coordinates[2] = {
    {.position = MCT_QUANTITY("cart_position", "m", -1e6, 1e6, 0, "to the right"),
     .rate = MCT_QUANTITY("cart_velocity", "m/s", -1e6, 1e6, 0, ""),
     MCT_ENCODER("cart", "metre", "1/m", 1, 43958, "the cart"),
     .position_weight = 0.3,
     .rate_weight = 1.0},
    {.position = MCT_QUANTITY("pole_angle", "rad", -1e6, 1e6, 3.141592653589793, "clockwise from upright"),
     .rate = MCT_QUANTITY("pole_rate", "rad/s", -1e6, 1e6, 0, ""),
     .is_angle = true,
     MCT_ENCODER("pole", "turn", "1/turn", 4, 4096, "the pole"),
     .position_weight = 0.15,
     .rate_weight = 1.5},
};

static const mct_field force_field = MCT_QUANTITY("force", "N", -1e9, 1e9, 0, "on the cart");
static const char *const particle_names[] = {"cart", "pole"};

static mct_status prepare(const struct mct_scene *scene, double h, void *constants, struct mct_message *why)
{
    constants_t *k = constants;
    const double *p = scene->parameters;
    const uint32_t effects = mct_scene_effects(scene);
    const bool gravity = effects & MCT_GRAVITY;
    const bool viscous = effects & MCT_VISCOUS;
    const bool coulomb = effects & MCT_COULOMB;
    const double inertia = p[POLE_MASS] * p[POLE_LENGTH] * p[POLE_LENGTH];
    k->step = mct_step_of(h);
    k->cart_mass = (mct_real)p[CART_MASS];
    k->pole_mass = (mct_real)p[POLE_MASS];
    k->total_mass = (mct_real)(p[CART_MASS] + p[POLE_MASS]);
    k->length = (mct_real)p[POLE_LENGTH];
    k->moment = (mct_real)(p[POLE_MASS] * p[POLE_LENGTH]);
    k->inertia = (mct_real)inertia;
    k->gravity = (mct_real)(gravity ? p[GRAVITY] : 0);
    k->weight_moment = (mct_real)(gravity ? p[POLE_MASS] * p[GRAVITY] * p[POLE_LENGTH] : 0);
    k->inverse_length = (mct_real)(1 / p[POLE_LENGTH]);
    k->mass_per_inertia = (mct_real)((p[CART_MASS] + p[POLE_MASS]) / inertia);
    k->cart_viscous = (mct_real)(viscous ? p[CART_FRICTION] : 0);
    k->pole_viscous = (mct_real)(viscous ? p[POLE_FRICTION] : 0);
    k->coulomb[0] = (mct_real)(coulomb ? p[CART_COULOMB] : 0);
    k->coulomb[1] = (mct_real)(coulomb ? p[POLE_COULOMB] : 0);
    k->hold[0] = (mct_real)(coulomb ? p[STATIC_RATIO] * p[CART_COULOMB] : 0);
    k->hold[1] = (mct_real)(coulomb ? p[STATIC_RATIO] * p[POLE_COULOMB] : 0);
    k->drag[0] = (mct_real)(effects & MCT_DRAG ? p[CART_DRAG] : 0);
    k->drag[1] = (mct_real)(effects & MCT_DRAG ? p[POLE_DRAG] : 0);
    const mct_status status =
        mct_motor_prepare(&k->motor, effects, p[GEAR_RATIO] / p[PULLEY_RADIUS], p[TORQUE_CONSTANT],
                          p[BACK_EMF_CONSTANT], p[RESISTANCE], p[INDUCTANCE], h);
    k->cart_damping = k->cart_viscous + ((effects & MCT_MOTOR_QUASI_STATIC) ? k->motor.damping : 0);
    if (status == MCT_ERROR_RANGE) {
        mct_motor_refuse(p[RESISTANCE], p[INDUCTANCE], why);
    }
    return status;
}

MCT_INLINE bool is_cart_damped(unsigned effects)
{
    return (effects & (MCT_VISCOUS | MCT_MOTOR_QUASI_STATIC)) != 0;
}

/* Whether anything acts on the pole. A compiler may not drop a product with 0: what is off is left out by hand. */
MCT_INLINE bool is_pole_loaded(unsigned effects)
{
    return (effects & (MCT_GRAVITY | MCT_VISCOUS | MCT_DRAG)) != 0;
}

/* Drag by the square as a damping, which grows with the rate. */
MCT_INLINE mct_real drag_of(const constants_t *k, int i, mct_real rate)
{
    return k->drag[i] * (rate < 0 ? -rate : rate);
}

/* a = M^-1 (f1, f2), where f is tau - C v. */
MCT_INLINE void solve(const constants_t *k, bool pole_loaded, mct_real s, mct_real c, mct_real f1,
                      mct_real f2, mct_real *a)
{
    const mct_real inverse = 1 / (k->cart_mass + k->pole_mass * s * s);
    const mct_real c_over_l = c * k->inverse_length;
    if (!pole_loaded) {
        a[0] = inverse * f1;
        a[1] = -inverse * (c_over_l * f1);
        return;
    }
    a[0] = inverse * (f1 - c_over_l * f2);
    a[1] = inverse * (k->mass_per_inertia * f2 - c_over_l * f1);
}

MCT_INLINE void derivative_at(const void *constants, unsigned effects, const mct_real *x, mct_real s,
                              mct_real c, mct_real u, mct_real *dx)
{
    const constants_t *k = constants;
    const mct_real pd = x[2];
    const mct_real thd = x[3];
    const mct_real current = (effects & MCT_MOTOR_INDUCTIVE) ? x[4] : 0;
    mct_real f1 = mct_motor_force(&k->motor, effects, u, current) + k->moment * s * thd * thd;
    mct_real f2 = 0;
    if (effects & MCT_GRAVITY) {
        f2 = k->weight_moment * s;
    }
    if (is_cart_damped(effects)) {
        f1 -= k->cart_damping * pd;
    }
    if (effects & MCT_VISCOUS) {
        f2 -= k->pole_viscous * thd;
    }
    if (effects & MCT_DRAG) {
        f1 -= drag_of(k, 0, pd) * pd;
        f2 -= drag_of(k, 1, thd) * thd;
    }
    dx[0] = pd;
    dx[1] = thd;
    solve(k, is_pole_loaded(effects), s, c, f1, f2, dx + 2);
    if (effects & MCT_MOTOR_INDUCTIVE) {
        dx[4] = mct_motor_current_rate(&k->motor, u, pd, current);
    }
}

MCT_INLINE void derivative(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                           mct_real *dx)
{
    mct_real s, c;
    mct_sincos(x[1], &s, &c);
    derivative_at(constants, effects, x, s, c, u, dx);
}

/*
 * Velocity increments of an impulse over the step, with the matrix M + extra, where extra = [e11 -bilinear; 0 e22]
 * holds what is taken implicitly. The determinant is that of M plus what extra adds, so that a light cart
 * does not lose it.
 */
MCT_INLINE void impulse(const constants_t *k, unsigned effects, mct_real s, mct_real c, mct_real e11,
                        mct_real bilinear, mct_real e22, mct_real p1, mct_real p2, mct_real *dv)
{
    const bool cart_damped = (effects & (MCT_VISCOUS | MCT_MOTOR | MCT_DRAG)) != 0;
    const bool pole_damped = (effects & (MCT_VISCOUS | MCT_DRAG)) != 0;
    const mct_real m12 = k->moment * c;
    const mct_real a11 = cart_damped ? k->total_mass + e11 : k->total_mass;
    const mct_real a12 = m12 - bilinear;
    const mct_real a22 = pole_damped ? k->inertia + e22 : k->inertia;
    const mct_real det_M = k->inertia * (k->cart_mass + k->pole_mass * s * s);
    const mct_real drift = bilinear * m12;
    const mct_real det = pole_damped   ? det_M + (e11 * a22 + k->total_mass * e22 + drift)
                         : cart_damped ? det_M + (e11 * a22 + drift)
                                       : det_M + drift;
    const mct_real inverse = 1 / det;
    if (!is_pole_loaded(effects)) {
        dv[0] = inverse * (a22 * p1);
        dv[1] = -inverse * (m12 * p1);
        return;
    }
    dv[0] = inverse * (a22 * p1 - a12 * p2);
    dv[1] = inverse * (a11 * p2 - m12 * p1);
}

/* Drag is bilinear in the old rate and the new one. */
MCT_INLINE void take_drag(const constants_t *k, mct_real pd, mct_real thd, mct_real *f1, mct_real *f2,
                          mct_real *e11, mct_real *e22)
{
    const mct_real on_cart = drag_of(k, 0, pd);
    const mct_real on_pole = drag_of(k, 1, thd);
    *f1 -= on_cart * pd;
    *f2 -= on_pole * thd;
    *e11 += k->step.h * on_cart;
    *e22 += k->step.h * on_pole;
}

/* Kick of `euler`: damping and current implicit, h known to the constants. */
MCT_INLINE void kick_implicit(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                              mct_real *dx)
{
    const constants_t *k = constants;
    const mct_real h = k->step.h;
    const mct_real pd = x[2];
    const mct_real thd = x[3];
    mct_real s, c;
    mct_sincos(x[1], &s, &c);
    mct_real current = 0;
    if (effects & MCT_MOTOR_INDUCTIVE) {
        current = mct_motor_implicit_current(&k->motor, h, u, pd, x[4]);
        dx[4] = current - x[4];
    }
    mct_real f1 = mct_motor_force(&k->motor, effects, u, current) + k->moment * s * thd * thd;
    mct_real f2 = 0;
    mct_real e11 = 0;
    mct_real e22 = 0;
    if (effects & MCT_GRAVITY) {
        f2 = k->weight_moment * s;
    }
    if (is_cart_damped(effects)) {
        f1 -= k->cart_damping * pd;
        e11 = h * k->cart_damping;
    }
    if (effects & MCT_VISCOUS) {
        f2 -= k->pole_viscous * thd;
        e22 = h * k->pole_viscous;
    }
    if (effects & MCT_DRAG) {
        take_drag(k, pd, thd, &f1, &f2, &e11, &e22);
    }
    impulse(k, effects, s, c, e11, 0, e22, h * f1, h * f2, dx + 2);
}

/* Kick of `leap`: bilinear in old and new velocity, damping at their mean, current averaged exactly. */
MCT_INLINE void kick_symmetric(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                               mct_real *dx)
{
    const constants_t *k = constants;
    const mct_real h = k->step.h;
    const mct_real half = k->step.half;
    const mct_real pd = x[2];
    const mct_real thd = x[3];
    mct_real s, c;
    mct_sincos(x[1], &s, &c);
    const mct_real centrifugal = k->moment * s * thd;
    mct_real current = 0;
    mct_real e11 = 0;
    mct_real e22 = 0;
    if (effects & MCT_MOTOR_INDUCTIVE) {
        current = mct_motor_mean_current(&k->motor, u, pd, x[4]);
        e11 = h * k->motor.force_per_ampere * k->motor.emf * k->motor.mean_from_change;
    }
    mct_real f1 = mct_motor_force(&k->motor, effects, u, current) + centrifugal * thd;
    mct_real f2 = 0;
    if (effects & MCT_GRAVITY) {
        f2 = k->weight_moment * s;
    }
    if (is_cart_damped(effects)) {
        f1 -= k->cart_damping * pd;
        e11 += half * k->cart_damping;
    }
    if (effects & MCT_VISCOUS) {
        f2 -= k->pole_viscous * thd;
        e22 = half * k->pole_viscous;
    }
    if (effects & MCT_DRAG) {
        take_drag(k, pd, thd, &f1, &f2, &e11, &e22);
    }
    impulse(k, effects, s, c, e11, h * centrifugal, e22, h * f1, h * f2, dx + 2);
    if (effects & MCT_MOTOR_INDUCTIVE) {
        dx[4] = mct_motor_current_change(&k->motor, u, pd, x[4], dx[2]);
    }
}

/*
 * Of Lagrange's equations, by terms: with c w for cos th thd, the first one is (m1 + m2) pd + m2 l c w = integral of
 * f - k1 pd, which spares the centrifugal term; c w and s w are the rates of sine and cosine, too. In a mode of exact
 * friction, what is at rest has an unlimited mass; the load on it is what its own equation leaves.
 */
MCT_INLINE void series(const void *constants, unsigned effects, int order, const mct_real *x, mct_real u,
                       const mct_slip *slip, mct_series *rates, mct_series *loads)
{
    const constants_t *k = constants;
    const mct_real h = k->step.h;
    mct_real *const v = rates[0], *const w = rates[1], *const current = rates[2];
    mct_series s, c, a;      /* a: accelerations of the cart, times h */
    mct_series carts, poles; /* impulses that change the rates */
    mct_sincos(x[1], &s[0], &c[0]);
    v[0] = x[2];
    w[0] = x[3];
    if (effects & MCT_MOTOR_INDUCTIVE) {
        current[0] = x[4];
    }
    mct_real to_v[2], to_w[2]; /* by a unit of impulse on cart and pole */
    solve(k, true, s[0], c[0], 1, 0, to_v);
    solve(k, true, s[0], c[0], 0, 1, to_w);
    mct_real against[2] = {0, 0}; /* dynamic friction */
    mct_real drag[2] = {0, 0};
    if (effects & MCT_COULOMB_EXACT) {
        const bool is_held[2] = {slip->direction[0] == 0, slip->direction[1] == 0};
        if (is_held[0] || is_held[1]) {
            to_v[0] = is_held[0] ? 0 : 1 / k->total_mass;
            to_v[1] = to_w[0] = 0;
            to_w[1] = is_held[1] ? 0 : 1 / k->inertia;
        }
        for (int i = 0; i < 2; i++) {
            against[i] = slip->direction[i] * k->coulomb[i];
            drag[i] = slip->direction[i] * k->drag[i];
        }
    }
    mct_real cw = c[0] * w[0];
    MCT_UNROLL
    for (int n = 0; n < order; n++) {
        const mct_real part = mct_series_share(n);
        const mct_real share = h * part;
        const mct_real input = n == 0 ? u : MCT_NOTHING;
        mct_real sw = MCT_NOTHING;
        mct_real ca = MCT_NOTHING; /* as the next cw, but for c[0] times what is sought */
        s[n + 1] = share * cw;
        cw = MCT_NOTHING;
        MCT_UNROLL
        for (int j = n; j > 0; j--) { /* what is known first, first */
            sw += s[j] * w[n - j];
            cw += c[j] * w[n + 1 - j];
            ca += c[j] * a[n - j];
        }
        c[n + 1] = -share * sw - (share * s[0]) * w[n];
        mct_real f1 = MCT_NOTHING;
        if (n == 0 || (effects & MCT_MOTOR_INDUCTIVE)) {
            f1 = mct_motor_force(&k->motor, effects, u, (effects & MCT_MOTOR_INDUCTIVE) ? current[n] : 0);
        }
        mct_real f2 = MCT_NOTHING;
        if (effects & MCT_GRAVITY) {
            f2 = k->weight_moment * s[n];
        }
        if ((effects & MCT_COULOMB_EXACT) && n == 0) {
            f1 -= against[0];
            f2 -= against[1];
        }
        if (effects & MCT_DRAG) {
            f1 -= drag[0] * mct_series_product(v, v, n);
            f2 -= drag[1] * mct_series_product(w, w, n);
        }
        if (is_cart_damped(effects)) {
            f1 -= k->cart_damping * v[n];
        }
        if (effects & MCT_VISCOUS) {
            f2 -= k->pole_viscous * w[n];
        }
        const mct_real on_cart = (share * f1 - k->moment * cw) - (k->moment * w[0]) * c[n + 1];
        const mct_real on_pole = share * f2 - (k->moment * part) * ca;
        v[n + 1] = to_v[0] * on_cart + to_w[0] * on_pole;
        w[n + 1] = to_v[1] * on_cart + to_w[1] * on_pole;
        carts[n] = on_cart;
        poles[n] = on_pole;
        a[n] = (mct_real)(n + 1) * v[n + 1];
        cw += c[n + 1] * w[0] + c[0] * w[n + 1];
        if (effects & MCT_MOTOR_INDUCTIVE) {
            current[n + 1] = share * mct_motor_current_rate(&k->motor, input, v[n], current[n]);
        }
    }
    if ((effects & MCT_COULOMB_EXACT) && (slip->direction[0] == 0 || slip->direction[1] == 0)) {
        const mct_real coupling = k->moment * c[0];
        const mct_real per_step = 1 / h;
        for (int n = 0; n < order; n++) {
            const mct_real rate = (mct_real)(n + 1) * per_step;
            loads[0][n] = rate * (carts[n] - coupling * w[n + 1]);
            loads[1][n] = rate * (poles[n] - coupling * v[n + 1]);
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

void mct_cart_pole_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real u,
                          mct_motion *out)
{
    const constants_t *k = constants;
    mct_taylor_motion(series, constants, k->step, effects, 2, state, u, out);
}

MCT_INLINE mct_inertia2 inertia_at(const constants_t *k, mct_real s, mct_real c)
{
    const mct_real inverse = 1 / (k->cart_mass + k->pole_mass * s * s);
    return (mct_inertia2){{k->total_mass, k->moment * c, k->inertia},
                          {inverse, -inverse * c * k->inverse_length, inverse * k->mass_per_inertia}};
}

/*
 * Moreau's friction, with the matrix where the pole would be after half a step at its rate: that is the middle of the step
 * up to h^2, and known before the step is. s, c: there.
 */
MCT_INLINE void slide(const constants_t *k, unsigned effects, mct_real s, mct_real c, const mct_real *x,
                      mct_real *dx)
{
    if (effects & MCT_COULOMB_MOREAU) {
        mct_friction_correct(inertia_at(k, s, c), k->coulomb, k->hold, k->step.h, x + 2, dx);
    }
}

/* From the sine at the start, which the stepper has taken, too. */
MCT_INLINE void slide_from_start(const constants_t *k, unsigned effects, const mct_real *x, mct_real *dx)
{
    const mct_real turned = k->step.half * x[3];
    mct_real s0, c0, s, c;
    mct_sincos(x[1], &s0, &c0);
    mct_sincos_near(x[1] + turned, turned, s0, c0, &s, &c);
    slide(k, effects, s, c, x, dx);
}

/* `leap` has taken that of the middle, */
MCT_INLINE void slide_from_middle(const constants_t *k, unsigned effects, const mct_real *x, mct_real *dx)
{
    mct_real s, c;
    mct_sincos(x[1] + k->step.half * x[3], &s, &c);
    slide(k, effects, s, c, x, dx);
}

/* and so has `rk4`. */
MCT_INLINE void runge_kutta(const constants_t *k, unsigned effects, const mct_real *x, mct_real u,
                            mct_real *dx)
{
    mct_real middle[2];
    mct_rk4_by_middle(derivative_at, 1, k, k->step, effects, 2, x, u, dx, middle);
    slide(k, effects, middle[0], middle[1], x, dx);
}

static void evaluate(const void *constants, uint32_t effects, const mct_real *x, mct_real u,
                     mct_evaluation *out)
{
    const constants_t *k = constants;
    const mct_real pd = x[2];
    const mct_real thd = x[3];
    mct_real s, c;
    mct_sincos(x[1], &s, &c);
    *out = (mct_evaluation){0};
    out->M[0][0] = k->total_mass;
    out->M[0][1] = out->M[1][0] = k->moment * c;
    out->M[1][1] = k->inertia;
    out->C[0][1] = -k->moment * s * thd;
    out->Cv[0] = out->C[0][1] * thd;

    mct_real drive = u;
    if (effects & MCT_MOTOR) {
        out->current =
            (effects & MCT_MOTOR_INDUCTIVE) ? x[4] : mct_motor_quasi_static_current(&k->motor, u, pd);
        drive = k->motor.force_per_ampere * out->current;
    }
    const mct_real cart_viscous = -k->cart_viscous * pd;
    const mct_real pole_viscous = -k->pole_viscous * thd;
    const mct_real cart_drag = -drag_of(k, 0, pd) * pd;
    const mct_real pole_drag = -drag_of(k, 1, thd) * thd;
    const mct_real smooth[2] = {drive + cart_viscous + cart_drag - out->Cv[0],
                                k->weight_moment * s + pole_viscous + pole_drag};
    mct_real dry[2];
    const mct_inertia2 inertia = inertia_at(k, s, c);
    mct_friction_force(&inertia, k->coulomb, k->hold, x + 2, smooth, dry);
    solve(k, true, s, c, smooth[0] + dry[0], smooth[1] + dry[1], out->acceleration);
    out->tau[0] = drive + cart_viscous + cart_drag + dry[0];
    out->tau[1] = k->weight_moment * s + pole_viscous + pole_drag + dry[1];

    const mct_real a = out->acceleration[0];
    const mct_real alpha = out->acceleration[1];
    const mct_real pole_acceleration[2] = {a + k->length * (c * alpha - s * thd * thd),
                                           -k->length * (s * alpha + c * thd * thd)};
    out->mass[0] = k->cart_mass;
    out->mass[1] = k->pole_mass;
    out->position[0][0] = x[0];
    out->position[1][0] = x[0] + k->length * s;
    out->position[1][1] = k->length * c;
    out->force[0][0] = out->tau[0];
    out->force[0][1] = -k->cart_mass * k->gravity;
    out->force[1][1] = -k->pole_mass * k->gravity;
    out->constraint_force[0][0] = k->cart_mass * a - out->tau[0];
    out->constraint_force[0][1] = k->cart_mass * k->gravity;
    out->constraint_force[1][0] = k->pole_mass * pole_acceleration[0];
    out->constraint_force[1][1] = k->pole_mass * (pole_acceleration[1] + k->gravity);

    out->kinetic_energy =
        MCT_R(0.5) * (k->total_mass * pd * pd + k->inertia * thd * thd) + k->moment * c * pd * thd;
    out->potential_energy = k->weight_moment * c;
    out->power[MCT_EFFECT_GRAVITY] = k->weight_moment * s * thd;
    out->power[MCT_EFFECT_VISCOUS] = cart_viscous * pd + pole_viscous * thd;
    out->power[MCT_EFFECT_DRAG] = cart_drag * pd + pole_drag * thd;
    out->power[MCT_EFFECT_COULOMB] = dry[0] * pd + dry[1] * thd;
    mct_motor_powers(&k->motor, effects, u, pd, out);
}

MCT_INLINE void accelerate_at(const constants_t *k, uint32_t effects, const mct_real *x, mct_real s,
                              mct_real c, mct_real u, mct_real *a)
{
    const mct_real force = mct_motor_observed_force(&k->motor, effects, u, x[2]);
    const mct_real thd = x[3];
    mct_real cart_damping = k->cart_viscous;
    mct_real pole_damping = k->pole_viscous;
    if (effects & MCT_DRAG) {
        cart_damping += drag_of(k, 0, x[2]);
        pole_damping += drag_of(k, 1, thd);
    }
    solve(k, true, s, c, force - cart_damping * x[2] + k->moment * s * thd * thd,
          k->weight_moment * s - pole_damping * thd, a);
}

void mct_cart_pole_accelerate(const void *constants, uint32_t effects, const mct_real *x, mct_real s,
                              mct_real c, mct_real u, mct_real *a)
{
    accelerate_at(constants, effects, x, s, c, u, a);
}

/* The cart's acceleration grows by as much with each unit of input. */
mct_real mct_cart_pole_input_for(const mct_cart_pole_constants *k, uint32_t effects, const mct_real *x,
                                 mct_real s, mct_real c, mct_real acceleration)
{
    mct_real without[2], with_one[2];
    accelerate_at(k, effects, x, s, c, 0, without);
    accelerate_at(k, effects, x, s, c, 1, with_one);
    return (acceleration - without[0]) / (with_one[0] - without[0]);
}

static void place(const void *constants, mct_hyperdual time, const mct_hyperdual *q,
                  mct_hyperdual (*position)[3])
{
    (void)time;
    const constants_t *k = constants;
    const mct_hyperdual zero = mct_hyperdual_constant(0);
    position[0][0] = q[0];
    position[0][1] = zero;
    position[0][2] = zero;
    position[1][0] = mct_hyperdual_add(q[0], mct_hyperdual_scale(k->length, mct_hyperdual_sin(q[1])));
    position[1][1] = mct_hyperdual_scale(k->length, mct_hyperdual_cos(q[1]));
    position[1][2] = zero;
}

const mct_motor *mct_cart_pole_motor(const void *constants)
{
    return &((const constants_t *)constants)->motor;
}

static void linearise(const struct mct_scene *scene, mct_linear_model *model)
{
    const double *p = scene->parameters;
    const bool viscous = scene->effects & MCT_VISCOUS;
    const double ratio = p[GEAR_RATIO] / p[PULLEY_RADIUS];
    const bool motor = scene->effects & MCT_MOTOR;
    const double volts_to_force = motor ? ratio * p[TORQUE_CONSTANT] / p[RESISTANCE] : 1;
    const double back_emf = motor ? volts_to_force * ratio * p[BACK_EMF_CONSTANT] : 0;
    const double cart_damping = (viscous ? p[CART_FRICTION] : 0) + back_emf;
    const double pole_damping = viscous ? p[POLE_FRICTION] : 0;
    const double stiffness = (scene->effects & MCT_GRAVITY) ? p[POLE_MASS] * p[GRAVITY] * p[POLE_LENGTH] : 0;
    /* M^-1 upright: [1, -1/l; -1/l, (m1 + m2)/(m2 l^2)] / m1. */
    const double w11 = 1 / p[CART_MASS];
    const double w12 = -w11 / p[POLE_LENGTH];
    const double w22 = w11 * (p[CART_MASS] + p[POLE_MASS]) / (p[POLE_MASS] * p[POLE_LENGTH] * p[POLE_LENGTH]);
    *model = (mct_linear_model){
        .states = 4,
        /* clang-format off */
        .A = {0, 0, 1, 0,
              0, 0, 0, 1,
              0, w12 * stiffness, -w11 * cart_damping, -w12 * pole_damping,
              0, w22 * stiffness, -w12 * cart_damping, -w22 * pole_damping},
        /* clang-format on */
        .B = {0, 0, w11 * volts_to_force, w12 * volts_to_force},
    };
}

#define friction mct_no_friction /* the steppers here see to it, which know a sine near the middle */

MCT_STEPPER_KERNELS(MCT_ALL_SETS, seed, k->step.remainder,
                    (mct_seed(derivative, k, k->step, effects, 2, x, u, dx),
                     slide_from_start(k, effects, x, dx)))
MCT_STEPPER_KERNELS(MCT_ALL_SETS, euler, k->step.remainder,
                    (mct_euler(kick_implicit, k, k->step, effects, 2, x, u, dx),
                     slide_from_start(k, effects, x, dx)))
MCT_STEPPER_KERNELS(MCT_ALL_SETS, leap, k->step.remainder,
                    (mct_leap(kick_symmetric, k, k->step, effects, 2, x, u, dx),
                     slide_from_middle(k, effects, x, dx)))
MCT_STEPPER_KERNELS(MCT_ALL_SETS, rk4, k->step.sixth_remainder, runge_kutta(k, effects, x, u, dx))
MCT_TAYLOR_MOTOR_KERNELS(k->step.remainder)

static const mct_named_kernel *kernel(int stepper, uint32_t effects)
{
    static const mct_named_kernel *const kernels[MCT_STEPPER_COUNT] = {
        [MCT_STEPPER_SEED] = seed_kernels,
        [MCT_STEPPER_EULER] = euler_kernels,
        [MCT_STEPPER_LEAP] = leap_kernels,
        [MCT_STEPPER_RK4] = rk4_kernels,
        MCT_TAYLOR_ROWS,
    };
    return mct_kernel_of(kernels, stepper, effects);
}

static const mct_actuation actuation = {
    .driven_coordinate = 0,
    .upright_coordinate = 1,
    .supply_parameter = SUPPLY_VOLTAGE,
    .current_limit_parameter = CURRENT_LIMIT,
    .resistance_parameter = RESISTANCE,
    .inductance_parameter = INDUCTANCE,
    .accelerate = mct_cart_pole_accelerate,
    .linearise = linearise,
    .motor = mct_cart_pole_motor,
};

const mct_system mct_cart_pole = {
    .name = "cart_pole",
    .doc = "a pole on a cart: the classical inverted pendulum",
    .source = "2.4",
    .coordinate_count = 2,
    .coordinates = coordinates,
    .parameter_count = PARAMETERS,
    .parameters = parameters,
    .input_without_motor = &force_field,
    .effects = MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB | MCT_DRAG | MCT_MOTOR | MCT_SATURATION,
    .standard_effects = MCT_GRAVITY | MCT_VISCOUS | MCT_MOTOR_QUASI_STATIC | MCT_SATURATION_VOLTAGE,
    .particle_count = 2,
    .particle_names = particle_names,
    .actuation = &actuation,
    .prepare = prepare,
    .evaluate = evaluate,
    .place = place,
    .kernel = kernel,
    .motion = mct_cart_pole_motion,
};

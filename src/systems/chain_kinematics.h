/*
 * Kinematic chain: n links of lengths l in a plane, the first hinged to the origin; the angles change until
 * the tip is at a target. A process without time: one update a step.
 *
 * Equation      tip f(q) = sum_i l_i (cos, sin)(q_1 + ... + q_i),  error e = d - f,  J = df/dq
 *               transpose  dq = kappa J' e
 *               inverse    dq = J' (J J')^-1 e
 *               ridge      dq = J' (J J' + alpha)^-1 e
 * Source        section 7, eqs. 420-434.
 * Conventions   q relative: the first from axis 1, each other one from the link before, counterclockwise.
 * Differences   (424)-(426): J'J is n x n of rank 2, singular from three links on; the pseudo-inverse stands
 *               in. (427): the penalty is alpha |dq|^2 / 2, which gives (430) itself; as printed it pulls q
 *               to 0. (431), (434): l_i; the angles up to link i.
 *               d is the point within reach that is nearest to the target: the nearest tip is the same, but
 *               the error ends at 0, and with it the damping. Around a target out of reach itself the chain
 *               would swing.
 *               No angle changes by more than `largest_step`. A pose without a gradient is bent by 1e-3 rad.
 *               gain = 0: kappa = |J'e|^2 / |JJ'e|^2, which makes |e - J dq| least (S. R. Buss, Introduction
 *               to inverse kinematics, 2004).
 *               ridge = 0: alpha = |e|^2 / 2 + |e| reach / 1000, after T. Sugihara (IEEE Transactions on
 *               Robotics 27, 2011). The first term bounds the step, |dq| <= sqrt(1/2); the second sees to it
 *               where J is singular at the goal, and dies out with the error, as a constant does not.
 * Validity      Where J'e = 0 and e is not, all joints lie on one line with d: a saddle, so whatever leaves
 *               the saddles comes home. ridge does; inverse and transpose not always: docs/systems/chain.md.
 *
 * All functions are pure: no error but NaN from NaN, thread-safe, O(n).
 */
#ifndef MCTAU_CHAIN_KINEMATICS_H
#define MCTAU_CHAIN_KINEMATICS_H

#include "mctau/arctan.h"
#include "mctau/chain.h"
#include "mctau/matrix.h"
#include "mctau/sincos.h"

#define MCT_CHAIN_BEND MCT_R(1e-3) /**< of every joint, where there is no gradient [rad] */
#define MCT_CHAIN_GOAL \
    MCT_R(1e-6) /**< an error that does, as a part of the reach; a pose so near is not bent */

/** What follows from the lengths and the target. Sums in double. */
static inline void mct_chain_complete(mct_chain_constants *self)
{
    const double x = (double)self->target[0];
    const double y = (double)self->target[1];
    const double distance = mct_sqrt(x * x + y * y);
    double reach = 0;
    double longest = 0;
    for (int32_t i = 0; i < self->links; i++) {
        reach += (double)self->length[i];
        longest = mct_max(longest, (double)self->length[i]);
    }
    const double inner = mct_max(2 * longest - reach, 0);
    const double nearest = mct_max(mct_min(distance, reach), inner);
    self->reach = (mct_real)reach;
    self->inner = (mct_real)inner;
    self->aim[0] = (mct_real)(distance > 0 ? x * (nearest / distance) : nearest);
    self->aim[1] = (mct_real)(distance > 0 ? y * (nearest / distance) : 0);
}

/** The highest gain that is stable in every pose, 2 / |J|^2 of the stretched one [1/m^2]. */
static inline mct_real mct_chain_largest_gain(const mct_chain_constants *self)
{
    mct_real arm = 0;
    mct_real sum = 0;
    for (int32_t k = self->links - 1; k >= 0; k--) {
        arm += self->length[k];
        sum += arm * arm;
    }
    return 2 / sum;
}

typedef struct {
    mct_real arm[MCT_CHAIN_MAX_LINKS + 1][2]; /**< from joint k to the tip [m]; the last is 0. Link i ends at
                                                   arm[0] - arm[i + 1]; the tip is arm[0] */
    mct_real error[2];                        /**< e, from the tip to the aim [m] */
} mct_chain_pose;

/** (431), (433). Directions are turned, not angles added: a chain that has wound itself up loses nothing. */
static inline void mct_chain_place(const mct_chain_constants *self, const mct_real *angles,
                                   mct_chain_pose *pose)
{
    const int32_t n = self->links;
    mct_real sine = 0;
    mct_real cosine = 1;
    for (int32_t i = 0; i < n; i++) {
        mct_real s, c;
        mct_sincos(angles[i], &s, &c);
        const mct_real turned = sine * c + cosine * s;
        cosine = cosine * c - sine * s;
        sine = turned;
        pose->arm[i][0] = self->length[i] * cosine;
        pose->arm[i][1] = self->length[i] * sine;
    }
    pose->arm[n][0] = 0;
    pose->arm[n][1] = 0;
    for (int32_t k = n - 1; k >= 0; k--) {
        pose->arm[k][0] += pose->arm[k + 1][0];
        pose->arm[k][1] += pose->arm[k + 1][1];
    }
    pose->error[0] = self->aim[0] - pose->arm[0][0];
    pose->error[1] = self->aim[1] - pose->arm[0][1];
}

/** (434): turning joint k moves the tip across its arm. */
static inline void mct_chain_jacobian(const mct_chain_constants *self, const mct_chain_pose *pose,
                                      mct_real (*jacobian)[MCT_CHAIN_MAX_LINKS])
{
    for (int32_t k = 0; k < self->links; k++) {
        jacobian[0][k] = -pose->arm[k][1];
        jacobian[1][k] = pose->arm[k][0];
    }
}

/** |e|^2 [m^2], from the aim; the target itself may lie beyond. */
static inline mct_real mct_chain_error_squared(const mct_chain_pose *pose)
{
    return pose->error[0] * pose->error[0] + pose->error[1] * pose->error[1];
}

static inline bool mct_chain_converged(const mct_chain_constants *self, const mct_chain_pose *pose)
{
    const mct_real goal = MCT_CHAIN_GOAL * self->reach;
    return mct_chain_error_squared(pose) <= goal * goal;
}

/*
 * dq = J' w, (J J' + alpha) w = e, on axes along the error and across it: there e = (size, 0), and J has the
 * rows g and h. h is eliminated from g first: sums of squares are all that is left, no determinant that is a
 * small difference.
 */
static inline void mct_chain_least_squares(int32_t n, const mct_real *g, const mct_real *h, mct_real gg,
                                           mct_real gh, mct_real hh, mct_real size, mct_real ridge,
                                           mct_real *step)
{
    const mct_real damped = hh + ridge;
    const mct_real share = damped > 0 ? gh / damped : 0;
    mct_real rest = 0; /* of g, squared */
    for (int32_t k = 0; k < n; k++) {
        step[k] = g[k] - share * h[k];
        rest += step[k] * step[k];
    }
    const mct_real rounding = 8 * MCT_REAL_EPSILON;
    const bool rank_one = ridge <= 0 && rest <= rounding * rounding * gg; /* one link; all in one line */
    const mct_real factor = size / (rank_one ? gg + hh : ridge * (1 + share * share) + rest);
    for (int32_t k = 0; k < n; k++) {
        step[k] = factor * (rank_one ? g[k] : step[k]);
    }
}

/* alpha of an update [m^2], for an error of this size; 0 of `inverse`. */
static inline mct_real mct_chain_ridge(const mct_chain_constants *self, mct_real size)
{
    const mct_real from_error = size * (MCT_R(0.5) * size + MCT_R(1e-3) * self->reach);
    return self->method == MCT_CHAIN_INVERSE ? 0 : self->ridge > 0 ? self->ridge : from_error;
}

/* Brings all changes within the bound, all alike: their direction stays. */
static inline void mct_chain_limit(int32_t n, mct_real bound, mct_real *step)
{
    mct_real largest = 0;
    for (int32_t k = 0; k < n; k++) {
        const mct_real turn = step[k] < 0 ? -step[k] : step[k];
        largest = turn > largest ? turn : largest;
    }
    if (largest > bound) {
        const mct_real share = bound / largest;
        for (int32_t k = 0; k < n; k++) {
            step[k] = mct_clamp(share * step[k], bound);
        }
    }
}

/** Change of the angles in one update [rad], each within +-largest_step; n. Finite for finite angles. */
static inline void mct_chain_step(const mct_chain_constants *self, const mct_chain_pose *pose, mct_real *step)
{
    const int32_t n = self->links;
    const mct_real square = mct_chain_error_squared(pose);
    const mct_real rounding = MCT_REAL_EPSILON * self->reach;
    if (square <= rounding * rounding) {
        for (int32_t k = 0; k < n; k++) {
            step[k] = 0;
        }
        return;
    }
    const mct_real inverse = mct_inverse_root(square);
    const mct_real size = square * inverse;
    const mct_real along[2] = {pose->error[0] * inverse, pose->error[1] * inverse};
    mct_real g[MCT_CHAIN_MAX_LINKS]; /* how far a turn of joint k takes the tip along the error [m] */
    mct_real h[MCT_CHAIN_MAX_LINKS]; /* and across it */
    mct_real gg = 0;
    mct_real gh = 0;
    mct_real hh = 0;
    for (int32_t k = 0; k < n; k++) {
        g[k] = along[1] * pose->arm[k][0] - along[0] * pose->arm[k][1];
        h[k] = along[0] * pose->arm[k][0] + along[1] * pose->arm[k][1];
        gg += g[k] * g[k];
        gh += g[k] * h[k];
        hh += h[k] * h[k];
    }
    if (gg <= MCT_R(1e-12) * hh && !mct_chain_converged(self, pose)) { /* all in line with the aim */
        for (int32_t k = 0; k < n; k++) {
            step[k] = MCT_CHAIN_BEND;
        }
    } else if (self->method == MCT_CHAIN_TRANSPOSE) {
        const mct_real best = gg > 0 ? 1 / (gg + gh * (gh / gg)) : 0;
        const mct_real gain = self->gain > 0 ? self->gain : best;
        for (int32_t k = 0; k < n; k++) {
            step[k] = gain * size * g[k];
        }
    } else {
        mct_chain_least_squares(n, g, h, gg, gh, hh, size, mct_chain_ridge(self, size), step);
    }
    mct_chain_limit(n, self->largest_step, step);
}

/** One update: what a kernel adds to the angles in a step. n sines and cosines, some 25 n multiplications. */
static inline void mct_chain_update(const mct_chain_constants *self, const mct_real *angles, mct_real *step)
{
    mct_chain_pose pose;
    mct_chain_place(self, angles, &pose);
    mct_chain_step(self, &pose, step);
}

#endif

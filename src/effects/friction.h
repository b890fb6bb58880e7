/*
 * Dry (Coulomb) friction on two coordinates: Moreau's impulse clamp.
 *
 * Rule         of all friction impulses p with |p_i| <= bound_i, take the one that minimises the kinetic
 *              energy after the step, 1/2 p'W p + v'p, with W = M^-1 and v the velocity that the step would
 *              end with. A coordinate then either rests (v_i + (W p)_i = 0) or slides against the full bound:
 *              sticking is exact, nothing creeps.
 * Solution     exact and bounded: the minimum lies inside the box or on one of its four sides.
 * Source       the source document has no dry friction but in 8.2; the scheme is Moreau's time stepping.
 * Accuracy     first order where a coordinate starts or stops, second order while it slides or rests.
 */
#ifndef MCT_EFFECTS_FRICTION_H
#define MCT_EFFECTS_FRICTION_H

#include "mctau/real.h"
#include "mctau/symmetric2.h"

/* By the energies of the best impulse on each side of the box; few cases need it. */
void mct_friction_impulse_on_a_side(mct_symmetric2 W, const mct_real *v, const mct_real *bound, mct_real *p);

/*
 * v: velocity without friction; bound: largest impulse; p: impulse (out). The conditions of the minimum tell the usual
 * cases: both rest, both slide on as they did, or one rests; it then takes part in the other's inertia, so that the sign
 * of what would stop both is against the other's motion.
 */
static inline void mct_friction_impulse(mct_inertia2 inertia, const mct_real *v, const mct_real *bound,
                                        mct_real *p)
{
    const mct_symmetric2 M = inertia.mass;
    const mct_symmetric2 W = inertia.inverse;
    const mct_real against[2] = {v[0] > 0 ? -bound[0] : bound[0], v[1] > 0 ? -bound[1] : bound[1]};
    const mct_real after[2] = {v[0] + W.a11 * against[0] + W.a12 * against[1],
                               v[1] + W.a12 * against[0] + W.a22 * against[1]};
    p[0] = against[0];
    p[1] = against[1];
    if (after[0] * v[0] > 0 && after[1] * v[1] > 0) {
        return;
    }
    const mct_real rest[2] = {-(M.a11 * v[0] + M.a12 * v[1]), -(M.a12 * v[0] + M.a22 * v[1])};
    const bool is_within[2] = {rest[0] >= -bound[0] && rest[0] <= bound[0],
                               rest[1] >= -bound[1] && rest[1] <= bound[1]};
    if (is_within[0] && is_within[1]) {
        p[0] = rest[0];
        p[1] = rest[1];
        return;
    }
    for (int i = 0; i < 2; i++) { /* i slides */
        if (!is_within[i]) {
            const int j = 1 - i;
            const mct_real own = i == 0 ? W.a22 : W.a11;
            p[i] = rest[i] > 0 ? bound[i] : -bound[i];
            p[j] = -(v[j] + W.a12 * p[i]) / own;
            if (p[j] >= -bound[j] && p[j] <= bound[j]) {
                return;
            }
        }
    }
    mct_friction_impulse_on_a_side(W, v, bound, p);
}

/*
 * With static friction: bound is that of a coordinate at rest, `slide` the dynamic one. What the first cannot hold
 * slides and has the second, under which the other may come to rest or go, too. bound: the one that holds (out).
 */
static inline void mct_friction_impulse_from(mct_inertia2 inertia, const mct_real *v, const mct_real *slide,
                                             mct_real *bound, mct_real *p)
{
    for (int pass = 0; pass < 3; pass++) {
        bool is_done = true;
        mct_friction_impulse(inertia, v, bound, p);
        for (int i = 0; i < 2; i++) {
            if (bound[i] > slide[i] && (p[i] >= bound[i] || p[i] <= -bound[i])) {
                bound[i] = slide[i];
                is_done = false;
            }
        }
        if (is_done) {
            return;
        }
    }
}

/*
 * Friction forces at one instant: full size against a motion, and at rest what keeps a coordinate at rest, if
 * it can. slide, hold: dynamic and static friction; v: rates; f: all other forces, C v included; dry: friction (out).
 */
static inline void mct_friction_force(mct_inertia2 inertia, const mct_real *slide, const mct_real *hold,
                                      const mct_real *v, const mct_real *f, mct_real *dry)
{
    mct_real moving[2], least[2], bound[2];
    for (int i = 0; i < 2; i++) {
        moving[i] = v[i] > 0 ? -slide[i] : v[i] < 0 ? slide[i] : 0;
        least[i] = v[i] == 0 ? slide[i] : 0;
        bound[i] = v[i] == 0 ? hold[i] : 0;
    }
    const mct_real g[2] = {f[0] + moving[0], f[1] + moving[1]};
    const mct_symmetric2 W = inertia.inverse;
    const mct_real acceleration[2] = {W.a11 * g[0] + W.a12 * g[1], W.a12 * g[0] + W.a22 * g[1]};
    mct_friction_impulse_from(inertia, acceleration, least, bound, dry);
    dry[0] += moving[0];
    dry[1] += moving[1];
}

/*
 * Corrects the increments dx = (dq, dv) of a step from velocities v, of length h, for dry friction of the
 * given forces, in motion and at rest. A coordinate that comes to rest gets exactly the velocity 0, and travels h/2
 * times the velocity it had.
 */
static inline void mct_friction_correct(mct_inertia2 inertia, const mct_real *slide, const mct_real *hold,
                                        mct_real h, const mct_real *v, mct_real *dx)
{
    const mct_real free_velocity[2] = {v[0] + dx[2], v[1] + dx[3]};
    const mct_real least[2] = {h * slide[0], h * slide[1]};
    mct_real bound[2] = {v[0] == 0 ? h * hold[0] : least[0], v[1] == 0 ? h * hold[1] : least[1]};
    mct_real p[2];
    mct_friction_impulse_from(inertia, free_velocity, least, bound, p);
    const mct_symmetric2 W = inertia.inverse;
    const mct_real change[2] = {W.a11 * p[0] + W.a12 * p[1], W.a12 * p[0] + W.a22 * p[1]};
    for (int i = 0; i < 2; i++) {
        if (p[i] > -bound[i] && p[i] < bound[i]) {
            dx[2 + i] = -v[i];
            dx[i] = MCT_R(0.5) * h * v[i];
        } else {
            dx[2 + i] += change[i];
            dx[i] += MCT_R(0.5) * h * change[i];
        }
    }
}

#endif

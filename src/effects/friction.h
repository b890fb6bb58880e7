/*
 * Dry (Coulomb) friction on two coordinates: Moreau's impulse clamp.
 *
 * Rule         of all friction impulses p with |p_i| <= bound_i, take the one that minimises the kinetic
 *              energy after the step, 1/2 p'W p + v'p, with W = M^-1 and v the velocity that the step would
 *              end with. A coordinate then either rests (v_i + (W p)_i = 0) or slides against the full bound:
 *              sticking is exact, nothing creeps.
 * Solution     exact and bounded: the minimum lies inside the box or on one of its four sides. Its conditions tell most
 *              cases without a search; the rest is friction.c.
 * Source       the source document has no dry friction but in 8.2; the scheme is Moreau's time stepping.
 * Accuracy     first order where a coordinate starts or stops, second order while it slides or rests.
 */
#ifndef MCT_EFFECTS_FRICTION_H
#define MCT_EFFECTS_FRICTION_H

#include <stdbool.h>

#include "mctau/real.h"
#include "mctau/symmetric2.h"

/* v: velocity without friction; bound: largest impulse; p: impulse (out). */
void mct_friction_impulse(const mct_inertia2 *inertia, const mct_real *v, const mct_real *bound, mct_real *p);

/*
 * Friction forces at one instant: full size against a motion, and at rest what keeps a coordinate at rest, if
 * it can. slide, hold: dynamic and static friction; v: rates; f: all other forces, C v included; dry: friction (out).
 */
void mct_friction_force(const mct_inertia2 *inertia, const mct_real *slide, const mct_real *hold,
                        const mct_real *v, const mct_real *f, mct_real *dry);

/* mct_friction_correct in any case. */
void mct_friction_correct_any(const mct_inertia2 *inertia, const mct_real *slide, const mct_real *hold,
                              mct_real h, const mct_real *v, mct_real *dx);

/* A change of velocity i, and half of it along the way. */
MCT_INLINE void mct_friction_change(int i, mct_real h, mct_real change, mct_real *dx)
{
    dx[2 + i] += change;
    dx[i] += MCT_R(0.5) * h * change;
}

/*
 * Corrects increments where i slides on and j, which is at rest, stays; false, and nothing done, where it is not so. Then i
 * moves alone, M_ii dv_i = (M dv)_i + p_i, which needs no inverse of M: the division waits for nothing.
 */
MCT_INLINE bool mct_friction_one_slides(mct_symmetric2 M, int i, const mct_real *slide, const mct_real *hold,
                                        mct_real h, const mct_real *v, mct_real *dx)
{
    const int j = 1 - i;
    const mct_real inverse = 1 / (i == 0 ? M.a11 : M.a22);
    const mct_real p = h * (v[i] > 0 ? -slide[i] : slide[i]);
    const mct_real ratio = inverse * M.a12;
    const mct_real own = inverse * p;
    const mct_real pull = dx[2 + j];
    const mct_real half = MCT_R(0.5) * h;
    const mct_real dv = (dx[2 + i] + own) + ratio * pull;
    const mct_real holds = M.a12 * (ratio * pull + own) - (i == 0 ? M.a22 : M.a11) * pull;
    const mct_real bound = h * hold[j];
    if (v[i] * (v[i] + dv) > 0 && holds > -bound && holds < bound) {
        dx[i] = (dx[i] + half * own) + (half * ratio) * pull;
        dx[2 + i] = dv;
        dx[j] = 0;
        dx[2 + j] = 0;
        return true;
    }
    return false;
}

/*
 * Corrects the increments dx = (dq, dv) of a step from velocities v, of length h, for dry friction of the
 * given forces, in motion and at rest. A coordinate that comes to rest gets exactly the velocity 0, and travels h/2
 * times the velocity it had. What slides mostly goes on, and what rests stays: this is tried first, for a case that meets
 * the conditions of the minimum is the only one.
 */
MCT_INLINE void mct_friction_correct(mct_inertia2 inertia, const mct_real *slide, const mct_real *hold,
                                     mct_real h, const mct_real *v, mct_real *dx)
{
    const mct_symmetric2 W = inertia.inverse;
    bool is_done = false;
    if (v[0] == 0) {
        is_done = v[1] != 0 && mct_friction_one_slides(inertia.mass, 1, slide, hold, h, v, dx);
    } else if (v[1] == 0) {
        is_done = mct_friction_one_slides(inertia.mass, 0, slide, hold, h, v, dx);
    } else {
        const mct_real p[2] = {h * (v[0] > 0 ? -slide[0] : slide[0]), h * (v[1] > 0 ? -slide[1] : slide[1])};
        const mct_real change[2] = {W.a11 * p[0] + W.a12 * p[1], W.a12 * p[0] + W.a22 * p[1]};
        is_done = v[0] * (v[0] + dx[2] + change[0]) > 0 && v[1] * (v[1] + dx[3] + change[1]) > 0;
        if (is_done) {
            mct_friction_change(0, h, change[0], dx);
            mct_friction_change(1, h, change[1], dx);
        }
    }
    if (!is_done) { /* by copies: what is handed on by its address does not stay in registers */
        const mct_inertia2 matrices = inertia;
        const mct_real rates[2] = {v[0], v[1]};
        mct_real changes[4] = {dx[0], dx[1], dx[2], dx[3]};
        mct_friction_correct_any(&matrices, slide, hold, h, rates, changes);
        for (int i = 0; i < 4; i++) {
            dx[i] = changes[i];
        }
    }
}

#endif

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

/* v: velocity without friction; bound: largest impulse; p: impulse (out). */
static inline void mct_friction_impulse(mct_inertia2 inertia, const mct_real *v, const mct_real *bound,
                                        mct_real *p)
{
    const mct_symmetric2 M = inertia.mass;
    const mct_symmetric2 W = inertia.inverse;
    const mct_real rest1 = -(M.a11 * v[0] + M.a12 * v[1]);
    const mct_real rest2 = -(M.a12 * v[0] + M.a22 * v[1]);
    if (rest1 >= -bound[0] && rest1 <= bound[0] && rest2 >= -bound[1] && rest2 <= bound[1]) {
        p[0] = rest1;
        p[1] = rest2;
        return;
    }
    const mct_real side[4][2] = {
        {bound[0], mct_clamp(-(v[1] + W.a12 * bound[0]) / W.a22, bound[1])},
        {-bound[0], mct_clamp(-(v[1] - W.a12 * bound[0]) / W.a22, bound[1])},
        {mct_clamp(-(v[0] + W.a12 * bound[1]) / W.a11, bound[0]), bound[1]},
        {mct_clamp(-(v[0] - W.a12 * bound[1]) / W.a11, bound[0]), -bound[1]},
    };
    mct_real least = 0;
    for (int k = 0; k < 4; k++) {
        const mct_real a = side[k][0];
        const mct_real b = side[k][1];
        const mct_real energy =
            MCT_R(0.5) * (W.a11 * a * a + W.a22 * b * b) + W.a12 * a * b + v[0] * a + v[1] * b;
        if (k == 0 || energy < least) {
            least = energy;
            p[0] = a;
            p[1] = b;
        }
    }
}

/*
 * Friction forces at one instant: full size against a motion, and at rest what keeps a coordinate at rest, if
 * it can. size: of the friction; v: rates; f: all other forces, C v included; dry: friction (out).
 */
static inline void mct_friction_force(mct_inertia2 inertia, const mct_real *size, const mct_real *v,
                                      const mct_real *f, mct_real *dry)
{
    mct_real moving[2];
    mct_real bound[2];
    for (int i = 0; i < 2; i++) {
        moving[i] = v[i] > 0 ? -size[i] : v[i] < 0 ? size[i] : 0;
        bound[i] = v[i] == 0 ? size[i] : 0;
    }
    const mct_real g[2] = {f[0] + moving[0], f[1] + moving[1]};
    const mct_symmetric2 W = inertia.inverse;
    const mct_real acceleration[2] = {W.a11 * g[0] + W.a12 * g[1], W.a12 * g[0] + W.a22 * g[1]};
    mct_friction_impulse(inertia, acceleration, bound, dry);
    dry[0] += moving[0];
    dry[1] += moving[1];
}

/*
 * Corrects the increments dx = (dq, dv) of a step from velocities v, of length h, for dry friction of the
 * given forces. A coordinate that comes to rest gets exactly the velocity 0, and travels h/2 times the
 * velocity it had.
 */
static inline void mct_friction_correct(mct_inertia2 inertia, const mct_real *force, mct_real h,
                                        const mct_real *v, mct_real *dx)
{
    const mct_real free_velocity[2] = {v[0] + dx[2], v[1] + dx[3]};
    const mct_real bound[2] = {h * force[0], h * force[1]};
    mct_real p[2];
    mct_friction_impulse(inertia, free_velocity, bound, p);
    const mct_symmetric2 W = inertia.inverse;
    const mct_real change[2] = {W.a11 * p[0] + W.a12 * p[1], W.a12 * p[0] + W.a22 * p[1]};
    for (int i = 0; i < 2; i++) {
        const bool rests = force[i] > 0 && p[i] > -bound[i] && p[i] < bound[i];
        if (rests) {
            dx[2 + i] = -v[i];
            dx[i] = MCT_R(0.5) * h * v[i];
        } else {
            dx[2 + i] += change[i];
            dx[i] += MCT_R(0.5) * h * change[i];
        }
    }
}

#endif

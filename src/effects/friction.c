#include "friction.h"

/* By the energies of the best impulse on each side of the box. */
static void search_sides(mct_symmetric2 W, const mct_real *v, const mct_real *bound, mct_real *p)
{
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

void mct_friction_impulse(const mct_inertia2 *inertia, const mct_real *v, const mct_real *bound, mct_real *p)
{
    const mct_symmetric2 M = inertia->mass;
    const mct_real rest[2] = {-(M.a11 * v[0] + M.a12 * v[1]), -(M.a12 * v[0] + M.a22 * v[1])};
    if (rest[0] >= -bound[0] && rest[0] <= bound[0] && rest[1] >= -bound[1] && rest[1] <= bound[1]) {
        p[0] = rest[0];
        p[1] = rest[1];
    } else {
        search_sides(inertia->inverse, v, bound, p);
    }
}

/*
 * With static friction as well: bound is that of a coordinate at rest, `slide` the dynamic one. What the first cannot hold
 * slides and has the second, under which the other may come to rest or go, too. bound: the one that holds (out).
 */
static void static_impulse(const mct_inertia2 *inertia, const mct_real *v, const mct_real *slide,
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

void mct_friction_force(const mct_inertia2 *inertia, const mct_real *slide, const mct_real *hold,
                        const mct_real *v, const mct_real *f, mct_real *dry)
{
    mct_real moving[2], least[2], bound[2];
    for (int i = 0; i < 2; i++) {
        moving[i] = v[i] > 0 ? -slide[i] : v[i] < 0 ? slide[i] : 0;
        least[i] = v[i] == 0 ? slide[i] : 0;
        bound[i] = v[i] == 0 ? hold[i] : 0;
    }
    const mct_real g[2] = {f[0] + moving[0], f[1] + moving[1]};
    const mct_symmetric2 W = inertia->inverse;
    const mct_real acceleration[2] = {W.a11 * g[0] + W.a12 * g[1], W.a12 * g[0] + W.a22 * g[1]};
    static_impulse(inertia, acceleration, least, bound, dry);
    dry[0] += moving[0];
    dry[1] += moving[1];
}

void mct_friction_correct_any(const mct_inertia2 *inertia, const mct_real *slide, const mct_real *hold,
                              mct_real h, const mct_real *v, mct_real *dx)
{
    const mct_real free_velocity[2] = {v[0] + dx[2], v[1] + dx[3]};
    const mct_real least[2] = {h * slide[0], h * slide[1]};
    mct_real bound[2] = {v[0] == 0 ? h * hold[0] : least[0], v[1] == 0 ? h * hold[1] : least[1]};
    mct_real p[2];
    static_impulse(inertia, free_velocity, least, bound, p);
    const mct_symmetric2 W = inertia->inverse;
    const mct_real change[2] = {W.a11 * p[0] + W.a12 * p[1], W.a12 * p[0] + W.a22 * p[1]};
    for (int i = 0; i < 2; i++) {
        if (p[i] > -bound[i] && p[i] < bound[i]) {
            dx[2 + i] = -v[i];
            dx[i] = MCT_R(0.5) * h * v[i];
        } else {
            mct_friction_change(i, h, change[i], dx);
        }
    }
}

#include "friction.h"

void mct_friction_impulse_on_a_side(mct_symmetric2 W, const mct_real *v, const mct_real *bound, mct_real *p)
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

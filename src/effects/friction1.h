/*
 * Dry (Coulomb) friction on one coordinate: Moreau's impulse clamp. The rule, its source and its accuracy are those of
 * friction.h; with one coordinate the least energy is reached by a clamp alone.
 */
#ifndef MCT_EFFECTS_FRICTION1_H
#define MCT_EFFECTS_FRICTION1_H

#include "mctau/real.h"

/*
 * Corrects the increments dx = (dq, dv) of a step of length h from the velocity v for dry friction of the given
 * force; `hold` is the static one, of what starts at rest. What comes to rest gets exactly the velocity 0 and travels
 * h/2 times the velocity it had.
 */
MCT_INLINE void mct_friction1_correct(mct_real inertia, mct_real inverse_inertia, mct_real force,
                                      mct_real hold, mct_real h, mct_real v, mct_real *dx)
{
    const mct_real bound = h * force;
    const mct_real bears = v == 0 ? h * hold : bound;
    const mct_real stop = -inertia * (v + dx[1]);
    if (force > 0 && stop >= -bears && stop <= bears) {
        dx[1] = -v;
        dx[0] = MCT_R(0.5) * h * v;
    } else {
        const mct_real change = inverse_inertia * mct_clamp(stop, bound);
        dx[1] += change;
        dx[0] += MCT_R(0.5) * h * change;
    }
}

/* Friction at one instant: full size against a motion, and at rest what keeps it at rest, if it can. */
MCT_INLINE mct_real mct_friction1_force(mct_real size, mct_real hold, mct_real v, mct_real others)
{
    if (v == 0 && others >= -hold && others <= hold) {
        return -others;
    }
    return v > 0 || (v == 0 && others > 0) ? -size : size;
}

#endif

/*
 * A Runge-Kutta-Nystroem method of order 6 for forces that depend on position alone: five stages, no velocities in them.
 *
 * Source: J. Albrecht, Beitraege zum Runge-Kutta-Verfahren, ZAMM 35 (1955); Hairer, Norsett, Wanner, Solving ODEs I,
 *   II.14. Its order is measured in tests.
 */
#ifndef MCT_STEPPERS_RKN6_H
#define MCT_STEPPERS_RKN6_H

#include "advance.h"

/* `acceleration` writes that of the coordinates x[0..n-1], under input u. */
MCT_INLINE void mct_rkn6(mct_derivative acceleration, const void *self, mct_step step, unsigned effects,
                         int n, const mct_real *x, mct_real u, mct_real *dx)
{
    enum { STAGES = 5 };
    static const mct_real part[STAGES] = {0, MCT_R(0.25), MCT_R(0.5), MCT_R(0.75), 1};
    static const mct_real within[STAGES][STAGES - 1] = {
        {0},
        {MCT_R(1.0 / 32)},
        {MCT_R(-1.0 / 24), MCT_R(1.0 / 6)},
        {MCT_R(3.0 / 32), MCT_R(1.0 / 8), MCT_R(1.0 / 16)},
        {0, MCT_R(3.0 / 7), MCT_R(-1.0 / 14), MCT_R(1.0 / 7)}};
    static const mct_real to_position[STAGES] = {MCT_R(7.0 / 90), MCT_R(4.0 / 15), MCT_R(1.0 / 15),
                                                 MCT_R(4.0 / 45), 0};
    static const mct_real to_rate[STAGES] = {MCT_R(7.0 / 90), MCT_R(16.0 / 45), MCT_R(2.0 / 15),
                                             MCT_R(16.0 / 45), MCT_R(7.0 / 90)};
    const mct_real h = step.h;
    mct_real a[STAGES][MCT_MAX_COORDINATES];
    mct_real stage[MCT_MAX_COORDINATES];
    MCT_UNROLL
    for (int s = 0; s < STAGES; s++) {
        MCT_UNROLL
        for (int i = 0; i < n; i++) {
            mct_real bend = 0; /* the newest stage last: all wait for it */
            MCT_UNROLL
            for (int j = 0; j < s; j++) {
                bend += within[s][j] * a[j][i];
            }
            stage[i] = x[i] + h * (part[s] * x[n + i] + h * bend);
        }
        acceleration(self, effects, stage, u, a[s]);
    }
    MCT_UNROLL
    for (int i = 0; i < n; i++) {
        mct_real position = 0, rate = 0;
        MCT_UNROLL
        for (int s = 0; s < STAGES; s++) {
            position += to_position[s] * a[s][i];
            rate += to_rate[s] * a[s][i];
        }
        dx[i] = h * (x[n + i] + h * position);
        dx[n + i] = h * rate;
    }
}

#endif

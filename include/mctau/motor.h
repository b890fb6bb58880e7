/**
 * @file motor.h
 * Constants of a DC motor acting on one coordinate, precomputed for a step. The equations are in
 * src/effects/motor.h.
 */
#ifndef MCTAU_MOTOR_H
#define MCTAU_MOTOR_H

#include "mctau/real.h"
#include "mctau/status.h"

typedef struct {
    mct_real force_per_ampere;   /**< [N/A] or [N m/A], gears included */
    mct_real emf;                /**< back-emf per rate of the coordinate [V s/m] or [V s/rad] */
    mct_real resistance;         /**< [ohm] */
    mct_real inductance;         /**< [H] */
    mct_real conductance;        /**< 1 / resistance [S] */
    mct_real inverse_inductance; /**< [1/H] */
    mct_real force_per_volt;     /**< at rest, L = 0 [N/V] or [N m/V] */
    mct_real damping;            /**< of the back-emf, L = 0 [N s/m] or [N m s] */
    /* exact step of the current, for the step h of prepare */
    mct_real mean_from_current; /**< phi_1 */
    mct_real mean_from_voltage; /**< (h/L) phi_2 [S] */
    mct_real mean_from_change;  /**< (h/L) phi_3 [S] */
    mct_real end_from_current;  /**< e^-z - 1 */
    mct_real end_from_voltage;  /**< (h/L) phi_1 [S] */
} mct_motor;

/**
 * Precomputes a motor.
 * @param effects     MCT_MOTOR_... bits decide what is computed; the rest of the struct is zero
 * @param ratio       coordinate's rate -> motor's rate (gear ratio / pulley radius; 1 for a direct drive)
 * @param torque_constant [N m/A], back_emf_constant [V s/rad], resistance [ohm], inductance [H]
 * @param h           step [s]
 * @return MCT_OK, or MCT_ERROR_RANGE for R = 0 without inductance
 */
mct_status mct_motor_prepare(mct_motor *motor, uint32_t effects, double ratio, double torque_constant,
                             double back_emf_constant, double resistance, double inductance, double h);

#endif

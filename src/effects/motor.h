/*
 * DC motor on one coordinate with rate w.
 *
 * Equation     L di/dt = V - R i - emf w;  force = force_per_ampere i.   (source 2.5, eqs. 164-166)
 * Quasi-static L = 0: i = (V - emf w) / R, hence force = force_per_volt V - damping w.
 * Inductive    the current is a state. Over a step h in which w changes linearly by dw, with z = h R / L and
 *              phi_k the exponential functions of -z, the linear equation has the exact solution
 *                  mean i over the step = i0 phi_1 + (h/L) phi_2 (V - emf w0) - (h/L) phi_3 emf dw
 *                  i1 - i0              = i0 (e^-z - 1) + (h/L) phi_1 (V - emf w0) - (h/L) phi_2 emf dw
 *              so a stepper that advances velocities by impulses is stable for any L/R, R = 0 included.
 * Differences  from the source: gears and pulleys are folded into force_per_ampere and emf.
 * Units        SI; "force" is a torque where the coordinate is an angle.
 */
#ifndef MCT_EFFECTS_MOTOR_H
#define MCT_EFFECTS_MOTOR_H

#include "mctau/effects.h"
#include "mctau/motor.h"
#include "mctau/system.h"

/* Says which parameter makes mct_motor_prepare() fail. */
void mct_motor_refuse(double resistance, double inductance, struct mct_message *why);

/*
 * Force of the drive, but for the damping of a quasi-static motor, which joins the viscous one. `current` is
 * that of an inductive motor, or its mean over a step; not read otherwise.
 */
MCT_INLINE mct_real mct_motor_force(const mct_motor *motor, unsigned effects, mct_real u, mct_real current)
{
    if (effects & MCT_MOTOR_INDUCTIVE) {
        return motor->force_per_ampere * current;
    }
    return (effects & MCT_MOTOR_QUASI_STATIC) ? motor->force_per_volt * u : u;
}

/* Current after a step h of the implicit Euler method, at the old rate. */
MCT_INLINE mct_real mct_motor_implicit_current(const mct_motor *motor, mct_real h, mct_real voltage,
                                               mct_real rate, mct_real current)
{
    const mct_real gain = h * motor->inverse_inductance;
    return (current + gain * (voltage - motor->emf * rate)) / (1 + gain * motor->resistance);
}

/* Current when L = 0. */
MCT_INLINE mct_real mct_motor_quasi_static_current(const mct_motor *motor, mct_real voltage, mct_real rate)
{
    return (voltage - motor->emf * rate) * motor->conductance;
}

/* di/dt of an inductive motor. */
MCT_INLINE mct_real mct_motor_current_rate(const mct_motor *motor, mct_real voltage, mct_real rate,
                                           mct_real current)
{
    return (voltage - motor->resistance * current - motor->emf * rate) * motor->inverse_inductance;
}

/* Mean current over a step, but for the part - mean_from_rate_change * dw, which the caller solves for. */
MCT_INLINE mct_real mct_motor_mean_current(const mct_motor *motor, mct_real voltage, mct_real rate,
                                           mct_real current)
{
    return current * motor->mean_from_current + (voltage - motor->emf * rate) * motor->mean_from_voltage;
}

/* Change of current over a step in which the rate changes by rate_change. */
MCT_INLINE mct_real mct_motor_current_change(const mct_motor *motor, mct_real voltage, mct_real rate,
                                             mct_real current, mct_real rate_change)
{
    return current * motor->end_from_current + (voltage - motor->emf * rate) * motor->end_from_voltage -
           motor->emf * rate_change * motor->mean_from_voltage;
}

/* Force with the current eliminated (L = 0), for observers and estimates. */
MCT_INLINE mct_real mct_motor_observed_force(const mct_motor *motor, uint32_t effects, mct_real u,
                                             mct_real rate)
{
    return (effects & MCT_MOTOR) ? motor->force_per_volt * u - motor->damping * rate : u;
}

/*
 * Powers and energy of the motor, or of the plain force u, on a coordinate with this rate, at the current in
 * `out`.
 */
static inline void mct_motor_powers(const mct_motor *motor, uint32_t effects, mct_real u, mct_real rate,
                                    mct_evaluation *out)
{
    if (!(effects & MCT_MOTOR)) {
        out->power_input = u * rate;
        return;
    }
    const mct_real i = out->current;
    out->power_input = u * i;
    out->power[MCT_EFFECT_MOTOR] = motor->force_per_ampere * i * rate;
    out->power_resistance = -motor->resistance * i * i;
    out->power_conversion = (motor->force_per_ampere - motor->emf) * i * rate;
    if (effects & MCT_MOTOR_INDUCTIVE) {
        out->magnetic_energy = MCT_R(0.5) * motor->inductance * i * i;
    }
}

#endif

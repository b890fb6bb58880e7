#include "motor.h"

#include <string.h>

#include "mctau/matrix.h"
#include "mctau/message.h"

mct_status mct_motor_prepare(mct_motor *motor, uint32_t effects, double ratio, double torque_constant,
                             double back_emf_constant, double resistance, double inductance, double h)
{
    memset(motor, 0, sizeof *motor);
    if (!(effects & MCT_MOTOR)) {
        return MCT_OK;
    }
    const double force_per_ampere = ratio * torque_constant;
    const double emf = ratio * back_emf_constant;
    motor->force_per_ampere = (mct_real)force_per_ampere;
    motor->emf = (mct_real)emf;
    motor->resistance = (mct_real)resistance;
    motor->inductance = (mct_real)inductance;
    if (resistance > 0) {
        motor->conductance = (mct_real)(1 / resistance);
        motor->force_per_volt = (mct_real)(force_per_ampere / resistance);
        motor->damping = (mct_real)(force_per_ampere * emf / resistance);
    }
    if (effects & MCT_MOTOR_QUASI_STATIC) {
        return resistance > 0 ? MCT_OK : MCT_ERROR_RANGE;
    }
    /*
     * phi_1..phi_3 of -z stand in the first row of the exponential of this matrix, with no cancellation for
     * small z.
     */
    const double z = h * resistance / inductance;
    const double generator[16] = {-z, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0};
    double phi[16];
    const mct_status status = mct_expm1(4, generator, phi);
    motor->inverse_inductance = (mct_real)(1 / inductance);
    motor->mean_from_current = (mct_real)phi[1];
    motor->mean_from_voltage = (mct_real)(h / inductance * phi[2]);
    motor->mean_from_change = (mct_real)(h / inductance * phi[3]);
    motor->end_from_current = (mct_real)phi[0];
    motor->end_from_voltage = (mct_real)(h / inductance * phi[1]);
    return status;
}

void mct_motor_refuse(double resistance, double inductance, struct mct_message *why)
{
    if (resistance > 0) {
        mct_message_add(why, "parameters.inductance: found ");
        mct_message_add_number(why, inductance);
        mct_message_add(why, " H, with which the current settles within ");
        mct_message_add_number(why, inductance / resistance);
        mct_message_add(why, " s; allowed 0, or from 1e-18 of a step on");
    } else {
        mct_message_add(
            why, "parameters.resistance: found 0 ohm with a motor that has no inductance; allowed above 0");
    }
}

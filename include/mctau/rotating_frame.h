/**
 * @file rotating_frame.h
 * Constants of the rotating frame, precomputed by mct_rotating_frame.prepare. Equations in
 * src/systems/rotating_frame.c.
 */
#ifndef MCTAU_ROTATING_FRAME_H
#define MCTAU_ROTATING_FRAME_H

#include "mctau/real.h"
#include "mctau/step.h"

typedef struct {
    mct_step step;
    mct_real mass;                    /**< m [kg] */
    mct_real angular_velocity[3];     /**< of the frame at the start [rad/s] */
    mct_real angular_acceleration[3]; /**< of the frame at the start [rad/s^2] */
    mct_real force[3];                /**< in space axes, without the weight [N] */
    mct_real push[3];                 /**< force and weight by mass, in space axes [m/s^2] */
    mct_real gravity;                 /**< g [m/s^2], 0 when off */
    mct_real drag;                    /**< [N s^2/m^2], 0 when off */
    mct_real drag_by_mass;            /**< [1/m], 0 when off */
    bool is_pushed;                   /**< any force or weight */
    bool has_fixed_axis;              /**< both angular vectors along `axis`; then the next three hold */
    mct_real axis[3];                 /**< of length 1 */
    mct_real spin;                    /**< about the axis at the start [rad/s] */
    mct_real spin_rate;               /**< [rad/s^2] */
} mct_rotating_frame_constants;

#endif

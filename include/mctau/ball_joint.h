/**
 * @file ball_joint.h
 * Constants of the ball joint, precomputed by mct_ball_joint.prepare. Equations in src/systems/ball_joint.c.
 */
#ifndef MCTAU_BALL_JOINT_H
#define MCTAU_BALL_JOINT_H

#include "mctau/rotor.h"

typedef struct {
    mct_rotor rotor;
    mct_real first_moment[3]; /**< sum m b, in principal axes [kg m] */
    mct_real gravity[3];      /**< in space axes [m/s^2] */
} mct_ball_joint_constants;

#endif

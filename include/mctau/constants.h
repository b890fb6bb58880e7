/**
 * @file constants.h
 * Room for the constants of any system: what prepare writes and kernels read.
 */
#ifndef MCTAU_CONSTANTS_H
#define MCTAU_CONSTANTS_H

#include "mctau/cart_pole.h"
#include "mctau/pendulum.h"
#include "mctau/reaction_wheel.h"

typedef union {
    mct_cart_pole_constants cart_pole;
    mct_reaction_wheel_constants reaction_wheel;
    mct_pendulum_constants pendulum;
} mct_constants;

#endif

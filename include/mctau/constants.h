/**
 * @file constants.h
 * Room for the constants of any system: what prepare writes and kernels read.
 */
#ifndef MCTAU_CONSTANTS_H
#define MCTAU_CONSTANTS_H

#include "mctau/ball_joint.h"
#include "mctau/block.h"
#include "mctau/cart_pole.h"
#include "mctau/chain.h"
#include "mctau/falling_sphere.h"
#include "mctau/hinge.h"
#include "mctau/linked_particles.h"
#include "mctau/moving_base.h"
#include "mctau/pendulum.h"
#include "mctau/reaction_wheel.h"
#include "mctau/rigid_body.h"
#include "mctau/rotating_frame.h"
#include "mctau/solid_pendulum.h"
#include "mctau/spring_pendulum.h"

/** Length of mct_constants, as the words that `mctau compile` writes. */
#define MCT_CONSTANTS_WORDS (MCT_REAL_IS_FLOAT ? 200 : 400)

typedef union {
    mct_cart_pole_constants cart_pole;
    mct_reaction_wheel_constants reaction_wheel;
    mct_pendulum_constants pendulum;
    mct_hinged_particles hinged_particles;
    mct_moving_base_constants moving_base;
    mct_spring_pendulum_constants spring_pendulum;
    mct_rotating_frame_constants rotating_frame;
    mct_ball_joint_constants ball_joint;
    mct_solid_pendulum_constants solid_pendulum;
    mct_rigid_body_constants rigid_body;
    mct_chain_constants chain;
    mct_block_constants block;
    mct_linked_particles_constants linked_particles;
    mct_falling_sphere_constants falling_sphere;
    uint32_t words[MCT_CONSTANTS_WORDS];
} mct_constants;

#endif

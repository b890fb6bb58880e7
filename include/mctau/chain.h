/**
 * @file chain.h
 * Constants of the kinematic chain. Equations in src/systems/chain_kinematics.h.
 */
#ifndef MCTAU_CHAIN_H
#define MCTAU_CHAIN_H

#include "mctau/real.h"

#define MCT_CHAIN_MAX_LINKS 16

/** How an update finds the angles' change. */
typedef enum {
    MCT_CHAIN_TRANSPOSE, /**< (422): down the gradient */
    MCT_CHAIN_INVERSE,   /**< (426): Gauss-Newton, by the pseudo-inverse */
    MCT_CHAIN_RIDGE      /**< (430): damped least squares */
} mct_chain_method;

typedef struct {
    int32_t links; /**< n, 1 to MCT_CHAIN_MAX_LINKS */
    mct_chain_method method;
    mct_real length[MCT_CHAIN_MAX_LINKS]; /**< l [m], each above 0 */
    mct_real target[2];                   /**< d [m] */
    mct_real gain;                        /**< kappa of transpose [1/m^2]; 0: the best one of each update */
    mct_real ridge;                       /**< alpha of ridge [m^2]; 0: from the error */
    mct_real largest_step;                /**< of an angle in an update [rad], above 0 */
    /* from the above, by mct_chain_complete() */
    mct_real reach;  /**< sum of the lengths: how far the tip gets from the base [m] */
    mct_real inner;  /**< how near: the excess of one link over all others, else 0 [m] */
    mct_real aim[2]; /**< the point within reach that is nearest to the target [m] */
} mct_chain_constants;

#endif

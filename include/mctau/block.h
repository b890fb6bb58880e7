/**
 * @file block.h
 * Constants of the block, precomputed by mct_block.prepare. Equations in src/systems/block.c.
 */
#ifndef MCTAU_BLOCK_H
#define MCTAU_BLOCK_H

#include "mctau/real.h"
#include "mctau/step.h"

#define MCT_BLOCK_ORDER 17 /**< largest order of the series of a step: 1/18! is beyond double */

typedef struct {
    mct_step step;
    mct_real mass;             /**< m [kg] */
    mct_real inverse_mass;     /**< [1/kg] */
    mct_real step_over_mass;   /**< h / m [s/kg] */
    mct_real sine, cosine;     /**< of the slope */
    mct_real weight;           /**< m g [N], 0 when off */
    mct_real weight_along;     /**< - m g sin a [N], 0 when off */
    mct_real static_friction;  /**< mu_s m g cos a [N], 0 when off */
    mct_real dynamic_friction; /**< mu_d m g cos a [N], 0 when off */
    mct_real rest_speed;       /**< a speed relative to the belt that is rounding [m/s], 0 without a belt */
    mct_real belt_speed;       /**< [m/s] */
    mct_real spring;           /**< k [N/m], 0 when off */
    mct_real force;            /**< [N] */
    mct_real ramp;             /**< [N/s] */
    mct_real amplitude;        /**< [N] */
    mct_real frequency;        /**< [rad/s] */
    mct_real phase_step;       /**< the sine's turn in a step [rad]; what rounding leaves out of it */
    mct_real phase_rest;
    mct_real step_rest; /**< what rounding leaves out of the step [s] */
    int32_t order;      /**< of the series of a step */
} mct_block_constants;

#endif

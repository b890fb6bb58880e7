/**
 * @file stepper.h
 * The menu of steppers. Each returns increments; kernels add them to a compensated state.
 */
#ifndef MCTAU_STEPPER_H
#define MCTAU_STEPPER_H

#include "mctau/real.h"

enum {
    MCT_STEPPER_SEED,
    MCT_STEPPER_EULER,
    MCT_STEPPER_LEAP,
    MCT_STEPPER_RK4,
    MCT_STEPPER_TAYLOR4,
    MCT_STEPPER_TAYLOR6,
    MCT_STEPPER_TAYLOR8,
    MCT_STEPPER_TAYLOR12,
    MCT_STEPPER_EXPO,
    MCT_STEPPER_EXPO8,
    MCT_STEPPER_RKN6,
    MCT_STEPPER_SPLIT3,
    MCT_STEPPER_DISCRETE,
    MCT_STEPPER_COUNT
};

typedef struct {
    const char *name;
    int order;       /**< global order of convergence on a smooth scene under a held input */
    const char *doc; /**< scheme, role, cost */
    /** Largest h R/L at which the scheme follows an inductive motor; 0 when any will do. */
    double motor_stability_limit;
    bool
        needs_smooth; /**< no kernel where an effect has a kink: coulomb by Moreau, drag without exact coulomb */
    bool is_special; /**< for scenes that name it: never chosen for one that leaves its stepper out */
} mct_stepper;

/** All steppers, by the enumeration above. */
extern const mct_stepper mct_steppers[MCT_STEPPER_COUNT];

#endif

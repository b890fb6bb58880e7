/*
 * Instantiates the kernels of a system: one for every stepper that it lists and every kernel mask.
 *
 * The including file defines `constants_t` and `friction`, the correction for dry friction. In a stepper's
 * expressions `k` are the constants, `effects` the literal mask, x, u, dx as in mct_derivative; `remainder` is
 * that of mct_advance.
 */
#ifndef MCT_SYSTEMS_KERNELS_H
#define MCT_SYSTEMS_KERNELS_H

#include "../steppers/advance.h"
#include "mctau/stepper.h"

#define MCT_STEPPER_KERNELS(stepper, remainder, expression)                                          \
    MCT_INLINE void stepper##_increments(const void *constants, unsigned effects, const mct_real *x, \
                                         mct_real u, mct_real *dx)                                   \
    {                                                                                                \
        const constants_t *k = constants;                                                            \
        expression;                                                                                  \
    }                                                                                                \
    MCT_KERNELS_WITH_MOTOR(stepper, remainder, 0)                                                    \
    MCT_KERNELS_WITH_MOTOR(stepper, remainder, 8)                                                    \
    MCT_KERNELS_WITH_MOTOR(stepper, remainder, 16)                                                   \
    static const mct_kernel stepper##_kernels[MCT_KERNEL_MASKS] = {                                  \
        MCT_KERNEL_NAMES(stepper, 0), MCT_KERNEL_NAMES(stepper, 8), MCT_KERNEL_NAMES(stepper, 16)};

/* The eight sets of gravity, viscous and coulomb with one kind of motor: MCT_MOTOR's bits as a literal. */
#define MCT_KERNELS_WITH_MOTOR(stepper, remainder, motor) \
    MCT_KERNEL(stepper, remainder, motor, 0)              \
    MCT_KERNEL(stepper, remainder, motor, 1)              \
    MCT_KERNEL(stepper, remainder, motor, 2)              \
    MCT_KERNEL(stepper, remainder, motor, 3)              \
    MCT_KERNEL(stepper, remainder, motor, 4)              \
    MCT_KERNEL(stepper, remainder, motor, 5)              \
    MCT_KERNEL(stepper, remainder, motor, 6)              \
    MCT_KERNEL(stepper, remainder, motor, 7)

#define MCT_KERNEL_NAMES(stepper, motor)                                                        \
    stepper##_##motor##_0, stepper##_##motor##_1, stepper##_##motor##_2, stepper##_##motor##_3, \
        stepper##_##motor##_4, stepper##_##motor##_5, stepper##_##motor##_6, stepper##_##motor##_7

#define MCT_KERNEL(stepper, remainder, motor, others)                                                      \
    static void stepper##_##motor##_##others(const void *constants, mct_state *state, mct_real u,          \
                                             int32_t steps)                                                \
    {                                                                                                      \
        const constants_t *k = constants;                                                                  \
        mct_advance(stepper##_increments, friction, k, remainder, (motor) + (others), MCT_MAX_ENCODERS, \
                    state, u, steps);                                                                      \
    }

/* The kernel of a stepper for an effect set; NULL where the stepper does not suit the system. */
static inline mct_kernel mct_kernel_of(const mct_kernel *const *kernels, int stepper, uint32_t effects)
{
    const mct_kernel *row = kernels[stepper];
    return row == NULL ? NULL : row[effects & MCT_KERNEL_EFFECTS];
}

#endif

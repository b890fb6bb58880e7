/*
 * Instantiates the kernels of a system: one for every stepper that it lists and every kernel mask.
 *
 * The including file defines MCT_SYSTEM, its name, ahead of this one, `constants_t`, and `friction`, the correction for
 * dry friction. In a stepper's expressions `k` are the constants, `effects` the literal mask, x, u, dx as in
 * mct_derivative; `remainder` is that of mct_advance.
 */
#ifndef MCT_SYSTEMS_KERNELS_H
#define MCT_SYSTEMS_KERNELS_H

#include "../steppers/advance.h"
#include "mctau/stepper.h"
#include "systems.h"

/* mct_SYSTEM_what, of the including file's system */
#define MCT_OF_SYSTEM(what)         MCT_JOINED(MCT_SYSTEM, what)
#define MCT_JOINED(...)             MCT_JOINED_AS(__VA_ARGS__)
#define MCT_JOINED_AS(system, what) mct_##system##_##what

/* A kernel is found from outside by its name, mct_SYSTEM_STEPPER_SET; tables have it with its name. */
#define MCT_KERNEL_NAME(stepper, set)  MCT_OF_SYSTEM(stepper##_##set)
#define MCT_KERNEL_ENTRY(stepper, set) MCT_NAMED_KERNEL(MCT_KERNEL_NAME(stepper, set))

/* Bits of the mask of all kernels, defined by the including file. */
#ifndef MCT_ALWAYS
#define MCT_ALWAYS 0
#endif

/* n: the system's coordinates. */
#define MCT_KERNEL(stepper, remainder, n, set, mask) \
    MCT_KERNEL_AS(MCT_KERNEL_NAME(stepper, set), stepper, remainder, n, mask)
#define MCT_KERNEL_AS(name, stepper, remainder, n, mask)                                                    \
    void name(const void *constants, mct_state *state, mct_real u, int32_t steps);                          \
    void name(const void *constants, mct_state *state, mct_real u, int32_t steps)                           \
    {                                                                                                       \
        const constants_t *k = constants;                                                                   \
        mct_advance(stepper##_increments, friction, k, remainder, (mask) | MCT_ALWAYS, n, state, u, steps); \
    }

#define MCT_INCREMENTS(stepper, expression)                                                          \
    MCT_INLINE void stepper##_increments(const void *constants, unsigned effects, const mct_real *x, \
                                         mct_real u, mct_real *dx)                                   \
    {                                                                                                \
        const constants_t *k = constants;                                                            \
        (void)effects;                                                                               \
        (void)u;                                                                                     \
        expression;                                                                                  \
    }

/* Place `index` of a stepper's table; NULL where there is no table, or the place is empty. */
static inline const mct_named_kernel *mct_kernel_at(const mct_named_kernel *row, uint32_t index)
{
    return row == NULL || row[index].function == NULL ? NULL : &row[index];
}

/* --- A system with a motor --- */

/* Its tables have 24 places for each kind of motor, in fours of neither, gravity, viscous friction and both: without more;
 * with dry friction by Moreau, with it exact; then the same three with drag. */
#define MCT_MOTOR_KERNELS (3 * 24)

/* Sets of a stepper beside its motor, by their masks in digits, which names are made of; `none` of the others. */
#define MCT_SMOOTH_SETS(each, none, ...) each(__VA_ARGS__, 0, 1, 2, 3) none none none none none
#define MCT_DRY_SETS(each, none, ...) \
    each(__VA_ARGS__, 0, 1, 2, 3) each(__VA_ARGS__, 4, 5, 6, 7) none none none none
#define MCT_ALL_SETS(each, none, ...)                                                                  \
    each(__VA_ARGS__, 0, 1, 2, 3) each(__VA_ARGS__, 4, 5, 6, 7) none each(__VA_ARGS__, 64, 65, 66, 67) \
        each(__VA_ARGS__, 68, 69, 70, 71) none
#define MCT_EXACT_SETS(each, none, ...)                                                              \
    each(__VA_ARGS__, 0, 1, 2, 3) none each(__VA_ARGS__, 65536, 65537, 65538, 65539) none none each( \
        __VA_ARGS__, 65600, 65601, 65602, 65603)

/* Kernels of a stepper for these sets and each kind of motor, whose bit is a literal. */
#define MCT_STEPPER_KERNELS(SETS, stepper, remainder, expression)                                     \
    MCT_INCREMENTS(stepper, expression)                                                               \
    SETS(MCT_FOUR, , stepper, remainder, 0)                                                           \
    SETS(MCT_FOUR, , stepper, remainder, 8)                                                           \
    SETS(MCT_FOUR, , stepper, remainder, 16)                                                          \
    static const mct_named_kernel stepper##_kernels[MCT_MOTOR_KERNELS] = {                            \
        SETS(MCT_FOUR_NAMES, MCT_NO_NAMES, stepper, 0) SETS(MCT_FOUR_NAMES, MCT_NO_NAMES, stepper, 8) \
            SETS(MCT_FOUR_NAMES, MCT_NO_NAMES, stepper, 16)};

#define MCT_FOUR(stepper, remainder, motor, a, b, c, d)                          \
    MCT_KERNEL(stepper, remainder, MCT_MAX_ENCODERS, motor##_##a, (motor) + (a)) \
    MCT_KERNEL(stepper, remainder, MCT_MAX_ENCODERS, motor##_##b, (motor) + (b)) \
    MCT_KERNEL(stepper, remainder, MCT_MAX_ENCODERS, motor##_##c, (motor) + (c)) \
    MCT_KERNEL(stepper, remainder, MCT_MAX_ENCODERS, motor##_##d, (motor) + (d))

#define MCT_FOUR_NAMES(stepper, motor, a, b, c, d)                                  \
    MCT_KERNEL_ENTRY(stepper, motor##_##a), MCT_KERNEL_ENTRY(stepper, motor##_##b), \
        MCT_KERNEL_ENTRY(stepper, motor##_##c), MCT_KERNEL_ENTRY(stepper, motor##_##d),
#define MCT_NO_NAMES {NULL, NULL}, {NULL, NULL}, {NULL, NULL}, {NULL, NULL},

/* The kernel of a stepper for an effect set; NULL where the stepper does not suit the system. */
static inline const mct_named_kernel *mct_kernel_of(const mct_named_kernel *const *kernels, int stepper,
                                                    uint32_t effects)
{
    if ((effects & MCT_MOTOR) == MCT_MOTOR || (effects & MCT_COULOMB) == MCT_COULOMB) {
        return NULL;
    }
    const uint32_t dry = (effects & MCT_COULOMB_EXACT) ? 8 : effects & MCT_COULOMB_MOREAU; /* which is 4 */
    return mct_kernel_at(kernels[stepper], 3 * (effects & MCT_MOTOR) + ((effects & MCT_DRAG) ? 12 : 0) + dry +
                                               (effects & (MCT_GRAVITY | MCT_VISCOUS)));
}

/* --- A system without a motor --- */

/* One kernel for each subset of up to five switches, listed in the order of the system's `switches`. */
#define MCT_PAIR(stepper, remainder, n, number, mask, A) \
    MCT_KERNEL(stepper, remainder, n, number##0, mask)   \
    MCT_KERNEL(stepper, remainder, n, number##1, (mask) | (A))
#define MCT_QUAD(stepper, remainder, n, number, mask, A, B) \
    MCT_PAIR(stepper, remainder, n, number##0, mask, A)     \
    MCT_PAIR(stepper, remainder, n, number##1, (mask) | (B), A)
#define MCT_OCTET(stepper, remainder, n, number, mask, A, B, C) \
    MCT_QUAD(stepper, remainder, n, number##0, mask, A, B)      \
    MCT_QUAD(stepper, remainder, n, number##1, (mask) | (C), A, B)

#define MCT_PAIR_NAMES(stepper, number) \
    MCT_KERNEL_ENTRY(stepper, number##0), MCT_KERNEL_ENTRY(stepper, number##1)
#define MCT_QUAD_NAMES(stepper, number) MCT_PAIR_NAMES(stepper, number##0), MCT_PAIR_NAMES(stepper, number##1)
#define MCT_OCTET_NAMES(stepper, number) \
    MCT_QUAD_NAMES(stepper, number##0), MCT_QUAD_NAMES(stepper, number##1)

/* The kernel of a stepper of a system without switches. */
#define MCT_KERNELS_0(stepper, remainder, n, expression) \
    MCT_INCREMENTS(stepper, expression)                  \
    MCT_KERNEL(stepper, remainder, n, s, 0)              \
    static const mct_named_kernel stepper##_kernels[1] = {MCT_KERNEL_ENTRY(stepper, s)};
/* Kernels of a stepper for one switch, */
#define MCT_KERNELS_1(stepper, remainder, n, A, expression) \
    MCT_INCREMENTS(stepper, expression)                     \
    MCT_PAIR(stepper, remainder, n, s, 0, A)                \
    static const mct_named_kernel stepper##_kernels[2] = {MCT_PAIR_NAMES(stepper, s)};
/* for two, three, four and five switches; bit i of the index is switch i. */
#define MCT_KERNELS_2(...) MCT_KERNELS_2_OF(__VA_ARGS__)
#define MCT_KERNELS_2_OF(stepper, remainder, n, A, B, expression) \
    MCT_INCREMENTS(stepper, expression)                           \
    MCT_QUAD(stepper, remainder, n, s, 0, A, B)                   \
    static const mct_named_kernel stepper##_kernels[4] = {MCT_QUAD_NAMES(stepper, s)};
#define MCT_KERNELS_3(...) MCT_KERNELS_3_OF(__VA_ARGS__)
#define MCT_KERNELS_3_OF(stepper, remainder, n, A, B, C, expression) \
    MCT_INCREMENTS(stepper, expression)                              \
    MCT_OCTET(stepper, remainder, n, s, 0, A, B, C)                  \
    static const mct_named_kernel stepper##_kernels[8] = {MCT_OCTET_NAMES(stepper, s)};
#define MCT_KERNELS_4(...) MCT_KERNELS_4_OF(__VA_ARGS__) /* so that a list of switches may be a macro */
#define MCT_KERNELS_4_OF(stepper, remainder, n, A, B, C, D, expression)                  \
    MCT_INCREMENTS(stepper, expression)                                                  \
    MCT_OCTET(stepper, remainder, n, s0, 0, A, B, C)                                     \
    MCT_OCTET(stepper, remainder, n, s1, D, A, B, C)                                     \
    static const mct_named_kernel stepper##_kernels[16] = {MCT_OCTET_NAMES(stepper, s0), \
                                                           MCT_OCTET_NAMES(stepper, s1)};
#define MCT_KERNELS_5(...) MCT_KERNELS_5_OF(__VA_ARGS__)
#define MCT_KERNELS_5_OF(stepper, remainder, n, A, B, C, D, E, expression)                           \
    MCT_INCREMENTS(stepper, expression)                                                              \
    MCT_OCTET(stepper, remainder, n, s00, 0, A, B, C)                                                \
    MCT_OCTET(stepper, remainder, n, s01, D, A, B, C)                                                \
    MCT_OCTET(stepper, remainder, n, s10, E, A, B, C)                                                \
    MCT_OCTET(stepper, remainder, n, s11, (D) | (E), A, B, C)                                        \
    static const mct_named_kernel stepper##_kernels[32] = {                                          \
        MCT_OCTET_NAMES(stepper, s00), MCT_OCTET_NAMES(stepper, s01), MCT_OCTET_NAMES(stepper, s10), \
        MCT_OCTET_NAMES(stepper, s11)};

/* The kernel of a stepper for an effect set, by the system's switches (0 ends them). */
static inline const mct_named_kernel *mct_switched_kernel_of(const mct_named_kernel *const *kernels,
                                                             const uint32_t *switches, int stepper,
                                                             uint32_t effects)
{
    uint32_t index = 0;
    for (int i = 0; switches[i] != 0; i++) {
        index |= (effects & switches[i]) ? UINT32_C(1) << i : 0;
    }
    return mct_kernel_at(kernels[stepper], index);
}

/* Of a system without dry friction. */
MCT_INLINE void mct_no_friction(const void *constants, unsigned effects, const mct_real *x, mct_real u,
                                mct_real *dx)
{
    (void)constants;
    (void)effects;
    (void)x;
    (void)u;
    (void)dx;
}

/* --- Steppers that need a smooth motion: no kernels for effects with a kink; the others of a table stay NULL --- */

/* Of `count` switches, of which the first, the first two, three or four suit. */
#define MCT_SMOOTH_KERNELS_1(stepper, remainder, n, count, A, expression) \
    MCT_INCREMENTS(stepper, expression)                                   \
    MCT_PAIR(stepper, remainder, n, s, 0, A)                              \
    static const mct_named_kernel stepper##_kernels[1 << (count)] = {MCT_PAIR_NAMES(stepper, s)};
#define MCT_SMOOTH_KERNELS_2(stepper, remainder, n, count, A, B, expression) \
    MCT_INCREMENTS(stepper, expression)                                      \
    MCT_QUAD(stepper, remainder, n, s, 0, A, B)                              \
    static const mct_named_kernel stepper##_kernels[1 << (count)] = {MCT_QUAD_NAMES(stepper, s)};
#define MCT_SMOOTH_KERNELS_3(...) MCT_SMOOTH_KERNELS_3_OF(__VA_ARGS__)
#define MCT_SMOOTH_KERNELS_3_OF(stepper, remainder, n, count, A, B, C, expression) \
    MCT_INCREMENTS(stepper, expression)                                            \
    MCT_OCTET(stepper, remainder, n, s, 0, A, B, C)                                \
    static const mct_named_kernel stepper##_kernels[1 << (count)] = {MCT_OCTET_NAMES(stepper, s)};

#define MCT_SMOOTH_KERNELS_4(...) MCT_SMOOTH_KERNELS_4_OF(__VA_ARGS__)
#define MCT_SMOOTH_KERNELS_4_OF(stepper, remainder, n, count, A, B, C, D, expression)              \
    MCT_INCREMENTS(stepper, expression)                                                            \
    MCT_OCTET(stepper, remainder, n, s0, 0, A, B, C)                                               \
    MCT_OCTET(stepper, remainder, n, s1, D, A, B, C)                                               \
    static const mct_named_kernel stepper##_kernels[1 << (count)] = {MCT_OCTET_NAMES(stepper, s0), \
                                                                     MCT_OCTET_NAMES(stepper, s1)};

/* Of three switches and dry friction, none, by Moreau and exact, which are the fourth and fifth. */
#define MCT_DRY_KERNELS_3(...) MCT_DRY_KERNELS_3_OF(__VA_ARGS__)
#define MCT_DRY_KERNELS_3_OF(stepper, remainder, n, A, B, C, expression) \
    MCT_INCREMENTS(stepper, expression)                                  \
    MCT_OCTET(stepper, remainder, n, s, 0, A, B, C)                      \
    MCT_OCTET(stepper, remainder, n, m, MCT_COULOMB_MOREAU, A, B, C)     \
    MCT_OCTET(stepper, remainder, n, e, MCT_COULOMB_EXACT, A, B, C)      \
    static const mct_named_kernel stepper##_kernels[32] = {              \
        MCT_OCTET_NAMES(stepper, s), MCT_OCTET_NAMES(stepper, m), MCT_OCTET_NAMES(stepper, e)};

/*
 * Of a series that knows exact friction: two switches A and B, then dry friction by Moreau, drag and exact dry friction,
 * of which drag suits with the last alone, and not every system.
 */
#define MCT_EXACT_KERNELS(stepper, remainder, n, A, B, expression) \
    MCT_INCREMENTS(stepper, expression)                            \
    MCT_QUAD(stepper, remainder, n, s, 0, A, B)                    \
    MCT_QUAD(stepper, remainder, n, e, MCT_COULOMB_EXACT, A, B)    \
    static const mct_named_kernel stepper##_kernels[32] = {        \
        MCT_QUAD_NAMES(stepper, s), [16] = MCT_QUAD_NAMES(stepper, e)};
#define MCT_EXACT_DRAG_KERNELS(stepper, remainder, n, A, B, expression)    \
    MCT_INCREMENTS(stepper, expression)                                    \
    MCT_QUAD(stepper, remainder, n, s, 0, A, B)                            \
    MCT_QUAD(stepper, remainder, n, e, MCT_COULOMB_EXACT, A, B)            \
    MCT_QUAD(stepper, remainder, n, d, MCT_COULOMB_EXACT | MCT_DRAG, A, B) \
    static const mct_named_kernel stepper##_kernels[32] = {                \
        MCT_QUAD_NAMES(stepper, s), [16] = MCT_QUAD_NAMES(stepper, e), [24] = MCT_QUAD_NAMES(stepper, d)};

/* --- Taylor's method: the including file's step, taylor(constants, effects, order, x, u, dx), by literal orders --- */

#define MCT_TAYLOR_OF_ORDER(KERNELS, order, ...) \
    KERNELS(taylor##order, __VA_ARGS__, taylor(k, effects, order, x, u, dx))
#define MCT_TAYLOR(KERNELS, ...)                 \
    MCT_TAYLOR_OF_ORDER(KERNELS, 4, __VA_ARGS__) \
    MCT_TAYLOR_OF_ORDER(KERNELS, 6, __VA_ARGS__) \
    MCT_TAYLOR_OF_ORDER(KERNELS, 8, __VA_ARGS__) \
    MCT_TAYLOR_OF_ORDER(KERNELS, 12, __VA_ARGS__)
/* Of a system with a motor; exact dry friction by one order alone, for these kernels are large. */
#define MCT_TAYLOR_MOTOR_KERNELS(remainder)                     \
    MCT_TAYLOR_OF_ORDER(MCT_SMOOTH_MOTOR_KERNELS, 4, remainder) \
    MCT_TAYLOR_OF_ORDER(MCT_EXACT_MOTOR_KERNELS, 6, remainder)  \
    MCT_TAYLOR_OF_ORDER(MCT_SMOOTH_MOTOR_KERNELS, 8, remainder) \
    MCT_TAYLOR_OF_ORDER(MCT_SMOOTH_MOTOR_KERNELS, 12, remainder)
#define MCT_SMOOTH_MOTOR_KERNELS(...) MCT_STEPPER_KERNELS(MCT_SMOOTH_SETS, __VA_ARGS__)
#define MCT_EXACT_MOTOR_KERNELS(...)  MCT_STEPPER_KERNELS(MCT_EXACT_SETS, __VA_ARGS__)
#define MCT_TAYLOR_EXACT(...)         MCT_TAYLOR(MCT_EXACT_KERNELS, __VA_ARGS__)
#define MCT_TAYLOR_EXACT_DRAG(...)    MCT_TAYLOR(MCT_EXACT_DRAG_KERNELS, __VA_ARGS__)
#define MCT_TAYLOR_KERNELS_2(...)     MCT_TAYLOR(MCT_SMOOTH_KERNELS_2, __VA_ARGS__)
#define MCT_TAYLOR_KERNELS_3(...)     MCT_TAYLOR(MCT_SMOOTH_KERNELS_3, __VA_ARGS__)

/* Their rows in the table of a system's kernels. */
#define MCT_TAYLOR_ROWS                                                               \
    [MCT_STEPPER_TAYLOR4] = taylor4_kernels, [MCT_STEPPER_TAYLOR6] = taylor6_kernels, \
    [MCT_STEPPER_TAYLOR8] = taylor8_kernels, [MCT_STEPPER_TAYLOR12] = taylor12_kernels

#endif

/**
 * @file effects.h
 * Effects: what a scene may switch on or leave out. One bit has one meaning across all systems.
 *
 * A right-hand side is written once over a literal mask; the compiler removes what is off. MCT_KERNEL_EFFECTS select
 * a kernel; the others act once a tick, outside of it.
 */
#ifndef MCTAU_EFFECTS_H
#define MCTAU_EFFECTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    MCT_GRAVITY = 1 << 0,        /**< weight of every particle */
    MCT_VISCOUS = 1 << 1,        /**< friction torque or force proportional to a coordinate's rate */
    MCT_COULOMB_MOREAU = 1 << 2, /**< dry friction of constant size, with sticking: Moreau's impulse clamp */
    MCT_MOTOR_QUASI_STATIC =
        1 << 3, /**< DC motor with L = 0: the input is a voltage, the current follows at once */
    MCT_MOTOR_INDUCTIVE = 1 << 4,    /**< DC motor with L di/dt = V - R i - k w: the current is a state */
    MCT_SATURATION_VOLTAGE = 1 << 5, /**< the supply bounds the voltage */
    MCT_DRAG = 1 << 6,               /**< force against a velocity, proportional to its square */
    MCT_SPRING = 1 << 7,             /**< linear spring */
    MCT_BASE_MOTION = 1 << 8,        /**< the pivot moves as prescribed */
    MCT_CENTRIFUGAL = 1 << 9,        /**< of a rotating frame: - m omega x (omega x u) */
    MCT_CORIOLIS = 1 << 10,          /**< of a rotating frame: - 2 m omega x v */
    MCT_EULER_FORCE = 1 << 11,       /**< of a rotating frame: - m domega/dt x u */
    MCT_STOKES = 1 << 12,            /**< viscous drag of a slow sphere, proportional to its velocity */
    MCT_BUOYANCY = 1 << 13,          /**< weight of the displaced fluid */
    MCT_FORCING = 1 << 14,           /**< a force that changes in time as prescribed */
    MCT_FORCES = 1 << 15,            /**< constant forces on points of the mechanism */
    MCT_COULOMB_EXACT = 1 << 16,     /**< dry friction, starts and stops located within the step */
    MCT_SATURATION_CURRENT = 1 << 17 /**< the drive bounds the current */
};
#define MCT_CLOCK (MCT_BASE_MOTION | MCT_FORCING) /**< what depends on time: the phases are states */
/** What does work that is in no energy and is no input. */
#define MCT_SOURCES        (MCT_CLOCK | MCT_FORCES | MCT_CENTRIFUGAL | MCT_CORIOLIS | MCT_EULER_FORCE)
#define MCT_MOTOR          (MCT_MOTOR_QUASI_STATIC | MCT_MOTOR_INDUCTIVE)
#define MCT_COULOMB        (MCT_COULOMB_MOREAU | MCT_COULOMB_EXACT)
#define MCT_SATURATION     (MCT_SATURATION_VOLTAGE | MCT_SATURATION_CURRENT)
#define MCT_POTENTIAL      (MCT_GRAVITY | MCT_SPRING | MCT_BUOYANCY) /**< what has a potential energy */
#define MCT_KERNEL_EFFECTS (~(uint32_t)MCT_SATURATION)

/**
 * One effect as a scene names it. `bits` lists the mask of each choice; a switch has the choices false and
 * true.
 */
typedef struct {
    const char *name;
    const char *doc;
    uint32_t mask;              /**< all bits that belong to the effect */
    const char *const *choices; /**< NULL for a switch */
    uint32_t bits[3];           /**< mask by choice (false/true for a switch); 0 for the first */
    bool is_switch;             /**< false and true may stand for the first two choices */
} mct_effect;

/** Place of an effect in mct_effects. */
enum {
    MCT_EFFECT_GRAVITY,
    MCT_EFFECT_VISCOUS,
    MCT_EFFECT_COULOMB,
    MCT_EFFECT_MOTOR,
    MCT_EFFECT_SATURATION,
    MCT_EFFECT_DRAG,
    MCT_EFFECT_SPRING,
    MCT_EFFECT_BASE_MOTION,
    MCT_EFFECT_CENTRIFUGAL,
    MCT_EFFECT_CORIOLIS,
    MCT_EFFECT_EULER,
    MCT_EFFECT_STOKES,
    MCT_EFFECT_BUOYANCY,
    MCT_EFFECT_FORCING,
    MCT_EFFECT_FORCES,
    MCT_EFFECT_COUNT
};
/** All effects, in the order in which they are listed. */
extern const mct_effect mct_effects[MCT_EFFECT_COUNT];

#endif

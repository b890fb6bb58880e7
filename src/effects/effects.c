#include "mctau/effects.h"

#define SWITCH(name, bit, doc)                          \
    {                                                   \
        (name), (doc), (bit), NULL, {0, (bit), 0}, true \
    }

static const char *const motor_choices[] = {"off", "quasi_static", "inductive", NULL};
static const char *const coulomb_choices[] = {"off", "moreau", "exact", NULL};
static const char *const saturation_choices[] = {"off", "voltage", "current", NULL};

const mct_effect mct_effects[MCT_EFFECT_COUNT] = {
    [MCT_EFFECT_GRAVITY] = SWITCH("gravity", MCT_GRAVITY, "weight of every particle"),
    [MCT_EFFECT_VISCOUS] = SWITCH("viscous", MCT_VISCOUS, "friction proportional to a coordinate's rate"),
    [MCT_EFFECT_COULOMB] = {.name = "coulomb",
                            .doc =
                                "dry friction of constant size, with sticking; moreau: by an impulse a step; "
                                "exact: starts and stops are located within the step, by a series",
                            .mask = MCT_COULOMB,
                            .choices = coulomb_choices,
                            .bits = {0, MCT_COULOMB_MOREAU, MCT_COULOMB_EXACT},
                            .is_switch = true},
    [MCT_EFFECT_MOTOR] =
        {.name = "motor",
         .doc = "off: the input is a force or torque; quasi_static: a voltage, L = 0; inductive: "
                "a voltage, the current is a state",
         .mask = MCT_MOTOR,
         .choices = motor_choices,
         .bits = {0, MCT_MOTOR_QUASI_STATIC, MCT_MOTOR_INDUCTIVE}},
    [MCT_EFFECT_SATURATION] =
        {.name = "saturation",
         .doc = "voltage: the supply bounds the voltage; current: and the drive the current",
         .mask = MCT_SATURATION,
         .choices = saturation_choices,
         .bits = {0, MCT_SATURATION_VOLTAGE, MCT_SATURATION},
         .is_switch = true},
    [MCT_EFFECT_DRAG] = SWITCH("drag", MCT_DRAG, "force against a velocity, proportional to its square"),
    [MCT_EFFECT_SPRING] = SWITCH("spring", MCT_SPRING, "linear spring"),
    [MCT_EFFECT_BASE_MOTION] = SWITCH("base_motion", MCT_BASE_MOTION, "the pivot moves as prescribed"),
    [MCT_EFFECT_CENTRIFUGAL] = SWITCH("centrifugal", MCT_CENTRIFUGAL, "of a rotating frame, outwards"),
    [MCT_EFFECT_CORIOLIS] = SWITCH("coriolis", MCT_CORIOLIS, "of a rotating frame, across the velocity"),
    [MCT_EFFECT_EULER] = SWITCH("euler", MCT_EULER_FORCE, "of a frame whose rotation changes"),
    [MCT_EFFECT_STOKES] =
        SWITCH("stokes", MCT_STOKES, "viscous drag of a slow sphere, proportional to its velocity"),
    [MCT_EFFECT_BUOYANCY] = SWITCH("buoyancy", MCT_BUOYANCY, "weight of the displaced fluid"),
    [MCT_EFFECT_FORCING] = SWITCH("forcing", MCT_FORCING, "a force that changes in time as prescribed"),
    [MCT_EFFECT_FORCES] = SWITCH("forces", MCT_FORCES, "constant forces on points of the mechanism"),
};

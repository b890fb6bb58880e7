#include "mctau/effects.h"

static const char *const motor_choices[] = {"off", "quasi_static", "inductive", NULL};

const mct_effect mct_effects[MCT_EFFECT_COUNT] = {
    {"gravity", "weight of every particle", MCT_GRAVITY, NULL, {0, MCT_GRAVITY, 0}},
    {"viscous", "friction proportional to a coordinate's rate", MCT_VISCOUS, NULL, {0, MCT_VISCOUS, 0}},
    {"coulomb", "dry friction of constant size, with sticking", MCT_COULOMB, NULL, {0, MCT_COULOMB, 0}},
    {"motor",
     "off: the input is a force or torque; quasi_static: a voltage, L = 0; inductive: a voltage, the current "
     "is a state",
     MCT_MOTOR,
     motor_choices,
     {0, MCT_MOTOR_QUASI_STATIC, MCT_MOTOR_INDUCTIVE}},
    {"saturation", "the supply bounds the voltage", MCT_SATURATION, NULL, {0, MCT_SATURATION, 0}},
};

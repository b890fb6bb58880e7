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
    {"drag", "force against a velocity, proportional to its square", MCT_DRAG, NULL, {0, MCT_DRAG, 0}},
    {"spring", "linear spring", MCT_SPRING, NULL, {0, MCT_SPRING, 0}},
    {"base_motion", "the pivot moves as prescribed", MCT_BASE_MOTION, NULL, {0, MCT_BASE_MOTION, 0}},
    {"centrifugal", "of a rotating frame, outwards", MCT_CENTRIFUGAL, NULL, {0, MCT_CENTRIFUGAL, 0}},
    {"coriolis", "of a rotating frame, across the velocity", MCT_CORIOLIS, NULL, {0, MCT_CORIOLIS, 0}},
    {"euler", "of a frame whose rotation changes", MCT_EULER_FORCE, NULL, {0, MCT_EULER_FORCE, 0}},
    {"stokes",
     "viscous drag of a slow sphere, proportional to its velocity",
     MCT_STOKES,
     NULL,
     {0, MCT_STOKES, 0}},
    {"buoyancy", "weight of the displaced fluid", MCT_BUOYANCY, NULL, {0, MCT_BUOYANCY, 0}},
    {"forcing", "a force that changes in time as prescribed", MCT_FORCING, NULL, {0, MCT_FORCING, 0}},
    {"forces", "constant forces on points of the mechanism", MCT_FORCES, NULL, {0, MCT_FORCES, 0}},
};

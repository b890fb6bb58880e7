#include "mctau/effects.h"

static const char *const motor_choices[] = {"off", "quasi_static", "inductive", NULL};
static const char *const coulomb_choices[] = {"off", "moreau", "exact", NULL};
static const char *const saturation_choices[] = {"off", "voltage", "current", NULL};

const mct_effect mct_effects[MCT_EFFECT_COUNT] = {
    [MCT_EFFECT_GRAVITY] =
        {"gravity", "weight of every particle", MCT_GRAVITY, NULL, {0, MCT_GRAVITY, 0}, true},
    [MCT_EFFECT_VISCOUS] = {"viscous",
                            "friction proportional to a coordinate's rate",
                            MCT_VISCOUS,
                            NULL,
                            {0, MCT_VISCOUS, 0},
                            true},
    [MCT_EFFECT_COULOMB] = {"coulomb",
                            "dry friction of constant size, with sticking; moreau: by an impulse a step; "
                            "exact: starts and stops "
                            "are located "
                            "within the step",
                            MCT_COULOMB,
                            coulomb_choices,
                            {0, MCT_COULOMB_MOREAU, MCT_COULOMB_EXACT},
                            true},
    [MCT_EFFECT_MOTOR] = {"motor",
                          "off: the input is a force or torque; quasi_static: a voltage, L = 0; inductive: a "
                          "voltage, the current "
                          "is a state",
                          MCT_MOTOR,
                          motor_choices,
                          {0, MCT_MOTOR_QUASI_STATIC, MCT_MOTOR_INDUCTIVE},
                          false},
    [MCT_EFFECT_SATURATION] = {"saturation",
                               "voltage: the supply bounds the voltage; current: and the drive the current",
                               MCT_SATURATION,
                               saturation_choices,
                               {0, MCT_SATURATION_VOLTAGE, MCT_SATURATION},
                               true},
    [MCT_EFFECT_DRAG] = {"drag",
                         "force against a velocity, proportional to its square",
                         MCT_DRAG,
                         NULL,
                         {0, MCT_DRAG, 0},
                         true},
    [MCT_EFFECT_SPRING] = {"spring", "linear spring", MCT_SPRING, NULL, {0, MCT_SPRING, 0}, true},
    [MCT_EFFECT_BASE_MOTION] = {"base_motion",
                                "the pivot moves as prescribed",
                                MCT_BASE_MOTION,
                                NULL,
                                {0, MCT_BASE_MOTION, 0},
                                true},
    [MCT_EFFECT_CENTRIFUGAL] = {"centrifugal",
                                "of a rotating frame, outwards",
                                MCT_CENTRIFUGAL,
                                NULL,
                                {0, MCT_CENTRIFUGAL, 0},
                                true},
    [MCT_EFFECT_CORIOLIS] = {"coriolis",
                             "of a rotating frame, across the velocity",
                             MCT_CORIOLIS,
                             NULL,
                             {0, MCT_CORIOLIS, 0},
                             true},
    [MCT_EFFECT_EULER] =
        {"euler", "of a frame whose rotation changes", MCT_EULER_FORCE, NULL, {0, MCT_EULER_FORCE, 0}, true},
    [MCT_EFFECT_STOKES] = {"stokes",
                           "viscous drag of a slow sphere, proportional to its velocity",
                           MCT_STOKES,
                           NULL,
                           {0, MCT_STOKES, 0},
                           true},
    [MCT_EFFECT_BUOYANCY] =
        {"buoyancy", "weight of the displaced fluid", MCT_BUOYANCY, NULL, {0, MCT_BUOYANCY, 0}, true},
    [MCT_EFFECT_FORCING] = {"forcing",
                            "a force that changes in time as prescribed",
                            MCT_FORCING,
                            NULL,
                            {0, MCT_FORCING, 0},
                            true},
    [MCT_EFFECT_FORCES] =
        {"forces", "constant forces on points of the mechanism", MCT_FORCES, NULL, {0, MCT_FORCES, 0}, true},
};

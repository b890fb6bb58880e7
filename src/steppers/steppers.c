#include "mctau/stepper.h"

const mct_stepper mct_steppers[MCT_STEPPER_COUNT] = {
    [MCT_STEPPER_SEED] = {"seed", 1,
                          "the source document's eqs. 22-23; anti-damped: the baseline to beat, not to use",
                          2.0},
    [MCT_STEPPER_EULER] = {"euler", 1,
                           "semi-implicit Euler with implicit damping and current: what most simulators do",
                           0},
    [MCT_STEPPER_LEAP] = {"leap", 2,
                          "Kahan's leapfrog, exactly symmetric, the motor's current averaged over the step",
                          0},
    [MCT_STEPPER_RK4] = {"rk4", 4, "classical Runge-Kutta: the generic default", 2.785},
    [MCT_STEPPER_EXPO] = {"expo", 4, "exponential Nystroem on the exact flow of the linear part: any L/R", 0},
    [MCT_STEPPER_DISCRETE] = {"discrete", 1,
                              "the steps of a process that has no time of its own: inverse kinematics", 0},
};

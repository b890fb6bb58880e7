#include "mctau/stepper.h"

/*
 * The limits of a motor: a current decays as e^-z, z = h R/L, and a scheme of order p, with as many stages or terms, makes
 * 1 - z + z^2/2 - ... +- z^p/p! of it, which is within +-1 up to the z that stands here, rounded down. It is 2 at order 1
 * and grows by some 0.38 an order.
 */
const mct_stepper mct_steppers[MCT_STEPPER_COUNT] = {
    [MCT_STEPPER_SEED] = {"seed", 1,
                          "the source document's eqs. 22-23; anti-damped: the baseline to beat, not to use",
                          2.0, false, false},
    [MCT_STEPPER_EULER] = {"euler", 1,
                           "semi-implicit Euler with implicit damping and current: what most simulators do",
                           0, false, false},
    [MCT_STEPPER_LEAP] = {"leap", 2,
                          "Kahan's leapfrog, exactly symmetric, the motor's current averaged over the step",
                          0, false, false},
    [MCT_STEPPER_RK4] = {"rk4", 4, "classical Runge-Kutta: the generic default", 2.785, false, false},
    [MCT_STEPPER_TAYLOR4] =
        {"taylor4", 4,
         "Taylor's method, order 4: one sine a step at any order; these find exact dry friction", 2.785, true,
         true},
    [MCT_STEPPER_TAYLOR6] = {"taylor6", 6, "Taylor's method, order 6: exact to rounding at 1 kHz", 3.553,
                             true, true},
    [MCT_STEPPER_TAYLOR8] = {"taylor8", 8, "Taylor's method, order 8", 4.313, true, true},
    [MCT_STEPPER_TAYLOR12] = {"taylor12", 12, "Taylor's method, order 12: for steps of 10 to 20 ms", 5.822,
                              true, true},
    [MCT_STEPPER_EXPO] = {"expo", 5, "exponential collocation on the exact flow of the linear part: any L/R",
                          0, false, false},
    [MCT_STEPPER_EXPO8] = {"expo8", 8, "exponential collocation: as expo, for long steps and the last digits",
                           0, true, true},
    [MCT_STEPPER_RKN6] = {"rkn6", 6,
                          "Runge-Kutta-Nystroem, order 6: for forces of position alone, without friction", 0,
                          true, true},
    [MCT_STEPPER_SPLIT3] = {"split3", 2,
                            "parts in turn, each moved exactly: rotations about three axes, at any spin; "
                            "along a spring and about its pivot, at any stiffness",
                            0, false, true},
    [MCT_STEPPER_DISCRETE] = {"discrete", 1,
                              "the steps of a process that has no time of its own: inverse kinematics", 0,
                              false, false},
};

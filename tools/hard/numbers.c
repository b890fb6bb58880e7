/* Hard cases of numbers: time, inverse kinematics, denormals, inputs that are none. */
#include "hard_run.h"

const hard_case hard_numbers[] = {{.rule = NULL}};

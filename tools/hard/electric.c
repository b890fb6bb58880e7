/* Hard cases of the motor: a current that follows in microseconds, none at all, jumps of the voltage. */
#include "hard_run.h"

const hard_case hard_electric[] = {{.rule = NULL}};

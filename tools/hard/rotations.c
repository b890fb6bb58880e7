/* Hard cases of rotations and angles. */
#include "hard_run.h"

const hard_case hard_rotations[] = {{.rule = NULL}};

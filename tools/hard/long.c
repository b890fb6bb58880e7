/* Hard cases of many steps: energy, reversal, a swing that nearly stops. */
#include "hard_run.h"

const hard_case hard_long[] = {{.rule = NULL}};

/* Hard cases at the ends: ratios of parameters, days of time, controllers at their limits. */
#include "hard_run.h"

const hard_case hard_extremes[] = {{.rule = NULL}};

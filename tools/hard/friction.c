/* Hard cases of dry friction. */
#include "hard_run.h"

const hard_case hard_friction[] = {{.rule = NULL}};

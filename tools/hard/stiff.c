/* Hard cases of scales far apart: masses, springs, drag, shaken pivots, frames and spins. */
#include "hard_run.h"

const hard_case hard_stiff[] = {{.rule = NULL}};

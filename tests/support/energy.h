/* Energies of an evaluation; without Unity, so for benchmarks as well. */
#ifndef MCT_TEST_ENERGY_H
#define MCT_TEST_ENERGY_H

#include "mctau/system.h"

/* Rate of kinetic, potential and magnetic energy by the powers [W]. */
double energy_rate(const mct_evaluation *at);

#endif

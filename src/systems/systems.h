/* The systems that mct_systems lists. */
#ifndef MCT_SYSTEMS_SYSTEMS_H
#define MCT_SYSTEMS_SYSTEMS_H

#include "mctau/system.h"

extern const mct_system mct_cart_pole;
extern const mct_system mct_reaction_wheel;
extern const mct_system mct_pendulum;

#endif

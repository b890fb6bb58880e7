/* The laws of the swing-up, mct_SYSTEM_swing_up: the input wanted of a controller that has not caught its pendulum yet. */
#ifndef MCT_CONTROL_SWING_UP_H
#define MCT_CONTROL_SWING_UP_H

#include "mctau/controller.h"

mct_real mct_cart_pole_swing_up(mct_controller *controller);
mct_real mct_reaction_wheel_swing_up(mct_controller *controller);

#endif

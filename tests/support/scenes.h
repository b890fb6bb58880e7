/* Scenes made by hand, by the names that a scene file would use. */
#ifndef MCT_TEST_SCENES_H
#define MCT_TEST_SCENES_H

#include "mctau/plant.h"
#include "mctau/scene.h"
#include "mctau/stepper.h"
#include "support/energy.h"

enum { CART_POLE, REACTION_WHEEL, CENTRAL_SYSTEMS }; /* as in mct_systems; those with a motor */

/* Index of a system by its name; fails the test when there is none. */
int system_called(const char *name);

/* Defaults of a system, with this stepper and these effects; checked at use, not here. */
mct_scene scene_of(int system, int stepper, uint32_t effects);

/* The next stepper behind `stepper` that suits a system with these effects; MCT_STEPPER_COUNT behind the last. */
int suiting_stepper(int stepper, int system, uint32_t effects);
#define FOR_EACH_STEPPER(stepper, system, effects)                                        \
    for (int stepper = suiting_stepper(-1, system, effects); stepper < MCT_STEPPER_COUNT; \
         stepper = suiting_stepper(stepper, system, effects))

/* A parameter by its name; fails the test when there is none. */
double *parameter_of(mct_scene *scene, const char *name);

/* A plant of a scene; fails the test when it cannot be made. */
void start_plant(mct_plant *plant, const mct_scene *scene);

/* Advances a plant by whole ticks under one input. */
void step_plant(mct_plant *plant, mct_real input, long ticks);

/* Kinetic, potential and magnetic energy at the plant's state [J]. */
double energy_of(const mct_plant *plant);

/* Name of a motor's mode in an effect set. */
const char *motor_name(uint32_t effects);

/* |angle| taken to within half a turn. */
double angle_size(double angle);

#endif

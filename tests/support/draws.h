/* Random scenes and states of any system, drawn by the descriptors. */
#ifndef MCT_TEST_DRAWS_H
#define MCT_TEST_DRAWS_H

#include "mctau/constants.h"
#include "mctau/scene.h"
#include "support/random.h"

/*
 * A scene of a system with random parameters, lists and effects (those in `always` are on where the system has them), its
 * constants for steps of 1 ms and a state. Gives false where it is refused: a body without inertia about an axis.
 */
bool draw_scene(test_random *random, int system, uint32_t always, mct_scene *scene, mct_constants *constants,
                mct_real *x);

#endif

/* The cheapest way to simulate a scene to a tolerance. */
#ifndef MCTAU_TOOLS_PICK_H
#define MCTAU_TOOLS_PICK_H

#include "scene_file.h"

/*
 * For a scene with stepper = "auto": sets stepper and substeps to the cheapest that meet scene.tolerance at
 * the scene's own tick and precision, says which on stderr, and adds them to the text that a log keeps.
 * Leaves others alone. Gives 0, or says that there is none and gives the exit code.
 */
int choose_stepper(scene_file *file);

#endif

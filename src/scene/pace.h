/* Whether a scene's steps follow its motion. */
#ifndef MCT_SCENE_PACE_H
#define MCT_SCENE_PACE_H

#include "mctau/scene.h"

#define MCT_SMALL_SHARE 0.01 /* of an inertia, worth a closer look */

typedef enum {
    MCT_PACE_FOLLOWS,
    MCT_PACE_LONG,        /* worth telling */
    MCT_PACE_NOT_FOLLOWED /* nothing that comes after such a step can be trusted */
} mct_pace_verdict;

typedef struct {
    mct_pace_verdict verdict;
    double error;   /* largest change of the rates by halving one step, in units of what rates there may be */
    double longest; /* step that follows, at most the scene's [s]; 0: none was found */
    int coordinate; /* an angle that is not at its start where the error was found; -1: none */
    double angle;   /* its value there [rad] */
    double share;   /* least part of a coordinate's inertia there that is left while the others are free */
    int lightest;   /* that coordinate */
} mct_pace;

/*
 * Tries one step of the scene's kernel, and two of half its length, from its start and from places that its energy may
 * reach, in several directions each; then shorter steps until they follow. Bounded: some 10 to 200 us where the step
 * does, else as many times that as it takes halvings, at most 40. prepare() must have taken the scene.
 */
void mct_pace_find(const mct_scene *scene, mct_pace *pace);

#endif

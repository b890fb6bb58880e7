/*
 * The systems whose motion is smooth, by the textbook, in quadruple precision: from a scene's numbers, nothing of the
 * closed forms in src/ is used. One for many: tests of steppers take every system by it.
 */
#ifndef MCT_TEST_TEXTBOOK_H
#define MCT_TEST_TEXTBOOK_H

#include "support/bodies.h"
#include "support/reference.h"

typedef struct {
    const mct_scene *scene;
    quad input;
    quad_rate rate;
    int states;
    reference_model central; /* cart_pole, reaction_wheel */
    textbook_body body;      /* ball_joint, rigid_body: states as bodies.h has them */
    struct {
        quad axis[3], gravity[3], inertia, friction; /* inertia: that of the parts about themselves */
        int count;
        quad mass[MCT_MAX_PARTICLES], place[MCT_MAX_PARTICLES][3];
    } hinge;
} textbook;

/* The textbook of a scene, which must outlive it, under a held input; false when there is none of its system. */
bool textbook_of(textbook *self, const mct_scene *scene, double input);

/* x: the states that a plant has. */
void textbook_start(const textbook *self, const mct_plant *plant, quad *x);

/* Largest difference of a plant from x, each state's relative to its size or 1; an attitude's in rad. */
double textbook_distance(const textbook *self, const mct_plant *plant, const quad *x);

#endif

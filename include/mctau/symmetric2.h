/**
 * @file symmetric2.h
 * Symmetric 2 x 2 matrices: the inertia of a system with two coordinates.
 */
#ifndef MCTAU_SYMMETRIC2_H
#define MCTAU_SYMMETRIC2_H

#include "mctau/real.h"

typedef struct {
    mct_real a11, a12, a22;
} mct_symmetric2;

/** A mass matrix and its inverse, each as exact as it can be had. */
typedef struct {
    mct_symmetric2 mass;
    mct_symmetric2 inverse;
} mct_inertia2;

#endif

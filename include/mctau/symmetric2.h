/**
 * @file symmetric2.h
 * A symmetric 2 x 2 matrix: an inverse mass matrix, say.
 */
#ifndef MCTAU_SYMMETRIC2_H
#define MCTAU_SYMMETRIC2_H

#include "mctau/real.h"

typedef struct {
    mct_real a11, a12, a22;
} mct_symmetric2;

#endif

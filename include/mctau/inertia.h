/**
 * @file inertia.h
 * Mass, centre and inertia of bodies: of particles, of simple shapes; principal axes (source, 5.4 and 5.6).
 *
 * In double in both precisions of the core: for what is computed once at init. Deterministic to the bit,
 * bounded, thread-safe for distinct outputs; an output must not overlap an input. An inertia is a symmetric
 * matrix I[9] [kg m^2], entry (i, j) at I[3 i + j], in axes fixed in the body:
 *
 *     I = -sum m R^2[b] = sum m (b'b - b b')                                 (314)
 *
 * Corrections to the source: the masses in (310) and (315), the sign of (324), the total mass.
 */
#ifndef MCTAU_INERTIA_H
#define MCTAU_INERTIA_H

#include "mctau/status.h"

/** A body as far as its motion goes. */
typedef struct {
    double mass;       /**< [kg] */
    double center[3];  /**< of mass [m] */
    double inertia[9]; /**< about the centre [kg m^2] */
} mct_body;

/**
 * Mass, centre (325) and inertia about it (323) of particles. The centre is taken off before squares are, so
 * that a body far from the origin keeps its digits.
 *
 * @param mass      of each, at least 0 and not all 0 [kg]
 * @param position  count x 3 [m]
 * @return MCT_ERROR_ARGUMENT (no particle), MCT_ERROR_RANGE (a negative mass, or none at all),
 *         MCT_ERROR_NOT_FINITE; `body` is then undefined. Some 20 operations a particle.
 */
mct_status mct_body_of_particles(int count, const double *mass, const double (*position)[3], mct_body *body);

/**
 * Inertia of a body about any point: I - m R^2[center - point] (321), (326), Steiner's parallel axis theorem.
 */
void mct_inertia_about(const mct_body *body, const double *point, double *inertia);

/** Shapes of even density, centred at the origin; those with an axis of symmetry have it along axis 3. */
typedef enum {
    MCT_BOX,           /**< sizes along the three axes (328) */
    MCT_SOLID_SPHERE,  /**< radius */
    MCT_HOLLOW_SPHERE, /**< radius, of a thin wall */
    MCT_CYLINDER,      /**< radius, length */
    MCT_TUBE,          /**< radius, length, of a thin wall, open at both ends */
    MCT_DISC,          /**< radius, thin */
    MCT_HOOP,          /**< radius, thin: the source's wheel (140) */
    MCT_ROD,           /**< length, thin */
} mct_shape;

/**
 * Inertia of a shape about its centre.
 *
 * @param mass  at least 0 [kg]
 * @param size  as many as the shape has, in the order above, each at least 0 [m]
 * @return MCT_ERROR_ARGUMENT (no such shape), MCT_ERROR_RANGE (a negative mass or size), MCT_ERROR_NOT_FINITE
 */
mct_status mct_shape_inertia(mct_shape shape, double mass, const double *size, double *inertia);

/**
 * Principal axes: I = p diag(moments) p' (367), by Jacobi's rotations.
 *
 * A moment that is repeated has a plane of axes, or all: any orthogonal ones of them are given. The axes are
 * right-handed; a diagonal I gives the identity. The moments are in the order of the axes, not sorted. They are
 * known to some roundings of the largest one.
 *
 * @param inertia  of which the upper triangle is read
 * @param moments  3 [kg m^2], out
 * @param axes     3 x 3, the columns are the axes, out
 * @return MCT_ERROR_NOT_FINITE; MCT_ERROR_NO_CONVERGENCE after 16 sweeps (5 do where it was measured). The
 *         outputs are then undefined. Some 600 operations. C. G. J. Jacobi (1846); H. Rutishauser (1966).
 */
mct_status mct_principal_axes(const double *inertia, double *moments, double *axes);

/** What no body can have as its inertia. */
typedef enum {
    MCT_INERTIA_PHYSICAL,
    MCT_INERTIA_NOT_FINITE,
    MCT_INERTIA_NOT_SYMMETRIC,
    MCT_INERTIA_NEGATIVE,     /**< a principal moment is below 0 */
    MCT_INERTIA_NOT_TRIANGLE, /**< a principal moment exceeds the sum of the other two */
} mct_inertia_fault;

/** The first fault that was found, and its figures, for a message. */
typedef struct {
    mct_inertia_fault fault;
    int row, column; /**< of the entry, where one is at fault */
    double found;    /**< the entry; the moment at fault */
    double bound;    /**< what it should have been: the entry opposite; 0; the sum of the other two moments */
    double moments[3], axes[9]; /**< of mct_principal_axes(); 0 where the first three faults prevent it */
} mct_inertia_report;

/**
 * Checks that an inertia is one: symmetric, no principal moment negative, none larger than the sum of the
 * others. A part in 1e9 of the trace is allowed for rounding (flat bodies lie on the bound).
 *
 * @return MCT_OK, MCT_ERROR_NOT_FINITE, otherwise MCT_ERROR_RANGE; `report` is written in any case
 */
mct_status mct_inertia_check(const double *inertia, mct_inertia_report *report);

/** How many particles mct_equimomental_particles() makes of a body. */
#define MCT_EQUIMOMENTAL_COUNT 6

/**
 * Six particles, each a sixth of the mass, that move as the body does: mass, centre and inertia are the same.
 * On each principal axis i, at +-sqrt(3 s_i / m) from the centre, s_i = (I_1 + I_2 + I_3)/2 - I_i its second
 * moment.
 *
 * @param position  6 x 3 [m], out
 * @return as mct_inertia_check(), and MCT_ERROR_RANGE for a mass that is not positive; `position` is then
 *         undefined
 */
mct_status mct_equimomental_particles(const mct_body *body, double (*position)[3]);

#endif

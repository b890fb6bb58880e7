/**
 * @file hyperdual.h
 * Numbers that carry their own first and second derivatives, exactly.
 *
 * A hyper-dual number is value + e1 d1 + e2 d2 + e12 d1 d2, with d1^2 = d2^2 = 0. Seed the arguments of a
 * function with two directions, e1 = a and e2 = b; then the result holds f, f'a, f'b and a'f''b, without a
 * step size and without a truncation error. One written formula therefore yields position, velocity,
 * Jacobian and its rate.
 *
 * All functions are thread-safe and free of branches; angles in rad, in the range of mct_sincos().
 * Source: J. A. Fike, J. J. Alonso, The development of hyper-dual numbers for exact second-derivative
 * calculations, AIAA 2011-886.
 */
#ifndef MCTAU_HYPERDUAL_H
#define MCTAU_HYPERDUAL_H

#include "mctau/real.h"
#include "mctau/sincos.h"

typedef struct {
    mct_real value; /**< the function itself */
    mct_real e1;    /**< its derivative along the first direction */
    mct_real e2;    /**< its derivative along the second direction */
    mct_real e12;   /**< its second derivative, along both */
} mct_hyperdual;

/** A number that does not depend on what is differentiated. */
MCT_INLINE mct_hyperdual mct_hyperdual_constant(mct_real value)
{
    return (mct_hyperdual){value, MCT_R(0.0), MCT_R(0.0), MCT_R(0.0)};
}

MCT_INLINE mct_hyperdual mct_hyperdual_add(mct_hyperdual a, mct_hyperdual b)
{
    return (mct_hyperdual){a.value + b.value, a.e1 + b.e1, a.e2 + b.e2, a.e12 + b.e12};
}

MCT_INLINE mct_hyperdual mct_hyperdual_sub(mct_hyperdual a, mct_hyperdual b)
{
    return (mct_hyperdual){a.value - b.value, a.e1 - b.e1, a.e2 - b.e2, a.e12 - b.e12};
}

MCT_INLINE mct_hyperdual mct_hyperdual_mul(mct_hyperdual a, mct_hyperdual b)
{
    return (mct_hyperdual){
        a.value * b.value,
        a.value * b.e1 + a.e1 * b.value,
        a.value * b.e2 + a.e2 * b.value,
        a.value * b.e12 + (a.e1 * b.e2 + a.e2 * b.e1) + a.e12 * b.value,
    };
}

MCT_INLINE mct_hyperdual mct_hyperdual_scale(mct_real factor, mct_hyperdual a)
{
    return (mct_hyperdual){factor * a.value, factor * a.e1, factor * a.e2, factor * a.e12};
}

MCT_INLINE mct_hyperdual mct_hyperdual_neg(mct_hyperdual a)
{
    return (mct_hyperdual){-a.value, -a.e1, -a.e2, -a.e12};
}

/**
 * The chain rule: f(a), for a function known by its value and its first two derivatives at a.value. Use it
 * for any function that is not here (a root, a quotient), and for measured motion: base position, velocity,
 * acceleration.
 */
MCT_INLINE mct_hyperdual mct_hyperdual_compose(mct_hyperdual a, mct_real f, mct_real f_prime,
                                               mct_real f_second)
{
    return (mct_hyperdual){f, f_prime * a.e1, f_prime * a.e2, f_prime * a.e12 + f_second * (a.e1 * a.e2)};
}

/** Both functions of one angle, for the price of one mct_sincos(). */
MCT_INLINE void mct_hyperdual_sincos(mct_hyperdual angle, mct_hyperdual *sine, mct_hyperdual *cosine)
{
    mct_real s;
    mct_real c;
    mct_sincos(angle.value, &s, &c);
    *sine = mct_hyperdual_compose(angle, s, c, -s);
    *cosine = mct_hyperdual_compose(angle, c, -s, -c);
}

MCT_INLINE mct_hyperdual mct_hyperdual_sin(mct_hyperdual angle)
{
    mct_hyperdual sine;
    mct_hyperdual cosine;
    mct_hyperdual_sincos(angle, &sine, &cosine);
    return sine;
}

MCT_INLINE mct_hyperdual mct_hyperdual_cos(mct_hyperdual angle)
{
    mct_hyperdual sine;
    mct_hyperdual cosine;
    mct_hyperdual_sincos(angle, &sine, &cosine);
    return cosine;
}

#endif

/**
 * @file compensated.h
 * Sums that keep what rounding drops.
 *
 * A step adds a small increment to a large state. Its rounding error, some 1e5 times a run, is what limits
 * single precision at 1 kHz: a smaller step makes an uncompensated float state worse. Here the part that did
 * not fit is carried to the next step.
 *
 * Source: T. J. Dekker, A floating-point technique for extending the available precision (1971); W. Kahan,
 * Further remarks on reducing truncation errors (1965).
 */
#ifndef MCTAU_COMPENSATED_H
#define MCTAU_COMPENSATED_H

#include "mctau/real.h"

/**
 * The rounded sum of two numbers, and its rounding error: sum + *error equals larger + smaller exactly,
 * provided that |larger| >= |smaller| (or either is 0) and that nothing overflows. Otherwise *error is still
 * the larger part of the error. Three additions.
 */
MCT_INLINE mct_real mct_two_sum(mct_real larger, mct_real smaller, mct_real *error)
{
    const mct_real sum = larger + smaller;
    *error = smaller - (sum - larger);
    return sum;
}

/**
 * The rounded product of two numbers, and its rounding error: product + *error equals a b exactly, provided that neither
 * is beyond 1e34 and that nothing of the error is lost as a denormal. Seventeen operations.
 * Source: Dekker, as above; a number is cut in halves by G. W. Veltkamp's way.
 */
MCT_INLINE mct_real mct_two_product(mct_real a, mct_real b, mct_real *error)
{
    const mct_real cut = MCT_REAL_IS_FLOAT ? MCT_R(0x1p12 + 1) : MCT_R(0x1p27 + 1);
    const mct_real a_cut = cut * a;
    const mct_real b_cut = cut * b;
    const mct_real a_high = a_cut - (a_cut - a);
    const mct_real b_high = b_cut - (b_cut - b);
    const mct_real a_low = a - a_high;
    const mct_real b_low = b - b_high;
    const mct_real product = a * b;
    *error = a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
    return product;
}

/**
 * Adds an increment to a value that has a compensation. The represented quantity is *value + *compensation;
 * start with a compensation of 0, and set it to 0 whenever the value is set.
 *
 * An increment may exceed the value, as it does when a state passes through zero: the step then loses at
 * most a rounding of the increment, not of the sum so far. Four additions; thread-safe for distinct values.
 */
MCT_INLINE void mct_add_compensated(mct_real *value, mct_real *compensation, mct_real increment)
{
    *value = mct_two_sum(*value, increment + *compensation, compensation);
}

/**
 * Adds an increment of two parts, its rounded value and the rest, to a value that has a compensation. Nothing is lost
 * but roundings of the compensation, so a clock does not drift. Either sum may be the larger. Ten additions.
 * Source: D. E. Knuth, The Art of Computer Programming 2, 4.2.2 (the sum without an order).
 */
MCT_INLINE void mct_add_parts(mct_real *value, mct_real *compensation, mct_real increment, mct_real rest)
{
    const mct_real sum = *value + increment;
    const mct_real added = sum - *value;
    const mct_real dropped = (*value - (sum - added)) + (increment - added);
    *value = mct_two_sum(sum, *compensation + (dropped + rest), compensation);
}

#endif

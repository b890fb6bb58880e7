/*
 * Stands before the library's header where tools/bench --central compiles kernels without compensation: an increment is
 * added, and what rounding drops is lost.
 */
#ifndef MCTAU_BENCHMARK_PLAIN_COMPENSATED_H
#define MCTAU_BENCHMARK_PLAIN_COMPENSATED_H

#define mct_add_compensated mct_add_compensated_of_the_library
#include "../../../../include/mctau/compensated.h"
#undef mct_add_compensated

MCT_INLINE void mct_add_compensated(mct_real *value, const mct_real *compensation, mct_real increment)
{
    (void)compensation;
    *value += increment;
}

#endif

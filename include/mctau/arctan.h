/**
 * @file arctan.h
 * Inverse square root and direction of a planar vector, with the same bits on every target: + - * / and integers only.
 *
 * mct_inverse_root() is within 2 roundings for positive normal numbers; mct_direction() within 3 of the angle.
 * Both are thread-safe, of bounded cost, and measured in tests/math/test_arctan.c.
 */
#ifndef MCTAU_ARCTAN_H
#define MCTAU_ARCTAN_H

#include <string.h>

#include "mctau/real.h"

/** 1 / sqrt(x), x > 0 and normal: an estimate from the bits, then Newton's iteration (C. Lomont, 2003). */
MCT_INLINE mct_real mct_inverse_root(mct_real x)
{
    mct_real y;
#if MCT_REAL_IS_FLOAT
    enum { ITERATIONS = 3 };
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits = UINT32_C(0x5f375a86) - (bits >> 1);
#else
    enum { ITERATIONS = 4 };
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    bits = UINT64_C(0x5fe6eb50c7b537a9) - (bits >> 1);
#endif
    memcpy(&y, &bits, sizeof y);
    const mct_real half = MCT_R(0.5) * x;
    MCT_UNROLL
    for (int i = 0; i < ITERATIONS; i++) {
        y += y * (MCT_R(0.5) - (half * y) * y); /* (half y) y: y squared alone overflows for the smallest x */
    }
    return y;
}

/** Arc tangent for |t| <= 7/16: the polynomial of Sun's fdlibm (1993). */
MCT_INLINE mct_real mct_arctan_small(mct_real t)
{
    const mct_real z = t * t;
    const mct_real w = z * z;
    const mct_real odd =
        z *
        (MCT_R(3.33333333333329318027e-01) +
         w * (MCT_R(1.42857142725034663711e-01) +
              w * (MCT_R(9.09088713343650656196e-02) +
                   w * (MCT_R(6.66107313738753120669e-02) +
                        w * (MCT_R(4.97687799461593236017e-02) + w * MCT_R(1.62858201153657823623e-02))))));
    const mct_real even =
        w * (MCT_R(-1.99999999998764832476e-01) +
             w * (MCT_R(-1.11111104054623557880e-01) +
                  w * (MCT_R(-7.69187620504482999495e-02) +
                       w * (MCT_R(-5.83357013379057348645e-02) + w * MCT_R(-3.65315727442169155270e-02)))));
    return t - t * (odd + even);
}

/**
 * Angle of (x, y) from axis 1, counterclockwise, within +-pi [rad]. size: sqrt(x^2 + y^2), positive. Halved once, and
 * once more beyond half a right angle, so that the polynomial does.
 */
MCT_INLINE mct_real mct_direction(mct_real x, mct_real y, mct_real size)
{
    const bool ahead = x >= 0;
    const mct_real half_tangent = y / (size + (ahead ? x : -x));
    mct_real angle;
    if (half_tangent < MCT_R(0.4375) && half_tangent > MCT_R(-0.4375)) {
        angle = 2 * mct_arctan_small(half_tangent);
    } else {
        const mct_real square = 1 + half_tangent * half_tangent;
        angle = 4 * mct_arctan_small(half_tangent / (1 + square * mct_inverse_root(square)));
    }
    const mct_real half_turn = MCT_R(3.14159265358979323846);
    return ahead ? angle : (y < 0 ? -half_turn : half_turn) - angle;
}

#endif

/**
 * @file sincos.h
 * Sine and cosine together, with the same bits on every target.
 *
 * Only + - * and integer conversions, in a fixed order: without contraction, every IEEE machine gives the
 * same result, which no libm promises. No branches and no tables, so a loop over angles vectorises.
 *
 * Largest error measured, in units in the last place (tests/math/test_sincos.c repeats it on a part):
 *
 *                              |x| <= pi    |x| <= 8192    |x| <= 1e6
 *   mct_sincos_f32             0.82         0.85           -           all floats, against double
 *   mct_sincos_f64             0.82         0.83           1.7         5e7 doubles, against long double
 *   mct_sincos_turn32          0.85                                    all 2^32 angles, against double
 *   mct_sincos_turn32_f64      0.82                                    every 11th, against long double
 *
 * The angles nearest to a multiple of pi/2 are among them. Beyond those ranges the result is that of an
 * angle at most one unit in the last place away, up to 2^51 quarter turns (3.5e15 rad), in float 2^21
 * (3.3e6 rad). From there on, where neighbouring numbers lie half a radian apart, and for what is not finite,
 * both results are NaN. No input is undefined behaviour. Angles that grow belong into a binary angle.
 *
 * Method: the nearest multiple of pi/2 is taken off in parts (W. J. Cody, W. Waite, 1980), and the rounding
 * of that goes into a tail; then minimax polynomials on |r| <= 0.79 (relative error 2^-57.8 and 2^-63.8, in
 * float 2^-27.8 and 2^-32.9), their terms paired so that few wait for each other.
 */
#ifndef MCTAU_SINCOS_H
#define MCTAU_SINCOS_H

#include <string.h>

#include "mctau/real.h"

/** Sine and cosine of `quadrant` pi/2 + (r + tail), for |r| <= 0.79 and a tail of the size of a rounding. */
MCT_INLINE void mct_sincos_quadrant_f64(double r, double tail, uint64_t quadrant, double *s, double *c)
{
    const double z = r * r;
    const double zz = z * z;
    const double z4 = zz * zz;
    const double p = (-0x1.5555555555547p-3 + z * 0x1.111111110f595p-7) +
                     (zz * (-0x1.a01a019bb4435p-13 + z * 0x1.71de352632efbp-19) +
                      z4 * (-0x1.ae5e25f815641p-26 + z * 0x1.5d8040d463a9ap-33));
    const double q = (0x1.555555555554ap-5 + z * -0x1.6c16c16c14df7p-10) +
                     (zz * (0x1.a01a019c5abcap-16 + z * -0x1.27e4f7cbcb656p-22) +
                      z4 * (0x1.1ee9c216282b1p-29 + z * -0x1.8f99248d576efp-37));
    const double half = 0.5 * z;
    const double rest = 1.0 - half; /* what it drops comes back with the small terms */
    const double sine = r + ((r * z) * p + tail * rest);
    const double cosine = rest + (zz * q + (((1.0 - rest) - half) - r * tail));
    const double a = (quadrant & 1u) ? cosine : sine;
    const double b = (quadrant & 1u) ? sine : cosine;
    *s = (quadrant & 2u) ? -a : a;
    *c = ((quadrant + 1u) & 2u) ? -b : b;
}

/** The same in single precision. */
MCT_INLINE void mct_sincos_quadrant_f32(float r, float tail, uint32_t quadrant, float *s, float *c)
{
    const float z = r * r;
    const float zz = z * z;
    const float p = (-0x1.555544p-3f + z * 0x1.1106c6p-7f) + zz * -0x1.991c2cp-13f;
    const float q = (0x1.55554ap-5f + z * -0x1.6c0c1ep-10f) + zz * 0x1.99e334p-16f;
    const float half = 0.5f * z;
    const float rest = 1.0f - half;
    const float sine = r + ((r * z) * p + tail * rest);
    const float cosine = rest + (zz * q + (((1.0f - rest) - half) - r * tail));
    const float a = (quadrant & 1u) ? cosine : sine;
    const float b = (quadrant & 1u) ? sine : cosine;
    *s = (quadrant & 2u) ? -a : a;
    *c = ((quadrant + 1u) & 2u) ? -b : b;
}

/** Sine and cosine of x [rad]. Range and error: see above. Thread-safe. */
MCT_INLINE void mct_sincos_f64(double x, double *s, double *c)
{
    const double shift = 0x1.8p52; /* adding it rounds to an integer and leaves that in the low bits */
    const double shifted = x * 0x1.45f306dc9c883p-1 + shift;
    const double n = shifted - shift;
    uint64_t quadrant;
    memcpy(&quadrant, &shifted, sizeof quadrant);
    const double first = x - n * 0x1.921fb544p+0; /* parts of 33 bits: the products are exact for n < 2^20 */
    const double second = n * 0x1.0b4611a6p-34;
    const double third = n * 0x1.3198a2e037073p-69;
    const double r = first - second;
    const double excess = n * 0x1p973; /* infinite from n = 2^51 on, and then its difference is NaN */
    const double tail = (((first - r) - second) - third) + (excess - excess);
    mct_sincos_quadrant_f64(r, tail, quadrant, s, c);
}

/** Sine and cosine of x [rad] in single precision. Range and error: see above. Thread-safe. */
MCT_INLINE void mct_sincos_f32(float x, float *s, float *c)
{
    const float shift = 0x1.8p23f;
    const float shifted = x * 0x1.45f306p-1f + shift;
    const float n = shifted - shift;
    uint32_t quadrant;
    memcpy(&quadrant, &shifted, sizeof quadrant);
    const float difference = (x - n * 0x1.92p+0f) - n * 0x1.fb4p-12f; /* 11 bits: exact for n < 2^13 */
    const float third = n * 0x1.444p-24f;
    const float r = difference - third;
    const float excess = n * 0x1p107f; /* infinite from n = 2^21 on */
    const float tail = (((difference - r) - third) - n * 0x1.68c234p-39f) + (excess - excess);
    mct_sincos_quadrant_f32(r, tail, quadrant, s, c);
}

/**
 * Splits a binary angle (2^32 is one turn) into the nearest quadrant and a rest in [-2^29, 2^29). Exact: the
 * sine is 0 at no turn and at half a turn, the cosine at a quarter and at three, whichever way they are
 * reached.
 */
MCT_INLINE int32_t mct_turn32_rest(int32_t binary_angle, uint32_t *quadrant)
{
    const uint32_t eighth = UINT32_C(0x20000000);
    const uint32_t advanced = (uint32_t)binary_angle + eighth;
    *quadrant = advanced >> 30;
    return (int32_t)(advanced & UINT32_C(0x3fffffff)) - (int32_t)eighth;
}

/** Sine and cosine of a binary angle, any of the 2^32 to one turn, in single precision. Thread-safe. */
MCT_INLINE void mct_sincos_turn32(int32_t binary_angle, float *s, float *c)
{
    uint32_t quadrant;
    const int32_t rest = mct_turn32_rest(binary_angle, &quadrant);
    const int32_t low = ((rest + 0x8000) & 0xffff) - 0x8000;
    const float coarse = (float)(rest - low); /* 15 bits each: products with the 9 leading bits of the */
    const float fine = (float)low;            /* unit are exact, and show what the rounding of r dropped */
    const float r = (float)rest * 0x1.921fb6p-30f;
    const float tail = ((coarse * 0x1.92p-30f - r) + fine * 0x1.92p-30f) + (float)rest * 0x1.fb5444p-42f;
    mct_sincos_quadrant_f32(r, tail, quadrant, s, c);
}

/** The same in double precision. */
MCT_INLINE void mct_sincos_turn32_f64(int32_t binary_angle, double *s, double *c)
{
    uint32_t quadrant;
    const double rest = (double)mct_turn32_rest(binary_angle, &quadrant);
    const double coarse = rest * 0x1.921fb4p-30; /* 23 bits by 30: exact */
    const double fine = rest * 0x1.4442d18469899p-54;
    const double r = coarse + fine;
    const double tail = (coarse - r) + fine;
    mct_sincos_quadrant_f64(r, tail, quadrant, s, c);
}

/** Sine and cosine of x [rad] in the core's precision. */
MCT_INLINE void mct_sincos(mct_real x, mct_real *s, mct_real *c)
{
#if MCT_REAL_IS_FLOAT
    mct_sincos_f32(x, s, c);
#else
    mct_sincos_f64(x, s, c);
#endif
}

/** Sine and cosine of a binary angle, 2^32 to one turn, in the core's precision. */
MCT_INLINE void mct_sincos_turn(int32_t binary_angle, mct_real *s, mct_real *c)
{
#if MCT_REAL_IS_FLOAT
    mct_sincos_turn32(binary_angle, s, c);
#else
    mct_sincos_turn32_f64(binary_angle, s, c);
#endif
}

/**
 * Sine and cosine of an angle that lies `delta` from one whose sine and cosine are (s0, c0), by the addition
 * theorem and short series, which leave out less than a tenth of a rounding; beyond |delta| = 1/16 rad as
 * mct_sincos. Half its cost; two roundings more.
 */
MCT_INLINE void mct_sincos_near(mct_real angle, mct_real delta, mct_real s0, mct_real c0, mct_real *s,
                                mct_real *c)
{
    if (!(delta <= MCT_R(0.0625) && delta >= MCT_R(-0.0625))) {
        mct_sincos(angle, s, c);
        return;
    }
    const mct_real z = delta * delta;
#if MCT_REAL_IS_FLOAT
    const mct_real bend = -1.0F / 6 + z * (1.0F / 120); /* sine of delta = delta + delta z bend */
    const mct_real versine = z * (0.5F - z * (1.0F / 24));
#else
    const mct_real zz = z * z;
    const mct_real bend = (-1.0 / 6 + z * (1.0 / 120)) + zz * (-1.0 / 5040 + z * (1.0 / 362880));
    const mct_real versine = z * (0.5 - z * (1.0 / 24)) + (z * zz) * (1.0 / 720 - z * (1.0 / 40320));
#endif
    const mct_real along = c0 * delta;
    const mct_real across = s0 * delta;
    *s = s0 + (along + ((along * z) * bend - s0 * versine));
    *c = c0 - (across + ((across * z) * bend + c0 * versine));
}

#endif

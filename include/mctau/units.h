/**
 * @file units.h
 * Other units in those of the SI (source, section 8.3): 416 ounce inches are 416 * MCT_OUNCE_INCH newton
 * metres, and a torque is torque / MCT_OUNCE_INCH of them. Exact by definition; those with pi are rounded to
 * double.
 *
 * The source's round figures agree with them: 1 N m is 141.612 oz in, 1 kg cm is 1/10.197 N m, 1 kilopond
 * 9.81 N.
 */
#ifndef MCTAU_UNITS_H
#define MCTAU_UNITS_H

/* length [m] */
#define MCT_CENTIMETER 1e-2
#define MCT_MILLIMETER 1e-3
#define MCT_INCH       0.0254

/* mass [kg] */
#define MCT_GRAM  1e-3
#define MCT_POUND 0.45359237
#define MCT_OUNCE 0.028349523125 /* a sixteenth of a pound */

/* force [N] */
#define MCT_STANDARD_GRAVITY 9.80665 /* [m/s^2]: turns a mass into the force of its weight */
#define MCT_DYNE             1e-5
#define MCT_KILOPOND         9.80665
#define MCT_POUND_FORCE      4.4482216152605
#define MCT_OUNCE_FORCE      0.27801385095378125

/* torque [N m] */
#define MCT_NEWTON_MILLIMETER   1e-3
#define MCT_DYNE_CENTIMETER     1e-7
#define MCT_KILOGRAM_CENTIMETER 0.0980665
#define MCT_OUNCE_INCH          0.00706155181422604375
#define MCT_POUND_INCH          0.1129848290276167
#define MCT_POUND_FOOT          1.3558179483314004

/* angle [rad], angular velocity [rad/s] */
#define MCT_DEGREE 0.017453292519943295
#define MCT_TURN   6.283185307179586
#define MCT_RPM    0.10471975511965977 /* turns a minute */

#endif

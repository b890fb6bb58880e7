/**
 * @file start.h
 * What start.c asks of an image.
 */
#ifndef MCTAU_HAL_CORTEX_M_START_H
#define MCTAU_HAL_CORTEX_M_START_H

/** Exit code after a fault; main's own codes should differ. */
#define MCT_EXIT_FAULT 70

/**
 * How the image ends: after main, a fault or an interrupt without a handler. semihosting.c tells the debugger or emulator;
 * a board that runs alone has its own, which leaves the motor at zero volts.
 * @param said  what happened, for a reader, or NULL
 * @param code  main's, or MCT_EXIT_FAULT
 */
#ifdef __GNUC__
__attribute__((noreturn))
#endif
void mct_image_end(const char *said, int code);

#endif

/**
 * @file semihosting.h
 * Text, files and the exit code of an image, by way of the debugger or emulator that runs it. Without one the
 * processor stops here: not for an image that runs alone.
 *
 * Source: ARM, Semihosting for AArch32 and AArch64, chapter 2.
 */
#ifndef MCTAU_HAL_CORTEX_M_SEMIHOSTING_H
#define MCTAU_HAL_CORTEX_M_SEMIHOSTING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Writes a text to the host's console. */
void mct_semihosting_write(const char *text);

/** The command line that the host gives to the image, NUL-terminated; returns 0, or -1 when it is longer. */
int mct_semihosting_command_line(char *text, size_t size);

/** Opens a file of the host to read it, or makes one anew to write it; returns its number, or -1. */
int32_t mct_semihosting_open(const char *path, bool writes);

/** Reads on in an open file; returns how many bytes, at most `size`, or -1. */
int32_t mct_semihosting_read(int32_t file, void *data, size_t size);

/** Writes on in an open file; returns whether all of it was taken. */
bool mct_semihosting_append(int32_t file, const void *data, size_t size);

/** Closes an open file; returns whether all that was written has arrived. */
bool mct_semihosting_close(int32_t file);

/** Reads a file of the host from its beginning; returns how many bytes, at most `size`, or -1. */
int32_t mct_semihosting_read_file(const char *path, void *data, size_t size);

/** Ends the emulation, or hands over to the debugger. */
#ifdef __GNUC__
__attribute__((noreturn))
#endif
void mct_semihosting_exit(int code);

#endif

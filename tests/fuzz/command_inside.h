/*
 * Included ahead of everything in the command's sources (fuzz.cmake): what would leave the fuzz target's process, or
 * take long, is done by command_inside.c instead.
 */
#ifndef MCT_TEST_FUZZ_COMMAND_INSIDE_H
#define MCT_TEST_FUZZ_COMMAND_INSIDE_H

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#undef stderr
#define stderr                            fuzz_stderr
#define main                              fuzz_main
#define exit                              fuzz_exit
#define fork                              fuzz_fork
#define mct_scene_read                    fuzz_scene_read
#define sigaction(number, action, before) fuzz_sigaction() /* signals are the fuzzer's */

extern FILE *fuzz_stderr;
void fuzz_exit(int code) __attribute__((noreturn));
pid_t fuzz_fork(void);
int fuzz_sigaction(void);
int fuzz_main(int argc, char **argv);

#endif

/* The command within a fuzz target: called like a function, in a folder of its own, with short scenes. */
#ifndef MCT_TEST_FUZZ_COMMAND_H
#define MCT_TEST_FUZZ_COMMAND_H

#include <stddef.h>
#include <stdint.h>

enum { FUZZ_COMMAND_TICKS = 20 /* of a scene, at most */, FUZZ_COMMAND_FILES = 6 };

/* Makes the folder, with the files below in it: once, before all else. */
void fuzz_command_begin(void);

/* scene.toml, free.toml, csv.toml, input.csv, bus.log, and run.lcm if the build has LCM. */
const char *fuzz_command_file(int number);

/* Calls the command in the folder; afterwards it holds the files as they were and no others. */
int fuzz_command(int argc, char **argv);

/* What the last call said on stderr, as far as there is room. */
const char *fuzz_command_said(void);

/* Puts a file into the folder, until after the next call. */
void fuzz_command_put(const char *name, const uint8_t *data, size_t size);

/* The log of a run of one of the files; 0 bytes if the build has no LCM. */
size_t fuzz_command_record(const char *scene, const char *duration, uint8_t *log, size_t size);

#endif

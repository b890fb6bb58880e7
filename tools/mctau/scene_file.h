/* From a file's name and a command line to a scene. */
#ifndef MCTAU_TOOLS_SCENE_FILE_H
#define MCTAU_TOOLS_SCENE_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "mctau/scene.h"
#include "options.h"
#include "runner.h"

typedef struct {
    const arguments *given; /* the command line */
    const char *path;       /* as given; "-" is stdin */
    char *text; /* the file's text, and a line "#!set table.key=value" for each override: what a log keeps */
    csv_samples samples; /* none without */
    char *samples_path; /* where they came from */
    mct_scene scene;
    const mct_runner *runner; /* of the scene's precision */
} scene_file;

/*
 * Reads what the operand names, with the overrides. Gives 0, or says what is wrong and gives the exit code.
 */
int scene_file_read(scene_file *self, const arguments *given);

/* Adds an override to the text that a log keeps: what was chosen here, and not given. */
void scene_file_note(scene_file *self, const char *key, const char *value);

void scene_file_free(scene_file *self);

/* Whether two paths are one regular file; either may be NULL. */
bool is_same_file(const char *a, const char *b);

/* Runner of a precision, NULL when this build has not got it. */
const mct_runner *find_runner(int precision);

/* "double, float": the precisions that this build has. */
const char *runner_names(void);

#endif

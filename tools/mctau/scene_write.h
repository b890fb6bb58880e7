/* From a scene to a file that reads back as the same scene. */
#ifndef MCTAU_TOOLS_SCENE_WRITE_H
#define MCTAU_TOOLS_SCENE_WRITE_H

#include "mctau/scene.h"
#include "src/scene/tables.h"

/* A key's value as a scene has it: a number, true, "name", [1, 2]. */
const char *scene_value_text(const mct_scene *scene, const mct_scene_key *key, char *text, size_t size);

/*
 * Writes all of [scene], [parameters], [effects] and [initial], and of the other tables what is no default; `comment`,
 * lines without "#", stands ahead. The file is there in whole or as it was. Gives 0, or says what is wrong and gives the
 * exit code.
 */
int scene_write(const mct_scene *scene, const char *comment, const char *path);

#endif

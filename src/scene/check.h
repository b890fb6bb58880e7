/* What is wrong with a scene, and which key is to blame. */
#ifndef MCT_SCENE_CHECK_H
#define MCT_SCENE_CHECK_H

#include "tables.h"

typedef struct {
    const char *table;
    const char *key;   /* or the name of a vector */
    char key_text[48]; /* what `key` points to when no descriptor has it */
} mct_blame;

/* As mct_scene_check, but with the key to blame apart from the sentence about it. */
mct_status mct_scene_examine(const mct_scene *scene, mct_blame *blame, mct_message *sentence);

/* Whether a number is one that the field allows. */
bool mct_field_allows(const mct_field *field, double value);

/* Adds what a key of a system allows: "0.001 to 1 s", "true or false", "none, constant, sine". */
void mct_message_add_allowed(mct_message *message, const mct_scene_key *key, const mct_system *system);

/* Checks the numbers of a list, and its rows; adds what is wrong. */
mct_status mct_list_examine(const mct_scene_key *key, const mct_system *system, const mct_list *list,
                            mct_message *sentence);

/* Adds a unit, a blank ahead of it; nothing for a pure number. */
void mct_message_add_unit(mct_message *message, const mct_field *field);

/* Whether a kind of input reads a key of [input]. */
bool mct_input_reads(int32_t kind, const char *key);

#endif

/*
 * Every key that a scene of a system may have, as one list of tables: the fixed ones of mct_scene_tables and
 * those that follow from the system's descriptor. Reader, check, listings and the compile step walk it.
 */
#ifndef MCT_SCENE_TABLES_H
#define MCT_SCENE_TABLES_H

#include "mctau/scene.h"

/* The fixed tables, then [parameters], [effects], [initial], [weights]. */
enum {
    MCT_TABLE_PARAMETERS = MCT_SCENE_TABLE_COUNT,
    MCT_TABLE_EFFECTS,
    MCT_TABLE_INITIAL,
    MCT_TABLE_WEIGHTS,
    MCT_TABLE_COUNT
};

typedef struct {
    mct_field field;          /* `offset` is that in mct_scene */
    const mct_effect *effect; /* an effect, whose bits lie in mct_scene.effects; else NULL */
    const mct_row_list *rows; /* of a list of a system; else NULL */
    bool is_real;             /* whatever it is, it is stored as double */
} mct_scene_key;

const char *mct_table_name(int table);

/* Keys of a table for a system, by number: fixed ones first, then those of the system. */
int mct_key_count(int table, const mct_system *system);
mct_scene_key mct_key_at(int table, const mct_system *system, int number);

/* Name of a choice by its index, or NULL beyond the last. Systems and steppers get their names from their own
 * tables. */
const char *mct_choice_name(const mct_field *field, int32_t index);

/* A key's value as a number (booleans 0 or 1, choices their index); not for texts and lists. */
double mct_key_get(const mct_scene *scene, const mct_scene_key *key);
void mct_key_set(mct_scene *scene, const mct_scene_key *key, double value);

/* The most accurate stepper that suits a scene as it stands, but no series; MCT_STEPPER_RK4 when none does. */
int32_t mct_best_stepper(const mct_scene *scene);

/* Whether a stepper has a kernel for the scene and can follow its motor. */
bool mct_stepper_suits(const mct_scene *scene, int stepper);

/* h R / L of an inductive motor at the scene's step; 0 without one. */
double mct_motor_stiffness(const mct_scene *scene);

#endif

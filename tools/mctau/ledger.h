/* A ledger of energy, for scripts and for people: powers at a state, or the works of a run. */
#ifndef MCTAU_TOOLS_LEDGER_H
#define MCTAU_TOOLS_LEDGER_H

#include <stdio.h>

#include "json.h"
#include "mctau/scene.h"
#include "powers.h"

/* A member for each power that the scene knows, by its name. */
void json_powers(json *out, const char *key, const powers *self, const mct_scene *scene);
void json_energies(json *out, const char *key, const energies *self);

/* A table of energies: its head, and rows; one for each power, with what it brings to each energy. */
void print_energies_head(FILE *file, const char *title);
void print_powers(FILE *file, const powers *self, const mct_scene *scene);
void print_energies(FILE *file, const char *name, const energies *self);

#endif

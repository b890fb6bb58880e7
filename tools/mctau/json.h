/*
 * Writes JSON, indented, one value a line; a vector of numbers is one value.
 *
 * Numbers have 17 significant digits, so a double reads back as the same double; what is not finite is null.
 * Every call takes the key of an object's member, or NULL within a list.
 */
#ifndef MCTAU_TOOLS_JSON_H
#define MCTAU_TOOLS_JSON_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct {
    FILE *file;
    int depth;
    bool filled; /* the innermost object or list has a member */
} json;

/* Begins the outermost object, whose first member is the schema's name and version, as "mctau.run/1". */
json json_begin(FILE *file, const char *schema);
/* Ends the outermost object. */
void json_finish(json *self);

void json_object(json *self, const char *key);
void json_end_object(json *self);
void json_list(json *self, const char *key);
void json_end_list(json *self);

void json_text(json *self, const char *key, const char *text); /* NULL: null */
void json_number(json *self, const char *key, double value);
void json_integer(json *self, const char *key, int64_t value);
void json_count(json *self, const char *key, uint64_t value);
void json_boolean(json *self, const char *key, bool value);
/* The bits of a number, as a text in C's hexadecimal notation. */
void json_hex(json *self, const char *key, double value);
/* A list of numbers on one line. */
void json_vector(json *self, const char *key, const double *values, int count);

#endif

/*
 * Verbs and their options. One table per verb drives the parser and --help, and is what a shell completion
 * will need.
 */
#ifndef MCTAU_TOOLS_OPTIONS_H
#define MCTAU_TOOLS_OPTIONS_H

#include <stdbool.h>
#include <stdio.h>

#include "mctau/scene.h"

#define MAX_OPTIONS 24

typedef struct {
    const char *name;     /* behind the two dashes; behind one if it is a letter */
    const char *argument; /* what --help calls its argument; NULL for a switch */
    const char *key;      /* "table.key" of the scene that it stands for, ANY_KEY for --set, NULL for none */
    const char *doc;      /* one line; NULL: what the key's descriptor says */
} option;

#define ANY_KEY ""

/* Options that all verbs with a scene have. */
#define OPTION_SET                                                                                        \
    {                                                                                                     \
        "set", "TABLE.KEY=VALUE", ANY_KEY, "any value of the scene, as often as wanted; a later one wins" \
    }
#define OPTION_JSON                                                                           \
    {                                                                                         \
        "json", NULL, NULL, "the result as one JSON object on stdout, and nothing else there" \
    }

struct arguments;

typedef struct {
    const char *name;
    const char *doc; /* one line, for the list of verbs */
    const char *
        operand; /* what its one operand is called, "[...]" when it may be left out, "...]" when there may be more */
    const char *text;      /* what it does and what comes out */
    const option *options; /* ends with an empty row */
    const char *examples;  /* one a line */
    const char *exit_codes;
    int (*run)(const struct arguments *given); /* gives the exit code */
} verb;

/* What a command line asks for. */
typedef struct arguments {
    const char *program; /* as called: what hints name */
    const verb *verb;
    const char *operand;   /* NULL when left out */
    char *const *operands; /* all of them, where there may be more than one */
    int operand_count;
    const char *values[MAX_OPTIONS]; /* by row of the verb's table; NULL when not given, "" for a switch */
    mct_override *overrides;         /* --set and the short cuts, in their order */
    int override_count;
} arguments;

/* Argument of an option, "" for a switch; NULL when it was not given. */
const char *arguments_value(const arguments *self, const char *name);

/*
 * Reads a command line; argv[0] is the verb's name.
 * Returns true when the verb shall run. Otherwise *exit_code says how to end: help was printed, or a
 * complaint.
 */
bool arguments_read(arguments *self, const verb *asked, int argc, char **argv, int *exit_code);

void arguments_free(arguments *self);

/* Writes what a verb does, its options, examples and exit codes. */
void print_help(const verb *self, FILE *file);

#endif

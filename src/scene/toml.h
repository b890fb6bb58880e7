/*
 * A strict subset of TOML 1.0: tables, bare keys, `table.key = value` ahead of the first table, numbers,
 * booleans, texts of one line, lists and lists of lists, comments, CRLF, a byte order mark. What it accepts, TOML
 * accepts with the same meaning (but for the mark, of which TOML 1.0 says nothing). What TOML forbids is
 * refused with the reason; what TOML has and the subset has not is refused by saying so.
 *
 * The text is not copied: entries point into it.
 */
#ifndef MCT_SCENE_TOML_H
#define MCT_SCENE_TOML_H

#include <stdint.h>

#include "mctau/message.h"
#include "mctau/status.h"
#include "text.h"

enum {
    MCT_TOML_ENTRIES = 128,   /* a scene has some 80 keys */
    MCT_TOML_TABLES = 32,     /* and ten tables */
    MCT_TOML_LENGTH = 1 << 20 /* bytes of a text */
};

typedef enum {
    MCT_TOML_INTEGER,
    MCT_TOML_REAL,
    MCT_TOML_BOOLEAN,
    MCT_TOML_TEXT,
    MCT_TOML_LIST
} mct_toml_kind;

typedef struct {
    mct_span table;
    mct_span key;
    mct_span source; /* the value as written */
    mct_toml_kind kind;
    bool is_bare;         /* a text from outside of a file, without quotes: `source` as it stands */
    int32_t line, column; /* of the key, from 1; columns count bytes */
    int32_t count;        /* items of a list */
    int64_t integer;      /* an integer; 0 or 1 of a boolean */
    double number;        /* an integer or a real */
} mct_toml_entry;

typedef struct {
    mct_span name;
    int32_t line, column;
} mct_toml_table;

typedef struct {
    int entry_count;
    int table_count;
    mct_toml_entry entries[MCT_TOML_ENTRIES];
    mct_toml_table tables[MCT_TOML_TABLES];
} mct_toml;

/* Reads a text. MCT_ERROR_SYNTAX or MCT_ERROR_BOUND, with "origin:line:column: ..." in `why`. */
mct_status mct_toml_read(const char *text, size_t length, const char *origin, mct_toml *toml,
                         mct_message *why);

/* Splits "table.key=value" and leaves the value, without the blanks around it, in `source`. Refuses what no
 * text of TOML may contain. MCT_ERROR_SYNTAX, with "origin: ..." in `why`. */
mct_status mct_toml_split(const char *assignment, const char *origin, mct_toml_entry *entry,
                          mct_message *why);

/* Reads `source` of a split assignment as one value. Whoever wants a bare text sets `kind` and `is_bare`
 * instead. */
mct_status mct_toml_read_value(const char *origin, mct_toml_entry *entry, mct_message *why);

/* The decoded text of a MCT_TOML_TEXT and its length in bytes, which may be more than was written:
 * `capacity`, NUL included. */
size_t mct_toml_text(const mct_toml_entry *entry, char *text, size_t capacity);

/* The next item of a MCT_TOML_LIST, `position` being 0 for the first; false behind the last. */
bool mct_toml_item(const mct_toml_entry *list, size_t *position, mct_toml_entry *item);

#endif

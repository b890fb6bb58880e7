#include "csv_input.h"

#include <csv.h>
#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "mctau/scene.h"
#include "say.h"

typedef struct {
    const char *path;
    const char *column;
    long long line;      /* being read */
    bool has_header;     /* the first line is behind */
    size_t field;        /* of the line, from 0 */
    bool found;          /* the header has the column */
    size_t wanted;       /* which field it is */
    bool taken;          /* the line had it */
    mct_message headers; /* for a complaint */
    const mct_field *range;
    double *samples;
    size_t count, capacity;
    mct_status status; /* of the first thing wrong; the rest is then passed over */
    mct_message *why;
} reader;

static mct_status refuse(reader *self, mct_status status, const char *sentence)
{
    mct_message_clear(self->why);
    mct_message_add(self->why, self->path);
    if (self->line > 0) {
        mct_message_add(self->why, ":");
        mct_message_add_integer(self->why, self->line);
    }
    mct_message_add(self->why, ": ");
    mct_message_add(self->why, self->column);
    mct_message_add(self->why, ": ");
    mct_message_add(self->why, sentence);
    self->status = status;
    return status;
}

static void refuse_number(reader *self, const char *text, const char *reason)
{
    enum { SHOWN = 40 };
    refuse(self, MCT_ERROR_RANGE, "found ");
    mct_message_add(self->why, text[0] == '\0' ? "nothing" : "");
    mct_message_add_span(self->why, text, SHOWN);
    mct_message_add(self->why, reason);
    mct_message_add(self->why, "; allowed a number from ");
    mct_message_add_number(self->why, self->range->minimum);
    mct_message_add(self->why, " to ");
    mct_message_add_number(self->why, self->range->maximum);
}

static void take_number(reader *self, const char *text)
{
    char *end;
    const double value = strtod(text, &end);
    if (end == text || *end != '\0') {
        refuse_number(self, text, "");
    } else if (!isfinite(value)) {
        refuse_number(self, text, ", which is not finite");
    } else if (value < self->range->minimum || value > self->range->maximum) {
        refuse_number(self, text, "");
    } else {
        if (self->count == self->capacity) {
            self->capacity = self->capacity > 0 ? 2 * self->capacity : 4096;
            self->samples = need_memory(realloc(self->samples, self->capacity * sizeof *self->samples));
        }
        self->samples[self->count++] = value;
        self->taken = true;
    }
}

static void take_header(reader *self, const char *text)
{
    mct_message_add(&self->headers, self->field > 0 ? ", " : "");
    mct_message_add(&self->headers, text);
    if (!self->found && strcmp(text, self->column) == 0) {
        self->found = true;
        self->wanted = self->field;
    }
}

static void on_field(void *text, size_t length, void *context)
{
    reader *self = context;
    (void)length; /* the text ends in NUL */
    const char *shown = text != NULL ? text : "";
    if (self->status == MCT_OK && !self->has_header) {
        take_header(self, shown);
    } else if (self->status == MCT_OK && self->field == self->wanted) {
        take_number(self, shown);
    }
    self->field++;
}

static void on_row(int terminator, void *context)
{
    reader *self = context;
    (void)terminator;
    if (self->status == MCT_OK && !self->has_header && !self->found) {
        refuse(self, MCT_ERROR_RANGE, "found no such column; allowed ");
        mct_message_add(self->why, self->headers.text);
    } else if (self->status == MCT_OK && self->has_header && !self->taken) {
        refuse(self, MCT_ERROR_SYNTAX, "found a row that ends before this column: ");
        mct_message_add_integer(self->why, (long long)self->field);
        mct_message_add(self->why, self->field == 1 ? " field" : " fields");
        mct_message_add(self->why, "; allowed at least ");
        mct_message_add_integer(self->why, (long long)self->wanted + 1);
    }
    self->has_header = true;
    self->field = 0;
    self->taken = false;
}

/* Hands the text over line by line, so that the reader knows where it is. */
static void parse(reader *self, struct csv_parser *parser, char *text, size_t length)
{
    size_t begin = length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0; /* a byte-order mark */
    while (begin < length && self->status == MCT_OK) {
        const char *newline = memchr(text + begin, '\n', length - begin);
        const size_t end = newline != NULL ? (size_t)(newline - text) + 1 : length;
        self->line++;
        if (csv_parse(parser, text + begin, end - begin, on_field, on_row, self) != end - begin) {
            refuse(self, MCT_ERROR_SYNTAX, "found what is not CSV: ");
            mct_message_add(self->why, csv_strerror(csv_error(parser)));
            return;
        }
        begin = end;
    }
    if (self->status == MCT_OK && csv_fini(parser, on_field, on_row, self) != 0) {
        refuse(self, MCT_ERROR_SYNTAX, "found a quote that does not end");
    }
    if (self->status == MCT_OK && self->count == 0) {
        refuse(self, MCT_ERROR_SYNTAX,
               self->has_header ? "found no row below the headers" : "found an empty file");
        mct_message_add(self->why, "; allowed a line of headers and one row a tick");
    }
}

static char *read_file(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return NULL;
    }
    char *text = NULL;
    size_t capacity = 0;
    *length = 0;
    do {
        capacity = capacity > 0 ? 2 * capacity : 65536;
        text = need_memory(realloc(text, capacity));
        *length += fread(text + *length, 1, capacity - *length, file);
    } while (*length == capacity);
    const int reason = ferror(file) ? errno : 0;
    fclose(file);
    if (reason != 0) {
        free(text);
        errno = reason;
        return NULL;
    }
    return text;
}

/* The range of an input is that of input.values. */
static const mct_field *input_range(void)
{
    for (int i = 0; i < MCT_SCENE_TABLE_COUNT; i++) {
        for (int j = 0; j < mct_scene_tables[i].field_count; j++) {
            const mct_field *field = &mct_scene_tables[i].fields[j];
            if (field->offset == offsetof(mct_scene, input_values)) {
                return field;
            }
        }
    }
    return NULL;
}

mct_status csv_input_read(const char *path, const char *column, double **samples, size_t *count,
                          mct_message *why)
{
    reader self = {.path = path, .column = column, .range = input_range(), .status = MCT_OK, .why = why};
    struct csv_parser parser;
    size_t length;
    mct_message_clear(why);
    char *text = read_file(path, &length);
    if (text == NULL) {
        mct_message_add(why, path);
        mct_message_add(why, ": the file of input.file cannot be read: ");
        mct_message_add(why, strerror(errno));
        return MCT_ERROR_IO;
    }
    need_memory(csv_init(&parser, CSV_STRICT | CSV_STRICT_FINI | CSV_APPEND_NULL) == 0 ? text : NULL);
    parse(&self, &parser, text, length);
    csv_free(&parser);
    free(text);
    if (self.status != MCT_OK) {
        free(self.samples);
        return self.status;
    }
    *samples = self.samples;
    *count = self.count;
    return MCT_OK;
}

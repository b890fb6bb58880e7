#include "json.h"

#include <inttypes.h>
#include <math.h>

static void write_text(FILE *file, const char *text)
{
    fputc('"', file);
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; c++) {
        if (*c == '"' || *c == '\\') {
            fprintf(file, "\\%c", *c);
        } else if (*c < 0x20 || *c == 0x7f) {
            fprintf(file, "\\u%04x", *c);
        } else {
            fputc(*c, file);
        }
    }
    fputc('"', file);
}

static void write_number(FILE *file, double value)
{
    if (isfinite(value)) {
        fprintf(file, "%.17g", value);
    } else {
        fputs("null", file);
    }
}

static void new_line(json *self)
{
    fprintf(self->file, "\n%*s", 2 * self->depth, "");
}

/* Whatever stands before a value: comma, line, key. */
static void begin(json *self, const char *key)
{
    fputs(self->filled ? "," : "", self->file);
    new_line(self);
    self->filled = true;
    if (key != NULL) {
        write_text(self->file, key);
        fputs(": ", self->file);
    }
}

static void open_with(json *self, const char *key, char bracket)
{
    begin(self, key);
    fputc(bracket, self->file);
    self->depth++;
    self->filled = false;
}

static void close_with(json *self, char bracket)
{
    self->depth--;
    if (self->filled) {
        new_line(self);
    }
    fputc(bracket, self->file);
    self->filled = true;
}

json json_begin(FILE *file, const char *schema)
{
    json self = {.file = file, .depth = 1};
    fputc('{', file);
    json_text(&self, "schema", schema);
    return self;
}

void json_finish(json *self)
{
    close_with(self, '}');
    fputc('\n', self->file);
}

void json_object(json *self, const char *key)
{
    open_with(self, key, '{');
}

void json_end_object(json *self)
{
    close_with(self, '}');
}

void json_list(json *self, const char *key)
{
    open_with(self, key, '[');
}

void json_end_list(json *self)
{
    close_with(self, ']');
}

void json_text(json *self, const char *key, const char *text)
{
    begin(self, key);
    if (text != NULL) {
        write_text(self->file, text);
    } else {
        fputs("null", self->file);
    }
}

void json_number(json *self, const char *key, double value)
{
    begin(self, key);
    write_number(self->file, value);
}

void json_integer(json *self, const char *key, int64_t value)
{
    begin(self, key);
    fprintf(self->file, "%" PRId64, value);
}

void json_count(json *self, const char *key, uint64_t value)
{
    begin(self, key);
    fprintf(self->file, "%" PRIu64, value);
}

void json_boolean(json *self, const char *key, bool value)
{
    begin(self, key);
    fputs(value ? "true" : "false", self->file);
}

void json_hex(json *self, const char *key, double value)
{
    begin(self, key);
    fprintf(self->file, "\"%a\"", value);
}

void json_vector(json *self, const char *key, const double *values, int count)
{
    begin(self, key);
    fputc('[', self->file);
    for (int i = 0; i < count; i++) {
        fputs(i > 0 ? ", " : "", self->file);
        write_number(self->file, values[i]);
    }
    fputc(']', self->file);
}

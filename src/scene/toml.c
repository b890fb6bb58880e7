#include "toml.h"

#include <string.h>

#include "number.h"

typedef struct {
    const char *text;
    size_t length;
    size_t position;
    size_t line_start;
    int32_t line; /* from 1; 0 for an assignment from outside of a file */
    const char *origin;
    mct_message *why;
    const mct_toml_entry *entry; /* whose value it is, when it does not come from a file */
} scanner;

static const char outside[] = " is TOML, but outside of the subset that scenes use";

/* --- what is wrong, and where --- */

static void begin_fault(const scanner *self, size_t position)
{
    mct_message_clear(self->why);
    mct_message_add(self->why, self->origin);
    if (self->line > 0) {
        mct_message_add(self->why, ":");
        mct_message_add_integer(self->why, self->line);
        mct_message_add(self->why, ":");
        mct_message_add_integer(self->why, (long long)(position - self->line_start) + 1);
    }
    mct_message_add(self->why, ": ");
    if (self->entry != NULL) {
        mct_message_add_span(self->why, self->entry->table.start, self->entry->table.length);
        mct_message_add(self->why, ".");
        mct_message_add_span(self->why, self->entry->key.start, self->entry->key.length);
        mct_message_add(self->why, ": ");
    }
}

static mct_status fault_at(const scanner *self, size_t position, const char *what, const char *more)
{
    begin_fault(self, position);
    mct_message_add(self->why, what);
    mct_message_add(self->why, more);
    return MCT_ERROR_SYNTAX;
}

static mct_status fault(const scanner *self, const char *what)
{
    return fault_at(self, self->position, what, "");
}

/* A quotation that stays short whatever is in the file. */
static void add_quoted(mct_message *why, mct_span span)
{
    enum { SHOWN = 40 };
    mct_message_add(why, "'");
    mct_message_add_span(why, span.start, span.length < SHOWN ? span.length : SHOWN);
    mct_message_add(why, span.length > SHOWN ? "...'" : "'");
}

static mct_status fault_quoting(const scanner *self, size_t position, mct_span span, const char *what)
{
    begin_fault(self, position);
    add_quoted(self->why, span);
    mct_message_add(self->why, what);
    return MCT_ERROR_SYNTAX;
}

/* --- the text --- */

static bool at_end(const scanner *self)
{
    return self->position >= self->length;
}

/* The byte at an offset from here; NUL, which the text does not contain, beyond the end. */
static char peek(const scanner *self, size_t offset)
{
    return self->length - self->position > offset ? self->text[self->position + offset] : '\0';
}

static bool at_newline(const scanner *self)
{
    return peek(self, 0) == '\n' || peek(self, 0) == '\r'; /* a CR has been checked to stand before an LF */
}

static void skip_newline(scanner *self)
{
    self->position += peek(self, 0) == '\r' ? 2 : 1;
    self->line += self->line > 0 ? 1 : 0;
    self->line_start = self->position;
}

static void skip_blanks(scanner *self)
{
    while (peek(self, 0) == ' ' || peek(self, 0) == '\t') {
        self->position++;
    }
}

static void skip_comment(scanner *self)
{
    if (peek(self, 0) == '#') {
        while (!at_end(self) && !at_newline(self)) {
            self->position++;
        }
    }
}

/* Refuses what may stand nowhere in a TOML text: invalid UTF-8, control characters. Hence nothing below meets
 * them. */
static mct_status check_characters(const scanner *start)
{
    scanner self = *start;
    while (!at_end(&self)) {
        const size_t left = self.length - self.position;
        const size_t size = mct_utf8_length(self.text + self.position, left);
        const unsigned char c = (unsigned char)peek(&self, 0);
        if (size == 0) {
            return fault(&self, "these bytes are not UTF-8");
        }
        if (c == '\n' || (c == '\r' && peek(&self, 1) == '\n')) {
            skip_newline(&self);
            continue;
        }
        if ((c < 0x20 && c != '\t') || c == 0x7F) {
            static const char hexadecimal[] = "0123456789ABCDEF";
            const char code[] = {hexadecimal[c >> 4], hexadecimal[c & 15], '\0'};
            return fault_at(&self, self.position, "a control character, U+00", code);
        }
        self.position += size;
    }
    return MCT_OK;
}

/* --- values --- */

/* A run of bytes that may be a number, a boolean or a date. */
static mct_span peek_word(const scanner *self)
{
    const char *const ends = " \t\r\n,[]{}#=\"'";
    size_t size = 0;
    while (self->position + size < self->length) {
        const char c = self->text[self->position + size];
        size_t i = 0;
        while (ends[i] != '\0' && ends[i] != c) {
            i++;
        }
        if (ends[i] != '\0') {
            break;
        }
        size++;
    }
    const mct_span word = {self->text + self->position, size};
    return word;
}

static bool looks_like_date(mct_span word)
{
    size_t digits = 0;
    while (digits < word.length && mct_is_digit(word.start[digits])) {
        digits++;
    }
    return digits + 1 < word.length && mct_is_digit(word.start[digits + 1]) &&
           ((digits == 4 && word.start[digits] == '-') || (digits == 2 && word.start[digits] == ':'));
}

static mct_status read_number(scanner *self, mct_number *number)
{
    const mct_span word = peek_word(self);
    if (looks_like_date(word)) {
        return fault_at(self, self->position, "a date or a time", outside);
    }
    const char *const wrong = mct_number_read(word, number);
    if (wrong != NULL && word.length > 0) {
        begin_fault(self, self->position);
        add_quoted(self->why, word);
        mct_message_add(self->why, ": ");
        mct_message_add(self->why, wrong);
        return MCT_ERROR_SYNTAX;
    }
    if (wrong != NULL) {
        return fault(self, "a value is missing");
    }
    self->position += word.length;
    return MCT_OK;
}

static bool at_triple_quote(const scanner *self, char quote)
{
    return peek(self, 0) == quote && peek(self, 1) == quote && peek(self, 2) == quote;
}

/* The value of `count` hexadecimal digits at an offset from here; -1 when there are fewer. */
static int32_t read_hexadecimal(const scanner *self, size_t offset, size_t count)
{
    uint32_t value = 0;
    for (size_t i = 0; i < count; i++) {
        const char c = peek(self, offset + i);
        const bool letter = (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
        if (!mct_is_digit(c) && !letter) {
            return -1;
        }
        value = value << 4 | (uint32_t)(letter ? (c | 0x20) - 'a' + 10 : c - '0');
    }
    return value > 0x10FFFF || (value >= 0xD800 && value < 0xE000) ? -1 : (int32_t)value;
}

/* The character behind a backslash and how many bytes of the text it takes, backslash included; -1 when there
 * is none such. */
static int32_t read_escape(const scanner *self, size_t *size)
{
    static const char letters[] = "btnfr\"\\";
    static const char characters[] = "\b\t\n\f\r\"\\";
    const char c = peek(self, 1);
    if (c == 'u' || c == 'U') {
        const size_t digits = c == 'u' ? 4 : 8;
        *size = 2 + digits;
        return read_hexadecimal(self, 2, digits);
    }
    *size = 2;
    for (size_t i = 0; letters[i] != '\0'; i++) {
        if (letters[i] == c) {
            return characters[i];
        }
    }
    return -1;
}

static mct_status skip_text(scanner *self)
{
    const char quote = peek(self, 0);
    const size_t start = self->position;
    if (at_triple_quote(self, quote)) {
        return fault_at(self, start, "a text of several lines", outside);
    }
    self->position++;
    while (peek(self, 0) != quote) {
        if (at_end(self) || at_newline(self)) {
            return fault_at(self, start, "this text has no closing quote on its line", "");
        }
        size_t size = 1;
        if (quote == '"' && peek(self, 0) == '\\' && read_escape(self, &size) < 0) {
            return fault(self, "not an escape; these are: \\b \\t \\n \\f \\r \\\" \\\\ \\uXXXX \\UXXXXXXXX; "
                               "or use '...'");
        }
        self->position += size;
    }
    self->position++;
    return MCT_OK;
}

static void skip_between_items(scanner *self)
{
    size_t before;
    do {
        before = self->position;
        skip_blanks(self);
        skip_comment(self);
        if (at_newline(self)) {
            skip_newline(self);
        }
    } while (self->position > before);
}

enum { MOST_DEPTH = 2 }; /* of lists within lists */

static mct_status read_value(scanner *self, int depth, mct_toml_entry *entry);

static mct_status read_list(scanner *self, int depth, int32_t *count)
{
    const scanner start = *self;
    *count = 0;
    self->position++;
    for (;;) {
        skip_between_items(self);
        if (at_end(self)) {
            return fault_at(&start, start.position, "this list has no closing bracket", "");
        }
        if (peek(self, 0) == ']') {
            break;
        }
        mct_toml_entry item;
        const mct_status status = read_value(self, depth, &item);
        if (status != MCT_OK) {
            return status;
        }
        ++*count;
        skip_between_items(self);
        if (peek(self, 0) == ',') {
            self->position++;
        } else if (!at_end(self) && peek(self, 0) != ']') {
            return fault(self, "a comma or a closing bracket is missing in the list");
        }
    }
    self->position++;
    return MCT_OK;
}

/* `depth`: lists around the value. At most MOST_DEPTH + 1 calls deep. */
static mct_status read_value(scanner *self, int depth, mct_toml_entry *entry)
{
    const size_t start = self->position;
    const char c = peek(self, 0);
    const mct_span word = peek_word(self);
    mct_status status = MCT_OK;
    entry->is_bare = false;
    entry->count = 0;
    entry->integer = 0;
    entry->number = 0;
    if (c == '"' || c == '\'') {
        entry->kind = MCT_TOML_TEXT;
        status = skip_text(self);
    } else if (c == '[' && depth == MOST_DEPTH) {
        status = fault_at(self, start, "a list of lists of lists", outside);
    } else if (c == '[') {
        entry->kind = MCT_TOML_LIST;
        status = read_list(self, depth + 1, &entry->count);
    } else if (c == '{') {
        status = fault_at(self, start, "a table within a line", outside);
    } else if (mct_span_is(word, "true") || mct_span_is(word, "false")) {
        entry->kind = MCT_TOML_BOOLEAN;
        entry->integer = mct_span_is(word, "true") ? 1 : 0;
        self->position += word.length;
    } else {
        mct_number number;
        status = read_number(self, &number);
        if (status == MCT_OK) {
            entry->kind = number.is_integer ? MCT_TOML_INTEGER : MCT_TOML_REAL;
            entry->integer = number.integer;
            entry->number = number.value;
        }
    }
    entry->source.start = self->text + start;
    entry->source.length = self->position - start;
    return status;
}

/* --- keys and tables --- */

static mct_status read_bare_key(scanner *self, const char *what, mct_span *key)
{
    const char c = peek(self, 0);
    if (c == '"' || c == '\'') {
        return fault_at(self, self->position, "a key in quotes", outside);
    }
    size_t size = 0;
    for (;;) {
        const char k = peek(self, size);
        if (!mct_is_digit(k) && !(k >= 'a' && k <= 'z') && !(k >= 'A' && k <= 'Z') && k != '_' && k != '-') {
            break;
        }
        size++;
    }
    if (size == 0) {
        return fault_at(self, self->position, what, " is missing (letters, digits, '_' and '-')");
    }
    key->start = self->text + self->position;
    key->length = size;
    self->position += size;
    return MCT_OK;
}

static mct_toml_table *find_table(mct_toml *toml, mct_span name)
{
    for (int i = 0; i < toml->table_count; i++) {
        if (mct_span_equal(toml->tables[i].name, name)) {
            return &toml->tables[i];
        }
    }
    return NULL;
}

static mct_status add_table(const scanner *self, size_t position, mct_toml *toml, mct_span name)
{
    if (toml->table_count == MCT_TOML_TABLES) {
        fault_at(self, position, "more tables than a scene can have", "");
        return MCT_ERROR_BOUND;
    }
    mct_toml_table *const table = &toml->tables[toml->table_count++];
    table->name = name;
    table->line = self->line;
    table->column = (int32_t)(position - self->line_start) + 1;
    return MCT_OK;
}

static mct_status read_header(scanner *self, mct_toml *toml, mct_span *table)
{
    const size_t start = self->position;
    if (peek(self, 1) == '[') {
        return fault_at(self, start, "a list of tables", outside);
    }
    self->position++;
    skip_blanks(self);
    const size_t position = self->position;
    mct_status status = read_bare_key(self, "the name of a table", table);
    if (status != MCT_OK) {
        return status;
    }
    skip_blanks(self);
    if (peek(self, 0) == '.') {
        return fault_at(self, position, "a table within a table", outside);
    }
    if (peek(self, 0) != ']') {
        return fault(self, "the closing bracket of the table's name is missing");
    }
    self->position++;
    const mct_toml_table *const first = find_table(toml, *table);
    if (first != NULL) {
        status = fault_quoting(self, position, *table, " begins a second time; the first is in line ");
        mct_message_add_integer(self->why, first->line);
        return status;
    }
    return add_table(self, position, toml, *table);
}

/* Reads "key =" or "table.key =", and the blanks behind it. `table` is that of the last header, empty ahead
 * of the first. */
static mct_status read_key(scanner *self, mct_span table, mct_toml_entry *entry)
{
    const size_t start = self->position;
    mct_span first;
    mct_status status = read_bare_key(self, "a key", &first);
    if (status != MCT_OK) {
        return status;
    }
    skip_blanks(self);
    entry->table = table;
    entry->key = first;
    entry->line = self->line;
    entry->column = (int32_t)(start - self->line_start) + 1;
    if (peek(self, 0) == '.') {
        self->position++;
        skip_blanks(self);
        entry->table = first;
        status = read_bare_key(self, "a key", &entry->key);
        if (status != MCT_OK) {
            return status;
        }
        skip_blanks(self);
        if (table.length > 0 || peek(self, 0) == '.') {
            return fault_at(self, start, "a table within a table", outside);
        }
    }
    if (peek(self, 0) != '=') {
        const mct_span key = {first.start, (size_t)(entry->key.start + entry->key.length - first.start)};
        return fault_quoting(self, self->position, key, " is not followed by '='");
    }
    if (entry->table.length == 0) {
        return fault_quoting(self, start, first, " belongs to no table: put it below a line such as [scene]");
    }
    self->position++;
    skip_blanks(self);
    return MCT_OK;
}

static mct_status read_entry(scanner *self, mct_toml *toml, mct_span table)
{
    const size_t start = self->position;
    const scanner at_key = *self;
    if (toml->entry_count == MCT_TOML_ENTRIES) {
        fault(self, "more keys than a scene can have");
        return MCT_ERROR_BOUND;
    }
    mct_toml_entry *const entry = &toml->entries[toml->entry_count];
    mct_status status = read_key(self, table, entry);
    if (status != MCT_OK) {
        return status;
    }
    for (int i = 0; i < toml->entry_count; i++) {
        const mct_toml_entry *const other = &toml->entries[i];
        if (mct_span_equal(other->table, entry->table) && mct_span_equal(other->key, entry->key)) {
            status =
                fault_quoting(&at_key, start, entry->key, " is given a second time; the first is in line ");
            mct_message_add_integer(self->why, other->line);
            return status;
        }
    }
    if (find_table(toml, entry->table) == NULL) {
        status = add_table(&at_key, start, toml, entry->table);
        if (status != MCT_OK) {
            return status;
        }
    }
    if (at_end(self) || at_newline(self) || peek(self, 0) == '#') {
        return fault_quoting(self, self->position, entry->key, " has no value");
    }
    status = read_value(self, 0, entry);
    toml->entry_count += status == MCT_OK ? 1 : 0;
    return status;
}

mct_status mct_toml_read(const char *text, size_t length, const char *origin, mct_toml *toml,
                         mct_message *why)
{
    scanner self = {text, length, 0, 0, 1, origin, why, NULL};
    mct_span table = {text, 0};
    toml->entry_count = 0;
    toml->table_count = 0;
    if (length > MCT_TOML_LENGTH) {
        fault(&self, "a scene of more than a megabyte");
        return MCT_ERROR_BOUND;
    }
    if (length >= 3 && text[0] == '\xEF' && text[1] == '\xBB' && text[2] == '\xBF') {
        self.position = 3;
        self.line_start = 3;
    }
    mct_status status = check_characters(&self);
    while (status == MCT_OK) {
        skip_blanks(&self);
        if (peek(&self, 0) == '[') {
            status = read_header(&self, toml, &table);
        } else if (!at_end(&self) && !at_newline(&self) && peek(&self, 0) != '#') {
            status = read_entry(&self, toml, table);
        }
        if (status != MCT_OK) {
            break;
        }
        skip_blanks(&self);
        skip_comment(&self);
        if (at_end(&self)) {
            break;
        }
        if (!at_newline(&self)) {
            const mct_span word = peek_word(&self);
            const mct_span rest = {word.start, word.length > 0 ? word.length : 1};
            return fault_quoting(&self, self.position, rest, " stands behind what should end the line");
        }
        skip_newline(&self);
    }
    return status;
}

mct_status mct_toml_split(const char *assignment, const char *origin, mct_toml_entry *entry, mct_message *why)
{
    const mct_span none = {assignment, 0};
    scanner self = {assignment, mct_text_length(assignment), 0, 0, 0, origin, why, NULL};
    if (self.length > MCT_TOML_LENGTH) {
        fault(&self, "an assignment of more than a megabyte");
        return MCT_ERROR_BOUND;
    }
    mct_status status = check_characters(&self);
    if (status != MCT_OK) {
        return status;
    }
    skip_blanks(&self);
    status = read_key(&self, none, entry);
    if (status != MCT_OK) {
        return status;
    }
    size_t end = self.length;
    while (end > self.position && (assignment[end - 1] == ' ' || assignment[end - 1] == '\t')) {
        end--;
    }
    entry->line = 0;
    entry->column = 0;
    entry->source.start = assignment + self.position;
    entry->source.length = end - self.position;
    return MCT_OK;
}

mct_status mct_toml_read_value(const char *origin, mct_toml_entry *entry, mct_message *why)
{
    const mct_span whole = entry->source;
    scanner self = {whole.start, whole.length, 0, 0, 0, origin, why, entry};
    const mct_status status = read_value(&self, 0, entry);
    if (status != MCT_OK || self.position == whole.length) {
        return status;
    }
    const mct_span rest = {whole.start + self.position, whole.length - self.position};
    return fault_quoting(&self, self.position, rest, " stands behind the value");
}

size_t mct_toml_text(const mct_toml_entry *entry, char *text, size_t capacity)
{
    const size_t quotes = entry->is_bare ? 0 : 1;
    scanner self = {entry->source.start, entry->source.length - quotes, quotes, 0, 0, "", NULL, NULL};
    const bool escapes = !entry->is_bare && entry->source.start[0] == '"';
    size_t length = 0;
    while (!at_end(&self)) {
        char bytes[4] = {peek(&self, 0)};
        size_t size = 1;
        size_t count = 1;
        if (escapes && bytes[0] == '\\') {
            const uint32_t code = (uint32_t)read_escape(&self, &size);
            count = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
            for (size_t i = count; i > 1; i--) {
                bytes[i - 1] = (char)(0x80 | (code >> (6 * (count - i)) & 0x3F));
            }
            const uint32_t mark = count == 1 ? 0 : 0xF00u >> count & 0xFF;
            bytes[0] = (char)(mark | code >> (6 * (count - 1)));
        }
        for (size_t i = 0; i < count; i++) {
            if (length + 1 < capacity) {
                text[length] = bytes[i];
            }
            length++;
        }
        self.position += size;
    }
    if (capacity > 0) {
        text[length < capacity ? length : capacity - 1] = '\0';
    }
    return length;
}

bool mct_toml_item(const mct_toml_entry *list, size_t *position, mct_toml_entry *item)
{
    scanner self = {
        list->source.start, list->source.length, *position > 0 ? *position : 1, 0, 0, "", NULL, NULL};
    skip_between_items(&self);
    if (peek(&self, 0) == ',') {
        self.position++;
        skip_between_items(&self);
    }
    if (peek(&self, 0) == ']' || read_value(&self, 1, item) != MCT_OK) {
        return false;
    }
    *position = self.position;
    return true;
}

/*
 * Helper of test_toml.py: reads documents from stdin, each "LENGTH\n" and that many bytes, and writes what
 * the reader makes of each as lines of JSON: {"ok": ..., "message": ..., "tables": [...], "entries": [[table,
 * key, kind, value], ...]}. Items of a list are [kind, value]. Reals are written as the hexadecimal of their bits, texts as the hexadecimal of
 * their bytes.
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "scene/toml.h"

static char text[MCT_TOML_LENGTH];
static char decoded[MCT_TOML_LENGTH];
static mct_toml toml;

static void print_bytes(const char *bytes, size_t length)
{
    putchar('"');
    for (size_t i = 0; i < length; i++) {
        printf("%02x", (unsigned)(unsigned char)bytes[i]);
    }
    putchar('"');
}

static void print_bits(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    printf("\"%016" PRIx64 "\"", bits);
}

/* The value behind its kind; a list is one of such pairs. */
static void print_value(const mct_toml_entry *entry)
{
    static const char *const kinds[] = {"integer", "real", "boolean", "text", "list"};
    printf("\"%s\", ", kinds[entry->kind]);
    if (entry->kind == MCT_TOML_INTEGER || entry->kind == MCT_TOML_BOOLEAN) {
        printf("%" PRId64, entry->integer);
    } else if (entry->kind == MCT_TOML_REAL) {
        print_bits(entry->number);
    } else if (entry->kind == MCT_TOML_TEXT) {
        print_bytes(decoded, mct_toml_text(entry, decoded, sizeof decoded));
    } else {
        size_t position = 0;
        mct_toml_entry item;
        putchar('[');
        for (int32_t i = 0; mct_toml_item(entry, &position, &item); i++) {
            fputs(i > 0 ? ", [" : "[", stdout);
            print_value(&item);
            putchar(']');
        }
        putchar(']');
    }
}

static void print_entry(const mct_toml_entry *entry)
{
    printf("[\"%.*s\", \"%.*s\", ", (int)entry->table.length, entry->table.start, (int)entry->key.length,
           entry->key.start);
    print_value(entry);
    putchar(']');
}

int main(void)
{
    size_t length;
    while (scanf("%zu", &length) == 1 && length <= sizeof text && getchar() == '\n' &&
           fread(text, 1, length, stdin) == length) {
        mct_message why;
        mct_message_clear(&why);
        const mct_status status = mct_toml_read(text, length, "x", &toml, &why);
        printf("{\"status\": %d, \"message\": ", (int)status);
        print_bytes(why.text, strlen(why.text));
        fputs(", \"tables\": [", stdout);
        for (int i = 0; status == MCT_OK && i < toml.table_count; i++) {
            printf("%s\"%.*s\"", i > 0 ? ", " : "", (int)toml.tables[i].name.length,
                   toml.tables[i].name.start);
        }
        fputs("], \"entries\": [", stdout);
        for (int i = 0; status == MCT_OK && i < toml.entry_count; i++) {
            fputs(i > 0 ? ", " : "", stdout);
            print_entry(&toml.entries[i]);
        }
        puts("]}");
    }
    return 0;
}

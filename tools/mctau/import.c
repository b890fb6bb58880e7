/* mctau import: the records that an image has left, as an event log. */
#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

#include "json.h"
#include "say.h"
#include "scene_file.h"
#include "verbs.h"

static const option options[] = {
    {"records", "FILE", NULL, "what the image has written; must be given"},
    {"o", "FILE.lcm", NULL, "the event log; must be given"},
    {"precision", "NAME", "scene.precision", NULL},
    OPTION_SET,
    OPTION_JSON,
    {NULL, NULL, NULL, NULL},
};

static int import_verb(const arguments *given);

const verb verb_import = {
    .name = "import",
    .doc = "makes an event log of the records that an image of a compiled scene has left",
    .operand = "SCENE",
    .text = "An image of a scene (tools/flash) writes each tick's record as it is in memory. With the scene "
            "beside "
            "them they are\n"
            "a log as mctau run --log writes it: mctau replay proves that every bit is the same here, and "
            "any LCM "
            "tool reads it.\n"
            "SCENE, --set and --precision are those that the image was made from.",
    .options = options,
    .examples = "  tools/flash scenes/cart_pole.toml --target qemu-m4f --records run.records\n"
                "  mctau import scenes/cart_pole.toml --precision float --records run.records -o run.lcm\n"
                "  mctau replay run.lcm\n",
    .exit_codes = "  0  written\n"
                  "  2  the command line, the scene or the records are wrong; there is no log\n"
                  "  3  a file could not be read or written, or the records were cut: then the log has the "
                  "whole ones\n",
    .run = import_verb,
};

static int tell(const scene_file *file, const char *log, const import_result *result)
{
    const bool json_wanted = arguments_value(file->given, "json") != NULL;
    if (json_wanted) {
        json out = json_begin(stdout, "mctau.import/1");
        json_text(&out, "log", log);
        json_count(&out, "ticks", result->ticks);
        json_count(&out, "left_over", result->left_over);
        json_finish(&out);
    } else {
        printf("%s: %" PRIu64 " ticks\n", log, result->ticks);
    }
    return result->left_over == 0
               ? EXIT_WELL
               : say(EXIT_IO, "the records end within one: %" PRIu64 " bytes left out", result->left_over);
}

static int import_file(const scene_file *file, const char *records, const char *log)
{
    import_result result;
    mct_message why;
    const run_options wanted = {.log = log, .scene_text = file->text};
    const mct_status status = file->runner->import(&file->scene, records, &wanted, &result, &why);
    return status != MCT_OK ? say_status(status, &why) : tell(file, log, &result);
}

static int import_verb(const arguments *given)
{
    const char *records = arguments_value(given, "records"), *log = arguments_value(given, "o");
    scene_file file;
    if (records == NULL || log == NULL) {
        return say(EXIT_USAGE, "%s: found none; allowed the name of a file",
                   records == NULL ? "--records" : "-o");
    }
    int exit_code = scene_file_read(&file, given);
    if (exit_code == EXIT_WELL && (is_same_file(file.path, log) || is_same_file(records, log))) {
        exit_code = say(EXIT_USAGE, "-o: %s is read from", log);
    }
    if (exit_code == EXIT_WELL) {
        exit_code = import_file(&file, records, log);
    }
    scene_file_free(&file);
    return exit_code;
}

/* mctau compile: a scene as C, for a microcontroller. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mctau/config.h"
#include "mctau/stepper.h"
#include "say.h"
#include "scene_file.h"
#include "scene_write.h"
#include "verbs.h"

static const option options[] = {
    {"o", "FILE.c", NULL, "where the C goes; - is stdout; must be given"},
    {"precision", "NAME", "scene.precision", NULL},
    OPTION_SET,
    {NULL, NULL, NULL, NULL},
};

static int compile_verb(const arguments *given);

const verb verb_compile = {
    .name = "compile",
    .doc = "turns a scene into C: const structs and the one kernel that it needs",
    .operand = "SCENE",
    .text =
        "Writes what the scene's init computes (gains, catch region, the plant's constants, the initial "
        "state) as "
        "const structs,\n"
        "and names the one kernel that advances the plant. The text includes hal/compiled.h, which says how "
        "a "
        "program uses it.\n"
        "Linked against the library for the same precision with --gc-sections, all other kernels, the scene "
        "reader and every\n"
        "init stay out. tools/flash builds images from it and runs them.",
    .options = options,
    .examples = "  mctau compile scenes/cart_pole.toml --precision float -o cart_pole.c\n"
                "  mctau compile scenes/reaction_wheel.toml --set effects.viscous=false -o -\n",
    .exit_codes = "  0  written\n"
                  "  2  the command line or the scene is wrong; the file is left as it was\n"
                  "  3  the scene could not be read, or the file not be written\n",
    .run = compile_verb,
};

/* A line of a comment, which nothing in it may end. */
static void put_line(csv_output *out, char *text)
{
    for (char *end = strstr(text, "*/"); end != NULL; end = strstr(end, "*/")) {
        *end = '.';
    }
    csv_output_headers(out, " *", 2);
    csv_output_headers(out, text[0] != '\0' ? " " : "", text[0] != '\0' ? 1 : 0);
    csv_output_headers(out, text, strlen(text));
    csv_output_headers(out, "\n", 1);
}

/* What the file is, and the scene's parameters, since the constants below are no longer they. */
static void put_head(csv_output *out, const scene_file *file)
{
    const mct_scene *scene = &file->scene;
    const mct_system *system = mct_systems[scene->system];
    char line[1024];
    csv_output_headers(out, "/*\n", 3);
    snprintf(line, sizeof line, "%s: %s by %s in %s, a tick of %g s; by mctau compile, %s.", file->path,
             system->name, mct_steppers[scene->stepper].name, file->runner->precision, scene->dt,
             MCT_VERSION);
    put_line(out, line);
    snprintf(line, sizeof line, "Not to be edited: change the scene and compile it again.");
    put_line(out, line);
    line[0] = '\0';
    put_line(out, line);
    const int tables[] = {MCT_TABLE_EFFECTS, MCT_TABLE_PARAMETERS};
    for (size_t t = 0; t < sizeof tables / sizeof tables[0]; t++) {
        for (int i = 0; i < mct_key_count(tables[t], system); i++) {
            char value[8192];
            const mct_scene_key key = mct_key_at(tables[t], system, i);
            if (key.effect != NULL && !(key.effect->mask & system->effects)) {
                continue;
            }
            snprintf(line, sizeof line, "%s = %.900s%s%s", key.field.name,
                     scene_value_text(scene, &key, value, sizeof value), key.field.unit[0] != '\0' ? " " : "",
                     key.field.unit);
            put_line(out, line);
        }
    }
    csv_output_headers(out, " */\n", 4);
}

static int write_file(const scene_file *file, const char *path)
{
    mct_message why = {""};
    const run_options given = {.samples = file->samples};
    csv_output *out = need_memory(malloc(sizeof *out));
    mct_status status = csv_output_open(out, path, &why);
    int exit_code = status != MCT_OK ? say_status(status, &why) : EXIT_WELL;
    if (exit_code == EXIT_WELL) {
        put_head(out, file);
        status = file->runner->compile(&file->scene, &given, out, &why);
        if (status != MCT_OK) {
            csv_output_discard(out);
            exit_code = say_status(status, &why);
        } else {
            csv_output_close(out);
            exit_code = out->error != 0
                            ? say(EXIT_IO, "%s: %s; it is left as it was", path, strerror(out->error))
                            : EXIT_WELL;
        }
    }
    free(out);
    return exit_code;
}

static int compile_verb(const arguments *given)
{
    const char *path = arguments_value(given, "o");
    scene_file file;
    if (path == NULL) {
        return say(EXIT_USAGE, "-o: found none; allowed the name of a file, or -");
    }
    int exit_code = scene_file_read(&file, given);
    if (exit_code == EXIT_WELL && is_same_file(file.path, path)) {
        exit_code = say(EXIT_USAGE, "-o: %s is the scene itself", path);
    }
    if (exit_code == EXIT_WELL) {
        exit_code = write_file(&file, path);
    }
    scene_file_free(&file);
    return exit_code;
}

#include "scene_file.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "csv_input.h"
#include "say.h"

enum { LARGEST_SCENE = 1 << 20 }; /* bytes */

static const mct_runner *const runners[] = {
#if defined MCT_HAVE_F64
    &mct_runner_f64,
#endif
#if defined MCT_HAVE_F32
    &mct_runner_f32,
#endif
    NULL,
};

const mct_runner *find_runner(int precision)
{
    const char *name = precision == MCT_PRECISION_FLOAT ? "float" : "double";
    for (int i = 0; runners[i] != NULL; i++) {
        if (strcmp(runners[i]->precision, name) == 0) {
            return runners[i];
        }
    }
    return NULL;
}

const char *runner_names(void)
{
    const bool has_double = find_runner(MCT_PRECISION_DOUBLE) != NULL;
    const bool has_float = find_runner(MCT_PRECISION_FLOAT) != NULL;
    return has_double && has_float ? "double, float" : has_double ? "double" : has_float ? "float" : "none";
}

static const char *shown_path(const char *path)
{
    return strcmp(path, "-") == 0 ? "standard input" : path;
}

/* Reads a stream to its end; gives NULL with errno set, EFBIG when it is too large. */
static char *read_all(FILE *file, size_t *length)
{
    char *text = need_memory(malloc(LARGEST_SCENE + 1));
    *length = fread(text, 1, LARGEST_SCENE + 1, file);
    if (ferror(file) || *length > LARGEST_SCENE) {
        errno = ferror(file) ? errno : EFBIG;
        free(text);
        return NULL;
    }
    return text;
}

static int read_text(const char *path, char **text, size_t *length)
{
    const bool standard = strcmp(path, "-") == 0;
    errno = 0;
    FILE *file = standard ? stdin : fopen(path, "rb");
    *text = file != NULL ? read_all(file, length) : NULL;
    const int reason = errno;
    if (file != NULL && !standard) {
        fclose(file);
    }
    if (*text != NULL) {
        return 0;
    }
    if (reason == EFBIG) {
        return say(EXIT_USAGE, "%s: found more than %d bytes; a scene has less", shown_path(path),
                   LARGEST_SCENE);
    }
    return say(EXIT_IO, "%s: the scene cannot be read: %s", shown_path(path), strerror(reason));
}

static const char mark[] = "#!set "; /* ahead of an override in the text that a log keeps */

/*
 * The text that a log keeps. A line of the file that looks like an override (the file came out of a log) is
 * made an ordinary comment, since the run that is logged does not heed it.
 */
static char *logged_text(const char *text, size_t length, const arguments *given)
{
    size_t size = length + 2;
    for (int i = 0; i < given->override_count; i++) {
        size += sizeof mark + strlen(given->overrides[i].assignment) + 1;
    }
    char *result = need_memory(malloc(size));
    memcpy(result, text, length);
    for (size_t i = 0; i + sizeof mark - 1 <= length; i++) {
        if ((i == 0 || result[i - 1] == '\n') && memcmp(result + i, mark, sizeof mark - 1) == 0) {
            result[i + 1] = ' ';
        }
    }
    char *end = result + length;
    if (length > 0 && end[-1] != '\n') {
        *end++ = '\n';
    }
    *end = '\0';
    for (int i = 0; i < given->override_count; i++) {
        end += sprintf(end, "%s%s\n", mark, given->overrides[i].assignment);
    }
    return result;
}

/* Of a path in a scene: relative ones count from the scene's folder. */
static char *beside(const char *scene_path, const char *path)
{
    const char *slash = strrchr(scene_path, '/');
    const size_t folder = path[0] == '/' || slash == NULL ? 0 : (size_t)(slash + 1 - scene_path);
    char *result = need_memory(malloc(folder + strlen(path) + 1));
    memcpy(result, scene_path, folder);
    strcpy(result + folder, path);
    return result;
}

static int read_samples(scene_file *self)
{
    const mct_scene *scene = &self->scene;
    if (scene->input != MCT_INPUT_CSV) {
        return 0;
    }
    csv_samples *samples = &self->samples;
    mct_message why;
    self->samples_path = beside(self->path, scene->input_file);
    const mct_status status =
        csv_input_read(self->samples_path, scene->input_column, &samples->f64, &samples->count, &why);
    if (status != MCT_OK) {
        return say_status(status, &why);
    }
    samples->f32 = need_memory(calloc(samples->count + 1, sizeof *samples->f32));
    for (size_t i = 0; i < samples->count; i++) {
        samples->f32[i] = (float)samples->f64[i];
    }
    return 0;
}

static int choose_runner(scene_file *self)
{
    self->runner = find_runner(self->scene.precision);
    if (self->runner == NULL) {
        return say(EXIT_USAGE, "%s: scene.precision: found %s, which this build has not; allowed %s",
                   shown_path(self->path), self->scene.precision == MCT_PRECISION_FLOAT ? "float" : "double",
                   runner_names());
    }
    return 0;
}

int scene_file_read(scene_file *self, const arguments *given)
{
    char *text;
    size_t length = 0;
    mct_message why;
    memset(self, 0, sizeof *self);
    self->given = given;
    self->path = given->operand;
    int exit_code = read_text(self->path, &text, &length);
    if (exit_code != 0) {
        return exit_code;
    }
    mct_message_clear(&why);
    const mct_status status = mct_scene_read(text, length, shown_path(self->path), given->overrides,
                                             given->override_count, &self->scene, &why);
    if (status == MCT_OK) {
        self->text = logged_text(text, length, given);
        exit_code = choose_runner(self);
        exit_code = exit_code != 0 ? exit_code : read_samples(self);
    } else {
        exit_code = say_status(status, &why);
    }
    free(text);
    for (int i = 0; exit_code == 0 && mct_scene_note(&self->scene, i, &why); i++) {
        say(0, "note: %s", why.text);
    }
    if (exit_code != 0) {
        scene_file_free(self);
    }
    return exit_code;
}

void scene_file_note(scene_file *self, const char *key, const char *value)
{
    const size_t length = strlen(self->text);
    const size_t more = sizeof mark + strlen(key) + strlen(value) + 2;
    self->text = need_memory(realloc(self->text, length + more));
    snprintf(self->text + length, more, "%s%s=%s\n", mark, key, value);
}

bool is_same_file(const char *a, const char *b)
{
    struct stat there[2];
    return a != NULL && b != NULL && stat(a, &there[0]) == 0 && stat(b, &there[1]) == 0 &&
           S_ISREG(there[0].st_mode) && there[0].st_dev == there[1].st_dev &&
           there[0].st_ino == there[1].st_ino;
}

void scene_file_free(scene_file *self)
{
    free(self->text);
    free(self->samples.f64);
    free(self->samples.f32);
    free(self->samples_path);
    memset(self, 0, sizeof *self);
}

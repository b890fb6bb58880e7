/* mctau advise: which effects a scene calls for at a tolerance. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "advise.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "instructions.h"
#include "mctau/stepper.h"
#include "say.h"
#include "scene_write.h"
#include "verbs.h"

static const option options[] = {
    {"tolerance", "E", NULL,
     "largest change allowed at any tick, as mctau cost --help defines an error; 1e-12 or more"},
    {"write", "FILE.toml", NULL, "the scene without what is dropped, with the certificate as a comment"},
    {"duration", "S", "scene.duration", "how much of the scene, a whole number of ticks"},
    OPTION_INSTRUCTIONS,
    OPTION_SET,
    OPTION_JSON,
    {NULL, NULL, NULL, NULL},
};

static int run_verb(const arguments *given);

const verb verb_advise = {
    .name = "advise",
    .doc = "which effects a scene calls for at a tolerance, verified by a run",
    .operand = "SCENE",
    .text =
        "Shows for each effect that is on: its time scale, what it costs, and by how much leaving it out "
        "would change the run.\n"
        "Drops those that change least while the sum of their estimates stays within the tolerance, and "
        "verifies what is left\n"
        "by a run against the full one: if they differ by more, the last that was dropped is taken back.\n"
        "The estimate is to first order: what the effect does in each tick, carried on by the derivative of "
        "the scene's tick.\n"
        "With a controller, of dry friction, and where it is too large for that, it is a run without the "
        "effect.\n"
        "The difference of two runs is that of their worst state at the worst tick, relative to the state's "
        "largest value or to 1;\n"
        "a motor's current and other states that go with an effect are not compared. Both runs are in "
        "double, by the scene's\n"
        "stepper where steps half as long change little, else by a more accurate one; what they still change "
        "counts against\n"
        "the tolerance.\n"
        "A motor is taken from inductive to quasi-static and no further: without it the input would mean a "
        "force. Of sensors\n"
        "noise and latency may go; encoders stay. Effects that are off although a coefficient of theirs is "
        "not 0 are shown\n"
        "with what they would change.\n"
        "Times and instructions are those of a tick of the plant, flash bytes those of its kernel in float "
        "on a Cortex-M4F:\n"
        "always the full scene's less those without the effect; - where they are not known.",
    .options = options,
    .examples = "  mctau advise scenes/cart_pole_free.toml --tolerance 1e-2\n"
                "  mctau advise scenes/reaction_wheel.toml --tolerance 0.05 --write lean.toml\n"
                "  mctau advise scenes/pendulum.toml --tolerance 1e-3 --set effects.drag=true --json\n",
    .exit_codes = "  0  certified: the pruned scene, or the full one where nothing can go\n"
                  "  1  nothing can be certified, as when any error grows beyond the tolerance; or the scene "
                  "diverges\n"
                  "  2  the command line or the scene is wrong\n"
                  "  3  a file could not be read or written\n",
    .run = run_verb,
};

/* --- names --- */

enum { LABEL = 96 };

static mct_scene with_value(const advice *self, const change *one, double value)
{
    mct_scene scene = self->file->scene;
    mct_key_set(&scene, &one->key, value);
    return scene;
}

/* A value without quotes, as --set takes it. */
static const char *value_text(const advice *self, const change *one, double value, char *text)
{
    const mct_scene scene = with_value(self, one, value);
    if (one->key.field.kind == MCT_FIELD_CHOICE) {
        return mct_choice_name(&one->key.field, (int32_t)value);
    }
    return scene_value_text(&scene, &one->key, text, LABEL);
}

/* "gravity", "coulomb -> off", "noise 0.5 -> 0", "arm_counts_per_turn 4096" */
static const char *label_of(const advice *self, const change *one, char *text)
{
    char from[LABEL], to[LABEL];
    const char *name = one->key.field.name;
    const char *begin = value_text(self, one, one->from, from), *end = value_text(self, one, one->to, to);
    if (one->key.field.kind == MCT_FIELD_BOOLEAN) {
        snprintf(text, LABEL, "%s", name);
    } else if (one->from == one->to) {
        snprintf(text, LABEL, "%s %s", name, begin);
    } else if (one->key.effect != NULL) {
        snprintf(text, LABEL, "%s -> %s", name, end);
    } else {
        snprintf(text, LABEL, "%s %s -> %s", name, begin, end);
    }
    return text;
}

/* "effects.coulomb=off" */
static const char *assignment_of(const advice *self, const change *one, char *text)
{
    char to[LABEL];
    snprintf(text, LABEL, "%s.%s=%s", mct_table_name(one->table), one->key.field.name,
             value_text(self, one, one->to, to));
    return text;
}

static const char *state_name(const advice *self, const departure *where)
{
    const mct_system *system = mct_systems[self->full.system];
    const bool is_rotation =
        system->attitude != MCT_ATTITUDE_NONE && where->state == mct_rate_index(system) - 4;
    return is_rotation ? "attitude" : mct_state_field(system, where->state)->name;
}

static double time_of(const advice *self, const departure *where)
{
    return (double)where->tick * self->full.dt;
}

/* --- the certificate --- */

/* "dropped: viscous, drag; bound 3.1e-04; verified 2.9e-04" */
static const char *certificate(const advice *self, char *text, size_t size)
{
    char label[LABEL];
    int used = snprintf(text, size, "dropped: "), count = 0;
    for (int i = 0; i < self->count; i++) {
        if (self->list[i].is_dropped && used < (int)size) {
            used += snprintf(text + used, size - (size_t)used, "%s%s", count++ > 0 ? ", " : "",
                             label_of(self, &self->list[i], label));
        }
    }
    if (used < (int)size) {
        snprintf(text + used, size - (size_t)used, "%s; bound %.1e; verified %.1e",
                 count > 0 ? "" : "nothing", self->bound, self->verified);
    }
    return text;
}

static double saved_flash(const advice *self)
{
    return advise_flash(self, &self->full_cost, &self->pruned_cost);
}

static int write_scene(const advice *self, const char *path)
{
    char line[16 * LABEL], comment[20 * LABEL];
    mct_scene scene = advise_pruned_scene(self);
    if (self->file->samples_path != NULL) { /* which counts from the folder of the scene that was read */
        char *absolute = realpath(self->file->samples_path, NULL);
        const bool fits = absolute != NULL && strlen(absolute) < sizeof scene.input_file;
        if (fits) {
            strcpy(scene.input_file, absolute);
        }
        free(absolute);
        if (!fits) {
            return say(EXIT_IO, "--write: %s has too long a path for a scene", self->file->samples_path);
        }
    }
    snprintf(comment, sizeof comment,
             "By mctau advise from %s: what a tolerance of %g calls for, over %g s.\n"
             "%s.\n"
             "Both runs in double by %s at %d a tick; steps half as long change %.1e.\n",
             self->file->path, self->tolerance, (double)self->ticks * self->full.dt,
             certificate(self, line, sizeof line), mct_steppers[self->full.stepper].name, self->full.substeps,
             self->uncertainty);
    return scene_write(&scene, comment, path);
}

/* --- JSON --- */

static void json_estimate(const advice *self, const change *one, json *out)
{
    const bool is_known = !isnan(one->estimate.size);
    json_number(out, "time_scale_s", one->time_scale);
    json_boolean(out, "near_tick", advise_is_near_tick(self, one->time_scale));
    json_number(out, "estimate", one->estimate.size);
    json_text(out, "estimate_by", !is_known ? NULL : one->by_run ? "run" : "first_order");
    json_object(out, "changes_most");
    if (isfinite(one->estimate.size)) {
        json_text(out, "state", state_name(self, &one->estimate));
        json_number(out, "time_s", time_of(self, &one->estimate));
    }
    json_end_object(out);
}

/* Whether it is dropped, by itself or with a further step down of the same effect. */
static bool goes(const advice *self, const change *one)
{
    bool result = false;
    for (int i = 0; i < self->count; i++) {
        const change *other = &self->list[i];
        result = result || (other->is_dropped && other->to <= one->to && other->table == one->table &&
                            strcmp(other->key.field.name, one->key.field.name) == 0);
    }
    return result;
}

static void json_change(const advice *self, const change *one, json *out)
{
    char text[LABEL];
    const bool is_effect = one->key.effect != NULL;
    json_object(out, NULL);
    json_text(out, "name", one->key.field.name);
    json_text(out, "kind", value_text(self, one, one->from, text));
    json_text(out, "without", value_text(self, one, one->to, text));
    json_text(out, "unit", one->key.field.unit);
    json_text(out, "state", "on");
    json_estimate(self, one, out);
    json_number(out, "ns", is_effect ? self->full_cost.ns - one->cost.ns : (double)NAN);
    json_number(out, "instructions",
                is_effect ? self->full_cost.instructions - one->cost.instructions : (double)NAN);
    json_number(out, "flash_bytes",
                is_effect && one->from != one->to ? advise_flash(self, &self->full_cost, &one->cost)
                                                  : (double)NAN);
    json_text(out, "decision", goes(self, one) ? "drop" : "keep");
    json_text(out, "reason", one->reason);
    json_text(out, "set", one->from != one->to ? assignment_of(self, one, text) : NULL);
    json_end_object(out);
}

static void json_names(const advice *self, bool dropped, json *out)
{
    for (int i = 0; i < self->count; i++) {
        const char *name = self->list[i].key.field.name;
        bool is_named = false; /* by another step of the same effect */
        for (int j = 0; j < i; j++) {
            is_named = is_named || (goes(self, &self->list[j]) == dropped &&
                                    strcmp(self->list[j].key.field.name, name) == 0);
        }
        if (goes(self, &self->list[i]) == dropped && !is_named) {
            json_text(out, NULL, name);
        }
    }
}

static void json_left_out(const advice *self, const change *one, json *out)
{
    char text[LABEL];
    const mct_system *system = mct_systems[self->full.system];
    json_object(out, NULL);
    json_text(out, "name", one->key.field.name);
    json_text(out, "kind", value_text(self, one, one->to, text));
    json_text(out, "state", "off");
    json_estimate(self, one, out);
    json_boolean(out, "matters", one->estimate.size > self->tolerance);
    json_text(out, "reason", one->reason);
    json_text(out, "set", assignment_of(self, one, text));
    json_list(out, "coefficients");
    for (int i = 0; i < mct_key_count(MCT_TABLE_PARAMETERS, system); i++) {
        const mct_scene_key key = mct_key_at(MCT_TABLE_PARAMETERS, system, i);
        if (advise_would_read(self, one, &key)) {
            json_object(out, NULL);
            json_text(out, "name", key.field.name);
            json_number(out, "value", key.rows != NULL ? (double)NAN : mct_key_get(&self->file->scene, &key));
            json_text(out, "unit", key.field.unit);
            json_boolean(out, "given", (self->file->scene.given >> i & 1) != 0);
            json_end_object(out);
        }
    }
    json_end_list(out);
    json_end_object(out);
}

static void print_json(const advice *self)
{
    char text[16 * LABEL];
    json out = json_begin(stdout, "mctau.advise/1");
    json_text(&out, "system", mct_systems[self->full.system]->name);
    json_text(&out, "input", self->is_loop ? "controlled" : self->about.held ? "held" : "free");
    json_number(&out, "tick", self->full.dt);
    json_number(&out, "duration", (double)self->about.all_ticks * self->full.dt);
    json_number(&out, "compared", (double)self->ticks * self->full.dt);
    json_number(&out, "tolerance", self->tolerance);
    json_boolean(&out, "certified", self->is_certified);
    json_text(&out, "refusal", self->refusal);
    json_text(&out, "certificate", self->is_certified ? certificate(self, text, sizeof text) : NULL);
    json_number(&out, "bound", self->bound);
    json_number(&out, "verified_error", self->is_certified ? self->verified : (double)NAN);
    json_number(&out, "uncertainty", self->uncertainty);
    json_integer(&out, "taken_back", self->taken_back);
    json_text(&out, "stepper", mct_steppers[self->full.stepper].name);
    json_integer(&out, "substeps", self->full.substeps);
    json_integer(&out, "stride", self->full.stride);
    json_list(&out, "effects");
    for (int i = 0; i < self->count; i++) {
        json_change(self, &self->list[i], &out);
    }
    json_end_list(&out);
    json_list(&out, "kept");
    json_names(self, false, &out);
    json_end_list(&out);
    json_list(&out, "dropped");
    json_names(self, true, &out);
    json_end_list(&out);
    json_list(&out, "set");
    for (int i = 0; i < self->count; i++) {
        if (self->list[i].is_dropped) {
            json_text(&out, NULL, assignment_of(self, &self->list[i], text));
        }
    }
    json_end_list(&out);
    json_object(&out, "saves");
    json_number(&out, "ns", self->full_cost.ns - self->pruned_cost.ns);
    json_number(&out, "instructions", self->full_cost.instructions - self->pruned_cost.instructions);
    json_number(&out, "flash_bytes", saved_flash(self));
    json_end_object(&out);
    json_text(&out, "instructions_counted_by",
              self->not_counted == NULL ? counter_names[self->counter] : NULL);
    json_text(&out, "instructions_not_counted", self->not_counted);
    json_list(&out, "left_out");
    for (int i = 0; i < self->left_out_count; i++) {
        json_left_out(self, &self->left_out[i], &out);
    }
    json_end_list(&out);
    json_finish(&out);
}

/* --- for people --- */

static const char *number_text(const char *format, double value, char *text)
{
    snprintf(text, LABEL, isfinite(value) ? format : "-", value);
    return text;
}

static void print_change(const advice *self, const change *one)
{
    char label[LABEL], scale[LABEL], ns[LABEL], instructions[LABEL], flash[LABEL], size[LABEL],
        where[LABEL] = "";
    const bool has_cost = one->key.effect != NULL && one->from != one->to;
    const double nan = (double)NAN;
    if (isfinite(one->estimate.size) && one->estimate.size > 0) {
        snprintf(where, sizeof where, "%s, %.3g s", state_name(self, &one->estimate),
                 time_of(self, &one->estimate));
    }
    const bool is_told = one->is_fixed || isinf(one->estimate.size);
    printf("%-4s %-27s%10s%c%7s%7s%7s%9s%c %s\n", goes(self, one) ? "drop" : "keep",
           label_of(self, one, label), number_text("%.3g s", one->time_scale, scale),
           advise_is_near_tick(self, one->time_scale) ? '~' : ' ',
           number_text("%.1f", has_cost ? self->full_cost.ns - one->cost.ns : nan, ns),
           number_text("%.0f", has_cost ? self->full_cost.instructions - one->cost.instructions : nan,
                       instructions),
           number_text("%.0f", has_cost ? advise_flash(self, &self->full_cost, &one->cost) : nan, flash),
           number_text("%.1e", one->estimate.size, size), one->by_run && !one->is_fixed ? '*' : ' ',
           is_told ? one->reason : where);
}

static void print_coefficients(const advice *self, const change *one)
{
    const mct_system *system = mct_systems[self->full.system];
    const char *between = "";
    for (int i = 0; i < mct_key_count(MCT_TABLE_PARAMETERS, system); i++) {
        const mct_scene_key key = mct_key_at(MCT_TABLE_PARAMETERS, system, i);
        if (!advise_would_read(self, one, &key)) {
            continue;
        }
        printf("%s%s", between, key.field.name);
        if (key.rows == NULL) {
            printf(" = %g%s%s", mct_key_get(&self->file->scene, &key), key.field.unit[0] != '\0' ? " " : "",
                   key.field.unit);
        }
        printf("%s", (self->file->scene.given >> i & 1) != 0 ? "" : " (default)");
        between = ", ";
    }
    printf("\n");
}

static void print_left_out(const advice *self, const change *one)
{
    char assignment[LABEL], scale[LABEL];
    printf("  %s: ", assignment_of(self, one, assignment));
    print_coefficients(self, one);
    if (one->is_fixed) {
        printf("      %s\n", one->reason);
        return;
    }
    printf("      would change %s by ",
           isfinite(one->estimate.size) ? state_name(self, &one->estimate) : "the run");
    if (isfinite(one->estimate.size)) {
        printf("%.1e at %.3g s", one->estimate.size, time_of(self, &one->estimate));
    } else {
        printf("more than can be told");
    }
    printf("%s", one->estimate.size > self->tolerance ? ", more than the tolerance" : "");
    if (!isnan(one->time_scale)) {
        printf("; time scale %s%s", number_text("%.3g s", one->time_scale, scale),
               advise_is_near_tick(self, one->time_scale) ? ", near the tick" : "");
    }
    printf("\n");
}

static void print_saving(const char *before, int digits, const char *what, double full, double pruned)
{
    if (!isnan(full) && !isnan(pruned)) {
        printf("%s%.*f of %.*f %s", before, digits, full - pruned, digits, full, what);
    }
}

static void print_certificate(const advice *self)
{
    char text[16 * LABEL];
    const double flash = saved_flash(self);
    printf("%s, tolerance %g\n", certificate(self, text, sizeof text), self->tolerance);
    if (self->taken_back > 0) {
        printf("Verification took back %d that the estimates had promised.\n", self->taken_back);
    }
    if (strstr(text, "nothing") == NULL) {
        print_saving("saves: ", 1, "ns", self->full_cost.ns, self->pruned_cost.ns);
        print_saving(", ", 0, "instructions", self->full_cost.instructions, self->pruned_cost.instructions);
        if (!isnan(flash)) {
            printf(" a tick; %.0f bytes of flash", flash);
        }
        printf("\nto run it: mctau run %s", self->file->path);
        for (int i = 0; i < self->count; i++) {
            if (self->list[i].is_dropped) {
                printf(" --set %s", assignment_of(self, &self->list[i], text));
            }
        }
        printf("\n");
    }
}

static void print_text(const advice *self)
{
    printf("%s: %s, tick %g s, %g s%s\n", self->file->path, mct_systems[self->full.system]->name,
           self->full.dt, (double)self->ticks * self->full.dt, self->is_loop ? ", closed loop" : "");
    printf("Judged in double by %s at %d step%s a tick; steps half as long change %.1e.\n\n",
           mct_steppers[self->full.stepper].name, self->full.substeps, self->full.substeps > 1 ? "s" : "",
           self->uncertainty);
    if (self->count > 0) {
        printf("     %-27s%10s %7s%7s%7s%9s  %s\n", "effect", "time scale", "ns", "instr", "flash", "change",
               "most of all");
    }
    for (int i = 0; i < self->count; i++) {
        print_change(self, &self->list[i]);
    }
    printf(self->count > 0
               ? "\nns, instructions a tick and bytes of flash on a Cortex-M4F that it takes; the "
                 "change of the run without it.\n~ near the tick; * by a run, else to first order"
               : "No effect is on");
    printf(self->not_counted != NULL ? ". Instructions: not counted: %s.\n\n" : ".\n\n", self->not_counted);
    if (self->is_certified) {
        print_certificate(self);
    } else {
        printf("Nothing is certified: %s than %g.\n", self->refusal, self->tolerance);
    }
    if (self->left_out_count > 0) {
        printf("\nLeft out, though coefficients are not 0:\n");
    }
    for (int i = 0; i < self->left_out_count; i++) {
        print_left_out(self, &self->left_out[i]);
    }
}

/* --- the command line --- */

static int read_request(const arguments *given, double *tolerance, int *counter)
{
    const char *text = arguments_value(given, "tolerance"), *path = arguments_value(given, "write");
    if (text == NULL) {
        return say(EXIT_USAGE, "advise: no --tolerance given, the largest change allowed, as 1e-3");
    }
    if (path != NULL && (path[0] == '\0' || strcmp(path, "-") == 0)) {
        return say(EXIT_USAGE, "--write: found %s; allowed a file", path[0] == '\0' ? "nothing" : path);
    }
    const int exit_code = read_number("tolerance", text, 1e-12, 1e6,
                                      "1e-12 to 1e6; below, rounding alone is larger", tolerance);
    return exit_code != 0 ? exit_code : read_counter(arguments_value(given, "instructions"), counter);
}

static int advise(const scene_file *file, double tolerance, int counter)
{
    advice self;
    const char *path = arguments_value(file->given, "write");
    if (is_same_file(path, file->path) || is_same_file(path, file->samples_path)) {
        return say(EXIT_USAGE, "--write: found %s, which the scene is read from; allowed another file", path);
    }
    int exit_code = advise_begin(&self, file, tolerance, counter);
    if (exit_code != 0) {
        return exit_code;
    }
    exit_code = path != NULL && self.is_certified ? write_scene(&self, path) : 0;
    if (exit_code == 0) {
        if (arguments_value(file->given, "json") != NULL) {
            print_json(&self);
        } else {
            print_text(&self);
        }
        exit_code = self.is_certified ? EXIT_WELL : EXIT_CHECK_FAILED;
    }
    advise_end(&self);
    return exit_code;
}

static int run_verb(const arguments *given)
{
    scene_file file;
    double tolerance;
    int counter;
    int exit_code = read_request(given, &tolerance, &counter);
    exit_code = exit_code != 0 ? exit_code : scene_file_read(&file, given);
    if (exit_code == 0) {
        exit_code = instructions_note() != NULL ? advise_count_again(&file, instructions_note())
                                                : advise(&file, tolerance, counter);
        scene_file_free(&file);
    }
    return exit_code;
}

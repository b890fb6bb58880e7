/* mctau list: what there is. Nothing is written here: all of it comes from the descriptors. */
#include <stdio.h>
#include <string.h>

#include "json.h"
#include "mctau/stepper.h"
#include "say.h"
#include "verbs.h"

static const option options[] = {
    OPTION_JSON,
    {NULL, NULL, NULL, NULL},
};

static int run_verb(const arguments *given);

const verb verb_list = {
    .name = "list",
    .doc = "lists systems with parameters, units, ranges and defaults; effects, steppers, controllers, scene "
           "keys",
    .operand = "[SYSTEM]",
    .text = "Lists all that a scene may hold. With SYSTEM, that system alone, with its parameters.",
    .options = options,
    .examples = "  mctau list\n"
                "  mctau list cart_pole\n"
                "  mctau list --json\n",
    .exit_codes = "  0  well\n"
                  "  2  no such system\n",
    .run = run_verb,
};

/* With the effects that a scene has by default, or with these but for one. */
static bool suits_without(const mct_system *system, int stepper, uint32_t effect)
{
    return system->kernel(stepper, system->standard_effects & MCT_KERNEL_EFFECTS & ~effect) != NULL;
}

static bool suits(const mct_system *system, int stepper)
{
    return suits_without(system, stepper, 0);
}

static bool may_suit(const mct_system *system, int stepper)
{
    return suits(system, stepper) || suits_without(system, stepper, MCT_VISCOUS);
}

/* Name that an effect has in a mask, as a scene writes it. */
static const char *effect_choice(const mct_effect *effect, uint32_t mask)
{
    static const char *const switched[] = {"false", "true"};
    const uint32_t bits = mask & effect->mask;
    int choice = 0;
    while (choice < 2 && effect->bits[choice] != bits) {
        choice++;
    }
    return effect->choices != NULL ? effect->choices[choice] : switched[choice];
}

/* Name of choice `index` of a field; NULL beyond the last. Systems and steppers name themselves. */
static const char *choice_name(const mct_field *field, int index)
{
    if (field->choices != NULL) {
        return field->choices[index];
    }
    if (field->offset == offsetof(mct_scene, system)) {
        return index < MCT_SYSTEM_COUNT ? mct_systems[index]->name : NULL;
    }
    return index < MCT_STEPPER_COUNT ? mct_steppers[index].name : NULL;
}

/* The [controller] or [input] table's field `kind`: names of what there is. */
static const mct_field *kind_of(const char *table)
{
    for (int i = 0; i < MCT_SCENE_TABLE_COUNT; i++) {
        if (strcmp(mct_scene_tables[i].name, table) == 0) {
            return &mct_scene_tables[i].fields[0];
        }
    }
    return NULL;
}

/*
 * An effect by which something is read: "viscous", or "motor = inductive" where not every kind of it does. The text is
 * kept until the next call with the same buffer.
 */
static const char *reader_name(const mct_effect *effect, uint32_t readers, char *buffer, size_t size)
{
    if ((effect->mask & ~readers) == 0) {
        return effect->name;
    }
    snprintf(buffer, size, "%s = %s", effect->name, effect_choice(effect, readers));
    return buffer;
}

/* Default of a text, which stands in the scene that the library fills. */
static const char *default_text(const mct_scene *defaults, const mct_field *field)
{
    return (const char *)defaults + field->offset;
}

/* --- JSON --- */

static void json_range(json *out, const mct_field *field)
{
    json_text(out, "unit", field->unit);
    json_number(out, "minimum", field->minimum);
    json_number(out, "maximum", field->maximum);
    json_number(out, "default", field->standard);
}

static void json_quantity_within(json *out, const mct_field *field)
{
    json_text(out, "name", field->name);
    json_range(out, field);
    json_text(out, "doc", field->doc);
}

static void json_quantity(json *out, const char *key, const mct_field *field)
{
    json_object(out, key);
    json_quantity_within(out, field);
    json_end_object(out);
}

static void json_coordinate(json *out, const mct_coordinate *coordinate)
{
    json_object(out, NULL);
    json_text(out, "name", coordinate->position.name);
    json_range(out, &coordinate->position);
    json_text(out, "doc", coordinate->position.doc);
    json_boolean(out, "is_angle", coordinate->is_angle);
    if (coordinate->rate.name != NULL) { /* not of a process */
        json_quantity(out, "rate", &coordinate->rate);
    }
    json_quantity(out, "encoder", &coordinate->encoder);
    json_number(out, "position_weight", coordinate->position_weight);
    json_number(out, "rate_weight", coordinate->rate_weight);
    json_end_object(out);
}

/* A switch is a boolean, anything else a name. */
static void json_choice_of(json *out, const char *key, const mct_effect *effect, uint32_t mask)
{
    if (effect->choices != NULL) {
        json_text(out, key, effect_choice(effect, mask));
    } else {
        json_boolean(out, key, (mask & effect->mask) != 0);
    }
}

static void json_choices(json *out, const char *key, const mct_field *field)
{
    json_list(out, key);
    for (int i = 0; choice_name(field, i) != NULL; i++) {
        json_text(out, NULL, choice_name(field, i));
    }
    json_end_list(out);
}

/* The effects that read a parameter or a list; none: it is read always. */
static void json_readers(json *out, uint32_t readers)
{
    char buffer[64];
    json_list(out, "read_by");
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        if (mct_effects[i].mask & readers) {
            json_text(out, NULL, reader_name(&mct_effects[i], readers, buffer, sizeof buffer));
        }
    }
    json_end_list(out);
}

/* A quantity of a system, or a name. */
static void json_parameter(json *out, const mct_field *field)
{
    json_object(out, NULL);
    if (field->kind != MCT_FIELD_CHOICE) {
        json_quantity_within(out, field);
    } else {
        json_text(out, "name", field->name);
        json_choices(out, "choices", field);
        json_text(out, "default", choice_name(field, (int)field->standard));
        json_text(out, "doc", field->doc);
    }
    json_readers(out, field->effects);
    json_end_object(out);
}

static void json_rows(json *out, const mct_row_list *rows)
{
    json_object(out, NULL);
    json_text(out, "name", rows->name);
    json_text(out, "doc", rows->doc);
    json_readers(out, rows->effects);
    json_integer(out, "fewest_rows", rows->fewest_rows);
    json_integer(out, "most_rows", rows->most_rows);
    json_list(out, "columns");
    for (int i = 0; i < rows->column_count; i++) {
        json_parameter(out, &rows->columns[i]);
    }
    json_end_list(out);
    json_list(out, "default");
    for (int i = 0; i < rows->standard_rows; i++) {
        json_list(out, NULL);
        for (int j = 0; j < rows->column_count; j++) {
            const double value = rows->standard[i * rows->column_count + j];
            if (rows->columns[j].kind == MCT_FIELD_CHOICE) {
                json_text(out, NULL, choice_name(&rows->columns[j], (int)value));
            } else {
                json_number(out, NULL, value);
            }
        }
        json_end_list(out);
    }
    json_end_list(out);
    json_end_object(out);
}

static void json_system(json *out, const mct_system *system)
{
    json_object(out, NULL);
    json_text(out, "name", system->name);
    json_text(out, "doc", system->doc);
    json_text(out, "source", system->source);
    json_list(out, "coordinates");
    for (int i = 0; i < system->coordinate_count; i++) {
        json_coordinate(out, &system->coordinates[i]);
    }
    json_end_list(out);
    if (system->actuation != NULL) {
        const mct_coordinate *coordinates = system->coordinates;
        json_text(out, "driven_coordinate", coordinates[system->actuation->driven_coordinate].position.name);
        json_text(out, "upright_coordinate",
                  coordinates[system->actuation->upright_coordinate].position.name);
    }
    if (system->input_without_motor != NULL) {
        json_quantity(out, "input_without_motor", system->input_without_motor);
    }
    json_list(out, "parameters");
    for (int i = 0; i < system->parameter_count; i++) {
        json_parameter(out, &system->parameters[i]);
    }
    json_end_list(out);
    json_list(out, "lists");
    for (int i = 0; i < system->list_count; i++) {
        json_rows(out, &system->lists[i]);
    }
    json_end_list(out);
    json_list(out, "effects");
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        if (system->effects & mct_effects[i].mask) {
            json_object(out, NULL);
            json_text(out, "name", mct_effects[i].name);
            json_choice_of(out, "default", &mct_effects[i], system->standard_effects);
            json_list(out, "choices");
            for (int j = 0; mct_effects[i].choices != NULL && mct_effects[i].choices[j] != NULL; j++) {
                if (!(mct_effects[i].bits[j] & ~system->effects)) {
                    json_text(out, NULL, mct_effects[i].choices[j]);
                }
            }
            json_end_list(out);
            json_end_object(out);
        }
    }
    json_end_list(out);
    json_list(out, "particles");
    for (int i = 0; i < system->particle_count; i++) {
        json_text(out, NULL, system->particle_names[i]);
    }
    json_end_list(out);
    json_list(out, "steppers");
    for (int i = 0; i < MCT_STEPPER_COUNT; i++) {
        if (suits(system, i)) {
            json_text(out, NULL, mct_steppers[i].name);
        }
    }
    json_end_list(out);
    json_list(out, "steppers_without_friction");
    for (int i = 0; i < MCT_STEPPER_COUNT; i++) {
        if (may_suit(system, i) && !suits(system, i)) {
            json_text(out, NULL, mct_steppers[i].name);
        }
    }
    json_end_list(out);
    json_end_object(out);
}

static void json_key(json *out, const mct_field *field, const mct_scene *defaults)
{
    static const char *const kinds[] = {"real", "integer", "boolean", "choice", "text", "list"};
    json_object(out, NULL);
    json_text(out, "name", field->name);
    json_text(out, "kind", kinds[field->kind]);
    json_text(out, "unit", field->unit);
    switch (field->kind) {
    case MCT_FIELD_REAL:
    case MCT_FIELD_INTEGER:
        json_number(out, "minimum", field->minimum);
        json_number(out, "maximum", field->maximum);
        json_number(out, "default", field->standard);
        break;
    case MCT_FIELD_BOOLEAN:
        json_boolean(out, "default", field->standard > 0);
        break;
    case MCT_FIELD_CHOICE:
        json_choices(out, "choices", field);
        if (field->choices != NULL) { /* else by system */
            json_text(out, "default", choice_name(field, (int)field->standard));
        }
        break;
    case MCT_FIELD_TEXT:
        json_text(out, "default", default_text(defaults, field));
        break;
    case MCT_FIELD_LIST:
        json_number(out, "minimum", field->minimum);
        json_number(out, "maximum", field->maximum);
        break;
    }
    json_text(out, "doc", field->doc);
    json_end_object(out);
}

static void json_tables(json *out)
{
    mct_scene defaults;
    mct_scene_defaults(&defaults, 0);
    json_list(out, "tables");
    for (int i = 0; i < MCT_SCENE_TABLE_COUNT; i++) {
        const mct_scene_table *table = &mct_scene_tables[i];
        json_object(out, NULL);
        json_text(out, "name", table->name);
        json_text(out, "doc", table->doc);
        json_list(out, "keys");
        for (int j = 0; j < table->field_count; j++) {
            json_key(out, &table->fields[j], &defaults);
        }
        json_end_list(out);
        json_end_object(out);
    }
    json_end_list(out);
}

static void print_json(const mct_system *only)
{
    json out = json_begin(stdout, "mctau.list/1");
    json_list(&out, "systems");
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (only == NULL || only == mct_systems[i]) {
            json_system(&out, mct_systems[i]);
        }
    }
    json_end_list(&out);
    json_list(&out, "effects");
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        json_object(&out, NULL);
        json_text(&out, "name", mct_effects[i].name);
        json_text(&out, "doc", mct_effects[i].doc);
        json_list(&out, "choices");
        for (int j = 0; mct_effects[i].choices != NULL && mct_effects[i].choices[j] != NULL; j++) {
            json_text(&out, NULL, mct_effects[i].choices[j]);
        }
        if (mct_effects[i].choices == NULL) {
            json_boolean(&out, NULL, false);
            json_boolean(&out, NULL, true);
        }
        json_end_list(&out);
        json_end_object(&out);
    }
    json_end_list(&out);
    json_list(&out, "steppers");
    for (int i = 0; i < MCT_STEPPER_COUNT; i++) {
        json_object(&out, NULL);
        json_text(&out, "name", mct_steppers[i].name);
        json_integer(&out, "order", mct_steppers[i].order);
        json_text(&out, "doc", mct_steppers[i].doc);
        json_number(&out, "motor_stability_limit", mct_steppers[i].motor_stability_limit);
        json_end_object(&out);
    }
    json_end_list(&out);
    json_choices(&out, "controllers", kind_of("controller"));
    json_choices(&out, "inputs", kind_of("input"));
    json_tables(&out);
    json_finish(&out);
}

/* --- for people --- */

static void print_choices(const mct_field *field)
{
    for (int i = 0; choice_name(field, i) != NULL; i++) {
        printf("%s %s", i > 0 ? "," : "", choice_name(field, i));
    }
    printf("\n");
}

/* "; read by drag, buoyancy" of a coefficient */
static void print_readers(uint32_t readers)
{
    char buffer[64];
    const char *between = "; read by";
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        if (mct_effects[i].mask & readers) {
            printf("%s %s", between, reader_name(&mct_effects[i], readers, buffer, sizeof buffer));
            between = ",";
        }
    }
    printf("\n");
}

static void print_quantity(const mct_field *field)
{
    if (field->kind == MCT_FIELD_CHOICE) {
        printf("  %-24s %-8s %12s  %24s %s:", field->name, "", choice_name(field, (int)field->standard),
               "a name", field->doc);
        print_choices(field);
        return;
    }
    printf("  %-24s %-8s %12g  %10g to %-10g %s", field->name, field->unit, field->standard, field->minimum,
           field->maximum, field->doc);
    print_readers(field->effects);
}

static void print_heading(const char *title)
{
    printf("\n%-26s %-8s %12s  %24s\n", title, "unit", "default", "allowed");
}

static void print_rows(const mct_row_list *rows)
{
    printf("\n[parameters] %s: a list of %d to %d %s; %s", rows->name, rows->fewest_rows, rows->most_rows,
           rows->column_count > 1 ? "rows" : "numbers", rows->doc);
    print_readers(rows->effects);
    for (int i = 0; i < rows->column_count; i++) {
        const mct_field *field = &rows->columns[i];
        if (field->kind == MCT_FIELD_CHOICE) {
            print_quantity(field);
        } else {
            printf("  %-24s %-8s %12s  %10g to %-10g %s\n", field->name, field->unit, "", field->minimum,
                   field->maximum, field->doc);
        }
    }
    printf("  default [");
    for (int i = 0; i < rows->standard_rows * rows->column_count; i++) {
        const int column = i % rows->column_count;
        const mct_field *field = &rows->columns[column];
        printf("%s%s", i > 0 ? ", " : "", column == 0 && rows->column_count > 1 ? "[" : "");
        if (field->kind == MCT_FIELD_CHOICE) {
            printf("\"%s\"", choice_name(field, (int)rows->standard[i]));
        } else {
            printf("%g", rows->standard[i]);
        }
        printf("%s", column == rows->column_count - 1 && rows->column_count > 1 ? "]" : "");
    }
    printf("]\n");
}

static void print_effects(const mct_system *system)
{
    printf("\n[effects]%s\n", system->effects == 0 ? "                  none" : "");
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        const mct_effect *effect = &mct_effects[i];
        if (system->effects & effect->mask) {
            printf("  %-24s default %-14s %s\n", effect->name,
                   effect_choice(effect, system->standard_effects), effect->doc);
        }
    }
}

static void print_encoders(const mct_system *system)
{
    print_heading("[sensors]");
    for (int i = 0; i < system->coordinate_count; i++) {
        print_quantity(&system->coordinates[i].encoder);
    }
    print_heading("[weights]");
    for (int i = 0; i < 2 * system->coordinate_count; i++) {
        const mct_field *field = mct_state_field(system, i);
        const mct_coordinate *coordinate = &system->coordinates[i % system->coordinate_count];
        printf("  %-24s %-8s %12g  deviation that costs a controller as much as the full input\n",
               field->name, field->unit,
               i < system->coordinate_count ? coordinate->position_weight : coordinate->rate_weight);
    }
}

static void print_input(const mct_system *system)
{
    const mct_field *plain = system->input_without_motor;
    if (system->actuation != NULL) {
        printf("\nInput: a voltage [V]; with motor = \"off\" a %s [%s], %s\n", plain->name, plain->unit,
               plain->doc);
        printf("Driven: %s. Upright: %s = 0. ",
               system->coordinates[system->actuation->driven_coordinate].position.name,
               system->coordinates[system->actuation->upright_coordinate].position.name);
    } else if (plain != NULL) {
        printf("\nInput: a %s [%s], %s\n", plain->name, plain->unit, plain->doc);
    } else {
        printf("\nInput: none\n");
    }
}

static void print_system(const mct_system *system)
{
    printf("%s: %s (source %s)\n", system->name, system->doc, system->source);
    print_heading("[initial]");
    for (int i = 0; i < mct_most_states(system); i++) {
        print_quantity(mct_state_field(system, i));
    }
    print_heading("[parameters]");
    for (int i = 0; i < system->parameter_count; i++) {
        print_quantity(&system->parameters[i]);
    }
    for (int i = 0; i < system->list_count; i++) {
        print_rows(&system->lists[i]);
    }
    if (system->actuation != NULL) {
        print_encoders(system);
    }
    print_effects(system);
    print_input(system);
    printf("Particles:");
    if (system->lists_particles) {
        printf(" one for each row of %s%s", system->lists[0].name, system->particle_count > 0 ? ":" : "");
    }
    for (int i = 0; i < system->particle_count; i++) {
        printf(" %s", system->particle_names[i]);
    }
    printf("\n");
}

/* "; for cart_pole, pendulum" or "; not for chain", whichever is shorter; nothing when it suits all. */
static void print_suited(int stepper)
{
    int suited = 0;
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        suited += may_suit(mct_systems[i], stepper) ? 1 : 0;
    }
    const bool shown = 2 * suited < MCT_SYSTEM_COUNT;
    const char *between = shown ? "; for " : "; not for ";
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        if (may_suit(mct_systems[i], stepper) == shown) {
            printf("%s%s", between, mct_systems[i]->name);
            between = ", ";
        }
    }
}

static void print_steppers(const mct_system *only)
{
    printf("Steppers (scene.stepper)\n");
    for (int i = 0; i < MCT_STEPPER_COUNT; i++) {
        if (only != NULL && !may_suit(only, i)) {
            continue;
        }
        printf("  %-10s order %d  %s", mct_steppers[i].name, mct_steppers[i].order, mct_steppers[i].doc);
        if (only == NULL) {
            print_suited(i);
        }
        printf("\n");
    }
}

static void print_key(const mct_field *field, const mct_scene *defaults)
{
    printf("  %-24s ", field->name);
    switch (field->kind) {
    case MCT_FIELD_REAL:
    case MCT_FIELD_INTEGER:
        printf("%-8s %12g  %10g to %-10g %s\n", field->unit, field->standard, field->minimum, field->maximum,
               field->doc);
        return;
    case MCT_FIELD_LIST:
        printf("%-8s %12s  %10g to %-10g %s\n", field->unit, "[]", field->minimum, field->maximum,
               field->doc);
        return;
    case MCT_FIELD_BOOLEAN:
        printf("%-8s %12s  %24s %s\n", "", field->standard > 0 ? "true" : "false", "true or false",
               field->doc);
        return;
    case MCT_FIELD_TEXT:
        printf("%-8s %12s  %24s %s\n", "", default_text(defaults, field), "a text", field->doc);
        return;
    case MCT_FIELD_CHOICE:
        printf("%-8s %12s  %24s %s:", "",
               field->choices != NULL ? choice_name(field, (int)field->standard) : "", "a name", field->doc);
        print_choices(field);
        return;
    }
}

static void print_all(void)
{
    mct_scene defaults;
    mct_scene_defaults(&defaults, 0);
    printf("Systems (scene.system); mctau list SYSTEM shows coordinates, parameters and effects\n");
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        printf("  %-20s %s\n", mct_systems[i]->name, mct_systems[i]->doc);
    }
    printf("\n");
    print_steppers(NULL);
    printf("\nEffects ([effects])\n");
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        printf("  %-20s %s\n", mct_effects[i].name, mct_effects[i].doc);
    }
    printf("\nTables of a scene, beside [parameters], [effects], [initial] and [weights], whose keys are the "
           "system's\n");
    for (int i = 0; i < MCT_SCENE_TABLE_COUNT; i++) {
        const mct_scene_table *table = &mct_scene_tables[i];
        printf("\n[%s]  %s\n", table->name, table->doc);
        for (int j = 0; j < table->field_count; j++) {
            print_key(&table->fields[j], &defaults);
        }
    }
}

static int run_verb(const arguments *given)
{
    const mct_system *only = NULL;
    for (int i = 0; given->operand != NULL && i < MCT_SYSTEM_COUNT; i++) {
        if (strcmp(mct_systems[i]->name, given->operand) == 0) {
            only = mct_systems[i];
        }
    }
    if (given->operand != NULL && only == NULL) {
        mct_message names;
        mct_message_clear(&names);
        for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
            mct_message_add(&names, i > 0 ? ", " : "");
            mct_message_add(&names, mct_systems[i]->name);
        }
        return say(EXIT_USAGE, "list: found system %s; allowed %s", given->operand, names.text);
    }
    if (arguments_value(given, "json") != NULL) {
        print_json(only);
    } else if (only != NULL) {
        print_system(only);
        printf("\n");
        print_steppers(only);
    } else {
        print_all();
    }
    return EXIT_WELL;
}

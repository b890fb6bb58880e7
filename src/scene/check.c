#include "check.h"

#include <string.h>

#include "mctau/constants.h"
#include "mctau/matrix.h"
#include "mctau/stepper.h"
#include "pace.h"
#include "text.h"

/* --- sentences --- */

void mct_message_add_unit(mct_message *message, const mct_field *field)
{
    if (field->unit[0] != '\0') {
        mct_message_add(message, " ");
        mct_message_add(message, field->unit);
    }
}

static void add_bound(mct_message *message, const mct_field *field, double bound)
{
    if (field->kind == MCT_FIELD_INTEGER) {
        mct_message_add_integer(message, (long long)bound);
    } else {
        mct_message_add_number(message, bound);
    }
}

/* Adds ", " ahead of all names but the first. */
static void add_name(mct_message *message, const char *name, int *count)
{
    mct_message_add(message, *count > 0 ? ", " : "");
    mct_message_add(message, name);
    ++*count;
}

static void add_range(mct_message *message, const mct_field *field)
{
    if (field->kind == MCT_FIELD_CHOICE) {
        for (int i = 0, count = 0; mct_choice_name(field, i) != NULL; i++) {
            add_name(message, mct_choice_name(field, i), &count);
        }
        return;
    }
    add_bound(message, field, field->minimum);
    mct_message_add(message, " to ");
    add_bound(message, field, field->maximum);
    mct_message_add_unit(message, field);
}

/* "1 to 32 rows of mass (1e-06 to 1e+06 kg), position_1 (...)", or "1 to 16 numbers from 0.001 to 100 m" */
static void add_rows(mct_message *message, const mct_row_list *rows)
{
    mct_message_add_integer(message, rows->fewest_rows);
    mct_message_add(message, " to ");
    mct_message_add_integer(message, rows->most_rows);
    mct_message_add(message, rows->column_count == 1 ? " numbers from " : " rows of ");
    for (int i = 0; i < rows->column_count; i++) {
        if (rows->column_count > 1) {
            mct_message_add(message, i > 0 ? ", " : "");
            mct_message_add(message, rows->columns[i].name);
            mct_message_add(message, " (");
        }
        add_range(message, &rows->columns[i]);
        mct_message_add(message, rows->column_count > 1 ? ")" : "");
    }
}

void mct_message_add_allowed(mct_message *message, const mct_scene_key *key, const mct_system *system)
{
    const mct_field *const field = &key->field;
    int count = 0;
    switch (field->kind) {
    case MCT_FIELD_BOOLEAN:
        mct_message_add(message, key->effect != NULL && (key->effect->mask & ~system->effects)
                                     ? "false"
                                     : "true or false");
        break;
    case MCT_FIELD_CHOICE:
        for (int32_t i = 0; mct_choice_name(field, i) != NULL; i++) {
            if (key->effect == NULL || !(key->effect->bits[i] & ~system->effects)) {
                add_name(message, mct_choice_name(field, i), &count);
            }
        }
        break;
    case MCT_FIELD_TEXT:
        mct_message_add(message, "a text of at most ");
        mct_message_add_integer(message, (long long)field->maximum - 1);
        mct_message_add(message, " bytes");
        break;
    case MCT_FIELD_LIST:
        if (key->rows != NULL) {
            add_rows(message, key->rows);
            break;
        }
        mct_message_add(message, "at most ");
        mct_message_add_integer(message, MCT_MAX_LIST);
        mct_message_add(message, " numbers from ");
        /* fall through */
    case MCT_FIELD_REAL:
    case MCT_FIELD_INTEGER:
        add_range(message, field);
        break;
    }
}

/* --- single keys --- */

bool mct_field_allows(const mct_field *field, double value)
{
    return value >= field->minimum && value <= field->maximum; /* a NaN is neither */
}

static bool is_choice(const mct_field *field, double value)
{
    return value >= 0 && value < INT32_MAX && value == (int32_t)value &&
           mct_choice_name(field, (int32_t)value) != NULL;
}

static mct_status refuse_number(const mct_scene_key *key, const mct_system *system, double value,
                                mct_message *sentence)
{
    mct_message_add(sentence, "found ");
    mct_message_add_number(sentence, value);
    mct_message_add_unit(sentence, &key->field);
    mct_message_add(sentence, "; allowed ");
    mct_message_add_allowed(sentence, key, system);
    return MCT_ERROR_RANGE;
}

/* "found -1 kg as mass of row 2", "found 7 as number 3" */
static void add_place(mct_message *sentence, const mct_row_list *rows, int32_t index)
{
    const bool has_columns = rows != NULL && rows->column_count > 1;
    mct_message_add(sentence, " as ");
    mct_message_add(sentence, has_columns ? rows->columns[index % rows->column_count].name : "number ");
    mct_message_add(sentence, has_columns ? " of row " : "");
    mct_message_add_integer(sentence, has_columns ? index / rows->column_count + 1 : index + 1);
}

mct_status mct_list_examine(const mct_scene_key *key, const mct_system *system, const mct_list *list,
                            mct_message *sentence)
{
    const mct_row_list *const rows = key->rows;
    const int columns = rows != NULL ? rows->column_count : 1;
    const int32_t fewest = rows != NULL ? rows->fewest_rows : 0;
    const int32_t most = rows != NULL ? rows->most_rows : MCT_MAX_LIST;
    if (list->count % columns != 0 || list->count < fewest * columns || list->count > most * columns) {
        mct_message_add(sentence, "found ");
        mct_message_add_integer(sentence, list->count / columns);
        mct_message_add(sentence, columns > 1 ? " rows; allowed " : " numbers; allowed ");
        mct_message_add_allowed(sentence, key, system);
        return MCT_ERROR_BOUND;
    }
    for (int32_t i = 0; i < list->count; i++) {
        const mct_field *const field = rows != NULL ? &rows->columns[i % columns] : &key->field;
        const double value = list->values[i];
        if (field->kind == MCT_FIELD_CHOICE ? !is_choice(field, value) : !mct_field_allows(field, value)) {
            mct_message_add(sentence, "found ");
            mct_message_add_number(sentence, value);
            mct_message_add_unit(sentence, field);
            add_place(sentence, rows, i);
            mct_message_add(sentence, "; allowed ");
            add_range(sentence, field);
            return MCT_ERROR_RANGE;
        }
    }
    return MCT_OK;
}

static mct_status examine_key(const mct_scene *scene, const mct_scene_key *key, const mct_system *system,
                              mct_message *sentence)
{
    const mct_field *const field = &key->field;
    const char *const place = (const char *)scene + field->offset;
    switch (field->kind) {
    case MCT_FIELD_TEXT: {
        size_t length = 0;
        while (length < (size_t)field->maximum && place[length] != '\0') {
            length++;
        }
        if (length == (size_t)field->maximum) {
            mct_message_add(sentence, "found a text without an end; allowed ");
            mct_message_add_allowed(sentence, key, system);
            return MCT_ERROR_BOUND;
        }
        return MCT_OK;
    }
    case MCT_FIELD_LIST:
        return mct_list_examine(key, system, (const mct_list *)(const void *)place, sentence);
    case MCT_FIELD_CHOICE: {
        const double index = mct_key_get(scene, key);
        return is_choice(field, index) ? MCT_OK : refuse_number(key, system, index, sentence);
    }
    case MCT_FIELD_BOOLEAN: {
        const double value = mct_key_get(scene, key);
        return value == 0 || value == 1 ? MCT_OK : refuse_number(key, system, value, sentence);
    }
    case MCT_FIELD_REAL:
    case MCT_FIELD_INTEGER:
        break;
    }
    const double value = mct_key_get(scene, key);
    return mct_field_allows(field, value) ? MCT_OK : refuse_number(key, system, value, sentence);
}

static mct_status examine_keys(const mct_scene *scene, const mct_system *system, mct_blame *blame,
                               mct_message *sentence)
{
    for (int table = 0; table < MCT_TABLE_COUNT; table++) {
        for (int i = 0; i < mct_key_count(table, system); i++) {
            const mct_scene_key key = mct_key_at(table, system, i);
            const mct_status status =
                key.effect != NULL ? MCT_OK : examine_key(scene, &key, system, sentence);
            if (status != MCT_OK) {
                blame->table = mct_table_name(table);
                blame->key = key.field.name;
                return status;
            }
        }
    }
    return MCT_OK;
}

/* --- keys together --- */

#define SMALLEST_QUATERNION 1e-100 /* whose square can still be divided by */
#define LENGTH_TOLERANCE    1e-8   /* of its square: what eight or more digits make of 1 */

static mct_status examine_effects(const mct_scene *scene, const mct_system *system, mct_blame *blame,
                                  mct_message *sentence)
{
    blame->table = "effects";
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        const mct_scene_key key = mct_key_at(MCT_TABLE_EFFECTS, system, i);
        const uint32_t bits = scene->effects & key.effect->mask;
        const bool is_choice =
            bits == key.effect->bits[0] || bits == key.effect->bits[1] || bits == key.effect->bits[2];
        if (!is_choice || (bits & ~system->effects)) {
            blame->key = key.field.name;
            mct_message_add(sentence, is_choice ? "found what " : "found more than one; ");
            mct_message_add(sentence, is_choice ? system->name : "");
            mct_message_add(sentence, is_choice ? " has not; allowed " : "allowed ");
            mct_message_add_allowed(sentence, &key, system);
            return is_choice ? MCT_ERROR_UNSUITED : MCT_ERROR_RANGE;
        }
    }
    uint32_t known = 0;
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        known |= mct_effects[i].mask;
    }
    if (scene->effects & ~known) {
        blame->key = "*";
        mct_message_add(sentence, "found bits that no effect has");
        return MCT_ERROR_RANGE;
    }
    return MCT_OK;
}

/* "gravity, viscous, motor = inductive" */
static void add_effects(mct_message *sentence, uint32_t effects)
{
    int count = 0;
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        const mct_effect *const effect = &mct_effects[i];
        const uint32_t bits = effects & effect->mask & MCT_KERNEL_EFFECTS;
        if (bits == 0) {
            continue;
        }
        add_name(sentence, effect->name, &count);
        for (int choice = 1; effect->choices != NULL && choice < 3; choice++) {
            if (effect->bits[choice] == bits) {
                mct_message_add(sentence, " = ");
                mct_message_add(sentence, effect->choices[choice]);
            }
        }
    }
    if (count == 0) {
        mct_message_add(sentence, "no effects");
    }
}

static void add_suitable_steppers(const mct_scene *scene, mct_message *sentence)
{
    int count = 0;
    for (int i = 0; i < MCT_STEPPER_COUNT; i++) {
        if (mct_stepper_suits(scene, i)) {
            add_name(sentence, mct_steppers[i].name, &count);
        }
    }
    mct_message_add(sentence, count > 0 ? "" : "none");
}

/* The largest number of three digits that does not exceed a positive value. */
static double round_down(double value)
{
    double unit = 1;
    for (int i = 0; i < 40 && value / unit >= 1000; i++) {
        unit *= 10;
    }
    for (int i = 0; i < 40 && value / unit < 100; i++) {
        unit /= 10;
    }
    return (int)(value / unit) * unit;
}

static mct_status examine_stepper(const mct_scene *scene, const mct_system *system, mct_blame *blame,
                                  mct_message *sentence)
{
    if (scene->stepper == MCT_STEPPER_COUNT) {
        blame->table = "scene";
        blame->key = "stepper";
        mct_message_add(sentence,
                        "found auto, which is only of a scene's text; allowed the index of a stepper");
        return MCT_ERROR_RANGE;
    }
    if (mct_stepper_suits(scene, scene->stepper)) {
        return MCT_OK;
    }
    const mct_stepper *const stepper = &mct_steppers[scene->stepper];
    const uint32_t effects = mct_scene_effects(scene);
    blame->table = "scene";
    blame->key = "stepper";
    mct_message_add(sentence, "found ");
    mct_message_add(sentence, stepper->name);
    if (system->kernel(scene->stepper, effects & MCT_KERNEL_EFFECTS) == NULL) {
        mct_message_add(sentence, ", which does not suit ");
        mct_message_add(sentence, system->name);
        mct_message_add(sentence, " with ");
        add_effects(sentence, effects);
        if (stepper->needs_smooth && (effects & (MCT_COULOMB_MOREAU | MCT_DRAG))) {
            const uint32_t exact = (effects & ~(uint32_t)MCT_COULOMB) | MCT_COULOMB_EXACT;
            mct_message_add(sentence, ", for a series ends where friction has a kink");
            if (system->kernel(scene->stepper, exact & MCT_KERNEL_EFFECTS) != NULL) {
                mct_message_add(sentence, ", unless coulomb = \"exact\" finds it");
            }
        } else if (effects & MCT_COULOMB_EXACT) {
            mct_message_add(sentence, ", for coulomb = \"exact\" is found on a series");
        }
        mct_message_add(sentence, "; allowed ");
        add_suitable_steppers(scene, sentence);
        return MCT_ERROR_UNSUITED;
    }

    const double stiffness = mct_motor_stiffness(scene);
    const double limit = stepper->motor_stability_limit;
    const double longest_tick = round_down(scene->dt / stiffness * limit);
    const double substeps = scene->substeps * (stiffness / limit);
    mct_message_add(sentence, ", which follows an inductive motor up to h R/L = ");
    mct_message_add_number(sentence, limit);
    mct_message_add(sentence, "; at h = ");
    mct_message_add_number(sentence, mct_scene_step(scene));
    mct_message_add(sentence, " s it is ");
    mct_message_add_number(sentence, stiffness);
    mct_message_add(sentence, "; allowed ");
    add_suitable_steppers(scene, sentence);
    if (scene->stride > 1) {
        mct_message_add(sentence, ", or a scene.stride below ");
        mct_message_add_integer(sentence, (long long)(scene->stride * (limit / stiffness)) + 1);
    }
    for (int i = 0; i < mct_key_count(0, system) && scene->stride == 1; i++) {
        const mct_scene_key key = mct_key_at(0, system, i);
        if (mct_text_equal(key.field.name, "substeps") && substeps < key.field.maximum) {
            mct_message_add(sentence, ", or scene.substeps from ");
            mct_message_add_integer(sentence, (long long)substeps + 1);
        }
        if (mct_text_equal(key.field.name, "dt") && longest_tick >= key.field.minimum) {
            mct_message_add(sentence, ", or scene.dt up to ");
            mct_message_add_number(sentence, longest_tick);
            mct_message_add(sentence, " s");
        }
    }
    return MCT_ERROR_UNSUITED;
}

/* Ticks within a step are read off its series, which not every stepper has. */
static mct_status examine_stride(const mct_scene *scene, const mct_system *system, mct_blame *blame,
                                 mct_message *sentence)
{
    if (scene->stride == 1) {
        return MCT_OK;
    }
    blame->table = "scene";
    blame->key = "stride";
    mct_message_add(sentence, "found ");
    mct_message_add_integer(sentence, scene->stride);
    if (scene->substeps > 1) {
        mct_message_add(sentence, " beside scene.substeps = ");
        mct_message_add_integer(sentence, scene->substeps);
        mct_message_add(sentence, "; allowed either above 1");
        return MCT_ERROR_UNSUITED;
    }
    if (scene->stepper != MCT_STEPPER_TAYLOR12) {
        mct_message_add(sentence, " with stepper ");
        mct_message_add(sentence, mct_steppers[scene->stepper].name);
        mct_message_add(sentence, ", which has no series to read ticks off; allowed 1, or stepper taylor12");
        return MCT_ERROR_UNSUITED;
    }
    if (scene->effects & MCT_COULOMB_EXACT) {
        mct_message_add(sentence, " with coulomb = \"exact\", which cuts the series; allowed 1");
        return MCT_ERROR_UNSUITED;
    }
    if (system->motion == NULL) {
        mct_message_add(sentence, ", for which ");
        mct_message_add(sentence, system->name);
        mct_message_add(sentence, " has no series to hand; allowed 1");
        return MCT_ERROR_UNSUITED;
    }
    return MCT_OK;
}

static mct_status examine_controller(const mct_scene *scene, mct_blame *blame, mct_message *sentence)
{
    if (scene->controller == MCT_CONTROLLER_NONE) {
        return MCT_OK;
    }
    blame->table = "controller";
    blame->key = "kind";
    if (!(scene->effects & MCT_MOTOR)) {
        mct_message_add(sentence, "found a controller, which gives a voltage, with effects.motor = off; "
                                  "allowed with quasi_static or inductive");
        return MCT_ERROR_UNSUITED;
    }
    if (scene->input != MCT_INPUT_NONE) {
        mct_message_add(sentence,
                        "found a controller together with an open-loop [input]; allowed one of them, "
                        "the other's kind being none");
        return MCT_ERROR_UNSUITED;
    }
    return MCT_OK;
}

bool mct_input_reads(int32_t kind, const char *key)
{
    static const struct {
        int32_t kind;
        const char *key;
    } readers[] = {
        {MCT_INPUT_CONSTANT, "value"}, {MCT_INPUT_SINE, "value"},  {MCT_INPUT_SINE, "amplitude"},
        {MCT_INPUT_SINE, "frequency"}, {MCT_INPUT_STEPS, "times"}, {MCT_INPUT_STEPS, "values"},
        {MCT_INPUT_CSV, "file"},       {MCT_INPUT_CSV, "column"},
    };
    bool reads = mct_text_equal(key, "kind");
    for (size_t i = 0; i < sizeof readers / sizeof readers[0]; i++) {
        reads = reads || (readers[i].kind == kind && mct_text_equal(readers[i].key, key));
    }
    return reads;
}

static mct_status examine_input(const mct_scene *scene, const mct_system *system, mct_blame *blame,
                                mct_message *sentence)
{
    const mct_list *const times = &scene->input_times;
    const mct_list *const values = &scene->input_values;
    blame->table = "input";
    if (scene->input != MCT_INPUT_NONE && system->actuation == NULL && system->input_without_motor == NULL) {
        blame->key = "kind";
        mct_message_add(sentence, "found an input, which ");
        mct_message_add(sentence, system->name);
        mct_message_add(sentence, " has not; allowed none");
        return MCT_ERROR_UNSUITED;
    }
    if (scene->input == MCT_INPUT_CSV && (scene->input_file[0] == '\0' || scene->input_column[0] == '\0')) {
        blame->key = scene->input_file[0] == '\0' ? "file" : "column";
        mct_message_add(sentence, "found none; an input of kind csv needs a file and the name of a column");
        return MCT_ERROR_UNSUITED;
    }
    if (scene->input != MCT_INPUT_STEPS) {
        return MCT_OK;
    }
    blame->key = "times";
    if (times->count == 0 || times->count != values->count) {
        mct_message_add(sentence, "found ");
        mct_message_add_integer(sentence, times->count);
        mct_message_add(sentence, " times and ");
        mct_message_add_integer(sentence, values->count);
        mct_message_add(sentence, " values; allowed equally many, at least one");
        return MCT_ERROR_UNSUITED;
    }
    for (int32_t i = 1; i < times->count; i++) {
        if (!(times->values[i] > times->values[i - 1])) {
            mct_message_add(sentence, "found ");
            mct_message_add_number(sentence, times->values[i]);
            mct_message_add(sentence, " s behind ");
            mct_message_add_number(sentence, times->values[i - 1]);
            mct_message_add(sentence, " s; allowed only rising times");
            return MCT_ERROR_UNSUITED;
        }
    }
    return MCT_OK;
}

static mct_status examine_attitude(const mct_scene *scene, const mct_system *system, mct_blame *blame,
                                   mct_message *sentence)
{
    if (system->attitude == MCT_ATTITUDE_NONE) {
        return MCT_OK;
    }
    const int first = mct_rate_index(system) - 4;
    for (int i = first; i < first + 4; i++) {
        if (mct_abs(scene->initial[i]) > SMALLEST_QUATERNION) {
            return MCT_OK;
        }
    }
    blame->table = "initial";
    blame->key = mct_state_field(system, first)->name;
    mct_message_add(sentence, "found a quaternion of length 0; allowed any other, as 1, 0, 0, 0");
    return MCT_ERROR_UNSUITED;
}

static mct_status examine_duration(const mct_scene *scene, mct_blame *blame, mct_message *sentence)
{
    const double ticks = scene->duration / scene->dt;
    const int64_t nearest = (int64_t)(ticks + 0.5); /* at most 1e14 */
    const double difference = ticks - (double)nearest;
    /* 1e-9 of a tick, and what rounding the three numbers may have cost. */
    const double tolerance = 1e-9 + 4 * DBL_EPSILON * ticks;
    if (difference <= tolerance && -difference <= tolerance) {
        return MCT_OK;
    }
    blame->table = "scene";
    blame->key = "duration";
    mct_message_add(sentence, "found ");
    mct_message_add_number(sentence, scene->duration);
    mct_message_add(sentence, " s, which is not a whole number of ticks of ");
    mct_message_add_number(sentence, scene->dt);
    mct_message_add(sentence, " s; the nearest is ");
    mct_message_add_number(sentence, (double)nearest * scene->dt);
    mct_message_add(sentence, " s, ");
    mct_message_add_integer(sentence, nearest);
    mct_message_add(sentence, nearest == 1 ? " tick" : " ticks");
    return MCT_ERROR_UNSUITED;
}

/* What only the system itself can say: its constants are computed, and thrown away. Its sentence is "table.key: ...". */
static mct_status examine_system(const mct_scene *scene, const mct_system *system, mct_blame *blame,
                                 mct_message *sentence)
{
    mct_constants constants;
    mct_message why;
    mct_message_clear(&why);
    if (system->prepare(scene, mct_scene_step(scene), &constants, &why) == MCT_OK) {
        return MCT_OK;
    }
    blame->table = "parameters";
    const char *text = why.text;
    for (int table = 0; table < MCT_TABLE_COUNT && text == why.text; table++) {
        const mct_span name = mct_text_span(mct_table_name(table));
        const mct_span begin = {why.text, name.length};
        if (mct_text_length(why.text) > name.length && mct_span_equal(begin, name) &&
            why.text[name.length] == '.') {
            blame->table = mct_table_name(table);
            text += name.length + 1;
        }
    }
    size_t length = 0;
    while (text > why.text && text[length] != ':' && text[length] != '\0' &&
           length + 1 < sizeof blame->key_text) {
        blame->key_text[length] = text[length];
        length++;
    }
    blame->key_text[length] = '\0';
    blame->key = length > 0 ? blame->key_text : "*";
    mct_message_add(sentence, length > 0 && text[length] == ':' ? text + length + 2 : text + length);
    return MCT_ERROR_UNSUITED;
}

/* "0.001 s by rk4" */
static void add_step(mct_message *message, const mct_scene *scene)
{
    mct_message_add_number(message, mct_scene_step(scene));
    mct_message_add(message, " s by ");
    mct_message_add(message, mct_steppers[scene->stepper].name);
}

/* "at pole_angle = 3.14159, where cart_position feels 1e-06 of its inertia" */
static void add_place_of_pace(mct_message *message, const mct_system *system, const mct_pace *pace)
{
    if (pace->coordinate >= 0) {
        mct_message_add(message, " at ");
        mct_message_add(message, system->coordinates[pace->coordinate].position.name);
        mct_message_add(message, " = ");
        mct_message_add_number(message, pace->angle);
    }
    if (pace->share < MCT_SMALL_SHARE) {
        mct_message_add(message, ", where ");
        mct_message_add(message, system->coordinates[pace->lightest].position.name);
        mct_message_add(message, " feels ");
        mct_message_add_number(message, pace->share);
        mct_message_add(message, " of its inertia");
    }
}

/* "steps up to 3.9e-06 s, scene.substeps from 256" */
static void add_remedy(mct_message *message, const mct_scene *scene, const mct_pace *pace)
{
    const mct_field *substeps = NULL;
    for (int i = 0; i < mct_scene_tables[0].field_count; i++) {
        if (mct_text_equal(mct_scene_tables[0].fields[i].name, "substeps")) {
            substeps = &mct_scene_tables[0].fields[i];
        }
    }
    if (pace->longest == 0) {
        mct_message_add(message, "no step that was tried");
        return;
    }
    const double needed = scene->dt / pace->longest;
    mct_message_add(message, "steps up to ");
    mct_message_add_number(message, pace->longest);
    mct_message_add(message, " s");
    if (scene->stride > 1 && needed <= 1) {
        mct_message_add(message, ", a smaller scene.stride");
    } else if (needed <= substeps->maximum) { /* NOLINT(*NullDereference): the table has it */
        mct_message_add(message, ", scene.substeps from ");
        mct_message_add_integer(message, (long long)(needed + 0.5));
    } else {
        mct_message_add(message, ", more than the ");
        mct_message_add_integer(message, (long long)substeps->maximum);
        mct_message_add(message, " scene.substeps of a tick: with these a scene.dt up to ");
        mct_message_add_number(message, substeps->maximum * pace->longest);
        mct_message_add(message, " s");
    }
}

/* Steps that are far too long for what moves. */
static mct_status examine_pace(const mct_scene *scene, const mct_system *system, mct_blame *blame,
                               mct_message *sentence)
{
    mct_pace pace;
    mct_pace_find(scene, &pace);
    if (pace.verdict != MCT_PACE_NOT_FOLLOWED) {
        return MCT_OK;
    }
    blame->table = "scene";
    blame->key = "dt";
    mct_message_add(sentence, "found steps of ");
    add_step(sentence, scene);
    mct_message_add(sentence, ", which do not follow the motion");
    add_place_of_pace(sentence, system, &pace);
    mct_message_add(sentence, "; allowed ");
    add_remedy(sentence, scene, &pace);
    return MCT_ERROR_UNSUITED;
}

mct_status mct_scene_examine(const mct_scene *scene, mct_blame *blame, mct_message *sentence)
{
    blame->table = "scene";
    blame->key = "system";
    mct_message_clear(sentence);
    if (scene->system < 0 || scene->system >= MCT_SYSTEM_COUNT) {
        mct_message_add(sentence, "found a system that there is not");
        return MCT_ERROR_RANGE;
    }
    const mct_system *const system = mct_systems[scene->system];
    mct_status status = examine_keys(scene, system, blame, sentence);
    status = status != MCT_OK ? status : examine_effects(scene, system, blame, sentence);
    status = status != MCT_OK ? status : examine_stepper(scene, system, blame, sentence);
    status = status != MCT_OK ? status : examine_stride(scene, system, blame, sentence);
    status = status != MCT_OK ? status : examine_controller(scene, blame, sentence);
    status = status != MCT_OK ? status : examine_input(scene, system, blame, sentence);
    status = status != MCT_OK ? status : examine_attitude(scene, system, blame, sentence);
    status = status != MCT_OK ? status : examine_duration(scene, blame, sentence);
    status = status != MCT_OK ? status : examine_system(scene, system, blame, sentence);
    status = status != MCT_OK ? status : examine_pace(scene, system, blame, sentence);
    return status;
}

/* "viscous = false" or "motor = off", of all effects in a mask */
static void add_switched_off(mct_message *note, const mct_system *system, uint32_t mask)
{
    int count = 0;
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        const mct_effect *const effect = &mct_effects[i];
        if (!(effect->mask & mask & system->effects)) {
            continue;
        }
        mct_message_add(note, count++ > 0 ? " and effects." : "effects.");
        mct_message_add(note, effect->name);
        mct_message_add(note, effect->choices == NULL || effect->bits[1] & mask ? " off" : " not ");
        if (effect->choices != NULL && !(effect->bits[1] & mask)) {
            mct_message_add(note, effect->choices[2]);
        }
    }
}

/* The number-th coefficient that is given in vain. */
static bool note_idle_coefficient(const mct_scene *scene, const mct_system *system, int number,
                                  mct_message *note)
{
    for (int i = 0; i < mct_key_count(MCT_TABLE_PARAMETERS, system); i++) {
        const mct_scene_key key = mct_key_at(MCT_TABLE_PARAMETERS, system, i);
        const uint32_t readers = key.rows != NULL ? key.rows->effects : key.field.effects;
        if (!(scene->given & (UINT32_C(1) << i)) || readers == 0 ||
            (readers & mct_scene_effects(scene)) != 0 || number-- > 0) {
            continue;
        }
        mct_message_clear(note);
        mct_message_add(note, "parameters.");
        mct_message_add(note, key.field.name);
        mct_message_add(note, ": given with ");
        add_switched_off(note, system, readers);
        mct_message_add(note, ": nothing reads it");
        return true;
    }
    return false;
}

static bool note_quaternion(const mct_scene *scene, const mct_system *system, mct_message *note)
{
    double square = 0;
    if (system->attitude == MCT_ATTITUDE_NONE) {
        return false;
    }
    const int first = mct_rate_index(system) - 4;
    for (int i = first; i < first + 4; i++) {
        square += scene->initial[i] * scene->initial[i];
    }
    if (mct_abs(square - 1) < LENGTH_TOLERANCE) {
        return false;
    }
    mct_message_clear(note);
    mct_message_add(note, "initial.attitude: found a quaternion of length ");
    mct_message_add_number(note, mct_sqrt(square));
    mct_message_add(note, "; it is taken with length 1");
    return true;
}

static bool note_pace(const mct_scene *scene, const mct_system *system, mct_message *note)
{
    mct_pace pace;
    mct_pace_find(scene, &pace);
    if (pace.verdict != MCT_PACE_LONG) {
        return false;
    }
    mct_message_clear(note);
    mct_message_add(note, "scene.dt: steps of ");
    add_step(note, scene);
    mct_message_add(note, " are long for the motion");
    add_place_of_pace(note, system, &pace);
    mct_message_add(note, ": two of half the length change rates by ");
    mct_message_add_number(note, (int)(100 * pace.error + 0.5));
    mct_message_add(note, " %; it asks for ");
    add_remedy(note, scene, &pace);
    return true;
}

bool mct_scene_note(const mct_scene *scene, int number, mct_message *note)
{
    const mct_system *const system = mct_systems[scene->system];
    if (note_quaternion(scene, system, note) && number-- == 0) {
        return true;
    }
    if (note_pace(scene, system, note) && number-- == 0) {
        return true;
    }
    return note_idle_coefficient(scene, system, number, note);
}

mct_status mct_scene_check(const mct_scene *scene, mct_message *why)
{
    mct_blame blame;
    mct_message sentence;
    const mct_status status = mct_scene_examine(scene, &blame, &sentence);
    if (status != MCT_OK) {
        mct_message_clear(why);
        mct_message_add(why, blame.table);
        mct_message_add(why, ".");
        mct_message_add(why, blame.key);
        mct_message_add(why, ": ");
        mct_message_add(why, sentence.text);
    }
    return status;
}

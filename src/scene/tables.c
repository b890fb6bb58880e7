#include "tables.h"

#include <string.h>

#include "mctau/stepper.h"

/* --- the fixed tables --- */

#define PLACE(member) offsetof(mct_scene, member)
#define REAL(name, unit, minimum, maximum, standard, member, doc)                           \
    {                                                                                       \
        name, unit, doc, MCT_FIELD_REAL, minimum, maximum, standard, NULL, PLACE(member), 0 \
    }
#define INTEGER(name, unit, minimum, maximum, standard, member, doc)                           \
    {                                                                                          \
        name, unit, doc, MCT_FIELD_INTEGER, minimum, maximum, standard, NULL, PLACE(member), 0 \
    }
#define BOOLEAN(name, standard, member, doc)                                     \
    {                                                                            \
        name, "", doc, MCT_FIELD_BOOLEAN, 0, 1, standard, NULL, PLACE(member), 0 \
    }
#define CHOICE(name, choices, standard, member, doc)                               \
    {                                                                              \
        name, "", doc, MCT_FIELD_CHOICE, 0, 0, standard, choices, PLACE(member), 0 \
    }
#define TEXT(name, member, doc)                                                   \
    {                                                                             \
        name, "", doc, MCT_FIELD_TEXT, 0, MCT_MAX_TEXT, 0, NULL, PLACE(member), 0 \
    }
#define LIST(name, unit, minimum, maximum, member, doc)                              \
    {                                                                                \
        name, unit, doc, MCT_FIELD_LIST, minimum, maximum, 0, NULL, PLACE(member), 0 \
    }

#define LONGEST       1e7 /* [s] */
#define LARGEST_INPUT 1e9 /* [V], [N] or [N m] */

static const char *const precisions[] = {"double", "float", NULL};
static const char *const controllers[] = {"none", "swing_up_balance", NULL};
static const char *const inputs[] = {"none", "constant", "sine", "steps", "csv", NULL};
static const char *const faults[] = {"none", "nan", "silent", "frozen", NULL};
static const char *const can_protocols[] = {"native", "vesc", "odrive", NULL};
static const char *const can_modes[] = {"voltage", "foc", "torque", NULL};
static const char *const can_firmwares[] = {"0.6", "0.5", NULL};
static const char *const can_faults[] = {"none",    "drop",   "drop_commands", "delay",  "duplicate",
                                         "reorder", "short",  "remote",        "format", "nan",
                                         "silence", "reboot", "estop",         "error",  NULL};

/* The names of systems and steppers stand in mct_systems and mct_steppers: see mct_choice_name. */
static const mct_field scene_fields[] = {
    CHOICE("system", NULL, 0, system, "what is simulated; must be given"),
    CHOICE("stepper", NULL, MCT_STEPPER_RK4, stepper,
           "how; left out: the most accurate that suits system and effects, but no taylor; auto: the command "
           "takes the "
           "cheapest that meets the tolerance, and its substeps"),
    REAL("tolerance", "", 1e-15, 1e6, 1e-6, tolerance,
         "of stepper = auto: largest error at any tick, relative to a state's largest value or to 1"),
    REAL("dt", "s", 1e-7, 1, 0.001, dt, "the tick: one reading of the sensors, one command, one record"),
    INTEGER("substeps", "", 1, 1000, 1, substeps, "steps of the simulation within a tick"),
    INTEGER("stride", "", 1, 1000, 1, stride,
            "ticks that one step of taylor12 may go while the input stays the same: those between are read "
            "off its series"),
    REAL("duration", "s", 0, LONGEST, 10, duration, "a whole number of ticks"),
    CHOICE("precision", precisions, MCT_PRECISION_DOUBLE, precision,
           "scalar of the simulation and the controller"),
    TEXT(
        "hal", hal,
        "the hardware: sim; ring (simulated drives on a simulated bus); socketcan:INTERFACE; candump:FILE (a "
        "recorded bus)"),
    BOOLEAN("realtime", 0, realtime, "paced by the clock instead of by the simulation"),
};

static const mct_field controller_fields[] = {
    CHOICE("kind", controllers, MCT_CONTROLLER_NONE, controller, "what decides the voltage"),
    REAL("observer_bandwidth", "rad/s", 1, 1e4, 50, observer_bandwidth, "of the velocity estimate"),
    REAL("energy_band", "", 0.001, 10, 0.02, energy_band,
         "fraction of the energy from hanging to upright over which pumping fades out"),
    REAL("capture", "", 0.05, 0.95, 0.5, capture,
         "fraction of the region from which the voltage can still catch the upright at which balancing takes "
         "over"),
    REAL("track_half_length", "m", 0.01, 1000, 0.4, track_half_length,
         "a coordinate that is a length stays within +- this"),
    REAL("overspeed", "rad/s", 1, 1e6, 2000, overspeed,
         "rate of an angle beyond which the supervisor cuts the voltage"),
    REAL("give_up_after", "s", 0, LONGEST, 120, give_up_after,
         "time without balance, less that with it, after which the supervisor cuts the voltage; 0: never"),
    REAL("rearm_after", "s", 0, 1000, 0, rearm_after,
         "after a fault drive again when feedback has been well for so long; 0: only when asked to"),
    REAL("input_weight", "", 1e-6, 1e6, 1, input_weight, "cost of the voltage; larger is gentler"),
};

static const mct_field input_fields[] = {
    CHOICE("kind", inputs, MCT_INPUT_NONE, input,
           "open-loop input: volts with a motor, else newtons or newton metres"),
    REAL("value", "", -LARGEST_INPUT, LARGEST_INPUT, 0, input_value,
         "of a constant; of a sine, what it swings about"),
    REAL("amplitude", "", 0, LARGEST_INPUT, 0, input_amplitude, "of a sine"),
    REAL("frequency", "rad/s", 0, 1e6, 1, input_frequency, "of a sine"),
    LIST("times", "s", 0, LONGEST, input_times, "of steps, rising; zero before the first"),
    LIST("values", "", -LARGEST_INPUT, LARGEST_INPUT, input_values, "of steps, each held from its time on"),
    TEXT("file", input_file, "CSV file with a header line, one row a tick; the last row is held"),
    TEXT("column", input_column, "name of the column in the file"),
};

static const mct_field sensor_fields[] = {
    INTEGER("counter_bits", "", 8, 32, 32, counter_bits, "width of an encoder's counter, which wraps"),
    INTEGER("latency", "ticks", 0, 16, 0, latency, "age of the counts that a controller sees"),
    REAL("noise", "counts", 0, 1000, 0, noise, "standard deviation of each count"),
    INTEGER("seed", "", 0, INT32_MAX, 0, sensor_seed, "of the noise"),
    CHOICE("fault", faults, MCT_SENSOR_FAULT_NONE, sensor_fault, "what befalls the sensors"),
    REAL("fault_time", "s", 0, LONGEST, 1, sensor_fault_time, "when"),
    REAL("fault_duration", "s", 0, LONGEST, 0.1, sensor_fault_duration, "for how long"),
};

static const mct_field can_fields[] = {
    CHOICE("protocol", can_protocols, MCT_CAN_NATIVE, can_protocol, "what the drives speak"),
    CHOICE(
        "mode", can_modes, MCT_CAN_MODE_VOLTAGE, can_mode,
        "what a drive is told: voltage (native; vesc with a brushed motor; odrive with a gimbal motor), foc "
        "(vesc with a three-phase motor) or torque (odrive, the armature computed here)"),
    CHOICE("firmware", can_firmwares, MCT_CAN_FIRMWARE_0_6, can_firmware, "of an odrive"),
    INTEGER("node", "", 0, 63, 1, can_node, "number of the drive that powers the motor"),
    BOOLEAN("inverted", 0, can_inverted, "positive volts turn the motor the other way"),
    INTEGER("pole_pairs", "", 1, 100, 7, can_pole_pairs,
            "of the motor of a vesc, which tells electrical turns"),
    INTEGER("bitrate", "bit/s", 10000, 1000000, 1000000, can_bitrate, "of the bus, for its load"),
    REAL("highest_load", "", 0.01, 10, 0.7, can_highest_load, "fraction of the bus that may be used"),
    REAL(
        "watchdog", "s", 0, 2, 0.1, can_watchdog,
        "after this long without a command a drive stops by itself: sent to a native drive, in the others to "
        "be configured; verified at the start where the drive tells; 0: none, at your own risk"),
    REAL("startup", "s", 0.1, 60, 3, can_startup, "longest wait for the drives' messages at the start"),
    REAL("duty_ramp", "1/s", 0.1, 1e6, 20, can_duty_ramp, "how fast a simulated vesc changes its duty"),
    BOOLEAN("lockstep", 0, can_lockstep,
            "over a socket: paced by the drive's answers instead of the clock; for simulated drives only"),
    CHOICE("fault", can_faults, MCT_CAN_FAULT_NONE, can_fault,
           "what befalls simulated drives and their frames"),
    REAL("fault_time", "s", 0, LONGEST, 1, can_fault_time, "when"),
    REAL("fault_duration", "s", 0, LONGEST, 0.1, can_fault_duration,
         "for how long; 0: one tick; a reboot takes 50 ms at least, frames of a delay come 8 ticks late"),
};

static const mct_field variation_fields[] = {
    REAL("spread", "", 0, 0.5, 0, variation_spread,
         "largest relative change of a parameter that the controller is not told"),
    INTEGER("seed", "", 0, INT32_MAX, 0, variation_seed, "which of the varied plants"),
};

static const mct_field telemetry_fields[] = {
    TEXT("lcm", lcm, "URL of a provider; empty: none"),
    TEXT("log", log, "path of an event log; empty: none"),
};

#define TABLE(name, fields, doc)                                       \
    {                                                                  \
        name, doc, (int)(sizeof(fields) / sizeof(fields)[0]), (fields) \
    }

const mct_scene_table mct_scene_tables[MCT_SCENE_TABLE_COUNT] = {
    TABLE("scene", scene_fields, "what is simulated, how, how long"),
    TABLE("controller", controller_fields, "closed loop"),
    TABLE("input", input_fields, "open loop, held over each tick"),
    TABLE("sensors", sensor_fields,
          "encoders and what is wrong with them; counts per turn or metre by the system's encoders"),
    TABLE("can", can_fields, "motor and encoders on a CAN bus, with scene.hal = \"socketcan:can0\""),
    TABLE("variation", variation_fields, "a plant that differs from its model"),
    TABLE("telemetry", telemetry_fields, "who is told"),
};

/* --- all tables --- */

enum { TABLE_SCENE, TABLE_SENSORS = 3, TABLE_CAN = 4 };

/* Deviations that cost as much as the full input. */
#define SMALLEST_WEIGHT 1e-6
#define LARGEST_WEIGHT  1e6

const char *mct_table_name(int table)
{
    static const char *const names[] = {"parameters", "effects", "initial", "weights"};
    return table < MCT_SCENE_TABLE_COUNT ? mct_scene_tables[table].name
                                         : names[table - MCT_SCENE_TABLE_COUNT];
}

int mct_key_count(int table, const mct_system *system)
{
    switch (table) {
    case MCT_TABLE_PARAMETERS:
        return system->parameter_count + system->list_count;
    case MCT_TABLE_EFFECTS:
        return MCT_EFFECT_COUNT;
    case MCT_TABLE_INITIAL:
        return mct_most_states(system);
    case MCT_TABLE_WEIGHTS:
        return 2 * mct_encoder_count(system);
    default:
        return mct_scene_tables[table].field_count + (table == TABLE_SENSORS ? mct_encoder_count(system)
                                                      : table == TABLE_CAN   ? 2 * mct_encoder_count(system)
                                                                             : 0);
    }
}

mct_scene_key mct_key_at(int table, const mct_system *system, int number)
{
    mct_scene_key key;
    memset(&key, 0, sizeof key);
    const size_t place = sizeof(double) * (size_t)number;
    const int coordinates = system->coordinate_count;
    switch (table) {
    case MCT_TABLE_PARAMETERS:
        if (number < system->parameter_count) {
            key.field = system->parameters[number];
            key.field.offset = PLACE(parameters) + place;
            key.is_real = true;
        } else {
            const int list = number - system->parameter_count;
            key.rows = &system->lists[list];
            key.field.name = key.rows->name;
            key.field.unit = key.rows->column_count == 1 ? key.rows->columns[0].unit : "";
            key.field.doc = key.rows->doc;
            key.field.kind = MCT_FIELD_LIST;
            key.field.offset = PLACE(lists) + sizeof(mct_list) * (size_t)list;
        }
        return key;
    case MCT_TABLE_EFFECTS:
        key.effect = &mct_effects[number];
        key.field.name = key.effect->name;
        key.field.unit = "";
        key.field.doc = key.effect->doc;
        key.field.kind = key.effect->choices == NULL ? MCT_FIELD_BOOLEAN : MCT_FIELD_CHOICE;
        key.field.choices = key.effect->choices;
        key.field.offset = PLACE(effects);
        return key;
    case MCT_TABLE_INITIAL:
        key.field = *mct_state_field(system, number);
        key.field.offset = PLACE(initial) + place;
        return key;
    case MCT_TABLE_WEIGHTS: {
        const bool is_rate = number >= coordinates;
        const mct_coordinate *const coordinate = &system->coordinates[number % coordinates];
        key.field = *mct_state_field(system, number);
        key.field.doc = "deviation that costs a controller as much as the full input";
        key.field.minimum = SMALLEST_WEIGHT;
        key.field.maximum = LARGEST_WEIGHT;
        key.field.standard = is_rate ? coordinate->rate_weight : coordinate->position_weight;
        key.field.offset = PLACE(weights) + place;
        return key;
    }
    default: {
        const int fixed = mct_scene_tables[table].field_count;
        if (number < fixed) {
            key.field = mct_scene_tables[table].fields[number];
        } else if (table == TABLE_SENSORS) {
            key.field = system->coordinates[number - fixed].encoder;
            key.field.offset = PLACE(counts_per_unit) + sizeof(double) * (size_t)(number - fixed);
        } else if (number - fixed < coordinates) {
            key.field = system->coordinates[number - fixed].encoder_node;
            key.field.offset = PLACE(can_encoder_node) + sizeof(int32_t) * (size_t)(number - fixed);
        } else {
            const int encoder = number - fixed - coordinates;
            key.field = system->coordinates[encoder].encoder_ratio;
            key.field.offset = PLACE(can_encoder_ratio) + sizeof(double) * (size_t)encoder;
        }
        return key;
    }
    }
}

const char *mct_choice_name(const mct_field *field, int32_t index)
{
    if (index < 0) {
        return NULL;
    }
    if (field->choices == NULL) {
        if (field->offset == PLACE(system)) {
            return index < MCT_SYSTEM_COUNT ? mct_systems[index]->name : NULL;
        }
        return index < MCT_STEPPER_COUNT    ? mct_steppers[index].name
               : index == MCT_STEPPER_COUNT ? "auto"
                                            : NULL;
    }
    for (int32_t i = 0; i < index; i++) {
        if (field->choices[i] == NULL) {
            return NULL;
        }
    }
    return field->choices[index];
}

double mct_key_get(const mct_scene *scene, const mct_scene_key *key)
{
    const char *const place = (const char *)scene + key->field.offset;
    if (key->effect != NULL) {
        const uint32_t bits = scene->effects & key->effect->mask;
        return bits == 0 ? 0 : bits == key->effect->bits[1] ? 1 : 2;
    }
    if (key->is_real || key->field.kind == MCT_FIELD_REAL) {
        double value;
        memcpy(&value, place, sizeof value);
        return value;
    }
    int32_t value;
    memcpy(&value, place, sizeof value);
    return value;
}

void mct_key_set(mct_scene *scene, const mct_scene_key *key, double value)
{
    char *const place = (char *)scene + key->field.offset;
    if (key->effect != NULL) {
        scene->effects = (scene->effects & ~key->effect->mask) | key->effect->bits[(int)value];
    } else if (key->is_real || key->field.kind == MCT_FIELD_REAL) {
        memcpy(place, &value, sizeof value);
    } else {
        const int32_t integer = (int32_t)value;
        memcpy(place, &integer, sizeof integer);
    }
}

/* --- defaults --- */

double mct_motor_stiffness(const mct_scene *scene)
{
    const mct_system *const system = mct_systems[scene->system];
    if (!(mct_scene_effects(scene) & MCT_MOTOR_INDUCTIVE)) {
        return 0;
    }
    return mct_scene_step(scene) * scene->parameters[system->actuation->resistance_parameter] /
           scene->parameters[system->actuation->inductance_parameter];
}

bool mct_stepper_suits(const mct_scene *scene, int stepper)
{
    const double limit = mct_steppers[stepper].motor_stability_limit;
    const uint32_t effects = mct_scene_effects(scene) & MCT_KERNEL_EFFECTS;
    return mct_systems[scene->system]->kernel(stepper, effects) != NULL &&
           (limit == 0 || mct_motor_stiffness(scene) <= limit);
}

int32_t mct_best_stepper(const mct_scene *scene)
{
    int32_t best = -1;
    for (int32_t i = 0; i < MCT_STEPPER_COUNT; i++) {
        /* Of equal order the later one: it treats more of the motion exactly. */
        if (mct_stepper_suits(scene, i) && !mct_steppers[i].is_special &&
            (best < 0 || mct_steppers[i].order >= mct_steppers[best].order)) {
            best = i;
        }
    }
    /* Exact friction wants a series where nothing else is as exact. */
    const int32_t otherwise = (scene->effects & MCT_COULOMB_EXACT) ? MCT_STEPPER_TAYLOR6 : MCT_STEPPER_RK4;
    return best < 0 ? otherwise : best;
}

void mct_scene_defaults(mct_scene *scene, int system)
{
    static const char hal[] = "sim";
    const mct_system *const descriptor = mct_systems[system];
    memset(scene, 0, sizeof *scene); /* texts and lists are empty */
    scene->effects = descriptor->standard_effects;
    for (int table = 0; table < MCT_TABLE_COUNT; table++) {
        for (int i = 0; i < mct_key_count(table, descriptor); i++) {
            const mct_scene_key key = mct_key_at(table, descriptor, i);
            if (table != MCT_TABLE_EFFECTS && key.field.kind != MCT_FIELD_TEXT &&
                key.field.kind != MCT_FIELD_LIST) {
                mct_key_set(scene, &key, key.field.standard);
            }
        }
    }
    for (int i = 0; i < descriptor->list_count; i++) {
        const mct_row_list *const rows = &descriptor->lists[i];
        scene->lists[i].count = rows->standard_rows * rows->column_count;
        memcpy(scene->lists[i].values, rows->standard, sizeof(double) * (size_t)scene->lists[i].count);
    }
    memcpy(scene->hal, hal, sizeof hal);
    scene->system = system;
    scene->stepper = mct_best_stepper(scene);
}

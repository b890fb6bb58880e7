/**
 * @file scene.h
 * A scene: what is simulated and controlled, as plain data. The reader turns text (a strict subset of TOML)
 *   into it.
 *
 * Everything in a scene is double or int32_t whatever the core's precision, so that one reader serves both.
 */
#ifndef MCTAU_SCENE_H
#define MCTAU_SCENE_H

#include "mctau/field.h"
#include "mctau/message.h"
#include "mctau/status.h"
#include "mctau/system.h"

#define MCT_MAX_LIST 128 /**< numbers in a list of a scene */
#define MCT_MAX_TEXT 256 /**< bytes of a text in a scene, NUL included */

typedef struct {
    int32_t count;
    double values[MCT_MAX_LIST];
} mct_list;

enum { MCT_PRECISION_DOUBLE, MCT_PRECISION_FLOAT };
enum { MCT_CONTROLLER_NONE, MCT_CONTROLLER_SWING_UP_BALANCE };
enum { MCT_INPUT_NONE, MCT_INPUT_CONSTANT, MCT_INPUT_SINE, MCT_INPUT_STEPS, MCT_INPUT_CSV };
enum { MCT_CAN_NATIVE, MCT_CAN_VESC, MCT_CAN_ODRIVE };
enum { MCT_CAN_MODE_VOLTAGE, MCT_CAN_MODE_FOC, MCT_CAN_MODE_TORQUE };
enum { MCT_CAN_FIRMWARE_0_6, MCT_CAN_FIRMWARE_0_5 };
enum {
    MCT_CAN_FAULT_NONE,
    MCT_CAN_FAULT_DROP,
    MCT_CAN_FAULT_DROP_COMMANDS,
    MCT_CAN_FAULT_DELAY,
    MCT_CAN_FAULT_DUPLICATE,
    MCT_CAN_FAULT_REORDER,
    MCT_CAN_FAULT_SHORT,
    MCT_CAN_FAULT_REMOTE,
    MCT_CAN_FAULT_FORMAT,
    MCT_CAN_FAULT_NAN,
    MCT_CAN_FAULT_SILENCE,
    MCT_CAN_FAULT_REBOOT,
    MCT_CAN_FAULT_ESTOP,
    MCT_CAN_FAULT_ERROR
};
enum { MCT_SENSOR_FAULT_NONE, MCT_SENSOR_FAULT_NAN, MCT_SENSOR_FAULT_SILENT, MCT_SENSOR_FAULT_FROZEN };

typedef struct mct_scene {
    /* [scene] */
    int32_t system;    /**< index into mct_systems */
    int32_t stepper;   /**< index into mct_steppers */
    int32_t automatic; /**< 1: stepper = "auto"; the most accurate one stands in until a host has chosen */
    int32_t precision; /**< MCT_PRECISION_... */
    int32_t substeps;  /**< steps per tick */
    int32_t stride;    /**< ticks per step; this or substeps is 1 */
    int32_t realtime;
    double dt;        /**< the tick [s] */
    double duration;  /**< [s] */
    double tolerance; /**< of a host that chooses the stepper */
    char hal[MCT_MAX_TEXT];
    /* [parameters], [effects], [initial]: by the system's descriptor */
    double parameters[MCT_MAX_PARAMETERS];
    mct_list lists[MCT_MAX_LISTS]; /**< of rows, one behind the other: mct_system.lists */
    /** Which keys of [parameters] were given, in the order of the table: bit i is key i, the lists last. */
    uint32_t given;
    uint32_t effects;
    double initial[MCT_MAX_STATES];
    /* [controller], [weights] */
    int32_t controller;
    double observer_bandwidth; /**< [rad/s] */
    double energy_band;
    double capture;
    double track_half_length; /**< [m] */
    double overspeed;         /**< [rad/s] */
    double give_up_after;     /**< [s] without balance, less those with it; 0: never */
    double rearm_after;       /**< [s]; 0: only when asked to */
    double weights[2 * MCT_MAX_ENCODERS];
    double input_weight;
    /* [input] */
    int32_t input;
    double input_value, input_amplitude, input_frequency;
    mct_list input_times, input_values;
    char input_file[MCT_MAX_TEXT];
    char input_column[MCT_MAX_TEXT];
    /* [sensors] */
    double counts_per_unit[MCT_MAX_ENCODERS]; /**< per turn of an angle, per metre of a length */
    int32_t counter_bits;
    int32_t latency; /**< [ticks] */
    int32_t sensor_seed;
    double noise; /**< [counts], standard deviation */
    int32_t sensor_fault;
    double sensor_fault_time, sensor_fault_duration; /**< [s] */
    /* [can] */
    int32_t can_protocol; /**< MCT_CAN_NATIVE, ... */
    int32_t can_mode;     /**< MCT_CAN_MODE_... */
    int32_t can_firmware; /**< of an ODrive, MCT_CAN_FIRMWARE_... */
    int32_t can_node;     /**< drive of the motor */
    int32_t can_inverted;
    int32_t can_pole_pairs;
    int32_t can_bitrate; /**< [bit/s] */
    double can_highest_load;
    double can_watchdog;  /**< [s] */
    double can_startup;   /**< [s] */
    double can_duty_ramp; /**< [1/s] */
    int32_t can_lockstep;
    int32_t can_fault;                          /**< MCT_CAN_FAULT_... */
    double can_fault_time, can_fault_duration;  /**< [s] */
    int32_t can_encoder_node[MCT_MAX_ENCODERS]; /**< drive that reads it; -1: see the key's doc */
    double can_encoder_ratio[MCT_MAX_ENCODERS]; /**< drive's turns per turn or metre */
    /* [variation] */
    double variation_spread;
    int32_t variation_seed;
    /* [telemetry] */
    char lcm[MCT_MAX_TEXT];
    char log[MCT_MAX_TEXT];
} mct_scene;

/** Length of a scene's steps [s]. */
static inline double mct_scene_step(const mct_scene *scene)
{
    return scene->dt * scene->stride / scene->substeps;
}

/** A table of a scene with fixed keys, `offset` of each field saying where it goes. */
typedef struct {
    const char *name;
    const char *doc;
    int field_count;
    const mct_field *fields;
} mct_scene_table;

#define MCT_SCENE_TABLE_COUNT 7
/**
 * [scene], [controller], [input], [sensors], [can], [variation], [telemetry]. The tables [parameters], [effects],
 * [initial] and [weights], and the encoders' keys of [sensors] and [can], follow from the system's descriptor:
 * parameters; mct_effects; names of states (the current with an inductive motor only); names of coordinates
 * and rates; mct_coordinate.encoder.
 *
 * The choices of scene.system and scene.stepper are the names in mct_systems and mct_steppers; `choices` of
 * these two fields is NULL. Texts are empty by default but for scene.hal, "sim"; lists are empty. A scene
 * must name its system; the stepper it leaves out, or calls "auto", is the most accurate one that suits, but no
 * series.
 */
extern const mct_scene_table mct_scene_tables[MCT_SCENE_TABLE_COUNT];

/**
 * Fills a scene with the defaults of a system: nothing but descriptors decides. Thread-safe, as all functions
 * here.
 * @param scene   written, all of it
 * @param system  index into mct_systems, 0 to MCT_SYSTEM_COUNT - 1
 */
void mct_scene_defaults(mct_scene *scene, int system);

/** One value given from outside the file, as by `--set table.key=value`. */
typedef struct {
    const char *assignment; /**< "table.key=value"; a text or a name may go without quotes */
    const char *origin;     /**< what messages call it, as "--set" */
} mct_override;

/**
 * Reads a scene from text. Fixed allocation, some 25 kB of stack; the text is not kept. Well below a
 * millisecond.
 *
 * Text: a strict subset of TOML 1.0 (tables, `table.key = value` ahead of the first of them, numbers,
 * booleans, texts of one line, lists of numbers, comments), at most 1 MiB. Numbers are correctly rounded. A
 * key that nothing would read is refused: one of [input] that the chosen kind does not use, the initial
 * current of a motor that has none.
 *
 * Order of reading does not matter to the writer of a scene: the system is looked up first, then its defaults
 * are filled in, then the file's values, then the overrides in their order.
 *
 * @param text, length  the scene, UTF-8; need not be NUL-terminated
 * @param origin        what messages call the text: a file name; an override's origin stands in its place
 * @param overrides, override_count
 * @param scene         written on success only
 * @param why           on failure one sentence: "origin:line: table.key: found ...; allowed ..."; cleared on
 *                      success; may be NULL
 * @return MCT_OK; MCT_ERROR_SYNTAX (not the subset), MCT_ERROR_RANGE (unknown key, wrong type, out of range,
 *         not finite, unknown name), MCT_ERROR_BOUND (more keys or a longer text than the reader holds),
 *         MCT_ERROR_UNSUITED (checks of mct_scene_check)
 */
mct_status mct_scene_read(const char *text, size_t length, const char *origin, const mct_override *overrides,
                          int override_count, mct_scene *scene, mct_message *why);

/**
 * Checks what single keys cannot say: that the stepper suits the system and the effects, that it can follow
 * the motor's time constant at this step, that a controller has a motor and encoders, that [input] and
 * [controller] are not both given, that lists of times rise and match their values, that the duration is a
 * whole number of ticks, and what the system has against its parameters; and that every value is within its range. Called by mct_scene_read; call it after
 * changing a scene by hand.
 * @param why  on failure one sentence: "table.key: found ...; allowed ..."; may be NULL
 * @return MCT_OK; MCT_ERROR_RANGE, MCT_ERROR_BOUND (a single value), MCT_ERROR_UNSUITED (values that do not
 *         go together)
 */
mct_status mct_scene_check(const mct_scene *scene, mct_message *why);

/**
 * What a user should be told of a scene that is well: a quaternion whose length is not 1 and is made so; a coefficient
 * that is given while all effects that read it are off.
 * @param number  0 for the first note
 * @param note    written: one sentence, "table.key: ..."
 * @return false when there are no more
 */
bool mct_scene_note(const mct_scene *scene, int number, mct_message *note);

/**
 * Draws the parameters of a plant that differs from its model: each parameter that is not known exactly
 * anyhow (gravity, lengths, gear ratio, supply voltage are) is multiplied by 1 + spread * u, u uniform in
 * [-1, 1), a function of (variation_seed, index of the parameter) alone, and kept within its range. The
 * controller keeps the scene as written: it does not know.
 * @param scene  checked
 * @param plant  written: the scene with other parameters; may be the scene itself
 */
void mct_scene_vary(const mct_scene *scene, mct_scene *plant);

#endif

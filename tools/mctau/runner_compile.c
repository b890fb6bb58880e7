/*
 * A scene's structs as C text. A field that is 0 is left out, as C takes it for 0; a field that were forgotten here is found
 * by tests/compile, which holds the structs of the text against those of init, byte for byte.
 */
#include "runner_compile.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/sim/sim.h"
#include "hal/socketcan/can.h"
#include "mctau/loop.h"

enum { DEEPEST = 8 };

/* Where the text goes, within how many braces it is, and which are to be opened yet: C knows no empty ones. */
typedef struct {
    csv_output *out;
    int depth;
    int unopened_count;
    const char *unopened[DEEPEST];
} text;

/* --- pieces of C --- */

static void put(text *self, const char *format, ...)
{
    char line[512];
    va_list values;
    va_start(values, format);
    const int length = vsnprintf(line, sizeof line, format, values);
    va_end(values);
    csv_output_headers(self->out, line, (size_t)length);
}

static void indent(text *self)
{
    for (int i = 0; i < self->unopened_count; i++) {
        put(self, "%*s.%s = {\n", 4 * self->depth++, "", self->unopened[i]);
    }
    self->unopened_count = 0;
    put(self, "%*s", 4 * self->depth, "");
}

/* Exact: C99 reads and writes a number's bits in base 16. */
static void put_number(text *self, double value)
{
    if (value > -1e6 && value < 1e6 && value == (double)(int32_t)value) {
        put(self, "%d", (int)value);
    } else {
        put(self, MCT_REAL_IS_FLOAT ? "%aF /* %g */" : "%a /* %g */", value, value);
    }
}

/* The name must be valid until the end. */
static void begin(text *self, const char *name)
{
    self->unopened[self->unopened_count++] = name;
}

static void end(text *self)
{
    if (self->unopened_count > 0) {
        self->unopened_count--;
        return;
    }
    self->depth--;
    indent(self);
    put(self, "},\n");
}

static void put_text(text *self, const char *name, const char *value)
{
    indent(self);
    put(self, ".%s = %s,\n", name, value);
}

static void put_integer(text *self, const char *name, int64_t value)
{
    if (value != 0) {
        indent(self);
        put(self, ".%s = %" PRId64 ",\n", name, value);
    }
}

static void put_mask(text *self, const char *name, uint32_t value)
{
    if (value != 0) {
        indent(self);
        put(self, ".%s = 0x%" PRIX32 "U,\n", name, value);
    }
}

static void put_flag(text *self, const char *name, bool value)
{
    if (value) {
        put_text(self, name, "true");
    }
}

static void put_double(text *self, const char *name, double value)
{
    if (value != 0) {
        indent(self);
        put(self, ".%s = %a,\n", name, value);
    }
}

static void put_real(text *self, const char *name, mct_real value)
{
    if (value != 0) {
        indent(self);
        put(self, ".%s = ", name);
        put_number(self, (double)value);
        put(self, ",\n");
    }
}

static void put_reals(text *self, const char *name, const mct_real *values, int count)
{
    for (int i = 0; i < count; i++) {
        char place[64];
        snprintf(place, sizeof place, "%s[%d]", name, i);
        put_real(self, place, values[i]);
    }
}

/* Plain data without pointers, which is laid out alike wherever numbers have these sizes and begin with their low byte. */
static void put_words(text *self, const void *data, size_t size)
{
    size_t used = size / sizeof(uint32_t);
    for (uint32_t word = 0; used > 0 && word == 0; used -= word == 0) {
        memcpy(&word, (const char *)data + (used - 1) * sizeof word, sizeof word);
    }
    if (used == 0) {
        return;
    }
    indent(self);
    put(self, ".words = {");
    for (size_t i = 0; i < used; i++) {
        uint32_t word;
        memcpy(&word, (const char *)data + i * sizeof word, sizeof word);
        put(self, "%s0x%08" PRIX32 ",", i % 8 == 0 ? "\n        " : " ", word);
    }
    put(self, "},\n");
}

#define INTEGER(field) put_integer(self, #field, (int64_t)from->field)
#define MASK(field)    put_mask(self, #field, from->field)
#define FLAG(field)    put_flag(self, #field, from->field)
#define REAL(field)    put_real(self, #field, from->field)
#define REALS(field)   put_reals(self, #field, from->field, (int)(sizeof from->field / sizeof from->field[0]))
#define DOUBLE(field)  put_double(self, #field, from->field)

/* --- what a tick reads of a system --- */

static void put_phases(text *self, const mct_system *system)
{
    put(self, "\nstatic const mct_field phases[MCT_PHASES] = {\n");
    for (int i = 0; i < MCT_PHASES; i++) {
        put(self, "    {.unit = \"%s\"},\n", system->phases[i].unit);
    }
    put(self, "};\n");
}

static void put_actuation(text *self, const mct_system *system)
{
    const mct_actuation *from = system->actuation;
    put(self,
        "\nvoid mct_%s_accelerate(const void *constants, uint32_t effects, const mct_real *x, mct_real s, "
        "mct_real c,\n    mct_real input, mct_real *a);\n"
        "const mct_motor *mct_%s_motor(const void *constants);\n",
        system->name, system->name);
    put(self, "\nstatic const mct_actuation actuation = {\n");
    self->depth = 1;
    INTEGER(driven_coordinate);
    INTEGER(upright_coordinate);
    put(self, "    .accelerate = mct_%s_accelerate,\n    .motor = mct_%s_motor,\n};\n", system->name,
        system->name);
}

static void put_system(text *self, const mct_system *from, bool has_stride)
{
    if (from->phases != NULL) {
        put_phases(self, from);
    }
    if (from->actuation != NULL) {
        put_actuation(self, from);
    }
    if (has_stride) {
        put(self,
            "\nvoid mct_%s_motion(const void *constants, uint32_t effects, const mct_state *state, mct_real "
            "input,\n    mct_motion *motion);\n",
            from->name);
    }
    put(self, "\nstatic const mct_coordinate coordinates[] = {\n");
    for (int i = 0; i < from->coordinate_count; i++) {
        put(self, "    {.is_angle = %s, .is_cyclic = %s},\n",
            from->coordinates[i].is_angle ? "true" : "false",
            from->coordinates[i].is_cyclic ? "true" : "false");
    }
    put(self, "};\n\nstatic const mct_system scene_system = {\n");
    self->depth = 1;
    put(self, "    .name = \"%s\",\n", from->name);
    put_text(self, "coordinates", "coordinates");
    INTEGER(coordinate_count);
    INTEGER(attitude);
    FLAG(is_process);
    FLAG(is_timed);
    if (from->phases != NULL) {
        put_text(self, "phases", "phases");
    }
    if (from->actuation != NULL) {
        put_text(self, "actuation", "&actuation");
    }
    if (has_stride) {
        put(self, "    .motion = mct_%s_motion,\n", from->name);
    }
    put(self, "};\n");
}

/* --- the loop --- */

static void put_samples(text *self, const mct_input *from)
{
    if (from->samples.count == 0) {
        return;
    }
    put(self, "\nstatic const mct_real samples[] = {\n");
    for (size_t i = 0; i < from->samples.count; i++) {
        put(self, "    ");
        put_number(self, (double)from->samples.values[i]);
        put(self, ",\n");
    }
    put(self, "};\n");
}

static void put_input(text *self, const mct_input *from)
{
    begin(self, "input");
    indent(self);
    put(self, ".kind = %" PRId32 ",\n", from->kind);
    REAL(value);
    REAL(amplitude);
    if (from->phase_per_tick != 0) {
        indent(self);
        put(self, ".phase_per_tick = %" PRIu64 "U,\n", from->phase_per_tick);
    }
    INTEGER(step_count);
    for (int i = 0; i < from->step_count; i++) {
        indent(self);
        put(self, ".step_ticks[%d] = %" PRIu64 ", .step_values[%d] = ", i, from->step_ticks[i], i);
        put_number(self, (double)from->step_values[i]);
        put(self, ",\n");
    }
    if (from->samples.count > 0) {
        indent(self);
        put(self, ".samples = {samples, %zu},\n", from->samples.count);
    }
    end(self);
}

static void put_plan(text *self, const mct_plan *from)
{
    put_samples(self, &from->input);
    put(self, "\nstatic const mct_plan plan = {\n");
    self->depth = 1;
    begin(self, "model");
    put_words(self, &from->model, sizeof from->model);
    end(self);
    put_input(self, &from->input);
    put(self, "};\n");
}

static void put_encoder(text *self, const mct_encoder_track *from, int number)
{
    char name[32];
    snprintf(name, sizeof name, "encoders[%d]", number);
    begin(self, name);
    INTEGER(turn);
    INTEGER(last);
    INTEGER(lap);
    INTEGER(travelled);
    REAL(lap_moves);
    REAL(unit);
    REAL(start);
    REAL(deviation);
    end(self);
}

static void put_observer(text *self, const mct_observer *from)
{
    begin(self, "observer");
    put_text(self, "system", "&scene_system");
    put_text(self, "constants", "&plan.model");
    MASK(effects);
    INTEGER(counter_shift);
    REAL(h);
    REAL(keep);
    REAL(rate_gain);
    for (int i = 0; i < mct_encoder_count(from->system); i++) {
        put_encoder(self, &from->encoders[i], i);
    }
    REAL(gravity_slope);
    REALS(x);
    REAL(sine);
    REAL(cosine);
    end(self);
}

static void put_controller(text *self, const mct_controller *from)
{
    begin(self, "controller");
    put_text(self, "system", "&scene_system");
    indent(self);
    put(self, ".swing_up = mct_%s_swing_up,\n", from->system->name);
    MASK(effects);
    INTEGER(mode);
    REAL(limit);
    REALS(gains);
    REALS(unstable);
    REAL(capture);
    REAL(energy_scale);
    REAL(largest_shift);
    REAL(information);
    REAL(memory);
    REAL(direction);
    REAL(still);
    REAL(swing_acceleration);
    REAL(track_stiffness);
    REAL(track_damping);
    REAL(track_half_length);
    put_observer(self, &from->observer);
    put_text(self, "constants", "&plan.model");
    end(self);
}

static void put_supervisor(text *self, const mct_supervisor *from)
{
    begin(self, "supervisor");
    put_text(self, "system", "&scene_system");
    FLAG(observed);
    REAL(limit);
    REAL(steps_per_volt);
    REAL(watch_limit);
    INTEGER(derate_us);
    INTEGER(stale_us);
    INTEGER(frozen_limit);
    REAL(track_half_length);
    REAL(overspeed);
    INTEGER(rearm_limit);
    INTEGER(give_up_limit);
    end(self);
}

static void put_loop(text *self, const mct_loop *from)
{
    if (from->controlled) {
        put(self, "\nmct_real mct_%s_swing_up(mct_controller *controller);\n", from->controller.system->name);
    }
    put_plan(self, from->plan);
    put(self, "\nconst mct_loop mct_compiled_loop = {\n");
    self->depth = 1;
    FLAG(controlled);
    put_text(self, "plan", "&plan");
    if (from->controlled) {
        put_controller(self, &from->controller);
    }
    put_supervisor(self, &from->supervisor);
    put(self, "};\n");
}

/* --- the plant --- */

static void put_state(text *self, const mct_state *from)
{
    begin(self, "state");
    REALS(x);
    REALS(c);
    for (int i = 0; i < MCT_MAX_COORDINATES; i++) {
        char name[32];
        snprintf(name, sizeof name, "turns[%d]", i);
        put_integer(self, name, from->turns[i]);
    }
    end(self);
}

static void put_plant(text *self, const mct_plant *from, const char *kernel)
{
    begin(self, "plant");
    put_text(self, "system", "&scene_system");
    put_text(self, "kernel", kernel);
    if (from->limit != NULL) {
        put_text(self, "limit",
                 from->limit == mct_plant_within_current ? "mct_plant_within_current"
                                                         : "mct_plant_within_voltage");
    }
    if (from->advance != NULL) {
        put_text(self, "advance", "mct_plant_stride");
    }
    MASK(effects);
    INTEGER(states);
    INTEGER(entries);
    INTEGER(substeps);
    REAL(bound);
    REAL(drop);
    put_state(self, &from->state);
    put_integer(self, "stride.ticks", from->stride.ticks);
    begin(self, "constants");
    put_words(self, &from->constants, sizeof from->constants);
    end(self);
    end(self);
}

static void put_sim_encoder(text *self, const mct_sim_encoder *from, int number)
{
    char name[32];
    snprintf(name, sizeof name, "encoders[%d]", number);
    begin(self, name);
    INTEGER(turn_counts);
    REAL(unit_counts);
    REAL(unit_rest);
    MASK(start_counts);
    REAL(start_rest);
    end(self);
}

static void put_sim(text *self, const mct_sim *from, const char *kernel)
{
    put(self,
        "\nvoid %s(const void *constants, mct_state *state, mct_real input, int32_t steps);\n"
        "\nconst mct_sim mct_compiled_sim = {\n",
        kernel);
    self->depth = 1;
    put_plant(self, &from->plant, kernel);
    for (int i = 0; i < from->encoder_count; i++) {
        put_sim_encoder(self, &from->encoders[i], i);
    }
    INTEGER(encoder_count);
    REAL(noise);
    INTEGER(seed);
    INTEGER(counter_shift);
    INTEGER(latency);
    INTEGER(tick_us);
    INTEGER(fault);
    INTEGER(fault_begin);
    INTEGER(fault_end);
    DOUBLE(dt);
    put(self, "};\n");
}

/* --- the HAL over CAN --- */

static void put_can_motor(text *self, const mct_can_motor *from)
{
    begin(self, "motor");
    DOUBLE(supply);
    DOUBLE(resistance);
    DOUBLE(torque_per_ampere);
    DOUBLE(emf_per_turn);
    FLAG(inverted);
    end(self);
}

static void put_can_encoder(text *self, const mct_can_encoder *from, int number)
{
    char name[32];
    snprintf(name, sizeof name, "encoders[%d]", number);
    begin(self, name);
    FLAG(used);
    INTEGER(coordinate);
    DOUBLE(counts_per_turn);
    end(self);
}

static void put_can_axis(text *self, const mct_can_axis *from, const char *protocol, int number)
{
    char name[32];
    snprintf(name, sizeof name, "axes[%d]", number);
    begin(self, name);
    put_text(self, "protocol", protocol);
    put_text(self, "scene", "&mct_compiled_scene.scene");
    INTEGER(node);
    MASK(roles);
    INTEGER(watchdog_ms);
    put_can_motor(self, &from->motor);
    for (int i = 0; i < MCT_CAN_ENCODERS; i++) {
        put_can_encoder(self, &from->encoders[i], i);
    }
    end(self);
}

static void put_can(text *self, const mct_scene *scene)
{
    mct_message why;
    mct_can *from = malloc(sizeof *from);
    mct_message_clear(&why);
    if (from == NULL || mct_can_init(from, scene, (mct_can_transport){NULL, NULL}, false, &why) != MCT_OK) {
        put(self, "\n/* No mct_compiled_can: %.400s. */\n", from == NULL ? "no memory" : why.text);
        free(from);
        return;
    }
    const mct_can_protocol *spoken = from->axes.protocol;
    char protocol[64];
    snprintf(protocol, sizeof protocol, "&mct_can_%s",
             spoken == &mct_can_odrive_0_5 ? "odrive_0_5" : spoken->name);
    put(self, "\nconst mct_can mct_compiled_can = {\n");
    self->depth = 1;
    put_text(self, "scene", "&mct_compiled_scene.scene");
    DOUBLE(dt);
    INTEGER(tick_us);
    INTEGER(encoder_count);
    begin(self, "axes");
    put_text(self, "protocol", protocol);
    put_integer(self, "count", from->axes.count);
    for (int i = 0; i < from->axes.count; i++) {
        put_can_axis(self, &from->axes.axes[i], protocol, i);
    }
    end(self);
    put(self, "};\n");
    free(from);
}

/* --- all of it --- */

/* As words of a pair each, for what is 8 bytes long may not lie across two. */
static void put_scene(text *self, const mct_scene *scene)
{
    put(self, "\nconst union mct_compiled_scene mct_compiled_scene = {.words = {");
    for (size_t i = 0; i < sizeof *scene / sizeof(uint64_t); i++) {
        uint64_t word;
        memcpy(&word, (const char *)scene + i * sizeof word, sizeof word);
        if (word != 0) {
            put(self, "\n    [%zu] = 0x%016" PRIX64 ",", i, word);
        }
    }
    put(self, "\n}};\n");
}

mct_status runner_compile(const mct_scene *scene, const run_options *options, csv_output *out,
                          mct_message *why)
{
    text whole = {.out = out};
    mct_sim *sim = malloc(sizeof *sim);
    mct_loop *loop = malloc(sizeof *loop);
    mct_plan *plan = malloc(sizeof *plan);
    mct_scene compiled = *scene;
    compiled.realtime = 0; /* a clock is the program's */
    mct_status status = MCT_ERROR_IO;
    if (sim != NULL && loop != NULL && plan != NULL) {
        status = mct_sim_init(sim, &compiled, why);
        status = status != MCT_OK ? status
                                  : mct_loop_init(loop, plan, &compiled, (mct_hal){NULL, NULL}, NULL,
                                                  RUNNER_SAMPLES(options), why);
    }
    if (status == MCT_OK) {
        const mct_plant *plant = &sim->plant;
        const char *kernel = plant->system->kernel(scene->stepper, plant->effects)->name;
        put(&whole,
            "#include \"hal/compiled.h\"\n"
            "\n#if MCT_REAL_IS_FLOAT != %d\n#error \"the scene was compiled in %s\"\n#endif\n",
            MCT_REAL_IS_FLOAT, MCT_REAL_IS_FLOAT ? "float" : "double");
        put_system(&whole, plant->system, scene->stride > 1);
        put_loop(&whole, loop);
        put_sim(&whole, sim, kernel);
        put_can(&whole, &compiled);
        put_scene(&whole, &compiled);
        put(&whole, "\nconst uint64_t mct_compiled_ticks = %" PRIu64 ";\n",
            (uint64_t)(scene->duration / scene->dt + 0.5));
    }
    free(sim);
    free(loop);
    free(plan);
    return status;
}

/*
 * Prints one 64-bit hash per case over all the bits that the case computes, so that builds can be compared
 * line by line. usage: bits SCENE...
 *
 * Cases: sine and cosine; every stepper x system with a motor x motor (all eight sets of gravity, viscous and coulomb that
 * it suits in one hash), the state of every tick under an input that jumps; M, C, tau and all that follows from them; the
 * closed loop of each scene given, as it is and with noise, latency and a plant that differs, all that a tick
 * records.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/sim/sim.h"
#include "mctau/loop.h"
#include "mctau/sincos.h"

enum { TICKS = 10240, TICKS_PER_INPUT = 64, ANGLES = 1 << 16 };

static const char *const precision = MCT_REAL_IS_FLOAT ? "float " : "double";

/* --- the hash: of values, not of bytes, so that byte order and padding do not enter --- */

static uint64_t with(uint64_t hash, uint64_t value)
{
    hash = (hash ^ value) * UINT64_C(0x9FB21C651E98DF25);
    return hash ^ (hash >> 32);
}

static uint64_t with_double(uint64_t hash, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return with(hash, bits);
}

static uint64_t with_float(uint64_t hash, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return with(hash, bits);
}

static uint64_t with_real(uint64_t hash, mct_real value)
{
#if MCT_REAL_IS_FLOAT
    return with_float(hash, value);
#else
    return with_double(hash, value);
#endif
}

static uint64_t with_reals(uint64_t hash, const mct_real *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        hash = with_real(hash, values[i]);
    }
    return hash;
}

static uint64_t with_state(uint64_t hash, const mct_system *system, const mct_state *state)
{
    const size_t states = (size_t)mct_most_states(system);
    hash = with_reals(hash, state->x, states);
    hash = with_reals(hash, state->c, states);
    for (int i = 0; i < system->coordinate_count; i++) {
        hash = with(hash, (uint32_t)state->turns[i]);
    }
    return hash;
}

/* Of two coordinates and four particles at least, as all systems once had. */
static uint64_t with_evaluation(uint64_t hash, const mct_scene *scene, const mct_evaluation *at)
{
    const size_t n = (size_t)mct_coordinate_count(scene);
    const size_t count = (size_t)mct_particle_count(scene);
    const size_t N = n > 2 ? n : 2;
    const size_t particles = count > 4 ? count : 4;
    for (size_t i = 0; i < N; i++) {
        hash = with_reals(hash, at->M[i], N);
    }
    hash = with_reals(hash, &at->position[0][0], 3 * particles);
    hash = with_reals(hash, at->mass, particles);
    hash = with_real(hash, at->potential_energy);
    for (size_t i = 0; i < N; i++) {
        hash = with_reals(hash, at->C[i], N);
    }
    hash = with_reals(hash, at->Cv, N);
    hash = with_real(hash, at->kinetic_energy);
    hash = with_real(hash, at->magnetic_energy);
    hash = with_reals(hash, at->tau, N);
    hash = with_reals(hash, at->acceleration, N);
    hash = with_real(hash, at->current);
    hash = with_reals(hash, &at->constraint_force[0][0], 3 * particles);
    hash = with_real(hash, at->power_input);
    hash = with_reals(hash, at->power, MCT_EFFECT_COUNT);
    hash = with_real(hash, at->power_frame);
    hash = with_real(hash, at->power_resistance);
    return with_real(hash, at->power_conversion);
}

static uint64_t with_record(uint64_t hash, const mct_system *system, const mct_record *record)
{
    hash = with_state(hash, system, &record->plant);
    for (int i = 0; i < mct_encoder_count(system); i++) {
        hash = with(hash, (uint32_t)record->reading.counts[i]);
    }
    hash = with(hash, record->reading.flags);
    hash = with_reals(hash, record->estimate, 2 * (size_t)mct_encoder_count(system));
    hash = with_real(hash, record->wanted);
    hash = with_real(hash, record->applied);
    hash = with(hash, (uint64_t)record->mode);
    return with(hash, record->faults);
}

/* --- cases --- */

static void fail(const char *what, const char *why)
{
    fprintf(stderr, "bits: %s: %s\n", what, why);
    exit(1);
}

static void print_sincos(void)
{
    uint64_t hash = 0;
    for (int i = 0; i < ANGLES; i++) {
        const int32_t from_middle = i - ANGLES / 2;
        const double x = (double)from_middle * (double)abs(from_middle) * 0x1.234567p-20;
        const int32_t binary_angle = from_middle * 65521;
        double s, c;
        float fs, fc;
        mct_sincos_f64(x, &s, &c);
        hash = with_double(with_double(hash, s), c);
        mct_sincos_f32((float)x, &fs, &fc);
        hash = with_float(with_float(hash, fs), fc);
        mct_sincos_turn32_f64(binary_angle, &s, &c);
        hash = with_double(with_double(hash, s), c);
        mct_sincos_turn32(binary_angle, &fs, &fc);
        hash = with_float(with_float(hash, fs), fc);
    }
    printf("%s sincos %016llx\n", precision, (unsigned long long)hash);
}

/* A fraction of the full input, held for some ticks: any multiple of 1/128 between -1 and 1. */
static double input_at(int tick)
{
    const uint32_t hold = (uint32_t)(tick / TICKS_PER_INPUT);
    return (double)(int32_t)((hold * UINT32_C(2654435761)) >> 24) / 128 - 1;
}

/* A scene in which every stepper can follow the motor, and no state runs away. */
static void prepare_scene(mct_scene *scene, int system, int stepper, uint32_t effects)
{
    mct_scene_defaults(scene, system);
    const mct_system *model = mct_systems[system];
    double *p = scene->parameters;
    scene->stepper = stepper;
    scene->effects = effects;
    p[model->actuation->inductance_parameter] = 2e-3 * p[model->actuation->resistance_parameter];
    for (int i = 0; i < model->parameter_count; i++) {
        const char *name = model->parameters[i].name;
        if (strstr(name, "coulomb") != NULL) {
            p[i] = strstr(name, "cart") != NULL ? 0.5 : 1e-3;
        } else if (strstr(name, "drag") != NULL) {
            p[i] = strstr(name, "cart") != NULL ? 0.5 : 1e-5;
        }
    }
    scene->initial[model->actuation->upright_coordinate] = 2;
}

static double full_input(const mct_scene *scene)
{
    const mct_system *model = mct_systems[scene->system];
    if (scene->effects & MCT_MOTOR) {
        return scene->parameters[model->actuation->supply_parameter];
    }
    return model->coordinates[model->actuation->driven_coordinate].is_angle ? 1e-3 : 1;
}

/* Of all sets of gravity, viscous and Moreau's friction beside a motor and `more`. */
static void print_kernels(const char *what, int system, int stepper, const char *motor, uint32_t more)
{
    uint64_t hash = 0;
    int suited = 0;
    char name[64];
    snprintf(name, sizeof name, "%s %s %s", mct_systems[system]->name, mct_steppers[stepper].name, motor);
    for (uint32_t others = 0; others < MCT_MOTOR_QUASI_STATIC; others++) {
        mct_scene scene;
        mct_plant plant;
        prepare_scene(&scene, system, stepper, more | others);
        const double amplitude = full_input(&scene);
        const mct_status status = mct_plant_init(&plant, &scene, NULL);
        if (status == MCT_ERROR_UNSUITED) {
            continue;
        }
        suited++;
        if (status != MCT_OK) {
            fail(name, "not accepted");
        }
        for (int tick = 0; tick < TICKS; tick++) {
            mct_plant_step(&plant, (mct_real)(amplitude * input_at(tick)));
            hash = with_state(hash, plant.system, &plant.state);
        }
        if (plant.diverged_ticks != 0) {
            fail(name, "diverged, so its hash would say little");
        }
    }
    if (suited > 0) {
        printf("%s %s %s %016llx\n", precision, what, name, (unsigned long long)hash);
    }
}

/* A system without a motor, from its defaults: under weight, what a scene gets, and all effects with either kind of friction. */
static void print_motion(int system, int stepper)
{
    const mct_system *model = mct_systems[system];
    const uint32_t sets[] = {model->effects & MCT_GRAVITY, model->standard_effects,
                             model->effects & ~(uint32_t)MCT_COULOMB_EXACT,
                             model->effects & ~(uint32_t)MCT_COULOMB_MOREAU};
    const double amplitude = model->input_without_motor != NULL ? 1e-3 : 0;
    uint64_t hash = 0;
    int suited = 0;
    for (size_t i = 0; i < sizeof sets / sizeof sets[0]; i++) {
        mct_scene scene;
        mct_plant plant;
        mct_scene_defaults(&scene, system);
        scene.stepper = stepper;
        scene.effects = sets[i];
        for (int k = 0; k < model->parameter_count;
             k++) { /* those of effects that a scene does not get are 0 */
            scene.parameters[k] += scene.parameters[k] == 0 && model->parameters[k].effects != 0 ? 0.01 : 0;
        }
        if (mct_plant_init(&plant, &scene, NULL) != MCT_OK) {
            continue;
        }
        suited++;
        for (int tick = 0; tick < TICKS; tick++) {
            mct_plant_step(&plant, (mct_real)(amplitude * input_at(tick)));
            hash = with_state(hash, plant.system, &plant.state);
        }
        if (plant.diverged_ticks != 0) {
            fail(model->name, "diverged, so its hash would say little");
        }
    }
    if (suited > 0) {
        printf("%s motion %s %s %016llx\n", precision, model->name, mct_steppers[stepper].name,
               (unsigned long long)hash);
    }
}

static void print_evaluations(int system, const char *motor, uint32_t motor_effect)
{
    uint64_t hash = 0;
    mct_scene scene;
    mct_plant plant;
    mct_evaluation at;
    prepare_scene(&scene, system, MCT_STEPPER_LEAP,
                  motor_effect | MCT_GRAVITY | MCT_VISCOUS | MCT_COULOMB_MOREAU);
    if (mct_plant_init(&plant, &scene, NULL) != MCT_OK) {
        fail(mct_systems[system]->name, "not accepted");
    }
    for (int tick = 0; tick < TICKS; tick++) {
        mct_plant_step(&plant, (mct_real)(full_input(&scene) * input_at(tick)));
        mct_plant_evaluate(&plant, &at);
        hash = with_evaluation(hash, &scene, &at);
    }
    printf("%s evaluate %s %s %016llx\n", precision, mct_systems[system]->name, motor,
           (unsigned long long)hash);
}

static void run_loop(const mct_scene *scene, const char *name, const char *variant)
{
    static mct_sim sim;
    static mct_loop loop;
    static mct_plan plan;
    uint64_t hash = 0;
    if (mct_sim_init(&sim, scene, NULL) != MCT_OK ||
        mct_loop_init(&loop, &plan, scene, mct_sim_hal(&sim), NULL, (mct_samples){NULL, 0}, NULL) != MCT_OK) {
        fail(name, "not accepted");
    }
    loop.hal.ops->open(loop.hal.context, NULL);
    const uint64_t ticks = (uint64_t)(scene->duration / scene->dt + 0.5);
    for (uint64_t tick = 0; tick < ticks; tick++) {
        mct_loop_tick(&loop);
        hash = with_record(hash, mct_systems[scene->system], &loop.record);
    }
    loop.hal.ops->close(loop.hal.context);
    printf("%s scene %s %s %s %016llx\n", precision, name, mct_steppers[scene->stepper].name, variant,
           (unsigned long long)hash);
}

static void print_scene(const char *path)
{
    static char text[1 << 16];
    mct_scene scene;
    mct_message why;
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        fail(path, "cannot be opened");
    }
    const size_t length = fread(text, 1, sizeof text, file);
    fclose(file);
    if (mct_scene_read(text, length, path, NULL, 0, &scene, &why) != MCT_OK) {
        fail(path, why.text);
    }
    const char *name = mct_systems[scene.system]->name;
    run_loop(&scene, name, "as_it_is");
    scene.noise = 1;
    scene.latency = 1;
    scene.sensor_seed = scene.variation_seed = 1;
    scene.variation_spread = 0.05;
    run_loop(&scene, name, "varied");
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        uint32_t effect;
    } motors[] = {{"off", 0}, {"quasi_static", MCT_MOTOR_QUASI_STATIC}, {"inductive", MCT_MOTOR_INDUCTIVE}};
    static const struct {
        const char *name;
        uint32_t effect;
    } kinds[] = {{"kernels", 0},
                 {"drag", MCT_DRAG},
                 {"exact", MCT_COULOMB_EXACT},
                 {"exact_drag", MCT_COULOMB_EXACT | MCT_DRAG}};
    print_sincos();
    for (int system = 0; system < MCT_SYSTEM_COUNT && mct_systems[system]->actuation != NULL; system++) {
        for (size_t m = 0; m < sizeof motors / sizeof motors[0]; m++) {
            for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
                for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
                    print_kernels(kinds[i].name, system, stepper, motors[m].name,
                                  motors[m].effect | kinds[i].effect);
                }
            }
            print_evaluations(system, motors[m].name, motors[m].effect);
        }
    }
    for (int system = 0; system < MCT_SYSTEM_COUNT; system++) {
        for (int stepper = 0; mct_systems[system]->actuation == NULL && stepper < MCT_STEPPER_COUNT;
             stepper++) {
            print_motion(system, stepper);
        }
    }
    for (int i = 1; i < argc; i++) {
        print_scene(argv[i]);
    }
    return fflush(stdout) == 0 ? 0 : 1;
}

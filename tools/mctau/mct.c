/* mctau mct: everything that the equation of motion says at a scene's initial state. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "json.h"
#include "say.h"
#include "scene_file.h"
#include "verbs.h"

#define LARGEST_INPUT 1e9 /* as in a scene */

static const option options[] = {
    OPTION_SET,
    {"input", "V", NULL,
     "input [V; N or N m with the motor off]; default: the scene's own at t = 0, 0 under a controller"},
    {"precision", "NAME", "scene.precision", NULL},
    OPTION_JSON,
    {NULL, NULL, NULL, NULL},
};

static int run_verb(const arguments *given);

const verb verb_mct = {
    .name = "mct",
    .doc = "shows M, C, tau, accelerations, constraint forces, energies and powers at a state",
    .operand = "SCENE",
    .text = "Evaluates M(q) a + C(q,v) v = tau at the scene's initial state, which --set initial.NAME=VALUE "
            "changes.\n"
            "The constraint force on a particle is e = m xdd - f: what the constraints add to the forces f "
            "from outside.",
    .options = options,
    .examples = "  mctau mct scenes/cart_pole.toml --set initial.pole_angle=0.5 --set initial.pole_rate=2\n"
                "  mctau mct scenes/reaction_wheel.toml --input 10 --json\n",
    .exit_codes = "  0  well\n"
                  "  2  the command line or the scene is wrong\n"
                  "  3  the scene could not be read\n",
    .run = run_verb,
};

static double total(const energies *energy)
{
    return energy->kinetic + energy->potential + energy->magnetic;
}

/* Rate of change of all energy. */
static double total_power(const energies *power)
{
    return power->power_input + power->power_viscous + power->power_coulomb + power->power_resistance +
           power->power_conversion + power->power_base;
}

/* --- JSON --- */

static void json_matrix(json *out, const char *key, const double (*rows)[RUNNER_MAX_COORDINATES], int n)
{
    json_list(out, key);
    for (int i = 0; i < n; i++) {
        json_vector(out, NULL, rows[i], n);
    }
    json_end_list(out);
}

static void json_particles(json *out, const char *key, const mct_result *at, const double (*rows)[3])
{
    json_object(out, key);
    for (int i = 0; i < at->particles; i++) {
        json_vector(out, at->particle_names[i], rows[i], 3);
    }
    json_end_object(out);
}

static void print_json(const scene_file *file, const mct_result *at)
{
    const int n = at->coordinates;
    json out = json_begin(stdout, "mctau.mct/1");
    json_text(&out, "system", mct_systems[file->scene.system]->name);
    json_text(&out, "precision", file->runner->precision);
    json_list(&out, "coordinates");
    for (int i = 0; i < n; i++) {
        json_text(&out, NULL, at->names[i]);
    }
    json_end_list(&out);
    json_object(&out, "state");
    for (int i = 0; i < at->states; i++) {
        json_number(&out, at->names[i], at->state[i]);
    }
    json_end_object(&out);
    json_number(&out, "input", at->input);
    json_matrix(&out, "M", at->M, n);
    json_matrix(&out, "C", at->C, n);
    json_vector(&out, "Cv", at->Cv, n);
    json_vector(&out, "tau", at->tau, n);
    json_vector(&out, "acceleration", at->acceleration, n);
    json_particles(&out, "constraint_force", at, at->constraint_force);
    json_particles(&out, "position", at, at->position);
    json_object(&out, "mass");
    for (int i = 0; i < at->particles; i++) {
        json_number(&out, at->particle_names[i], at->mass[i]);
    }
    json_end_object(&out);
    json_number(&out, "current", at->current);
    json_number(&out, "energy", total(&at->energy));
    json_object(&out, "energies");
    json_number(&out, "kinetic", at->energy.kinetic);
    json_number(&out, "potential", at->energy.potential);
    json_number(&out, "magnetic", at->energy.magnetic);
    json_end_object(&out);
    json_number(&out, "power", total_power(&at->energy));
    json_object(&out, "powers");
    json_number(&out, "input", at->energy.power_input);
    json_number(&out, "viscous", at->energy.power_viscous);
    json_number(&out, "coulomb", at->energy.power_coulomb);
    json_number(&out, "resistance", at->energy.power_resistance);
    json_number(&out, "conversion", at->energy.power_conversion);
    json_number(&out, "base", at->energy.power_base);
    json_end_object(&out);
    json_finish(&out);
}

/* --- for people --- */

static bool is_length(const mct_result *at, int coordinate)
{
    return strcmp(at->units[coordinate], "m") == 0;
}

static const char *force_unit(const mct_result *at, int coordinate)
{
    return is_length(at, coordinate) ? "N" : "N m";
}

static void print_state(const scene_file *file, const mct_result *at)
{
    const mct_system *system = mct_systems[file->scene.system];
    const bool has_motor = (file->scene.effects & MCT_MOTOR) != 0;
    printf("%s, precision %s\n\nState\n", system->name, file->runner->precision);
    for (int i = 0; i < at->states; i++) {
        printf("  %-18s %14.8g %s\n", at->names[i], at->state[i], at->units[i]);
    }
    printf("  %-18s %14.8g %s\n", has_motor ? "(input) voltage" : "(input)", at->input,
           has_motor                             ? "V"
           : system->input_without_motor != NULL ? system->input_without_motor->unit
                                                 : "");
}

/* M and C, with the unit that turns a column's acceleration or velocity into the row's force. */
static void print_matrix(const mct_result *at, const char *title,
                         const double (*rows)[RUNNER_MAX_COORDINATES], const char *units[3])
{
    const int n = at->coordinates;
    printf("\n%s\n  %-18s", title, "");
    for (int j = 0; j < n; j++) {
        printf(" %20s", at->names[j]);
    }
    printf("\n");
    for (int i = 0; i < n; i++) {
        printf("  %-18s", at->names[i]);
        for (int j = 0; j < n; j++) {
            printf(" %12.6g %-7s", rows[i][j], units[!is_length(at, i) + !is_length(at, j)]);
        }
        printf("\n");
    }
}

static void print_vectors(const mct_result *at)
{
    printf("\n  %-18s %18s %18s %18s\n", "", "C v", "tau", "acceleration a");
    for (int i = 0; i < at->coordinates; i++) {
        printf("  %-18s %14.8g %-3s %14.8g %-3s %14.8g %s/s^2\n", at->names[i], at->Cv[i], force_unit(at, i),
               at->tau[i], force_unit(at, i), at->acceleration[i], at->units[i]);
    }
}

static void print_particles(const mct_result *at)
{
    printf("\nConstraint force e = m xdd - f of each particle [N] (1 right, 2 up, 3 to the viewer)\n");
    printf("  %-18s %12s %14s %14s %14s\n", "", "mass [kg]", "e1", "e2", "e3");
    for (int i = 0; i < at->particles; i++) {
        const double *e = at->constraint_force[i];
        printf("  %-18s %12.6g %14.8g %14.8g %14.8g\n", at->particle_names[i], at->mass[i], e[0], e[1], e[2]);
    }
    printf("  Of all forces that keep the constraints, e has the least sum of |e|^2 / m: it is the residual "
           "of Gauss's\n"
           "  least-squares problem, whose solution is a.\n");
}

static void print_ledger(const mct_result *at)
{
    const energies *e = &at->energy;
    const struct {
        const char *name;
        double value;
    } energy[] = {{"kinetic", e->kinetic},
                  {"potential", e->potential},
                  {"magnetic", e->magnetic},
                  {"total", total(e)}},
      power[] = {{"input", e->power_input},
                 {"viscous friction", e->power_viscous},
                 {"dry friction", e->power_coulomb},
                 {"resistance", e->power_resistance},
                 {"conversion", e->power_conversion},
                 {"moving base", e->power_base},
                 {"total", total_power(e)}};
    printf("\nEnergy [J]\n");
    for (size_t i = 0; i < sizeof energy / sizeof energy[0]; i++) {
        printf("  %-18s %14.8g\n", energy[i].name, energy[i].value);
    }
    printf("\nPower [W]: what changes it; the total is its rate\n");
    for (size_t i = 0; i < sizeof power / sizeof power[0]; i++) {
        printf("  %-18s %14.8g\n", power[i].name, power[i].value + 0.0); /* shows -0 as 0 */
    }
}

static void print_text(const scene_file *file, const mct_result *at)
{
    static const char *mass_units[3] = {"kg", "kg m", "kg m^2"};
    static const char *damping_units[3] = {"N s/m", "N s", "N m s"};
    print_state(file, at);
    print_matrix(at, "Mass matrix M", at->M, mass_units);
    print_matrix(at, "C = m J' Jdot", at->C, damping_units);
    print_vectors(at);
    print_particles(at);
    print_ledger(at);
}

/* --- the verb --- */

static int read_input(const char *text, double *input)
{
    char *end;
    *input = strtod(text, &end);
    if (end == text || *end != '\0' || !(fabs(*input) <= LARGEST_INPUT)) {
        return say(EXIT_USAGE, "--input: found %s; allowed a number from %g to %g", text, -LARGEST_INPUT,
                   LARGEST_INPUT);
    }
    return 0;
}

static int evaluate(const scene_file *file, const arguments *given)
{
    mct_result at;
    mct_message why;
    double input = 0;
    const char *text = arguments_value(given, "input");
    const run_options samples = {.samples = file->samples, .sample_count = file->sample_count};
    if (text != NULL && read_input(text, &input) != 0) {
        return EXIT_USAGE;
    }
    const mct_status status =
        file->runner->mct(&file->scene, &samples, text != NULL ? &input : NULL, &at, &why);
    if (status != MCT_OK) {
        return say_status(status, &why);
    }
    if (arguments_value(given, "json") != NULL) {
        print_json(file, &at);
    } else {
        print_text(file, &at);
    }
    return EXIT_WELL;
}

static int run_verb(const arguments *given)
{
    scene_file file;
    int exit_code = scene_file_read(&file, given);
    if (exit_code == 0) {
        exit_code = evaluate(&file, given);
        scene_file_free(&file);
    }
    return exit_code;
}

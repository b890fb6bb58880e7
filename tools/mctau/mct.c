/* mctau mct: everything that the equation of motion says at a scene's initial state. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "json.h"
#include "ledger.h"
#include "say.h"
#include "scene_file.h"
#include "verbs.h"

#define LARGEST_INPUT 1e9 /* as in a scene */

static const option options[] = {
    OPTION_SET,
    {"input", "V", NULL,
     "input [V; N or N m with the motor off]; default: the scene's own at t = 0, 0 under a controller"},
    {"precision", "NAME", "scene.precision", NULL},
    {"christoffel", NULL, NULL,
     "also the matrix C of eq. 229, from the derivatives of M: another matrix, the same C v"},
    OPTION_JSON,
    {NULL, NULL, NULL, NULL},
};

static int run_verb(const arguments *given);

const verb verb_mct = {
    .name = "mct",
    .doc = "shows M, C, tau, accelerations, constraint forces, energies and powers at a state",
    .operand = "SCENE",
    .text =
        "Evaluates M(q) a + C(q,v) v = tau at the scene's initial state, which --set initial.NAME=VALUE "
        "changes.\n"
        "The constraint force on a particle is e = m xdd - f: what the constraints add to the forces f from "
        "outside,\n"
        "and so what rods and joints carry. It is computed twice: in closed form, and as the residual of "
        "Gauss's\n"
        "least-squares problem, for which the geometry x = h(q), the masses and f are enough.",
    .options = options,
    .examples = "  mctau mct scenes/fixed_axis.toml\n"
                "  mctau mct scenes/cart_pole.toml --set initial.pole_angle=0.5 --set initial.pole_rate=2\n"
                "  mctau mct scenes/reaction_wheel.toml --input 10 --json\n",
    .exit_codes = "  0  well\n"
                  "  2  the command line or the scene is wrong\n"
                  "  3  the scene could not be read\n",
    .run = run_verb,
};

/* Of a base or a frame that moves as prescribed: through the constraints. */
static double prescribed_power(const powers *power)
{
    return power->of[MCT_EFFECT_BASE_MOTION] + power->of[MCT_EFFECT_CENTRIFUGAL] +
           power->of[MCT_EFFECT_CORIOLIS] + power->of[MCT_EFFECT_EULER] + power->of[POWER_FRAME];
}

/* What the particles' constraint forces come to. */
typedef struct {
    double force[3], moment[3];     /* all e together, and about the origin: what carries the mechanism */
    double least;                   /* sum of |e|^2 / m [N^2/kg] */
    double work, work_of_couples;   /* per second: e . xd, and couples . v [W] */
    double acceleration_difference; /* of the two ways to a, relative to the largest, or 1 */
    double force_difference;        /* of those to e, relative to the largest force */
} sums;

/* Largest difference of n numbers, relative to the largest number and to `scale` at least. */
static double difference_of(const double *a, const double *b, int n, double scale)
{
    double largest = scale, difference = 0;
    for (int i = 0; i < n; i++) {
        largest = fmax(largest, fmax(fabs(a[i]), fabs(b[i])));
        difference = fmax(difference, fabs(a[i] - b[i]));
    }
    return largest > 0 ? difference / largest : 0;
}

static sums sums_of(const mct_result *at)
{
    sums sum = {.force = {0}};
    double largest_force = 0;
    for (int i = 0; i < at->particles; i++) {
        const double *e = at->constraint_force[i];
        const double *x = at->position[i];
        for (int j = 0; j < 3; j++) {
            sum.force[j] += e[j];
            largest_force = fmax(largest_force, fabs(at->force[i][j]));
            sum.moment[j] += x[(j + 1) % 3] * e[(j + 2) % 3] - x[(j + 2) % 3] * e[(j + 1) % 3];
            sum.least += at->mass[i] > 0 ? e[j] * e[j] / at->mass[i] : 0;
            sum.work += e[j] * at->gauss.velocity[i][j];
        }
    }
    for (int i = 0; i < at->coordinates; i++) {
        sum.work_of_couples += at->gauss.couple[i] * at->rate[i];
    }
    sum.acceleration_difference = difference_of(at->acceleration, at->gauss.acceleration, at->coordinates, 1);
    sum.force_difference = difference_of(at->constraint_force[0], at->gauss.constraint_force[0],
                                         3 * at->particles, largest_force);
    return sum;
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
    const sums sum = sums_of(at);
    const energies gains = powers_gains(&at->power, file->scene.effects);
    json out = json_begin(stdout, "mctau.mct/1");
    json_text(&out, "system", mct_systems[file->scene.system]->name);
    json_text(&out, "precision", file->runner->precision);
    json_list(&out, "coordinates");
    for (int i = 0; i < n; i++) {
        json_text(&out, NULL, at->coordinate_names[i]);
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
    json_particles(&out, "force", at, at->force);
    json_particles(&out, "constraint_force", at, at->constraint_force);
    json_object(&out, "load");
    json_vector(&out, "force", sum.force, 3);
    json_vector(&out, "moment", sum.moment, 3);
    json_end_object(&out);
    if (at->gauss.solved) {
        json_object(&out, "gauss");
        json_vector(&out, "acceleration", at->gauss.acceleration, n);
        json_vector(&out, "couple", at->gauss.couple, n);
        json_particles(&out, "constraint_force", at, at->gauss.constraint_force);
        json_number(&out, "least", sum.least);
        json_number(&out, "acceleration_difference", sum.acceleration_difference);
        json_number(&out, "force_difference", sum.force_difference);
        json_number(&out, "work_of_constraints", sum.work);
        json_number(&out, "work_of_couples", sum.work_of_couples);
        if (at->gauss.has_C) {
            json_matrix(&out, "C", at->gauss.C, n);
        }
        json_end_object(&out);
    }
    json_particles(&out, "position", at, at->position);
    json_object(&out, "mass");
    for (int i = 0; i < at->particles; i++) {
        json_number(&out, at->particle_names[i], at->mass[i]);
    }
    json_end_object(&out);
    json_number(&out, "current", at->current);
    json_number(&out, "energy", energy_total(at->energy));
    json_energies(&out, "energies", &at->energy);
    json_number(&out, "power", energy_total(gains));
    json_powers(&out, "powers", &at->power, &file->scene);
    json_energies(&out, "rates", &gains);
    json_finish(&out);
}

/* --- for people --- */

/* A number in its column; a zero without the sign that a product may have left. */
static void print_number(int width, int digits, double value)
{
    printf(" %*.*g", width, digits, value + 0.0);
}

static bool is_length(const mct_result *at, int coordinate)
{
    return strcmp(at->coordinate_units[coordinate], "m") == 0;
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
        printf("  %-18s", at->names[i]);
        print_number(14, 8, at->state[i]);
        printf(" %s\n", at->units[i]);
    }
    if (!has_motor && system->input_without_motor == NULL) {
        return;
    }
    printf("  %-18s", has_motor ? "(input) voltage" : "(input)");
    print_number(14, 8, at->input);
    printf(" %s\n", has_motor ? "V" : system->input_without_motor->unit);
}

/* M and C, with the unit that turns a column's acceleration or velocity into the row's force. */
static void print_matrix(const mct_result *at, const char *title,
                         const double (*rows)[RUNNER_MAX_COORDINATES], const char *units[3])
{
    const int n = at->coordinates;
    printf("\n%s\n  %-18s", title, "");
    for (int j = 0; j < n; j++) {
        printf(" %20s", at->coordinate_names[j]);
    }
    printf("\n");
    for (int i = 0; i < n; i++) {
        printf("  %-18s", at->coordinate_names[i]);
        for (int j = 0; j < n; j++) {
            print_number(12, 6, rows[i][j]);
            printf(" %-7s", units[!is_length(at, i) + !is_length(at, j)]);
        }
        printf("\n");
    }
}

static void print_vectors(const mct_result *at)
{
    printf("\n  %-18s %18s %18s %18s\n", "", "C v", "tau", "acceleration a");
    for (int i = 0; i < at->coordinates; i++) {
        printf("  %-18s", at->coordinate_names[i]);
        print_number(14, 8, at->Cv[i]);
        printf(" %-3s", force_unit(at, i));
        print_number(14, 8, at->tau[i]);
        printf(" %-3s", force_unit(at, i));
        print_number(14, 8, at->acceleration[i]);
        printf(" %s/s^2\n", at->coordinate_units[i]);
    }
}

static void print_row(const char *name, double mass, const double *vector)
{
    printf("  %-20s", name);
    if (mass >= 0) {
        print_number(12, 6, mass);
    } else {
        printf(" %12s", "");
    }
    for (int j = 0; j < 3; j++) {
        print_number(14, 8, vector[j]);
    }
    print_number(14, 8, sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]));
    printf("\n");
}

static void print_particles(const mct_result *at, const sums *sum)
{
    printf("\nConstraint force e = m xdd - f of each particle [N]: what rods and joints carry (1 right, 2 "
           "up, 3 to the "
           "viewer)\n");
    printf("  %-20s %12s %14s %14s %14s %14s\n", "", "mass [kg]", "e1", "e2", "e3", "|e|");
    for (int i = 0; i < at->particles; i++) {
        print_row(at->particle_names[i], at->mass[i], at->constraint_force[i]);
    }
    print_row("all: on the support", -1, sum->force);
    print_row("moment, origin [N m]", -1, sum->moment);
}

static void print_gauss(const mct_result *at, const sums *sum)
{
    printf(
        "\nGauss's principle: of all motions that the constraints allow, a has the least sum of |e|^2 / m\n");
    if (!at->gauss.solved) {
        printf("  The coordinates do not move the particles independently here: M has no inverse, and the "
               "closed form\n"
               "  takes the smallest of the accelerations that do.\n");
        return;
    }
    const struct {
        const char *name;
        double value;
        const char *unit, *doc;
    } rows[] = {
        {"sum of |e|^2 / m", sum->least, "N^2/kg", "of the closed form"},
        {"a differs by", sum->acceleration_difference, "", "between closed form and least squares, relative"},
        {"e differs by", sum->force_difference, "", "from the residual of the least squares, relative"},
        {"work of e", sum->work, "W", "e . xd"},
        {"work of couples", sum->work_of_couples, "W", "of joint friction and torques, which e passes on"},
        {"of the base", prescribed_power(&at->power), "W", "which moves as prescribed"},
        {"of constraints", sum->work - sum->work_of_couples - prescribed_power(&at->power), "W",
         "the rest: none"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        printf("  %-18s", rows[i].name);
        print_number(12, 4, rows[i].value);
        printf(" %-7s %s\n", rows[i].unit, rows[i].doc);
    }
}

static void print_ledger(const scene_file *file, const mct_result *at)
{
    const energies gains = powers_gains(&at->power, file->scene.effects);
    print_energies_head(stdout, "Energy [J]");
    print_energies(stdout, "at this state", &at->energy);
    print_energies_head(stdout, "Power [W]: what changes it");
    print_powers(stdout, &at->power, &file->scene);
    print_energies(stdout, "its rate", &gains);
}

static void print_motion(const scene_file *file, const mct_result *at, bool christoffel)
{
    static const char *mass_units[3] = {"kg", "kg m", "kg m^2"};
    static const char *damping_units[3] = {"N s/m", "N s", "N m s"};
    const sums sum = sums_of(at);
    print_matrix(at, "Mass matrix M", at->M, mass_units);
    print_matrix(at, "C = m J' Jdot", at->C, damping_units);
    if (christoffel && at->gauss.has_C) {
        print_matrix(at, "C of eq. 229", at->gauss.C, damping_units);
    } else if (christoffel) {
        printf("\nC of eq. 229: not of a rotation, whose rates are no derivatives of coordinates\n");
    }
    print_vectors(at);
    print_particles(at, &sum);
    print_gauss(at, &sum);
    print_ledger(file, at);
}

/* Of a process M a = tau is its next step. */
static void print_process(const mct_result *at)
{
    static const char *units[3] = {"m^2", "m^2", "m^2"};
    print_matrix(at, "M of M update = J'(d - f), by the method", at->M, units);
    printf("\n  %-18s %18s %18s\n", "", "tau = J'(d - f)", "next update");
    for (int i = 0; i < at->coordinates; i++) {
        printf("  %-18s", at->coordinate_names[i]);
        print_number(14, 8, at->tau[i]);
        printf(" m^2");
        print_number(14, 8, at->acceleration[i]);
        printf(" rad\n");
    }
    printf("\n  %-18s %14s %14s %14s\n", "position [m]", "x1", "x2", "x3");
    for (int i = 0; i < at->particles; i++) {
        printf("  %-18s", at->particle_names[i]);
        for (int j = 0; j < 3; j++) {
            print_number(14, 8, at->position[i][j]);
        }
        printf("\n");
    }
    printf("\n  %-18s", "tip to target [m]");
    print_number(14, 8, sqrt(2 * at->energy.potential));
    printf("\n");
}

static void print_text(const scene_file *file, const mct_result *at, bool christoffel)
{
    print_state(file, at);
    if (mct_systems[file->scene.system]->is_process) {
        print_process(at);
    } else {
        print_motion(file, at, christoffel);
    }
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
    const run_options samples = {.samples = file->samples};
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
        print_text(file, &at, arguments_value(given, "christoffel") != NULL);
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

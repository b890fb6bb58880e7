#include "ledger.h"

#include "mctau/system.h"

static const char *name_of(int power)
{
    static const char *const others[] = {"input", "resistance", "conversion", "frame"};
    return power < MCT_EFFECT_COUNT ? mct_effects[power].name : others[power - MCT_EFFECT_COUNT];
}

static bool has(const mct_scene *scene, int power, double amount)
{
    const mct_system *const system = mct_systems[scene->system];
    const bool motor = (scene->effects & MCT_MOTOR) != 0;
    switch (power) {
    case POWER_INPUT:
        return motor || system->input_without_motor != NULL || amount != 0;
    case POWER_RESISTANCE:
    case POWER_CONVERSION:
        return motor;
    case POWER_FRAME:
        return system->is_timed;
    default: /* saturation bounds an input and has no power */
        return power != MCT_EFFECT_SATURATION && (scene->effects & mct_effects[power].mask) != 0;
    }
}

void json_powers(json *out, const char *key, const powers *self, const mct_scene *scene)
{
    json_object(out, key);
    for (int i = 0; i < POWER_COUNT; i++) {
        if (has(scene, i, self->of[i])) {
            json_number(out, name_of(i), self->of[i]);
        }
    }
    json_end_object(out);
}

void json_energies(json *out, const char *key, const energies *self)
{
    json_object(out, key);
    json_number(out, "kinetic", self->kinetic);
    json_number(out, "potential", self->potential);
    json_number(out, "magnetic", self->magnetic);
    json_end_object(out);
}

void print_energies_head(FILE *file, const char *title)
{
    fprintf(file, "\n%s\n  %-16s %14s %14s %14s %14s\n", title, "", "kinetic", "potential", "magnetic",
            "total");
}

void print_powers(FILE *file, const powers *self, const mct_scene *scene)
{
    for (int i = 0; i < POWER_COUNT; i++) {
        if (has(scene, i, self->of[i])) {
            const energies gain = power_gains(i, self->of[i], scene->effects);
            print_energies(file, name_of(i), &gain);
        }
    }
}

void print_energies(FILE *file, const char *name, const energies *self)
{
    fprintf(file, "  %-16s %14.6g %14.6g %14.6g %14.6g\n", name, self->kinetic + 0.0, self->potential + 0.0,
            self->magnetic + 0.0, energy_total(*self) + 0.0); /* + 0: without the sign of a zero */
}

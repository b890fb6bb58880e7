/* The one table that a precision shows to the front end. MCT_RUNNER, its name, is given by the build. */
#include "runner.h"

#include <string.h>

#include "mctau/input.h"
#include "mctau/judge.h"
#include "mctau/plant.h"
#include "runner_advise.h"
#include "runner_compile.h"
#include "runner_cost.h"
#include "runner_drive.h"
#include "runner_import.h"
#include "runner_ledger.h"
#include "runner_replay.h"
#include "runner_run.h"

energies runner_energies(const mct_evaluation *at)
{
    return (energies){
        .kinetic = (double)at->kinetic_energy,
        .potential = (double)at->potential_energy,
        .magnetic = (double)at->magnetic_energy,
    };
}

powers runner_powers(const mct_evaluation *at)
{
    powers power = {{
        [POWER_INPUT] = (double)at->power_input,
        [POWER_RESISTANCE] = (double)at->power_resistance,
        [POWER_CONVERSION] = (double)at->power_conversion,
        [POWER_FRAME] = (double)at->power_frame,
    }};
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        power.of[i] = (double)at->power[i];
    }
    return power;
}

/* Input at t = 0, within the plant's bounds. */
static mct_real input_of(const mct_scene *scene, const run_options *options, const double *given,
                         mct_real bound)
{
    mct_input open_loop;
    mct_input_init(&open_loop, scene, RUNNER_SAMPLES(options));
    const mct_real wanted = given != NULL ? (mct_real)*given : mct_input_at(&open_loop, 0);
    return wanted > bound ? bound : wanted < -bound ? -bound : wanted;
}

/* The closed form's judge: knows the geometry, the masses and the forces. */
static void judge(const mct_plant *plant, const mct_evaluation *at, mct_result *result)
{
    mct_judgement judgement;
    gauss_result *gauss = &result->gauss;
    memset(&judgement, 0, sizeof judgement);
    const mct_status status =
        mct_judge(plant->system, &plant->constants, result->particles, plant->state.x, at, &judgement);
    gauss->solved = status == MCT_OK;
    gauss->has_C = gauss->solved && plant->system->attitude == MCT_ATTITUDE_NONE;
    for (int i = 0; gauss->solved && i < result->coordinates; i++) {
        gauss->acceleration[i] = (double)judgement.motion.acceleration[i];
        gauss->couple[i] = (double)judgement.couple[i];
        for (int j = 0; j < result->coordinates; j++) {
            gauss->C[i][j] = (double)judgement.lagrange.C_alternative[i][j];
        }
    }
    for (int i = 0; gauss->solved && i < judgement.particle_count; i++) {
        const int own = judgement.particle[i];
        for (int axis = 0; axis < 3; axis++) {
            gauss->velocity[own][axis] = (double)judgement.motion.velocity[i][axis];
            gauss->constraint_force[own][axis] = (double)judgement.motion.constraint_force[i][axis];
        }
    }
}

static mct_status runner_mct(const mct_scene *scene, const run_options *options, const double *input,
                             mct_result *result, mct_message *why)
{
    mct_plant plant;
    mct_evaluation at;
    memset(result, 0, sizeof *result);
    mct_message_clear(why);
    const mct_status status = mct_plant_init(&plant, scene, why);
    if (status != MCT_OK) {
        return status;
    }
    plant.input = input_of(scene, options, input, plant.bound);
    mct_plant_evaluate(&plant, &at);
    const mct_system *system = plant.system;
    result->states = mct_state_count(scene);
    for (int i = 0; i < result->states; i++) {
        const mct_field *field = mct_state_field(system, i);
        result->names[i] = field->name;
        result->units[i] = field->unit;
        result->state[i] = mct_plant_value(&plant, i);
    }
    result->coordinates = mct_coordinate_count(scene);
    for (int i = 0; i < result->coordinates; i++) {
        for (int j = 0; j < result->coordinates; j++) {
            result->M[i][j] = (double)at.M[i][j];
            result->C[i][j] = (double)at.C[i][j];
        }
        result->coordinate_names[i] = system->coordinates[i].position.name;
        result->coordinate_units[i] = system->coordinates[i].position.unit;
        result->rate[i] = system->is_process ? 0 : result->state[mct_rate_index(system) + i];
        result->Cv[i] = (double)at.Cv[i];
        result->tau[i] = (double)at.tau[i];
        result->acceleration[i] = (double)at.acceleration[i];
    }
    result->particles = mct_particle_count(scene);
    for (int i = 0; i < result->particles; i++) {
        result->particle_names[i] = system->particle_names[i];
        result->mass[i] = (double)at.mass[i];
        for (int axis = 0; axis < 3; axis++) {
            result->position[i][axis] = (double)at.position[i][axis];
            result->force[i][axis] = (double)at.force[i][axis];
            result->constraint_force[i][axis] = (double)at.constraint_force[i][axis];
        }
    }
    judge(&plant, &at, result);
    result->current = (double)at.current;
    result->input = (double)plant.input;
    result->energy = runner_energies(&at);
    result->power = runner_powers(&at);
    return MCT_OK;
}

extern const mct_runner MCT_RUNNER;
const mct_runner MCT_RUNNER = {
    .precision = MCT_REAL_IS_FLOAT ? "float" : "double",
    .real_size = sizeof(mct_real),
    .run = runner_run,
    .mct = runner_mct,
    .replay = runner_replay,
    .drive = runner_drive,
    .inputs = runner_inputs,
    .ledger_begin = ledger_begin,
    .ledger_tick = ledger_tick,
    .ledger_end = ledger_end,
    .try = runner_try,
    .loop = runner_loop,
    .depart = runner_depart,
    .time_scale = runner_time_scale,
    .compile = runner_compile,
    .import = runner_import,
    .hard_case_after = hard_case_after,
    .hard_run_case = hard_run_case,
    .hard_judge = hard_judge,
    .hard_criterion = hard_criterion,
};

#include "support/draws.h"

#include <string.h>

#include "mctau/plant.h"

/* Within half an order of magnitude of the default, or of 1. */
static double near(test_random *random, const mct_field *field)
{
    const double sign = field->minimum < 0 && random_in(random, -1, 1) < 0 ? -1 : 1;
    const double drawn =
        sign * random_scale(random, 0.3, 3) * (field->standard != 0 ? fabs(field->standard) : 1);
    return fmin(fmax(drawn, field->minimum), field->maximum);
}

static void draw_lists(test_random *random, const mct_system *system, mct_scene *scene)
{
    for (int i = 0; i < system->list_count; i++) {
        const mct_row_list *rows = &system->lists[i];
        const int most = rows->most_rows < 6 ? rows->most_rows : 6;
        const int count = (int)random_in(random, rows->fewest_rows, most + 1);
        scene->lists[i].count = count * rows->column_count;
        for (int j = 0; j < scene->lists[i].count; j++) {
            const mct_field *column = &rows->columns[j % rows->column_count];
            scene->lists[i].values[j] = column->kind == MCT_FIELD_CHOICE
                                            ? (random_in(random, 0, 2) < 1 ? 0 : 1)
                                            : near(random, column);
        }
    }
}

static uint32_t draw_effects(test_random *random, const mct_system *system, uint32_t always)
{
    uint32_t effects = 0;
    for (int i = 0; i < MCT_EFFECT_COUNT; i++) {
        const uint32_t bits =
            mct_effects[i].bits[(int)random_in(random, 0, mct_effects[i].choices != NULL ? 3 : 2)];
        effects |= bits & system->effects;
    }
    return effects | (system->effects & always);
}

bool draw_scene(test_random *random, int number, uint32_t always, mct_scene *scene, mct_constants *constants,
                mct_real *x)
{
    const mct_system *system = mct_systems[number];
    mct_scene_defaults(scene, number);
    for (int i = 0; i < system->parameter_count; i++) {
        if (system->parameters[i].kind == MCT_FIELD_REAL && random_in(random, 0, 2) < 1) {
            scene->parameters[i] = near(random, &system->parameters[i]);
        }
    }
    draw_lists(random, system, scene);
    scene->effects = draw_effects(random, system, always);
    if (system->prepare(scene, 1e-3, constants, NULL) != MCT_OK) { /* two ways to give a body, say */
        mct_scene defaults;
        mct_scene_defaults(&defaults, number);
        memcpy(scene->parameters, defaults.parameters, sizeof scene->parameters);
        if (system->prepare(scene, 1e-3, constants, NULL) != MCT_OK) {
            return false;
        }
    }
    mct_state state;
    for (int i = 0; i < mct_state_count(scene); i++) {
        scene->initial[i] = near(random, mct_state_field(system, i));
    }
    mct_state_set(system, mct_state_count(scene), scene->initial, &state);
    memcpy(x, state.x, sizeof state.x);
    return true;
}

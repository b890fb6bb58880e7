/* Prints, for scenes given as lines "system key=value ...", the linear model, the weights and the gains, as
 * JSON. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mctau/controller.h"
#include "mctau/scene.h"

static void print_numbers(const char *name, const double *numbers, int count)
{
    printf("\"%s\": [", name);
    for (int i = 0; i < count; i++) {
        printf("%s%.17g", i > 0 ? ", " : "", numbers[i]);
    }
    printf("], ");
}

int main(void)
{
    char line[4096];
    while (fgets(line, sizeof line, stdin) != NULL) {
        mct_override overrides[32];
        int count = 0;
        char text[256];
        const char *const system_name = strtok(line, " \n");
        snprintf(text, sizeof text, "[scene]\nsystem = \"%s\"\n[controller]\nkind = \"swing_up_balance\"\n",
                 system_name);
        for (char *word = strtok(NULL, " \n"); word != NULL && count < 32; word = strtok(NULL, " \n")) {
            overrides[count++] = (mct_override){word, "test"};
        }
        mct_scene scene;
        mct_message why = {""};
        static mct_controller controller;
        static mct_constants constants;
        if (mct_scene_read(text, strlen(text), "text", overrides, count, &scene, &why) != MCT_OK ||
            mct_controller_init(&controller, &constants, &scene, &why) != MCT_OK) {
            fprintf(stderr, "%s\n", why.text);
            return 1;
        }
        const mct_system *const system = mct_systems[scene.system];
        mct_linear_model model;
        system->actuation->linearise(&scene, &model);
        double gains[2 * MCT_MAX_ENCODERS];
        for (int i = 0; i < model.states; i++) {
            gains[i] = (double)controller.gains[i];
        }
        const double limit = scene.parameters[system->actuation->supply_parameter];
        printf("{");
        print_numbers("A", model.A, model.states * model.states);
        print_numbers("B", model.B, model.states);
        print_numbers("weights", scene.weights, model.states);
        print_numbers("K", gains, model.states);
        printf("\"dt\": %.17g, \"input_weight\": %.17g, \"limit\": %.17g}\n", scene.dt, scene.input_weight,
               limit);
    }
    return 0;
}

/* A cart and its pole fall freely for a second. Prints the state. */
#include <stdio.h>
#include <string.h>

#include "mctau/plant.h"

int main(void)
{
    static const char text[] = "[scene]\n"
                               "system = \"cart_pole\"\n"
                               "stepper = \"rk4\"\n"
                               "[effects]\n"
                               "motor = \"off\"\n"
                               "[initial]\n"
                               "pole_angle = 2.0\n";
    mct_scene scene;
    mct_message why;
    mct_plant plant;
    if (mct_scene_read(text, strlen(text), "minimal.c", NULL, 0, &scene, &why) != MCT_OK ||
        mct_plant_init(&plant, &scene, &why) != MCT_OK) {
        fprintf(stderr, "%s\n", why.text);
        return 1;
    }
    for (int tick = 0; tick < 1000; tick++) {
        mct_plant_step(&plant, 0); /* no force on the cart */
    }
    for (int i = 0; i < plant.states; i++) {
        const mct_field *field = mct_state_field(plant.system, i);
        printf("%-14s %9.6f %s\n", field->name, mct_plant_value(&plant, i), field->unit);
    }
    return 0;
}

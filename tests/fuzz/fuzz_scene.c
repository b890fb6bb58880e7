/*
 * Arbitrary text into the scene reader, and what it lets pass into all that prepares itself from a scene.
 *
 * Input: the text; behind a NUL an assignment as of --set, behind another one a second one.
 */
#include <math.h>
#include <string.h>

#include "fuzz/fuzz.h"
#include "hal/socketcan/can.h"
#include "hal/socketcan/ring.h"
#include "mctau/controller.h"
#include "mctau/plant.h"
#include "mctau/scene.h"
#include "mctau/supervisor.h"

static void check_message(const mct_message *why)
{
    const size_t length = strnlen(why->text, sizeof why->text);
    FUZZ_RULE(length > 0, "a refusal says why");
    FUZZ_RULE(length < sizeof why->text, "a message ends");
    for (size_t i = 0; i < length; i++) {
        FUZZ_RULE((unsigned char)why->text[i] >= ' ' && why->text[i] != 0x7F,
                  "a message is one line of text");
    }
}

/* A scene that was read can be prepared, or is refused with a reason. */
static void prepare(const mct_scene *scene)
{
    static mct_plant plant;
    static mct_can can;
    static mct_can_ring ring;
    static mct_controller controller;
    static mct_constants constants;
    mct_supervisor supervisor;
    mct_message why = {""};
    FUZZ_RULE(mct_scene_check(scene, &why) == MCT_OK, "a scene that was read passes the check: %s", why.text);
    mct_message_clear(&why);
    if (mct_plant_init(&plant, scene, &why) == MCT_OK && scene->substeps <= 100) {
        mct_plant_step(&plant, 1);
        for (int i = 0; i < plant.states; i++) {
            FUZZ_RULE(isfinite(mct_plant_value(&plant, i)), "a plant's state stays finite");
        }
    }
    mct_message_clear(&why);
    mct_can_ring_init(&ring);
    if (mct_can_init(&can, scene, mct_can_ring_end(&ring, 0), true, &why) != MCT_OK) {
        check_message(&why);
    } else {
        FUZZ_RULE(can.axes.count >= 1 && can.axes.count <= MCT_CAN_MAX_AXES, "there is a drive");
        FUZZ_RULE(can.report.load > 0 && can.report.load <= scene->can_highest_load,
                  "the bus can bear the load: %g", can.report.load);
    }
    mct_message_clear(&why);
    if (scene->controller != MCT_CONTROLLER_NONE) {
        if (mct_controller_init(&controller, &constants, scene, &why) != MCT_OK) {
            check_message(&why);
        } else {
            const mct_reading reading = {{100, -100}, 0, 0};
            mct_controller_update(&controller, &reading, 0);
            FUZZ_RULE(controller.limit >= 0, "a controller has a limit: %g", (double)controller.limit);
        }
    }
    mct_supervisor_init(&supervisor, scene);
    FUZZ_RULE(supervisor.limit >= 0 && supervisor.stale_us >= 5000, "limits of the supervisor make sense");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    mct_override overrides[2];
    char assignments[2][256];
    int count = 0;
    const uint8_t *end = size > 0 ? memchr(data, 0, size) : NULL;
    const size_t length = end != NULL ? (size_t)(end - data) : size;
    for (; end != NULL && count < 2; count++) {
        const uint8_t *begin = end + 1;
        const size_t left = size - (size_t)(begin - data);
        end = left > 0 ? memchr(begin, 0, left) : NULL;
        const size_t whole = end != NULL ? (size_t)(end - begin) : left;
        const size_t kept = whole < sizeof assignments[0] ? whole : sizeof assignments[0] - 1;
        memcpy(assignments[count], begin, kept);
        assignments[count][kept] = '\0';
        overrides[count] = (mct_override){assignments[count], "--set"};
    }
    static mct_scene scene, again;
    mct_message why;
    memset(&scene, 0x5A, sizeof scene);
    memset(&again, 0x5A, sizeof again);
    const mct_status status =
        mct_scene_read((const char *)data, length, "fuzz.toml", overrides, count, &scene, &why);
    if (status != MCT_OK) {
        FUZZ_RULE(memcmp(&scene, &again, sizeof scene) == 0, "a scene that is refused is not written");
        check_message(&why);
        return 0;
    }
    FUZZ_RULE(why.text[0] == '\0', "a message is cleared on success");
    FUZZ_RULE(mct_scene_read((const char *)data, length, "fuzz.toml", overrides, count, &again, NULL) ==
                  MCT_OK,
              "what was read once is read again");
    FUZZ_RULE(memcmp(&scene, &again, sizeof scene) == 0, "the same text is the same scene");
    prepare(&scene);
    return 0;
}

/* Texts that use every part of the syntax; then each key with its default, by the descriptors. */
size_t fuzz_seed(int number, uint8_t *out)
{
    static const char wheel[] =
        "# a comment\n"
        "[scene]\nsystem = \"reaction_wheel\"\nstepper = \"expo\"\ndt = 0.001\nduration = 30.0\n"
        "[effects]\nmotor = \"inductive\"\nviscous = true\ncoulomb = false\nsaturation = true\n"
        "[initial]\narm_angle = 3.141592653589793\n[controller]\nkind = \"swing_up_balance\"\n"
        "[sensors]\narm_counts_per_turn = 4096\nwheel_counts_per_turn = 4096\n";
    static const char cart[] =
        "scene.system = 'cart_pole'\r\nscene.hal = \"ring\"\r\n"
        "[can]\nprotocol = \"odrive\"\nmode = \"torque\"\nnode = 0x3\nfirmware = \"0.5\"\n"
        "[controller]\nkind = \"swing_up_balance\"\n[variation]\nspread = 0.1\nseed = 1_000\n";
    static const char input[] =
        "[scene]\nsystem = \"cart_pole\"\n[input]\nkind = \"steps\"\ntimes = [0, 1e-1, # why\n 2.5,]\n"
        "values = [ +1, -2.5E+0, 0 ]\n[telemetry]\nlog = \"a\\tb\\u00e9.lcm\"";
    static const char set[] = "[scene]\nsystem = \"reaction_wheel\"\n\0can.watchdog=0.25\0scene.dt=0.002";
    const struct {
        const char *text;
        size_t size;
    } texts[] = {
        {wheel, sizeof wheel - 1}, {cart, sizeof cart - 1}, {input, sizeof input - 1}, {set, sizeof set - 1}};
    const int count = (int)(sizeof texts / sizeof texts[0]);
    if (number < count) {
        memcpy(out, texts[number].text, texts[number].size);
        return texts[number].size;
    }
    const int table = (number - count) / 2;
    if (table >= MCT_SCENE_TABLE_COUNT) {
        return 0;
    }
    size_t size =
        (size_t)snprintf((char *)out, FUZZ_LONGEST, "scene.system=\"%s\"\n", mct_systems[number % 2]->name);
    for (int i = 0; i < mct_scene_tables[table].field_count; i++) {
        const char *name = mct_scene_tables[table].fields[i].name;
        if (strcmp(name, "system") != 0) {
            size += (size_t)snprintf((char *)out + size, FUZZ_LONGEST - size, "%s.%s = %d\n",
                                     mct_scene_tables[table].name, name, i % 3);
        }
    }
    return size;
}

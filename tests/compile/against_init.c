/*
 * Compiled structs against those of init, for the scene whose text is on stdin: byte for byte but for pointers and padding,
 * then the records of both over some ticks. Overrides are the arguments. Says what differs.
 */
#include <stdio.h>
#include <string.h>

#include "hal/compiled.h"

#pragma weak mct_compiled_can /* a scene may have none */

enum { TICKS = 3000, LONGEST_TEXT = 1 << 16, MOST_OVERRIDES = 16 };

static mct_scene scene;
static mct_plan plan;
static mct_loop made_loop, compiled_loop;
static mct_sim made_sim, compiled_sim;
static mct_can made_can;
static bool has_can;

static int fail(const char *what, const char *why)
{
    printf("%s: %s\n", what, why);
    return 1;
}

static int read_scene(int count, char **assignments)
{
    static char text[LONGEST_TEXT];
    mct_override overrides[MOST_OVERRIDES];
    mct_message why;
    const size_t length = fread(text, 1, sizeof text, stdin);
    for (int i = 0; i < count && i < MOST_OVERRIDES; i++) {
        overrides[i] = (mct_override){assignments[i], "argument"};
    }
    if (mct_scene_read(text, length, "stdin", overrides, count, &scene, &why) != MCT_OK) {
        return fail("scene", why.text);
    }
    if (mct_sim_init(&made_sim, &scene, &why) != MCT_OK ||
        mct_loop_init(&made_loop, &plan, &scene, (mct_hal){NULL, NULL}, NULL, (mct_samples){NULL, 0}, &why) !=
            MCT_OK) {
        return fail("init", why.text);
    }
    has_can = mct_can_init(&made_can, &scene, (mct_can_transport){NULL, NULL}, false, &why) == MCT_OK;
    return 0;
}

/* What its open makes anew is left out, and pointers but for the protocol. */
static void forget_for_can(mct_can *can)
{
    memset(&can->report, 0, sizeof can->report);
    can->scene = NULL;
    for (int i = 0; i < can->axes.count; i++) {
        can->axes.axes[i].scene = NULL;
    }
}

static int compare_can(void)
{
    static mct_can cans[2];
    if (has_can != (&mct_compiled_can != NULL)) {
        return fail("mct_compiled_can", has_can ? "is not there" : "is there");
    }
    if (!has_can) {
        return 0;
    }
    memcpy(&cans[0], &made_can, sizeof made_can);
    memcpy(&cans[1], &mct_compiled_can, sizeof made_can);
    forget_for_can(&cans[0]);
    forget_for_can(&cans[1]);
    return memcmp(&cans[0], &cans[1], sizeof cans[0]) == 0
               ? 0
               : fail("mct_compiled_can", "differs from mct_can_init");
}

/* What a tick reads by way of them is compared by running. */
static void forget_pointers(mct_loop *loop, mct_sim *sim)
{
    loop->plan = NULL;
    loop->controller.system = NULL;
    loop->controller.constants = NULL;
    loop->controller.swing_up = NULL;
    loop->controller.observer.system = NULL;
    loop->controller.observer.constants = NULL;
    loop->supervisor.system = NULL;
    sim->plant.system = NULL;
    sim->plant.kernel = NULL;
    sim->plant.limit = NULL;
    sim->plant.advance = NULL;
}

static int compare_structs(void)
{
    static mct_loop loops[2];
    static mct_sim sims[2];
    memcpy(&loops[0], &made_loop, sizeof made_loop);
    memcpy(&loops[1], &mct_compiled_loop, sizeof made_loop);
    memcpy(&sims[0], &made_sim, sizeof made_sim);
    memcpy(&sims[1], &mct_compiled_sim, sizeof made_sim);
    for (int i = 0; i < 2; i++) {
        forget_pointers(&loops[i], &sims[i]);
    }
    if (memcmp(&loops[0], &loops[1], sizeof loops[0]) != 0) {
        return fail("mct_compiled_loop", "differs from mct_loop_init");
    }
    if (memcmp(&sims[0], &sims[1], sizeof sims[0]) != 0) {
        return fail("mct_compiled_sim", "differs from mct_sim_init");
    }
    if (memcmp(&plan, mct_compiled_loop.plan, sizeof plan) != 0) {
        return fail("plan", "differs from mct_loop_init");
    }
    return memcmp(&scene, &mct_compiled_scene.scene, sizeof scene) == 0
               ? 0
               : fail("scene", "differs from the reader's");
}

static int compare_runs(void)
{
    compiled_loop = mct_compiled_loop;
    compiled_sim = mct_compiled_sim;
    compiled_loop.hal = mct_sim_hal(&compiled_sim);
    made_loop.hal = mct_sim_hal(&made_sim);
    for (int i = 0; i < TICKS; i++) {
        mct_loop_tick(&compiled_loop);
        mct_loop_tick(&made_loop);
        if (memcmp(&compiled_loop.record, &made_loop.record, sizeof made_loop.record) != 0) {
            return fail("record", "differs");
        }
    }
    return made_sim.plant.tick == TICKS ? 0 : fail("plant", "has not moved");
}

int main(int argc, char **argv)
{
    int failed = read_scene(argc - 1, argv + 1);
    failed = failed ? failed : compare_structs();
    failed = failed ? failed : compare_can();
    return failed ? failed : compare_runs();
}

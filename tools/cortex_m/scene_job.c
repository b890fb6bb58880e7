/*
 * scene_job SCENE FILE TICKS [TABLE.KEY=VALUE]...: reads a scene and writes it as a job for count.c, with
 * the inputs of its run: those of the closed loop, in simulation, or of [input]. Prints the system's name.
 * Exit codes as of mctau: 2 the scene is wrong, 3 a file cannot be read or written.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/sim/sim.h"
#include "job.h"
#include "mctau/input.h"
#include "mctau/loop.h"

enum { MOST_OVERRIDES = 64, LARGEST_SCENE = 1 << 20, EXIT_USAGE = 2, EXIT_IO = 3 };

static int say(int exit_code, const char *what, const char *why)
{
    fprintf(stderr, "%s%s%s\n", what, what[0] != '\0' ? ": " : "", why);
    return exit_code;
}

static int read_scene(const char *path, char **assignments, int count, mct_scene *scene)
{
    static char text[LARGEST_SCENE];
    mct_override overrides[MOST_OVERRIDES];
    mct_message why;
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        return say(EXIT_IO, path, "the scene cannot be read");
    }
    const size_t length = fread(text, 1, sizeof text, file);
    fclose(file);
    for (int i = 0; i < count; i++) {
        overrides[i] = (mct_override){assignments[i], "--set"};
    }
    if (mct_scene_read(text, length, path, overrides, count, scene, &why) != MCT_OK) {
        return say(EXIT_USAGE, "", why.text);
    }
    if (scene->controller == MCT_CONTROLLER_NONE && scene->input == MCT_INPUT_CSV) {
        return say(EXIT_USAGE, path, "input.kind: found csv; allowed here none, constant, sine, steps");
    }
    return 0;
}

static int closed_loop_inputs(const mct_scene *scene, job *self)
{
    static mct_sim sim;
    static mct_loop loop;
    static mct_plan plan;
    mct_message why;
    mct_scene simulated = *scene;
    simulated.realtime = 0;
    if (mct_sim_init(&sim, &simulated, &why) != MCT_OK ||
        mct_loop_init(&loop, &plan, &simulated, mct_sim_hal(&sim), NULL, (mct_samples){NULL, 0}, &why) !=
            MCT_OK ||
        loop.hal.ops->open(loop.hal.context, &why) != MCT_OK) {
        return say(EXIT_USAGE, "", why.text);
    }
    for (int i = 0; i < self->ticks; i++) {
        mct_loop_tick(&loop);
        self->inputs[i] = (double)loop.record.applied;
    }
    loop.hal.ops->close(loop.hal.context);
    return 0;
}

static int fill_inputs(const mct_scene *scene, job *self)
{
    mct_input input;
    if (scene->controller != MCT_CONTROLLER_NONE) {
        return closed_loop_inputs(scene, self);
    }
    mct_input_init(&input, scene, (mct_samples){NULL, 0});
    for (int i = 0; i < self->ticks; i++) {
        self->inputs[i] = (double)mct_input_at(&input, (uint64_t)i);
    }
    return 0;
}

/* Those that suit the scene at one step a tick, whichever it names. */
static void find_suited(job *self)
{
    mct_scene scene = self->scene;
    for (scene.stepper = 0; scene.stepper < MCT_STEPPER_COUNT; scene.stepper++) {
        self->suited[scene.stepper] = mct_scene_check(&scene, NULL) == MCT_OK;
    }
}

static int write_job(const char *path, const job *self)
{
    FILE *file = fopen(path, "wb");
    const bool written = file != NULL && fwrite(self, sizeof *self, 1, file) == 1;
    return file != NULL && fclose(file) == 0 && written ? 0 : say(EXIT_IO, path, "cannot be written");
}

int main(int count, char **arguments)
{
    static job self;
    mct_scene scene;
    if (count < 4 || count - 4 > MOST_OVERRIDES) {
        return say(EXIT_USAGE, "usage", "scene_job SCENE FILE TICKS [TABLE.KEY=VALUE]...");
    }
    int exit_code = read_scene(arguments[1], arguments + 4, count - 4, &scene);
    if (exit_code != 0) {
        return exit_code;
    }
    const double ticks = scene.duration / scene.dt + 0.5;
    self.size = sizeof self;
    self.ticks = atoi(arguments[3]);
    self.ticks = ticks < self.ticks ? (int32_t)ticks : self.ticks;
    if (self.ticks < 1 || self.ticks > JOB_TICKS) {
        return say(EXIT_USAGE, arguments[1], "found no tick to count; allowed 1 to 10000");
    }
    exit_code = fill_inputs(&scene, &self);
    if (exit_code == 0) {
        mct_scene_vary(&scene, &self.scene);
        self.scene.substeps = 1;
        find_suited(&self);
        exit_code = write_job(arguments[2], &self);
    }
    if (exit_code == 0) {
        puts(mct_systems[scene.system]->name);
    }
    return exit_code;
}

/* mctau: one command, a verb for each job. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "mctau/config.h"
#include "say.h"
#include "scene_file.h"
#include "verbs.h"

/* A new verb is a file and a row here. */
static const verb *const verbs[] = {&verb_run,   &verb_mct,     &verb_list,  &verb_replay,
                                    &verb_drive, &verb_cost,    &verb_pick,  &verb_advise,
                                    &verb_hard,  &verb_compile, &verb_import};
enum { VERBS = sizeof verbs / sizeof verbs[0] };

static void print_overview(FILE *file)
{
    fputs("usage: mctau VERB [options]\n\n"
          "Small mechanisms in closed form, M(q) a + C(q,v) v = tau, simulated and controlled at a fixed "
          "step.\n\n"
          "Verbs\n",
          file);
    for (int i = 0; i < VERBS; i++) {
        fprintf(file, "  %-10s %s\n", verbs[i]->name, verbs[i]->doc);
    }
    fputs("\n  mctau VERB --help tells what a verb does, its options, examples and exit codes\n"
          "  mctau --version\n\n"
          "Begin with\n"
          "  mctau run scenes/reaction_wheel.toml\n",
          file);
}

/* What was printed is of no use when it did not arrive. A reader that has seen enough (head) is no error. */
static int finish(int exit_code)
{
    errno = 0;
    const bool lost = fflush(stdout) != 0 || ferror(stdout);
    if (lost && errno != EPIPE) {
        return say(EXIT_IO, "the result could not be printed: %s",
                   errno != 0 ? strerror(errno) : "write error");
    }
    return exit_code;
}

static int run_verb(const verb *chosen, const char *program, int argc, char **argv)
{
    arguments given;
    int exit_code;
    if (arguments_read(&given, chosen, argc, argv, &exit_code)) {
        given.program = program;
        exit_code = chosen->run(&given);
    }
    arguments_free(&given);
    return finish(exit_code);
}

int main(int argc, char **argv)
{
    const char *first = argc > 1 ? argv[1] : "";
    for (int i = 0; i < VERBS; i++) {
        if (strcmp(first, verbs[i]->name) == 0) {
            return run_verb(verbs[i], argv[0], argc - 1, argv + 1);
        }
    }
    if (strcmp(first, "--help") == 0 || strcmp(first, "-h") == 0 || strcmp(first, "help") == 0) {
        print_overview(stdout);
        return finish(EXIT_WELL);
    }
    if (strcmp(first, "--version") == 0) {
        printf("mctau %s (%s)\n", MCT_VERSION, runner_names());
        return finish(EXIT_WELL);
    }
    if (argc > 1) {
        say(EXIT_USAGE, "%s: no such verb", first);
    }
    print_overview(stderr);
    return EXIT_USAGE;
}

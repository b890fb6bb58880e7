/*
 * Arbitrary bytes as an event log for `mctau replay`.
 *
 * Input: the log.
 */
#include <string.h>

#include "fuzz/command.h"
#include "fuzz/fuzz.h"

static int replay(void)
{
    char words[][16] = {"mctau", "replay", "fuzz.lcm"};
    char *argv[] = {words[0], words[1], words[2], NULL};
    return fuzz_command(3, argv);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char begin[] = "mctau: fuzz.lcm:";
    fuzz_command_begin();
    fuzz_command_put("fuzz.lcm", data, size);
    const int exit_code = replay();
    const char *said = fuzz_command_said();
    FUZZ_RULE(exit_code >= 0 && exit_code <= 3, "an exit code that is documented: %d", exit_code);
    FUZZ_RULE((exit_code >= 2) == (said[0] != '\0'),
              "a log that is not replayed to its end has a reason: %d, %s", exit_code, said);
    if (exit_code >= 2) {
        FUZZ_RULE(strncmp(said, begin, sizeof begin - 1) == 0, "the reason names the log: %s", said);
        FUZZ_RULE(strchr(said, '\n') == said + strlen(said) - 1, "the reason is one line: %s", said);
    }
    return 0;
}

/* Logs of each scene: whole, cut within an event, and one behind the other. */
size_t fuzz_seed(int number, uint8_t *out)
{
    enum { KINDS = 3, SCENES = 3 };
    const int scene = number / KINDS;
    if (scene >= SCENES) {
        return 0;
    }
    fuzz_command_begin();
    const char *name = fuzz_command_file(scene);
    const size_t size = fuzz_command_record(name, "0.003", out, FUZZ_LONGEST);
    switch (number % KINDS) {
    case 0:
        return size;
    case 1:
        return size - size / 8;
    default:
        return size + fuzz_command_record(name, "0.002", out + size, FUZZ_LONGEST - size);
    }
}

/* mctau replay: runs what a log recorded again, and compares. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "json.h"
#include "say.h"
#include "scene_file.h"
#include "verbs.h"

static const option options[] = {
    OPTION_JSON,
    {NULL, NULL, NULL, NULL},
};

static int run_verb(const arguments *given);

const verb verb_replay = {
    .name = "replay",
    .doc = "runs a log's recorded inputs again and proves the same bits, tick for tick",
    .operand = "LOG",
    .text = "Reads an event log that mctau run --log wrote, runs what it recorded again in the same "
            "precision, and compares\n"
            "every tick bit for bit. Names the first tick and field that differ.",
    .options = options,
    .examples = "  mctau run scenes/cart_pole.toml --log run.lcm\n"
                "  mctau replay run.lcm\n",
    .exit_codes = "  0  equal, every bit of every tick\n"
                  "  1  different\n"
                  "  2  the log is not one of mctau's, or is damaged\n"
                  "  3  the log could not be read, or was cut; what it holds is equal\n",
    .run = run_verb,
};

static void print_json(const char *log, const replay_result *result)
{
    json out = json_begin(stdout, "mctau.replay/1");
    json_text(&out, "log", log);
    json_boolean(&out, "equal", result->equal);
    json_count(&out, "ticks", result->ticks);
    json_boolean(&out, "truncated", result->truncated);
    if (!result->equal) {
        json_count(&out, "first_tick", result->first_tick);
        json_text(&out, "field", result->field);
        json_number(&out, "recorded", result->recorded);
        json_number(&out, "replayed", result->replayed);
        json_hex(&out, "recorded_hex", result->recorded);
        json_hex(&out, "replayed_hex", result->replayed);
    }
    json_finish(&out);
}

static void print_text(const char *log, const replay_result *result)
{
    if (result->equal) {
        printf("%s: equal: %" PRIu64 " ticks, the same bits in every field\n", log, result->ticks);
    } else {
        printf("%s: different from tick %" PRIu64 " on, field %s:\n", log, result->first_tick, result->field);
        printf("  recorded %24.17g  %a\n  replayed %24.17g  %a\n", result->recorded, result->recorded,
               result->replayed, result->replayed);
    }
}

/* The log knows its precision: the runner that has another one says so, and the next is asked. */
static mct_status replay(const char *log, replay_result *result, mct_message *why)
{
    static const int precisions[] = {MCT_PRECISION_DOUBLE, MCT_PRECISION_FLOAT};
    mct_status status = MCT_ERROR_UNSUITED;
    for (int i = 0; i < 2 && status == MCT_ERROR_UNSUITED; i++) {
        const mct_runner *runner = find_runner(precisions[i]);
        status = runner != NULL ? runner->replay(log, result, why) : status;
    }
    return status;
}

static int run_verb(const arguments *given)
{
    replay_result result;
    mct_message why;
    const mct_status status = replay(given->operand, &result, &why);
    if (status != MCT_OK) {
        return say_status(status, &why);
    }
    if (arguments_value(given, "json") != NULL) {
        print_json(given->operand, &result);
    } else {
        print_text(given->operand, &result);
    }
    if (!result.equal) {
        return EXIT_CHECK_FAILED;
    }
    if (result.truncated) {
        return say(EXIT_IO,
                   "%s: the log was cut: found no end; all %" PRIu64 " ticks that it holds are equal",
                   given->operand, result.ticks);
    }
    return EXIT_WELL;
}

#include "runner_import.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "hal/records.h"
#include "say.h"

#if MCTAU_HAVE_LCM
#include "hal/lcm/telemetry.h"

static mct_status complain(mct_status status, const char *path, const char *what, mct_message *why)
{
    mct_message_clear(why);
    mct_message_add(why, path);
    mct_message_add(why, ": ");
    mct_message_add(why, what);
    return status;
}

static mct_status read_head(FILE *file, const char *path, mct_message *why)
{
    const mct_records_head here = mct_records_head_here();
    mct_records_head head;
    if (fread(&head, 1, sizeof head, file) != sizeof head ||
        memcmp(head.magic, here.magic, sizeof head.magic) != 0) {
        return complain(ferror(file) ? MCT_ERROR_IO : MCT_ERROR_SYNTAX, path,
                        "found no head of records; allowed what an image has written", why);
    }
    if (head.real_size != here.real_size) {
        return complain(MCT_ERROR_UNSUITED, path,
                        head.real_size == sizeof(float)
                            ? "found records in float; allowed with --precision float"
                            : "found records in double; allowed with --precision double",
                        why);
    }
    return head.record_size == here.record_size
               ? MCT_OK
               : complain(MCT_ERROR_SYNTAX, path, "found records of another version of mctau", why);
}

static void wait_for_room(const mct_ring *ring)
{
    const struct timespec pause = {.tv_nsec = 100000};
    while (mct_ring_is_full(ring)) { /* its reader ends what it has begun: a log that fails is counted */
        nanosleep(&pause, NULL);
    }
}

static mct_status copy_records(FILE *file, const char *path, mct_ring *ring, import_result *result,
                               mct_message *why)
{
    mct_record record;
    size_t length;
    while ((length = fread(&record, 1, sizeof record, file)) == sizeof record) {
        if (record.tick != result->ticks) {
            mct_message_clear(why);
            mct_message_add(why, path);
            mct_message_add(why, ": found tick ");
            mct_message_add_integer(why, (long long)record.tick);
            mct_message_add(why, " where ");
            mct_message_add_integer(why, (long long)result->ticks);
            mct_message_add(why, " belongs");
            return MCT_ERROR_SYNTAX;
        }
        wait_for_room(ring);
        mct_ring_push(ring, &record);
        result->ticks++;
    }
    result->left_over = length;
    return ferror(file) ? complain(MCT_ERROR_IO, path, strerror(errno), why) : MCT_OK;
}

mct_status runner_import(const mct_scene *scene, const char *records, const run_options *options,
                         import_result *result, mct_message *why)
{
    memset(result, 0, sizeof *result);
    mct_message_clear(why);
    FILE *file = fopen(records, "rb");
    if (file == NULL) {
        return complain(MCT_ERROR_IO, records, strerror(errno), why);
    }
    mct_ring *ring = need_memory(calloc(1, sizeof *ring));
    mct_telemetry *telemetry = need_memory(calloc(1, sizeof *telemetry));
    const mct_telemetry_targets targets = {.log = options->log, .scene_text = options->scene_text};
    mct_status status = read_head(file, records, why);
    if (status == MCT_OK) {
        status = mct_telemetry_start(telemetry, ring, scene, &targets, why);
        if (status == MCT_OK) {
            status = copy_records(file, records, ring, result, why);
            mct_telemetry_stop(telemetry);
            if (status != MCT_OK) {
                (void)unlink(options->log);
            } else if (telemetry->counts.log_errors > 0 || telemetry->counts.first_log_errno != 0) {
                status =
                    complain(MCT_ERROR_IO, options->log, strerror(telemetry->counts.first_log_errno), why);
            }
        }
    }
    fclose(file);
    free(ring);
    free(telemetry);
    return status;
}

#else

mct_status runner_import(const mct_scene *scene, const char *records, const run_options *options,
                         import_result *result, mct_message *why)
{
    (void)scene;
    (void)records;
    (void)options;
    memset(result, 0, sizeof *result);
    mct_message_clear(why);
    mct_message_add(why, "import: this build has no LCM, so there are no logs");
    return MCT_ERROR_IO;
}

#endif

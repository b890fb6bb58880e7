/*
 * The twin: a compiled scene's loop with its mechanism in simulation, as fast as it goes.
 *
 * Command line: the image's name, a file for the records, or "-", then the number of ticks instead of the scene's.
 */
#include "hal/compiled.h"
#include "hal/records.h"
#include "image.h"

int main(void)
{
    static mct_loop loop;
    static mct_sim sim;
    char path[IMAGE_WORD];
    image_counts counts = {0};
    uint64_t hash = 0;
    if (!image_begin()) {
        return image_fail("the emulator's timer does not count instructions");
    }
    const uint64_t ticks = image_number(2, mct_compiled_ticks);
    const bool records = image_word(1, path) && path[0] != '-';
    const mct_records_head head = mct_records_head_here();
    const int32_t file = records ? mct_semihosting_open(path, true) : -1;
    bool written = !records || (file != -1 && mct_semihosting_append(file, &head, sizeof head));
    loop = mct_compiled_loop;
    sim = mct_compiled_sim;
    loop.hal = mct_sim_hal(&sim);
    (void)loop.hal.ops->open(loop.hal.context, NULL);
    for (uint64_t i = 0; i < ticks && written; i++) {
        image_tick(&loop, &counts);
        hash = image_hash(hash, &loop.record, sizeof loop.record);
        written = !records || mct_semihosting_append(file, &loop.record, sizeof loop.record);
    }
    loop.hal.ops->close(loop.hal.context);
    if (!written || (records && !mct_semihosting_close(file))) {
        return image_fail("the records could not be written");
    }
    image_report(&loop, &counts, hash);
    return 0;
}

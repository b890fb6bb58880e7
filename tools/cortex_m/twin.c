/*
 * The twin: a compiled scene's loop with its mechanism in simulation, as fast as it goes.
 *
 * Command line: the image's name, a file for the records, or "-", then the number of ticks instead of the scene's.
 */
#include "hal/compiled.h"
#include "image.h"

int main(void)
{
    static mct_loop loop;
    static mct_sim sim;
    image_counts counts = {0};
    image_records records;
    if (!image_begin()) {
        return image_fail("the emulator's timer does not count instructions");
    }
    const uint64_t ticks = image_number(2, mct_compiled_ticks);
    image_records_open(&records, 1);
    loop = mct_compiled_loop;
    sim = mct_compiled_sim;
    loop.hal = mct_sim_hal(&sim);
    (void)loop.hal.ops->open(loop.hal.context, NULL);
    for (uint64_t i = 0; i < ticks && records.is_well; i++) {
        image_tick(&loop, &counts);
        image_records_add(&records, &loop.record);
    }
    loop.hal.ops->close(loop.hal.context);
    if (!image_records_close(&records)) {
        return image_fail("the records could not be written");
    }
    image_report(&loop, &counts, records.hash);
    return 0;
}

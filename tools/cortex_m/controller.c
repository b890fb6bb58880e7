/*
 * The controller alone: a compiled scene's loop, fed with the readings of recorded ticks, which it has to answer with the
 * same records. What runs on a robot, where a board's HAL stands in the place of this one.
 *
 * Command line: the image's name, the file of the records.
 */
#include <string.h>

#include "hal/compiled.h"
#include "hal/records.h"
#include "image.h"

/* --- a HAL of recorded ticks --- */

static mct_status nothing_to_open(void *context, mct_message *why)
{
    (void)context;
    (void)why;
    return MCT_OK;
}

static mct_status read_recorded(void *context, mct_reading *reading)
{
    const mct_record *recorded = context;
    *reading = recorded->reading;
    return MCT_OK;
}

static mct_status write_nowhere(void *context, mct_real input)
{
    (void)context;
    (void)input;
    return MCT_OK;
}

static mct_status no_wait(void *context)
{
    (void)context;
    return MCT_OK;
}

static void nothing(void *context)
{
    (void)context;
}

static const mct_state *no_plant(void *context)
{
    (void)context;
    return NULL;
}

static const mct_timing *no_timing(void *context)
{
    static const mct_timing none = {0};
    (void)context;
    return &none;
}

static mct_counters no_counters(void *context)
{
    (void)context;
    return (mct_counters){0};
}

static const mct_hal_ops recorded_hal = {
    .name = "recorded",
    .open = nothing_to_open,
    .read = read_recorded,
    .write = write_nowhere,
    .wait_tick = no_wait,
    .stop = nothing,
    .arm = nothing,
    .close = nothing,
    .plant = no_plant,
    .timing = no_timing,
    .counters = no_counters,
};

/* --- the run --- */

int main(void)
{
    static mct_loop loop;
    static mct_record recorded;
    static mct_records_head head;
    char path[IMAGE_WORD];
    image_counts counts = {0};
    image_records nowhere = {.is_well = true, .file = -1}; /* only hashed */
    const mct_records_head here = mct_records_head_here();
    if (!image_begin()) {
        return image_fail("the emulator's timer does not count instructions");
    }
    const int32_t file = image_word(1, path) ? mct_semihosting_open(path, false) : -1;
    if (file == -1 || mct_semihosting_read(file, &head, sizeof head) != (int32_t)sizeof head ||
        memcmp(&head, &here, sizeof head) != 0) {
        return image_fail("there are no records of this precision");
    }
    loop = mct_compiled_loop;
    loop.hal = (mct_hal){&recorded_hal, &recorded};
    uint64_t differing = 0, first = 0;
    while (mct_semihosting_read(file, &recorded, sizeof recorded) == (int32_t)sizeof recorded) {
        memset(&recorded.plant, 0, sizeof recorded.plant); /* nobody knows it on a robot */
        image_tick(&loop, &counts);
        image_records_add(&nowhere, &loop.record);
        if (memcmp(&loop.record, &recorded, sizeof recorded) != 0 && differing++ == 0) {
            first = recorded.tick;
        }
    }
    (void)mct_semihosting_close(file);
    image_report(&loop, &counts, nowhere.hash);
    const uint64_t differences[] = {differing, first};
    image_print("differing", differences, 2);
    return differing == 0 ? 0 : 1;
}

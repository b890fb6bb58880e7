/*
 * The controller of a scene on a board of yours. Beside it stands the scene, as mctau compile writes it:
 *
 *     mctau compile scenes/cart_pole.toml --precision float -o scene.c
 */
#include <stdbool.h>
#include <stdint.h>

#include "hal/compiled.h"

/* What the board has to provide. */
int32_t board_encoder(int number); /* counter of a coordinate's encoder; it may wrap */
void board_motor(float volts);     /* held until the next call */
void board_wait_for_tick(void);    /* until the next millisecond begins */
bool board_runs(void);             /* false: zero volts, and an end */

typedef struct {
    bool is_stopped; /* zero volts, whatever is written, until it is armed */
} board;

static mct_status open_board(void *context, mct_message *why)
{
    (void)context;
    (void)why;
    board_motor(0);
    return MCT_OK;
}

static mct_status read_board(void *context, mct_reading *reading)
{
    (void)context;
    for (int i = 0; i < MCT_MAX_ENCODERS; i++) {
        reading->counts[i] = board_encoder(i);
    }
    reading->age_us = 0; /* older counts are derated, then cut */
    reading->flags = 0;  /* MCT_READING_...: what is wrong with them */
    return MCT_OK;
}

static mct_status write_board(void *context, mct_real volts)
{
    const board *self = context;
    board_motor(self->is_stopped ? 0 : (float)volts);
    return MCT_OK;
}

static mct_status wait_for_tick(void *context)
{
    (void)context;
    board_wait_for_tick();
    return MCT_OK;
}

static void stop_board(void *context)
{
    board *self = context;
    self->is_stopped = true;
    board_motor(0);
}

static void arm_board(void *context)
{
    board *self = context;
    self->is_stopped = false;
}

static const mct_state *no_plant(void *context)
{
    (void)context;
    return NULL; /* nobody knows the true state */
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

static const mct_hal_ops board_hal = {
    .name = "board",
    .open = open_board,
    .read = read_board,
    .write = write_board,
    .wait_tick = wait_for_tick,
    .stop = stop_board,
    .arm = arm_board,
    .close = stop_board,
    .plant = no_plant,
    .timing = no_timing,
    .counters = no_counters,
};

int main(void)
{
    static mct_loop loop;
    static board hardware;
    loop = mct_compiled_loop;
    loop.hal = (mct_hal){&board_hal, &hardware};
    loop.hal.ops->open(loop.hal.context, NULL);
    while (board_runs()) {
        mct_loop_tick(&loop); /* swings up, catches, balances; on any doubt zero volts */
    }
    loop.hal.ops->close(loop.hal.context);
    return loop.record.faults == 0 ? 0 : 1;
}

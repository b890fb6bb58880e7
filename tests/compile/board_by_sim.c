/* The board of docs/examples/firmware.c, for this machine: the compiled scene's own mechanism. */
#include <stdbool.h>
#include <stdio.h>

#include "hal/compiled.h"

static mct_sim sim;
static uint64_t ticks;

int32_t board_encoder(int number);
void board_motor(float volts);
void board_wait_for_tick(void);
bool board_runs(void);

int32_t board_encoder(int number)
{
    const mct_hal hal = mct_sim_hal(&sim);
    static mct_reading reading;
    if (number == 0) {
        (void)hal.ops->read(hal.context, &reading);
    }
    return reading.counts[number];
}

void board_motor(float volts)
{
    sim.input = (mct_real)volts;
}

void board_wait_for_tick(void)
{
    mct_plant_step(&sim.plant, sim.input);
    ticks++;
}

bool board_runs(void)
{
    if (ticks == 0) {
        sim = mct_compiled_sim;
    }
    if (ticks == mct_compiled_ticks) {
        for (int i = 0; i < sim.plant.states; i++) {
            printf("%a\n", mct_plant_value(&sim.plant, i));
        }
    }
    return ticks < mct_compiled_ticks;
}

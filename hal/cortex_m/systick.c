#include "systick.h"

#include <string.h>

#include "hal/clock.h"
#include "processor.h"

#define SYST_CSR (*(volatile uint32_t *)0xE000E010) /* SysTick's control and status, */
#define SYST_RVR (*(volatile uint32_t *)0xE000E014) /* reload value, */
#define SYST_CVR (*(volatile uint32_t *)0xE000E018) /* current value, which counts down */
#define ICSR     (*(volatile uint32_t *)0xE000ED04)

enum { ENABLE = 1 << 0, TICKINT = 1 << 1, CLKSOURCE_CORE = 1 << 2, PENDSTSET = 1 << 26 };
enum { LEAST_CYCLES = 1000, MOST_CYCLES = 1 << 24 };

static uint32_t core_mhz;
static uint32_t period; /* [cycles] */
static uint64_t ticks;  /* whole periods; written by the interrupt alone */
static int64_t newest;  /* cycles as last told */

void SysTick_Handler(void);
void SysTick_Handler(void)
{
    ticks++;
}

mct_status mct_systick_start(uint32_t mhz, double tick)
{
    const double cycles = tick * 1e6 * mhz + 0.5;
    if (mhz < 1 || mhz > 1000 || !(cycles >= LEAST_CYCLES && cycles < MOST_CYCLES + 1.0)) {
        return MCT_ERROR_RANGE;
    }
    core_mhz = mhz;
    period = (uint32_t)cycles;
    SYST_RVR = period - 1;
    SYST_CVR = 0;
    SYST_CSR = ENABLE | TICKINT | CLKSOURCE_CORE;
    return MCT_OK;
}

int64_t mct_systick_cycles(void)
{
    const uint32_t before = mct_interrupts_hold();
    uint32_t left = SYST_CVR;
    uint64_t whole = ticks;
    if (ICSR & PENDSTSET) { /* a period is over and not yet counted */
        left = SYST_CVR;
        whole++;
    }
    /* A period begins at 0, then comes its reload value. Should the 0 be seen ahead of its interrupt, time stands. */
    const int64_t now = (int64_t)(whole * period + (left == 0 ? 0 : period - left));
    newest = now > newest ? now : newest;
    const int64_t told = newest;
    mct_interrupts_restore(before);
    return told;
}

int64_t mct_systick_us(void)
{
    return mct_systick_cycles() / core_mhz;
}

/* --- hal/clock.h --- */

static uint32_t microseconds(int64_t cycles)
{
    const int64_t us = cycles / core_mhz;
    return us < 0 ? 0 : us > UINT32_MAX ? UINT32_MAX : (uint32_t)us;
}

void mct_clock_start(mct_clock *clock, double tick)
{
    (void)tick; /* SysTick has it */
    memset(clock, 0, sizeof *clock);
    clock->has_memory = true; /* nothing else runs */
    clock->has_priority = true;
    clock->woke = mct_systick_cycles();
    clock->tick = (uint64_t)clock->woke / period + 1;
}

/* An interrupt that comes between the look and the sleep ends the sleep at once: it is held back, not lost. */
static void sleep_until(uint64_t tick)
{
    bool is_due = false;
    while (!is_due) {
        const uint32_t before = mct_interrupts_hold();
        is_due = ticks >= tick;
        if (!is_due) {
            mct_interrupts_wait();
        }
        mct_interrupts_restore(before);
    }
}

mct_status mct_clock_wait(mct_clock *clock)
{
    mct_timing *timing = &clock->timing;
    const int64_t done = mct_systick_cycles();
    mct_histogram_add(&timing->work, microseconds(done - clock->woke));
    const uint64_t begun = (uint64_t)done / period;
    if (begun >= clock->tick) {
        mct_hal_count(&timing->missed_ticks, begun - clock->tick + 1);
        clock->tick = begun + 1;
    }
    sleep_until(clock->tick);
    clock->woke = mct_systick_cycles();
    mct_histogram_add(&timing->lateness, microseconds(clock->woke - (int64_t)(clock->tick * period)));
    clock->tick++;
    return MCT_OK;
}

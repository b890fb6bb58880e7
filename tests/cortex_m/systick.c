/*
 * SysTick as the loop's clock, on the emulated board. Prints a line for each figure: its name, the number in decimal. The
 * timer of mps2.h, which is another one, says how long things took: 25 counts a microsecond, as the core.
 */
#include "hal/cortex_m/systick.h"
#include "hal/clock.h"
#include "hal/cortex_m/mps2.h"
#include "hal/cortex_m/processor.h"
#include "hal/cortex_m/semihosting.h"

enum { CORE_MHZ = 25, TICKS = 1000, LOOKS = 20000, LEAP_US = 20, HELD_US = 1500 };
#define TICK 0.001

static void print(const char *name, int64_t number)
{
    mct_message line;
    mct_message_clear(&line);
    mct_message_add(&line, name);
    mct_message_add(&line, " ");
    mct_message_add_integer(&line, number);
    mct_semihosting_write(line.text);
    mct_semihosting_write("\n");
}

static uint32_t elapsed_us(uint32_t begin)
{
    return (begin - mct_mps2_timer()) / CORE_MHZ;
}

static void work_for(uint32_t us)
{
    const uint32_t begin = mct_mps2_timer();
    while (elapsed_us(begin) < us) {
    }
}

static void show_ticks(mct_clock *clock)
{
    (void)mct_clock_wait(clock);
    const uint32_t begin = mct_mps2_timer();
    const uint64_t missed = clock->timing.missed_ticks;
    uint32_t longest = 0;
    uint32_t before = 0;
    for (int i = 0; i < TICKS; i++) {
        (void)mct_clock_wait(clock);
        const uint32_t now = elapsed_us(begin);
        longest = now - before > longest ? now - before : longest;
        before = now;
    }
    print("ticks_us", before);
    print("longest_tick_us", longest);
    print("missed_at_rest", (int64_t)(clock->timing.missed_ticks - missed));
    print("worst_lateness_us", clock->timing.lateness.worst_us);
}

static void show_work(mct_clock *clock, uint32_t us)
{
    (void)mct_clock_wait(clock); /* what was printed is over */
    const uint64_t missed = clock->timing.missed_ticks;
    work_for(us);
    (void)mct_clock_wait(clock);
    print("work_us", clock->timing.work.latest_us);
    print("missed", (int64_t)(clock->timing.missed_ticks - missed));
    print("lateness_us", clock->timing.lateness.latest_us);
}

static void show_time(void)
{
    int64_t last = mct_systick_cycles();
    const int64_t first_us = mct_systick_us();
    const uint32_t begin = mct_mps2_timer();
    int back = 0;
    for (int i = 0; i < LOOKS; i++) {
        const int64_t now = mct_systick_cycles();
        back += now < last;
        last = now;
    }
    const uint32_t timer_us = elapsed_us(begin);
    print("times_back", back);
    print("systick_us", mct_systick_us() - first_us);
    print("timer_us", timer_us);
}

/*
 * While the processor sleeps, the emulator leaps to the next event of a timer, and now and then to the one behind it as
 * well, so that two interrupts become one. Another timer, with many events and no interrupts, makes such leaps short.
 */
static void make_leaps_short(void)
{
    mct_cmsdk_timer *const timer1 = (mct_cmsdk_timer *)0x40001000;
    timer1->value = timer1->reload = LEAP_US * CORE_MHZ - 1;
    timer1->control = 1;
}

/* From the beginning of a tick until after the next one, whose interrupt is held back. */
static void show_time_while_held(mct_clock *clock)
{
    (void)mct_clock_wait(clock);
    const int64_t begin_us = mct_systick_us();
    const uint32_t before = mct_interrupts_hold();
    work_for(HELD_US);
    const int64_t end_us = mct_systick_us();
    mct_interrupts_restore(before);
    print("held_us", end_us - begin_us);
}

int main(void)
{
    mct_clock clock;
    mct_mps2_start();
    make_leaps_short();
    print("too_long", mct_systick_start(CORE_MHZ, 0.68));
    print("too_short", mct_systick_start(CORE_MHZ, 1e-6));
    print("no_number", mct_systick_start(CORE_MHZ, -TICK));
    print("no_frequency", mct_systick_start(0, TICK));
    print("right", mct_systick_start(CORE_MHZ, TICK));
    mct_clock_start(&clock, TICK);
    show_ticks(&clock);
    show_work(&clock, 300);
    show_work(&clock, 3500);
    show_work(&clock, 300);
    show_time();
    show_time_while_held(&clock);
    return 0;
}

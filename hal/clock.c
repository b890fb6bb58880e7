#define _GNU_SOURCE

#include "hal/clock.h"

#include <errno.h>
#include <sched.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

void mct_clock_start(mct_clock *clock, double period)
{
    const struct sched_param priority = {.sched_priority = 80};
    memset(clock, 0, sizeof *clock);
    clock->has_memory = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
    clock->has_priority = sched_setscheduler(0, SCHED_FIFO, &priority) == 0;
    clock->period_ns = period * 1e9;
    clock->start_ns = now_ns();
    clock->woke = clock->start_ns;
    clock->tick = 1;
}

static int64_t deadline_ns(const mct_clock *clock)
{
    return clock->start_ns + (int64_t)((double)clock->tick * clock->period_ns + 0.5);
}

static uint32_t microseconds(int64_t ns)
{
    const int64_t us = ns / 1000;
    return us < 0 ? 0 : us > UINT32_MAX ? UINT32_MAX : (uint32_t)us;
}

mct_status mct_clock_wait(mct_clock *clock)
{
    mct_timing *timing = &clock->timing;
    const int64_t done = now_ns();
    mct_histogram_add(&timing->work, microseconds(done - clock->woke));
    const int64_t late_ns = done - deadline_ns(clock);
    if (late_ns > 0) {
        const uint64_t missed = (uint64_t)((double)late_ns / clock->period_ns) + 1;
        mct_hal_count(&timing->missed_ticks, missed);
        clock->tick += missed;
    }
    const int64_t due_ns = deadline_ns(clock);
    const struct timespec deadline = {.tv_sec = due_ns / 1000000000, .tv_nsec = (long)(due_ns % 1000000000)};
    int status = EINTR;
    for (int tries = 0; status == EINTR && tries < 100; tries++) {
        status = clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, NULL);
    }
    clock->woke = now_ns();
    mct_histogram_add(&timing->lateness, microseconds(clock->woke - due_ns));
    clock->tick++;
    return status == 0 ? MCT_OK : MCT_ERROR_IO;
}

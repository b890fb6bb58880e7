#define _DEFAULT_SOURCE /* syscall */
#include "instructions.h"

#include <string.h>
#include <unistd.h>

#if defined __linux__
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>

int instructions_open(void)
{
    struct perf_event_attr what;
    memset(&what, 0, sizeof what);
    what.size = sizeof what;
    what.type = PERF_TYPE_HARDWARE;
    what.config = PERF_COUNT_HW_INSTRUCTIONS;
    what.disabled = 1;
    what.exclude_kernel = 1;
    what.exclude_hv = 1;
    return (int)syscall(SYS_perf_event_open, &what, 0, -1, -1, 0);
}

void instructions_begin(int handle)
{
    ioctl(handle, PERF_EVENT_IOC_RESET, 0);
    ioctl(handle, PERF_EVENT_IOC_ENABLE, 0);
}

uint64_t instructions_end(int handle)
{
    uint64_t count = 0;
    ioctl(handle, PERF_EVENT_IOC_DISABLE, 0);
    return read(handle, &count, sizeof count) == (ssize_t)sizeof count ? count : 0;
}
#else
int instructions_open(void)
{
    return -1;
}

void instructions_begin(int handle)
{
    (void)handle;
}

uint64_t instructions_end(int handle)
{
    (void)handle;
    return 0;
}
#endif

void instructions_close(int handle)
{
    if (handle >= 0) {
        close(handle);
    }
}

/*
 * The HAL over a CAN socket when any one of its system calls fails, or every one of a kind from there on. The calls
 * stand here for the C library's, over a bus within the process with a virtual drive at its other end. Whatever
 * fails: the start is refused with a sentence, or the run goes on and what was lost is counted or a fault; at the end
 * the motor has zero volts.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <net/if.h>
#include <net/if_arp.h>

#include <linux/can.h>

#include "hal/socketcan/can.h"
#include "hal/socketcan/drive.h"
#include "hal/socketcan/ring.h"
#include "hal/socketcan/socket.h"
#include "mctau/loop.h"
#include "support/scenes.h"
#include "support/swing_up.h"
#include "unity.h"

enum { TICKS = 60, CAN_FD = 1000, MOST_OWN = 16, FIRST = 20 /* calls that open the socket */, SAMPLE = 40 };

typedef enum { SOCKET, IOCTL, SETSOCKOPT, BIND, SEND, RECVMSG, PPOLL, CLOSE, NONE } kind;

static mct_scene scene;
static mct_can_ring bus;
static mct_can_drive drive;
static mct_can_socket can_socket;
static mct_can can;
static mct_loop loop;
static mct_plan plan;
static mct_message why;

static struct {
    mct_can_transport wire; /* our end of the bus */
    mct_can_counts counts;
    struct can_frame own[MOST_OWN]; /* confirmations that wait */
    int own_count;
    long count, at; /* calls so far; that which fails */
    int error;
    bool ever;
    kind failing; /* from here on */
    kind chosen;  /* that was to fail */
    int open;     /* sockets */
} kernel;

/* --- the kernel --- */

static bool fails(kind call)
{
    kernel.count++;
    const bool chosen = kernel.count == kernel.at;
    kernel.chosen = chosen ? call : kernel.chosen;
    if (!chosen && kernel.failing != call) {
        return false;
    }
    kernel.failing = kernel.ever ? call : kernel.failing;
    mct_can_ring_advance(&bus, 100); /* or who tries again and again would take for ever */
    errno = kernel.error;
    return true;
}

int socket(int domain, int type, int protocol)
{
    (void)type;
    (void)protocol;
    if (fails(SOCKET)) {
        return -1;
    }
    if (domain != PF_CAN) {
        errno = EAFNOSUPPORT; /* nobody tells of interfaces */
        return -1;
    }
    kernel.open++;
    return CAN_FD;
}

int ioctl(int fd, unsigned long what, ...)
{
    va_list arguments;
    va_start(arguments, what);
    struct ifreq *answer = va_arg(arguments, struct ifreq *);
    va_end(arguments);
    (void)fd;
    if (fails(IOCTL)) {
        return -1;
    }
    if (what == SIOCGIFHWADDR) {
        answer->ifr_hwaddr.sa_family = ARPHRD_CAN;
    } else if (what == SIOCGIFFLAGS) {
        answer->ifr_flags = IFF_UP;
    } else {
        answer->ifr_ifindex = 3;
    }
    return 0;
}

int setsockopt(int fd, int level, int name, const void *value, socklen_t length)
{
    (void)fd;
    (void)level;
    (void)name;
    (void)value;
    (void)length;
    return fails(SETSOCKOPT) ? -1 : 0;
}

int bind(int fd, const struct sockaddr *address, socklen_t length)
{
    (void)fd;
    (void)address;
    (void)length;
    return fails(BIND) ? -1 : 0;
}

ssize_t send(int fd, const void *data, size_t length, int flags)
{
    mct_can_frame frame = {0};
    struct can_frame raw;
    (void)fd;
    (void)flags;
    if (fails(SEND)) {
        return -1;
    }
    memcpy(&raw, data, sizeof raw);
    frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
    frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
    frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    frame.length = raw.can_dlc;
    memcpy(frame.data, raw.data, sizeof frame.data);
    if (kernel.own_count == MOST_OWN || !kernel.wire.ops->send(kernel.wire.context, &frame)) {
        errno = ENOBUFS;
        return -1;
    }
    kernel.own[kernel.own_count++] = raw;
    return (ssize_t)length;
}

ssize_t recvmsg(int fd, struct msghdr *message, int flags)
{
    struct can_frame raw;
    mct_can_frame frame;
    (void)fd;
    (void)flags;
    if (fails(RECVMSG)) {
        return -1;
    }
    message->msg_controllen = 0;
    message->msg_flags = 0;
    memset(&raw, 0, sizeof raw);
    if (kernel.own_count > 0) {
        raw = kernel.own[0];
        memmove(kernel.own, kernel.own + 1, (size_t)--kernel.own_count * sizeof raw);
        message->msg_flags = MSG_CONFIRM | MSG_DONTROUTE;
    } else if (kernel.wire.ops->receive(kernel.wire.context, &frame)) {
        raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0) | (frame.remote ? CAN_RTR_FLAG : 0);
        raw.can_dlc = frame.length;
        memcpy(raw.data, frame.data, sizeof frame.data);
    } else {
        errno = EAGAIN;
        return -1;
    }
    memcpy(message->msg_iov->iov_base, &raw, sizeof raw);
    return (ssize_t)sizeof raw;
}

int ppoll(struct pollfd *sockets, nfds_t count, const struct timespec *timeout, const sigset_t *mask)
{
    const int64_t us = (int64_t)timeout->tv_sec * 1000000 + timeout->tv_nsec / 1000;
    (void)sockets;
    (void)mask;
    if (fails(PPOLL)) {
        return -1;
    }
    if (count == 0) {
        mct_can_ring_advance(&bus, us);
        return 0;
    }
    return kernel.own_count > 0 || kernel.wire.ops->wait(kernel.wire.context, us) ? 1 : 0;
}

int close(int fd)
{
    if (fd != CAN_FD) {
        return 0;
    }
    kernel.open--; /* as Linux does, even when it fails */
    return fails(CLOSE) ? -1 : 0;
}

/* The bus's time; a look at it takes a little, or who waits in vain would wait for ever. */
int clock_gettime(clockid_t clock, struct timespec *now)
{
    (void)clock;
    bus.now_us++;
    now->tv_sec = (time_t)(bus.now_us / 1000000);
    now->tv_nsec = (long)(bus.now_us % 1000000) * 1000;
    return 0;
}

/* --- a run --- */

typedef struct {
    mct_status status;
    uint64_t ticks;
    mct_can_counts counts;
    uint32_t faults, worst_age_us; /* the age of each feedback is in the record */
    mct_state plant;
    long calls, calls_of_start;
    bool failed_in_run; /* and not in a start that overcame it, nor at the end */
    kind chosen;
} outcome;

static outcome run(long at, int error, bool ever)
{
    outcome result;
    memset(&result, 0, sizeof result);
    memset(&why, 0, sizeof why);
    memset(&kernel, 0, sizeof kernel);
    kernel.failing = kernel.chosen = NONE;
    kernel.at = at;
    kernel.error = error;
    kernel.ever = ever;
    mct_can_ring_init(&bus);
    kernel.wire = mct_can_ring_end(&bus, 0);
    kernel.wire.ops->open(kernel.wire.context, NULL, 0, &kernel.counts, &why);
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_can_drive_init(&drive, &scene, mct_can_ring_end(&bus, 1), &why));
    mct_can_drive_serve(&drive, &bus);
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_can_drive_open(&drive, &why));
    const mct_can_transport transport = mct_can_socket_transport(&can_socket, "can0", 500000);
    TEST_ASSERT_EQUAL_INT(MCT_OK, mct_can_init(&can, &scene, transport, true, &why));
    can.plant = &drive.sim.plant.state;
    const mct_hal hal = mct_can_hal(&can);
    result.status = hal.ops->open(hal.context, &why);
    result.calls_of_start = kernel.count;
    if (result.status == MCT_OK) {
        TEST_ASSERT_EQUAL_INT(MCT_OK,
                              mct_loop_init(&loop, &plan, &scene, hal, NULL, (mct_samples){NULL, 0}, &why));
        for (int i = 0; i < TICKS; i++) {
            mct_loop_tick(&loop);
            const uint32_t age_us = loop.record.reading.age_us;
            result.worst_age_us = age_us > result.worst_age_us ? age_us : result.worst_age_us;
        }
        result.failed_in_run = at > result.calls_of_start && at <= kernel.count;
        result.plant = loop.record.plant;
        result.ticks = loop.tick;
        result.faults = loop.supervisor.latched;
        hal.ops->stop(hal.context);
        hal.ops->close(hal.context);
    }
    const mct_counters counters = hal.ops->counters(hal.context);
    memcpy(result.counts.values, counters.values, sizeof result.counts.values);
    result.calls = kernel.count;
    result.chosen = kernel.chosen;
    /* What did not get through ends by the drive's own watchdog. */
    const int64_t end_us = bus.now_us + (int64_t)(scene.can_watchdog * 1e6) + 10000;
    for (int i = 0; i < 10000 && bus.now_us < end_us; i++) {
        kernel.wire.ops->wait(kernel.wire.context, 1000);
        for (mct_can_frame frame; kernel.wire.ops->receive(kernel.wire.context, &frame);) {
        }
    }
    return result;
}

/* Whether a counter, or the age of feedback, tells of trouble. */
static bool is_told(const outcome *plain, const outcome *now)
{
    const mct_can_count lost[] = {MCT_CAN_COUNT_QUEUE_FULL, MCT_CAN_COUNT_LINK_LOST};
    if (now->chosen == SEND) { /* a frame that was not taken */
        return now->counts.values[lost[0]] + now->counts.values[lost[1]] > 0;
    }
    bool found = now->worst_age_us > plain->worst_age_us;
    for (int i = 0; i < MCT_CAN_COUNTS; i++) {
        const bool traffic =
            i == MCT_CAN_COUNT_SENT || i == MCT_CAN_COUNT_CONFIRMED || i == MCT_CAN_COUNT_RECEIVED;
        found |= !traffic && now->counts.values[i] != plain->counts.values[i];
    }
    return found;
}

static void check(const outcome *plain, const outcome *now, const char *what)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, kernel.open, what); /* no socket is left */
    TEST_ASSERT_TRUE_MESSAGE(!drive.powered || drive.volts == 0, what);
    if (now->status != MCT_OK) {
        TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_ERROR_IO, now->status, what);
        TEST_ASSERT_TRUE_MESSAGE(strlen(why.text) > 20, what);
        return;
    }
    TEST_ASSERT_TRUE_MESSAGE(now->ticks == TICKS, what);
    const bool same = memcmp(&now->plant, &plain->plant, sizeof plain->plant) == 0;
    TEST_ASSERT_TRUE_MESSAGE((same && now->chosen != SEND) || is_told(plain, now) || now->faults != 0 ||
                                 !now->failed_in_run,
                             what);
}

void setUp(void)
{
    scene = swing_up_scene(REACTION_WHEEL);
}

void tearDown(void)
{
}

static void test_a_run_over_a_socket_that_works_has_no_fault(void)
{
    const outcome plain = run(0, 0, false);
    TEST_ASSERT_EQUAL_INT_MESSAGE(MCT_OK, plain.status, why.text);
    TEST_ASSERT_EQUAL_HEX32(0, plain.faults);
    TEST_ASSERT_TRUE(plain.counts.values[MCT_CAN_COUNT_CONFIRMED] >= TICKS);
    TEST_ASSERT_TRUE(drive.result.driven_ticks > TICKS / 2);
}

static void test_whatever_call_fails_it_is_told_and_the_motor_ends_at_zero_volts(void)
{
    static const int errors[] = {EIO, EINTR, EAGAIN, ENOBUFS, ENOMEM, EBADF, ENETDOWN, ENODEV};
    enum { ERRORS = (int)(sizeof errors / sizeof errors[0]) };
    const outcome plain = run(0, 0, false);
    const char *asked = getenv("MCTAU_FAULTS");
    const long step = asked != NULL && strcmp(asked, "all") == 0 ? 1 : plain.calls / SAMPLE + 1;
    long refused = 0, in_run = 0, runs = 0;
    for (long n = 1; n <= plain.calls; n += n < FIRST ? 1 : step) {
        for (int i = 0; i < 2 * ERRORS; i++) {
            char what[80];
            const int error = errors[i / 2];
            const bool ever = i % 2 != 0;
            const outcome now = run(n, error, ever);
            snprintf(what, sizeof what, "call %ld, errno %d, %s", n, error, ever ? "ever" : "once");
            check(&plain, &now, what);
            refused += now.status != MCT_OK;
            in_run += now.failed_in_run;
            runs++;
        }
    }
    printf("%ld calls, %ld runs, %ld refused at the start, %ld failed behind it\n", plain.calls, runs,
           refused, in_run);
    TEST_ASSERT_TRUE(refused > 0 && in_run > 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_run_over_a_socket_that_works_has_no_fault);
    RUN_TEST(test_whatever_call_fails_it_is_told_and_the_motor_ends_at_zero_volts);
    return UNITY_END();
}

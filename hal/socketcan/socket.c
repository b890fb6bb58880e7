#define _GNU_SOURCE

#include "hal/socketcan/socket.h"

#include <errno.h>
#include <poll.h>
#include <stddef.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <net/if.h>
#include <net/if_arp.h>

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/netlink.h>
#include <linux/can/raw.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <linux/rtnetlink.h>

#include "hal/socketcan/filter.h"

enum {
    MOST_MESSAGES = 256, /* read in one go; the rest next time */
    MOST_STALE = 4096,   /* thrown away in one go */
    MOST_ROUNDS = 64,    /* of a wait that wakes up for confirmations and errors */
    MOST_REPLIES = 256,  /* of the kernel to one question */
    REPLY_SIZE = 16384   /* [bytes], two of the kernel's pages of replies */
};

typedef char name_has_the_kernels_size[MCT_CAN_INTERFACE_SIZE == IFNAMSIZ ? 1 : -1];

static int64_t clock_us(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

/* --- the rules --- */

static void forget_flights(mct_can_socket *self)
{
    for (int i = 0; i < self->flight_count; i++) {
        self->flights[i].unsent = false;
    }
}

static bool is_lost(const mct_can_socket *self)
{
    return self->state != MCT_CAN_UP;
}

void mct_can_socket_lose(mct_can_socket *self, mct_can_link_state state)
{
    if (!is_lost(self)) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_LINK_LOST);
    }
    self->state = state;
    forget_flights(self);
    if (self->has_pending) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_SKIPPED);
        self->has_pending = false;
    }
}

void mct_can_socket_regain(mct_can_socket *self)
{
    if (is_lost(self)) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_LINK_BACK);
    }
    self->state = MCT_CAN_UP;
    self->passive = false;
    forget_flights(self);
}

void mct_can_socket_dropped(mct_can_socket *self, uint32_t total)
{
    const uint32_t more = total - self->dropped;
    self->dropped = total;
    if (more > 0) {
        mct_hal_count(&self->counts->values[MCT_CAN_COUNT_OVERFLOWED], more);
        forget_flights(self); /* confirmations may have been among them */
    }
}

static void note_controller(mct_can_socket *self, uint8_t status)
{
    const bool passive = (status & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0;
    const uint8_t better = CAN_ERR_CRTL_ACTIVE | CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING;
    if ((status & CAN_ERR_CRTL_RX_OVERFLOW) != 0) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_OVERFLOWED);
    }
    if (passive && !self->passive) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_ERROR_PASSIVE);
    }
    if (passive || (status & better) != 0) {
        self->passive = passive;
    }
}

static void note_error(mct_can_socket *self, const struct can_frame *raw)
{
    const uint32_t class = raw->can_id & CAN_ERR_MASK;
    const bool at_ack_slot = (class & CAN_ERR_PROT) != 0 && raw->data[3] == CAN_ERR_PROT_LOC_ACK;
    mct_can_counted(self->counts, MCT_CAN_COUNT_ERROR_FRAMES);
    if ((class & CAN_ERR_ACK) != 0 || at_ack_slot) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_NO_ACKNOWLEDGE);
    } else if ((class & (CAN_ERR_PROT | CAN_ERR_BUSERROR)) != 0) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_BUS_ERRORS);
    }
    if ((class & CAN_ERR_CRTL) != 0) {
        note_controller(self, raw->data[1]);
    }
    if ((class & CAN_ERR_BUSOFF) != 0 && self->state != MCT_CAN_BUS_OFF) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_BUS_OFF);
        mct_can_socket_lose(self, MCT_CAN_BUS_OFF);
    }
    if ((class & CAN_ERR_RESTARTED) != 0) {
        mct_can_socket_regain(self); /* and what was under way is lost, with its confirmations */
    }
}

static void note_confirmation(mct_can_socket *self, uint32_t id)
{
    for (int i = 0; i < self->flight_count; i++) {
        mct_can_flight *flight = &self->flights[i];
        if (flight->id == id && flight->unsent) {
            flight->unsent = false;
            mct_can_counted(self->counts, MCT_CAN_COUNT_CONFIRMED);
        }
    }
}

static void unpack(const struct can_frame *raw, int64_t time_us, mct_can_frame *frame)
{
    memset(frame, 0, sizeof *frame);
    frame->extended = (raw->can_id & CAN_EFF_FLAG) != 0;
    frame->remote = (raw->can_id & CAN_RTR_FLAG) != 0;
    frame->id = raw->can_id & (frame->extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    frame->length = raw->can_dlc <= CAN_MAX_DLEN ? raw->can_dlc : CAN_MAX_DLEN;
    if (!frame->remote) {
        memcpy(frame->data, raw->data, frame->length);
    }
    frame->time_us = time_us;
}

bool mct_can_socket_take(mct_can_socket *self, const struct can_frame *raw, int flags, int64_t time_us,
                         mct_can_frame *frame)
{
    if ((raw->can_id & CAN_ERR_FLAG) != 0) {
        note_error(self, raw);
        return false;
    }
    if ((flags & MSG_CONFIRM) != 0) {
        note_confirmation(self, raw->can_id);
        return false;
    }
    if (self->state == MCT_CAN_BUS_OFF && (flags & MSG_DONTROUTE) == 0) { /* from the bus: it lives */
        mct_can_socket_regain(self);
    }
    if (is_lost(self)) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_SKIPPED);
        return false;
    }
    unpack(raw, time_us, frame);
    if (!mct_can_is_wanted(self->filters, self->filter_count, frame)) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_FOREIGN); /* somebody else sends what is sent from here */
        return false;
    }
    return true;
}

mct_can_flight *mct_can_socket_flight(mct_can_socket *self, uint32_t id, bool *is_new)
{
    *is_new = false;
    for (int i = 0; i < self->flight_count; i++) {
        if (self->flights[i].id == id) {
            return &self->flights[i];
        }
    }
    if (self->flight_count == MCT_CAN_MAX_FLIGHTS) {
        return NULL;
    }
    *is_new = true;
    self->flights[self->flight_count] = (mct_can_flight){.id = id};
    return &self->flights[self->flight_count++];
}

mct_can_link_state mct_can_socket_state(const mct_can_socket *self, int64_t now_us)
{
    bool unsent = false;
    for (int i = 0; i < self->flight_count; i++) {
        const mct_can_flight *flight = &self->flights[i];
        unsent |= flight->unsent && now_us - flight->since_us > MCT_CAN_UNSENT_US;
    }
    return self->state == MCT_CAN_UP && unsent ? MCT_CAN_UNSENT : self->state;
}

/* --- receiving --- */

/*
 * The kernel's software stamp of the arrival, on our clock. That of the adapter's own clock would be finer,
 * but how that clock stands to ours nobody knows; so it is not asked for. The wall clock may be set at any
 * time: only what has passed since the stamp is taken from it.
 */
static int64_t arrival_us(const struct scm_timestamping *stamps)
{
    const int64_t now_us = clock_us(CLOCK_MONOTONIC);
    const int64_t stamp_us = (int64_t)stamps->ts[0].tv_sec * 1000000 + stamps->ts[0].tv_nsec / 1000;
    const int64_t age_us = stamp_us != 0 ? clock_us(CLOCK_REALTIME) - stamp_us : 0;
    return now_us - (age_us > 0 ? age_us : 0);
}

/* What a failed system call on the socket says of the link. */
static void note_failure(mct_can_socket *self, int error)
{
    if (error == ENETDOWN) {
        mct_can_socket_lose(self, MCT_CAN_DOWN);
    } else if (error == ENODEV || error == ENXIO) {
        mct_can_socket_lose(self, MCT_CAN_GONE);
    }
}

/* Reads one message of the socket. @return its length, or -1 with errno */
static ssize_t read_message(mct_can_socket *self, struct can_frame *raw, int *flags, int64_t *time_us)
{
    union {
        struct cmsghdr align;
        char bytes[CMSG_SPACE(sizeof(struct scm_timestamping)) + CMSG_SPACE(sizeof(uint32_t)) + 64];
    } control;
    struct scm_timestamping stamps;
    struct iovec vector = {raw, sizeof *raw};
    struct msghdr message;
    memset(&stamps, 0, sizeof stamps);
    memset(&message, 0, sizeof message);
    message.msg_iov = &vector;
    message.msg_iovlen = 1;
    message.msg_control = &control;
    message.msg_controllen = sizeof control;
    const ssize_t length = recvmsg(self->fd, &message, MSG_DONTWAIT);
    if (length < 0) {
        return length;
    }
    for (struct cmsghdr *part = CMSG_FIRSTHDR(&message); part != NULL; part = CMSG_NXTHDR(&message, part)) {
        const bool ours = part->cmsg_level == SOL_SOCKET;
        if (ours && part->cmsg_type == SO_TIMESTAMPING && part->cmsg_len >= CMSG_LEN(sizeof stamps)) {
            memcpy(&stamps, CMSG_DATA(part), sizeof stamps);
        } else if (ours && part->cmsg_type == SO_RXQ_OVFL && part->cmsg_len >= CMSG_LEN(sizeof(uint32_t))) {
            uint32_t total;
            memcpy(&total, CMSG_DATA(part), sizeof total);
            mct_can_socket_dropped(self, total);
        }
    }
    *flags = message.msg_flags;
    *time_us = arrival_us(&stamps);
    return length;
}

/* Reads up to the next frame to receive. */
static bool pull(mct_can_socket *self, mct_can_frame *frame)
{
    struct can_frame raw;
    int flags;
    int64_t time_us;
    for (int i = 0; i < MOST_MESSAGES; i++) {
        const ssize_t length = read_message(self, &raw, &flags, &time_us);
        if (length == (ssize_t)sizeof raw) {
            if (mct_can_socket_take(self, &raw, flags, time_us, frame)) {
                return true;
            }
        } else if (length < 0 && errno != EINTR) {
            if (errno == EAGAIN) {
                self->emptied_us = clock_us(CLOCK_MONOTONIC);
            }
            note_failure(self, errno);
            return false;
        }
    }
    return false;
}

/* Reads ahead, so that confirmations and errors are seen. */
static bool look(mct_can_socket *self)
{
    if (!self->has_pending && (self->state == MCT_CAN_UP || self->state == MCT_CAN_BUS_OFF)) {
        self->has_pending = pull(self, &self->pending);
    }
    return self->has_pending;
}

static bool socket_receive(void *context, mct_can_frame *frame)
{
    mct_can_socket *self = context;
    if (!look(self)) {
        return false;
    }
    *frame = self->pending;
    self->has_pending = false;
    return true;
}

static bool socket_wait(void *context, int64_t timeout_us)
{
    mct_can_socket *self = context;
    const int64_t end_us = clock_us(CLOCK_MONOTONIC) + timeout_us;
    for (int i = 0; i < MOST_ROUNDS; i++) {
        if (look(self)) {
            return true;
        }
        const int64_t rest_us = end_us - clock_us(CLOCK_MONOTONIC);
        if (rest_us <= 0) {
            return false;
        }
        /* A socket without an interface would wake up at once, again and again. */
        const bool listening = self->state == MCT_CAN_UP || self->state == MCT_CAN_BUS_OFF;
        struct pollfd readable = {self->fd, POLLIN, 0};
        const struct timespec timeout = {(time_t)(rest_us / 1000000), (long)(rest_us % 1000000) * 1000};
        if (ppoll(&readable, listening ? 1 : 0, &timeout, NULL) < 0) {
            return look(self); /* a signal: who waits may have to end */
        }
    }
    return look(self);
}

/* --- opening --- */

/* All identifiers that are wanted, in either format and as remote requests, and those of frames sent from
 * here. */
static bool install_filters(const mct_can_socket *self, int fd)
{
    struct can_filter filters[4 * MCT_CAN_MAX_FILTERS + MCT_CAN_MAX_FLIGHTS];
    const uint32_t flags = CAN_EFF_FLAG | CAN_RTR_FLAG;
    size_t count = 0;
    for (int i = 0; i < self->filter_count; i++) {
        const uint32_t id = self->filters[i].id;
        for (uint32_t remote = 0; remote <= CAN_RTR_FLAG; remote += CAN_RTR_FLAG) {
            filters[count++] = (struct can_filter){id | CAN_EFF_FLAG | remote, CAN_EFF_MASK | flags};
            if (id <= CAN_SFF_MASK) {
                filters[count++] = (struct can_filter){id | remote, CAN_SFF_MASK | flags};
            }
        }
    }
    for (int i = 0; i < self->flight_count && self->filter_count > 0; i++) {
        const uint32_t id = self->flights[i].id;
        const uint32_t bits = (id & CAN_EFF_FLAG) != 0 ? CAN_EFF_MASK : CAN_SFF_MASK;
        filters[count++] = (struct can_filter){id, bits | flags};
    }
    if (self->filter_count == 0) {
        filters[count++] = (struct can_filter){0, 0};
    }
    return setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, filters, (socklen_t)(count * sizeof filters[0])) == 0;
}

/* What went wrong on the way to an open socket; each has its sentence. */
typedef enum { ATTACHED, NO_SOCKET, NO_INTERFACE, NOT_CAN, NO_OPTION, NOT_BOUND } outcome;

static bool ask_interface(const mct_can_socket *self, int fd, unsigned long what, struct ifreq *answer)
{
    memset(answer, 0, sizeof *answer);
    memcpy(answer->ifr_name, self->interface, MCT_CAN_INTERFACE_SIZE);
    return ioctl(fd, what, answer) == 0;
}

static bool is_interface_up(const mct_can_socket *self, int fd)
{
    struct ifreq answer;
    return ask_interface(self, fd, SIOCGIFFLAGS, &answer) && (answer.ifr_flags & IFF_UP) != 0;
}

static bool set_options(const mct_can_socket *self, int fd)
{
    const can_err_mask_t errors = CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_PROT | CAN_ERR_ACK |
                                  CAN_ERR_BUSOFF | CAN_ERR_BUSERROR | CAN_ERR_RESTARTED;
    const int on = 1;
    const int stamps = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
    return install_filters(self, fd) &&
           setsockopt(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) == 0 &&
           setsockopt(fd, SOL_CAN_RAW, CAN_RAW_LOOPBACK, &on, sizeof on) == 0 &&
           setsockopt(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &on, sizeof on) == 0 &&
           setsockopt(fd, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on) == 0 &&
           setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPING, &stamps, sizeof stamps) == 0;
}

/* Filters come before bind, so that nothing else ever waits in the queue. */
static outcome configure(const mct_can_socket *self, int fd)
{
    struct ifreq answer;
    if (!ask_interface(self, fd, SIOCGIFHWADDR, &answer)) {
        return NO_INTERFACE;
    }
    if (answer.ifr_hwaddr.sa_family != ARPHRD_CAN) {
        return NOT_CAN;
    }
    if (!set_options(self, fd)) {
        return NO_OPTION;
    }
    if (!ask_interface(self, fd, SIOCGIFINDEX, &answer)) {
        return NO_INTERFACE;
    }
    struct sockaddr_can address;
    memset(&address, 0, sizeof address);
    address.can_family = AF_CAN;
    address.can_ifindex = answer.ifr_ifindex;
    return bind(fd, (const struct sockaddr *)&address, sizeof address) == 0 ? ATTACHED : NOT_BOUND;
}

/* Opens a socket on the interface. On failure there is none, and errno tells more. */
static outcome attach(mct_can_socket *self)
{
    const int fd = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
    if (fd < 0) {
        return NO_SOCKET;
    }
    const outcome result = configure(self, fd);
    const int error = errno;
    if (result != ATTACHED) {
        close(fd);
        errno = error;
        return result;
    }
    self->fd = fd;
    self->dropped = 0;
    self->has_pending = false;
    return ATTACHED;
}

static void detach(mct_can_socket *self)
{
    if (self->fd >= 0) {
        close(self->fd);
    }
    self->fd = -1;
}

static void add_interface(const mct_can_socket *self, mct_message *why)
{
    mct_message_add(why, "\"");
    mct_message_add(why, self->interface);
    mct_message_add(why, "\"");
}

static void add_error(mct_message *why, int error)
{
    mct_message_add(why, " (errno ");
    mct_message_add_integer(why, error);
    mct_message_add(why, ")");
}

static void list_interfaces(mct_message *why);

static void explain_socket(int error, mct_message *why)
{
    if (error == EAFNOSUPPORT || error == EPROTONOSUPPORT || error == ESOCKTNOSUPPORT) {
        mct_message_add(
            why, "this kernel has no CAN: load its modules with 'sudo modprobe -a can can_raw' (and vcan or "
                 "your adapter's); in a container load them on the host; a kernel built without CAN needs "
                 "another one, or a virtual machine");
    } else if (error == EPERM || error == EACCES) {
        mct_message_add(why,
                        "not allowed to open a CAN socket: a container or a sandbox forbids it; allow it the "
                        "address family AF_CAN, or run outside");
    } else {
        mct_message_add(why, "cannot open a CAN socket");
        add_error(why, error);
    }
}

static void explain(const mct_can_socket *self, outcome result, int error, mct_message *why)
{
    switch (result) {
    case NO_SOCKET:
        explain_socket(error, why);
        break;
    case NO_INTERFACE:
        mct_message_add(why, "there is no interface ");
        add_interface(self, why);
        list_interfaces(why);
        break;
    case NOT_CAN:
        mct_message_add(why, "interface ");
        add_interface(self, why);
        mct_message_add(why, " is not a CAN interface");
        list_interfaces(why);
        break;
    case NO_OPTION:
    case NOT_BOUND:
    case ATTACHED:
        mct_message_add(why, "cannot use interface ");
        add_interface(self, why);
        add_error(why, error);
        mct_message_add(why, error == EPERM || error == EACCES
                                 ? ": not allowed; run with the rights to use it"
                             : result == NO_OPTION ? ": this needs Linux 4.1 or newer"
                                                   : ": is it being unplugged?");
        break;
    }
}

static void explain_down(const mct_can_socket *self, const mct_can_link *link, mct_message *why)
{
    mct_message_add(why, "interface ");
    add_interface(self, why);
    mct_message_add(why, " is down: 'sudo ip link set ");
    mct_message_add(why, self->interface);
    mct_message_add(why, " up");
    if (strcmp(link->kind, "vcan") != 0 && strcmp(link->kind, "vxcan") != 0) {
        mct_message_add(why, " type can bitrate ");
        if (self->bitrate > 0) {
            mct_message_add_integer(why, self->bitrate);
        } else {
            mct_message_add(why, "<bit/s>");
        }
        mct_message_add(why, " restart-ms 100");
    }
    mct_message_add(why, "'");
}

static mct_status socket_open(void *context, const mct_can_filter *filters, int count, mct_can_counts *counts,
                              mct_message *why)
{
    mct_can_socket *self = context;
    mct_can_link link;
    if (!mct_can_check_filters(filters, count, why)) {
        return MCT_ERROR_IO;
    }
    for (int i = 0; i < count; i++) {
        self->filters[i] = filters[i];
    }
    self->filter_count = count;
    self->counts = counts;
    self->state = MCT_CAN_UP;
    self->flight_count = 0;
    self->passive = false;
    if (!self->name_fits || self->interface[0] == '\0') {
        mct_message_add(why, "found an interface's name \"");
        mct_message_add(why, self->interface);
        mct_message_add(why, self->name_fits ? "\"" : "...\"");
        mct_message_add(why, "; allowed 1 to 15 bytes, such as can0");
        return MCT_ERROR_IO;
    }
    const outcome result = attach(self);
    if (result != ATTACHED) {
        explain(self, result, errno, why);
        return MCT_ERROR_IO;
    }
    const bool known = mct_can_link_details(self->interface, &link);
    if (!is_interface_up(self, self->fd)) {
        explain_down(self, &link, why);
        detach(self);
        return MCT_ERROR_IO;
    }
    if (known && link.state == CAN_STATE_BUS_OFF) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_BUS_OFF);
        mct_can_socket_lose(self, MCT_CAN_BUS_OFF);
    }
    return MCT_OK;
}

static void socket_close(void *context)
{
    detach(context);
}

/* --- sending --- */

static uint32_t kernel_id(const mct_can_frame *frame)
{
    return frame->id | (frame->extended ? CAN_EFF_FLAG : 0) | (frame->remote ? CAN_RTR_FLAG : 0);
}

static bool socket_send(void *context, const mct_can_frame *frame)
{
    mct_can_socket *self = context;
    struct can_frame raw;
    bool is_new;
    if (self->fd < 0 || is_lost(self)) {
        return false;
    }
    mct_can_flight *flight = mct_can_socket_flight(self, kernel_id(frame), &is_new);
    if (is_new && !install_filters(self, self->fd)) {
        self->flight_count--; /* its confirmation would not come through */
        flight = NULL;
    }
    if (flight != NULL && flight->unsent) {
        look(self); /* it may just have been confirmed */
        if (is_lost(self)) {
            return false;
        }
        if (flight->unsent) {
            mct_can_counted(self->counts, MCT_CAN_COUNT_HELD_BACK);
            return false;
        }
    }
    memset(&raw, 0, sizeof raw);
    raw.can_id = kernel_id(frame);
    raw.can_dlc = frame->length <= CAN_MAX_DLEN ? frame->length : CAN_MAX_DLEN;
    memcpy(raw.data, frame->data, raw.can_dlc);
    const ssize_t length = send(self->fd, &raw, sizeof raw, MSG_DONTWAIT);
    if (length != (ssize_t)sizeof raw) {
        note_failure(self, length < 0 ? errno : 0);
        if (!is_lost(self)) {
            mct_can_counted(self->counts, MCT_CAN_COUNT_QUEUE_FULL); /* ENOBUFS, EAGAIN: given up */
        }
        return false;
    }
    if (flight != NULL) {
        flight->unsent = true;
        flight->since_us = clock_us(CLOCK_MONOTONIC);
    }
    mct_can_counted(self->counts, MCT_CAN_COUNT_SENT);
    return true;
}

/* --- looking after the link --- */

/* Throws away what has come before the link was back. */
static void drain(mct_can_socket *self)
{
    struct can_frame raw;
    int flags;
    int64_t time_us;
    for (int i = 0; i < MOST_STALE; i++) {
        const ssize_t length = read_message(self, &raw, &flags, &time_us);
        if (length < 0 && errno == EAGAIN) {
            return;
        }
        if (length == (ssize_t)sizeof raw && (flags & MSG_CONFIRM) == 0 && (raw.can_id & CAN_ERR_FLAG) == 0) {
            mct_can_counted(self->counts, MCT_CAN_COUNT_SKIPPED);
        }
        if (length < 0 && (errno == ENODEV || errno == ENXIO)) {
            mct_can_socket_lose(self, MCT_CAN_GONE);
        }
    }
}

/* Drains first: whatever goes wrong after the interface was found up is then still to be read. */
static void try_to_regain(mct_can_socket *self)
{
    if (self->state == MCT_CAN_DOWN) {
        drain(self);
    }
    if (self->state == MCT_CAN_GONE) {
        detach(self);
        if (attach(self) != ATTACHED) {
            return;
        }
        self->state = MCT_CAN_DOWN;
    }
    if (is_interface_up(self, self->fd)) {
        mct_can_socket_regain(self);
    }
}

static mct_can_link_state socket_tend(void *context)
{
    mct_can_socket *self = context;
    const int64_t now_us = clock_us(CLOCK_MONOTONIC);
    look(self);
    const bool absent = self->state == MCT_CAN_DOWN || self->state == MCT_CAN_GONE;
    if (absent && now_us - self->tried_us >= MCT_CAN_RETRY_US) {
        self->tried_us = now_us;
        try_to_regain(self);
    }
    /* A confirmation may wait behind a frame that nobody has received yet. */
    return mct_can_socket_state(self, self->has_pending ? self->emptied_us : now_us);
}

static int64_t socket_now_us(void *context)
{
    (void)context;
    return clock_us(CLOCK_MONOTONIC);
}

mct_can_transport mct_can_socket_transport(mct_can_socket *self, const char *interface, uint32_t bitrate)
{
    static const mct_can_transport_ops ops = {
        .name = "socketcan",
        .open = socket_open,
        .send = socket_send,
        .receive = socket_receive,
        .wait = socket_wait,
        .now_us = socket_now_us,
        .tend = socket_tend,
        .close = socket_close,
    };
    memset(self, 0, sizeof *self);
    size_t length = 0;
    while (length < MCT_CAN_INTERFACE_SIZE - 1 && interface[length] != '\0') {
        self->interface[length] = interface[length];
        length++;
    }
    self->name_fits = interface[length] == '\0';
    self->bitrate = bitrate;
    self->fd = -1;
    return (mct_can_transport){&ops, self};
}

/* --- what the kernel knows of interfaces (rtnetlink) --- */

/* A piece of a message: attributes, each with a length, a type and a value. */
typedef struct {
    const char *at, *end;
} attributes;

typedef struct {
    int type;
    const char *value;
    size_t length;
} attribute;

static bool next_attribute(attributes *rest, attribute *found)
{
    struct rtattr header;
    const size_t room = (size_t)(rest->end - rest->at);
    if (room < sizeof header) {
        return false;
    }
    memcpy(&header, rest->at, sizeof header);
    if (header.rta_len < sizeof header || header.rta_len > room) {
        return false;
    }
    const size_t padded = RTA_ALIGN((size_t)header.rta_len);
    found->type = header.rta_type & 0x3FFF; /* without the marks of nesting and byte order */
    found->value = rest->at + sizeof header;
    found->length = header.rta_len - sizeof header;
    rest->at += padded < room ? padded : room;
    return true;
}

static uint32_t number(const attribute *source, size_t offset)
{
    uint32_t value = 0;
    if (source->length >= offset + sizeof value) {
        memcpy(&value, source->value + offset, sizeof value);
    }
    return value;
}

static void copy_text(const attribute *source, char *text, size_t size)
{
    size_t length = 0;
    while (length < source->length && length < size - 1 && source->value[length] != '\0') {
        text[length] = source->value[length];
        length++;
    }
    text[length] = '\0';
}

static void read_can(attributes rest, mct_can_link *link)
{
    attribute found;
    while (next_attribute(&rest, &found)) {
        switch (found.type) {
        case IFLA_CAN_BITTIMING:
            link->bitrate = number(&found, offsetof(struct can_bittiming, bitrate));
            break;
        case IFLA_CAN_STATE:
            link->state = (int)number(&found, 0);
            break;
        case IFLA_CAN_RESTART_MS:
            link->restart_ms = number(&found, 0);
            break;
        case IFLA_CAN_CTRLMODE:
            link->listen_only =
                (number(&found, offsetof(struct can_ctrlmode, flags)) & CAN_CTRLMODE_LISTENONLY) != 0;
            break;
        default:
            break;
        }
    }
}

/* The kind comes before what is particular to it, but better not to rely on that. */
static void read_kind(attributes rest, mct_can_link *link)
{
    attribute found, data = {0, NULL, 0};
    while (next_attribute(&rest, &found)) {
        if (found.type == IFLA_INFO_KIND) {
            copy_text(&found, link->kind, sizeof link->kind);
        } else if (found.type == IFLA_INFO_DATA) {
            data = found;
        }
    }
    if (data.value != NULL && strcmp(link->kind, "can") == 0) {
        read_can((attributes){data.value, data.value + data.length}, link);
    }
}

/* Reads a message on an interface. @return false when it is about something else */
static bool read_link(const char *message, size_t length, char name[MCT_CAN_INTERFACE_SIZE],
                      mct_can_link *link)
{
    struct nlmsghdr header;
    struct ifinfomsg info;
    attribute found;
    const size_t begin = NLMSG_HDRLEN + NLMSG_ALIGN(sizeof info);
    memset(link, 0, sizeof *link);
    link->state = -1;
    name[0] = '\0';
    memcpy(&header, message, sizeof header);
    if (header.nlmsg_type != RTM_NEWLINK || length < begin) {
        return false;
    }
    memcpy(&info, message + NLMSG_HDRLEN, sizeof info);
    link->index = info.ifi_index;
    link->is_can = info.ifi_type == ARPHRD_CAN;
    link->is_up = (info.ifi_flags & IFF_UP) != 0;
    attributes rest = {message + begin, message + length};
    while (next_attribute(&rest, &found)) {
        switch (found.type) {
        case IFLA_IFNAME:
            copy_text(&found, name, MCT_CAN_INTERFACE_SIZE);
            break;
        case IFLA_TXQLEN:
            link->queue = number(&found, 0);
            break;
        case IFLA_LINKINFO:
            read_kind((attributes){found.value, found.value + found.length}, link);
            break;
        default:
            break;
        }
    }
    return true;
}

typedef struct {
    struct nlmsghdr header;
    struct ifinfomsg info;
    struct rtattr attribute; /* with the name, for one interface */
    char name[MCT_CAN_INTERFACE_SIZE];
} link_request;

/* Asks for one interface, or for all with a name of NULL. @return a socket to read replies from, or -1 */
static int ask_links(const char *name)
{
    link_request request;
    const size_t length = name != NULL ? sizeof request : offsetof(link_request, attribute);
    const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
    if (fd < 0) {
        return -1;
    }
    memset(&request, 0, sizeof request);
    request.header.nlmsg_len = (uint32_t)length;
    request.header.nlmsg_type = RTM_GETLINK;
    request.header.nlmsg_flags = (uint16_t)(NLM_F_REQUEST | (name == NULL ? NLM_F_DUMP : 0));
    request.info.ifi_family = AF_UNSPEC;
    request.attribute.rta_type = IFLA_IFNAME;
    request.attribute.rta_len = (uint16_t)(sizeof request.attribute + sizeof request.name);
    for (size_t i = 0; name != NULL && i < sizeof request.name - 1 && name[i] != '\0'; i++) {
        request.name[i] = name[i];
    }
    if (send(fd, &request, length, MSG_DONTWAIT) != (ssize_t)length) {
        close(fd);
        return -1;
    }
    return fd;
}

/* Replies of the kernel, several messages in each. */
typedef struct {
    int fd;
    int replies; /* read so far */
    size_t at, length;
    union {
        struct nlmsghdr align;
        char bytes[REPLY_SIZE];
    } buffer;
} answers;

/* The next interface that the kernel tells of; false at the end. */
static bool next_link(answers *self, char name[MCT_CAN_INTERFACE_SIZE], mct_can_link *link)
{
    while (self->replies < MOST_REPLIES) {
        if (self->at >= self->length) {
            /* The kernel answers within the send; nothing to wait for. */
            const ssize_t length = recv(self->fd, &self->buffer, sizeof self->buffer, MSG_DONTWAIT);
            if (length <= 0) {
                return false;
            }
            self->replies++;
            self->at = 0;
            self->length = (size_t)length;
        }
        const char *message = self->buffer.bytes + self->at;
        const size_t room = self->length - self->at;
        struct nlmsghdr header;
        if (room < sizeof header) {
            return false;
        }
        memcpy(&header, message, sizeof header);
        if (header.nlmsg_len < sizeof header || header.nlmsg_len > room || header.nlmsg_type == NLMSG_DONE ||
            header.nlmsg_type == NLMSG_ERROR) {
            return false;
        }
        self->at += NLMSG_ALIGN((size_t)header.nlmsg_len);
        if (read_link(message, header.nlmsg_len, name, link)) {
            return true;
        }
    }
    return false;
}

bool mct_can_link_details(const char *interface, mct_can_link *link)
{
    char name[MCT_CAN_INTERFACE_SIZE];
    answers replies = {.fd = ask_links(interface)};
    memset(link, 0, sizeof *link);
    link->state = -1;
    if (replies.fd < 0) {
        return false;
    }
    const bool found = next_link(&replies, name, link);
    close(replies.fd);
    return found;
}

/* Adds which CAN interfaces there are. */
static void list_interfaces(mct_message *why)
{
    char name[MCT_CAN_INTERFACE_SIZE];
    mct_can_link link;
    int count = 0;
    answers replies = {.fd = ask_links(NULL)};
    if (replies.fd >= 0) {
        while (next_link(&replies, name, &link)) {
            if (link.is_can) {
                mct_message_add(why, count == 0 ? "; CAN interfaces here: " : ", ");
                mct_message_add(why, name);
                count++;
            }
        }
        close(replies.fd);
    }
    if (count == 0) {
        mct_message_add(
            why, "; this machine has no CAN interface: plug an adapter in and load its driver, or make a "
                 "virtual one with 'sudo ip link add vcan0 type vcan && sudo ip link set vcan0 up'");
    }
}

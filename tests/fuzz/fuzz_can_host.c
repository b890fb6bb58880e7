/*
 * The host HAL under the loop, with supervisor and controller, against a bus that brings anything.
 *
 * The start is a real one, over the ring with the virtual drive. From then on a transport of this file stands
 * between: the drive lives on, but its frames are lost, changed, repeated, delayed, and others come.
 *
 * What is demanded is computed here, from the frames that were handed to the host and those that it sent, the latter
 * read by the drive's end of the protocol; the HAL's own state is looked at where a comment says so.
 *
 * Input: three bytes for scene, fault of the drive and way of working; then operations, a byte each and what it takes.
 */
#include <math.h>
#include <string.h>

#include "fuzz/can_scenes.h"
#include "fuzz/fuzz.h"
#include "hal/socketcan/can.h"
#include "hal/socketcan/drive.h"
#include "hal/socketcan/filter.h"
#include "hal/socketcan/ring.h"
#include "mctau/loop.h"

enum { MOST_TICKS = 250, QUEUE = 64, KINDS = 8, FAULTS = MCT_CAN_FAULT_ERROR + 1 };
#define ALL_FLAGS (2u * MCT_READING_ESTOP - 1)

/* What reading the bus has to come to. */
typedef struct {
    bool news[MCT_MAX_ENCODERS]; /* a frame with this encoder's counts since the last read */
    int64_t newest_us[MCT_MAX_ENCODERS];
    uint64_t fresh_tick[MCT_MAX_ENCODERS];
    bool estop, invalid, link_down; /* since the last write */
    bool ready;                     /* the motor's drive has said so since it was asked last */
    bool stopped;                   /* and not armed since */
    uint64_t frames;                /* handed to the host */
} expectation;

typedef struct {
    mct_scene scene;
    mct_can_ring ring;
    mct_can_drive drive;
    mct_can can;
    mct_loop loop;
    mct_plan plan;
    mct_can_transport bus;                   /* the host's end of the ring */
    mct_can_device drives[MCT_CAN_MAX_AXES]; /* who read what the host sends */
    /* the way between */
    bool started;
    bool cut, deaf, full; /* the drive's frames are lost; the host's are; the host's are refused */
    bool echoes;          /* for each of the drive's frames comes an old one of that identifier */
    uint8_t spoilt_frame, spoilt_byte, spoilt_bits;
    int64_t older_us;
    mct_can_link_state link;
    int head, count;
    mct_can_frame queue[QUEUE];
    mct_can_frame last[KINDS]; /* of the drive, one of each identifier */
    int last_count;
    /* what is watched */
    expectation expected;
    uint64_t ticks, received_before;
    mct_real written;
    bool writing;
    mct_can_counts before;
    mct_supervisor supervisor_before;
    bool disturbed;       /* by anything at all */
    uint64_t quiet_ticks; /* since a fault was latched, all that was sent having reached the drive */
} bench;

/* One place, for it holds pointers into itself. */
static bench self;
static bench starts[FUZZ_CAN_SCENES];
static bool made[FUZZ_CAN_SCENES];

/* --- what a frame means, read from its bits --- */

static bool is_finite_float(const uint8_t *data)
{
    float value;
    memcpy(&value, data, sizeof value);
    return isfinite(value);
}

/* Number of the drive's encoder whose counts this is; -1 when it is something else. */
static int encoder_of(const mct_can_axis *axis, const mct_can_frame *frame)
{
    const uint32_t id = frame->id, node = axis->node;
    switch (self.scene.can_protocol) {
    case MCT_CAN_NATIVE:
        return id == 0x180 + node ? 0 : id == 0x280 + node ? 1 : -1;
    case MCT_CAN_VESC:
        return id == (16 << 8 | node) ? 0 : -1;
    default:
        return id == (node << 5 | (self.can.axes.protocol == &mct_can_odrive_0_5 ? 10 : 9)) ? 0 : -1;
    }
}

static bool is_estop(const mct_can_axis *axis, const mct_can_frame *frame)
{
    const uint32_t id = frame->id, node = axis->node;
    return (self.scene.can_protocol == MCT_CAN_NATIVE && id == 0x010 + node) ||
           (self.scene.can_protocol == MCT_CAN_ODRIVE && id == (node << 5 | 2));
}

/* Whether the frame says that the motor's drive obeys. */
static bool says_ready(const mct_can_frame *frame)
{
    static const uint8_t no_error[4] = {0};
    const uint32_t id = frame->id, node = self.can.axes.axes[0].node;
    switch (self.scene.can_protocol) {
    case MCT_CAN_NATIVE:
        return id == 0x180 + node && frame->length == 8 && (frame->data[7] & 3) == 1;
    case MCT_CAN_VESC:
        return (id & 0xFF) == node;
    default:
        return id == (node << 5 | 1) && frame->length == 8 && memcmp(frame->data, no_error, 4) == 0 &&
               frame->data[4] == 8;
    }
}

static void expect_of(const mct_can_frame *frame)
{
    expectation *expected = &self.expected;
    expected->frames++;
    if (frame->remote || frame->extended != self.can.axes.protocol->extended) {
        return;
    }
    expected->ready |= says_ready(frame);
    for (int i = 0; i < self.can.axes.count; i++) {
        const mct_can_axis *axis = &self.can.axes.axes[i];
        const int place = encoder_of(axis, frame);
        expected->estop |= is_estop(axis, frame);
        if (place < 0 || !axis->encoders[place].used || frame->length != 8) {
            continue;
        }
        const bool native = self.scene.can_protocol == MCT_CAN_NATIVE;
        const bool floats = self.can.axes.protocol == &mct_can_odrive;
        const bool bad = native
                             ? frame->data[7] & 0x40
                             : floats && !(is_finite_float(frame->data) && is_finite_float(frame->data + 4));
        /* The same once more is no news; the HAL's own memory tells. */
        const bool repeated = native && axis->encoders[place].updates > 0 &&
                              memcmp(axis->encoders[place].last, frame->data, 8) == 0;
        expected->invalid |= bad;
        if (!bad && !repeated) {
            const int i_of = axis->encoders[place].coordinate;
            expected->news[i_of] = true;
            if (frame->time_us > expected->newest_us[i_of]) {
                expected->newest_us[i_of] = frame->time_us;
            }
        }
    }
}

/* --- the transport between --- */

static void put(const mct_can_frame *frame)
{
    if (self.count < QUEUE) {
        self.queue[(self.head + self.count++) % QUEUE] = *frame;
    }
}

/* Where the last frame of an identifier lies. */
static mct_can_frame *last_of(uint32_t id)
{
    for (int i = 0; i < self.last_count; i++) {
        if (self.last[i].id == id) {
            return &self.last[i];
        }
    }
    self.last_count += self.last_count < KINDS;
    self.last[self.last_count - 1].id = id;
    return &self.last[self.last_count - 1];
}

/* Takes from the ring what the drive has said. */
static void fetch(void)
{
    mct_can_frame frame;
    for (int number = 0; self.bus.ops->receive(self.bus.context, &frame); number++) {
        mct_can_frame *last = last_of(frame.id);
        if (self.echoes) {
            last->time_us = frame.time_us;
            frame = *last;
        } else {
            *last = frame;
        }
        if (self.spoilt_bits != 0 && number == self.spoilt_frame) {
            frame.data[self.spoilt_byte] = (uint8_t)(frame.data[self.spoilt_byte] ^ self.spoilt_bits);
            self.spoilt_bits = 0;
        }
        frame.time_us -= self.older_us;
        if (!self.cut) {
            put(&frame);
        }
    }
}

static mct_status between_open(void *context, const mct_can_filter *filters, int count,
                               mct_can_counts *counts, mct_message *why)
{
    (void)context;
    return self.bus.ops->open(self.bus.context, filters, count, counts, why);
}

static void check_sent(const mct_can_frame *frame);

static bool between_send(void *context, const mct_can_frame *frame)
{
    (void)context;
    if (self.started) {
        check_sent(frame);
        if (self.full || self.link != MCT_CAN_UP) {
            mct_can_counted(&self.can.counts, MCT_CAN_COUNT_QUEUE_FULL);
            return false;
        }
        if (self.deaf) {
            mct_can_counted(&self.can.counts, MCT_CAN_COUNT_SENT);
            return true;
        }
    }
    return self.bus.ops->send(self.bus.context, frame);
}

static bool between_receive(void *context, mct_can_frame *frame)
{
    (void)context;
    if (!self.started) {
        return self.bus.ops->receive(self.bus.context, frame);
    }
    if (self.count == 0) {
        return false;
    }
    *frame = self.queue[self.head];
    self.head = (self.head + 1) % QUEUE;
    self.count--;
    expect_of(frame);
    return true;
}

static bool between_wait(void *context, int64_t timeout_us)
{
    (void)context;
    if (!self.started) {
        return self.bus.ops->wait(self.bus.context, timeout_us);
    }
    if (self.count == 0) {
        self.bus.ops->wait(self.bus.context, timeout_us);
        fetch();
    }
    return self.count > 0;
}

static int64_t between_now_us(void *context)
{
    (void)context;
    return self.ring.now_us;
}

static mct_can_link_state between_tend(void *context)
{
    (void)context;
    self.expected.link_down |= self.link != MCT_CAN_UP;
    return self.link;
}

static void between_close(void *context)
{
    (void)context;
    self.bus.ops->close(self.bus.context);
}

/* --- what the host sends --- */

static void check_volts(const mct_can_device *device)
{
    const mct_can_axis *axis = &self.can.axes.axes[0];
    const double told = axis->motor.inverted ? -device->value : device->value;
    FUZZ_RULE(isfinite(device->value), "what is sent is finite: %g", device->value);
    if (device->wish == MCT_CAN_WISH_VOLTS) {
        FUZZ_RULE(fabs(told) <= axis->motor.supply * (1 + 1e-6), "what is sent is within the supply: %g V",
                  told);
    } else if (device->wish == MCT_CAN_WISH_DUTY) {
        FUZZ_RULE(fabs(told) <= 1, "what is sent is within the supply: duty %g", told);
    }
    if (device->value == 0) {
        return;
    }
    FUZZ_RULE(!self.expected.stopped, "from a stop until it is armed a drive is told zero, not %g", told);
    if (device->wish == MCT_CAN_WISH_TORQUE) {
        return; /* zero volts are a torque too: the motor brakes against its own back-emf */
    }
    FUZZ_RULE(self.writing && self.written != 0, "volts are sent when they are written alone");
    FUZZ_RULE(told * (double)self.written > 0, "what is sent has the sign of what was written");
    if (device->wish == MCT_CAN_WISH_VOLTS) {
        FUZZ_RULE(fabs(told - (double)self.written) <= 0.0005 + 1e-6 * fabs(told), "%g V are sent as %g V",
                  (double)self.written, told);
    }
}

static void check_sent(const mct_can_frame *frame)
{
    const mct_can_axes *axes = &self.can.axes;
    FUZZ_RULE(frame->length <= 8 && !frame->remote && frame->extended == axes->protocol->extended,
              "a frame that is sent has the protocol's form");
    for (int i = frame->length; i < 8; i++) {
        FUZZ_RULE(frame->data[i] == 0, "data are zero beyond the length");
    }
    mct_can_verdict verdict = MCT_CAN_IS_FOREIGN;
    for (int i = 0; i < axes->count && verdict == MCT_CAN_IS_FOREIGN; i++) {
        verdict = axes->protocol->obey(&self.drives[i], frame);
        FUZZ_RULE(i == 0 || verdict == MCT_CAN_IS_FOREIGN || self.drives[i].value == 0,
                  "the motor's drive alone is told volts");
    }
    FUZZ_RULE(verdict == MCT_CAN_IS_COMMAND || verdict == MCT_CAN_IS_REQUEST || verdict == MCT_CAN_IS_STOP,
              "a drive understands what is sent, and takes it for new: id %x, verdict %d", frame->id,
              (int)verdict);
    check_volts(&self.drives[0]);
    FUZZ_RULE(!self.expected.stopped || self.scene.can_protocol == MCT_CAN_VESC ||
                  !self.drives[0].wants_ready,
              "from a stop until it is armed nothing asks a drive to be ready");
}

/* --- the HAL as the loop sees it --- */

static void check_counts(void)
{
    const mct_supervisor *supervisor = &self.loop.supervisor, *before = &self.supervisor_before;
    for (int i = 0; i < MCT_CAN_COUNTS; i++) {
        FUZZ_RULE(self.can.counts.values[i] >= self.before.values[i], "a count never falls: %s",
                  mct_can_counters[i].name);
    }
    for (int i = 0; i < MCT_FAULT_COUNT; i++) {
        FUZZ_RULE(supervisor->counts[i] >= before->counts[i], "a count never falls: %s",
                  mct_fault_name((mct_fault)i));
    }
    FUZZ_RULE(supervisor->derated_ticks >= before->derated_ticks &&
                  supervisor->limited_ticks >= before->limited_ticks &&
                  supervisor->rearmed >= before->rearmed,
              "a count never falls");
    FUZZ_RULE(self.can.counts.values[MCT_CAN_COUNT_RECEIVED] - self.received_before == self.expected.frames,
              "each frame is counted");
    self.before = self.can.counts;
    self.supervisor_before = *supervisor;
}

static mct_status watched_open(void *context, mct_message *why)
{
    return mct_can_hal(context).ops->open(context, why);
}

static mct_status watched_read(void *context, mct_reading *reading)
{
    const mct_status status = mct_can_hal(context).ops->read(context, reading);
    FUZZ_RULE(status == MCT_OK, "a bus that fails is no HAL that fails");
    FUZZ_RULE((reading->flags & ~ALL_FLAGS) == 0, "flags are known: %x", reading->flags);
    for (int i = 0; i < MCT_MAX_ENCODERS; i++) {
        self.expected.fresh_tick[i] = self.expected.news[i] ? self.can.tick : self.expected.fresh_tick[i];
        self.expected.news[i] = false;
    }
    return status;
}

/* All that has been handed to the host is known to it: what must the voltage be? */
static mct_status watched_write(void *context, mct_real volts)
{
    const mct_supervisor *supervisor = &self.loop.supervisor;
    expectation *expected = &self.expected;
    FUZZ_RULE(isfinite((double)volts), "volts are finite: %g", (double)volts);
    FUZZ_RULE(fabs((double)volts) <= (double)supervisor->limit, "volts are within the limit: %g",
              (double)volts);
    FUZZ_RULE(volts == 0 || supervisor->latched == 0, "volts are zero while a fault is latched: %g",
              (double)volts);
    FUZZ_RULE(volts == 0 || expected->ready, "volts are zero until the drive says that it is ready: %g",
              (double)volts);
    FUZZ_RULE(volts == 0 || self.can.axes.axes[0].state == MCT_CAN_DRIVE_READY, /* the HAL's own */
              "volts are zero while the drive is not ready: %g", (double)volts);
    for (int i = 0; i < mct_systems[self.scene.system]->coordinate_count; i++) {
        const uint64_t age = self.can.lockstep ? (self.can.tick - expected->fresh_tick[i]) * self.can.tick_us
                                               : (uint64_t)(self.ring.now_us - expected->newest_us[i]);
        FUZZ_RULE(volts == 0 || age < 5000,
                  "volts are zero from 5 ms without feedback on: %g V, encoder %d is %llu us old",
                  (double)volts, i, (unsigned long long)age);
    }
    FUZZ_RULE(!expected->estop || supervisor->latched & 1u << MCT_FAULT_ESTOP, "an emergency stop latches");
    FUZZ_RULE(!expected->invalid || supervisor->latched & 1u << MCT_FAULT_SENSOR_INVALID,
              "what is not a number latches");
    FUZZ_RULE(!expected->link_down || supervisor->latched & 1u << MCT_FAULT_LINK_DOWN, "a lost link latches");
    expected->estop = expected->invalid = expected->link_down = false;
    self.writing = true;
    self.written = volts;
    const mct_status status = mct_can_hal(context).ops->write(context, volts);
    self.writing = false;
    check_counts();
    return status;
}

static mct_status watched_wait_tick(void *context)
{
    const int64_t before_us = self.ring.now_us;
    if (self.can.lockstep) {
        const mct_status status = mct_can_hal(context).ops->wait_tick(context);
        FUZZ_RULE(self.ring.now_us - before_us <= 60000, "a wait in lockstep is bounded");
        return status;
    }
    self.bus.ops->wait(self.bus.context, 1000);
    fetch();
    self.can.tick++; /* all that the HAL does here, but for the sleep */
    return MCT_OK;
}

static void watched_stop(void *context)
{
    mct_can_hal(context).ops->stop(context);
    self.expected.ready = false;
    self.expected.stopped = true;
}

static void watched_arm(void *context)
{
    self.expected.ready = !self.can.axes.protocol->has_state; /* one that never tells is taken for ready */
    self.expected.stopped = false;
    mct_can_hal(context).ops->arm(context);
}

static void watched_close(void *context)
{
    mct_can_hal(context).ops->close(context);
}

static const mct_state *watched_plant(void *context)
{
    return mct_can_hal(context).ops->plant(context);
}

static const mct_timing *watched_timing(void *context)
{
    return mct_can_hal(context).ops->timing(context);
}

static mct_counters watched_counters(void *context)
{
    return mct_can_hal(context).ops->counters(context);
}

/* --- a run --- */

/* Over a bus that is not simulated a tick in lockstep waits for the drive's answer. */
static const mct_can_transport_ops between[2] = {
    {
        .simulated = true,
        .name = "fuzz",
        .open = between_open,
        .send = between_send,
        .receive = between_receive,
        .wait = between_wait,
        .now_us = between_now_us,
        .tend = between_tend,
        .close = between_close,
    },
    {
        .simulated = false,
        .name = "fuzz",
        .open = between_open,
        .send = between_send,
        .receive = between_receive,
        .wait = between_wait,
        .now_us = between_now_us,
        .tend = between_tend,
        .close = between_close,
    },
};

static void start(int scene)
{
    static const mct_hal_ops watched = {
        .name = "watched",
        .open = watched_open,
        .read = watched_read,
        .write = watched_write,
        .wait_tick = watched_wait_tick,
        .stop = watched_stop,
        .arm = watched_arm,
        .close = watched_close,
        .plant = watched_plant,
        .timing = watched_timing,
        .counters = watched_counters,
    };
    mct_message why = {""};
    memset(&self, 0, sizeof self);
    self.scene = fuzz_can_scene(scene);
    mct_can_ring_init(&self.ring);
    self.bus = mct_can_ring_end(&self.ring, 0);
    FUZZ_RULE(mct_can_drive_init(&self.drive, &self.scene, mct_can_ring_end(&self.ring, 1), &why) == MCT_OK,
              "the drive of scene %d: %s", scene, why.text);
    mct_can_drive_serve(&self.drive, &self.ring);
    FUZZ_RULE(mct_can_drive_open(&self.drive, &why) == MCT_OK, "the drive of scene %d: %s", scene, why.text);
    FUZZ_RULE(mct_can_init(&self.can, &self.scene, (mct_can_transport){&between[0], NULL}, true, &why) ==
                  MCT_OK,
              "the host of scene %d: %s", scene, why.text);
    const mct_hal hal = {&watched, &self.can};
    FUZZ_RULE(mct_loop_init(&self.loop, &self.plan, &self.scene, hal, NULL, (mct_samples){NULL, 0}, &why) ==
                  MCT_OK,
              "the loop of scene %d: %s", scene, why.text);
    FUZZ_RULE(hal.ops->open(hal.context, &why) == MCT_OK, "the start of scene %d: %s", scene, why.text);
    for (int i = 0; i < self.can.axes.count; i++) {
        self.drives[i] = fuzz_can_device(&self.can.axes, i);
    }
    self.started = true;
    self.expected.ready = true;
    self.before = self.can.counts;
    self.supervisor_before = self.loop.supervisor;
    self.received_before = self.can.counts.values[MCT_CAN_COUNT_RECEIVED];
    for (int i = 0; i < MCT_MAX_ENCODERS; i++) {
        self.expected.fresh_tick[i] = self.can.tick;
        self.expected.newest_us[i] = self.ring.now_us;
    }
}

/* End to end: what a stop does to the motor. A VESC needs time for it, and faults of the drive are its own. */
static void check_motor(void)
{
    const bool reached = !self.deaf && !self.full && self.link == MCT_CAN_UP &&
                         self.scene.can_protocol != MCT_CAN_VESC &&
                         self.scene.can_fault == MCT_CAN_FAULT_NONE;
    self.quiet_ticks = reached && self.loop.supervisor.latched != 0 ? self.quiet_ticks + 1 : 0;
    FUZZ_RULE(isfinite(self.drive.volts), "the motor's volts are finite");
    FUZZ_RULE(self.quiet_ticks < 3 || !self.drive.powered || self.drive.volts == 0,
              "the motor has no volts while a fault is latched: %g", self.drive.volts);
}

static void tick(void)
{
    if (self.ticks >= MOST_TICKS) {
        return;
    }
    self.ticks += self.can.transport.ops->simulated || !self.can.lockstep ? 1 : 4; /* for the time it takes */
    mct_loop_tick(&self.loop);
    const mct_record *record = &self.loop.record;
    FUZZ_RULE(isfinite((double)record->applied) &&
                  fabs((double)record->applied) <= (double)self.loop.supervisor.limit,
              "what is applied is within the limit: %g", (double)record->applied);
    FUZZ_RULE(record->applied == 0 || record->faults == 0, "nothing is applied while a fault is latched");
    check_motor();
    FUZZ_RULE(self.disturbed || record->faults == 0, "a run that nothing disturbs has no fault: %x",
              record->faults);
    FUZZ_RULE(self.disturbed || self.ticks < 40 || record->reading.flags == 0, "nor does its reading: %x",
              record->reading.flags);
    self.older_us = 0;
}

static void put_any(fuzz_bytes *input, uint8_t what)
{
    uint8_t bytes[FUZZ_CAN_FRAME];
    for (int i = 0; i < FUZZ_CAN_FRAME; i++) {
        bytes[i] = fuzz_byte(input);
    }
    mct_can_frame frame = fuzz_can_frame(&self.can.axes, bytes);
    frame.time_us = self.ring.now_us - (what >> 4) * 200;
    const mct_can_filter *filters = self.ring.ports[0].filters; /* a transport brings nothing else */
    if (mct_can_is_wanted(filters, self.ring.ports[0].filter_count, &frame)) {
        put(&frame);
    }
}

static void put_again(fuzz_bytes *input, uint8_t what)
{
    const uint8_t place = fuzz_byte(input), bits = fuzz_byte(input);
    mct_can_frame frame = self.last[what >> 4 & (KINDS - 1)];
    if (self.last_count <= (what >> 4 & (KINDS - 1))) {
        return;
    }
    if (place & 8) {
        frame.time_us = self.ring.now_us;
    }
    frame.data[place & 7] = (uint8_t)(frame.data[place & 7] ^ bits);
    put(&frame);
}

static void operate(fuzz_bytes *input)
{
    const uint8_t what = fuzz_byte(input);
    self.disturbed |= (what & 15) > 2;
    switch (what & 15) {
    case 0:
    case 1:
    case 2: /* some ticks */
        for (int i = 0; i <= what >> 4; i++) {
            tick();
        }
        break;
    case 3:
        self.cut ^= (what & 16) == 0;
        self.echoes ^= (what & 16) != 0;
        tick();
        break;
    case 4:
        self.deaf = !self.deaf;
        tick();
        break;
    case 5:
    case 6: /* a frame beside the drive's */
        put_any(input, what);
        break;
    case 7: /* a frame in their place */
        put_any(input, what);
        self.cut = true;
        tick();
        break;
    case 8: /* bits of one of theirs */
    case 9:
        self.spoilt_frame = what >> 4 & 7;
        self.spoilt_byte = fuzz_byte(input) & 7;
        self.spoilt_bits = fuzz_byte(input);
        tick();
        break;
    case 10: /* one of theirs once more, or nearly so */
        put_again(input, what);
        break;
    case 11:
        mct_loop_rearm(&self.loop);
        tick();
        break;
    case 12: {
        const uint8_t state = fuzz_byte(input);
        self.link = state < 128 ? MCT_CAN_UP : (mct_can_link_state)(state % MCT_CAN_LINK_STATES);
        tick();
        break;
    }
    case 13:
        self.full = !self.full;
        tick();
        break;
    case 14: /* time goes by, or stamps are late */
        if (what & 16) {
            self.older_us = (what >> 5) * 700;
        } else {
            mct_can_ring_advance(&self.ring, (what >> 5) * 900);
        }
        tick();
        break;
    default:
        mct_supervisor_fault(&self.loop.supervisor, MCT_FAULT_STOPPED);
        watched_stop(&self.can);
        tick();
        break;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes input = {data, data + size};
    const int scene = fuzz_byte(&input) % FUZZ_CAN_SCENES;
    const uint8_t fault = fuzz_byte(&input), way = fuzz_byte(&input);
    if (!made[scene]) {
        start(scene);
        memcpy(&starts[scene], &self, sizeof self);
        made[scene] = true;
    }
    memcpy(&self, &starts[scene], sizeof self);
    self.scene.can_fault = fault % FAULTS;
    self.drive.fault_begin = self.drive.sim.plant.tick + (fault >> 5) * 3;
    self.drive.fault_end = self.drive.fault_begin + 1 + (fault >> 4 & 1) * 20;
    self.disturbed = self.scene.can_fault != MCT_CAN_FAULT_NONE;
    self.can.lockstep = way & 1;
    self.can.transport.ops = &between[way >> 2 & 1];
    self.loop.supervisor.rearm_limit = way & 2 ? 10 : 0;
    while (input.at < input.end && self.ticks < MOST_TICKS) {
        operate(&input);
    }
    mct_can_hal(&self.can).ops->close(&self.can);
    return 0;
}

/* For each scene: a plain run; one with each operation; one with each message. */
size_t fuzz_seed(int number, uint8_t *out)
{
    static const uint8_t zero[8] = {0};
    const int kind = number / FUZZ_CAN_SCENES;
    size_t size = 0;
    out[size++] = (uint8_t)(number % FUZZ_CAN_SCENES);
    out[size++] = kind < 5 ? 0 : (uint8_t)(kind - 4 + 32);
    out[size++] = (uint8_t)((kind & 3) + (kind % 5 == 1 ? 4 : 0));
    out[size++] = 0xF0;
    if (kind >= 5 + FAULTS) {
        return 0;
    }
    if (kind == 2) {
        for (int i = 3; i < 16; i++) {
            out[size++] = (uint8_t)(i | (number % 2 == 0 ? 0x20 : 0x10));
            if (i == 8 || i == 9 || i == 10 || i == 12) {
                out[size++] = 0xFF;
                out[size++] = 0x10;
            } else if (i >= 5 && i <= 7) {
                fuzz_can_bytes(0, i, 8, zero, out + size);
                size += FUZZ_CAN_FRAME;
            }
            out[size++] = 0x60;
            out[size++] = 0x0B;
            out[size++] = 0x60;
        }
    } else if (kind == 3) {
        for (int i = 0; i < 9; i++) {
            out[size++] = 5;
            fuzz_can_bytes(i & 1, i, 8, zero, out + size);
            size += FUZZ_CAN_FRAME;
            out[size++] = 0x60;
            out[size++] = 0x0B;
        }
    }
    for (int i = 0; i < 12; i++) {
        out[size++] = kind == 4 && i % 3 == 2 ? 0x0B : 0xF0;
    }
    return size;
}

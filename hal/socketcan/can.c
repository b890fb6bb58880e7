#include "hal/socketcan/can.h"

#include <string.h>

#include "mctau/system.h"

enum {
    MOST_FRAMES = 512,     /* drained at once */
    LISTEN_US = 1000,      /* between looks while listening */
    PATIENCE_US = 50000,   /* in lockstep, for an answer */
    ENOUGH_QUICK = 50,     /* messages that show a period of some ticks */
    ENOUGH_SLOW = 3,       /* of a period far longer than a tick */
    ARMING_US = 1000000,   /* for a drive to get ready */
    ARM_AGAIN_US = 100000, /* between requests */
    ALTERNATIONS = 4       /* of an encoder at rest: two of them */
};

/* --- frames that come --- */

static void count_refused(mct_can *self, mct_can_verdict verdict)
{
    static const struct {
        mct_can_verdict verdict;
        mct_can_count count;
    } meanings[] = {
        {MCT_CAN_IS_FOREIGN, MCT_CAN_COUNT_FOREIGN},       {MCT_CAN_IS_REPEATED, MCT_CAN_COUNT_REPEATED},
        {MCT_CAN_IS_OLDER, MCT_CAN_COUNT_OUT_OF_ORDER},    {MCT_CAN_IS_BAD_LENGTH, MCT_CAN_COUNT_BAD_LENGTH},
        {MCT_CAN_IS_BAD_FORMAT, MCT_CAN_COUNT_BAD_FORMAT}, {MCT_CAN_IS_REMOTE, MCT_CAN_COUNT_REMOTE},
        {MCT_CAN_IS_NOT_FINITE, MCT_CAN_COUNT_NOT_FINITE},
    };
    for (size_t i = 0; i < sizeof meanings / sizeof meanings[0]; i++) {
        if (verdict == meanings[i].verdict) {
            mct_can_counted(&self->counts, meanings[i].count);
        }
    }
    self->invalid |= verdict == MCT_CAN_IS_NOT_FINITE;
}

/* The time from a command to its answer. */
static void note_answer(mct_can *self, const mct_can_encoder *encoder)
{
    const int64_t sent_us = self->sent_us[encoder->echo];
    if (self->axes.protocol->has_echo && encoder->echo != self->answered && sent_us > 0) {
        const int64_t us = encoder->time_us - sent_us;
        self->answered = encoder->echo;
        if (!self->lockstep && us >= 0 && us < UINT32_MAX) {
            mct_histogram_add(&self->clock.timing.round_trip, (uint32_t)us);
        }
    }
}

/* Gives a frame to the drive that it belongs to. */
static mct_can_verdict take(mct_can *self, const mct_can_frame *frame)
{
    mct_can_verdict verdict = MCT_CAN_IS_FOREIGN;
    for (int i = 0; i < self->axes.count && verdict == MCT_CAN_IS_FOREIGN; i++) {
        mct_can_axis *axis = &self->axes.axes[i];
        const mct_can_drive_state before = axis->state;
        verdict = self->axes.protocol->hear(axis, frame);
        if (axis->state == MCT_CAN_DRIVE_FAULTY && before != MCT_CAN_DRIVE_FAULTY && !self->stopped) {
            mct_can_counted(&self->counts, MCT_CAN_COUNT_DRIVE_FAULTS);
        }
        for (int j = 0; verdict == MCT_CAN_IS_FEEDBACK && j < MCT_CAN_ENCODERS; j++) {
            note_answer(self, &axis->encoders[j]);
        }
    }
    if (verdict == MCT_CAN_IS_STOP) {
        mct_can_counted(&self->counts, MCT_CAN_COUNT_EMERGENCY_STOPS);
        self->estop = true;
    }
    count_refused(self, verdict);
    return verdict;
}

/* Takes in all that has come. */
static void drain(mct_can *self)
{
    const mct_can_transport *transport = &self->transport;
    mct_can_frame frame;
    for (int i = 0; i < MOST_FRAMES && transport->ops->receive(transport->context, &frame); i++) {
        mct_can_counted(&self->counts, MCT_CAN_COUNT_RECEIVED);
        take(self, &frame);
    }
}

/* --- frames that go --- */

static bool send(mct_can *self, const mct_can_frame *frame)
{
    return self->transport.ops->send(self->transport.context, frame);
}

static void send_all(mct_can *self, const mct_can_frame *frames, int count)
{
    for (int i = 0; i < count; i++) {
        send(self, &frames[i]);
    }
}

static void command(mct_can *self, mct_real volts)
{
    mct_can_axis *axis = &self->axes.axes[0];
    mct_can_frame frame;
    self->axes.protocol->command(axis, volts, !self->stopped, &frame);
    const int64_t now = self->transport.ops->now_us(self->transport.context);
    self->sent_us[axis->sequence] = send(self, &frame) ? now : 0;
}

static void ask_to_arm(mct_can *self)
{
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    for (int i = 0; i < self->axes.count; i++) {
        send_all(self, frames, self->axes.protocol->arm(&self->axes.axes[i], frames));
    }
}

/* --- a tick --- */

/* Time since the newest counts of an encoder were captured. */
static uint32_t age_of(mct_can *self, int coordinate, const mct_can_encoder *encoder,
                       const mct_can_axis *axis)
{
    uint64_t age = (self->tick - self->fresh_tick[coordinate]) * self->tick_us;
    if (!self->lockstep) {
        const int64_t us = self->transport.ops->now_us(self->transport.context) - encoder->time_us;
        age = us > 0 ? (uint64_t)us : 0;
    }
    /* Feedback that answers an old command is as old as that, whenever it came; one tick may be on its way. */
    if (self->axes.protocol->has_echo && encoder->used) {
        const uint8_t behind = (uint8_t)(self->axes.axes[0].sequence - encoder->echo);
        const uint64_t at_least = (uint64_t)behind * self->tick_us;
        if (axis == &self->axes.axes[0] && behind >= 2 && at_least > age) {
            mct_can_counted(&self->counts, MCT_CAN_COUNT_ANSWER_LATE);
            age = at_least;
        }
    }
    return age < UINT32_MAX ? (uint32_t)age : UINT32_MAX;
}

static void read_encoders(mct_can *self, mct_reading *reading)
{
    for (int i = 0; i < self->encoder_count; i++) {
        mct_can_axis *axis;
        const mct_can_encoder *encoder = mct_can_encoder_of(&self->axes, i, &axis);
        const uint32_t news = encoder->updates - self->updates[i];
        if (news > 0) {
            self->updates[i] = encoder->updates;
            self->fresh_tick[i] = self->tick;
            reading->counts[i] = encoder->counts;
            mct_hal_count(&self->counts.values[MCT_CAN_COUNT_SKIPPED], news - 1);
        } else {
            mct_can_counted(&self->counts, MCT_CAN_COUNT_NO_FEEDBACK);
            reading->flags |= MCT_READING_MISSING;
        }
        const uint32_t age = age_of(self, i, encoder, axis);
        reading->age_us = age > reading->age_us ? age : reading->age_us;
    }
}

/* While drives get ready they are asked again now and then, and what they say about themselves is no fault yet. */
static void follow_arming(mct_can *self)
{
    const uint32_t again = ARM_AGAIN_US / self->tick_us + 1;
    if (self->arming_ticks == 0) {
        return;
    }
    if (self->axes.axes[0].state == MCT_CAN_DRIVE_READY) {
        self->arming_ticks = 0;
    } else if (--self->arming_ticks == 0) {
        self->arming_failed = true;
    } else if (self->arming_ticks % again == 0) {
        ask_to_arm(self);
    }
}

static void read_drives(mct_can *self, mct_reading *reading)
{
    const mct_can_axes *axes = &self->axes;
    follow_arming(self);
    if (self->stopped || axes->axes[0].state != MCT_CAN_DRIVE_READY) {
        reading->flags |= MCT_READING_NOT_READY;
    }
    for (int i = 0; i < axes->count; i++) {
        const mct_can_axis *axis = &axes->axes[i];
        if (axis->state == MCT_CAN_DRIVE_FAULTY && !self->stopped && self->arming_ticks == 0) {
            reading->flags |= MCT_READING_DRIVE_FAULT;
        }
        if (axis->restarts != self->restarts[i]) {
            self->restarts[i] = axis->restarts;
            mct_can_counted(&self->counts, MCT_CAN_COUNT_DRIVE_RESTARTS);
            reading->flags |= MCT_READING_RESTARTED;
        }
    }
    if (self->arming_failed && !self->stopped) {
        reading->flags |= MCT_READING_DRIVE_FAULT;
    }
}

static void send_stop(mct_can *self)
{
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    send_all(self, frames, self->axes.protocol->stop(&self->axes.axes[0], frames));
}

/* A stop that was called while the link was down has not been heard. */
static void tend(mct_can *self)
{
    const bool was_down = self->link != MCT_CAN_UP;
    self->link = self->transport.ops->tend(self->transport.context);
    if (was_down && self->link == MCT_CAN_UP && self->stopped) {
        send_stop(self);
    }
}

static mct_status can_read(void *context, mct_reading *reading)
{
    mct_can *self = context;
    tend(self);
    drain(self);
    *reading = self->reading;
    reading->flags = 0;
    reading->age_us = 0;
    read_encoders(self, reading);
    read_drives(self, reading);
    reading->flags |= self->invalid ? (uint32_t)MCT_READING_INVALID : 0;
    reading->flags |= self->estop ? (uint32_t)MCT_READING_ESTOP : 0;
    reading->flags |= self->link != MCT_CAN_UP ? (uint32_t)MCT_READING_LINK_DOWN : 0;
    self->invalid = false;
    self->estop = false;
    self->reading = *reading;
    return MCT_OK;
}

static mct_status can_write(void *context, mct_real volts)
{
    mct_can *self = context;
    command(self, self->stopped ? 0 : volts);
    return MCT_OK; /* a command that the bus does not take is counted, and the drive's watchdog knows */
}

/* Whether every encoder has said something since the last command. */
static bool is_answered(mct_can *self)
{
    for (int i = 0; i < self->encoder_count; i++) {
        mct_can_axis *axis;
        const mct_can_encoder *encoder = mct_can_encoder_of(&self->axes, i, &axis);
        const bool answers = !self->axes.protocol->has_echo || axis != &self->axes.axes[0] ||
                             encoder->echo == self->axes.axes[0].sequence;
        if (encoder->updates == self->updates[i] || !answers) {
            return false;
        }
    }
    return true;
}

static mct_status can_wait_tick(void *context)
{
    mct_can *self = context;
    const mct_can_transport *transport = &self->transport;
    mct_status status = MCT_OK;
    if (!self->lockstep) {
        status = mct_clock_wait(&self->clock);
    } else {
        int64_t left_us = transport->ops->simulated ? (int64_t)self->tick_us : PATIENCE_US;
        const int64_t end_us = transport->ops->now_us(transport->context) + left_us;
        for (int i = 0; i < MOST_FRAMES && left_us > 0 && !is_answered(self); i++) {
            transport->ops->wait(transport->context, left_us);
            drain(self);
            left_us = end_us - transport->ops->now_us(transport->context);
        }
    }
    self->tick++;
    return status;
}

static void can_stop(void *context)
{
    mct_can *self = context;
    send_stop(self);
    self->stopped = true;
    self->arming_ticks = 0;
    self->arming_failed = false;
    mct_can_counted(&self->counts, MCT_CAN_COUNT_STOPS_SENT);
}

static void can_arm(void *context)
{
    mct_can *self = context;
    self->stopped = false;
    self->arming_failed = false;
    self->arming_ticks = ARMING_US / self->tick_us + 1;
    for (int i = 0; i < self->axes.count && self->axes.protocol->has_state; i++) {
        self->axes.axes[i].state = MCT_CAN_DRIVE_UNKNOWN; /* until it says so anew */
    }
    mct_can_counted(&self->counts, MCT_CAN_COUNT_ARMINGS);
    ask_to_arm(self);
}

static void can_close(void *context)
{
    mct_can *self = context;
    if (!self->stopped) {
        can_stop(self);
    }
    self->transport.ops->close(self->transport.context);
}

static const mct_state *can_plant(void *context)
{
    const mct_can *self = context;
    return self->plant;
}

static const mct_timing *can_timing(void *context)
{
    const mct_can *self = context;
    return &self->clock.timing;
}

static mct_counters can_counters(void *context)
{
    const mct_can *self = context;
    return (mct_counters){MCT_CAN_COUNTS, mct_can_counters, self->counts.values};
}

/* --- the start --- */

static double allowed_period(const mct_can *self, const mct_can_message *message)
{
    return message->slowest != 0 ? message->slowest : 3 * self->dt;
}

/* All cyclic messages of the drives, and the load that they and the commands make. */
static void plan(mct_can *self)
{
    const mct_can_protocol *protocol = self->axes.protocol;
    mct_can_report *report = &self->report;
    double nominal = 0;
    double stuffed = 0;
    memset(report, 0, sizeof *report);
    for (int i = 0; i < self->axes.count; i++) {
        const mct_can_axis *axis = &self->axes.axes[i];
        for (int j = 0; j < protocol->message_count; j++) {
            const mct_can_message *message = &protocol->messages[j];
            if ((message->of & axis->roles) == 0 || message->period < 0) {
                continue;
            }
            const double period = message->period > 0 ? message->period : self->dt;
            nominal += mct_can_nominal_bits(protocol->extended, message->length) / period;
            stuffed += mct_can_stuffed_bits(protocol->extended, message->length) / period;
            if (message->from_drive) {
                report->heard[report->heard_count++] = (mct_can_heard){
                    .message = message,
                    .node = axis->node,
                    .id = protocol->identifier(message->code, axis->node),
                    .slowest = allowed_period(self, message),
                };
            }
        }
    }
    report->nominal_load = nominal / self->scene->can_bitrate;
    report->load = stuffed / self->scene->can_bitrate;
    report->watchdog_tells = protocol->has_state;
}

mct_status mct_can_init(mct_can *self, const mct_scene *scene, mct_can_transport transport, bool lockstep,
                        mct_message *why)
{
    memset(self, 0, sizeof *self);
    self->transport = transport;
    self->scene = scene;
    self->lockstep = lockstep;
    self->dt = scene->dt;
    self->encoder_count = mct_systems[scene->system]->coordinate_count;
    self->tick_us = scene->dt < 1e-6 ? 1 : (uint32_t)(scene->dt * 1e6 + 0.5);
    const mct_status status = mct_can_axes_init(&self->axes, scene, why);
    if (status != MCT_OK) {
        return status;
    }
    plan(self);
    if (self->report.load > scene->can_highest_load) {
        mct_message_clear(why);
        mct_message_add(why, "can.bitrate: found ");
        mct_message_add_integer(why, scene->can_bitrate);
        mct_message_add(why, " bit/s, of which the messages of this scene take up to ");
        mct_message_add_number(why, (double)(int)(100 * self->report.load + 0.5));
        mct_message_add(why, " %; allowed ");
        mct_message_add_number(why, 100 * scene->can_highest_load);
        mct_message_add(why, " % (can.highest_load): a faster bus, a longer tick (scene.dt) or fewer drives");
        return MCT_ERROR_RANGE;
    }
    return MCT_OK;
}

/* Everything that the drives can say to this host. */
static int list_filters(const mct_can *self, mct_can_filter filters[MCT_CAN_MAX_FILTERS])
{
    const mct_can_protocol *protocol = self->axes.protocol;
    int count = 0;
    for (int i = 0; i < self->axes.count; i++) {
        for (int j = 0; j < protocol->message_count; j++) {
            const mct_can_message *message = &protocol->messages[j];
            if (message->from_drive && count < MCT_CAN_MAX_FILTERS) {
                filters[count++] = (mct_can_filter){
                    protocol->identifier(message->code, self->axes.axes[i].node), protocol->extended};
            }
        }
    }
    return count;
}

static void note_heard(mct_can *self, const mct_can_frame *frame)
{
    for (int i = 0; i < self->report.heard_count; i++) {
        mct_can_heard *heard = &self->report.heard[i];
        if (heard->id == frame->id && !frame->remote && frame->extended == self->axes.protocol->extended) {
            heard->first_us = heard->count == 0 ? frame->time_us : heard->first_us;
            heard->last_us = frame->time_us;
            heard->count++;
        }
    }
}

static bool has_heard_enough(const mct_can *self)
{
    for (int i = 0; i < self->report.heard_count; i++) {
        const mct_can_heard *heard = &self->report.heard[i];
        const bool quick = heard->message->period == 0;
        if (heard->count < (quick ? ENOUGH_QUICK : ENOUGH_SLOW)) {
            return false;
        }
    }
    return true;
}

/* Lets a millisecond pass, hearing what comes until `done`: what is said for a moment only is not missed. */
static bool listen_a_while(mct_can *self, bool (*done)(const mct_can *self))
{
    const mct_can_transport *transport = &self->transport;
    mct_can_frame frame;
    transport->ops->wait(transport->context, LISTEN_US);
    self->link = transport->ops->tend(transport->context);
    for (int i = 0; i < MOST_FRAMES && !done(self) && transport->ops->receive(transport->context, &frame);
         i++) {
        mct_can_counted(&self->counts, MCT_CAN_COUNT_RECEIVED);
        note_heard(self, &frame);
        take(self, &frame);
    }
    return done(self);
}

/* Lets time pass until `done`, at most `seconds`. The number of looks is bounded as well: a clock may stand. */
static bool listen_until(mct_can *self, double seconds, bool (*done)(const mct_can *self))
{
    const mct_can_transport *transport = &self->transport;
    const int64_t begin = transport->ops->now_us(transport->context);
    const int64_t most_us = (int64_t)(seconds * 1e6);
    const int most_looks = (int)(seconds * 1e6 / LISTEN_US) * 100;
    bool is_done = done(self);
    for (int i = 0;
         i < most_looks && !is_done && transport->ops->now_us(transport->context) - begin < most_us; i++) {
        is_done = listen_a_while(self, done);
    }
    return is_done;
}

static void add_message(mct_message *why, const mct_can_heard *heard)
{
    mct_message_add(why, "node ");
    mct_message_add_integer(why, heard->node);
    mct_message_add(why, ": ");
    mct_message_add(why, heard->message->name);
}

static bool never(const mct_can *self)
{
    (void)self;
    return false;
}

/* What the errors on the bus mean when nothing is heard. */
static void explain_silence(mct_can *self, mct_message *why)
{
    const uint64_t *counts = self->counts.values;
    command(self, 0); /* does anybody acknowledge? */
    listen_until(self, 0.1, never);
    if (self->link != MCT_CAN_UP && self->link != MCT_CAN_UNSENT) {
        mct_message_add(why, mct_can_link_text(self->link));
    } else if (counts[MCT_CAN_COUNT_BUS_ERRORS] + counts[MCT_CAN_COUNT_ERROR_PASSIVE] > 0) {
        mct_message_add(why, "the bus carries errors: look for a wrong bit rate, wiring or termination");
    } else if (counts[MCT_CAN_COUNT_NO_ACKNOWLEDGE] > 0 || self->link == MCT_CAN_UNSENT) {
        mct_message_add(
            why, "nobody on the bus acknowledges: look at the drive's supply, the wiring and the bit rate");
    } else {
        mct_message_add(why,
                        "look at the drive's supply, its node number (can.node), its protocol (can.protocol) "
                        "and its bit rate");
    }
}

/* Says which message is missing or too slow; false when one is. */
static bool check_heard(mct_can *self, mct_message *why)
{
    mct_can_report *report = &self->report;
    const bool is_paced =
        !self->lockstep || self->transport.ops->simulated; /* else by how busy the machine is */
    uint64_t all = 0;
    for (int i = 0; i < report->heard_count; i++) {
        mct_can_heard *heard = &report->heard[i];
        all += heard->count;
        heard->period = heard->count > 1
                            ? 1e-6 * (double)(heard->last_us - heard->first_us) / (double)(heard->count - 1)
                            : 0;
    }
    for (int i = 0; i < report->heard_count; i++) {
        const mct_can_heard *heard = &report->heard[i];
        if (heard->count == 0) {
            add_message(why, heard);
            mct_message_add(why, " has not come within ");
            mct_message_add_number(why, self->scene->can_startup);
            mct_message_add(why, " s; ");
            if (all == 0) {
                mct_message_add(why, "nor has any other of its messages: ");
                explain_silence(self, why);
            } else {
                mct_message_add(
                    why, "other messages have: switch this one on in the drive, or look at its node number");
            }
            return false;
        }
        if (is_paced && (heard->period > heard->slowest || heard->count < 2)) {
            add_message(why, heard);
            mct_message_add(why, " comes every ");
            mct_message_add_number(why, 0.01 * (double)(int64_t)(1e5 * heard->period + 0.5)); /* [ms] */
            mct_message_add(why, " ms; allowed up to ");
            mct_message_add_number(why, 1e3 * heard->slowest);
            mct_message_add(why, " ms: set its rate in the drive");
            return false;
        }
    }
    return true;
}

/* Two drives under one number, each with a serial number or a position of its own: the encoder jumps to and fro. */
static bool check_alone(mct_can *self, mct_message *why)
{
    for (int i = 0; i < self->axes.count; i++) {
        const mct_can_axis *axis = &self->axes.axes[i];
        if (axis->serial_changes > 0 || axis->alternations >= ALTERNATIONS) {
            mct_message_add(why, "node ");
            mct_message_add_integer(why, axis->node);
            mct_message_add(why,
                            ": found two drives with this number; allowed one: give the other one its own");
            return false;
        }
    }
    return true;
}

static bool is_ready(const mct_can *self)
{
    return self->axes.axes[0].state == MCT_CAN_DRIVE_READY;
}

static bool has_watchdog_acted(const mct_can *self)
{
    return self->axes.axes[0].watchdog_expired;
}

/* Zero volts, ready. */
static bool get_ready(mct_can *self, mct_message *why)
{
    const uint64_t received = self->counts.values[MCT_CAN_COUNT_RECEIVED];
    bool ready = false;
    can_arm(self);
    for (int i = 0; i < ARMING_US / ARM_AGAIN_US && !ready; i++) {
        ready = listen_until(self, 1e-6 * ARM_AGAIN_US, is_ready);
        if (!ready) {
            ask_to_arm(self);
        }
    }
    self->arming_ticks = 0;
    if (!ready) {
        const mct_can_axis *axis = &self->axes.axes[0];
        mct_message_add(why, "node ");
        mct_message_add_integer(why, axis->node);
        mct_message_add(why, ": the drive does not get ready");
        if (self->counts.values[MCT_CAN_COUNT_RECEIVED] == received) {
            mct_message_add(why,
                            ": nothing has come since it was asked to; look at its supply and its wiring");
            return false;
        }
        if (axis->error != 0) {
            mct_message_add(why, ", it reports error ");
            mct_message_add_integer(why, axis->error);
        }
        mct_message_add(why, "; look at its control mode, its calibration and its errors");
    }
    return ready;
}

/* The drive must stop by itself when commands cease: tried here, at zero volts, where it tells. */
static bool check_watchdog(mct_can *self, mct_message *why)
{
    const double timeout = self->scene->can_watchdog;
    if (!self->axes.protocol->has_state || timeout == 0) {
        return true;
    }
    if (!listen_until(self, 2 * timeout + 0.5, has_watchdog_acted)) {
        mct_message_add(why, "node ");
        mct_message_add_integer(why, self->axes.axes[0].node);
        mct_message_add(why, ": its watchdog did not act within ");
        mct_message_add_number(why, 2 * timeout + 0.5);
        mct_message_add(why, " s without commands; set the drive's own watchdog to ");
        mct_message_add_number(why, timeout);
        mct_message_add(why, " s (can.watchdog); or another drive or host with this number feeds it");
        return false;
    }
    self->report.watchdog_verified = true;
    return get_ready(self, why);
}

static mct_status start(mct_can *self, mct_message *why)
{
    listen_until(self, self->scene->can_startup, has_heard_enough);
    if (!check_heard(self, why) || !check_alone(self, why) || !get_ready(self, why) ||
        !check_watchdog(self, why)) {
        return MCT_ERROR_IO;
    }
    self->report.bus_voltage = mct_can_bus_voltage(&self->axes.axes[0]);
    command(self, 0);
    for (int i = 0; i < self->axes.count; i++) {
        self->restarts[i] = self->axes.axes[i].restarts;
    }
    for (int i = 0; i < self->encoder_count; i++) {
        mct_can_axis *axis;
        self->updates[i] =
            mct_can_encoder_of(&self->axes, i, &axis)->updates - 1; /* the newest is yet to be read */
    }
    self->invalid = false;
    self->estop = false;
    memset(&self->counts, 0, sizeof self->counts); /* what the start has tried on purpose is no news */
    return MCT_OK;
}

static mct_status can_open(void *context, mct_message *why)
{
    mct_can *self = context;
    mct_message reason;
    mct_can_filter filters[MCT_CAN_MAX_FILTERS];
    mct_message_clear(&reason);
    self->stopped = true;
    plan(self); /* afresh, whatever an attempt before has heard */
    mct_status status = self->transport.ops->open(self->transport.context, filters,
                                                  list_filters(self, filters), &self->counts, &reason);
    if (status == MCT_OK) {
        status = start(self, &reason);
        if (status != MCT_OK) {
            can_close(self);
        }
    }
    if (status != MCT_OK) {
        mct_message_add(why, "scene.hal: ");
        mct_message_add(why, reason.text);
    }
    if (!self->lockstep) {
        mct_clock_start(&self->clock, self->dt);
    }
    return status;
}

mct_hal mct_can_hal(mct_can *self)
{
    static const mct_hal_ops ops = {
        .name = "can",
        .open = can_open,
        .read = can_read,
        .write = can_write,
        .wait_tick = can_wait_tick,
        .stop = can_stop,
        .arm = can_arm,
        .close = can_close,
        .plant = can_plant,
        .timing = can_timing,
        .counters = can_counters,
    };
    return (mct_hal){&ops, self};
}

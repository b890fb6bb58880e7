#include "hal/socketcan/drive.h"

#include <string.h>

#include "hal/socketcan/codec.h"

enum { MOST_FRAMES = 512 /* taken in at once */ };

static const double vesc_highest_duty = 0.95;
static const double vesc_slowness = 1.1; /* its status loop, by the period that it is set to */
static const double reboot_time = 0.05;  /* [s] */
static const double root_of_3 = 1.7320508075688772;
static const double room_temperature = 25; /* [degree Celsius] */

/* --- small questions --- */

static bool is_vesc(const mct_can_device *device)
{
    return device->protocol == &mct_can_vesc;
}

static bool is_native(const mct_can_device *device)
{
    return device->protocol == &mct_can_native;
}

static bool is_odrive(const mct_can_device *device)
{
    return device->protocol == &mct_can_odrive || device->protocol == &mct_can_odrive_0_5;
}

/* True while the scene's fault lasts. */
static bool is_spoilt(const mct_can_drive *self)
{
    const uint64_t tick = self->sim.plant.tick;
    return self->released && tick >= self->fault_begin && tick < self->fault_end;
}

static bool has_fault(const mct_can_drive *self, int32_t fault)
{
    return self->scene->can_fault == fault && is_spoilt(self);
}

static bool is_dark(const mct_can_drive *self, int device)
{
    return self->boards[device].dark_until > 0;
}

static double clamp(double value, double limit)
{
    return value > limit ? limit : value < -limit ? -limit : value;
}

static const mct_motor *windings(const mct_can_drive *self)
{
    return self->sim.plant.system->actuation->motor(&self->sim.plant.constants);
}

static double back_emf(const mct_can_drive *self)
{
    const mct_system *system = self->sim.plant.system;
    const int rate = system->coordinate_count + system->actuation->driven_coordinate;
    return (double)windings(self)->emf * mct_plant_value(&self->sim.plant, rate);
}

/* --- the sensors --- */

/* As wide as the scene's counters are. */
static int32_t wrapped(const mct_can_drive *self, int64_t counts)
{
    const uint32_t counter = (uint32_t)(uint64_t)counts << self->sim.counter_shift;
    return (int32_t)counter >> self->sim.counter_shift;
}

/* Rates go the way of the counts: as late, and held while these are. To a count a second. */
static void sense_rates(mct_can_drive *self)
{
    enum { SIZE = MCT_MAX_LATENCY + 1 };
    const mct_sim *sim = &self->sim;
    const uint64_t tick = sim->plant.tick;
    const uint64_t late = tick < sim->latency ? tick : sim->latency;
    const bool frozen =
        sim->fault == MCT_SENSOR_FAULT_FROZEN && tick >= sim->fault_begin && tick < sim->fault_end;
    const int n = sim->plant.system->coordinate_count;
    for (int i = 0; i < n; i++) {
        const mct_sim_encoder *encoder = &sim->encoders[i];
        const double unit_counts = (double)encoder->unit_counts + (double)encoder->unit_rest;
        const double rate = mct_plant_value(&sim->plant, n + i) * unit_counts;
        self->rates[tick % SIZE][i] = (double)(int64_t)(rate < 0 ? rate - 0.5 : rate + 0.5);
        if (!frozen && !(self->reading.flags & MCT_READING_NO_COUNTS)) {
            self->rate[i] = self->rates[(tick - late) % SIZE][i];
        }
    }
}

/* Once a tick of the mechanism: noise and latency go by it. */
static void sense(mct_can_drive *self)
{
    const mct_hal hal = mct_sim_hal(&self->sim);
    hal.ops->read(hal.context, &self->reading);
    sense_rates(self);
    for (int i = 0; i < self->device_count; i++) {
        mct_can_drive_board *board = &self->boards[i];
        for (int j = 0; j < MCT_CAN_ENCODERS; j++) {
            const mct_can_encoder *encoder = &self->axes.axes[i].encoders[j];
            if (encoder->used) {
                const int32_t counts = self->reading.counts[encoder->coordinate];
                board->position[j] += wrapped(self, (int64_t)counts - board->sensed[j]);
                board->sensed[j] = counts;
            }
        }
    }
}

/* --- what a drive is told --- */

static void disarm(mct_can_device *device)
{
    device->wants_ready = false;
    device->wish = MCT_CAN_WISH_RELEASE;
    device->value = 0;
}

/* Stops and pardons act at once, in the order in which they came. */
static void heed(mct_can_drive *self, mct_can_device *device)
{
    if (device->wants_stop) {
        device->wants_stop = false;
        device->estopped = true;
        self->result.stops++;
        disarm(device);
    }
    if (device->wants_clear) {
        device->wants_clear = false;
        device->estopped = false;
        device->watchdog_expired = false;
        device->restarted = false;
        device->error = 0;
    }
}

static void count_refused(mct_can_drive *self, mct_can_verdict verdict)
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
    self->result.refused += verdict >= MCT_CAN_IS_BAD_LENGTH;
}

static bool is_command(mct_can_verdict verdict)
{
    return verdict == MCT_CAN_IS_COMMAND || verdict == MCT_CAN_IS_OLDER || verdict == MCT_CAN_IS_REPEATED;
}

/* What a frame would be, heard by a drive; nothing changes. */
static mct_can_verdict classify(const mct_can_device *device, const mct_can_frame *frame)
{
    mct_can_device copy = *device;
    return copy.protocol->obey(&copy, frame);
}

/* True when a fault keeps a drive from hearing a frame. */
static bool is_swallowed(const mct_can_drive *self, int device, mct_can_verdict verdict)
{
    return is_dark(self, device) || (has_fault(self, MCT_CAN_FAULT_DROP_COMMANDS) && is_command(verdict));
}

/* Gives a frame to the drive that it is for. Returns whether it is a command, obeyed or not. */
static bool hear(mct_can_drive *self, const mct_can_frame *frame)
{
    mct_can_verdict verdict = MCT_CAN_IS_FOREIGN;
    mct_can_counted(&self->counts, MCT_CAN_COUNT_RECEIVED);
    for (int i = 0; i < self->device_count && verdict == MCT_CAN_IS_FOREIGN; i++) {
        mct_can_device *device = &self->devices[i];
        verdict = classify(device, frame);
        if (verdict == MCT_CAN_IS_FOREIGN) {
            continue;
        }
        if (is_swallowed(self, i, verdict)) {
            self->result.spoilt++;
            return is_command(verdict);
        }
        device->protocol->obey(device, frame);
        heed(self, device);
        const bool feeds =
            verdict == MCT_CAN_IS_COMMAND || (verdict == MCT_CAN_IS_REQUEST && is_odrive(device));
        self->boards[i].fed = feeds ? self->tick : self->boards[i].fed;
        self->result.commands += verdict == MCT_CAN_IS_COMMAND;
        self->result.old_commands += verdict == MCT_CAN_IS_OLDER || verdict == MCT_CAN_IS_REPEATED;
    }
    count_refused(self, verdict);
    return is_command(verdict);
}

static void drain(mct_can_drive *self)
{
    const mct_can_transport *transport = &self->transport;
    mct_can_frame frame;
    for (int i = 0; i < MOST_FRAMES && transport->ops->receive(transport->context, &frame); i++) {
        hear(self, &frame);
    }
}

bool mct_can_drive_wait(mct_can_drive *self, int64_t timeout_us)
{
    const mct_can_transport *transport = &self->transport;
    const int64_t begin = transport->ops->now_us(transport->context);
    mct_can_frame frame;
    for (int i = 0; i < MOST_FRAMES; i++) {
        bool found = false;
        while (!found && transport->ops->receive(transport->context, &frame)) {
            found = hear(self, &frame);
        }
        const int64_t left = begin + timeout_us - transport->ops->now_us(transport->context);
        if (found || left <= 0 || !transport->ops->wait(transport->context, left)) {
            return found;
        }
    }
    return false;
}

/* --- the rules of a drive --- */

/* What it may do, by all that it knows. */
static void settle(mct_can_device *device)
{
    const bool is_held = device->estopped || device->watchdog_expired || device->error != 0;
    /* One of ours that has restarted waits until its host has noticed. */
    const bool is_new = is_native(device) && device->restarted;
    const bool is_asked = device->wants_ready && (device->roles & MCT_CAN_OF_MOTOR);
    device->state = is_held               ? MCT_CAN_DRIVE_FAULTY
                    : is_asked && !is_new ? MCT_CAN_DRIVE_READY
                                          : MCT_CAN_DRIVE_IDLE;
    if (device->state == MCT_CAN_DRIVE_READY) {
        device->restarted = false;
        device->has_driven = true;
    }
}

/* A native drive has it from its host, the others from their configuration. */
static double watchdog_of(const mct_can_device *device)
{
    return is_native(device) ? 1e-3 * device->watchdog_ms : device->scene->can_watchdog;
}

/* The motor's drive stops by itself when its commands cease. */
static void watch(mct_can_drive *self)
{
    mct_can_device *device = &self->devices[0];
    const double timeout = watchdog_of(device);
    const double waited = (double)(self->tick - self->boards[0].fed) * self->sim.dt;
    if (device->state == MCT_CAN_DRIVE_READY && timeout > 0 && waited >= timeout - 1e-9) {
        device->watchdog_expired =
            device->protocol->has_state; /* one that does not tell goes on when it hears */
        disarm(device);
        self->result.watchdog_trips++;
    }
}

/* Everything that a drive knows when it starts. */
static void boot(mct_can_drive *self, int number)
{
    mct_can_device *device = &self->devices[number];
    mct_can_drive_board *board = &self->boards[number];
    const mct_can_axis *axis = &self->axes.axes[number];
    memset(device, 0, sizeof *device);
    *device = (mct_can_device){
        .protocol = axis->protocol,
        .scene = axis->scene,
        .node = axis->node,
        .roles = axis->roles,
        .serial = (uint16_t)(1000 + axis->node),
        .wish = MCT_CAN_WISH_RELEASE,
        .state = MCT_CAN_DRIVE_IDLE,
        .restarted = true,
        .supply = self->axes.axes[0].motor.supply,
        .temperature = room_temperature,
        .counts_per_turn =
            mct_can_nearest(mct_can_magnitude(axis->encoders[0].counts_per_turn), 0, INT32_MAX),
    };
    board->booted = self->tick;
    board->fed = self->tick;
    board->duty = 0;
    for (int j = 0; j < MCT_CAN_ENCODERS; j++) {
        board->position[j] = 0;
    }
    for (int j = 0; j < MCT_CAN_MAX_MESSAGES; j++) {
        board->due[j] = (double)(self->tick + 1) * self->sim.dt; /* at the end of this tick */
    }
}

/* Code of a fault of the power stage. */
static uint32_t error_of(const mct_can_device *device)
{
    const uint32_t other = 255, drv_fault = 0x20, motor_failed = 0x40;
    return device->protocol == &mct_can_odrive       ? drv_fault
           : device->protocol == &mct_can_odrive_0_5 ? motor_failed
                                                     : other;
}

/* The first tick of a fault. */
static bool begins(const mct_can_drive *self, int32_t fault)
{
    return has_fault(self, fault) && self->sim.plant.tick == self->fault_begin;
}

static void start_reboot(mct_can_drive *self)
{
    const double duration = self->scene->can_fault_duration;
    if (!begins(self, MCT_CAN_FAULT_REBOOT) || is_dark(self, 0)) {
        return;
    }
    const double seconds = duration > reboot_time ? duration : reboot_time;
    for (int i = 0; i < self->device_count; i++) {
        self->boards[i].dark_until = self->tick + (uint64_t)(seconds / self->sim.dt + 0.5);
        disarm(&self->devices[i]);
    }
}

/* Faults that befall the drives themselves. */
static void suffer(mct_can_drive *self)
{
    mct_can_device *device = &self->devices[0];
    const bool stop = has_fault(self, MCT_CAN_FAULT_ESTOP);
    const bool error = has_fault(self, MCT_CAN_FAULT_ERROR);
    if (is_vesc(device)) {
        device->error = stop || error;
    } else if (error) {
        device->error = error_of(device);
        disarm(device);
    } else if (begins(self, MCT_CAN_FAULT_ESTOP)) {
        device->wants_stop = true;
        heed(self, device);
        self->calls_stop = true;
    }
    start_reboot(self);
}

/* Drives that have been dark for long enough come up. */
static void wake(mct_can_drive *self)
{
    for (int i = 0; i < self->device_count; i++) {
        if (is_dark(self, i) && self->tick >= self->boards[i].dark_until) {
            self->boards[i].dark_until = 0;
            boot(self, i);
        }
    }
}

/* --- volts at the motor --- */

/* In the drive's sense of turning. A current follows its command within the tick, but for the inductance. */
static double volts_of_current(const mct_can_drive *self, double amperes)
{
    const double sense_of_turning = self->axes.axes[0].motor.inverted ? -1 : 1;
    return (double)windings(self)->resistance * amperes + sense_of_turning * back_emf(self);
}

/* Duty moves at the pace that it is set to. */
static double ramped(mct_can_drive *self, double wanted)
{
    mct_can_drive_board *board = &self->boards[0];
    const double step = self->scene->can_duty_ramp * self->sim.dt;
    const double duty = clamp(wanted, vesc_highest_duty);
    board->duty += clamp(duty - board->duty, step);
    return board->duty;
}

/* Volts that the bridge is to put on the motor; false when it is to let it run free. */
static bool follow(mct_can_drive *self, double *volts)
{
    mct_can_device *device = &self->devices[0];
    const mct_can_motor *motor = &self->axes.axes[0].motor;
    const bool foc = self->scene->can_mode == MCT_CAN_MODE_FOC;
    const double full = motor->supply / (foc ? root_of_3 : 1); /* volts of a duty of one */
    *volts = 0;
    if (is_dark(self, 0)) {
        return false;
    }
    if (device->state != MCT_CAN_DRIVE_READY) {
        return is_native(device);
    }
    const bool is_current = device->wish == MCT_CAN_WISH_CURRENT || device->wish == MCT_CAN_WISH_TORQUE;
    if (is_current && device->value == 0) {
        return false; /* no current: nothing else than to run free */
    }
    switch (device->wish) {
    case MCT_CAN_WISH_VOLTS:
        *volts = device->value;
        break;
    case MCT_CAN_WISH_DUTY:
        *volts = ramped(self, device->value) * full;
        break;
    case MCT_CAN_WISH_CURRENT:
        *volts = volts_of_current(self, device->value);
        break;
    case MCT_CAN_WISH_TORQUE:
        *volts = volts_of_current(self, device->value / motor->torque_per_ampere);
        break;
    default:
        return is_native(device);
    }
    *volts = clamp(*volts, is_vesc(device) ? vesc_highest_duty * full : full);
    if (device->wish != MCT_CAN_WISH_DUTY) {
        self->boards[0].duty = *volts / full;
    }
    return true;
}

static void power(mct_can_drive *self)
{
    double volts;
    self->powered = follow(self, &volts);
    if (self->powered) {
        self->volts = self->axes.axes[0].motor.inverted ? 0 - volts : volts; /* 0, not -0 */
    } else {
        self->volts = back_emf(self);
        self->boards[0].duty = 0;
    }
}

static void note_volts(mct_can_drive *self)
{
    mct_can_drive_result *result = &self->result;
    const double size = self->volts < 0 ? -self->volts : self->volts;
    if (self->powered && size > 0) {
        result->driven_ticks++;
        result->last_driven = self->sim.plant.tick;
        result->highest_volts = size > result->highest_volts ? size : result->highest_volts;
    }
}

/* --- what a drive says --- */

static void send(mct_can_drive *self, const mct_can_frame *frame)
{
    self->transport.ops->send(self->transport.context, frame);
}

static void keep(mct_can_drive *self, const mct_can_frame *frame, uint64_t ticks)
{
    if (self->late_count < MCT_CAN_MAX_DELAYED) {
        const int place = (self->late_first + self->late_count++) % MCT_CAN_MAX_DELAYED;
        self->late[place] = (mct_can_late_frame){*frame, self->tick + ticks};
    }
}

static void send_late(mct_can_drive *self)
{
    const bool over = !has_fault(self, MCT_CAN_FAULT_DELAY) && !has_fault(self, MCT_CAN_FAULT_REORDER);
    while (self->late_count > 0 && (over || self->late[self->late_first].due <= self->tick)) {
        send(self, &self->late[self->late_first].frame);
        self->late_first = (self->late_first + 1) % MCT_CAN_MAX_DELAYED;
        self->late_count--;
    }
}

static void empty(mct_can_frame *frame, int from)
{
    for (int i = from; i < 8; i++) {
        frame->data[i] = 0;
    }
}

/* Spoils a frame as the fault of the moment does; false when it does not go out now. */
static bool spoil(mct_can_drive *self, mct_can_frame *frame)
{
    const uint64_t since = self->sim.plant.tick - self->fault_begin;
    self->result.spoilt++;
    switch (self->scene->can_fault) {
    case MCT_CAN_FAULT_DROP:
    case MCT_CAN_FAULT_SILENCE:
        return false;
    case MCT_CAN_FAULT_DELAY:
        keep(self, frame, MCT_CAN_DELAY);
        return false;
    case MCT_CAN_FAULT_DUPLICATE:
        send(self, frame);
        return true;
    case MCT_CAN_FAULT_REORDER:
        if (since % 2 == 0) {
            keep(self, frame, 1);
        } else {
            self->result.spoilt--; /* goes out as ever */
        }
        return since % 2 != 0;
    case MCT_CAN_FAULT_SHORT:
        frame->length = (uint8_t)(frame->length > 0 ? frame->length - 1 : 0);
        empty(frame, frame->length);
        return true;
    case MCT_CAN_FAULT_REMOTE:
        frame->remote = true;
        empty(frame, 0);
        return true;
    case MCT_CAN_FAULT_FORMAT:
        frame->extended = !frame->extended;
        frame->id &= frame->extended ? 0x1FFFFFFF : 0x7FF;
        return true;
    default:
        self->result.spoilt--; /* not a fault of frames */
        return true;
    }
}

static double current(const mct_can_drive *self)
{
    const mct_plant *plant = &self->sim.plant;
    if (plant->effects & MCT_MOTOR_INDUCTIVE) {
        return mct_plant_value(plant, 2 * plant->system->coordinate_count);
    }
    return self->powered ? (self->volts - back_emf(self)) / (double)windings(self)->resistance : 0;
}

/* Fills in what a drive knows of itself. */
static void measure(mct_can_drive *self, int number)
{
    mct_can_device *device = &self->devices[number];
    const mct_can_drive_board *board = &self->boards[number];
    const mct_can_axis *axis = &self->axes.axes[number];
    for (int j = 0; j < MCT_CAN_ENCODERS; j++) {
        const bool reversed = axis->encoders[j].counts_per_turn < 0;
        const int64_t counts = reversed ? -board->position[j] : board->position[j];
        device->counts[j] = is_native(device) ? wrapped(self, counts) : (int32_t)(uint32_t)(uint64_t)counts;
    }
    if (axis->encoders[0].used) {
        device->turns = (double)board->position[0] / axis->encoders[0].counts_per_turn;
        device->rate = self->rate[axis->encoders[0].coordinate] / axis->encoders[0].counts_per_turn;
    }
    if (device->roles & MCT_CAN_OF_MOTOR) {
        const double sense_of_turning = axis->motor.inverted ? -1 : 1;
        device->volts = self->powered ? sense_of_turning * self->volts : 0;
        device->amperes = sense_of_turning * current(self);
    }
    device->encoder_invalid =
        has_fault(self, MCT_CAN_FAULT_NAN) || (self->reading.flags & MCT_READING_INVALID) != 0;
    device->time_us = (self->tick - board->booted) * self->sim.tick_us;
}

/* True when a message is to go out at this tick. */
static bool is_due(mct_can_drive *self, int number, int message)
{
    const mct_can_device *device = &self->devices[number];
    const mct_can_message *described = &device->protocol->messages[message];
    const double dt = self->sim.dt;
    const double now = (double)self->tick * dt;
    const double slowness = is_vesc(device) && !self->lockstep ? vesc_slowness : 1;
    const double period = (described->period > 0 ? described->period : dt) * slowness;
    double *due = &self->boards[number].due[message];
    if (now < *due - dt / 2) {
        return false;
    }
    *due = *due + period > now ? *due + period : now + period;
    return true;
}

/* True for what tells a position; a slow message is about the drive as a whole. */
static bool tells_counts(const mct_can_message *message)
{
    return (message->of & (MCT_CAN_OF_ENCODER | MCT_CAN_OF_SPARE)) != 0 && message->period == 0;
}

static void say(mct_can_drive *self, int number, int message)
{
    mct_can_device *device = &self->devices[number];
    mct_can_frame frame;
    memset(&frame, 0, sizeof frame);
    if (tells_counts(&device->protocol->messages[message])) {
        self->result.spoilt += has_fault(self, MCT_CAN_FAULT_NAN);
        if (self->reading.flags & MCT_READING_MISSING) {
            return; /* the encoder has told the drive nothing */
        }
    }
    if (device->protocol->report(device, message, &frame) && (!is_spoilt(self) || spoil(self, &frame))) {
        send(self, &frame);
    }
}

/* True when a message belongs to what a drive sends at this tick. */
static bool is_to_say(mct_can_drive *self, int number, int message)
{
    const mct_can_device *device = &self->devices[number];
    const mct_can_message *described = &device->protocol->messages[message];
    if (!described->from_drive || (described->of != 0 && !(described->of & device->roles))) {
        return false;
    }
    if (described->period < 0) {
        return self->calls_stop && number == 0; /* nothing else happens that has a message of its own */
    }
    return is_due(self, number, message);
}

static void report(mct_can_drive *self)
{
    const bool reordered = self->scene->can_fault == MCT_CAN_FAULT_REORDER;
    if (!reordered) {
        send_late(self);
    }
    for (int i = 0; i < self->device_count; i++) {
        mct_can_device *device = &self->devices[i];
        if (is_dark(self, i)) {
            continue;
        }
        measure(self, i);
        for (int j = 0; j < device->protocol->message_count; j++) {
            if (is_to_say(self, i, j)) {
                say(self, i, j);
            }
        }
    }
    if (reordered) {
        send_late(self);
    }
    self->calls_stop = false;
}

/* --- from beginning to end --- */

mct_status mct_can_drive_init(mct_can_drive *self, const mct_scene *scene, mct_can_transport transport,
                              mct_message *why)
{
    memset(self, 0, sizeof *self);
    self->scene = scene;
    self->transport = transport;
    self->lockstep = scene->can_lockstep != 0;
    mct_status status = mct_can_axes_init(&self->axes, scene, why);
    status = status != MCT_OK ? status : mct_sim_init(&self->sim, scene, why);
    if (status != MCT_OK) {
        return status;
    }
    self->sim.realtime = false; /* its owner paces it */
    self->device_count = self->axes.count;
    const double end = scene->can_fault_time + scene->can_fault_duration;
    self->fault_begin = (uint64_t)(scene->can_fault_time / scene->dt + 0.5);
    self->fault_end = (uint64_t)(end / scene->dt + 0.5);
    if (self->fault_end <= self->fault_begin) {
        self->fault_end = self->fault_begin + 1;
    }
    for (int i = 0; i < self->device_count; i++) {
        boot(self, i);
    }
    return MCT_OK;
}

mct_status mct_can_drive_open(mct_can_drive *self, mct_message *why)
{
    const mct_hal hal = mct_sim_hal(&self->sim);
    mct_status status = self->transport.ops->open(self->transport.context, NULL, 0, &self->counts, why);
    status = status != MCT_OK ? status : hal.ops->open(hal.context, why);
    if (status == MCT_OK) {
        sense(self);
    }
    return status;
}

/* Lets the mechanism go when the owner has let go of it, or else when somebody drives it. */
static void release(mct_can_drive *self)
{
    const bool driven = self->devices[0].state == MCT_CAN_DRIVE_READY;
    self->was_held |= self->held;
    self->released |= !self->held && (self->was_held || driven);
}

/* The mechanism moves under the volts of this tick. */
static void step(mct_can_drive *self)
{
    const mct_hal hal = mct_sim_hal(&self->sim);
    note_volts(self);
    hal.ops->write(hal.context, (mct_real)self->volts);
    hal.ops->wait_tick(hal.context);
    sense(self);
    self->result.ticks = self->sim.plant.tick;
}

void mct_can_drive_tick(mct_can_drive *self)
{
    mct_can_device *motor = &self->devices[0];
    self->link = self->transport.ops->tend(self->transport.context);
    wake(self);
    if (self->was_held) {
        release(self); /* so that a fault at the very first tick finds the mechanism let go */
    }
    start_reboot(self); /* before it hears anything */
    drain(self);
    for (int i = 0; i < self->device_count; i++) {
        settle(&self->devices[i]);
    }
    release(self);
    suffer(self);
    settle(motor);
    watch(self);
    settle(motor);
    power(self);
    if (self->released) {
        step(self);
    }
    self->tick++;
    report(self);
}

void mct_can_drive_close(mct_can_drive *self)
{
    const mct_hal hal = mct_sim_hal(&self->sim);
    hal.ops->close(hal.context);
    self->volts = 0;
    self->powered = false;
    self->transport.ops->close(self->transport.context);
}

static void serve(void *context, int64_t timeout_us)
{
    mct_can_drive *self = context;
    (void)timeout_us; /* a wait of the host's is a tick, however long it would be */
    mct_can_ring_advance(self->ring, self->sim.tick_us);
    mct_can_drive_tick(self);
}

void mct_can_drive_serve(mct_can_drive *self, mct_can_ring *ring)
{
    self->ring = ring;
    self->lockstep = true;
    mct_can_ring_serve(ring, 1, serve, self);
}

/*
 * Arbitrary frames into the virtual drive, over the ring, with any of the scene's faults.
 *
 * Input: three bytes for scene, fault and its time; then operations, a byte each and what it takes.
 */
#include <math.h>
#include <string.h>

#include "fuzz/can_scenes.h"
#include "fuzz/fuzz.h"
#include "hal/socketcan/drive.h"

enum { MOST_TICKS = 1000, FAULTS = MCT_CAN_FAULT_ERROR + 1 };

typedef struct {
    mct_scene scene;
    mct_can_ring ring;
    mct_can_drive drive;
    mct_can_axes host; /* who hears what the drives say, and makes valid commands */
    mct_can_counts counts;
    mct_can_transport end;
    double supply;
    uint64_t ticks;
    uint64_t fed;     /* tick of the newest frame that could be a command to the motor's drive */
    uint64_t stopped; /* ticks since an emergency stop without a frame that could clear it; 0: none */
    mct_can_counts before;
    mct_can_drive_result result;
    mct_reading sensed;
} bench;

static bool is_native(const bench *self)
{
    return self->scene.can_protocol == MCT_CAN_NATIVE;
}

static void send(bench *self, const mct_can_frame *frame)
{
    if (!self->end.ops->send(self->end.context, frame)) {
        return;
    }
    const uint32_t id = frame->id, node = self->drive.devices[0].node;
    const bool odrive = self->scene.can_protocol == MCT_CAN_ODRIVE;
    const bool stop = is_native(self) ? id == 0x010 + node : odrive && id == (node << 5 | 0x02);
    const bool clear = is_native(self) ? id == 0x100 + node && (frame->data[5] & 15) == 2
                                       : odrive && id == (node << 5 | 0x18);
    const bool heard = !frame->remote && frame->extended == self->host.protocol->extended &&
                       self->scene.can_fault != MCT_CAN_FAULT_SILENCE;
    self->stopped = stop && heard ? 1 : clear ? 0 : self->stopped;
    self->fed = self->ticks;
}

static void check_counts(bench *self)
{
    const mct_can_drive_result *now = &self->drive.result, *before = &self->result;
    for (int i = 0; i < MCT_CAN_COUNTS; i++) {
        FUZZ_RULE(self->drive.counts.values[i] >= self->before.values[i], "a count never falls: %s",
                  mct_can_counters[i].name);
    }
    FUZZ_RULE(now->ticks >= before->ticks && now->commands >= before->commands &&
                  now->old_commands >= before->old_commands && now->refused >= before->refused &&
                  now->watchdog_trips >= before->watchdog_trips && now->stops >= before->stops &&
                  now->driven_ticks >= before->driven_ticks && now->last_driven >= before->last_driven &&
                  now->spoilt >= before->spoilt && now->highest_volts >= before->highest_volts,
              "what became of the drive never falls");
    self->before = self->drive.counts;
    self->result = self->drive.result;
}

static void check_motor(bench *self)
{
    const mct_can_drive *drive = &self->drive;
    const mct_can_device *device = &drive->devices[0];
    const double size = drive->powered ? fabs(drive->volts) : 0;
    const double watchdog = is_native(self) ? 1e-3 * device->watchdog_ms : self->scene.can_watchdog;
    const double alone = (double)(self->ticks - self->fed) * self->scene.dt;
    FUZZ_RULE(isfinite(drive->volts), "volts are finite: %g", drive->volts);
    FUZZ_RULE(size <= self->supply, "volts are within the supply: %g of %g", drive->volts, self->supply);
    FUZZ_RULE(size == 0 || watchdog == 0 || alone < watchdog + 1.5 * self->scene.dt,
              "volts are zero after the watchdog's time: %g V, no command for %g s of %g s", drive->volts,
              alone, watchdog);
    FUZZ_RULE(size == 0 || self->stopped < 2, "volts are zero after an emergency stop: %g", drive->volts);
    FUZZ_RULE(size == 0 || device->state == MCT_CAN_DRIVE_READY, "a drive that is not ready does not drive");
    FUZZ_RULE(drive->powered || !is_native(self) || drive->boards[0].dark_until > 0,
              "a native bridge holds the motor");
    for (int i = 0; i < drive->sim.plant.system->coordinate_count; i++) {
        FUZZ_RULE(isfinite(mct_plant_value(&drive->sim.plant, i)), "the plant stays finite");
    }
}

/* What the drives say has a valid form but for what the fault makes of it. */
static void hear(bench *self)
{
    const int32_t fault = self->scene.can_fault;
    const bool misformed =
        fault == MCT_CAN_FAULT_SHORT || fault == MCT_CAN_FAULT_REMOTE || fault == MCT_CAN_FAULT_FORMAT;
    mct_can_frame frame;
    int count = 0;
    while (self->end.ops->receive(self->end.context, &frame)) {
        FUZZ_RULE(count++ <= MCT_CAN_RING_FRAMES, "a tick brings a bounded number of frames");
        FUZZ_RULE(frame.length <= 8 && frame.id <= (frame.extended ? 0x1FFFFFFFu : 0x7FFu), "a frame is one");
        for (int i = frame.remote ? 0 : frame.length; i < 8; i++) {
            FUZZ_RULE(frame.data[i] == 0, "data are zero beyond the length");
        }
        mct_can_verdict verdict = MCT_CAN_IS_FOREIGN;
        for (int i = 0; i < self->host.count && verdict == MCT_CAN_IS_FOREIGN; i++) {
            verdict = self->host.protocol->hear(&self->host.axes[i], &frame);
        }
        FUZZ_RULE(misformed || (verdict != MCT_CAN_IS_FOREIGN && verdict != MCT_CAN_IS_BAD_LENGTH &&
                                verdict != MCT_CAN_IS_BAD_FORMAT && verdict != MCT_CAN_IS_REMOTE),
                  "a host understands the drive: id %x, length %d, verdict %d", frame.id, frame.length,
                  (int)verdict);
    }
}

static void tick(bench *self)
{
    if (self->ticks >= MOST_TICKS) {
        return;
    }
    self->end.ops->wait(self->end.context, 1000);
    self->ticks++;
    self->stopped += self->stopped > 0;
    check_motor(self);
    check_counts(self);
    hear(self);
}

static void send_valid(bench *self, uint8_t what)
{
    mct_can_frame frames[MCT_CAN_MAX_BURST];
    mct_can_axis *axis = &self->host.axes[0];
    int count = 1;
    switch (what % 4) {
    case 0:
        count = self->host.protocol->arm(axis, frames);
        break;
    case 1:
        count = self->host.protocol->stop(axis, frames);
        break;
    default:
        self->host.protocol->command(axis, (mct_real)((what >> 2) - 32) * MCT_R(1.5), true, frames);
        break;
    }
    for (int i = 0; i < count; i++) {
        send(self, &frames[i]);
    }
}

static void start(bench *self, uint8_t scene, uint8_t fault, uint8_t time)
{
    mct_message why = {""};
    memset(self, 0, sizeof *self);
    self->scene = fuzz_can_scene(scene);
    self->scene.can_fault = fault % FAULTS;
    self->scene.can_fault_time = (time & 15) * 0.004;
    self->scene.can_fault_duration = (time >> 4) * 0.005;
    self->scene.can_lockstep = fault >= 128;
    self->scene.can_watchdog = fault >= 64 && fault < 80 ? 0.02 : 0.1;
    mct_can_ring_init(&self->ring);
    self->end = mct_can_ring_end(&self->ring, 0);
    FUZZ_RULE(mct_can_axes_init(&self->host, &self->scene, &why) == MCT_OK, "axes: %s", why.text);
    FUZZ_RULE(mct_can_drive_init(&self->drive, &self->scene, mct_can_ring_end(&self->ring, 1), &why) ==
                  MCT_OK,
              "drive: %s", why.text);
    mct_can_drive_serve(&self->drive, &self->ring);
    self->drive.lockstep = fault >= 128;
    self->supply = self->host.axes[0].motor.supply;
    FUZZ_RULE(mct_can_drive_open(&self->drive, &why) == MCT_OK, "drive: %s", why.text);
    self->end.ops->open(self->end.context, NULL, 0, &self->counts, &why);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static bench self;
    fuzz_bytes input = {data, data + size};
    const uint8_t scene = fuzz_byte(&input), fault = fuzz_byte(&input), time = fuzz_byte(&input);
    start(&self, scene, fault, time);
    while (input.at < input.end && self.ticks < MOST_TICKS) {
        const uint8_t what = fuzz_byte(&input);
        uint8_t bytes[FUZZ_CAN_FRAME];
        mct_can_frame frame;
        switch (what % 8) {
        case 0:
        case 1: /* some ticks */
            for (int i = 0; i <= what >> 3; i++) {
                tick(&self);
            }
            break;
        case 2: /* what a host would send */
        case 3:
            send_valid(&self, fuzz_byte(&input));
            tick(&self);
            break;
        case 4: /* that several times in a row */
            for (int i = 0; i <= what >> 5; i++) {
                send_valid(&self, fuzz_byte(&input));
            }
            tick(&self);
            break;
        case 5: /* anything */
        case 6:
            for (int i = 0; i < FUZZ_CAN_FRAME; i++) {
                bytes[i] = fuzz_byte(&input);
            }
            frame = fuzz_can_frame(&self.host, bytes);
            send(&self, &frame);
            break;
        default:
            if (what < 64) {
                self.drive.held = !self.drive.held;
            } else if (what < 96) {
                mct_can_drive_wait(&self.drive, 1000);
            } else {
                self.stopped = 0; /* what is under way when the link goes is lost */
                self.ring.state =
                    what % 3 == 0 ? (mct_can_link_state)(what % MCT_CAN_LINK_STATES) : MCT_CAN_UP;
            }
            break;
        }
    }
    mct_can_drive_close(&self.drive);
    FUZZ_RULE(self.drive.volts == 0 && !self.drive.powered, "a closed drive has zero volts");
    return 0;
}

/* An arming and a run of commands for each scene and fault; then every message there is. */
size_t fuzz_seed(int number, uint8_t *out)
{
    static const uint8_t zero[8] = {0};
    size_t size = 0;
    if (number >= FUZZ_CAN_SCENES * 3) {
        return 0;
    }
    out[size++] = (uint8_t)(number % FUZZ_CAN_SCENES);
    out[size++] = (uint8_t)(number % FAULTS + (number % 2) * 128);
    out[size++] = 0x53;
    out[size++] = 2; /* get ready */
    out[size++] = 0;
    if (number < FUZZ_CAN_SCENES) {
        for (int i = 0; i < 60; i++) {
            out[size++] = 2;
            out[size++] = (uint8_t)(i * 4 + 2);
        }
        out[size++] = 0xF8; /* silence */
        out[size++] = 0xF8;
        out[size++] = 0xF8;
        out[size++] = 0xF8;
        out[size++] = 0xF8;
    }
    for (int i = 0; i < 18; i++) {
        out[size++] = 5;
        fuzz_can_bytes(i & 1, i / 2, 8, zero, out + size);
        size += FUZZ_CAN_FRAME;
        out[size++] = 2;
        out[size++] = 0xF2;
    }
    return size;
}

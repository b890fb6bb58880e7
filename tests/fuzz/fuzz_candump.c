/*
 * Arbitrary text as a recorded log, and who reads it to its end.
 *
 * Input: eight bytes of how it is read, then the log.
 */
#include <string.h>

#include "fuzz/can_scenes.h"
#include "fuzz/fuzz.h"
#include "hal/socketcan/can.h"
#include "hal/socketcan/candump.h"
#include "hal/socketcan/drive.h"
#include "hal/socketcan/filter.h"

enum { HEAD = 8 };

/* Identifiers that the seeds hold too. */
static const mct_can_filter identifiers[] = {
    {0x123, false},     {0x101, false}, {0x181, false}, {0x201, false}, {0x281, false},
    {0x18DAF110, true}, {0x1001, true}, {0x001, true},  {0x029, false}, {0x7FF, false},
};
enum { IDENTIFIERS = (int)(sizeof identifiers / sizeof identifiers[0]) };

static int list_of(uint8_t bits, mct_can_filter *list)
{
    int count = 0;
    for (int i = 0; i < 8; i++) {
        if (bits >> i & 1) {
            list[count++] = identifiers[i];
        }
    }
    return count;
}

typedef struct {
    mct_can_candump log;
    mct_can_transport transport;
    mct_can_counts counts;
    mct_can_filter filters[8], own[8];
    int filter_count;
    int64_t now_us;
    uint64_t received, sent;
    size_t position;
} reader;

static void check(reader *self)
{
    const mct_can_candump *log = &self->log;
    const int64_t now_us = self->transport.ops->now_us(self->transport.context);
    FUZZ_RULE(now_us >= self->now_us, "the clock only goes forward: %lld us behind %lld us",
              (long long)now_us, (long long)self->now_us);
    self->now_us = now_us;
    FUZZ_RULE(log->position >= self->position && log->position <= log->length,
              "the position only goes forward");
    self->position = log->position;
    FUZZ_RULE(log->compared + log->unmatched == self->sent, "each frame that is sent is looked for");
    FUZZ_RULE(log->mismatches <= log->compared, "a mismatch was compared");
    FUZZ_RULE(self->received + log->compared <= log->lines, "a line is used once");
    const uint64_t skipped = self->counts.values[MCT_CAN_COUNT_SKIPPED];
    FUZZ_RULE(self->received + skipped <= log->lines, "a line is received or skipped, once");
}

static void receive(reader *self)
{
    mct_can_frame frame;
    memset(&frame, 0xA5, sizeof frame);
    const int64_t before_us = self->now_us;
    if (!self->transport.ops->receive(self->transport.context, &frame)) {
        return;
    }
    self->received++;
    FUZZ_RULE(frame.length <= 8, "a length is up to 8: %d", frame.length);
    for (int i = frame.remote ? 0 : frame.length; i < 8; i++) {
        FUZZ_RULE(frame.data[i] == 0, "data are zero beyond the length");
    }
    FUZZ_RULE(frame.id <= (frame.extended ? 0x1FFFFFFFu : 0x7FFu), "an identifier fits its bits: %x",
              frame.id);
    FUZZ_RULE(mct_can_is_wanted(self->filters, self->filter_count, &frame), "what is received is wanted: %x",
              frame.id);
    FUZZ_RULE(frame.time_us >= before_us, "a frame is not older than the one before");
    FUZZ_RULE(frame.time_us <= self->transport.ops->now_us(self->transport.context),
              "a frame is not of the future");
}

static void send(reader *self, uint32_t choice, const uint8_t *data)
{
    mct_can_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.id = choice < IDENTIFIERS ? identifiers[choice].id : 0x400 + choice;
    frame.extended = choice < IDENTIFIERS && identifiers[choice].extended;
    frame.length = data != NULL ? 8 : 0;
    if (data != NULL) {
        memcpy(frame.data, data, 8);
    }
    self->transport.ops->send(self->transport.context, &frame);
    self->sent++;
}

static void read_to_its_end(reader *self, const uint8_t *head)
{
    uint64_t state = head[2] | head[3] << 8;
    /* Each step that does not move on in the log sends, or waits: few are needed for each line. */
    const uint64_t most = 16 * (self->log.lines + 16);
    uint64_t steps = 0;
    size_t position = 0;
    int idle = 0;
    while (self->transport.ops->tend(self->transport.context) != MCT_CAN_END_OF_LOG) {
        FUZZ_RULE(steps++ < most, "a log ends: %llu lines", (unsigned long long)self->log.lines);
        state =
            state * 0x5851F42D4C957F2D + 0x14057B7EF767814F; /* its low bits are no worse than a fuzzer's */
        const uint32_t drawn = (uint32_t)(state >> 40);
        switch (head[4] % 4 == 0 ? drawn % 4 : head[4] % 4) {
        case 0:
            receive(self);
            break;
        case 1:
            send(self, drawn >> 4 & 15, head);
            break;
        case 2:
            self->transport.ops->wait(self->transport.context, head[5] * 1000);
            break;
        default:
            receive(self);
            send(self, head[6] & 15, head);
            break;
        }
        check(self);
        idle = self->log.position == position ? idle + 1 : 0;
        position = self->log.position;
        if (idle > 4) { /* whoever receives all, then sends what is not in the log, gets to the end */
            receive(self);
            check(self);
            send(self, 100, NULL);
            check(self);
        }
    }
    mct_can_frame frame;
    const uint64_t before = self->received;
    for (int i = 0; i < 64; i++) {
        FUZZ_RULE(!self->transport.ops->receive(self->transport.context, &frame),
                  "behind the end nothing is received");
    }
    FUZZ_RULE(self->received == before, "behind the end nothing is received");
}

static void check_reason(const mct_message *why)
{
    const size_t length = strnlen(why->text, sizeof why->text);
    FUZZ_RULE(length > 0 && length < sizeof why->text, "a refusal says why");
    for (size_t i = 0; i < length; i++) {
        FUZZ_RULE((unsigned char)why->text[i] >= ' ' && why->text[i] != 0x7F,
                  "a message is one line of text");
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static reader self;
    mct_message why = {""};
    if (size < HEAD) {
        return 0;
    }
    memset(&self, 0, sizeof self);
    self.transport = mct_can_candump_transport(&self.log, (const char *)data + HEAD, size - HEAD);
    self.filter_count = list_of(data[0], self.filters);
    self.log.own_count = list_of(data[1], self.own);
    self.log.own = self.own;
    if (self.transport.ops->open(self.transport.context, self.filters, self.filter_count, &self.counts,
                                 &why) != MCT_OK) {
        check_reason(&why);
        return 0;
    }
    FUZZ_RULE(why.text[0] == '\0', "an opened log has no complaint");
    FUZZ_RULE(self.log.lines > 0, "an opened log holds frames");
    read_to_its_end(&self, data);
    self.transport.ops->close(self.transport.context);
    return 0;
}

/* --- seeds: logs of runs over the ring --- */

typedef struct {
    char *at, *end;
    mct_can_ring ring;
} recorder;

static void note(recorder *self, const mct_can_frame *frame)
{
    char line[96];
    const long long us = 1436509052249713 + self->ring.now_us;
    int size =
        snprintf(line, sizeof line, frame->extended ? "(%lld.%06lld) can0 %08X#" : "(%lld.%06lld) can0 %03X#",
                 us / 1000000, us % 1000000, frame->id);
    for (int i = 0; i < frame->length; i++) {
        size += snprintf(line + size, sizeof line - (size_t)size, "%02X", frame->data[i]);
    }
    line[size++] = '\n';
    if (size <= self->end - self->at) {
        memcpy(self->at, line, (size_t)size);
        self->at += size;
    }
}

/* A host that commands volts in turn with a drive that answers. */
static size_t record(int number, uint8_t *out)
{
    static recorder self;
    static mct_can_drive drive;
    static mct_can_axes axes;
    const mct_scene scene = fuzz_can_scene(number);
    mct_can_counts counts = {{0}};
    mct_message why = {""};
    mct_can_ring_init(&self.ring);
    self.at = (char *)out;
    self.end = (char *)out + FUZZ_LONGEST / 2;
    const mct_can_transport host = mct_can_ring_end(&self.ring, 0);
    FUZZ_RULE(mct_can_axes_init(&axes, &scene, &why) == MCT_OK, "axes: %s", why.text);
    FUZZ_RULE(mct_can_drive_init(&drive, &scene, mct_can_ring_end(&self.ring, 1), &why) == MCT_OK,
              "drive: %s", why.text);
    mct_can_drive_serve(&drive, &self.ring);
    FUZZ_RULE(mct_can_drive_open(&drive, &why) == MCT_OK, "drive: %s", why.text);
    host.ops->open(host.context, NULL, 0, &counts, &why);
    for (int tick = 0; tick < 25; tick++) {
        mct_can_frame frames[MCT_CAN_MAX_BURST + 1];
        int sent = tick == 0 ? axes.protocol->arm(&axes.axes[0], frames) : 0;
        axes.protocol->command(&axes.axes[0], (mct_real)(tick % 5), true, &frames[sent++]);
        for (int i = 0; i < sent; i++) {
            host.ops->send(host.context, &frames[i]);
            note(&self, &frames[i]);
        }
        host.ops->wait(host.context, 1000);
        while (host.ops->receive(host.context, &frames[0])) {
            note(&self, &frames[0]);
        }
    }
    host.ops->close(host.context);
    mct_can_drive_close(&drive);
    return (size_t)(self.at - (char *)out);
}

size_t fuzz_seed(int number, uint8_t *out)
{
    static const char sample[] =
        "(1436509052.249713) can0 123#0011AABB\n"
        "(1436509052.249800) can0 18DAF110#R3 T\r\n"
        "\n(1436509052.249801) vcan1 20000004#0000000000000000\n"
        "(1436509052.250713500) can0 101#\n(1436509053.250713) can0 7FF#0102030405060708 R\n"
        "(1436509050.250713) can0 123#R\n(1436509059.250713) can0 123#DEADBEEF";
    static const char small[] = "(1.000000) can0 123#R8\n(1.000100) can0 101#11 T\n(1.000200) can0 123#22\n";
    static const uint8_t heads[][HEAD] = {
        {0, 0, 1, 1, 0, 1, 0, 0},       {0x1D, 0, 1, 1, 1, 1, 1, 0},  {0x1D, 2, 1, 1, 3, 1, 1, 0},
        {0x40, 0x80, 1, 1, 3, 1, 7, 0}, {0xFF, 0, 1, 1, 2, 50, 7, 0},
    };
    enum { HEADS = (int)(sizeof heads / sizeof heads[0]), LOGS = 5 };
    static const int scenes[LOGS - 2] = {0, 4, 6};
    if (number >= HEADS * LOGS) {
        return 0;
    }
    memcpy(out, heads[number % HEADS], HEAD);
    const int log = number / HEADS;
    if (log == 0) {
        memcpy(out + HEAD, sample, sizeof sample - 1);
        return HEAD + sizeof sample - 1;
    }
    if (log == 1) {
        memcpy(out + HEAD, small, sizeof small - 1);
        return HEAD + sizeof small - 1;
    }
    return HEAD + record(scenes[log - 2], out + HEAD);
}

/*
 * Lets the codecs of hal/socketcan work for test_can_codecs.py. Each line asks one thing of a fresh axis or drive:
 *
 *   messages                                   the tables
 *   command SETTINGS sequence bus_voltage rate volts enable
 *   report SETTINGS message STATE              a frame of the drive
 *   hear SETTINGS FRAME                        what a host makes of it
 *   obey SETTINGS FRAME                        what a drive makes of it
 *
 * SETTINGS: protocol mode firmware node inverted; FRAME: id extended remote length data (hexadecimal digits).
 * An answer is one line of JSON.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/socketcan/protocol.h"

static mct_scene scene;
static mct_can_axis axis;
static mct_can_device device;

static const char *word(void)
{
    const char *next = strtok(NULL, " \n");
    if (next == NULL) {
        fputs("can_codec_dump: a line is too short\n", stderr);
        exit(1);
    }
    return next;
}

static double number(void)
{
    return strtod(word(), NULL);
}

static long long integer(void)
{
    return strtoll(word(), NULL, 0);
}

static void print_number(const char *name, double value, const char *end)
{
    /* JSON has no NaN, Python's reader knows it by this name */
    if (value != value) {
        printf("\"%s\": NaN%s", name, end);
    } else {
        printf("\"%s\": %.17g%s", name, value, end);
    }
}

static void print_frame(const mct_can_frame *frame)
{
    printf("\"id\": %" PRIu32 ", \"extended\": %d, \"remote\": %d, \"data\": \"", frame->id, frame->extended,
           frame->remote);
    for (int i = 0; i < frame->length; i++) {
        printf("%02x", frame->data[i]);
    }
    printf("\"}\n");
}

static mct_can_frame read_frame(void)
{
    mct_can_frame frame = {.id = (uint32_t)integer()};
    frame.extended = integer() != 0;
    frame.remote = integer() != 0;
    frame.length = (uint8_t)integer();
    const char *digits = word();
    for (int i = 0; i < frame.length && i < 8; i++) {
        unsigned byte;
        sscanf(digits + 2 * i, "%2x", &byte);
        frame.data[i] = (uint8_t)byte;
    }
    return frame;
}

static const mct_can_protocol *read_settings(void)
{
    memset(&scene, 0, sizeof scene);
    memset(&axis, 0, sizeof axis);
    memset(&device, 0, sizeof device);
    scene.can_protocol = (int32_t)integer();
    scene.can_mode = (int32_t)integer();
    scene.can_firmware = (int32_t)integer();
    const mct_can_protocol *protocol = mct_can_protocol_of(&scene);
    scene.can_pole_pairs = 7;
    scene.can_watchdog = 0.1;
    axis.protocol = device.protocol = protocol;
    axis.scene = device.scene = &scene;
    axis.watchdog_ms = mct_can_watchdog_ms(scene.can_watchdog);
    axis.node = device.node = (uint8_t)integer();
    axis.roles = device.roles = MCT_CAN_OF_MOTOR | MCT_CAN_OF_ENCODER | MCT_CAN_OF_SPARE;
    device.counts_per_turn = 4096;
    axis.motor = (mct_can_motor){12, 2, 0.05, 0.25, integer() != 0};
    for (int i = 0; i < MCT_CAN_ENCODERS; i++) {
        axis.encoders[i].used = true;
        axis.encoders[i].counts_per_turn = 4096;
    }
    return protocol;
}

static void dump_messages(void)
{
    static const char *const files[] = {"native", "vesc", "odrive", "odrive_0_5"};
    printf("[");
    for (int p = 0; p <= MCT_CAN_PROTOCOL_COUNT; p++) {
        scene.can_protocol = p < MCT_CAN_PROTOCOL_COUNT ? p : MCT_CAN_ODRIVE;
        scene.can_firmware = p < MCT_CAN_PROTOCOL_COUNT ? MCT_CAN_FIRMWARE_0_6 : MCT_CAN_FIRMWARE_0_5;
        const mct_can_protocol *protocol = mct_can_protocol_of(&scene);
        for (int i = 0; i < protocol->message_count; i++) {
            const mct_can_message *message = &protocol->messages[i];
            printf("%s{\"file\": \"%s\", \"number\": %d, \"name\": \"%s\", \"id\": %" PRIu32
                   ", \"extended\": %d, \"length\": %d, \"from_drive\": %d, \"period\": %.17g}",
                   p + i > 0 ? ", " : "", files[p], i, message->name, protocol->identifier(message->code, 1),
                   protocol->extended, message->length, message->from_drive, message->period);
        }
    }
    printf("]\n");
}

static void dump_command(void)
{
    const mct_can_protocol *protocol = read_settings();
    axis.sequence = (uint8_t)integer();
    axis.bus_voltage = number();
    axis.rate = number();
    const double volts = number();
    mct_can_frame frame;
    protocol->command(&axis, (mct_real)volts, integer() != 0, &frame);
    printf("{\"sequence\": %d, ", axis.sequence);
    print_frame(&frame);
}

static void dump_report(void)
{
    const mct_can_protocol *protocol = read_settings();
    const int message = (int)integer();
    device.state = (mct_can_drive_state)integer();
    device.error = (uint32_t)integer();
    const long long flags = integer();
    device.watchdog_expired = flags & 1;
    device.estopped = flags >> 1 & 1;
    device.restarted = flags >> 2 & 1;
    device.encoder_invalid = flags >> 3 & 1;
    device.has_driven = flags >> 4 & 1;
    device.counts[0] = (int32_t)integer();
    device.counts[1] = (int32_t)integer();
    device.sequence = (uint8_t)integer();
    device.serial = (uint16_t)integer();
    device.time_us = (uint64_t)integer();
    device.turns = number();
    device.rate = number();
    device.volts = number();
    device.amperes = number();
    device.supply = number();
    device.temperature = number();
    mct_can_frame frame;
    const bool has = protocol->report(&device, message, &frame);
    printf("{\"has\": %d, ", has);
    print_frame(&frame);
}

static void dump_hear(void)
{
    const mct_can_protocol *protocol = read_settings();
    const mct_can_frame frame = read_frame();
    const mct_can_verdict verdict = protocol->hear(&axis, &frame);
    printf("{\"verdict\": %d, \"state\": %d, \"error\": %" PRIu32
           ", \"watchdog_expired\": %d, \"estopped\": %d, "
           "\"serial\": %d, \"counts\": [%" PRId32 ", %" PRId32
           "], \"capture\": [%d, %d], \"echo\": [%d, %d], "
           "\"steps\": %" PRId64 ", ",
           (int)verdict, (int)axis.state, axis.error, axis.watchdog_expired, axis.estopped, axis.serial,
           axis.encoders[0].counts, axis.encoders[1].counts, axis.encoders[0].capture_us,
           axis.encoders[1].capture_us, axis.encoders[0].echo, axis.encoders[1].echo, axis.encoders[0].steps);
    print_number("bus_voltage", mct_can_bus_voltage(&axis), ", ");
    print_number("turns", axis.encoders[0].turns, ", ");
    print_number("rate", axis.rate, "}\n");
}

static void dump_obey(void)
{
    const mct_can_protocol *protocol = read_settings();
    const mct_can_frame frame = read_frame();
    const mct_can_verdict verdict = protocol->obey(&device, &frame);
    printf("{\"verdict\": %d, \"wish\": %d, \"sequence\": %d, \"watchdog_ms\": %" PRIu32
           ", \"wants\": [%d, %d, %d], ",
           (int)verdict, (int)device.wish, device.sequence, device.watchdog_ms, device.wants_ready,
           device.wants_clear, device.wants_stop);
    print_number("value", device.value, "}\n");
}

int main(void)
{
    char line[1024];
    while (fgets(line, sizeof line, stdin) != NULL) {
        const char *request = strtok(line, " \n");
        if (strcmp(request, "messages") == 0) {
            dump_messages();
        } else if (strcmp(request, "command") == 0) {
            dump_command();
        } else if (strcmp(request, "report") == 0) {
            dump_report();
        } else if (strcmp(request, "hear") == 0) {
            dump_hear();
        } else if (strcmp(request, "obey") == 0) {
            dump_obey();
        } else {
            return 1;
        }
    }
    return 0;
}

/*
 * A compiled scene's loop on a CAN interface, as a Linux process: what a board with a CAN peripheral does.
 *
 * Command line: the image's name, the interface, a file for the records or "-", then the number of ticks instead of the
 * scene's.
 */
#include <signal.h>
#include <string.h>

#include "hal/compiled.h"
#include "hal/records.h"
#include "hal/socketcan/can.h"
#include "hal/socketcan/socket.h"
#include "image.h"

/* Set by a signal; a signal's handler has no other way to be heard. */
static volatile sig_atomic_t stopped;

static void on_signal(int number)
{
    (void)number;
    stopped = 1;
}

static void watch_signals(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    sigemptyset(&action.sa_mask);
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGHUP, &action, NULL);
}

int main(void)
{
    static mct_loop loop;
    static mct_can can;
    static mct_can_socket socket;
    const mct_scene *scene = &mct_compiled_scene.scene;
    const mct_records_head head = mct_records_head_here();
    char interface[IMAGE_WORD], path[IMAGE_WORD];
    image_counts counts = {0};
    mct_message why = {""};
    uint64_t hash = 0;
    (void)image_begin(); /* nothing is counted here */
    if (!image_word(1, interface)) {
        return image_fail("no interface given");
    }
    const bool records = image_word(2, path) && path[0] != '-';
    const uint64_t ticks = image_number(3, mct_compiled_ticks);
    const int32_t file = records ? mct_semihosting_open(path, true) : -1;
    bool written = !records || (file != -1 && mct_semihosting_append(file, &head, sizeof head));
    watch_signals();
    loop = mct_compiled_loop;
    loop.hal = mct_can_hal(&can);
    const mct_can_transport transport =
        mct_can_socket_transport(&socket, interface, (uint32_t)scene->can_bitrate);
    if (mct_can_init(&can, scene, transport, scene->can_lockstep != 0, &why) != MCT_OK ||
        loop.hal.ops->open(loop.hal.context, &why) != MCT_OK) {
        return image_fail(why.text);
    }
    while (loop.tick < ticks && written && !stopped) {
        image_tick(&loop, &counts);
        hash = image_hash(hash, &loop.record, sizeof loop.record);
        written = !records || mct_semihosting_append(file, &loop.record, sizeof loop.record);
    }
    loop.hal.ops->close(loop.hal.context);
    if (!written || (records && !mct_semihosting_close(file))) {
        return image_fail("the records could not be written");
    }
    image_report(&loop, &counts, hash);
    return 0;
}

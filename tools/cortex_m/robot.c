/*
 * A compiled scene's loop on a CAN interface, as a Linux process: what a board with a CAN peripheral does.
 *
 * Command line: the image's name, the interface, a file for the records or "-", then the number of ticks instead of the
 * scene's.
 */
#include <signal.h>
#include <string.h>

#include "hal/compiled.h"
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
    char interface[IMAGE_WORD];
    image_counts counts = {0};
    image_records records;
    mct_message why = {""};
    (void)image_begin(); /* nothing is counted here */
    if (!image_word(1, interface)) {
        return image_fail("no interface given");
    }
    const uint64_t ticks = image_number(3, mct_compiled_ticks);
    image_records_open(&records, 2);
    watch_signals();
    loop = mct_compiled_loop;
    loop.hal = mct_can_hal(&can);
    const mct_can_transport transport =
        mct_can_socket_transport(&socket, interface, (uint32_t)scene->can_bitrate);
    if (mct_can_init(&can, scene, transport, scene->can_lockstep != 0, &why) != MCT_OK ||
        loop.hal.ops->open(loop.hal.context, &why) != MCT_OK) {
        return image_fail(why.text);
    }
    while (loop.tick < ticks && records.is_well && !stopped) {
        image_tick(&loop, &counts);
        image_records_add(&records, &loop.record);
    }
    loop.hal.ops->close(loop.hal.context);
    if (!image_records_close(&records)) {
        return image_fail("the records could not be written");
    }
    image_report(&loop, &counts, records.hash);
    return 0;
}

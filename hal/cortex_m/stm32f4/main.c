/*
 * The controller on a board with a CAN peripheral: estimator, control, supervisor and HAL over CAN in one image, with a
 * scene as `mctau compile` writes it. A worked skeleton. NOT RUN ON HARDWARE. See docs/porting.md.
 *
 * It never drives of itself after a reset: the loop runs at zero volts until the button is pressed, which also clears
 * faults. (controller.rearm_after in the scene arms without a button; leave it 0.)
 */
#include "board.h"
#include "bxcan.h"
#include "hal/compiled.h"
#include "hal/cortex_m/systick.h"
#include "registers.h"

enum { EXIT_NO_CLOCK = 2, EXIT_NO_TICK, EXIT_NO_CAN, EXIT_NO_WATCHDOG };
enum { TICKS_WITHOUT_FEEDING = 10, PAUSE_US = 500000 };

static mct_bxcan bus;
static mct_can can;
static mct_loop loop;
static mct_message why; /* of the last failure: for a debugger */

/* The interrupts of the part, behind the processor's own: RM0090, 12.2, table 62. */
static void can1_interrupt(void)
{
    mct_bxcan_interrupt(&bus);
}

typedef void (*handler)(void);
__attribute__((section(".interrupts"), used)) static const handler interrupts[] = {
    [19] = can1_interrupt, /* CAN1_TX */
    [20] = can1_interrupt, /* CAN1_RX0 */
};

static void pause(void)
{
    const int64_t begin = mct_systick_us();
    while (mct_systick_us() - begin < PAUSE_US) {
    }
}

/* Until the drives have said all that the start asks for. Each attempt begins afresh; the LED blinks meanwhile. */
static mct_hal open_hal(void)
{
    bool is_lit = false;
    for (;;) {
        can = mct_compiled_can;
        can.transport = mct_bxcan_transport(&bus);
        const mct_hal hal = mct_can_hal(&can);
        mct_message_clear(&why);
        if (hal.ops->open(hal.context, &why) == MCT_OK) {
            return hal;
        }
        is_lit = !is_lit;
        mct_board_show_well(is_lit);
        pause();
    }
}

/* Zero volts, until mct_loop_rearm. */
static void stop(void)
{
    mct_supervisor_fault(&loop.supervisor, MCT_FAULT_STOPPED);
    loop.hal.ops->stop(loop.hal.context);
}

int main(void)
{
    if (!mct_board_start()) {
        return EXIT_NO_CLOCK;
    }
    if (mct_systick_start(MCT_BOARD_CORE_MHZ, mct_compiled_can.dt) != MCT_OK) {
        return EXIT_NO_TICK;
    }
    bus = (mct_bxcan){.registers = (mct_bxcan_registers *)CAN1_BASE,
                      .clock_hz = MCT_BOARD_CAN_HZ,
                      .bitrate = (uint32_t)mct_compiled_scene.scene.can_bitrate,
                      .now_us = mct_systick_us};
    if (!mct_bxcan_self_test(&bus, &why)) {
        return EXIT_NO_CAN;
    }
    loop = mct_compiled_loop;
    loop.hal = open_hal();
    stop();
    if (!mct_board_watchdog_start(TICKS_WITHOUT_FEEDING * can.tick_us)) {
        stop();
        return EXIT_NO_WATCHDOG;
    }
    bool was_pressed = true; /* one that is held from the start, or stuck, arms nothing */
    for (;;) {
        const bool is_pressed = mct_board_button();
        if (is_pressed && !was_pressed) {
            mct_loop_rearm(&loop);
        }
        was_pressed = is_pressed;
        mct_board_watchdog_feed();
        mct_board_show_tick();
        mct_loop_tick(&loop);
        mct_board_show_well(loop.record.faults == 0);
    }
}

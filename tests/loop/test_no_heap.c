/* After init, the loop and the sim HAL do not touch the heap: counted by functions that stand in for the C
 * library's. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hal/sim/sim.h"
#include "hal/socketcan/can.h"
#include "hal/socketcan/drive.h"
#include "hal/socketcan/ring.h"
#include "mctau/loop.h"
#include "support/scenes.h"
#include "support/swing_up.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static long calls;

#if defined __GLIBC__ && !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
#define COUNTS 1
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *old, size_t size);
extern void __libc_free(void *memory);
extern void *__libc_memalign(size_t alignment, size_t size);

void *malloc(size_t size)
{
    calls++;
    return __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    calls++;
    return __libc_calloc(count, size);
}

void *realloc(void *old, size_t size)
{
    calls++;
    return __libc_realloc(old, size);
}

void free(void *memory)
{
    calls++;
    __libc_free(memory);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    calls++;
    return __libc_memalign(alignment, size);
}
#else
#define COUNTS 0
#endif

static void test_the_counter_sees_a_call(void)
{
    void *volatile memory = malloc(1);
    free(memory);
    TEST_ASSERT_TRUE(calls >= 2);
}

/* Init is held to the same, although only the run is promised. */
static void test_a_run_of_loop_and_sim_uses_no_heap(void)
{
    static mct_loop loop;
    static mct_plan plan;
    static mct_sim sim;
    static mct_ring ring;
    for (int system = 0; system < CENTRAL_SYSTEMS; system++) {
        mct_scene scene = swing_up_scene(system);
        scene.noise = 1;
        scene.latency = 1;
        calls = 0;
        memset(&ring, 0, sizeof ring);
        mct_status status = mct_sim_init(&sim, &scene, NULL);
        const mct_hal hal = mct_sim_hal(&sim);
        status = status == MCT_OK
                     ? mct_loop_init(&loop, &plan, &scene, hal, &ring, (mct_samples){NULL, 0}, NULL)
                     : status;
        status = status == MCT_OK ? hal.ops->open(hal.context, NULL) : status;
        for (int k = 0; k < 12000; k++) { /* past a swing-up, and past a full ring */
            mct_loop_tick(&loop);
        }
        hal.ops->stop(hal.context);
        hal.ops->close(hal.context);
        const long counted = calls;
        TEST_ASSERT_EQUAL_INT(MCT_OK, status);
        TEST_ASSERT_EQUAL_INT(0, counted);
        TEST_ASSERT_EQUAL_UINT64(12000 - MCT_RING_SIZE, ring.dropped);
        TEST_ASSERT_EQUAL_INT(MCT_MODE_BALANCE, loop.controller.mode);
    }
}

/* Both ends of the bus, start included. */
static void test_a_run_over_a_bus_uses_no_heap(void)
{
    static mct_loop loop;
    static mct_plan plan;
    static mct_can can;
    static mct_can_drive drive;
    static mct_can_ring bus;
    for (int32_t protocol = MCT_CAN_NATIVE; protocol <= MCT_CAN_ODRIVE; protocol++) {
        mct_scene scene = swing_up_scene(1);
        scene.can_protocol = protocol;
        calls = 0;
        mct_can_ring_init(&bus);
        mct_status status = mct_can_drive_init(&drive, &scene, mct_can_ring_end(&bus, 1), NULL);
        mct_can_drive_serve(&drive, &bus);
        status = status == MCT_OK ? mct_can_drive_open(&drive, NULL) : status;
        status =
            status == MCT_OK ? mct_can_init(&can, &scene, mct_can_ring_end(&bus, 0), true, NULL) : status;
        const mct_hal hal = mct_can_hal(&can);
        status = status == MCT_OK ? hal.ops->open(hal.context, NULL) : status;
        status = status == MCT_OK
                     ? mct_loop_init(&loop, &plan, &scene, hal, NULL, (mct_samples){NULL, 0}, NULL)
                     : status;
        for (int k = 0; k < 12000; k++) {
            mct_loop_tick(&loop);
        }
        hal.ops->close(hal.context);
        mct_can_drive_close(&drive);
        const long counted = calls;
        TEST_ASSERT_EQUAL_INT(MCT_OK, status);
        TEST_ASSERT_EQUAL_INT(0, counted);
        TEST_ASSERT_EQUAL_INT(MCT_MODE_BALANCE, loop.controller.mode);
    }
}

int main(void)
{
    const char *const sanitizers = getenv("MCTAU_SANITIZE");
    if (!COUNTS || (sanitizers != NULL && sanitizers[0] != 0)) {
        puts("skipped: the heap of this build cannot be counted (sanitizers, or another C library than "
             "glibc)");
        return 77;
    }
    UNITY_BEGIN();
    RUN_TEST(test_the_counter_sees_a_call);
    RUN_TEST(test_a_run_of_loop_and_sim_uses_no_heap);
    RUN_TEST(test_a_run_over_a_bus_uses_no_heap);
    return UNITY_END();
}

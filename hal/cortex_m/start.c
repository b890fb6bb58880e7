/*
 * From reset to main: vector table, FPU, .data and .bss. For a Cortex-M4F or M7, with any linker script that
 * has the symbols of sections.ld. Of the C library it needs memcpy and memset alone.
 *
 * Handlers have the names that CMSIS gives them, and are weak: an image that has its own defines it.
 */
#include <stdint.h>
#include <string.h>

#include "start.h"

int main(void);
void Reset_Handler(void);
void HardFault_Handler(void);
void NMI_Handler(void);
void SVC_Handler(void);
void DebugMon_Handler(void);
void PendSV_Handler(void);
void SysTick_Handler(void);

extern uint32_t mct_stack_top[];
extern uint8_t mct_data_begin[], mct_data_end[], mct_bss_begin[], mct_bss_end[];
extern const uint8_t mct_data_image[];

/* Bus, usage and memory faults are not enabled of their own and come here, too. */
__attribute__((weak)) void HardFault_Handler(void)
{
    mct_image_end("hard fault\n", MCT_EXIT_FAULT);
}

/* For those that nothing has enabled. */
static void unexpected(void)
{
    mct_image_end("an interrupt without a handler\n", MCT_EXIT_FAULT);
}

#define OR_UNEXPECTED __attribute__((weak, alias("unexpected")))
OR_UNEXPECTED void NMI_Handler(void);
OR_UNEXPECTED void SVC_Handler(void);
OR_UNEXPECTED void DebugMon_Handler(void);
OR_UNEXPECTED void PendSV_Handler(void);
OR_UNEXPECTED void SysTick_Handler(void);

/* What the processor reads at address 0: ARMv7-M Architecture Reference Manual, B1.5.3. */
typedef struct {
    uint32_t *stack;
    void (*handlers[15])(void);
} vectors;

__attribute__((section(".vectors"), used)) static const vectors table = {
    mct_stack_top,
    {Reset_Handler, NMI_Handler, HardFault_Handler, HardFault_Handler, HardFault_Handler, HardFault_Handler,
     NULL, NULL, NULL, NULL, SVC_Handler, DebugMon_Handler, NULL, PendSV_Handler, SysTick_Handler},
};

__attribute__((noinline, noreturn)) static void start(void)
{
    memcpy(mct_data_begin, mct_data_image, (size_t)(mct_data_end - mct_data_begin));
    memset(mct_bss_begin, 0, (size_t)(mct_bss_end - mct_bss_begin));
    mct_image_end(NULL, main());
}

/* No floating-point instruction may come before the FPU is on, so all else is in another function. */
void Reset_Handler(void)
{
    volatile uint32_t *const coprocessor_access = (volatile uint32_t *)0xE000ED88; /* CPACR */
    *coprocessor_access |= UINT32_C(0xF) << 20;                                    /* CP10 and CP11: full */
    __asm__ volatile("dsb\n\tisb" ::: "memory");
    start();
}

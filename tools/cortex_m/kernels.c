/*
 * Where each kernel lies: an image for the emulator, of all systems. Prints a line for each system, stepper and set of
 * effects that has one: name, name, set and address, the last two in hexadecimal, and the kernel's own name.
 */
#include <stddef.h>

#include "hal/cortex_m/semihosting.h"
#include "mctau/effects.h"
#include "mctau/stepper.h"
#include "mctau/system.h"

static void write_hex(uint32_t value)
{
    char text[10] = " ";
    for (int i = 0; i < 8; i++) {
        text[1 + i] = "0123456789abcdef"[(value >> (28 - 4 * i)) & 15];
    }
    text[9] = '\0';
    mct_semihosting_write(text);
}

int main(void)
{
    for (int i = 0; i < MCT_SYSTEM_COUNT; i++) {
        const mct_system *system = mct_systems[i];
        const uint32_t all = system->effects & MCT_KERNEL_EFFECTS;
        for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
            uint32_t effects = 0;
            do {
                const mct_named_kernel *kernel = system->kernel(stepper, effects);
                if (kernel != NULL) {
                    mct_semihosting_write(system->name);
                    mct_semihosting_write(" ");
                    mct_semihosting_write(mct_steppers[stepper].name);
                    write_hex(effects);
                    write_hex((uint32_t)(uintptr_t)kernel->function);
                    mct_semihosting_write(" ");
                    mct_semihosting_write(kernel->name);
                    mct_semihosting_write("\n");
                }
                effects = (effects - all) & all; /* the next subset */
            } while (effects != 0);
        }
    }
    return 0;
}

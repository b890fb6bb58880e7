#include "kernel_bytes.h"

#include <stddef.h>

#include "mctau/effects.h"
#include "mctau/stepper.h"
#include "mctau/system.h"

/* A system as it was measured: bit i of an index into `bytes` is the i-th bit of `effects`; 0 where there is no kernel. */
typedef struct {
    uint32_t effects;
    const uint16_t *bytes[MCT_STEPPER_COUNT];
} measured_system;

#include "kernel_bytes_table.h"

int mct_kernel_bytes(int system, int stepper, uint32_t effects)
{
    const measured_system *const measured = &measured_systems[system];
    const uint16_t *const bytes = measured->bytes[stepper];
    const uint32_t wanted = effects & MCT_KERNEL_EFFECTS;
    if (bytes == NULL || (wanted & ~measured->effects) != 0) {
        return -1;
    }
    int index = 0;
    int place = 0;
    for (int bit = 0; bit < 32; bit++) {
        if ((measured->effects >> bit) & 1) {
            index |= (int)((wanted >> bit) & 1) << place++;
        }
    }
    return bytes[index] > 0 ? bytes[index] : -1;
}

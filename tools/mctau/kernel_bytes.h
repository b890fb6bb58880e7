/*
 * Flash that the kernels take on a Cortex-M4F, in float: kernel_bytes_table.h, measured by tools/effects --flash.
 */
#ifndef MCTAU_KERNEL_BYTES_H
#define MCTAU_KERNEL_BYTES_H

#include <stdint.h>

/*
 * Bytes of the kernel with all that it calls, whoever else calls that too.
 * system: index into mct_systems; stepper: MCT_STEPPER_...; effects: any set, of which those of kernels count.
 * Returns -1 where there is no such kernel or it was not measured.
 */
int mct_kernel_bytes(int system, int stepper, uint32_t effects);

#endif

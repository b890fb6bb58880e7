/*
 * What gcc calls to store or load 64 bits at once (the counters of hal.h, the ring of record.h), which a Cortex-M has
 * no instruction for: no interrupt comes between the halves. With one core, every order of memory is kept.
 */
#include "processor.h"

uint64_t __atomic_load_8(const volatile void *place, int order);
void __atomic_store_8(volatile void *place, uint64_t value, int order);

uint64_t __atomic_load_8(const volatile void *place, int order)
{
    (void)order;
    const uint32_t before = mct_interrupts_hold();
    const uint64_t value = *(const volatile uint64_t *)place;
    mct_interrupts_restore(before);
    return value;
}

void __atomic_store_8(volatile void *place, uint64_t value, int order)
{
    (void)order;
    const uint32_t before = mct_interrupts_hold();
    *(volatile uint64_t *)place = value;
    mct_interrupts_restore(before);
}

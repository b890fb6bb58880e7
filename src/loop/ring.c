#include "mctau/record.h"

static size_t load(const size_t *counter)
{
    return __atomic_load_n(counter, __ATOMIC_ACQUIRE);
}

static void store(size_t *counter, size_t value)
{
    __atomic_store_n(counter, value, __ATOMIC_RELEASE);
}

bool mct_ring_is_full(const mct_ring *ring)
{
    return load(&ring->head) - load(&ring->tail) >= MCT_RING_SIZE;
}

bool mct_ring_push(mct_ring *ring, const mct_record *record)
{
    if (mct_ring_is_full(ring)) {
        store(&ring->dropped, ring->dropped + 1);
        return false;
    }
    const size_t head = ring->head;
    ring->records[head % MCT_RING_SIZE] = *record;
    store(&ring->head, head + 1);
    return true;
}

const mct_record *mct_ring_peek(const mct_ring *ring)
{
    const size_t tail = ring->tail;
    return load(&ring->head) == tail ? NULL : &ring->records[tail % MCT_RING_SIZE];
}

void mct_ring_pop(mct_ring *ring)
{
    store(&ring->tail, ring->tail + 1);
}

#include "hal/socketcan/ring.h"

#include <string.h>

#include "hal/socketcan/filter.h"

static bool is_lost(mct_can_link_state state)
{
    return state == MCT_CAN_DOWN || state == MCT_CAN_GONE || state == MCT_CAN_BUS_OFF;
}

/* Notes what has become of the link since the last look. @return whether it carries */
static bool look(mct_can_ring_port *self)
{
    const mct_can_link_state state = self->ring->state;
    if (self->open && is_lost(state) && !is_lost(self->seen)) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_LINK_LOST);
        mct_hal_count(&self->counts->values[MCT_CAN_COUNT_SKIPPED], self->count);
        self->count = 0;
    }
    if (self->open && !is_lost(state) && is_lost(self->seen)) {
        mct_can_counted(self->counts, MCT_CAN_COUNT_LINK_BACK);
    }
    self->seen = state;
    return self->open && state == MCT_CAN_UP;
}

static mct_status ring_open(void *context, const mct_can_filter *filters, int count, mct_can_counts *counts,
                            mct_message *why)
{
    mct_can_ring_port *self = context;
    if (!mct_can_check_filters(filters, count, why)) {
        return MCT_ERROR_IO;
    }
    for (int i = 0; i < count; i++) {
        self->filters[i] = filters[i];
    }
    self->filter_count = count;
    self->counts = counts;
    self->count = 0;
    self->seen = MCT_CAN_UP;
    self->open = true;
    return MCT_OK;
}

static bool ring_send(void *context, const mct_can_frame *frame)
{
    mct_can_ring_port *self = context;
    mct_can_ring_port *other = &self->ring->ports[self->other];
    if (!look(self)) {
        if (self->open && self->ring->state == MCT_CAN_UNSENT) {
            mct_can_counted(self->counts, MCT_CAN_COUNT_HELD_BACK);
        }
        return false;
    }
    if (other->open && mct_can_is_wanted(other->filters, other->filter_count, frame)) {
        if (other->count == MCT_CAN_RING_FRAMES) {
            mct_can_counted(self->counts, MCT_CAN_COUNT_QUEUE_FULL);
            return false;
        }
        mct_can_frame *place = &other->frames[(other->head + other->count) % MCT_CAN_RING_FRAMES];
        *place = *frame;
        place->time_us = self->ring->now_us;
        other->count++;
    }
    mct_can_counted(self->counts, MCT_CAN_COUNT_SENT);
    mct_can_counted(self->counts, MCT_CAN_COUNT_CONFIRMED);
    return true;
}

static bool ring_receive(void *context, mct_can_frame *frame)
{
    mct_can_ring_port *self = context;
    if (!look(self) || self->count == 0) {
        return false;
    }
    *frame = self->frames[self->head];
    self->head = (self->head + 1) % MCT_CAN_RING_FRAMES;
    self->count--;
    return true;
}

static bool has_frame(mct_can_ring_port *self)
{
    return look(self) && self->count > 0;
}

static bool ring_wait(void *context, int64_t timeout_us)
{
    mct_can_ring_port *self = context;
    mct_can_ring *ring = self->ring;
    const mct_can_ring_port *other = &ring->ports[self->other];
    if (has_frame(self)) {
        return true;
    }
    if (other->service == NULL) {
        mct_can_ring_advance(ring, timeout_us);
    } else if (!ring->serving) {
        ring->serving = true;
        other->service(other->service_context, timeout_us);
        ring->serving = false;
    }
    return has_frame(self);
}

static int64_t ring_now_us(void *context)
{
    const mct_can_ring_port *self = context;
    return self->ring->now_us;
}

static mct_can_link_state ring_tend(void *context)
{
    mct_can_ring_port *self = context;
    look(self);
    return self->ring->state;
}

static void ring_close(void *context)
{
    mct_can_ring_port *self = context;
    self->open = false;
    self->count = 0;
}

void mct_can_ring_init(mct_can_ring *ring)
{
    memset(ring, 0, sizeof *ring);
    ring->state = MCT_CAN_UP;
    for (int i = 0; i < 2; i++) {
        ring->ports[i].ring = ring;
        ring->ports[i].other = 1 - i;
    }
}

mct_can_transport mct_can_ring_end(mct_can_ring *ring, int end)
{
    static const mct_can_transport_ops ops = {
        .name = "ring",
        .simulated = true,
        .open = ring_open,
        .send = ring_send,
        .receive = ring_receive,
        .wait = ring_wait,
        .now_us = ring_now_us,
        .tend = ring_tend,
        .close = ring_close,
    };
    return (mct_can_transport){&ops, &ring->ports[end != 0]};
}

void mct_can_ring_serve(mct_can_ring *ring, int end, mct_can_ring_service service, void *context)
{
    ring->ports[end != 0].service = service;
    ring->ports[end != 0].service_context = context;
}

void mct_can_ring_advance(mct_can_ring *ring, int64_t us)
{
    ring->now_us += us > 0 ? us : 0;
}

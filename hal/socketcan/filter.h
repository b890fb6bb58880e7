/**
 * @file filter.h
 * What filters let pass, the same for every transport.
 */
#ifndef MCTAU_HAL_SOCKETCAN_FILTER_H
#define MCTAU_HAL_SOCKETCAN_FILTER_H

#include "hal/socketcan/transport.h"

/**
 * Whether a frame shall be received: its identifier is one of the filters', or there are none. A remote
 * request and a frame whose identifier has the other number of bits pass too, for the receiver to refuse and
 * count them.
 */
static inline bool mct_can_is_wanted(const mct_can_filter *filters, int count, const mct_can_frame *frame)
{
    bool wanted = count == 0;
    for (int i = 0; i < count && !wanted; i++) {
        wanted = filters[i].id == frame->id;
    }
    return wanted;
}

/** Whether filters can be kept: not too many, each identifier within its bits. Else a sentence in `why`. */
bool mct_can_check_filters(const mct_can_filter *filters, int count, mct_message *why);

#endif

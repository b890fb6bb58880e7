#include "hal/socketcan/counts.h"

#define MCT_CAN_COUNT_COUNTER(identifier, name, doc) {#name, doc},
const mct_counter mct_can_counters[MCT_CAN_COUNTS] = {MCT_CAN_COUNT_LIST(MCT_CAN_COUNT_COUNTER)};
#undef MCT_CAN_COUNT_COUNTER

/* A HAL shows them all. */
typedef char mct_can_counts_fit[MCT_CAN_COUNTS <= MCT_MAX_COUNTERS ? 1 : -1];

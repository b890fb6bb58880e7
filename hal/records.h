/**
 * @file records.h
 * A stream of records, as an image leaves it: a head, then each record's bytes. `mctau import` makes an event log of it.
 */
#ifndef MCTAU_HAL_RECORDS_H
#define MCTAU_HAL_RECORDS_H

#include <string.h>

#include "mctau/record.h"

#define MCT_RECORDS_MAGIC "mctau-r1"

/** Ahead of the records: who cannot read them sees it by this. Numbers begin with their low byte. */
typedef struct {
    char magic[8];
    uint32_t real_size;   /**< of mct_real [bytes] */
    uint32_t record_size; /**< of mct_record [bytes] */
} mct_records_head;

/** The head of this program's records. */
static inline mct_records_head mct_records_head_here(void)
{
    mct_records_head head = {.real_size = sizeof(mct_real), .record_size = sizeof(mct_record)};
    memcpy(head.magic, MCT_RECORDS_MAGIC, sizeof head.magic);
    return head;
}

#endif

#include "image.h"

#include <string.h>

#include "hal/records.h"
#include "target.h"

/* --- words in and out --- */

bool image_word(int number, char word[IMAGE_WORD])
{
    static char line[2 * IMAGE_WORD];
    if (mct_semihosting_command_line(line, sizeof line) != 0) {
        return false;
    }
    size_t length = 0;
    for (const char *c = line; *c != '\0'; c++) {
        if (*c == ' ') {
            number--;
        } else if (number == 0 && length < IMAGE_WORD) {
            word[length++] = *c;
        }
    }
    if (length == 0 || length == IMAGE_WORD) {
        return false;
    }
    word[length] = '\0';
    return true;
}

uint64_t image_number(int number, uint64_t otherwise)
{
    char word[IMAGE_WORD];
    uint64_t value = 0;
    if (!image_word(number, word)) {
        return otherwise;
    }
    for (const char *digit = word; *digit >= '0' && *digit <= '9'; digit++) {
        value = 10 * value + (uint64_t)(*digit - '0');
    }
    return value;
}

void image_print(const char *name, const uint64_t *values, int count)
{
    mct_semihosting_write(name);
    for (int n = 0; n < count; n++) {
        char text[18] = " ";
        for (int i = 0; i < 16; i++) {
            text[1 + i] = "0123456789abcdef"[(values[n] >> (60 - 4 * i)) & 15];
        }
        text[17] = '\0';
        mct_semihosting_write(text);
    }
    mct_semihosting_write("\n");
}

int image_fail(const char *why)
{
    mct_semihosting_write("failed: ");
    mct_semihosting_write(why);
    mct_semihosting_write("\n");
    return 1;
}

/* --- records --- */

/* FNV-1a, by words. */
static uint64_t hash_of(uint64_t hash, const void *data, size_t size)
{
    for (size_t i = 0; i < size; i += sizeof(uint32_t)) {
        uint32_t word;
        memcpy(&word, (const char *)data + i, sizeof word);
        hash = (hash ^ word) * UINT64_C(0x100000001b3);
    }
    return hash;
}

void image_records_open(image_records *records, int number)
{
    const mct_records_head head = mct_records_head_here();
    char path[IMAGE_WORD];
    records->hash = 0;
    records->is_wanted = image_word(number, path) && path[0] != '-';
    records->file = records->is_wanted ? mct_semihosting_open(path, true) : -1;
    records->is_well = !records->is_wanted ||
                       (records->file != -1 && mct_semihosting_append(records->file, &head, sizeof head));
}

void image_records_add(image_records *records, const mct_record *record)
{
    records->hash = hash_of(records->hash, record, sizeof *record);
    if (records->is_wanted) {
        records->is_well = records->is_well && mct_semihosting_append(records->file, record, sizeof *record);
    }
}

bool image_records_close(image_records *records)
{
    const bool is_closed = records->file == -1 || mct_semihosting_close(records->file);
    return records->is_well && is_closed;
}

/* --- instructions --- */

/* Functions of one instruction, to return, and of a hundred more: what counting costs, and whether it counts. */
__attribute__((noinline)) static void nothing(mct_loop *loop)
{
    (void)loop;
    __asm__ volatile("");
}

__attribute__((noinline)) static void hundred(mct_loop *loop)
{
    (void)loop;
    __asm__ volatile(".rept 100\n\tnop\n\t.endr");
}

__attribute__((noinline)) static uint32_t counted(void (*work)(mct_loop *), mct_loop *loop)
{
    const uint32_t begin = target_clock();
    work(loop);
    return target_instructions(begin, target_clock());
}

bool image_begin(void)
{
    void (*volatile none)(mct_loop *) = nothing;
    void (*volatile more)(mct_loop *) = hundred;
    target_start();
    target_paint_stack();
    return !TARGET_COUNTS || counted(more, NULL) - counted(none, NULL) == 100;
}

void image_tick(mct_loop *loop, image_counts *counts)
{
    void (*volatile none)(mct_loop *) = nothing;
    void (*volatile tick)(mct_loop *) = mct_loop_tick;
    const uint32_t around = counted(none, loop) - 1; /* its return is a tick's, too */
    const uint32_t taken = counted(tick, loop) - around;
    counts->least = counts->ticks == 0 || taken < counts->least ? taken : counts->least;
    counts->most = taken > counts->most ? taken : counts->most;
    counts->sum += taken;
    counts->ticks++;
}

void image_report(const mct_loop *loop, const image_counts *counts, uint64_t hash)
{
    const uint64_t result[] = {counts->ticks, hash, loop->record.faults};
    const uint64_t instructions[] = {counts->least, counts->sum, counts->most};
    const uint64_t stack = target_stack_used();
    image_print("run", result, 3);
    mct_semihosting_write("mode ");
    mct_semihosting_write(mct_mode_name((mct_mode)loop->record.mode));
    mct_semihosting_write("\n");
    for (int i = 0; !TARGET_COUNTS && i < MCT_FAULT_COUNT; i++) { /* an image has no room for names */
        if (loop->record.faults & (1u << i)) {
            mct_semihosting_write("fault ");
            mct_semihosting_write(mct_fault_name((mct_fault)i));
            mct_semihosting_write("\n");
        }
    }
    if (TARGET_COUNTS) {
        image_print("instructions", instructions, 3);
        image_print("stack", &stack, 1);
    }
}

/*
 * Instructions of every stepper that suits a scene, and what its run hashes to. An image for the emulator;
 * compiled for the host (native.c) it gives the same hashes and counts nothing.
 *
 * Prints a line with the number of ticks, then a line for each stepper, numbers in hexadecimal: name, hash of
 * the states after every tick, ticks refused; least, most and sum over all ticks of a further step's
 * instructions, then of a tick's; address of the kernel.
 */
#include <string.h>

#include "hal/cortex_m/semihosting.h"
#include "job.h"
#include "mctau/plant.h"
#include "target.h"

static void write_hex(uint64_t value, int digits)
{
    char text[18];
    text[0] = ' ';
    for (int i = 0; i < digits; i++) {
        text[1 + i] = "0123456789abcdef"[(value >> (4 * (digits - 1 - i))) & 15];
    }
    text[1 + digits] = '\0';
    mct_semihosting_write(text);
}

/* --- hash --- */

static uint64_t with_words(uint64_t hash, const void *data, size_t size)
{
    for (size_t i = 0; i < size; i += sizeof(uint32_t)) {
        uint32_t word;
        memcpy(&word, (const char *)data + i, sizeof word);
        hash = (hash ^ word) * UINT64_C(0x100000001b3); /* FNV-1a's prime */
    }
    return hash;
}

static uint64_t with_state(uint64_t hash, const mct_plant *plant)
{
    const size_t size = (size_t)plant->entries * sizeof(mct_real);
    hash = with_words(hash, plant->state.x, size);
    hash = with_words(hash, plant->state.c, size);
    return with_words(hash, plant->state.turns, sizeof plant->state.turns);
}

/* --- counts --- */

typedef struct {
    uint32_t least, most;
    uint64_t sum;
} counts;

static void counts_add(counts *self, uint32_t value)
{
    self->least = value < self->least ? value : self->least;
    self->most = value > self->most ? value : self->most;
    self->sum += value;
}

static void counts_write(const counts *self)
{
    write_hex(self->least, 8);
    write_hex(self->most, 8);
    write_hex(self->sum, 16);
}

/* Instructions of a kernel and of its call, on a copy of the state. */
__attribute__((noinline)) static uint32_t count_kernel(const mct_plant *plant, mct_real input, int32_t steps)
{
    mct_state state = plant->state;
    const uint32_t begin = target_clock();
    plant->kernel(&plant->constants, &state, input, steps);
    return target_instructions(begin, target_clock());
}

__attribute__((noinline)) static uint32_t count_tick(void (*step)(mct_plant *, mct_real), mct_plant *plant,
                                                     mct_real input)
{
    const uint32_t begin = target_clock();
    step(plant, input);
    return target_instructions(begin, target_clock());
}

/* A function of one instruction, to return; so it shows what counting costs itself. */
__attribute__((noinline)) static void nothing(mct_plant *plant, mct_real input)
{
    (void)plant;
    (void)input;
    __asm__ volatile("");
}

/* A thousand instructions more than nothing. */
__attribute__((noinline)) static void thousand(mct_plant *plant, mct_real input)
{
    (void)plant;
    (void)input;
    __asm__ volatile(".rept 1000\n\tnop\n\t.endr");
}

/* An emulator whose time is not made of instructions would measure something else. */
static bool counts_exactly(void)
{
    void (*volatile none)(mct_plant *, mct_real) = nothing;
    void (*volatile more)(mct_plant *, mct_real) = thousand;
    return count_tick(more, NULL, 0) - count_tick(none, NULL, 0) == 1000;
}

/* A further step is what a kernel takes for two less what it takes for one. */
static uint32_t count_step(const mct_plant *plant, mct_real input)
{
    return count_kernel(plant, input, 2) - count_kernel(plant, input, 1);
}

static void run(const job *self, int stepper)
{
    static mct_plant plant;
    mct_scene scene = self->scene;
    scene.stepper = stepper;
    if (mct_plant_init(&plant, &scene, NULL) != MCT_OK) {
        return;
    }
    void (*volatile step)(mct_plant *, mct_real) = mct_plant_step;
    void (*volatile none)(mct_plant *, mct_real) = nothing;
    uint64_t hash = 0;
    counts of_step = {.least = UINT32_MAX}, of_tick = {.least = UINT32_MAX};
    for (int i = 0; i < self->ticks; i++) {
        const mct_real input = (mct_real)self->inputs[i];
        const uint32_t around = count_tick(none, &plant, input) - 1; /* its return is a tick's, too */
        counts_add(&of_step, count_step(&plant, input));
        counts_add(&of_tick, count_tick(step, &plant, input) - around);
        hash = with_state(hash, &plant);
    }
    mct_semihosting_write(mct_steppers[stepper].name);
    write_hex(hash, 16);
    write_hex(plant.diverged_ticks, 8);
    counts_write(&of_step);
    counts_write(&of_tick);
    write_hex((uintptr_t)plant.kernel, 16);
    mct_semihosting_write("\n");
}

static int fail(const char *why)
{
    mct_semihosting_write("failed: ");
    mct_semihosting_write(why);
    mct_semihosting_write("\n");
    return 1;
}

/* The command line: the image's own name, the job's file. */
int main(void)
{
    static job self;
    static char line[1024];
    if (mct_semihosting_command_line(line, sizeof line) != 0 || strchr(line, ' ') == NULL) {
        return fail("no job given");
    }
    if (mct_semihosting_read_file(strchr(line, ' ') + 1, &self, sizeof self) != (int32_t)sizeof self ||
        self.size != sizeof self) {
        return fail("the job cannot be read, or is another version's");
    }
    target_start();
    if (TARGET_COUNTS && !counts_exactly()) {
        return fail("the emulator's timer does not count instructions");
    }
    mct_semihosting_write("ticks");
    write_hex((uint64_t)self.ticks, 8);
    mct_semihosting_write("\n");
    for (int stepper = 0; stepper < MCT_STEPPER_COUNT; stepper++) {
        if (self.suited[stepper]) {
            run(&self, stepper);
        }
    }
    return 0;
}

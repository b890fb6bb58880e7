/*
 * Drives a fuzz target without libFuzzer: seeds, then mutations of what has reached something new, told by the
 * compiler's -fsanitize-coverage=trace-pc. Nothing depends on the clock or on addresses: the same program makes the
 * same runs.
 *
 *   fuzz_NAME_smoke [--runs N] [--seconds N] [--seed N]   ends at whatever comes first
 *   fuzz_NAME_smoke --input HEX                           one input, as a failure prints it
 *   fuzz_NAME_smoke --file FILE                           one input
 *   fuzz_NAME_smoke --write-seeds FOLDER
 */
#include <signal.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "fuzz/fuzz.h"
#include "mctau/mix.h"

enum { MAP = 1 << 16, MOST_KEPT = 4096, LONGEST_RUN = 20 /* [s] */ };

typedef struct {
    size_t size;
    uint8_t *data;
} kept_input;

static struct {
    uint64_t state;
    kept_input kept[MOST_KEPT];
    int kept_count;
    /* of the present run, for who tells of its failure */
    uint64_t seed, run;
    const uint8_t *data;
    size_t size;
    bool running, told;
} self;

/* --- coverage --- */

static uint8_t hits[MAP], seen[MAP];
static uint64_t place;

void __sanitizer_cov_trace_pc(void);
void __sanitizer_cov_trace_pc(void)
{
    const uint64_t here =
        mct_mix((uint64_t)((char *)__builtin_return_address(0) - (char *)&LLVMFuzzerTestOneInput));
    uint8_t *count = &hits[(here ^ place) % MAP];
    *count = (uint8_t)(*count + (*count < UINT8_MAX));
    place = here >> 1;
}

/* Whether a way was gone that no run went before, or another number of times: 1, 2, 3, 4-7, 8-15, ... */
static bool is_new(void)
{
    bool found = false;
    for (size_t i = 0; i < MAP; i += sizeof(uint64_t)) {
        uint64_t word;
        memcpy(&word, &hits[i], sizeof word);
        for (size_t j = i; word != 0 && j < i + sizeof word; j++) {
            const unsigned n = hits[j];
            const uint8_t bit = (uint8_t)(n == 0    ? 0
                                          : n < 4   ? 1 << (n - 1)
                                          : n < 8   ? 8
                                          : n < 16  ? 16
                                          : n < 32  ? 32
                                          : n < 128 ? 64
                                                    : 128);
            found |= (bit & ~seen[j]) != 0;
            seen[j] |= bit;
        }
    }
    return found;
}

/* --- failures --- */

static void tell(void)
{
    if (!self.running || self.told) {
        return;
    }
    self.told = true;
    fprintf(stderr, "\nseed %llu, run %llu, input of %zu bytes; to see it again: --input ",
            (unsigned long long)self.seed, (unsigned long long)self.run, self.size);
    for (size_t i = 0; i < self.size; i++) {
        fprintf(stderr, "%02x", self.data[i]);
    }
    fprintf(stderr, "%s\n", self.size == 0 ? "''" : "");
}

static void on_signal(int number)
{
    if (number == SIGALRM) {
        fprintf(stderr, "broken rule: a run ends (none did for %d s)\n", LONGEST_RUN);
    }
    tell();
    _exit(1);
}

/* Called by the sanitizers' runtime; weak where there is none. */
void __sanitizer_set_death_callback(void (*callback)(void)) __attribute__((weak));
const char *__asan_default_options(void);
const char *__asan_default_options(void)
{
    return "detect_leaks=0"; /* nothing here has a heap, and the search needs rights that a container may lack */
}

static void run(const uint8_t *data, size_t size)
{
    /* A block of its own, so that a read beyond its end is seen. */
    uint8_t *copy = malloc(size > 0 ? size : 1);
    if (size > 0) {
        memcpy(copy, data, size);
    }
    self.data = copy;
    self.size = size;
    self.running = true;
    memset(hits, 0, sizeof hits);
    place = 0;
    alarm(LONGEST_RUN);
    LLVMFuzzerTestOneInput(copy, size);
    alarm(0);
    self.running = false;
    self.run++;
    free(copy);
}

/* --- inputs --- */

static uint64_t draw(uint64_t below)
{
    self.state += MCT_MIX_STEP;
    return mct_mix(self.state) % below;
}

static void keep(const uint8_t *data, size_t size)
{
    kept_input *place_of = &self.kept[self.kept_count < MOST_KEPT ? self.kept_count++ : (int)draw(MOST_KEPT)];
    free(place_of->data);
    place_of->data = malloc(size > 0 ? size : 1);
    place_of->size = size;
    memcpy(place_of->data, data, size);
}

/* Every second time one of the newest. */
static const kept_input *choose(void)
{
    const uint64_t count = (uint64_t)self.kept_count;
    const uint64_t newest = count < 32 ? count : 32;
    return &self.kept[draw(2) == 0 ? draw(count) : count - 1 - draw(newest)];
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

static size_t insert(uint8_t *data, size_t size, size_t at, const uint8_t *piece, size_t length)
{
    const size_t room = least(length, FUZZ_LONGEST - size);
    memmove(data + at + room, data + at, size - at);
    memcpy(data + at, piece, room);
    return size + room;
}

static size_t mutate_once(uint8_t *data, size_t size)
{
    static const uint8_t telling[] = {0,    1,    2,    7,    8,    9,   16,  0x7E, 0x7F, 0x80,
                                      0x81, 0xC0, 0xFE, 0xFF, '\n', ' ', '#', '.',  '-',  '"',
                                      '=',  '[',  '0',  '1',  '9',  'R', 'e', '_'};
    uint8_t piece[64];
    const size_t at = size > 0 ? draw(size) : 0;
    const size_t length = 1 + draw(draw(4) == 0 ? sizeof piece : 8);
    const kept_input *other = choose();
    switch (draw(size > 0 ? 9 : 1)) {
    case 0: /* new bytes */
        for (size_t i = 0; i < length; i++) {
            piece[i] = (uint8_t)draw(256);
        }
        return insert(data, size, at, piece, length);
    case 1:
        data[at] = (uint8_t)(data[at] ^ 1u << draw(8));
        return size;
    case 2:
        data[at] = (uint8_t)draw(256);
        return size;
    case 3:
        data[at] = telling[draw(sizeof telling)];
        return size;
    case 4:
        data[at] = (uint8_t)(data[at] + draw(33) - 16);
        return size;
    case 5: { /* out with a piece */
        const size_t gone = least(length, size - at);
        memmove(data + at, data + at + gone, size - at - gone);
        return size - gone;
    }
    case 6: /* a piece once more, somewhere */
        memcpy(piece, data + at, least(length, size - at));
        return insert(data, size, draw(size), piece, least(length, size - at));
    case 7: { /* a piece of another input */
        const size_t from = other->size > 0 ? draw(other->size) : 0;
        memcpy(piece, other->data + from, least(length, other->size - from));
        return insert(data, size, at, piece, least(length, other->size - from));
    }
    default: { /* from here on another input */
        const size_t from = other->size > 0 ? draw(other->size) : 0;
        const size_t rest = least(other->size - from, FUZZ_LONGEST - at);
        memcpy(data + at, other->data + from, rest);
        return at + rest;
    }
    }
}

static void run_mutation(void)
{
    uint8_t data[FUZZ_LONGEST];
    const kept_input *origin = choose();
    size_t size = origin->size;
    memcpy(data, origin->data, size);
    for (uint64_t left = draw(2) == 0 ? 1 : 1 + draw(10); left > 0; left--) {
        size = mutate_once(data, size);
    }
    run(data, size);
    if (is_new()) {
        keep(data, size);
    }
}

static void run_seeds(void)
{
    uint8_t data[FUZZ_LONGEST];
    size_t size;
    for (int i = 0; (size = fuzz_seed(i, data)) > 0; i++) {
        run(data, size);
        is_new();
        keep(data, size);
    }
    run(data, 0);
}

/* --- other ways to start --- */

static int run_hex(const char *text)
{
    static uint8_t data[1 << 20];
    size_t size = 0;
    unsigned byte;
    for (; size < sizeof data && sscanf(text + 2 * size, "%2x", &byte) == 1; size++) {
        data[size] = (uint8_t)byte;
    }
    run(data, size);
    return 0;
}

static int run_file(const char *path)
{
    static uint8_t data[1 << 20];
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        perror(path);
        return 3;
    }
    run(data, fread(data, 1, sizeof data, file));
    fclose(file);
    return 0;
}

static int write_seeds(const char *folder)
{
    uint8_t data[FUZZ_LONGEST];
    size_t size;
    for (int i = 0; (size = fuzz_seed(i, data)) > 0; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/seed-%03d", folder, i);
        FILE *file = fopen(path, "wb");
        if (file == NULL || fwrite(data, 1, size, file) != size || fclose(file) != 0) {
            perror(path);
            return 3;
        }
    }
    return 0;
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

int main(int count, char **words)
{
    uint64_t runs = UINT64_MAX;
    double seconds = 1e9;
    self.seed = 1;
    if (__sanitizer_set_death_callback != NULL) {
        __sanitizer_set_death_callback(tell);
    }
    signal(SIGABRT, on_signal);
    signal(SIGALRM, on_signal);
    for (int i = 1; i + 1 < count; i += 2) {
        const char *option = words[i], *value = words[i + 1];
        if (strcmp(option, "--runs") == 0) {
            runs = strtoull(value, NULL, 10);
        } else if (strcmp(option, "--seconds") == 0) {
            seconds = strtod(value, NULL);
        } else if (strcmp(option, "--seed") == 0) {
            self.seed = strtoull(value, NULL, 10);
        } else if (strcmp(option, "--input") == 0) {
            return run_hex(value);
        } else if (strcmp(option, "--file") == 0) {
            return run_file(value);
        } else if (strcmp(option, "--write-seeds") == 0) {
            return write_seeds(value);
        } else {
            fprintf(stderr, "%s: unknown option %s\n", words[0], option);
            return 2;
        }
    }
    self.state = mct_mix(self.seed);
    const double begin = now();
    run_seeds();
    const int seeds = self.kept_count;
    while (self.run < runs && (self.run % 64 != 0 || now() - begin < seconds)) {
        run_mutation();
    }
    printf("%llu runs in %.1f s, seed %llu, %d inputs kept of which %d seeds\n", (unsigned long long)self.run,
           now() - begin, (unsigned long long)self.seed, self.kept_count, seeds);
    return 0;
}

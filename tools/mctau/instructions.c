#define _DEFAULT_SOURCE /* syscall, mkstemp */
#include "instructions.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define NOTE "MCTAU_INSTRUCTIONS_NOTE" /* in the environment */

enum { BY_MARKS = 1 << 20 }; /* a handle that is no file's */

const char *instructions_note(void)
{
    return getenv(NOTE);
}

/* Does nothing; callgrind writes down its counts when it returns. */
__attribute__((noinline)) void instructions_mark(void);

void instructions_mark(void)
{
    __asm__ volatile(""); /* so that no call of it is left out */
}

#if defined __linux__
#include <fcntl.h>
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>

int instructions_open(void)
{
    if (instructions_note() != NULL) {
        return BY_MARKS;
    }
    struct perf_event_attr what;
    memset(&what, 0, sizeof what);
    what.size = sizeof what;
    what.type = PERF_TYPE_HARDWARE;
    what.config = PERF_COUNT_HW_INSTRUCTIONS;
    what.disabled = 1;
    what.exclude_kernel = 1;
    what.exclude_hv = 1;
    return (int)syscall(SYS_perf_event_open, &what, 0, -1, -1, 0);
}

void instructions_begin(int handle)
{
    if (handle == BY_MARKS) {
        instructions_mark();
        return;
    }
    ioctl(handle, PERF_EVENT_IOC_RESET, 0);
    ioctl(handle, PERF_EVENT_IOC_ENABLE, 0);
}

uint64_t instructions_end(int handle)
{
    uint64_t count = 0;
    if (handle == BY_MARKS) {
        instructions_mark();
        return 0;
    }
    ioctl(handle, PERF_EVENT_IOC_DISABLE, 0);
    return read(handle, &count, sizeof count) == (ssize_t)sizeof count ? count : 0;
}

enum { LONGEST_COMMAND = 1 << 17, OUR_WORDS = 6, MOST_WORDS = 512, NOT_FOUND = 127 };

/* The command line of this process, words one behind the other; behind `first` words. False where it is too long. */
static bool own_words(char *text, char **words, int first)
{
    FILE *file = fopen("/proc/self/cmdline", "rb");
    const size_t length = file != NULL ? fread(text, 1, LONGEST_COMMAND - 1, file) : 0;
    int count = first;
    if (file != NULL) {
        fclose(file);
    }
    for (size_t i = 0; i < length && count < MOST_WORDS - 1; i += strlen(text + i) + 1) {
        words[count++] = text + i;
    }
    words[count] = NULL;
    return length > 0 && length < LONGEST_COMMAND - 1 && count < MOST_WORDS - 1;
}

/* Runs a command without any output; its exit code, NOT_FOUND where there is none. */
static int run(char **words, const char *note)
{
    const pid_t child = fork();
    int status = -1;
    if (child == 0) {
        const int nowhere = open("/dev/null", O_RDWR);
        for (int i = 0; i <= 2; i++) {
            dup2(nowhere, i);
        }
        setenv(NOTE, note, 1);
        execvp(words[0], words);
        _exit(NOT_FOUND);
    }
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* Lines "totals: N", one for each mark; the second of each pair counts what lies between. */
static size_t read_totals(const char *path, uint64_t *counts, size_t pieces)
{
    char line[256];
    size_t found = 0;
    unsigned long long total;
    FILE *file = fopen(path, "r");
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        if (sscanf(line, "totals: %llu", &total) == 1) {
            if (found % 2 == 1 && found / 2 < pieces) {
                counts[found / 2] = total;
            }
            found++;
        }
    }
    if (file != NULL) {
        fclose(file);
    }
    return found / 2;
}

const char *instructions_by_valgrind(const char *note, uint64_t *counts, size_t pieces)
{
    char path[] = "/tmp/mctau-count-XXXXXX", out[64], program[4096];
    char *words[MOST_WORDS] = {
        "valgrind", "--tool=callgrind", "--dump-after=instructions_mark", "--combine-dumps=yes", out,
        program};
    char *text = malloc(LONGEST_COMMAND);
    const ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = '\0';
    const bool known = text != NULL && length > 0 && own_words(text, words, OUR_WORDS - 1);
    words[OUR_WORDS - 1] = program; /* not as it was called: that may be looked up in the path */
    const int file = known ? mkstemp(path) : -1;
    if (file < 0) {
        free(text);
        return "valgrind cannot be given this command once more";
    }
    close(file);
    snprintf(out, sizeof out, "--callgrind-out-file=%s", path);
    const int exit_code = run(words, note);
    const size_t found = exit_code == 0 ? read_totals(path, counts, pieces) : 0;
    unlink(path);
    free(text);
    return exit_code == NOT_FOUND ? "valgrind is not installed"
           : exit_code != 0       ? "valgrind cannot run this program"
           : found != pieces ? "valgrind does not see where the pieces of work begin (a stripped program?)"
                             : NULL;
}
#else
int instructions_open(void)
{
    return -1;
}

void instructions_begin(int handle)
{
    (void)handle;
}

uint64_t instructions_end(int handle)
{
    (void)handle;
    return 0;
}

const char *instructions_by_valgrind(const char *note, uint64_t *counts, size_t pieces)
{
    (void)note, (void)counts, (void)pieces;
    return "not known on this system";
}
#endif

void instructions_close(int handle)
{
    if (handle >= 0 && handle != BY_MARKS) {
        close(handle);
    }
}

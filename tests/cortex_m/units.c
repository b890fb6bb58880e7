/*
 * Many tests in one image, since they share the core: the command line names the one that runs. Files that it reads are
 * found from the repository's root.
 *
 *     hal/cortex_m/run m4f build/cortex-m4f/units_f32.elf test_scene
 */
#include <stdio.h>
#include <string.h>

#include "hal/cortex_m/semihosting.h"

/* A test's main, setUp and tearDown are renamed as it is compiled. */
#define UNIT(name)           \
    int name##_main(void);   \
    void name##_setUp(void); \
    void name##_tearDown(void);
#include "units.h"
#undef UNIT

typedef struct {
    const char *name;
    int (*main)(void);
    void (*set_up)(void);
    void (*tear_down)(void);
} unit;

#define UNIT(name) {#name, name##_main, name##_setUp, name##_tearDown},
static const unit units[] = {
#include "units.h"
};

static const unit *running;

/* What Unity calls. */
void setUp(void);
void tearDown(void);

void setUp(void)
{
    running->set_up();
}

void tearDown(void)
{
    running->tear_down();
}

void initialise_monitor_handles(void); /* newlib's: opens stdin, stdout and stderr */

int main(void)
{
    enum { UNKNOWN = 2 };
    static char line[1000];
    initialise_monitor_handles();
    if (mct_semihosting_command_line(line, sizeof line) != 0 || strtok(line, " ") == NULL) {
        return UNKNOWN;
    }
    const char *const name = strtok(NULL, " ");
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++) {
        if (name != NULL && strcmp(name, units[i].name) == 0) {
            running = &units[i];
            const int code = running->main();
            fflush(stdout);
            return code;
        }
    }
    printf("no such test: %s\n", name != NULL ? name : "none is named");
    fflush(stdout);
    return UNKNOWN;
}

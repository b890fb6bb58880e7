#include "fuzz/command.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <math.h>
#include <setjmp.h>
#include <string.h>
#include <unistd.h>

#include "fuzz/fuzz.h"
#include "mctau/scene.h"
#include "runner.h"
#include "runner_cost.h"

enum { FILES = FUZZ_COMMAND_FILES, LOG = FILES - 1, MOST_BYTES = 1 << 16, SAID = 1 << 14 };

static struct {
    int home, folder; /* descriptors */
    char place[32];
    char said[SAID];
    jmp_buf end;
    int exit_code;
} self;

static struct {
    const char *name;
    size_t size;
    uint8_t data[MOST_BYTES];
} files[FILES] = {{.name = "scene.toml"}, {.name = "free.toml"}, {.name = "csv.toml"},
                  {.name = "input.csv"},  {.name = "bus.log"},   {.name = "run.lcm"}};

/* --- what the command's sources call instead, see command_inside.h --- */

FILE *fuzz_stderr;
void fuzz_exit(int code) __attribute__((noreturn));
pid_t fuzz_fork(void);
int fuzz_sigaction(void);
int fuzz_main(int argc, char **argv);

void fuzz_exit(int code)
{
    self.exit_code = code;
    longjmp(self.end, 1);
}

pid_t fuzz_fork(void)
{
    errno = ENOSYS;
    return -1;
}

int fuzz_sigaction(void)
{
    return 0;
}

/* Short, in lockstep, and neither on a network nor on a bus that may be there. */
mct_status fuzz_scene_read(const char *text, size_t length, const char *file, const mct_override *overrides,
                           int count, mct_scene *scene, mct_message *why);
mct_status fuzz_scene_read(const char *text, size_t length, const char *file, const mct_override *overrides,
                           int count, mct_scene *scene, mct_message *why)
{
    const mct_status status = mct_scene_read(text, length, file, overrides, count, scene, why);
    if (status == MCT_OK) {
        const double longest = FUZZ_COMMAND_TICKS * scene->dt;
        scene->duration = scene->duration < longest ? scene->duration : longest;
        scene->substeps = scene->substeps < 10 ? scene->substeps : 10;
        scene->realtime = 0;
        scene->lcm[0] = '\0';
        if (strncmp(scene->hal, "socketcan", 9) == 0) {
            strcpy(scene->hal, "ring");
        }
    }
    return status;
}

/* --- what the runner's table holds instead, see fuzz.cmake --- */

/* Times nothing, so that a run depends on its input alone, and ends soon. */
mct_status fuzz_try(const mct_scene *scene, trial *asked, mct_message *why);
mct_status fuzz_try(const mct_scene *scene, trial *asked, mct_message *why)
{
    asked->ns = 1;
    asked->instructions = (double)NAN;
    if (asked->sample_ns > 0 && asked->states == NULL) {
        return MCT_OK;
    }
    asked->sample_ns = 0;
    asked->count = false;
    return runner_try(scene, asked, why);
}

mct_status fuzz_drive(const mct_scene *scene, const drive_options *options, drive_result *result,
                      mct_message *why);
mct_status fuzz_drive(const mct_scene *scene, const drive_options *options, drive_result *result,
                      mct_message *why)
{
    (void)scene;
    (void)options;
    memset(result, 0, sizeof *result);
    mct_message_clear(why);
    mct_message_add(why, "no bus here");
    return MCT_ERROR_IO;
}

/* No case is run: they take seconds, and nothing of the input. */
void fuzz_hard_case(const hard_case *about, bool is_full, hard_result results[HARD_METHOD_COUNT]);
void fuzz_hard_case(const hard_case *about, bool is_full, hard_result results[HARD_METHOD_COUNT])
{
    (void)about;
    (void)is_full;
    memset(results, 0, HARD_METHOD_COUNT * sizeof results[0]);
    results[HARD_LIBRARY].is_tried = true;
}

/* --- the folder --- */

static void must(bool holds, const char *what)
{
    if (!holds) {
        perror(what);
        _exit(3);
    }
}

static void enter(int folder)
{
    must(fchdir(folder) == 0, "fchdir");
}

static void write_file(const char *name, const uint8_t *data, size_t size)
{
    const int file = open(name, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    must(file >= 0 && write(file, data, size) == (ssize_t)size && close(file) == 0, name);
}

static size_t read_file(const char *name, uint8_t *data, size_t size)
{
    const int file = open(name, O_RDONLY | O_CLOEXEC);
    const ssize_t got = file >= 0 ? read(file, data, size) : 0;
    if (file >= 0) {
        close(file);
    }
    return got > 0 ? (size_t)got : 0;
}

static void write_files(void)
{
    for (int i = 0; i < FILES; i++) {
        if (files[i].size > 0) {
            write_file(files[i].name, files[i].data, files[i].size);
        }
    }
}

/* All that a call may have left. */
static void clear_folder(void)
{
    DIR *all = opendir(".");
    must(all != NULL, "opendir");
    for (struct dirent *entry = readdir(all); entry != NULL; entry = readdir(all)) {
        const size_t length = strlen(entry->d_name);
        FUZZ_RULE(length < 4 || strcmp(entry->d_name + length - 4, ".tmp") != 0,
                  "no unfinished file is left: %s", entry->d_name);
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            must(unlink(entry->d_name) == 0, entry->d_name);
        }
    }
    closedir(all);
}

static void give_texts(void)
{
    static const char *const texts[LOG] = {
        "[scene]\nsystem = \"reaction_wheel\"\nstepper = \"expo\"\n[effects]\nmotor = "
        "\"inductive\"\n[initial]\n"
        "arm_angle = 3.0\n[controller]\nkind = \"swing_up_balance\"\n[sensors]\nnoise = 0.5\n",
        "[scene]\nsystem = \"cart_pole\"\nstepper = \"taylor6\"\n[effects]\nmotor = \"none\"\n",
        "[scene]\nsystem = \"cart_pole\"\nstepper = \"rk4\"\n[input]\nkind = \"csv\"\nfile = \"input.csv\"\n"
        "column = \"volts\"\n",
        "time,volts\n0,1\n0.001,-2.5\n0.002,\"3\"\n0.003,4e-1\n",
        "(1436509052.249713) can0 181#0000000000000000\n(1436509052.250713) can0 101#0011223344556677\n",
    };
    for (int i = 0; i < LOG; i++) {
        files[i].size = strlen(texts[i]);
        memcpy(files[i].data, texts[i], files[i].size);
    }
}

/* --- a call --- */

static int call(int argc, char **argv)
{
    const int null = open("/dev/null", O_RDWR | O_CLOEXEC), in = dup(STDIN_FILENO), out = dup(STDOUT_FILENO);
    must(null >= 0 && in >= 0 && out >= 0, "streams");
    fflush(stdout);
    dup2(null, STDIN_FILENO);
    dup2(null, STDOUT_FILENO);
    memset(self.said, 0, sizeof self.said);
    rewind(fuzz_stderr);
    optind = 0; /* getopt begins again */
    if (setjmp(self.end) == 0) {
        self.exit_code = fuzz_main(argc, argv);
    }
    fflush(fuzz_stderr);
    fflush(stdout);
    clearerr(stdin);
    dup2(in, STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    close(null);
    close(in);
    close(out);
    return self.exit_code;
}

int fuzz_command(int argc, char **argv)
{
    enter(self.folder);
    const int exit_code = call(argc, argv);
    clear_folder();
    write_files();
    enter(self.home);
    return exit_code;
}

const char *fuzz_command_said(void)
{
    return self.said;
}

const char *fuzz_command_file(int number)
{
    return files[number].name;
}

void fuzz_command_put(const char *name, const uint8_t *data, size_t size)
{
    enter(self.folder);
    write_file(name, data, size);
    enter(self.home);
}

size_t fuzz_command_record(const char *scene, const char *duration, uint8_t *log, size_t size)
{
    enum { COUNT = 7 };
    const char *const words[COUNT] = {"mctau", "run", scene, "--duration", duration, "--log", "run.lcm"};
    char copies[COUNT][32];
    char *argv[COUNT + 1] = {NULL};
    for (int i = 0; i < COUNT; i++) {
        argv[i] = strcpy(copies[i], words[i]);
    }
    enter(self.folder);
    call(COUNT, argv);
    const size_t got = read_file("run.lcm", log, size);
    clear_folder();
    write_files();
    enter(self.home);
    return got;
}

static void remove_folder(void)
{
    if (fchdir(self.folder) == 0) {
        clear_folder();
        rmdir(self.place);
    }
}

void fuzz_command_begin(void)
{
    if (fuzz_stderr != NULL) {
        return;
    }
    strcpy(self.place, "/tmp/mctau-fuzz-XXXXXX");
    must(mkdtemp(self.place) != NULL, self.place);
    self.home = open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    self.folder = open(self.place, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    fuzz_stderr = fmemopen(self.said, sizeof self.said, "w");
    must(self.home >= 0 && self.folder >= 0 && fuzz_stderr != NULL && atexit(remove_folder) == 0, self.place);
    give_texts();
    enter(self.folder);
    write_files();
    enter(self.home);
    files[LOG].size = fuzz_command_record(files[0].name, "0.01", files[LOG].data, sizeof files[LOG].data);
    enter(self.folder);
    write_files();
    enter(self.home);
}

/*
 * Runs a command and has one of its system calls fail, whichever thread makes it (x86-64 Linux, by ptrace).
 *
 *   fail_call FILE N ERRNO MANNER REPORT COMMAND...
 *
 * Counted are the calls below, from the first on whose path is FILE: before it the loader is at work. Call N
 * fails with the number ERRNO; N = 0: none. MANNER:
 *   once   that call alone
 *   ever   every call of its kind from there on
 *   part   a write: half of its bytes are taken; the writes after it fail
 *   kill   the command is killed ahead of it
 *   torn   the command is killed when half the bytes of a write are taken, the first one from there on
 * REPORT gets a line "NAME FAILED FILE" for each call that was counted: FAILED is 1 or 0, FILE that of a
 * write, fsync or close.
 * The exit code is that of the command, or 128 + its signal; 99 when it cannot be traced.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

enum { NOT_TRACED = 99, MOST_THREADS = 64, FILE_SIZE = 1024 };

/* Left out are calls that cannot fail when they are called rightly (masks of signals, futexes, unmapping). */
static const struct {
    int number;
    const char *name;
} kinds[] = {
    {SYS_read, "read"},
    {SYS_write, "write"},
    {SYS_open, "open"},
    {SYS_openat, "openat"},
    {SYS_close, "close"},
    {SYS_stat, "stat"},
    {SYS_fstat, "fstat"},
    {SYS_newfstatat, "newfstatat"},
    {SYS_lseek, "lseek"},
    {SYS_access, "access"},
    {SYS_faccessat2, "faccessat2"},
    {SYS_rename, "rename"},
    {SYS_unlink, "unlink"},
    {SYS_ftruncate, "ftruncate"},
    {SYS_fsync, "fsync"},
    {SYS_ioctl, "ioctl"},
    {SYS_fcntl, "fcntl"},
    {SYS_pipe2, "pipe2"},
    {SYS_poll, "poll"},
    {SYS_ppoll, "ppoll"},
    {SYS_socket, "socket"},
    {SYS_connect, "connect"},
    {SYS_bind, "bind"},
    {SYS_setsockopt, "setsockopt"},
    {SYS_getsockopt, "getsockopt"},
    {SYS_sendto, "sendto"},
    {SYS_sendmsg, "sendmsg"},
    {SYS_recvfrom, "recvfrom"},
    {SYS_recvmsg, "recvmsg"},
    {SYS_mmap, "mmap"},
    {SYS_mprotect, "mprotect"},
    {SYS_brk, "brk"},
    {SYS_mlockall, "mlockall"},
    {SYS_clone, "clone"},
    {SYS_clone3, "clone3"},
    {SYS_sched_setscheduler, "sched_setscheduler"},
    {SYS_clock_nanosleep, "clock_nanosleep"},
};

static const char *name_of(long number)
{
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (kinds[i].number == number) {
            return kinds[i].name;
        }
    }
    return NULL;
}

static struct {
    const char *begin; /* path that the count begins with */
    long at;
    int error;
    const char *manner;
    FILE *report;
    pid_t child;
    bool began;
    long count;
    long failing; /* kind of which all calls fail from here on, or -1 */
    struct {
        pid_t id;
        bool inside, fails, torn;
        long result;
    } threads[MOST_THREADS];
} self;

static int slot_of(pid_t id)
{
    for (int i = 0; i < MOST_THREADS; i++) {
        if (self.threads[i].id == id || self.threads[i].id == 0) {
            self.threads[i].id = id;
            return i;
        }
    }
    exit(NOT_TRACED);
}

static bool is_manner(const char *name)
{
    return strcmp(self.manner, name) == 0;
}

static bool names_the_file(pid_t id, unsigned long address)
{
    char path[4096] = "";
    const size_t length = strlen(self.begin) + 1;
    struct iovec here = {path, length}, there = {(void *)address, length};
    return length <= sizeof path && process_vm_readv(id, &here, 1, &there, 1, 0) == (ssize_t)length &&
           strcmp(path, self.begin) == 0;
}

/* The file that a call hands something over to, "" for other calls. */
static void find_file(pid_t id, long number, unsigned long descriptor, char file[FILE_SIZE])
{
    char link[64];
    const bool gives = number == SYS_write || number == SYS_fsync || number == SYS_close;
    snprintf(link, sizeof link, "/proc/%d/fd/%lu", (int)id, descriptor);
    const ssize_t length = gives ? readlink(link, file, FILE_SIZE - 1) : 0;
    file[length > 0 ? length : 0] = '\0';
}

/* What becomes of a call: true when it fails. */
static bool spoil(pid_t id, int slot, struct user_regs_struct *registers)
{
    const long number = (long)registers->orig_rax;
    const bool chosen = ++self.count == self.at;
    if (chosen && is_manner("kill")) {
        kill(self.child, SIGKILL);
        return true;
    }
    if (is_manner("torn")) {
        self.threads[slot].torn = self.count >= self.at && number == SYS_write;
        registers->rdx /= self.threads[slot].torn ? 2 : 1;
    } else if (chosen && is_manner("part") && number == SYS_write) {
        registers->rdx /= 2;
        self.failing = number;
    } else if (chosen || self.failing == number) {
        self.failing = is_manner("ever") ? number : self.failing;
        self.threads[slot].fails = true;
        self.threads[slot].result =
            number == SYS_brk ? 0 : -self.error; /* brk gives an end that is too low */
        registers->orig_rax = (unsigned long)-1; /* no call at all */
    } else {
        return false;
    }
    ptrace(PTRACE_SETREGS, id, NULL, registers);
    return self.threads[slot].fails;
}

static void enter(pid_t id, int slot, struct user_regs_struct *registers)
{
    const long number = (long)registers->orig_rax;
    const char *name = name_of(number);
    char file[FILE_SIZE];
    self.began |= number == SYS_openat && names_the_file(id, registers->rsi);
    if (self.began && name != NULL) {
        find_file(id, number, registers->rdi, file);
        const bool fails = spoil(id, slot, registers);
        fprintf(self.report, "%s %d %s\n", name, fails, file);
    }
}

static void leave(pid_t id, int slot, struct user_regs_struct *registers)
{
    if (self.threads[slot].torn) {
        kill(self.child, SIGKILL);
    }
    if (self.threads[slot].fails) {
        registers->rax = (unsigned long)self.threads[slot].result;
        ptrace(PTRACE_SETREGS, id, NULL, registers);
    }
    self.threads[slot].fails = false;
}

static void at_call(pid_t id)
{
    struct user_regs_struct registers;
    const int slot = slot_of(id);
    if (ptrace(PTRACE_GETREGS, id, NULL, &registers) != 0) {
        return;
    }
    if (self.threads[slot].inside) {
        leave(id, slot, &registers);
    } else {
        enter(id, slot, &registers);
    }
    self.threads[slot].inside = !self.threads[slot].inside;
}

static int trace(void)
{
    int status;
    for (;;) {
        const pid_t id = waitpid(-1, &status, __WALL);
        if (id < 0) {
            return NOT_TRACED;
        }
        if (WIFEXITED(status) || WIFSIGNALED(status)) {
            if (id == self.child) {
                return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
            }
            continue;
        }
        const int number = WSTOPSIG(status);
        int passed = 0;
        if (number == (SIGTRAP | 0x80)) {
            at_call(id);
        } else if (number != SIGTRAP && number != SIGSTOP) {
            passed = number;
        }
        ptrace(PTRACE_SYSCALL, id, NULL, (void *)(long)passed);
    }
}

int main(int argc, char **argv)
{
    int status;
    if (argc < 7) {
        return NOT_TRACED;
    }
    self.begin = argv[1];
    self.at = atol(argv[2]);
    self.error = atoi(argv[3]);
    self.manner = argv[4];
    self.failing = -1;
    self.report = fopen(argv[5], "we");
    self.child = fork();
    if (self.child == 0) {
        ptrace(PTRACE_TRACEME, 0, NULL, NULL);
        raise(SIGSTOP);
        execv(argv[6], argv + 6);
        _exit(NOT_TRACED);
    }
    const long how = PTRACE_O_TRACESYSGOOD | PTRACE_O_TRACECLONE | PTRACE_O_TRACEEXEC | PTRACE_O_EXITKILL;
    if (self.report == NULL || waitpid(self.child, &status, 0) != self.child || !WIFSTOPPED(status) ||
        ptrace(PTRACE_SETOPTIONS, self.child, NULL, (void *)how) != 0 ||
        ptrace(PTRACE_SYSCALL, self.child, NULL, NULL) != 0) {
        return NOT_TRACED;
    }
    const int code = trace();
    fclose(self.report);
    return code;
}

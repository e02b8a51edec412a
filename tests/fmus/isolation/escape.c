/* A library that misbehaves when it is loaded, against those that watch over it (Linux). */
#define _GNU_SOURCE
#include <fcntl.h>
#include <signal.h>
#include <stddef.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/stat.h>
#include <unistd.h>

#define DEEP 1100

static void to_parent(int number) {
    if (getppid() > 1)
        kill(getppid(), number);
}

static void hide(void) {
    setsid();
    prctl(PR_SET_PDEATHSIG, 0, 0, 0, 0);
}

__attribute__((constructor)) static void load(void) {
#if defined ORPHANS
    if (fork() == 0 || fork() == 0) {
        hide();
    } else {
        hide();
        to_parent(SIGKILL);
    }
    sleep(60);
    _exit(0);
#elif defined STOPS_THE_WATCHDOG
    to_parent(SIGSTOP);
    _exit(3);
#elif defined TRACED
    ptrace(PTRACE_TRACEME, 0, NULL, NULL);
    raise(SIGUSR1);
#elif defined DEEP_FOLDERS
    for (int n = 0; n < DEEP; n++)
        if (mkdir("folder", 0700) != 0 || chdir("folder") != 0)
            _exit(4);
    _exit(5);
#endif
}

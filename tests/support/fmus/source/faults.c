/* How an FMU can misbehave. Each fault is a function; resources/car.txt says which, where and when. */
#define _GNU_SOURCE
#include "instance.h"

#include <fenv.h>
#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#ifndef _WIN32
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

static const double LONGEST_STEP = 0.02; /* [s] of discard_long and discard_spoiled */

static volatile int always = 1;
static volatile size_t nowhere = 0;

static void wait_for(double seconds) {
    struct timespec time = {(time_t)seconds, (long)(1e9 * (seconds - floor(seconds)))};
    nanosleep(&time, NULL);
}

/* ---- it dies ---- */

static Status segfault(Instance *self, FaultEntry *fault, double time, double step) {
    *(volatile int *)nowhere = 1;
    return OK;
}

static Status abort_(Instance *self, FaultEntry *fault, double time, double step) { abort(); }

static int deeper(volatile char *above) {
    volatile char room[4096];
    room[0] = above[0];
    return always ? deeper(room) + room[0] : 0;
}

static Status stack_overflow(Instance *self, FaultEntry *fault, double time, double step) {
    volatile char room[1] = {0};
    return (Status)deeper(room);
}

static Status exit_0(Instance *self, FaultEntry *fault, double time, double step) { exit(0); }

static Status exit_3(Instance *self, FaultEntry *fault, double time, double step) { exit(3); }

static Status quick_exit_(Instance *self, FaultEntry *fault, double time, double step) { _Exit(4); }

/* ---- it does not answer ---- */

static Status hang(Instance *self, FaultEntry *fault, double time, double step) {
    while (always) {}
    return OK;
}

static Status sleep_forever(Instance *self, FaultEntry *fault, double time, double step) {
    while (always) wait_for(1.0);
    return OK;
}

static Status slow(Instance *self, FaultEntry *fault, double time, double step) {
    wait_for(0.05);
    return OK;
}

/* ---- it refuses ---- */

static Status warning(Instance *self, FaultEntry *fault, double time, double step) {
    self->say(self, WARNING, "the tyres are worn");
    return WARNING;
}

static Status error(Instance *self, FaultEntry *fault, double time, double step) {
    self->say(self, ERROR, "the axle broke");
    return ERROR;
}

static Status error_without_events(Instance *self, FaultEntry *fault, double time, double step) {
    return self->event_mode ? OK : error(self, fault, time, step);
}

static Status fatal(Instance *self, FaultEntry *fault, double time, double step) {
    self->say(self, FATAL, "the engine is on fire");
    self->dead = true;
    return FATAL;
}

static Status pending(Instance *self, FaultEntry *fault, double time, double step) { return PENDING; }

static Status unknown_status(Instance *self, FaultEntry *fault, double time, double step) { return (Status)77; }

static Status silent_null(Instance *self, FaultEntry *fault, double time, double step) { return ERROR; }

static Status discard_once(Instance *self, FaultEntry *fault, double time, double step) {
    if (fault->count > 1) return OK;
    car_step(&self->car, time, 0.5 * step);
    self->last_time = time + 0.5 * step;
    return DISCARD;
}

static Status discard_long(Instance *self, FaultEntry *fault, double time, double step) {
    return step > LONGEST_STEP ? DISCARD : OK;
}

static Status discard_spoiled(Instance *self, FaultEntry *fault, double time, double step) {
    if (step <= LONGEST_STEP) return OK;
    self->car.x[0] += 1.0;
    self->car.undefined = true;
    return DISCARD;
}

static Status discard_always(Instance *self, FaultEntry *fault, double time, double step) { return DISCARD; }

static Status discard_creeping(Instance *self, FaultEntry *fault, double time, double step) {
    car_step(&self->car, time, 1e-9 * step);
    self->last_time = time + 1e-9 * step;
    return DISCARD;
}

static Status discard_backwards(Instance *self, FaultEntry *fault, double time, double step) {
    self->last_time = time - 1.0;
    return DISCARD;
}

static Status discard_nan(Instance *self, FaultEntry *fault, double time, double step) {
    self->last_time = NAN;
    return DISCARD;
}

static Status terminate(Instance *self, FaultEntry *fault, double time, double step) {
    self->say(self, WARNING, "the tank is empty");
    self->ended = true;
    return DISCARD;
}

/* ---- it tells nonsense ---- */

static Status spoil(Instance *self, Quantity quantity, double amount) {
    self->car.added[quantity] = amount;
    return OK;
}

static Status nan_speed(Instance *self, FaultEntry *fault, double time, double step) { return spoil(self, Q_speed, NAN); }

static Status nan_position(Instance *self, FaultEntry *fault, double time, double step) { return spoil(self, Q_position, NAN); }

static Status nan_acceleration(Instance *self, FaultEntry *fault, double time, double step) { return spoil(self, Q_acceleration, NAN); }

static Status nan_rate(Instance *self, FaultEntry *fault, double time, double step) {
    self->car.rate_fault = NAN;
    return OK;
}

static Status inf_speed(Instance *self, FaultEntry *fault, double time, double step) { return spoil(self, Q_speed, INFINITY); }

static Status huge_speed(Instance *self, FaultEntry *fault, double time, double step) { return spoil(self, Q_speed, 1e300); }

static Status jump(Instance *self, FaultEntry *fault, double time, double step) { return spoil(self, Q_position, 50.0); }

static Status frozen(Instance *self, FaultEntry *fault, double time, double step) {
    self->car.frozen = true;
    return OK;
}

static Status position_stands(Instance *self, FaultEntry *fault, double time, double step) {
    if (!self->car.position_stands) self->car.stood = car_get(&self->car, Q_position);
    self->car.position_stands = true;
    return OK;
}

static Status speed_stands(Instance *self, FaultEntry *fault, double time, double step) {
    if (!self->car.speed_stands) self->car.stood = car_get(&self->car, Q_speed);
    self->car.speed_stands = true;
    return OK;
}

static Status trembles(Instance *self, FaultEntry *fault, double time, double step) {
    return spoil(self, Q_speed, fault->count % 2 * 1e-16 * (1.0 + 4.0 * fabs(self->car.x[1])));
}

static Status chatter(Instance *self, FaultEntry *fault, double time, double step) {
    self->car.chatters = true;
    return OK;
}

static Status refuse_start_value(Instance *self, FaultEntry *fault, double time, double step) { return OK; } /* instance.c */

static Status memory(Instance *self, FaultEntry *fault, double time, double step) {
    enum { SIZE = 300 << 20 };
    if (fault->count > 1) return OK;
    char *room = malloc(SIZE);
    if (room == NULL) return ERROR;
    memset(room, 1, SIZE);
    return room[always] == 1 ? OK : ERROR;
}

/* ---- it talks ---- */

static Status message_latin1(Instance *self, FaultEntry *fault, double time, double step) {
    self->say(self, WARNING, "K\xfchlwasser zu hei\xdf");
    return WARNING;
}

static Status message_null(Instance *self, FaultEntry *fault, double time, double step) {
    self->say(self, WARNING, NULL);
    return WARNING;
}

static Status message_percent(Instance *self, FaultEntry *fault, double time, double step) {
    self->say(self, WARNING, "100% sure, 5 %, %q");
    return WARNING;
}

static Status message_arguments(Instance *self, FaultEntry *fault, double time, double step) {
    self->say(self, WARNING, "the %s broke %d times, %.1f%% sure", "axle", 3, 99.5);
    return WARNING;
}

static Status message_control(Instance *self, FaultEntry *fault, double time, double step) {
    self->say(self, WARNING, "\x1b[2J\x1b[31mred\x07\r\nsecond line\x01\x7f");
    return WARNING;
}

static Status message_huge(Instance *self, FaultEntry *fault, double time, double step) {
    enum { SIZE = 1 << 20 };
    static char text[SIZE];
    memset(text, 'x', SIZE - 1);
    self->say(self, WARNING, text);
    return WARNING;
}

static Status flood_log(Instance *self, FaultEntry *fault, double time, double step) {
    for (int i = 0; i < 10000; ++i) self->say(self, OK, "everything is fine");
    return OK;
}

static Status flood(FILE *stream) {
    static char line[1001];
    memset(line, '.', 1000);
    line[999] = '\n';
    for (int i = 0; i < 5000; ++i) fputs(line, stream); /* 5 MB a step */
    fflush(stream);
    return OK;
}

static Status flood_stdout(Instance *self, FaultEntry *fault, double time, double step) { return flood(stdout); }

static Status flood_stderr(Instance *self, FaultEntry *fault, double time, double step) { return flood(stderr); }

static Status last_words(Instance *self, FaultEntry *fault, double time, double step) {
    fputs("assertion failed: \x1b[31mwheels == 4\n", stderr);
    abort();
}

/* ---- it spoils what belongs to the process ---- */

#ifndef _WIN32
static Status chdir_(Instance *self, FaultEntry *fault, double time, double step) { return chdir("/") ? ERROR : OK; }

static Status litter(Instance *self, FaultEntry *fault, double time, double step) {
    FILE *file = fopen("litter.txt", "w");
    if (file != NULL) fclose(file);
    return OK;
}

static Status setlocale_(Instance *self, FaultEntry *fault, double time, double step) {
    const char *const names[] = {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "C.UTF-8", ""};
    for (int i = 0; i < 5 && setlocale(LC_ALL, names[i]) == NULL; ++i) {}
    return OK;
}

static Status environment(Instance *self, FaultEntry *fault, double time, double step) {
    clearenv();
    return OK;
}

static Status umask_(Instance *self, FaultEntry *fault, double time, double step) {
    umask(0777);
    return OK;
}

static Status trap_floats(Instance *self, FaultEntry *fault, double time, double step) {
#ifdef __linux__
    feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_ALL_EXCEPT & ~FE_INEXACT);
#endif
    return OK;
}

static Status trap_inexact(Instance *self, FaultEntry *fault, double time, double step) {
#ifdef __linux__
    feclearexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_ALL_EXCEPT);
#endif
    return OK;
}

static Status round_up(Instance *self, FaultEntry *fault, double time, double step) {
    fesetround(FE_UPWARD);
    return OK;
}

static void shrug(int number) { (void)number; }

static Status ignore_signals(Instance *self, FaultEntry *fault, double time, double step) {
    signal(SIGINT, SIG_IGN);
    signal(SIGTERM, SIG_IGN);
    signal(SIGCHLD, SIG_IGN);
    return OK;
}

static Status replace_handlers(Instance *self, FaultEntry *fault, double time, double step) {
    for (int number = 1; number < 32; ++number)
        if (number != SIGKILL && number != SIGSTOP) signal(number, shrug);
    return OK;
}

static Status close_files(Instance *self, FaultEntry *fault, double time, double step) {
    for (int fd = 0; fd <= 20; ++fd) close(fd);
    return OK;
}

static Status write_into_files(Instance *self, FaultEntry *fault, double time, double step) {
    static const char noise[] = "\x80\x04K\x01.{\"speed\": 1e999}\n";
    for (int fd = 3; fd <= 64; ++fd)
        if (fcntl(fd, F_GETFD) != -1) {
            fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) | O_NONBLOCK);
            if (write(fd, noise, sizeof noise) < 0) continue;
        }
    return OK;
}

static Status kill_self(Instance *self, FaultEntry *fault, double time, double step) {
    kill(getpid(), SIGKILL);
    return OK;
}

static Status stop_self(Instance *self, FaultEntry *fault, double time, double step) {
    kill(getpid(), SIGSTOP);
    return OK;
}

static Status kill_parent(Instance *self, FaultEntry *fault, double time, double step) {
    kill(getppid(), SIGTERM);
    return OK;
}

static Status offspring(bool own_session) {
    if (fork() == 0) {
        if (own_session) setsid();
        alarm(60); /* the zoo's own limit */
        while (always) wait_for(1.0);
    }
    return OK;
}

static Status fork_child(Instance *self, FaultEntry *fault, double time, double step) {
    return fault->count > 1 ? OK : offspring(false);
}

static Status fork_session(Instance *self, FaultEntry *fault, double time, double step) {
    return fault->count > 1 ? OK : offspring(true);
}

static void *run_on(void *argument) {
    while (always) wait_for(0.01);
    return argument;
}

static Status thread(Instance *self, FaultEntry *fault, double time, double step) {
    pthread_t id;
    if (fault->count == 1 && pthread_create(&id, NULL, run_on, NULL) == 0) pthread_detach(id);
    return OK;
}

static void *crash_soon(void *argument) {
    wait_for(0.02);
    *(volatile int *)nowhere = 1;
    return argument;
}

static Status thread_crash(Instance *self, FaultEntry *fault, double time, double step) {
    pthread_t id;
    if (fault->count == 1 && pthread_create(&id, NULL, crash_soon, NULL) == 0) pthread_detach(id);
    return OK;
}

static void *talk(void *argument) {
    Instance *self = argument;
    self->say(self, WARNING, "said by another thread");
    return argument;
}

static Status message_thread(Instance *self, FaultEntry *fault, double time, double step) {
    pthread_t id;
    if (pthread_create(&id, NULL, talk, self) == 0) pthread_join(id, NULL);
    return WARNING;
}
#endif

/* ---- the table ---- */

static const struct {
    const char *name;
    Status (*happen)(Instance *self, FaultEntry *fault, double time, double step);
} FAULTS[] = {
    {"segfault", segfault}, {"abort", abort_}, {"stack_overflow", stack_overflow}, {"exit_0", exit_0},
    {"exit_3", exit_3}, {"quick_exit", quick_exit_}, {"hang", hang}, {"sleep_forever", sleep_forever},
    {"slow", slow}, {"warning", warning}, {"error", error}, {"error_without_events", error_without_events}, {"fatal", fatal}, {"pending", pending},
    {"unknown_status", unknown_status}, {"silent_null", silent_null}, {"discard_once", discard_once},
    {"discard_long", discard_long}, {"discard_spoiled", discard_spoiled}, {"discard_always", discard_always},
    {"discard_creeping", discard_creeping}, {"discard_backwards", discard_backwards}, {"discard_nan", discard_nan},
    {"terminate", terminate}, {"nan", nan_speed}, {"nan_position", nan_position},
    {"nan_acceleration", nan_acceleration}, {"nan_rate", nan_rate}, {"inf", inf_speed}, {"huge", huge_speed},
    {"jump", jump}, {"frozen", frozen}, {"position_stands", position_stands},
    {"speed_stands", speed_stands}, {"trembles", trembles}, {"chatter", chatter}, {"refuse_start_value", refuse_start_value},
    {"memory", memory}, {"message_latin1", message_latin1}, {"message_null", message_null},
    {"message_percent", message_percent}, {"message_arguments", message_arguments},
    {"message_control", message_control}, {"message_huge", message_huge}, {"flood_log", flood_log},
    {"flood_stdout", flood_stdout}, {"flood_stderr", flood_stderr}, {"last_words", last_words},
#ifndef _WIN32
    {"chdir", chdir_}, {"litter", litter}, {"setlocale", setlocale_}, {"environment", environment},
    {"umask", umask_}, {"trap_floats", trap_floats}, {"trap_inexact", trap_inexact}, {"round_up", round_up},
    {"ignore_signals", ignore_signals}, {"replace_handlers", replace_handlers}, {"close_files", close_files},
    {"write_into_files", write_into_files}, {"kill_self", kill_self}, {"stop_self", stop_self},
    {"kill_parent", kill_parent}, {"fork_child", fork_child}, {"fork_session", fork_session}, {"thread", thread},
    {"thread_crash", thread_crash}, {"message_thread", message_thread},
#endif
};

bool has_fault(const Instance *self, const char *name) {
    for (int i = 0; i < self->fault_count; ++i)
        if (strcmp(self->faults[i].name, name) == 0) return true;
    return false;
}

static Status happen(Instance *self, FaultEntry *fault, double time, double step) {
    for (size_t i = 0; i < sizeof FAULTS / sizeof *FAULTS; ++i)
        if (strcmp(fault->name, FAULTS[i].name) == 0) {
            ++fault->count;
            return FAULTS[i].happen(self, fault, time, step);
        }
    fprintf(stderr, "car.txt: no fault '%s' here\n", fault->name);
    abort();
}

Status misbehave(Instance *self, Phase phase, double time, double step) {
    Status worst = OK;
    for (int i = 0; i < self->fault_count; ++i) {
        FaultEntry *fault = &self->faults[i];
        if (fault->phase != phase || time < fault->from - 1e-9) continue;
        Status status = happen(self, fault, time, step);
        if (status > worst) worst = status;
    }
    return worst;
}

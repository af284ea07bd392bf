/* SPDX-License-Identifier: BSD-3-Clause */
/* Processes that take the runs of a plan one by one. They are forked before this process has
 * threads, and share a memory mapping with it. */
#define _DEFAULT_SOURCE /* for MAP_ANONYMOUS */
#include "jobs.h"
#include "summary.h"
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

enum { WAITING = -2, RUNNING = -3, PAUSE_MS = 50, SHOWN = 6 };

/* [s] between lines of progress: on a terminal, in a log. */
static const double EVERY_TERMINAL = 1, EVERY_LOG = 10;

/* Shared memory of the processes; `state` of a run: WAITING, RUNNING, PLAN_OPEN, or its exit
 * code. */
typedef struct board {
    _Atomic int64_t next;
    _Atomic int64_t refused;
    _Atomic int stop; /* no other run starts */
    _Atomic int state[];
} board;

/* The processes, and the task of this one. */
typedef struct crew {
    plan *p;
    board *b;
    int64_t first, step, count;
    size_t size; /* of the shared memory [bytes] */
    int32_t jobs;
    pid_t *pid;
    double begin, shown;
    int64_t done_before;
} crew;

static volatile sig_atomic_t signalled;

static void on_signal(int number)
{
    (void)number;
    signalled = 1;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int32_t jobs_processors(void)
{
    const long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count > 1 ? (int32_t)count : 1;
}

/* ---- a process of the crew ---- */

static void catch_all(void (*handler)(int))
{
    static const int caught[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU};
    const struct sigaction action = {.sa_handler = handler};
    struct sigaction before;
    for (size_t k = 0; k < sizeof caught / sizeof *caught; k++)
        if (sigaction(caught[k], NULL, &before) == 0 && before.sa_handler != SIG_IGN)
            sigaction(caught[k], &action, NULL);
}

/* Next run; -1: none. */
static int64_t next_of(crew *w)
{
    const int64_t k = atomic_fetch_add(&w->b->next, 1);
    return signalled || atomic_load(&w->b->stop) || k >= w->count ? -1 : k;
}

static void take_runs(crew *w)
{
    for (int64_t k = next_of(w); k >= 0; k = next_of(w)) {
        const int64_t i = w->first + k * w->step;
        atomic_store(&w->b->state[k], RUNNING);
        const int code = plan_take(w->p, i, true);
        atomic_store(&w->b->state[k], code);
        if (code == PLAN_REFUSED || code == MPS_EXIT_INTERRUPTED) atomic_store(&w->b->stop, code);
    }
}

static void check_runs(crew *w)
{
    for (int64_t k = next_of(w); k >= 0; k = next_of(w))
        atomic_fetch_add(&w->b->refused, plan_check(w->p, w->first + k * w->step, w->p->runs) > 0);
}

/* ---- all processes ---- */

static bool begin(crew *w, plan *p, int64_t first, int64_t step)
{
    *w = (crew){.p = p, .first = first, .step = step, .jobs = p->c->jobs, .begin = now()};
    w->count = first < p->runs ? (p->runs - first + step - 1) / step : 0;
    if (w->jobs > w->count) w->jobs = (int32_t)w->count;
    w->size = sizeof(board) + (size_t)w->count * sizeof(_Atomic int);
    w->b = mmap(NULL, w->size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    w->pid = calloc((size_t)w->jobs + 1, sizeof *w->pid);
    if (w->b == MAP_FAILED || !w->pid) {
        fprintf(stderr, "mps %s: no memory\n", p->c->verb);
        return false;
    }
    for (int64_t k = 0; k < w->count; k++) atomic_store(&w->b->state[k], WAITING);
    return true;
}

static void end(crew *w)
{
    if (w->b != MAP_FAILED) munmap(w->b, w->size);
    free(w->pid);
}

/* @return false: a process cannot be created; the existing ones do all runs */
static bool start(crew *w, void (*work)(crew *w))
{
    fflush(NULL);
    for (int32_t k = 0; k < w->jobs; k++) {
        const pid_t parent = getpid();
        w->pid[k] = fork();
        if (w->pid[k] < 0) {
            fprintf(stderr, "mps %s: --jobs: %s\n", w->p->c->verb, strerror(errno));
            return k > 0;
        }
        if (w->pid[k] > 0) continue;
#ifdef __linux__
        prctl(PR_SET_PDEATHSIG, SIGTERM); /* if this process is killed, the runs stop too */
#endif
        if (getppid() == parent) work(w);
        fflush(NULL);
        _exit(0);
    }
    return true;
}

/* Number of running processes. */
static int32_t count_alive(crew *w)
{
    int32_t alive = 0;
    for (int32_t k = 0; k < w->jobs; k++) {
        if (w->pid[k] > 0 && waitpid(w->pid[k], NULL, WNOHANG) != 0) w->pid[k] = 0;
        alive += w->pid[k] > 0;
    }
    return alive;
}

static void send(const crew *w, int number)
{
    for (int32_t k = 0; k < w->jobs; k++)
        if (w->pid[k] > 0) kill(w->pid[k], number);
}

/* ---- progress ---- */

/* Completed fraction of a run, by its summary, which is written every 10 s. */
static double share_of(const crew *w, int64_t k)
{
    char folder[SERIES_PATH];
    if (!series_folder(w->p->place, w->first + k * w->step, folder)) return 0;
    const double share = summary_number(folder, "t_end") / summary_number(folder, "until");
    return share > 0 && share < 1 ? share : 0;
}

/* "12 of 100 done, 1 failed, in progress: 013 45 %, 014 12 %" */
static void write_progress(const crew *w, char *line, size_t size)
{
    int64_t done = 0, failed = 0, shown = 0;
    double part = 0;
    char running[160] = "";
    size_t used = 0;
    for (int64_t k = 0; k < w->count; k++) {
        const int state = atomic_load(&w->b->state[k]);
        done += state == MPS_EXIT_OK;
        failed += state > MPS_EXIT_OK;
        if (state != RUNNING) continue;
        const double share = share_of(w, k);
        part += share;
        if (shown++ < SHOWN && used < sizeof running)
            used += (size_t)snprintf(running + used, sizeof running - used, "%s%03lld %.0f %%",
                                     used ? ", " : "", (long long)(w->first + k * w->step) + 1,
                                     100 * share);
    }
    const double took = now() - w->begin, sum = (double)(done + failed) + part,
                 left = sum > 0 ? took * ((double)w->count - sum) / sum : NAN;
    int n = snprintf(line, size, "mps %s: %lld of %lld done, %lld failed", w->p->c->verb,
                     (long long)done, (long long)w->count, (long long)failed);
    if (used > 0) n += snprintf(line + n, size - (size_t)n, ", in progress: %s", running);
    if (!isnan(left)) snprintf(line + n, size - (size_t)n, ", left %.0f s", left);
}

static void show_progress(crew *w, bool terminal)
{
    char line[400];
    if (w->p->c->quiet || now() - w->shown < (terminal ? EVERY_TERMINAL : EVERY_LOG)) return;
    w->shown = now();
    write_progress(w, line, sizeof line);
    fprintf(stderr, terminal ? "\r%s\033[K" : "%s\n", line);
}

/* Wait for all processes. A signal ends the runs with their checkpoints; a second one ends them
 * immediately. */
static void wait_all(crew *w, bool shows)
{
    const struct timespec pause = {.tv_nsec = PAUSE_MS * 1000000L};
    const bool terminal = isatty(2) != 0;
    bool stop_sent = false;
    w->shown = now();
    while (count_alive(w) > 0) {
        if (signalled) {
            atomic_store(&w->b->stop, MPS_EXIT_INTERRUPTED);
            send(w, stop_sent ? SIGKILL : SIGTERM);
            if (!stop_sent && !w->p->c->quiet)
                fprintf(stderr, "%smps %s: stopping; each run writes a checkpoint\n",
                        terminal ? "\r\033[K" : "", w->p->c->verb);
            stop_sent = true;
            signalled = 0;
        }
        if (shows) show_progress(w, terminal);
        nanosleep(&pause, NULL);
    }
    if (shows && terminal && !w->p->c->quiet) fputs("\r\033[K", stderr);
}

/* ---- public ---- */

int64_t jobs_check(const plan *p, int64_t first, int64_t step)
{
    crew w;
    plan all = *p;
    int64_t refused = 1;
    if (begin(&w, &all, first, step) && start(&w, check_runs)) {
        wait_all(&w, false);
        refused = atomic_load(&w.b->refused);
        /* a process ended before all runs were checked */
        if (atomic_load(&w.b->next) < w.count) refused++;
    }
    end(&w);
    return refused;
}

int jobs_run(plan *p, int64_t first, int64_t step)
{
    crew w;
    int code = MPS_EXIT_FAILED;
    signalled = 0;
    catch_all(on_signal);
    if (begin(&w, p, first, step) && start(&w, take_runs)) {
        wait_all(&w, true);
        code = atomic_load(&w.b->stop);
        for (int64_t k = 0; k < w.count; k++) {
            const int state = atomic_load(&w.b->state[k]);
            /* the run of a killed process is left unchanged */
            p->code[first + k * step] = state == RUNNING   ? MPS_EXIT_FAILED
                                        : state == WAITING ? PLAN_OPEN
                                                           : state;
        }
    }
    end(&w);
    catch_all(SIG_DFL);
    return code;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Formats the progress of a run. */
#include "progress.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

double mps__progress_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void mps__progress_begin(progress *p, double t_end, int64_t particles, bool terminal)
{
    const char *no_colour = getenv("NO_COLOR"), *term = getenv("TERM");
    bool dumb = !term || strcmp(term, "dumb") == 0;
    *p = (progress){
        .terminal = terminal && isatty(2) && !dumb, .t_end = t_end, .particles = particles};
    p->colour = p->terminal && !(no_colour && no_colour[0]);
    p->start = p->shown = mps__progress_clock();
}

void mps__progress_from(progress *p, double t, int64_t steps)
{
    p->t_begin = t;
    p->steps_shown = steps;
}

static void progress_time(char *text, size_t size, double seconds)
{
    long s = seconds < 359999 ? (long)(seconds + 0.5) : 359999;
    if (s >= 3600)
        snprintf(text, size, "%ldh%02ldm", s / 3600, s / 60 % 60);
    else if (s >= 60)
        snprintf(text, size, "%ldm%02lds", s / 60, s % 60);
    else
        snprintf(text, size, "%lds", s);
}

bool mps__progress_step(progress *p, const mps_step_info *info, char *text, size_t size)
{
    double now = mps__progress_clock(), interval = p->terminal ? 0.1 : 10;
    if (now - p->shown < interval) return false;
    double rate = (double)(info->step - p->steps_shown) * (double)p->particles / (now - p->shown);
    /* a tenth of a second covers only a few steps */
    p->rate = p->rate > 0 ? 0.8 * p->rate + 0.2 * rate : rate;
    double done = info->t - p->t_begin;
    double rest = done > 0 ? (now - p->start) * (p->t_end - info->t) / done : 0;
    double percent = 100 * info->t / p->t_end;
    p->shown = now;
    p->steps_shown = info->step;
    if (p->terminal) {
        char left[32];
        progress_time(left, sizeof left, rest);
        const char *on = p->colour ? "\033[1m" : "", *off = p->colour ? "\033[0m" : "";
        snprintf(text, size,
                 "\r%s%5.1f %%%s  t %.3f s  dt %.1e  CFL %.2f  PPE %3d  %.0f kp/s  left %s\033[K",
                 on, percent, off, info->t, info->dt, info->cfl, (int)info->ppe_iterations,
                 p->rate / 1000, left);
        p->line = true;
    } else {
        snprintf(text, size, "t=%.6g step=%lld dt=%.3e wall=%.1f left=%.1f\n", info->t,
                 (long long)info->step, info->dt, now - p->start, rest);
    }
    return true;
}

const char *mps__progress_clear(progress *p)
{
    const bool line = p->line;
    p->line = false;
    return line ? "\r\033[K" : "";
}

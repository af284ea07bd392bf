/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of --profile: time of each pass of a step. */
#include <mps/job.h>
#include <mps/mps.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static double profile_sum(mps_sim *sim)
{
    mps_pass_info p;
    double sum = 0;
    mps_pass_info_init(&p, sizeof p);
    for (int32_t k = 0; mps_pass_info_get(sim, k, &p) == MPS_OK; k++) sum += p.seconds;
    return sum;
}

/* A pass without arrays of its own has no bytes and no rate. */
static void profile_line(FILE *out, const mps_pass_info *p, double sum)
{
    fprintf(out, "%-9s %-24s %9lld %11.4f %6.1f %% %11.1f", p->hook_name, p->name,
            (long long)p->calls, p->seconds, sum > 0 ? 100 * p->seconds / sum : 0,
            p->calls > 0 ? 1e6 * p->seconds / (double)p->calls : 0);
    if (p->bytes > 0 && p->seconds > 0)
        fprintf(out, " %10.3f %8.2f\n", 1e-9 * p->bytes, 1e-9 * p->bytes / p->seconds);
    else
        fprintf(out, " %10s %8s\n", "-", "-");
}

mps_status mps_job_profile_text(mps_sim *sim, double measured, char **text)
{
    mps_pass_info p;
    size_t size;
    if (text) *text = NULL;
    if (!sim || !text) return MPS_E_ARG;
    FILE *out = open_memstream(text, &size);
    if (!out) return MPS_E_NOMEM;
    mps_pass_info_init(&p, sizeof p);
    fprintf(out, "%-9s %-24s %9s %11s %8s %11s %10s %8s\n", "hook", "pass", "calls", "seconds",
            "share", "us/call", "GB", "GB/s");
    const double sum = profile_sum(sim);
    for (int32_t k = 0; mps_pass_info_get(sim, k, &p) == MPS_OK; k++) profile_line(out, &p, sum);
    fprintf(out, "%-9s %-24s %9s %11.4f  of the steps: %.4f\n", "sum", "", "", sum, measured);
    const bool failed = ferror(out) != 0;
    if (fclose(out) == 0 && !failed) return MPS_OK;
    free(*text);
    *text = NULL;
    return MPS_E_NOMEM;
}

/* SPDX-License-Identifier: BSD-3-Clause */
#include "profile.h"
#include <stdio.h>

static double profile_sum(mps_sim *sim)
{
    mps_pass_info p;
    double sum = 0;
    mps_pass_info_init(&p, sizeof p);
    for (int32_t k = 0; mps_pass_info_get(sim, k, &p) == MPS_OK; k++) sum += p.seconds;
    return sum;
}

/* A pass without arrays of its own has no bytes, and no rate. */
static void profile_line(const mps_pass_info *p, double sum)
{
    printf("%-9s %-24s %9lld %11.4f %6.1f %% %11.1f", p->hook_name, p->name, (long long)p->calls,
           p->seconds, sum > 0 ? 100 * p->seconds / sum : 0,
           p->calls > 0 ? 1e6 * p->seconds / (double)p->calls : 0);
    if (p->bytes > 0 && p->seconds > 0)
        printf(" %10.3f %8.2f\n", 1e-9 * p->bytes, 1e-9 * p->bytes / p->seconds);
    else
        printf(" %10s %8s\n", "-", "-");
}

void profile_print(mps_sim *sim, double measured)
{
    mps_pass_info p;
    const double sum = profile_sum(sim);
    mps_pass_info_init(&p, sizeof p);
    printf("%-9s %-24s %9s %11s %8s %11s %10s %8s\n", "hook", "pass", "calls", "seconds", "share",
           "us/call", "GB", "GB/s");
    for (int32_t k = 0; mps_pass_info_get(sim, k, &p) == MPS_OK; k++) profile_line(&p, sum);
    printf("%-9s %-24s %9s %11.4f  of the steps: %.4f\n", "sum", "", "", sum, measured);
    fflush(stdout);
}

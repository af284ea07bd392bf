/* SPDX-License-Identifier: BSD-3-Clause */
/* Fluid on the lattice of a tank. */
#include "lattice_plan.h"
#include <math.h>
#include <string.h>

/* Points of the last row, evenly spread in groups: holes one point wide would not close, a bump some points wide levels out. Each line of
 * groups carries the remainder over, lines side by side begin elsewhere. */
static bool in_top_row(const mps__lattice_plan *p, const int64_t k[3])
{
    enum { GROUP = 3 };
    static const double golden = 0.6180339887498949;
    const int64_t i = (k[0] - p->box.first[0]) / GROUP, j = (k[2] - p->box.first[2]) / GROUP;
    const double share = p->box.top, at = share * (double)i + golden * (double)j + 0.5;
    return share == 0 || k[1] < p->box.last[1] || floor(at) > floor(at - share);
}

static bool fluid_choose(const mps__lattice_plan *p, const int64_t k[3])
{
    double X[3];
    if (!in_top_row(p, k)) return false;
    if (!p->inside) return true;
    mps__lattice_point(p, k, X);
    return p->inside(p->user, X) != 0;
}

static void fluid_describe(const mps__lattice_plan *p, const int64_t k[3], mps__lattice_site *out)
{
    (void)k;
    out->kind = MPS_FLUID;
    out->phase = p->phase;
    out->part = -1;
}

static mps_status fluid_run(mps__lattice_plan *p)
{
    MPS__TRY(mps__packing_make(&p->packing, p->sim));
    MPS__TRY(mps__lattice_plan_choose(p));
    MPS__CHECK(&p->sim->context, p->chosen > 0,
               "nothing to fill: no free lattice point lies inside (%lld are taken)",
               (long long)p->taken);
    return mps__lattice_plan_build(p);
}

/* Share of the free points of the last row that were chosen. */
static double top_share(const mps__lattice_plan *p)
{
    int64_t k[3] = {p->box.first[0], p->box.first[1], p->box.first[2]}, place = 0, chosen = 0,
            left = 0;
    do {
        const int state = k[1] == p->box.last[1] ? p->state[place] : POINT_SOLID;
        chosen += state == POINT_CHOSEN;
        left += state == POINT_FREE;
        place++;
    } while (mps__lattice_plan_next(p, k));
    return chosen > 0 ? (double)chosen / (double)(chosen + left) : 0;
}

static void report_volume(const mps__lattice_plan *p, const double *lo, const double *hi)
{
    double built, asked;
    mps__lattice_plan_volumes(p, lo, hi, &built, &asked);
    mps__log(&p->sim->context, MPS_LOG_INFO,
             "fill of phase %d: %.6g m%d of %.6g m%d asked for, %+.2g %%", (int)p->phase, built,
             (int)p->dim, asked, (int)p->dim, asked > 0 ? 100 * (built / asked - 1) : 0.0);
}

mps_status mps__geometry_fill(mps_sim *sim, const mps__fill *fill, mps__lattice_box *box,
                              int64_t *added)
{
    mps__lattice_plan p;
    MPS__TRY(mps__slots_tell(sim));
    mps__lattice_plan_init(&p, sim, box);
    p.choose = fluid_choose;
    p.describe = fluid_describe;
    p.phase = fill->phase;
    p.inside = fill->inside;
    p.user = fill->user;
    mps_status status = fluid_run(&p);
    if (status == MPS_OK) report_volume(&p, fill->lo, fill->hi);
    if (status == MPS_OK && box->top > 0) box->top = top_share(&p);
    if (p.box.top > 0 && box->top == 0) box->last[1]--;
    mps__lattice_plan_free(&p);
    if (status == MPS_OK && added) *added = p.chosen;
    return status;
}

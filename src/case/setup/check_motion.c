/* SPDX-License-Identifier: BSD-3-Clause */
/* What mps check reports about a motion as the run has it, from start to end. */
#include "check.h"
#include <math.h>

static void write_source(const writer *w, const build *b)
{
    const build_motion *m = b->motion;
    fprintf(w->file, "centre ");
    mps__check_place(w, b, m->centre);
    if (m->rows > 0) fprintf(w->file, ", %lld rows of %s, ", (long long)m->rows, m->file);
    if (m->rows > 0 && m->step_most > m->step_least * (1 + 1e-6))
        fprintf(w->file, "%.4g to %.4g s apart", m->step_least, m->step_most);
    else if (m->rows > 0)
        fprintf(w->file, "%.4g s apart", m->step_most);
    if (m->unused[0]) fprintf(w->file, "; not used: %s", m->unused);
    if (m->plugin)
        fprintf(w->file, ", '%s' of a plug-in", m->plugin);
    else if (m->rows == 0)
        fprintf(w->file, ", %d harmonic%s", (int)m->count, m->count == 1 ? "" : "s");
    fprintf(w->file, "\n");
}

static void write_degree(const writer *w, const build_motion *m, int32_t degree)
{
    const bool turn = degree >= MPS_SHIP_ROLL;
    const double *most = m->largest[degree], f = turn ? 180 / acos(-1.0) : 1;
    const char *unit = turn ? "deg" : "m", *name = mps__degrees[degree];
    const motion_filtered *c = &m->change[degree];
    mps__check_heading(w, "");
    fprintf(w->file, "%s: at most %.4g %s, %.3g %s/s, %.3g %s/s2 in the run\n", name, f * most[0],
            unit, f * most[1], unit, f * most[2], unit);
    if (!(m->cutoff > 0)) return;
    mps__check_heading(w, "");
    fprintf(w->file,
            "    'cutoff: %g Hz' changes its rows by %.3g %s (rms), at most %.3g %s; accelerations "
            "of the file were up to %.3g %s/s2\n",
            m->cutoff, f * c->rms, unit, f * c->most, unit, f * c->accel, unit);
}

void mps__check_write_motion(const writer *w, build *b)
{
    const build_motion *m = b->motion;
    mps__check_heading(w, "motion");
    if (b->body) {
        fprintf(w->file, "that of the body\n");
        mps__check_write_body(w, b);
        return;
    }
    if (!m) {
        fprintf(w->file, "none\n");
        return;
    }
    write_source(w, b);
    for (int32_t d = 0; d < MOTION_DEGREES; d++)
        if (m->used[d]) write_degree(w, m, d);
    mps__check_write_start(w, b);
}

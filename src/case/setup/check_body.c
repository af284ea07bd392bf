/* SPDX-License-Identifier: BSD-3-Clause */
/* What mps check reports about a body: mass, and natural periods with and without liquid. */
#include "check.h"
#include "pendulum.h"
#include <math.h>

static void write_period(const writer *w, const char *how, double period, const build *b)
{
    if (isnan(period))
        fprintf(w->file, "%s: nothing restores", how);
    else
        fprintf(w->file, "%s %.4g s", how, period);
    if (b->modes.count && isfinite(period))
        fprintf(w->file, " = %.3g T1", period / b->modes.period[0]);
}

/* Suffix of units of masses and loads. */
static const char *per_width(const build *b)
{
    return b->dim == 2 ? "/m" : "";
}

/* The two lowest coupled periods of body and liquid in a box. */
static void write_coupled(const writer *w, const build *b, int32_t degree)
{
    pendulum p;
    double period[2], sign;
    int32_t dof;
    mps__degree_to_lab(b->motion, degree, &dof, &sign);
    const bool along = dof == b->modes.axis, turn = dof == MPS_ROTATE_Z - b->modes.axis;
    if ((!along && !turn) || !mps__pendulum_make(b, b->motion->centre, &p)) return;
    fprintf(w->file, "\n");
    mps__check_heading(w, "");
    const double least = -mps__pendulum_stiffness(&p, turn, 0);
    if (b->body->stiffness[degree] < least) {
        if (turn)
            fprintf(w->file, "    with the moving liquid it falls over: it needs %.4g N m/rad%s",
                    least, per_width(b));
        else
            fprintf(w->file, "    with the moving liquid: nothing restores");
        return;
    }
    mps__pendulum_periods(&p, turn, b->body->mass[degree], b->body->stiffness[degree], period);
    write_period(w, "    with the moving liquid, by linear theory", period[0], b);
    write_period(w, " and", period[1], b);
}

static void write_table(const writer *w, const build_motion *load)
{
    if (load->rows == 0) return;
    mps__check_heading(w, "");
    fprintf(w->file, "loads of %lld rows of %s; t = 0 is %.6g s of the file", (long long)load->rows,
            load->file, load->from);
    if (load->ramp > 0) fprintf(w->file, "; they grow over %.4g s ('ramp')", load->ramp);
    fprintf(w->file, "\n");
}

void mps__check_write_body(const writer *w, const build *b)
{
    const build_body *body = b->body;
    const char *width = per_width(b);
    frozen liquid;
    if (!mps__body_frozen(b, &liquid)) return;
    mps__check_heading(w, "body");
    fprintf(w->file, "mass %.4g kg%s at ", body->body.mass, width);
    mps__check_place(w, b, body->body.centre_of_mass);
    fprintf(w->file, ", centre ");
    mps__check_place(w, b, body->axes.centre);
    fprintf(w->file, "; liquid %.4g kg%s at ", liquid.mass, width);
    mps__check_place(w, b, liquid.place);
    fprintf(w->file, "\n");
    write_table(w, &body->load);
    for (int32_t d = 0; d < MOTION_DEGREES; d++) {
        if (!body->axes.used[d]) continue;
        const bool turn = d >= MPS_SHIP_ROLL;
        mps__check_heading(w, "");
        fprintf(w->file, "%s: %s %.4g %s%s, restoring %.4g %s%s, damping %.4g %s%s",
                mps__degrees[d], turn ? "inertia about the centre" : "mass", body->mass[d],
                turn ? "kg m2" : "kg", width, body->stiffness[d], turn ? "N m/rad" : "N/m", width,
                body->damping[d], turn ? "N m s/rad" : "N s/m", width);
        if (body->friction[d] > 0)
            fprintf(w->file, ", dry friction %.4g %s%s", body->friction[d], turn ? "N m" : "N",
                    width);
        fprintf(w->file, "\n");
        mps__check_heading(w, "");
        write_period(w, "    natural period without liquid", mps__body_period(b, d, NULL), b);
        write_period(w, "; with the liquid frozen", mps__body_period(b, d, &liquid), b);
        write_coupled(w, b, d);
        fprintf(w->file, "\n");
    }
}

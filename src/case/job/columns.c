/* SPDX-License-Identifier: BSD-3-Clause */
/* The common columns of probes.csv, and the bounding boxes of tank and liquid. */
#include "run.h"
#include "view.h"
#include <math.h>
#include <string.h>

/* The columns of every job, after the added ones, in the order from COLUMN_KE on. The unit of
 * energy is J, in 2-D J/m. */
static const job_column COMMON[COLUMN_COMMON] = {
    {.name = "ke", .unit = "J", .about = "Kinetic energy: of all fluid"},
    {.name = "x_tank", .unit = "m", .about = "Displacement of the tank along x"},
    {.name = "pe", .unit = "J", .about = "Potential energy: of all fluid, 0 at the lab's origin"},
    {.name = "wall_work_momentum",
     .unit = "J",
     .about = "Work of the walls, by momentum: that the fluid received, since the start"},
    {.name = "wall_work_probes",
     .unit = "J",
     .about = "Work of the walls, by probes: of the forces that probes show, since the start"},
    {.name = "viscous",
     .unit = "J",
     .about = "Energy lost by viscosity and numerical dissipation: since the start"},
    {.name = "plugins",
     .unit = "J",
     .about = "Energy lost in plug-ins: in models that are not the library's, since the start"},
    {.name = "collision", .unit = "J", .about = "Energy lost in collisions: since the start"},
    {.name = "shift", .unit = "J", .about = "Energy lost in shifting: since the start"},
    {.name = "numerical",
     .unit = "J",
     .about = "Energy lost otherwise: what closes the budget, since the start"},
    {.name = "added",
     .unit = "J",
     .about = "Energy from outside: of particles added or lost, since the start"},
    {.name = "volume_error",
     .about = "Error of volume: growth of the fluid below the surface since the first step, as a "
              "share"},
    {.name = "friction",
     .unit = "J",
     .about = "Energy lost at walls: taken by friction.history and layer.history, since the start"},
    {.name = "layers",
     .unit = "J",
     .about = "Energy of layers: kinetic energy of the flow at side walls, beside ke"}};

int mps__job_columns(const mps_job *job)
{
    return job->columns + COLUMN_COMMON;
}

bool mps__job_common(int k, int32_t dim, job_column *out)
{
    if (k < 0 || k >= COLUMN_COMMON) return false;
    *out = COMMON[k];
    if (strcmp(out->unit, "J") == 0 && dim != 3) memcpy(out->unit, "J/m", sizeof "J/m");
    out->type = "value";
    out->probe = -1;
    return true;
}

job_column mps__job_column(const mps_job *job, int k)
{
    job_column c = {.probe = -1};
    if (k < job->columns) return job->column[k];
    mps__job_common(k - job->columns, job->dim, &c);
    return c;
}

bool mps__job_is_common(const char *name)
{
    for (int k = 0; k < COLUMN_COMMON; k++)
        if (strcmp(COMMON[k].name, name) == 0) return true;
    return strcmp(name, "t") == 0;
}

mps_status mps_job_column_init(mps_job_column *column, size_t size)
{
    if (!column || size != sizeof *column) return MPS_E_ARG;
    *column = (mps_job_column){.struct_size = sizeof *column, .name = "", .unit = "", .about = ""};
    return MPS_OK;
}

mps_status mps_job_column_get(const mps_job *job, int32_t index, mps_job_column *column)
{
    if (!job || !column || column->struct_size != sizeof *column || index < 0 ||
        index >= job->columns)
        return MPS_E_ARG;
    const job_column *c = &job->column[index];
    *column = (mps_job_column){sizeof *column, c->flags, c->name, c->unit, c->about};
    return MPS_OK;
}

mps_status mps_job_column_read(mps_job *job, mps_sim *sim, int32_t index, double *value)
{
    double values[8] = {0};
    int32_t rank, ranks = 1;
    if (!job || !sim || !value || index < 0 || index >= job->columns) return MPS_E_ARG;
    const job_column *c = &job->column[index];
    mps_sim_ranks(sim, &rank, &ranks);
    if (ranks > 1 && (c->flags & MPS_JOB_PARTICLES))
        return mps__job_refuse(job, MPS_E_STATE, "%s: particles of one rank are not enough",
                               c->name);
    if (c->value) {
        *value = c->value(c->user, sim);
        return MPS_OK;
    }
    const mps_status status = mps_probe_read(sim, c->probe, values);
    if (status < 0) return mps__job_refuse(job, status, "%s: %s", c->name, mps_sim_error(sim));
    *value = values[c->component] - c->zero;
    return MPS_OK;
}

/* Set rounding errors around 0 to 0. */
static void tidy(job_box *b, double dp)
{
    for (int d = 0; d < 3; d++) {
        if (fabs(b->lo[d]) < 1e-9 * dp) b->lo[d] = 0;
        if (fabs(b->hi[d]) < 1e-9 * dp) b->hi[d] = 0;
    }
}

static void take(job_box *b, const double *x, int dim)
{
    for (int d = 0; d < dim; d++) {
        b->lo[d] = b->count ? fmin(b->lo[d], x[d]) : x[d];
        b->hi[d] = b->count ? fmax(b->hi[d], x[d]) : x[d];
    }
    b->count++;
}

void mps__job_boxes(mps_job *job)
{
    view v;
    job->walls = job->liquid = (job_box){0};
    const mps_status posed = mps__scene_pose(job->sim, job->dim, &job->built);
    if (!mps__job_note(job, posed, "pose of the tank")) return;
    if (!mps__job_note(job, mps__view_open(job->sim, &v) ? MPS_OK : MPS_E_BUSY, "size of the tank"))
        return;
    for (int64_t i = 0; i < v.x.count; i++) {
        double lab[3] = {0, 0, 0}, x[3];
        memcpy(lab, v.x.data + i * v.x.stride, (size_t)job->dim * sizeof *lab);
        mps__film_to_tank(&job->built, lab, x);
        const bool fluid = v.kind.integers[i] == MPS_FLUID;
        const int32_t phase = v.phase.integers[i];
        if (v.kind.integers[i] == MPS_WALL) take(&job->walls, x, job->dim);
        if (fluid && phase == 0) take(&job->liquid, x, job->dim);
        if (fluid && phase >= job->phases) job->phases = phase + 1;
    }
    tidy(&job->walls, job->dp);
    tidy(&job->liquid, job->dp);
    mps__view_close(job->sim, &v);
}

double mps__job_depth(const mps_job *job)
{
    const double floor = job->walls.lo[1], top = job->level > 0 ? job->level : job->liquid.hi[1];
    const bool stands = job->walls.count > 0 && job->liquid.count > 0 &&
                        job->liquid.lo[1] - floor < 1.5 * job->dp;
    return stands ? top - floor : NAN;
}

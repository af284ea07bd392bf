/* SPDX-License-Identifier: BSD-3-Clause */
/* The colour scale of all pictures of a run, determined from the case as built: independent of
 * restarts, of the time of a picture and of the number of ranks. */
#include "run.h"
#include "page_scale.h"
#include "view.h"
#include <math.h>

/* Phases considered; factor above the pressure at rest, for wave crests. */
enum { PHASES = 16 };
static const double RESERVE = 1.25;
/* Used instead of gravity where nothing else determines a pressure, as in mps_config.velocity_scale
 * [m/s2]. */
static const double GRAVITY_ELSE = 9.81;

/* Extents and speed of the particles of each phase. All are maxima, so that ranks can combine them:
 * `least` is negated. */
typedef struct extents {
    double most[3 * PHASES], least[3 * PHASES], speed[PHASES];
} extents;

static void take_particles(extents *e, const view *v, const mps_lease *u, int dim)
{
    for (int64_t i = 0; i < v->x.count; i++) {
        const double *x = v->x.data + i * v->x.stride, *w = u->data + i * u->stride;
        const int32_t k = v->phase.integers[i];
        double square = 0;
        if (v->kind.integers[i] != MPS_FLUID || k < 0 || k >= PHASES) continue;
        for (int d = 0; d < dim; d++) {
            e->most[3 * k + d] = fmax(e->most[3 * k + d], x[d]);
            e->least[3 * k + d] = fmax(e->least[3 * k + d], -x[d]);
            square += w[d] * w[d];
        }
        e->speed[k] = fmax(e->speed[k], sqrt(square));
    }
}

/* Collective call. @return false: the particles of this rank cannot be read */
static bool find_extents(mps_job *job, extents *e)
{
    const mps_job_ranks *r = job->config.ranks;
    mps_lease u = {.struct_size = sizeof u};
    view v;
    for (int k = 0; k < 3 * PHASES; k++) e->most[k] = e->least[k] = -HUGE_VAL;
    for (int k = 0; k < PHASES; k++) e->speed[k] = 0;
    bool read = mps__view_open(job->sim, &v);
    if (read) {
        read = mps_lease_begin(job->sim, "velocity", MPS_READ, &u) == MPS_OK;
        if (read) {
            take_particles(e, &v, &u, job->dim);
            mps_lease_end(job->sim, &u);
        }
        mps__view_close(job->sim, &v);
    }
    if (mps__job_ranks(job) > 1) {
        r->largest_numbers(r->user, 3 * PHASES, e->most);
        r->largest_numbers(r->user, 3 * PHASES, e->least);
        r->largest_numbers(r->user, PHASES, e->speed);
    }
    return read;
}

/* Surface tension of this phase with any other [N/m]. */
static double tension_of(const mps_sim *sim, int32_t phase)
{
    double common = 0, most = 0;
    if (mps_model_get(sim, "tension", "sigma", &common) != MPS_OK) return 0; /* no such model */
    for (int32_t other = 0; other < PHASES; other++) {
        double own = common;
        mps_phase p;
        mps_phase_init(&p, sizeof p);
        if (other == phase || mps_phase_get(sim, other, &p) != MPS_OK) continue;
        if (mps_tension_get(sim, phase, other, &own) != MPS_OK) own = common;
        most = fmax(most, own);
    }
    return most;
}

/* Pressures of the fluid at the start [Pa]: rho |g| h of the stacked phases; rho u^2 of a phase
 * that is brought to rest; the Laplace pressure of a droplet as narrow as the phase. If all are 0:
 * rho GRAVITY_ELSE h. 0: there is no fluid. */
static double pressure_at_start(const mps_job *job, const extents *e)
{
    double rest = 0, otherwise = 0, blow = 0, curved = 0;
    for (int32_t k = 0; k < PHASES; k++) {
        double width = HUGE_VAL;
        mps_phase p;
        mps_phase_init(&p, sizeof p);
        if (!(e->most[3 * k] > -HUGE_VAL) || mps_phase_get(job->sim, k, &p) != MPS_OK) continue;
        const double height = e->most[3 * k + 1] + e->least[3 * k + 1] + job->dp;
        for (int d = 0; d < job->dim; d++)
            width = fmin(width, e->most[3 * k + d] + e->least[3 * k + d] + job->dp);
        rest += p.density * fabs(job->config.gravity) * height;
        otherwise += p.density * GRAVITY_ELSE * height;
        blow = fmax(blow, p.density * e->speed[k] * e->speed[k]);
        curved = fmax(curved, tension_of(job->sim, k) * 2 * (job->dim - 1) / width);
    }
    const double known = RESERVE * (rest + curved) + blow;
    return known > 0 ? known : otherwise;
}

void mps__colours_begin(mps_job *job)
{
    const mps_job_config *c = &job->config;
    extents e;
    page_scale scale = {0};
    mps_picture_config_init(&job->picture, sizeof job->picture);
    job->picture.title = c->title ? c->title : c->name;
    job->picture.gravity = fabs(c->gravity);
    job->picture.edges = job->edge;
    job->picture.edge_count = job->edges;
    const bool read = find_extents(job, &e);
    if (!mps__job_note(job, read ? MPS_OK : MPS_E_BUSY, "colours of the pictures")) return;
    const double pressure = pressure_at_start(job, &e);
    if (!(pressure > 0) || !isfinite(pressure)) return; /* each picture determines its own scale */
    mps__scale_end(&scale, pressure, false);
    job->picture.pressure_lo = scale.lo;
    job->picture.pressure_hi = scale.hi;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of verbs: what they get, and what is checked after them. */
#include "guard.h"
#include <math.h>
#include <stdio.h>

static mps_status verb_failed(mps__host *h, const mps__call *call, double t)
{
    char *error = h->context->error;
    const mps_status status = h->no_memory ? MPS_E_NOMEM : MPS_E_PLUGIN;
    if (!error[0])
        return mps__fail(h->context, status, "model '%s' failed at t = %.9g s",
                         call->model->ops->name, t);
    return mps__fail(h->context, status, "model '%s' at t = %.9g s: %.300s", call->model->ops->name,
                     t, error);
}

/* The text of a failure at particle i: what the model left there, and what is allowed. */
static mps_status left(const mps__host *h, const mps_stage *s, const mps__call *call, int64_t i,
                       const char *what, const char *allowed)
{
    const double *x = s->x + i * s->dim;
    return mps__fail(
        h->context, MPS_E_PLUGIN,
        "model '%s' at t = %.9g s left %s at particle %lld, (%g, %g, %g) m; must be %s",
        call->model->ops->name, s->t, what, (long long)s->id[i], x[0], x[1], s->dim == 3 ? x[2] : 0,
        allowed);
}

static bool is_no_region(const void *regions, int64_t i)
{
    const int32_t *region = regions;
    return region[i] < MPS_REGION_INNER || region[i] > MPS_REGION_DRY;
}

/* Regions decide which rows later moments work on. */
static mps_status check_regions(const mps__host *h, const mps_stage *s, const mps__call *call)
{
    char what[32], allowed[32];
    const int32_t *region = mps__channels_array(h->channels, h->particles, MPS__REGION);
    const int64_t first = mps__parallel_first(h->parallel, s->n, is_no_region, region);
    if (first == s->n) return MPS_OK;
    snprintf(what, sizeof what, "region %d", (int)region[first]);
    snprintf(allowed, sizeof allowed, "%d..%d", MPS_REGION_INNER, MPS_REGION_DRY);
    return left(h, s, call, first, what, allowed);
}

static bool writes(const mps__call *call, int32_t channel)
{
    for (int32_t u = 0; u < call->verb->use_count; u++)
        if (call->channel[u] == channel && call->verb->uses[u].access & MPS_USE_WRITE) return true;
    return false;
}

static bool is_not_finite(const void *values, int64_t i)
{
    return !isfinite(((const double *)values)[i]);
}

/* No comparison with a number density that is not finite is true: the free surface would be lost
 * without an error. */
static mps_status check_number_density(const mps__host *h, const mps_stage *s,
                                       const mps__call *call)
{
    char what[64];
    const double *nd = mps__channels_array(h->channels, h->particles, MPS__NUMBER_DENSITY);
    const int64_t first = mps__parallel_first(h->parallel, s->n, is_not_finite, nd);
    if (first == s->n) return MPS_OK;
    snprintf(what, sizeof what, "the number density %g", nd[first]);
    return left(h, s, call, first, what, "finite");
}

static mps_status left_equation(const mps__host *h, const mps_stage *s, const mps__call *call,
                                const char *what, double value, const char *allowed)
{
    return mps__fail(h->context, MPS_E_PLUGIN,
                     "model '%s' at t = %.9g s left %s = %g in the pressure equation; must be %s",
                     call->model->ops->name, s->t, what, value, allowed);
}

/* The step divides by the gain, and a NaN here would be that of all pressures. */
static mps_status check_equation(const mps__host *h, const mps_stage *s, const mps__call *call)
{
    const mps_equation *e = s->equation;
    if (e->radius != MPS_NEAR && e->radius != MPS_FAR)
        return left_equation(h, s, call, "radius", e->radius, "MPS_NEAR or MPS_FAR");
    if (!(e->gain > 0 && e->gain <= 1))
        return left_equation(h, s, call, "gain", e->gain, "> 0 and <= 1");
    if (!(e->wall_factor >= 0 && isfinite(e->wall_factor)))
        return left_equation(h, s, call, "wall_factor", e->wall_factor, "finite and >= 0");
    return MPS_OK;
}

static mps_status check_after(const mps__host *h, const mps_stage *s, const mps__call *call)
{
    if (s->moment == MPS_LIMIT && !(s->dt_limit > 0))
        return mps__fail(
            h->context, MPS_E_PLUGIN,
            "model '%s' at t = %.9g s allows a step of %g s; must be > 0, INFINITY for no limit",
            call->model->ops->name, s->t, s->dt_limit);
    if (!mps__models_foreign(h->models, call->model)) return MPS_OK;
    if (s->equation) MPS__TRY(check_equation(h, s, call));
    if (writes(call, MPS__NUMBER_DENSITY)) MPS__TRY(check_number_density(h, s, call));
    return s->moment == MPS_CLASSIFY ? check_regions(h, s, call) : MPS_OK;
}

/* ---- ghosts ---- */

void mps__host_flux(const mps__host *h, int32_t channel[MPS__FLUX_CHANNELS])
{
    channel[0] = MPS__PRESSURE_DENSITY;
    channel[1] = MPS__TANK_ACCELERATION;
    channel[2] = mps__channels_find(h->channels, "interface_distance");
    channel[3] = mps__channels_find(h->channels, "pressure_jump");
    channel[4] = mps__channels_find(h->channels, "wetted_share");
}

mps_status mps__host_share(mps__host *h, const int32_t *channel, int32_t count)
{
    mps__shared shared[MPS__USES + MPS__FLUX_CHANNELS];
    int32_t found = 0;
    if (!mps__ranks_many(h->ghosts->ranks)) return MPS_OK;
    for (int32_t k = 0; k < count; k++) {
        bool *stale = channel[k] < 0 ? NULL
                                     : mps__channels_stale(h->channels, h->particles, channel[k]);
        if (!stale || !*stale) continue;
        *stale = false;
        shared[found++] = (mps__shared){mps__channels_array(h->channels, h->particles, channel[k]),
                                        mps__channels_bytes(h->channels, h->particles, channel[k])};
    }
    return mps__ghosts_share(h->ghosts, shared, found);
}

void mps__host_written(mps__host *h, int32_t channel)
{
    *mps__channels_stale(h->channels, h->particles, channel) = true;
}

void mps__host_alike(mps__host *h, int32_t channel)
{
    *mps__channels_stale(h->channels, h->particles, channel) = false;
}

void mps__host_all_alike(mps__host *h)
{
    for (int32_t k = 0; k < h->channels->count; k++) h->channels->list[k].stale = false;
    for (int32_t k = 0; k < h->particles->fields; k++) h->particles->field[k].stale = false;
}

/* Channels that the verb reads at neighbours; from MPS_FORCE on also those of the fluxes of pairs, which need no use. */
static mps_status share_before(mps__host *h, const mps_stage *s, const mps__call *call)
{
    int32_t channel[MPS__USES + MPS__FLUX_CHANNELS], count = 0;
    if (!mps__ranks_many(h->ghosts->ranks)) return MPS_OK;
    for (int32_t u = 0; u < call->verb->use_count; u++)
        if (call->verb->uses[u].access & MPS__USE_AROUND) channel[count++] = call->channel[u];
    if (s->moment >= MPS_FORCE) {
        mps__host_flux(h, channel + count);
        count += MPS__FLUX_CHANNELS;
    }
    return mps__host_share(h, channel, count);
}

static void note_writes(mps__host *h, const mps__call *call)
{
    for (int32_t u = 0; u < call->verb->use_count; u++)
        if (call->channel[u] >= 0 && call->verb->uses[u].access & MPS_USE_WRITE)
            mps__host_written(h, call->channel[u]);
}

static mps_status run_call(mps__host *h, mps_stage *s, const mps__call *call)
{
    void *data[MPS__USES];
    MPS__TRY(share_before(h, s, call));
    for (int32_t u = 0; u < call->verb->use_count; u++)
        data[u] = mps__channels_array(h->channels, h->particles, call->channel[u]);
    s->data = data;
    s->setting = call->model->k;
    s->self = call->model->self;
    h->context->error[0] = 0;
    h->no_memory = false;
    h->misused = false;
    const int failed = call->verb->run(s) || h->misused;
    h->scratch_used = 0;
    s->data = NULL;
    note_writes(h, call);
    return failed ? verb_failed(h, call, s->t) : check_after(h, s, call);
}

#ifdef MPS_CHECKED
static mps_status run_checked(mps__host *h, mps_stage *s, const mps__call *call)
{
    mps__guard guard;
    mps_status status = mps__guard_begin(&guard, h, s, call);
    if (status == MPS_OK) status = run_call(h, s, call);
    const mps_status after = mps__guard_end(&guard, h, s, call);
    return status < 0 ? status : after;
}
#else
#define run_checked run_call
#endif

mps_status mps__host_run(mps__host *h, mps_stage *s, int32_t moment)
{
    const mps__lock before = mps__lock_set(h->context, MPS__LOCKED, "a verb of a model");
    mps_status status = MPS_OK;
    s->moment = moment;
    s->host = h;
    for (int32_t k = h->plan.begin[moment]; k < h->plan.begin[moment + 1] && status == MPS_OK; k++)
        status = run_checked(h, s, &h->plan.call[k]);
    h->context->lock = before;
    return status;
}

const char *mps__host_writer(const mps__host *h, int32_t channel)
{
    for (int32_t k = 0; k < h->plan.begin[MPS_MOMENT_COUNT]; k++)
        if (writes(&h->plan.call[k], channel)) return h->plan.call[k].model->ops->name;
    return NULL;
}

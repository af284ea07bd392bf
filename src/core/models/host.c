/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of verbs: what they get, and what is checked after them. */
#include "guard.h"
#include <math.h>

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

static void *array_of(const mps__host *h, int32_t channel)
{
    if (channel < 0) return NULL;
    if (channel >= MPS__CHANNELS) return *h->particles->field[channel - MPS__CHANNELS].data;
    return mps__channels_array(h->channels, h->particles, channel);
}

/* Regions decide which rows later moments work on. */
static mps_status check_regions(const mps__host *h, const mps_stage *s, const mps__call *call)
{
    const int32_t *region = h->channels->list[MPS__REGION].array;
    int64_t first = s->n;
    for (int64_t i = 0; i < s->n && first == s->n; i++)
        if (region[i] < MPS_REGION_INNER || region[i] > MPS_REGION_DRY) first = i;
    if (first == s->n) return MPS_OK;
    const double *x = s->x + first * s->dim;
    return mps__fail(
        h->context, MPS_E_PLUGIN,
        "model '%s' at t = %.9g s left region %d at particle %lld, (%g, %g, %g) m; must be %d..%d",
        call->model->ops->name, s->t, (int)region[first], (long long)s->id[first], x[0], x[1],
        s->dim == 3 ? x[2] : 0, MPS_REGION_INNER, MPS_REGION_DRY);
}

static bool writes(const mps__call *call, int32_t channel)
{
    for (int32_t u = 0; u < call->verb->use_count; u++)
        if (call->channel[u] == channel && call->verb->uses[u].access & MPS_USE_WRITE) return true;
    return false;
}

/* No comparison with a number density that is not finite is true: the free surface would be lost without an error. */
static mps_status check_number_density(const mps__host *h, const mps_stage *s,
                                       const mps__call *call)
{
    const double *nd = array_of(h, MPS__NUMBER_DENSITY);
    int64_t first = 0;
    while (first < s->n && isfinite(nd[first])) first++;
    if (first == s->n) return MPS_OK;
    const double *x = s->x + first * s->dim;
    return mps__fail(h->context, MPS_E_PLUGIN,
                     "model '%s' at t = %.9g s left the number density %g at particle %lld, (%g, "
                     "%g, %g) m; must be finite",
                     call->model->ops->name, s->t, nd[first], (long long)s->id[first], x[0], x[1],
                     s->dim == 3 ? x[2] : 0);
}

static mps_status check_after(const mps__host *h, const mps_stage *s, const mps__call *call)
{
    if (s->moment == MPS_LIMIT && !(s->dt_limit > 0))
        return mps__fail(
            h->context, MPS_E_PLUGIN,
            "model '%s' at t = %.9g s allows a step of %g s; must be > 0, INFINITY for no limit",
            call->model->ops->name, s->t, s->dt_limit);
    if (!mps__models_foreign(h->models, call->model)) return MPS_OK;
    if (writes(call, MPS__NUMBER_DENSITY)) MPS__TRY(check_number_density(h, s, call));
    return s->moment == MPS_CLASSIFY ? check_regions(h, s, call) : MPS_OK;
}

static mps_status run_call(mps__host *h, mps_stage *s, const mps__call *call)
{
    void *data[MPS__USES];
    for (int32_t u = 0; u < call->verb->use_count; u++) data[u] = array_of(h, call->channel[u]);
    s->data = data;
    s->setting = call->model->k;
    s->self = call->model->self;
    h->context->error[0] = 0;
    h->no_memory = false;
    const int failed = call->verb->run(s);
    h->scratch_used = 0;
    s->data = NULL;
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

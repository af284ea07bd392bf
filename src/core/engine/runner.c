/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of verbs: their arguments, and checks of their results. */
#include "guard.h"
#include "loop.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static mps_status verb_failed(mps__runner *h, const mps__call *call, double t)
{
    char *error = h->context->error;
    const mps_status status = h->no_memory ? MPS_E_NOMEM : MPS_E_PLUGIN;
    if (!error[0])
        return mps__fail(h->context, status, "model '%s' failed at t = %.9g s", call->name, t);
    return mps__fail(h->context, status, "model '%s' at t = %.9g s: %.300s", call->name, t, error);
}

/* Error text of an invalid value at particle i: the value, and what is allowed. */
static mps_status left(mps__runner *h, const mps_stage *s, const mps__call *call, int64_t i,
                       const char *what, const char *allowed)
{
    if (h->memory.space == MPS__ON_DEVICE) mps__memory_sync_fields(&h->memory);
    const double *x = h->particles->x + i * s->view->dim;
    return mps__fail(
        h->context, MPS_E_PLUGIN,
        "model '%s' at t = %.9g s left %s at particle %lld, (%g, %g, %g) m; must be %s", call->name,
        s->view->t, what, (long long)h->particles->id[i], x[0], x[1], s->view->dim == 3 ? x[2] : 0,
        allowed);
}

/* Copy a value of a channel from the memory space of the call to the host. */
static void fetch_value(mps__runner *h, void *to, const void *from, size_t bytes)
{
    if (h->memory.space == MPS__ON_DEVICE)
        mps__device_download(&h->memory.device, to, from, bytes);
    else
        memcpy(to, from, bytes);
}

/* Fields of the checks. */
typedef struct check_fields {
    const int32_t *region;
    const double *nd;
} check_fields;

MPS_ROW bool is_no_region(const check_fields *f, int64_t i)
{
    return f->region[i] < MPS_REGION_INNER || f->region[i] > MPS_REGION_DRY;
}
MPS__FIRST(bad_regions, is_no_region, check_fields)

/* Later hooks select particles by region. */
static mps_status check_regions(mps__runner *h, const mps_stage *s, const mps__call *call)
{
    char what[32], allowed[32];
    const int32_t *region = mps__memory_array(&h->memory, MPS__REGION, h->memory.space);
    int32_t bad = 0;
    const int64_t first = mps__first_run(h->parallel, &bad_regions, s->view->n,
                                         &(check_fields){.region = region});
    if (first == s->view->n) return MPS_OK;
    fetch_value(h, &bad, region + first, sizeof bad);
    snprintf(what, sizeof what, "region %d", (int)bad);
    snprintf(allowed, sizeof allowed, "%d..%d", MPS_REGION_INNER, MPS_REGION_DRY);
    return left(h, s, call, first, what, allowed);
}

static bool writes(const mps__call *call, int32_t channel)
{
    for (int32_t u = 0; u < call->use_count; u++)
        if (call->channel[u] == channel && call->uses[u].access & MPS_USE_WRITE) return true;
    return false;
}

MPS_ROW bool is_not_finite(const check_fields *f, int64_t i)
{
    return !isfinite(f->nd[i]);
}
MPS__FIRST(bad_densities, is_not_finite, check_fields)

/* Every comparison with a non-finite number density is false: the free surface would be lost
 * without an error. */
static mps_status check_number_density(mps__runner *h, const mps_stage *s, const mps__call *call)
{
    char what[64];
    const double *nd = mps__memory_array(&h->memory, MPS__NUMBER_DENSITY, h->memory.space);
    double bad = 0;
    const int64_t first = mps__first_run(h->parallel, &bad_densities, s->view->n,
                                         &(check_fields){.nd = nd});
    if (first == s->view->n) return MPS_OK;
    fetch_value(h, &bad, nd + first, sizeof bad);
    snprintf(what, sizeof what, "the number density %g", bad);
    return left(h, s, call, first, what, "finite");
}

static mps_status left_equation(const mps__runner *h, const mps_stage *s, const mps__call *call,
                                const char *what, double value, const char *allowed)
{
    return mps__fail(h->context, MPS_E_PLUGIN,
                     "model '%s' at t = %.9g s left %s = %g in the pressure equation; must be %s",
                     call->name, s->view->t, what, value, allowed);
}

static double number_of(const mps__runner *h, int32_t channel)
{
    const mps__channel *k = &h->channels->list[channel];
    return k->spec.type == MPS_TYPE_INTEGER ? *(const int32_t *)k->array.host
                                            : *(const double *)k->array.host;
}

/* The step divides by the gain; a NaN here would spread to all pressures. */
static mps_status check_equation(const mps__runner *h, const mps_stage *s, const mps__call *call)
{
    const double radius = number_of(h, MPS__EQUATION_RADIUS),
                 gain = number_of(h, MPS__EQUATION_GAIN),
                 wall_factor = number_of(h, MPS__EQUATION_WALL_FACTOR);
    if (radius != MPS_NEAR && radius != MPS_FAR)
        return left_equation(h, s, call, "equation_radius", radius, "MPS_NEAR or MPS_FAR");
    if (!(gain > 0 && gain <= 1))
        return left_equation(h, s, call, "equation_gain", gain, "> 0 and <= 1");
    if (!(wall_factor >= 0 && isfinite(wall_factor)))
        return left_equation(h, s, call, "equation_wall_factor", wall_factor, "finite and >= 0");
    return MPS_OK;
}

static mps_status check_after(mps__runner *h, const mps_stage *s, const mps__call *call)
{
    if (s->hook == MPS_LIMIT && !(s->dt_limit > 0))
        return mps__fail(
            h->context, MPS_E_PLUGIN,
            "model '%s' at t = %.9g s allows a step of %g s; must be > 0, INFINITY for no limit",
            call->name, s->view->t, s->dt_limit);
    if (!mps__models_foreign(h->models, call->model)) return MPS_OK;
    for (int32_t u = 0; u < call->use_count; u++)
        if (call->channel[u] >= MPS__EQUATION_RADIUS && call->channel[u] <= MPS__EQUATION_GAIN)
            MPS__TRY(check_equation(h, s, call));
    if (writes(call, MPS__NUMBER_DENSITY)) MPS__TRY(check_number_density(h, s, call));
    return writes(call, MPS__REGION) ? check_regions(h, s, call) : MPS_OK;
}

/* ---- ghosts ---- */

/* Halo exchange of the listed channels whose ghosts are stale. */
static mps_status exchange(mps__runner *h, const int32_t *channel, int32_t count)
{
    mps__halo_array shared[MPS__USES + MPS__FLUX_CHANNELS];
    int32_t found = 0;
    if (!mps__ranks_many(h->ghosts->ranks)) return MPS_OK;
    for (int32_t k = 0; k < count; k++) {
        const mps__array *a = mps__channels_of(h->channels, h->particles, channel[k]);
        if (a && !mps__array_ghosts_valid(a))
            shared[found++] = mps__memory_halo(&h->memory, channel[k]);
    }
    return mps__ghosts_exchange_at(h->ghosts, &h->memory.device, shared, found);
}

void mps__runner_all_alike(mps__runner *h)
{
    for (int32_t k = 0; k < h->channels->count; k++)
        mps__array_ghosts_set(&h->channels->list[k].array, true);
    for (int32_t k = 0; k < h->particles->fields; k++)
        mps__array_ghosts_set(&h->particles->field[k].array, true);
}

/* Halo exchange of channels that the call reads at neighbours; from MPS_FORCE on also of the pair
 * flux channels, which need no declared use. */
static mps_status exchange_before(mps__runner *h, const mps__call *call)
{
    int32_t channel[MPS__USES + MPS__FLUX_CHANNELS], count = 0;
    bool pairs = call->model != NULL;
    if (!mps__ranks_many(h->ghosts->ranks)) return MPS_OK;
    for (int32_t u = 0; u < call->use_count; u++) {
        if (!(call->uses[u].access & MPS__USE_AROUND)) continue;
        channel[count++] = call->channel[u];
        pairs = true;
    }
    if (pairs && call->hook >= MPS_FORCE) {
        mps__flux_channels(h->channels, channel + count);
        count += MPS__FLUX_CHANNELS;
    }
    return exchange(h, channel, count);
}

static mps__array *array_of(const mps__runner *h, int32_t channel)
{
    return mps__channels_of(h->channels, h->particles, channel);
}

/* New versions of what a call wrote; ghosts do not have them. Loops run over owned particles. A
 * pass with `with_ghosts` leaves ghosts valid if its inputs and the values that it modified were
 * valid there. */
static void note_writes(mps__runner *h, const mps__call *call, int32_t space)
{
    bool ghosts = call->pass && call->pass->with_ghosts;
    for (int32_t u = 0; u < call->use_count && ghosts; u++)
        ghosts = call->uses[u].access & MPS_USE_WRITE || !array_of(h, call->channel[u]) ||
                 mps__array_ghosts_valid(array_of(h, call->channel[u]));
    for (int32_t u = 0; u < call->use_count; u++) {
        mps__array *a = array_of(h, call->channel[u]);
        if (!a || !(call->uses[u].access & MPS_USE_WRITE)) continue;
        const bool were = !(call->uses[u].access & MPS_USE_READ) || mps__array_ghosts_valid(a);
        mps__array_written(a, space);
        mps__array_ghosts_set(a, ghosts && were);
    }
}

/* ---- first values ---- */

/* A channel of a model: `width` numbers per row; each `diagonal`th is `initial`, the others are
 * 0. */
typedef struct beginning {
    double initial;
    double *reals; /* one of the two is NULL */
    int32_t *integers;
    int32_t width, diagonal;
} beginning;

MPS_ROW void begin_row(const beginning *b, int64_t i)
{
    for (int32_t d = 0; d < b->width; d++) {
        const double value = d % b->diagonal == 0 ? b->initial : 0;
        if (b->reals)
            b->reals[i * b->width + d] = value;
        else
            b->integers[i * b->width + d] = (int32_t)value;
    }
}
MPS__LOOP_ANY(begin_rows, begin_row, beginning)

static void begin_channel(mps__runner *h, int32_t channel, int32_t space)
{
    const mps__channel *k = &h->channels->list[channel];
    const bool scalar = mps__channel_is_scalar(k), real = k->spec.type == MPS_TYPE_REAL;
    const int32_t before = mps__memory_set_space(&h->memory, scalar ? MPS__ON_HOST : space);
    void *array = mps__memory_array(&h->memory, channel, space);
    const beginning b = {.initial = k->spec.initial,
                         .reals = real ? array : NULL,
                         .integers = real ? NULL : array,
                         .width = scalar ? 1 : k->components,
                         .diagonal = k->spec.components == MPS_MATRIX ? h->channels->dim + 1 : 1};
    mps__loop_run(h->parallel, &begin_rows, MPS__ANY_DIM, scalar ? 1 : h->particles->n, &b);
    mps__memory_set_space(&h->memory, before);
    mps__memory_written(&h->memory, channel, space);
}

/* Initialise the channels of models before the first call that uses them. */
static void begin_channels(mps__runner *h, const mps__call *call, int32_t space)
{
    for (int32_t k = MPS__OWN_CHANNELS; call->begins >> k; k++) {
        if (!(call->begins >> k & 1)) continue;
        begin_channel(h, k, space);
        mps__array_ghosts_set(&h->channels->list[k].array, true);
    }
}

/* ---- a device ---- */

/* Memory space of a call: the device if the call and the device support it. */
static int32_t space_of(const mps__runner *h, const mps__call *call)
{
    if (!h->memory.open) return MPS__ON_HOST;
    const bool device = call->pass
                            ? call->pass->device
                            : call->verb->device && (h->memory.device.ops.plugin_loops ||
                                                     !mps__models_foreign(h->models, call->model));
    return device ? MPS__ON_DEVICE : MPS__ON_HOST;
}

/* Copy what a call reads to its memory space, also arrays that it writes only in part. Pair flux
 * channels need no declared use. */
static void make_ready(mps__runner *h, const mps__call *call, int32_t space)
{
    int32_t flux[MPS__FLUX_CHANNELS];
    if (!h->memory.open) return;
    mps__memory_sync(&h->memory, MPS__POSITION, space);
    bool pairs = call->model != NULL;
    for (int32_t u = 0; u < call->use_count; u++) {
        pairs = pairs || call->uses[u].access & MPS__USE_AROUND;
        if (!(call->uses[u].access & MPS__USE_BEGIN))
            mps__memory_sync(&h->memory, call->channel[u], space);
    }
    if (space == MPS__ON_HOST && pairs) mps__memory_sync_lists(&h->memory);
    if (call->hook < MPS_FORCE) return;
    mps__flux_channels(h->channels, flux);
    for (int f = 0; f < MPS__FLUX_CHANNELS; f++) mps__memory_sync(&h->memory, flux[f], space);
}

const mps_view *mps__runner_begin_serial(mps_stage *s)
{
    mps__runner *h = s->host;
    const mps_view *device_view = s->view;
    mps__memory_set_space(&h->memory, MPS__ON_HOST);
    s->view = h->view;
    return device_view;
}

void mps__runner_end_serial(mps_stage *s, const mps_view *device_view)
{
    mps__runner *h = s->host;
    mps__memory_set_space(&h->memory, MPS__ON_DEVICE);
    s->view = device_view;
}

void mps__runner_switch_to_host(mps_stage *s)
{
    mps__runner *h = s->host;
    if (h->memory.space == MPS__ON_HOST) return;
    for (int32_t u = 0; u < h->call->use_count; u++)
        h->data[u] = mps__memory_array(&h->memory, h->call->channel[u], MPS__ON_HOST);
    mps__memory_set_space(&h->memory, MPS__ON_HOST);
    s->view = h->view;
    h->switched = true;
    h->memory.device.info.host_calls++;
}

void mps__runner_to_host(mps__runner *h)
{
    if (!h->switched || h->copied) return;
    begin_channels(h, h->call, MPS__ON_HOST);
    make_ready(h, h->call, MPS__ON_HOST);
    h->copied = true;
}

/* ---- calls ---- */

int32_t mps__runner_line(const mps__runner *h, const mps__call *call)
{
    if (!call->model) return MPS__LINE_OF_HOOK;
    if (mps__models_foreign(h->models, call->model)) return MPS__LINE_PLUGINS;
    const char *name = call->model->ops->name;
    return mps__same_slot(name, "friction") || mps__same_slot(name, "layer") ? MPS__LINE_FRICTION
                                                                             : MPS__LINE_OF_HOOK;
}

static mps_status run_verb(mps__runner *h, mps_stage *s, const mps__call *call)
{
    const mps__lock before = mps__lock_set(h->context, MPS__LOCKED, "a verb of a model");
    h->context->error[0] = 0;
    h->no_memory = false;
    h->misused = false;
    h->line = mps__runner_line(h, call);
    const int failed = call->verb->run(s) || h->misused;
    h->context->lock = before;
    if (failed && h->ghosts->ranks->failed) return mps__ranks_status(h->ghosts->ranks);
    return failed ? verb_failed(h, call, s->view->t) : check_after(h, s, call);
}

static mps_status run_call(mps__runner *h, mps_stage *s, mps_view *v, mps__call *call)
{
    void *data[MPS__USES];
    mps_view device_view;
    const int32_t space = space_of(h, call);
    h->view = v;
    h->call = call;
    h->data = data;
    h->switched = h->copied = false;
    for (int32_t u = 0; u < call->use_count; u++)
        data[u] = mps__memory_array(&h->memory, call->channel[u], space);
    v->setting = call->model ? call->model->k : NULL;
    s->data = data;
    s->self = call->model ? call->model->self : h->step;
    h->model = call->model ? &h->models->on[call->model - h->models->on] : NULL;
    h->with_ghosts = call->pass && call->pass->with_ghosts;
    mps__memory_set_space(&h->memory, space);
    if (space == MPS__ON_DEVICE) {
        device_view = *v;
        mps__memory_view(&h->memory, &device_view);
        s->view = &device_view;
    }
    mps_status status = call->pass ? call->pass->run(s) : run_verb(h, s, call);
    mps__memory_set_space(&h->memory, MPS__ON_HOST);
    /* a failed copy explains the failure of the verb */
    if (space == MPS__ON_DEVICE && (status >= 0 || (h->copied && h->memory.device.failed)))
        status = mps__device_status(&h->memory.device);
    h->with_ghosts = false;
    h->model = NULL;
    h->scratch_used = 0;
    s->view = v;
    s->data = NULL;
    note_writes(h, call, h->copied ? MPS__ON_HOST : space);
    h->switched = false;
    return status;
}

/* ---- costs ---- */

/* Lower bound of the bytes moved by the loops of a call: each declared array once for reading, once
 * for writing. */
static double bytes_of(const mps__runner *h, const mps__call *call)
{
    double bytes = 0;
    for (int32_t u = 0; u < call->use_count; u++) {
        if (!array_of(h, call->channel[u])) continue;
        const int32_t access = call->uses[u].access;
        const int times = !!(access & (MPS_USE_READ | MPS__USE_AROUND)) +
                          !!(access & MPS_USE_WRITE);
        bytes += times * (double)h->particles->n *
                 (double)mps__channels_bytes(h->channels, h->particles, call->channel[u]);
    }
    return bytes;
}

void mps__runner_begin(mps__runner *h)
{
    memset(h->seconds, 0, sizeof h->seconds);
    h->step = NULL; /* the previous step is over */
    h->deferred.count = h->deferred.sums = h->deferred.maxima = 0;
    memset(h->wrong, 0, sizeof h->wrong);
    h->densities.agreed = false;
    h->before_call = NULL;
    h->in_calls = 0;
    h->clock = mps__clock();
}

double mps__runner_book(mps__runner *h, int part)
{
    const double now = mps__clock(), seconds = now - h->clock - h->in_calls;
    mps__cost *cost = &h->plan.outside[part];
    cost->calls++;
    cost->seconds += seconds;
    h->in_calls = 0;
    h->clock = now;
    return seconds;
}

static int stage_of(const mps__call *call)
{
    if (call->pass) return call->pass->stage;
    return call->hook <= MPS_SOURCE ? MPS_STAGE_OPERATORS : MPS_STAGE_CORRECT;
}

#ifdef MPS_CHECKED
static mps_status run_checked(mps__runner *h, mps_stage *s, mps_view *v, mps__call *call)
{
    mps__guard guard;
    mps_status status = mps__guard_begin(&guard, h, call);
    if (status == MPS_OK) status = run_call(h, s, v, call);
    return mps__guard_end(&guard, h, s, call, status);
}
#else
#define run_checked run_call
#endif

static bool is_idle(const mps__runner *h, const mps__call *call)
{
    return call->pass && call->pass->idle && call->pass->idle(h->step);
}

mps_status mps__runner_run(mps__runner *h, mps_stage *s, mps_view *v, int32_t hook)
{
    mps_status status = MPS_OK;
    double clock = mps__clock();
    s->hook = hook;
    s->view = v;
    s->host = h;
    if (hook == MPS_LIMIT) h->limiter = -1;
    for (int32_t k = h->plan.begin[hook]; k < h->plan.begin[hook + 1] && status == MPS_OK; k++) {
        mps__call *call = &h->plan.call[k];
        const double limit = s->dt_limit;
        if (is_idle(h, call)) continue;
        if (h->before_call) h->before_call(h->step, call);
        status = exchange_before(h, call);
        h->memory.device.info.host_calls += h->memory.open && space_of(h, call) == MPS__ON_HOST;
        begin_channels(h, call, space_of(h, call));
        make_ready(h, call, space_of(h, call));
        if (status == MPS_OK) status = mps__device_status(&h->memory.device);
        if (status == MPS_OK) status = run_checked(h, s, v, call);
        if (hook == MPS_LIMIT && s->dt_limit < limit) h->limiter = k;
        call->cost.calls++;
        call->cost.bytes += bytes_of(h, call);
        const double now = mps__clock(), seconds = now - clock;
        clock = now;
        call->cost.seconds += seconds;
        h->seconds[stage_of(call)] += seconds;
        h->in_calls += seconds;
    }
    return status;
}

/* Log the calls that run on the host: once after each change of models or device. */
void mps__runner_log_spaces(mps__runner *h)
{
    char text[MPS__ERROR_SIZE] = "";
    size_t used = 0;
    if (!h->memory.open || h->memory.logged == h->plan.changes) return;
    h->memory.logged = h->plan.changes;
    for (int32_t k = 0; k < h->plan.begin[MPS_HOOK_COUNT]; k++) {
        const mps__call *call = &h->plan.call[k];
        if (space_of(h, call) != MPS__ON_HOST || is_idle(h, call)) continue;
        if (used + MPS__NAME_SIZE + 2 > sizeof text) continue;
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", used > 0 ? ", " : "",
                                 call->name);
    }
    if (used > 0)
        mps__log(h->context, MPS_LOG_INFO,
                 "device '%s': these parts of a step run on the host, with copies: %.400s",
                 h->memory.device.ops.name, text);
}

const char *mps__runner_writer(const mps__runner *h, int32_t channel)
{
    for (int32_t k = 0; k < h->plan.begin[MPS_HOOK_COUNT]; k++)
        if (h->plan.call[k].model && writes(&h->plan.call[k], channel)) return h->plan.call[k].name;
    return NULL;
}

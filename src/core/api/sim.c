/* SPDX-License-Identifier: BSD-3-Clause */
/* Create and destroy a simulation; configuration, phases and models of the public interface. */
#include "step.h"
#include "sim.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const mps_config config_default = {.struct_size = sizeof(mps_config),
                                          .dim = 2,
                                          .gravity = {0, -9.81, 0},
                                          .kernel = "improved",
                                          .re_near = 2.1,
                                          .threads = 1,
                                          .speed_limit = 1000};
static const mps_phase water = {
    .struct_size = sizeof(mps_phase), .density = 1000, .viscosity = 1e-3};

/* Range of spacings whose powers are finite and non-zero [m]. */
static const double DP_MIN = 1e-12, DP_MAX = 1e12;

mps_status mps_config_init(mps_config *config, size_t size)
{
    return mps__struct_init("mps_config", config, size, &config_default, sizeof config_default);
}

mps_status mps_phase_init(mps_phase *phase, size_t size)
{
    return mps__struct_init("mps_phase", phase, size, &water, sizeof water);
}

static mps_status check_domain(mps__context *c, const mps_config *f, bool *given)
{
    *given = false;
    for (int d = 0; d < f->dim; d++)
        *given = *given || f->domain_min[d] != 0 || f->domain_max[d] != 0;
    for (int d = 0; *given && d < f->dim; d++)
        MPS__CHECK(c, f->domain_max[d] > f->domain_min[d],
                   "config.domain axis %d is %g..%g: max must be greater than min", d,
                   f->domain_min[d], f->domain_max[d]);
    return MPS_OK;
}

static mps_status check_config(mps__context *c, mps_config *f)
{
    if (f->dim == 0) f->dim = 2;
    MPS__CHECK(c, f->dim == 2 || f->dim == 3, "config.dim is %d: 2 or 3", f->dim);
    MPS__CHECK(c, f->dp >= DP_MIN && f->dp <= DP_MAX, "config.dp is %g m: must be %g..%g m", f->dp,
               DP_MIN, DP_MAX);
    if (f->re_near == 0) f->re_near = 2.1;
    if (f->re_far == 0) f->re_far = f->dim == 2 ? 3.1 : 2.1;
    /* diagonal neighbours, at 1.42 dp, need a non-zero weight: with 1.1 the energy of a tank grows
     * tenfold, with 1.01 it diverges */
    MPS__CHECK(c, f->re_near >= 1.5 && f->re_near <= 10,
               "config.re_near is %g dp: 1.5 <= re_near <= 10", f->re_near);
    MPS__CHECK(c, f->re_far >= f->re_near && f->re_far <= 10,
               "config.re_far is %g dp: re_near (%g) <= re_far <= 10", f->re_far, f->re_near);
    if (f->threads == 0) f->threads = 1;
    MPS__CHECK(c, f->threads >= 1 && f->threads <= MPS__THREADS_MOST, "config.threads is %d: 1..%d",
               f->threads, MPS__THREADS_MOST);
    MPS__CHECK(c, f->lost_policy == MPS_LOST_REMOVE || f->lost_policy == MPS_LOST_ERROR,
               "config.lost_policy is %d: MPS_LOST_REMOVE or MPS_LOST_ERROR", f->lost_policy);
    MPS__CHECK(c, mps__finite(f->gravity, 3), "config.gravity is (%g, %g, %g): must be finite",
               f->gravity[0], f->gravity[1], f->gravity[2]);
    MPS__CHECK(c, f->velocity_scale >= 0 && isfinite(f->velocity_scale),
               "config.velocity_scale is %g: must be >= 0 m/s", f->velocity_scale);
    for (int d = 0; d < 3; d++) {
        MPS__CHECK(c, isfinite(f->domain_min[d]), "config.domain_min[%d] is %g: must be finite", d,
                   f->domain_min[d]);
        MPS__CHECK(c, isfinite(f->domain_max[d]), "config.domain_max[%d] is %g: must be finite", d,
                   f->domain_max[d]);
    }
    if (f->speed_limit == 0) f->speed_limit = config_default.speed_limit;
    MPS__CHECK(c, f->speed_limit > 0, "config.speed_limit is %g: must be > 0 m/s", f->speed_limit);
    MPS__CHECK(c, !f->allocator.alloc == !f->allocator.release,
               "config.allocator: alloc and release go together");
    return MPS_OK;
}

static mps_status set_up(mps_sim *sim, const mps_config *f)
{
    mps__world *w = &sim->world;
    MPS__TRY(
        mps__world_init(w, &sim->context, f->dim, f->dp, mps__step_passes, mps__step_pass_count));
    const char *kernel = f->kernel ? f->kernel : config_default.kernel;
    w->setup.kernel.struct_size = sizeof w->setup.kernel;
    if (mps_kernel_find(kernel, &w->setup.kernel) != MPS_OK) {
        const char *names[] = {"improved", "original"};
        char hint[MPS__HINT_SIZE];
        return mps__fail(&sim->context, MPS_E_NAME, "config.kernel is \"%.60s\"; %s", kernel,
                         mps__hint(hint, '"', kernel, names, 2));
    }
    for (int d = 0; d < f->dim; d++) w->setup.g[d] = f->gravity[d];
    const double g = sqrt(mps__dot(w->setup.g, w->setup.g, f->dim));
    w->setup.scale_given = f->velocity_scale > 0;
    w->setup.velocity_scale = w->setup.scale_given ? f->velocity_scale
                                                   : sqrt((g > 0 ? g : 9.81) * f->dp);
    w->setup.re_near = f->re_near * f->dp;
    w->setup.re_far = f->re_far * f->dp;
    mps__pool_resize(&w->pool, f->threads);
    MPS__TRY(mps__pool_set(&w->pool, &f->parallel, "config.parallel"));
    w->threads = w->pool.parallel.threads;
    w->setup.lost_policy = f->lost_policy;
    w->setup.speed_limit = f->speed_limit;
    MPS__TRY(check_domain(&sim->context, f, &w->setup.domain_given));
    memcpy(w->setup.domain_min, f->domain_min, sizeof w->setup.domain_min);
    memcpy(w->setup.domain_max, f->domain_max, sizeof w->setup.domain_max);
    mps_time_control_init(&w->setup.control, sizeof w->setup.control);
    w->setup.control.dt_min = 1e-9 * sqrt(f->dp / 9.81);
    w->setup.phase_defined[0] = true;
    w->setup.phase_density[0] = water.density;
    w->setup.phase_viscosity[0] = water.viscosity;
    return mps__models_preset(&w->models, "imps");
}

mps_status mps_sim_create(const mps_config *config, mps_sim **sim)
{
    if (!sim) return MPS_E_ARG;
    *sim = NULL;
    mps__context c = {.allocator = mps__allocator_default()};
    mps_config f = config_default;
    mps_status status = mps__struct_in(&c, "mps_config", &f, sizeof f, config);
    /* not copied, but has a buffer for the error text */
    if (status < 0 && config && config->struct_size >= offsetof(mps_config, parallel)) {
        f.error = config->error;
        f.error_size = config->error_size;
    }
    if (status == MPS_OK) status = check_config(&c, &f);
    if (status == MPS_OK && f.allocator.alloc) c.allocator = f.allocator;
    mps_sim *s = status == MPS_OK ? mps__alloc(&c, 1, sizeof *s) : NULL;
    if (status == MPS_OK && !s) status = MPS_E_NOMEM;
    if (s) {
        s->context = c;
        s->context.log = f.log;
        s->context.log_user = f.log_user;
        status = set_up(s, &f);
        if (status == MPS_OK) {
            *sim = s;
            return MPS_OK;
        }
        c = s->context;
        mps_sim_destroy(s);
    }
    if (config && f.error && f.error_size > 0) snprintf(f.error, f.error_size, "%s", c.error);
    return status;
}

void mps_sim_destroy(mps_sim *sim)
{
    if (!sim) return;
    if (sim->context.lock.level > MPS__UNLOCKED) {
        mps__fail(&sim->context, MPS_E_BUSY,
                  "mps_sim_destroy() was called from %s, and does nothing there: call it when the "
                  "call of the library that is in progress has returned",
                  sim->context.lock.what);
        mps__log(&sim->context, MPS_LOG_WARNING, "%s", sim->context.error);
        return;
    }
    /* the destroy functions of plug-ins run under this lock */
    mps__lock_set(&sim->context, MPS__LOCKED, "mps_sim_destroy()");
    mps__context c = sim->context;
    mps__probes_free(&sim->context, &sim->probes);
    for (int32_t k = 0; k < sim->solids; k++) mps__distances_free(&sim->solid[k], &c);
    mps__free(&c, sim->solid);
    mps__world_free(&sim->world);
    mps__free(&c, sim);
}

const char *mps_sim_error(const mps_sim *sim)
{
    return sim ? sim->context.error : "the simulation is NULL";
}

mps_status mps_sim_shape(const mps_sim *sim, int32_t *dim, double *dp)
{
    if (!sim) return MPS_E_ARG;
    if (dim) *dim = sim->world.setup.dim;
    if (dp) *dp = sim->world.setup.dp;
    return MPS_OK;
}

mps_status mps_sim_time(const mps_sim *sim, double *t, int64_t *steps)
{
    if (!sim) return MPS_E_ARG;
    if (t) *t = sim->world.state.t;
    if (steps) *steps = sim->world.state.step;
    return MPS_OK;
}

mps_status mps_threads_set(mps_sim *sim, int32_t threads)
{
    MPS__SETS(sim);
    MPS__CHECK(&sim->context, threads >= 1 && threads <= MPS__THREADS_MOST, "threads is %d: 1..%d",
               threads, MPS__THREADS_MOST);
    mps__pool_resize(&sim->world.pool, threads);
    sim->world.threads = threads;
    return MPS_OK;
}

/* Set the density of a phase's particles; the field is not changed if all have this density
 * already. */
static mps_status set_density(mps__world *w, int32_t phase, double density)
{
    mps__particles *s = &w->particles;
    bool differs = false;
    MPS__TRY(mps__world_fetch_field(w, MPS__FIELD_DENSITY));
    for (int64_t i = 0; i < s->n; i++)
        differs = differs || (s->phase[i] == phase && s->rho[i] != density);
    if (!differs) return MPS_OK;
    MPS__TRY(mps__world_write_field(w, MPS__FIELD_DENSITY));
    for (int64_t i = 0; i < s->n; i++)
        if (s->phase[i] == phase) s->rho[i] = density;
    return MPS_OK;
}

mps_status mps_phase_set(mps_sim *sim, int32_t index, const mps_phase *phase)
{
    MPS__SETS(sim);
    mps_phase p = water;
    MPS__CHECK(&sim->context, index >= 0 && index < MPS__PHASES, "phase index is %d: 0..%d", index,
               MPS__PHASES - 1);
    MPS__TRY(mps__struct_in(&sim->context, "mps_phase", &p, sizeof p, phase));
    MPS__CHECK(&sim->context, p.density > 0 && isfinite(p.density),
               "phase %d: density is %g: must be > 0 kg/m3, finite", index, p.density);
    MPS__CHECK(&sim->context, p.viscosity >= 0 && isfinite(p.viscosity),
               "phase %d: viscosity is %g: must be >= 0 Pa s, finite", index, p.viscosity);
    mps__world *w = &sim->world;
    if (mps__particles_leases(&w->particles))
        return mps__fail(&sim->context, MPS_E_BUSY, "a lease is open");
    MPS__TRY(set_density(w, index, p.density));
    w->setup.phase_defined[index] = true;
    w->setup.phase_density[index] = p.density;
    w->setup.phase_viscosity[index] = p.viscosity;
    return MPS_OK;
}

mps_status mps_phase_get(const mps_sim *sim, int32_t index, mps_phase *phase)
{
    if (!sim) return MPS_E_ARG;
    mps__context *c = mps__sim_context(sim);
    MPS__CHECK(c, index >= 0 && index < MPS__PHASES && sim->world.setup.phase_defined[index],
               "phase %d is not defined: call mps_phase_set() first", index);
    mps_phase p = water;
    p.density = sim->world.setup.phase_density[index];
    p.viscosity = sim->world.setup.phase_viscosity[index];
    return mps__struct_out(c, "mps_phase", phase, &p, sizeof p);
}

static mps_status check_pair(mps__context *c, const mps__world *w, int32_t a, int32_t b)
{
    const int32_t both[2] = {a, b};
    for (int k = 0; k < 2; k++)
        MPS__CHECK(c, both[k] >= 0 && both[k] < MPS__PHASES && w->setup.phase_defined[both[k]],
                   "phase %d is not defined: call mps_phase_set() first", both[k]);
    MPS__CHECK(c, a != b, "surface tension of phase %d with itself: the phases must differ", a);
    return MPS_OK;
}

mps_status mps_tension_set(mps_sim *sim, int32_t a, int32_t b, double sigma)
{
    MPS__SETS(sim);
    mps__world *w = &sim->world;
    MPS__TRY(check_pair(&sim->context, w, a, b));
    MPS__CHECK(&sim->context, sigma >= 0 && isfinite(sigma),
               "surface tension of phases %d and %d is %g: must be >= 0 N/m, finite", a, b, sigma);
    w->setup.tension[a * MPS__PHASES + b] = w->setup.tension[b * MPS__PHASES + a] = sigma;
    return MPS_OK;
}

mps_status mps_tension_get(const mps_sim *sim, int32_t a, int32_t b, double *sigma)
{
    if (!sim) return MPS_E_ARG;
    mps__context *c = mps__sim_context(sim);
    MPS__TRY(check_pair(c, &sim->world, a, b));
    MPS__CHECK(c, sigma, "sigma is NULL");
    const double value = sim->world.setup.tension[a * MPS__PHASES + b];
    MPS__CHECK(c, value >= 0, "surface tension of phases %d and %d was never set", a, b);
    *sigma = value;
    return MPS_OK;
}

/* ---- models ---- */

mps_status mps_model_register(mps_sim *sim, const mps_model_ops *ops)
{
    MPS__SETS(sim);
    return mps__models_register(&sim->world.models, ops);
}

mps_status mps_preset_use(mps_sim *sim, const char *name)
{
    MPS__SETS(sim);
    return mps__models_preset(&sim->world.models, name);
}

mps_status mps_model_use(mps_sim *sim, const char *name)
{
    MPS__SETS(sim);
    return mps__models_use(&sim->world.models, name);
}

mps_status mps_model_remove(mps_sim *sim, const char *slot)
{
    MPS__SETS(sim);
    return mps__models_remove(&sim->world.models, slot);
}

mps_status mps_model_set(mps_sim *sim, const char *slot, const char *key, double value)
{
    MPS__SETS(sim);
    const mps_setting *s = NULL;
    double *place = mps__models_value(&sim->world.models, slot, key, &s);
    if (!place) return MPS_E_NAME;
    MPS__CHECK(&sim->context, value >= s->min && value <= s->max, "%s.%s is %g: allowed %g..%g",
               slot, key, value, s->min, s->max);
    MPS__CHECK(&sim->context, s->type == MPS_TYPE_REAL || value == floor(value),
               "%s.%s is %g: must be a whole number, %g..%g", slot, key, value, s->min, s->max);
    *place = value;
    return MPS_OK;
}

mps_status mps_model_get(const mps_sim *sim, const char *slot, const char *key, double *value)
{
    if (!sim) return MPS_E_ARG;
    MPS__CHECK(mps__sim_context(sim), value, "value is NULL");
    const double *place = mps__models_value((mps__models *)&sim->world.models, slot, key, NULL);
    if (!place) return MPS_E_NAME;
    *value = *place;
    return MPS_OK;
}

mps_status mps_model_state(const mps_sim *sim, const char *slot, const double **values,
                           int64_t *count)
{
    const mps__numbers *state = NULL;
    MPS__READS(sim);
    MPS__CHECK(mps__sim_context(sim), values && count, "values or count is NULL");
    MPS__TRY(mps__models_state((mps__models *)&sim->world.models, slot, &state));
    *values = state->count > 0 ? state->value : NULL;
    *count = state->count;
    return MPS_OK;
}

const char *mps_model_name(const mps_sim *sim, int32_t index)
{
    return sim && index >= 0 && index < sim->world.models.active
               ? sim->world.models.on[index].ops->name
               : NULL;
}

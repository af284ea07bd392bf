/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of stepping, and the stencil of a simulation. */
#include "step.h"
#include "kernel.h"
#include "sim.h"
#include "world_ranks.h"
#include <math.h>

static const mps_time_control control_default = {.struct_size = sizeof(mps_time_control),
                                                 .cfl = 0.3,
                                                 .gravity = 0.06,
                                                 .viscous = 0.2,
                                                 .growth = 1.1};
static const mps_step_info info_default = {.struct_size = sizeof(mps_step_info)};

mps_status mps_time_control_init(mps_time_control *control, size_t size)
{
    return mps__struct_init("mps_time_control", control, size, &control_default,
                            sizeof control_default);
}

mps_status mps_step_info_init(mps_step_info *info, size_t size)
{
    return mps__struct_init("mps_step_info", info, size, &info_default, sizeof info_default);
}

static mps_status check_limits(mps__context *c, const mps_time_control *t)
{
    const double value[] = {t->cfl, t->gravity, t->viscous, t->dt_max};
    static const char *const name[] = {"cfl", "gravity", "viscous", "dt_max"};
    for (int k = 0; k < 4; k++)
        MPS__CHECK(c, !isnan(value[k]),
                   "time_control.%s is %g: must be a number, <= 0 for no limit", name[k], value[k]);
    MPS__CHECK(c, t->dt > 0 || t->cfl > 0 || t->gravity > 0 || t->dt_max > 0,
               "time_control: cfl %g, gravity %g and dt_max %g are all off; one must be > 0",
               t->cfl, t->gravity, t->dt_max);
    return MPS_OK;
}

mps_status mps_time_control_set(mps_sim *sim, const mps_time_control *control)
{
    MPS__SETS(sim);
    mps__context *c = &sim->context;
    mps_time_control t = control_default;
    MPS__TRY(mps__struct_in(c, "mps_time_control", &t, sizeof t, control));
    MPS__CHECK(c, t.dt >= 0 && isfinite(t.dt),
               "time_control.dt is %g s: > 0, or 0 for an adaptive step", t.dt);
    MPS__TRY(check_limits(c, &t));
    MPS__CHECK(c, t.growth < 0 || t.growth > 1, "time_control.growth is %g: > 1, or < 0 for none",
               t.growth);
    MPS__CHECK(c, t.dt_min >= 0 && isfinite(t.dt_min), "time_control.dt_min is %g s: >= 0",
               t.dt_min);
    if (t.dt_min == 0) t.dt_min = 1e-9 * sqrt(sim->world.setup.dp / 9.81);
    sim->world.setup.control = t;
    sim->world.state.dt_previous = 0;
    return MPS_OK;
}

static mps_status ready(mps_sim *sim)
{
    const int32_t open = mps__particles_leases(&sim->world.particles);
    return open ? mps__fail(&sim->context, MPS_E_BUSY,
                            "%d lease(s) are open; end them before stepping", open)
                : MPS_OK;
}

mps_status mps_step(mps_sim *sim, double dt_max, mps_step_info *info)
{
    MPS__STEPS(sim);
    MPS__CHECK(&sim->context, dt_max > 0 && isfinite(dt_max),
               "dt_max is %g s: must be > 0 and finite", dt_max);
    mps_step_info probe = info_default;
    if (info) MPS__TRY(mps__struct_in(&sim->context, "mps_step_info", &probe, sizeof probe, info));
    MPS__TRY(ready(sim));
    /* allocate before the step: an out-of-memory error leaves no step incomplete */
    MPS__TRY(mps__ranks_report(&sim->world.ranks, mps__probes_take(&sim->world, &sim->probes)));
    const mps__lock before = mps__lock_set(&sim->context, MPS__LOCKED, "a callback in a step");
    mps_status status = mps__ranks_report(&sim->world.ranks, mps__world_step(&sim->world, dt_max));
    sim->context.lock = before;
    if (status >= 0 && info)
        MPS__TRY(mps__struct_out(&sim->context, "mps_step_info", info, &sim->world.info,
                                 sizeof sim->world.info));
    return status;
}

/* Times within this difference are equal: programs add up step lengths, which rounds. */
static double rounding_of(double t)
{
    return 1e-12 * fmax(1.0, fabs(t));
}

mps_status mps_run(mps_sim *sim, double t_end, mps_monitor_fn monitor, void *user)
{
    MPS__STEPS(sim);
    mps__world *w = &sim->world;
    const double small = rounding_of(t_end);
    MPS__CHECK(&sim->context, isfinite(t_end) && t_end >= w->state.t - small,
               "t_end is %.17g s: must be finite and not before the present time %.17g s", t_end,
               w->state.t);
    mps_status result = MPS_OK;
    while (t_end - w->state.t > small) {
        w->ending = true;
        const mps_status status = mps_step(sim, t_end - w->state.t, NULL);
        w->ending = false;
        if (status < 0) return status;
        if (status > 0) result = status;
        if (fabs(t_end - w->state.t) <= fmax(small, 1e-6 * w->info.dt))
            w->state.t = w->info.t = t_end;
        const mps__lock before = mps__lock_set(&sim->context, MPS__READ_ONLY, "a monitor");
        bool stop = monitor && monitor(user, sim, &w->info);
        sim->context.lock = before;
        mps__world_any(w, 1, &stop); /* a monitor of any rank stops all */
        MPS__TRY(mps__ranks_status(&w->ranks));
        if (stop) return MPS_W_STOPPED;
    }
    w->state.t = t_end; /* also without a step: otherwise a loop up to this time would not end */
    return result;
}

mps_status mps_step_info_get(mps_sim *sim, mps_step_info *info)
{
    MPS__MEASURES(sim);
    return mps__struct_out(&sim->context, "mps_step_info", info, &sim->world.info,
                           sizeof sim->world.info);
}

mps_status mps_stencil_get(mps_sim *sim, int32_t which, mps_stencil *stencil)
{
    mps_stencil view;
    MPS__MEASURES(sim);
    MPS__TRY(mps__struct_check(&sim->context, "mps_stencil", stencil));
    MPS__CHECK(&sim->context, which == MPS_NEAR || which == MPS_FAR,
               "which is %d: must be MPS_NEAR (0) or MPS_FAR (1)", which);
    const mps__field *x = mps__particles_field(&sim->world.particles, "position");
    if (x->writer) return mps__fail(&sim->context, MPS_E_BUSY, "positions are leased for writing");
    const mps__lock before = mps__lock_set(&sim->context, MPS__LOCKED, "a kernel");
    mps_status status = mps__particles_leases(&sim->world.particles)
                            ? mps__world_neighbours_kept(&sim->world)
                            : mps__world_neighbours(&sim->world);
    if (status == MPS_OK) status = mps__world_stencil_all(&sim->world, which, &view);
    sim->context.lock = before;
    MPS__TRY(status);
    return mps__struct_out(&sim->context, "mps_stencil", stencil, &view, sizeof view);
}

mps_status mps_kernel_use(mps_sim *sim, const mps_kernel *kernel)
{
    MPS__SETS(sim);
    mps__context *c = &sim->context;
    const mps__setup *setup = &sim->world.setup;
    mps_kernel k = {0};
    double n0;
    MPS__TRY(mps__struct_in(c, "mps_kernel", &k, sizeof k, kernel));
    if (sim->world.state.step > 0)
        return mps__fail(c, MPS_E_STATE, "the kernel cannot change after the first step");
    const mps__lock before = mps__lock_set(c, MPS__LOCKED, "a kernel");
    const mps_status status = mps__kernel_lattice(c, &k, setup->dim, setup->dp, setup->re_near, &n0,
                                                  NULL);
    c->lock = before;
    MPS__TRY(status);
    k.struct_size = sizeof k;
    sim->world.setup.kernel = k;
    return MPS_OK;
}

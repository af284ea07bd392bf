/* SPDX-License-Identifier: BSD-3-Clause */
/* Stepping of the public interface, and the stencil of a simulation. */
#include "sim.h"
#include <math.h>

static const mps_time_control control_default = {
    .struct_size = sizeof(mps_time_control), .cfl = 0.3, .gravity = 0.06, .viscous = 0.2, .growth = 1.1};
static const mps_step_info info_default = {.struct_size = sizeof(mps_step_info)};

mps_status mps_time_control_init(mps_time_control *control, size_t size)
{
    return mps__struct_init(control, size, &control_default, sizeof control_default);
}

mps_status mps_step_info_init(mps_step_info *info, size_t size)
{
    return mps__struct_init(info, size, &info_default, sizeof info_default);
}

static mps_status check_limits(mps__context *c, const mps_time_control *t)
{
    const double value[] = {t->cfl, t->gravity, t->viscous, t->dt_max};
    static const char *const name[] = {"cfl", "gravity", "viscous", "dt_max"};
    for (int k = 0; k < 4; k++)
        MPS__CHECK(c, !isnan(value[k]), "time_control.%s is %g: must be a number, <= 0 for no limit", name[k], value[k]);
    MPS__CHECK(c, t->dt > 0 || t->cfl > 0 || t->gravity > 0 || t->dt_max > 0,
               "time_control: cfl %g, gravity %g and dt_max %g are all off; one must be > 0", t->cfl, t->gravity, t->dt_max);
    return MPS_OK;
}

mps_status mps_sim_set_time_control(mps_sim *sim, const mps_time_control *control)
{
    MPS__CHANGES(sim);
    mps__context *c = &sim->context;
    mps_time_control t = control_default;
    MPS__TRY(mps__struct_in(c, "mps_time_control", &t, sizeof t, control));
    MPS__CHECK(c, t.dt >= 0 && isfinite(t.dt), "time_control.dt is %g s: > 0, or 0 for an adaptive step", t.dt);
    MPS__TRY(check_limits(c, &t));
    MPS__CHECK(c, t.growth < 0 || t.growth > 1, "time_control.growth is %g: > 1, or < 0 for none", t.growth);
    MPS__CHECK(c, t.dt_min >= 0 && isfinite(t.dt_min), "time_control.dt_min is %g s: >= 0", t.dt_min);
    if (t.dt_min == 0) t.dt_min = 1e-9 * sqrt(sim->world.setup.dp / 9.81);
    sim->world.setup.control = t;
    sim->world.state.dt_previous = 0;
    return MPS_OK;
}

static mps_status ready(mps_sim *sim)
{
    const int32_t open = mps__particles_leases(&sim->world.particles);
    return open ? mps__fail(&sim->context, MPS_E_BUSY, "%d lease(s) are open; end them before stepping", open) : MPS_OK;
}

mps_status mps_step(mps_sim *sim, double dt_max, mps_step_info *info)
{
    MPS__CHANGES(sim);
    MPS__CHECK(&sim->context, dt_max > 0 && isfinite(dt_max), "dt_max is %g s: must be > 0 and finite", dt_max);
    mps_step_info probe = info_default;
    if (info) MPS__TRY(mps__struct_in(&sim->context, "mps_step_info", &probe, sizeof probe, info));
    MPS__TRY(ready(sim));
    /* before the step, not after it: what runs out of memory here leaves no step half done */
    MPS__TRY(mps__probes_take(&sim->world, &sim->probes));
    const mps__lock before = mps__lock_set(&sim->context, MPS__LOCKED, "a callback in a step");
    mps_status status = mps__world_step(&sim->world, dt_max);
    sim->context.lock = before;
    if (status >= 0 && info) MPS__TRY(mps__struct_out(&sim->context, "mps_step_info", info, &sim->world.info, sizeof sim->world.info));
    return status;
}

mps_status mps_run(mps_sim *sim, double t_end, mps_monitor_fn monitor, void *user)
{
    MPS__CHANGES(sim);
    mps__world *w = &sim->world;
    MPS__CHECK(&sim->context, isfinite(t_end) && t_end >= w->state.t, "t_end is %g s: must be finite and not before the present time %g s",
               t_end, w->state.t);
    mps_status result = MPS_OK;
    const double small = 1e-12 * fmax(1.0, fabs(t_end));
    while (t_end - w->state.t > small) {
        w->ending = true;
        const mps_status status = mps_step(sim, t_end - w->state.t, NULL);
        w->ending = false;
        if (status < 0) return status;
        if (status > 0) result = status;
        if (fabs(t_end - w->state.t) <= fmax(small, 1e-6 * w->info.dt)) w->state.t = w->info.t = t_end;
        const mps__lock before = mps__lock_set(&sim->context, MPS__READ_ONLY, "a monitor");
        const int stop = monitor && monitor(user, sim, &w->info);
        sim->context.lock = before;
        if (stop) return MPS_W_STOPPED;
    }
    return result;
}

mps_status mps_sim_stencil(mps_sim *sim, int32_t which, mps_stencil *stencil)
{
    MPS__READS(sim);
    MPS__CHECK(&sim->context, stencil && (which == MPS_NEAR || which == MPS_FAR), "stencil is NULL, or which is %d: MPS_NEAR or MPS_FAR",
               which);
    const mps__field *x = mps__particles_field(&sim->world.particles, "position");
    if (x->writer) return mps__fail(&sim->context, MPS_E_BUSY, "positions are leased for writing");
    MPS__TRY(mps__particles_leases(&sim->world.particles) ? mps__world_neighbours_kept(&sim->world) : mps__world_neighbours(&sim->world));
    return mps__world_stencil_all(&sim->world, which, stencil);
}

/* Why the kernel has no lattice constants. */
static mps_status bad_kernel(mps_sim *sim, const mps_kernel *kernel)
{
    const mps__world *w = &sim->world;
    const int reach = (int)(w->setup.re_near / w->setup.dp) + 1;
    const int most = w->setup.dim * reach * reach;
    MPS__CHECK(&sim->context, kernel->id >= MPS_KERNEL_IMPROVED && kernel->id <= MPS_KERNEL_CUSTOM,
               "kernel.id is %d: fill it with mps_kernel_find() or mps_kernel_custom()", kernel->id);
    MPS__CHECK(&sim->context, kernel->id != MPS_KERNEL_CUSTOM || kernel->fn, "kernel.fn is NULL: fill it with mps_kernel_custom()");
    for (int square = 1; square <= most; square++) { /* more than the distances of a lattice: the first bad one is named */
        const double r = w->setup.dp * sqrt(square), value = mps_kernel_value(kernel, r, w->setup.re_near);
        MPS__CHECK(&sim->context, value >= 0 && isfinite(value), "the kernel is %g at r = %g m of re = %g m: must be >= 0 and finite",
                   value, r, w->setup.re_near);
    }
    return mps__fail(&sim->context, MPS_E_ARG, "the kernel is 0 at all distances of a lattice of %g m within re = %g m", w->setup.dp, w->setup.re_near);
}

mps_status mps_sim_set_kernel(mps_sim *sim, const mps_kernel *kernel)
{
    MPS__CHANGES(sim);
    MPS__CHECK(&sim->context, kernel, "kernel is NULL");
    if (sim->world.state.step > 0) return mps__fail(&sim->context, MPS_E_STATE, "the kernel cannot change after the first step");
    double n0;
    mps_status status = mps_lattice_constants(kernel, sim->world.setup.dim, sim->world.setup.dp, sim->world.setup.re_near, &n0, NULL);
    if (status != MPS_OK) return bad_kernel(sim, kernel);
    sim->world.setup.kernel = *kernel;
    return MPS_OK;
}

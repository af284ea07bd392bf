/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of mps/couple.h for the load on the tank. */
#include "sim.h"
#include <mps/couple.h>
#include <string.h>

static const mps_load load_default = {.struct_size = sizeof(mps_load)};

mps_status mps_load_init(mps_load *load, size_t size)
{
    return mps__struct_init("mps_load", load, size, &load_default, sizeof load_default);
}

mps_status mps_load_watch(mps_sim *sim, int32_t what)
{
    MPS__SETS(sim);
    mps__world *w = &sim->world;
    MPS__CHECK(w->context, what >= MPS_LOAD_NONE && what <= MPS_LOAD_MASS,
               "mps_load_watch(): what is %d: must be MPS_LOAD_NONE (0), MPS_LOAD_FORCE (1) or "
               "MPS_LOAD_MASS (2)",
               (int)what);
    const int32_t open = mps__particles_leases(&w->particles);
    if (open)
        return mps__fail(w->context, MPS_E_BUSY,
                         "%d lease(s) are open; end them before mps_load_watch()", open);
    if (what == MPS_LOAD_MASS) MPS__TRY(mps__ranks_report(&w->ranks, mps__world_add_guess(w)));
    w->load.watch = what;
    if (what == MPS_LOAD_NONE) w->load.known = false;
    return MPS_OK;
}

/* Transform accelerations and moments to another point at distance r: its acceleration is a + alpha
 * x r + ..., where terms without a derivative of the velocity belong to the rest. */
static void move(const mps__load *l, const double r[3], mps_load *out)
{
    double T[36] = {0}, arm[3]; /* maps accelerations at the new point to the known one */
    for (int k = 0; k < 6; k++) T[7 * k] = 1;
    for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, f = (d + 2) % 3; /* a_known = a_new - alpha x r */
        T[6 * d + 3 + e] = -r[f];
        T[6 * d + 3 + f] = r[e];
    }
    mps__cross(r, l->force, arm);
    memcpy(out->force, l->force, sizeof out->force);
    memcpy(out->acceleration, l->accel, sizeof out->acceleration);
    for (int d = 0; d < 3; d++) {
        out->force[3 + d] -= arm[d];
        for (int k = 3; k < 6; k++) out->acceleration[d] -= T[6 * d + k] * l->accel[k];
    }
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            for (int k = 0; k < 36; k++)
                out->mass[6 * i + j] += T[6 * (k / 6) + i] * l->mass[k] * T[6 * (k % 6) + j];
}

mps_status mps_load_get(mps_sim *sim, const double *centre, mps_load *load)
{
    MPS__READS(sim);
    mps__world *w = &sim->world;
    const mps__load *l = &w->load;
    mps_load out = load_default;
    double at[3] = {0}, r[3];
    MPS__TRY(mps__struct_check(w->context, "mps_load", load));
    MPS__CHECK(w->context, !centre || mps__finite(centre, w->setup.dim),
               "mps_load_get(): the centre is not finite");
    if (!l->known)
        return mps__fail(w->context, MPS_E_STATE,
                         "mps_load_get(): the load of the last step is not known: call "
                         "mps_load_watch() with MPS_LOAD_FORCE or MPS_LOAD_MASS before the step");
    mps__motion_point(&w->motion, &w->state.before, centre ? centre : w->motion.centre, at, NULL,
                      NULL);
    for (int d = 0; d < 3; d++) r[d] = d < w->setup.dim ? at[d] - l->at[d] : 0;
    move(l, r, &out);
    out.dt = l->dt;
    out.iterations = l->iterations;
    out.has_mass = l->has_mass;
    for (int i = 0; i < 6 && l->has_mass; i++) {
        out.rest[i] = out.force[i];
        for (int j = 0; j < 6; j++) out.rest[i] += out.mass[6 * i + j] * out.acceleration[j];
    }
    return mps__struct_out(w->context, "mps_load", load, &out, sizeof out);
}

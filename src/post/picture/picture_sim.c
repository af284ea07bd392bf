/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes of a simulation, by leases. */
#include "picture_scene.h"
#include <math.h>
#include <mps/mps.h>
#include <string.h>

enum { LEASES = 6 };
typedef enum leased { POSITION, PRESSURE, VELOCITY, KIND, PHASE, PLATE } leased;
static const char *const field[LEASES] = {"position", "pressure", "velocity",
                                          "kind",     "phase",    "plate"};

mps_status mps__scene_pose(mps_sim *sim, int32_t dim, film_pose *out)
{
    const double origin[3] = {0, 0, 0};
    mps_motion_state state;
    mps_motion_pose pose;
    mps_motion_state_init(&state, sizeof state);
    mps_motion_pose_init(&pose, sizeof pose);
    *out = (film_pose){{0}, {0}};
    mps_status status = mps_motion_state_get(sim, &state);
    if (status == MPS_OK) status = mps_motion_pose_from_state(&state, &pose);
    if (status == MPS_OK) status = mps_motion_to_lab(sim, origin, out->shift, NULL);
    if (dim == 2) out->shift[2] = 0;
    memcpy(out->turn, pose.rotation, sizeof out->turn);
    return status;
}

/* Dummies are not drawn: those of thin plates are in the liquid on the other side. */
static bool is_drawn(const mps_lease *l, int64_t i)
{
    return l[KIND].integers[i] == MPS_FLUID || l[KIND].integers[i] == MPS_WALL;
}

static void take_particle(scene *s, const mps_lease *l, int64_t i, int64_t to)
{
    double x[3] = {0, 0, 0}, u2 = 0, X[3];
    /* rounded to single precision as in frames, so that a picture of the state equals that of its
     * frame */
    for (int32_t d = 0; d < s->dim; d++) x[d] = (double)(float)l[POSITION].data[i * s->dim + d];
    mps__film_to_tank(&s->pose, x, X);
    for (int d = 0; d < 3; d++) s->x[3 * to + d] = (float)X[d];
    s->p[to] = (float)l[PRESSURE].data[i];
    s->kind[to] = l[KIND].integers[i] == MPS_FLUID ? SCENE_FLUID : SCENE_WALL;
    s->phase[to] = (uint8_t)l[PHASE].integers[i];
    if (s->kind[to] != SCENE_FLUID) return;
    for (int32_t d = 0; d < s->dim; d++)
        u2 += l[VELOCITY].data[i * s->dim + d] * l[VELOCITY].data[i * s->dim + d];
    s->speed2 = fmax(s->speed2, u2);
}

static mps_status take_particles(scene *s, const mps_lease *l, page_errors *e)
{
    int64_t n = 0;
    for (int64_t i = 0; i < l[KIND].count; i++) n += is_drawn(l, i);
    if (!mps__scene_reserve(s, n)) return mps__page_fail(e, MPS_E_NOMEM, "no memory for a picture");
    n = 0;
    for (int64_t i = 0; i < l[KIND].count; i++)
        if (is_drawn(l, i)) take_particle(s, l, i, n++);
    return MPS_OK;
}

static mps_status lease_all(scene *s, mps_sim *sim, page_errors *e)
{
    mps_lease lease[LEASES];
    int count = 0;
    mps_status status = MPS_OK;
    for (; status == MPS_OK && count < LEASES; count += status == MPS_OK) {
        mps_lease_init(&lease[count], sizeof lease[count]);
        status = mps_lease_begin(sim, field[count], MPS_READ, &lease[count]);
    }
    if (status != MPS_OK)
        mps__page_fail(e, status, "no picture: %s", mps_sim_error(sim));
    else
        status = take_particles(s, lease, e);
    while (count > 0) mps_lease_end(sim, &lease[--count]);
    return status;
}

/* Ids of probes continue after removals: the last id is not known, so all small ones are tried. */
static mps_status take_probes(scene *s, const mps_sim *sim, page_errors *e)
{
    enum { MISSES = 64 };
    mps_probe_info info;
    for (int32_t id = 0, misses = 0; misses < MISSES; id++) {
        mps_probe_info_init(&info, sizeof info);
        if (mps_probe_size(sim, id) < 0) {
            misses++;
            continue;
        }
        misses = 0;
        if (mps_probe_info_get(sim, id, &info) != MPS_OK || !info.name[0] ||
            info.type == MPS_PROBE_FORCE)
            continue;
        scene_sensor *own = mps__scene_sensor(s, info.name);
        if (!own) return mps__page_fail(e, MPS_E_NOMEM, "no memory for a picture");
        own->gauge = info.type == MPS_PROBE_GAUGE;
        memcpy(own->at, info.at, sizeof own->at);
        if (info.type == MPS_PROBE_WALL_PRESSURE)
            memcpy(own->normal, info.normal, sizeof own->normal);
    }
    return MPS_OK;
}

mps_status mps__scene_of_sim(scene *s, mps_sim *sim, page_errors *e)
{
    mps_phase phase;
    *s = (scene){.run_lo = {1, 1, 1}};
    if (mps_sim_shape(sim, &s->dim, &s->dp) != MPS_OK || mps_sim_time(sim, &s->t, NULL) != MPS_OK)
        return mps__page_fail(e, MPS_E_ARG, "no picture: the simulation is NULL");
    for (int32_t k = 0; k < SCENE_PHASES; k++) {
        mps_phase_init(&phase, sizeof phase);
        if (mps_phase_get(sim, k, &phase) == MPS_OK) s->density[k] = phase.density;
    }
    mps_status status = mps__scene_pose(sim, s->dim, &s->pose);
    if (status != MPS_OK) return mps__page_fail(e, status, "no picture: %s", mps_sim_error(sim));
    status = lease_all(s, sim, e);
    if (status == MPS_OK) status = take_probes(s, sim, e);
    return status;
}

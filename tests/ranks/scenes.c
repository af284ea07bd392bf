/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes whose bytes do not depend on the number of ranks. */
#include "scenes.h"
#include "ppe/builtin.h"
#include "sim.h"
#include <stdio.h>
#include <string.h>

/* Polynomials alone: sines of C libraries differ in the last digit. */
static int sway(void *user, double t, mps_motion_state *state)
{
    (void)user;
    state->value[MPS_MOVE_X] = 1.5 * t * t;
    state->rate[MPS_MOVE_X] = 3 * t;
    state->accel[MPS_MOVE_X] = 3;
    return 0;
}

static int roll(void *user, double t, mps_motion_state *state)
{
    (void)user;
    state->value[MPS_ROTATE_Z] = 2 * t * t;
    state->rate[MPS_ROTATE_Z] = 4 * t;
    state->accel[MPS_ROTATE_Z] = 4;
    return 0;
}

/* A tank that sways while it travels with the liquid, by its length in a few steps. */
static int travel(void *user, double t, mps_motion_state *state)
{
    sway(user, t, state);
    state->value[MPS_MOVE_X] += 100 * t;
    state->rate[MPS_MOVE_X] += 100;
    return 0;
}

const scene scenes[SCENES] = {
    {.name = "dam_2d", .preset = "imps", .dim = 2, .steps = 60, .dp = 0.02},
    {.name = "dam_3d", .preset = "imps", .dim = 3, .steps = 20, .dp = 0.05},
    {.name = "surge_2d", .preset = "imps", .dim = 2, .steps = 60, .dp = 0.02, .motion = sway},
    {.name = "roll_2d", .preset = "imps", .dim = 2, .steps = 60, .dp = 0.02, .motion = roll},
    {.name = "changes_2d", .preset = "imps", .dim = 2, .steps = 40, .dp = 0.02, .changes = true},
    {.name = "fast_2d", .preset = "imps", .dim = 2, .steps = 30, .dp = 0.02, .fast = true},
    {.name = "baffle_2d", .preset = "imps", .dim = 2, .steps = 150, .dp = 0.02, .baffle = 1},
    {.name = "plate_2d",
     .preset = "imps",
     .dim = 2,
     .steps = 120,
     .dp = 0.02,
     .motion = roll,
     .baffle = 2},
    {.name = "plate_3d", .preset = "imps", .dim = 3, .steps = 25, .dp = 0.05, .baffle = 2},
    {.name = "air_2d",
     .preset = "mmps",
     .dim = 2,
     .steps = 40,
     .dp = 0.025,
     .motion = sway,
     .sigma = 0.07},
    {.name = "air_3d", .preset = "mmps", .dim = 3, .steps = 8, .dp = 0.06, .sigma = 0.07},
    {.name = "dam_2d_jacobi",
     .preset = "imps",
     .dim = 2,
     .steps = 30,
     .dp = 0.02,
     .preconditioner = "jacobi"},
    {.name = "dam_3d_divided",
     .preset = "imps",
     .dim = 3,
     .steps = 12,
     .dp = 0.05,
     .preconditioner = "divided"},
    {.name = "roll_2d_divided",
     .preset = "imps",
     .dim = 2,
     .steps = 40,
     .dp = 0.02,
     .motion = roll,
     .preconditioner = "divided"},
    {.name = "air_2d_divided",
     .preset = "mmps",
     .dim = 2,
     .steps = 20,
     .dp = 0.025,
     .motion = sway,
     .preconditioner = "divided"},
    {.name = "air_2d_jacobi",
     .preset = "mmps",
     .dim = 2,
     .steps = 12,
     .dp = 0.025,
     .preconditioner = "jacobi"},
    {.name = "drop_2d", .preset = "imps", .dim = 2, .steps = 60, .dp = 0.02, .drop = true},
    {.name = "drop_air_2d",
     .preset = "mmps",
     .dim = 2,
     .steps = 20,
     .dp = 0.025,
     .sigma = 0.07,
     .drop = true},
    {.name = "paper_2d", .preset = "imps.paper", .dim = 2, .steps = 40, .dp = 0.025},
    {.name = "paper_air_2d",
     .preset = "mmps.paper",
     .dim = 2,
     .steps = 20,
     .dp = 0.025,
     .sigma = 0.07},
    {.name = "gas_2d",
     .preset = "imps",
     .dim = 2,
     .steps = 60,
     .dp = 0.02,
     .motion = roll,
     .gas = true},
    {.name = "gas_3d", .preset = "imps", .dim = 3, .steps = 15, .dp = 0.05, .gas = true},
    {.name = "travel_2d", .preset = "imps", .dim = 2, .steps = 10, .dp = 0.02, .motion = travel},
    {.name = "travel_2d_divided",
     .preset = "imps",
     .dim = 2,
     .steps = 10,
     .dp = 0.02,
     .motion = travel,
     .preconditioner = "divided"},
    {.name = "travel_3d_divided",
     .preset = "imps",
     .dim = 3,
     .steps = 5,
     .dp = 0.05,
     .motion = travel,
     .preconditioner = "divided"},
};

mps_status scene_create(const scene *s, mps_sim **sim)
{
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dim = s->dim;
    config.dp = s->dp;
    config.threads = s->threads > 0 ? s->threads : 1;
    return mps_sim_create(&config, sim);
}

/* Under the name "divided": auxgrid that divides all grids but the last, as it does with large
 * ones. */
static mps_status register_divided(mps_sim *sim)
{
    static int64_t whole = 1;
    mps_preconditioner_ops ops = mps__preconditioner_auxgrid;
    ops.name = "divided";
    ops.user = &whole;
    return mps_preconditioner_register(sim, &ops);
}

static mps_status add_air(mps_sim *sim, const scene *s, const double lo[3], const double hi[3])
{
    mps_phase gas;
    mps_phase_init(&gas, sizeof gas);
    gas.density = 1.2;
    gas.viscosity = 1.8e-5;
    mps_status status = mps_phase_set(sim, 1, &gas);
    if (status == MPS_OK) status = mps_fill_box_add(sim, 1, lo, hi, NULL, NULL);
    if (status == MPS_OK) status = mps_tension_set(sim, 0, 1, s->sigma);
    return status;
}

/* A sensor on the wall that the liquid meets, a gauge, a pressure in the liquid, the forces on all
 * walls and on the floor. */
static mps_status add_probes(mps_sim *sim)
{
    static const int32_t types[SCENE_PROBES] = {MPS_PROBE_WALL_PRESSURE, MPS_PROBE_GAUGE,
                                                MPS_PROBE_FLUID_PRESSURE, MPS_PROBE_FORCE,
                                                MPS_PROBE_FORCE};
    static const double places[SCENE_PROBES][3] = {
        {0.6, 0.06, 0.2}, {0.2, 0, 0.2}, {0.15, 0.1, 0.2}, {0, 0, 0}, {0.1, 0, 0}};
    mps_status status = MPS_OK;
    for (int k = 0; k < SCENE_PROBES && status == MPS_OK; k++) {
        mps_probe probe;
        int32_t id;
        mps_probe_init(&probe, sizeof probe);
        probe.type = types[k];
        if (k == SCENE_PROBES - 1) probe.part = "tank.y0";
        for (int d = 0; d < 3; d++) probe.at[d] = places[k][d];
        status = mps_probe_add(sim, &probe, &id);
    }
    return status;
}

/* Liquid to two thirds of the tank, but for a box in it. */
static int about_gas(void *user, const double *x)
{
    const scene *s = user;
    const bool in = x[0] > 0.16 && x[0] < 0.44 && x[1] > 0.08 && x[1] < 0.28 &&
                    (s->dim == 2 || (x[2] > 0.08 && x[2] < 0.32));
    return x[1] < 0.37 && !in;
}

static mps_status add_gas(mps_sim *sim, const scene *s)
{
    scene copy = *s;
    mps_status status = mps_model_use(sim, "gas.pocket");
    if (status == MPS_OK) status = mps_model_set(sim, "gas", "least", 2);
    if (status == MPS_OK) status = mps_fill_add(sim, 0, about_gas, &copy, NULL);
    return status;
}

mps_status scene_build(mps_sim *sim, const scene *s)
{
    const double lo[3] = {0, 0, 0}, depth[3] = {0.3, 0.26, 0.4}, all[3] = {0.6, 0.45, 0.4};
    const double from[3] = {0.2, 0.12, 0}, to[3] = {0.4, 0.32, 0.4};
    const double b[3] = {0.36, 0, 0}, c[3] = {0.42, 0.1, 0.4}, up[3] = {0.02, 0.15, 0},
                 along[3] = {0, 0, 0.4};
    mps_tank tank;
    mps_status status = mps_preset_use(sim, s->preset);
    if (status == MPS_OK) status = register_divided(sim);
    if (status == MPS_OK)
        status = mps_solver_use(sim, "sundials.pcg",
                                s->preconditioner ? s->preconditioner : "auxgrid");
    mps_tank_init(&tank, sizeof tank);
    for (int d = 0; d < 3; d++) tank.size[d] = all[d];
    if (status == MPS_OK) status = mps_tank_add(sim, &tank, NULL);
    if (status == MPS_OK && s->baffle == 1) status = mps_baffle_add(sim, "block", b, c, NULL);
    if (status == MPS_OK && s->baffle == 2)
        status = mps_plate_add(sim, "plate", b, up, s->dim == 3 ? along : NULL);
    if (status == MPS_OK && s->gas) status = add_gas(sim, s);
    if (status == MPS_OK && !s->gas)
        status = mps_fill_box_add(sim, 0, s->drop ? from : lo, s->drop ? to : depth, NULL, NULL);
    if (status == MPS_OK && s->preset[0] == 'm') status = add_air(sim, s, lo, all);
    if (status == MPS_OK && s->motion == travel)
        status = mps_motion_centre_set(sim, lo, MPS_START_WITH_TANK);
    if (status == MPS_OK && s->motion) status = mps_motion_callback_set(sim, s->motion, NULL);
    if (status == MPS_OK) status = add_probes(sim);
    return status;
}

/* Faster to the right, up to 4 m/s, with a part of its own for each particle. */
static mps_status speed_up(mps_sim *sim)
{
    const mps__particles *s = &sim->world.particles;
    mps_lease u = {.struct_size = sizeof u};
    const mps_status status = mps_lease_begin(sim, "velocity", MPS_WRITE, &u);
    if (status < 0) return status;
    for (int64_t i = 0; i < u.count; i++)
        if (s->kind[i] == MPS_FLUID)
            u.data[i * u.stride] = 10 * s->x[i * s->dim] + 0.001 * (double)(s->id[i] * 7919 % 1000);
    return mps_lease_end(sim, &u);
}

/* Fluid is removed before step 9, and some is added before step 13. */
mps_status scene_change(mps_sim *sim, const scene *s, int step)
{
    enum { GO = 25, COME = 4 };
    int64_t ids[GO], twice[2];
    double places[COME * 2];
    mps_particle_block block;
    if (s->fast && step == 0) return speed_up(sim);
    if (!s->changes || (step != 9 && step != 13)) return MPS_OK;
    for (int k = 0; k < GO; k++) ids[k] = sim->world.particles.next_id - 40 + k;
    if (step == 9) {
        twice[0] = twice[1] = ids[0];
        if (mps_particles_remove(sim, 2, twice) != MPS_E_ARG) return MPS_E_STATE;
        return mps_particles_remove(sim, GO, ids);
    }
    mps_particle_block_init(&block, sizeof block);
    for (int k = 0; k < COME; k++) {
        places[2 * k] = 0.41 + 0.02 * k;
        places[2 * k + 1] = 0.33;
    }
    block.kind = MPS_FLUID;
    block.count = COME;
    block.position = places;
    return mps_particles_add(sim, &block, NULL);
}

void record_note(mps_sim *sim, const mps_step_info *info, record *r)
{
    const mps__particles *s = &sim->world.particles;
    const int dim = s->dim;
    const mps__ghosts *g = &sim->world.ghosts;
    for (int64_t i = mps__own_from(g, 0); i < s->n; i = mps__own_from(g, i + 1)) {
        double *v = r->value[s->id[i]];
        for (int d = 0; d < dim; d++) {
            v[d] = s->x[i * dim + d];
            v[3 + d] = s->u[i * dim + d];
        }
        v[6] = s->p[i];
        v[7] = s->nd[i];
        v[8] = s->load[i];
        __atomic_fetch_add(&r->count, 1, __ATOMIC_RELAXED);
    }
    mps_energy e = {.struct_size = sizeof e};
    mps_energy_get(sim, &e);
    const double numbers[] = {info->t,
                              info->dt,
                              info->ppe_iterations,
                              (double)info->ppe_unknowns,
                              (double)info->surface,
                              info->max_speed,
                              e.kinetic,
                              e.wall_work_momentum,
                              e.wall_work_probes,
                              e.mass,
                              e.volume_filled,
                              e.centre[0],
                              e.centre[1],
                              info->crossing_time,

                              (double)info->pockets,
                              info->pocket_pressure,
                              e.gas};
    double probes[15] = {0};
    int at = 0;
    for (int32_t k = 0; k < SCENE_PROBES; at += mps_probe_size(sim, k++))
        mps_probe_read(sim, k, probes + at);
    if (sim->world.ranks.rank > 0) return;
    memcpy(r->info, numbers, sizeof numbers);
    memcpy(r->info + 17, probes, sizeof probes);
}

bool record_same(const record *alone, const record *many, char *text, size_t size)
{
    static const char *const names[] = {"x", "y", "z", "u", "v", "w", "p", "n", "load"},
                             *const infos[] = {"t",
                                               "dt",
                                               "iterations",
                                               "unknowns",
                                               "surface",
                                               "max_speed",
                                               "kinetic",
                                               "wall_work_momentum",
                                               "wall_work_probes",
                                               "mass",
                                               "volume",
                                               "cx",
                                               "cy",
                                               "crossing_time",
                                               "pockets",
                                               "pocket pressure",
                                               "work of gas",
                                               "wall pressure",
                                               "gauge",
                                               "fluid pressure",
                                               "force or moment",
                                               "force or moment",
                                               "force or moment",
                                               "force or moment",
                                               "force or moment",
                                               "force or moment",
                                               "force or moment",
                                               "force or moment",
                                               "force or moment",
                                               "force or moment",
                                               "force or moment",
                                               "force or moment"};
    const record *a = alone, *b = many;
    if (a->count != b->count) {
        snprintf(text, size, "%lld particles, not %lld", (long long)b->count, (long long)a->count);
        return false;
    }
    for (int v = 0; v < SCENE_INFOS; v++)
        if (memcmp(&a->info[v], &b->info[v], sizeof(double)) != 0) {
            snprintf(text, size, "%s is %.17g, not %.17g", infos[v], b->info[v], a->info[v]);
            return false;
        }
    for (int64_t id = 0; id < SCENE_MOST; id++)
        for (int v = 0; v < SCENE_NUMBERS; v++)
            if (memcmp(&a->value[id][v], &b->value[id][v], sizeof(double)) != 0) {
                snprintf(text, size, "%s of particle %lld is %.17g, not %.17g", names[v],
                         (long long)id, b->value[id][v], a->value[id][v]);
                return false;
            }
    return true;
}

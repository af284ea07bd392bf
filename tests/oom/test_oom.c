/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory that runs out: the k-th allocation fails, for k = 1, 2, ... until a call runs through. Every failure is
 * MPS_E_NOMEM with a text, leaves a handle that works, and at the end all memory is back. */
#include "../tags.h"
#include <math.h>
#include <math.h>
#include <mps/model.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

/* Fails the allocation number `fail_at` (0: none) and counts what is out. */
typedef struct memory {
    int64_t live, count, fail_at;
} memory;

static void *memory_alloc(void *user, size_t size)
{
    memory *m = user;
    if (++m->count == m->fail_at) return NULL;
    void *block = malloc(size);
    if (block) m->live++;
    return block;
}

static void memory_release(void *user, void *block)
{
    ((memory *)user)->live--;
    free(block);
}

static mps_allocator allocator_of(memory *m)
{
    return (mps_allocator){memory_alloc, memory_release, m};
}

/* Of the next simulation. */
static int32_t dimension = 2;

static mps_status create(memory *m, mps_sim **sim, char *error, size_t error_size)
{
    mps_config config;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dim = dimension;
    config.dp = dimension == 3 ? 0.1 : 0.05;
    config.allocator = allocator_of(m);
    config.error = error;
    config.error_size = error_size;
    return mps_sim_create(&config, sim);
}

/* ---- scenes: what stands before the call under test -------------------------------------------------------------- */

static mps_status add_tank(mps_sim *sim)
{
    mps_tank tank;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = tank.size[2] = 0.5;
    tank.open_top = 1;
    return mps_tank_add(sim, &tank, NULL);
}

static mps_status fill(mps_sim *sim)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {0.5, 0.3, 0.5};
    return mps_fill_box_add(sim, 0, lo, hi, NULL, NULL);
}

static void nothing(mps_sim *sim)
{
    (void)sim;
}
static void tank_only(mps_sim *sim)
{
    assert_int_equal(add_tank(sim), MPS_OK);
}

static void filled(mps_sim *sim)
{
    tank_only(sim);
    assert_int_equal(fill(sim), MPS_OK);
}

static void stepped(mps_sim *sim)
{
    filled(sim);
    for (int k = 0; k < 3; k++) assert_int_equal(mps_step(sim, 1e-3, NULL), MPS_OK);
}

/* With probes that keep averages and samples, a thousand of them in the next step. */
static void sampled(mps_sim *sim)
{
    filled(sim);
    for (int32_t type = 0; type < 4; type++) {
        mps_probe p;
        int32_t id;
        assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
        p.type = type;
        p.at[1] = type == MPS_PROBE_GAUGE ? 0 : 0.1;
        p.average = 1e-3;
        p.rate = 1e6;
        assert_int_equal(mps_probe_add(sim, &p, &id), MPS_OK);
    }
    for (int k = 0; k < 2; k++) assert_int_equal(mps_step(sim, 1e-3, NULL), MPS_OK);
}

static const char checkpoint[] = "oom.checkpoint";

static mps_status write_checkpoint(mps_sim *sim)
{
    return mps_checkpoint_write(sim, checkpoint);
}

static mps_status read_checkpoint(mps_sim *sim)
{
    return mps_checkpoint_read(sim, checkpoint);
}

/* A step beyond a checkpoint. */
static void beyond(mps_sim *sim)
{
    sampled(sim);
    assert_int_equal(write_checkpoint(sim), MPS_OK);
    assert_int_equal(mps_step(sim, 1e-3, NULL), MPS_OK);
}

/* And back. */
static void restored(mps_sim *sim)
{
    beyond(sim);
    assert_int_equal(read_checkpoint(sim), MPS_OK);
}

static void with_plate(mps_sim *sim)
{
    const double lo[2] = {0.25, 0}, hi[2] = {0.25, 0.2};
    tank_only(sim);
    assert_int_equal(mps_baffle_add(sim, "plate", lo, hi, NULL), MPS_OK);
    assert_int_equal(fill(sim), MPS_OK);
}

static void filled_for_bicgstab(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(mps_solver_use(sim, "sundials.bicgstab", "ic0"), MPS_OK);
}

static void filled_for_gmres(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(mps_solver_use(sim, "sundials.gmres", "jacobi"), MPS_OK);
    assert_int_equal(mps_preset_use(sim, "imps.paper"), MPS_OK);
}

static void filled_for_auxgrid(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(mps_solver_use(sim, "sundials.pcg", "auxgrid"), MPS_OK);
}

/* A closed tank of gas alone: nonlinear rows. */
static void gas_for_kinsol(mps_sim *sim)
{
    mps_tank tank;
    const double lo[2] = {0, 0}, hi[2] = {0.5, 0.5};
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = 0.5;
    assert_int_equal(mps_tank_add(sim, &tank, NULL), MPS_OK);
    assert_int_equal(mps_fill_box_add(sim, 0, lo, hi, NULL, NULL), MPS_OK);
    assert_int_equal(mps_model_use(sim, "gas.isentropic"), MPS_OK);
    assert_int_equal(mps_model_set(sim, "gas", "phase", 0), MPS_OK);
    assert_int_equal(mps_solver_use(sim, "sundials.kinsol", NULL), MPS_OK);
}

static void filled_for_klu(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(mps_solver_use(sim, "sundials.klu", NULL), MPS_OK);
}

/* Far above the pool, so that the next step sorts and grows everything. */
static mps_status add_drop(mps_sim *sim, double y, int64_t count)
{
    double x[2 * 64];
    mps_particle_block block;
    assert_true(count <= 64);
    assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
    for (int64_t k = 0; k < count; k++) {
        x[2 * k] = 0.1 + 0.04 * (double)(k % 8);
        x[2 * k + 1] = y + 0.04 * (double)(k / 8);
    }
    block.count = count;
    block.position = x;
    return mps_particles_add(sim, &block, NULL);
}

static void grown(mps_sim *sim)
{
    stepped(sim);
    assert_int_equal(add_drop(sim, 0.36, 64), MPS_OK);
}

/* ---- calls under test ---------------------------------------------------------------------------------------------- */

static mps_status baffle(mps_sim *sim)
{
    const double lo[2] = {0.25, 0.05}, hi[2] = {0.25, 0.2};
    return mps_baffle_add(sim, "baffle", lo, hi, NULL);
}

static mps_status plate(mps_sim *sim)
{
    const double corner[2] = {0.2, 0.05}, edge[2] = {0.1, 0.15};
    return mps_plate_add(sim, "plate", corner, edge, NULL);
}

static int anywhere(void *user, const double *x)
{
    return (void)user, x[1] < 0.3;
}
static mps_status fill_inside(mps_sim *sim)
{
    return mps_fill_add(sim, 0, anywhere, NULL, NULL);
}

static double round_shell(void *user, const double *x)
{
    return (void)user, 0.3 - hypot(x[0] - 0.3, x[1] - 0.3);
}

static int round_inside(void *user, const double *x)
{
    return round_shell(user, x) < 0;
}

static mps_status add_solid(mps_sim *sim, mps_distance_fn distance, mps_inside_fn inside)
{
    mps_solid solid;
    assert_int_equal(mps_solid_init(&solid, sizeof solid), MPS_OK);
    solid.distance = distance;
    solid.inside = inside;
    solid.hi[0] = solid.hi[1] = 0.6;
    return mps_solid_add(sim, &solid);
}

static mps_status solid(mps_sim *sim)
{
    return add_solid(sim, round_shell, NULL);
}

static mps_status solid_by_inside(mps_sim *sim)
{
    return add_solid(sim, NULL, round_inside);
}

static void solid_only(mps_sim *sim)
{
    assert_int_equal(solid(sim), MPS_OK);
}

static mps_status add_block(mps_sim *sim)
{
    return add_drop(sim, 0.36, 64);
}

static mps_status remove_some(mps_sim *sim)
{
    const int64_t ids[3] = {3, 1, 40};
    return mps_particles_remove(sim, 3, ids);
}

static mps_status field_add(mps_sim *sim)
{
    return mps_field_add(sim, "mine", 3);
}

static mps_status harmonics(mps_sim *sim)
{
    const mps_harmonic h = {.dof = MPS_SURGE, .amplitude = 0.01, .omega = 3};
    return mps_motion_harmonics_set(sim, 1, &h);
}

static mps_status motion_table(mps_sim *sim)
{
    const double t[4] = {0, 1, 2, 3}, x[4] = {0, 0.01, 0, -0.01};
    const int32_t dof = MPS_SURGE;
    return mps_motion_table_set(sim, 4, t, 1, &dof, x);
}

static mps_status probe(mps_sim *sim)
{
    mps_probe p;
    int32_t id = -1;
    assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
    p.at[1] = 0.1;
    const mps_status status = mps_probe_add(sim, &p, &id);
    assert_int_equal(id, status == MPS_OK ? 0 : -1);
    return status;
}

static mps_status series(mps_sim *sim)
{
    int64_t count = -1;
    const mps_status status = mps_probe_series(sim, 0, &count, NULL, NULL);
    assert_int_equal(count, status == MPS_OK ? 2001 : -1);
    return status;
}

static mps_status read_gauge(mps_sim *sim)
{
    double value;
    return mps_probe_read(sim, 2, &value);
}

static mps_status solver(mps_sim *sim)
{
    return mps_solver_use(sim, "sundials.bicgstab", "ic0");
}
static mps_status preset(mps_sim *sim)
{
    return mps_preset_use(sim, "imps.paper");
}
static mps_status step(mps_sim *sim)
{
    return mps_step(sim, 1e-3, NULL);
}

static mps_status stencil(mps_sim *sim)
{
    mps_stencil s = {.struct_size = sizeof s};
    return mps_stencil_get(sim, MPS_FAR, &s);
}

/* ---- presets and all else that takes memory --- */

static void use_preset(mps_sim *sim, const char *name)
{
    assert_int_equal(mps_preset_use(sim, name), MPS_OK);
}

static void with_gas(mps_sim *sim, const char *preset_name)
{
    const mps_phase gas = {.struct_size = sizeof gas, .density = 1.2, .viscosity = 1.8e-5};
    const double lo[3] = {0, 0, 0}, hi[3] = {0.5, 0.5, 0.5};
    mps_tank tank;
    assert_int_equal(mps_tank_init(&tank, sizeof tank), MPS_OK);
    tank.size[0] = tank.size[1] = tank.size[2] = 0.5;
    use_preset(sim, preset_name);
    assert_int_equal(mps_phase_set(sim, 1, &gas), MPS_OK);
    assert_int_equal(mps_tank_add(sim, &tank, NULL), MPS_OK);
    assert_int_equal(fill(sim), MPS_OK);
    assert_int_equal(mps_fill_box_add(sim, 1, lo, hi, NULL, NULL), MPS_OK);
}

static void filled_paper(mps_sim *sim)
{
    use_preset(sim, "imps.paper");
    filled(sim);
}

static void filled_mmps(mps_sim *sim)
{
    with_gas(sim, "mmps");
}

static void filled_mmps_paper(mps_sim *sim)
{
    with_gas(sim, "mmps.paper");
}

static void filled_threads(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(mps_threads_set(sim, 3), MPS_OK);
}

static mps_status fill_level(mps_sim *sim)
{
    const double lo[2] = {0, 0}, hi[2] = {0.5, 0.28};
    return mps_fill_level_add(sim, 0, lo, hi, NULL, NULL);
}

static const char stl_path[] = "oom.stl";

static mps_status stl_solid(mps_sim *sim)
{
    mps_stl stl;
    assert_int_equal(mps_stl_init(&stl, sizeof stl), MPS_OK);
    return mps_stl_add(sim, stl_path, &stl, NULL);
}

/* A tetrahedron. */
static void write_stl(void)
{
    static const double corner[4][3] = {{0, 0, 0}, {0.8, 0, 0}, {0, 0.8, 0}, {0, 0, 0.8}};
    static const int face[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    FILE *file = fopen(stl_path, "w");
    assert_non_null(file);
    fprintf(file, "solid a\n");
    for (int f = 0; f < 4; f++) {
        fprintf(file, "facet normal 0 0 0\nouter loop\n");
        for (int k = 0; k < 3; k++)
            fprintf(file, "vertex %g %g %g\n", corner[face[f][k]][0], corner[face[f][k]][1],
                    corner[face[f][k]][2]);
        fprintf(file, "endloop\nendfacet\n");
    }
    fprintf(file, "endsolid a\n");
    assert_int_equal(fclose(file), 0);
}

static mps_status model(mps_sim *sim)
{
    return mps_model_use(sim, "tension.csf");
}

static int run_nothing(mps_stage *s)
{
    return mps_stage_scratch(s, s->n) == NULL;
}

static int create_state(const mps_allocator *allocator, void **self)
{
    *self = allocator->alloc(allocator->user, 100);
    return *self == NULL;
}

static void destroy_state(const mps_allocator *allocator, void *self)
{
    allocator->release(allocator->user, self);
}

static mps_status register_model(mps_sim *sim)
{
    static const mps_use uses[] = {{"oom_mark", MPS_USE_CHANGE}};
    static const mps_verb verbs[] = {
        {.moment = MPS_FORCE, .use_count = 1, .uses = uses, .run = run_nothing}};
    static const mps_channel channels[] = {
        {"oom_mark", "-", "any", 2, MPS_TYPE_REAL, MPS_LIFE_PARTICLE, 1}};
    const mps_model_ops ops = {.struct_size = sizeof ops,
                               .api = MPS_MODEL_API,
                               .name = "oom.any",
                               .help = "any",
                               .channel_count = 1,
                               .verb_count = 1,
                               .channels = channels,
                               .verbs = verbs,
                               .create = create_state,
                               .destroy = destroy_state};
    return mps_model_register(sim, &ops);
}

static void with_own_model(mps_sim *sim)
{
    filled(sim);
    assert_int_equal(register_model(sim), MPS_OK);
}

static mps_status use_own_model(mps_sim *sim)
{
    return mps_model_use(sim, "oom.any");
}

static void using_own_model(mps_sim *sim)
{
    with_own_model(sim);
    assert_int_equal(use_own_model(sim), MPS_OK);
}

static mps_status energy(mps_sim *sim)
{
    mps_energy e;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    return mps_energy_get(sim, &e);
}

static mps_status verb_info(mps_sim *sim)
{
    mps_verb_info v;
    assert_int_equal(mps_verb_info_init(&v, sizeof v), MPS_OK);
    return mps_verb_info_get(sim, 0, &v);
}

static mps_status frames(mps_sim *sim)
{
    mps_frames *f = NULL;
    mps_status status = mps_frames_open(sim, ".", "oom_frames", 0, &f);
    if (status == MPS_OK) status = mps_frames_write(f);
    if (status == MPS_OK) status = mps_frames_write(f);
    mps_frames_close(f);
    return status;
}

static mps_status frames_continued(mps_sim *sim)
{
    mps_frames *f = NULL;
    const mps_status status = mps_frames_open(sim, ".", "oom_frames", MPS_FRAMES_CONTINUE, &f);
    mps_frames_close(f);
    return status;
}

static void with_frames(mps_sim *sim)
{
    stepped(sim);
    assert_int_equal(frames(sim), MPS_OK);
}

static mps_status custom_kernel(mps_sim *sim)
{
    mps_kernel kernel = {.struct_size = sizeof kernel};
    assert_int_equal(mps_kernel_find("original", &kernel), MPS_OK);
    return mps_kernel_use(sim, &kernel);
}

static mps_status remove_probe(mps_sim *sim)
{
    return mps_probe_remove(sim, 0);
}

static mps_status read_force(mps_sim *sim)
{
    double values[6];
    return mps_probe_read(sim, 3, values);
}

static mps_status callback(mps_sim *sim)
{
    return mps_motion_clear(sim);
}

/* ---- the loop -------------------------------------------------------------------------------------------------------- */

/* Positions, velocities and pressures by id, so that the order does not matter. */
static double *snapshot(mps_sim *sim, int64_t *count)
{
    static const char *const fields[3] = {"position", "velocity", "pressure"};
    const int64_t *ids = NULL, n = mps_particles_count(sim, -1);
    double *out = calloc((size_t)(7 * (n + 300)), sizeof *out);
    int64_t at = 0;
    assert_int_equal(tags_peek(sim, &ids, NULL, NULL, NULL), MPS_OK);
    for (int f = 0; f < 3; f++) {
        mps_lease lease = {.struct_size = sizeof lease};
        assert_int_equal(mps_lease_begin(sim, fields[f], MPS_READ, &lease), MPS_OK);
        for (int64_t i = 0; i < n; i++)
            for (int c = 0; c < lease.stride; c++)
                out[at + ids[i] * lease.stride + c] = lease.data[i * lease.stride + c];
        at += (n + 64) * lease.stride;
        assert_int_equal(mps_lease_end(sim, &lease), MPS_OK);
    }
    *count = 7 * n;
    return out;
}

/* A failed call changed nothing one can see. */
static void check_unchanged(mps_sim *sim, const double *before, int64_t count, double t)
{
    int64_t now = 0;
    double time = -1, *after = snapshot(sim, &now);
    assert_int_equal(now, count);
    assert_memory_equal(after, before, (size_t)count * sizeof *after);
    assert_int_equal(mps_sim_time(sim, &time, NULL), MPS_OK);
    assert_true(time == t);
    free(after);
}

typedef struct scene {
    const char *name;
    void (*prepare)(mps_sim *sim);
    mps_status (*call)(mps_sim *sim);
    int64_t
        least; /* allocations the call makes at least, so that the loop is known to test something */
    int32_t dim; /* 0: 2 */
} scene;

static const scene scenes[] = {
    {"geometry_tank", nothing, add_tank, 2, 0},
    {"geometry_baffle", tank_only, baffle, 2, 0},
    {"geometry_plate", tank_only, plate, 2, 0},
    {"step with a plate", with_plate, step, 20, 0},
    {"geometry_fill_box", tank_only, fill, 2, 0},
    {"geometry_fill", tank_only, fill_inside, 2, 0},
    {"geometry_solid", nothing, solid, 50, 0},
    {"geometry_solid by inside", nothing, solid_by_inside, 60, 0},
    {"geometry_fill beside a solid", solid_only, fill_inside, 30, 0},
    {"particles_add", filled, add_block, 5, 0},
    {"particles_remove", filled, remove_some, 3, 0},
    {"field_add", filled, field_add, 1, 0},
    {"motion_set_harmonics", filled, harmonics, 1, 0},
    {"motion_set_table", filled, motion_table, 1, 0},
    {"probe_add", filled, probe, 1, 0},
    {"solver_use", filled, solver, 1, 0},
    {"use_preset", filled, preset, 0, 0},
    {"first step", filled, step, 20, 0},
    {"later step", stepped, step, 0, 0}, /* has all it needs */
    {"step of more", grown, step, 20, 0},
    {"step with samples", sampled, step, 8, 0},
    {"probe_series", sampled, series, 2, 0},
    {"probe_read", sampled, read_gauge, 3, 0},
    {"first step, bicgstab", filled_for_bicgstab, step, 20, 0},
    {"first step, gmres", filled_for_gmres, step, 20, 0},
    {"first step, auxgrid", filled_for_auxgrid, step, 20, 0},
    {"first step, klu", filled_for_klu, step, 20, 0},
    {"first step, kinsol", gas_for_kinsol, step, 20, 0},
    {"stencil", filled, stencil, 10, 0},
    {"stencil of more", grown, stencil, 10, 0},
    {"checkpoint_write", sampled, write_checkpoint, 3, 0},
    {"checkpoint_read", beyond, read_checkpoint, 20, 0},
    {"step after checkpoint_read", restored, step, 8, 0},
    {"first step, imps, 3-D", filled, step, 20, 3},
    {"first step, imps.paper", filled_paper, step, 20, 0},
    {"first step, imps.paper, 3-D", filled_paper, step, 20, 3},
    {"first step, mmps", filled_mmps, step, 20, 0},
    {"first step, mmps, 3-D", filled_mmps, step, 20, 3},
    {"first step, mmps.paper", filled_mmps_paper, step, 20, 0},
    {"first step, mmps.paper, 3-D", filled_mmps_paper, step, 20, 3},
    {"first step, threads", filled_threads, step, 20, 0},
    {"first step, own model", using_own_model, step, 20, 0},
    {"geometry_fill_level", tank_only, fill_level, 2, 0},
    {"geometry_stl", nothing, stl_solid, 20, 3},
    {"geometry_stl in a tank", tank_only, stl_solid, 20, 3},
    {"model_use", filled, model, 0, 0},
    {"model_register", filled, register_model, 0, 0},
    {"model_use of an own model", with_own_model, use_own_model, 1, 0},
    {"energy_get", filled, energy, 0, 0},
    {"verb_info_get", filled, verb_info, 0, 0},
    {"frames", stepped, frames, 1, 0},
    {"frames continued", with_frames, frames_continued, 1, 0},
    {"sim_set_kernel", tank_only, custom_kernel, 0, 0},
    {"probe_remove", sampled, remove_probe, 0, 0},
    {"probe_read of a force", sampled, read_force, 0, 0},
    {"motion_clear", filled, callback, 0, 0},
};

static void check_step_after(mps_sim *sim, const scene *s)
{
    if (s->call(sim) != MPS_OK) fail_msg("%s, again: %s", s->name, mps_sim_error(sim));
}

/* Fail allocation k of one call. Returns false when the call had fewer than k. */
static bool fail_once(const scene *s, int64_t k)
{
    memory m = {0, 0, 0};
    mps_sim *sim = NULL;
    double t = -1;
    int64_t count = 0;
    assert_int_equal(create(&m, &sim, NULL, 0), MPS_OK);
    s->prepare(sim);
    double *before = snapshot(sim, &count);
    assert_int_equal(mps_sim_time(sim, &t, NULL), MPS_OK);
    m.count = 0;
    m.fail_at = k;
    const mps_status status = s->call(sim);
    const bool failed = m.count >= k;
    m.fail_at = 0;
    if (failed) {
        if (status == MPS_OK &&
            s->prepare ==
                filled_threads) { /* the memory of the threads: loops run in the calling thread then */
            check_step_after(sim, s);
            mps_sim_destroy(sim);
            free(before);
            assert_int_equal(m.live, 0);
            return true;
        }
        if (status != MPS_E_NOMEM)
            fail_msg("%s, allocation %lld: %s: %s", s->name, (long long)k, mps_status_name(status),
                     mps_sim_error(sim));
        if (!strstr(mps_sim_error(sim), "memory"))
            fail_msg("%s, allocation %lld: the text is \"%s\"", s->name, (long long)k,
                     mps_sim_error(sim));
        check_unchanged(sim, before, count, t);
        if (s->call(sim) != MPS_OK)
            fail_msg("%s, again after allocation %lld: %s", s->name, (long long)k,
                     mps_sim_error(sim));
    } else {
        assert_int_equal(status, MPS_OK);
        assert_true(m.count >= s->least);
    }
    if (mps_particles_count(sim, MPS_FLUID) > 0) assert_true(mps_step(sim, 1e-3, NULL) >= 0);
    mps_sim_destroy(sim);
    free(before);
    if (m.live != 0)
        fail_msg("%s, allocation %lld: %lld blocks are not given back", s->name, (long long)k,
                 (long long)m.live);
    return failed;
}

static void run_scene(void **state)
{
    const scene *s = *state;
    dimension = s->dim ? s->dim : 2;
    for (int64_t k = 1; fail_once(s, k); k++) assert_true(k < 1000);
}

static void sim_create(void **state)
{
    (void)state;
    dimension = 2;
    mps_status status = MPS_E_NOMEM;
    int64_t k = 0;
    while (status != MPS_OK) {
        memory m = {0, 0, ++k};
        mps_sim *sim = (mps_sim *)&m;
        char error[200] = "";
        status = create(&m, &sim, error, sizeof error);
        if (status == MPS_OK) {
            assert_true(m.live > 0);
            mps_sim_destroy(sim);
        } else {
            assert_int_equal(status, MPS_E_NOMEM);
            assert_null(sim);
            assert_non_null(strstr(error, "memory"));
        }
        assert_int_equal(m.live, 0);
    }
    assert_true(k > 15);
}

static void neighbours(void **state)
{
    (void)state;
    double x[200];
    mps_kernel kernel = {.struct_size = sizeof kernel};
    mps_stencil s = {.struct_size = sizeof s};
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    for (int k = 0; k < 200; k++) x[k] = k % 2 ? k / 20 : k / 2 % 10;
    for (int64_t k = 1;; k++) {
        memory m = {0, 0, k};
        const mps_allocator allocator = allocator_of(&m);
        mps_neighbours *list = (mps_neighbours *)&m;
        mps_status status = mps_neighbours_create(2, 1, &allocator, &list);
        if (status != MPS_OK) {
            assert_int_equal(status, MPS_E_NOMEM);
            assert_null(list);
            continue;
        }
        assert_true(k > 1);
        status = mps_neighbours_build(list, 100, x, 2.1, 3.1);
        const bool failed = status != MPS_OK;
        if (failed) {
            assert_int_equal(status, MPS_E_NOMEM);
            assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &s),
                             MPS_E_ARG); /* empty */
            assert_int_equal(mps_neighbours_build(list, 100, x, 2.1, 3.1), MPS_OK);
        }
        assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &s), MPS_OK);
        assert_int_equal(s.end[55] - s.begin[55], 12);
        mps_neighbours_destroy(list);
        assert_int_equal(m.live, 0);
        if (!failed) {
            assert_true(k > 8);
            break;
        }
    }
}

int main(void)
{
    enum { SCENES = sizeof scenes / sizeof scenes[0] };
    struct CMUnitTest tests[SCENES + 2] = {cmocka_unit_test(sim_create),
                                           cmocka_unit_test(neighbours)};
    for (int k = 0; k < SCENES; k++)
        tests[k + 2] = (struct CMUnitTest){scenes[k].name, run_scene, NULL, NULL,
                                           (void *)&scenes[k]};
    write_stl();
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    remove(checkpoint);
    remove(stl_path);
    remove("oom_frames.pvd");
    return failed;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes of the kit of models: a tank that surges, half full of water; with air in "mmps", and in
 * 2-D without air with a falling droplet. */
#include "model_scenes.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *preset;
    int32_t dim;
} scenes[KIT_SCENES] = {{"imps", 2},       {"imps", 3}, {"mmps", 2},
                        {"imps.paper", 2}, {"mmps", 3}, {"mmps.paper", 2}};

/* Inner size of the tanks and depth of the water, in spacings. */
enum { SIDE_2D = 16, SIDE_3D = 6 };
static const double DP = 0.02;

kit_case kit_scene(const mps_model_ops *ops, kit_prepare_fn prepare, void *user, int k)
{
    return (kit_case){.ops = ops,
                      .prepare = prepare,
                      .user = user,
                      .preset = scenes[k].preset,
                      .dim = scenes[k].dim,
                      .threads = 1};
}

static bool two_phases(const kit_case *c)
{
    return strncmp(c->preset, "mmps", 4) == 0;
}

/* Slightly displaced from the lattice, so that no sum vanishes by symmetry; a function of the
 * position. */
static double jitter(int a, int b, int c, int d)
{
    return 0.05 * DP * sin(1.0 + 12.9898 * a + 78.233 * b + 37.719 * c + 4.7 * d);
}

static int side_of(const kit_case *c)
{
    return c->dim == 2 ? SIDE_2D : SIDE_3D;
}

/* Part of the lattice: columns left..right-1 of rows from..to-1. */
typedef struct part {
    int left, right, from, to;
} part;

/* Positions of a part. @return their number */
static int64_t places_of(const kit_case *c, part p, double *x)
{
    const int deep = c->dim == 3 ? side_of(c) : 2;
    int64_t count = 0;
    for (int b = p.from; b < p.to; b++)
        for (int a = p.left; a < p.right; a++)
            for (int e = 1; e < deep; e++) {
                const int place[3] = {a, b, e};
                for (int d = 0; d < c->dim; d++)
                    x[count * c->dim + d] = DP * place[d] + jitter(a, b, e, d);
                count++;
            }
    return count;
}

static void turn_round(double *x, int64_t count, int dim)
{
    for (int64_t i = 0; i < count / 2; i++)
        for (int d = 0; d < dim; d++) {
            const double kept = x[i * dim + d];
            x[i * dim + d] = x[(count - 1 - i) * dim + d];
            x[(count - 1 - i) * dim + d] = kept;
        }
}

/* Fluid of a phase, with a rotating velocity. */
static mps_status add_fluid(const kit_case *c, mps_sim *sim, int32_t phase, part p)
{
    const size_t most = (size_t)SIDE_2D * SIDE_2D * SIDE_3D;
    double *x = malloc(6 * most * sizeof *x);
    mps_particle_block block;
    if (!x) return MPS_E_NOMEM;
    double *u = x + 3 * most;
    mps_particle_block_init(&block, sizeof block);
    block.count = places_of(c, p, x);
    if (c->reverse) turn_round(x, block.count, c->dim);
    for (int64_t i = 0; i < block.count; i++)
        for (int d = 0; d < c->dim; d++)
            u[i * c->dim + d] = 0.1 * sin(30 * x[i * c->dim] + 20 * x[i * c->dim + 1] + d);
    block.phase = phase;
    block.position = x;
    block.velocity = u;
    const mps_status status = mps_particles_add(sim, &block, NULL);
    free(x);
    return status;
}

static mps_status fill(const kit_case *c, mps_sim *sim)
{
    const int side = side_of(c), middle = side / 2 + 1;
    const part water = {1, side, 1, middle}, rest = {1, side, middle, side}, drop = {7, 10, 12, 15};
    mps_phase air;
    mps_status status = mps_phase_init(&air, sizeof air);
    air.density = 1.29;
    air.viscosity = 1.8e-5;
    if (status >= 0 && two_phases(c)) status = mps_phase_set(sim, 1, &air);
    if (status >= 0 && two_phases(c)) status = mps_tension_set(sim, 0, 1, 0.0727);
    if (status >= 0) status = add_fluid(c, sim, 0, water);
    if (status >= 0 && two_phases(c)) status = add_fluid(c, sim, 1, rest);
    if (status >= 0 && !two_phases(c) && c->dim == 2) status = add_fluid(c, sim, 0, drop);
    return status;
}

static mps_status build(const kit_case *c, mps_sim *sim)
{
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.01, .omega = 8};
    const double side = DP * side_of(c);
    mps_solver_limits limits;
    mps_tank tank;
    mps_status status = mps_preset_use(sim, c->preset);
    mps_tank_init(&tank, sizeof tank);
    for (int d = 0; d < c->dim; d++) tank.size[d] = side;
    mps_solver_limits_init(&limits, sizeof limits);
    limits.tolerance = 1e-10; /* results differ by rounding only */
    if (status >= 0) status = mps_tank_add(sim, &tank, NULL);
    if (status >= 0) status = fill(c, sim);
    if (status >= 0) status = mps_solver_limits_set(sim, &limits);
    if (status >= 0 && c->nonlinear) status = mps_solver_use(sim, "sundials.kinsol", NULL);
    if (status >= 0) status = mps_motion_harmonics_set(sim, 1, &surge);
    return status;
}

/* Register the model unless it is built in. */
static mps_status know(const kit_case *c, mps_sim *sim)
{
    mps_model_info info;
    mps_model_info_init(&info, sizeof info);
    for (int32_t k = 0; mps_model_info_get(sim, k, &info) == MPS_OK; k++)
        if (strcmp(info.name, c->ops->name) == 0) return MPS_OK;
    return mps_model_register(sim, c->ops);
}

mps_status kit_switch_on(const kit_case *c, mps_sim *sim)
{
    mps_status status = know(c, sim);
    if (status >= 0) status = mps_model_use(sim, c->ops->name);
    if (status >= 0 && c->prepare) status = c->prepare(c->user, sim);
    if (status >= 0 && c->key) status = mps_model_set(sim, c->ops->name, c->key, c->value);
    return status;
}

mps_status kit_open(const kit_case *c, mps_sim **sim)
{
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dim = c->dim;
    config.dp = DP;
    config.threads = c->threads;
    if (c->allocator) config.allocator = *c->allocator;
    mps_status status = mps_sim_create(&config, sim);
    if (status >= 0 && c->ranks) status = mps_sim_ranks_set(*sim, c->ranks);
    if (status >= 0) status = build(c, *sim);
    if (status >= 0 && !c->without) status = kit_switch_on(c, *sim);
    return status;
}

mps_status kit_steps(mps_sim *sim, int steps)
{
    mps_status status = MPS_OK;
    for (int k = 0; k < steps && status >= 0; k++) status = mps_step(sim, 1e-3, NULL);
    return status;
}

/* ---- states ---------------------------------------------------------------------------------- */

enum { LIBRARY_FIELDS = 4 };

/* Compared fields: those of the library, and channels of MPS_LIFE_PARTICLE. */
static int32_t field_name(const mps_sim *sim, int32_t index, const char **name)
{
    static const char *const own[LIBRARY_FIELDS] = {"position", "velocity", "pressure", "density"};
    const int32_t count = LIBRARY_FIELDS;
    mps_channel_info info;
    int32_t found = count;
    if (index < count) *name = own[index];
    if (index < count) return 1;
    mps_channel_info_init(&info, sizeof info);
    for (int32_t k = 0; mps_channel_info_get(sim, k, &info) == MPS_OK; k++) {
        if (info.own || info.life != MPS_LIFE_PARTICLE) continue;
        *name = info.name;
        if (found++ == index) return 1;
    }
    return 0;
}

/* Append a copy of one field to those copied before. */
static bool append(mps_sim *sim, const char *name, const int64_t *place, kit_state *s)
{
    mps_lease lease = {.struct_size = sizeof lease};
    if (mps_lease_begin(sim, name, MPS_READ, &lease) < 0) return false;
    const int32_t wide = s->stride + lease.stride;
    kit_field *field = &s->field[s->fields++];
    snprintf(field->name, sizeof field->name, "%s", name);
    field->first = s->stride;
    field->components = lease.stride;
    double *data = malloc((size_t)s->n * (size_t)wide * sizeof *data);
    for (int64_t i = 0; data && i < s->n; i++) {
        if (s->stride > 0)
            memcpy(data + i * wide, s->data + i * s->stride, (size_t)s->stride * sizeof *data);
        memcpy(data + i * wide + s->stride, lease.data + place[i] * lease.stride,
               (size_t)lease.stride * sizeof *data);
    }
    mps_lease_end(sim, &lease);
    free(s->data);
    s->data = data;
    s->stride = wide;
    return data != NULL;
}

static int by_id(const void *a, const void *b)
{
    const int64_t *p = a, *q = b;
    return p[0] < q[0] ? -1 : p[0] > q[0];
}

/* place: pairs of id and row, sorted by id; then rows only. */
static bool append_all(mps_sim *sim, int64_t *place, kit_state *s)
{
    mps_lease id = {.struct_size = sizeof id};
    const char *name;
    bool good = true;
    if (mps_lease_begin(sim, "id", MPS_READ, &id) < 0) return false;
    for (int64_t i = 0; i < s->n; i++) {
        place[2 * i] = id.ids[i];
        place[2 * i + 1] = i;
    }
    mps_lease_end(sim, &id);
    qsort(place, (size_t)s->n, 2 * sizeof *place, by_id);
    for (int64_t i = 0; i < s->n; i++) {
        s->id[i] = place[2 * i];
        place[i] = place[2 * i + 1];
    }
    for (int32_t k = 0; good && field_name(sim, k, &name); k++) {
        good = s->fields < KIT_FIELDS && append(sim, name, place, s);
        if (good) s->field[k].own = k >= LIBRARY_FIELDS;
    }
    return good;
}

bool kit_state_get(mps_sim *sim, kit_state *s)
{
    *s = (kit_state){.n = mps_particles_count(sim, -1)};
    s->id = malloc((size_t)s->n * sizeof *s->id);
    int64_t *place = malloc(2 * (size_t)s->n * sizeof *place);
    const bool good = s->id && place && append_all(sim, place, s);
    free(place);
    if (!good) kit_state_free(s);
    return good;
}

void kit_state_free(kit_state *s)
{
    free(s->id);
    free(s->data);
    *s = (kit_state){0};
}

bool kit_state_finite(const kit_state *s)
{
    for (int64_t k = 0; k < s->n * s->stride; k++)
        if (!isfinite(s->data[k])) return false;
    return true;
}

bool kit_state_same(const kit_state *a, const kit_state *b)
{
    return a->n == b->n && a->stride == b->stride && a->n > 0 &&
           memcmp(a->id, b->id, (size_t)a->n * sizeof *a->id) == 0 &&
           memcmp(a->data, b->data, (size_t)(a->n * a->stride) * sizeof *a->data) == 0;
}

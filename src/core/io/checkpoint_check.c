/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of the numbers in a checkpoint. */
#include "checkpoint_check.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DAMAGED(...) return mps__fail(c, MPS_E_IO, "the checkpoint is damaged: " __VA_ARGS__)

/* Larger ids could overflow during the life of a handle. */
static const int64_t MOST_IDS = INT64_C(1) << 62;

/* Largest difference between the entries of a stored rotation and those computed from its angles:
 * other C libraries round sin and cos differently. */
static const double ROTATION = 1e-9;

/* Largest deviation of the next sample number from its time, due to rounding. */
static const double SAMPLES = 2;

static mps_status check_range(mps__context *c, const char *name, double value, double least,
                              double most)
{
    if (!(value >= least && value <= most))
        DAMAGED("\"%s\" is %.9g; must be %g..%g", name, value, least, most);
    return MPS_OK;
}

/* Finite, with margin for products of four: derived numbers must be finite as well. */
static const double most_of_all = 1e75;

static mps_status check_within(mps__context *c, const char *name, const double *values,
                               int64_t count, double most)
{
    for (int64_t k = 0; k < count; k++)
        if (!(fabs(values[k]) <= most))
            DAMAGED("number %lld of \"%s\" is %g; must be within +-%g", (long long)k, name,
                    values[k], most);
    return MPS_OK;
}

static mps_status check_finite(mps__context *c, const char *name, const double *values,
                               int64_t count)
{
    return check_within(c, name, values, count, most_of_all);
}

/* ---- scalars ---- */

static mps_status check_pose_state(mps__context *c, const mps__arrived *a, const char *name,
                                   const mps_motion_state *s)
{
    MPS__TRY(check_finite(c, name, s->value, MPS_DOF_COUNT));
    MPS__TRY(check_finite(c, name, s->rate, MPS_DOF_COUNT));
    MPS__TRY(check_finite(c, name, s->accel, MPS_DOF_COUNT));
    for (int d = 0; d < MPS_DOF_COUNT; d++)
        if (a->sim->world.setup.dim == 2 && !mps__dof_in_plane(d) &&
            (s->value[d] != 0 || s->rate[d] != 0 || s->accel[d] != 0))
            DAMAGED("'%s' of \"%s\" is not 0, but 2-D does not have it", mps__dof_name[d], name);
    return MPS_OK;
}

mps_status mps__check_body(mps__context *c, const mps__body_state *b)
{
    const double *const loads[] = {b->late,      b->liquid,    b->external,
                                   b->restoring, b->felt_late, b->friction};
    const double energies[] = {b->damped, b->external_work, b->liquid_work, b->start, b->rubbed};
    for (size_t k = 0; k < sizeof loads / sizeof loads[0]; k++)
        MPS__TRY(check_finite(c, "body", loads[k], 6));
    MPS__TRY(check_finite(c, "body", b->mass, 36));
    MPS__TRY(check_finite(c, "body", energies, 5));
    return check_finite(c, "body", b->origin, 3);
}

mps_status mps__check_load(mps__context *c, const mps__load *l)
{
    MPS__TRY(check_finite(c, "load", &l->dt, 1));
    MPS__TRY(check_finite(c, "load", l->at, 3));
    MPS__TRY(check_finite(c, "load", l->force, 6));
    MPS__TRY(check_finite(c, "load", l->accel, 6));
    return check_finite(c, "load", l->mass, 36);
}

/* A pose with `set` false has no rotation. */
static mps_status check_pose(mps__context *c, const mps__arrived *a, const char *name,
                             const mps__pose *p, bool set)
{
    mps__pose exact;
    MPS__TRY(check_finite(c, name, &p->t, 1));
    MPS__TRY(check_pose_state(c, a, name, &p->state));
    MPS__TRY(check_finite(c, name, p->rotation, 9));
    MPS__TRY(check_finite(c, name, p->omega, 3));
    MPS__TRY(check_finite(c, name, p->alpha, 3));
    mps__motion_pose_of(&p->state, p->t, &exact);
    for (int k = 0; set && k < 9; k++)
        if (fabs(p->rotation[k] - exact.rotation[k]) > ROTATION)
            DAMAGED("the rotation of \"%s\" is not that of its angles", name);
    return MPS_OK;
}

static mps_status check_budget(mps__context *c, const mps__budget *b)
{
    const double work[] = {b->wall_work_momentum,
                           b->wall_work_probes,
                           b->viscous,
                           b->plugins,
                           b->collision,
                           b->shift,
                           b->added,
                           b->friction,
                           b->layers,
                           b->gas,
                           b->start,
                           b->deviation,
                           b->deviation_start};
    const mps__bulk *l = &b->last;
    const double last[] = {l->kinetic, l->potential, l->momentum[0], l->momentum[1],
                           l->momentum[2]};
    const double *const change[] = {
        b->momentum.plugins,   b->momentum.reaction, b->momentum.total, b->momentum.gravity,
        b->momentum.force,     b->momentum.pressure, b->momentum.walls, b->momentum.numerical,
        b->momentum.collision, b->momentum.shift,    b->momentum.added, b->momentum.friction};
    MPS__TRY(check_finite(c, "state.budget", work, sizeof work / sizeof work[0]));
    MPS__TRY(check_finite(c, "state.budget", last, sizeof last / sizeof last[0]));
    for (size_t k = 0; k < sizeof change / sizeof change[0]; k++)
        MPS__TRY(check_finite(c, "state.budget", change[k], 3));
    if (b->started != 0 && b->started != 1)
        DAMAGED("\"started\" of \"state.budget\" is %lld; must be 0 or 1", (long long)b->started);
    return MPS_OK;
}

static mps_status check_flags(mps__context *c, const mps__state *s)
{
    const struct {
        const char *name;
        int32_t value;
    } all[] = {{"state.start_pending", s->start_pending},
               {"state.level_told", s->level_told},
               {"state.moves_told", s->moves_told},
               {"state.window_told", s->window_told}};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
        if (all[k].value != 0 && all[k].value != 1)
            DAMAGED("\"%s\" is %d; must be 0 or 1", all[k].name, (int)all[k].value);
    return MPS_OK;
}

static mps_status check_counts(mps__context *c, const mps__arrived *a)
{
    const struct {
        const char *name;
        int64_t value;
    } all[] = {{"state.step", a->state.step},
               {"state.lost", a->state.lost},
               {"state.jump", a->state.jump.since},
               {"particles.next_id", a->next_id}};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++)
        if (all[k].value < 0 || all[k].value > MOST_IDS)
            DAMAGED("\"%s\" is %lld; must be 0..%lld", all[k].name, (long long)all[k].value,
                    (long long)MOST_IDS);
    if (a->state.lost > a->next_id)
        DAMAGED("\"state.lost\" is %lld, more than all particles", (long long)a->state.lost);
    return MPS_OK;
}

mps_status mps__check_scalars(mps__context *c, const mps__arrived *a)
{
    const mps__state *s = &a->state;
    const double most = most_of_all;
    MPS__TRY(check_range(c, "state.t", s->t, 0, most));
    MPS__TRY(check_range(c, "state.crossing_time", s->crossing_time, 0, most));
    if (s->dt_previous != 0)
        MPS__TRY(check_range(c, "state.dt_previous", s->dt_previous, 1 / most, most));
    if (s->dt_before != 0) /* velocities of the tank are divided by it */
        MPS__TRY(check_range(c, "state.dt_before", s->dt_before, 1 / most, most));
    MPS__TRY(check_range(c, "state.jump", s->jump.accel, 0, most));
    MPS__TRY(check_range(c, "state.spread", s->spread, 0, most));
    MPS__TRY(check_counts(c, a));
    MPS__TRY(check_flags(c, s));
    MPS__TRY(check_budget(c, &s->budget));
    MPS__TRY(check_pose(c, a, "state.before", &s->before, s->step > 0));
    MPS__TRY(check_pose(c, a, "motion.now", &a->now, true));
    if (!(fabs(a->now.t - s->t) <= 1e-9 * (1 + s->t)))
        DAMAGED("\"motion.now\" is at %.9g s, \"state.t\" is %.9g s", a->now.t, s->t);
    return check_pose_state(c, a, "motion.hold", &a->hold);
}

/* ---- particles ---- */

static const void *field(const mps__arrived *a, const char *name)
{
    const mps__particles *s = &a->sim->world.particles;
    for (int32_t k = 0; k < s->fields; k++)
        if (strcmp(s->field[k].name, name) == 0) return a->field[k];
    return NULL; /* not reached: the names are internal */
}

static mps_status check_tags(mps__context *c, const mps__arrived *a, const char *name,
                             int64_t least, int64_t most)
{
    const int32_t *values = field(a, name);
    for (int64_t i = 0; i < a->n; i++)
        if (values[i] < least || values[i] > most)
            DAMAGED("\"%s\" of particle %lld is %d; must be %lld..%lld", name, (long long)i,
                    (int)values[i], (long long)least, (long long)most);
    return MPS_OK;
}

static mps_status check_held(mps__context *c, const mps__arrived *a)
{
    const uint8_t *values = field(a, "held");
    for (int64_t i = 0; i < a->n; i++)
        if (values[i] > 1)
            DAMAGED("\"held\" of particle %lld is %d; must be 0 or 1", (long long)i,
                    (int)values[i]);
    return MPS_OK;
}

static int ascending(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

/* Sift down from index k of a heap of n, so that a parent is not less than its children. */
static void sink(int64_t *v, int64_t k, int64_t n)
{
    for (int64_t child; (child = 2 * k + 1) < n; k = child) {
        if (child + 1 < n && ascending(&v[child], &v[child + 1]) < 0) child++;
        if (v[k] >= v[child]) return;
        const int64_t keep = v[k];
        v[k] = v[child];
        v[child] = keep;
    }
}

/* Heap sort: qsort() may allocate memory outside of the handle's allocator. */
static void sort_ids(int64_t *v, int64_t n)
{
    for (int64_t k = n / 2; k-- > 0;) sink(v, k, n);
    for (int64_t end = n; end-- > 1;) {
        const int64_t keep = v[0];
        v[0] = v[end];
        v[end] = keep;
        sink(v, 0, end);
    }
}

static mps_status check_ids(mps__context *c, const mps__arrived *a)
{
    const int64_t *id = field(a, "id");
    bool sorted = true;
    for (int64_t i = 0; i < a->n; i++) {
        if (id[i] < 0 || id[i] >= a->next_id)
            DAMAGED("\"id\" of particle %lld is %lld; must be 0..%lld", (long long)i,
                    (long long)id[i], (long long)a->next_id - 1);
        sorted &= i == 0 || id[i] > id[i - 1];
    }
    if (sorted) return MPS_OK;
    int64_t *copy = mps__alloc(c, a->n, sizeof *copy), twice = -1;
    if (!copy) return MPS_E_NOMEM;
    memcpy(copy, id, (size_t)a->n * sizeof *copy);
    sort_ids(copy, a->n);
    for (int64_t i = 1; i < a->n && twice < 0; i++)
        if (copy[i] == copy[i - 1]) twice = copy[i];
    mps__free(c, copy);
    if (twice >= 0) DAMAGED("two particles have the \"id\" %lld", (long long)twice);
    return MPS_OK;
}

static mps_status check_reals(mps__context *c, const mps__arrived *a)
{
    const mps__particles *s = &a->sim->world.particles;
    for (int32_t k = 0; k < s->fields; k++) {
        const mps__field *f = &s->field[k];
        if (!a->field[k]) continue; /* not stored */
        if (f->size == sizeof(double) && strcmp(f->name, "id") != 0)
            MPS__TRY(check_within(c, f->name, a->field[k], a->n * f->components,
                                  f->data == &f->own ? DBL_MAX : most_of_all));
    }
    const double *density = field(a, "density");
    for (int64_t i = 0; i < a->n; i++) {
        const bool fluid = ((const int32_t *)field(a, "kind"))[i] == MPS_FLUID;
        if (density[i] < 0 || (fluid && density[i] <= 0))
            DAMAGED("\"density\" of particle %lld is %g; must be > 0", (long long)i, density[i]);
    }
    if (a->searched) MPS__TRY(check_finite(c, "searched", a->searched, a->n * s->dim));
    return MPS_OK;
}

/* Fluid must have a defined phase; a linked dummy must be linked to a wall. */
static mps_status check_links(mps__context *c, const mps__arrived *a)
{
    const int32_t *kind = field(a, "kind"), *phase = field(a, "phase"), *wall = field(a, "wall_of");
    for (int64_t i = 0; i < a->n; i++) {
        if (kind[i] == MPS_FLUID && !a->sim->world.setup.phase_defined[phase[i]])
            DAMAGED("particle %lld is of phase %d, which is not defined", (long long)i,
                    (int)phase[i]);
        if (a->linked && wall[i] >= 0 && (kind[i] != MPS_DUMMY || kind[wall[i]] != MPS_WALL))
            DAMAGED("\"wall_of\" of particle %lld is %d, which is no wall of a dummy", (long long)i,
                    (int)wall[i]);
    }
    return MPS_OK;
}

/* The set-up text was compared; the solids must match it. */
static mps_status check_solids(mps__context *c, const mps__arrived *a)
{
    const mps__particles *s = &a->sim->world.particles;
    const bool moved = mps__models_move_solids(&a->sim->world.models);
    const mps__solids here = mps__solids_of(s->n, s->dim, s->kind, s->part, moved ? NULL : s->ref);
    const mps__solids there = mps__solids_of(a->n, s->dim, field(a, "kind"), field(a, "part"),
                                             moved ? NULL : field(a, "ref"));
    if (there.count != here.count || there.checksum != here.checksum)
        DAMAGED("its solid particles (%lld) are not those of its set-up (%lld)",
                (long long)there.count, (long long)here.count);
    return MPS_OK;
}

mps_status mps__check_particles(mps__context *c, const mps__arrived *a)
{
    const mps__world *w = &a->sim->world;
    if (a->n > INT32_MAX) DAMAGED("it has %lld particles: at most %d", (long long)a->n, INT32_MAX);
    MPS__TRY(check_ids(c, a));
    MPS__TRY(check_tags(c, a, "kind", MPS_FLUID, MPS_DUMMY));
    MPS__TRY(check_tags(c, a, "phase", 0, MPS__PHASES - 1));
    MPS__TRY(check_tags(c, a, "part", -1, w->particles.parts - 1));
    MPS__TRY(check_tags(c, a, "region", MPS_REGION_INNER, MPS_REGION_DRY));
    MPS__TRY(check_held(c, a));
    MPS__TRY(check_tags(c, a, "wall_of", -1, a->n - 1));
    MPS__TRY(check_tags(c, a, "plate", 0, w->lists.occluders.count));
    if (a->linked < 0 || a->linked > 1 || a->listed < 0 || a->listed > a->linked)
        DAMAGED("\"lists\" are %d, %d; must be 0 or 1, the second only with the first",
                (int)a->linked, (int)a->listed);
    MPS__TRY(check_reals(c, a));
    MPS__TRY(check_links(c, a));
    return check_solids(c, a);
}

/* ---- series ---- */

static mps_status check_times(mps__context *c, int64_t probe, const double *t, int64_t count,
                              int64_t stride, double most)
{
    for (int64_t k = 0; k < count; k++)
        if (!(t[k * stride] <= most) || (k > 0 && !(t[k * stride] >= t[(k - 1) * stride])))
            DAMAGED("time %lld of probe %lld is %.9g; must ascend up to %.9g", (long long)k,
                    (long long)probe, t[k * stride], most);
    return MPS_OK;
}

mps_status mps__check_series(mps__context *c, const mps__arrived *a, int64_t probe,
                             const mps__series *s, int64_t waits)
{
    const double rate = a->sim->probes.list[probe].config.rate, slack = 1e-9 * (1 + a->state.t);
    if (waits < 0 || waits > 1)
        DAMAGED("\"waits\" of probe %lld is %lld; must be 0 or 1", (long long)probe,
                (long long)waits);
    if (waits && s->rows > 0)
        DAMAGED("probe %lld waits for its first row and has %lld", (long long)probe,
                (long long)s->rows);
    if (s->step < -1 || s->step > a->state.step)
        DAMAGED("the last step of probe %lld is %lld; must be -1..%lld", (long long)probe,
                (long long)s->step, (long long)a->state.step);
    if ((s->step >= 0) != (s->rows > 0))
        DAMAGED("probe %lld has %lld rows after step %lld", (long long)probe, (long long)s->rows,
                (long long)s->step);
    if (!(s->start >= 0 && s->start <= a->state.t))
        DAMAGED("probe %lld begins at %g s", (long long)probe, s->start);
    MPS__TRY(check_finite(c, "signal", s->row, s->rows * (1 + s->size)));
    MPS__TRY(check_finite(c, "times", s->t, s->count));
    MPS__TRY(check_finite(c, "samples", s->value, s->count * s->size));
    MPS__TRY(check_times(c, probe, s->row, s->rows, 1 + s->size, a->state.t));
    MPS__TRY(check_times(c, probe, s->t, s->count, 1, a->state.t + slack));
    const double due = s->rows > 0 ? s->row[(s->rows - 1) * (1 + s->size)] * rate : 0;
    if (s->next < 0 || (s->rows > 0 && !(fabs((double)s->next - due) <= SAMPLES)) ||
        s->count > s->next)
        DAMAGED("the next sample of probe %lld is number %lld, after %lld", (long long)probe,
                (long long)s->next, (long long)s->count);
    return MPS_OK;
}

/* ---- models ---- */

mps_status mps__check_numbers(mps__context *c, const mps_model_ops *ops, const mps__numbers *s)
{
    char why[200] = "";
    for (int64_t k = 0; k < s->count; k++)
        if (!isfinite(s->value[k]))
            DAMAGED("number %lld of model '%s' is %g; must be finite", (long long)k, ops->name,
                    s->value[k]);
    if (ops->check && ops->check(s->value, s->count, why, sizeof why) != 0)
        return mps__fail(c, MPS_E_VERSION,
                         "the numbers of model '%s' in the checkpoint do not fit: %.*s", ops->name,
                         (int)sizeof why - 1, why);
    return MPS_OK;
}

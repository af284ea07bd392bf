/* SPDX-License-Identifier: BSD-3-Clause */
/* Set-up of a simulation as text. */
#include "checkpoint.h"
#include "step.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { LINE = 256 };

/* Write one line. Numbers have all digits. */
static void line(mps__text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void line(mps__text *t, const char *format, ...)
{
    char text[LINE];
    va_list list;
    va_start(list, format);
    const int wanted = vsnprintf(text, sizeof text - 1, format, list),
              length = wanted < LINE - 2 ? wanted : LINE - 2;
    va_end(list);
    text[length] = '\n';
    if (t->data) memcpy(t->data + t->size, text, (size_t)length + 1);
    t->size += length + 1;
}

static void vector(mps__text *t, const char *name, const double *v)
{
    line(t, "%s %.17g %.17g %.17g", name, v[0], v[1], v[2]);
}

static void put_config(const mps_sim *sim, mps__text *t)
{
    const mps__world *w = &sim->world;
    line(t, "dimensions %d", (int)w->setup.dim);
    line(t, "dp %.17g", w->setup.dp_given);
    if (w->setup.dp != w->setup.dp_given) line(t, "dp of whole cells %.17g", w->setup.dp);
    line(t, "near radius %.17g", w->setup.re_near);
    line(t, "far radius %.17g", w->setup.re_far);
    vector(t, "gravity", w->setup.g);
    line(t, "velocity scale %.17g", w->setup.velocity_scale);
    line(t, "kernel %s",
         w->setup.kernel.id == MPS_KERNEL_IMPROVED   ? "improved"
         : w->setup.kernel.id == MPS_KERNEL_ORIGINAL ? "original"
                                                     : "custom");
    if (!w->setup.domain_given) return;
    vector(t, "domain from", w->setup.domain_min);
    vector(t, "domain to", w->setup.domain_max);
}

static void put_phases(const mps__world *w, mps__text *t)
{
    for (int a = 0; a < MPS__PHASES; a++) {
        if (!w->setup.phase_defined[a]) continue;
        line(t, "phase %d density %.17g", a, w->setup.phase_density[a]);
        line(t, "phase %d viscosity %.17g", a, w->setup.phase_viscosity[a]);
        for (int b = 0; b < a; b++)
            if (w->setup.tension[a * MPS__PHASES + b] >= 0)
                line(t, "tension of %d and %d %.17g", b, a, w->setup.tension[a * MPS__PHASES + b]);
    }
}

static void put_models(const mps__models *m, mps__text *t)
{
    for (int32_t k = 0; k < m->active; k++) {
        const mps_model_ops *ops = m->on[k].ops;
        line(t, "model %s", ops->name);
        for (int32_t s = 0; s < ops->setting_count; s++)
            line(t, "model %s %s %.17g", ops->name, ops->settings[s].key, m->on[k].k[s]);
    }
}

static void put_fields(const mps__particles *s, mps__text *t)
{
    for (int32_t k = 0; k < s->fields; k++)
        if (s->field[k].data == &s->field[k].own)
            line(t, "field %s of %d", s->field[k].name, (int)s->field[k].components);
}

mps__solids mps__solids_of(int64_t n, int32_t dim, const int32_t *kind, const int32_t *part,
                           const double *ref)
{
    mps__solids solids = {0, 0};
    for (int64_t i = 0; i < n; i++) {
        if (kind[i] == MPS_FLUID) continue;
        const int32_t what[2] = {kind[i], part[i]};
        const uint64_t tags = mps__checksum(0, what, sizeof what);
        solids.checksum += ref ? mps__checksum(tags, ref + i * dim, (size_t)dim * sizeof *ref)
                               : tags;
        solids.count++;
    }
    return solids;
}

static void put_solids(const mps_sim *sim, mps__text *t)
{
    const mps__particles *s = &sim->world.particles;
    const bool moved = mps__models_move_solids(&sim->world.models);
    const mps__solids solids = mps__solids_of(s->n, s->dim, s->kind, s->part,
                                              moved ? NULL : s->ref);
    for (int32_t k = 0; k < s->parts; k++) line(t, "part %s", s->part_name[k]);
    line(t, "solid particles %lld", (long long)solids.count);
    line(t, "checksum of their %s %llu", moved ? "parts" : "places",
         (unsigned long long)solids.checksum);
    line(t, "layers of dummies %d", (int)sim->world.setup.layers);
    for (int32_t k = 0; k < sim->world.lists.occluders.count; k++) {
        const mps__occluder *p = &sim->world.lists.occluders.list[k];
        vector(t, "plate at", p->corner);
        vector(t, "plate facing", p->normal);
        line(t, "plate of %.17g x %.17g", p->length[0], p->length[1]);
    }
}

static void put_probes(const mps__probes *p, mps__text *t)
{
    for (int64_t k = 0; k < p->count; k++) {
        const mps_probe *c = &p->list[k].config;
        if (p->list[k].removed) {
            line(t, "probe %lld removed", (long long)k);
            continue;
        }
        line(t, "probe %lld type %d", (long long)k, (int)c->type);
        line(t, "probe %lld at %.17g %.17g %.17g", (long long)k, c->at[0], c->at[1], c->at[2]);
        line(t, "probe %lld name %s", (long long)k, p->list[k].name);
        line(t, "probe %lld normal %.17g %.17g %.17g", (long long)k, c->normal[0], c->normal[1],
             c->normal[2]);
        line(t, "probe %lld along %.17g %.17g %.17g", (long long)k, c->direction[0],
             c->direction[1], c->direction[2]);
        line(t, "probe %lld diameter %.17g", (long long)k, c->diameter);
        line(t, "probe %lld length %.17g", (long long)k, c->length);
        line(t, "probe %lld part %s", (long long)k, p->list[k].part_name);
        line(t, "probe %lld phases %u", (long long)k, (unsigned)c->phases);
        line(t, "probe %lld drops %d", (long long)k, (int)c->count_drops);
        line(t, "probe %lld average %.17g", (long long)k, c->average);
        line(t, "probe %lld rate %.17g", (long long)k, c->rate);
    }
}

void mps__setup_text(const mps_sim *sim, mps__text *t)
{
    const mps__motion *m = &sim->world.motion;
    put_config(sim, t);
    for (int32_t k = 0; k < sim->notes; k++) line(t, "%s", sim->note[k]);
    put_phases(&sim->world, t);
    put_models(&sim->world.models, t);
    put_fields(&sim->world.particles, t);
    put_solids(sim, t);
    put_probes(&sim->probes, t);
    vector(t, "centre of motion", m->centre);
    line(t, "start %s", m->start == MPS_START_WITH_TANK ? "with the tank" : "at rest");
    line(t, "motion %s", mps__body_carries(&sim->world) ? "by a body" : m->fn ? "given" : "none");
    if (t->data) t->data[t->size] = 0;
    t->size++;
}

mps_status mps__setup_compare(mps__context *c, const char *saved, const char *here)
{
    while (*saved || *here) {
        const int a = (int)strcspn(saved, "\n"), b = (int)strcspn(here, "\n");
        if (a != b || memcmp(saved, here, (size_t)a) != 0)
            return mps__fail(c, MPS_E_ARG,
                             "the checkpoint has \"%.*s\" where this simulation has \"%.*s\": it "
                             "must be set up by the same calls",
                             a < 150 ? a : 150, saved, b < 150 ? b : 150, here);
        saved += a + (saved[a] == '\n');
        here += b + (here[b] == '\n');
    }
    return MPS_OK;
}

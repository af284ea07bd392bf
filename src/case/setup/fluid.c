/* SPDX-License-Identifier: BSD-3-Clause */
/* Fluids: water, air and those of the case. Phases are numbered by falling density, so that a gas
 * is the last. */
#include "build.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* [Pa s] of water, and default of other fluids */
#define WATER_VISCOSITY 1e-3

static const build_fluid KNOWN[] = {{"water", 1000, WATER_VISCOSITY, NAN, NULL},
                                    {"air", 1.29, 1.5e-5, NAN, NULL}};

static const build_fluid *find_known(const char *name)
{
    for (size_t i = 0; i < sizeof KNOWN / sizeof *KNOWN; i++)
        if (strcmp(KNOWN[i].name, name) == 0) return &KNOWN[i];
    return NULL;
}

/* No fluid has this name: propose the nearest name, ignoring letter case, or list all. */
static void refuse_name(build *b, const tree_node *at)
{
    const tree_node *fluids = mps__tree_find(b->root, "fluids");
    char names[BUILD_TEXT] = "";
    const char *nearest = NULL;
    size_t used = 0;
    int32_t best = INT32_MAX, distance;
    for (const tree_node *n = fluids ? fluids->first : NULL; n; n = n->next) {
        const bool same = strcasecmp(n->key, at->key) == 0;
        if (used < sizeof names)
            used += (size_t)snprintf(names + used, sizeof names - used, "%s, ", n->key);
        if (!same && !mps__words_near(at->key, n->key, &distance)) continue;
        if (same) distance = 0;
        if (distance < best) nearest = n->key;
        if (distance < best) best = distance;
    }
    if (nearest)
        mps__case_log(b->c, at, false, "no fluid has the name '%s'; did you mean '%s'?", at->key,
                      nearest);
    else
        mps__case_log(b->c, at, false,
                      "no fluid has the name '%s'; known are %swater and air; others are defined "
                      "by the key 'fluids'",
                      at->key, names);
}

static void read_fluid(build *b, const tree_node *at, build_fluid *f)
{
    const tree_node *own = mps__tree_find(mps__tree_find(b->root, "fluids"), at->key);
    const build_fluid *known = find_known(at->key);
    *f = known ? *known
               : (build_fluid){.density = NAN, .viscosity = WATER_VISCOSITY, .tension = NAN};
    f->at = at;
    snprintf(f->name, sizeof f->name, "%s", at->key);
    if (!own && !known) {
        refuse_name(b, at);
        return;
    }
    if (!own) return;
    f->density = mps__read_number(b->c, own, "density", f->density);
    f->viscosity = mps__read_number(b->c, own, "viscosity", f->viscosity);
    f->tension = mps__read_number(b->c, own, "tension", f->tension);
    if (mps__read_is(b->c, own, "viscosity", UNIT_KINEMATIC))
        f->viscosity = f->density * f->viscosity;
    if (isnan(f->density))
        mps__case_log(b->c, own, false,
                      "fluids.%s: 'density' is missing, e.g. 'density: 450 kg/m3'", at->key);
}

static int by_density(const void *a, const void *b)
{
    const build_fluid *f = a, *g = b;
    if (f->density != g->density) return f->density < g->density ? 1 : -1;
    return f->at->line != g->at->line ? (f->at->line < g->at->line ? -1 : 1)
                                      : (f->at->column < g->at->column ? -1 : 1);
}

static int32_t find_fluid(const build *b, const char *name)
{
    for (int32_t i = 0; i < b->fluids; i++)
        if (strcmp(b->fluid[i].name, name) == 0) return i;
    return -1;
}

int32_t mps__build_phase(build *b, const tree_node *at, const char *name)
{
    const int32_t phase = find_fluid(b, name);
    if (phase < 0)
        mps__case_log(b->c, at, false, "no fluid with the name '%s' is filled into the tank", name);
    return phase;
}

/* Whether 'use' adds a model that imps lacks for several fluids: the case compares imps with
 * mmps. */
static bool adds_for_several(const build *b)
{
    static const char *const slot[] = {"tension.", "gas.", "reference."};
    const tree_node *use = mps__tree_find(b->root, "use"),
                    *at = use && use->kind == TREE_LIST ? use->first : use;
    for (; at; at = at == use ? NULL : at->next)
        for (size_t i = 0; i < sizeof slot / sizeof *slot; i++)
            if (strncmp(at->text, slot[i], strlen(slot[i])) == 0) return true;
    return false;
}

void mps__build_fluids_read(build *b)
{
    const tree_node *fill = mps__tree_find(b->root, "fill"); /* with at least one fluid */
    for (const tree_node *item = fill->first; item; item = item->next) {
        const tree_node *at = item->first; /* of a map with one key */
        if (find_fluid(b, at->key) >= 0) continue;
        if (b->fluids == BUILD_FLUIDS) {
            mps__case_log(b->c, at, false, "more than %d fluids", BUILD_FLUIDS);
            return;
        }
        read_fluid(b, at, &b->fluid[b->fluids++]);
    }
    if (mps__case_failed(b->c)) return;
    qsort(b->fluid, (size_t)b->fluids, sizeof *b->fluid, by_density);
    snprintf(b->model, sizeof b->model, "%s",
             mps__read_text(b->c, b->root, "model", b->fluids > 1 ? "mmps" : "imps"));
    b->several = strncmp(b->model, "mmps", 4) == 0;
    const tree_node *model = mps__tree_find(b->root, "model");
    if (b->several && b->fluids < 2)
        mps__case_log(b->c, model, false,
                      "model: '%s' is for several fluids that fill the tank together; add "
                      "'- air: rest' to fill, or take imps",
                      b->model);
    if (!b->several && b->fluids > 1 && !adds_for_several(b))
        mps__case_log(b->c, model, false,
                      "model: '%s' is for one liquid, %d are filled in; mmps is for several; to "
                      "compare both, add 'use: reference.lid' or 'use: tension.csf'",
                      b->model, (int)b->fluids);
}

void mps__build_phases(build *b)
{
    for (int32_t i = 0; i < b->fluids && !mps__case_failed(b->c); i++) {
        const build_fluid *f = &b->fluid[i];
        mps_phase phase;
        mps_phase_init(&phase, sizeof phase);
        phase.density = f->density;
        phase.viscosity = f->viscosity;
        if (!mps__build_try(b, mps_phase_set(b->sim, i, &phase), f->at, f->name)) return;
    }
    for (int32_t i = 0; i < b->fluids;
         i++) /* the tension of a liquid acts against all lighter fluids */
        for (int32_t k = i + 1; k < b->fluids && !isnan(b->fluid[i].tension); k++)
            mps__build_try(b, mps_tension_set(b->sim, i, k, b->fluid[i].tension), b->fluid[i].at,
                           "tension");
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Free surface by number density alone, Z14 (15), Z14: Zhang, Wan & Hino 2014: n < beta n0, for
 * fluid and wall particles. Dry walls are on the surface too and have p = 0. */
#include "helpers.h"

enum { BETA, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [BETA] = {"beta", "n0", "On the surface: number density below this", MPS_TYPE_REAL, 0.97, 0.5,
              1.0}};

enum { NUMBER_DENSITY, REGION, USES };
static const mps_use uses[USES] = {
    [NUMBER_DENSITY] = {"number_density", MPS_USE_READ}, [REGION] = {"region", MPS_USE_WRITE}};

typedef struct fields {
    const double *number_density;
    int32_t *region;
} fields;

MPS_ROW void surface_row(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (mps_is_dummy(v, i)) return;
    if (f->number_density[i] < v->setting[BETA] * v->near.n0) f->region[i] = MPS_REGION_SURFACE;
}
MPS_ROWS(surface_rows, surface_row, fields)

static int find_surface(mps_stage *s)
{
    fields f = {.number_density = s->data[NUMBER_DENSITY], .region = s->data[REGION]};
    mps_stage_rows(s, &surface_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_CLASSIFY, .use_count = USES, .uses = uses, .run = find_surface, .device = 1}};

const mps_model_ops mps__surface_original = {
    .struct_size = sizeof(mps_model_ops),
    .api = MPS_MODEL_API,
    .name = "surface.original",
    .help = "Free surface by number density alone, Z14 (15)",
    .setting_count = SETTINGS,
    .settings = settings,
    .verb_count = 1,
    .verbs = verbs};

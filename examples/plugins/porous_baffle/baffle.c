/* SPDX-License-Identifier: BSD-3-Clause */
/* Porous baffle: a strip of the tank, from <= x < to in its frame, with the drag of Darcy and
 * Forchheimer,
 *   a = -k v,   k = darcy + forchheimer |v|,   v = u - u_tank.
 * The update is implicit, k/(1 + k dt) instead of k: stable for any dt. The baffle has no
 * particles; it reports its force on the fluid to the library, as the part "baffle". */
#include "baffle.h"
#include <math.h>
#include <mps/plugin.h>
#include <mps/reaction.h>

enum { FROM, TO, DARCY, FORCHHEIMER, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [FROM] = {"from", "m", "x where the baffle begins", MPS_TYPE_REAL, 0.0, -1e6, 1e6},
    [TO] = {"to", "m", "x where the baffle ends", MPS_TYPE_REAL, 0.0, -1e6, 1e6},
    [DARCY] = {"darcy", "1/s", "Drag proportional to the velocity", MPS_TYPE_REAL, 0.0, 0.0, 1e6},
    [FORCHHEIMER] = {"forchheimer", "1/m", "Drag proportional to its square", MPS_TYPE_REAL, 0.0,
                     0.0, 1e6}};

static const char *const parts[] = {"baffle"};

enum { VELOCITY, ACCELERATION, USES };
static const mps_use uses[USES] = {
    [VELOCITY] = {"velocity", MPS_USE_READ}, [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

typedef struct fields {
    const double *velocity;
    double *acceleration;
    double *drag; /* [n*dim] acceleration by the baffle */
} fields;

MPS_ROW void slow_down(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    double place[3], tank[3], speed2 = 0;
    const double *u = f->velocity + i * dim, *k = v->setting;
    if (v->kind[i] != MPS_FLUID) return;
    mps_view_tank(v, v->x + i * dim, place, tank);
    if (place[0] < k[FROM] || place[0] >= k[TO]) return;
    for (int d = 0; d < dim; d++) speed2 += (u[d] - tank[d]) * (u[d] - tank[d]);
    const double rate = k[DARCY] + k[FORCHHEIMER] * sqrt(speed2);
    for (int d = 0; d < dim; d++) {
        f->drag[i * dim + d] = -rate / (1 + rate * v->dt) * (u[d] - tank[d]);
        f->acceleration[i * dim + d] += f->drag[i * dim + d];
    }
}
MPS_ROWS(slow_down_rows, slow_down, fields)

static int drag_fluid(mps_stage *s)
{
    fields f = {.velocity = s->data[VELOCITY],
                .acceleration = s->data[ACCELERATION],
                .drag = mps_stage_scratch(s, s->view->n * s->view->dim)};
    if (!f.drag) return 1;
    mps_stage_rows(s, &slow_down_rows, &f);
    return mps_stage_reaction(s, parts[0], f.drag);
}

static const mps_verb verbs[] = {
    {.hook = MPS_FORCE, .use_count = USES, .uses = uses, .run = drag_fluid}};

const mps_model_ops baffle_porous = {.struct_size = sizeof(mps_model_ops),
                                     .api = MPS_MODEL_API,
                                     .name = "baffle.porous",
                                     .help = "Porous baffle: drag of Darcy and Forchheimer",
                                     .setting_count = SETTINGS,
                                     .settings = settings,
                                     .verb_count = 1,
                                     .verbs = verbs,
                                     .part_count = 1,
                                     .parts = parts};

/* As a plug-in of a case. */
mps_status mps_plugin(mps_registry *r)
{
    const mps_status status = mps_plugin_begin(r, "porous_baffle", "1.0");
    return status < 0 ? status : r->model(r->host, &baffle_porous);
}

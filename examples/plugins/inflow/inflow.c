/* SPDX-License-Identifier: BSD-3-Clause */
/* Inflow and outlet. A jet flows from an opening in the lab: a line across the jet in 2-D, a square
 * in 3-D. A row of particles with spacing dp leaves it each time the previous row has moved by dp:
 *   t_k = start + k dp/U,  k = 0, 1, ... while t_k < stop;  rate = U (n dp)^(D-1),
 * n the integer nearest to width/dp, U the speed. A row that was due within the last step starts at
 * its position after free fall. The opening is in air: it does not displace adjacent fluid. The
 * outlet is a box in the frame of the tank: fluid inside of it is removed. The number of rows so
 * far is a channel, so that checkpoints save it. Every particle has this number, because a scalar
 * channel lasts for one step only; its maximum is used. */
#include "inflow.h"
#include <mps/plugin.h>
#include <stdbool.h>

enum { X, Y, Z, U, V, W, WIDTH, START, STOP, PHASE, X0, Y0, Z0, X1, Y1, Z1, SETTINGS };
#define METRES(k, what)                             \
    {                                               \
        k, "m", what, MPS_TYPE_REAL, 0.0, -1e6, 1e6 \
    }
#define SPEED(k, what)                                    \
    {                                                     \
        k, "m/s", what, MPS_TYPE_REAL, 0.0, -500.0, 500.0 \
    }
static const mps_setting settings[SETTINGS] = {
    [X] = METRES("x", "Centre of the opening, in the lab"),
    [Y] = METRES("y", "Centre of the opening, in the lab"),
    [Z] = METRES("z", "Centre of the opening, in the lab"),
    [U] = SPEED("u", "Velocity of the jet; all 0: no jet"),
    [V] = SPEED("v", "Velocity of the jet; all 0: no jet"),
    [W] = SPEED("w", "Velocity of the jet; all 0: no jet"),
    [WIDTH] = {"width", "m", "Width of the opening", MPS_TYPE_REAL, 0.0, 0.0, 1e6},
    [START] = {"start", "s", "Time of the first row", MPS_TYPE_REAL, 0.0, -1e6, 1e6},
    [STOP] = {"stop", "s", "No row from then on", MPS_TYPE_REAL, 1e6, -1e6, 1e6},
    [PHASE] = {"phase", "-", "Phase that comes", MPS_TYPE_INTEGER, 0.0, 0.0, 15.0},
    [X0] = METRES("x0", "Lower corner of the outlet, in the tank"),
    [Y0] = METRES("y0", "Lower corner of the outlet, in the tank"),
    [Z0] = METRES("z0", "Lower corner of the outlet, in the tank"),
    [X1] = METRES("x1", "Upper corner of the outlet, in the tank"),
    [Y1] = METRES("y1", "Upper corner of the outlet, in the tank"),
    [Z1] = METRES("z1", "Upper corner of the outlet, in the tank")};

static const mps_channel channels[] = {{.name = "inflow_rows",
                                        .unit = "-",
                                        .help = "rows of the jet so far; the largest one counts",
                                        .components = 1,
                                        .type = MPS_TYPE_REAL,
                                        .life = MPS_LIFE_PARTICLE,
                                        .initial = 0.0}};

/* Maximum number of rows per step. */
enum { MOST_ROWS = 1000 };

/* Arrays of particles, and a number for all of them. */
typedef struct fields {
    double *rows;
    int32_t *leaves;
    double due;
} fields;

/* ---- MPS_POPULATE: the jet ------------------------------------------------------------------- */

static double speed_of(const mps_view *v)
{
    const double *u = v->setting + U;
    return sqrt(u[0] * u[0] + u[1] * u[1] + (v->dim == 3 ? u[2] * u[2] : 0));
}

/* Time at which row k leaves the opening. */
static double time_of(const mps_view *v, double k)
{
    return v->setting[START] + k * v->dp / speed_of(v);
}

/* Rows that are due at the time t. */
static double rows_due(const mps_view *v, double t)
{
    const double until = fmin(t, v->setting[STOP]);
    if (!(speed_of(v) > 0) || until < v->setting[START]) return 0;
    double k = ceil((until - v->setting[START]) * speed_of(v) / v->dp) + 1;
    while (k > 0 && !(time_of(v, k - 1) <= t && time_of(v, k - 1) < v->setting[STOP])) k--;
    return k;
}

MPS_ROW void raise(const int dim, const mps_view *v, const fields *f, int64_t i, double *most)
{
    (void)dim, (void)v;
    most[0] = mps_larger(most[0], f->rows[i]);
}
MPS_SUMS(raise_rows, raise, fields)

/* Particles in a line across the jet. */
static int64_t across(const mps_view *v)
{
    return (int64_t)floor(v->setting[WIDTH] / v->dp + 0.5);
}

/* Unit vectors across the jet; in 2-D the second one is 0. */
static void axes_across(const mps_view *v, double first[3], double second[3])
{
    const double s = speed_of(v);
    const double n[3] = {v->setting[U] / s, v->setting[V] / s, v->dim == 3 ? v->setting[W] / s : 0};
    const int least = fabs(n[0]) <= fabs(n[1]) ? 0 : 1; /* an axis that is not along the jet */
    double square = 0;
    for (int d = 0; d < 3; d++) {
        first[d] = (d == least) - n[d] * n[least];
        square += first[d] * first[d];
    }
    for (int d = 0; d < 3; d++) first[d] /= sqrt(square);
    for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, g = (d + 2) % 3;
        second[d] = v->dim == 3 ? n[e] * first[g] - n[g] * first[e] : 0;
    }
}

/* Positions and velocities of a row that left the opening tau ago. */
static void place_row(const mps_view *v, double tau, double *x, double *u)
{
    const int64_t n = across(v), lines = v->dim == 3 ? n : 1;
    double first[3], second[3];
    axes_across(v, first, second);
    for (int64_t k = 0; k < n * lines; k++) {
        const double a = ((double)(k % n) - 0.5 * (double)(n - 1)) * v->dp;
        const double b = ((double)(k / n) - 0.5 * (double)(lines - 1)) * v->dp;
        for (int d = 0; d < v->dim; d++) {
            const double speed = v->setting[U + d];
            x[k * v->dim + d] = v->setting[X + d] + a * first[d] + b * second[d] +
                                tau * (speed + 0.5 * tau * v->g[d]);
            u[k * v->dim + d] = speed + tau * v->g[d];
        }
    }
}

/* Rows from..to-1. */
static int add_rows(mps_stage *s, double from, double to)
{
    const mps_view *v = s->view;
    const int64_t n = across(v), count = v->dim == 3 ? n * n : n;
    double *x = mps_stage_scratch(s, 2 * count * v->dim);
    if (!x) return 1;
    if (to - from > MOST_ROWS)
        return mps_stage_fail(s,
                              "%g rows came since the last step, at most %d are allowed: set the "
                              "speed, %g m/s, lower, or 'start' to the present time",
                              to - from, MOST_ROWS, speed_of(v));
    for (double k = from; k < to; k++) {
        place_row(v, v->t - time_of(v, k), x, x + count * v->dim);
        if (mps_stage_add(s, (int32_t)v->setting[PHASE], count, x, x + count * v->dim)) return 1;
    }
    return 0;
}

enum { JET_ROWS, JET_USES };
static const mps_use jet_uses[JET_USES] = {[JET_ROWS] = {"inflow_rows", MPS_USE_READ}};

static int let_in(mps_stage *s)
{
    const mps_view *v = s->view;
    const fields f = {.rows = s->data[JET_ROWS]};
    const double due = rows_due(v, v->t);
    double come = 0;
    mps_stage_max(s, 1, &raise_rows, &f, &come);
    if (!(due > come) || across(v) < 1) return 0;
    return add_rows(s, come, due);
}

/* ---- MPS_POPULATE: the outlet ---------------------------------------------------------------- */

MPS_ROW void mark(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    double place[3];
    bool inside = v->kind[i] == MPS_FLUID;
    mps_view_tank(v, v->x + i * dim, place, NULL);
    for (int d = 0; d < dim; d++)
        inside = inside && place[d] > v->setting[X0 + d] && place[d] < v->setting[X1 + d];
    f->leaves[i] = inside;
}
MPS_ROWS(mark_rows, mark, fields)

static int let_out(mps_stage *s)
{
    const fields f = {.leaves = mps_stage_scratch_integers(s, s->view->n)};
    if (!f.leaves) return 1;
    mps_stage_rows(s, &mark_rows, &f);
    return mps_stage_remove(s, f.leaves);
}

/* ---- MPS_PREPARE: rows so far ---------------------------------------------------------------- */

enum { COUNT_ROWS, COUNT_USES };
static const mps_use count_uses[COUNT_USES] = {[COUNT_ROWS] = {"inflow_rows", MPS_USE_WRITE}};

MPS_ROW void count(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim, (void)v;
    f->rows[i] = f->due;
}
MPS_ROWS(count_rows, count, fields)

static int note_rows(mps_stage *s)
{
    const fields f = {.rows = s->data[COUNT_ROWS], .due = rows_due(s->view, s->view->t)};
    mps_stage_rows(s, &count_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_POPULATE, .use_count = JET_USES, .uses = jet_uses, .run = let_in},
    {.hook = MPS_POPULATE, .run = let_out},
    {.hook = MPS_PREPARE, .use_count = COUNT_USES, .uses = count_uses, .run = note_rows}};

const mps_model_ops inflow_jet = {.struct_size = sizeof(mps_model_ops),
                                  .api = MPS_MODEL_API,
                                  .name = "inflow.jet",
                                  .help = "Jet out of an opening, and a box where fluid leaves",
                                  .setting_count = SETTINGS,
                                  .settings = settings,
                                  .channel_count = 1,
                                  .channels = channels,
                                  .verb_count = 3,
                                  .verbs = verbs};

/* As a plug-in of a case. */
mps_status mps_plugin(mps_registry *r)
{
    const mps_status status = mps_plugin_begin(r, "inflow", "1.0");
    return status < 0 ? status : r->model(r->host, &inflow_jet);
}

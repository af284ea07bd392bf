/* SPDX-License-Identifier: BSD-3-Clause */
/* A plug-in with one item of each kind, for the tests of plug-ins in cases: a uniform drag, an
 * identity preconditioner, a load, a motion. */
#include <math.h>
#include <mps/plugin.h>
#include <string.h>

/* ---- a model ---- */

enum { RATE, SHARE, REACH, ANGLE, ON, LAYERS, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [RATE] = {"rate", "1/s", "Drag of the fluid", MPS_TYPE_REAL, 0.0, 0.0, 100.0},
    [SHARE] = {"share", "-", "Factor of the drag", MPS_TYPE_REAL, 1.0, 0.0, 1.0},
    [REACH] = {"reach", "mm", "x up to which it acts, 0: everywhere", MPS_TYPE_REAL, 0.0, 0.0, 1e6},
    [ANGLE] = {"angle", "deg", "Of no effect", MPS_TYPE_REAL, 0.0, -90.0, 90.0},
    [ON] = {"on", "-", "Whether it acts", MPS_TYPE_FLAG, 1.0, 0.0, 1.0},
    [LAYERS] = {"layers", "-", "Of no effect", MPS_TYPE_INTEGER, 2.0, 1.0, 5.0}};

enum { VELOCITY, ACCELERATION, USES };
static const mps_use uses[USES] = {
    [VELOCITY] = {"velocity", MPS_USE_READ}, [ACCELERATION] = {"acceleration", MPS_USE_CHANGE}};

typedef struct fields {
    const double *velocity;
    double *acceleration;
} fields;

MPS_ROW void slow_down(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    double place[3], tank[3];
    const double *k = v->setting;
    if (v->kind[i] != MPS_FLUID || k[ON] < 0.5) return;
    mps_view_tank(v, v->x + i * dim, place, tank);
    if (k[REACH] > 0 && place[0] > 1e-3 * k[REACH]) return;
    const double rate = k[RATE] * k[SHARE];
    for (int d = 0; d < dim; d++)
        f->acceleration[i * dim + d] -= rate / (1 + rate * v->dt) *
                                        (f->velocity[i * dim + d] - tank[d]);
}
MPS_ROWS(slow_down_rows, slow_down, fields)

static int drag_fluid(mps_stage *s)
{
    const fields f = {.velocity = s->data[VELOCITY], .acceleration = s->data[ACCELERATION]};
    mps_stage_rows(s, &slow_down_rows, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_FORCE, .use_count = USES, .uses = uses, .run = drag_fluid}};

static const mps_model_ops screen = {.struct_size = sizeof(mps_model_ops),
                                     .api = MPS_MODEL_API,
                                     .name = "screen.uniform",
                                     .help = "Uniform drag",
                                     .setting_count = SETTINGS,
                                     .settings = settings,
                                     .verb_count = 1,
                                     .verbs = verbs};

/* ---- a preconditioner ---- */

typedef struct identity {
    int64_t n;
} identity;

static int create(const mps_allocator *allocator, void **self)
{
    *self = allocator->alloc(allocator->user, sizeof(identity));
    return *self == NULL;
}

static int setup(void *self, const mps_ppe_problem *problem)
{
    ((identity *)self)->n = problem->n;
    return MPS_PPE_CONVERGED;
}

static int apply(void *self, const double *r, double *z)
{
    memcpy(z, r, (size_t)((identity *)self)->n * sizeof *z);
    return MPS_PPE_CONVERGED;
}

static void destroy(const mps_allocator *allocator, void *self)
{
    allocator->release(allocator->user, self);
}

static const mps_preconditioner_ops plain = {.struct_size = sizeof(mps_preconditioner_ops),
                                             .api = MPS_PPE_API,
                                             .name = "plain",
                                             .symmetric = 1,
                                             .create = create,
                                             .setup = setup,
                                             .apply = apply,
                                             .destroy = destroy,
                                             .help = "no preconditioner, as one",
                                             .ranks = 1};

/* ---- a load and a motion ---- */

static const mps_setting magnet_settings[] = {
    {"strength", "N", "Amplitude along x", MPS_TYPE_REAL, 5.0, 0.0, 1e3},
    {"period", "s", "Period", MPS_TYPE_REAL, 1.0, 0.1, 10.0}};

static double period_of(const double *setting)
{
    return setting[1];
}

static int magnet_load(void *user, const double *setting, double t, const mps_motion_state *state,
                       double load[6])
{
    (void)user, (void)state;
    load[0] = setting[0] * sin(2 * acos(-1.0) * t / setting[1]);
    return 0;
}

static const mps_drive_ops magnet = {.struct_size = sizeof(mps_drive_ops),
                                     .api = MPS_PLUGIN_API,
                                     .name = "magnet",
                                     .help = "Harmonic force along x",
                                     .setting_count = 2,
                                     .settings = magnet_settings,
                                     .load = magnet_load,
                                     .period = period_of};

static const mps_setting carriage_settings[] = {
    {"amplitude", "m", "Amplitude along x", MPS_TYPE_REAL, 0.005, 0.0, 1.0},
    {"period", "s", "Period", MPS_TYPE_REAL, 1.0, 0.1, 10.0}};

static int carriage_motion(void *user, const double *setting, double t, mps_motion_state *state)
{
    const double omega = 2 * acos(-1.0) / setting[1];
    (void)user;
    state->value[MPS_MOVE_X] = setting[0] * sin(omega * t);
    state->rate[MPS_MOVE_X] = setting[0] * omega * cos(omega * t);
    state->accel[MPS_MOVE_X] = -setting[0] * omega * omega * sin(omega * t);
    return 0;
}

static const mps_drive_ops carriage = {.struct_size = sizeof(mps_drive_ops),
                                       .api = MPS_PLUGIN_API,
                                       .name = "carriage",
                                       .help = "Harmonic motion along x",
                                       .setting_count = 2,
                                       .settings = carriage_settings,
                                       .motion = carriage_motion,
                                       .period = period_of};

mps_status mps_plugin(mps_registry *r)
{
    mps_status status = mps_plugin_begin(r, "screen", SCREEN_VERSION);
    if (status == MPS_OK) status = r->model(r->host, &screen);
    if (status == MPS_OK) status = r->preconditioner(r->host, &plain);
    if (status == MPS_OK) status = r->drive(r->host, &magnet);
    if (status == MPS_OK) status = r->drive(r->host, &carriage);
    return status;
}

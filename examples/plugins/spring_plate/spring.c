/* SPDX-License-Identifier: BSD-3-Clause */
/* A rigid body on a spring and a damper, which moves along one axis of a tank at rest:
 *   m a = F + f - k x - c u,   F = -sum p_i A_i  over its wall particles,
 * x its displacement, u = dx/dt, f a given force, e.g. its weight. The pressures of a step depend
 * on the motion in this step, so that F is known one step late. If the added mass exceeds the mass
 * of the body, a = (F + f - k x - c u)/m is unstable. With an estimate m_a of the added mass,
 *   a_new = (F + m_a a_old + f - k x - c u)/(m + m_a),   u += dt a_new,   x += dt u,
 * errors of one step are multiplied by (m_a - exact)/(m + m_a): stable if m_a > (exact - m)/2. The
 * solution does not depend on m_a if a changes slowly. The body is fixed until F is known.
 *
 * Particles of the body have 1 in the field "spring_member", which the caller writes. All of them
 * have the same numbers in "spring_motion". The body must be thicker than 3 dp: thin plates do not
 * move. */
#include "spring.h"
#include <stdbool.h>

enum { AXIS, MASS, STIFFNESS, DAMPING, FORCE, ADDED_MASS, SETTINGS };
static const mps_setting settings[SETTINGS] = {
    [AXIS] = {"axis", "-", "Axis of the motion: 0, 1, 2 for x, y, z", MPS_TYPE_INTEGER, 1.0, 0.0,
              2.0},
    [MASS] = {"mass", "kg", "Mass of the body, in 2-D per m", MPS_TYPE_REAL, 1.0, 1e-6, 1e12},
    [STIFFNESS] = {"stiffness", "N/m", "Stiffness of the spring", MPS_TYPE_REAL, 0.0, 0.0, 1e12},
    [DAMPING] = {"damping", "N s/m", "Coefficient of the damper", MPS_TYPE_REAL, 0.0, 0.0, 1e12},
    [FORCE] = {"force", "N", "Given force on the body", MPS_TYPE_REAL, 0.0, -1e12, 1e12},
    [ADDED_MASS] = {"added_mass", "kg", "Estimate of the mass of the water that moves along",
                    MPS_TYPE_REAL, 0.0, 0.0, 1e12}};

/* Components of "spring_motion". */
enum { DISPLACEMENT, SPEED, ACCELERATION, LOAD, LOADED, MOTION };

static const mps_channel channels[] = {
    {.name = "spring_member",
     .unit = "-",
     .help = "1: particle of the body",
     .components = 1,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_PARTICLE,
     .initial = 0.0},
    {.name = "spring_motion",
     .unit = "-",
     .help = "displacement, velocity, acceleration, force of the water, 1: it is known",
     .components = MOTION,
     .type = MPS_TYPE_REAL,
     .life = MPS_LIFE_PARTICLE,
     .initial = 0.0}};

/* Arrays of particles that the loops use. */
typedef struct fields {
    const double *member, *wall_pressure;
    double *motion, *place;
    double load;
} fields;

MPS_ROW bool is_member(const mps_view *v, const fields *f, int64_t i)
{
    return v->kind[i] != MPS_FLUID && f->member[i] > 0.5;
}

/* ---- MPS_LIMIT ------------------------------------------------------------------------------- */

/* Successive updates of u and x are stable below dt = 2/omega; a tenth of it is sufficiently
 * accurate. The explicit damper needs dt < 2 m/c. */
static int limit_step(mps_stage *s)
{
    const double *k = s->view->setting, mass = k[MASS] + k[ADDED_MASS];
    if (k[STIFFNESS] > 0) s->dt_limit = fmin(s->dt_limit, 0.2 * sqrt(mass / k[STIFFNESS]));
    if (k[DAMPING] > 0) s->dt_limit = fmin(s->dt_limit, 0.2 * mass / k[DAMPING]);
    return 0;
}

/* ---- MPS_MOTION ------------------------------------------------------------------------------ */

enum { MOVE_MEMBER, MOVE_MOTION, MOVE_PLACE, MOVE_USES };
static const mps_use move_uses[MOVE_USES] = {[MOVE_MEMBER] = {"spring_member", MPS_USE_READ},
                                             [MOVE_MOTION] = {"spring_motion", MPS_USE_CHANGE},
                                             [MOVE_PLACE] = {"solid_place", MPS_USE_CHANGE}};

MPS_ROW void move(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    const double *k = v->setting, mass = k[MASS] + k[ADDED_MASS];
    const int axis = (int)k[AXIS];
    double *m = f->motion + i * MOTION;
    if (!is_member(v, f, i) || m[LOADED] < 0.5) return;
    m[ACCELERATION] = (m[LOAD] + k[ADDED_MASS] * m[ACCELERATION] + k[FORCE] -
                       k[STIFFNESS] * m[DISPLACEMENT] - k[DAMPING] * m[SPEED]) /
                      mass;
    m[SPEED] += v->dt * m[ACCELERATION];
    m[DISPLACEMENT] += v->dt * m[SPEED];
    f->place[i * dim + axis] += v->dt * m[SPEED];
}
MPS_ROWS(move_rows, move, fields)

/* Raise most[0] to the speed. */
MPS_ROW void raise(const int dim, const mps_view *v, const fields *f, int64_t i, double *most)
{
    (void)dim;
    const double speed = fabs(f->motion[i * MOTION + SPEED]);
    if (is_member(v, f, i)) most[0] = speed <= most[0] ? most[0] : speed; /* NaN too */
}
MPS_SUMS(raise_rows, raise, fields)

static int move_body(mps_stage *s)
{
    const mps_view *v = s->view;
    const fields f = {.member = s->data[MOVE_MEMBER],
                      .motion = s->data[MOVE_MOTION],
                      .place = s->data[MOVE_PLACE]};
    double speed;
    if (v->setting[AXIS] >= v->dim)
        return mps_stage_fail(s, "'axis' is %g, in %d-D 0 to %d is allowed", v->setting[AXIS],
                              (int)v->dim, (int)v->dim - 1);
    mps_stage_rows(s, &move_rows, &f);
    mps_stage_max(s, 1, &raise_rows, &f, &speed);
    if (speed * v->dt > 0.5 * v->dp)
        return mps_stage_fail(
            s,
            "the body has %g m/s and would move by %g m in a step of %g s, at most "
            "dp/2 = %g m is allowed: see 'mass', 'added_mass' and 'force'",
            speed, speed * v->dt, v->dt, 0.5 * v->dp);
    return 0;
}

/* ---- MPS_LOAD -------------------------------------------------------------------------------- */

enum { LOAD_MEMBER, LOAD_PRESSURE, LOAD_MOTION, LOAD_USES };
static const mps_use load_uses[LOAD_USES] = {[LOAD_MEMBER] = {"spring_member", MPS_USE_READ},
                                             [LOAD_PRESSURE] = {"wall_pressure", MPS_USE_READ},
                                             [LOAD_MOTION] = {"spring_motion", MPS_USE_CHANGE}};

MPS_ROW void add_load(const int dim, const mps_view *v, const fields *f, int64_t i, double *sums)
{
    const int axis = (int)v->setting[AXIS];
    if (is_member(v, f, i) && v->kind[i] == MPS_WALL)
        sums[0] -= f->wall_pressure[i] * v->area[i * dim + axis];
}
MPS_SUMS(add_loads, add_load, fields)

MPS_ROW void keep_load(const int dim, const mps_view *v, const fields *f, int64_t i)
{
    (void)dim;
    if (!is_member(v, f, i)) return;
    f->motion[i * MOTION + LOAD] = f->load;
    f->motion[i * MOTION + LOADED] = 1;
}
MPS_ROWS(keep_loads, keep_load, fields)

static int load_body(mps_stage *s)
{
    fields f = {.member = s->data[LOAD_MEMBER],
                .wall_pressure = s->data[LOAD_PRESSURE],
                .motion = s->data[LOAD_MOTION]};
    mps_stage_sum(s, 1, &add_loads, &f, &f.load);
    mps_stage_rows(s, &keep_loads, &f);
    return 0;
}

static const mps_verb verbs[] = {
    {.hook = MPS_LIMIT, .run = limit_step},
    {.hook = MPS_MOTION, .use_count = MOVE_USES, .uses = move_uses, .run = move_body},
    {.hook = MPS_LOAD, .use_count = LOAD_USES, .uses = load_uses, .after = "*", .run = load_body}};

const mps_model_ops body_spring = {.struct_size = sizeof(mps_model_ops),
                                   .api = MPS_MODEL_API,
                                   .name = "body.spring",
                                   .help = "Rigid body on a spring, moved by the water",
                                   .setting_count = SETTINGS,
                                   .settings = settings,
                                   .channel_count = 2,
                                   .channels = channels,
                                   .verb_count = 3,
                                   .verbs = verbs};

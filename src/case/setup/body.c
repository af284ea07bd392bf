/* SPDX-License-Identifier: BSD-3-Clause */
/* `body`: a rigid body that moves with the liquid by coupling. Its degrees of freedom are those of
 * a ship, along axes parallel to those of the tank. */
#include "body.h"
#include "drive.h"
#include "pendulum.h"
#include "sensor_load.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double STEPS_A_PERIOD = 20;

/* ---- reading ---- */

static void read_mass(build *b, build_body *body, const tree_node *map)
{
    static const int place[6] = {0, 4, 8, 1, 2, 5}; /* xx yy zz xy xz yz, row by row */
    double I[6] = {0};
    mps_body_init(&body->body, sizeof body->body);
    body->body.mass = mps__read_number(b->c, map, "mass", 0);
    memcpy(body->body.centre_of_mass, body->axes.centre, sizeof body->axes.centre);
    mps__read_numbers(b->c, map, "centre_of_mass", 3, body->body.centre_of_mass);
    body->body.gravity = mps__read_flag(b->c, map, "gravity", true);
    const int32_t given = mps__read_numbers(b->c, map, "inertia", 6, I);
    if (b->dim == 2 && given > 1)
        mps__case_log(b->c, mps__tree_find(map, "inertia"), false,
                      "body.inertia: in 2-D it is one number, about z");
    if (b->dim == 3 && given > 0 && given != 3 && given != 6)
        mps__case_log(b->c, mps__tree_find(map, "inertia"), false,
                      "body.inertia: in 3-D it is three numbers, about x, y, z, or six, with xy, "
                      "xz, yz");
    if (b->dim == 2) {
        body->body.inertia[8] = I[0];
        return;
    }
    for (int k = 0; k < 6; k++) body->body.inertia[place[k]] = I[k];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < i; j++) body->body.inertia[3 * i + j] = body->body.inertia[3 * j + i];
}

/* Moment of inertia of a point mass about an axis of the library through the centre. */
static double about_centre(const build_motion *m, double mass, const double *place, int axis)
{
    double sum = 0;
    for (int d = 0; d < m->dim; d++) {
        const double r = place[d] - m->centre[d];
        if (d != axis) sum += mass * r * r;
    }
    return sum;
}

/* Stiffness of a rotation due to a weight: a weight above the centre destabilises. */
static double weight_stiffness(const build *b, const build_motion *m, double mass,
                               const double *place, int32_t dof)
{
    const bool tilts = dof == MPS_ROTATE_X || dof == MPS_ROTATE_Z;
    return tilts ? -mass * b->gravity * (place[1] - m->centre[1]) : 0;
}

static void log_error(build *b, const tree_node *node, const char *key, int32_t degree,
                      const char *text)
{
    mps__case_log(b->c, mps__tree_find(node, key), false, "body.%s.%s: %s", mps__degrees[degree],
                  key, text);
}

/* Stiffness and damping of a free degree of freedom. */
static void read_spring(build *b, build_body *body, const tree_node *node, int32_t degree)
{
    const double turn = 2 * acos(-1.0), mass = body->mass[degree];
    int32_t dof;
    double sign;
    mps__degree_to_lab(&body->axes, degree, &dof, &sign);
    const double weight = body->body.gravity ? weight_stiffness(b, &body->axes, body->body.mass,
                                                                body->body.centre_of_mass, dof)
                                             : 0;
    double spring = mps__read_number(b->c, node, "stiffness", 0);
    const double period = mps__read_number(b->c, node, "period", 0);
    if (period > 0 && !(mass > 0)) {
        log_error(b, node, "period", degree, "needs a mass, or an inertia; give a stiffness");
        return;
    }
    if (period > 0) spring = mass * turn * turn / (period * period) - weight;
    double damping = mps__read_number(b->c, node, "damping", 0);
    if (mps__read_is(b->c, node, "damping", UNIT_SHARE) && damping > 0) {
        if (!(mass > 0) || !(spring + weight > 0)) {
            log_error(b, node, "damping", degree,
                      "a share needs a mass and a stiffness that outweighs the body's weight; give "
                      "N s/m, or N m s/rad of a turn");
            return;
        }
        damping *= 2 * sqrt(mass * (spring + weight));
    }
    body->stiffness[degree] = spring + weight;
    body->damping[degree] = damping;
    body->body.free |= MPS_BODY_FREE(dof);
    body->body.stiffness[7 * dof] = spring;
    body->body.damping[7 * dof] = damping;
    body->friction[degree] = mps__read_number(b->c, node, "friction", 0);
    body->body.friction[dof] = body->friction[degree];
}

static void read_degree(build *b, build_body *body, const tree_node *map, int32_t degree)
{
    const tree_node *node = mps__tree_find(map, mps__degrees[degree]), *load;
    build_motion *axes = &body->axes;
    int32_t dof;
    double sign;
    if (!node || mps__case_failed(b->c)) return;
    axes->used[degree] = true;
    mps__degree_check(b, axes, node, degree);
    mps__degree_to_lab(axes, degree, &dof, &sign);
    body->mass[degree] = dof < MPS_ROTATE_X
                             ? body->body.mass
                             : body->body.inertia[4 * (dof - MPS_ROTATE_X)] +
                                   about_centre(axes, body->body.mass, body->body.centre_of_mass,
                                                dof - MPS_ROTATE_X);
    read_spring(b, body, node, degree);
    load = mps__tree_find(node, "load");
    if (load) body->load.used[degree] = true;
    if (load) mps__harmonics_read(b, &body->load, load, degree);
}

/* ---- loads ---- */

static int load_at(void *user, double t, const mps_motion_state *state, double load[6])
{
    const build_body *body = user;
    if (body->drive && mps__drive_load(body->drive, t, state, load) != 0) return 1;
    for (int32_t d = 0; d < MOTION_DEGREES; d++) {
        double q[3], sign;
        int32_t dof;
        if (!body->load.used[d]) continue;
        mps__harmonics_at(&body->load, d, t, q);
        mps__degree_to_lab(&body->axes, d, &dof, &sign);
        load[dof] += sign * (q[0] + mps__motion_table_at(&body->load, d, t));
    }
    return 0;
}

/* A table, a load of a plug-in, or both. */
static void read_table(build *b, build_body *body, const tree_node *map)
{
    bool used[MOTION_DEGREES];
    const bool file = mps__tree_find(map, "file") != NULL;
    body->drive = mps__drive_read(b, map, MPS_PLUGIN_LOAD);
    if (!file && !mps__tree_find(map, "plugin"))
        mps__case_log(b->c, map, false,
                      "body.load: give 'file', a table, or 'plugin', a load of a plug-in");
    if (!file) return;
    memcpy(used, body->load.used, sizeof used);
    memset(body->load.used, 0, sizeof used);
    body->load.of = "body.load";
    if (!mps__motion_file(b, &body->load, map)) return;
    for (int32_t d = 0; d < MOTION_DEGREES; d++) {
        if (body->load.used[d] && !body->axes.used[d])
            mps__case_log(b->c, mps__tree_find(map, "file"), false,
                          "body.load: %s is not free; give 'body.%s', or leave its column out",
                          mps__degrees[d], mps__degrees[d]);
        body->load.used[d] = body->load.used[d] || used[d];
    }
}

/* ---- all ---- */

/* A period of the body or of its load is resolved by so many steps. */
static double longest_step(const build *b, const build_body *body)
{
    double least = fmin(mps__shortest_period(&body->load), b->until);
    least = fmin(least, mps__drive_period(body->drive));
    for (int32_t d = 0; d < MOTION_DEGREES; d++)
        if (body->axes.used[d] && body->mass[d] > 0 && body->stiffness[d] > 0)
            least = fmin(least, 2 * acos(-1.0) * sqrt(body->mass[d] / body->stiffness[d]));
    return least / STEPS_A_PERIOD;
}

void mps__build_body(build *b)
{
    const tree_node *map = mps__tree_find(b->root, "body"), *table = mps__tree_find(map, "load");
    if (!map || mps__case_failed(b->c)) return;
    build_body *body = mps__build_alloc(b, sizeof *body);
    if (body)
        body->load.harmonic = mps__build_alloc(b, MOTION_HARMONICS * sizeof *body->load.harmonic);
    if (!body || !body->load.harmonic) return;
    b->until = mps__read_number(b->c, mps__tree_find(b->root, "run"), "until", NAN);
    body->axes.of = body->load.of = "body";
    body->load.load = true;
    mps__ship_read(b, &body->axes, map);
    read_mass(b, body, map);
    for (int32_t d = 0; d < MOTION_DEGREES; d++) read_degree(b, body, map, d);
    body->load.ship = body->axes.ship;
    body->load.dim = b->dim;
    body->load.has_forward = body->axes.has_forward;
    body->load.flipped = body->axes.flipped;
    if (table && !mps__case_failed(b->c)) read_table(b, body, table);
    if (!body->body.free && !mps__case_failed(b->c))
        mps__case_log(b->c, map, false,
                      "body: no degree is free; give surge, sway, heave, roll, pitch or yaw");
    if (mps__case_failed(b->c)) return;
    body->axes.dt_max = longest_step(b, body);
    body->body.load = load_at;
    body->body.user = body;
    if (!mps__build_try(b, mps_motion_centre_set(b->sim, body->axes.centre, MPS_START_AT_REST), map,
                        "body.centre") ||
        !mps__build_try(b, mps_body_set(b->sim, &body->body), map, "body"))
        return;
    b->motion = &body->axes;
    b->body = body;
}

/* ---- columns ---- */

typedef enum body_value {
    BODY_RATE,
    BODY_LIQUID,
    BODY_EXTERNAL,
    BODY_FRICTION,
    BODY_VALUES
} body_value;

/* A column, in the memory of the case. */
typedef struct body_column {
    body_value what;
    int32_t dof;
    double factor;
} body_column;

static double column_value(void *user, mps_sim *sim)
{
    const body_column *k = user;
    mps_body_report r;
    mps_body_report_init(&r, sizeof r);
    if (mps_body_get(sim, &r) < 0) return NAN;
    const double *from[BODY_VALUES] = {r.velocity, r.liquid, r.external, r.friction};
    return k->factor * from[k->what][k->dof];
}

static bool add_column(const sensing *s, int32_t degree, body_value what)
{
    static const char *const name[] = {"body_rate_", "body_liquid_", "body_external_",
                                       "body_friction_"},
                             *const about[] = {
                                 "Velocity of the body", "Load of the liquid on the body",
                                 "External load on the body", "Dry friction on the body"};
    static const char *const unit[2][2][BODY_VALUES] = {
        {{"m/s", "N/m", "N/m", "N/m"}, {"deg/s", "N m/m", "N m/m", "N m/m"}},
        {{"m/s", "N", "N", "N"}, {"deg/s", "N m", "N m", "N m"}}};
    const bool turn = degree >= MPS_SHIP_ROLL;
    char column[2 * BUILD_NAME], text[BUILD_TEXT];
    body_column *k = mps__build_alloc(s->b, sizeof *k);
    if (!k) return false;
    k->what = what;
    mps__degree_to_lab(s->b->motion, degree, &k->dof, &k->factor);
    if (turn && what == BODY_RATE) k->factor *= 180 / acos(-1.0);
    snprintf(column, sizeof column, "%s%s", name[what], mps__degrees[degree]);
    snprintf(text, sizeof text, "%s, %s: %saxes of the lab", about[what], mps__degrees[degree],
             turn                ? "about its centre, "
             : what == BODY_RATE ? "of its centre, "
                                 : "");
    return mps__sensor_value(s, column, unit[s->b->dim - 2][turn][what], text, column_value, k);
}

static double rubbed(void *user, mps_sim *sim)
{
    mps_body_report r;
    (void)user;
    mps_body_report_init(&r, sizeof r);
    return mps_body_get(sim, &r) < 0 ? NAN : r.rubbed;
}

void mps__body_columns(build *b)
{
    const sensing s = {b, mps__tree_find(b->root, "body"), false};
    bool rubs = false;
    if (!b->body || b->status < 0) return;
    for (int32_t d = 0; d < MOTION_DEGREES; d++)
        for (body_value what = BODY_RATE; b->motion->used[d] && what < BODY_VALUES; what++) {
            if (what == BODY_FRICTION && !(b->body->friction[d] > 0)) continue;
            rubs = rubs || what == BODY_FRICTION;
            if (!add_column(&s, d, what)) return;
        }
    if (rubs)
        mps__sensor_value(&s, "body_rubbed", b->dim == 3 ? "J" : "J/m",
                          "Energy lost by dry friction of the body: since the start", rubbed, NULL);
}

/* ---- natural periods ---- */

/* Frozen liquid from the tank, if the liquid is one fluid in a box. */
static bool box_frozen(const build *b, frozen *f)
{
    const form *t = &b->tank.form;
    pendulum p;
    if (!mps__pendulum_make(b, b->motion->centre, &p)) return false;
    f->mass = p.mass;
    for (int d = 0; d < b->dim; d++) f->place[d] = 0.5 * (t->lo[d] + t->hi[d]);
    f->place[1] = t->lo[1] + 0.5 * b->depth;
    for (int axis = 0; axis < 3; axis++) {
        double own = 0;
        for (int d = 0; d < b->dim; d++) {
            const double side = d == 1 ? b->depth : t->hi[d] - t->lo[d];
            if (d != axis) own += p.mass * side * side / 12;
        }
        f->inertia[axis] = own + about_centre(b->motion, p.mass, f->place, axis);
    }
    return true;
}

bool mps__body_frozen(const build *b, frozen *f)
{
    double h[3] = {b->dp, b->dp, b->dp};
    mps_lease x = {.struct_size = sizeof x}, kind = x, phase = x;
    *f = (frozen){.mass = 0};
    if (box_frozen(b, f)) return true;
    mps_lattice_get(b->sim, NULL, h);
    const double volume = h[0] * h[1] * (b->dim == 3 ? h[2] : 1);
    bool good = mps_lease_begin(b->sim, "position", MPS_READ, &x) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "kind", MPS_READ, &kind) == MPS_OK;
    good = good && mps_lease_begin(b->sim, "phase", MPS_READ, &phase) == MPS_OK;
    for (int64_t i = 0; good && i < x.count; i++) {
        double at[3] = {0};
        if (kind.integers[i] != MPS_FLUID) continue;
        const double mass = volume * b->fluid[phase.integers[i]].density;
        memcpy(at, x.data + i * x.stride, (size_t)b->dim * sizeof *at);
        f->mass += mass;
        for (int d = 0; d < 3; d++) {
            f->place[d] += mass * at[d];
            f->inertia[d] += about_centre(b->motion, mass, at, d);
        }
    }
    for (int d = 0; d < 3 && f->mass > 0; d++) f->place[d] /= f->mass;
    mps_lease_end(b->sim, &phase);
    mps_lease_end(b->sim, &kind);
    mps_lease_end(b->sim, &x);
    return good;
}

double mps__body_period(const build *b, int32_t degree, const frozen *liquid)
{
    const build_body *body = b->body;
    double mass = body->mass[degree], stiffness = body->stiffness[degree], sign;
    int32_t dof;
    mps__degree_to_lab(&body->axes, degree, &dof, &sign);
    if (liquid) {
        mass += dof < MPS_ROTATE_X ? liquid->mass : liquid->inertia[dof - MPS_ROTATE_X];
        stiffness += weight_stiffness(b, &body->axes, liquid->mass, liquid->place, dof);
    }
    return mass > 0 && stiffness > 0 ? 2 * acos(-1.0) * sqrt(mass / stiffness) : NAN;
}

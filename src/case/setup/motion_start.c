/* SPDX-License-Identifier: BSD-3-Clause */
/* The start of a motion: its effect on the liquid in the first steps, and how ramp, from and start
 * reduce it. */
#include "check.h"
#include <math.h>
#include <string.h>

enum { TEXT = 40, SAMPLES = 40 };

/* Warn of a tank whose velocity jumps by this fraction of the long-wave speed: for a table; for
 * harmonics, whose start is a jump by definition. */
static const double JUMP_OF_TABLE = 0.01, JUMP_OF_HARMONICS = 0.1;
/* For a tank at rest. */
static const double REST = 1e-4;
/* A surface whose deviation from the level is this fraction of the depth. */
static const double RISE = 0.01;
/* A table whose acceleration reaches this fraction of its largest one immediately, and pressures of
 * this fraction of those at rest. */
static const double SUDDEN = 0.5, PRESSURE = 0.1;

static double depth_of(const build *b)
{
    const form *t = &b->tank.form;
    return b->modes.count ? b->modes.depth : isfinite(b->depth) ? b->depth : t->hi[1] - t->lo[1];
}

/* Pressure due to a horizontal and a vertical acceleration [Pa]. A wall acts on half the length of
 * the tank, or in shallow liquid on 0.74 depths (Westergaard 1933). */
static double pressure_of(const build *b, const double a[2])
{
    const form *t = &b->tank.form;
    const double h = depth_of(b),
                 length = fmax(t->hi[0] - t->lo[0], b->dim == 3 ? t->hi[2] - t->lo[2] : 0);
    return b->fluid[0].density * (a[0] * fmin(0.5 * length, 0.74 * h) + a[1] * h);
}

/* Largest velocity and acceleration of the corners of the tank: horizontal, vertical. */
static void corners(const build *b, const mps_motion_pose *p, double velocity[2], double accel[2])
{
    const form *t = &b->tank.form;
    const double *w = p->omega, *l = p->alpha, *c = b->motion->centre;
    velocity[0] = velocity[1] = accel[0] = accel[1] = 0;
    for (int k = 0; k < 1 << b->dim; k++) {
        double X[3] = {0}, r[3] = {0}, v[3], a[3];
        for (int d = 0; d < b->dim; d++) X[d] = (k >> d & 1 ? t->hi[d] : t->lo[d]) - c[d];
        for (int n = 0; n < 9; n++) r[n / 3] += p->rotation[n] * X[n % 3];
        for (int d = 0; d < 3; d++) {
            const int e = (d + 1) % 3, f = (d + 2) % 3;
            v[d] = w[e] * r[f] - w[f] * r[e];
        }
        for (int d = 0; d < 3; d++) {
            const int e = (d + 1) % 3, f = (d + 2) % 3;
            a[d] = p->accel[d] + l[e] * r[f] - l[f] * r[e] + w[e] * v[f] - w[f] * v[e];
        }
        for (int d = 0; d < 3; d++) v[d] += p->velocity[d];
        velocity[0] = fmax(velocity[0], hypot(v[0], v[2]));
        velocity[1] = fmax(velocity[1], fabs(v[1]));
        accel[0] = fmax(accel[0], hypot(a[0], a[2]));
        accel[1] = fmax(accel[1], fabs(a[1]));
    }
}

static bool pose_at(build *b, double t, mps_motion_pose *pose)
{
    mps_motion_state state = {.struct_size = sizeof state};
    mps_motion_pose_init(pose, sizeof *pose);
    return mps_motion_state_at(b->sim, t, &state) == MPS_OK &&
           mps_motion_pose_from_state(&state, pose) == MPS_OK;
}

/* The first step [s]. */
static double first_step(const build *b, double speed)
{
    const mps_time_control *c = &b->time;
    const double scale = b->scale > 0 ? b->scale
                                      : sqrt((b->gravity > 0 ? b->gravity : 9.81) * b->dp);
    double dt = INFINITY;
    if (c->dt > 0) return c->dt;
    if (c->gravity > 0) dt = c->gravity * b->dp / scale;
    if (c->cfl > 0 && speed > 0) dt = fmin(dt, c->cfl * b->dp / speed);
    return c->dt_max > 0 ? fmin(dt, c->dt_max) : dt;
}

static const char *pressure_text(double p, char out[TEXT])
{
    if (p < 1e3)
        snprintf(out, TEXT, "%.3g Pa", p);
    else if (p < 1e6)
        snprintf(out, TEXT, "%.3g kPa", 1e-3 * p);
    else
        snprintf(out, TEXT, "%.3g MPa", 1e-6 * p);
    return out;
}

bool mps__motion_begin(build *b, motion_begin *s)
{
    mps_motion_pose p;
    double velocity[2], accel[2];
    *s = (motion_begin){.speed = 0};
    if (!pose_at(b, 0, &p)) return false;
    const double *up = p.rotation + 3; /* the vertical, in the axes of the tank */
    const form *t = &b->tank.form;
    corners(b, &p, velocity, accel);
    s->speed = hypot(velocity[0], velocity[1]);
    if (s->speed < REST * sqrt(b->gravity * depth_of(b))) s->speed = velocity[0] = velocity[1] = 0;
    s->step = first_step(b, s->speed);
    for (int k = 0; k < 2; k++) velocity[k] /= s->step;
    s->jump = pressure_of(b, velocity);
    s->tilt = acos(fmin(1, up[1]));
    for (int d = 0; d < b->dim; d += 2)
        s->rise += fabs(up[d]) / fmax(up[1], 1e-3) * 0.5 * (t->hi[d] - t->lo[d]);
    /* a table has no acceleration at its first row: use the first twentieth of a wave */
    const double span = b->modes.count ? 0.05 * b->modes.period[0] : 0;
    for (int i = 0; i <= SAMPLES && pose_at(b, fmin(b->until, span * i / SAMPLES), &p); i++) {
        double v[2], a[2];
        corners(b, &p, v, a);
        s->accel = fmax(s->accel, hypot(a[0], a[1]));
        s->push = fmax(s->push, pressure_of(b, a));
        if (b->motion->rows == 0) break;
    }
    return true;
}

/* Approximate upper bound of accelerations of the corners. */
static double most_accel(const build *b)
{
    double sum = 0;
    for (int32_t d = 0; d < MOTION_DEGREES; d++)
        sum += b->motion->largest[d][2] * (d < MPS_SHIP_ROLL ? 1 : mps__motion_reach(b, b->motion));
    return sum;
}

static void warn_of_jump(build *b, const motion_begin *s, const tree_node *at)
{
    const bool file = b->motion->rows > 0;
    const double wave = sqrt(b->gravity * depth_of(b)),
                 share = file ? JUMP_OF_TABLE : JUMP_OF_HARMONICS;
    const char *from = file ? "; 'from' begins at another time of the file" : "";
    char text[TEXT];
    if (b->motion->start == MPS_START_AT_REST && s->speed > share * wave && s->speed > 0)
        mps__case_log(b->c, at, true,
                      "motion: the tank begins with %.3g m/s and the liquid at rest: a jump, which "
                      "makes about %s in the first step of %.2g s; 'start: tank' gives the liquid "
                      "the velocity of the tank; 'ramp' lets the motion grow from rest%s",
                      s->speed, pressure_text(s->jump, text), s->step, from);
    else if (file && !b->motion->noisy && s->accel > SUDDEN * most_accel(b) &&
             s->push > PRESSURE * b->fluid[0].density * b->gravity * depth_of(b))
        mps__case_log(b->c, at, true,
                      "motion: the file begins with an acceleration of %.3g m/s2, which the spline "
                      "reaches within its first rows: pressures jump by about %s; 'ramp' lets the "
                      "motion grow from rest%s",
                      s->accel, pressure_text(s->push, text), from);
}

void mps__motion_start(build *b)
{
    motion_begin s;
    const tree_node *map = mps__tree_find(b->root, "motion"), *file = mps__tree_find(map, "file");
    if (!b->motion || b->body || b->fluids == 0 || !mps__motion_begin(b, &s)) return;
    warn_of_jump(b, &s, file ? file : map);
    if (s.rise <= RISE * depth_of(b) || !(b->gravity > 0)) return;
    mps__case_log(b->c, file ? file : map, true,
                  "motion: the tank begins with a tilt of %.3g deg, the liquid with the surface of "
                  "an upright tank: at the walls it is up to %.3g m off the level, and begins to "
                  "slosh; 'ramp' lets the tilt grow from 0%s",
                  s.tilt * 180 / acos(-1.0), s.rise,
                  file ? "; 'from' begins at another time of the file" : "");
}

/* ---- mps check ---- */

static double longest_ramp(const build_motion *m)
{
    double ramp = m->ramp;
    for (int32_t i = 0; i < m->count; i++) ramp = fmax(ramp, m->harmonic[i].ramp);
    return ramp;
}

void mps__check_write_start(const writer *w, build *b)
{
    const build_motion *m = b->motion;
    const double ramp = longest_ramp(m);
    const bool with_tank = m->start == MPS_START_WITH_TANK;
    char text[TEXT];
    motion_begin s;
    if (!mps__motion_begin(b, &s)) return;
    mps__check_heading(w, "start");
    if (m->rows > 0) fprintf(w->file, "t = 0 is %.6g s of the file; ", m->from);
    if (ramp > 0) fprintf(w->file, "the motion grows over %.4g s ('ramp'); ", ramp);
    if (s.speed == 0)
        fprintf(w->file, "tank and liquid begin at rest");
    else if (with_tank)
        fprintf(w->file, "tank and liquid begin with %.3g m/s ('start: tank')", s.speed);
    else
        fprintf(w->file,
                "the tank begins with %.3g m/s, the liquid at rest ('start: rest'): about %s in "
                "the first step, of %.2g s",
                s.speed, pressure_text(s.jump, text), s.step);
    if (s.speed == 0 && with_tank) fprintf(w->file, "; 'start: tank' changes nothing");
    if (m->rows == 0 && s.accel > 0)
        fprintf(w->file, "; acceleration from 0 to %.3g m/s2 at once: about %s", s.accel,
                pressure_text(s.push, text));
    if (s.tilt > 0) fprintf(w->file, "; tilt %.3g deg", s.tilt * 180 / acos(-1.0));
    fprintf(w->file, "\n");
}

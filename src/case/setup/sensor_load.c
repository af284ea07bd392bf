/* SPDX-License-Identifier: BSD-3-Clause */
/* Load of the liquid on the tank and acceleration of its centre, by degree of freedom of the ship:
 * from the momentum of the liquid, or from pressures on walls. */
#include "sensor_load.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Words of sensors.*.load. */
enum { LOAD_MOMENTUM, LOAD_WALLS };

/* One component, in the memory of the case. */
typedef struct part {
    double centre[3], sign;
    int32_t dof, probe; /* probe -1: by momentum */
    bool acceleration;
} part;

static double part_value(void *user, mps_sim *sim)
{
    const part *p = user;
    double read[MPS_DOF_COUNT];
    mps_load load;
    mps_load_init(&load, sizeof load);
    if (p->probe >= 0) {
        int32_t dim;
        mps_sim_shape(sim, &dim, NULL);
        const int32_t at = dim == 3 ? p->dof : p->dof == MPS_ROTATE_Z ? 2 : p->dof;
        return mps_probe_read(sim, p->probe, read) < 0 ? NAN : p->sign * read[at];
    }
    if (mps_load_get(sim, p->centre, &load) < 0) return NAN;
    return p->sign * (p->acceleration ? load.acceleration[p->dof] : load.force[p->dof]);
}

bool mps__degree_moves(const build_motion *m, int32_t degree, int32_t *dof, double *sign)
{
    mps__degree_to_lab(m, degree, dof, sign);
    if (m->dim == 3) return true;
    if (*dof != MPS_MOVE_X && *dof != MPS_MOVE_Y && *dof != MPS_ROTATE_Z) return false;
    /* without a bow both are along x */
    const bool sway = m->used[MPS_SHIP_SWAY];
    return m->has_forward || degree > MPS_SHIP_SWAY || (degree == MPS_SHIP_SWAY) == sway;
}

/* A column of a degree of freedom. */
static bool add_part(const sensing *s, const char *name, int32_t degree, const part *like)
{
    static const char *const unit[2][2][2] = {{{"N/m", "N m/m"}, {"m/s2", "rad/s2"}},
                                              {{"N", "N m"}, {"m/s2", "rad/s2"}}};
    build *b = s->b;
    char text[2 * BUILD_NAME], about[BUILD_TEXT];
    part *p = mps__build_alloc(b, sizeof *p);
    if (!p) return false;
    *p = *like;
    const bool turn = degree >= MPS_SHIP_ROLL;
    const char *what = turn ? "Moment" : "Force", *how = "by its momentum, mean of each step";
    if (p->probe >= 0) how = "by pressures on walls, no mean over time";
    snprintf(text, sizeof text, "%s_%s%s", name, p->acceleration ? "a_" : "", mps__degrees[degree]);
    if (p->acceleration)
        snprintf(about, sizeof about, "Acceleration of the tank, %s: at the centre of the load",
                 mps__degrees[degree]);
    else
        snprintf(about, sizeof about, "%s of the liquid on the tank, %s: %s", what,
                 mps__degrees[degree], how);
    return mps__sensor_value(s, text, unit[b->dim - 2][p->acceleration][turn], about, part_value,
                             p);
}

bool mps__load_columns(const sensing *s, const char *name, const double *centre, int32_t probe)
{
    build *b = s->b;
    for (int k = 0; k < (probe >= 0 ? 1 : 2); k++)
        for (int32_t d = 0; d < MOTION_DEGREES; d++) {
            part like = {.probe = probe, .acceleration = k == 1};
            memcpy(like.centre, centre, sizeof like.centre);
            if (!mps__degree_moves(b->motion, d, &like.dof, &like.sign)) continue;
            if (!add_part(s, name, d, &like)) return false;
        }
    return true;
}

/* A probe of all walls without a column of its own. @return false: there is a message */
static bool add_probe(const sensing *s, const double *centre, int32_t *id)
{
    char name[2 * BUILD_NAME];
    mps_probe probe;
    mps_probe_init(&probe, sizeof probe);
    probe.type = MPS_PROBE_FORCE;
    probe.average = 0;
    memcpy(probe.at, centre, sizeof probe.at);
    snprintf(name, sizeof name, "%s.walls", s->map->key);
    probe.name = name;
    return mps__build_try(s->b, mps_probe_add(s->b->sim, &probe, id), s->map, s->map->key);
}

void mps__sensor_load(const sensing *s)
{
    build *b = s->b;
    double centre[3];
    int32_t probe = -1;
    const int32_t how = mps__read_choice(b->c, s->map, "load", LOAD_MOMENTUM);
    if (!b->motion && b->c->known_errors) return; /* the motion has errors of its own */
    if (!b->motion) {
        mps__sensor_log(s, "load", "needs 'motion' or 'body', whose degrees name its columns");
        return;
    }
    memcpy(centre, b->motion->centre, sizeof centre);
    mps__read_numbers(b->c, s->map, "about", 3, centre);
    if (mps__case_failed(b->c)) return;
    const bool done = how == LOAD_WALLS ? add_probe(s, centre, &probe)
                                        : mps__build_try(b, mps_load_watch(b->sim, MPS_LOAD_FORCE),
                                                         s->map, s->map->key);
    if (done) mps__load_columns(s, s->map->key, centre, probe);
}

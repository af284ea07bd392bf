/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of measures. The members of mps_measure that an entry needs are listed at the end of
 * its help. */
#include "measure.h"
#include "values.h"
#include "view.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { INFO = sizeof(mps_measure_info), PARTICLES = MPS_JOB_PARTICLES };

static const measure_kind KINDS[] = {
    {.info = {INFO, 0, "front", "m", "m",
              "place of the front: how far liquid reaches from the left wall without a gap of two "
              "spacings; box"},
     .about = "Place of the front: how far liquid reaches from the left wall without a gap",
     .open = mps__open_front,
     .value = mps__measure_front},
    {.info = {INFO, 0, "centre", "m", "m",
              "centre of the particles of a phase along an axis; phase, axis"},
     .about = "Centre of the phase: mean place of its particles along ",
     .by_axis = true,
     .flags = PARTICLES,
     .value = mps__measure_centre},
    {.info = {INFO, 0, "speed", "m/s", "m/s",
              "mean velocity of the particles of a phase along an axis; phase, axis"},
     .about = "Velocity of the phase: mean of its particles along ",
     .by_axis = true,
     .flags = PARTICLES,
     .value = mps__measure_speed},
    {.info = {INFO, 0, "half_axis", "m", "m",
              "half axis of the ellipse with the second moment of a phase; phase, axis"},
     .about = "Half axis of the phase: of the ellipse with its second moment, along ",
     .by_axis = true,
     .flags = PARTICLES,
     .value = mps__measure_half_axis},
    {.info = {INFO, 0, "centre_of_mass", "m", "m",
              "centre of mass of all fluid along an axis; axis"},
     .about = "Centre of mass: of all fluid, along ",
     .by_axis = true,
     .value = mps__measure_mass_centre},
    {.info = {INFO, 2, "interface_top", "m", "m",
              "highest point of the interface between phase 0 and the others; box, smoothing"},
     .about = "Highest point of the interface: y",
     .flags = PARTICLES,
     .open = mps__open_interface,
     .value = mps__measure_top},
    {.info = {INFO, 2, "interface_bottom", "m", "m",
              "lowest point of the interface between phase 0 and the others; box, smoothing"},
     .about = "Lowest point of the interface: y",
     .flags = PARTICLES,
     .open = mps__open_interface,
     .value = mps__measure_bottom},
    {.info = {INFO, 2, "circularity", "", "",
              "circularity of all phases but 0: circumference of the circle of the same area over "
              "their own; box, smoothing"},
     .about = "Circularity: circumference of the circle of the same area over its own",
     .flags = PARTICLES,
     .open = mps__open_interface,
     .value = mps__measure_circularity},
    {.info = {INFO, 0, "trapped_gas", "m2", "m3",
              "volume of cavities that liquid encloses, with gas in them or not; box"},
     .about = "Volume of trapped air: of cavities that liquid encloses",
     .flags = PARTICLES,
     .open = mps__open_cavities,
     .value = mps__measure_cavities},
    {.info = {INFO, 0, "pockets", "", "",
              "number of pockets of trapped gas, of the model gas.pocket; none"},
     .about = "Pockets: number of voids with trapped gas",
     .value = mps__measure_pockets},
    {.info = {INFO, 0, "pocket_volume", "m2", "m3",
              "volume of all pockets of trapped gas, of the model gas.pocket; none"},
     .about = "Volume of pockets: of all voids with trapped gas",
     .value = mps__measure_pocket_volume},
    {.info =
         {INFO, 0, "pocket_pressure", "Pa", "Pa",
          "pressure of the pocket that is farthest from the ambient pressure, less that, of the "
          "model gas.pocket; none"},
     .about = "Pressure of pockets: of the one farthest from the ambient pressure, less that",
     .value = mps__measure_pocket_pressure},
    {.info = {INFO, 0, "gas_work", "J/m", "J",
              "work of trapped gas on the liquid since the start, of the model gas.pocket; none"},
     .about = "Work of trapped gas: on the liquid, since the start",
     .value = mps__measure_gas_work},
    {.info = {INFO, 0, "pressure_jump", "Pa", "Pa",
              "mean pressure within half a radius of a centre less that beyond 1.5 radii; centre, "
              "radius"},
     .about = "Pressure jump: mean within half the radius less that beyond 1.5 radii",
     .flags = MPS_JOB_PARTICLES | MPS_JOB_PRESSURE,
     .value = mps__measure_jump},
    {.info = {INFO, 0, "gap", "m", "m",
              "gap above a plane that moves with the tank: from it to the lowest fluid, less a "
              "spacing; level"},
     .about = "Gap above the floor: from the floor to the lowest liquid, less a spacing",
     .flags = PARTICLES,
     .value = mps__measure_gap},
    {.info = {INFO, 0, "angle", "deg", "deg",
              "angle of the tank about the z axis, counterclockwise; none"},
     .about = "Angle of the tank: about z, counterclockwise",
     .value = mps__measure_angle},
    {.info = {INFO, 0, "strays", "", "",
              "number of particles that strayed into another phase; none"},
     .about = "Strays: particles that strayed into another phase",
     .flags = PARTICLES,
     .value = mps__measure_strays},
    {.info = {INFO, 0, "trespass", "m", "m",
              "how far a phase reaches above a level, or another one below it; phase, level"},
     .about = "Trespass: how far a fluid reaches beyond the level",
     .flags = PARTICLES,
     .value = mps__measure_trespass},
};
enum { KIND_COUNT = sizeof KINDS / sizeof *KINDS };

mps_status mps_measure_init(mps_measure *measure, size_t size)
{
    if (!measure || size != sizeof *measure) return MPS_E_ARG;
    *measure = (mps_measure){.struct_size = sizeof *measure, .smoothing = 2};
    return MPS_OK;
}

mps_status mps_measure_info_init(mps_measure_info *info, size_t size)
{
    if (!info || size != sizeof *info) return MPS_E_ARG;
    *info = (mps_measure_info){.struct_size = sizeof *info};
    return MPS_OK;
}

mps_status mps_measure_info_get(int32_t index, mps_measure_info *info)
{
    if (!info || info->struct_size != sizeof *info || index < 0 || index >= KIND_COUNT)
        return MPS_E_ARG;
    *info = KINDS[index].info;
    return MPS_OK;
}

const measure_kind *mps__measure_find(const char *name)
{
    for (int k = 0; name && k < KIND_COUNT; k++)
        if (strcmp(KINDS[k].info.name, name) == 0) return &KINDS[k];
    return NULL;
}

static mps_status refuse(char *error, mps_status status, const char *name, const char *why)
{
    snprintf(error, QUANTITY_ERROR, "measure '%s': %s", name, why);
    return status;
}

/* @return NULL, or the error */
static const char *check(const mps_measure *m, const measure_kind *kind, int32_t dim)
{
    if (kind->info.dim == 2 && dim != 2) return "is for 2 dimensions";
    if (m->axis < 0 || m->axis >= dim) return "axis must be 0, 1 or, in 3-D, 2";
    if (m->phase < 0) return "phase must be 0 or more";
    if (!(m->smoothing >= 1 && m->smoothing <= 3)) return "smoothing must be 1 to 3 spacings";
    if (kind->value == mps__measure_jump && !(m->radius > 0)) return "radius must be > 0";
    for (int d = 0; d < dim; d++)
        if (!isfinite(m->box[d]) || !isfinite(m->box[3 + d]) || m->box[d] > m->box[3 + d])
            return "box must have lo <= hi";
    return NULL;
}

/* The box of the walls, if none is given. @return false: there are no walls */
static bool find_box(quantity *q, mps_sim *sim)
{
    view v;
    double *box = q->measure.box;
    bool given = false, found = false;
    for (int k = 0; k < 6; k++) given = given || box[k] != 0;
    if (given) return true;
    if (!mps__view_open(sim, &v)) return false;
    for (int64_t i = 0; i < v.x.count; i++) {
        if (v.kind.integers[i] != MPS_WALL) continue;
        for (int d = 0; d < q->dim; d++) {
            const double x = v.x.data[i * v.x.stride + d];
            box[d] = found ? fmin(box[d], x) : x;
            box[3 + d] = found ? fmax(box[3 + d], x) : x;
        }
        found = true;
    }
    return mps__view_close(sim, &v) && found;
}

mps_status mps__quantity_create(mps_sim *sim, const mps_measure *measure,
                                const mps_job_ranks *ranks, quantity **out, char *error)
{
    const measure_kind *kind = mps__measure_find(measure->measure);
    const char *name = measure->measure ? measure->measure : "";
    *out = NULL;
    if (!kind) return refuse(error, MPS_E_NAME, name, "there is none of this name");
    quantity *q = calloc(1, sizeof *q);
    if (!q) return refuse(error, MPS_E_NOMEM, name, "out of memory");
    q->kind = kind;
    q->measure = *measure;
    q->ranks = ranks && ranks->count > 1 ? ranks : NULL;
    mps_sim_shape(sim, &q->dim, &q->dp);
    const char *wrong = check(measure, kind, q->dim);
    mps_status status = MPS_OK;
    if (wrong) status = refuse(error, MPS_E_ARG, name, wrong);
    if (status == MPS_OK && kind->open && !find_box(q, sim))
        status = refuse(error, MPS_E_STATE, name, "there are no walls; give a box");
    if (status == MPS_OK && kind->open && (status = kind->open(q, sim)) != MPS_OK)
        refuse(error, status, name, "out of memory");
    if (status == MPS_OK && measure->change && !isfinite(q->start = kind->value(q, sim)))
        status = refuse(error, MPS_E_STATE, name, "has no value at the start");
    if (status == MPS_OK)
        *out = q;
    else
        mps__quantity_free(q);
    return status;
}

double mps__quantity_value(void *user, mps_sim *sim)
{
    quantity *q = user;
    return q->measure.change ? q->kind->value(q, sim) - q->start : q->kind->value(q, sim);
}

void mps__quantity_free(quantity *q)
{
    if (!q) return;
    mps__raster_free(&q->grid);
    mps__cavities_free(&q->gas);
    free(q->furthest);
    free(q);
}

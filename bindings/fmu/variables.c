/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of variables, and the token of a case. */
#include "variables.h"
#include <ctype.h>
#include <mps/mps.h>
#include <stdio.h>
#include <string.h>

/* Units of a kind: along an axis, about an axis; in 2-D per metre of width. */
static const struct {
    const char *name, *turned, *unit, *turned_unit, *plane_unit, *plane_turned_unit, *about,
        *turned_about;
} table[FMU_KINDS] = {
    [FMU_POSE] = {"pose", "angle", "m", "rad", "m", "rad",
                  "displacement of the centre at the end of the next step",
                  "angle at the end of the next step"},
    [FMU_VELOCITY] = {"velocity", "angle_rate", "m/s", "rad/s", "m/s", "rad/s",
                      "first derivative of the displacement", "first derivative of the angle"},
    [FMU_ACCELERATION] = {"acceleration", "angle_acceleration", "m/s2", "rad/s2", "m/s2", "rad/s2",
                          "second derivative of the displacement",
                          "second derivative of the angle"},
    [FMU_LOAD] = {"force", "moment", "N", "N.m", "N/m", "N.m/m",
                  "force of the liquid on the tank, mean over the last step",
                  "moment of the liquid about the centre, mean over the last step"},
    [FMU_REST] = {"rest_force", "rest_moment", "N", "N.m", "N/m", "N.m/m",
                  "force that the tank would feel without acceleration",
                  "moment that the tank would feel without acceleration"}};

static bool has(int32_t dim, int32_t dof)
{
    return dim == 3 || dof == MPS_MOVE_X || dof == MPS_MOVE_Y || dof == MPS_ROTATE_Z;
}

static void fill(int32_t dim, fmu_kind kind, int32_t dof, fmu_variable *v)
{
    const bool turns = dof >= MPS_ROTATE_X;
    *v = (fmu_variable){.reference = (uint32_t)((int32_t)kind * FMU_STRIDE + dof),
                        .kind = kind,
                        .dof = dof,
                        .input = kind >= FMU_POSE && kind <= FMU_ACCELERATION,
                        .name = "time",
                        .unit = "s",
                        .about = "time"};
    if (kind == FMU_TIME) return;
    snprintf(v->name, sizeof v->name, "%s.%c", turns ? table[kind].turned : table[kind].name,
             "xyz"[dof % 3]);
    v->unit = dim == 2 ? (turns ? table[kind].plane_turned_unit : table[kind].plane_unit)
                       : (turns ? table[kind].turned_unit : table[kind].unit);
    v->about = turns ? table[kind].turned_about : table[kind].about;
}

/* A name of FMI consists of letters, digits and '_', or is quoted. */
static bool is_plain(const char *name)
{
    if (isdigit((unsigned char)name[0])) return false;
    for (; *name; name++)
        if (!isalnum((unsigned char)*name) && *name != '_') return false;
    return true;
}

static bool fill_sensor(const fmu_model *m, int32_t number, fmu_variable *v)
{
    mps_job_column c;
    int32_t column = number; /* the importer prescribes the motion, whose columns are the first */
    mps_job_column_init(&c, sizeof c);
    for (int32_t k = 0; mps_job_column_get(m->job, k, &c) == MPS_OK && c.flags & MPS_JOB_MOTION;
         k++)
        column++;
    if (mps_job_column_get(m->job, column, &c) != MPS_OK) return false;
    *v = (fmu_variable){.reference = FMU_SENSORS + (uint32_t)number,
                        .kind = FMU_SENSOR,
                        .dof = column,
                        .later = (c.flags & MPS_JOB_PRESSURE) != 0,
                        .unit = c.unit,
                        .about = c.about};
    snprintf(v->name, sizeof v->name, is_plain(c.name) ? "sensor.%s" : "sensor.'%s'", c.name);
    return true;
}

bool fmu_variable_at(const fmu_model *m, int32_t index, fmu_variable *v)
{
    int32_t left = index - 1;
    if (index == 0) fill(m->dim, FMU_TIME, 0, v);
    for (fmu_kind kind = FMU_POSE; kind < FMU_KINDS && left >= 0; kind++)
        for (int32_t dof = 0; dof < MPS_DOF_COUNT && left >= 0; dof++)
            if (has(m->dim, dof) && left-- == 0) fill(m->dim, kind, dof, v);
    return index >= 0 && (left < 0 || fill_sensor(m, left, v));
}

bool fmu_variable_of(const fmu_model *m, uint32_t reference, fmu_variable *v)
{
    if (reference >= FMU_SENSORS)
        return reference - FMU_SENSORS <= INT32_MAX &&
               fill_sensor(m, (int32_t)(reference - FMU_SENSORS), v);
    for (int32_t i = 0; fmu_variable_at(m, i, v) && v->kind != FMU_SENSOR; i++)
        if (v->reference == reference) return true;
    return false;
}

/* Hash of 64 bits by Fowler, Noll and Vo, FNV-1a. */
static uint64_t hash(uint64_t h, const char *text)
{
    for (; *text; text++) h = (h ^ (unsigned char)*text) * 1099511628211u;
    return h;
}

void fmu_token(const char *text, char token[FMU_TOKEN])
{
    uint64_t h[2] = {14695981039346656037u, 14695981039346656037u ^ 0x5bd1e995u};
    for (int k = 0; k < 2; k++) {
        h[k] = hash(hash(h[k], mps_version(NULL, NULL, NULL)), text);
        for (fmu_kind kind = FMU_POSE; kind < FMU_KINDS; kind++)
            h[k] = hash(hash(h[k], table[kind].name), table[kind].turned);
        h[k] = hash(h[k], "sensor");
    }
    snprintf(token, FMU_TOKEN, "{%08x-%04x-%04x-%04x-%04x%08x}", (unsigned)(h[0] >> 32),
             (unsigned)(h[0] >> 16 & 0xffff), (unsigned)(h[0] & 0xffff), (unsigned)(h[1] >> 48),
             (unsigned)(h[1] >> 32 & 0xffff), (unsigned)(h[1] & 0xffffffff));
}

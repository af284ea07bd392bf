/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of units, and queries of it. */
#include "units.h"
#include <mps/case.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define PI 3.14159265358979323846

/* The first unit of a kind is used in examples. */
/* clang-format off */
static const mps__unit units[] = {
    {"m", UNIT_LENGTH, 0, 1, 1, SCALE_NONE}, {"cm", UNIT_LENGTH, -2, 1, 1, SCALE_NONE}, {"mm", UNIT_LENGTH, -3, 1, 1, SCALE_NONE},
    {"km", UNIT_LENGTH, 3, 1, 1, SCALE_NONE}, {"um", UNIT_LENGTH, -6, 1, 1, SCALE_NONE}, {"dp", UNIT_LENGTH, 0, 1, 1, SCALE_DP},
    {"s", UNIT_TIME, 0, 1, 1, SCALE_NONE}, {"ms", UNIT_TIME, -3, 1, 1, SCALE_NONE}, {"us", UNIT_TIME, -6, 1, 1, SCALE_NONE},
    {"min", UNIT_TIME, 0, 60, 1, SCALE_NONE}, {"h", UNIT_TIME, 0, 3600, 1, SCALE_NONE}, {"T1", UNIT_TIME, 0, 1, 1, SCALE_T1},
    {"deg", UNIT_ANGLE, 0, PI, 180, SCALE_NONE}, {"rad", UNIT_ANGLE, 0, 1, 1, SCALE_NONE},
    {"rad/s", UNIT_OMEGA, 0, 1, 1, SCALE_NONE}, {"deg/s", UNIT_OMEGA, 0, PI, 180, SCALE_NONE},
    {"rad/s2", UNIT_ANG_ACCEL, 0, 1, 1, SCALE_NONE}, {"deg/s2", UNIT_ANG_ACCEL, 0, PI, 180, SCALE_NONE},
    {"Hz", UNIT_FREQUENCY, 0, 1, 1, SCALE_NONE}, {"kHz", UNIT_FREQUENCY, 3, 1, 1, SCALE_NONE},
    {"mHz", UNIT_FREQUENCY, -3, 1, 1, SCALE_NONE},
    {"m/s", UNIT_VELOCITY, 0, 1, 1, SCALE_NONE}, {"cm/s", UNIT_VELOCITY, -2, 1, 1, SCALE_NONE},
    {"mm/s", UNIT_VELOCITY, -3, 1, 1, SCALE_NONE}, {"km/h", UNIT_VELOCITY, 0, 1, 3.6, SCALE_NONE},
    {"m/s2", UNIT_ACCEL, 0, 1, 1, SCALE_NONE}, {"mm/s2", UNIT_ACCEL, -3, 1, 1, SCALE_NONE},
    {"kg/m3", UNIT_DENSITY, 0, 1, 1, SCALE_NONE}, {"t/m3", UNIT_DENSITY, 3, 1, 1, SCALE_NONE},
    {"g/cm3", UNIT_DENSITY, 3, 1, 1, SCALE_NONE},
    {"Pa s", UNIT_DYNAMIC, 0, 1, 1, SCALE_NONE}, {"mPa s", UNIT_DYNAMIC, -3, 1, 1, SCALE_NONE}, {"uPa s", UNIT_DYNAMIC, -6, 1, 1, SCALE_NONE},
    {"cP", UNIT_DYNAMIC, -3, 1, 1, SCALE_NONE},
    {"m2/s", UNIT_KINEMATIC, 0, 1, 1, SCALE_NONE}, {"mm2/s", UNIT_KINEMATIC, -6, 1, 1, SCALE_NONE}, {"cSt", UNIT_KINEMATIC, -6, 1, 1, SCALE_NONE},
    {"N/m", UNIT_TENSION | UNIT_STIFFNESS, 0, 1, 1, SCALE_NONE}, {"mN/m", UNIT_TENSION, -3, 1, 1, SCALE_NONE},
    {"kN/m", UNIT_STIFFNESS, 3, 1, 1, SCALE_NONE}, {"MN/m", UNIT_STIFFNESS, 6, 1, 1, SCALE_NONE},
    {"N m/rad", UNIT_TURN_STIFFNESS, 0, 1, 1, SCALE_NONE}, {"kN m/rad", UNIT_TURN_STIFFNESS, 3, 1, 1, SCALE_NONE},
    {"MN m/rad", UNIT_TURN_STIFFNESS, 6, 1, 1, SCALE_NONE},
    {"N s/m", UNIT_DAMPING, 0, 1, 1, SCALE_NONE}, {"kN s/m", UNIT_DAMPING, 3, 1, 1, SCALE_NONE}, {"MN s/m", UNIT_DAMPING, 6, 1, 1, SCALE_NONE},
    {"N m s/rad", UNIT_TURN_DAMPING, 0, 1, 1, SCALE_NONE}, {"kN m s/rad", UNIT_TURN_DAMPING, 3, 1, 1, SCALE_NONE},
    {"MN m s/rad", UNIT_TURN_DAMPING, 6, 1, 1, SCALE_NONE},
    {"Pa", UNIT_PRESSURE, 0, 1, 1, SCALE_NONE}, {"hPa", UNIT_PRESSURE, 2, 1, 1, SCALE_NONE}, {"kPa", UNIT_PRESSURE, 3, 1, 1, SCALE_NONE},
    {"MPa", UNIT_PRESSURE, 6, 1, 1, SCALE_NONE}, {"mbar", UNIT_PRESSURE, 2, 1, 1, SCALE_NONE}, {"bar", UNIT_PRESSURE, 5, 1, 1, SCALE_NONE},
    {"kg", UNIT_MASS, 0, 1, 1, SCALE_NONE}, {"g", UNIT_MASS, -3, 1, 1, SCALE_NONE}, {"t", UNIT_MASS, 3, 1, 1, SCALE_NONE},
    {"kg m2", UNIT_INERTIA, 0, 1, 1, SCALE_NONE}, {"t m2", UNIT_INERTIA, 3, 1, 1, SCALE_NONE},
    {"N", UNIT_FORCE, 0, 1, 1, SCALE_NONE}, {"kN", UNIT_FORCE, 3, 1, 1, SCALE_NONE}, {"MN", UNIT_FORCE, 6, 1, 1, SCALE_NONE},
    {"N m", UNIT_MOMENT, 0, 1, 1, SCALE_NONE}, {"kN m", UNIT_MOMENT, 3, 1, 1, SCALE_NONE}, {"MN m", UNIT_MOMENT, 6, 1, 1, SCALE_NONE},
    {"N m/m", UNIT_LINE_MOMENT, 0, 1, 1, SCALE_NONE}, {"kN m/m", UNIT_LINE_MOMENT, 3, 1, 1, SCALE_NONE},
    {"MN m/m", UNIT_LINE_MOMENT, 6, 1, 1, SCALE_NONE},
    {"J", UNIT_ENERGY, 0, 1, 1, SCALE_NONE}, {"kJ", UNIT_ENERGY, 3, 1, 1, SCALE_NONE}, {"mJ", UNIT_ENERGY, -3, 1, 1, SCALE_NONE},
    {"J/m", UNIT_LINE_ENERGY, 0, 1, 1, SCALE_NONE}, {"kJ/m", UNIT_LINE_ENERGY, 3, 1, 1, SCALE_NONE}, {"mJ/m", UNIT_LINE_ENERGY, -3, 1, 1, SCALE_NONE},
    {"m2", UNIT_AREA, 0, 1, 1, SCALE_NONE}, {"m3", UNIT_VOLUME, 0, 1, 1, SCALE_NONE}, {"l", UNIT_VOLUME, -3, 1, 1, SCALE_NONE},
    {"%", UNIT_SHARE, -2, 1, 1, SCALE_WHOLE},
    {"MB", UNIT_BYTES, 6, 1, 1, SCALE_NONE}, {"kB", UNIT_BYTES, 3, 1, 1, SCALE_NONE}, {"GB", UNIT_BYTES, 9, 1, 1, SCALE_NONE},
};

static const char *const kind_names[UNIT_KINDS] = {
    "a number", "a length", "a time", "an angle", "an angular velocity", "a frequency", "a velocity", "an acceleration", "a density",
    "a dynamic viscosity", "a kinematic viscosity", "a surface tension", "a pressure", "a mass", "an inertia", "a stiffness", "a force",
    "a moment", "a share", "a number of bytes", "an angular acceleration", "a volume", "an area",
    "a damping", "a stiffness of a turn", "a damping of a turn", "a moment per length", "an energy", "an energy per length"};
/* clang-format on */

enum { UNITS = sizeof units / sizeof units[0] };

double mps_unit_factor(const char *from, const char *to)
{
    if (!from || !to) return NAN;
    if (strcmp(from, to) == 0) return 1;
    const mps__unit *a = mps__unit_find(from, strlen(from)), *b = mps__unit_find(to, strlen(to));
    if (!a || !b || !(a->kinds & b->kinds) || a->scale != b->scale) return NAN;
    return mps__unit_value(a) / mps__unit_value(b);
}

const mps__unit *mps__unit_get(int32_t index)
{
    return index >= 0 && index < UNITS ? &units[index] : NULL;
}

const char *mps__unit_si(uint64_t kinds)
{
    for (int k = 0; k < UNITS; k++) {
        const mps__unit *u = &units[k];
        if ((u->kinds & kinds) && u->scale == SCALE_NONE && mps__unit_value(u) == 1) return u->name;
    }
    return "";
}

/* Whether the name is that of the unit; "m/s^2" equals "m/s2", and several blanks equal one. */
static bool same(const char *name, size_t length, const char *unit)
{
    size_t i = 0;
    while (i < length && *unit) {
        if (name[i] == '^') {
            i++;
            continue;
        }
        if (name[i] != *unit) return false;
        i++;
        unit++;
        while (unit[-1] == ' ' && i < length && name[i] == ' ') i++;
    }
    return i == length && !*unit;
}

const mps__unit *mps__unit_find(const char *name, size_t length)
{
    for (int k = 0; k < UNITS; k++)
        if (same(name, length, units[k].name)) return &units[k];
    return NULL;
}

void mps__kinds_name(uint64_t kinds, char *out, size_t size)
{
    size_t used = 0;
    out[0] = '\0';
    if (kinds == UNIT_ANY) {
        snprintf(out, size, "a number with any unit");
        return;
    }
    for (int k = UNIT_KINDS - 1; k >= 0; k--) {
        if (!(kinds >> k & 1)) continue;
        const int more = snprintf(out + used, size - used, "%s%s", used ? " or " : "",
                                  kind_names[k]);
        if (more < 0 || used + (size_t)more >= size) return;
        used += (size_t)more;
    }
}

void mps__kinds_units(uint64_t kinds, char *out, size_t size)
{
    size_t used = 0;
    out[0] = '\0';
    for (int k = 0; k < UNITS; k++) {
        if (!(units[k].kinds & kinds)) continue;
        const int more = snprintf(out + used, size - used, "%s%s", used ? ", " : "", units[k].name);
        if (more < 0 || used + (size_t)more >= size) return;
        used += (size_t)more;
    }
}

/* Check one bound of a range, "> 0", ">= 1", "<= 5"; `at` moves past it. */
static bool bound_holds(const char **at, double value, bool sign_only)
{
    const bool above = **at == '>', closed = (*at)[1] == '=';
    double limit = 0;
    mps__numbers n = {.kinds = UNIT_ANY, .scale = {1, NAN, NAN, 1}, .most = 1, .out = &limit};
    char text[64];
    *at += closed ? 2 : 1;
    *at += strspn(*at, " ");
    snprintf(text, sizeof text, "%.*s", (int)strcspn(*at, ","), *at);
    *at += strcspn(*at, ",");
    *at += strspn(*at, ", ");
    n.text = text;
    if (!mps__numbers_read(&n) || (sign_only && limit != 0)) return true;
    if (above) return closed ? value >= limit : value > limit;
    return closed ? value <= limit : value < limit;
}

bool mps__range_holds(const char *range, double value, bool sign_only)
{
    const char *dots = strstr(range, " .. ");
    char text[80];
    if (dots) {
        snprintf(text, sizeof text, ">= %.*s, <= %s", (int)(dots - range), range, dots + 4);
        range = text;
    }
    while (*range == '>' || *range == '<')
        if (!bound_holds(&range, value, sign_only)) return false;
    return true;
}

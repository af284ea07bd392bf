/* SPDX-License-Identifier: BSD-3-Clause */
/* Converts texts of numbers with units to SI. */
#ifndef MPS_CASE_UNITS_H
#define MPS_CASE_UNITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Kinds of quantities, as bits. A unit may have several kinds: N/m is one of tension and of
 * stiffness. */
#define UNIT_NONE      (UINT64_C(1) << 0) /* a number without a unit */
#define UNIT_LENGTH    (UINT64_C(1) << 1)
#define UNIT_TIME      (UINT64_C(1) << 2)
#define UNIT_ANGLE     (UINT64_C(1) << 3)
#define UNIT_OMEGA     (UINT64_C(1) << 4)
#define UNIT_FREQUENCY (UINT64_C(1) << 5)
#define UNIT_VELOCITY  (UINT64_C(1) << 6)
#define UNIT_ACCEL     (UINT64_C(1) << 7)
#define UNIT_DENSITY   (UINT64_C(1) << 8)
#define UNIT_DYNAMIC   (UINT64_C(1) << 9)
#define UNIT_KINEMATIC (UINT64_C(1) << 10)
#define UNIT_TENSION   (UINT64_C(1) << 11)
#define UNIT_PRESSURE  (UINT64_C(1) << 12)
#define UNIT_MASS      (UINT64_C(1) << 13)
#define UNIT_INERTIA   (UINT64_C(1) << 14)
#define UNIT_STIFFNESS (UINT64_C(1) << 15)
#define UNIT_FORCE     (UINT64_C(1) << 16)
#define UNIT_MOMENT    (UINT64_C(1) << 17)
#define UNIT_SHARE     (UINT64_C(1) << 18)
#define UNIT_BYTES     (UINT64_C(1) << 19)
#define UNIT_ANG_ACCEL (UINT64_C(1) << 20)
#define UNIT_VOLUME    (UINT64_C(1) << 21)
#define UNIT_AREA      (UINT64_C(1) << 22)
#define UNIT_DAMPING   (UINT64_C(1) << 23)
/* rotational */
#define UNIT_TURN_STIFFNESS (UINT64_C(1) << 24)
#define UNIT_TURN_DAMPING   (UINT64_C(1) << 25)
/* per metre of length in 2-D */
#define UNIT_LINE_MOMENT (UINT64_C(1) << 26)
#define UNIT_ENERGY      (UINT64_C(1) << 27)
#define UNIT_LINE_ENERGY (UINT64_C(1) << 28)
#define UNIT_KINDS       29
#define UNIT_VISCOSITY   (UNIT_DYNAMIC | UNIT_KINEMATIC)
#define UNIT_ANY         ((UINT64_C(1) << UNIT_KINDS) - 1)

/* What a unit is relative to. */
typedef enum unit_scale { SCALE_NONE, SCALE_DP, SCALE_T1, SCALE_WHOLE } unit_scale;

typedef struct mps__unit {
    const char *name;
    uint64_t kinds;
    int32_t tens;       /* a power of ten, free of rounding errors */
    double times, over; /* SI: number * 10^tens * times / over */
    unit_scale scale;
} mps__unit;

/* A text of numbers to read, and the results. */
typedef struct mps__numbers {
    const char *text;
    uint64_t kinds;
    double scale[4]; /* by unit_scale; NAN: not known; [SCALE_NONE] is 1 */
    int32_t most;    /* capacity of `out` */
    double *out;
    const char *like; /* an example of a value, whose unit a message proposes; NULL: none */
    /* results */
    int32_t count;
    uint64_t found;      /* kinds that all units of the text have; all of `kinds` without a unit */
    bool relative;       /* a unit is dp, T1 or % */
    const char *missing; /* the unit whose scale is not known: its numbers are NAN; or NULL */
    char why[600];       /* the error */
} mps__numbers;

/* Read a list of numbers, "0 50 mm". A number without a unit has the unit of the next number that
 * has one. 0 needs none.
 * @return false: `why` is the error */
bool mps__numbers_read(mps__numbers *n);
/* Number `index` of a list with its unit, "50 mm", as a text.
 * @return false: there is none, or the buffer is too small */
bool mps__numbers_split(const char *text, int32_t index, char *buffer, size_t size);
/* Find a unit by name, with blanks as written; NULL: unknown. */
const mps__unit *mps__unit_find(const char *name, size_t length);
/* The SI value of this unit; of dp and T1: 1. */
double mps__unit_value(const mps__unit *unit);
/* The SI unit of these kinds, "" if there is none. */
const char *mps__unit_si(uint64_t kinds);
/* Unit number `index`, NULL after the last. */
const mps__unit *mps__unit_get(int32_t index);
/* "a length", "a time or a number" ... */
void mps__kinds_name(uint64_t kinds, char *out, size_t size);
/* All units of kinds, "m, cm, mm, km, dp". */
void mps__kinds_units(uint64_t kinds, char *out, size_t size);
/* Whether a value is in a range, "> 0", ">= 0", "1 .. 16", "> 0, <= 1". Numbers of ranges may have
 * units.
 * @param sign_only  check the sign of the value alone: bounds other than 0 are ignored */
bool mps__range_holds(const char *range, double value, bool sign_only);

#endif

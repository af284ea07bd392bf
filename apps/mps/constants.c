/* SPDX-License-Identifier: BSD-3-Clause */
#include "constants.h"
#include <math.h>
#include <stdio.h>

const char *quantity(double value, const char *unit)
{
    enum { TEXTS = 8, CAPACITY = 48 };
    static char text[TEXTS][CAPACITY];
    static int next;
    next = (next + 1) % TEXTS;
    mps_quantity_write(value, unit, text[next], CAPACITY);
    return text[next];
}

void print_quantity(int width, double value, const char *unit)
{
    const char *text = quantity(value, unit);
    int shown = 0; /* number of characters: a minus has three bytes */
    for (const char *c = text; *c; c++) shown += ((unsigned char)*c & 0xC0) != 0x80;
    printf(" %*s%s", width > shown ? width - shown : 0, "", text);
}

void print_time(int width, double t)
{
    char text[32];
    snprintf(text, sizeof text, "%.5g s", t);
    printf(" %*s", width, text);
}

void constants_begin(constants *k)
{
    mps_stats_config_init(&k->used, sizeof k->used);
    k->error[0] = '\0';
    k->used.error = k->error;
    k->used.error_size = sizeof k->error;
    k->run = k->used;
}

mps_status constants_read(constants *k, const choices *c, const char *folder)
{
    mps_status status = mps_stats_config_read(folder, &k->run);
    k->used = k->run;
    for (int32_t i = 0; i < c->sets && status == MPS_OK; i++)
        status = mps_stats_config_set(&k->used, c->set[i]);
    return status;
}

/* Whether the values differ, or only one of them is known. */
static bool differ(double a, double b)
{
    return isnan(a) || isnan(b) ? isnan(a) != isnan(b) : a != b;
}

/* Print each constant that differs from `before`, in a line that begins with `where`. */
static void print_others(const mps_stats_config *now, const mps_stats_config *before,
                         const char *where)
{
    mps_stats_constant a = {.struct_size = sizeof a}, b = a;
    const char *between = where;
    for (int32_t k = 0; mps_stats_constant_get(now, k, &a) == MPS_OK &&
                        mps_stats_constant_get(before, k, &b) == MPS_OK;
         k++) {
        if (!differ(a.value, b.value)) continue;
        char number[32]; /* as given: three digits would show a ratio of 1.025 as 1.02 */
        snprintf(number, sizeof number, "%.6g", a.value);
        printf("%s%s %s", between, a.key[0] ? a.key : a.about,
               a.unit[0] ? quantity(a.value, a.unit) : number);
        between = ", ";
    }
    if (between != where) printf("\n");
}

void constants_print(const constants *k, const choices *c, const char *folder)
{
    constants defaults;
    char where[400];
    constants_begin(&defaults);
    snprintf(where, sizeof where, "constants of the run in %.300s: ", folder);
    print_others(&k->run, &defaults.used, where);
    print_others(&k->used, &k->run, "constants by --set: ");
    if (k->used.sensors[0]) printf("sensors: %s\n", k->used.sensors);
    printf("%s\n", c->sets
                       ? "all others: defaults"
                       : "all others: defaults; --set impacts.threshold='6 kPa' changes one, an "
                         "edit of case.yaml does not");
}

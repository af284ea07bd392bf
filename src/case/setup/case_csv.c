/* SPDX-License-Identifier: BSD-3-Clause */
/* Tables of numbers that a case names: messages and units. */
#include "case_csv.h"
#include "units.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { UNITS_SIZE = 200, NAMES_SIZE = 400, UNIT_SIZE = 64 };

static bool report(mps_case *c, const tree_node *at, const mps__csv *t, mps__csv_error error)
{
    if (error == CSV_MEMORY)
        c->no_memory = true;
    else if (error != CSV_OK)
        mps__case_log(c, at, false, "%s", t->why);
    return error == CSV_OK;
}

bool mps__case_csv_open(mps_case *c, const tree_node *at, const char *path, mps__csv *t)
{
    return report(c, at, t, mps__csv_open(t, path, 0));
}

bool mps__case_csv_read(mps_case *c, const tree_node *at, mps__csv *t)
{
    if (!report(c, at, t, mps__csv_read(t))) return false;
    if (t->rows == 0) mps__case_log(c, at, false, "%s: has no numbers", t->path);
    return t->rows > 0;
}

int32_t mps__case_csv_find(mps_case *c, const tree_node *at, const mps__csv *t, const char *name,
                           bool needed)
{
    char names[NAMES_SIZE];
    const int32_t k = mps__csv_find(t, name);
    mps__csv_names(t, names, sizeof names);
    if (k == -2)
        mps__case_log(c, at, false, "%s: more than one column has the name '%s': %s", t->path, name,
                      names);
    else if (k == -1 && needed)
        mps__case_log(c, at, false, "'%s' is no column of %s, which has %s", name, t->path, names);
    return k < 0 ? -1 : k;
}

/* ---- units ---- */

/* Other spellings of a unit, or of its first characters, in the names of a table. */
static const struct {
    const char *written, *unit;
} others[] = {{"\xc2\xb0", "deg"}, /* degree sign, UTF-8 */
              {"\xc2\xba", "deg"}, /* masculine ordinal, which looks like it */
              {"\xb0", "deg"},     /* degree sign, Latin-1 */
              {"degrees", "deg"},  {"degree", "deg"}, {"deg", "deg"},
              {"radians", "rad"},  {"radian", "rad"}, {"rad", "rad"},
              {"seconds", "s"},    {"second", "s"},   {"sec", "s"}};

const mps__unit *mps__case_csv_unit(const char *text)
{
    char unit[UNIT_SIZE];
    const mps__unit *found = mps__unit_find(text, strlen(text));
    for (size_t k = 0; !found && k < sizeof others / sizeof *others; k++) {
        const size_t length = strlen(others[k].written);
        if (strncasecmp(text, others[k].written, length) != 0) continue;
        if (text[length] && text[length] != '/') continue;
        snprintf(unit, sizeof unit, "%s%s", others[k].unit, text + length);
        found = mps__unit_find(unit, strlen(unit));
    }
    return found;
}

static bool same_unit(const mps__unit *a, const mps__unit *b)
{
    return a->kinds == b->kinds && a->scale == b->scale &&
           fabs(mps__unit_value(a) - mps__unit_value(b)) <= 1e-12 * fabs(mps__unit_value(b));
}

/* Compare the units of the table and of the case. @return false: they differ */
static bool agree(mps_case *c, const tree_node *at, const mps__csv *t, int32_t column,
                  const char *unit)
{
    const mps__unit *in_case = mps__case_csv_unit(unit);
    const mps__unit *in_table = mps__case_csv_unit(t->unit[column]);
    if (!in_table || !in_case || same_unit(in_table, in_case)) return true;
    mps__case_log(c, at, false,
                  "%s: column '%s' has the unit '%s' in the table and '%s' in the case; give it "
                  "once, or the same twice",
                  t->path, t->name[column], t->unit[column], unit);
    return false;
}

/* List the units that a table may have: those of a kind, except dp, T1 and %. */
static void list_units(uint64_t kinds, char *out, size_t size)
{
    const mps__unit *u;
    size_t used = 0;
    out[0] = '\0';
    for (int32_t k = 0; (u = mps__unit_get(k)) != NULL; k++) {
        if (!(u->kinds & kinds) || u->scale != SCALE_NONE) continue;
        const int more = snprintf(out + used, size - used, "%s%s", used ? ", " : "", u->name);
        if (more < 0 || used + (size_t)more + 5 >= size) {
            snprintf(out + used, size - used, ", ..");
            return;
        }
        used += (size_t)more;
    }
}

double mps__case_csv_factor(mps_case *c, const tree_node *at, const mps__csv *t, int32_t column,
                            uint64_t kinds, const char *unit)
{
    char wanted[80], units[UNITS_SIZE];
    const char *text = unit ? unit : t->unit[column];
    const mps__unit *u = mps__case_csv_unit(text);
    mps__kinds_name(kinds, wanted, sizeof wanted);
    list_units(kinds, units, sizeof units);
    if (unit && !agree(c, at, t, column, unit)) return NAN;
    if (!text[0])
        mps__case_log(c, at, false,
                      "%s: column '%s' has no unit; write it behind the name, e.g. '%s[%.*s]', or "
                      "give 'units' in the case: %s is wanted, in %s",
                      t->path, t->name[column], t->name[column], (int)strcspn(units, ","), units,
                      wanted, units);
    else if (!u || !(u->kinds & kinds) || u->scale != SCALE_NONE)
        mps__case_log(c, at, false, "%s: column '%s' has the unit '%s', %s is wanted, in %s",
                      t->path, t->name[column], text, wanted, units);
    else
        return mps__unit_value(u);
    return NAN;
}

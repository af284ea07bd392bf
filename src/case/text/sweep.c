/* SPDX-License-Identifier: BSD-3-Clause */
/* `sweep`: paths and their values. A value is kept as a text, with its unit. */
#include "tree.h"
#include "units.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { VALUE_CAPACITY = 200, PATH_VALUES = 1000, SWEEP_RUNS = 100000 };

/* "a to b step c", in the unit of c. */
typedef struct steps {
    double from, step;
    int32_t count;
    char unit[40];
} steps;

/* Remove the words "to" and "step"; false: the text does not have both. */
static bool without_words(const char *text, char *numbers, size_t size)
{
    const char *to = strstr(text, " to "), *step = strstr(text, " step ");
    if (!to || !step || step < to) return false;
    return (size_t)snprintf(numbers, size, "%.*s %.*s %s", (int)(to - text), text,
                            (int)(step - to - 4), to + 4, step + 6) < size;
}

/* Read the numbers a, b, c as written: all have the unit at the end. */
static bool read_steps(const char *text, steps *s)
{
    char numbers[VALUE_CAPACITY], number[VALUE_CAPACITY];
    double value[3];
    if (!without_words(text, numbers, sizeof numbers)) return false;
    mps__numbers all = {.text = numbers, .kinds = UNIT_ANY, .most = 3, .out = value};
    if (!mps__numbers_read(&all) || all.count < 3) return false;
    for (int32_t k = 0; k < 3; k++) {
        mps__numbers_split(numbers, k, number, sizeof number);
        char *unit = strchr(number, ' ');
        if (k > 0 && strcmp(s->unit, unit ? unit : "") != 0) return false;
        if (snprintf(s->unit, sizeof s->unit, "%s", unit ? unit : "") >= (int)sizeof s->unit)
            return false;
        if (unit) *unit = '\0';
        mps__numbers n = {.text = number, .kinds = UNIT_NONE, .most = 1, .out = &value[k]};
        mps__numbers_read(&n);
    }
    const double count = floor((value[1] - value[0]) / value[2] + 1e-9) + 1;
    if (!(count >= 1 && count <= PATH_VALUES)) return false;
    s->from = value[0];
    s->step = value[2];
    s->count = (int32_t)count;
    return true;
}

static bool has_steps(const tree_node *node)
{
    return node->kind == TREE_TEXT && strstr(node->text, " to ");
}

/* Value number `index` of a path. @return false: there is none, or the buffer is too small */
static bool get_value(const tree_node *node, bool numbers, int32_t index, char *out, size_t size)
{
    steps s = {0};
    if (node->kind == TREE_LIST) {
        const tree_node *n = node->first;
        for (; n && index > 0; index--) n = n->next;
        return n && n->kind == TREE_TEXT && (size_t)snprintf(out, size, "%s", n->text) < size;
    }
    if (has_steps(node))
        return read_steps(node->text, &s) && index < s.count &&
               (size_t)snprintf(out, size, "%.12g%s", s.from + index * s.step, s.unit) < size;
    if (numbers) return mps__numbers_split(node->text, index, out, size);
    return index == 0 && (size_t)snprintf(out, size, "%s", node->text) < size;
}

static bool is_numbers(const mps__key *key)
{
    return key && key->shape == SHAPE_NUMBERS && key->many == 1;
}

static int32_t count_values(const tree_node *node)
{
    char value[VALUE_CAPACITY];
    const bool numbers = is_numbers(mps__key_at(node->key));
    int32_t count = 0;
    if (node->kind == TREE_MAP) return 0;
    while (count <= PATH_VALUES && get_value(node, numbers, count, value, sizeof value)) count++;
    return count;
}

/* Whether the text has numbers up to its end. */
static bool reads_as_numbers(mps_case *c, const tree_node *node, const mps__key *key)
{
    double value[PATH_VALUES];
    if (node->kind != TREE_TEXT || has_steps(node) || !is_numbers(key)) return true;
    mps__numbers all = {.text = node->text,
                        .kinds = key->units,
                        .most = PATH_VALUES,
                        .out = value,
                        .like = key->example};
    if (mps__numbers_read(&all)) return true;
    mps__case_log(c, node, false, "sweep: %s: %s", node->key, all.why);
    return false;
}

/* A sweep must not set plug-ins: it passes its values through the program, which would trust them
 * as its user's. */
static bool is_plugin(const char *path)
{
    return strncmp(path, "plugins", 7) == 0;
}

/* Check each value as if it were at its path. */
static void check_values(mps_case *c, const tree_node *node, const mps__key *key, int32_t count)
{
    char value[VALUE_CAPACITY];
    for (int32_t k = 0; k < count && !c->no_memory; k++) {
        tree_node *one = mps__tree_new(c, TREE_TEXT,
                                       (mps__place){node->source, node->line, node->column});
        if (!one || !get_value(node, is_numbers(key), k, value, sizeof value)) return;
        one->text = mps__case_copy(c, value, strlen(value));
        one->key = node->key;
        one->entry = key;
        one->units = key->units;
        if (one->text) mps__check_value(c, one);
    }
}

static bool can_sweep(const mps__key *key)
{
    return key && key->shape != SHAPE_MAP && key->shape != SHAPE_MAPS &&
           key->shape != SHAPE_PATHS && !mps__key_names(key);
}

static void refuse_path(mps_case *c, const tree_node *n)
{
    char near[64];
    const char *known = strchr(n->key, '.')
                            ? NULL
                            : mps__key_nearest(&mps__keys[0], n->key, near, sizeof near);
    if (known && strcmp(known, n->key) == 0) known = NULL; /* a map */
    mps__case_log_key(c, n, "sweep: '%.80s' is no path of a value%s%s%s", n->key,
                      known ? "; did you mean '" : ", as 'motion.roll.period'", known ? known : "",
                      known ? "'?" : "");
}

void mps__check_sweep(mps_case *c, tree_node *root)
{
    const tree_node *sweep = mps__tree_find(root, "sweep");
    double runs = 1;
    if (!sweep || sweep->kind != TREE_MAP) return;
    for (const tree_node *n = sweep->first; n; n = n->next) {
        const mps__key *key = mps__key_at(n->key);
        const int32_t count = count_values(n);
        if (is_plugin(n->key))
            mps__case_log_key(c, n,
                              "sweep: plug-ins cannot be varied; their settings can, e.g. "
                              "'settings.screen.darcy'");
        else if (!can_sweep(key))
            refuse_path(c, n);
        else if (count == 0 || count > PATH_VALUES)
            mps__case_log(
                c, n, false,
                "sweep: 1 to %d values are wanted, e.g. '0.8 0.9 T1' or '1 to 2 step 0.1 s'",
                PATH_VALUES);
        else if (reads_as_numbers(c, n, key))
            check_values(c, n, key, count);
        runs *= count;
    }
    if (runs > SWEEP_RUNS)
        mps__case_log_key(c, sweep, "sweep: %.0f runs, %d at most", runs, SWEEP_RUNS);
}

/* ---- calls ----------------------------------------------------------------------------------- */

static const tree_node *sweep_of(const mps_case *c)
{
    return c && c->text ? mps__tree_find(c->root, "sweep") : NULL;
}

int64_t mps_case_runs(const mps_case *c)
{
    const tree_node *sweep = sweep_of(c);
    int64_t runs = c && c->text ? 1 : 0;
    for (const tree_node *n = sweep ? sweep->first : NULL; n; n = n->next) runs *= count_values(n);
    return runs;
}

/* A parsed sweep has values in each list. */
static int64_t at_least_one(int32_t count)
{
    return count > 0 ? count : 1;
}

int32_t mps_case_sweep_count(const mps_case *c)
{
    const tree_node *sweep = sweep_of(c);
    return sweep ? sweep->count : 0;
}

mps_status mps_case_sweep_get(const mps_case *c, int64_t index, int32_t which, char *buffer,
                              size_t size)
{
    char value[VALUE_CAPACITY];
    const tree_node *sweep = sweep_of(c), *n = sweep ? sweep->first : NULL;
    if (!n || !buffer || index < 0 || which < 0 || index >= mps_case_runs(c)) return MPS_E_ARG;
    for (int32_t k = 0; n && k < which; k++) n = n->next;
    if (!n) return MPS_E_ARG;
    for (const tree_node *later = n->next; later; later = later->next)
        index /= at_least_one(count_values(later));
    const int64_t values = at_least_one(count_values(n));
    if (!get_value(n, is_numbers(mps__key_at(n->key)), (int32_t)(index % values), value,
                   sizeof value))
        return MPS_E_ARG;
    return (size_t)snprintf(buffer, size, "%s=%s", n->key, value) < size ? MPS_OK : MPS_E_ARG;
}

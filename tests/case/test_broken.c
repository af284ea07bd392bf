/* SPDX-License-Identifier: BSD-3-Clause */
/* Invalid cases, made from valid ones that have all keys: each key misspelled and duplicated, each
 * value with a wrong unit, out of its range and of a wrong type. Each must be refused at its
 * position, with a helpful message. */
#include "case_kit.h"
#include "units.h"

static const char *const files[] = {"box.yaml",     "polygon.yaml",     "cylinder.yaml",
                                    "sphere.yaml",  "stl.yaml",         "body.yaml",
                                    "plugins.yaml", "plugins_body.yaml"};
enum { FILES = sizeof files / sizeof files[0] };

static int32_t made;

/* The text with line `line`, from column `column` on, replaced. */
static char *edit(const char *text, int32_t line, int32_t column, const char *with)
{
    const size_t size = strlen(text) + strlen(with) + 400;
    char *out = malloc(size);
    assert_non_null(out);
    const char *at = text;
    for (int32_t k = 1; k < line; k++) at = strchr(at, '\n') + 1;
    at += column - 1;
    const char *end = at + strcspn(at, "\n");
    snprintf(out, size, "%.*s%s%s", (int)(at - text), text, with, end);
    return out;
}

static const char *line_from(const char *text, int32_t line, int32_t column)
{
    for (int32_t k = 1; k < line; k++) text = strchr(text, '\n') + 1;
    return text + column - 1;
}

static void refused(const char *text, const tree_node *n, bool key, const char *with,
                    const char *words)
{
    const int32_t column = key ? n->key_column : n->column;
    char *broken = edit(text, key ? n->key_line : n->line, column, with);
    kit_refused(broken, key ? n->key_line : n->line, column, words);
    free(broken);
    made++;
}

static void misspell(const char *text, const tree_node *n)
{
    const char *rest = line_from(text, n->key_line, n->key_column) + strlen(n->key);
    char with[400], words[100];
    const size_t length = strlen(n->key);
    if (length < 3) return;
    /* the letters before the last exchanged */
    snprintf(with, sizeof with, "%s%.*s", n->key, (int)strcspn(rest, "\n"), rest);
    with[length - 1] = n->key[length - 2];
    with[length - 2] = n->key[length - 1];
    if (with[length - 1] == with[length - 2]) with[length - 1] = 'q';
    snprintf(words, sizeof words, "unknown key|did you mean '");
    refused(text, n, true, with, words);
}

static void give_twice(const char *text, const tree_node *n)
{
    const char *line = line_from(text, n->key_line, n->key_column);
    char with[800], words[60];
    const int length = (int)strcspn(line, "\n");
    snprintf(with, sizeof with, "%.*s\n%*s%.*s", length, line, (int)n->key_column - 1, "", length,
             line);
    char *broken = edit(text, n->key_line, n->key_column, with);
    snprintf(words, sizeof words, "is given twice|line %d", (int)n->key_line);
    kit_refused(broken, n->key_line + 1, n->key_column, words);
    free(broken);
    made++;
}

/* A value outside of the range, in the first unit. */
static void leave_range(const char *text, const tree_node *n)
{
    static const double tries[] = {-1, 0, 1e12, 1.5};
    const mps__unit *u = NULL, *unit;
    if (n->entry->shape != SHAPE_NUMBERS || n->entry->few != 1) return;
    for (int32_t k = 0; (unit = mps__unit_get(k)) != NULL && !u; k++)
        if (unit->kinds & n->units) u = unit;
    for (size_t k = 0; k < sizeof tries / sizeof tries[0]; k++) {
        const double value = tries[k] * (u && !(n->units & UNIT_NONE) ? mps__unit_value(u) : 1);
        char with[60];
        if (n->entry->whole && tries[k] == 1.5) {
            refused(text, n, false, "1.5", "whole number");
            continue;
        }
        if (mps__range_holds(n->entry->range, value, false)) continue;
        snprintf(with, sizeof with, "%g %s", tries[k], u && !(n->units & UNIT_NONE) ? u->name : "");
        refused(text, n, false, with, "out of its range");
    }
}

static void break_value(const char *text, const tree_node *n)
{
    switch (n->entry->shape) {
    case SHAPE_NUMBERS:
        refused(text, n, false, "3 furlong", "'furlong' is no unit");
        refused(text, n, false, "several", "is no number");
        if (!(n->units & UNIT_NONE)) refused(text, n, false, "3", "has no unit|e.g. '3 ");
        if (!(n->units & UNIT_MASS)) refused(text, n, false, "3 kg", "is the unit of a mass");
        leave_range(text, n);
        break;
    case SHAPE_POINTS:
        refused(text, n, false, "[0 0 m]", "points");
        refused(text, n, false, "here", "a list of points is wanted");
        break;
    case SHAPE_WORD:
    case SHAPE_FLAG:
        refused(text, n, false, "furlong",
                n->entry->shape == SHAPE_WORD ? "is not known" : "yes or no");
        break;
    case SHAPE_UNIT:
        refused(text, n, false, "furlong", "is no unit here");
        break;
    case SHAPE_FILE:
        refused(text, n, false, "nowhere.csv", "cannot be read");
        break;
    default:
        break;
    }
    if (n->entry->shape != SHAPE_PATHS) refused(text, n, false, "{a: b}", "wanted");
    refused(text, n, false, "\"\"", "wanted");
    refused(text, n, false, "&x 1", "anchor");
}

static bool is_leaf(const tree_node *n)
{
    return n->entry && n->key && n->entry->shape >= SHAPE_NUMBERS;
}

static void break_all(const char *text, const tree_node *node, bool *seen)
{
    for (const tree_node *n = node->first; n; n = n->next) {
        if (n->entry) seen[n->entry - mps__keys] = true;
        const bool own = n->parent->entry && mps__key_names(n->parent->entry);
        if (is_leaf(n) && n->line == n->key_line) {
            const bool setting = strcmp(n->parent->key ? n->parent->key : "", "settings") == 0;
            /* settings have their ranges from libmps */
            if (setting) refused(text, n, false, "3 kg", "is the unit of a mass");
            if (setting) refused(text, n, true, "gas.soubd: 3", "did you mean");
            if (!setting) break_value(text, n);
            /* the first of a list of maps is after its dash */
            if (n->parent->parent && n->parent->parent->kind == TREE_LIST && n->parent->first == n)
                continue;
            give_twice(text, n);
        }
        if (!own && n->key && n->entry && n->key_line > 0 && n->kind != TREE_LIST &&
            n->entry->shape >= SHAPE_NUMBERS)
            misspell(text, n);
        break_all(text, n, seen);
    }
}

static void each_key(void **state)
{
    bool seen[400] = {true}; /* the root */
    (void)state;
    for (int f = 0; f < FILES; f++) {
        char path[400];
        mps_case *c = NULL;
        snprintf(path, sizeof path, CASES "%s", files[f]);
        char *text = kit_file(path);
        assert_int_equal(kit_read(text, NULL, &c), MPS_OK);
        break_all(text, c->root, seen);
        mps_case_destroy(c);
        free(text);
    }
    for (int32_t k = 0; k < mps__keys_count; k++) {
        const char *key = mps__keys[k].path;
        const bool merged = !strcmp(key, "base") || !strcmp(key, "set") || !strcmp(key, "sweep");
        if (!seen[k] && !merged) fail_msg("no case has the key '%s'", key);
    }
    print_message("%d broken cases\n", (int)made);
    assert_true(made >= 200);
}

/* What is no case at all. */
static void files_that_are_none(void **state)
{
    (void)state;
    kit_refused("", 1, 1, "nothing in it");
    kit_refused("# a comment\n", 1, 1, "nothing in it");
    kit_refused("just a text", 1, 1, "a map of keys is wanted");
    kit_refused("[1, 2]", 1, 1, "a map of keys is wanted");
    kit_refused("mps: 1\ntank:\n\tsize: 1 1 m\n", 3, 1, "a tab in the indentation");
    kit_refused("mps: 1\ntitle: a\xff"
                "b\n",
                2, 9, "byte 0xff|no text in UTF-8");
    kit_refused("mps: 1\ntitle: \x01\n", 2, 8, "byte 0x01");
    kit_refused("mps: 1\n---\nmps: 1\n", 2, 1, "a second document");
    kit_refused("%YAML 1.1\n---\nmps: 1\n", 1, 1, "a directive");
    kit_refused("mps: 1\ntitle: *a\n", 2, 8, "an alias");
    kit_refused("mps: 1\ntitle: &a x\n", 2, 8, "an anchor");
    kit_refused("mps: 1\ntitle: !!str x\n", 2, 8, "a tag");
    kit_refused("mps: 1\ntank: !box {size: 1 1 m}\n", 2, 7, "a tag");
    kit_refused("mps: 1\nfill: &a [x]\n", 2, 7, "an anchor");
    kit_refused("mps: 1\n<<: {dp: 1 m}\n", 2, 1, "a merge key");
    kit_refused("mps: 1\n? [a]\n: b\n", 2, 3, "a list as a key");
    kit_refused("mps: 1\ntitle: \"a\\0b\"\n", 2, 8, "byte 0");
    kit_refused("mps: 1\ntitle: \"open\n", 3, 1, "this is no YAML");
    kit_refused("mps: 1\ntank: {size: 1 1 m\n", 3, 1, "this is no YAML");
    kit_refused("mps: 1\nmps: 1\n", 2, 1, "given twice");
}

static void large_and_deep(void **state)
{
    const size_t size = 10 << 20;
    char *text = malloc(size + 1), *at = text;
    mps_case *c = NULL;
    (void)state;
    assert_non_null(text);
    memset(text, 'x', size);
    text[size] = '\0';
    kit_refused(text, 0, 0, "larger than 1 MB");
    at += sprintf(at, "mps: 1\ntitle: ");
    for (int k = 0; k < 40; k++) *at++ = '[';
    *at = '\0';
    kit_refused(text, 2, 8 + 31, "more than 32 levels");
    at = text + sprintf(text, "mps: 1\n");
    for (int k = 0; k < 1100; k++) at += sprintf(at, "k%d: 1\n", k);
    kit_refused(text, 1001, 1, "more than 1000 keys");
    at = text + sprintf(text, "use: [");
    for (int k = 0; k < 100100; k++) at += sprintf(at, "a,");
    sprintf(at, "]\n");
    kit_refused(text, 0, 0, "more than 100000 values");
    memset(text, '{', 1000000);
    text[1000000] = '\0';
    assert_int_equal(kit_read(text, NULL, &c), MPS_E_ARG);
    mps_case_destroy(c);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_key),
                                       cmocka_unit_test(files_that_are_none),
                                       cmocka_unit_test(large_and_deep)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

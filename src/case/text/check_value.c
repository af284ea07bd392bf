/* SPDX-License-Identifier: BSD-3-Clause */
/* Checking single values: numbers, points, texts, words. */
#include "tree.h"
#include "units.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void refuse(mps_case *c, const tree_node *node, const char *wanted)
{
    char path[PATH_CAPACITY];
    const mps__key *e = node->entry;
    mps__tree_path(node, path, sizeof path);
    if (node->kind == TREE_TEXT && node->text && *node->text)
        mps__case_log(c, node, false, "%s: '%.80s': %s is wanted, e.g. '%s'", path, node->text,
                      wanted, e->example);
    else
        mps__case_log(c, node, false, "%s: %s is wanted, not %s, e.g. '%s'", path, wanted,
                      node->kind == TREE_TEXT   ? "nothing"
                      : node->kind == TREE_LIST ? "a list"
                                                : "a map",
                      e->example);
}

/* ---- numbers --------------------------------------------------------------------------------- */

/* The elements of a list of texts, joined with blanks; of a text, the text. NULL: the list has
 * other elements, or memory is exhausted. */
static const char *joined(mps_case *c, const tree_node *node)
{
    size_t length = 1;
    if (node->kind == TREE_TEXT) return node->text;
    for (const tree_node *n = node->first; n; n = n->next) {
        if (n->kind != TREE_TEXT) return NULL;
        length += strlen(n->text) + 1;
    }
    char *text = node->kind == TREE_LIST ? mps__case_take(c, length) : NULL;
    size_t used = 0;
    for (const tree_node *n = node->first; text && n; n = n->next)
        used += (size_t)snprintf(text + used, length - used, "%s ", n->text);
    return text;
}

/* How many numbers are required. A case may be run in 2-D and in 3-D, so a position may have its
 * third number in 2-D too. */
static void expect_count(const mps__key *e, int32_t *few, int32_t *many)
{
    const bool place = e->shape == SHAPE_POINTS || e->few == COUNT_DIM;
    *few = place ? 2 : e->few;
    *many = place ? 3 : e->many;
}

static bool right_count(mps_case *c, const tree_node *node, const mps__numbers *n, int32_t few)
{
    char path[PATH_CAPACITY];
    if (n->count >= few) return true;
    mps__case_log(c, node, false, "%s: %d number%s, %d are wanted, e.g. '%s'",
                  mps__tree_path(node, path, sizeof path), (int)n->count, n->count == 1 ? "" : "s",
                  (int)few, node->entry->example);
    return false;
}

/* @return false: a number is outside its range */
static bool in_range(mps_case *c, const tree_node *node, const mps__numbers *n)
{
    const mps__key *e = node->entry;
    char path[PATH_CAPACITY];
    for (int32_t k = 0; k < n->count; k++) {
        if (e->whole && n->out[k] != floor(n->out[k])) {
            mps__case_log(c, node, false, "%s: '%s': a whole number is wanted",
                          mps__tree_path(node, path, sizeof path), node->text);
            return false;
        }
        if (isnan(n->out[k]) || mps__range_holds(e->range, n->out[k], n->relative)) continue;
        if (strcmp(e->path, "mps") == 0) /* the range of `mps` lists versions */
            mps__case_log(c, node, false,
                          "mps: version %.20s is out of its range: this program reads version %s",
                          n->text, e->example);
        else
            mps__case_log(c, node, false, "%s: '%.80s' is out of its range: %s",
                          mps__tree_path(node, path, sizeof path), n->text, e->range);
        return false;
    }
    return true;
}

int32_t mps__node_numbers(mps_case *c, const tree_node *node, int32_t most, double *out,
                          uint64_t *found)
{
    char path[PATH_CAPACITY], kind[120];
    const char *text = joined(c, node);
    if (!text) {
        if (c->no_memory) return -1;
        mps__kinds_name(node->units, kind, sizeof kind);
        refuse(c, node, kind);
        return -1;
    }
    mps__numbers n = {.text = text,
                      .kinds = node->units,
                      .scale = {1, c->scale.dp, c->scale.T1, c->scale.whole},
                      .most = most,
                      .out = out,
                      .like = node->entry->example};
    int32_t few, many;
    expect_count(node->entry, &few, &many);
    if (n.most > many) n.most = many;
    if (!mps__numbers_read(&n)) {
        mps__case_log(c, node, false, "%s: %s", mps__tree_path(node, path, sizeof path), n.why);
        return -1;
    }
    if (found) *found = n.found;
    if (!right_count(c, node, &n, few) || !in_range(c, node, &n)) return -1;
    if (n.missing && strcmp(node->entry->path, "dp") == 0) {
        mps__case_log(c, node, false,
                      "dp: 'dp' is not known here; a length is wanted, e.g. '4 mm'");
        return -1;
    }
    return n.count;
}

static void check_numbers(mps_case *c, tree_node *node)
{
    int32_t least, many;
    expect_count(node->entry, &least, &many);
    double few[8], *values = few;
    if (many > 8) values = malloc((size_t)many * sizeof *values);
    if (values)
        mps__node_numbers(c, node, many, values, NULL);
    else
        c->no_memory = true;
    if (values != few) free(values);
}

static void check_points(mps_case *c, tree_node *node)
{
    const mps__key *e = node->entry;
    char path[PATH_CAPACITY], counts[40];
    double point[3];
    if (node->kind != TREE_LIST) {
        refuse(c, node, "a list of points");
        return;
    }
    snprintf(counts, sizeof counts, e->few == e->many ? "%d" : "%d to %d", (int)e->few,
             (int)e->many);
    if (node->count < e->few || node->count > e->many)
        mps__case_log(c, node, false, "%s: %d points, %s are wanted, e.g. '%s'",
                      mps__tree_path(node, path, sizeof path), (int)node->count, counts,
                      e->example);
    for (tree_node *n = node->first; n; n = n->next) {
        n->entry = e;
        n->units = e->units;
        mps__node_numbers(c, n, 3, point, NULL);
    }
}

/* ---- texts ----------------------------------------------------------------------------------- */

static void check_texts(mps_case *c, tree_node *node)
{
    for (tree_node *n = node->first; n; n = n->next) {
        n->entry = node->entry;
        if (n->kind != TREE_TEXT || !*n->text) refuse(c, n, "a text");
    }
    if (node->kind == TREE_MAP || (node->kind == TREE_TEXT && !*node->text))
        refuse(c, node, "a text, or a list of such");
}

/* Refuse a word and propose the nearest allowed one. */
static void refuse_word(mps_case *c, const tree_node *node)
{
    char path[PATH_CAPACITY], known[80], nearest[80] = "";
    const char *word;
    size_t length;
    int32_t distance, best = 100;
    for (int32_t i = 0; (length = mps__words_get(node->entry->words, i, &word)) > 0; i++) {
        snprintf(known, sizeof known, "%.*s", (int)length, word);
        if (!mps__words_near(node->text, known, &distance) || distance >= best) continue;
        best = distance;
        memcpy(nearest, known, sizeof nearest);
    }
    mps__tree_path(node, path, sizeof path);
    if (nearest[0])
        mps__case_log(c, node, false, "%s: '%.80s' is not known; did you mean '%s'?", path,
                      node->text, nearest);
    else
        mps__case_log(c, node, false, "%s: '%.80s' is not known; one of these is wanted: %s", path,
                      node->text, node->entry->words);
}

static void check_word(mps_case *c, tree_node *node)
{
    if (node->kind != TREE_TEXT || !*node->text)
        refuse(c, node, "a word");
    else if (!mps__words_have(node->entry->words, node->text, strlen(node->text)))
        refuse_word(c, node);
}

static void check_flag(mps_case *c, tree_node *node)
{
    if (node->kind != TREE_TEXT ||
        !mps__words_have("yes|no|true|false", node->text, strlen(node->text)))
        refuse(c, node, "yes or no");
}

static void check_unit(mps_case *c, tree_node *node)
{
    char path[PATH_CAPACITY], list[160];
    const mps__unit *u = node->kind == TREE_TEXT ? mps__unit_find(node->text, strlen(node->text))
                                                 : NULL;
    if (u && (u->kinds & node->units) && u->scale == SCALE_NONE) return;
    if (node->kind != TREE_TEXT || !*node->text) {
        refuse(c, node, "a unit");
        return;
    }
    mps__kinds_units(node->units, list, sizeof list);
    mps__case_log(c, node, false, "%s: '%.80s' is no unit here; units: %s",
                  mps__tree_path(node, path, sizeof path), node->text, list);
}

static void check_file(mps_case *c, const tree_node *node)
{
    char path[PATH_CAPACITY];
    if (node->kind != TREE_TEXT || !*node->text) {
        refuse(c, node, "the name of a file");
        return;
    }
    const char *file = mps__file_path(c, node);
    if (file && access(file, R_OK) != 0)
        mps__case_log(c, node, false, "%s: '%s' cannot be read: %s",
                      mps__tree_path(node, path, sizeof path), node->text, strerror(errno));
}

void mps__check_value(mps_case *c, tree_node *node)
{
    if (strcmp(node->entry->path, "settings.*") == 0) return; /* checked by mps__check_models() */
    switch (node->entry->shape) {
    case SHAPE_NUMBERS:
        check_numbers(c, node);
        break;
    case SHAPE_POINTS:
        check_points(c, node);
        break;
    case SHAPE_TEXTS:
        check_texts(c, node);
        break;
    case SHAPE_WORD:
        check_word(c, node);
        break;
    case SHAPE_FLAG:
        check_flag(c, node);
        break;
    case SHAPE_UNIT:
        check_unit(c, node);
        break;
    case SHAPE_FILE:
        check_file(c, node);
        break;
    default:
        if (node->kind != TREE_TEXT || !*node->text) refuse(c, node, "a text");
    }
}

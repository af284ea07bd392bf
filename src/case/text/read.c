/* SPDX-License-Identifier: BSD-3-Clause */
/* Reads values of a checked case. */
#include "read.h"
#include <math.h>
#include <string.h>

const tree_node *mps__case_root(const mps_case *c)
{
    return c->root;
}

/* Find a key and mark it as read. */
static tree_node *find(const tree_node *map, const char *key)
{
    tree_node *node = mps__tree_find(map, key);
    if (node) node->read = true;
    return node;
}

/* Refuse a value in T1 where the case needs it before the liquid, which determines T1, is filled;
 * dp and the height of the tank are always known by then. */
static void refuse_unknown(mps_case *c, const tree_node *node)
{
    char path[PATH_CAPACITY];
    mps__case_log(c, node, false, "%s: 'T1' is not known here; write a time in s",
                  mps__tree_path(node, path, sizeof path));
}

static int32_t read_node(mps_case *c, const tree_node *node, int32_t most, double *out,
                         uint64_t *found)
{
    const int32_t count = mps__node_numbers(c, node, most, out, found);
    for (int32_t k = 0; k < count; k++) {
        if (!isnan(out[k])) continue;
        refuse_unknown(c, node);
        return 0;
    }
    return count < 0 ? 0 : count;
}

int32_t mps__read_values(mps_case *c, const tree_node *node, int32_t most, double *out)
{
    mps__read_all(node);
    return read_node(c, node, most, out, NULL);
}

int32_t mps__read_numbers(mps_case *c, const tree_node *map, const char *key, int32_t most,
                          double *out)
{
    const tree_node *node = find(map, key);
    return node ? read_node(c, node, most, out, NULL) : 0;
}

double mps__read_number(mps_case *c, const tree_node *map, const char *key, double otherwise)
{
    double value;
    return mps__read_numbers(c, map, key, 1, &value) == 1 ? value : otherwise;
}

bool mps__read_is(mps_case *c, const tree_node *map, const char *key, uint64_t kind)
{
    const tree_node *node = mps__tree_find(map, key);
    uint64_t found = 0;
    double value;
    return node && mps__node_numbers(c, node, 1, &value, &found) == 1 && found == kind;
}

const char *mps__read_text(mps_case *c, const tree_node *map, const char *key,
                           const char *otherwise)
{
    const tree_node *node = find(map, key);
    (void)c;
    return node && node->kind == TREE_TEXT ? node->text : otherwise;
}

const char *mps__read_text_at(mps_case *c, const tree_node *map, const char *key, int32_t index)
{
    const tree_node *node = find(map, key);
    if (node && node->kind == TREE_LIST) {
        mps__read_all(node);
        for (node = node->first; node && index > 0; index--) node = node->next;
    }
    (void)c;
    return node && node->kind == TREE_TEXT && index == 0 ? node->text : NULL;
}

const char *mps__read_path(mps_case *c, const tree_node *map, const char *key)
{
    const tree_node *node = find(map, key);
    return node && node->kind == TREE_TEXT ? mps__file_path(c, node) : NULL;
}

bool mps__read_flag(mps_case *c, const tree_node *map, const char *key, bool otherwise)
{
    const char *text = mps__read_text(c, map, key, NULL);
    return text ? strcmp(text, "yes") == 0 || strcmp(text, "true") == 0 : otherwise;
}

int32_t mps__read_choice(mps_case *c, const tree_node *map, const char *key, int32_t otherwise)
{
    const tree_node *node = find(map, key);
    const char *word;
    size_t length;
    (void)c;
    if (!node || node->kind != TREE_TEXT || !node->entry || !node->entry->words) return otherwise;
    for (int32_t i = 0; (length = mps__words_get(node->entry->words, i, &word)) > 0; i++)
        if (strlen(node->text) == length && memcmp(node->text, word, length) == 0) return i;
    return otherwise;
}

double mps__read_unit(mps_case *c, const tree_node *map, const char *key, double otherwise)
{
    const char *text = mps__read_text(c, map, key, NULL);
    const mps__unit *u = text ? mps__unit_find(text, strlen(text)) : NULL;
    return u ? mps__unit_value(u) : otherwise;
}

double mps__read_setting(mps_case *c, const tree_node *node, double otherwise)
{
    double value;
    mps__read_all(node);
    return mps__node_setting(c, node, &value) ? value : otherwise;
}

static void mark(tree_node *node)
{
    node->read = true;
    for (tree_node *n = node->first; n; n = n->next) mark(n);
}

/* The mark is set through the parent: reading does not change the contents of a case. */
void mps__read_all(const tree_node *node)
{
    if (!node || !node->parent) return;
    for (tree_node *n = node->parent->first; n; n = n->next)
        if (n == node) mark(n);
}

void mps__case_scale_set(mps_case *c, read_scale scale)
{
    c->scale = scale;
}

/* Whether the texts of a list form one value. */
static bool is_value(const tree_node *node)
{
    return node->kind == TREE_TEXT || node->count == 0 ||
           (node->entry && node->entry->shape >= SHAPE_NUMBERS);
}

static const tree_node *unread(const tree_node *node)
{
    for (const tree_node *n = node->first; n; n = n->next) {
        const tree_node *found = !is_value(n) ? unread(n) : n->read ? NULL : n;
        if (found) return found;
    }
    return NULL;
}

const tree_node *mps__case_unread(const mps_case *c)
{
    return c->root ? unread(c->root) : NULL;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Checking a tree against the table of keys: unknown and missing keys, kinds. */
#include "tree.h"
#include "units.h"
#include <stdio.h>
#include <string.h>

enum { NAME_MOST = 31 };

static void check_node(mps_case *c, tree_node *node, const mps__key *entry);

/* Report that the node should be a map, a list or a text. */
static void refuse_kind(mps_case *c, const tree_node *node, const char *wanted)
{
    static const char *const is[] = {"a text", "a list", "a map"};
    char path[PATH_CAPACITY];
    const mps__key *e = node->entry;
    const char *given = is[node->kind];
    if (node->kind == TREE_TEXT && !*node->text) given = "nothing";
    if (node->kind == TREE_LIST && node->count == 0) given = "an empty list";
    if (node->kind == TREE_MAP && node->count == 0) given = "an empty map";
    mps__case_log(c, node, false, "%s: %s is wanted, not %s%s%s%s",
                  mps__tree_path(node, path, sizeof path), wanted, given,
                  *e->example ? ", e.g. '" : "", e->example, *e->example ? "'" : "");
}

/* ---- names and keys -------------------------------------------------------------------------- */

static void refuse_key(mps_case *c, const tree_node *node, const mps__key *parent)
{
    char path[PATH_CAPACITY], near[64];
    const char *known = mps__key_nearest(parent, node->key, near, sizeof near);
    const mps__key *other = known ? NULL : mps__key_elsewhere(node->key);
    mps__tree_path(node, path, sizeof path);
    if (known)
        mps__case_log_key(c, node, "unknown key '%s'; did you mean '%s'?", path, known);
    else if (other && other->path[0])
        mps__case_log_key(c, node, "unknown key '%s'; '%s' is a key of '%s'", path, node->key,
                          other->path);
    else
        mps__case_log_key(c, node, "unknown key '%s'", path);
}

/* Check a name that the user chooses. */
static bool check_name(mps_case *c, const tree_node *node)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_",
                      more[] = "0123456789-";
    const size_t length = strlen(node->key);
    size_t good = 0;
    while (node->key[good] &&
           (strchr(letters, node->key[good]) || (good > 0 && strchr(more, node->key[good]))))
        good++;
    if (good == length && length > 0 && length <= NAME_MOST) return true;
    mps__case_log_key(
        c, node,
        "name '%.60s': a letter a to z, A to Z is wanted, then such letters, digits, _ and -, %d "
        "in all at most",
        node->key, NAME_MOST);
    return false;
}

static void check_child(mps_case *c, tree_node *child, const mps__key *parent)
{
    const mps__key *entry = mps__key_below(parent, child->key);
    if (!entry) {
        refuse_key(c, child, parent);
        return;
    }
    if (mps__key_names(parent) && !mps__key_dotted(parent) && !check_name(c, child)) return;
    check_node(c, child, entry);
}

/* ---- maps ------------------------------------------------------------------------------------ */

static void check_required(mps_case *c, const tree_node *map, const mps__key *entry)
{
    char path[PATH_CAPACITY];
    for (int32_t k = 1; k < mps__keys_count; k++) {
        const mps__key *key = &mps__keys[k];
        if (!key->required || !mps__key_is_below(entry, key)) continue;
        const char *last = mps__key_last(key);
        if (mps__tree_find(map, last)) continue;
        mps__tree_path(map, path, sizeof path);
        mps__case_log_key(c, map, "%s%skey '%s' is missing, e.g. '%s: %s'", path, *path ? ": " : "",
                          last, last, key->example);
    }
}

static void check_group(mps_case *c, const tree_node *map, const mps__key_group *g)
{
    char path[PATH_CAPACITY], words[120];
    const tree_node *first = NULL;
    const char *word;
    size_t length;
    mps__tree_path(map, path, sizeof path);
    for (const tree_node *n = map->first; n; n = n->next) {
        if (!mps__words_have(g->keys, n->key, strlen(n->key))) continue;
        if (first)
            mps__case_log_key(c, n, "%s: '%s' and '%s' exclude each other; remove one", path,
                              first->key, n->key);
        first = n;
    }
    if (first || !g->required) return;
    size_t used = 0;
    for (int32_t i = 0; (length = mps__words_get(g->keys, i, &word)) > 0; i++)
        used += (size_t)snprintf(words + used, sizeof words - used, "%s%.*s", i ? ", " : "",
                                 (int)length, word);
    mps__case_log_key(c, map, "%s: one of these keys is missing: %s", path, words);
}

/* Refuse a key that needs another key which is not given. */
static void check_needs(mps_case *c, const tree_node *map, const mps__key_group *g)
{
    char path[PATH_CAPACITY];
    const size_t length = strcspn(g->keys, "|");
    const char *needed = g->keys + length + 1;
    for (const tree_node *n = map->first; n; n = n->next) {
        if (strlen(n->key) != length || memcmp(n->key, g->keys, length) != 0) continue;
        if (!mps__tree_find(map, needed))
            mps__case_log_key(c, n, "%s: '%s' is missing beside it, e.g. '%s: %s'",
                              mps__tree_path(n, path, sizeof path), needed, needed,
                              mps__key_below(map->entry, needed)->example);
    }
}

/* A flow map in braces with an unquoted text that contains commas: "{axes: x forward, y port, z
 * up}" has the keys "y port" and "z up".
 * @return the last of these parts, after a message; NULL: the text is not split */
static tree_node *split_word(mps_case *c, tree_node *node, const mps__key *entry)
{
    char word[80], path[PATH_CAPACITY];
    if (!entry || !entry->words || node->kind != TREE_TEXT) return NULL;
    size_t used = (size_t)snprintf(word, sizeof word, "%.60s", node->text);
    for (tree_node *n = node->next; n && n->kind == TREE_TEXT && !*n->text; n = n->next) {
        used += (size_t)snprintf(word + used, sizeof word - used, ", %.60s", n->key);
        if (used >= sizeof word) return NULL;
        if (!mps__words_have(entry->words, word, used)) continue;
        node->entry = n->entry = entry;
        mps__case_log(c, node, false, "%s: a text with commas needs quotes in braces, %s: '%s'",
                      mps__tree_path(node, path, sizeof path), node->key, word);
        return n;
    }
    return NULL;
}

static void check_map(mps_case *c, tree_node *map, const mps__key *entry)
{
    map->entry = entry;
    if (map->kind != TREE_MAP) {
        refuse_kind(c, map, "a map of keys");
        return;
    }
    for (tree_node *n = map->first; n; n = n->next) {
        tree_node *last = split_word(c, n, mps__key_below(entry, n->key));
        if (last)
            n = last;
        else
            check_child(c, n, entry);
    }
    check_required(c, map, entry);
    for (int32_t k = 0; k < mps__key_groups_count; k++)
        if (mps__group_is_of(&mps__key_groups[k], entry)) check_group(c, map, &mps__key_groups[k]);
    for (int32_t k = 0; k < mps__key_needs_count; k++)
        if (mps__group_is_of(&mps__key_needs[k], entry)) check_needs(c, map, &mps__key_needs[k]);
}

static void check_maps(mps_case *c, tree_node *node, const mps__key *entry)
{
    if (node->kind != TREE_LIST) {
        check_map(c, node, entry);
        return;
    }
    for (tree_node *n = node->first; n; n = n->next) check_map(c, n, entry);
    if (node->count == 0 && !entry->words) refuse_kind(c, node, "a map of keys, or a list of such");
}

static void check_fills(mps_case *c, tree_node *list, const mps__key *entry)
{
    if (list->kind != TREE_LIST || list->count == 0) {
        refuse_kind(c, list, "a list of fluids");
        return;
    }
    for (tree_node *n = list->first; n; n = n->next) {
        n->entry = entry;
        if (n->kind != TREE_MAP || n->count != 1)
            refuse_kind(c, n, "one fluid with how it is filled in");
        else
            check_child(c, n->first, entry);
    }
}

static void check_paths(mps_case *c, tree_node *map)
{
    if (map->kind != TREE_MAP || map->count == 0) refuse_kind(c, map, "a map of paths and values");
}

/* Whether the node is a text that replaces the map, `rest`. */
static bool is_word(const tree_node *node, const mps__key *entry)
{
    return node->kind == TREE_TEXT && entry->words &&
           mps__words_have(entry->words, node->text, strlen(node->text));
}

static void check_node(mps_case *c, tree_node *node, const mps__key *entry)
{
    node->entry = entry;
    node->units = entry->units;
    switch (entry->shape) {
    case SHAPE_MAP:
        if (!is_word(node, entry)) check_map(c, node, entry);
        break;
    case SHAPE_MAPS:
        check_maps(c, node, entry);
        break;
    case SHAPE_NAMES:
        if (node->kind != TREE_MAP)
            refuse_kind(c, node, "a map of names");
        else
            for (tree_node *n = node->first; n; n = n->next) check_child(c, n, entry);
        break;
    case SHAPE_FILLS:
        check_fills(c, node, entry);
        break;
    case SHAPE_PATHS:
        check_paths(c, node);
        break;
    default:
        mps__check_value(c, node);
    }
}

/* The checks mark nodes as read: clear these marks. */
static void forget_reads(tree_node *node)
{
    for (tree_node *n = node->first; n; n = n->next) {
        n->read = false;
        forget_reads(n);
    }
}

void mps__check(mps_case *c, tree_node *root)
{
    check_node(c, root, &mps__keys[0]);
    mps__plugins_load(c, root);
    mps__check_models(c, root);
    mps__check_sweep(c, root);
    mps__check_columns(c, root);
    forget_reads(root);
}

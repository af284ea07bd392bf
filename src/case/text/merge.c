/* SPDX-License-Identifier: BSD-3-Clause */
/* Merges trees: `base` under its file, and single values at paths, "fill.water.depth". */
#include "tree.h"
#include <stdlib.h>
#include <string.h>

/* The group of mutually exclusive keys of a key below `parent`; NULL: none. */
static const char *group_of(const mps__key *parent, const char *key)
{
    for (int32_t k = 0; parent && k < mps__key_groups_count; k++) {
        const mps__key_group *g = &mps__key_groups[k];
        if (mps__words_have(g->keys, key, strlen(key)) && mps__group_is_of(g, parent))
            return g->keys;
    }
    return NULL;
}

/* A new value of a group replaces the other values of the group. */
static void drop_others(const mps__key *parent, tree_node *map, const char *key)
{
    const char *group = group_of(parent, key);
    for (tree_node *n = map->first, *next; group && n; n = next) {
        next = n->next;
        if (strcmp(n->key, key) != 0 && mps__words_have(group, n->key, strlen(n->key)))
            mps__tree_remove(map, n);
    }
}

/* Insert a child into a map; it replaces a child of the same key. */
static void put(const mps__key *entry, tree_node *map, tree_node *child)
{
    tree_node *there = mps__tree_find(map, child->key);
    drop_others(entry, map, child->key);
    if (there)
        mps__tree_replace(there, child);
    else
        mps__tree_append(map, child);
}

static void merge(const mps__key *entry, tree_node *under, tree_node *over)
{
    for (tree_node *n = over->first, *next; n; n = next) {
        next = n->next;
        tree_node *there = mps__tree_find(under, n->key);
        const mps__key *below = entry ? mps__key_below(entry, n->key) : NULL;
        if (there && there->kind == TREE_MAP && n->kind == TREE_MAP) {
            drop_others(entry, under, n->key);
            merge(below, there, n);
        } else {
            put(entry, under, n);
        }
    }
    under->source = over->source;
    under->line = over->line;
    under->column = over->column;
    under->key_line = over->key_line;
    under->key_column = over->key_column;
}

void mps__merge(tree_node *under, tree_node *over)
{
    merge(&mps__keys[0], under, over);
}

/* ---- values at paths ------------------------------------------------------------------------- */

typedef struct way {
    mps_case *c;
    const char *path; /* for messages */
    mps__place at;
} way;

static void refuse_step(const way *w, const mps__key *parent, const char *name)
{
    char near[64];
    const char *known = mps__key_nearest(parent, name, near, sizeof near);
    if (known)
        mps__case_fail(w->c, w->at, "unknown path '%s': no key '%s'; did you mean '%s'?", w->path,
                       name, known);
    else
        mps__case_fail(w->c, w->at, "unknown path '%s': no key '%s'", w->path, name);
}

/* Find an element of a list by its number, from 1, or by the name of a one-key map; create it if
 * `add` is not NULL. */
static tree_node *list_step(const way *w, tree_node *list, const char *name)
{
    tree_node *found = mps__tree_find(list, name);
    char *end;
    const long number = strtol(name, &end, 10);
    if (found || *end || number < 1) return found;
    tree_node *n = list->first;
    for (long k = 1; n && k < number; k++) n = n->next;
    if (!n) {
        mps__case_fail(w->c, w->at, "path '%s': there is no element %ld", w->path, number);
        return NULL;
    }
    return n->kind == TREE_MAP && n->count == 1 ? n->first : n;
}

/* Create a map for a key of a `set` that does not exist yet. */
static tree_node *new_map(const way *w, const char *key)
{
    tree_node *map = mps__tree_new(w->c, TREE_MAP, w->at);
    if (map) map->key = key;
    return map;
}

/* Add a fluid at the end of `fill`. */
static tree_node *add_item(const way *w, tree_node *list, tree_node *value)
{
    tree_node *item = mps__tree_new(w->c, TREE_MAP, w->at);
    if (!item) return NULL;
    mps__tree_append(list, item);
    mps__tree_append(item, value);
    return value;
}

static void set_at(const way *w, tree_node *node, const mps__key *entry, const char *rest,
                   tree_node *value);

/* Set a value at a path that continues in a list. */
static void set_in_list(const way *w, tree_node *list, const mps__key *entry, const char *name,
                        const char *rest, tree_node *value)
{
    const int32_t errors = w->c->errors;
    tree_node *child = list_step(w, list, name);
    if (w->c->errors > errors) return;
    if (!child && entry->shape != SHAPE_FILLS) {
        refuse_step(w, entry, name);
    } else if (rest) {
        const mps__key *below = entry->shape == SHAPE_FILLS ? mps__key_below(entry, name) : entry;
        if (!child || child->kind == TREE_TEXT) {
            tree_node *map = new_map(w, child && child->key ? child->key : name);
            if (!map) return;
            if (child) mps__tree_replace(child, map);
            child = child ? map : add_item(w, list, map);
        }
        if (child) set_at(w, child, below, rest, value);
    } else {
        value->key = child && child->key ? child->key : name;
        if (child && child->parent->kind == TREE_LIST) value->key = NULL;
        if (child)
            mps__tree_replace(child, value);
        else
            add_item(w, list, value);
    }
}

static void set_in_map(const way *w, tree_node *map, const mps__key *entry, const char *name,
                       const char *rest, tree_node *value)
{
    const mps__key *below = mps__key_below(entry, name);
    tree_node *child = mps__tree_find(map, name);
    if (!below && (rest || entry->shape != SHAPE_PATHS)) {
        refuse_step(w, entry, name);
    } else if (!rest) {
        value->key = name;
        put(entry, map, value);
    } else {
        if (!child || child->kind == TREE_TEXT) {
            child = below->shape == SHAPE_FILLS ? mps__tree_new(w->c, TREE_LIST, w->at)
                                                : new_map(w, name);
            if (!child) return;
            child->key = name;
            put(entry, map, child);
        } else {
            drop_others(entry, map, name);
        }
        set_at(w, child, below, rest, value);
    }
}

static void set_at(const way *w, tree_node *node, const mps__key *entry, const char *rest,
                   tree_node *value)
{
    const size_t length = mps__key_dotted(entry) ? strlen(rest) : strcspn(rest, ".");
    const char *name = mps__case_copy(w->c, rest, length);
    if (!name) return;
    rest = rest[length] ? rest + length + 1 : NULL;
    const bool holds = entry->shape == SHAPE_MAP || entry->shape == SHAPE_MAPS ||
                       entry->shape == SHAPE_PATHS || mps__key_names(entry);
    if (!holds || (node->kind == TREE_LIST && entry->shape == SHAPE_MAP))
        mps__case_fail(w->c, w->at, "path '%s': nothing is below '%s'", w->path,
                       mps__key_last(entry));
    else if (node->kind == TREE_LIST)
        set_in_list(w, node, entry, name, rest, value);
    else
        set_in_map(w, node, entry, name, rest, value);
}

void mps__set(mps_case *c, tree_node *root, const char *path, tree_node *value, mps__place at)
{
    const way w = {c, path, at};
    if (strcmp(path, "base") == 0 || strcmp(path, "set") == 0) {
        mps__case_fail(c, at, "'%s' cannot be set", path);
        return;
    }
    value->key_line = at.line;
    value->key_column = at.column;
    set_at(&w, root, &mps__keys[0], path, value);
}

void mps__set_text(mps_case *c, tree_node *root, const char *text)
{
    const size_t length = strcspn(text, "=");
    const char *path = mps__case_copy(c, text, length);
    const mps__source s = {.name = mps__case_print(c, "--set %.200s", text),
                           .text = mps__case_copy(c, text[length] ? text + length + 1 : "",
                                                  text[length] ? strlen(text + length + 1) : 0),
                           .folder = mps__folder_of(c, ""),
                           .size = text[length] ? strlen(text + length + 1) : 0,
                           .option = true};
    const int32_t source = path && s.name && s.text && s.folder ? mps__source_add(c, &s) : -1;
    const mps__place at = {source, 1, 1};
    if (source < 0) {
        if (!c->no_memory) mps__case_fail(c, (mps__place){0, 0, 0}, "too many values are set");
        return;
    }
    if (!text[length] || length == 0) {
        mps__case_fail(c, at, "path=value is wanted, e.g. 'run.until=60 s'");
        return;
    }
    if (s.size == 0) {
        mps__case_fail(c, at, "there is no value behind '%s='", path);
        return;
    }
    if (s.size > TREE_BYTES) {
        mps__case_fail(c, at, "the value is larger than 1 MB");
        return;
    }
    tree_node *value = mps__parse(c, source);
    if (value) mps__set(c, root, path, value, at);
}

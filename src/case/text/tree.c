/* SPDX-License-Identifier: BSD-3-Clause */
/* Nodes of a tree. */
#include "tree.h"
#include <stdio.h>
#include <string.h>

tree_node *mps__tree_new(mps_case *c, tree_kind kind, mps__place at)
{
    tree_node *n = mps__case_take(c, sizeof *n);
    if (!n) return NULL;
    *n = (tree_node){.kind = kind,
                     .text = "",
                     .source = at.source,
                     .line = at.line,
                     .column = at.column,
                     .key_line = at.line,
                     .key_column = at.column};
    return n;
}

void mps__tree_append(tree_node *parent, tree_node *child)
{
    child->parent = parent;
    child->next = NULL;
    if (parent->last)
        parent->last->next = child;
    else
        parent->first = child;
    parent->last = child;
    parent->count++;
}

void mps__tree_remove(tree_node *parent, const tree_node *child)
{
    tree_node **link = &parent->first, *last = NULL;
    while (*link && *link != child) {
        last = *link;
        link = &(*link)->next;
    }
    if (!*link) return;
    *link = child->next;
    if (parent->last == child) parent->last = last;
    parent->count--;
}

void mps__tree_replace(tree_node *child, tree_node *with)
{
    tree_node *parent = child->parent;
    tree_node **link = &parent->first;
    while (*link != child) link = &(*link)->next;
    *link = with;
    with->parent = parent;
    with->next = child->next;
    if (parent->last == child) parent->last = with;
}

tree_node *mps__tree_find(const tree_node *map, const char *key)
{
    for (tree_node *n = map ? map->first : NULL; n; n = n->next) {
        if (map->kind == TREE_MAP && strcmp(n->key, key) == 0) return n;
        if (map->kind == TREE_LIST && n->kind == TREE_MAP && n->count == 1 &&
            strcmp(n->first->key, key) == 0)
            return n->first;
    }
    return NULL;
}

/* Number of a node in its list, from 1. */
static int place_of(const tree_node *node)
{
    int place = 1;
    for (const tree_node *n = node->parent->first; n != node; n = n->next) place++;
    return place;
}

/* Whether a node has a name in paths: in a list of one-key maps the keys have one, the maps do
 * not. */
static bool has_step(const tree_node *node)
{
    if (!node->parent) return false;
    return node->key || node->kind != TREE_MAP || node->count != 1;
}

const char *mps__tree_path(const tree_node *node, char *buffer, size_t size)
{
    const tree_node *way[TREE_DEPTH + 2];
    int steps = 0;
    size_t used = 0;
    buffer[0] = '\0';
    for (; node && steps < TREE_DEPTH + 2; node = node->parent)
        if (has_step(node)) way[steps++] = node;
    while (steps-- > 0) {
        const tree_node *n = way[steps];
        const char *point = used ? "." : "";
        const int more = n->key ? snprintf(buffer + used, size - used, "%s%s", point, n->key)
                                : snprintf(buffer + used, size - used, "%s%d", point, place_of(n));
        if (more < 0 || used + (size_t)more >= size) break;
        used += (size_t)more;
    }
    return buffer;
}

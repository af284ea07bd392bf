/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of columns of probes.csv: the name of a sensor must differ from other columns, and
 * 'collect' must name columns. */
#include "tables.h"
#include "tree.h"
#include "units.h"
#include <stdio.h>
#include <string.h>

enum { LISTED_CAPACITY = 200 };

/* Columns of each run; of the motion; of a body. */
#define OR(name) "|" #name
static const char COMMON[] = "t" COMMON_COLUMNS(OR), MOTION[] = "surge|sway|heave|roll|pitch|yaw",
                  BODY[] = "body_";

static void check_sensors(mps_case *c, const tree_node *sensors, bool moves)
{
    for (const tree_node *n = sensors->first; n; n = n->next) {
        const bool common = mps__words_have(COMMON, n->key, strlen(n->key));
        if (!common && !(moves && mps__words_have(MOTION, n->key, strlen(n->key)))) continue;
        mps__case_log_key(c, n, "sensors.%s: probes.csv has a column '%s', %s; choose another name",
                          n->key, n->key, common ? "which each run writes" : "of the motion");
    }
}

/* Whether one name is the other, or the beginning of it before "_". */
static bool is_part(const char *a, size_t length, const char *b, size_t most)
{
    const size_t least = length < most ? length : most;
    if (memcmp(a, b, least) != 0) return false;
    return length == most || (length < most ? b : a)[least] == '_';
}

static bool is_word_part(const char *words, const char *name, size_t length)
{
    const char *word;
    size_t most;
    for (int32_t k = 0; (most = mps__words_get(words, k, &word)) > 0; k++)
        if (is_part(name, length, word, most)) return true;
    return false;
}

static bool is_column(const tree_node *sensors, const char *name, size_t length)
{
    const size_t body = sizeof BODY - 1;
    if (is_word_part(COMMON, name, length) || is_word_part(MOTION, name, length)) return true;
    if (length >= body && memcmp(name, BODY, body) == 0) return true;
    for (const tree_node *n = sensors ? sensors->first : NULL; n; n = n->next)
        if (is_part(name, length, n->key, strlen(n->key))) return true;
    return false;
}

static void check_entry(mps_case *c, const tree_node *sensors, const tree_node *node)
{
    char known[LISTED_CAPACITY] = "";
    size_t used = 0;
    const char *dot = node->kind == TREE_TEXT ? strrchr(node->text, '.') : NULL;
    if (!dot || dot == node->text || strpbrk(node->text, "[], \""))
        return; /* the check of the sweep reports it */
    if (is_column(sensors, node->text, (size_t)(dot - node->text))) return;
    for (const tree_node *n = sensors ? sensors->first : NULL; n && used < sizeof known;
         n = n->next)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "",
                                 n->key);
    mps__case_log(c, node, false, "collect: no sensor is '%.*s'%s%s", (int)(dot - node->text),
                  node->text, used ? "; there are " : "", known);
}

void mps__check_columns(mps_case *c, const tree_node *root)
{
    const tree_node *sensors = mps__tree_find(root, "sensors"),
                    *collect = mps__tree_find(root, "collect");
    if (sensors && sensors->kind != TREE_MAP) return;
    if (sensors)
        check_sensors(c, sensors, mps__tree_find(root, "motion") || mps__tree_find(root, "body"));
    if (collect && collect->kind == TREE_TEXT) check_entry(c, sensors, collect);
    if (collect && collect->kind == TREE_LIST)
        for (const tree_node *n = collect->first; n; n = n->next) check_entry(c, sensors, n);
}

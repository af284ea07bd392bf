/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of models, solvers and kernels, and settings with their units and ranges, as libmps lists them. */
#include "tree.h"
#include "units.h"
#include <math.h>
#include <mps/model.h>
#include <mps/mps.h>
#include <stdio.h>
#include <string.h>

/* Lists of names in libmps. */
typedef mps_status (*list_fn)(const mps_sim *sim, int32_t index, mps_name_info *info);

enum { NAME_ROOM = 64 };

/* The nearest of the names that `list` has, into `nearest`; @return whether the name itself is there */
static bool find_name(const mps_sim *sim, list_fn list, const char *name, char *nearest)
{
    mps_name_info info;
    int32_t distance, best = 2 * NAME_ROOM;
    nearest[0] = '\0';
    mps_name_info_init(&info, sizeof info);
    for (int32_t k = 0; list(sim, k, &info) == MPS_OK; k++) {
        if (strcmp(info.name, name) == 0) return true;
        if (!mps__words_near(name, info.name, &distance) || distance >= best) continue;
        best = distance;
        snprintf(nearest, NAME_ROOM, "%s", info.name);
    }
    return false;
}

static void refuse_name(mps_case *c, const tree_node *node, const char *what, const char *nearest)
{
    char path[PATH_ROOM];
    mps__case_say(c, node, false, "%s: no %s '%.60s'%s%s%s",
                  mps__tree_path(node, path, sizeof path), what, node->text,
                  *nearest ? "; did you mean '" : "", nearest, *nearest ? "'?" : "");
}

static void check_name(mps_case *c, const mps_sim *sim, const tree_node *node, const char *what,
                       list_fn list)
{
    char nearest[NAME_ROOM];
    if (!node || node->kind != TREE_TEXT || !*node->text) return;
    if (!find_name(sim, list, node->text, nearest)) refuse_name(c, node, what, nearest);
}

/* ---- models ----------------------------------------------------------------------------------- */

/* Whether a model, or a slot of models, has this name; else the nearest. */
static bool find_model(const mps_sim *sim, const char *name, bool slot, char *nearest)
{
    mps_model_info info;
    int32_t distance, best = 2 * NAME_ROOM;
    nearest[0] = '\0';
    mps_model_info_init(&info, sizeof info);
    for (int32_t k = 0; mps_model_info_get(sim, k, &info) == MPS_OK; k++) {
        char known[NAME_ROOM];
        const size_t length = slot && !strchr(name, '.') ? strcspn(info.name, ".")
                                                         : strlen(info.name);
        snprintf(known, sizeof known, "%.*s", (int)length, info.name);
        if (strcmp(known, name) == 0) return true;
        if (!mps__words_near(name, known, &distance) || distance >= best) continue;
        best = distance;
        memcpy(nearest, known, sizeof known);
    }
    return false;
}

static void check_model(mps_case *c, const mps_sim *sim, const tree_node *node, bool slot)
{
    char nearest[NAME_ROOM];
    if (node->kind != TREE_TEXT || !*node->text) return;
    if (!find_model(sim, node->text, slot, nearest))
        refuse_name(c, node, slot ? "slot or model" : "model", nearest);
}

/* A text, or each text of a list. */
static void check_model_list(mps_case *c, const mps_sim *sim, const tree_node *list, bool slot)
{
    if (!list) return;
    if (list->kind != TREE_LIST) check_model(c, sim, list, slot);
    for (const tree_node *n = list->first; n; n = n->next) check_model(c, sim, n, slot);
}

/* ---- settings --------------------------------------------------------------------------------- */

/* Find slot.key among the settings of all models of the slot; else the nearest. */
static bool find_setting(const mps_sim *sim, const char *name, mps_setting_info *found,
                         char *nearest)
{
    mps_model_info model;
    int32_t distance, best = 2 * NAME_ROOM;
    nearest[0] = '\0';
    mps_model_info_init(&model, sizeof model);
    for (int32_t m = 0; mps_model_info_get(sim, m, &model) == MPS_OK; m++) {
        for (int32_t k = 0; k < model.settings; k++) {
            char known[NAME_ROOM];
            mps_setting_info_init(found, sizeof *found);
            if (mps_setting_info_get(sim, model.name, k, found) != MPS_OK) break;
            snprintf(known, sizeof known, "%.*s.%s", (int)strcspn(model.name, "."), model.name,
                     found->key);
            if (strcmp(known, name) == 0) return true;
            if (!mps__words_near(name, known, &distance) || distance >= best) continue;
            best = distance;
            memcpy(nearest, known, sizeof known);
        }
    }
    return false;
}

static uint64_t kinds_of(const char *unit)
{
    const mps__unit *u = mps__unit_find(unit, strlen(unit));
    return u ? u->kinds : UNIT_NONE | UNIT_SHARE;
}

static void check_setting(mps_case *c, const mps_sim *sim, tree_node *node)
{
    mps_setting_info info;
    char nearest[NAME_ROOM], path[PATH_ROOM];
    double value;
    if (!find_setting(sim, node->key, &info, nearest)) {
        mps__case_say_key(c, node, "no setting '%.60s'%s%s%s", node->key,
                          *nearest ? "; did you mean '" : "; settings are slot.key", nearest,
                          *nearest ? "'?" : "");
        return;
    }
    node->units = kinds_of(info.unit);
    node->in_dp = strcmp(info.unit, "dp") == 0;
    if (!mps__node_setting(c, node, &value) || isnan(value)) return;
    if (value >= info.min && value <= info.max &&
        (info.type == MPS_TYPE_REAL || value == floor(value)))
        return;
    mps__case_say(c, node, false, "%s: '%.60s' is out of its range: %s%g .. %g %s",
                  mps__tree_path(node, path, sizeof path), node->text,
                  info.type == MPS_TYPE_REAL ? "" : "whole numbers, ", info.min, info.max,
                  strcmp(info.unit, "-") == 0 ? "" : info.unit);
}

bool mps__node_setting(mps_case *c, const tree_node *node, double *value)
{
    const read_scale scale = c->scale;
    double length = 0;
    if (!node->in_dp) return mps__node_numbers(c, node, 1, value, NULL) == 1;
    c->scale.dp = 1; /* "3 dp" is 3 without rounding */
    bool done = mps__node_numbers(c, node, 1, value, NULL) == 1;
    c->scale.dp = NAN;
    done = done && mps__node_numbers(c, node, 1, &length, NULL) == 1;
    c->scale = scale;
    if (done && !isnan(length)) *value = length / scale.dp;
    return done;
}

/* ---- all -------------------------------------------------------------------------------------- */

static const tree_node *below(const tree_node *root, const char *map, const char *key)
{
    const tree_node *node = mps__tree_find(root, map);
    return node && node->kind == TREE_MAP ? mps__tree_find(node, key) : NULL;
}

void mps__check_models(mps_case *c, tree_node *root)
{
    const tree_node *model = mps__tree_find(root, "model"), *use = mps__tree_find(root, "use"),
                    *gone = mps__tree_find(root, "remove"), *solver = below(root, "run", "solver"),
                    *preconditioner = below(root, "run", "preconditioner"),
                    *kernel = below(root, "kernel", "name");
    tree_node *settings = mps__tree_find(root, "settings");
    mps_sim *sim = NULL;
    mps_config config;
    if (!model && !use && !gone && !solver && !preconditioner && !kernel && !settings) return;
    mps_config_init(&config, sizeof config);
    config.dp = 1;
    if (mps_sim_create(&config, &sim) != MPS_OK) {
        c->no_memory = true;
        return;
    }
    check_name(c, sim, model, "preset of models", mps_preset_info_get);
    check_name(c, sim, solver, "pressure solver", mps_solver_info_get);
    check_name(c, sim, preconditioner, "preconditioner", mps_preconditioner_info_get);
    check_name(c, sim, kernel, "kernel", mps_kernel_info_get);
    check_model_list(c, sim, use, false);
    check_model_list(c, sim, gone, true);
    if (settings && settings->kind == TREE_MAP)
        for (tree_node *n = settings->first; n; n = n->next) check_setting(c, sim, n);
    mps_sim_destroy(sim);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks names of models, solvers and kernels, and units and ranges of settings, against the lists
 * of libmps. */
#include "tree.h"
#include "units.h"
#include <math.h>
#include <mps/model.h>
#include <mps/mps.h>
#include <stdio.h>
#include <string.h>

/* A function of libmps that lists names. */
typedef mps_status (*list_fn)(const mps_sim *sim, int32_t index, mps_name_info *info);

enum { NAME_CAPACITY = 64, LISTED_CAPACITY = 160 };

/* The nearest of the names that `list` has, into `nearest`, and all of them into `all`;
 * @return whether the name itself is there */
static bool find_name(const mps_sim *sim, list_fn list, const char *name, char *nearest, char *all)
{
    mps_name_info info;
    int32_t distance, best = 2 * NAME_CAPACITY;
    size_t used = 0;
    nearest[0] = all[0] = '\0';
    mps_name_info_init(&info, sizeof info);
    for (int32_t k = 0; list(sim, k, &info) == MPS_OK; k++) {
        if (strcmp(info.name, name) == 0) return true;
        if (used < LISTED_CAPACITY)
            used += (size_t)snprintf(all + used, LISTED_CAPACITY - used, "%s%s", k ? ", " : "",
                                     info.name);
        if (!mps__words_near(name, info.name, &distance) || distance >= best) continue;
        best = distance;
        snprintf(nearest, NAME_CAPACITY, "%s", info.name);
    }
    return false;
}

/* @param others  what there is, for a name to which none is near */
static void refuse_name(mps_case *c, const tree_node *node, const char *what, const char *nearest,
                        const char *others)
{
    char path[PATH_CAPACITY];
    mps__case_log(c, node, false, "%s: no %s '%.60s'; %s%s%s",
                  mps__tree_path(node, path, sizeof path), what, node->text,
                  *nearest ? "did you mean '" : "", *nearest ? nearest : others,
                  *nearest ? "'?" : "");
}

static void check_name(mps_case *c, const mps_sim *sim, const tree_node *node, const char *what,
                       list_fn list)
{
    char nearest[NAME_CAPACITY], all[LISTED_CAPACITY], others[LISTED_CAPACITY + 16];
    if (!node || node->kind != TREE_TEXT || !*node->text) return;
    if (find_name(sim, list, node->text, nearest, all)) return;
    snprintf(others, sizeof others, "there are %s", all);
    refuse_name(c, node, what, nearest, others);
}

/* ---- models ---------------------------------------------------------------------------------- */

/* Whether a model or a slot of models has this name; else its nearest name. */
static bool find_model(const mps_sim *sim, const char *name, bool slot, char *nearest)
{
    mps_model_info info;
    int32_t distance, best = 2 * NAME_CAPACITY;
    nearest[0] = '\0';
    mps_model_info_init(&info, sizeof info);
    for (int32_t k = 0; mps_model_info_get(sim, k, &info) == MPS_OK; k++) {
        char known[NAME_CAPACITY];
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
    char nearest[NAME_CAPACITY];
    if (node->kind != TREE_TEXT || !*node->text) return;
    if (!find_model(sim, node->text, slot, nearest))
        refuse_name(c, node, slot ? "slot or model" : "model", nearest,
                    "'mps list models' lists those of the library, 'mps list plugins' others");
}

/* Check a text, or each text of a list. */
static void check_model_list(mps_case *c, const mps_sim *sim, const tree_node *list, bool slot)
{
    if (!list) return;
    if (list->kind != TREE_LIST) check_model(c, sim, list, slot);
    for (const tree_node *n = list->first; n; n = n->next) check_model(c, sim, n, slot);
}

/* ---- settings -------------------------------------------------------------------------------- */

/* The setting searched for, and the nearest name of a setting so far. */
typedef struct search {
    const char *name;
    int32_t best;
    char nearest[NAME_CAPACITY];
} search;

/* Whether slot.key is the setting that is searched for. */
static bool is_setting(search *s, const char *slot, size_t length, const char *key)
{
    char known[NAME_CAPACITY];
    int32_t distance;
    snprintf(known, sizeof known, "%.*s.%s", (int)length, slot, key);
    if (strcmp(known, s->name) == 0) return true;
    if (!mps__words_near(s->name, known, &distance) || distance >= s->best) return false;
    s->best = distance;
    memcpy(s->nearest, known, sizeof known);
    return false;
}

/* Search the settings of all models of a slot, then those of loads and motions of plug-ins; if
 * there is none, find the nearest name. */
static bool find_setting(const mps_case *c, const mps_sim *sim, search *s, mps_setting_info *found)
{
    const mps_drive_ops *drive;
    mps_model_info model;
    mps_model_info_init(&model, sizeof model);
    for (int32_t m = 0; mps_model_info_get(sim, m, &model) == MPS_OK; m++) {
        for (int32_t k = 0; k < model.settings; k++) {
            mps_setting_info_init(found, sizeof *found);
            if (mps_setting_info_get(sim, model.name, k, found) != MPS_OK) break;
            if (is_setting(s, model.name, strcspn(model.name, "."), found->key)) return true;
        }
    }
    for (int32_t m = 0; (drive = mps__plugins_drive_at(c, m)) != NULL; m++)
        for (int32_t k = 0; k < drive->setting_count; k++) {
            const mps_setting *known = &drive->settings[k];
            *found = (mps_setting_info){.struct_size = sizeof *found,
                                        .type = known->type,
                                        .key = known->key,
                                        .unit = known->unit,
                                        .min = known->min,
                                        .max = known->max};
            if (is_setting(s, drive->name, strlen(drive->name), known->key)) return true;
        }
    return false;
}

/* Read a setting whose unit may be one that no key of a case has: its text is then used as written.
 * @return false: there is a message */
static bool take_unit(mps_case *c, tree_node *node, const char *unit)
{
    const mps__unit *u = mps__unit_find(unit, strlen(unit));
    node->in_dp = u && u->scale == SCALE_DP;
    node->unit = u && !node->in_dp ? mps__unit_value(u) : 1;
    node->units = u ? u->kinds : UNIT_NONE | UNIT_SHARE;
    if (u || node->kind != TREE_TEXT || strcmp(unit, "-") == 0) return true;
    const size_t length = strlen(node->text), tail = strlen(unit);
    if (length > tail && strcmp(node->text + length - tail, unit) == 0)
        node->number = mps__case_copy(c, node->text, length - tail);
    double value;
    char path[PATH_CAPACITY];
    mps__numbers n = {.text = node->number ? node->number : node->text,
                      .kinds = node->units,
                      .most = 1,
                      .out = &value};
    if (mps__numbers_read(&n)) return true;
    mps__case_log(c, node, false, "%s: '%.60s': a number in '%s' is wanted, e.g. '1 %s'",
                  mps__tree_path(node, path, sizeof path), node->text, unit, unit);
    return false;
}

/* Read a flag. */
static void take_flag(tree_node *node)
{
    if (node->kind != TREE_TEXT) return;
    if (mps__words_have("yes|true", node->text, strlen(node->text))) node->number = "1";
    if (mps__words_have("no|false", node->text, strlen(node->text))) node->number = "0";
}

static void check_setting(mps_case *c, const mps_sim *sim, tree_node *node)
{
    mps_setting_info info;
    search s = {.name = node->key, .best = 2 * NAME_CAPACITY};
    char path[PATH_CAPACITY];
    double value;
    if (!find_setting(c, sim, &s, &info)) {
        mps__case_log_key(c, node, "no setting '%.60s'%s%s%s", node->key,
                          *s.nearest ? "; did you mean '"
                                     : "; settings are slot.key, as 'mps list settings' lists them",
                          s.nearest, *s.nearest ? "'?" : "");
        return;
    }
    if (!take_unit(c, node, info.unit)) return;
    if (info.type == MPS_TYPE_FLAG) take_flag(node);
    if (!mps__node_setting(c, node, &value) || isnan(value)) return;
    if (value >= info.min && value <= info.max &&
        (info.type == MPS_TYPE_REAL || value == floor(value)))
        return;
    mps__case_log(c, node, false, "%s: '%.60s' is out of its range: %s%g .. %g %s",
                  mps__tree_path(node, path, sizeof path), node->text,
                  info.type == MPS_TYPE_REAL ? "" : "whole numbers, ", info.min, info.max,
                  strcmp(info.unit, "-") == 0 ? "" : info.unit);
}

bool mps__node_setting(mps_case *c, const tree_node *node, double *value)
{
    const read_scale scale = c->scale;
    double length = 0;
    tree_node number = *node; /* without a unit that no key has */
    if (node->number) number.text = node->number;
    bool done = true;
    if (node->in_dp) c->scale.dp = 1; /* "3 dp" is 3 without rounding */
    done = mps__node_numbers(c, &number, 1, value, NULL) == 1;
    if (done && !node->in_dp && node->unit > 0) *value /= node->unit;
    if (!node->in_dp) return done;
    c->scale.dp = NAN;
    done = done && mps__node_numbers(c, node, 1, &length, NULL) == 1;
    c->scale = scale;
    if (done && !isnan(length)) *value = length / scale.dp;
    return done;
}

/* ---- plug-ins -------------------------------------------------------------------------------- */

/* Check the name of a load or motion of a plug-in, below `map` of the case. */
static void check_drive(mps_case *c, const tree_node *node, int32_t kind)
{
    const char *what = kind == MPS_PLUGIN_LOAD ? "load" : "motion";
    char nearest[NAME_CAPACITY], path[PATH_CAPACITY];
    if (!node || node->kind != TREE_TEXT || !*node->text) return;
    if (mps__plugins_drive(c, node->text, kind, nearest, sizeof nearest)) return;
    mps__case_log(c, node, false, "%s: no plug-in has a %s '%.60s'%s%s%s",
                  mps__tree_path(node, path, sizeof path), what, node->text,
                  *nearest     ? "; did you mean '"
                  : c->plugins ? ""
                               : "; 'plugins' names its library",
                  nearest, *nearest ? "'?" : "");
}

static bool has_text(const tree_node *node, const char *text)
{
    if (!node) return false;
    if (node->kind == TREE_TEXT) return strcmp(node->text, text) == 0;
    for (const tree_node *n = node->kind == TREE_LIST ? node->first : NULL; n; n = n->next)
        if (n->kind == TREE_TEXT && strcmp(n->text, text) == 0) return true;
    return false;
}

enum { USERS = 5 }; /* keys that may name an item of a plug-in */

/* A plug-in of which the case uses nothing usually means a missing line. */
static void warn_of_unused(mps_case *c, const tree_node *const used[USERS])
{
    static const char *const key[USERS] = {"use: [", "run: {solver: ", "run: {preconditioner: ",
                                           "body: {load: {plugin: ", "motion: {plugin: "},
                             *const end[USERS] = {"]", "}", "}", "}}", "}"};
    for (int32_t k = 0; k < c->plugins; k++) {
        mps_plugin_item item;
        mps_plugin_item_init(&item, sizeof item);
        bool any = false;
        for (int32_t i = 0; mps_plugin_item_get(c->plugin[k].file, i, &item) == MPS_OK; i++)
            for (int n = 0; n < USERS; n++) any = any || has_text(used[n], item.name);
        if (any || mps_plugin_item_get(c->plugin[k].file, 0, &item) != MPS_OK) continue;
        mps__case_log(c, c->plugin[k].at, true,
                      "plugins: nothing of this plug-in is used; e.g. '%s%s%s' uses it",
                      key[item.kind], item.name, end[item.kind]);
    }
}

/* ---- all ------------------------------------------------------------------------------------- */

static const tree_node *below(const tree_node *root, const char *map, const char *key)
{
    const tree_node *node = mps__tree_find(root, map);
    return node && node->kind == TREE_MAP ? mps__tree_find(node, key) : NULL;
}

/* Keys whose values name something of libmps or of a plug-in. */
enum { MODEL, USE, REMOVE, SETTINGS, SOLVER, PRECONDITIONER, KERNEL, LOAD, MOTION, NAMES };

static void find_names(const tree_node *root, const tree_node *names[NAMES])
{
    const tree_node *load = below(root, "body", "load");
    names[MODEL] = mps__tree_find(root, "model");
    names[USE] = mps__tree_find(root, "use");
    names[REMOVE] = mps__tree_find(root, "remove");
    names[SETTINGS] = mps__tree_find(root, "settings");
    names[SOLVER] = below(root, "run", "solver");
    names[PRECONDITIONER] = below(root, "run", "preconditioner");
    names[KERNEL] = below(root, "kernel", "name");
    names[LOAD] = load && load->kind == TREE_MAP ? mps__tree_find(load, "plugin") : NULL;
    names[MOTION] = below(root, "motion", "plugin");
}

void mps__check_models(mps_case *c, tree_node *root)
{
    const tree_node *names[NAMES];
    mps_sim *sim = NULL;
    mps_config config;
    bool any = c->plugins > 0;
    find_names(root, names);
    for (int k = 0; k < NAMES; k++) any = any || names[k];
    if (!any || mps__plugins_missing(c, root)) return;
    mps_config_init(&config, sizeof config);
    config.dp = 1;
    if (mps_sim_create(&config, &sim) != MPS_OK) {
        c->no_memory = true;
        return;
    }
    mps__plugins_register(c, sim);
    check_name(c, sim, names[MODEL], "preset of models", mps_preset_info_get);
    check_name(c, sim, names[SOLVER], "pressure solver", mps_solver_info_get);
    check_name(c, sim, names[PRECONDITIONER], "preconditioner", mps_preconditioner_info_get);
    check_name(c, sim, names[KERNEL], "kernel", mps_kernel_info_get);
    check_model_list(c, sim, names[USE], false);
    check_model_list(c, sim, names[REMOVE], true);
    check_drive(c, names[LOAD], MPS_PLUGIN_LOAD);
    check_drive(c, names[MOTION], MPS_PLUGIN_MOTION);
    if (names[SETTINGS] && names[SETTINGS]->kind == TREE_MAP)
        for (tree_node *n = names[SETTINGS]->first; n; n = n->next) check_setting(c, sim, n);
    const tree_node *const used[USERS] = {names[USE], names[SOLVER], names[PRECONDITIONER],
                                          names[LOAD], names[MOTION]};
    warn_of_unused(c, used);
    mps_sim_destroy(sim);
}

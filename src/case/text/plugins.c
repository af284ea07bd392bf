/* SPDX-License-Identifier: BSD-3-Clause */
/* `plugins` of a case: locates the files, decides which may be loaded, and loads them. */
#include "plugin_file.h"
#include "tree.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

static const char search_path[] = "MPS_PLUGIN_PATH";

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* ---- one form -------------------------------------------------------------------------------- */

/* Convert a text to a map with `file`. */
static void put_item(mps_case *c, tree_node *list, tree_node *item)
{
    const mps__place at = {item->source, item->line, item->column};
    tree_node *map = item;
    if (item->kind == TREE_TEXT) {
        map = mps__tree_new(c, TREE_MAP, at);
        tree_node *file = map ? mps__tree_new(c, TREE_TEXT, at) : NULL;
        if (!file) return;
        file->text = item->text;
        file->key = "file";
        file->key_line = at.line;
        file->key_column = at.column;
        mps__tree_append(map, file);
    }
    map->key = NULL;
    mps__tree_append(list, map);
}

/* A plug-in that the program names replaces the same plug-in of the case. */
static void put_file(mps_case *c, tree_node *list, const char *name)
{
    const mps__source s = {.name = mps__case_print(c, "--plugin %.200s", name),
                           .text = "",
                           .folder = mps__folder_of(c, ""),
                           .option = true};
    const int32_t source = s.name && s.folder ? mps__source_add(c, &s) : -1;
    tree_node *text = source < 0 ? NULL : mps__tree_new(c, TREE_TEXT, (mps__place){source, 1, 1});
    if (!text) return;
    /* a name without '/' that the program passes is in the current folder */
    text->text = mps__case_copy(c, name, strlen(name));
    for (tree_node *n = list->first, *next; text->text && n; n = next) {
        const tree_node *file = n->kind == TREE_MAP ? mps__tree_find(n, "file") : NULL;
        next = n->next;
        if (file && file->kind == TREE_TEXT && strcmp(base_name(file->text), base_name(name)) == 0)
            mps__tree_remove(list, n);
    }
    if (text->text) put_item(c, list, text);
}

void mps__plugins_put(mps_case *c, tree_node *root, int32_t count, const char *const *files)
{
    tree_node *given = mps__tree_find(root, "plugins");
    const mps__place at = given ? (mps__place){given->source, given->line, given->column}
                                : (mps__place){root->source, 1, 1};
    tree_node *list = given || count > 0 ? mps__tree_new(c, TREE_LIST, at) : NULL;
    if (!list) return;
    list->key = "plugins";
    if (given) {
        list->key_line = given->key_line;
        list->key_column = given->key_column;
        mps__tree_replace(given, list);
    } else {
        mps__tree_append(root, list);
    }
    const bool many = given && given->kind == TREE_LIST;
    if (given && !many) put_item(c, list, given);
    for (tree_node *n = many ? given->first : NULL, *next; n; n = next) {
        next = n->next;
        put_item(c, list, n);
    }
    for (int32_t k = 0; k < count; k++) put_file(c, list, files[k]);
}

/* ---- where a file is ------------------------------------------------------------------------- */

static const char *in_folder(mps_case *c, const char *folder, size_t length, const char *name)
{
    const bool slash = length == 0 || folder[length - 1] == '/';
    const char *path = mps__case_print(c, "%.*s%s%s", (int)length, folder, slash ? "" : "/", name);
    return path && access(path, F_OK) == 0 ? path : NULL;
}

/* Search the folder of the file that names it; a name without '/' then in those of MPS_PLUGIN_PATH.
 * NULL: not found */
static const char *find_file(mps_case *c, const tree_node *file)
{
    const char *folder = c->source[file->source].folder, *path = NULL,
               *more = strchr(file->text, '/') ? NULL : getenv(search_path);
    if (file->text[0] == '/') return access(file->text, F_OK) == 0 ? file->text : NULL;
    path = in_folder(c, folder, strlen(folder), file->text);
    while (!path && more && *more) {
        const size_t length = strcspn(more, ":");
        if (length > 0) path = in_folder(c, more, length, file->text);
        more += length + (more[length] == ':');
    }
    return path;
}

static void refuse_missing(mps_case *c, const tree_node *file)
{
    const char *path = getenv(search_path);
    if (file->text[0] == '/')
        mps__case_log(c, file, false, "plugins: there is no file '%.200s'", file->text);
    else
        mps__case_log(c, file, false, "plugins: there is no file '%.200s' in '%.200s'%s%.100s%s",
                      file->text, c->source[file->source].folder,
                      strchr(file->text, '/') ? ""
                      : path && *path         ? ", nor in MPS_PLUGIN_PATH, '"
                                              : "; MPS_PLUGIN_PATH names further folders",
                      strchr(file->text, '/') || !path ? "" : path,
                      strchr(file->text, '/') || !path || !*path ? "" : "'");
}

/* ---- loading --------------------------------------------------------------------------------- */

/* A case of a page or from memory is not trusted. */
static bool is_allowed(mps_case *c, const tree_node *file)
{
    const mps__source *s = &c->source[file->source];
    if (c->load == MPS_CASE_PLUGINS_ALL || !s->untrusted) return true;
    mps__case_log(c, file, false,
                  "plugins: '%.200s' is a program that would run with your rights, and a page or a "
                  "text of others names it; if you trust it, --allow-plugins loads it, or give "
                  "your own copy by --plugin FILE",
                  file->text);
    return false;
}

static void check_sum(mps_case *c, tree_node *item, const mps_plugin_file *p)
{
    tree_node *sum = mps__tree_find(item, "sha256"), *file = mps__tree_find(item, "file");
    if (sum && strcasecmp(sum->text, p->sha256) != 0)
        mps__case_log(
            c, sum, false,
            "plugins: '%.200s' is not the file that is wanted: its SHA-256 is %s; without "
            "'sha256' the case takes any",
            p->path, p->sha256);
    if (sum) return;
    sum = mps__tree_new(c, TREE_TEXT, (mps__place){file->source, file->line, file->column});
    if (!sum) return;
    sum->key = "sha256";
    sum->text = p->sha256;
    mps__tree_append(item, sum);
}

static void load_item(mps_case *c, tree_node *item)
{
    char why[PLUGIN_WHY];
    mps_plugin_file *p = NULL;
    tree_node *file = item->kind == TREE_MAP ? mps__tree_find(item, "file") : NULL,
              *sum = file ? mps__tree_find(item, "sha256") : NULL;
    /* there is a message already */
    if (!file || file->kind != TREE_TEXT || !file->text[0] || (sum && sum->kind != TREE_TEXT))
        return;
    const char *path = find_file(c, file);
    if (path) file->text = path; /* absolute, so that it is valid in any folder */
    if (c->load == MPS_CASE_PLUGINS_NONE || c->no_memory || !is_allowed(c, file)) return;
    if (!path) {
        refuse_missing(c, file);
        return;
    }
    if (c->plugins == CASE_PLUGINS) {
        mps__case_log(c, file, false, "plugins: more than %d", CASE_PLUGINS);
        return;
    }
    const mps_status status = mps_plugin_open(path, &p, why, sizeof why);
    if (status == MPS_E_NOMEM)
        c->no_memory = true;
    else if (status != MPS_OK)
        mps__case_log(c, file, false, "plugins: '%.200s': %s", path, why);
    if (status != MPS_OK) return;
    c->plugin[c->plugins++] = (mps__case_plugin){p, file};
    file->text = p->path;
    check_sum(c, item, p);
}

void mps__plugins_load(mps_case *c, tree_node *root)
{
    tree_node *list = mps__tree_find(root, "plugins");
    for (tree_node *n = list ? list->first : NULL; n; n = n->next) load_item(c, n);
}

bool mps__plugins_missing(const mps_case *c, const tree_node *root)
{
    const tree_node *list = mps__tree_find(root, "plugins");
    return list && list->count > c->plugins;
}

void mps__plugins_close(mps_case *c)
{
    while (c->plugins > 0) mps_plugin_close(c->plugin[--c->plugins].file);
}

const mps_plugin_file *mps_case_plugin(const mps_case *c, int32_t index)
{
    return c && index >= 0 && index < c->plugins ? c->plugin[index].file : NULL;
}

/* ---- registered items ------------------------------------------------------------------------ */

/* An earlier plug-in with an item of the same name. */
static const mps_plugin_file *owner_of(const mps_case *c, int32_t which, const char **name)
{
    const mps_plugin_file *p = c->plugin[which].file;
    for (int32_t k = 0; k < p->items; k++)
        for (int32_t j = 0; j < which; j++)
            for (int32_t i = 0; i < c->plugin[j].file->items; i++) {
                *name = p->item[k].name;
                if (strcmp(c->plugin[j].file->item[i].name, *name) == 0) return c->plugin[j].file;
            }
    return NULL;
}

bool mps__plugins_register(mps_case *c, mps_sim *sim)
{
    char why[PLUGIN_WHY];
    bool good = true;
    for (int32_t k = 0; k < c->plugins; k++) {
        const mps__case_plugin *p = &c->plugin[k];
        const char *name;
        const mps_plugin_file *owner = owner_of(c, k, &name);
        if (!owner && mps_plugin_register(p->file, sim, why, sizeof why) == MPS_OK) continue;
        good = false;
        if (owner)
            mps__case_log(c, p->at, false,
                          "plugins: '%.200s': the name '%s' is taken by '%.200s'; remove one of "
                          "the plug-ins",
                          p->file->path, name, owner->path);
        else
            mps__case_log(c, p->at, false, "plugins: '%.200s': %s", p->file->path, why);
    }
    return good;
}

const mps_drive_ops *mps__plugins_drive_at(const mps_case *c, int32_t index)
{
    for (int32_t k = 0; k < c->plugins; k++)
        for (int32_t i = 0; i < c->plugin[k].file->items; i++) {
            const plugin_item *item = &c->plugin[k].file->item[i];
            if (item->kind >= MPS_PLUGIN_LOAD && index-- == 0) return &item->drive;
        }
    return NULL;
}

const mps_drive_ops *mps__plugins_drive(const mps_case *c, const char *name, int32_t kind,
                                        char *near, size_t size)
{
    const mps_drive_ops *ops;
    int32_t distance, best = INT32_MAX;
    if (near) near[0] = '\0';
    for (int32_t k = 0; (ops = mps__plugins_drive_at(c, k)) != NULL; k++) {
        if ((ops->load ? MPS_PLUGIN_LOAD : MPS_PLUGIN_MOTION) != kind) continue;
        if (strcmp(ops->name, name) == 0) return ops;
        if (!near || !mps__words_near(name, ops->name, &distance) || distance >= best) continue;
        best = distance;
        snprintf(near, size, "%s", ops->name);
    }
    return NULL;
}

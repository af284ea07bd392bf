/* SPDX-License-Identifier: BSD-3-Clause */
/* What a plug-in registers, and the public functions that load plug-ins. */
#include "plugin_file.h"
#include <dlfcn.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SETTINGS_MOST = 16, DRIVE_NAME = 31 };

/* First argument of the functions of a registry. */
typedef struct host {
    mps_plugin_file *plugin;
    mps_sim *sim;
    bool list;
    plugin_why *why;
} host;

/* ---- items ---- */

static mps_status add(host *h, int32_t kind, const char *name, const char *help,
                      const mps_drive_ops *drive)
{
    mps_plugin_file *p = h->plugin;
    if (!h->list) return MPS_OK;
    if (p->items == PLUGIN_ITEMS) {
        mps__plugin_fail(h->why, MPS_E_ARG, "it registers more than %d models and others",
                         PLUGIN_ITEMS);
        return MPS_E_ARG;
    }
    plugin_item *item = &p->item[p->items++];
    *item = (plugin_item){.kind = kind};
    snprintf(item->name, sizeof item->name, "%s", name);
    snprintf(item->help, sizeof item->help, "%s", help ? help : "");
    if (drive) item->drive = *drive;
    return MPS_OK;
}

/* Record a table that libmps accepted as an item; if it refused the table, keep its error text. */
static mps_status added(host *h, mps_status status, int32_t kind, const char *name,
                        const char *help)
{
    if (status == MPS_OK) return add(h, kind, name, help, NULL);
    mps__plugin_fail(h->why, status, "%s", mps_sim_error(h->sim));
    return status;
}

static mps_status add_model(void *user, const mps_model_ops *ops)
{
    host *h = user;
    const mps_status status = mps_model_register(h->sim, ops);
    return added(h, status, MPS_PLUGIN_MODEL, status == MPS_OK ? ops->name : "",
                 status == MPS_OK ? ops->help : "");
}

static mps_status add_solver(void *user, const mps_solver_ops *ops)
{
    host *h = user;
    const mps_status status = mps_solver_register(h->sim, ops);
    return added(h, status, MPS_PLUGIN_SOLVER, status == MPS_OK ? ops->name : "",
                 status == MPS_OK ? ops->help : "");
}

static mps_status add_preconditioner(void *user, const mps_preconditioner_ops *ops)
{
    host *h = user;
    const mps_status status = mps_preconditioner_register(h->sim, ops);
    return added(h, status, MPS_PLUGIN_PRECONDITIONER, status == MPS_OK ? ops->name : "",
                 status == MPS_OK ? ops->help : "");
}

/* ---- loads and motions ---- */

static bool is_name(const char *name)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz",
                      all[] = "abcdefghijklmnopqrstuvwxyz0123456789_";
    return name && name[0] && strchr(letters, name[0]) && strlen(name) <= DRIVE_NAME &&
           strspn(name, all) == strlen(name);
}

static bool check_setting(const mps_drive_ops *ops, int32_t k, plugin_why *why)
{
    const mps_setting *s = &ops->settings[k];
    if (!is_name(s->key) || !s->unit || !s->unit[0] || !s->help || !s->help[0])
        return mps__plugin_fail(why, MPS_E_ARG, "setting %d of '%s' needs a key, a unit and a help",
                                (int)k, ops->name);
    if (!(s->min <= s->initial && s->initial <= s->max) || !isfinite(s->min) || !isfinite(s->max))
        return mps__plugin_fail(why, MPS_E_ARG,
                                "setting '%s' of '%s': the default %g is not in its "
                                "range, %g .. %g",
                                s->key, ops->name, s->initial, s->min, s->max);
    if (s->type != MPS_TYPE_REAL && s->type != MPS_TYPE_INTEGER && s->type != MPS_TYPE_FLAG)
        return mps__plugin_fail(why, MPS_E_ARG, "setting '%s' of '%s': %d is no MPS_TYPE_...",
                                s->key, ops->name, (int)s->type);
    return true;
}

/* A setting is named by the slot of a model or by the name of a load, so these names must
 * differ. */
static bool is_slot(const mps_sim *sim, const char *name)
{
    const size_t length = strlen(name);
    mps_model_info m;
    mps_model_info_init(&m, sizeof m);
    for (int32_t k = 0; mps_model_info_get(sim, k, &m) == MPS_OK; k++)
        if (strncmp(m.name, name, length) == 0 && m.name[length] == '.') return true;
    return false;
}

static bool check_drive(const host *h, const mps_drive_ops *ops)
{
    plugin_why *why = h->why;
    if (!ops || ops->struct_size < sizeof *ops)
        return mps__plugin_fail(why, MPS_E_ARG, "mps_drive_ops.struct_size must be sizeof");
    if (ops->api != MPS_PLUGIN_API)
        return mps__plugin_fail(why, MPS_E_VERSION, "mps_drive_ops.api is %u; this library has %u",
                                (unsigned)ops->api, MPS_PLUGIN_API);
    if (!is_name(ops->name))
        return mps__plugin_fail(
            why, MPS_E_ARG,
            "the name of a load or motion must have 1 to %d lower-case letters, "
            "digits and _, a letter first",
            DRIVE_NAME);
    if (!ops->help || !ops->help[0] || !ops->load == !ops->motion || ops->setting_count < 0 ||
        ops->setting_count > SETTINGS_MOST || (ops->setting_count > 0 && !ops->settings))
        return mps__plugin_fail(why, MPS_E_ARG,
                                "'%s' needs a help text, one of load and motion, and 0 to %d "
                                "settings with a table",
                                ops->name, SETTINGS_MOST);
    for (int32_t k = 0; k < ops->setting_count; k++)
        if (!check_setting(ops, k, why)) return false;
    for (int32_t k = 0; h->list && k < h->plugin->items; k++)
        if (strcmp(h->plugin->item[k].name, ops->name) == 0)
            return mps__plugin_fail(why, MPS_E_NAME, "the name '%s' is taken", ops->name);
    return !is_slot(h->sim, ops->name) ||
           mps__plugin_fail(why, MPS_E_NAME, "the name '%s' is a slot of models", ops->name);
}

static mps_status add_drive(void *user, const mps_drive_ops *ops)
{
    host *h = user;
    if (!check_drive(h, ops)) return h->why->status;
    return add(h, ops->load ? MPS_PLUGIN_LOAD : MPS_PLUGIN_MOTION, ops->name, ops->help, ops);
}

/* ---- the call ---- */

static bool check_about(const mps_registry *r, plugin_why *why)
{
    const char *const texts[] = {r->name, r->version};
    for (int k = 0; k < 2; k++)
        if (!texts[k] || !texts[k][0] || strlen(texts[k]) >= PLUGIN_NAME)
            return mps__plugin_fail(why, MPS_E_PLUGIN,
                                    "mps_plugin() must call mps_plugin_begin() with a name and a "
                                    "version of 1 to %d characters",
                                    PLUGIN_NAME - 1);
    return true;
}

bool mps__plugin_call(mps_plugin_file *p, mps_sim *sim, bool list, plugin_why *why)
{
    host h = {p, sim, list, why};
    mps_registry r = {.struct_size = sizeof r,
                      .api = MPS_PLUGIN_API,
                      .host = &h,
                      .model = add_model,
                      .solver = add_solver,
                      .preconditioner = add_preconditioner,
                      .drive = add_drive};
    const mps_status status = p->begin(&r);
    const bool newer = status == MPS_E_VERSION && !r.name; /* mps_plugin_begin() refused */
    if (r.plugin_api != 0 && (r.plugin_api != MPS_PLUGIN_API || newer))
        return mps__plugin_fail(why, MPS_E_VERSION,
                                "it has version %u of the interface <mps/plugin.h>, and this "
                                "program version %u; compile it with the headers of libmps %s",
                                (unsigned)r.plugin_api, MPS_PLUGIN_API,
                                mps_version(NULL, NULL, NULL));
    if (why->status != MPS_OK || !check_about(&r, why)) return false;
    if (status != MPS_OK)
        return mps__plugin_fail(why, MPS_E_PLUGIN, "mps_plugin() returned %d, %s", (int)status,
                                mps_status_text(status));
    if (!list) return true;
    memcpy(p->name, r.name, strlen(r.name) + 1);
    memcpy(p->version, r.version, strlen(r.version) + 1);
    if (p->items > 0) return true;
    return mps__plugin_fail(why, MPS_E_PLUGIN, "mps_plugin() registers nothing");
}

/* ---- public functions ---- */

static mps_status load(mps_plugin_file *p, const char *path, plugin_why *why)
{
    mps_config config;
    mps_sim *sim = NULL;
    if (!mps__plugin_load(p, path, why)) return why->status;
    mps_config_init(&config, sizeof config);
    config.dp = 1;
    if (mps_sim_create(&config, &sim) != MPS_OK)
        mps__plugin_fail(why, MPS_E_NOMEM, "no memory");
    else
        mps__plugin_call(p, sim, true, why);
    mps_sim_destroy(sim);
    return why->status;
}

mps_status mps_plugin_open(const char *path, mps_plugin_file **out, char *error, size_t size)
{
    plugin_why why = {.status = MPS_OK};
    if (error && size > 0) error[0] = '\0';
    if (out) *out = NULL;
    if (!path || !out || (size > 0 && !error)) return MPS_E_ARG;
    mps_plugin_file *p = calloc(1, sizeof *p);
    if (!p)
        mps__plugin_fail(&why, MPS_E_NOMEM, "no memory");
    else
        load(p, path, &why);
    if (why.status == MPS_OK)
        *out = p;
    else
        mps_plugin_close(p);
    if (error && size > 0) snprintf(error, size, "%s", why.text);
    return why.status;
}

void mps_plugin_close(mps_plugin_file *plugin)
{
    if (!plugin) return;
    if (plugin->handle) dlclose(plugin->handle);
    free(plugin);
}

mps_status mps_plugin_register(const mps_plugin_file *plugin, mps_sim *sim, char *error,
                               size_t size)
{
    plugin_why why = {.status = MPS_OK};
    char note[192];
    if (error && size > 0) error[0] = '\0';
    if (!plugin || !sim || (size > 0 && !error)) return MPS_E_ARG;
    snprintf(note, sizeof note, "plug-in %s %s SHA-256 %s", plugin->name, plugin->version,
             plugin->sha256);
    mps__plugin_call((mps_plugin_file *)plugin, sim, false, &why);
    const mps_status noted = why.status == MPS_OK ? mps_checkpoint_note_add(sim, note) : MPS_OK;
    if (noted != MPS_OK) mps__plugin_fail(&why, noted, "%s", mps_sim_error(sim));
    if (error && size > 0) snprintf(error, size, "%s", why.text);
    return why.status;
}

mps_status mps_plugin_info_init(mps_plugin_info *info, size_t size)
{
    if (!info || size != sizeof *info) return MPS_E_ARG;
    *info = (mps_plugin_info){.struct_size = sizeof *info};
    return MPS_OK;
}

mps_status mps_plugin_info_get(const mps_plugin_file *plugin, mps_plugin_info *info)
{
    if (!plugin || !info || info->struct_size != sizeof *info) return MPS_E_ARG;
    *info = (mps_plugin_info){.struct_size = sizeof *info,
                              .items = plugin->items,
                              .path = plugin->path,
                              .sha256 = plugin->sha256,
                              .name = plugin->name,
                              .version = plugin->version};
    return MPS_OK;
}

mps_status mps_plugin_item_init(mps_plugin_item *item, size_t size)
{
    if (!item || size != sizeof *item) return MPS_E_ARG;
    *item = (mps_plugin_item){.struct_size = sizeof *item};
    return MPS_OK;
}

mps_status mps_plugin_item_get(const mps_plugin_file *plugin, int32_t index, mps_plugin_item *item)
{
    if (!plugin || !item || item->struct_size != sizeof *item || index < 0 ||
        index >= plugin->items)
        return MPS_E_ARG;
    const plugin_item *p = &plugin->item[index];
    *item = (mps_plugin_item){.struct_size = sizeof *item,
                              .kind = p->kind,
                              .name = p->name,
                              .help = p->help,
                              .drive = p->kind >= MPS_PLUGIN_LOAD ? &p->drive : NULL};
    return MPS_OK;
}

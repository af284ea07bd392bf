/* SPDX-License-Identifier: BSD-3-Clause */
/* Registry of models, the active models and their settings. */
#include "models.h"
#include "built_in.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static size_t slot_length(const char *name)
{
    const char *dot = strchr(name, '.');
    return dot ? (size_t)(dot - name) : strlen(name);
}

bool mps__same_slot(const char *a, const char *b)
{
    size_t n = slot_length(a);
    return n == slot_length(b) && strncmp(a, b, n) == 0;
}

static int32_t find_active(const mps__models *m, const char *slot)
{
    for (int32_t k = 0; k < m->active; k++)
        if (mps__same_slot(m->on[k].ops->name, slot)) return k;
    return -1;
}

/* Like find_active(), but a full name must be that of the active model. */
static int32_t find_named(const mps__models *m, const char *slot)
{
    const int32_t k = find_active(m, slot);
    return k >= 0 && strchr(slot, '.') && strcmp(m->on[k].ops->name, slot) != 0 ? -1 : k;
}

static mps_status check_settings(mps__context *c, const mps_model_ops *ops)
{
    for (int32_t k = 0; k < ops->setting_count; k++) {
        const mps_setting *s = &ops->settings[k];
        MPS__CHECK(c, s->key && s->key[0] && s->unit && s->help,
                   "model '%s': setting %d has no key, unit or help", ops->name, (int)k);
        MPS__CHECK(c, s->initial >= s->min && s->initial <= s->max,
                   "model '%s': setting '%s' is %g, outside its range %g..%g", ops->name, s->key,
                   s->initial, s->min, s->max);
        MPS__CHECK(c, s->type >= MPS_TYPE_REAL && s->type <= MPS_TYPE_FLAG,
                   "model '%s': setting '%s' has type %d: MPS_TYPE_...", ops->name, s->key,
                   (int)s->type);
        MPS__CHECK(c, s->type == MPS_TYPE_REAL || s->initial == floor(s->initial),
                   "model '%s': setting '%s' is %g: must be a whole number", ops->name, s->key,
                   s->initial);
        MPS__CHECK(c, s->type != MPS_TYPE_FLAG || (s->min == 0 && s->max == 1),
                   "model '%s': flag '%s' allows %g..%g: must be 0..1", ops->name, s->key, s->min,
                   s->max);
    }
    return MPS_OK;
}

static mps_status check_verbs(mps__context *c, const mps_model_ops *ops)
{
    const int32_t known = MPS_USE_READ | MPS_USE_NEIGHBOURS | MPS_USE_WRITE | MPS_USE_OPTIONAL |
                          MPS_USE_DUMMIES | MPS_USE_ROWS;
    for (int32_t v = 0; v < ops->verb_count; v++) {
        const mps_verb *verb = &ops->verbs[v];
        MPS__CHECK(c, verb->run, "model '%s': verb %d has no function", ops->name, (int)v);
        MPS__CHECK(c, verb->hook >= 0 && verb->hook < MPS_HOOK_COUNT,
                   "model '%s': verb %d has hook %d: MPS_POPULATE..MPS_SHIFT", ops->name, (int)v,
                   (int)verb->hook);
        MPS__CHECK(c,
                   verb->use_count >= 0 && verb->use_count <= MPS__USES &&
                       (verb->use_count == 0 || verb->uses),
                   "model '%s': verb %d has %d uses: 0..%d, with a table", ops->name, (int)v,
                   (int)verb->use_count, MPS__USES);
        for (int32_t u = 0; u < verb->use_count; u++)
            MPS__CHECK(c,
                       verb->uses[u].channel && verb->uses[u].channel[0] &&
                           !(verb->uses[u].access & ~known) &&
                           verb->uses[u].access & (known & ~MPS_USE_OPTIONAL),
                       "model '%s': use %d of verb %d has no channel, or access %d, which is no "
                       "sum of MPS_USE_...",
                       ops->name, (int)u, (int)v, (int)verb->uses[u].access);
        for (int32_t u = 0; u < verb->use_count; u++)
            for (int32_t w = 0; w < u; w++)
                MPS__CHECK(c, strcmp(verb->uses[w].channel, verb->uses[u].channel) != 0,
                           "model '%s': verb %d uses channel '%s' twice: add the accesses",
                           ops->name, (int)v, verb->uses[u].channel);
    }
    return MPS_OK;
}

/* Check the tables that describe a model. */
static mps_status check_tables(mps__context *c, const mps_model_ops *ops)
{
    const struct {
        const char *what;
        int32_t count, least, most;
        const void *table;
    } all[] = {{"settings", ops->setting_count, 0, MPS__SETTINGS, ops->settings},
               {"channels", ops->channel_count, 0, MPS__BROUGHT, ops->channels},
               {"verbs", ops->verb_count, 1, MPS__VERBS, ops->verbs},
               {"parts", ops->part_count, 0, MPS__BROUGHT, ops->parts}};
    for (int k = 0; k < 4; k++)
        MPS__CHECK(c,
                   all[k].count >= all[k].least && all[k].count <= all[k].most &&
                       (all[k].count == 0 || all[k].table),
                   "model '%s' has %d %s: %d..%d, with a table", ops->name, (int)all[k].count,
                   all[k].what, (int)all[k].least, (int)all[k].most);
    MPS__TRY(check_settings(c, ops));
    for (int32_t k = 0; k < ops->channel_count; k++)
        MPS__TRY(mps__channel_check(c, ops->name, &ops->channels[k]));
    for (int32_t k = 0; k < ops->part_count; k++)
        MPS__CHECK(c, ops->parts[k] && ops->parts[k][0] && strlen(ops->parts[k]) < MPS__PART_NAME,
                   "model '%s': the name of part %d must have 1..%d characters", ops->name, (int)k,
                   MPS__PART_NAME - 1);
    return check_verbs(c, ops);
}

static mps_status check_ops(mps__models *m, const mps_model_ops *ops)
{
    mps__context *c = m->context;
    const char *dot = strchr(ops->name, '.');
    MPS__CHECK(c, dot && dot != ops->name && dot[1] && strlen(ops->name) < MPS__NAME_SIZE,
               "model name '%s': must be 'slot.variant' of at most %d characters", ops->name,
               MPS__NAME_SIZE - 1);
    MPS__CHECK(c, ops->help && ops->help[0], "model '%s' has no help text", ops->name);
    MPS__CHECK(c, !ops->create == !ops->destroy, "model '%s': create and destroy go together",
               ops->name);
    MPS__TRY(check_tables(c, ops));
    for (int32_t k = 0; k < m->known; k++)
        MPS__CHECK(c, strcmp(m->name[k], ops->name) != 0, "model name '%s' is taken", ops->name);
    MPS__CHECK(c, m->known < MPS__MODELS_KNOWN, "model '%s' is one too many: at most %d", ops->name,
               MPS__MODELS_KNOWN);
    return MPS_OK;
}

mps_status mps__models_register(mps__models *m, const mps_model_ops *ops)
{
    mps_model_ops copy = {0};
    MPS__TRY(mps__struct_in(m->context, "mps_model_ops", &copy, sizeof copy, ops));
    if (copy.api != MPS_MODEL_API)
        return mps__fail(m->context, MPS_E_VERSION, "model interface %u: this library has %u",
                         copy.api, MPS_MODEL_API);
    MPS__CHECK(m->context, copy.name, "a model needs a name");
    MPS__TRY(check_ops(m, &copy));
    mps__name_copy(m->name[m->known], MPS__NAME_SIZE, copy.name);
    copy.name = m->name[m->known];
    m->registry[m->known++] = copy;
    return MPS_OK;
}

mps_status mps__models_init(mps__models *m, mps__context *context, mps__channels *channels,
                            mps__particles *particles)
{
    *m = (mps__models){.context = context, .channels = channels, .particles = particles};
    for (int k = 0; mps__built_in_models[k]; k++)
        MPS__TRY(mps__models_register(m, mps__built_in_models[k]));
    m->built_in = m->known;
    return MPS_OK;
}

bool mps__models_foreign(const mps__models *m, const mps__model *model)
{
    return model->ops >= &m->registry[m->built_in];
}

/* Whether a verb of an active model declares an access. */
static bool any_use(const mps__models *m, int32_t access)
{
    bool any = false;
    for (int32_t k = 0; k < m->active; k++)
        for (int32_t v = 0; v < m->on[k].ops->verb_count; v++) {
            const mps_verb *verb = &m->on[k].ops->verbs[v];
            for (int32_t u = 0; u < verb->use_count; u++)
                any = any || verb->uses[u].access & access;
        }
    return any;
}

bool mps__models_dummy_rows(const mps__models *m)
{
    return any_use(m, MPS_USE_DUMMIES);
}

bool mps__models_neighbour_rows(const mps__models *m)
{
    return any_use(m, MPS_USE_ROWS);
}

bool mps__models_move_solids(const mps__models *m)
{
    bool any = false;
    for (int32_t k = 0; k < m->active; k++)
        for (int32_t v = 0; v < m->on[k].ops->verb_count; v++) {
            const mps_verb *verb = &m->on[k].ops->verbs[v];
            for (int32_t u = 0; u < verb->use_count; u++)
                any = any || (verb->uses[u].access & MPS_USE_WRITE &&
                              strcmp(verb->uses[u].channel, "solid_place") == 0);
        }
    return any;
}

double mps__models_reach(const mps__models *m, double dp)
{
    double reach = 0;
    for (int32_t k = 0; k < m->active; k++) {
        const mps_model_ops *ops = m->on[k].ops;
        if (ops->reach) reach = fmax(reach, ops->reach(m->on[k].k, dp));
    }
    return reach;
}

static void drop(mps__models *m, int32_t k)
{
    const mps_model_ops *ops = m->on[k].ops;
    if (ops->destroy) ops->destroy(&m->context->allocator, m->on[k].self);
    mps__numbers_free(m->context, &m->on[k].state);
    mps__channels_drop(m->channels, ops);
    m->changes++;
    memmove(&m->on[k], &m->on[k + 1], (size_t)(m->active - k - 1) * sizeof m->on[0]);
    m->active--;
}

void mps__models_free(mps__models *m)
{
    while (m->active > 0) drop(m, m->active - 1);
}

/* Names of all slots, without duplicates. */
static int32_t list_slots(const mps__models *m, char slot[][MPS__NAME_SIZE], const char *names[])
{
    int32_t count = 0;
    for (int32_t k = 0; k < m->known; k++) {
        bool first = true;
        for (int32_t j = 0; j < k; j++) first = first && !mps__same_slot(m->name[j], m->name[k]);
        if (!first) continue;
        memcpy(slot[count], m->name[k], slot_length(m->name[k]));
        slot[count][slot_length(m->name[k])] = 0;
        names[count] = slot[count];
        count++;
    }
    return count;
}

/* Set an error text that names the existing models of the slot, else the nearest name, else all
 * slots. */
static mps_status unknown_model(mps__models *m, const char *name)
{
    const char *names[MPS__MODELS_KNOWN];
    char hint[MPS__HINT_SIZE], slot[MPS__MODELS_KNOWN][MPS__NAME_SIZE];
    int32_t count = 0;
    for (int32_t k = 0; k < m->known; k++)
        if (mps__same_slot(m->name[k], name)) names[count++] = m->name[k];
    if (count > 0)
        return mps__fail(m->context, MPS_E_NAME, "no model \"%.60s\"; %s", name,
                         mps__hint(hint, '"', name, names, count));
    for (int32_t k = 0; k < m->known; k++) names[k] = m->name[k];
    const char *near = mps__near(name, names, m->known);
    if (near)
        return mps__fail(m->context, MPS_E_NAME, "no model \"%.60s\"; did you mean \"%s\"?", name,
                         near);
    return mps__fail(m->context, MPS_E_NAME, "no model \"%.60s\"; the slots are %s", name,
                     mps__list(hint, '"', names, list_slots(m, slot, names)));
}

static mps_status check_parts(const mps__models *m, const mps_model_ops *ops)
{
    int32_t fresh = 0;
    for (int32_t k = 0; k < ops->part_count; k++)
        fresh += mps__part_number(m->particles, ops->parts[k], false) < 0;
    MPS__CHECK(m->context, m->particles->parts + fresh <= MPS__PARTS_MAX,
               "model '%s' brings %d parts, and there are %d: at most %d", ops->name, (int)fresh,
               (int)m->particles->parts, MPS__PARTS_MAX);
    return MPS_OK;
}

/* Prepare a model for activation: create its state, add its channels. `leaving`: NULL, or the model
 * that it replaces. */
static mps_status make(mps__models *m, int32_t which, const mps_model_ops *leaving,
                       mps__model *fresh)
{
    const mps_model_ops *ops = &m->registry[which];
    *fresh = (mps__model){.ops = ops, .self = ops->user};
    MPS__TRY(check_parts(m, ops));
    for (int32_t k = 0; k < ops->setting_count; k++) fresh->k[k] = ops->settings[k].initial;
    const mps__lock before = mps__lock_set(m->context, MPS__LOCKED, "create of a model");
    const bool failed = ops->create && ops->create(&m->context->allocator, &fresh->self) != 0;
    m->context->lock = before;
    if (failed) return mps__fail(m->context, MPS_E_NOMEM, "no memory for model '%s'", ops->name);
    const mps_status status = mps__channels_bring(m->channels, m->particles, ops, leaving);
    if (status < 0 && ops->destroy) ops->destroy(&m->context->allocator, fresh->self);
    for (int32_t k = 0; k < ops->part_count && status == MPS_OK; k++)
        mps__part_number(m->particles, ops->parts[k], true);
    return status;
}

mps_status mps__models_use(mps__models *m, const char *name)
{
    MPS__CHECK(m->context, name, "the model's name is NULL");
    int32_t which = 0;
    while (which < m->known && strcmp(m->name[which], name) != 0) which++;
    if (which == m->known) return unknown_model(m, name);
    const int32_t old = find_active(m, name);
    MPS__CHECK(m->context, old >= 0 || m->active < MPS__MODELS_ACTIVE,
               "model \"%s\" is one too many: at most %d are active", name, MPS__MODELS_ACTIVE);
    mps__model fresh;
    MPS__TRY(make(m, which, old >= 0 ? m->on[old].ops : NULL, &fresh));
    if (old >= 0) drop(m, old);
    int32_t place = m->active;
    while (place > 0 && m->on[place - 1].ops > fresh.ops) place--;
    memmove(&m->on[place + 1], &m->on[place], (size_t)(m->active - place) * sizeof m->on[0]);
    m->on[place] = fresh;
    m->active++;
    m->changes++;
    return MPS_OK;
}

/* Set an error text that names the active model of the slot, else the nearest slot, else all active
 * slots. */
static mps_status not_active(mps__models *m, const char *slot)
{
    const char *names[MPS__MODELS_ACTIVE];
    char hint[MPS__HINT_SIZE], slots[MPS__MODELS_ACTIVE][MPS__NAME_SIZE];
    const int32_t k = find_active(m, slot);
    if (k >= 0)
        return mps__fail(m->context, MPS_E_NAME, "no active model \"%.60s\"; its slot has \"%s\"",
                         slot, m->on[k].ops->name);
    for (int32_t i = 0; i < m->active; i++) {
        const char *name = m->on[i].ops->name;
        snprintf(slots[i], sizeof slots[i], "%.*s", (int)slot_length(name), name);
        names[i] = slots[i];
    }
    const char *near = mps__near(slot, names, m->active);
    if (near)
        return mps__fail(m->context, MPS_E_NAME,
                         "no active model in slot \"%.60s\"; did you mean \"%s\"?", slot, near);
    return mps__fail(m->context, MPS_E_NAME,
                     "no active model in slot \"%.60s\"; the active slots are %s", slot,
                     m->active > 0 ? mps__list(hint, '"', names, m->active) : "none");
}

mps_status mps__models_remove(mps__models *m, const char *slot)
{
    MPS__CHECK(m->context, slot, "the slot is NULL");
    const int32_t k = find_named(m, slot);
    if (k < 0) return not_active(m, slot);
    drop(m, k);
    return MPS_OK;
}

mps_status mps__models_state(mps__models *m, const char *slot, const mps__numbers **state)
{
    const int32_t which = slot ? find_named(m, slot) : -1;
    if (which < 0) return not_active(m, slot ? slot : "NULL");
    *state = &m->on[which].state;
    return MPS_OK;
}

double *mps__models_value(mps__models *m, const char *slot, const char *key,
                          const mps_setting **setting)
{
    const int32_t which = slot ? find_named(m, slot) : -1;
    if (which < 0) {
        not_active(m, slot ? slot : "NULL");
        return NULL;
    }
    const mps_model_ops *ops = m->on[which].ops;
    const char *keys[MPS__SETTINGS];
    char hint[MPS__HINT_SIZE];
    for (int32_t k = 0; k < ops->setting_count; k++) {
        keys[k] = ops->settings[k].key;
        if (!key || strcmp(keys[k], key) != 0) continue;
        if (setting) *setting = &ops->settings[k];
        return &m->on[which].k[k];
    }
    if (ops->setting_count == 0)
        mps__fail(m->context, MPS_E_NAME, "model \"%s\" has no setting", ops->name);
    else if (!key)
        mps__fail(m->context, MPS_E_NAME,
                  "the key of a setting of model \"%s\" is NULL; there are %s", ops->name,
                  mps__list(hint, '"', keys, ops->setting_count));
    else
        mps__fail(m->context, MPS_E_NAME, "model \"%s\" has no setting \"%.60s\"; %s", ops->name,
                  key, mps__hint(hint, '"', key, keys, ops->setting_count));
    return NULL;
}

mps_status mps__models_preset(mps__models *m, const char *name)
{
    MPS__CHECK(m->context, name, "the preset's name is NULL");
    const char *names[MPS__PRESETS];
    char hint[MPS__HINT_SIZE];
    for (int p = 0; p < MPS__PRESETS; p++) {
        names[p] = mps__presets[p].name;
        if (strcmp(name, names[p]) != 0) continue;
        mps__models kept = *m;
        m->active = 0;
        mps_status status = MPS_OK;
        for (const mps__preset_line *l = mps__presets[p].lines; l->model && status == MPS_OK; l++) {
            if (!l->key)
                status = mps__models_use(m, l->model);
            else
                *mps__models_value(m, l->model, l->key, NULL) = l->value;
        }
        if (status == MPS_OK) {
            mps__models_free(&kept);
        } else {
            mps__models_free(m);
            kept.changes = m->changes;
            *m = kept;
        }
        return status;
    }
    return mps__fail(m->context, MPS_E_NAME, "no preset \"%.60s\"; %s", name,
                     mps__hint(hint, '"', name, names, MPS__PRESETS));
}

bool mps__models_preset_info(int32_t k, const char **name, const char **help)
{
    if (k < 0 || k >= MPS__PRESETS) return false;
    *name = mps__presets[k].name;
    *help = mps__presets[k].help;
    return true;
}

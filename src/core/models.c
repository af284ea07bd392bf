/* SPDX-License-Identifier: BSD-3-Clause */
/* Registry of models, the active list and its settings. */
#include "models.h"
#include "../bc/builtin.h"
#include "../phase/builtin.h"
#include <math.h>
#include <string.h>

/* One line of a preset: switch a model on (key NULL), or change a number of the one switched on last. */
typedef struct preset_line {
    const char *model, *key;
    double value;
} preset_line;

#include "presets.inc"

static size_t slot_length(const char *name)
{
    const char *dot = strchr(name, '.');
    return dot ? (size_t)(dot - name) : strlen(name);
}

static bool same_slot(const char *a, const char *b)
{
    size_t n = slot_length(a);
    return n == slot_length(b) && strncmp(a, b, n) == 0;
}

static int32_t find_active(const mps__models *m, const char *slot)
{
    for (int32_t k = 0; k < m->active; k++)
        if (same_slot(m->on[k].ops->name, slot)) return k;
    return -1;
}

/* As find_active(), but a full name must be the active model's own. */
static int32_t find_named(const mps__models *m, const char *slot)
{
    const int32_t k = find_active(m, slot);
    return k >= 0 && strchr(slot, '.') && strcmp(m->on[k].ops->name, slot) != 0 ? -1 : k;
}

static mps_status check_ops(mps__models *m, const mps_model_ops *ops)
{
    mps__context *c = m->context;
    const char *dot = strchr(ops->name, '.');
    MPS__CHECK(c, dot && dot != ops->name && dot[1] && strlen(ops->name) < MPS__NAME_SIZE,
               "model name \"%s\": must be \"slot.variant\" of at most %d characters", ops->name, MPS__NAME_SIZE - 1);
    MPS__CHECK(c, ops->classify || ops->force || ops->source || ops->gradient || ops->velocity || ops->shift || ops->dt_limit || ops->load,
               "model \"%s\" has no verb", ops->name);
    MPS__CHECK(c, !ops->create == !ops->destroy, "model \"%s\": create and destroy go together", ops->name);
    MPS__CHECK(c, ops->setting_count >= 0 && ops->setting_count <= MPS__SETTINGS && (ops->setting_count == 0 || ops->settings),
               "model \"%s\" has %d settings: 0..%d, with a table", ops->name, ops->setting_count, MPS__SETTINGS);
    for (int32_t k = 0; k < ops->setting_count; k++) {
        const mps_setting *s = &ops->settings[k];
        MPS__CHECK(c, s->key && s->initial >= s->min && s->initial <= s->max, "model \"%s\": setting %d is outside its own range",
                   ops->name, k);
    }
    for (int32_t k = 0; k < m->known; k++) MPS__CHECK(c, strcmp(m->name[k], ops->name) != 0, "model name \"%s\" is taken", ops->name);
    MPS__CHECK(c, m->known < MPS__MODELS_KNOWN, "model \"%s\" is one too many: at most %d", ops->name, MPS__MODELS_KNOWN);
    return MPS_OK;
}

mps_status mps__models_register(mps__models *m, const mps_model_ops *ops)
{
    mps_model_ops copy = {0};
    MPS__TRY(mps__struct_in(m->context, "mps_model_ops", &copy, sizeof copy, ops));
    if (copy.api != MPS_MODEL_API)
        return mps__fail(m->context, MPS_E_VERSION, "model interface %u: this library speaks %u", copy.api, MPS_MODEL_API);
    MPS__CHECK(m->context, copy.name, "a model needs a name");
    MPS__TRY(check_ops(m, &copy));
    mps__name_copy(m->name[m->known], MPS__NAME_SIZE, copy.name);
    copy.name = m->name[m->known];
    m->registry[m->known++] = copy;
    return MPS_OK;
}

mps_status mps__models_init(mps__models *m, mps__context *context)
{
    *m = (mps__models){.context = context};
    const mps_model_ops *const *lists[] = {mps__builtin_bc(), mps__builtin_phase()};
    for (size_t l = 0; l < 2; l++)
        for (const mps_model_ops *const *ops = lists[l]; *ops; ops++) MPS__TRY(mps__models_register(m, *ops));
    m->built_in = m->known;
    return MPS_OK;
}

bool mps__models_foreign(const mps__models *m, const mps__model *model)
{
    return model->ops >= &m->registry[m->built_in];
}

static void drop(mps__models *m, int32_t k)
{
    if (m->on[k].ops->destroy) m->on[k].ops->destroy(m->on[k].self);
    memmove(&m->on[k], &m->on[k + 1], (size_t)(m->active - k - 1) * sizeof m->on[0]);
    m->active--;
}

void mps__models_free(mps__models *m)
{
    while (m->active > 0) drop(m, m->active - 1);
}

/* Names of all slots, each once. */
static int32_t list_slots(const mps__models *m, char slot[][MPS__NAME_SIZE], const char *names[])
{
    int32_t count = 0;
    for (int32_t k = 0; k < m->known; k++) {
        bool first = true;
        for (int32_t j = 0; j < k; j++) first = first && !same_slot(m->name[j], m->name[k]);
        if (!first) continue;
        memcpy(slot[count], m->name[k], slot_length(m->name[k]));
        slot[count][slot_length(m->name[k])] = 0;
        names[count] = slot[count];
        count++;
    }
    return count;
}

/* Who means a slot that is there means one of its models. */
static mps_status unknown_model(mps__models *m, const char *name)
{
    const char *names[MPS__MODELS_KNOWN];
    char hint[MPS__HINT_SIZE], slot[MPS__MODELS_KNOWN][MPS__NAME_SIZE];
    int32_t count = 0;
    for (int32_t k = 0; k < m->known; k++)
        if (same_slot(m->name[k], name)) names[count++] = m->name[k];
    if (count > 0) return mps__fail(m->context, MPS_E_NAME, "no model \"%.60s\"; %s", name, mps__hint(hint, '"', name, names, count));
    for (int32_t k = 0; k < m->known; k++) names[k] = m->name[k];
    const char *near = mps__near(name, names, m->known);
    if (near) return mps__fail(m->context, MPS_E_NAME, "no model \"%.60s\"; did you mean \"%s\"?", name, near);
    return mps__fail(m->context, MPS_E_NAME, "no model \"%.60s\"; the slots are %s", name,
                     mps__list(hint, '"', names, list_slots(m, slot, names)));
}

mps_status mps__models_use(mps__models *m, const char *name)
{
    MPS__CHECK(m->context, name, "the model's name is NULL");
    int32_t which = 0;
    while (which < m->known && strcmp(m->name[which], name) != 0) which++;
    if (which == m->known) return unknown_model(m, name);
    const int32_t old = find_active(m, name);
    MPS__CHECK(m->context, old >= 0 || m->active < MPS__MODELS_ACTIVE, "model \"%s\" is one too many: at most %d are active", name,
               MPS__MODELS_ACTIVE);
    mps__model fresh = {.ops = &m->registry[which]};
    for (int32_t k = 0; k < fresh.ops->setting_count; k++) fresh.k[k] = fresh.ops->settings[k].initial;
    if (fresh.ops->create && fresh.ops->create(&m->context->allocator, &fresh.self) != 0)
        return mps__fail(m->context, MPS_E_NOMEM, "no memory for model \"%s\"", name);
    if (old >= 0) drop(m, old);
    int32_t place = m->active;
    while (place > 0 && m->on[place - 1].ops->order > fresh.ops->order) place--;
    memmove(&m->on[place + 1], &m->on[place], (size_t)(m->active - place) * sizeof m->on[0]);
    m->on[place] = fresh;
    m->active++;
    return MPS_OK;
}

mps_status mps__models_remove(mps__models *m, const char *slot)
{
    MPS__CHECK(m->context, slot, "the slot is NULL");
    const int32_t k = find_named(m, slot);
    if (k < 0) return mps__fail(m->context, MPS_E_NAME, "no active model in slot \"%s\"", slot);
    drop(m, k);
    return MPS_OK;
}

double *mps__models_value(mps__models *m, const char *slot, const char *key, const mps_setting **setting)
{
    const int32_t which = slot ? find_named(m, slot) : -1;
    if (which < 0) {
        mps__fail(m->context, MPS_E_NAME, "no active model in slot \"%s\"", slot ? slot : "NULL");
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
        mps__fail(m->context, MPS_E_NAME, "the key of a setting of model \"%s\" is NULL; there are %s", ops->name,
                  mps__list(hint, '"', keys, ops->setting_count));
    else
        mps__fail(m->context, MPS_E_NAME, "model \"%s\" has no setting \"%.60s\"; %s", ops->name, key,
                  mps__hint(hint, '"', key, keys, ops->setting_count));
    return NULL;
}

mps_status mps__models_preset(mps__models *m, const char *name)
{
    MPS__CHECK(m->context, name, "the preset's name is NULL");
    const char *names[PRESET_COUNT];
    char hint[MPS__HINT_SIZE];
    for (size_t p = 0; p < PRESET_COUNT; p++) {
        names[p] = presets[p].name;
        if (strcmp(name, names[p]) != 0) continue;
        mps__models kept = *m;
        m->active = 0;
        mps_status status = MPS_OK;
        for (const preset_line *l = presets[p].lines; l->model && status == MPS_OK; l++) {
            if (!l->key)
                status = mps__models_use(m, l->model);
            else
                *mps__models_value(m, l->model, l->key, NULL) = l->value;
        }
        if (status == MPS_OK) {
            mps__models_free(&kept);
        } else {
            mps__models_free(m);
            *m = kept;
        }
        return status;
    }
    return mps__fail(m->context, MPS_E_NAME, "no preset \"%.60s\"; %s", name, mps__hint(hint, '"', name, names, PRESET_COUNT));
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Public functions of mps/list.h. */
#include "sim.h"
#include <mps/list.h>
#include <stdio.h>
#include <string.h>

static const mps_model_info model_default = {.struct_size = sizeof(mps_model_info)};
static const mps_setting_info setting_default = {.struct_size = sizeof(mps_setting_info)};
static const mps_channel_info channel_default = {.struct_size = sizeof(mps_channel_info)};
static const mps_verb_info verb_default = {.struct_size = sizeof(mps_verb_info)};
static const mps_pass_info pass_default = {.struct_size = sizeof(mps_pass_info)};
static const mps_name_info name_default = {.struct_size = sizeof(mps_name_info)};

mps_status mps_model_info_init(mps_model_info *info, size_t size)
{
    return mps__struct_init("mps_model_info", info, size, &model_default, sizeof model_default);
}

mps_status mps_setting_info_init(mps_setting_info *info, size_t size)
{
    return mps__struct_init("mps_setting_info", info, size, &setting_default,
                            sizeof setting_default);
}

mps_status mps_channel_info_init(mps_channel_info *info, size_t size)
{
    return mps__struct_init("mps_channel_info", info, size, &channel_default,
                            sizeof channel_default);
}

mps_status mps_verb_info_init(mps_verb_info *info, size_t size)
{
    return mps__struct_init("mps_verb_info", info, size, &verb_default, sizeof verb_default);
}

mps_status mps_pass_info_init(mps_pass_info *info, size_t size)
{
    return mps__struct_init("mps_pass_info", info, size, &pass_default, sizeof pass_default);
}

mps_status mps_name_info_init(mps_name_info *info, size_t size)
{
    return mps__struct_init("mps_name_info", info, size, &name_default, sizeof name_default);
}

/* ---- models ---- */

/* Active model of a table, or NULL. */
static const mps__model *active(const mps__models *m, const mps_model_ops *ops)
{
    for (int32_t k = 0; k < m->active; k++)
        if (m->on[k].ops == ops) return &m->on[k];
    return NULL;
}

mps_status mps_model_info_get(const mps_sim *sim, int32_t index, mps_model_info *info)
{
    if (!sim) return MPS_E_ARG;
    const mps__models *m = &sim->world.models;
    if (index < 0 || index >= m->known) return MPS_E_ARG;
    const mps_model_ops *ops = &m->registry[index];
    const mps_model_info found = {.struct_size = sizeof found,
                                  .active = active(m, ops) != NULL,
                                  .name = ops->name,
                                  .help = ops->help,
                                  .settings = ops->setting_count,
                                  .channels = ops->channel_count,
                                  .verbs = ops->verb_count,
                                  .built_in = index < m->built_in};
    return mps__struct_out(mps__sim_context(sim), "mps_model_info", info, &found, sizeof found);
}

mps_status mps_setting_info_get(const mps_sim *sim, const char *model, int32_t index,
                                mps_setting_info *info)
{
    if (!sim) return MPS_E_ARG;
    mps__context *c = mps__sim_context(sim);
    const mps__models *m = &sim->world.models;
    const mps_model_ops *ops = NULL;
    MPS__CHECK(c, model, "the model's name is NULL");
    for (int32_t k = 0; k < m->known && !ops; k++)
        if (strcmp(m->name[k], model) == 0) ops = &m->registry[k];
    if (!ops) return mps__fail(c, MPS_E_NAME, "no model '%.60s'", model);
    if (index < 0 || index >= ops->setting_count) return MPS_E_ARG;
    const mps_setting *s = &ops->settings[index];
    const mps__model *on = active(m, ops);
    const mps_setting_info found = {.struct_size = sizeof found,
                                    .type = s->type,
                                    .key = s->key,
                                    .unit = s->unit,
                                    .help = s->help,
                                    .initial = s->initial,
                                    .min = s->min,
                                    .max = s->max,
                                    .value = on ? on->k[index] : s->initial};
    return mps__struct_out(c, "mps_setting_info", info, &found, sizeof found);
}

mps_status mps_channel_info_get(const mps_sim *sim, int32_t index, mps_channel_info *info)
{
    if (!sim) return MPS_E_ARG;
    const mps__channels *c = &sim->world.channels;
    const int32_t hidden = MPS__OWN_CHANNELS - MPS__PUBLIC_CHANNELS;
    if (index < 0 || index >= c->count - hidden) return MPS_E_ARG;
    const mps__channel *k = &c->list[index < MPS__PUBLIC_CHANNELS ? index : index + hidden];
    const mps_channel_info found = {.struct_size = sizeof found,
                                    .components = k->components,
                                    .type = k->spec.type,
                                    .life = k->spec.life,
                                    .name = k->spec.name,
                                    .unit = k->spec.unit,
                                    .help = k->spec.help,
                                    .reads = k->reads,
                                    .writes = k->writes,
                                    .own = index < MPS__PUBLIC_CHANNELS};
    return mps__struct_out(mps__sim_context(sim), "mps_channel_info", info, &found, sizeof found);
}

/* "name:rw? name:n" */
static void fill_uses(const mps__call *call, char out[MPS__USES_SIZE])
{
    size_t used = 0;
    out[0] = 0;
    for (int32_t u = 0; u < call->use_count; u++) {
        const int32_t a = call->uses[u].access;
        const char *read = a & MPS_USE_ROWS         ? "a"
                           : a & MPS_USE_DUMMIES    ? "d"
                           : a & MPS_USE_NEIGHBOURS ? "n"
                           : a & MPS_USE_READ       ? "r"
                                                    : "";
        const int length = snprintf(out + used, MPS__USES_SIZE - used, "%s%s:%s%s%s", u ? " " : "",
                                    call->uses[u].channel, read, a & MPS_USE_WRITE ? "w" : "",
                                    a & MPS_USE_OPTIONAL ? "?" : "");
        if (length < 0 || used + (size_t)length >= MPS__USES_SIZE) break;
        used += (size_t)length;
    }
    out[used] = 0; /* no truncated names */
}

/* Verb number `index` of the plan, or NULL. */
static const mps__call *find_verb(const mps__plan *p, int32_t index)
{
    for (int32_t k = 0; k < p->begin[MPS_HOOK_COUNT] && index >= 0; k++)
        if (p->call[k].model && index-- == 0) return &p->call[k];
    return NULL;
}

mps_status mps_verb_info_get(mps_sim *sim, int32_t index, mps_verb_info *info)
{
    if (!sim) return MPS_E_ARG;
    mps__plan *p = &sim->world.runner.plan;
    if (mps__plan_make(p, &sim->world.models) < 0) return MPS_E_STATE;
    const mps__call *call = find_verb(p, index);
    if (!call) return MPS_E_ARG;
    fill_uses(call, sim->uses);
    const mps_verb_info found = {.struct_size = sizeof found,
                                 .hook = call->hook,
                                 .hook_name = mps__hook_name(call->hook),
                                 .model = call->name,
                                 .uses = sim->uses};
    return mps__struct_out(&sim->context, "mps_verb_info", info, &found, sizeof found);
}

/* ---- passes ---- */

mps_status mps_pass_info_get(mps_sim *sim, int32_t index, mps_pass_info *info)
{
    const mps__call *call;
    int part;
    if (!sim) return MPS_E_ARG;
    mps__plan *p = &sim->world.runner.plan;
    if (mps__plan_make(p, &sim->world.models) < 0) return MPS_E_STATE;
    if (!mps__plan_entry(p, index, &call, &part)) return MPS_E_ARG;
    const mps__cost *cost = call ? &call->cost : &p->outside[part];
    sim->uses[0] = 0;
    if (call) fill_uses(call, sim->uses);
    const mps_pass_info found = {.struct_size = sizeof found,
                                 .hook = call ? call->hook : -1,
                                 .hook_name = call ? mps__hook_name(call->hook) : "step",
                                 .name = call ? call->name : mps__part_name(part),
                                 .uses = sim->uses,
                                 .model = call && call->model,
                                 .calls = cost->calls,
                                 .seconds = cost->seconds,
                                 .bytes = cost->bytes};
    return mps__struct_out(&sim->context, "mps_pass_info", info, &found, sizeof found);
}

mps_status mps_profile_reset(mps_sim *sim)
{
    MPS__READS(sim);
    mps__plan *p = &sim->world.runner.plan;
    MPS__TRY(mps__plan_make(p, &sim->world.models));
    mps__plan_clear_costs(p);
    return MPS_OK;
}

/* ---- names ---- */

static mps_status fill_name(const mps_sim *sim, mps_name_info *info, const char *name,
                            const char *help, bool in_use)
{
    const mps_name_info found = {
        .struct_size = sizeof found, .active = in_use, .name = name, .help = help ? help : ""};
    return mps__struct_out(mps__sim_context(sim), "mps_name_info", info, &found, sizeof found);
}

mps_status mps_preset_info_get(const mps_sim *sim, int32_t index, mps_name_info *info)
{
    const char *name, *help;
    if (!sim || !mps__models_preset_info(index, &name, &help)) return MPS_E_ARG;
    return fill_name(sim, info, name, help, false);
}

mps_status mps_solver_info_get(const mps_sim *sim, int32_t index, mps_name_info *info)
{
    if (!sim || index < 0 || index >= sim->world.solvers.solvers) return MPS_E_ARG;
    const mps_solver_ops *ops = &sim->world.solvers.solver[index];
    return fill_name(sim, info, ops->name, ops->help, sim->world.solvers.use == ops);
}

mps_status mps_preconditioner_info_get(const mps_sim *sim, int32_t index, mps_name_info *info)
{
    if (!sim || index < 0 || index >= sim->world.solvers.preconditioners) return MPS_E_ARG;
    const mps_preconditioner_ops *ops = &sim->world.solvers.preconditioner[index];
    return fill_name(sim, info, ops->name, ops->help, sim->world.solvers.pc == ops);
}

mps_status mps_kernel_info_get(const mps_sim *sim, int32_t index, mps_name_info *info)
{
    static const char *const name[] = {"improved", "original"};
    static const char *const help[] = {"re/(0.85 r + 0.15 re) - 1, W22 (3): finite at r = 0",
                                       "re/r - 1, Z14 (3)"};
    if (!sim || index < 0 || index > 1) return MPS_E_ARG;
    return fill_name(sim, info, name[index], help[index],
                     sim->world.setup.kernel.id == MPS_KERNEL_IMPROVED + index);
}

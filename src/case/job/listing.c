/* SPDX-License-Identifier: BSD-3-Clause */
/* Prints lists of the library, as the library reports them. */
#include <math.h>
#include <mps/job.h>
#include <mps/model.h>
#include <mps/mps.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const type_name[] = {"real", "integer", "flag"};

static void print_number(FILE *out, double value)
{
    if (value >= 1e6)
        fprintf(out, "1e%g", log10(value));
    else
        fprintf(out, "%g", value);
}

static void print_settings(FILE *out, const mps_sim *sim, const char *model)
{
    mps_setting_info k;
    mps_setting_info_init(&k, sizeof k);
    for (int32_t i = 0; mps_setting_info_get(sim, model, i, &k) == MPS_OK; i++) {
        if (i == 0)
            fprintf(out, "| setting | default | range | unit | meaning |\n|---|---|---|---|---|\n");
        fprintf(out, "| `%s` | ", k.key);
        print_number(out, k.initial);
        if (k.type == MPS_TYPE_FLAG)
            fprintf(out, " | 0 or 1");
        else {
            fprintf(out, " | ");
            print_number(out, k.min);
            fprintf(out, " .. ");
            print_number(out, k.max);
        }
        fprintf(out, " | %s | %s |\n", k.unit, k.help);
    }
    fprintf(out, "\n");
}

static void print_models(FILE *out, const mps_sim *sim)
{
    mps_model_info m;
    mps_model_info_init(&m, sizeof m);
    fprintf(out,
            "## Models\n\nA name is `slot.variant`; a slot holds one model.\n\n| to | in a program "
            "| in a driver |\n|---|---|---|\n"
            "| switch a model on | `mps_model_use()` | `--use NAME` |\n| switch a slot off | "
            "`mps_model_remove()` | `--remove SLOT` |\n"
            "| change a setting | `mps_model_set()` | `--set SLOT.KEY=VALUE` |\n\n");
    for (int32_t i = 0; mps_model_info_get(sim, i, &m) == MPS_OK; i++) {
        fprintf(out, "### %s\n\n%s.\n\n", m.name, m.help);
        if (m.settings > 0) print_settings(out, sim, m.name);
    }
}

static void print_channels(FILE *out, const mps_sim *sim)
{
    mps_channel_info c;
    mps_channel_info_init(&c, sizeof c);
    fprintf(
        out,
        "## Channels of the library\n\nArrays with values per particle that verbs of models may "
        "use; with 0 numbers: one number for all particles.\n\n"
        "| channel | numbers in 2-D | type | unit | meaning |\n|---|---|---|---|---|\n");
    for (int32_t i = 0; mps_channel_info_get(sim, i, &c) == MPS_OK; i++)
        if (c.own)
            fprintf(out, "| `%s` | %d | %s | %s | %s |\n", c.name, (int)c.components,
                    type_name[c.type], c.unit, c.help);
    fprintf(out, "\n## Channels of models\n\n| channel | numbers in 2-D | type | unit | meaning "
                 "|\n|---|---|---|---|---|\n");
}

/* Print channels that the models of a preset add, unless an earlier model did. */
static void print_brought(FILE *out, const mps_sim *sim)
{
    mps_channel_info c;
    mps_channel_info_init(&c, sizeof c);
    for (int32_t i = 0; mps_channel_info_get(sim, i, &c) == MPS_OK; i++)
        if (!c.own)
            fprintf(out, "| `%s` | %d | %s | %s | %s |\n", c.name, (int)c.components,
                    type_name[c.type], c.unit, c.help);
}

static void print_order(FILE *out, mps_sim *sim, const char *preset)
{
    mps_verb_info v;
    mps_verb_info_init(&v, sizeof v);
    if (mps_preset_use(sim, preset) != MPS_OK) return;
    fprintf(out,
            "## Order of a step: %s\n\nChannels: `r` reads its own row, `n` neighbours too, `w` "
            "writes, `?` may be missing.\n\n"
            "| hook | model | channels |\n|---|---|---|\n",
            preset);
    for (int32_t i = 0; mps_verb_info_get(sim, i, &v) == MPS_OK; i++)
        fprintf(out, "| %s | `%s` | %s |\n", v.hook_name, v.model, v.uses);
    fprintf(out, "\n");
}

/* Print the settings of one model that a preset changes. */
static void print_changes(FILE *out, const mps_sim *sim, const char *preset, const char *model)
{
    mps_setting_info k;
    mps_setting_info_init(&k, sizeof k);
    for (int32_t i = 0; mps_setting_info_get(sim, model, i, &k) == MPS_OK; i++) {
        double value;
        if (mps_model_get(sim, model, k.key, &value) != MPS_OK || value == k.initial) continue;
        fprintf(out, "| `%s` | `%s %s` | ", preset, model, k.key);
        print_number(out, k.initial);
        fprintf(out, " | ");
        print_number(out, value);
        fprintf(out, " |\n");
    }
}

static void print_preset_settings(FILE *out, mps_sim *sim)
{
    mps_name_info n;
    mps_model_info m;
    mps_name_info_init(&n, sizeof n);
    mps_model_info_init(&m, sizeof m);
    fprintf(out, "Settings that a preset changes:\n\n| preset | setting | default | in the preset "
                 "|\n|---|---|---|---|\n");
    for (int32_t k = 0; mps_preset_info_get(sim, k, &n) == MPS_OK; k++) {
        if (mps_preset_use(sim, n.name) != MPS_OK) continue;
        for (int32_t i = 0; mps_model_info_get(sim, i, &m) == MPS_OK; i++)
            if (m.active) print_changes(out, sim, n.name, m.name);
    }
    fprintf(out, "\n");
    mps_preset_use(sim, "imps");
}

typedef mps_status (*name_fn)(const mps_sim *sim, int32_t index, mps_name_info *info);

static void print_names(FILE *out, const mps_sim *sim, const char *title, name_fn get)
{
    mps_name_info n;
    mps_name_info_init(&n, sizeof n);
    fprintf(out, "## %s\n\n| name | meaning |\n|---|---|\n", title);
    for (int32_t i = 0; get(sim, i, &n) == MPS_OK; i++)
        fprintf(out, "| `%s` | %s%s |\n", n.name, n.help, n.active ? " (default)" : "");
    fprintf(out, "\n");
}

static void print_all(FILE *out, mps_sim *sim)
{
    fprintf(out,
            "# Models, channels and solvers\n\nPrinted by any driver with `--list-models`.\n\n"
            "W22: Wen, Zhao & Wan 2022; Z14: Zhang, Wan & Hino 2014. dp: particle spacing. n: "
            "number density, n0: that of\n"
            "the full lattice. U_g = sqrt(g dp), tau_g = sqrt(dp/g). M: moment matrix. A flag is 0 "
            "(off) or 1 (on).\n\n");
    print_names(out, sim, "Presets", mps_preset_info_get);
    print_preset_settings(out, sim);
    print_models(out, sim);
    print_channels(out, sim);
    mps_preset_use(sim, "mmps"); /* adds all channels */
    print_brought(out, sim);
    fprintf(out, "\n");
    print_order(out, sim, "imps");
    print_order(out, sim, "mmps");
    print_order(out, sim, "imps.paper");
    print_order(out, sim, "mmps.paper");
    mps_preset_use(sim, "imps");
    print_names(out, sim, "Pressure solvers", mps_solver_info_get);
    print_names(out, sim, "Preconditioners", mps_preconditioner_info_get);
    print_names(out, sim, "Kernels", mps_kernel_info_get);
}

mps_status mps_job_models_text(char **text)
{
    mps_config config;
    mps_sim *sim = NULL;
    size_t size;
    if (!text) return MPS_E_ARG;
    *text = NULL;
    mps_config_init(&config, sizeof config);
    config.dp = 1;
    if (mps_sim_create(&config, &sim) != MPS_OK) return MPS_E_NOMEM;
    FILE *out = open_memstream(text, &size);
    if (out) print_all(out, sim);
    mps_sim_destroy(sim);
    const bool failed = !out || ferror(out);
    if (out && fclose(out) == 0 && !failed) return MPS_OK;
    free(*text);
    *text = NULL;
    return MPS_E_NOMEM;
}

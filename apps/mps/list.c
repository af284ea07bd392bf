/* SPDX-License-Identifier: BSD-3-Clause */
/* mps list: contents of the library and of the language of cases. */
#include "cli.h"
#include "starts.h"
#include <dirent.h>
#include <mps/mps.h>
#include <mps/model.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static mps_sim *make_sim(void)
{
    mps_config config;
    mps_sim *sim = NULL;
    mps_config_init(&config, sizeof config);
    config.dp = 1;
    mps_sim_create(&config, &sim);
    return sim;
}

/* The second comment line or the title of a case describes it. */
void cli_list_cases(FILE *out)
{
    for (const start *s = starts; s->name; s++) {
        if (strchr(s->name, '.')) continue; /* a table of one of them */
        const char *title = strstr(s->text, "\ntitle: ");
        const int length = title ? (int)strcspn(title + 8, "\n") : 0;
        fprintf(out, "%-20s %.*s\n", s->name, length, title ? title + 8 : "");
    }
}

/* Whether a name is an element of a path, or a text is its beginning: "holes", "solids",
 * "motion.roll". */
static bool is_on_path(const char *path, const char *name)
{
    const size_t length = strlen(name);
    if (strncmp(path, name, length) == 0 && strchr(".|", path[length])) return true;
    for (const char *at = path; *at; at += strcspn(at, ".|"), at += *at != '\0')
        if (strcspn(at, ".|") == length && strncmp(at, name, length) == 0) return true;
    return false;
}

/* Whether a text contains a word or a part of one, in lower or upper case. */
static bool has_word(const char *text, const char *word)
{
    const size_t length = strlen(word);
    for (; *text; text++)
        if (strncasecmp(text, word, length) == 0) return true;
    return false;
}

static void print_key(const mps_case_key *k)
{
    printf("%s%s\n    %s", k->path, k->required ? " (required)" : "", k->help);
    if (k->kind[0]) printf("; %s", k->kind);
    if (k->range[0]) printf(", %s", k->range);
    if (k->otherwise[0]) printf("; default: %s", k->otherwise);
    if (k->example[0]) printf("; e.g. %s", k->example);
    printf("\n");
}

/* List all keys; or those of one name, then those whose text or example contains it.
 * @return exit code */
static int list_keys(const char *name)
{
    mps_case_key k = {.struct_size = sizeof k};
    int32_t count = 0;
    for (int texts = 0; texts < (name ? 2 : 1); texts++)
        for (int32_t i = 0; mps_case_key_get(i, &k) == MPS_OK; i++) {
            const bool named = !name || is_on_path(k.path, name);
            const bool in_text = name && !named &&
                                 (has_word(k.help, name) || has_word(k.path, name) ||
                                  has_word(k.example, name));
            if (!k.path[0] || !(texts ? in_text : named)) continue;
            count++;
            print_key(&k);
        }
    if (count > 0) return MPS_EXIT_OK;
    fprintf(stderr, "mps list: no key and no text of one has '%s'; 'mps list keys' shows all\n",
            name);
    return MPS_EXIT_USAGE;
}

/* List each kind of quantity once, with its units. */
static void list_units(void)
{
    mps_case_key k = {.struct_size = sizeof k}, earlier = {.struct_size = sizeof earlier};
    for (int32_t i = 0; mps_case_key_get(i, &k) == MPS_OK; i++) {
        bool known = !k.units[0] || strchr(k.path, '*') == k.path;
        for (int32_t j = 0; j < i && !known; j++)
            known = mps_case_key_get(j, &earlier) == MPS_OK && strcmp(earlier.kind, k.kind) == 0;
        if (!known) printf("%-24s %s\n", k.kind, k.units);
    }
}

static void list_models(const mps_sim *sim)
{
    mps_name_info n;
    mps_model_info m;
    mps_name_info_init(&n, sizeof n);
    mps_model_info_init(&m, sizeof m);
    printf("model:\n");
    for (int32_t i = 0; mps_preset_info_get(sim, i, &n) == MPS_OK; i++)
        printf("  %-24s %s\n", n.name, n.help);
    printf("use:\n");
    for (int32_t i = 0; mps_model_info_get(sim, i, &m) == MPS_OK; i++)
        printf("  %-24s %s\n", m.name, m.help);
}

static void list_settings(const mps_sim *sim)
{
    mps_model_info m;
    mps_setting_info k;
    mps_model_info_init(&m, sizeof m);
    mps_setting_info_init(&k, sizeof k);
    for (int32_t i = 0; mps_model_info_get(sim, i, &m) == MPS_OK; i++) {
        if (m.settings > 0) printf("%s\n", m.name);
        for (int32_t j = 0; mps_setting_info_get(sim, m.name, j, &k) == MPS_OK; j++)
            printf("  %.*s.%s: %s; %g .. %g %s, default %g\n", (int)strcspn(m.name, "."), m.name,
                   k.key, k.help, k.min, k.max, k.unit, k.initial);
    }
}

static void list_solvers(const mps_sim *sim)
{
    mps_name_info n;
    mps_name_info_init(&n, sizeof n);
    printf("run.solver:\n");
    for (int32_t i = 0; mps_solver_info_get(sim, i, &n) == MPS_OK; i++)
        printf("  %-24s %s\n", n.name, n.help);
    printf("run.preconditioner:\n");
    for (int32_t i = 0; mps_preconditioner_info_get(sim, i, &n) == MPS_OK; i++)
        printf("  %-24s %s\n", n.name, n.help);
    printf("kernel.name:\n");
    for (int32_t i = 0; mps_kernel_info_get(sim, i, &n) == MPS_OK; i++)
        printf("  %-24s %s\n", n.name, n.help);
}

static void list_measures(void)
{
    mps_measure_info m;
    mps_measure_info_init(&m, sizeof m);
    for (int32_t i = 0; mps_measure_info_get(i, &m) == MPS_OK; i++)
        printf("%-18s %s%s%s%s\n", m.name, m.unit[0] ? "[" : "", m.unit, m.unit[0] ? "] " : "",
               m.help);
}

/* ---- plug-ins ---- */

enum { WHY_SIZE = 640 };

/* Load the plug-ins of the command line, and register them on a simulation if there is one. */
static int load_plugins(const choices *c, mps_sim *sim, mps_plugin_file **loaded)
{
    char why[WHY_SIZE];
    for (int32_t k = 0; k < c->plugins; k++) {
        mps_status status = mps_plugin_open(c->plugin[k], &loaded[k], why, sizeof why);
        if (status == MPS_OK) status = mps_plugin_register(loaded[k], sim, why, sizeof why);
        if (status == MPS_OK) continue;
        fprintf(stderr, "mps list: --plugin %s: %s\n", c->plugin[k], why);
        return status == MPS_E_NOMEM ? MPS_EXIT_FAILED : MPS_EXIT_USAGE;
    }
    return MPS_EXIT_OK;
}

static void list_drive(const mps_drive_ops *drive)
{
    for (int32_t j = 0; drive && j < drive->setting_count; j++) {
        const mps_setting *k = &drive->settings[j];
        printf("    %s.%s: %s; %g .. %g %s, default %g\n", drive->name, k->key, k->help, k->min,
               k->max, k->unit, k->initial);
    }
}

static void list_plugin(const mps_plugin_file *plugin)
{
    static const char *const kind[] = {"use", "run.solver", "run.preconditioner",
                                       "body.load.plugin", "motion.plugin"};
    mps_plugin_info info;
    mps_plugin_item item;
    mps_plugin_info_init(&info, sizeof info);
    mps_plugin_item_init(&item, sizeof item);
    if (mps_plugin_info_get(plugin, &info) != MPS_OK) return;
    printf("%s %s\n  file %s\n  SHA-256 %s\n", info.name, info.version, info.path, info.sha256);
    for (int32_t i = 0; mps_plugin_item_get(plugin, i, &item) == MPS_OK; i++) {
        printf("  %s: %-20s %s\n", kind[item.kind], item.name, item.help);
        list_drive(item.drive);
    }
}

/* List plug-ins in the folders of MPS_PLUGIN_PATH. A file that is no plug-in is listed with the
 * reason. */
static void list_path(void)
{
    const char *at = getenv("MPS_PLUGIN_PATH");
    char name[1024], why[WHY_SIZE];
    for (; at && *at; at += strcspn(at, ":"), at += *at == ':') {
        const int length = (int)strcspn(at, ":");
        snprintf(name, sizeof name, "%.*s", length, at);
        DIR *folder = length > 0 ? opendir(name) : NULL;
        for (struct dirent *e; folder && (e = readdir(folder)) != NULL;) {
            const size_t n = strlen(e->d_name);
            mps_plugin_file *plugin = NULL;
            if (n < 4 || strcmp(e->d_name + n - 3, ".so") != 0) continue;
            snprintf(name, sizeof name, "%.*s/%.255s", length < 700 ? length : 700, at, e->d_name);
            if (mps_plugin_open(name, &plugin, why, sizeof why) == MPS_OK)
                list_plugin(plugin);
            else
                printf("%s: %s\n", name, why);
            mps_plugin_close(plugin);
        }
        if (folder) closedir(folder);
    }
}

static void list_plugins(const choices *c, mps_plugin_file *const *loaded)
{
    for (int32_t k = 0; k < c->plugins; k++) list_plugin(loaded[k]);
    if (c->plugins == 0) list_path();
}

enum { LISTS = 8 };

static void print_list(const choices *c, int chosen, const mps_sim *sim, int *code,
                       mps_plugin_file *const *loaded)
{
    if (chosen == 0) cli_list_cases(stdout);
    if (chosen == 1) *code = list_keys(c->files > 1 ? c->file[1] : NULL);
    if (chosen == 2) list_models(sim);
    if (chosen == 3) list_settings(sim);
    if (chosen == 4) list_solvers(sim);
    if (chosen == 5) list_units();
    if (chosen == 6) list_measures();
    if (chosen == 7) list_plugins(c, loaded);
}

int verb_list(const choices *c)
{
    static const char *const all[LISTS] = {"cases",   "keys",  "models",   "settings",
                                           "solvers", "units", "measures", "plugins"};
    mps_plugin_file *loaded[CLI_PLUGINS] = {NULL};
    const char *what = c->files ? c->file[0] : "";
    int chosen = -1;
    for (int i = 0; i < LISTS; i++)
        if (strcmp(what, all[i]) == 0) chosen = i;
    if (chosen < 0) {
        if (what[0]) fprintf(stderr, "mps list: '%s' is no list\n", what);
        for (int i = 0; i < LISTS; i++)
            fprintf(what[0] ? stderr : stdout, "mps list %s%s\n", all[i], i == 1 ? " [NAME]" : "");
        return what[0] ? MPS_EXIT_USAGE : MPS_EXIT_OK;
    }
    if (c->files > 1 && chosen != 1) {
        fprintf(stderr, "mps list %s: '%s' is one argument too many\n", what, c->file[1]);
        return MPS_EXIT_USAGE;
    }
    mps_sim *sim = make_sim();
    if (!sim) {
        fprintf(stderr, "mps list: no memory\n");
        return MPS_EXIT_FAILED;
    }
    int code = load_plugins(c, sim, loaded);
    if (code == MPS_EXIT_OK) print_list(c, chosen, sim, &code, loaded);
    mps_sim_destroy(sim);
    for (int32_t k = 0; k < c->plugins; k++) mps_plugin_close(loaded[k]);
    return cli_flush(c, code);
}

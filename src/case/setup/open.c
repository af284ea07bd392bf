/* SPDX-License-Identifier: BSD-3-Clause */
/* The empty simulation with its models, settings, solver and time steps. */
#include "drive.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* An error text of the library in the words of case files: keys instead of members of structs and
 * of functions. */
static const char *in_keys(const char *text, char *out, size_t size)
{
    static const char *const word[][2] = {{"probe.at[0]", "x of its place"},
                                          {"probe.at[1]", "y of its place"},
                                          {"probe.at[2]", "z of its place"},
                                          {"probe.at", "its place"},
                                          {"probe.normal", "'normal'"},
                                          {"probe.diameter", "'diameter'"},
                                          {"; mps_fill_level_add() keeps the volume", ""}};
    size_t used = 0;
    while (*text && used + 1 < size) {
        size_t k = 0, n = sizeof word / sizeof *word;
        while (k < n && strncmp(text, word[k][0], strlen(word[k][0])) != 0) k++;
        if (k == n) {
            out[used++] = *text++;
            continue;
        }
        used += (size_t)snprintf(out + used, size - used, "%s", word[k][1]);
        text += strlen(word[k][0]);
    }
    out[used < size ? used : size - 1] = '\0';
    return out;
}

static bool refused(build *b, mps_status status, const tree_node *at, const char *what,
                    const char *why)
{
    char text[4 * BUILD_TEXT];
    if (status >= 0) return false;
    if (status == MPS_E_NOMEM)
        b->status = status;
    else
        mps__case_log(b->c, at, false, "%s: %s", what, in_keys(why, text, sizeof text));
    return true;
}

bool mps__build_try(build *b, mps_status status, const tree_node *at, const char *what)
{
    return !refused(b, status, at, what, mps_sim_error(b->sim));
}

bool mps__build_try_job(build *b, mps_status status, const tree_node *at, const char *what)
{
    return !refused(b, status, at, what, mps_job_error(b->job));
}

void *mps__build_alloc(build *b, size_t size)
{
    void *memory = mps__case_take(b->c, size);
    if (!memory) b->status = MPS_E_NOMEM;
    return memory;
}

/* ---- messages ---- */

/* Log messages are kept until there is a job, which then logs them. */
static void keep(void *user, int level, const char *text)
{
    build_log *log = user;
    char plain[4 * BUILD_TEXT];
    text = in_keys(text, plain, sizeof plain);
    if (log->job) {
        mps_job_log(log->job, level, text);
        return;
    }
    if (log->count == BUILD_NOTES) {
        log->further++;
        return;
    }
    log->level[log->count] = level;
    snprintf(log->text[log->count++], sizeof log->text[0], "%s", text);
}

/* ---- models ---- */

static bool has_model(const build *b, const char *slot)
{
    const char *name;
    const size_t length = strlen(slot);
    for (int32_t i = 0; (name = mps_model_name(b->sim, i)) != NULL; i++)
        if (strncmp(name, slot, length) == 0 && name[length] == '.') return true;
    return false;
}

/* Call a function of the library for a text, or for each text of a list. */
static void for_names(build *b, const char *key, mps_status (*call)(mps_sim *, const char *))
{
    const tree_node *node = mps__tree_find(b->root, key);
    mps__read_all(node);
    const tree_node *at = node && node->kind == TREE_LIST ? node->first : node;
    for (; at; at = at == node ? NULL : at->next)
        mps__build_try(b, call(b->sim, at->text), at, key);
}

/* Apply "slot.key"; the slot may be a full name, so the key begins after the last dot. */
static void set_one(build *b, const tree_node *at)
{
    char slot[96];
    const char *dot = strrchr(at->key, '.');
    if (mps__drive_has(b, at->key)) return; /* read where the load or motion is used */
    const double value = mps__read_setting(b->c, at, NAN);
    if (!dot || isnan(value)) return;
    snprintf(slot, sizeof slot, "%.*s", (int)(dot - at->key), at->key);
    mps__build_try(b, mps_model_set(b->sim, slot, dot + 1, value), at, at->key);
}

static void use_models(build *b)
{
    const tree_node *model = mps__tree_find(b->root, "model");
    if (!mps__build_try(b, mps_preset_use(b->sim, b->model), model ? model : b->root, "model"))
        return;
    for_names(b, "remove", mps_model_remove);
    for_names(b, "use", mps_model_use);
    /* without gravity pressures have no vertical reference */
    if (b->gravity == 0 && has_model(b, "reference"))
        mps__build_try(b, mps_model_remove(b->sim, "reference"), b->root, "gravity");
    const tree_node *settings = mps__tree_find(b->root, "settings");
    for (const tree_node *at = settings ? settings->first : NULL; at; at = at->next) set_one(b, at);
}

static void use_solver(build *b, const tree_node *run)
{
    mps_solver_limits limits;
    const tree_node *at = mps__tree_find(run, "solver");
    const char *solver = mps__read_text(b->c, run, "solver", "sundials.pcg"),
               *preconditioner = mps__read_text(b->c, run, "preconditioner", NULL);
    if (preconditioner && !preconditioner[0]) preconditioner = NULL;
    mps__build_try(b, mps_solver_use(b->sim, solver, preconditioner), at ? at : run, "run.solver");
    mps_solver_limits_init(&limits, sizeof limits);
    limits.tolerance = mps__read_number(b->c, run, "tolerance", limits.tolerance);
    limits.max_iterations = (int32_t)mps__read_number(b->c, run, "iterations",
                                                      limits.max_iterations);
    limits.divergence = mps__read_number(b->c, run, "divergence", limits.divergence);
    mps__build_try(b, mps_solver_limits_set(b->sim, &limits), run, "run");
}

/* ---- all ---- */

/* Corners of the box beyond which particles are lost. */
static void read_domain(build *b, mps_config *config)
{
    double x[2][3];
    const tree_node *node = mps__tree_find(b->root, "domain");
    if (!node || mps__build_points(b, node, 0, 2, x) != 2) return;
    for (int d = 0; d < 3; d++) {
        config->domain_min[d] = fmin(x[0][d], x[1][d]);
        config->domain_max[d] = fmax(x[0][d], x[1][d]);
    }
}

static void create(build *b, const tree_node *run, const mps_job_config *options)
{
    char error[2 * BUILD_TEXT] = "";
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dim = b->dim;
    config.dp = b->dp;
    config.gravity[1] = -b->gravity;
    b->scale = config.velocity_scale = mps__read_number(b->c, run, "velocity_scale", 0);
    /* W22 (Wen, Zhao & Wan 2022); no paper has a value for 3-D */
    if (b->paper && b->dim == 2) config.re_far = 4.1;
    const tree_node *kernel = mps__tree_find(b->root, "kernel");
    config.kernel = mps__read_text(b->c, kernel, "name", config.kernel);
    if (mps__tree_find(kernel, "near"))
        config.re_near = mps__read_number(b->c, kernel, "near", NAN) / b->dp;
    if (mps__tree_find(kernel, "far"))
        config.re_far = mps__read_number(b->c, kernel, "far", NAN) / b->dp;
    read_domain(b, &config);
    config.speed_limit = mps__read_number(b->c, run, "speed_limit", config.speed_limit);
    config.lost_policy = mps__read_choice(b->c, run, "lost", MPS_LOST_REMOVE);
    const bool ranks = options && options->ranks;
    config.threads = (int32_t)mps__read_number(b->c, run, "threads", ranks ? 1 : 2);
    config.log = keep;
    config.log_user = b->log;
    config.error = error;
    config.error_size = sizeof error;
    if (mps__case_failed(b->c)) return;
    const mps_status status = mps_sim_create(&config, &b->sim);
    if (status == MPS_E_NOMEM)
        b->status = status;
    else if (status < 0)
        mps__case_log(b->c, b->root, false, "%s", error);
    else if (mps__plugins_register(b->c, b->sim) && ranks)
        mps__build_try(b, options->ranks->attach(options->ranks->user, b->sim), b->root, "ranks");
}

void mps__build_open(build *b, const mps_job_config *options)
{
    const tree_node *run = mps__tree_find(b->root, "run");
    const size_t length = strlen(b->model);
    b->paper = length > 6 && strcmp(b->model + length - 6, ".paper") == 0;
    b->log = mps__build_alloc(b, sizeof *b->log);
    if (b->log) create(b, run, options);
    if (!b->sim || mps__case_failed(b->c)) return;
    use_models(b);
    if (!mps__case_failed(b->c)) use_solver(b, run);
}

/* Growth is a ratio of two steps and is not scaled; dt_min ends a run. */
static void scale_steps(mps_time_control *control, double factor)
{
    control->dt *= factor;
    control->cfl *= factor;
    control->gravity *= factor;
    control->viscous *= factor;
    control->dt_max *= factor;
}

void mps__build_time(build *b)
{
    const tree_node *run = mps__tree_find(b->root, "run");
    mps_time_control control;
    mps_time_control_init(&control, sizeof control);
    control.dt = mps__read_number(b->c, run, "dt", 0);
    control.cfl = mps__read_number(b->c, run, "cfl", control.cfl);
    if (b->paper) control.gravity = 0.03; /* W22's steps are 0.01; at 0.06 it fails even sooner */
    control.gravity = mps__read_number(b->c, run, "calm", control.gravity);
    control.viscous = mps__read_number(b->c, run, "viscous", control.viscous);
    control.dt_min = mps__read_number(b->c, run, "dt_min", control.dt_min);
    control.growth = mps__read_number(b->c, run, "growth", control.growth);
    control.dt_max = mps__read_number(b->c, run, "dt_max", 0);
    b->until = mps__read_number(b->c, run, "until", NAN);
    const double dt_max = b->motion ? b->motion->dt_max : 0;
    if (dt_max > 0) control.dt_max = control.dt_max > 0 ? fmin(control.dt_max, dt_max) : dt_max;
    scale_steps(&control, mps__read_number(b->c, run, "step_factor", 1));
    b->time = control;
    if (!mps__case_failed(b->c))
        mps__build_try(b, mps_time_control_set(b->sim, &control), run, "run");
}

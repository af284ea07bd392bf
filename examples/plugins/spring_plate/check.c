/* SPDX-License-Identifier: BSD-3-Clause */
/* Test the body on a spring with the kit of models, which compares bytes on ranks and over a
 * checkpoint: the floor of its tanks is the body. Then compare bytes after failed steps. */
#include "spring.h"
#include <model_kit.h>
#include <mps/mps.h>
#include <stdio.h>
#include <string.h>

/* ---- the kit --------------------------------------------------------------------------------- */

static mps_status choose_floor(mps_sim *sim)
{
    mps_lease x = {.struct_size = sizeof x}, member = {.struct_size = sizeof member};
    mps_status status = mps_lease_begin(sim, "position", MPS_READ, &x);
    if (status < 0) return status;
    status = mps_lease_begin(sim, "spring_member", MPS_WRITE, &member);
    if (status < 0) return status;
    for (int64_t i = 0; i < x.count; i++) member.data[i] = x.data[i * x.stride + 1] < 1e-4;
    mps_lease_end(sim, &x);
    return mps_lease_end(sim, &member);
}

static mps_status prepare(void *user, mps_sim *sim)
{
    (void)user;
    mps_status status = mps_model_set(sim, "body", "mass", 200);
    if (status >= 0) status = mps_model_set(sim, "body", "added_mass", 100);
    if (status >= 0) status = mps_model_set(sim, "body", "stiffness", 1e4);
    if (status >= 0) status = mps_model_set(sim, "body", "damping", 10);
    return status < 0 ? status : choose_floor(sim);
}

/* ---- failed steps ------------------------------------------------------------------------- */

static int fail_on_demand(mps_stage *s)
{
    const int32_t *wanted = s->self;
    return *wanted ? mps_stage_fail(s, "as wanted") : 0;
}

static const mps_verb fail_verbs[] = {{.hook = MPS_SHIFT, .run = fail_on_demand}};

static mps_status build(mps_sim *sim, int32_t *wanted)
{
    const mps_model_ops fails = {.struct_size = sizeof fails,
                                 .api = MPS_MODEL_API,
                                 .name = "fail.on_demand",
                                 .help = "Fails on demand",
                                 .verb_count = 1,
                                 .verbs = fail_verbs,
                                 .user = wanted};
    const double lo[2] = {0, 0}, hi[2] = {0.3, 0.1};
    mps_tank tank;
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = tank.size[1] = 0.3;
    mps_status status = mps_tank_add(sim, &tank, NULL);
    if (status >= 0) status = mps_fill_box_add(sim, 0, lo, hi, NULL, NULL);
    if (status >= 0) status = mps_model_register(sim, &body_spring);
    if (status >= 0) status = mps_model_use(sim, "body.spring");
    if (status >= 0) status = mps_model_register(sim, &fails);
    if (status >= 0) status = mps_model_use(sim, "fail.on_demand");
    return status < 0 ? status : prepare(NULL, sim);
}

/* State after several steps, with failed steps in between. @return number of values; 0 after a
 * failure */
static int64_t numbers(int failing, double *value, int64_t most)
{
    static const char *const names[] = {"position", "velocity", "spring_motion"};
    mps_lease f = {.struct_size = sizeof f};
    int32_t wanted = 0;
    int64_t count = 0;
    mps_sim *sim;
    mps_config config;
    mps_config_init(&config, sizeof config);
    config.dp = 0.02;
    if (mps_sim_create(&config, &sim) < 0) return 0;
    int bad = build(sim, &wanted) < 0;
    for (int k = 0; k < 60 && !bad; k++) {
        wanted = failing && k % 7 == 0;
        if (wanted) bad = mps_step(sim, 1, NULL) != MPS_E_PLUGIN;
        wanted = 0;
        bad = bad || mps_step(sim, 1, NULL) < 0;
    }
    for (int k = 0; k < 3 && !bad; k++) {
        bad = mps_lease_begin(sim, names[k], MPS_READ, &f) < 0 || count + f.count * f.stride > most;
        if (!bad) memcpy(value + count, f.data, (size_t)(f.count * f.stride) * sizeof *value);
        count += f.count * f.stride;
        if (!bad) mps_lease_end(sim, &f);
    }
    if (bad) fprintf(stderr, "failing steps: %s\n", mps_sim_error(sim));
    mps_sim_destroy(sim);
    return bad ? 0 : count;
}

static int failing_steps(void)
{
    enum { MOST = 20000 };
    static double a[MOST], b[MOST];
    const int64_t n = numbers(0, a, MOST), m = numbers(1, b, MOST);
    const int bad = n == 0 || n != m || memcmp(a, b, (size_t)n * sizeof *a) != 0;
    printf("after failing steps: %s\n", bad ? "OTHER BYTES" : "same bytes");
    return bad;
}

int main(void)
{
    return failing_steps() | (kit_check_model(&body_spring, prepare, NULL) != 0);
}

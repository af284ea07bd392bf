/* SPDX-License-Identifier: BSD-3-Clause */
/* A program of the frozen version: compiled with its headers, linked to the library of the day. It reads and writes all fields of the
 * structs that it passes, so that a field at another place is seen. Its model and solver are shared objects of that version too. */
#include <math.h>
#include <mps/mps.h>
#include <mps/model.h>
#include <mps/ppe.h>
#include <stdio.h>
#include <string.h>

extern const mps_model_ops frozen_model;
extern const mps_solver_ops frozen_solver;
extern int frozen_model_calls, frozen_solver_calls;

#define CHECK(condition)                                           \
    do {                                                           \
        if (!(condition)) {                                        \
            printf("%s:%d: %s\n", __FILE__, __LINE__, #condition); \
            if (sim) printf("  %s\n", mps_sim_error(sim));         \
            return 1;                                              \
        }                                                          \
    } while (0)

static int steps_seen;
static char said[200];

static void listen(void *user, int level, const char *text)
{
    (void)level;
    snprintf(user, sizeof said, "%s", text);
}

static int monitor(void *user, mps_sim *sim, const mps_step_info *info)
{
    (void)sim;
    steps_seen++;
    return *(int *)user == steps_seen || !(info->dt > 0 && info->t >= info->dt && info->max_speed >= 0 && info->ppe_unknowns > 0);
}

static int defaults(void)
{
    mps_sim *sim = NULL;
    mps_config c;
    mps_time_control t;
    mps_solver_limits l;
    mps_phase p;
    mps_probe q;
    mps_tank k;
    CHECK(mps_config_init(&c, sizeof c) == MPS_OK && c.struct_size == sizeof c && c.dim == 2 && c.dp == 0);
    CHECK(c.gravity[1] == -9.81 && strcmp(c.kernel, "improved") == 0 && c.re_near == 2.1 && c.threads == 1 && c.speed_limit == 1000);
    CHECK(!c.allocator.alloc && !c.log && !c.error && c.error_size == 0 && c.parallel.threads == 0);
    CHECK(mps_time_control_init(&t, sizeof t) == MPS_OK && t.dt == 0 && t.cfl == 0.3 && t.gravity == 0.06 && t.viscous == 0.2);
    CHECK(t.growth == 1.1 && t.dt_max == 0 && t.dt_min == 0);
    CHECK(mps_solver_limits_init(&l, sizeof l) == MPS_OK && l.max_iterations == 2000 && l.tolerance == 1e-6 && l.divergence == 1e-4);
    CHECK(mps_phase_init(&p, sizeof p) == MPS_OK && p.density == 1000 && p.viscosity == 1e-3);
    CHECK(mps_probe_init(&q, sizeof q) == MPS_OK && q.direction[1] == 1 && q.average == MPS_AVERAGE_AUTO && q.rate == 0 && q.phases == 0);
    CHECK(mps_tank_init(&k, sizeof k) == MPS_OK && k.dummy_layers == 2 && k.open_top == 0);
    return 0;
}

static int particles(mps_sim *sim)
{
    const double x[2] = {0.2, 0.35};
    mps_particle_block b;
    mps_lease u = {.struct_size = sizeof u};
    int64_t id = -1;
    CHECK(mps_particle_block_init(&b, sizeof b) == MPS_OK);
    b.count = 1;
    b.position = x;
    CHECK(mps_particles_add(sim, &b, &id) == MPS_OK && mps_particle_index(sim, id) >= 0);
    CHECK(mps_lease_begin(sim, "position", MPS_READ, &u) == MPS_OK && u.count == mps_particles_count(sim, -1) && u.stride == 2);
    CHECK(u.data[2 * mps_particle_index(sim, id) + 1] == 0.35);
    CHECK(mps_lease_end(sim, &u) == MPS_OK && !u.data);
    return mps_particles_remove(sim, 1, &id) != MPS_OK;
}

static int measure(mps_sim *sim)
{
    mps_energy e;
    mps_momentum m;
    mps_step_info i;
    mps_probe q;
    int32_t id = -1;
    double value = -1;
    CHECK(mps_energy_init(&e, sizeof e) == MPS_OK && mps_energy_get(sim, &e) == MPS_OK);
    CHECK(fabs(e.mass - 1000 * 0.05 * 0.05 * (double)mps_particles_count(sim, MPS_FLUID)) < 1e-9 && e.volume > 0 && e.centre[0] > 0.1);
    CHECK(mps_momentum_init(&m, sizeof m) == MPS_OK && mps_momentum_get(sim, &m) == MPS_OK);
    CHECK(m.struct_size == sizeof m && m.gravity[1] < 0 && m.gravity[0] == 0);
    CHECK(mps_step_info_init(&i, sizeof i) == MPS_OK && mps_step(sim, 1e-3, &i) >= 0);
    CHECK(i.struct_size == sizeof i && i.step > 1 && i.dt > 0 && i.dt <= 1e-3 && i.ppe_solves >= 1 && i.seconds[MPS_STAGE_PPE_SOLVE] >= 0);
    CHECK(i.crossing_time >= 0 && i.lost == 0 && i.surface > 0);
    CHECK(mps_probe_init(&q, sizeof q) == MPS_OK);
    q.type = MPS_PROBE_GAUGE;
    q.at[0] = 0.2;
    CHECK(mps_probe_add(sim, &q, &id) == MPS_OK && mps_probe_read(sim, id, &value) == MPS_OK && fabs(value - 0.2) < 0.05);
    return 0;
}

static int build(mps_sim **out)
{
    const double lo[2] = {0, 0}, hi[2] = {0.4, 0.2};
    double built[3];
    mps_sim *sim = NULL;
    mps_config c;
    mps_tank t;
    mps_config_init(&c, sizeof c);
    c.dp = 0.05;
    c.log = listen;
    c.log_user = said;
    CHECK(mps_sim_create(&c, &sim) == MPS_OK);
    *out = sim;
    mps_tank_init(&t, sizeof t);
    t.name = "box";
    t.size[0] = t.size[1] = 0.4;
    CHECK(mps_tank_add(sim, &t, built) == MPS_OK && fabs(built[0] - 0.4) < 1e-12 && mps_part_find(sim, "box.y0") >= 0);
    CHECK(mps_fill_box_add(sim, 0, lo, hi, NULL, NULL) == MPS_OK);
    CHECK(mps_model_register(sim, &frozen_model) == MPS_OK && mps_model_use(sim, "frozen.v1") == MPS_OK);
    CHECK(mps_model_set(sim, "frozen", "pull", 0.25) == MPS_OK);
    CHECK(mps_solver_register(sim, &frozen_solver) == MPS_OK && mps_solver_use(sim, "frozen.jacobi", NULL) == MPS_OK);
    return 0;
}

int main(void)
{
    mps_sim *sim = NULL;
    int stop = 3, failed = defaults() || build(&sim);
    if (!failed && (mps_run(sim, 1, monitor, &stop) != MPS_W_STOPPED || steps_seen != 3)) {
        printf("mps_run() ended after %d steps, not 3: an error, or wrong values in mps_step_info\n", steps_seen);
        failed = 1;
    }
    failed = failed || particles(sim) || measure(sim);
    if (failed && sim) printf("%s\n", mps_sim_error(sim));
    mps_sim_destroy(sim);
    if (!failed && (frozen_model_calls < 4 || frozen_solver_calls < 4)) failed = !!puts("the model or the solver was not called");
    puts(failed ? "FAILED" : "the program of the frozen version runs");
    return failed;
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Short runs with known answers, coarse and on one thread: rest, a standing wave, a surging and a
 * rolling tank, 3-D. The still level is layers * dp, at the centres of the top layer. */
#include "../tags.h"
#include <math.h>
#include <mps/mps.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { PROBES = 4, VALUES = 6, ROWS = 8192, WIDTH = 1 + PROBES * VALUES };
static const double rho0 = 1000, g = 9.81;

#define OK(sim, call)                                               \
    do {                                                            \
        mps_status status_ = (call);                                \
        if (status_ != MPS_OK)                                      \
            fail_msg("%s: %s: %s", #call, mps_status_name(status_), \
                     (sim) ? mps_sim_error(sim) : "no handle");     \
    } while (0)
#define NEAR(what, got, wanted, tolerance)                                                     \
    do {                                                                                       \
        double got_ = (got), wanted_ = (wanted), tolerance_ = (tolerance);                     \
        print_message("    %s: %.5g, wanted %.5g +- %.2g\n", what, got_, wanted_, tolerance_); \
        if (!(fabs(got_ - wanted_) <= tolerance_))                                             \
            fail_msg("%s is off by %g", what, got_ - wanted_);                                 \
    } while (0)
#define BELOW(what, got, limit)                                                      \
    do {                                                                             \
        double got_ = (got), limit_ = (limit);                                       \
        print_message("    %s: %.3g, at most %.3g\n", what, got_, limit_);           \
        if (!(got_ <= limit_)) fail_msg("%s is %g, at most %g", what, got_, limit_); \
    } while (0)

/* ---- a run and what was measured after each of its steps ------------------------------------- */

typedef struct row {
    double t, value[PROBES][VALUES];
    mps_energy energy;
} row;

typedef struct record {
    mps_sim *sim;
    int32_t probes, probe[PROBES];
    int64_t lost, count;
    row *rows;
} record;

static void record_open(record *r, int32_t dim, double dp, const double *size, double depth)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {size[0], depth, size[2]};
    mps_config config;
    mps_tank tank;
    *r = (record){.rows = calloc(ROWS, sizeof(row))};
    assert_non_null(r->rows);
    OK(r->sim, mps_config_init(&config, sizeof config));
    config.dim = dim;
    config.dp = dp;
    OK(r->sim, mps_sim_create(&config, &r->sim));
    OK(r->sim, mps_tank_init(&tank, sizeof tank));
    for (int d = 0; d < 3; d++) tank.size[d] = size[d];
    OK(r->sim, mps_tank_add(r->sim, &tank, NULL));
    if (depth > 0) OK(r->sim, mps_fill_box_add(r->sim, 0, lo, hi, NULL, NULL));
}

static void record_close(record *r)
{
    mps_sim_destroy(r->sim);
    free(r->rows);
}

static void record_probe(record *r, int32_t type, double x, double y, double z)
{
    mps_probe probe;
    OK(r->sim, mps_probe_init(&probe, sizeof probe));
    probe.type = type;
    probe.at[0] = x;
    probe.at[1] = y;
    probe.at[2] = z;
    OK(r->sim, mps_probe_add(r->sim, &probe, &r->probe[r->probes++]));
}

static void measure(record *r, double t)
{
    assert_true(r->count < ROWS);
    row *now = &r->rows[r->count++];
    now->t = t;
    for (int32_t k = 0; k < r->probes; k++)
        OK(r->sim, mps_probe_read(r->sim, r->probe[k], now->value[k]));
    OK(r->sim, mps_energy_init(&now->energy, sizeof now->energy));
    OK(r->sim, mps_energy_get(r->sim, &now->energy));
}

static int monitor(void *user, mps_sim *sim, const mps_step_info *info)
{
    record *r = user;
    (void)sim;
    measure(r, info->t);
    r->lost = info->lost;
    return 0;
}

/* Every row after a step. */
static void record_run(record *r, double t_end)
{
    OK(r->sim, mps_run(r->sim, t_end, monitor, r));
    assert_int_equal(r->lost, 0);
}

/* Mean and deviation of a probe from t0 on; steps are of nearly the same length. */
static double mean_after(const record *r, double t0, int32_t probe, double *rms)
{
    double n = 0, sum = 0, square = 0;
    for (int64_t k = 0; k < r->count; k++) {
        if (r->rows[k].t < t0) continue;
        n += 1;
        sum += r->rows[k].value[probe][0];
    }
    for (int64_t k = 0; k < r->count; k++)
        if (r->rows[k].t >= t0) square += pow(r->rows[k].value[probe][0] - sum / n, 2);
    *rms = sqrt(square / n);
    return sum / n;
}

static double mean_kinetic(const record *r, double from, double to)
{
    double n = 0, sum = 0;
    for (int64_t k = 0; k < r->count; k++) {
        if (r->rows[k].t < from || r->rows[k].t > to) continue;
        n += 1;
        sum += r->rows[k].energy.kinetic;
    }
    return sum / n;
}

/* Move the fluid off its lattice by up to `amount` a direction: a perfect lattice is at rest to
 * rounding, which proves little. */
static void jitter(mps_sim *sim, double amount)
{
    const int32_t *kind;
    mps_lease x = {.struct_size = sizeof x};
    uint32_t seed = 12345;
    OK(sim, tags_peek(sim, NULL, &kind, NULL, NULL));
    OK(sim, mps_lease_begin(sim, "position", MPS_WRITE, &x));
    for (int64_t i = 0; i < x.count * x.stride; i++) {
        seed = seed * 1664525u + 1013904223u;
        if (kind[i / x.stride] == MPS_FLUID) x.data[i] += amount * (2.0 * seed / 4294967296.0 - 1);
    }
    OK(sim, mps_lease_end(sim, &x));
}

/* ---- rest ------------------------------------------------------------------------------------ */

/* Pressures within 2 % of rho g h, noise too. */
static void check_rest(record *r, double level, const double *height, double t0, double t_end)
{
    record_run(r, t_end);
    for (int32_t k = 0; k < r->probes; k++) {
        double rms, mean = mean_after(r, t0, k, &rms);
        NEAR("mean pressure [Pa]", mean, rho0 * g * (level - height[k]), 0.02 * rho0 * g * level);
        BELOW("its rms [Pa]", rms, 0.02 * rho0 * g * level);
    }
    BELOW("volume error", fabs(r->rows[r->count - 1].energy.volume_error), 0.02);
}

static void static_tank(void **state)
{
    (void)state;
    const double size[3] = {0.4, 0.4, 0}, dp = 0.02, height[3] = {0.04, 0.1, 0.14};
    record r;
    record_open(&r, 2, dp, size, 0.2);
    jitter(r.sim, 0.1 * dp);
    for (int k = 0; k < 3; k++)
        record_probe(&r, MPS_PROBE_WALL_PRESSURE, k == 1 ? size[0] : 0, height[k], 0);
    check_rest(&r, 0.2, height, 0.3, 1);
    BELOW("kinetic energy at the end [J]", mean_kinetic(&r, 0.8, 1),
          0.5 * mean_kinetic(&r, 0, 0.2));
    record_close(&r);
}

static void static_tank_3d(void **state)
{
    (void)state;
    const double size[3] = {0.2, 0.25, 0.15}, dp = 0.025, height[3] = {0.025, 0.05, 0.1};
    record r;
    record_open(&r, 3, dp, size, 0.15);
    jitter(r.sim, 0.05 * dp);
    record_probe(&r, MPS_PROBE_WALL_PRESSURE, 0, height[0], 0.075);
    record_probe(&r, MPS_PROBE_WALL_PRESSURE, 0.1, height[1], 0.15);
    record_probe(&r, MPS_PROBE_WALL_PRESSURE, 0.2, height[2], 0.075);
    check_rest(&r, 0.15, height, 0.1, 0.3);
    BELOW("mean speed at the end [m/s]",
          sqrt(2 * mean_kinetic(&r, 0.25, 0.3) / r.rows[0].energy.mass), 0.05 * sqrt(g * dp));
    record_close(&r);
}

/* ---- waves ----------------------------------------------------------------------------------- */

/* Water of the first standing wave: the lattice displaced as linear theory does, column tops on a
 * cos(k x). */
static void add_wave(mps_sim *sim, double dp, double length, double depth, double a)
{
    const double k = acos(-1.0) / length;
    const int columns = (int)lround(length / dp) - 1, rows = (int)lround(depth / dp);
    double *x = malloc((size_t)columns * (size_t)rows * 2 * sizeof *x), *out = x;
    mps_particle_block block;
    assert_non_null(x);
    for (int i = 1; i <= columns; i++)
        for (int j = 1; j <= rows; j++) {
            const double X = i * dp, Y = j * dp, top = rows * dp, amount = a / sinh(k * top);
            const double surface_x = X - amount * cosh(k * top) * sin(k * X);
            *out++ = X - amount * cosh(k * Y) * sin(k * X);
            *out++ = (Y + amount * sinh(k * Y) * cos(k * X)) * (top + a * cos(k * surface_x)) /
                     (top + a * cos(k * X));
        }
    OK(sim, mps_particle_block_init(&block, sizeof block));
    block.count = (int64_t)columns * rows;
    block.position = x;
    OK(sim, mps_particles_add(sim, &block, NULL));
    free(x);
}

/* Amplitude of the least-squares fit a cos(wt) + b of a probe, and its residual. */
static double fit_cosine(const record *r, double level, double omega, double *amplitude)
{
    double n = 0, c = 0, cc = 0, y = 0, yc = 0, rest = 0;
    for (int64_t k = 0; k < r->count; k++) {
        const double cosine = cos(omega * r->rows[k].t), value = r->rows[k].value[0][0] - level;
        n += 1;
        c += cosine;
        cc += cosine * cosine;
        y += value;
        yc += value * cosine;
    }
    *amplitude = (yc - y * c / n) / (cc - c * c / n);
    for (int64_t k = 0; k < r->count; k++)
        rest += pow(r->rows[k].value[0][0] - level - y / n -
                        *amplitude * (cos(omega * r->rows[k].t) - c / n),
                    2);
    return rest;
}

static void standing_wave(void **state)
{
    (void)state;
    const double size[3] = {1, 0.7, 0}, dp = 0.025, depth = 0.5, a = 0.02, k = acos(-1.0) / size[0];
    const double omega = sqrt(g * k * tanh(k * depth)) * (1 - 0.0973 * k * a * k * a);
    double best = 0, least = INFINITY, amplitude = 0;
    record r;
    record_open(&r, 2, dp, size, 0);
    add_wave(r.sim, dp, size[0], depth, a);
    record_probe(&r, MPS_PROBE_GAUGE, 0, 0, 0);
    record_run(&r, 1.5 * 2 * acos(-1.0) / omega);
    for (double factor = 0.9; factor <= 1.1; factor += 0.0005) {
        double height, rest = fit_cosine(&r, depth, factor * omega, &height);
        if (rest >= least) continue;
        least = rest;
        best = factor * omega;
        amplitude = height;
    }
    NEAR("frequency [rad/s]", best, omega, 0.015 * omega);
    NEAR("amplitude [m]", amplitude, a, 0.1 * a);
    record_close(&r);
}

static void surge(mps_sim *sim, int32_t start)
{
    const mps_harmonic motion = {.dof = MPS_MOVE_X, .amplitude = 0.02, .omega = 6.469};
    const double centre[3] = {0, 0, 0};
    OK(sim, mps_motion_centre_set(sim, centre, start));
    OK(sim, mps_motion_harmonics_set(sim, 1, &motion));
}

/* Largest value of the first probe up to t_end, its time by a parabola through the largest row and
 * its neighbours at +-span. */
static double crest(const record *r, double from, double *t)
{
    int64_t top = -1;
    for (int64_t k = 0; k < r->count; k++)
        if (r->rows[k].t >= from && (top < 0 || r->rows[k].value[0][0] > r->rows[top].value[0][0]))
            top = k;
    const int64_t span = 15;
    assert_true(top >= span && top + span < r->count);
    const double y0 = r->rows[top - span].value[0][0], y1 = r->rows[top].value[0][0],
                 y2 = r->rows[top + span].value[0][0];
    *t = r->rows[top].t +
         0.5 * (r->rows[top + span].t - r->rows[top].t) * (y0 - y2) / (y0 - 2 * y1 + y2);
    return y1;
}

/* First crest at the left wall of Z14's tank, against nonlinear potential flow. */
static void surge_tank(void **state)
{
    (void)state;
    const double size[3] = {0.8, 0.5, 0}, dp = 0.02;
    double t;
    record r;
    record_open(&r, 2, dp, size, 0.25);
    surge(r.sim, MPS_START_AT_REST);
    record_probe(&r, MPS_PROBE_GAUGE, dp, 0, 0);
    record_run(&r, 1.3);
    NEAR("crest [m]", crest(&r, 0.7, &t) - floor(0.25 / dp + 1e-9) * dp, 0.065, 0.15 * 0.065);
    NEAR("its time [s]", t, 1.11, 0.03);
    BELOW("volume error", fabs(r.rows[r.count - 1].energy.volume_error), 0.02);
    record_close(&r);
}

/* The liquid has the tank's speed when the first step begins and only its weight acts on it, or the
 * walls push it in one step. */
static void start_conventions(void **state)
{
    (void)state;
    const double size[3] = {0.4, 0.4, 0}, dp = 0.02, speed = 0.02 * 6.469,
                 still = rho0 * g * (0.2 - 0.1);
    double first[2], moving[2];
    for (int32_t start = MPS_START_AT_REST; start <= MPS_START_WITH_TANK; start++) {
        record r;
        record_open(&r, 2, dp, size, 0.2);
        surge(r.sim, start);
        record_probe(&r, MPS_PROBE_WALL_PRESSURE, 0, 0.1, 0);
        record_run(&r, 0.01);
        first[start] = r.rows[0].value[0][0];
        moving[start] = r.rows[0].energy.momentum[0] / r.rows[0].energy.mass;
        record_close(&r);
    }
    NEAR("first pressure, with the tank [Pa]", first[MPS_START_WITH_TANK], still, 0.1 * still);
    NEAR("speed of the liquid, with the tank [m/s]", moving[MPS_START_WITH_TANK], speed,
         0.01 * speed);
    BELOW("speed of the liquid, from rest [m/s]", moving[MPS_START_AT_REST], 0.9 * speed);
    assert_true(first[MPS_START_AT_REST] > 3 * still);
}

/* ---- rolling --------------------------------------------------------------------------------- */

/* Impulse of the force on the tank against the liquid's momentum, over windows of 0.1 s, in parts
 * of the weight's. The half cells between the walls and the first columns are liquid too, which
 * carries no particle. */
static void check_forces(const record *r, int32_t force, double from, double share)
{
    double worst = 0, sum[2] = {0, 0}, scale = 1;
    int64_t begin = 0;
    for (int64_t k = 1; k < r->count; k++) {
        const row *now = &r->rows[k], *was = now - 1, *first = &r->rows[begin];
        if (now->t < from) {
            begin = k;
            continue;
        }
        for (int d = 0; d < 2; d++) sum[d] += now->value[force][d] * (now->t - was->t);
        if (now->t - first->t < 0.1) continue;
        const double span = now->t - first->t, weight = share * now->energy.mass * g;
        const double x = sum[0] + share * (now->energy.momentum[0] - first->energy.momentum[0]);
        const double y = sum[1] + share * (now->energy.momentum[1] - first->energy.momentum[1]) +
                         weight * span;
        scale = weight * span;
        worst = fmax(worst, hypot(x, y) / scale);
        sum[0] = sum[1] = 0;
        begin = k;
    }
    BELOW("force against momentum, of the weight", worst, 0.05);
}

static void rolling_tank(void **state)
{
    (void)state;
    const double size[3] = {0.4, 0.4, 0}, dp = 0.02, centre[3] = {0.2, 0.2, 0};
    const mps_harmonic motion = {.dof = MPS_ROTATE_Z, .amplitude = 0.1, .omega = 3};
    record r;
    record_open(&r, 2, dp, size, 0.2);
    OK(r.sim, mps_motion_centre_set(r.sim, centre, MPS_START_AT_REST));
    OK(r.sim, mps_motion_harmonics_set(r.sim, 1, &motion));
    record_probe(&r, MPS_PROBE_FORCE, 0.2, 0.2, 0);
    record_run(&r, 1);
    double fastest = 0, volume = 0;
    for (int64_t k = 0; k < r.count; k++) {
        fastest = fmax(fastest, sqrt(2 * r.rows[k].energy.kinetic / r.rows[k].energy.mass));
        volume = fmax(volume, fabs(r.rows[k].energy.volume_error));
    }
    BELOW("mean speed [m/s]", fastest, 0.3);
    BELOW("volume error", volume, 0.02);
    check_forces(&r, 0, 0.1, (size[0] / dp) / (size[0] / dp - 1));
    record_close(&r);
}

/* A closed tank full of water has no pressure datum: only differences are meaningful, here rho L a
 * between the ends. */
static void full_tank(void **state)
{
    (void)state;
    const double size[2] = {0.4, 0.3}, at[2][3] = {{0, 0.16, 0}, {0.4, 0.16, 0}};
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.02, .omega = 6};
    record r;
    double errors = 0, squares = 0;
    int32_t id[2];
    record_open(&r, 2, 0.02, size, 0.3);
    OK(r.sim, mps_motion_harmonics_set(r.sim, 1, &surge));
    for (int k = 0; k < 2; k++) {
        mps_probe p;
        mps_probe_init(&p, sizeof p);
        memcpy(p.at, at[k], sizeof p.at);
        OK(r.sim, mps_probe_add(r.sim, &p, &id[k]));
    }
    for (int k = 1; k <= 100; k++) {
        double left, right;
        mps_motion_state m = {.struct_size = sizeof m};
        OK(r.sim, mps_run(r.sim, 0.01 * k, NULL, NULL));
        OK(r.sim, mps_motion_state_get(r.sim, &m));
        OK(r.sim, mps_probe_read(r.sim, id[0], &left));
        OK(r.sim, mps_probe_read(r.sim, id[1], &right));
        const double wanted = rho0 * size[0] * m.accel[MPS_MOVE_X];
        errors += k > 20 ? (left - right - wanted) * (left - right - wanted) : 0;
        squares += k > 20 ? wanted * wanted : 0;
    }
    BELOW("end to end pressure, rms error", sqrt(errors / squares), 0.03);
    record_close(&r);
}

/* The literal equations of the papers run, and keep the hydrostatic pressure for some time. */
static void paper_preset(void **state)
{
    (void)state;
    const double size[2] = {0.4, 0.3};
    record r;
    double p;
    int32_t id;
    mps_probe bottom;
    record_open(&r, 2, 0.02, size, 0.2);
    OK(r.sim, mps_preset_use(r.sim, "imps.paper"));
    mps_probe_init(&bottom, sizeof bottom);
    bottom.at[0] = 0.2;
    OK(r.sim, mps_probe_add(r.sim, &bottom, &id));
    for (int k = 0; k < 50; k++) OK(r.sim, mps_step(r.sim, 1e-3, NULL));
    OK(r.sim, mps_probe_read(r.sim, id, &p));
    NEAR("pressure at the bottom [Pa]", p, rho0 * g * 0.2,
         0.12 * rho0 * g * 0.2); /* one-sided rows: up to 11 % too much */
    record_close(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(static_tank),       cmocka_unit_test(static_tank_3d),
        cmocka_unit_test(standing_wave),     cmocka_unit_test(surge_tank),
        cmocka_unit_test(start_conventions), cmocka_unit_test(rolling_tank),
        cmocka_unit_test(full_tank),         cmocka_unit_test(paper_preset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* The crossing time: dp/u of the fastest coherent liquid. Spray is excluded, a film of two rows is
 * included. */
#include "sim.h"
#include "tank_fixture.h"
#include <stdlib.h>

static const double dp = 0.015625, re = 2.1, SCALE = 0.5; /* SCALE: U_g [m/s] */

enum { MOST = 4000 };

/* Blocks of liquid on a lattice, each with its velocity along the first axis. */
typedef struct liquid {
    mps_sim *sim;
    int32_t dim;
    int64_t n;
    double x[3 * MOST], u[MOST];
} liquid;

static void open_liquid(liquid *l, int32_t dim, int32_t threads)
{
    mps_config c;
    *l = (liquid){.dim = dim};
    assert_int_equal(mps_config_init(&c, sizeof c), MPS_OK);
    c.dim = dim;
    c.dp = dp;
    c.threads = threads;
    c.velocity_scale = SCALE;
    c.re_near = re;
    c.re_far = 3.1;
    memset(c.gravity, 0, sizeof c.gravity);
    assert_int_equal(mps_sim_create(&c, &l->sim), MPS_OK);
}

/* `cells` particles a side from a corner, both in spacings. */
static void add_body(liquid *l, const int *from, const int *cells, double u)
{
    for (int k = 0; k < (l->dim == 3 ? cells[2] : 1); k++)
        for (int j = 0; j < cells[1]; j++)
            for (int i = 0; i < cells[0]; i++) {
                const int at[3] = {from[0] + i, from[1] + j, from[2] + k};
                for (int d = 0; d < l->dim; d++) l->x[l->n * l->dim + d] = dp * at[d];
                l->u[l->n++] = u;
                assert_true(l->n < MOST);
            }
}

/* All of them in one call; the crossing time after the first step. */
static double first_time(liquid *l)
{
    mps_particle_block b;
    mps_step_info info;
    double *u = calloc((size_t)(l->n * l->dim), sizeof *u);
    assert_non_null(u);
    for (int64_t k = 0; k < l->n; k++) u[k * l->dim] = l->u[k];
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = l->n;
    b.position = l->x;
    b.velocity = u;
    ASSERT_OK(l->sim, mps_particles_add(l->sim, &b, NULL));
    free(u);
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    assert_true(mps_step(l->sim, 1e-5, &info) >= 0);
    return info.crossing_time;
}

/* A block of 6 x 6 (x 6) at 6 U_g, and another far above it. */
static double beside(int32_t dim, const int *cells, double u)
{
    static liquid l;
    const int origin[3] = {0, 0, 0}, above[3] = {0, 30, 0}, all[3] = {6, 6, 6};
    open_liquid(&l, dim, 1);
    add_body(&l, origin, all, 6 * SCALE);
    add_body(&l, above, cells, u);
    const double t = first_time(&l);
    mps_sim_destroy(l.sim);
    return t;
}

/* A film of two rows that extends over the radius to both sides is included; droplets are not, in
 * any number. */
static void films_and_drops(void **state)
{
    (void)state;
    const double slow = dp / (6 * SCALE), fast = dp / (12 * SCALE);
    for (int32_t dim = 2; dim <= 3; dim++) {
        const int film[3] = {5, 2, 5}, longer[3] = {12, 2, 12}, row[3] = {12, 1, 12},
                  drop[3] = {2, 3, 2}, one[3] = {1, 1, 1};
        ASSERT_NEAR(beside(dim, film, 12 * SCALE), fast, 1e-3 * fast);
        ASSERT_NEAR(beside(dim, longer, 12 * SCALE), fast, 1e-3 * fast);
        ASSERT_NEAR(beside(dim, row, 12 * SCALE), slow, 1e-3 * slow);
        ASSERT_NEAR(beside(dim, drop, 12 * SCALE), slow, 1e-3 * slow);
        ASSERT_NEAR(beside(dim, one, 12 * SCALE), slow, 1e-3 * slow);
    }
    static liquid l; /* as many particles as half of the block, all isolated */
    const int origin[3] = {0, 0, 0}, one[3] = {1, 1, 1}, all[3] = {6, 6, 6};
    open_liquid(&l, 2, 1);
    add_body(&l, origin, all, 6 * SCALE);
    for (int k = 0; k < 18; k++) add_body(&l, (int[3]){4 * k, 30, 0}, one, 12 * SCALE);
    ASSERT_NEAR(first_time(&l), slow, 1e-3 * slow);
    mps_sim_destroy(l.sim);
}

/* N - 1 and N fast particles within the radius of one of them: 8 in 2-D, 22 in 3-D. Each is far
 * from the next, so that they stay as they are. */
static void number_of_a_piece(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++)
        for (int more = 0; more < 2; more++) {
            static liquid l;
            const int wanted = (dim == 2 ? 7 : 21) + more;
            int have = 0;
            open_liquid(&l, dim, 1);
            for (int square = 0; square <= 4; square++) /* the nearest first */
                for (int k = dim == 3 ? -2 : 0; k <= (dim == 3 ? 2 : 0); k++)
                    for (int j = -2; j <= 2; j++)
                        for (int i = -2; i <= 2; i++) {
                            if (i * i + j * j + k * k != square || have == wanted) continue;
                            have++;
                            add_body(&l, (int[3]){i, j, k}, (int[3]){1, 1, 1}, 12 * SCALE);
                        }
            assert_int_equal(have, wanted);
            const double t = first_time(&l), all = more ? dp / (12 * SCALE) : dp / (5 * SCALE);
            ASSERT_NEAR(t, all, 1e-3 * all);
            mps_sim_destroy(l.sim);
        }
}

/* Up to 5 U_g spray or not makes no difference: at most dp/(5 U_g), and less in calm liquid. */
static void calm_and_moderate(void **state)
{
    (void)state;
    const int one[3] = {1, 1, 1}, film[3] = {5, 2, 5};
    const double speeds[] = {0.1, 0.5, 0.9, 1.5, 4.9}, most = dp / (5 * SCALE);
    for (int32_t dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 5; k++)
            for (int piece = 0; piece < 2; piece++) {
                static liquid l;
                open_liquid(&l, dim, 1);
                add_body(&l, (int[3]){0, 0, 0}, (int[3]){6, 6, 6}, 0.05 * SCALE);
                add_body(&l, (int[3]){0, 30, 0}, piece ? film : one, speeds[k] * SCALE);
                const double wanted = fmin(1, speeds[k]) * most;
                ASSERT_NEAR(first_time(&l), wanted, 1e-3 * wanted);
                mps_sim_destroy(l.sim);
            }
}

/* ---- against a double loop ------------------------------------------------------------------- */

static int descending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* u_i by sorting: the N-th of the speeds within re, at most its own. `x`: positions before the
 * step. */
static double piece_by_sorting(const liquid *l, const double *speed, int64_t i)
{
    static double near[MOST];
    const int64_t N = l->dim == 2 ? 8 : 22;
    int64_t count = 0;
    for (int64_t j = 0; j < l->n; j++) {
        double square = 0;
        for (int d = 0; d < l->dim; d++)
            square += pow(l->x[j * l->dim + d] - l->x[i * l->dim + d], 2);
        if (square < re * re * dp * dp) near[count++] = speed[j];
    }
    qsort(near, (size_t)count, sizeof *near, descending);
    return count < N ? 0 : fmin(near[N - 1], speed[i]);
}

/* A cloud with speeds of all sizes, by 1, 2 and 4 threads. */
static void double_loop(void **state)
{
    int fast = 0;
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++)
        for (int seed = 0; seed < 5; seed++) {
            double times[3];
            for (int k = 0; k < 3; k++) {
                static liquid l;
                static double speed[MOST];
                uint64_t random = 1000 + (uint64_t)seed;
                open_liquid(&l, dim, 1 << k);
                add_body(&l, (int[3]){0, 0, 0},
                         dim == 2 ? (int[3]){50, 40, 1} : (int[3]){14, 12, 11}, 0);
                for (int64_t i = 0; i < l.n; i++) {
                    random = random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
                    l.u[i] = 14 * SCALE * pow((double)(random >> 11) / 9007199254740992.0, 2);
                }
                times[k] = first_time(&l);
                const mps__particles *s = &l.sim->world.particles;
                for (int64_t i = 0; i < s->n; i++)
                    speed[s->id[i]] = sqrt(mps__dot(&s->u[i * dim], &s->u[i * dim], dim));
                double u = 0;
                for (int64_t i = 0; i < l.n; i++) u = fmax(u, piece_by_sorting(&l, speed, i));
                const double wanted = dp / fmax(u, 5 * SCALE);
                ASSERT_NEAR(times[k], wanted, 1e-12 * wanted);
                fast += u > 5 * SCALE;
                mps_sim_destroy(l.sim);
            }
            assert_true(times[0] == times[1] && times[0] == times[2]);
        }
    assert_true(fast >= 15); /* of 30 */
}

/* Gas counts neither as a piece nor as a part of one. */
static void gas(void **state)
{
    (void)state;
    static liquid l;
    mps_phase air;
    mps_particle_block b;
    double x[2 * 30], u[2 * 30] = {0};
    open_liquid(&l, 2, 1);
    assert_int_equal(mps_phase_init(&air, sizeof air), MPS_OK);
    air.density = 1.2;
    ASSERT_OK(l.sim, mps_phase_set(l.sim, 1, &air));
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    for (int k = 0; k < 30; k++) {
        x[2 * k] = dp * (k % 10);
        x[2 * k + 1] = dp * (50 + k / 10);
        u[2 * k] = 30 * SCALE;
    }
    b.count = 30;
    b.position = x;
    b.velocity = u;
    b.phase = 1;
    ASSERT_OK(l.sim, mps_particles_add(l.sim, &b, NULL));
    add_body(&l, (int[3]){0, 0, 0}, (int[3]){6, 6, 6}, 6 * SCALE);
    ASSERT_NEAR(first_time(&l), dp / (6 * SCALE), 1e-3 * dp / SCALE);
    mps_sim_destroy(l.sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(films_and_drops), cmocka_unit_test(number_of_a_piece),
        cmocka_unit_test(calm_and_moderate), cmocka_unit_test(double_loop), cmocka_unit_test(gas)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

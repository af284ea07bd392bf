/* SPDX-License-Identifier: BSD-3-Clause */
/* Trapped gas on a device: steps have the bytes of the host, and a step that does not search voids
 * copies no field. */
#define _POSIX_C_SOURCE 200809L
#include "phase/gas_pocket.h"
#include "scene.h"

/* after cmocka.h */
#include "../turns.h"

/* ---- scenes ---- */

/* Liquid in a tank, but for a box in it that may have a way to the surface. */
typedef struct gas_scene {
    const char *name;
    int32_t dim;
    double dp, slot; /* width of the way [m] */
    bool plate;      /* thin, over the middle of the box */
    int steps;
} gas_scene;

static const gas_scene gas_scenes[] = {{"enclosed 2-D", 2, 0.02, 0, false, 30},
                                       {"enclosed 3-D", 3, 0.05, 0, false, 14},
                                       {"closing 2-D", 2, 0.02, 0.05, false, 100},
                                       {"closing 3-D", 3, 0.05, 0.11, false, 40},
                                       {"plate 2-D", 2, 0.02, 0, true, 20}};
enum { GAS_SCENES = sizeof gas_scenes / sizeof gas_scenes[0] };

static int in_liquid(void *user, const double *x)
{
    const gas_scene *s = user;
    const bool beside = s->dim == 3 && (x[2] < 0.1 || x[2] > 0.3);
    const bool box = x[0] > 0.16 && x[0] < 0.44 && x[1] > 0.08 && x[1] < 0.28 && !beside;
    const bool way = fabs(x[0] - 0.3) < 0.5 * s->slot && x[1] > 0.08 &&
                     (s->dim == 2 || fabs(x[2] - 0.2) < 0.5 * s->slot);
    return x[1] < 0.37 && !box && !way;
}

static mps_sim *enclosing(const gas_scene *s)
{
    const double foot[2] = {0.2, 0.2}, edge[2] = {0.2, 0.04};
    gas_scene copy = *s;
    mps_sim *sim = new_sim(s->dim, s->dp);
    shadow_heap(sim);
    ASSERT_OK(sim, mps_preset_use(sim, "imps"));
    ASSERT_OK(sim, mps_model_use(sim, "gas.pocket"));
    ASSERT_OK(sim, mps_model_set(sim, "gas", "least", 2));
    add_tank(sim, 0.6, 0.45, 0.4);
    if (s->plate) ASSERT_OK(sim, mps_plate_add(sim, "plate", foot, edge, NULL));
    ASSERT_OK(sim, mps_fill_add(sim, 0, in_liquid, &copy, NULL));
    ASSERT_OK(sim, mps_field_add(sim, "mark", 2));
    shake(sim, 0.02);
    return sim;
}

/* In 3-D liquid added by the program closes the gap, in 2-D adjacent liquid falls into it. */
static void change(mps_sim *sim, const gas_scene *s, int step)
{
    double x[4][3];
    mps_particle_block b;
    if (s->dim == 2 || s->slot == 0 || step != 4) return;
    for (int k = 0; k < 4; k++) {
        x[k][0] = k % 2 == 0 ? 0.275 : 0.325;
        x[k][1] = 0.325;
        x[k][2] = k < 2 ? 0.175 : 0.225;
    }
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 4;
    b.position = x[0];
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
}

static const mps__pocket_head *head_of(mps_sim *sim)
{
    const double *numbers = NULL;
    int64_t count = 0;
    ASSERT_OK(sim, mps_model_state(sim, "gas", &numbers, &count));
    assert_true(count > 0);
    return (const mps__pocket_head *)(const void *)numbers;
}

/* ---- the same bytes ---- */

static void scenes_with_gas(void **state)
{
    (void)state;
    for (int m = 0; m < GAS_SCENES; m++) {
        const gas_scene *g = &gas_scenes[m];
        mps_sim *host = enclosing(g), *sim = enclosing(g);
        int with = 0, without = 0;
        shadow s;
        shadow_attach(&s, sim);
        for (int k = 0; k < g->steps; k++) {
            change(host, g, k);
            change(sim, g, k);
            go(host, 1);
            go(sim, 1);
            const bool any = head_of(host)->pockets > 0;
            with += any;
            without += !any && with == 0;
            if (k % 5 == 4)
                same(host, sim); /* else steps begin with fields that the device has alone */
        }
        same(host, sim);
        same_memory(host, sim);
        print_message("%s: %d steps before a pocket, %d with one\n", g->name, without, with);
        assert_true(with > 2 && (without > 2) == (g->slot > 0));
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
        assert_int_equal(s.blocks, 0);
    }
}

/* ---- failures ---- */

/* In a step with a pocket, and in one that searches voids and finds none. */
static void failing_devices(void **state)
{
    (void)state;
    for (int m = 0; m < 4; m++) {
        const gas_scene *g = &gas_scenes[m % 2 == 0 ? 0 : 2];
        mps_sim *host = enclosing(g), *sim = enclosing(g);
        shadow s;
        shadow_attach(&s, sim);
        fail_each(host, sim, m < 2 ? &s.launches : &s.downloads, m < 2 ? &s.fails_at : &s.loses_at);
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
    }
}

/* ---- what a step costs ---- */

static mps_device_info step_of(mps_sim *sim)
{
    ASSERT_OK(sim, mps_step(sim, 0.01, NULL));
    return shadow_counts(sim);
}

static void assert_in(const char *what, int64_t value, int64_t least, int64_t most)
{
    print_message(" %lld %s", (long long)value, what);
    if (value < least || value > most)
        fail_msg("%s: %lld, wanted %lld to %lld", what, (long long)value, (long long)least,
                 (long long)most);
}

/* A step without a search reads the speed of the surface; a step with a search downloads positions
 * of the liquid, and its number of slabs. */
static void costs_without_a_pocket(void **state)
{
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *with = unwatched("imps", dim), *without = unwatched("imps", dim);
        int looks = 0, waits = 0;
        shadow s, t;
        ASSERT_OK(with, mps_model_use(with, "gas.pocket"));
        shadow_attach(&s, with);
        shadow_attach(&t, without);
        for (int k = 0; k < 20; k++) {
            const int64_t n = with->world.particles.n;
            const mps_device_info a = step_of(with), b = step_of(without);
            const mps__pocket_head *head = head_of(with);
            const bool looked = head->waited == 0;
            assert_true(head->pockets == 0);
            assert_int_equal(a.host_calls, looked);
            if (k == 0) continue; /* settings go */
            print_message("%d-D, %lld particles, %s:", (int)dim, (long long)n,
                          looked ? "looks" : "waits");
            assert_in("waits", a.waits - b.waits, 1, looked ? 4 : 1);
            assert_in("launches", a.launches - b.launches, 2, looked ? 8 : 5);
            assert_in("bytes up", a.bytes_up - b.bytes_up, 0, 0);
            const int64_t places = looked ? n * (4 + 8 * dim) : 0;
            assert_in("bytes down\n", a.bytes_down - b.bytes_down, places + 8, places + 24);
            looks += looked;
            waits += !looked;
        }
        assert_true(looks > 0 && waits > 10);
        mps_sim_destroy(with);
        mps_sim_destroy(without);
    }
}

/* Bytes per particle: data that the two passes on the host read; pressures, gradients and numbers
 * that one of them writes. */
static void costs_with_a_pocket(void **state)
{
    static const int64_t down[2][2] = {{300, 400}, {400, 540}};
    (void)state;
    for (int m = 0; m < 2; m++) {
        const gas_scene *g = &gas_scenes[m];
        mps_sim *sim = enclosing(g);
        const int64_t *range = down[g->dim - 2], n = sim->world.particles.n;
        int steps = 0;
        shadow s;
        shadow_attach(&s, sim);
        for (int k = 0; k < g->steps; k++) {
            const int64_t before = sim->world.lists.neighbours.searches;
            const mps_device_info i = step_of(sim);
            assert_true(head_of(sim)->pockets == 1);
            assert_int_equal(i.host_calls, 2);
            if (k == 0 || sim->world.lists.neighbours.searches > before) continue;
            print_message("%d-D, %lld particles:", (int)g->dim, (long long)n);
            assert_in("waits", i.waits, 20, 45);
            assert_in("bytes up", i.bytes_up, n * 8 * (4 + g->dim), n * 8 * (4 + g->dim) + 1000);
            assert_in("bytes down\n", i.bytes_down, n * range[0], n * range[1]);
            steps++;
        }
        assert_true(steps > 4);
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    struct CMUnitTest tests[] = {
        cmocka_unit_test(scenes_with_gas),
        cmocka_unit_test(failing_devices),
        cmocka_unit_test(costs_without_a_pocket),
        cmocka_unit_test(costs_with_a_pocket),
    };
    take_turns(tests, sizeof tests / sizeof tests[0], 3);
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

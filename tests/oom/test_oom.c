/* SPDX-License-Identifier: BSD-3-Clause */
/* Out of memory: the k-th allocation fails, for k = 1, 2, ... until a call succeeds. Every failure
 * is MPS_E_NOMEM with a text, the handle remains usable, and finally all memory is freed. */
#include "oom_fixture.h"

/* ---- calls under test ------------------------------------------------------------------------ */

static mps_status baffle(mps_sim *sim)
{
    const double lo[2] = {0.25, 0.05}, hi[2] = {0.25, 0.2};
    return mps_baffle_add(sim, "baffle", lo, hi, NULL);
}

static mps_status plate(mps_sim *sim)
{
    const double corner[2] = {0.2, 0.05}, edge[2] = {0.1, 0.15};
    return mps_plate_add(sim, "plate", corner, edge, NULL);
}

static int anywhere(void *user, const double *x)
{
    return (void)user, x[1] < 0.3;
}
static mps_status fill_inside(mps_sim *sim)
{
    return mps_fill_add(sim, 0, anywhere, NULL, NULL);
}

static double round_shell(void *user, const double *x)
{
    return (void)user, 0.3 - hypot(x[0] - 0.3, x[1] - 0.3);
}

static int round_inside(void *user, const double *x)
{
    return round_shell(user, x) < 0;
}

static mps_status add_solid(mps_sim *sim, mps_distance_fn distance, mps_inside_fn inside)
{
    mps_solid solid;
    assert_int_equal(mps_solid_init(&solid, sizeof solid), MPS_OK);
    solid.distance = distance;
    solid.inside = inside;
    solid.hi[0] = solid.hi[1] = 0.6;
    return mps_solid_add(sim, &solid);
}

static mps_status solid(mps_sim *sim)
{
    return add_solid(sim, round_shell, NULL);
}

static mps_status solid_by_inside(mps_sim *sim)
{
    return add_solid(sim, NULL, round_inside);
}

static void solid_only(mps_sim *sim)
{
    assert_int_equal(solid(sim), MPS_OK);
}

static mps_status add_block(mps_sim *sim)
{
    return add_drop(sim, 0.36, 64);
}

static mps_status remove_some(mps_sim *sim)
{
    const int64_t ids[3] = {3, 1, 40};
    return mps_particles_remove(sim, 3, ids);
}

static mps_status field_add(mps_sim *sim)
{
    return mps_field_add(sim, "mine", 3);
}

static mps_status harmonics(mps_sim *sim)
{
    const mps_harmonic h = {.dof = MPS_MOVE_X, .amplitude = 0.01, .omega = 3};
    return mps_motion_harmonics_set(sim, 1, &h);
}

static mps_status motion_table(mps_sim *sim)
{
    const double t[4] = {0, 1, 2, 3}, x[4] = {0, 0.01, 0, -0.01};
    const int32_t dof = MPS_MOVE_X;
    return mps_motion_table_set(sim, 4, t, 1, &dof, x);
}

static mps_status probe(mps_sim *sim)
{
    mps_probe p;
    int32_t id = -1;
    assert_int_equal(mps_probe_init(&p, sizeof p), MPS_OK);
    p.at[1] = 0.1;
    const mps_status status = mps_probe_add(sim, &p, &id);
    assert_int_equal(id, status == MPS_OK ? 0 : -1);
    return status;
}

/* ---- presets and all else that takes memory --- */

static mps_status fill_level(mps_sim *sim)
{
    const double lo[2] = {0, 0}, hi[2] = {0.5, 0.28};
    return mps_fill_level_add(sim, 0, lo, hi, NULL, NULL);
}

static const char stl_path[] = "oom.stl";

static mps_status stl_solid(mps_sim *sim)
{
    mps_stl stl;
    assert_int_equal(mps_stl_init(&stl, sizeof stl), MPS_OK);
    int64_t edges = 0;
    const mps_status status = mps_stl_edges(sim, stl_path, &stl, 0.3, 0, NULL, &edges);
    if (status != MPS_OK) return status;
    assert_int_equal(edges, 6);
    return mps_stl_add(sim, stl_path, &stl, NULL);
}

/* A tetrahedron. */
static void write_stl(void)
{
    static const double corner[4][3] = {{0, 0, 0}, {0.4, 0, 0}, {0, 0.4, 0}, {0, 0, 0.4}};
    static const int face[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    FILE *file = fopen(stl_path, "w");
    assert_non_null(file);
    fprintf(file, "solid a\n");
    for (int f = 0; f < 4; f++) {
        fprintf(file, "facet normal 0 0 0\nouter loop\n");
        for (int k = 0; k < 3; k++)
            fprintf(file, "vertex %g %g %g\n", corner[face[f][k]][0], corner[face[f][k]][1],
                    corner[face[f][k]][2]);
        fprintf(file, "endloop\nendfacet\n");
    }
    fprintf(file, "endsolid a\n");
    assert_int_equal(fclose(file), 0);
}

static mps_status model(mps_sim *sim)
{
    return mps_model_use(sim, "tension.csf");
}

static mps_status verb_info(mps_sim *sim)
{
    mps_verb_info v;
    assert_int_equal(mps_verb_info_init(&v, sizeof v), MPS_OK);
    return mps_verb_info_get(sim, 0, &v);
}

static mps_status custom_kernel(mps_sim *sim)
{
    mps_kernel kernel = {.struct_size = sizeof kernel};
    assert_int_equal(mps_kernel_find("original", &kernel), MPS_OK);
    return mps_kernel_use(sim, &kernel);
}

static mps_status remove_probe(mps_sim *sim)
{
    return mps_probe_remove(sim, 0);
}

static mps_status callback(mps_sim *sim)
{
    return mps_motion_clear(sim);
}

static const scene scenes[] = {
    {"geometry_tank", nothing, add_tank, 2, 0},
    {"geometry_baffle", tank_only, baffle, 2, 0},
    {"geometry_plate", tank_only, plate, 2, 0},
    {"geometry_fill_box", tank_only, fill, 2, 0},
    {"geometry_fill", tank_only, fill_inside, 2, 0},
    {"geometry_solid", nothing, solid, 50, 0},
    {"geometry_solid by inside", nothing, solid_by_inside, 60, 0},
    {"geometry_fill beside a solid", solid_only, fill_inside, 30, 0},
    {"particles_add", filled, add_block, 5, 0},
    {"particles_remove", filled, remove_some, 3, 0},
    {"field_add", filled, field_add, 1, 0},
    {"motion_set_harmonics", filled, harmonics, 1, 0},
    {"motion_set_table", filled, motion_table, 1, 0},
    {"probe_add", filled, probe, 1, 0},
    {"solver_use", filled, solver, 1, 0},
    {"use_preset", filled, preset, 0, 0},
    {"geometry_fill_level", tank_only, fill_level, 2, 0},
    {"geometry_stl", nothing, stl_solid, 20, 3},
    {"geometry_stl in a tank", tank_only, stl_solid, 20, 3},
    {"model_use", filled, model, 0, 0},
    {"model_register", filled, register_model, 0, 0},
    {"model_use of an own model", with_own_model, use_own_model, 1, 0},
    {"verb_info_get", filled, verb_info, 0, 0},
    {"sim_set_kernel", tank_only, custom_kernel, 0, 0},
    {"probe_remove", sampled, remove_probe, 0, 0},
    {"motion_clear", filled, callback, 0, 0},
};

static void sim_create(void **state)
{
    (void)state;
    dimension = 2;
    mps_status status = MPS_E_NOMEM;
    int64_t k = 0;
    while (status != MPS_OK) {
        memory m = {0, 0, ++k};
        mps_sim *sim = (mps_sim *)&m;
        char error[200] = "";
        status = create(&m, &sim, error, sizeof error);
        if (status == MPS_OK) {
            assert_true(m.live > 0);
            mps_sim_destroy(sim);
        } else {
            assert_int_equal(status, MPS_E_NOMEM);
            assert_null(sim);
            assert_non_null(strstr(error, "memory"));
        }
        assert_int_equal(m.live, 0);
    }
    assert_true(k > 15);
}

static void neighbours(void **state)
{
    (void)state;
    double x[200];
    mps_kernel kernel = {.struct_size = sizeof kernel};
    mps_stencil s = {.struct_size = sizeof s};
    assert_int_equal(mps_kernel_find("improved", &kernel), MPS_OK);
    for (int k = 0; k < 200; k++) x[k] = k % 2 ? k / 20 : k / 2 % 10;
    for (int64_t k = 1;; k++) {
        memory m = {0, 0, k};
        const mps_allocator allocator = allocator_of(&m);
        mps_neighbours *list = (mps_neighbours *)&m;
        mps_status status = mps_neighbours_create(2, 1, &allocator, &list);
        if (status != MPS_OK) {
            assert_int_equal(status, MPS_E_NOMEM);
            assert_null(list);
            continue;
        }
        assert_true(k > 1);
        status = mps_neighbours_build(list, 100, x, 2.1, 3.1);
        const bool failed = status != MPS_OK;
        if (failed) {
            assert_int_equal(status, MPS_E_NOMEM);
            assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &s),
                             MPS_E_ARG); /* empty */
            assert_int_equal(mps_neighbours_build(list, 100, x, 2.1, 3.1), MPS_OK);
        }
        assert_int_equal(mps_neighbours_stencil_get(list, MPS_NEAR, &kernel, &s), MPS_OK);
        assert_int_equal(s.end[55] - s.begin[55], 12);
        mps_neighbours_destroy(list);
        assert_int_equal(m.live, 0);
        if (!failed) {
            assert_true(k > 8);
            break;
        }
    }
}

int main(void)
{
    enum { SCENES = sizeof scenes / sizeof scenes[0] };
    struct CMUnitTest tests[SCENES + 2] = {cmocka_unit_test(sim_create),
                                           cmocka_unit_test(neighbours)};
    for (int k = 0; k < SCENES; k++)
        tests[k + 2] = (struct CMUnitTest){scenes[k].name, run_scene, NULL, NULL,
                                           (void *)&scenes[k]};
    write_stl();
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    remove(stl_path);
    return failed;
}

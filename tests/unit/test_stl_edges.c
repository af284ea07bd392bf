/* SPDX-License-Identifier: BSD-3-Clause */
/* Sharp edges of STL files. */
#include "stl_fixture.h"

/* Each edge of a box once, between its transformed corners, for any diagonals in the file; on a
 * sphere none with a smaller angle than its faces. */
static void sharp_edges(void **state)
{
    const triangles box = box_mesh(), fine = sphere_mesh(24);
    const double degree = acos(-1.0) / 180;
    double ends[12][6], few[2][6] = {{0}};
    int64_t count = -1;
    mps_sim *sim = new_sim(3, 0.2);
    mps_stl stl;
    (void)state;
    assert_int_equal(mps_stl_init(&stl, sizeof stl), MPS_OK);
    stl.scale = 2;
    stl.shift[1] = -1;
    write_binary(&box);
    ASSERT_OK(sim, mps_stl_edges(sim, path, &stl, 20 * degree, 12, ends[0], &count));
    assert_int_equal(count, 12);
    double length = 0;
    for (int k = 0; k < 12; k++) {
        int along = 0;
        for (int d = 0; d < 3; d++) {
            const double side = (const double[]){4, 2.4, 3.2}[d];
            for (int e = 0; e < 2; e++) {
                const double x = ends[k][3 * e + d] + (d == 1);
                ASSERT_NEAR(fmin(fabs(x), fabs(x - side)), 0, 1e-6);
            }
            along += fabs(ends[k][d] - ends[k][3 + d]) > 0.1;
            length += fabs(ends[k][d] - ends[k][3 + d]);
        }
        assert_int_equal(along, 1);
        for (int j = 0; j < k; j++) assert_memory_not_equal(ends[j], ends[k], sizeof ends[k]);
    }
    ASSERT_NEAR(length, 4 * (4 + 2.4 + 3.2), 1e-5);
    ASSERT_OK(sim, mps_stl_edges(sim, path, &stl, 20 * degree, 1, few[0], &count));
    assert_int_equal(count, 12);
    assert_memory_equal(few[0], ends[0], sizeof few[0]);
    assert_true(few[1][0] == 0 && few[1][5] == 0);
    ASSERT_OK(sim, mps_stl_edges(sim, path, &stl, 91 * degree, 0, NULL, &count));
    assert_int_equal(count, 0);
    assert_int_equal(mps_particles_count(sim, -1), 0);
    write_binary(&fine); /* of faces 7.5 degrees apart */
    ASSERT_OK(sim, mps_stl_edges(sim, path, &stl, 8 * degree, 0, NULL, &count));
    assert_int_equal(count, 0);
    ASSERT_OK(sim, mps_stl_edges(sim, path, &stl, 7 * degree, 0, NULL, &count));
    assert_true(count > 0 && 2 * count <= 3 * fine.count);
    count = -1;
    ASSERT_REFUSED(sim, mps_stl_edges(sim, path, &stl, -1, 0, NULL, &count), MPS_E_ARG, "0..pi");
    ASSERT_REFUSED(sim, mps_stl_edges(sim, path, &stl, 4, 0, NULL, &count), MPS_E_ARG, "0..pi");
    ASSERT_REFUSED(sim, mps_stl_edges(sim, path, &stl, 1, 1, NULL, &count), MPS_E_ARG, "ends");
    ASSERT_REFUSED(sim, mps_stl_edges(sim, path, &stl, 1, -1, ends[0], &count), MPS_E_ARG,
                   "capacity");
    ASSERT_REFUSED(sim, mps_stl_edges(sim, path, &stl, 1, 0, NULL, NULL), MPS_E_ARG, "count");
    ASSERT_REFUSED(sim, mps_stl_edges(sim, "none.stl", &stl, 1, 0, NULL, &count), MPS_E_IO, "none");
    stl.scale = -1;
    ASSERT_REFUSED(sim, mps_stl_edges(sim, path, &stl, 1, 0, NULL, &count), MPS_E_ARG, "scale");
    assert_int_equal(count, -1);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sharp_edges)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

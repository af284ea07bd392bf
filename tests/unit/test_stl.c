/* SPDX-License-Identifier: BSD-3-Clause */
/* STL files: both formats, scale, invalid meshes, truncated files and changed bytes; distances to
 * meshes. */
#include "stl_fixture.h"
#include "../every.h"
#include <sys/stat.h>

/* ---- meshes ---- */

static void turn(triangles *t, int k)
{
    for (int d = 0; d < 3; d++) {
        const float first = t->x[k][d];
        t->x[k][d] = t->x[k][3 + d];
        t->x[k][3 + d] = first;
    }
}

/* ---- files ---- */

static void write_ascii(const triangles *t)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, "solid a tank\r\n");
    for (int i = 0; i < t->count; i++) {
        const float *x = t->x[i];
        fprintf(file, " facet normal nan 0 0\n  OUTER loop\n");
        for (int k = 0; k < 3; k++)
            fprintf(file, "   vertex %.9e %.9g %+.9E\n", x[3 * k], x[3 * k + 1], x[3 * k + 2]);
        fprintf(file, "  endloop\n endfacet\n");
    }
    fprintf(file, "endsolid a tank\n");
    assert_int_equal(fclose(file), 0);
}

static mps_status read_file(mps_sim *sim, int container, double scale)
{
    mps_stl stl;
    double built[6];
    assert_int_equal(mps_stl_init(&stl, sizeof stl), MPS_OK);
    stl.container = container;
    stl.scale = scale;
    return mps_stl_add(sim, path, &stl, built);
}

/* ---- tests ---- */

static double area_of(const mps_sim *sim, double *volume)
{
    const mps__particles *s = &sim->world.particles;
    double area = 0;
    *volume = 0;
    for (int64_t i = 0; i < s->n; i++) {
        if (s->kind[i] != MPS_WALL) continue;
        area += sqrt(mps__dot(&s->area[3 * i], &s->area[3 * i], 3));
        *volume -= mps__dot(&s->area[3 * i], &s->ref[3 * i], 3) / 3;
    }
    return area;
}

static void both_forms(void **state)
{
    (void)state;
    const triangles t = box_mesh();
    int64_t walls[2];
    for (int ascii = 0; ascii < 2; ascii++) {
        mps_sim *sim = new_sim(3, 0.2);
        double volume;
        if (ascii)
            write_ascii(&t);
        else
            write_binary(&t);
        ASSERT_OK(sim, read_file(sim, 1, 1));
        ASSERT_NEAR(area_of(sim, &volume), 15.04, 1.2); /* edges, see test_solid.c */
        ASSERT_NEAR(volume, 3.84, 0.01);
        const mps__particles *s = &sim->world.particles;
        for (int64_t i = 0; i < s->n; i++) {
            if (s->kind[i] != MPS_WALL) continue;
            const double *x = &s->ref[3 * i];
            const double near = fmin(fmin(fmin(x[0], 2 - x[0]), fmin(x[1], 1.2 - x[1])),
                                     fmin(x[2], 1.6 - x[2]));
            ASSERT_NEAR(near, 0, 1e-4);
        }
        walls[ascii] = mps_particles_count(sim, MPS_WALL);
        const double lo[3] = {0, 0, 0}, hi[3] = {2, 0.6, 1.6};
        int64_t added;
        ASSERT_OK(sim, mps_fill_box_add(sim, 0, lo, hi, &added, NULL));
        assert_int_equal(added, 9 * 3 * 7);
        mps_sim_destroy(sim);
    }
    assert_int_equal(walls[0], walls[1]);
}

/* Millimetres, inside out, as a body. */
static void scale_and_orientation(void **state)
{
    (void)state;
    triangles t = sphere_mesh(16);
    for (int turned = 0; turned < 2; turned++) {
        for (int k = 0; turned && k < t.count; k++) turn(&t, k);
        write_binary(&t);
        for (int container = 0; container < 2; container++) {
            mps_sim *sim = new_sim(3, 1e-4);
            double volume;
            ASSERT_OK(sim, read_file(sim, container, 1e-3));
            ASSERT_NEAR(area_of(sim, &volume) * 1e6, 4 * 3.14159, 0.02 * 4 * 3.14159);
            /* about (1, 1, 1) mm: the sum of the areas is zero, so the position does not matter */
            ASSERT_NEAR(volume * 1e9, container ? 4.13 : -4.13, 0.1);
            ASSERT_REFUSED(sim, read_file(sim, container, 1e-6), MPS_E_ARG,
                           "is the unit of the file right?");
            mps_sim_destroy(sim);
        }
    }
}

static void refused(mps_status wanted, const char *word)
{
    mps_sim *sim = new_sim(3, 0.2);
    ASSERT_REFUSED(sim, read_file(sim, 1, 1), wanted, word);
    assert_int_equal(mps_particles_count(sim, -1), 0);
    mps_sim_destroy(sim);
}

static void bad_meshes(void **state)
{
    (void)state;
    triangles t = box_mesh();
    t.count--;
    write_binary(&t);
    refused(MPS_E_ARG, "not closed: 3 edges");
    t = box_mesh();
    turn(&t, 5);
    write_binary(&t);
    refused(MPS_E_ARG, "not oriented: at 3 edges");
    t = box_mesh();
    t.x[3][4] = NAN;
    write_binary(&t);
    refused(MPS_E_ARG, "coordinate 4 of triangle 3 is nan");
    t.count = 0;
    write_binary(&t);
    refused(MPS_E_ARG, "no triangles");
    write_ascii(&t);
    refused(MPS_E_ARG, "no triangles");
    t.count = 1;
    memset(t.x[0], 0, sizeof t.x[0]);
    write_binary(&t);
    refused(MPS_E_ARG, "no triangle with an area");
}

static void bad_files(void **state)
{
    (void)state;
    unsigned char *bytes;
    const triangles t = box_mesh();
    const size_t size = binary_of(&t, &bytes);
    bytes[0] = 'x';
    write_bytes(bytes, size - 1);
    refused(MPS_E_IO, "a binary STL file of 12 triangles has 684");
    write_bytes(bytes, 50);
    refused(MPS_E_IO, "has 50 bytes");
    bytes[80] = 13;
    write_bytes(bytes, size);
    refused(MPS_E_IO, "of 13 triangles has 734");
    free(bytes);
    static const char *const text[][2] = {
        {"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0", "ends in line 5"},
        {"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1,5\n", "\"1,5\" instead of"},
        {"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1e999\n", "\"1e999\" instead of"},
        {"solid x\nfacet normal 0 0 1\nouter ring\n", "line 3: \"ring\" instead of \"loop\""},
        {"solid x\nrubbish\n", "\"rubbish\" instead of \"facet\""},
        {"solid x\nendsolid x\nmore\n", "\"more\" instead of \"solid\""},
    };
    for (size_t k = 0; k < sizeof text / sizeof text[0]; k++) {
        write_bytes(text[k][0], strlen(text[k][0]));
        refused(MPS_E_IO, text[k][1]);
    }
    unlink(path);
    refused(MPS_E_IO, "cannot open");
    assert_int_equal(mkfifo(path, 0600), 0);
    refused(MPS_E_IO, "it is a pipe (FIFO), no regular file"); /* it does not wait for a writer */
    unlink(path);
    mps_sim *sim = new_sim(2, 0.1);
    ASSERT_REFUSED(sim, read_file(sim, 1, 1), MPS_E_ARG, "needs 3-D");
    mps_sim_destroy(sim);
    sim = new_sim(3, 0.1);
    ASSERT_REFUSED(sim, read_file(sim, 1, -1), MPS_E_ARG, "stl.scale");
    ASSERT_REFUSED(sim, mps_stl_add(sim, "", &(mps_stl){.struct_size = sizeof(mps_stl)}, NULL),
                   MPS_E_ARG, "empty");
    write_binary(&t);
    add_tank(sim, 1, 1, 1); /* in a tank too lattice points must not be one */
    const mps_stl far = {.struct_size = sizeof far, .container = 1, .shift = {0, 0, 1e16}};
    ASSERT_REFUSED(sim, mps_stl_add(sim, path, &far, NULL), MPS_E_ARG, "must be within 1e+08 m");
    mps_sim_destroy(sim);
}

/* A triangle of no area on an edge is skipped and the mesh is still closed. */
static void degenerate_triangles(void **state)
{
    (void)state;
    triangles t = box_mesh();
    memcpy(t.x[t.count], t.x[0], sizeof t.x[0]);
    memcpy(&t.x[t.count][6], &t.x[0][3], 3 * sizeof(float));
    t.count++;
    write_binary(&t);
    mps_sim *sim = new_sim(3, 0.2);
    ASSERT_OK(sim, read_file(sim, 1, 1));
    mps_sim_destroy(sim);
}

static uint32_t random_number(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* Any file: a status, and nothing added unless it is MPS_OK. */
static void try_file(void)
{
    mps_sim *sim = new_sim(3, 0.5);
    const mps_status status = read_file(sim, 1, 1);
    if (status != MPS_OK) {
        assert_true(status == MPS_E_ARG || status == MPS_E_IO || status == MPS_E_NOMEM);
        assert_true(mps_sim_error(sim)[0] != 0);
        assert_int_equal(mps_particles_count(sim, -1), 0);
    }
    mps_sim_destroy(sim);
}

static void damaged_files(void **state)
{
    (void)state;
    const triangles t = box_mesh();
    for (int ascii = 0; ascii < 2; ascii++) {
        unsigned char *bytes = NULL;
        uint32_t seed = 7;
        size_t size = binary_of(&t, &bytes);
        if (ascii) {
            write_ascii(&t);
            FILE *file = fopen(path, "rb");
            free(bytes);
            bytes = calloc(1 << 16, 1);
            assert_true(file && bytes);
            size = fread(bytes, 1, 1 << 16, file);
            fclose(file);
        }
        for (size_t cut = 0; cut < size; cut += 1 + (size_t)every(4) * size / 60) {
            write_bytes(bytes, cut);
            try_file();
        }
        for (int k = 0; k < 120 / every(4); k++) {
            const size_t at = random_number(&seed) % size;
            const unsigned char kept = bytes[at];
            bytes[at] ^= (unsigned char)(1 << random_number(&seed) % 8);
            write_bytes(bytes, size);
            try_file();
            bytes[at] = kept;
        }
        free(bytes);
    }
}

/* The side of a point near faces, edges and corners of a box, and its distance. */
static void distances(void **state)
{
    (void)state;
    const triangles t = box_mesh();
    mps__context context = {.allocator = mps__allocator_default()};
    mps__mesh m;
    mps__mesh_faults faults;
    mps__mesh_init(&m, &context, 3);
    assert_int_equal(mps__mesh_reserve(&m, 3 * t.count, t.count), MPS_OK);
    for (int k = 0; k < 9 * t.count; k++) m.x[k] = t.x[k / 9][k % 9];
    for (int k = 0; k < 3 * t.count; k++) m.corner[k] = k;
    m.points = 3 * t.count;
    m.elements = t.count;
    assert_int_equal(mps__mesh_weld(&m, 0, &faults), MPS_OK);
    assert_int_equal(m.points, 8);
    assert_int_equal(faults.open + faults.turned + faults.degenerate, 0);
    assert_int_equal(mps__mesh_finish(&m), MPS_OK);
    ASSERT_NEAR(mps__mesh_volume(&m), 3.84, 1e-6);
    const double size[3] = {2, (float)1.2, (float)1.6};
    for (int k = 0; k < 5 * 5 * 5; k++) {
        const int step[3] = {k % 5, k / 5 % 5, k / 25};
        double x[3], foot[3], n[3], out2 = 0, most = -INFINITY;
        for (int d = 0; d < 3; d++) {
            x[d] = size[d] * (0.37 * step[d] - 0.3);
            const double q = fmax(-x[d], x[d] - size[d]);
            out2 += fmax(q, 0) * fmax(q, 0);
            most = fmax(most, q);
        }
        const double r = mps__mesh_distance(&m, x, foot, n);
        ASSERT_NEAR(r, fmin(most, 0) + sqrt(out2), 1e-12);
        for (int d = 0; d < 3; d++) ASSERT_NEAR(foot[d] + r * n[d], x[d], 1e-12);
    }
    mps__mesh_free(&m);
}

/* The axis z of the file becomes y: a rotation by 90 degrees about x. Angles are about x, then y,
 * then z of the tank. */
static void rotation(void **state)
{
    (void)state;
    const double quarter = 0.5 * 3.14159265358979323846;
    const struct {
        double angle[3], lo[3], hi[3];
    } c[] = {{{0, 0, 0}, {0, 0, 0}, {2, 1.2, 1.6}},
             {{-quarter, 0, 0}, {0, 0, -1.2}, {2, 1.6, 0}},
             {{0, quarter, 0}, {0, 0, -2}, {1.6, 1.2, 0}},
             {{0, 0, quarter}, {-1.2, 0, 0}, {0, 2, 1.6}},
             {{quarter, quarter, 0}, {0, -1.6, -2}, {1.2, 0, 0}},
             {{0.5, 0, 0},
              {0, -1.6 * sin(0.5), 0},
              {2, 1.2 * cos(0.5), 1.2 * sin(0.5) + 1.6 * cos(0.5)}}};
    const triangles box = box_mesh();
    write_binary(&box);
    for (size_t k = 0; k < sizeof c / sizeof c[0]; k++) {
        mps_sim *sim = new_sim(3, 0.2);
        mps_stl stl;
        double built[6], volume;
        assert_int_equal(mps_stl_init(&stl, sizeof stl), MPS_OK);
        stl.container = 1;
        memcpy(stl.rotation, c[k].angle, sizeof stl.rotation);
        stl.shift[2] = 3;
        ASSERT_OK(sim, mps_stl_add(sim, path, &stl, built));
        for (int d = 0; d < 3; d++) {
            ASSERT_NEAR(built[d], c[k].lo[d] + (d == 2 ? 3 : 0), 1e-6);
            ASSERT_NEAR(built[3 + d], c[k].hi[d] + (d == 2 ? 3 : 0), 1e-6);
        }
        ASSERT_NEAR(area_of(sim, &volume), 13.9544,
                    k < 5 ? 1e-3 : 0.1); /* 15.04 less edges, at 6 to 10 dp */
        mps_sim_destroy(sim);
    }
    mps_sim *sim = new_sim(3, 0.2);
    mps_stl stl;
    assert_int_equal(mps_stl_init(&stl, sizeof stl), MPS_OK);
    stl.rotation[1] = NAN;
    ASSERT_REFUSED(sim, mps_stl_add(sim, path, &stl, NULL), MPS_E_ARG,
                   "stl.rotation is (0, nan, 0) rad");
    stl.rotation[1] = 0;
    stl.open_side = MPS_SIDE_Y1;
    ASSERT_REFUSED(sim, mps_stl_add(sim, path, &stl, NULL), MPS_E_ARG, "a body has none");
    stl.container = 1;
    stl.open_side = 7;
    ASSERT_REFUSED(sim, mps_stl_add(sim, path, &stl, NULL), MPS_E_ARG, "stl.open_side is 7");
    mps_sim_destroy(sim);
}

/* No particle of the solid is in the plane of the open side or beyond; the other walls extend up to
 * it. */
static void open_sides(void **state)
{
    (void)state;
    static const double size[3] = {2, 1.2, 1.6};
    const triangles box = box_mesh();
    write_binary(&box);
    for (int32_t side = MPS_SIDE_NONE; side <= MPS_SIDE_Z1; side++) {
        mps_sim *sim = new_sim(3, 0.2);
        const mps__particles *s = &sim->world.particles;
        const int d = side > 0 ? (side - 1) / 2 : 0, up = (side - 1) % 2;
        const double sign = up ? 1 : -1, plane = up ? size[d] : 0;
        double nearest = INFINITY, area = 0, lid = size[(d + 1) % 3] * size[(d + 2) % 3],
               whole = 2 * (2 * 1.2 + 2 * 1.6 + 1.2 * 1.6);
        mps_stl stl;
        assert_int_equal(mps_stl_init(&stl, sizeof stl), MPS_OK);
        stl.container = 1;
        stl.open_side = side;
        ASSERT_OK(sim, mps_stl_add(sim, path, &stl, NULL));
        for (int64_t i = 0; i < s->n; i++) {
            if (s->kind[i] == MPS_WALL) area += sqrt(mps__dot(&s->area[3 * i], &s->area[3 * i], 3));
            nearest = fmin(nearest, sign * (plane - s->ref[3 * i + d]));
        }
        if (side > 0) assert_true(nearest > 0.09 && nearest < 0.21);
        if (side > 0)
            assert_true(area < whole - 0.9 * lid && area > whole - lid - 0.2 * 2 * 3.6 - 0.3);
        fill_depth(sim, 2, 0.6, 1.6);
        for (int k = 0; side == MPS_SIDE_Y1 && k < 5; k++)
            ASSERT_OK(sim, mps_step(sim, 1e-3, NULL));
        mps_sim_destroy(sim);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rotation),
        cmocka_unit_test(open_sides),
        cmocka_unit_test(both_forms),
        cmocka_unit_test(scale_and_orientation),
        cmocka_unit_test(bad_meshes),
        cmocka_unit_test(bad_files),

        cmocka_unit_test(degenerate_triangles),
        cmocka_unit_test(damaged_files),
        cmocka_unit_test(distances),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Voids of the tank: the same bytes with any number of threads, limits, refusals, positions. */
#include "void_fixture.h"
#include <stdbool.h>

/* Ten steps of liquid that falls into its voids. */
static void fall(found_voids *f, int32_t threads)
{
    mps_sim *sim = new_sim(2, DP);
    add_tank(sim, 1, 0.8, 0);
    add_dividing_plate(sim);
    fill_drawn(sim, 2, 0.5, in_both);
    watch_voids(sim, f);
    ASSERT_OK(sim, mps_threads_set(sim, threads));
    for (int k = 0; k < 10; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    mps_sim_destroy(sim);
}

static void test_threads(void **state)
{
    found_voids one, f;
    (void)state;
    fall(&one, 1);
    assert_true(one.v.count >= 4 && one.v.faces > 300);
    for (int32_t threads = 2; threads <= 5; threads += 3) {
        fall(&f, threads);
        assert_int_equal(f.v.count, one.v.count);
        assert_int_equal(f.v.faces, one.v.faces);
        assert_memory_equal(f.label, one.label, (size_t)cells_of(&f.v) * sizeof *f.label);
        assert_memory_equal(f.size, one.size, (size_t)f.v.count * sizeof *f.size);
        for (int k = 0; k < 5; k++)
            assert_memory_equal(f.face[k], one.face[k], (size_t)f.v.faces * sizeof *f.face[k]);
        forget_voids(&f);
    }
    forget_voids(&one);
}

static void test_least(void **state)
{
    found_voids f;
    mps_sim *sim = drawn_2d(&f, in_both);
    (void)state;
    f.config.least = 65; /* the circle has 113 dp2, the box 70, of which deep are fewer */
    step_and_end(sim);
    assert_int_equal(f.v.count, 2);
    assert_true(share_within(&f, 1, in_circle) > 0.95);
    forget_voids(&f);
}

/* Liquid without a tank has no raster. */
static void test_no_tank(void **state)
{
    found_voids f;
    const double x[4] = {0, 0, 0, 0.02};
    mps_particle_block b;
    mps_sim *sim = new_sim(2, DP);
    (void)state;
    assert_int_equal(mps_particle_block_init(&b, sizeof b), MPS_OK);
    b.count = 2;
    b.position = x;
    ASSERT_OK(sim, mps_particles_add(sim, &b, NULL));
    watch_voids(sim, &f);
    step_and_end(sim);
    assert_int_equal(f.steps, 1);
    assert_int_equal(f.v.count, 0);
    assert_int_equal(cells_of(&f.v), 0);
    forget_voids(&f);
}

static int ask_early(mps_stage *s)
{
    mps_voids v;
    assert_int_equal(mps_voids_init(&v, sizeof v), MPS_OK);
    return mps_stage_voids(s, NULL, &v);
}

static int ask_for_nothing(mps_stage *s)
{
    return mps_stage_voids(s, NULL, NULL);
}

static void test_refusals(void **state)
{
    static const mps_verb early[] = {{.hook = MPS_LIMIT, .run = ask_early}},
                          null[] = {{.hook = MPS_PREPARE, .run = ask_for_nothing}};
    const mps_model_ops early_ops = {TOY("early.voids", 1, early)},
                        null_ops = {TOY("null.voids", 1, null)};
    static const struct {
        double side, cover, channel, least;
        const char *word;
    } bad[] = {{0.1, 0, 0, 0, "side is 0.1 dp"},  {3, 0, 0, 0, "side is 3 dp"},
               {0, 0.2, 0, 0, "cover is 0.2 dp"}, {0, 0, 0.5, 0, "channel is 0.5 dp"},
               {0, 0, 4, 0, "channel is 4 dp"},   {0, 0, 0, -1, "least is -1 dp"},
               {NAN, 0, 0, 0, "side is nan"},     {0, 0, 0, INFINITY, "least is inf"}};
    found_voids f;
    mps_sim *sim = drawn_2d(&f, none);
    (void)state;
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
        f.config.side = bad[k].side;
        f.config.cover = bad[k].cover;
        f.config.channel = bad[k].channel;
        f.config.least = bad[k].least;
        ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, bad[k].word);
    }
    assert_int_equal(mps_voids_config_init(&f.config, sizeof f.config), MPS_OK);
    use_model(sim, &early_ops);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "before MPS_PREPARE");
    ASSERT_OK(sim, mps_model_remove(sim, "early"));
    use_model(sim, &null_ops);
    ASSERT_REFUSED(sim, mps_step(sim, 1, NULL), MPS_E_PLUGIN, "mps_voids is NULL");
    ASSERT_OK(sim, mps_model_remove(sim, "null"));
    step_and_end(sim);
    assert_int_equal(f.v.count, 1);
    forget_voids(&f);
}

/* Positions in the grid. */
static void test_places(void **state)
{
    found_voids f;
    const double in[2] = {0.503, 0.252}, beyond[2] = {0.5, -0.1}, wall[2] = {0.503, 0.39};
    mps_sim *sim = drawn_2d(&f, in_circle);
    (void)state;
    step_and_end(sim);
    f.v.label = f.label;
    assert_int_equal(f.label[mps_voids_cell(&f.v, in)], 1);
    assert_int_equal(mps_voids_cell(&f.v, beyond), -1);
    assert_int_equal(mps_voids_near(&f.v, in, 0.02), 1);
    assert_int_equal(mps_voids_near(&f.v, beyond, 0.05), -1);
    assert_int_equal(mps_voids_near(&f.v, wall, 0.01), -1);
    assert_int_equal(mps_voids_near(&f.v, wall, 0.04), 1);
    forget_voids(&f);
}

/* ---- by all particles ---- */

/* Cells that were compared, of the kinds deep, liquid and narrow, and faces. */
static struct {
    int64_t deep, liquid, narrow, faces;
} compared;

typedef struct liquid {
    double place[3];
    int64_t id;
} liquid;

static bool is_wet(const mps_view *v, const int32_t *region, int64_t i)
{
    if (!mps_is_wall(v, i) || region[i] == MPS_REGION_DRY) return false;
    for (int64_t j = 0; j < v->n; j++) {
        double square = 0;
        for (int d = 0; d < v->dim; d++)
            square += pow(v->x[i * v->dim + d] - v->x[j * v->dim + d], 2);
        if (mps_is_fluid(v, j) && region[j] != MPS_REGION_SPRAY && square < 2.25 * v->dp * v->dp)
            return true;
    }
    return false;
}

/* The distance of the nearest liquid particle from a cell's centre [dp]. */
static double nearest_of(const mps_voids *r, int64_t c, const liquid *list, int64_t count,
                         double dp, int64_t *id)
{
    const int64_t line = c / r->cells[0],
                  at[3] = {c % r->cells[0], line % r->cells[1], line / r->cells[1]};
    double least = INFINITY;
    for (int64_t k = 0; k < count; k++) {
        double square = 0;
        for (int d = 0; d < r->dim; d++)
            square += pow(r->origin[d] + ((double)at[d] + 0.5) * r->side - list[k].place[d], 2);
        if (square >= least) continue;
        least = square;
        *id = list[k].id;
    }
    return sqrt(least) / dp;
}

static int compare_all(mps_stage *s)
{
    const mps_view *v = s->view;
    const mps_voids_config *config = s->self;
    const double cover = v->dim == 2 ? 0.72 : 0.9, channel = v->dim == 2 ? 0.9 : 1.1, tiny = 1e-9;
    const int32_t *region = s->data[0];
    liquid *list = malloc((size_t)v->n * sizeof *list);
    int64_t count = 0, id = -1;
    mps_voids r;
    assert_int_equal(mps_voids_init(&r, sizeof r), MPS_OK);
    if (mps_stage_voids(s, config, &r)) return 1;
    for (int64_t i = 0; i < v->n; i++) {
        const bool fluid = mps_is_fluid(v, i) && region[i] != MPS_REGION_SPRAY;
        if (!fluid && !is_wet(v, region, i)) continue;
        mps_view_tank(v, v->x + i * v->dim, list[count].place, NULL);
        list[count++].id = v->id[i];
    }
    assert_true(r.count > 1);
    for (int64_t c = 0; c < (int64_t)r.cells[0] * r.cells[1] * r.cells[2]; c++) {
        const double distance = nearest_of(&r, c, list, count, v->dp, &id);
        if (r.label[c] == MPS_VOID_SOLID) continue;
        if (distance > channel + tiny) assert_true(r.label[c] >= 0);
        if (distance < cover - tiny) assert_int_equal(r.label[c], MPS_VOID_NONE);
        compared.deep += distance > channel;
        compared.liquid += distance < cover;
        compared.narrow += r.label[c] >= 0 && distance < channel;
    }
    for (int64_t k = 0; k < r.faces; k++) {
        const int64_t step[3] = {1, r.cells[0], (int64_t)r.cells[0] * r.cells[1]},
                      by = step[r.face_side[k] / 2] * (r.face_side[k] % 2 ? 1 : -1);
        if (r.face_row[k] < 0) continue;
        const double distance = nearest_of(&r, r.face_cell[k] + by, list, count, v->dp, &id);
        assert_true(distance < channel + tiny);
        compared.faces += v->id[r.face_row[k]] == id;
        compared.faces -= v->id[r.face_row[k]] != id; /* rounding may decide between two */
    }
    free(list);
    return 0;
}

static int rough(void *user, const double *X)
{
    (void)user;
    return X[1] < 0.3 + 0.08 * sin(23 * X[0]) && hypot(X[0] - 0.31, X[1] - 0.14) > 0.09;
}

static void compare_steps(int32_t dim, double dp, double side, int steps)
{
    static const mps_use uses[] = {{"region", MPS_USE_READ}};
    static const mps_verb verbs[] = {
        {.hook = MPS_PREPARE, .use_count = 1, .uses = uses, .run = compare_all}};
    const mps_harmonic roll = {.dof = MPS_ROTATE_Z, .amplitude = 0.3, .omega = 9};
    mps_voids_config config;
    const mps_model_ops ops = {TOY("compare.voids", 1, verbs), .user = &config};
    mps_sim *sim = new_sim(dim, dp);
    assert_int_equal(mps_voids_config_init(&config, sizeof config), MPS_OK);
    config.side = side;
    memset(&compared, 0, sizeof compared);
    add_tank(sim, 0.6, 0.5, 0.25);
    ASSERT_OK(sim, mps_fill_add(sim, 0, rough, NULL, NULL));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &roll));
    use_model(sim, &ops);
    for (int k = 0; k < steps; k++) ASSERT_OK(sim, mps_step(sim, 1, NULL));
    assert_true(compared.deep > 100 && compared.liquid > 100 && compared.narrow > 10);
    assert_true(compared.faces > 100);
    mps_sim_destroy(sim);
}

static void test_by_all_particles(void **state)
{
    (void)state;
    compare_steps(2, 0.02, 0, 25);
    compare_steps(2, 0.02, 0.31, 2);
    compare_steps(3, 0.04, 0, 2);
    compare_steps(3, 0.04, 0.6, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads), cmocka_unit_test(test_least),
        cmocka_unit_test(test_no_tank), cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_places),  cmocka_unit_test(test_by_all_particles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

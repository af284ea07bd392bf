/* SPDX-License-Identifier: BSD-3-Clause */
/* The model gas.pocket in runs: without a pocket nothing changes; bytes do not depend on threads
 * and restarts; gas is kept in a violent flow; walls in a pocket show its pressure. */
#include "phase/gas_pocket.h"
#include "../every.h"
#include "checkpoint_editor.h"
#include "frame_fixture.h"

static const double DP = 0.02;

typedef struct scene {
    double size[2], depth, length; /* of tank and liquid */
    double pocket[4];              /* box without liquid: lo, hi; of no volume: none */
    int32_t threads;
    bool gas;
    double surge; /* of the tank: acceleration x 2 [m/s2] */
    double dp;    /* 0: DP */
} scene;

static const scene calm = {.size = {0.6, 0.4}, .depth = 0.2, .length = 0.6};
static const scene closed = {.size = {0.6, 0.45},
                             .depth = 0.37,
                             .length = 0.6,
                             .pocket = {0, 0.08, 0.2, 0.28},
                             .gas = true,
                             .surge = 1};
static const scene dam = {
    .size = {1.2, 0.8}, .depth = 0.5, .length = 0.4, .gas = true, .dp = 0.0125};

static int surge(void *user, double t, mps_motion_state *state)
{
    const scene *s = user;
    state->value[MPS_MOVE_X] = s->surge * t * t;
    state->rate[MPS_MOVE_X] = 2 * s->surge * t;
    state->accel[MPS_MOVE_X] = 2 * s->surge;
    return 0;
}

static int in_liquid(void *user, const double *x)
{
    const scene *s = user;
    const double *b = s->pocket;
    if (x[0] > b[0] - 0.5 * DP && x[1] > b[1] && x[0] < b[2] && x[1] < b[3]) return 0;
    return x[0] < s->length && x[1] < s->depth;
}

static mps_sim *build(scene *s)
{
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dp = s->dp > 0 ? s->dp : DP;
    config.threads = s->threads > 0 ? s->threads : 1;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    if (s->gas) ASSERT_OK(sim, mps_model_use(sim, "gas.pocket"));
    add_tank(sim, s->size[0], s->size[1], 0);
    ASSERT_OK(sim, mps_fill_add(sim, 0, in_liquid, s, NULL));
    if (s->surge != 0) ASSERT_OK(sim, mps_motion_callback_set(sim, surge, s));
    return sim;
}

/* Positions, velocities and pressures by id; free() it. */
static double *numbers(mps_sim *sim, int64_t *count)
{
    static const char *const field[] = {"position", "velocity", "pressure", "wall_pressure"};
    mps_lease id = {.struct_size = sizeof id}, lease = id;
    *count = mps_particles_count(sim, -1);
    double *all = calloc((size_t)*count * 6, sizeof *all);
    int at = 0;
    ASSERT_OK(sim, mps_lease_begin(sim, "id", MPS_READ, &id));
    for (int f = 0; f < 4; f++) {
        ASSERT_OK(sim, mps_lease_begin(sim, field[f], MPS_READ, &lease));
        for (int64_t i = 0; i < *count; i++) {
            assert_true(id.ids[i] < *count);
            memcpy(all + 6 * id.ids[i] + at, lease.data + i * lease.stride,
                   (size_t)lease.stride * sizeof *all);
        }
        at += lease.stride;
        ASSERT_OK(sim, mps_lease_end(sim, &lease));
    }
    ASSERT_OK(sim, mps_lease_end(sim, &id));
    assert_int_equal(at, 6);
    return all;
}

static void assert_same(mps_sim *one, mps_sim *other)
{
    int64_t n, m;
    double *a = numbers(one, &n), *b = numbers(other, &m);
    assert_int_equal(n, m);
    assert_memory_equal(a, b, (size_t)n * 6 * sizeof *a);
    free(a);
    free(b);
}

static mps_step_info run_steps(mps_sim *sim, int steps)
{
    mps_step_info info;
    assert_int_equal(mps_step_info_init(&info, sizeof info), MPS_OK);
    for (int k = 0; k < steps; k++) ASSERT_OK(sim, mps_step(sim, 1, &info));
    return info;
}

static void no_pocket_no_change(void **state)
{
    (void)state;
    scene s = calm, other = calm;
    other.gas = true;
    mps_sim *a = build(&s), *b = build(&other);
    run_steps(a, 60);
    const mps_step_info info = run_steps(b, 60);
    assert_int_equal(info.pockets, 0);
    assert_same(a, b);
    mps_sim_destroy(a);
    mps_sim_destroy(b);
}

static void threads(void **state)
{
    (void)state;
    scene s = closed, other = closed;
    other.threads = 2;
    mps_sim *a = build(&s), *b = build(&other);
    const mps_step_info one = run_steps(a, 80), two = run_steps(b, 80);
    assert_int_equal(one.pockets, 1);
    assert_true(one.pocket_volume == two.pocket_volume);
    assert_true(one.pocket_pressure == two.pocket_pressure);
    assert_same(a, b);
    mps_sim_destroy(a);
    mps_sim_destroy(b);
}

static void restart(void **state)
{
    (void)state;
    static const char file[] = "pocket.checkpoint";
    scene s = closed;
    mps_sim *a = build(&s), *b = build(&s);
    mps_energy e, f;
    assert_int_equal(mps_energy_init(&e, sizeof e), MPS_OK);
    assert_int_equal(mps_energy_init(&f, sizeof f), MPS_OK);
    run_steps(a, 40);
    ASSERT_OK(a, mps_checkpoint_write(a, file));
    ASSERT_OK(b, mps_checkpoint_read(b, file));
    const mps_step_info one = run_steps(a, 40), two = run_steps(b, 40);
    assert_int_equal(two.pockets, 1);
    assert_true(one.pocket_volume == two.pocket_volume);
    assert_same(a, b);
    ASSERT_OK(a, mps_energy_get(a, &e));
    ASSERT_OK(b, mps_energy_get(b, &f));
    assert_true(e.gas != 0 && e.gas == f.gas);
    remove(file);
    mps_sim_destroy(a);
    mps_sim_destroy(b);
}

/* A number of the state, and the error text if it is changed. */
typedef struct forgery {
    size_t at;
    double value;
    const char *word;
} forgery;

/* The only model with numbers. */
static void find_numbers(unsigned char *bytes, size_t size, char *name, size_t capacity)
{
    editor_part p = {0};
    for (int k = 0; k < 64; k++) {
        snprintf(name, capacity, "numbers of model %d", k);
        if (editor_find(bytes, size, name, &p)) return;
    }
    fail_msg("no numbers");
}

/* States of another build of the model, or damaged ones, are refused and change nothing. */
static void states_that_do_not_fit(void **state)
{
    (void)state;
    enum { HEAD = sizeof(mps__pocket_head) / 8, POCKET = sizeof(mps__pocket) / 8 };
#define OF_HEAD(member) (offsetof(mps__pocket_head, member) / 8)
    static const forgery all[] = {
        {OF_HEAD(layout), 1, "'gas.pocket' in the checkpoint do not fit: their layout is 1"},
        {OF_HEAD(layout), 0, "their layout is 0, of another build; must be -1"},
        {OF_HEAD(pockets), 2, ", which is not "},
        {OF_HEAD(pockets), -1, ", which is not "},
        {OF_HEAD(pockets), 1e300, ", which is not "},
        {OF_HEAD(runs), 1.5, ", which is not "},
        {HEAD + offsetof(mps__pocket, gas) / 8, 0, "the gas of pocket 0 is 0; must be > 0"},
        {HEAD + POCKET, 1e6, "the labels of the raster"},
        {HEAD + POCKET, -1, "the labels of the raster"},
        {HEAD + POCKET + 1, 3, "the labels of the raster"},
        {HEAD + POCKET + 1, 0.5, "the labels of the raster"},
        {OF_HEAD(cells), -1, "the labels of the raster"},
        {OF_HEAD(cells[1]), 7, "the labels of the raster"}};
#undef OF_HEAD
    char path[300], name[MPS__PART_TITLE];
    size_t size;
    scene s = closed;
    mps_sim *a = build(&s), *b = build(&s);
    snprintf(path, sizeof path, "%s/state", folder);
    run_steps(a, 5);
    run_steps(b, 5);
    ASSERT_OK(a, mps_checkpoint_write(a, path));
    unsigned char *bytes = (unsigned char *)slurp("state", &size), *copy = malloc(size);
    assert_non_null(copy);
    find_numbers(bytes, size, name, sizeof name);
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
        memcpy(copy, bytes, size);
        assert_true(editor_put(copy, size, name, 8 * all[k].at, &all[k].value, 8));
        editor_repair(copy, size);
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        assert_int_equal(fwrite(copy, 1, size, file), size);
        fclose(file);
        ASSERT_REFUSED(a, mps_checkpoint_read(a, path), MPS_E_VERSION, all[k].word);
    }
    run_steps(a, 5); /* the refusals did it no harm */
    run_steps(b, 5);
    assert_same(a, b);
    remove(path);
    free(bytes);
    free(copy);
    mps_sim_destroy(a);
    mps_sim_destroy(b);
}

/* Particles with a number in the field "pocket". */
static int64_t numbered(mps_sim *sim, double number)
{
    mps_lease pocket = {.struct_size = sizeof pocket};
    int64_t count = 0;
    ASSERT_OK(sim, mps_lease_begin(sim, "pocket", MPS_READ, &pocket));
    for (int64_t i = 0; i < pocket.count; i++) count += pocket.data[i] == number;
    ASSERT_OK(sim, mps_lease_end(sim, &pocket));
    return count;
}

typedef struct books {
    int pockets; /* most */
    double closed, vented, largest;
} books;

static int follow_books(void *user, mps_sim *sim, const mps_step_info *info)
{
    books *b = user;
    const double *value = NULL;
    int64_t count = 0;
    double gas = 0, volume = 0;
    ASSERT_OK(sim, mps_model_state(sim, "gas", &value, &count));
    const mps__pocket_head *head = (const mps__pocket_head *)(const void *)value;
    const mps__pocket *pocket = (const mps__pocket *)(const void *)(value + sizeof *head / 8);
    assert_int_equal((int)head->pockets, info->pockets);
    for (int k = 0; k < info->pockets; k++) {
        gas += pocket[k].gas;
        volume += pocket[k].volume;
        assert_true(pocket[k].gas > 0 && pocket[k].volume > 0);
    }
    assert_true((numbered(sim, 0) < mps_particles_count(sim, -1)) == (info->pockets > 0));
    ASSERT_NEAR(gas, head->closed - head->vented, 1e-12);
    ASSERT_NEAR(volume, info->pocket_volume, 1e-12);
    b->closed = head->closed;
    b->vented = head->vented;
    b->largest = fmax(b->largest, fabs(info->pocket_pressure));
    if (info->pockets > b->pockets) b->pockets = info->pockets;
    return 0;
}

/* A dam break: jets enclose gas, pockets split, join and open. Their gas is the enclosed gas minus
 * the escaped gas. */
static void gas_is_kept(void **state)
{
    (void)state;
    scene s = dam;
    books b = {0};
    if (every(2) > 1) s.dp *= 1.5; /* with the pockets of a coarse run */
    mps_sim *sim = build(&s);
    ASSERT_OK(sim, mps_run(sim, 1.6, follow_books, &b));
    print_message("%d pockets at most, %.4f m2 enclosed, %.4f m2 vented, %.0f Pa at most\n",
                  b.pockets, b.closed, b.vented, b.largest);
    assert_true(b.pockets > (every(2) == 1));
    assert_true(b.vented > 0 && b.closed > b.vented - 1e-12);
    assert_true(b.largest > 100 && b.largest < 1e5);
    mps_sim_destroy(sim);
}

typedef struct means {
    double sum[2], count[2]; /* of volumes of the first and the last part of the time */
    double t_end, gas;
} means;

static int add_volume(void *user, mps_sim *sim, const mps_step_info *info)
{
    means *m = user;
    const double *value = NULL;
    int64_t count = 0;
    assert_int_equal(info->pockets, 1);
    ASSERT_OK(sim, mps_model_state(sim, "gas", &value, &count));
    const mps__pocket *pocket = (const mps__pocket *)(const void *)(value +
                                                                    sizeof(mps__pocket_head) / 8);
    if (m->gas == 0) m->gas = pocket->gas;
    ASSERT_NEAR(pocket->gas / m->gas, 1, 1e-6);
    const double part = fmin(1, m->t_end / 3);
    for (int k = 0; k < 2; k++) {
        if (k == 0 ? info->t > part : info->t < m->t_end - part) continue;
        m->sum[k] += info->pocket_volume * info->dt;
        m->count[k] += info->dt;
    }
    return 0;
}

/* A pocket under a roof of plates in a surging tank keeps its gas and its volume: its mean over
 * many of its own periods. MPS_POCKET_SECONDS sets another time. */
static void carried(void **state)
{
    (void)state;
    const char *seconds = getenv("MPS_POCKET_SECONDS");
    scene s = {.size = {0.6, 0.8},
               .depth = 0.6,
               .length = 0.6,
               .pocket = {0.11, 0.26, 0.5, 0.4},
               .gas = true};
    means m = {.t_end = seconds ? strtod(seconds, NULL) : 1.5};
    const mps_harmonic surge_of = {.dof = MPS_MOVE_X, .amplitude = 0.02, .omega = 4};
    static const double left[] = {0.1, 0.16}, right[] = {0.5, 0.16}, top[] = {0.1, 0.4},
                        up[] = {0, 0.24}, across[] = {0.4, 0};
    mps_config config;
    mps_sim *sim = NULL;
    assert_int_equal(mps_config_init(&config, sizeof config), MPS_OK);
    config.dp = DP;
    assert_int_equal(mps_sim_create(&config, &sim), MPS_OK);
    ASSERT_OK(sim, mps_model_use(sim, "gas.pocket"));
    add_tank(sim, s.size[0], s.size[1], 0);
    ASSERT_OK(sim, mps_plate_add(sim, "top", top, across, NULL));
    ASSERT_OK(sim, mps_plate_add(sim, "left", left, up, NULL));
    ASSERT_OK(sim, mps_plate_add(sim, "right", right, up, NULL));
    ASSERT_OK(sim, mps_fill_add(sim, 0, in_liquid, &s, NULL));
    ASSERT_OK(sim, mps_motion_harmonics_set(sim, 1, &surge_of));
    ASSERT_OK(sim, mps_run(sim, m.t_end, add_volume, &m));
    const double first = m.sum[0] / m.count[0], last = m.sum[1] / m.count[1];
    print_message("volume at first %.5f, at last, after %g s, %.5f m2\n", first, m.t_end, last);
    ASSERT_NEAR(last / first, 1, 0.01);
    mps_sim_destroy(sim);
}

/* Particles of the next frame with a number in its array "pocket". Its particles: fluid and
 * walls. */
static int64_t numbered_in_frame(mps_sim *sim, double number)
{
    const int64_t n = mps_particles_count(sim, MPS_FLUID) + mps_particles_count(sim, MPS_WALL);
    mps_frames *frames = NULL;
    size_t size;
    int64_t count = 0;
    ASSERT_OK(sim, mps_frames_open(sim, folder, "pocket", 0, &frames));
    ASSERT_OK(sim, mps_frames_write(frames));
    mps_frames_close(frames);
    char *text = slurp("pocket/pocket_000000.vtp", &size);
    const char *at = find_array(text, size, "pocket", "Float64", 1, (uint64_t)n * sizeof(double));
    for (int64_t i = 0; i < n; i++) {
        double value;
        memcpy(&value, at + (size_t)i * sizeof value, sizeof value);
        count += value == number;
    }
    free(text);
    return count;
}

/* Particles about a pocket have its number, in frames too. */
static void particles_name_it(void **state)
{
    (void)state;
    scene s = closed;
    mps_sim *sim = build(&s);
    run_steps(sim, 2);
    const int64_t all = mps_particles_count(sim, -1), about = numbered(sim, 1);
    assert_int_equal(about + numbered(sim, 0), all);
    assert_true(about > 2 * (10 + 10) && about < 4 * (10 + 10)); /* a box of 10 x 10 dp at a wall */
    assert_int_equal(numbered_in_frame(sim, 1), about);
    mps_sim_destroy(sim);
}

/* Calm water is looked at in one of 16 steps, a moving surface before it has moved by a spacing. */
static void looks_when_it_moves(void **state)
{
    (void)state;
    scene s[2] = {calm, dam};
    for (int k = 0; k < 2; k++) {
        const double dp = s[k].dp > 0 ? s[k].dp : DP;
        double most = 0, waits = 0;
        s[k].gas = true;
        mps_sim *sim = build(&s[k]);
        for (int step = 0; step < 160; step++) {
            const double *value = NULL;
            int64_t count = 0;
            run_steps(sim, 1);
            ASSERT_OK(sim, mps_model_state(sim, "gas", &value, &count));
            const mps__pocket_head *head = (const mps__pocket_head *)(const void *)value;
            assert_true(head->moved >= 0 && head->moved < dp);
            most = fmax(most, head->waited);
            waits += head->waited > 0;
        }
        if (k == 0) assert_true(most == 15 && waits == 150);
        if (k == 1) assert_true(waits > 0 && waits < 150);
        mps_sim_destroy(sim);
    }
}

/* The wall at x = 0 in a pocket at it. */
static void walls_show_it(void **state)
{
    (void)state;
    scene s = closed;
    mps_probe probe;
    double shown = 0;
    int32_t id;
    s.surge = 0;
    mps_sim *sim = build(&s);
    assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
    probe.type = MPS_PROBE_WALL_PRESSURE;
    probe.at[1] = 0.2;
    probe.average = 0;
    ASSERT_OK(sim, mps_probe_add(sim, &probe, &id));
    for (int k = 0; k < 30; k++) {
        const mps_step_info info = run_steps(sim, 1);
        ASSERT_OK(sim, mps_probe_read(sim, id, &shown));
        ASSERT_NEAR(shown, info.pocket_pressure, 1e-9 * fabs(info.pocket_pressure));
    }
    assert_true(shown != 0);
    mps_sim_destroy(sim);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_pocket_no_change),
                                       cmocka_unit_test(threads),
                                       cmocka_unit_test(restart),
                                       cmocka_unit_test(states_that_do_not_fit),
                                       cmocka_unit_test(gas_is_kept),
                                       cmocka_unit_test(carried),
                                       cmocka_unit_test(particles_name_it),
                                       cmocka_unit_test(looks_when_it_moves),
                                       cmocka_unit_test(walls_show_it)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields remain on a device until the host requests them. The shadow overwrites stale values of the
 * host with NaN: code that reads a field without a request finds NaN. */
#define _POSIX_C_SOURCE 200809L
#include "scene.h"
#include <math.h>
#include <mps/body.h>
#include <mps/couple.h>
#include <mps/output.h>

static const char *const public_fields[] = {"position",       "velocity", "pressure",
                                            "number_density", "density",  "mark"};
enum { FIELDS = sizeof public_fields / sizeof public_fields[0] };

/* Whether a field is stale on the host; it is not requested. */
static bool lacks(mps_sim *sim, const char *name)
{
    const mps__field *f = mps__particles_field(&sim->world.particles, name);
    assert_non_null(f);
    return !mps__array_valid(&f->array, MPS__ON_HOST);
}

/* ---- resident and downloaded fields ---- */

static void fields_stay(void **state)
{
    static const char *const preset[] = {"imps", "mmps"};
    (void)state;
    for (int k = 0; k < 4; k++) {
        mps_sim *sim = unwatched(preset[k / 2], 2 + k % 2);
        shadow s;
        shadow_attach(&s, sim);
        go(sim, 4);
        assert_true(lacks(sim, "position") && lacks(sim, "velocity") && lacks(sim, "pressure"));
        assert_true(isnan(sim->world.particles.x[0]) && isnan(sim->world.particles.u[0]));
        /* no step has changed them */
        assert_false(lacks(sim, "mark") || lacks(sim, "id"));
        mps_sim_destroy(sim);
    }
}

/* One of the questions that a user may ask. */
static void lease_all(mps_sim *host, mps_sim *sim)
{
    for (int k = 0; k < FIELDS; k++) same_field(host, sim, public_fields[k]);
}

static void lease_one(mps_sim *host, mps_sim *sim)
{
    const int64_t before = shadow_counts(sim).downloads;
    same_field(host, sim, "velocity");
    assert_int_equal(shadow_counts(sim).downloads, before + 1);
    assert_true(lacks(sim, "position") && !lacks(sim, "velocity"));
}

static void write_one(mps_sim *host, mps_sim *sim)
{
    mps_sim *side[] = {host, sim};
    for (int k = 0; k < 2; k++) {
        mps_lease u = {.struct_size = sizeof u};
        ASSERT_OK(side[k], mps_lease_begin(side[k], "velocity", MPS_WRITE, &u));
        for (int64_t i = 0; i < u.count * u.stride; i++) u.data[i] *= 0.999;
        ASSERT_OK(side[k], mps_lease_end(side[k], &u));
    }
}

static void tags(mps_sim *host, mps_sim *sim)
{
    same_tags(host, sim);
    assert_true(lacks(sim, "position"));
}

static void budgets(mps_sim *host, mps_sim *sim)
{
    same_budgets(host, sim);
}

static void momentum(mps_sim *host, mps_sim *sim)
{
    mps_momentum m[2];
    mps_sim *side[] = {host, sim};
    const int64_t before = shadow_counts(sim).downloads;
    memset(m, 0, sizeof m);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(mps_momentum_init(&m[k], sizeof m[k]), MPS_OK);
        ASSERT_OK(side[k], mps_momentum_get(side[k], &m[k]));
    }
    assert_memory_equal(m[0].total, m[1].total, sizeof m[0].total);
    assert_int_equal(shadow_counts(sim).downloads, before); /* the step knows it */
}

static void probes(mps_sim *host, mps_sim *sim)
{
    static const int32_t type[] = {MPS_PROBE_WALL_PRESSURE, MPS_PROBE_FORCE, MPS_PROBE_GAUGE,
                                   MPS_PROBE_FLUID_PRESSURE};
    mps_sim *side[] = {host, sim};
    for (int t = 0; t < 4; t++) {
        double value[2][6] = {{0}};
        for (int k = 0; k < 2; k++) {
            mps_probe probe;
            int32_t id;
            assert_int_equal(mps_probe_init(&probe, sizeof probe), MPS_OK);
            probe.type = type[t];
            probe.at[0] = type[t] == MPS_PROBE_WALL_PRESSURE ? 0 : 0.2;
            probe.at[1] = type[t] == MPS_PROBE_GAUGE ? 0 : 0.1;
            ASSERT_OK(side[k], mps_probe_add(side[k], &probe, &id));
            ASSERT_OK(side[k], mps_step(side[k], 0.01, NULL));
            ASSERT_OK(side[k], mps_probe_read(side[k], id, value[k]));
            ASSERT_OK(side[k], mps_probe_remove(side[k], id));
        }
        assert_memory_equal(value[0], value[1], sizeof value[0]);
        assert_true(value[0][0] != 0);
    }
}

static void stencils(mps_sim *host, mps_sim *sim)
{
    for (int32_t which = MPS_NEAR; which <= MPS_FAR; which++) {
        mps_stencil a, b;
        assert_int_equal(mps_stencil_init(&a, sizeof a), MPS_OK);
        assert_int_equal(mps_stencil_init(&b, sizeof b), MPS_OK);
        ASSERT_OK(host, mps_stencil_get(host, which, &a));
        ASSERT_OK(sim, mps_stencil_get(sim, which, &b));
        assert_int_equal(a.n, b.n);
        assert_memory_equal(a.x, b.x, (size_t)(a.n * a.dim) * sizeof *a.x);
        for (int64_t i = 0; i < a.n; i++) {
            const size_t count = (size_t)(a.end[i] - a.begin[i]);
            assert_int_equal(a.end[i] - a.begin[i], b.end[i] - b.begin[i]);
            assert_memory_equal(a.col + a.begin[i], b.col + b.begin[i], count * sizeof *a.col);
        }
    }
}

/* A file as a whole. */
static char *slurp(const char *path, long *size)
{
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    fseek(f, 0, SEEK_END);
    *size = ftell(f);
    rewind(f);
    char *text = malloc((size_t)*size + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)*size, f), *size);
    fclose(f);
    return text;
}

static void same_files(const char *a, const char *b)
{
    long size[2];
    char *text[] = {slurp(a, &size[0]), slurp(b, &size[1])};
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(text[0], text[1], (size_t)size[0]);
    free(text[0]);
    free(text[1]);
}

static void frames(mps_sim *host, mps_sim *sim)
{
    mps_sim *side[] = {host, sim};
    static const char *const name[] = {"a", "b"};
    char path[2][PATH + 32];
    for (int k = 0; k < 2; k++) {
        mps_frames *f = NULL;
        ASSERT_OK(side[k], mps_frames_open(side[k], folder, name[k],
                                           MPS_FRAMES_FLUID | MPS_FRAMES_WALL, &f));
        ASSERT_OK(side[k], mps_frames_write(f));
        mps_frames_close(f);
        snprintf(path[k], sizeof path[k], "%s/%s/%s_000000.vtp", folder, name[k], name[k]);
    }
    same_files(path[0], path[1]);
}

static void checkpoints(mps_sim *host, mps_sim *sim)
{
    char path[2][PATH];
    ASSERT_OK(host, mps_checkpoint_write(host, path_of(path[0], "lazy_host")));
    ASSERT_OK(sim, mps_checkpoint_write(sim, path_of(path[1], "lazy_device")));
    same_files(path[0], path[1]);
    ASSERT_OK(host, mps_checkpoint_read(host, path[0]));
    ASSERT_OK(sim, mps_checkpoint_read(sim, path[1]));
}

/* Steps that a snapshot takes back. */
static void snapshots(mps_sim *host, mps_sim *sim)
{
    mps_sim *side[] = {host, sim};
    for (int k = 0; k < 2; k++) {
        mps_snapshot *snapshot = NULL;
        ASSERT_OK(side[k], mps_snapshot_create(side[k], &snapshot));
        ASSERT_OK(side[k], mps_snapshot_take(snapshot));
        for (int again = 0; again < 2; again++) {
            go(side[k], 3 + 4 * again);
            ASSERT_OK(side[k], mps_snapshot_restore(snapshot));
        }
        mps_snapshot_destroy(snapshot);
    }
}

static void take_off(mps_sim *host, mps_sim *sim)
{
    const mps_device_ops ops = sim->world.runner.memory.device.ops;
    ASSERT_OK(sim, mps_sim_device_set(sim, NULL));
    go(host, 2);
    go(sim, 2);
    ASSERT_OK(sim, mps_sim_device_set(sim, &ops));
}

static void more_particles(mps_sim *host, mps_sim *sim)
{
    const double place[3] = {0.3, 0.5, 0.2};
    mps_sim *side[] = {host, sim};
    for (int k = 0; k < 2; k++) {
        mps_particle_block block;
        int64_t id;
        assert_int_equal(mps_particle_block_init(&block, sizeof block), MPS_OK);
        block.count = 1;
        block.position = place;
        ASSERT_OK(side[k], mps_particles_add(side[k], &block, &id));
        ASSERT_OK(side[k], mps_step(side[k], 0.01, NULL));
        ASSERT_OK(side[k], mps_particles_remove(side[k], 1, &id));
    }
}

/* Each request alone after steps, for any state after a search; then steps continue. */
static void questions(void **state)
{
    static void (*const ask[])(mps_sim *, mps_sim *) = {
        lease_all, lease_one, write_one, tags,      budgets,     momentum,      probes,
        stencils,  frames,    take_off,  snapshots, checkpoints, more_particles};
    (void)state;
    for (int32_t dim = 2; dim <= 3; dim++) {
        mps_sim *host = unwatched("imps", dim), *sim = unwatched("imps", dim);
        shadow s;
        shadow_attach(&s, sim);
        for (size_t k = 0; k < sizeof ask / sizeof ask[0]; k++) {
            go(host, 3 + (int64_t)k % 2);
            go(sim, 3 + (int64_t)k % 2);
            assert_true(lacks(sim, "position") && lacks(sim, "velocity"));
            ask[k](host, sim);
            if (k % 2 == 1) same(host, sim);
        }
        go(host, 3);
        go(sim, 3);
        same(host, sim);
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
        assert_int_equal(s.blocks, 0);
    }
}

/* Parts of a step on the host that need fields which no previous step has downloaded: the added
 * mass, a rigid body that carries the tank. */
static void parts_on_the_host(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        mps_sim *pair[] = {unwatched("imps", 2 + k % 2), unwatched("imps", 2 + k % 2)};
        shadow s;
        shadow_attach(&s, pair[1]);
        for (int side = 0; side < 2; side++) {
            mps_body body;
            assert_int_equal(mps_body_init(&body, sizeof body), MPS_OK);
            body.free = MPS_BODY_FREE(MPS_MOVE_X);
            body.mass = 100;
            body.stiffness[0] = 4e4;
            body.equilibrium[0] = 0.01;
            if (k < 2)
                ASSERT_OK(pair[side], mps_load_watch(pair[side], MPS_LOAD_MASS));
            else
                ASSERT_OK(pair[side], mps_body_set(pair[side], &body));
            go(pair[side], 12);
        }
        same(pair[0], pair[1]);
        mps_sim_destroy(pair[0]);
        mps_sim_destroy(pair[1]);
    }
}

/* ---- failures ---- */

static bool fail_now;

static int fail_if(mps_stage *s)
{
    return fail_now ? mps_stage_fail(s, "as the test wants it") : 0;
}

static const mps_verb late_verbs[] = {{.hook = MPS_SHIFT, .run = fail_if}};
static const mps_model_ops late = {TOY("test.late", 1, late_verbs)};

/* Steps that fail for other reasons leave fields on the device unchanged, in each step between two
 * searches. */
static void failed_steps(void **state)
{
    static const char *const preset[] = {"imps", "mmps"};
    (void)state;
    for (int k = 0; k < 4; k++) {
        mps_sim *pair[] = {unwatched(preset[k / 2], 2 + k % 2),
                           unwatched(preset[k / 2], 2 + k % 2)};
        shadow s;
        shadow_attach(&s, pair[1]);
        for (int side = 0; side < 2; side++) {
            ASSERT_OK(pair[side], mps_model_register(pair[side], &late));
            ASSERT_OK(pair[side], mps_model_use(pair[side], "test.late"));
            for (int step = 0; step < 10; step++) {
                fail_now = step > 0;
                for (int times = 0; times < step % 3; times++)
                    ASSERT_REFUSED(pair[side], mps_step(pair[side], 0.01, NULL), MPS_E_PLUGIN,
                                   "as the test wants it");
                fail_now = false;
                ASSERT_OK(pair[side], mps_step(pair[side], 0.01, NULL));
            }
        }
        assert_true(lacks(pair[1], "position"));
        same(pair[0], pair[1]);
        mps_sim_destroy(pair[0]);
        mps_sim_destroy(pair[1]);
    }
}

/* All calls that need fields return an error until the device works again. Nothing is lost. */
static void silent_between_steps(void **state)
{
    mps_sim *host = unwatched("imps", 2), *sim = unwatched("imps", 2);
    mps_lease lease = {.struct_size = sizeof lease};
    mps_energy energy;
    mps_snapshot *snapshot = NULL;
    char path[PATH];
    shadow s;
    (void)state;
    assert_int_equal(mps_energy_init(&energy, sizeof energy), MPS_OK);
    shadow_attach(&s, sim);
    ASSERT_OK(sim, mps_snapshot_create(sim, &snapshot));
    go(host, 5);
    go(sim, 5);
    s.dead = true;
    for (int k = 0; k < 2; k++) {
        ASSERT_REFUSED(sim, mps_lease_begin(sim, "velocity", MPS_READ, &lease), MPS_E_PLUGIN,
                       "the newest fields are on the device only");
        ASSERT_REFUSED(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &lease), MPS_E_PLUGIN,
                       "device only");
        ASSERT_REFUSED(sim, mps_energy_get(sim, &energy), MPS_E_PLUGIN, "device only");
        ASSERT_REFUSED(sim, mps_checkpoint_write(sim, path_of(path, "none")), MPS_E_PLUGIN,
                       "device only");
        ASSERT_REFUSED(sim, mps_snapshot_take(snapshot), MPS_E_PLUGIN, "device only");
        ASSERT_REFUSED(sim, mps_sim_device_set(sim, NULL), MPS_E_PLUGIN, "device only");
    }
    s.dead = false;
    same(host, sim);
    go(host, 5);
    go(sim, 5);
    same(host, sim);
    mps_snapshot_destroy(snapshot);
    mps_sim_destroy(host);
    mps_sim_destroy(sim);
}

/* A device fails permanently at a launch of a step: fields valid only on the device are lost, and
 * each call that needs them returns an error until a checkpoint or a snapshot restores a state.
 * `way`: which of them; 2: all fields are valid on the host, so nothing is lost. */
static void die(mps_sim *host, mps_sim *sim, shadow *s, int way, int64_t launch)
{
    mps_lease lease = {.struct_size = sizeof lease};
    mps_snapshot *snapshot = NULL;
    char path[PATH];
    ASSERT_OK(sim, mps_checkpoint_write(sim, path_of(path, "life")));
    ASSERT_OK(sim, mps_snapshot_create(sim, &snapshot));
    ASSERT_OK(sim, mps_snapshot_take(snapshot));
    if (way < 2) go(sim, 1 + launch % 3);
    s->dies_at = s->launches + launch;
    ASSERT_REFUSED(sim, mps_step(sim, 0.01, NULL), MPS_E_PLUGIN, "device 'shadow' failed");
    for (int k = 0; k < 2 && way < 2; k++) {
        ASSERT_REFUSED(sim, mps_lease_begin(sim, "position", MPS_READ, &lease), MPS_E_PLUGIN,
                       "read a checkpoint or restore a snapshot");
        ASSERT_REFUSED(sim, mps_step(sim, 0.01, NULL), MPS_E_PLUGIN, "t = ");
        ASSERT_REFUSED(sim, mps_sim_device_set(sim, NULL), MPS_E_PLUGIN, "device only");
    }
    if (way == 0) ASSERT_OK(sim, mps_checkpoint_read(sim, path));
    if (way == 1) ASSERT_OK(sim, mps_snapshot_restore(snapshot));
    ASSERT_OK(sim, mps_sim_device_set(sim, NULL));
    assert_null(sim->world.runner.memory.device.ops.name);
    mps_snapshot_destroy(snapshot);
    go(host, 4);
    go(sim, 4);
    same(host, sim);
}

static void dead_devices(void **state)
{
    (void)state;
    for (int k = 0; k < 18; k++) {
        mps_sim *host = unwatched("imps", 2 + k % 2), *sim = unwatched("imps", 2 + k % 2);
        shadow s;
        shadow_attach(&s, sim);
        go(host, 3);
        go(sim, 3);
        die(host, sim, &s, k / 6, 1 + 21 * (k % 6));
        mps_sim_destroy(host);
        mps_sim_destroy(sim);
        assert_int_equal(s.blocks, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_stay),          cmocka_unit_test(questions),
        cmocka_unit_test(parts_on_the_host),    cmocka_unit_test(failed_steps),
        cmocka_unit_test(silent_between_steps), cmocka_unit_test(dead_devices),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Refused checkpoints: another set-up, a wrong time, damaged or manipulated files. */
#define _POSIX_C_SOURCE 200809L
#include "checkpoint_editor.h"
#include "checkpoint_fixture.h"
#include "world.h"
#include <sys/stat.h>

/* ---- refusals ---- */

static int other_motion(void *user, double t, mps_motion_state *state)
{
    (void)user;
    state->value[MPS_MOVE_X] = 0.2 * t;
    return 0;
}

/* What differs, and the word for it. */
typedef struct difference {
    void (*make)(mps_sim *sim);
    const char *word;
} difference;

static void thicker(mps_sim *sim)
{
    const mps_phase p = {.struct_size = sizeof p, .density = 1001, .viscosity = 1e-3};
    ASSERT_OK(sim, mps_phase_set(sim, 0, &p));
}
static void other_setting(mps_sim *sim)
{
    ASSERT_OK(sim, mps_model_set(sim, "collision", "distance", 0.77));
}
static void other_model(mps_sim *sim)
{
    ASSERT_OK(sim, mps_model_remove(sim, "shift"));
}
static void one_more_field(mps_sim *sim)
{
    ASSERT_OK(sim, mps_field_add(sim, "colour", 1));
}
static void one_more_probe(mps_sim *sim)
{
    add_probes(sim);
}
static void moved_otherwise(mps_sim *sim)
{
    ASSERT_OK(sim, mps_motion_callback_set(sim, other_motion, NULL));
}
static void not_moved(mps_sim *sim)
{
    ASSERT_OK(sim, mps_motion_clear(sim));
}

static void other_set_ups(void **state)
{
    static const difference all[] = {
        {thicker, "\"phase 0 density 1000\" where this simulation has \"phase 0 density 1001\""},
        {other_setting, "distance 0.77"},
        {other_model, "\"model shift."},
        {one_more_field, "\"field colour of 1\""},
        {one_more_probe, "\"probe 4 type 0\""},
        {moved_otherwise, "the motion is another one: at t = "},
        {not_moved, "\"motion given\" where this simulation has \"motion none\""}};
    char path[PATH];
    mps_sim *sim = shaken(), *kept = shaken();
    (void)state;
    go(sim, 5);
    ASSERT_OK(sim, mps_checkpoint_write(sim, path_of(path, "set-up")));
    mps_sim_destroy(sim);
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
        sim = shaken();
        all[k].make(sim);
        ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path), MPS_E_ARG, all[k].word);
        same_field(sim, kept, "position");
        go(sim, 1); /* the refusal does it no harm */
        mps_sim_destroy(sim);
    }
    sim = with_air();
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path), MPS_E_ARG, "set up by the same calls");
    mps_sim_destroy(sim);
    sim = dam_3d();
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path), MPS_E_ARG, "\"dimensions 2\"");
    mps_sim_destroy(sim);
    sim = new_sim(2, 0.04);
    add_tank(sim, 0.64, 0.6, 0);
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path), MPS_E_ARG, "the checkpoint has");
    mps_sim_destroy(sim);
    mps_sim_destroy(kept);
}

static void calls_at_the_wrong_time(void **state)
{
    char path[PATH];
    mps_sim *sim = shaken();
    mps_lease x = {.struct_size = sizeof x};
    (void)state;
    ASSERT_OK(sim, mps_checkpoint_write(sim, path_of(path, "lease")));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_READ, &x));
    ASSERT_OK(sim, mps_checkpoint_write(sim, path));
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path), MPS_E_BUSY, "1 lease");
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    ASSERT_OK(sim, mps_lease_begin(sim, "velocity", MPS_WRITE, &x));
    ASSERT_REFUSED(sim, mps_checkpoint_write(sim, path), MPS_E_BUSY, "\"velocity\" is leased");
    ASSERT_OK(sim, mps_lease_end(sim, &x));
    assert_int_equal(mps_checkpoint_write(NULL, path), MPS_E_ARG);
    assert_int_equal(mps_checkpoint_read(NULL, path), MPS_E_ARG);
    ASSERT_REFUSED(sim, mps_checkpoint_write(sim, NULL), MPS_E_ARG, "path");
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, ""), MPS_E_ARG, "path");
    ASSERT_REFUSED(sim, mps_checkpoint_write(sim, "/nowhere/there/x"), MPS_E_IO,
                   "cannot create \"/nowhere/there/x.tmp\": No such file");
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path_of(path, "missing")), MPS_E_IO,
                   "No such file");
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, folder), MPS_E_IO, "cannot read");
    mps_sim_destroy(sim);
}

/* ---- damage ---- */

static void write_file(const char *path, const unsigned char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static size_t read_file(const char *path, unsigned char *bytes, size_t capacity)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t size = fread(bytes, 1, capacity, file);
    assert_true(size < capacity);
    assert_int_equal(fclose(file), 0);
    return size;
}

/* A number of a file, and the error text if it is changed. */
typedef struct forgery {
    const char *part;
    size_t offset; /* bytes into the elements */
    char type;     /* 'd'ouble, 'i'nt32_t, 'l': int64_t */
    double real;
    int64_t whole;
    const char *word;
} forgery;

#define REAL(part, offset, value, word)   \
    {                                     \
        part, offset, 'd', value, 0, word \
    }
#define NARROW(part, number, value, word)             \
    {                                                 \
        part, (size_t)(number)*4, 'i', 0, value, word \
    }
#define WIDE(part, offset, value, word)   \
    {                                     \
        part, offset, 'l', 0, value, word \
    }

static void forge(unsigned char *bytes, size_t size, const forgery *f)
{
    const int32_t narrow = (int32_t)f->whole;
    const void *value = f->type == 'd'   ? (const void *)&f->real
                        : f->type == 'i' ? (const void *)&narrow
                                         : &f->whole;
    if (!editor_put(bytes, size, f->part, f->offset, value, f->type == 'i' ? 4 : 8))
        fail_msg("no \"%s\"", f->part);
    editor_repair(bytes, size);
}

static const forgery forgeries[] = {
    NARROW("field kind", 5, 3, "\"kind\" of particle 5 is 3; must be 0..2"),
    NARROW("field phase", 7, 16, "\"phase\" of particle 7 is 16; must be 0..15"),
    NARROW("field part", 0, 99, "\"part\" of particle 0 is 99"),
    NARROW("field plate", 1, 1, "\"plate\" of particle 1 is 1; must be 0..0"),
    NARROW("field wall_of", 2, -2, "\"wall_of\" of particle 2 is -2"),
    NARROW("field wall_of", 2, 1 << 30, "\"wall_of\" of particle 2"),
    NARROW("field region", 3, 6, "\"region\" of particle 3 is 6; must be 0..5"),
    NARROW("field held", 3, 2, "\"held\" of particle 12 is 2; must be 0 or 1"), /* a byte each */
    WIDE("field id", 32, INT64_C(1) << 40, "\"id\" of particle 4"),
    WIDE("field id", 32, -1, "\"id\" of particle 4 is -1"),
    WIDE("particles.next_id", 0, 3, "\"id\" of particle"),
    WIDE("particles.next_id", 0, INT64_MAX, "\"particles.next_id\""),
    REAL("field position", 8, NAN, "number 1 of \"position\" is nan"),
    REAL("field position", 8, INFINITY, "number 1 of \"position\" is inf"),
    REAL("field velocity", 16, NAN, "\"velocity\""),
    REAL("field pressure", 0, NAN, "\"pressure\""),
    REAL("field number_density", 0, -INFINITY, "\"number_density\""),
    REAL("field density", 24, NAN, "\"density\""),
    REAL("field density", 24, -1, "\"density\" of particle 3 is -1; must be > 0"),
    REAL("field ref", 0, NAN, "\"ref\""),
    REAL("field area", 0, NAN, "\"area\""),
    REAL("field wall_pressure", 0, NAN, "\"wall_pressure\""),
    REAL("field mark", 0, NAN, "\"mark\""),
    REAL("searched", 40, NAN, "\"searched\""),
    NARROW("lists", 0, 2, "\"lists\" are 2, 1"),
    NARROW("lists", 0, 0, "\"lists\" are 0, 1"),
    NARROW("lists", 1, 7, "\"lists\" are 1, 7"),
    REAL("state.t", 0, NAN, "\"state.t\" is nan"),
    REAL("state.t", 0, 1e74, "\"motion.now\" is at 0.0"),
    REAL("state.t", 0, 1e76, "must be 0..1e+75"),
    REAL("state.dt_before", 0, 5e-322, "\"state.dt_before\" is 4.99"),
    REAL("state.budget", 0, -1e76, "must be within +-1e+75"),
    REAL("state.t", 0, -1, "\"state.t\" is -1"),
    WIDE("state.step", 0, -1, "\"state.step\" is -1"),
    WIDE("state.lost", 0, -1, "\"state.lost\" is -1"),
    WIDE("state.lost", 0, INT64_C(1) << 50, "more than all particles"),
    REAL("state.crossing_time", 0, NAN, "\"state.crossing_time\""),
    REAL("state.dt_previous", 0, -1, "\"state.dt_previous\""),
    REAL("state.dt_before", 0, INFINITY, "\"state.dt_before\""),
    REAL("state.spread", 0, NAN, "\"state.spread\""),
    REAL("state.jump", offsetof(mps__jump, accel), NAN, "\"state.jump\""),
    WIDE("state.jump", offsetof(mps__jump, since), -1, "\"state.jump\""),
    REAL("state.before", offsetof(mps__pose, state.value), NAN, "\"state.before\""),
    REAL("motion.now", offsetof(mps__pose, state.rate) + 8 * MPS_ROTATE_Z, INFINITY,
         "\"motion.now\""),
    REAL("motion.now", offsetof(mps__pose, rotation), NAN, "\"motion.now\""),
    REAL("motion.now", offsetof(mps__pose, rotation) + 8, 0.5, "the rotation of \"motion.now\""),
    REAL("motion.now", offsetof(mps__pose, state.value) + 8 * MPS_ROTATE_Y, 0.1,
         "'MPS_ROTATE_Y' of \"motion.now\" is not 0"),
    REAL("motion.now", offsetof(mps__pose, omega), NAN, "\"motion.now\""),
    REAL("motion.now", offsetof(mps__pose, alpha), NAN, "\"motion.now\""),
    REAL("motion.now", offsetof(mps__pose, t), NAN, "\"motion.now\""),
    REAL("motion.hold", offsetof(mps_motion_state, accel), NAN, "\"motion.hold\""),
    REAL("state.budget", offsetof(mps__budget, wall_work_momentum), NAN, "\"state.budget\""),
    REAL("state.budget", offsetof(mps__budget, deviation_start), NAN, "\"state.budget\""),
    REAL("state.budget", offsetof(mps__budget, last.momentum), NAN, "\"state.budget\""),
    REAL("state.budget", offsetof(mps__budget, momentum.added) + 16, NAN, "\"state.budget\""),
    WIDE("state.budget", offsetof(mps__budget, started), 2, "\"started\" of \"state.budget\" is 2"),
    NARROW("state.start_pending", 0, 2, "\"state.start_pending\" is 2; must be 0 or 1"),
    NARROW("state.level_told", 0, -1, "\"state.level_told\""),
    NARROW("state.moves_told", 0, 2, "\"state.moves_told\""),
    NARROW("state.window_told", 0, 2, "\"state.window_told\""),
    WIDE("probe 0 series", 0, -2, "the last step of probe 0 is -2"),
    WIDE("probe 0 series", 0, 1000, "the last step of probe 0 is 1000"),
    WIDE("probe 0 series", 0, -1, "rows after step -1"),
    WIDE("probe 0 series", 8, 2, "\"waits\" of probe 0 is 2"),
    WIDE("probe 0 series", 8, 1, "probe 0 waits for its first row and has"),
    WIDE("probe 0 series", 16, INT64_MIN, "the next sample of probe 0"),
    WIDE("probe 0 series", 16, INT64_C(1) << 40, "the next sample of probe 0"),
    REAL("probe 0 series", 24, NAN, "probe 0 begins at nan"),
    REAL("probe 0 signal", 0, NAN, "\"signal\""),
    REAL("probe 0 signal", 8, INFINITY, "\"signal\""),
    REAL("probe 0 signal", 0, 99, "time 0 of probe 0 is 99"),
    REAL("probe 0 times", 8, -1, "time 1 of probe 0 is -1"),
    REAL("probe 0 times", 8, NAN, "\"times\""),
    REAL("probe 0 samples", 0, NAN, "\"samples\""),
};

/* Files whose checksums are right and whose numbers are wrong. Nothing changes. */
static void forged_files(void **state)
{
    static unsigned char bytes[1 << 20], copy[1 << 20];
    char path[PATH];
    mps_sim *sim = shaken(), *kept = shaken();
    (void)state;
    for (int k = 0; k < 2; k++) go(k ? sim : kept, 3);
    ASSERT_OK(sim, mps_checkpoint_write(sim, path_of(path, "forged")));
    const size_t size = read_file(path, bytes, sizeof bytes);
    for (size_t k = 0; k < sizeof forgeries / sizeof forgeries[0]; k++) {
        memcpy(copy, bytes, size);
        forge(copy, size, &forgeries[k]);
        write_file(path, copy, size);
        if (mps_checkpoint_read(sim, path) == MPS_OK)
            fail_msg("forgery %d of \"%s\" was taken", (int)k, forgeries[k].part);
        ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path), MPS_E_IO, forgeries[k].word);
    }
    for (int k = 0; k < 2; k++) go(k ? sim : kept, 3);
    same(sim, kept);
    mps_sim_destroy(sim);
    mps_sim_destroy(kept);
}

static editor_part part_of(unsigned char *bytes, size_t size, const char *name)
{
    editor_part part = {0};
    assert_true(editor_find(bytes, size, name, &part));
    return part;
}

/* Numbers that are wrong together. */
static void forged_relations(void **state)
{
    static unsigned char bytes[1 << 20], copy[1 << 20];
    static const char *const words[] = {
        "two particles have the \"id\"", "which is no wall of a dummy", "which is not defined",
        "are not those of its set-up", "are not those of its set-up"};
    char path[PATH];
    mps_sim *sim = shaken();
    (void)state;
    go(sim, 3);
    ASSERT_OK(sim, mps_checkpoint_write(sim, path_of(path, "relations")));
    const size_t size = read_file(path, bytes, sizeof bytes);
    for (int k = 0; k < 5; k++) {
        memcpy(copy, bytes, size);
        const editor_part kind = part_of(copy, size, "field kind"),
                          phase = part_of(copy, size, "field phase");
        const editor_part id = part_of(copy, size, "field id"),
                          wall = part_of(copy, size, "field wall_of");
        const editor_part ref = part_of(copy, size, "field ref");
        int64_t fluid = 0, dummy = 0;
        int32_t value;
        while (memcpy(&value, kind.elements + 4 * fluid, 4), value != MPS_FLUID) fluid++;
        while (memcpy(&value, kind.elements + 4 * dummy, 4), value != MPS_DUMMY) dummy++;
        value = k == 1 ? (int32_t)fluid : k == 2 ? 3 : MPS_FLUID;
        if (k == 0) memcpy(id.elements, id.elements + 8 * (id.count - 1), 8);
        if (k == 1) memcpy(wall.elements + 4 * dummy, &value, 4);
        if (k == 2) memcpy(phase.elements + 4 * fluid, &value, 4);
        if (k == 3) memset(wall.elements, 0xff, wall.used);
        if (k == 3) memcpy(kind.elements + 4 * dummy, &value, 4);
        if (k == 4) memset(ref.elements + 16 * dummy, 0, 16);
        editor_repair(copy, size);
        write_file(path, copy, size);
        ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path), MPS_E_IO, words[k]);
    }
    go(sim, 1);
    mps_sim_destroy(sim);
}

/* A checkpoint replaces a regular file only, and leaves no other file. */
static void odd_places(void **state)
{
    char path[PATH], beside[PATH];
    struct stat there;
    mps_sim *sim = shaken();
    (void)state;
    path_of(path, "pipe");
    path_of(beside, "pipe.tmp");
    assert_int_equal(mkfifo(path, 0600), 0);
    ASSERT_REFUSED(sim, mps_checkpoint_write(sim, path), MPS_E_IO, "no regular file");
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path), MPS_E_IO, "it is a pipe (FIFO)");
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, folder), MPS_E_IO, "it is a folder");
    assert_int_equal(stat(path, &there), 0);
    assert_true(S_ISFIFO(there.st_mode));
    ASSERT_REFUSED(sim, mps_checkpoint_write(sim, folder), MPS_E_IO, "no regular file");
    assert_int_not_equal(access(beside, F_OK), 0);
    mps_sim_destroy(sim);
}

/* A flipped bit or a truncation anywhere: always reported, nothing is read. */
static void damaged_files(void **state)
{
    static unsigned char bytes[1 << 20];
    char path[PATH];
    mps_sim *sim = shaken(), *kept = shaken();
    (void)state;
    ASSERT_OK(sim, mps_checkpoint_write(sim, path_of(path, "damaged")));
    const size_t size = read_file(path, bytes, sizeof bytes);
    for (size_t k = 0; k < size; k += k < 150 ? 1 : 211) {
        bytes[k] ^= 1 << k % 8;
        write_file(path, bytes, size);
        const mps_status status = mps_checkpoint_read(sim, path);
        bytes[k] ^= 1 << k % 8;
        if (status != MPS_E_IO && status != MPS_E_VERSION)
            fail_msg("byte %zu of %zu turned: %s", k, size, mps_status_name(status));
    }
    for (size_t k = 0; k < size; k += k < 150 ? 1 : 1013) {
        write_file(path, bytes, k);
        ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path), MPS_E_IO,
                       k < 16 ? "is no checkpoint" : "cut short");
    }
    bytes[size] = 0;
    write_file(path, bytes, size + 1);
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path), MPS_E_IO, "continues behind its end");
    write_file(path, (const unsigned char *)"something else altogether", 25);
    ASSERT_REFUSED(sim, mps_checkpoint_read(sim, path), MPS_E_IO, "is no checkpoint");
    same(sim, kept);
    mps_sim_destroy(sim);
    mps_sim_destroy(kept);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_set_ups),    cmocka_unit_test(calls_at_the_wrong_time),
        cmocka_unit_test(damaged_files),    cmocka_unit_test(forged_files),
        cmocka_unit_test(forged_relations), cmocka_unit_test(odd_places),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

/* SPDX-License-Identifier: BSD-3-Clause */
/* Checkpoints with any numbers and correct checksums: refused without a change, or read, and then
 * the simulation continues. */
#include "../unit/checkpoint_editor.h"
#include "fuzz.h"
#include <unistd.h>

enum { SCENES = 4, LARGEST = 1 << 19, EDITS = 12, PATH_LENGTH = 64 };

static struct {
    mps_sim *sim;
    size_t size;
    unsigned char *file;
} scene[SCENES];

static unsigned char edited[LARGEST];
static char path[PATH_LENGTH];

static void leave(void)
{
    for (int k = 0; k < SCENES; k++) {
        mps_sim_destroy(scene[k].sim);
        free(scene[k].file);
    }
    remove(path);
}

static void write_file(const unsigned char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    FUZZ_MUST(file && fwrite(bytes, 1, size, file) == size);
    fclose(file);
}

static void add_probes(mps_sim *sim)
{
    for (int32_t type = 0; type < 4; type++) {
        mps_probe probe;
        int32_t id;
        mps_probe_init(&probe, sizeof probe);
        probe.type = type;
        probe.at[1] = type == MPS_PROBE_GAUGE ? 0 : 0.1;
        probe.at[0] = type == MPS_PROBE_GAUGE ? 0.2 : 0;
        probe.average = type == 3 ? 0 : 0.02;
        probe.rate = 500;
        FUZZ_MUST(mps_probe_add(sim, &probe, &id) == MPS_OK);
    }
}

static mps_sim *build(int k)
{
    const double lo[3] = {0, 0, 0}, hi[3] = {0.4, k == 1 ? 0.4 : 0.2, 0.4},
                 half[3] = {0.4, 0.2, 0.4}, foot[2] = {0.2, 0}, edge[2] = {0, 0.2};
    const mps_harmonic surge = {.dof = MPS_MOVE_X, .amplitude = 0.02, .omega = 8};
    mps_config config;
    mps_tank tank;
    mps_sim *sim = NULL;
    fuzz_config(&config, k == 2 ? 3 : 2, k == 1 ? 0.08 : 0.1);
    mps_tank_init(&tank, sizeof tank);
    tank.size[0] = tank.size[1] = tank.size[2] = 0.4;
    FUZZ_MUST(mps_sim_create(&config, &sim) == MPS_OK);
    if (k == 1) {
        const mps_phase gas = {.struct_size = sizeof gas, .density = 1.2, .viscosity = 1.8e-5};
        FUZZ_MUST(mps_preset_use(sim, "mmps") == MPS_OK);
        FUZZ_MUST(mps_phase_set(sim, 1, &gas) == MPS_OK);
    }
    FUZZ_MUST(mps_tank_add(sim, &tank, NULL) == MPS_OK);
    if (k == 3) FUZZ_MUST(mps_plate_add(sim, "plate", foot, edge, NULL) == MPS_OK);
    FUZZ_MUST(mps_fill_box_add(sim, 0, lo, half, NULL, NULL) == MPS_OK);
    if (k == 1) FUZZ_MUST(mps_fill_box_add(sim, 1, lo, hi, NULL, NULL) == MPS_OK);
    if (k != 2) FUZZ_MUST(mps_field_add(sim, "mark", 2) == MPS_OK);
    if (k != 3) add_probes(sim);
    if (k != 1) FUZZ_MUST(mps_motion_harmonics_set(sim, 1, &surge) == MPS_OK);
    for (int s = 0; s < 4; s++) FUZZ_MUST(mps_step(sim, 4e-3, NULL) >= 0);
    return sim;
}

static void prepare(int k)
{
    if (!path[0]) {
        snprintf(path, sizeof path, "%s/mps_fuzz_%ld",
                 access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp", (long)getpid());
        atexit(leave);
    }
    if (scene[k].sim) return;
    scene[k].sim = build(k);
    FUZZ_MUST(mps_checkpoint_write(scene[k].sim, path) == MPS_OK);
    FILE *file = fopen(path, "rb");
    scene[k].file = malloc(LARGEST);
    FUZZ_MUST(file && scene[k].file);
    scene[k].size = fread(scene[k].file, 1, LARGEST, file);
    FUZZ_MUST(scene[k].size < LARGEST);
    fclose(file);
}

/* One number of one part. */
static void edit(fuzz_input *in, unsigned char *file, size_t size)
{
    editor_part p;
    int wanted = fuzz_pick(in, 80);
    size_t at = EDITOR_HEAD;
    while (editor_part_at(file, size, at, &p) && wanted-- > 0) at += EDITOR_PART + p.capacity;
    if (!editor_part_at(file, size, at, &p) || p.used < 8) return;
    size_t where = ((size_t)fuzz_byte(in) << 8 | fuzz_byte(in)) % p.used;
    const double real = fuzz_real(in, 1);
    const int64_t whole = fuzz_whole(in);
    const int32_t narrow = (int32_t)whole;
    switch (fuzz_pick(in, 4)) {
    case 0:
        memcpy(p.elements + where % (p.used / 8) * 8, &real, 8);
        break;
    case 1:
        memcpy(p.elements + where % (p.used / 8) * 8, &whole, 8);
        break;
    case 2:
        memcpy(p.elements + where % (p.used / 4) * 4, &narrow, 4);
        break;
    default:
        p.elements[where] = (unsigned char)narrow;
    }
}

/* Fewer particles, in all arrays; the file gets shorter. */
static size_t shorten(unsigned char *file, size_t size, int64_t less)
{
    editor_part p;
    if (!editor_find(file, size, "field id", &p)) return size;
    const int64_t n = p.count, kept = n - less % n;
    for (size_t at = EDITOR_HEAD; editor_part_at(file, size, at, &p);
         at += EDITOR_PART + p.capacity) {
        const int per = p.count == n ? 1 : p.count == 2 * n ? 2 : p.count == 3 * n ? 3 : 0;
        if (!per || strncmp((char *)p.at, "probe", 5) == 0) continue;
        const size_t old = p.capacity;
        const int64_t count = kept * per;
        memcpy(p.at + MPS__PART_TITLE + 8, &count, sizeof count);
        editor_part fresh;
        if (!editor_part_at(file, size, at, &fresh)) return size;
        memmove(fresh.elements + fresh.capacity, fresh.elements + old,
                size - at - EDITOR_PART - old);
        size -= old - fresh.capacity;
        p = fresh;
    }
    return size;
}

static void go_on(mps_sim *sim)
{
    double values[8];
    fuzz_check_finite(sim);
    for (int32_t id = 0; id < 4; id++)
        if (mps_probe_size(sim, id) > 0) fuzz_status(sim, mps_probe_read(sim, id, values));
    for (int k = 0; k < 2; k++) fuzz_step(sim, 4e-3);
    for (int32_t id = 0; id < 4; id++)
        if (mps_probe_size(sim, id) > 0)
            fuzz_status(sim, mps_probe_series(sim, id, NULL, NULL, NULL));
    FUZZ_MUST(fuzz_status(sim, mps_checkpoint_write(sim, path)) == MPS_OK);
    const mps_status again = fuzz_status(
        sim, mps_checkpoint_read(sim, path)); /* what it writes it takes */
    if (again < 0) fprintf(stderr, "%s\n", mps_sim_error(sim));
    FUZZ_MUST(again == MPS_OK);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_input in = {data, size, 0};
    const int k = fuzz_pick(&in, SCENES);
    double before = -1, after = -1;
    prepare(k);
    mps_sim *sim = scene[k].sim;
    size_t used = scene[k].size;
    write_file(scene[k].file, used);
    FUZZ_MUST(mps_checkpoint_read(sim, path) == MPS_OK);
    memcpy(edited, scene[k].file, used);
    const unsigned less = fuzz_byte(&in);
    if (less >= 230) used = shorten(edited, used, fuzz_byte(&in));
    for (int e = 0; e < EDITS && fuzz_left(&in); e++) edit(&in, edited, used);
    editor_repair(edited, used);
    write_file(edited, used);
    mps_sim_time(sim, &before, NULL);
    const int64_t n = mps_particles_count(sim, -1);
    if (fuzz_status(sim, mps_checkpoint_read(sim, path)) >= 0) {
        go_on(sim);
    } else {
        mps_sim_time(sim, &after, NULL);
        FUZZ_MUST(before == after && n == mps_particles_count(sim, -1));
    }
    return 0;
}

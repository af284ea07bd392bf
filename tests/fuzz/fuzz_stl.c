/* SPDX-License-Identifier: BSD-3-Clause */
/* STL files: any bytes, or a closed surface with any changes of its corners and triangles, so that
 * solids are built and filled. */
#include "fuzz.h"
#include <unistd.h>

enum { CORNERS = 8, TRIANGLES = 12, PATH_LENGTH = 64 };

static char path[PATH_LENGTH];

static void leave(void)
{
    remove(path);
}

static void write_file(const void *bytes, size_t size)
{
    if (!path[0]) {
        snprintf(path, sizeof path, "%s/mps_fuzz_%ld.stl",
                 access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp", (long)getpid());
        atexit(leave);
    }
    FILE *file = fopen(path, "wb");
    FUZZ_MUST(file && fwrite(bytes, 1, size, file) == size);
    fclose(file);
}

/* A box with moved corners, and with omitted, duplicated or inverted triangles. */
static size_t make_binary(fuzz_input *in, unsigned char *out)
{
    static const int face[TRIANGLES][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                           {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                           {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    float corner[CORNERS][3];
    uint32_t count = 0;
    for (int k = 0; k < CORNERS; k++)
        for (int d = 0; d < 3; d++) corner[k][d] = (float)(k >> d & 1);
    for (int edits = fuzz_pick(in, 6); edits > 0; edits--) {
        const int k = fuzz_pick(in, CORNERS), d = fuzz_pick(in, 3);
        corner[k][d] += (float)fuzz_real(in, 0.5);
    }
    memset(out, 0, 84);
    const int odd = fuzz_pick(in, 64), which = fuzz_pick(in, TRIANGLES);
    for (int t = 0; t < TRIANGLES; t++) {
        if (odd == 1 && t == which) continue;
        for (int copy = 0; copy < (odd == 2 && t == which ? 2 : 1); copy++) {
            unsigned char *at = out + 84 + 50 * count++;
            memset(at, 0, 50);
            for (int v = 0; v < 3; v++)
                memcpy(at + 12 + 12 * v, corner[face[t][odd == 3 && t == which ? 2 - v : v]], 12);
        }
    }
    if (odd == 4) count = (uint32_t)fuzz_whole(in);
    memcpy(out + 80, &count, sizeof count);
    return 84 + 50 * (size_t)(odd == 1 ? TRIANGLES - 1 : odd == 2 ? TRIANGLES + 1 : TRIANGLES);
}

static void place_anywhere(fuzz_input *in, mps_stl *stl)
{
    for (int d = 0; d < 3; d++) {
        stl->shift[d] = fuzz_real(in, 1);
        if (fuzz_byte(in) > 200) stl->rotation[d] = fuzz_real(in, 4);
    }
    stl->open_side = fuzz_byte(in) > 240 ? (int32_t)fuzz_byte(in) % 9 : 0;
}

static void step_some(mps_sim *sim)
{
    const double lo[3] = {-1, -1, -1}, hi[3] = {2, 2, 2};
    int64_t added = 0;
    if (fuzz_status(sim, mps_fill_box_add(sim, 0, lo, hi, &added, NULL)) < 0) return;
    FUZZ_MUST(added > 0);
    fuzz_step(sim, 1e-3);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    unsigned char file[84 + 50 * (TRIANGLES + 1)];
    fuzz_input in = {data, size, 0};
    mps_config config;
    mps_stl stl;
    mps_sim *sim = NULL;
    double built[6];
    const unsigned mode = fuzz_byte(&in);
    fuzz_config(&config, 3, mode & 8 ? 0.3 : 0.5);
    FUZZ_MUST(mps_sim_create(&config, &sim) == MPS_OK);
    mps_stl_init(&stl, sizeof stl);
    stl.container = mode & 1;
    if (mode & 2) stl.scale = fuzz_real(&in, 1);
    if (mode & 4) stl.shift[1] = fuzz_real(&in, 1);
    if (mode & 128) place_anywhere(&in, &stl);
    if ((mode & 48) == 48)
        write_file(data + in.at, size - in.at); /* any bytes */
    else
        write_file(file, make_binary(&in, file));
    if (!(mode & 1) || mode & 64) { /* a body in a tank, or a second container */
        mps_tank tank;
        mps_tank_init(&tank, sizeof tank);
        for (int d = 0; d < 3; d++) tank.lo[d] = -0.3, tank.size[d] = 1.5;
        FUZZ_MUST(mps_tank_add(sim, &tank, NULL) == MPS_OK);
    }
    const int64_t before = mps_particles_count(sim, -1);
    if (fuzz_status(sim, mps_stl_add(sim, path, &stl, built)) >= 0) {
        fuzz_check_finite(sim);
        step_some(sim);
    } else {
        FUZZ_MUST(mps_particles_count(sim, -1) == before);
    }
    mps_sim_destroy(sim);
    return 0;
}
